//! Kinds of change that an edit of the pattern makes to the cloth of a worn garment.

/// Kind of change that an edit makes to the cloth of a worn garment, the least first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RestChange {
    /// Nothing: the draft is the same.
    Nothing,
    /// Rest shapes of its triangles.
    Shapes,
    /// The mesh of its panels.
    Mesh,
}
