//! Fonts of a PDF: Helvetica, and the parts of other fonts that its texts take, with the letters that
//! each glyph stands for, so that texts can be searched and copied.

use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str};
use std::sync::Arc;
use toile_lettering::{Font, Line, OutlineKind, Run, plain_bytes};

/// The objects of a font: itself, its letters, its measures, its file, the text of its letters,
/// their glyphs.
const OBJECTS: i32 = 6;
/// Codes are glyphs of the embedded part.
const CODES: SystemInfo = SystemInfo {
    registry: Str(b"Adobe"),
    ordering: Str(b"Identity"),
    supplement: 0,
};

/// The fonts of a document, as its texts ask for them.
#[derive(Default)]
pub(crate) struct PdfFonts {
    fonts: Vec<PdfFont>,
}

/// The part of a font that is used.
struct PdfFont {
    font: Arc<Font>,
    /// Glyphs with the letters that they stand for, in the order of their codes, from 1.
    letters: Vec<(u16, String)>,
}

impl PdfFonts {
    /// Shows a text whose baseline starts at the origin of the text matrix, letters of a size.
    pub fn show(&mut self, content: &mut Content, text: &str, (size, matrix): (f32, [f32; 6])) {
        content.begin_text();
        match plain_bytes(text) {
            Some(bytes) => {
                content.set_font(Name(b"F1"), size).set_text_matrix(matrix);
                content.show(Str(&bytes));
            }
            None => {
                for run in Line::new(text).runs {
                    self.show_run(content, &run, (size, matrix));
                }
            }
        }
        content.end_text();
    }

    /// Glyphs one by one, each at its own place: then no reader adds up other widths.
    fn show_run(&mut self, content: &mut Content, run: &Run, (size, matrix): (f32, [f32; 6])) {
        let place = self.place_of(&run.font);
        let name = font_name(place);
        content.set_font(Name(name.as_bytes()), size);
        for glyph in &run.glyphs {
            let code = self.fonts[place].code(glyph.id, &glyph.text);
            let [x, y] = glyph.at.map(|at| at as f32 * size);
            let [a, b, c, d, e, f] = matrix;
            let at = [a, b, c, d, e + a * x + c * y, f + b * x + d * y];
            content.set_text_matrix(at).show(Str(&code.to_be_bytes()));
        }
    }

    fn place_of(&mut self, font: &Arc<Font>) -> usize {
        let known = self.fonts.iter().position(|f| Arc::ptr_eq(&f.font, font));
        known.unwrap_or_else(|| {
            self.fonts.push(PdfFont {
                font: font.clone(),
                letters: Vec::new(),
            });
            self.fonts.len() - 1
        })
    }

    /// How many objects of the document they take.
    pub fn objects(&self) -> i32 {
        1 + OBJECTS * self.fonts.len() as i32
    }

    /// Their names on pages and their objects, the first of which has a number.
    pub fn names(&self, first: i32) -> impl Iterator<Item = (String, Ref)> {
        let plain = ("F1".to_owned(), Ref::new(first));
        let others = (0..self.fonts.len()).map(move |k| {
            let object = Ref::new(first + 1 + OBJECTS * k as i32);
            (font_name(k), object)
        });
        std::iter::once(plain).chain(others)
    }

    /// Writes them as objects, the first of which has a number.
    pub fn write(&self, pdf: &mut Pdf, first: i32) {
        pdf.type1_font(Ref::new(first))
            .base_font(Name(b"Helvetica"))
            .encoding_predefined(Name(b"WinAnsiEncoding"));
        for (k, font) in self.fonts.iter().enumerate() {
            font.write(pdf, (k, first + 1 + OBJECTS * k as i32));
        }
    }
}

/// The name of an embedded font on pages.
fn font_name(place: usize) -> String {
    format!("F{}", place + 2)
}

