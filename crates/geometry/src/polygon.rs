//! Polygons with holes: measures, place of a point, transformation.

use crate::{Vec2, orient2d};

/// A region of the plane bounded by one outer ring and any number of holes (m).
///
/// Rings are closed implicitly (the first point is not repeated) and may run either way;
/// [`Polygon::oriented`] gives the standard form. Nothing is checked on construction:
/// see [`Polygon::defects`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    /// The outer ring (m).
    pub outer: Vec<Vec2>,
    /// The rings of the holes (m).
    pub holes: Vec<Vec<Vec2>>,
}

/// A rectangle with sides along the axes (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds2 {
    /// Corner with the least coordinates (m).
    pub min: Vec2,
    /// Corner with the greatest coordinates (m).
    pub max: Vec2,
}

/// Where a point lies with respect to a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// Strictly inside.
    Inside,
    /// On an edge or vertex.
    Boundary,
    /// Strictly outside.
    Outside,
}

impl Bounds2 {
    /// The rectangle that holds nothing; it grows by [`Bounds2::include`].
    pub const EMPTY: Self = Self {
        min: Vec2::new(f64::INFINITY, f64::INFINITY),
        max: Vec2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// The least rectangle that holds all points; [`Bounds2::EMPTY`] of none.
    pub fn of(points: impl IntoIterator<Item = Vec2>) -> Self {
        let mut bounds = Self::EMPTY;
        points.into_iter().for_each(|p| bounds.include(p));
        bounds
    }

    /// Grows to hold a point.
    pub fn include(&mut self, point: Vec2) {
        self.min = self.min.inf(&point);
        self.max = self.max.sup(&point);
    }

    /// The least rectangle that holds both.
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.inf(&other.min),
            max: self.max.sup(&other.max),
        }
    }

    /// Extent along x and y (m).
    pub fn size(&self) -> Vec2 {
        self.max - self.min
    }

    /// The middle (m).
    pub fn centre(&self) -> Vec2 {
        self.min + (self.max - self.min) * 0.5
    }

    /// Whether the closed rectangles share a point.
    pub fn meets(&self, other: &Self) -> bool {
        self.min.x <= other.max.x
            && other.min.x <= self.max.x
            && self.min.y <= other.max.y
            && other.min.y <= self.max.y
    }

    /// Whether the open rectangles share a point.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.x < other.max.x
            && other.min.x < self.max.x
            && self.min.y < other.max.y
            && other.min.y < self.max.y
    }

    /// Whether a point lies in the closed rectangle.
    pub fn contains(&self, point: Vec2) -> bool {
        point.x >= self.min.x
            && point.x <= self.max.x
            && point.y >= self.min.y
            && point.y <= self.max.y
    }

    /// Distance between the rectangles (m), 0 where they meet.
    pub fn distance(&self, other: &Self) -> f64 {
        let gap = (other.min - self.max).sup(&(self.min - other.max));
        gap.sup(&Vec2::zeros()).norm()
    }

    /// The same rectangle moved (m).
    pub fn translated(&self, by: Vec2) -> Self {
        Self {
            min: self.min + by,
            max: self.max + by,
        }
    }

    /// The same rectangle grown by a margin on every side (m).
    pub fn grown(&self, margin: f64) -> Self {
        let margin = Vec2::new(margin, margin);
        Self {
            min: self.min - margin,
            max: self.max + margin,
        }
    }
}

/// Signed area of a ring (m2), positive when it runs counter-clockwise.
pub fn ring_area(ring: &[Vec2]) -> f64 {
    let Some(&origin) = ring.first() else {
        return 0.0;
    };
    let mut twice = 0.0;
    for pair in ring.windows(2).skip(1) {
        twice += (pair[0] - origin).perp(&(pair[1] - origin));
    }
    twice * 0.5
}

