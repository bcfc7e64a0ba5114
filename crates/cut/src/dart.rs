//! The mouth of a dart: cloth that lies flush with the edge beside it once the dart is pressed.
//!
//! When a dart is sewn shut and pressed to one side, the cloth inside it is folded at the leg that it is
//! pressed towards, and folded back at the fold line half-way between the legs. So the half of the mouth
//! beside that leg is cut along the mirror image, in the leg, of the cut line of the edge next to it; the
//! other half is cut along the mirror image of the first half in the fold line.

use crate::chain::{Chain, Tag, corner_tag};
use crate::ring::{Chord, Ring};
use crate::{CapFault, CutError, Dart, MITRE_LIMIT, SegmentKind};
use toile_geometry::{Polygon, Vec2};

/// The cloth at the mouth of a dart: points that replace the legs in the chain round the cloth.
pub(crate) struct Cap {
    /// The two legs, as edges of the ring.
    pub legs: [usize; 2],
    /// Outer boundary from the start of the first leg to the end of the second leg; the end point is left
    /// out.
    pub roof: Chain,
    /// Cloth between the neighbours' allowances and the extended legs.
    pub patches: Vec<Chain>,
    /// Reason why the cap runs straight across the mouth. `None`: it is shaped by folding.
    pub fault: Option<CapFault>,
}

/// A directed line, with points at its left and at its right.
#[derive(Clone, Copy)]
struct Axis {
    on: Vec2,
    /// Unit vector along the line.
    along: Vec2,
}

impl Axis {
    fn mirror(&self, p: Vec2) -> Vec2 {
        let d = p - self.on;
        self.on + self.along * (2.0 * d.dot(&self.along)) - d
    }

    /// Signed distance of a point from the line, positive at the left (m).
    fn side(&self, p: Vec2) -> f64 {
        self.along.perp(&(p - self.on))
    }

    /// Point where the line through `p` in the direction `way` meets the axis. `None`: they are parallel.
    fn meet(&self, p: Vec2, way: Vec2) -> Option<Vec2> {
        let t = -self.side(p) / self.along.perp(&way);
        t.is_finite().then(|| p + way * t)
    }
}

/// Unit vector along a ring, in its walking order, at a point with the outward normal `normal`.
fn along(normal: Vec2) -> Vec2 {
    Vec2::new(-normal.y, normal.x)
}

/// One side of a dart's mouth: the outer end of a leg, and the edge next to the leg (the neighbour), walked
/// away from the dart.
struct Flank {
    /// The leg, as an edge of the ring.
    leg: usize,
    /// Outer end of the leg (m).
    mouth: Vec2,
    /// Unit vector outwards along the leg.
    out: Vec2,
    /// The neighbour's cut line, from the mouth on (m).
    offset: Vec<Vec2>,
    /// Width of the neighbour's allowance (m).
    width: f64,
}

impl Flank {
    /// The side of the mouth before (0) or after (1) the dart with these legs.
    fn new(ring: &Ring, legs: [usize; 2], which: usize) -> Self {
        let (leg, neighbour) = match which {
            0 => (legs[0], ring.before(legs[0])),
            _ => (legs[1], ring.after(legs[1])),
        };
        let (mouth, out) = match which {
            0 => (ring.first(leg).from, -along(ring.edges[leg].ends[0])),
            _ => (ring.last(leg).to, along(ring.edges[leg].ends[1])),
        };
        let edge = &ring.edges[neighbour];
        let mut chords: Vec<&Chord> = ring.chords[edge.chords.clone()].iter().collect();
        if which == 0 {
            chords.reverse();
        }
        let ends = |chord: &Chord| match which {
            0 => [chord.to, chord.from],
            _ => [chord.from, chord.to],
        };
        let near = edge.ends[1 - which];
        let mut offset = Vec::with_capacity(chords.len() + 1);
        for (k, chord) in chords.iter().enumerate() {
            let before = if k == 0 { near } else { chords[k - 1].normal };
            let normal = if k == 0 { near } else { chord.normal };
            let middle = before + normal;
            let scale = edge.width / (1.0 + before.dot(&normal));
            offset.push(ends(chord)[0] + middle * scale);
        }
        if let Some(chord) = chords.last() {
            offset.push(ends(chord)[1] + chord.normal * edge.width);
        }
        Self {
            leg,
            mouth,
            out,
            offset,
            width: edge.width,
        }
    }

