//! Diagnostics for markers that refer to removed parts.

use crate::{Code, Diagnostic, Marker, PartId, Pattern, Place};
use std::collections::BTreeMap;

/// What waits on markers for a fabric, panel or size to return: one finding for each marker and lost
/// part. The rest of the marker can be cut.
pub(super) fn waiting(pattern: &Pattern) -> Vec<Diagnostic> {
    let markers = pattern.markers.iter();
    markers.flat_map(|marker| of(pattern, marker)).collect()
}

fn of(pattern: &Pattern, marker: &Marker) -> Vec<Diagnostic> {
    let mut pieces: BTreeMap<PartId, usize> = BTreeMap::new();
    let size_is_there = |id| pattern.sizes.iter().any(|size| size.id == id);
    for ordered in &marker.order {
        if let Some(size) = ordered.size.filter(|id| !size_is_there(*id)) {
            pieces.insert(size.into(), 0);
        }
    }
    for laid in &marker.placements {
        let panel = laid.piece.panel;
        let lost = match (laid.piece.size, pattern.panel(panel)) {
            (_, None) => panel.into(),
            (Some(size), _) if !size_is_there(size) => size.into(),
            _ => continue,
        };
        *pieces.entry(lost).or_default() += 1;
    }
    let mut found = Vec::new();
    let mut tell = |message: String, hint| {
        let (code, place) = (Code::MissingReference, Place::Marker(marker.id));
        found.push(Diagnostic::warning(code, place, message, hint));
    };
    let name = &marker.name;
    let fabric = marker.cloth.fabric;
    if pattern.fabric(fabric).is_none() {
        tell(
            format!("marker {name:?} is laid on {fabric}, which is gone"),
            "give the marker another fabric, or undo",
        );
    }
    for (part, count) in pieces {
        let wait = match count {
            0 => "is ordered".to_owned(),
            1 => "1 piece of it waits".to_owned(),
            count => format!("{count} pieces of it wait"),
        };
        tell(
            format!("marker {name:?}: {part} is gone, and {wait}"),
            "undo, or take the pieces off the marker and out of its order",
        );
    }
    found
}
