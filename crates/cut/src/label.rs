//! Places and sizes of the words on a piece.

use toile_geometry::{Polygon, Vec2, point_segment_distance};

/// Cells of the grid along each side of a polygon's box.
const CELLS: u32 = 24;
/// Width of a letter over its height, about.
const LETTER: f64 = 0.55;
/// Share of a free length that words take.
const FILLED: f64 = 0.85;
/// How far below their place words begin, over the distance to the outline.
pub(crate) const GAP: f64 = 0.05;
/// Height of all lines of words, one under another, over that distance.
pub(crate) const LINES: f64 = 0.85;
/// Least height of letters \[m\].
pub(crate) const SMALLEST: f64 = 0.003;

/// A place far inside a polygon, in its units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The place \[m\].
    pub at: Vec2,
    /// Distance to the outline \[m\].
    pub room: f64,
    /// Free length along x and y of lines of words from the place on \[m\].
    pub runs: [f64; 2],
}

impl Spot {
    /// The size of letters at which words fit, at most the one asked, and whether they run upwards.
    pub fn size_of(&self, words: &str, size: f64) -> (f64, bool) {
        let letters = words.chars().count().max(1) as f64;
        let fitted = |run: f64| size.min(FILLED * run / (LETTER * letters)).max(SMALLEST);
        let upright = fitted(self.runs[0]) < 0.6 * size && self.runs[1] > 1.5 * self.runs[0];
        (fitted(self.runs[usize::from(upright)]), upright)
    }
}

/// The point of a grid that lies far inside a polygon and near its middle.
pub fn roomiest_spot(polygon: &Polygon) -> Spot {
    let bounds = polygon.bounds();
    let centre = bounds.centre();
    let mut best = (0.0, centre, 0.0);
    for k in 0..CELLS * CELLS {
        let cell = Vec2::new(f64::from(k % CELLS) + 0.5, f64::from(k / CELLS) + 0.5);
        let point = bounds.min + bounds.size().component_mul(&cell) / f64::from(CELLS);
        if !polygon.contains(point) {
            continue;
        }
        let room = polygon
            .edges()
            .map(|edge| point_segment_distance(point, edge))
            .fold(f64::INFINITY, f64::min);
        let score = room / (1.0 + (point - centre).norm() / bounds.size().norm());
        if score > best.0 {
            best = (score, point, room);
        }
    }
    let (_, at, room) = best;
    Spot {
        at,
        room,
        runs: [0, 1].map(|axis| free_run(polygon, at, room, axis)),
    }
}

/// Twice the way from a point to the nearer side of the outline along an axis, in all the height
/// that lines of words take: below the point where they run along x, right of it where they run upwards.
fn free_run(polygon: &Polygon, at: Vec2, room: f64, axis: usize) -> f64 {
    let other = 1 - axis;
    let height = (GAP + LINES) * room;
    let [low, high] = match axis {
        0 => [at[other] - height, at[other]],
        _ => [at[other], at[other] + height],
    };
    let nearest = |[a, b]: [Vec2; 2]| {
        let [from, to] = [
            a[other].min(b[other]).max(low),
            a[other].max(b[other]).min(high),
        ];
        if from > to {
            return f64::INFINITY;
        }
        let place =
            |level: f64| a[axis] + (b[axis] - a[axis]) * (level - a[other]) / (b[other] - a[other]);
        let ends = match b[other] == a[other] {
            true => [a[axis], b[axis]],
            false => [from, to].map(place),
        };
        let [first, second] = ends.map(|end| end - at[axis]);
        match first * second <= 0.0 {
            true => 0.0,
            false => first.abs().min(second.abs()),
        }
    };
    2.0 * polygon.edges().map(nearest).fold(f64::INFINITY, f64::min)
}
