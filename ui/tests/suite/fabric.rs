//! The table of fabrics by its accessible names: chosen, made, copied, changed, coloured, put on panels, removed;
//! undone exactly, and there again from the file.

use crate::drafter::Drafter;
use crate::garments;
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::sync::Arc;
use toile_fabric::{Compression, LibraryFabric};
use toile_pattern::{Fabric, Pattern};
use toile_session::{Project, library_fabric};
use toile_ui::Beginning;

fn opened(file: &Path) -> Drafter {
    Drafter::begun(Beginning {
        file: Some(file.to_owned()),
        folder: None,
    })
}

/// A window with the band and its table of fabrics.
fn fabrics(folder: &Path) -> Drafter {
    let mut drafter = opened(&garments::band(folder));
    drafter.key(Key::F4);
    drafter
}

fn project(drafter: &Drafter) -> Project {
    drafter.window.state().session().project().clone()
}

fn fabric(drafter: &Drafter, name: &str) -> Arc<Fabric> {
    let pattern = drafter.pattern();
    let found = pattern.fabrics.iter().find(|fabric| fabric.name == name);
    found.unwrap_or_else(|| panic!("no fabric {name}")).clone()
}

fn chosen(drafter: &Drafter) -> Option<String> {
    let fabric = project(drafter).fabric;
    fabric.map(|choice| choice.name().to_owned())
}

/// Turns the wheel until something in the table is seen, as a hand does, and gives its place.
fn reach(drafter: &mut Drafter, name: &str) -> egui::Pos2 {
    let top = drafter
        .window
        .get_by_role_and_label(Role::ComboBox, "Garment cut from");
    let top = top.rect().bottom() + 14.0;
    let low = drafter.window.ctx.content_rect().bottom() - 40.0;
    for _ in 0..100 {
        let at = drafter.window.get_by_label(name).rect().center();
        let turn = match at.y {
            y if y < top => 1.0,
            y if y > low => -1.0,
            _ => return at,
        };
        turn_wheel(drafter, egui::pos2(at.x, 0.5 * (top + low)), turn);
    }
    panic!("{name:?} is out of reach");
}

/// Turns the wheel by a line over a place, up or down.
fn turn_wheel(drafter: &mut Drafter, at: egui::Pos2, turn: f32) {
    drafter.window.hover_at(at);
    drafter.window.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: egui::vec2(0.0, turn),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    drafter.window.run();
}

/// Shows a fabric of the list, ticks a box or presses a button of the table.
fn press(drafter: &mut Drafter, name: &str) {
    let at = reach(drafter, name);
    drafter.click(at);
}

/// Takes something from a list.
fn choose(drafter: &mut Drafter, list: &str, choice: &str) {
    let found = drafter.window.get_by_role_and_label(Role::ComboBox, list);
    drafter.click(found.rect().center());
    let found = drafter.window.get_by_label(choice);
    drafter.click(found.rect().center());
}

fn undo(drafter: &mut Drafter) {
    drafter.chord(Modifiers::COMMAND, Key::Z);
}

/// Undoes what was done since, to the same pattern, and does it again.
fn undone_exactly(drafter: &mut Drafter, before: &Project) {
    let after = project(drafter);
    let steps = drafter.window.state().session().past().len();
    for _ in 0..steps {
        undo(drafter);
    }
    let undone = project(drafter);
    // Ids are never given twice: what was undone keeps the counter.
    let counted = Pattern {
        ids: undone.pattern.ids,
        ..(*before.pattern).clone()
    };
    assert_eq!(*undone.pattern, counted);
    assert_eq!(
        (undone.fabric, undone.width),
        (before.fabric.clone(), before.width)
    );
    for _ in 0..steps {
        drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    }
    assert!(project(drafter) == after);
}

#[test]
fn another_fabric_in_three_actions() {
    let folder = tempfile::tempdir().unwrap();
    let mut drafter = opened(&garments::band(folder.path()));
    let before = project(&drafter);
    drafter.key(Key::F4);
    let denim = LibraryFabric::named("denim").unwrap();
    choose(
        &mut drafter,
        "Garment cut from",
        &format!("denim: {}", denim.about),
    );
    assert_eq!(drafter.actions, 3);
    assert_eq!(chosen(&drafter).as_deref(), Some("denim"));
    // Its figures are on show, with their sources.
    let source = drafter.window.query_all_by_label_contains("enzyme");
    assert!(source.count() >= 2, "weight and bend");
    assert!(drafter.window.query_by_label("334").is_some());

    drafter.enter("Roll width", "140");
    assert_eq!(project(&drafter).width, Some(1.4));
    drafter.enter("Roll width", "40m");
    assert_eq!(project(&drafter).width, Some(1.4));
    assert!(drafter.window.query_by_label("give 5 cm to 20 m").is_some());
    drafter.key(Key::Escape);
    drafter.chord(Modifiers::COMMAND, Key::S);
    let again = opened(&project(&drafter).source.unwrap());
    assert_eq!(chosen(&again).as_deref(), Some("denim"));
    assert_eq!(project(&again).width, Some(1.4));
    undone_exactly(&mut drafter, &before);
    choose(&mut drafter, "Garment cut from", "each panel's own fabric");
    assert_eq!(chosen(&drafter), None);
}

