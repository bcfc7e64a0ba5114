//! Markers in pattern files: read back to the bit, refused with their place.

use toile_interchange::{read_pattern, write_pattern};
use toile_pattern::{NapRule, Spread};

const SHIRT: &str = include_str!("../../../../patterns/t-shirt.toile.json");

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
    assert_eq!(
        (cloth.selvedge, cloth.gap),
        (None, None),
        "what is not said stays open"
    );
    assert_eq!(
        (cloth.nap, cloth.spread),
        (Some(NapRule::PerGarment), Some(Spread::Folded))
    );
    assert_eq!((cloth.plies, cloth.price_per_metre), (Some(3), Some(11.5)));
    assert_eq!(cloth.tilt, Some(2f64.to_radians()));
    assert_eq!(cloth.print.unwrap().repeat, [0.05, 0.0]);
    let flaws = cloth.flaws.as_deref().unwrap();
    assert_eq!((flaws[0].at, flaws[0].clearance), ([1.0, 0.2], 0.005));
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

/// The shirt with that marker on two rolls, with rules and marks that match.
fn ruled() -> String {
    let (pattern, _) = read_pattern(SHIRT).unwrap();
    let panel = |name: &str| pattern.panel_named(name).unwrap();
    let notch = |panel: &toile_pattern::Panel| {
        let mut notches = panel.notches.iter();
        notches.find(|notch| notch.name == "waist").unwrap().id.0
    };
    let (front, back) = (panel("front"), panel("back"));
    let more = format!(
        r#""selvedge": 1,
      "gap": 0.2,
      "rolls": [{{"name": "remnant", "width": 140, "length": 200, "price_per_metre": 4, "flaws": []}}, {{}}],
      "rules": [
        {{"tilt": 2}},
        {{"panel": {0}, "gap": 0.4, "block": 2, "turns": [0, 180], "turn_over": false}},
        {{"panel": {0}, "copy": 1, "on_fold": true, "over_flaws": false, "on_print": true, "fabric": {2}}},
        {{"panel": {1}, "also": [{{"fabric": {2}, "quantity": 2}}]}}
      ],
      "match": [[{{"panel": {0}, "notch": {3}}}, {{"panel": {1}, "notch": {4}}}]],
      "order""#,
        front.id.0,
        back.id.0,
        front.fabric.0,
        notch(front),
        notch(back)
    );
    let with = marked().replacen("\"order\"", &more, 1);
    with.replacen("\"locked\": true", "\"roll\": 1", 1)
}

#[test]
fn rolls_rules_and_marks_are_read_and_written() {
    let (pattern, notes) = read_pattern(&ruled()).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let marker = pattern.marker_named("jersey 140").unwrap();
    let cloth = &marker.cloth;
    assert_eq!(
        (cloth.selvedge, cloth.gap),
        (Some(0.01), Some(0.002)),
        "given as by default"
    );
    let rolls = cloth.rolls.as_deref().unwrap();
    assert_eq!(rolls[0].name.as_deref(), Some("remnant"));
    assert_eq!((rolls[0].width, rolls[0].length), (Some(1.4), Some(2.0)));
    assert_eq!(rolls[0].flaws.as_deref(), Some(&[][..]));
    assert_eq!(rolls[1], toile_pattern::Roll::default());
    let front = pattern.panel_named("front").unwrap();
    let rule = |copy| marker.rule_for(front.id, copy);
    assert_eq!(rule(0).rule.block, Some(0.02));
    assert_eq!(rule(0).rule.tilt, Some(2f64.to_radians()));
    let turns = rule(0).rule.turns.unwrap();
    assert_eq!(turns[1].0, std::f64::consts::PI);
    assert_eq!((rule(0).fabric, rule(1).fabric), (None, Some(front.fabric)));
    assert_eq!((marker.rules.len(), marker.matched[0].0.len()), (4, 2));
    assert_eq!(marker.placements[0].roll, 1);
    let text = write_pattern(&pattern).unwrap();
    let (again, _) = read_pattern(&text).unwrap();
    assert_eq!(again, pattern);
    assert_eq!(write_pattern(&again).unwrap(), text);
}

#[test]
fn what_no_cloth_can_be_laid_by_is_refused() {
    let good = ruled();
    for (old, new, what) in [
        (
            "}, {}],",
            "}, {\"name\": \"remnant\"}],",
            "two rolls are called",
        ),
        ("\"length\": 200", "\"length\": 0", "the roll has no length"),
        (
            "\"rolls\": [",
            "\"rolls\": {}, \"held\": [",
            "where a list is expected",
        ),
        (
            "\"copy\": 1, \"on_fold",
            "\"on_fold",
            "the same pieces have two rules",
        ),
        ("\"turns\": [0, 180]", "\"turns\": []", "in no direction"),
        (
            "\"turns\": [0, 180]",
            "\"turns\": 0",
            "where a list is expected",
        ),
        ("\"block\": 2", "\"block\": -2", "the block of its rule"),
        (
            "\"on_fold\": true",
            "\"on_fold\": 1",
            "where true or false is expected",
        ),
        (
            "\"quantity\": 2}]}",
            "\"quantity\": 0.5}]}",
            "not a whole number",
        ),
    ] {
        assert!(good.contains(old), "{old}");
        let error = read_pattern(&good.replacen(old, new, 1)).unwrap_err();
        assert!(error.what.contains(what), "{old}: {error}");
        assert!(error.place.starts_with("line "), "{error}");
        assert!(!error.hint.is_empty(), "{error}");
    }
    // A panel that was never given, and a mark alone.
    let panel = good.replacen("{\"panel\": ", "{\"panel\": 88888", 1);
    assert!(read_pattern(&panel).is_err());
    let start = good.find("\"match\": [[").unwrap();
    let end = start + good[start..].find("]]").unwrap();
    let middle = start + good[start..end].rfind(", {").unwrap();
    let alone = format!("{}{}", &good[..middle], &good[end..]);
    let error = read_pattern(&alone).unwrap_err();
    assert!(error.what.contains("fewer than two marks"), "{error}");
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
