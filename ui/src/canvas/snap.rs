//! Snapping: a place near the pointer that means something, and how a point there is constructed.

use super::guides;
use super::scene::{CurveScene, PointRole, Scene, SheetScene};
use toile_geometry::Vec2;
use toile_pattern::{Guide, Mark, Name, Number, PointId, PointRule, SheetId};

/// How near the pointer must be to a place to be drawn to it [pixels].
const REACH: f64 = 9.0;
/// How near it must be to the level of a point [pixels].
const LEVEL_REACH: f64 = 5.0;
/// Steps of the grid [m], and the least enlargement each is used at [pixels per metre].
const GRID: [(f64, f64); 4] = [(0.001, 8000.0), (0.005, 1600.0), (0.01, 500.0), (0.05, 0.0)];

/// How a point at a place comes about.
#[derive(Clone, Debug, PartialEq)]
pub enum Spec {
    /// It is there.
    Point(PointId),
    /// It is constructed.
    New(PointRule),
    /// At a distance [m] and angle [rad] from the place given before.
    FromLast {
        /// The distance [m].
        distance: Number,
        /// The angle [rad], from +x counter-clockwise.
        angle: Number,
    },
    /// Beside the place given before [m].
    BesideLast {
        /// To the right [m].
        x: Number,
        /// Upward [m].
        y: Number,
    },
}

/// A place that a point could have.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// The sheet.
    pub sheet: SheetId,
    /// Where on it [m].
    pub at: Vec2,
    /// How a point there comes about.
    pub spec: Spec,
    /// What it is, in words; empty for anywhere.
    pub words: String,
}

impl Placed {
    /// A place that means nothing in particular.
    pub fn free(sheet: SheetId, at: Vec2) -> Self {
        Self {
            sheet,
            at,
            spec: Spec::New(PointRule::at(at.x, at.y)),
            words: String::new(),
        }
    }

    /// The point that is there.
    pub fn point(&self) -> Option<PointId> {
        match self.spec {
            Spec::Point(id) => Some(id),
            _ => None,
        }
    }
}

/// Places near one of a sheet [m], the best first; the last is anywhere. Guides lie where the sheet
/// has them.
pub fn snaps(
    (scene, own_guides): (&Scene, &[Guide]),
    sheet: SheetId,
    at: Vec2,
    scale: f64,
) -> Vec<Placed> {
    let mut found = Vec::new();
    let reach = REACH / scale;
    let step = grid_step(scale);
    if let Some(drawn) = scene.sheet_scene(sheet) {
        points(drawn, at, reach, &mut found);
        crossings(drawn, at, reach, &mut found);
    }
    guides::crossings(sheet, own_guides, (at, reach), &mut found);
    if let Some(drawn) = scene.sheet_scene(sheet) {
        guides::on_lines(drawn, own_guides, (at, reach), &mut found);
        on_curves(drawn, at, reach, &mut found);
        on_edges(drawn, at, reach, &mut found);
    }
    guides::on_guides(sheet, own_guides, (at, reach, scale), &mut found);
    if let Some(drawn) = scene.sheet_scene(sheet) {
        levels(drawn, at, (LEVEL_REACH / scale, step), &mut found);
    }
    found.push(Placed {
        words: "on the grid".into(),
        ..Placed::free(sheet, at.map(|v| rounded(v, step)))
    });
    found.push(Placed::free(sheet, at));
    found
}

/// The step of the grid at an enlargement [m].
pub fn grid_step(scale: f64) -> f64 {
    let step = GRID.iter().find(|(_, least)| scale >= *least);
    step.map_or(0.05, |(step, _)| *step)
}

/// The nearest multiple of a step, with few digits: 0.3, not 0.30000000000000004.
pub fn rounded(value: f64, step: f64) -> f64 {
    ((value / step).round() * step * 1e6).round() / 1e6
}

fn points(sheet: &SheetScene, at: Vec2, reach: f64, found: &mut Vec<Placed>) {
    let mut near: Vec<(f64, Placed)> = sheet
        .points
        .iter()
        .map(|point| ((point.at - at).norm(), point))
        .filter(|(away, _)| *away <= reach)
        .map(|(away, point)| {
            let placed = Placed {
                sheet: sheet.id,
                at: point.at,
                spec: Spec::Point(point.id),
                words: point.name.clone(),
            };
            (away, placed)
        })
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.extend(near.into_iter().map(|(_, placed)| placed));
}

/// Curves that come near, the nearest first, with the place on each.
pub(super) fn near_curves(
    sheet: &SheetScene,
    at: Vec2,
    reach: f64,
) -> Vec<(&CurveScene, f64, Vec2)> {
    let mut near: Vec<(f64, &CurveScene, f64, Vec2)> = sheet
        .curves
        .iter()
        .filter_map(|curve| {
            let place = curve.path.nearest(at)?;
            let point = curve.path.point(place);
            let away = (point - at).norm();
            (away <= reach).then_some((away, curve, place.along, point))
        })
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.into_iter()
        .map(|(_, curve, along, point)| (curve, along, point))
        .collect()
}

