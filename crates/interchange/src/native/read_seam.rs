//! Reads seams, and the marks and names by which places are told.

use super::item::Item;
use super::json::Value;
use super::read::{Measure, Reader};
use super::words::ROLES;
use crate::FormatError;
use toile_pattern::{Mark, Name, PartId, Seam, Span};

/// The name of a corner, edge or line: an id, or what an operation made.
pub fn name<'a, T: From<u32> + Into<PartId> + Copy>(
    reader: &mut Reader<'a>,
    item: &Item<'a>,
) -> Result<Name<T>, FormatError> {
    if let Value::Number(_) = item.node.value {
        return reader.reference(item).map(Name::Drawn);
    }
    let fields = item.object(&["by", "role", "index"], &mut reader.notes)?;
    let index = fields.need("index")?;
    Ok(Name::Made {
        by: reader.reference(&fields.need("by")?)?,
        role: fields.need("role")?.choice(ROLES)?,
        index: u16::try_from(index.count()?)
            .map_err(|_| index.error("there are not that many", "write a smaller index"))?,
    })
}

/// A place on a line: a corner, a notch, or a way from corners.
pub fn mark<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<Mark, FormatError> {
    if let Value::Number(_) = item.node.value {
        return name(reader, item).map(Mark::Corner);
    }
    let known = &[
        "by", "role", "index", "notch", "from", "distance", "between", "share",
    ];
    let fields = item.object(known, &mut reader.notes)?;
    fields.of_one_kind(
        &[],
        &[
            (1, &["notch"]),
            (1, &["from", "distance"]),
            (1, &["between", "share"]),
            (1, &["by", "role", "index"]),
        ],
    )?;
    if let Some(notch) = fields.get("notch") {
        return reader.reference(&notch).map(Mark::Notch);
    }
    if let Some(from) = fields.get("from") {
        return Ok(Mark::Along {
            from: name(reader, &from)?,
            distance: reader.number(&fields.need("distance")?, Measure::Length)?,
        });
    }
    if let Some(ends) = fields.get("between") {
        let [from, to]: [Item<'a>; 2] = ends.exactly()?;
        return Ok(Mark::Between {
            ends: [name(reader, &from)?, name(reader, &to)?],
            share: reader.number(&fields.need("share")?, Measure::Plain)?,
        });
    }
    name(reader, item).map(Mark::Corner)
}

/// Reads a seam.
pub fn seam<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<Seam, FormatError> {
    let known = &[
        "id",
        "name",
        "sides",
        "ease",
        "gathered",
        "right_sides_together",
        "multi_ply",
    ];
    let fields = item.object(known, &mut reader.notes)?;
    let sides: [Item<'a>; 2] = fields.need("sides")?.exactly()?;
    let mut chains = [Vec::new(), Vec::new()];
    for (chain, side) in chains.iter_mut().zip(&sides) {
        for item in side.list()? {
            chain.push(span(reader, &item)?);
        }
    }
    let id = reader.own(&fields.need("id")?)?;
    let mut seam = Seam::new(id, fields.need("name")?.name()?, chains);
    if let Some(ease) = fields.get("ease") {
        seam.ease = reader.number(&ease, Measure::Length)?;
    }
    seam.gathered = fields.flag_or("gathered", false)?;
    seam.right_sides_together = fields.flag_or("right_sides_together", true)?;
    seam.multi_ply = fields.flag_or("multi_ply", false)?;
    Ok(seam)
}

fn span<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<Span, FormatError> {
    let known = &["panel", "line", "from", "to", "copy", "half", "backwards"];
    let fields = item.object(known, &mut reader.notes)?;
    let half = match fields.get("half") {
        Some(half) => u8::try_from(half.count()?)
            .map_err(|_| half.error("there are not that many halves", "write 0 or 1"))?,
        None => 0,
    };
    Ok(Span {
        panel: reader.reference(&fields.need("panel")?)?,
        copy: fields.get("copy").map_or(Ok(0), |copy| copy.count())?,
        half,
        line: name(reader, &fields.need("line")?)?,
        from: mark(reader, &fields.need("from")?)?,
        to: mark(reader, &fields.need("to")?)?,
        backwards: fields.flag_or("backwards", false)?,
    })
}
