//! Run control: progress and cancel, log, stage times. Called from the calling thread only, between stages
//! and between chunks of a stage.

use super::{Error, Result, Status};
use std::time::Instant;

/// What a running operation reports to. The progress sink returns `false` to cancel.
pub struct Run<'a> {
    progress: Option<&'a mut (dyn FnMut(&'static str, f64) -> bool + 'a)>,
    log: Option<&'a mut (dyn FnMut(&str) + 'a)>,
    /// The part of the whole call that fractions are of now.
    part: [f64; 2],
    stages: Vec<(&'static str, f64)>,
    open: Option<(&'static str, Instant)>,
}

impl<'a> Run<'a> {
    /// Reports to nobody.
    pub fn quiet() -> Self {
        Self::new(None, None)
    }

    pub fn new(
        progress: Option<&'a mut (dyn FnMut(&'static str, f64) -> bool + 'a)>,
        log: Option<&'a mut (dyn FnMut(&str) + 'a)>,
    ) -> Self {
        Self { progress, log, part: [0.0, 1.0], stages: Vec::new(), open: None }
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
        if let Some(progress) = self.progress.as_mut()
            && !progress(name, self.part[0] + fraction * (self.part[1] - self.part[0]))
        {
            return Err(Error::new(Status::Cancelled, format!("cancelled by the caller in stage {name}")));
        }
        Ok(())
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
