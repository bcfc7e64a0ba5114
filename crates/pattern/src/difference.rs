//! The edit that turns one state of a document into another.

use crate::{Edit, Pattern, Seam};
use std::sync::Arc;

/// The edit that makes `from` equal to `to`, id counters apart. Shared parts are not compared.
pub fn difference(from: &Pattern, to: &Pattern) -> Edit {
    let mut edits = Vec::new();
    if from.name != to.name {
        edits.push(Edit::SetName(to.name.clone()));
    }
    if from.unit != to.unit {
        edits.push(Edit::SetUnit(to.unit));
    }
    sizes(from, to, &mut edits);
    variables(from, to, &mut edits);
    parts(from, to, &mut edits);
    let mut edits = edits.into_iter();
    match (edits.next(), edits.len()) {
        (Some(only), 0) => only,
        (first, _) => Edit::Many(first.into_iter().chain(edits).collect()),
    }
}

fn sizes(from: &Pattern, to: &Pattern, edits: &mut Vec<Edit>) {
    if from.sizes != to.sizes {
        for size in &from.sizes {
            if to.size(&size.name).is_none() {
                edits.push(Edit::RemoveSize(size.name.clone()));
            }
        }
        for (at, size) in to.sizes.iter().enumerate() {
            edits.push(Edit::PutSize {
                at,
                size: size.clone(),
            });
        }
    }
    let kept = from
        .base_size
        .as_deref()
        .filter(|name| to.size(name).is_some());
    if kept != to.base_size.as_deref() {
        edits.push(Edit::SetBaseSize(to.base_size.clone()));
    }
}

fn variables(from: &Pattern, to: &Pattern, edits: &mut Vec<Edit>) {
    if from.variables == to.variables {
        return;
    }
    for variable in &from.variables {
        if !to.variables.iter().any(|v| v.name == variable.name) {
            edits.push(Edit::RemoveVariable(variable.name.clone()));
        }
    }
    for (at, variable) in to.variables.iter().enumerate() {
        edits.push(Edit::PutVariable {
            at,
            variable: variable.clone(),
        });
    }
}

/// Fabrics that panels need come before them, those they free go after them, seams last.
fn parts(from: &Pattern, to: &Pattern, edits: &mut Vec<Edit>) {
    for (at, fabric) in to.fabrics.iter().enumerate() {
        if !from.fabrics.get(at).is_some_and(|old| same(old, fabric)) {
            edits.push(Edit::PutFabric {
                at,
                fabric: (**fabric).clone(),
            });
        }
    }
    let removed: Vec<_> = from
        .panels
        .iter()
        .filter(|panel| to.panel(panel.id).is_none())
        .map(|panel| panel.id)
        .collect();
    edits.extend(removed.iter().map(|id| Edit::RemovePanel(*id)));
    let stays = |seam: &&Arc<Seam>| seam.spans().all(|span| !removed.contains(&span.panel));
    let seams: Vec<_> = from.seams.iter().filter(stays).collect();
    for (at, panel) in to.panels.iter().enumerate() {
        let old = from.panels.iter().find(|old| old.id == panel.id);
        if !old.is_some_and(|old| same(old, panel)) {
            edits.push(Edit::PutPanel {
                at,
                panel: Box::new((**panel).clone()),
            });
        }
    }
    for fabric in &from.fabrics {
        if to.fabric(fabric.id).is_none() {
            edits.push(Edit::RemoveFabric(fabric.id));
        }
    }
    for seam in &seams {
        if to.seam(seam.id).is_none() {
            edits.push(Edit::RemoveSeam(seam.id));
        }
    }
    for (at, seam) in to.seams.iter().enumerate() {
        let old = seams.iter().find(|old| old.id == seam.id);
        if !old.is_some_and(|old| same(old, seam)) {
            edits.push(Edit::PutSeam {
                at,
                seam: (**seam).clone(),
            });
        }
    }
}

fn same<T: PartialEq>(a: &Arc<T>, b: &Arc<T>) -> bool {
    Arc::ptr_eq(a, b) || a == b
}
