//! Girths and lengths taken from a skin: a tape lies tight, so it follows the convex hull of a
//! section and bridges hollows.

use crate::Part;
use crate::bands::{Bands, Near};
use std::cell::Cell;
use toile_geometry::{TriangleMesh, Vec2, Vec3, closed_length, convex_hull};

/// A skin whose vertices are placed when first needed. The first half of its triangles is the left side, the
/// other half the mirror image.
pub(crate) struct Skinned<'a> {
    triangles: &'a [[u32; 3]],
    parts: &'a [Part],
    placed: Vec<Cell<Vec3>>,
    place: Option<&'a dyn Fn(usize) -> Vec3>,
    /// Index of the triangles by their position on the template, to skip those far away.
    bands: Option<&'a Bands>,
}

impl<'a> Skinned<'a> {
    /// A finished mesh.
    pub(crate) fn finished(mesh: &'a TriangleMesh, parts: &'a [Part]) -> Self {
        Self {
            triangles: &mesh.triangles,
            parts,
            placed: mesh.positions.iter().copied().map(Cell::new).collect(),
            place: None,
            bands: None,
        }
    }

    /// A skin whose vertices are placed on demand.
    pub(crate) fn lazy(
        (template, bands): (&'a TriangleMesh, &'a Bands),
        parts: &'a [Part],
        place: &'a dyn Fn(usize) -> Vec3,
    ) -> Self {
        Self {
            triangles: &template.triangles,
            parts,
            placed: vec![Cell::new(Vec3::repeat(f64::NAN)); bands.vertices()],
            place: Some(place),
            bands: Some(bands),
        }
    }

    /// Position of a vertex (m).
    #[inline]
    pub(crate) fn at(&self, vertex: u32) -> Vec3 {
        let known = self.placed[vertex as usize].get();
        match self.place {
            Some(place) if known.x.is_nan() => self.placed_at(place, vertex as usize),
            _ => known,
        }
    }

    #[cold]
    fn placed_at(&self, place: &dyn Fn(usize) -> Vec3, vertex: usize) -> Vec3 {
        let p = place(vertex);
        self.placed[vertex].set(p);
        p
    }

    /// Segments in which the left half of some parts crosses the plane through a point with a unit normal.
    pub(crate) fn section(
        &self,
        parts: &[Part],
        [origin, normal]: [Vec3; 2],
        near: Option<Near>,
    ) -> Vec<[Vec3; 2]> {
        let half = self.triangles.len() / 2;
        let mut segments = Vec::new();
        let mut cut = |t: usize| {
            if parts.contains(&self.parts[t]) {
                segments.extend(self.cut(t, [origin, normal]));
            }
        };
        match (self.bands, near) {
            (Some(bands), Some(near)) => bands.of(near).for_each(&mut cut),
            _ => (0..half).for_each(cut),
        }
        segments
    }

    /// The segment in which a triangle crosses a plane.
    fn cut(&self, t: usize, [origin, normal]: [Vec3; 2]) -> Option<[Vec3; 2]> {
        let [a, b, c] = self.triangles[t];
        let corners = [self.at(a), self.at(b), self.at(c)];
        let above = |p: &Vec3| (p - origin).dot(&normal);
        let height = [above(&corners[0]), above(&corners[1]), above(&corners[2])];
        let side = height[0] >= 0.0;
        // Most triangles near a tape lie on one side of it.
        if (height[1] >= 0.0) == side && (height[2] >= 0.0) == side {
            return None;
        }
        let mut ends = [Vec3::zeros(); 2];
        let mut count = 0;
        for k in 0..3 {
            let (i, j) = (k, (k + 1) % 3);
            if (height[i] >= 0.0) != (height[j] >= 0.0) && count < 2 {
                let share = height[i] / (height[i] - height[j]);
                ends[count] = corners[i] + (corners[j] - corners[i]) * share;
                count += 1;
            }
        }
        (count == 2).then_some(ends)
    }

    /// Convex hull of a section, in the plane's own coordinates, first axis sideways.
    pub(crate) fn hull(&self, part: Part, plane: [Vec3; 2], near: Option<Near>) -> Vec<Vec2> {
        let [origin, normal] = plane;
        // A section of the trunk can pass through the first rings of the legs.
        let parts: &[Part] = match part {
            Part::Trunk => &[Part::Trunk, Part::LeftLeg],
            // The root of the neck belongs to the trunk.
            Part::Head => &[Part::Head, Part::Trunk],
            _ => &[part],
        };
        let both = matches!(part, Part::Trunk | Part::Head);
        let second = Vec3::x().cross(&normal);
        let second = if second.norm() > 0.1 {
            second.normalize()
        } else {
            Vec3::z()
        };
        let first = normal.cross(&second);
        let mut points = Vec::new();
        for p in self.section(parts, plane, near).into_iter().flatten() {
            let offset = p - origin;
            let q = Vec2::new(offset.dot(&first), offset.dot(&second));
            points.push(q);
            if both {
                points.push(Vec2::new(-q.x, q.y));
            }
        }
        convex_hull(&points)
    }
}

