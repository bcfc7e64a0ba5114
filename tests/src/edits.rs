//! Edits of a pattern whose garment hangs: what predicting, correcting and hanging anew cost, and how far
//! apart they end.

use crate::random::Random;
use crate::root;
use std::path::PathBuf;
use std::sync::Arc;
use toile_drape::{Equilibrium, GarmentRun, GarmentSetup, Stage, Workspace, residual};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3};
use toile_pattern::plan;
use toile_session::{Command, GarmentJob, Quality, RestChange, Session, Silent, cpu_seconds};

/// A garment at rest with the session of its pattern.
pub struct Hung {
    session: Session,
    job: GarmentJob,
    equilibrium: Equilibrium,
    /// Processor time of its drape from the start (s).
    pub fresh_cpu: f64,
}

/// What one edit took, and where it led.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Processor time of taking the edit, draft to rest data (s), of the prediction with it, and of going on to
    /// rest from there.
    pub taking_cpu: f64,
    /// Likewise.
    pub prediction_cpu: f64,
    /// Likewise.
    pub correction_cpu: f64,
    /// Net force over weight under the new shapes: where it hung, where it was predicted, in the end.
    pub residuals: [f64; 3],
    /// Share of the predicted step that was taken.
    pub share: f64,
    /// Whether it came to rest.
    pub at_rest: bool,
    /// Pairs of its triangles that cross in the end.
    pub crossings: usize,
    /// Structures of matrices that were worked out.
    pub structures: usize,
    /// Whether triangles and what hangs on them stayed the same ones.
    pub shares_topology: bool,
    /// Where it ended.
    pub ends: Ends,
}

/// Two measures of a garment at rest (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ends {
    /// Height of the lowest vertex.
    pub hem: f64,
    /// Length of its section a hand above the hem.
    pub girth: f64,
}

/// Height above the hem where the girth is taken (m).
const ABOVE_HEM: f64 = 0.15;

impl Ends {
    /// Of a mesh.
    pub fn of(mesh: &TriangleMesh) -> Self {
        let hem = mesh
            .positions
            .iter()
            .map(|p| p.y)
            .fold(f64::INFINITY, f64::min);
        let level = hem + ABOVE_HEM;
        let mut girth = 0.0;
        for t in 0..mesh.triangles.len() {
            let corners = mesh.corners(t);
            let cut = |(a, b): (Vec3, Vec3)| {
                let crosses = (a.y > level) != (b.y > level);
                crosses.then(|| a + (b - a) * ((level - a.y) / (b.y - a.y)))
            };
            let [a, b, c] = corners;
            let points: Vec<Vec3> = [(a, b), (b, c), (c, a)]
                .into_iter()
                .filter_map(cut)
                .collect();
            if let [from, to] = points[..] {
                girth += (to - from).norm();
            }
        }
        Self { hem, girth }
    }
}

