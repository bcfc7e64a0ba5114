//! A font: which letters it has, their shapes, and the part of it that a document needs.

use crate::outline::Contours;
use harfrust::ShaperData;
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::DrawSettings;
use skrifa::raw::TableProvider;
use skrifa::string::StringId;
use skrifa::{FontRef, GlyphId, MetadataProvider, Tag};
use std::borrow::Cow;
use subsetter::GlyphRemapper;

/// How a font's outlines are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutlineKind {
    /// Quadratic curves, table `glyf`.
    TrueType,
    /// Cubic curves, table `CFF `.
    Cff,
}

/// Measures that a document tells of a font, over the size of its letters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FontMetrics {
    /// Box that holds every letter: left, bottom, right, top.
    pub bounds: [f64; 4],
    /// Highest letter over the baseline.
    pub ascent: f64,
    /// Lowest letter, below 0.
    pub descent: f64,
    /// Height of capitals.
    pub capitals: f64,
}

/// A font with outlines.
pub struct Font {
    data: Cow<'static, [u8]>,
    index: u32,
    shaper: ShaperData,
    /// Name of the font in documents, without spaces.
    pub name: String,
    /// How its outlines are written.
    pub kind: OutlineKind,
    units: f64,
}

impl std::fmt::Debug for Font {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Font({})", self.name)
    }
}

/// Bits of the table `OS/2` by which a font forbids embedding, or that of a part.
const NOT_EMBEDDED: u16 = 0x0002;
const NOT_IN_PART: u16 = 0x0100;

impl Font {
    /// The font at an index of a file; nothing if it has no outlines that a document can take, or
    /// forbids it.
    pub(crate) fn new(data: Cow<'static, [u8]>, index: u32) -> Option<Self> {
        let font = FontRef::from_index(&data, index).ok()?;
        let kind = outline_kind(&font)?;
        let name = font
            .localized_strings(StringId::POSTSCRIPT_NAME)
            .english_or_first()
            .map_or_else(String::new, |name| name.chars().collect());
        let plain = |c: &char| c.is_ascii_alphanumeric() || *c == '-';
        let name: String = name.chars().filter(plain).collect();
        let units = f64::from(font.head().ok()?.units_per_em()).max(1.0);
        let shaper = ShaperData::new(&font);
        Some(Self {
            shaper,
            name: if name.is_empty() { "Font".into() } else { name },
            kind,
            units,
            index,
            data,
        })
    }

