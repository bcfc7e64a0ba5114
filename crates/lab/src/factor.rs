//! Times of the sparse factorisation and of solving with it, on sheets and tubes of triangles
//! coupled as far as bending couples them.

use crate::LabError;
use crate::clock::Clock;
use crate::timed::Timed;
use std::f64::consts::TAU;
use toile_geometry::Vec3;
use toile_sparse::factor::{Block, Factor, Graph};

/// Steps of a triangular lattice (i, j) to all points within 2.65 edges, one of each pair: with
/// itself a vertex then has 31 entries in its row, as in a cloth.
const STEPS: [[i64; 2]; 15] = [
    [1, 0],
    [0, 1],
    [-1, 1],
    [2, 0],
    [0, 2],
    [-2, 2],
    [1, 1],
    [-1, 2],
    [-2, 1],
    [2, 1],
    [1, 2],
    [-1, 3],
    [-2, 3],
    [-3, 2],
    [-3, 1],
];

/// Times each is done; the least of them counts, as other work on the machine only adds.
const REPEATS: usize = 5;
/// Vertices from which it is done fewer times, and how many then.
const LARGE: (usize, usize) = (50_000, 2);

/// What the lattice is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lattice {
    /// A square sheet.
    Sheet,
    /// A tube as long as it is round.
    Tube,
}

/// A lattice of about so many vertices: which of them are coupled, and where they lie.
fn lattice(kind: Lattice, vertices: usize) -> (Graph, Vec<Vec3>) {
    let columns = (vertices as f64 * 0.866).sqrt().round() as i64;
    let rows = vertices as i64 / columns;
    let mut pairs = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            for [di, dj] in STEPS {
                // Rows are sheared back by half an edge each, so that the sheet stays upright.
                let column = i + di + (j + dj).div_euclid(2) - j.div_euclid(2);
                let inside = kind == Lattice::Tube || (0..columns).contains(&column);
                if j + dj < rows && inside {
                    let other = (j + dj) * columns + column.rem_euclid(columns);
                    pairs.push([(j * columns + i) as u32, other as u32]);
                }
            }
        }
    }
    let places = (0..rows * columns).map(|v| {
        let (i, j) = (v % columns, v / columns);
        let (x, y) = (i as f64 + 0.5 * (j % 2) as f64, 0.866 * j as f64);
        match kind {
            Lattice::Tube => {
                let radius = columns as f64 / TAU;
                Vec3::new(radius * (x / radius).cos(), y, radius * (x / radius).sin())
            }
            Lattice::Sheet => Vec3::new(x, y, 0.0),
        }
    });
    let places = places.collect();
    (Graph::from_pairs((rows * columns) as usize, pairs), places)
}

/// A graph Laplacian times the identity, a little above it.
fn fill(v: usize, columns: &[u32], row: &mut [Block<3>]) {
    for (out, &u) in row.iter_mut().zip(columns) {
        let value = entry(v, u, columns.len());
        *out = std::array::from_fn(|r| std::array::from_fn(|c| if r == c { value } else { 0.0 }));
    }
}

/// An entry of a row with so many.
fn entry(v: usize, u: u32, entries: usize) -> f64 {
    if u as usize == v {
        entries as f64
    } else {
        -1.0
    }
}

/// |b - A x| / |b|.
fn error(graph: &Graph, b: &[Vec3], x: &[Vec3]) -> f64 {
    let missed = b.iter().enumerate().map(|(v, b)| {
        let row = graph.row(v);
        let entries = row.iter();
        let product = entries.map(|&u| entry(v, u, row.len()) * x[u as usize]);
        (b - product.sum::<Vec3>()).norm_squared()
    });
    let scale: f64 = b.iter().map(Vec3::norm_squared).sum();
    (missed.sum::<f64>() / scale).sqrt()
}

/// The least wall and processor time of so many repetitions (s).
fn least(count: usize, mut repeat: impl FnMut()) -> [f64; 2] {
    let mut least = [f64::INFINITY; 2];
    for _ in 0..count {
        let clock = Clock::start();
        repeat();
        least = [least[0].min(clock.wall()), least[1].min(clock.spent())];
    }
    least
}

/// Works out a factor's structure, factorises and solves.
pub(crate) fn factor(
    (kind, vertices): (Lattice, usize),
    result: &mut Timed,
) -> Result<(), LabError> {
    let clock = Clock::start();
    let (graph, places) = lattice(kind, vertices);
    result.vertices = places.len();
    let structure = Clock::start();
    let mut factor = Factor::<3>::new(graph, &places);
    let structure = structure.wall();
    let b = vec![Vec3::new(1.0, -2.0, 3.0); places.len()];
    let mut x = vec![Vec3::zeros(); places.len()];
    // Memory never written to is not read from memory: this is not timed.
    if let Err(not_positive) = factor.factorise(fill) {
        result.failure = Some(not_positive.to_string());
        return Ok(());
    }
    let repeats = if vertices < LARGE.0 { REPEATS } else { LARGE.1 };
    let factorise = least(repeats, || {
        let _ = std::hint::black_box(factor.factorise(fill));
    });
    let solve = least(repeats, || factor.solve(std::hint::black_box(&b), &mut x));
    result.wall_s = clock.wall();
    result.cpu_s = clock.cpu();
    let operations = factor.operations();
    for (name, value) in [
        ("gflop", 1e-9 * operations),
        ("millions_of_numbers", 1e-6 * factor.size()[0] as f64),
        ("structure_ms", 1e3 * structure),
        ("factorise_ms", 1e3 * factorise[0]),
        ("factorise_cpu_ms", 1e3 * factorise[1]),
        ("gflop_a_second", 1e-9 * operations / factorise[0]),
        ("gflop_a_cpu_second", 1e-9 * operations / factorise[1]),
        ("solve_ms", 1e3 * solve[0]),
        ("solve_cpu_ms", 1e3 * solve[1]),
        ("error", error(factor.graph(), &b, &x)),
    ] {
        result.counted.insert(name.to_owned(), value);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vertex_within_the_lattice_has_31_entries_and_what_is_solved_is_solved() {
        for kind in [Lattice::Sheet, Lattice::Tube] {
            let (graph, places) = lattice(kind, 600);
            assert_eq!(graph.longest_row(), 31);
            let mut factor = Factor::<3>::new(graph, &places);
            factor.factorise(fill).unwrap();
            let b: Vec<Vec3> = places.iter().map(|p| Vec3::new(p.y, 1.0, -p.x)).collect();
            let mut x = vec![Vec3::zeros(); b.len()];
            assert_eq!(error(factor.graph(), &b, &x), 1.0);
            factor.solve(&b, &mut x);
            assert!(error(factor.graph(), &b, &x) < 1e-12, "{kind:?}");
        }
    }
}
