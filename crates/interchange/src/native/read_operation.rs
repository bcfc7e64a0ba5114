//! Reads operations of panels.

use super::item::{FieldsOfKind, Item};
use super::read::{Measure, Reader};
use super::read_seam::{mark, name};
use super::words::{BRIDGES, PLEATS, PRESSED, SIDES, TURNED};
use crate::FormatError;
use toile_pattern::{
    Apex, Bridge, Number, Operation, OperationKind, PleatLine, Pressed, Side, SpreadCut, Turned,
};

type Read = for<'a> fn(&mut Reader<'a>, &Item<'a>) -> Result<OperationKind, FormatError>;

/// Names of operations in files, with the reader of each.
const KINDS: [(&str, Read); 8] = [
    ("dart", dart),
    ("diamond", diamond),
    ("fold", fold),
    ("pivot", pivot),
    ("spread", spread),
    ("split", split),
    ("insert", insert),
    ("pleat", pleat),
];

/// Reads an operation.
pub fn operation<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<Operation, FormatError> {
    let own = ["id", "name", "meant"];
    let known: Vec<&str> = own
        .into_iter()
        .chain(KINDS.iter().map(|kind| kind.0))
        .collect();
    let fields = item.object(&known, &mut reader.notes)?;
    let words = KINDS.map(|kind| [kind.0]);
    let kinds: Vec<FieldsOfKind<'_>> = words.iter().map(|word| (1, &word[..])).collect();
    fields.of_one_kind(&own, &kinds)?;
    let mut found = KINDS
        .iter()
        .filter_map(|(word, read)| Some((fields.get(word)?, read)));
    let Some((item, read)) = found.next() else {
        let words = words.map(|[word]| word).join(", ");
        return Err(item.error(
            "the operation is none that this version knows",
            format!("give it one of {words}, or use a newer version"),
        ));
    };
    let kind = read(reader, &item)?;
    Ok(Operation {
        id: reader.own(&fields.need("id")?)?,
        name: fields.need("name")?.name()?.to_owned(),
        kind,
        meant: fields.flag_or("meant", false)?,
    })
}

fn dart<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<OperationKind, FormatError> {
    let known = &[
        "line",
        "mouth",
        "intake",
        "depth",
        "apex",
        "pressed",
        "trued",
        "keeps_length",
    ];
    let fields = item.object(known, &mut reader.notes)?;
    fields.of_one_kind(&[], &[(1, &["apex"]), (1, &["depth"])])?;
    Ok(OperationKind::Dart {
        line: name(reader, &fields.need("line")?)?,
        mouth: mark(reader, &fields.need("mouth")?)?,
        intake: reader.number(&fields.need("intake")?, Measure::Length)?,
        apex: match fields.get("apex") {
            Some(apex) => Apex::Point(reader.reference(&apex)?),
            None => Apex::Depth(reader.number(&fields.need("depth")?, Measure::Length)?),
        },
        pressed: pressed(fields.get("pressed"))?,
        trued: fields.flag_or("trued", false)?,
        keeps_length: fields.flag_or("keeps_length", false)?,
    })
}

fn pressed(item: Option<Item<'_>>) -> Result<Pressed, FormatError> {
    match item {
        Some(pressed) => pressed.choice(PRESSED),
        None => Ok(Pressed::default()),
    }
}

fn diamond<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<OperationKind, FormatError> {
    let fields = item.object(&["ends", "widest", "intake"], &mut reader.notes)?;
    Ok(OperationKind::Diamond {
        ends: reader.references(&fields.need("ends")?)?,
        widest: reader.number(&fields.need("widest")?, Measure::Plain)?,
        intake: reader.number(&fields.need("intake")?, Measure::Length)?,
    })
}

fn fold<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<OperationKind, FormatError> {
    let fields = item.object(&["line", "from", "to"], &mut reader.notes)?;
    Ok(OperationKind::Fold {
        line: name(reader, &fields.need("line")?)?,
        ends: [
            mark(reader, &fields.need("from")?)?,
            mark(reader, &fields.need("to")?)?,
        ],
    })
}

