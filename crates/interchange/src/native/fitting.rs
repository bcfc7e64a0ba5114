//! The fitting of a pattern's garment as stored in its file: wearer, size, fabric, other garments.

use std::ops::RangeInclusive;
use toile_body::Figure;
use toile_measure::Measurements;
use toile_pattern::SizeId;

/// Allowed widths of fabric (m).
pub const FABRIC_WIDTHS: RangeInclusive<f64> = 0.05..=20.0;

/// The fitting of a garment: wearer, size, fabric and garments worn with it. Values equal to the pattern's
/// are left out. Files are named by their path relative to the pattern's folder, with `/`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fitting {
    /// The body that wears the garment.
    pub wearer: FittingWearer,
    /// The size that the pattern is drafted in.
    pub size: Option<SizeId>,
    /// A fabric that replaces the fabric of every panel.
    pub fabric: Option<FittingFabric>,
    /// Width of the fabric (m).
    pub width: Option<f64>,
    /// Layer of the garment among those worn together: larger numbers lie farther out.
    pub layer: u16,
    /// Garments worn together with the pattern's garment.
    pub worn_with: Vec<FittingLayer>,
}

/// The body that a garment is tried on.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum FittingWearer {
    /// The body that the pattern asks for.
    #[default]
    OfPattern,
    /// A figure with average measurements.
    Figure(Figure),
    /// A body made from measurements.
    Measured {
        /// The figure that the body is adapted from.
        figure: Figure,
        /// The file that the measurements were read from; `None` if they come from no file.
        file: Option<String>,
        /// The measurements (m), (rad).
        measurements: Measurements,
    },
    /// The body of a mannequin file.
    Mannequin {
        /// The file.
        file: String,
    },
}

/// A fabric that replaces the fabric of every panel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FittingFabric {
    /// A fabric of the pattern or of the library, by name.
    Named(String),
    /// A fabric from a file.
    File(String),
}

/// A garment worn together with the pattern's garment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FittingLayer {
    /// The pattern file of the garment.
    pub file: String,
    /// Layer of the garment.
    pub layer: u16,
}
