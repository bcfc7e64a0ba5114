//! Flat drawings of plain lines, filled areas and words, as SVG text or on an image; charts are drawn with
//! them.

use crate::{Align, Image, PictureError, Rgb, TextStyle};
use std::fmt::Write;

/// One mark of a drawing; places in pixels from the top left.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Mark {
    /// Joined segments; one point alone is a round dot.
    Path {
        points: Vec<[f64; 2]>,
        width: f64,
        colour: Rgb,
        dashed: bool,
    },
    /// A filled rectangle between two corners.
    Box {
        from: [f64; 2],
        to: [f64; 2],
        colour: Rgb,
    },
    /// A line of words, its baseline at the place; turned a quarter to the left or not.
    Words {
        at: [f64; 2],
        text: String,
        height: f64,
        align: Align,
        upright: bool,
        colour: Rgb,
    },
}

/// Marks on white paper.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Width and height (pixel).
    pub size: [f64; 2],
    pub(crate) marks: Vec<Mark>,
}

/// Length of a dash and of the gap after it (pixel).
const DASH: [f64; 2] = [6.0, 4.0];

impl Drawing {
    /// Drawings in rows of so many columns, each as wide and high as the largest.
    pub fn sheet(drawings: &[Self], columns: usize) -> Self {
        let columns = columns.max(1);
        let largest = |axis: usize| drawings.iter().map(|d| d.size[axis]).fold(0.0, f64::max);
        let cell = [largest(0), largest(1)];
        let rows = drawings.len().div_ceil(columns);
        let mut sheet = Self {
            size: [
                cell[0] * columns.min(drawings.len().max(1)) as f64,
                cell[1] * rows as f64,
            ],
            marks: Vec::new(),
        };
        for (k, drawing) in drawings.iter().enumerate() {
            let by = [
                cell[0] * (k % columns) as f64,
                cell[1] * (k / columns) as f64,
            ];
            sheet
                .marks
                .extend(drawing.marks.iter().cloned().map(|mark| mark.moved(by)));
        }
        sheet
    }

    /// The drawing as an SVG file.
    pub fn to_svg(&self) -> String {
        let [width, height] = self.size;
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {width:.0} {height:.0}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
        );
        for mark in &self.marks {
            mark.write_svg(&mut text);
        }
        text + "</svg>\n"
    }

    /// The drawing as an image.
    ///
    /// # Errors
    /// An empty or too large drawing.
    pub fn to_image(&self) -> Result<Image, PictureError> {
        let [width, height] = self.size.map(|s| s.round().max(0.0) as usize);
        let mut image = Image::new(width, height, [1.0; 3])?;
        for mark in &self.marks {
            mark.draw(&mut image);
        }
        Ok(image)
    }
}

