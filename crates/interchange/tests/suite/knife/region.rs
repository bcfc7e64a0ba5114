//! The cloth inside seam lines as a file draws them, and whether a line runs through it.

use crate::knife::files::Line;
use toile_geometry::Vec2;

/// A place this near to a seam line is not inside (m).
const NEAR: f64 = 5e-5;
/// Between places of a line that are looked at (m).
const STEP: f64 = 2.5e-4;
/// Most places that are looked at along a side.
const MOST: usize = 40;
/// Strips by height.
const BANDS: usize = 256;

/// Sides of seam lines by height.
pub struct Region {
    low: f64,
    band: f64,
    bands: Vec<Vec<[Vec2; 2]>>,
}

fn inside_ring(at: Vec2, ring: &[Vec2]) -> bool {
    let mut inside = false;
    for (k, p) in ring.iter().enumerate() {
        let q = ring[(k + 1) % ring.len()];
        if (p.y > at.y) != (q.y > at.y) && at.x < p.x + (at.y - p.y) * (q.x - p.x) / (q.y - p.y) {
            inside = !inside;
        }
    }
    inside
}

fn away(at: Vec2, [p, q]: [Vec2; 2]) -> f64 {
    let way = q - p;
    let share = ((at - p).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
    match share.is_finite() {
        true => (p + way * share - at).norm(),
        false => (p - at).norm(),
    }
}

impl Region {
    /// Of closed seam lines. One inside another is a hole if a cut line lies in it, else a dart
    /// that holds cloth. Seam lines of halves are open at the fold and closed by it.
    pub fn new(sewn: &[Line], cut: &[Line]) -> Self {
        let is_dart = |(k, ring): (usize, &Line)| {
            let at = ring[0];
            let others = sewn.iter().enumerate().filter(|(other, _)| *other != k);
            let is_inner = others.filter(|(_, o)| inside_ring(at, o)).count() % 2 == 1;
            let holds = |line: &Line| {
                let on = |p: &Vec2| {
                    let count = ring.len();
                    (0..count).any(|k| away(*p, [ring[k], ring[(k + 1) % count]]) < NEAR)
                };
                line.iter().all(|p| inside_ring(*p, ring) || on(p))
            };
            is_inner && !cut.iter().any(holds)
        };
        let rings = sewn.iter().enumerate().filter(|ring| !is_dart(*ring));
        let rings: Vec<&Line> = rings.map(|(_, ring)| ring).collect();
        let heights = || rings.iter().flat_map(|ring| ring.iter().map(|p| p.y));
        let low = heights().fold(f64::INFINITY, f64::min);
        let high = heights().fold(f64::NEG_INFINITY, f64::max);
        let band = ((high - low) / BANDS as f64).max(1e-3);
        let mut region = Self {
            low,
            band,
            bands: vec![Vec::new(); BANDS + 2],
        };
        for ring in rings {
            for (k, &p) in ring.iter().enumerate() {
                let q = ring[(k + 1) % ring.len()];
                let first = region.number(p.y.min(q.y) - NEAR);
                let last = region.number(p.y.max(q.y) + NEAR);
                for band in first..=last {
                    region.bands[band].push([p, q]);
                }
            }
        }
        region
    }

    fn number(&self, height: f64) -> usize {
        let band = ((height - self.low) / self.band).max(0.0) as usize;
        band.min(self.bands.len() - 1)
    }

    fn holds(&self, at: Vec2) -> bool {
        let sides = &self.bands[self.number(at.y)];
        let mut inside = false;
        for &[p, q] in sides {
            if (p.y > at.y) != (q.y > at.y) && at.x < p.x + (at.y - p.y) * (q.x - p.x) / (q.y - p.y)
            {
                inside = !inside;
            }
        }
        inside && sides.iter().all(|side| away(at, *side) >= NEAR)
    }

    /// A place of a line that lies inside.
    pub fn point_inside(&self, line: &Line) -> Option<Vec2> {
        let places = line.windows(2).flat_map(|pair| {
            let count = (((pair[1] - pair[0]).norm() / STEP).ceil() as usize).clamp(1, MOST);
            let at = move |k: usize| pair[0] + (pair[1] - pair[0]) * (k as f64 / count as f64);
            (0..=count).map(at).collect::<Vec<_>>()
        });
        places.into_iter().find(|at| self.holds(*at))
    }
}
