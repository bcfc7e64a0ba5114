//! Against dense factorisation, at any number of threads, and where it must fail.

use super::*;
use proptest::prelude::*;

/// A sheet of triangles, `columns` by `rows` vertices, coupled two rings far.
fn sheet(columns: usize, rows: usize) -> (Graph, Vec<Vec3>) {
    let at = |i: usize, j: usize| (j * columns + i) as u32;
    let mut pairs = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            for dj in 0..3usize {
                for di in -2i64..3 {
                    let (i2, j2) = (i as i64 + di, j + dj);
                    if (0..columns as i64).contains(&i2)
                        && j2 < rows
                        && di.unsigned_abs() as usize + dj < 4
                    {
                        pairs.push([at(i, j), at(i2 as usize, j2)]);
                    }
                }
            }
        }
    }
    let places = (0..rows * columns)
        .map(|v| Vec3::new((v % columns) as f64, (v / columns) as f64, 0.0))
        .collect();
    (Graph::from_pairs(columns * rows, pairs), places)
}

/// A number between -1 and 1 that depends on two others in no obvious way.
fn noise(a: usize, b: usize) -> f64 {
    let mut h = (a as u64) << 32 | b as u64;
    for _ in 0..3 {
        h = (h ^ (h >> 31)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
    (h >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// A symmetric matrix with dominant diagonal blocks.
fn entry<const D: usize>(graph: &Graph, v: usize, u: usize) -> Block<D> {
    std::array::from_fn(|r| {
        std::array::from_fn(|c| {
            let (a, b) = ((v * D + r).min(u * D + c), (v * D + r).max(u * D + c));
            let dominant = if a == b {
                (graph.row(v).len() * D + 1) as f64
            } else {
                0.0
            };
            dominant + noise(a, b)
        })
    })
}

fn fill<const D: usize>(graph: &Graph) -> impl Fn(usize, &[u32], &mut [Block<D>]) + Sync + '_ {
    move |v, columns, row| {
        for (out, &u) in row.iter_mut().zip(columns) {
            *out = entry(graph, v, u as usize);
        }
    }
}

/// Largest component of A x - b over the largest of b.
fn residual<const D: usize>(graph: &Graph, columns: usize, x: &[f64], b: &[f64]) -> f64 {
    let mut worst = 0.0f64;
    for v in 0..graph.vertex_count() {
        for k in 0..columns {
            for r in 0..D {
                let mut sum = -b[(v * columns + k) * D + r];
                for &u in graph.row(v) {
                    let block = entry::<D>(graph, v, u as usize);
                    for c in 0..D {
                        sum += block[r][c] * x[(u as usize * columns + k) * D + c];
                    }
                }
                worst = worst.max(sum.abs());
            }
        }
    }
    worst / b.iter().fold(0.0f64, |most, b| most.max(b.abs()))
}

fn solved<const D: usize>(graph: &Graph, places: &[Vec3], columns: usize) -> (Vec<f64>, f64) {
    let mut factor = Factor::<D>::new(graph.clone(), places);
    factor.factorise(fill(graph)).unwrap();
    let b: Vec<f64> = (0..graph.vertex_count() * D * columns)
        .map(|i| noise(i, 7))
        .collect();
    let mut x = vec![0.0; b.len()];
    factor.solve_columns(columns, &b, &mut x);
    let residual = residual::<D>(graph, columns, &x, &b);
    (x, residual)
}

#[test]
fn sheets_of_any_size_are_solved() {
    for (columns, rows) in [(1, 1), (3, 1), (5, 4), (12, 30), (40, 40)] {
        let (graph, places) = sheet(columns, rows);
        assert!(
            solved::<3>(&graph, &places, 1).1 < 1e-12,
            "{columns} x {rows}"
        );
        assert!(
            solved::<1>(&graph, &places, 3).1 < 1e-12,
            "{columns} x {rows}"
        );
        assert!(
            solved::<3>(&graph, &places, 2).1 < 1e-12,
            "{columns} x {rows}"
        );
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let (graph, places) = sheet(90, 70);
    let bits = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let (x, residual) = pool.install(|| solved::<3>(&graph, &places, 1));
        assert!(residual < 1e-12);
        x.into_iter().map(f64::to_bits).collect::<Vec<_>>()
    };
    let one = bits(1);
    for threads in [2, 3, 2] {
        assert_eq!(bits(threads), one, "{threads} threads");
    }
}

#[test]
fn a_second_factorisation_forgets_the_first() {
    let (graph, places) = sheet(20, 20);
    let b = vec![Vec3::new(1.0, -2.0, 3.0); 400];
    let solve = |factor: &mut Factor<3>| {
        let mut x = vec![Vec3::zeros(); 400];
        factor.factorise(fill(&graph)).unwrap();
        factor.solve(&b, &mut x);
        x
    };
    let fresh = solve(&mut Factor::new(graph.clone(), &places));
    let mut used = Factor::<3>::new(graph.clone(), &places);
    assert!(
        used.factorise(|_, _, row| row.fill([[-1.0; 3]; 3]))
            .is_err()
    );
    used.factorise(|v, columns, row| {
        fill(&graph)(v, columns, row);
        row.iter_mut().flatten().flatten().for_each(|e| *e *= 3.0);
    })
    .unwrap();
    assert_eq!(solve(&mut used), fresh);
}

#[test]
fn single_precision_comes_near() {
    let (graph, places) = sheet(25, 25);
    let mut factor = Factor::<3, f32>::new(graph.clone(), &places);
    factor.factorise(fill(&graph)).unwrap();
    let b: Vec<f64> = (0..625 * 3).map(|i| noise(i, 7)).collect();
    let mut x = vec![0.0; b.len()];
    factor.solve_columns(1, &b, &mut x);
    assert!(residual::<3>(&graph, 1, &x, &b) < 1e-5);
}

#[test]
fn the_vertex_that_fails_is_named() {
    let (graph, places) = sheet(30, 30);
    for (bad, value) in [(451, -1.0), (17, f64::NAN), (880, f64::INFINITY), (3, 0.0)] {
        // Uncoupled from the others, so that no other vertex can fail for it.
        let spoilt = |v: usize, columns: &[u32], row: &mut [Block<3>]| {
            for (out, &u) in row.iter_mut().zip(columns) {
                *out = entry(&graph, v, u as usize);
                if v == bad || u as usize == bad {
                    let diagonal = if v == u as usize { value } else { 0.0 };
                    *out = std::array::from_fn(|r| {
                        std::array::from_fn(|c| if r == c { diagonal } else { 0.0 })
                    });
                }
            }
        };
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            let mut factor = Factor::<3>::new(graph.clone(), &places);
            let failed = pool.install(|| factor.factorise(spoilt));
            assert_eq!(failed, Err(NotPositive { vertex: bad }));
        }
    }
}

#[test]
fn places_need_not_make_sense() {
    let (graph, places) = sheet(30, 20);
    for junk in [
        Vec3::zeros(),
        Vec3::repeat(f64::NAN),
        Vec3::repeat(f64::INFINITY),
    ] {
        assert!(solved::<3>(&graph, &vec![junk; 600], 1).1 < 1e-12);
    }
    let flat: Vec<Vec3> = places.iter().map(|p| Vec3::new(p.x, 0.0, 0.0)).collect();
    assert!(solved::<1>(&graph, &flat, 3).1 < 1e-12);
}

#[test]
fn nothing_is_solved_without_vertices() {
    let mut factor = Factor::<3>::new(Graph::from_pairs(0, []), &[]);
    factor.factorise(|_, _, _| {}).unwrap();
    factor.solve(&[], &mut []);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Any graph at all: sparse, dense, disconnected, with hubs.
    #[test]
    fn random_graphs_are_solved(
        n in 1usize..150,
        pairs in prop::collection::vec((0u32..150, 0u32..150), 0..600),
        hub in prop::bool::ANY,
    ) {
        let mut pairs: Vec<[u32; 2]> = pairs
            .into_iter()
            .map(|(a, b)| [a % n as u32, b % n as u32])
            .collect();
        if hub {
            pairs.extend((0..n as u32).map(|v| [0, v]));
        }
        let graph = Graph::from_pairs(n, pairs);
        let places: Vec<Vec3> = (0..n)
            .map(|v| Vec3::new(noise(v, 1), noise(v, 2), noise(v, 3)))
            .collect();
        prop_assert!(solved::<3>(&graph, &places, 1).1 < 1e-11);
        prop_assert!(solved::<1>(&graph, &places, 3).1 < 1e-11);
    }
}
