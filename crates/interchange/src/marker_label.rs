//! Where the words of a piece go, and how large; how many words fit a line.

use crate::pdf::letter_width;
use toile_geometry::{Polygon, Vec2, point_segment_distance};

/// How much wider than in Helvetica a line may come out in another sans-serif font: in DejaVu Sans
/// and Verdana it is about 1.17 times as long.
const WIDER: f64 = 1.25;

/// A text in lines of at most a length, at a size of letters in the same unit, whatever sans-serif
/// font draws it: broken between words, and within a word that is longer than a line.
pub(crate) fn lines_within(text: &str, size: f64, length: f64) -> Vec<String> {
    // Letters of other scripts may be as wide as high.
    let wide = |c: char| letter_width(c).map_or(1.0, |width| width * WIDER) * size;
    let width = |text: &str| text.chars().map(wide).sum::<f64>();
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(line) + width(" ") + width(word) <= length => {
                line.push(' ');
                line.push_str(word);
                continue;
            }
            _ => lines.push(String::new()),
        }
        let mut taken = 0.0;
        for c in word.chars() {
            if taken > 0.0 && taken + wide(c) > length {
                lines.push(String::new());
                taken = 0.0;
            }
            taken += wide(c);
            if let Some(line) = lines.last_mut() {
                line.push(c);
            }
        }
    }
    lines
}

/// Where the words of a piece go, in the units of its polygon.
pub(crate) struct Spot {
    pub at: Vec2,
    /// Distance to the outline.
    pub room: f64,
    /// Free length through the point along x and y.
    pub runs: [f64; 2],
}

/// The size of letters that fit, at most the one asked, and whether they run upwards.
pub(crate) fn size_on(spot: &Spot, words: &str, size: f64) -> (f64, bool) {
    // A letter is about 0.55 of its height wide.
    let letters = words.chars().count().max(1) as f64;
    let fitted = |run: f64| size.min(0.85 * run / (0.55 * letters)).max(0.003);
    let upright = fitted(spot.runs[0]) < 0.6 * size && spot.runs[1] > 1.5 * spot.runs[0];
    (fitted(spot.runs[usize::from(upright)]), upright)
}

/// The point of a grid that lies far inside and near the middle.
pub(crate) fn roomiest_spot(polygon: &Polygon) -> Spot {
    const CELLS: u32 = 24;
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
        runs: [0, 1].map(|axis| free_run(polygon, at, axis)),
    }
}

/// Twice the way from a point to the nearer side of the outline along an axis.
fn free_run(polygon: &Polygon, at: Vec2, axis: usize) -> f64 {
    let other = 1 - axis;
    let crossed = |[a, b]: [Vec2; 2]| {
        let spans = (a[other] <= at[other]) != (b[other] <= at[other]);
        let share = (at[other] - a[other]) / (b[other] - a[other]);
        spans.then(|| (a[axis] + (b[axis] - a[axis]) * share - at[axis]).abs())
    };
    2.0 * polygon
        .edges()
        .filter_map(crossed)
        .fold(f64::INFINITY, f64::min)
}
