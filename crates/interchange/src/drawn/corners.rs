//! Corners of a line: where the file marks them, else where it kinks, or where a curve and a straight line meet.

use super::piece::{DrawnLine, Span};
use toile_geometry::Vec2;

/// Least turn of a line that is a corner, where the file marks none (rad): 10 degrees.
const MIN_KINK: f64 = 10.0 / 180.0 * std::f64::consts::PI;
/// Turn from which a vertex is no vertex of a curve, however coarse (rad): 30 degrees.
const MIN_SURE_KINK: f64 = 30.0 / 180.0 * std::f64::consts::PI;
/// Share of the turn of a vertex of a coarse curve that its neighbours turn by at least (1).
const MIN_ALIKE: f64 = 0.6;
/// Fewest vertices in a row at which a curve bends (1): two may be the corners of a straight side.
const UNMARKED_ROW: usize = 3;
/// The same where the file marks corners, and none of these.
pub(crate) const MARKED_ROW: usize = 2;
/// Chords beside a vertex whose lengths differ by this factor or more are not of one curve (1).
const UNLIKE_CHORDS: f64 = 4.0;
/// Share of the turn that a long chord of a curve would make with the chord before, below which it is none of the curve
/// (1).
const NOT_OF_CURVE: f64 = 0.5;
/// Least turn at a vertex of a curve, between chords of one straight line (rad): coordinates are rounded.
const MIN_BEND: f64 = 5e-3;
/// Least distance at which a point of a curve tells the direction at a vertex (m).
const MIN_WAY: f64 = 5e-4;
/// Largest distance of a vertex from a straight line that still lies on it (m).
pub(crate) const STRAIGHT: f64 = 1e-5;

/// Indices of the corners of a line, in order; `further` are vertices that must be corners. A closed line has
/// at least two, an open one its ends.
pub(crate) fn corners(line: &DrawnLine, further: &[usize]) -> Vec<usize> {
    let count = line.len();
    let marked = line.is_corner.iter().any(|&is_corner| is_corner);
    let is_chord = |k: usize| line.span(k) == Span::Chord;
    let is_corner = |k: usize| {
        let is_end = !line.is_closed && (k == 0 || k + 1 == count);
        let is_kink = || (0..line.by_size.len()).any(|size| is_kink(line, size, k));
        is_end
            || further.contains(&k)
            || is_turn(line, k)
            || match marked {
                true => line.is_corner.get(k) == Some(&true),
                false => is_chord(k) && (is_kink() || ends_curve(line, k)),
            }
    };
    let mut found: Vec<usize> = (0..count).filter(|&k| is_corner(k)).collect();
    if line.is_closed && found.len() < 2 && count > 1 {
        let first = found.first().copied().unwrap_or(0);
        found = vec![first, (first + count / 2) % count];
        found.sort_unstable();
    }
    found
}

/// Whether a line that says its spans turns at a vertex: two of another kind meet there, two straight ones, or two
/// curves at an angle.
fn is_turn(line: &DrawnLine, k: usize) -> bool {
    let count = line.len();
    let before = (k + count - 1) % count;
    match (line.span(before), line.span(k)) {
        (Span::Chord, Span::Chord) => false,
        (Span::Cubic(a), Span::Cubic(b)) => {
            let points = line.in_size(0);
            let at = |k: usize| points[k % count];
            // A handle may lie on its vertex; the next point then shows the direction.
            let first = |from: Vec2, to: [Vec2; 3]| {
                let ways = to.into_iter().map(|p| p - from);
                ways.into_iter().find(|way| way.norm() > STRAIGHT)
            };
            let into = first(at(k), [a[1], a[0], at(before)]).map(|way| -way);
            let out = first(at(k), [b[0], b[1], at(k + 1)]);
            match (into, out) {
                (Some(a), Some(b)) => angle(a, b).abs() > MIN_KINK,
                _ => true,
            }
        }
        (Span::Straight | Span::Chord, _) | (Span::Cubic(_), _) => true,
    }
}

/// Whether a line that marks no corners has one at a vertex in a size: it turns by more than 10 degrees, and not as its
/// neighbours do.
pub(crate) fn is_kink(line: &DrawnLine, size: usize, k: usize) -> bool {
    is_kink_but(line, size, k, UNMARKED_ROW)
}

/// Whether a line turns at a vertex by more than 10 degrees, and is no vertex of a curve, which bends at so many
/// vertices in a row at least.
pub(crate) fn is_kink_but(line: &DrawnLine, size: usize, k: usize, row: usize) -> bool {
    let turn = turn(line, size, k);
    turn.abs() > MIN_KINK && !is_of_coarse_curve(line, size, (k, turn), row)
}

