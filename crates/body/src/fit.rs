//! Fits our mannequin to a foreign closed mesh of a person.

use crate::describe::Description;
use crate::fit_check::{FitMisfit, misfit};
use crate::fit_field::{self, Goal};
use crate::fit_frame::{self, FoundFrame};
use crate::fit_girths::{GirthResidual, girths};
use crate::fit_samples::{DensityTarget, PARTS, Sample, samples};
use crate::fit_start::start;
use crate::request::Request;
use crate::rigging::Rigging;
use crate::rings::TemplateSkin;
use crate::sides::both_sides;
use crate::template::Template;
use crate::{
    BodyError, BodyFrame, Figure, Part, Primitive, Scan, ScanLandmarks, rings, template_skin,
};
use rayon::prelude::*;
use std::collections::BTreeMap;
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};
use toile_measure::Measurements;

/// Our own body fitted to somebody's mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Data from which the body is made: give it to [`crate::Mannequin::from_description`].
    pub description: Description,
    /// Distances of the body's skin from the mesh.
    pub misfit: FitMisfit,
    /// Shift that made the mesh stand on y = 0 centred at x = 0 (m).
    pub shift: Vec3,
    /// Measurements whose taped values no body has: they are left out of the description.
    pub dropped: Vec<&'static str>,
}

impl Scan {
    /// Fits a mannequin. Joints come from the sections of the limbs. About 150 primitives are fitted by least
    /// squares so that their density on the mesh is the threshold. The fit is repeated five times: each time
    /// a skin is cast from the primitives, and its distances from the mesh and the differences of its girths
    /// from those of the mesh correct the next fit. The best fit is kept. The mesh is taken as symmetric: the
    /// left half of the body is fitted to both halves of the mesh.
    ///
    /// # Errors
    /// [`BodyError::Mesh`] for a landmark or a limb that cannot be found, with the landmark to give.
    pub fn fit(&self, figure: Figure) -> Result<Fit, BodyError> {
        let shift = self.shift();
        if shift.norm() > 1e-9 {
            let moved = self.moved(shift)?;
            return Ok(Fit {
                shift,
                ..moved.fit_standing(figure)?
            });
        }
        self.fit_standing(figure)
    }

    fn fit_standing(&self, figure: Figure) -> Result<Fit, BodyError> {
        let mut found = fit_frame::find(self)?;
        let (primitives, mut misfit) = fitted(self, &mut found)?;
        misfit.primitives = primitives.len();
        let (measurements, dropped) = sound(self.measurements(), figure)?;
        let description = Description {
            figure,
            measurements,
            primitives: primitives.into_iter().filter(|p| !p.is_right()).collect(),
            frame: Some(found.frame),
            rigging: Rigging::default(),
        };
        Ok(Fit {
            description,
            misfit,
            shift: Vec3::zeros(),
            dropped,
        })
    }
}

/// The table without values that no body has, which come from tapes at wrong positions, and the names of the
/// dropped measurements.
fn sound(
    mut table: Measurements,
    figure: Figure,
) -> Result<(Measurements, Vec<&'static str>), BodyError> {
    let mut dropped = Vec::new();
    loop {
        match Request::read(&table, figure) {
            Ok(_) => return Ok((table, dropped)),
            Err(BodyError::OutOfRange { name, .. }) if name != "height" => {
                let mut rest = Measurements::new();
                for (other, measured) in table.iter().filter(|row| row.0 != name) {
                    rest.set(other, measured.value, measured.origin)
                        .map_err(|error| BodyError::Description(error.to_string()))?;
                }
                table = rest;
                dropped.push(name);
            }
            Err(error) => return Err(error),
        }
    }
}

/// Fits primitives, and the levels of `found` with them. Returns the primitives of both sides, and the
/// distances of their skin from the mesh.
fn fitted(scan: &Scan, found: &mut FoundFrame) -> Result<(Vec<Primitive>, FitMisfit), BodyError> {
    let own = Scan::new(template_skin(Figure::Woman)?, ScanLandmarks::default())?;
    let rows = start(scan, found, &own);
    let tree = SurfaceTree::new(scan.mesh().clone());
    let mut targets = samples(scan, &tree, found);
    let height = found.frame.height;
    let mut groups: Vec<Vec<Primitive>> = PARTS
        .iter()
        .map(|&part| rows.iter().filter(|p| p.part == part).copied().collect())
        .collect();
    let mut tapes: [Vec<GirthResidual>; 4] = Default::default();
    let mut best: Option<(Vec<Primitive>, FitMisfit, BodyFrame)> = None;
    for round in 0..=ROUNDS {
        groups
            .par_iter_mut()
            .zip(targets.par_iter().zip(&tapes))
            .for_each(|(own, (samples, girths))| {
                let goal = Goal {
                    samples,
                    girths,
                    height,
                };
                fit_field::fit(own, &goal);
            });
        let primitives = both_sides(groups.concat());
        let (skin, checked) = cast_best(scan, found, &primitives)?;
        let misfit = misfit(scan, &checked, &found.frame.joints, [0.0, found.chin]);
        for (part, samples) in PARTS.iter().zip(&mut targets) {
            drawn(samples, *part, &skin, height);
        }
        tapes = girths([scan, &checked], found, (&groups, round + 1));
        let bad = misfit.badness(height);
        if best.as_ref().is_none_or(|b| bad < b.1.badness(height)) {
            best = Some((primitives, misfit, found.frame));
        }
    }
    let (primitives, misfit, frame) =
        best.ok_or_else(|| BodyError::Mesh("was not fitted".into()))?;
    found.frame = frame;
    Ok((primitives, misfit))
}

