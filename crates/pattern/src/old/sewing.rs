//! What turns flat panels into a garment: seams, darts, notches, lines, places on the body.

use crate::{
    BodyPart, DartId, EdgeCurve, EdgeId, Facing, InternalLineId, NotchId, Number, PanelId, PointId,
    SeamId,
};
use serde::{Deserialize, Serialize};

/// Two chains of edge spans that are sewn together, start to start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seam {
    /// Its id.
    pub id: SeamId,
    /// Name to show.
    pub name: String,
    /// Both chains, each in walking order.
    pub sides: [Vec<Span>; 2],
    /// How much longer one side may be than the other [m].
    pub ease: Number,
    /// Whether the longer side is gathered to fit the shorter, whatever its length.
    pub gathered: bool,
    /// Whether right sides lie together while it is sewn: the usual seam.
    pub right_sides_together: bool,
    /// Whether more than two plies may meet here.
    pub multi_ply: bool,
}

impl Seam {
    /// A usual seam without ease.
    pub fn new(id: SeamId, name: impl Into<String>, sides: [Vec<Span>; 2]) -> Self {
        Self {
            id,
            name: name.into(),
            sides,
            ease: Number::ZERO,
            gathered: false,
            right_sides_together: true,
            multi_ply: false,
        }
    }

    /// The spans of both sides.
    pub fn spans(&self) -> impl Iterator<Item = &Span> {
        self.sides.iter().flatten()
    }
}

/// A stretch of an edge on one copy of a panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Span {
    /// The panel.
    pub panel: PanelId,
    /// Its copy, from 0.
    pub copy: u32,
    /// The edge.
    pub edge: EdgeId,
    /// Whether it is the edge's mirror image on the other half of a folded panel.
    pub reflected: bool,
    /// Fraction of the edge's arc length where the span starts. Fractions follow the edge as it
    /// is drawn, on mirrored copies and halves too.
    pub from: Number,
    /// Fraction where it ends; less than `from` walks the edge backwards.
    pub to: Number,
}

impl Span {
    /// The whole edge of copy 0, in its own direction.
    pub fn whole(panel: PanelId, edge: EdgeId) -> Self {
        Self {
            panel,
            copy: 0,
            edge,
            reflected: false,
            from: Number::Value(0.0),
            to: Number::Value(1.0),
        }
    }

    /// The same span walked the other way.
    pub fn reversed(self) -> Self {
        Self {
            from: self.to,
            to: self.from,
            ..self
        }
    }
}

/// A line inside a panel that is drawn, cut or sewn on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InternalLine {
    /// Its id.
    pub id: InternalLineId,
    /// Name to show.
    pub name: String,
    /// Joined pieces, each with its ends.
    pub segments: Vec<LineSegment>,
}

/// One piece of an internal line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LineSegment {
    /// Where it starts and ends.
    pub ends: [PointId; 2],
    /// How it runs between them.
    pub curve: EdgeCurve,
}

/// A dart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dart {
    /// Its id.
    pub id: DartId,
    /// Name to show.
    pub name: String,
    /// Where and how large.
    pub shape: DartShape,
}

/// Where a dart is and how large.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DartShape {
    /// Taken out of an edge, which is drawn with the dart's mouth in it.
    Edge {
        /// The edge of the outline.
        edge: EdgeId,
        /// Fraction of the edge's arc length where the middle of the mouth is.
        at: Number,
        /// Width of the mouth along the edge [m].
        width: Number,
        /// Where it ends.
        tip: DartTip,
    },
    /// A diamond inside the panel, widest between its two ends.
    Diamond {
        /// Its two ends.
        ends: [PointId; 2],
        /// Fraction of the way where it is widest.
        at: Number,
        /// Width there [m].
        width: Number,
    },
}

/// Where the dart of an edge ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DartTip {
    /// So far from the middle of the mouth, square to it [m].
    Depth(Number),
    /// At a point of the panel.
    Apex(PointId),
}

/// A mark on an edge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Notch {
    /// Its id.
    pub id: NotchId,
    /// Name to show.
    pub name: String,
    /// The edge of the outline or a hole.
    pub edge: EdgeId,
    /// Where on it.
    pub at: Along,
}

/// A place along an edge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Along {
    /// Fraction of the arc length from the start.
    Fraction(Number),
    /// Distance along the edge from its start, or from its end if negative [m].
    Distance(Number),
}

/// Where a panel goes before it is sewn.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
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
