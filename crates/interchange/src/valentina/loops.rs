//! Loops of an outline that crosses itself: the outline goes on from the crossing, as in the other program.

use super::build::Build;
use super::nodes::{Outline, Stretch};
use super::things::{CurveThing, PointThing};
use std::sync::Arc;
use toile_geometry::{Bounds2, Curve as Piece, Path, Vec2};
use toile_pattern::PointRule;

/// Distance from the ends of a stretch within which nothing is a crossing (m).
const NEAR_ENDS: f64 = 5e-5;
/// Difference within which two places are the same crossing (m).
const SAME_PLACE: f64 = 1e-6;

/// Area of a slit as a share of its squared length, at most (1).
const SLIT: f64 = 1e-3;
/// Largest number of stretches of an outline that is searched for loops.
const MAX_STRETCHES: usize = 400;

/// A crossing of two stretches of an outline.
struct Crossing {
    /// Indices of the stretches, the earlier one first.
    stretches: [usize; 2],
    /// Lengths from the starts of both (m).
    along: [f64; 2],
    at: Vec2,
    /// The corner that is there already: the start of the later stretch, where it lies on the earlier one and
    /// goes on along it, or the end of the earlier one, to which the outline returns.
    corner: Option<PointThing>,
}

/// Leaves out the loops of a closed outline, and returns their number: from its first node on, each crossing
/// with a later stretch is followed into that stretch.
pub(super) fn leave_out_loops(build: &mut Build, outline: &mut Outline) -> usize {
    if outline.stretches.len() > MAX_STRETCHES {
        return 0;
    }
    let mut count = leave_out_slits(&mut outline.stretches);
    count += usize::from(leave_out_start(&mut outline.stretches));
    let mut from = 0;
    while let Some(found) = first_crossing(&outline.stretches, from) {
        let [i, j] = found.stretches;
        let [Some(first), Some(second)] =
            [i, j].map(|k| build.wholes.get(&outline.stretches[k].curve).cloned())
        else {
            return count;
        };
        let corner = match (found.corner, rule([&first, &second], found.at)) {
            (Some(corner), _) => corner,
            (None, Some(rule)) => build.add_point("crossing of the outline", rule, found.at),
            (None, None) => {
                // It is no crossing of the curves as a whole: the outline stays as it is there.
                from = i + 1;
                continue;
            }
        };
        if is_tip(&outline.stretches, &found) {
            leave_out_tip(&mut outline.stretches, &found, corner);
            count += 1;
            continue;
        }
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

/// Leaves out slits, in which an outline goes in and comes back to the same corner, and returns their number.
fn leave_out_slits(stretches: &mut Vec<Stretch>) -> usize {
    let mut count = 0;
    let mut i = 0;
    while i < stretches.len() {
        let corner = stretches[i].ends[0].id;
        let back = (i + 2..stretches.len())
            .find(|&j| stretches[j].ends[0].id == corner && is_slit(&stretches[i..j]));
        match back {
            Some(j) => {
                stretches.drain(i..j);
                count += 1;
            }
            None => i += 1,
        }
    }
    count
}

/// Leaves out what lies before the last return to the first corner; says whether there was such a return.
fn leave_out_start(stretches: &mut Vec<Stretch>) -> bool {
    let Some(first) = stretches.first().map(|one| one.ends[0]) else {
        return false;
    };
    let returns = |one: &Stretch| is_same_place(one.ends[0].at, first.at);
    let last = stretches.iter().rposition(returns);
    // A single stretch is no outline.
    let last = last.filter(|&last| last > 0 && last + 2 <= stretches.len());
    if let Some(last) = last {
        stretches[last].ends[0] = first;
        stretches.drain(..last);
    }
    last.is_some()
}

/// Whether the last stretch crosses the first nearer to their common corner, along both, than to the rest.
fn is_tip(stretches: &[Stretch], found: &Crossing) -> bool {
    let [i, j] = found.stretches;
    let Some((first, last)) = stretches.first().zip(stretches.last()) else {
        return false;
    };
    let is_short = |along: f64, of: &Stretch| along < of.path.length() / 2.0;
    i == 0
        && j + 1 == stretches.len()
        && is_short(found.along[0], first)
        && is_short(last.path.length() - found.along[1], last)
}

/// Leaves out the tip in which an outline begins and ends: it begins and ends where that crosses itself.
fn leave_out_tip(stretches: &mut [Stretch], found: &Crossing, corner: PointThing) {
    if let Some(first) = stretches.first_mut() {
        first.path = first.path.between(found.along[0], first.path.length());
        first.ends[0] = corner;
    }
    if let Some(last) = stretches.last_mut() {
        last.path = last.path.between(0.0, found.along[1]);
        last.ends[1] = corner;
    }
}

fn is_same_place(a: Vec2, b: Vec2) -> bool {
    (a - b).norm() <= SAME_PLACE
}

/// Whether stretches that close by themselves hold next to nothing between them.
fn is_slit(stretches: &[Stretch]) -> bool {
    let curves = stretches.iter().flat_map(|one| one.path.curves());
    let area = curves.map(Piece::swept_area).sum::<f64>().abs() / 2.0;
    let length: f64 = stretches.iter().map(|one| one.path.length()).sum();
    area <= SLIT * length * length
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
        // Of several returns to one corner the last counts.
        let first = found.min_by(|a, b| {
            let order = a.along[0].total_cmp(&b.along[0]);
            order.then(b.stretches[1].cmp(&a.stretches[1]))
        });
        if first.is_some() {
            return first;
        }
    }
    None
}

/// The crossing of two stretches, apart from their ends, that comes first along the earlier one.
fn crossing(stretches: &[Stretch], [i, j]: [usize; 2]) -> Option<Crossing> {
    let (a, b) = (&stretches[i], &stretches[j]);
    if let Some(along) = taken_up(a, b).filter(|_| j > i + 1) {
        let corner = b.ends[0];
        return Some(Crossing {
            stretches: [i, j],
            along: [along, 0.0],
            at: corner.at,
            corner: Some(corner),
        });
    }
    let corner = a.ends[1];
    let returns = j > i + 1 && is_same_place(corner.at, b.ends[0].at);
    let back = returns.then(|| Crossing {
        stretches: [i, j],
        along: [a.path.length(), 0.0],
        at: corner.at,
        corner: Some(corner),
    });
    if a.curve == b.curve {
        return back;
    }
    // Where a begins, the stretch before it meets b already; where b ends, a meets the stretch after it.
    let [start, end] = [a.ends[0].at, b.ends[1].at];
    let shared = [corner.at, b.ends[0].at];
    let all = a.path.crossings(&b.path).into_iter();
    let mut inner = all.filter(|one| {
        let is_near = |at: &Vec2| (one.point - at).norm() <= NEAR_ENDS;
        !(is_near(&start) || is_near(&end) || shared.iter().all(is_near))
    });
    let inner = inner.next().map(|one| Crossing {
        stretches: [i, j],
        along: [one.here.along, one.there.along],
        at: one.point,
        corner: None,
    });
    inner.or(back)
}

/// Length along a straight stretch at which another begins that goes on along it, past its end or not.
fn taken_up(a: &Stretch, b: &Stretch) -> Option<f64> {
    let ends = |one: &Stretch| match one.path.curves() {
        [Piece::Line { start, end }] => Some([*start, *end]),
        _ => None,
    };
    let ([from, to], [start, end]) = (ends(a)?, ends(b)?);
    let (way, other) = (
        (to - from).try_normalize(1e-12)?,
        (end - start).try_normalize(1e-12)?,
    );
    let along = way.dot(&(start - from));
    let is_inside = (NEAR_ENDS..=(to - from).norm() - NEAR_ENDS).contains(&along);
    let is_on = way.perp(&(start - from)).abs() <= SAME_PLACE;
    let is_alike = way.dot(&other) > 0.0 && way.perp(&other).abs() <= 1e-6;
    (is_inside && is_on && is_alike).then_some(along)
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
