//! The way of `docs/GUIDE.md`, gone in an empty window by mouse and keys: what is typed is read from
//! the guide. The dress is without fault in every size, its lines run on smoothly across all seams, and
//! it drapes. Where `TOILE_SCREENS` names a folder and there is a graphics adapter, the pictures of
//! the guide are written there:
//!
//!     TOILE_SCREENS=$PWD/docs/screens cargo test -p toile-ui --test suite guide::

use crate::drafter::Drafter;
use crate::guide_reader::Reader;
use crate::guide_reader::text::{self, section};
use crate::screens::{Colours, Part};
use egui::{Key, Modifiers, Rect, Role, pos2, vec2};
use egui_kittest::kittest::Queryable;
use std::collections::BTreeSet;
use toile_pattern::Evaluation;
use toile_pattern::walk::{Smoothness, Walk};
use toile_session::{Command, Figure, Project};

#[test]
fn the_guide_leads_from_an_empty_window_to_a_draped_dress() {
    let mut reader = Reader::new();
    begin(&mut reader);
    measure(&mut reader);
    draft_front(&mut reader);
    draft_back(&mut reader);
    sew(&mut reader);
    is_clean_in_every_size(&mut reader);
    let folder = tempfile::tempdir().unwrap();
    lay(&mut reader);
    save(&mut reader, folder.path());
    print(&mut reader, folder.path());
    try_on(&mut reader);
    wear(&mut reader);
    alter(&mut reader);
    says_what_is_there(&reader);
    println!("{} actions", reader.drafter.actions);
}

fn begin(reader: &mut Reader) {
    let part = section("What you see");
    let page = Rect::from_min_max(pos2(0.0, 0.0), pos2(1200.0, 420.0));
    reader.picture("welcome", Some(page));
    reader.drafter.press("New pattern");
    reader.look();
    reader.drafter.enter("Name", part.says("Shift dress"));
    reader.look();
    reader.drafter.key(Key::F7);
}

fn measure(reader: &mut Reader) {
    let part = section("Measurements");
    let drafter = &mut reader.drafter;
    drafter.key(Key::F8);
    let sizes = ["S", "M", "L"];
    for _ in sizes {
        drafter.press("Add size");
    }
    for (k, name) in sizes.into_iter().enumerate() {
        let was = &drafter.pattern().sizes[k].name;
        let head = match k {
            0 => format!("{was} (base)"),
            _ => was.clone(),
        };
        drafter.press(&head);
        drafter.typed(part.says(name));
        assert_eq!(
            drafter.pattern().sizes[k].name,
            name,
            "{}",
            drafter.status()
        );
    }
    for row in part.table("measurement | name in formulas | S | M | L", 0) {
        let [label, name, s, m, l] = row[..] else {
            panic!("{row:?}");
        };
        drafter.enter("New measurement", label);
        drafter.typed_and(s, Key::Tab);
        drafter.typed_and(m, Key::Tab);
        drafter.typed(l);
        let pattern = drafter.pattern();
        for (size, typed) in pattern.sizes.iter().zip([s, m, l]) {
            let typed: f64 = typed.parse().unwrap();
            let now = size.measurements.get(name).unwrap();
            let shown = if name == "shoulder_incl" {
                now.to_degrees()
            } else {
                now * 100.0
            };
            assert!(
                (shown - typed).abs() < 1e-9,
                "{label}: {shown}, {}",
                drafter.status()
            );
        }
    }
    reader.enlarge_tables();
    reader.picture_of_tables("measurements");
    let drafter = &mut reader.drafter;
    drafter.press("Variables");
    for (k, line) in section("Variables").block().into_iter().enumerate() {
        match k {
            0 => drafter.enter("New variable", line),
            _ => drafter.typed(line),
        }
        let name = line.split(" =").next().unwrap();
        let pattern = drafter.pattern();
        let found = pattern.variables.iter().find(|found| found.name == name);
        assert!(found.is_some(), "{line}: {}", drafter.status());
    }
    reader.picture_of_tables("variables");
    reader.drafter.key(Key::Escape);
    reader.drafter.key(Key::F8);
}