#[test]
fn a_fabric_of_a_file_is_cut_from_and_copied() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("ponte.json");
    let text = r#"{"toile": 1, "kind": "fabric", "density": 0.25}"#;
    std::fs::write(&file, text).unwrap();
    let mut drafter = fabrics(folder.path());
    choose(&mut drafter, "Garment cut from", "a fabric file\u{2026}");
    drafter.enter("File", &file.display().to_string());
    assert_eq!(
        chosen(&drafter).as_deref(),
        Some("ponte"),
        "{}",
        drafter.status()
    );
    press(&mut drafter, "Copy into the pattern");
    assert_eq!(fabric(&drafter, "ponte").material.density, 0.25);
    // One that is none is refused with its name.
    std::fs::write(&file, "words").unwrap();
    choose(&mut drafter, "Garment cut from", "a fabric file\u{2026}");
    drafter.enter("File", &file.display().to_string());
    assert!(
        drafter.status().contains("ponte.json"),
        "{}",
        drafter.status()
    );
}

#[test]
fn a_fabric_of_the_library_is_copied_changed_coloured_renamed_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let mut drafter = fabrics(folder.path());
    let before = project(&drafter);
    press(&mut drafter, "denim (library)");
    press(&mut drafter, "Copy into the pattern");
    let library = library_fabric("denim").unwrap();
    let copied = fabric(&drafter, "denim");
    assert_eq!(copied.material, library.material);

    // Every figure, in its unit.
    for (field, text) in [
        ("Width", "1.2 m"),
        ("Weight", "410"),
        ("Thickness", "1,1"),
        ("Stretch, warp", "5000"),
        ("Stretch, weft", "4000 N/m"),
        ("Hardening, warp", "12"),
        ("Hardening, weft", "3"),
        ("Shear", "150"),
        ("Narrowing", "0.25"),
        ("Bend, warp", "90"),
        ("Bend, weft", "2 * 40"),
        ("Bend, bias", "85.5"),
        ("Friction", "0.5"),
    ] {
        let steps = drafter.window.state().session().past().len();
        drafter.enter(field, text);
        let done = drafter.window.state().session().past().len();
        assert_eq!(done, steps + 1, "{field}: {}", drafter.status());
    }
    drafter.enter("Colour", "#203a66");
    press(&mut drafter, "Nap: all pieces point one way");
    drafter.enter("Fabric name", "indigo");
    let changed = fabric(&drafter, "indigo");
    let near =
        |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * b.abs().max(1e-6), "{a} is not {b}");
    near(changed.width, 1.2);
    near(changed.material.density, 0.41);
    near(changed.material.thickness, 1.1e-3);
    assert_eq!(changed.material.stretch, [5000.0, 4000.0]);
    assert_eq!(changed.material.hardening, [12.0, 3.0]);
    assert_eq!(
        (changed.material.shear, changed.material.poisson),
        (150.0, 0.25)
    );
    for (bend, wanted) in changed
        .material
        .bend
        .into_iter()
        .zip([90e-6, 80e-6, 85.5e-6])
    {
        near(bend, wanted);
    }
    assert_eq!((changed.material.friction, changed.nap), (0.5, true));
    assert_eq!(
        changed.colour,
        [0x20, 0x3a, 0x66].map(|byte| f64::from(byte) / 255.0)
    );
    let given = drafter.window.query_all_by_label("given in the pattern");
    assert_eq!(given.count(), 23);

    // Out of range it is refused at the field.
    drafter.enter("Weight", "0");
    assert!(
        drafter
            .window
            .query_by_label_contains("give 1 to 10000")
            .is_some()
    );
    assert_eq!(
        fabric(&drafter, "indigo").material.density,
        changed.material.density
    );
    drafter.key(Key::Escape);

    drafter.chord(Modifiers::COMMAND, Key::S);
    let file = project(&drafter).source.unwrap();
    let mut again = opened(&file);
    assert_eq!(*fabric(&again, "indigo"), *changed);
    again.key(Key::F4);
    undone_exactly(&mut drafter, &before);
}

