//! Outlines of glyphs as closed lines.

use skrifa::outline::OutlinePen;

/// Largest distance of a line from the curve it stands for, over the size of the letters.
const TOLERANCE: f64 = 0.002;

/// Gathers the contours of a glyph.
pub(crate) struct Contours {
    /// Over the size of the letters, of a unit of the font.
    scale: f64,
    done: Vec<Vec<[f64; 2]>>,
    open: Vec<[f64; 2]>,
}

impl Contours {
    pub fn new(scale: f64) -> Self {
        Self {
            scale,
            done: Vec::new(),
            open: Vec::new(),
        }
    }

    pub fn finish(mut self) -> Vec<Vec<[f64; 2]>> {
        self.end();
        self.done
    }

    fn end(&mut self) {
        let mut contour = std::mem::take(&mut self.open);
        if contour.len() > 1 && contour.first() == contour.last() {
            contour.pop();
        }
        if contour.len() > 2 {
            self.done.push(contour);
        }
    }

    fn point(&self, x: f32, y: f32) -> [f64; 2] {
        [f64::from(x) * self.scale, f64::from(y) * self.scale]
    }

    /// Adds a curve with its control points; a curve of degree n with second differences d of its
    /// control points is nearer than n (n - 1) d / (8 m^2) to m chords.
    fn curve(&mut self, controls: &[[f64; 2]]) {
        let Some(&from) = self.open.last() else {
            return;
        };
        let all: Vec<[f64; 2]> = std::iter::once(from)
            .chain(controls.iter().copied())
            .collect();
        let degree = controls.len() as f64;
        let bend = all
            .windows(3)
            .map(|p| {
                let along = |k: usize| p[0][k] - 2.0 * p[1][k] + p[2][k];
                along(0).hypot(along(1))
            })
            .fold(0.0, f64::max);
        let parts = (degree * (degree - 1.0) * bend / (8.0 * TOLERANCE)).sqrt();
        let parts = parts.ceil().clamp(1.0, 64.0) as u32;
        for k in 1..=parts {
            self.open.push(at(&all, f64::from(k) / f64::from(parts)));
        }
    }
}

/// A point of a Bézier curve by its control points (de Casteljau).
fn at(controls: &[[f64; 2]], t: f64) -> [f64; 2] {
    let mut points = controls.to_vec();
    while points.len() > 1 {
        let mix = |p: &[[f64; 2]]| [0, 1].map(|k| p[0][k] + (p[1][k] - p[0][k]) * t);
        points = points.windows(2).map(mix).collect();
    }
    points[0]
}

impl OutlinePen for Contours {
    fn move_to(&mut self, x: f32, y: f32) {
        self.end();
        self.open.push(self.point(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.open.push(self.point(x, y));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.curve(&[self.point(cx, cy), self.point(x, y)]);
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        self.curve(&[self.point(cx0, cy0), self.point(cx1, cy1), self.point(x, y)]);
    }

    fn close(&mut self) {
        self.end();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_of_curves_is_followed_to_the_tolerance() {
        let mut pen = Contours::new(1.0);
        let k = 0.552_284_8;
        pen.move_to(1.0, 0.0);
        pen.curve_to(1.0, k, k, 1.0, 0.0, 1.0);
        pen.curve_to(-k, 1.0, -1.0, k, -1.0, 0.0);
        pen.curve_to(-1.0, -k, -k, -1.0, 0.0, -1.0);
        pen.curve_to(k, -1.0, 1.0, -k, 1.0, 0.0);
        pen.close();
        let contours = pen.finish();
        assert_eq!(contours.len(), 1);
        let ring = &contours[0];
        for (k, p) in ring.iter().enumerate() {
            let q = ring[(k + 1) % ring.len()];
            let middle = (0.5 * (p[0] + q[0])).hypot(0.5 * (p[1] + q[1]));
            assert!((middle - 1.0).abs() < TOLERANCE + 3e-4, "{middle}");
        }
    }
}
