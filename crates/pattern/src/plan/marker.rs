//! Plans changes of markers: new markers, other fabric, another order; pieces laid, moved, turned, turned
//! over, locked and taken off.

use super::impossible;
use super::names::{free_name, wished};
use crate::{
    ClothSettings, Edit, EditError, Entity, Evaluation, FabricId, Marker, MarkerId, MatchedMarks,
    OrderedPiece, OrderedSize, PiecePlacement, PieceRule,
};
use std::collections::{HashMap, HashSet};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// Plans to add a marker on a fabric for one garment: in the size that the pattern is drafted for, or for the
/// wearer's measurements. Returns the marker too. Without a name the marker is called "marker", the next
/// "marker 2".
///
/// # Errors
/// The fabric is missing; the name is taken or not allowed.
pub fn add_marker(
    evaluation: &Evaluation,
    name: Option<&str>,
    fabric: FabricId,
) -> Result<(Vec<Edit>, MarkerId), EditError> {
    let pattern = evaluation.pattern();
    let missing = || EditError::Missing(fabric.to_string());
    pattern.fabric(fabric).ok_or_else(missing)?;
    let owner = |name: &str| {
        pattern
            .marker_named(name)
            .map(|_| format!("marker {name:?}"))
    };
    let name = match name {
        Some(name) => wished(name, owner)?,
        None => free_name("marker", |name| owner(name).is_some()),
    };
    let mut ids = pattern.ids;
    let id: MarkerId = ids.take();
    let marker = Marker {
        id,
        name,
        fabric,
        order: vec![OrderedSize {
            size: evaluation.wearer().size,
            quantity: 1,
        }],
        ..Marker::default()
    };
    Ok((vec![Edit::Put(Entity::Marker(Arc::new(marker)))], id))
}

/// Plans to remove a marker.
///
/// # Errors
/// The marker is missing.
pub fn remove_marker(evaluation: &Evaluation, id: MarkerId) -> Result<Vec<Edit>, EditError> {
    found(evaluation, id)?;
    Ok(vec![Edit::Remove(id.into())])
}

/// Plans to give a marker another order. Pieces that are no longer ordered keep their placements, in case
/// they are ordered again.
///
/// # Errors
/// The marker is missing; a size is ordered twice or with quantity 0.
pub fn set_marker_order(
    evaluation: &Evaluation,
    id: MarkerId,
    order: Vec<OrderedSize>,
) -> Result<Vec<Edit>, EditError> {
    let marker = found(evaluation, id)?.clone();
    put(Marker { order, ..marker })
}

/// Plans to lay a marker on another fabric, and sets whether the marker keeps this fabric if the garment is
/// cut from another. Pieces keep their positions.
///
/// # Errors
/// The marker is missing.
pub fn set_marker_fabric(
    evaluation: &Evaluation,
    id: MarkerId,
    (fabric, keeps_fabric): (FabricId, bool),
) -> Result<Vec<Edit>, EditError> {
    let marker = found(evaluation, id)?.clone();
    put(Marker {
        fabric,
        keeps_fabric,
        ..marker
    })
}

/// Plans to change the cloth settings of a marker. Pieces keep their positions.
///
/// # Errors
/// The marker is missing; one of the settings is not allowed.
pub fn set_marker_cloth(
    evaluation: &Evaluation,
    id: MarkerId,
    cloth: ClothSettings,
) -> Result<Vec<Edit>, EditError> {
    let marker = found(evaluation, id)?.clone();
    put(Marker { cloth, ..marker })
}

/// Plans to remove one of a marker's rolls, counted from 0. Pieces on this roll lose their placements; but if
/// it was the only roll, pieces stay where they are, on as much fabric as needed.
///
/// # Errors
/// The marker or the roll is missing.
pub fn remove_marker_roll(
    evaluation: &Evaluation,
    id: MarkerId,
    roll: usize,
) -> Result<Vec<Edit>, EditError> {
    let mut marker = found(evaluation, id)?.clone();
    let mut rolls = marker.cloth.rolls.take().unwrap_or_default();
    if roll >= rolls.len() {
        let what = format!("marker {:?} has no roll {}", marker.name, roll + 1);
        return Err(impossible(what, "choose one of its rolls"));
    }
    rolls.remove(roll);
    if !rolls.is_empty() {
        let on = |laid: &PiecePlacement| usize::from(laid.roll);
        marker.placements.retain(|laid| on(laid) != roll);
        let after = marker.placements.iter_mut().filter(|laid| on(laid) > roll);
        after.for_each(|laid| laid.roll -= 1);
        marker.cloth.rolls = Some(rolls);
    }
    put(marker)
}

