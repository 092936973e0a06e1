//! The context: thread pool, callbacks, last error, predicate counters.
//!
//! All engine work runs inside the context's own rayon pool, never on rayon's global one (ranks × threads). The
//! calling thread meanwhile waits, and serves the callbacks: a worker that has something to tell sends a note and, for
//! progress, waits for the answer. So callbacks run on the calling thread only, under the host's floating-point
//! environment, and workers never leave the clean one. Cost of a note: two thread switches, some microseconds; calls
//! without callbacks send none.
//!
//! The `busy` flag makes re-entry (a callback that uses its own context) and use from two threads a status instead of
//! undefined behaviour.

use super::guard::{Host, adopt_worker, catch, guard};
use super::view::{address, index, into_handle, put};
use crate::base::blocks::Keeper;
use crate::base::{Error, Run, Status};
use crate::exact::counters::{self, Counts, PREDICATES, Predicate, TIERS};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::any::Any;
use std::cell::UnsafeCell;
use std::ffi::{CString, c_char, c_void};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock, mpsc};
use std::thread::JoinHandle;

/// Largest number of threads of a context.
pub const LAP_MAX_THREADS: i32 = 1024;

/// Level of a log message: what the library does and why.
pub const LAP_LOG_INFO: i32 = 0;

/// Progress of a call: the name of its stage (valid during the callback) and the fraction of the whole call that is
/// done, from 0 to 1, never falling. Return 0 to go on, anything else to cancel the call.
///
/// Runs on the thread that made the call and under the floating-point environment which that thread had. Must
/// return normally (no exception, no longjmp) and must not use the same context (LAP_ERR_BUSY).
pub type lap_progress = Option<unsafe extern "C" fn(user: *mut c_void, stage: *const c_char, fraction: f64) -> i32>;

/// A log message (valid during the callback) and its level, LAP_LOG_INFO. The same rules as for lap_progress.
pub type lap_log = Option<unsafe extern "C" fn(user: *mut c_void, level: i32, message: *const c_char)>;

/// What calls need besides their data: threads, callbacks, the last error, predicate counters. One thread uses a
/// context at a time; any number of contexts may exist. Other handles do not need the context that made them once they
/// are made, so it may be freed before them. Do not carry a context over a fork().
pub struct lap_context {
    busy: AtomicBool,
    state: UnsafeCell<State>,
}

pub struct State {
    threads: usize,
    pool: Option<Pool>,
    progress: (lap_progress, *mut c_void),
    log: (lap_log, *mut c_void),
    status: i32,
    message: CString,
    defect_kinds: Vec<i32>,
    defect_ids: Vec<[i64; 3]>,
    counting: bool,
    counts: Counts,
    /// Those of the last call alone.
    pub last_counts: Counts,
    /// Exact strings of the last call.
    pub strings: [CString; 4],
    /// What the last call handed out views of.
    held: Option<Arc<dyn Any + Send + Sync>>,
    /// Memory of one call is kept for the next.
    _keeper: Keeper,
}

impl State {
    fn new() -> Self {
        Self {
            threads: 1,
            pool: None,
            progress: (None, std::ptr::null_mut()),
            log: (None, std::ptr::null_mut()),
            status: 0,
            message: CString::default(),
            defect_kinds: Vec::new(),
            defect_ids: Vec::new(),
            counting: false,
            counts: Counts::ZERO,
            last_counts: Counts::ZERO,
            strings: Default::default(),
            held: None,
            _keeper: Keeper::new(),
        }
    }

    fn clear_error(&mut self) {
        self.status = 0;
        self.message = CString::default();
        self.defect_kinds.clear();
        self.defect_ids.clear();
    }

    fn set_error(&mut self, error: &Error) {
        self.status = error.status as i32;
        self.message = c_string(&error.message);
        self.defect_kinds.extend(error.culprits.iter().map(|c| c.kind as i32));
        self.defect_ids.extend(error.culprits.iter().map(|c| c.ids));
    }

