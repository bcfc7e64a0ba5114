//! Starts a search from an existing marker: reads its placements and locks.

use crate::MarkerError;
use toile_interchange::MarkerFile;
use toile_nesting::{Item, Locked, Marker, Placement, Strip, Unplaced};

/// Refuses a name to lock that is on none of the starting markers.
pub(crate) fn check_names(starts: &[MarkerFile], locked: &[String]) -> Result<(), MarkerError> {
    let laid = || starts.iter().flat_map(|file| &file.pieces);
    let is_there = |name: &str| laid().any(|piece| piece.name == name);
    match locked.iter().find(|name| !is_there(name)) {
        None => Ok(()),
        Some(name) => {
            let mut names: Vec<&str> = laid().map(|piece| &*piece.name).collect();
            names.sort_unstable();
            names.dedup();
            Err(MarkerError::Unknown {
                kind: "piece to lock",
                name: name.clone(),
                hint: format!("the marker to go on from has: {}", names.join(", ")),
            })
        }
    }
}

/// The starting marker for a fabric: the one with the most pieces of these names, the first of equals, `None`
/// if none has any. A file that names no fabric fits every fabric.
pub(crate) fn start_of(
    starts: &[MarkerFile],
    fabric: &str,
    (items, strip): (&[Item], &Strip),
) -> Option<Marker> {
    let of_fabric = |file: &&MarkerFile| file.fabric.name.as_deref().is_none_or(|n| n == fabric);
    let markers = starts.iter().filter(of_fabric);
    let mut best: Option<Marker> = None;
    for marker in markers.map(|file| start_from(file, items, strip)) {
        let most = best.as_ref().map_or(0, |b| b.placements.len());
        if marker.placements.len() > most {
            best = Some(marker);
        }
    }
    best
}

/// The placements of a file assigned to items: by number and name, or by name alone.
fn start_from(file: &MarkerFile, items: &[Item], strip: &Strip) -> Marker {
    let mut marker = Marker::default();
    let mut left: Vec<Vec<u32>> = items.iter().map(|i| (0..i.quantity).collect()).collect();
    for piece in &file.pieces {
        let same = |k: &usize| items[*k].name == piece.name && !left[*k].is_empty();
        let own = Some(piece.item).filter(|k| *k < items.len()).filter(same);
        let Some(item) = own.or_else(|| (0..items.len()).find(same)) else {
            continue;
        };
        let free = &mut left[item];
        let at = free.iter().position(|&c| c == piece.copy).unwrap_or(0);
        marker.placements.push(Placement {
            item,
            copy: free.remove(at),
            turn: piece.turn.to_radians(),
            mirrored: piece.face_down,
            translation: toile_geometry::Vec2::from(piece.at),
        });
    }
    for (item, copies) in left.iter().enumerate() {
        marker.unplaced.extend(copies.iter().map(|&copy| Unplaced {
            item,
            copy,
            reason: "it does not lie on the marker gone on from; search longer".to_owned(),
        }));
    }
    marker.measure(items, strip);
    marker
}

/// Refuses a name to lock if its piece is on no starting marker of its fabric.
pub(crate) fn check_locks<'a>(
    items: impl Iterator<Item = &'a Item>,
    names: &[String],
) -> Result<(), MarkerError> {
    let held: Vec<&str> = items
        .filter(|item| !item.locked.is_empty())
        .map(|item| item.name.as_str())
        .collect();
    match names.iter().find(|name| !held.contains(&name.as_str())) {
        None => Ok(()),
        Some(name) => Err(MarkerError::Conflict(format!(
            "piece {name:?} cannot be locked: no marker to go on from has it on the fabric it is laid on; give that fabric's marker with --from"
        ))),
    }
}

/// Locks the pieces with certain names that lie on the starting marker.
pub(crate) fn lock(items: &mut [Item], start: &Marker, names: &[String]) {
    for placement in &start.placements {
        let item = &mut items[placement.item];
        let known = item.locked.iter().any(|l| l.copy == placement.copy);
        if names.contains(&item.name) && !known {
            item.locked.push(Locked {
                copy: placement.copy,
                turn: placement.turn,
                mirrored: placement.mirrored,
                translation: placement.translation,
            });
        }
    }
}