/// The angle by which a line turns to the left at a vertex in a size (rad); 0 at the ends of an open line and at a
/// vertex that repeats its neighbour.
fn turn(line: &DrawnLine, size: usize, k: usize) -> f64 {
    let points = line.in_size(size);
    let n = points.len();
    if !line.is_closed && (k == 0 || k + 1 == n) {
        return 0.0;
    }
    let before = (k + n - 1) % n;
    // Points of the curve say better than vertices which way it runs; very near ones do not, as they are rounded.
    let is_off = |p: &&Vec2| (*p - points[k]).norm() > MIN_WAY;
    let from = line.between_in(size, before).iter().rev().find(is_off);
    let to = line.between_in(size, k).iter().find(is_off);
    let from = from.copied().unwrap_or(points[before]);
    let to = to.copied().unwrap_or(points[(k + 1) % n]);
    angle(points[k] - from, to - points[k])
}

/// The angle from one vector to another, positive to the left (rad); 0 where one has no length.
fn angle(a: Vec2, b: Vec2) -> f64 {
    match a.norm() > 0.0 && b.norm() > 0.0 {
        true => a.perp(&b).atan2(a.dot(&b)),
        false => 0.0,
    }
}

/// Whether a vertex at which a line turns is one of a curve of few vertices: the line turns alike at its neighbours, but
/// for one at which the curve ends, and bends at so many vertices in a row. A curve ends at an end of the line, a corner
/// beyond doubt or a change to chords of another length.
fn is_of_coarse_curve(line: &DrawnLine, size: usize, (k, own): (usize, f64), row: usize) -> bool {
    let count = line.len();
    let is_end = |k: usize, turn: f64| {
        let is_last = !line.is_closed && (k == 0 || k + 1 == count);
        is_last || turn.abs() > MIN_SURE_KINK || has_unlike_chords(line, size, k)
    };
    if is_end(k, own) {
        return false;
    }
    let mut bent = 1;
    for step in [count - 1, 1] {
        for far in 1..row {
            let k = (k + far * step) % count;
            let turn = turn(line, size, k);
            if is_end(k, turn) || (far > 1 && turn.abs() <= MIN_BEND) {
                break;
            }
            if far == 1 && turn * own.signum() < MIN_ALIKE * own.abs() {
                return false;
            }
            bent += 1;
        }
    }
    bent >= row
}

/// Whether the chords beside a vertex are too unlike in length for one curve, and the file has no points of them.
fn has_unlike_chords(line: &DrawnLine, size: usize, k: usize) -> bool {
    let points = line.in_size(size);
    let count = points.len();
    if !line.is_closed && (k == 0 || k + 1 == count) {
        return false;
    }
    let before = (k + count - 1) % count;
    let [a, b] = [before, k].map(|k| (points[(k + 1) % count] - points[k]).norm());
    let has_points = [before, k]
        .iter()
        .any(|&k| !line.between_in(size, k).is_empty());
    !has_points && a.max(b) >= UNLIKE_CHORDS * a.min(b)
}

/// Whether a curve and a straight line that goes on from it without a kink meet at a vertex: in every size one chord is
/// much longer than the other, at whose other end the line turns on, and turns less than a chord of the curve would.
fn ends_curve(line: &DrawnLine, k: usize) -> bool {
    let count = line.len();
    let ends = |size: usize| {
        let points = line.in_size(size);
        let length = |a: usize, b: usize| (points[a] - points[b]).norm();
        let [before, after] = [count - 1, 1].map(|step| (k + step) % count);
        let (other, beyond, long) = match length(before, k) < length(after, k) {
            true => (before, (k + count - 2) % count, length(after, k)),
            false => (after, (k + 2) % count, length(before, k)),
        };
        // A curve turns evenly along its chords, by half of what belongs to a chord at each end of it.
        let (turned, first) = (turn(line, size, other), length(k, other));
        let by_curve = turned * (first + long) / (first + length(other, beyond));
        has_unlike_chords(line, size, k)
            && turned.abs() > MIN_BEND
            && !is_kink(line, size, other)
            && turn(line, size, k) * by_curve.signum() < NOT_OF_CURVE * by_curve.abs()
    };
    (0..line.by_size.len()).all(ends)
}

/// Whether all points lie on the straight line from the first to the last.
pub(crate) fn is_straight(points: &[Vec2]) -> bool {
    lies_along(points, STRAIGHT)
}

