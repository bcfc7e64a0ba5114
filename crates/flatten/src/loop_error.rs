//! Why a region cannot be cut out of a surface.

/// A loop on a surface that bounds no region, with the place and the remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LoopError {
    /// There is no surface.
    #[error("the surface has no triangles; give a mesh")]
    Empty,
    /// A vertex or a triangle cannot be used.
    #[error("{0}; repair the mesh")]
    Mesh(#[from] toile_geometry::MeshDefect),
    /// More than two triangles meet at an edge, or two on one side of it.
    #[error(
        "the surface branches or has one side at ({0:.4}, {1:.4}, {2:.4}) m; leave one sheet of it, with a front and a back"
    )]
    Branches(f64, f64, f64),
    /// Too few or too many places.
    #[error("the loop has {count} places; give {least} to {most}")]
    Count {
        /// Places given.
        count: usize,
        /// Fewest.
        least: usize,
        /// Most.
        most: usize,
    },
    /// A place is not on the surface.
    #[error(
        "{what} is {distance} mm from the surface, more than {most} mm; give a place on it (m, in the axes of the mesh)"
    )]
    Off {
        /// Name of the place.
        what: String,
        /// Distance (mm).
        distance: f64,
        /// Largest distance (mm).
        most: f64,
    },
    /// Two places are one.
    #[error("{0} and {1} lie in one place; leave one of them out")]
    Same(String, String),
    /// No path joins two places.
    #[error(
        "no path on the surface joins {0} and {1}: it is in several pieces; give places on one piece"
    )]
    Apart(String, String),
    /// A path meets another one.
    #[error(
        "the path from {first} meets the loop again at ({x:.4}, {y:.4}, {z:.4}) m, on the path from {second}; give the places in the order round the region, or one more between them"
    )]
    Crosses {
        /// Place that the path begins at.
        first: String,
        /// Place that the path it meets begins at.
        second: String,
        /// Place (m).
        x: f64,
        /// Place (m).
        y: f64,
        /// Place (m).
        z: f64,
    },
    /// The loop has one side alone.
    #[error(
        "the loop does not part the surface in two: it runs round a handle or a hole of it; give a loop that bounds a region"
    )]
    PartsNothing,
    /// The region has holes.
    #[error(
        "the region within the loop has {0} outlines, so it is no disk; give a loop that goes round no hole, or name the other side by a place inside"
    )]
    Holes(usize),
    /// The region has a handle.
    #[error(
        "the region within the loop has a handle, so it is no disk; give a loop that goes round none"
    )]
    Handle,
    /// The place inside tells no side.
    #[error(
        "the place inside lies on neither side of the loop; give one away from it, on the same piece of the surface"
    )]
    Inside,
    /// A cut cannot be made.
    #[error("cut {cut} {why}; {remedy}")]
    Cut {
        /// Number of the cut, from 1.
        cut: usize,
        /// What is wrong.
        why: String,
        /// The remedy.
        remedy: &'static str,
    },
    /// The length of edges cannot be used.
    #[error(
        "the length of the edges is {0} m; give one of 0.5 mm to 10 cm, such that the region has 3 to {1} triangles"
    )]
    EdgeLength(f64, usize),
    /// A path could not be cut into the triangles.
    #[error("the triangles at {0} are too thin to be cut; mesh the surface again")]
    TooThin(String),
}
