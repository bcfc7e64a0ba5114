//! Intersection, union, difference and offset of polygons, through `geo`.
//!
//! `geo` snaps coordinates to an integer grid of 2^30 steps over the extent of both operands
//! (Martinez, Rueda and Feito 2009 in a sweep over integers), so a result is right to about
//! 4e-9 of the larger extent. Operands are recentred on their shared box first, so that a pattern
//! drawn far from the origin loses nothing. Operands with a coordinate that is not finite are
//! treated as empty.

use crate::{Bounds2, Polygon, Vec2};
use geo::algorithm::bool_ops::{BooleanOps, FillRule, OpType};
use geo::algorithm::buffer::{Buffer, BufferStyle, LineJoin};
use geo::{Coord, LineString, MultiPolygon};

/// How an offset outline turns a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Corner {
    /// The edges run on until they meet, cut square where the corner is sharper than `limit` (rad).
    Mitre {
        /// Least angle between the edges that is still mitred (rad).
        limit: f64,
    },
    /// An arc of chords no longer than this fraction of the distance.
    Round {
        /// Length of a chord over the offset distance.
        step: f64,
    },
    /// Cut straight across.
    Bevel,
}

fn ring_out(ring: &[Vec2], origin: Vec2) -> LineString<f64> {
    let coord = |p: &Vec2| Coord {
        x: p.x - origin.x,
        y: p.y - origin.y,
    };
    let mut coords: Vec<Coord<f64>> = ring.iter().map(coord).collect();
    if let Some(&first) = coords.first() {
        coords.push(first);
    }
    LineString(coords)
}

fn polygon_out(polygon: &Polygon, origin: Vec2) -> geo::Polygon<f64> {
    let standard = polygon.oriented();
    let holes = standard.holes.iter().map(|h| ring_out(h, origin)).collect();
    geo::Polygon::new(ring_out(&standard.outer, origin), holes)
}

fn back(result: MultiPolygon<f64>, origin: Vec2) -> Vec<Polygon> {
    let ring = |line: &LineString<f64>| {
        let end = line.0.len().saturating_sub(1);
        let points = line.0[..end].iter();
        points.map(|c| Vec2::new(c.x, c.y) + origin).collect()
    };
    let polygon = |p: &geo::Polygon<f64>| Polygon {
        outer: ring(p.exterior()),
        holes: p.interiors().iter().map(ring).collect(),
    };
    let all = result.0.iter().map(polygon);
    all.filter(|p: &Polygon| p.outer.len() > 2).collect()
}

fn usable(polygon: &Polygon) -> bool {
    polygon.outer.len() > 2 && polygon.is_finite()
}

fn combine(a: &Polygon, b: &Polygon, operation: OpType) -> Vec<Polygon> {
    let origin = a.bounds().union(&b.bounds()).centre();
    let (a, b) = (polygon_out(a, origin), polygon_out(b, origin));
    back(
        a.boolean_op_with_fill_rule(&b, operation, FillRule::NonZero),
        origin,
    )
}

/// The region in both polygons: outer rings counter-clockwise, holes clockwise. Polygons that only
/// touch give nothing, or slivers no wider than the grid.
pub fn intersection(a: &Polygon, b: &Polygon) -> Vec<Polygon> {
    if !usable(a) || !usable(b) || !a.bounds().overlaps(&b.bounds()) {
        return Vec::new();
    }
    combine(a, b, OpType::Intersection)
}

/// The region in either polygon.
pub fn union(a: &Polygon, b: &Polygon) -> Vec<Polygon> {
    match (usable(a), usable(b)) {
        (true, true) => combine(a, b, OpType::Union),
        (true, false) => vec![a.oriented()],
        (false, true) => vec![b.oriented()],
        (false, false) => Vec::new(),
    }
}

/// The region in the first polygon and not in the second.
pub fn difference(a: &Polygon, b: &Polygon) -> Vec<Polygon> {
    match (usable(a), usable(b)) {
        (true, true) => combine(a, b, OpType::Difference),
        (true, false) => vec![a.oriented()],
        _ => Vec::new(),
    }
}

/// The region around which closed loops wind at least once, in either direction (the non-zero
/// rule): cleans an outline that crosses itself, or joins many at once.
pub fn wound_region(loops: &[Vec<Vec2>]) -> Vec<Polygon> {
    let finite = |p: &Vec2| p.x.is_finite() && p.y.is_finite();
    if !loops.iter().flatten().all(finite) {
        return Vec::new();
    }
    let origin = Bounds2::of(loops.iter().flatten().copied()).centre();
    let rings = loops.iter().filter(|l| l.len() > 2);
    let all: Vec<geo::Polygon<f64>> = rings
        .map(|l| geo::Polygon::new(ring_out(l, origin), Vec::new()))
        .collect();
    if all.is_empty() {
        return Vec::new();
    }
    let nothing = MultiPolygon::new(Vec::new());
    back(
        MultiPolygon(all).boolean_op_with_fill_rule(&nothing, OpType::Union, FillRule::NonZero),
        origin,
    )
}

/// The polygon grown by a distance (m), or shrunk by a negative one; it may fall into several or
/// into none.
pub fn offset(polygon: &Polygon, distance: f64, corner: Corner) -> Vec<Polygon> {
    if !usable(polygon) || !distance.is_finite() {
        return Vec::new();
    }
    if distance == 0.0 {
        return vec![polygon.oriented()];
    }
    let join = match corner {
        Corner::Mitre { limit } => LineJoin::Miter(limit),
        Corner::Round { step } => LineJoin::Round(step),
        Corner::Bevel => LineJoin::Bevel,
    };
    let origin = polygon.bounds().centre();
    let style = BufferStyle::new(distance).line_join(join);
    back(
        polygon_out(polygon, origin).buffer_with_style(style),
        origin,
    )
}

/// Total area (m2).
pub fn total_area(polygons: &[Polygon]) -> f64 {
    polygons.iter().map(Polygon::area).sum()
}
