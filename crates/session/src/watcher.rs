//! How the outside follows long work and stops it.

use crate::SessionError;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Follows long work; may stop it.
pub trait Watcher {
    /// Told again and again: the stage, its share of the work done in 0..=1 (it never falls within
    /// a command), and a detail. `Break` cancels: the command fails with
    /// [`SessionError::Cancelled`] and leaves everything as it was.
    fn progress(&mut self, stage: &str, share: f64, detail: &str) -> ControlFlow<()>;

    /// Set from anywhere when the work is to stop, if there is such a flag: work that is not told
    /// on looks at it.
    fn stop_flag(&self) -> Option<Arc<AtomicBool>> {
        None
    }
}

/// A watcher that watches nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Watcher for Silent {
    fn progress(&mut self, _stage: &str, _share: f64, _detail: &str) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl<F: FnMut(&str, f64, &str) -> ControlFlow<()>> Watcher for F {
    fn progress(&mut self, stage: &str, share: f64, detail: &str) -> ControlFlow<()> {
        self(stage, share, detail)
    }
}

/// Maps the share of a part of the work into the share of the whole, which never falls.
pub(crate) struct Part<'a> {
    whole: &'a mut dyn Watcher,
    from: f64,
    to: f64,
    reached: f64,
}

impl<'a> Part<'a> {
    /// The part from one share of the whole to another.
    pub fn new(whole: &'a mut dyn Watcher, from: f64, to: f64) -> Self {
        Self {
            whole,
            from,
            to,
            reached: from,
        }
    }
}

impl Watcher for Part<'_> {
    fn progress(&mut self, stage: &str, share: f64, detail: &str) -> ControlFlow<()> {
        let share = self.from + (self.to - self.from) * share.clamp(0.0, 1.0);
        self.reached = self.reached.max(share);
        self.whole.progress(stage, self.reached, detail)
    }

    fn stop_flag(&self) -> Option<Arc<AtomicBool>> {
        self.whole.stop_flag()
    }
}

/// Tells the watcher, and turns its wish to stop into an error.
pub(crate) fn tell(
    watcher: &mut dyn Watcher,
    stage: &str,
    share: f64,
    detail: &str,
) -> Result<(), SessionError> {
    match watcher.progress(stage, share, detail) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(SessionError::Cancelled),
    }
}
