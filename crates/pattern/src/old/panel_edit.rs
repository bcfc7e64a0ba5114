//! Edits inside a panel.

use crate::apply::{impossible, name_allowed};
use crate::formula::Mentioned;
use crate::numbers::all_finite;
use crate::{
    DartShape, DartTip, EdgeCurve, EdgeId, EditError, IdCounters, Panel, PanelEdit, PanelId,
    Pattern, PointId, PointPlace,
};
use std::collections::BTreeSet;
use std::sync::Arc;

impl Pattern {
    pub(crate) fn change_panel(&mut self, id: PanelId, edit: PanelEdit) -> Result<(), EditError> {
        let k = self.panel_position(id)?;
        let mut panel = (*self.panels[k]).clone();
        let old_name = panel.name.clone();
        match edit {
            PanelEdit::Rename(name) => {
                name_allowed(&name)?;
                self.rewrite(&Mentioned::Panel(old_name.into()), &name)?;
                panel = (*self.panels[k]).clone();
                panel.name = name;
            }
            PanelEdit::RenamePoint { point, name } => {
                let was = panel.point(point).ok_or_else(|| missing(&point))?;
                let old = Mentioned::Point(old_name.into(), was.name.as_str().into());
                name_allowed(&name)?;
                self.rewrite(&old, &name)?;
                panel = (*self.panels[k]).clone();
                if let Some(found) = panel.points.iter_mut().find(|p| p.id == point) {
                    found.name = name;
                }
            }
            PanelEdit::RenameEdge { edge, name } => {
                let was = panel.edge(edge).ok_or_else(|| missing(&edge))?;
                let old = Mentioned::Edge(old_name.into(), was.name.as_str().into());
                name_allowed(&name)?;
                self.rewrite(&old, &name)?;
                panel = (*self.panels[k]).clone();
                if let Some(found) = panel.edge_mut(edge) {
                    found.name = name;
                }
            }
            PanelEdit::SplitEdge {
                edge,
                at,
                points,
                curves,
                new_edge,
                name,
            } => {
                let mut part = crate::split::Part { edge, at, new_edge };
                part.split(&mut panel, points, curves, name)?;
                self.respan(&mut part, id)?;
            }
            PanelEdit::JoinEdges { point, at } => {
                let join = crate::split::join(&mut panel, point, at)?;
                self.rejoin(&join, id)?;
            }
            PanelEdit::SetFabric(fabric) if self.fabric(fabric).is_none() => {
                return Err(missing(&fabric));
            }
            simple => panel.change(simple)?,
        }
        self.replaceable(&panel)?;
        panel.reserve_ids(&mut self.ids);
        self.panels[k] = Arc::new(panel);
        Ok(())
    }
}

impl Pattern {
    /// Counters beyond every id of the pattern, whether or not its own counters know them.
    pub fn free_ids(&self) -> IdCounters {
        let mut ids = self.ids;
        for panel in &self.panels {
            panel.reserve_ids(&mut ids);
        }
        self.seams.iter().for_each(|seam| seam.id.reserve(&mut ids));
        self.fabrics
            .iter()
            .for_each(|fabric| fabric.id.reserve(&mut ids));
        ids
    }
}

fn missing(id: &impl ToString) -> EditError {
    EditError::Missing(id.to_string())
}

/// Replaces the part with the same id, or adds it.
fn put<T, I: PartialEq>(list: &mut Vec<T>, part: T, id: impl Fn(&T) -> I) {
    match list.iter().position(|known| id(known) == id(&part)) {
        Some(k) => list[k] = part,
        None => list.push(part),
    }
}

fn take<T, I: PartialEq + ToString>(
    list: &mut Vec<T>,
    wanted: I,
    id: impl Fn(&T) -> I,
) -> Result<(), EditError> {
    let k = list.iter().position(|known| id(known) == wanted);
    list.remove(k.ok_or_else(|| missing(&wanted))?);
    Ok(())
}

impl Panel {
    fn change(&mut self, edit: PanelEdit) -> Result<(), EditError> {
        match edit {
            PanelEdit::MovePoint { point, place } => {
                let found = self.points.iter_mut().find(|p| p.id == point);
                found.ok_or_else(|| missing(&point))?.place = place;
            }
            PanelEdit::PutPoint { at, point } => {
                self.points.retain(|known| known.id != point.id);
                self.points.insert(at.min(self.points.len()), point);
            }
            PanelEdit::RemovePoint(point) => {
                if let Some(by) = self.user_of(point) {
                    return Err(EditError::InUse {
                        what: point.to_string(),
                        by,
                    });
                }
                take(&mut self.points, point, |p| p.id)?;
            }
            PanelEdit::SetEdgeCurve { edge, curve } => {
                self.edge_mut(edge).ok_or_else(|| missing(&edge))?.curve = curve;
            }
            PanelEdit::SetEdgeAllowance { edge, allowance } => {
                let found = self.edge_mut(edge).ok_or_else(|| missing(&edge))?;
                found.seam_allowance = allowance;
            }
            PanelEdit::SetSeamAllowance(allowance) => self.seam_allowance = allowance,
            PanelEdit::PutDart(dart) => put(&mut self.darts, dart, |d| d.id),
            PanelEdit::RemoveDart(id) => take(&mut self.darts, id, |d| d.id)?,
            PanelEdit::PutNotch(notch) => put(&mut self.notches, notch, |n| n.id),
            PanelEdit::RemoveNotch(id) => take(&mut self.notches, id, |n| n.id)?,
            PanelEdit::PutInternalLine(line) => put(&mut self.internal_lines, line, |l| l.id),
            PanelEdit::RemoveInternalLine(id) => take(&mut self.internal_lines, id, |l| l.id)?,
            PanelEdit::SetGrain(grain) => self.grain = grain,
            PanelEdit::SetFold(fold) => self.fold = fold,
            PanelEdit::SetCut(cut) => self.cut = cut,
            PanelEdit::SetFabric(fabric) => self.fabric = fabric,
            PanelEdit::SetWorn(worn) => self.worn = worn,
            PanelEdit::Rename(_)
            | PanelEdit::RenamePoint { .. }
            | PanelEdit::RenameEdge { .. }
            | PanelEdit::SplitEdge { .. }
            | PanelEdit::JoinEdges { .. } => {
                return Err(impossible(
                    "this edit needs the whole pattern",
                    "apply it to the pattern",
                ));
            }
        }
        Ok(())
    }

