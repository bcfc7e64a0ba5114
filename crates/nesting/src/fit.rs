//! Posed outlines and their no-fit polygons, computed once each.
//!
//! A no-fit polygon of a fixed and a moving shape holds the moves at which they overlap, or come
//! nearer than the gap. It is made on outlines that are simplified outwards, so that staying out
//! of it is always safe.

use crate::check::orientations;
use crate::simplify::simplify_outward;
use crate::{Item, Pose, Strip};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::{Arc, PoisonError, RwLock};
use toile_geometry::{
    Bounds2, Polygon, Vec2, minkowski_sum, no_fit_polygon, point_segment_distance,
};

/// How far outlines may grow when they are simplified \[m\]: well under the width of a chalk line.
const SIMPLIFY: f64 = 2e-4;
/// Corners of the polygon round the disc that keeps the gap.
const DISC_CORNERS: u32 = 16;
/// Positions nearer to the boundary of a no-fit polygon than this count as touching \[m\]: over the
/// rounding of the no-fit polygons, and under what the last exact check can still mend.
pub(crate) const TOUCH: f64 = 5e-8;

/// An item in one orientation.
#[derive(Clone, Debug)]
pub(crate) struct Shape {
    /// Index of the item.
    pub item: usize,
    /// Its orientation, not moved.
    pub pose: Pose,
    /// Its exact outline there.
    pub outline: Polygon,
    /// The box round it.
    pub bounds: Bounds2,
    /// The outer ring with fewer points, never inside the outline.
    ring: Vec<Vec2>,
    /// The shape of the same item turned by half a circle, if that is allowed too.
    opposite: Option<usize>,
}

/// The moves of one shape at which it overlaps another that stays.
#[derive(Clone, Debug)]
pub(crate) struct NoFit {
    /// Edges of the boundary: at its points the shapes touch.
    pub edges: Vec<[Vec2; 2]>,
    /// The box round them.
    pub bounds: Bounds2,
}

impl NoFit {
    fn new(regions: &[Polygon]) -> Self {
        let edges: Vec<[Vec2; 2]> = regions.iter().flat_map(Polygon::edges).collect();
        Self {
            bounds: Bounds2::of(edges.iter().flatten().copied()),
            edges,
        }
    }

    fn negated(&self) -> Self {
        Self {
            edges: self.edges.iter().map(|e| e.map(|p| -p)).collect(),
            bounds: Bounds2 {
                min: -self.bounds.max,
                max: -self.bounds.min,
            },
        }
    }

    /// Whether a move overlaps by more than [`TOUCH`].
    pub fn forbids(&self, at: Vec2) -> bool {
        let Bounds2 { min, max } = self.bounds;
        if at.x <= min.x + TOUCH
            || at.x >= max.x - TOUCH
            || at.y <= min.y + TOUCH
            || at.y >= max.y - TOUCH
        {
            return false;
        }
        let mut inside = false;
        for &[a, b] in &self.edges {
            if a.y.max(b.y) < at.y - TOUCH || a.y.min(b.y) > at.y + TOUCH {
                continue;
            }
            if touches(at, [a, b]) {
                return false;
            }
            if (a.y <= at.y) != (b.y <= at.y) {
                let x = a.x + (b.x - a.x) * ((at.y - a.y) / (b.y - a.y));
                inside ^= x > at.x;
            }
        }
        inside
    }
}

/// Whether a point is as near to a segment as [`TOUCH`].
fn touches(at: Vec2, [a, b]: [Vec2; 2]) -> bool {
    a.x.max(b.x) >= at.x - TOUCH
        && a.x.min(b.x) <= at.x + TOUCH
        && point_segment_distance(at, [a, b]) <= TOUCH
}

type PairKey = (usize, usize);
type Ring = Arc<Vec<Vec2>>;

/// All shapes of a job with the no-fit polygons found so far; may be shared by threads.
pub(crate) struct Fit {
    /// Every item in every orientation, item by item.
    pub shapes: Vec<Shape>,
    gaps: Vec<f64>,
    strip_gap: f64,
    pairs: RwLock<BTreeMap<PairKey, Arc<NoFit>>>,
    grown: RwLock<BTreeMap<(usize, u64), Ring>>,
}

impl Fit {
    /// Poses every item in every allowed orientation.
    pub fn new(items: &[Item], strip: &Strip) -> Self {
        let mut shapes: Vec<Shape> = Vec::new();
        for (k, item) in items.iter().enumerate() {
            let first = shapes.len();
            let mut ways = orientations(item, strip, 0);
            for way in orientations(item, strip, 1) {
                if item.quantity > 1 && !ways.contains(&way) {
                    ways.push(way);
                }
            }
            shapes.extend(ways.iter().map(|&way| Shape::new(k, item, way)));
            for s in first..shapes.len() {
                let half = |t: &Shape| {
                    let turned = (t.pose.turn - shapes[s].pose.turn).abs();
                    t.pose.mirrored == shapes[s].pose.mirrored && turned == PI
                };
                shapes[s].opposite = (first..shapes.len()).find(|&t| half(&shapes[t]));
            }
        }
        Self {
            shapes,
            gaps: items.iter().map(|item| item.gap).collect(),
            strip_gap: strip.gap,
            pairs: RwLock::default(),
            grown: RwLock::default(),
        }
    }

