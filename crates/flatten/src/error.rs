//! Why a surface cannot be flattened.

/// A surface that has no panel, with the place and the remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlattenError {
    /// There is nothing to flatten.
    #[error("the surface has no triangles; give a mesh of a surface with one outline")]
    Empty,
    /// More vertices than are taken.
    #[error("the surface has {count} vertices, more than {most}; give a coarser mesh")]
    TooLarge {
        /// Vertices of the surface.
        count: usize,
        /// Most vertices taken.
        most: usize,
    },
    /// A vertex or a triangle cannot be used.
    #[error("{0}; repair the mesh")]
    Mesh(#[from] toile_geometry::MeshDefect),
    /// A triangle has no area.
    #[error(
        "triangle {triangle} at ({x:.4}, {y:.4}, {z:.4}) m has no area; remove it or mesh the surface again"
    )]
    NoArea {
        /// Index of the triangle.
        triangle: usize,
        /// Place of its middle (m).
        x: f64,
        /// Place of its middle (m).
        y: f64,
        /// Place of its middle (m).
        z: f64,
    },
    /// The surface is in several pieces.
    #[error("the surface is in {0} pieces; flatten one at a time")]
    Pieces(usize),
    /// More than two triangles meet at an edge, or two fans of triangles at a vertex.
    #[error(
        "the surface branches at ({x:.4}, {y:.4}, {z:.4}) m, where {what}; leave one sheet of it"
    )]
    Branches {
        /// The kind of branch.
        what: &'static str,
        /// Place (m).
        x: f64,
        /// Place (m).
        y: f64,
        /// Place (m).
        z: f64,
    },
    /// The surface has one side, as a Moebius band.
    #[error(
        "the surface has one side (a Moebius band); cut it across, so that it has a front and a back"
    )]
    OneSided,
    /// The surface has no outline.
    #[error("the surface is closed and has no outline; cut it open, or give a loop on it")]
    Closed,
    /// The surface has holes.
    #[error(
        "the surface has {outlines} outlines, so it is no disk; cut it from the outer outline to each of the {holes} others"
    )]
    Holes {
        /// Number of outlines.
        outlines: usize,
        /// Outlines but one.
        holes: usize,
    },
    /// The surface has handles.
    #[error("the surface has a handle, as a cup has; cut it through")]
    Handle,
    /// The grain stands square to the surface.
    #[error("the grain stands square to the surface; give a direction along it")]
    Grain,
    /// A limit, a stiffness or another number cannot be used.
    #[error("{what} is {value}; {remedy}")]
    Number {
        /// Name of the number.
        what: &'static str,
        /// The number.
        value: f64,
        /// The remedy.
        remedy: &'static str,
    },
    /// A cut does not begin at the outline or does not follow edges.
    #[error("cut {cut} {why}; draw it from the outline along edges of the mesh to a vertex inside")]
    Cut {
        /// Index of the cut.
        cut: usize,
        /// What is wrong.
        why: &'static str,
    },
    /// No start without flipped triangles was found.
    #[error(
        "no flat start without flipped triangles was found, the mesh has triangles that are too thin; mesh the surface again"
    )]
    NoStart,
    /// The work was stopped.
    #[error("it was stopped")]
    Stopped,
    /// A region cannot be cut out of a surface, or meshed.
    #[error(transparent)]
    Loop(#[from] crate::LoopError),
    /// A linear system could not be solved.
    #[error("the surface's triangles are too thin to be solved for; mesh the surface again")]
    Singular,
}

impl From<toile_sparse::factor::NotPositive> for FlattenError {
    fn from(_: toile_sparse::factor::NotPositive) -> Self {
        Self::Singular
    }
}
