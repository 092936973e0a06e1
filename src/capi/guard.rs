//! The one guard that every `extern "C"` body runs in: the host's floating-point environment is put aside and brought
//! back, and no panic leaves (nor prints).
//!
//! Panics are silenced without taking the process's panic hook away: a hook installed once is quiet on threads that
//! are inside the library, and hands every other panic to the hook that was there before. It notes where the panic
//! happened, so that the context's message can say it.

use super::fpenv::{self, Env};
use crate::base::{Error, Status};
use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

/// The host's floating-point environment while a call runs.
pub struct Host {
    env: Env,
}

impl Host {
    /// Runs a callback of the host under its own environment. What the callback changes there, sticky flags
    /// included, is kept.
    pub fn call<T>(&mut self, callback: impl FnOnce() -> T) -> T {
        fpenv::leave(&self.env);
        let quiet = QUIET.replace(false);
        let result = callback();
        QUIET.set(quiet);
        self.env = fpenv::enter();
        result
    }
}

thread_local! {
    /// This thread is inside the library.
    static QUIET: Cell<bool> = const { Cell::new(false) };
    /// Where the last panic of this thread happened.
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

fn install_hook() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if QUIET.get() {
                let place = info.location().map(|at| format!("{}:{}", at.file(), at.line()));
                PLACE.with(|p| *p.borrow_mut() = place);
            } else {
                before(info);
            }
        }));
    });
}

/// Makes a thread of our own pool one where our arithmetic holds and panics stay silent.
pub fn adopt_worker() {
    fpenv::set_clean();
    QUIET.set(true);
}

/// Runs `body`; a panic becomes an error with the status `Internal`.
pub fn catch<T>(body: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    PLACE.with(|p| p.borrow_mut().take());
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|payload| {
        let what = match payload.downcast_ref::<&'static str>() {
            Some(text) => text,
            None => payload.downcast_ref::<String>().map_or("of unknown kind", String::as_str),
        };
        let place = PLACE.with(|p| p.borrow_mut().take());
        let message = format!("fault of the library at {}: {what}", place.as_deref().unwrap_or("an unknown place"));
        // A payload whose destructor panics must not undo all this.
        std::mem::forget(payload);
        Err(Error::new(Status::Internal, message))
    })
}

/// The guard. The body gets the host's environment, for callbacks.
pub fn guard(body: impl FnOnce(&mut Host) -> Result<(), Status>) -> i32 {
    install_hook();
    let quiet = QUIET.replace(true);
    let mut host = Host { env: fpenv::enter() };
    // catch_unwind is a call that is never inlined, so no floating-point operation of the body moves out of it.
    let result = catch(|| Ok(body(&mut host)));
    fpenv::leave(&host.env);
    QUIET.set(quiet);
    match result {
        Ok(Ok(())) => Status::Ok as i32,
        Ok(Err(status)) => status as i32,
        Err(error) => error.status as i32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_status_and_keeps_its_place() {
        assert_eq!(guard(|_| panic!("on purpose")), Status::Internal as i32);
        let error = {
            QUIET.set(true);
            let error = catch::<()>(|| panic!("on {}", "purpose")).unwrap_err();
            QUIET.set(false);
            error
        };
        assert_eq!(error.status, Status::Internal);
        assert!(error.message.contains("on purpose") && error.message.contains("guard.rs"), "{}", error.message);
    }

    #[test]
    fn the_quiet_flag_is_lifted_in_callbacks_and_afterwards() {
        let status = guard(|host| {
            assert!(QUIET.get());
            host.call(|| assert!(!QUIET.get()));
            assert!(QUIET.get());
            Ok(())
        });
        assert_eq!(status, 0);
        assert!(!QUIET.get());
    }
}
