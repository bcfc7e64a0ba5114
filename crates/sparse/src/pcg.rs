//! Preconditioned conjugate gradients (Hestenes and Stiefel 1952).

use crate::factor::{Factor, Number};
use crate::matrix::{ROW_CHUNK, dot};
use nalgebra::Matrix3;
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Stopping criteria of the linear solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PcgLimits {
    /// Preconditioned residual relative to the first.
    pub tolerance: f64,
    /// Most iterations.
    pub iterations: usize,
}

/// A symmetric positive definite approximate inverse.
pub trait Preconditioner {
    /// Writes the approximate solution for a right-hand side.
    fn apply(&mut self, residual: &[Vec3], solution: &mut [Vec3]);
}

/// Block Jacobi: the inverses of the 3x3 diagonal blocks.
#[derive(Clone, Debug, Default)]
pub struct BlockJacobi {
    inverses: Vec<Matrix3<f64>>,
}

impl BlockJacobi {
    /// Inverts the diagonal blocks; those of fixed rows become zero.
    pub fn refresh(&mut self, fixed: &[bool], diagonal: impl Fn(usize) -> Matrix3<f64> + Sync) {
        self.inverses.resize(fixed.len(), Matrix3::zeros());
        self.inverses
            .par_chunks_mut(ROW_CHUNK)
            .enumerate()
            .for_each(|(chunk, out)| {
                for (k, inverse) in out.iter_mut().enumerate() {
                    let v = chunk * ROW_CHUNK + k;
                    *inverse = if fixed[v] {
                        Matrix3::zeros()
                    } else {
                        let block = diagonal(v);
                        block.try_inverse().unwrap_or_else(|| {
                            Matrix3::identity() / block.diagonal().sum().max(f64::MIN_POSITIVE)
                        })
                    };
                }
            });
    }
}

impl Preconditioner for BlockJacobi {
    fn apply(&mut self, residual: &[Vec3], solution: &mut [Vec3]) {
        for ((z, r), inverse) in solution.iter_mut().zip(residual).zip(&self.inverses) {
            *z = inverse * r;
        }
    }
}

/// The factor of a similar matrix; it must not couple fixed vertices with others.
impl<const D: usize, T: Number> Preconditioner for Factor<D, T> {
    fn apply(&mut self, residual: &[Vec3], solution: &mut [Vec3]) {
        self.solve(residual, solution);
    }
}

/// A system A x = b with A symmetric and positive definite.
pub struct LinearSystem<'a, F> {
    /// The right-hand side.
    pub b: &'a [Vec3],
    /// Rows whose solution is zero.
    pub fixed: &'a [bool],
    /// A row of A times a vector.
    pub row: F,
}

/// Work vectors of the solver.
#[derive(Default)]
pub struct Pcg {
    residual: Vec<Vec3>,
    preconditioned: Vec<Vec3>,
    search: Vec<Vec3>,
    image: Vec<Vec3>,
}

impl Pcg {
    /// Solves a system up to the limits; the solution is then the last iterate. Returns the number of iterations.
    pub fn solve<F: Fn(usize, &[Vec3]) -> Vec3 + Sync>(
        &mut self,
        system: &LinearSystem<F>,
        preconditioner: &mut impl Preconditioner,
        limits: PcgLimits,
        x: &mut [Vec3],
    ) -> usize {
        let n = system.b.len();
        for vector in [
            &mut self.residual,
            &mut self.preconditioned,
            &mut self.search,
            &mut self.image,
        ] {
            vector.resize(n, Vec3::zeros());
        }
        x.fill(Vec3::zeros());
        for ((r, b), &fixed) in self.residual.iter_mut().zip(system.b).zip(system.fixed) {
            *r = if fixed { Vec3::zeros() } else { *b };
        }
        preconditioner.apply(&self.residual, &mut self.preconditioned);
        self.search.copy_from_slice(&self.preconditioned);
        let mut rho = dot(&self.residual, &self.preconditioned);
        let goal = rho * limits.tolerance * limits.tolerance;
        for iteration in 0..limits.iterations {
            if rho <= goal || !rho.is_finite() {
                return iteration;
            }
            self.apply(system);
            let curvature = dot(&self.search, &self.image);
            if curvature <= 0.0 || !curvature.is_finite() {
                return iteration;
            }
            let alpha = rho / curvature;
            for (x, p) in x.iter_mut().zip(&self.search) {
                *x += p * alpha;
            }
            for (r, q) in self.residual.iter_mut().zip(&self.image) {
                *r -= q * alpha;
            }
            preconditioner.apply(&self.residual, &mut self.preconditioned);
            let next = dot(&self.residual, &self.preconditioned);
            let beta = next / rho;
            for (p, z) in self.search.iter_mut().zip(&self.preconditioned) {
                *p = z + *p * beta;
            }
            rho = next;
        }
        limits.iterations
    }

