//! Adds notches to lines of panels, one or a row of them, and changes them.

use super::impossible;
use super::lookup::{self, after, refuse_faults};
use super::names::free_name;
use crate::{
    CornerName, Edit, EditError, Entity, Evaluation, LineId, Mark, Notch, NotchId, NotchKind,
    Panel, PanelId, Place,
};
use std::sync::Arc;

/// Most notches that are added at once.
const MAX_NOTCHES_IN_ROW: u32 = 100;

/// Notches at equal distances between two corners of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotchRow {
    /// The line that the notches are on.
    pub line: LineId,
    /// The two corners, in the order of the line; no notch is added at the corners.
    pub ends: [CornerName; 2],
    /// Number of notches to add.
    pub count: u32,
}

/// Plans to add a notch to a line of a panel; returns the notch too. The notch is called `notch`, `notch 2`,
/// ...
///
/// # Errors
/// The panel or line is missing, or the mark is not on the line.
pub fn add_notch(
    evaluation: &Evaluation,
    panel: PanelId,
    (line, at): (LineId, Mark),
    kind: NotchKind,
) -> Result<(Vec<Edit>, NotchId), EditError> {
    let (edits, ids) = add(evaluation, panel, line, (vec![at], kind))?;
    Ok((edits, ids[0]))
}

/// Plans to add evenly spaced notches between two corners; returns the notches too.
///
/// # Errors
/// The panel, line or corners are missing; the number of notches is 0 or above 100.
pub fn add_notches(
    evaluation: &Evaluation,
    panel: PanelId,
    row: NotchRow,
    kind: NotchKind,
) -> Result<(Vec<Edit>, Vec<NotchId>), EditError> {
    if !(1..=MAX_NOTCHES_IN_ROW).contains(&row.count) {
        return Err(impossible(
            format!("a row of {} notches cannot be put", row.count),
            format!("ask for 1 to {MAX_NOTCHES_IN_ROW}"),
        ));
    }
    let mark = |k: u32| Mark::Between {
        ends: row.ends,
        share: (f64::from(k) / f64::from(row.count + 1)).into(),
    };
    let marks = (1..=row.count).map(mark).collect();
    add(evaluation, panel, row.line, (marks, kind))
}

/// Plans to move a notch along its line or to another line.
///
/// # Errors
/// The notch or line is missing, or the mark is not on the line.
pub fn move_notch(
    evaluation: &Evaluation,
    (panel, notch): (PanelId, NotchId),
    (line, at): (LineId, Mark),
) -> Result<Vec<Edit>, EditError> {
    let (mut changed, k) = found(evaluation, panel, notch)?;
    line_of(evaluation, &changed, line)?;
    refuse_itself(&at, notch)?;
    changed.notches[k].line = line;
    changed.notches[k].at = at;
    put(evaluation, changed, &[notch])
}

/// Plans to give a notch another shape.
///
/// # Errors
/// The notch is missing.
pub fn set_notch_kind(
    evaluation: &Evaluation,
    (panel, notch): (PanelId, NotchId),
    kind: NotchKind,
) -> Result<Vec<Edit>, EditError> {
    let (mut changed, k) = found(evaluation, panel, notch)?;
    changed.notches[k].kind = kind;
    Ok(vec![Edit::Put(Entity::Panel(Arc::new(changed)))])
}

/// Plans to remove a notch from a panel. Marks placed at the notch stay, and are valid again if it comes
/// back.
///
/// # Errors
/// The notch is missing.
pub fn remove_notch(
    evaluation: &Evaluation,
    (panel, notch): (PanelId, NotchId),
) -> Result<Vec<Edit>, EditError> {
    let (mut changed, k) = found(evaluation, panel, notch)?;
    changed.notches.remove(k);
    Ok(vec![Edit::Put(Entity::Panel(Arc::new(changed)))])
}

/// A copy of the panel to be changed, and the index of the notch in it.
fn found(
    evaluation: &Evaluation,
    panel: PanelId,
    notch: NotchId,
) -> Result<(Panel, usize), EditError> {
    let panel = lookup::panel(evaluation.pattern(), panel)?;
    let at = panel.notches.iter().position(|known| known.id == notch);
    let at = at.ok_or_else(|| EditError::Missing(format!("{notch} of panel {:?}", panel.name)))?;
    Ok(((**panel).clone(), at))
}

/// Refuses a line that belongs neither to the panel nor to a panel that it is a side of.
fn line_of(evaluation: &Evaluation, panel: &Panel, line: LineId) -> Result<(), EditError> {
    let owner = evaluation.pattern().owner_of(panel.id, line.into());
    let missing = || EditError::Missing(line.to_string());
    owner.map(|_| ()).ok_or_else(missing)
}

fn refuse_itself(at: &Mark, notch: NotchId) -> Result<(), EditError> {
    match at {
        Mark::Notch(id) if *id == notch => Err(impossible(
            "the notch would lie where it lies itself",
            "put it on an edge or a corner",
        )),
        Mark::Notch(_) | Mark::Along { .. } | Mark::Between { .. } | Mark::Corner(_) => Ok(()),
    }
}

fn add(
    evaluation: &Evaluation,
    panel: PanelId,
    line: LineId,
    (marks, kind): (Vec<Mark>, NotchKind),
) -> Result<(Vec<Edit>, Vec<NotchId>), EditError> {
    let pattern = evaluation.pattern();
    let mut changed = (**lookup::panel(pattern, panel)?).clone();
    line_of(evaluation, &changed, line)?;
    let mut ids = pattern.ids;
    let mut made = Vec::new();
    for at in marks {
        let id: NotchId = ids.take();
        let taken = |name: &str| changed.notches.iter().any(|known| known.name == name);
        let name = free_name("notch", taken);
        changed.notches.push(Notch {
            id,
            name,
            line,
            at,
            kind,
        });
        made.push(id);
    }
    Ok((put(evaluation, changed, &made)?, made))
}

/// The edit that puts a panel into the pattern; refused if one of these notches has no position.
fn put(evaluation: &Evaluation, panel: Panel, notches: &[NotchId]) -> Result<Vec<Edit>, EditError> {
    let (id, name) = (panel.id, panel.name.clone());
    let edits = vec![Edit::Put(Entity::Panel(Arc::new(panel)))];
    let after = after(evaluation, &edits)?;
    let places: Vec<Place> = notches.iter().map(|&n| Place::Notch(id, n)).collect();
    refuse_faults(evaluation, &after, &places)?;
    let drawn = after.pattern().panel(id).and_then(|p| after.last_stage(p));
    let is_drawn = |notch: &NotchId| {
        drawn.is_some_and(|stage| stage.notches.iter().any(|known| known.id == *notch))
    };
    match notches.iter().all(is_drawn) {
        true => Ok(edits),
        false => Err(impossible(
            format!("panel {name:?} cannot be drawn there"),
            "mend its lines first, or choose another place",
        )),
    }
}
