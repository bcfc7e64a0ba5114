//! Sheets in the window, and what becomes of what is placed on them: handles that turn along, formulas
//! of what is dragged.

use crate::drafter::Drafter;
use egui::{Key, Modifiers, Rect, Role, vec2};
use egui_kittest::kittest::Queryable;
use toile_geometry::Vec2;
use toile_pattern::{CurveRule, Number, PointRule};
use toile_ui::Beginning;

impl Drafter {
    fn begin(&mut self) {
        self.press("New pattern");
        self.enter("Name", "Sheets");
    }

    fn draw_rectangle(&mut self) {
        self.key(Key::R);
        self.click(self.place(0.0, 0.0));
        self.click(self.place(0.1, 0.1));
        self.key(Key::Escape);
        self.key(Key::Escape);
    }
}

#[test]
fn the_next_piece_is_drawn_on_a_sheet_of_its_own() {
    let mut drafter = Drafter::new();
    drafter.begin();
    drafter.draw_rectangle();
    assert_eq!(drafter.pattern().sheets.len(), 1);
    drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::N);
    let pattern = drafter.pattern();
    assert_eq!(pattern.sheets.len(), 2, "{}", drafter.status());
    // It stands selected beside what is there, and is renamed as anything is.
    let [first, second] = [&pattern.sheets[0], &pattern.sheets[1]];
    assert!(
        second.on_table[0] > first.on_table[0] + 0.1,
        "{:?}",
        second.on_table
    );
    drafter.enter("Name", "sleeve");
    assert_eq!(drafter.pattern().sheets[1].name, "sleeve");
    // It is drawn on, with names of its own: both pieces have a corner A.
    drafter.draw_rectangle();
    let pattern = drafter.pattern();
    assert_eq!(pattern.panels.len(), 2, "{}", drafter.status());
    assert!(
        pattern
            .sheets
            .iter()
            .all(|sheet| sheet.point_named("A").is_some())
    );
    assert_eq!(pattern.panels[1].sheet(), Some(pattern.sheets[1].id));
    // The sheet is moved by its tag, with its panel.
    drafter.key(Key::Escape);
    drafter
        .window
        .get_by_role_and_label(Role::Button, "Point A of sleeve");
    drafter.click(drafter.part("Panel draft"));
    drafter.click(drafter.part("Point A of sleeve"));
    let tag = drafter.part("Sheet sleeve") + vec2(20.0, -14.0);
    let panel = drafter.part("Panel sleeve");
    let before = drafter.pattern().sheets[1].on_table;
    drafter.drag(tag, tag + vec2(30.0, 40.0));
    let after = drafter.pattern().sheets[1].on_table;
    assert!(
        after[0] > before[0] && after[1] < before[1],
        "{before:?} {after:?}"
    );
    let moved = drafter.part("Panel sleeve") - panel;
    assert!((moved - vec2(30.0, 40.0)).length() < 1.0, "{moved:?}");
    // It goes with its panel.
    drafter.key(Key::Delete);
    let pattern = drafter.pattern();
    assert_eq!(
        (pattern.sheets.len(), pattern.panels.len()),
        (1, 1),
        "{}",
        drafter.status()
    );
    drafter.chord(Modifiers::COMMAND, Key::Z);
    let pattern = drafter.pattern();
    assert_eq!((pattern.sheets.len(), pattern.panels.len()), (2, 2));
}

#[test]
fn a_sheet_of_a_shipped_pattern_is_added_where_it_is_seen_to_be_free() {
    let mut drafter = Drafter::opened("t-shirt");
    let before = drafter.part("Panel sleeve");
    let sheets = drafter.pattern().sheets.len();
    drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::N);
    assert_eq!(
        drafter.pattern().sheets.len(),
        sheets + 1,
        "{}",
        drafter.status()
    );
    // The others lie where they were seen, now by the document too: it is opened again as it is.
    let places: Vec<[f64; 2]> = drafter
        .pattern()
        .sheets
        .iter()
        .map(|s| s.on_table)
        .collect();
    for (k, place) in places.iter().enumerate() {
        assert!(!places[..k].contains(place), "{places:?}");
    }
    drafter.chord(Modifiers::COMMAND, Key::Z);
    drafter.key(Key::Home);
    let after = drafter.part("Panel sleeve");
    assert!((after - before).length() < 1.0, "{before:?} {after:?}");
}

