//! The document of version 1: parts by their numbers, formulas as text.

use super::super::item::Written;
use toile_measure::Measurements;
use toile_pattern::{BodyPart, Cut, DisplayUnit, Fabric, Facing};

/// A value [m], [rad] or plain, or the text of a formula.
#[derive(Clone, Debug, PartialEq)]
pub enum Number {
    /// A value.
    Value(f64),
    /// A formula.
    Formula(String),
}

impl Number {
    /// Zero.
    pub const ZERO: Self = Self::Value(0.0);
}

impl From<f64> for Number {
    fn from(value: f64) -> Self {
        Self::Value(value)
    }
}

/// A pattern. Cloning is cheap: panels and seams are shared until they are edited.
///
/// Fields are public, so a pattern may be inconsistent; `resolve` and `check` then say where.
#[derive(Clone, Debug, Default)]
pub struct Pattern {
    /// Name to show.
    pub name: String,
    /// Unit its author thinks in; values in memory are metres all the same.
    pub unit: DisplayUnit,
    /// Named tables of measurements, in the order they are offered.
    pub sizes: Vec<Size>,
    /// Name of the size used when none is asked for; else the first.
    pub base_size: Option<String>,
    /// Named numbers for formulas.
    pub variables: Vec<Variable>,
    /// The panels.
    pub panels: Vec<Panel>,
    /// The seams.
    pub seams: Vec<Seam>,
    /// The fabrics panels name.
    pub fabrics: Vec<Fabric>,
}

/// A named table of measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct Size {
    /// Name, such as `M` or `42`.
    pub name: String,
    /// Its measurements.
    pub measurements: Measurements,
}

/// A named number that formulas may use. A bare value is a plain number; a length is written as a
/// formula with a unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Name in formulas.
    pub name: String,
    /// What it stands for.
    pub number: Number,
}

/// One flat piece of the pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Its id.
    pub id: u32,
    /// Name to show and for formulas, unique in the pattern.
    pub name: String,
    /// Every point of it: corners, control points, construction points.
    pub points: Vec<Point>,
    /// The closed outline, in order; counter-clockwise seen from the right side of the cloth.
    pub outline: Vec<Edge>,
    /// Closed holes, wound against the outline.
    pub holes: Vec<Vec<Edge>>,
    /// Lines drawn inside it.
    pub internal_lines: Vec<InternalLine>,
    /// Its darts.
    pub darts: Vec<Dart>,
    /// Its notches.
    pub notches: Vec<Notch>,
    /// Direction of the warp [rad], from +x counter-clockwise.
    pub grain: Number,
    /// A straight edge that lies on the fold of the cloth: the piece is the panel and its mirror
    /// image, unfolded.
    pub fold: Option<u32>,
    /// Width of cloth outside edges that have no allowance of their own [m].
    pub seam_allowance: Number,
    /// How often it is cut.
    pub cut: Cut,
    /// The fabric it is cut from.
    pub fabric: u32,
    /// Where on the body it belongs.
    pub worn: WornRule,
}

/// A point of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Its id.
    pub id: u32,
    /// Name for formulas, unique in the panel.
    pub name: String,
    /// Where it is.
    pub place: PointPlace,
}

/// Where a point is: its coordinates, or how it is constructed from other parts of its panel.
#[derive(Clone, Debug, PartialEq)]
pub enum PointPlace {
    /// At coordinates of the panel's plane.
    At {
        /// To the right [m].
        x: Number,
        /// Upward [m].
        y: Number,
    },
    /// Beside another point.
    Offset {
        /// The other point.
        base: u32,
        /// To the right of it [m].
        x: Number,
        /// Above it [m].
        y: Number,
    },
    /// At a distance from another point.
    Polar {
        /// The other point.
        base: u32,
        /// Direction [rad], from +x counter-clockwise.
        angle: Number,
        /// How far [m].
        distance: Number,
    },
    /// In the frame of two points: `base + along (tip - base) + aside (tip - base turned left)`.
    Between {
        /// Origin of the frame.
        base: u32,
        /// End of its unit axis.
        tip: u32,
        /// Plain fraction of the way.
        along: Number,
        /// Plain fraction of the same length to the left of the way.
        aside: Number,
    },
    /// On the line through two points, at a distance from the first.
    Toward {
        /// Where to start.
        base: u32,
        /// Where to go.
        tip: u32,
        /// How far [m].
        distance: Number,
    },
    /// On an edge of the panel.
    OnEdge {
        /// The edge.
        edge: u32,
        /// Fraction of its arc length.
        at: Number,
    },
    /// Where the lines through two pairs of points meet.
    Crossing {
        /// The first line.
        first: [u32; 2],
        /// The second line.
        second: [u32; 2],
    },
    /// The mirror image of a point in the line through two others.
    Mirrored {
        /// The point.
        base: u32,
        /// The mirror.
        line: [u32; 2],
    },
}