/// Girth of one part by a tight tape in a plane (m); zero if the plane does not meet the part.
pub(crate) fn girth(skinned: &Skinned, part: Part, plane: [Vec3; 2], near: Option<Near>) -> f64 {
    closed_length(&skinned.hull(part, plane, near))
}

/// Length of the part of a closed hull with `side * y >= 0`, without the closing chord (m).
pub(crate) fn half_length(hull: &[Vec2], side: f64) -> f64 {
    let mut sum = 0.0;
    for (k, &a) in hull.iter().enumerate() {
        let b = hull[(k + 1) % hull.len()];
        let (u, v) = (side * a.y, side * b.y);
        let share = match (u >= 0.0, v >= 0.0) {
            (true, true) => 1.0,
            (false, false) => 0.0,
            (true, false) => u / (u - v),
            (false, true) => v / (v - u),
        };
        sum += share * (b - a).norm();
    }
    sum
}

/// Extent of a hull along its two axes (m).
pub(crate) fn extent(hull: &[Vec2]) -> [f64; 2] {
    [0, 1].map(|k| {
        let low = hull.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let high = hull.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        (high - low).max(0.0)
    })
}

/// Breadth of a hull along its first axis at a position on the second (m); `None` beyond its ends.
pub(crate) fn breadth_at(hull: &[Vec2], place: f64) -> Option<f64> {
    let mut ends: Option<[f64; 2]> = None;
    for (k, a) in hull.iter().enumerate() {
        let b = hull[(k + 1) % hull.len()];
        if (a.y >= place) != (b.y >= place) {
            let x = a.x + (b.x - a.x) * ((place - a.y) / (b.y - a.y));
            let [low, high] = ends.unwrap_or([x; 2]);
            ends = Some([low.min(x), high.max(x)]);
        }
    }
    ends.map(|[low, high]| high - low)
}

/// Length of a tight tape from a point over segments of an upright section down to a level, on the side of
/// the unit vector `outward` (m): along the hull of the points between.
pub(crate) fn fall(segments: &[[Vec3; 2]], from: Vec3, level: f64, outward: Vec3) -> Option<f64> {
    let flat = |p: Vec3| Vec2::new(p.y, p.dot(&outward));
    let flat: Vec<[Vec2; 2]> = segments.iter().map(|s| s.map(flat)).collect();
    let end = outermost(&flat, level)?;
    Some(stretched(&flat, end, Vec2::new(from.y, from.dot(&outward))))
}

/// Length of a tape as in [`fall`] that hangs straight down below the outermost point (m).
pub(crate) fn hanging(
    segments: &[[Vec3; 2]],
    from: Vec3,
    level: f64,
    outward: Vec3,
) -> Option<f64> {
    let flat = |p: Vec3| Vec2::new(p.y, p.dot(&outward));
    let flat: Vec<[Vec2; 2]> = segments.iter().map(|s| s.map(flat)).collect();
    let on = outermost(&flat, level)?;
    let between = |p: &&Vec2| p.x > level && p.x < from.y;
    let places = flat.iter().flatten().filter(between).map(|p| p.y);
    let end = Vec2::new(level, places.fold(on.y, f64::max));
    Some(stretched(&flat, end, Vec2::new(from.y, from.dot(&outward))))
}

/// Length along the skin of the front of an upright section between two heights (m).
pub(crate) fn along(segments: &[[Vec3; 2]], [low, high]: [f64; 2]) -> f64 {
    let front = |s: &&[Vec3; 2]| s[0].z + s[1].z > 0.0;
    let length = |[a, b]: &[Vec3; 2]| {
        let [bottom, top] = [a.y.min(b.y), a.y.max(b.y)];
        let within = (top.min(high) - bottom.max(low)).max(0.0);
        // A level segment lies either inside or outside the range.
        let level = if bottom >= low && top <= high {
            1.0
        } else {
            0.0
        };
        let share = if top > bottom {
            within / (top - bottom)
        } else {
            level
        };
        (b - a).norm() * share
    };
    segments.iter().filter(front).map(length).sum()
}

/// The outermost point (position along, outward) of a section at a position along.
pub(crate) fn outermost(segments: &[[Vec2; 2]], along: f64) -> Option<Vec2> {
    segments
        .iter()
        .filter(|[a, b]| (a.x >= along) != (b.x >= along))
        .map(|[a, b]| a + (b - a) * ((along - a.x) / (b.x - a.x)))
        .max_by(|a, b| a.y.total_cmp(&b.y))
}

