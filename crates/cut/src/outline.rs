//! The cut line of a piece.
//!
//! # Decided with
//! - [`crate::seams`] (`edges_of`, `corner_of`): widths and kinds of corners;
//! - [`crate::check`], [`toile_geometry::PolygonDefect`], [`crate::ring`]: the seam line checked, and
//!   flattened to chords;
//! - [`crate::allowance::cloth`], [`crate::corner::corner_cloth`], [`crate::dart::caps`]: cloth along edges,
//!   at corners, at the mouths of darts;
//! - [`crate::region::outline_region`], [`crate::region::hole_region`], [`toile_geometry::wound_region`]: all
//!   cloth united;
//! - [`crate::trace::Sides`]: each segment traced to its edge;
//! - [`crate::uncovered::uncovered_findings`]: lengths that got no cut line;
//! - [`crate::finding::Finding`], [`crate::words::cut_diagnostics`]: faults of the cut line and their words.

use crate::allowance::{Cloth, cloth};
use crate::dart::caps;
use crate::region::{Frame, hole_region, outline_region};
use crate::ring::Ring;
use crate::trace::{Sides, Traced};
use crate::uncovered::{covered, uncovered_findings};
use crate::{CutError, CutLine, CutRing, Finding, SeamLine};
use toile_geometry::{CrossingKind, Polygon, Vec2};

/// The cut line of a piece: its seam line with darts capped, grown by the allowance of each edge.
///
/// Curves are flattened to [`crate::FLATNESS`]; corners of the result are accurate to about 4e-9 of the
/// piece's extent. A loop in which no edge has a width is returned as flattened. Corners that the union of
/// the cloth does not move keep their coordinates to the last bit.
///
/// # Errors
/// [`CutError`] for a seam line that bounds no region (open, crossing itself, not finite), for widths below
/// 0, for corner limits out of range, and for darts whose legs do not make a dart.
pub fn cut_line(seam: &SeamLine) -> Result<CutLine, CutError> {
    let rings = seam.rings()?;
    let mut line = CutLine::default();
    for ring in &rings {
        let caps = match ring.number {
            0 => caps(ring, &seam.darts)?,
            _ => Vec::new(),
        };
        for (dart, cap) in caps.iter().enumerate() {
            let fault = cap.fault.map(|fault| Finding::StraightCap { dart, fault });
            line.findings.extend(fault);
        }
        let cloth = cloth(ring, &caps);
        line.findings.extend(cloth.findings.iter().cloned());
        line.add(ring, &cloth);
    }
    Ok(line)
}

impl CutLine {
    fn add(&mut self, ring: &Ring, cloth: &Cloth) {
        let frame = Frame::of(ring, &cloth.chains);
        let sides = Sides::new(&cloth.chains, frame);
        let mut edges = ring.edges.iter().zip(&cloth.is_leg);
        let bare = edges.all(|(edge, &is_leg)| edge.width == 0.0 && !is_leg);
        let rings = match (ring.number, bare) {
            // No allowance and no dart: the outer boundary is the chain of the seam line.
            (_, true) => vec![
                cloth.chains[0]
                    .points
                    .iter()
                    .map(|&p| frame.snap(p))
                    .collect(),
            ],
            (0, false) => outline_region(&cloth.chains, frame),
            (_, false) => hole_region(ring, &cloth.chains, frame),
        };
        let (traced, cut) = traced(ring, &sides, &rings);
        if ring.number == 0 {
            for (k, bay) in cut.iter().enumerate().skip(1) {
                self.findings.push(Finding::BayShut {
                    hole: k - 1,
                    area: toile_geometry::ring_area(&bay.points).abs(),
                });
            }
        } else if cut.len() != 1 {
            self.findings.push(Finding::HoleShut {
                hole: ring.number - 1,
                parts: cut.len(),
            });
        }
        if !cut.is_empty() {
            let covered = covered(ring, &sides, &traced);
            self.findings
                .extend(uncovered_findings(ring, cloth, &covered, &cut));
        }
        let mut cut = cut.into_iter();
        if ring.number == 0 {
            self.outline = cut.next().unwrap_or_default();
        }
        self.holes.extend(cut);
    }
}

/// The rings with their corners moved back from the grid to their original coordinates, and needless corners
/// left out. If the rings then cross, needless corners are kept, and if they still cross, corners stay on the
/// grid. This happens only where two corners lie within a grid step of each other.
fn traced(ring: &Ring, sides: &Sides, rings: &[Vec<Vec2>]) -> (Vec<Traced>, Vec<CutRing>) {
    let attempt = |exact: bool, merged: bool| {
        let traced: Vec<Traced> = rings.iter().map(|r| sides.trace(r, exact)).collect();
        let cut = traced.iter().map(|t| t.ring(ring, sides, merged));
        let cut: Vec<CutRing> = cut.collect();
        (traced, cut)
    };
    for (exact, merged) in [(true, true), (true, false)] {
        let (traced, cut) = attempt(exact, merged);
        if !crosses(&cut) {
            return (traced, cut);
        }
    }
    attempt(false, false)
}

fn crosses(rings: &[CutRing]) -> bool {
    let mut points = rings.iter().map(|ring| ring.points.clone());
    let polygon = Polygon {
        outer: points.next().unwrap_or_default(),
        holes: points.collect(),
    };
    let crossings = polygon.crossings(8);
    crossings
        .iter()
        .any(|found| found.kind != CrossingKind::Touch)
}
