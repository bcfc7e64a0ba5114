//! The stages of a garment's way, each with what it remembers: plain data of a checkpoint.

use crate::kinetic_damping::KineticDamping;
use crate::{PseudoTransientContinuation, RestSettings, SewRun};
use serde::{Deserialize, Serialize};

/// Where a garment is on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Elastics draw the panels together.
    Sewing,
    /// The merged garment swings under gravity until it is calm.
    Swinging,
    /// It settles to rest.
    Settling,
    /// At rest.
    Finished,
}

/// A stage with all that it remembers from one step to the next beside the state of the cloth.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) enum StageState {
    /// Elastics draw the panels together.
    Sewing(SewRun),
    /// The merged garment swings.
    Swinging(Swinging),
    /// It settles to rest.
    Settling(Settling),
    /// At rest: how it settled.
    Finished(Settling),
}

/// A merged garment that swings.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Swinging {
    pub damping: KineticDamping,
    pub attempts: Attempts,
}

/// A merged garment that settles.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Settling {
    pub continuation: PseudoTransientContinuation,
    /// Whether the swing ended at crossings of cloth before the cloth was calm.
    pub cut_short: bool,
    pub attempts: Attempts,
}

/// What was tried so far to bring a merged level to rest; a level that comes back to a stage goes on with it.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Attempts {
    /// Swings that are over.
    pub swings: usize,
    /// Rounds of finer contact testing.
    pub refinements: usize,
    /// Residual below which crossings of the body are looked for next.
    pub look_below: f64,
}

/// Residual below which crossings of the body are first looked for: what is found early is cured on the way.
const FIRST_LOOK: f64 = 2.0;

impl Default for Attempts {
    /// None yet.
    fn default() -> Self {
        Self {
            swings: 0,
            refinements: 0,
            look_below: FIRST_LOOK,
        }
    }
}

impl Settling {
    /// Settles near rest, where a swing or an edit left the cloth.
    pub fn near(settings: RestSettings, attempts: Attempts) -> Self {
        Self {
            continuation: PseudoTransientContinuation::near(settings),
            cut_short: false,
            attempts,
        }
    }
}

impl StageState {
    /// Which it is.
    pub fn stage(&self) -> Stage {
        match self {
            Self::Sewing(_) => Stage::Sewing,
            Self::Swinging(_) => Stage::Swinging,
            Self::Settling(_) => Stage::Settling,
            Self::Finished(_) => Stage::Finished,
        }
    }

    /// Steps of sewing and of settling that it counts.
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
