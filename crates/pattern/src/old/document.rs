//! The document: what is edited, saved and undone.

use crate::{
    Dart, EdgeId, Fabric, FabricId, IdCounters, InternalLine, Notch, Number, PanelId, PointId,
    Seam, SeamId, WornRule,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toile_measure::Measurements;

/// Longest name of a part [characters].
pub const NAME_LENGTH: usize = 80;

/// A pattern. Cloning is cheap: panels and seams are shared until they are edited.
///
/// Fields are public, so a pattern may be inconsistent; `resolve` and `check` then say where.
#[derive(Clone, Debug, Default, PartialEq)]
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
    pub panels: Vec<Arc<Panel>>,
    /// The seams.
    pub seams: Vec<Arc<Seam>>,
    /// The fabrics panels name.
    pub fabrics: Vec<Arc<Fabric>>,
    /// The next free ids.
    pub ids: IdCounters,
}

/// The unit lengths are shown and written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DisplayUnit {
    /// Millimetres.
    Millimetre,
    /// Centimetres.
    #[default]
    Centimetre,
    /// Metres.
    Metre,
    /// Inches.
    Inch,
}

/// A named table of measurements.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Size {
    /// Name, such as `M` or `42`.
    pub name: String,
    /// Its measurements.
    pub measurements: Measurements,
}

/// A named number that formulas may use. A bare value is a plain number; a length is written as a
/// formula with a unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variable {
    /// Name in formulas.
    pub name: String,
    /// What it stands for.
    pub number: Number,
}

/// One flat piece of the pattern.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// Its id.
    pub id: PanelId,
    /// Name to show and for formulas, unique in the pattern.
    pub name: String,
    /// Every point of it: corners, control points, construction points.
    pub points: Vec<Point>,
    /// The closed outline, in order; counter-clockwise seen from the right side of the cloth.
    pub outline: Vec<Edge>,
    /// Closed holes, wound against the outline.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub holes: Vec<Vec<Edge>>,
    /// Lines drawn inside it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub internal_lines: Vec<InternalLine>,
    /// Its darts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub darts: Vec<Dart>,
    /// Its notches.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notches: Vec<Notch>,
    /// Direction of the warp [rad], from +x counter-clockwise.
    pub grain: Number,
    /// A straight edge that lies on the fold of the cloth: the piece is the panel and its mirror
    /// image, unfolded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fold: Option<EdgeId>,
    /// Width of cloth outside edges that have no allowance of their own [m].
    pub seam_allowance: Number,
    /// How often it is cut.
    pub cut: Cut,
    /// The fabric it is cut from.
    pub fabric: FabricId,
    /// Where on the body it belongs.
    pub worn: WornRule,
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

/// A point of a panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Its id.
    pub id: PointId,
    /// Name for formulas, unique in the panel.
    pub name: String,
    /// Where it is.
    pub place: PointPlace,
}

/// Where a point is: its coordinates, or how it is constructed from other parts of its panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
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
        base: PointId,
        /// To the right of it [m].
        x: Number,
        /// Above it [m].
        y: Number,
    },
    /// At a distance from another point.
    Polar {
        /// The other point.
        base: PointId,
        /// Direction [rad], from +x counter-clockwise.
        angle: Number,
        /// How far [m].
        distance: Number,
    },
    /// In the frame of two points: `base + along (tip - base) + aside (tip - base turned left)`.
    Between {
        /// Origin of the frame.
        base: PointId,
        /// End of its unit axis.
        tip: PointId,
        /// Plain fraction of the way.
        along: Number,
        /// Plain fraction of the same length to the left of the way.
        aside: Number,
    },
    /// On the line through two points, at a distance from the first.
    Toward {
        /// Where to start.
        base: PointId,
        /// Where to go.
        tip: PointId,
        /// How far [m].
        distance: Number,
    },
    /// On an edge of the panel.
    OnEdge {
        /// The edge.
        edge: EdgeId,
        /// Fraction of its arc length.
        at: Number,
    },
    /// Where the lines through two pairs of points meet.
    Crossing {
        /// The first line.
        first: [PointId; 2],
        /// The second line.
        second: [PointId; 2],
    },
    /// The mirror image of a point in the line through two others.
    Mirrored {
        /// The point.
        base: PointId,
        /// The mirror.
        line: [PointId; 2],
    },
}

impl PointPlace {
    /// A point at fixed coordinates [m].
    pub fn at(x: f64, y: f64) -> Self {
        Self::At {
            x: x.into(),
            y: y.into(),
        }
    }

    /// Points it is constructed from.
    pub fn bases(&self) -> Vec<PointId> {
        match *self {
            Self::At { .. } | Self::OnEdge { .. } => vec![],
            Self::Offset { base, .. } | Self::Polar { base, .. } => vec![base],
            Self::Between { base, tip, .. } | Self::Toward { base, tip, .. } => vec![base, tip],
            Self::Crossing { first, second } => [first, second].concat(),
            Self::Mirrored { base, line } => vec![base, line[0], line[1]],
        }
    }

