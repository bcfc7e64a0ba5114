//! Checkpoints of the run of a scene.
//!
//! # Decided with
//! - [`crate::scene_run::SceneRun::checkpoint`], [`crate::scene_run::SceneRun::steps_to_checkpoint`]: when
//!   one may be taken, and runs that have none;
//! - [`crate::scene_run::SceneRun::resume`]: another scene is refused;
//! - [`crate::world::SavedWorld`], [`crate::action::Hand`]: objects unlike the scene's; hands;
//! - [`crate::world::Simulation::restore`], [`crate::state::State::check`]: parts that do not fit each other;
//! - [`crate::collision::ContactDetector::forget`]: contacts found anew;
//! - [`crate::digest::Digest`], [`crate::track::Track`]: digest of a scene and of its tracks.

use crate::action::Hand;
use crate::collision::Tally;
use crate::digest::Digest;
use crate::scene::ObjectKind;
use crate::world::SavedWorld;
use crate::{Control, Scene, State};
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// A scene's run between two steps, without the scene, which has to be given again to resume: plain data for a file.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneCheckpoint {
    /// Digest of the scene.
    pub(crate) scene: u64,
    /// The world as it was edited and merged.
    pub(crate) world: SavedWorld,
    /// Hands on the cloth.
    pub(crate) hands: Vec<Hand>,
    /// Positions of the vertices when the structure was compiled (m).
    pub(crate) layout: Vec<Vec3>,
    pub(crate) state: State,
    pub(crate) control: Control,
    pub(crate) steps: usize,
    pub(crate) split_steps: usize,
    pub(crate) refinements: usize,
    pub(crate) tally: Option<Tally>,
}

impl SceneCheckpoint {
    /// Steps taken.
    pub fn steps(&self) -> usize {
        self.steps
    }
}

/// Digest of a scene: of its debug format, which is exact to the last bit of a number, and of the digests of its
/// tracks.
pub(crate) fn scene_digest(scene: &Scene) -> u64 {
    let mut plain = scene.clone();
    let mut tracks = Vec::new();
    for (index, object) in plain.objects.iter_mut().enumerate() {
        if let ObjectKind::Animated { track, .. } = &mut object.kind
            && let Some(track) = track.take()
        {
            let number = track.digest();
            tracks.extend([index as u32, (number >> 32) as u32, number as u32]);
        }
    }
    let mut digest = Digest::new();
    digest.text(&format!("{plain:?}"));
    digest.whole(tracks);
    digest.value()
}
