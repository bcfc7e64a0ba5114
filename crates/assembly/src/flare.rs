//! Flared pieces: rings and sectors of rings, from which circle skirts are cut. Before they are laid out they
//! are unrolled about the circle of their inner edge, so that they hang from it.

use crate::flat_pieces::{FlatPiece, Tie};
use crate::mesh::{PieceMesh, PieceMeshes};
use crate::role::Role;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toile_geometry::Vec2;
use toile_pattern::{BodyPart, Draft, Facing};

/// Smallest angle of a sector that is unrolled (rad): pieces with flatter waist edges are wrapped as they
/// are.
const MIN_TURN: f64 = 0.6;
/// Largest deviation of an inner edge from its circle, relative to the radius.
const OFF_CIRCLE: f64 = 0.08;
/// Largest angle by which cloth may reach over the sides of a sector (rad).
const OVER_SIDE: f64 = 0.12;
/// Neighbouring edges with directions that differ by less than this form one arc (rad).
const SMOOTH: f64 = 0.35;
/// Smallest length of an inner edge that is sewn to nothing, relative to the waist girth.
const ROUND_WAIST: f64 = 0.7;

/// The inner edge of a ring or of a sector of a ring.
#[derive(Clone, Debug)]
struct InnerEdge {
    centre: Vec2,
    radius: f64,
    /// Direction of the middle of the edge, and the angle that it spans (rad).
    middle: f64,
    turn: f64,
    /// Indices of the piece's edges that form it.
    edges: Vec<usize>,
}

/// Data for finding flared pieces.
pub(crate) struct Pieces<'a> {
    pub draft: &'a Draft,
    pub meshes: &'a PieceMeshes,
    /// Waist girth of the body (m).
    pub waist: f64,
}

/// Unrolls every flared piece that hangs on the trunk. Rings that are sewn to pieces round the trunk go round
/// it as well, even if the document lays a single ring over the body.
pub(crate) fn unroll_flares(pieces: &Pieces, laid: &mut [FlatPiece], roles: &mut [Role]) {
    let found: Vec<Option<InnerEdge>> = (0..laid.len())
        .map(|k| match roles[k] {
            Role::Wrapped {
                part: BodyPart::Trunk,
                ..
            } => inner_edge(&pieces.meshes.pieces[k], &laid[k]),
            _ => None,
        })
        .collect();
    let held: Vec<bool> = (0..laid.len())
        .map(|k| pieces.hangs(k, &found, (laid, roles)))
        .collect();
    for (k, inner) in found.into_iter().enumerate() {
        let Some(inner) = inner.filter(|_| held[k]) else {
            continue;
        };
        if let Role::Wrapped { facing, .. } = &mut roles[k]
            && *facing == Facing::Over
        {
            *facing = Facing::Around;
        }
        unroll(&mut laid[k], &inner);
    }
}

impl Pieces<'_> {
    /// Pieces that an edge of a piece is sewn to: indices of the meshed pieces, with their edges.
    fn partners(&self, k: usize, edge: usize) -> Vec<(usize, usize)> {
        let piece = self.meshes.pieces[k].draft_piece;
        let mut partners = Vec::new();
        for seam in &self.draft.seams {
            for side in [0, 1] {
                let mut here = seam.sides[side].iter();
                if here.any(|span| span.piece == piece && span.edge == edge) {
                    let there = seam.sides[1 - side].iter().filter_map(|span| {
                        let mut meshed = self.meshes.pieces.iter();
                        let other = meshed.position(|m| m.draft_piece == span.piece)?;
                        Some((other, span.edge))
                    });
                    partners.extend(there);
                }
            }
        }
        partners
    }

    /// Whether a piece hangs from its inner edge. The inner edge must be sewn to pieces round the trunk, or
    /// go round the waist by itself; the outer edge may only be sewn to the inner edge of another flared
    /// piece.
    fn hangs(
        &self,
        k: usize,
        found: &[Option<InnerEdge>],
        (laid, roles): (&[FlatPiece], &[Role]),
    ) -> bool {
        let Some(inner) = &found[k] else {
            return false;
        };
        let on_trunk = |other: usize| {
            matches!(roles[other], Role::Wrapped { part, facing, .. }
                if part == BodyPart::Trunk && facing != Facing::Over)
        };
        let above: Vec<usize> = inner
            .edges
            .iter()
            .flat_map(|&edge| self.partners(k, edge))
            .map(|partner| partner.0)
            .collect();
        let mesh = &self.meshes.pieces[k];
        let outer_is_free = (0..mesh.edge_vertices.len())
            .filter(|edge| {
                !inner.edges.contains(edge) && !inner.is_side(&points_of(mesh, &laid[k], &[*edge]))
            })
            .flat_map(|edge| self.partners(k, edge))
            .all(|(other, edge)| {
                let flared = found[other].as_ref();
                flared.is_some_and(|inner| inner.edges.contains(&edge))
            });
        outer_is_free
            && match above.is_empty() {
                true => {
                    let round = found.iter().flatten().map(|i| i.radius * i.turn);
                    let is_ring = inner.turn >= TAU;
                    !is_ring && round.sum::<f64>() >= ROUND_WAIST * self.waist
                }
                false => above.iter().all(|&other| other != k && on_trunk(other)),
            }
    }
}