/// Plans to give a marker other rules for laying its pieces.
///
/// # Errors
/// The marker is missing; a value in one of the rules is not allowed; there are two rules for the same
/// pieces.
pub fn set_marker_rules(
    evaluation: &Evaluation,
    id: MarkerId,
    rules: Vec<PieceRule>,
) -> Result<Vec<Edit>, EditError> {
    let marker = found(evaluation, id)?.clone();
    put(Marker { rules, ..marker })
}

/// Plans to give a marker other sets of marks that must lie on the same place of the print.
///
/// # Errors
/// The marker is missing; a set has fewer than two marks.
pub fn set_matched_marks(
    evaluation: &Evaluation,
    id: MarkerId,
    matched: Vec<MatchedMarks>,
) -> Result<Vec<Edit>, EditError> {
    let marker = found(evaluation, id)?.clone();
    put(Marker { matched, ..marker })
}

/// Plans to lay all pieces of a marker anew, as a search has placed them. Locked pieces, pieces that are not
/// ordered, and pieces whose panel was removed keep their placements; other pieces without a new placement
/// lose theirs.
///
/// # Errors
/// The marker is missing; a piece is laid twice or at a position that is not finite; a locked piece
/// would move.
pub fn place_marker(
    evaluation: &Evaluation,
    id: MarkerId,
    placements: Vec<PiecePlacement>,
) -> Result<Vec<Edit>, EditError> {
    let mut marker = found(evaluation, id)?.clone();
    let cut: HashSet<OrderedPiece> = evaluation.pattern().ordered_pieces(&marker).collect();
    let new: HashMap<OrderedPiece, PiecePlacement> =
        placements.iter().map(|laid| (laid.piece, *laid)).collect();
    let moves = |laid: &&PiecePlacement| {
        let new = new.get(&laid.piece);
        let place = |laid: &PiecePlacement| (laid.at, laid.turn, laid.flipped, laid.roll);
        laid.locked && new.is_some_and(|new| place(new) != place(laid))
    };
    if let Some(laid) = marker.placements.iter().find(moves) {
        return Err(locked(evaluation, laid.piece));
    }
    let stays = |laid: &PiecePlacement| laid.locked || !cut.contains(&laid.piece);
    marker
        .placements
        .retain(|laid| stays(laid) && !new.contains_key(&laid.piece));
    marker.placements.extend(placements);
    put(marker)
}

/// Plans to lay some pieces of a marker: pieces without a placement, and pieces that lie elsewhere.
///
/// # Errors
/// The marker is missing; a piece is laid twice, is locked at its present place, or gets a position that is
/// not finite.
pub fn place_pieces(
    evaluation: &Evaluation,
    id: MarkerId,
    placements: &[PiecePlacement],
) -> Result<Vec<Edit>, EditError> {
    let mut marker = found(evaluation, id)?.clone();
    for new in placements {
        let known = |laid: &PiecePlacement| laid.piece == new.piece;
        match marker.placements.iter().position(known) {
            Some(k) if marker.placements[k].locked => return Err(locked(evaluation, new.piece)),
            Some(k) => marker.placements[k] = *new,
            None => marker.placements.push(*new),
        }
    }
    put(marker)
}

/// Plans to take pieces off a marker: they lose their placements.
///
/// # Errors
/// The marker is missing; a piece does not lie on the marker, or is locked.
pub fn take_off_pieces(
    evaluation: &Evaluation,
    id: MarkerId,
    pieces: &[OrderedPiece],
) -> Result<Vec<Edit>, EditError> {
    let mut marker = changed(evaluation, (id, pieces), |_| {})?;
    let is_off = |laid: &PiecePlacement| pieces.contains(&laid.piece);
    marker.placements.retain(|laid| !is_off(laid));
    put(marker)
}

/// Plans to move pieces of a marker by a displacement (m).
///
/// # Errors
/// The marker is missing; a piece does not lie on the marker, or is locked; the displacement is not finite.
pub fn move_pieces(
    evaluation: &Evaluation,
    (id, pieces): (MarkerId, &[OrderedPiece]),
    by: [f64; 2],
) -> Result<Vec<Edit>, EditError> {
    put(changed(evaluation, (id, pieces), |laid| {
        laid.at = [laid.at[0] + by[0], laid.at[1] + by[1]];
    })?)
}

