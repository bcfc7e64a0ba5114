//! Overlapping strokes blended as one shape.

use crate::colour::Rgb;
use crate::image::Image;
use std::collections::BTreeMap;

/// The share of each pixel that is covered, 0..=1, by column within row.
#[derive(Default)]
pub(crate) struct Ink {
    rows: BTreeMap<i64, BTreeMap<i64, f64>>,
}

/// Strokes farther out than this are not drawn (pixel).
const FURTHEST: f64 = 1e5;

impl Ink {
    /// Adds segments through points, with round ends. One point gives a dot.
    pub(crate) fn path(&mut self, points: &[[f64; 2]], radius: f64) {
        match points {
            [] => {}
            [point] => self.segment(*point, *point, radius),
            _ => points
                .windows(2)
                .for_each(|pair| self.segment(pair[0], pair[1], radius)),
        }
    }

    fn segment(&mut self, a: [f64; 2], b: [f64; 2], radius: f64) {
        if ![a, b].iter().flatten().all(|x| x.abs() < FURTHEST) {
            return;
        }
        let along = [b[0] - a[0], b[1] - a[1]];
        let squared = along[0].powi(2) + along[1].powi(2);
        let reach = radius + 1.0;
        let range = |k: usize| {
            let low = (a[k].min(b[k]) - reach).floor() as i64;
            low..=(a[k].max(b[k]) + reach).ceil() as i64
        };
        for y in range(1) {
            for x in range(0) {
                let p = [x as f64 + 0.5 - a[0], y as f64 + 0.5 - a[1]];
                let t = if squared > 0.0 {
                    ((p[0] * along[0] + p[1] * along[1]) / squared).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let distance = (p[0] - t * along[0]).hypot(p[1] - t * along[1]);
                let cover = (radius + 0.5 - distance).clamp(0.0, 1.0).min(2.0 * radius);
                if cover > 0.0 {
                    let cell = self.rows.entry(y).or_default().entry(x).or_default();
                    *cell = cell.max(cover);
                }
            }
        }
    }

    /// Blends the shape onto an image.
    pub(crate) fn lay_on(&self, image: &mut Image, colour: Rgb) {
        for (&y, row) in &self.rows {
            for (&x, &cover) in row {
                image.blend(x, y, colour, cover);
            }
        }
    }
}

impl Image {
    /// Draws joined segments through points in pixels, round ends, as one shape.
    pub fn draw_path(&mut self, points: &[[f64; 2]], width: f64, colour: Rgb) {
        let mut ink = Ink::default();
        ink.path(points, 0.5 * width);
        ink.lay_on(self, colour);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_as_wide_as_asked() {
        let mut image = Image::new(40, 20, [0.0; 3]).unwrap();
        image.draw_path(&[[5.0, 10.0], [20.0, 10.0], [35.0, 10.0]], 4.0, [1.0; 3]);
        let column: f64 = (0..20)
            .map(|y| f64::from(image.pixel(20, y).unwrap()[0]) / 255.0)
            .sum();
        assert!((column - 4.0).abs() < 0.05, "{column}");
    }
}
