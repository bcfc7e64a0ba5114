//! Memories of methods from step to step: plain data of a state.

use crate::laws::membrane::Curvature;
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// Memory of a method from step to step beside positions and velocities. Other methods than the one that wrote it
/// ignore it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Memory {
    /// Nothing.
    #[default]
    Nothing,
    /// The state before the last step, for methods of two steps.
    Previous {
        /// Positions before the last step (m).
        positions: Vec<Vec3>,
        /// Velocities before the last step (m/s).
        velocities: Vec<Vec3>,
        /// Length of the last step (s).
        step: f64,
    },
    /// Buried contact samples, ascending: a solid was put over them, and they have not come out since.
    Buried(Vec<u32>),
    /// Memory of pseudo-transient continuation.
    Rest(RestMemory),
    /// Memory of dynamic relaxation.
    Relaxation(RelaxationMemory),
}

impl Memory {
    /// The memory of buried contact samples, ascending.
    pub fn of_buried(samples: impl Iterator<Item = u32>) -> Self {
        let samples: Vec<u32> = samples.collect();
        match samples.is_empty() {
            true => Self::Nothing,
            false => Self::Buried(samples),
        }
    }

    /// The buried contact samples, ascending.
    pub fn buried(&self) -> &[u32] {
        match self {
            Self::Buried(samples) => samples,
            _ => &[],
        }
    }
}

/// Memory of pseudo-transient continuation between two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RestMemory {
    /// Next pseudo time step (s), and its bound.
    pub(crate) pseudo_step: f64,
    pub(crate) longest_step: f64,
    pub(crate) steps: usize,
    /// Net force over weight after the last step, and its lowest so far.
    #[serde(with = "toile_fabric::exact")]
    pub(crate) residual: f64,
    #[serde(with = "toile_fabric::exact")]
    pub(crate) best: f64,
    /// Steps since the residual was lowest.
    pub(crate) waited: usize,
    pub(crate) linear_iterations: usize,
    pub(crate) curvature: Curvature,
}

/// Memory of dynamic relaxation between two iterations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RelaxationMemory {
    /// Displacements per iteration, half an iteration earlier (m).
    pub moves: Vec<Vec3>,
    /// Fictitious masses, with the iteration as unit of time (N/m).
    pub masses: Vec<f64>,
    /// Fictitious kinetic energy half an iteration earlier (J).
    pub kinetic: f64,
    /// Whether the next iteration starts without velocity.
    pub still: bool,
    /// Iterations so far.
    pub iterations: usize,
    /// Net force over weight at the last iteration.
    #[serde(with = "toile_fabric::exact")]
    pub residual: f64,
}
