//! Hard cases: each method must end sound or with an error that says where.

use crate::clock::Clock;
use crate::stability::shake;
use crate::{LabError, MeshKind, freeze::ball, rectangle};
use serde::Serialize;
use std::ops::ControlFlow;
use std::sync::Arc;
use toile_drape::{
    Cloth, Collider, Material, MethodKind, State, System, SystemBuilder, Workspace, whole_energy,
};
use toile_geometry::{SurfaceTree, Vec2, Vec3};
use toile_session::Watcher;

/// The outcome of a method on a hard case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// It went through, finite, with no more energy and no farther away than it can have come.
    Sound,
    /// It stopped with an error that says what and where.
    Stopped,
    /// It was still sound when its time was up.
    Slow,
    /// It went on with a state no cloth can have.
    Unsound,
}

/// A method in a hard case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HardRun {
    /// The case.
    pub case: &'static str,
    /// The method.
    pub method: &'static str,
    /// How it went.
    pub outcome: Outcome,
    /// The error, or what the state looks like.
    pub detail: String,
}

/// A case ready to run.
struct Case {
    system: System,
    state: State,
    step: f64,
    /// A surface that takes the place of the model's after a third of the steps.
    jump: Option<Collider>,
}

/// Steps of a case, and processor time it may take (s).
const STEPS: usize = 30;
const BUDGET: f64 = 1.5;

/// A case by its name.
type Make = fn() -> Result<Case, LabError>;

const CASES: [(&str, Make); 10] = [
    ("compressed by 30 % at 1e8 N/m", compressed),
    ("stretched by 300 %", stretched),
    ("slivers", slivers),
    ("stiffness 1 to 1e4", stiffness_contrast),
    ("mass 1 to 1e3", mass_contrast),
    ("step of 0.2 s", long_step),
    ("a body that jumps", jumping_body),
    ("a coordinate that is no number", not_a_number),
    ("a velocity that is infinite", infinite),
    ("force field of 1990 on a thin limb", force_field),
];

fn cloth(
    kind: MeshKind,
    material: Material,
    place: impl Fn(Vec2) -> Vec3,
) -> Result<(Cloth, Vec<u32>), LabError> {
    let flat = rectangle(kind, Vec2::zeros(), Vec2::new(0.2, 0.1), [10, 5])?;
    let cloth = flat.cloth(material, place);
    Ok((cloth, flat.chosen(|p| p.x < 1e-9)))
}

fn case(cloth: &Cloth, pins: &[u32]) -> Result<Case, LabError> {
    let mut builder = SystemBuilder::new("cloth", cloth)?;
    for &pin in pins {
        builder.pinned[pin as usize] = true;
    }
    let system = builder.build();
    let mut state = State::at_rest(&system, cloth.positions.clone());
    shake(&system, &mut state, 1e-3);
    Ok(Case {
        system,
        state,
        step: 1.0 / 60.0,
        jump: None,
    })
}

fn hanging(p: Vec2) -> Vec3 {
    Vec3::new(p.y, -p.x, 0.0)
}

fn compressed() -> Result<Case, LabError> {
    let material = Material {
        stretch: [1e8; 2],
        shear: 3e7,
        ..Material::default()
    };
    let squeeze = |p: Vec2| Vec3::new(p.y, -0.7 * p.x, 0.0);
    let (cloth, mut pins) = cloth(MeshKind::Delaunay, material, squeeze)?;
    pins.extend(
        (0..cloth.positions.len() as u32).filter(|&v| cloth.positions[v as usize].y < -0.14 + 1e-9),
    );
    case(&cloth, &pins)
}

fn stretched() -> Result<Case, LabError> {
    let drawn = |p: Vec2| Vec3::new(p.y, -4.0 * p.x, 0.0);
    let (cloth, pins) = cloth(MeshKind::Delaunay, Material::default(), drawn)?;
    case(&cloth, &pins)
}

fn slivers() -> Result<Case, LabError> {
    let (cloth, pins) = cloth(MeshKind::Slivers, Material::default(), hanging)?;
    case(&cloth, &pins)
}

fn contrast(second: Material) -> Result<Case, LabError> {
    let (mut cloth, pins) = cloth(MeshKind::Delaunay, Material::default(), hanging)?;
    cloth.materials.push(second);
    for (t, corners) in cloth.triangles.iter().enumerate() {
        if corners
            .iter()
            .all(|&v| cloth.positions[v as usize].y < -0.1)
        {
            cloth.material[t] = 1;
        }
    }
    case(&cloth, &pins)
}

fn stiffness_contrast() -> Result<Case, LabError> {
    let usual = Material::default();
    contrast(Material {
        stretch: usual.stretch.map(|y| 1e4 * y),
        shear: 1e4 * usual.shear,
        bend: usual.bend.map(|d| 1e4 * d),
        ..usual
    })
}

fn mass_contrast() -> Result<Case, LabError> {
    let usual = Material::default();
    contrast(Material {
        density: 1e3 * usual.density,
        ..usual
    })
}

