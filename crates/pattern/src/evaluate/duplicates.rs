//! Diagnostics for ids and names that are used twice.

use crate::{Code, Diagnostic, Pattern, Place, Severity};
use std::collections::HashSet;

const HINT: &str = "rename or renumber one of them";

/// Collects a diagnostic for each name that several parts with the same owner have.
struct Finder(Vec<Diagnostic>);

impl Finder {
    fn names<'a>(
        &mut self,
        severity: Severity,
        (owner, kind): (&str, &str),
        parts: impl Iterator<Item = (&'a str, Place)>,
    ) {
        let mut seen = HashSet::new();
        for (name, place) in parts {
            if !seen.insert(name) {
                let message = format!("{owner}two {kind} are called {name:?}");
                let code = Code::Duplicate;
                self.0
                    .push(Diagnostic::new(severity, code, place, message, HINT));
            }
        }
    }
}

/// Diagnostics for duplicates. Duplicate ids, and names that formulas or commands use, are errors, as a
/// reference would be ambiguous; a duplicate of a name that is only shown is a warning.
pub(super) fn duplicates(pattern: &Pattern) -> Vec<Diagnostic> {
    let (error, warning) = (Severity::Error, Severity::Warning);
    let mut finder = Finder(Vec::new());
    let sizes = pattern.sizes.iter().map(|s| (&*s.name, Place::Size(s.id)));
    finder.names(error, ("", "sizes"), sizes);
    let variables = pattern.variables.iter();
    let variables = variables.map(|v| (&*v.name, Place::Variable(v.id)));
    finder.names(error, ("", "variables"), variables);
    let fabrics = pattern.fabrics.iter();
    let fabrics = fabrics.map(|f| (&*f.name, Place::Fabric(f.id)));
    finder.names(warning, ("", "fabrics"), fabrics);
    let sheets = pattern.sheets.iter();
    let sheets = sheets.map(|s| (&*s.name, Place::Sheet(s.id)));
    finder.names(error, ("", "sheets"), sheets);
    let panels = pattern.panels.iter();
    let panels = panels.map(|p| (&*p.name, Place::Panel(p.id)));
    finder.names(error, ("", "panels"), panels);
    let seams = pattern.seams.iter().map(|s| (&*s.name, Place::Seam(s.id)));
    finder.names(error, ("", "seams"), seams);
    let markers = pattern.markers.iter();
    let markers = markers.map(|m| (&*m.name, Place::Marker(m.id)));
    finder.names(warning, ("", "markers"), markers);
    for panel in &pattern.panels {
        let owner = format!("panel {:?}: ", panel.name);
        let edges = panel.edges();
        let edges = edges.map(|e| (&*e.name, Place::Edge(panel.id, e.id)));
        finder.names(error, (&owner, "edges"), edges);
        let lines = panel.lines.iter();
        let lines = lines.map(|l| (&*l.name, Place::Line(panel.id, l.id)));
        finder.names(warning, (&owner, "lines"), lines);
        let notches = panel.notches.iter();
        let notches = notches.map(|n| (&*n.name, Place::Notch(panel.id, n.id)));
        finder.names(warning, (&owner, "notches"), notches);
        let operations = panel.operations.iter();
        let operations = operations.map(|o| (&*o.name, Place::Operation(panel.id, o.id)));
        finder.names(warning, (&owner, "operations"), operations);
    }
    for sheet in &pattern.sheets {
        let owner = format!("sheet {:?}: ", sheet.name);
        let points = sheet.points.iter();
        let points = points.map(|p| (&*p.name, Place::Point(p.id)));
        finder.names(error, (&owner, "points"), points);
        let curves = sheet.curves.iter();
        let curves = curves.map(|c| (&*c.name, Place::Curve(c.id)));
        finder.names(error, (&owner, "curves"), curves);
    }
    let mut found = finder.0;
    let mut ids = HashSet::new();
    for (id, place) in pattern.parts() {
        if !ids.insert(id.number()) {
            let message = format!("two parts have the id {id}");
            found.push(Diagnostic::error(Code::Duplicate, place, message, HINT));
        }
    }
    found
}
