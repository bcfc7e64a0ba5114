//! Grade rules in the window: given to a selected point, typed by size, undone exactly.

use crate::drafter::Drafter;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use toile_pattern::{Evaluation, GradeRule, PointId, plan};

fn point(drafter: &Drafter, name: &str) -> PointId {
    let pattern = drafter.pattern();
    pattern.sheets[0].point_named(name).unwrap().id
}

/// Places of a point in all sizes (m).
fn places(drafter: &Drafter, id: PointId) -> Vec<[f64; 2]> {
    let pattern = drafter.pattern();
    let sizes = pattern.sizes.iter();
    sizes
        .map(|size| Evaluation::new(&pattern, size).point(id).unwrap().into())
        .collect()
}

#[test]
fn a_rule_is_given_typed_and_undone_exactly() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "graded");
    drafter.chord(Modifiers::SHIFT, Key::L);
    for (x, y) in [
        (0.0, 0.0),
        (0.2, 0.02),
        (0.25, 0.3),
        (-0.03, 0.26),
        (0.0, 0.0),
    ] {
        drafter.click(drafter.place(x, y));
    }
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.key(Key::F8);
    drafter.press("Add size");
    drafter.press("Add size");
    let before = drafter.pattern();
    let steps = drafter.steps();
    assert_eq!(before.sizes.len(), 2);
    let [base, other] = [0, 1].map(|k| before.sizes[k].name.clone());
    let corner = point(&drafter, "A");
    let at = places(&drafter, corner);
    drafter.click(drafter.part("Point A of draft"));
    drafter.window.get_by_label("Grading").click();
    drafter.window.run();
    drafter.press("Give grade rule");
    assert_eq!(
        GradeRule::all(&drafter.pattern()).len(),
        1,
        "{}",
        drafter.status()
    );
    drafter.enter(&format!("Rule 1 across in {other}"), "1.2");
    drafter.enter(&format!("Rule 1 up in {other}"), "-3mm");
    let now = places(&drafter, corner);
    let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12;
    assert!(near(now[0], at[0]), "the base size {base} stays: {now:?}");
    assert!(
        near(now[1], [at[1][0] + 0.012, at[1][1] - 0.003]),
        "{now:?}"
    );
    // A fault is told at the field, and changes nothing.
    let kept = drafter.pattern();
    drafter.enter(&format!("Rule 1 across in {other}"), "50m");
    assert_eq!(drafter.pattern(), kept);
    drafter.key(Key::Escape);
    // The rule is copied to another corner, and mirrored there.
    drafter.click(drafter.part("Point A of draft"));
    drafter.shift_click(drafter.part("Point D of draft"));
    drafter.press("Copy grade rule");
    let copied = point(&drafter, "D");
    let rule = GradeRule::all(&drafter.pattern())[0];
    assert_eq!(
        plan::points_of_rule(&drafter.pattern(), rule).len(),
        2,
        "{}",
        drafter.status()
    );
    drafter.key(Key::Escape);
    drafter.click(drafter.part("Point D of draft"));
    drafter.press("Mirror grade rule across");
    let of_copy = places(&drafter, copied);
    assert!(
        near(of_copy[1], [of_copy[0][0] - 0.012, of_copy[0][1] - 0.003]),
        "{of_copy:?}"
    );
    // The nest shows the ways of both corners.
    drafter.chord(Modifiers::SHIFT, Key::G);
    let grading = drafter.window.state().view().grading.clone().unwrap();
    assert_eq!(grading.ways.len(), 2);
    assert!(grading.ways.iter().all(|way| way.places.len() == 2));
    drafter.chord(Modifiers::SHIFT, Key::G);
    while drafter.steps() > steps {
        drafter.chord(Modifiers::COMMAND, Key::Z);
    }
    // The counter of ids alone goes on.
    assert!(drafter.pattern().says_the_same(&before));
    let field = format!("Rule 1 across in {other}");
    assert!(drafter.window.query_by_label(&field).is_none());
}
