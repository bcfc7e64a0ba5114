//! Harmonic interpolation over a plane mesh: free vertices follow the displacements of the given vertices
//! around them.

use crate::planar::Planar;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};
use toile_geometry::Vec2;
use toile_sparse::ScalarMatrix;
use toile_sparse::factor::{Factor, Graph, NotPositive};

/// Smallest weight of an edge (1). Edges with a weight of zero except for rounding are kept, so that every
/// free vertex is connected to given ones.
const MIN_WEIGHT: f64 = 1e-12;

/// Harmonic weights of the free vertices of one mesh, factorised once: each new shape of the outline then
/// costs one solution.
///
/// Each free vertex moves by the weighted mean of its neighbours' displacements. The weight is half the sum
/// of the cotangents opposite the edge between them (Pinkall and Polthier 1993).
///
/// The weights are those of the Delaunay triangulation of the same points and boundary (Bobenko and
/// Springborn 2007), where none is negative. The mean is then a convex combination, and affine maps are
/// reproduced for any triangles of the mesh.
pub(crate) struct HarmonicWeights {
    /// Number of given vertices; they come first.
    given: usize,
    free: usize,
    /// Free vertex, given vertex and weight of each edge between a free and a given vertex.
    border: Vec<(usize, usize, f64)>,
    factor: Factor<1>,
}

impl HarmonicWeights {
    /// Factorises the weights of a mesh whose first `given` vertices are given; `triangles` must be
    /// counter-clockwise.
    ///
    /// # Errors
    /// The points give no finite weights.
    pub fn new(
        points: &[Vec2],
        triangles: Vec<[usize; 3]>,
        given: usize,
    ) -> Result<Self, NotPositive> {
        let free = points.len() - given;
        let mut entries: Vec<(u32, u32, f64)> = Vec::new();
        let mut pairs: Vec<[u32; 2]> = Vec::new();
        let mut border = Vec::new();
        let edges = match free {
            0 => Vec::new(),
            _ => weights(points, triangles),
        };
        for ([a, b], weight) in edges {
            for (from, to) in [(a, b), (b, a)] {
                let Some(row) = from.checked_sub(given) else {
                    continue;
                };
                entries.push((row as u32, row as u32, weight));
                if let Some(column) = to.checked_sub(given) {
                    entries.push((row as u32, column as u32, -weight));
                    pairs.push([row as u32, column as u32]);
                } else {
                    border.push((row, to, weight));
                }
            }
        }
        let matrix = ScalarMatrix::from_entries(free, &entries);
        let places: Vec<_> = points[given..].iter().map(|p| p.push(0.0)).collect();
        let mut factor: Factor<1> = Factor::new(Graph::from_pairs(free, pairs), &places);
        if free > 0 {
            factor.factorise(|row, _, out| {
                for (out, &value) in out.iter_mut().zip(matrix.row_entries(row).1) {
                    *out = [[value]];
                }
            })?;
        }
        Ok(Self {
            given,
            free,
            border,
            factor,
        })
    }

    /// Displacements (m) of all vertices from those of the given ones.
    pub fn displacements(&mut self, given: &[Vec2]) -> Vec<Vec2> {
        let mut all = given.to_vec();
        if self.free == 0 {
            return all;
        }
        let mut right = vec![0.0; 2 * self.free];
        for &(row, to, weight) in &self.border {
            right[2 * row] += weight * given[to].x;
            right[2 * row + 1] += weight * given[to].y;
        }
        let mut solution = vec![0.0; 2 * self.free];
        self.factor.solve_columns(2, &right, &mut solution);
        all.extend(
            solution
                .chunks_exact(2)
                .map(|pair| Vec2::new(pair[0], pair[1])),
        );
        all
    }
}

/// The weights of one mesh, computed at the first use; copies of the mesh share them.
#[derive(Clone, Default)]
pub(crate) struct SharedWeights(Arc<Mutex<Option<HarmonicWeights>>>);

impl fmt::Debug for SharedWeights {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SharedWeights").finish_non_exhaustive()
    }
}

impl SharedWeights {
    /// Displacements (m) of all vertices from those of the first ones; `make` computes the weights if they
    /// are missing.
    ///
    /// # Errors
    /// The error of `make`.
    pub fn displacements(
        &self,
        given: &[Vec2],
        make: impl FnOnce() -> Result<HarmonicWeights, NotPositive>,
    ) -> Result<Vec<Vec2>, NotPositive> {
        // The weights are stored only when complete, so that a panic elsewhere leaves no incomplete ones.
        let mut shared = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut weights = match shared.take().filter(|had| had.given == given.len()) {
            Some(weights) => weights,
            None => make()?,
        };
        let all = weights.displacements(given);
        *shared = Some(weights);
        Ok(all)
    }
}

