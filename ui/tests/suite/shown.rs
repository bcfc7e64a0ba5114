//! What the window shows: angles in degrees, long formulas whole, the heads of a table that is
//! scrolled, corners where an outline has them; and that the rims of its parts are taken hold of.

use crate::drafter::Drafter;
use egui::{Key, Modifiers, Rect, Role, vec2};
use egui_kittest::kittest::{NodeT, Queryable};

/// A new pattern with the table of variables open.
fn with_variables(variables: &[&str]) -> Drafter {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Shown");
    drafter.key(Key::F8);
    drafter.press("Variables");
    for variable in variables {
        drafter.enter("New variable", variable);
    }
    assert_eq!(drafter.pattern().variables.len(), variables.len());
    drafter
}

fn rect(drafter: &Drafter, role: Role, name: &str) -> Rect {
    let found = drafter.window.get_by_role_and_label(role, name);
    found.rect()
}

#[test]
fn variables_that_are_angles_are_told_in_degrees() {
    let mut drafter = with_variables(&[
        "slope = 30deg",
        "flare = atan2(1cm, 1cm)",
        "steep = flare + 15",
        "wide = 3cm / 2",
        "ratio = slope / 4deg",
    ]);
    let told = |drafter: &Drafter, words: &str| {
        let all = drafter.status();
        assert!(all.split(" | ").any(|told| told == words), "{words}: {all}");
    };
    for words in ["30\u{b0}", "45\u{b0}", "60\u{b0}", "1.5 cm", "7.5"] {
        told(&drafter, words);
    }
    // So is what is typed, before it is entered.
    drafter.click(rect(&drafter, Role::TextInput, "steep").center());
    drafter.type_text("flare / 2");
    told(&drafter, "= 22.5\u{b0}");
    drafter.key(Key::Escape);
    drafter.click(rect(&drafter, Role::TextInput, "wide").center());
    drafter.type_text("30cm / 4");
    told(&drafter, "= 7.5 cm");
}

#[test]
fn a_long_formula_is_seen_whole_when_it_has_the_keys() {
    let formula = "max(1cm + 2cm + 3cm, 4cm + 5cm) + hypot(3cm, 4cm) + round(12.34cm, 5mm)";
    let mut drafter = with_variables(&[&format!("long = {formula}"), "short = 2cm"]);
    let field = |drafter: &Drafter, name: &str| rect(drafter, Role::TextInput, name);
    let one_line = field(&drafter, "short").height();
    assert!((field(&drafter, "long").height() - one_line).abs() < 0.1);
    // All of it is told beside a pointer that rests there.
    let told = |drafter: &Drafter| drafter.status().split(" | ").any(|told| told == formula);
    drafter.hover(field(&drafter, "long").center());
    drafter.window.run_steps(90);
    assert!(told(&drafter));
    drafter.click(field(&drafter, "long").center());
    assert!(field(&drafter, "long").height() > 1.6 * one_line);
    // Enter takes it as ever, and Tab goes on.
    let before = drafter.pattern();
    drafter.key(Key::Enter);
    assert!((field(&drafter, "long").height() - one_line).abs() < 0.1);
    assert_eq!(drafter.pattern(), before);
    drafter.enter("long", "1cm + 1cm");
    assert_eq!(drafter.pattern().variables.len(), 2);
    drafter.enter_on("long", formula);
    assert!((field(&drafter, "long").height() - one_line).abs() < 0.1);
    let pattern = drafter.pattern();
    let now = drafter.evaluation().variable(pattern.variables[0].id);
    assert!((now.unwrap().0 - 0.265).abs() < 1e-9, "{now:?}");
}

#[test]
fn the_heads_of_the_variables_stay_while_the_rows_are_scrolled() {
    let mut drafter = with_variables(&["first = 1cm"]);
    let head = |drafter: &Drafter| rect(drafter, Role::Label, "Number or formula");
    let before = head(&drafter);
    for k in 0..12 {
        drafter.enter("New variable", &format!("v{k} = {k}cm"));
    }
    assert_eq!(head(&drafter), before);
    let first = rect(&drafter, Role::TextInput, "first");
    assert!(first.bottom() < before.top(), "it is scrolled");
    let last = rect(&drafter, Role::TextInput, "v11");
    let low = drafter.window.ctx.content_rect().bottom();
    assert!(last.top() >= before.bottom() && last.bottom() < low);
    // It stands under its head.
    assert!((last.left() - before.left()).abs() < 1.0);
}

