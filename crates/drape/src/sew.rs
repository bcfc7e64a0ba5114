//! Sewing: springs along the seams draw the panels together round the body until the seams can be merged, by damped
//! implicit Euler without gravity and friction.
//!
//! # Decided with
//! - [`crate::garment::GarmentLevel::seams`]: the pairs of vertices that are sewn;
//! - [`crate::laws::elastic::ElasticLaw`], [`crate::elastic::ElasticCouplings`]: law of the pull; the springs
//!   of all pairs;
//! - [`crate::step`] (`implicit_euler`): a step: speed limit, drag;
//! - [`crate::garment::GarmentSetup::sewing_environment`]: no gravity, no friction, panels apart by layers;
//! - [`crate::garment::GarmentRun::merge`]: closed seams merged;
//! - [`crate::world`] (`present.rs`, `closed_pairs`): closed attachments of a scene.

use crate::laws::elastic::ElasticLaw;
use crate::laws::membrane::Curvature;
use crate::step::{StepSettings, step_in_time};
use crate::{DrapeError, LinearSolver, NewtonSettings, PcgLimits, State, System, Workspace};
use serde::{Deserialize, Serialize};

/// Settings of sewing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SewSettings {
    /// Largest gap of a seam at which its sides are merged (m).
    pub merge_within: f64,
    /// Most steps.
    pub steps: usize,
}

impl Default for SewSettings {
    /// 1 mm, within 600 steps.
    fn default() -> Self {
        Self {
            merge_within: 1e-3,
            steps: 600,
        }
    }
}

/// A run of sewing.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SewRun {
    settings: SewSettings,
    /// The stitched vertex pairs of the level; not saved.
    #[serde(skip)]
    stitches: Vec<[u32; 2]>,
    stiffness: f64,
    force: f64,
    steps: usize,
    #[serde(with = "toile_fabric::exact")]
    gap: f64,
    #[serde(with = "toile_fabric::exact")]
    best_gap: f64,
    waited: usize,
}

/// Step in time while sewing (s).
const STEP: f64 = 1.0 / 60.0;
/// Drag while sewing (1/s): motion dies out in a few tenths of a second.
const DRAG: f64 = 5.0;
/// Speed limit while sewing (m/s): 20 mm a step, less than the body's thinnest half limb.
const SPEED_LIMIT: f64 = 1.2;
/// Strain of the cloth beside a seam under the largest force of its springs, before that force is raised.
const PULL_STRAIN: f64 = 0.2;
/// Square of the edge of an equilateral triangle over its area, 4 / sqrt(3).
const EDGE_SQUARED_PER_AREA: f64 = 2.31;
/// Steps without progress after which the springs get stiffer and stronger.
const PATIENCE: usize = 12;

impl SewRun {
    /// Starts sewing: replaces the elastics of the system by springs at the stitches. Their stiffness follows from the
    /// stretch stiffness of the cloth, their largest force also from the edge length of the mesh.
    pub fn new(system: &mut System, stitches: Vec<[u32; 2]>, settings: SewSettings) -> Self {
        let area: f64 = system.rest.elements.iter().map(|e| e.area).sum();
        let edge = (area / system.rest.elements.len().max(1) as f64 * EDGE_SQUARED_PER_AREA).sqrt();
        let count = 2 * system.materials.list.len().max(1);
        let stretch: f64 = system
            .materials
            .list
            .iter()
            .map(|m| m.stretch[0] + m.stretch[1])
            .sum::<f64>()
            / count as f64;
        let mut run = Self {
            settings,
            stitches,
            stiffness: 2.0 * stretch,
            force: PULL_STRAIN * stretch * edge,
            steps: 0,
            gap: f64::INFINITY,
            best_gap: f64::INFINITY,
            waited: 0,
        };
        run.set_elastics(system);
        run
    }

    /// Resumes a saved run: the stitches of its level become the elastics of the system again.
    pub(crate) fn resume(&mut self, system: &mut System, stitches: Vec<[u32; 2]>) {
        self.stitches = stitches;
        self.set_elastics(system);
    }

    fn set_elastics(&mut self, system: &mut System) {
        let law = ElasticLaw {
            stiffness: self.stiffness,
            largest_force: self.force,
        };
        system.couple(self.stitches.iter().map(|&ends| (ends, law)).collect());
    }

    /// Largest gap between two stitched vertices (m).
    pub fn gap(&self, state: &State) -> f64 {
        let gap =
            |&[a, b]: &[u32; 2]| (state.positions[a as usize] - state.positions[b as usize]).norm();
        self.stitches.iter().map(gap).fold(0.0, f64::max)
    }

    /// The largest gap after the last step (m).
    pub fn last_gap(&self) -> f64 {
        self.gap
    }

    /// Measures the largest gap without a step.
    pub fn measure_gap(&mut self, state: &State) {
        self.gap = self.gap(state);
    }

    /// Steps taken.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Whether every seam is close enough to be merged.
    pub fn closed(&self) -> bool {
        self.gap <= self.settings.merge_within
    }

    /// Takes one step.
    ///
    /// # Errors
    /// Seams still open after the allowed steps; a step that fails at every size.
    pub fn advance(
        &mut self,
        system: &mut System,
        state: &mut State,
        workspace: &mut Workspace,
    ) -> Result<(), DrapeError> {
        if self.steps >= self.settings.steps {
            return Err(DrapeError::SeamsOpen {
                gap_mm: self.gap * 1000.0,
                steps: self.steps,
            });
        }
        let settings = StepSettings {
            step: STEP,
            drag: DRAG,
            speed_limit: SPEED_LIMIT,
            newton: NewtonSettings {
                iterations: 2,
                tolerance: 0.0,
                longest_move: 1.2 * SPEED_LIMIT * STEP,
                curvature: Curvature::CONVEX,
                linear: LinearSolver::Iterative(PcgLimits {
                    tolerance: 0.05,
                    iterations: 150,
                }),
            },
        };
        step_in_time(system, state, workspace, &settings)?;
        self.steps += 1;
        self.gap = self.gap(state);
        if self.gap < 0.97 * self.best_gap {
            self.best_gap = self.gap;
            self.waited = 0;
        } else {
            self.waited += 1;
        }
        if self.waited >= PATIENCE {
            self.waited = 0;
            self.best_gap = self.gap;
            self.force *= 1.5;
            self.stiffness *= 1.5;
            self.set_elastics(system);
        }
        Ok(())
    }
}
