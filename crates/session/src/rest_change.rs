//! Kinds of change that an edit of the pattern makes to the cloth of a worn garment.

/// Kind of change that an edit makes to the cloth of a worn garment, from the smallest to the largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RestChange {
    /// No change: the draft is the same.
    Nothing,
    /// Change of the rest shapes of the triangles.
    Shapes,
    /// Change of the mesh of the panels.
    Mesh,
}
