//! What is typed goes where it is meant to: to the slot that is asked for, to what was made last, to the
//! filled button of a dialog; and what is dragged lands on round numbers.

use crate::drafter::Drafter;
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable;
use toile_geometry::Vec2;
use toile_pattern::{CurveRule, Number, PointRule};

/// An empty pattern.
fn begun() -> Drafter {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Typed");
    drafter
}

/// The same with a rectangle of 20 by 30 cm.
fn with_rectangle() -> Drafter {
    let mut drafter = begun();
    drafter.key(Key::R);
    drafter.typed_and("0", Key::Tab);
    drafter.typed("0");
    drafter.typed_and("20", Key::Tab);
    drafter.typed("30");
    drafter.key(Key::Home);
    drafter
}

fn near(at: Vec2, wanted: [f64; 2]) {
    assert!((at - Vec2::from(wanted)).norm() < 1e-9, "{at} {wanted:?}");
}

#[test]
fn a_typed_distance_divides_the_edge_there() {
    let mut drafter = with_rectangle();
    drafter.key(Key::B);
    let top = drafter.part("Edge top of draft");
    drafter.hover(top);
    drafter.typed("7.3");
    let pattern = drafter.pattern();
    let made = pattern.sheets[0].points.last().unwrap();
    let at = drafter.evaluation().point(made.id).unwrap();
    assert!(
        (at.x - 0.073).abs() < 1e-9 || (at.x - 0.127).abs() < 1e-9,
        "{at}"
    );
    assert!((at.y - 0.3).abs() < 1e-12, "{at}");
    // What was typed is what the point is placed by.
    assert!(matches!(made.rule, PointRule::AlongCurve { .. }));
    // One that is too long is refused, and stays to be mended.
    let hover = drafter.part("Edge right of draft");
    drafter.hover(hover);
    drafter.typed("31");
    let fault = drafter.window.state().fault().unwrap().to_owned();
    assert!(fault.starts_with("distance: "), "{fault}");
    assert!(drafter.window.state().view().is_typing());
    drafter.key(Key::Backspace);
    drafter.key(Key::Enter);
    assert_eq!(drafter.pattern().panels[0].edges().count(), 6);
}

#[test]
fn handles_that_are_typed_after_a_curve_are_those_of_the_curve() {
    let mut drafter = begun();
    drafter.key(Key::C);
    for place in [["0", "0"], ["20", "0"]] {
        drafter.typed_and(place[0], Key::Tab);
        drafter.typed(place[1]);
    }
    drafter.key(Key::Enter);
    assert_eq!(
        drafter.pattern().sheets[0].curves.len(),
        1,
        "{}",
        drafter.status()
    );
    for number in ["5", "=2cm + 1", "-4"] {
        drafter.typed_and(number, Key::Tab);
    }
    drafter.typed("6");
    let pattern = drafter.pattern();
    let curve = &pattern.sheets[0].curves[0];
    let CurveRule::Spline { handles, .. } = &curve.rule else {
        panic!("{curve:?}");
    };
    let evaluation = drafter.evaluation();
    let [first, last] = handles.map(|handle| evaluation.point(handle).unwrap());
    near(first, [0.05, 0.03]);
    near(last, [0.16, 0.06]);
    // Its name too, until another is begun.
    drafter.typed("'armhole");
    assert_eq!(drafter.pattern().sheets[0].curves[0].name, "armhole");
    // The numbers of the next are its own.
    drafter.typed_and("1", Key::Tab);
    drafter.typed("2");
    drafter.typed_and("#9", Key::Tab);
    drafter.typed("8");
    drafter.key(Key::Enter);
    let pattern = drafter.pattern();
    assert_eq!(pattern.sheets[0].curves.len(), 2, "{}", drafter.status());
    let ends = pattern.sheets[0].curves[1].ends;
    let evaluation = drafter.evaluation();
    near(evaluation.point(ends[0]).unwrap(), [0.01, 0.02]);
    near(evaluation.point(ends[1]).unwrap(), [0.09, 0.08]);
}

