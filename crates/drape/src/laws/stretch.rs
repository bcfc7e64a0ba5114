//! The stress-strain law of a membrane: stress and energy as functions of Green strain.
//!
//! With E = (E_uu, E_vv, gamma), gamma = 2 E_uv, the energy per area is
//!
//! W = 1/2 (C11 E_uu^2 + C22 E_vv^2 + 2 C12 E_uu E_vv + G gamma^2)
//!   + 1/4 (C11 k_u <E_uu>^4 + C22 k_v <E_vv>^4) + W_limit(E_uu) + W_limit(E_vv),
//!
//! where `<x>` = max(x, 0): along a thread S = C (E + k E^3), the J-shaped curve of a woven cloth, whose yarns lose
//! their crimp before they stretch.
//!
//! The strain limit adds K r(E - L) to the stress, with L the limit as Green strain, K = 100 C, r(x) = 0 below zero,
//! x^2 / (2 d) up to d = L / 50, then x - d / 2. Energy and stress are smooth, the stiffness is continuous and bounded,
//! so a cloth may start far beyond its limit. At twice the load that reaches the limit, the strain exceeds the limit by
//! 2 %.
//!
//! In a tension field the first line is replaced by the least energy over all finer wrinkles (Pipkin
//! 1986): min over A >= 0 of W(E + A), whose dual is max over stresses S >= 0 of
//! S : E - 1/2 S : C^-1 : S. The membrane is taut where C E is tensile in every direction, and slack, without energy,
//! where E shortens every direction. Otherwise it is wrinkled: one tension T along the direction t that maximises
//! (t.E.t)^2 / (2 q(t)), q(t) = t t : C^-1 : t t, T = t.E.t / q. The stress is never
//! compressive and the energy is convex, so its Hessian is exact and positive semidefinite.
//!
//! # Decided with
//! - [`crate::materials::Materials::law`], [`crate::incremental_potential::IncrementalLaw`]: who holds the
//!   law, made from the figures of a material; the law with viscosity and kept strain;
//! - [`crate::xpbd`] (`membrane.rs`): the law in single precision, for XPBD;
//! - [`crate::features::Feature`]: a kind of law as a feature;
//! - [`crate::methods`] (`newton_solver.rs`, `is_stiff`), [`crate::sew::SewRun::new`],
//!   [`crate::kinetic_damping`] (`substep`), crate `reference` (`metric.rs`): know the linear stiffness
//!   alone;
//! - crate `reference` (`patches/`: `is_plain`, `membrane.rs`, `EdgeMembrane`, `limits.rs`): patches know linear laws
//!   alone.
//!
//! By hand: cases in `reference/tests/suite/features.rs`, recorded states in `lab/tests/recorded/states.rs`, a strip in
//! `lab/src/laws/strain.rs`, pages `docs/methods/laws.md` and `docs/FORMATS.md`.

use crate::Compression;
use std::sync::LazyLock;

/// Stiffness of a strain limit as a multiple of the membrane's own.
const LIMIT_STIFFNESS: f64 = 100.0;

/// Range of strain in which the stiffness of a limit rises, as a share of the limit.
const LIMIT_ONSET: f64 = 0.02;

/// Stress and energy as functions of Green strain (E_uu, E_vv, gamma). Implemented by [`MembraneLaw`] and by its
/// form over a step; materials hold a [`MembraneLaw`], so another law is a part of it.
pub trait StrainLaw {
    /// Stress S_uu, S_vv, S_uv (N/m) and energy per area (J/m2).
    fn stress(&self, strain: [f64; 3]) -> ([f64; 3], f64);

    /// Derivative of the stress with respect to the strain, a symmetric positive semidefinite matrix given as
    /// uu-uu, vv-vv, uu-vv, gamma-gamma, uu-gamma, vv-gamma (N/m).
    fn slope(&self, strain: [f64; 3]) -> [f64; 6];
}

/// The law of a membrane in stretch and shear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MembraneLaw {
    /// C11, C22, C12 and the shear stiffness G (N/m).
    pub stiffness: [f64; 4],
    /// The number k along warp and weft: S = C (E + k E^3) in tension; 0 is a linear law.
    pub hardening: [f64; 2],
    /// Limit of the stretch of warp and weft, as a share of the rest length; infinite for none.
    pub limit: [f64; 2],
    /// Behaviour under compression.
    pub compression: Compression,
}

