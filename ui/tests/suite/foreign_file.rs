//! Files of other programs in the window: dropped, read otherwise by one click, saved in a format with what
//! that leaves out.

use crate::drafter::Drafter;
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT, Queryable};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_geometry::Bounds2;
use toile_pattern::Pattern;
use toile_session::{Command, Format, Session, Silent, WriteOptions};

/// A file that is dropped.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn drop_files(drafter: &mut Drafter, files: &[&Path]) {
    let dropped = files.iter().map(|file| {
        let file: egui::DroppedFileHandle = Arc::new(Dropped(file.to_path_buf()));
        file
    });
    drafter
        .window
        .input_mut()
        .dropped_files
        .extend(dropped.collect::<Vec<_>>());
    drafter.window.run();
    drafter.window.input_mut().dropped_files.clear();
    drafter.window.run();
}

/// The T-shirt as DXF, written into a folder.
fn t_shirt_dxf(folder: &Path) -> PathBuf {
    let path = folder.join("shirt.dxf");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../patterns/t-shirt.toile.json");
    let write = Command::WritePattern {
        path: path.clone(),
        options: WriteOptions {
            format: Some(Format::DxfAama),
            all_sizes: true,
        },
    };
    let mut session = Session::new();
    session
        .execute_all(&[Command::open(shipped), write], &mut Silent)
        .unwrap();
    path
}

/// Height of the first panel (m).
fn height(drafter: &Drafter) -> f64 {
    let stage = drafter.stage();
    let points = stage.outline().iter().map(|edge| edge.curve.point(0.0));
    Bounds2::of(points).size().y
}

/// Chooses an entry of a list.
fn choose(drafter: &mut Drafter, list: &str, entry: &str) {
    let found = drafter.window.get_by_role_and_label(Role::ComboBox, list);
    let at = found.rect().center();
    drafter.click(at);
    let found = drafter.window.get_by_role_and_label(Role::Button, entry);
    let at = found.rect().center();
    drafter.click(at);
}

#[test]
fn a_dropped_dxf_is_read_in_another_unit_by_one_choice_and_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = t_shirt_dxf(folder.path());
    let mut drafter = Drafter::new();
    drop_files(&mut drafter, &[&file]);
    assert!(
        drafter.window.query_by_label("Read as DXF-AAMA").is_some(),
        "{}",
        drafter.status()
    );
    let read = drafter.pattern();
    let before = height(&drafter);
    assert!(before > 0.3 && before < 1.0, "{before}");

    choose(&mut drafter, "Unit of the file", "cm");
    let larger = height(&drafter);
    assert!((larger / before - 10.0).abs() < 1e-6, "{larger} {before}");
    choose(&mut drafter, "Unit of the file", "mm");
    assert_eq!(drafter.pattern(), read);

    drafter.press("Dismiss");
    assert!(drafter.window.query_by_label("Read as DXF-AAMA").is_none());
}

#[test]
fn a_file_is_not_read_anew_over_changes() {
    let folder = tempfile::tempdir().unwrap();
    let file = t_shirt_dxf(folder.path());
    let mut drafter = Drafter::new();
    drop_files(&mut drafter, &[&file]);
    let read = drafter.pattern();
    let first = format!("Panel {}", read.panels[0].name);
    drafter.click(drafter.part(&first));
    drafter.key(Key::Delete);
    let changed = drafter.pattern();
    assert_ne!(changed, read, "{}", drafter.status());
    choose(&mut drafter, "Unit of the file", "cm");
    assert_eq!(drafter.pattern(), changed);
    assert!(
        drafter.status().contains("would be lost"),
        "{}",
        drafter.status()
    );
}

#[test]
fn a_pattern_is_saved_as_dxf_with_what_that_leaves_out_told_before() {
    let folder = tempfile::tempdir().unwrap();
    let mut drafter = Drafter::opened("t-shirt");
    let before = drafter.pattern();
    drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    choose(&mut drafter, "Format", "DXF-ASTM");
    let told = drafter.status();
    assert!(
        told.contains("The file leaves out:") && told.contains("constructed points (14)"),
        "{told}"
    );
    let path = folder.path().join("shirt.dxf");
    assert!(!path.exists());
    drafter.enter("File", &path.display().to_string());
    assert!(path.exists(), "{}", drafter.status());
    assert!(drafter.status().contains("Wrote"), "{}", drafter.status());
    // The window still shows its own document.
    assert_eq!(drafter.pattern(), before);

    let mut session = Session::new();
    session.execute(Command::open(&path), &mut Silent).unwrap();
    let read = session.project().pattern.clone();
    assert_eq!(read.panels.len(), before.panels.len());
    assert_eq!(read.sizes.len(), before.sizes.len());
    let base = |pattern: &Pattern| pattern.base().map(|size| size.name.clone());
    assert_eq!(base(&read), base(&before));
}

