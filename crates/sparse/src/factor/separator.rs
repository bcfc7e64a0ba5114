//! One cut of nested dissection: the best of several sweeps of a plane (or a front of breadth-first
//! search) over the vertices, then straightened by moving single vertices (Fiduccia and
//! Mattheyses 1982, for vertex separators: Ashcraft and Liu 1996).

use super::subgraph::Subgraph;
use nalgebra::{Matrix3, SymmetricEigen};
use toile_geometry::Vec3;

/// Label of vertices in the separator; the sides are 0 and 1.
pub const SEPARATOR: u32 = 2;

/// Share of the vertices that the smaller side must have at least.
const BALANCE: f64 = 0.2;

/// Share of the vertices above which a separator saves nothing.
const MAX_SEPARATOR: f64 = 0.5;

/// Sweeps of which the separator is straightened.
const STRAIGHTENED: usize = 2;

/// Pieces of no more vertices are swept in two directions alone, and the better separator is
/// straightened: most of the time would go into such pieces, and more sweeps save them nothing.
const SMALL: usize = 1000;

/// Passes of straightening at the most; two or three find nothing any more.
const PASSES: usize = 6;

/// Estimate of the work that a cut leaves.
#[derive(Clone, Copy)]
struct Estimate {
    /// Work of a part of n vertices, as a multiple of n^1.5.
    below: f64,
}

impl Estimate {
    /// A sheet whose vertices are coupled r rings far has rows of 3 r (r + 1) others, a square one
    /// of n vertices has separators of r sqrt(n), and factorising it costs K n^1.5 with
    /// K n^1.5 = (r sqrt(n))^3 + 2 K (n/2)^1.5.
    fn new(graph: &Subgraph) -> Self {
        let others = graph.entries() as f64 / graph.len() as f64;
        let reach = ((1.0 + 4.0 / 3.0 * others).sqrt() - 1.0) / 2.0;
        Self {
            below: reach.powi(3) / (1.0 - std::f64::consts::FRAC_1_SQRT_2),
        }
    }

    /// With a separator of `s` vertices between sides of `a` and `b`.
    fn work(self, s: usize, a: usize, b: usize) -> f64 {
        let [s, a, b] = [s, a, b].map(|n| n as f64);
        s * s * s + self.below * (a * a.sqrt() + b * b.sqrt())
    }
}

/// A label for every vertex and the separator, in order along its longest direction; nothing when
/// no separator is worth it.
pub fn separate(graph: &Subgraph) -> Option<(Vec<u32>, Vec<u32>)> {
    let estimate = Estimate::new(graph);
    let mut swept: Vec<(f64, Vec<u32>)> = candidate_keys(graph)
        .iter()
        .filter_map(|keys| sweep(graph, estimate, keys))
        .collect();
    swept.sort_by(|a, b| a.0.total_cmp(&b.0));
    swept.truncate(if is_small(graph) { 1 } else { STRAIGHTENED });
    for (work, side) in &mut swept {
        *work = straighten(graph, estimate, side);
    }
    let best = swept.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    let (_, side) = best?;
    let mut separator: Vec<u32> = (0..graph.len() as u32)
        .filter(|&v| side[v as usize] == SEPARATOR)
        .collect();
    let large = separator.len() as f64 > MAX_SEPARATOR * graph.len() as f64;
    if large || [0, 1].iter().any(|label| !side.contains(label)) {
        return None;
    }
    let (low, high) = bounds(separator.iter().map(|&v| graph.places[v as usize]));
    let axis = (high - low).imax();
    separator.sort_by(|&a, &b| {
        let [p, q] = [a, b].map(|v| graph.places[v as usize][axis]);
        p.total_cmp(&q).then(a.cmp(&b))
    });
    Some((side, separator))
}

fn bounds(places: impl Iterator<Item = Vec3>) -> (Vec3, Vec3) {
    let none = Vec3::repeat(f64::INFINITY);
    places.fold((none, -none), |(low, high), p| (low.inf(&p), high.sup(&p)))
}

