//! Guides in pattern files: read back to the bit, refused with their place; files without any keep
//! their bytes.

use toile_interchange::{read_pattern, write_pattern};
use toile_pattern::{Edit, Entity, Guide, GuideRun, Severity};

const SHIRT: &str = include_str!("../../../../patterns/t-shirt.toile.json");

/// The shirt with guides in its file.
fn with(guides: &str) -> String {
    let end = SHIRT.find("\"next_id\"").unwrap();
    format!(
        "{}\"guides\": [{guides}],\n  \"next_id\": 903\n}}\n",
        &SHIRT[..end]
    )
}

#[test]
fn guides_are_read_and_written() {
    let text = with(r#"{"id": 900, "y": 12.5}, {"id": 902, "x": {"m": -0.1061}}"#);
    let (pattern, notes) = read_pattern(&text).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let guides: Vec<Guide> = pattern.guides.iter().map(|guide| **guide).collect();
    let [level, upright] = guides[..] else {
        panic!("{guides:?}")
    };
    assert_eq!((level.runs, level.at), (GuideRun::Horizontal, 0.125));
    assert_eq!((upright.runs, upright.at), (GuideRun::Vertical, -0.1061));
    let written = write_pattern(&pattern).unwrap();
    let (again, _) = read_pattern(&written).unwrap();
    assert_eq!(again, pattern);
    assert_eq!(write_pattern(&again).unwrap(), written);
}

#[test]
fn a_file_without_guides_says_nothing_of_them() {
    let (mut pattern, _) = read_pattern(SHIRT).unwrap();
    let before = write_pattern(&pattern).unwrap();
    assert!(!before.contains("guides"));
    let id = pattern.ids.take();
    let guide = Guide {
        id,
        runs: GuideRun::Vertical,
        at: 0.3,
    };
    let unchanged = pattern.clone();
    let put = Edit::Put(Entity::Guide(guide.into()));
    pattern.apply(&[put]).unwrap();
    assert!(write_pattern(&pattern).unwrap().contains("guides"));
    pattern.apply(&[Edit::Remove(id.into())]).unwrap();
    assert_eq!(pattern, unchanged);
}

#[test]
fn what_is_wrong_with_a_guide_is_told_with_its_place() {
    for (guide, path, words) in [
        (r#"{"id": 900, "y": 1e999}"#, "guides[0].y", "finite"),
        (r#"{"id": 900, "x": NaN}"#, "line", "N"),
        (r#"{"id": 900, "x": null}"#, "guides[0].x", "number"),
        (r#"{"id": 900, "x": "waist / 2"}"#, "guides[0].x", "formula"),
        (r#"{"id": 900, "x": 1, "y": 2}"#, "guides[0].", "kind"),
        (r#"{"id": 900}"#, "guides[0]", "\"y\""),
        (r#"{"y": 2}"#, "guides[0]", "\"id\""),
        (r#"{"id": 990, "y": 2}"#, "next_id", "991"),
        (
            r#"{"id": 900, "y": 2}, {"id": 900, "x": 2}"#,
            "guides[1].id",
            "already",
        ),
        (r#"7"#, "guides[0]", "object"),
    ] {
        let error = read_pattern(&with(guide)).unwrap_err().to_string();
        assert!(
            error.contains(path) && error.contains(words),
            "{guide}: {error}"
        );
    }
    // A field that is not known is told, as everywhere.
    let (_, notes) = read_pattern(&with(r#"{"id": 900, "y": 2, "colour": "red"}"#)).unwrap();
    assert!(
        notes.iter().any(|note| note.severity == Severity::Warning),
        "{notes:?}"
    );
}

#[test]
fn a_place_that_is_not_finite_is_neither_put_nor_written() {
    let (mut pattern, _) = read_pattern(SHIRT).unwrap();
    let before = pattern.clone();
    for at in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let guide = Guide {
            id: 900.into(),
            runs: GuideRun::Horizontal,
            at,
        };
        let put = Edit::Put(Entity::Guide(guide.into()));
        let error = pattern.apply(&[put]).unwrap_err().to_string();
        assert!(
            error.contains("guide 900") && error.contains("finite"),
            "{error}"
        );
        assert_eq!(pattern, before);
        let mut forced = pattern.clone();
        forced.guides.push(guide.into());
        let error = write_pattern(&forced).unwrap_err().to_string();
        assert!(error.contains("guide 900"), "{error}");
    }
}
