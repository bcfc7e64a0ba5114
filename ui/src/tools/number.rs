//! Typed and displayed numbers: lengths in the document's unit, angles in degrees.

use toile_pattern::{DisplayUnit, Evaluation, Number, Want, plan};

/// Reads a typed number. A bare number is in the document's unit, or in degrees; a decimal comma equals a
/// point; a formula may begin with `=`.
///
/// # Errors
/// The error in the formula, and the remedy.
pub fn parse(text: &str, want: Want, evaluation: &Evaluation) -> Result<Number, String> {
    let text = text.trim().trim_start_matches('=').trim();
    let plain = match text.matches(',').count() {
        // Without parentheses the text has no arguments that the comma could separate: it is a decimal
        // comma.
        1 if !text.contains('(') => text.replace(',', "."),
        _ => text.to_owned(),
    };
    let number = plan::read_number(evaluation, &plain, want).map_err(|error| error.to_string())?;
    evaluation.number_or_fault(&number, want)?;
    Ok(number)
}

/// Whether a number or formula can begin with this character.
pub fn begins_typing(c: char) -> bool {
    c.is_ascii_digit() || matches!(c, '=' | '.' | ',' | '-' | '+' | '(')
}

/// Text of a value with its unit.
pub fn show(value: f64, want: Want, unit: DisplayUnit) -> String {
    match want {
        Want::Length => {
            let digits = match unit {
                DisplayUnit::Millimetre => 1,
                DisplayUnit::Centimetre | DisplayUnit::Inch => 2,
                DisplayUnit::Metre => 4,
            };
            format!("{} {}", trimmed(value / unit.metres(), digits), unit.sign())
        }
        Want::Angle => format!("{}\u{b0}", trimmed(value.to_degrees(), 2)),
        Want::Plain | Want::Any => trimmed(value, 4),
    }
}

/// Text of a number with at most `digits` digits after the point.
fn trimmed(value: f64, digits: usize) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;
    use toile_pattern::Pattern;

    #[test]
    fn numbers_are_typed_in_the_units_of_the_document() {
        let pattern = Pattern::blank("A");
        let evaluation = Evaluation::new(&pattern, &toile_measure::Measurements::default());
        let read = |text: &str, want| parse(text, want, &evaluation);
        assert_eq!(read("12,5", Want::Length), Ok(Number::Value(0.125)));
        assert_eq!(read("=3mm", Want::Length), Ok(Number::Value(0.003)));
        assert_eq!(
            read("90", Want::Angle),
            Ok(Number::Value(90_f64.to_radians()))
        );
        assert!(
            read("waist / 4", Want::Length).is_err(),
            "nobody was measured"
        );
        assert!(read("max(1cm,", Want::Length).is_err());
        assert!(read("1e999", Want::Length).is_err());
        assert_eq!(
            show(0.1234, Want::Length, DisplayUnit::Centimetre),
            "12.34 cm"
        );
        assert_eq!(show(-1e-9, Want::Length, DisplayUnit::Millimetre), "0 mm");
    }
}