#[test]
fn after_the_first_corner_places_are_typed_in_three_ways() {
    for tool in [Key::L, Key::C] {
        for modifiers in [Modifiers::NONE, Modifiers::SHIFT] {
            if (tool, modifiers) == (Key::C, Modifiers::SHIFT) {
                continue;
            }
            let mut drafter = begun();
            drafter.chord(modifiers, tool);
            drafter.typed_and("1", Key::Tab);
            drafter.typed("2");
            drafter.typed_and("10", Key::Tab);
            drafter.typed("90");
            drafter.typed_and("@3", Key::Tab);
            drafter.typed("=1cm + 3");
            drafter.typed_and("#20", Key::Tab);
            drafter.typed("-5");
            // As other programs write a length and an angle.
            drafter.typed("5<-90");
            drafter.key(Key::Enter);
            let pattern = drafter.pattern();
            let evaluation = drafter.evaluation();
            for wanted in [[0.01, 0.12], [0.04, 0.16], [0.2, -0.05], [0.2, -0.1]] {
                let points = pattern.sheets[0].points.iter();
                let is_there = points
                    .filter_map(|point| evaluation.point(point.id))
                    .any(|at| (at - Vec2::from(wanted)).norm() < 1e-9);
                assert!(is_there, "{tool:?} {wanted:?} {}", drafter.status());
            }
        }
    }
}

#[test]
fn the_field_at_fault_is_named_and_keeps_what_is_typed() {
    let mut drafter = begun();
    drafter.key(Key::L);
    drafter.typed_and("0", Key::Tab);
    drafter.typed("0");
    drafter.typed_and("12", Key::Tab);
    drafter.typed("=30cm");
    let fault = drafter.window.state().fault().unwrap().to_owned();
    assert!(fault.starts_with("angle: "), "{fault}");
    drafter.key(Key::Backspace);
    drafter.key(Key::Backspace);
    drafter.typed("deg");
    let pattern = drafter.pattern();
    assert_eq!(pattern.sheets[0].curves.len(), 1, "{}", drafter.status());
    let end = drafter.point("B");
    near(end, [0.12 * 30_f64.to_radians().cos(), 0.06]);
    // Of another sort of numbers what is typed already stands in the way.
    drafter.type_text("5");
    drafter.type_text("@");
    let fault = drafter.window.state().fault().unwrap().to_owned();
    assert!(fault.starts_with("length 5 is typed"), "{fault}");
}

#[test]
fn lengths_are_typed_with_functions_and_pi() {
    let mut drafter = begun();
    drafter.key(Key::P);
    drafter.typed_and("40*cos(30deg)", Key::Tab);
    drafter.typed("=10*pi");
    near(
        drafter.point("A"),
        [0.4 * 30_f64.to_radians().cos(), 0.1 * std::f64::consts::PI],
    );
}

#[test]
fn arcs_are_drawn_by_centre_radius_and_angle() {
    let mut drafter = begun();
    drafter.chord(Modifiers::SHIFT, Key::O);
    drafter.typed_and("1", Key::Tab);
    drafter.typed("2");
    drafter.typed_and("=20/(2*pi)", Key::Tab);
    drafter.typed("30");
    drafter.typed("90");
    let pattern = drafter.pattern();
    let curve = pattern.sheets[0].curves.last().unwrap();
    let evaluation = drafter.evaluation();
    let path = evaluation.curve(curve.id).unwrap();
    // A quarter of a circle of that girth.
    assert!((path.length() - 0.05).abs() < 1e-12, "{}", path.length());
    let radius = 0.2 / std::f64::consts::TAU;
    let start = evaluation.point(curve.ends[0]).unwrap();
    let angle = 30_f64.to_radians();
    near(
        start,
        [0.01 + radius * angle.cos(), 0.02 + radius * angle.sin()],
    );
    // Shown by its angle and radius, and set by them.
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    assert!(drafter.window.query_by_label("bulge").is_none());
    drafter.enter("angle", "60");
    let length = |drafter: &Drafter| {
        let pattern = drafter.pattern();
        let curve = pattern.sheets[0].curves.last().unwrap();
        drafter.evaluation().curve(curve.id).unwrap().length()
    };
    let chord = radius * 2_f64.sqrt();
    let wanted = 60_f64.to_radians() * chord;
    assert!((length(&drafter) - wanted).abs() < 1e-12);
    drafter.enter("radius", "=5cm");
    let wanted = 2.0 * 0.05 * (chord / 0.1).asin();
    assert!((length(&drafter) - wanted).abs() < 1e-12);
}

