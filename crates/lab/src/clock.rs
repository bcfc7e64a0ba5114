//! Wall and processor time of one piece of work.

use std::time::Instant;

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

    /// Wall time so far (s).
    pub fn wall(&self) -> f64 {
        self.wall.elapsed().as_secs_f64()
    }

    /// Processor time so far, or wall time where the system does not tell it (s).
    pub fn spent(&self) -> f64 {
        self.cpu().unwrap_or_else(|| self.wall())
    }

    /// Processor time of the whole process so far (s), where the system tells it.
    pub fn cpu(&self) -> Option<f64> {
        Some((processor_seconds()? - self.cpu?).max(0.0))
    }
}

/// Processor time of the threads of this process (s): to the nanosecond where the system has such a
/// clock (POSIX `CLOCK_PROCESS_CPUTIME_ID`), else as it is told otherwise.
fn processor_seconds() -> Option<f64> {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
    }
    #[cfg(not(unix))]
    toile_session::cpu_seconds()
}
