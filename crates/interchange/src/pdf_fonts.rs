//! Fonts of a PDF: Helvetica, and embedded subsets of other fonts. The characters of each glyph are recorded,
//! so that texts can be searched and copied.

use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str};
use std::sync::Arc;
use toile_lettering::{Font, Line, OutlineKind, Run, plain_bytes};

/// Number of PDF objects per embedded font: the font, its descendant font, its descriptor, the font file, the
/// character map and the glyph map.
const OBJECTS: i32 = 6;
/// The character collection Adobe-Identity: the code of a character is the number (CID) of its glyph in the
/// embedded font.
const CODES: SystemInfo = SystemInfo {
    registry: Str(b"Adobe"),
    ordering: Str(b"Identity"),
    supplement: 0,
};

/// The fonts of a document, collected as texts use them.
#[derive(Default)]
pub(crate) struct PdfFonts {
    fonts: Vec<PdfFont>,
}

/// The used glyphs of an embedded font.
struct PdfFont {
    font: Arc<Font>,
    /// Glyphs with the characters that they stand for, in the order of their codes, from 1.
    letters: Vec<(u16, String)>,
}

impl PdfFonts {
    /// Draws a text with its baseline starting at the origin of the text matrix, in a letter size.
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

    /// Draws glyphs one by one, each at its own position, so that PDF readers need not add up glyph widths.
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

    /// Number of PDF objects that the fonts take.
    pub fn objects(&self) -> i32 {
        1 + OBJECTS * self.fonts.len() as i32
    }

    /// Resource names and object numbers of the fonts, numbered from `first`.
    pub fn names(&self, first: i32) -> impl Iterator<Item = (String, Ref)> {
        let plain = ("F1".to_owned(), Ref::new(first));
        let others = (0..self.fonts.len()).map(move |k| {
            let object = Ref::new(first + 1 + OBJECTS * k as i32);
            (font_name(k), object)
        });
        std::iter::once(plain).chain(others)
    }

    /// Writes the fonts as objects, numbered from `first`.
    pub fn write(&self, pdf: &mut Pdf, first: i32) {
        pdf.type1_font(Ref::new(first))
            .base_font(Name(b"Helvetica"))
            .encoding_predefined(Name(b"WinAnsiEncoding"));
        for (k, font) in self.fonts.iter().enumerate() {
            font.write(pdf, (k, first + 1 + OBJECTS * k as i32));
        }
    }
}

/// Resource name of an embedded font on pages.
fn font_name(place: usize) -> String {
    format!("F{}", place + 2)
}

impl PdfFont {
    /// The code of a glyph that stands for the characters `text`. In a CFF font a glyph has only one code,
    /// since PDF selects such glyphs by their index alone: the glyph stands for the characters of its first
    /// use.
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
        // A tag of six capitals marks the subset of a font.
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

    /// The map from codes to characters.
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
