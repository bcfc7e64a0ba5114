//! Pastes fragments, duplicates parts, and inserts the panels of another pattern.

use super::fragment::{Fragment, Outside, copy, copy_all, references};
use super::impossible;
use super::lookup::{after, finite, sheet};
use super::names::{curve_owner, free_name, letter_name, panel_owner, sheet_owner};
use super::numbers::{number_entry, put_number};
use super::transform::move_points;
use crate::fields::{NumberAddress, Remap};
use crate::{
    Edit, EditError, Entity, Evaluation, Fabric, Formula, FreshId, Ids, Number, PartId, Pattern,
    PointId, SheetId, SizeId, Token, Variable,
};
use std::collections::HashSet;
use std::sync::Arc;
use toile_geometry::{Bounds2, Vec2};

/// Distance between parts and their duplicates (m).
const GAP: f64 = 0.05;

/// Destination of a pasted fragment.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct PasteTarget {
    /// The sheet to paste onto. `None`: new sheets are made.
    pub sheet: Option<SheetId>,
    /// Displacement of the parts on the sheet, or of new sheets on the table (m).
    pub offset: [f64; 2],
}

/// Result of pasting.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Pasted {
    /// The edits that paste the parts.
    pub edits: Vec<Edit>,
    /// New points, curves, sheets, panels, seams and variables.
    pub parts: Vec<PartId>,
    /// Numbers whose formulas name parts that this pattern does not have: each is now a value or, if it had
    /// no value, needs a new number.
    pub loosened: Vec<NumberAddress>,
    /// Names of sizes that this pattern does not have: values of numbers for these sizes are left out.
    pub lost_sizes: Vec<String>,
}

/// Plans to paste a fragment, with new ids and free names. A formula keeps its reference to a part outside
/// the fragment if the fragment was copied from this pattern and the part still exists; otherwise the number
/// becomes the value that it had, and is listed in the result.
///
/// # Errors
/// The sheet is missing; the offset is not finite; two parts of the fragment have the same id, or the pattern
/// does not accept one of the parts.
pub fn paste(
    evaluation: &Evaluation,
    fragment: &Fragment,
    target: PasteTarget,
) -> Result<Pasted, EditError> {
    let offset = Vec2::from(target.offset);
    finite("the offset", &[offset])?;
    let pattern = evaluation.pattern();
    if let Some(id) = target.sheet {
        sheet(pattern, id)?;
    }
    let mut pasting = Pasting {
        work: pattern.clone(),
        known: pattern.parts().into_iter().map(|(id, _)| id).collect(),
        ids: pattern.ids,
        remap: Remap::default(),
        result: Pasted::default(),
    };
    refuse_doubles(fragment)?;
    let fragment = pasting.loosened(fragment)?;
    pasting.number(&fragment, target.sheet);
    for entity in fragment.entities() {
        pasting.put(entity, target)?;
    }
    let result = pasting.finished(&fragment);
    match target.sheet {
        Some(_) if offset != Vec2::zeros() => moved(evaluation, result, offset),
        _ => Ok(result),
    }
}

/// Refuses fragments in which two parts have the same id: references to it would be ambiguous.
fn refuse_doubles(fragment: &Fragment) -> Result<(), EditError> {
    let mut seen = HashSet::new();
    let parts = fragment.as_pattern().parts().into_iter();
    match parts.map(|(id, _)| id).find(|id| !seen.insert(id.number())) {
        Some(id) => Err(impossible(
            format!("two parts of the fragment have the id {id}"),
            "copy it again",
        )),
        None => Ok(()),
    }
}

/// Plans to duplicate parts beside the originals: panels with a new sheet to the right on the table, points
/// and curves to the right on their own sheet.
///
/// # Errors
/// Any error of [`copy`] and [`paste`].
pub fn duplicate(evaluation: &Evaluation, parts: &[PartId]) -> Result<Pasted, EditError> {
    let fragment = copy(evaluation, parts)?;
    let points = fragment.sheets.iter().flat_map(|sheet| &sheet.points);
    let places = points.filter_map(|point| evaluation.point(point.id));
    let bounds = Bounds2::of(places);
    let width = bounds.size().x;
    let width = if width.is_finite() {
        width.max(0.0)
    } else {
        0.0
    };
    let own = match fragment.sheets.as_slice() {
        [only] if fragment.panels.is_empty() => Some(only.id),
        _ => None,
    };
    let is_whole = parts.iter().any(|part| matches!(part, PartId::Sheet(_)));
    let target = PasteTarget {
        sheet: own.filter(|_| !is_whole),
        offset: [width + GAP, 0.0],
    };
    paste(evaluation, &fragment, target)
}