#[test]
fn an_arc_goes_on_smoothly_from_a_line_an_arc_and_a_curve() {
    let mut drafter = begun();
    drafter.key(Key::L);
    drafter.typed_and("0", Key::Tab);
    drafter.typed("0");
    drafter.typed_and("10", Key::Tab);
    drafter.typed("0");
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.key(Key::Home);
    // From the end of the line with a radius and an angle.
    drafter.chord(Modifiers::SHIFT, Key::T);
    drafter.click(drafter.place(0.08, 0.0));
    drafter.typed_and("5", Key::Tab);
    drafter.typed("90");
    near(drafter.point("C"), [0.15, 0.05]);
    drafter.key(Key::Home);
    // From the end of the arc to a place.
    drafter.click(drafter.place(0.1495, 0.043));
    drafter.typed_and("#5", Key::Tab);
    drafter.typed("15");
    let pattern = drafter.pattern();
    assert_eq!(pattern.sheets[0].curves.len(), 3, "{}", drafter.status());
    let evaluation = drafter.evaluation();
    let paths: Vec<_> = pattern.sheets[0]
        .curves
        .iter()
        .map(|curve| evaluation.curve(curve.id).unwrap())
        .collect();
    // Centre and start lie level: it turns back about the middle of the chord's bisector.
    let direction = |path: &toile_geometry::Path, along: f64| {
        let at = |along: f64| path.point(path.at_length(along).unwrap());
        let way = at(along + 1e-7) - at(along);
        way.y.atan2(way.x)
    };
    for pair in paths.windows(2) {
        let end = direction(pair[0], pair[0].length() - 1e-7);
        let start = direction(pair[1], 0.0);
        let kink = (end - start + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU)
            - std::f64::consts::PI;
        assert!(kink.abs() < 1e-4, "{kink}");
    }
    // And stays so when the line is turned.
    let b = pattern.sheets[0].point_named("B").unwrap();
    assert!(matches!(b.rule, PointRule::Polar { .. }));
}

#[test]
fn an_arc_through_points_leads_through_them_whatever_moves() {
    let mut drafter = begun();
    drafter.key(Key::P);
    for [x, y] in [["0", "0"], ["20", "0"], ["9", "4"]] {
        drafter.typed_and(x, Key::Tab);
        drafter.typed(y);
    }
    drafter.key(Key::Home);
    drafter.key(Key::A);
    for name in ["A", "B", "C"] {
        drafter.click(drafter.part(&format!("Point {name} of draft")));
    }
    let away = |drafter: &Drafter| {
        let pattern = drafter.pattern();
        let curve = &pattern.sheets[0].curves[0];
        let evaluation = drafter.evaluation();
        let path = evaluation.curve(curve.id).unwrap();
        let by = drafter.point("C");
        (path.point(path.nearest(by).unwrap()) - by).norm()
    };
    assert!(away(&drafter) < 1e-9);
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.click(drafter.part("Point C of draft"));
    drafter.enter("y", "7");
    near(drafter.point("C"), [0.09, 0.07]);
    assert!(away(&drafter) < 1e-9, "{}", away(&drafter));
}

