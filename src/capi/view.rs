//! Between our arrays and C's pointers. All raw writes of the C boundary go through `put`.

use crate::base::{
    BoxId, CellId, ComponentId, EdgeId, FaceId, FunctionId, NodeId, OperandId, PatchId, PlaneId, PolygonId, RegionId,
    SetId, ShellId, Status, TetId, TriangleId, VertexId,
};
use crate::complex::{HalfCorner, HalfFace, Key};
use crate::network::patches::HalfPatch;
use crate::network::simplex::{
    Carrier, LocalCell, LocalEdge, LocalFace, LocalFunction, LocalHalfFace, LocalPlane, LocalVertex,
};

/// Writes through an output pointer, unless the caller does not want that output.
///
/// # Safety
/// `out` is null or points to writable, aligned memory for one `T`.
pub unsafe fn put<T>(out: *mut T, value: T) {
    if !out.is_null() {
        unsafe { out.write(value) }
    }
}

/// Element types whose arrays C may read as arrays of `To`, in place: same size and alignment, `#[repr(transparent)]`
/// or a primitive, every bit pattern that occurs a value of `To`. An all-ones `NONE` reads as −1; all other values
/// are below 2³¹ (checked when a handle is made).
///
/// # Safety
/// The implementor's layout is what the above says.
pub unsafe trait ReadAs<To> {}
unsafe impl ReadAs<i32> for u32 {}
unsafe impl ReadAs<i32> for i32 {}
unsafe impl ReadAs<i32> for VertexId {}
unsafe impl ReadAs<i32> for EdgeId {}
unsafe impl ReadAs<i32> for PlaneId {}
unsafe impl ReadAs<i32> for CellId {}
unsafe impl ReadAs<i32> for ComponentId {}
unsafe impl ReadAs<i32> for FaceId {}
unsafe impl ReadAs<i32> for BoxId {}
unsafe impl ReadAs<i32> for NodeId {}
unsafe impl ReadAs<i32> for RegionId {}
unsafe impl ReadAs<i32> for TetId {}
unsafe impl ReadAs<i32> for TriangleId {}
unsafe impl ReadAs<i32> for OperandId {}
unsafe impl ReadAs<i32> for FunctionId {}
unsafe impl ReadAs<i32> for SetId {}
unsafe impl ReadAs<i32> for PolygonId {}
unsafe impl ReadAs<i32> for PatchId {}
unsafe impl ReadAs<i32> for ShellId {}
unsafe impl ReadAs<i32> for HalfPatch {}
unsafe impl ReadAs<i32> for HalfFace {}
unsafe impl ReadAs<i32> for HalfCorner {}
unsafe impl ReadAs<i32> for LocalVertex {}
unsafe impl ReadAs<i32> for LocalEdge {}
unsafe impl ReadAs<i32> for LocalFace {}
unsafe impl ReadAs<i32> for LocalCell {}
unsafe impl ReadAs<i32> for LocalPlane {}
unsafe impl ReadAs<i32> for LocalFunction {}
unsafe impl ReadAs<i32> for LocalHalfFace {}
unsafe impl ReadAs<i64> for i64 {}
// A transparent pair.
unsafe impl ReadAs<i64> for Key {}
unsafe impl ReadAs<f64> for f64 {}
unsafe impl ReadAs<u8> for u8 {}
unsafe impl ReadAs<u8> for Carrier {}
// A byte of 0 or 1.
unsafe impl ReadAs<u8> for bool {}
// Fixed-size groups lie flat.
unsafe impl<To, T: ReadAs<To>, const N: usize> ReadAs<To> for [T; N] {}

/// The address that C reads an array at; NULL for an empty array.
pub fn address<T: ReadAs<To>, To>(items: &[T]) -> *const To {
    if items.is_empty() { std::ptr::null() } else { items.as_ptr().cast() }
}

/// Writes how long an array is, and its address.
///
/// # Safety
/// As for [`put`].
pub unsafe fn put_list<T: ReadAs<To>, To>(count: *mut i64, start: *mut *const To, items: &[T]) {
    unsafe {
        put(count, items.len() as i64);
        put(start, address(items));
    }
}

