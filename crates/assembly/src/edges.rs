//! All edges of the sewn pieces in one table, with their lengths and the triangle size that the shape of the
//! outline requires along them.

use crate::AssemblyError;
use toile_geometry::{Curve, Vec2};
use toile_pattern::{Draft, Piece, PieceEdge};

/// Smallest triangle size that the shape of an outline may require, relative to the target edge length.
/// Smaller sizes would follow needle-thin points with ever smaller triangles and time steps.
const MIN_SHAPE_SIZE: f64 = 0.35;
/// A point across the piece counts as near if the path to it along the outline is this many times longer than
/// the straight line: corners wider than about 40 degrees do not count.
const ACROSS: f64 = 2.9;
/// Largest number of probes for which an outline is searched for narrow places; the search takes time
/// proportional to the square of the number.
const MAX_PROBES: usize = 30_000;
/// Turning angle of the outline per sample (rad): at least seven chords per circle.
const TURN: f64 = 0.9;

/// One edge of one piece.
#[derive(Clone, Debug)]
pub(crate) struct Edge {
    /// Index into the draft's pieces.
    pub piece: usize,
    /// Index of the closed loop of the piece: 0 the outline, then the holes.
    pub contour: usize,
    /// Index in the table of the next edge of the loop.
    pub next: usize,
    /// Curve of the edge (m).
    pub curve: Curve,
    /// Arc length of the edge (m).
    pub length: f64,
    /// Triangle size that the shape requires (m), at equal arc-length steps, ends included.
    pub shape_size: Vec<f64>,
}

impl Edge {
    /// The point at an arc-length fraction (m); exact at both ends.
    pub fn point(&self, fraction: f64) -> Vec2 {
        if fraction <= 0.0 {
            self.curve.start()
        } else if fraction >= 1.0 {
            self.curve.end()
        } else {
            self.curve
                .point(self.curve.parameter_at_length(fraction * self.length))
        }
    }

    /// Triangle size that the shape requires at an arc-length fraction (m).
    pub fn size_at(&self, fraction: f64) -> f64 {
        let last = self.shape_size.len() - 1;
        let place = fraction.clamp(0.0, 1.0) * last as f64;
        let low = (place.floor() as usize).min(last.saturating_sub(1));
        let high = (low + 1).min(last);
        let share = place - low as f64;
        self.shape_size[low] * (1.0 - share) + self.shape_size[high] * share
    }
}

/// All edges of the sewn pieces.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeTable {
    /// Edges in the order of the draft: outline first, then each hole.
    pub edges: Vec<Edge>,
    /// Index of the first edge of each piece; pieces that are not sewn have no edges.
    pub first: Vec<usize>,
}

/// The loops of a piece, the outline first.
pub(crate) fn contours(piece: &Piece) -> impl Iterator<Item = &[PieceEdge]> {
    std::iter::once(piece.outline.as_slice()).chain(piece.holes.iter().map(Vec::as_slice))
}

fn outline_error(piece: &Piece, reason: impl Into<String>, remedy: &str) -> AssemblyError {
    AssemblyError::Outline {
        piece: piece.name.clone(),
        reason: reason.into(),
        remedy: remedy.to_owned(),
    }
}

impl EdgeTable {
    /// Measures every edge of the chosen pieces, with the triangle sizes that their shape requires.
    pub fn new(draft: &Draft, chosen: &[bool], spacing: f64) -> Result<Self, AssemblyError> {
        let mut table = Self::measured(draft, chosen)?;
        for piece in 0..draft.pieces.len() {
            let edges = table.of_piece(piece);
            if !edges.is_empty() {
                set_shape_sizes(&mut table.edges[edges], spacing);
            }
        }
        Ok(table)
    }

    /// Measures every edge of the chosen pieces, without triangle sizes.
    pub fn measured(draft: &Draft, chosen: &[bool]) -> Result<Self, AssemblyError> {
        let mut table = Self::default();
        for (index, piece) in draft.pieces.iter().enumerate() {
            table.first.push(table.edges.len());
            if !chosen[index] {
                continue;
            }
            for (contour, edges) in contours(piece).enumerate() {
                table.add_contour(piece, index, contour, edges)?;
            }
        }
        table.first.push(table.edges.len());
        Ok(table)
    }

