//! Panels: flat pieces of the garment, traced from a sheet.

use crate::{
    BodyPart, CurveId, EdgeId, FabricId, Facing, LineId, Mark, NotchId, Number, Operation,
    OperationId, PanelId, PointId, SheetId, Side,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// One flat piece of the pattern.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// Its id.
    pub id: PanelId,
    /// Name to show and for formulas, unique in the pattern.
    pub name: String,
    /// Where its shape comes from.
    pub source: Source,
    /// Its outline, holes and internal lines. The outline runs counter-clockwise seen from the
    /// right side of the cloth, holes against it.
    pub lines: Vec<Line>,
    /// Its notches.
    pub notches: Vec<Notch>,
    /// Its operations, in order.
    pub operations: Vec<Arc<Operation>>,
    /// Direction of the warp [rad], from +x counter-clockwise.
    pub grain: Number,
    /// Width of cloth outside edges that have no allowance of their own [m].
    pub allowance: Number,
    /// How often it is cut.
    pub cut: Cut,
    /// The fabric it is cut from.
    pub fabric: FabricId,
    /// Where on the body it belongs.
    pub worn: WornRule,
    /// How far it was moved on the table from where its sheet has it [m], if it was.
    pub on_table: Option<[f64; 2]>,
}

/// Where the shape of a panel comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Source {
    /// Its lines follow curves of a sheet.
    Traced(SheetId),
    /// It is a side of another panel, and follows that.
    Side {
        /// The panel.
        of: PanelId,
        /// The operation that splits it.
        split: OperationId,
        /// Which side.
        side: Side,
    },
}

/// A closed or open line of a panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Its id.
    pub id: LineId,
    /// Name to show, unique among the panel's lines.
    pub name: String,
    /// Its kind.
    pub kind: LineKind,
    /// The operation that inserts it; nothing for a line of the panel as drawn.
    pub by: Option<OperationId>,
    /// Its edges, in order.
    pub edges: Vec<Edge>,
}

/// The kinds of lines of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LineKind {
    /// The closed outline.
    Outline,
    /// A closed hole.
    Hole,
    /// A line drawn inside.
    Internal,
}

/// A stretch of a curve, from a point on it to another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Edge {
    /// Its id.
    pub id: EdgeId,
    /// Name for seams and formulas, unique in the panel.
    pub name: String,
    /// The curve it follows.
    pub curve: CurveId,
    /// Where it starts and ends: points on the curve. It may run against the curve.
    pub ends: [PointId; 2],
    /// Width of cloth outside it [m]; nothing means the panel's.
    pub allowance: Option<Number>,
    /// The corner at its start.
    pub corner: EdgeCorner,
}

/// What is asked of a corner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "WrittenCorner")]
pub struct EdgeCorner {
    /// How the cut line turns it.
    pub kind: Corner,
    /// How far the cut line may reach there.
    pub limit: MitreLimit,
    /// Whether a kink of the line that goes on there across a seam is meant.
    pub meant: bool,
}

/// A corner as a journal has it: of earlier versions its kind alone, or nothing.
#[derive(Deserialize)]
#[serde(untagged)]
enum WrittenCorner {
    Whole {
        kind: Corner,
        limit: MitreLimit,
        meant: bool,
    },
    Kind(Option<Corner>),
}

impl From<WrittenCorner> for EdgeCorner {
    fn from(written: WrittenCorner) -> Self {
        match written {
            WrittenCorner::Whole { kind, limit, meant } => Self { kind, limit, meant },
            WrittenCorner::Kind(kind) => Self {
                kind: kind.unwrap_or_default(),
                ..Self::default()
            },
        }
    }
}

/// How far from a corner its cut line may reach.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MitreLimit {
    /// So many times the wider of both allowances; beyond, it is cut off.
    Widths(f64),
    /// As far as both lines run.
    None,
}

impl MitreLimit {
    /// What is asked where nothing is: mitres down to 47 degrees are whole.
    pub const USUAL: f64 = 2.5;
    /// The least and the most that may be asked.
    pub const RANGE: [f64; 2] = [1.0, 100.0];
}

impl Default for MitreLimit {
    fn default() -> Self {
        Self::Widths(Self::USUAL)
    }
}

/// How a cut line turns a corner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Corner {
    /// Both lines run on until they meet.
    #[default]
    Mitre,
    /// Cut off straight.
    Bevel,
    /// Square to the edge after the corner.
    Square,
    /// The seam lines run on into the allowances.
    Extended,
    /// The neighbour's cut line mirrored in the edge after the corner, as a hem needs.
    Mirrored,
}

/// A notch of a panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Notch {
    /// Its id.
    pub id: NotchId,
    /// Name to show.
    pub name: String,
    /// The line it is on.
    pub line: LineId,
    /// Where on it.
    pub at: Mark,
    /// How it is cut or drawn.
    pub kind: NotchKind,
}

