//! The model: the constant data of a simulation.
//!
//! # Decided with
//! - [`crate::contacts`] (`fits`), [`crate::collision::ContactDetector::surface`]: contacts and surface kept;
//! - [`crate::hessian::Hessian`]: matrix and factor kept;
//! - [`crate::xpbd`], crate `reference` (`patches/`: `sheet.rs`, `fits`): XPBD and patches kept;
//! - crate `reference` (`metric.rs`, `colours.rs`): methods for comparison;
//! - [`crate::topology`], [`crate::caps`], [`crate::rest_data`]: triangles that are simulated in place of
//!   those drawn, and their rest shapes.
//!
//! By hand: a new part of a model must be compared in each of these places whose cache depends on it.

use crate::ContactSettings;
use crate::collider::{Collider, PrescribedVertex};
use crate::elastic::ElasticCouplings;
use crate::materials::Materials;
use crate::pair_policies::PairPolicies;
use crate::rest_data::RestData;
use crate::topology::Topology;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;
use toile_geometry::{TriangleMesh, Vec3};

/// Vertices with a prescribed motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prescribed {
    /// Whether each vertex is pinned, so that it is no unknown.
    pub pinned: Vec<bool>,
    /// Pinned vertices on a prescribed motion; only XPBD moves them.
    pub led: Vec<PrescribedVertex>,
}

/// The shared parts of a model. A cache has a clone of the parts it was made from and is valid while the model has the
/// same ones.
#[derive(Clone)]
pub struct ModelParts {
    /// Triangles and the structure of matrices.
    pub topology: Arc<Topology>,
    /// Data that follow from rest shapes and materials.
    pub rest: Arc<RestData>,
    /// Materials.
    pub materials: Arc<Materials>,
    /// Vertices with a prescribed motion.
    pub prescribed: Arc<Prescribed>,
    /// Elastics between vertices.
    pub couplings: Arc<ElasticCouplings>,
    /// Solid surfaces.
    pub colliders: Arc<Vec<Collider>>,
    /// Contact settings.
    pub contact: ContactSettings,
    /// Layer of each vertex, larger numbers farther out, or
    /// [`BETWEEN_LAYERS`](crate::collision::BETWEEN_LAYERS); empty where all have the same.
    pub layer: Arc<Vec<u16>>,
    /// Pairs of objects that ignore each other.
    pub policies: Arc<PairPolicies>,
}

/// The constant part of a simulation, made by a [`SystemBuilder`](crate::SystemBuilder). It is
/// immutable: it gives read access to its [`ModelParts`] only.
#[derive(Clone)]
pub struct Model {
    parts: ModelParts,
}

impl Deref for Model {
    type Target = ModelParts;

    fn deref(&self) -> &ModelParts {
        &self.parts
    }
}

impl fmt::Debug for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Model")
            .field("vertices", &self.vertex_count())
            .field("triangles", &self.topology.triangles.len())
            .finish_non_exhaustive()
    }
}

impl Model {
    /// A model of parts, which must belong to one cloth.
    pub(crate) fn of(parts: ModelParts) -> Self {
        Self { parts }
    }
}

impl ModelParts {
    /// Mass of the cloth at each vertex (kg); zero for a vertex on no triangle, which has a mass in the model.
    pub(crate) fn cloth_mass(&self) -> Vec<f64> {
        let corners = self.topology.corner_start.windows(2);
        let own = self.rest.mass.iter().zip(corners);
        own.map(|(&mass, corners)| if corners[0] < corners[1] { mass } else { 0.0 })
            .collect()
    }

    /// Whether another model shares triangles, rest shapes and materials.
    pub fn has_cloth_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.topology, &other.topology)
            && Arc::ptr_eq(&self.rest, &other.rest)
            && Arc::ptr_eq(&self.materials, &other.materials)
    }

    /// Whether matrices of another model share the sparsity pattern, except for elastics between vertices.
    pub(crate) fn has_structure_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.topology, &other.topology)
            && (self.topology.bending.is_some() || Arc::ptr_eq(&self.rest, &other.rest))
    }

    /// Whether another model shares prescribed vertices and elastics between vertices.
    pub fn has_couplings_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.prescribed, &other.prescribed)
            && Arc::ptr_eq(&self.couplings, &other.couplings)
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.rest.mass.len()
    }

    /// Area of a triangle at rest (m2).
    pub fn rest_area(&self, triangle: usize) -> f64 {
        self.rest.elements[triangle].area
    }

    /// Triangles of the surface before the exchange of caps.
    pub fn surface_triangles(&self) -> &[[u32; 3]] {
        self.topology.surface_triangles()
    }

    /// The surface at some positions.
    pub fn mesh(&self, positions: &[Vec3]) -> TriangleMesh {
        self.topology.mesh(positions)
    }
}
