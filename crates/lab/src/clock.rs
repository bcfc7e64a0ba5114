//! Wall and processor time of one piece of work.

use std::time::Instant;
use toile_session::cpu_seconds;

/// When a piece of work began.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    wall: Instant,
    cpu: Option<f64>,
}

impl Clock {
    pub fn start() -> Self {
        Self {
            wall: Instant::now(),
            cpu: processor_seconds(),
        }
    }

    /// Wall time so far [s].
    pub fn wall(&self) -> f64 {
        self.wall.elapsed().as_secs_f64()
    }

    /// Processor time so far, or wall time where the system does not tell it [s].
    pub fn spent(&self) -> f64 {
        self.cpu().unwrap_or_else(|| self.wall())
    }

    /// Processor time of the whole process so far [s], where the system tells it.
    pub fn cpu(&self) -> Option<f64> {
        Some((processor_seconds()? - self.cpu?).max(0.0))
    }
}

/// Processor time of the threads of this process [s]: to the microsecond where the system tells
/// it of each thread (Linux: the first field of `/proc/self/task/N/schedstat`, in nanoseconds).
fn processor_seconds() -> Option<f64> {
    let exact = || -> Option<f64> {
        let mut sum = 0.0;
        for task in std::fs::read_dir("/proc/self/task").ok()? {
            let text = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
            let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
            sum += 1e-9 * nanoseconds;
        }
        Some(sum)
    };
    exact().or_else(cpu_seconds)
}
