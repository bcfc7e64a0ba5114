//! Strip packing instances and solutions in the JSON of jagua-rs and sparrow (Gardeyn and Wauters
//! 2025), by which nesting programs are compared.
//!
//! Lengths are in units of the instance. Pieces are rotated about their origin, then translated; the strip
//! lies along x from 0, with its height along y.

use crate::FormatError;
use serde_json::{Map, Value, json};
use toile_geometry::{Polygon, Vec2};
use toile_nesting::{Allowed, Item, Marker, Mirror, Nap, Strip};

/// Number of orientations read for an item that may be turned freely: one every fifteen degrees.
const FREE_TURNS: u32 = 24;

/// A strip packing instance.
#[derive(Clone, Debug, PartialEq)]
pub struct JaguaInstance {
    /// Name of the instance.
    pub name: String,
    /// Length in memory divided by length in the file: a power of two, so that nothing is rounded.
    pub scale: f64,
    /// Items in the order of the file (m).
    pub items: Vec<Item>,
    /// The strip (m).
    pub strip: Strip,
    /// Notes on assumptions that were made.
    pub notes: Vec<String>,
    /// The id of each item in the file.
    ids: Vec<Value>,
    /// The file as read, to which a solution is added.
    document: Map<String, Value>,
}

/// Known fields of an instance; `solution` is skipped.
const TOP_FIELDS: [&str; 4] = ["name", "strip_height", "items", "solution"];
/// Known fields of an item; `dxf` names the source of the outline and is skipped.
const ITEM_FIELDS: [&str; 5] = ["id", "demand", "allowed_orientations", "shape", "dxf"];

/// Adds a note for every unknown field.
fn unknown(fields: &Map<String, Value>, place: &str, (known, notes): (&[&str], &mut Vec<String>)) {
    for name in fields.keys().filter(|name| !known.contains(&name.as_str())) {
        let dot = if place.is_empty() { "" } else { "." };
        notes.push(format!("{place}{dot}{name} is not known here and ignored"));
    }
}

/// Whether a text looks like a nesting instance rather than a pattern.
pub fn is_jagua_instance(text: &str) -> bool {
    let document: Result<Value, _> = serde_json::from_str(text);
    document.is_ok_and(|d| d.get("items").is_some() && d.get("strip_height").is_some())
}

fn wrong(place: impl Into<String>, what: impl Into<String>) -> FormatError {
    FormatError::new(place, what, "correct the instance and try again")
}

/// Reads an instance; a solution in the file is ignored.
///
/// # Errors
/// The text is not JSON, or something is missing or is not a number.
pub fn read_jagua(text: &str) -> Result<JaguaInstance, FormatError> {
    let document: Value = serde_json::from_str(text).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        wrong(place, "the text is not JSON")
    })?;
    let Value::Object(document) = document else {
        return Err(wrong("the top", "this is not an object"));
    };
    let height = document.get("strip_height").and_then(Value::as_f64);
    let height = height.filter(|h| h.is_finite() && *h > 0.0);
    let height = height.ok_or_else(|| wrong("strip_height", "there is no height above 0"))?;
    // The scaled height is between one and two metres, like the width of a roll of fabric.
    let scale = (-height.log2().floor()).exp2();
    let listed = document.get("items").and_then(Value::as_array);
    let listed = listed.ok_or_else(|| wrong("items", "there is no list of items"))?;
    let (mut items, mut ids, mut notes) = (Vec::new(), Vec::new(), Vec::new());
    unknown(&document, "", (&TOP_FIELDS, &mut notes));
    for (k, value) in listed.iter().enumerate() {
        items.push(read_item(value, &format!("items[{k}]"), scale, &mut notes)?);
        ids.push(value.get("id").cloned().unwrap_or_else(|| json!(k)));
    }
    let name = document
        .get("name")
        .and_then(Value::as_str)
        .unwrap_or("marker");
    Ok(JaguaInstance {
        name: name.to_owned(),
        scale,
        items,
        strip: Strip::of_width(height * scale),
        notes,
        ids,
        document,
    })
}

