//! Quantities of values in formulas, whose numbers have no units there.

/// Quantity of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// A power of length: 0 for plain numbers, 1 for lengths.
    Power(i8),
    /// An angle, in degrees there.
    Angle,
}

/// A plain number.
pub(super) const PLAIN: Quantity = Quantity::Power(0);
/// A length.
pub(super) const LENGTH: Quantity = Quantity::Power(1);

/// Unit of lengths of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FileUnit {
    /// Word of the unit in our formulas.
    pub word: &'static str,
}

impl FileUnit {
    /// The unit of a word in the file.
    pub fn of(word: &str) -> Option<Self> {
        let word = match word {
            "mm" => "mm",
            "cm" => "cm",
            "inch" | "in" => "in",
            _ => return None,
        };
        Some(Self { word })
    }

    /// Size of the unit (m).
    pub fn metres(self) -> f64 {
        match self.word {
            "mm" => 1e-3,
            "cm" => 1e-2,
            _ => 0.0254,
        }
    }

    /// A value of the file in metres or radians.
    pub fn si(self, value: f64, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Power(power) => value * self.metres().powi(i32::from(power)),
            Quantity::Angle => value.to_radians(),
        }
    }

    /// A value in metres or radians in the units of the file.
    pub fn of_si(self, value: f64, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Power(power) => value / self.metres().powi(i32::from(power)),
            Quantity::Angle => value.to_degrees(),
        }
    }
}

/// A value that formulas name: its text in our formulas, and its value in the file's units.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Symbol {
    /// Text in our formulas, a primary expression.
    pub text: String,
    /// Quantity of the text.
    pub quantity: Quantity,
    /// Value for the base size, in the file's unit or in degrees.
    pub value: f64,
}
