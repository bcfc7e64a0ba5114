//! Losses of one shape at regular moves from another.

/// Numbers added at once: rows of rasters and maps are padded to whole groups.
pub(crate) const LANES: usize = 16;

/// Losses of one shape at regular moves from another.
#[derive(Clone, Debug)]
pub(crate) struct DepthRaster {
    /// First column and row, in cells from no move.
    pub first: [i32; 2],
    pub columns: usize,
    /// Numbers from row to row: the columns, then zeros to at least one whole group more.
    pub stride: usize,
    pub values: Vec<f32>,
}

/// Length of a padded row.
pub(crate) fn padded(columns: usize) -> usize {
    columns.next_multiple_of(LANES) + LANES
}
