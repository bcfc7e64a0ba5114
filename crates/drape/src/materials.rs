//! The materials of a cloth, by triangle.

use crate::Material;
use crate::laws::stretch::MembraneLaw;
use crate::material::{DissipativeLaws, MaterialLaws};

/// Materials, and the material of each triangle.
pub struct Materials {
    /// The materials.
    pub list: Vec<Material>,
    /// Index into `list` of each triangle.
    pub of_triangle: Vec<u16>,
    /// Membrane law of each material.
    pub laws: Vec<MembraneLaw>,
}

impl Materials {
    /// Materials, and an index into them for each triangle.
    pub(crate) fn new(list: Vec<Material>, of_triangle: Vec<u16>) -> Self {
        Self {
            laws: list.iter().map(Material::membrane).collect(),
            list,
            of_triangle,
        }
    }

    /// The material of a triangle.
    pub fn of(&self, triangle: usize) -> &Material {
        &self.list[self.of_triangle[triangle] as usize]
    }

    /// The membrane law of a triangle.
    #[inline]
    pub fn law(&self, triangle: usize) -> &MembraneLaw {
        &self.laws[self.of_triangle[triangle] as usize]
    }

    /// Whether any material has a coefficient of restitution.
    pub(crate) fn bounce(&self) -> bool {
        self.list.iter().any(|m| m.restitution.is_some())
    }

    /// Whether any material is viscous in stretch.
    pub fn have_viscous_stretch(&self) -> bool {
        self.list.iter().any(|m| m.is_viscous()[0])
    }

    /// Whether any material relaxes in stretch or bending.
    pub fn keep_strain(&self) -> bool {
        self.list.iter().any(Material::keeps_strain)
    }
}
