//! Pieces of layers that this program wrote, by the kinds of their lines.

use super::drawing::Drawing;
use super::join::ends;
use super::kinds::LineKind;
use super::piece::SvgPiece;
use super::region::Region;
use crate::Loss;
use crate::drawn::piece::DrawnLine;
use toile_geometry::Vec2;
use toile_pattern::NotchKind;

/// Groups that hold a panel of this program, in the order of the file.
pub(super) fn groups(drawing: &Drawing) -> Vec<usize> {
    let groups = 0..drawing.groups.len();
    groups
        .filter(|&group| drawing.groups[group].panel.is_some())
        .collect()
}

/// The piece in a group that is no panel yet, and what was left out; `None`, with a loss, without a closed line.
pub(super) fn new_piece(
    drawing: &Drawing,
    group: usize,
    losses: &mut Vec<Loss>,
) -> Option<SvgPiece> {
    let found = piece(drawing, group, losses);
    if found.is_none() {
        let why = "none of its lines is a closed outline";
        losses.push(Loss::at(name(drawing, group), "a panel", why));
    }
    found
}

/// The name of a group.
fn name(drawing: &Drawing, group: usize) -> String {
    let own = &drawing.groups[group];
    own.label.clone().unwrap_or_else(|| own.id.clone())
}

/// The piece in a group, and what was left out; `None` without a closed line.
pub(super) fn piece(drawing: &Drawing, group: usize, losses: &mut Vec<Loss>) -> Option<SvgPiece> {
    let mut piece = SvgPiece {
        name: name(drawing, group),
        ..SvgPiece::default()
    };
    let mut told = None;
    let mut open = 0;
    for line in &drawing.lines {
        let element = drawing.element(line);
        if !drawing.is_within(element.group, group) {
            continue;
        }
        let shape = line.shape.clone();
        match element.kind {
            Some(LineKind::Sew) if shape.is_closed && piece.sew.is_none() => {
                piece.sew = Some(shape);
            }
            Some(LineKind::Cut) if shape.is_closed && piece.cut.is_none() => {
                piece.cut = Some(shape);
            }
            Some(LineKind::Hole) if shape.is_closed => piece.holes.push(shape),
            Some(LineKind::Grain) if !shape.is_closed => {
                piece.grain.get_or_insert(ends(&shape));
            }
            Some(LineKind::Notch(kind)) => {
                // A notch of several lines is placed by the first one.
                if told != Some(line.element) {
                    piece.notches.push((notch_place(&shape, kind), kind));
                }
                told = Some(line.element);
            }
            Some(LineKind::Internal | LineKind::Sew | LineKind::Cut) | None => {
                piece.inside.push(shape);
            }
            Some(LineKind::Hole | LineKind::Grain) => open += 1,
        }
    }
    if open > 0 {
        losses.push(Loss {
            count: open,
            ..Loss::at(
                &piece.name,
                "holes and grain lines",
                "holes are closed lines, grain lines open ones",
            )
        });
    }
    let outline = piece.outline()?;
    let region = Region::of(outline);
    let all = piece.inside.len();
    let gap = 0.01;
    piece
        .inside
        .retain(|line| region.holds(&super::region::places(line), gap));
    if piece.inside.len() < all {
        losses.push(Loss {
            count: all - piece.inside.len(),
            ..Loss::at(
                &piece.name,
                "lines beyond the outline",
                "they mark nothing on it",
            )
        });
    }
    Some(piece)
}

/// The place on the edge of the cloth of a notch by its first line.
fn notch_place(line: &DrawnLine, kind: NotchKind) -> Vec2 {
    let [first, last] = ends(line);
    match kind {
        NotchKind::Slit | NotchKind::T | NotchKind::Check => first,
        NotchKind::V | NotchKind::Castle => (first + last) * 0.5,
    }
}
