//! Sheets of lines, areas and words as PDF. Lengths in metres from the lower left corner; the text
//! is Helvetica, which every reader has.

use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str};
use std::collections::BTreeSet;
use toile_geometry::{Bounds2, Vec2};

/// Points of a PDF in a metre \[1/m\].
const POINTS: f64 = 72.0 / 0.0254;
/// Longest side of a page in its own units (PDF 1.7, annex C); longer pages have a larger unit.
const LONGEST: f64 = 14_400.0;

/// A colour of ink: red, green, blue, 0..=1.
pub(crate) type Ink = [f32; 3];

/// A PDF in the making.
#[derive(Default)]
pub(crate) struct PdfSheets {
    pages: Vec<PdfPage>,
    /// Names of the layers that readers can hide (optional content groups).
    layers: Vec<String>,
}

/// A page in the making.
pub(crate) struct PdfPage {
    size: Vec2,
    /// Points in a unit of the page.
    unit: f64,
    content: Content,
    /// Layers that have something on it.
    layers: BTreeSet<usize>,
}

/// Where a text stands on its baseline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Align {
    Left,
    Middle,
    Right,
}

/// Words on a page.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PdfText<'a> {
    pub text: &'a str,
    /// On the baseline \[m\].
    pub at: Vec2,
    /// Size of the letters \[m\].
    pub size: f64,
    /// Direction of the baseline \[rad\].
    pub angle: f64,
    pub align: Align,
    pub ink: Ink,
}

impl PdfPage {
    /// An empty page of a size \[m\].
    pub fn new(size: Vec2) -> Self {
        let unit = (size.max() * POINTS / LONGEST).ceil().max(1.0);
        let mut content = Content::new();
        content.set_line_cap(LineCapStyle::RoundCap);
        content.set_line_join(LineJoinStyle::RoundJoin);
        Self {
            size,
            unit,
            content,
            layers: BTreeSet::new(),
        }
    }

    /// What follows belongs to a layer, until its end.
    pub fn begin_layer(&mut self, layer: usize) {
        self.layers.insert(layer);
        self.content
            .begin_marked_content_with_properties(Name(b"OC"))
            .properties_named(Name(layer_name(layer).as_bytes()));
    }

    /// Ends a layer.
    pub fn end_layer(&mut self) {
        self.content.end_marked_content();
    }

    /// What follows is of a kind (marked content by that name), until its end.
    pub fn begin_kind(&mut self, name: &str) {
        self.content.begin_marked_content(Name(name.as_bytes()));
    }

    /// Ends a kind.
    pub fn end_kind(&mut self) {
        self.content.end_marked_content();
    }

    /// What follows is seen inside bounds \[m\] alone, until the end of the clip.
    pub fn clip(&mut self, bounds: &Bounds2) {
        let (low, size) = (bounds.min, bounds.size());
        let [x, y, width, height] = [low.x, low.y, size.x, size.y].map(|m| self.units(m));
        self.content
            .save_state()
            .rect(x, y, width, height)
            .clip_nonzero()
            .end_path();
    }

    /// Ends a clip.
    pub fn end_clip(&mut self) {
        self.content.restore_state();
    }

    fn units(&self, metres: f64) -> f32 {
        (metres * POINTS / self.unit) as f32
    }

    fn path<'p>(&mut self, rings: impl IntoIterator<Item = &'p [Vec2]>, closed: bool) {
        for ring in rings {
            for (k, p) in ring.iter().enumerate() {
                let (x, y) = (self.units(p.x), self.units(p.y));
                match k {
                    0 => self.content.move_to(x, y),
                    _ => self.content.line_to(x, y),
                };
            }
            if closed && !ring.is_empty() {
                self.content.close_path();
            }
        }
    }

    /// Fills rings, holes by the even-odd rule.
    pub fn fill<'p>(&mut self, rings: impl IntoIterator<Item = &'p [Vec2]>, ink: Ink) {
        self.content.set_fill_rgb(ink[0], ink[1], ink[2]);
        self.path(rings, true);
        self.content.fill_even_odd();
    }

    /// Draws a line of a width \[m\], dashed by a length \[m\] if that is not 0.
    pub fn stroke(&mut self, points: &[Vec2], closed: bool, (width, dash, ink): (f64, f64, Ink)) {
        let (width, dash) = (self.units(width), self.units(dash));
        self.content.set_stroke_rgb(ink[0], ink[1], ink[2]);
        self.content.set_line_width(width);
        let dashes: &[f32] = &[dash, 0.5 * dash];
        let dashes = if dash > 0.0 { dashes } else { &[] };
        self.content.set_dash_pattern(dashes.iter().copied(), 0.0);
        self.path([points], closed);
        self.content.stroke();
    }

    /// Writes words.
    pub fn text(&mut self, text: PdfText<'_>) {
        let encoded = win_ansi(text.text);
        let width = text_width(&encoded) * text.size;
        let back = match text.align {
            Align::Left => 0.0,
            Align::Middle => 0.5 * width,
            Align::Right => width,
        };
        let (sin, cos) = text.angle.sin_cos();
        let at = text.at - Vec2::new(cos, sin) * back;
        let (x, y, size) = (self.units(at.x), self.units(at.y), self.units(text.size));
        let (sin, cos) = (sin as f32, cos as f32);
        self.content
            .set_fill_rgb(text.ink[0], text.ink[1], text.ink[2])
            .begin_text()
            .set_font(Name(b"F1"), size)
            .set_text_matrix([cos, sin, -sin, cos, x, y])
            .show(Str(&encoded))
            .end_text();
    }
}

