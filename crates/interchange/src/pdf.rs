//! Pages of lines, areas and text as PDF. Lengths in metres from the lower left corner. The font is
//! Helvetica, which every reader has; for characters that it lacks, subsets of other fonts are embedded.

use crate::pdf_fonts::PdfFonts;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref};
use std::collections::BTreeSet;
use toile_geometry::{Bounds2, Vec2};
use toile_lettering::{shortened, width};

/// Points of a PDF per metre (1/m).
const POINTS: f64 = 72.0 / 0.0254;
/// Longest side of a page in default user units (PDF 1.7, annex C); longer pages use a larger unit.
const LONGEST: f64 = 14_400.0;

/// A colour: red, green, blue (0 to 1).
pub(crate) type Ink = [f32; 3];

/// A PDF file being written.
#[derive(Default)]
pub(crate) struct PdfSheets {
    pages: Vec<PdfPage>,
    /// Names of the layers that a reader can hide (optional content groups).
    layers: Vec<String>,
}

/// A page being written.
pub(crate) struct PdfPage {
    size: Vec2,
    /// Points per unit of the page.
    unit: f64,
    /// Everything drawn up to and including the last text.
    parts: Vec<Part>,
    /// Everything drawn since the last text.
    content: Content,
    /// Layers that have content on the page.
    layers: BTreeSet<usize>,
}

/// A part of a page: drawing commands, or a text, which is encoded when the fonts of the document are known.
enum Part {
    Drawn(Vec<u8>),
    Text {
        text: String,
        /// Letter size in units of the page.
        size: f32,
        /// Matrix from text space to the page.
        matrix: [f32; 6],
        ink: Ink,
    },
}

/// The part of a text that its position refers to: start, middle or end of the baseline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Align {
    Left,
    Middle,
    Right,
}

/// A text on a page.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PdfText<'a> {
    pub text: &'a str,
    /// Position on the baseline (m).
    pub at: Vec2,
    /// Letter size (m).
    pub size: f64,
    /// Direction of the baseline (rad).
    pub angle: f64,
    pub align: Align,
    pub ink: Ink,
}

impl PdfPage {
    /// An empty page with its width and height (m).
    pub fn new(size: Vec2) -> Self {
        let unit = (size.max() * POINTS / LONGEST).ceil().max(1.0);
        let mut content = Content::new();
        content.set_line_cap(LineCapStyle::RoundCap);
        content.set_line_join(LineJoinStyle::RoundJoin);
        Self {
            size,
            unit,
            parts: Vec::new(),
            content,
            layers: BTreeSet::new(),
        }
    }

    /// Begins a layer: everything drawn until [`Self::end_layer`] belongs to the layer.
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

    /// Begins a section of marked content of the given name; [`Self::end_kind`] ends the section.
    pub fn begin_kind(&mut self, name: &str) {
        self.content.begin_marked_content(Name(name.as_bytes()));
    }

    /// Ends a section of marked content.
    pub fn end_kind(&mut self) {
        self.content.end_marked_content();
    }

    /// Begins a clip: until [`Self::end_clip`], drawing is visible only inside the bounds (m).
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

    /// Fills rings by the even-odd rule, so that inner rings are holes.
    pub fn fill<'p>(&mut self, rings: impl IntoIterator<Item = &'p [Vec2]>, ink: Ink) {
        self.content.set_fill_rgb(ink[0], ink[1], ink[2]);
        self.path(rings, true);
        self.content.fill_even_odd();
    }

    /// Draws a line of a width (m) with dashes of a length (m); the line is solid if the dash length is 0.
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

    /// Writes a text.
    pub fn text(&mut self, text: PdfText<'_>) {
        let width = width(text.text) * text.size;
        let back = match text.align {
            Align::Left => 0.0,
            Align::Middle => 0.5 * width,
            Align::Right => width,
        };
        let (sin, cos) = text.angle.sin_cos();
        let at = text.at - Vec2::new(cos, sin) * back;
        let (x, y, size) = (self.units(at.x), self.units(at.y), self.units(text.size));
        let (sin, cos) = (sin as f32, cos as f32);
        let drawn = std::mem::replace(&mut self.content, Content::new());
        self.parts.push(Part::Drawn(drawn.finish().into_vec()));
        self.parts.push(Part::Text {
            text: text.text.to_owned(),
            size,
            matrix: [cos, sin, -sin, cos, x, y],
            ink: text.ink,
        });
    }

    /// The page's content stream, with the fonts of the document.
    fn encoded(&mut self, fonts: &mut PdfFonts) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut add = |part: &[u8]| {
            if !bytes.is_empty() && !part.is_empty() {
                bytes.push(b'\n');
            }
            bytes.extend_from_slice(part);
        };
        for part in std::mem::take(&mut self.parts) {
            match part {
                Part::Drawn(drawn) => add(&drawn),
                Part::Text {
                    text,
                    size,
                    matrix,
                    ink,
                } => {
                    let mut content = Content::new();
                    content.set_fill_rgb(ink[0], ink[1], ink[2]);
                    fonts.show(&mut content, &text, (size, matrix));
                    add(content.finish().as_slice());
                }
            }
        }
        let drawn = std::mem::replace(&mut self.content, Content::new());
        add(drawn.finish().as_slice());
        bytes
    }
}

/// Name of a layer in a page's resources.
fn layer_name(layer: usize) -> String {
    format!("L{layer}")
}

impl PdfSheets {
    /// A document without pages, with layers that a reader can hide.
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

    /// The complete file.
    pub fn finish(mut self, title: &str) -> Vec<u8> {
        let mut pdf = Pdf::new();
        let mut fonts = PdfFonts::default();
        let contents: Vec<Vec<u8>> = self
            .pages
            .iter_mut()
            .map(|page| page.encoded(&mut fonts))
            .collect();
        let (catalog, tree, info) = (Ref::new(1), Ref::new(2), Ref::new(3));
        let first_layer = 4 + fonts.objects();
        let first = first_layer + self.layers.len() as i32;
        let layer_of = |k: usize| Ref::new(first_layer + k as i32);
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
        for (k, (sheet, content)) in self.pages.into_iter().zip(contents).enumerate() {
            let PdfPage {
                size, unit, layers, ..
            } = sheet;
            let units = |metres: f64| (metres * POINTS / unit) as f32;
            let mut page = pdf.page(page_of(k));
            page.media_box(Rect::new(0.0, 0.0, units(size.x), units(size.y)));
            if unit > 1.0 {
                page.pair(Name(b"UserUnit"), unit as f32);
            }
            page.parent(tree).contents(content_of(k));
            let mut resources = page.resources();
            let mut named = resources.fonts();
            for (name, font) in fonts.names(4) {
                named.pair(Name(name.as_bytes()), font);
            }
            named.finish();
            if !layers.is_empty() {
                let mut properties = resources.insert(Name(b"Properties")).dict();
                for layer in layers {
                    properties.pair(Name(layer_name(layer).as_bytes()), layer_of(layer));
                }
            }
            resources.finish();
            page.finish();
            pdf.stream(content_of(k), &content);
        }
        fonts.write(&mut pdf, 4);
        pdf.finish()
    }
}

/// Breaks a text of a letter size (m) between words into lines of at most `width` (m); a word that is longer
/// than a line is cut off.
pub(crate) fn wrapped(text: &str, size: f64, width: f64) -> Vec<String> {
    let fits = |line: &str| toile_lettering::width(line) * size <= width;
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

/// The longest start of a text of a letter size (m) that fits into a width (m).
pub(crate) fn fitted(text: &str, size: f64, width: f64) -> String {
    shortened(text, width / size)
}
