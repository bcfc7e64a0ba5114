//! Words on an image.

use crate::colour::Rgb;
use crate::font::{CAPITAL, SPACING, glyph};
use crate::image::Image;
use crate::ink::Ink;

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
    /// Height of a capital letter \[pixel\].
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

/// Width of a line of text \[pixel\].
pub fn text_width(text: &str, height: f64) -> f64 {
    let units: f64 = text.chars().map(|c| glyph(c).1).sum();
    (units - SPACING).max(0.0) * height / CAPITAL
}

impl Image {
    /// Writes a line of ASCII text with its baseline through a point in pixels; other characters
    /// show as question marks.
    pub fn write(&mut self, at: [f64; 2], text: &str, style: &TextStyle) {
        self.write_turned(at, text, style, [[1.0, 0.0], [0.0, 1.0]]);
    }

    /// The same, turned a quarter to the left: words run upwards.
    pub fn write_upright(&mut self, at: [f64; 2], text: &str, style: &TextStyle) {
        self.write_turned(at, text, style, [[0.0, 1.0], [-1.0, 0.0]]);
    }

    /// Writes along the first row of `turn` (x and y parts of a pixel to the right and down).
    fn write_turned(&mut self, at: [f64; 2], text: &str, style: &TextStyle, turn: [[f64; 2]; 2]) {
        let unit = style.height / CAPITAL;
        let width = text_width(text, style.height);
        let mut x = match style.align {
            Align::Left => 0.0,
            Align::Middle => -0.5 * width,
            Align::Right => -width,
        };
        let mut ink = Ink::default();
        for character in text.chars() {
            let (strokes, advance) = glyph(character);
            for stroke in strokes {
                let points: Vec<[f64; 2]> = stroke
                    .iter()
                    .map(|p| [x + unit * p[0], -unit * p[1]])
                    .map(|[along, down]| {
                        [
                            at[0] + turn[0][0] * along + turn[0][1] * down,
                            at[1] + turn[1][0] * along + turn[1][1] * down,
                        ]
                    })
                    .collect();
                let dot = if points.len() == 1 { 1.3 } else { 1.0 };
                ink.path(&points, 0.5 * dot * style.weight * style.height);
            }
            x += unit * advance;
        }
        ink.lay_on(self, style.colour);
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
