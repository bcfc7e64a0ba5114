//! Facings of pieces that are sewn side to side round the body, such as gores, if nothing else tells them:
//! each gets the facing of its position in the ring.

use crate::flat_pieces::{FlatPiece, Tie};
use std::f64::consts::TAU;
use toile_geometry::Vec2;
use toile_pattern::Facing;

/// Smallest fraction of the stitches between two neighbours that join the right side of one to the left side
/// of the other.
const SIDE_BY_SIDE: f64 = 0.75;
/// Smallest number of pieces in a ring; fewer face each other in front and behind.
const FEWEST: usize = 3;
/// Facings in their order to the left round the wearer, from the front.
const ROUND: [Facing; 4] = [Facing::Front, Facing::Left, Facing::Back, Facing::Right];

/// The facing of each piece in a closed ring whose facings are all unknown; `None` for other pieces. The ring
/// is turned to match the pieces it is sewn to; otherwise its first piece faces forward. `told` holds the
/// facings known from names and the document.
pub(crate) fn ring_facings(
    laid: &[FlatPiece],
    ties: &[Tie],
    told: &[Option<Facing>],
) -> Vec<Option<Facing>> {
    let next: Vec<Option<usize>> = (0..laid.len())
        .map(|k| next_to_the_left(k, laid, ties))
        .collect();
    let mut facings = vec![None; laid.len()];
    for first in 0..laid.len() {
        let ring = ring_from(first, &next);
        let is_untold = ring
            .iter()
            .all(|&k| told[k].is_none() && facings[k].is_none());
        if ring.len() < FEWEST || !is_untold {
            continue;
        }
        let girth: f64 = ring.iter().map(|&k| laid[k].width()).sum();
        let mut along = -0.5 * laid[first].width();
        let mut places = Vec::new();
        for &k in &ring {
            places.push((along + 0.5 * laid[k].width()) / girth.max(1e-9));
            along += laid[k].width();
        }
        let turn = turn_of((&ring, &places), ties, told);
        for (&k, place) in ring.iter().zip(places) {
            let quarter = (4.0 * (place + turn)).round().rem_euclid(4.0) as usize;
            facings[k] = Some(ROUND[quarter % 4]);
        }
    }
    facings
}

/// The piece that follows piece `k` to the left round the wearer: its left edge is sewn to the right edge of
/// `k`, both seen from outside.
fn next_to_the_left(k: usize, laid: &[FlatPiece], ties: &[Tie]) -> Option<usize> {
    let middle = |k: usize| 0.5 * (laid[k].low.x + laid[k].high.x);
    // For each other piece, the number of stitches from side to side, and of all stitches.
    let mut counts = vec![[0_usize; 2]; laid.len()];
    for tie in ties {
        for (own, other) in [(0, 1), (1, 0)] {
            if tie.pieces[own] != k {
                continue;
            }
            let there = tie.pieces[other];
            let is_beside = tie.points[own].x > middle(k) && tie.points[other].x < middle(there);
            counts[there][0] += usize::from(is_beside);
            counts[there][1] += 1;
        }
    }
    let is_next =
        |counts: [usize; 2]| counts[0] > 0 && counts[0] as f64 >= SIDE_BY_SIDE * counts[1] as f64;
    (0..laid.len())
        .filter(|&j| is_next(counts[j]))
        .max_by_key(|&j| (counts[j][0], laid.len() - j))
}

/// The ring that contains a piece, from that piece to the left; empty for a piece that is in no ring.
fn ring_from(first: usize, next: &[Option<usize>]) -> Vec<usize> {
    let mut ring = vec![first];
    let mut at = next[first];
    while let Some(k) = at.filter(|k| !ring.contains(k)) {
        ring.push(k);
        at = next[k];
    }
    match at == Some(first) {
        true => ring,
        false => Vec::new(),
    }
}

/// Rotation of a ring to match the pieces that it is sewn to (turns).
fn turn_of((ring, places): (&[usize], &[f64]), ties: &[Tie], told: &[Option<Facing>]) -> f64 {
    let mut turned = Vec2::zeros();
    for tie in ties {
        for (own, other) in [(0, 1), (1, 0)] {
            let here = ring.iter().position(|&k| k == tie.pieces[own]);
            let there = told[tie.pieces[other]];
            let quarter = there.and_then(|facing| ROUND.iter().position(|&f| f == facing));
            if let (Some(here), Some(quarter)) = (here, quarter) {
                let angle = TAU * (0.25 * quarter as f64 - places[here]);
                turned += Vec2::new(angle.cos(), angle.sin());
            }
        }
    }
    turned.y.atan2(turned.x) / TAU
}
