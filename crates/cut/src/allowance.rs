//! The outline of the cloth before it is cleaned: one closed chain round the sum of all patches of cloth.
//!
//! Every chord of the seam line has a rectangle of cloth outside it and every outer bend a wedge, all
//! counter-clockwise. Neighbouring patches, and the patches and the seam line, share sides that are run
//! through once in either direction. Without these shared sides the boundaries of all patches are a single
//! chain. The winding number of the chain at a point is the number of patches that hold the point, so the
//! region where it is not 0 is the union of all patches; the chain has a third of the segments that the
//! separate patches have.

use crate::chain::{Chain, Tag, corner_edge, corner_tag};
use crate::corner::{CornerCloth, HalfPlane, Outcome, STRAIGHT, corner_cloth};
use crate::dart::Cap;
use crate::ring::{Chord, FLATNESS, Ring};
use crate::{Finding, SegmentKind};
use toile_geometry::Vec2;

/// Cloth along one ring of the seam line, before it is united, with the findings about its corners.
pub(crate) struct Cloth {
    /// Closed chains round the cloth: separate patches of corners, dart caps and trimmed allowances, and the
    /// chain along the whole ring.
    pub chains: Vec<Chain>,
    /// Whether each edge of the ring is a leg of a dart, which has no allowance of its own.
    pub is_leg: Vec<bool>,
    pub findings: Vec<Finding>,
}

/// Cloth at each corner of a ring, indexed by the edge that starts at the corner.
struct Corners {
    cloth: Vec<Option<CornerCloth>>,
}

/// A straight cut through the allowance of an edge, made for the shape of the corner at the start of the edge
/// `corner`.
struct Trim {
    plane: HalfPlane,
    corner: usize,
}

/// Largest bend (rad) that a wedge with a single tip covers. The wedge stands for an arc of radius `width`
/// and angle t. The tangents at the ends of the arc meet in the tip, width t^2 / 8 beyond the arc: at most
/// [`FLATNESS`] for this bend.
fn wedge_step(width: f64) -> f64 {
    (8.0 * FLATNESS / width).sqrt().min(1.0)
}

/// Tips of the wedge outside a bend (m), relative to the bend's point on the seam line: points where tangents
/// of the arc with the radius `width` meet.
fn wedge(normals: [Vec2; 2], width: f64) -> Vec<Vec2> {
    let [n, m] = normals;
    let turn = n.perp(&m).atan2(n.dot(&m)).max(0.0);
    let count = (turn / wedge_step(width)).ceil().max(1.0);
    let half = turn / count / 2.0;
    let reach = width / half.cos();
    (0..count as usize)
        .map(|k| {
            let (sin, cos) = (half * (2 * k + 1) as f64).sin_cos();
            Vec2::new(n.x * cos - n.y * sin, n.x * sin + n.y * cos) * reach
        })
        .collect()
}

impl Corners {
    fn new(ring: &Ring, is_leg: &[bool]) -> Self {
        let cloth = (0..ring.edges.len())
            .map(|edge| {
                let before = ring.before(edge);
                if is_leg[edge] || is_leg[before] {
                    return None;
                }
                corner_cloth(
                    (ring.edges[edge].corner, ring.edges[edge].limit),
                    [ring.edges[before].ends[1], ring.edges[edge].ends[0]],
                    [ring.edges[before].width, ring.edges[edge].width],
                )
            })
            .collect();
        Self { cloth }
    }

    /// Cuts that the corners at the two ends of its edge make in the allowance of chord `k` of the ring.
    fn trims(&self, ring: &Ring, k: usize) -> Vec<Trim> {
        let chord = &ring.chords[k];
        let edge = &ring.edges[chord.edge];
        let after = ring.after(chord.edge);
        let reach = |other: usize, corner: usize| {
            ring.edges[corner].limit * edge.width.max(ring.edges[other].width)
        };
        let mut trims = Vec::new();
        let trim = |corner: usize, side: usize| {
            let plane = self.cloth[corner].as_ref()?.trims[side]?;
            Some(Trim {
                plane: plane.translated(ring.first(corner).from),
                corner,
            })
        };
        if chord.at < reach(ring.before(chord.edge), chord.edge) {
            trims.extend(trim(chord.edge, 1));
        }
        if edge.length - chord.at - chord.length < reach(after, after) {
            trims.extend(trim(after, 0));
        }
        // A curved edge may bend back over the line of a cut: the cut applies only to chords that lie inside
        // its line.
        let outer = [chord.from + ring.out(k, 0), chord.to + ring.out(k, 1)];
        let beyond = |p: &Vec2, plane: &HalfPlane| plane.normal.dot(p) - plane.limit;
        trims.retain(|Trim { plane, .. }| {
            let ends = [chord.from, chord.to];
            ends.iter().all(|p| beyond(p, plane) <= 1e-9)
                && outer.iter().any(|p| beyond(p, plane) > 0.0)
        });
        trims
    }
}

