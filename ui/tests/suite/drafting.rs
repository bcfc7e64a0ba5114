//! Drafting from an empty window by tools alone, from raw events, with actions counted: an action is
//! a click, a whole drag, a key or chord, or a typed field with the Enter or Tab that ends it. The
//! documents that counted ways begin and end with are recorded: see `drafter/counted.rs`.

use crate::drafter::Drafter;
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT, Queryable};
use toile_geometry::Vec2;
use toile_pattern::Evaluation;
use toile_session::{Command, Project, Session, Silent};

#[test]
fn a_skirt_panel_with_a_dart_from_an_empty_window() {
    let mut drafter = Drafter::new();
    drafter.starts("skirt");
    drafter.press("New pattern");
    drafter.enter("Name", "Skirt");
    assert_eq!(drafter.pattern().name, "Skirt");

    // The wearer: her own waist and hips.
    drafter.key(Key::F8);
    drafter.press("Add size");
    drafter.enter("Waist girth", "72");
    drafter.enter("Hip girth", "98");
    drafter.key(Key::F8);

    // The panel: a rectangle with a width from a measurement.
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    let opposite = drafter.place(0.2, 0.3);
    drafter.hover(opposite);
    drafter.typed_and("=hips / 4 + 1cm", Key::Tab);
    drafter.typed("60");
    let pattern = drafter.pattern();
    assert_eq!(
        pattern.panels.len(),
        1,
        "{:?}",
        drafter.window.state().findings()
    );
    let hips = drafter
        .window
        .state()
        .session()
        .project()
        .drafted_to()
        .measurements
        .get("hips")
        .unwrap();
    assert_eq!(hips, 0.98);
    let size = drafter.point("C") - drafter.point("A");
    assert!(
        (size - Vec2::new(hips / 4.0 + 0.01, 0.6)).norm() < 1e-12,
        "{size}"
    );

    // The dart in the middle of the waist edge, trued.
    let before = drafter.actions;
    drafter.key(Key::Home);
    drafter.key(Key::D);
    let top = drafter.part("Edge top of draft");
    drafter.click(top);
    drafter.typed("2.5");
    drafter.typed("11");
    let dart = drafter.actions - before;
    let pattern = drafter.pattern();
    assert_eq!(pattern.panels[0].operations.len(), 1);
    // Centre front lies on the fold.
    drafter.chord(Modifiers::SHIFT, Key::F);
    drafter.click(drafter.part("Edge left of draft"));
    let count = drafter.pattern().panels[0].operations.len();
    assert_eq!(count, 2, "{}", drafter.status());
    // With the allowance of the hem, on paper.
    drafter.key(Key::Escape);
    drafter.click(drafter.part("Edge bottom of draft"));
    drafter.enter("seam allowance", "4");
    let folder = tempfile::tempdir().unwrap();
    let paper = folder.path().join("skirt.pdf");
    drafter.chord(Modifiers::COMMAND, Key::P);
    drafter.enter("File", &paper.display().to_string());
    for _ in 0..2000 {
        if paper.exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
        drafter.window.run_steps(1);
    }
    assert!(paper.exists(), "{}", drafter.status());
    println!("{} actions, {dart} of them for the dart", drafter.actions);
    assert!(drafter.actions <= 24, "{}", drafter.actions);
    assert!(drafter.actions - dart <= 22, "{}", drafter.actions);
    drafter.ends("skirt");
    let hem = drafter.pattern().panels[0]
        .edges()
        .find(|edge| edge.name == "bottom")
        .and_then(|edge| edge.allowance.as_ref()?.value());
    assert_eq!(hem, Some(0.04));
    assert!(
        drafter.window.query_by_label("No faults").is_some(),
        "{:?}",
        drafter.window.state().findings()
    );

    // All of it can be undone and done again to the same bytes.
    let end = drafter.pattern();
    let steps = drafter.window.state().session().past().len();
    for _ in 0..steps {
        drafter.chord(Modifiers::COMMAND, Key::Z);
    }
    assert!(drafter.pattern().panels.is_empty());
    for _ in 0..steps {
        drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    }
    assert!(drafter.pattern().says_the_same(&end));
    // And replayed from the journal.
    let journal = drafter.window.state().session().journal();
    let (again, _) = Session::replay(&journal, folder.path(), &mut Silent).unwrap();
    assert!(again.project().pattern.says_the_same(&end));
    assert!(matches!(journal[0], Command::NewPattern { .. }));
}

