//! Loops of an outline that crosses itself: the outline goes on from the crossing, as in the other program.

use super::build::Build;
use super::nodes::{Outline, Stretch};
use super::things::CurveThing;
use std::sync::Arc;
use toile_geometry::{Bounds2, Curve as Piece, Path, Vec2};
use toile_pattern::PointRule;

/// Distance from the ends of a stretch within which nothing is a crossing (m).
const NEAR_ENDS: f64 = 5e-5;
/// Difference within which two places are the same crossing (m).
const SAME_PLACE: f64 = 1e-6;

/// Largest number of stretches of an outline that is searched for loops.
const MAX_STRETCHES: usize = 400;

/// A crossing of two stretches of an outline.
struct Crossing {
    /// Indices of the stretches, the earlier one first.
    stretches: [usize; 2],
    /// Lengths from the starts of both (m).
    along: [f64; 2],
    at: Vec2,
}

/// Leaves out the loops of a closed outline, and returns their number: from its first node on, each crossing
/// with a later stretch is followed into that stretch.
pub(super) fn leave_out_loops(build: &mut Build, outline: &mut Outline) -> usize {
    let mut count = 0;
    let mut from = 0;
    if outline.stretches.len() > MAX_STRETCHES {
        return count;
    }
    while let Some(found) = first_crossing(&outline.stretches, from) {
        let [i, j] = found.stretches;
        let [Some(first), Some(second)] =
            [i, j].map(|k| build.wholes.get(&outline.stretches[k].curve).cloned())
        else {
            return count;
        };
        let Some(rule) = rule([&first, &second], found.at) else {
            // It is no crossing of the curves as a whole: the outline stays as it is there.
            from = i + 1;
            continue;
        };
        let corner = build.add_point("crossing of the outline", rule, found.at);
        let start = &mut outline.stretches[i];
        start.path = start.path.between(0.0, found.along[0]);
        start.ends[1] = corner;
        let end = &mut outline.stretches[j];
        end.path = end.path.between(found.along[1], end.path.length());
        end.ends[0] = corner;
        outline.stretches.drain(i + 1..j);
        count += 1;
        from = i;
    }
    if count > 0 {
        let corners: Vec<_> = outline.stretches.iter().map(|one| one.ends[0].id).collect();
        outline
            .passmarks
            .retain(|(corner, _)| corners.contains(corner));
    }
    count
}

/// The first crossing of a stretch with a later one, from a stretch on.
fn first_crossing(stretches: &[Stretch], from: usize) -> Option<Crossing> {
    let bounds: Vec<Bounds2> = stretches
        .iter()
        .map(|one| Bounds2::of(one.path.curves().iter().flat_map(Piece::defining_points)))
        .collect();
    let meet = |i: usize, j: usize| {
        let (a, b) = (&bounds[i], &bounds[j]);
        a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y
    };
    for i in from..stretches.len() {
        let others = (i + 1..stretches.len()).filter(|&j| meet(i, j));
        let found = others.filter_map(|j| crossing(stretches, [i, j]));
        let first = found.min_by(|a, b| a.along[0].total_cmp(&b.along[0]));
        if first.is_some() {
            return first;
        }
    }
    None
}

/// The crossing of two stretches, apart from their ends, that comes first along the earlier one.
fn crossing(stretches: &[Stretch], [i, j]: [usize; 2]) -> Option<Crossing> {
    let (a, b) = (&stretches[i], &stretches[j]);
    if a.curve == b.curve {
        return None;
    }
    let ends = [a.ends[0].at, a.ends[1].at, b.ends[0].at, b.ends[1].at];
    let all = a.path.crossings(&b.path).into_iter();
    let mut inner = all.filter(|one| {
        let apart = |end: &Vec2| (one.point - end).norm() > NEAR_ENDS;
        ends.iter().all(apart)
    });
    inner.next().map(|one| Crossing {
        stretches: [i, j],
        along: [one.here.along, one.there.along],
        at: one.point,
    })
}

/// The ends of a curve that is one straight line.
fn straight(curve: &CurveThing) -> Option<[toile_pattern::PointId; 2]> {
    let is_straight = matches!(curve.path.curves(), [Piece::Line { .. }]);
    is_straight.then(|| curve.ends.map(|end| end.id))
}

/// The construction of a crossing of two curves at a place. `None`: there is none.
fn rule([first, second]: [&Arc<CurveThing>; 2], at: Vec2) -> Option<PointRule> {
    let number = |found: Vec<Vec2>| {
        let index = found
            .iter()
            .position(|one| (one - at).norm() <= SAME_PLACE)?;
        u16::try_from(index).ok()
    };
    let with_line = |line: &CurveThing, curve: &CurveThing| {
        let way = line.ends[1].at - line.ends[0].at;
        let unit = way.try_normalize(1e-12)?;
        let found = super::points::line_crossings(&curve.path, line.ends[0].at, unit);
        Some(PointRule::LineCrossing {
            line: line.ends.map(|end| end.id),
            curve: curve.id,
            index: number(found)?,
        })
    };
    match (straight(first), straight(second)) {
        (Some(first), Some(second)) => Some(PointRule::Crossing { first, second }),
        (Some(_), None) => with_line(first, second),
        (None, Some(_)) => with_line(second, first),
        (None, None) => {
            let path: &Path = &first.path;
            let found = path.crossings(&second.path);
            Some(PointRule::CurveCrossing {
                curves: [first.id, second.id],
                index: number(found.iter().map(|one| one.point).collect())?,
            })
        }
    }
}
