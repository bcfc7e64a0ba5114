//! Fabrics: made, copied, given other figures, put on panels, taken away.

use super::impossible;
use super::names::free_name;
use crate::{Edit, EditError, Entity, Evaluation, Fabric, FabricId, Marker, Pattern, is_part_name};
use std::sync::Arc;
use toile_fabric::Component;

/// A number of a fabric that the window can change: the width of its roll, or a figure of its material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FabricFigure {
    /// Width of the roll (m).
    Width,
    /// A component of a figure of the material.
    Material(Component),
}

/// Least and greatest width of a roll that are accepted (m).
const WIDTHS: [f64; 2] = [0.05, 20.0];

impl FabricFigure {
    /// All figures, the width first.
    pub fn all() -> impl Iterator<Item = Self> {
        std::iter::once(Self::Width).chain(Component::all().map(Self::Material))
    }

    /// Value of the figure for a fabric (SI). `None`: the figure is optional, and the fabric does not have
    /// it.
    pub fn of(self, fabric: &Fabric) -> Option<f64> {
        match self {
            Self::Width => Some(fabric.width),
            Self::Material(component) => component.of(&fabric.material),
        }
    }

    /// Label of the figure.
    pub fn name(self) -> String {
        match self {
            Self::Width => "Width".to_owned(),
            Self::Material(component) => component.label(),
        }
    }

    /// Explanation of the figure for somebody who sews.
    pub fn about(self) -> &'static str {
        match self {
            Self::Width => "The roll from selvedge to selvedge, selvedges included",
            Self::Material(component) => component.figure.about,
        }
    }

    /// Unit in which the figure is shown, and the value of that unit in SI units.
    pub fn unit(self) -> (&'static str, f64) {
        match self {
            Self::Width => ("m", 1.0),
            Self::Material(component) => {
                (component.figure.unit.shown, component.figure.unit.factor)
            }
        }
    }

    /// Whether fabrics usually give the figure: it is always written, or published for common cloths.
    pub fn is_usual(self) -> bool {
        match self {
            Self::Width => true,
            Self::Material(Component { figure, .. }) => {
                figure.is_always_written || figure.source.is_some()
            }
        }
    }

    /// Whether a fabric may lack the figure.
    pub fn may_be_absent(self) -> bool {
        match self {
            Self::Width => false,
            Self::Material(component) => component.figure.may_be_absent(),
        }
    }

    /// Whether the figure may have this value (SI).
    ///
    /// # Errors
    /// The value is not allowed. The message gives the allowed values, in the unit shown.
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

/// Plans to add a fabric; returns the fabric too. If its name is taken it gets the next free one, such as
/// `denim 2`.
///
/// # Errors
/// The name is not allowed.
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

/// Plans to change the fabric of the pattern that has the id of `changed`.
///
/// # Errors
/// The fabric is missing; one of its changed figures has a value that is not allowed.
pub fn set_fabric(evaluation: &Evaluation, changed: Fabric) -> Result<Vec<Edit>, EditError> {
    let before = fabric(evaluation.pattern(), changed.id)?;
    for figure in FabricFigure::all() {
        let value = figure.of(&changed);
        // Files may hold values that are not allowed: they are accepted as long as they are not changed.
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

/// Plans to set a figure of a fabric to another value (SI).
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

/// Plans to remove a fabric.
///
/// # Errors
/// The fabric is missing, or panels or markers use it; the message names them.
pub fn remove_fabric(evaluation: &Evaluation, id: FabricId) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    let gone = fabric(pattern, id)?;
    let panels = pattern.panels.iter().filter(|panel| panel.fabric == id);
    let panels = panels.map(|panel| format!("panel {:?}", panel.name));
    let names = |marker: &&Arc<Marker>| {
        let part = Entity::Marker((*marker).clone());
        part.references().contains(&id.into())
    };
    let markers = pattern.markers.iter().filter(names);
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
