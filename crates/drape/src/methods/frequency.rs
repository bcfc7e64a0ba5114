//! The largest angular frequency of a model, which bounds the substep of every explicit method.

use crate::laws::contact::RESTITUTION_DAMPING;
use crate::laws::membrane::Curvature;
use crate::{ContactSample, Inertia, State, System, Workspace};
use toile_geometry::Vec3;

/// Lanczos iteration for the largest frequency, with its private memory.
#[derive(Default)]
pub struct FrequencySearch {
    zeros: Vec<f64>,
    inverse_roots: Vec<f64>,
    before: Vec<Vec3>,
    present: Vec<Vec3>,
    scaled: Vec<Vec3>,
    next: Vec<Vec3>,
}

/// The vibration of the largest frequency.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FastestMode {
    /// Angular frequency (rad/s).
    pub frequency: f64,
    /// The vertex of largest amplitude.
    pub vertex: usize,
}

/// Lanczos iterations of [`largest_frequency`]: relative error 1e-6 on the meshes tried.
const ACCURATE_ITERATIONS: usize = 160;

/// Lanczos iterations before every step of an explicit method: relative error of a few per mille.
const STEP_ITERATIONS: usize = 30;

/// The largest angular frequency of the free vertices about a state (rad/s): the square root of
/// the largest eigenvalue of M^-1 K, K the positive semidefinite Hessian of membrane, bending,
/// elastics and the loaded contacts at that state. At equilibrium K is the exact Hessian.
///
/// By Lanczos iteration (Lanczos 1950). Cost: about 160 products with K.
pub fn largest_frequency(system: &System, state: &State) -> f64 {
    let mut workspace = Workspace::default();
    FrequencySearch::default()
        .run(system, state, &mut workspace, ACCURATE_ITERATIONS)
        .frequency
}

/// A bound on the frequency that contact can add (rad/s): the largest sum over a vertex of
/// w_s k_s / m, samples s at it with weight w_s and normal stiffness k_s (rows of K summed, so
/// every eigenvalue is below it; Gershgorin 1931). With samples at vertices alone it is
/// sqrt(stiffness / density). Zero without solid surfaces.
pub fn contact_frequency(system: &System, samples: &[ContactSample]) -> f64 {
    if system.colliders.is_empty() {
        return 0.0;
    }
    let mut stiffness = vec![0.0; system.vertex_count()];
    for sample in samples {
        let law = system.contact.law(sample.area, sample.friction);
        for (&v, &w) in sample.vertices.iter().zip(&sample.weights) {
            stiffness[v as usize] += w * law.normal;
        }
    }
    stiffness
        .iter()
        .zip(&system.rest.mass)
        .zip(&system.prescribed.pinned)
        .filter(|&(_, &pinned)| !pinned)
        .map(|((k, m), _)| k / m)
        .fold(0.0, f64::max)
        .sqrt()
}

/// [`contact_frequency`] raised for the contact dashpot (rad/s): a dashpot of damping ratio zeta, evaluated at the old
/// velocity, lowers the limit of h w from 2 to 2 (sqrt(1 + zeta^2) - zeta).
pub fn damped_contact_frequency(system: &System, samples: &[ContactSample]) -> f64 {
    let zeta = RESTITUTION_DAMPING;
    contact_frequency(system, samples) * (zeta.hypot(1.0) + zeta)
}

impl FrequencySearch {
    /// Lanczos iteration about a state without viscosity, with a fixed start vector and at most `iterations` products
    /// with K. The frequency is a lower bound, within a few per mille after 30.
    pub fn run(
        &mut self,
        system: &System,
        state: &State,
        workspace: &mut Workspace,
        iterations: usize,
    ) -> FastestMode {
        workspace.increment.begin_static(system, state);
        self.search(system, state, workspace, iterations)
    }

    /// The largest stable substep (s) and the vertex of largest amplitude: w h = `limit` without damping, and with
    /// the damping ratio xi of the fastest vibration h = limit / w (sqrt(1 + xi^2) - xi), the limit of a leapfrog
    /// whose damping force is evaluated at the lagging velocity (Belytschko, Liu and Moran 2000, section 6.2).
    /// `extra` is the frequency (rad/s) of contact, added in squares.
    pub fn stable_step(
        &mut self,
        system: &System,
        state: &State,
        workspace: &mut Workspace,
        [limit, extra]: [f64; 2],
    ) -> (f64, usize) {
        let undamped = self.run(system, state, workspace, STEP_ITERATIONS);
        let w = undamped.frequency.hypot(extra);
        let mut ratio = 0.0;
        if w > 0.0
            && (system.materials.have_viscous_stretch() || system.rest.viscous_bending.is_some())
        {
            // K + w C has the eigenvalue w^2 + 2 xi w^2 for the same vibration.
            workspace.increment.begin_step(system, state, w);
            let damped = self
                .search(system, state, workspace, STEP_ITERATIONS)
                .frequency;
            ratio = (damped * damped - undamped.frequency * undamped.frequency).max(0.0)
                / (2.0 * w * w);
            workspace.increment.begin_static(system, state);
        }
        let shortened = (1.0 + ratio * ratio).sqrt() - ratio;
        (limit / w * shortened, undamped.vertex)
    }

