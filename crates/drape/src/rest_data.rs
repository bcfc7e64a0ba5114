//! Data that follow from the rest shapes and materials of a cloth: elements, bending, masses.

use crate::bending_structure::Stencils;
use crate::contact_sample::ContactSample;
use crate::laws::bending::{BendingMatrix, BendingStencil};
use crate::laws::membrane::MembraneElement;
use crate::material::{DissipativeLaws, MaterialLaws};
use crate::materials::Materials;
use crate::topology::Topology;
use crate::{DrapeError, Material};
use nalgebra::Vector3;
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_sparse::ScalarMatrix;

/// Data that follow from rest shapes and materials.
#[derive(Clone)]
pub struct RestData {
    /// Membrane element of each triangle.
    pub elements: Vec<MembraneElement>,
    /// Bending matrix over the vertices, the same for x, y and z (N/m).
    pub bending: ScalarMatrix,
    /// Viscous matrix of bending in the pattern of `bending`; none without viscosity.
    pub viscous_bending: Option<ScalarMatrix>,
    /// Curvature stencil of each triangle; empty unless bending has viscosity or internal strain.
    pub stencils: Vec<BendingStencil>,
    /// The shared stencils where the topology has a structure of bending; else empty.
    pub(crate) curvatures: Stencils,
    /// Mass of each vertex (kg).
    pub mass: Vec<f64>,
    /// Contact samples at the vertices. A state adds more in triangles that cross a solid.
    pub samples: Arc<Vec<ContactSample>>,
}

impl RestData {
    /// The data for rest shapes of a topology's triangles after the exchange of caps.
    ///
    /// # Errors
    /// A triangle without area; the message names `object`.
    pub(crate) fn new(
        object: &str,
        topology: &Topology,
        rest: &[[Vec2; 3]],
        materials: &Materials,
    ) -> Result<Self, DrapeError> {
        let elements = elements(object, rest)?;
        let stencils = topology.stencils(rest);
        let bending = Bending::new(topology.layout.len(), stencils, materials, &elements);
        let (mass, samples) = lump(topology, materials, &elements);
        Ok(Self {
            elements,
            bending: bending.elastic,
            viscous_bending: bending.viscous,
            stencils: bending.stencils,
            curvatures: Vec::new(),
            mass,
            samples: Arc::new(samples),
        })
    }

    /// The data for other rest shapes of the same topology. With a structure of bending unchanged stencils are shared,
    /// and [`Self::curvatures`] must be those of `self`.
    ///
    /// # Errors
    /// A triangle without area, or one that is ill-conditioned in the structure; the message names `object`.
    pub(crate) fn reshaped(
        &self,
        object: &str,
        topology: &Topology,
        rest: &[[Vec2; 3]],
        materials: &Materials,
    ) -> Result<Self, DrapeError> {
        let Some(structure) = &topology.bending else {
            return Self::new(object, topology, rest, materials);
        };
        let elements = elements(object, rest)?;
        let curvatures = structure.stencils((&self.shapes(), &self.curvatures), rest)?;
        let matrix = |law| structure.matrix(&curvatures, materials, law, &elements);
        let viscous = self.viscous_bending.as_ref();
        let (mass, samples) = lump(topology, materials, &elements);
        let own = curvatures
            .iter()
            .map(|stencil| BendingStencil::clone(stencil));
        Ok(Self {
            bending: matrix(Material::bending_matrix),
            viscous_bending: viscous.map(|_| matrix(Material::viscous_bend)),
            stencils: match self.stencils.is_empty() {
                true => Vec::new(),
                false => own.collect(),
            },
            elements,
            curvatures,
            mass,
            samples: Arc::new(samples),
        })
    }

    /// The rest shape of each triangle, warp along the first axis (m).
    pub(crate) fn shapes(&self) -> Vec<[Vec2; 3]> {
        self.elements.iter().map(MembraneElement::rest).collect()
    }
}

fn elements(object: &str, rest: &[[Vec2; 3]]) -> Result<Vec<MembraneElement>, DrapeError> {
    let element = |(triangle, &rest): (usize, &[Vec2; 3])| {
        let empty = || DrapeError::EmptyTriangle {
            object: object.to_owned(),
            triangle,
        };
        MembraneElement::new(rest).ok_or_else(empty)
    };
    rest.iter().enumerate().map(element).collect()
}

/// Lumps mass, area and friction at the vertices: a third of each triangle to each corner. A vertex on
/// no triangle has no sample, and a mass of 1 kg so that it has a finite inverse.
fn lump(
    topology: &Topology,
    materials: &Materials,
    elements: &[MembraneElement],
) -> (Vec<f64>, Vec<ContactSample>) {
    let count = topology.layout.len();
    let mut mass = vec![0.0; count];
    let mut area = vec![0.0; count];
    let mut friction = vec![0.0; count];
    let mut restitution = vec![[0.0; 2]; count];
    for (t, corners) in topology.triangles.iter().enumerate() {
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

/// The bending matrices of a cloth.
struct Bending {
    elastic: ScalarMatrix,
    viscous: Option<ScalarMatrix>,
    stencils: Vec<BendingStencil>,
}

impl Bending {
    fn new(
        count: usize,
        stencils: Vec<BendingStencil>,
        materials: &Materials,
        elements: &[MembraneElement],
    ) -> Self {
        let sum = |of: fn(&Material) -> BendingMatrix| {
            let laws: Vec<_> = materials.list.iter().map(of).collect();
            let mut entries = Vec::with_capacity(100 * stencils.len());
            for (t, stencil) in stencils.iter().enumerate() {
                let law = laws[materials.of_triangle[t] as usize];
                let stiffness = stencil.stiffness(law) * elements[t].area;
                for (&i, p) in stencil.vertices.iter().zip(&stencil.weights) {
                    let moment = stiffness * Vector3::from(*p);
                    for (&j, q) in stencil.vertices.iter().zip(&stencil.weights) {
                        entries.push((i, j, moment.dot(&Vector3::from(*q))));
                    }
                }
            }
            ScalarMatrix::from_entries(count, &entries)
        };
        let elastic = sum(Material::bending_matrix);
        let viscous = materials
            .list
            .iter()
            .any(|m| m.is_viscous()[1])
            .then(|| sum(Material::viscous_bend));
        let relaxes = materials.list.iter().any(|m| m.relaxed_fraction[1] > 0.0);
        Self {
            elastic,
            stencils: if relaxes || viscous.is_some() {
                stencils
            } else {
                Vec::new()
            },
            viscous,
        }
    }
}
