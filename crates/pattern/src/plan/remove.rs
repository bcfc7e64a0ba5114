//! Removes parts.
//!
//! # Decided with
//! - [`crate::document::Pattern::users`] (`references.rs`), [`crate::fields::references()`]: which parts name a part;
//! - [`crate::document::Pattern::apply`] (`apply.rs`): names of removed parts are kept, unknown ids refused;
//! - [`crate::plan::join_edges`]: edges at a corner that goes;
//! - [`crate::diagnostic::Code::MissingReference`]: lost parts told;
//! - [`crate::evaluate::Evaluation::take_changes`] (`graph.rs`): computed anew once the part is back.

use super::divide::join_edges;
use super::impossible;
use super::lookup::after;
use super::names::free_name;
use crate::{
    Edge, Edit, EditError, Entity, Evaluation, Head, Ids, Line, LineKind, Panel, PanelId, PartId,
    Pattern, PointId,
};
use std::collections::HashSet;
use std::sync::Arc;

/// Plans to remove a point. If it is a corner of a panel's line, the edges that meet there are joined; any
/// other point is removed from its sheet, and parts constructed from it have no shape until it comes back.
///
/// # Errors
/// The point is missing, or the line would have too few corners left.
pub fn remove_point(
    evaluation: &Evaluation,
    (panel, point): (PanelId, PointId),
) -> Result<Vec<Edit>, EditError> {
    let owner = evaluation.pattern().panel(panel);
    let mut edges = owner.into_iter().flat_map(|panel| panel.edges());
    if edges.any(|edge| edge.ends[1] == point) {
        return join_edges(evaluation, (panel, point));
    }
    Ok(vec![Edit::Remove(point.into())])
}

/// Plans to remove selected parts of any kinds. At removed corners of panels that stay, edges are joined
/// first; an edge is removed from the end or the middle of an internal line. Other parts that refer to
/// removed ones stay, and are valid again if these come back.
///
/// # Errors
/// A part is missing; a panel would lose its outline; a closed line would lose an edge or too many corners.
pub fn remove_parts(evaluation: &Evaluation, parts: &[PartId]) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    let known: HashSet<PartId> = pattern.parts().into_iter().map(|(id, _)| id).collect();
    if let Some(missing) = parts.iter().find(|part| !known.contains(part)) {
        return Err(EditError::Missing(missing.to_string()));
    }
    let gone: HashSet<PartId> = parts.iter().copied().collect();
    let mut edits = Vec::new();
    let mut ids = pattern.ids;
    for panel in pattern
        .panels
        .iter()
        .filter(|panel| !gone.contains(&panel.id.into()))
    {
        edits.extend(thinned(panel, &gone, &mut ids)?);
    }
    let mut work = after(evaluation, &edits)?;
    for &part in parts {
        if let PartId::Point(point) = part
            && !is_on_removed_sheet(pattern, &gone, part)
        {
            for (panel, corner) in corners(work.pattern(), &gone, point) {
                let more = join_edges(&work, (panel, corner))?;
                work = after(&work, &more)?;
                edits.extend(more);
            }
        }
    }
    if let Some(size) = pattern.base_size
        && gone.contains(&size.into())
    {
        edits.push(Edit::Put(Entity::Head(Head {
            name: pattern.name.clone(),
            unit: pattern.unit,
            base_size: None,
        })));
    }
    let left: HashSet<PartId> = work
        .pattern()
        .parts()
        .into_iter()
        .map(|(id, _)| id)
        .collect();
    let mut told = HashSet::new();
    for &part in parts {
        let is_inside = matches!(
            part,
            PartId::Line(_) | PartId::Edge(_) | PartId::Notch(_) | PartId::Operation(_)
        );
        let follows = is_inside || is_on_removed_sheet(pattern, &gone, part);
        if !follows && left.contains(&part) && told.insert(part) {
            edits.push(Edit::Remove(part));
        }
    }
    Ok(edits)
}

/// Whether a point or curve is removed together with its sheet.
fn is_on_removed_sheet(pattern: &Pattern, gone: &HashSet<PartId>, part: PartId) -> bool {
    let sheet = match part {
        PartId::Point(id) => pattern.point(id).map(|found| found.0),
        PartId::Curve(id) => pattern.curve(id).map(|found| found.0),
        PartId::Size(_)
        | PartId::Variable(_)
        | PartId::Fabric(_)
        | PartId::Sheet(_)
        | PartId::Panel(_)
        | PartId::Line(_)
        | PartId::Edge(_)
        | PartId::Notch(_)
        | PartId::Operation(_)
        | PartId::Seam(_)
        | PartId::Marker(_)
        | PartId::Guide(_) => None,
    };
    sheet.is_some_and(|sheet| gone.contains(&sheet.id.into()))
}

/// Panels that stay and have the point as a corner between two edges, each with the point.
fn corners(pattern: &Pattern, gone: &HashSet<PartId>, point: PointId) -> Vec<(PanelId, PointId)> {
    let between = |line: &Line| {
        let ends_here = line.edges.iter().any(|edge| edge.ends[1] == point);
        let starts_here = line.edges.iter().any(|edge| edge.ends[0] == point);
        let returns = line.edges.first().map(|edge| edge.ends[0]) == Some(point);
        ends_here && starts_here && (line.is_closed() || !returns)
    };
    let panels = pattern.panels.iter();
    let kept = panels.filter(|panel| !gone.contains(&panel.id.into()));
    let with = kept.filter(|panel| panel.lines.iter().any(between));
    with.map(|panel| (panel.id, point)).collect()
}

/// The edit that puts a panel without its removed parts. `None`: none of its parts is removed.
fn thinned(
    panel: &Arc<Panel>,
    gone: &HashSet<PartId>,
    ids: &mut Ids,
) -> Result<Option<Edit>, EditError> {
    let mut changed = (**panel).clone();
    changed
        .notches
        .retain(|notch| !gone.contains(&notch.id.into()));
    changed
        .operations
        .retain(|operation| !gone.contains(&operation.id.into()));
    changed.lines.clear();
    for line in &panel.lines {
        let goes = |edge: &Edge| gone.contains(&edge.id.into());
        if gone.contains(&line.id.into()) || line.edges.iter().all(goes) {
            if line.kind == LineKind::Outline {
                return Err(impossible(
                    format!("panel {:?} would have no outline", panel.name),
                    "remove the panel itself",
                ));
            }
            continue;
        }
        if let Some(edge) = line.edges.iter().find(|edge| goes(edge))
            && line.is_closed()
        {
            return Err(impossible(
                format!(
                    "line {:?} of panel {:?} would be open without its edge {:?}",
                    line.name, panel.name, edge.name
                ),
                "remove a corner of the edge, or the whole line",
            ));
        }
        let stays = line.edges.split(goes).filter(|edges| !edges.is_empty());
        for (k, edges) in stays.enumerate() {
            let taken = |name: &str| {
                let mut lines = panel.lines.iter().chain(&changed.lines);
                lines.any(|known| known.name == name)
            };
            let (id, name) = match k {
                0 => (line.id, line.name.clone()),
                _ => (ids.take(), free_name(&line.name, taken)),
            };
            changed.lines.push(Line {
                id,
                name,
                kind: line.kind,
                by: line.by,
                edges: edges.to_vec(),
            });
        }
    }
    let is_thinner = changed != **panel;
    Ok(is_thinner.then(|| Edit::Put(Entity::Panel(Arc::new(changed)))))
}
