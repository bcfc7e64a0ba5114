//! Putting on a garment that is tight. Seams that close across a body larger than the garment draw the cloth into it:
//! there it may fold through itself so that it never comes to rest. Such a garment is sewn again from where it was placed,
//! round a thinner body, which then grows back and stretches the cloth from inside.

use super::GarmentRun;
use crate::laws::membrane::Curvature;
use crate::step::{StepSettings, step_in_time};
use crate::world::{MeetingPoint, Simulation, WorldEdit};
use crate::{DrapeError, LinearSolver, NewtonSettings, PcgLimits, PlacedSolid};

/// Share of the vertices of a sewn garment inside the body above which it is tight: the shipped patterns have less than
/// a fifth of it.
const SUNK: f64 = 0.01;
/// How much thinner the body is made, as a share of its height: 20 mm of an adult, less than a wrist's radius.
const RECESS: f64 = 0.012;
/// Steps in which it grows back.
const GROWTH_STEPS: f64 = 20.0;
/// A step of these (s), and the drag while it grows (1/s): the cloth follows the body and does not swing.
const STEP: f64 = 1.0 / 60.0;
const DRAG: f64 = 20.0;
/// Speed limit of the cloth meanwhile (m/s).
const SPEED_LIMIT: f64 = 1.2;

impl GarmentRun {
    /// Whether panels that were placed round the body as it is lie in it, now that they are sewn.
    pub(super) fn is_sunk(&self) -> bool {
        if self.level > 0 || self.recess > 0.0 {
            return false;
        }
        let Simulation { system, state, .. } = &self.simulation;
        let solids = system.colliders.iter().map(|solid| solid.at(state.time));
        let solids: Vec<PlacedSolid> = solids.collect();
        let inside = state.positions.iter().filter(|&&p| {
            let found = solids.iter().map(|solid| solid.distance(p));
            found.flatten().any(|(distance, _)| distance < 0.0)
        });
        inside.count() as f64 > SUNK * state.positions.len() as f64
    }

    /// How much thinner the body of a tight garment is made (m).
    fn largest_recess(&self) -> f64 {
        let solids = self.setup.colliders.iter();
        let heights = solids.filter_map(|solid| solid.mesh().bounds());
        RECESS
            * heights
                .map(|[low, high]| high.y - low.y)
                .fold(0.0, f64::max)
    }

    /// Starts sewing again from where the panels were placed, round a thinner body.
    pub(super) fn sew_round_thinner_body(&mut self) -> Result<(), DrapeError> {
        self.steps = self.steps();
        self.recess = self.largest_recess();
        let level = self.setup.levels[self.level].clone();
        self.replace_mesh(&level)?;
        self.simulation.state.positions = level.cloth.positions;
        self.simulation.reset_motion();
        self.begin()
    }

