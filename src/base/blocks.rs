//! Where the library's large arrays live. Mapping memory afresh for every call costs as much as the geometry does: a page
//! fault for every 4 KiB (DESIGN §12, "Memory"). So blocks of [`LARGE`] bytes or more are kept when freed and handed out again,
//! up to [`KEPT`] bytes for the process, as long as somebody says that calls will follow ([`Keeper`]: every context is one);
//! the last one to leave gives all of them back. Blocks of megabytes are mapped where huge pages fit, and ask for them:
//! one page fault then brings 2 MiB. Blocks too large to be kept grow by moving their pages, not what is in them, and shrink in place.
//!
//! Smaller requests, and all of them on systems other than Linux, go to the system's allocator.
//!
//! Invariant: the size class of a block follows from the size of the request alone, so what is freed is found again; a block
//! that is kept holds the address of the next one of its class in its first word. The lock is only ever tried: where
//! another thread has it (or had it when the process forked), blocks are mapped and unmapped directly.
//!
//! Cost: some 20 ns for a kept block; address space is rounded up by an eighth at most, memory by two pages.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Requests of so many bytes or more are blocks: where the system's allocator would map memory anew, too.
const LARGE: usize = 1 << LARGE_BITS;
const LARGE_BITS: u32 = 17;
/// What is kept for later calls, in all: enough for cuts of hundreds of thousands of triangles, where page faults weigh most (cuts of a
/// million triangles gain 8 % over 64 MiB), and little enough for every rank of a full node to hold, and for large grids beside it.
const KEPT: usize = 256 << 20;
const PAGE: usize = 4096;
/// A cache line.
const LINE: usize = 64;
/// A huge page.
const HUGE: usize = 2 << 20;
/// Blocks do not all start at the same place of a page: loops that walk several arrays side by side would meet in the same
/// sets of the cache. This many bytes further each time, modulo a page.
const STAGGER: usize = 13 * LINE;
/// Eight classes for each power of two.
const CLASSES: usize = 8 * (64 - LARGE_BITS as usize);

/// Global allocator of the crate.
pub struct Blocks;

struct Kept {
    /// The first kept block of each class, 0 if there is none.
    first: [usize; CLASSES],
    bytes: usize,
}

static KEEPERS: AtomicUsize = AtomicUsize::new(0);
static MAPPED: AtomicUsize = AtomicUsize::new(0);
static STORE: Mutex<Kept> = Mutex::new(Kept { first: [0; CLASSES], bytes: 0 });

/// As long as one of these lives, freed blocks are kept for reuse.
#[derive(Debug)]
pub struct Keeper(());

impl Keeper {
    pub fn new() -> Self {
        KEEPERS.fetch_add(1, Ordering::Relaxed);
        Self(())
    }
}

impl Default for Keeper {
    fn default() -> Self {
        Self::new()
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        if KEEPERS.fetch_sub(1, Ordering::Relaxed) == 1 {
            give_all_back();
        }
    }
}

fn is_block(layout: &Layout) -> bool {
    cfg!(all(target_os = "linux", target_pointer_width = "64", not(miri)))
        && layout.size() >= LARGE
        && layout.align() <= LINE
        && layout.size() < 1 << 46
}

/// The class of a size of at least [`LARGE`], and the bytes that blocks of this class have: the next size with four
/// significant bits, which is a multiple of the page size.
fn class(size: usize) -> (usize, usize) {
    let bits = usize::BITS - 1 - (size - 1).leading_zeros();
    let step = bits - 3;
    let eighth = ((size - 1) >> step) + 1;
    // `eighth` is in 9..=16, and `bits` is one less than that of LARGE where the size is LARGE itself.
    ((bits as usize + 1 - LARGE_BITS as usize) * 8 + eighth - 9, eighth << step)
}

/// The bytes of the blocks of a class.
fn bytes_of(class: usize) -> usize {
    (9 + class % 8) << (class / 8 + LARGE_BITS as usize - 4)
}

/// A kept block of a class; for want of one, the front of one that is up to twice as large.
fn take(class: usize, bytes: usize) -> Option<*mut u8> {
    let mut store = STORE.try_lock().ok()?;
    let from = (class..CLASSES.min(class + 9)).find(|&c| store.first[c] != 0)?;
    let block = store.first[from] as *mut u8;
    // SAFETY: kept blocks are mapped, aligned to cache lines, unused by anyone else, and their first word is the next one's address.
    store.first[from] = unsafe { block.cast::<usize>().read() };
    let found = bytes_of(from);
    store.bytes -= found;
    drop(store);
    if found > bytes {
        unmap(page_of(block).wrapping_add(bytes + PAGE), found - bytes);
    }
    Some(block)
}

