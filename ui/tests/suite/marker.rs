//! Markers in the window: made, searched for, moved, locked, undone.

use egui::{Key, Modifiers, Pos2, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use toile_geometry::{Polygon, PreparedPolygon, Vec2};
use toile_pattern::{Marker, PiecePlacement};
use toile_session::Command;
use toile_ui::{Beginning, ToileApp};

type Window = Harness<'static, ToileApp>;

fn window() -> Window {
    window_of("t-shirt", 1400.0)
}

fn window_of(pattern: &str, width: f32) -> Window {
    let file = format!("../patterns/{pattern}.toile.json");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let mut window = Harness::builder()
        .with_size(vec2(width, 1000.0))
        .with_theme(egui::Theme::Light)
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
    window
}

fn marker(window: &Window) -> Arc<Marker> {
    window.state().session().project().pattern.markers[0].clone()
}

fn press(window: &mut Window, key: Key) {
    window.key_press(key);
    window.run_ok();
}

/// Where a piece is seen.
fn piece(window: &Window, name: &str) -> Pos2 {
    let found = window.get_by_role_and_label(Role::Button, name);
    found.rect().center()
}

fn drag(window: &mut Window, from: Pos2, by: egui::Vec2) {
    window.hover_at(from);
    window.run_ok();
    window.drag_at(from);
    window.run_ok();
    window.hover_at(from + by * 0.5);
    window.run_ok();
    window.hover_at(from + by);
    window.run_ok();
    window.drop_at(from + by);
    window.run_ok();
}

fn drag_with_alt(window: &mut Window, from: Pos2, by: egui::Vec2) {
    window.event(egui::Event::ModifiersChanged(Modifiers::ALT));
    drag(window, from, by);
    window.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    window.run_ok();
}

#[test]
fn a_marker_is_searched_for_moved_locked_and_undone() {
    let mut window = window();
    press(&mut window, Key::F10);
    let made = marker(&window);
    assert!(made.placements.is_empty());
    assert_eq!(made.order.len(), 1);

    // Everything waits: a search lays it all.
    window.key_press_modifiers(Modifiers::SHIFT, Key::F10);
    window.run_ok();
    let begun = Instant::now();
    while marker(&window).placements.is_empty() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
        window.run_ok();
    }
    let found = marker(&window);
    assert_eq!(found.placements.len(), 4, "front, back and two sleeves");
    let state = window.state().marker_view().state.clone();
    assert!(
        state.overlaps.is_empty() && state.outside.is_empty(),
        "{state:?}"
    );
    assert_eq!((state.laid, state.waiting), (4, 0));
    assert!(state.efficiency > 0.5, "{state:?}");
    window.run_ok();

    // A piece let go over another goes back.
    let steps = window.state().session().past().len();
    let [front, back] = ["Piece front", "Piece back"].map(|name| piece(&window, name));
    drag(&mut window, front, (back - front) * 0.8);
    assert_eq!(window.state().session().past().len(), steps);
    assert_eq!(marker(&window).placements, found.placements);
    assert!(window.query_by_label_contains("hold Alt").is_some());
    // With Alt it stays: one step of the history, and it is said to overlap.
    drag_with_alt(&mut window, front, (back - front) * 0.8);
    assert_eq!(window.state().session().past().len(), steps + 1);
    assert_ne!(marker(&window).placements, found.placements);
    assert!(!window.state().marker_view().state.overlaps.is_empty());
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_ok();
    assert_eq!(marker(&window).placements, found.placements);
    assert!(window.state().marker_view().state.overlaps.is_empty());

    // Escape leaves a drag: nothing of it is taken.
    let at = piece(&window, "Piece front");
    window.hover_at(at);
    window.run_ok();
    window.drag_at(at);
    window.run_ok();
    window.hover_at(at + vec2(60.0, 30.0));
    window.run_ok();
    press(&mut window, Key::Escape);
    window.drop_at(at + vec2(60.0, 30.0));
    window.run_ok();
    assert_eq!(marker(&window).placements, found.placements);
    assert_eq!(window.state().session().past().len(), steps);

    // A locked piece stays.
    let front = piece(&window, "Piece front");
    window.hover_at(front);
    window.run_ok();
    window.drag_at(front);
    window.drop_at(front);
    window.run_ok();
    press(&mut window, Key::L);
    let locked = |placements: &[PiecePlacement]| placements.iter().filter(|p| p.locked).count();
    assert_eq!(locked(&marker(&window).placements), 1);
    let before = marker(&window);
    drag(&mut window, front, vec2(40.0, 0.0));
    assert_eq!(marker(&window), before);
    // It is taken off only when it is free again.
    press(&mut window, Key::L);
    press(&mut window, Key::Delete);
    assert_eq!(marker(&window).placements.len(), 3);
    assert_eq!(window.state().marker_view().state.waiting, 1);
}

