//! Reads one panel of a pattern file.

use super::super::item::{FieldsOfKind, Item, Object};
use super::super::json::Value;
use super::super::words::{FACINGS, PARTS, WORN};
use super::document::{
    Along, Dart, DartShape, DartTip, Edge, EdgeCurve, InternalLine, LineSegment, Notch, Number,
    Panel, Pattern, Point, PointPlace, WornRule,
};
use super::read::{Kind, Reader, unknown};
use crate::FormatError;
use std::collections::BTreeMap;
use toile_pattern::{Cut, nearest};

const FIELDS: &[&str] = &[
    "id",
    "fabric",
    "cut",
    "fold",
    "grain",
    "seam_allowance",
    "worn",
    "points",
    "outline",
    "holes",
    "lines",
    "darts",
    "notches",
];

/// Names of one panel's parts.
struct Names<'a> {
    panel: &'a str,
    points: BTreeMap<&'a str, u32>,
    edges: BTreeMap<&'a str, u32>,
}

impl Names<'_> {
    fn point(&self, item: &Item<'_>) -> Result<u32, FormatError> {
        self.find(&self.points, "point", item)
    }

    fn edge(&self, item: &Item<'_>) -> Result<u32, FormatError> {
        self.find(&self.edges, "edge", item)
    }

    fn find<T: Copy>(
        &self,
        known: &BTreeMap<&str, T>,
        kind: &str,
        item: &Item<'_>,
    ) -> Result<T, FormatError> {
        let name = item.text()?;
        known.get(name).copied().ok_or_else(|| {
            let mut error = unknown(item, kind, name, nearest(name, known.keys().copied()));
            error.what.push_str(&format!(" in panel {:?}", self.panel));
            error
        })
    }

    fn points<const N: usize>(&self, item: &Item<'_>) -> Result<[u32; N], FormatError> {
        let items: [Item<'_>; N] = item.exactly()?;
        let mut ids = [0; N];
        for (id, item) in ids.iter_mut().zip(&items) {
            *id = self.point(item)?;
        }
        Ok(ids)
    }
}

/// Reads the panel of that name.
pub fn panel(
    reader: &mut Reader,
    pattern: &Pattern,
    name: &str,
    item: &Item<'_>,
) -> Result<Panel, FormatError> {
    item.check_name(name)?;
    let fields = item.object(FIELDS, &mut reader.notes)?;
    let fabric = fields.need("fabric")?;
    let cloth = fabric.text()?;
    let found = pattern.fabrics.iter().find(|known| known.name == cloth);
    let found = found.ok_or_else(|| {
        let near = nearest(cloth, pattern.fabrics.iter().map(|known| &*known.name));
        unknown(&fabric, "fabric", cloth, near)
    })?;
    let id = reader.ids.take(Kind::Panel, fields.get("id"), item)?;
    let mut panel = Panel::new(id, name, found.id.0);
    let mut names = Names {
        panel: name,
        points: BTreeMap::new(),
        edges: BTreeMap::new(),
    };
    let points = fields.need("points")?.entries()?;
    for (name, item) in &points {
        item.check_name(name)?;
        let written = match &item.node.value {
            Value::Object(_) => written_id(item),
            _ => None,
        };
        let id = reader.ids.take(Kind::Point, written, item)?;
        names.points.insert(name, id);
    }
    let outline = fields.need("outline")?;
    let holes = match fields.get("holes") {
        Some(holes) => holes.list()?,
        None => Vec::new(),
    };
    for list in std::iter::once(&outline).chain(&holes) {
        edge_names(reader, list, &mut names)?;
    }
    for (name, item) in &points {
        let place = place(reader, item, &names)?;
        panel.points.push(Point {
            id: names.points[name],
            name: (*name).to_owned(),
            place,
        });
    }
    panel.outline = edges(reader, &outline, &names)?;
    for hole in &holes {
        panel.holes.push(edges(reader, hole, &names)?);
    }
    details(reader, &fields, &names, &mut panel)?;
    lists(reader, &fields, &names, &mut panel)?;
    Ok(panel)
}

fn written_id<'a>(item: &Item<'a>) -> Option<Item<'a>> {
    let entries = item.entries().ok()?;
    let found = entries.into_iter().find(|(name, _)| *name == "id");
    found.map(|(_, item)| item)
}

