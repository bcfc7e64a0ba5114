//! Evaluation: every value of a pattern for one set of measurements, kept up to date edit by edit.
//!
//! Variables, points, curves, edges, panel stages and seams are the nodes of a graph; its edges are the
//! dependencies between them. An update takes over changed definitions, sorts the graph anew if dependencies
//! changed (strongly connected components by Tarjan 1972, on an explicit stack), and recomputes the nodes
//! that depend on the changes, in that order. It stops at a node whose value stays the same to the last bit.
//!
//! # Decided with
//! - [`crate::evaluate::Evaluation::take_over`] (`changes.rs`): which definitions changed;
//! - [`crate::evaluate::needs::Needs`]: what each value needs;
//! - [`crate::evaluate::Evaluation::update`] (`graph.rs`): order of recomputing, where it stops;
//! - [`crate::evaluate::compute`]: one value of any kind;
//! - [`crate::evaluate::wearer::Wearer`], [`crate::evaluate::numbers::Computation::quantity`]: the wearer;
//!   values that a size has of its own;
//! - [`crate::diagnostic::Code`]: faults found meanwhile;
//! - [`crate::drafting::Drafting`]: the draft made of it;
//! - [`crate::evaluate::Evaluation::cycle`] (`compute.rs`), [`crate::plan`] (`numbers.rs`, `refuse_valueless`): formulas
//!   that need themselves are told; an edit that makes such a circle is refused.
//!
//! Beside the pattern: crate `session`, `derived.rs`. By hand: a new list of the document in `take_over`.

mod changes;
mod compute;
mod curves;
mod duplicates;
mod graph;
mod markers;
mod needs;
mod node;
mod numbers;
mod on_stage;
mod operations;
mod panels;
mod points;
mod reshape;
mod seams;
mod wearer;

pub use node::Node;
pub(crate) use node::{SeamValue, SpanValue, Value};
pub use wearer::Wearer;

use crate::{Diagnostic, Pattern, PointId, SheetId};
use node::NodeState;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;
use toile_geometry::Vec2;

/// All values of a pattern for one wearer. A clone shares data with the original until either changes them.
#[derive(Clone, Default)]
pub struct Evaluation {
    pattern: Pattern,
    wearer: Arc<Wearer>,
    nodes: Vec<Arc<NodeState>>,
    /// Number of each node, which is its index in `nodes`.
    index: Arc<HashMap<Node, u32>>,
    /// Number of each word that formulas have used so far.
    words: HashMap<Box<str>, u32>,
    /// The words, by their numbers.
    word_texts: Vec<Box<str>>,
    /// For each panel, the nodes whose dependencies the panel decides: they are found again when it changes.
    watchers: Arc<HashMap<crate::PanelId, HashSet<u32>>>,
    names: Arc<crate::formula::Names>,
    /// Diagnostics of ids and names that are used twice.
    duplicates: Vec<Diagnostic>,
    /// Number of updates so far.
    revision: u64,
}

/// Counts of the nodes that an update changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Update {
    /// Number of nodes that were computed.
    pub computed: usize,
    /// Number of nodes whose value changed.
    pub changed: usize,
    /// Number of new nodes: new parts, and measurements and missing parts that formulas name.
    pub met: usize,
}

impl Evaluation {
    /// Evaluates a pattern for a size, or a table of measurements.
    pub fn new(pattern: &Pattern, wearer: impl Into<Wearer>) -> Self {
        let mut evaluation = Self::default();
        evaluation.update(pattern, wearer);
        evaluation
    }

    /// The pattern as last evaluated.
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// The wearer that the pattern was last evaluated for.
    pub fn wearer(&self) -> &Wearer {
        &self.wearer
    }

    /// The size of the pattern whose measurements the wearer has: numbers take the values that they have for
    /// this size. `None`: the measurements are those of no size.
    pub fn size(&self) -> Option<crate::SizeId> {
        self.wearer.size
    }

    /// Names of the pattern's parts.
    pub fn names(&self) -> &Arc<crate::formula::Names> {
        &self.names
    }