    /// Keeps what a call hands out views of, until the next call that does.
    pub fn hold<T: Send + Sync + 'static>(&mut self, value: T) -> Arc<T> {
        let value = Arc::new(value);
        self.held = Some(value.clone());
        value
    }

    /// How many threads a handle made now may use for what it computes on demand.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Runs engine work in the pool, its callbacks on the calling thread.
    pub fn run<T: Send>(
        &mut self,
        host: &mut Host,
        body: impl FnOnce(&mut Run) -> Result<T, Error> + Send,
    ) -> Result<T, Error> {
        let pool = match self.pool.take() {
            Some(pool) => pool,
            None => Pool::new(self.threads)?,
        };
        let result = self.run_counted(&pool, host, body);
        self.pool = Some(pool);
        result
    }

    fn run_counted<T: Send>(
        &mut self,
        pool: &Pool,
        host: &mut Host,
        body: impl FnOnce(&mut Run) -> Result<T, Error> + Send,
    ) -> Result<T, Error> {
        self.last_counts = Counts::ZERO;
        if !self.counting {
            return self.run_in(pool, host, body);
        }
        // Counters are thread-local.
        pool.broadcast(|_| {
            counters::take();
            counters::enable(true);
        });
        let result = self.run_in(pool, host, body);
        let counted = pool.broadcast(|_| {
            counters::enable(false);
            counters::take()
        });
        counted.iter().for_each(|counts| self.last_counts.merge(counts));
        self.counts.merge(&self.last_counts);
        result
    }

    fn run_in<T: Send>(
        &self,
        pool: &Pool,
        host: &mut Host,
        body: impl FnOnce(&mut Run) -> Result<T, Error> + Send,
    ) -> Result<T, Error> {
        let (progress, log) = (self.progress, self.log);
        if progress.0.is_none() && log.0.is_none() {
            return pool.install(|| catch(|| body(&mut Run::quiet())));
        }
        let (notes, inbox) = mpsc::channel();
        let (answer, answers) = mpsc::channel();
        let mut result = None;
        pool.in_place_scope(|scope| {
            let result = &mut result;
            scope.spawn(move |_| {
                let (progress_notes, log_notes) = (notes.clone(), notes);
                // A closed channel means that the calling thread is gone: stop.
                let mut progress = move |stage: &'static str, fraction: f64| {
                    progress_notes.send(Note::Progress(stage, fraction)).is_ok() && answers.recv().unwrap_or(false)
                };
                let mut log = |message: &str| {
                    let _ = log_notes.send(Note::Log(message.into()));
                };
                *result = Some(catch(|| body(&mut Run::new(Some(&mut progress), Some(&mut log)))));
            });
            // Ends when the worker drops its senders.
            for note in inbox {
                match note {
                    Note::Progress(stage, fraction) => {
                        let go_on = progress.0.is_none_or(|callback| {
                            let stage = c_string(stage);
                            host.call(|| unsafe { callback(progress.1, stage.as_ptr(), fraction) }) == 0
                        });
                        let _ = answer.send(go_on);
                    }
                    Note::Log(message) => {
                        if let Some(callback) = log.0 {
                            let message = c_string(&message);
                            host.call(|| unsafe { callback(log.1, LAP_LOG_INFO, message.as_ptr()) });
                        }
                    }
                }
            }
        });
        result.unwrap_or_else(|| Err(Error::new(Status::Internal, "the worker ended without a result")))
    }
}

/// Threads that are waited for when dropped.
struct Joined(Vec<JoinHandle<()>>);

impl Drop for Joined {
    fn drop(&mut self) {
        for thread in self.0.drain(..) {
            // A worker that panicked has nothing more to say.
            let _ = thread.join();
        }
    }
}

/// A pool whose threads have the clean floating-point environment and panic silently. They are gone when it is dropped:
/// rayon alone lets them run out by themselves, which a host that unloads the library would not survive.
pub struct Pool {
    // Fields are dropped in this order: the pool tells its threads to end, then they are waited for.
    pool: ThreadPool,
    _threads: Joined,
}

