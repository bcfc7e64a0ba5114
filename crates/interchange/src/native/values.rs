//! Measurements and fabrics, written alike in all versions of the format.

use super::item::Item;
use super::json::Value;
use crate::FormatError;
use toile_measure::{Measurements, Origin, UnitKind, definition};
use toile_pattern::{Diagnostic, DisplayUnit, Fabric, FabricId, Rheology};

/// A table of measurements.
pub fn measurements(
    item: &Item<'_>,
    unit: DisplayUnit,
    notes: &mut Vec<Diagnostic>,
) -> Result<Measurements, FormatError> {
    let mut table = Measurements::new();
    for (name, entry) in item.entries()? {
        let predicted = match &entry.node.value {
            Value::Object(fields) => fields.iter().any(|(name, _)| name == "predicted"),
            _ => false,
        };
        let (entry, origin) = if predicted {
            let fields = entry.object(&["predicted"], notes)?;
            (fields.need("predicted")?, Origin::Predicted)
        } else {
            (entry, Origin::Asked)
        };
        let is_angle = definition(name).is_some_and(|known| known.kind == UnitKind::Angle);
        let number = if is_angle {
            entry.angle()?
        } else {
            entry.length(unit)?
        };
        let value = entry.fixed(&number)?;
        if table.contains(name) {
            return Err(entry.error(
                format!("the measurement {name:?} is given twice, once under another name"),
                "remove one of them",
            ));
        }
        table
            .set(name, value, origin)
            .map_err(|error| entry.error(error.to_string(), "change it"))?;
    }
    Ok(table)
}

/// A fabric without its id, and the id that is written.
pub fn fabric<'a>(
    name: &str,
    item: &Item<'a>,
    notes: &mut Vec<Diagnostic>,
) -> Result<(Option<Item<'a>>, Fabric), FormatError> {
    item.check_name(name)?;
    let fields = item.object(
        &[
            "id",
            "name",
            "density_kg_per_m2",
            "thickness_m",
            "stretch_N_per_m",
            "shear_N_per_m",
            "poisson",
            "bend_N_m",
            "friction",
            "width_m",
            "nap",
            "colour",
            "hardening",
            "viscosity_N_s_per_m",
            "bend_viscosity_N_m_s",
            "kept",
            "relaxation_time_s",
        ],
        notes,
    )?;
    let value = |field: &str| fields.need(field)?.plain_value();
    let usual = Rheology::default();
    let or = |field: &str, usual| fields.get(field).map_or(Ok(usual), |v| v.plain_value());
    let pair_or = |field: &str, usual| fields.get(field).map_or(Ok(usual), |v| values(&v));
    let rheology = Rheology {
        hardening: pair_or("hardening", usual.hardening)?,
        viscosity: or("viscosity_N_s_per_m", usual.viscosity)?,
        bend_viscosity: or("bend_viscosity_N_m_s", usual.bend_viscosity)?,
        kept: pair_or("kept", usual.kept)?,
        relaxation_time: or("relaxation_time_s", usual.relaxation_time)?,
    };
    let fabric = Fabric {
        id: FabricId::default(),
        name: name.to_owned(),
        density: value("density_kg_per_m2")?,
        thickness: value("thickness_m")?,
        stretch: values(&fields.need("stretch_N_per_m")?)?,
        shear: value("shear_N_per_m")?,
        poisson: value("poisson")?,
        bend: values(&fields.need("bend_N_m")?)?,
        friction: value("friction")?,
        width: value("width_m")?,
        nap: fields.flag_or("nap", false)?,
        colour: match fields.get("colour") {
            Some(colour) => values(&colour)?,
            None => [0.8, 0.8, 0.8],
        },
        rheology,
    };
    Ok((fields.get("id"), fabric))
}

/// Exactly `N` plain numbers.
pub fn values<const N: usize>(item: &Item<'_>) -> Result<[f64; N], FormatError> {
    let items: [Item<'_>; N] = item.exactly()?;
    let mut result = [0.0; N];
    for (value, item) in result.iter_mut().zip(&items) {
        *value = item.plain_value()?;
    }
    Ok(result)
}
