//! Diagnostics for markers that refer to removed parts.

use crate::{Code, Diagnostic, Marker, PartId, Pattern, Place, RuledPieces};
use std::collections::{BTreeMap, BTreeSet};

/// Diagnostics for markers that refer to a removed fabric, panel or size: one for each marker and removed
/// part. The rest of such a marker can still be cut.
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
    let fabric = marker.fabric;
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
    for part in ruled(pattern, marker) {
        tell(
            format!("marker {name:?}: {part} is gone, and a rule of the marker names it"),
            "undo, or take the rule out of the marker",
        );
    }
    let marks = marker.matched.iter().flat_map(|set| &set.0);
    let is_lost = |panel, notch| {
        let owner = pattern.panel(panel);
        !owner.is_some_and(|owner| owner.notches.iter().any(|own| own.id == notch))
    };
    let lost = marks.filter(|mark| is_lost(mark.panel, mark.notch)).count();
    if lost > 0 {
        tell(
            format!("marker {name:?}: of the marks that match {lost} are gone"),
            "undo, or take them out of the marker",
        );
    }
    found
}

/// Removed panels and fabrics that are named by rules of a marker.
fn ruled(pattern: &Pattern, marker: &Marker) -> BTreeSet<PartId> {
    let mut lost = BTreeSet::new();
    for rule in &marker.rules {
        if let RuledPieces::Panel(panel) | RuledPieces::Copy(panel, _) = rule.pieces
            && pattern.panel(panel).is_none()
        {
            lost.insert(panel.into());
        }
        let also = rule.also.iter().flatten().map(|also| also.fabric);
        let fabrics = rule.fabric.into_iter().chain(also);
        let gone = fabrics.filter(|fabric| pattern.fabric(*fabric).is_none());
        lost.extend(gone.map(PartId::from));
    }
    lost
}
