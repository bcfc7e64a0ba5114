//! Hard scenes run to their ends, and what is measured on the way.

use super::hard_scenes::HardScene;
use toile_drape::{MethodSettings, SceneRun};
use toile_geometry::{TriangleMesh, Vec3};

/// Where everything lies at the end.
pub struct End<'a> {
    /// The run.
    pub run: &'a SceneRun,
    /// The surface of every object, in the order of the scene.
    pub meshes: Vec<TriangleMesh>,
    /// The farthest that any vertex of cloth was from its start (m).
    pub farthest: f64,
}

impl End<'_> {
    /// Places of all cloth (m).
    pub fn cloth(&self) -> &[Vec3] {
        &self.run.state.positions
    }

    /// Mean place of an object (m).
    pub fn middle(&self, object: usize) -> Vec3 {
        let places = &self.meshes[object].positions;
        places.iter().sum::<Vec3>() / places.len() as f64
    }
}

/// What a run showed.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Pairs of cloth triangles that cross, exactly: most on the way, and at the end.
    pub crossings: [usize; 2],
    /// Pairs of a cloth triangle and a body's at the end.
    pub body_crossings: usize,
    /// How deep a vertex is in a body at the end (m).
    pub penetration: f64,
    /// Whether the end shows what the scene is about.
    pub shown: bool,
    /// How far the energy rose above that when nothing drove any more (J).
    pub energy_rise: f64,
    /// How far it may, as a share of the next.
    pub rise_allowed: f64,
    /// What energies are compared with (J): the weight at 0.1 m, the motion at the start, or motion
    /// and strain when nothing drives any more.
    pub energy_scale: f64,
    /// Change of momentum over that of the faster half of the cloth, linear and angular.
    pub momentum: [f64; 2],
    /// Steps taken.
    pub steps: usize,
    /// What contact of cloth with cloth counted.
    pub tally: toile_drape::collision::Tally,
}

impl Outcome {
    /// What does not hold, in words.
    pub fn faults(&self) -> Vec<String> {
        let rise = self.energy_rise / self.energy_scale;
        let faults = [
            (
                self.crossings[0] > 0,
                format!(
                    "{} crossings of cloth on the way, {} at the end",
                    self.crossings[0], self.crossings[1]
                ),
            ),
            (
                self.body_crossings > 0,
                format!("{} crossings of a body", self.body_crossings),
            ),
            (
                self.penetration > 0.0,
                format!("{:.1e} m within a body", self.penetration),
            ),
            (
                rise > self.rise_allowed,
                format!("energy rises by {rise:.1e}"),
            ),
            (
                self.tally.looks <= 10,
                "contact was hardly looked for".to_owned(),
            ),
            (
                !self.shown,
                "the end does not show what the scene is about".to_owned(),
            ),
        ];
        let faults = faults.into_iter().filter(|(wrong, _)| *wrong);
        faults.map(|(_, what)| what).collect()
    }
}

/// What grips that cloth held back may be late by (s).
const LATE: f64 = 0.02;

/// Momentum and angular momentum about the origin.
fn momenta(run: &SceneRun) -> [Vec3; 2] {
    let state = &run.state;
    let mut sums = [Vec3::zeros(); 2];
    for ((x, v), m) in state
        .positions
        .iter()
        .zip(&state.velocities)
        .zip(&run.system.rest.mass)
    {
        sums[0] += v * *m;
        sums[1] += x.cross(v) * *m;
    }
    sums
}

/// Runs a scene to its end.
pub fn run(hard: HardScene) -> (SceneRun, Outcome) {
    let mut run = SceneRun::new(&hard.scene, MethodSettings::build).expect("a sound scene");
    let mut first = 0;
    for (object, velocity) in hard.velocities.iter().enumerate() {
        let count = hard.scene.objects[object].mesh.positions.len();
        run.state_mut().velocities[first..first + count].fill(*velocity);
        first += count;
    }
    let mass: f64 = run.system.rest.mass.iter().sum();
    let motion = run.state.kinetic_energy(&run.system);
    let mut outcome = Outcome {
        energy_scale: if motion > 0.0 {
            motion
        } else {
            mass * 9.81 * 0.1
        },
        ..Outcome::default()
    };
    let start = momenta(&run);
    let places = run.state.positions.clone();
    let mut farthest = 0.0;
    let driven = hard.driven_until > 0.0;
    let mut level = if driven { f64::INFINITY } else { run.energy() };
    while !run.finished() {
        run.advance().expect("a step that succeeds");
        outcome.steps += 1;
        // Grips that cloth held back arrive a little later.
        if !driven || run.state.time >= hard.driven_until + LATE {
            let energy = run.energy();
            if level.is_infinite() {
                level = energy;
                let weight = run.state.positions.iter().zip(&run.system.rest.mass);
                let fallen: f64 = weight
                    .map(|(x, m)| m * run.system.control.gravity.dot(x))
                    .sum();
                outcome.energy_scale = outcome.energy_scale.max(energy + fallen);
            }
            outcome.energy_rise = outcome.energy_rise.max(energy - level);
        }
        if motion > 0.0 || outcome.steps.is_multiple_of(8) {
            outcome.crossings[0] = outcome.crossings[0].max(run.crossings());
        }
        let ways = run.state.positions.iter().zip(&places);
        farthest = ways.map(|(x, p)| (x - p).norm()).fold(farthest, f64::max);
    }
    let end = momenta(&run);
    let speed = (2.0 * motion / mass).sqrt();
    if speed > 0.0 {
        outcome.momentum = [
            (end[0] - start[0]).norm() / (mass * speed),
            (end[1] - start[1]).norm() / (mass * speed * 0.2),
        ];
    }
    outcome.tally = run.cloth_tally().unwrap_or_default();
    let measures = run.measure();
    outcome.crossings[1] = measures.self_intersections;
    outcome.crossings[0] = outcome.crossings[0].max(outcome.crossings[1]);
    outcome.body_crossings = measures.body_intersections;
    outcome.penetration = measures.penetration_max;
    outcome.shown = (hard.shown)(&End {
        run: &run,
        meshes: run.meshes(),
        farthest,
    });
    outcome.rise_allowed = hard.most_rise;
    (run, outcome)
}
