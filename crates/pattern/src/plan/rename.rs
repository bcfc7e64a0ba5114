//! Renames parts. Formulas hold ids, so they follow.

use super::bind::bound;
use super::lookup::after;
use super::names::{curve_owner, panel_owner, point_owner, sheet_owner, wished};
use super::{impossible, lookup};
use crate::formula::PI;
use crate::{
    Curve, Edit, EditError, Entity, Evaluation, Fabric, Marker, Panel, PartId, Pattern, Place,
    Point, Seam, SheetHead, Size, Variable,
};
use std::sync::Arc;
use toile_measure::definition;

/// Plans to rename a part; no edits if it has that name already. Formulas in which the new name stood for no
/// part refer to this part afterwards.
///
/// # Errors
/// The part is missing; the name is not allowed, or another part of its owner has it. The owner is the
/// pattern for sizes, variables, fabrics, sheets, panels, seams and markers; the sheet for points and curves;
/// the panel for lines, edges, notches and operations.
pub fn rename(evaluation: &Evaluation, part: PartId, name: &str) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    let parts = pattern.parts();
    let found = parts.iter().find(|(id, _)| *id == part);
    let (_, place) = found.ok_or_else(|| EditError::Missing(part.to_string()))?;
    let entity = match place {
        Place::Line(panel, _)
        | Place::Edge(panel, _)
        | Place::Notch(panel, _)
        | Place::Operation(panel, _) => {
            let panel = lookup::panel(pattern, *panel)?;
            Entity::Panel(Arc::new(renamed(panel, part, name)?))
        }
        Place::Pattern
        | Place::Size(_)
        | Place::Variable(_)
        | Place::Sheet(_)
        | Place::Point(_)
        | Place::Curve(_)
        | Place::Panel(_)
        | Place::Seam(_)
        | Place::SeamEnd(..)
        | Place::Fabric(_)
        | Place::Marker(_)
        | Place::Guide(_)
        | Place::File { .. } => match of_sheet(pattern, part, name)? {
            Some(entity) => entity,
            None => of_pattern(pattern, part, name)?,
        },
    };
    let mut edits = vec![Edit::Put(entity)];
    let after = after(evaluation, &edits)?;
    if after.pattern() == pattern {
        return Ok(Vec::new());
    }
    edits.extend(bound(&after));
    Ok(edits)
}

/// A sheet, a point, a curve or a panel with the new name. `None`: the part is of another kind.
fn of_sheet(pattern: &Pattern, part: PartId, name: &str) -> Result<Option<Entity>, EditError> {
    Ok(Some(match part {
        PartId::Sheet(id) => {
            let sheet = lookup::sheet(pattern, id)?;
            Entity::Sheet(SheetHead {
                id,
                name: wished(name, |name| sheet_owner(pattern, Some(sheet), name))?,
                on: sheet.on,
                on_table: sheet.on_table,
            })
        }
        PartId::Point(id) => {
            let (sheet, point) = lookup::point(pattern, id)?;
            let owner = |name: &str| {
                let owner = point_owner(sheet, name);
                owner.filter(|_| point.name != name)
            };
            let name = wished(name, owner)?;
            let point = (**point).clone();
            Entity::Point(sheet.id, Arc::new(Point { name, ..point }))
        }
        PartId::Curve(id) => {
            let (sheet, curve) = lookup::curve(pattern, id)?;
            let owner = |name: &str| {
                let owner = curve_owner(sheet, name);
                owner.filter(|_| curve.name != name)
            };
            let name = wished(name, owner)?;
            let curve = (**curve).clone();
            Entity::Curve(sheet.id, Arc::new(Curve { name, ..curve }))
        }
        PartId::Panel(id) => {
            let panel = lookup::panel(pattern, id)?;
            let name = wished(name, |name| panel_owner(pattern, panel, name))?;
            let panel = (**panel).clone();
            Entity::Panel(Arc::new(Panel { name, ..panel }))
        }
        PartId::Size(_)
        | PartId::Variable(_)
        | PartId::Fabric(_)
        | PartId::Line(_)
        | PartId::Edge(_)
        | PartId::Notch(_)
        | PartId::Operation(_)
        | PartId::Seam(_)
        | PartId::Marker(_)
        | PartId::Guide(_) => return Ok(None),
    }))
}

