//! Numbers of a file in its declared unit, so that every value in memory is read back bit by bit.

use toile_pattern::DisplayUnit;

/// Metres in an inch.
const INCH: f64 = 0.0254;

/// Power of ten by which a number of metres is multiplied to get the unit; `None` for units that are not
/// decimal.
fn decimals(unit: DisplayUnit) -> Option<i32> {
    match unit {
        DisplayUnit::Metre => Some(0),
        DisplayUnit::Centimetre => Some(2),
        DisplayUnit::Millimetre => Some(3),
        DisplayUnit::Inch => None,
    }
}

/// The length (m) that a number in a file stands for; `None` if it is not finite.
pub fn read_length(raw: &str, unit: DisplayUnit) -> Option<f64> {
    let value = match decimals(unit) {
        Some(places) => shifted(raw, -places)?,
        None => raw.parse::<f64>().ok()? * INCH,
    };
    value.is_finite().then_some(value)
}

/// Largest length that is written (m): larger ones might exceed the number range of other programs.
const LARGEST: f64 = 1e290;

/// The number that is written for a length (m); `None` if no number is read back as exactly this length.
pub fn write_length(value: f64, unit: DisplayUnit) -> Option<String> {
    if value.abs() > LARGEST {
        return None;
    }
    let candidates = match decimals(unit) {
        Some(places) => vec![decimal(value, places)],
        None => neighbours(value / INCH),
    };
    let exact = |raw: &String| read_length(raw, unit).map(f64::to_bits) == Some(value.to_bits());
    candidates.into_iter().find(exact)
}

/// The angle (rad) that a number of degrees in a file stands for; `None` if it is not finite.
pub fn read_degrees(raw: &str) -> Option<f64> {
    let degrees: f64 = raw.parse().ok()?;
    degrees.is_finite().then(|| degrees.to_radians())
}

/// The number of degrees that is written for an angle (rad); `None` if no number is read back as exactly this
/// angle.
pub fn write_degrees(value: f64) -> Option<String> {
    let exact = |raw: &String| read_degrees(raw).map(f64::to_bits) == Some(value.to_bits());
    neighbours(value.to_degrees()).into_iter().find(exact)
}

/// A plain number of a file; `None` if it is not finite.
pub fn read_plain(raw: &str) -> Option<f64> {
    raw.parse().ok().filter(|value: &f64| value.is_finite())
}

/// The shortest text that is read back as the number.
pub fn write_plain(value: f64) -> String {
    decimal(value, 0)
}

/// Texts to try, in this order: a round number near the value, the value itself, its neighbours in `f64`.
fn neighbours(value: f64) -> Vec<String> {
    let round: f64 = format!("{value:.12e}").parse().unwrap_or(value);
    [
        round,
        value,
        value.next_up(),
        value.next_down(),
        value.next_up().next_up(),
        value.next_down().next_down(),
    ]
    .into_iter()
    .map(write_plain)
    .collect()
}

/// The number `raw` times ten to the power of `places`, correctly rounded.
fn shifted(raw: &str, places: i32) -> Option<f64> {
    let (digits, exponent) = match raw.split_once(['e', 'E']) {
        Some((digits, exponent)) => (digits, exponent.parse::<i32>().ok()?),
        None => (raw, 0),
    };
    format!("{digits}e{}", exponent.checked_add(places)?)
        .parse()
        .ok()
}

/// The shortest decimal that is read back as the value, with its point moved right by `places`.
fn decimal(value: f64, places: i32) -> String {
    let text = format!("{value:e}");
    let Some((mantissa, exponent)) = text.split_once('e') else {
        return text;
    };
    let exponent = exponent.parse::<i32>().unwrap_or(0) + places;
    let (sign, mantissa) = match mantissa.strip_prefix('-') {
        Some(rest) => ("-", rest),
        None => ("", mantissa),
    };
    let digits: String = mantissa.chars().filter(|c| *c != '.').collect();
    if digits == "0" {
        return format!("{sign}0");
    }
    let count = digits.len() as i32;
    if !(-6..=15).contains(&exponent) {
        let (first, rest) = digits.split_at(1);
        let point = if rest.is_empty() { "" } else { "." };
        return format!("{sign}{first}{point}{rest}e{exponent}");
    }
    if exponent < 0 {
        let zeros = "0".repeat((-exponent - 1) as usize);
        format!("{sign}0.{zeros}{digits}")
    } else if count <= exponent + 1 {
        let zeros = "0".repeat((exponent + 1 - count) as usize);
        format!("{sign}{digits}{zeros}")
    } else {
        let (whole, part) = digits.split_at((exponent + 1) as usize);
        format!("{sign}{whole}.{part}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_look_as_a_person_writes_them() {
        assert_eq!(
            write_length(0.123, DisplayUnit::Centimetre).unwrap(),
            "12.3"
        );
        assert_eq!(write_length(1.5, DisplayUnit::Millimetre).unwrap(), "1500");
        assert_eq!(
            write_length(-0.0005, DisplayUnit::Centimetre).unwrap(),
            "-0.05"
        );
        assert_eq!(write_length(0.0, DisplayUnit::Metre).unwrap(), "0");
        assert_eq!(write_length(0.0254, DisplayUnit::Inch).unwrap(), "1");
        assert_eq!(write_degrees(45_f64.to_radians()).unwrap(), "45");
        assert_eq!(write_degrees(std::f64::consts::FRAC_PI_2).unwrap(), "90");
        assert_eq!(write_plain(1e300), "1e300");
        assert_eq!(write_plain(0.35), "0.35");
        assert_eq!(read_length("1e400", DisplayUnit::Metre), None);
        assert_eq!(read_length("1e99999999999", DisplayUnit::Centimetre), None);
    }

    proptest! {
        #[test]
        fn decimal_units_are_exact_for_every_value(value in any::<f64>()) {
            prop_assume!(value.abs() <= LARGEST);
            for unit in [DisplayUnit::Metre, DisplayUnit::Centimetre, DisplayUnit::Millimetre] {
                let raw = write_length(value, unit).unwrap();
                prop_assert_eq!(read_length(&raw, unit).unwrap().to_bits(), value.to_bits());
            }
            prop_assert_eq!(read_plain(&write_plain(value)).unwrap().to_bits(), value.to_bits());
        }
    }
}
