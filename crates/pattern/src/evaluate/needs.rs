//! Dependencies: the nodes that the definition of a node needs.

use super::node::{Definition, Node};
use crate::fields::{self, Fields};
use crate::formula::{Names, Use};
use crate::{
    CornerName, Edge, Line, Mark, Name, Number, OperationId, Panel, PanelId, PartReference,
    Pattern, PointId, PointRule, Source, StageLineage, WornRule,
};

/// The nodes and words that a definition depends on, and the panels that decide which nodes these are.
pub(crate) struct Needs<'d> {
    pattern: &'d Pattern,
    names: &'d Names,
    pub nodes: Vec<Node>,
    pub words: Vec<Box<str>>,
    pub panels: Vec<PanelId>,
    /// Whether the definition names parts that did not exist when its formulas were read.
    pub by_name: bool,
}

impl<'d> Needs<'d> {
    /// The dependencies of a definition in a pattern.
    pub fn of(definition: &Definition, pattern: &'d Pattern, names: &'d Names) -> Self {
        let mut needs = Self {
            pattern,
            names,
            nodes: Vec::new(),
            words: Vec::new(),
            panels: Vec::new(),
            by_name: false,
        };
        needs.definition(definition);
        needs.nodes.sort_unstable();
        needs.nodes.dedup();
        needs.panels.sort_unstable();
        needs.panels.dedup();
        needs
    }

    fn definition(&mut self, definition: &Definition) {
        match definition {
            Definition::Missing | Definition::Word => {}
            Definition::Variable(variable) => self.number(&variable.number),
            Definition::Point(point) => {
                let rule = &point.rule;
                self.sources(rule);
                self.numbers(fields::numbers(rule));
                if let PointRule::Mark { at, .. } = rule {
                    self.on_stage(point.id, at);
                }
            }
            Definition::Curve(curve) => {
                let rule = &curve.rule;
                self.nodes.extend(curve.ends.map(Node::Point));
                self.sources(rule);
                self.numbers(fields::numbers(rule));
            }
            Definition::Edge(panel, line, k) => {
                let edge = &panel.lines[*line].edges[*k];
                self.nodes.push(Node::Curve(edge.curve));
                self.nodes.extend(edge.ends.map(Node::Point));
            }
            Definition::Stage(panel, 0) => {
                if let Source::Side { of, split, .. } = panel.source {
                    self.nodes.push(Node::Stage(of, Some(split)));
                }
                self.numbers([&panel.grain, &panel.allowance]);
                self.lines(panel, None);
                self.notches(panel, 0);
                if let WornRule::Wrapped {
                    level: Some(level), ..
                } = &panel.worn
                {
                    self.number(level);
                }
            }
            Definition::Stage(panel, step) => {
                let before = step.checked_sub(2).map(|k| panel.operations[k].id);
                self.nodes.push(Node::Stage(panel.id, before));
                self.nodes.push(Node::Stage(panel.id, None));
                let operation = &panel.operations[step - 1].kind;
                self.numbers(fields::numbers(operation));
                self.sources(operation);
                if operation.sheet().is_some() {
                    self.number(&panel.allowance);
                    self.lines(panel, Some(panel.operations[step - 1].id));
                }
                for mark in fields::marks(operation) {
                    self.mark(panel, mark, Some(*step));
                }
                self.notches(panel, *step);
            }
            Definition::Seam(seam) => {
                for span in seam.spans() {
                    self.last_stage(span.panel);
                    self.nodes.push(Node::Stage(span.panel, None));
                    if let Some(panel) = self.pattern.panel(span.panel) {
                        self.mark(panel, &span.from, None);
                        self.mark(panel, &span.to, None);
                    }
                }
                self.numbers(fields::numbers(&**seam));
            }
        }
    }

    /// Adds the points and curves that the part's own fields name.
    fn sources(&mut self, part: &dyn Fields) {
        let points = fields::points(part).into_iter();
        self.nodes.extend(points.map(Node::Point));
        let curves = fields::curves(part).into_iter();
        self.nodes.extend(curves.map(Node::Curve));
    }

    /// Adds the dependencies of the lines that the operation `by` inserts into a panel; of the lines as drawn
    /// if it is `None`.
    fn lines(&mut self, panel: &Panel, by: Option<OperationId>) {
        let own = panel.lines.iter().filter(|line| line.by == by);
        for edge in own.flat_map(|line| &line.edges) {
            self.nodes.push(Node::Edge(edge.id));
            self.numbers(edge.allowance.as_ref());
        }
    }

