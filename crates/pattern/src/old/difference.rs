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
    let old: Vec<_> = from.fabrics.iter().collect();
    for (at, fabric) in arranged(old, &to.fabrics, |fabric| fabric.id) {
        edits.push(Edit::PutFabric {
            at,
            fabric: (**fabric).clone(),
        });
    }
    let (kept, removed): (Vec<_>, Vec<_>) = from
        .panels
        .iter()
        .partition(|panel| to.panel(panel.id).is_some());
    edits.extend(removed.iter().map(|panel| Edit::RemovePanel(panel.id)));
    for (at, panel) in arranged(kept, &to.panels, |panel| panel.id) {
        edits.push(Edit::PutPanel {
            at,
            panel: Box::new((**panel).clone()),
        });
    }
    for fabric in &from.fabrics {
        if to.fabric(fabric.id).is_none() {
            edits.push(Edit::RemoveFabric(fabric.id));
        }
    }
    let stays = |seam: &Seam| {
        let gone = |id| removed.iter().any(|panel| panel.id == id);
        !seam.spans().any(|span| gone(span.panel))
    };
    let (kept, removed): (Vec<_>, Vec<_>) = from
        .seams
        .iter()
        .filter(|seam| stays(seam))
        .partition(|seam| to.seam(seam.id).is_some());
    edits.extend(removed.iter().map(|seam| Edit::RemoveSeam(seam.id)));
    for (at, seam) in arranged(kept, &to.seams, |seam| seam.id) {
        edits.push(Edit::PutSeam {
            at,
            seam: (**seam).clone(),
        });
    }
}

/// The parts that must be put, and where, so that the list begins with `to` in its order.
fn arranged<'a, T: PartialEq, I: PartialEq>(
    mut list: Vec<&'a Arc<T>>,
    to: &'a [Arc<T>],
    id: impl Fn(&T) -> I,
) -> Vec<(usize, &'a Arc<T>)> {
    let mut puts = Vec::new();
    for (at, part) in to.iter().enumerate() {
        if list.get(at).is_some_and(|old| same(old, part)) {
            continue;
        }
        list.retain(|old| id(old) != id(part));
        list.insert(at.min(list.len()), part);
        puts.push((at, part));
    }
    puts
}

fn same<T: PartialEq>(a: &Arc<T>, b: &Arc<T>) -> bool {
    Arc::ptr_eq(a, b) || a == b
}