#[test]
fn a_tool_taken_by_its_key_knows_where_the_pointer_rests() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Rest");
    drafter.hover(drafter.place(0.1, 0.1));
    drafter.key(Key::R);
    for [across, up] in [["5", "7"], ["20", "60"]] {
        drafter.type_text(across);
        drafter.key(Key::Tab);
        drafter.typed(up);
    }
    assert_eq!(drafter.pattern().panels.len(), 1, "{}", drafter.status());
    let corner = drafter.point("A") - Vec2::new(0.05, 0.07);
    assert!(corner.norm() < 1e-12, "{corner}");
}

#[test]
fn lines_by_lengths_and_angles_become_constructions() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Lines");
    drafter.key(Key::L);
    drafter.click(drafter.place(0.0, 0.0));
    for (length, angle) in [("20", "0"), ("=10cm + 5cm", "90"), ("12,5", "180")] {
        for c in length.chars() {
            drafter.window.event(egui::Event::Text(c.to_string()));
            drafter.window.run();
        }
        drafter.key(Key::Tab);
        drafter.typed(angle);
    }
    let pattern = drafter.pattern();
    assert_eq!(pattern.sheets[0].curves.len(), 3);
    for (name, at) in [("B", [0.2, 0.0]), ("C", [0.2, 0.15]), ("D", [0.075, 0.15])] {
        let away = (drafter.point(name) - Vec2::from(at)).norm();
        assert!(away < 1e-12, "{name} is {away} away");
    }
    // Back to the first point closes the figure; a click inside makes a panel of it.
    drafter.click(drafter.part("Point A of draft"));
    drafter.key(Key::Escape);
    drafter.key(Key::T);
    drafter.hover(drafter.place(0.12, 0.07));
    println!("{}", drafter.status());
    drafter.click(drafter.place(0.12, 0.07));
    assert_eq!(drafter.pattern().panels.len(), 1, "{}", drafter.status());
    drafter.key(Key::Escape);
    assert!(drafter.window.query_by_label("No faults").is_some());
}

#[test]
fn two_clicks_sew_both_sides_and_one_puts_notches_that_meet() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Skirt");
    // A front on the fold, and a back that is cut twice.
    for (x, width) in [(0.0, "25"), (0.4, "26")] {
        drafter.key(Key::R);
        drafter.click(drafter.place(x, 0.0));
        drafter.hover(drafter.place(x + 0.1, 0.1));
        for c in width.chars() {
            drafter.window.event(egui::Event::Text(c.to_string()));
            drafter.window.run();
        }
        drafter.key(Key::Tab);
        drafter.typed("60");
    }
    drafter.key(Key::Home);
    let names: Vec<String> = drafter
        .pattern()
        .panels
        .iter()
        .map(|p| p.name.clone())
        .collect();
    let [front, back] = &names[..] else {
        panic!("{names:?}");
    };
    drafter.chord(Modifiers::SHIFT, Key::F);
    drafter.click(drafter.part(&format!("Edge left of {front}")));
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.click(drafter.part(&format!("Panel {back}")));
    drafter.enter_choice("in mirrored pairs");

    drafter.key(Key::S);
    let before = drafter.actions;
    drafter.click(drafter.part(&format!("Edge right of {front}")));
    drafter.click(drafter.part(&format!("Edge left 2 of {back}")));
    assert_eq!(drafter.actions - before, 2);
    let pattern = drafter.pattern();
    assert_eq!(pattern.seams.len(), 2, "{}", drafter.status());
    let halves: Vec<(u8, u32)> = pattern
        .seams
        .iter()
        .map(|seam| (seam.sides[0][0].half, seam.sides[1][0].copy))
        .collect();
    assert_eq!(halves, [(0, 0), (1, 1)]);
    // Start to start: both sides are walked upward or both downward.
    let steps = drafter.window.state().session().past().len();
    drafter.key(Key::Escape);
    let sewn = drafter.pattern();
    // The other way, and back.
    drafter.key(Key::X);
    assert_ne!(drafter.pattern().seams, sewn.seams, "{}", drafter.status());
    drafter.key(Key::X);
    assert!(drafter.pattern().says_the_same(&sewn));
    assert_eq!(drafter.window.state().session().past().len(), steps + 2);

    // Two notches by a tool and a click, both a third of the way up.
    drafter.starts("notches");
    let before = drafter.actions;
    drafter.chord(Modifiers::SHIFT, Key::N);
    let up = drafter.place(0.25, 0.2);
    drafter.click(up);
    assert_eq!(drafter.actions - before, 2);
    drafter.ends("notches");
    let pattern = drafter.pattern();
    let heights: Vec<f64> = pattern
        .panels
        .iter()
        .map(|panel| {
            assert_eq!(panel.notches.len(), 1, "{}", drafter.status());
            let stage = drafter.evaluation();
            let stage = stage.last_stage(panel).unwrap();
            stage.notches[0].point.y
        })
        .collect();
    assert!((heights[0] - 0.2).abs() < 0.003, "{heights:?}");
    assert!((heights[0] - heights[1]).abs() < 1e-9, "{heights:?}");
}

