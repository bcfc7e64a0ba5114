//! The linear membrane in terms of a triangle's edges: the form that takes few operations.

use super::Lane;
use crate::laws::membrane::MembraneElement;

/// The membrane of one triangle in terms of its edges d1 = x1 - x0, d2 = x2 - x0: with
/// q = (d1.d1, d2.d2, 2 d1.d2) less their values at rest, Green strain is linear in q, so the
/// energy is q.Kq / 4 with a constant 3x3 K, and with s = Kq the gradients by x1 and x2 are
/// s0 d1 + s2 d2 and s1 d2 + s2 d1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeMembrane {
    /// Rest values of d1.d1, d2.d2, 2 d1.d2 [m2].
    rest: [f64; 3],
    /// K: 00, 11, 22, 01, 02, 12 [N/m3].
    stiffness: [f64; 6],
}

impl EdgeMembrane {
    /// From a linear law `[C11, C22, C12, G]` [N/m].
    pub fn new(element: &MembraneElement, law: [f64; 4]) -> Self {
        let [_, w1, w2] = element.warp;
        let [_, z1, z2] = element.weft;
        let [_, d1, d2] = element.rest();
        // Rows: E_uu, E_vv, gamma by q.
        let strain = [
            [0.5 * w1 * w1, 0.5 * w2 * w2, 0.5 * w1 * w2],
            [0.5 * z1 * z1, 0.5 * z2 * z2, 0.5 * z1 * z2],
            [w1 * z1, w2 * z2, 0.5 * (w1 * z2 + w2 * z1)],
        ];
        let [c11, c22, c12, g] = law;
        let entry = |i: usize, j: usize| {
            let [u, v, s] = strain;
            2.0 * element.area
                * (c11 * u[i] * u[j]
                    + c22 * v[i] * v[j]
                    + c12 * (u[i] * v[j] + v[i] * u[j])
                    + g * s[i] * s[j])
        };
        Self {
            rest: [d1.norm_squared(), d2.norm_squared(), 2.0 * d1.dot(&d2)],
            stiffness: [
                entry(0, 0),
                entry(1, 1),
                entry(2, 2),
                entry(0, 1),
                entry(0, 2),
                entry(1, 2),
            ],
        }
    }

    /// Its numbers, bit by bit.
    pub fn bits(&self) -> [u64; 9] {
        let ([a, b, c], [d, e, f, g, h, i]) = (self.rest, self.stiffness);
        [a, b, c, d, e, f, g, h, i].map(f64::to_bits)
    }

    #[inline(always)]
    fn strain_and_slope(&self, [d1, d2]: [Lane; 2]) -> [[f64; 3]; 2] {
        let q = [
            d1.dot(d1) - self.rest[0],
            d2.dot(d2) - self.rest[1],
            2.0f64.mul_add(d1.dot(d2), -self.rest[2]),
        ];
        let k = &self.stiffness;
        let s = [
            k[0].mul_add(q[0], k[3].mul_add(q[1], k[4] * q[2])),
            k[3].mul_add(q[0], k[1].mul_add(q[1], k[5] * q[2])),
            k[4].mul_add(q[0], k[5].mul_add(q[1], k[2] * q[2])),
        ];
        [q, s]
    }

    /// The gradient of its energy by the corners 1 and 2 [N], from the edges to them; that by
    /// corner 0 is minus their sum.
    #[inline(always)]
    pub fn gradient(&self, [d1, d2]: [Lane; 2]) -> [Lane; 2] {
        let [_, s] = self.strain_and_slope([d1, d2]);
        [
            d1.scaled(s[0]).add_scaled(d2, s[2]),
            d2.scaled(s[1]).add_scaled(d1, s[2]),
        ]
    }

    /// Its energy [J].
    #[inline(always)]
    pub fn energy(&self, edges: [Lane; 2]) -> f64 {
        let [q, s] = self.strain_and_slope(edges);
        0.25 * (q[0] * s[0] + q[1] * s[1] + q[2] * s[2])
    }

    /// Largest and smallest principal squared stretch: eigenvalues of the present metric by the
    /// one at rest. A triangle folded onto a line counts too: warp and weft then pull the same
    /// way, and the square is up to 2.
    #[inline(always)]
    pub fn squared_stretch(&self, [d1, d2]: [Lane; 2]) -> [f64; 2] {
        let (c11, c22, c12) = (d1.dot(d1), d2.dot(d2), d1.dot(d2));
        let [r11, r22, r12] = [self.rest[0], self.rest[1], 0.5 * self.rest[2]];
        let rest = r11 * r22 - r12 * r12;
        let half = 0.5 * (c11 * r22 + c22 * r11 - 2.0 * c12 * r12) / rest;
        let product = (c11 * c22 - c12 * c12) / rest;
        let root = (half * half - product).max(0.0).sqrt();
        [half + root, half - root]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::stretch::MembraneLaw;
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
        let edges = [1, 2].map(|k| Lane::from(x[k] - x[0]));
        let got = membrane.gradient(edges);
        let (energy, expected) = element.gradient(&MembraneLaw::linear(law), x);
        for (got, expected) in got.iter().zip(&expected[1..]) {
            assert!((Vec3::from(*got) - expected).norm() < 1e-12);
        }
        assert!((membrane.energy(edges) - energy).abs() < 1e-12 * energy);
    }

    #[test]
    fn principal_stretch_is_that_of_the_deformation() {
        let rest = [
            Vec2::zeros(),
            Vec2::new(0.02, 0.001),
            Vec2::new(0.004, 0.017),
        ];
        let element = MembraneElement::new(rest).expect("has area");
        let membrane = EdgeMembrane::new(&element, [1.0, 1.0, 0.0, 1.0]);
        let drawn = [1, 2].map(|k| Lane::from(Vec3::new(1.3 * rest[k].x, 0.0, 0.8 * rest[k].y)));
        let [high, low] = membrane.squared_stretch(drawn);
        assert!(
            (high - 1.69).abs() < 1e-9 && (low - 0.64).abs() < 1e-9,
            "{high} {low}"
        );
    }
}