/// The name of a layer in a page's resources.
fn layer_name(layer: usize) -> String {
    format!("L{layer}")
}

impl PdfSheets {
    /// Without pages, with layers that readers can hide.
    pub fn with_layers(layers: &[String]) -> Self {
        Self {
            pages: Vec::new(),
            layers: layers.to_vec(),
        }
    }

    /// Adds a page.
    pub fn push(&mut self, page: PdfPage) {
        self.pages.push(page);
    }

    /// The file.
    pub fn finish(self, title: &str) -> Vec<u8> {
        let mut pdf = Pdf::new();
        let (catalog, tree, font, info) = (Ref::new(1), Ref::new(2), Ref::new(3), Ref::new(4));
        let first = 5 + self.layers.len() as i32;
        let layer_of = |k: usize| Ref::new(5 + k as i32);
        let page_of = |k: usize| Ref::new(first + 2 * k as i32);
        let content_of = |k: usize| Ref::new(first + 1 + 2 * k as i32);
        let mut root = pdf.catalog(catalog);
        root.pages(tree);
        let layers = || (0..self.layers.len()).map(layer_of);
        if !self.layers.is_empty() {
            let mut properties = root.insert(Name(b"OCProperties")).dict();
            properties.insert(Name(b"OCGs")).array().items(layers());
            let mut usual = properties.insert(Name(b"D")).dict();
            usual.insert(Name(b"Order")).array().items(layers());
            usual.insert(Name(b"ON")).array().items(layers());
        }
        root.finish();
        for (k, name) in self.layers.iter().enumerate() {
            pdf.indirect(layer_of(k))
                .dict()
                .pair(Name(b"Type"), Name(b"OCG"))
                .pair(Name(b"Name"), pdf_writer::TextStr(name));
        }
        pdf.document_info(info)
            .title(pdf_writer::TextStr(title))
            .producer(pdf_writer::TextStr("Toile"));
        pdf.pages(tree)
            .kids((0..self.pages.len()).map(page_of))
            .count(self.pages.len() as i32);
        for (k, sheet) in self.pages.into_iter().enumerate() {
            let PdfPage {
                size,
                unit,
                content,
                layers,
            } = sheet;
            let units = |metres: f64| (metres * POINTS / unit) as f32;
            let mut page = pdf.page(page_of(k));
            page.media_box(Rect::new(0.0, 0.0, units(size.x), units(size.y)));
            if unit > 1.0 {
                page.pair(Name(b"UserUnit"), unit as f32);
            }
            page.parent(tree).contents(content_of(k));
            let mut resources = page.resources();
            resources.fonts().pair(Name(b"F1"), font);
            if !layers.is_empty() {
                let mut properties = resources.insert(Name(b"Properties")).dict();
                for layer in layers {
                    properties.pair(Name(layer_name(layer).as_bytes()), layer_of(layer));
                }
            }
            resources.finish();
            page.finish();
            pdf.stream(content_of(k), &content.finish());
        }
        pdf.type1_font(font)
            .base_font(Name(b"Helvetica"))
            .encoding_predefined(Name(b"WinAnsiEncoding"));
        pdf.finish()
    }
}

/// Text in the encoding of the page; letters it does not have become question marks.
fn win_ansi(text: &str) -> Vec<u8> {
    let byte = |c: char| match c {
        ' '..='~' | '\u{a0}'..='\u{ff}' => c as u8,
        '\u{20ac}' => 0x80,
        '\u{2013}' => 0x96,
        '\u{2019}' => 0x92,
        c if c.is_control() => b' ',
        _ => b'?',
    };
    text.chars().map(byte).collect()
}

/// Width of Helvetica's letters from the space to the tilde, in thousandths of their size (Adobe
/// font metrics).
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];

/// Width of a letter over its size in Helvetica, from the space to the tilde.
pub(crate) fn letter_width(c: char) -> Option<f64> {
    let place = u32::from(c).checked_sub(32)?;
    let width = WIDTHS.get(usize::try_from(place).ok()?)?;
    Some(f64::from(*width) / 1e3)
}

/// Width of encoded text over the size of its letters.
fn text_width(encoded: &[u8]) -> f64 {
    let width = |&byte: &u8| match byte {
        b' '..=b'~' => f64::from(WIDTHS[usize::from(byte - b' ')]),
        _ => 556.0,
    };
    encoded.iter().map(width).sum::<f64>() / 1e3
}

/// A text in lines of at most a width \[m\] at a size \[m\], broken between words; a longer word is
/// cut.
pub(crate) fn wrapped(text: &str, size: f64, width: f64) -> Vec<String> {
    let fits = |line: &str| text_width(&win_ansi(line)) * size <= width;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if fits(&format!("{line} {word}")) => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(fitted(word, size, width)),
        }
    }
    lines
}

/// As many letters from the start of a text as fit a width \[m\] at a size \[m\].
pub(crate) fn fitted(text: &str, size: f64, width: f64) -> String {
    if text_width(&win_ansi(text)) * size <= width {
        return text.to_owned();
    }
    let mut short = String::new();
    for c in text.chars() {
        let longer = format!("{short}{c}");
        if text_width(&win_ansi(&format!("{longer}..."))) * size > width {
            break;
        }
        short = longer;
    }
    short + "..."
}