    fn axis(&self) -> Axis {
        Axis {
            on: self.mouth,
            along: self.out,
        }
    }

    /// The neighbour's cut line from the point where it meets the extended leg, `axis`. If the cut line
    /// starts on the neighbour's side of the leg, it is extended back to the leg. Then the triangle of cloth
    /// between the leg and the start of the cut line is returned, too.
    fn beyond_leg(&self, axis: Axis) -> Result<(Vec<Vec2>, Option<[Vec2; 3]>), CapFault> {
        let [first, second, ..] = self.offset[..] else {
            return Err(CapFault::NoNeighbour);
        };
        let far = self.offset[self.offset.len() - 1];
        let sign = axis.side(far).signum();
        let mut missing = None;
        let path = if axis.side(first) * sign >= 0.0 {
            let meet = axis
                .meet(first, second - first)
                .ok_or(CapFault::NoMeeting)?;
            missing = Some([self.mouth, first, meet]);
            std::iter::once(meet)
                .chain(self.offset.iter().copied())
                .collect()
        } else {
            let k = (1..self.offset.len())
                .find(|&k| axis.side(self.offset[k]) * sign >= 0.0)
                .ok_or(CapFault::NoMeeting)?;
            let (p, q) = (self.offset[k - 1], self.offset[k]);
            let meet = axis.meet(p, q - p).ok_or(CapFault::NoMeeting)?;
            let rest = self.offset[k..].iter().copied();
            std::iter::once(meet).chain(rest).collect::<Vec<_>>()
        };
        let reach = (path[0] - self.mouth).norm();
        if reach > MITRE_LIMIT * self.width {
            return Err(CapFault::NoMeeting);
        }
        Ok((path, missing))
    }
}

/// The caps of all darts of an outline, in the order of `darts`.
pub(crate) fn caps(ring: &Ring, darts: &[Dart]) -> Result<Vec<Cap>, CutError> {
    let cap = |(k, dart): (usize, &Dart)| {
        let legs = ring.legs(dart.legs).ok_or(CutError::Dart(k))?;
        let pressed = if ring.reversed {
            1 - dart.pressed
        } else {
            dart.pressed
        };
        Ok(cap(ring, legs, pressed, &all_legs(ring, darts)))
    };
    darts.iter().enumerate().map(cap).collect()
}

fn all_legs(ring: &Ring, darts: &[Dart]) -> Vec<usize> {
    darts
        .iter()
        .filter_map(|dart| ring.legs(dart.legs))
        .flatten()
        .collect()
}

fn cap(ring: &Ring, legs: [usize; 2], pressed: usize, all: &[usize]) -> Cap {
    let neighbours = [ring.before(legs[0]), ring.after(legs[1])];
    let flanks = [0, 1].map(|which| Flank::new(ring, legs, which));
    let folded = match all.contains(&neighbours[pressed]) {
        true => Err(CapFault::NoNeighbour),
        false => folded(ring, legs, &flanks, pressed),
    };
    let (roof, patches, fault) = match folded {
        Ok((roof, patches)) => (roof, patches, None),
        Err(fault) => {
            let width = match all.contains(&neighbours[pressed]) {
                true => 0.0,
                false => flanks[pressed].width,
            };
            (straight(&flanks, pressed, width), Vec::new(), Some(fault))
        }
    };
    Cap {
        legs,
        roof,
        patches: patches
            .into_iter()
            .filter(|(k, _)| !all.contains(&neighbours[*k]))
            .map(|(k, patch)| {
                let corner = [legs[0], ring.after(legs[1])][k];
                patch_chain(patch, corner_tag(ring, corner))
            })
            .collect(),
        fault,
    }
}

fn cap_tag(leg: usize) -> Tag {
    Tag {
        edge: leg,
        kind: SegmentKind::DartCap,
        beside: None,
    }
}

fn patch_chain(patch: [Vec2; 3], tag: Tag) -> Chain {
    let mut points = patch.to_vec();
    if toile_geometry::ring_area(&points) < 0.0 {
        points.reverse();
    }
    Chain {
        points,
        tags: vec![tag; 3],
    }
}

