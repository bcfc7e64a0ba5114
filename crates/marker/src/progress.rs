//! Progress of a search, and how to stop it.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use toile_nesting::Marker;

/// Progress of a search.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SearchProgress {
    /// Part of the work done, 0..=1.
    pub done: f64,
    /// Length of the best marker so far (m); nothing before the first.
    pub length: Option<f64>,
    /// Its efficiency if all pieces lie on it, 0..=1.
    pub efficiency: Option<f64>,
    /// Price of its fabric, all plies together, if a metre's is known.
    pub cost: Option<f64>,
    /// The best marker so far, for [`DocumentMarker::under_way`](crate::DocumentMarker::under_way); nothing before
    /// the first, and on rolls. It is the same where nothing is new.
    pub marker: Option<Arc<Marker>>,
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
