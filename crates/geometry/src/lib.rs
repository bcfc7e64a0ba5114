//! Vocabulary of shape: units, curves, polygons, triangle meshes, box trees,
//! ellipsoids and exact predicates. Knows nothing of tailoring or physics.
//!
//! In memory everything is metres, kilograms, seconds, radians and `f64`,
//! right-handed, Y up.

#![cfg_attr(test, allow(clippy::unwrap_used))]

mod closed_list;
mod closest;
mod closest_facet;
mod curve;
mod distance_field;
mod ellipsoid;
mod mesh;
mod moving_surface;
mod path;
mod pinch;
mod polygon;
mod polygon_boolean;
mod polygon_contact;
mod polygon_hull;
mod polygon_minkowski;
mod polygon_simple;
mod polygon_tree;
mod predicates;
mod rings;
mod section;
mod swept_tree;
mod tree;
mod triangle;
mod triangulate;
mod units;

pub use closest::{closest_on_face, closest_on_segments};
pub use curve::Curve;
pub use distance_field::DistanceField;
pub use ellipsoid::Ellipsoid;
pub use mesh::{MeshDefect, Topology, TriangleMesh};
pub use moving_surface::MovingSurface;
pub use path::{Path, PathCrossing, PathPlace};
pub use pinch::Room;
pub use polygon::{Bounds2, Location, Polygon, ring_area};
pub use polygon_boolean::{
    Corner, difference, intersection, offset, total_area, union, wound_region,
};
pub use polygon_contact::{PreparedPolygon, interiors_overlap};
pub use polygon_hull::{convex_hull, half_hull};
pub use polygon_minkowski::{minkowski_sum, no_fit_polygon};
pub use polygon_simple::{Crossing, CrossingKind, PolygonDefect, crossing_point};
pub use polygon_tree::{EdgeTree, closest_on_segment, point_segment_distance, segment_distance};
pub use predicates::{
    orient2d, orient3d, segment_intersects_triangle, segments_cross, triangles_intersect,
};
pub use rings::{RingCrossings, Rings};
pub use section::{closed_length, horizontal_section};
pub use tree::{ClosestPoint, SurfaceTree};
pub use triangle::{
    Feature, closest_point_on_triangle, ray_into_triangle, tetrahedron_volume, triangle_area,
};
pub use triangulate::{TriangulationError, delaunay_triangles, polygon_triangles};
pub use units::{Angle, Duration, Length, UnitError};

/// Point or vector in the plane (m).
pub type Vec2 = nalgebra::Vector2<f64>;
/// Point or vector in space (m), Y up.
pub type Vec3 = nalgebra::Vector3<f64>;
/// Rotation followed by translation.
pub type Rigid = nalgebra::Isometry3<f64>;
