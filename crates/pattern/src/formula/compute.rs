//! Computes formulas and checks their dimensions: `bust + 2` is refused and `bust + 2cm` is not.

use super::{Comparison, Formula, Function, Operation};
use crate::{Code, PartReference, VariableId};
use toile_geometry::Vec2;

/// A value with its dimension: `power` is 0 for plain numbers and angles, 1 for lengths, 2 for
/// areas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quantity {
    pub value: f64,
    pub power: i8,
    /// Whether a plain number is an angle (rad), which is shown in degrees. Formulas are checked without it.
    pub is_angle: bool,
}

/// Reason why a formula has no value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Failure {
    /// A value that the formula needs is missing. The fault was reported at the node with this number, which
    /// lacks the value.
    Reported(u32),
    /// A fault of this formula, with its column if that is known.
    Fault {
        code: Code,
        column: Option<usize>,
        message: String,
        hint: String,
    },
}

impl Failure {
    pub fn new(code: Code, message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self::Fault {
            code,
            column: None,
            message: message.into(),
            hint: hint.into(),
        }
    }
}

/// Source of the values of the names in formulas.
pub(crate) trait Environment {
    fn variable(&self, id: VariableId) -> Result<Quantity, Failure>;
    fn measurement(&self, name: &str) -> Result<Quantity, Failure>;
    /// Length of a part as drawn (m).
    fn length(&self, part: &PartReference) -> Result<f64, Failure>;
    /// Length of a stretch after all operations (m).
    fn finished(&self, part: &PartReference) -> Result<f64, Failure>;
    /// Start and end of a part as drawn (m).
    fn ends(&self, part: &PartReference) -> Result<[Vec2; 2], Failure>;
    /// Place of a point (m).
    fn point(&self, part: &PartReference) -> Result<Vec2, Failure>;
}

/// Highest power of length allowed in intermediate results.
const MAXIMUM_POWER: i8 = 6;

/// The value of a formula.
pub(crate) fn compute(
    formula: &Formula,
    environment: &impl Environment,
) -> Result<Quantity, Failure> {
    let mut stack: Vec<Quantity> = Vec::new();
    let steps = formula.steps();
    let mut at = 0;
    while let Some(step) = steps.get(at) {
        at += 1;
        let fault = |(message, hint): (String, &str)| Failure::Fault {
            code: Code::Formula,
            column: Some(step.column),
            message,
            hint: hint.into(),
        };
        let here = |failure| match failure {
            Failure::Fault {
                code,
                column: None,
                message,
                hint,
            } => Failure::Fault {
                code,
                column: Some(step.column),
                message,
                hint,
            },
            other @ (Failure::Reported(_) | Failure::Fault { .. }) => other,
        };
        let result = match &step.operation {
            Operation::JumpUnless(to) => {
                let [a] = pop(&mut stack);
                if a.value == 0.0 {
                    at = *to;
                }
                continue;
            }
            Operation::Jump(to) => {
                at = *to;
                continue;
            }
            Operation::Constant(quantity) => *quantity,
            Operation::Variable(id) => environment.variable(*id).map_err(here)?,
            Operation::Word(name) => environment.measurement(name).map_err(here)?,
            Operation::Length(part) => length(environment.length(part).map_err(here)?),
            Operation::Finished(part) => length(environment.finished(part).map_err(here)?),
            Operation::Angle(part) => direction(environment.ends(part).map_err(here)?),
            Operation::AngleBetween(a, b) => direction([
                environment.point(a).map_err(here)?,
                environment.point(b).map_err(here)?,
            ]),
            Operation::Coordinate(point, axis) => {
                length(environment.point(point).map_err(here)?[*axis])
            }
            Operation::Distance(a, b) => {
                let a = environment.point(a).map_err(here)?;
                let b = environment.point(b).map_err(here)?;
                length((b - a).norm())
            }
            Operation::Negate => {
                let [a] = pop(&mut stack);
                Quantity {
                    value: -a.value,
                    ..a
                }
            }
            Operation::Not => {
                let [a] = pop(&mut stack);
                truth(a.value == 0.0)
            }
            Operation::And => {
                let [a, b] = pop(&mut stack);
                truth(a.value != 0.0 && b.value != 0.0)
            }
            Operation::Or => {
                let [a, b] = pop(&mut stack);
                truth(a.value != 0.0 || b.value != 0.0)
            }
            Operation::Compare(comparison) => {
                let [a, b] = pop(&mut stack);
                like(a, b, 0.0).map_err(fault)?;
                truth(compare(*comparison, a.value, b.value))
            }
            Operation::Add => {
                let [a, b] = pop(&mut stack);
                like(a, b, a.value + b.value).map_err(fault)?
            }
            Operation::Subtract => {
                let [a, b] = pop(&mut stack);
                like(a, b, a.value - b.value).map_err(fault)?
            }
            Operation::Multiply => {
                let [a, b] = pop(&mut stack);
                product(a, b).map_err(fault)?
            }
            Operation::Divide => {
                let [a, b] = pop(&mut stack);
                quotient(a, b).map_err(fault)?
            }
            Operation::Call(function, count) => {
                let values = stack.split_off(stack.len() - count);
                call(*function, &values).map_err(fault)?
            }
        };
        if !result.value.is_finite() {
            return Err(fault((
                "the result is not a finite number".into(),
                "look at the values it is made from",
            )));
        }
        stack.push(result);
    }
    let [result] = pop(&mut stack);
    Ok(result)
}

