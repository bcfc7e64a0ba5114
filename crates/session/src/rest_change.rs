//! How much of a worn garment's cloth an edit changes.

/// What an edit changes of a worn garment's cloth, the least first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RestChange {
    /// Nothing: the draft is the same.
    Nothing,
    /// Rest shapes of its triangles.
    Shapes,
    /// The mesh of its panels.
    Mesh,
}
