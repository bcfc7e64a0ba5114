//! Nodes of the evaluation: keys, definitions, values and dependencies.

use crate::formula::Quantity;
use crate::stage::Stretch;
use crate::{
    Curve, CurveId, Diagnostic, EdgeId, OperationId, Panel, PanelId, Point, PointId, Seam, SeamId,
    Stage, Variable, VariableId,
};
use std::sync::Arc;
use toile_geometry::{Path, Vec2};

/// Key of a node of the evaluation: a part, a panel stage, or a word in formulas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Node {
    /// A measurement or other word in formulas, by its number among the words used so far.
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
    /// An edge: the panel, the index of its line and the index of the edge in the line.
    Edge(Arc<Panel>, usize, usize),
    /// A stage: the panel, and the number of its operations that are done.
    Stage(Arc<Panel>, usize),
    Seam(Arc<Seam>),
}

impl Definition {
    /// Whether `self` and `other` share the same object; equal content is not enough.
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

/// The value of a seam for one set of measurements.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SeamValue {
    /// Length by which one side may be longer than the other (m).
    pub ease: f64,
    /// Spans of each side in walking order.
    pub sides: [Vec<SpanValue>; 2],
    /// Length of each side without the legs of darts (m).
    pub lengths: [f64; 2],
}

/// The value of a span: a copy and half of a panel, and the stretches of edges that the span covers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpanValue {
    pub panel: crate::PanelId,
    pub copy: u32,
    pub half: u8,
    pub stretch: Stretch,
}

/// The state of a node: its definition, its value, and its neighbours in the graph.
#[derive(Clone)]
pub(crate) struct NodeState {
    pub node: Node,
    pub definition: Definition,
    pub needs: Vec<u32>,
    pub needed_by: Vec<u32>,
    /// Panels that decide on which other nodes the node depends.
    pub watches: Vec<PanelId>,
    /// Rank in the order of computation: higher than the ranks of all nodes it depends on, except in a cycle.
    pub rank: u32,
    /// If the node is in a cycle: a node of that cycle, which stands for the whole of it.
    pub cycle: Option<u32>,
    /// The value. `Err`: the number of the node whose fault keeps this node from having a value.
    pub value: Result<Value, u32>,
    /// The last value that could be computed, shown while there is none now.
    pub last_good: Option<Value>,
    /// Number of the update at which the value last changed.
    pub changed: u64,
    /// Whether the part was missing from the document when the node was last computed.
    pub missing: bool,
    /// Whether the definition names parts that did not exist when its formulas were read.
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
