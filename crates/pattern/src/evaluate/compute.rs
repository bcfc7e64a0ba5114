//! Computes the value of one node, of any kind.

use super::node::{Definition, Node, Value};
use super::numbers::Computation;
use super::{Evaluation, curves, operations, points, seams};
use crate::formula::Failure;
use crate::{Code, Diagnostic, PartReference, Place, Severity};

/// Most names of a cycle that a message lists.
const CYCLE_NAMES: usize = 12;

impl Evaluation {
    /// Computes the value of a node from the values of the nodes that it depends on.
    pub(super) fn compute(&self, k: u32) -> (Result<Value, u32>, Vec<Diagnostic>) {
        let state = &self.nodes[k as usize];
        if let Some(named) = state.cycle {
            let told = match named == k {
                true => vec![self.cycle(k)],
                false => Vec::new(),
            };
            return (Err(named), told);
        }
        let mut computation = Computation {
            evaluation: self,
            k,
            diagnostics: Vec::new(),
            missed: Vec::new(),
            cause: k,
        };
        let value = computation.value(&state.definition);
        let cause = computation.cause;
        (value.ok_or(cause), computation.diagnostics)
    }

    /// The diagnostic for a node that depends on itself.
    fn cycle(&self, k: u32) -> Diagnostic {
        let mut names: Vec<String> = Vec::new();
        let mut at = k;
        let component = self.nodes[k as usize].cycle;
        let mut seen = std::collections::HashSet::new();
        // A walk along dependencies inside the cycle's component comes back to a node that it has visited.
        while seen.insert(at) {
            if names.len() < CYCLE_NAMES {
                names.push(self.node_words(at));
            }
            let needs = &self.nodes[at as usize].needs;
            let inside = needs
                .iter()
                .filter(|&&n| self.nodes[n as usize].cycle == component);
            let first = inside.min_by_key(|&&n| self.place_in_order(&self.nodes[n as usize]));
            let Some(&next) = first else {
                break;
            };
            at = next;
        }
        let more = if seen.len() > CYCLE_NAMES {
            " -> ..."
        } else {
            ""
        };
        let first = names[0].clone();
        let last = if more.is_empty() {
            self.node_words(at)
        } else {
            first.clone()
        };
        Diagnostic::error(
            Code::Cycle,
            self.place(k),
            format!(
                "{first} needs itself: {}{more} -> {last}",
                names.join(" -> ")
            ),
            "give one of them a value that does not need the others",
        )
    }

    fn node_words(&self, k: u32) -> String {
        let names = &self.names;
        match &self.nodes[k as usize].definition {
            Definition::Variable(variable) => variable.name.clone(),
            Definition::Point(point) => names.print_part(&PartReference::Point(point.id)),
            Definition::Curve(curve) => names.print_part(&PartReference::Curve(curve.id)),
            Definition::Edge(panel, line, edge) => {
                format!("{}.{}", panel.name, panel.lines[*line].edges[*edge].name)
            }
            Definition::Stage(panel, 0) => panel.name.clone(),
            Definition::Stage(panel, step) => {
                format!("{}.{}", panel.name, panel.operations[step - 1].name)
            }
            Definition::Seam(seam) => seam.name.clone(),
            Definition::Missing | Definition::Word => match self.nodes[k as usize].node {
                Node::Word(word) => self.word_texts[word as usize].to_string(),
                Node::Variable(_)
                | Node::Point(_)
                | Node::Curve(_)
                | Node::Edge(_)
                | Node::Stage(..)
                | Node::Seam(_) => format!("?{k}"),
            },
        }
    }

    fn place(&self, k: u32) -> Place {
        match &self.nodes[k as usize].definition {
            Definition::Missing | Definition::Word => Place::Pattern,
            Definition::Variable(variable) => Place::Variable(variable.id),
            Definition::Point(point) => Place::Point(point.id),
            Definition::Curve(curve) => Place::Curve(curve.id),
            Definition::Edge(panel, line, edge) => {
                Place::Edge(panel.id, panel.lines[*line].edges[*edge].id)
            }
            Definition::Stage(panel, 0) => Place::Panel(panel.id),
            Definition::Stage(panel, step) => {
                Place::Operation(panel.id, panel.operations[step - 1].id)
            }
            Definition::Seam(seam) => Place::Seam(seam.id),
        }
    }
}

impl Computation<'_> {
    fn value(&mut self, definition: &Definition) -> Option<Value> {
        match definition {
            Definition::Missing => None,
            Definition::Word => self.word(),
            Definition::Variable(variable) => {
                let place = Place::Variable(variable.id);
                let what = format!("variable {:?}", variable.name);
                let result = self.variable(&variable.number);
                self.reported(result, &place, &what).map(Value::Number)
            }
            Definition::Point(point) => points::point(self, point).map(Value::Point),
            Definition::Curve(curve) => curves::curve(self, curve).map(Value::Path),
            Definition::Edge(panel, line, edge) => {
                curves::edge(self, panel, &panel.lines[*line].edges[*edge]).map(Value::Path)
            }
            Definition::Stage(panel, step) => {
                operations::stage(self, panel, *step).map(Value::Stage)
            }
            Definition::Seam(seam) => seams::seam(self, seam).map(Value::Seam),
        }
    }

    /// The value of a word in formulas: that of the measurement with this name or, if there is none, of the
    /// variable that has this name now. `None`: there is no such value.
    fn word(&mut self) -> Option<Value> {
        let evaluation = self.evaluation;
        let Node::Word(number) = evaluation.nodes[self.k as usize].node else {
            return None;
        };
        let name = &*evaluation.word_texts[number as usize];
        if let Some((quantity, borrowed)) = evaluation.measurement(name) {
            if borrowed {
                self.diagnostics.push(Diagnostic::new(
                    Severity::Note,
                    Code::BorrowedMeasurement,
                    Place::Pattern,
                    format!("measurement {name:?} was not given; the pattern's base size has it"),
                    "measure it, if the base size does not fit",
                ));
            }
            return Some(Value::Number(quantity));
        }
        let variable = evaluation.variable_called(name)?;
        match self.needed(Node::Variable(variable)) {
            Ok(value) => Some(value.clone()),
            Err(Failure::Reported(cause)) => {
                self.cause = cause;
                None
            }
            Err(Failure::Fault { .. }) => None,
        }
    }
}
