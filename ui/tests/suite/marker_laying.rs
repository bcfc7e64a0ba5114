//! How a marker is laid, in the window: its rolls, and rules for single pieces.

use egui::{Key, Modifiers, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use toile_pattern::{Marker, Pattern, PieceRule, RuledPieces, Turn};
use toile_session::{Command, Session, Silent};
use toile_ui::{Beginning, ToileApp};

type Window = Harness<'static, ToileApp>;

const SHIRT: &str = include_str!("../../../patterns/t-shirt.toile.json");

/// A window with the shirt and an empty marker of it, its fields shown.
fn window() -> Window {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../patterns/t-shirt.toile.json");
    let mut window = Harness::builder()
        .with_size(vec2(1600.0, 1100.0))
        .with_max_steps(8)
        .with_step_dt(1.0 / 60.0)
        .build_eframe(move |creation| {
            let beginning = Beginning {
                file: Some(file.clone()),
                folder: None,
            };
            let state = creation.wgpu_render_state.as_ref();
            ToileApp::new(&creation.egui_ctx, state, beginning)
        });
    window.run_ok();
    window.key_press(Key::F10);
    window.run_ok();
    press(&mut window, "Rolls and rules");
    window
}

fn marker(window: &Window) -> Arc<Marker> {
    window.state().session().project().pattern.markers[0].clone()
}

fn steps(window: &Window) -> usize {
    window.state().session().past().len()
}

fn press(window: &mut Window, button: &str) {
    window.get_by_label(button).click();
    window.run_ok();
}

fn tick(window: &mut Window, name: &str) {
    window.get_by_role_and_label(Role::CheckBox, name).click();
    window.run_ok();
}

fn enter(window: &mut Window, field: &str, text: &str) {
    window.get_by_role_and_label(Role::TextInput, field).click();
    window.run_ok();
    window.event(egui::Event::Text(text.into()));
    window.run_ok();
    window.key_press(Key::Enter);
    window.run_ok();
}

fn choose(window: &mut Window, list: &str, choice: &str) {
    window.get_by_role_and_label(Role::ComboBox, list).click();
    window.run_ok();
    window.get_by_label(choice).click();
    window.run_ok();
}

/// Selects a piece by a click on it.
fn select(window: &mut Window, name: &str) {
    let at = window.get_by_role_and_label(Role::Button, name).rect();
    window.hover_at(at.center());
    window.run_ok();
    window.drag_at(at.center());
    window.drop_at(at.center());
    window.run_ok();
}

fn undo(window: &mut Window) {
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_ok();
}

/// The pattern of a file.
fn opened(path: &Path) -> Arc<Pattern> {
    let mut session = Session::new();
    let open = Command::open(path);
    let told = session.execute(open, &mut Silent).unwrap();
    let warned =
        |event: &toile_session::Event| matches!(event, toile_session::Event::Warned { .. });
    assert!(!told.iter().any(warned), "{told:?}");
    session.project().pattern.clone()
}

/// The shirt with a marker as it is written by hand.
fn by_hand(fields: &str) -> Arc<Pattern> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hand.toile.json");
    std::fs::write(&path, SHIRT).unwrap();
    let pattern = opened(&path);
    let front = pattern.panel_named("front").unwrap();
    let size = pattern.size_named("M").unwrap().id.0;
    let fields = fields.replace("FRONT", &front.id.0.to_string());
    let marker = format!(
        r#"{{"id": {0}, "name": "marker", "fabric": {1}, {fields}, "order": [{{"size": {size}, "quantity": 1}}]}}"#,
        pattern.ids.next, front.fabric.0
    );
    let end = SHIRT.find("\"next_id\"").unwrap();
    let next = pattern.ids.next + 1;
    let text = format!(
        "{}\"markers\": [{marker}],\n  \"next_id\": {next}\n}}\n",
        &SHIRT[..end]
    );
    std::fs::write(&path, text).unwrap();
    opened(&path)
}

