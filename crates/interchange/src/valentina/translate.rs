//! Formulas of Valentina and Seamly2D written as ours, and their values.
//!
//! Numbers there have no units: lengths are in the unit of the file, angles in degrees. A number beside a
//! length gets the unit of the file; where a value is used as another quantity than it is, it is divided by
//! one unit and multiplied by another, so that every formula keeps its value.

use super::expression::{Expression, Operator};
use super::kinds::{FileUnit, LENGTH, PLAIN, Quantity, Symbol};
use super::quantities::{Quantities, constant, exponent, quantity_of};

/// Largest exponent that is written as a product.
const MAX_EXPONENT: f64 = 6.0;

/// Source of the names of formulas.
pub(super) trait Scope: Quantities {
    fn symbol(&self, name: &str) -> Option<Symbol>;
    fn unit(&self) -> FileUnit;
}

/// Strengths of binding of texts, from sums to single values.
const OR: u8 = 1;
const AND: u8 = 2;
const COMPARISON: u8 = 3;
const SUM: u8 = 4;
const PRODUCT: u8 = 5;
const SIGN: u8 = 6;
const SINGLE: u8 = 7;

/// Text of a formula, and how strongly its outermost operator binds.
struct Bound {
    text: String,
    strength: u8,
}

impl Bound {
    fn new(text: impl Into<String>, strength: u8) -> Self {
        Self {
            text: text.into(),
            strength,
        }
    }

    fn single(text: impl Into<String>) -> Self {
        Self::new(text, SINGLE)
    }

    /// The text, in parentheses if it binds less than this.
    fn at_least(&self, strength: u8) -> String {
        match self.strength >= strength {
            true => self.text.clone(),
            false => format!("({})", self.text),
        }
    }
}

/// A formula in our words.
///
/// # Errors
/// A name or a function that nothing is known of, in words.
pub(super) fn translated(
    formula: &Expression,
    want: Quantity,
    scope: &impl Scope,
) -> Result<String, String> {
    Ok(written(formula, want, scope)?.text)
}

/// A primary expression of our formulas: the formula, in parentheses where needed.
pub(super) fn translated_single(
    formula: &Expression,
    want: Quantity,
    scope: &impl Scope,
) -> Result<String, String> {
    Ok(written(formula, want, scope)?.at_least(SINGLE))
}

fn written(formula: &Expression, want: Quantity, scope: &impl Scope) -> Result<Bound, String> {
    let own = quantity_of(formula, scope).unwrap_or(want);
    let text = raw(formula, own, scope)?;
    Ok(coerced(text, own, want, scope.unit()))
}

/// A value as another quantity: the number of its units is kept.
fn coerced(text: Bound, own: Quantity, want: Quantity, unit: FileUnit) -> Bound {
    if own == want {
        return text;
    }
    let mut made = text.at_least(PRODUCT);
    let (length, degree) = (format!("1{}", unit.word), "1deg".to_owned());
    let mut times = |quantity: Quantity, up: bool| {
        let (one, power) = match quantity {
            Quantity::Power(power) => (&length, power),
            Quantity::Angle => (&degree, 1),
        };
        let sign = if (power > 0) == up { " * " } else { " / " };
        for _ in 0..power.unsigned_abs() {
            made.push_str(sign);
            made.push_str(one);
        }
    };
    times(own, false);
    times(want, true);
    Bound::new(made, PRODUCT)
}

fn raw(formula: &Expression, own: Quantity, scope: &impl Scope) -> Result<Bound, String> {
    match formula {
        Expression::Literal(number) => Ok(literal(*number, own, scope.unit())),
        Expression::Name(name) => match constant(name) {
            Some(value) => Ok(coerced(
                Bound::single(value.to_string()),
                PLAIN,
                own,
                scope.unit(),
            )),
            None => {
                let symbol = scope.symbol(name).ok_or_else(|| unknown(name))?;
                let text = Bound::single(symbol.text);
                Ok(coerced(text, symbol.quantity, own, scope.unit()))
            }
        },
        Expression::Negative(inner) => {
            let inner = written(inner, own, scope)?;
            Ok(Bound::new(format!("-{}", inner.at_least(SINGLE)), SIGN))
        }
        Expression::Pair(operator, pair) => pair_text(*operator, pair, own, scope),
        Expression::Choice(three) => {
            let condition = written(&three[0], PLAIN, scope)?.text;
            let then = written(&three[1], own, scope)?.text;
            let otherwise = written(&three[2], own, scope)?.text;
            Ok(Bound::single(format!(
                "if({condition}, {then}, {otherwise})"
            )))
        }
        Expression::Call(name, arguments) => call(name, arguments, own, scope),
    }
}

