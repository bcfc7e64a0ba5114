//! The materials of a cloth as its triangles use them.

use crate::Material;
use crate::laws::stretch::MembraneLaw;

/// Materials, and which of them each triangle is of.
pub struct Materials {
    /// The materials.
    pub list: Vec<Material>,
    /// Index into `list` of each triangle.
    pub of_triangle: Vec<u16>,
    /// How each material resists stretch.
    pub laws: Vec<MembraneLaw>,
}

impl Materials {
    /// Of materials and an index into them for each triangle.
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

    /// How a triangle resists stretch.
    pub(crate) fn law(&self, triangle: usize) -> &MembraneLaw {
        &self.laws[self.of_triangle[triangle] as usize]
    }

    /// Whether any cloth says how it bounces.
    pub(crate) fn bounce(&self) -> bool {
        self.list.iter().any(|m| m.restitution.is_some())
    }

    /// Whether stretch of any cloth is viscous.
    pub(crate) fn have_viscous_stretch(&self) -> bool {
        self.list.iter().any(|m| m.is_viscous()[0])
    }

    /// Whether any cloth keeps stretch or folds.
    pub(crate) fn keep_strain(&self) -> bool {
        self.list.iter().any(Material::keeps_strain)
    }
}
