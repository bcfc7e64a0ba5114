//! Sizes with their measurements, variables, and the name, unit and base size of a pattern.

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

/// Plans to add a size with measurements; returns the size too. Without a name the size is called `size`,
/// `size 2`, ...
///
/// # Errors
/// The name is taken or not allowed.
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

/// Plans to remove a size. Values that numbers have for this size stay, and are valid again if the size comes
/// back. If it was the base size, the first other size becomes the base size.
///
/// # Errors
/// The size is missing.
pub fn remove_size(evaluation: &Evaluation, size: SizeId) -> Result<Vec<Edit>, EditError> {
    remove::remove_parts(evaluation, &[size.into()])
}

/// Plans to set a measurement of a size (m) or (rad), or, without a value, to remove it from the size's
/// table.
///
/// # Errors
/// The size is missing, or has no such measurement to remove; the name is not that of a measurement; the
/// value is not finite.
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

/// Plans to add a variable; returns the variable too. Without a name the variable is called `v1`, `v2`, ...
/// Formulas in which its name stood for no part refer to the variable afterwards.
///
/// # Errors
/// The name is taken, is the name of a measurement or is not allowed; the number has no value.
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

/// Plans to make a size the base size. `None`: the first size is used.
///
/// # Errors
/// The size is missing.
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

/// Plans to show lengths in another unit; the lengths themselves stay.
pub fn set_unit(evaluation: &Evaluation, unit: DisplayUnit) -> Vec<Edit> {
    vec![Edit::Put(Entity::Head(Head {
        unit,
        ..head(evaluation)
    }))]
}

/// Plans to rename the pattern.
///
/// # Errors
/// The name is not allowed.
pub fn rename_pattern(evaluation: &Evaluation, name: &str) -> Result<Vec<Edit>, EditError> {
    Ok(vec![Edit::Put(Entity::Head(Head {
        name: wished(name, |_| None)?,
        ..head(evaluation)
    }))])
}