#[test]
fn rims_are_taken_hold_of_from_both_sides() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.key(Key::F8);
    let view = |drafter: &Drafter| drafter.window.get_by_label("Pattern view").rect();
    for side in [-3.0, 3.0] {
        let before = view(&drafter);
        let rim = before.right_center() + vec2(4.0, 30.0);
        let from = rim + vec2(side, 0.0);
        drafter.drag(from, from - vec2(40.0, 0.0));
        let width = view(&drafter).width();
        assert!(
            (width - before.width() + 40.0).abs() < 6.0,
            "{side}: {width}"
        );
        let before = view(&drafter);
        let rim = before.center_bottom() + vec2(-200.0, 4.0);
        let from = rim + vec2(0.0, side);
        drafter.drag(from, from - vec2(0.0, 30.0));
        let height = view(&drafter).height();
        assert!((height - before.height() + 30.0).abs() < 6.0, "{side}");
    }
    assert!(drafter.window.state().view().selection.is_empty());
}

#[test]
fn corners_that_a_step_moved_are_seen_only_with_their_sheet() {
    let mut drafter = Drafter::with_panel("Pivoted");
    drafter.click(drafter.place(-0.05, -0.05));
    let points = |drafter: &Drafter| {
        let parts = drafter.window.query_all_by_role(Role::Button);
        let labels = parts.filter_map(|part| part.accesskit_node().label());
        labels.filter(|label| label.starts_with("Point ")).count()
    };
    // Beside the tool, which the window calls a point too.
    let tools = points(&drafter) - 4;
    drafter.key(Key::D);
    drafter.click(drafter.part("Edge top of draft"));
    drafter.typed("2");
    drafter.typed("15");
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.click(drafter.place(-0.05, -0.05));
    assert_eq!(points(&drafter) - tools, 4, "a dart leaves them");
    drafter.chord(Modifiers::SHIFT, Key::E);
    drafter.click(drafter.part("Dart of draft"));
    drafter.click(drafter.part("Edge right of draft"));
    drafter.key(Key::Enter);
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.click(drafter.place(-0.05, -0.05));
    assert!(drafter.window.state().view().selection.is_empty());
    let seen = points(&drafter) - tools;
    assert!((2..4).contains(&seen), "{seen}");
    // With the panel all are there, to be taken hold of.
    drafter.click(drafter.part("Panel draft"));
    assert_eq!(points(&drafter) - tools, 4);
}

/// Lengths in pixels of what is drawn between two places.
fn drawn_between(drafter: &Drafter, [from, to]: [egui::Pos2; 2]) -> f32 {
    let strip = Rect::from_two_pos(from, to).expand(1.0);
    let shapes = drafter.window.output().shapes.iter();
    let lengths = shapes.filter_map(|clipped| match &clipped.shape {
        egui::Shape::LineSegment { points, .. } => {
            let is_inside = points.iter().all(|at| strip.contains(*at));
            is_inside.then(|| points[0].distance(points[1]))
        }
        _ => None,
    });
    lengths.sum()
}

#[test]
fn an_inner_line_of_a_folded_panel_is_seen_on_both_halves() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Shown");
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.key(Key::I);
    drafter.click(drafter.part("Panel draft"));
    drafter.click(drafter.place(0.05, 0.1));
    drafter.click(drafter.place(0.15, 0.1));
    drafter.key(Key::Enter);
    drafter.chord(Modifiers::SHIFT, Key::F);
    drafter.click(drafter.part("Edge left of draft"));
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.key(Key::Home);
    let drawn = |side: f64| {
        let ends = [0.05, 0.15].map(|x| drafter.place(x * side, 0.1));
        drawn_between(&drafter, ends) / ends[0].distance(ends[1])
    };
    let halves = [drawn(1.0), drawn(-1.0)];
    assert!(halves.iter().all(|share| *share > 0.5), "{halves:?}");
}

