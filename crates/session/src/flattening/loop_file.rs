//! A loop of a file: places on a surface round a region, lines to cut in it, by coordinates or by landmarks of a body.

use crate::SessionError;
use crate::open::read_input;
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::Path;
use toile_body::{Mannequin, Part};
use toile_flatten::SurfaceLoop;
use toile_geometry::{Angle, Vec2, Vec3, horizontal_section};
use toile_interchange::{ExpectedKind, FormatError};

/// Levels of the trunk, from below, as in [`toile_body::Landmarks::spine`].
const LEVELS: [&str; 5] = ["crotch", "hips", "waist", "bust", "neck"];

/// Places within places.
const MAX_DEPTH: usize = 16;

/// Fields of a loop's file.
const FIELDS: [&str; 6] = ["toile", "kind", "places", "inside", "cuts", "comment"];

/// Reads a loop (JSON), and notes on what was not read. Landmarks are those of the mannequin.
///
/// # Errors
/// The file cannot be read, or is no loop; with the place and the remedy.
pub(super) fn open_loop(
    path: &Path,
    body: Option<&Mannequin>,
) -> Result<(SurfaceLoop, Vec<String>), SessionError> {
    let text = read_input(path, ExpectedKind::SmallJson)?;
    read_loop(&text, body)
        .map(|(read, unknown)| {
            let note = |field| {
                format!(
                    "{}: there is no field {field:?}; it was left out",
                    path.display()
                )
            };
            (read, unknown.into_iter().map(note).collect())
        })
        .map_err(|error| SessionError::Format {
            path: path.to_owned(),
            error,
        })
}

fn read_loop(
    text: &str,
    body: Option<&Mannequin>,
) -> Result<(SurfaceLoop, Vec<String>), FormatError> {
    let value: Value = serde_json::from_str(text).map_err(|error| {
        FormatError::new(
            format!("line {}, column {}", error.line(), error.column()),
            error.to_string(),
            "write it as JSON, see docs/FORMATS.md, \"Loops\"",
        )
    })?;
    let wrong = |place: &str, what: &str, hint: &str| Err(FormatError::new(place, what, hint));
    let head = r#"begin with {"toile": 1, "kind": "loop", "places": [...]}"#;
    let Some(object) = value.as_object() else {
        return wrong("the whole file", "this is no loop", head);
    };
    if object.get("kind").and_then(Value::as_str) != Some("loop") {
        return wrong("kind", "this is no loop", head);
    }
    if object.get("toile").and_then(Value::as_u64) != Some(1) {
        return wrong("toile", "the version of the loop is not 1", head);
    }
    let Some(given) = object.get("places").and_then(Value::as_array) else {
        return wrong("places", "there is no list of places", head);
    };
    let places = places(given, "places", body)?;
    let inside = (object.get("inside"))
        .map(|value| place(value, "inside", body, 0))
        .transpose()?;
    let lines = match object.get("cuts") {
        None => &Vec::new(),
        Some(Value::Array(lines)) => lines,
        Some(_) => {
            let hint = "write a list of lines, each a list of places from the loop inwards";
            return wrong("cuts", "this is no list", hint);
        }
    };
    let mut cuts = Vec::with_capacity(lines.len());
    for (k, line) in lines.iter().enumerate() {
        let at = format!("cuts[{k}]");
        let Some(line) = line.as_array() else {
            return wrong(&at, "this is no list", "write a list of places");
        };
        cuts.push(self::places(line, &at, body)?);
    }
    let unknown = (object.keys())
        .filter(|field| !FIELDS.contains(&field.as_str()))
        .cloned();
    let unknown = unknown.collect();
    let read = SurfaceLoop {
        places,
        inside,
        cuts,
    };
    Ok((read, unknown))
}

fn places(given: &[Value], at: &str, body: Option<&Mannequin>) -> Result<Vec<Vec3>, FormatError> {
    (given.iter().enumerate())
        .map(|(k, value)| place(value, &format!("{at}[{k}]"), body, 0))
        .collect()
}

