//! Sizes and their measurements, variables, and what a pattern has besides its parts.

use super::bind::bound;
use super::lookup::after;
use super::names::{free_name, wished};
use super::rename::variable_name;
use super::{impossible, numbers, remove};
use crate::fields::NumberAddress;
use crate::{
    DisplayUnit, Edit, EditError, Entity, Evaluation, Head, Number, Size, SizeId, Variable,
    VariableId,
};
use std::sync::Arc;
use toile_measure::{Measurements, Origin};

/// The edits that add a size with measurements; and the size. Without a name it is called `size`,
/// `size 2`, ...
///
/// # Errors
/// The name is taken or can be none.
pub fn add_size(
    evaluation: &Evaluation,
    name: Option<&str>,
    measurements: Measurements,
) -> Result<(Vec<Edit>, SizeId), EditError> {
    let pattern = evaluation.pattern();
    let owner = |name: &str| pattern.size_named(name).map(|_| format!("size {name:?}"));
    let name = match name {
        Some(name) => wished(name, owner)?,
        None => free_name("size", |name| owner(name).is_some()),
    };
    let mut ids = pattern.ids;
    let id: SizeId = ids.take();
    let size = Arc::new(Size {
        id,
        name,
        measurements,
    });
    Ok((vec![Edit::Put(Entity::Size(size))], id))
}

/// The edits that take a size away; values that other parts have for it wait for its return. If it
/// was the base size, the first of the others is.
///
/// # Errors
/// The size is not there.
pub fn remove_size(evaluation: &Evaluation, size: SizeId) -> Result<Vec<Edit>, EditError> {
    remove::remove_parts(evaluation, &[size.into()])
}

/// The edits that set a measurement of a size (m) or (rad), or take it out of its table.
///
/// # Errors
/// The size is not there, or has no such measurement to take out; the name is no measurement's;
/// the value is not finite.
pub fn set_measurement(
    evaluation: &Evaluation,
    size: SizeId,
    name: &str,
    value: Option<f64>,
) -> Result<Vec<Edit>, EditError> {
    let mut sizes = evaluation.pattern().sizes.iter();
    let found = sizes.find(|known| known.id == size);
    let mut changed = (**found.ok_or_else(|| EditError::Missing(size.to_string()))?).clone();
    match value {
        Some(value) => changed
            .measurements
            .set(name, value, Origin::Asked)
            .map_err(|error| {
                let told = error.to_string();
                let (message, hint) = told.split_once(": ").unwrap_or((&told, "choose another"));
                impossible(message, hint)
            })?,
        None => {
            let own = toile_measure::definition(name).map_or(name, |known| known.name);
            if changed.measurements.remove(own).is_none() {
                let what = format!("measurement {name:?} of size {:?}", changed.name);
                return Err(EditError::Missing(what));
            }
        }
    }
    Ok(vec![Edit::Put(Entity::Size(Arc::new(changed)))])
}

/// The edits that add a variable; and the variable. Without a name it is called `v1`, `v2`, ...
/// Formulas that speak of a variable of that name, and found none, mean it from now on.
///
/// # Errors
/// The name is taken, that of a measurement or can be none; the number has no value.
pub fn add_variable(
    evaluation: &Evaluation,
    name: Option<&str>,
    number: Number,
) -> Result<(Vec<Edit>, VariableId), EditError> {
    let pattern = evaluation.pattern();
    let name = match name {
        Some(name) => variable_name(pattern, None, name)?,
        None => super::names::numbered_name("v", |name| pattern.variable_named(name).is_some()),
    };
    let mut ids = pattern.ids;
    let id: VariableId = ids.take();
    let variable = Arc::new(Variable { id, name, number });
    let mut edits = vec![Edit::Put(Entity::Variable(variable))];
    numbers::refuse_valueless(evaluation, &edits, &NumberAddress::new(id, "value"))?;
    edits.extend(bound(&after(evaluation, &edits)?));
    Ok((edits, id))
}

fn head(evaluation: &Evaluation) -> Head {
    let pattern = evaluation.pattern();
    Head {
        name: pattern.name.clone(),
        unit: pattern.unit,
        base_size: pattern.base_size,
    }
}

/// The edits that make a size the base size, or the first one if nothing is chosen.
///
/// # Errors
/// The size is not there.
pub fn set_base_size(
    evaluation: &Evaluation,
    size: Option<SizeId>,
) -> Result<Vec<Edit>, EditError> {
    let mut sizes = evaluation.pattern().sizes.iter();
    if let Some(id) = size
        && !sizes.any(|known| known.id == id)
    {
        return Err(EditError::Missing(id.to_string()));
    }
    Ok(vec![Edit::Put(Entity::Head(Head {
        base_size: size,
        ..head(evaluation)
    }))])
}

/// The edits that show lengths in another unit; no length changes.
pub fn set_unit(evaluation: &Evaluation, unit: DisplayUnit) -> Vec<Edit> {
    vec![Edit::Put(Entity::Head(Head {
        unit,
        ..head(evaluation)
    }))]
}

/// The edits that give the pattern another name.
///
/// # Errors
/// It is none that a part may have.
pub fn rename_pattern(evaluation: &Evaluation, name: &str) -> Result<Vec<Edit>, EditError> {
    Ok(vec![Edit::Put(Entity::Head(Head {
        name: wished(name, |_| None)?,
        ..head(evaluation)
    }))])
}
