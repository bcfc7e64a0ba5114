//! The cost of sewing one edge to another, from both edges alone.

use super::edges::{CHORDS, SeamEdge};
use super::places::Places;
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// Cost of lengths that differ by far more than [`LENGTH_SCALE`] (1).
const LENGTH: f64 = 3.0;
/// Difference of lengths, as a part of the longer, at which two thirds of [`LENGTH`] are counted (1).
const LENGTH_SCALE: f64 = 0.08;
/// Cost of the whole length of the longer edge (1): of two gathers the smaller is preferred.
const GATHER: f64 = 1.5;
/// Cost of an end at which the outlines do not go on into each other (1).
const ANGLE: f64 = 0.8;
/// Angle by which an end may be off for two thirds of [`ANGLE`] (rad).
const ANGLE_SCALE: f64 = 30.0 * PI / 180.0;
/// Cost of an end at which the sewing goes on along the next edges of both pieces (1).
const GOING_ON: f64 = 0.1;
/// Cost of edges of other shapes (1).
const SHAPE: f64 = 1.5;
/// Distance of shapes, as a part of the length, at which two thirds of [`SHAPE`] are counted (1).
const SHAPE_SCALE: f64 = 0.05;
/// Cost of two edges that both bulge outwards, or both inwards (1).
const SAME_BULGE: f64 = 0.6;
/// Turning of an edge up to which it counts as straight (rad).
pub(super) const STRAIGHT: f64 = 15.0 * PI / 180.0;
/// Turning beyond [`STRAIGHT`] from which [`SAME_BULGE`] counts whole (rad).
const BENT: f64 = 30.0 * PI / 180.0;
/// Cost of grains that point apart when the edges are sewn (1).
const GRAIN: f64 = 0.6;
/// Cost of edges that point apart in space (1).
const DIRECTION: f64 = 0.8;
/// Cost of edges 2.7 times as far from each other in space as their nearest edges are (1).
const PLACE: f64 = 1.0;
/// Largest cost of a distance in space (1).
const MAX_PLACE: f64 = 1.5;
/// Cost of edges of one piece (1).
const SAME_PIECE: f64 = 1.5;
/// Cost of edges of one piece that share a corner, unless they may be the legs of a dart (1).
const SAME_CORNER: f64 = 1.5;
/// Widest opening between two edges that may be the legs of a dart (rad).
pub(super) const MAX_DART: f64 = 45.0 * PI / 180.0;
/// Cost of an edge on the wearer's left with one on the right (1).
const SIDES: f64 = 0.7;
/// Cost of an edge with its own mirror image: seams along the middle are fewer than others (1).
const IMAGE: f64 = 0.7;
/// Cost of two lower borders: hems are not sewn to each other (1).
const HEMS: f64 = 1.0;
/// Cost of other seam allowances (1).
const ALLOWANCE: f64 = 0.5;
/// Smallest difference of seam allowances that counts (m).
const SAME_ALLOWANCE: f64 = 1e-4;
/// Gain of notches that meet; half of it is the cost of notches on one edge alone (1).
const NOTCHES: f64 = 0.5;
/// Distance within which notches meet, as a part of the length (1).
const NOTCH_REACH: f64 = 0.05;
/// Gain of names that share a word (1).
const NAMES: f64 = 0.3;
/// Words in names of edges that say nothing on their partners.
const PLAIN_WORDS: [&str; 9] = [
    "edge", "line", "seam", "hem", "neck", "neckline", "cuff", "opening", "fold",
];
/// Letters of the shortest word that counts.
const MIN_WORD: usize = 4;

/// Largest gain of all that lowers a cost (1).
pub(super) const MAX_GAIN: f64 = NOTCHES + NAMES;

/// What is known of all edges beside their own geometry.
pub(super) struct Known<'a> {
    /// The edges.
    pub edges: &'a [SeamEdge],
    /// Their places in space.
    pub places: &'a Places,
    /// Their mirror images.
    pub images: &'a [Option<usize>],
    /// Sides of the wearer: 1 left, -1 right (1).
    pub sides: &'a [f64],
    /// Words of their names.
    pub words: Vec<BTreeSet<String>>,
}

/// Words of the name of an edge that may also stand in the name of its partner.
pub(super) fn words(edge: &SeamEdge) -> BTreeSet<String> {
    let name = edge.name.to_lowercase();
    let words = name.split(|c: char| !c.is_alphabetic());
    let telling = |word: &&str| word.chars().count() >= MIN_WORD && !PLAIN_WORDS.contains(word);
    words.filter(telling).map(str::to_owned).collect()
}

