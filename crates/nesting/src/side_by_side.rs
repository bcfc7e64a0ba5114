//! Runs work on parallel threads, and calls back at intervals.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// Interval of the calls.
const PAUSE: Duration = Duration::from_millis(50);

/// Works on every part in a thread of its own; meanwhile calls `told` at intervals.
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
                // Nobody receives the message if another part has failed.
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
