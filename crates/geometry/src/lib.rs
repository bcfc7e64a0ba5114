//! Vocabulary of shape: units, curves, polygons, triangle meshes, box trees,
//! ellipsoids and exact predicates. Knows nothing of tailoring or physics.
//!
//! In memory everything is metres, kilograms, seconds, radians and `f64`,
//! right-handed, Y up.

mod curve;
mod mesh;
mod predicates;
mod tree;
mod triangle;
mod units;

pub use curve::Curve;
pub use mesh::{MeshDefect, Topology, TriangleMesh};
pub use predicates::{
    orient2d, orient3d, segment_intersects_triangle, segments_cross, triangles_intersect,
};
pub use tree::{ClosestPoint, SurfaceTree};
pub use triangle::{Feature, closest_point_on_triangle, tetrahedron_volume, triangle_area};
pub use units::{Angle, Length, UnitError};

/// Point or vector in the plane [m].
pub type Vec2 = nalgebra::Vector2<f64>;
/// Point or vector in space [m], Y up.
pub type Vec3 = nalgebra::Vector3<f64>;
/// Rotation followed by translation.
pub type Rigid = nalgebra::Isometry3<f64>;