    fn add_contour(
        &mut self,
        piece: &Piece,
        index: usize,
        contour: usize,
        edges: &[PieceEdge],
    ) -> Result<(), AssemblyError> {
        let start = self.edges.len();
        if edges.is_empty() {
            return Err(outline_error(
                piece,
                "the outline has no edge",
                "draw a closed outline",
            ));
        }
        for (k, edge) in edges.iter().enumerate() {
            if !edge.curve.is_finite() {
                return Err(outline_error(
                    piece,
                    format!("edge {k} has a coordinate that is not a finite number"),
                    "check the formulas behind it",
                ));
            }
            let length = edge.curve.length();
            if !(length > 1e-7 && length < 1e3) {
                return Err(outline_error(
                    piece,
                    format!("edge {k} is {length} m long"),
                    "edges must be longer than 0.1 micrometre and shorter than 1 km",
                ));
            }
            let next = &edges[(k + 1) % edges.len()];
            let gap = (next.curve.start() - edge.curve.end()).norm();
            if gap.is_nan() || gap > 1e-6 {
                return Err(outline_error(
                    piece,
                    format!("edge {k} ends {gap} m from where the next one starts"),
                    "close the outline",
                ));
            }
            self.edges.push(Edge {
                piece: index,
                contour,
                next: start + (k + 1) % edges.len(),
                curve: edge.curve,
                length,
                shape_size: Vec::new(),
            });
        }
        Ok(())
    }

    /// Index range of the edges of a piece.
    pub fn of_piece(&self, piece: usize) -> std::ops::Range<usize> {
        self.first[piece]..self.first[piece + 1]
    }
}

/// A sample point of the boundary of one piece.
struct Probe {
    point: Vec2,
    tangent: Vec2,
    /// Arc length from the start of its loop (m).
    place: f64,
    contour: usize,
    edge: usize,
}

/// Sets the triangle size that each edge of a piece requires, from the radius of curvature and the width of
/// the piece wherever two parts of its outline face each other across cloth.
fn set_shape_sizes(edges: &mut [Edge], spacing: f64) {
    let probes = boundary_probes(edges, spacing);
    let contour_count = edges.iter().map(|e| e.contour + 1).max().unwrap_or(0);
    let mut lengths = vec![0.0; contour_count];
    for edge in edges.iter() {
        lengths[edge.contour] += edge.length;
    }
    let left_is_inside = signed_area(&probes) > 0.0;
    let floor = MIN_SHAPE_SIZE * spacing;
    let mut sizes: Vec<Vec<f64>> = vec![Vec::new(); edges.len()];
    for (k, probe) in probes.iter().enumerate() {
        let inward = if left_is_inside {
            Vec2::new(-probe.tangent.y, probe.tangent.x)
        } else {
            Vec2::new(probe.tangent.y, -probe.tangent.x)
        };
        let mut size = spacing;
        let others = if probes.len() <= MAX_PROBES {
            &probes[..]
        } else {
            &[]
        };
        for other in others {
            let offset = other.point - probe.point;
            let distance = offset.norm();
            if distance >= size || offset.dot(&inward) < 0.3 * distance {
                continue;
            }
            let along = (other.place - probe.place).abs();
            let way = along.min(lengths[probe.contour] - along);
            if other.contour != probe.contour || way > ACROSS * distance {
                size = distance;
            }
        }
        // Curvature from the turning angle between neighbouring probes of the same edge.
        for other in [k.wrapping_sub(1), k + 1] {
            if let Some(near) = probes.get(other).filter(|n| n.edge == probe.edge) {
                let turn = probe.tangent.angle(&near.tangent);
                if turn > 1e-6 {
                    size = size.min(TURN * (near.place - probe.place).abs() / turn);
                }
            }
        }
        sizes[probe.edge].push(size.max(floor));
    }
    for (edge, size) in edges.iter_mut().zip(sizes) {
        edge.shape_size = size;
    }
}

fn boundary_probes(edges: &[Edge], spacing: f64) -> Vec<Probe> {
    let mut probes = Vec::new();
    let (mut contour, mut place) = (0, 0.0);
    for (index, edge) in edges.iter().enumerate() {
        if edge.contour != contour {
            (contour, place) = (edge.contour, 0.0);
        }
        let count = ((2.0 * edge.length / spacing).ceil()).clamp(6.0, 4000.0) as usize;
        let nudge = 1e-6;
        for k in 0..=count {
            let fraction = k as f64 / count as f64;
            let t = edge.curve.parameter_at_length(fraction * edge.length);
            let derivative = edge.curve.derivative(t.clamp(nudge, 1.0 - nudge));
            probes.push(Probe {
                point: edge.point(fraction),
                tangent: derivative.try_normalize(0.0).unwrap_or_else(Vec2::x),
                place: place + fraction * edge.length,
                contour,
                edge: index,
            });
        }
        place += edge.length;
    }
    probes
}

/// Signed area of the outline through the probes (m2).
fn signed_area(probes: &[Probe]) -> f64 {
    let outline: Vec<Vec2> = probes
        .iter()
        .filter(|p| p.contour == 0)
        .map(|p| p.point)
        .collect();
    polygon_area(&outline)
}

/// Signed area of a closed polygon (m2), positive if counter-clockwise.
pub(crate) fn polygon_area(points: &[Vec2]) -> f64 {
    let Some(&origin) = points.first() else {
        return 0.0;
    };
    let twice: f64 = (0..points.len())
        .map(|k| (points[k] - origin).perp(&(points[(k + 1) % points.len()] - origin)))
        .sum();
    0.5 * twice
}
