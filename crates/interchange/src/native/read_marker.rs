//! Reads markers.

use super::item::{Item, Object};
use super::read::{Measure, Reader};
use super::words::{NAPS, SPREADS};
use crate::FormatError;
use toile_pattern::{Flaw, Marker, MarkerCloth, OrderedPiece, OrderedSize, PiecePlacement, Print};

const FIELDS: &[&str] = &[
    "id",
    "name",
    "fabric",
    "keeps_fabric",
    "width",
    "length",
    "selvedge",
    "end_margin",
    "gap",
    "nap",
    "tilt",
    "spread",
    "plies",
    "price_per_metre",
    "currency",
    "print",
    "flaws",
    "order",
    "placements",
];

/// Reads a marker.
pub fn marker<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<Marker, FormatError> {
    let fields = item.object(FIELDS, &mut reader.notes)?;
    let marker = Marker {
        id: reader.own(&fields.need("id")?)?,
        name: fields.need("name")?.name()?.to_owned(),
        cloth: cloth(reader, &fields)?,
        order: each(reader, &fields, "order", ordered)?,
        placements: each(reader, &fields, "placements", placement)?,
    };
    let Some(fault) = marker.fault() else {
        return Ok(marker);
    };
    let field = fields.get(fault.field).unwrap_or_else(|| item.clone());
    let place = match fault.item {
        Some(k) => field.list()?.into_iter().nth(k).unwrap_or(field),
        None => field,
    };
    Err(place.error(fault.message, fault.hint))
}

/// The items of a list, each as it is read.
fn each<'a, T>(
    reader: &mut Reader<'a>,
    fields: &Object<'a>,
    name: &str,
    read: impl Fn(&mut Reader<'a>, &Item<'a>) -> Result<T, FormatError>,
) -> Result<Vec<T>, FormatError> {
    let items = fields.items(name)?.into_iter();
    items.map(|item| read(reader, &item)).collect()
}

fn cloth<'a>(reader: &mut Reader<'a>, fields: &Object<'a>) -> Result<MarkerCloth, FormatError> {
    let usual = MarkerCloth::of(reader.reference(&fields.need("fabric")?)?);
    let length = |name: &str| match fields.get(name) {
        Some(item) => reader.value(&item, Measure::Length).map(Some),
        None => Ok(None),
    };
    let (width, at_hand) = (length("width")?, length("length")?);
    let selvedge = length("selvedge")?.unwrap_or(usual.selvedge);
    let end_margin = length("end_margin")?.unwrap_or(usual.end_margin);
    let gap = length("gap")?.unwrap_or(usual.gap);
    let spread = match fields.get("spread") {
        Some(spread) => spread.choice(SPREADS)?,
        None => usual.spread,
    };
    Ok(MarkerCloth {
        keeps_fabric: fields.flag_or("keeps_fabric", false)?,
        width,
        length: at_hand,
        selvedge,
        end_margin,
        gap,
        nap: match fields.get("nap") {
            Some(nap) => Some(nap.choice(NAPS)?),
            None => None,
        },
        tilt: match fields.get("tilt") {
            Some(tilt) => reader.value(&tilt, Measure::Angle)?,
            None => usual.tilt,
        },
        spread,
        plies: match fields.get("plies") {
            Some(plies) => plies.count()?,
            None => spread.usual_plies(),
        },
        price_per_metre: match fields.get("price_per_metre") {
            Some(price) => Some(price.plain_value()?),
            None => None,
        },
        currency: match fields.get("currency") {
            Some(currency) => currency.text()?.to_owned(),
            None => String::new(),
        },
        print: match fields.get("print") {
            Some(item) => {
                let fields = item.object(&["repeat", "origin"], &mut reader.notes)?;
                Some(Print {
                    repeat: reader.place(&fields.need("repeat")?)?,
                    origin: match fields.get("origin") {
                        Some(origin) => reader.place(&origin)?,
                        None => [0.0; 2],
                    },
                })
            }
            None => None,
        },
        flaws: each(reader, fields, "flaws", flaw)?,
        ..usual
    })
}

fn flaw<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<Flaw, FormatError> {
    let fields = item.object(&["at", "size", "clearance"], &mut reader.notes)?;
    Ok(Flaw {
        at: reader.place(&fields.need("at")?)?,
        size: reader.place(&fields.need("size")?)?,
        clearance: match fields.get("clearance") {
            Some(clearance) => reader.value(&clearance, Measure::Length)?,
            None => 0.0,
        },
    })
}

fn ordered<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<OrderedSize, FormatError> {
    let fields = item.object(&["size", "quantity"], &mut reader.notes)?;
    Ok(OrderedSize {
        size: match fields.get("size") {
            Some(size) => Some(reader.reference(&size)?),
            None => None,
        },
        quantity: fields
            .get("quantity")
            .map_or(Ok(1), |count| count.count())?,
    })
}

fn placement<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<PiecePlacement, FormatError> {
    let known = &[
        "panel", "copy", "size", "garment", "at", "turn", "flipped", "locked",
    ];
    let fields = item.object(known, &mut reader.notes)?;
    let count = |name: &str| fields.get(name).map_or(Ok(0), |item| item.count());
    let (copy, garment) = (count("copy")?, count("garment")?);
    Ok(PiecePlacement {
        piece: OrderedPiece {
            panel: reader.reference(&fields.need("panel")?)?,
            copy,
            size: match fields.get("size") {
                Some(size) => Some(reader.reference(&size)?),
                None => None,
            },
            garment,
        },
        at: reader.place(&fields.need("at")?)?,
        turn: match fields.get("turn") {
            Some(turn) => reader.value(&turn, Measure::Angle)?,
            None => 0.0,
        },
        flipped: fields.flag_or("flipped", false)?,
        locked: fields.flag_or("locked", false)?,
    })
}