#[test]
fn the_opposite_handle_turns_along_and_ctrl_leaves_it() {
    let mut drafter = Drafter::new();
    drafter.begin();
    drafter.key(Key::C);
    for [x, y] in [[0.0, 0.0], [0.1, 0.05], [0.2, 0.0]] {
        drafter.click(drafter.place(x, y));
    }
    drafter.key(Key::Enter);
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    let pattern = drafter.pattern();
    let CurveRule::Spline { knots, .. } = &pattern.sheets[0].curves[0].rule else {
        panic!("no spline");
    };
    let knot = knots[0];
    let seen = |drafter: &Drafter| {
        let evaluation = drafter.evaluation();
        [knot.before, knot.point, knot.after].map(|id| evaluation.point(id).unwrap())
    };
    let [_, middle, after] = seen(&drafter);
    let length = (seen(&drafter)[0] - middle).norm();
    let from = drafter.place(after.x, after.y);
    let to = Vec2::new(after.x, after.y + 0.03);
    drafter.drag(from, drafter.place(to.x, to.y));
    let [before, middle, after] = seen(&drafter);
    assert!((after - to).norm() < 1e-3, "{after}");
    assert!((after - middle).perp(&(before - middle)).abs() < 1e-9);
    assert!(((before - middle).norm() - length).abs() < 1e-9);
    // With Ctrl one handle alone.
    drafter
        .window
        .event(egui::Event::ModifiersChanged(Modifiers::COMMAND));
    let from = drafter.place(after.x, after.y);
    drafter.drag(from, drafter.place(after.x, after.y + 0.03));
    drafter
        .window
        .event(egui::Event::ModifiersChanged(Modifiers::NONE));
    let [stayed, _, moved] = seen(&drafter);
    assert!((stayed - before).norm() < 1e-9, "{stayed}");
    assert!((moved - after).norm() > 0.02, "{moved}");
}

#[test]
fn the_opposite_handle_turns_along_whatever_becomes_of_formulas() {
    let mut drafter = Drafter::new();
    drafter.begin();
    drafter.key(Key::F8);
    drafter.press("Add size");
    drafter.press("Add size");
    drafter.key(Key::F8);
    drafter.key(Key::C);
    for [x, y] in [[0.0, 0.0], [0.1, 0.05], [0.2, 0.0]] {
        drafter.click(drafter.place(x, y));
    }
    drafter.key(Key::Enter);
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    let pattern = drafter.pattern();
    let CurveRule::Spline { knots, .. } = &pattern.sheets[0].curves[0].rule else {
        panic!("no spline");
    };
    let knot = knots[0];
    let seen = |drafter: &Drafter| {
        let evaluation = drafter.evaluation();
        [knot.before, knot.point, knot.after].map(|id| evaluation.point(id).unwrap())
    };
    let [was, middle, after] = seen(&drafter);
    let length = (was - middle).norm();
    for presses in 0..4 {
        let from = drafter.place(after.x, after.y);
        let to = Vec2::new(after.x, after.y + 0.03);
        let goal = drafter.place(to.x, to.y);
        drafter.begin_drag(from, goal);
        for _ in 0..presses {
            drafter.window.event(egui::Event::Text("=".into()));
            drafter.window.run();
        }
        drafter.window.drop_at(goal);
        drafter.window.run();
        let [before, middle, moved] = seen(&drafter);
        assert!((moved - to).norm() < 1e-3, "{presses}: {moved}");
        let across = (moved - middle).perp(&(before - middle)).abs();
        assert!(across < 1e-9, "{presses}: {across}");
        let longer = (before - middle).norm() - length;
        assert!(longer.abs() < 1e-9, "{presses}: {longer}");
        drafter.chord(Modifiers::COMMAND, Key::Z);
        assert_eq!(seen(&drafter), [was, middle, after], "one step");
    }
}