impl InnerEdge {
    /// Angle of a point from the middle (rad) and distance from the centre (m). The coordinates are those of
    /// the flat piece, seen from its right side.
    fn polar(&self, p: Vec2) -> [f64; 2] {
        let d = p - self.centre;
        let turn = (d.y.atan2(d.x) - self.middle + PI).rem_euclid(TAU) - PI;
        [turn, d.norm()]
    }

    /// Whether an edge of the piece runs along a side of the sector.
    fn is_side(&self, points: &[Vec2]) -> bool {
        let along = |p: &Vec2| (self.polar(*p)[0].abs() - 0.5 * self.turn).abs() < OVER_SIDE;
        self.turn < TAU && points.iter().all(along)
    }
}

/// The inner edge of a piece that is a ring or a sector of a ring; `None` for other pieces.
fn inner_edge(mesh: &PieceMesh, laid: &FlatPiece) -> Option<InnerEdge> {
    let outline = outline_edges(mesh);
    let holes: Vec<usize> = (outline..mesh.edge_vertices.len()).collect();
    if mesh.loops.len() == 2 {
        return ring(mesh, laid, holes);
    }
    let arcs = smooth_chains(mesh, laid, outline);
    let mut found = arcs
        .into_iter()
        .filter_map(|edges| sector(mesh, laid, edges));
    found.next()
}

/// Number of edges of a mesh that belong to its outline; they come first.
fn outline_edges(mesh: &PieceMesh) -> usize {
    let own = &mesh.loops[0];
    let of_outline = |vertices: &Vec<u32>| vertices.iter().all(|v| own.contains(v));
    mesh.edge_vertices
        .iter()
        .take_while(|e| of_outline(e))
        .count()
}

fn ring(mesh: &PieceMesh, laid: &FlatPiece, edges: Vec<usize>) -> Option<InnerEdge> {
    let points = points_of(mesh, laid, &edges);
    let (centre, radius) = circle(&points)?;
    Some(InnerEdge {
        centre,
        radius,
        // The side drawn lowest is worn in front.
        middle: -FRAC_PI_2,
        turn: TAU,
        edges,
    })
}

fn sector(mesh: &PieceMesh, laid: &FlatPiece, edges: Vec<usize>) -> Option<InnerEdge> {
    let points = points_of(mesh, laid, &edges);
    let (centre, radius) = circle(&points)?;
    let mut turn = 0.0;
    for pair in points.windows(2) {
        let [a, b] = [pair[0] - centre, pair[1] - centre];
        turn += a.perp(&b).atan2(a.dot(&b));
    }
    let first = points.first()? - centre;
    let inner = InnerEdge {
        centre,
        radius,
        middle: first.y.atan2(first.x) + 0.5 * turn,
        turn: turn.abs(),
        edges,
    };
    let is_inside = laid.points.iter().all(|&p| {
        let [angle, distance] = inner.polar(p);
        distance >= (1.0 - OFF_CIRCLE) * radius && angle.abs() <= 0.5 * inner.turn + OVER_SIDE
    });
    (inner.turn >= MIN_TURN && is_inside).then_some(inner)
}

