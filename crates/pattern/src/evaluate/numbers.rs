//! Values of the numbers of a document, and the values that formulas look up.

use super::Evaluation;
use super::needs::drawn_stretch;
use super::node::{Definition, Node, Value};
use crate::formula::{Environment, Failure, Kind, Quantity, compute, kind};
use crate::stage::{MarkValue, is_sewn};
use crate::{
    Code, CornerName, Diagnostic, Name, Number, PartReference, Place, VariableId, Want, nearest,
};
use std::borrow::Cow;
use toile_geometry::{Path, Vec2};

/// Greatest length in a pattern (m): a longer one is refused.
const LONGEST: f64 = 1000.0;
/// Greatest plain number (1) and greatest angle (rad) in a pattern: a larger one is refused.
const LARGEST: f64 = 1e6;

/// The computation of one node. It reads values of other nodes and collects diagnostics.
pub(crate) struct Computation<'e> {
    pub evaluation: &'e Evaluation,
    /// Index of the node that is computed.
    pub k: u32,
    pub diagnostics: Vec<Diagnostic>,
    /// References that were not found so far, each with its diagnostic place. Several numbers of one place
    /// that name the same missing part have one cause, which is reported once.
    pub missed: Vec<(Place, String)>,
    /// The node whose fault keeps the computed node from having a value.
    pub cause: u32,
}

impl Evaluation {
    /// The value of a number that does not belong to a node: a length (m), an angle (rad) or plain, as `want`
    /// says. `None`: the number has no value.
    pub fn number(&self, number: &Number, want: Want) -> Option<f64> {
        self.number_of_kind(number, want, &Place::Pattern, "").0
    }

    /// The value of a number that does not belong to a node, or its fault in words.
    ///
    /// # Errors
    /// The formula has no value; the message ends with advice.
    pub fn number_or_fault(&self, number: &Number, want: Want) -> Result<f64, String> {
        let (value, found) = self.number_of_kind(number, want, &Place::Pattern, "");
        let fault = found.first().map(|found| {
            let words = found.message.trim_start_matches(": ");
            format!("{words}: {}", found.hint)
        });
        value.ok_or_else(|| fault.unwrap_or_else(|| "it has no value yet".into()))
    }

    /// The quantity of a number that may be of any quantity, such as that of a variable: a length or an
    /// angle, otherwise plain. A number without value counts as plain.
    pub fn kind(&self, number: &Number) -> Want {
        let mut computation = Computation::new(self);
        match computation.variable(number) {
            Ok(Quantity { power: 1, .. }) => Want::Length,
            Ok(Quantity { is_angle: true, .. }) => Want::Angle,
            _ => Want::Plain,
        }
    }

    /// The value of a length that does not belong to a node (m), and its diagnostics.
    pub(crate) fn length_of(
        &self,
        number: &Number,
        place: &Place,
        what: &str,
    ) -> (Option<f64>, Vec<Diagnostic>) {
        self.number_of_kind(number, Want::Length, place, what)
    }

    /// The value of a measurement. It is taken from the base size if the wearer has none; the flag is then
    /// `true`.
    pub(super) fn measurement(&self, name: &str) -> Option<(Quantity, bool)> {
        let given = self.wearer.measurements.get(name);
        let base = || self.pattern.base_measurements()?.get(name);
        let value = given.or_else(base)?;
        let quantity = match toile_measure::is_angle(name) {
            true => Quantity::angle(value),
            false => Quantity::length(value),
        };
        Some((quantity, given.is_none()))
    }

    /// The variable that a word names, unless the word is a measurement.
    pub(super) fn variable_called(&self, word: &str) -> Option<VariableId> {
        match self.measurement(word) {
            Some(_) => None,
            None => self.names.variable(word),
        }
    }

    pub(crate) fn number_of_kind(
        &self,
        number: &Number,
        want: Want,
        place: &Place,
        what: &str,
    ) -> (Option<f64>, Vec<Diagnostic>) {
        let mut computation = Computation::new(self);
        let value = computation.number(number, want, place, what);
        (value, computation.diagnostics)
    }
}

impl<'e> Computation<'e> {
    /// A computation for a number that does not belong to a node.
    fn new(evaluation: &'e Evaluation) -> Self {
        Self {
            evaluation,
            k: 0,
            diagnostics: Vec::new(),
            missed: Vec::new(),
            cause: 0,
        }
    }

