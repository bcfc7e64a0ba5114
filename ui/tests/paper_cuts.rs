//! What once took several actions while a pattern was drafted in the window, and takes one now.
#![allow(clippy::unwrap_used)]

mod drafter;

use drafter::Drafter;
use egui::Key;
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
    drafter.typed_on("=half");
    drafter.typed("3");
    assert_eq!(drafter.point("A"), Vec2::new(0.01, 0.03));
}