impl MembraneLaw {
    /// A linear law; `stiffness` is C11, C22, C12, G (N/m).
    pub fn linear(stiffness: [f64; 4]) -> Self {
        Self {
            stiffness,
            hardening: [0.0; 2],
            limit: [f64::INFINITY; 2],
            compression: Compression::Full,
        }
    }

    /// Whether the law is linear, so that XPBD and explicit steps in patches use `stiffness` only.
    #[inline]
    pub fn is_linear(&self) -> bool {
        let &Self {
            stiffness: _,
            hardening,
            limit,
            compression,
        } = self;
        hardening == [0.0; 2] && limit == [f64::INFINITY; 2] && compression == Compression::Full
    }

    /// Contribution of hardening and limit along one direction: stress (N/m), energy (J/m2) and stiffness (N/m).
    #[inline]
    fn beyond_line(&self, direction: usize, strain: f64) -> (f64, f64, f64) {
        let c = self.stiffness[direction];
        let e = strain.max(0.0);
        let k = c * self.hardening[direction];
        let (mut stress, mut energy, mut slope) =
            (k * e * e * e, 0.25 * k * e * e * e * e, 3.0 * k * e * e);
        let stretch = self.limit[direction];
        if stretch.is_finite() {
            let limit = stretch + 0.5 * stretch * stretch;
            let (x, d) = (strain - limit, LIMIT_ONSET * limit);
            let stiff = LIMIT_STIFFNESS * c;
            if x >= d {
                stress += stiff * (x - 0.5 * d);
                energy += stiff * (0.5 * x * (x - d) + d * d / 6.0);
                slope += stiff;
            } else if x > 0.0 {
                stress += stiff * x * x / (2.0 * d);
                energy += stiff * x * x * x / (6.0 * d);
                slope += stiff * x / d;
            }
        }
        (stress, energy, slope)
    }
}

impl StrainLaw for MembraneLaw {
    #[inline]
    fn stress(&self, strain: [f64; 3]) -> ([f64; 3], f64) {
        let [c11, c22, c12, g] = self.stiffness;
        let [e_uu, e_vv, gamma] = strain;
        let mut s = [c11 * e_uu + c12 * e_vv, c22 * e_vv + c12 * e_uu, g * gamma];
        let mut energy = 0.5 * (s[0] * e_uu + s[1] * e_vv + s[2] * gamma);
        if !self.is_linear() {
            if self.compression == Compression::TensionField {
                match Field::of(self.stiffness, strain, s) {
                    Field::Taut => {}
                    Field::Slack => (s, energy) = ([0.0; 3], 0.0),
                    Field::Wrinkled(wrinkle) => {
                        s = wrinkle.along.map(|m| wrinkle.tension * m);
                        energy = 0.5 * wrinkle.tension * wrinkle.tension * wrinkle.compliance;
                    }
                }
            }
            for direction in 0..2 {
                let (stress, part, _) = self.beyond_line(direction, strain[direction]);
                s[direction] += stress;
                energy += part;
            }
        }
        (s, energy)
    }

    #[inline]
    fn slope(&self, strain: [f64; 3]) -> [f64; 6] {
        let [c11, c22, c12, g] = self.stiffness;
        let mut slope = [c11, c22, c12, g, 0.0, 0.0];
        if !self.is_linear() {
            if self.compression == Compression::TensionField {
                let [e_uu, e_vv, gamma] = strain;
                let s = [c11 * e_uu + c12 * e_vv, c22 * e_vv + c12 * e_uu, g * gamma];
                match Field::of(self.stiffness, strain, s) {
                    Field::Taut => {}
                    Field::Slack => slope = [0.0; 6],
                    Field::Wrinkled(wrinkle) => slope = wrinkle.slope(),
                }
            }
            for direction in 0..2 {
                slope[direction] += self.beyond_line(direction, strain[direction]).2;
            }
        }
        slope
    }
}

/// State of a tension field.
enum Field {
    Taut,
    Slack,
    Wrinkled(Wrinkle),
}

/// A wrinkled state: one tension along a direction t.
struct Wrinkle {
    /// T (N/m).
    tension: f64,
    /// t t as (uu, vv, uv).
    along: [f64; 3],
    /// Compliance q = t t : C^-1 : t t (m/N).
    compliance: f64,
    /// dT/dtheta m + T dm/dtheta, and minus the second derivative of the energy by theta.
    turn: ([f64; 3], f64),
}

/// Number of directions sampled before the best is refined; between two of them q has one extremum at most
/// unless warp and bias differ by more than a factor of 10^4.
const DIRECTIONS: usize = 32;

