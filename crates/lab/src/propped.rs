//! The propped elastica: an inextensible strip without weight, clamped upright over a table and
//! pushed down on it, its tip held in place by friction.
//!
//! With phi the angle from the upright, s the length from the clamp over L, and the forces N (from
//! below) and T (along the table) in units of D / L^2:
//! phi'' = -N sin(phi) - T cos(phi), phi(0) = 0, phi'(1) = 0, and the tip straight below the clamp at
//! 1 - epsilon: the integral of sin(phi) is 0, that of cos(phi) is 1 - epsilon (Love 1927, section
//! 262). Friction has to bear |T| / N. At epsilon = 0 the strip buckles at N = 20.19 (Euler's load
//! of a strip clamped and propped, tan k = k, N = k^2), with T proportional to the mode.

use nalgebra::{Matrix3, Vector3};

/// Forces on the tip of a propped strip, over D / L^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Propped {
    /// Upward force, a ratio.
    pub normal: f64,
    /// Force along the table, a ratio; its sign is that of the side the strip bends to.
    pub along: f64,
}

impl Propped {
    /// Coefficient of friction that holds the tip.
    pub fn friction(&self) -> f64 {
        self.along.abs() / self.normal
    }
}

/// First root of tan k = k: the strip buckles under k^2.
const BUCKLING: f64 = 4.493_409_457_909_064;

/// Steps of the integration along the strip: halving them changes the forces by less than 1e-8.
const STEPS: usize = 400;

/// From the straight strip to the one wanted in so many stages.
const STAGES: usize = 40;

/// Solves the propped elastica for the share `epsilon` of its length that the clamp has come down,
/// above 0 and up to 0.6.
pub fn propped_elastica(epsilon: f64) -> Propped {
    let first = epsilon / STAGES as f64;
    // The mode phi = -(T/N) (1 - cos ks) + (T/k) sin ks has phi'(0) = T; epsilon is half the mean of
    // its square.
    let unit = shape(Vector3::new(BUCKLING * BUCKLING, -1e-3, -1e-3));
    let scale = (first / (1.0 - unit[2])).sqrt();
    let mut unknown = Vector3::new(BUCKLING * BUCKLING, -1e-3 * scale, -1e-3 * scale);
    for stage in 1..=STAGES {
        let down = epsilon * stage as f64 / STAGES as f64;
        if stage > 1 {
            // Forces grow with the root of the way down.
            let grown = (stage as f64 / (stage - 1) as f64).sqrt();
            unknown = Vector3::new(unknown[0], unknown[1] * grown, unknown[2] * grown);
        }
        unknown = solve(unknown, 1.0 - down);
    }
    Propped {
        normal: unknown[0],
        along: unknown[1],
    }
}

/// Newton's method for N, T and the curvature at the clamp that meet the ends.
fn solve(mut unknown: Vector3<f64>, height: f64) -> Vector3<f64> {
    let miss = |unknown: Vector3<f64>| shape(unknown) - Vector3::new(0.0, 0.0, height);
    for _ in 0..30 {
        let value = miss(unknown);
        let mut slope = Matrix3::zeros();
        for k in 0..3 {
            let h = 1e-6 * unknown[k].abs().max(1e-3);
            let more = Vector3::ith(k, h);
            slope.set_column(
                k,
                &((miss(unknown + more) - miss(unknown - more)) / (2.0 * h)),
            );
        }
        let Some(step) = slope.lu().solve(&value) else {
            break;
        };
        unknown -= step;
        if step.norm() < 1e-11 * unknown.norm() {
            break;
        }
    }
    unknown
}

/// Slope at the tip and its place, (phi'(1), x, y), for N, T and phi'(0), by Runge and Kutta.
fn shape(unknown: Vector3<f64>) -> Vector3<f64> {
    let [normal, along, bent] = [unknown[0], unknown[1], unknown[2]];
    let slope = |y: [f64; 4]| {
        let (sin, cos) = y[0].sin_cos();
        [y[1], -normal * sin - along * cos, sin, cos]
    };
    let h = 1.0 / STEPS as f64;
    let step = |y: [f64; 4], k: [f64; 4], h: f64| [0, 1, 2, 3].map(|i| y[i] + h * k[i]);
    let mut y = [0.0, bent, 0.0, 0.0];
    for _ in 0..STEPS {
        let k1 = slope(y);
        let k2 = slope(step(y, k1, 0.5 * h));
        let k3 = slope(step(y, k2, 0.5 * h));
        let k4 = slope(step(y, k3, h));
        y = [0, 1, 2, 3].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    Vector3::new(y[1], y[2], y[3])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elastica::tests::shared;

    #[test]
    fn a_strip_hardly_pushed_carries_the_load_of_euler() {
        let held = propped_elastica(1e-4);
        assert!((held.normal - 20.19).abs() < 0.01, "{held:?}");
        // The mode phi = T g(s), and epsilon is half the mean of its square.
        let mode = |s: f64| {
            let turn = BUCKLING * s;
            turn.sin() / BUCKLING - (1.0 - turn.cos()) / (BUCKLING * BUCKLING)
        };
        let squares = (0..1000).map(|k| mode((f64::from(k) + 0.5) * 1e-3).powi(2));
        let expected = (2.0 * 1e-4 / (squares.sum::<f64>() * 1e-3)).sqrt();
        assert!(
            (held.along.abs() / expected - 1.0).abs() < 1e-3,
            "{held:?} {expected}"
        );
    }

    #[test]
    fn agrees_with_a_table() {
        let Some(text) = shared("drape/stick_slip_elastica.txt") else {
            return;
        };
        let mut compared = 0;
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            let after = |name: &str| {
                let at = words.iter().position(|w| w.starts_with(name))?;
                let word = words[at].split_once('=').map_or("", |(_, value)| value);
                let next = words[at + 1..].iter().find_map(|w| w.parse::<f64>().ok());
                word.parse().ok().or(next)
            };
            let [Some(epsilon), Some(friction)] = ["eps_y", "mu_req"].map(after) else {
                continue;
            };
            if epsilon <= 0.6 {
                let got = propped_elastica(epsilon).friction();
                assert!((got - friction).abs() < 2e-5, "{epsilon}: {got} {friction}");
                compared += 1;
            }
        }
        assert!(compared >= 12, "{compared}");
    }
}
