//! Limits of the resolution of loss maps.

/// Total size of all depth rasters, padding included, above which loss maps get fewer rows: 128 MB.
pub(crate) const RASTER_NUMBERS: f64 = 32e6;

/// Limits of the resolution of loss maps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Maps {
    /// Smallest number of rows.
    pub rows: f64,
    /// Largest total size of all depth rasters (numbers).
    pub numbers: f64,
}

impl Maps {
    /// Maps that resolve positions of all but the smallest pieces, in 128 MB.
    pub const FINE: Self = Self {
        rows: 24.0,
        numbers: RASTER_NUMBERS,
    };
    /// The coarsest maps that are still useful, in 512 MB.
    pub const COARSE: Self = Self {
        rows: 8.0,
        numbers: 4.0 * RASTER_NUMBERS,
    };
}
