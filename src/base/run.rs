//! Run control: progress and cancel, log, stage times. Called between stages and between chunks of a stage by the thread that has the
//! [`Run`], and within long chunks, through a [`Watch`], by whichever thread works there; by one thread at a time.

use super::{Error, Result, Status};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, TryLockError};
use std::time::Instant;

/// Returns `false` to cancel.
type Progress<'a> = dyn FnMut(&'static str, f64) -> bool + Send + 'a;

/// What a running operation reports to. The progress sink returns `false` to cancel.
pub struct Run<'a> {
    progress: Option<&'a mut Progress<'a>>,
    log: Option<&'a mut (dyn FnMut(&str) + 'a)>,
    /// The part of the whole call that fractions are of now.
    part: [f64; 2],
    stages: Vec<(&'static str, f64)>,
    open: Option<(&'static str, Instant)>,
    /// The largest fraction told: calls within calls begin anew, the caller sees none fall.
    reached: f64,
}

impl<'a> Run<'a> {
    /// Reports to nobody.
    pub fn quiet() -> Self {
        Self::new(None, None)
    }

    pub fn new(progress: Option<&'a mut Progress<'a>>, log: Option<&'a mut (dyn FnMut(&str) + 'a)>) -> Self {
        Self { progress, log, part: [0.0, 1.0], stages: Vec::new(), open: None, reached: 0.0 }
    }

    /// Ends the running stage, starts the next, and tells the progress sink. `fraction` is of the whole call.
    pub fn stage(&mut self, name: &'static str, fraction: f64) -> Result<()> {
        self.end_stage();
        self.open = Some((name, Instant::now()));
        self.tick(name, fraction)
    }

    /// Fractions from here on are of this part of the whole call, until it is set again: for what repeats other operations.
    pub fn set_part(&mut self, part: [f64; 2]) {
        self.part = part;
    }

    /// Progress within a stage; an error if the caller wants to stop.
    pub fn tick(&mut self, name: &'static str, fraction: f64) -> Result<()> {
        self.reached = self.reached.max(self.of_whole(fraction));
        if let Some(progress) = self.progress.as_mut()
            && !progress(name, self.reached)
        {
            return Err(cancelled(name));
        }
        Ok(())
    }

    fn of_whole(&self, fraction: f64) -> f64 {
        self.part[0] + fraction * (self.part[1] - self.part[0])
    }

    /// Runs work, on any number of threads, that looks now and then whether it is to go on. Its result counts only if it was not to stop.
    pub fn watched<T>(&mut self, name: &'static str, fraction: f64, work: impl FnOnce(&Watch) -> T) -> Result<T> {
        self.reached = self.reached.max(self.of_whole(fraction));
        let fraction = self.reached;
        let ask = self
            .progress
            .as_mut()
            .map(|progress| -> Mutex<Box<Ask>> { Mutex::new(Box::new(move || progress(name, fraction))) });
        let watch = Watch { ask, ..Watch::quiet() };
        let result = work(&watch);
        if watch.stopped.into_inner() { Err(cancelled(name)) } else { Ok(result) }
    }

    pub fn end_stage(&mut self) {
        if let Some((name, start)) = self.open.take() {
            self.stages.push((name, start.elapsed().as_secs_f64()));
        }
    }

    pub fn log(&mut self, message: &str) {
        if let Some(log) = self.log.as_mut() {
            log(message);
        }
    }

    /// Seconds per stage, in the order in which they ran.
    pub fn take_stages(&mut self) -> Vec<(&'static str, f64)> {
        self.end_stage();
        std::mem::take(&mut self.stages)
    }
}

fn cancelled(name: &str) -> Error {
    Error::new(Status::Cancelled, format!("cancelled by the caller in stage {name}"))
}

/// Microseconds between two questions to the caller, about.
const PERIOD: u64 = 10_000;

/// Whether work within a stage is to go on.
///
/// How often the caller is asked depends on time, what is computed does not: work that is told to stop has no result. Work that takes less than
/// [`PERIOD`] never asks. Cost: a look at the clock, some 30 ns, so once a microsecond's work or more; nothing if nobody is to be asked.
pub struct Watch<'r> {
    ask: Option<Mutex<Box<Ask<'r>>>>,
    stopped: AtomicBool,
    start: Instant,
    /// When to ask next, in microseconds from the start.
    next: AtomicU64,
}

type Ask<'r> = dyn FnMut() -> bool + Send + 'r;

impl Watch<'_> {
    /// Nobody is asked.
    pub fn quiet() -> Self {
        Self { ask: None, stopped: AtomicBool::new(false), start: Instant::now(), next: AtomicU64::new(PERIOD) }
    }

    /// Whether to go on. Once it says no it always does.
    #[inline]
    pub fn go_on(&self) -> bool {
        match &self.ask {
            None => true,
            Some(ask) => !self.stopped.load(Ordering::Relaxed) && self.ask(ask),
        }
    }

    /// For work that ends by an error: whoever watches sees the run's own.
    #[inline]
    pub fn check(&self) -> Result<()> {
        if self.go_on() { Ok(()) } else { Err(Error::new(Status::Cancelled, "told to stop")) }
    }

    fn ask(&self, ask: &Mutex<Box<Ask>>) -> bool {
        let now = self.start.elapsed().as_micros() as u64;
        if now < self.next.load(Ordering::Relaxed) {
            return true;
        }
        // Another thread that asks already will tell all. One that panicked while it did has asked for the last time.
        match ask.try_lock() {
            Err(TryLockError::WouldBlock) => return true,
            Err(TryLockError::Poisoned(_)) => self.stopped.store(true, Ordering::Relaxed),
            Ok(mut ask) => {
                // (Told to stop since it was looked at last: not asked again.)
                if self.stopped.load(Ordering::Relaxed) || !ask() {
                    self.stopped.store(true, Ordering::Relaxed);
                }
                self.next.store(self.start.elapsed().as_micros() as u64 + PERIOD, Ordering::Relaxed);
            }
        }
        !self.stopped.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;
    use std::time::Duration;

    #[test]
    fn long_work_stops_on_all_threads_and_asks_once() {
        for threads in [1, 3] {
            let (mut asked, mut units) = (0, 0);
            let mut progress = |name: &'static str, fraction: f64| {
                assert_eq!((name, fraction), ("long", 0.5));
                asked += 1;
                asked < 3
            };
            let mut run = Run::new(Some(&mut progress), None);
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let outcome = run.watched("long", 0.5, |watch| {
                let unit = |_: u32| {
                    let go_on = watch.go_on();
                    if go_on {
                        std::thread::sleep(Duration::from_millis(1));
                    }
                    go_on as u32
                };
                units = pool.install(|| (0..100_000).into_par_iter().map(unit).sum::<u32>());
            });
            let error = outcome.unwrap_err();
            assert_eq!(
                (error.status, error.message.as_str()),
                (Status::Cancelled, "cancelled by the caller in stage long")
            );
            assert_eq!(asked, 3);
            assert!(units > 0 && units < 100_000);
        }
    }

    #[test]
    fn nobody_is_asked_by_a_quiet_run() {
        assert!(Run::quiet().watched("quiet", 0.0, |watch| watch.go_on()).is_ok_and(|go_on| go_on));
    }
}