/// A ring without points that repeat the one before them.
pub(crate) fn without_repeats(ring: &[Vec2]) -> Vec<Vec2> {
    let mut clean: Vec<Vec2> = Vec::with_capacity(ring.len());
    for &p in ring {
        if clean.last() != Some(&p) {
            clean.push(p);
        }
    }
    while clean.len() > 1 && clean.first() == clean.last() {
        clean.pop();
    }
    clean
}

/// The edges of a closed ring, each from one point to the next.
pub(crate) fn ring_edges(ring: &[Vec2]) -> impl Iterator<Item = [Vec2; 2]> + '_ {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(&a, &b)| [a, b])
}

impl Polygon {
    /// A region without holes.
    pub fn new(outer: Vec<Vec2>) -> Self {
        Self {
            outer,
            holes: Vec::new(),
        }
    }

    /// A rectangle with sides along the axes.
    pub fn rectangle(bounds: Bounds2) -> Self {
        let Bounds2 { min, max } = bounds;
        Self::new(vec![
            min,
            Vec2::new(max.x, min.y),
            max,
            Vec2::new(min.x, max.y),
        ])
    }

    /// All rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<Vec2>> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// All edges of all rings.
    pub fn edges(&self) -> impl Iterator<Item = [Vec2; 2]> + '_ {
        self.rings().flat_map(|ring| ring_edges(ring))
    }

    /// Area of the outer ring less the holes (m2), whichever way the rings run.
    pub fn area(&self) -> f64 {
        let holes: f64 = self.holes.iter().map(|h| ring_area(h).abs()).sum();
        ring_area(&self.outer).abs() - holes
    }

    /// Length of all edges (m).
    pub fn perimeter(&self) -> f64 {
        self.edges().map(|[a, b]| (b - a).norm()).sum()
    }

    /// The least rectangle that holds the outer ring; [`Bounds2::EMPTY`] of an empty polygon.
    pub fn bounds(&self) -> Bounds2 {
        Bounds2::of(self.outer.iter().copied())
    }

    /// Whether all coordinates are finite.
    pub fn is_finite(&self) -> bool {
        self.rings()
            .flatten()
            .all(|p| p.x.is_finite() && p.y.is_finite())
    }

    /// The standard form: outer ring counter-clockwise, holes clockwise (so that the region is
    /// always at the left of an edge), repeated points and rings of less than three points gone.
    pub fn oriented(&self) -> Self {
        let turned = |ring: &Vec<Vec2>, sign: f64| {
            let mut ring = without_repeats(ring);
            if ring_area(&ring) * sign < 0.0 {
                ring.reverse();
            }
            ring
        };
        Self {
            outer: turned(&self.outer, 1.0),
            holes: self
                .holes
                .iter()
                .map(|h| turned(h, -1.0))
                .filter(|h| h.len() > 2)
                .collect(),
        }
    }

    /// The polygon with every point moved by a function.
    pub fn mapped(&self, map: impl Fn(Vec2) -> Vec2) -> Self {
        let ring = |r: &Vec<Vec2>| r.iter().map(|&p| map(p)).collect();
        Self {
            outer: ring(&self.outer),
            holes: self.holes.iter().map(ring).collect(),
        }
    }

    /// The polygon moved (m).
    pub fn translated(&self, by: Vec2) -> Self {
        self.mapped(|p| p + by)
    }

    /// The polygon turned about the origin by an angle (rad), counter-clockwise.
    pub fn rotated(&self, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        self.mapped(|p| Vec2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y))
    }

    /// Where a point lies, by the even-odd rule. Sign exact: an edge counts as boundary only if
    /// the point lies on it exactly.
    pub fn locate(&self, point: Vec2) -> Location {
        let mut inside = false;
        for [a, b] in self.edges() {
            match crosses_ray(a, b, point) {
                RayHit::On => return Location::Boundary,
                RayHit::Crossed => inside = !inside,
                RayHit::Missed => {}
            }
        }
        if inside {
            Location::Inside
        } else {
            Location::Outside
        }
    }

    /// Whether a point lies inside or on the boundary. Exact.
    pub fn contains(&self, point: Vec2) -> bool {
        self.locate(point) != Location::Outside
    }

    /// Whether the region is convex: no holes and no right turn. Exact; collinear points allowed.
    pub fn is_convex(&self) -> bool {
        let ring = &self.oriented().outer;
        let n = ring.len();
        if n < 3 || !self.holes.is_empty() {
            return false;
        }
        let left = (0..n).all(|k| orient2d(ring[k], ring[(k + 1) % n], ring[(k + 2) % n]) >= 0.0);
        // A star winds several times with left turns only: its edges change from falling to
        // rising more than once.
        let rising = |k: usize| {
            let d = ring[(k + 1) % n] - ring[k];
            d.y > 0.0 || (d.y == 0.0 && d.x > 0.0)
        };
        let starts = (0..n).filter(|&k| rising(k) && !rising((k + n - 1) % n));
        left && starts.count() == 1
    }
}

