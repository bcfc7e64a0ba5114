//! Reads panels: lines and notches.

use super::item::{Item, Object};
use super::json::Value;
use super::read::{Measure, Reader};
use super::read_operation::operation;
use super::read_seam::mark;
use super::words::{CORNERS, FACINGS, LINES, NOTCHES, PARTS, SIDES, WORN};
use crate::FormatError;
use std::sync::Arc;
use toile_pattern::{
    Corner, Cut, Edge, EdgeCorner, Line, MitreLimit, Notch, NotchKind, Number, Panel, SheetId,
    Source, WornRule,
};

/// The sheet a panel is traced from, or the panel it is a side of.
fn source<'a>(reader: &mut Reader<'a>, fields: &Object<'a>) -> Result<Source, FormatError> {
    let Some(side) = fields.get("side") else {
        return Ok(Source::Traced(reader.reference(&fields.need("sheet")?)?));
    };
    if let Some(sheet) = fields.get("sheet") {
        return Err(sheet.error(
            "a panel is traced from a sheet or a side of a panel, not both",
            "keep sheet or side",
        ));
    }
    let own = side.object(&["of", "split", "is"], &mut reader.notes)?;
    Ok(Source::Side {
        of: reader.reference(&own.need("of")?)?,
        split: reader.reference(&own.need("split")?)?,
        side: own.need("is")?.choice(SIDES)?,
    })
}

/// Reads a panel.
pub fn panel<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<Panel, FormatError> {
    let known = &[
        "id",
        "name",
        "sheet",
        "side",
        "fabric",
        "cut",
        "grain",
        "allowance",
        "worn",
        "table",
        "lines",
        "notches",
        "operations",
    ];
    let fields = item.object(known, &mut reader.notes)?;
    let id = reader.own(&fields.need("id")?)?;
    let source = source(reader, &fields)?;
    let fabric = reader.reference(&fields.need("fabric")?)?;
    let mut panel = Panel {
        source,
        ..Panel::new(id, fields.need("name")?.name()?, SheetId::default(), fabric)
    };
    if let Some(item) = fields.get("cut") {
        panel.cut = cut(reader, &item)?;
    }
    if let Some(grain) = fields.get("grain") {
        panel.grain = reader.number(&grain, Measure::Angle)?;
    }
    if let Some(allowance) = fields.get("allowance") {
        panel.allowance = reader.number(&allowance, Measure::Length)?;
    }
    if let Some(item) = fields.get("worn") {
        panel.worn = worn(reader, &item)?;
    }
    if let Some(table) = fields.get("table") {
        panel.on_table = Some(reader.place(&table)?);
    }
    for item in fields.items("lines")? {
        let line = line(reader, &item)?;
        panel.lines.push(line);
    }
    for item in fields.items("notches")? {
        let known = &["id", "name", "line", "at", "kind"];
        let fields = item.object(known, &mut reader.notes)?;
        panel.notches.push(Notch {
            id: reader.own(&fields.need("id")?)?,
            name: fields.need("name")?.name()?.to_owned(),
            line: reader.reference(&fields.need("line")?)?,
            at: mark(reader, &fields.need("at")?)?,
            kind: match fields.get("kind") {
                Some(kind) => kind.choice(NOTCHES)?,
                None => NotchKind::Slit,
            },
        });
    }
    for item in fields.items("operations")? {
        let operation = operation(reader, &item)?;
        panel.operations.push(Arc::new(operation));
    }
    Ok(panel)
}

/// `3`, `"pair"`, or an object.
fn cut(reader: &mut Reader<'_>, item: &Item<'_>) -> Result<Cut, FormatError> {
    match &item.node.value {
        Value::Number(_) => Ok(Cut {
            quantity: item.count()?,
            mirrored: false,
        }),
        Value::Text(_) => item.choice(&[(
            "pair",
            Cut {
                quantity: 2,
                mirrored: true,
            },
        )]),
        _ => {
            let fields = item.object(&["quantity", "mirrored"], &mut reader.notes)?;
            Ok(Cut {
                quantity: fields.need("quantity")?.count()?,
                mirrored: fields.flag_or("mirrored", false)?,
            })
        }
    }
}

fn worn<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<WornRule, FormatError> {
    let known = &["part", "facing", "level", "translation_m", "rotation_xyzw"];
    let fields = item.object(known, &mut reader.notes)?;
    fields.of_one_kind(&[], WORN)?;
    if let Some(translation) = fields.get("translation_m") {
        return Ok(WornRule::Placed {
            translation: super::values::values(&translation)?,
            rotation: super::values::values(&fields.need("rotation_xyzw")?)?,
        });
    }
    Ok(WornRule::Wrapped {
        part: fields.need("part")?.choice(PARTS)?,
        facing: fields.need("facing")?.choice(FACINGS)?,
        level: optional(reader, &fields, "level")?,
    })
}

/// A length that may be left out.
fn optional<'a>(
    reader: &mut Reader<'a>,
    fields: &Object<'a>,
    name: &str,
) -> Result<Option<Number>, FormatError> {
    match fields.get(name) {
        Some(item) => reader.number(&item, Measure::Length).map(Some),
        None => Ok(None),
    }
}

fn line<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<Line, FormatError> {
    let fields = item.object(&["id", "name", "kind", "by", "edges"], &mut reader.notes)?;
    let mut line = Line {
        id: reader.own(&fields.need("id")?)?,
        name: fields.need("name")?.name()?.to_owned(),
        kind: fields.need("kind")?.choice(LINES)?,
        by: match fields.get("by") {
            Some(by) => Some(reader.reference(&by)?),
            None => None,
        },
        edges: Vec::new(),
    };
    for item in fields.items("edges")? {
        let known = &[
            "id",
            "name",
            "curve",
            "from",
            "to",
            "allowance",
            "corner",
            "limit",
            "meant",
        ];
        let fields = item.object(known, &mut reader.notes)?;
        line.edges.push(Edge {
            id: reader.own(&fields.need("id")?)?,
            name: fields.need("name")?.name()?.to_owned(),
            curve: reader.reference(&fields.need("curve")?)?,
            ends: [
                reader.reference(&fields.need("from")?)?,
                reader.reference(&fields.need("to")?)?,
            ],
            allowance: optional(reader, &fields, "allowance")?,
            corner: EdgeCorner {
                kind: match fields.get("corner") {
                    Some(corner) => corner.choice(CORNERS)?,
                    None => Corner::default(),
                },
                limit: match fields.get("limit") {
                    Some(limit) => mitre_limit(&limit)?,
                    None => MitreLimit::default(),
                },
                meant: fields.flag_or("meant", false)?,
            },
        });
    }
    Ok(line)
}

/// How far a cut line may reach from a corner: a number of widths, or `"none"`.
fn mitre_limit(item: &Item<'_>) -> Result<MitreLimit, FormatError> {
    let [least, most] = MitreLimit::RANGE;
    if item.text().is_ok_and(|text| text == "none") {
        return Ok(MitreLimit::None);
    }
    let hint = format!("give a number of widths from {least} to {most}, or \"none\"");
    match item.plain_value() {
        Ok(widths) if (least..=most).contains(&widths) => Ok(MitreLimit::Widths(widths)),
        _ => Err(item.error("it is no limit of a corner", hint)),
    }
}
