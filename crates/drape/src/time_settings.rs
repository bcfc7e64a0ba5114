//! Times of a run of a scene, and its method.

use crate::MethodSettings;

/// Duration, step and method of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSettings {
    /// Time simulated before time 0 (s).
    pub lead_in: f64,
    /// Time simulated from 0 on (s).
    pub duration: f64,
    /// Step in time (s).
    pub step: f64,
    /// The method.
    pub method: MethodSettings,
}

impl TimeSettings {
    /// All simulated time (s).
    pub fn whole(&self) -> f64 {
        self.lead_in + self.duration
    }
}
