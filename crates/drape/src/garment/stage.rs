//! The stages of a garment's run with their memories: plain data of a checkpoint.

use super::watch::Fall;
use crate::kinetic_damping::KineticDamping;
use crate::{PseudoTransientContinuation, RestSettings, SewRun};
use serde::{Deserialize, Serialize};

/// The stage of a garment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Springs along the seams draw the panels together.
    Sewing,
    /// XPBD with kinetic damping moves the merged garment under gravity until its motion has died out.
    Swinging,
    /// Pseudo-transient continuation brings it to rest.
    Settling,
    /// It is at rest, or its steps are used up.
    Finished,
}

/// A stage with its memory from step to step beside the state of the cloth.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) enum StageState {
    /// See [`Stage::Sewing`].
    Sewing(SewRun),
    /// See [`Stage::Swinging`].
    Swinging(Swinging),
    /// See [`Stage::Settling`].
    Settling(Settling),
    /// See [`Stage::Finished`]; the memory is that of the settling before.
    Finished(Settling),
}

/// Memory of the swing.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Swinging {
    pub damping: KineticDamping,
    pub attempts: Attempts,
}

/// Memory of the settling.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Settling {
    pub continuation: PseudoTransientContinuation,
    /// Whether the swing ended with crossings of cloth before the motion had died out.
    pub cut_short: bool,
    pub attempts: Attempts,
    /// How its net force falls.
    #[serde(default)]
    pub fall: Fall,
}

/// Attempts so far to bring a merged level to rest; a level that returns to an earlier stage continues the count.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Attempts {
    /// Finished swings.
    pub swings: usize,
    /// Rounds of refined contact samples.
    pub refinements: usize,
    /// Residual below which crossings of the body are searched next.
    pub check_below: f64,
    /// Whether the panels placed round the body lay in it once they were sewn, round the body as it is.
    #[serde(default)]
    pub is_sunk: bool,
}

/// Residual below which crossings of the body are first searched: samples refined early need no steps of their own.
const FIRST_CHECK: f64 = 2.0;

impl Default for Attempts {
    /// No attempt yet.
    fn default() -> Self {
        Self {
            swings: 0,
            refinements: 0,
            check_below: FIRST_CHECK,
            is_sunk: false,
        }
    }
}

impl Settling {
    /// The start of settling near rest, after a swing or an edit.
    pub fn near(settings: RestSettings, attempts: Attempts) -> Self {
        Self {
            continuation: PseudoTransientContinuation::near(settings),
            cut_short: false,
            attempts,
            fall: Fall::default(),
        }
    }
}

impl StageState {
    /// The stage without its memory.
    pub fn stage(&self) -> Stage {
        match self {
            Self::Sewing(_) => Stage::Sewing,
            Self::Swinging(_) => Stage::Swinging,
            Self::Settling(_) => Stage::Settling,
            Self::Finished(_) => Stage::Finished,
        }
    }

    /// Steps of sewing and of settling in this stage.
    pub fn steps(&self) -> [usize; 2] {
        match self {
            Self::Sewing(sewing) => [sewing.steps(), 0],
            Self::Swinging(_) => [0, 0],
            Self::Settling(settling) | Self::Finished(settling) => {
                [0, settling.continuation.steps()]
            }
        }
    }
}
