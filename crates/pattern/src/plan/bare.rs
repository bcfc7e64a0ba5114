//! Numbers without unit in typed formulas. Beside a length such a number is in the document's unit, beside an
//! angle in degrees: `waist / 4 + 2` is a quarter of the waist plus 2 cm, and where a length is expected,
//! `40 * cos(30deg)` is 40 cm times that. The unit is written into the formula, so that a later change of the
//! document's unit changes no value. An expression with `pi` is an angle in radians and stays as it is.

use crate::formula::{Function, Operation, Quantity};
use crate::{Evaluation, Formula, Want};
use std::f64::consts::PI;
use toile_measure::UnitKind;

/// Quantity of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Length,
    Angle,
    Plain,
    Unknown,
}

/// A value on the stack, as far as it is known without computing the formula.
#[derive(Clone, Debug)]
struct Value {
    kind: Kind,
    /// Columns of the numbers without unit that get one if the value turns out to be a length or an angle:
    /// those of all terms of a sum and both branches of a condition, but of a product only those of its one
    /// factor that has such numbers. A zero needs no unit. `None`: no unit can be given.
    bare: Option<Vec<usize>>,
    /// Whether the value contains `pi`.
    is_round: bool,
}

impl Value {
    fn of(kind: Kind) -> Self {
        Self {
            kind,
            bare: None,
            is_round: false,
        }
    }
}

impl Value {
    /// A product or quotient. If it is plain, the unit is given to the numbers of its only factor that can
    /// have one. If both factors can, it is unknown which one is meant, and neither gets a unit.
    fn product(first: Self, second: Self, kind: impl Fn([Kind; 2]) -> Kind) -> Self {
        let kind = kind([first.kind, second.kind]);
        Self {
            kind,
            bare: match (first.bare, second.bare) {
                (Some(bare), None) | (None, Some(bare)) if kind == Kind::Plain => Some(bare),
                _ => None,
            },
            is_round: first.is_round || second.is_round,
        }
    }
}

/// The text with units added to the numbers without unit that stand for lengths and angles; unchanged if it
/// has no such numbers.
pub(super) fn with_units(
    evaluation: &Evaluation,
    text: &str,
    formula: &Formula,
    want: Want,
) -> String {
    let mut units = Units {
        evaluation,
        given: Vec::new(),
    };
    units.read(formula, want);
    let mut given = units.given;
    given.sort_unstable();
    given.dedup();
    let unit = evaluation.pattern().unit;
    let mut written: Vec<char> = text.chars().collect();
    for (column, kind) in given.into_iter().rev() {
        let end = number_end(&written, column - 1);
        let sign = match kind {
            Kind::Angle => "deg",
            Kind::Length | Kind::Plain | Kind::Unknown => unit.sign(),
        };
        written.splice(end..end, sign.chars());
    }
    written.into_iter().collect()
}

/// The position after the digits of the number that begins at `start`.
fn number_end(text: &[char], start: usize) -> usize {
    let mut end = start;
    while let Some(c) = text.get(end) {
        let sign_of_exponent =
            matches!(c, '+' | '-') && end > start && matches!(text[end - 1], 'e' | 'E');
        let exponent = matches!(c, 'e' | 'E')
            && text
                .get(end + 1)
                .is_some_and(|next| next.is_ascii_digit() || matches!(next, '+' | '-'));
        if !(c.is_ascii_digit() || *c == '.' || exponent || sign_of_exponent) {
            break;
        }
        end += 1;
    }
    end
}

struct Units<'e> {
    evaluation: &'e Evaluation,
    /// Columns of the numbers that get a unit, each with the kind of unit.
    given: Vec<(usize, Kind)>,
}

