//! The run of a garment through its stages: sewing, swing and settling, from the coarsest mesh of its panels to the
//! finest. One call of `advance` is one step. Between some steps the run can be saved; resumed in another process it
//! goes on to the same bytes.
//!
//! # Decided with
//! - [`crate::garment::stage::StageState`]: what each stage remembers;
//! - [`crate::sew`], [`crate::kinetic_damping`], [`crate::pseudo_transient`]: a step of sewing, of the swing,
//!   of settling, and when each ends;
//! - [`crate::garment::GarmentRun::merge`], [`crate::sew::SewRun::closed`]: sewn vertices merged once the
//!   seams are closed;
//! - [`crate::garment::setup`]: environment while sewn and when worn; limits on coarser meshes;
//! - [`crate::garment::tight`], [`crate::garment::watch`]: a tight garment sewn again round a thinner body; a
//!   garment that fell off;
//! - [`crate::garment::edit`], [`crate::garment::checkpoint`]: stages begun again after an edit of the
//!   pattern; a run saved and resumed;
//! - [`crate::garment::GarmentRun::swing_again`], [`crate::garment::GarmentRun::unsettle`]: back to the swing
//!   after a tangle; settling begun again for a hand;
//! - [`crate::garment::GarmentRun::findings`], [`crate::garment::body_crossings`]: what a run tells of
//!   itself; crossings that end in finer contact.

mod checkpoint;
mod digest;
mod edit;
mod setup;
mod stage;
mod tight;
mod watch;

pub use checkpoint::Checkpoint;
pub use setup::{GarmentLevel, GarmentSetup};
pub use stage::Stage;

use crate::collision::{ClothMemory, Tally};
use crate::kinetic_damping::{KineticDamping, SwingWorkspace};
use crate::measure::{Measures, measure};
use crate::world::{MeetingPoint, ObjectId, Simulation, WorldEdit};
use crate::{Control, DrapeError, Equilibrium, Finding, SewRun, State, System, Workspace};
use setup::GarmentWorld;
use stage::{Attempts, Settling, StageState, Swinging};
use std::ops::Deref;
use toile_geometry::Vec2;
use watch::Fall;

/// Progress of a garment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The stage.
    pub stage: Stage,
    /// Steps taken in it.
    pub step: usize,
    /// Largest seam gap (m).
    pub gap: f64,
    /// Net force over weight.
    pub residual: f64,
    /// Rough share of the whole run that is done, 0..=1; only an edit lowers it.
    pub share: f64,
}

/// A garment being sewn and draped.
pub struct GarmentRun {
    /// The world of the present stage. Callers may change the control of its system only: other changes are not saved.
    simulation: Simulation,
    /// The garment among its objects.
    garment: ObjectId,
    setup: GarmentSetup,
    level: usize,
    stage: StageState,
    /// Rest shapes that the structure of the merged cloth was compiled for; none without an edit since.
    made_for: Option<Vec<[Vec2; 3]>>,
    gap_before_merging: f64,
    share: f64,
    /// By how much the body is thinner than it is (m), while a tight garment is put on.
    recess: f64,
    findings: Vec<Finding>,
    /// Steps of sewing and of settling in finished stages.
    steps: [usize; 2],
    /// Counts of contact of cloth with cloth before the present caches were made.
    tally: Tally,
    workspace: Workspace,
    swing_workspace: SwingWorkspace,
    /// Whether the next detection of contacts depends on no earlier one.
    forgot_contacts: bool,
}

/// Steps of a stage between two checkpoints, at which contacts are searched without the search structures of earlier
/// detections: these are not in a checkpoint, and the order of contacts may depend on them. A step of the swing is a
/// round; one full search in 40 rounds costs less than 1 %.
const SEWING_SPAN: usize = 8;
const SWINGING_SPAN: usize = 40;
const SETTLING_SPAN: usize = 8;

/// Rounds of the swing between two searches for cloth that fell off the body: 0.1 s or less; and steps of the settling.
const FALL_ROUNDS: usize = 10;
const FALL_STEPS: usize = 8;

/// Most rounds of refined contact samples; crossings of the body that remain are reported.
const MAX_REFINEMENTS: usize = 12;

/// Most swings of a level: a swing that ended at a tangle is repeated once the tangle is undone.
const MAX_SWINGS: usize = 3;