#[test]
fn an_edge_that_is_clicked_while_a_number_is_typed_gives_its_length() {
    let mut drafter = Drafter::with_panel("Lengths");
    drafter.click(drafter.part("Edge top of draft"));
    let field = drafter
        .window
        .get_by_role_and_label(Role::TextInput, "seam allowance");
    field.focus();
    drafter.window.run();
    drafter.click(drafter.part("Edge right of draft"));
    for c in "/ 20".chars() {
        drafter.window.event(egui::Event::Text(c.to_string()));
        drafter.window.run();
    }
    drafter.window.key_press(Key::Enter);
    drafter.window.run();
    let pattern = drafter.pattern();
    let edge = pattern.panels[0].edges().find(|edge| edge.name == "top");
    let allowance = edge.unwrap().allowance.clone().unwrap();
    let formula = allowance.as_formula().unwrap();
    let evaluation = drafter.evaluation();
    assert_eq!(formula.text(evaluation.names()), "length(draft.right)/ 20");
    let value = evaluation.number(&allowance, toile_pattern::Want::Length);
    assert!((value.unwrap() - 0.3 / 20.0).abs() < 1e-12, "{value:?}");
}

#[test]
fn a_cap_is_fitted_to_its_armhole_by_clicking_it() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.starts("cap");
    // A notch lies on its middle: a second click takes what is under it.
    let middle = drafter.part("Edge cap_front of sleeve");
    drafter.click(middle);
    // Not a double click.
    drafter.window.run_steps(40);
    drafter.click(middle);
    let field = drafter
        .window
        .get_by_role_and_label(Role::TextInput, "length");
    field.focus();
    drafter.window.run();
    drafter.click(drafter.part("Edge armhole of front"));
    drafter.typed(" + 0.5cm");
    assert!(drafter.actions <= 6, "{}", drafter.actions);
    drafter.ends("cap");
    let pattern = drafter.pattern();
    for size in &pattern.sizes {
        let sized = Project {
            pattern: pattern.clone().into(),
            size: Some(size.name.clone()),
            ..Project::default()
        };
        let evaluation = Evaluation::new(&pattern, sized.drafted_to());
        let length = |panel: &str, edge: &str| {
            let panel = pattern.panel_named(panel).unwrap();
            let edge = panel.edges().find(|found| found.name == edge).unwrap();
            evaluation.edge(edge.id).unwrap().length()
        };
        let ease = length("sleeve", "cap_front") - length("front", "armhole");
        assert!((ease - 0.005).abs() < 1e-6, "{}: {ease}", size.name);
    }
}