    /// All diagnostics of the evaluation: faults of definitions, each reported only at its cause.
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        // Faults of a word that no formula uses any longer are left out.
        let is_used = |state: &NodeState| match state.node {
            Node::Word(_) => !state.needed_by.is_empty(),
            Node::Variable(_)
            | Node::Point(_)
            | Node::Curve(_)
            | Node::Edge(_)
            | Node::Stage(..)
            | Node::Seam(_) => true,
        };
        let states = self.nodes.iter().map(|state| &**state);
        let told = states.filter(|state| !state.diagnostics.is_empty() && is_used(state));
        let mut order: Vec<&NodeState> = told.collect();
        order.sort_by_key(|state| self.place_in_order(state));
        let own = order
            .iter()
            .flat_map(|state| state.diagnostics.iter().cloned());
        let duplicates = self.duplicates.iter().cloned();
        let markers = markers::waiting(&self.pattern);
        duplicates.chain(own).chain(markers).collect()
    }

    /// Sort key of a node, independent of the order in which nodes were made: parts come first, then words by
    /// their texts.
    fn place_in_order(&self, state: &NodeState) -> Result<Node, &str> {
        match state.node {
            Node::Word(word) => Err(&self.word_texts[word as usize]),
            node @ (Node::Variable(_)
            | Node::Point(_)
            | Node::Curve(_)
            | Node::Edge(_)
            | Node::Stage(..)
            | Node::Seam(_)) => Ok(node),
        }
    }

    /// Position of a point (m). `None`: it cannot be computed.
    pub fn point(&self, id: PointId) -> Option<Vec2> {
        match self.value(Node::Point(id))? {
            Value::Point(place) => Some(*place),
            Value::Number(_) | Value::Path(_) | Value::Stage(_) | Value::Seam(_) => None,
        }
    }

    /// Positions of all points that can be computed (m).
    pub fn points(&self) -> BTreeMap<(SheetId, PointId), Vec2> {
        let sheets = self.pattern.sheets.iter();
        sheets
            .flat_map(|sheet| sheet.points.iter().map(|point| (sheet.id, point.id)))
            .filter_map(|key| Some((key, self.point(key.1)?)))
            .collect()
    }

    /// A curve as drawn (m). `None`: it cannot be computed.
    pub fn curve(&self, id: crate::CurveId) -> Option<&Arc<toile_geometry::Path>> {
        match self.value(Node::Curve(id))? {
            Value::Path(path) => Some(path),
            Value::Number(_) | Value::Point(_) | Value::Stage(_) | Value::Seam(_) => None,
        }
    }

    /// An edge as drawn (m). `None`: it cannot be computed.
    pub fn edge(&self, id: crate::EdgeId) -> Option<&Arc<toile_geometry::Path>> {
        match self.value(Node::Edge(id))? {
            Value::Path(path) => Some(path),
            Value::Number(_) | Value::Point(_) | Value::Stage(_) | Value::Seam(_) => None,
        }
    }

    /// A stage of a panel: the panel after the operation `after`, or as drawn if `after` is `None`. Returns
    /// `None` if the stage cannot be computed.
    pub fn stage(
        &self,
        panel: crate::PanelId,
        after: Option<crate::OperationId>,
    ) -> Option<&Arc<crate::Stage>> {
        match self.value(Node::Stage(panel, after))? {
            Value::Stage(stage) => Some(stage),
            Value::Number(_) | Value::Point(_) | Value::Path(_) | Value::Seam(_) => None,
        }
    }

    /// The last stage of a panel.
    pub fn last_stage(&self, panel: &crate::Panel) -> Option<&Arc<crate::Stage>> {
        self.stage(panel.id, panel.operations.last().map(|o| o.id))
    }

    /// The last stage of a panel, as it was when it could last be computed. For display, never for export.
    pub fn last_good_stage(&self, panel: &crate::Panel) -> Option<&Arc<crate::Stage>> {
        let node = Node::Stage(panel.id, panel.operations.last().map(|o| o.id));
        match self.state(node)?.last_good.as_ref()? {
            Value::Stage(stage) => Some(stage),
            Value::Number(_) | Value::Point(_) | Value::Path(_) | Value::Seam(_) => None,
        }
    }

    /// The value of a variable, and its dimension as a power of length: 0 for plain numbers and angles, 1 for
    /// lengths (m).
    pub fn variable(&self, id: crate::VariableId) -> Option<(f64, i8)> {
        match self.value(Node::Variable(id))? {
            Value::Number(quantity) => Some((quantity.value, quantity.power)),
            Value::Point(_) | Value::Path(_) | Value::Stage(_) | Value::Seam(_) => None,
        }
    }

    /// Whether a variable is an angle; its value is then in radians (rad).
    pub fn is_angle(&self, id: crate::VariableId) -> bool {
        matches!(self.value(Node::Variable(id)), Some(Value::Number(quantity)) if quantity.is_angle)
    }

    pub(crate) fn seam_value(&self, id: crate::SeamId) -> Option<&Arc<SeamValue>> {
        match self.value(Node::Seam(id))? {
            Value::Seam(value) => Some(value),
            Value::Number(_) | Value::Point(_) | Value::Path(_) | Value::Stage(_) => None,
        }
    }

    /// Rank of a node in the order of computation: higher than the ranks of all nodes it depends on, except
    /// in a cycle.
    pub(crate) fn rank(&self, node: Node) -> Option<u32> {
        self.state(node).map(|state| state.rank)
    }

    /// Adds a node and all nodes that depend on it, directly or indirectly, to a set.
    pub fn gather_dependants(&self, node: Node, found: &mut HashSet<Node>) {
        let mut open: Vec<Node> = vec![node];
        while let Some(node) = open.pop() {
            if !found.insert(node) {
                continue;
            }
            let needed_by = self.state(node).map_or(&[][..], |state| &state.needed_by);
            open.extend(needed_by.iter().map(|&k| self.nodes[k as usize].node));
        }
    }

    fn state(&self, node: Node) -> Option<&NodeState> {
        self.index.get(&node).map(|&k| &*self.nodes[k as usize])
    }

    /// A node, to be changed: it is copied first if another evaluation shares it.
    fn state_mut(&mut self, k: u32) -> &mut NodeState {
        Arc::make_mut(&mut self.nodes[k as usize])
    }

    fn value(&self, node: Node) -> Option<&Value> {
        self.state(node)?.value.as_ref().ok()
    }
}