fn is_small(graph: &Subgraph) -> bool {
    graph.len() <= SMALL
}

/// Orders to sweep the vertices in: along the principal directions, the longest first; in large
/// pieces along the axes and by distance within the graph from a vertex at the rim too.
fn candidate_keys(graph: &Subgraph) -> Vec<Vec<f64>> {
    let along = |d: Vec3| graph.places.iter().map(|p| p.dot(&d)).collect();
    let mut all: Vec<Vec<f64>> = Vec::new();
    let centre = graph.places.iter().sum::<Vec3>() / graph.len() as f64;
    let spread = graph.places.iter().fold(Matrix3::zeros(), |sum, p| {
        sum + (p - centre) * (p - centre).transpose()
    });
    if spread.iter().all(|s| s.is_finite())
        && let Some(eigen) = SymmetricEigen::try_new(spread, 1e-12, 100)
    {
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let direction = |&k: &usize| along(eigen.eigenvectors.column(k).into());
        if is_small(graph) {
            return order[..2].iter().map(direction).collect();
        }
        all.extend(order.iter().map(direction));
    }
    all.extend([Vec3::x(), Vec3::y(), Vec3::z()].map(along));
    let rim = farthest(&hops(graph, 0));
    all.push(hops(graph, rim));
    all
}

/// Steps along the graph from a vertex.
fn hops(graph: &Subgraph, from: usize) -> Vec<f64> {
    let mut steps = vec![f64::INFINITY; graph.len()];
    steps[from] = 0.0;
    let mut queue = vec![from as u32];
    let mut next = 0;
    while next < queue.len() {
        let v = queue[next] as usize;
        next += 1;
        for &u in graph.neighbours(v) {
            if steps[u as usize].is_infinite() {
                steps[u as usize] = steps[v] + 1.0;
                queue.push(u);
            }
        }
    }
    steps
}

fn farthest(steps: &[f64]) -> usize {
    (0..steps.len())
        .max_by(|&a, &b| steps[a].total_cmp(&steps[b]))
        .unwrap_or(0)
}

/// Moves the vertices from right to left in the order of their keys, and keeps the moment at
/// which the rim of one side makes the cheapest separator.
fn sweep(graph: &Subgraph, estimate: Estimate, keys: &[f64]) -> Option<(f64, Vec<u32>)> {
    let n = graph.len();
    let mut order: Vec<u32> = (0..n as u32).collect();
    order.sort_unstable_by(|&a, &b| {
        keys[a as usize]
            .total_cmp(&keys[b as usize])
            .then(a.cmp(&b))
    });
    let mut in_left = vec![0u32; n];
    let mut left = vec![false; n];
    let (mut left_rim, mut right_rim) = (0usize, 0usize);
    let mut best: Option<(f64, usize, bool)> = None;
    let least = ((n as f64 * BALANCE) as usize).max(1);
    for (at, &v) in order.iter().enumerate() {
        let v = v as usize;
        right_rim -= usize::from(in_left[v] > 0);
        left_rim += usize::from(in_left[v] < graph.neighbours(v).len() as u32);
        left[v] = true;
        for &u in graph.neighbours(v) {
            let u = u as usize;
            in_left[u] += 1;
            if left[u] {
                left_rim -= usize::from(in_left[u] == graph.neighbours(u).len() as u32);
            } else {
                right_rim += usize::from(in_left[u] == 1);
            }
        }
        let (a, b) = (at + 1, n - at - 1);
        for (from_left, s, a, b) in [
            (true, left_rim, a.saturating_sub(left_rim), b),
            (false, right_rim, a, b.saturating_sub(right_rim)),
        ] {
            if a < least || b < least {
                continue;
            }
            let found = estimate.work(s, a, b);
            if best.is_none_or(|(work, _, _)| found < work) {
                best = Some((found, at + 1, from_left));
            }
        }
    }
    let (work, cut, from_left) = best?;
    let mut side = vec![1; n];
    for &v in &order[..cut] {
        side[v as usize] = 0;
    }
    let (own, other) = if from_left { (0, 1) } else { (1, 0) };
    let rim: Vec<usize> = (0..n)
        .filter(|&v| {
            side[v] == own
                && graph
                    .neighbours(v)
                    .iter()
                    .any(|&u| side[u as usize] == other)
        })
        .collect();
    for v in rim {
        side[v] = SEPARATOR;
    }
    Some((work, side))
}

