//! The stress-strain law of a membrane: stress and energy as functions of Green strain.
//!
//! With E = (E_uu, E_vv, gamma), gamma = 2 E_uv, the energy per area is
//!
//! W = 1/2 (C11 E_uu^2 + C22 E_vv^2 + 2 C12 E_uu E_vv + G gamma^2)
//!   + 1/4 (C11 k_u <E_uu>^4 + C22 k_v <E_vv>^4) + W_limit(E_uu) + W_limit(E_vv),
//!
//! where `<x>` is x above zero and zero below: along a thread S = C (E + k E^3), the J-shaped curve
//! of a woven cloth whose crimp is pulled out before its yarns are.
//!
//! The strain limit adds K r(E - L) to the stress, with L the limit as Green strain, K = 100 C,
//! r(x) = 0 below zero, x^2 / (2 d) up to d = L / 50, then x - d / 2. Energy and stress are smooth,
//! the stiffness is continuous and bounded, so a cloth may start far beyond its limit. How soft it
//! is: at twice the load that reaches the limit, the strain is beyond it by 2 % of itself.

/// Stiffness of a strain limit as a multiple of the membrane's own.
const LIMIT_STIFFNESS: f64 = 100.0;

/// Width over which a strain limit sets in, as a share of the limit.
const LIMIT_ONSET: f64 = 0.02;

/// What a cloth does when it is squeezed in its own plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// It resists as much as it does stretch. The Hessian drops its compressive part.
    #[default]
    Full,
    /// It buckles finer than the mesh can show and carries nothing: the tension field.
    TensionField,
}

/// How a membrane resists stretch and shear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MembraneLaw {
    /// C11, C22, C12 and the shear stiffness G [N/m].
    pub stiffness: [f64; 4],
    /// k along warp and weft: S = C (E + k E^3) in tension; 0 is a straight line.
    pub hardening: [f64; 2],
    /// Stretch (share of the length at rest) that warp and weft hardly exceed; infinite for none.
    pub limit: [f64; 2],
    /// What it does when squeezed.
    pub compression: Compression,
}

impl MembraneLaw {
    /// A straight-line law; `stiffness` is C11, C22, C12, G [N/m].
    pub fn linear(stiffness: [f64; 4]) -> Self {
        Self {
            stiffness,
            hardening: [0.0; 2],
            limit: [f64::INFINITY; 2],
            compression: Compression::Full,
        }
    }

    /// Whether the law is the straight line alone: then `stiffness` says all.
    pub fn is_linear(&self) -> bool {
        self.hardening == [0.0; 2]
            && self.limit == [f64::INFINITY; 2]
            && self.compression == Compression::Full
    }

    /// Stress S_uu, S_vv, S_uv [N/m] and energy per area [J/m2] at a Green strain
    /// E_uu, E_vv, gamma.
    #[inline]
    pub fn stress(&self, strain: [f64; 3]) -> ([f64; 3], f64) {
        let [c11, c22, c12, g] = self.stiffness;
        let [e_uu, e_vv, gamma] = strain;
        let mut s = [c11 * e_uu + c12 * e_vv, c22 * e_vv + c12 * e_uu, g * gamma];
        let mut energy = 0.5 * (s[0] * e_uu + s[1] * e_vv + s[2] * gamma);
        if !self.is_linear() {
            for direction in 0..2 {
                let (stress, part, _) = self.beyond_line(direction, strain[direction]);
                s[direction] += stress;
                energy += part;
            }
        }
        (s, energy)
    }

    /// Slope of the stress by the strain, a symmetric positive semidefinite matrix given as
    /// uu-uu, vv-vv, uu-vv, gamma-gamma, uu-gamma, vv-gamma [N/m].
    #[inline]
    pub fn slope(&self, strain: [f64; 3]) -> [f64; 6] {
        let [c11, c22, c12, g] = self.stiffness;
        let mut slope = [c11, c22, c12, g, 0.0, 0.0];
        if !self.is_linear() {
            for direction in 0..2 {
                slope[direction] += self.beyond_line(direction, strain[direction]).2;
            }
        }
        slope
    }

    /// What hardening and limit add along one direction: stress [N/m], energy [J/m2] and slope
    /// [N/m].
    fn beyond_line(&self, direction: usize, strain: f64) -> (f64, f64, f64) {
        let c = self.stiffness[direction];
        let e = strain.max(0.0);
        let k = c * self.hardening[direction];
        let (mut stress, mut energy, mut slope) =
            (k * e * e * e, 0.25 * k * e * e * e * e, 3.0 * k * e * e);
        let most = self.limit[direction];
        if most.is_finite() {
            let limit = most + 0.5 * most * most;
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