#[test]
fn panels_are_cut_from_a_fabric_by_a_tick_and_one_in_use_is_not_removed() {
    let folder = tempfile::tempdir().unwrap();
    let mut drafter = fabrics(folder.path());
    let before = project(&drafter);
    let cut_from = |drafter: &Drafter| {
        let pattern = drafter.pattern();
        let name = |id| pattern.fabric(id).unwrap().name.clone();
        let names = pattern.panels.iter().map(|panel| name(panel.fabric));
        names.collect::<Vec<_>>()
    };
    drafter.press("New fabric");
    drafter.enter("Fabric name", "lining");
    press(&mut drafter, "back");
    assert_eq!(cut_from(&drafter), ["poplin", "lining"]);
    // One of the library comes with its panel.
    press(&mut drafter, "silk (library)");
    press(&mut drafter, "front");
    assert_eq!(cut_from(&drafter), ["silk", "lining"]);

    press(&mut drafter, "lining");
    press(&mut drafter, "Remove fabric");
    let told = drafter.status();
    assert!(
        told.contains("panel \"back\"") && told.contains("another fabric"),
        "{told}"
    );
    press(&mut drafter, "poplin");
    press(&mut drafter, "Copy fabric");
    assert_eq!(
        fabric(&drafter, "poplin 2").material.shear,
        fabric(&drafter, "poplin").material.shear
    );
    press(&mut drafter, "poplin");
    choose(&mut drafter, "Garment cut from", "poplin of the pattern");
    press(&mut drafter, "Remove fabric");
    assert!(
        drafter.status().contains("the garment is cut from"),
        "{}",
        drafter.status()
    );
    undo(&mut drafter);
    press(&mut drafter, "poplin");
    press(&mut drafter, "Remove fabric");
    assert!(
        drafter
            .pattern()
            .fabrics
            .iter()
            .all(|fabric| fabric.name != "poplin")
    );
    undone_exactly(&mut drafter, &before);
}

#[test]
fn figures_that_are_rarely_given_are_typed_too() {
    let folder = tempfile::tempdir().unwrap();
    let mut drafter = fabrics(folder.path());
    press(&mut drafter, "denim (library)");
    press(&mut drafter, "Copy into the pattern");
    let before = fabric(&drafter, "denim");
    for (field, text) in [
        ("Stretch limit, warp", "0.06"),
        ("Stretch limit, weft", "0.1"),
        ("Curling across", "0.1"),
        ("Viscosity", "0.02"),
        ("Bend viscosity", "0.5"),
        ("Damping", "2"),
        ("Kept, stretch", "0.05"),
        ("Kept, fold", "0.2"),
        ("Relaxation", "4"),
        ("Rebound", "0.3"),
    ] {
        let steps = drafter.window.state().session().past().len();
        drafter.enter(field, text);
        let done = drafter.window.state().session().past().len();
        assert_eq!(done, steps + 1, "{field}: {}", drafter.status());
    }
    let at = drafter
        .window
        .get_by_role_and_label(Role::TextInput, "Rebound");
    let at = at.rect().center();
    for _ in 0..10 {
        turn_wheel(&mut drafter, at, -1.0);
    }
    choose(&mut drafter, "Compression", "tension-field");
    let near =
        |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * b.abs().max(1e-6), "{a} is not {b}");
    let changed = fabric(&drafter, "denim");
    assert_eq!(changed.material.strain_limit, [0.06, 0.1]);
    assert_eq!(changed.material.compression, Compression::TensionField);
    assert_eq!(changed.material.bend_poisson, 0.1);
    assert_eq!(changed.material.viscosity, 0.02);
    near(changed.material.bend_viscosity, 0.5e-6);
    near(changed.material.stiffness_damping, 2e-3);
    assert_eq!(changed.material.relaxed_fraction, [0.05, 0.2]);
    assert_eq!(changed.material.relaxation_time, 4.0);
    assert_eq!(changed.material.restitution, Some(0.3));
    assert_eq!(changed.material.stretch, before.material.stretch);
    // Blank is without a limit.
    for _ in 0..3 {
        turn_wheel(&mut drafter, at, 1.0);
    }
    drafter.enter("Stretch limit, warp", " ");
    let changed = fabric(&drafter, "denim");
    assert_eq!(changed.material.strain_limit[0], f64::INFINITY);
}
