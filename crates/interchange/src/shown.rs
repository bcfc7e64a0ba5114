//! Lengths and areas as text, in the display unit of a document.

use toile_pattern::DisplayUnit;

/// Inches per yard.
const YARD: f64 = 36.0;

/// Formats lengths and areas: in inches for a document in inches, else in centimetres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown(pub DisplayUnit);

impl Shown {
    /// Whether lengths are shown in inches.
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

    /// A short length (m) with its unit, such as a margin or a gap.
    pub fn short(self, metres: f64) -> String {
        match self.is_inch() {
            true => format!("{:.2} in", inches(metres)),
            false => format!("{:.0} mm", metres * 1e3),
        }
    }

    /// A length of cloth (m) as sold: metres and yards, with the document's unit first.
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

    /// An area (m2) as a number in the display unit.
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
