//! Room for the drawing: its share of the window with garment and tables open, on screens of several sizes; and
//! the parts round it, where a person puts them.

use egui::{Key, Modifiers, Rect, Role, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};
use toile_pattern::plan;
use toile_session::Command;
use toile_ui::{Beginning, ToileApp};

type Window = Harness<'static, ToileApp>;

fn dress() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../patterns/dress.toile.json")
}

/// A window of so many logical pixels with the dress in it.
fn opened(size: [f32; 2], folder: Option<&Path>) -> Window {
    opened_file(dress(), size, folder)
}

/// The same with another pattern.
fn opened_file(file: PathBuf, size: [f32; 2], folder: Option<&Path>) -> Window {
    let beginning = Beginning {
        file: Some(file),
        folder: folder.map(Path::to_owned),
    };
    let mut window: Window = Harness::builder()
        .with_size(vec2(size[0], size[1]))
        .with_theme(egui::Theme::Light)
        .with_max_steps(20)
        .with_step_dt(1.0 / 60.0)
        .build_eframe(move |creation| ToileApp::new(&creation.egui_ctx, None, beginning));
    window.run_ok();
    window
}

fn key(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run_ok();
}

fn canvas(window: &Window) -> Rect {
    window
        .get_by_role_and_label(Role::Canvas, "Pattern view")
        .rect()
}

fn share(window: &Window, size: [f32; 2]) -> f32 {
    canvas(window).area() / (size[0] * size[1])
}

#[test]
fn the_drawing_has_its_share_of_the_window_with_garment_and_tables_open() {
    // A screen of 2560 x 1440 at a scale of 2 has 1280 x 720 logical pixels.
    let screens = [
        ([1280.0, 800.0], 0.45),
        ([1920.0, 1080.0], 0.60),
        ([2560.0, 1440.0], 0.60),
        ([1280.0, 720.0], 0.42),
    ];
    for (size, least) in screens {
        let mut window = opened(size, None);
        key(&mut window, Modifiers::NONE, Key::F8);
        assert!(window.query_by_label_contains("3D view").is_some());
        assert!(window.query_by_label("Add size").is_some());
        let share = share(&window, size);
        assert!(share >= least, "{size:?}: {share:.3} of {least}");
        // What is selected lies over the table, and takes nothing from it.
        let before = canvas(&window);
        window.get_by_label("Panel front skirt").click();
        window.run_ok();
        assert_eq!(canvas(&window), before);
        let name = window.get_by_role_and_label(Role::TextInput, "Name").rect();
        assert!(
            before.contains_rect(name),
            "{size:?}: {name:?} beside {before:?}"
        );
        key(&mut window, Modifiers::NONE, Key::Escape);
        let name = window.query_by_role_and_label(Role::TextInput, "Name");
        assert!(name.is_none(), "{size:?}: nothing is selected");
    }
}

/// The inspector goes to the other corner where it would lie on what is selected.
#[test]
fn what_is_selected_is_not_covered_by_its_inspector() {
    let size = [900.0, 700.0];
    let mut window = opened(size, None);
    for name in ["Panel front skirt", "Panel back skirt", "Panel front skirt"] {
        let at = window.get_by_label(name).rect().center();
        window.get_by_label(name).click();
        window.run_ok();
        let field = window.get_by_role_and_label(Role::TextInput, "Name").rect();
        let beside = field.left() > at.x || field.right() < at.x;
        assert!(beside, "{name} at {at:?} under {field:?}");
        key(&mut window, Modifiers::NONE, Key::Escape);
    }
}

#[test]
fn tables_stand_where_they_were_dragged_and_are_there_the_next_time() {
    let folder = tempfile::tempdir().unwrap();
    let size = [1700.0, 900.0];
    let mut window = opened(size, Some(folder.path()));
    key(&mut window, Modifiers::NONE, Key::F8);
    let is_beside = |window: &Window| {
        let table = window.get_by_label("Add size").rect();
        table.left() >= canvas(window).right()
    };
    assert!(is_beside(&window));
    let drag = |window: &mut Window, to: egui::Pos2| {
        let handle = window.get_by_label("Move tables").rect().center();
        window.hover_at(handle);
        window.drag_at(handle);
        window.run_ok();
        window.hover_at(handle + (to - handle) * 0.5);
        window.run_ok();
        window.hover_at(to);
        window.run_ok();
        window.drop_at(to);
        window.run_ok();
    };
    drag(&mut window, pos2(300.0, 860.0));
    assert!(!is_beside(&window));
    let below = window.get_by_label("Add size").rect();
    assert!(below.top() >= canvas(&window).bottom());
    let again = opened(size, Some(folder.path()));
    assert!(!is_beside(&again), "where they were put is not remembered");
    drag(&mut window, pos2(1600.0, 300.0));
    assert!(is_beside(&window));
    key(&mut window, Modifiers::SHIFT, Key::F8);
    assert!(!is_beside(&window));
}