#[test]
fn a_dragged_formula_is_adjusted_or_what_else_is_chosen() {
    let mut drafter = Drafter::new();
    drafter.begin();
    drafter.key(Key::F8);
    drafter.press("Add size");
    drafter.press("Add size");
    drafter.press("Variables");
    drafter.enter("New variable", "width = 10cm");
    drafter.key(Key::F8);
    drafter.hover(drafter.place(0.1, 0.1));
    drafter.key(Key::P);
    drafter.type_text("=width * 2");
    drafter.key(Key::Tab);
    drafter.typed("5");
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    let number = |drafter: &Drafter| {
        let pattern = drafter.pattern();
        let PointRule::At { x, .. } = &pattern.sheets[0].points[0].rule else {
            panic!("not by coordinates");
        };
        x.clone()
    };
    let was = number(&drafter);
    assert!(matches!(was, Number::Formula(_)), "{was:?}");
    let start = drafter.point("A");
    for (presses, end) in [(0, 0.23), (1, 0.24), (2, 0.25), (3, 0.26)] {
        let from = drafter.place(start.x, start.y);
        let to = drafter.place(end, start.y);
        drafter.begin_drag(from, to);
        for _ in 0..presses {
            drafter.window.event(egui::Event::Text("=".into()));
            drafter.window.run();
        }
        drafter.window.drop_at(to);
        drafter.window.run();
        let at = drafter.point("A");
        assert!((at.x - end).abs() < 1.5e-3, "{presses}: {at}");
        let now = number(&drafter);
        let pattern = drafter.pattern();
        match presses {
            0 => assert!(matches!(now, Number::Adjusted { .. }), "{now:?}"),
            1 => {
                assert_eq!(now, was);
                let width = drafter.evaluation().variable(pattern.variables[0].id);
                assert!((width.unwrap().0 - at.x / 2.0).abs() < 1e-12);
            }
            2 => assert!(
                matches!(&now, Number::PerSize { usual, sizes } if **usual == was && sizes.len() == 1),
                "{now:?}"
            ),
            _ => assert!(matches!(now, Number::Value(_)), "{now:?}"),
        }
        drafter.chord(Modifiers::COMMAND, Key::Z);
        assert_eq!(number(&drafter), was);
        assert_eq!(drafter.point("A"), start);
    }
}

#[test]
fn handles_of_a_selected_curve_take_numbers_beside_it() {
    let mut drafter = Drafter::new();
    drafter.begin();
    drafter.key(Key::C);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.0));
    drafter.key(Key::Enter);
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.click(drafter.part("Curve AB of draft"));
    let before = drafter.actions;
    for (field, text) in [
        ("x of handle at A", "5"),
        ("y of handle at A", "7"),
        ("x of handle at B", "-4"),
        ("y of handle at B", "2"),
    ] {
        drafter.enter(field, text);
    }
    assert_eq!(drafter.actions - before, 4);
    let pattern = drafter.pattern();
    let CurveRule::Spline { handles, .. } = &pattern.sheets[0].curves[0].rule else {
        panic!("no spline");
    };
    let evaluation = drafter.evaluation();
    let [a, b] = handles.map(|id| evaluation.point(id).unwrap());
    let ends = [drafter.point("A"), drafter.point("B")];
    assert!((a - ends[0] - Vec2::new(0.05, 0.07)).norm() < 1e-9, "{a}");
    assert!((b - ends[1] - Vec2::new(-0.04, 0.02)).norm() < 1e-9, "{b}");
}

#[test]
fn a_part_is_found_by_its_name_and_shown() {
    let mut drafter = Drafter::opened("t-shirt");
    // Far from everything.
    for _ in 0..12 {
        drafter.key(Key::Plus);
    }
    let is_seen = |drafter: &Drafter| {
        drafter
            .window
            .query_by_role_and_label(Role::Button, "Panel sleeve")
            .is_some()
    };
    assert!(!is_seen(&drafter));
    drafter.chord(Modifiers::COMMAND, Key::K);
    drafter.enter(
        "Find a command, a part, a variable or a measurement",
        "panel sle",
    );
    assert!(is_seen(&drafter), "{}", drafter.status());
    let label = drafter
        .window
        .get_by_role_and_label(Role::TextInput, "Name");
    assert_eq!(label.value().unwrap(), "sleeve");
    // A seam is shown where it begins, though other panels are on show alone.
    drafter.key(Key::Home);
    drafter.click(drafter.part("Panel front"));
    drafter.key(Key::Period);
    drafter.chord(Modifiers::COMMAND, Key::K);
    drafter.enter(
        "Find a command, a part, a variable or a measurement",
        "left sleeve",
    );
    assert!(is_seen(&drafter), "{}", drafter.status());
}

#[test]
fn a_sheet_is_copied_with_its_panels_into_free_room() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.click(drafter.part("Point top of sleeve"));
    let tag = drafter.part("Sheet sleeve") + vec2(20.0, -14.0);
    drafter.click(tag);
    drafter.chord(Modifiers::COMMAND, Key::D);
    let pattern = drafter.pattern();
    let counts = (pattern.sheets.len(), pattern.panels.len());
    assert_eq!(counts, (4, 4), "{}", drafter.status());
    assert_eq!(pattern.panels[3].sheet(), Some(pattern.sheets[3].id));
    // The others stay where they are seen, and say so.
    for (k, sheet) in pattern.sheets.iter().enumerate() {
        let others = pattern.sheets[..k].iter();
        assert!(others.clone().all(|other| other.on_table != sheet.on_table));
    }
}

