//! Sizes, variables, and the head of a pattern.

use super::*;
use crate::sample::{formula, point, sample};
use toile_pattern::plan::NumberAddress;

#[test]
fn sizes_come_and_go_with_their_measurements() {
    let pattern = sample();
    let evaluation = evaluated(&pattern);
    let (edits, one) = plan::add_size(&evaluation, None, Measurements::adult()).unwrap();
    let with = done(&pattern, &edits);
    let (edits, two) =
        plan::add_size(&evaluated(&with), None, Measurements::adult_woman()).unwrap();
    let with = done(&with, &edits);
    let names: Vec<&str> = with.sizes.iter().map(|size| &*size.name).collect();
    assert_eq!(names, ["size", "size 2"]);
    let evaluation = evaluated(&with);
    let edits = plan::set_measurement(&evaluation, two, "bust", Some(0.95)).unwrap();
    let measured = done(&with, &edits);
    assert_eq!(measured.size("size 2").unwrap().get("bust"), Some(0.95));
    assert_eq!(measured.sizes[0], with.sizes[0]);
    let edits = plan::set_measurement(&evaluated(&measured), two, "bust", None).unwrap();
    assert_eq!(
        done(&measured, &edits).size("size 2").unwrap().get("bust"),
        None
    );
    let edits = plan::set_base_size(&evaluation, Some(two)).unwrap();
    let based = done(&with, &edits);
    assert_eq!(based.base().unwrap().id, two);
    let edits = plan::remove_size(&evaluated(&based), two).unwrap();
    let after = done(&based, &edits);
    assert_eq!((after.base_size, after.base().unwrap().id), (None, one));
    let edits = plan::set_base_size(&evaluated(&based), None).unwrap();
    assert!(done(&based, &edits).says_the_same(&with));
    for (found, says) in [
        (
            plan::set_measurement(&evaluation, two, "Bust Girth", Some(1.0)),
            "lower-case",
        ),
        (
            plan::set_measurement(&evaluation, two, "bust", Some(f64::NAN)),
            "finite",
        ),
        (
            plan::set_measurement(&evaluation, two, "tail", None),
            "\"tail\" of size \"size 2\"",
        ),
        (
            plan::set_measurement(&evaluation, SizeId(9999), "bust", None),
            "size 9999",
        ),
        (
            plan::set_base_size(&evaluation, Some(SizeId(9999))),
            "size 9999",
        ),
        (plan::remove_size(&evaluation, SizeId(9999)), "size 9999"),
        (plan::rename_pattern(&evaluation, ""), "cannot be a name"),
    ] {
        let told = refusal(found);
        assert!(told.contains(says), "{told}");
    }
    let told = refusal(plan::add_size(
        &evaluation,
        Some("size"),
        Measurements::adult(),
    ));
    assert!(told.contains("which size \"size\" has"), "{told}");
}

#[test]
fn variables_move_what_uses_them_in_every_size() {
    let pattern = sample();
    let number = formula("bust / 10");
    let (edits, tenth) = plan::add_variable(&evaluated(&pattern), Some("tenth"), number).unwrap();
    let with = done(&pattern, &edits);
    let (edits, other) = plan::add_variable(&evaluated(&with), None, 2.0.into()).unwrap();
    let with = done(&with, &edits);
    assert_eq!(with.variables[1].name, "v1");
    assert_eq!(with.variables[1].id, other);
    let p1 = point(&with, "front", "p1");
    let evaluation = evaluated(&with);
    let number = plan::read_number(&evaluation, "tenth * v1", Want::Length).unwrap();
    let place = NumberAddress::new(p1, "at.x");
    let edits = plan::set_number(&evaluation, &place, number).unwrap();
    let after = done(&with, &edits);
    for body in bodies() {
        let x = body.get("bust").unwrap() / 5.0;
        same_place(places(&after, &body, &[p1])[0], v(x, 0.0));
        let evaluation = Evaluation::new(&after, &body);
        assert!((evaluation.variable(tenth).unwrap().0 - x / 2.0).abs() < 1e-12);
    }
    for (name, number, says) in [
        (Some("tenth"), Number::ZERO, "which variable \"tenth\" has"),
        (Some("bust"), Number::ZERO, "is a measurement"),
        (Some("a'b"), Number::ZERO, "cannot be a name"),
        (None, formula("bus"), "there is no variable or measurement"),
    ] {
        let told = refusal(plan::add_variable(&evaluation, name, number));
        assert!(told.contains(says), "{told}");
    }
}

#[test]
fn the_unit_and_the_name_move_nothing() {
    let pattern = sample();
    let evaluation = evaluated(&pattern);
    let inches = done(&pattern, &plan::set_unit(&evaluation, DisplayUnit::Inch));
    let edits = plan::rename_pattern(&evaluated(&inches), "coat").unwrap();
    let after = done(&inches, &edits);
    assert_eq!((&*after.name, after.unit), ("coat", DisplayUnit::Inch));
    for body in bodies() {
        let points = Evaluation::new(&after, &body).points();
        assert_eq!(points, Evaluation::new(&pattern, &body).points());
    }
}

#[test]
fn a_length_stays_a_length_in_sizes_with_their_own() {
    let (edits, size) =
        plan::add_size(&evaluated(&sample()), None, Measurements::adult_woman()).unwrap();
    let pattern = done(&sample(), &edits);
    let number = formula("bust / 10");
    let (edits, tenth) = plan::add_variable(&evaluated(&pattern), None, number).unwrap();
    let pattern = done(&pattern, &edits);
    let place = NumberAddress::new(tenth, "value");
    let wish = (size, Some(0.07));
    let edits = plan::set_number_in_size(&evaluated(&pattern), &place, wish).unwrap();
    let pattern = done(&pattern, &edits);
    for body in bodies() {
        let value = match body == Measurements::adult_woman() {
            true => 0.07,
            false => body.get("bust").unwrap() / 10.0,
        };
        let evaluation = Evaluation::new(&pattern, crate::plans::wearer(&pattern, &body));
        let (found, power) = evaluation.variable(tenth).unwrap();
        assert!((found - value).abs() < 1e-12 && power == 1);
    }
}
