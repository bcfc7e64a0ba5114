//! Progress of a search, and how to stop it.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use toile_nesting::Marker;

/// Progress of a search.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SearchProgress {
    /// Fraction of the work done (0 to 1).
    pub done: f64,
    /// Length of the best marker so far (m); `None` before the first.
    pub length: Option<f64>,
    /// Efficiency of the best marker if all pieces lie on it (0 to 1).
    pub efficiency: Option<f64>,
    /// Price of the fabric for all plies, if the price per metre is known.
    pub cost: Option<f64>,
    /// The best marker so far, for [`DocumentMarker::under_way`](crate::DocumentMarker::under_way); `None`
    /// before the first, and on rolls. The same `Arc` as before if there is no improvement.
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
    /// Called repeatedly with the progress; returns whether to continue.
    pub report: &'a mut dyn FnMut(&SearchProgress) -> bool,
    /// A flag that any thread may set to stop the search.
    pub stop: Arc<AtomicBool>,
}