/// One edge of an outline or hole.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Its id.
    pub id: u32,
    /// Name for seams and formulas, unique in the panel.
    pub name: String,
    /// Where it starts and ends.
    pub ends: [u32; 2],
    /// How it runs between them.
    pub curve: EdgeCurve,
    /// Width of cloth outside it [m]; nothing means the panel's.
    pub seam_allowance: Option<Number>,
}

/// How an edge runs between its ends.
#[derive(Clone, Debug, PartialEq, Default)]
pub enum EdgeCurve {
    /// Straight.
    #[default]
    Line,
    /// A circular arc.
    Arc {
        /// Tangent of a quarter of the swept angle; positive turns counter-clockwise, 1 is a
        /// half circle.
        bulge: Number,
    },
    /// A quadratic Bezier curve.
    Quadratic {
        /// Its control point.
        control: u32,
    },
    /// A cubic Bezier curve.
    Cubic {
        /// Its control points.
        controls: [u32; 2],
    },
}

/// Two chains of edge spans that are sewn together, start to start.
#[derive(Clone, Debug, PartialEq)]
pub struct Seam {
    /// Its id.
    pub id: u32,
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

/// A stretch of an edge on one copy of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// The panel.
    pub panel: u32,
    /// Its copy, from 0.
    pub copy: u32,
    /// The edge.
    pub edge: u32,
    /// Whether it is the edge's mirror image on the other half of a folded panel.
    pub reflected: bool,
    /// Fraction of the edge's arc length where the span starts. Fractions follow the edge as it
    /// is drawn, on mirrored copies and halves too.
    pub from: Number,
    /// Fraction where it ends; less than `from` walks the edge backwards.
    pub to: Number,
}

/// A line inside a panel that is drawn, cut or sewn on.
#[derive(Clone, Debug, PartialEq)]
pub struct InternalLine {
    /// Its id.
    pub id: u32,
    /// Name to show.
    pub name: String,
    /// Joined pieces, each with its ends.
    pub segments: Vec<LineSegment>,
}

/// One piece of an internal line.
#[derive(Clone, Debug, PartialEq)]
pub struct LineSegment {
    /// Where it starts and ends.
    pub ends: [u32; 2],
    /// How it runs between them.
    pub curve: EdgeCurve,
}

/// A dart.
#[derive(Clone, Debug, PartialEq)]
pub struct Dart {
    /// Its id.
    pub id: u32,
    /// Name to show.
    pub name: String,
    /// Where and how large.
    pub shape: DartShape,
}

/// Where a dart is and how large.
#[derive(Clone, Debug, PartialEq)]
pub enum DartShape {
    /// Taken out of an edge, which is drawn with the dart's mouth in it.
    Edge {
        /// The edge of the outline.
        edge: u32,
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
        ends: [u32; 2],
        /// Fraction of the way where it is widest.
        at: Number,
        /// Width there [m].
        width: Number,
    },
}

/// Where the dart of an edge ends.
#[derive(Clone, Debug, PartialEq)]
pub enum DartTip {
    /// So far from the middle of the mouth, square to it [m].
    Depth(Number),
    /// At a point of the panel.
    Apex(u32),
}

/// A mark on an edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Notch {
    /// Its id.
    pub id: u32,
    /// Name to show.
    pub name: String,
    /// The edge of the outline or a hole.
    pub edge: u32,
    /// Where on it.
    pub at: Along,
}

/// A place along an edge.
#[derive(Clone, Debug, PartialEq)]
pub enum Along {
    /// Fraction of the arc length from the start.
    Fraction(Number),
    /// Distance along the edge from its start, or from its end if negative [m].
    Distance(Number),
}

/// Where a panel goes before it is sewn.
#[derive(Clone, Debug, PartialEq, Default)]
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
    /// An empty panel of that fabric.
    pub fn new(id: u32, name: &str, fabric: u32) -> Self {
        Self {
            id,
            name: name.into(),
            points: Vec::new(),
            outline: Vec::new(),
            holes: Vec::new(),
            internal_lines: Vec::new(),
            darts: Vec::new(),
            notches: Vec::new(),
            grain: Number::Value(std::f64::consts::FRAC_PI_2),
            fold: None,
            seam_allowance: Number::ZERO,
            cut: Cut::default(),
            fabric,
            worn: WornRule::Automatic,
        }
    }

    /// Every edge: the outline's, then each hole's.
    pub fn edges(&self) -> impl Iterator<Item = &Edge> {
        self.outline.iter().chain(self.holes.iter().flatten())
    }

    /// The edge with that name.
    pub fn edge_named(&self, name: &str) -> Option<&Edge> {
        self.edges().find(|edge| edge.name == name)
    }
}

impl Span {
    /// The whole edge of copy 0, in its own direction.
    pub fn whole(panel: u32, edge: u32) -> Self {
        Self {
            panel,
            copy: 0,
            edge,
            reflected: false,
            from: Number::Value(0.0),
            to: Number::Value(1.0),
        }
    }
}

impl From<Written<'_>> for Number {
    fn from(written: Written<'_>) -> Self {
        match written {
            Written::Value(value) => Self::Value(value),
            Written::Formula(text) => Self::Formula(text.to_owned()),
        }
    }
}
