//! A guide as it is drawn.

use egui::Pos2;
use toile_pattern::{GuideId, GuideRun};

/// A guide as the canvas draws it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnGuide {
    /// Guide in the document; `None` for one that is being added.
    pub id: Option<GuideId>,
    /// Direction of the guide.
    pub runs: GuideRun,
    /// Coordinate of the guide across its direction, on the table (m).
    pub at: f64,
}

/// The label of a guide beside the pointer.
#[derive(Clone, Debug, PartialEq)]
pub struct GuideLabel {
    /// Position of the pointer.
    pub at: Pos2,
    /// Text.
    pub words: String,
}