fn literal(number: f64, own: Quantity, unit: FileUnit) -> Bound {
    match own {
        LENGTH => Bound::single(format!("{number}{}", unit.word)),
        Quantity::Angle => Bound::single(format!("{number}deg")),
        Quantity::Power(_) => coerced(Bound::single(number.to_string()), PLAIN, own, unit),
    }
}

fn pair_text(
    operator: Operator,
    pair: &[Expression; 2],
    own: Quantity,
    scope: &impl Scope,
) -> Result<Bound, String> {
    use Quantity::{Angle, Power};
    let both = pair.each_ref().map(|one| quantity_of(one, scope));
    let alike = both[0].or(both[1]).unwrap_or(PLAIN);
    let (wants, sign, strength) = match operator {
        Operator::Add => ([own; 2], "+", SUM),
        Operator::Subtract => ([own; 2], "-", SUM),
        Operator::Multiply => {
            let wants = match both {
                [Some(Power(0)), None] => [PLAIN, own],
                [_, None] | [None, Some(Power(0))] | [Some(Angle), Some(Power(0))] => [own, PLAIN],
                [None, Some(_)] | [Some(Power(0)), Some(Angle)] => [PLAIN, own],
                [Some(Power(a)), Some(Power(b))] => [Power(a), Power(b)],
                [Some(Angle), Some(Power(b))] => [PLAIN, Power(b)],
                [Some(Power(a)), Some(Angle)] => [Power(a), PLAIN],
                [Some(Angle), Some(Angle)] => [PLAIN; 2],
            };
            (wants, "*", PRODUCT)
        }
        Operator::Divide => {
            let wants = match both {
                [_, None | Some(Power(0))] => [own, PLAIN],
                [None | Some(Angle), Some(Power(b))] => [PLAIN, Power(b)],
                [None | Some(Angle), Some(Angle)] => [Angle; 2],
                [Some(Power(a)), Some(Power(b))] => [Power(a), Power(b)],
                [Some(Power(a)), Some(Angle)] => [Power(a), PLAIN],
            };
            (wants, "/", PRODUCT)
        }
        Operator::Less => ([alike; 2], "<", COMPARISON),
        Operator::LessOrEqual => ([alike; 2], "<=", COMPARISON),
        Operator::More => ([alike; 2], ">", COMPARISON),
        Operator::MoreOrEqual => ([alike; 2], ">=", COMPARISON),
        Operator::Equal => ([alike; 2], "=", COMPARISON),
        Operator::Unequal => ([alike; 2], "!=", COMPARISON),
        Operator::And => ([PLAIN; 2], "and", AND),
        Operator::Or => ([PLAIN; 2], "or", OR),
        Operator::Power => return power(pair, both[0], scope),
    };
    let left = written(&pair[0], wants[0], scope)?;
    let right = written(&pair[1], wants[1], scope)?;
    // Comparisons do not stand in a row, and the right side of a sum or product binds more strongly.
    let left_strength = if strength == COMPARISON {
        SUM
    } else {
        strength
    };
    let left = left.at_least(left_strength);
    let right = right.at_least(strength + 1);
    Ok(Bound::new(format!("{left} {sign} {right}"), strength))
}

