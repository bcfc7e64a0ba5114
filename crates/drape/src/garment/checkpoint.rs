//! A garment's run saved between two steps, and gone on with.

use super::digest::SetupDigest;
use super::setup::GarmentWorld;
use super::stage::StageState;
use super::{GarmentRun, GarmentSetup};
use crate::collision::Tally;
use crate::kinetic_damping::SwingWorkspace;
use crate::world::{ObjectId, Simulation, WorldEdit};
use crate::{Control, DrapeError, State, Workspace};
use serde::{Deserialize, Serialize};
use toile_geometry::{Vec2, Vec3};

/// All that a garment's run is between two steps but its setup, which it is resumed with: plain data, to be
/// written to a file.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// What it is of.
    setup: SetupDigest,
    level: usize,
    stage: StageState,
    state: State,
    control: Control,
    /// Where the vertices lay when the structure was made [m]: orders of elimination follow.
    layout: Vec<Vec3>,
    /// Shapes after an edit.
    edited: Option<EditedShapes>,
    /// Vertices that might touch when the factor's structure was worked out for them.
    eliminated_pairs: Option<Vec<[u32; 2]>>,
    #[serde(with = "crate::exact")]
    gap_before_merging: f64,
    share: f64,
    warnings: Vec<String>,
    steps: [usize; 2],
    tally: Tally,
}

/// Shapes of a garment whose pattern was edited while it was worn.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct EditedShapes {
    /// Rest shapes that the structure was made for [m].
    made_for: Vec<[Vec2; 3]>,
    /// Whether others came after them.
    is_reshaped: bool,
    /// Rest shapes now [m].
    rest: Vec<[Vec2; 3]>,
    /// Where strain counts.
    counted: Vec<bool>,
}

impl GarmentRun {
    /// All that it takes to go on from here in another process to the same bytes; nothing but where
    /// [`GarmentRun::is_checkpoint`].
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
            warnings: self.warnings.clone(),
            steps: self.steps,
            tally: self.cloth_tally(),
        })
    }

    /// Goes on from a checkpoint, with the setup that it was saved of; after an edit, with one of the same
    /// meshes, whose rest shapes do not count.
    ///
    /// # Errors
    /// A checkpoint of another setup, by what differs; one that does not fit itself.
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
        let made_as = (is_sewn, checkpoint.layout, edited.as_ref());
        let (mut simulation, garment) = restored(&setup, level, made_as)?;
        if let StageState::Sewing(sewing) = &mut stage {
            sewing.resume(&mut simulation.system, setup.levels[level].stitches.clone());
        }
        simulation.go_on_from(checkpoint.state, checkpoint.control)?;
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
            warnings: checkpoint.warnings,
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

/// The world of a level as it was made: whether it is still sewn, where its vertices lay, and what edits came.
fn restored(
    setup: &GarmentSetup,
    level: usize,
    (is_sewn, layout, edited): (bool, Vec<Vec3>, Option<&EditedShapes>),
) -> Result<(Simulation, ObjectId), DrapeError> {
    let mut made = setup.clone();
    if let Some(edited) = edited {
        made.levels[level].cloth.rest.clone_from(&edited.made_for);
    }
    let GarmentWorld {
        mut world,
        garment,
        solids,
    } = made.world(level);
    if !is_sewn {
        world.merge(made.levels[level].seams(garment));
        world.set_environment(made.worn_environment());
    }
    let simulation = Simulation::laid_out(world, layout, solids);
    let mut simulation = simulation.map_err(|error| damaged("layout", &error.to_string()))?;
    if let Some(edited) = edited.filter(|edited| edited.is_reshaped) {
        simulation.edit(WorldEdit::Reshape(garment, edited.rest.clone()))?;
    }
    Ok((simulation, garment))
}

/// A checkpoint whose parts do not fit each other.
pub(super) fn damaged(place: &str, what: &str) -> DrapeError {
    DrapeError::Scene {
        place: format!("checkpoint, {place}"),
        what: what.to_owned(),
        remedy: "take another checkpoint: this one is damaged".to_owned(),
    }
}
