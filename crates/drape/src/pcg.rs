//! Conjugate gradients preconditioned by the inverses of the 3x3 diagonal blocks.

use crate::sparse::{ROW_CHUNK, dot};
use nalgebra::Matrix3;
use rayon::prelude::*;
use toile_geometry::Vec3;

/// When the linear solver stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PcgLimits {
    /// Preconditioned residual relative to the start.
    pub tolerance: f64,
    /// Iterations at the most.
    pub iterations: usize,
}

/// Private vectors of the solver, sized once.
#[derive(Default)]
pub struct Pcg {
    residual: Vec<Vec3>,
    preconditioned: Vec<Vec3>,
    search: Vec<Vec3>,
    image: Vec<Vec3>,
    inverses: Vec<Matrix3<f64>>,
}

impl Pcg {
    /// Solves A x = b for a symmetric positive definite A given by its rows; `fixed` rows of the
    /// result are zero. Stops early with what it has. Returns the iterations taken.
    pub fn solve(
        &mut self,
        b: &[Vec3],
        fixed: &[bool],
        row: impl Fn(usize, &[Vec3]) -> Vec3 + Sync,
        diagonal: impl Fn(usize) -> Matrix3<f64> + Sync,
        limits: PcgLimits,
        x: &mut [Vec3],
    ) -> usize {
        let n = b.len();
        for vector in [
            &mut self.residual,
            &mut self.preconditioned,
            &mut self.search,
            &mut self.image,
        ] {
            vector.resize(n, Vec3::zeros());
        }
        self.inverses.resize(n, Matrix3::zeros());
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
        x.fill(Vec3::zeros());
        self.residual.copy_from_slice(b);
        self.precondition();
        self.search.copy_from_slice(&self.preconditioned);
        let mut rho = dot(&self.residual, &self.preconditioned);
        let goal = rho * limits.tolerance * limits.tolerance;
        for iteration in 0..limits.iterations {
            if rho <= goal || !rho.is_finite() {
                return iteration;
            }
            let search = &self.search;
            self.image
                .par_chunks_mut(ROW_CHUNK)
                .enumerate()
                .for_each(|(chunk, out)| {
                    for (k, image) in out.iter_mut().enumerate() {
                        let v = chunk * ROW_CHUNK + k;
                        *image = if fixed[v] {
                            Vec3::zeros()
                        } else {
                            row(v, search)
                        };
                    }
                });
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
            self.precondition();
            let next = dot(&self.residual, &self.preconditioned);
            let beta = next / rho;
            for (p, z) in self.search.iter_mut().zip(&self.preconditioned) {
                *p = z + *p * beta;
            }
            rho = next;
        }
        limits.iterations
    }

    fn precondition(&mut self) {
        for ((z, r), inverse) in self
            .preconditioned
            .iter_mut()
            .zip(&self.residual)
            .zip(&self.inverses)
        {
            *z = inverse * r;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fixed_chain_is_solved() {
        let n = 50;
        let fixed: Vec<bool> = (0..n).map(|v| v == 0).collect();
        let row = |v: usize, p: &[Vec3]| {
            let mut sum = p[v] * 2.0 - p[v - 1];
            if v + 1 < n {
                sum -= p[v + 1];
            } else {
                sum -= p[v];
            }
            sum
        };
        let diagonal = |v: usize| Matrix3::identity() * if v + 1 < n { 2.0 } else { 1.0 };
        let b = vec![Vec3::y(); n];
        let mut x = vec![Vec3::zeros(); n];
        let limits = PcgLimits {
            tolerance: 1e-12,
            iterations: 200,
        };
        let taken = Pcg::default().solve(&b, &fixed, row, diagonal, limits, &mut x);
        assert!(taken < 200);
        // Closed form: x_v = v (n - 1) - v (v - 1) / 2.
        for (v, got) in x.iter().enumerate() {
            let v = v as f64;
            let expected = v * (n as f64 - 1.0) - v * (v - 1.0) / 2.0;
            assert!((got.y - expected).abs() < 1e-8, "{v}: {} {expected}", got.y);
        }
    }
}
