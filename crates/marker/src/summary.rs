//! The summary of a marker: length, cost, efficiency, faults.

use toile_pattern::DisplayUnit;

/// The main numbers of a marker.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MarkerSummary {
    /// Name of the fabric.
    pub fabric: String,
    /// The roll that the marker is cut from, if there are several.
    pub roll: Option<String>,
    /// Number of pieces laid.
    pub pieces: usize,
    /// Number of pieces that lie on no marker of the fabric.
    pub unplaced: usize,
    /// Names of the unplaced pieces, each with the reason.
    pub missing: Vec<[String; 2]>,
    /// Length of fabric used, end margins included (m).
    pub length: f64,
    /// Width of the fabric (m).
    pub width: f64,
    /// Number of layers cut at once; the two layers of folded fabric count as one.
    pub plies: u32,
    /// Length of fabric needed for all plies together (m).
    pub yardage: f64,
    /// Price of the fabric, if the price per metre is known.
    pub cost: Option<f64>,
    /// Currency of the price.
    pub currency: String,
    /// Area of the pieces divided by width times length between the end margins (0 to 1).
    pub efficiency: f64,
    /// Area of the pieces divided by width times length (0 to 1).
    pub utilisation: f64,
    /// The unit of displayed lengths.
    pub unit: DisplayUnit,
    /// Notes for the cutter.
    pub notes: Vec<String>,
    /// Whether the check found no fault, so that the marker can be cut.
    pub sound: bool,
}
