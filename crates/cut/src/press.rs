//! How the darts and pleats of a piece are folded: short lines at the cut line where they are brought together, and
//! arrows to where they are pressed.

use crate::notch::{CutNotch, NOTCH_DEPTH};
use crate::notch_place::{AT_CORNER, corner_at};
use crate::notch_room::Room;
use crate::seams::{NamedSeam, Plane};
use toile_geometry::Vec2;
use toile_pattern::{NotchKind, Piece, PressArrow, Role};

/// The arrows of a piece in the plane it is cut in.
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

/// Lines into the allowance where the legs of darts and the lines of pleats, drawn on, meet the cut line, as deep as
/// notches; where there is no allowance, along them into the cloth. None where a notch is.
pub(crate) fn fold_ticks(
    piece: &Piece,
    plane: &Plane,
    seam: &NamedSeam,
    (room, notches): (&Room, &[CutNotch]),
) -> Vec<[Vec2; 2]> {
    let mut ticks: Vec<[Vec2; 2]> = Vec::new();
    for [end, inner] in folded_ends(piece, plane, seam) {
        for [from, to] in ticks_at([end, inner], seam, room) {
            let is_here = |at: Vec2| (at - from).norm() < AT_CORNER;
            let is_notched = notches.iter().any(|notch| match notch.cut.is_empty() {
                true => is_here(notch.point),
                false => is_here(notch.on_cut),
            });
            if !is_notched && !ticks.iter().any(|tick| is_here(tick[0])) {
                ticks.push([from, to]);
            }
        }
    }
    ticks
}

/// Ends on the outline of what is folded, each with a place further along it into the cloth.
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

/// The lines at one end: one for each cut line that meets there.
fn ticks_at([end, inner]: [Vec2; 2], seam: &NamedSeam, room: &Room) -> Vec<[Vec2; 2]> {
    let outwards = corner_at(seam, end).map_or_else(Vec::new, |corner| corner.outwards_all());
    let cut = outwards.into_iter().filter_map(|outwards| {
        let way = outwards.try_normalize(1e-9)?;
        let at = room.cut_line(end, outwards)?;
        let axes = [Vec2::new(way.y, -way.x), -way];
        let (depth, _) = room.cut(NotchKind::Slit, (end, at), axes)?;
        Some([at, at - way * depth])
    });
    let mut found: Vec<[Vec2; 2]> = cut.collect();
    if let (true, Some(way)) = (found.is_empty(), (inner - end).try_normalize(1e-9)) {
        found.push([end, end + way * NOTCH_DEPTH.min((inner - end).norm())]);
    }
    found
}
