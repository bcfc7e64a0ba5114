//! The drape test of Cusick (1968; ISO 9073-9, BS 5058).

use crate::check::{Cases, Expected};
use crate::shadow::{fold_count, shadow};
use crate::{LabError, Tolerance, disc};
use toile_drape::{
    Material, PseudoTransientContinuation, RestSettings, State, System, SystemBuilder, Workspace,
};
use toile_fabric::{LIBRARY, LibraryFabric};
use toile_geometry::{Vec3, total_area};

/// Radius of the specimen and of the discs that hold it (m).
const SPECIMEN: f64 = 0.15;
const DISC: f64 = 0.09;

/// The result of a drape test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drape {
    /// Drape coefficient: the share of the free ring's area that its shadow still covers.
    pub coefficient: f64,
    /// Folds of the shadow.
    pub folds: usize,
}

/// Drapes a specimen of a material in triangles of a size (m).
///
/// # Errors
/// The drape did not come to rest.
pub fn cusick(material: Material, cell: f64) -> Result<Drape, LabError> {
    let flat = disc(SPECIMEN, DISC, cell)?;
    // A slight wave to start from, of no single number of folds: flat, the disc would not know
    // where to fold.
    let cloth = flat.cloth(material, |p| {
        let (r, angle) = (p.norm(), p.y.atan2(p.x));
        let wave: f64 = (3..12)
            .map(|n| (f64::from(n) * angle + f64::from(n * n)).cos())
            .sum();
        let out = ((r - DISC) / (SPECIMEN - DISC)).max(0.0);
        Vec3::new(p.x, 2e-4 * wave * out, p.y)
    });
    let mut builder = SystemBuilder::new("specimen", &cloth)?;
    for v in flat.chosen(|p| p.norm() < DISC + 0.51 * cell) {
        builder.pinned[v as usize] = true;
    }
    let system = builder.build();
    let mut state = State::at_rest(&system, cloth.positions);
    settle(&system, &mut state)?;
    let shape = shadow(&state.positions, &system.topology.triangles);
    let area = |r: f64| std::f64::consts::PI * r * r;
    Ok(Drape {
        coefficient: (total_area(&shape) - area(DISC)) / (area(SPECIMEN) - area(DISC)),
        folds: fold_count(&shape, 4e-3),
    })
}

/// Net force over weight at which a specimen is measured: its coefficient then changes by less
/// than 0.001 more.
const STILL: f64 = 1e-3;
/// Where folds shift against each other for ever so long, this is still enough for 0.01.
const NEARLY_STILL: f64 = 2e-2;
/// Steps to rest at the most.
const STEPS: usize = 500;

fn settle(system: &System, state: &mut State) -> Result<(), LabError> {
    let mut workspace = Workspace::default();
    let mut run = PseudoTransientContinuation::new(RestSettings {
        residual: STILL,
        steps: STEPS,
        ..RestSettings::default()
    });
    while !run.finished() {
        match run.advance(system, state, &mut workspace) {
            Err(error) if run.residual() > NEARLY_STILL => return Err(error.into()),
            Err(_) => break,
            Ok(()) => {}
        }
    }
    if run.residual() > NEARLY_STILL {
        return Err(LabError::Unfinished {
            what: "net force over weight",
            got: run.residual(),
            asked: STILL,
            steps: run.steps(),
        });
    }
    Ok(())
}

/// A cloth of a bending length (m): c = (D / (rho g))^(1/3).
fn of_length(length: f64) -> Material {
    Material {
        density: 0.15,
        stretch: [500.0; 2],
        shear: 50.0,
        poisson: 0.0,
        bend: [0.15 * 9.81 * length.powi(3); 3],
        ..Material::default()
    }
}

/// Drape coefficients found for kinds of fabric (%), by fabric of the library: published bands,
/// collected as targets by the drape simulator of the ppf contact solver (its `targets.csv`); plain cotton also
/// Gan, Steven and Ly 1991, who measured 68.4.
const BANDS: [(&str, [f64; 2]); 6] = [
    ("silk", [20.0, 40.0]),
    ("flag-nylon", [20.0, 40.0]),
    ("cotton", [60.0, 76.0]),
    ("wool", [40.0, 70.0]),
    ("leather", [47.0, 70.0]),
    ("denim", [70.0, 90.0]),
];

/// What the test itself leaves open of a band, what may be lost to another number of folds, and how
/// near the coefficient of a stiff disc is to one: shares of the whole ring.
const OUTSIDE: Tolerance = Tolerance::zero("outside the band", "the whole ring", 0.02);
const LOST: Tolerance = Tolerance::zero("fall below the last", "the whole ring", 0.02);
const STIFF: Tolerance = Tolerance::value("drape coefficient", 0.03);
pub(super) const CUSICK: [Tolerance; 3] = [OUTSIDE, LOST, STIFF];

/// Fabrics of the library, their figures none of them from a drape, against the bands published
/// for their kind.
fn library(cases: &mut Cases) -> Result<(), LabError> {
    for (name, [low, high]) in BANDS {
        let start = std::time::Instant::now();
        cases.tell(0.0, name)?;
        let known: Vec<&str> = LIBRARY.iter().map(|fabric| fabric.name).collect();
        let fabric = LibraryFabric::named(name).ok_or_else(|| LabError::Unknown {
            what: "fabric of the library",
            name: name.to_owned(),
            known: known.join(", "),
        });
        let drape = fabric.and_then(|fabric| cusick(fabric.material(), 8e-3));
        let shown = drape.as_ref().map_or("-".to_owned(), |d| {
            format!("{:.1} %, {} folds", 100.0 * d.coefficient, d.folds)
        });
        let outside = drape.map(|d| {
            let dc = 100.0 * d.coefficient;
            (low - dc).max(dc - high).max(0.0) / 100.0
        });
        cases.add(
            format!("{name}, DC {shown}, band {low} to {high}"),
            Expected::zero(OUTSIDE, 1.0),
            outside,
            start,
        )?;
    }
    Ok(())
}

/// The drape coefficient rises with the bending length, and stands near 1 for a stiff disc.
pub(super) fn rising(cases: &mut Cases) -> Result<(), LabError> {
    library(cases)?;
    let mut last: Option<f64> = None;
    for length in [0.010, 0.015, 0.020, 0.025, 0.030, 0.040] {
        let start = std::time::Instant::now();
        cases.tell(0.0, &format!("bending length {:.0} mm", length * 1e3))?;
        let drape = cusick(of_length(length), 8e-3);
        let found = drape.as_ref().ok().map(|d| d.coefficient);
        let lost = drape.map(|d| (last.unwrap_or(0.0) - d.coefficient).max(0.0));
        let shown = found.map_or("-".to_owned(), |f| format!("{:.1}", 100.0 * f));
        cases.add(
            format!("bending length {:.0} mm, DC {shown} %", length * 1e3),
            Expected::zero(LOST, 1.0),
            lost,
            start,
        )?;
        last = found.or(last);
    }
    cases.measure(
        "a stiff disc, bending length 200 mm",
        Expected::value(STIFF, 1.0),
        || cusick(of_length(0.2), 8e-3).map(|d| d.coefficient),
    )?;
    Ok(())
}
