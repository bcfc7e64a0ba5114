//! Panels: flat pieces of the garment, traced from a sheet.
//!
//! # Decided with
//! - [`crate::plan`] (`trace.rs`, `ALLOWANCE`), [`crate::document::edge_corner::EdgeCorner`]: allowance of a
//!   new panel; corners of the cut line;
//! - [`crate::evaluate`] (`panels.rs`, `PanelEvaluation`): allowance, grain and lines evaluated;
//! - [`crate::drafting`] (`panel`, `piece`): grain and allowance on the draft;
//! - [`crate::stage::Stage::mirror_image`]: grain turned over with a mirrored piece;
//! - [`crate::draft::Worn::mirror_image`]: which part of the body the mirrored piece is worn on;
//! - [`crate::plan::numbers_of`]: its numbers for the window.
//!
//! The grain is upright if a file does not give it. A side of a split panel has a grain of its own.

use crate::fields::{Choice, Clash, ITSELF, Told, ValueField, angle, group, key, length};
use crate::{
    BodyPart, CurveId, EdgeCorner, EdgeId, FabricId, Facing, LineId, Mark, NotchId, Number,
    Operation, OperationId, PanelId, PointId, SheetId, Side, fields,
};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;
use strum::{EnumIter, IntoEnumIterator, VariantArray, VariantNames};

/// One flat piece of the pattern.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// Identifier of the panel.
    pub id: PanelId,
    /// Name to show and for formulas, unique in the pattern.
    pub name: String,
    /// Source of the panel's shape: a sheet, or a side of another panel.
    pub source: Source,
    /// Outline, holes and internal lines. Seen from the right side of the cloth the outline runs
    /// counter-clockwise, holes clockwise.
    pub lines: Vec<Line>,
    /// Notches of the panel.
    pub notches: Vec<Notch>,
    /// Operations that alter the panel, in order.
    pub operations: Vec<Arc<Operation>>,
    /// Direction of the warp (rad), from +x counter-clockwise.
    pub grain: Number,
    /// Seam allowance of edges that do not have their own (m).
    pub allowance: Number,
    /// Number of pieces cut, and whether in mirrored pairs.
    pub cut: Cut,
    /// The fabric that the panel is cut from.
    pub fabric: FabricId,
    /// Place of the panel on the body.
    pub worn: WornRule,
    /// Displacement of the panel on the table from its place on the sheet (m), if the panel was moved.
    pub on_table: Option<[f64; 2]>,
}

impl Default for Panel {
    fn default() -> Self {
        Self::new(
            PanelId::default(),
            "",
            SheetId::default(),
            FabricId::default(),
        )
    }
}

fields!(Panel, |self, v| {
    let Self {
        id,
        name,
        source,
        lines,
        notches,
        operations,
        grain,
        allowance,
        cut,
        fabric,
        worn,
        on_table,
    } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.flat(source);
    v.id("fabric", fabric);
    v.part(group("cut").left_out_if(*cut == Cut::default()), cut);
    v.number(angle("grain").left_out_at(FRAC_PI_2), grain);
    v.number(
        length("allowance").label("seam allowance").left_out_at(0.0),
        allowance,
    );
    v.part(
        group("worn").left_out_if(*worn == WornRule::Automatic),
        worn,
    );
    v.optional("table", on_table);
    if let Some([x, y]) = on_table {
        v.list(group("table"), &mut |v| {
            v.value(key("x").length(), x);
            v.value(key("y").length(), y);
        });
    }
    v.each(group("lines"), lines);
    v.each(group("notches"), notches);
    v.each(group("operations"), operations);
});

/// Source of the shape of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumIter, Serialize, Deserialize)]
pub enum Source {
    /// The lines of the panel follow curves of a sheet.
    Traced(SheetId),
    /// The panel is one side of another panel that is split, and changes with it.
    Side {
        /// The panel that is split.
        of: PanelId,
        /// The operation that splits it.
        split: OperationId,
        /// The side of the split.
        side: Side,
    },
}

impl Default for Source {
    fn default() -> Self {
        Self::Traced(SheetId::default())
    }
}

