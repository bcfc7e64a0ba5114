//! What methods remember from one step to the next: plain data of a state.

use crate::laws::membrane::Curvature;
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// What a method must remember from one step to the next beyond positions and velocities. Another
/// method than the one that wrote it takes no notice of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Memory {
    /// Nothing.
    #[default]
    Nothing,
    /// The state before the last step, for methods of two steps.
    Previous {
        /// Positions then [m].
        positions: Vec<Vec3>,
        /// Velocities then [m/s].
        velocities: Vec<Vec3>,
        /// Length of the step that followed [s].
        step: f64,
    },
    /// Contact samples that a surface was put over and that have not come out since, in order.
    Buried(Vec<u32>),
    /// How the way to rest stands.
    Rest(RestMemory),
    /// How dynamic relaxation stands.
    Relaxation(RelaxationMemory),
}

impl Memory {
    /// Of contact samples that a surface was put over, in order.
    pub(crate) fn of_buried(samples: impl Iterator<Item = u32>) -> Self {
        let samples: Vec<u32> = samples.collect();
        match samples.is_empty() {
            true => Self::Nothing,
            false => Self::Buried(samples),
        }
    }

    /// The contact samples that a surface was put over, in order.
    pub(crate) fn buried(&self) -> &[u32] {
        match self {
            Self::Buried(samples) => samples,
            _ => &[],
        }
    }
}

/// How the way to rest stands between two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RestMemory {
    /// Next pseudo time step [s], and its bound.
    pub(crate) pseudo_step: f64,
    pub(crate) longest_step: f64,
    pub(crate) steps: usize,
    /// Net force over weight after the last step, and its lowest so far.
    #[serde(with = "crate::exact")]
    pub(crate) residual: f64,
    #[serde(with = "crate::exact")]
    pub(crate) best: f64,
    /// Steps since the residual found a new low.
    pub(crate) waited: usize,
    pub(crate) linear_iterations: usize,
    pub(crate) curvature: Curvature,
}

/// How a relaxation stands between two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RelaxationMemory {
    /// Moves per iteration, half an iteration back [m].
    pub(crate) moves: Vec<Vec3>,
    /// Fictitious masses in iterations [N/m].
    pub(crate) masses: Vec<f64>,
    /// Kinetic energy in iterations, half an iteration back [J].
    pub(crate) kinetic: f64,
    /// Whether the next iteration starts from standstill.
    pub(crate) still: bool,
    pub(crate) iterations: usize,
    #[serde(with = "crate::exact")]
    pub(crate) residual: f64,
}