    /// Adds the dependencies of a point that is placed by a mark on the panel stage that its sheet lies on.
    fn on_stage(&mut self, point: PointId, at: &Mark) {
        let on = self.pattern.point(point).and_then(|found| found.0.on);
        let Some((panel, after)) = on else {
            return;
        };
        self.panels.push(panel);
        self.nodes.push(Node::Stage(panel, after));
        if let Some(panel) = self.pattern.panel(panel) {
            let own = after.and_then(|by| panel.step_of(by)).unwrap_or(0);
            self.mark(panel, at, Some(own + 1));
        }
    }

    /// Adds the dependencies of the notches that are placed once the first `step` operations of the panel are
    /// done.
    fn notches(&mut self, panel: &Panel, step: usize) {
        let lineage = self.stage_lineage(panel);
        for notch in &panel.notches {
            let first = self
                .pattern
                .first_step(panel, &lineage, &notch.at)
                .unwrap_or(0);
            if first.max(lineage.base) == lineage.base + step {
                self.mark(panel, &notch.at, Some(step));
            }
        }
    }

    /// The stages that lead to a panel. They depend on all panels that it is a side of, which are added too.
    fn stage_lineage(&mut self, panel: &Panel) -> StageLineage {
        let parents = self.pattern.lineage(panel).into_iter().skip(1);
        self.panels.extend(parents.map(|parent| parent.id));
        if let Source::Side { of, .. } = panel.source {
            self.panels.push(of);
        }
        self.pattern.stage_lineage(panel)
    }

    /// Adds the dependencies of the mark's number, and the stage on which the mark is placed. With `before`,
    /// the stage is added only if fewer than this many operations of the panel are done on it.
    fn mark(&mut self, panel: &Panel, mark: &Mark, before: Option<usize>) {
        let lineage = self.stage_lineage(panel);
        self.numbers(match mark {
            Mark::Notch(id) => {
                let notch = self.pattern.notch_of(panel, *id);
                notch.and_then(|notch| notch.at.number())
            }
            own @ (Mark::Along { .. } | Mark::Between { .. } | Mark::Corner(_)) => own.number(),
        });
        let first = self.pattern.first_step(panel, &lineage, mark);
        let before = before.map_or(usize::MAX, |step| lineage.base + step);
        let stage = first
            .filter(|&step| step < before)
            .and_then(|step| lineage.stage(step));
        self.nodes
            .extend(stage.map(|(panel, after)| Node::Stage(panel, after)));
    }

    fn numbers<'a>(&mut self, numbers: impl IntoIterator<Item = &'a Number>) {
        for number in numbers {
            self.number(number);
        }
    }

    fn number(&mut self, number: &Number) {
        let Some(formula) = number.as_formula() else {
            return;
        };
        for used in formula.uses() {
            match used {
                Use::Variable(id) => self.nodes.push(Node::Variable(id)),
                Use::Word(word) => self.words.push(word.into()),
                Use::Part {
                    part: PartReference::Unknown(text),
                    kind,
                    finished,
                } => {
                    self.by_name = true;
                    if let Some(part) = self.names.part(text, kind) {
                        self.part(&part, finished);
                    }
                }
                Use::Part { part, finished, .. } => self.part(part, finished),
            }
        }
    }

    fn part(&mut self, part: &PartReference, finished: bool) {
        match part {
            PartReference::Point(id) => self.nodes.push(Node::Point(*id)),
            PartReference::Curve(id) => self.nodes.push(Node::Curve(*id)),
            PartReference::Seam(id) => self.nodes.push(Node::Seam(*id)),
            PartReference::Unknown(_) => {}
            PartReference::Stretch { panel, ends } => {
                self.panels.push(*panel);
                if finished {
                    self.nodes.push(Node::Stage(*panel, None));
                    self.last_stage(*panel);
                }
                let panel = self.pattern.panel(*panel);
                let lines = panel.map_or(&[][..], |panel| &panel.lines);
                let edges = drawn_stretch(lines, *ends);
                self.nodes
                    .extend(edges.iter().flatten().map(|e| Node::Edge(e.id)));
            }
        }
    }

    fn last_stage(&mut self, panel: PanelId) {
        self.panels.push(panel);
        if let Some(found) = self.pattern.panel(panel) {
            let last = found.operations.last().map(|o| o.id);
            self.nodes.push(Node::Stage(panel, last));
        }
    }
}

/// The drawn edges from one corner of a line to a later corner. `None`: an operation made one of the corners,
/// or they are not corners of one line in this order.
pub(crate) fn drawn_stretch(lines: &[Line], ends: [CornerName; 2]) -> Option<Vec<&Edge>> {
    let [Name::Drawn(from), Name::Drawn(to)] = ends else {
        return None;
    };
    lines.iter().find_map(|line| line.stretch([from, to]))
}