    /// The value of a number. A fault is reported at `place` and calls the number `what`.
    pub fn number(
        &mut self,
        number: &Number,
        want: Want,
        place: &Place,
        what: &str,
    ) -> Option<f64> {
        let result = self.measure(number, want);
        self.reported(result, place, what)
    }

    /// The value of a number, refused if it exceeds the bounds for garments.
    pub fn measure(&mut self, number: &Number, want: Want) -> Result<f64, Failure> {
        self.quantity(number, want).and_then(|q| bounded(q, want))
    }

    pub fn quantity(&mut self, number: &Number, want: Want) -> Result<Quantity, Failure> {
        let plain = |value: f64| match want {
            Want::Length => Quantity::length(value),
            Want::Angle => Quantity::angle(value),
            Want::Plain | Want::Any => Quantity::plain(value),
        };
        match number {
            Number::Value(value) => Ok(plain(*value)),
            Number::Formula(formula) => compute(formula, &Reading(self)),
            Number::Adjusted { formula, by } => {
                let found = compute(formula, &Reading(self))?;
                Ok(Quantity {
                    value: found.value + by,
                    ..found
                })
            }
            Number::PerSize { usual, sizes } => {
                let own = sizes
                    .iter()
                    .find(|own| Some(own.0) == self.evaluation.wearer.size);
                match own {
                    Some((_, value)) => Ok(plain(*value)),
                    None => self.quantity(usual, want),
                }
            }
        }
    }

    /// The value of a variable, which may have any dimension. A value of its own in a size has the dimension
    /// of the usual number.
    pub fn variable(&mut self, number: &Number) -> Result<Quantity, Failure> {
        let found = self.quantity(number, Want::Plain)?;
        match number {
            Number::PerSize { usual, .. } => Ok(Quantity {
                value: found.value,
                ..self.variable(usual)?
            }),
            Number::Value(_) | Number::Formula(_) | Number::Adjusted { .. } => Ok(found),
        }
    }

    /// Turns a failure into a diagnostic, unless the fault was already reported at another node.
    pub fn reported<T>(
        &mut self,
        result: Result<T, Failure>,
        place: &Place,
        what: &str,
    ) -> Option<T> {
        match result {
            Ok(value) => return Some(value),
            Err(Failure::Reported(cause)) => self.cause = cause,
            Err(Failure::Fault {
                code,
                column,
                message,
                hint,
            }) => {
                if code == Code::MissingReference {
                    let missed = (place.clone(), message.clone());
                    if self.missed.contains(&missed) {
                        return None;
                    }
                    self.missed.push(missed);
                }
                let message = match column {
                    Some(column) => format!("{what}: column {column}: {message}"),
                    None => format!("{what}: {message}"),
                };
                self.diagnostics
                    .push(Diagnostic::error(code, place.clone(), message, hint));
            }
        }
        None
    }

    /// The value of a node that the computed node depends on.
    pub fn needed(&self, node: Node) -> Result<&Value, Failure> {
        let evaluation = self.evaluation;
        let Some(state) = evaluation.state(node) else {
            return Err(missing(node));
        };
        match (&state.value, &state.definition) {
            (Ok(value), _) => Ok(value),
            (Err(_), Definition::Missing) => Err(missing(node)),
            (Err(cause), _) => Err(Failure::Reported(*cause)),
        }
    }

    /// The definition of a node.
    pub fn definition(&self, node: Node) -> Option<&Definition> {
        self.evaluation.state(node).map(|state| &state.definition)
    }

    /// Position of a point (m).
    pub fn point_at(&self, id: crate::PointId) -> Result<Vec2, Failure> {
        match self.needed(Node::Point(id))? {
            Value::Point(place) => Ok(*place),
            Value::Number(_) | Value::Path(_) | Value::Stage(_) | Value::Seam(_) => {
                Err(missing(Node::Point(id)))
            }
        }
    }

    /// The path of a curve or an edge (m).
    pub fn path(&self, node: Node) -> Result<&std::sync::Arc<Path>, Failure> {
        match self.needed(node)? {
            Value::Path(path) => Ok(path),
            Value::Number(_) | Value::Point(_) | Value::Stage(_) | Value::Seam(_) => {
                Err(missing(node))
            }
        }
    }

