//! The window without a window: used by its accessible names, needing neither display nor GPU.

use crate::garments;
use egui::accesskit::{Action, ActionRequest, TreeId};
use egui::{Key, Modifiers, Pos2, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use toile_pattern::{Evaluation, Pattern};
use toile_session::{Command, Session, Silent};
use toile_ui::{Beginning, Item, ToileApp};

type Window = Harness<'static, ToileApp>;

fn t_shirt() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../patterns/t-shirt.toile.json")
}

fn window(file: &Path) -> Window {
    begun(Beginning {
        file: Some(file.to_owned()),
        folder: None,
    })
}

fn begun(beginning: Beginning) -> Window {
    let mut window = Harness::builder()
        .with_size(vec2(1200.0, 800.0))
        .with_theme(egui::Theme::Light)
        .with_max_steps(20)
        .with_step_dt(1.0 / 60.0)
        .build_eframe(move |creation| {
            let state = creation.wgpu_render_state.as_ref();
            ToileApp::new(&creation.egui_ctx, state, beginning)
        });
    window.run();
    window
}

fn pattern(window: &Window) -> Pattern {
    (*window.state().session().project().pattern).clone()
}

/// The panels and seams, which undoing must restore exactly.
fn drawn(pattern: &Pattern) -> impl PartialEq + std::fmt::Debug + use<> {
    (pattern.panels.clone(), pattern.seams.clone())
}

/// The part that is selected alone.
fn selected(window: &Window) -> Option<Item> {
    window.state().view().selection.single()
}

fn place(window: &Window, name: &str) -> Pos2 {
    // The status line may say the same words; the part itself is a button.
    let part = window.get_by_role_and_label(Role::Button, name);
    part.rect().center()
}

fn press(window: &mut Window, name: &str) {
    window.get_by_label(name).click();
    window.run();
}

/// Types into the field of that name, and takes it.
fn enter(window: &mut Window, name: &str, text: &str) {
    window.get_by_role_and_label(Role::TextInput, name).focus();
    window.run();
    window.event(egui::Event::Text(text.into()));
    window.run();
    key(window, Key::Enter);
}

fn key(window: &mut Window, key: Key) {
    window.key_press(key);
    window.run();
}

fn click(window: &mut Window, at: Pos2) {
    window.hover_at(at);
    window.drag_at(at);
    window.drop_at(at);
    window.run();
}

/// Drags the pointer in several moves.
fn drag(window: &mut Window, from: Pos2, way: egui::Vec2) {
    window.hover_at(from);
    window.drag_at(from);
    window.run();
    for k in 1..=6 {
        window.hover_at(from + way * (k as f32 / 6.0));
        window.run();
    }
    window.drop_at(from + way);
    window.run();
}

fn point_at(window: &Window, panel: &str, point: &str) -> toile_geometry::Vec2 {
    let project = window.state().session().project();
    let panel = project.pattern.panel_named(panel).unwrap();
    let sheet = project.pattern.sheet(panel.sheet().unwrap()).unwrap();
    let id = sheet.point_named(point).unwrap().id;
    let evaluation = Evaluation::new(&project.pattern, project.drafted_to());
    evaluation.point(id).unwrap()
}

#[test]
fn the_t_shirt_opens_and_its_parts_have_names() {
    let window = window(&t_shirt());
    for name in [
        "Pattern view",
        "3D view",
        "Save",
        "Undo",
        "Redo",
        "Drape",
        "Point hem_centre of front",
        "Point tip of back",
        "Edge armhole of front",
        "No faults",
    ] {
        assert!(window.query_by_label(name).is_some(), "{name}");
    }
    assert_eq!(window.unnamed_widgets(), Vec::<String>::new());
    let disabled = |name| window.get_by_label(name).accesskit_node().is_disabled();
    assert!(disabled("Undo") && disabled("Redo") && disabled("Save"));
}