/// Moves vertices out of the separator, drawing in those that would then touch the other side, as
/// long as that pays; passes go uphill too and keep the best moment. Returns the work estimated.
fn straighten(graph: &Subgraph, estimate: Estimate, side: &mut [u32]) -> f64 {
    let mut count = [0usize; 3];
    for &s in side.iter() {
        count[s as usize] += 1;
    }
    let mut best = estimate.work(count[2], count[0], count[1]);
    for _ in 0..PASSES {
        let found = pass(graph, estimate, side, &mut count);
        if found >= best {
            break;
        }
        best = found;
    }
    best
}

/// One pass; leaves the best moment in `side` and `count` and returns its work.
fn pass(graph: &Subgraph, estimate: Estimate, side: &mut [u32], count: &mut [usize; 3]) -> f64 {
    let mut rim: Vec<u32> = (0..side.len() as u32)
        .filter(|&v| side[v as usize] == SEPARATOR)
        .collect();
    let mut drawn: Vec<[i32; 2]> = vec![[0; 2]; side.len()];
    let touching = |side: &[u32], v: u32| {
        let mut touch = [0; 3];
        for &u in graph.neighbours(v as usize) {
            touch[side[u as usize] as usize] += 1;
        }
        // Moving to one side draws in the neighbours on the other.
        [touch[1], touch[0]]
    };
    for &v in &rim {
        drawn[v as usize] = touching(side, v);
    }
    let mut locked = vec![false; side.len()];
    let mut moves: Vec<(u32, u32)> = Vec::new();
    let least = ((side.len() as f64 * BALANCE) as usize).max(1);
    let (mut best, mut best_moves) = (estimate.work(count[2], count[0], count[1]), 0);
    let mut best_count = *count;
    let patience = 20 + rim.len() / 2;
    let mut since = 0;
    while since < patience {
        let small = u32::from(count[1] < count[0]);
        let mut choice: Option<(i32, bool, usize)> = None;
        for (at, &v) in rim.iter().enumerate() {
            for to in [small, 1 - small] {
                let other = count[1 - to as usize];
                let cost = drawn[v as usize][to as usize];
                let better = choice.is_none_or(|(least, _, _)| cost < least);
                if better && other >= least + cost as usize {
                    choice = Some((cost, to == 1, at));
                }
            }
        }
        let Some((_, to_right, at)) = choice else {
            break;
        };
        let to = u32::from(to_right);
        let v = rim.swap_remove(at);
        let mut changed = vec![v];
        locked[v as usize] = true;
        moves.push((v, SEPARATOR));
        side[v as usize] = to;
        count[2] -= 1;
        count[to as usize] += 1;
        for &u in graph.neighbours(v as usize) {
            if side[u as usize] == 1 - to {
                moves.push((u, 1 - to));
                side[u as usize] = SEPARATOR;
                count[1 - to as usize] -= 1;
                count[2] += 1;
                changed.push(u);
                if !locked[u as usize] {
                    rim.push(u);
                }
            }
        }
        for &w in &changed {
            if side[w as usize] == SEPARATOR {
                drawn[w as usize] = touching(side, w);
            }
            for &u in graph.neighbours(w as usize) {
                if side[u as usize] == SEPARATOR {
                    drawn[u as usize] = touching(side, u);
                }
            }
        }
        let found = estimate.work(count[2], count[0], count[1]);
        since += 1;
        if found < best {
            (best, best_moves, best_count, since) = (found, moves.len(), *count, 0);
        }
    }
    for &(v, was) in moves[best_moves..].iter().rev() {
        side[v as usize] = was;
    }
    *count = best_count;
    best
}
