//! What the window keeps: an open menu has Escape for itself, a print that failed is asked for again,
//! the size is that of the last time.

use crate::drafter::Drafter;
use egui::{Key, Modifiers, Role, vec2};
use egui_kittest::kittest::Queryable;
use toile_ui::Beginning;

#[test]
fn escape_closes_an_open_menu_and_nothing_else() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.click(drafter.part("Panel front"));
    drafter.key(Key::D);
    let entry = |drafter: &Drafter| {
        let found = drafter
            .window
            .query_by_role_and_label(Role::Button, "Align left");
        found.is_some()
    };
    drafter.press("Edit");
    assert!(entry(&drafter));
    drafter.key(Key::Escape);
    assert!(!entry(&drafter), "the menu is open still");
    let view = drafter.window.state().view();
    assert!(
        view.hint(drafter.window.state().base()).contains("dart"),
        "the tool is put down"
    );
    assert!(!view.selection.is_empty());
    // The next one is the tool's.
    drafter.key(Key::Escape);
    let view = drafter.window.state().view();
    assert!(!view.hint(drafter.window.state().base()).contains("dart"));
}

#[test]
fn a_print_that_failed_is_asked_for_again_with_the_reason() {
    let mut drafter = Drafter::opened("poncho");
    let folder = tempfile::tempdir().unwrap();
    drafter.chord(Modifiers::COMMAND, Key::P);
    let nowhere = folder.path().join("nowhere/poncho.pdf");
    drafter.enter("File", &nowhere.display().to_string());
    let asked = |drafter: &mut Drafter| {
        for _ in 0..3000 {
            drafter.window.run_steps(1);
            let again = drafter
                .window
                .query_by_role_and_label(Role::TextInput, "File")
                .is_some();
            if again {
                return true;
            }
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        false
    };
    assert!(asked(&mut drafter), "{}", drafter.status());
    assert!(drafter.status().contains("nowhere"), "{}", drafter.status());
    let file = drafter
        .window
        .get_by_role_and_label(Role::TextInput, "File");
    assert_eq!(file.value(), Some(nowhere.display().to_string()));
    // Another place, and it is made.
    // The keys come to its field in the next frame, with all of its text selected.
    drafter.window.run();
    let paper = folder.path().join("poncho.pdf");
    drafter.enter("File", &paper.display().to_string());
    for _ in 0..3000 {
        if paper.exists() {
            break;
        }
        drafter.window.run_steps(1);
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert!(paper.exists(), "{}", drafter.status());
}

#[test]
fn the_window_opens_as_large_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let beginning = || Beginning {
        file: None,
        folder: Some(folder.path().to_owned()),
    };
    assert_eq!(beginning().viewport().inner_size, Some(vec2(1400.0, 860.0)));
    let mut drafter = Drafter::begun(beginning());
    drafter.window.set_size(vec2(1234.0, 777.0));
    drafter.window.run();
    eframe::App::on_exit(drafter.window.state_mut());
    let opened = beginning().viewport();
    assert_eq!(opened.inner_size, Some(vec2(1234.0, 777.0)));
    assert_eq!(opened.maximized, Some(false));
    // A size nobody can work in is not opened.
    drafter.window.set_size(vec2(50.0, 40.0));
    drafter.window.run();
    eframe::App::on_exit(drafter.window.state_mut());
    assert_eq!(beginning().viewport().inner_size, Some(vec2(760.0, 480.0)));
}
