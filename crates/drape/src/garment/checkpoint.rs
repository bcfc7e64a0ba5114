//! Checkpoints of a garment's run: saving it between two steps and resuming it.
//!
//! # Decided with
//! - [`crate::garment::stage::StageState`], [`crate::state::State`], [`crate::control::Control`]: what is
//!   saved;
//! - [`crate::garment::GarmentRun::is_checkpoint`], [`crate::garment::GarmentRun::forget_after`]: between
//!   which steps; what is forgotten there;
//! - [`crate::contacts::Contacts::forget`], [`crate::kinetic_damping::SwingWorkspace::forget_contacts`]:
//!   contacts found anew;
//! - [`crate::garment::digest::SetupDigest::check`]: another setup is refused;
//! - [`crate::world::Simulation::laid_out`], [`crate::world::Simulation::restore`]: the layout and state
//!   taken back;
//! - [`toile_fabric::exact`], [`crate::digest`]: infinite numbers; digests;
//! - [`crate::scene_checkpoint`]: the same for the run of a scene.
//!
//! By hand: `SetupDigest::of` lists the settings. No command writes a garment's checkpoint.
//! Damage and other versions are refused by crate `interchange`, `checkpoint.rs`; those of a scene are due by crate
//! `session`, `scene_checkpoint.rs`.

use super::digest::SetupDigest;
use super::setup::GarmentWorld;
use super::stage::StageState;
use super::{GarmentRun, GarmentSetup};
use crate::collision::Tally;
use crate::kinetic_damping::SwingWorkspace;
use crate::world::{ObjectId, Simulation, WorldEdit};
use crate::{Control, DrapeError, Finding, State, Workspace};
use serde::{Deserialize, Serialize};
use toile_geometry::{Vec2, Vec3};

/// A garment's run between two steps, without its setup, which has to be given again to resume: plain data for a
/// file.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// Digest of the setup it was saved with.
    setup: SetupDigest,
    level: usize,
    stage: StageState,
    state: State,
    control: Control,
    /// Positions of the vertices when the structure was compiled (m): they decide the elimination orders.
    layout: Vec<Vec3>,
    /// Rest shapes after an edit; none without one.
    edited: Option<EditedShapes>,
    /// Contact pairs of vertices in the sparsity pattern of the last symbolic factorisation.
    eliminated_pairs: Option<Vec<[u32; 2]>>,
    #[serde(with = "toile_fabric::exact")]
    gap_before_merging: f64,
    share: f64,
    /// By how much the body is thinner than it is (m).
    #[serde(default)]
    recess: f64,
    findings: Vec<Finding>,
    steps: [usize; 2],
    tally: Tally,
}

/// Rest shapes of a garment whose pattern was edited while it was worn.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct EditedShapes {
    /// Rest shapes that the structure was compiled for (m).
    made_for: Vec<[Vec2; 3]>,
    /// Whether the rest shapes changed after that.
    is_reshaped: bool,
    /// Present rest shapes (m).
    rest: Vec<[Vec2; 3]>,
    /// Triangles whose strain counts.
    counted: Vec<bool>,
}

impl GarmentRun {
    /// A checkpoint from which another process goes on to the same bytes; none unless [`GarmentRun::is_checkpoint`].
    pub fn checkpoint(&self) -> Option<Checkpoint> {
        if !self.is_checkpoint() {
            return None;
        }
        let topology = &self.system.topology;
        let edited = self.made_for.as_ref().map(|made_for| EditedShapes {
            made_for: made_for.clone(),
            is_reshaped: topology.bending.is_some(),
            rest: self.setup.levels[self.level].cloth.rest.clone(),
            counted: self.setup.counted.clone(),
        });
        Some(Checkpoint {
            setup: SetupDigest::of(&self.setup, self.level),
            level: self.level,
            stage: self.stage.clone(),
            state: self.state.clone(),
            control: self.system.control.clone(),
            layout: topology.layout.clone(),
            edited,
            eliminated_pairs: self.workspace.eliminated_pairs(&self.system),
            gap_before_merging: self.gap_before_merging,
            share: self.share,
            recess: self.recess,
            findings: self.findings.clone(),
            steps: self.steps,
            tally: self.cloth_tally(),
        })
    }