#[test]
fn tools_are_signs_and_a_key_brings_their_names() {
    let mut window = opened([1280.0, 800.0], None);
    let width = |window: &Window| window.get_by_label("Fisheye dart").rect().width();
    assert!(width(&window) <= 44.0);
    let narrow = canvas(&window);
    key(&mut window, Modifiers::NONE, Key::F2);
    assert!(width(&window) > 120.0);
    assert!(canvas(&window).width() < narrow.width());
    // Every tool is seen without scrolling on the smallest of the screens.
    for window in [window, opened([1280.0, 720.0], None)] {
        for tool in ["Select", "Point", "Grain", "Walk seam"] {
            let at = window.get_by_label(tool).rect();
            assert!(
                at.bottom() <= window.get_by_label("No faults").rect().top(),
                "{tool} at {at:?}"
            );
        }
    }
}

#[test]
fn the_interface_is_scaled_and_the_scale_is_remembered() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = opened([1280.0, 800.0], Some(folder.path()));
    for _ in 0..3 {
        key(&mut window, Modifiers::COMMAND, Key::Plus);
    }
    assert!((window.ctx.zoom_factor() - 1.3).abs() < 1e-3);
    let again = opened([1280.0, 800.0], Some(folder.path()));
    assert!((again.ctx.zoom_factor() - 1.3).abs() < 1e-3);
    key(&mut window, Modifiers::COMMAND, Key::Num0);
    assert!((window.ctx.zoom_factor() - 1.0).abs() < 1e-3);
}

/// Every label of every pattern that comes with the program, in every size: none over another, none cut off.
#[test]
fn no_label_lies_over_another_or_is_cut_off() {
    let patterns = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../patterns");
    let mut checked = 0;
    for entry in std::fs::read_dir(patterns).unwrap() {
        let file = entry.unwrap().path();
        if file.is_dir() {
            continue;
        }
        let mut window = opened_file(file.clone(), [1280.0, 800.0], None);
        let pattern = window.state().session().project().pattern.clone();
        for size in &pattern.sizes {
            let size = Some(size.name.clone());
            window.state_mut().execute(Command::SetSize { size });
            window.run_ok();
            key(&mut window, Modifiers::NONE, Key::F);
            for select_all in [false, true] {
                if select_all {
                    key(&mut window, Modifiers::COMMAND, Key::A);
                }
                let labels = window.state().view().labels().to_vec();
                let view = canvas(&window);
                assert!(labels.len() >= pattern.panels.len(), "{}", file.display());
                for (k, one) in labels.iter().enumerate() {
                    let whole = view.expand(0.5).contains_rect(*one);
                    assert!(
                        whole || select_all,
                        "{}: {one:?} of {view:?}",
                        file.display()
                    );
                    let over = labels[k + 1..]
                        .iter()
                        .find(|other| other.shrink(0.5).intersects(*one));
                    assert!(over.is_none(), "{}: {one:?} over {over:?}", file.display());
                    checked += 1;
                }
            }
            key(&mut window, Modifiers::NONE, Key::Escape);
        }
    }
    assert!(checked > 200, "{checked}");
}

/// A longer hem pushes the pieces below it away, in the view alone, and they come back with it.
#[test]
fn pieces_that_grow_push_others_away_in_the_view_alone() {
    let mut window = opened([1280.0, 800.0], None);
    let before = window.state().session().project().clone();
    let places = |window: &Window| {
        let view = window.state().view();
        let sheets = before.pattern.sheets.iter();
        let places = sheets.map(|sheet| view.table_layout.sheet(sheet.id));
        places.collect::<Vec<_>>()
    };
    let usual = places(&window);
    let pattern = before.pattern.clone();
    let bodice = pattern
        .sheets
        .iter()
        .find(|sheet| sheet.name == "front bodice");
    let points: Vec<_> = bodice
        .unwrap()
        .points
        .iter()
        .map(|point| point.id)
        .collect();
    let down = plan::Affine::translation(toile_geometry::Vec2::new(0.0, -0.3));
    let moved = plan::transform_points(window.state().base(), &points, &down);
    let edits = moved.unwrap().edits;
    let label = "Move points".to_owned();
    window.state_mut().execute(Command::Edit { edits, label });
    window.run_ok();
    assert_ne!(places(&window), usual, "nothing was pushed");
    let now = window.state().session().project().pattern.clone();
    for (sheet, was) in now.sheets.iter().zip(&pattern.sheets) {
        assert_eq!(sheet.on_table, was.on_table, "the document was changed");
    }
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(places(&window), usual);
}

/// With everything open in the least window nothing breaks down, and in a usual one the pattern stays seen.
#[test]
fn a_crowded_window_shows_what_it_has_room_for() {
    for size in [[760.0, 480.0], [1280.0, 800.0]] {
        let mut window = opened(size, None);
        for open in [Key::F8, Key::F9, Key::F10] {
            key(&mut window, Modifiers::NONE, open);
        }
        key(&mut window, Modifiers::COMMAND, Key::A);
        for table in [
            "Variables",
            "Fabric",
            "Wearer",
            "Worn with",
            "History",
            "Pattern",
        ] {
            window.get_by_label(table).click();
            window.run_ok();
        }
        let least = if size[1] < 600.0 { 0.0 } else { 100.0 };
        let canvas = canvas(&window);
        assert!(canvas.height() >= least, "{size:?}: {canvas:?}");
    }
}
