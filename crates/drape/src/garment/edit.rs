//! Edits of the pattern of a worn garment: other rest shapes, or another mesh of the same panels. The simulation goes
//! on from the present positions.
//!
//! # Decided with
//! - [`crate::garment::GarmentRun::takes_edits`], [`crate::garment::GarmentRun::restart_stage`]: when an edit
//!   is taken; stages begun again;
//! - [`crate::world::Simulation::reshape`], [`crate::system::System::reshaped`]: other rest shapes of the
//!   same mesh;
//! - [`crate::contact_refinement`]: samples under other rest shapes;
//! - [`crate::world::World::replace_mesh`] (`edit.rs`), [`crate::carry::Carry`]: another mesh and its shape;
//! - [`crate::equilibrium::Equilibrium`]: a prediction of the new rest; tests alone ask for it.

use super::stage::{Attempts, Settling};
use super::{GarmentLevel, GarmentRun, Stage, StageState};
use crate::DrapeError;
use crate::world::WorldEdit;
use toile_geometry::{Vec2, Vec3};

impl GarmentRun {
    /// Whether the pattern may be edited: on the finest mesh, once its seams are merged.
    pub fn takes_edits(&self) -> bool {
        self.is_finest() && self.stage.stage() != Stage::Sewing
    }

    /// Replaces the rest shapes of the finest mesh, and the flags of the triangles whose strain counts. The cloth goes
    /// on from its present positions without velocity; friction anchors stay.
    ///
    /// # Errors
    /// A garment that is sewn or on a coarser mesh; too few or too many shapes, or one without area. The garment is
    /// then unchanged.
    pub fn reshape(&mut self, rest: Vec<[Vec2; 3]>, counted: Vec<bool>) -> Result<(), DrapeError> {
        self.refuse_edit()?;
        let level = &self.setup.levels[self.level];
        let [given, count] = [rest.len(), level.cloth.triangles.len()];
        if given != count {
            return Err(DrapeError::Scene {
                place: "the edited garment".to_owned(),
                what: format!("it has {given} rest shapes for {count} triangles"),
                remedy: "give one for each, or mesh it again".to_owned(),
            });
        }
        let before = level.cloth.rest.clone();
        let edit = WorldEdit::Reshape(self.garment, rest.clone());
        match self.simulation.edit(edit)?.is_restructured {
            false => {
                self.simulation.state.velocities.fill(Vec3::zeros());
                self.made_for.get_or_insert(before);
            }
            true => {
                self.simulation.reset_motion();
                self.made_for = Some(rest.clone());
                self.clear_caches();
            }
        }
        self.setup.levels[self.level].cloth.rest = rest;
        self.setup.counted = counted;
        self.steps = self.steps();
        self.restart_stage();
        Ok(())
    }

    /// Replaces the finest mesh by another one of the same panels, and the flags of the triangles whose strain counts.
    /// Positions are interpolated at the same points of the panels. Seams that are closed there are merged at once,
    /// others are sewn. Friction anchors and internal strain are lost.
    ///
    /// # Errors
    /// A garment that is sewn or on a coarser mesh; a mesh that cannot be simulated or has other panels. The garment is
    /// then unchanged.
    pub fn remesh(
        &mut self,
        mut level: GarmentLevel,
        counted: Vec<bool>,
    ) -> Result<(), DrapeError> {
        self.refuse_edit()?;
        level.leave_out_restitution();
        self.replace_mesh(&level)?;
        self.steps = self.steps();
        self.setup.levels[self.level] = level;
        self.setup.counted = counted;
        self.begin()?;
        self.restart_stage();
        Ok(())
    }

    fn refuse_edit(&self) -> Result<(), DrapeError> {
        let what = match self.stage.stage() {
            _ if self.takes_edits() => return Ok(()),
            Stage::Sewing => "it is still being sewn",
            _ => "it still hangs on a coarser mesh",
        };
        Err(DrapeError::Scene {
            place: "the edited garment".to_owned(),
            what: what.to_owned(),
            remedy: "edit it once the seams of its finest mesh are closed".to_owned(),
        })
    }

    /// Restarts the stage with its full budget of attempts and steps; the progress falls back accordingly.
    fn restart_stage(&mut self) {
        self.share = match &self.stage {
            StageState::Sewing(_) => 0.0,
            StageState::Swinging(_) => {
                self.stage = self.swinging(Attempts::default());
                0.5
            }
            StageState::Settling(_) | StageState::Finished(_) => {
                let settings = self.setup.rest_on(self.level);
                self.stage = StageState::Settling(Settling::near(settings, Attempts::default()));
                0.7
            }
        };
        self.findings.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cloth, ContactSettings, GarmentSetup, Material, RestSettings, SewSettings};
    use toile_geometry::TriangleMesh;

    /// A sheet of 8 x 8 squares of 20 mm that falls.
    fn setup() -> GarmentSetup {
        let mut mesh = TriangleMesh::default();
        for v in 0..81u32 {
            let [x, y] = [v % 9, v / 9].map(|k| 0.02 * f64::from(k));
            mesh.positions.push(Vec3::new(x, y, 0.1 * x * y));
        }
        for q in 0..64u32 {
            let a = q / 8 * 9 + q % 8;
            mesh.triangles
                .extend([[a, a + 1, a + 10], [a, a + 10, a + 9]]);
        }
        GarmentSetup {
            levels: vec![GarmentLevel {
                cloth: Cloth::from_mesh("sheet", &mesh, Material::default()).unwrap(),
                ..GarmentLevel::default()
            }],
            counted: Vec::new(),
            colliders: Vec::new(),
            contact: ContactSettings::default(),
            gravity: Vec3::new(0.0, -9.81, 0.0),
            sew: SewSettings::default(),
            rest: RestSettings::default(),
        }
    }

    #[test]
    fn a_garment_compiled_again_where_it_hangs_goes_on_from_a_checkpoint() {
        let mut run = GarmentRun::new(setup()).unwrap();
        for _ in 0..3 {
            run.advance().unwrap();
        }
        assert!(!run.is_checkpoint());
        // So narrow that the neighbours chosen for curvatures are ill-conditioned.
        let narrow = |shape: &[Vec2; 3]| shape.map(|p| Vec2::new(0.01 * p.x, p.y));
        let rest: Vec<_> = setup().levels[0].cloth.rest.iter().map(narrow).collect();
        run.reshape(rest, Vec::new()).unwrap();
        assert!(
            run.system.topology.bending.is_none(),
            "the structure was not compiled again"
        );
        let checkpoint = run.checkpoint().unwrap();
        let mut resumed = GarmentRun::resume(setup(), checkpoint).unwrap();
        assert_eq!(resumed.system.topology.layout, run.system.topology.layout);
        for run in [&mut run, &mut resumed] {
            for _ in 0..3 {
                run.advance().unwrap();
            }
            // An edit under the structure that was compiled again.
            let rest = setup().levels[0].cloth.rest.clone();
            run.reshape(rest, Vec::new()).unwrap();
            for _ in 0..3 {
                run.advance().unwrap();
            }
        }
        assert!(resumed.state == run.state);
    }
}
