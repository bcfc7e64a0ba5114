//! Diagnostics: a fault of a pattern with its place, severity and remedy.
//!
//! # Decided with
//! - [`crate::evaluate`] (`numbers.rs`, `points.rs`, `curves.rs`, `duplicates.rs`, `markers.rs`): faults of
//!   numbers, points, curves, names, markers;
//! - [`crate::evaluate`] (`panels.rs`, `operations.rs`, `reshape.rs`, `seams.rs`): faults of panels,
//!   operations and seams;
//! - [`crate::evaluate`] (`compute.rs`), [`crate::formula::Failure`]: formulas that need themselves; formulas
//!   that cannot be computed;
//! - [`crate::drafting`] (`report`), [`crate::check::check_draft`]: faults found in making the draft; checks
//!   of pieces, seam lengths and fabrics;
//! - [`crate::kinks`], [`crate::orientation`]: kinks across seams; pieces that show the wrong side of the
//!   cloth;
//! - [`crate::evaluate::Evaluation::diagnostics`]: all of them in order;
//! - [`crate::document::Pattern::describe`] (`describe.rs`): the place in words;
//! - [`crate::plan`] (`lookup.rs`, `refuse_faults`): an edit that would make an error is refused.
//!
//! Told by crate `session` (`derived.rs`, `perform.rs`), crate `cli` (`check_commands.rs`) and the window
//! (`app/mod.rs`, `app/findings.rs`). Further: cut lines in crate `cut` (`words.rs`), meshing in crate
//! `assembly`, files in crate `interchange`. By hand: what a click on a new `Place` selects (window,
//! `app/findings.rs`), tests `diagnostics.rs` and `causes.rs`.

use crate::{
    CurveId, EdgeId, FabricId, GuideId, LineId, MarkerId, NotchId, OperationId, PanelId, PointId,
    SeamId, SheetId, SizeId, VariableId,
};
use std::fmt;

/// Severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Information only: the garment can be made.
    Note,
    /// The garment can be made, but probably not as meant.
    Warning,
    /// The garment cannot be made.
    Error,
}

/// Kind of fault that a diagnostic reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Code {
    /// A formula has no value.
    Formula,
    /// The value of a formula or the position of a point depends on itself.
    Cycle,
    /// A spline cannot be drawn to the length that is set for it.
    OutOfReach,
    /// A measurement was not given and is taken from the pattern's base size.
    BorrowedMeasurement,
    /// A reference names a part that does not exist.
    MissingReference,
    /// Two parts have the same id or name.
    Duplicate,
    /// A number is infinite or not a number.
    NotFinite,
    /// A number is larger than any garment needs.
    TooLarge,
    /// The pattern has more parts than the program accepts.
    TooMany,
    /// An outline has no edges or encloses nothing.
    EmptyOutline,
    /// An edge does not start where the one before it ends.
    OpenOutline,
    /// An outline crosses or touches itself.
    SelfCrossing,
    /// An edge has no length.
    ZeroLengthEdge,
    /// A hole runs the same way round as its outline.
    HoleWinding,
    /// A hole is not inside its outline.
    HoleOutside,
    /// The fold line is not a straight edge of the outline.
    BadFold,
    /// An internal line reaches outside its panel: the cloth has what lies inside.
    LineOutside,
    /// A dart is wider than its edge, or overlaps another.
    DartTooWide,
    /// A dart's apex lies outside its panel.
    DartOutside,
    /// A dart cannot be trued: no smooth line leads across its mouth, or its legs would change too much.
    NotTrued,
    /// An edge that continues across a dart, a pleat or a seam has a kink there.
    Kink,
    /// A dart cannot be pivoted as asked.
    BadPivot,
    /// A panel cannot be cut along a curve or line.
    BadCut,
    /// A notch lies beyond its edge.
    NotchOffEdge,
    /// A seam names a span of an edge that does not exist.
    MissingSpan,
    /// The fractions of a span are not between 0 and 1, or the span has no length.
    BadSpan,
    /// The two sides of a seam differ by more than its ease.
    SeamLength,
    /// A panel is sewn to nothing.
    NotSewn,
    /// So that pieces show their right sides, seams take another copy of a mirrored pair, or another half of
    /// a folded panel, than the document gives.
    OtherCopy,
    /// A piece shows its wrong side, or pieces are sewn into a ring with one side only, as a Moebius band.
    InsideOut,
    /// A fabric has an impossible property.
    BadFabric,
    /// A seam allowance or other length is negative.
    Negative,
    /// A corner of the cut line is too sharp for a mitre: the mitre is cut off.
    SharpCorner,
    /// A corner of the cut line is too blunt for the shape that is asked for: it is mitred instead.
    BluntCorner,
    /// Along an edge the seam allowance runs into other cloth.
    AllowanceSwallowed,
    /// Along an edge the seam allowance is narrower than asked.
    AllowanceNarrow,
    /// The seam allowances along the two sides of a slit or a bay overlap.
    SlitShut,
    /// A hole is filled or divided by its seam allowance.
    HoleShut,
    /// The cut line cannot follow the cloth of a folded dart: it runs straight across the mouth.
    StraightDart,
    /// Notches are cut less deep than usual.
    NotchShort,
    /// Notches are drawn and not cut.
    NotchDrawn,
    /// A piece has no line to cut along.
    NoCutLine,
    /// A mirrored pair is cut an odd number of times.
    OddPair,
    /// The file has a field that this version does not know.
    UnknownField,
    /// The outline is too intricate: checking it takes more steps than are allowed.
    Unchecked,
    /// The garment is draped without folding and pressing a pleat.
    NotPressed,
    /// An operation takes in no cloth and leaves its panel unchanged.
    NoEffect,
}

