//! What follows from the rest shapes of a cloth and its materials: elements, bending, masses.

use crate::contact_sample::ContactSample;
use crate::laws::bending::{BendingMatrix, BendingStencil, RestSheet};
use crate::laws::membrane::MembraneElement;
use crate::materials::Materials;
use crate::{Cloth, DrapeError, Material};
use nalgebra::Vector3;
use std::sync::Arc;
use toile_sparse::ScalarMatrix;

/// What follows from rest shapes and materials.
#[derive(Clone)]
pub struct RestData {
    /// Membrane of each triangle.
    pub(crate) elements: Vec<MembraneElement>,
    /// Bending over the vertices, the same for x, y and z [N/m].
    pub(crate) bending: ScalarMatrix,
    /// Viscous matrix of bending, where any cloth has one: the pattern of `bending`.
    pub(crate) viscous_bending: Option<ScalarMatrix>,
    /// Curvatures of each triangle; empty unless folds are viscous or kept.
    pub(crate) stencils: Vec<BendingStencil>,
    /// Mass of each vertex [kg].
    pub mass: Vec<f64>,
    /// Where the cloth is tested against solids from the start: at its vertices. A state has more where
    /// it needs them.
    pub samples: Arc<Vec<ContactSample>>,
}

impl RestData {
    /// Of a cloth whose caps are exchanged.
    ///
    /// # Errors
    /// A triangle without area, told as one of `object`.
    pub(crate) fn new(
        object: &str,
        cloth: &Cloth,
        materials: &Materials,
    ) -> Result<Self, DrapeError> {
        let mut elements = Vec::with_capacity(cloth.triangles.len());
        for (triangle, &rest) in cloth.rest.iter().enumerate() {
            let empty = || DrapeError::EmptyTriangle {
                object: object.to_owned(),
                triangle,
            };
            elements.push(MembraneElement::new(rest).ok_or_else(empty)?);
        }
        let bending = Bending::new(cloth, &elements);
        let (mass, samples) = lump(cloth, materials, &elements);
        Ok(Self {
            elements,
            bending: bending.elastic,
            viscous_bending: bending.viscous,
            stencils: bending.stencils,
            mass,
            samples: Arc::new(samples),
        })
    }
}

/// Lumps mass, area and friction at the vertices: a third of each triangle to each corner. A vertex on
/// no triangle has no sample, and a mass of 1 kg so that nothing is divided by zero.
fn lump(
    cloth: &Cloth,
    materials: &Materials,
    elements: &[MembraneElement],
) -> (Vec<f64>, Vec<ContactSample>) {
    let count = cloth.positions.len();
    let mut mass = vec![0.0; count];
    let mut area = vec![0.0; count];
    let mut friction = vec![0.0; count];
    let mut restitution = vec![[0.0; 2]; count];
    for (t, corners) in cloth.triangles.iter().enumerate() {
        let share = elements[t].area / 3.0;
        let material = materials.of(t);
        for &v in corners {
            area[v as usize] += share;
            mass[v as usize] += share * material.density;
            friction[v as usize] += share * material.friction;
            if let Some(e) = material.restitution {
                restitution[v as usize][0] += share * e;
                restitution[v as usize][1] += share;
            }
        }
    }
    let samples = (0..count)
        .filter(|&v| area[v] > 0.0)
        .map(|v| ContactSample {
            triangle: None,
            vertices: [v as u32; 3],
            weights: [1.0, 0.0, 0.0],
            area: area[v],
            friction: friction[v] / area[v],
            restitution: (restitution[v][1] > 0.0).then(|| restitution[v][0] / restitution[v][1]),
            extra_offset: 0.0,
        })
        .collect();
    for (mass, &area) in mass.iter_mut().zip(&area) {
        if area <= 0.0 {
            *mass = 1.0;
        }
    }
    (mass, samples)
}

/// The bending of a cloth.
struct Bending {
    elastic: ScalarMatrix,
    viscous: Option<ScalarMatrix>,
    stencils: Vec<BendingStencil>,
}

impl Bending {
    fn new(cloth: &Cloth, elements: &[MembraneElement]) -> Self {
        let topology = cloth.mesh().topology();
        let sheet = RestSheet {
            triangles: &cloth.triangles,
            rest: &cloth.rest,
            topology: &topology,
        };
        let stencils = sheet.stencils();
        let sum = |of: fn(&Material) -> BendingMatrix| {
            let laws: Vec<_> = cloth.materials.iter().map(of).collect();
            let mut entries = Vec::with_capacity(100 * stencils.len());
            for (t, stencil) in stencils.iter().enumerate() {
                let law = laws[cloth.material[t] as usize];
                let stiffness = stencil.stiffness(law) * elements[t].area;
                for (&i, p) in stencil.vertices.iter().zip(&stencil.weights) {
                    let moment = stiffness * Vector3::from(*p);
                    for (&j, q) in stencil.vertices.iter().zip(&stencil.weights) {
                        entries.push((i, j, moment.dot(&Vector3::from(*q))));
                    }
                }
            }
            ScalarMatrix::from_entries(cloth.positions.len(), &entries)
        };
        let elastic = sum(Material::bending_matrix);
        let viscous = cloth
            .materials
            .iter()
            .any(|m| m.is_viscous()[1])
            .then(|| sum(Material::viscous_bend));
        let kept = cloth.materials.iter().any(|m| m.kept[1] > 0.0);
        Self {
            elastic,
            stencils: if kept || viscous.is_some() {
                stencils
            } else {
                Vec::new()
            },
            viscous,
        }
    }
}
