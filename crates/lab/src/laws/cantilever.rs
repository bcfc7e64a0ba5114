//! The heavy cantilever: the law of bending under weight.

use crate::check::{Cases, Expected};
use crate::elastica::heavy_elastica;
use crate::flat::{STRAIGHT, clamped};
use crate::root::bisect;
use crate::settle::{TIGHT, mean, to_rest};
use crate::{LabError, MeshKind, Tolerance, rectangle};
use std::time::Instant;
use toile_drape::{Material, State, SystemBuilder};
use toile_geometry::{Vec2, Vec3};
use toile_session::Watcher;

/// Length of the strip (m), its mass per area (kg/m2), and gravity (m/s2).
const LENGTH: f64 = 0.05;
const DENSITY: f64 = 0.2;
const GRAVITY: f64 = 9.81;

/// Membrane stiffness Y L^2 / D where a case does not say otherwise: the strip stretches by
/// Gamma 1e-5 / 2 of its length, half a per mille at Gamma 100. A strip of 5 cm of cotton has 1e5;
/// how stiffer membranes fare is the law of resolution.
const STIFF: f64 = 1e5;

/// A strip of so many elements, its width a fifth of its length, clamped at x = 0.
///
/// The last two held rows of points lie half a cell before and behind x = 0: the strip keeps its
/// slope there to second order.
struct Strip {
    kind: MeshKind,
    elements: usize,
    gamma: f64,
    stiffness: f64,
}

impl Strip {
    /// Gamma = rho g L^3 / D.
    fn bend(&self) -> f64 {
        DENSITY * GRAVITY * LENGTH.powi(3) / self.gamma
    }

    /// Drop and reach of the tip at rest, as shares of the length.
    fn settle(&self) -> Result<[f64; 2], LabError> {
        let cell = LENGTH / (self.elements as f64 + 0.5);
        let rows = (self.elements / 5).max(1);
        let (from, to) = (-(STRAIGHT as f64 - 0.5) * cell, LENGTH);
        let flat = rectangle(
            self.kind,
            Vec2::new(from, 0.0),
            Vec2::new(to, rows as f64 * cell),
            [self.elements + STRAIGHT, rows],
        )?;
        let bend = self.bend();
        let stretch = self.stiffness * bend / (LENGTH * LENGTH);
        let material = Material {
            density: DENSITY,
            stretch: [stretch; 2],
            shear: 0.5 * stretch,
            poisson: 0.0,
            bend: [bend; 3],
            ..Material::default()
        };
        let cloth = flat.cloth(material, |p| Vec3::new(p.x, 0.0, p.y));
        let mut builder = SystemBuilder::new("strip", &cloth)?;
        for v in flat.chosen(|p| clamped(p.x, cell)) {
            builder.pinned[v as usize] = true;
        }
        let system = builder.build();
        let mut state = State::at_rest(&system, cloth.positions);
        to_rest(&system, &mut state, TIGHT)?;
        let tip = mean(&state.positions, &flat.chosen(|p| p.x > to - 1e-9));
        Ok([-tip.y / LENGTH, tip.x / LENGTH])
    }

    fn ratio(&self) -> Result<f64, LabError> {
        self.settle().map(|[drop, reach]| drop / reach)
    }
}

/// Gamma of the master curve.
const GAMMAS: [f64; 11] = [
    0.01, 0.1, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 300.0, 1000.0,
];

/// Drop over reach: second order in the cell.
const RATIO: Tolerance = Tolerance::value("h/w", 0.01);
/// How far that spreads over the kinds of mesh.
const SPREAD: Tolerance =
    Tolerance::zero("(max-min)/mean", "the mean", 0.005).only("Gamma up to 100");
pub(super) const HEAVY: [Tolerance; 2] = [RATIO, SPREAD];

