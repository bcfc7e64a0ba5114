//! A quick check, for pieces moved by hand: which overlap, and which reach beyond the fabric.

use crate::referee::sides;
use crate::violation::beyond_limit;
use crate::{Item, Marker, PENETRATION_LIMIT, Side, Strip};
use toile_geometry::{Polygon, PreparedPolygon, intersection, total_area};

/// Pieces that cannot be cut where they lie, with length and efficiency of the marker. Placements are named by
/// their index in the marker.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clashes {
    /// Pairs of pieces that overlap.
    pub overlaps: Vec<Overlap>,
    /// Pieces that reach beyond the usable fabric.
    pub outside: Vec<Outside>,
    /// Fabric used, end margins included (m).
    pub length: f64,
    /// Area of the pieces over width times length between the end margins, 0..=1; more where they
    /// overlap.
    pub efficiency: f64,
    /// Area of the pieces over width times length, 0..=1; more where they overlap.
    pub utilisation: f64,
}

/// Two pieces that overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlap {
    /// The placements, the lower index first.
    pub pair: [usize; 2],
    /// Where they overlap, in the plane of the fabric (m).
    pub region: Vec<Polygon>,
}

/// A piece that reaches beyond the usable fabric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outside {
    /// The placement.
    pub placement: usize,
    /// The edge of the fabric that it crosses.
    pub side: Side,
    /// By how much (m).
    pub by: f64,
}

impl Clashes {
    /// Whether all lies on the fabric and apart.
    pub fn is_empty(&self) -> bool {
        self.overlaps.is_empty() && self.outside.is_empty()
    }
}

/// Whether two outlines that share a region lie deeper in each other than the limit. A move d that
/// parts them sweeps the whole region with the boundary of either, so area <= d * perimeter: where
/// the area is larger the costly depth need not be known.
fn is_deep([a, b]: [&PreparedPolygon; 2], region: &[Polygon]) -> bool {
    let perimeter = a.polygon().perimeter().min(b.polygon().perimeter());
    total_area(region) > 2.0 * PENETRATION_LIMIT * perimeter
        || a.penetration_depth(b) > PENETRATION_LIMIT
}

/// Overlapping pairs and pieces off the fabric, by the referee's limits and exact predicates.
/// Gaps, orientations, print and flaws are not looked at. Placements that name no item, or whose
/// place is not finite, are passed over. Costs a sweep along the warp, an exact test for each
/// pair whose boxes meet, and what each overlapping pair shares.
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
