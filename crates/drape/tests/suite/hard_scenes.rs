//! Hard scenes: each ends without a crossing, counted exactly, keeps what momentum it must keep and
//! gains no energy that nothing put in. Long ones run in `soak hard`.

use crate::support::hard_run::{Outcome, run};
use crate::support::hard_scenes::{Size, hard_scene};

/// Runs a scene and holds it to what all of them must meet: no crossing on the way nor at the end,
/// no more energy than was there, to a share that contact in substeps leaves, and an end that shows
/// what the scene is about.
fn check(name: &str) -> Outcome {
    let (_, outcome) = run(hard_scene(name, Size::Short));
    assert_eq!(outcome.faults(), Vec::<String>::new(), "{name}");
    outcome
}

#[test]
fn a_sheet_crumpled_by_moving_walls() {
    check("crumpled in a box");
}

#[test]
fn layers_lie_on_a_cylinder() {
    check("layers on a cylinder");
}

#[test]
fn a_strip_twisted_three_turns() {
    check("twisted");
}

#[test]
fn a_scarf_drawn_through_a_ring() {
    check("through a ring");
}

#[test]
fn five_cloths_fall_on_one_another() {
    check("five stacked");
}

#[test]
fn a_knot_drawn_tight() {
    check("knot");
}

#[test]
fn cloths_pinched_between_arm_and_trunk() {
    check("pinched by an arm");
}

#[test]
fn a_sphere_flies_through_a_curtain() {
    check("sphere at 10 m/s");
}

#[test]
fn folded_cloth_falls_on_a_floor() {
    check("folded and dropped");
}

#[test]
fn two_sheets_that_meet_in_flight_keep_their_momentum() {
    let outcome = check("two in free flight");
    let [linear, angular] = outcome.momentum;
    assert!(linear < 1e-4, "{linear}");
    // Friction acts across the thickness that the sheets keep.
    assert!(angular < 0.01, "{angular}");
}