impl Quantity {
    /// A length (m).
    pub fn length(value: f64) -> Self {
        Self {
            power: 1,
            ..Self::plain(value)
        }
    }

    /// A plain number.
    pub fn plain(value: f64) -> Self {
        Self {
            value,
            power: 0,
            is_angle: false,
        }
    }

    /// An angle (rad).
    pub fn angle(value: f64) -> Self {
        Self {
            is_angle: true,
            ..Self::plain(value)
        }
    }
}

fn length(value: f64) -> Quantity {
    Quantity::length(value)
}

fn plain(value: f64) -> Quantity {
    Quantity::plain(value)
}

fn truth(holds: bool) -> Quantity {
    plain(f64::from(u8::from(holds)))
}

fn direction([a, b]: [Vec2; 2]) -> Quantity {
    let way = b - a;
    Quantity::angle(way.y.atan2(way.x))
}

fn compare(comparison: Comparison, a: f64, b: f64) -> bool {
    match comparison {
        Comparison::Less => a < b,
        Comparison::LessOrEqual => a <= b,
        Comparison::More => a > b,
        Comparison::MoreOrEqual => a >= b,
        Comparison::Equal => a == b,
        Comparison::Unequal => a != b,
    }
}

/// Pops the last `N` values; the parser ensures that the stack has enough for each step.
fn pop<const N: usize>(stack: &mut Vec<Quantity>) -> [Quantity; N] {
    let rest = stack.split_off(stack.len() - N);
    std::array::from_fn(|k| rest[k])
}

