//! Progress of a search, and how to stop it.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Progress of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SearchProgress {
    /// Part of the work done, 0..=1.
    pub done: f64,
    /// Length of the best marker so far [m]; nothing before the first.
    pub length: Option<f64>,
    /// Its efficiency if all pieces lie on it, 0..=1.
    pub efficiency: Option<f64>,
    /// Price of its fabric, all plies together, if a metre's is known.
    pub cost: Option<f64>,
}

impl SearchProgress {
    /// The progress in words.
    pub fn words(&self) -> String {
        match self.length {
            Some(length) => format!("{:.0} mm of fabric", length * 1e3),
            None => "making ready".to_owned(),
        }
    }
}

/// Receives the progress of a search, and may stop it.
pub struct SearchWatcher<'a> {
    /// Called repeatedly with the progress; returns whether to go on.
    pub report: &'a mut dyn FnMut(&SearchProgress) -> bool,
    /// A flag that any thread may set to stop the search.
    pub stop: Arc<AtomicBool>,
}
