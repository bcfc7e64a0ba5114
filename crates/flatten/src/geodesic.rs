//! Shortest paths over a surface of triangles: a strip of triangles from end to end, the straightest way through it, and
//! the strip led round the other side of every corner at which the way still bends (Xin and Wang 2007).

use crate::ordered::Ordered;
use crate::region::flat_triangle;
use crate::split_mesh::{SNAP, SplitMesh};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::PI;
use toile_geometry::{Vec2, Vec3};

/// Most times that a strip is led round a corner.
const MAX_ROUNDS: usize = 20_000;

/// Least by which the angle on the other side of a corner is below a straight one, for the way to be led there (rad).
const BEND: f64 = 1e-7;

/// A place of a path on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathNode {
    /// At a vertex.
    Vertex(u32),
    /// Across an edge.
    Edge {
        /// Ends of the edge.
        ends: [u32; 2],
        /// Share of the way between them (1).
        share: f64,
    },
}

/// The shortest path between two vertices, with both; none where no path joins them. It is the shortest among its
/// neighbours; a surface with handles or deep bays may have a shorter one elsewhere.
pub fn shortest_path(mesh: &SplitMesh, from: u32, to: u32) -> Option<Vec<PathNode>> {
    let mut strip = first_strip(mesh, from, to)?;
    for _ in 0..MAX_ROUNDS {
        trim(mesh, &mut strip, from, to);
        let layout = Layout::new(mesh, &strip, to);
        let start = layout.place(&strip, mesh, 0, from);
        let turns = layout.turns(from, start);
        match led_round(mesh, &strip, &layout, (start, &turns)) {
            Some(shorter) => strip = shorter,
            None => return Some(layout.nodes(from, start, &turns)),
        }
    }
    None
}

/// Adjacent triangles from one vertex to another, a short way by the middles of the edges between them.
fn first_strip(mesh: &SplitMesh, from: u32, to: u32) -> Option<Vec<u32>> {
    let count = mesh.triangles().len();
    let start = mesh.positions()[from as usize];
    let mut reached = vec![f64::INFINITY; count];
    let mut entered: Vec<Vec3> = vec![start; count];
    let mut before: Vec<Option<u32>> = vec![None; count];
    let mut open = BinaryHeap::new();
    for t in mesh.fan(from)?.triangles {
        reached[t as usize] = 0.0;
        open.push(Reverse((Ordered(0.0), t)));
    }
    while let Some(Reverse((Ordered(way), t))) = open.pop() {
        if way > reached[t as usize] {
            continue;
        }
        let corners = mesh.triangles()[t as usize];
        if corners.contains(&to) {
            let mut strip = vec![t];
            let mut at = t;
            while let Some(previous) = before[at as usize] {
                strip.push(previous);
                at = previous;
            }
            strip.reverse();
            return Some(strip);
        }
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let Some(next) = mesh.left_of(b, a) else {
                continue;
            };
            let middle = 0.5 * (mesh.positions()[a as usize] + mesh.positions()[b as usize]);
            let longer = way + (middle - entered[t as usize]).norm();
            if longer < reached[next as usize] {
                reached[next as usize] = longer;
                entered[next as usize] = middle;
                before[next as usize] = Some(t);
                open.push(Reverse((Ordered(longer), next)));
            }
        }
    }
    None
}

/// Leaves out what a strip does before it last leaves its start, after it first reaches its end, and between two visits
/// of one triangle.
fn trim(mesh: &SplitMesh, strip: &mut Vec<u32>, from: u32, to: u32) {
    let has = |t: &u32, v: u32| mesh.triangles()[*t as usize].contains(&v);
    let mut short: Vec<u32> = Vec::with_capacity(strip.len());
    for &t in strip.iter() {
        match short.iter().position(|&other| other == t) {
            Some(at) => short.truncate(at + 1),
            None => short.push(t),
        }
    }
    let start = short.iter().rposition(|t| has(t, from)).unwrap_or(0);
    short.drain(..start);
    if let Some(end) = short.iter().position(|t| has(t, to)) {
        short.truncate(end + 1);
    }
    *strip = short;
}