fn draft_front(reader: &mut Reader) {
    let part = section("The front: points");
    let middle = reader.view().center();
    reader.drafter.hover(middle);
    reader.draw_points(part, 0);
    reader.draw_points_from(part, "draft");
    reader.draw_points(part, 1);
    let part = section("The front: lines and curves");
    reader.draw_lines(part, "draft");
    reader.draw_curves(part, "draft");

    let part = section("The front: panel, allowance, dart, fold");
    reader.trace(part, [0.1, -0.6], "front");
    reader.allow(part, "front");
    reader.edge("front", "centre");
    reader.drafter.enter("seam allowance", part.says("0"));
    reader.drafter.key(Key::D);
    reader.edge("front", "mouth");
    for number in [
        "=distance(draft.dart_low, draft.dart_high)",
        "=distance(draft.bust_point, draft.dart_low) * cos(bust_dart / 2) - 2.5cm",
    ] {
        reader.drafter.typed(part.says(number));
    }
    reader.drafter.chord(Modifiers::SHIFT, Key::F);
    reader.edge("front", "centre");
    reader.drafter.key(Key::N);
    let at = reader.on_edge("front", "armhole", Some("underarm"));
    reader.drafter.hover(at);
    reader
        .drafter
        .typed(part.says("=length(front.armhole) * 0.4"));
    reader.drafter.key(Key::G);
    let at = reader.drafter.place(0.08, -0.7);
    reader.drafter.click(at);
    reader.drafter.click(at);
    reader.drafter.typed_and(part.says("20"), Key::Tab);
    reader.drafter.typed(part.says("90"));
    let pattern = reader.drafter.pattern();
    let front = pattern.panel_named("front").unwrap();
    assert_eq!(
        (front.operations.len(), front.notches.len()),
        (2, 1),
        "{}",
        reader.drafter.status()
    );
    reader.put_down();
    reader.drafter.key(Key::Home);
    let middle = reader.drafter.part("Panel front");
    reader.drafter.click(middle);
    reader.look();
    reader.drafter.click(reader.drafter.part("Dart of front"));
    reader.picture("dart", None);
}

fn draft_back(reader: &mut Reader) {
    let part = section("The back");
    reader.put_down();
    reader
        .drafter
        .chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::N);
    reader.drafter.enter("Name", part.says("back"));
    let view = reader.view();
    reader
        .drafter
        .hover(pos2(view.right() - 20.0, view.center().y));
    reader.draw_points(part, 0);
    reader.draw_points_from(part, "back");
    reader.draw_points(part, 1);
    reader.draw_lines(part, "back");
    reader.draw_curves(part, "back");
    reader.trace(part, [-0.1, -0.6], "back");
    reader.look();
    reader.drafter.enter_choice("in mirrored pairs");
    reader.allow(part, "back");
    reader.drafter.key(Key::N);
    let at = reader.on_edge("back", "centre", Some("neck_centre"));
    reader.drafter.hover(at);
    reader.drafter.typed(part.says("55"));
    reader.put_down();
    reader.drafter.key(Key::Home);
}

fn sew(reader: &mut Reader) {
    reader.drafter.key(Key::S);
    reader.edge("front", "shoulder");
    reader.edge("back", "shoulder");
    let low = reader.on_edge("front", "side_low", None);
    reader.drafter.shift_click(low);
    reader.edge("front", "side_high");
    reader.edge("back", "side");
    reader.edge("back", "centre");
    // Not a double click.
    reader.drafter.window.run_steps(40);
    reader.edge("back", "centre");
    let seams = reader.drafter.pattern().seams.len();
    assert_eq!(seams, 5, "{}", reader.drafter.status());
    reader.put_down();
    reader.edge("back", "side");
    reader.drafter.chord(Modifiers::SHIFT, Key::X);
    reader.picture("seams", None);
    reader.put_down();
    reader.drafter.chord(Modifiers::SHIFT, Key::N);
    let at = reader.on_edge("back", "side", Some("hem_side"));
    reader.drafter.click(at);
    reader.put_down();
    for edge in ["side", "shoulder"] {
        let panel = if edge == "side" { "back" } else { "front" };
        reader.edge(panel, edge);
        reader.drafter.key(Key::W);
        reader.drafter.key(Key::End);
        if edge == "shoulder" {
            reader.picture("walk", None);
        }
        reader.put_down();
        reader.drafter.key(Key::Home);
    }
}

