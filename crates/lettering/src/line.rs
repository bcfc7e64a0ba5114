//! A line of text set in fonts: glyphs from left to right, whatever way the scripts run.

use crate::font::{Font, ShapedGlyph, is_ignorable};
use crate::system::{fallback, font_for};
use std::ops::Range;
use std::sync::Arc;
use unicode_bidi::BidiInfo;
use unicode_segmentation::UnicodeSegmentation;

/// A line of text set in fonts.
#[derive(Clone, Debug)]
pub struct Line {
    /// Its parts from left to right, each in one font.
    pub runs: Vec<Run>,
    /// Width over the size of the letters.
    pub width: f64,
    /// The letters that no font has; boxes stand for them.
    pub missing: Vec<char>,
}

/// A part of a line in one font.
#[derive(Clone, Debug)]
pub struct Run {
    /// The font.
    pub font: Arc<Font>,
    /// Its glyphs from left to right.
    pub glyphs: Vec<Glyph>,
}

/// A glyph of a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Glyph {
    /// Its number in the font; 0 is the box for a letter that is missing.
    pub id: u16,
    /// Its origin from the start of the line's baseline, over the size of the letters.
    pub at: [f64; 2],
    /// The letters it stands for.
    pub text: String,
}

/// Letters of a line that run one way and are set in one font; no font has those without.
struct Part {
    letters: Range<usize>,
    font: Option<Arc<Font>>,
    leftwards: bool,
}

impl Line {
    /// A text set in the fonts that have its letters. Control characters are blanks.
    pub fn new(text: &str) -> Self {
        let blank = |c: char| if c.is_control() { ' ' } else { c };
        let text: String = text.chars().map(blank).collect();
        let mut line = Self {
            runs: Vec::new(),
            width: 0.0,
            missing: Vec::new(),
        };
        for part in parts(&text) {
            let letters = &text[part.letters];
            match part.font {
                Some(font) => {
                    let glyphs = font.shaped(letters, part.leftwards);
                    line.push(font, letters, (glyphs, part.leftwards));
                }
                None => line.push_missing(letters, part.leftwards),
            }
        }
        line
    }

    fn push(
        &mut self,
        font: Arc<Font>,
        letters: &str,
        (shaped, leftwards): (Vec<ShapedGlyph>, bool),
    ) {
        let texts = texts(letters, &shaped, leftwards);
        let mut glyphs = Vec::with_capacity(shaped.len());
        for (glyph, text) in shaped.iter().zip(texts) {
            glyphs.push(Glyph {
                id: glyph.id,
                at: [self.width + glyph.offset[0], glyph.offset[1]],
                text,
            });
            self.width += glyph.advance;
        }
        self.runs.push(Run { font, glyphs });
    }

    /// A box for each letter.
    fn push_missing(&mut self, letters: &str, leftwards: bool) {
        let shown = letters.chars().filter(|c| !is_ignorable(*c));
        self.missing.extend(shown);
        let Some(font) = fallback() else {
            return;
        };
        let mut each: Vec<&str> = letters.graphemes(true).collect();
        if leftwards {
            each.reverse();
        }
        let advance = font.advance(0);
        let mut glyphs = Vec::with_capacity(each.len());
        for text in each {
            glyphs.push(Glyph {
                id: 0,
                at: [self.width, 0.0],
                text: text.to_owned(),
            });
            self.width += advance;
        }
        self.runs.push(Run { font, glyphs });
    }

    /// The closed lines of each of its glyphs over their size, from the start of the baseline, y up.
    pub fn outlines(&self) -> impl Iterator<Item = Vec<Vec<[f64; 2]>>> {
        let glyphs = self.runs.iter().flat_map(|run| {
            let font = &run.font;
            run.glyphs.iter().map(move |glyph| (font, glyph))
        });
        glyphs.map(|(font, glyph)| {
            let mut rings = font.outline(glyph.id);
            for p in rings.iter_mut().flatten() {
                *p = [p[0] + glyph.at[0], p[1] + glyph.at[1]];
            }
            rings
        })
    }
}

/// The parts of a text from left to right (Unicode Standard Annex 9).
fn parts(text: &str) -> Vec<Part> {
    let bidi = BidiInfo::new(text, None);
    let mut all = Vec::new();
    for paragraph in &bidi.paragraphs {
        let (levels, runs) = bidi.visual_runs(paragraph, paragraph.range.clone());
        for run in runs {
            let leftwards = levels[run.start].is_rtl();
            let mut parts = in_fonts(text, run, leftwards);
            if leftwards {
                parts.reverse();
            }
            all.extend(parts);
        }
    }
    all
}

