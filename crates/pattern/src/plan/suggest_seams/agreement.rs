//! Agreement of candidates with each other: each edge has at most one partner, and seams that meet at a
//! corner go on into each other there.

use super::edges::SeamEdge;
use std::f64::consts::PI;

/// Cost of an edge that stays unsewn (1).
const UNSEWN: f64 = 2.0;
/// Difference of costs at which one candidate is 2.7 times as likely as another (1).
const TEMPERATURE: f64 = 0.3;
/// Gain of an end of a seam that agrees with the seams round its corner (1).
const AGREEMENT: f64 = 0.8;
/// Part of that gain where both edges beyond the corner stay unsewn (1).
const BORDER: f64 = 0.7;
/// Angle by which the cloth round a corner may be off for a third of the gain (rad).
const ANGLE_SCALE: f64 = 40.0 * PI / 180.0;
/// Rounds in which likelihoods and agreements are found in turn.
const ROUNDS: usize = 8;
/// Steps by which likelihoods are brought to add up to 1.
const STEPS: usize = 30;

/// Largest gain by agreement (1).
pub(super) const MAX_AGREEMENT: f64 = 2.0 * AGREEMENT;

/// For each edge its candidates, in the order of their index, with the cost of each (1). A candidate of an
/// edge has the edge among its own candidates, at the same cost.
pub(super) type Candidates = Vec<Vec<(usize, f64)>>;

/// Likelihoods of all candidates, and of staying unsewn.
struct Likelihoods {
    /// For each edge, of each of its candidates in order (1).
    sewn: Vec<Vec<f64>>,
    /// For each edge (1).
    unsewn: Vec<f64>,
}

/// Lowers the costs of candidates by their agreement with the candidates of neighbouring edges.
///
/// Likelihoods p = s(i) s(j) exp(-cost / T) are scaled so that those of each edge and of staying unsewn add
/// up to 1. Where a seam ends at a corner, the edges beyond the corner agree with it if they are sewn to each
/// other and the cloth makes a full turn there, if they are sewn to edges that meet on another piece, or if
/// both stay unsewn.
///
/// Returns the lowered costs, and the likelihood of each candidate (1).
pub(super) fn agreed(edges: &[SeamEdge], candidates: &Candidates) -> (Candidates, Vec<Vec<f64>>) {
    let mut costs = candidates.clone();
    for _ in 0..ROUNDS {
        let likelihoods = likelihoods(&costs);
        let net = Net {
            edges,
            candidates,
            likelihoods: &likelihoods,
        };
        for (i, own) in costs.iter_mut().enumerate() {
            for (k, (j, cost)) in own.iter_mut().enumerate() {
                let gain = net.at_corner(i, *j) + net.at_corner(*j, i);
                *cost = candidates[i][k].1 - AGREEMENT * gain;
            }
        }
    }
    let sewn = likelihoods(&costs).sewn;
    (costs, sewn)
}

fn likelihoods(costs: &Candidates) -> Likelihoods {
    let weights: Vec<Vec<f64>> = costs
        .iter()
        .map(|own| {
            own.iter()
                .map(|(_, cost)| (-cost / TEMPERATURE).exp())
                .collect()
        })
        .collect();
    let left = (-UNSEWN / TEMPERATURE).exp();
    let mut scales = vec![0.5; costs.len()];
    for _ in 0..STEPS {
        let next = scales.iter().enumerate().map(|(i, scale): (usize, &f64)| {
            let pairs = costs[i].iter().zip(&weights[i]);
            let sum: f64 = pairs.map(|((j, _), weight)| weight * scales[*j]).sum();
            (scale / (sum + left)).sqrt()
        });
        scales = next.collect();
    }
    let sewn: Vec<Vec<f64>> = costs
        .iter()
        .enumerate()
        .map(|(i, own)| {
            let pairs = own.iter().zip(&weights[i]);
            pairs
                .map(|((j, _), weight)| weight * scales[i] * scales[*j])
                .collect()
        })
        .collect();
    let unsewn = sewn
        .iter()
        .map(|own| (1.0 - own.iter().sum::<f64>()).clamp(0.0, 1.0));
    Likelihoods {
        unsewn: unsewn.collect(),
        sewn,
    }
}

/// Candidates with their likelihoods.
struct Net<'a> {
    edges: &'a [SeamEdge],
    candidates: &'a Candidates,
    likelihoods: &'a Likelihoods,
}

impl Net<'_> {
    /// Likelihood that two edges are sewn to each other (1).
    fn together(&self, i: usize, j: usize) -> f64 {
        let found = self.candidates[i].binary_search_by_key(&j, |known| known.0);
        found.map_or(0.0, |k| self.likelihoods.sewn[i][k])
    }

    /// Agreement, from 0 to 1, at the corner where edge `i` ends and its partner `j` starts (1).
    fn at_corner(&self, i: usize, j: usize) -> f64 {
        let (a, b) = (&self.edges[i], &self.edges[j]);
        let (x, y) = (a.next, b.previous);
        let sum = a.angles[1] + b.angles[0];
        let full = (-(sum - 2.0 * PI).abs() / ANGLE_SCALE).exp();
        let goes_on = full * self.together(x, y);
        let border = BORDER * self.likelihoods.unsewn[x] * self.likelihoods.unsewn[y];
        goes_on.max(border).max(self.through_others(x, y))
    }

    /// Likelihood that the edge `x`, which starts at a corner, and the edge `y`, which ends there, are sewn to
    /// edges that meet at that corner: on one piece, or across a seam (1).
    fn through_others(&self, x: usize, y: usize) -> f64 {
        let mut sum = 0.0;
        for (k, (c, _)) in self.candidates[x].iter().enumerate() {
            let p = self.likelihoods.sewn[x][k];
            if *c == y || p < 1e-3 {
                continue;
            }
            let beyond = self.edges[*c].next;
            for (l, (d, _)) in self.candidates[y].iter().enumerate() {
                let q = self.likelihoods.sewn[y][l];
                if *d == x || q < 1e-3 {
                    continue;
                }
                let meet = match beyond == *d {
                    true => 1.0,
                    false => self.together(beyond, self.edges[*d].previous),
                };
                sum += p * q * meet;
            }
        }
        sum.min(1.0)
    }
}