/// Course of the chain of cloth from one chord to the next.
#[derive(Clone, Copy, PartialEq)]
enum Joint {
    /// The chain runs in to the seam line and out again.
    Spike,
    /// The chain runs straight on, or by a step between two widths.
    Flat,
    /// The chain runs round an outer bend, along a wedge.
    Wedge,
    /// Slight bend: the allowances of both chords end at this point (m), which lies in a direction between
    /// the normals of the two chords.
    Meet(Vec2),
}

/// Cosine of the sharpest inner bend that counts as slight (1). A slight bend is a bend of a curve, whose
/// normal is taken to turn evenly there.
const SLIGHT: f64 = 0.9;

fn joint(ring: &Ring, k: usize, trimmed: &[Vec<Trim>], is_leg: &[bool]) -> Joint {
    let chord = &ring.chords[k];
    let before_index = (k + ring.chords.len() - 1) % ring.chords.len();
    let before = &ring.chords[before_index];
    let same_edge = k != ring.edges[chord.edge].chords.start;
    let normals = match same_edge {
        true => [before.normal, chord.normal],
        false => [
            ring.edges[before.edge].ends[1],
            ring.edges[chord.edge].ends[0],
        ],
    };
    let (sin, cos) = (normals[0].perp(&normals[1]), normals[0].dot(&normals[1]));
    let widths = [before, chord].map(|chord| ring.edges[chord.edge].width);
    let plain = trimmed[k].is_empty()
        && trimmed[before_index].is_empty()
        && !is_leg[chord.edge]
        && !is_leg[before.edge];
    if !same_edge || is_leg[chord.edge] {
        let step = widths[0].min(widths[1]) > 0.0;
        return match plain && sin.abs() <= STRAIGHT && cos > 0.0 && step {
            true => Joint::Flat,
            false => Joint::Spike,
        };
    }
    let width = widths[1];
    let middle = before.normal + chord.normal;
    if sin >= 0.0 && cos > 0.0 && sin <= wedge_step(width) {
        return Joint::Meet(chord.from + middle * (width / (1.0 + cos)));
    }
    if sin < 0.0 && cos > SLIGHT {
        // The normal of a parabola through the three points: the shorter chord has the greater weight.
        let normal = before.normal * chord.length + chord.normal * before.length;
        return Joint::Meet(chord.from + normal.normalize() * width);
    }
    match sin >= 0.0 && plain {
        true => Joint::Wedge,
        false => Joint::Spike,
    }
}

/// Cloth along a ring with its allowances. `caps` replace the legs of the darts.
pub(crate) fn cloth(ring: &Ring, caps: &[Cap]) -> Cloth {
    let mut is_leg = vec![false; ring.edges.len()];
    for cap in caps {
        cap.legs.iter().for_each(|&leg| is_leg[leg] = true);
    }
    let corners = Corners::new(ring, &is_leg);
    let trims: Vec<Vec<Trim>> = (0..ring.chords.len())
        .map(|k| corners.trims(ring, k))
        .collect();
    let mut chain = Chain::default();
    let mut chains = Vec::new();
    for (k, chord) in ring.chords.iter().enumerate() {
        if is_leg[chord.edge] {
            // The cap replaces both legs: it is added at the start of the first leg.
            let cap = caps.iter().find(|cap| cap.legs[0] == chord.edge);
            if let Some(cap) = cap.filter(|_| k == ring.edges[chord.edge].chords.start) {
                cap.roof
                    .points
                    .iter()
                    .zip(&cap.roof.tags)
                    .for_each(|(&p, &tag)| chain.side(p, tag));
            }
            continue;
        }
        let next = (k + 1) % ring.chords.len();
        let joints = [
            joint(ring, k, &trims, &is_leg),
            joint(ring, next, &trims, &is_leg),
        ];
        push_chord(&mut chain, ring, k, joints, [&trims[k], &trims[next]]);
        let ends = outer_ends(ring, k, joints);
        chains.extend(trimmed_beyond(ring, k, ends, &trims[k]));
        chains.extend(trimmed_wedge(ring, k, [&trims[k], &trims[next]]));
    }
    chains.push(chain);
    chains.extend(caps.iter().flat_map(|cap| cap.patches.iter().cloned()));
    let mut findings = Vec::new();
    for (edge, corner) in corners.cloth.into_iter().enumerate() {
        let Some(corner) = corner else { continue };
        let p = ring.first(edge).from;
        for patch in corner.patches {
            let points = patch.into_iter().map(|x| x + p).collect();
            chains.push(Chain::patch(points, corner_tag(ring, edge)));
        }
        findings.extend(corner_finding(ring, edge, corner.outcome));
    }
    Cloth {
        chains,
        is_leg,
        findings,
    }
}

