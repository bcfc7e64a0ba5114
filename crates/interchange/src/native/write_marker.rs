//! Writes markers.

use super::json::Value;
use super::words::{NAPS, SPREADS, word};
use super::write::{Fields, Measure, Writer, count, named, text};
use crate::FormatError;
use toile_pattern::{Marker, MarkerCloth, Number, OrderedPiece, PiecePlacement};

/// A marker. What is usual is left out.
pub fn marker(writer: &Writer<'_>, marker: &Marker) -> Result<Value, FormatError> {
    let mut fields = named(marker.id.0, &marker.name)?;
    let what = format!("marker {:?}", marker.name);
    cloth(writer, (&marker.cloth, &what), &mut fields)?;
    let order = marker.order.iter().map(|ordered| {
        let mut fields = Fields::default();
        fields.put_if("size", ordered.size.map(|id| count(id.0)));
        fields.put("quantity", count(ordered.quantity));
        fields.done()
    });
    fields.put_list("order", order.collect());
    let placements = marker.placements.iter();
    let placements = placements.map(|laid| placement(writer, laid, &what));
    fields.put_list("placements", placements.collect::<Result<_, _>>()?);
    Ok(fields.done())
}

fn cloth(
    writer: &Writer<'_>,
    (cloth, what): (&MarkerCloth, &str),
    fields: &mut Fields,
) -> Result<(), FormatError> {
    let usual = MarkerCloth::of(cloth.fabric);
    let length = |value: f64| writer.number(&Number::Value(value), Measure::Length, what);
    fields.put("fabric", count(cloth.fabric.0));
    if cloth.keeps_fabric {
        fields.put("keeps_fabric", Value::Flag(true));
    }
    for (name, value) in [("width", cloth.width), ("length", cloth.length)] {
        if let Some(value) = value {
            fields.put(name, length(value)?);
        }
    }
    for (name, value, usual) in [
        ("selvedge", cloth.selvedge, usual.selvedge),
        ("end_margin", cloth.end_margin, usual.end_margin),
        ("gap", cloth.gap, usual.gap),
    ] {
        if value.to_bits() != usual.to_bits() {
            fields.put(name, length(value)?);
        }
    }
    fields.put_if("nap", cloth.nap.map(|nap| text(word(NAPS, &nap))));
    if cloth.tilt.to_bits() != usual.tilt.to_bits() {
        let tilt = Number::Value(cloth.tilt);
        fields.put("tilt", writer.number(&tilt, Measure::Angle, what)?);
    }
    if cloth.spread != usual.spread {
        fields.put("spread", text(word(SPREADS, &cloth.spread)));
    }
    if cloth.plies != cloth.spread.usual_plies() {
        fields.put("plies", count(cloth.plies));
    }
    if let Some(price) = cloth.price_per_metre {
        let price = Number::Value(price);
        fields.put(
            "price_per_metre",
            writer.number(&price, Measure::Plain, what)?,
        );
    }
    if !cloth.currency.is_empty() {
        fields.put("currency", text(&cloth.currency));
    }
    if let Some(print) = &cloth.print {
        let mut own = Fields::default();
        own.put("repeat", writer.place(print.repeat, what)?);
        if print.origin.map(f64::to_bits) != [0; 2] {
            own.put("origin", writer.place(print.origin, what)?);
        }
        fields.put("print", own.done());
    }
    let mut flaws = Vec::new();
    for flaw in &cloth.flaws {
        let mut own = Fields::default();
        own.put("at", writer.place(flaw.at, what)?);
        own.put("size", writer.place(flaw.size, what)?);
        if flaw.clearance.to_bits() != 0 {
            own.put("clearance", length(flaw.clearance)?);
        }
        flaws.push(own.done());
    }
    fields.put_list("flaws", flaws);
    Ok(())
}

fn placement(writer: &Writer<'_>, laid: &PiecePlacement, what: &str) -> Result<Value, FormatError> {
    let OrderedPiece {
        panel,
        copy,
        size,
        garment,
    } = laid.piece;
    let mut fields = Fields::default();
    fields.put("panel", count(panel.0));
    if copy > 0 {
        fields.put("copy", count(copy));
    }
    fields.put_if("size", size.map(|id| count(id.0)));
    if garment > 0 {
        fields.put("garment", count(garment));
    }
    fields.put("at", writer.place(laid.at, what)?);
    if laid.turn.to_bits() != 0 {
        let turn = Number::Value(laid.turn);
        fields.put("turn", writer.number(&turn, Measure::Angle, what)?);
    }
    for (name, is_so) in [("flipped", laid.flipped), ("locked", laid.locked)] {
        if is_so {
            fields.put(name, Value::Flag(true));
        }
    }
    Ok(fields.done())
}
