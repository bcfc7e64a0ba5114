//! A quick check for pieces moved by hand: finds overlaps and pieces beyond the fabric.

use crate::referee::sides;
use crate::violation::beyond_limit;
use crate::{Item, Marker, PENETRATION_LIMIT, Side, Strip};
use toile_geometry::{Polygon, PreparedPolygon, intersection, total_area};

/// Pieces that cannot be cut in their positions, with length and efficiency of the marker. Placements are
/// given by their index in the marker.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clashes {
    /// Pairs of pieces that overlap.
    pub overlaps: Vec<Overlap>,
    /// Pieces that extend beyond the usable fabric.
    pub outside: Vec<Outside>,
    /// Length of fabric used, end margins included (m).
    pub length: f64,
    /// Area of the pieces divided by width times length between the end margins (1); over 1 where pieces
    /// overlap.
    pub efficiency: f64,
    /// Area of the pieces divided by width times length (1); over 1 where pieces overlap.
    pub utilisation: f64,
}

/// Two pieces that overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlap {
    /// The placements, the lower index first.
    pub pair: [usize; 2],
    /// Region of the overlap, in the plane of the fabric (m).
    pub region: Vec<Polygon>,
}

/// A piece that extends beyond the usable fabric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outside {
    /// The placement.
    pub placement: usize,
    /// The edge of the fabric that it crosses.
    pub side: Side,
    /// Distance by which the piece extends beyond (m).
    pub by: f64,
}

impl Clashes {
    /// Whether there are no overlaps and no pieces beyond the fabric.
    pub fn is_empty(&self) -> bool {
        self.overlaps.is_empty() && self.outside.is_empty()
    }
}

/// Whether two overlapping outlines penetrate each other deeper than the limit. A translation d that
/// separates them sweeps the whole region with the boundary of either, so area <= d * perimeter: if the area
/// is larger, the costly penetration depth is not needed.
fn is_deep([a, b]: [&PreparedPolygon; 2], region: &[Polygon]) -> bool {
    let perimeter = a.polygon().perimeter().min(b.polygon().perimeter());
    total_area(region) > 2.0 * PENETRATION_LIMIT * perimeter
        || a.penetration_depth(b) > PENETRATION_LIMIT
}

/// Overlapping pairs and pieces beyond the fabric, by the referee's limits and exact predicates. Gaps,
/// orientations, print and flaws are not checked. Placements of unknown items or without finite position are
/// skipped. Cost: a sweep along the warp, an exact test for each pair with overlapping boxes, and the
/// intersection of each overlapping pair.
pub fn clashes(items: &[Item], strip: &Strip, marker: &Marker) -> Clashes {
    let mut measured = marker.clone();
    measured.measure(items, strip);
    let mut found = Clashes {
        length: measured.length,
        efficiency: measured.efficiency,
        utilisation: measured.utilisation,
        ..Clashes::default()
    };
    let mut laid: Vec<(usize, PreparedPolygon)> = Vec::new();
    for (k, placement) in marker.placements.iter().enumerate() {
        let at = placement.translation;
        let finite = [at.x, at.y, placement.turn].iter().all(|x| x.is_finite());
        if let Some(item) = items.get(placement.item).filter(|_| finite) {
            let outline = placement.pose(item).lay(&item.outline);
            laid.push((k, PreparedPolygon::new(&outline)));
        }
    }
    for (k, outline) in &laid {
        for (side, by) in sides(strip, outline.bounds()) {
            if beyond_limit(by) {
                found.outside.push(Outside {
                    placement: *k,
                    side,
                    by,
                });
            }
        }
    }
    let start = |n: &(usize, PreparedPolygon)| n.1.bounds().min.x;
    laid.sort_by(|a, b| start(a).total_cmp(&start(b)));
    for (n, (k, one)) in laid.iter().enumerate() {
        let end = one.bounds().max.x;
        for (other, outline) in laid[n + 1..].iter().take_while(|o| start(o) < end) {
            if !one.bounds().overlaps(&outline.bounds()) || !one.overlaps(outline) {
                continue;
            }
            let region = intersection(one.polygon(), outline.polygon());
            if is_deep([one, outline], &region) {
                found.overlaps.push(Overlap {
                    pair: [*k.min(other), *k.max(other)],
                    region,
                });
            }
        }
    }
    found.overlaps.sort_by_key(|overlap| overlap.pair);
    found
}
