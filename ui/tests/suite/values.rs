//! Variables and measurements: typed in their tables, found by name, changed at once.

use crate::drafter::Drafter;
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable;
use toile_geometry::Vec2;

fn drawing() -> Drafter {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Cuts");
    drafter
}

#[test]
fn variables_are_typed_one_after_another() {
    let mut drafter = drawing();
    drafter.key(Key::F8);
    drafter.press("Variables");
    drafter.enter("New variable", "ease = 2cm");
    drafter.typed("half = ease / 2");
    let pattern = drafter.pattern();
    let names: Vec<&str> = pattern.variables.iter().map(|v| &*v.name).collect();
    assert_eq!(names, ["ease", "half"], "{}", drafter.status());
    // Escape gives the keys back to the tools.
    drafter.key(Key::Escape);
    drafter.hover(drafter.place(0.1, 0.1));
    drafter.key(Key::P);
    drafter.typed_and("=half", Key::Tab);
    drafter.typed("3");
    assert_eq!(drafter.point("A"), Vec2::new(0.01, 0.03));
}

/// Ctrl+K leads to the number of a variable and of a measurement, and says when nothing is found.
#[test]
fn variables_and_measurements_are_found_by_name_and_changed_at_once() {
    let mut drafter = drawing();
    drafter.key(Key::F8);
    drafter.press("Add size");
    drafter.press("Variables");
    drafter.enter("New variable", "ease = 2cm");
    drafter.key(Key::Escape);
    drafter.key(Key::F8);
    drafter.hover(drafter.place(0.1, 0.1));
    let find = |drafter: &mut Drafter, text: &str| {
        drafter.chord(Modifiers::COMMAND, Key::K);
        drafter.window.run();
        drafter.type_text(text);
    };
    find(&mut drafter, "ease");
    drafter.key(Key::Enter);
    drafter.window.run();
    drafter.typed("3cm");
    let pattern = drafter.pattern();
    let evaluation = drafter.evaluation();
    let value = evaluation.variable(pattern.variables[0].id).unwrap().0;
    assert!((value - 0.03).abs() < 1e-12, "{value}");

    drafter.key(Key::Escape);
    drafter.hover(drafter.place(0.1, 0.1));
    find(&mut drafter, "hips");
    drafter.key(Key::Enter);
    drafter.window.run();
    drafter.typed("101,5");
    let size = &drafter.pattern().sizes[0];
    assert_eq!(size.measurements.get("hips"), Some(1.015));
    // Of several sizes that on show is changed.
    drafter.press("Add size");
    let size = drafter.pattern().sizes[1].name.clone();
    drafter.key(Key::Escape);
    let sizes = drafter.window.get_by_role_and_label(Role::ComboBox, "Size");
    drafter.click(sizes.rect().center());
    let sizes = drafter
        .window
        .query_all_by_role_and_label(Role::Button, &size);
    let upper = sizes.min_by(|a, b| a.rect().top().total_cmp(&b.rect().top()));
    let shown = upper.unwrap().rect().center();
    drafter.click(shown);
    let project = drafter.window.state().session().project();
    assert_eq!(project.size.as_ref(), Some(&size));
    drafter.hover(drafter.place(0.1, 0.1));
    find(&mut drafter, "hips");
    drafter.key(Key::Enter);
    drafter.window.run();
    drafter.typed("103");
    let hips = drafter.pattern().sizes.clone();
    let hips = hips.iter().map(|size| size.measurements.get("hips"));
    assert_eq!(hips.collect::<Vec<_>>(), [Some(1.015), Some(1.03)]);

    drafter.key(Key::Escape);
    drafter.hover(drafter.place(0.1, 0.1));
    find(&mut drafter, "no such thing");
    assert!(drafter.status().contains("Nothing has this in its name."));
}

#[test]
fn a_variable_that_is_there_takes_the_new_number() {
    let mut drafter = drawing();
    drafter.key(Key::F8);
    drafter.press("Variables");
    drafter.enter("New variable", "ease = 2cm");
    drafter.typed("half = ease / 2");
    drafter.typed("ease = 5cm");
    let (pattern, evaluation) = (drafter.pattern(), drafter.evaluation());
    assert_eq!(pattern.variables.len(), 2, "{}", drafter.status());
    let half = evaluation.variable(pattern.variables[1].id).unwrap().0;
    assert!((half - 0.025).abs() < 1e-12, "{half}");
}

/// While no size is chosen the base size is drafted, and Find leads to it.
#[test]
fn find_leads_to_the_base_size_while_none_is_chosen() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.hover(drafter.place(0.1, 0.1));
    drafter.chord(Modifiers::COMMAND, Key::K);
    drafter.window.run();
    drafter.type_text("hips");
    drafter.key(Key::Enter);
    drafter.window.run();
    let before = drafter.pattern();
    drafter.typed("101");
    let after = drafter.pattern();
    for (old, new) in before.sizes.iter().zip(&after.sizes) {
        let is_changed = old.measurements.get("hips") != new.measurements.get("hips");
        assert_eq!(is_changed, old.name == "M", "{}", old.name);
    }
}