/// A size, a variable, a fabric, a seam or a marker with the new name.
fn of_pattern(pattern: &Pattern, part: PartId, name: &str) -> Result<Entity, EditError> {
    let missing = || EditError::Missing(part.to_string());
    Ok(match part {
        PartId::Size(id) => {
            let size = pattern.sizes.iter().find(|size| size.id == id);
            let others = pattern.sizes.iter().filter(|size| size.id != id);
            let name = free(name, "size", others.map(|size| &*size.name))?;
            let size = (**size.ok_or_else(missing)?).clone();
            Entity::Size(Arc::new(Size { name, ..size }))
        }
        PartId::Variable(id) => {
            let variable = pattern.variables.iter().find(|variable| variable.id == id);
            let variable = (**variable.ok_or_else(missing)?).clone();
            let name = variable_name(pattern, Some(&variable), name)?;
            Entity::Variable(Arc::new(Variable { name, ..variable }))
        }
        PartId::Fabric(id) => {
            let others = pattern.fabrics.iter().filter(|fabric| fabric.id != id);
            let name = free(name, "fabric", others.map(|fabric| &*fabric.name))?;
            let fabric = (**pattern.fabric(id).ok_or_else(missing)?).clone();
            Entity::Fabric(Arc::new(Fabric { name, ..fabric }))
        }
        PartId::Seam(id) => {
            let others = pattern.seams.iter().filter(|seam| seam.id != id);
            let name = free(name, "seam", others.map(|seam| &*seam.name))?;
            let seam = (**lookup::seam(pattern, id)?).clone();
            Entity::Seam(Arc::new(Seam { name, ..seam }))
        }
        PartId::Marker(id) => {
            let others = pattern.markers.iter().filter(|marker| marker.id != id);
            let name = free(name, "marker", others.map(|marker| &*marker.name))?;
            let marker = (**pattern.marker(id).ok_or_else(missing)?).clone();
            Entity::Marker(Arc::new(Marker { name, ..marker }))
        }
        PartId::Sheet(_)
        | PartId::Point(_)
        | PartId::Curve(_)
        | PartId::Panel(_)
        | PartId::Line(_)
        | PartId::Edge(_)
        | PartId::Notch(_)
        | PartId::Operation(_)
        | PartId::Guide(_) => return Err(missing()),
    })
}

/// The name for a variable; refused if it is taken or is the name of a measurement. In files, formulas that
/// name the measurement would then refer to the variable.
pub(super) fn variable_name(
    pattern: &Pattern,
    own: Option<&Variable>,
    name: &str,
) -> Result<String, EditError> {
    let others = pattern.variables.iter();
    let others = others.filter(|variable| own.is_none_or(|own| own.id != variable.id));
    let name = free(name, "variable", others.map(|variable| &*variable.name))?;
    let is_measured = pattern
        .sizes
        .iter()
        .any(|size| size.measurements.contains(&name));
    let is_own = own.is_some_and(|own| own.name == name);
    if !is_own && name == PI {
        return Err(impossible(
            "\"pi\" is the number 3.14159..., and formulas would not tell them apart",
            "choose another name",
        ));
    }
    if !is_own && (is_measured || definition(&name).is_some()) {
        return Err(impossible(
            format!("{name:?} is a measurement, and formulas would not tell them apart"),
            "choose another name",
        ));
    }
    Ok(name)
}

/// The name; refused if another part of this kind has it.
fn free<'n>(
    name: &str,
    kind: &str,
    others: impl Iterator<Item = &'n str> + Clone,
) -> Result<String, EditError> {
    wished(name, |name| {
        let mut others = others.clone();
        others
            .any(|other| other == name)
            .then(|| format!("{kind} {name:?}"))
    })
}

/// A copy of a panel, with one of its own parts renamed.
fn renamed(panel: &Panel, part: PartId, name: &str) -> Result<Panel, EditError> {
    let mut changed = panel.clone();
    let of = |kind: &str, names: Vec<(PartId, &str)>| {
        let others = names.into_iter().filter(|(id, _)| *id != part);
        let names: Vec<&str> = others.map(|(_, name)| name).collect();
        wished(name, |name| {
            names
                .contains(&name)
                .then(|| format!("{kind} {name:?} of panel {:?}", panel.name))
        })
    };
    let lines = panel.lines.iter().map(|line| (line.id.into(), &*line.name));
    let edges = panel.edges().map(|edge| (edge.id.into(), &*edge.name));
    let notches = panel.notches.iter().map(|n| (n.id.into(), &*n.name));
    let operations = panel.operations.iter().map(|o| (o.id.into(), &*o.name));
    match part {
        PartId::Line(id) => {
            let name = of("line", lines.collect())?;
            let own = changed.lines.iter_mut().filter(|line| line.id == id);
            own.for_each(|line| line.name.clone_from(&name));
        }
        PartId::Edge(id) => {
            let name = of("edge", edges.collect())?;
            let all = changed.lines.iter_mut().flat_map(|line| &mut line.edges);
            all.filter(|edge| edge.id == id)
                .for_each(|edge| edge.name.clone_from(&name));
        }
        PartId::Notch(id) => {
            let name = of("notch", notches.collect())?;
            let own = changed.notches.iter_mut().filter(|notch| notch.id == id);
            own.for_each(|notch| notch.name.clone_from(&name));
        }
        PartId::Operation(id) => {
            let name = of("operation", operations.collect())?;
            let own = changed.operations.iter_mut().filter(|known| known.id == id);
            own.for_each(|known| Arc::make_mut(known).name.clone_from(&name));
        }
        PartId::Size(_)
        | PartId::Variable(_)
        | PartId::Fabric(_)
        | PartId::Sheet(_)
        | PartId::Point(_)
        | PartId::Curve(_)
        | PartId::Panel(_)
        | PartId::Seam(_)
        | PartId::Marker(_)
        | PartId::Guide(_) => {
            return Err(EditError::Missing(part.to_string()));
        }
    }
    Ok(changed)
}
