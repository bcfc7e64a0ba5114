//! The linear membrane in terms of the squared lengths of a triangle's edges.

use toile_drape::laws::membrane::MembraneElement;

/// The membrane of one triangle by its edges x1 - x0, x2 - x0 and x2 - x1: with q their squared
/// lengths less those at rest, Green strain is linear in q, so the energy is q.Kq / 4 with a
/// constant 3x3 matrix K, and t = Kq are tensions: an edge from a to b adds t (b - a) to the gradient at b
/// and the opposite at a.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeMembrane {
    /// Squared lengths at rest (m2).
    pub rest: [f64; 3],
    /// K (N/m3).
    pub stiffness: [[f64; 3]; 3],
    /// Coefficients of the principal stretches: three weights of q (1/m2) and the inverse of four times
    /// the squared area (1/m4).
    pub shape: [f64; 4],
}

impl EdgeMembrane {
    /// From a linear law `[C11, C22, C12, G]` (N/m).
    pub fn new(element: &MembraneElement, law: [f64; 4]) -> Self {
        let [_, w1, w2] = element.warp;
        let [_, z1, z2] = element.weft;
        let [_, d1, d2] = element.rest();
        // Derivatives of E_uu, E_vv, gamma by q; 2 d1.d2 is the sum of the first two less the third.
        let mixed = 0.5 * (w1 * z2 + w2 * z1);
        let u = [0.5 * w1 * (w1 + w2), 0.5 * w2 * (w1 + w2), -0.5 * w1 * w2];
        let v = [0.5 * z1 * (z1 + z2), 0.5 * z2 * (z1 + z2), -0.5 * z1 * z2];
        let s = [w1 * z1 + mixed, w2 * z2 + mixed, -mixed];
        let [c11, c22, c12, g] = law;
        let entry = |i: usize, j: usize| {
            2.0 * element.area
                * (c11 * u[i] * u[j]
                    + c22 * v[i] * v[j]
                    + c12 * (u[i] * v[j] + v[i] * u[j])
                    + g * s[i] * s[j])
        };
        let (r11, r22, r12) = (d1.norm_squared(), d2.norm_squared(), d1.dot(&d2));
        let inverse = 1.0 / (r11 * r22 - r12 * r12);
        let half = 0.5 * inverse;
        Self {
            rest: [r11, r22, (d2 - d1).norm_squared()],
            stiffness: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))),
            shape: [half * (r22 - r12), half * (r11 - r12), half * r12, inverse],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_drape::laws::stretch::MembraneLaw;
    use toile_geometry::{Vec2, Vec3};

    #[test]
    fn the_membrane_in_edges_is_the_membrane_in_tangents() {
        let rest = [
            Vec2::new(0.1, 0.2),
            Vec2::new(0.12, 0.203),
            Vec2::new(0.104, 0.217),
        ];
        let element = MembraneElement::new(rest).expect("has area");
        let law = [700.0, 450.0, 120.0, 60.0];
        let membrane = EdgeMembrane::new(&element, law);
        let x = [
            Vec3::new(0.001, 0.0, 0.002),
            Vec3::new(0.019, 0.004, -0.003),
            Vec3::new(0.005, 0.016, 0.006),
        ];
        let edges = [x[1] - x[0], x[2] - x[0], x[2] - x[1]];
        let q = [0, 1, 2].map(|k| edges[k].norm_squared() - membrane.rest[k]);
        let k = membrane.stiffness;
        let t = k.map(|row| row[0] * q[0] + row[1] * q[1] + row[2] * q[2]);
        let got = [
            edges[0] * -t[0] - edges[1] * t[1],
            edges[0] * t[0] - edges[2] * t[2],
            edges[1] * t[1] + edges[2] * t[2],
        ];
        let (energy, expected) = element.gradient(&MembraneLaw::linear(law), x);
        for (got, expected) in got.iter().zip(&expected) {
            assert!((got - expected).norm() < 1e-12);
        }
        let sum = 0.25 * (q[0] * t[0] + q[1] * t[1] + q[2] * t[2]);
        assert!((sum - energy).abs() < 1e-12 * energy);
    }
}
