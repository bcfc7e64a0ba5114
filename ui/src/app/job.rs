//! Work on a thread of its own, with progress; it can be cancelled.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use toile_session::{SessionError, Watcher};

/// Work on another thread than the window.
pub struct Job<T> {
    receiver: Receiver<Result<T, SessionError>>,
    follower: Follower,
}

/// Progress of the work.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JobProgress {
    /// Name of the present step.
    pub stage: String,
    /// Progress, 0..=1.
    pub share: f64,
    /// Further information on the step.
    pub detail: String,
}

/// Passes progress to the window, and the request to stop to the work.
#[derive(Clone, Default)]
pub struct Follower {
    progress: Arc<Mutex<JobProgress>>,
    stop: Arc<AtomicBool>,
}

impl Watcher for Follower {
    fn progress(&mut self, stage: &str, share: f64, detail: &str) -> ControlFlow<()> {
        let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        *progress = JobProgress {
            stage: stage.to_owned(),
            share,
            detail: detail.to_owned(),
        };
        match self.stop.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    fn stop_flag(&self) -> Option<Arc<AtomicBool>> {
        Some(self.stop.clone())
    }
}

impl<T: Send + 'static> Job<T> {
    /// Starts the work on a new thread.
    pub fn start(
        work: impl FnOnce(&mut Follower) -> Result<T, SessionError> + Send + 'static,
    ) -> Self {
        let follower = Follower::default();
        let mut own = follower.clone();
        let (sender, receiver) = channel();
        std::thread::spawn(move || {
            let result = work(&mut own);
            // The receiver is gone if the window was closed meanwhile.
            let _ = sender.send(result);
        });
        Self { receiver, follower }
    }

    /// Present progress.
    pub fn progress(&self) -> JobProgress {
        let progress = &self.follower.progress;
        let progress = progress.lock().unwrap_or_else(PoisonError::into_inner);
        progress.clone()
    }

    /// Asks the work to stop as soon as it can.
    pub fn cancel(&self) {
        self.follower.stop.store(true, Ordering::Relaxed);
    }

    /// Result of the work once it has ended: the value, or a text that says why there is none.
    pub fn result(&self) -> Option<Result<T, String>> {
        match self.receiver.try_recv() {
            Ok(result) => Some(result.map_err(|error| error.to_string())),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                Some(Err("the work ended unexpectedly: try again".to_owned()))
            }
        }
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.follower.stop.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ended<T: Send + 'static>(job: &Job<T>) -> Result<T, String> {
        loop {
            if let Some(result) = job.result() {
                return result;
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn work_tells_how_far_it_is_and_stops_when_asked() {
        let whole = Job::start(|follower| {
            let _ = follower.progress("counting", 0.5, "half");
            Ok(7)
        });
        assert_eq!(ended(&whole), Ok(7));
        assert_eq!(whole.progress().stage, "counting");
        let endless = Job::start(|follower| {
            loop {
                if follower.progress("waiting", 0.0, "").is_break() {
                    return Err::<(), _>(SessionError::Cancelled);
                }
            }
        });
        endless.cancel();
        assert_eq!(ended(&endless), Err(SessionError::Cancelled.to_string()));
    }
}