type Arithmetic = Result<Quantity, (String, &'static str)>;

/// The common power of length of two values. Zero without unit has any power. `None`: the powers differ.
fn common_power(a: Quantity, b: Quantity) -> Option<i8> {
    let any = |q: Quantity| q.value == 0.0 && q.power == 0;
    if a.power == b.power || any(b) {
        Some(a.power)
    } else if any(a) {
        Some(b.power)
    } else {
        None
    }
}

fn like(a: Quantity, b: Quantity, value: f64) -> Arithmetic {
    match common_power(a, b) {
        Some(power) => Ok(Quantity {
            value,
            power,
            is_angle: a.is_angle || b.is_angle,
        }),
        None => Err((
            format!("{} is put together with {}", kind(a.power), kind(b.power)),
            "give the plain number a unit, for example 2cm: here, or in the variable that has it",
        )),
    }
}

fn product(a: Quantity, b: Quantity) -> Arithmetic {
    let power = a.power + b.power;
    if power.abs() > MAXIMUM_POWER {
        return Err((
            "too many lengths are multiplied".into(),
            "a length may be multiplied by plain numbers only, if the result is a length",
        ));
    }
    // The product of an angle (rad) and a length is a length: that of an arc.
    Ok(Quantity {
        value: a.value * b.value,
        power,
        is_angle: power == 0 && a.is_angle != b.is_angle,
    })
}

fn quotient(a: Quantity, b: Quantity) -> Arithmetic {
    if b.value == 0.0 {
        return Err((
            "division by zero".into(),
            "make sure the divisor is not zero for these measurements",
        ));
    }
    product(
        a,
        Quantity {
            power: -b.power,
            ..plain(1.0)
        },
    )
    .map(|q| Quantity {
        value: a.value / b.value,
        is_angle: q.is_angle && !b.is_angle,
        ..q
    })
}

fn call(function: Function, values: &[Quantity]) -> Arithmetic {
    let angle = |name: &str| {
        if values[0].power == 0 {
            Ok(values[0].value)
        } else {
            Err((
                format!("{name} of {}", kind(values[0].power)),
                "give it an angle, for example shoulder_incl or 30deg",
            ))
        }
    };
    let extreme = |better: fn(f64, f64) -> f64| {
        values[1..].iter().try_fold(values[0], |best, &next| {
            like(best, next, better(best.value, next.value))
        })
    };
    match function {
        Function::Minimum => extreme(f64::min),
        Function::Maximum => extreme(f64::max),
        Function::Absolute => Ok(Quantity {
            value: values[0].value.abs(),
            ..values[0]
        }),
        Function::SquareRoot => square_root(values[0]),
        Function::Sine => Ok(plain(angle("sin")?.sin())),
        Function::Cosine => Ok(plain(angle("cos")?.cos())),
        Function::Tangent => Ok(plain(angle("tan")?.tan())),
        Function::ArcTangent2 => {
            like(values[0], values[1], 0.0)?;
            Ok(Quantity::angle(values[0].value.atan2(values[1].value)))
        }
        Function::Hypotenuse => like(values[0], values[1], values[0].value.hypot(values[1].value)),
        Function::Round => round(values[0], values[1]),
    }
}

fn round(a: Quantity, step: Quantity) -> Arithmetic {
    if step.value <= 0.0 {
        return Err((
            "the step that is rounded to is not above zero".into(),
            "give a step, for example 5mm",
        ));
    }
    like(a, step, (a.value / step.value).round() * step.value)
}

fn square_root(a: Quantity) -> Arithmetic {
    if a.value < 0.0 {
        return Err((
            format!("the square root of a negative number ({})", a.value),
            "make sure it is positive for these measurements, for example with max(0, ...)",
        ));
    }
    if a.power % 2 != 0 {
        return Err((
            format!("the square root of {}", kind(a.power)),
            "multiply two lengths under the root",
        ));
    }
    Ok(Quantity {
        power: a.power / 2,
        ..plain(a.value.sqrt())
    })
}

/// Name of a dimension for messages.
pub(crate) fn kind(power: i8) -> &'static str {
    match power {
        0 => "a plain number",
        1 => "a length",
        2 => "an area",
        _ => "a power of a length",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::Names;

    struct Body;

    impl Environment for Body {
        fn variable(&self, _: VariableId) -> Result<Quantity, Failure> {
            Ok(plain(1.0))
        }
        fn measurement(&self, name: &str) -> Result<Quantity, Failure> {
            match name {
                "bust" => Ok(length(0.96)),
                "slope" => Ok(plain(0.5)),
                _ => Err(Failure::new(Code::MissingReference, "unknown", "define it")),
            }
        }
        fn length(&self, _: &PartReference) -> Result<f64, Failure> {
            Ok(0.25)
        }
        fn finished(&self, _: &PartReference) -> Result<f64, Failure> {
            Ok(0.2)
        }
        fn ends(&self, _: &PartReference) -> Result<[Vec2; 2], Failure> {
            Ok([Vec2::zeros(), Vec2::new(0.0, 0.3)])
        }
        fn point(&self, part: &PartReference) -> Result<Vec2, Failure> {
            Ok(match part {
                PartReference::Unknown(text) if text.ends_with('a') => Vec2::new(0.1, 0.2),
                _ => Vec2::new(0.4, 0.6),
            })
        }
    }

    fn value(text: &str) -> Result<Quantity, Failure> {
        compute(&Formula::parse(text, &Names::default()).unwrap(), &Body)
    }

    #[test]
    fn angles_are_known_through_arithmetic() {
        for (text, is_angle) in [
            ("30deg", true),
            ("atan2(bust, 1m) - 90deg", true),
            ("2 * -angle(f.e) / 3 + 0.1", true),
            ("max(abs(30deg), 0.2)", true),
            ("if(1, 1rad, 2)", true),
            ("slope", false),
            ("sin(30deg)", false),
            ("30deg / 10deg", false),
            ("1 / 30deg", false),
            ("30deg * 1m", false),
            ("30deg < 1", false),
            ("bust / 1m", false),
        ] {
            assert_eq!(value(text).unwrap().is_angle, is_angle, "{text}");
        }
    }

    #[test]
    fn arithmetic_has_its_usual_precedence_and_units() {
        for (text, expected, power) in [
            ("1 + 2 * 3 - 4 / 2", 5.0, 0),
            ("-(2 - 5) * -2", -6.0, 0),
            ("10 - 4 - 3", 3.0, 0),
            ("8 / 4 / 2", 1.0, 0),
            ("bust / 4 + 2.5cm", 0.265, 1),
            ("2cm + 5mm + 1m + 1in", 1.0504, 1),
            ("max(1cm, 2cm, 0)", 0.02, 1),
            ("min(bust, 1m)", 0.96, 1),
            ("sqrt(bust * bust)", 0.96, 1),
            ("hypot(3cm, 4cm)", 0.05, 1),
            ("tan(slope) * 1m", 0.5_f64.tan(), 1),
            ("sin(30deg)", 0.5, 0),
            ("atan2(bust, bust)", std::f64::consts::FRAC_PI_4, 0),
            ("length(f.e) / bust", 0.25 / 0.96, 0),
            ("finished(f.e)", 0.2, 1),
            ("angle(f.e)", std::f64::consts::FRAC_PI_2, 0),
            ("distance(f.a, f.b)", 0.5, 1),
            ("y(f.a) - x(f.a)", 0.1, 1),
            ("bust + 0", 0.96, 1),
            ("1e2 mm", 0.1, 1),
            ("1 1/2in + 1/4in", 1.75 * 0.0254, 1),
            (
                "if(bust > 1m, 1, 2) + if(bust <= 1m and 1, 10, 20)",
                12.0,
                0,
            ),
            ("if(0, 1 / 0, 3)", 3.0, 0),
            ("not 0 or 1 / 2", 1.0, 0),
            ("round(bust, 10cm)", 1.0, 1),
            ("1 + (2 = 2)", 2.0, 0),
        ] {
            let got = value(text).unwrap();
            assert!((got.value - expected).abs() < 1e-12, "{text}: {got:?}");
            assert_eq!(got.power, power, "{text}");
        }
    }

    #[test]
    fn mixing_lengths_with_plain_numbers_is_refused_where_it_happens() {
        for (text, at, says) in [
            ("bust + 2", 6, "put together"),
            ("bust < 2", 6, "put together"),
            ("1 / (bust - bust)", 3, "division by zero"),
            ("sqrt(bust)", 1, "square root"),
            ("sqrt(1 - 2)", 1, "negative"),
            ("sin(bust)", 1, "sin of a length"),
            ("round(bust, 0)", 1, "not above zero"),
            ("waist", 1, "unknown"),
            ("1e300 * 1e300", 7, "finite"),
            ("bust*bust*bust*bust*bust*bust*bust", 30, "too many lengths"),
        ] {
            match value(text) {
                Err(Failure::Fault {
                    column: Some(column),
                    message,
                    ..
                }) => {
                    assert_eq!(column, at, "{text}");
                    assert!(message.contains(says), "{text}: {message}");
                }
                other => panic!("{text}: {other:?}"),
            }
        }
    }
}