#[test]
fn sheets_of_which_one_was_moved_are_opened_again_as_they_were_seen() {
    let names = ["Panel front", "Panel back", "Panel sleeve"];
    let mut drafter = Drafter::opened("t-shirt");
    let before = names.map(|name| drafter.part(name));
    drafter.click(drafter.part("Point top of sleeve"));
    let tag = drafter.part("Sheet sleeve") + vec2(20.0, -14.0);
    drafter.drag(tag, tag + vec2(0.0, 40.0));
    // One that is selected is moved by arrow keys as by the pointer.
    drafter.click(tag + vec2(0.0, 40.0));
    drafter.chord(Modifiers::SHIFT, Key::ArrowDown);
    let moved = names.map(|name| drafter.part(name));
    for k in 0..2 {
        assert!((moved[k] - before[k]).length() < 0.1, "{}", names[k]);
    }
    assert!((moved[2] - before[2]).y > 40.5, "{before:?} {moved:?}");
    drafter.key(Key::Home);
    let seen = names.map(|name| drafter.part(name));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("moved.toile.json");
    std::fs::write(&file, drafter.saved()).unwrap();
    let mut again = Drafter::begun(Beginning {
        file: Some(file),
        folder: None,
    });
    again.key(Key::Home);
    for (name, seen) in names.iter().zip(seen) {
        let found = again.part(name);
        assert!((found - seen).length() < 1.0, "{name}: {seen:?} {found:?}");
    }
}

/// How many sheets and points a pattern has.
fn counts(drafter: &Drafter) -> (usize, usize) {
    let pattern = drafter.pattern();
    let points = pattern.sheets.iter().map(|sheet| sheet.points.len()).sum();
    (pattern.sheets.len(), points)
}

/// Two sheets, the second with two points.
fn with_bare_sheet() -> Drafter {
    let mut drafter = Drafter::new();
    drafter.begin();
    drafter.draw_rectangle();
    drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::N);
    drafter.key(Key::P);
    drafter.click(drafter.place(0.0, 0.05));
    drafter.click(drafter.place(0.1, 0.1));
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter
}

/// Pastes what was copied last.
fn paste(drafter: &mut Drafter) {
    drafter.chord(Modifiers::COMMAND, Key::K);
    drafter.enter(
        "Find a command, a part, a variable or a measurement",
        "Paste",
    );
}

#[test]
fn a_sheet_without_panels_is_pasted_as_a_sheet() {
    let mut drafter = with_bare_sheet();
    let tag = drafter.part("Sheet sheet") + vec2(20.0, -14.0);
    drafter.click(tag);
    drafter.window.event(egui::Event::Copy);
    drafter.window.run();
    paste(&mut drafter);
    assert_eq!(counts(&drafter), (3, 8), "{}", drafter.status());
    let pattern = drafter.pattern();
    assert_ne!(pattern.sheets[1].name, pattern.sheets[2].name);
    assert_ne!(pattern.sheets[1].on_table, pattern.sheets[2].on_table);
    // Its points alone go to the sheet in hand.
    drafter.chord(Modifiers::COMMAND, Key::Z);
    assert_eq!(counts(&drafter), (2, 6));
    drafter.key(Key::Home);
    drafter.click(drafter.part("Point A of sheet"));
    drafter.window.event(egui::Event::Copy);
    drafter.window.run();
    paste(&mut drafter);
    assert_eq!(counts(&drafter), (2, 7), "{}", drafter.status());
}

#[test]
fn a_sheet_without_panels_is_duplicated_beside_itself() {
    let mut drafter = with_bare_sheet();
    let tag = drafter.part("Sheet sheet") + vec2(20.0, -14.0);
    drafter.click(tag);
    drafter.chord(Modifiers::COMMAND, Key::D);
    assert_eq!(counts(&drafter), (3, 8), "{}", drafter.status());
    let pattern = drafter.pattern();
    let [first, second] = [1, 2].map(|k| pattern.sheets[k].on_table[0]);
    assert!(second > first + 0.1, "{first} {second}");
}