/// The part of the pattern or the place in its file that a diagnostic is about.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// The pattern as a whole.
    Pattern,
    /// A size.
    Size(SizeId),
    /// A variable.
    Variable(VariableId),
    /// A sheet.
    Sheet(SheetId),
    /// A point of a sheet.
    Point(PointId),
    /// A curve of a sheet.
    Curve(CurveId),
    /// A panel.
    Panel(PanelId),
    /// A line of a panel: its outline, a hole or a line inside.
    Line(PanelId, LineId),
    /// An edge of a panel.
    Edge(PanelId, EdgeId),
    /// An operation of a panel.
    Operation(PanelId, OperationId),
    /// A notch of a panel.
    Notch(PanelId, NotchId),
    /// A seam.
    Seam(SeamId),
    /// An end of a seam: 0 its start, 1 its end.
    SeamEnd(SeamId, usize),
    /// A fabric.
    Fabric(FabricId),
    /// A marker.
    Marker(MarkerId),
    /// A guide.
    Guide(GuideId),
    /// A place in the file that the pattern was read from.
    File {
        /// Path of names and indices from the root, such as `panels.front.points`.
        path: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
    },
}

/// One fault or remark that a check reports.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Severity of the fault.
    pub severity: Severity,
    /// Kind of fault.
    pub code: Code,
    /// The part that is at fault.
    pub place: Place,
    /// Description of the fault, with the names of the parts.
    pub message: String,
    /// Advice on how to remedy the fault.
    pub hint: String,
}

impl Diagnostic {
    /// A diagnostic of the given severity.
    pub fn new(
        severity: Severity,
        code: Code,
        place: Place,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self {
            severity,
            code,
            place,
            message: message.into(),
            hint: hint.into(),
        }
    }

    pub(crate) fn error(
        code: Code,
        place: Place,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self::new(Severity::Error, code, place, message, hint)
    }

    pub(crate) fn warning(
        code: Code,
        place: Place,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self::new(Severity::Warning, code, place, message, hint)
    }
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        })
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.severity, self.message)?;
        if let Place::File { path, line, column } = &self.place {
            write!(f, " (line {line}, column {column}, at {path})")?;
        }
        write!(f, "; {}", self.hint)
    }
}