fn long_step() -> Result<Case, LabError> {
    let (cloth, pins) = cloth(MeshKind::Delaunay, Material::default(), |p| {
        Vec3::new(p.x, 0.0, p.y)
    })?;
    Ok(Case {
        step: 0.2,
        ..case(&cloth, &pins)?
    })
}

fn ball_at(place: Vec3, radius: f64) -> Collider {
    let mut mesh = ball(radius, 2);
    for p in &mut mesh.positions {
        *p += place;
    }
    Collider::new(Arc::new(SurfaceTree::new(mesh)))
}

fn lying() -> Result<Case, LabError> {
    let above = |p: Vec2| Vec3::new(p.x - 0.1, 0.055, p.y - 0.05);
    let (cloth, _) = cloth(MeshKind::Delaunay, Material::default(), above)?;
    let mut case = case(&cloth, &[])?;
    case.system =
        (case.system).with(|builder| builder.colliders.push(ball_at(Vec3::zeros(), 0.05)));
    Ok(case)
}

fn jumping_body() -> Result<Case, LabError> {
    Ok(Case {
        jump: Some(ball_at(Vec3::new(0.02, 0.03, 0.0), 0.05)),
        ..lying()?
    })
}

fn not_a_number() -> Result<Case, LabError> {
    let mut case = slivers()?;
    let last = case.state.positions.len() - 1;
    case.state.positions[last].x = f64::NAN;
    Ok(case)
}

fn infinite() -> Result<Case, LabError> {
    let mut case = slivers()?;
    let last = case.state.velocities.len() - 1;
    case.state.velocities[last].y = f64::INFINITY;
    Ok(case)
}

/// A repulsion along the normals that reaches farther than a limb is thick, a hundred times
/// stiffer than usual, met at speed.
fn force_field() -> Result<Case, LabError> {
    let mut case = lying()?;
    case.system = case.system.with(|builder| {
        builder.colliders = vec![ball_at(Vec3::zeros(), 0.008)];
        builder.contact.offset = 0.02;
        builder.contact.stiffness = 1e8;
    });
    for v in &mut case.state.velocities {
        v.y = -5.0;
    }
    Ok(case)
}

/// The energy that a cloth can have come by.
struct Allowance {
    /// Energy of motion, strain and contact (J): that of the start, what the weight can have added
    /// since, and what a body that jumped put into the contact.
    energy: f64,
    /// What the body that jumped put in (J).
    jumped: f64,
    workspace: Workspace,
}

/// How many times that energy the motion may have and still count as sound: the energy of a method
/// that keeps it swings.
const SWING: f64 = 10.0;

impl Allowance {
    fn new(case: &Case) -> Self {
        let mut allowance = Self {
            energy: 0.0,
            jumped: 0.0,
            workspace: Workspace::default(),
        };
        allowance.energy = allowance.energy_of(&case.system, &case.state);
        allowance
    }

    /// Energy of motion, strain and contact (J), without that of the weight, which has no zero.
    fn energy_of(&mut self, system: &System, state: &State) -> f64 {
        let places = state.positions.iter().zip(&system.rest.mass);
        let weight: f64 = places.map(|(x, m)| m * system.control.gravity.dot(x)).sum();
        whole_energy(system, state, &mut self.workspace) + weight
    }

    /// Puts a surface in the place of the model's, with what that stores in the contact.
    fn jump(&mut self, system: &mut System, state: &State, jumped: Collider) {
        let before = self.energy_of(system, state);
        *system = system.with(|builder| builder.colliders = vec![jumped]);
        let more = (self.energy_of(system, state) - before).max(0.0);
        self.energy += more;
        self.jumped += more;
    }

    /// Adds what the weight can give in a step (s): the root of the energy grows by |g| sqrt(M/2) a
    /// second at most, as dE/dt = sum m g.v <= |g| sqrt(2 M E).
    fn fall(&mut self, system: &System, step: f64) {
        let push = system.control.gravity.norm() * (0.5 * free_mass(system)).sqrt();
        self.energy = (self.energy.max(0.0).sqrt() + push * step).powi(2);
    }

    /// Words for motion with more energy than it can have. Strain is left out: what a solver leaves
    /// unsolved in stiff cloth counts as much energy there and moves nothing.
    fn exceeded_by(&self, system: &System, state: &State) -> Option<String> {
        let motion = state.kinetic_energy(system);
        let words = || {
            let possible = self.energy;
            format!("moves with {motion:.1e} J where {possible:.1e} J are possible")
        };
        (motion.is_nan() || motion > SWING * self.energy).then(words)
    }
}

/// Mass of the vertices that are not pinned (kg).
fn free_mass(system: &System) -> f64 {
    let free = system.rest.mass.iter().zip(&system.prescribed.pinned);
    free.filter(|&(_, &pinned)| !pinned).map(|(m, _)| m).sum()
}