/// What an edge does to the ray from a point towards +x.
pub(crate) enum RayHit {
    /// The point lies on the edge.
    On,
    /// The ray crosses it.
    Crossed,
    /// Neither.
    Missed,
}

/// Exact; an edge holds its lower end and not its upper one, so that rays through vertices count
/// right.
pub(crate) fn crosses_ray(a: Vec2, b: Vec2, point: Vec2) -> RayHit {
    if (a.y > point.y && b.y > point.y)
        || (a.y < point.y && b.y < point.y)
        || (a.x < point.x && b.x < point.x)
    {
        return RayHit::Missed;
    }
    let side = orient2d(a, b, point);
    if side == 0.0 && Bounds2::of([a, b]).contains(point) {
        return RayHit::On;
    }
    let upward = a.y <= point.y && point.y < b.y;
    let downward = b.y <= point.y && point.y < a.y;
    if (upward && side > 0.0) || (downward && side < 0.0) {
        RayHit::Crossed
    } else {
        RayHit::Missed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<Vec2> {
        points.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
    }

    fn frame() -> Polygon {
        Polygon {
            outer: ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]),
            holes: vec![ring(&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)])],
        }
    }

    #[test]
    fn measures_of_a_frame() {
        let frame = frame();
        assert_eq!(frame.area(), 11.0);
        assert_eq!(frame.perimeter(), 18.0);
        assert_eq!(frame.bounds().size(), Vec2::new(4.0, 3.0));
        let standard = frame.oriented();
        assert!(ring_area(&standard.outer) > 0.0 && ring_area(&standard.holes[0]) < 0.0);
        assert!(!frame.is_convex());
        assert!((frame.rotated(0.3).area() - 11.0).abs() < 1e-12);
        assert_eq!(Polygon::default().area(), 0.0);
    }

    #[test]
    fn points_are_located_exactly() {
        let frame = frame();
        for (x, y, want) in [
            (0.5, 0.5, Location::Inside),
            (1.5, 1.5, Location::Outside),
            (1.0, 1.5, Location::Boundary),
            (4.0, 3.0, Location::Boundary),
            (4.0 + 1e-15, 3.0, Location::Outside),
            (-1.0, 0.0, Location::Outside),
            (-1.0, 3.0, Location::Outside),
            (5.0, 1.0, Location::Outside),
        ] {
            assert_eq!(frame.locate(Vec2::new(x, y)), want, "({x}, {y})");
        }
        assert!(!frame.contains(Vec2::new(f64::NAN, 0.0)));
    }

    #[test]
    fn convexity_is_not_fooled_by_stars_or_collinear_points() {
        let square = ring(&[(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert!(Polygon::new(square).is_convex());
        let star = (0..5)
            .map(|k| {
                let angle = 4.0 * std::f64::consts::PI * f64::from(k) / 5.0;
                Vec2::new(angle.cos(), angle.sin())
            })
            .collect();
        assert!(!Polygon::new(star).is_convex());
    }
}
