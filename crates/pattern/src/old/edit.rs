//! Edits: every change a document can undergo, in absolute values.

use crate::{
    Cut, Dart, DartId, DisplayUnit, EdgeCurve, EdgeId, Fabric, FabricId, InternalLine,
    InternalLineId, Notch, NotchId, Number, Panel, PanelId, Point, PointId, PointPlace, Seam,
    SeamId, Size, Variable, WornRule,
};
use serde::{Deserialize, Serialize};

/// One change of a pattern. Values are absolute, so that an edit means the same whenever it is
/// applied. `Put` edits add a part, or replace the one with the same id; `at` is its place in the
/// list, counted from 0 and clamped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edit {
    /// Several edits, all or none.
    Many(Vec<Edit>),
    /// Names the pattern.
    SetName(String),
    /// Chooses the unit lengths are written in.
    SetUnit(DisplayUnit),
    /// Chooses the size used when none is asked for.
    SetBaseSize(Option<String>),
    /// Adds a size or replaces the one of that name.
    PutSize {
        /// Place in the list.
        at: usize,
        /// The size.
        size: Size,
    },
    /// Removes a size.
    RemoveSize(String),
    /// Sets or removes one measurement of a size [m] or [rad].
    SetMeasurement {
        /// Name of the size.
        size: String,
        /// Name of the measurement.
        name: String,
        /// Its value, or nothing.
        value: Option<f64>,
    },
    /// Adds a variable or replaces the one of that name.
    PutVariable {
        /// Place in the list.
        at: usize,
        /// The variable.
        variable: Variable,
    },
    /// Removes a variable.
    RemoveVariable(String),
    /// Renames a variable, in formulas too.
    RenameVariable {
        /// Its name so far.
        from: String,
        /// Its new name.
        to: String,
    },
    /// Adds or replaces a fabric.
    PutFabric {
        /// Place in the list.
        at: usize,
        /// The fabric.
        fabric: Fabric,
    },
    /// Removes a fabric that no panel uses.
    RemoveFabric(FabricId),
    /// Adds or replaces a panel.
    PutPanel {
        /// Place in the list.
        at: usize,
        /// The panel.
        panel: Box<Panel>,
    },
    /// Removes a panel and every seam that names it.
    RemovePanel(PanelId),
    /// Adds or replaces a seam.
    PutSeam {
        /// Place in the list.
        at: usize,
        /// The seam.
        seam: Seam,
    },
    /// Removes a seam.
    RemoveSeam(SeamId),
    /// Changes something inside a panel.
    InPanel {
        /// The panel.
        panel: PanelId,
        /// The change.
        edit: PanelEdit,
    },
}

/// One change inside a panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PanelEdit {
    /// Renames the panel, in formulas too.
    Rename(String),
    /// Renames a point, in formulas too.
    RenamePoint {
        /// The point.
        point: PointId,
        /// Its new name.
        name: String,
    },
    /// Renames an edge, in formulas too.
    RenameEdge {
        /// The edge.
        edge: EdgeId,
        /// Its new name.
        name: String,
    },
    /// Puts a point somewhere else.
    MovePoint {
        /// The point.
        point: PointId,
        /// Its new place.
        place: PointPlace,
    },
    /// Adds a point that no edge uses yet, or replaces one.
    PutPoint {
        /// Place in the list.
        at: usize,
        /// The point.
        point: Point,
    },
    /// Removes a point that nothing uses.
    RemovePoint(PointId),
    /// Divides an edge at a new corner. Seams, notches and darts stay where they are.
    SplitEdge {
        /// The edge; it keeps its first part.
        edge: EdgeId,
        /// Fraction of its arc length where it is divided.
        at: f64,
        /// The new corner first, then new control points.
        points: Vec<Point>,
        /// How both parts run.
        curves: [EdgeCurve; 2],
        /// Id of the second part.
        new_edge: EdgeId,
        /// Name of the second part.
        name: String,
    },
    /// Removes a corner: the edge after it becomes part of the edge before it.
    JoinEdges {
        /// The corner.
        point: PointId,
        /// The first edge's share of the joined length.
        at: f64,
    },
    /// Changes how an edge runs.
    SetEdgeCurve {
        /// The edge.
        edge: EdgeId,
        /// How it runs.
        curve: EdgeCurve,
    },
    /// Changes the allowance of an edge [m]; nothing means the panel's.
    SetEdgeAllowance {
        /// The edge.
        edge: EdgeId,
        /// The allowance.
        allowance: Option<Number>,
    },
    /// Changes the allowance of edges that have none of their own [m].
    SetSeamAllowance(Number),
    /// Adds or replaces a dart.
    PutDart(Dart),
    /// Removes a dart.
    RemoveDart(DartId),
    /// Adds or replaces a notch.
    PutNotch(Notch),
    /// Removes a notch.
    RemoveNotch(NotchId),
    /// Adds or replaces an internal line.
    PutInternalLine(InternalLine),
    /// Removes an internal line.
    RemoveInternalLine(InternalLineId),
    /// Turns the grainline [rad].
    SetGrain(Number),
    /// Chooses the fold line.
    SetFold(Option<EdgeId>),
    /// Changes how often the panel is cut.
    SetCut(Cut),
    /// Changes the fabric the panel is cut from.
    SetFabric(FabricId),
    /// Changes where on the body the panel belongs.
    SetWorn(WornRule),
}

/// Why an edit was refused. The document is unchanged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditError {
    /// A part it names is not there.
    #[error("{0} is not there: choose one that is")]
    Missing(String),
    /// A name cannot be used.
    #[error(
        "{0:?} cannot be a name: use 1 to 80 characters without quotes, control characters or spaces at the ends"
    )]
    Name(String),
    /// A name or id is taken.
    #[error("{0} is taken: choose another")]
    Taken(String),
    /// A number is not finite.
    #[error("{0} has a number that is not finite: give a finite one")]
    NotFinite(String),
    /// Something still needs the part.
    #[error("{what} is used by {by}: change that first")]
    InUse {
        /// The part.
        what: String,
        /// What needs it.
        by: String,
    },
    /// The edit makes no sense here.
    #[error("{message}: {hint}")]
    Impossible {
        /// What is wrong.
        message: String,
        /// What to do.
        hint: String,
    },
}
