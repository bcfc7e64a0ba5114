//! Draws on a finished panel: sheets that lie on a stage, and curves to cut the panel along.

use super::construct::add_curve;
use super::lookup::{self, after};
use super::marks::{NearMark, point_at_mark};
use super::names::{free_name, letter_name, sheet_owner};
use super::{CurveShape, impossible};
use crate::{
    CornerName, CurveId, CurveRule, Edit, EditError, Entity, Evaluation, Ids, LineName, Mark, Name,
    Operation, OperationId, OperationKind, Panel, PanelId, Point, PointRule, Sheet, SheetHead,
    SheetId, Stage,
};
use std::sync::Arc;

/// Plans to open a sheet on a panel as it is before it is unfolded, with a point at each of its corners;
/// returns the sheet too. A sheet that already lies on that stage is used again.
///
/// # Errors
/// The panel is missing, cannot be drawn, or is split, so that sheets can only lie on its sides.
pub fn open_sheet(
    evaluation: &Evaluation,
    panel: PanelId,
) -> Result<(Vec<Edit>, SheetId), EditError> {
    let pattern = evaluation.pattern();
    let owner = lookup::panel(pattern, panel)?;
    if owner.is_split() {
        return Err(impossible(
            format!("panel {:?} is split", owner.name),
            "draw on its sides",
        ));
    }
    let fold = |step: &Arc<Operation>| matches!(step.kind, OperationKind::Fold { .. });
    let count = owner.operations.iter().position(fold);
    let count = count.unwrap_or(owner.operations.len());
    // Inserted lines do not move the panel, so a sheet drawn before such an operation lies on this stage too.
    let steps = owner.operations[..count].iter();
    let last = steps.rev().find(|step| step.kind.sheet().is_none());
    let on = (panel, last.map(|step| step.id));
    let sheets = pattern.sheets.iter();
    if let Some(known) = sheets.clone().find(|sheet| sheet.on == Some(on)) {
        return Ok((Vec::new(), known.id));
    }
    let stage = evaluation.stage(on.0, on.1).ok_or_else(|| {
        impossible(
            format!("panel {:?} cannot be drawn", owner.name),
            "mend it first",
        )
    })?;
    let mut ids = pattern.ids;
    let taken = |name: &str| sheet_owner(pattern, None, name).is_some();
    let head = SheetHead {
        id: ids.take(),
        name: free_name(&format!("on {}", owner.name), taken),
        on: Some(on),
        on_table: [0.0; 2],
    };
    let id = head.id;
    let mut names: Vec<String> = Vec::new();
    let mut edits = vec![Edit::Put(Entity::Sheet(head))];
    for (line, corner) in corners(stage) {
        let name = letter_name(|name| names.iter().any(|known| known == name));
        names.push(name.clone());
        let at = Mark::Corner(corner);
        let rule = PointRule::Mark { line, at };
        let point = Point {
            id: ids.take(),
            name,
            rule,
        };
        edits.push(Edit::Put(Entity::Point(id, Arc::new(point))));
    }
    Ok((edits, id))
}

/// The corners of the outline of a stage, each with the name of the line.
fn corners(stage: &Stage) -> Vec<(LineName, CornerName)> {
    let outline = stage
        .lines
        .iter()
        .find(|line| line.kind == crate::LineKind::Outline);
    let edges = outline.iter().flat_map(|line| {
        let own = line.edges.iter().filter(|edge| edge.half == 0);
        own.filter_map(|edge| Some((line.name, edge.start?)))
    });
    edges.collect()
}

/// The operation with which a panel inserts a sheet that lies on one of its stages: the existing one or, if
/// there is none, a new operation right after that stage.
pub(super) fn inserted(panel: &mut Panel, sheet: &Sheet, ids: &mut Ids) -> OperationId {
    let own = |step: &&Arc<Operation>| step.kind.sheet() == Some(sheet.id);
    if let Some(step) = panel.operations.iter().find(own) {
        return step.id;
    }
    let id: OperationId = ids.take();
    let kind = OperationKind::Insert { sheet: sheet.id };
    let named = |name: &str| panel.operations.iter().any(|known| known.name == name);
    let name = free_name(kind.word(), named);
    let stage = sheet.on.and_then(|(_, after)| after);
    let at = stage.and_then(|by| panel.step_of(by)).unwrap_or(0);
    let operation = Arc::new(Operation {
        id,
        name,
        kind,
        meant: false,
    });
    panel.operations.insert(at, operation);
    id
}

/// Plans to draw a straight curve between two places on a line of a panel; returns the curve too. The ends of
/// the curve are points that stay at these places. If no operation moved the two places, it is drawn on the
/// sheet of the panel itself, otherwise on a sheet that lies on the finished panel.
///
/// # Errors
/// The panel is missing, cannot be drawn, or is split; both places are the same.
pub fn line_across(
    evaluation: &Evaluation,
    panel: PanelId,
    places: [NearMark; 2],
) -> Result<(Vec<Edit>, CurveId), EditError> {
    let owner = lookup::panel(evaluation.pattern(), panel)?;
    let line = |work: &Evaluation, sheet: SheetId, ends| {
        let shape = CurveShape::Rule(CurveRule::Line);
        add_curve(work, (sheet, None), ends, shape)
    };
    let drawn = || {
        let [from, to] = places.clone();
        let (mut edits, start) = point_at_mark(evaluation, panel, from)?;
        let work = after(evaluation, &edits)?;
        let (more, end) = point_at_mark(&work, panel, to)?;
        edits.extend(more);
        let work = after(evaluation, &edits)?;
        let (sheet, _) = lookup::point(work.pattern(), start)?;
        let (more, curve) = line(&work, sheet.id, [start, end])?;
        edits.extend(more);
        Ok((edits, curve))
    };
    let on_stage = owner.sheet().is_none() || !owner.operations.is_empty();
    match drawn() {
        Ok(found) => return Ok(found),
        Err(error) if !on_stage => return Err(error),
        Err(_) => {}
    }
    let (mut edits, sheet) = open_sheet(evaluation, panel)?;
    let mut ends = Vec::with_capacity(2);
    for near in places {
        let work = after(evaluation, &edits)?;
        let rule = PointRule::Mark {
            line: Name::Drawn(near.line),
            at: near.mark,
        };
        let points = lookup::sheet(work.pattern(), sheet)?.points.iter();
        let mut known = points
            .filter(|point| point.rule == rule)
            .map(|point| point.id);
        if let Some(id) = known.next() {
            ends.push(id);
            continue;
        }
        let (more, id) = super::add_point(&work, sheet, None, rule)?;
        edits.extend(more);
        ends.push(id);
    }
    let work = after(evaluation, &edits)?;
    let (more, curve) = line(&work, sheet, [ends[0], ends[1]])?;
    edits.extend(more);
    Ok((edits, curve))
}
