//! Who wears the garment and what is worn with it, by accessible names: each kind of wearer and each layer undone
//! exactly, there after save and load, and named where a file is missing.

use crate::drafter::Drafter;
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};
use toile_session::{BodyChoice, Command, Figure, Project, Session, Silent};
use toile_ui::Beginning;

fn shipped(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../patterns");
    folder.join(format!("{name}.toile.json"))
}

/// A window with a pattern that lies in a folder.
fn opened(pattern: &Path) -> Drafter {
    Drafter::begun(Beginning {
        file: Some(pattern.to_owned()),
        folder: None,
    })
}

/// The T-shirt and the poncho, a table of measurements and a mannequin, in a folder.
fn folder_of_work(folder: &Path) -> PathBuf {
    std::fs::create_dir_all(folder).unwrap();
    for name in ["t-shirt", "poncho"] {
        let file = folder.join(format!("{name}.toile.json"));
        std::fs::copy(shipped(name), file).unwrap();
    }
    let table = r#"{"toile": 1, "kind": "measurements", "unit": "cm", "measurements": {"height": 171.5, "waist": 83}}"#;
    std::fs::write(folder.join("anna.json"), table).unwrap();
    let mut tailor = Session::new();
    let man = Command::SetBody {
        figure: Some(Figure::Man),
        measurements: None,
    };
    tailor.execute(man, &mut Silent).unwrap();
    let path = folder.join("form.json");
    tailor
        .execute(Command::SaveBody { path }, &mut Silent)
        .unwrap();
    folder.join("t-shirt.toile.json")
}

fn project(drafter: &Drafter) -> Project {
    drafter.window.state().session().project().clone()
}

/// What of a project its file keeps, without the folder it lies in.
fn seen(project: &Project, folder: &Path) -> String {
    let others = project.others.iter().map(|worn| {
        let file = worn.source.canonicalize().unwrap_or_default();
        (worn.name(), worn.layer, file, worn.pattern.is_some())
    });
    let all = format!(
        "{:?} {:?} {} {:?}",
        project.body,
        project.size,
        project.layer,
        others.collect::<Vec<_>>()
    );
    all.replace(&folder.display().to_string(), "FOLDER")
}

/// What was just done is one step, unsaved, undone exactly, and there after save and load.
fn is_kept(drafter: &mut Drafter, (before, file): (&Project, &Path)) {
    let folder = file.parent().unwrap();
    let after = project(drafter);
    assert!(after != *before && drafter.window.state().is_unsaved());
    drafter.chord(Modifiers::COMMAND, Key::Z);
    assert_eq!(project(drafter), *before);
    drafter.chord(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert_eq!(project(drafter), after);
    drafter.chord(Modifiers::COMMAND, Key::S);
    assert!(!drafter.window.state().is_unsaved(), "{}", drafter.status());
    let mut again = Session::new();
    let open = Command::open(file);
    again.execute(open, &mut Silent).unwrap();
    assert_eq!(seen(again.project(), folder), seen(&after, folder));
    assert!(!again.is_unsaved());
}

/// A measurement of the wearer is so long (m).
fn measures(project: &Project, name: &str, length: f64) {
    let now = project.body_measurements().get(name).unwrap();
    assert!((now - length).abs() < 1e-12, "{name}: {now}");
}

/// Chooses a file in the dialog that is open.
fn choose(drafter: &mut Drafter, path: &Path) {
    drafter.enter("File", &path.display().to_string());
}

#[test]
fn the_wearer_is_another_in_three_actions() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.press("Garment");
    drafter.press("Wearer");
    drafter.press("Man");
    assert_eq!(drafter.actions, 3);
    assert_eq!(project(&drafter).body, BodyChoice::Sample(Figure::Man));
    // The mannequin in the garment's view is made for him.
    let height = project(&drafter).body_measurements().get("height").unwrap();
    let stands = |drafter: &Drafter| {
        let mut session = drafter.window.state().session().snapshot();
        let skin = session.mannequin().unwrap().skin().clone();
        let top = skin.positions.iter().map(|p| p.y).fold(0.0, f64::max);
        (top - height).abs() < 0.02
    };
    drafter.wait(stands);
}

