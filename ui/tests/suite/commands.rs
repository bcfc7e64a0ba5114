//! Every command is in a menu under its name, and takes nothing away that Undo does not bring back.

use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::sync::Arc;
use toile_pattern::Pattern;
use toile_ui::{Beginning, Menu, ToileApp, commands};

fn window() -> Harness<'static, ToileApp> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../patterns/t-shirt.toile.json");
    let mut window = Harness::builder()
        .with_size(vec2(1400.0, 1000.0))
        .with_theme(egui::Theme::Light)
        .with_max_steps(6)
        .with_step_dt(1.0 / 60.0)
        .build_eframe(move |creation| {
            let beginning = Beginning {
                file: Some(file.clone()),
                folder: None,
            };
            let state = creation.wgpu_render_state.as_ref();
            ToileApp::new(&creation.egui_ctx, state, beginning)
        });
    // Nothing fades in or out.
    window
        .ctx
        .all_styles_mut(|style| style.animation_time = 0.0);
    window.run_ok();
    window
}

fn pattern(window: &Harness<'_, ToileApp>) -> Arc<Pattern> {
    window.state().session().project().pattern.clone()
}

/// Opens a menu; where it was left open by a dialog, the first click closes it.
fn open_menu(window: &mut Harness<'_, ToileApp>, menu: Menu) {
    let first = commands().find(|command| command.menu == menu).unwrap();
    let shown = |window: &Harness<'_, ToileApp>| window.query_all_by_label(first.name).count();
    let before = shown(window);
    for _ in 0..2 {
        window.get_by_label(menu.name()).click();
        window.run_ok();
        if shown(window) > before {
            return;
        }
    }
}

#[test]
fn every_command_is_reached_by_its_name_and_its_changes_are_undone() {
    let mut window = window();
    let before = pattern(&window);
    let mut changed = Vec::new();
    for menu in Menu::ALL {
        for command in commands().filter(|command| command.menu == menu) {
            // Draping is a matter of minutes here: other tests start it.
            if command.name == "Drape" {
                continue;
            }
            window.key_press_modifiers(Modifiers::COMMAND, Key::A);
            window.run_ok();
            open_menu(&mut window, menu);
            let entry = window.query_all_by_label(command.name).last();
            let entry = entry.unwrap_or_else(|| panic!("{} is in no menu", command.name));
            entry.click();
            window.run_ok();
            // What was opened in the view is closed again.
            if menu == Menu::View {
                open_menu(&mut window, menu);
                let entry = window.query_all_by_label(command.name).last().unwrap();
                entry.click();
                window.run_ok();
            }
            // Dialogs and tools are left; the menu too where the command could not be done.
            for _ in 0..2 {
                window.key_press(Key::Escape);
                window.run_ok();
            }
            let dialogs = window.query_all_by_label("Cancel").count();
            assert_eq!(dialogs, 0, "{} is not left by Escape", command.name);
            if *pattern(&window) != *before {
                changed.push(command.name);
                window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
                window.run_ok();
            }
            assert!(pattern(&window).says_the_same(&before), "{}", command.name);
        }
    }
    for name in ["Delete", "Cut", "Duplicate", "Align left"] {
        assert!(changed.contains(&name), "{name} did nothing: {changed:?}");
    }
}