impl Pool {
    pub fn new(threads: usize) -> Result<Self, Error> {
        let mut spawned = Joined(Vec::with_capacity(threads));
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("lapidary-{i}"))
            .start_handler(|_| adopt_worker())
            .spawn_handler(|worker| {
                let name = worker.name().unwrap_or_default().to_string();
                spawned.0.push(std::thread::Builder::new().name(name).spawn(|| worker.run())?);
                Ok(())
            })
            .build()
            .map_err(|e| Error::new(Status::OutOfMemory, format!("no threads to be had: {e}")))?;
        Ok(Self { pool, _threads: spawned })
    }
}

impl std::ops::Deref for Pool {
    type Target = ThreadPool;
    fn deref(&self) -> &ThreadPool {
        &self.pool
    }
}

/// Names of the counters, "predicate.tier", in the order in which they are numbered.
fn counter_names() -> &'static [CString] {
    static NAMES: OnceLock<Vec<CString>> = OnceLock::new();
    NAMES.get_or_init(|| {
        let tiers = |p: Predicate| TIERS.iter().map(move |t| c_string(&format!("{}.{}", p.name(), t.name())));
        PREDICATES.iter().flat_map(|&p| tiers(p)).collect()
    })
}

enum Note {
    Progress(&'static str, f64),
    Log(String),
}

/// A C string; an inner NUL ends it.
pub fn c_string(text: &str) -> CString {
    let end = text.find('\0').unwrap_or(text.len());
    CString::new(&text[..end]).unwrap_or_default()
}

/// Runs `body` with the context's state, which nobody else uses meanwhile. Errors do not touch the last error.
fn enter(context: *mut lap_context, body: impl FnOnce(&mut State, &mut Host) -> Result<(), Status>) -> i32 {
    guard(|host| {
        let context = unsafe { context.as_ref() }.ok_or(Status::NullPointer)?;
        if context.busy.swap(true, Ordering::Acquire) {
            return Err(Status::Busy);
        }
        // Released on every path, a panic included.
        struct Release<'a>(&'a AtomicBool);
        impl Drop for Release<'_> {
            fn drop(&mut self) {
                self.0.store(false, Ordering::Release);
            }
        }
        let _release = Release(&context.busy);
        body(unsafe { &mut *context.state.get() }, host)
    })
}

/// Runs a call that may fail with details: they become the context's last error.
pub fn with_context(context: *mut lap_context, body: impl FnOnce(&mut State, &mut Host) -> Result<(), Error>) -> i32 {
    enter(context, |state, host| {
        state.clear_error();
        catch(|| body(state, host)).map_err(|error| {
            state.set_error(&error);
            error.status
        })
    })
}

/// Makes a context: one thread, no callbacks, counters off.
///
/// context: receives the handle; free it with lap_context_free. The pool's threads are started when first needed.
///
/// Errors: LAP_ERR_NULL_POINTER. Threads: any. Cost: an allocation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_new(context: *mut *mut lap_context) -> i32 {
    guard(|_| {
        if context.is_null() {
            return Err(Status::NullPointer);
        }
        let made = lap_context { busy: AtomicBool::new(false), state: UnsafeCell::new(State::new()) };
        unsafe { put(context, into_handle(made)) };
        Ok(())
    })
}

/// Frees a context and all that was borrowed from it. NULL is allowed and does nothing.
///
/// Errors: LAP_ERR_BUSY if called from one of the context's callbacks; nothing is freed then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_free(context: *mut lap_context) -> i32 {
    if context.is_null() {
        return Status::Ok as i32;
    }
    let status = enter(context, |_, _| Ok(()));
    if status != Status::Ok as i32 {
        return status;
    }
    guard(|_| {
        drop(unsafe { Box::from_raw(context) });
        Ok(())
    })
}

/// Sets how many worker threads the calls with this context use: 1 (the default) to LAP_MAX_THREADS. Results do not
/// depend on it, bit for bit. With 1, a call computes in one worker thread while the calling thread waits.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT, LAP_ERR_BUSY. Cost: none; a pool of the old size is let go.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_set_threads(context: *mut lap_context, threads: i32) -> i32 {
    with_context(context, |state, _| {
        if !(1..=LAP_MAX_THREADS).contains(&threads) {
            return Err(Error::new(Status::BadArgument, format!("threads: {threads} is not in 1..={LAP_MAX_THREADS}")));
        }
        if state.threads != threads as usize {
            state.threads = threads as usize;
            state.pool = None;
        }
        Ok(())
    })
}