#[test]
fn every_kind_of_wearer_is_undone_exactly_and_there_again() {
    let place = tempfile::tempdir().unwrap();
    let file = folder_of_work(place.path());
    let mut drafter = opened(&file);
    drafter.key(Key::F3);
    let mut before = project(&drafter);
    let mut kept = |drafter: &mut Drafter| {
        is_kept(drafter, (&before, &file));
        before = project(drafter);
        before.clone()
    };
    drafter.press("Child of 10 years");
    let now = kept(&mut drafter);
    assert_eq!(now.body, BodyChoice::Sample(Figure::Child10));
    drafter.press("Dress form");
    let now = kept(&mut drafter);
    assert_eq!(now.body, BodyChoice::Sample(Figure::DressForm));
    drafter.press("Woman");
    kept(&mut drafter);
    drafter.press("size XL");
    let now = kept(&mut drafter);
    assert_eq!(now.size.as_deref(), Some("XL"));
    drafter.press("the wearer");
    let now = kept(&mut drafter);
    assert_eq!((now.size.as_deref(), now.size_name()), (None, None));
    // A table of measurements, grown from the figure that was chosen before.
    drafter.press("Wearer from file");
    choose(&mut drafter, &place.path().join("anna.json"));
    let now = kept(&mut drafter);
    measures(&now, "waist", 0.83);
    assert_eq!(now.figure(), Figure::Woman);
    assert!(now.body.words().contains("anna.json"));
    // One of her measurements typed, found by its meaning; then left to be predicted.
    drafter.enter("Find measurement", "smallest ribs");
    drafter.enter("Waist girth", "81.5");
    let now = kept(&mut drafter);
    measures(&now, "waist", 0.815);
    measures(&now, "height", 1.715);
    assert_eq!(now.asked_measurements().len(), 2);
    let field = drafter
        .window
        .get_by_role_and_label(Role::TextInput, "Waist girth");
    let at = field.rect().center();
    drafter.click(at);
    drafter.key(Key::Backspace);
    drafter.key(Key::Enter);
    let now = kept(&mut drafter);
    assert_eq!(now.asked_measurements().len(), 1);
    // A mannequin of its own.
    drafter.press("Wearer from file");
    choose(&mut drafter, &place.path().join("form.json"));
    let now = kept(&mut drafter);
    assert!(matches!(now.body, BodyChoice::Shaped { .. }));
    drafter.press("As the pattern says");
    let now = kept(&mut drafter);
    assert_eq!(now.body, BodyChoice::OfPattern);
    // The last one of a file is still in the list.
    let words = drafter.window.get_by_label_contains("form.json");
    let at = words.rect().center();
    drafter.click(at);
    let now = kept(&mut drafter);
    assert!(matches!(now.body, BodyChoice::Shaped { .. }));
}

#[test]
fn a_typed_girth_leaves_the_wearer_as_tall_as_before() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.key(Key::F3);
    drafter.press("Man");
    let before = project(&drafter).body_measurements();
    drafter.enter("Find measurement", "waist girth");
    drafter.enter("Waist girth", "120");
    let after = project(&drafter);
    measures(&after, "waist", 1.2);
    let height = before.get("height").unwrap();
    let now = after.body_measurements().get("height").unwrap();
    assert!((now - height).abs() < 6e-4, "{height} {now}");
    // A height that is asked for is taken as it is.
    drafter.enter("Find measurement", "floor crown");
    drafter.enter("Height", "190");
    measures(&project(&drafter), "height", 1.9);
    measures(&project(&drafter), "waist", 1.2);
}