fn is_clean_in_every_size(reader: &mut Reader) {
    let pattern = reader.drafter.pattern();
    let mut crossing = 0;
    for size in &pattern.sizes {
        let chosen = Command::SetSize {
            size: Some(size.name.clone()),
        };
        reader.drafter.window.state_mut().execute(chosen);
        reader.drafter.window.run();
        let findings = reader.drafter.window.state().findings();
        assert!(findings.is_empty(), "{}: {findings:?}", size.name);
        let project = Project {
            pattern: pattern.clone().into(),
            size: Some(size.name.clone()),
            ..Project::default()
        };
        let evaluation = Evaluation::new(&pattern, project.drafted_to());
        let (draft, found) = pattern.resolve(project.drafted_to());
        assert!(found.is_empty(), "{}: {found:?}", size.name);
        for seam in &draft.seams {
            let walk = Walk::new(&draft, seam).unwrap();
            for joint in walk.joints(evaluation.ease(seam.id)).into_iter().flatten() {
                let line = joint.line(&pattern, &draft);
                // A trued dart takes less than a tenth of a millimetre from the side.
                let told = (joint.smoothness(), joint.step.abs() < 1e-4);
                let kink = joint.kink.to_degrees();
                assert_eq!(
                    told,
                    (Smoothness::Smooth, true),
                    "{}: {line}, {kink}, {}",
                    size.name,
                    joint.step
                );
                crossing += 1;
            }
        }
    }
    // Neck and armhole across both shoulders, armhole and hem across both sides, neck and hem across
    // the centre back, the side across both darts.
    assert_eq!(crossing, 3 * 12);
    let base = Command::SetSize {
        size: Some("S".into()),
    };
    reader.drafter.window.state_mut().execute(base);
    reader.drafter.window.run();
}

fn save(reader: &mut Reader, folder: &std::path::Path) {
    let file = folder.join("shift-dress.toile.json");
    reader.drafter.chord(Modifiers::COMMAND, Key::S);
    reader.look();
    reader.drafter.enter("File", &file.display().to_string());
    assert!(file.exists(), "{}", reader.drafter.status());
}

/// All sizes, then the marker.
fn lay(reader: &mut Reader) {
    reader.drafter.chord(Modifiers::SHIFT, Key::G);
    reader.picture("sizes", None);
    reader.drafter.chord(Modifiers::SHIFT, Key::G);

    let part = section("The marker");
    reader.drafter.key(Key::F10);
    for (size, count) in [("S", "1"), ("M", "1"), ("L", "0")] {
        let role = Role::SpinButton;
        let field = reader.drafter.window.get_by_role_and_label(role, size);
        let at = field.rect().center();
        reader.drafter.click(at);
        reader.drafter.typed(part.says(count));
    }
    reader.choose("for", "2 s");
    reader.drafter.press("Search marker");
    let laid = |drafter: &Drafter| !drafter.pattern().markers[0].placements.is_empty();
    reader.drafter.wait(laid);
    reader.drafter.window.run();
    let pattern = reader.drafter.pattern();
    let ordered: u32 = pattern.markers[0]
        .order
        .iter()
        .map(|row| row.quantity)
        .sum();
    assert_eq!((ordered, pattern.markers[0].placements.len()), (2, 6));
    let state = &reader.drafter.window.state().marker_view().state;
    assert!(
        state.overlaps.is_empty() && state.outside.is_empty(),
        "{state:?}"
    );
    reader.picture("marker", None);
    reader.drafter.key(Key::F10);
}

fn print(reader: &mut Reader, folder: &std::path::Path) {
    let paper = folder.join("shift-dress.pdf");
    reader.drafter.chord(Modifiers::COMMAND, Key::P);
    reader.choose("Size", "all, a layer each");
    for (name, is_last) in [("shift-dress.pdf", false), (paper.to_str().unwrap(), true)] {
        let field = reader
            .drafter
            .window
            .get_by_role_and_label(Role::TextInput, "File");
        let at = field.rect().center();
        reader.drafter.click(at);
        reader.drafter.chord(Modifiers::COMMAND, Key::A);
        reader.drafter.type_text(name);
        if is_last {
            reader.drafter.key(Key::Enter);
        } else {
            let dialog = Rect::from_min_max(pos2(340.0, 230.0), pos2(860.0, 560.0));
            reader.picture("print", Some(dialog));
        }
    }
    reader.drafter.wait(|_| paper.exists());
    reader.drafter.key(Key::F4);
    reader.look();
    reader.drafter.key(Key::F4);
    reader.drafter.chord(Modifiers::COMMAND, Key::E);
    reader.look();
    reader.drafter.key(Key::Escape);
}