fn run(mut case: Case, kind: MethodKind, budget: f64) -> Result<(Outcome, String), LabError> {
    let mut state = case.state.clone();
    let mut method = toile_reference::build(&kind.into())?;
    // What is no number has no energy; every method is to refuse it.
    let finite = state.first_not_finite().is_none();
    let mut allowance = finite.then(|| Allowance::new(&case));
    let clock = Clock::start();
    for n in 0..STEPS {
        if n == STEPS / 3
            && let Some(jumped) = case.jump.take()
            && let Some(allowance) = &mut allowance
        {
            allowance.jump(&mut case.system, &state, jumped);
        }
        if let Err(error) = method.advance(&case.system, &mut state, case.step) {
            return Ok((Outcome::Stopped, error.to_string()));
        }
        if let Some(vertex) = state.first_not_finite() {
            return Ok((
                Outcome::Unsound,
                format!("vertex {vertex} is not finite after step {n}"),
            ));
        }
        if let Some(allowance) = &mut allowance {
            allowance.fall(&case.system, case.step);
            if let Some(words) = allowance.exceeded_by(&case.system, &state) {
                return Ok((Outcome::Unsound, format!("{words} after step {n}")));
            }
        }
        let jumped = allowance.as_ref().map_or(0.0, |a| a.jumped);
        if clock.spent() > budget {
            return Ok(verdict(&case, &state, jumped, Some(n + 1)));
        }
        if method.finished() {
            break;
        }
    }
    let jumped = allowance.as_ref().map_or(0.0, |a| a.jumped);
    Ok(verdict(&case, &state, jumped, None))
}

/// A cloth that fell freely all the time, thrown by all the energy that a body that jumped put in,
/// came no farther than this (m).
fn reach(case: &Case, jumped: f64) -> f64 {
    let time = STEPS as f64 * case.step;
    let fastest = case
        .state
        .velocities
        .iter()
        .map(|v| v.norm())
        .fold(0.0, f64::max);
    let thrown = (2.0 * jumped / free_mass(&case.system)).sqrt();
    2.0 + 0.5 * 9.81 * time * time + (fastest + thrown) * time
}

fn verdict(
    case: &Case,
    state: &State,
    jumped: f64,
    stopped_at: Option<usize>,
) -> (Outcome, String) {
    let places = state.positions.iter().zip(&case.state.positions);
    let moved = places.map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
    let words = format!("moved by {moved:.2} m at the most");
    if moved > reach(case, jumped) {
        return (Outcome::Unsound, words);
    }
    match stopped_at {
        Some(steps) => (
            Outcome::Slow,
            format!("{words}; {steps} of {STEPS} steps in {BUDGET} s of processor time"),
        ),
        None => (Outcome::Sound, words),
    }
}

/// Runs every method through every case.
///
/// # Errors
/// A case cannot be built; the watcher asked to stop.
pub fn hard_cases(watcher: &mut dyn Watcher) -> Result<Vec<HardRun>, LabError> {
    let mut runs = Vec::new();
    for (k, (name, make)) in CASES.into_iter().enumerate() {
        for (method, kind) in MethodKind::ALL {
            let share = k as f64 / CASES.len() as f64;
            if watcher.progress(name, share, method) == ControlFlow::Break(()) {
                return Err(LabError::Cancelled);
            }
            let (outcome, detail) = run(make()?, kind, BUDGET)?;
            runs.push(HardRun {
                case: name,
                method,
                outcome,
                detail,
            });
        }
    }
    Ok(runs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_refuses_what_is_no_number() {
        for make in [not_a_number, infinite] {
            for (name, kind) in MethodKind::ALL {
                let (outcome, detail) = run(make().unwrap(), kind, BUDGET).unwrap();
                assert_eq!(outcome, Outcome::Stopped, "{name}: {detail}");
                assert!(detail.contains("vertex"), "{name}: {detail}");
            }
        }
    }

    #[test]
    fn cloth_that_a_body_jumped_into_is_thrown_by_no_more_than_that_gave() {
        let (outcome, detail) =
            run(jumping_body().unwrap(), MethodKind::Bdf2, f64::INFINITY).unwrap();
        assert_eq!(outcome, Outcome::Sound, "{detail}");
    }

    #[test]
    fn the_implicit_midpoint_rule_refuses_energy_that_nothing_gave() {
        for make in [jumping_body, stretched] {
            let (outcome, detail) =
                run(make().unwrap(), MethodKind::ImplicitMidpoint, f64::INFINITY).unwrap();
            assert_eq!(outcome, Outcome::Stopped, "{detail}");
            assert!(detail.contains("the energy grew"), "{detail}");
        }
    }

    #[test]
    fn a_state_with_energy_that_nothing_gave_is_impossible() {
        let case = lying().unwrap();
        let mut allowance = Allowance::new(&case);
        let mut state = case.state.clone();
        assert_eq!(allowance.exceeded_by(&case.system, &state), None);
        for v in &mut state.velocities {
            v.y = 2.0;
        }
        let words = allowance.exceeded_by(&case.system, &state);
        assert!(words.is_some_and(|words| words.contains(" J are possible")));
        for _ in 0..60 {
            allowance.fall(&case.system, 1.0 / 60.0);
        }
        assert_eq!(allowance.exceeded_by(&case.system, &state), None);
    }
}