/// Plans to insert another pattern, with its sheets, panels, seams, variables and fabrics, at an offset on
/// the table (m). Its sizes are left out, since it is then drafted for the sizes of this pattern, and so are
/// its markers, which were laid for its own sizes.
///
/// # Errors
/// The other pattern has nothing to insert; any error of [`paste`].
pub fn insert_pattern(
    evaluation: &Evaluation,
    other: &Evaluation,
    offset: [f64; 2],
) -> Result<Pasted, EditError> {
    let mut fragment = copy_all(other)?;
    // Even if both patterns have the same name they are different: no reference may lead to a part of this
    // pattern.
    fragment
        .outside
        .iter_mut()
        .for_each(|outside| outside.words = None);
    let target = PasteTarget {
        sheet: None,
        offset,
    };
    paste(evaluation, &fragment, target)
}

struct Pasting {
    /// The pattern with all parts that are pasted so far.
    work: Pattern,
    /// The parts that the pattern had before pasting.
    known: HashSet<PartId>,
    ids: Ids,
    remap: Remap,
    result: Pasted,
}

impl Pasting {
    /// The fragment, with numbers replaced by their values if they name parts that this pattern does not
    /// have.
    fn loosened(&mut self, fragment: &Fragment) -> Result<Fragment, EditError> {
        let mut own = fragment.as_pattern();
        let mine: HashSet<PartId> = own.parts().into_iter().map(|(id, _)| id).collect();
        let places = self.work.parts();
        let is_here = |outside: &Outside| {
            let place = places.iter().find(|(id, _)| *id == outside.part);
            let words = place.map(|(_, place)| self.work.describe(place));
            words.is_some() && words == outside.words && self.work.name == fragment.pattern
        };
        let outside = fragment.outside.iter().filter(|outside| is_here(outside));
        let here: HashSet<PartId> = outside.map(|outside| outside.part).collect();
        let stays =
            |id: &PartId| mine.contains(id) || here.contains(id) || matches!(id, PartId::Size(_));
        for outside in &fragment.values {
            let entity = own.entity_with(outside.place.part);
            let entry = number_entry(&own, &outside.place);
            let (Some(mut entity), Some(number)) = (entity, entry.and_then(|entry| entry.number))
            else {
                continue;
            };
            if references(&number).iter().all(stays) {
                continue;
            }
            self.result.loosened.push(outside.place.clone());
            if let Some(value) = outside.value {
                let is_variable = matches!(outside.place.part, PartId::Variable(_));
                let number = match is_variable && outside.power == 1 {
                    true => length(value),
                    false => Number::Value(value),
                };
                put_number(&mut entity, &outside.place, &number);
                own.apply(&[Edit::Put(entity)])?;
            }
        }
        let changed = Fragment {
            sheets: own.sheets,
            panels: own.panels,
            seams: own.seams,
            variables: own.variables,
            ..fragment.clone()
        };
        // A part that does not exist here gets an unused id, so that the reference does not lead to another
        // part.
        for entity in changed.entities() {
            for lost in entity.references().into_iter().filter(|id| !stays(id)) {
                let ids = &mut self.ids;
                self.remap
                    .ids
                    .entry(lost)
                    .or_insert_with(|| fresh(lost, ids));
            }
        }
        Ok(changed)
    }

