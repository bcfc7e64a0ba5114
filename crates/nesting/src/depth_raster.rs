//! Losses of one shape at positions on a regular grid relative to another.

/// Numbers processed at once by SIMD: rows of rasters and maps are padded to multiples of it.
pub(crate) const LANES: usize = 16;

/// Losses of one shape at positions on a regular grid relative to another.
#[derive(Clone, Debug)]
pub(crate) struct DepthRaster {
    /// First column and first row, in cells from zero offset.
    pub first: [i32; 2],
    pub columns: usize,
    /// Distance between rows in `values`: the columns, then zeros for at least one whole SIMD group.
    pub stride: usize,
    pub values: Vec<f32>,
}

/// Length of a padded row.
pub(crate) fn padded(columns: usize) -> usize {
    columns.next_multiple_of(LANES) + LANES
}