/// A place by coordinates, a landmark's name, a level and an angle, between two others, or moved from another.
fn place(
    value: &Value,
    at: &str,
    body: Option<&Mannequin>,
    depth: usize,
) -> Result<Vec3, FormatError> {
    let wrong = |what: &str, hint: &str| Err(FormatError::new(at, what, hint));
    let shapes = "write [x, y, z] in metres, the name of a landmark, {\"level\": \"waist\", \"angle\": \"90deg\"}, \
                  {\"between\": [place, place], \"share\": 0.5}, or {\"at\": place, \"by\": [x, y, z]}";
    if depth > MAX_DEPTH {
        return wrong("places lie within places too deep", shapes);
    }
    match value {
        Value::Array(_) => match vector(value) {
            Some(place) => Ok(place),
            None => wrong("these are not three finite numbers", shapes),
        },
        Value::String(name) => landmark(name, at, body),
        Value::Object(object) => {
            let get = |name: &str| object.get(name);
            let inner =
                |value: &Value, name: &str| place(value, &format!("{at}.{name}"), body, depth + 1);
            let found = match (get("level"), get("between"), get("at")) {
                (Some(level), None, None) => {
                    let angle = match get("angle") {
                        None => Some(0.0),
                        Some(angle) => (angle.as_str())
                            .and_then(|text| text.parse::<Angle>().ok())
                            .map(|angle| angle.as_radians()),
                    };
                    let (Some(level), Some(angle)) = (level.as_str(), angle) else {
                        return wrong("the level or the angle cannot be read", shapes);
                    };
                    return at_level(level, angle, at, body);
                }
                (None, Some(Value::Array(ends)), None) if ends.len() == 2 => {
                    let (a, b) = (
                        inner(&ends[0], "between[0]")?,
                        inner(&ends[1], "between[1]")?,
                    );
                    let share = get("share").map_or(Some(0.5), Value::as_f64);
                    let Some(share) = share.filter(|share| (0.0..=1.0).contains(share)) else {
                        return wrong("the share is no number from 0 to 1", shapes);
                    };
                    a.lerp(&b, share)
                }
                (None, None, Some(from)) => {
                    let Some(by) = get("by").and_then(vector) else {
                        return wrong("by is not three finite numbers", shapes);
                    };
                    inner(from, "at")? + by
                }
                _ => return wrong("this is no place", shapes),
            };
            // A place between or beside others lies off a bent surface: the nearest point of it is meant.
            let on = body.and_then(|body| body.closest_point(found));
            Ok(on.map_or(found, |on| on.point))
        }
        Value::Null | Value::Bool(_) | Value::Number(_) => wrong("this is no place", shapes),
    }
}

fn vector(value: &Value) -> Option<Vec3> {
    let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
    let [x, y, z] = numbers?[..] else {
        return None;
    };
    Some(Vec3::new(x, y, z))
}

/// The names of landmarks and their places (m).
fn landmarks(body: &Mannequin) -> [(&'static str, Vec3); 12] {
    let marks = body.landmarks();
    [
        ("crown", marks.crown),
        ("chin", marks.chin),
        ("nape", marks.nape),
        ("neck left", marks.neck_sides[0]),
        ("neck right", marks.neck_sides[1]),
        ("shoulder left", marks.shoulder_tips[0]),
        ("shoulder right", marks.shoulder_tips[1]),
        ("bust left", marks.bust_points[0]),
        ("bust right", marks.bust_points[1]),
        ("waist", marks.waist),
        ("hips", marks.hips),
        ("crotch", marks.crotch),
    ]
}

fn need<'a>(body: Option<&'a Mannequin>, at: &str) -> Result<&'a Mannequin, FormatError> {
    body.ok_or_else(|| {
        FormatError::new(
            at,
            "a mesh has no landmarks",
            "give coordinates, [x, y, z] in metres, or a mannequin (--body)",
        )
    })
}

fn landmark(name: &str, at: &str, body: Option<&Mannequin>) -> Result<Vec3, FormatError> {
    let body = need(body, at)?;
    let all = landmarks(body);
    let found = all.iter().find(|mark| mark.0 == name);
    let place = found.map(|mark| mark.1).ok_or_else(|| {
        let names = all.map(|mark| mark.0).join(", ");
        FormatError::new(
            at,
            format!("there is no landmark {name:?}"),
            format!("name one of {names}"),
        )
    })?;
    Ok(body.closest_point(place).map_or(place, |on| on.point))
}

