//! Progress reports of long work, and the request to stop it.
//!
//! # Decided with
//! - [`crate::session::Session::execute_all`], [`crate::command::Command::weight`]: shares of commands;
//! - [`crate::watched_search::watched`], [`toile_marker::SearchWatcher`]: searches for markers;
//! - [`crate::timing::Timing`]: seconds spent;
//! - [`crate::session::Session::snapshot`] (`snapshot.rs`): work on another thread.
//!
//! Shown by crate `cli` (`bar.rs`, Ctrl-C) and the window (`app/job.rs`).

use crate::SessionError;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Receives progress reports of long work, and may stop it.
pub trait Watcher {
    /// Called repeatedly with the stage, the share of the work done in 0..=1 (it never falls within
    /// a command), and a detail. `Break` cancels: the command fails with
    /// [`SessionError::Cancelled`] and leaves everything as it was.
    fn progress(&mut self, stage: &str, share: f64, detail: &str) -> ControlFlow<()>;

    /// A flag that any thread may set to stop the work, if there is one; work polls it where it reports no
    /// progress.
    fn stop_flag(&self) -> Option<Arc<AtomicBool>> {
        None
    }
}

/// A watcher that ignores all reports and never stops the work.
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

/// Maps the progress of one part of the work into a range of the progress of the whole, which never falls.
pub(crate) struct ProgressShare<'a> {
    whole: &'a mut dyn Watcher,
    from: f64,
    to: f64,
    reached: f64,
}

impl<'a> ProgressShare<'a> {
    /// The part of the work between two values of the progress of the whole.
    pub fn new(whole: &'a mut dyn Watcher, from: f64, to: f64) -> Self {
        Self {
            whole,
            from,
            to,
            reached: from,
        }
    }
}

impl Watcher for ProgressShare<'_> {
    fn progress(&mut self, stage: &str, share: f64, detail: &str) -> ControlFlow<()> {
        let share = self.from + (self.to - self.from) * share.clamp(0.0, 1.0);
        self.reached = self.reached.max(share);
        self.whole.progress(stage, self.reached, detail)
    }

    fn stop_flag(&self) -> Option<Arc<AtomicBool>> {
        self.whole.stop_flag()
    }
}

/// Reports progress to the watcher; a request to stop becomes [`SessionError::Cancelled`].
pub(crate) fn report_progress(
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
