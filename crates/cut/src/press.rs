//! Fold marks of darts and pleats: short lines at the cut line where they are brought together, and arrows in
//! the direction in which they are pressed.

use crate::notch::{CutNotch, NOTCH_DEPTH};
use crate::notch_place::{AT_CORNER, corner_at};
use crate::notch_room::Room;
use crate::seams::{NamedSeam, Plane};
use toile_geometry::Vec2;
use toile_pattern::{NotchKind, Piece, PressArrow, Role};

/// The press arrows of a piece, mapped to the plane in which the piece is cut.
pub(crate) fn pressed(piece: &Piece, plane: &Plane) -> Vec<PressArrow> {
    let arrow = |arrow: &PressArrow| {
        let across = plane.vector(arrow.way);
        Some(PressArrow {
            at: plane.vector(arrow.at),
            way: across.try_normalize(1e-12)?,
            width: arrow.width * across.norm(),
            ..*arrow
        })
    };
    piece.pressed.iter().filter_map(arrow).collect()
}

/// A short line where a leg of a dart or a line of a pleat ends at the cut line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoldTick {
    /// Ends of the line (m), from the cut line inwards.
    pub ends: [Vec2; 2],
    /// Whether the line lies in the allowance, where it may be cut like a notch. If there is no allowance,
    /// the line runs into the cloth and is only drawn.
    pub in_allowance: bool,
}

/// Short lines where the extended legs of darts and lines of pleats meet the cut line. They run into the
/// allowance, as deep as notches; where there is no allowance, along the leg into the cloth. Omitted where a
/// notch stands.
pub(crate) fn fold_ticks(
    piece: &Piece,
    plane: &Plane,
    seam: &NamedSeam,
    (room, notches): (&Room, &[CutNotch]),
) -> Vec<FoldTick> {
    let mut ticks: Vec<FoldTick> = Vec::new();
    for [end, inner] in folded_ends(piece, plane, seam) {
        for tick in ticks_at([end, inner], seam, room) {
            let is_here = |at: Vec2| (at - tick.ends[0]).norm() < AT_CORNER;
            let is_notched = notches.iter().any(|notch| match notch.cut.is_empty() {
                true => is_here(notch.point),
                false => is_here(notch.on_cut),
            });
            if !is_notched && !ticks.iter().any(|known| is_here(known.ends[0])) {
                ticks.push(tick);
            }
        }
    }
    ticks
}

/// Ends, on the outline, of the legs of darts and the lines of pleats. Each comes with a second point of the
/// leg or line, farther inside the cloth.
fn folded_ends(piece: &Piece, plane: &Plane, seam: &NamedSeam) -> Vec<[Vec2; 2]> {
    let outline = &seam.line.outline;
    let legs = seam.line.darts.iter().flat_map(|dart| {
        let [first, second] = dart.legs.map(|leg| &outline[leg].curve);
        [[first.start(), first.end()], [second.end(), second.start()]]
    });
    let is_folded = |role| matches!(role, Some(Role::Crease | Role::Placement));
    let lines = piece.internal_lines.iter();
    let lines = lines.filter(|line| is_folded(line.name.role()));
    let lines = lines.filter_map(|line| {
        let [start, end] = [line.curves.first()?.start(), line.curves.last()?.end()];
        let [start, end] = [start, end].map(|at| plane.vector(at));
        Some([[start, end], [end, start]])
    });
    legs.chain(lines.flatten()).collect()
}

/// The short lines at one end of a leg or pleat line: one for each cut line that meets there.
fn ticks_at([end, inner]: [Vec2; 2], seam: &NamedSeam, room: &Room) -> Vec<FoldTick> {
    let outwards = corner_at(seam, end).map_or_else(Vec::new, |corner| corner.outwards_all());
    let ways: Vec<(Vec2, Vec2)> = outwards
        .into_iter()
        .filter_map(|outwards| Some((outwards, outwards.try_normalize(1e-9)?)))
        .collect();
    if ways.is_empty() {
        let way = (inner - end).try_normalize(1e-9);
        let tick = way.map(|way| FoldTick {
            ends: [end, end + way * NOTCH_DEPTH.min((inner - end).norm())],
            in_allowance: false,
        });
        return tick.into_iter().collect();
    }
    let in_allowance = |(outwards, way): (Vec2, Vec2)| {
        let at = room.cut_line(end, outwards)?;
        let axes = [Vec2::new(way.y, -way.x), -way];
        let (depth, _) = room.cut(NotchKind::Slit, (end, at), axes)?;
        Some(FoldTick {
            ends: [at, at - way * depth],
            in_allowance: true,
        })
    };
    ways.into_iter().filter_map(in_allowance).collect()
}
