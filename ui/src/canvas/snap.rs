//! Snapping: meaningful places near the pointer, with the construction of a point there.

use super::guides;
use super::placed::{Placed, Spec, grid_step, near_curves, on_curve, on_edge, rounded};
use super::scene::{CurveScene, PointRole, Scene, SheetScene};
use toile_geometry::Vec2;
use toile_pattern::{Guide, Number, PointId, PointRule, SheetId};

/// Distance within which the pointer snaps to a place (pixels).
const REACH: f64 = 9.0;
/// Distance within which the pointer snaps to the level of a point, or to the vertical through it (pixels).
const LEVEL_REACH: f64 = 5.0;
/// Snapping places near a point of a sheet (m), the best first; the last is the point itself. Guides are
/// in the coordinates of the sheet.
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

/// Whether one of two curves ends at their intersection, so that a point exists there already.
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

/// Finds the nearest point on the edges of the panel that the sheet lies on.
fn on_edges(sheet: &SheetScene, at: Vec2, reach: f64, found: &mut Vec<Placed>) {
    let near = sheet.edges.iter().filter_map(|part| {
        let (point, share) = part.nearest(at)?;
        let away = (point - at).norm();
        (away <= reach).then_some((away, part, point, share))
    });
    if let Some((_, part, point, share)) = near.min_by(|a, b| a.0.total_cmp(&b.0)) {
        found.push(on_edge(
            sheet.id,
            part,
            (share, point),
            "on the panel's edge",
        ));
    }
}

/// Finds places level with a point, and straight above or below a point, at a multiple of the grid step
/// from it.
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