impl Units<'_> {
    /// Runs through the steps of a formula once, with kinds of quantities on the stack instead of values.
    fn read(&mut self, formula: &Formula, want: Want) {
        let mut stack: Vec<Value> = Vec::new();
        // Indices of the steps at which the two branches of a condition join.
        let mut meets: Vec<usize> = Vec::new();
        for (k, step) in formula.steps().iter().enumerate() {
            self.meet(&mut stack, &mut meets, k);
            let mut pop = || stack.pop().unwrap_or_else(|| Value::of(Kind::Unknown));
            let value = match &step.operation {
                Operation::Constant(constant) => self.constant(step.column, *constant),
                Operation::Variable(id) => Value::of(match self.evaluation.variable(*id) {
                    Some((_, 1)) => Kind::Length,
                    Some(_) if self.evaluation.is_angle(*id) => Kind::Angle,
                    Some((_, 0)) => Kind::Plain,
                    _ => Kind::Unknown,
                }),
                Operation::Word(name) => Value::of(self.measured(name)),
                Operation::Length(_)
                | Operation::Finished(_)
                | Operation::Coordinate(..)
                | Operation::Distance(..) => Value::of(Kind::Length),
                Operation::Angle(_) | Operation::AngleBetween(..) => Value::of(Kind::Angle),
                Operation::Negate => pop(),
                Operation::Not => {
                    pop();
                    Value::of(Kind::Plain)
                }
                Operation::Add | Operation::Subtract => {
                    let (second, first) = (pop(), pop());
                    self.join([first, second])
                }
                Operation::Compare(_) | Operation::And | Operation::Or => {
                    let (second, first) = (pop(), pop());
                    self.join([first, second]);
                    Value::of(Kind::Plain)
                }
                Operation::Multiply => {
                    let (second, first) = (pop(), pop());
                    Value::product(first, second, |kinds| match kinds {
                        [Kind::Plain, kind] | [kind, Kind::Plain] => kind,
                        // The product of an angle (rad) and a length is a length: that of an arc.
                        [Kind::Angle, Kind::Length] | [Kind::Length, Kind::Angle] => Kind::Length,
                        _ => Kind::Unknown,
                    })
                }
                Operation::Divide => {
                    let (mut second, first) = (pop(), pop());
                    // A quotient takes its unit at the dividend.
                    second.bare = None;
                    Value::product(first, second, |kinds| match kinds {
                        [kind, Kind::Plain] => kind,
                        [Kind::Length, Kind::Length] | [Kind::Angle, Kind::Angle] => Kind::Plain,
                        [Kind::Length, Kind::Angle] => Kind::Length,
                        _ => Kind::Unknown,
                    })
                }
                Operation::Call(function, count) => {
                    let values: Vec<Value> = (0..*count).map(|_| pop()).collect();
                    self.call(*function, values)
                }
                Operation::JumpUnless(_) => {
                    pop();
                    continue;
                }
                Operation::Jump(to) => {
                    meets.push(*to);
                    continue;
                }
            };
            stack.push(value);
        }
        self.meet(&mut stack, &mut meets, formula.steps().len());
        let wanted = match want {
            Want::Length => Kind::Length,
            Want::Angle => Kind::Angle,
            Want::Plain | Want::Any => return,
        };
        if let Some(result) = stack.pop() {
            self.join([result, Value::of(wanted)]);
        }
    }

    fn meet(&mut self, stack: &mut Vec<Value>, meets: &mut Vec<usize>, step: usize) {
        while meets.last() == Some(&step) {
            meets.pop();
            if let (Some(second), Some(first)) = (stack.pop(), stack.pop()) {
                let joined = self.join([first, second]);
                stack.push(joined);
            }
        }
    }

    fn call(&mut self, function: Function, values: Vec<Value>) -> Value {
        match function {
            Function::Minimum | Function::Maximum | Function::Hypotenuse | Function::Round => {
                let joined = values.into_iter().reduce(|a, b| self.join([a, b]));
                joined.unwrap_or_else(|| Value::of(Kind::Unknown))
            }
            Function::Absolute => values
                .into_iter()
                .next()
                .unwrap_or_else(|| Value::of(Kind::Unknown)),
            Function::SquareRoot => Value::of(match values.first().map(|value| value.kind) {
                Some(Kind::Plain) => Kind::Plain,
                _ => Kind::Unknown,
            }),
            Function::Sine | Function::Cosine | Function::Tangent => Value::of(Kind::Plain),
            Function::ArcTangent2 => {
                let _ = values.into_iter().reduce(|a, b| self.join([a, b]));
                Value::of(Kind::Angle)
            }
        }
    }

    /// Joins two values that must be of one quantity: if one of them is a length or an angle, the numbers
    /// without unit in the other get its unit.
    fn join(&mut self, [first, second]: [Value; 2]) -> Value {
        let bare_of = |value: &Value| value.bare.clone().unwrap_or_default();
        let mut give = |plain: &Value, kind: Kind| {
            if kind == Kind::Length || !plain.is_round {
                self.given
                    .extend(bare_of(plain).iter().map(|&column| (column, kind)));
            }
            Value::of(kind)
        };
        match [first.kind, second.kind] {
            [kind @ (Kind::Length | Kind::Angle), Kind::Plain] => give(&second, kind),
            [Kind::Plain, kind @ (Kind::Length | Kind::Angle)] => give(&first, kind),
            [Kind::Plain, Kind::Plain] => Value {
                kind: Kind::Plain,
                bare: first.bare.zip(second.bare).map(|(mut all, more)| {
                    all.extend(more);
                    all
                }),
                is_round: first.is_round || second.is_round,
            },
            [kind, other] if kind == other => Value::of(kind),
            _ => Value::of(Kind::Unknown),
        }
    }

    fn constant(&self, column: usize, constant: Quantity) -> Value {
        match constant {
            Quantity { power: 1, .. } => Value::of(Kind::Length),
            Quantity { is_angle: true, .. } => Value::of(Kind::Angle),
            Quantity { value, .. } => Value {
                kind: Kind::Plain,
                // `pi` is a name and takes no unit.
                bare: match value {
                    PI => None,
                    0.0 => Some(Vec::new()),
                    _ => Some(vec![column]),
                },
                is_round: value == PI,
            },
        }
    }

    fn measured(&self, name: &str) -> Kind {
        if let Some(known) = toile_measure::definition(name) {
            return match known.kind {
                UnitKind::Angle => Kind::Angle,
                _ => Kind::Length,
            };
        }
        let pattern = self.evaluation.pattern();
        let base = pattern.base_measurements();
        match base.and_then(|table| table.get(name)) {
            Some(_) => Kind::Length,
            None => Kind::Unknown,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Evaluation, Number, Pattern, Want, plan};
    use toile_measure::{Measurements, Origin};

    #[test]
    fn a_bare_number_beside_a_length_or_an_angle_gets_its_unit() {
        let mut wearer = Measurements::new();
        for (name, value) in [("waist", 0.72), ("shoulder_incl", 0.37)] {
            wearer.set(name, value, Origin::Asked).unwrap();
        }
        let evaluation = Evaluation::new(&Pattern::blank("A"), &wearer);
        for (typed, kept, want) in [
            ("waist/4+2", "waist/4+2cm", Want::Length),
            ("2.5 + waist / 4", "2.5cm + waist / 4", Want::Length),
            ("waist/4 + (1 + 2)", "waist/4 + (1cm + 2cm)", Want::Length),
            ("waist - -3", "waist - -3cm", Want::Length),
            ("max(waist/4, 20)", "max(waist/4, 20cm)", Want::Length),
            ("round(waist/4, 0.5)", "round(waist/4, 0.5cm)", Want::Length),
            (
                "if(waist > 80, 2, 3.5)",
                "if(waist > 80cm, 2cm, 3.5cm)",
                Want::Length,
            ),
            (
                "waist / 4 + if(waist > 80cm, 2, 3)",
                "waist / 4 + if(waist > 80cm, 2cm, 3cm)",
                Want::Length,
            ),
            ("90 - shoulder_incl", "90deg - shoulder_incl", Want::Angle),
            (
                "shoulder_incl * 0.9 + 5",
                "shoulder_incl * 0.9 + 5deg",
                Want::Angle,
            ),
            ("waist + 1e1", "waist + 1e1cm", Want::Length),
            // A variable may be of any quantity: only a number that stands beside a length gets a unit.
            ("waist/4 + 2", "waist/4 + 2cm", Want::Any),
            // Factors, zeros and ratios get no unit.
            ("waist * 2", "waist * 2", Want::Length),
            ("max(waist, 0)", "max(waist, 0)", Want::Length),
            ("waist / 72cm + 1", "waist / 72cm + 1", Want::Plain),
            ("waist + 1 5/8in", "waist + 1 5/8in", Want::Length),
            ("waist + 3 mm", "waist + 3 mm", Want::Length),
            // In a product one factor is the length, in a quotient the dividend.
            ("40*cos(30deg)", "40cm*cos(30deg)", Want::Length),
            ("sin(30deg) * 40 / 3", "sin(30deg) * 40cm / 3", Want::Length),
            ("(1 + 2) * pi", "(1cm + 2cm) * pi", Want::Length),
            ("sqrt(2) * 5 - waist", "sqrt(2) * 5cm - waist", Want::Length),
            ("waist / (2*pi)", "waist / (2*pi)", Want::Length),
            ("3 * shoulder_incl", "3 * shoulder_incl", Want::Angle),
            // An angle with `pi` is in radians, as in textbooks.
            ("pi / 6", "pi / 6", Want::Angle),
            (
                "2 * pi / 3 + shoulder_incl",
                "2 * pi / 3 + shoulder_incl",
                Want::Angle,
            ),
        ] {
            let number = plan::read_number(&evaluation, typed, want).unwrap();
            let shown = plan::number_text(&evaluation, &number, want);
            assert_eq!(shown, kept, "{typed}");
            assert!(evaluation.number(&number, want).is_some(), "{typed}");
            // The text that is shown may be typed again.
            assert_eq!(plan::read_number(&evaluation, &shown, want), Ok(number));
        }
        // A sum with a plain variable or product is no length: it gets no unit and is refused where it is
        // used.
        let number = plan::read_number(&evaluation, "waist + 2 * 3", Want::Length).unwrap();
        assert!(matches!(number, Number::Formula(_)));
        assert!(evaluation.number(&number, Want::Length).is_none());
    }
}
