//! Checks a seam line, then flattens it to chords.

use crate::ring::Ring;
use crate::{CutError, EdgeIndex, SeamEdge, SeamLine};
use toile_geometry::{Polygon, PolygonDefect};
use toile_pattern::MitreLimit;

/// Largest gap between the ends of two edges that meet (m). It allows for the rounding of formulas and files
/// and is far below what can be cut.
const CLOSED: f64 = 1e-6;

impl SeamLine {
    /// The loops flattened to rings, the outline first, after all checks have passed.
    pub(crate) fn rings(&self) -> Result<Vec<Ring>, CutError> {
        let mut rings = Vec::with_capacity(1 + self.holes.len());
        for ring in 0..=self.holes.len() {
            let edges = self.edges(ring).unwrap_or_default();
            check_edges(edges, ring)?;
            rings.push(Ring::new(edges, ring));
        }
        check_shape(&rings)?;
        self.check_darts(&rings)?;
        Ok(rings)
    }

    fn check_darts(&self, rings: &[Ring]) -> Result<(), CutError> {
        let count = self.outline.len();
        for (k, dart) in self.darts.iter().enumerate() {
            let [before, after] = dart.legs;
            let follow = before < count && after == (before + 1) % count && dart.pressed < 2;
            let taken = self.darts[..k]
                .iter()
                .any(|other| other.legs.iter().any(|leg| dart.legs.contains(leg)));
            let inward = || rings.first().is_some_and(|ring| ring.is_notch(dart.legs));
            if !follow || taken || !inward() {
                return Err(CutError::Dart(k));
            }
        }
        Ok(())
    }
}

fn check_edges(edges: &[SeamEdge], ring: usize) -> Result<(), CutError> {
    for (k, edge) in edges.iter().enumerate() {
        let index = EdgeIndex { ring, edge: k };
        if !edge.curve.is_finite() {
            return Err(CutError::NotFinite(index));
        }
        if !(edge.width >= 0.0 && edge.width.is_finite()) {
            return Err(CutError::Width(index));
        }
        if !(MitreLimit::RANGE[0]..=MitreLimit::RANGE[1]).contains(&edge.limit) {
            return Err(CutError::Limit(index));
        }
        let gap = (edge.curve.end() - edges[(k + 1) % edges.len()].curve.start()).norm();
        if gap > CLOSED {
            return Err(CutError::Open(index, gap));
        }
    }
    Ok(())
}

fn check_shape(rings: &[Ring]) -> Result<(), CutError> {
    let points = |ring: &Ring| ring.chords.iter().map(|chord| chord.from).collect();
    let polygon = Polygon {
        outer: rings.first().map(points).unwrap_or_default(),
        holes: rings.iter().skip(1).map(points).collect(),
    };
    let index = |[ring, point]: [usize; 2]| EdgeIndex {
        ring,
        edge: rings[ring].source_of(point),
    };
    match polygon.defects().first() {
        None => Ok(()),
        Some(PolygonDefect::NotFinite { ring, point }) => {
            Err(CutError::NotFinite(index([*ring, *point])))
        }
        Some(PolygonDefect::TooFewPoints { ring } | PolygonDefect::NoArea { ring }) => {
            Err(CutError::NoArea(*ring))
        }
        Some(PolygonDefect::Crossing(found)) => Err(CutError::Crossing(
            index(found.first),
            index(found.second),
            found.point,
        )),
        Some(PolygonDefect::StrayHole { hole }) => Err(CutError::StrayHole(*hole)),
    }
}