#[test]
fn dropped_measurements_dress_the_wearer_and_a_dropped_fabric_is_cut() {
    let folder = tempfile::tempdir().unwrap();
    let measured = folder.path().join("me.json");
    std::fs::write(
        &measured,
        r#"{"toile":1,"kind":"measurements","unit":"cm","measurements":{"height":181}}"#,
    )
    .unwrap();
    let mut drafter = Drafter::opened("poncho");
    let pattern = drafter.pattern();
    drop_files(&mut drafter, &[&measured]);
    let project = drafter.window.state().session().project();
    assert!(!project.body.is_of_pattern(), "{}", drafter.status());
    assert_eq!(drafter.pattern(), pattern);

    let fabric = folder.path().join("twill.json");
    std::fs::write(&fabric, r#"{"toile":1,"kind":"fabric","name":"twill"}"#).unwrap();
    drop_files(&mut drafter, &[&fabric]);
    let project = drafter.window.state().session().project();
    assert!(project.fabric.is_some(), "{}", drafter.status());
}

#[test]
fn the_bar_goes_once_the_pattern_is_saved_to_a_file_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let file = t_shirt_dxf(folder.path());
    let mut drafter = Drafter::new();
    drop_files(&mut drafter, &[&file]);
    // What is typed wrong is told, and what is right then is taken.
    drafter.enter("Sew line inside by", "wide");
    drafter.enter("Sew line inside by", "5mm");
    let bar = |drafter: &Drafter| drafter.window.query_by_label("Read as DXF-AAMA").is_some();
    assert!(bar(&drafter), "{}", drafter.status());
    drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    let saved = folder.path().join("own.toile.json");
    drafter.enter("File", &saved.display().to_string());
    assert!(saved.exists() && !bar(&drafter), "{}", drafter.status());
}

#[test]
fn a_dropped_picture_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("photo.png");
    std::fs::write(&picture, b"\x89PNG\r\n\x1a\n0000").unwrap();
    let mut drafter = Drafter::opened("poncho");
    let pattern = drafter.pattern();
    drop_files(&mut drafter, &[&picture]);
    assert!(drafter.status().contains("picture"), "{}", drafter.status());
    assert_eq!(drafter.pattern(), pattern);
}

#[test]
fn after_a_list_the_keys_go_to_the_tool() {
    let folder = tempfile::tempdir().unwrap();
    let file = t_shirt_dxf(folder.path());
    let mut drafter = Drafter::new();
    drop_files(&mut drafter, &[&file]);
    for (unit, takes_tool_before) in [("cm", false), ("mm", true)] {
        if takes_tool_before {
            drafter.chord(Modifiers::SHIFT, Key::U);
        }
        choose(&mut drafter, "Unit of the file", unit);
        let list = drafter
            .window
            .get_by_role_and_label(Role::ComboBox, "Unit of the file");
        list.focus();
        drafter.window.run();
        drafter.chord(Modifiers::SHIFT, Key::U);
        assert!(
            drafter.status().contains("Candidate 1 of"),
            "{}",
            drafter.status()
        );
        drafter.key(Key::Tab);
        assert!(
            drafter.status().contains("Candidate 2 of"),
            "{}",
            drafter.status()
        );
        assert!(drafter.pattern().seams.is_empty());
        drafter.key(Key::Enter);
        assert!(!drafter.pattern().seams.is_empty(), "{}", drafter.status());
        drafter.chord(Modifiers::COMMAND, Key::Z);
    }
}

#[test]
fn every_loss_is_told_whole_in_words_of_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let file = t_shirt_dxf(folder.path());
    // A shape that no rule knows, in each block.
    let text = std::fs::read_to_string(&file).unwrap();
    let circle = "0\nCIRCLE\n8\n99\n10\n1.0\n20\n1.0\n40\n3.0\n";
    let text = text.replace("0\nENDBLK", &format!("{circle}0\nENDBLK"));
    std::fs::write(&file, text).unwrap();
    let mut drafter = Drafter::new();
    drop_files(&mut drafter, &[&file]);
    let buttons = drafter.window.query_all_by_role(Role::Button);
    let labels = buttons.filter_map(|button| button.accesskit_node().label());
    let label = labels
        .into_iter()
        .find(|label| label.ends_with("left out"))
        .unwrap();
    let count: usize = label.split(' ').next().unwrap().parse().unwrap();
    assert!(count > 0);
    drafter
        .window
        .get_by_role_and_label(Role::Button, &label)
        .click();
    drafter.window.run();
    let lines = drafter.window.query_all_by_role(Role::Label);
    let lines: Vec<String> = lines
        .filter_map(|line| line.accesskit_node().value())
        .collect();
    assert!(
        lines
            .iter()
            .any(|line| line.contains("CIRCLE") || line.contains("layer 99")),
        "{lines:?}"
    );
    assert!(lines.iter().all(|line| !line.contains("--")), "{lines:?}");
}