fn read_item(
    value: &Value,
    place: &str,
    scale: f64,
    notes: &mut Vec<String>,
) -> Result<Item, FormatError> {
    let field = |name: &str| format!("{place}.{name}");
    if let Value::Object(fields) = value {
        unknown(fields, place, (&ITEM_FIELDS, notes));
    }
    if let Some(Value::Object(fields)) = value.get("shape") {
        unknown(fields, &field("shape"), (&["type", "data"], notes));
    }
    let name = match value.get("id") {
        Some(Value::String(id)) => id.clone(),
        Some(id) => id.to_string(),
        None => place.to_owned(),
    };
    let demand = value.get("demand").and_then(Value::as_u64);
    let demand = demand.ok_or_else(|| wrong(field("demand"), "there is no whole number"))?;
    let quantity = u32::try_from(demand)
        .map_err(|_| wrong(field("demand"), format!("{demand} is too many")))?;
    let shape = value.get("shape").unwrap_or(&Value::Null);
    let outline = match shape.get("type").and_then(Value::as_str) {
        Some("simple_polygon") => Polygon::new(ring(&shape["data"], &field("shape.data"), scale)?),
        Some("polygon") => {
            notes.push(format!(
                "item {name}: its holes are not filled with other pieces; density counts them as cloth, as published densities do"
            ));
            let outer = &shape["data"]["outer"];
            Polygon::new(ring(outer, &field("shape.data.outer"), scale)?)
        }
        other => {
            let what = format!("{:?} is not a shape known here", other.unwrap_or_default());
            return Err(wrong(field("shape.type"), what));
        }
    };
    let turns = match value.get("allowed_orientations") {
        None | Some(Value::Null) => {
            notes.push(format!(
                "item {name} may be turned freely: turned by multiples of {} degrees",
                360 / FREE_TURNS
            ));
            (0..FREE_TURNS)
                .map(|k| f64::from(k * 360 / FREE_TURNS))
                .collect()
        }
        Some(Value::Array(list)) => {
            let angles: Option<Vec<f64>> = list.iter().map(Value::as_f64).collect();
            angles.ok_or_else(|| wrong(field("allowed_orientations"), "not numbers"))?
        }
        Some(_) => return Err(wrong(field("allowed_orientations"), "this is not a list")),
    };
    Ok(Item {
        quantity,
        allowed: Allowed::turned(turns.into_iter().map(f64::to_radians).collect()),
        ..Item::new(name, outline)
    })
}

/// Reads the points of an outline; a last point equal to the first is left out.
fn ring(value: &Value, place: &str, scale: f64) -> Result<Vec<Vec2>, FormatError> {
    let list = value
        .as_array()
        .ok_or_else(|| wrong(place, "there is no list of points"))?;
    let mut points = Vec::with_capacity(list.len());
    for (k, pair) in list.iter().enumerate() {
        let number = |i: usize| pair.get(i).and_then(Value::as_f64);
        match (number(0), number(1)) {
            (Some(x), Some(y)) => points.push(Vec2::new(x, y) * scale),
            _ => {
                return Err(wrong(
                    format!("{place}[{k}]"),
                    "this is not a pair of numbers",
                ));
            }
        }
    }
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    Ok(points)
}

/// The instance with a marker as its solution, as jagua-rs and sparrow write it; `seconds` is the run time,
/// which is left out if it is `None`. The same marker gives the same bytes.
///
/// # Errors
/// A number is not finite.
pub fn write_jagua(
    instance: &JaguaInstance,
    marker: &Marker,
    seconds: Option<f64>,
) -> Result<String, FormatError> {
    let length = marker.length / instance.scale;
    if !length.is_finite() {
        return Err(wrong("solution", "a number is not finite"));
    }
    let placed = marker.placements.iter().map(|p| {
        let at = p.translation / instance.scale;
        json!({
            "item_id": instance.ids.get(p.item),
            "transformation": { "rotation": p.turn.to_degrees(), "translation": [at.x, at.y] },
        })
    });
    let mut solution = json!({
        "strip_width": length,
        "density": marker.efficiency,
        "layout": {
            "container_id": 0,
            "placed_items": placed.collect::<Vec<_>>(),
            "density": marker.efficiency,
        },
    });
    if let Some(seconds) = seconds {
        solution["run_time_sec"] = json!(seconds);
    }
    let mut document = instance.document.clone();
    document.insert("solution".into(), solution);
    let text = serde_json::to_string_pretty(&Value::Object(document));
    text.map_err(|error| wrong("solution", error.to_string()))
}

