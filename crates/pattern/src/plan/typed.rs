//! Numbers as typed and shown: formulas, and numbers without unit in the unit of the document.

use super::bare::with_units;
use super::impossible;
use crate::formula::Operation;
use crate::{DisplayUnit, EditError, Evaluation, Formula, Number, PartReference, Token, Want};

/// Number of decimals with which a value is written in its unit. They are finer than any pattern needs, and
/// few enough to hide rounding errors in the last bits.
const DECIMALS: usize = 9;
/// Number of decimals to which a value in its unit is rounded to see whether it was typed. If it was, the
/// rounded value is shown.
const TYPED: usize = 6;
/// Largest difference between a value in its unit and that value rounded to [`TYPED`] decimals at which it
/// counts as typed.
const SAME: f64 = 1e-9;

impl DisplayUnit {
    /// Length of the unit (m).
    pub fn metres(self) -> f64 {
        match self {
            Self::Millimetre => 0.001,
            Self::Centimetre => 0.01,
            Self::Metre => 1.0,
            Self::Inch => 0.0254,
        }
    }

    /// Symbol of the unit, as formulas write it.
    pub fn sign(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
            Self::Inch => "in",
        }
    }
}

/// The number that a text stands for in a field for the quantity `want`. A number without unit is in the
/// document's unit if the field holds a length, and in degrees if it holds an angle; it becomes a value, and
/// so does a single number with a unit. Any other text becomes a formula, in which a number without unit
/// beside a length or an angle gets a unit.
///
/// # Errors
/// The text is not a formula; it names a part that is missing.
pub fn read_number(evaluation: &Evaluation, text: &str, want: Want) -> Result<Number, EditError> {
    let text = text.trim();
    let formula = Formula::parse(text, evaluation.names()).map_err(|error| {
        let message = format!("column {}: {}", error.column, error.message);
        impossible(message, error.hint)
    })?;
    refuse_unknown(&formula)?;
    let formula = match is_bare(text) {
        true => formula,
        false => {
            let written = with_units(evaluation, text, &formula, want);
            Formula::parse(&written, evaluation.names()).unwrap_or(formula)
        }
    };
    let number = Number::Formula(formula.clone());
    let is_constant = formula
        .tokens()
        .iter()
        .all(|token| matches!(token, Token::Text(_)));
    if !is_constant {
        return Ok(number);
    }
    let unit = evaluation.pattern().unit;
    let plain = evaluation.number(&number, Want::Plain);
    if let Some(value) = plain.filter(|_| is_bare(text)) {
        match want {
            Want::Length => return Ok(Number::Value(in_metres(text, value, unit))),
            Want::Angle => return Ok(Number::Value(value.to_radians())),
            Want::Plain | Want::Any => {}
        }
    }
    let is_single = matches!(
        formula
            .steps()
            .iter()
            .map(|step| &step.operation)
            .collect::<Vec<_>>()[..],
        [Operation::Constant(_)] | [Operation::Constant(_), Operation::Negate]
    );
    // In a field for any quantity a number with a unit stays a formula, since a value in such a field is a
    // plain number.
    let want = match want {
        Want::Any if !is_bare(text) => return Ok(number),
        Want::Any => Want::Plain,
        want @ (Want::Length | Want::Plain | Want::Angle) => want,
    };
    let value = evaluation.number(&number, want).filter(|_| is_single);
    Ok(value.map_or(number, Number::Value))
}

/// A length typed in the document's unit, in metres (m). Digits alone are read with the unit as their decimal
/// exponent, so that 12.3 cm is 0.123 m to the last bit, as in files.
fn in_metres(text: &str, value: f64, unit: DisplayUnit) -> f64 {
    let exponent = match unit {
        DisplayUnit::Millimetre => -3,
        DisplayUnit::Centimetre => -2,
        DisplayUnit::Metre => 0,
        DisplayUnit::Inch => return value * unit.metres(),
    };
    let shifted: Option<f64> = format!("{text}e{exponent}").parse().ok();
    shifted.unwrap_or(value * unit.metres())
}