    fn search(
        &mut self,
        system: &System,
        state: &State,
        workspace: &mut Workspace,
        iterations: usize,
    ) -> FastestMode {
        let n = system.vertex_count();
        self.fit(system);
        workspace.fit(system);
        workspace.contacts.refresh(system, state, &state.positions);
        let inertia = Inertia {
            weight: &self.zeros,
            target: &state.positions,
        };
        workspace.fill_gradient(system, &state.positions, Some(&inertia));
        workspace.fill_hessian(system, &state.positions, &inertia, Curvature::CONVEX);
        let (mut diagonal, mut off_diagonal) = (Vec::new(), Vec::new());
        let mut beta = normalise(&mut self.present);
        for _ in 0..iterations.min(3 * n) {
            if beta == 0.0 {
                break;
            }
            for ((s, q), root) in self
                .scaled
                .iter_mut()
                .zip(&self.present)
                .zip(&self.inverse_roots)
            {
                *s = q * *root;
            }
            let last = off_diagonal.last().copied().unwrap_or(0.0);
            for (v, next) in self.next.iter_mut().enumerate() {
                let root = self.inverse_roots[v];
                *next = if root == 0.0 {
                    Vec3::zeros()
                } else {
                    workspace.hessian_row(system, v, &self.scaled) * root - self.before[v] * last
                };
            }
            let alpha: f64 = self
                .next
                .iter()
                .zip(&self.present)
                .map(|(a, b)| a.dot(b))
                .sum();
            for (next, q) in self.next.iter_mut().zip(&self.present) {
                *next -= q * alpha;
            }
            diagonal.push(alpha);
            beta = normalise(&mut self.next);
            // A zero vector up to rounding: the Krylov space is exhausted.
            if beta <= 1e-12 * alpha.abs() {
                break;
            }
            off_diagonal.push(beta);
            std::mem::swap(&mut self.before, &mut self.present);
            std::mem::swap(&mut self.present, &mut self.next);
        }
        let eigenvalue = largest_eigenvalue(&diagonal, &off_diagonal);
        FastestMode {
            frequency: eigenvalue.max(0.0).sqrt(),
            vertex: largest_component(&self.present),
        }
    }

    /// Sizes the vectors for a model and sets the start vector.
    fn fit(&mut self, system: &System) {
        let n = system.vertex_count();
        self.zeros.resize(n, 0.0);
        for vector in [
            &mut self.before,
            &mut self.present,
            &mut self.scaled,
            &mut self.next,
        ] {
            vector.clear();
            vector.resize(n, Vec3::zeros());
        }
        self.inverse_roots.clear();
        self.inverse_roots.extend(
            system
                .rest
                .mass
                .iter()
                .zip(&system.prescribed.pinned)
                .map(|(m, &pinned)| if pinned { 0.0 } else { 1.0 / m.sqrt() }),
        );
        for (v, q) in self.present.iter_mut().enumerate() {
            if !system.prescribed.pinned[v] {
                *q = Vec3::from_fn(|axis, _| pseudo_random((3 * v + axis) as u64));
            }
        }
    }
}

/// A pseudo-random number in -1..1 by the mixing function of SplitMix64 (Steele, Lea and Flood 2014): components of a
/// start vector that is, for practical purposes, orthogonal to no vibration.
pub(super) fn pseudo_random(index: u64) -> f64 {
    let mut z = index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Normalises a vector to length 1 and returns its former length.
fn normalise(q: &mut [Vec3]) -> f64 {
    let length = q.iter().map(Vec3::norm_squared).sum::<f64>().sqrt();
    if length > 0.0 {
        for q in q.iter_mut() {
            *q /= length;
        }
    }
    length
}

/// The index of the longest vector.
fn largest_component(q: &[Vec3]) -> usize {
    let mut best = (0, -1.0);
    for (v, q) in q.iter().enumerate() {
        if q.norm_squared() > best.1 {
            best = (v, q.norm_squared());
        }
    }
    best.0
}

/// The largest eigenvalue of a symmetric tridiagonal matrix, by bisection on the count of
/// eigenvalues below a number (Sturm's sequence; Golub and Van Loan 2013, section 8.4).
fn largest_eigenvalue(diagonal: &[f64], off_diagonal: &[f64]) -> f64 {
    let n = diagonal.len();
    let side = |k: usize| {
        let left = if k > 0 { off_diagonal[k - 1] } else { 0.0 };
        let right = if k + 1 < n { off_diagonal[k] } else { 0.0 };
        left.abs() + right.abs()
    };
    let mut low = diagonal.iter().copied().fold(0.0, f64::max);
    let mut high = (0..n).map(|k| diagonal[k] + side(k)).fold(low, f64::max);
    let all_below = |x: f64| {
        let mut pivot = 1.0;
        for k in 0..n {
            let coupling = if k > 0 { off_diagonal[k - 1] } else { 0.0 };
            pivot = x - diagonal[k] - coupling * coupling / pivot;
            if pivot <= 0.0 {
                return false;
            }
        }
        true
    };
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if all_below(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_eigenvalue_of_a_chain_is_that_of_its_closed_form() {
        // The matrix 2, -1 of order n has the eigenvalues 2 - 2 cos(k pi / (n + 1)).
        let n = 12;
        let got = largest_eigenvalue(&vec![2.0; n], &vec![-1.0; n - 1]);
        let expected = 2.0 + 2.0 * (std::f64::consts::PI / 13.0).cos();
        assert!((got - expected).abs() < 1e-13, "{got} {expected}");
        assert_eq!(largest_eigenvalue(&[], &[]), 0.0);
    }
}