#[test]
fn a_new_sheet_lies_beside_panels_that_are_hidden_too() {
    let mut drafter = Drafter::opened("t-shirt");
    let right = |drafter: &Drafter| {
        let view = drafter.window.state().view();
        view.table_layout.bounds(&view.scene).unwrap().max.x
    };
    let free = right(&drafter);
    drafter.click(drafter.part("Panel front"));
    drafter.key(Key::Period);
    assert!(right(&drafter) < free, "others lie farther to the right");
    drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::N);
    let pattern = drafter.pattern();
    let sheet = pattern.sheets.last().unwrap();
    assert_eq!(pattern.sheets.len(), 4, "{}", drafter.status());
    assert!(sheet.on_table[0] > free, "{:?} {free}", sheet.on_table);
    // It is seen, though others were on show alone.
    drafter.part(&format!("Sheet {}", sheet.name));
}

/// Rectangles on the screen round the panels.
fn panels_seen(drafter: &Drafter) -> Vec<Rect> {
    let view_state = drafter.window.state().view();
    let view = drafter.window.get_by_label("Pattern view").rect();
    let panels = view_state.scene.panels.iter().map(|panel| {
        let origin = view_state.table_layout.panel(panel.id);
        let bounds = panel.bounds();
        let corners = [bounds.min, bounds.max].map(|at| view_state.screen(view, origin, at));
        Rect::from_two_pos(corners[0], corners[1])
    });
    panels.collect()
}

/// Asserts that so many panels lie apart, and that the last of them is seen whole.
fn assert_apart(drafter: &Drafter, count: usize) {
    let panels = panels_seen(drafter);
    assert_eq!(panels.len(), count, "{}", drafter.status());
    let last = panels[count - 1];
    for other in &panels[..count - 1] {
        assert!(!other.intersects(last), "{panels:?}");
    }
    let view = drafter.window.get_by_label("Pattern view").rect();
    assert!(view.contains_rect(last), "{last} is not in {view}");
}

/// A panel that was moved off its sheet is copied beside where it lies, not beside where it was.
#[test]
fn a_panel_moved_off_its_sheet_is_copied_beside_itself() {
    let mut drafter = Drafter::new();
    drafter.begin();
    drafter.draw_rectangle();
    let from = drafter.part("Panel draft");
    drafter.drag(from, from - egui::vec2(60.0, 40.0));
    drafter.click(drafter.part("Panel draft"));
    drafter.chord(Modifiers::COMMAND, Key::D);
    assert_apart(&drafter, 2);
    let [panel, copy] = [0, 1].map(|k| panels_seen(&drafter)[k]);
    assert!((copy.top() - panel.top()).abs() < 2.0, "{panel} {copy}");
    let room = copy.left() - panel.right();
    assert!(room < 0.75 * panel.width(), "{panel} {copy}");
}

#[test]
fn panels_are_pasted_where_there_is_room_and_seen_there() {
    let mut drafter = Drafter::new();
    drafter.begin();
    drafter.draw_rectangle();
    drafter.click(drafter.part("Panel draft"));
    drafter.window.event(egui::Event::Copy);
    drafter.window.run();
    for count in 2..9 {
        paste(&mut drafter);
        assert_apart(&drafter, count);
    }
    // So are duplicates, out of view as well.
    drafter.chord(Modifiers::COMMAND, Key::D);
    assert_apart(&drafter, 9);
    // As large as the view, it is shown smaller.
    drafter.key(Key::Home);
    for _ in 0..7 {
        drafter.key(Key::Plus);
    }
    paste(&mut drafter);
    assert_apart(&drafter, 10);

    // What was cut comes back to its place while that is free.
    let mut drafter = with_bare_sheet();
    let place = drafter.pattern().sheets[1].on_table;
    drafter.click(drafter.part("Sheet sheet") + vec2(20.0, -14.0));
    drafter.window.event(egui::Event::Cut);
    drafter.window.run();
    assert_eq!(drafter.pattern().sheets.len(), 1, "{}", drafter.status());
    paste(&mut drafter);
    assert_eq!(drafter.pattern().sheets[1].on_table, place);
}

#[test]
fn empty_sheets_are_not_pasted_upon_each_other() {
    let mut drafter = Drafter::new();
    drafter.begin();
    drafter.draw_rectangle();
    drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::N);
    drafter.window.event(egui::Event::Copy);
    drafter.window.run();
    paste(&mut drafter);
    paste(&mut drafter);
    let pattern = drafter.pattern();
    let places: Vec<_> = pattern.sheets.iter().map(|sheet| sheet.on_table).collect();
    assert_eq!(places.len(), 4, "{}", drafter.status());
    for (k, place) in places.iter().enumerate() {
        assert!(!places[..k].contains(place), "{places:?}");
    }
}
