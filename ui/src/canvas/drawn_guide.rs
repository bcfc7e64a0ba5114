//! A guide as it is drawn.

use egui::Pos2;
use toile_pattern::{GuideId, GuideRun};

/// A guide as it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnGuide {
    /// Which; nothing for one that is not in the document yet.
    pub id: Option<GuideId>,
    /// Which way it runs.
    pub runs: GuideRun,
    /// Where it lies on the table (m).
    pub at: f64,
}

/// What is told of a guide beside the pointer.
#[derive(Clone, Debug, PartialEq)]
pub struct GuideLabel {
    /// Where the pointer is.
    pub at: Pos2,
    /// The words.
    pub words: String,
}
