//! What once took several actions while a pattern was drafted in the window, and takes one now.
#![allow(clippy::unwrap_used)]

mod drafter;

use drafter::Drafter;
use egui::{Key, Modifiers};
use toile_geometry::Vec2;
use toile_ui::Overlay;

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

/// A new piece is not a fault before the first seam is sewn.
#[test]
fn nothing_is_forgotten_before_the_first_seam() {
    let mut drafter = drawing();
    for from in [0.0, 0.1, 0.2] {
        drafter.key(Key::R);
        drafter.click(drafter.place(from, 0.0));
        drafter.click(drafter.place(from + 0.06, 0.2));
    }
    assert_eq!(drafter.pattern().panels.len(), 3, "{}", drafter.status());
    assert!(drafter.window.state().findings().is_empty());
    drafter.key(Key::S);
    drafter.click(drafter.part("Edge right of draft"));
    drafter.click(drafter.part("Edge left 2 of draft 2"));
    drafter.key(Key::Escape);
    let found = drafter.window.state().findings();
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].to_string().contains("sewn to nothing"));
}

/// `'` and a name, typed before the last place of an inner line or of open lines, name them.
#[test]
fn lines_that_are_no_panel_are_named_as_they_are_drawn() {
    let mut drafter = drawing();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.key(Key::I);
    drafter.click(drafter.place(0.1, 0.15));
    drafter.click(drafter.place(0.05, 0.1));
    drafter.type_text("'pocket");
    drafter.click(drafter.place(0.15, 0.1));
    drafter.key(Key::Enter);
    drafter.key(Key::Escape);
    let pattern = drafter.pattern();
    let lines = &pattern.panels[0].lines;
    assert_eq!(lines.len(), 2, "{}", drafter.status());
    assert_eq!(lines[1].name, "pocket");

    drafter.chord(Modifiers::SHIFT, Key::L);
    drafter.click(drafter.place(0.22, 0.1));
    drafter.click(drafter.place(0.25, 0.2));
    drafter.type_text("'roof");
    drafter.click(drafter.place(0.28, 0.1));
    drafter.key(Key::Enter);
    let pattern = drafter.pattern();
    let mut curves = pattern.sheets.iter().flat_map(|sheet| &sheet.curves);
    for name in ["roof 1", "roof 2"] {
        assert!(
            curves.any(|curve| curve.name == name),
            "{}",
            drafter.status()
        );
    }
}

#[test]
fn the_handles_of_a_curve_are_set_beside_it_one_after_another() {
    let mut drafter = drawing();
    drafter.key(Key::C);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.0));
    drafter.key(Key::Enter);
    drafter.enter_on("x of handle at A", "5");
    drafter.typed_and("3", Key::Tab);
    drafter.typed_and("-4", Key::Tab);
    drafter.typed("2");
    let away = |name: &str, x: f64, y: f64| (drafter.point(name) - Vec2::new(x, y)).norm();
    assert!(away("h1", 0.05, 0.03) < 1e-12, "{}", drafter.status());
    assert!(away("h2", 0.16, 0.02) < 1e-12, "{}", drafter.status());
}

#[test]
fn a_point_drawn_from_another_follows_it() {
    let mut drafter = drawing();
    drafter.hover(drafter.place(0.1, 0.2));
    drafter.key(Key::P);
    drafter.typed_and("0", Key::Tab);
    drafter.typed("0");
    // By numbers, and by a click.
    drafter.key(Key::U);
    drafter.click(drafter.part("Point A of draft"));
    drafter.typed_and("10", Key::Tab);
    drafter.typed("90");
    drafter.click(drafter.part("Point A of draft"));
    drafter.click(drafter.place(0.15, 0.1));
    drafter.key(Key::Escape);
    drafter.click(drafter.part("Point A of draft"));
    drafter.enter("x", "3");
    let away = |name: &str, x: f64, y: f64| (drafter.point(name) - Vec2::new(x, y)).norm();
    assert!(away("B", 0.03, 0.1) < 1e-12, "{}", drafter.point("B"));
    assert!(away("C", 0.18, 0.1) < 1e-12, "{}", drafter.point("C"));
}

#[test]
fn darts_and_notches_are_put_at_a_typed_distance_from_the_nearer_corner() {
    let mut drafter = drawing();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.key(Key::N);
    for (x, distance) in [(0.02, "5"), (0.18, "=4cm + 3cm")] {
        drafter.hover(drafter.place(x, 0.3));
        drafter.typed(distance);
    }
    drafter.key(Key::D);
    drafter.hover(drafter.place(0.03, 0.0));
    drafter.typed("8");
    drafter.typed("2");
    drafter.typed("10");
    let pattern = drafter.pattern();
    let evaluation = drafter.evaluation();
    let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
    let mut places: Vec<Vec2> = stage.notches.iter().map(|notch| notch.point).collect();
    places.extend(stage.darts.iter().map(|dart| dart.apex));
    let wanted = [[0.05, 0.3], [0.13, 0.3], [0.08, 0.1]].map(Vec2::from);
    assert_eq!(places.len(), 3, "{}", drafter.status());
    for (place, wanted) in places.iter().zip(wanted) {
        assert!((place - wanted).norm() < 1e-12, "{place} is not {wanted}");
    }
    // Farther than the edge is long.
    drafter.key(Key::N);
    drafter.hover(drafter.place(0.02, 0.3));
    drafter.typed("25");
    let words = drafter.status();
    assert!(words.contains("does not reach so far"), "{words}");
    assert_eq!(drafter.pattern().panels[0].notches.len(), 2);
}

