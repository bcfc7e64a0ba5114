//! Memory of L-BFGS: pairs of a step and the change of the gradient over it.

use std::collections::VecDeque;
use toile_geometry::Vec3;
use toile_sparse::dot;

/// A step s and the change y of the gradient over it.
#[derive(Default)]
struct Pair {
    s: Vec<Vec3>,
    y: Vec<Vec3>,
    product: f64,
}

/// The correction pairs of the last steps, and the last iterate.
#[derive(Default)]
pub struct CorrectionPairs {
    pairs: VecDeque<Pair>,
    spare: Option<Pair>,
    /// The last iterate and its gradient.
    iterate: Vec<Vec3>,
    gradient: Vec<Vec3>,
    /// The vector q of the two-loop recursion.
    remainder: Vec<Vec3>,
    /// The factors a_i of the two-loop recursion, from new to old.
    factors: Vec<f64>,
}

/// Least s.y as a share of |s| |y|: below it the product is rounding.
const MIN_CURVATURE: f64 = 1e-10;

impl CorrectionPairs {
    /// Removes all pairs; the last iterate remains.
    pub fn clear(&mut self) {
        self.pairs.clear();
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Adds an iterate with its gradient. The step from the last iterate becomes a pair if its curvature s.y is
    /// positive; at most `most` pairs remain.
    pub fn push(&mut self, x: &[Vec3], gradient: &[Vec3], most: usize) {
        if self.iterate.len() == x.len() {
            let mut pair = match self.pairs.len() >= most {
                true => self.pairs.pop_front().unwrap_or_default(),
                false => self.spare.take().unwrap_or_default(),
            };
            let difference = |to: &mut Vec<Vec3>, now: &[Vec3], before: &[Vec3]| {
                to.clear();
                to.extend(now.iter().zip(before).map(|(a, b)| a - b));
            };
            difference(&mut pair.s, x, &self.iterate);
            difference(&mut pair.y, gradient, &self.gradient);
            pair.product = dot(&pair.s, &pair.y);
            let scale = (dot(&pair.s, &pair.s) * dot(&pair.y, &pair.y)).sqrt();
            match pair.product > MIN_CURVATURE * scale {
                true => self.pairs.push_back(pair),
                false => self.spare = Some(pair),
            }
        }
        self.iterate.clear();
        self.iterate.extend_from_slice(x);
        self.gradient.clear();
        self.gradient.extend_from_slice(gradient);
    }

    /// The descent direction at the last iterate by the two-loop recursion (Nocedal and Wright 2006, algorithm 7.4):
    /// q = g; for the pairs from new to old a_i = s_i.q / s_i.y_i, q -= a_i y_i; r = A^-1 q;
    /// from old to new r += (a_i - y_i.r / s_i.y_i) s_i; the direction is -r. `solve` gives A^-1 of a vector.
    pub fn descent_direction(
        &mut self,
        direction: &mut [Vec3],
        solve: impl FnOnce(&[Vec3], &mut [Vec3]),
    ) {
        let q = &mut self.remainder;
        q.clone_from(&self.gradient);
        self.factors.clear();
        for pair in self.pairs.iter().rev() {
            let factor = dot(&pair.s, q) / pair.product;
            self.factors.push(factor);
            for (q, y) in q.iter_mut().zip(&pair.y) {
                *q -= y * factor;
            }
        }
        solve(q, direction);
        for (pair, &factor) in self.pairs.iter().zip(self.factors.iter().rev()) {
            let correction = factor - dot(&pair.y, direction) / pair.product;
            for (r, s) in direction.iter_mut().zip(&pair.s) {
                *r += s * correction;
            }
        }
        for d in direction {
            *d = -*d;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    /// Descends x.Hx / 2 for three numbers with exact steps along the direction; the metric is 1.
    #[test]
    fn as_many_pairs_as_unknowns_find_the_bottom_of_a_bowl() {
        let h = Matrix3::new(4.0, 1.0, 0.0, 1.0, 3.0, 0.5, 0.0, 0.5, 40.0);
        let mut x = vec![Vec3::new(1.0, -2.0, 0.5)];
        let (mut pairs, mut direction) = (CorrectionPairs::default(), [Vec3::zeros()]);
        let mut norms = Vec::<f64>::new();
        for _ in 0..4 {
            let gradient = [h * x[0]];
            norms.push(gradient[0].norm());
            pairs.push(&x, &gradient, 8);
            pairs.descent_direction(&mut direction, |q, r| r.copy_from_slice(q));
            let slope = gradient[0].dot(&direction[0]);
            assert!(slope < 0.0 || norms[norms.len() - 1] < 1e-12);
            let curvature = direction[0].dot(&(h * direction[0]));
            if curvature > 0.0 {
                x[0] -= direction[0] * (slope / curvature);
            }
        }
        assert!(norms[3] < 1e-12 * norms[0], "{norms:?}");
        assert!(norms[2] > 1e-3 * norms[0], "{norms:?}");
    }

    #[test]
    fn steps_along_which_the_gradient_falls_and_old_ones_are_not_remembered() {
        let mut pairs = CorrectionPairs::default();
        let at = |x: f64| vec![Vec3::x() * x];
        pairs.push(&at(0.0), &at(0.0), 2);
        assert!(pairs.is_empty(), "one place is no step");
        pairs.push(&at(1.0), &at(-1.0), 2);
        assert!(pairs.is_empty());
        for k in 2..6 {
            pairs.push(&at(f64::from(k)), &at(f64::from(k * k)), 2);
        }
        assert_eq!(pairs.pairs.len(), 2);
        assert_eq!(pairs.pairs[1].product, 9.0);
        pairs.clear();
        assert!(pairs.is_empty());
        pairs.push(&at(9.0), &at(81.0), 2);
        assert_eq!(pairs.pairs[0].product, 4.0 * 56.0);
    }
}
