//! Rows of flared pieces, laid round the trunk as a cone: at the top level with the pieces they hang from,
//! below wider and in folds.

use crate::flat_pieces::{FlatPiece, Tie};
use crate::outline_curve::OutlineCurve;
use crate::part_frames::PartFrame;
use crate::role::Role;
use crate::rows::Row;
use crate::surroundings::{Fit, Surroundings, arm_distance, skin_outline};
use std::f64::consts::TAU;
use toile_geometry::{Vec2, Vec3, closed_length, convex_hull};
use toile_pattern::Facing;

/// Initial distance of cloth from the convex hull of the skin (m).
const FIRST_DISTANCE: f64 = 0.012;
/// Largest radial widening of the cone per metre of cloth, so that it stays below arms that are held out at
/// 45 degrees.
const WIDEST: f64 = 0.5;
/// Number of levels at which the cone is computed.
const LEVELS: usize = 24;
/// Largest height of folds per metre of cloth below the inner edge.
const FOLDS: f64 = 0.45;
/// Height above the floor below which no cloth is laid (m).
const FLOOR: f64 = 0.03;

/// The cone at one distance below the inner edge.
struct Level {
    height: f64,
    curve: OutlineCurve,
}

/// Positions of the pieces of a row with flared pieces (m), in the order of the row.
pub(crate) fn wrap_flared(
    row: &Row,
    laid: &[FlatPiece],
    around: &Surroundings,
    frame: &PartFrame,
    fit: Fit,
) -> Vec<Vec<Vec3>> {
    let flared = || row.pieces.iter().filter(|&&k| laid[k].turn > 0.0);
    let rise = flared().map(|&k| laid[k].rise).sum::<f64>() / flared().count().max(1) as f64;
    let top = rise + fit.lift;
    let lowest = row.pieces.iter().map(|&k| laid[k].span()[0]);
    let depth = (rise - lowest.fold(rise, f64::min)).max(1e-3);
    let cone = cone(row, around, frame, ([top, depth], fit.distance));
    let at = |piece: &FlatPiece, p: &Vec2| {
        let below = (rise - piece.rise - p.y).clamp(0.0, depth);
        let share = (p.x + piece.shift) / row.girth.max(1e-6);
        let level = below / depth * LEVELS as f64;
        let k = (level as usize).min(LEVELS - 1);
        let [upper, lower] = [0, 1].map(|next| {
            let Level { height, curve } = &cone[k + next];
            frame.on_curve(curve, 0, share * curve.length(), *height)
        });
        upper + (lower - upper) * (level - k as f64)
    };
    let place = |&k: &usize| laid[k].points.iter().map(|p| at(&laid[k], p)).collect();
    row.pieces.iter().map(place).collect()
}

/// The cone of a row from its top down (m). At each level it is as long as the cloth, in a constant number of
/// folds that suffices at the hem.
fn cone(
    row: &Row,
    around: &Surroundings,
    frame: &PartFrame,
    ([top, depth], distance): ([f64; 2], f64),
) -> Vec<Level> {
    let widens = (row.turn / TAU).min(WIDEST);
    let falls = (1.0 - widens * widens)
        .sqrt()
        .min(((top - FLOOR) / depth).max(0.05));
    let length = |below: f64| row.girth + row.turn * below;
    let ring = |below: f64| {
        let height = top - falls * below;
        let points = skin_outline(row.part, around, frame, [height, top]);
        let hull = closed_length(&convex_hull(&points));
        let most = FIRST_DISTANCE + WIDEST * below;
        let wanted = ((length(below) - hull) / TAU).clamp(FIRST_DISTANCE, most);
        let ring = OutlineCurve::ring(&points, Vec2::zeros(), wanted + distance);
        let room = arm_distance(row.part, around, frame, [height, height]);
        let room = (room - ring.reach(Vec2::zeros())).max(0.0);
        (height, ring, room.min(FOLDS * below))
    };
    let (_, hem, room) = ring(depth);
    let count = hem.fold_count(length(depth), room);
    (0..=LEVELS)
        .map(|k| {
            let below = depth * k as f64 / LEVELS as f64;
            let (height, ring, room) = ring(below);
            let wanted = length(below);
            let curve = match ring.length() < wanted && room > 1e-3 {
                true => ring.in_folds(count, wanted, room),
                false => ring,
            };
            Level { height, curve }
        })
        .collect()
}

/// Sets the positions of a flared row's pieces round the body: side by side as they are sewn, then rotated
/// together below the pieces they hang from, or else towards their facings.
pub(crate) fn set_flared_shifts(
    laid: &mut [FlatPiece],
    roles: &[Role],
    (row, rows): (&Row, &[Row]),
    ties: &[Tie],
    frame: &PartFrame,
) {
    let mut along = 0.0;
    for &k in &in_order(row, laid, ties) {
        laid[k].shift = along - laid[k].low.x;
        along += laid[k].width();
    }
    let girth_of = |k: usize| {
        let of = rows.iter().find(|r| r.pieces.contains(&k));
        of.map_or(0.0, |r| r.girth)
    };
    let mut turned = Vec2::zeros();
    let mut add = |angle: f64| turned += Vec2::new(angle.cos(), angle.sin());
    let mut is_tied = false;
    for tie in ties {
        for (own, other) in [(0, 1), (1, 0)] {
            let [a, b] = [tie.pieces[own], tie.pieces[other]];
            let girth = girth_of(b);
            if !row.pieces.contains(&a) || row.pieces.contains(&b) || girth <= 0.0 {
                continue;
            }
            let there = (laid[b].shift + tie.points[other].x) / girth;
            let here = (laid[a].shift + tie.points[own].x) / row.girth;
            add(TAU * (there - here));
            is_tied = true;
        }
    }
    if !is_tied {
        for &k in &row.pieces {
            let facing = match roles[k] {
                Role::Wrapped { facing, .. } => facing,
                Role::Placed(_) => Facing::Front,
            };
            let home = 0.25 * frame.quarter(facing) as f64;
            let middle = laid[k].shift + 0.5 * (laid[k].low.x + laid[k].high.x);
            add(TAU * (home - middle / row.girth));
        }
    }
    let by = turned.y.atan2(turned.x) / TAU * row.girth;
    for &k in &row.pieces {
        laid[k].shift += by;
    }
}

/// The pieces of a row in their order to the left round the body: the last side of each is sewn to the first
/// side of the next.
fn in_order(row: &Row, laid: &[FlatPiece], ties: &[Tie]) -> Vec<usize> {
    let middle = |k: usize| 0.5 * (laid[k].low.x + laid[k].high.x);
    let follows = |a: usize, b: usize| {
        ties.iter()
            .filter(|tie| {
                [(0, 1), (1, 0)].iter().any(|&(x, y)| {
                    tie.pieces[x] == a
                        && tie.pieces[y] == b
                        && tie.points[x].x > middle(a)
                        && tie.points[y].x < middle(b)
                })
            })
            .count()
    };
    let mut order: Vec<usize> = Vec::new();
    for start in 0..row.pieces.len() {
        let mut at = start;
        while !order.contains(&row.pieces[at]) {
            order.push(row.pieces[at]);
            let next = (0..row.pieces.len())
                .filter(|&n| !order.contains(&row.pieces[n]))
                .max_by_key(|&n| (follows(row.pieces[at], row.pieces[n]), usize::MAX - n));
            match next.filter(|&n| follows(row.pieces[at], row.pieces[n]) > 0) {
                Some(next) => at = next,
                None => break,
            }
        }
    }
    order
}
