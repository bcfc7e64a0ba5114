//! Looks up parts for planners, with an error that names a missing part; and the evaluation that edits
//! would give.

use super::impossible;
use crate::{
    Curve, CurveId, Diagnostic, Edit, EditError, Evaluation, Line, LineId, Panel, PanelId, Pattern,
    Place, Point, PointId, Seam, SeamId, Severity, Sheet, SheetId,
};
use std::sync::Arc;
use toile_geometry::{Path, Vec2};

fn missing(part: &dyn std::fmt::Display) -> EditError {
    EditError::Missing(part.to_string())
}

pub(super) fn sheet(pattern: &Pattern, id: SheetId) -> Result<&Arc<Sheet>, EditError> {
    pattern.sheet(id).ok_or_else(|| missing(&id))
}

pub(super) fn point(
    pattern: &Pattern,
    id: PointId,
) -> Result<(&Arc<Sheet>, &Arc<Point>), EditError> {
    pattern.point(id).ok_or_else(|| missing(&id))
}

pub(super) fn curve(
    pattern: &Pattern,
    id: CurveId,
) -> Result<(&Arc<Sheet>, &Arc<Curve>), EditError> {
    pattern.curve(id).ok_or_else(|| missing(&id))
}

pub(super) fn panel(pattern: &Pattern, id: PanelId) -> Result<&Arc<Panel>, EditError> {
    pattern.panel(id).ok_or_else(|| missing(&id))
}

/// The sheet that a panel's own lines are drawn on.
pub(super) fn drawn_on<'p>(
    pattern: &'p Pattern,
    panel: &Panel,
) -> Result<&'p Arc<Sheet>, EditError> {
    match panel.sheet() {
        Some(id) => sheet(pattern, id),
        None => Err(impossible(
            format!(
                "panel {:?} is a side of another and has no lines of its own",
                panel.name
            ),
            "draw on the panel that was split",
        )),
    }
}

pub(super) fn line(panel: &Panel, id: LineId) -> Result<&Line, EditError> {
    panel.line(id).ok_or_else(|| missing(&id))
}

pub(super) fn seam(pattern: &Pattern, id: SeamId) -> Result<&Arc<Seam>, EditError> {
    pattern.seam(id).ok_or_else(|| missing(&id))
}

/// Position of a point (m), or an error that names the point.
pub(super) fn place(evaluation: &Evaluation, id: PointId) -> Result<Vec2, EditError> {
    let (_, found) = point(evaluation.pattern(), id)?;
    evaluation.point(id).ok_or_else(|| {
        impossible(
            format!("point {:?} cannot be drawn", found.name),
            "mend its formulas first",
        )
    })
}

/// A curve as drawn (m), or an error that names the curve.
pub(super) fn path(evaluation: &Evaluation, id: CurveId) -> Result<&Arc<Path>, EditError> {
    let (_, found) = curve(evaluation.pattern(), id)?;
    evaluation.curve(id).ok_or_else(|| {
        impossible(
            format!("curve {:?} cannot be drawn", found.name),
            "mend its points and formulas first",
        )
    })
}

/// Refuses positions that are not finite; `what` names the positions in the error.
pub(super) fn finite(what: &str, places: &[Vec2]) -> Result<(), EditError> {
    match places.iter().all(|p| p.x.is_finite() && p.y.is_finite()) {
        true => Ok(()),
        false => Err(EditError::NotFinite(what.to_owned())),
    }
}

/// The evaluation of the pattern after edits, to check their effect. The given evaluation is not changed.
///
/// # Errors
/// The pattern does not accept the edits.
pub(super) fn after(evaluation: &Evaluation, edits: &[Edit]) -> Result<Evaluation, EditError> {
    let mut pattern = evaluation.pattern().clone();
    pattern.apply(edits)?;
    let mut after = evaluation.clone();
    after.update(&pattern, evaluation.wearer().clone());
    Ok(after)
}

/// Refuses edits if one of these diagnostic places has a fault after them that it did not have before; the
/// error has the message of that fault.
pub(super) fn refuse_faults(
    before: &Evaluation,
    after: &Evaluation,
    places: &[Place],
) -> Result<(), EditError> {
    let old = before.diagnostics();
    let is_new = |found: &Diagnostic| {
        found.severity != Severity::Note && places.contains(&found.place) && !old.contains(found)
    };
    match after.diagnostics().into_iter().find(is_new) {
        Some(found) => Err(impossible(found.message, found.hint)),
        None => Ok(()),
    }
}
