//! What the definition of a node needs.

use super::node::{Definition, Node};
use crate::formula::{Names, Use};
use crate::{
    CornerName, Edge, Line, Mark, Name, Notch, Number, Panel, PanelId, PartReference, Pattern,
    WornRule,
};

/// Nodes a definition needs, and panels whose lines say which.
pub(crate) struct Needs<'d> {
    pattern: &'d Pattern,
    names: &'d Names,
    pub nodes: Vec<Node>,
    pub words: Vec<Box<str>>,
    pub panels: Vec<PanelId>,
    /// Whether it names parts that nothing was called when its formulas were read.
    pub by_name: bool,
}

impl<'d> Needs<'d> {
    /// What a definition needs in a pattern.
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
                self.nodes
                    .extend(rule.points().into_iter().map(Node::Point));
                self.nodes
                    .extend(rule.curves().into_iter().map(Node::Curve));
                self.numbers(rule.numbers());
            }
            Definition::Curve(curve) => {
                let rule = &curve.rule;
                self.nodes.extend(curve.ends.map(Node::Point));
                self.nodes
                    .extend(rule.points().into_iter().map(Node::Point));
                self.nodes.extend(rule.curve().map(Node::Curve));
                self.numbers(rule.number());
            }
            Definition::Edge(panel, line, k) => {
                let edge = &panel.lines[*line].edges[*k];
                self.nodes.push(Node::Curve(edge.curve));
                self.nodes.extend(edge.ends.map(Node::Point));
            }
            Definition::Stage(panel, 0) => {
                self.nodes
                    .extend(panel.edges().map(|edge| Node::Edge(edge.id)));
                self.numbers([&panel.grain, &panel.allowance]);
                self.numbers(panel.edges().filter_map(|e| e.allowance.as_ref()));
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
                self.numbers(operation.numbers());
                self.nodes
                    .extend(operation.points().into_iter().map(Node::Point));
                for mark in operation.marks() {
                    self.mark(panel, mark, *step);
                }
                self.notches(panel, *step);
            }
            Definition::Seam(seam) => {
                for span in seam.spans() {
                    self.last_stage(span.panel);
                    self.nodes.push(Node::Stage(span.panel, None));
                    if let Some(panel) = self.pattern.panel(span.panel) {
                        self.mark(panel, &span.from, usize::MAX);
                        self.mark(panel, &span.to, usize::MAX);
                    }
                }
                self.numbers(seam.numbers());
            }
        }
    }

    /// What notches need that are placed when that many operations are done.
    fn notches(&mut self, panel: &Panel, step: usize) {
        let own = |notch: &&Notch| panel.first_step(&notch.at).unwrap_or(0) == step;
        self.numbers(
            panel
                .notches
                .iter()
                .filter(own)
                .filter_map(|n| n.at.number()),
        );
    }

    /// The number of a mark, and the stage it is placed on, if that comes before a step.
    fn mark(&mut self, panel: &Panel, mark: &Mark, before: usize) {
        if let Mark::Notch(id) = mark {
            self.numbers(panel.notch(*id).and_then(|notch| notch.at.number()));
        }
        let first = panel.first_step(mark).filter(|&step| step < before);
        let made = first.and_then(|step| panel.operations.get(step.checked_sub(1)?));
        self.nodes
            .extend(made.map(|o| Node::Stage(panel.id, Some(o.id))));
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

/// The drawn edges of a stretch between corners.
pub(crate) fn drawn_stretch(lines: &[Line], ends: [CornerName; 2]) -> Option<Vec<&Edge>> {
    let [Name::Drawn(from), Name::Drawn(to)] = ends else {
        return None;
    };
    lines.iter().find_map(|line| line.stretch([from, to]))
}
