//! Adds operations to panels; adjusts, reorders and removes them.

use super::impossible;
use super::lookup::{self, after, refuse_faults};
use super::names::free_name;
use crate::{
    Diagnostic, Edit, EditError, Entity, Evaluation, Operation, OperationId, OperationKind, Panel,
    PanelId, Place, Severity, SheetId, fields,
};
use std::sync::Arc;

/// Plans to add an operation to a panel; returns the operation too. Its name is that of its kind: `dart`,
/// `dart 2`. It is inserted before the first fold, so that both halves have it; a fold is added as the last
/// operation.
///
/// # Errors
/// The panel is missing or cannot be drawn; the operation cannot be done (the message gives the reason).
pub fn add_operation(
    evaluation: &Evaluation,
    panel: PanelId,
    kind: OperationKind,
) -> Result<(Vec<Edit>, OperationId), EditError> {
    let pattern = evaluation.pattern();
    let mut changed = (**lookup::panel(pattern, panel)?).clone();
    let mut ids = pattern.ids;
    let id: OperationId = ids.take();
    let named = |name: &str| changed.operations.iter().any(|known| known.name == name);
    let name = free_name(kind.word(), named);
    // Folds are added after all other operations.
    let fold = |known: &Arc<Operation>| known.kind.fold_ends().is_some();
    let end = changed.operations.len();
    let at = match kind.fold_ends() {
        Some(_) => end,
        None => changed.operations.iter().position(fold).unwrap_or(end),
    };
    let operation = Arc::new(Operation {
        id,
        name,
        kind,
        meant: false,
    });
    changed.operations.insert(at, operation);
    Ok((put(evaluation, changed, &[id])?, id))
}

/// Plans to change the settings of an operation. The operation keeps its id, name and place in the order, so
/// parts that are named by it keep their names.
///
/// # Errors
/// The operation is missing, or cannot be done with these settings (the message gives the reason).
pub fn set_operation(
    evaluation: &Evaluation,
    (panel, operation): (PanelId, OperationId),
    kind: OperationKind,
) -> Result<Vec<Edit>, EditError> {
    let mut changed = (**lookup::panel(evaluation.pattern(), panel)?).clone();
    let at = position(&changed, operation)?;
    Arc::make_mut(&mut changed.operations[at]).kind = kind;
    put(evaluation, changed, &[operation])
}

/// Plans to move an operation to another index in the order of the panel's operations; an index beyond the
/// end is the end.
///
/// # Errors
/// The operation is missing; one of the panel's operations could then no longer be done.
pub fn move_operation(
    evaluation: &Evaluation,
    (panel, operation): (PanelId, OperationId),
    to: usize,
) -> Result<Vec<Edit>, EditError> {
    let mut changed = (**lookup::panel(evaluation.pattern(), panel)?).clone();
    let at = position(&changed, operation)?;
    let moved = changed.operations.remove(at);
    let to = to.min(changed.operations.len());
    changed.operations.insert(to, moved);
    let all: Vec<OperationId> = changed.operations.iter().map(|known| known.id).collect();
    put(evaluation, changed, &all)
}

/// Plans to remove an operation from a panel. References to parts that it made stay, and are valid again if
/// it comes back.
///
/// # Errors
/// The operation is missing.
pub fn remove_operation(
    evaluation: &Evaluation,
    (panel, operation): (PanelId, OperationId),
) -> Result<Vec<Edit>, EditError> {
    let mut changed = (**lookup::panel(evaluation.pattern(), panel)?).clone();
    let at = position(&changed, operation)?;
    changed.operations.remove(at);
    Ok(vec![Edit::Put(Entity::Panel(Arc::new(changed)))])
}

fn position(panel: &Panel, operation: OperationId) -> Result<usize, EditError> {
    let found = panel.operations.iter().position(|o| o.id == operation);
    found.ok_or_else(|| EditError::Missing(format!("{operation} of panel {:?}", panel.name)))
}

/// The edit that puts a panel into the pattern; refused if one of these operations cannot be done.
fn put(
    evaluation: &Evaluation,
    panel: Panel,
    operations: &[OperationId],
) -> Result<Vec<Edit>, EditError> {
    refuse_foreign_parts(evaluation, &panel)?;
    let (id, name) = (panel.id, panel.name.clone());
    let edits = vec![Edit::Put(Entity::Panel(Arc::new(panel)))];
    let after = after(evaluation, &edits)?;
    let places: Vec<Place> = operations
        .iter()
        .map(|&operation| Place::Operation(id, operation))
        .collect();
    let undone =
        |found: &Diagnostic| found.severity == Severity::Error && places.contains(&found.place);
    // The one operation that is added or changed is refused for any fault, even one that it had before;
    // faults elsewhere count only if they are new.
    if let ([_], Some(found)) = (operations, after.diagnostics().into_iter().find(undone)) {
        return Err(impossible(found.message, found.hint));
    }
    refuse_faults(evaluation, &after, &places)?;
    match after.stage(id, operations.first().copied()) {
        Some(_) => Ok(edits),
        None => Err(impossible(
            format!("panel {name:?} cannot be drawn"),
            "mend its outline first",
        )),
    }
}

/// Refuses operations that use points or curves of other sheets: they must be on the panel's own sheet, or on
/// a sheet that lies on the stage before the operation.
fn refuse_foreign_parts(evaluation: &Evaluation, panel: &Panel) -> Result<(), EditError> {
    let mut pattern = evaluation.pattern().clone();
    pattern.apply(&[Edit::Put(Entity::Panel(Arc::new(panel.clone())))])?;
    let own = pattern.sheet_of(panel);
    for (step, operation) in (1..).zip(&panel.operations) {
        // A missing part is reported by the operation that uses it.
        let points = fields::points(&operation.kind)
            .into_iter()
            .filter_map(|id| {
                let (sheet, point) = pattern.point(id)?;
                Some((sheet, "point", &point.name))
            });
        let curves = fields::curves(&operation.kind)
            .into_iter()
            .filter_map(|id| {
                let (sheet, curve) = pattern.curve(id)?;
                Some((sheet, "curve", &curve.name))
            });
        let is_foreign =
            |sheet: SheetId| own != Some(sheet) && !pattern.lies_before(sheet, panel, step);
        if let Some(sheet) = operation.kind.sheet()
            && !pattern.lies_before(sheet, panel, step)
            && was_laid(evaluation, panel.id, operation)
        {
            return Err(impossible(
                format!(
                    "insert {:?}: its sheet does not lie on the stage before it then",
                    operation.name
                ),
                "do it right after the operation that its sheet lies on",
            ));
        }
        let mut used = points.chain(curves);
        if let Some((sheet, kind, name)) = used.find(|found| is_foreign(found.0.id)) {
            return Err(impossible(
                format!(
                    "{kind} {name:?} is on sheet {:?}, which panel {:?} is not traced from",
                    sheet.name, panel.name
                ),
                format!(
                    "choose a {kind} of the panel's own sheet, or of one that lies on its last stage"
                ),
            ));
        }
    }
    Ok(())
}

/// Whether the sheet that an operation inserts lies on the stage before that operation, in the pattern as it
/// is now.
fn was_laid(evaluation: &Evaluation, panel: PanelId, insert: &Operation) -> bool {
    let pattern = evaluation.pattern();
    let found = pattern.panel(panel).and_then(|panel| {
        let (sheet, step) = (insert.kind.sheet()?, panel.step_of(insert.id)?);
        Some(pattern.lies_before(sheet, panel, step))
    });
    found == Some(true)
}
