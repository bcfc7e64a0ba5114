//! Evaluates formulas, keeping track of lengths, so that `bust + 2` is refused and `bust + 2cm`
//! is not.

use crate::Code;
use crate::formula::{Formula, Function, Operation, Reference};
use toile_geometry::Vec2;

/// A value with its dimension: `power` is 0 for plain numbers and angles, 1 for lengths, 2 for
/// areas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quantity {
    pub value: f64,
    pub power: i8,
}

/// Why a formula has no value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Failure {
    /// Something it needs has no value; that was reported where it stands.
    Reported,
    /// A fault of this formula.
    Fault {
        code: Code,
        column: usize,
        message: String,
        hint: String,
    },
    /// What it names is not there, or is being computed right now.
    Lookup {
        code: Code,
        message: String,
        hint: String,
    },
}

/// Where formulas look names up.
pub(crate) trait Environment {
    /// A variable or measurement.
    fn named(&mut self, name: &str) -> Result<Quantity, Failure>;
    /// Length of an edge [m].
    fn edge_length(&mut self, reference: &Reference) -> Result<f64, Failure>;
    /// Place of a point [m].
    fn point(&mut self, reference: &Reference) -> Result<Vec2, Failure>;
}

/// Highest power of a length that makes sense on the way to a result.
const MAXIMUM_POWER: i8 = 6;

/// The value of a formula.
pub(crate) fn evaluate(
    formula: &Formula,
    environment: &mut impl Environment,
) -> Result<Quantity, Failure> {
    let mut stack: Vec<Quantity> = Vec::new();
    for step in formula.steps() {
        let fault = |(message, hint): (String, &str)| Failure::Fault {
            code: Code::Formula,
            column: step.column,
            message,
            hint: hint.into(),
        };
        let at_column = |failure| match failure {
            Failure::Lookup {
                code,
                message,
                hint,
            } => Failure::Fault {
                code,
                column: step.column,
                message,
                hint,
            },
            other => other,
        };
        let result = match &step.operation {
            Operation::Constant { value, power } => Quantity {
                value: *value,
                power: *power,
            },
            Operation::Name(name) => environment.named(name).map_err(at_column)?,
            Operation::EdgeLength(edge) => {
                length(environment.edge_length(edge).map_err(at_column)?)
            }
            Operation::Coordinate(point, axis) => {
                length(environment.point(point).map_err(at_column)?[*axis])
            }
            Operation::Distance(a, b) => {
                let a = environment.point(a).map_err(at_column)?;
                let b = environment.point(b).map_err(at_column)?;
                length((b - a).norm())
            }
            Operation::Negate => {
                let [a] = pop(&mut stack);
                Quantity {
                    value: -a.value,
                    power: a.power,
                }
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

fn length(value: f64) -> Quantity {
    Quantity { value, power: 1 }
}

/// The last `N` values; the parser wrote as many as each step takes.
fn pop<const N: usize>(stack: &mut Vec<Quantity>) -> [Quantity; N] {
    let rest = stack.split_off(stack.len() - N);
    std::array::from_fn(|k| rest[k])
}

type Arithmetic = Result<Quantity, (String, &'static str)>;

/// The dimension two values share; zero has any.
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
        Some(power) => Ok(Quantity { value, power }),
        None => Err((
            format!("{} is put together with {}", kind(a.power), kind(b.power)),
            "give the plain number a unit, for example 2cm",
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
    Ok(Quantity {
        value: a.value * b.value,
        power,
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
            value: 1.0,
            power: -b.power,
        },
    )
    .map(|q| Quantity {
        value: a.value / b.value,
        power: q.power,
    })
}

fn call(function: Function, values: &[Quantity]) -> Arithmetic {
    let plain = |name: &str| {
        if values[0].power == 0 {
            Ok(values[0].value)
        } else {
            Err((
                format!("{name} of {}", kind(values[0].power)),
                "give it an angle, for example shoulder_incl or 30deg",
            ))
        }
    };
    let angle = |value: f64| Quantity { value, power: 0 };
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
            power: values[0].power,
        }),
        Function::SquareRoot => square_root(values[0]),
        Function::Sine => Ok(angle(plain("sin")?.sin())),
        Function::Cosine => Ok(angle(plain("cos")?.cos())),
        Function::Tangent => Ok(angle(plain("tan")?.tan())),
        Function::ArcTangent2 => {
            like(values[0], values[1], 0.0)?;
            Ok(Quantity {
                value: values[0].value.atan2(values[1].value),
                power: 0,
            })
        }
        Function::Hypotenuse => like(values[0], values[1], values[0].value.hypot(values[1].value)),
    }
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
        value: a.value.sqrt(),
        power: a.power / 2,
    })
}

/// A dimension in words.
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

    struct Body;

    impl Environment for Body {
        fn named(&mut self, name: &str) -> Result<Quantity, Failure> {
            match name {
                "bust" => Ok(length(0.96)),
                "slope" => Ok(Quantity {
                    value: 0.5,
                    power: 0,
                }),
                _ => Err(Failure::Lookup {
                    code: Code::MissingReference,
                    message: "unknown".into(),
                    hint: "define it".into(),
                }),
            }
        }
        fn edge_length(&mut self, _: &Reference) -> Result<f64, Failure> {
            Ok(0.25)
        }
        fn point(&mut self, reference: &Reference) -> Result<Vec2, Failure> {
            Ok(match &*reference.part {
                "a" => Vec2::new(0.1, 0.2),
                _ => Vec2::new(0.4, 0.6),
            })
        }
    }

    fn value(text: &str) -> Result<Quantity, Failure> {
        evaluate(&Formula::parse(text).unwrap(), &mut Body)
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
            ("distance(f.a, f.b)", 0.5, 1),
            ("y(f.a) - x(f.a)", 0.1, 1),
            ("bust + 0", 0.96, 1),
            ("1e2 mm", 0.1, 1),
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
            ("1 / (bust - bust)", 3, "division by zero"),
            ("sqrt(bust)", 1, "square root"),
            ("sqrt(1 - 2)", 1, "negative"),
            ("sin(bust)", 1, "sin of a length"),
            ("waist", 1, "unknown"),
            ("1e300 * 1e300", 7, "finite"),
            ("bust*bust*bust*bust*bust*bust*bust", 30, "too many lengths"),
        ] {
            match value(text) {
                Err(Failure::Fault {
                    column, message, ..
                }) => {
                    assert_eq!(column, at, "{text}");
                    assert!(message.contains(says), "{text}: {message}");
                }
                other => panic!("{text}: {other:?}"),
            }
        }
    }
}