/// Crossings of the body are searched again once the residual is below this share of that at the last search.
const NEXT_CHECK: f64 = 0.1;

impl Deref for GarmentRun {
    type Target = Simulation;

    fn deref(&self) -> &Simulation {
        &self.simulation
    }
}

impl GarmentRun {
    /// The control of the next steps: attachments of hands on the cloth, gravity, air. An edit resets it.
    pub fn control_mut(&mut self) -> &mut Control {
        &mut self.simulation.system.control
    }

    /// The state, mutable between two steps.
    pub fn state_mut(&mut self) -> &mut State {
        &mut self.simulation.state
    }

    /// A garment before its first step.
    ///
    /// # Errors
    /// Meshes and materials that cannot be simulated, a setup without levels.
    pub fn new(setup: GarmentSetup) -> Result<Self, DrapeError> {
        let setup = setup.prepared()?;
        let GarmentWorld {
            world,
            garment,
            solids,
        } = setup.world(0, 0.0);
        let mut simulation = Simulation::with_solids(world, solids)?;
        let sewing = SewRun::new(&mut simulation.system, Vec::new(), setup.sew);
        let mut run = Self {
            simulation,
            garment,
            level: 0,
            stage: StageState::Sewing(sewing),
            made_for: None,
            gap_before_merging: 0.0,
            share: 0.0,
            recess: 0.0,
            findings: Vec::new(),
            steps: [0; 2],
            tally: Tally::default(),
            workspace: Workspace::default(),
            swing_workspace: SwingWorkspace::default(),
            forgot_contacts: true,
            setup,
        };
        run.begin()?;
        Ok(run)
    }

    /// Starts to sew the panels of the present level at their present positions; seams that are closed already are
    /// merged at once.
    fn begin(&mut self) -> Result<(), DrapeError> {
        let stitches = self.setup.levels[self.level].stitches.clone();
        let Simulation { system, state, .. } = &mut self.simulation;
        let mut sewing = SewRun::new(system, stitches, self.setup.sew);
        sewing.measure_gap(state);
        let closed = sewing.closed();
        self.stage = StageState::Sewing(sewing);
        self.made_for = None;
        self.clear_caches();
        if closed {
            self.merge()?;
        }
        Ok(())
    }

    /// Replaces the present mesh by that of a level, with open seams and without velocity, in the shape reached.
    fn replace_mesh(&mut self, level: &GarmentLevel) -> Result<(), DrapeError> {
        let cloth = Box::new(level.cloth.clone());
        let edits = vec![
            WorldEdit::SetEnvironment(Box::new(self.setup.sewing_environment(self.recess))),
            WorldEdit::ReplaceMesh(self.garment, cloth, level.layers()),
        ];
        self.simulation.edit_all(edits, MeetingPoint::Midpoint)?;
        self.simulation.reset_motion();
        Ok(())
    }

    /// Merged vertex of each vertex of the present level's cloth; the identity until its seams are merged.
    pub fn target(&self) -> &[u32] {
        &self.simulation.map().target
    }

    /// Whether the present level is the last.
    fn is_finest(&self) -> bool {
        self.level + 1 == self.setup.levels.len()
    }

    /// Present level, and number of levels.
    pub fn level(&self) -> [usize; 2] {
        [self.level, self.setup.levels.len()]
    }

    /// Present stage and progress.
    pub fn progress(&self) -> Progress {
        let (gap, residual) = match &self.stage {
            StageState::Sewing(sewing) => (sewing.last_gap(), f64::INFINITY),
            StageState::Swinging(_) => (0.0, f64::INFINITY),
            StageState::Settling(settling) | StageState::Finished(settling) => {
                (0.0, settling.continuation.residual())
            }
        };
        Progress {
            stage: self.stage.stage(),
            step: self.stage.steps().into_iter().sum(),
            gap,
            residual,
            share: self.share,
        }
    }

    /// Restarts the settling of a merged garment with all the steps of its setup, after a caller changed the
    /// attachments of its control. No effect in other stages.
    pub fn unsettle(&mut self) {
        if let StageState::Settling(settling) | StageState::Finished(settling) = &self.stage {
            let mut settling = settling.clone();
            let settings = self.setup.rest_on(self.level);
            settling
                .continuation
                .continue_to(settings.residual, settings.steps);
            settling.fall = Fall::default();
            // What hands hold is not taken off and put on again.
            settling.attempts.is_sunk = false;
            self.stage = StageState::Settling(settling);
            self.findings.clear();
        }
    }

