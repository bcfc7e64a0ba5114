//! Exports of the window: each by its name, with the bytes of the command line; stopped, refused, counted.

use crate::drafter::Drafter;
use crate::garments;
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};
use toile_session::{Command, Export, ExportFormat, Quality, Session, Silent};
use toile_ui::Beginning;

/// Every box of the dialog with what it writes.
const BOXES: [(&str, ExportFormat); 19] = [
    ("GLB", ExportFormat::Glb),
    ("OBJ", ExportFormat::Obj),
    ("Picture of the garment", ExportFormat::Drape),
    ("Picture of the fit", ExportFormat::Fit),
    ("Marker DXF", ExportFormat::MarkerDxf),
    ("Marker HPGL", ExportFormat::MarkerPlt),
    ("Marker PDF", ExportFormat::MarkerPdf),
    ("Marker SVG", ExportFormat::MarkerSvg),
    ("Marker report", ExportFormat::MarkerReport),
    ("Marker JSON", ExportFormat::MarkerJson),
    ("Nesting problem JSON", ExportFormat::MarkerInstance),
    ("Pieces PDF", ExportFormat::PiecesPdf),
    ("Pieces SVG", ExportFormat::PiecesSvg),
    ("GarmentCode", ExportFormat::PatternGarmentcode),
    ("SVG", ExportFormat::PatternSvg),
    ("DXF-AAMA", ExportFormat::PatternDxfAama),
    ("DXF-ASTM", ExportFormat::PatternDxfAstm),
    ("Report", ExportFormat::Report),
    ("Journal and times", ExportFormat::Journal),
];

/// A window with the band, coarsely meshed.
fn band(folder: &Path) -> (Drafter, PathBuf) {
    let file = garments::band(folder);
    let mut drafter = Drafter::begun(Beginning {
        file: Some(file.clone()),
        folder: None,
    });
    let quality = Quality::Preview;
    drafter
        .window
        .state_mut()
        .execute(Command::SetQuality { quality });
    drafter.window.run();
    (drafter, file)
}

fn exports(drafter: &Drafter) -> bool {
    drafter.window.query_by_label("Stop export").is_some()
}

/// Ticks a box or takes the tick away.
fn tick(drafter: &mut Drafter, name: &str) {
    drafter
        .window
        .get_by_role_and_label(Role::CheckBox, name)
        .click();
    drafter.window.run();
}

/// Ends the dialog with a folder, and waits for what is written.
fn export_to(drafter: &mut Drafter, folder: &Path) {
    drafter.enter("Folder", &folder.display().to_string());
    drafter.wait(|drafter| !exports(drafter));
}

#[test]
fn every_export_has_the_bytes_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let (mut drafter, file) = band(folder.path());
    let written = folder.path().join("window");
    drafter.chord(Modifiers::COMMAND, Key::E);
    for (name, format) in BOXES {
        if !format.is_usual() || format == ExportFormat::Journal {
            tick(&mut drafter, name);
        }
    }
    export_to(&mut drafter, &written);
    let told = drafter.status();
    let verdict = "the garment hangs at rest";
    assert!(
        told.contains("Exported 22 files") && told.contains(verdict),
        "{told}"
    );

    // As `toile make FILE --quality preview --formats ... --out DIR` does it.
    let made = folder.path().join("made");
    let formats = ExportFormat::ALL.to_vec();
    assert_eq!(formats.len(), BOXES.len());
    let mut session = Session::new();
    let commands = [
        Command::open(file),
        Command::SetQuality {
            quality: Quality::Preview,
        },
        Command::Check,
        Command::Export(Export {
            dir: made.clone(),
            formats,
            marker: None,
        }),
    ];
    session.execute_all(&commands, &mut Silent).unwrap();
    let [mut window, mut line] = [&written, &made].map(|dir| garments::lasting(dir));
    for files in [&mut window, &mut line] {
        assert!(files.remove("journal.jsonl").is_some());
    }
    assert_eq!(window.len(), 20);
    for (name, bytes) in &line {
        assert!(window[name] == *bytes, "{name} differs");
    }

    // What was written by this window is replaced without a question, and what is asked is remembered.
    drafter.chord(Modifiers::COMMAND, Key::E);
    for (name, format) in BOXES {
        if format.is_of_garment() || format == ExportFormat::Report {
            tick(&mut drafter, name);
        }
    }
    drafter.key(Key::Enter);
    drafter.wait(|drafter| !exports(drafter));
    assert!(
        drafter.status().contains("Exported 17 files"),
        "{}",
        drafter.status()
    );
    assert!(garments::files(&written)["marker.dxf"] == line["marker.dxf"]);
}

#[test]
fn a_garment_that_hangs_in_the_window_is_exported_as_the_command_line_hangs_it() {
    let folder = tempfile::tempdir().unwrap();
    let (mut drafter, file) = band(folder.path());
    drafter.press("Drape");
    drafter.wait(|drafter| drafter.window.state().session().draped().is_some());
    let written = folder.path().join("window");
    drafter.chord(Modifiers::COMMAND, Key::E);
    for (name, format) in BOXES {
        if format.is_of_marker() && format.is_usual() {
            tick(&mut drafter, name);
        }
    }
    export_to(&mut drafter, &written);
    let made = folder.path().join("made");
    let quality = Quality::Preview;
    let commands = [
        Command::open(file),
        Command::SetQuality { quality },
        Command::drape(),
        Command::export(&made),
    ];
    let mut session = Session::new();
    session.execute_all(&commands, &mut Silent).unwrap();
    let mut line = garments::lasting(&made);
    line.remove("journal.jsonl");
    assert_eq!(line.len(), 5);
    assert!(garments::files(&written) == line);
}