/// Letters that run one way, divided by the fonts that have them.
fn in_fonts(text: &str, letters: Range<usize>, leftwards: bool) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for (at, cluster) in text[letters.clone()].grapheme_indices(true) {
        let range = letters.start + at..letters.start + at + cluster.len();
        let blank = cluster
            .chars()
            .all(|c| c.is_whitespace() || is_ignorable(c));
        let last = parts.last_mut();
        // Blanks stay with the letters before them.
        if let Some(Part {
            font: Some(font),
            letters,
            ..
        }) = last
            && blank
            && font.has(cluster)
        {
            letters.end = range.end;
            continue;
        }
        let font = font_for(cluster);
        match parts.last_mut() {
            Some(part) if is_same(part.font.as_ref(), font.as_ref()) => {
                part.letters.end = range.end;
            }
            _ => parts.push(Part {
                letters: range,
                font,
                leftwards,
            }),
        }
    }
    parts
}

fn is_same(a: Option<&Arc<Font>>, b: Option<&Arc<Font>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (None, None) => true,
        _ => false,
    }
}

/// The letters each glyph stands for. Those of glyphs that share several letters go one to each,
/// the rest to the last, so that reading the glyphs in the way of the script gives the text.
fn texts(letters: &str, shaped: &[ShapedGlyph], leftwards: bool) -> Vec<String> {
    let mut order: Vec<usize> = (0..shaped.len()).collect();
    if leftwards {
        order.reverse();
    }
    let mut texts = vec![String::new(); shaped.len()];
    let mut k = 0;
    while k < order.len() {
        let start = shaped[order[k]].letter;
        let count = order[k..]
            .iter()
            .take_while(|&&glyph| shaped[glyph].letter == start)
            .count();
        let end = order
            .get(k + count)
            .map_or(letters.len(), |&glyph| shaped[glyph].letter);
        let cluster = letters.get(start..end).unwrap_or_default();
        let mut rest = cluster.chars();
        for (place, &glyph) in order[k..k + count].iter().enumerate() {
            match place + 1 == count {
                true => texts[glyph].extend(rest.by_ref()),
                false => texts[glyph].extend(rest.next()),
            }
        }
        k += count;
    }
    texts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &Line) -> String {
        let glyphs = line.runs.iter().flat_map(|run| &run.glyphs);
        glyphs.map(|glyph| glyph.text.as_str()).collect()
    }

    #[test]
    fn latin_greek_and_cyrillic_have_letters_everywhere() {
        for text in [
            "Ärmel, zsebőr, łata",
            "Передняя половинка",
            "Μπροστινό φύλλο",
            "✂ 😀",
        ] {
            let line = Line::new(text);
            assert!(line.missing.is_empty(), "{text}: {:?}", line.missing);
            assert_eq!(read(&line), text);
            assert!(line.width > 0.2 * text.chars().count() as f64);
            let rings: Vec<_> = line.outlines().flatten().collect();
            let right = rings.iter().flatten().map(|p| p[0]).fold(0.0, f64::max);
            assert!(
                (right - line.width).abs() < 0.2,
                "{text}: {right} {}",
                line.width
            );
        }
    }

    #[test]
    fn scripts_from_the_right_stand_in_their_order() {
        // Hebrew between Latin letters: its first letter stands right of its last.
        let line = Line::new("a שלום z");
        let glyphs: Vec<&Glyph> = line.runs.iter().flat_map(|run| &run.glyphs).collect();
        let place = |text: &str| glyphs.iter().find(|g| g.text == text).unwrap().at[0];
        assert!(place("a") < place("ם"));
        assert!(place("ם") < place("ש"));
        assert!(place("ש") < place("z"));
    }

    #[test]
    fn a_letter_of_no_font_is_a_box_with_its_text() {
        let line = Line::new("ő\u{f8ffe}");
        assert_eq!(line.missing, ['\u{f8ffe}']);
        let glyph = &line.runs.last().unwrap().glyphs[0];
        assert_eq!((glyph.id, glyph.text.as_str()), (0, "\u{f8ffe}"));
        assert!(!line.runs[0].font.outline(0).is_empty());
    }

    #[test]
    fn the_part_of_a_font_is_small_and_the_same_every_time() {
        let line = Line::new("Рукав");
        let run = &line.runs[0];
        let ids: Vec<u16> = run.glyphs.iter().map(|g| g.id).collect();
        let (part, numbers) = run.font.part(&ids).unwrap();
        assert!(part.len() < 60_000, "{}", part.len());
        assert_eq!(numbers, [1, 2, 3, 4, 5]);
        assert_eq!(run.font.part(&ids).unwrap().0, part);
    }
}
