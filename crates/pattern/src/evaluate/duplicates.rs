//! Ids and names that are taken twice.

use crate::{Code, Diagnostic, Pattern, Place};
use std::collections::HashSet;

/// Ids must be unique, or seams would mean two things; names, or formulas would.
pub(super) fn duplicates(pattern: &Pattern) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let mut report = |place: Place, message: String| {
        found.push(Diagnostic::error(
            Code::Duplicate,
            place,
            message,
            "rename or renumber one of them",
        ));
    };
    let mut seen = HashSet::new();
    for variable in &pattern.variables {
        if !seen.insert(variable.name.as_str()) {
            let words = format!("two variables are called {:?}", variable.name);
            report(Place::Variable(variable.id), words);
        }
    }
    let mut seen = HashSet::new();
    for panel in &pattern.panels {
        if !seen.insert(panel.name.as_str()) {
            let words = format!("two panels are called {:?}", panel.name);
            report(Place::Panel(panel.id), words);
        }
        let mut edges = HashSet::new();
        for edge in panel.edges() {
            if !edges.insert(edge.name.as_str()) {
                let words = format!("panel {:?}: two edges {:?}", panel.name, edge.name);
                report(Place::Edge(panel.id, edge.id), words);
            }
        }
    }
    for sheet in &pattern.sheets {
        let mut points = HashSet::new();
        for point in &sheet.points {
            if !points.insert(point.name.as_str()) {
                let words = format!("sheet {:?}: two points {:?}", sheet.name, point.name);
                report(Place::Point(point.id), words);
            }
        }
    }
    let mut ids = HashSet::new();
    for (id, place) in pattern.parts() {
        if !ids.insert(id.number()) {
            report(place, format!("two parts have the id {id}"));
        }
    }
    found
}
