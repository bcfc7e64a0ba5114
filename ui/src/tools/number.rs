//! Numbers as they are typed and shown: lengths in the document's unit, angles in degrees.

use toile_pattern::{DisplayUnit, Evaluation, Formula, Number, Want};

/// What a number measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A length.
    Length,
    /// An angle.
    Angle,
    /// A share, a count, a factor.
    Plain,
}

impl Kind {
    /// What a formula for it must give.
    pub fn want(self) -> Want {
        match self {
            Self::Length => Want::Length,
            Self::Angle | Self::Plain => Want::Plain,
        }
    }
}

/// The short name of a unit, and its size [m].
pub fn unit(unit: DisplayUnit) -> (&'static str, f64) {
    match unit {
        DisplayUnit::Millimetre => ("mm", 0.001),
        DisplayUnit::Centimetre => ("cm", 0.01),
        DisplayUnit::Metre => ("m", 1.0),
        DisplayUnit::Inch => ("in", 0.0254),
    }
}

/// A number of a tool or a field from what was typed: a bare number is in the document's unit or
/// in degrees, and a decimal comma is as good as a point; all else is a formula.
///
/// # Errors
/// What is wrong with the formula, and what to do.
pub fn parse(text: &str, kind: Kind, evaluation: &Evaluation) -> Result<Number, String> {
    let text = text.trim().trim_start_matches('=').trim();
    let plain = match text.matches(',').count() {
        1 => text.replace(',', "."),
        _ => text.to_owned(),
    };
    if let Ok(value) = plain.parse::<f64>() {
        if !value.is_finite() {
            return Err("the number is not finite: type another".into());
        }
        return Ok(Number::Value(match kind {
            Kind::Length => value * unit(evaluation.pattern().unit).1,
            Kind::Angle => value.to_radians(),
            Kind::Plain => value,
        }));
    }
    let formula = Formula::parse(text, evaluation.names())
        .map_err(|error| format!("column {}: {}: {}", error.column, error.message, error.hint))?;
    let number = Number::Formula(formula);
    match evaluation.number_or_fault(&number, kind.want()) {
        Ok(_) => Ok(number),
        Err(words) => Err(words),
    }
}

/// A value in words.
pub fn show(value: f64, kind: Kind, of: DisplayUnit) -> String {
    match kind {
        Kind::Length => {
            let (name, size) = unit(of);
            let digits = match of {
                DisplayUnit::Millimetre => 1,
                DisplayUnit::Centimetre | DisplayUnit::Inch => 2,
                DisplayUnit::Metre => 4,
            };
            format!("{} {name}", trimmed(value / size, digits))
        }
        Kind::Angle => format!("{}\u{b0}", trimmed(value.to_degrees(), 2)),
        Kind::Plain => trimmed(value, 4),
    }
}

/// A number with at most so many digits after the point.
pub fn trimmed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    match text {
        "-0" => "0".into(),
        text => text.into(),
    }
}