    /// What uses a point, in words.
    pub(crate) fn user_of(&self, id: PointId) -> Option<String> {
        let uses = |ends: &[PointId; 2], curve: &EdgeCurve| {
            ends.contains(&id) || curve.controls().contains(&id)
        };
        let edge = self.edges().find(|edge| uses(&edge.ends, &edge.curve));
        if let Some(edge) = edge {
            return Some(format!("edge {:?}", edge.name));
        }
        let line = self
            .internal_lines
            .iter()
            .find(|line| line.segments.iter().any(|s| uses(&s.ends, &s.curve)));
        if let Some(line) = line {
            return Some(format!("internal line {:?}", line.name));
        }
        let dart = self.darts.iter().find(|dart| match &dart.shape {
            DartShape::Edge { tip, .. } => *tip == DartTip::Apex(id),
            DartShape::Diamond { ends, .. } => ends.contains(&id),
        });
        if let Some(dart) = dart {
            return Some(format!("dart {:?}", dart.name));
        }
        let point = self
            .points
            .iter()
            .find(|point| point.place.bases().contains(&id));
        point.map(|point| format!("point {:?}", point.name))
    }

    /// Whether the panel is consistent in itself: names, ids, references, finite values.
    pub(crate) fn validate(&self) -> Result<(), EditError> {
        name_allowed(&self.name)?;
        let points = unique(self.points.iter().map(|p| (p.id, &*p.name)), "point")?;
        let edges = unique(self.edges().map(|e| (e.id, &*e.name)), "edge")?;
        unique(self.darts.iter().map(|d| (d.id, &*d.name)), "dart")?;
        unique(self.notches.iter().map(|n| (n.id, &*n.name)), "notch")?;
        unique(self.internal_lines.iter().map(|l| (l.id, &*l.name)), "line")?;
        let mut used: Vec<PointId> = Vec::new();
        for edge in self.edges() {
            used.extend(edge.ends.iter().chain(edge.curve.controls()));
        }
        for segment in self.internal_lines.iter().flat_map(|line| &line.segments) {
            used.extend(segment.ends.iter().chain(segment.curve.controls()));
        }
        let mut along: Vec<EdgeId> = self.notches.iter().map(|notch| notch.edge).collect();
        along.extend(self.fold);
        for dart in &self.darts {
            match &dart.shape {
                DartShape::Edge { edge, tip, .. } => {
                    along.push(*edge);
                    if let DartTip::Apex(apex) = tip {
                        used.push(*apex);
                    }
                }
                DartShape::Diamond { ends, .. } => used.extend(ends),
            }
        }
        for point in &self.points {
            used.extend(point.place.bases());
            if let PointPlace::OnEdge { edge, .. } = point.place {
                along.push(edge);
            }
        }
        if let Some(id) = used.iter().find(|id| !points.contains(id)) {
            return Err(missing(id));
        }
        if let Some(id) = along.iter().find(|id| !edges.contains(id)) {
            return Err(missing(id));
        }
        if !all_finite(self.clone().numbers_mut()) {
            return Err(EditError::NotFinite(format!("panel {:?}", self.name)));
        }
        Ok(())
    }

    /// Makes sure no id of the panel is given out again.
    pub(crate) fn reserve_ids(&self, counters: &mut IdCounters) {
        self.id.reserve(counters);
        self.points.iter().for_each(|p| p.id.reserve(counters));
        self.edges().for_each(|e| e.id.reserve(counters));
        self.darts.iter().for_each(|d| d.id.reserve(counters));
        self.notches.iter().for_each(|n| n.id.reserve(counters));
        self.internal_lines
            .iter()
            .for_each(|l| l.id.reserve(counters));
    }
}

/// The ids, if ids and names are all different and the names allowed.
fn unique<'a, I: Ord + Copy + ToString>(
    parts: impl Iterator<Item = (I, &'a str)>,
    kind: &str,
) -> Result<BTreeSet<I>, EditError> {
    let mut ids = BTreeSet::new();
    let mut names = BTreeSet::new();
    for (id, name) in parts {
        name_allowed(name)?;
        if !ids.insert(id) {
            return Err(EditError::Taken(id.to_string()));
        }
        if !names.insert(name) {
            return Err(EditError::Taken(format!("{kind} {name:?}")));
        }
    }
    Ok(ids)
}
