//! How a pattern's garment is tried on, as its file keeps it.

use std::ops::RangeInclusive;
use toile_body::Figure;
use toile_measure::Measurements;
use toile_pattern::SizeId;

/// Widths that fabric may have (m).
pub const FABRIC_WIDTHS: RangeInclusive<f64> = 0.05..=20.0;

/// How a garment is tried on: on whom, in which size and cloth, with what else. What is as the
/// pattern says is left out. Files are named by a path from the pattern's own folder, with `/`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fitting {
    /// Whose body it is.
    pub wearer: FittingWearer,
    /// The size it is drafted in.
    pub size: Option<SizeId>,
    /// The fabric that takes the place of every panel's.
    pub fabric: Option<FittingFabric>,
    /// Width of the fabric (m).
    pub width: Option<f64>,
    /// Layer of the garment itself among those worn with it: larger numbers lie farther out.
    pub layer: u16,
    /// Garments worn with it.
    pub worn_with: Vec<FittingLayer>,
}

/// Whose body a garment is tried on.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum FittingWearer {
    /// As the pattern says.
    #[default]
    OfPattern,
    /// A figure with its average measurements.
    Figure(Figure),
    /// A body of measurements.
    Measured {
        /// The figure it is grown from.
        figure: Figure,
        /// The file they were read from, if they are its own.
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

/// A fabric that takes the place of every panel's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FittingFabric {
    /// One of the pattern's or of the library, by name.
    Named(String),
    /// One of a file.
    File(String),
}

/// A garment that is worn with the pattern's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FittingLayer {
    /// The file of its pattern.
    pub file: String,
    /// Its layer.
    pub layer: u16,
}
