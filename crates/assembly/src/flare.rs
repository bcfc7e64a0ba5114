//! Flared pieces: rings and sectors of rings, as circle skirts are cut of. They are unrolled about the circle of their
//! inner edge before they are laid out, so that they hang from it.

use crate::flat_pieces::{FlatPiece, Tie};
use crate::mesh::{PieceMesh, PieceMeshes};
use crate::role::Role;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toile_geometry::Vec2;
use toile_pattern::{BodyPart, Draft, Facing};

/// Least angle of a sector that is laid out as one (rad): flatter waists are wrapped as they are.
const MIN_TURN: f64 = 0.6;
/// Farthest that an inner edge lies off its circle, as a share of its radius.
const OFF_CIRCLE: f64 = 0.08;
/// Farthest that cloth reaches over the sides of a sector (rad).
const OVER_SIDE: f64 = 0.12;
/// Neighbouring edges whose directions differ by less than this are one arc (rad).
const SMOOTH: f64 = 0.35;
/// Least length of an inner edge that is sewn to nothing, over the length round the waist.
const ROUND_WAIST: f64 = 0.7;

/// The inner edge of a ring or of a sector of one.
#[derive(Clone, Debug)]
struct InnerEdge {
    centre: Vec2,
    radius: f64,
    /// Direction of its middle (rad), and the angle it spans (rad).
    middle: f64,
    turn: f64,
    /// Edges of the piece that it is made of.
    edges: Vec<usize>,
}

/// What is known of the pieces when they are searched for flares.
pub(crate) struct Pieces<'a> {
    pub draft: &'a Draft,
    pub meshes: &'a PieceMeshes,
    /// Length round the body's waist (m).
    pub waist: f64,
}

/// Unrolls every flared piece that hangs on the trunk. Rings that are sewn to what goes round the trunk go round it
/// too, whatever their document says of a ring alone.
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
    /// Pieces that an edge of a piece is sewn to, as indices of meshed pieces, with the edges there.
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

    /// Whether a piece hangs from its inner edge: that is sewn to what is worn round the trunk, or goes round the
    /// waist by itself; and its outer edge is sewn to nothing but to the inner edge of another such piece.
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
    /// Angle of a point from the middle (rad), and its distance from the centre (m). The coordinates are those of the
    /// piece as laid, seen from its right side.
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

/// The inner edge of a piece that is a ring or a sector of one; none of another.
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

/// How many of a mesh's edges are of its outline: they come first.
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

/// Points along edges of a piece as laid, in the order of its outline.
fn points_of(mesh: &PieceMesh, laid: &FlatPiece, edges: &[usize]) -> Vec<Vec2> {
    let vertices = edges.iter().flat_map(|&e| &mesh.edge_vertices[e]);
    vertices.map(|&v| laid.points[v as usize]).collect()
}

/// Runs of edges of the outline that bend on evenly, each as the outline walks it.
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

/// Centre and radius of the circle that fits points (Kasa 1976), where they lie near it.
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

/// Lays a piece out by the way along its inner edge and the distance under it.
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

/// Turns a flared piece to its wrong side where the seam along its inner edge asks for that: walked by the seam, both
/// sides of it must go round the body the same way.
pub(crate) fn turn_as_sewn(laid: &mut [FlatPiece], ties: &mut [Tie]) {
    for k in 0..laid.len() {
        if laid[k].turn == 0.0 {
            continue;
        }
        // Half of the steps from stitch to stitch would suffice: but for one at the seam's end, all go the same way.
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