    /// Largest seam gap in the step before merging (m).
    pub fn gap_before_merging(&self) -> f64 {
        self.gap_before_merging
    }

    /// Steps of sewing and of settling so far, without the swing.
    pub fn steps(&self) -> [usize; 2] {
        let [sewing, settling] = self.stage.steps();
        [self.steps[0] + sewing, self.steps[1] + settling]
    }

    /// Counts of contact of cloth with cloth so far.
    pub fn cloth_tally(&self) -> Tally {
        let swinging = self.swing_workspace.cloth_tally();
        let settling = self.workspace.contacts.cloth.tally;
        self.tally.then(swinging).then(settling)
    }

    /// Number of symbolic factorisations and constraint layouts in the present stage: one, and one for each change of
    /// the model.
    pub fn structures(&self) -> usize {
        self.swing_workspace.builds() + self.workspace.symbolic_factorisations()
    }

    /// What the run found on its way and did about it, for the verdict on its result.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// Takes one step.
    ///
    /// # Errors
    /// Seams that do not close, numbers that are not finite, no progress; the state is then the last good one.
    pub fn advance(&mut self) -> Result<Progress, DrapeError> {
        let stage = self.stage.stage();
        match stage {
            Stage::Sewing => self.sew()?,
            Stage::Swinging => self.swing()?,
            Stage::Settling => self.step_to_rest()?,
            Stage::Finished => return Ok(self.progress()),
        }
        let progress = self.progress();
        self.log(stage, &progress);
        Ok(progress)
    }

    /// Tells the log about a step that was taken in a stage.
    fn log(&self, taken: Stage, progress: &Progress) {
        let Progress {
            stage,
            step,
            gap,
            residual,
            ..
        } = *progress;
        let mesh = self.level + 1;
        if stage == taken {
            tracing::debug!(?stage, mesh, step, gap, residual, "step of the garment");
        } else {
            tracing::info!(?stage, mesh, after = ?taken, residual, "stage of the garment");
        }
    }

    /// Sets the progress to a share of the present level. A level takes about a quarter of the time of the next.
    fn set_progress(&mut self, share: f64) {
        let after = 4f64.powi(self.level as i32 + 1 - self.setup.levels.len() as i32);
        let before = if self.level == 0 { 0.0 } else { 0.25 * after };
        self.share = self.share.max(before + (after - before) * share);
    }

    fn sew(&mut self) -> Result<(), DrapeError> {
        let StageState::Sewing(sewing) = &mut self.stage else {
            return Ok(());
        };
        self.forgot_contacts = false;
        let Simulation { system, state, .. } = &mut self.simulation;
        sewing.advance(system, state, &mut self.workspace)?;
        let (gap, closed, steps) = (sewing.last_gap(), sewing.closed(), sewing.steps());
        let start = 0.3;
        self.set_progress(0.5 * (1.0 - (gap / start).min(1.0)));
        if closed {
            return self.merge();
        }
        self.forget_after(steps, SEWING_SPAN);
        Ok(())
    }

    fn swing(&mut self) -> Result<(), DrapeError> {
        if self.recess > 0.0 {
            return self.grow_body();
        }
        let StageState::Swinging(Swinging { damping, attempts }) = &mut self.stage else {
            return Ok(());
        };
        self.forgot_contacts = false;
        let Simulation { system, state, .. } = &mut self.simulation;
        damping.advance(system, state, &mut self.swing_workspace)?;
        let shown = 0.5 + 0.2 * damping.share();
        let rounds = damping.rounds() as usize;
        if damping.finished() {
            let cut_short = damping.left_crossings(&self.swing_workspace);
            attempts.swings += 1;
            let settings = self.setup.rest_on(self.level);
            self.stage = StageState::Settling(Settling {
                cut_short,
                ..Settling::near(settings, *attempts)
            });
            self.tally = self.tally.then(self.swing_workspace.cloth_tally());
            self.swing_workspace = SwingWorkspace::default();
            self.forget_contacts();
        } else {
            self.forget_after(rounds, SWINGING_SPAN);
        }
        self.set_progress(shown);
        if rounds.is_multiple_of(FALL_ROUNDS) {
            self.refuse_fallen()?;
        }
        Ok(())
    }

