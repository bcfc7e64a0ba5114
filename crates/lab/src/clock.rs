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
            cpu: cpu_seconds(),
        }
    }

    /// Wall time so far [s].
    pub fn wall(&self) -> f64 {
        self.wall.elapsed().as_secs_f64()
    }

    /// Processor time of the whole process so far [s], where the system tells it.
    pub fn cpu(&self) -> Option<f64> {
        Some(cpu_seconds()? - self.cpu?)
    }
}