/// Items and the usable width of a strip as an instance, in millimetres with the grain along x; also returns
/// the properties that the format cannot express. On one-way fabric only rotation 0 is allowed.
///
/// # Errors
/// A number is not finite.
pub fn write_jagua_instance(
    name: &str,
    items: &[Item],
    strip: &Strip,
) -> Result<(String, Vec<&'static str>), FormatError> {
    for item in items {
        let mut points = item.outline.outer.iter();
        let turns = item.allowed.turns.iter().all(|t| t.is_finite());
        let finite = points.all(|p| p.x.is_finite() && p.y.is_finite());
        if !(finite && turns && item.grain.is_finite()) {
            let place = format!("piece \"{}\"", item.name);
            return Err(wrong(place, "a number is not finite"));
        }
    }
    if !strip.usable_width().is_finite() {
        return Err(wrong("the fabric", "its width is not finite"));
    }
    let item = |(id, item): (usize, &Item)| {
        let straight = item.outline.rotated(-item.grain);
        let corner = straight.bounds().min;
        let point = |p: &Vec2| [(p.x - corner.x) * 1e3, (p.y - corner.y) * 1e3];
        let runs = |turn: &&f64| strip.nap != Nap::OneWay || **turn == 0.0;
        let turns = item.allowed.turns.iter().filter(runs);
        let turns: Vec<f64> = turns.map(|t| t.to_degrees()).collect();
        json!({
            "id": id,
            "demand": item.quantity,
            "allowed_orientations": turns,
            "shape": {
                "type": "simple_polygon",
                "data": straight.oriented().outer.iter().map(point).collect::<Vec<_>>(),
            },
        })
    };
    let instance = json!({
        "name": name,
        "strip_height": strip.usable_width() * 1e3,
        "items": items.iter().enumerate().map(item).collect::<Vec<_>>(),
    });
    Ok((format!("{instance}\n"), left_out(items, strip)))
}