    /// Resumes a checkpoint with the setup that it was saved with. After an edit the setup needs the same meshes, and
    /// the rest shapes of the checkpoint replace its own.
    ///
    /// # Errors
    /// A checkpoint of another setup, with the property that differs; a checkpoint whose fields contradict each other.
    pub fn resume(setup: GarmentSetup, checkpoint: Checkpoint) -> Result<Self, DrapeError> {
        let mut setup = setup.prepared()?;
        let (level, edited) = (checkpoint.level, checkpoint.edited);
        let given = SetupDigest::of(&setup, level);
        checkpoint.setup.check(&given, edited.is_some())?;
        if level >= setup.levels.len() {
            return Err(damaged("level", "there is no such mesh"));
        }
        let made_for = edited.as_ref().map(|edited| edited.made_for.clone());
        if let Some(edited) = &edited {
            edited.check(setup.levels[level].cloth.triangles.len())?;
            setup.levels[level].cloth.rest.clone_from(&edited.rest);
            setup.counted.clone_from(&edited.counted);
        }
        let mut stage = checkpoint.stage;
        let is_sewn = matches!(stage, StageState::Sewing(_));
        let structure = (is_sewn, checkpoint.layout, edited.as_ref());
        let stand = (level, checkpoint.recess);
        let (mut simulation, garment) = restored(&setup, stand, structure)?;
        if let StageState::Sewing(sewing) = &mut stage {
            sewing.resume(&mut simulation.system, setup.levels[level].stitches.clone());
        }
        simulation.restore(checkpoint.state, checkpoint.control)?;
        let system = &simulation.system;
        let mut workspace = Workspace::default();
        if let Some(pairs) = &checkpoint.eliminated_pairs {
            let count = system.vertex_count();
            if pairs.iter().flatten().any(|&v| v as usize >= count) {
                return Err(damaged("eliminated_pairs", "there are fewer vertices"));
            }
            workspace.eliminate_pairs(system, pairs);
        }
        Ok(Self {
            simulation,
            garment,
            level,
            made_for,
            setup,
            stage,
            gap_before_merging: checkpoint.gap_before_merging,
            share: checkpoint.share,
            recess: checkpoint.recess,
            findings: checkpoint.findings,
            steps: checkpoint.steps,
            tally: checkpoint.tally,
            workspace,
            swing_workspace: SwingWorkspace::default(),
            forgot_contacts: true,
        })
    }
}

impl EditedShapes {
    fn check(&self, triangles: usize) -> Result<(), DrapeError> {
        for (what, shapes) in [("made_for", &self.made_for), ("rest", &self.rest)] {
            if shapes.len() != triangles {
                let found = format!(
                    "{} shapes are given for {triangles} triangles",
                    shapes.len()
                );
                return Err(damaged(&format!("edited.{what}"), &found));
            }
        }
        Ok(())
    }
}

/// The simulation of a level with the same structure as when the checkpoint was saved: from whether it is still sewn,
/// the positions at compilation, and the edited rest shapes.
fn restored(
    setup: &GarmentSetup,
    (level, recess): (usize, f64),
    (is_sewn, layout, edited): (bool, Vec<Vec3>, Option<&EditedShapes>),
) -> Result<(Simulation, ObjectId), DrapeError> {
    let mut original = setup.clone();
    if let Some(edited) = edited {
        (original.levels[level].cloth.rest).clone_from(&edited.made_for);
    }
    let GarmentWorld {
        mut world,
        garment,
        solids,
    } = original.world(level, recess);
    if !is_sewn {
        world.merge(original.levels[level].seams(garment));
        world.set_environment(original.worn_environment(recess));
    }
    let simulation = Simulation::laid_out(world, layout, solids);
    let mut simulation = simulation.map_err(|error| damaged("layout", &error.to_string()))?;
    if let Some(edited) = edited.filter(|edited| edited.is_reshaped) {
        simulation.edit(WorldEdit::Reshape(garment, edited.rest.clone()))?;
    }
    Ok((simulation, garment))
}

/// The error of a checkpoint whose fields contradict each other.
pub(super) fn damaged(place: &str, what: &str) -> DrapeError {
    DrapeError::Scene {
        place: format!("checkpoint, {place}"),
        what: what.to_owned(),
        remedy: "take another checkpoint: this one is damaged".to_owned(),
    }
}