#[test]
fn letters_and_digits_change_no_view_while_a_tool_is_in_hand() {
    let mut drafter = with_rectangle();
    drafter.key(Key::Escape);
    let camera = |drafter: &Drafter| drafter.window.state().view().camera;
    let fitted = camera(&drafter);
    drafter.key(Key::Plus);
    let near = camera(&drafter);
    assert_ne!(near, fitted);
    drafter.key(Key::B);
    for (modifiers, key) in [
        (Modifiers::NONE, Key::F),
        (Modifiers::NONE, Key::Num0),
        (Modifiers::SHIFT, Key::R),
        (Modifiers::SHIFT, Key::G),
        (Modifiers::SHIFT, Key::A),
        (Modifiers::NONE, Key::Period),
    ] {
        drafter.chord(modifiers, key);
        assert_eq!(camera(&drafter), near, "{key:?}");
    }
    assert!(drafter.window.state().view().rulers);
    assert!(drafter.window.state().view().allowances);
    drafter.key(Key::F);
    let words = drafter.window.state().fault().unwrap().to_owned();
    assert!(words.starts_with("Fit: "), "{words}");
    // Home always.
    drafter.key(Key::Home);
    assert_ne!(camera(&drafter), near);
    drafter.key(Key::Escape);
    drafter.key(Key::Plus);
    drafter.key(Key::F);
    assert_eq!(camera(&drafter).scale, fitted.scale);
}

#[test]
fn enter_presses_the_filled_button_of_a_dialog_and_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("one.toile.json");
    let mut drafter = with_rectangle();
    drafter.chord(Modifiers::COMMAND, Key::S);
    drafter.enter("File", &file.display().to_string());
    assert!(file.exists(), "{}", drafter.status());
    let saved = std::fs::read(&file).unwrap();
    // Changes that would be lost are saved.
    drafter.key(Key::Escape);
    drafter.click(drafter.part("Edge top of draft"));
    drafter.enter("seam allowance", "3");
    drafter.chord(Modifiers::COMMAND, Key::N);
    assert!(drafter.window.query_by_label("Save the changes?").is_some());
    drafter.key(Key::Enter);
    assert_ne!(std::fs::read(&file).unwrap(), saved);
    assert!(!drafter.window.state().is_unsaved());
    drafter.key(Key::Escape);
    // A file that is there is not replaced.
    let other = folder.path().join("two.toile.json");
    std::fs::write(&other, "kept").unwrap();
    drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    drafter.enter("File", &other.display().to_string());
    assert!(drafter.window.query_by_label("Replace the file?").is_some());
    drafter.key(Key::Enter);
    assert_eq!(std::fs::read(&other).unwrap(), b"kept");
    assert!(drafter.window.query_by_label("Save the pattern").is_some());
    // A button that has the keys takes Enter itself.
    drafter.key(Key::Escape);
    drafter.chord(Modifiers::COMMAND, Key::N);
    let cancel = drafter.window.get_by_role_and_label(Role::Button, "Cancel");
    cancel.focus();
    drafter.window.run();
    drafter.key(Key::Enter);
    assert!(drafter.window.query_by_label("New pattern").is_none());
    assert_eq!(drafter.pattern().name, "Typed");
}