    /// Maps the id of every part of a fragment to a new id, or to that of an equal part that exists here
    /// already.
    fn number(&mut self, fragment: &Fragment, sheet: Option<SheetId>) {
        for (part, _) in fragment.as_pattern().parts() {
            let known = match (part, sheet) {
                (PartId::Sheet(_), Some(sheet)) => Some(sheet.into()),
                (PartId::Fabric(_), _) => self.same_fabric(&fragment.fabrics, part),
                (PartId::Variable(_), _) => self.same_variable(&fragment.variables, part),
                _ => None,
            };
            let new = known.unwrap_or_else(|| fresh(part, &mut self.ids));
            self.remap.ids.insert(part, new);
        }
        for outside in &fragment.outside {
            let PartId::Size(id) = outside.part else {
                continue;
            };
            let named = outside
                .name
                .as_deref()
                .and_then(|name| self.work.size_named(name));
            match named.map(|size| size.id) {
                Some(own) => {
                    self.remap.sizes.insert(id, own);
                }
                None => {
                    let name = outside.name.clone().unwrap_or_else(|| id.to_string());
                    self.result.lost_sizes.push(name);
                }
            }
        }
    }

    /// The fabric of this pattern with the same name.
    fn same_fabric(&self, fabrics: &[Arc<Fabric>], part: PartId) -> Option<PartId> {
        let fabric = fabrics
            .iter()
            .find(|fabric| PartId::from(fabric.id) == part)?;
        let mut own = self.work.fabrics.iter();
        own.find(|own| own.name == fabric.name)
            .map(|own| own.id.into())
    }

    /// The variable of this pattern with the same name and the same number, if its formula names only
    /// measurements.
    fn same_variable(&self, variables: &[Arc<Variable>], part: PartId) -> Option<PartId> {
        let variable = variables.iter().find(|v| PartId::from(v.id) == part)?;
        let own = self.work.variable_named(&variable.name)?;
        let tokens = variable.number.as_formula().map_or(&[][..], |f| f.tokens());
        let is_of_body = tokens
            .iter()
            .all(|t| matches!(t, Token::Text(_) | Token::Word(_)));
        (is_of_body && own.number == variable.number).then(|| own.id.into())
    }

    /// Puts an entity of the fragment into the pattern, with its new id and a free name.
    fn put(&mut self, entity: Entity, target: PasteTarget) -> Result<(), EditError> {
        let mut entity = self.remap.entity(entity);
        let is_here = |id: PartId| self.known.contains(&id);
        if entity.id().is_none_or(is_here) {
            return Ok(());
        }
        self.rename(&mut entity);
        // Panels keep their displacement from their sheet.
        if let Entity::Sheet(head) = &mut entity {
            head.on_table[0] += target.offset[0];
            head.on_table[1] += target.offset[1];
        }
        self.result.parts.extend(entity.id());
        let edit = Edit::Put(entity);
        put_unchecked(&mut self.work, &edit)?;
        self.result.edits.push(edit);
        Ok(())
    }

    fn rename(&self, entity: &mut Entity) {
        let work = &self.work;
        match entity {
            Entity::Head(_) | Entity::Size(_) | Entity::Marker(_) | Entity::Guide(_) => {}
            Entity::Fabric(fabric) => {
                let fabric = Arc::make_mut(fabric);
                let taken = |name: &str| work.fabrics.iter().any(|known| known.name == name);
                fabric.name = free_name(&fabric.name, taken);
            }
            Entity::Variable(variable) => {
                let variable = Arc::make_mut(variable);
                let taken = |name: &str| work.variable_named(name).is_some();
                variable.name = free_name(&variable.name, taken);
            }
            Entity::Sheet(head) => {
                let taken = |name: &str| sheet_owner(work, None, name).is_some();
                head.name = free_name(&head.name, taken);
            }
            Entity::Point(sheet, point) => {
                let point = Arc::make_mut(point);
                let sheet = work.sheet(*sheet);
                let taken = |name: &str| sheet.is_some_and(|s| s.point_named(name).is_some());
                point.name = point_name(&point.name, taken);
            }
            Entity::Curve(sheet, curve) => {
                let curve = Arc::make_mut(curve);
                let sheet = work.sheet(*sheet);
                let taken = |name: &str| sheet.is_some_and(|s| curve_owner(s, name).is_some());
                curve.name = free_name(&curve.name, taken);
            }
            Entity::Panel(panel) => {
                let panel = Arc::make_mut(panel);
                let taken = |name: &str| panel_owner(work, panel, name).is_some();
                panel.name = free_name(&panel.name, taken);
            }
            Entity::Seam(seam) => {
                let seam = Arc::make_mut(seam);
                let taken = |name: &str| work.seams.iter().any(|known| known.name == name);
                seam.name = free_name(&seam.name, taken);
            }
        }
    }

