//! What the chart of speed against accuracy holds: its runs, and how well the converged ends are known.

use crate::chart_contact::Touched;
use serde::Serialize;

/// One run of one method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// The scene.
    pub scene: String,
    /// File of its cloth.
    pub mesh: String,
    /// Vertices of the cloth.
    pub vertices: usize,
    /// The method.
    pub method: &'static str,
    /// Step (s) for methods in time; net force over weight asked for by methods of rest.
    pub step: f64,
    /// Iterations it is given in a (sub)step at the most. None for explicit methods, which do not
    /// iterate, and for methods of rest, which go on until they are done.
    pub iterations: Option<usize>,
    /// Wall time (ms): a simulated second of motion, or the whole way to rest.
    pub wall_ms: f64,
    /// Processor time (ms), likewise.
    pub cpu_ms: Option<f64>,
    /// Root of the mean squared distance to the converged end (mm).
    pub error_mm: Option<f64>,
    /// Why there is no end, or why it is wrong.
    pub failure: Option<String>,
    /// Whether no other run of the scene and mesh took less processor time and is nearer.
    pub best: bool,
}

impl Point {
    /// What it costs (ms): processor time where the system tells it, which a busy machine does
    /// not falsify, else wall time.
    pub fn cost(&self) -> f64 {
        self.cpu_ms.unwrap_or(self.wall_ms)
    }
}

/// The runs, and how well the converged ends are known.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ChartData {
    /// Motion: methods in time.
    pub motion: Vec<Point>,
    /// Rest: methods that look for it.
    pub rest: Vec<Point>,
    /// Contact of cloth with cloth.
    pub contact: Vec<Touched>,
    /// For each mesh: how far two unlike methods end apart (mm), and what they were.
    pub agreement: Vec<Agreement>,
}

/// How well a converged end is known.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Agreement {
    /// The mesh.
    pub mesh: String,
    /// Distance of the ends of two unlike methods at fine steps (mm).
    pub apart_mm: Option<f64>,
    /// The methods and their steps.
    pub by: String,
}
