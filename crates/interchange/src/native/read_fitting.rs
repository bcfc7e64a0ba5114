//! Reads the fitting of a garment.

use super::fitting::{FABRIC_WIDTHS, Fitting, FittingFabric, FittingLayer, FittingWearer};
use super::item::Item;
use super::reader::Reader;
use crate::FormatError;
use toile_body::Figure;
use toile_drape::MAX_LAYER;
use toile_measure::Measurements;
use toile_pattern::fields::{Clash, Kind};
use toile_pattern::{SizeId, Want};

/// Reads the fitting of the garment.
pub fn fitting<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<Fitting, FormatError> {
    let known = &["wearer", "size", "fabric", "width", "layer", "worn_with"];
    let fields = item.object(known, &mut reader.notes)?;
    let mut fitting = Fitting::default();
    if let Some(item) = fields.get("wearer") {
        fitting.wearer = wearer(reader, &item)?;
    }
    if let Some(item) = fields.get("size") {
        let size = fitting.size.insert(SizeId::default());
        reader.reference(&item, size)?;
    }
    if let Some(item) = fields.get("fabric") {
        fitting.fabric = Some(fabric(reader, &item)?);
    }
    if let Some(item) = fields.get("width") {
        let width = reader.value(&item, Want::Length)?;
        if !FABRIC_WIDTHS.contains(&width) {
            return Err(item.error(
                format!("the fabric is {width} m wide"),
                "give a width from 5 cm to 20 m",
            ));
        }
        fitting.width = Some(width);
    }
    if let Some(item) = fields.get("layer") {
        fitting.layer = layer(&item)?;
    }
    for item in fields.items("worn_with")? {
        let fields = item.object(&["file", "layer"], &mut reader.notes)?;
        fitting.worn_with.push(FittingLayer {
            file: file(&fields.need("file")?)?,
            layer: layer(&fields.need("layer")?)?,
        });
    }
    Ok(fitting)
}

fn wearer<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<FittingWearer, FormatError> {
    let known = &["figure", "measurements", "file", "mannequin"];
    let fields = item.object(known, &mut reader.notes)?;
    let kinds = [
        Kind::told_by("mannequin", &[]),
        Kind::told_by("measurements", &["figure", "file"]),
        Kind::told_by("figure", &[]),
    ];
    fields.kind(&kinds, &Clash::default())?;
    if let Some(mannequin) = fields.get("mannequin") {
        return Ok(FittingWearer::Mannequin {
            file: file(&mannequin)?,
        });
    }
    let names = Figure::ALL.map(Figure::name);
    let figure = Figure::ALL[fields.need("figure")?.word(&names)?];
    let Some(table) = fields.get("measurements") else {
        return Ok(FittingWearer::Figure(figure));
    };
    Ok(FittingWearer::Measured {
        figure,
        file: match fields.get("file") {
            Some(item) => Some(file(&item)?),
            None => None,
        },
        measurements: measurements(reader, &table)?,
    })
}

/// Measurements of a wearer; every length must be above zero.
fn measurements<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<Measurements, FormatError> {
    let table = reader.measurements(item)?;
    let Some((name, value)) = table.impossible() else {
        return Ok(table);
    };
    let mut entries = item.entries()?.into_iter();
    let own = entries.find(|(written, _)| {
        *written == name || toile_measure::definition(written).is_some_and(|d| d.name == name)
    });
    let place = own.map_or_else(|| item.clone(), |(_, place)| place);
    Err(place.error(
        format!("the measurement {name:?} is {value} m"),
        "give a length above 0",
    ))
}

fn fabric<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<FittingFabric, FormatError> {
    let fields = item.object(&["name", "file"], &mut reader.notes)?;
    let kinds = [Kind::told_by("name", &[]), Kind::told_by("file", &[])];
    fields.kind(&kinds, &Clash::default())?;
    match fields.get("file") {
        Some(item) => file(&item).map(FittingFabric::File),
        None => {
            let name = fields.need("name")?.name()?;
            Ok(FittingFabric::Named(name.to_owned()))
        }
    }
}

/// The path of a file, which must not be empty.
fn file(item: &Item<'_>) -> Result<String, FormatError> {
    match item.text()? {
        "" => Err(item.error(
            "the path is empty",
            "name the file, from the pattern's folder",
        )),
        path => Ok(path.to_owned()),
    }
}

fn layer(item: &Item<'_>) -> Result<u16, FormatError> {
    let number = item.count()?;
    let layer = u16::try_from(number).ok().filter(|&k| k <= MAX_LAYER);
    layer.ok_or_else(|| {
        item.error(
            format!("{number} is no layer"),
            format!("give a number from 0 to {MAX_LAYER}"),
        )
    })
}
