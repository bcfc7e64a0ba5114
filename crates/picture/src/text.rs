//! Words on an image.

use crate::colour::Rgb;
use crate::font::{CAPITAL, Glyph, SPACING, glyph};
use crate::image::Image;
use crate::ink::Ink;
use toile_lettering::Line;

/// Where the given point lies in the line of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// The text begins at the point.
    Left,
    /// The text is centred on the point.
    Middle,
    /// The text ends at the point.
    Right,
}

/// How words look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextStyle {
    /// Height of a capital letter (pixel).
    pub height: f64,
    /// Width of the strokes as part of the height; 0.1 is plain, 0.15 bold.
    pub weight: f64,
    /// Colour of the strokes.
    pub colour: Rgb,
    /// Where the given point lies.
    pub align: Align,
}

impl TextStyle {
    /// Plain dark letters that begin at the point.
    pub fn plain(height: f64) -> Self {
        Self {
            height,
            weight: 0.115,
            colour: [0.17, 0.17, 0.19],
            align: Align::Left,
        }
    }
}

/// Height of capitals over the size of letters in fonts.
const CAPITALS: f64 = 0.7;

/// Letters of a line of text.
enum Letters {
    /// In strokes, where these have all of them.
    Strokes(Vec<Glyph>),
    /// In fonts.
    Fonts(Line),
}

impl Letters {
    fn of(text: &str) -> Self {
        match text.chars().map(glyph).collect() {
            Some(glyphs) => Self::Strokes(glyphs),
            None => Self::Fonts(Line::new(text)),
        }
    }

    /// Width (pixel), capitals being so high.
    fn width(&self, height: f64) -> f64 {
        match self {
            Self::Strokes(glyphs) => {
                let units: f64 = glyphs.iter().map(|glyph| glyph.1).sum();
                (units - SPACING).max(0.0) * height / CAPITAL
            }
            Self::Fonts(line) => line.width * height / CAPITALS,
        }
    }
}

/// Width of a line of text (pixel).
pub fn text_width(text: &str, height: f64) -> f64 {
    Letters::of(text).width(height)
}

impl Image {
    /// Writes a line of text with its baseline through a point in pixels; text that is not ASCII in a
    /// font that has its letters.
    pub fn write(&mut self, at: [f64; 2], text: &str, style: &TextStyle) {
        self.write_turned(at, text, style, [[1.0, 0.0], [0.0, 1.0]]);
    }

    /// The same, turned a quarter to the left: words run upwards.
    pub fn write_upright(&mut self, at: [f64; 2], text: &str, style: &TextStyle) {
        self.write_turned(at, text, style, [[0.0, 1.0], [-1.0, 0.0]]);
    }

    /// Writes along the first row of `turn` (x and y parts of a pixel to the right and down).
    fn write_turned(&mut self, at: [f64; 2], text: &str, style: &TextStyle, turn: [[f64; 2]; 2]) {
        let letters = Letters::of(text);
        let width = letters.width(style.height);
        let start = match style.align {
            Align::Left => 0.0,
            Align::Middle => -0.5 * width,
            Align::Right => -width,
        };
        let place = |along: f64, up: f64| {
            [0, 1].map(|k| at[k] + turn[0][k] * (start + along) - turn[1][k] * up)
        };
        match letters {
            Letters::Strokes(glyphs) => {
                let unit = style.height / CAPITAL;
                let mut ink = Ink::default();
                let mut x = 0.0;
                for (strokes, advance) in glyphs {
                    for stroke in strokes {
                        let points: Vec<[f64; 2]> = stroke
                            .iter()
                            .map(|p| place(x + unit * p[0], unit * p[1]))
                            .collect();
                        let dot = if points.len() == 1 { 1.3 } else { 1.0 };
                        ink.path(&points, 0.5 * dot * style.weight * style.height);
                    }
                    x += unit * advance;
                }
                ink.lay_on(self, style.colour);
            }
            Letters::Fonts(line) => {
                let size = style.height / CAPITALS;
                // Letter by letter: where they join they lie on one another.
                for mut rings in line.outlines() {
                    for p in rings.iter_mut().flatten() {
                        *p = place(size * p[0], size * p[1]);
                    }
                    self.fill_rings(&rings, style.colour);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ink_columns(image: &Image) -> (usize, usize) {
        let dark = |x: usize| (0..image.height).any(|y| image.pixel(x, y).unwrap()[0] < 128);
        let columns: Vec<usize> = (0..image.width).filter(|&x| dark(x)).collect();
        (columns[0], columns[columns.len() - 1])
    }

    #[test]
    fn alignment_puts_the_words_where_asked() {
        let spans = [Align::Left, Align::Middle, Align::Right].map(|align| {
            let mut image = Image::new(300, 40, [1.0; 3]).unwrap();
            let style = TextStyle {
                align,
                ..TextStyle::plain(14.0)
            };
            image.write([150.0, 25.0], "Front 5 %", &style);
            ink_columns(&image)
        });
        assert!(spans[0].0 >= 148 && spans[2].1 <= 152);
        assert!((150 - spans[1].0).abs_diff(spans[1].1 - 150) <= 5);
        assert!((spans[0].1 - spans[0].0).abs_diff(spans[2].1 - spans[2].0) <= 1);
    }

    #[test]
    fn letters_beyond_ascii_are_as_high_as_others() {
        let mut image = Image::new(60, 60, [1.0; 3]).unwrap();
        image.write([10.0, 50.0], "Ш", &TextStyle::plain(28.0));
        let dark = |x: usize, y: usize| image.pixel(x, y).unwrap()[0] < 128;
        let rows: Vec<usize> = (0..60).filter(|&y| (0..60).any(|x| dark(x, y))).collect();
        let (top, bottom) = (rows[0], rows[rows.len() - 1]);
        assert!((48..=50).contains(&bottom), "{bottom}");
        assert!((26..=31).contains(&(bottom - top + 1)), "{top} {bottom}");
        // Three strokes stand on a line: three dark runs half-way up.
        let half: Vec<bool> = (0..60).map(|x| dark(x, 36)).collect();
        let starts = half.windows(2).filter(|pair| !pair[0] && pair[1]).count();
        assert_eq!(starts, 3);
    }

    #[test]
    fn an_l_stands_on_the_baseline_with_the_asked_height() {
        let mut image = Image::new(40, 60, [1.0; 3]).unwrap();
        image.write([10.0, 50.0], "L", &TextStyle::plain(28.0));
        let rows: Vec<usize> = (0..60)
            .filter(|&y| (0..40).any(|x| image.pixel(x, y).unwrap()[0] < 128))
            .collect();
        let (top, bottom) = (rows[0], rows[rows.len() - 1]);
        assert!((49..=52).contains(&bottom), "{bottom}");
        assert!((28..=33).contains(&(bottom - top + 1)), "{top} {bottom}");
    }
}
