//! The result of one benchmark.

use serde::Serialize;
use std::collections::BTreeMap;

/// One benchmark at one number of threads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Timed {
    /// Its name.
    pub name: String,
    /// Threads it was given.
    pub threads: usize,
    /// Vertices of the cloth.
    pub vertices: usize,
    /// Wall time (s).
    pub wall_s: f64,
    /// Processor time of the process (s).
    pub cpu_s: Option<f64>,
    /// Further numbers: steps, residual, times of stages (s).
    pub counted: BTreeMap<String, f64>,
    /// A table of its own.
    pub report: Option<String>,
    /// Why it did not end.
    pub failure: Option<String>,
}