    /// Takes a step of pseudo-transient continuation, then goes on to another swing, to the next finer level or to
    /// the end where its time has come.
    fn step_to_rest(&mut self) -> Result<(), DrapeError> {
        let is_finest = self.is_finest();
        let StageState::Settling(settling) = &mut self.stage else {
            return Ok(());
        };
        self.forgot_contacts = false;
        let continuation = &mut settling.continuation;
        let Simulation { system, state, .. } = &mut self.simulation;
        continuation.advance(system, state, &mut self.workspace)?;
        let (residual, steps) = (continuation.residual(), continuation.steps());
        settling.fall.note(residual, steps);
        if is_finest && continuation.is_used_up() {
            settling.fall.end(residual);
        }
        let failed = continuation.is_used_up() || settling.fall.is_stuck;
        let finished = continuation.finished() || settling.fall.is_stuck;
        if failed && settling.attempts.is_sunk {
            return self.sew_round_thinner_body();
        }
        if settling.cut_short && self.workspace.contacts.cloth.is_in_order() {
            settling.cut_short = false;
            if settling.attempts.swings < MAX_SWINGS {
                self.swing_again();
                return Ok(());
            }
        }
        let decades = (1.0 / residual.max(1e-9)).log10() / 3.0;
        self.set_progress((0.7 + 0.3 * decades.clamp(0.0, 1.0)).min(0.99));
        if finished && !is_finest {
            return self.refine();
        }
        if is_finest {
            self.finish();
        }
        match self.stage {
            StageState::Finished(_) => self.forget_contacts(),
            _ => self.forget_after(steps, SETTLING_SPAN),
        }
        if steps.is_multiple_of(FALL_STEPS) {
            self.refuse_fallen()?;
        }
        Ok(())
    }

    /// Whether it was given up because its net force stayed far above its weight.
    pub fn is_stuck(&self) -> bool {
        matches!(&self.stage, StageState::Finished(settling) if settling.fall.is_stuck)
    }

    /// Refines contact samples at crossings of the body on the finest mesh, and finishes a garment at rest.
    fn finish(&mut self) {
        let StageState::Settling(settling) = &mut self.stage else {
            return;
        };
        let is_stuck = settling.fall.is_stuck;
        let finished = settling.continuation.finished() || is_stuck;
        let residual = settling.continuation.residual();
        if !is_stuck && (finished || residual < settling.attempts.check_below) {
            settling.attempts.check_below = NEXT_CHECK * residual;
            let Simulation { system, state, .. } = &mut self.simulation;
            let crossing = body_crossings(system, state);
            if !crossing.is_empty() && settling.attempts.refinements < MAX_REFINEMENTS {
                settling.attempts.refinements += 1;
                for triangle in crossing {
                    state.refine_contact(system, triangle);
                }
                if finished {
                    let settings = self.setup.rest;
                    settling
                        .continuation
                        .continue_to(settings.residual, settings.steps / 4);
                    return;
                }
            }
        }
        if !finished {
            return;
        }
        self.stage = StageState::Finished(settling.clone());
        self.share = 1.0;
    }

    /// Starts another swing, after the tangle that ended the last one is undone.
    fn swing_again(&mut self) {
        let StageState::Settling(settling) = &self.stage else {
            return;
        };
        self.steps[1] += settling.continuation.steps();
        let attempts = settling.attempts;
        self.simulation.state.cloth = ClothMemory::default();
        self.stage = self.swinging(attempts);
        let cloth = &mut self.workspace.contacts.cloth;
        self.tally = self.tally.then(std::mem::take(&mut cloth.tally));
        self.forget_contacts();
    }

    /// A swing of the merged cloth of the present level.
    fn swinging(&self, attempts: Attempts) -> StageState {
        let damping = match self.level {
            0 => KineticDamping::new(&self.system),
            _ => KineticDamping::carried(&self.system),
        };
        StageState::Swinging(Swinging { damping, attempts })
    }