    /// The result of pasting; its addresses contain the new ids.
    fn finished(mut self, fragment: &Fragment) -> Pasted {
        let places = fragment.values.iter().map(|value| &value.place);
        let loose: Vec<NumberAddress> = places
            .filter(|place| self.result.loosened.contains(place))
            .map(|place| {
                let part = self.remap.ids.get(&place.part);
                NumberAddress::new(*part.unwrap_or(&place.part), place.path.clone())
            })
            .collect();
        self.result.loosened = loose;
        self.result
    }
}

/// A name for a pasted point: its own if it is free. If not, a point that is named by a letter gets the next
/// free letter, any other point its own name with a number.
fn point_name(name: &str, taken: impl Fn(&str) -> bool) -> String {
    if !taken(name) {
        return name.to_owned();
    }
    let mut characters = name.chars();
    let is_letter = characters.next().is_some_and(|c| c.is_ascii_uppercase())
        && characters.all(|c| c.is_ascii_digit());
    match is_letter {
        true => letter_name(taken),
        false => free_name(name, taken),
    }
}

/// A length as a variable needs it: a formula with a unit.
fn length(value: f64) -> Number {
    let formula = Formula::of_measurements(&format!("{value:?}m"));
    formula.map_or(Number::Value(value), Number::Formula)
}

fn fresh(part: PartId, ids: &mut Ids) -> PartId {
    fn take<T: From<FreshId> + Into<PartId>>(ids: &mut Ids) -> PartId {
        ids.take::<T>().into()
    }
    match part {
        PartId::Size(_) => take::<SizeId>(ids),
        PartId::Variable(_) => take::<crate::VariableId>(ids),
        PartId::Fabric(_) => take::<crate::FabricId>(ids),
        PartId::Sheet(_) => take::<SheetId>(ids),
        PartId::Point(_) => take::<PointId>(ids),
        PartId::Curve(_) => take::<crate::CurveId>(ids),
        PartId::Panel(_) => take::<crate::PanelId>(ids),
        PartId::Line(_) => take::<crate::LineId>(ids),
        PartId::Edge(_) => take::<crate::EdgeId>(ids),
        PartId::Notch(_) => take::<crate::NotchId>(ids),
        PartId::Operation(_) => take::<crate::OperationId>(ids),
        PartId::Seam(_) => take::<crate::SeamId>(ids),
        PartId::Marker(_) => take::<crate::MarkerId>(ids),
        PartId::Guide(_) => take::<crate::GuideId>(ids),
    }
}

/// Puts a part into a pattern without checking that the parts it refers to exist.
fn put_unchecked(work: &mut Pattern, edit: &Edit) -> Result<(), EditError> {
    let ids = std::mem::replace(&mut work.ids, Ids { next: u32::MAX });
    let result = work.apply(std::slice::from_ref(edit));
    work.ids = ids;
    result
}

/// Moves pasted points on their sheet.
fn moved(evaluation: &Evaluation, mut result: Pasted, offset: Vec2) -> Result<Pasted, EditError> {
    let pasted = after(evaluation, &result.edits)?;
    let goal = |part: &PartId| {
        let id = PointId::try_from(*part).ok()?;
        Some((id, pasted.point(id)? + offset))
    };
    let goals: Vec<(PointId, Vec2)> = result.parts.iter().filter_map(goal).collect();
    for edit in move_points(&pasted, &goals)?.edits {
        let Edit::Put(entity) = &edit else { continue };
        let own = entity.id();
        let same = |known: &Edit| matches!(known, Edit::Put(put) if put.id() == own);
        match result.edits.iter().position(same) {
            Some(k) => result.edits[k] = edit,
            None => result.edits.push(edit),
        }
    }
    Ok(result)
}