/// Borrows an input array of `count` groups.
///
/// # Safety
/// If `count > 0` and `start` is not null, it points to `count` readable groups that nobody writes meanwhile.
pub unsafe fn input<'a, T>(start: *const T, count: i64) -> Result<&'a [T], Status> {
    if count < 0 {
        return Err(Status::BadArgument);
    }
    if count > i32::MAX as i64 {
        return Err(Status::TooLarge);
    }
    if count == 0 {
        return Ok(&[]);
    }
    if start.is_null() {
        return Err(Status::NullPointer);
    }
    Ok(unsafe { std::slice::from_raw_parts(start, count as usize) })
}

/// Borrows a handle.
///
/// # Safety
/// `handle` is null or a live handle of that type.
pub unsafe fn handle<'a, T>(handle: *const T) -> Result<&'a T, Status> {
    unsafe { handle.as_ref() }.ok_or(Status::NullPointer)
}

/// Borrows a handle that the caller lets nobody else use meanwhile.
///
/// # Safety
/// `handle` is null or a live handle of that type, not used by any other call.
pub unsafe fn handle_mut<'a, T>(handle: *mut T) -> Result<&'a mut T, Status> {
    unsafe { handle.as_mut() }.ok_or(Status::NullPointer)
}

/// Gives a handle to the caller.
pub fn into_handle<T>(value: T) -> *mut T {
    Box::into_raw(Box::new(value))
}

/// Checks an index from the caller against a count.
pub fn index(i: i32, count: usize) -> Result<usize, Status> {
    usize::try_from(i).ok().filter(|&i| i < count).ok_or(Status::BadArgument)
}

/// Reads a versioned option struct: the caller's `struct_size` bytes over the defaults. A caller built against an
/// older header has a shorter struct and gets defaults for the rest; one built against a newer header has a longer
/// one, and may not set what this library does not know.
///
/// # Safety
/// `options` is null or points to `struct_size` readable bytes, `struct_size` being the struct's first `i32`. `T` is
/// `#[repr(C)]`, of `i32`s, `i64`s and `f64`s without gaps (any bytes are a value), with `struct_size: i32` first.
pub unsafe fn read_options<T: Copy>(options: *const T, defaults: T) -> Result<T, Status> {
    if options.is_null() {
        return Ok(defaults);
    }
    let size = unsafe { options.cast::<i32>().read_unaligned() };
    let Some(size) = usize::try_from(size).ok().filter(|&n| (4..=4096).contains(&n) && n % 4 == 0) else {
        return Err(Status::BadArgument);
    };
    let mut read = defaults;
    let known = size.min(size_of::<T>());
    unsafe { std::ptr::copy_nonoverlapping(options.cast::<u8>(), (&raw mut read).cast::<u8>(), known) };
    for i in known..size {
        if unsafe { options.cast::<u8>().add(i).read() } != 0 {
            return Err(Status::BadArgument);
        }
    }
    Ok(read)
}

/// Writes default options into the first `struct_size` bytes of the caller's struct (which may be an older or a
/// newer version than ours) and that size into its first field; bytes beyond our version become 0.
///
/// # Safety
/// `options` is null or points to `struct_size` writable bytes. `T` as for [`read_options`].
pub unsafe fn write_options<T: Copy>(options: *mut T, struct_size: i32, defaults: T) -> Result<(), Status> {
    if options.is_null() {
        return Err(Status::NullPointer);
    }
    let Some(size) = usize::try_from(struct_size).ok().filter(|&n| (4..=4096).contains(&n) && n % 4 == 0) else {
        return Err(Status::BadArgument);
    };
    unsafe {
        options.cast::<u8>().write_bytes(0, size);
        std::ptr::copy_nonoverlapping(
            (&raw const defaults).cast::<u8>(),
            options.cast::<u8>(),
            size.min(size_of::<T>()),
        );
        options.cast::<i32>().write_unaligned(struct_size);
    }
    Ok(())
}
