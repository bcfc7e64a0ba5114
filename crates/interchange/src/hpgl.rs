//! Lines and words for a plotter: HPGL/2 in user units of a hundredth of a millimetre, y up.

use std::fmt::Write as _;
use toile_geometry::Vec2;
use toile_lettering::{Line, width};

/// User units per metre (1/m).
const UNITS: f64 = 1e5;
/// Plotter units per metre (1/m).
const PLOTTER: f64 = 4e4;
/// Height of capitals relative to the letter size.
const CAPITALS: f64 = 0.72;

/// A plot being written.
pub(crate) struct HpglWriter {
    text: String,
    pen: u8,
}

fn unit(metres: f64) -> i64 {
    (metres * UNITS).round() as i64
}

impl HpglWriter {
    /// An empty plot with its width and height (m).
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

    /// A polyline through points (m), drawn with a pen counted from 1.
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

    /// A text with the middle of its baseline at a point (m), letter size (m) and rotation (rad). Plotters
    /// know ASCII only: a text with other characters is drawn as outlines.
    pub fn text(&mut self, pen: u8, words: &str, (at, size, angle): (Vec2, f64, f64)) {
        let blank = |c: char| if c.is_control() { ' ' } else { c };
        let words: String = words.chars().map(blank).collect();
        let (sin, cos) = angle.sin_cos();
        if !words.is_ascii() {
            let line = Line::new(&words);
            let place = |[x, y]: [f64; 2]| {
                let [x, y] = [(x - 0.5 * line.width) * size, y * size];
                at + Vec2::new(cos * x - sin * y, sin * x + cos * y)
            };
            for ring in line.outlines().flatten() {
                let ring: Vec<Vec2> = ring.into_iter().map(place).collect();
                self.polyline(pen, &ring, true);
            }
            return;
        }
        self.select(pen);
        // A plotter's letters are two thirds as wide as the step from one letter to the next. With this width
        // the text is as long as in the other formats.
        let step = width(&words) * size / words.len().max(1) as f64;
        let _ = writeln!(
            self.text,
            "PU{},{};DI{cos:.4},{sin:.4};SI{:.3},{:.3};LO4;LB{words}\u{3};",
            unit(at.x),
            unit(at.y),
            step / 1.5 * 100.0,
            CAPITALS * size * 100.0
        );
    }

    /// The complete file.
    pub fn finish(self) -> String {
        self.text + "PU;SP0;\n"
    }
}