/// Points along edges of the flat piece, in the order of its outline.
fn points_of(mesh: &PieceMesh, laid: &FlatPiece, edges: &[usize]) -> Vec<Vec2> {
    let vertices = edges.iter().flat_map(|&e| &mesh.edge_vertices[e]);
    vertices.map(|&v| laid.points[v as usize]).collect()
}

/// Sequences of outline edges without corners between them, in the order of the outline.
fn smooth_chains(mesh: &PieceMesh, laid: &FlatPiece, outline: usize) -> Vec<Vec<usize>> {
    let directions = |edge: usize| {
        let points = points_of(mesh, laid, &[edge]);
        let n = points.len();
        (n >= 2).then(|| [points[1] - points[0], points[n - 1] - points[n - 2]])
    };
    let joins = |a: usize, b: usize| match (directions(a), directions(b)) {
        (Some([_, end]), Some([start, _])) => {
            end.perp(&start).atan2(end.dot(&start)).abs() < SMOOTH
        }
        _ => false,
    };
    let Some(first) = (0..outline).find(|&e| !joins((e + outline - 1) % outline, e)) else {
        return Vec::new();
    };
    let mut chains: Vec<Vec<usize>> = Vec::new();
    for k in 0..outline {
        let edge = (first + k) % outline;
        match chains.last_mut() {
            Some(chain) if chain.last().is_some_and(|&last| joins(last, edge)) => chain.push(edge),
            _ => chains.push(vec![edge]),
        }
    }
    chains
}

/// Centre and radius of the circle that fits points (Kasa 1976); `None` if they do not lie near it.
fn circle(points: &[Vec2]) -> Option<(Vec2, f64)> {
    let count = points.len() as f64;
    if points.len() < 3 {
        return None;
    }
    let mean = points.iter().sum::<Vec2>() / count;
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    let mut right = Vec2::zeros();
    for p in points {
        let d = p - mean;
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
        right += d * d.norm_squared();
    }
    let determinant = xx * yy - xy * xy;
    if determinant <= 1e-9 * (xx + yy) * (xx + yy) {
        return None;
    }
    let offset =
        Vec2::new(yy * right.x - xy * right.y, xx * right.y - xy * right.x) * (0.5 / determinant);
    let radius = (offset.norm_squared() + (xx + yy) / count).sqrt();
    let centre = mean + offset;
    let is_near = |p: &Vec2| ((p - centre).norm() - radius).abs() <= OFF_CIRCLE * radius;
    points.iter().all(is_near).then_some((centre, radius))
}

/// Unrolls a piece: the first coordinate is the arc length along its inner edge, the second is measured from
/// there.
fn unroll(laid: &mut FlatPiece, inner: &InnerEdge) {
    for p in &mut laid.points {
        let [turn, distance] = inner.polar(*p);
        *p = Vec2::new(inner.radius * turn, inner.radius - distance);
    }
    let half = 0.5 * inner.radius * inner.turn;
    let depth = laid.points.iter().map(|p| p.y).fold(0.0, f64::min);
    laid.low = Vec2::new(-half, depth);
    laid.high = Vec2::new(half, 0.0);
    laid.turn = inner.turn;
}

/// Turns a flared piece to its wrong side if the seam along its inner edge requires it: walked along the
/// seam, both sides must go round the body in the same direction.
pub(crate) fn turn_as_sewn(laid: &mut [FlatPiece], ties: &mut [Tie]) {
    for k in 0..laid.len() {
        if laid[k].turn == 0.0 {
            continue;
        }
        // The sign of the majority suffices: all steps from stitch to stitch go the same way, except one at
        // the end of the seam.
        let mut together = 0.0;
        for pair in ties.windows(2) {
            for (own, other) in [(0, 1), (1, 0)] {
                let pieces = pair[0].pieces;
                if pieces == pair[1].pieces && pieces[own] == k && laid[pieces[other]].turn == 0.0 {
                    let [here, there] = [own, other].map(|s| pair[1].points[s] - pair[0].points[s]);
                    together += (here.x * there.x).signum();
                }
            }
        }
        if together >= 0.0 {
            continue;
        }
        for p in &mut laid[k].points {
            p.x = -p.x;
        }
        for tie in ties.iter_mut() {
            for side in [0, 1] {
                if tie.pieces[side] == k {
                    tie.points[side].x = -tie.points[side].x;
                }
            }
        }
    }
}
