//! Fabrics: made, copied, given other figures, put on panels, taken away.

use super::impossible;
use super::names::free_name;
use crate::{Edit, EditError, Entity, Evaluation, Fabric, FabricId, Pattern, is_part_name};
use std::sync::Arc;

/// A number that tells how a fabric is: what a marker or a drape takes from it. Values are in SI units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FabricFigure {
    /// Width of the roll (m).
    Width,
    /// Mass per area (kg/m2).
    Weight,
    /// Thickness (m).
    Thickness,
    /// Stiffness in stretch along the warp (N/m).
    StretchWarp,
    /// Stiffness in stretch along the weft (N/m).
    StretchWeft,
    /// How much stiffer it gets along the warp as it is stretched (1).
    HardeningWarp,
    /// How much stiffer it gets along the weft as it is stretched (1).
    HardeningWeft,
    /// Stiffness in shear (N/m).
    Shear,
    /// How much it narrows where it is stretched (Poisson ratio) (1).
    Narrowing,
    /// Stiffness in bending along the warp (N m).
    BendWarp,
    /// Stiffness in bending along the weft (N m).
    BendWeft,
    /// Stiffness in bending on the bias (N m).
    BendBias,
    /// Coulomb friction against skin (1).
    Friction,
}

impl FabricFigure {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::Width,
        Self::Weight,
        Self::Thickness,
        Self::StretchWarp,
        Self::StretchWeft,
        Self::HardeningWarp,
        Self::HardeningWeft,
        Self::Shear,
        Self::Narrowing,
        Self::BendWarp,
        Self::BendWeft,
        Self::BendBias,
        Self::Friction,
    ];

    /// Its value for a fabric.
    pub fn of(self, fabric: &Fabric) -> f64 {
        *self.place(&mut fabric.clone())
    }

    /// Its name in the trade.
    pub fn name(self) -> &'static str {
        match self {
            Self::Width => "Width",
            Self::Weight => "Weight",
            Self::Thickness => "Thickness",
            Self::StretchWarp => "Stretch, warp",
            Self::StretchWeft => "Stretch, weft",
            Self::HardeningWarp => "Hardening, warp",
            Self::HardeningWeft => "Hardening, weft",
            Self::Shear => "Shear",
            Self::Narrowing => "Narrowing",
            Self::BendWarp => "Bend, warp",
            Self::BendWeft => "Bend, weft",
            Self::BendBias => "Bend, bias",
            Self::Friction => "Friction",
        }
    }

    /// The unit it is told in, and that in SI units.
    pub fn unit(self) -> (&'static str, f64) {
        match self {
            Self::Width => ("m", 1.0),
            Self::Weight => ("g/m\u{b2}", 1e-3),
            Self::Thickness => ("mm", 1e-3),
            Self::StretchWarp | Self::StretchWeft | Self::Shear => ("N/m", 1.0),
            Self::BendWarp | Self::BendWeft | Self::BendBias => ("\u{b5}N m", 1e-6),
            Self::HardeningWarp | Self::HardeningWeft | Self::Narrowing | Self::Friction => {
                ("", 1.0)
            }
        }
    }

    /// Whether a cloth can have a value.
    ///
    /// # Errors
    /// It cannot: the values that there are, in the unit it is told in.
    pub fn check(self, value: f64) -> Result<(), String> {
        let [least, most] = self.range();
        if (least..=most).contains(&value) {
            return Ok(());
        }
        let (sign, unit) = self.unit();
        // Round figures in their unit are told as such.
        let [least, most] = [least, most].map(|end| (end / unit * 1e6).round() / 1e6);
        Err(format!("give {least} to {most} {sign}")
            .trim_end()
            .to_owned())
    }

    fn place(self, fabric: &mut Fabric) -> &mut f64 {
        match self {
            Self::Width => &mut fabric.width,
            Self::Weight => &mut fabric.density,
            Self::Thickness => &mut fabric.thickness,
            Self::StretchWarp => &mut fabric.stretch[0],
            Self::StretchWeft => &mut fabric.stretch[1],
            Self::HardeningWarp => &mut fabric.rheology.hardening[0],
            Self::HardeningWeft => &mut fabric.rheology.hardening[1],
            Self::Shear => &mut fabric.shear,
            Self::Narrowing => &mut fabric.poisson,
            Self::BendWarp => &mut fabric.bend[0],
            Self::BendWeft => &mut fabric.bend[1],
            Self::BendBias => &mut fabric.bend[2],
            Self::Friction => &mut fabric.friction,
        }
    }

    /// The least and the largest value that a cloth can have: well beyond those of apparel, from chiffon
    /// (30 g/m2, 1 uN m) to sole leather.
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::Width => [0.05, 20.0],
            Self::Weight => [1e-3, 10.0],
            Self::Thickness => [1e-5, 0.02],
            Self::StretchWarp | Self::StretchWeft => [1.0, 1e6],
            Self::HardeningWarp | Self::HardeningWeft => [0.0, 1e6],
            Self::Shear => [0.1, 1e6],
            Self::Narrowing => [0.0, 0.95],
            Self::BendWarp | Self::BendWeft | Self::BendBias => [1e-8, 0.1],
            Self::Friction => [0.0, 5.0],
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
    for figure in FabricFigure::ALL {
        let value = figure.of(&changed);
        // Files may hold others: they are kept until they are changed.
        if value == figure.of(before) {
            continue;
        }
        if let Err(hint) = figure.check(value) {
            let (name, shown) = (figure.name().to_lowercase(), value / figure.unit().1);
            let message = format!("the {name} of fabric {:?} is {shown}", changed.name);
            return Err(impossible(message, hint));
        }
    }
    Ok(vec![Edit::Put(Entity::Fabric(Arc::new(changed)))])
}

/// The edits that give a fabric another value of a figure, in SI units.
///
/// # Errors
/// As [`set_fabric`].
pub fn set_fabric_figure(
    evaluation: &Evaluation,
    mut changed: Fabric,
    (figure, value): (FabricFigure, f64),
) -> Result<Vec<Edit>, EditError> {
    *figure.place(&mut changed) = value;
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