/// A strip laid out flat.
struct Layout {
    /// Places of each triangle's corners, in the order of its corners (m).
    places: Vec<[Vec2; 3]>,
    /// Ends of the edges between the triangles, on the left and on the right of the way: vertices and places (m). The
    /// last is the end of the path, twice.
    portals: Vec<[(u32, Vec2); 2]>,
}

/// A corner at which the straightest way through a strip bends.
struct Turn {
    vertex: u32,
    /// Index of the edge that it ends.
    portal: usize,
    place: Vec2,
    /// Whether the corner is on the left of the way.
    is_left: bool,
}

impl Layout {
    fn new(mesh: &SplitMesh, strip: &[u32], to: u32) -> Self {
        let mut places = vec![flat_triangle(mesh.corners(strip[0]))];
        let mut portals = Vec::with_capacity(strip.len());
        for pair in strip.windows(2) {
            let (corners, next) = (
                mesh.triangles()[pair[0] as usize],
                mesh.triangles()[pair[1] as usize],
            );
            let known = places[places.len() - 1];
            let shared =
                (0..3).find(|&k| mesh.left_of(corners[(k + 1) % 3], corners[k]) == Some(pair[1]));
            let k = shared.unwrap_or(0);
            let (a, b) = ((k, corners[k]), ((k + 1) % 3, corners[(k + 1) % 3]));
            let (at_a, at_b) = (known[a.0], known[b.0]);
            portals.push([(b.1, at_b), (a.1, at_a)]);
            // The next triangle has the edge from b to a, its third corner on the left of that.
            let m = next.iter().position(|&v| v == b.1).unwrap_or(0);
            let own = mesh.corners(pair[1]);
            let local = flat_triangle([own[m], own[(m + 1) % 3], own[(m + 2) % 3]]);
            let along = (at_a - at_b).try_normalize(0.0).unwrap_or_default();
            let left = Vec2::new(-along.y, along.x);
            let mut laid = [Vec2::zeros(); 3];
            laid[m] = at_b;
            laid[(m + 1) % 3] = at_a;
            laid[(m + 2) % 3] = at_b + along * local[2].x + left * local[2].y;
            places.push(laid);
        }
        let last = strip.len() - 1;
        let corner = mesh.triangles()[strip[last] as usize]
            .iter()
            .position(|&v| v == to);
        let end = (to, places[last][corner.unwrap_or(0)]);
        portals.push([end, end]);
        Self { places, portals }
    }

    fn place(&self, strip: &[u32], mesh: &SplitMesh, triangle: usize, v: u32) -> Vec2 {
        let corners = mesh.triangles()[strip[triangle] as usize];
        let k = corners.iter().position(|&w| w == v).unwrap_or(0);
        self.places[triangle][k]
    }

    /// The corners at which the straightest way through the strip bends (a funnel).
    fn turns(&self, from: u32, start: Vec2) -> Vec<Turn> {
        let mut turns = Vec::new();
        let mut apex = (from, start);
        // The sides of the funnel, left and right, and the edges they end at. A side at the apex does not bound yet.
        let mut sides = [apex, apex];
        let mut at = [0usize, 0];
        let mut k = 0;
        while k < self.portals.len() {
            for own in [1, 0] {
                let other = 1 - own;
                let sign = if own == 0 { -1.0 } else { 1.0 };
                let candidate = self.portals[k][own];
                if candidate.0 == apex.0 {
                    continue;
                }
                let turn = |a: Vec2, b: Vec2| sign * (a - apex.1).perp(&(b - apex.1));
                if sides[own].0 != apex.0 && turn(sides[own].1, candidate.1) < 0.0 {
                    continue;
                }
                if sides[other].0 == apex.0 || turn(candidate.1, sides[other].1) > 0.0 {
                    sides[own] = candidate;
                    at[own] = k;
                    continue;
                }
                if sides[other].0 == self.end() {
                    return turns;
                }
                apex = sides[other];
                k = at[other];
                turns.push(Turn {
                    vertex: apex.0,
                    portal: k,
                    place: apex.1,
                    is_left: other == 0,
                });
                sides = [apex, apex];
                at = [k, k];
                break;
            }
            k += 1;
        }
        turns
    }

