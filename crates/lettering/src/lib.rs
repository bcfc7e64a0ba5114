//! Letters of every script: which font has them, how wide they are, their outlines.
//!
//! Text in the letters of Western Europe is set in Helvetica, which every reader of PDF has
//! ([`is_plain`]). Any other text is set in the fonts that the program brings (Latin, Greek,
//! Cyrillic, emoji) and, for letters that these lack, in fonts of the system. The same text gives
//! the same letters whenever the fonts of the system are the same.
//!
//! # Decided with
//! - [`crate::system::font_for`]: the font of a letter: those the program brings, then those of the system;
//! - [`crate::line::Line`]: parts of a line by direction and font;
//! - [`crate::font::Font`], [`crate::outline`]: glyphs, their widths and outlines;
//! - [`crate::helvetica`]: Western text in PDF and its widths;
//! - [`crate::missing_note`]: letters that no font has.
//!
//! Asked by crates `cut`, `picture` and `interchange` (`pdf_fonts.rs`, `hpgl.rs`).

#![cfg_attr(test, allow(clippy::unwrap_used))]

mod font;
mod helvetica;
mod line;
mod outline;
mod system;

pub use font::{Font, FontMetrics, OutlineKind};
pub use helvetica::{is_plain, plain_bytes};
pub use line::{Glyph, Line, Run};

use std::collections::BTreeSet;

/// Width of a text over the size of its letters, in Helvetica where that has all of them.
pub fn width(text: &str) -> f64 {
    match plain_bytes(text) {
        Some(bytes) => helvetica::width(&bytes),
        None => Line::new(text).width,
    }
}

/// The letters of texts that no font has, each once, in order.
pub fn missing_letters<'t>(texts: impl IntoIterator<Item = &'t str>) -> BTreeSet<char> {
    let strange = texts.into_iter().filter(|text| !is_plain(text));
    strange.flat_map(|text| Line::new(text).missing).collect()
}

/// What to tell of letters that no font has; nothing if there are none.
pub fn missing_note(missing: &BTreeSet<char>) -> Option<String> {
    let letters: Vec<String> = missing
        .iter()
        .map(|c| format!("{c} (U+{:04X})", u32::from(*c)))
        .collect();
    (!letters.is_empty()).then(|| {
        format!(
            "no font has these letters, which are drawn as boxes: {}; install a font of their script, as one of the Noto family",
            letters.join(", ")
        )
    })
}

/// As much of a text from its start as fits a width over the size of its letters, with an ellipsis
/// where it is shortened.
pub fn shortened(text: &str, most: f64) -> String {
    use unicode_segmentation::UnicodeSegmentation;
    if width(text) <= most {
        return text.to_owned();
    }
    let ends: Vec<usize> = text.grapheme_indices(true).map(|(at, _)| at).collect();
    let cut = |count: usize| format!("{}…", text[..ends[count]].trim_end());
    // The widest prefix that fits, by halving.
    let (mut fits, mut too_long) = (0, ends.len());
    while too_long - fits > 1 {
        let middle = (fits + too_long) / 2;
        match width(&cut(middle)) <= most {
            true => fits = middle,
            false => too_long = middle,
        }
    }
    if fits == 0 { String::new() } else { cut(fits) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_text_is_as_wide_as_in_helvetica() {
        assert!((width("Front") - (0.611 + 0.333 + 0.556 + 0.556 + 0.278)).abs() < 1e-12);
        assert_eq!(width("Zwickel €"), width("Zwickel 0"));
        assert!((width("ÄÖ") - 1.445).abs() < 1e-12);
    }

    #[test]
    fn a_text_is_shortened_between_letters_to_the_width_asked() {
        for text in [
            "front bodice with a long name",
            "Передняя половинка",
            "zsebőrőőő",
        ] {
            for most in [0.5, 1.5, 3.0, 6.0] {
                let short = shortened(text, most);
                assert!(width(&short) <= most, "{short:?}");
                let start = short.trim_end_matches('…');
                assert!(text.starts_with(start), "{short:?}");
                assert!(short.is_empty() || short == text || short.ends_with('…'));
            }
        }
        assert_eq!(shortened("abc", 10.0), "abc");
        assert_eq!(shortened("", 1.0), "");
    }

    #[test]
    fn letters_of_no_font_are_named() {
        // A letter of the private use area, which fonts of writing do not have.
        let missing = missing_letters(["plain", "a\u{f8ffe}b"]);
        assert_eq!(missing.iter().collect::<Vec<_>>(), [&'\u{f8ffe}']);
        assert!(missing_note(&missing).unwrap().contains("U+F8FFE"));
        assert_eq!(missing_note(&BTreeSet::new()), None);
    }
}