#[test]
fn what_is_dragged_lands_on_round_numbers_unless_ctrl_is_held() {
    let mut drafter = with_rectangle();
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    let step = |value: f64| (value / 1e-4 - (value / 1e-4).round()).abs();
    for (name, by) in [("C", [37.3, -21.7]), ("A", [-13.4, 11.9])] {
        drafter.click(drafter.part("Panel draft"));
        let from = drafter.part(&format!("Point {name} of draft"));
        drafter.drag(from, from + egui::vec2(by[0], by[1]));
        let at = drafter.point(name);
        let rule = &drafter.pattern().sheets[0]
            .point_named(name)
            .unwrap()
            .rule
            .clone();
        let numbers: Vec<f64> = toile_pattern::fields::numbers(rule)
            .into_iter()
            .filter_map(Number::value)
            .collect();
        assert_eq!(numbers.len(), 2, "{rule:?}");
        assert!(numbers.iter().all(|n| step(*n) < 1e-6), "{numbers:?} {at}");
    }
    let from = drafter.part("Point C of draft");
    let before = drafter.point("C");
    let held = egui::Event::ModifiersChanged;
    drafter.window.event(held(Modifiers::COMMAND));
    drafter.drag(from, from + egui::vec2(17.3, 9.1));
    drafter.window.event(held(Modifiers::NONE));
    let moved = drafter.point("C") - before;
    let scale = drafter.window.state().view().camera.scale;
    assert!(
        (moved.x - 17.3 / scale).abs() < 2e-7 * 1e3 / scale.max(1.0) + 1e-6,
        "{moved}"
    );
    assert!(step(drafter.point("C").x) > 1e-6 || step(drafter.point("C").y) > 1e-6);
}

#[test]
fn a_quarter_circle_skirt_from_a_waist_by_formula() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Quarter skirt");
    drafter.key(Key::F8);
    drafter.press("Add size");
    drafter.enter("Waist girth", "72");
    drafter.key(Key::F8);
    drafter.chord(Modifiers::SHIFT, Key::C);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.typed("=waist/(pi/2)");
    drafter.typed("60");
    drafter.typed("90");
    assert!(drafter.actions <= 14, "{}", drafter.actions);
    let pattern = drafter.pattern();
    assert_eq!(pattern.panels.len(), 1, "{}", drafter.status());
    let evaluation = drafter.evaluation();
    let lengths: Vec<(String, f64)> = pattern.panels[0]
        .edges()
        .map(|edge| {
            (
                edge.name.clone(),
                evaluation.edge(edge.id).unwrap().length(),
            )
        })
        .collect();
    let length = |name: &str| lengths.iter().find(|known| known.0 == name).unwrap().1;
    let quarter = std::f64::consts::FRAC_PI_2;
    assert!((length("inner") - 0.72).abs() < 1e-9, "{lengths:?}");
    assert!(
        (length("outer") - (0.72 + 0.6 * quarter)).abs() < 1e-9,
        "{lengths:?}"
    );
    for side in ["start", "end"] {
        assert!((length(side) - 0.6).abs() < 1e-9, "{lengths:?}");
    }
    assert!(drafter.window.query_by_label("No faults").is_some());
    println!("{} actions", drafter.actions);
}

#[test]
fn circles_and_rings_are_panels() {
    for (inner, angle, area) in [
        ("0", "360", 0.01 * std::f64::consts::PI),
        ("5", "360", 0.0200 * std::f64::consts::PI),
        ("0", "180", 0.005 * std::f64::consts::PI),
        ("0", "=pi/2", 0.0025 * std::f64::consts::PI),
    ] {
        let mut drafter = begun();
        drafter.chord(Modifiers::SHIFT, Key::C);
        drafter.typed_and("0", Key::Tab);
        drafter.typed("0");
        drafter.typed(inner);
        drafter.typed("10");
        drafter.typed(angle);
        let pattern = drafter.pattern();
        assert_eq!(pattern.panels.len(), 1, "{}", drafter.status());
        let evaluation = drafter.evaluation();
        let mut enclosed = 0.0;
        for edge in pattern.panels[0].edges() {
            let path = evaluation.edge(edge.id).unwrap();
            let count = 2000;
            let places: Vec<Vec2> = (0..=count)
                .map(|k| path.length() * f64::from(k) / f64::from(count))
                .map(|along| path.point(path.at_length(along).unwrap()))
                .collect();
            enclosed += places
                .windows(2)
                .map(|p| 0.5 * p[0].perp(&p[1]))
                .sum::<f64>();
        }
        assert!(
            (enclosed - area).abs() < 1e-6,
            "{inner} {angle}: {enclosed} {area}"
        );
        drafter.typed("'flounce");
        assert_eq!(drafter.pattern().panels[0].name, "flounce");
    }
}
