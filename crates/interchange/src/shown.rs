//! Lengths and areas in words, in the unit of a document.

use toile_pattern::DisplayUnit;

/// Inches in a yard.
const YARD: f64 = 36.0;

/// Puts numbers in words: inches where a document has inches, else centimetres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown(pub DisplayUnit);

impl Shown {
    /// Whether it shows inches.
    pub fn is_inch(self) -> bool {
        self.0 == DisplayUnit::Inch
    }

    /// A length (m) with its unit.
    pub fn length(self, metres: f64) -> String {
        match self.is_inch() {
            true => format!("{:.1} in", inches(metres)),
            false => format!("{:.1} cm", metres * 1e2),
        }
    }

    /// The width of a fabric (m) with its unit.
    pub fn width(self, metres: f64) -> String {
        match self.is_inch() {
            true => {
                let text = format!("{:.1}", inches(metres));
                format!("{} in", text.trim_end_matches(".0"))
            }
            false => format!("{:.0} cm", metres * 1e2),
        }
    }

    /// A short length (m) with its unit: a margin, a gap.
    pub fn short(self, metres: f64) -> String {
        match self.is_inch() {
            true => format!("{:.2} in", inches(metres)),
            false => format!("{:.0} mm", metres * 1e3),
        }
    }

    /// A length of cloth (m) as it is bought, in yards or metres first.
    pub fn cloth(self, metres: f64) -> [String; 2] {
        let [metric, yards] = [
            format!("{metres:.3} m"),
            format!("{:.2} yd", inches(metres) / YARD),
        ];
        match self.is_inch() {
            true => [yards, metric],
            false => [metric, yards],
        }
    }

    /// An area (m2) with its unit.
    pub fn area(self, square_metres: f64) -> String {
        format!("{} {}", self.area_number(square_metres), self.area_unit())
    }

    /// An area (m2) as a number in its unit.
    pub(crate) fn area_number(self, square_metres: f64) -> String {
        let unit = match self.is_inch() {
            true => DisplayUnit::Inch,
            false => DisplayUnit::Centimetre,
        };
        format!("{:.0}", square_metres / unit.metres().powi(2))
    }

    pub(crate) fn area_unit(self) -> &'static str {
        if self.is_inch() { "in2" } else { "cm2" }
    }
}

fn inches(metres: f64) -> f64 {
    metres / DisplayUnit::Inch.metres()
}