    /// One step of the merged garment while the body grows back.
    pub(super) fn grow_body(&mut self) -> Result<(), DrapeError> {
        let settings = StepSettings {
            step: STEP,
            drag: DRAG,
            speed_limit: SPEED_LIMIT,
            newton: NewtonSettings {
                iterations: 3,
                tolerance: 0.0,
                longest_move: SPEED_LIMIT * STEP,
                curvature: Curvature::CONVEX,
                linear: LinearSolver::Iterative(PcgLimits {
                    tolerance: 0.05,
                    iterations: 150,
                }),
            },
        };
        let Simulation { system, state, .. } = &mut self.simulation;
        step_in_time(system, state, &mut self.workspace, &settings)?;
        let growth = self.largest_recess() / GROWTH_STEPS;
        // What rounding leaves is no step.
        self.recess = match self.recess > 1.5 * growth {
            true => self.recess - growth,
            false => 0.0,
        };
        let environment = self.setup.worn_environment(self.recess);
        let edit = WorldEdit::SetEnvironment(Box::new(environment));
        self.simulation
            .edit_all(vec![edit], MeetingPoint::Midpoint)?;
        if self.recess == 0.0 {
            self.simulation.reset_motion();
            self.clear_caches();
        }
        self.forget_contacts();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::stage::StageState;
    use super::*;
    use crate::{
        Cloth, ContactSettings, GarmentLevel, GarmentSetup, Material, RestSettings, SewSettings,
        Stage,
    };
    use std::sync::Arc;
    use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

    /// A closed upright post with a radius of 10 cm, 80 cm high.
    fn post() -> Arc<SurfaceTree> {
        let (sides, rings) = (48u32, 33u32);
        let mut mesh = TriangleMesh::default();
        for k in 0..sides * rings {
            let angle = std::f64::consts::TAU * f64::from(k % sides) / f64::from(sides);
            let height = 0.8 * f64::from(k / sides) / f64::from(rings - 1);
            let (x, z) = (0.1 * angle.sin(), 0.1 * angle.cos());
            mesh.positions.push(Vec3::new(x, height, z));
        }
        for k in 0..sides * (rings - 1) {
            let next = k / sides * sides + (k + 1) % sides;
            let (above, beside) = (k + sides, next + sides);
            mesh.triangles
                .extend([[k, next, beside], [k, beside, above]]);
        }
        for (ring, height) in [(0, 0.0), (rings - 1, 0.8)] {
            let middle = mesh.positions.len() as u32;
            mesh.positions.push(Vec3::new(0.0, height, 0.0));
            for k in 0..sides {
                let [a, b] = [k, (k + 1) % sides].map(|k| ring * sides + k);
                mesh.triangles.push(match ring {
                    0 => [b, a, middle],
                    _ => [a, b, middle],
                });
            }
        }
        Arc::new(SurfaceTree::new(mesh))
    }

    /// Two sheets of a width (m), before and behind the post, sewn at both sides to a tube.
    fn tube(width: f64) -> GarmentSetup {
        let (columns, rows) = (12u32, 10u32);
        let mut mesh = TriangleMesh::default();
        let mut stitches = Vec::new();
        for side in [1.0, -1.0] {
            let first = mesh.positions.len() as u32;
            for k in 0..(columns + 1) * (rows + 1) {
                let x = width * (f64::from(k % (columns + 1)) / f64::from(columns) - 0.5);
                let y = 0.3 + 0.2 * f64::from(k / (columns + 1)) / f64::from(rows);
                mesh.positions.push(Vec3::new(side * x, y, 0.13 * side));
            }
            for row in 0..rows {
                for column in 0..columns {
                    let a = first + row * (columns + 1) + column;
                    let [b, c] = [a + 1, a + columns + 1];
                    mesh.triangles.extend([[a, b, c + 1], [a, c + 1, c]]);
                }
            }
        }
        for row in 0..=rows {
            let count = (columns + 1) * (rows + 1);
            let [left, right] = [row * (columns + 1), row * (columns + 1) + columns];
            stitches.extend([[left, count + right], [right, count + left]]);
        }
        GarmentSetup {
            levels: vec![GarmentLevel {
                cloth: Cloth::from_mesh("tube", &mesh, Material::default()).unwrap(),
                stitches,
                ..GarmentLevel::default()
            }],
            counted: Vec::new(),
            colliders: vec![post()],
            contact: ContactSettings {
                cloth_offset: 2e-3,
                ..ContactSettings::default()
            },
            gravity: Vec3::new(0.0, -9.81, 0.0),
            sew: SewSettings::default(),
            rest: RestSettings::default(),
        }
    }

    /// A garment whose seams are just closed, and whether it lies in the post.
    fn sewn(width: f64) -> (GarmentRun, bool) {
        let mut run = GarmentRun::new(tube(width)).unwrap();
        while run.progress().stage == Stage::Sewing {
            run.advance().unwrap();
        }
        let StageState::Swinging(swinging) = &run.stage else {
            panic!("it does not swing");
        };
        let is_sunk = swinging.attempts.is_sunk;
        (run, is_sunk)
    }

    #[test]
    fn a_tight_tube_is_sewn_round_a_thinner_post_which_grows_back() {
        let (mut run, is_sunk) = sewn(0.2);
        assert!(is_sunk);
        run.sew_round_thinner_body().unwrap();
        let [mut sewn, mut grown] = [0.0; 2];
        while run.progress().stage != Stage::Finished {
            run.advance().unwrap();
            match run.progress().stage {
                Stage::Sewing => sewn = run.recess.max(sewn),
                _ => grown = run.recess.max(grown),
            }
        }
        assert!((sewn - 0.0096).abs() < 1e-12, "{sewn}");
        assert!((grown - 0.0096).abs() < 1e-12, "{grown}");
        assert_eq!(run.recess, 0.0);
        assert_eq!(run.system.contact.offset, 4e-3);
        let measures = run.measure();
        assert!(measures.residual < 1e-2, "{}", measures.residual);
        assert_eq!(measures.self_intersections, 0);
    }

    /// A tight garment that may take so many steps to rest, run to its end, and how often its panels were sewn.
    fn run_to_end(steps: usize) -> (GarmentRun, usize) {
        let mut setup = tube(0.2);
        setup.rest.steps = steps;
        let mut run = GarmentRun::new(setup).unwrap();
        let (mut is_sewing, mut count) = (false, 0);
        while run.progress().stage != Stage::Finished {
            run.advance().unwrap();
            let was_sewing = is_sewing;
            is_sewing = run.progress().stage == Stage::Sewing;
            count += usize::from(is_sewing && !was_sewing);
        }
        (run, count)
    }

    #[test]
    fn a_tight_tube_that_uses_up_its_steps_is_sewn_round_a_thinner_post_once() {
        let (run, count) = run_to_end(1);
        assert!(run.progress().residual > run.setup.rest.residual);
        assert_eq!(count, 2);
    }

    #[test]
    fn a_tight_tube_that_comes_to_rest_or_is_held_by_a_hand_is_not_sewn_again() {
        let (mut run, count) = run_to_end(400);
        assert!(run.progress().residual <= run.setup.rest.residual);
        assert_eq!(count, 1);
        run.setup.rest.steps = 1;
        run.unsettle();
        while run.progress().stage != Stage::Finished {
            run.advance().unwrap();
            assert_ne!(run.progress().stage, Stage::Sewing);
        }
    }

    #[test]
    fn a_tube_with_ease_does_not_lie_in_the_post() {
        assert!(!sewn(0.34).1);
    }

    #[test]
    fn a_garment_saved_while_the_post_grows_goes_on_to_the_same_bytes() {
        let (mut run, _) = sewn(0.2);
        run.sew_round_thinner_body().unwrap();
        while run.progress().stage == Stage::Sewing {
            run.advance().unwrap();
        }
        for _ in 0..5 {
            run.advance().unwrap();
        }
        assert!(run.recess > 0.0);
        let mut resumed = GarmentRun::resume(tube(0.2), run.checkpoint().unwrap()).unwrap();
        for run in [&mut run, &mut resumed] {
            for _ in 0..30 {
                run.advance().unwrap();
            }
            assert_eq!(run.recess, 0.0);
        }
        assert!(resumed.state == run.state);
    }
}