/// Plans to turn pieces of a marker together about the point `centre` (m) by an angle, counter-clockwise
/// (rad).
///
/// # Errors
/// The marker is missing; a piece does not lie on the marker, or is locked; a number is not finite.
pub fn turn_pieces(
    evaluation: &Evaluation,
    (id, pieces): (MarkerId, &[OrderedPiece]),
    (angle, centre): (f64, [f64; 2]),
) -> Result<Vec<Edit>, EditError> {
    let [cos, sin] = direction(angle);
    put(changed(evaluation, (id, pieces), |laid| {
        let [x, y] = [laid.at[0] - centre[0], laid.at[1] - centre[1]];
        laid.at = [centre[0] + cos * x - sin * y, centre[1] + sin * x + cos * y];
        laid.turn = principal(laid.turn + angle);
    })?)
}

/// Plans to turn pieces of a marker over together, by mirroring them in a line along the warp at y = `line`
/// (m).
///
/// # Errors
/// The marker is missing; a piece does not lie on the marker, or is locked; the line is not finite.
pub fn flip_pieces(
    evaluation: &Evaluation,
    (id, pieces): (MarkerId, &[OrderedPiece]),
    line: f64,
) -> Result<Vec<Edit>, EditError> {
    put(changed(evaluation, (id, pieces), |laid| {
        laid.at[1] = 2.0 * line - laid.at[1];
        laid.turn = principal(-laid.turn);
        laid.flipped = !laid.flipped;
    })?)
}

/// Plans to lock pieces of a marker at their places, or to unlock them.
///
/// # Errors
/// The marker is missing; a piece does not lie on the marker.
pub fn lock_pieces(
    evaluation: &Evaluation,
    (id, pieces): (MarkerId, &[OrderedPiece]),
    is_locked: bool,
) -> Result<Vec<Edit>, EditError> {
    let mut marker = found(evaluation, id)?.clone();
    for &piece in pieces {
        laid(evaluation, &mut marker, piece)?.locked = is_locked;
    }
    put(marker)
}

fn found(evaluation: &Evaluation, id: MarkerId) -> Result<&Marker, EditError> {
    let marker = evaluation.pattern().marker(id);
    let marker = marker.ok_or_else(|| EditError::Missing(id.to_string()))?;
    Ok(marker)
}

/// The edit that puts a marker into the pattern; refused if the marker has a fault.
fn put(marker: Marker) -> Result<Vec<Edit>, EditError> {
    if let Some(fault) = marker.fault() {
        let what = format!("marker {:?}: {}", marker.name, fault.message);
        return Err(impossible(what, fault.hint));
    }
    Ok(vec![Edit::Put(Entity::Marker(Arc::new(marker)))])
}

/// A copy of the marker in which `change` has changed the placements of these pieces; refused if one of the
/// pieces is locked.
fn changed(
    evaluation: &Evaluation,
    (id, pieces): (MarkerId, &[OrderedPiece]),
    change: impl Fn(&mut PiecePlacement),
) -> Result<Marker, EditError> {
    let mut marker = found(evaluation, id)?.clone();
    for &piece in pieces {
        let own = laid(evaluation, &mut marker, piece)?;
        if own.locked {
            return Err(locked(evaluation, piece));
        }
        change(own);
    }
    Ok(marker)
}

fn laid<'m>(
    evaluation: &Evaluation,
    marker: &'m mut Marker,
    piece: OrderedPiece,
) -> Result<&'m mut PiecePlacement, EditError> {
    let name = &marker.name;
    let missing = || {
        impossible(
            format!(
                "{} does not lie on marker {name:?}",
                words(evaluation, piece)
            ),
            "lay it first",
        )
    };
    let placements = &mut marker.placements;
    match placements.iter().position(|known| known.piece == piece) {
        Some(k) => Ok(&mut placements[k]),
        None => Err(missing()),
    }
}

fn locked(evaluation: &Evaluation, piece: OrderedPiece) -> EditError {
    impossible(
        format!("{} is locked where it lies", words(evaluation, piece)),
        "unlock it first",
    )
}

/// Description of a piece, for messages.
fn words(evaluation: &Evaluation, piece: OrderedPiece) -> String {
    evaluation.pattern().piece_words(piece)
}

/// The equal angle above -PI and up to PI (rad); an angle in this range is returned unchanged.
fn principal(angle: f64) -> f64 {
    match angle {
        angle if angle > -PI && angle <= PI => angle,
        angle => PI - (PI - angle).rem_euclid(TAU),
    }
}

/// Cosine and sine of an angle (rad), exact for multiples of a quarter turn.
fn direction(angle: f64) -> [f64; 2] {
    let quarters = (angle / FRAC_PI_2).round();
    if (angle - quarters * FRAC_PI_2).abs() > 1e-12 {
        return [angle.cos(), angle.sin()];
    }
    match quarters.rem_euclid(4.0) as u8 {
        0 => [1.0, 0.0],
        1 => [0.0, 1.0],
        2 => [-1.0, 0.0],
        _ => [0.0, -1.0],
    }
}
