//! A few laws, quick enough for every test run; `toile validate` measures all.

use toile_lab::{Check, LAWS, LabError, validate};
use toile_session::Silent;

fn checks(names: &[&str]) -> Vec<Check> {
    let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
    validate(&names, &mut Silent).expect("known laws")
}

#[test]
fn the_quick_laws_hold_for_every_method() {
    let quick = [
        "patch",
        "rigid",
        "picture-frame",
        "uniaxial",
        "flight",
        "incline",
        "cloth-on-cloth",
        "fall",
        "viscous-stretch",
        "viscous-bending",
    ];
    let checks = checks(&quick);
    for name in quick {
        assert!(checks.iter().any(|check| check.law == name), "{name}");
    }
    let failed: Vec<&Check> = checks.iter().filter(|check| !check.passed()).collect();
    assert!(failed.is_empty(), "{}", toile_lab::table(&checks));
    for law in LAWS.iter().filter(|law| quick.contains(&law.name)) {
        for tolerance in law.tolerances {
            let used = checks.iter().any(|check| {
                let same = check.quantity == tolerance.quantity && check.of == tolerance.of;
                check.law == law.name && same && check.tolerance <= tolerance.share
            });
            assert!(used, "{}: {tolerance} is no check's", law.name);
        }
    }
}

#[test]
fn coulombs_friction_is_met_within_a_hundredth() {
    let checks = checks(&["capstan", "stick-slip"]);
    assert_eq!(checks.len(), 14);
    for check in &checks {
        assert!(check.tolerance <= 0.01, "{check:?}");
        assert!(check.passed(), "{}", toile_lab::table(&checks));
    }
}

#[test]
fn no_tolerance_of_any_law_is_wider_than_three_per_cent_and_names_are_unique() {
    for law in &LAWS {
        assert!(!law.tolerances.is_empty(), "{}", law.name);
        for tolerance in law.tolerances {
            let share = tolerance.share;
            assert!(share > 0.0 && share <= 0.03, "{}: {tolerance}", law.name);
            assert!(!tolerance.quantity.is_empty() && !tolerance.of.is_empty());
        }
    }
    let mut names: Vec<_> = LAWS.iter().map(|law| law.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), LAWS.len());
}

#[test]
fn an_unknown_law_is_named_with_those_there_are() {
    let error = validate(&["gravity".to_owned()], &mut Silent).expect_err("no such law");
    assert!(matches!(error, LabError::Unknown { .. }));
    assert!(error.to_string().contains("cantilever"), "{error}");
}

#[test]
fn long_work_can_be_stopped() {
    let mut stop = |_: &str, _: f64, _: &str| std::ops::ControlFlow::Break(());
    let error = validate(&["patch".to_owned()], &mut stop).expect_err("stopped");
    assert!(matches!(error, LabError::Cancelled));
}