    /// The font as read.
    ///
    /// # Errors
    /// The file is damaged, which was found out when it was first read.
    fn open(&self) -> Option<FontRef<'_>> {
        FontRef::from_index(&self.data, self.index).ok()
    }

    /// The glyphs of a text that runs one way, in the order in which they stand from the left.
    pub(crate) fn shaped(&self, text: &str, leftwards: bool) -> Vec<ShapedGlyph> {
        let Some(font) = self.open() else {
            return Vec::new();
        };
        let mut buffer = harfrust::UnicodeBuffer::new();
        buffer.push_str(text);
        buffer.set_direction(match leftwards {
            true => harfrust::Direction::RightToLeft,
            false => harfrust::Direction::LeftToRight,
        });
        buffer.set_cluster_level(harfrust::BufferClusterLevel::MonotoneCharacters);
        buffer.guess_segment_properties();
        let shaper = self.shaper.shaper(&font).build();
        let shaped = shaper.shape(buffer, harfrust::ShapeOptions::new());
        let em = |units: i32| f64::from(units) / self.units;
        let glyphs = shaped.glyph_infos().iter().zip(shaped.glyph_positions());
        glyphs
            .map(|(info, place)| ShapedGlyph {
                id: u16::try_from(info.glyph_id).unwrap_or(0),
                letter: info.cluster as usize,
                advance: em(place.x_advance),
                offset: [em(place.x_offset), em(place.y_offset)],
            })
            .collect()
    }

    /// Whether it has all letters of a text, and outlines for them.
    pub(crate) fn has(&self, text: &str) -> bool {
        self.open().is_some_and(|font| covers(&font, text))
    }

    /// Width of a glyph over the size of the letters.
    pub fn advance(&self, glyph: u16) -> f64 {
        let width = self.open().and_then(|font| {
            let metrics = font.glyph_metrics(Size::unscaled(), LocationRef::default());
            metrics.advance_width(GlyphId::from(glyph))
        });
        width.map_or(0.0, |width| f64::from(width) / self.units)
    }

    /// The closed lines of a glyph over the size of the letters, from its origin, y up.
    pub fn outline(&self, glyph: u16) -> Vec<Vec<[f64; 2]>> {
        let mut contours = Contours::new(1.0 / self.units);
        if let Some(font) = self.open()
            && let Some(outline) = font.outline_glyphs().get(GlyphId::from(glyph))
        {
            let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
            // A damaged glyph is drawn as far as it can be read.
            let _ = outline.draw(settings, &mut contours);
        }
        contours.finish()
    }

    /// Its measures.
    pub fn metrics(&self) -> FontMetrics {
        let measured = self.open().map(|font| {
            let metrics = font.metrics(Size::unscaled(), LocationRef::default());
            let em = |units: f32| f64::from(units) / self.units;
            let bounds = metrics.bounds.unwrap_or_default();
            FontMetrics {
                bounds: [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max].map(em),
                ascent: em(metrics.ascent),
                descent: em(metrics.descent),
                capitals: metrics.cap_height.map_or(0.7, em),
            }
        });
        measured.unwrap_or(FontMetrics {
            bounds: [0.0, -0.25, 1.0, 1.0],
            ascent: 1.0,
            descent: -0.25,
            capitals: 0.7,
        })
    }

    /// The part of the font that draws some glyphs, for a document, and the number of each in it;
    /// nothing if the font is damaged.
    pub fn part(&self, glyphs: &[u16]) -> Option<(Vec<u8>, Vec<u16>)> {
        let mut numbers = GlyphRemapper::new();
        let new: Vec<u16> = glyphs.iter().map(|&glyph| numbers.remap(glyph)).collect();
        let part = subsetter::subset(&self.data, self.index, &numbers).ok()?;
        Some((part, new))
    }
}

/// A glyph of a shaped text.
pub(crate) struct ShapedGlyph {
    pub id: u16,
    /// Where its letters begin in the text (byte).
    pub letter: usize,
    /// To the origin of the next, over the size of the letters.
    pub advance: f64,
    pub offset: [f64; 2],
}

fn outline_kind(font: &FontRef<'_>) -> Option<OutlineKind> {
    let allowed = font.os2().map_or(0, |os2| os2.fs_type());
    let has = |tag: &[u8; 4]| font.table_data(Tag::new(tag)).is_some();
    if allowed & 0x000f == NOT_EMBEDDED || allowed & NOT_IN_PART != 0 {
        return None;
    }
    match (has(b"glyf"), has(b"CFF ")) {
        (true, _) => Some(OutlineKind::TrueType),
        (_, true) => Some(OutlineKind::Cff),
        _ => None,
    }
}

/// Whether the font at an index of a file has all letters of a text and can be taken into a
/// document.
pub(crate) fn file_covers(data: &[u8], index: u32, text: &str) -> bool {
    FontRef::from_index(data, index)
        .is_ok_and(|font| outline_kind(&font).is_some() && covers(&font, text))
}

fn covers(font: &FontRef<'_>, text: &str) -> bool {
    let letters = font.charmap();
    let outlines = font.outline_glyphs();
    let drawn = |c: char| {
        let glyph = letters.map(c)?;
        // Fonts of coloured pictures have letters without outlines.
        let outline = outlines.get(glyph)?;
        let mut contours = Contours::new(1.0);
        let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        outline.draw(settings, &mut contours).ok()?;
        (c.is_whitespace() || !contours.finish().is_empty()).then_some(())
    };
    let ignored = |c: &char| is_ignorable(*c);
    text.chars()
        .filter(|c| !ignored(c))
        .all(|c| drawn(c).is_some())
}

/// Whether a letter steers others and is not drawn itself.
pub(crate) fn is_ignorable(c: char) -> bool {
    matches!(
        c,
        '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}'
            | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{fe00}'..='\u{fe0f}'
            | '\u{feff}' | '\u{e0000}'..='\u{e0fff}'
    )
}