/// The properties of the items and of the strip that an instance cannot express.
fn left_out(items: &[Item], strip: &Strip) -> Vec<&'static str> {
    let any = |has: &dyn Fn(&Item) -> bool| items.iter().any(has);
    let all = [
        ("gaps", strip.gap > 0.0 || any(&|i| i.gap > 0.0)),
        ("tilt", any(&|i| i.allowed.tilt > 0.0)),
        ("turning over", any(&|i| i.allowed.mirror != Mirror::Never)),
        ("the nap of each garment", strip.nap == Nap::PerBundle),
        ("end margins", strip.end_margin > 0.0),
        ("the length at hand", strip.max_length.is_some()),
        ("the print", strip.stripes.is_some()),
        ("flaws", !strip.flaws.is_empty()),
        ("folds", any(&|i| i.fold_edge.is_some())),
        ("locked pieces", any(&|i| !i.locked.is_empty())),
        ("holes", any(&|i| !i.outline.holes.is_empty())),
    ];
    let lost = all.into_iter().filter(|what| what.1);
    lost.map(|what| what.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instance_written_is_read_back() {
        let ring = [[0.1, 0.2], [0.5, 0.25], [0.3, 0.9]].map(Vec2::from);
        let item = Item {
            quantity: 3,
            grain: 0.3,
            ..Item::new("sleeve", Polygon::new(ring.to_vec()))
        };
        let strip = Strip {
            selvedge: 0.01,
            ..Strip::of_width(1.5)
        };
        let (text, lost) =
            write_jagua_instance("shirt", std::slice::from_ref(&item), &strip).unwrap();
        assert!(lost.is_empty(), "{lost:?}");
        let damaged = Item {
            grain: f64::NAN,
            ..item.clone()
        };
        assert!(write_jagua_instance("shirt", &[damaged], &strip).is_err());
        assert!(is_jagua_instance(&text));
        let back = read_jagua(&text).unwrap();
        assert_eq!((back.items.len(), back.items[0].quantity), (1, 3));
        let scale = back.scale / 1e-3;
        assert!((back.strip.width / scale - 1.48).abs() < 1e-12);
        let area = back.items[0].outline.area() / (scale * scale);
        assert!((area - item.outline.area()).abs() < 1e-12);
        assert_eq!(back.items[0].allowed.turns, item.allowed.turns);
    }

    #[test]
    fn what_an_instance_cannot_say_is_listed() {
        let square = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.4], [0.0, 0.4]].map(Vec2::from);
        let mut item = Item::new("square", Polygon::new(square.to_vec()));
        item.allowed.mirror = Mirror::Free;
        item.allowed.tilt = 0.02;
        item.gap = 0.001;
        let hole = square.map(|p| p * 0.5 + Vec2::new(0.1, 0.1));
        item.outline.holes.push(hole.to_vec());
        let strip = Strip {
            nap: Nap::OneWay,
            end_margin: 0.01,
            max_length: Some(3.0),
            ..Strip::of_width(1.5)
        };
        let (text, lost) = write_jagua_instance("a", std::slice::from_ref(&item), &strip).unwrap();
        assert_eq!(
            lost,
            [
                "gaps",
                "tilt",
                "turning over",
                "end margins",
                "the length at hand",
                "holes"
            ]
        );
        assert_eq!(read_jagua(&text).unwrap().items[0].allowed.turns, [0.0]);
    }

    use toile_nesting::{Control, Search, make_marker};

    const SMALL: &str = r#"{ "name": "small", "strip_height": 4900.0, "items": [
        { "id": 7, "demand": 2, "allowed_orientations": [0.0, 180.0],
          "shape": { "type": "simple_polygon", "data": [[0, 0], [2000, 0], [0, 1000], [0, 0]] } },
        { "id": 9, "demand": 1, "allowed_orientations": null,
          "shape": { "type": "simple_polygon", "data": [[0, 0], [500, 0], [500, 300]] } } ] }"#;

    #[test]
    fn an_instance_is_read_solved_and_written() {
        assert!(is_jagua_instance(SMALL) && !is_jagua_instance("{}"));
        let instance = read_jagua(SMALL).unwrap();
        assert_eq!(instance.items.len(), 2);
        assert_eq!(instance.items[0].quantity, 2);
        assert_eq!(instance.items[0].outline.outer.len(), 3);
        assert_eq!(instance.items[1].allowed.turns.len(), 24);
        assert_eq!(instance.notes.len(), 1);
        assert!(instance.strip.width >= 1.0 && instance.strip.width < 2.0);
        assert_eq!(instance.strip.width / instance.scale, 4900.0);
        let mut control = Control {
            progress: &mut |_| {},
            cancel: &std::sync::atomic::AtomicBool::new(false),
        };
        let search = Search::evaluations(100_000);
        let marker = make_marker(&instance.items, &instance.strip, search, &mut control).unwrap();
        let text = write_jagua(&instance, &marker, None).unwrap();
        assert_eq!(text, write_jagua(&instance, &marker, None).unwrap());
        let value: Value = serde_json::from_str(&text).unwrap();
        let placed = value["solution"]["layout"]["placed_items"]
            .as_array()
            .unwrap();
        let ids: Vec<i64> = placed
            .iter()
            .filter_map(|p| p["item_id"].as_i64())
            .collect();
        assert_eq!(ids, [7, 7, 9]);
        assert!(value["solution"]["strip_width"].as_f64().unwrap() >= 2000.0);
        assert_eq!(value["items"][0]["demand"], 2);
        assert_eq!(read_jagua(&text).unwrap().items, instance.items);
    }

    #[test]
    fn fields_that_are_not_known_are_noted_with_their_path() {
        for (old, new, path) in [
            (
                "\"allowed_orientations\": [",
                "\"allowed_orientation\": [",
                "items[0].allowed_orientation",
            ),
            ("\"name\":", "\"title\":", "title"),
            (
                "\"type\":",
                "\"holes\": [], \"type\":",
                "items[0].shape.holes",
            ),
        ] {
            let instance = read_jagua(&SMALL.replacen(old, new, 1)).unwrap();
            let note = format!("{path} is not known here and ignored");
            assert!(instance.notes.contains(&note), "{:?}", instance.notes);
        }
    }

    #[test]
    fn damaged_instances_are_refused_with_the_place() {
        for (old, new, place) in [
            ("4900.0", "-1", "strip_height"),
            ("\"demand\": 2", "\"demand\": \"two\"", "items[0].demand"),
            ("[2000, 0]", "[2000]", "items[0].shape.data[1]"),
            (
                "\"type\": \"simple_polygon\", \"data\": [[0, 0], [500",
                "\"type\": \"blob\", \"data\": [[0, 0], [500",
                "items[1].shape.type",
            ),
            ("[0.0, 180.0]", "[\"a\"]", "items[0].allowed_orientations"),
        ] {
            assert!(SMALL.contains(old), "{old}");
            let error = read_jagua(&SMALL.replacen(old, new, 1)).unwrap_err();
            assert_eq!(error.place, place, "{error}");
        }
        assert!(read_jagua("{").is_err() && read_jagua("[]").is_err());
    }
}