fn corner_finding(ring: &Ring, edge: usize, outcome: Outcome) -> Option<Finding> {
    let corner = ring.index(corner_edge(ring, edge));
    let widths = [ring.before(edge), edge].map(|k| ring.edges[k].width);
    match outcome {
        Outcome::AsAsked => None,
        Outcome::CutOff(asked) => Some(Finding::CutOff {
            corner,
            asked,
            kept: ring.edges[edge].limit * widths[0].max(widths[1]),
        }),
        Outcome::Mitred(asked) => Some(Finding::Mitred { corner, asked }),
    }
}

/// Adds the part of the chain beside chord `k`, up to the joint with the next chord.
fn push_chord(chain: &mut Chain, ring: &Ring, k: usize, joints: [Joint; 2], trims: [&[Trim]; 2]) {
    let chord = &ring.chords[k];
    let width = ring.edges[chord.edge].width;
    let edge_tag = |beside: Option<(usize, [f64; 2])>| Tag {
        edge: chord.edge,
        kind: SegmentKind::Edge,
        beside,
    };
    if width == 0.0 {
        chain.side(chord.from, edge_tag(Some((k, [0.0, 1.0]))));
        return;
    }
    let last = k + 1 == ring.edges[chord.edge].chords.end;
    let after = ring.after(chord.edge);
    let end_tag = corner_tag(ring, if last { after } else { chord.edge });
    let [is_trimmed, next_trimmed] = trims.map(|trims| !trims.is_empty());
    let outer = outer_ends(ring, k, joints);
    if is_trimmed {
        push_trimmed(chain, ring, k, (outer, trims[0]));
        if matches!(joints[1], Joint::Meet(_)) && !next_trimmed {
            chain.side(chord.to, end_tag);
        }
        return;
    }
    if joints[0] == Joint::Spike {
        chain.side(chord.from, corner_tag(ring, chord.edge));
    }
    let crossing = crossed(chord, outer);
    if let Some(x) = crossing {
        // The end lines of this allowance cross at `x`: the cloth runs up to `x`, and beyond `x` the chain
        // runs round backwards. The sides there are not tagged as this chord's own cut line, but as the end
        // of an allowance.
        chain.side(outer[0], end_tag);
        chain.side(x, end_tag);
        chain.side(outer[1], edge_tag(None));
        chain.side(outer[0], end_tag);
        chain.side(x, end_tag);
    } else {
        chain.side(outer[0], edge_tag(Some((k, [0.0, 1.0]))));
    }
    match joints[1] {
        // The chain of the next chord starts at the same point.
        Joint::Meet(_) if !next_trimmed => {}
        Joint::Meet(_) | Joint::Spike | Joint::Flat => chain.side(outer[1], end_tag),
        Joint::Wedge => {
            let next = &ring.chords[(k + 1) % ring.chords.len()];
            chain.side(outer[1], edge_tag(None));
            for tip in wedge([chord.normal, next.normal], width) {
                chain.side(chord.to + tip, edge_tag(None));
            }
        }
    }
}

/// The outer ends of the allowance beside a chord, at the chord's start and at its end.
fn outer_ends(ring: &Ring, k: usize, joints: [Joint; 2]) -> [Vec2; 2] {
    let chord = &ring.chords[k];
    let end = |end: usize, p: Vec2| match joints[end] {
        Joint::Meet(meet) => meet,
        _ => p + ring.out(k, end),
    };
    [end(0, chord.from), end(1, chord.to)]
}

/// Point where the two end lines of a chord's allowance cross; each end line runs from an end of the chord to
/// the outer end there. `None`: they do not cross. They cross where the curve is tighter than the allowance
/// is wide.
fn crossed(chord: &Chord, [start, end]: [Vec2; 2]) -> Option<Vec2> {
    if (end - start).dot(&chord.along()) >= 0.0 {
        return None;
    }
    let (a, b) = (start - chord.from, end - chord.to);
    let share = (chord.to - chord.from).perp(&b) / a.perp(&b);
    (share > 0.0 && share < 1.0).then(|| chord.from + a * share)
}