    /// Continues on the next finer level with the shape reached.
    fn refine(&mut self) -> Result<(), DrapeError> {
        let finer = self.setup.levels[self.level + 1].clone();
        self.replace_mesh(&finer)?;
        self.steps = self.steps();
        self.level += 1;
        self.begin()
    }

    /// Merges the stitched vertices, and starts gravity and friction.
    fn merge(&mut self) -> Result<(), DrapeError> {
        let StageState::Sewing(sewing) = &self.stage else {
            return Ok(());
        };
        let (gap, steps) = (sewing.last_gap(), sewing.steps());
        let attempts = Attempts {
            is_sunk: self.is_sunk(),
            ..Attempts::default()
        };
        let edits = vec![
            WorldEdit::SetEnvironment(Box::new(self.setup.worn_environment(self.recess))),
            WorldEdit::Merge(self.setup.levels[self.level].seams(self.garment)),
        ];
        self.simulation.edit_all(edits, MeetingPoint::Midpoint)?;
        self.simulation.reset_motion();
        self.steps[0] += steps;
        self.gap_before_merging = gap;
        self.stage = self.swinging(attempts);
        self.clear_caches();
        self.set_progress(0.5);
        Ok(())
    }

    /// The simulation of the present stage, to be stepped in time. The cloth is merged unless the stage is
    /// [`Stage::Sewing`].
    pub fn into_simulation(self) -> Simulation {
        self.simulation
    }

    /// The garment at rest, to be predicted and corrected under other rest shapes; none before [`Stage::Finished`].
    pub fn into_equilibrium(self) -> Option<Equilibrium> {
        let StageState::Finished(settling) = self.stage else {
            return None;
        };
        let triangles = self.simulation.map().triangles.iter();
        Some(Equilibrium {
            merged: triangles.map(|&t| t as usize).collect(),
            settings: self.setup.rest,
            system: self.simulation.system,
            state: self.simulation.state,
            workspace: self.workspace,
            continuation: settling.continuation,
        })
    }

    /// Measures the present state, with the strain of those triangles that count in the setup.
    pub fn measure(&self) -> Measures {
        let counted = match self.system.topology.triangles.len() == self.setup.counted.len() {
            true => &self.setup.counted[..],
            false => &[],
        };
        measure(
            &self.system,
            &self.state,
            &mut Workspace::default(),
            counted,
        )
    }

    /// Whether the next detection of contacts depends on no earlier one, so that another process can go on from here to
    /// the same bytes.
    pub fn is_checkpoint(&self) -> bool {
        self.forgot_contacts
    }

    /// Most steps to the next checkpoint; the end of a stage is one, too.
    pub fn steps_to_checkpoint(&self) -> usize {
        if self.forgot_contacts {
            return 0;
        }
        let (steps, span) = match &self.stage {
            StageState::Sewing(sewing) => (sewing.steps(), SEWING_SPAN),
            StageState::Swinging(swinging) => (swinging.damping.rounds() as usize, SWINGING_SPAN),
            StageState::Settling(settling) | StageState::Finished(settling) => {
                (settling.continuation.steps(), SETTLING_SPAN)
            }
        };
        span - steps % span
    }

    /// Forgets contacts when `span` divides the number of steps of a stage.
    fn forget_after(&mut self, steps: usize, span: usize) {
        if steps.is_multiple_of(span) {
            self.forget_contacts();
        }
    }

    /// Clears the search structures of contacts.
    fn forget_contacts(&mut self) {
        self.workspace.contacts.forget();
        self.swing_workspace.forget_contacts();
        self.forgot_contacts = true;
    }

    /// Clears all caches, for another cloth.
    fn clear_caches(&mut self) {
        self.tally = self.cloth_tally();
        self.workspace = Workspace::default();
        self.swing_workspace = SwingWorkspace::default();
        self.forgot_contacts = true;
    }
}

/// Triangles of the cloth that cross a solid surface by exact predicates, ascending.
fn body_crossings(system: &System, state: &State) -> Vec<u32> {
    let mesh = system.mesh(&state.positions);
    let mut crossing: Vec<u32> = Vec::new();
    for collider in system.colliders.iter() {
        let pairs = collider.at(state.time).crossings(&mesh);
        crossing.extend(pairs.iter().map(|pair| pair[0]));
    }
    crossing.sort_unstable();
    crossing.dedup();
    crossing
}
