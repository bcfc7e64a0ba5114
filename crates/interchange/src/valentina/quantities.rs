//! Quantities of the values of formulas, found from the names and functions in them.

use super::expression::{Expression, Operator};
use super::kinds::{LENGTH, PLAIN, Quantity};

/// Highest power of length that is followed through a formula.
const MAX_POWER: i8 = 4;

/// Source of the quantities of names. `None`: nothing says yet what the name is.
pub(super) trait Quantities {
    fn quantity(&self, name: &str) -> Option<Quantity>;
}

/// The quantity of a formula's value. `None`: it is made of numbers alone, and may be any.
pub(super) fn quantity_of(formula: &Expression, of: &impl Quantities) -> Option<Quantity> {
    match formula {
        Expression::Literal(_) => None,
        Expression::Name(name) => match constant(name) {
            Some(_) => Some(PLAIN),
            None => of.quantity(name),
        },
        Expression::Negative(inner) => quantity_of(inner, of),
        Expression::Pair(operator, pair) => {
            let [a, b] = pair.each_ref().map(|one| quantity_of(one, of));
            match operator {
                Operator::Add | Operator::Subtract => a.or(b),
                Operator::Multiply => product(a, b),
                Operator::Divide => quotient(a, b),
                Operator::Power => Some(raised(a, exponent(&pair[1]))),
                Operator::Less
                | Operator::LessOrEqual
                | Operator::More
                | Operator::MoreOrEqual
                | Operator::Equal
                | Operator::Unequal
                | Operator::And
                | Operator::Or => Some(PLAIN),
            }
        }
        Expression::Choice(three) => quantity_of(&three[1], of).or(quantity_of(&three[2], of)),
        Expression::Call(name, arguments) => match name.as_str() {
            "abs" | "min" | "max" | "sum" | "avg" | "rint" | "r2cm" | "fmod" => {
                arguments.iter().find_map(|one| quantity_of(one, of))
            }
            "sqrt" => match arguments.first().and_then(|one| quantity_of(one, of)) {
                Some(Quantity::Power(power)) if power % 2 == 0 => Some(Quantity::Power(power / 2)),
                Some(_) | None => Some(PLAIN),
            },
            "asinD" | "acosD" | "atanD" | "atan2D" | "radTodeg" => Some(Quantity::Angle),
            _ => Some(PLAIN),
        },
    }
}

fn bounded(power: i8) -> Quantity {
    Quantity::Power(power.clamp(-MAX_POWER, MAX_POWER))
}

fn product(a: Option<Quantity>, b: Option<Quantity>) -> Option<Quantity> {
    use Quantity::{Angle, Power};
    match (a, b) {
        (None | Some(Power(0)), None) | (None, Some(Power(0))) => None,
        (Some(one), None) | (None, Some(one)) => Some(one),
        (Some(Power(a)), Some(Power(b))) => Some(bounded(a + b)),
        (Some(Angle), Some(Power(0))) | (Some(Power(0)), Some(Angle)) => Some(Angle),
        (Some(Angle), Some(Power(power))) | (Some(Power(power)), Some(Angle)) => Some(Power(power)),
        (Some(Angle), Some(Angle)) => Some(PLAIN),
    }
}

fn quotient(a: Option<Quantity>, b: Option<Quantity>) -> Option<Quantity> {
    use Quantity::{Angle, Power};
    match (a, b) {
        (None, None | Some(Power(0))) => None,
        (None, Some(Power(power))) | (Some(Angle), Some(Power(power @ (1.. | ..=-1)))) => {
            Some(Power(-power))
        }
        (None | Some(Angle), Some(Angle)) => Some(PLAIN),
        (Some(Angle), None | Some(Power(_))) => Some(Angle),
        (Some(one), None) => Some(one),
        (Some(Power(a)), Some(Power(b))) => Some(bounded(a - b)),
        (Some(Power(power)), Some(Angle)) => Some(Power(power)),
    }
}

