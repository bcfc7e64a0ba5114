//! The model: everything about a simulation that does not change while it runs.

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

/// Vertices whose motion is given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prescribed {
    /// Whether each vertex is held: it is no unknown.
    pub pinned: Vec<bool>,
    /// Held vertices that are led; only XPBD leads them.
    pub led: Vec<PrescribedVertex>,
}

/// The parts of a model. A cache holds a clone of the parts it was made from and is valid while the
/// model has the same ones.
#[derive(Clone)]
pub struct ModelParts {
    /// Triangles and the structure of matrices.
    pub topology: Arc<Topology>,
    /// What follows from rest shapes.
    pub rest: Arc<RestData>,
    /// What the cloth is made of.
    pub materials: Arc<Materials>,
    /// Vertices whose motion is given.
    pub prescribed: Arc<Prescribed>,
    /// Elastics between vertices.
    pub couplings: Arc<ElasticCouplings>,
    /// Solid surfaces.
    pub colliders: Arc<Vec<Collider>>,
    /// How the cloth meets them, and itself.
    pub contact: ContactSettings,
    /// Layer of each vertex, larger numbers farther out, or
    /// [`BETWEEN_LAYERS`](crate::collision::BETWEEN_LAYERS); empty where all are of one.
    pub layer: Arc<Vec<u16>>,
    /// Which objects of the cloth do not meet each other, or which solids.
    pub policies: Arc<PairPolicies>,
}

/// The constant part of a simulation, made by a [`SystemBuilder`](crate::SystemBuilder). Nothing assigns to
/// it: it only lends its [`ModelParts`].
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
    /// Of its parts, which must be of one cloth.
    pub(crate) fn of(parts: ModelParts) -> Self {
        Self { parts }
    }
}

impl ModelParts {
    /// Mass of the cloth at each vertex [kg]: that of the model, and none for a vertex on no triangle.
    pub(crate) fn cloth_mass(&self) -> Vec<f64> {
        let corners = self.topology.corner_start.windows(2);
        let own = self.rest.mass.iter().zip(corners);
        own.map(|(&mass, corners)| if corners[0] < corners[1] { mass } else { 0.0 })
            .collect()
    }

    /// Whether another model is of the very same cloth: triangles, rest shapes and materials.
    pub(crate) fn has_cloth_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.topology, &other.topology)
            && Arc::ptr_eq(&self.rest, &other.rest)
            && Arc::ptr_eq(&self.materials, &other.materials)
    }

    /// Whether matrices of another model have the very same structure, elastics between vertices apart.
    pub(crate) fn has_structure_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.topology, &other.topology)
            && (self.topology.bending.is_some() || Arc::ptr_eq(&self.rest, &other.rest))
    }

    /// Whether another model has the very same prescribed vertices and the same elastics between vertices.
    pub(crate) fn has_couplings_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.prescribed, &other.prescribed)
            && Arc::ptr_eq(&self.couplings, &other.couplings)
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.rest.mass.len()
    }

    /// Area of a triangle at rest [m2].
    pub fn rest_area(&self, triangle: usize) -> f64 {
        self.rest.elements[triangle].area
    }

    /// Triangles of the surface as it was given.
    pub fn surface_triangles(&self) -> &[[u32; 3]] {
        self.topology.surface_triangles()
    }

    /// The surface at some positions.
    pub fn mesh(&self, positions: &[Vec3]) -> TriangleMesh {
        self.topology.mesh(positions)
    }
}