#[test]
fn a_point_is_dragged_and_undone_exactly() {
    let mut window = window(&t_shirt());
    let before = pattern(&window);
    let old = point_at(&window, "front", "hem_side");
    let scale = window.state().view().camera.scale;
    let start = place(&window, "Point hem_side of front");
    // With Ctrl it comes to no round number.
    window.event(egui::Event::ModifiersChanged(Modifiers::COMMAND));
    drag(&mut window, start, vec2(30.0, -18.0));
    window.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    let new = point_at(&window, "front", "hem_side");
    let way = (new - old) * scale;
    assert!(
        (way.x - 30.0).abs() < 0.01 && (way.y - 18.0).abs() < 0.01,
        "{way}"
    );
    let seen = place(&window, "Point hem_side of front");
    assert!((seen - start - vec2(30.0, -18.0)).length() < 0.5);
    assert_eq!(window.state().session().can_undo(), Some("Move point"));
    let after = pattern(&window);
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run();
    assert_eq!(drawn(&pattern(&window)), drawn(&before));
    assert_eq!(
        window.state().session().can_undo(),
        None,
        "a drag is one step"
    );
    assert!(!window.state().is_unsaved());
    window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    window.run();
    assert_eq!(drawn(&pattern(&window)), drawn(&after));
}

#[test]
fn a_drag_replays_from_the_journal() {
    let mut window = window(&t_shirt());
    let start = place(&window, "Point underarm of back");
    drag(&mut window, start, vec2(-25.0, 12.0));
    let session = window.state().session();
    let journal = session.journal();
    let edits = journal.iter().filter(|c| matches!(c, Command::Edit { .. }));
    assert_eq!(edits.count(), 1, "a drag is one command");
    let folder = tempfile::tempdir().unwrap();
    let again = Session::replay(&journal, folder.path(), &mut Silent);
    let (again, _) = again.unwrap();
    assert_eq!(*again.project().pattern, pattern(&window));
}

#[test]
fn shift_keeps_a_drag_level() {
    let mut window = window(&t_shirt());
    let old = point_at(&window, "front", "hem_side");
    let start = place(&window, "Point hem_side of front");
    window.event(egui::Event::ModifiersChanged(Modifiers::SHIFT));
    drag(&mut window, start, vec2(40.0, 9.0));
    let new = point_at(&window, "front", "hem_side");
    assert!(new.x > old.x + 0.01);
    assert_eq!(new.y, old.y);
}

/// How many corners the outline of the front has.
fn corners(pattern: &Pattern) -> usize {
    let front = pattern.panel_named("front").unwrap();
    front.outline().unwrap().edges.len()
}

#[test]
fn a_point_is_added_in_the_middle_of_an_edge_and_deleted() {
    let mut window = window(&t_shirt());
    let before = pattern(&window);
    let points = |window: &Window| corners(&pattern(window));
    let count = points(&window);
    let middle = place(&window, "Edge side of front");
    click(&mut window, middle + vec2(0.0, 30.0));
    assert!(matches!(selected(&window), Some(Item::Edge(..))));
    assert!(window.query_by_label_contains("sewn by seam").is_some());

    key(&mut window, Key::Insert);
    assert_eq!(points(&window), count + 1);
    let Some(Item::Point(point)) = selected(&window) else {
        panic!("the new point is selected");
    };
    let project = window.state().session().project();
    let (_, name) = project.pattern.point(point).unwrap();
    let label = format!("Point {} of front", name.name);
    assert!((place(&window, &label) - middle).length() < 1.0);

    key(&mut window, Key::Delete);
    assert_eq!(points(&window), count);
    assert_eq!(selected(&window), None);
    press(&mut window, "Undo");
    press(&mut window, "Undo");
    assert_eq!(drawn(&pattern(&window)), drawn(&before));
    assert!(!window.state().is_unsaved());
}

#[test]
fn a_double_click_divides_an_edge_there() {
    let mut window = window(&t_shirt());
    let count = corners(&pattern(&window));
    let at = place(&window, "Edge side of front") + vec2(0.0, 45.0);
    window.hover_at(at);
    for _ in 0..2 {
        window.drag_at(at);
        window.drop_at(at);
        window.hover_at(at);
    }
    window.run();
    assert_eq!(corners(&pattern(&window)), count + 1);
    let Some(Item::Point(_)) = selected(&window) else {
        panic!("the new point is selected");
    };
    window.key_press(Key::Delete);
    window.run();
    assert_eq!(corners(&pattern(&window)), count);
}