#[test]
fn a_distance_is_refused_where_there_is_no_edge() {
    let mut drafter = drawing();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.key(Key::I);
    drafter.click(drafter.part("Panel draft"));
    drafter.click(drafter.place(0.05, 0.1));
    drafter.click(drafter.place(0.15, 0.1));
    drafter.key(Key::Enter);
    drafter.key(Key::N);
    drafter.hover(drafter.place(0.08, 0.1));
    drafter.typed("2");
    let words = drafter.status();
    assert!(
        words.contains("a distance is measured along an edge"),
        "{words}"
    );
    assert!(drafter.pattern().panels[0].notches.is_empty());
    // Where there is one, what is typed is taken.
    drafter.hover(drafter.place(0.08, 0.0));
    drafter.key(Key::Enter);
    assert_eq!(drafter.pattern().panels[0].notches.len(), 1);
}

/// Words on the canvas.
fn told(drafter: &Drafter) -> String {
    let marks = drafter.window.state().view().overlay(&drafter.evaluation());
    let words = marks.into_iter().filter_map(|mark| match mark {
        Overlay::Words(_, _, words) => Some(words),
        _ => None,
    });
    words.collect::<Vec<_>>().join(" | ")
}

#[test]
fn the_distance_from_the_nearer_end_is_told_where_a_notch_would_lie() {
    let mut drafter = drawing();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.key(Key::D);
    drafter.hover(drafter.place(0.03, 0.0));
    drafter.typed("8");
    drafter.typed("2");
    drafter.typed("10");
    drafter.key(Key::N);
    // On whole millimetres, along the edge without the mouth of its dart, from 7 to 9 cm.
    for (x, wanted) in [
        (0.0502, "5 cm"),
        (0.16, "4 cm"),
        (0.12, "8 cm"),
        (0.109, "9 cm"),
    ] {
        drafter.hover(drafter.place(x, 0.0));
        assert_eq!(told(&drafter), wanted, "at {x}");
    }
    drafter.hover(drafter.place(0.05, 0.3));
    assert_eq!(told(&drafter), "5 cm");
    // A click puts it there.
    drafter.hover(drafter.place(0.16, 0.0));
    drafter.click(drafter.place(0.16, 0.0));
    let notch = |drafter: &Drafter| {
        let pattern = drafter.pattern();
        let evaluation = drafter.evaluation();
        let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
        stage.notches.last().unwrap().point
    };
    let at = notch(&drafter);
    assert!((at - Vec2::new(0.16, 0.0)).norm() < 1e-9, "{at}");
    // What is typed is told in its place.
    drafter.hover(drafter.place(0.14, 0.0));
    drafter.type_text("3");
    assert_eq!(told(&drafter), "distance 3|");
    drafter.key(Key::Escape);
    // Inside there is no edge.
    drafter.hover(drafter.place(0.1, 0.25));
    assert_eq!(told(&drafter), "");
}

#[test]
fn a_point_is_named_as_it_is_drawn() {
    let mut drafter = drawing();
    drafter.hover(drafter.place(0.1, 0.2));
    drafter.key(Key::P);
    drafter.typed_and("5", Key::Tab);
    drafter.typed_and("7", Key::Tab);
    drafter.typed("tip");
    let steps = drafter.window.state().session().past().len();
    assert_eq!(drafter.point("tip"), Vec2::new(0.05, 0.07));
    // A name that another point has is refused, with the point.
    drafter.typed_and("1", Key::Tab);
    drafter.typed_and("2", Key::Tab);
    drafter.typed("tip");
    let words = drafter.status();
    assert!(words.contains("is taken"), "{words}");
    drafter.key(Key::Escape);
    assert_eq!(drafter.pattern().sheets[0].points.len(), 1);
    assert_eq!(drafter.window.state().session().past().len(), steps);
}

impl Drafter {
    /// Characters that all come within one frame, as they do while a slow frame is drawn.
    fn type_within_a_frame(&mut self, text: &str) {
        let typed = text.chars().map(|c| egui::Event::Text(c.to_string()));
        self.window.input_mut().events.extend(typed);
        self.window.run();
    }
}

#[test]
fn nothing_is_lost_of_what_is_typed_within_one_frame() {
    let mut drafter = drawing();
    drafter.key(Key::P);
    for (text, key) in [
        ("=max(12cm, 3cm)", Key::Tab),
        ("=7cm", Key::Tab),
        ("hip", Key::Enter),
    ] {
        drafter.type_within_a_frame(text);
        drafter.key(key);
    }
    let hip = drafter.point("hip");
    assert!((hip - Vec2::new(0.12, 0.07)).norm() < 1e-12, "{hip}");
    // A dialog's name is typed as it opens: nothing of it is left, nothing is lost.
    let mut drafter = Drafter::new();
    drafter.window.input_mut().events.push(egui::Event::Key {
        key: Key::N,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: Modifiers::COMMAND,
    });
    drafter.window.step();
    drafter.type_within_a_frame("Cape");
    drafter.key(Key::Enter);
    assert_eq!(drafter.pattern().name, "Cape");
    // Neither is what goes on after the focus has moved: a row of numbers, sizes, the next name.
    drafter.key(Key::F8);
    drafter.press("Add size");
    drafter.press("Add size");
    drafter.enter("New measurement", "waist");
    let key = |key| egui::Event::Key {
        key,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    let text = |text: &str| egui::Event::Text(text.to_owned());
    let row = [
        text("84"),
        key(Key::Tab),
        text("9"),
        text("2"),
        key(Key::Enter),
    ];
    drafter.window.input_mut().events.extend(row);
    drafter.window.run();
    let sizes = drafter.pattern().sizes;
    let waists: Vec<_> = sizes
        .iter()
        .map(|size| size.measurements.get("waist"))
        .collect();
    assert_eq!(waists, [Some(0.84), Some(0.92)]);
}
