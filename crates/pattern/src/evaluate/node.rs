//! What is evaluated, what defines it, and what it needs.

use crate::formula::Quantity;
use crate::stage::Stretch;
use crate::{
    Curve, CurveId, Diagnostic, EdgeId, OperationId, Panel, PanelId, Point, PointId, Seam, SeamId,
    Stage, Variable, VariableId,
};
use std::sync::Arc;
use toile_geometry::{Path, Vec2};

/// Something that has a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Node {
    /// A measurement or other word in formulas, by its number among the words that were met.
    Word(u32),
    /// A variable.
    Variable(VariableId),
    /// A point.
    Point(PointId),
    /// A curve.
    Curve(CurveId),
    /// An edge of a panel.
    Edge(EdgeId),
    /// A panel as drawn, or after an operation.
    Stage(PanelId, Option<OperationId>),
    /// A seam.
    Seam(SeamId),
}

/// The definition from which a node is computed.
#[derive(Clone)]
pub(crate) enum Definition {
    /// The document has no such part.
    Missing,
    Word,
    Variable(Arc<Variable>),
    Point(Arc<Point>),
    Curve(Arc<Curve>),
    /// An edge: the panel, its line and the edge's place in it.
    Edge(Arc<Panel>, usize, usize),
    /// A stage: the panel and how many of its operations are done.
    Stage(Arc<Panel>, usize),
    Seam(Arc<Seam>),
}

impl Definition {
    /// Whether two definitions are one and the same.
    pub fn is(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Missing, Self::Missing) | (Self::Word, Self::Word) => true,
            (Self::Variable(a), Self::Variable(b)) => Arc::ptr_eq(a, b),
            (Self::Point(a), Self::Point(b)) => Arc::ptr_eq(a, b),
            (Self::Curve(a), Self::Curve(b)) => Arc::ptr_eq(a, b),
            (Self::Edge(a, i, j), Self::Edge(b, k, l)) => Arc::ptr_eq(a, b) && (i, j) == (k, l),
            (Self::Stage(a, i), Self::Stage(b, j)) => Arc::ptr_eq(a, b) && i == j,
            (Self::Seam(a), Self::Seam(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}

/// The value of a node.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Number(Quantity),
    Point(Vec2),
    Path(Arc<Path>),
    Stage(Arc<Stage>),
    Seam(Arc<SeamValue>),
}

/// A seam for one set of measurements.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SeamValue {
    /// How much longer one side may be (m).
    pub ease: f64,
    /// Of each side, its spans in walking order; nothing where one has no place.
    pub sides: [Vec<SpanValue>; 2],
    /// Length of each side, dart legs left out (m).
    pub lengths: [f64; 2],
}

/// A span: a copy and half of a panel, and named edges between shares.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpanValue {
    pub panel: crate::PanelId,
    pub copy: u32,
    pub half: u8,
    pub stretch: Stretch,
}

/// A node with its place in the graph and its value.
#[derive(Clone)]
pub(crate) struct NodeState {
    pub node: Node,
    pub definition: Definition,
    pub needs: Vec<u32>,
    pub needed_by: Vec<u32>,
    /// Panels from whose lines its needs follow.
    pub watches: Vec<PanelId>,
    /// Place in the order: larger than that of everything it needs, but in a cycle.
    pub rank: u32,
    /// The component of a cycle it is in, named by one of its nodes.
    pub cycle: Option<u32>,
    /// Its value, or the node whose fault keeps it from having one.
    pub value: Result<Value, u32>,
    /// Its last value, to be shown while it has none.
    pub last_good: Option<Value>,
    /// Update at which its value last changed.
    pub changed: u64,
    /// Whether the document had no such part when it was last computed.
    pub missing: bool,
    /// Whether it names parts that nothing was called when its formulas were read.
    pub by_name: bool,
    pub diagnostics: Vec<Diagnostic>,
}

impl Value {
    /// Whether two values are the same to the bit.
    pub fn is_same(&self, other: &Self) -> bool {
        let same = |a: f64, b: f64| a.to_bits() == b.to_bits();
        match (self, other) {
            (Self::Number(a), Self::Number(b)) => {
                same(a.value, b.value) && (a.power, a.is_angle) == (b.power, b.is_angle)
            }
            (Self::Point(a), Self::Point(b)) => same(a.x, b.x) && same(a.y, b.y),
            (Self::Path(a), Self::Path(b)) => Arc::ptr_eq(a, b) || is_same_path(a, b),
            (Self::Stage(a), Self::Stage(b)) => Arc::ptr_eq(a, b) || a.is_same(b),
            (Self::Seam(a), Self::Seam(b)) => a == b,
            _ => false,
        }
    }
}

fn is_same_path(a: &Path, b: &Path) -> bool {
    let bits = |path: &Path| -> Vec<u64> {
        let points = path
            .curves()
            .iter()
            .flat_map(|curve| curve.defining_points());
        points
            .flat_map(|p| [p.x.to_bits(), p.y.to_bits()])
            .collect()
    };
    a == b && bits(a) == bits(b)
}