/// Drop over reach at 40 elements on four kinds of mesh, and how far these spread.
pub(super) fn heavy(cases: &mut Cases) -> Result<(), LabError> {
    for (k, gamma) in GAMMAS.into_iter().enumerate() {
        let expected = heavy_elastica(gamma).ratio();
        // Second order. Beyond Gamma 100 the strip turns within its first L / sqrt(Gamma), one or
        // two cells of 40: cells half as long resolve it. Its membrane is as much stiffer as
        // keeps its stretch at half a per mille.
        let elements = if gamma <= 100.0 { 40 } else { 80 };
        let stiffness = STIFF * (gamma / 100.0).max(1.0);
        let mut found = Vec::new();
        let start = Instant::now();
        for (m, (name, kind)) in MeshKind::ALL.into_iter().enumerate() {
            let share = (k as f64 + 0.25 * m as f64) / GAMMAS.len() as f64;
            cases.tell(share, &format!("Gamma {gamma}, {name}"))?;
            let case = format!("Gamma {gamma}, {name}");
            let strip = Strip {
                kind,
                elements,
                gamma,
                stiffness,
            };
            let measured =
                cases.measure(case, Expected::value(RATIO, expected), || strip.ratio())?;
            found.extend(measured);
        }
        if gamma <= 100.0 && found.len() == MeshKind::ALL.len() {
            let most = found.iter().copied().fold(f64::MIN, f64::max);
            let least = found.iter().copied().fold(f64::MAX, f64::min);
            cases.add(
                format!("Gamma {gamma}, spread between meshes"),
                Expected::zero(SPREAD, 1.0),
                Ok((most - least) / expected),
                start,
            )?;
        }
    }
    Ok(())
}

/// Elements along the strip.
const ELEMENTS: [usize; 4] = [5, 10, 20, 40];

/// Stiffness of the membrane against that of bending, Y L^2 / D.
const STIFFNESSES: [f64; 3] = [1e4, 1e6, 1e8];

/// One point of the chart of how discretisation stiffens.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Resolved {
    /// `cantilever` or `hang`.
    pub scene: &'static str,
    /// Kind of mesh.
    pub mesh: &'static str,
    /// Y L^2 / D, a ratio.
    pub stiffness: f64,
    /// Elements along.
    pub elements: usize,
    /// Relative error; nothing when the drape failed.
    pub error: Option<f64>,
}

/// Measures how discretisation stiffens the strip (h/w at Gamma 10) and the hang.
///
/// # Errors
/// The watcher asked to stop.
pub fn locking(watcher: &mut dyn Watcher) -> Result<Vec<Resolved>, LabError> {
    let mut found = Vec::new();
    let expected = heavy_elastica(10.0).ratio();
    let total = STIFFNESSES.len() * ELEMENTS.len() * MeshKind::ALL.len();
    for stiffness in STIFFNESSES {
        for elements in ELEMENTS {
            for (mesh, kind) in MeshKind::ALL {
                let share = found.len() as f64 / (2.0 * total as f64);
                let detail = format!("{mesh}, {elements} elements, Y L2/D {stiffness:.0e}");
                if watcher.progress("resolution", share, &detail).is_break() {
                    return Err(LabError::Cancelled);
                }
                let strip = Strip {
                    kind,
                    elements,
                    gamma: 10.0,
                    stiffness,
                };
                let mut add = |scene, error| {
                    found.push(Resolved {
                        scene,
                        mesh,
                        stiffness,
                        elements,
                        error,
                    });
                };
                add("cantilever", strip.ratio().ok().map(|r| r / expected - 1.0));
                let hung = super::hang::stiffening(kind, stiffness, elements);
                add("hang", hung.ok());
            }
        }
    }
    Ok(found)
}

/// Error of the strip's drop over reach and of the hang's lengthening.
const STIFFENING: Tolerance = Tolerance::zero("relative error", "the expected value", 0.03);
pub(super) const RESOLUTION: [Tolerance; 1] = [STIFFENING];

