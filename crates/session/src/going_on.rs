//! Going on from markers made before: where their pieces lie, and which of them stay there.

use crate::{NestOptions, SessionError};
use std::path::Path;
use toile_interchange::{MarkerFile, read_marker_json, read_text};
use toile_nesting::{Item, Locked, Marker, Placement, Unplaced};

/// The markers that a job goes on from.
pub(crate) fn read_starts(options: &NestOptions) -> Result<Vec<MarkerFile>, SessionError> {
    let read = |path: &std::path::PathBuf| read_start(path);
    let starts: Vec<MarkerFile> = options.from.iter().map(read).collect::<Result<_, _>>()?;
    let there = |name: &str| {
        starts
            .iter()
            .flat_map(|f| &f.pieces)
            .any(|p| p.name == name)
    };
    match options.locked.iter().find(|name| !there(name)) {
        None => Ok(starts),
        Some(name) => {
            let mut names: Vec<&str> = starts
                .iter()
                .flat_map(|f| &f.pieces)
                .map(|p| p.name.as_str())
                .collect();
            names.sort_unstable();
            names.dedup();
            Err(SessionError::Unknown {
                kind: "piece to lock",
                name: name.clone(),
                hint: format!("the marker to go on from has: {}", names.join(", ")),
            })
        }
    }
}

fn read_start(path: &Path) -> Result<MarkerFile, SessionError> {
    read_marker_json(&read_text(path)?).map_err(|error| SessionError::Format {
        path: path.to_owned(),
        error,
    })
}

/// The start that has pieces of these names, if any: the one with the most.
pub(crate) fn start_of(starts: &[MarkerFile], items: &[Item]) -> Option<Marker> {
    let marker = |file: &MarkerFile| start_from(file, items);
    starts
        .iter()
        .map(marker)
        .filter(|m| !m.placements.is_empty())
        .max_by_key(|m| m.placements.len())
}

/// A file's placements as those of items: by number and name, or by name alone.
fn start_from(file: &MarkerFile, items: &[Item]) -> Marker {
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
            reason: String::new(),
        }));
    }
    marker
}

/// Locks the pieces of some names where a marker has them.
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