/// Whether blocks of a size are kept as long as there is room: then growing leaves one for the next call, which will grow likewise.
fn worth_keeping(size: usize) -> bool {
    size <= KEPT && KEEPERS.load(Ordering::Relaxed) != 0
}

/// Whether the block is kept.
fn keep(block: *mut u8, class: usize, bytes: usize) -> bool {
    if !worth_keeping(bytes) {
        return false;
    }
    let Ok(mut store) = STORE.try_lock() else { return false };
    if store.bytes + bytes > KEPT {
        return false;
    }
    // SAFETY: the block was freed by its owner and is larger than a word.
    unsafe { block.cast::<usize>().write(store.first[class]) };
    store.first[class] = block as usize;
    store.bytes += bytes;
    true
}

/// Returns all kept blocks to the system.
pub fn give_all_back() {
    let Ok(mut store) = STORE.try_lock() else { return };
    for at in 0..CLASSES {
        let bytes = bytes_of(at);
        while store.first[at] != 0 {
            let block = store.first[at] as *mut u8;
            // SAFETY: as in `take`; nobody refers to a kept block.
            store.first[at] = unsafe { block.cast::<usize>().read() };
            unmap(page_of(block), bytes + PAGE);
        }
    }
    store.bytes = 0;
}

/// Where the mapping of a block starts.
fn page_of(block: *mut u8) -> *mut u8 {
    block.wrapping_sub(block as usize % PAGE)
}

/// Maps a zeroed block, somewhere in the first of its pages, one more than it needs; null if there is no memory. `size` is what
/// will be used of it.
fn map(bytes: usize, size: usize) -> *mut u8 {
    let slack = if size >= HUGE { HUGE } else { 0 };
    let whole = bytes + PAGE;
    let (read_write, private) = (libc::PROT_READ | libc::PROT_WRITE, libc::MAP_PRIVATE | libc::MAP_ANONYMOUS);
    // SAFETY: a new anonymous mapping, wherever the system puts it, touches nothing else.
    let start = unsafe { libc::mmap(std::ptr::null_mut(), whole + slack, read_write, private, -1, 0) };
    if start == libc::MAP_FAILED {
        return std::ptr::null_mut();
    }
    let mut start = start.cast::<u8>();
    if slack != 0 {
        let before = start.align_offset(HUGE);
        if before > 0 {
            unmap(start, before);
        }
        start = start.wrapping_add(before);
        if slack > before {
            unmap(start.wrapping_add(whole), slack - before);
        }
        ask_for_huge_pages(start, size);
    }
    start.wrapping_add(MAPPED.fetch_add(STAGGER, Ordering::Relaxed) % PAGE)
}

/// Asks for huge pages as far as `size` fills them: for the rest, one might hold a hundred times what is used of it.
fn ask_for_huge_pages(start: *mut u8, size: usize) {
    #[cfg(target_os = "linux")]
    // SAFETY: advice on our own mapping; whether it is taken does not matter.
    unsafe {
        libc::madvise(start.cast(), size & !(HUGE - 1), libc::MADV_HUGEPAGE);
    }
}

/// A block of megabytes, made larger or smaller without copying: its front keeps its pages. What is cut off goes back to the system; what grows
/// moves to where huge pages fit as before. Null if there is no memory: the block is as it was.
///
/// # Safety
/// `block` is one of ours for a request of `old` bytes, [`HUGE`] or more, and is not used any more if the result is not null.
#[cfg(target_os = "linux")]
unsafe fn resize(block: *mut u8, old: usize, size: usize) -> *mut u8 {
    let (have, want) = (class(old).1, class(size).1);
    let start = page_of(block);
    if want <= have {
        if want < have {
            unmap(start.wrapping_add(want + PAGE), have - want);
        }
        return block;
    }
    let moved = page_of(map(want, size));
    if moved.is_null() {
        return moved;
    }
    let flags = libc::MREMAP_MAYMOVE | libc::MREMAP_FIXED;
    // SAFETY: both are whole mappings of ours; the new one, which nobody refers to yet, is replaced by the old one's pages.
    let done = unsafe { libc::mremap(start.cast(), have + PAGE, have + PAGE, flags, moved.cast::<libc::c_void>()) };
    if done == libc::MAP_FAILED {
        unmap(moved, want + PAGE);
        return std::ptr::null_mut();
    }
    ask_for_huge_pages(moved, size);
    moved.wrapping_add(block as usize % PAGE)
}

