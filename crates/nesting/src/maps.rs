//! Limits of the resolution of loss maps.

/// Numbers in all depth rasters together, padding included, above which loss maps get fewer rows:
/// 128 MB.
pub(crate) const RASTER_NUMBERS: f64 = 32e6;

/// Limits of the resolution of loss maps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Maps {
    /// Fewest rows.
    pub rows: f64,
    /// Most numbers in all depth rasters together.
    pub numbers: f64,
}

impl Maps {
    /// Maps that tell places of all but the smallest pieces apart, in 128 MB.
    pub const FINE: Self = Self {
        rows: 24.0,
        numbers: RASTER_NUMBERS,
    };
    /// Maps that still mean something, in 512 MB.
    pub const COARSE: Self = Self {
        rows: 8.0,
        numbers: 4.0 * RASTER_NUMBERS,
    };
}
