//! The summary of a marker: length, cost, efficiency, faults.

use toile_pattern::DisplayUnit;

/// The main numbers of a marker.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MarkerSummary {
    /// Name of the fabric.
    pub fabric: String,
    /// The roll it is cut from, if there are several.
    pub roll: Option<String>,
    /// Pieces laid.
    pub pieces: usize,
    /// Pieces that found no place on any marker of the fabric.
    pub unplaced: usize,
    /// Their names, and why.
    pub missing: Vec<[String; 2]>,
    /// Fabric used (m).
    pub length: f64,
    /// Width of the fabric (m).
    pub width: f64,
    /// Layers cut at once; a fold does not count.
    pub plies: u32,
    /// Fabric needed, all plies together (m).
    pub yardage: f64,
    /// Its price, if a metre's is known.
    pub cost: Option<f64>,
    /// Currency of the price.
    pub currency: String,
    /// Area of the pieces over width times length between the end margins, 0..=1.
    pub efficiency: f64,
    /// Area of the pieces over width times length, 0..=1.
    pub utilisation: f64,
    /// The unit numbers are shown in.
    pub unit: DisplayUnit,
    /// Notes for the cutter.
    pub notes: Vec<String>,
    /// Whether the referee found no overlap and nothing outside the fabric.
    pub sound: bool,
}
