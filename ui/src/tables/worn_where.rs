//! Places in the order of layers where a garment is put on.

/// Place of an added garment in the order of layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WornWhere {
    /// Over all other garments.
    Over,
    /// Under all other garments, next to the skin.
    Under,
}