/// Angle between sampled directions.
const WIDTH: f64 = std::f64::consts::PI / DIRECTIONS as f64;

/// Sine and cosine of twice each angle.
static DOUBLED: LazyLock<[(f64, f64); DIRECTIONS]> =
    LazyLock::new(|| std::array::from_fn(|k| (2.0 * k as f64 * WIDTH).sin_cos()));

/// Most Newton and bisection steps of the refinement: 60 halvings reach rounding.
const REFINEMENTS: usize = 60;

/// Step of the refinement below which it ends (rad): rounding is a few times smaller.
const CLOSE: f64 = 1e-15;

impl Field {
    fn of(stiffness: [f64; 4], [e_uu, e_vv, gamma]: [f64; 3], s: [f64; 3]) -> Self {
        if s[0] + s[1] >= 0.0 && s[0] * s[1] >= s[2] * s[2] {
            return Self::Taut;
        }
        if e_uu + e_vv <= 0.0 && e_uu * e_vv >= 0.25 * gamma * gamma {
            return Self::Slack;
        }
        let [c11, c22, c12, g] = stiffness;
        let determinant = c11 * c22 - c12 * c12;
        let (s11, s22, s12, sg) = (
            c22 / determinant,
            c11 / determinant,
            -c12 / determinant,
            1.0 / g,
        );
        let a0 = (3.0 * (s11 + s22) + 2.0 * s12 + sg) / 8.0;
        let a2 = 0.5 * (s11 - s22);
        let a4 = (s11 + s22 - 2.0 * s12 - sg) / 8.0;
        let (mean, half) = (0.5 * (e_uu + e_vv), 0.5 * (e_uu - e_vv));
        // p = t.E.t and q with their first two derivatives with respect to the angle.
        let doubled = |(sin, cos): (f64, f64)| {
            let (sin2, cos2) = (2.0 * sin * cos, cos * cos - sin * sin);
            let p = [
                mean + half * cos + 0.5 * gamma * sin,
                gamma * cos - 2.0 * half * sin,
                -4.0 * half * cos - 2.0 * gamma * sin,
            ];
            let q = [
                a0 + a2 * cos + a4 * cos2,
                -2.0 * a2 * sin - 4.0 * a4 * sin2,
                -4.0 * a2 * cos - 16.0 * a4 * cos2,
            ];
            (p, q)
        };
        let at = |angle: f64| doubled((2.0 * angle).sin_cos());
        let mut best = (f64::NEG_INFINITY, 0.0);
        for (k, &direction) in DOUBLED.iter().enumerate() {
            let (p, q) = doubled(direction);
            let value = p[0].max(0.0).powi(2) / q[0];
            if value > best.0 {
                best = (value, k as f64 * WIDTH);
            }
        }
        if best.0.is_nan() || best.0 <= 0.0 {
            return Self::Slack;
        }
        // d(p^2/q) = p (2 p' q - p q') / q^2 falls through zero at the best angle.
        let (mut low, mut high) = (best.1 - WIDTH, best.1 + WIDTH);
        let mut angle = best.1;
        for _ in 0..REFINEMENTS {
            let (p, q) = at(angle);
            let rise = 2.0 * p[1] * q[0] - p[0] * q[1];
            let slope = 2.0 * p[2] * q[0] + p[1] * q[1] - p[0] * q[2];
            if rise > 0.0 {
                low = angle;
            } else {
                high = angle;
            }
            let newton = angle - rise / slope;
            let next = if slope < 0.0 && newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            let done = (next - angle).abs() <= CLOSE;
            angle = next;
            if done {
                break;
            }
        }
        let (p, q) = at(angle);
        let (sin, cos) = angle.sin_cos();
        let tension = (p[0] / q[0]).max(0.0);
        let turning = -p[1] / q[0];
        let along = [cos * cos, sin * sin, sin * cos];
        let turned = [-2.0 * sin * cos, 2.0 * sin * cos, cos * cos - sin * sin];
        // The second derivative by theta of p^2 / (2 q) where the first is zero.
        let bend = turning * p[1] + tension * p[2]
            - tension * turning * q[1]
            - 0.5 * tension * tension * q[2];
        Self::Wrinkled(Wrinkle {
            tension,
            along,
            compliance: q[0],
            turn: (
                [0, 1, 2].map(|k| turning * along[k] + tension * turned[k]),
                -bend,
            ),
        })
    }
}

