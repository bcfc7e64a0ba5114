//! What once took several actions while a pattern was drafted in the window, and takes one now.

use crate::drafter::Drafter;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use toile_geometry::Vec2;
use toile_pattern::LineKind;
use toile_ui::Overlay;

fn drawing() -> Drafter {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Cuts");
    drafter
}

/// The lowest line says that some panels are on show, and Escape shows all again.
#[test]
fn panels_that_are_hidden_are_told_and_come_back() {
    let mut drafter = drawing();
    for from in [0.0, 0.1] {
        drafter.key(Key::R);
        drafter.click(drafter.place(from, 0.0));
        drafter.click(drafter.place(from + 0.06, 0.2));
    }
    drafter.key(Key::Escape);
    drafter.click(drafter.part("Panel draft"));
    drafter.key(Key::Period);
    let is_told = |drafter: &Drafter| {
        let told = drafter.window.query_by_label("1 panel shown: show all");
        told.is_some()
    };
    assert!(is_told(&drafter));
    assert!(drafter.window.query_by_label("Panel draft 2").is_none());
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    assert!(!is_told(&drafter));
    assert!(drafter.window.query_by_label("Panel draft 2").is_some());
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
    assert!(words.contains("it is measured along an edge"), "{words}");
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
    drafter.key(Key::Escape);
    drafter.tick("True the edge");
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
    assert_eq!(told(&drafter), "distance 3|\nname ");
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
    // What was typed goes back, then the tool is put down.
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    assert_eq!(drafter.pattern().sheets[0].points.len(), 1);
    assert_eq!(drafter.window.state().session().past().len(), steps);
}