fields!(
    Source,
    |self, v| {
        match self {
            Self::Traced(sheet) => v.id("sheet", sheet),
            Self::Side { of, split, side } => v.object(group("side"), &mut |v| {
                v.id("of", of);
                v.id("split", split);
                v.value(key("is"), side);
            }),
        }
    },
    kinds: |source| match source {
        Source::Traced(_) => Told::By(&[]),
        Source::Side { .. } => Told::Field("side"),
    },
    clash: Clash {
        two: Some([
            "a panel is traced from a sheet or a side of a panel, not both",
            "keep sheet or side",
        ]),
        ..Clash::default()
    },
);

/// A closed or open line of a panel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Identifier of the line.
    pub id: LineId,
    /// Name to show, unique among the panel's lines.
    pub name: String,
    /// Kind of line.
    pub kind: LineKind,
    /// The operation that inserts the line; `None`: the line belongs to the panel as drawn.
    pub by: Option<OperationId>,
    /// Edges of the line, in order.
    pub edges: Vec<Edge>,
}

fields!(Line, |self, v| {
    let Self {
        id,
        name,
        kind,
        by,
        edges,
    } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.value(key("kind"), kind);
    v.optional("by", by);
    if let Some(by) = by {
        v.id("by", by);
    }
    v.each(group("edges"), edges);
});

/// The kinds of lines of a panel.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    Default,
    VariantArray,
    VariantNames,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum LineKind {
    /// The closed outline.
    #[default]
    Outline,
    /// A closed hole.
    Hole,
    /// A line drawn inside.
    Internal,
}

/// A stretch of a curve between two of its points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Edge {
    /// Identifier of the edge.
    pub id: EdgeId,
    /// Name for seams and formulas, unique in the panel.
    pub name: String,
    /// The curve that the edge follows.
    pub curve: CurveId,
    /// Start and end of the edge: points on the curve. The edge may run against the curve.
    pub ends: [PointId; 2],
    /// Seam allowance of the edge (m); `None`: the allowance of the panel.
    pub allowance: Option<Number>,
    /// The corner at the start of the edge.
    pub corner: EdgeCorner,
}

fields!(Edge, |self, v| {
    let Self {
        id,
        name,
        curve,
        ends: [from, to],
        allowance,
        corner,
    } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.id("curve", curve);
    v.id("from", from);
    v.id("to", to);
    v.optional_number(length("allowance").label("seam allowance"), allowance);
    v.flat(corner);
});

/// A notch of a panel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Notch {
    /// Identifier of the notch.
    pub id: NotchId,
    /// Name to show.
    pub name: String,
    /// The line that the notch is on.
    pub line: LineId,
    /// Position of the notch on the line.
    pub at: Mark,
    /// Shape of the notch.
    pub kind: NotchKind,
}

fields!(Notch, |self, v| {
    let Self {
        id,
        name,
        line,
        at,
        kind,
    } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.id("line", line);
    v.mark(group("at"), at);
    v.value(key("kind").left_out_if(*kind == NotchKind::default()), kind);
});

/// The shape of a notch.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    Default,
    VariantArray,
    VariantNames,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum NotchKind {
    /// A short cut square to the edge.
    #[default]
    Slit,
    /// A cut in the shape of a V.
    V,
    /// A cut in the shape of a rectangle.
    Castle,
    /// A cut in the shape of a T.
    T,
    /// A cut in the shape of a check mark.
    Check,
}

/// Number of pieces cut from a panel.
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

/// One example for each form in which files write a cut: a number, `"pair"`, or both fields.
impl IntoEnumIterator for Cut {
    type Iterator = std::array::IntoIter<Self, 3>;

    fn iter() -> Self::Iterator {
        let forms = [(1, false), (2, true), (3, true)];
        forms
            .map(|(quantity, mirrored)| Self { quantity, mirrored })
            .into_iter()
    }
}

fields!(
    Cut,
    |self, v| {
        match self {
            Self { quantity: 2, mirrored: true } => v.word("pair"),
            Self { quantity, mirrored: false } => v.value(key(ITSELF), quantity),
            Self { quantity, mirrored } => {
                v.value(key("quantity"), quantity);
                v.value(key("mirrored").flag_if_absent(false), mirrored);
            }
        }
    },
    kinds: |cut| match cut {
        Cut { mirrored: false, .. } => Told::Number,
        Cut { quantity: 2, .. } => Told::Text,
        Cut { .. } => Told::By(&[]),
    }
);