#[test]
fn a_typed_girth_moves_nothing_that_does_not_go_with_it() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.key(Key::F3);
    drafter.press("Woman");
    drafter.press("the wearer");
    let before = project(&drafter).body_measurements();
    drafter.enter("Find measurement", "waist");
    for (typed, waist) in [("80.5", 0.805), ("85.5", 0.855)] {
        drafter.enter("Waist girth", typed);
        let after = project(&drafter);
        measures(&after, "waist", waist);
        let after = after.body_measurements();
        for name in ["waist_line", "hips_line", "arm_length", "head_l", "hips"] {
            let [now, usual] = [&after, &before].map(|table| table.get(name).unwrap());
            // The hips grow with the waist; a body's own waist changes nothing.
            let most = match (typed, name) {
                ("80.5", _) => 1e-12,
                (_, "hips") => 0.05,
                _ => 0.006,
            };
            assert!((now - usual).abs() <= most, "{name}: {usual} {now}");
        }
    }
}

#[test]
fn the_wearer_is_seen_where_the_tables_stand_in_a_narrow_column() {
    let size = egui::vec2(1920.0, 1080.0);
    let beginning = Beginning {
        file: Some(shipped("t-shirt")),
        folder: None,
    };
    let mut drafter = Drafter::of_size(size, beginning, None);
    drafter.key(Key::F3);
    let window = egui::Rect::from_min_size(egui::Pos2::ZERO, size);
    for name in ["Wearer", "Woman", "Dress form", "Find measurement"] {
        let at = drafter.window.get_by_label(name).rect();
        assert!(window.contains_rect(at), "{name}: {at:?}");
    }
    drafter.press("Man");
    assert_eq!(project(&drafter).body, BodyChoice::Sample(Figure::Man));
}

#[test]
fn sizes_are_added_one_after_the_other_in_the_same_place() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "skirt");
    drafter.key(Key::F8);
    let heads = |drafter: &Drafter| drafter.window.query_all_by_label("Measurement").count();
    assert_eq!(heads(&drafter), 0);
    let place = drafter.window.get_by_label("Add size").rect();
    for sizes in 1..=3 {
        drafter.press("Add size");
        assert_eq!(drafter.pattern().sizes.len(), sizes);
        let now = drafter.window.get_by_label("Add size").rect();
        assert_eq!(now, place, "{sizes} sizes");
    }
    assert_eq!(heads(&drafter), 1);
}

#[test]
fn a_measurement_nobody_has_is_refused_in_its_field() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.key(Key::F3);
    let before = project(&drafter);
    drafter.enter("Find measurement", "waist girth");
    for (text, words) in [("-4", "above 0"), ("0", "above 0"), ("waste", "waste")] {
        drafter.enter("Waist girth", text);
        assert_eq!(project(&drafter), before, "{text}");
        assert!(drafter.status().contains(words), "{}", drafter.status());
    }
    drafter.enter("Waist girth", "2/0");
    assert_eq!(project(&drafter), before);
    // A file that is no table says so, and the wearer stays.
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("no-table.json");
    std::fs::write(
        &path,
        r#"{"toile": 1, "kind": "measurements", "unit": "ell", "measurements": {}}"#,
    )
    .unwrap();
    drafter.press("Wearer from file");
    choose(&mut drafter, &path);
    assert!(drafter.status().contains("ell"), "{}", drafter.status());
    assert_eq!(project(&drafter), before);
}