/// A power as a product: exponents are whole or half numbers.
fn power(
    pair: &[Expression; 2],
    base: Option<Quantity>,
    scope: &impl Scope,
) -> Result<Bound, String> {
    let found = exponent(&pair[1]).filter(|e| e.abs() <= MAX_EXPONENT && (2.0 * e).fract() == 0.0);
    let exponent = found.ok_or("the exponent is no whole or half number up to 6")?;
    let base = match base {
        Some(Quantity::Power(power))
            if exponent.fract() == 0.0 && (f64::from(power) * exponent).abs() <= 4.0 =>
        {
            Quantity::Power(power)
        }
        _ => PLAIN,
    };
    let text = written(&pair[0], base, scope)?;
    let whole = exponent.abs().trunc() as usize;
    let mut factors = vec![text.at_least(SINGLE); whole];
    if exponent.fract() != 0.0 {
        factors.push(format!("sqrt({})", text.text));
    }
    let product = factors.join(" * ");
    Ok(match (factors.len(), exponent < 0.0) {
        (0, _) => Bound::single("1"),
        (1, false) => Bound::single(product),
        (_, false) => Bound::new(product, PRODUCT),
        (1, true) => Bound::new(format!("1 / {product}"), PRODUCT),
        (_, true) => Bound::new(format!("1 / ({product})"), PRODUCT),
    })
}

fn call(
    name: &str,
    arguments: &[Expression],
    own: Quantity,
    scope: &impl Scope,
) -> Result<Bound, String> {
    let each = |want: Quantity| -> Result<Vec<Bound>, String> {
        let texts = arguments.iter().map(|one| written(one, want, scope));
        texts.collect()
    };
    let listed = |all: Vec<Bound>| -> String {
        let texts: Vec<String> = all.into_iter().map(|one| one.text).collect();
        texts.join(", ")
    };
    let first = |want: Quantity| -> Result<Bound, String> {
        match arguments {
            [one] => written(one, want, scope),
            _ => Err(format!("{name} takes one value")),
        }
    };
    let one_unit = || literal(1.0, own, scope.unit()).text;
    let plain = |text: String| Ok(Bound::single(text));
    match name {
        "min" | "max" => plain(format!("{name}({})", listed(each(own)?))),
        "abs" => plain(format!("abs({})", first(own)?.text)),
        "sum" => {
            let texts: Vec<String> = each(own)?.iter().map(|one| one.at_least(PRODUCT)).collect();
            Ok(Bound::new(texts.join(" + "), SUM))
        }
        "avg" => {
            let texts: Vec<String> = each(own)?.iter().map(|one| one.at_least(PRODUCT)).collect();
            let text = format!("({}) / {}", texts.join(" + "), texts.len());
            Ok(Bound::new(text, PRODUCT))
        }
        "rint" => plain(format!("round({}, {})", first(own)?.text, one_unit())),
        "r2cm" => {
            let step = format!("{} / 10", one_unit());
            plain(format!("round({}, {step})", first(own)?.text))
        }
        "sqrt" => {
            let inner = match arguments.first().and_then(|one| quantity_of(one, scope)) {
                Some(Quantity::Power(power)) if power % 2 == 0 => Quantity::Power(power),
                Some(_) | None => PLAIN,
            };
            plain(format!("sqrt({})", first(inner)?.text))
        }
        "sin" | "cos" | "tan" => plain(format!("{name}({})", first(PLAIN)?.text)),
        "sinD" => plain(format!("sin({})", first(Quantity::Angle)?.text)),
        "cosD" => plain(format!("cos({})", first(Quantity::Angle)?.text)),
        "tanD" => plain(format!("tan({})", first(Quantity::Angle)?.text)),
        // An angle in degrees there and the same in radians are one value here.
        "radTodeg" => first(PLAIN),
        "degTorad" => first(Quantity::Angle),
        "atan" | "atanD" => plain(format!("atan2({}, 1)", first(PLAIN)?.text)),
        "asin" | "asinD" => {
            let x = first(PLAIN)?;
            let single = x.at_least(SINGLE);
            plain(format!("atan2({}, sqrt(1 - {single} * {single}))", x.text))
        }
        "acos" | "acosD" => {
            let x = first(PLAIN)?;
            let single = x.at_least(SINGLE);
            plain(format!("atan2(sqrt(1 - {single} * {single}), {})", x.text))
        }
        "atan2" | "atan2D" => match arguments {
            [_, _] => plain(format!("atan2({})", listed(each(PLAIN)?))),
            _ => Err(format!("{name} takes two values")),
        },
        "sign" => {
            let x = first(PLAIN)?.text;
            plain(format!("if({x} < 0, -1, if({x} > 0, 1, 0))"))
        }
        "fmod" => match arguments {
            [_, _] => {
                let both = each(own)?;
                let (a, b) = (both[0].at_least(PRODUCT), both[1].at_least(SIGN));
                // Quotients are cut towards zero: halves are rounded away from it.
                let floor = format!("(round(abs({a} / {b}) + 0.5, 1) - 1)");
                let cut = format!("if({a} / {b} < 0, -1, 1) * {floor}");
                Ok(Bound::new(format!("{a} - {b} * {cut}"), SUM))
            }
            _ => Err(format!("{name} takes two values")),
        },
        _ => Err(format!("the function {name:?} is not known")),
    }
}