/// The name and the width of the fabric that the marker lies on.
fn lies_on(window: &mut Window) -> (String, f64) {
    let project = window.state().session().project().clone();
    let marker = marker(window);
    let fabric = project
        .pattern
        .marker_fabric(&marker, &project.garment_cloth());
    let fabric = fabric.unwrap();
    (fabric.name, fabric.width)
}

fn execute(window: &mut Window, command: Command) {
    window.state_mut().execute(command);
    window.run_ok();
}

/// Takes something from a list.
fn choose(window: &mut Window, list: &str, choice: &str) {
    window.get_by_role_and_label(Role::ComboBox, list).click();
    window.run_ok();
    window.get_by_label(choice).click();
    window.run_ok();
}

#[test]
fn the_marker_lies_on_the_cloth_of_the_garment_and_what_it_keeps_is_mended_by_a_button() {
    let mut window = window();
    press(&mut window, Key::F10);
    let before = lies_on(&mut window);
    let fabric = Some("denim".to_owned());
    execute(&mut window, Command::SetFabric { fabric });
    assert_eq!(lies_on(&mut window), ("denim".to_owned(), 1.5));
    let shown = window.get_by_role_and_label(Role::ComboBox, "Lies on");
    assert_eq!(shown.value().as_deref(), Some("denim"));
    execute(&mut window, Command::SetWidth { width: Some(1.2) });
    assert_eq!(window.state().marker_view().cloth().size().y, 1.2);

    // It may keep its own, which is told as long as it is so.
    choose(&mut window, "Lies on", &format!("always {}", before.0));
    assert_eq!(lies_on(&mut window), before);
    let told = format!(
        "The marker stays on {}, and the garment is cut from denim",
        before.0
    );
    assert!(window.query_by_label_contains(&told).is_some());
    window.get_by_label("Lay on denim").click();
    window.run_ok();
    assert_eq!(lies_on(&mut window), ("denim".to_owned(), 1.2));
    assert!(window.query_by_label_contains("The marker stays").is_none());

    // One step back each.
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_ok();
    assert_eq!(lies_on(&mut window), before);
}

#[test]
fn words_never_move_the_fabric_of_the_marker() {
    let mut window = window();
    press(&mut window, Key::F10);
    // Other words, the same fabric at the same scale; only its length is that of what lies on it.
    let place = |window: &Window| {
        let seen = window.state().marker_view().seen_cloth();
        (seen.left_top(), seen.height())
    };
    let seen = window.state().marker_view().seen_cloth();
    let before = place(&window);
    let front = window.get_by_role_and_label(Role::Button, "Waiting piece front");
    let from = front.rect().center();
    drag(&mut window, from, seen.center() - from);
    let words = |window: &Window| {
        let told = window.query_by_label_contains("% used");
        told.map_or_else(String::new, |line| line.value().unwrap_or_default())
    };
    let first = words(&window);
    assert_eq!(place(&window), before, "{first}");
    let at = piece(&window, "Piece front");
    drag(&mut window, at, vec2(-100.0, 30.0));
    assert_ne!(words(&window), first);
    assert_eq!(place(&window), before, "{}", words(&window));
}

/// Searches until all is laid.
fn search(window: &mut Window) {
    window.key_press_modifiers(Modifiers::SHIFT, Key::F10);
    window.run_ok();
    let begun = Instant::now();
    while marker(window).placements.is_empty() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
        window.run_ok();
    }
    window.run_ok();
}

/// The outlines of the pieces that are laid, by name.
fn outlines(window: &Window) -> Vec<(String, PreparedPolygon)> {
    let id = marker(window).id;
    let mut session = window.state().session().snapshot_to_export();
    let laid = session.marker(id).unwrap();
    let outline = |piece: toile_session::LaidPiece<'_>| {
        let outline: Polygon = piece.cut.polygon().mapped(|at| piece.pose.apply(at));
        (piece.name.to_owned(), PreparedPolygon::new(&outline))
    };
    laid.laid().map(outline).collect()
}

/// The least distance of a piece to all others, once it is moved (m).
fn apart(all: &[(String, PreparedPolygon)], name: &str, by: Vec2) -> f64 {
    let own = all.iter().find(|(own, _)| own == name).unwrap();
    let moved = PreparedPolygon::new(&own.1.polygon().translated(by));
    let others = all.iter().filter(|(other, _)| other != name);
    let distances = others.map(|(_, other)| other.distance(&moved));
    distances.fold(f64::INFINITY, f64::min)
}