fn pivot<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<OperationKind, FormatError> {
    let known = &[
        "dart", "line", "mouth", "share", "back", "turned", "pressed",
    ];
    let fields = item.object(known, &mut reader.notes)?;
    Ok(OperationKind::Pivot {
        dart: reader.reference(&fields.need("dart")?)?,
        line: name(reader, &fields.need("line")?)?,
        mouth: mark(reader, &fields.need("mouth")?)?,
        share: match fields.get("share") {
            Some(share) => reader.number(&share, Measure::Plain)?,
            None => Number::Value(1.0),
        },
        back: match fields.get("back") {
            Some(back) => reader.number(&back, Measure::Length)?,
            None => Number::ZERO,
        },
        turned: match fields.get("turned") {
            Some(turned) => turned.choice(TURNED)?,
            None => Turned::default(),
        },
        pressed: pressed(fields.get("pressed"))?,
    })
}

fn spread<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<OperationKind, FormatError> {
    let fields = item.object(&["line", "held", "cuts", "bridge"], &mut reader.notes)?;
    let mut cuts = Vec::new();
    for item in fields.items("cuts")? {
        cuts.push(spread_cut(reader, &item)?);
    }
    Ok(OperationKind::Spread {
        line: name(reader, &fields.need("line")?)?,
        held: mark(reader, &fields.need("held")?)?,
        cuts,
        bridge: match fields.get("bridge") {
            Some(bridge) => bridge.choice(BRIDGES)?,
            None => Bridge::default(),
        },
    })
}

fn split<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<OperationKind, FormatError> {
    let fields = item.object(&["line", "curve"], &mut reader.notes)?;
    Ok(OperationKind::Split {
        line: name(reader, &fields.need("line")?)?,
        curve: reader.reference(&fields.need("curve")?)?,
    })
}

fn insert<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<OperationKind, FormatError> {
    let fields = item.object(&["sheet"], &mut reader.notes)?;
    Ok(OperationKind::Insert {
        sheet: reader.reference(&fields.need("sheet")?)?,
    })
}

fn pleat<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<OperationKind, FormatError> {
    let known = &[
        "line", "held", "pleats", "depth", "kind", "pressed", "trued",
    ];
    let fields = item.object(known, &mut reader.notes)?;
    let mut pleats = Vec::new();
    for item in fields.items("pleats")? {
        let fields = item.object(&["number", "from", "to"], &mut reader.notes)?;
        let number = numbered(&fields.need("number")?, PleatLine::LARGEST)?;
        let ends = [
            mark(reader, &fields.need("from")?)?,
            mark(reader, &fields.need("to")?)?,
        ];
        pleats.push(PleatLine { number, ends });
    }
    Ok(OperationKind::Pleat {
        line: name(reader, &fields.need("line")?)?,
        held: mark(reader, &fields.need("held")?)?,
        pleats,
        depth: reader.number(&fields.need("depth")?, Measure::Length)?,
        kind: fields.need("kind")?.choice(PLEATS)?,
        pressed: match fields.get("pressed") {
            Some(side) => side.choice(SIDES)?,
            None => Side::Left,
        },
        trued: fields.flag_or("trued", true)?,
    })
}

/// A number of a cut or pleat, up to the largest that may be.
fn numbered(item: &Item<'_>, largest: u16) -> Result<u16, FormatError> {
    let number = u16::try_from(item.count()?).ok();
    let number = number.filter(|number| *number <= largest);
    number.ok_or_else(|| item.error("there are not that many", "write a smaller number"))
}

fn spread_cut<'a>(reader: &mut Reader<'a>, item: &Item<'a>) -> Result<SpreadCut, FormatError> {
    let fields = item.object(&["number", "from", "to", "openings"], &mut reader.notes)?;
    let number = fields.need("number")?;
    let [start, end] = fields.need("openings")?.exactly()?;
    Ok(SpreadCut {
        number: numbered(&number, SpreadCut::LARGEST)?,
        ends: [
            mark(reader, &fields.need("from")?)?,
            mark(reader, &fields.need("to")?)?,
        ],
        openings: [
            reader.number(&start, Measure::Length)?,
            reader.number(&end, Measure::Length)?,
        ],
    })
}
