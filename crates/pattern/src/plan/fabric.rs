//! Fabrics: made, copied, given other figures, put on panels, taken away.

use super::impossible;
use super::names::free_name;
use crate::{Edit, EditError, Entity, Evaluation, Fabric, FabricId, Pattern, is_part_name};
use std::sync::Arc;
use toile_fabric::Component;

/// A number of a fabric that the window changes: the width of its roll, or one of its material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FabricFigure {
    /// Width of the roll (m).
    Width,
    /// A number of the material.
    Material(Component),
}

/// Widths of a roll that can be given (m).
const WIDTHS: [f64; 2] = [0.05, 20.0];

impl FabricFigure {
    /// All of them, the width first.
    pub fn all() -> impl Iterator<Item = Self> {
        std::iter::once(Self::Width).chain(Component::all().map(Self::Material))
    }

    /// The value for a fabric (SI); nothing where a cloth can be without it and is.
    pub fn of(self, fabric: &Fabric) -> Option<f64> {
        match self {
            Self::Width => Some(fabric.width),
            Self::Material(component) => component.of(&fabric.material),
        }
    }

    /// The label beside it.
    pub fn name(self) -> String {
        match self {
            Self::Width => "Width".to_owned(),
            Self::Material(component) => component.label(),
        }
    }

    /// Explanation for somebody who sews.
    pub fn about(self) -> &'static str {
        match self {
            Self::Width => "The roll from selvedge to selvedge, selvedges included",
            Self::Material(component) => component.figure.about,
        }
    }

    /// The unit it is shown in, and the value of that in SI units.
    pub fn unit(self) -> (&'static str, f64) {
        match self {
            Self::Width => ("m", 1.0),
            Self::Material(component) => {
                (component.figure.unit.shown, component.figure.unit.factor)
            }
        }
    }

    /// Whether patterns usually say it: it is always written, or published for common cloths.
    pub fn is_usual(self) -> bool {
        match self {
            Self::Width => true,
            Self::Material(Component { figure, .. }) => {
                figure.is_always_written || figure.source.is_some()
            }
        }
    }

    /// Whether a cloth can be without it.
    pub fn may_be_absent(self) -> bool {
        match self {
            Self::Width => false,
            Self::Material(component) => component.figure.may_be_absent(),
        }
    }

    /// Whether a cloth can have a value (SI).
    ///
    /// # Errors
    /// It cannot: the values that there are, in the unit shown.
    pub fn check(self, value: Option<f64>) -> Result<(), String> {
        match self {
            Self::Width => {
                let [min, max] = WIDTHS;
                match value.is_some_and(|width| (min..=max).contains(&width)) {
                    true => Ok(()),
                    false => Err(format!("give {min} to {max} m")),
                }
            }
            Self::Material(component) => component.check(value),
        }
    }

    fn set(self, fabric: &mut Fabric, value: Option<f64>) {
        match self {
            Self::Width => fabric.width = value.unwrap_or(fabric.width),
            Self::Material(component) => component.set(&mut fabric.material, value),
        }
    }
}

fn fabric(pattern: &Pattern, id: FabricId) -> Result<&Arc<Fabric>, EditError> {
    let found = pattern.fabric(id);
    found.ok_or_else(|| EditError::Missing(id.to_string()))
}

/// The edits that add a fabric; and the fabric. Where its name is taken it gets the next free one, as `denim 2`.
///
/// # Errors
/// It can have no such name.
pub fn add_fabric(
    evaluation: &Evaluation,
    new: Fabric,
) -> Result<(Vec<Edit>, FabricId), EditError> {
    let pattern = evaluation.pattern();
    if !is_part_name(&new.name) {
        return Err(EditError::Name(new.name));
    }
    let taken = |name: &str| pattern.fabrics.iter().any(|known| known.name == name);
    let mut ids = pattern.ids;
    let id: FabricId = ids.take();
    let name = free_name(&new.name, taken);
    let added = Fabric { id, name, ..new };
    Ok((vec![Edit::Put(Entity::Fabric(Arc::new(added)))], id))
}

/// The edits that change a fabric of the pattern, whose id it has.
///
/// # Errors
/// The fabric is not there; one of its figures is none that a cloth can have.
pub fn set_fabric(evaluation: &Evaluation, changed: Fabric) -> Result<Vec<Edit>, EditError> {
    let before = fabric(evaluation.pattern(), changed.id)?;
    for figure in FabricFigure::all() {
        let value = figure.of(&changed);
        // Files may hold others: they are kept until they are changed.
        if value == figure.of(before) {
            continue;
        }
        if let Err(hint) = figure.check(value) {
            let name = figure.name().to_lowercase();
            let shown = match value {
                Some(value) => format!("{}", value / figure.unit().1),
                None => "absent".to_owned(),
            };
            let message = format!("the {name} of fabric {:?} is {shown}", changed.name);
            return Err(impossible(message, hint));
        }
    }
    Ok(vec![Edit::Put(Entity::Fabric(Arc::new(changed)))])
}

/// The edits that give a fabric another value of a figure (SI).
///
/// # Errors
/// As [`set_fabric`].
pub fn set_fabric_figure(
    evaluation: &Evaluation,
    mut changed: Fabric,
    (figure, value): (FabricFigure, Option<f64>),
) -> Result<Vec<Edit>, EditError> {
    figure.set(&mut changed, value);
    set_fabric(evaluation, changed)
}

/// The edits that take a fabric away.
///
/// # Errors
/// The fabric is not there, or panels or markers use it: they are named.
pub fn remove_fabric(evaluation: &Evaluation, id: FabricId) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    let gone = fabric(pattern, id)?;
    let panels = pattern.panels.iter().filter(|panel| panel.fabric == id);
    let panels = panels.map(|panel| format!("panel {:?}", panel.name));
    let markers = pattern.markers.iter();
    let markers = markers.filter(|marker| marker.fabric == id);
    let users: Vec<String> = panels
        .chain(markers.map(|marker| format!("marker {:?}", marker.name)))
        .collect();
    match users.is_empty() {
        true => Ok(vec![Edit::Remove(id.into())]),
        false => Err(impossible(
            format!("fabric {:?} is used by {}", gone.name, users.join(", ")),
            "give them another fabric, or remove them, first",
        )),
    }
}
