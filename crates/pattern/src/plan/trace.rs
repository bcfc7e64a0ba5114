//! Panels and their lines traced from the curves of a sheet.

use super::chain::{Chain, Stretch, edges, stretches, wound};
use super::face::face;
use super::impossible;
use super::lookup::{self, after, finite, refuse_faults};
use super::names::{free_name, panel_owner, wished};
use super::on_panel::inserted;
use crate::{
    Edit, EditError, Entity, Evaluation, Fabric, FabricId, Ids, Line, LineId, LineKind, Number,
    Panel, PanelId, Pattern, Place, Sheet, SheetId,
};
use std::sync::Arc;
use toile_geometry::Vec2;

/// Seam allowance of the first panel of a pattern (m): what most home patterns have.
const ALLOWANCE: f64 = 0.01;

/// Name and fabric of a new panel. The panel gets the seam allowance of the panel before it in the pattern;
/// the first panel gets 1 cm.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct NewPanel<'a> {
    /// Name of the panel. `None`: the name of its sheet, with a number if it is taken.
    pub name: Option<&'a str>,
    /// Fabric of the panel. `None`: the first fabric of the pattern, or poplin if the pattern has no fabric.
    pub fabric: Option<FabricId>,
}

/// Treatment of closed lines inside a face of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Holes {
    /// The lines are cut out as holes.
    #[default]
    Cut,
    /// The lines are ignored.
    Ignored,
}

/// Plans to trace a panel round a closed chain of a sheet; returns the panel too. The outline runs
/// counter-clockwise in any case; edges are named after their curves.
///
/// # Errors
/// A part of the chain is missing; the chain is open, follows two curves at once or encloses nothing; the
/// name is taken or not allowed; the fabric is missing.
pub fn trace_panel(
    evaluation: &Evaluation,
    sheet: SheetId,
    chain: Chain<'_>,
    new: NewPanel<'_>,
) -> Result<(Vec<Edit>, PanelId), EditError> {
    let outline = stretches(evaluation, sheet, chain, LineKind::Outline)?;
    let outline = wound(outline, LineKind::Outline)?;
    traced(evaluation, sheet, &[outline], new)
}

/// Plans to trace the panel round a point of a sheet (m): its outline is the smallest closed line round the
/// point, made of curves cut at the points that lie on them. Returns the panel too.
///
/// # Errors
/// No closed line goes round the point, or the point lies on a curve; two curves cross there without a point
/// at the crossing; the name is taken or not allowed; the fabric is missing.
pub fn trace_face(
    evaluation: &Evaluation,
    sheet: SheetId,
    (place, holes): (Vec2, Holes),
    new: NewPanel<'_>,
) -> Result<(Vec<Edit>, PanelId), EditError> {
    finite("the place", &[place])?;
    let drawn = lookup::sheet(evaluation.pattern(), sheet)?;
    let face = face(evaluation, drawn, place)?;
    let mut lines = vec![face.outline];
    if holes == Holes::Cut {
        lines.extend(face.holes);
    }
    traced(evaluation, sheet, &lines, new)
}

/// Plans to add a hole or an internal line to a panel, along a chain of its sheet; returns the line too.
/// Holes run clockwise in any case. Without a name the line is named after its kind. If the chain is on a
/// sheet that lies on a stage of the panel, an operation right after that stage inserts the sheet's lines.
///
/// # Errors
/// A part of the chain is missing, or the chain follows two curves at once; a hole is open or encloses
/// nothing; an outline is asked for and the panel has one; the name is taken or not allowed.
pub fn add_line(
    evaluation: &Evaluation,
    panel: PanelId,
    (kind, name): (LineKind, Option<&str>),
    chain: Chain<'_>,
) -> Result<(Vec<Edit>, LineId), EditError> {
    let pattern = evaluation.pattern();
    let mut changed = (**lookup::panel(pattern, panel)?).clone();
    if kind == LineKind::Outline && changed.outline().is_some() {
        return Err(impossible(
            format!("panel {:?} has an outline", changed.name),
            "add a hole or an internal line, or trace another panel",
        ));
    }
    let mut ids = pattern.ids;
    let laid = chain
        .sheet(pattern)
        .filter(|sheet| sheet.on.is_some_and(|(of, _)| of == panel) && kind != LineKind::Outline);
    let (sheet, by) = match laid {
        Some(sheet) => (sheet, Some(inserted(&mut changed, sheet, &mut ids))),
        None => (lookup::drawn_on(pattern, &changed)?, None),
    };
    let found = wound(stretches(evaluation, sheet.id, chain, kind)?, kind)?;
    let line = Line {
        by,
        ..line(sheet, &found, (&changed, kind, name), &mut ids)?
    };
    let id = line.id;
    changed.lines.push(line);
    let edits = vec![Edit::Put(Entity::Panel(Arc::new(changed)))];
    refuse_undrawn(evaluation, &edits, panel)?;
    Ok((edits, id))
}

