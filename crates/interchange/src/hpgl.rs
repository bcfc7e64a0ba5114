//! Lines and words for a plotter: HPGL/2 in user units of a hundredth of a millimetre, y up.

use std::fmt::Write as _;
use toile_geometry::Vec2;

/// User units in a metre \[1/m\].
const UNITS: f64 = 1e5;
/// Plotter units in a metre \[1/m\].
const PLOTTER: f64 = 4e4;

/// A plot in the making.
pub(crate) struct HpglWriter {
    text: String,
    pen: u8,
}

fn unit(metres: f64) -> i64 {
    (metres * UNITS).round() as i64
}

impl HpglWriter {
    /// An empty plot of a size \[m\].
    pub fn new(size: Vec2) -> Self {
        let plotter = |metres: f64| (metres * PLOTTER).ceil() as i64;
        let mut text = String::from("IN;");
        let _ = writeln!(text, "PS{},{};", plotter(size.x), plotter(size.y));
        // 4000 plotter units of 0.025 mm are 10000 user units of 0.01 mm.
        text += "IP0,0,4000,4000;SC0,10000,0,10000;\n";
        Self { text, pen: 0 }
    }

    fn select(&mut self, pen: u8) {
        if self.pen != pen {
            let _ = writeln!(self.text, "SP{pen};");
            self.pen = pen;
        }
    }

    /// A line through points \[m\] with a pen, from 1.
    pub fn polyline(&mut self, pen: u8, points: &[Vec2], closed: bool) {
        let [first, rest @ ..] = points else {
            return;
        };
        if rest.is_empty() {
            return;
        }
        self.select(pen);
        let _ = write!(self.text, "PU{},{};PD", unit(first.x), unit(first.y));
        let all = rest.iter().chain(closed.then_some(first));
        let all: Vec<String> = all
            .map(|p| format!("{},{}", unit(p.x), unit(p.y)))
            .collect();
        let _ = writeln!(self.text, "{};PU;", all.join(","));
    }

    /// Words with their baseline's middle at a point \[m\], letters of a height \[m\], turned by an
    /// angle \[rad\]. Letters beyond ASCII become question marks.
    pub fn text(&mut self, pen: u8, words: &str, (at, height, angle): (Vec2, f64, f64)) {
        self.select(pen);
        let plain = |c: char| match c {
            ' '..='~' => c,
            _ => '?',
        };
        let words: String = words.chars().map(plain).collect();
        let (sin, cos) = angle.sin_cos();
        let _ = writeln!(
            self.text,
            "PU{},{};DI{cos:.4},{sin:.4};SI{:.3},{:.3};LO4;LB{words}\u{3};",
            unit(at.x),
            unit(at.y),
            height * 67.0,
            height * 100.0
        );
    }

    /// The file.
    pub fn finish(self) -> String {
        self.text + "PU;SP0;\n"
    }
}