/// Whether all points lie within a distance (m) of the straight line through the first and the last.
pub(crate) fn lies_along(points: &[Vec2], within: f64) -> bool {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return true;
    };
    let along = last - first;
    let length = along.norm();
    let off = |p: &Vec2| match length > 0.0 {
        true => (along.perp(&(p - first)) / length).abs(),
        false => (p - first).norm(),
    };
    points.iter().all(|p| off(p) <= within)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> DrawnLine {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [1.0, 1.0], [0.0, 1.0]];
        DrawnLine::one(points.map(Vec2::from).to_vec(), true)
    }

    #[test]
    fn kinks_are_corners_where_none_are_marked() {
        assert_eq!(corners(&square(), &[]), [0, 1, 3, 4]);
        assert_eq!(corners(&square(), &[2]), [0, 1, 2, 3, 4]);
        let marked = DrawnLine {
            is_corner: vec![true, false, true, false, false],
            ..square()
        };
        assert_eq!(corners(&marked, &[]), [0, 2]);
    }

    #[test]
    fn a_smooth_ring_has_two_corners_and_an_open_line_its_ends() {
        let at = |k: i32| {
            let turn = f64::from(k) / 48.0 * std::f64::consts::TAU;
            Vec2::new(turn.cos(), turn.sin())
        };
        let ring = DrawnLine::one((0..48).map(at).collect(), true);
        assert_eq!(corners(&ring, &[]), [0, 24]);
        let open = DrawnLine::one((0..10).map(at).collect(), false);
        assert_eq!(corners(&open, &[]), [0, 9]);
    }

    #[test]
    fn straightness_is_a_hundredth_of_a_millimetre() {
        let bent = |by: f64| [Vec2::zeros(), Vec2::new(0.5, by), Vec2::new(1.0, 0.0)];
        assert!(is_straight(&bent(9e-6)) && !is_straight(&bent(2e-5)));
    }

    #[test]
    fn vertices_of_a_coarse_curve_are_no_corners_but_those_beside_straight_lines_are() {
        // A quarter of a circle that turns by 15 degrees at each vertex, between straight lines; the first goes on from it
        // without a kink, the other ends in one of 20 degrees.
        let at = |k: i32| {
            let turn = f64::from(k) * 15.0_f64.to_radians();
            Vec2::new(0.1 * turn.sin(), 0.1 - 0.1 * turn.cos())
        };
        let mut points = vec![Vec2::new(-0.2, 0.0)];
        points.extend((0..=6).map(at));
        points.push(Vec2::new(0.0, 0.3));
        let line = DrawnLine::one(points, true);
        let found = corners(&line, &[]);
        assert_eq!(found, [0, 1, 7, 8]);
        // Vertices of a straight line are no corners, however long its chords.
        let split = [
            [0.0, 0.0],
            [0.9, 0.0],
            [0.95, 0.0],
            [1.0, 0.0],
            [1.0, 0.8],
            [0.0, 0.8],
        ];
        let line = DrawnLine::one(split.map(Vec2::from).to_vec(), true);
        assert_eq!(corners(&line, &[]), [0, 3, 4, 5]);
        // Two turns of 20 degrees between straight sides are corners.
        let sides = [
            [0.0, 0.0],
            [0.2, 0.0],
            [0.3879, 0.0684],
            [0.5411, 0.197],
            [0.2411, 0.497],
            [-0.1, 0.4],
        ];
        let line = DrawnLine::one(sides.map(Vec2::from).to_vec(), true);
        assert_eq!(corners(&line, &[]), [0, 1, 2, 3, 4, 5]);
        // A curve that is open has the ends of the line and no others.
        let open = DrawnLine::one((0..7).map(at).collect(), false);
        assert_eq!(corners(&open, &[]), [0, 6]);
        // A row of bends of 15 degrees at long chords alone is no curve.
        let bent = [
            [0.0, 0.0],
            [0.5, 0.0],
            [0.52, 0.005],
            [1.0, 0.27],
            [1.0, 0.8],
            [0.0, 0.8],
        ];
        let line = DrawnLine::one(bent.map(Vec2::from).to_vec(), true);
        assert_eq!(corners(&line, &[]), [0, 1, 2, 3, 4, 5]);
    }

    #[test]
    fn a_stray_vertex_of_a_curve_is_no_corner() {
        let at = |turn: f64| Vec2::new(turn.to_radians().cos(), turn.to_radians().sin()) * 0.1;
        let mut points: Vec<Vec2> = (0..=15).map(|k| at(6.0 * f64::from(k))).collect();
        points.insert(8, at(42.6));
        points.push(Vec2::zeros());
        let line = DrawnLine::one(points, true);
        assert_eq!(corners(&line, &[]), [0, 16, 17]);
    }

    #[test]
    fn a_vertex_that_is_written_twice_turns_nowhere() {
        for [x, y] in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]] {
            let at = |k: i32| Vec2::new(x, y) * f64::from(k) * 0.1;
            let line = DrawnLine::one([0, 1, 1, 2].map(at).to_vec(), false);
            assert_eq!(corners(&line, &[]), [0, 3]);
        }
    }
}