/// Plans to remove a hole or an internal line from a panel; curves and points stay on the sheet. Marks on the
/// line stay, and are valid again if the line comes back.
///
/// # Errors
/// The line is missing, or is the outline.
pub fn remove_line(
    evaluation: &Evaluation,
    (panel, line): (PanelId, LineId),
) -> Result<Vec<Edit>, EditError> {
    let mut changed = (**lookup::panel(evaluation.pattern(), panel)?).clone();
    if lookup::line(&changed, line)?.kind == LineKind::Outline {
        return Err(impossible(
            format!("panel {:?} would have no outline", changed.name),
            "remove the panel instead",
        ));
    }
    changed.lines.retain(|known| known.id != line);
    Ok(vec![Edit::Put(Entity::Panel(Arc::new(changed)))])
}

/// Plans to add a panel whose outline and holes follow these stretches.
fn traced(
    evaluation: &Evaluation,
    sheet: SheetId,
    lines: &[Vec<Stretch>],
    new: NewPanel<'_>,
) -> Result<(Vec<Edit>, PanelId), EditError> {
    let pattern = evaluation.pattern();
    let sheet = lookup::sheet(pattern, sheet)?;
    let mut ids = pattern.ids;
    let (mut edits, fabric) = fabric(pattern, new.fabric, &mut ids)?;
    let mut panel = Panel::new(ids.take(), "", sheet.id, fabric);
    panel.name = panel_name(pattern, sheet, &panel, new.name)?;
    let before = pattern.panels.last();
    panel.allowance = before.map_or(Number::Value(ALLOWANCE), |before| before.allowance.clone());
    for (k, stretches) in lines.iter().enumerate() {
        let kind = match k {
            0 => LineKind::Outline,
            _ => LineKind::Hole,
        };
        let line = line(sheet, stretches, (&panel, kind, None), &mut ids)?;
        panel.lines.push(line);
    }
    let id = panel.id;
    edits.push(Edit::Put(Entity::Panel(Arc::new(panel))));
    refuse_undrawn(evaluation, &edits, id)?;
    Ok((edits, id))
}

fn panel_name(
    pattern: &Pattern,
    sheet: &Sheet,
    panel: &Panel,
    name: Option<&str>,
) -> Result<String, EditError> {
    let owner = |name: &str| panel_owner(pattern, panel, name);
    match name {
        Some(name) => wished(name, owner),
        None => Ok(free_name(&sheet.name, |name| owner(name).is_some())),
    }
}

/// The fabric of a new panel, and the edits that add it if the pattern has no fabric yet.
fn fabric(
    pattern: &Pattern,
    wish: Option<FabricId>,
    ids: &mut Ids,
) -> Result<(Vec<Edit>, FabricId), EditError> {
    if let Some(id) = wish {
        let found = pattern.fabric(id);
        let found = found.ok_or_else(|| EditError::Missing(id.to_string()))?;
        return Ok((Vec::new(), found.id));
    }
    if let Some(first) = pattern.fabrics.first() {
        return Ok((Vec::new(), first.id));
    }
    let id = ids.take();
    let poplin = Entity::Fabric(Arc::new(Fabric::poplin(id)));
    Ok((vec![Edit::Put(poplin)], id))
}

fn line(
    sheet: &Sheet,
    stretches: &[Stretch],
    (panel, kind, name): (&Panel, LineKind, Option<&str>),
    ids: &mut Ids,
) -> Result<Line, EditError> {
    let owner = |name: &str| {
        let found = panel.lines.iter().find(|line| line.name == name)?;
        Some(format!("line {:?} of panel {:?}", found.name, panel.name))
    };
    let word = match kind {
        LineKind::Outline => "outline",
        LineKind::Hole => "hole",
        LineKind::Internal => "line",
    };
    let name = match name {
        Some(name) => wished(name, owner)?,
        None => free_name(word, |name| owner(name).is_some()),
    };
    Ok(Line {
        id: ids.take(),
        name,
        kind,
        by: None,
        edges: edges(sheet, stretches, panel, ids)?,
    })
}

/// Refuses edits after which a panel has a fault that it did not have before.
fn refuse_undrawn(
    evaluation: &Evaluation,
    edits: &[Edit],
    panel: PanelId,
) -> Result<(), EditError> {
    let after = after(evaluation, edits)?;
    let own = lookup::panel(after.pattern(), panel)?.own_parts();
    let mut places: Vec<Place> = own.into_iter().map(|(_, place)| place).collect();
    places.push(Place::Panel(panel));
    refuse_faults(evaluation, &after, &places)
}
