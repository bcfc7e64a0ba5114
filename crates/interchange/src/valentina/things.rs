//! Points and curves of a file as they were read: their parts in the document, and their places for the base
//! size.

use std::sync::Arc;
use toile_geometry::{Path, Vec2};
use toile_pattern::{CurveId, PointId};

/// A point that was read.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointThing {
    /// The point of the document.
    pub id: PointId,
    /// Place for the base size (m).
    pub at: Vec2,
    /// Index of its sheet.
    pub sheet: usize,
}

/// Answer of a tool: the point, or the reason in words why it cannot be made.
pub(super) type Made = Result<PointThing, String>;

/// A curve that was read, or a part of one.
#[derive(Clone, Debug)]
pub(super) struct CurveThing {
    /// The curve of the document that it is, or is part of.
    pub id: CurveId,
    /// Start and end of it.
    pub ends: [PointThing; 2],
    /// Course for the base size (m).
    pub path: Path,
    /// Index of its sheet.
    pub sheet: usize,
    /// Name in the file, as in `Spl_A_B`.
    pub name: String,
    /// Length as a formula, a primary expression.
    pub length: String,
    /// Length from the start of the document's curve to its own as a formula, a primary expression; `None`
    /// for 0.
    pub start: Option<String>,
    /// Whether it is the curve of the document as a whole.
    pub is_whole: bool,
}

/// A part of a file that other parts refer to by its number.
#[derive(Clone, Debug)]
pub(super) enum Thing {
    /// A point.
    Point(PointThing),
    /// A curve.
    Curve(Arc<CurveThing>),
}