/// A cap straight across the mouth, with the width of the edge that the dart is pressed towards.
fn straight(flanks: &[Flank; 2], pressed: usize, width: f64) -> Chain {
    let (p, q) = (flanks[0].mouth, flanks[1].mouth);
    let across = (q - p).try_normalize(0.0).unwrap_or_default();
    let out = Vec2::new(across.y, -across.x) * width;
    let tag = cap_tag(flanks[pressed].leg);
    let mut roof = Chain::default();
    roof.side(p, tag);
    if width > 0.0 {
        roof.side(p + out, tag);
        roof.side(q + out, tag);
    }
    roof
}

/// Roof of a cap that is shaped by folding, and its patches of cloth, each with the side of the mouth that it
/// lies at (0 before the dart, 1 after it).
type Folded = (Chain, Vec<(usize, [Vec2; 3])>);

fn folded(
    ring: &Ring,
    legs: [usize; 2],
    flanks: &[Flank; 2],
    pressed: usize,
) -> Result<Folded, CapFault> {
    let (near, far) = (&flanks[pressed], &flanks[1 - pressed]);
    let across = (far.mouth - near.mouth)
        .try_normalize(1e-9)
        .ok_or(CapFault::NoMeeting)?;
    // The mirror image in this line maps one end of the mouth to the other; if both legs are equally long,
    // the line runs through the apex.
    let fold = Axis {
        on: (near.mouth + far.mouth) * 0.5,
        along: Vec2::new(-across.y, across.x),
    };
    let leg = near.axis();
    let (path, missing) = near.beyond_leg(leg)?;
    let mut patches: Vec<(usize, [Vec2; 3])> = missing.map(|m| (pressed, m)).into_iter().collect();
    let half = up_to(path.into_iter().map(|p| leg.mirror(p)).collect(), fold)?;
    let other = Axis {
        on: far.mouth,
        along: fold.mirror(near.mouth + near.out) - far.mouth,
    };
    if let Ok((_, Some(missing))) = far.beyond_leg(other) {
        patches.push((1 - pressed, missing));
    }
    let mut points = vec![near.mouth];
    points.extend(&half);
    let turn = points.len() - 1;
    points.extend(half.iter().rev().skip(1).map(|&p| fold.mirror(p)));
    points.push(far.mouth);
    let tags = (0..points.len() - 1).map(|k| {
        let flank = if k < turn { near } else { far };
        cap_tag(flank.leg)
    });
    let mut tags: Vec<Tag> = tags.collect();
    // The first and last side lie on the extended legs: they are steps to the allowances of the neighbour
    // edges.
    let corner = |which: usize| corner_tag(ring, [legs[0], ring.after(legs[1])][which]);
    if let [first, .., last] = &mut tags[..] {
        (*first, *last) = (corner(pressed), corner(1 - pressed));
    }
    if pressed == 1 {
        points.reverse();
        tags.reverse();
    }
    let whole = points.iter().copied().chain(apex_side(ring, legs));
    let mut whole: Vec<Vec2> = whole.collect();
    whole.dedup_by(|a, b| (*a - *b).norm() < 1e-12);
    if toile_geometry::ring_area(&whole) <= 0.0 || !Polygon::new(whole).is_simple() {
        return Err(CapFault::Crossing);
    }
    points.pop();
    Ok((Chain { points, tags }, patches))
}

/// The points of a path before it meets a line, and the point where it meets the line.
fn up_to(path: Vec<Vec2>, line: Axis) -> Result<Vec<Vec2>, CapFault> {
    let sign = line.side(path[0]).signum();
    let crossed = path.iter().position(|&p| line.side(p) * sign <= 0.0);
    let k = crossed.ok_or(CapFault::TooShort)?;
    if k == 0 {
        return Err(CapFault::NoMeeting);
    }
    let meet = line
        .meet(path[k - 1], path[k] - path[k - 1])
        .ok_or(CapFault::NoMeeting)?;
    let mut kept = path;
    kept.truncate(k);
    kept.push(meet);
    Ok(kept)
}

/// Points of the two legs, walked backwards from the end of the second leg to the start of the first; both of
/// these end points are left out.
fn apex_side(ring: &Ring, legs: [usize; 2]) -> Vec<Vec2> {
    let mut points: Vec<Vec2> = legs
        .iter()
        .flat_map(|&leg| &ring.chords[ring.edges[leg].chords.clone()])
        .map(|chord| chord.from)
        .skip(1)
        .collect();
    points.reverse();
    points
}