/// Length of a tight tape from one point to another over a section on its outward side (m). Points are
/// (position along, outward), the first end before the second.
pub(crate) fn stretched(segments: &[[Vec2; 2]], from: Vec2, to: Vec2) -> f64 {
    let between = |p: &&Vec2| p.x > from.x && p.x < to.x;
    let mut points: Vec<Vec2> = segments.iter().flatten().filter(between).copied().collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.push(to);
    let mut chain = vec![from];
    for p in points {
        while chain.len() > 1 {
            let (a, b) = (chain[chain.len() - 2], chain[chain.len() - 1]);
            if (b - a).perp(&(p - b)) >= 0.0 {
                chain.pop();
            } else {
                break;
            }
        }
        chain.push(p);
    }
    chain.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
}

/// A point on an edge of a skin, which moves with the skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OnEdge {
    ends: [u32; 2],
    share: f64,
}

impl OnEdge {
    /// Position of the point on a skin (m).
    pub(crate) fn on(&self, skinned: &Skinned) -> Vec3 {
        let [a, b] = self.ends.map(|v| skinned.at(v));
        a + (b - a) * self.share
    }

    /// Position of the point on a mesh (m).
    pub(crate) fn at(&self, positions: &[Vec3]) -> Vec3 {
        let [a, b] = self.ends.map(|v| positions[v as usize]);
        a + (b - a) * self.share
    }
}

/// The highest point of the left side of the skin at a fixed `x`, above the height `from` (m); points of the
/// head, above `to` (m), are left out.
pub(crate) fn ridge(mesh: &TriangleMesh, x: f64, [from, to]: [f64; 2]) -> Option<OnEdge> {
    let mut best: Option<(f64, OnEdge)> = None;
    for triangle in &mesh.triangles {
        for k in 0..3 {
            let ends = [triangle[k], triangle[(k + 1) % 3]];
            let [a, b] = ends.map(|v| mesh.positions[v as usize]);
            if (a.x >= x) == (b.x >= x) {
                continue;
            }
            let share = (x - a.x) / (b.x - a.x);
            let y = a.y + (b.y - a.y) * share;
            if y >= from && y <= to && best.is_none_or(|(top, _)| y > top) {
                best = Some((y, OnEdge { ends, share }));
            }
        }
    }
    best.map(|(_, point)| point)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tape_falls_straight_over_a_hollow_and_round_a_bulge() {
        let at = |y: f64, z: f64| Vec3::new(0.0, y, z);
        // Down a wall with a hollow: the tape is straight.
        let hollow = [[at(1.0, 0.1), at(0.5, 0.0)], [at(0.5, 0.0), at(-0.5, 0.2)]];
        let straight = fall(&hollow, at(1.0, 0.1), 0.0, Vec3::z()).unwrap();
        assert!((straight - 1.0).abs() < 1e-12, "{straight}");
        // Over a bulge: the tape follows it.
        let bulge = [[at(1.0, 0.1), at(0.5, 0.6)], [at(0.5, 0.6), at(-0.5, -0.4)]];
        let over = fall(&bulge, at(1.0, 0.1), 0.0, Vec3::z()).unwrap();
        assert!((over - 2f64.sqrt()).abs() < 1e-12, "{over}");
        assert!(fall(&bulge, at(1.0, 0.1), -1.0, Vec3::z()).is_none());
        assert!(fall(&bulge, at(1.0, 0.1), 0.0, -Vec3::z()).unwrap() < 1.0 + 1e-12);
    }

    #[test]
    fn a_way_along_the_skin_goes_into_hollows() {
        let at = |y: f64, z: f64| Vec3::new(0.0, y, z);
        let front = [[at(1.0, 0.4), at(0.5, 0.1)], [at(0.5, 0.1), at(-0.5, 0.1)]];
        let back = [[at(1.0, -0.4), at(-1.0, -0.4)]];
        let whole: Vec<[Vec3; 2]> = front.into_iter().chain(back).collect();
        let way = along(&whole, [0.0, 1.0]);
        assert!((way - 0.5 - 0.34f64.sqrt()).abs() < 1e-12, "{way}");
    }

    #[test]
    fn halves_of_a_hull_and_its_extent() {
        let square = [
            Vec2::new(-1.0, -1.0),
            Vec2::new(1.0, -1.0),
            Vec2::new(1.0, 3.0),
            Vec2::new(-1.0, 3.0),
        ];
        assert!((half_length(&square, 1.0) - 8.0).abs() < 1e-12);
        assert!((half_length(&square, -1.0) - 4.0).abs() < 1e-12);
        assert_eq!(extent(&square), [2.0, 4.0]);
        assert_eq!(extent(&[]), [0.0, 0.0]);
        let triangle = [Vec2::zeros(), Vec2::new(2.0, 0.0), Vec2::new(1.0, 4.0)];
        let breadth = breadth_at(&triangle, 1.0).unwrap();
        assert!((breadth - 1.5).abs() < 1e-12, "{breadth}");
        assert_eq!(breadth_at(&triangle, 4.5), None);
    }
}