impl Drafter {
    /// Characters that all come within one frame, as they do while a slow frame is drawn.
    fn type_within_a_frame(&mut self, text: &str) {
        let typed = text.chars().flat_map(|c| {
            let key = Key::from_name(&c.to_uppercase().to_string());
            let event = |pressed| {
                key.map(|key| egui::Event::Key {
                    key,
                    physical_key: None,
                    pressed,
                    repeat: false,
                    modifiers: Modifiers::NONE,
                })
            };
            let text = egui::Event::Text(c.to_string());
            let released = event(false);
            event(true).into_iter().chain([text]).chain(released)
        });
        let typed: Vec<egui::Event> = typed.collect();
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
    // Letters of a name are no commands, even when they come with its sign.
    drafter.key(Key::L);
    drafter.click(drafter.place(0.03, 0.02));
    drafter.hover(drafter.place(0.05, 0.05));
    drafter.type_within_a_frame("'ginger");
    drafter.key(Key::Enter);
    let curves = &drafter.pattern().sheets[0].curves;
    assert_eq!(curves.len(), 1, "{}", drafter.status());
    assert_eq!(curves[0].name, "ginger");
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

/// A name that is typed before there are places enough is kept, and the numbers typed next are numbers.
#[test]
fn a_name_typed_before_the_second_place_is_kept() {
    let mut drafter = drawing();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.key(Key::I);
    drafter.click(drafter.part("Panel draft"));
    drafter.click(drafter.place(0.02, 0.1));
    drafter.typed("'pocket place");
    assert_eq!(drafter.window.state().fault(), None);
    drafter.typed_and("16", Key::Tab);
    drafter.typed("0");
    drafter.key(Key::Enter);
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    let pattern = drafter.pattern();
    let panel = &pattern.panels[0];
    assert_eq!(panel.lines.len(), 2, "{}", drafter.status());
    assert_eq!(panel.lines[1].name, "pocket place");
    let stage = drafter.evaluation();
    let stage = stage.last_stage(panel).unwrap();
    let line = stage
        .lines
        .iter()
        .find(|line| line.kind == LineKind::Internal)
        .unwrap();
    let length: f64 = line.edges.iter().map(|edge| edge.curve.length()).sum();
    assert!((length - 0.16).abs() < 1e-9, "{length}");

    // A curve and open lines in the same way, and a name before any place.
    for (key, name) in [(Key::C, "curve"), (Key::L, "roof")] {
        let modifiers = match key {
            Key::L => Modifiers::SHIFT,
            _ => Modifiers::NONE,
        };
        drafter.chord(modifiers, key);
        if key == Key::L {
            drafter.typed(&format!("'{name}"));
        }
        drafter.click(drafter.place(0.22, 0.1));
        if key == Key::C {
            drafter.typed(&format!("'{name}"));
        }
        drafter.typed_and("5", Key::Tab);
        drafter.typed("80");
        drafter.key(Key::Enter);
        drafter.key(Key::Escape);
        drafter.key(Key::Escape);
        let pattern = drafter.pattern();
        let mut curves = pattern.sheets.iter().flat_map(|sheet| &sheet.curves);
        let is_named = curves.any(|curve| curve.name.starts_with(name));
        assert!(is_named, "{name}: {}", drafter.status());
    }
    // Without a name, and once it is there, places are asked for as ever.
    drafter.key(Key::C);
    drafter.click(drafter.place(0.25, 0.1));
    drafter.key(Key::Enter);
    let fault = drafter.window.state().fault().map(str::to_owned);
    assert!(fault.unwrap().contains("at least two places"));
}

/// What was refused is told until the tool gets on; then what to do next is.
#[test]
fn a_refusal_is_gone_once_the_tool_gets_on() {
    let mut drafter = drawing();
    for from in [0.0, 0.1] {
        drafter.key(Key::R);
        drafter.click(drafter.place(from, 0.0));
        drafter.click(drafter.place(from + 0.08, 0.2));
    }
    drafter.key(Key::S);
    drafter.click(drafter.place(0.04, 0.1));
    let refused = "there is no edge of a panel here";
    assert_eq!(
        drafter.window.state().fault().unwrap().find(refused),
        Some(0)
    );
    // Pointing elsewhere and typing are no steps.
    drafter.hover(drafter.place(0.05, 0.12));
    assert!(drafter.status().contains(refused));
    drafter.click(drafter.part("Edge right of draft"));
    let words = drafter.status();
    assert!(!words.contains(refused), "{words}");
    assert!(words.contains("Click the edge it is sewn to"), "{words}");
    // Shift-clicks and steps back get on too.
    drafter.click(drafter.place(0.04, 0.1));
    assert!(drafter.status().contains(refused));
    drafter.key(Key::Escape);
    let words = drafter.status();
    assert!(words.contains("Click the edge to sew"), "{words}");
    drafter.click(drafter.place(0.04, 0.1));
    drafter.shift_click(drafter.part("Edge right of draft"));
    assert!(!drafter.status().contains(refused));

    // So it is with a seam that is walked.
    drafter.key(Key::S);
    drafter.click(drafter.part("Edge right of draft"));
    drafter.click(drafter.part("Edge left 2 of draft 2"));
    drafter.key(Key::W);
    drafter.typed("999");
    assert!(drafter.status().contains("type a distance from 0"));
    drafter.key(Key::Escape);
    drafter.typed("5");
    let words = drafter.status();
    assert!(!words.contains("type a distance from 0"), "{words}");

    drafter.key(Key::I);
    drafter.click(drafter.place(0.09, 0.25));
    assert!(drafter.status().contains("there is no panel here"));
    drafter.click(drafter.part("Panel draft"));
    drafter.key(Key::Enter);
    assert!(drafter.status().contains("at least two places"));
    drafter.click(drafter.place(0.02, 0.1));
    assert_eq!(drafter.window.state().fault(), None);
}

/// A pocket is not sewn to the line that marks its place: that is said, and what to do.
#[test]
fn a_line_inside_a_panel_is_refused_by_name_where_edges_are_sewn() {
    let mut drafter = drawing();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.key(Key::I);
    drafter.click(drafter.part("Panel draft"));
    drafter.click(drafter.place(0.05, 0.1));
    drafter.type_text("'pocket place");
    drafter.click(drafter.place(0.15, 0.1));
    drafter.key(Key::Enter);
    let on_line = drafter.place(0.08, 0.1);
    drafter.key(Key::S);
    drafter.click(on_line);
    let words = drafter.window.state().fault().unwrap().to_owned();
    for part in [
        "Line pocket place of draft lies inside the panel",
        "only edges of outlines and holes are sewn",
        "by hand",
    ] {
        assert!(words.contains(part), "{words}");
    }
    // Other tools that take edges say what they take.
    drafter.chord(Modifiers::SHIFT, Key::F);
    drafter.click(on_line);
    let words = drafter.window.state().fault().unwrap().to_owned();
    assert!(
        words.contains("Line pocket place of draft lies inside"),
        "{words}"
    );
    assert!(!words.contains("sewn"), "{words}");
}