    fn end(&self) -> u32 {
        self.portals[self.portals.len() - 1][0].0
    }

    /// The way through the corners as places on vertices and edges.
    fn nodes(&self, from: u32, start: Vec2, turns: &[Turn]) -> Vec<PathNode> {
        let mut nodes = vec![PathNode::Vertex(from)];
        let mut push = |node: PathNode| {
            if nodes.last() != Some(&node) {
                nodes.push(node);
            }
        };
        let last = self.portals.len() - 1;
        let (mut a, mut from_portal) = ((from, start), 0);
        let ends = turns
            .iter()
            .map(|turn| (turn.vertex, turn.place, turn.portal));
        for (v, place, portal) in ends.chain([(self.end(), self.portals[last][0].1, last)]) {
            let way = place - a.1;
            for [left, right] in &self.portals[from_portal..portal] {
                if [left.0, right.0].contains(&a.0) || [left.0, right.0].contains(&v) {
                    continue;
                }
                let (l, r) = (way.perp(&(left.1 - a.1)), way.perp(&(right.1 - a.1)));
                let share = if l - r > 0.0 {
                    (l / (l - r)).clamp(0.0, 1.0)
                } else {
                    0.5
                };
                push(match share {
                    s if s < SNAP => PathNode::Vertex(left.0),
                    s if s > 1.0 - SNAP => PathNode::Vertex(right.0),
                    share => PathNode::Edge {
                        ends: [left.0, right.0],
                        share,
                    },
                });
            }
            push(PathNode::Vertex(v));
            a = (v, place);
            from_portal = portal;
        }
        nodes
    }
}

/// The strip led round the other side of the first corner at which that is shorter.
fn led_round(
    mesh: &SplitMesh,
    strip: &[u32],
    layout: &Layout,
    (start, turns): (Vec2, &[Turn]),
) -> Option<Vec<u32>> {
    for (n, turn) in turns.iter().enumerate() {
        let v = turn.vertex;
        let has = |k: usize| mesh.triangles()[strip[k] as usize].contains(&v);
        let mut first = turn.portal;
        while first > 0 && has(first - 1) {
            first -= 1;
        }
        let mut last = turn.portal + 1;
        while last + 1 < strip.len() && has(last + 1) {
            last += 1;
        }
        let Some(fan) = mesh.fan(v).filter(|fan| fan.closed) else {
            continue;
        };
        let total: f64 = fan.triangles.iter().map(|&t| mesh.angle_at(t, v)).sum();
        let before = match n {
            0 => start,
            n => turns[n - 1].place,
        };
        let after = turns
            .get(n + 1)
            .map_or(layout.portals[layout.portals.len() - 1][0].1, |t| t.place);
        // The angle through the strip: from the way in to the first edge at the corner, on to the last, to the way out.
        let edge = |portal: usize| {
            let [left, right] = layout.portals[portal];
            let other = if left.0 == v { right } else { left };
            other.1 - turn.place
        };
        let inner: f64 = (first + 1..last).map(|k| mesh.angle_at(strip[k], v)).sum();
        let within = (before - turn.place).angle(&edge(first))
            + inner
            + edge(last - 1).angle(&(after - turn.place));
        if total - within >= PI - BEND {
            continue;
        }
        let count = fan.triangles.len();
        let place = |t: u32| fan.triangles.iter().position(|&other| other == t);
        let (Some(from), Some(to)) = (place(strip[first]), place(strip[last])) else {
            continue;
        };
        // A corner on the left is passed counter-clockwise, so that the other way round is clockwise.
        let step = if turn.is_left { count - 1 } else { 1 };
        let mut round = strip[..first].to_vec();
        let mut at = from;
        round.push(fan.triangles[at]);
        while at != to {
            at = (at + step) % count;
            round.push(fan.triangles[at]);
        }
        round.extend_from_slice(&strip[last + 1..]);
        return Some(round);
    }
    None
}