/// The quantity of a power, whose base is taken as a plain number where this is one.
fn raised(base: Option<Quantity>, exponent: Option<f64>) -> Quantity {
    match (base, exponent) {
        (Some(Quantity::Power(power)), Some(exponent))
            if exponent.fract() == 0.0 && (f64::from(power) * exponent).abs() <= 4.0 =>
        {
            Quantity::Power((f64::from(power) * exponent) as i8)
        }
        _ => PLAIN,
    }
}

/// The value of an exponent of numbers alone.
pub(super) fn exponent(formula: &Expression) -> Option<f64> {
    match formula {
        Expression::Literal(number) => Some(*number),
        Expression::Negative(inner) => exponent(inner).map(|number| -number),
        Expression::Pair(Operator::Divide, pair) => Some(exponent(&pair[0])? / exponent(&pair[1])?),
        Expression::Pair(Operator::Power, pair) => {
            Some(exponent(&pair[0])?.powf(exponent(&pair[1])?))
        }
        Expression::Name(_)
        | Expression::Pair(..)
        | Expression::Choice(_)
        | Expression::Call(..) => None,
    }
}

/// The value of a constant of the language.
pub(super) fn constant(name: &str) -> Option<f64> {
    match name {
        "_pi" | "pi" => Some(std::f64::consts::PI),
        "_e" => Some(std::f64::consts::E),
        _ => None,
    }
}

/// Passes on what a formula is wanted as to the names in it of which nothing is known yet.
pub(super) fn demand(
    formula: &Expression,
    want: Quantity,
    of: &impl Quantities,
    found: &mut impl FnMut(&str, Quantity),
) {
    let own = quantity_of(formula, of).unwrap_or(want);
    match formula {
        Expression::Literal(_) => {}
        Expression::Name(name) => {
            let unknown = constant(name).is_none() && of.quantity(name).is_none();
            if unknown && (own == LENGTH || own == Quantity::Angle) {
                found(name, own);
            }
        }
        Expression::Negative(inner) => demand(inner, own, of, found),
        Expression::Choice(three) => {
            demand(&three[0], PLAIN, of, found);
            demand(&three[1], own, of, found);
            demand(&three[2], own, of, found);
        }
        Expression::Pair(operator, pair) => {
            let both = pair.each_ref().map(|one| quantity_of(one, of));
            let wants = match operator {
                Operator::Add | Operator::Subtract => [own; 2],
                Operator::Multiply => match both {
                    [None, None] if is_number(&pair[0]) => [PLAIN, own],
                    [None, None] if is_number(&pair[1]) => [own, PLAIN],
                    [Some(PLAIN), None] => [PLAIN, own],
                    [None, Some(PLAIN)] => [own, PLAIN],
                    _ => [PLAIN; 2],
                },
                Operator::Divide => match both[1] {
                    None | Some(PLAIN) => [own, PLAIN],
                    Some(_) => [PLAIN; 2],
                },
                Operator::Less
                | Operator::LessOrEqual
                | Operator::More
                | Operator::MoreOrEqual
                | Operator::Equal
                | Operator::Unequal => [both[0].or(both[1]).unwrap_or(PLAIN); 2],
                Operator::Power | Operator::And | Operator::Or => [PLAIN; 2],
            };
            for (one, want) in pair.iter().zip(wants) {
                demand(one, want, of, found);
            }
        }
        Expression::Call(name, arguments) => {
            let each = match name.as_str() {
                "abs" | "min" | "max" | "sum" | "avg" | "rint" | "r2cm" | "fmod" => own,
                "sinD" | "cosD" | "tanD" | "degTorad" => Quantity::Angle,
                _ => PLAIN,
            };
            for one in arguments {
                demand(one, each, of, found);
            }
        }
    }
}

/// Whether a formula has no names.
fn is_number(formula: &Expression) -> bool {
    let mut names = 0;
    formula.each_name(&mut |name| names += usize::from(constant(name).is_none()));
    names == 0
}
