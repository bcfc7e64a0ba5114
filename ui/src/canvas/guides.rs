//! Guides on the canvas: finds the guide at a place, and snapping places on guides.

use super::placed::{Placed, grid_step, near_curves, on_curve, on_edge, rounded};
use super::scene::SheetScene;
use toile_geometry::{Curve, Path, Vec2};
use toile_pattern::{Guide, GuideRun, SheetId};

/// Distance from a guide within which the pointer can drag it (pixels).
const REACH: f64 = 6.0;

/// The guide nearest to a place of the table (m), and its distance (m); `None` if no guide is in reach.
/// `scale` is in pixels per metre.
pub fn guide_at<'g>(
    guides: impl IntoIterator<Item = &'g Guide>,
    at: Vec2,
    scale: f64,
) -> Option<(&'g Guide, f64)> {
    let near = guides
        .into_iter()
        .map(|guide| (guide, (guide.at - at[guide.runs.axis()]).abs()))
        .filter(|(_, away)| *away <= REACH / scale);
    near.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Guides converted from coordinates of the table to those of a sheet; `origin` is the sheet's origin on the
/// table (m).
pub fn on_sheet<'g>(guides: impl IntoIterator<Item = &'g Guide>, origin: Vec2) -> Vec<Guide> {
    let moved = guides.into_iter().map(|guide| Guide {
        at: guide.at - origin[guide.runs.axis()],
        ..*guide
    });
    moved.collect()
}

/// Point of a guide nearest to the point `to` (m).
pub fn nearest(guide: &Guide, to: Vec2) -> Vec2 {
    let mut at = to;
    at[guide.runs.axis()] = guide.at;
    at
}

/// Guides of a sheet within `reach` (m) of a point of the sheet (m), the nearest first.
fn near(guides: &[Guide], at: Vec2, reach: f64) -> impl Iterator<Item = &Guide> {
    let away = move |guide: &Guide| (guide.at - at[guide.runs.axis()]).abs();
    let within = guides.iter().filter(|guide| away(guide) <= reach);
    let mut within: Vec<&Guide> = within.collect();
    within.sort_by(|a, b| away(a).total_cmp(&away(b)));
    within.into_iter()
}

/// Finds intersections of guides near a point of a sheet (m), as snapping places.
pub(super) fn crossings(
    sheet: SheetId,
    guides: &[Guide],
    (at, reach): (Vec2, f64),
    found: &mut Vec<Placed>,
) {
    let of = |runs| near(guides, at, reach).filter(move |guide| guide.runs == runs);
    for level in of(GuideRun::Horizontal) {
        for upright in of(GuideRun::Vertical) {
            found.push(Placed {
                words: "where guides cross".into(),
                ..Placed::free(sheet, Vec2::new(upright.at, level.at))
            });
        }
    }
}

/// Finds intersections of guides with curves, or with edges of the panel that the sheet lies on, near a
/// point of the sheet (m). A new point made there stays on the curve or edge.
pub(super) fn on_lines(
    sheet: &SheetScene,
    guides: &[Guide],
    (at, reach): (Vec2, f64),
    found: &mut Vec<Placed>,
) {
    for guide in near(guides, at, reach) {
        let line = stretch(guide, at, reach);
        let is_near = |place: &Vec2| (place - at).norm() <= reach;
        for (curve, ..) in near_curves(sheet, at, reach) {
            let length = curve.path.length();
            let crossings = curve.path.crossings(&line).into_iter();
            for crossing in crossings.filter(|crossing| is_near(&crossing.point)) {
                let share = crossing.here.along / length;
                if share.is_finite() {
                    let words = "where the guide crosses";
                    found.push(on_curve(sheet.id, curve, (share, crossing.point), words));
                }
            }
        }
        for part in &sheet.edges {
            let crossings = Path::new(vec![part.curve]).crossings(&line).into_iter();
            for crossing in crossings.filter(|crossing| is_near(&crossing.point)) {
                if let Some((place, share)) = part.nearest(crossing.point) {
                    let words = "where the guide crosses the panel's edge";
                    found.push(on_edge(sheet.id, part, (share, place), words));
                }
            }
        }
    }
}

/// Finds points on guides near a point of a sheet (m); along the guide they snap to the grid.
pub(super) fn on_guides(
    sheet: SheetId,
    guides: &[Guide],
    (at, reach, scale): (Vec2, f64, f64),
    found: &mut Vec<Placed>,
) {
    let step = grid_step(scale);
    let on_grid = at.map(|value| rounded(value, step));
    found.extend(near(guides, at, reach).map(|guide| Placed {
        words: "on the guide".into(),
        ..Placed::free(sheet, nearest(guide, on_grid))
    }));
}

/// Segment of a guide round its point nearest to a point of the sheet (m), to twice the reach on either side.
fn stretch(guide: &Guide, at: Vec2, reach: f64) -> Path {
    let middle = nearest(guide, at);
    let way = match guide.runs {
        GuideRun::Horizontal => Vec2::new(2.0 * reach, 0.0),
        GuideRun::Vertical => Vec2::new(0.0, 2.0 * reach),
    };
    Path::new(vec![Curve::Line {
        start: middle - way,
        end: middle + way,
    }])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guide(runs: GuideRun, at: f64) -> Guide {
        Guide {
            id: 1.into(),
            runs,
            at,
        }
    }

    #[test]
    fn the_nearest_guide_is_at_a_place() {
        let guides = [
            guide(GuideRun::Horizontal, 0.1),
            guide(GuideRun::Vertical, 0.2),
        ];
        let at = |x, y| {
            let found = guide_at(&guides, Vec2::new(x, y), 1000.0);
            found.map(|(guide, _)| guide.runs)
        };
        assert_eq!(at(5.0, 0.104), Some(GuideRun::Horizontal));
        assert_eq!(at(0.203, -5.0), Some(GuideRun::Vertical));
        assert_eq!(at(0.201, 0.104), Some(GuideRun::Vertical));
        assert_eq!(at(0.21, 0.11), None);
    }

    #[test]
    fn of_two_guides_within_reach_the_nearer_comes_first() {
        let guides = [0.1, 0.105].map(|at| guide(GuideRun::Horizontal, at));
        for at in [0.1, 0.105] {
            let mut found = Vec::new();
            on_guides(
                1.into(),
                &guides,
                (Vec2::new(0.3, at), 0.01, 1000.0),
                &mut found,
            );
            assert_eq!(found[0].at.y, at);
        }
    }

    #[test]
    fn places_near_guides_lie_on_them_to_the_bit() {
        let guides = [
            guide(GuideRun::Horizontal, 0.1234567),
            guide(GuideRun::Vertical, 0.2),
        ];
        let own = on_sheet(&guides, Vec2::new(0.5, 0.0));
        let mut found = Vec::new();
        let sheet = SheetId(0);
        let near = Vec2::new(-0.297, 0.124);
        crossings(sheet, &own, (near, 0.005), &mut found);
        on_guides(sheet, &own, (near, 0.005, 1000.0), &mut found);
        let places: Vec<Vec2> = found.iter().map(|placed| placed.at).collect();
        let upright = 0.2 - 0.5;
        assert_eq!(
            places,
            [
                Vec2::new(upright, 0.1234567),
                Vec2::new(-0.3, 0.1234567),
                Vec2::new(upright, 0.12),
            ]
        );
        assert!(found.iter().all(|placed| placed.words.contains("guide")));
    }
}