#[test]
fn layers_are_put_on_in_order_undone_exactly_and_there_again() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("a");
    let file = folder_of_work(&folder);
    let mut drafter = opened(&file);
    drafter.chord(Modifiers::SHIFT, Key::F3);
    let mut before = project(&drafter);
    let mut kept = |drafter: &mut Drafter| {
        is_kept(drafter, (&before, &file));
        before = project(drafter);
        let layers = before.others.iter().map(|worn| (worn.name(), worn.layer));
        (before.layer, layers.collect::<Vec<_>>())
    };
    drafter.press("Wear over");
    choose(&mut drafter, &folder.join("poncho.toile.json"));
    let poncho = "Poncho".to_owned();
    assert_eq!(kept(&mut drafter), (0, vec![(poncho.clone(), 1)]));
    drafter.enter("Layer of Poncho", "7");
    assert_eq!(kept(&mut drafter), (0, vec![(poncho.clone(), 7)]));
    drafter.enter("Layer of T-shirt", "3");
    assert_eq!(kept(&mut drafter), (3, vec![(poncho.clone(), 7)]));
    drafter.press("Wear under");
    choose(&mut drafter, &shipped("trousers"));
    let (layer, others) = kept(&mut drafter);
    assert_eq!((layer, others[1].1), (3, 2));
    // As they are seen: the outermost first.
    let at = |name: &str| {
        let label = format!("Layer of {name}");
        let found = drafter
            .window
            .get_by_role_and_label(Role::TextInput, &label);
        found.rect().center().y
    };
    assert!(at("Poncho") < at("T-shirt") && at("T-shirt") < at("Trousers"));
    assert!(drafter.status().contains("worn over it"));
    assert!(drafter.status().contains("worn under it"));
    drafter.press("Take off Trousers");
    assert_eq!(kept(&mut drafter), (3, vec![(poncho, 7)]));
    // What makes no sense is refused.
    drafter.enter("Layer of Poncho", "1000");
    assert!(
        drafter.status().contains("0 to 999"),
        "{}",
        drafter.status()
    );
    drafter.key(Key::Escape);
    drafter.press("Wear over");
    choose(&mut drafter, &file);
    assert!(
        drafter.status().contains("the pattern itself"),
        "{}",
        drafter.status()
    );
    assert_eq!(project(&drafter), before);

    // Moved together they find each other; the one that is gone is named and stays named.
    let moved = place.path().join("b");
    std::fs::rename(&folder, &moved).unwrap();
    let file = moved.join("t-shirt.toile.json");
    let again = opened(&file);
    assert_eq!(again.window.state().fault(), None);
    assert_eq!(project(&again).others[0].name(), "Poncho");
    drop(again);
    let whole = std::fs::read_to_string(&file).unwrap();
    std::fs::remove_file(moved.join("poncho.toile.json")).unwrap();
    let mut again = opened(&file);
    assert!(
        again.status().contains("poncho.toile.json"),
        "{}",
        again.status()
    );
    again.chord(Modifiers::SHIFT, Key::F3);
    assert!(again.status().contains("left off"), "{}", again.status());
    again.enter("Layer of poncho.toile.json", "8");
    assert_eq!(project(&again).others[0].layer, 8);
    again.chord(Modifiers::COMMAND, Key::Z);
    again.press("Wear under");
    choose(&mut again, &shipped("trousers"));
    again.chord(Modifiers::COMMAND, Key::S);
    let saved = std::fs::read_to_string(&file).unwrap();
    assert!(saved != whole && saved.contains("poncho.toile.json") && saved.contains("trousers"));
}

#[test]
fn a_mannequin_that_is_missing_is_named_and_stays_named() {
    let place = tempfile::tempdir().unwrap();
    let file = folder_of_work(place.path());
    let mut drafter = opened(&file);
    drafter.key(Key::F3);
    drafter.press("Wearer from file");
    let form = place.path().join("form.json");
    choose(&mut drafter, &form);
    drafter.chord(Modifiers::COMMAND, Key::S);
    let whole = std::fs::read_to_string(&file).unwrap();
    std::fs::remove_file(form).unwrap();
    let mut again = opened(&file);
    assert!(again.status().contains("form.json"), "{}", again.status());
    again.key(Key::F3);
    assert!(
        again.status().contains("for want of the mannequin"),
        "{}",
        again.status()
    );
    again.press("size XL");
    again.chord(Modifiers::COMMAND, Key::Z);
    again.press("size S");
    again.chord(Modifiers::COMMAND, Key::S);
    let saved = std::fs::read_to_string(&file).unwrap();
    assert!(saved != whole && saved.contains("\"mannequin\": \"form.json\""));
}
