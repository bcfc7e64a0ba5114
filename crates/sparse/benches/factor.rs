//! Times of the sparse factorisation and of solving with it, on sheets and tubes of triangles
//! coupled as far as bending couples them. Run on an idle machine:
//! `cargo bench -p toile-sparse --bench factor`.

use criterion::{BenchmarkId, Criterion, Throughput};
use std::f64::consts::TAU;
use std::hint::black_box;
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

/// A lattice of about so many vertices: a square sheet, or a tube as long as it is round.
fn lattice(vertices: usize, tube: bool) -> (Graph, Vec<Vec3>) {
    let columns = (vertices as f64 * 0.866).sqrt().round() as i64;
    let rows = vertices as i64 / columns;
    let mut pairs = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            for [di, dj] in STEPS {
                // Rows are sheared back by half an edge each, so that the sheet stays upright.
                let column = i + di + (j + dj).div_euclid(2) - j.div_euclid(2);
                let inside = tube || (0..columns).contains(&column);
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
        if tube {
            let radius = columns as f64 / TAU;
            Vec3::new(radius * (x / radius).cos(), y, radius * (x / radius).sin())
        } else {
            Vec3::new(x, y, 0.0)
        }
    });
    let places = places.collect();
    (Graph::from_pairs((rows * columns) as usize, pairs), places)
}

/// A graph Laplacian times a full block, a little above it.
fn fill(v: usize, columns: &[u32], row: &mut [Block<3>]) {
    for (out, &u) in row.iter_mut().zip(columns) {
        let value = if u as usize == v {
            columns.len() as f64
        } else {
            -1.0
        };
        *out = std::array::from_fn(|r| std::array::from_fn(|c| if r == c { value } else { 0.0 }));
    }
}

fn factor(criterion: &mut Criterion) {
    for tube in [false, true] {
        let mut group = criterion.benchmark_group(if tube { "tube" } else { "sheet" });
        group.sample_size(10);
        for vertices in [1_000, 4_000, 10_000, 30_000, 100_000] {
            let (graph, places) = lattice(vertices, tube);
            let mut factor = Factor::<3>::new(graph, &places);
            let operations = factor.operations();
            let b = vec![Vec3::new(1.0, -2.0, 3.0); places.len()];
            let mut x = vec![Vec3::zeros(); places.len()];
            // Elements per second read as operations per second.
            group.throughput(Throughput::Elements(operations as u64));
            group.bench_function(BenchmarkId::new("factorise", vertices), |bencher| {
                bencher.iter(|| factor.factorise(black_box(fill)).is_ok());
            });
            // Memory never written to is not read from memory.
            factor.factorise(fill).expect("the matrix is positive");
            group.bench_function(BenchmarkId::new("solve", vertices), |bencher| {
                bencher.iter(|| factor.solve(black_box(&b), &mut x));
            });
        }
        group.finish();
    }
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    factor(&mut criterion);
    criterion.final_summary();
}
