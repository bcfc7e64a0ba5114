//! How a garment is tried on, in pattern files: read back to the bit, refused with its place; files that say
//! nothing of it keep their bytes.

use toile_body::Figure;
use toile_interchange::{
    Fitting, FittingFabric, FittingLayer, FittingWearer, read_document, read_pattern,
    write_document, write_pattern,
};
use toile_measure::{Measurements, Origin};
use toile_pattern::SizeId;

const SHIRT: &str = include_str!("../../../../patterns/t-shirt.toile.json");

/// The shirt with a fitting in its file.
fn with(fitting: &str) -> String {
    SHIRT.replacen(
        "\"next_id\"",
        &format!("\"fitting\": {fitting},\n  \"next_id\""),
        1,
    )
}

/// Wearers of every kind.
fn wearers() -> Vec<FittingWearer> {
    let mut measurements = Measurements::new();
    for (name, value, origin) in [
        ("waist", 0.7351, Origin::Asked),
        ("shoulder_incl", 0.3, Origin::Asked),
        ("hips", 1.0 / 3.0 + 0.7, Origin::Predicted),
        ("collar_stand", 0.04, Origin::Asked),
    ] {
        measurements.set(name, value, origin).unwrap();
    }
    let measured = |file: Option<&str>| FittingWearer::Measured {
        figure: Figure::Child8,
        file: file.map(str::to_owned),
        measurements: measurements.clone(),
    };
    vec![
        FittingWearer::OfPattern,
        FittingWearer::Figure(Figure::Man),
        measured(None),
        measured(Some("people/Anna.json")),
        FittingWearer::Mannequin {
            file: "../anna \"the\" best.json".to_owned(),
        },
    ]
}

#[test]
fn a_fitting_is_read_and_written() {
    let (pattern, _) = read_pattern(SHIRT).unwrap();
    let fabrics = [
        None,
        Some(FittingFabric::Named("denim".to_owned())),
        Some(FittingFabric::File("ponte.json".to_owned())),
    ];
    for wearer in wearers() {
        for fabric in &fabrics {
            let fitting = Fitting {
                wearer: wearer.clone(),
                size: pattern.base_size,
                fabric: fabric.clone(),
                width: Some(1.423_456_789_1),
                layer: 2,
                worn_with: vec![FittingLayer {
                    file: "coat.toile.json".to_owned(),
                    layer: 999,
                }],
            };
            let text = write_document(&pattern, &fitting).unwrap();
            let again = read_document(&text).unwrap();
            assert!(again.notes.is_empty(), "{:?}", again.notes);
            assert_eq!(again.fitting, fitting);
            assert_eq!(again.pattern, pattern);
            assert_eq!(
                write_document(&again.pattern, &again.fitting).unwrap(),
                text
            );
        }
    }
}

#[test]
fn a_file_without_a_fitting_says_nothing_of_it() {
    let file = read_document(SHIRT).unwrap();
    assert_eq!(file.fitting, Fitting::default());
    let text = write_document(&file.pattern, &file.fitting).unwrap();
    assert_eq!(text, SHIRT);
    assert_eq!(write_pattern(&file.pattern).unwrap(), text);
}

#[test]
fn what_is_wrong_with_a_fitting_is_told_with_its_place() {
    for (fitting, path, words) in [
        (r#"7"#, "fitting", "object"),
        (
            r#"{"wearer": {"figure": "giant"}}"#,
            "wearer.figure",
            "woman",
        ),
        (r#"{"wearer": {}}"#, "fitting.wearer", "\"figure\""),
        (
            r#"{"wearer": {"figure": "man", "file": "a.json"}}"#,
            "wearer.file",
            "kind",
        ),
        (
            r#"{"wearer": {"figure": "man", "mannequin": "a.json"}}"#,
            "wearer.figure",
            "kind",
        ),
        (r#"{"wearer": {"mannequin": ""}}"#, "mannequin", "empty"),
        (
            r#"{"wearer": {"figure": "man", "measurements": {"waist": NaN}}}"#,
            "line",
            "N",
        ),
        (
            r#"{"wearer": {"figure": "man", "measurements": {"waist": "hips"}}}"#,
            "measurements.waist",
            "formula",
        ),
        (
            r#"{"wearer": {"figure": "man", "measurements": {"height": 180, "chest": -90}}}"#,
            "measurements.chest",
            "above 0",
        ),
        (
            r#"{"wearer": {"figure": "man", "measurements": {"collar": 0}}}"#,
            "measurements.collar",
            "above 0",
        ),
        (r#"{"size": 4000000}"#, "fitting.size", "never given"),
        (r#"{"size": "M"}"#, "fitting.size", "whole number"),
        (r#"{"fabric": {}}"#, "fitting.fabric", "\"name\""),
        (
            r#"{"fabric": {"name": "denim", "file": "a.json"}}"#,
            "fabric.file",
            "kind",
        ),
        (r#"{"width": 4}"#, "fitting.width", "5 cm to 20 m"),
        (r#"{"width": -140}"#, "fitting.width", "5 cm to 20 m"),
        (r#"{"width": 1e999}"#, "fitting.width", "finite"),
        (r#"{"layer": 1000}"#, "fitting.layer", "999"),
        (r#"{"layer": -1}"#, "fitting.layer", "whole number"),
        (
            r#"{"worn_with": [{"layer": 1}]}"#,
            "worn_with[0]",
            "\"file\"",
        ),
        (
            r#"{"worn_with": [{"file": "a.json"}]}"#,
            "worn_with[0]",
            "\"layer\"",
        ),
        (
            r#"{"worn_with": [{"file": "a.json", "layer": 70000}]}"#,
            "worn_with[0].layer",
            "999",
        ),
    ] {
        let error = read_document(&with(fitting)).unwrap_err().to_string();
        assert!(
            error.contains("line ") && error.contains(path) && error.contains(words),
            "{fitting}: {error}"
        );
    }
    // A field that is not known is told, as everywhere.
    let file = read_document(&with(r#"{"wearer": {"figure": "man", "mood": 1}}"#)).unwrap();
    assert_eq!(file.notes.len(), 1, "{:?}", file.notes);
    assert_eq!(file.fitting.wearer, FittingWearer::Figure(Figure::Man));
}

/// A size that was removed may be named: it comes back with Undo.
#[test]
fn a_size_that_is_gone_may_stay_named() {
    let (mut pattern, _) = read_pattern(SHIRT).unwrap();
    let gone: SizeId = pattern.ids.take();
    let fitting = Fitting {
        size: Some(gone),
        ..Fitting::default()
    };
    let text = write_document(&pattern, &fitting).unwrap();
    assert_eq!(read_document(&text).unwrap().fitting.size, Some(gone));
}