    /// A times the search direction.
    fn apply<F: Fn(usize, &[Vec3]) -> Vec3 + Sync>(&mut self, system: &LinearSystem<F>) {
        let search = &self.search;
        self.image
            .par_chunks_mut(ROW_CHUNK)
            .enumerate()
            .for_each(|(chunk, out)| {
                for (k, image) in out.iter_mut().enumerate() {
                    let v = chunk * ROW_CHUNK + k;
                    *image = if system.fixed[v] {
                        Vec3::zeros()
                    } else {
                        (system.row)(v, search)
                    };
                }
            });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::factor::Graph;

    /// A chain fixed at its first vertex: row v of 2 x_v - x_(v-1) - x_(v+1), the last one free.
    fn row(n: usize, v: usize, p: &[Vec3]) -> Vec3 {
        if v + 1 < n {
            p[v] * 2.0 - p[v - 1] - p[v + 1]
        } else {
            p[v] - p[v - 1]
        }
    }

    fn solve(n: usize, preconditioner: &mut impl Preconditioner) -> usize {
        let fixed: Vec<bool> = (0..n).map(|v| v == 0).collect();
        let b = vec![Vec3::y(); n];
        let mut x = vec![Vec3::zeros(); n];
        let limits = PcgLimits {
            tolerance: 1e-12,
            iterations: 200,
        };
        let system = LinearSystem {
            b: &b,
            fixed: &fixed,
            row: |v, p: &[Vec3]| row(n, v, p),
        };
        let taken = Pcg::default().solve(&system, preconditioner, limits, &mut x);
        // Closed form: x_v = v (n - 1) - v (v - 1) / 2.
        for (v, got) in x.iter().enumerate() {
            let v = v as f64;
            let expected = v * (n as f64 - 1.0) - v * (v - 1.0) / 2.0;
            assert!((got.y - expected).abs() < 1e-8, "{v}: {} {expected}", got.y);
        }
        taken
    }

    #[test]
    fn a_fixed_chain_is_solved() {
        let n = 50;
        let fixed: Vec<bool> = (0..n).map(|v| v == 0).collect();
        let mut jacobi = BlockJacobi::default();
        jacobi.refresh(&fixed, |v| {
            Matrix3::identity() * if v + 1 < n { 2.0 } else { 1.0 }
        });
        assert!(solve(n, &mut jacobi) < 200);
    }

    #[test]
    fn a_stale_factor_needs_few_iterations() {
        let n = 50usize;
        let graph = Graph::from_pairs(n, (1..n as u32).map(|v| [v - 1, v]));
        let places: Vec<Vec3> = (0..n).map(|v| Vec3::x() * v as f64).collect();
        let mut stale = Factor::<1, f32>::new(graph, &places);
        // The same chain with each link a fifth stiffer or softer.
        let link = |v: u32| if v.is_multiple_of(2) { 1.2 } else { 0.8 };
        stale
            .factorise(|v, columns, row| {
                let v = v as u32;
                for (out, &u) in row.iter_mut().zip(columns) {
                    let last = v as usize + 1 == n;
                    *out = match (v, u) {
                        (0, 0) => [[1.0]],
                        (0, _) | (_, 0) => [[0.0]],
                        _ if u == v => [[link(v) + if last { 0.0 } else { link(v + 1) }]],
                        _ => [[-link(u.max(v))]],
                    };
                }
            })
            .unwrap();
        assert!(solve(n, &mut stale) < 12);
    }
}