/// The strip and the hang at three stiffnesses: at 40 elements nothing locks, at 20 nothing up to
/// 1e6. What is coarser or stiffer is charted: how it stiffens is what the chart is for.
pub(super) fn resolution(cases: &mut Cases) -> Result<(), LabError> {
    let start = Instant::now();
    let found = locking(
        &mut |_: &str, share: f64, case: &str| match cases.tell(share, case) {
            Ok(()) => std::ops::ControlFlow::Continue(()),
            Err(_) => std::ops::ControlFlow::Break(()),
        },
    )?;
    let held = |p: &&Resolved| p.elements == 40 || (p.elements == 20 && p.stiffness <= 1e6);
    for point in found.iter().filter(held) {
        let case = format!(
            "{}, {}, {} elements, Y L2/D {:.0e}",
            point.scene, point.mesh, point.elements, point.stiffness
        );
        let failed = LabError::Unfinished {
            what: "net force over weight",
            got: f64::NAN,
            asked: TIGHT,
            steps: 0,
        };
        cases.add(
            case,
            Expected::zero(STIFFENING, 1.0),
            point.error.ok_or(failed),
            start,
        )?;
    }
    Ok(())
}

/// What the order lacks of two.
const LACKING: Tolerance = Tolerance::zero("2 - order", "the order, 2", 0.03);
pub(super) const ORDER: [Tolerance; 1] = [LACKING];

/// Slope of the error against the cell, from 10 to 40 elements. Slivers are left out: how many there
/// are, and where, changes from one resolution to the next, so that their errors have no slope.
pub(super) fn order(cases: &mut Cases) -> Result<(), LabError> {
    let expected = heavy_elastica(2.0).ratio();
    for (name, kind) in MeshKind::ALL {
        if kind == MeshKind::Slivers {
            continue;
        }
        // At least second order: what lies above is no error.
        cases.measure(
            format!("{name}, 10 and 40 elements"),
            Expected::zero(LACKING, 2.0),
            || {
                let mut errors = Vec::new();
                for elements in [10, 40] {
                    let strip = Strip {
                        kind,
                        elements,
                        gamma: 2.0,
                        stiffness: STIFF,
                    };
                    errors.push((strip.ratio()? / expected - 1.0).abs());
                }
                Ok((2.0 - (errors[0] / errors[1]).log(4.0)).max(0.0))
            },
        )?;
    }
    Ok(())
}

/// Chord of the standard test for bending length (degree).
const CHORD: f64 = 41.5;

/// The overhang of a strip of 40 elements.
const OVERHANG: Tolerance = Tolerance::value("overhang/(D/rho g)^(1/3)", 0.003);
pub(super) const PEIRCE: [Tolerance; 1] = [OVERHANG];

/// The overhang at which the chord falls by 41.5 degrees: Gamma there is 8.0042, so that Peirce's
/// (1930) D = rho g l^3 / 8 holds to 0.05 %.
pub(super) fn peirce(cases: &mut Cases) -> Result<(), LabError> {
    let chord = CHORD.to_radians();
    let gamma = bisect(1.0, 30.0, |gamma| heavy_elastica(gamma).chord() - chord);
    for (name, kind) in MeshKind::ALL {
        cases.measure(name, Expected::value(OVERHANG, gamma.cbrt()), || {
            // Secant over Gamma until the chord is right.
            let angle = |gamma: f64| -> Result<f64, LabError> {
                let strip = Strip {
                    kind,
                    elements: 40,
                    gamma,
                    stiffness: STIFF,
                };
                let [drop, reach] = strip.settle()?;
                Ok(drop.atan2(reach) - chord)
            };
            let mut known = [(0.95 * gamma, 0.0), (1.05 * gamma, 0.0)];
            known[0].1 = angle(known[0].0)?;
            known[1].1 = angle(known[1].0)?;
            for _ in 0..3 {
                let [(a, fa), (b, fb)] = known;
                let next = b - fb * (b - a) / (fb - fa);
                known = [(b, fb), (next, angle(next)?)];
            }
            Ok(known[1].0.cbrt())
        })?;
    }
    Ok(())
}
