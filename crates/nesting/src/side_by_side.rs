//! Runs work on threads in parallel, and calls back at intervals.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// Time between two calls back.
const PAUSE: Duration = Duration::from_millis(50);

/// Works on every part on a thread of its own; meanwhile calls `told` now and then.
pub(crate) fn side_by_side<T: Send>(
    parts: Vec<T>,
    work: &(dyn Fn(T) + Sync),
    told: &mut dyn FnMut(),
) {
    let (ends, ended) = channel();
    std::thread::scope(|scope| {
        let mut left = parts.len();
        for part in parts {
            let ends = ends.clone();
            scope.spawn(move || {
                work(part);
                // Nobody listens any more if another part has failed.
                let _ = ends.send(());
            });
        }
        drop(ends);
        while left > 0 {
            match ended.recv_timeout(PAUSE) {
                Ok(()) => left -= 1,
                Err(RecvTimeoutError::Timeout) => told(),
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
    });
}