    /// Least distance between two shapes \[m\].
    pub fn gap(&self, a: usize, b: usize) -> f64 {
        let own = |s: usize| self.gaps[self.shapes[s].item];
        self.strip_gap.max(own(a)).max(own(b))
    }

    /// The no-fit polygon of a shape that moves round one that stays.
    ///
    /// With N(a, b) = a + (-b), and a' for a turned by half a circle: N(b, a) = N(a', b') =
    /// -N(a, b) and N(b', a') = N(a, b), so one computation serves four pairs.
    pub fn no_fit(&self, fixed: usize, moving: usize) -> Arc<NoFit> {
        let key = (fixed, moving);
        let known = self.pairs.read().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known.get(&key) {
            return found.clone();
        }
        drop(known);
        let opposite = |s: usize| self.shapes[s].opposite;
        let mut equal = vec![(key, false), ((moving, fixed), true)];
        if let (Some(f), Some(m)) = (opposite(fixed), opposite(moving)) {
            equal.extend([((f, m), true), ((m, f), false)]);
        }
        let &(first, turned) = equal.iter().min().unwrap_or(&(key, false));
        let made = Arc::new(self.compute(first));
        let negated = Arc::new(made.negated());
        let mut known = self.pairs.write().unwrap_or_else(PoisonError::into_inner);
        for (pair, sign) in equal {
            let same = if sign == turned { &made } else { &negated };
            known.entry(pair).or_insert_with(|| same.clone());
        }
        known.get(&key).cloned().unwrap_or(made)
    }

    fn compute(&self, (fixed, moving): PairKey) -> NoFit {
        let gap = self.gap(fixed, moving);
        let ring = &self.shapes[moving].ring;
        if gap == 0.0 {
            return NoFit::new(&no_fit_polygon(&self.shapes[fixed].ring, ring));
        }
        NoFit::new(&no_fit_polygon(&self.grown(fixed, gap), ring))
    }

    /// A shape's ring with the gap round it.
    fn grown(&self, shape: usize, gap: f64) -> Ring {
        let key = (shape, gap.to_bits());
        let known = self.grown.read().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known.get(&key) {
            return found.clone();
        }
        drop(known);
        let ring = &self.shapes[shape].ring;
        let region = minkowski_sum(ring, &disc(gap));
        let outer = region
            .first()
            .map_or_else(|| ring.clone(), |r| r.outer.clone());
        let made = Arc::new(simplify_outward(&outer, SIMPLIFY));
        let mut known = self.grown.write().unwrap_or_else(PoisonError::into_inner);
        known.entry(key).or_insert(made).clone()
    }
}

impl Shape {
    fn new(index: usize, item: &Item, (turn, mirrored): (f64, bool)) -> Self {
        let pose = Pose {
            grain: item.grain,
            turn,
            mirrored,
            translation: Vec2::zeros(),
        };
        let outline = pose.lay(&item.outline).oriented();
        Self {
            item: index,
            pose,
            bounds: outline.bounds(),
            ring: simplify_outward(&outline.outer, SIMPLIFY),
            outline,
            opposite: None,
        }
    }
}

/// A polygon round a disc of a radius \[m\].
fn disc(radius: f64) -> Vec<Vec2> {
    let step = std::f64::consts::TAU / f64::from(DISC_CORNERS);
    let reach = radius / (step / 2.0).cos();
    (0..DISC_CORNERS)
        .map(|k| {
            let (sin, cos) = (f64::from(k) * step).sin_cos();
            Vec2::new(cos, sin) * reach
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_geometry::{Bounds2, interiors_overlap};

    fn notched() -> Polygon {
        let points = [
            (0.0, 0.0),
            (0.4, 0.0),
            (0.4, 0.3),
            (0.25, 0.1),
            (0.1, 0.3),
            (0.0, 0.2),
        ];
        Polygon::new(points.iter().map(|&(x, y)| Vec2::new(x, y)).collect())
    }

    #[test]
    fn pairs_that_share_one_computation_are_right() {
        let square = Polygon::rectangle(Bounds2 {
            min: Vec2::zeros(),
            max: Vec2::new(0.1, 0.13),
        });
        let items = [Item::new("notched", notched()), Item::new("square", square)];
        let fit = Fit::new(&items, &Strip::of_width(1.0));
        assert_eq!(fit.shapes.len(), 4);
        for a in 0..4 {
            for b in 0..4 {
                let nfp = fit.no_fit(a, b);
                for k in 0..400 {
                    let at = Vec2::new(f64::from(k % 20) - 10.0, f64::from(k / 20) - 10.0) * 0.051;
                    let moved = fit.shapes[b].outline.translated(at);
                    let overlap = interiors_overlap(&fit.shapes[a].outline, &moved);
                    assert_eq!(nfp.forbids(at), overlap, "{a} {b} {at}");
                }
            }
        }
    }

    #[test]
    fn the_gap_is_kept_all_round() {
        let strip = Strip {
            gap: 0.02,
            ..Strip::of_width(1.0)
        };
        let fit = Fit::new(&[Item::new("notched", notched())], &strip);
        let nfp = fit.no_fit(0, 1);
        let fixed = toile_geometry::PreparedPolygon::new(&fit.shapes[0].outline);
        for [at, _] in &nfp.edges {
            let moved =
                toile_geometry::PreparedPolygon::new(&fit.shapes[1].outline.translated(*at));
            let gap = fixed.distance(&moved);
            assert!(gap > 0.02 - 1e-7 && gap < 0.0209, "{gap}");
        }
    }
}
