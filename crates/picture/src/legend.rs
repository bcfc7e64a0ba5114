//! The key to a coloured picture: a bar with ticks, a unit and plain words.

use crate::PictureError;
use crate::colour_map::ColourScale;
use crate::image::Image;
use crate::text::{Align, TextStyle, text_width};

/// The meaning of the colours of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// The quantity shown, as in "Stretch along the warp".
    pub title: String,
    /// Unit of the values, as in "%"; may be empty.
    pub unit: String,
    /// The colours of the values.
    pub scale: ColourScale,
    /// Words at the low and the high end, as in "relaxed" and "tight"; may be empty.
    pub ends: [String; 2],
    /// Words for the colour over the limit, as in "over the cloth's limit".
    pub over: String,
}

impl Legend {
    /// Checks the range of values.
    ///
    /// # Errors
    /// The ends are not finite or not in order.
    pub(crate) fn check(&self) -> Result<(), PictureError> {
        let span = self.scale.high - self.scale.low;
        if span.is_finite() && span > 0.0 {
            Ok(())
        } else {
            Err(PictureError::NotFinite("the range of the legend"))
        }
    }

    /// Height of the drawn legend for a height of capital letters (pixel).
    pub fn height(letters: f64) -> f64 {
        7.2 * letters
    }

    /// Draws the legend with its top left corner at a point; `letters` is the height of capital
    /// letters (pixel). Returns the corners of the colour bar (pixel).
    pub fn draw(&self, image: &mut Image, at: [f64; 2], width: f64, letters: f64) -> [[f64; 2]; 2] {
        let style = TextStyle::plain(letters);
        let title = if self.unit.is_empty() {
            self.title.clone()
        } else {
            format!("{}, {}", self.title, self.unit)
        };
        image.write([at[0], at[1] + letters], &title, &style);
        let over_width = match self.scale.over {
            Some(_) => letters * 2.0 + text_width(&self.over, letters).max(2.5 * letters),
            None => 0.0,
        };
        let top = at[1] + 2.2 * letters;
        let bar = [
            [at[0], top],
            [at[0] + width - over_width, top + 1.6 * letters],
        ];
        self.draw_bar(image, bar);
        self.draw_ticks(image, bar, &style);
        if let Some(over) = self.scale.over {
            let left = bar[1][0] + 1.5 * letters;
            image.fill_rectangle([left, top], [left + 2.5 * letters, bar[1][1]], over);
            let base = bar[1][1] + 2.1 * letters;
            image.write([left, base], &self.over, &style);
        }
        bar
    }

    fn draw_bar(&self, image: &mut Image, [from, to]: [[f64; 2]; 2]) {
        let columns = (to[0] - from[0]).max(1.0);
        for column in 0..columns as usize {
            let part = (column as f64 + 0.5) / columns;
            let colour = self.scale.map.colour(part);
            let x = from[0] + column as f64;
            image.fill_rectangle([x, from[1]], [x + 1.0, to[1]], colour);
        }
    }

    fn draw_ticks(&self, image: &mut Image, [from, to]: [[f64; 2]; 2], style: &TextStyle) {
        let letters = style.height;
        let middle = TextStyle {
            align: Align::Middle,
            ..*style
        };
        let (low, high) = (self.scale.low, self.scale.high);
        let (ticks, decimals) = ticks(low, high);
        for value in ticks {
            let x = from[0] + (to[0] - from[0]) * (value - low) / (high - low);
            let line = [[x, to[1]], [x, to[1] + 0.5 * letters]];
            image.draw_path(&line, (0.1 * letters).max(1.0), style.colour);
            let text = format!("{value:.decimals$}");
            image.write([x, to[1] + 2.1 * letters], &text, &middle);
        }
        let soft = TextStyle {
            colour: [0.40, 0.40, 0.43],
            ..*style
        };
        let base = to[1] + 3.9 * letters;
        image.write([from[0], base], &self.ends[0], &soft);
        let right = TextStyle {
            align: Align::Right,
            ..soft
        };
        image.write([to[0], base], &self.ends[1], &right);
    }
}

/// Round values from `low` to `high`, about five steps, and how many decimals show them.
fn ticks(low: f64, high: f64) -> (Vec<f64>, usize) {
    let rough = (high - low) / 5.0;
    let power = rough.log10().floor();
    let unit = 10_f64.powf(power);
    let factor = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|f| f * unit >= rough * 0.999)
        .unwrap_or(10.0);
    let step = factor * unit;
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    let first = (low / step - 1e-9).ceil();
    let count = ((high / step + 1e-9).floor() - first).clamp(0.0, 20.0) as usize;
    // Adding zero turns a negative zero into a plain one.
    let values = (0..=count)
        .map(|k| (first + k as f64) * step + 0.0)
        .collect();
    (values, decimals)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ColourMap;
    use crate::colour::byte;

    fn legend() -> Legend {
        Legend {
            title: "Stretch along the warp".into(),
            unit: "%".into(),
            scale: ColourScale {
                map: ColourMap::Heat,
                low: 0.0,
                high: 5.0,
                over: Some(ColourScale::OVER),
            },
            ends: ["relaxed".into(), "tight".into()],
            over: "over 5 %".into(),
        }
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks(0.0, 5.0), (vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0], 0));
        assert_eq!(ticks(-2.0, 2.0).0, [-2.0, -1.0, 0.0, 1.0, 2.0]);
        let (values, decimals) = ticks(0.0, 0.037);
        assert_eq!(decimals, 2);
        assert!(values.len() >= 4 && values[values.len() - 1] <= 0.037);
        let (values, decimals) = ticks(0.0, 12_000.0);
        assert_eq!((values[1], decimals), (5000.0, 0));
    }

    #[test]
    fn the_bar_shows_the_colours_of_the_values() {
        let legend = legend();
        let mut image = Image::new(600, 120, [1.0; 3]).unwrap();
        let [from, to] = legend.draw(&mut image, [20.0, 10.0], 560.0, 12.0);
        let row = (0.5 * (from[1] + to[1])) as usize;
        for value in [0.5, 2.5, 4.5] {
            let x = from[0] + (to[0] - from[0]) * value / 5.0;
            let pixel = image.pixel(x as usize, row).unwrap();
            let wanted = legend.scale.colour(value).map(byte);
            for k in 0..3 {
                assert!(
                    pixel[k].abs_diff(wanted[k]) <= 2,
                    "{value}: {pixel:?} {wanted:?}"
                );
            }
        }
        let over = image.pixel(to[0] as usize + 30, row).unwrap();
        assert_eq!(over[..3], ColourScale::OVER.map(byte));
    }

    #[test]
    fn empty_ranges_are_refused() {
        let mut legend = legend();
        assert!(legend.check().is_ok());
        for high in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            legend.scale.high = high;
            assert!(legend.check().is_err(), "{high}");
        }
    }
}
