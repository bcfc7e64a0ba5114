//! Places of the notches of a piece: on the seam line, and on the cut lines beside it.

use crate::corner::MITRE_LIMIT;
use crate::notch::CutNotch;
use crate::notch_room::Room;
use crate::seams::{NamedSeam, Plane};
use toile_geometry::{Vec2, ring_area};
use toile_pattern::{EdgeOrigin, Piece, PieceNotch};

/// Largest distance from a corner of the seam line at which a notch counts as at the corner (m).
pub(crate) const AT_CORNER: f64 = 1e-6;

/// Directions and allowance of an edge at one of its points.
#[derive(Clone, Copy)]
struct Side {
    edge: EdgeOrigin,
    /// Unit vector along the edge, in walking order of the loop.
    way: Vec2,
    /// Unit vector away from the cloth.
    out: Vec2,
    /// Width of the allowance (m).
    width: f64,
}

/// The edges before and after a corner.
pub(crate) struct Corner {
    before: Side,
    after: Side,
}

/// Frame for a notch: the edge that it is on, the vector from the seam line to the cut line (m), and the unit
/// vector into the piece.
struct Stand {
    edge: EdgeOrigin,
    outwards: Vec2,
    inward: Vec2,
}

/// The notches of a piece, each cut as deep as there is room for.
pub(crate) fn notches_of(
    piece: &Piece,
    plane: &Plane,
    seam: &NamedSeam,
    room: &Room,
) -> Vec<CutNotch> {
    let mut found: Vec<CutNotch> = Vec::new();
    for notch in &piece.notches {
        let point = plane.vector(notch.point);
        let stands = match corner_at(seam, point) {
            Some(corner) => corner.stands(notch.edge),
            None => vec![straight_out(notch, plane, seam)],
        };
        for stand in stands {
            let is_known = |known: &CutNotch| {
                (known.id, known.edge) == (notch.id, stand.edge)
                    && (known.point - point).norm() < AT_CORNER
            };
            if !found.iter().any(is_known) {
                found.push(cut_notch(piece, (notch, point), &stand, room));
            }
        }
    }
    found
}

fn cut_notch(
    piece: &Piece,
    (notch, point): (&PieceNotch, Vec2),
    stand: &Stand,
    room: &Room,
) -> CutNotch {
    let all = piece.outline.iter().chain(piece.holes.iter().flatten());
    let mut edges = all.filter(|edge| edge.origin == stand.edge);
    let reversed = edges.next().is_some_and(|edge| edge.reversed);
    // The cloth lies at the left of the outline as drawn.
    let along = |inward: Vec2| Vec2::new(inward.y, -inward.x) * if reversed { -1.0 } else { 1.0 };
    let mut made = CutNotch {
        id: notch.id,
        edge: stand.edge,
        kind: notch.kind,
        point,
        inward: stand.inward,
        on_cut: point,
        along: along(stand.inward),
        depth: 0.0,
        cut: Vec::new(),
    };
    let way = stand.outwards.try_normalize(1e-9);
    if let Some((way, at)) = way.and_then(|way| Some((way, room.cut_line(point, stand.outwards)?)))
    {
        made.on_cut = at;
        let axes = [along(-way), -way];
        if let Some((depth, lines)) = room.cut(notch.kind, (point, at), axes) {
            (made.depth, made.cut) = (depth, lines);
        }
    }
    made
}

/// Frame of a notch within an edge: square to the seam line.
fn straight_out(notch: &PieceNotch, plane: &Plane, seam: &NamedSeam) -> Stand {
    let inward = plane.normal(notch.inward);
    Stand {
        edge: notch.edge,
        outwards: -inward * seam.width_of(notch.edge),
        inward,
    }
}

/// The corner of a seam line at a point; `None`: no two edges meet there.
pub(crate) fn corner_at(seam: &NamedSeam, point: Vec2) -> Option<Corner> {
    for (number, (edges, names)) in seam.loops().enumerate() {
        let corners: Vec<Vec2> = edges.iter().flat_map(|e| e.curve.flatten(1e-3)).collect();
        // The outline runs counter-clockwise and holes clockwise, or both the other way round.
        let is_hole = number > 0;
        let sign = match (ring_area(&corners) < 0.0) == is_hole {
            true => 1.0,
            false => -1.0,
        };
        let side = |k: usize, end: f64| {
            let way = edges[k].curve.derivative(end).try_normalize(1e-15)?;
            Some(Side {
                edge: names[k],
                way,
                out: Vec2::new(way.y, -way.x) * sign,
                width: edges[k].width,
            })
        };
        for after in 0..edges.len() {
            let before = (after + edges.len() - 1) % edges.len();
            let here = (edges[after].curve.start() - point).norm() < AT_CORNER;
            if here && names[before] != names[after] {
                let (before, after) = (side(before, 1.0)?, side(after, 0.0)?);
                return Some(Corner { before, after });
            }
        }
    }
    None
}

impl Corner {
    /// Frames for a notch at the corner: one for each of the two edges that is not a leg of a dart; if both
    /// are legs, one frame for `edge`.
    fn stands(&self, edge: EdgeOrigin) -> Vec<Stand> {
        let (a, b) = (self.before, self.after);
        let inward = -(a.out + b.out).try_normalize(1e-6).unwrap_or(a.out);
        let own = [(a, -b.way), (b, a.way)];
        let sides = own
            .into_iter()
            .filter(|(side, _)| side.edge.leg().is_none());
        let stands: Vec<Stand> = sides
            .map(|(side, drawn_on)| Stand {
                edge: side.edge,
                outwards: self.outwards(side, drawn_on),
                inward,
            })
            .collect();
        match stands.is_empty() {
            true => vec![Stand {
                edge,
                outwards: Vec2::zeros(),
                inward,
            }],
            false => stands,
        }
    }

    /// Vectors from the corner to each cut line that meets there (m).
    pub fn outwards_all(&self) -> Vec<Vec2> {
        let stands = self.stands(self.before.edge).into_iter();
        stands.map(|stand| stand.outwards).collect()
    }

    /// Vector from the corner to the cut line of the edge of `side` (m), along the extended seam line of the
    /// other edge, which has the direction `drawn_on`. At an inner corner, and at a blunt corner where that
    /// vector is long, it leads to the point where both cut lines meet.
    fn outwards(&self, side: Side, drawn_on: Vec2) -> Vec2 {
        let (sin, cos) = (
            -self.before.out.dot(&self.after.way),
            self.before.out.dot(&self.after.out),
        );
        let rise = drawn_on.dot(&side.out);
        let is_blunt = cos > 0.0 && rise * MITRE_LIMIT < 1.0;
        if sin < 0.0 || is_blunt {
            return self.meeting().unwrap_or(side.out * side.width);
        }
        drawn_on * (side.width / rise.max(1e-9)).min(MITRE_LIMIT * side.width)
    }

    /// Vector from the corner to the point where both cut lines meet (m); `None`: the point is far away.
    fn meeting(&self) -> Option<Vec2> {
        let (n, m) = (self.before.out, self.after.out);
        let (p, q) = (self.before.width, self.after.width);
        let cos = n.dot(&m);
        let both = match (p - q).abs() < AT_CORNER {
            true => (n + m) * (p / (1.0 + cos)),
            false => (n * (p - q * cos) + m * (q - p * cos)) / (1.0 - cos * cos),
        };
        let is_near = both.norm() <= MITRE_LIMIT * p.max(q);
        is_near.then_some(both)
    }
}