#[test]
fn arrow_keys_and_fields_move_the_selected_point() {
    let mut window = window(&t_shirt());
    let old = point_at(&window, "front", "tip");
    let at = place(&window, "Point tip of front");
    click(&mut window, at);
    window.key_press(Key::ArrowRight);
    window.run();
    window.key_press_modifiers(Modifiers::SHIFT, Key::ArrowUp);
    window.run();
    let new = point_at(&window, "front", "tip");
    assert!(
        (new - old - toile_geometry::Vec2::new(0.001, 0.01)).norm() < 1e-7,
        "{}",
        new - old
    );

    enter(&mut window, "x", "21,5");
    assert!((point_at(&window, "front", "tip").x - 0.215).abs() < 1e-7);
}

#[test]
fn a_screen_reader_can_select_a_point() {
    let mut window = window(&t_shirt());
    let node = window.get_by_role_and_label(Role::Button, "Point neck_centre of back");
    let request = ActionRequest {
        action: Action::Click,
        target_tree: TreeId::ROOT,
        target_node: node.accesskit_node().locate().0,
        data: None,
    };
    window.event(egui::Event::AccessKitActionRequest(request));
    window.run();
    assert!(matches!(selected(&window), Some(Item::Point(_))));
    window.key_press(Key::Escape);
    window.run();
    assert_eq!(selected(&window), None);
}

#[test]
fn the_table_is_panned_zoomed_and_fitted() {
    let mut window = window(&t_shirt());
    let name = "Point hem_side of front";
    let fitted = place(&window, name);
    window.hover_at(fitted);
    window.run();
    for delta in [120.0, 120.0, -60.0] {
        window.event(egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: vec2(0.0, delta),
            modifiers: Modifiers::NONE,
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Unknown,
        });
        window.run();
    }
    assert!(
        (place(&window, name) - fitted).length() < 1.0,
        "zoomed at the cursor"
    );
    let before = window.state().view().camera;
    let middle_button = |pressed| egui::Event::PointerButton {
        pos: fitted,
        button: egui::PointerButton::Middle,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.event(middle_button(true));
    window.hover_at(fitted + vec2(35.0, 20.0));
    window.run();
    assert!((place(&window, name) - fitted - vec2(35.0, 20.0)).length() < 1.0);
    assert_eq!(window.state().view().camera.scale, before.scale);
    window.event(middle_button(false));
    window.key_press(Key::F);
    window.run();
    assert!((place(&window, name) - fitted).length() < 1.0);
    assert!(
        window.state().session().can_undo().is_none(),
        "views are not undone"
    );
}

