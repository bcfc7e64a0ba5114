//! Hard cases, one by one: each method stays sound, or stops with an error that says where.

use crate::clock::Clock;
use crate::stability::shake;
use crate::{LabError, MeshKind, freeze::ball, rectangle};
use serde::Serialize;
use std::ops::ControlFlow;
use std::sync::Arc;
use toile_drape::{Cloth, Collider, Material, MethodKind, MethodSettings, Model, State};
use toile_geometry::{SurfaceTree, Vec2, Vec3};
use toile_session::Watcher;

/// How a method met a hard case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// It went through and stayed finite and in place.
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
    model: Model,
    state: State,
    step: f64,
    /// A surface that takes the place of the model's after a third of the steps.
    jump: Option<Collider>,
}

/// Steps of a case, and processor time it may take [s].
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
    let mut model = Model::new("cloth", cloth)?;
    for &pin in pins {
        model.pinned[pin as usize] = true;
    }
    let mut state = State::at_rest(&model, cloth.positions.clone());
    shake(&model, &mut state, 1e-3);
    Ok(Case {
        model,
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
    case.model.colliders.push(ball_at(Vec3::zeros(), 0.05));
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
    case.model.colliders = vec![ball_at(Vec3::zeros(), 0.008)];
    case.model.contact.offset = 0.02;
    case.model.contact.stiffness = 1e8;
    for v in &mut case.state.velocities {
        v.y = -5.0;
    }
    Ok(case)
}

fn run(mut case: Case, kind: MethodKind) -> (Outcome, String) {
    let mut state = case.state.clone();
    let mut method = MethodSettings::from(kind).build();
    let clock = Clock::start();
    for n in 0..STEPS {
        if n == STEPS / 3
            && let Some(jumped) = case.jump.take()
        {
            case.model.colliders = vec![jumped];
        }
        if let Err(error) = method.advance(&case.model, &mut state, case.step) {
            return (Outcome::Stopped, error.to_string());
        }
        if let Some(vertex) = state.first_not_finite() {
            return (
                Outcome::Unsound,
                format!("vertex {vertex} is not finite after step {n}"),
            );
        }
        if clock.spent() > BUDGET {
            return verdict(&case, &state, Some(n + 1));
        }
        if method.finished() {
            break;
        }
    }
    verdict(&case, &state, None)
}

/// A cloth that fell freely all the time came no farther than this [m].
fn reach(case: &Case) -> f64 {
    let time = STEPS as f64 * case.step;
    let fastest = case
        .state
        .velocities
        .iter()
        .map(|v| v.norm())
        .fold(0.0, f64::max);
    2.0 + 0.5 * 9.81 * time * time + fastest * time
}

fn verdict(case: &Case, state: &State, stopped_at: Option<usize>) -> (Outcome, String) {
    let places = state.positions.iter().zip(&case.state.positions);
    let moved = places.map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
    let words = format!("moved by {moved:.2} m at the most");
    if moved > reach(case) {
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
            let (outcome, detail) = run(make()?, kind);
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
                let (outcome, detail) = run(make().unwrap(), kind);
                assert_eq!(outcome, Outcome::Stopped, "{name}: {detail}");
                assert!(detail.contains("vertex"), "{name}: {detail}");
            }
        }
    }
}
