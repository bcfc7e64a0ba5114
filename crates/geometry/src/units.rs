//! Lengths, angles and durations with their units, for constructors, command lines and files.

use std::fmt;
use std::str::FromStr;

/// A length. Stored in metres; other units exist only in constructors and texts.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Default)]
pub struct Length(f64);

/// An angle. Stored in radians.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Default)]
pub struct Angle(f64);

/// A duration. Stored in seconds.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Default)]
pub struct Duration(f64);

/// Why a text is not a length, an angle or a duration.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnitError {
    /// No number could be read.
    #[error("\"{0}\" does not start with a number; write for example {1}")]
    NotANumber(String, &'static str),
    /// The number is followed by a unit that is not known here.
    #[error("\"{0}\" is not a unit known here; use one of {1}")]
    UnknownUnit(String, &'static str),
    /// The number stands alone.
    #[error("\"{0}\" has no unit; write it with one of {1}")]
    NoUnit(String, &'static str),
    /// The number is not finite.
    #[error("\"{0}\" is not a finite number")]
    NotFinite(String),
}

const INCH: f64 = 0.0254;

impl Length {
    /// From metres (m).
    pub const fn metres(value: f64) -> Self {
        Self(value)
    }
    /// From centimetres (cm).
    pub const fn centimetres(value: f64) -> Self {
        Self(value / 100.0)
    }
    /// From millimetres (mm).
    pub const fn millimetres(value: f64) -> Self {
        Self(value / 1000.0)
    }
    /// From inches (in).
    pub const fn inches(value: f64) -> Self {
        Self(value * INCH)
    }
    /// In metres (m).
    pub const fn as_metres(self) -> f64 {
        self.0
    }
    /// In centimetres (cm).
    pub const fn as_centimetres(self) -> f64 {
        self.0 * 100.0
    }
    /// In millimetres (mm).
    pub const fn as_millimetres(self) -> f64 {
        self.0 * 1000.0
    }
}

impl Angle {
    /// From radians (rad).
    pub const fn radians(value: f64) -> Self {
        Self(value)
    }
    /// From degrees (deg).
    pub const fn degrees(value: f64) -> Self {
        Self(value.to_radians())
    }
    /// In radians (rad).
    pub const fn as_radians(self) -> f64 {
        self.0
    }
    /// In degrees (deg).
    pub const fn as_degrees(self) -> f64 {
        self.0.to_degrees()
    }
}

impl Duration {
    /// From seconds (s).
    pub const fn seconds(value: f64) -> Self {
        Self(value)
    }
    /// In seconds (s).
    pub const fn as_seconds(self) -> f64 {
        self.0
    }
}

/// Splits `"12.5 cm"` into its number and its unit; `example` is one that could be read.
fn split<'a>(text: &'a str, example: &'static str) -> Result<(f64, &'a str), UnitError> {
    let text = text.trim();
    let end = text
        .char_indices()
        .find(|&(at, c)| {
            let exponent = matches!(c, 'e' | 'E')
                && text[at + 1..].starts_with(|d: char| d.is_ascii_digit() || d == '-' || d == '+');
            !(c.is_ascii_digit() || matches!(c, '.' | '-' | '+') || exponent)
        })
        .map_or(text.len(), |(at, _)| at);
    let number: f64 = text[..end]
        .parse()
        .map_err(|_| UnitError::NotANumber(text.to_owned(), example))?;
    if !number.is_finite() {
        return Err(UnitError::NotFinite(text.to_owned()));
    }
    Ok((number, text[end..].trim()))
}

/// What is wrong with the unit of a text.
fn unit_error(text: &str, unit: &str, known: &'static str) -> UnitError {
    match unit {
        "" => UnitError::NoUnit(text.trim().to_owned(), known),
        unit => UnitError::UnknownUnit(unit.to_owned(), known),
    }
}

impl FromStr for Length {
    type Err = UnitError;

    /// Reads `150cm`, `1.5 m`, `12 mm`, `60in`. A unit is required, but for zero.
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let (number, unit) = split(text, "150cm")?;
        match unit {
            "mm" => Ok(Self::millimetres(number)),
            "cm" => Ok(Self::centimetres(number)),
            "m" => Ok(Self::metres(number)),
            "in" | "\"" => Ok(Self::inches(number)),
            "" if number == 0.0 => Ok(Self(0.0)),
            other => Err(unit_error(text, other, "mm, cm, m, in")),
        }
    }
}

impl FromStr for Angle {
    type Err = UnitError;

    /// Reads `45deg`, `45°`, `0.5rad`. A unit is required, but for zero.
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let (number, unit) = split(text, "45deg")?;
        match unit {
            "deg" | "°" => Ok(Self::degrees(number)),
            "rad" => Ok(Self::radians(number)),
            "" if number == 0.0 => Ok(Self(0.0)),
            other => Err(unit_error(text, other, "deg, rad")),
        }
    }
}

impl FromStr for Duration {
    type Err = UnitError;

    /// Reads `10s`, `250 ms`, `1.5min`; a number alone is in seconds.
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let (number, unit) = split(text, "10s")?;
        match unit {
            "ms" => Ok(Self(number * 1e-3)),
            "s" | "" => Ok(Self(number)),
            "min" => Ok(Self(number * 60.0)),
            other => Err(unit_error(text, other, "ms, s, min")),
        }
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1} mm", self.as_millimetres())
    }
}

impl fmt::Display for Angle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1} deg", self.as_degrees())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_read_in_every_unit() {
        for (text, metres) in [
            ("150cm", 1.5),
            ("1.5 m", 1.5),
            ("-12mm", -0.012),
            ("10in", 0.254),
            ("1e3 mm", 1.0),
            ("0", 0.0),
        ] {
            let got: Length = text.parse().expect(text);
            assert!((got.as_metres() - metres).abs() < 1e-12, "{text}: {got:?}");
        }
        assert_eq!(
            "12".parse::<Length>(),
            Err(UnitError::NoUnit("12".into(), "mm, cm, m, in"))
        );
        assert!(matches!(
            "cm".parse::<Length>(),
            Err(UnitError::NotANumber(_, "150cm"))
        ));
        assert!(matches!(
            "1e999m".parse::<Length>(),
            Err(UnitError::NotFinite(_))
        ));
    }

    #[test]
    fn angles_are_read_in_degrees_and_radians() {
        let right: Angle = "90deg".parse().expect("degrees");
        assert!((right.as_radians() - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert!("90 turns".parse::<Angle>().is_err());
    }

    #[test]
    fn durations_are_read_in_every_unit() {
        for (text, seconds) in [
            ("10s", 10.0),
            ("250 ms", 0.25),
            ("1.5min", 90.0),
            ("7", 7.0),
        ] {
            let got: Duration = text.parse().expect(text);
            assert!(
                (got.as_seconds() - seconds).abs() < 1e-12,
                "{text}: {got:?}"
            );
        }
        let error = "2 hours"
            .parse::<Duration>()
            .expect_err("no unit known here");
        assert_eq!(
            error.to_string(),
            "\"hours\" is not a unit known here; use one of ms, s, min"
        );
        let error = "soon".parse::<Duration>().expect_err("no number");
        assert!(
            error.to_string().ends_with("write for example 10s"),
            "{error}"
        );
    }
}