    /// A stage of a panel.
    pub fn stage(&self, node: Node) -> Result<&std::sync::Arc<crate::Stage>, Failure> {
        match self.needed(node)? {
            Value::Stage(stage) => Ok(stage),
            Value::Number(_) | Value::Point(_) | Value::Path(_) | Value::Seam(_) => {
                Err(missing(node))
            }
        }
    }
}

fn missing(node: Node) -> Failure {
    let what = match node {
        Node::Word(_) => "a measurement",
        Node::Variable(_) => "a variable",
        Node::Point(_) => "a point",
        Node::Curve(_) => "a curve",
        Node::Edge(_) => "an edge",
        Node::Stage(..) => "a panel",
        Node::Seam(_) => "a seam",
    };
    Failure::new(
        Code::MissingReference,
        format!("{what} that it names is not there any more"),
        "name another part, remove what uses it, or undo its removal",
    )
}

/// Looks up the values that a formula names, in the evaluation to which the computed node belongs.
struct Reading<'c, 'e>(&'c Computation<'e>);

impl Reading<'_, '_> {
    fn unknown(&self, text: &str, kind: Kind) -> Failure {
        let (message, hint) = self.0.evaluation.names.missing(text, kind);
        Failure::new(Code::MissingReference, message, hint)
    }

    /// The part that a formula names: `part` itself or, if that is an unknown name, the part that has this
    /// name now.
    fn bound<'p>(
        &self,
        part: &'p PartReference,
        kind: Kind,
    ) -> Result<Cow<'p, PartReference>, Failure> {
        let PartReference::Unknown(text) = part else {
            return Ok(Cow::Borrowed(part));
        };
        let found = self.0.evaluation.names.part(text, kind);
        found
            .map(Cow::Owned)
            .ok_or_else(|| self.unknown(text, kind))
    }

    fn edges(&self, part: &PartReference, kind: Kind) -> Result<Vec<&Path>, Failure> {
        let evaluation = self.0.evaluation;
        match part {
            PartReference::Curve(id) => Ok(vec![&**self.0.path(Node::Curve(*id))?]),
            PartReference::Stretch { panel, ends } => {
                let lines = evaluation
                    .pattern
                    .panel(*panel)
                    .map_or(&[][..], |p| &p.lines);
                let Some(edges) = drawn_stretch(lines, *ends) else {
                    return Err(Failure::new(
                        Code::MissingReference,
                        "the corners that it names are no stretch of a line any more",
                        "name an edge or two corners of one line, or undo the removal",
                    ));
                };
                edges
                    .iter()
                    .map(|edge| Ok(&**self.0.path(Node::Edge(edge.id))?))
                    .collect()
            }
            PartReference::Unknown(text) => Err(self.unknown(text, kind)),
            PartReference::Point(_) | PartReference::Seam(_) => Err(Failure::new(
                Code::Formula,
                "it has no edge",
                "name an edge or a curve",
            )),
        }
    }
}

impl Environment for Reading<'_, '_> {
    fn variable(&self, id: VariableId) -> Result<Quantity, Failure> {
        match self.0.needed(Node::Variable(id))? {
            Value::Number(quantity) => Ok(*quantity),
            Value::Point(_) | Value::Path(_) | Value::Stage(_) | Value::Seam(_) => {
                Err(missing(Node::Variable(id)))
            }
        }
    }

    fn measurement(&self, name: &str) -> Result<Quantity, Failure> {
        let evaluation = self.0.evaluation;
        if let Some((quantity, _)) = evaluation.measurement(name) {
            return Ok(quantity);
        }
        if let Some(variable) = evaluation.names.variable(name) {
            return self.variable(variable);
        }
        let base = evaluation.pattern.base_measurements();
        let known = evaluation
            .names
            .variable_names()
            .chain(evaluation.wearer.measurements.iter().map(|m| m.0))
            .chain(base.into_iter().flat_map(|base| base.iter().map(|m| m.0)));
        let hint = match nearest(name, known) {
            Some(near) => format!("did you mean {near:?}?"),
            None => "define a variable of that name, or measure it in every size".to_owned(),
        };
        let message = format!("there is no variable or measurement {name:?}");
        Err(Failure::new(Code::MissingReference, message, hint))
    }