/// The place of the trunk's skin at a level, seen from the middle of the trunk under an angle (rad), 0 forwards, a
/// quarter turn to the wearer's left.
fn at_level(
    level: &str,
    angle: f64,
    at: &str,
    body: Option<&Mannequin>,
) -> Result<Vec3, FormatError> {
    let body = need(body, at)?;
    let middle = LEVELS.iter().position(|name| *name == level);
    let Some(middle) = middle.map(|k| body.landmarks().spine[k]) else {
        return Err(FormatError::new(
            at,
            format!("there is no level {level:?}"),
            format!("name one of {}", LEVELS.join(", ")),
        ));
    };
    let parts = body.part_of_triangle();
    let trunk = (0..body.skin().triangles.len())
        .filter(|&t| matches!(parts.get(t), Some(Part::Trunk | Part::Head)));
    let ends = horizontal_section(body.skin(), trunk, middle.y);
    let (sine, cosine) = angle.rem_euclid(TAU).sin_cos();
    let (from, way) = (Vec2::new(middle.x, middle.z), Vec2::new(sine, cosine));
    let mut nearest: Option<f64> = None;
    for side in ends.chunks_exact(2) {
        let (p, q) = (side[0] - from, side[1] - from);
        let (a, b) = (way.perp(&p), way.perp(&q));
        if (a >= 0.0) == (b >= 0.0) {
            continue;
        }
        let along = p.lerp(&q, a / (a - b)).dot(&way);
        if along > 0.0 && nearest.is_none_or(|best| along < best) {
            nearest = Some(along);
        }
    }
    nearest
        .map(|along| Vec3::new(from.x + way.x * along, middle.y, from.y + way.y * along))
        .ok_or_else(|| {
            FormatError::new(
                at,
                format!("the trunk has no skin at the level {level:?} under this angle"),
                "give another angle, or coordinates",
            )
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_are_read_and_faults_told_with_their_place() {
        let text = r#"{"toile": 1, "kind": "loop", "places": [[0, 1, 2], [1, 0, 0],
            {"at": [0, 0, 0], "by": [0, 0.5, 0]}], "cuts": [[[1, 2, 3], {"between": [[0, 0, 0], [1, 1, 1]], "share": 0.25}]],
            "inside": [9, 9, 9], "colour": 3}"#;
        let (read, unknown) = read_loop(text, None).unwrap();
        assert_eq!(read.places[0], Vec3::new(0.0, 1.0, 2.0));
        assert_eq!(read.places[2], Vec3::new(0.0, 0.5, 0.0));
        assert_eq!(read.cuts[0][1], Vec3::repeat(0.25));
        assert_eq!(read.inside, Some(Vec3::repeat(9.0)));
        assert_eq!(unknown, ["colour"]);
        let fault = |places: &str| {
            let text = format!(r#"{{"toile": 1, "kind": "loop", "places": {places}}}"#);
            read_loop(&text, None).unwrap_err().to_string()
        };
        for (places, says) in [
            ("3", "places"),
            ("[[0, 1]]", "places[0]"),
            ("[[0, 1, 2], null]", "places[1]"),
            (r#"["waist"]"#, "a mesh has no landmarks"),
            (r#"[{"between": [[0, 0, 0]]}]"#, "no place"),
            (r#"[{"between": [[0, 0, 0], 3]}]"#, "places[0].between[1]"),
            (
                r#"[{"between": [[0, 0, 0], [0, 0, 0]], "share": 2}]"#,
                "share",
            ),
            (r#"[{"at": [0, 0, 0], "by": [1]}]"#, "by is not"),
            (r#"[{"level": "waist", "angle": 90}]"#, "angle"),
            (r#"[[0, 1, 1e999]]"#, "line 1"),
        ] {
            assert!(fault(places).contains(says), "{places}: {}", fault(places));
        }
        for text in ["[]", "{", "{}", r#"{"kind": "loop"}"#] {
            assert!(read_loop(text, None).is_err());
        }
    }

    #[test]
    fn landmarks_and_levels_of_a_woman_lie_on_her_skin() {
        let figure = toile_body::Figure::Woman;
        let woman = Mannequin::new(&figure.average(), figure).unwrap();
        let text = r#"{"toile": 1, "kind": "loop", "places": ["waist", "bust left",
            {"level": "waist", "angle": "90deg"}, {"level": "bust", "angle": "-90deg"},
            {"between": ["neck left", "shoulder left"], "share": 0.5}]}"#;
        let (read, _) = read_loop(text, Some(&woman)).unwrap();
        for place in &read.places {
            let on = woman.closest_point(*place).unwrap();
            assert!(on.signed_distance.abs() < 1e-6);
        }
        assert!(read.places[2].x > 0.1 && read.places[2].z.abs() < 0.1);
        assert!(read.places[3].x < -0.1);
        let bad = r#"{"toile": 1, "kind": "loop", "places": ["elbow"]}"#;
        let error = read_loop(bad, Some(&woman)).unwrap_err().to_string();
        assert!(error.contains("elbow") && error.contains("shoulder left"));
    }
}