    /// Its numbers, for reading and rewriting.
    pub(crate) fn numbers_mut(&mut self) -> Vec<&mut Number> {
        match self {
            Self::At { x, y } | Self::Offset { x, y, .. } => vec![x, y],
            Self::Polar {
                angle, distance, ..
            } => vec![angle, distance],
            Self::Between { along, aside, .. } => vec![along, aside],
            Self::Toward { distance, .. } => vec![distance],
            Self::OnEdge { at, .. } => vec![at],
            Self::Crossing { .. } | Self::Mirrored { .. } => vec![],
        }
    }
}

/// One edge of an outline or hole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Edge {
    /// Its id.
    pub id: EdgeId,
    /// Name for seams and formulas, unique in the panel.
    pub name: String,
    /// Where it starts and ends.
    pub ends: [PointId; 2],
    /// How it runs between them.
    pub curve: EdgeCurve,
    /// Width of cloth outside it [m]; nothing means the panel's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seam_allowance: Option<Number>,
}

/// How an edge runs between its ends.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
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
        control: PointId,
    },
    /// A cubic Bezier curve.
    Cubic {
        /// Its control points.
        controls: [PointId; 2],
    },
}

impl EdgeCurve {
    /// Its control points.
    pub fn controls(&self) -> &[PointId] {
        match self {
            Self::Line | Self::Arc { .. } => &[],
            Self::Quadratic { control } => std::slice::from_ref(control),
            Self::Cubic { controls } => controls,
        }
    }
}

impl Panel {
    /// An empty panel of that fabric.
    pub fn new(id: PanelId, name: impl Into<String>, fabric: FabricId) -> Self {
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

    /// The edge with that id.
    pub fn edge(&self, id: EdgeId) -> Option<&Edge> {
        self.edges().find(|edge| edge.id == id)
    }

    /// The edge with that name.
    pub fn edge_named(&self, name: &str) -> Option<&Edge> {
        self.edges().find(|edge| edge.name == name)
    }

    /// The point with that id.
    pub fn point(&self, id: PointId) -> Option<&Point> {
        self.points.iter().find(|point| point.id == id)
    }

    /// The point with that name.
    pub fn point_named(&self, name: &str) -> Option<&Point> {
        self.points.iter().find(|point| point.name == name)
    }

    pub(crate) fn edge_mut(&mut self, id: EdgeId) -> Option<&mut Edge> {
        self.outline
            .iter_mut()
            .chain(self.holes.iter_mut().flatten())
            .find(|edge| edge.id == id)
    }
}

impl Pattern {
    /// An empty pattern.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..Self::default()
        }
    }

    /// Whether another pattern is the same, whatever ids each would give next.
    pub fn says_the_same(&self, other: &Self) -> bool {
        let counted_alike = Self {
            ids: other.ids,
            ..self.clone()
        };
        counted_alike == *other
    }

    /// The panel with that id.
    pub fn panel(&self, id: PanelId) -> Option<&Panel> {
        self.panels
            .iter()
            .find(|panel| panel.id == id)
            .map(|p| &**p)
    }

    /// The panel with that name.
    pub fn panel_named(&self, name: &str) -> Option<&Panel> {
        self.panels
            .iter()
            .find(|panel| panel.name == name)
            .map(|p| &**p)
    }

    /// The seam with that id.
    pub fn seam(&self, id: SeamId) -> Option<&Seam> {
        self.seams.iter().find(|seam| seam.id == id).map(|s| &**s)
    }

    /// The fabric with that id.
    pub fn fabric(&self, id: FabricId) -> Option<&Fabric> {
        self.fabrics
            .iter()
            .find(|fabric| fabric.id == id)
            .map(|f| &**f)
    }

    /// The measurements of a named size.
    pub fn size(&self, name: &str) -> Option<&Measurements> {
        self.sizes
            .iter()
            .find(|size| size.name == name)
            .map(|size| &size.measurements)
    }

    /// The measurements of the base size: the one named so, else the first.
    pub fn base_measurements(&self) -> Option<&Measurements> {
        self.base_size
            .as_deref()
            .and_then(|name| self.size(name))
            .or_else(|| self.sizes.first().map(|size| &size.measurements))
    }
}

/// Whether a part may have that name: 1 to 80 characters, no control characters, no single
/// quotes (formulas use them), no space at either end.
pub fn is_part_name(name: &str) -> bool {
    !name.is_empty()
        && name.trim() == name
        && name.chars().count() <= NAME_LENGTH
        && !name.chars().any(|c| c.is_control() || c == '\'')
}