#[test]
fn a_dart_is_moved_by_its_number() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Dart");
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.key(Key::D);
    drafter.click(drafter.part("Edge top of draft"));
    drafter.typed("2");
    drafter.typed("8");
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.actions = 0;
    drafter.starts("dart");
    drafter.click(drafter.part("Dart of draft"));
    drafter.enter("part of the edge", "0.25");
    assert!(drafter.actions <= 4, "{}", drafter.actions);
    drafter.ends("dart");
    let pattern = drafter.pattern();
    let evaluation = drafter.evaluation();
    let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
    let apex = stage.darts[0].apex;
    assert!((apex.y - 0.22).abs() < 1e-9, "{apex:?}");
    let from_end = apex.x.min(0.2 - apex.x);
    assert!((from_end - 0.05).abs() < 1e-9, "{apex:?}");
}

#[test]
fn what_is_selected_is_moved_turned_mirrored_scaled_and_copied() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Parts");
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.1));
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    let start = drafter.point("A");
    drafter.click(drafter.part("Panel draft"));
    // Moved by typed numbers.
    drafter.key(Key::M);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.type_text("10");
    drafter.key(Key::Tab);
    drafter.typed("90");
    let moved = drafter.point("A");
    assert!(
        (moved - start - Vec2::new(0.0, 0.1)).norm() < 1e-9,
        "{moved}"
    );
    // Turned by a right angle about its first corner.
    drafter.key(Key::Escape);
    drafter.key(Key::Q);
    drafter.click(drafter.part("Point A of draft"));
    drafter.typed("90");
    let width = drafter.point("B") - drafter.point("A");
    assert!((width - Vec2::new(0.0, 0.2)).norm() < 1e-9, "{width}");
    // Scaled to twice its size.
    drafter.key(Key::Escape);
    drafter.chord(Modifiers::SHIFT, Key::S);
    drafter.click(drafter.part("Point A of draft"));
    drafter.typed("2");
    let width = drafter.point("B") - drafter.point("A");
    assert!((width - Vec2::new(0.0, 0.4)).norm() < 1e-9, "{width}");
    // Copied beside itself.
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.key(Key::Home);
    drafter.click(drafter.part("Panel draft"));
    drafter.chord(Modifiers::COMMAND, Key::D);
    assert_eq!(drafter.pattern().panels.len(), 2, "{}", drafter.status());
    // Copied through the clipboard of the system.
    drafter.window.event(egui::Event::Copy);
    drafter.window.step();
    let mut commands = drafter.window.output().platform_output.commands.iter();
    let text = commands.find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    drafter.window.event(egui::Event::Paste(text.unwrap()));
    drafter.window.run();
    assert_eq!(drafter.pattern().panels.len(), 3, "{}", drafter.status());
}

#[test]
fn hems_meet_hems_when_both_panels_are_drawn_alike() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Skirt");
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.4));
    drafter.chord(Modifiers::SHIFT, Key::F);
    drafter.click(drafter.part("Edge left of draft"));
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.click(drafter.part("Panel draft"));
    drafter.chord(Modifiers::COMMAND, Key::D);
    drafter.key(Key::Home);
    let pattern = drafter.pattern();
    let [front, back] = &pattern.panels[..] else {
        panic!("{}", drafter.status());
    };
    let side = |panel: &toile_pattern::Panel| {
        let edge = panel.edges().find(|edge| edge.name.starts_with("right"));
        format!("Edge {} of {}", edge.unwrap().name, panel.name)
    };
    let (first, second) = (side(front), side(back));
    drafter.key(Key::S);
    drafter.click(drafter.part(&first));
    drafter.click(drafter.part(&second));
    let evaluation = drafter.evaluation();
    let pattern = drafter.pattern();
    assert_eq!(pattern.seams.len(), 2, "{}", drafter.status());
    for seam in &pattern.seams {
        assert!(!toile_pattern::plan::is_upside_down(&evaluation, seam.id));
        let halves = [0, 1].map(|side| seam.sides[side][0].half);
        assert_ne!(halves[0], halves[1]);
    }
    // The fold is taken off by a click on its line.
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    let x = drafter.place(0.0, 0.3);
    drafter.click(x);
    drafter.key(Key::Delete);
    let pattern = drafter.pattern();
    let folds = pattern.panels.iter().map(|panel| panel.operations.len());
    assert_eq!(folds.sum::<usize>(), 1, "{}", drafter.status());
}

