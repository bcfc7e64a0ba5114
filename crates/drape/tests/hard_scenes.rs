//! Hard scenes: each ends without a crossing, counted exactly, keeps what momentum it must keep and
//! gains no energy that nothing put in. Long ones run in `soak hard`.

#[path = "support/hard_scenes.rs"]
mod hard_scenes;
#[path = "support/sheets.rs"]
mod sheets;
#[path = "support/solids.rs"]
mod solids;

use hard_scenes::{Outcome, Size, hard_scene, run};

/// Runs a scene and holds it to what all of them must meet: no crossing on the way nor at the end,
/// and no more energy than was there, to a share that contact in substeps leaves.
fn check(name: &str, energy: f64) -> Outcome {
    let (_, outcome) = run(hard_scene(name, Size::Short));
    assert_eq!(outcome.crossings, [0, 0], "{name}: cloth crosses cloth");
    assert_eq!(outcome.body_crossings, 0, "{name}: cloth crosses a body");
    let rise = outcome.energy_rise / outcome.energy_scale;
    assert!(rise <= energy, "{name}: energy rises by {rise}");
    assert!(outcome.tally.looks > 10, "{name}: contact was looked for");
    outcome
}

#[test]
fn a_sheet_crumpled_by_moving_walls() {
    check("crumpled in a box", 0.02);
}

#[test]
fn layers_lie_on_a_cylinder() {
    check("layers on a cylinder", 0.02);
}

#[test]
fn a_strip_twisted_three_turns() {
    // Moves are cut where it jams, which strains it a little.
    check("twisted", 0.1);
}

#[test]
fn a_scarf_drawn_through_a_ring() {
    check("through a ring", 0.02);
}

#[test]
fn five_cloths_fall_on_one_another() {
    check("five stacked", 0.02);
}

#[test]
fn a_knot_drawn_tight() {
    check("knot", 0.02);
}

#[test]
fn cloths_pinched_between_arm_and_trunk() {
    check("pinched by an arm", 0.02);
}

#[test]
fn a_sphere_flies_through_a_curtain() {
    check("sphere at 10 m/s", 0.02);
}

#[test]
fn folded_cloth_falls_on_a_floor() {
    check("folded and dropped", 0.03);
}

#[test]
fn two_sheets_that_meet_in_flight_keep_their_momentum() {
    let outcome = check("two in free flight", 1e-3);
    let [linear, angular] = outcome.momentum;
    assert!(linear < 1e-4, "{linear}");
    // Friction acts across the thickness that the sheets keep.
    assert!(angular < 0.01, "{angular}");
}