impl Wrinkle {
    /// dS/dE = m m / q + s s / (-d2W/dtheta2), s the change of stress as t turns.
    fn slope(&self) -> [f64; 6] {
        let (m, (s, b)) = (self.along, self.turn);
        let soft = if b > 0.0 { 1.0 / b } else { 0.0 };
        [(0, 0), (1, 1), (0, 1), (2, 2), (0, 2), (1, 2)]
            .map(|(i, j)| m[i] * m[j] / self.compliance + s[i] * s[j] * soft)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;
    use proptest::prelude::*;

    fn laws() -> Vec<MembraneLaw> {
        let plain = MembraneLaw::linear([700.0, 450.0, 120.0, 60.0]);
        let hard = MembraneLaw {
            hardening: [300.0, 90.0],
            ..plain
        };
        let limited = MembraneLaw {
            limit: [0.03, 0.1],
            ..hard
        };
        let field = |law: MembraneLaw| MembraneLaw {
            compression: Compression::TensionField,
            ..law
        };
        vec![plain, hard, limited, field(plain), field(limited)]
    }

    fn full([a, b, c, d, e, f]: [f64; 6]) -> Matrix3<f64> {
        Matrix3::new(a, c, e, c, b, f, e, f, d)
    }

    proptest! {
        #[test]
        fn stress_is_the_slope_of_the_energy_and_slope_that_of_the_stress(
            strain in prop::array::uniform3(-0.6f64..0.6), which in 0usize..5,
        ) {
            let law = laws()[which];
            let (stress, energy) = law.stress(strain);
            let slope = full(law.slope(strain));
            prop_assert!(energy >= 0.0);
            prop_assert!(slope.symmetric_eigenvalues().min() >= -1e-6 * slope.norm());
            let step = 1e-6;
            for k in 0..3 {
                let (mut up, mut down) = (strain, strain);
                up[k] += step;
                down[k] -= step;
                let (high, low) = (law.stress(up), law.stress(down));
                let got = (high.1 - low.1) / (2.0 * step);
                prop_assert!((got - stress[k]).abs() < 1e-4 * (1.0 + stress[k].abs()), "{} {}", got, stress[k]);
                // Slopes jump where taut meets wrinkled and where a limit sets in.
                let smooth = full(law.slope(up)) - full(law.slope(down));
                if smooth.norm() < 0.01 * slope.norm() {
                    for i in 0..3 {
                        let got = (high.0[i] - low.0[i]) / (2.0 * step);
                        prop_assert!((got - slope[(i, k)]).abs() < 0.02 * slope.norm() + 1e-3);
                    }
                }
            }
        }

        #[test]
        fn a_tension_field_never_pushes_and_is_the_least_energy_over_wrinkles(
            strain in prop::array::uniform3(-0.3f64..0.3),
            wrinkle in prop::array::uniform3(-0.5f64..0.5),
        ) {
            let plain = laws()[0];
            let field = laws()[3];
            let (s, energy) = field.stress(strain);
            prop_assert!(s[0] + s[1] >= -1e-9 && s[0] * s[1] - s[2] * s[2] >= -1e-6);
            // Any wrinkle strain w w^T, here of rank one or two, costs at least as much.
            let [a, b, c] = wrinkle;
            let over = [
                strain[0] + a * a + c * c,
                strain[1] + b * b,
                strain[2] + 2.0 * a * b,
            ];
            prop_assert!(energy <= plain.stress(over).1 + 1e-9);
            prop_assert!(energy <= plain.stress(strain).1 + 1e-12);
        }
    }

    #[test]
    fn a_limit_is_as_soft_as_it_says() {
        let c = 1000.0;
        let law = MembraneLaw {
            limit: [0.05, f64::INFINITY],
            ..MembraneLaw::linear([c, c, 0.0, 100.0])
        };
        let limit = 0.05 + 0.5 * 0.05 * 0.05;
        // Bisection for the strain at twice the stress of the limit.
        let (mut low, mut high) = (limit, 2.0 * limit);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if law.stress([middle, 0.0, 0.0]).0[0] < 2.0 * c * limit {
                low = middle;
            } else {
                high = middle;
            }
        }
        assert!((low / limit - 1.02).abs() < 2e-3, "{}", low / limit);
        let (stress, energy) = law.stress([40.0, 0.0, 0.0]);
        assert!(stress[0].is_finite() && energy.is_finite());
        assert!(law.slope([40.0, 0.0, 0.0])[0] < 102.0 * c);
    }
}
