//! Panels: flat pieces of the garment, traced from a sheet.

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
    /// Direction of the warp (rad), from +x counter-clockwise.
    pub grain: Number,
    /// Width of cloth outside edges that have no allowance of their own (m).
    pub allowance: Number,
    /// How often it is cut.
    pub cut: Cut,
    /// The fabric it is cut from.
    pub fabric: FabricId,
    /// Where on the body it belongs.
    pub worn: WornRule,
    /// How far it was moved on the table from where its sheet has it (m), if it was.
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

/// Where the shape of a panel comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumIter, Serialize, Deserialize)]
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

/// A stretch of a curve, from a point on it to another.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Edge {
    /// Its id.
    pub id: EdgeId,
    /// Name for seams and formulas, unique in the panel.
    pub name: String,
    /// The curve it follows.
    pub curve: CurveId,
    /// Where it starts and ends: points on the curve. It may run against the curve.
    pub ends: [PointId; 2],
    /// Width of cloth outside it (m); nothing means the panel's.
    pub allowance: Option<Number>,
    /// The corner at its start.
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

/// One for each form in which it is written: a number, `"pair"`, both fields.
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

/// Where a panel goes before it is sewn.
#[derive(Clone, Debug, PartialEq, Default, EnumIter, Serialize, Deserialize)]
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
        /// Height above the floor, or distance along an arm from the shoulder (m).
        level: Option<Number>,
    },
    /// Placed in space: world from panel. Mirrored copies go to the mirror place at -x.
    Placed {
        /// Where the panel's origin goes (m).
        translation: [f64; 3],
        /// Unit quaternion x, y, z, w.
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