impl PdfFont {
    /// The code of a glyph that stands for letters. Glyphs of cubic curves have one code each, as
    /// PDF numbers them by glyph alone: such a glyph stands for the letters of its first use.
    fn code(&mut self, glyph: u16, text: &str) -> u16 {
        let by_glyph = self.font.kind == OutlineKind::Cff;
        if by_glyph && glyph == 0 {
            return 0;
        }
        let is_it = |(g, t): &(u16, String)| *g == glyph && (by_glyph || t.as_str() == text);
        let known = self.letters.iter().position(is_it);
        let place = known.unwrap_or_else(|| {
            self.letters.push((glyph, text.to_owned()));
            self.letters.len() - 1
        });
        u16::try_from(place + 1).unwrap_or(0)
    }

    fn write(&self, pdf: &mut Pdf, (place, first): (usize, i32)) {
        let object = |k: i32| Ref::new(first + k);
        let glyphs: Vec<u16> = self.letters.iter().map(|(glyph, _)| *glyph).collect();
        let Some((file, numbers)) = self.font.part(&glyphs) else {
            return;
        };
        // Six capitals tell the parts of a font apart.
        let tag: String = format!("{place:06}")
            .bytes()
            .map(|digit| char::from(digit - b'0' + b'A'))
            .collect();
        let name = format!("{tag}+{}", self.font.name);
        let true_type = self.font.kind == OutlineKind::TrueType;
        pdf.type0_font(object(0))
            .base_font(Name(name.as_bytes()))
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(object(1))
            .to_unicode(object(4));
        let mut letters = pdf.cid_font(object(1));
        letters
            .subtype(match true_type {
                true => CidFontType::Type2,
                false => CidFontType::Type0,
            })
            .base_font(Name(name.as_bytes()))
            .system_info(CODES)
            .font_descriptor(object(2))
            .default_width(0.0);
        let widths = glyphs.iter().map(|&g| (self.font.advance(g) * 1e3) as f32);
        letters.widths().consecutive(1, widths);
        if true_type {
            letters.cid_to_gid_map_stream(object(5));
        }
        letters.finish();
        self.write_measures(pdf, &name, (object(2), object(3)));
        let mut stream = pdf.stream(object(3), &file);
        if true_type {
            stream.pair(Name(b"Length1"), file.len() as i32);
        } else {
            stream.pair(Name(b"Subtype"), Name(b"OpenType"));
        }
        stream.finish();
        pdf.stream(object(4), &self.texts());
        if true_type {
            let map: Vec<u8> = std::iter::once(&0)
                .chain(&numbers)
                .flat_map(|number: &u16| number.to_be_bytes())
                .collect();
            pdf.stream(object(5), &map);
        }
    }

    fn write_measures(&self, pdf: &mut Pdf, name: &str, (object, file): (Ref, Ref)) {
        let measures = self.font.metrics();
        let thousandths = |size: f64| (size * 1e3) as f32;
        let [left, bottom, right, top] = measures.bounds.map(thousandths);
        let mut descriptor = pdf.font_descriptor(object);
        descriptor
            .name(Name(name.as_bytes()))
            .flags(FontFlags::SYMBOLIC)
            .bbox(Rect::new(left, bottom, right, top))
            .italic_angle(0.0)
            .ascent(thousandths(measures.ascent))
            .descent(thousandths(measures.descent))
            .cap_height(thousandths(measures.capitals))
            .stem_v(80.0);
        match self.font.kind {
            OutlineKind::TrueType => descriptor.font_file2(file),
            OutlineKind::Cff => descriptor.font_file3(file),
        };
    }

    /// The letters of each code.
    fn texts(&self) -> Vec<u8> {
        let mut texts = UnicodeCmap::new(Name(b"Letters"), CODES);
        for (k, (_, text)) in self.letters.iter().enumerate() {
            if let Ok(code) = u16::try_from(k + 1)
                && !text.is_empty()
            {
                texts.pair_with_multiple(code, text.chars());
            }
        }
        texts.finish().into_vec()
    }
}