#[test]
fn an_edge_is_bent_through_a_place() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Bent");
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.chord(Modifiers::SHIFT, Key::B);
    drafter.click(drafter.part("Edge top of draft"));
    drafter.click(drafter.place(0.1, 0.27));
    let pattern = drafter.pattern();
    let evaluation = drafter.evaluation();
    let edge = pattern.panels[0].edges().find(|edge| edge.name == "top");
    let path = evaluation.edge(edge.unwrap().id).unwrap();
    let middle = path.point(path.nearest(Vec2::new(0.1, 0.27)).unwrap());
    assert!((middle - Vec2::new(0.1, 0.27)).norm() < 2e-3, "{middle}");
    assert!(path.length() > 0.205);
}

#[test]
fn keys_of_a_field_are_no_commands() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.click(drafter.part("Edge hem of front"));
    let selected = drafter.window.state().view().selection.clone();
    let field = drafter
        .window
        .get_by_role_and_label(Role::TextInput, "seam allowance");
    field.focus();
    drafter.window.run();
    drafter.chord(Modifiers::COMMAND, Key::A);
    assert_eq!(drafter.window.state().view().selection, selected);
    // Enter belongs to the field, not to a tool that was in hand.
    drafter.window.event(egui::Event::Text("4".into()));
    drafter.window.run();
    drafter.window.key_press(Key::Enter);
    drafter.window.run();
    let pattern = drafter.pattern();
    let front = pattern.panel_named("front").unwrap();
    let hem = front.edges().find(|edge| edge.name == "hem").unwrap();
    let width = hem
        .allowance
        .as_ref()
        .and_then(toile_pattern::Number::value);
    assert_eq!(width, Some(0.04), "{}", drafter.status());
}

#[test]
fn names_are_proposed_while_a_formula_is_typed() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.click(drafter.part("Edge hem of front"));
    let field = drafter
        .window
        .get_by_role_and_label(Role::TextInput, "seam allowance");
    field.focus();
    drafter.window.run();
    drafter.window.event(egui::Event::Text("waist_l".into()));
    drafter.window.run();
    assert!(drafter.window.query_by_label("waist_line").is_some());
    // The arrow downward takes it; a bare number beside it gets the document's unit.
    drafter.window.key_press(Key::ArrowDown);
    drafter.window.run();
    drafter.window.event(egui::Event::Text(" / 20 + 1".into()));
    drafter.window.run();
    drafter.window.key_press(Key::Enter);
    drafter.window.run();
    let pattern = drafter.pattern();
    let hem = pattern.panels[0].edges().find(|edge| edge.name == "hem");
    let allowance = hem.unwrap().allowance.clone().unwrap();
    let text = toile_pattern::plan::number_text(
        &drafter.evaluation(),
        &allowance,
        toile_pattern::Want::Length,
    );
    assert_eq!(text, "waist_line / 20 + 1cm");
}

#[test]
fn the_other_button_opens_a_menu_on_what_is_under_it() {
    let drafter = Drafter::opened("t-shirt");
    let at = drafter.part("Edge hem of front");
    let mut window = drafter.window;
    window.hover_at(at);
    window.run();
    for pressed in [true, false] {
        window.event(egui::Event::PointerButton {
            pos: at,
            button: egui::PointerButton::Secondary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        window.run();
    }
    // The bar of tools has a notch too; the menu is the second.
    let entries = window.query_all_by_role_and_label(Role::Button, "Notch");
    assert_eq!(entries.count(), 2);
    let hem = window.get_by_role_and_label(Role::Button, "Edge hem of front");
    assert_eq!(
        hem.accesskit_node().toggled(),
        Some(egui::accesskit::Toggled::True)
    );
}