/// Adds the outer boundary of a chord's rectangle after the cuts of the corners are made in it.
fn push_trimmed(chain: &mut Chain, ring: &Ring, k: usize, (ends, trims): ([Vec2; 2], &[Trim])) {
    let chord = &ring.chords[k];
    let outer = ends;
    chain.side(chord.from, corner_tag(ring, chord.edge));
    // Clockwise from the chord's start: clipping keeps the order of the points.
    let mut cloth = match crossed(chord, ends) {
        None => vec![chord.from, outer[0], outer[1], chord.to],
        Some(x) => vec![chord.from, x, chord.to],
    };
    for trim in trims {
        cloth = trim.plane.clip(&cloth);
    }
    let start = cloth.iter().position(|p| (p - chord.from).norm() < 1e-9);
    let (Some(start), true) = (start, cloth.len() > 2) else {
        return;
    };
    cloth.rotate_left(start);
    let way = outer[1] - outer[0];
    let share = |p: Vec2| ((p - outer[0]).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
    let is_out = |p: &Vec2| way.perp(&(p - outer[0])).abs() < 1e-9 * way.norm();
    let is_cut = |trim: &&Trim, p: &Vec2| {
        let plane = &trim.plane;
        (plane.normal.dot(p) - plane.limit).abs() < 1e-9
    };
    for pair in cloth.windows(2).skip(1) {
        let cut = trims
            .iter()
            .find(|trim| pair.iter().all(|p| is_cut(trim, p)));
        let tag = match cut {
            Some(trim) => corner_tag(ring, trim.corner),
            None if pair.iter().all(is_out) => Tag {
                edge: chord.edge,
                kind: SegmentKind::Edge,
                beside: Some((k, [share(pair[0]), share(pair[1])])),
            },
            None => corner_tag(ring, chord.edge),
        };
        chain.side(pair[0], tag);
    }
}

/// Cloth of a chord beyond the point where the end lines of its allowance cross, if a corner cuts some of
/// this cloth away.
fn trimmed_beyond(ring: &Ring, k: usize, ends: [Vec2; 2], trims: &[Trim]) -> Option<Chain> {
    let x = crossed(&ring.chords[k], ends)?;
    let corner = trims.first()?.corner;
    let mut cloth = vec![x, ends[1], ends[0]];
    for trim in trims {
        cloth = trim.plane.clip(&cloth);
    }
    (cloth.len() > 2).then(|| Chain::patch(cloth, corner_tag(ring, corner)))
}

/// The wedge at the outer bend at the end of chord `k`, if a corner cuts some of it away.
fn trimmed_wedge(ring: &Ring, k: usize, trims: [&Vec<Trim>; 2]) -> Option<Chain> {
    let (chord, next) = (&ring.chords[k], &ring.chords[(k + 1) % ring.chords.len()]);
    let width = ring.edges[chord.edge].width;
    let inside = k + 1 != ring.edges[chord.edge].chords.end;
    let plain = trims.iter().all(|trims| trims.is_empty());
    let (sin, cos) = (
        chord.normal.perp(&next.normal),
        chord.normal.dot(&next.normal),
    );
    let slight = cos > 0.0 && sin <= wedge_step(width);
    if !inside || plain || width == 0.0 || sin < 0.0 || slight {
        return None;
    }
    let mut cloth = vec![Vec2::zeros(), chord.normal * width];
    cloth.extend(wedge([chord.normal, next.normal], width));
    cloth.push(next.normal * width);
    for trim in trims[0].iter().chain(trims[1]) {
        cloth = trim.plane.translated(-chord.to).clip(&cloth);
    }
    let corner = trims[0].first().or(trims[1].first())?.corner;
    let is_round = |p: &Vec2| p.norm() > width * (1.0 - 1e-9);
    let count = cloth.len();
    let tags = (0..count).map(
        |k| match is_round(&cloth[k]) && is_round(&cloth[(k + 1) % count]) {
            true => Tag {
                edge: chord.edge,
                kind: SegmentKind::Edge,
                beside: None,
            },
            false => corner_tag(ring, corner),
        },
    );
    (count > 2).then(|| Chain {
        tags: tags.collect(),
        points: cloth.iter().map(|x| x + chord.to).collect(),
    })
}