/// Where the fields for text stand, by name.
fn fields(drafter: &Drafter) -> Vec<(String, Rect)> {
    let fields = drafter.window.query_all_by_role(Role::TextInput);
    fields
        .map(|field| {
            let name = field.accesskit_node().label().unwrap_or_default();
            (name, field.rect())
        })
        .collect()
}

#[test]
fn no_field_moves_while_one_is_typed_into() {
    let mut drafter = Drafter::opened("t-shirt");
    // A curve has a field for its length, and those of its handles.
    for (part, field) in [
        ("Edge hem of front", "seam allowance"),
        ("Edge shoulder of front", "seam allowance"),
        ("Edge cap_front of sleeve", "length"),
        ("Panel front", "grain"),
    ] {
        drafter.click(drafter.part(part));
        drafter.window.run_steps(40);
        if part.contains("cap_front") {
            drafter.click(drafter.part(part));
        }
        let before = fields(&drafter);
        assert!(before.len() > 1, "{part}: {before:?}");
        let first = drafter.window.get_by_role_and_label(Role::TextInput, field);
        first.focus();
        drafter.window.run();
        // A value, a fault, a name that is completed, a formula longer than the field.
        for text in ["3", " +", " waist_l", "ine / 20 + 1cm + 1cm + 1cm + 1cm"] {
            drafter.type_text(text);
            let own = |fields: Vec<(String, Rect)>| {
                let others = fields.into_iter().filter(|(name, _)| name != field);
                others.collect::<Vec<_>>()
            };
            assert_eq!(own(fields(&drafter)), own(before.clone()), "{part}: {text}");
        }
        drafter.key(Key::Escape);
        assert_eq!(fields(&drafter), before, "{part}");
        if field == "seam allowance" {
            for text in ["3", "3cm / 2"] {
                drafter.enter(field, text);
                assert_eq!(fields(&drafter), before, "{part}: {text} is entered");
            }
        }
    }
}

#[test]
fn escape_in_a_field_takes_back_what_is_typed_and_nothing_else() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.click(drafter.part("Edge hem of front"));
    let selected = drafter.window.state().view().selection.clone();
    let before = drafter.pattern();
    let shown = |drafter: &Drafter| {
        let window = &drafter.window;
        let field = window.get_by_role_and_label(Role::TextInput, "seam allowance");
        field.value()
    };
    let was = shown(&drafter);
    for text in ["7", "waist"] {
        drafter.click(rect(&drafter, Role::TextInput, "seam allowance").center());
        drafter.type_text(text);
        assert_eq!(shown(&drafter).as_deref(), Some(text));
        drafter.key(Key::Escape);
        assert_eq!(drafter.window.state().view().selection, selected, "{text}");
        assert_eq!(shown(&drafter), was);
        assert!(drafter.pattern().says_the_same(&before));
    }
    // In a table too; and the next one is for the selection.
    drafter.key(Key::F8);
    drafter.press("Variables");
    drafter.click(rect(&drafter, Role::TextInput, "New variable").center());
    drafter.type_text("ease");
    drafter.key(Key::Escape);
    assert_eq!(drafter.window.state().view().selection, selected);
    drafter.key(Key::Escape);
    assert!(drafter.window.state().view().selection.is_empty());
}

#[test]
fn what_is_typed_for_a_tool_stays_at_the_pointer() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Still");
    drafter.key(Key::L);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.hover(drafter.place(0.1, 0.1));
    let words = |drafter: &Drafter| {
        let view = drafter.window.state().view();
        let marks = view.overlay(&drafter.evaluation()).into_iter();
        let mut words = marks.filter_map(|mark| match mark {
            toile_ui::Overlay::Words(_, at, words) => Some((at, words)),
            _ => None,
        });
        words.next().unwrap()
    };
    let mut places = Vec::new();
    // A length, a fault in it, and the length again.
    for (text, line) in [
        ("2", "length 2|"),
        ("0", "length 20|"),
        ("+", "length 20+|"),
        ("5", "length 20+5|"),
    ] {
        drafter.type_text(text);
        let (at, words) = words(&drafter);
        assert_eq!(words.lines().next(), Some(line), "{words}");
        places.push(at);
    }
    assert!(places.windows(2).all(|w| w[0] == w[1]), "{places:?}");
    assert!((places[0] - toile_geometry::Vec2::new(0.1, 0.1)).norm() < 1e-3);
}