/// The edges of the Delaunay triangulation with their weights, each once, in order.
fn weights(points: &[Vec2], triangles: Vec<[usize; 3]>) -> Vec<([usize; 2], f64)> {
    let planar = Planar::delaunay(points.to_vec(), triangles);
    let mut halves: Vec<([usize; 2], f64)> = Vec::with_capacity(3 * planar.triangles.len());
    for t in 0..planar.triangles.len() {
        let (v, p) = (planar.triangles[t], planar.corners(t));
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (u, w) = (p[i] - p[k], p[j] - p[k]);
            let ends = [v[i].min(v[j]), v[i].max(v[j])];
            halves.push((ends, 0.5 * u.dot(&w) / u.perp(&w)));
        }
    }
    halves.sort_by_key(|half| half.0);
    let mut edges: Vec<([usize; 2], f64)> = Vec::with_capacity(halves.len());
    for (ends, half) in halves {
        match edges.last_mut() {
            Some((last, weight)) if *last == ends => *weight += half,
            _ => edges.push((ends, half)),
        }
    }
    for (_, weight) in &mut edges {
        // Not `max`, which would hide a weight that is not a number.
        if *weight < MIN_WEIGHT {
            *weight = MIN_WEIGHT;
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;

    fn harmonic(
        points: &[Vec2],
        triangles: Vec<[usize; 3]>,
        given: &[Vec2],
    ) -> Result<Vec<Vec2>, NotPositive> {
        let mut weights = HarmonicWeights::new(points, triangles, given.len())?;
        let first = weights.displacements(given);
        assert_eq!(
            first,
            weights.displacements(given),
            "the same weights again"
        );
        Ok(first)
    }

    /// A mesh with a boundary and free inner points. The triangles are those of a sheared grid, far from
    /// Delaunay.
    fn skewed() -> (Vec<Vec2>, Vec<[usize; 3]>, usize) {
        let (columns, rows) = (9, 7);
        let at = |i: usize, j: usize| {
            let (x, y) = (i as f64, j as f64);
            Vec2::new(x + 0.7 * y + 0.1 * (x * y).sin(), 0.6 * y)
        };
        let inner = |i: usize, j: usize| i > 0 && j > 0 && i < columns - 1 && j < rows - 1;
        let all = || (0..rows).flat_map(move |j| (0..columns).map(move |i| (i, j)));
        let mut order: Vec<(usize, usize)> = all().filter(|&(i, j)| !inner(i, j)).collect();
        let given = order.len();
        order.extend(all().filter(|&(i, j)| inner(i, j)));
        let number = |i: usize, j: usize| order.iter().position(|&o| o == (i, j)).unwrap();
        let mut triangles = Vec::new();
        for j in 0..rows - 1 {
            for i in 0..columns - 1 {
                let [a, b] = [number(i, j), number(i + 1, j)];
                let [c, d] = [number(i + 1, j + 1), number(i, j + 1)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        (
            order.iter().map(|&(i, j)| at(i, j)).collect(),
            triangles,
            given,
        )
    }

    #[test]
    fn affine_maps_are_reproduced_by_triangles_that_are_not_delaunay() {
        let (points, triangles, given) = skewed();
        let map = |p: &Vec2| Vec2::new(0.3 * p.x - 0.2 * p.y + 1.0, 0.5 * p.x + 0.1 * p.y - 2.0);
        let moved: Vec<Vec2> = points.iter().map(map).collect();
        let found = harmonic(&points, triangles, &moved[..given]).unwrap();
        for (found, wanted) in found.iter().zip(&moved) {
            assert!((found - wanted).norm() < 1e-12, "{found} {wanted}");
        }
    }

    #[test]
    fn no_displacement_is_larger_than_those_given() {
        let (points, triangles, given) = skewed();
        for v in 0..given {
            let mut moved = vec![Vec2::zeros(); given];
            moved[v] = Vec2::new(1.0, -1.0);
            for d in harmonic(&points, triangles.clone(), &moved).unwrap() {
                assert!(
                    (-1e-14..=1.0 + 1e-14).contains(&d.x) && (d.x + d.y).abs() < 1e-14,
                    "{d}"
                );
            }
        }
    }

    #[test]
    fn points_without_area_are_refused() {
        let points = vec![
            Vec2::zeros(),
            Vec2::x(),
            2.0 * Vec2::x(),
            Vec2::new(f64::NAN, 0.0),
        ];
        let triangles = vec![[0, 1, 3], [1, 2, 3], [2, 0, 3]];
        assert!(harmonic(&points, triangles, &[Vec2::zeros(); 3]).is_err());
    }
}