impl Choice for LineKind {}
impl Choice for NotchKind {}

/// Place of a panel on the body before it is sewn.
#[derive(Clone, Debug, PartialEq, Default, EnumIter, Serialize, Deserialize)]
pub enum WornRule {
    /// No place is given: the program decides from the seams.
    #[default]
    Automatic,
    /// Wrapped round a body part. Mirrored copies go to the other side of the body.
    Wrapped {
        /// The body part.
        part: BodyPart,
        /// The side of the body part.
        facing: Facing,
        /// Height above the floor, or distance along an arm from the shoulder (m). `None`: the program
        /// decides.
        level: Option<Number>,
    },
    /// Placed in space by a transformation from the panel to the world. Mirrored copies are placed at the
    /// mirror image (x changes sign).
    Placed {
        /// Position of the panel's origin in space (m).
        translation: [f64; 3],
        /// Rotation: unit quaternion x, y, z, w.
        rotation: [f64; 4],
    },
}

fields!(
    WornRule,
    |self, v| {
        match self {
            Self::Automatic => {}
            Self::Wrapped { part, facing, level } => {
                v.value(key("part"), part);
                v.value(key("facing"), facing);
                v.optional_number(length("level").label("height on the body"), level);
            }
            Self::Placed { translation: [tx, ty, tz], rotation: [x, y, z, w] } => {
                v.list(group("translation_m"), &mut |v| {
                    v.value(key("x"), tx);
                    v.value(key("y"), ty);
                    v.value(key("z"), tz);
                });
                v.list(group("rotation_xyzw"), &mut |v| {
                    v.value(key("x"), x);
                    v.value(key("y"), y);
                    v.value(key("z"), z);
                    v.value(key("w"), w);
                });
            }
        }
    },
    kinds: |worn| match worn {
        WornRule::Automatic => Told::Never,
        WornRule::Placed { .. } => Told::Field("translation_m"),
        WornRule::Wrapped { .. } => Told::By(&[]),
    }
);

impl Panel {
    /// The notch with this id.
    pub fn notch(&self, id: NotchId) -> Option<&Notch> {
        self.notches.iter().find(|notch| notch.id == id)
    }

    /// Number of an operation, counted from 1 in the order in which operations are done.
    pub fn step_of(&self, operation: OperationId) -> Option<usize> {
        let mut operations = self.operations.iter();
        operations.position(|o| o.id == operation).map(|k| k + 1)
    }

    /// An empty panel of this fabric, traced from this sheet.
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

    /// The sheet that the panel is traced from. `None`: it is a side of another panel.
    pub fn sheet(&self) -> Option<SheetId> {
        match self.source {
            Source::Traced(sheet) => Some(sheet),
            Source::Side { .. } => None,
        }
    }

    /// The outline of the panel, if it has one.
    pub fn outline(&self) -> Option<&Line> {
        let mut lines = self.lines.iter();
        lines.find(|line| line.kind == LineKind::Outline)
    }

    /// All edges, line by line.
    pub fn edges(&self) -> impl Iterator<Item = &Edge> {
        self.lines.iter().flat_map(|line| &line.edges)
    }

    /// The edge with this id.
    pub fn edge(&self, id: EdgeId) -> Option<&Edge> {
        self.edges().find(|edge| edge.id == id)
    }

    /// The edge with this name.
    pub fn edge_named(&self, name: &str) -> Option<&Edge> {
        self.edges().find(|edge| edge.name == name)
    }

    /// The line with this id.
    pub fn line(&self, id: LineId) -> Option<&Line> {
        self.lines.iter().find(|line| line.id == id)
    }

    /// The line that an edge is on.
    pub fn line_of(&self, edge: EdgeId) -> Option<&Line> {
        let mut lines = self.lines.iter();
        lines.find(|line| line.edges.iter().any(|known| known.id == edge))
    }
}

impl Line {
    /// Whether the line is closed.
    pub fn is_closed(&self) -> bool {
        self.kind != LineKind::Internal
    }

    /// Edges of the line from the corner `from` to the later corner `to`; all edges if both are the same
    /// corner of a closed line. `None`: these are not corners of the line in this order.
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
