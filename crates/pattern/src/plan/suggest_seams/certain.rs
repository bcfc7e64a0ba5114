//! Which pairs of edges are certain enough to be sewn unseen.

use super::cost::{Known, MAX_DART, STRAIGHT};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// Likelihood above which a pair counts as certain: three times that of all else together (1).
const CERTAIN: f64 = 0.75;
/// Distance of a placed edge from the middle of the wearer up to which it lies on the centre line (m).
const MIDDLE: f64 = 0.03;
/// Least place across the grain, of 1, of an edge at the border of its piece (1).
const BORDER: f64 = 0.85;
/// Greatest cosine of the angle between a centre line and the direction across the grain (1).
const ALONG: f64 = 0.25;
/// Angle by which the border of a garment may turn where it goes across a centre line (rad).
const BORDER_TURN: f64 = 40.0 * PI / 180.0;
/// Least angle of the cloth round a corner at which two seams of the same two pieces meet (rad): with less the
/// pieces are closed to a bag.
const BAG: f64 = 225.0 * PI / 180.0;
/// Words in names of edges on the centre line.
const MIDDLE_WORDS: [&str; 7] = [
    "centre", "center", "middle", "crotch", "rise", "mitte", "milieu",
];

/// A pair of edges that are each other's first choice.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstChoice {
    /// The edges, the smaller index first.
    pub edges: [usize; 2],
    /// Cost of the pair (1).
    pub cost: f64,
    /// Its likelihood (1).
    pub likelihood: f64,
    /// Whether a seam sews them already.
    pub is_sewn: bool,
}

/// The pairs, among those that are each other's first choice, that may be sewn unseen.
///
/// Hems are not sewn to each other, nor left to right. Mirror images, and edges of one piece, are sewn on the
/// centre line alone, where the border of the garment runs on smoothly across the seam. Of two seams that would
/// close two pieces to a bag at a corner, the costlier is not made.
pub(super) fn certain(known: &Known<'_>, choices: &[FirstChoice]) -> BTreeSet<[usize; 2]> {
    let certain = choices.iter().filter(|choice| {
        choice.is_sewn || choice.likelihood > CERTAIN && may_be_sewn(known, choice.edges)
    });
    let mut seams = Seams {
        known,
        costs: certain.map(|choice| (choice.edges, choice.cost)).collect(),
    };
    while let Some(pair) = seams.loose().or_else(|| seams.closes_a_bag()) {
        seams.costs.remove(&pair);
    }
    seams.costs.into_keys().collect()
}

/// Whether two edges are of kinds that are sewn to each other.
fn may_be_sewn(known: &Known<'_>, [i, j]: [usize; 2]) -> bool {
    let (a, b) = (&known.edges[i], &known.edges[j]);
    if a.is_bottom && b.is_bottom {
        return false;
    }
    let is_same_piece = a.piece == b.piece;
    if known.images[i] == Some(j) {
        return is_middle(known, [i, j]);
    }
    let panels = [a, b].map(|edge| edge.sewn.map(|sewn| sewn.panel));
    match is_same_piece {
        true => is_dart(known, [i, j]) || is_tube(known, [i, j]),
        false => known.sides[i] * known.sides[j] >= 0.0 && panels[0] != panels[1],
    }
}

/// Whether mirror images lie on a centre line: by their names; else they are straight, and in the middle of the
/// wearer, or, where they are not placed there, along the grain at the border of their pieces.
fn is_middle(known: &Known<'_>, [i, j]: [usize; 2]) -> bool {
    if is_named_middle(known, i) {
        return true;
    }
    let is_same_piece = known.edges[i].piece == known.edges[j].piece;
    match [i, j].map(|edge| known.places.to_the_left(edge)) {
        [Some(one), Some(two)] if !is_same_piece => {
            [i, j].iter().all(|edge| is_straight(known, *edge)) && one.abs().max(two.abs()) < MIDDLE
        }
        _ => is_tube(known, [i, j]),
    }
}

fn is_named_middle(known: &Known<'_>, edge: usize) -> bool {
    let mut words = MIDDLE_WORDS.iter();
    words.any(|word| known.words[edge].contains(*word))
}

fn is_straight(known: &Known<'_>, edge: usize) -> bool {
    known.edges[edge].turning.abs() < STRAIGHT
}

/// Whether both edges are straight borders along the grain, one at the left and one at the right.
fn is_tube(known: &Known<'_>, pair: [usize; 2]) -> bool {
    let [a, b] = pair.map(|edge| &known.edges[edge]);
    let is_border = |edge: usize| {
        let own = &known.edges[edge];
        let is_along = own.direction.cos().abs() < ALONG && own.across.abs() > BORDER;
        is_along && is_straight(known, edge)
    };
    pair.into_iter().all(is_border) && a.across * b.across < 0.0
}

/// Whether two edges may be the legs of a dart that is drawn as a notch of the outline.
fn is_dart(known: &Known<'_>, [i, j]: [usize; 2]) -> bool {
    let (a, b) = (&known.edges[i], &known.edges[j]);
    let shared = [(a.next == j, a.angles[1]), (b.next == i, b.angles[1])];
    let mut shared = shared.iter().filter(|(is_shared, _)| *is_shared);
    shared.any(|(_, angle)| 2.0 * PI - angle < MAX_DART)
}

/// Seams that are made together.
struct Seams<'a> {
    known: &'a Known<'a>,
    /// Cost of each pair (1).
    costs: BTreeMap<[usize; 2], f64>,
}

impl Seams<'_> {
    /// The pair beyond each end of a pair, and the angle of the cloth there (rad).
    fn ends(&self, [i, j]: [usize; 2]) -> [([usize; 2], f64); 2] {
        let (a, b) = (&self.known.edges[i], &self.known.edges[j]);
        let sorted = |x: usize, y: usize| [x.min(y), x.max(y)];
        [
            (sorted(a.next, b.previous), a.angles[1] + b.angles[0]),
            (sorted(a.previous, b.next), a.angles[0] + b.angles[1]),
        ]
    }

    /// A pair of mirror images, or of one piece, across which the border of the garment does not run on.
    fn loose(&self) -> Option<[usize; 2]> {
        let is_loose = |pair: &&[usize; 2]| {
            let [i, j] = **pair;
            let is_middle = self.known.images[i] == Some(j)
                || self.known.edges[i].piece == self.known.edges[j].piece;
            let is_told = is_named_middle(self.known, i) || is_dart(self.known, **pair);
            let runs_on = |(beyond, angle): ([usize; 2], f64)| {
                beyond == **pair
                    || self.costs.contains_key(&beyond)
                    || (angle - PI).abs() < BORDER_TURN
            };
            is_middle && !is_told && !self.ends(**pair).into_iter().all(runs_on)
        };
        self.costs.keys().find(is_loose).copied()
    }

    /// The costliest pair at a corner where two pieces would be closed to a bag.
    fn closes_a_bag(&self) -> Option<[usize; 2]> {
        let is_bag = |(pair, _): &(&[usize; 2], &f64)| {
            let mut ends = self.ends(**pair).into_iter();
            ends.any(|(beyond, angle)| {
                beyond != **pair && angle < BAG && self.costs.contains_key(&beyond)
            })
        };
        let bags = self.costs.iter().filter(is_bag);
        let costliest = bags.max_by(|a, b| a.1.total_cmp(b.1));
        costliest.map(|(pair, _)| *pair)
    }
}