/// The number of worker threads that calls with this context use.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_threads(context: *mut lap_context, threads: *mut i32) -> i32 {
    enter(context, |state, _| {
        if threads.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(threads, state.threads as i32) };
        Ok(())
    })
}

/// Sets the progress callback (NULL: none) and the pointer that is handed to it.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: some microseconds per call-back.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_set_progress(
    context: *mut lap_context,
    callback: lap_progress,
    user: *mut c_void,
) -> i32 {
    with_context(context, |state, _| {
        state.progress = (callback, user);
        Ok(())
    })
}

/// Sets the log callback (NULL: none) and the pointer that is handed to it. The library never writes to a file, to
/// the standard output or to the standard error by itself.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: some microseconds per call-back.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_set_log(context: *mut lap_context, callback: lap_log, user: *mut c_void) -> i32 {
    with_context(context, |state, _| {
        state.log = (callback, user);
        Ok(())
    })
}

/// How the last call with this context ended: its status (LAP_OK after success) and its message ("" after success),
/// which names the offending element. Calls of lap_context_last_error, lap_context_last_defects, lap_context_threads
/// and lap_context_counter* leave both as they are.
///
/// Outputs (each may be NULL). message is valid until the next call with this context.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_last_error(
    context: *mut lap_context,
    status: *mut i32,
    message: *mut *const c_char,
) -> i32 {
    enter(context, |state, _| {
        unsafe {
            put(status, state.status);
            put(message, state.message.as_ptr());
        }
        Ok(())
    })
}

/// All defects that the last call with this context found (none after success).
///
/// Outputs (each may be NULL): count; kinds: count numbers LAP_DEFECT_*; ids: 3 × count, the elements of each defect as
/// LAP_DEFECT_* says, in the caller's numbering, -1 where unused. The arrays are valid until the next call with this
/// context.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_last_defects(
    context: *mut lap_context,
    count: *mut i64,
    kinds: *mut *const i32,
    ids: *mut *const i64,
) -> i32 {
    enter(context, |state, _| {
        unsafe {
            put(count, state.defect_kinds.len() as i64);
            put(kinds, address(&state.defect_kinds));
            put(ids, address(&state.defect_ids));
        }
        Ok(())
    })
}

/// Switches the predicate counters on (nonzero) or off (0, the default). They tell, per predicate and per tier, how many
/// decisions the making of meshes and cuts with this context took.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost when on: a few percent of a call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_counters_enable(context: *mut lap_context, on: i32) -> i32 {
    enter(context, |state, _| {
        state.counting = on != 0;
        Ok(())
    })
}

/// Sets all predicate counters to 0.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_counters_reset(context: *mut lap_context) -> i32 {
    enter(context, |state, _| {
        state.counts = Counts::ZERO;
        Ok(())
    })
}

/// How many predicate counters there are.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BUSY. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_counters_count(context: *mut lap_context, count: *mut i32) -> i32 {
    enter(context, |_, _| {
        if count.is_null() {
            return Err(Status::NullPointer);
        }
        unsafe { put(count, counter_names().len() as i32) };
        Ok(())
    })
}

/// Predicate counter i, from 0: its name ("predicate.tier") and its value, summed over all calls since it was reset. Tiers:
/// topology (it was known already), filter (a few operations in double), bounded (a running error bound), exact
/// (integers on the stack), big (integers of any size).
///
/// Outputs (each may be NULL). name lives as long as the process.
///
/// Errors: LAP_ERR_NULL_POINTER, LAP_ERR_BAD_ARGUMENT if there is no such counter, LAP_ERR_BUSY. Cost: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lap_context_counter(
    context: *mut lap_context,
    i: i32,
    name: *mut *const c_char,
    value: *mut i64,
) -> i32 {
    enter(context, |state, _| {
        let i = index(i, counter_names().len())?;
        let count = state.counts.get(PREDICATES[i / TIERS.len()], TIERS[i % TIERS.len()]);
        unsafe {
            put(name, counter_names()[i].as_ptr());
            put(value, count as i64);
        }
        Ok(())
    })
}