/// A level of the frame whose best height is searched for.
#[derive(Clone, Copy, PartialEq)]
enum SearchedLevel {
    Armpit,
    Crotch,
}

impl SearchedLevel {
    fn level(self, frame: &mut BodyFrame) -> &mut f64 {
        match self {
            Self::Armpit => &mut frame.armpit,
            Self::Crotch => &mut frame.crotch,
        }
    }
}

/// A skin cast from primitives with a frame, and the same skin as the scan `checked`, to compare it with the
/// mesh.
struct CandidateSkin {
    skin: TemplateSkin,
    checked: Scan,
    frame: BodyFrame,
}

impl CandidateSkin {
    fn new(scan: &Scan, frame: BodyFrame, primitives: &[Primitive]) -> Result<Self, BodyError> {
        let mut template = Template::framed(&frame, primitives.to_vec());
        let skin = rings::cast_framed(&mut template)?;
        Ok(Self {
            checked: Scan::new(skin.mesh.clone(), scan.landmarks().clone())?,
            frame: BodyFrame {
                hand: template.hand,
                ..frame
            },
            skin,
        })
    }
}

/// Casts the skin of primitives. The levels of armpits and crotch are chosen one after the other so that the
/// skin near that level is nearest to the mesh: between a thick arm and a full trunk, and between thighs that
/// touch, only few levels can be cast.
fn cast_best(
    scan: &Scan,
    found: &mut FoundFrame,
    primitives: &[Primitive],
) -> Result<(TemplateSkin, Scan), BodyError> {
    /// Shifts of a level that are tried, smallest first, as shares of stature.
    const ELSEWHERE: [f64; 6] = [-0.003, 0.003, -0.006, 0.006, -0.01, 0.01];
    /// Distance above and below a level within which skin and mesh are compared, as a share of stature.
    const ROUND: f64 = 0.035;
    let height = found.frame.height;
    let mut best = CandidateSkin::new(scan, found.frame, primitives);
    for searched in [SearchedLevel::Armpit, SearchedLevel::Crotch] {
        let from = *searched.level(&mut found.frame);
        let range = [-ROUND, ROUND].map(|d| from + d * height);
        let bad = |candidate: &CandidateSkin| {
            misfit(scan, &candidate.checked, &candidate.frame.joints, range).badness(height)
        };
        let mut least = best.as_ref().map_or(f64::INFINITY, bad);
        for step in ELSEWHERE {
            let mut frame = best
                .as_ref()
                .map_or(found.frame, |candidate| candidate.frame);
            *searched.level(&mut frame) = from + step * height;
            let tried = CandidateSkin::new(scan, frame, primitives);
            let own = tried.as_ref().map_or(f64::INFINITY, bad);
            if own < least {
                (least, best) = (own, tried);
            }
        }
    }
    let best = best?;
    found.frame = best.frame;
    Ok((best.skin, best.checked))
}

/// Number of rounds of casting the skin and moving the samples by its misfit; the result is the best of all
/// rounds.
const ROUNDS: usize = 5;

/// Distance of the skin from a sample of the mesh.
struct SurfaceMiss {
    place: Vec3,
    normal: Vec3,
    /// Distance along the normal (m).
    miss: f64,
    weight: f64,
}

/// Moves the surface samples of a part by the distance of the skin from them, averaged over a neighbourhood,
/// to correct two errors: the chords of a cast skin lie inside the surface, and a fit has its own bias.
fn drawn(samples: &mut [Sample], part: Part, skin: &TemplateSkin, height: f64) {
    let cell = 0.03 * height;
    let mut own = TriangleMesh {
        positions: skin.mesh.positions.clone(),
        triangles: Vec::new(),
    };
    for (t, triangle) in skin.mesh.triangles.iter().enumerate() {
        if skin.parts[t] == part {
            own.triangles.push(*triangle);
        }
    }
    let tree = SurfaceTree::new(own);
    let key = |p: Vec3| [p.x, p.y, p.z].map(|x| (x / cell).floor() as i64);
    let mut cells: BTreeMap<[i64; 3], Vec<SurfaceMiss>> = BTreeMap::new();
    for sample in samples.iter() {
        let DensityTarget::Surface { normal, own } = sample.target else {
            continue;
        };
        let Some(closest) = tree.closest_point(own, 0.02 * height) else {
            continue;
        };
        let miss = (closest.point - own).dot(&normal);
        cells.entry(key(own)).or_default().push(SurfaceMiss {
            place: own,
            normal,
            miss,
            weight: sample.weight,
        });
    }
    for sample in samples {
        let DensityTarget::Surface { normal, own } = sample.target else {
            continue;
        };
        let [x, y, z] = key(own);
        let (mut sum, mut weights) = (0.0, 1e-12);
        for (i, j, k) in (0..27).map(|n| (n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)) {
            for other in cells.get(&[x + i, y + j, z + k]).into_iter().flatten() {
                let near = 1.0 - (other.place - own).norm_squared() / (cell * cell);
                if near > 0.0 && other.normal.dot(&normal) > 0.5 {
                    sum += other.miss * near * other.weight;
                    weights += near * other.weight;
                }
            }
        }
        let far = 0.006 * height;
        sample.place -= normal * (sum / weights).clamp(-far, far);
    }
}