/// Runs frames until something holds: at most that many, and at most two minutes.
fn wait(window: &mut Window, frames: usize, holds: impl Fn(&Window) -> bool) -> bool {
    let start = Instant::now();
    for _ in 0..frames {
        window.step();
        if holds(window) {
            return true;
        }
        if start.elapsed() > Duration::from_secs(120) {
            return false;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    false
}

#[test]
fn drape_runs_live_is_held_goes_on_and_stops() {
    let mut window = window(&t_shirt());
    press(&mut window, "Drape");
    let shows_cloth = |window: &Window| window.state().stage().vertices() > 100;
    assert!(wait(&mut window, 6000, shows_cloth), "no cloth came");
    let steps = |window: &Window| window.query_by_label_contains("step ").is_some();
    assert!(wait(&mut window, 6000, steps), "no step came");
    assert!(
        window
            .query_by_label_contains("3D view, garment of")
            .is_some()
    );
    press(&mut window, "Pause");
    assert!(window.query_by_label_contains("Paused").is_some());
    press(&mut window, "Pause");
    assert!(window.query_by_label_contains("Paused").is_none());
    press(&mut window, "Stop");
    assert!(window.query_by_label_contains("Stopped").is_some());
    let start = place(&window, "Point hem_side of front");
    drag(&mut window, start, vec2(10.0, 0.0));
    let stands = |window: &Window| {
        let words = window.query_by_label_contains("Out of date: the drape was stopped");
        words.is_some() && window.state().stage().is_out_of_date()
    };
    assert!(wait(&mut window, 6000, stands), "not told out of date");
}

#[test]
fn a_garment_at_rest_is_the_sessions_until_the_pattern_changes() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = window(&garments::band(folder.path()));
    press(&mut window, "Drape");
    let made = |window: &Window| window.state().session().draped().is_some();
    assert!(wait(&mut window, 6000, made), "no garment came to rest");
    let session = window.state().session();
    assert_eq!(session.journal().last(), Some(&Command::drape()));
    let (mut exported, journal) = (session.snapshot(), session.journal().len());
    let dir = folder.path().join("out");
    exported
        .execute(Command::export(&dir), &mut Silent)
        .unwrap();
    assert!(dir.join("garment.glb").exists());
    // A garment of an older pattern is not taken.
    press(&mut window, "Drape");
    let start = place(&window, "Point a of front");
    drag(&mut window, start, vec2(-22.0, 0.0));
    assert!(window.state().is_unsaved());
    let ended = |window: &Window| {
        window
            .query_by_label("Pause")
            .unwrap()
            .accesskit_node()
            .is_disabled()
    };
    assert!(wait(&mut window, 6000, ended));
    let session = window.state().session();
    assert_eq!(session.draped(), None);
    assert!(!session.journal()[journal..].contains(&Command::drape()));
}

#[test]
fn files_that_cannot_be_opened_say_so_in_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let rubbish = folder.path().join("rubbish.json");
    std::fs::write(&rubbish, "{ \"panels\": [ 12").unwrap();
    let missing = folder.path().join("missing.json");
    for file in [&rubbish, &missing, &folder.path().to_path_buf()] {
        let mut window = window(file);
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        assert!(
            window
                .query_by_label("This pattern cannot be opened")
                .is_some()
        );
        assert!(window.query_by_label_contains(&name).is_some(), "{name}");
        window.key_press(Key::D);
        window.key_press(Key::Delete);
        window.run();
        assert!(window.state().session().project().pattern.panels.is_empty());
    }
}

#[test]
fn closing_asks_before_changes_are_lost() {
    let close = |window: &mut Window| {
        let root = window
            .input_mut()
            .viewports
            .get_mut(&egui::ViewportId::ROOT);
        root.unwrap().events.push(egui::ViewportEvent::Close);
        window.step();
        window.run();
    };
    let question = "Save the changes?";
    let mut window = window(&t_shirt());
    close(&mut window);
    assert!(window.query_by_label(question).is_none());
    let start = place(&window, "Point hem_side of front");
    drag(&mut window, start, vec2(22.0, 0.0));
    close(&mut window);
    assert!(window.query_by_label(question).is_some());
    press(&mut window, "Keep working");
    assert!(window.query_by_label(question).is_none());
    assert!(window.state().is_unsaved());
}

#[test]
fn faults_are_listed_and_lead_to_their_place() {
    let mut window = window(&t_shirt());
    let start = place(&window, "Point hem_side of front");
    drag(&mut window, start, vec2(0.0, -60.0));
    assert!(window.query_by_label("No faults").is_none());
    let counts = ["1 fault", "1 warning", "2 faults", "2 warnings"];
    let count = counts
        .iter()
        .find(|name| window.query_by_label(name).is_some());
    press(&mut window, count.unwrap());
    let found = window.state().findings().first().unwrap().to_string();
    assert!(
        window.query_all_by_label_contains(&found).count() >= 1,
        "{found}"
    );
    press(&mut window, "Undo");
    assert!(window.query_by_label("No faults").is_some());
}

