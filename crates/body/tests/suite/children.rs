//! Children of several ages: bodies with their measurements, closed and clean.

use crate::common::is_sound;
use toile_body::{Figure, Mannequin};
use toile_measure::{Measurements, Origin};

#[test]
fn children_of_every_age_have_their_measurements() {
    let mut before = 4.0;
    for figure in Figure::ALL {
        let Some(age) = figure.age() else { continue };
        let body = Mannequin::new(&figure.average(), figure).unwrap();
        assert!(is_sound(&body), "{age} years");
        for row in body.measure() {
            let limit = if row.is_girth() { 5e-4 } else { 1e-3 };
            let exact = row.origin == Origin::Asked && !row.is_angle();
            assert!(!exact || row.deviation().abs() <= limit, "{age}: {row:?}");
        }
        let crown = body.levels().crown;
        assert!((crown - figure.average().get("height").unwrap()).abs() < 1e-3);
        // Heads, from crown to nape, in the stature: more with every year, seven at the most.
        let heads = crown / body.taken("head_l").unwrap();
        assert!(heads > before && heads < 7.0, "{age} years: {heads}");
        before = heads;
    }
}

#[test]
fn a_child_of_given_height_and_waist() {
    let mut asked = Measurements::new();
    asked.set("height", 1.1, Origin::Asked).unwrap();
    asked.set("waist", 0.58, Origin::Asked).unwrap();
    let body = Mannequin::new(&asked, Figure::Child6).unwrap();
    assert!(is_sound(&body));
    assert!((body.taken("waist").unwrap() - 0.58).abs() < 5e-4);
    assert!((body.taken("height").unwrap() - 1.1).abs() < 1e-3);
}