#[test]
fn rolls_and_a_rule_are_given_laid_undone_and_saved() {
    let mut window = window();
    let begun = steps(&window);
    // Two rolls: each thing that is said is one step.
    press(&mut window, "Add roll");
    enter(&mut window, "Roll called", "remnant");
    enter(&mut window, "Roll length", "80 cm");
    enter(&mut window, "Roll width", "140");
    press(&mut window, "Add roll");
    assert_eq!(steps(&window), begun + 5);
    assert_eq!(window.state().marker_view().rolls, ["remnant", "roll 2"]);
    // A block and one direction for a piece.
    assert!(window.query_by_label("Block").is_none());
    select(&mut window, "Waiting piece front");
    assert!(window.query_by_label("Rule for front").is_some());
    enter(&mut window, "Block", "1");
    tick(&mut window, "180\u{b0}");
    assert_eq!(steps(&window), begun + 7);
    let given = marker(&window);
    let rolls = given.cloth.rolls.as_deref().unwrap();
    assert_eq!((rolls[0].length, rolls[0].width), (Some(0.8), Some(1.4)));
    let [PieceRule { pieces, rule, .. }] = &given.rules[..] else {
        panic!("{:?}", given.rules);
    };
    let front = window.state().session().project().pattern.clone();
    let front = front.panel_named("front").unwrap().id;
    assert_eq!(*pieces, RuledPieces::Panel(front));
    assert_eq!(rule.block, Some(0.01));
    assert_eq!(rule.turns.as_deref(), Some(&[Turn(0.0)][..]));

    // It is what one writes by hand.
    let hand = by_hand(
        r#""rolls": [{"name": "remnant", "width": 140, "length": 80}, {"length": 500}],
           "rules": [{"panel": FRONT, "block": 1, "turns": [0]}]"#,
    );
    assert_eq!(window.state().session().project().pattern, hand);

    // Laid: what the first has no room for lies on the second.
    window.key_press_modifiers(Modifiers::SHIFT, Key::F10);
    window.run_ok();
    let started = Instant::now();
    while marker(&window).placements.is_empty() && started.elapsed() < Duration::from_secs(90) {
        std::thread::sleep(Duration::from_millis(20));
        window.run_ok();
    }
    window.run_ok();
    let laid = marker(&window);
    assert_eq!(laid.placements.len(), 4, "front, back and two sleeves");
    let on = |roll: u16| {
        laid.placements
            .iter()
            .filter(|own| own.roll == roll)
            .count()
    };
    assert!(on(0) > 0 && on(1) > 0, "{:?}", laid.placements);
    let of_front = laid.placements.iter().find(|own| own.piece.panel == front);
    assert_eq!(of_front.unwrap().turn, 0.0);
    for (roll, name) in [(0, "remnant"), (1, "roll 2")] {
        press(&mut window, name);
        let view = window.state().marker_view();
        assert_eq!((view.roll, view.state.laid), (usize::from(roll), on(roll)));
        let faults = (view.state.overlaps.len(), view.state.outside.len());
        assert_eq!(faults, (0, 0), "{name}");
    }

    // Saved and opened it is the same.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shirt.toile.json");
    let save = Command::SavePattern { path: path.clone() };
    window.state_mut().execute(save);
    window.run_ok();
    assert_eq!(opened(&path).markers[0], laid);

    // Undone, one step each.
    for left in (begun..begun + 8).rev() {
        undo(&mut window);
        assert_eq!(steps(&window), left);
    }
    let empty = marker(&window);
    assert!(empty.placements.is_empty() && empty.rules.is_empty());
    assert_eq!(empty.cloth.rolls, None);
}

#[test]
fn how_the_fabric_lies_is_said_field_by_field() {
    let mut window = window();
    let begun = steps(&window);
    // What is typed is given, also where it is as by default; an empty field is open again.
    enter(&mut window, "Selvedge", "1");
    assert_eq!(marker(&window).cloth.selvedge, Some(0.01));
    enter(&mut window, "Gap", "5 mm");
    enter(&mut window, "Tilt", "2");
    enter(&mut window, "Repeat along", "6");
    choose(&mut window, "Spread", "face to face");
    choose(&mut window, "Nap", "all one way");
    assert_eq!(steps(&window), begun + 6);
    let now = window.state().session().project().pattern.clone();
    let hand = by_hand(
        r#""selvedge": 1, "gap": 0.5, "nap": "one-way", "tilt": 2, "spread": "face-to-face",
           "print": {"repeat": [6, 0]}"#,
    );
    assert_eq!(now.markers[0].cloth, hand.markers[0].cloth);
    enter(&mut window, "Gap", " ");
    assert_eq!(marker(&window).cloth.gap, None);
    // What no fabric can be laid by is refused where it is typed.
    press(&mut window, "Add roll");
    let before = marker(&window);
    enter(&mut window, "Roll length", "0");
    assert_eq!(marker(&window), before);
    press(&mut window, "Remove roll");
    assert!(marker(&window).cloth.rolls.is_none());
}
