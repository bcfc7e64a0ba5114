//! Random seam lines: star-shaped outlines with curves, necklines, darts, slits and holes.

use super::{KINDS, line, reversed, reversed_loop};
use toile_cut::{Dart, SeamEdge, SeamLine};
use toile_geometry::{Curve, Vec2};

/// Numbers from 0 to 1, taken one after another.
pub struct Draw<'a> {
    numbers: &'a [f64],
    next: usize,
}

impl<'a> Draw<'a> {
    pub fn new(numbers: &'a [f64]) -> Self {
        Self { numbers, next: 0 }
    }

    fn unit(&mut self) -> f64 {
        let number = self.numbers[self.next % self.numbers.len()];
        // The second round differs from the first.
        let round = (self.next / self.numbers.len()) as f64;
        self.next += 1;
        (number + 0.377 * round).fract()
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    fn width(&mut self) -> f64 {
        match self.chance(0.15) {
            true => 0.0,
            false => self.between(0.003, 0.04),
        }
    }

    fn edge(&mut self, curve: Curve) -> SeamEdge {
        SeamEdge {
            limit: toile_cut::MITRE_LIMIT,
            curve,
            width: self.width(),
            corner: KINDS[((self.unit() * 7.0) as usize).min(6)],
        }
    }

    fn curve(&mut self, start: Vec2, end: Vec2) -> Curve {
        let chord = end - start;
        let left = Vec2::new(-chord.y, chord.x);
        let pick = self.unit();
        if pick < 0.35 {
            return line(start, end);
        }
        if pick < 0.55 {
            let bulge = self.between(-0.6, 0.6);
            return Curve::Arc { start, end, bulge };
        }
        // A neckline dives into the piece and turns round there.
        let depth = match pick < 0.7 {
            true => self.between(0.4, 1.2),
            false => self.between(-0.4, 0.4),
        };
        let skew = self.between(-0.5, 0.5);
        let share = self.between(0.05, 0.4);
        let controls = [
            start + chord * share + left * depth,
            end - chord * share + left * (depth + skew),
        ];
        Curve::Cubic {
            start,
            controls,
            end,
        }
    }

    fn push_notched(&mut self, seam: &mut SeamLine, start: Vec2, end: Vec2) {
        let along = (end - start).normalize();
        let inward = Vec2::new(-along.y, along.x);
        let middle = start + (end - start) * self.between(0.35, 0.65);
        let half = self.between(0.002, 0.018);
        let depth = self.between(0.03, 0.09);
        let edge = self.edge(line(start, middle - along * half));
        seam.outline.push(edge);
        let apex = middle + inward * depth;
        let legs = [seam.outline.len(), seam.outline.len() + 1];
        for curve in [
            line(middle - along * half, apex),
            line(apex, middle + along * half),
        ] {
            let leg = self.edge(curve);
            seam.outline.push(leg);
        }
        if self.chance(0.6) {
            let pressed = usize::from(self.chance(0.5));
            seam.darts.push(Dart { legs, pressed });
        }
        let edge = self.edge(line(middle + along * half, end));
        seam.outline.push(edge);
    }

    fn hole(&mut self) -> Vec<SeamEdge> {
        let radius = self.between(0.008, 0.05);
        let count = 2 + (self.unit() * 4.0) as usize;
        let turn = self.between(0.0, 6.0);
        let corner = |k: usize| {
            let angle = turn + std::f64::consts::TAU * k as f64 / count as f64;
            Vec2::new(angle.cos(), angle.sin()) * radius
        };
        let bulge = match count {
            2 => self.between(0.3, 1.0),
            _ => self.between(-0.1, 0.3),
        };
        (0..count)
            .map(|k| {
                let (start, end) = (corner(k), corner((k + 1) % count));
                self.edge(Curve::Arc { start, end, bulge })
            })
            .collect()
    }
}

/// A random seam line; it may cross itself.
pub fn random_seam(numbers: &[f64]) -> SeamLine {
    let mut draw = Draw::new(numbers);
    let count = 4 + (draw.unit() * 4.0) as usize;
    let corners: Vec<Vec2> = (0..count)
        .map(|k| {
            let angle = std::f64::consts::TAU * (k as f64 + draw.between(-0.3, 0.3)) / count as f64;
            Vec2::new(angle.cos(), angle.sin()) * draw.between(0.12, 0.4)
        })
        .collect();
    let mut seam = SeamLine::default();
    for k in 0..count {
        let (start, end) = (corners[k], corners[(k + 1) % count]);
        if (end - start).norm() > 0.1 && draw.chance(0.3) {
            draw.push_notched(&mut seam, start, end);
        } else {
            let curve = draw.curve(start, end);
            let edge = draw.edge(curve);
            seam.outline.push(edge);
        }
    }
    if draw.chance(0.5) {
        let hole = draw.hole();
        let turned = draw.chance(0.5);
        seam.holes
            .push(if turned { reversed_loop(&hole) } else { hole });
    }
    match draw.chance(0.3) {
        true => reversed(&seam),
        false => seam,
    }
}