impl Known<'_> {
    /// Cost of sewing the start of edge `i` to the end of edge `j`, and its end to the other's start (1).
    pub fn cost(&self, i: usize, j: usize) -> f64 {
        let (a, b) = (&self.edges[i], &self.edges[j]);
        let [near, far] = shapes_apart(a, b);
        let mut cost =
            length_cost(a, b) + ends_cost(a, b) + SHAPE * reached(near.min(far), SHAPE_SCALE);
        if far < near {
            let bulge = a.turning.abs().min(b.turning.abs());
            cost += SAME_BULGE * ((bulge - STRAIGHT) / BENT).clamp(0.0, 1.0);
        }
        let is_same_piece = a.piece == b.piece;
        if is_same_piece {
            cost += SAME_PIECE + corner_cost(a, b, [i, j]);
        }
        let is_image = self.images[i] == Some(j);
        if is_image {
            cost += IMAGE;
        } else if self.sides[i] * self.sides[j] < 0.0 {
            cost += SIDES;
        }
        if a.is_bottom && b.is_bottom {
            cost += HEMS;
        }
        cost += match self.places.apart(i, j, is_same_piece) {
            Some(apart) => {
                DIRECTION * 0.5 * (1.0 - apart.cosine) + (PLACE * apart.far).min(MAX_PLACE)
            }
            None => grain_cost(a, b),
        };
        if (a.allowance - b.allowance).abs() > SAME_ALLOWANCE {
            cost += ALLOWANCE;
        }
        cost += notch_cost(a, b);
        if !self.words[i].is_disjoint(&self.words[j]) {
            cost -= NAMES;
        }
        cost
    }
}

/// Share of a cost that is reached: 0 at no difference, two thirds at the scale, 1 far beyond it.
fn reached(difference: f64, scale: f64) -> f64 {
    1.0 - (-difference / scale).exp()
}

fn length_cost(a: &SeamEdge, b: &SeamEdge) -> f64 {
    let apart = (a.length - b.length).abs() / a.length.max(b.length).max(1e-9);
    LENGTH * reached(apart, LENGTH_SCALE) + GATHER * apart
}

/// Cost of both ends. The angles of the cloth add up to 180 degrees where a smooth line goes across the seam,
/// and to 360 degrees where the sewing goes on along the next edges of both pieces.
fn ends_cost(a: &SeamEdge, b: &SeamEdge) -> f64 {
    let sums = [a.angles[0] + b.angles[1], a.angles[1] + b.angles[0]];
    let end = |sum: f64| {
        let across = reached((sum - PI).abs(), ANGLE_SCALE);
        across.min(GOING_ON + reached((sum - 2.0 * PI).abs(), ANGLE_SCALE))
    };
    ANGLE * sums.map(end).iter().sum::<f64>()
}

/// Distances of the shapes of two edges, as parts of their length: laid against each other as parts of one
/// piece that was cut in two, and laid on each other as mirror images (1).
fn shapes_apart(a: &SeamEdge, b: &SeamEdge) -> [f64; 2] {
    let end = b.shape[CHORDS];
    let mut sums = [0.0; 2];
    for (p, q) in a.shape.iter().zip(b.shape.iter().rev()) {
        let (x, y) = (end.x - q.x, end.y - q.y);
        let along = (p.x - x).powi(2);
        sums[0] += along + (p.y - y).powi(2);
        sums[1] += along + (p.y + y).powi(2);
    }
    sums.map(|sum| (sum / (CHORDS + 1) as f64).sqrt())
}

/// Cost of two edges of one piece that share a corner.
fn corner_cost(a: &SeamEdge, b: &SeamEdge, [i, j]: [usize; 2]) -> f64 {
    let shared = match (a.next == j, b.next == i) {
        (true, true) => return 2.0 * SAME_CORNER,
        (true, false) => a.angles[1],
        (false, true) => b.angles[1],
        (false, false) => return 0.0,
    };
    match 2.0 * PI - shared > MAX_DART {
        true => SAME_CORNER,
        false => -SAME_PIECE,
    }
}

/// Cost of grains that point apart: compared once with the pieces side by side, once with one piece turned
/// over onto the other, as at a shoulder.
fn grain_cost(a: &SeamEdge, b: &SeamEdge) -> f64 {
    let beside = 1.0 + (a.direction - b.direction).cos();
    let upon = 1.0 - (a.direction + b.direction).cos();
    GRAIN * 0.5 * beside.min(upon)
}

fn notch_cost(a: &SeamEdge, b: &SeamEdge) -> f64 {
    if a.notches.is_empty() && b.notches.is_empty() {
        return 0.0;
    }
    if a.notches.len() != b.notches.len() {
        return 0.5 * NOTCHES;
    }
    let mut pairs = a.notches.iter().zip(b.notches.iter().rev());
    let meet = pairs.all(|(one, two)| (one + two - 1.0).abs() < NOTCH_REACH);
    if meet { -NOTCHES } else { 0.0 }
}
