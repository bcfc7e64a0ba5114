//! Materials from the usual textile tests: KES-F, cantilever, Cusick drape.

use crate::material::Material;
use std::f64::consts::PI;

/// One gram force (N).
const GRAM_FORCE: f64 = 9.80665e-3;

/// Largest load of KES-FB1: 500 gf/cm as force per length (N/m).
pub const KES_LOAD: f64 = 500.0 * GRAM_FORCE / 1e-2;

/// Curvature to which KES-FB2 bends (1/m): 2.5 per cm.
const KES_CURVATURE: f64 = 250.0;

/// Acceleration of gravity (m/s2).
const GRAVITY: f64 = 9.80665;

/// Values of the Kawabata evaluation system (Kawabata 1980) in its own units, warp and weft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KesValues {
    /// B: bending stiffness (gf cm2/cm).
    pub bending: [f64; 2],
    /// 2HB: hysteresis of the bending moment at 1/cm (gf cm/cm).
    pub bending_hysteresis: [f64; 2],
    /// G: shear stiffness, mean of warp and weft (gf/(cm deg)).
    pub shear: f64,
    /// 2HG: hysteresis of the shear force at half a degree (gf/cm).
    pub shear_hysteresis: f64,
    /// EM or EMT: extension at 500 gf/cm (%).
    pub extension: [f64; 2],
    /// LT: linearity of the load-extension curve (1), above 0.5 to 1.
    pub linearity: [f64; 2],
    /// RT: share of the tensile energy recovered (%).
    pub resilience: [f64; 2],
    /// T0: thickness at 0.5 gf/cm2 (mm).
    pub thickness: f64,
    /// W: weight (mg/cm2).
    pub weight: f64,
    /// MIU: coefficient of friction against the instrument's piano wires.
    pub friction: f64,
}

impl KesValues {
    /// An elastic material. KES does not measure lateral contraction, so `poisson` is 0, nor bending along the bias,
    /// which is set to the mean of warp and weft (618 fabrics have medians of
    /// 13.8, 8.8 and 11.5 uN m along warp, weft and bias; Feng et al. 2022).
    pub fn material(&self) -> Material {
        let curves = [0, 1].map(|k| tensile_curve(self.extension[k], self.linearity[k]));
        let [warp, weft] = self.bending.map(bending);
        Material {
            density: weight(self.weight),
            thickness: self.thickness * 1e-3,
            stretch: curves.map(|(stiffness, _)| stiffness),
            hardening: curves.map(|(_, hardening)| hardening),
            shear: shear(self.shear),
            poisson: 0.0,
            bend: [warp, weft, 0.5 * (warp + weft)],
            friction: self.friction,
            ..Material::default()
        }
    }

    /// Share of a fold that remains: KES bends to 2.5/cm and back, and at zero moment the curvature is HB / B. The
    /// larger of warp and weft, at most 0.95, for [`Material::relaxed_fraction`].
    pub fn kept_fold(&self) -> f64 {
        let share = |k: usize| {
            let left = 0.5 * self.bending_hysteresis[k] / self.bending[k];
            left * 100.0 / KES_CURVATURE
        };
        share(0).max(share(1)).clamp(0.0, 0.95)
    }
}

/// B of KES (gf cm2/cm) as bending stiffness (N m).
pub const fn bending(b: f64) -> f64 {
    b * GRAM_FORCE * 1e-2
}

/// G of KES (gf/(cm deg)) as shear stiffness (N/m per rad).
pub const fn shear(g: f64) -> f64 {
    g * GRAM_FORCE / 1e-2 * 180.0 / PI
}

/// W of KES (mg/cm2) as density (kg/m2).
pub const fn weight(w: f64) -> f64 {
    w * 1e-2
}

/// Least linearity of the cubic curve: a pure cube has 1/2.
const MIN_LINEARITY: f64 = 0.51;

/// Stiffness C (N/m) and hardening k of the curve S = C (E + k E^3) that reaches 500 gf/cm at an
/// extension (%) with a linearity LT.
///
/// LT is the area under the curve over that of the triangle, so with e the extension
/// LT = (1 + k e^2 / 2) / (1 + k e^2) and k = (1 - LT) / ((LT - 1/2) e^2); the difference between
/// extension and Green strain is neglected in LT (at 6 % of extension it comes out 0.02 low), not in
/// C: the force is (1 + e) S.
pub const fn tensile_curve(extension: f64, linearity: f64) -> (f64, f64) {
    let e = extension * 1e-2;
    let lt = linearity.clamp(MIN_LINEARITY, 1.0);
    let k = (1.0 - lt) / ((lt - 0.5) * e * e);
    let green = e + 0.5 * e * e;
    let stress = KES_LOAD / (1.0 + e);
    (stress / (green * (1.0 + k * green * green)), k)
}

/// Bending stiffness (N m) from a bending length (m) (Peirce 1930): B = rho g c^3.
pub const fn bending_of_length(density: f64, bending_length: f64) -> f64 {
    density * GRAVITY * (bending_length * bending_length * bending_length)
}