fn words(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn cpu() -> f64 {
    cpu_seconds().unwrap_or(f64::NAN)
}

/// Drapes a garment to rest.
pub fn draped(setup: GarmentSetup) -> Result<GarmentRun, String> {
    let mut run = GarmentRun::new(setup).map_err(words)?;
    while run.progress().stage != Stage::Finished {
        run.advance().map_err(words)?;
    }
    Ok(run)
}

impl Hung {
    /// A shipped pattern by its file name, draped.
    pub fn new(pattern: &str, quality: Quality) -> Result<Self, String> {
        let path: PathBuf = root().join("patterns").join(pattern);
        let mut session = Session::new();
        for command in [Command::open(path), Command::SetQuality { quality }] {
            session.execute(command, &mut Silent).map_err(words)?;
        }
        let job = session.garment_setup().map_err(words)?;
        let start = cpu();
        let run = draped(job.setup.clone())?;
        let fresh_cpu = cpu() - start;
        let equilibrium = run.into_equilibrium().ok_or("it is not at rest")?;
        Ok(Self {
            session,
            job,
            equilibrium,
            fresh_cpu,
        })
    }

    /// Moves a random point of a random sewn panel's sheet by `size` (m) in a random direction, and goes on to
    /// rest. Points that cannot be moved, and edits whose panels need another mesh, are passed over.
    pub fn edit(&mut self, random: &mut Random, size: f64) -> Result<Trial, String> {
        for _ in 0..200 {
            let evaluation = self.session.evaluation();
            let points: Vec<_> = (evaluation.pattern().sheets.iter())
                .flat_map(|sheet| sheet.points.iter().map(|p| p.id))
                .collect();
            let Some(&point) = random.one_of(&points) else {
                break;
            };
            let turn = random.between(0.0, std::f64::consts::TAU);
            let Some(at) = evaluation.point(point) else {
                continue;
            };
            let to = at + Vec2::new(turn.cos(), turn.sin()) * size;
            let Ok(edits) = plan::move_point(&evaluation, point, to) else {
                continue;
            };
            let label = "Move".to_owned();
            let edit = Command::Edit { edits, label };
            if self.session.execute(edit, &mut Silent).is_err() {
                continue;
            }
            let start = cpu();
            match self.session.garment_edit(&self.job) {
                Ok(edit) if edit.change == RestChange::Shapes => {
                    let morphing = cpu() - start;
                    return self.follow(edit.job, morphing);
                }
                _ => {
                    let undo = Command::Undo;
                    self.session.execute(undo, &mut Silent).map_err(words)?;
                }
            }
        }
        Err("no point of the pattern can be moved so".to_owned())
    }

    fn follow(&mut self, job: GarmentJob, morphing: f64) -> Result<Trial, String> {
        let level = job.setup.levels.last().ok_or("it has no mesh")?;
        let rest = level.cloth.rest.clone();
        let hanging = self.equilibrium.state().clone();
        let topology = self.equilibrium.system().topology.clone();
        let structures = self.equilibrium.structures();
        // The clock ticks in hundredths of a second.
        const REPEATS: usize = 10;
        let start = cpu();
        for _ in 1..REPEATS {
            self.equilibrium.predict(&rest).map_err(words)?;
        }
        let prediction = self.equilibrium.predict(&rest).map_err(words)?;
        let prediction_cpu = (cpu() - start) / REPEATS as f64;
        let system = prediction.system().clone();
        let start = cpu();
        for _ in 0..REPEATS {
            self.equilibrium.reshaped(&rest).map_err(words)?;
        }
        let taking_cpu = morphing + (cpu() - start) / REPEATS as f64;
        let mut predicted = hanging.clone();
        predicted.positions = prediction.positions().to_vec();
        let mut workspace = Workspace::default();
        let before = residual(&system, &hanging, &mut workspace);
        let after = residual(&system, &predicted, &mut workspace);
        let share = prediction.share();
        let shares_topology = Arc::ptr_eq(&topology, &system.topology);
        let start = cpu();
        self.equilibrium.take(prediction);
        let at_rest = self.equilibrium.correct(2000).map_err(words)?;
        let correction_cpu = cpu() - start;
        let mesh = system.mesh(&self.equilibrium.state().positions);
        let ends = Ends::of(&mesh);
        self.job = job;
        Ok(Trial {
            taking_cpu,
            prediction_cpu,
            correction_cpu,
            residuals: [before, after, self.equilibrium.residual()],
            share,
            at_rest,
            crossings: SurfaceTree::new(mesh).self_intersections().len(),
            structures: self.equilibrium.structures() - structures,
            shares_topology,
            ends,
        })
    }

    /// What the pattern as it is now is draped from, its first vertices moved by up to 10 um by a seed.
    pub fn fresh_setup(&mut self, seed: u64) -> Result<GarmentSetup, String> {
        let mut setup = self.session.garment_setup().map_err(words)?.setup;
        let mut random = Random(seed);
        let positions = setup
            .levels
            .iter_mut()
            .flat_map(|level| &mut level.cloth.positions);
        for place in positions {
            *place += Vec3::from_fn(|_, _| random.between(-1e-5, 1e-5));
        }
        Ok(setup)
    }
}
