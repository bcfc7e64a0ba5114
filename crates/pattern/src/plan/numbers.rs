//! Reads and sets the numbers of parts, each by its address.

use super::impossible;
use super::lookup::{after, refuse_faults};
use super::moving::added;
use crate::fields::{NumberAddress, NumberEntry, NumberSlot, with_number};
use crate::{
    Code, Edit, EditError, Entity, Evaluation, Number, PartId, Pattern, Place, SizeId, VariableId,
};

/// The numbers of a part, in the order in which inspectors show them; empty if the part has no numbers or is
/// missing.
pub fn numbers_of(evaluation: &Evaluation, part: PartId) -> Vec<NumberEntry> {
    let entity = evaluation.pattern().entity_with(part);
    entity.map_or_else(Vec::new, |entity| entity.number_entries(Some(part)))
}

/// The number at an address, with its label and quantity. `None`: it does not exist.
pub fn number_entry(pattern: &Pattern, place: &NumberAddress) -> Option<NumberEntry> {
    let entries = pattern
        .entity_with(place.part)?
        .number_entries(Some(place.part));
    entries.into_iter().find(|entry| entry.place == *place)
}

/// The number at an address. `None`: it does not exist or is left out.
pub fn number_at(pattern: &Pattern, place: &NumberAddress) -> Option<Number> {
    number_entry(pattern, place)?.number
}

/// Sets the number at an address in an entity; returns whether the number exists there.
pub(super) fn put_number(entity: &mut Entity, place: &NumberAddress, number: &Number) -> bool {
    let mut is_there = false;
    entity.change(&mut |part| {
        is_there = with_number(part, place, &mut |slot| match slot {
            NumberSlot::Always(old) => *old = number.clone(),
            NumberSlot::Optional(old) => *old = Some(number.clone()),
        });
    });
    is_there
}

/// Plans to set the number at an address.
///
/// # Errors
/// The entity has no number at the address; the new number has no value, has the wrong dimension, or depends
/// on itself.
pub fn set_number(
    evaluation: &Evaluation,
    place: &NumberAddress,
    number: Number,
) -> Result<Vec<Edit>, EditError> {
    let mut entity = entity(evaluation, place)?;
    if !put_number(&mut entity, place, &number) {
        return Err(missing(place));
    }
    let edits = vec![Edit::Put(entity)];
    refuse_valueless(evaluation, &edits, place)?;
    Ok(edits)
}

/// Plans to bring the number at an address to the value `to` (m), (rad) or plain, for the current
/// measurements. A number that is a value is set to it; a formula stays and gets an adjustment.
///
/// # Errors
/// The address has no number; the number has no value now, or would have none after the change.
pub fn adjust_number(
    evaluation: &Evaluation,
    place: &NumberAddress,
    to: f64,
) -> Result<Vec<Edit>, EditError> {
    let entry = number_entry(evaluation.pattern(), place).ok_or_else(|| missing(place))?;
    let number = entry.number.ok_or_else(|| missing(place))?;
    let now = match VariableId::try_from(place.part) {
        Ok(id) => evaluation.variable(id).map(|found| found.0),
        Err(_) => evaluation.number(&number, entry.want),
    };
    let now = now.ok_or_else(|| {
        impossible(
            format!("the {} of {} has no value", entry.label, place.part),
            "mend its formula first, or give it another number",
        )
    })?;
    set_number(evaluation, place, added(&number, to - now))
}

/// Plans to give a number another value in one size (m), (rad) or plain, or to remove that value if `value`
/// is `None`. The number stays unchanged for all other sizes.
///
/// # Errors
/// The size is missing, or the address has no number; the value is not finite.
pub fn set_number_in_size(
    evaluation: &Evaluation,
    place: &NumberAddress,
    (size, value): (SizeId, Option<f64>),
) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    if !pattern.sizes.iter().any(|known| known.id == size) {
        return Err(EditError::Missing(size.to_string()));
    }
    let number = number_at(pattern, place).ok_or_else(|| missing(place))?;
    let (usual, mut sizes) = match number {
        Number::PerSize { usual, sizes } => (usual, sizes),
        other @ (Number::Value(_) | Number::Formula(_) | Number::Adjusted { .. }) => {
            (Box::new(other), Vec::new())
        }
    };
    let at = sizes.iter().position(|own| own.0 == size);
    match (at, value) {
        (Some(k), Some(value)) => sizes[k].1 = value,
        (Some(k), None) => {
            sizes.remove(k);
        }
        (None, Some(value)) => sizes.push((size, value)),
        (None, None) => {}
    }
    let number = match sizes.is_empty() {
        true => *usual,
        false => Number::PerSize { usual, sizes },
    };
    set_number(evaluation, place, number)
}

/// Plans to leave a number out. An edge then has the allowance of its panel, a spline its handles as drawn,
/// and for the level of a panel on the body the program decides.
///
/// # Errors
/// The address has no number, or the number cannot be left out.
pub fn clear_number(
    evaluation: &Evaluation,
    place: &NumberAddress,
) -> Result<Vec<Edit>, EditError> {
    let mut entity = entity(evaluation, place)?;
    let mut can_be = false;
    let mut is_there = false;
    entity.change(&mut |part| {
        is_there = with_number(part, place, &mut |slot| {
            if let NumberSlot::Optional(old) = slot {
                *old = None;
                can_be = true;
            }
        });
    });
    match (is_there, can_be) {
        (false, _) => Err(missing(place)),
        (true, false) => {
            let entry = number_entry(evaluation.pattern(), place);
            let label = entry.map_or("number", |entry| entry.label);
            Err(impossible(
                format!("the {label} cannot be left out"),
                "give it a number, zero if need be",
            ))
        }
        (true, true) => Ok(vec![Edit::Put(entity)]),
    }
}

fn entity(evaluation: &Evaluation, place: &NumberAddress) -> Result<Entity, EditError> {
    let entity = evaluation.pattern().entity_with(place.part);
    entity.ok_or_else(|| missing(place))
}

fn missing(place: &NumberAddress) -> EditError {
    let key = place.path.rsplit('.').next().unwrap_or_default();
    EditError::Missing(format!("the {key} of {}", place.part))
}

/// Refuses edits after which the number at an address has a fault itself or depends on itself. A number
/// without value because other parts are missing is accepted.
pub(super) fn refuse_valueless(
    evaluation: &Evaluation,
    edits: &[Edit],
    place: &NumberAddress,
) -> Result<(), EditError> {
    let after = after(evaluation, edits)?;
    let old = evaluation.diagnostics();
    let cycles = after.diagnostics().into_iter();
    let mut cycles = cycles.filter(|found| found.code == Code::Cycle && !old.contains(found));
    if let Some(found) = cycles.next() {
        return Err(impossible(found.message, found.hint));
    }
    if let PartId::Variable(id) = place.part {
        return refuse_faults(evaluation, &after, &[Place::Variable(id)]);
    }
    let Some(entry) = number_entry(after.pattern(), place) else {
        return Ok(());
    };
    let Some(number) = entry.number else {
        return Ok(());
    };
    let (_, faults) = after.number_of_kind(&number, entry.want, &Place::Pattern, entry.label);
    match faults.into_iter().next() {
        Some(found) => Err(impossible(found.message, found.hint)),
        None => Ok(()),
    }
}
