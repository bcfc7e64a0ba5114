//! Marks of a piece: corners, notches and drill holes, which stand at vertices of its lines.
//!
//! They stand in the block of the sample size alone; other sizes have as many vertices and take them by number.

use super::block_piece::{BlockLine, BlockPiece};
use crate::drawn::allowance::{distance, nearest};
use crate::drawn::corners::{MARKED_ROW, is_kink_but};
use crate::drawn::piece::{DrawnLine, DrawnNotch};
use std::collections::BTreeMap;
use toile_geometry::Vec2;
use toile_pattern::NotchKind;

/// Largest distance of a mark from the vertex that it names (m).
const ON_VERTEX: f64 = 5e-4;
/// Largest distance of a corner of the sew line from the corner of the cut line that belongs to it (m).
const MAX_CORNER: f64 = 0.075;
/// Vertices that lie nearer to each other are in one place (m).
const ONE_VERTEX: f64 = 1e-6;
/// Share of the length of an outline within which two places are one (1).
const ONE_PLACE: f64 = 1e-4;

/// The block of a size with the marks and labels of the block that has them: its own, or that of the size with most
/// marks.
pub(super) fn with_marks(own: &BlockPiece, sized: &BTreeMap<usize, BlockPiece>) -> BlockPiece {
    let mut own = own.clone();
    if own.marks() == 0
        && let Some(donor) = sized.values().max_by_key(|piece| piece.marks())
        && let (Some(from), Some(to)) = (donor.cut.first(), own.cut.first().cloned())
        && from.points.len() == to.points.len()
    {
        let carried = |at: Vec2| carried(at, from, &to);
        own.turn_points = donor.turn_points.iter().map(|&at| carried(at)).collect();
        own.notches = donor
            .notches
            .iter()
            .map(|&(at, kind)| (carried(at), kind))
            .collect();
        own.notch_lines = donor.notch_lines.clone();
        for (line, _) in &mut own.notch_lines {
            line.points.iter_mut().for_each(|p| *p = carried(*p));
        }
    }
    for other in sized.values() {
        own.labels.add_all(&other.labels);
    }
    own
}

/// A place beside one line, beside another line with as many vertices.
fn carried(at: Vec2, from: &BlockLine, to: &BlockLine) -> Vec2 {
    let Some(found) = nearest(at, &from.points) else {
        return at;
    };
    let on = |line: &BlockLine| {
        let [a, b] = [found.chord, found.chord + 1].map(|k| line.points[k % line.points.len()]);
        a + (b - a) * found.share
    };
    on(to) + (at - on(from))
}

/// Places and shapes of notches that are drawn as lines across the cut line, or as a V with both ends on it.
pub(super) fn of_lines(own: &BlockPiece) -> Vec<(Vec2, NotchKind)> {
    let Some(cut) = own.cut.first() else {
        return Vec::new();
    };
    let gap = ONE_PLACE * cut.length();
    let of = |(line, kind): &(BlockLine, NotchKind)| {
        let off = |p: &Vec2| distance(*p, &cut.points);
        let least = line.points.iter().map(off).fold(f64::INFINITY, f64::min);
        let on = line.points.iter().filter(|p| off(p) <= least + gap);
        let count = on.clone().count().max(1) as f64;
        (on.sum::<Vec2>() / count, *kind)
    };
    own.notch_lines.iter().map(of).collect()
}

/// The notches of a piece, with their places in those sizes whose blocks have as many.
pub(super) fn notches(
    own: &BlockPiece,
    sized: &BTreeMap<usize, BlockPiece>,
    (count, unit): (usize, f64),
) -> Vec<DrawnNotch> {
    let all = |piece: &BlockPiece| -> Vec<(Vec2, NotchKind)> {
        let lines = of_lines(piece);
        piece.notches.iter().copied().chain(lines).collect()
    };
    let own = all(own);
    let sized: Vec<Option<Vec<(Vec2, NotchKind)>>> = (0..count)
        .map(|size| {
            sized
                .get(&size)
                .map(all)
                .filter(|all| all.len() == own.len())
        })
        .collect();
    let of = |(k, &(at, kind)): (usize, &(Vec2, NotchKind))| DrawnNotch {
        at: at * unit,
        in_sizes: sized
            .iter()
            .map(|all| all.as_ref().map(|all| all[k].0 * unit))
            .collect(),
        kind,
    };
    own.iter().enumerate().map(of).collect()
}