/// Somebody else tries it on, and it is worn with nothing.
fn try_on(reader: &mut Reader) {
    reader.put_down();
    reader.drafter.key(Key::F3);
    reader.look();
    reader.drafter.press("Man");
    let figure = |reader: &Reader| reader.drafter.window.state().session().project().figure();
    assert_eq!(figure(reader), Figure::Man);
    reader.drafter.chord(Modifiers::COMMAND, Key::Z);
    assert_eq!(figure(reader), Figure::Woman);
    reader.drafter.chord(Modifiers::SHIFT, Key::F3);
    reader.look();
    reader.drafter.key(Key::F8);
}

fn wear(reader: &mut Reader) {
    reader.put_down();
    reader.drafter.key(Key::F7);
    reader.choose("Cloth", "coarse");
    reader.drafter.key(Key::F5);
    let hangs = |drafter: &Drafter| drafter.window.state().session().draped().is_some();
    reader.drafter.wait(hangs);
    let draped = reader.drafter.window.state().session().draped().unwrap();
    assert_eq!((draped.body_intersections, draped.components), (0, 1));
    reader.drafter.key(Key::Home);
    reader.picture("window", None);
    let mut sides = Vec::new();
    for key in [Key::Num1, Key::Num3, Key::Num2] {
        reader.drafter.key(key);
        reader.drafter.window.run_steps(4);
        let view = reader
            .drafter
            .window
            .get_by_label_contains("3D view")
            .rect();
        let view = view.shrink2(vec2(10.0, 0.19 * view.height()));
        if reader.screens.is_some() {
            sides.push(Part::of(&mut reader.drafter.window, Some(view)));
        }
    }
    reader.shown.insert("drape");
    if let Some(screens) = &reader.screens {
        screens.write("drape", &sides, Colours::All);
    }
    reader.drafter.chord(Modifiers::COMMAND, Key::K);
    reader.drafter.type_text("dart");
    let field = "Find a command, a part, a variable or a measurement";
    let dialog = reader
        .drafter
        .window
        .get_by_role_and_label(Role::TextInput, field);
    let dialog = dialog.rect().expand2(vec2(40.0, 60.0));
    let dialog = dialog.with_max_y(dialog.bottom() + 160.0);
    reader.picture("find", Some(dialog));
    reader.drafter.key(Key::Escape);
    reader.drafter.chord(Modifiers::COMMAND, Key::K);
    reader.drafter.enter(field, "dark or light");
    reader.drafter.window.run();
    reader.picture("dark", None);
    reader.drafter.chord(Modifiers::COMMAND, Key::K);
    reader.drafter.enter(field, "dark or light");
}

/// Half of the dart goes to the hem, and back again.
fn alter(reader: &mut Reader) {
    let part = section("Altering a pattern");
    let before = reader.drafter.pattern();
    reader.put_down();
    reader.drafter.key(Key::F7);
    reader.drafter.key(Key::Home);
    reader.drafter.chord(Modifiers::SHIFT, Key::E);
    let dart = reader.drafter.part("Dart of front");
    reader.drafter.click(dart);
    reader.edge("front", "hem");
    reader.drafter.typed(part.says("0.5"));
    assert_eq!(reader.drafter.window.state().fault(), None);
    reader.look();
    reader.put_down();
    reader.drafter.key(Key::Home);
    let pattern = reader.drafter.pattern();
    let front = pattern.panel_named("front").unwrap();
    let stage = reader
        .drafter
        .evaluation()
        .last_stage(front)
        .unwrap()
        .clone();
    // Of both darts each half of the front has one.
    assert_eq!((front.operations.len(), stage.darts.len()), (3, 4));
    assert!(reader.drafter.evaluation().diagnostics().is_empty());
    reader.picture("pivot", None);
    reader.drafter.chord(Modifiers::COMMAND, Key::Z);
    assert!(reader.drafter.pattern().says_the_same(&before));
}

/// What the guide prints bold is a command, a menu or stood in the window; the pictures it shows are
/// those that were made.
fn says_what_is_there(reader: &Reader) {
    let mut unknown = Vec::new();
    for name in text::bold() {
        let known = reader.seen.contains(name) || toile_ui::named(name).is_some();
        if !known {
            unknown.push(name);
        }
    }
    assert!(unknown.is_empty(), "the guide names {unknown:?}");
    let told: BTreeSet<&str> = text::pictures().into_iter().collect();
    assert_eq!(told, reader.shown);
}