/// Bending stiffness (N m) of a strip whose overhang (m) sinks to an angle (rad) below the level,
/// measured from the edge to the tip (ASTM D1388 at 41.5 degrees).
///
/// Exact for the heavy elastica, theta'' = -Gamma (1 - s) cos theta. Measured from the tip in
/// t = Gamma^(1/3) (1 - s) it is theta_tt = -t cos theta with theta_t = 0 at the tip, so one
/// integration from a tip angle to where the strip is level gives Gamma = t^3 and the angle.
/// (Peirce's own formula is 5.8 % too high at 41.5 degrees; the usual (l/2)^3 there is right.)
/// None unless all three are positive and the angle is below 85 degrees.
pub fn bending_of_overhang(density: f64, overhang: f64, angle: f64) -> Option<f64> {
    let largest = 85.0 * PI / 180.0;
    if !(density > 0.0 && overhang > 0.0 && angle > 0.0 && angle < largest) {
        return None;
    }
    let (mut low, mut high) = (0.0, 0.5 * PI - 1e-9);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if elastica(middle).1 < angle {
            low = middle;
        } else {
            high = middle;
        }
    }
    let gamma = elastica(0.5 * (low + high)).0;
    Some(density * GRAVITY * overhang.powi(3) / gamma)
}

/// Gamma and the angle from edge to tip for a tip angle, by Runge-Kutta 4.
fn elastica(tip: f64) -> (f64, f64) {
    const STEP: f64 = 2e-3;
    let slope =
        |t: f64, [theta, turn, _, _]: [f64; 4]| [turn, -t * theta.cos(), theta.cos(), theta.sin()];
    let add = |a: [f64; 4], b: [f64; 4], h: f64| [0, 1, 2, 3].map(|k| a[k] + h * b[k]);
    let (mut t, mut y) = (0.0, [tip, 0.0, 0.0, 0.0]);
    // A strip nearly vertical at its tip is level after t = 15 at the latest (Gamma 3000).
    while t < 40.0 {
        let a = slope(t, y);
        let b = slope(t + 0.5 * STEP, add(y, a, 0.5 * STEP));
        let c = slope(t + 0.5 * STEP, add(y, b, 0.5 * STEP));
        let d = slope(t + STEP, add(y, c, STEP));
        let rate = [0, 1, 2, 3].map(|k| (a[k] + 2.0 * (b[k] + c[k]) + d[k]) / 6.0);
        let next = add(y, rate, STEP);
        if next[0] <= 0.0 {
            let share = y[0] / (y[0] - next[0]);
            let end = add(y, rate, STEP * share);
            t += STEP * share;
            return (t.powi(3), end[3].atan2(end[2]));
        }
        (t, y) = (t + STEP, next);
    }
    (t.powi(3), y[3].atan2(y[2]))
}

/// Cusick's drape coefficient (%) (BS 5058, ISO 9073-9): the share of the overhanging ring that the
/// draped specimen's shadow still covers. Areas in one unit; radii in its root.
pub fn drape_coefficient(shadow_area: f64, specimen_radius: f64, disc_radius: f64) -> f64 {
    let disc = PI * disc_radius * disc_radius;
    100.0 * (shadow_area - disc) / (PI * specimen_radius * specimen_radius - disc)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_converted() {
        assert!((bending(1.0) - 98.0665e-6).abs() < 1e-15);
        assert!((shear(1.0) - 56.19).abs() < 0.01);
        assert!((KES_LOAD - 490.3325).abs() < 1e-9);
        assert!((weight(26.35) - 0.2635).abs() < 1e-12);
    }

    #[test]
    fn an_overhang_gives_the_stiffness_of_the_elastica() {
        // Gamma = 8.0042 at 41.5 degrees; 10 at atan(1.066802), 1 at atan(0.124562).
        for (angle, gamma) in [
            (41.5f64.to_radians(), 8.0042),
            (1.066802f64.atan(), 10.0),
            (0.124562f64.atan(), 1.0),
            (5.888105f64.atan(), 100.0),
        ] {
            let got = bending_of_overhang(0.2, 0.1, angle).unwrap();
            let expected = 0.2 * GRAVITY * 1e-3 / gamma;
            assert!(
                (got / expected - 1.0).abs() < 1e-4,
                "{gamma}: {got} {expected}"
            );
        }
        assert!(bending_of_overhang(0.2, 0.1, f64::NAN).is_none());
        assert!(bending_of_overhang(0.2, 0.1, 1.55).is_none());
        assert!(
            (bending_of_length(0.2, 0.05) / (0.2 * GRAVITY * 0.1f64.powi(3) / 8.0) - 1.0).abs()
                < 1e-12
        );
    }

    #[test]
    fn a_flat_specimen_has_a_drape_coefficient_of_100() {
        assert!((drape_coefficient(PI * 0.15 * 0.15, 0.15, 0.09) - 100.0).abs() < 1e-9);
        assert!(drape_coefficient(PI * 0.09 * 0.09, 0.15, 0.09).abs() < 1e-9);
    }
}
