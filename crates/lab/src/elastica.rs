//! The heavy elastica: an inextensible strip clamped horizontally and bent by its own weight.
//!
//! theta'' = -Gamma (1 - s) cos(theta), theta(0) = 0, theta'(1) = 0, with theta below the
//! horizontal, s the length from the clamp over L and Gamma = rho g L^3 / D (Bickley 1934).
//! Solved by shooting from the free end in delta = pi/2 - theta and t = 1 - s:
//! delta'' = Gamma t sin(delta), delta'(0) = 0, delta(1) = pi/2. From this end the solution grows,
//! so the shooting is well conditioned in log delta(0) at every Gamma.

use std::f64::consts::FRAC_PI_2;

/// The shape of a heavy strip, lengths as shares of its own length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastica {
    /// Drop of the tip over the length of the strip, a share.
    pub drop: f64,
    /// Horizontal reach of the tip over the length of the strip, a share.
    pub reach: f64,
    /// Angle of the tip below the horizontal (rad).
    pub tip: f64,
}

impl Elastica {
    /// Drop over reach, h/w.
    pub fn ratio(&self) -> f64 {
        self.drop / self.reach
    }

    /// Angle of the chord from clamp to tip below the horizontal (rad).
    pub fn chord(&self) -> f64 {
        self.drop.atan2(self.reach)
    }
}

/// Steps of the integration along the strip: halving them changes h/w by less than 1e-9.
const STEPS: usize = 2000;

/// Solves the heavy elastica for Gamma = rho g L^3 / D.
pub fn heavy_elastica(gamma: f64) -> Elastica {
    let overshoot = |log: f64| integrate(gamma, log.exp())[0] - FRAC_PI_2;
    let log = crate::root::bisect(-120.0, FRAC_PI_2.ln(), overshoot);
    let start = log.exp();
    let [_, _, drop, reach] = integrate(gamma, start);
    Elastica {
        drop,
        reach,
        tip: FRAC_PI_2 - start,
    }
}

/// delta, its slope, and the integrals of sin(theta), cos(theta) at the clamp, by Runge and Kutta.
fn integrate(gamma: f64, start: f64) -> [f64; 4] {
    let slope = |t: f64, y: [f64; 4]| [y[1], gamma * t * y[0].sin(), y[0].cos(), y[0].sin()];
    let h = 1.0 / STEPS as f64;
    let mut y = [start, 0.0, 0.0, 0.0];
    let along = |y: [f64; 4], k: [f64; 4], h: f64| [0, 1, 2, 3].map(|i| y[i] + h * k[i]);
    for n in 0..STEPS {
        let t = n as f64 * h;
        let k1 = slope(t, y);
        let k2 = slope(t + 0.5 * h, along(y, k1, 0.5 * h));
        let k3 = slope(t + 0.5 * h, along(y, k2, 0.5 * h));
        let k4 = slope(t + h, along(y, k3, h));
        y = [0, 1, 2, 3].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        if y[0].is_nan() || y[0].abs() >= 50.0 {
            // Far beyond the clamp already: the start is too large.
            return [50.0, 0.0, 0.0, 1.0];
        }
    }
    y
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use std::path::Path;

    /// A table of the test material, where it is present; says so where it is not.
    pub(crate) fn shared(file: &str) -> Option<String> {
        let found = Path::new(env!("CARGO_MANIFEST_DIR"))
            .ancestors()
            .map(|folder| folder.join("shared/data").join(file))
            .find(|path| path.is_file());
        if found.is_none() {
            println!("skipped: no shared data folder");
        }
        found.map(|path| std::fs::read_to_string(path).unwrap())
    }

    /// Gamma, h/w, h/L, w/L, tip angle (degree): solved by collocation to 1e-9.
    const TABLE: [[f64; 5]; 10] = [
        [0.1, 0.012500, 0.012498, 0.999911, 0.955],
        [1.0, 0.124562, 0.123471, 0.991246, 9.460],
        [2.0, 0.246673, 0.238507, 0.966893, 18.43],
        [5.0, 0.585721, 0.495905, 0.846657, 39.94],
        [10.0, 1.066802, 0.700200, 0.656354, 60.31],
        [20.0, 1.863930, 0.829881, 0.445232, 76.75],
        [50.0, 3.705561, 0.907917, 0.245015, 87.46],
        [100.0, 5.888105, 0.937524, 0.159223, 89.62],
        [200.0, 8.906771, 0.956769, 0.107420, 89.97],
        [1000.0, 21.33544, 0.981141, 0.045986, 90.00],
    ];

    #[test]
    fn agrees_with_collocation() {
        for [gamma, ratio, drop, reach, tip] in TABLE {
            let shape = heavy_elastica(gamma);
            assert!(
                (shape.ratio() - ratio).abs() < 6e-7 + 2e-5 * ratio,
                "{gamma} {shape:?}"
            );
            assert!((shape.drop - drop).abs() < 2e-6, "{gamma} {shape:?}");
            assert!((shape.reach - reach).abs() < 2e-6, "{gamma} {shape:?}");
            assert!(
                (shape.tip.to_degrees() - tip).abs() < 0.01,
                "{gamma} {shape:?}"
            );
        }
    }

    #[test]
    fn a_stiff_strip_bends_by_the_beam_formula() {
        // h/L = Gamma / 8 for small deflections.
        let shape = heavy_elastica(1e-3);
        assert!((shape.drop / 1.25e-4 - 1.0).abs() < 1e-6, "{shape:?}");
    }

    #[test]
    fn agrees_with_a_published_curve() {
        let Some(text) = shared("drape/heavy_elastica.csv") else {
            return;
        };
        let mut compared = 0;
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            let row: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
            if row[0] <= 1000.0 {
                let ratio = heavy_elastica(row[0]).ratio();
                assert!((ratio / row[1] - 1.0).abs() < 1e-4, "{row:?} {ratio}");
                compared += 1;
            }
        }
        assert!(compared > 40);
    }
}
