//! Swept angle of an arc, which is shown and typed in place of the bulge. The document stores the bulge, the
//! tangent of a quarter of the angle; formulas are kept as formulas.

use super::impossible;
use super::typed::number_text;
use crate::{EditError, Evaluation, Formula, Number, Want};

/// Text before and after the angle in a formula for a bulge.
const AROUND: [&str; 2] = ["tan((", ") / 4)"];
/// Text before and after the bulge in a formula for an angle.
const AROUND_BULGE: [&str; 2] = ["4 * atan2(", ", 1)"];

/// The bulge of an arc that sweeps the angle `angle` (rad), positive counter-clockwise.
///
/// # Errors
/// The angle is zero, a full turn or more, or has no value.
pub fn bulge_of(evaluation: &Evaluation, angle: &Number) -> Result<Number, EditError> {
    let value = evaluation.number(angle, Want::Angle);
    let value = value.ok_or_else(|| impossible("the angle has no value", "type an angle"))?;
    if value.abs() >= std::f64::consts::TAU - 1e-9 || value.abs() < 1e-9 {
        return Err(impossible(
            "an arc sweeps more than nothing and less than a full turn",
            "type an angle between 0 and 360 degrees, negative for clockwise",
        ));
    }
    if let Number::Value(value) = angle {
        return Ok(Number::Value((value / 4.0).tan()));
    }
    let text = number_text(evaluation, angle, Want::Angle);
    let text = match between(&text, AROUND_BULGE) {
        Some(bulge) => bulge.to_owned(),
        None => format!("{}{text}{}", AROUND[0], AROUND[1]),
    };
    formula(evaluation, &text)
}

/// The angle (rad) that an arc with this bulge sweeps.
pub fn angle_of(evaluation: &Evaluation, bulge: &Number) -> Number {
    if let Number::Value(value) = bulge {
        return Number::Value(4.0 * value.atan());
    }
    let text = number_text(evaluation, bulge, Want::Plain);
    let text = match between(&text, AROUND) {
        Some(angle) => angle.to_owned(),
        None => format!("{}{text}{}", AROUND_BULGE[0], AROUND_BULGE[1]),
    };
    formula(evaluation, &text).unwrap_or_else(|_| bulge.clone())
}

/// The text between a prefix and a suffix. `None`: prefix or suffix is missing, or the parentheses between them
/// do not match.
fn between<'t>(text: &'t str, [start, end]: [&str; 2]) -> Option<&'t str> {
    let inner = text.strip_prefix(start)?.strip_suffix(end)?;
    let mut depth = 0_i32;
    let is_whole = inner.chars().all(|c| {
        depth += match c {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        depth >= 0
    });
    (is_whole && depth == 0).then_some(inner)
}

fn formula(evaluation: &Evaluation, text: &str) -> Result<Number, EditError> {
    let read = Formula::parse(text, evaluation.names());
    read.map(Number::Formula)
        .map_err(|error| impossible(error.message, error.hint))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pattern;
    use toile_measure::Measurements;

    #[test]
    fn angles_and_bulges_are_each_others_inverse() {
        let evaluation = Evaluation::new(&Pattern::blank("A"), &Measurements::default());
        let read = |text: &str| formula(&evaluation, text).unwrap();
        for (angle, bulge) in [
            (Number::Value(1.0), Number::Value(0.25_f64.tan())),
            (read("30deg + 10deg"), read("tan((30deg + 10deg) / 4)")),
            (read("4 * atan2(1 + 2, 1)"), read("1 + 2")),
            (read("(1rad) / 2"), read("tan(((1rad) / 2) / 4)")),
        ] {
            assert_eq!(bulge_of(&evaluation, &angle), Ok(bulge.clone()));
            let again = angle_of(&evaluation, &bulge);
            let value = |number| evaluation.number(number, Want::Angle).unwrap();
            assert!((value(&again) - value(&angle)).abs() < 1e-12);
            assert_eq!(again.as_formula(), angle.as_formula());
        }
        // A product of two tangents is not the tangent of a single angle.
        let product = read("tan((1) / 4) * tan((2) / 4)");
        let text = number_text(&evaluation, &angle_of(&evaluation, &product), Want::Angle);
        assert_eq!(text, "4 * atan2(tan((1) / 4) * tan((2) / 4), 1)");
        for angle in [0.0, 7.0] {
            assert!(bulge_of(&evaluation, &Number::Value(angle)).is_err());
        }
    }
}
