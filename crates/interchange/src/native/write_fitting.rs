//! Writes the fitting of a garment.

use super::fitting::{Fitting, FittingFabric, FittingWearer};
use super::json::Value;
use super::writer::{Object, Writer, count, text};
use crate::FormatError;
use toile_pattern::{Number, Want};

/// The fitting of the garment as JSON; `None` if it differs in no value from the pattern's own.
pub fn fitting(writer: &Writer, fitting: &Fitting) -> Result<Option<Value>, FormatError> {
    if *fitting == Fitting::default() {
        return Ok(None);
    }
    let mut fields = Object::default();
    fields.put_if("wearer", wearer(writer, &fitting.wearer));
    fields.put_if("size", fitting.size.map(|id| count(id.0)));
    if let Some(fabric) = &fitting.fabric {
        let mut own = Object::default();
        match fabric {
            FittingFabric::Named(name) => own.put("name", text(name)),
            FittingFabric::File(file) => own.put("file", text(file)),
        }
        fields.put("fabric", own.done());
    }
    if let Some(width) = fitting.width {
        let width = Number::Value(width);
        let place = "width of the fabric";
        fields.put("width", writer.number(&width, Want::Length, place)?);
    }
    if fitting.layer > 0 {
        fields.put("layer", count(fitting.layer.into()));
    }
    let worn = fitting.worn_with.iter().map(|worn| {
        let mut own = Object::default();
        own.put("file", text(&worn.file));
        own.put("layer", count(worn.layer.into()));
        own.done()
    });
    fields.put_list("worn_with", worn.collect());
    Ok(Some(fields.done()))
}

fn wearer(writer: &Writer, wearer: &FittingWearer) -> Option<Value> {
    let mut fields = Object::default();
    match wearer {
        FittingWearer::OfPattern => return None,
        FittingWearer::Figure(figure) => fields.put("figure", text(figure.name())),
        FittingWearer::Measured {
            figure,
            file,
            measurements,
        } => {
            fields.put("figure", text(figure.name()));
            fields.put_if("file", file.as_deref().map(text));
            fields.put("measurements", writer.measurements(measurements));
        }
        FittingWearer::Mannequin { file } => fields.put("mannequin", text(file)),
    }
    Some(fields.done())
}