#[test]
fn patterns_of_other_programs_open() {
    let shared = std::env::var_os("TOILE_SHARED").map(|folder| PathBuf::from(folder).join("data"));
    let data = shared.or_else(|| {
        let mut folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
        folders.find_map(|folder| Some(folder.join("shared/data")).filter(|data| data.is_dir()))
    });
    let file = data.map(|data| data.join("garmentcode/shirt_mean_specification.json"));
    let Some(file) = file.filter(|file| file.is_file()) else {
        println!("skipped: no folder of samples");
        return;
    };
    let window = window(&file);
    for name in ["right_ftorso", "left_sleeve_b"] {
        let parts = format!(" of {name}");
        let count = window.query_all_by_label_contains(&parts).count();
        assert!(count > 6, "{name}: {count}");
    }
    assert!(window.query_by_label_contains("No faults").is_some());
}

#[test]
fn saving_writes_a_file_that_opens_again() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toile.json");
    std::fs::copy(t_shirt(), &file).unwrap();
    let mut window = window(&file);
    let start = place(&window, "Point hem_side of front");
    drag(&mut window, start, vec2(22.0, 0.0));
    assert!(window.state().is_unsaved());
    press(&mut window, "Save");
    assert!(!window.state().is_unsaved());
    assert!(window.query_by_label_contains("Saved").is_some());
    let again = self::window(&file);
    assert_eq!(drawn(&pattern(&again)), drawn(&pattern(&window)));
}

#[test]
fn panning_makes_nothing_anew_and_zooming_evaluates_nothing() {
    let mut window = window(&t_shirt());
    let seen = |window: &Window| {
        let app = window.state();
        let scene = &app.view().scene;
        (scene.made(), scene.octave(), app.session().revision())
    };
    let before = seen(&window);
    let view = window.get_by_label("Pattern view").rect();
    let middle = view.center();
    let camera = window.state().view().camera;
    for k in 0..20 {
        let at = middle + vec2(k as f32 * 3.0, 2.0);
        window.event(egui::Event::PointerMoved(at));
        if k == 0 || k == 19 {
            window.event(egui::Event::PointerButton {
                pos: at,
                button: egui::PointerButton::Middle,
                pressed: k == 0,
                modifiers: Modifiers::NONE,
            });
        }
        window.run();
    }
    assert_eq!(seen(&window), before);
    assert_ne!(window.state().view().camera, camera);
    let camera = window.state().view().camera;
    window.hover_at(middle);
    window.run();
    // Within an octave nothing is made anew; beyond it lines are, and nothing is evaluated.
    for _ in 0..6 {
        let (made, octave, revision) = seen(&window);
        window.key_press(Key::Plus);
        window.run();
        let now = seen(&window);
        assert_eq!(now.2, revision);
        assert_eq!(now.1 == octave, now.0 == made);
    }
    assert!(window.state().view().camera.scale > camera.scale * 2.0);
    assert_ne!(seen(&window).0, before.0);
}

#[test]
fn a_number_begun_in_a_tool_is_no_command() {
    let mut window = window(&t_shirt());
    let view = window.get_by_label("Pattern view").rect();
    window.key_press(Key::P);
    window.run();
    window.hover_at(view.center());
    window.run();
    let scale = window.state().view().camera.scale;
    window.event(egui::Event::Text("0".into()));
    window.key_press(Key::Num0);
    window.run();
    assert_eq!(window.state().view().camera.scale, scale);
    assert!(window.state().view().is_typing());
    // Put down, the same key shows everything in its true size.
    for _ in 0..3 {
        window.key_press(Key::Escape);
        window.run();
    }
    window.key_press(Key::Num0);
    window.run();
    let scale = window.state().view().camera.scale;
    assert!((scale - 96.0 / 0.0254).abs() < 1e-6, "{scale}");
}

#[test]
fn a_panel_is_shown_alone_and_with_the_others_again() {
    let mut window = window(&t_shirt());
    let sleeve = place(&window, "Panel sleeve");
    window.hover_at(sleeve);
    window.drag_at(sleeve);
    window.drop_at(sleeve);
    window.run();
    let shown = |window: &Window| window.state().view().scene.panels.len();
    assert_eq!(shown(&window), 3);
    window.key_press(Key::Period);
    window.run();
    assert_eq!(shown(&window), 1);
    assert!(window.query_by_label("Panel front").is_none());
    window.key_press(Key::Period);
    window.run();
    assert_eq!(shown(&window), 3);
}