pub(super) fn unknown(name: &str) -> String {
    format!("nothing is called {name:?}")
}

/// The value of a formula for the base size, in the file's units.
///
/// # Errors
/// A name or a function that nothing is known of, in words.
pub(super) fn value(formula: &Expression, scope: &impl Scope) -> Result<f64, String> {
    let truth = |is: bool| if is { 1.0 } else { 0.0 };
    Ok(match formula {
        Expression::Literal(number) => *number,
        Expression::Name(name) => match constant(name) {
            Some(value) => value,
            None => scope.symbol(name).ok_or_else(|| unknown(name))?.value,
        },
        Expression::Negative(inner) => -value(inner, scope)?,
        Expression::Choice(three) => match value(&three[0], scope)? == 0.0 {
            false => value(&three[1], scope)?,
            true => value(&three[2], scope)?,
        },
        Expression::Pair(operator, pair) => {
            let (a, b) = (value(&pair[0], scope)?, value(&pair[1], scope)?);
            match operator {
                Operator::Add => a + b,
                Operator::Subtract => a - b,
                Operator::Multiply => a * b,
                Operator::Divide => a / b,
                Operator::Power => a.powf(b),
                Operator::Less => truth(a < b),
                Operator::LessOrEqual => truth(a <= b),
                Operator::More => truth(a > b),
                Operator::MoreOrEqual => truth(a >= b),
                Operator::Equal => truth(a == b),
                Operator::Unequal => truth(a != b),
                Operator::And => truth(a != 0.0 && b != 0.0),
                Operator::Or => truth(a != 0.0 || b != 0.0),
            }
        }
        Expression::Call(name, arguments) => {
            let all: Result<Vec<f64>, String> =
                arguments.iter().map(|one| value(one, scope)).collect();
            let all = all?;
            let sum: f64 = all.iter().sum();
            match (name.as_str(), all.as_slice()) {
                ("min", _) => all.iter().copied().fold(f64::INFINITY, f64::min),
                ("max", _) => all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
                ("sum", _) => sum,
                ("avg", _) => sum / all.len() as f64,
                ("abs", [x]) => x.abs(),
                ("rint", [x]) => x.round(),
                ("r2cm", [x]) => (x * 10.0).round() / 10.0,
                ("sqrt", [x]) => x.sqrt(),
                ("sin", [x]) => x.sin(),
                ("cos", [x]) => x.cos(),
                ("tan", [x]) => x.tan(),
                ("sinD", [x]) => x.to_radians().sin(),
                ("cosD", [x]) => x.to_radians().cos(),
                ("tanD", [x]) => x.to_radians().tan(),
                ("radTodeg", [x]) => x.to_degrees(),
                ("degTorad", [x]) => x.to_radians(),
                ("atan", [x]) => x.atan(),
                ("asin", [x]) => x.asin(),
                ("acos", [x]) => x.acos(),
                ("atanD", [x]) => x.atan().to_degrees(),
                ("asinD", [x]) => x.asin().to_degrees(),
                ("acosD", [x]) => x.acos().to_degrees(),
                ("atan2", [y, x]) => y.atan2(*x),
                ("atan2D", [y, x]) => y.atan2(*x).to_degrees(),
                ("sign", [x]) => f64::from(i8::from(*x > 0.0) - i8::from(*x < 0.0)),
                ("fmod", [a, b]) => a % b,
                _ => return Err(format!("the function {name:?} is not known")),
            }
        }
    })
}
