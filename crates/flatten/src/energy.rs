//! Energy of the fabric of a flat panel on its surface, as a function of the flat shape.
//!
//! A triangle with sides D in the panel and d on the surface is deformed by F = d D^-1. With E = (F^T F - 1) / 2 and the
//! fabric's law, S and W by E, the energy is the sum of A W, A = det D / 2, and its gradient by D is
//! A (W 1 - F^T F S) D^-T, the force of a configuration (Eshelby 1951). The warp runs along y.

use crate::Region;
use nalgebra::Matrix2;
use toile_drape::Compression;
use toile_drape::laws::stretch::{MembraneLaw, StrainLaw};
use toile_geometry::Vec2;

/// The energy of a surface's panel.
pub struct RestEnergy<'a> {
    region: &'a Region,
    law: MembraneLaw,
}

impl<'a> RestEnergy<'a> {
    /// The energy with the law of a fabric. It resists compression in full: slack cloth of a tension field takes no
    /// energy, so that a larger panel would cost nothing.
    pub fn new(region: &'a Region, law: MembraneLaw) -> Self {
        let compression = Compression::Full;
        let law = MembraneLaw { compression, ..law };
        Self { region, law }
    }

    /// The surface.
    pub fn region(&self) -> &'a Region {
        self.region
    }

    /// The law.
    pub fn law(&self) -> &MembraneLaw {
        &self.law
    }

    /// Energy (J) and gradient (N); none where a triangle is flipped or without area.
    pub fn gradient(&self, flat: &[Vec2], gradient: &mut [Vec2]) -> Option<f64> {
        gradient.iter_mut().for_each(|g| *g = Vec2::zeros());
        let mut energy = 0.0;
        for (triangle, corners) in self.region.mesh().triangles.iter().zip(self.region.flat()) {
            let [a, b, c] = triangle.map(|v| v as usize);
            let rest = Sides::new([flat[a], flat[b], flat[c]])?;
            let right = right_strain(corners, &rest);
            let (stress, density) = self.stress(&right);
            let by_sides = (Matrix2::identity() * density - right * stress)
                * rest.inverse.transpose()
                * rest.area;
            let (first, second) = (by_sides.column(0), by_sides.column(1));
            gradient[b] += first;
            gradient[c] += second;
            gradient[a] -= first + second;
            energy += rest.area * density;
        }
        energy.is_finite().then_some(energy)
    }

    /// Energy over the area of the panel of each triangle (J/m2); zero where it is flipped.
    pub fn densities(&self, flat: &[Vec2]) -> Vec<f64> {
        (self.region.mesh().triangles.iter().zip(self.region.flat()))
            .map(|(triangle, corners)| {
                Sides::new(triangle.map(|v| flat[v as usize]))
                    .map_or(0.0, |rest| self.stress(&right_strain(corners, &rest)).1)
            })
            .collect()
    }

    fn stress(&self, right: &Matrix2<f64>) -> (Matrix2<f64>, f64) {
        let strain = [
            0.5 * (right[(1, 1)] - 1.0),
            0.5 * (right[(0, 0)] - 1.0),
            right[(0, 1)],
        ];
        let ([warp, weft, shear], density) = self.law.stress(strain);
        (Matrix2::new(weft, shear, shear, warp), density)
    }
}

/// The sides of a triangle of the panel from its first corner.
pub(crate) struct Sides {
    inverse: Matrix2<f64>,
    area: f64,
}

impl Sides {
    pub(crate) fn new([a, b, c]: [Vec2; 3]) -> Option<Self> {
        let sides = Matrix2::from_columns(&[b - a, c - a]);
        let twice = sides.determinant();
        if twice.is_nan() || twice <= 0.0 {
            return None;
        }
        let inverse =
            Matrix2::new(sides[(1, 1)], -sides[(0, 1)], -sides[(1, 0)], sides[(0, 0)]) / twice;
        Some(Self {
            inverse,
            area: 0.5 * twice,
        })
    }
}

/// F^T F of a triangle from the panel to the surface (1).
pub(crate) fn right_strain(surface: &[Vec2; 3], rest: &Sides) -> Matrix2<f64> {
    let sides = Matrix2::from_columns(&[surface[1], surface[2]]);
    let deformation = sides * rest.inverse;
    deformation.transpose() * deformation
}
