//! Edits of the pattern under a worn garment: other rest shapes, or another mesh of the same panels. It goes
//! on from where it hangs.

use super::stage::{Attempts, Settling};
use super::{GarmentLevel, GarmentRun, Stage, StageState};
use crate::DrapeError;
use crate::world::WorldEdit;
use toile_geometry::{Vec2, Vec3};

impl GarmentRun {
    /// Whether an edit of the pattern can be taken: the finest mesh is in hand and its seams are closed.
    pub fn takes_edits(&self) -> bool {
        self.is_finest() && self.stage.stage() != Stage::Sewing
    }

    /// Gives the triangles of the finest mesh other rest shapes, and those where strain counts. The cloth
    /// goes on from where it hangs, without velocity; contact samples keep where they stick.
    ///
    /// # Errors
    /// While it is sewn or on a coarser mesh; shapes that are too few, too many or without area. The garment
    /// is then as it was.
    pub fn reshape(&mut self, rest: Vec<[Vec2; 3]>, counted: Vec<bool>) -> Result<(), DrapeError> {
        self.refuse_edit()?;
        let level = &self.setup.levels[self.level];
        let [given, wanted] = [rest.len(), level.cloth.triangles.len()];
        if given != wanted {
            return Err(DrapeError::Scene {
                place: "the edited garment".to_owned(),
                what: format!("it has {given} rest shapes for {wanted} triangles"),
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
                self.begin_caches();
            }
        }
        self.setup.levels[self.level].cloth.rest = rest;
        self.setup.counted = counted;
        self.steps = self.steps();
        self.go_on_from_here();
        Ok(())
    }

    /// Puts another mesh of the same panels in the place of the finest one, and those of its triangles where
    /// strain counts. It takes over the shape by place in the panels; seams that are closed there are merged
    /// at once, others are sewn from there. Where cloth stuck and what strain it kept is let go.
    ///
    /// # Errors
    /// While it is sewn or on a coarser mesh; a mesh that cannot be simulated or has other panels. The
    /// garment is then as it was.
    pub fn remesh(&mut self, level: GarmentLevel, counted: Vec<bool>) -> Result<(), DrapeError> {
        self.refuse_edit()?;
        self.replace_mesh(&level)?;
        self.steps = self.steps();
        self.setup.levels[self.level] = level;
        self.setup.counted = counted;
        self.begin()?;
        self.go_on_from_here();
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

    /// What was done to bring the garment to rest is to be done again; the share of the way falls.
    fn go_on_from_here(&mut self) {
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
        self.warnings.clear();
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
    fn a_garment_made_anew_where_it_hangs_goes_on_from_a_checkpoint() {
        let mut run = GarmentRun::new(setup()).unwrap();
        for _ in 0..3 {
            run.advance().unwrap();
        }
        assert!(!run.is_checkpoint());
        // So narrow that the neighbours chosen for curvatures serve no more.
        let narrow = |shape: &[Vec2; 3]| shape.map(|p| Vec2::new(0.01 * p.x, p.y));
        let rest: Vec<_> = setup().levels[0].cloth.rest.iter().map(narrow).collect();
        run.reshape(rest, Vec::new()).unwrap();
        assert!(
            run.system.topology.bending.is_none(),
            "the structure was not made anew"
        );
        let checkpoint = run.checkpoint().unwrap();
        let mut resumed = GarmentRun::resume(setup(), checkpoint).unwrap();
        assert_eq!(resumed.system.topology.layout, run.system.topology.layout);
        for run in [&mut run, &mut resumed] {
            for _ in 0..3 {
                run.advance().unwrap();
            }
            // It is edited under the structure that it was made anew for.
            let rest = setup().levels[0].cloth.rest.clone();
            run.reshape(rest, Vec::new()).unwrap();
            for _ in 0..3 {
                run.advance().unwrap();
            }
        }
        assert!(resumed.state == run.state);
    }
}