/// Elsewhere there are no blocks.
#[cfg(not(target_os = "linux"))]
unsafe fn resize(_: *mut u8, _: usize, _: usize) -> *mut u8 {
    std::ptr::null_mut()
}

fn unmap(start: *mut u8, bytes: usize) {
    // SAFETY: only called for whole pages of our own mappings that nobody refers to.
    unsafe { libc::munmap(start.cast(), bytes) };
}

// SAFETY: blocks are mappings of their own, at least as large as asked for, aligned to cache lines; `is_block` and `class` depend
// on the layout alone, which the caller repeats when freeing. Everything else is the system allocator's.
unsafe impl GlobalAlloc for Blocks {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if !is_block(&layout) {
            return unsafe { System.alloc(layout) };
        }
        let (class, bytes) = class(layout.size());
        take(class, bytes).unwrap_or_else(|| map(bytes, layout.size()))
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if !is_block(&layout) {
            return unsafe { System.alloc_zeroed(layout) };
        }
        let (class, bytes) = class(layout.size());
        match take(class, bytes) {
            Some(block) => {
                unsafe { block.write_bytes(0, layout.size()) };
                block
            }
            None => map(bytes, layout.size()),
        }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        if !is_block(&layout) {
            return unsafe { System.dealloc(block, layout) };
        }
        let (class, bytes) = class(layout.size());
        if !keep(block, class, bytes) {
            unmap(page_of(block), bytes + PAGE);
        }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        let new = unsafe { Layout::from_size_align_unchecked(size, layout.align()) };
        match (is_block(&layout), is_block(&new)) {
            (false, false) => unsafe { System.realloc(block, layout, size) },
            (true, true) if class(size).0 == class(layout.size()).0 => block,
            (true, true) if layout.size() >= HUGE && !worth_keeping(layout.size()) => unsafe {
                resize(block, layout.size(), size)
            },
            _ => unsafe {
                let moved = self.alloc(new);
                if !moved.is_null() {
                    std::ptr::copy_nonoverlapping(block, moved, layout.size().min(size));
                    self.dealloc(block, layout);
                }
                moved
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_hold_their_sizes() {
        for size in (LARGE..LARGE * 9).step_by(997).chain([LARGE, LARGE + 1, HUGE - 1, HUGE, HUGE + 1, (1 << 46) - 1]) {
            let (at, bytes) = class(size);
            assert!(bytes >= size && bytes - size <= size / 8 && bytes % PAGE == 0, "{size}");
            assert_eq!(bytes, bytes_of(at));
            assert_eq!(class(bytes), (at, bytes));
        }
    }

    #[test]
    fn what_a_block_holds_stays_when_it_grows_or_shrinks() {
        let mark = |i: usize| (i / 4096) as u8 ^ 0x5A;
        let mut bytes: Vec<u8> = Vec::new();
        let mut length = 0;
        for size in [KEPT + 1, 2 * KEPT + 77, 5 * KEPT / 2, KEPT + 3 * HUGE, KEPT + 5, 2 * KEPT] {
            bytes.truncate(size);
            bytes.shrink_to(size);
            bytes.reserve_exact(size - bytes.len());
            assert!((0..length.min(size)).step_by(4096).all(|i| bytes[i] == mark(i)), "size {size}");
            bytes.extend((bytes.len()..size).map(mark));
            assert!((bytes.as_ptr() as usize).is_multiple_of(LINE));
            length = size;
        }
    }

    #[test]
    fn kept_blocks_come_back_zeroed_where_wanted() {
        let keeper = Keeper::new();
        for round in 0..3u8 {
            for size in [LARGE, 3 * LARGE + 5, HUGE + 1, 3 * HUGE] {
                let mut zeroed = vec![0u8; size];
                assert!(zeroed.iter().all(|&x| x == 0), "round {round}, size {size}");
                zeroed.fill(round + 1);
                zeroed.extend_from_slice(&[7; LARGE]);
                assert!(zeroed[..size].iter().all(|&x| x == round + 1) && zeroed[size..].iter().all(|&x| x == 7));
            }
        }
        drop(keeper);
    }
}
