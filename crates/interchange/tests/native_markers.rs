//! Markers in pattern files: read back to the bit, refused with their place.
#![allow(clippy::unwrap_used)]

use toile_interchange::{read_pattern, write_pattern};
use toile_pattern::{NapRule, Spread};

const SHIRT: &str = include_str!("../../../patterns/t-shirt.toile.json");

/// A marker of the shirt, a field a line.
const MARKER: &str = r#"    {
      "id": 900,
      "name": "jersey 140",
      "fabric": FABRIC,
      "width": 140,
      "length": 500,
      "nap": "per-garment",
      "tilt": 2,
      "spread": "folded",
      "plies": 3,
      "price_per_metre": 11.5,
      "currency": "EUR",
      "print": {"repeat": [5, 0]},
      "flaws": [{"at": [100, 20], "size": [3, 1], "clearance": 0.5}],
      "order": [{"size": SIZE, "quantity": 2}],
      "placements": [
        {"panel": FRONT, "size": SIZE, "at": [12.5, 40], "locked": true},
        {"panel": FRONT, "size": SIZE, "garment": 1, "at": [112.5, 40.25], "turn": 180, "flipped": true}
      ]
    }"#;

/// The shirt with that marker in its file.
fn marked() -> String {
    let (pattern, _) = read_pattern(SHIRT).unwrap();
    let size = pattern.size_named("M").unwrap().id.0;
    let front = pattern.panel_named("front").unwrap();
    let marker = MARKER
        .replace("SIZE", &size.to_string())
        .replace("FRONT", &front.id.0.to_string())
        .replace("FABRIC", &front.fabric.0.to_string());
    let end = SHIRT.find("\"next_id\"").unwrap();
    format!(
        "{}\"markers\": [\n{marker}\n  ],\n  \"next_id\": 901\n}}\n",
        &SHIRT[..end]
    )
}

#[test]
fn a_marker_is_read_and_written() {
    let (pattern, notes) = read_pattern(&marked()).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let marker = pattern.marker_named("jersey 140").unwrap();
    let cloth = &marker.cloth;
    assert_eq!((cloth.width, cloth.length), (Some(1.4), Some(5.0)));
    assert_eq!((cloth.selvedge, cloth.gap), (0.01, 0.002));
    assert_eq!(
        (cloth.nap, cloth.spread),
        (Some(NapRule::PerGarment), Spread::Folded)
    );
    assert_eq!((cloth.plies, cloth.price_per_metre), (3, Some(11.5)));
    assert_eq!(cloth.tilt, 2f64.to_radians());
    assert_eq!(cloth.print.unwrap().repeat, [0.05, 0.0]);
    assert_eq!(
        (cloth.flaws[0].at, cloth.flaws[0].clearance),
        ([1.0, 0.2], 0.005)
    );
    assert_eq!(marker.quantity(pattern.size_named("M").map(|m| m.id)), 2);
    let [first, second] = &marker.placements[..] else {
        panic!("{marker:?}")
    };
    assert_eq!(
        (first.at, first.locked, first.flipped),
        ([0.125, 0.4], true, false)
    );
    assert_eq!(
        (second.piece.garment, second.turn),
        (1, std::f64::consts::PI)
    );
    let text = write_pattern(&pattern).unwrap();
    let (again, _) = read_pattern(&text).unwrap();
    assert_eq!(again, pattern);
    assert_eq!(write_pattern(&again).unwrap(), text);
}

#[test]
fn what_is_wrong_is_refused_with_line_and_column() {
    let good = marked();
    let line_of = |text: &str, what: &str| {
        let at = text.find(what).unwrap();
        1 + text[..at].matches('\n').count()
    };
    for (old, new, what) in [
        ("\"width\": 140", "\"width\": -140", "the width is -1.4"),
        ("\"width\": 140", "\"width\": \"bust\"", "a formula stands"),
        (
            "\"width\": 140",
            "\"width\": true",
            "where a length is expected",
        ),
        (
            "per-garment",
            "sometimes",
            "\"sometimes\" is not known here",
        ),
        ("\"plies\": 3", "\"plies\": 0", "0 plies"),
        ("\"quantity\": 2", "\"quantity\": 0", "no garment"),
        ("\"quantity\": 2", "\"quantity\": 2.5", "not a whole number"),
        ("\"garment\": 1, ", "", "the piece is laid twice"),
        (
            "\"at\": [12.5, 40]",
            "\"at\": [12.5]",
            "the list has 1 items",
        ),
        ("\"at\": [12.5, 40], ", "", "\"at\" is missing"),
        ("\"size\": [3, 1]", "\"size\": [-3, 1]", "the flaw's size"),
        (
            "\"name\": \"jersey 140\"",
            "\"name\": \" \"",
            "cannot be a name",
        ),
        ("\"id\": 900", "\"id\": 901", "901 has been given"),
        (
            "\"repeat\": [5, 0]",
            "\"repeat\": [5, -1]",
            "the repeat of the print",
        ),
    ] {
        assert!(good.contains(old), "{old}");
        let bad = good.replacen(old, new, 1);
        let error = read_pattern(&bad).unwrap_err();
        assert!(error.what.contains(what), "{old}: {error}");
        assert!(!error.hint.is_empty(), "{error}");
        let line = match new {
            "" => line_of(&good, old),
            "\"id\": 901" => line_of(&bad, "\"next_id\""),
            _ => line_of(&bad, new),
        };
        let place = format!("line {line}, column ");
        assert!(
            error.place.starts_with(&place),
            "{old}: {error}, not {place}"
        );
    }
    let panel = good.replacen("\"panel\": ", "\"panel\": 99", 1);
    let error = read_pattern(&panel);
    assert!(error.is_err(), "a seam's panel was never given");
    let unknown = good.replacen("\"locked\": true", "\"held\": true", 1);
    let (_, notes) = read_pattern(&unknown).unwrap();
    assert!(notes[0].message.contains("\"held\""), "{notes:?}");
}