fn crossings(sheet: &SheetScene, at: Vec2, reach: f64, found: &mut Vec<Placed>) {
    let near = near_curves(sheet, at, reach);
    for (k, (first, ..)) in near.iter().enumerate() {
        for (second, ..) in &near[k + 1..] {
            let crossings = first.path.crossings(&second.path);
            for (index, crossing) in crossings.iter().enumerate() {
                if (crossing.point - at).norm() > reach || is_end(first, second, crossing.point) {
                    continue;
                }
                let Ok(index) = u16::try_from(index) else {
                    continue;
                };
                found.push(Placed {
                    sheet: sheet.id,
                    at: crossing.point,
                    spec: Spec::New(PointRule::CurveCrossing {
                        curves: [first.id, second.id],
                        index,
                    }),
                    words: format!("{} crosses {}", first.name, second.name),
                });
            }
        }
    }
}

/// Whether curves meet at a place where one of them ends, and so a point is there already.
fn is_end(first: &CurveScene, second: &CurveScene, at: Vec2) -> bool {
    [first, second].iter().any(|curve| {
        let ends = [curve.line.first(), curve.line.last()];
        ends.into_iter()
            .flatten()
            .any(|end| (end - at).norm() < 1e-7)
    })
}

fn on_curves(sheet: &SheetScene, at: Vec2, reach: f64, found: &mut Vec<Placed>) {
    for (curve, along, point) in near_curves(sheet, at, reach) {
        let length = curve.path.length();
        if length <= 0.0 {
            continue;
        }
        let share = along / length;
        let middle = curve.path.at_length(0.5 * length);
        let middle = middle.map(|place| curve.path.point(place));
        if let Some(middle) = middle.filter(|middle| (middle - at).norm() <= reach) {
            found.push(on_curve(sheet.id, curve, (0.5, middle), "the middle of"));
        }
        found.push(on_curve(sheet.id, curve, (share, point), "on"));
    }
}

/// A point on a curve, at a share of its length, which lies there [m].
pub(super) fn on_curve(
    sheet: SheetId,
    curve: &CurveScene,
    (share, at): (f64, Vec2),
    words: &str,
) -> Placed {
    Placed {
        sheet,
        at,
        spec: Spec::New(PointRule::OnCurve {
            curve: curve.id,
            share: Number::Value(share),
        }),
        words: format!("{words} {}", curve.name),
    }
}

/// On edges of the panel that the sheet lies on.
fn on_edges(sheet: &SheetScene, at: Vec2, reach: f64, found: &mut Vec<Placed>) {
    let near = sheet.edges.iter().filter_map(|part| {
        let (point, share) = part.nearest(at)?;
        let away = (point - at).norm();
        (away <= reach).then_some((away, part, point, share))
    });
    if let Some((_, part, point, share)) = near.min_by(|a, b| a.0.total_cmp(&b.0)) {
        let at = Mark::Between {
            ends: part.ends,
            share: Number::Value(share),
        };
        let line = Name::Drawn(part.line);
        found.push(Placed {
            sheet: sheet.id,
            at: point,
            spec: Spec::New(PointRule::Mark { line, at }),
            words: "on the panel's edge".into(),
        });
    }
}

/// Beside or above a point, a multiple of the grid's step away.
fn levels(sheet: &SheetScene, at: Vec2, (reach, step): (f64, f64), found: &mut Vec<Placed>) {
    let points = sheet
        .points
        .iter()
        .filter(|point| point.role != PointRole::Handle);
    let nearest = |axis: usize| {
        let away = move |p: &Vec2| (p[axis] - at[axis]).abs();
        let near = points.clone().filter(move |point| away(&point.at) <= reach);
        near.min_by(|a, b| {
            let apart = |p: &Vec2| (p - at).norm();
            apart(&a.at).total_cmp(&apart(&b.at))
        })
    };
    let mut beside = |base: PointId, origin: Vec2, way: Vec2, words: String| {
        found.push(Placed {
            sheet: sheet.id,
            at: origin + way,
            spec: Spec::New(PointRule::Offset {
                base,
                x: Number::Value(way.x),
                y: Number::Value(way.y),
            }),
            words,
        });
    };
    if let Some(level) = nearest(1) {
        let way = Vec2::new(rounded(at.x - level.at.x, step), 0.0);
        beside(
            level.id,
            level.at,
            way,
            format!("level with {}", level.name),
        );
    }
    if let Some(above) = nearest(0) {
        let word = if at.y >= above.at.y { "above" } else { "below" };
        let way = Vec2::new(0.0, rounded(at.y - above.at.y, step));
        beside(above.id, above.at, way, format!("{word} {}", above.name));
    }
}