/// Whether a text has no units and no functions: its only letters are those of exponents.
fn is_bare(text: &str) -> bool {
    let mut before = ' ';
    text.chars().all(|c| {
        let is_exponent = matches!(c, 'e' | 'E') && (before.is_ascii_digit() || before == '.');
        before = c;
        is_exponent || !c.is_alphabetic()
    })
}

/// Refuses names of missing parts. Other words are accepted: they may be measurements in a table.
fn refuse_unknown(formula: &Formula) -> Result<(), EditError> {
    let mut unknown = formula.tokens().iter().filter_map(|token| match token {
        Token::Part(PartReference::Unknown(text)) => Some(text),
        Token::Text(_) | Token::Variable(_) | Token::Word(_) | Token::Part(_) => None,
    });
    match unknown.next() {
        Some(text) => Err(impossible(
            format!("{text} is not there"),
            "name an edge, a point or a seam of this pattern, as in front.armhole",
        )),
        None => Ok(()),
    }
}

/// The text of a number, which can be typed again and used in formulas: a formula with current names, a value
/// with its unit, or the value for the current size if sizes have their own.
pub fn number_text(evaluation: &Evaluation, number: &Number, want: Want) -> String {
    text(evaluation, (number, want), exact)
}

/// The text of a number for display: like [`number_text`], but a computed value is rounded to a hundredth of
/// a millimetre or of a degree.
pub fn number_shown(evaluation: &Evaluation, number: &Number, want: Want) -> String {
    text(evaluation, (number, want), shown)
}

/// Function that writes a value in its unit; it also gets the number of decimals needed.
type Digits = fn(f64, usize) -> String;

fn exact(value: f64, _: usize) -> String {
    format!("{value:.DECIMALS$}")
}

fn shown(value: f64, needed: usize) -> String {
    let typed = format!("{value:.TYPED$}");
    let parsed = typed.parse();
    let is_typed = parsed.is_ok_and(|typed: f64| (typed - value).abs() <= SAME);
    match is_typed {
        true => typed,
        false => format!("{value:.needed$}"),
    }
}

fn text(evaluation: &Evaluation, (number, want): (&Number, Want), digits: Digits) -> String {
    let names = evaluation.names();
    match number {
        Number::Value(value) => value_text(evaluation, (*value, want), digits),
        Number::Formula(formula) => formula.text(names),
        // The text is exact: if it is typed again it gives the same formula and adjustment.
        Number::Adjusted { formula, by } => {
            let sign = if *by < 0.0 { '-' } else { '+' };
            let by = value_text(evaluation, (by.abs(), want), exact);
            format!("({}) {sign} {by}", formula.text(names))
        }
        Number::PerSize { usual, sizes } => {
            let own = sizes.iter().find(|own| Some(own.0) == evaluation.size());
            match own {
                Some((_, value)) => value_text(evaluation, (*value, want), digits),
                None => text(evaluation, (usual, want), digits),
            }
        }
    }
}

fn value_text(evaluation: &Evaluation, (value, want): (f64, Want), digits: Digits) -> String {
    let unit = evaluation.pattern().unit;
    let (value, sign, needed) = match want {
        Want::Length => {
            let needed = match unit {
                DisplayUnit::Millimetre => 2,
                DisplayUnit::Centimetre => 3,
                DisplayUnit::Metre => 5,
                DisplayUnit::Inch => 4,
            };
            (value / unit.metres(), unit.sign(), needed)
        }
        Want::Angle => (value.to_degrees(), "deg", 2),
        Want::Plain | Want::Any => (value, "", 4),
    };
    let digits = digits(value, needed);
    let short = match digits.contains('.') {
        true => digits.trim_end_matches('0').trim_end_matches('.'),
        false => &digits,
    };
    match short {
        "-0" => format!("0{sign}"),
        short => format!("{short}{sign}"),
    }
}