#[test]
fn a_stopped_export_leaves_nothing_and_one_that_cannot_be_is_asked_again() {
    let folder = tempfile::tempdir().unwrap();
    let (mut drafter, _) = band(folder.path());
    let written = folder.path().join("window");
    drafter.chord(Modifiers::COMMAND, Key::E);
    drafter.enter("Folder", &written.display().to_string());
    assert!(exports(&drafter));
    drafter.press("Stop export");
    drafter.wait(|drafter| !exports(drafter));
    assert!(
        drafter.status().contains("nothing was written"),
        "{}",
        drafter.status()
    );
    assert!(!written.exists());

    let file = folder.path().join("file");
    std::fs::write(&file, "words").unwrap();
    drafter.chord(Modifiers::COMMAND, Key::E);
    export_to(&mut drafter, &file.join("below"));
    let told = drafter.window.query_all_by_label_contains("file is a file");
    assert_eq!(told.count(), 2, "in the dialog and in the status line");
    assert!(drafter.window.query_by_label("Folder").is_some());
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "words");
    drafter.key(Key::Escape);
    assert!(drafter.window.query_by_label("Folder").is_none());
}

#[test]
fn the_dxf_of_a_marker_in_three_actions_asks_before_it_replaces_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let (mut drafter, _) = band(folder.path());
    drafter.press("Marker");
    drafter.press("Export marker DXF");
    drafter.key(Key::Enter);
    drafter.wait(|drafter| !exports(drafter));
    assert_eq!(drafter.actions, 3);
    let dxf = folder.path().join("band-export/marker.dxf");
    let bytes = std::fs::read(&dxf).unwrap();
    let text = String::from_utf8(bytes.clone()).unwrap();
    assert!(text.contains("SECTION") && text.trim_end().ends_with("EOF"));
    assert_eq!(garments::files(dxf.parent().unwrap()).len(), 1);

    // Another window did not write it.
    std::fs::write(&dxf, "kept").unwrap();
    let (mut drafter, _) = band(folder.path());
    drafter.press("Marker");
    drafter.press("Export marker DXF");
    drafter.key(Key::Enter);
    let asked = drafter.window.query_by_label("There already: marker.dxf");
    assert!(asked.is_some() && !exports(&drafter));
    assert_eq!(std::fs::read_to_string(&dxf).unwrap(), "kept");
    drafter.press("Replace");
    drafter.wait(|drafter| !exports(drafter));
    assert!(std::fs::read(&dxf).unwrap() == bytes);
}

#[test]
fn a_window_that_is_closed_waits_for_its_export_and_closed_again_stops_it() {
    let folder = tempfile::tempdir().unwrap();
    let (mut drafter, _) = band(folder.path());
    let close = |drafter: &mut Drafter| {
        let viewports = &mut drafter.window.input_mut().viewports;
        let root = viewports.get_mut(&egui::ViewportId::ROOT);
        root.unwrap().events.push(egui::ViewportEvent::Close);
        drafter.window.step();
    };
    let does = |drafter: &Drafter, command: &egui::ViewportCommand| {
        let output = &drafter.window.output().viewport_output;
        output[&egui::ViewportId::ROOT].commands.contains(command)
    };
    drafter.window.state_mut().execute(Command::SavePattern {
        path: folder.path().join("band.toile.json"),
    });
    drafter.window.run();
    let begin = |drafter: &mut Drafter, name: &str| {
        drafter.chord(Modifiers::COMMAND, Key::E);
        let written = folder.path().join(name);
        drafter.enter("Folder", &written.display().to_string());
        assert!(exports(drafter));
        written
    };
    let written = begin(&mut drafter, "stopped");
    for _ in 0..2 {
        close(&mut drafter);
        assert!(does(&drafter, &egui::ViewportCommand::CancelClose));
    }
    drafter.wait(|drafter| !exports(drafter));
    assert!(!written.exists());
    drafter.window.step();
    assert!(does(&drafter, &egui::ViewportCommand::Close));

    let (mut drafter, _) = band(folder.path());
    let written = begin(&mut drafter, "whole");
    close(&mut drafter);
    assert!(does(&drafter, &egui::ViewportCommand::CancelClose));
    drafter.window.step();
    let told = drafter.status();
    assert!(told.contains("closes once the files are written"), "{told}");
    drafter.wait(|drafter| !exports(drafter));
    assert_eq!(garments::files(&written).len(), 7, "all of them");
    drafter.window.step();
    assert!(does(&drafter, &egui::ViewportCommand::Close));
}

#[test]
fn a_marker_that_no_format_shows_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = Session::new();
    let path = garments::band(folder.path());
    session.execute(Command::open(path), &mut Silent).unwrap();
    let export = Export {
        dir: folder.path().join("out"),
        formats: vec![ExportFormat::PiecesSvg, ExportFormat::Glb],
        marker: Some("shell".into()),
    };
    let refused = session.execute(Command::Export(export), &mut Silent);
    let words = refused.unwrap_err().to_string();
    assert!(
        words.contains("\"shell\"") && words.contains("pieces-svg, glb"),
        "{words}"
    );
    assert!(!folder.path().join("out").exists());
}