    fn length(&self, part: &PartReference) -> Result<f64, Failure> {
        let part = &*self.bound(part, Kind::StretchOrSeam)?;
        if let PartReference::Seam(id) = part {
            return match self.0.needed(Node::Seam(*id))? {
                Value::Seam(seam) => Ok(seam.lengths[0]),
                Value::Number(_) | Value::Point(_) | Value::Path(_) | Value::Stage(_) => {
                    Err(missing(Node::Seam(*id)))
                }
            };
        }
        Ok(self
            .edges(part, Kind::StretchOrSeam)?
            .iter()
            .map(|path| path.length())
            .sum())
    }

    fn finished(&self, part: &PartReference) -> Result<f64, Failure> {
        let part = &*self.bound(part, Kind::StretchOrSeam)?;
        let PartReference::Stretch { panel, ends } = part else {
            return self.length(part);
        };
        let pattern = &self.0.evaluation.pattern;
        let Some(found) = pattern.panel(*panel) else {
            return self.length(part);
        };
        let last = found.operations.last().map(|o| o.id);
        let stage = self.0.stage(Node::Stage(*panel, last))?;
        let drawn = self.0.stage(Node::Stage(*panel, None))?;
        let corners = ends.iter().map(|end| match end {
            Name::Drawn(id) => Some(*id),
            Name::Made { .. } => None,
        });
        let Some(corners) = corners.collect::<Option<Vec<_>>>() else {
            return self.length(part);
        };
        let has = |line: &&crate::Line| line.stretch([corners[0], corners[1]]).is_some();
        let Some(line) = found.lines.iter().find(has) else {
            return self.length(part);
        };
        let name = Name::Drawn(line.id);
        let place = |end: CornerName| stage.placed(drawn, name, MarkValue::Corner(end));
        let walked =
            place(ends[0]).and_then(|from| stage.stretch(name, [from, place(ends[1])?], is_sewn));
        // A stretch on a fold line is no edge of the unfolded panel: its finished length is 0.
        Ok(walked.map_or(0.0, |stretch| stage.stretch_length(0, &stretch)))
    }

    fn ends(&self, part: &PartReference) -> Result<[Vec2; 2], Failure> {
        let part = &*self.bound(part, Kind::Stretch)?;
        let edges = self.edges(part, Kind::Stretch)?;
        let first = edges.first().and_then(|path| path.curves().first());
        let last = edges.last().and_then(|path| path.curves().last());
        match (first, last) {
            (Some(first), Some(last)) => Ok([first.start(), last.end()]),
            _ => Err(Failure::new(
                Code::Formula,
                "it has no length",
                "name another edge",
            )),
        }
    }

    fn point(&self, part: &PartReference) -> Result<Vec2, Failure> {
        match &*self.bound(part, Kind::Point)? {
            PartReference::Point(id) => self.0.point_at(*id),
            PartReference::Curve(_)
            | PartReference::Stretch { .. }
            | PartReference::Seam(_)
            | PartReference::Unknown(_) => Err(Failure::new(
                Code::Formula,
                "it is no point",
                "name a point",
            )),
        }
    }
}

/// Refuses values of the wrong dimension and values that exceed the bounds for garments.
pub(crate) fn bounded(quantity: Quantity, want: Want) -> Result<f64, Failure> {
    let Quantity { value, power, .. } = quantity;
    let (wanted, limit, unit) = match want {
        Want::Length => (1, LONGEST, " m"),
        Want::Plain | Want::Angle => (0, LARGEST, ""),
        Want::Any => (power, LARGEST, ""),
    };
    if !value.is_finite() {
        return Err(Failure::new(
            Code::NotFinite,
            format!("the number is {value}"),
            "give a finite number",
        ));
    }
    if power != wanted && !(value == 0.0 && power == 0) {
        let hint = match want {
            Want::Length => "give a unit, for example 2cm",
            Want::Plain | Want::Any => "divide by a length, or leave the unit out",
            Want::Angle => "give an angle, for example 45deg",
        };
        let (found, wanted) = (kind(power), kind(wanted));
        let message = format!("the result is {found} and should be {wanted}");
        return Err(Failure::new(Code::Formula, message, hint));
    }
    if value.abs() > limit {
        return Err(Failure::new(
            Code::TooLarge,
            format!("the result is {value:.3e}{unit}, beyond {limit}{unit}"),
            "look at the values and units it is made from",
        ));
    }
    Ok(value)
}

/// Refuses positions that exceed the bounds for garments.
pub(crate) fn bounded_place(place: Vec2) -> Result<Vec2, Failure> {
    for value in [place.x, place.y] {
        bounded(Quantity::length(value), Want::Length)?;
    }
    Ok(place)
}
