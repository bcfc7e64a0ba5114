//! How the outside follows and stops a search.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// How far a search is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Standing {
    /// Part of the work done, 0..=1.
    pub done: f64,
    /// Length of the best marker so far [m]; nothing before the first.
    pub length: Option<f64>,
    /// Its efficiency if all pieces lie on it, 0..=1.
    pub efficiency: Option<f64>,
    /// Price of its fabric, all plies together, if a metre's is known.
    pub cost: Option<f64>,
}

impl Standing {
    /// The same in words.
    pub fn words(&self) -> String {
        match self.length {
            Some(length) => format!("{:.0} mm of fabric", length * 1e3),
            None => "making ready".to_owned(),
        }
    }
}

/// How the outside follows and stops a search.
pub struct Follow<'a> {
    /// Told again and again how far the search is; answers whether to go on.
    pub told: &'a mut dyn FnMut(&Standing) -> bool,
    /// Set from anywhere when the search is to stop.
    pub stop: Arc<AtomicBool>,
}