/// For each vertex of an outline, whether a turn point of the file belongs to it; empty without turn points. They
/// stand on the cut line, of which the outline may be the sew line.
pub(super) fn corners(
    outline: &DrawnLine,
    cut: &[Vec2],
    own: &BlockPiece,
    (base, unit): (usize, f64),
) -> Vec<bool> {
    let vertices = outline.in_size(base);
    let mut is_corner = vec![false; vertices.len()];
    let mut is_beside = false;
    let mut points: Vec<Vec2> = own.turn_points.iter().map(|p| p * unit).collect();
    // They are often repeated.
    let key = |p: &Vec2| [p.x, p.y].map(|x| (x * 1e6).round() as i64);
    points.sort_by_key(key);
    points.dedup_by_key(|p| key(p));
    // Vertices that lie in one place in this size are corners together: in others they lie apart.
    let mut mark = |k: usize| {
        let is_here = |p: &Vec2| (p - vertices[k]).norm() <= ONE_VERTEX;
        let here = vertices.iter().enumerate().filter(|(_, p)| is_here(p));
        here.for_each(|(j, _)| is_corner[j] = true);
    };
    for at in points {
        if let Some(k) = vertex_at(vertices, at, ON_VERTEX) {
            mark(k);
        } else if let Some(k) = vertex_at(cut, at, ON_VERTEX) {
            is_beside = true;
            let same = (cut.len() == vertices.len()).then_some(k);
            let same = same.filter(|&k| (vertices[k] - at).norm() <= MAX_CORNER);
            if let Some(k) = same.or_else(|| vertex_at(vertices, at, MAX_CORNER)) {
                mark(k);
            }
        }
    }
    if is_beside {
        for (k, is_corner) in is_corner.iter_mut().enumerate() {
            *is_corner |= is_kink_but(outline, base, k, MARKED_ROW);
        }
    }
    match is_corner.iter().any(|&is_corner| is_corner) {
        true => is_corner,
        false => Vec::new(),
    }
}

/// The vertex nearest to a place, within a distance (m).
fn vertex_at(vertices: &[Vec2], at: Vec2, within: f64) -> Option<usize> {
    let off = |k: &usize| (vertices[*k] - at).norm();
    let nearest = (0..vertices.len()).min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.filter(|k| off(k) <= within)
}

/// Places of drill holes in each size: those of its block if it has as many, else moved like the vertex of the
/// outline that is nearest in the base size.
pub(super) fn drills(
    own: &BlockPiece,
    sized: &BTreeMap<usize, BlockPiece>,
    (outline, base, unit): (&DrawnLine, usize, f64),
) -> Vec<Vec<Vec2>> {
    let vertices = outline.in_size(base);
    let of = |(k, &at): (usize, &Vec2)| {
        let at = at * unit;
        let vertex = vertex_at(vertices, at, f64::INFINITY);
        let in_size = |size: usize| {
            let block = sized.get(&size).map(|piece| &piece.drills);
            match (
                block.filter(|drills| drills.len() == own.drills.len()),
                vertex,
            ) {
                (Some(drills), _) => drills[k] * unit,
                (None, Some(vertex)) => at + outline.in_size(size)[vertex] - vertices[vertex],
                (None, None) => at,
            }
        };
        (0..outline.by_size.len()).map(in_size).collect()
    };
    own.drills.iter().enumerate().map(of).collect()
}