/// The shape of a notch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NotchKind {
    /// A short cut square to the edge.
    #[default]
    Slit,
    /// A V.
    V,
    /// A rectangle.
    Castle,
    /// A T.
    T,
    /// A check mark.
    Check,
}

/// How often a panel is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]

pub struct Cut {
    /// Number of pieces, copies 0 to `quantity - 1`.
    pub quantity: u32,
    /// Whether odd copies are mirror images.
    pub mirrored: bool,
}

impl Default for Cut {
    fn default() -> Self {
        Self {
            quantity: 1,
            mirrored: false,
        }
    }
}

/// Where a panel goes before it is sewn.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub enum WornRule {
    /// Nothing is known: the program decides from the seams.
    #[default]
    Automatic,
    /// Wrapped round a body part. Mirrored copies go to the other side of the body.
    Wrapped {
        /// The body part.
        part: BodyPart,
        /// Which side of it.
        facing: Facing,
        /// Height above the floor, or distance along an arm from the shoulder [m].
        level: Option<Number>,
    },
    /// Placed in space: world from panel. Mirrored copies go to the mirror place at -x.
    Placed {
        /// Where the panel's origin goes [m].
        translation: [f64; 3],
        /// Unit quaternion x, y, z, w.
        rotation: [f64; 4],
    },
}

impl Panel {
    /// The notch with that id.
    pub fn notch(&self, id: NotchId) -> Option<&Notch> {
        self.notches.iter().find(|notch| notch.id == id)
    }

    /// How many operations are done after one of them.
    pub fn step_of(&self, operation: OperationId) -> Option<usize> {
        let mut operations = self.operations.iter();
        operations.position(|o| o.id == operation).map(|k| k + 1)
    }

    /// An empty panel of that fabric, traced from that sheet.
    pub fn new(id: PanelId, name: impl Into<String>, sheet: SheetId, fabric: FabricId) -> Self {
        Self {
            id,
            name: name.into(),
            source: Source::Traced(sheet),
            lines: Vec::new(),
            notches: Vec::new(),
            operations: Vec::new(),
            grain: Number::Value(std::f64::consts::FRAC_PI_2),
            allowance: Number::ZERO,
            cut: Cut::default(),
            fabric,
            worn: WornRule::Automatic,
            on_table: None,
        }
    }

    /// The sheet its lines are traced from; nothing if it is a side of another panel.
    pub fn sheet(&self) -> Option<SheetId> {
        match self.source {
            Source::Traced(sheet) => Some(sheet),
            Source::Side { .. } => None,
        }
    }

    /// The outline, if there is one.
    pub fn outline(&self) -> Option<&Line> {
        let mut lines = self.lines.iter();
        lines.find(|line| line.kind == LineKind::Outline)
    }

    /// Every edge, line by line.
    pub fn edges(&self) -> impl Iterator<Item = &Edge> {
        self.lines.iter().flat_map(|line| &line.edges)
    }

    /// The edge with that id.
    pub fn edge(&self, id: EdgeId) -> Option<&Edge> {
        self.edges().find(|edge| edge.id == id)
    }

    /// The edge with that name.
    pub fn edge_named(&self, name: &str) -> Option<&Edge> {
        self.edges().find(|edge| edge.name == name)
    }

    /// The line with that id.
    pub fn line(&self, id: LineId) -> Option<&Line> {
        self.lines.iter().find(|line| line.id == id)
    }

    /// The line an edge is on.
    pub fn line_of(&self, edge: EdgeId) -> Option<&Line> {
        let mut lines = self.lines.iter();
        lines.find(|line| line.edges.iter().any(|known| known.id == edge))
    }

    /// Every number of the panel, its operations included.
    pub fn numbers(&self) -> Vec<&Number> {
        let mut numbers = vec![&self.grain, &self.allowance];
        numbers.extend(self.edges().filter_map(|edge| edge.allowance.as_ref()));
        numbers.extend(self.notches.iter().filter_map(|notch| notch.at.number()));
        numbers.extend(self.operations.iter().flat_map(|o| o.kind.numbers()));
        if let WornRule::Wrapped {
            level: Some(level), ..
        } = &self.worn
        {
            numbers.push(level);
        }
        numbers
    }
}

impl Line {
    /// Whether it is closed.
    pub fn is_closed(&self) -> bool {
        self.kind != LineKind::Internal
    }

    /// Its edges from a corner to one that follows it, all of them where both are the same corner
    /// of a closed line; nothing if either is not a corner of the line in that order.
    pub fn stretch(&self, [from, to]: [PointId; 2]) -> Option<Vec<&Edge>> {
        let first = self.edges.iter().position(|edge| edge.ends[0] == from)?;
        let count = self.edges.len();
        let reach = if self.is_closed() {
            count
        } else {
            count - first
        };
        let mut edges = Vec::new();
        for k in 0..reach {
            let edge = &self.edges[(first + k) % count];
            edges.push(edge);
            if edge.ends[1] == to {
                return Some(edges);
            }
        }
        None
    }
}