fn details(
    reader: &mut Reader,
    fields: &Object<'_>,
    names: &Names<'_>,
    panel: &mut Panel,
) -> Result<(), FormatError> {
    if let Some(cut) = fields.get("cut") {
        panel.cut = read_cut(reader, &cut)?;
    }
    if let Some(fold) = fields.get("fold") {
        panel.fold = Some(names.edge(&fold)?);
    }
    if let Some(grain) = fields.get("grain") {
        panel.grain = grain.angle()?.into();
    }
    if let Some(allowance) = fields.get("seam_allowance") {
        panel.seam_allowance = allowance.length(reader.unit)?.into();
    }
    if let Some(worn) = fields.get("worn") {
        panel.worn = read_worn(reader, &worn)?;
    }
    Ok(())
}

/// `3`, `"pair"`, or an object.
fn read_cut(reader: &mut Reader, item: &Item<'_>) -> Result<Cut, FormatError> {
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

fn read_worn(reader: &mut Reader, item: &Item<'_>) -> Result<WornRule, FormatError> {
    if let Value::Text(_) = item.node.value {
        return item
            .choice(&[("automatic", ())])
            .map(|()| WornRule::Automatic);
    }
    let fields = item.object(
        &["part", "facing", "level", "translation_m", "rotation_xyzw"],
        &mut reader.notes,
    )?;
    fields.of_one_kind(&[], WORN)?;
    if let Some(translation) = fields.get("translation_m") {
        let translation: [Item<'_>; 3] = translation.exactly()?;
        let rotation: [Item<'_>; 4] = fields.need("rotation_xyzw")?.exactly()?;
        let mut place = ([0.0; 3], [0.0; 4]);
        for (value, item) in place.0.iter_mut().zip(&translation) {
            *value = item.plain_value()?;
        }
        for (value, item) in place.1.iter_mut().zip(&rotation) {
            *value = item.plain_value()?;
        }
        return Ok(WornRule::Placed {
            translation: place.0,
            rotation: place.1,
        });
    }
    Ok(WornRule::Wrapped {
        part: fields.need("part")?.choice(PARTS)?,
        facing: fields.need("facing")?.choice(FACINGS)?,
        level: match fields.get("level") {
            Some(level) => Some(level.length(reader.unit)?.into()),
            None => None,
        },
    })
}

/// Kinds of points, by the fields that tell them.
const POINTS: &[FieldsOfKind<'_>] = &[
    (1, &["edge", "at"]),
    (1, &["at"]),
    (1, &["crossing"]),
    (1, &["mirror", "in"]),
    (2, &["from", "offset"]),
    (2, &["from", "angle", "distance"]),
    (2, &["from", "toward", "distance"]),
    (1, &["from", "to", "along", "aside"]),
];

/// The place of a point: `[x, y]` or an object.
fn place(
    reader: &mut Reader,
    item: &Item<'_>,
    names: &Names<'_>,
) -> Result<PointPlace, FormatError> {
    let unit = reader.unit;
    let pair = |item: &Item<'_>| -> Result<_, FormatError> {
        let [x, y]: [Item<'_>; 2] = item.exactly()?;
        Ok((x.length(unit)?.into(), y.length(unit)?.into()))
    };
    if let Value::List(_) = item.node.value {
        let (x, y) = pair(item)?;
        return Ok(PointPlace::At { x, y });
    }
    let fields = item.object(
        &[
            "id", "at", "from", "offset", "angle", "distance", "to", "along", "aside", "toward",
            "edge", "crossing", "mirror", "in",
        ],
        &mut reader.notes,
    )?;
    fields.of_one_kind(&["id"], POINTS)?;
    if let Some(edge) = fields.get("edge") {
        return Ok(PointPlace::OnEdge {
            edge: names.edge(&edge)?,
            at: fields.need("at")?.plain()?.into(),
        });
    }
    if let Some(at) = fields.get("at") {
        let (x, y) = pair(&at)?;
        return Ok(PointPlace::At { x, y });
    }
    if let Some(crossing) = fields.get("crossing") {
        let [first, second]: [Item<'_>; 2] = crossing.exactly()?;
        return Ok(PointPlace::Crossing {
            first: names.points(&first)?,
            second: names.points(&second)?,
        });
    }
    if let Some(mirror) = fields.get("mirror") {
        return Ok(PointPlace::Mirrored {
            base: names.point(&mirror)?,
            line: names.points(&fields.need("in")?)?,
        });
    }
    let Some(from) = fields.get("from") else {
        return Err(item.error(
            "the point has no place",
            "write [x, y], or an object with from, edge, crossing or mirror",
        ));
    };
    let base = names.point(&from)?;
    if let Some(offset) = fields.get("offset") {
        let (x, y) = pair(&offset)?;
        return Ok(PointPlace::Offset { base, x, y });
    }
    if let Some(angle) = fields.get("angle") {
        return Ok(PointPlace::Polar {
            base,
            angle: angle.angle()?.into(),
            distance: fields.need("distance")?.length(unit)?.into(),
        });
    }
    if let Some(toward) = fields.get("toward") {
        return Ok(PointPlace::Toward {
            base,
            tip: names.point(&toward)?,
            distance: fields.need("distance")?.length(unit)?.into(),
        });
    }
    Ok(PointPlace::Between {
        base,
        tip: names.point(&fields.need("to")?)?,
        along: fields.need("along")?.plain()?.into(),
        aside: fields
            .get("aside")
            .map_or(Ok(0.0.into()), |a| a.plain().map(Number::from))?,
    })
}

const EDGE_FIELDS: &[&str] = &[
    "edge",
    "id",
    "from",
    "to",
    "bulge",
    "quadratic",
    "cubic",
    "seam_allowance",
];

/// Gives every edge of a loop its id.
fn edge_names<'a>(
    reader: &mut Reader,
    list: &Item<'a>,
    names: &mut Names<'a>,
) -> Result<(), FormatError> {
    for item in list.list()? {
        let fields = item.object(EDGE_FIELDS, &mut reader.notes)?;
        let name = fields.need("edge")?;
        let id = reader.ids.take(Kind::Edge, fields.get("id"), &item)?;
        if names.edges.insert(name.name()?, id).is_some() {
            return Err(name.error(
                format!("two edges of panel {:?} are called so", names.panel),
                "rename one of them",
            ));
        }
    }
    Ok(())
}

fn edges(
    reader: &mut Reader,
    list: &Item<'_>,
    names: &Names<'_>,
) -> Result<Vec<Edge>, FormatError> {
    let items = list.list()?;
    let mut result = Vec::with_capacity(items.len());
    for (k, item) in items.iter().enumerate() {
        let fields = item.object(EDGE_FIELDS, &mut Vec::new())?;
        let name = fields.need("edge")?;
        let end = match fields.get("to") {
            Some(to) => to,
            None => {
                let next = &items[(k + 1) % items.len()];
                next.object(EDGE_FIELDS, &mut Vec::new())?.need("from")?
            }
        };
        result.push(Edge {
            id: names.edge(&name)?,
            name: name.name()?.to_owned(),
            ends: [names.point(&fields.need("from")?)?, names.point(&end)?],
            curve: curve(&fields, names)?,
            seam_allowance: match fields.get("seam_allowance") {
                Some(allowance) => Some(allowance.length(reader.unit)?.into()),
                None => None,
            },
        });
    }
    Ok(result)
}

fn curve(fields: &Object<'_>, names: &Names<'_>) -> Result<EdgeCurve, FormatError> {
    let bulge = fields.get("bulge");
    let quadratic = fields.get("quadratic");
    let cubic = fields.get("cubic");
    match (bulge, quadratic, cubic) {
        (None, None, None) => Ok(EdgeCurve::Line),
        (Some(bulge), None, None) => Ok(EdgeCurve::Arc {
            bulge: bulge.plain()?.into(),
        }),
        (None, Some(control), None) => Ok(EdgeCurve::Quadratic {
            control: names.point(&control)?,
        }),
        (None, None, Some(controls)) => Ok(EdgeCurve::Cubic {
            controls: names.points(&controls)?,
        }),
        _ => Err(fields.item.error(
            "the edge is more than one kind of curve",
            "keep one of bulge, quadratic, cubic",
        )),
    }
}

fn lists(
    reader: &mut Reader,
    fields: &Object<'_>,
    names: &Names<'_>,
    panel: &mut Panel,
) -> Result<(), FormatError> {
    for (name, item) in entries(fields, "lines")? {
        item.check_name(name)?;
        let line = line(reader, name, &item, names)?;
        panel.internal_lines.push(line);
    }
    for (name, item) in entries(fields, "darts")? {
        item.check_name(name)?;
        let dart = dart(reader, name, &item, names)?;
        panel.darts.push(dart);
    }
    for (name, item) in entries(fields, "notches")? {
        item.check_name(name)?;
        let fields = item.object(&["id", "edge", "at", "distance"], &mut reader.notes)?;
        fields.of_one_kind(&[], &[(1, &["distance"]), (1, &["at"])])?;
        panel.notches.push(Notch {
            id: reader.ids.take(Kind::Notch, fields.get("id"), &item)?,
            name: name.to_owned(),
            edge: names.edge(&fields.need("edge")?)?,
            at: match fields.get("distance") {
                Some(distance) => Along::Distance(distance.length(reader.unit)?.into()),
                None => Along::Fraction(fields.need("at")?.plain()?.into()),
            },
        });
    }
    Ok(())
}

fn entries<'a>(fields: &Object<'a>, name: &str) -> Result<Vec<(&'a str, Item<'a>)>, FormatError> {
    fields
        .get(name)
        .map_or(Ok(Vec::new()), |item| item.entries())
}

/// A line: `path` is a list of points joined by straight lines, `segments` may be curved.
fn line(
    reader: &mut Reader,
    name: &str,
    item: &Item<'_>,
    names: &Names<'_>,
) -> Result<InternalLine, FormatError> {
    let fields = item.object(&["id", "path", "segments"], &mut reader.notes)?;
    fields.of_one_kind(&[], &[(1, &["path"]), (1, &["segments"])])?;
    let id = reader.ids.take(Kind::Line, fields.get("id"), item)?;
    let mut segments = Vec::new();
    if let Some(path) = fields.get("path") {
        let items = path.list()?;
        if items.len() < 2 {
            return Err(path.error("the path has fewer than two points", "name two or more"));
        }
        for ends in items.windows(2) {
            segments.push(LineSegment {
                ends: [names.point(&ends[0])?, names.point(&ends[1])?],
                curve: EdgeCurve::Line,
            });
        }
    } else {
        for item in fields.need("segments")?.list()? {
            let known = &["from", "to", "bulge", "quadratic", "cubic"];
            let fields = item.object(known, &mut reader.notes)?;
            segments.push(LineSegment {
                ends: [
                    names.point(&fields.need("from")?)?,
                    names.point(&fields.need("to")?)?,
                ],
                curve: curve(&fields, names)?,
            });
        }
    }
    Ok(InternalLine {
        id,
        name: name.to_owned(),
        segments,
    })
}

fn dart(
    reader: &mut Reader,
    name: &str,
    item: &Item<'_>,
    names: &Names<'_>,
) -> Result<Dart, FormatError> {
    let known = &["id", "edge", "ends", "at", "width", "depth", "apex"];
    let fields = item.object(known, &mut reader.notes)?;
    let kinds: &[FieldsOfKind<'_>] = &[
        (1, &["ends"]),
        (2, &["edge", "apex"]),
        (1, &["edge", "depth"]),
    ];
    fields.of_one_kind(&[], kinds)?;
    let at = fields.need("at")?.plain()?.into();
    let width = fields.need("width")?.length(reader.unit)?.into();
    let shape = match fields.get("ends") {
        Some(ends) => DartShape::Diamond {
            ends: names.points(&ends)?,
            at,
            width,
        },
        None => DartShape::Edge {
            edge: names.edge(&fields.need("edge")?)?,
            at,
            width,
            tip: match fields.get("apex") {
                Some(apex) => DartTip::Apex(names.point(&apex)?),
                None => DartTip::Depth(fields.need("depth")?.length(reader.unit)?.into()),
            },
        },
    };
    Ok(Dart {
        id: reader.ids.take(Kind::Dart, fields.get("id"), item)?,
        name: name.to_owned(),
        shape,
    })
}