#[test]
fn a_piece_let_go_beside_another_lies_against_it_at_the_gap() {
    let mut window = window();
    press(&mut window, Key::F10);
    search(&mut window);
    // Room for pieces beyond the end.
    let at = piece(&window, "Piece front");
    let seen = window.state().marker_view().seen_cloth();
    let scale = f64::from(seen.height()) / window.state().marker_view().cloth().size().y;
    window.hover_at(at);
    for (near, with_alt) in [(0.008, false), (0.004, false), (0.008, true)] {
        let all = outlines(&window);
        // So far to the right that the others are so near.
        let (mut low, mut high) = (0.0, 4.0);
        for x in [3.0, 2.0, 1.0] {
            if apart(&all, "front", Vec2::new(x, 0.0)) > near {
                high = x;
            }
        }
        while high - low > 1e-6 {
            let middle: f64 = 0.5 * (low + high);
            match apart(&all, "front", Vec2::new(middle, 0.0)) > near {
                true => high = middle,
                false => low = middle,
            }
        }
        let steps = window.state().session().past().len();
        let way = vec2((high * scale) as f32, 0.0);
        let from = piece(&window, "Piece front");
        match with_alt {
            true => drag_with_alt(&mut window, from, way),
            false => drag(&mut window, from, way),
        }
        assert_eq!(window.state().session().past().len(), steps + 1);
        let all = outlines(&window);
        let gap = marker(&window)
            .cloth
            .gap
            .unwrap_or(toile_pattern::DEFAULT_GAP);
        let lies = apart(&all, "front", Vec2::zeros());
        match with_alt {
            true => assert!((lies - near).abs() < 1e-3, "{lies}"),
            false => assert!((lies - gap).abs() < 1e-9, "{lies}"),
        }
        window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        window.run_ok();
    }
}

#[test]
fn every_piece_keeps_its_name_and_no_name_lies_over_another() {
    let mut window = window_of("dress", 900.0);
    press(&mut window, Key::F10);
    search(&mut window);
    let names = window.state().marker_view().names().to_vec();
    assert!(names.iter().any(|name| name.led_to.is_some()), "{names:?}");
    for (k, name) in names.iter().enumerate() {
        for other in &names[..k] {
            assert!(!name.rect.intersects(other.rect), "{name:?} {other:?}");
        }
    }
    let laid = marker(&window).placements.len();
    assert_eq!(names.len(), laid, "{names:?}");
}

#[test]
fn what_a_search_has_is_seen_while_it_goes_on() {
    let mut window = window();
    press(&mut window, Key::F10);
    let base = window.state().session().snapshot_to_export().evaluation();
    let made = marker(&window);
    let order = made.order.iter().map(|ordered| toile_pattern::OrderedSize {
        quantity: 8,
        ..*ordered
    });
    let edits = toile_pattern::plan::set_marker_order(&base, made.id, order.collect()).unwrap();
    let label = "Set order".to_owned();
    execute(&mut window, Command::Edit { edits, label });
    window.key_press_modifiers(Modifiers::SHIFT, Key::F10);
    window.run_ok();
    let begun = Instant::now();
    while window.state().marker_view().state.laid == 0 && begun.elapsed() < Duration::from_secs(60)
    {
        std::thread::sleep(Duration::from_millis(5));
        window.run_ok();
    }
    // It is only seen: the document has it once the search is stopped.
    assert!(marker(&window).placements.is_empty());
    assert_eq!(window.state().marker_view().state.laid, 32);
    window.get_by_label("Stop search").click();
    window.run_ok();
    while marker(&window).placements.is_empty() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
        window.run_ok();
    }
    assert_eq!(marker(&window).placements.len(), 32);
    assert_eq!(window.state().marker_view().state.waiting, 0);
}

/// A marker of a size says that the garment is made for somebody else, and a button orders the wearer's.
#[test]
fn a_marker_of_a_size_beside_a_garment_of_a_wearer_is_mended_by_a_button() {
    let mut window = window();
    press(&mut window, Key::F10);
    let medium = marker(&window).order[0].size;
    assert!(medium.is_some());
    assert!(window.query_by_label("The wearer\u{2019}s").is_none());
    execute(
        &mut window,
        Command::SetBody {
            figure: Some(toile_session::Figure::Woman),
            measurements: None,
        },
    );
    window.run_ok();
    let said = "is of size M, and the garment is made for";
    assert!(window.query_by_label_contains(said).is_some());
    window.get_by_label("Order the wearer\u{2019}s").click();
    window.run_ok();
    let ordered = marker(&window).order.clone();
    assert_eq!((ordered.len(), ordered[0].size), (1, None));
    assert!(window.query_by_label_contains(said).is_none());
    assert!(window.query_by_label("The wearer\u{2019}s").is_some());

    // A new one is the wearer's from the start.
    window.get_by_label("New marker").click();
    window.run_ok();
    let markers = &window.state().session().project().pattern.markers;
    assert_eq!(markers[1].order[0].size, None);
}
