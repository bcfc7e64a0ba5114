//! Lines and words as DXF of release 12, which every cutter and drafting program reads. Millimetres,
//! y up.
//!
//! # Decided with
//! - [`crate::marker_plot::write_marker_dxf`], [`crate::marker_strokes::Strokes`]: the content, and its layers.

use std::fmt::Write as _;
use toile_geometry::{Bounds2, Vec2};

/// A DXF file being written.
pub(crate) struct DxfWriter {
    layers: Vec<(&'static str, u8)>,
    /// Finished blocks.
    blocks: String,
    /// What is written now: a block, or what is drawn outside of blocks.
    entities: String,
    /// What is drawn outside of blocks, while a block is written.
    outside: String,
    extent: Bounds2,
}

/// A number as text with at most four decimals (0.0001 mm for a length), without trailing zeros.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}

/// A text on one line: control characters become spaces; other characters beyond ASCII become `\U+` with their
/// UTF-16 code.
pub(super) fn plain(text: &str) -> String {
    let mut safe = String::new();
    for c in text.chars() {
        match c {
            c if c.is_control() => safe.push(' '),
            c if c.is_ascii() => safe.push(c),
            c => {
                for part in c.encode_utf16(&mut [0; 2]) {
                    let _ = write!(safe, "\\U+{part:04X}");
                }
            }
        }
    }
    safe
}

impl DxfWriter {
    /// A DXF without entities; each layer has a name and a colour (AutoCAD colour index).
    pub fn new(layers: Vec<(&'static str, u8)>) -> Self {
        Self {
            layers,
            blocks: String::new(),
            entities: String::new(),
            outside: String::new(),
            extent: Bounds2::of([]),
        }
    }

    fn group(&mut self, code: u32, value: &str) {
        let _ = writeln!(self.entities, "{code}\n{value}");
    }

    fn point(&mut self, code: u32, [x, y]: [f64; 2]) {
        self.group(code, &number(x));
        self.group(code + 10, &number(y));
        self.group(code + 20, "0");
    }

    /// A polyline through points (m).
    pub fn polyline(&mut self, layer: &str, points: &[Vec2], closed: bool) {
        if points.len() < 2 {
            return;
        }
        self.group(0, "POLYLINE");
        self.group(8, layer);
        self.group(66, "1");
        self.point(10, [0.0, 0.0]);
        self.group(70, if closed { "1" } else { "0" });
        for p in points {
            let at = [p.x * 1e3, p.y * 1e3];
            self.extent.include(Vec2::from(at));
            self.group(0, "VERTEX");
            self.group(8, layer);
            self.point(10, at);
        }
        self.group(0, "SEQEND");
        self.group(8, layer);
    }

    /// Begins a block, whose origin is that of the drawing: what follows is drawn in it.
    pub fn begin_block(&mut self, name: &str) {
        self.outside = std::mem::take(&mut self.entities);
        self.group(0, "BLOCK");
        self.group(8, "1");
        self.group(2, name);
        self.group(70, "64");
        self.point(10, [0.0, 0.0]);
        self.group(3, name);
    }

    /// Ends the block, and puts it into the drawing where it lies.
    pub fn end_block(&mut self, name: &str) {
        self.group(0, "ENDBLK");
        self.group(8, "1");
        self.blocks += &std::mem::take(&mut self.entities);
        self.entities = std::mem::take(&mut self.outside);
        self.group(0, "INSERT");
        self.group(8, "1");
        self.group(2, name);
        self.point(10, [0.0, 0.0]);
    }

    /// A point (m) with further values by their group codes, in the units of the file.
    pub fn mark(&mut self, layer: &str, at: Vec2, further: &[(u32, f64)]) {
        let at = [at.x * 1e3, at.y * 1e3];
        self.group(0, "POINT");
        self.group(8, layer);
        self.group(10, &number(at[0]));
        self.group(20, &number(at[1]));
        let z = further.iter().find(|(code, _)| *code == 30);
        self.group(30, &number(z.map_or(0.0, |(_, value)| *value)));
        for (code, value) in further.iter().filter(|(code, _)| *code != 30) {
            self.group(*code, &number(*value));
        }
    }

    /// A text that programs read, at a point (m).
    pub fn label(&mut self, layer: &str, words: &str, at: Vec2) {
        self.group(0, "TEXT");
        self.group(8, layer);
        self.point(10, [at.x * 1e3, at.y * 1e3]);
        self.group(40, "5");
        self.group(1, &plain(words));
    }

    /// A text with the middle of its baseline at a point (m), letter height (m) and rotation (rad).
    pub fn text(&mut self, layer: &str, words: &str, (at, height, angle): (Vec2, f64, f64)) {
        let at = [at.x * 1e3, at.y * 1e3];
        self.group(0, "TEXT");
        self.group(8, layer);
        self.point(10, at);
        self.group(40, &number(height * 1e3));
        self.group(1, &plain(words));
        self.group(50, &number(angle.to_degrees()));
        self.group(72, "1");
        self.point(11, at);
    }

    /// The complete file.
    pub fn finish(self) -> String {
        let corner = |name: &str, p: Vec2| {
            let (x, y) = (number(p.x), number(p.y));
            format!("9\n{name}\n10\n{x}\n20\n{y}\n30\n0\n")
        };
        let empty = !self.extent.min.x.is_finite();
        let (min, max) = match empty {
            true => (Vec2::zeros(), Vec2::zeros()),
            false => (self.extent.min, self.extent.max),
        };
        let mut text = String::from("999\nunits: millimetres\n0\nSECTION\n2\nHEADER\n");
        text += "9\n$ACADVER\n1\nAC1009\n";
        text += &corner("$EXTMIN", min);
        text += &corner("$EXTMAX", max);
        text += "0\nENDSEC\n0\nSECTION\n2\nTABLES\n";
        text += "0\nTABLE\n2\nLTYPE\n70\n1\n0\nLTYPE\n2\nCONTINUOUS\n70\n64\n3\nSolid line\n72\n65\n73\n0\n40\n0\n0\nENDTAB\n";
        let _ = write!(text, "0\nTABLE\n2\nLAYER\n70\n{}\n", self.layers.len());
        for (name, colour) in &self.layers {
            let _ = write!(
                text,
                "0\nLAYER\n2\n{name}\n70\n64\n62\n{colour}\n6\nCONTINUOUS\n"
            );
        }
        text += "0\nENDTAB\n0\nENDSEC\n";
        if !self.blocks.is_empty() {
            text += "0\nSECTION\n2\nBLOCKS\n";
            text += &self.blocks;
            text += "0\nENDSEC\n";
        }
        text += "0\nSECTION\n2\nENTITIES\n";
        text += &self.entities;
        text + "0\nENDSEC\n0\nEOF\n"
    }
}