fn hex(colour: Rgb) -> String {
    let [r, g, b] = colour.map(crate::colour::byte);
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

impl Mark {
    fn moved(mut self, by: [f64; 2]) -> Self {
        let shift = |p: &mut [f64; 2]| {
            p[0] += by[0];
            p[1] += by[1];
        };
        match &mut self {
            Self::Path { points, .. } => points.iter_mut().for_each(shift),
            Self::Box { from, to, .. } => [from, to].into_iter().for_each(shift),
            Self::Words { at, .. } => shift(at),
        }
        self
    }

    fn write_svg(&self, text: &mut String) {
        let _ = match self {
            Self::Path {
                points,
                width,
                colour,
                ..
            } if points.len() == 1 => writeln!(
                text,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{:.1}\" fill=\"{}\"/>",
                points[0][0],
                points[0][1],
                0.5 * width,
                hex(*colour)
            ),
            Self::Path {
                points,
                width,
                colour,
                dashed,
            } => {
                let list: Vec<String> = points
                    .iter()
                    .map(|p| format!("{:.1},{:.1}", p[0], p[1]))
                    .collect();
                let dash = if *dashed {
                    format!(" stroke-dasharray=\"{} {}\"", DASH[0], DASH[1])
                } else {
                    String::new()
                };
                writeln!(
                    text,
                    "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width:.1}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"{dash}/>",
                    list.join(" "),
                    hex(*colour)
                )
            }
            Self::Box { from, to, colour } => writeln!(
                text,
                "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{}\"/>",
                from[0],
                from[1],
                to[0] - from[0],
                to[1] - from[1],
                hex(*colour)
            ),
            Self::Words {
                at,
                text: words,
                height,
                align,
                upright,
                colour,
            } => {
                let anchor = match align {
                    Align::Left => "start",
                    Align::Middle => "middle",
                    Align::Right => "end",
                };
                let turn = if *upright {
                    format!(" transform=\"rotate(-90 {:.1} {:.1})\"", at[0], at[1])
                } else {
                    String::new()
                };
                // Capitals are seven tenths of the size of a sans-serif face.
                writeln!(
                    text,
                    "<text x=\"{:.1}\" y=\"{:.1}\" font-family=\"sans-serif\" font-size=\"{:.1}\" text-anchor=\"{anchor}\" fill=\"{}\"{turn}>{}</text>",
                    at[0],
                    at[1],
                    height / 0.7,
                    hex(*colour),
                    escaped(words)
                )
            }
        };
    }

    fn draw(&self, image: &mut Image) {
        match self {
            Self::Path {
                points,
                width,
                colour,
                dashed,
            } => {
                if *dashed {
                    for dash in dashes(points) {
                        image.draw_path(&dash, *width, *colour);
                    }
                } else {
                    image.draw_path(points, *width, *colour);
                }
            }
            Self::Box { from, to, colour } => image.fill_rectangle(*from, *to, *colour),
            Self::Words {
                at,
                text,
                height,
                align,
                upright,
                colour,
            } => {
                let style = TextStyle {
                    colour: *colour,
                    align: *align,
                    ..TextStyle::plain(*height)
                };
                if *upright {
                    image.write_upright(*at, text, &style);
                } else {
                    image.write(*at, text, &style);
                }
            }
        }
    }
}

/// A path cut into dashes.
fn dashes(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let (mut found, mut present) = (Vec::new(), Vec::new());
    let (mut left, mut on) = (DASH[0], true);
    for pair in points.windows(2) {
        let [mut a, b] = [pair[0], pair[1]];
        if on && present.is_empty() {
            present.push(a);
        }
        loop {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            if length <= left || length.is_nan() {
                left -= length;
                if on {
                    present.push(b);
                }
                break;
            }
            let t = left / length;
            a = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
            if on {
                present.push(a);
                found.push(std::mem::take(&mut present));
            } else {
                present.push(a);
            }
            on = !on;
            left = if on { DASH[0] } else { DASH[1] };
        }
    }
    if present.len() > 1 {
        found.push(present);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_cover_their_share_of_a_line() {
        let found = dashes(&[[0.0, 0.0], [60.0, 0.0], [60.0, 40.0]]);
        let total: f64 = found
            .iter()
            .flat_map(|d| d.windows(2))
            .map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]))
            .sum();
        assert!((total - 60.0).abs() < 1e-9, "{total}");
    }

    #[test]
    fn words_are_escaped_and_drawings_are_laid_side_by_side() {
        let drawing = Drawing {
            size: [100.0, 50.0],
            marks: vec![Mark::Words {
                at: [10.0, 20.0],
                text: "a < b & c".to_owned(),
                height: 8.0,
                align: Align::Left,
                upright: false,
                colour: [0.0; 3],
            }],
        };
        let sheet = Drawing::sheet(&[drawing.clone(), drawing.clone(), drawing], 2);
        assert_eq!(sheet.size, [200.0, 100.0]);
        let svg = sheet.to_svg();
        assert!(svg.contains("a &lt; b &amp; c") && svg.contains("x=\"110.0\""));
        let image = sheet.to_image().unwrap();
        assert!(image.pixels.iter().any(|&b| b < 128));
        assert!(Drawing::default().to_image().is_err());
    }
}
