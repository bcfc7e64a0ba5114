//! Exports by their formats: what each takes is made for it, and the bytes are those of the commands by themselves.

use crate::support::{band, files, lasting, make};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use toile_pattern::plan;
use toile_session::{
    Command, Event, Export, ExportFormat, MarkerFormat, MarkerJob, NestOptions, Paper,
    PrintOptions, Quality, Search, Session, Silent, Start, WriteOptions, nest_marker,
    nest_patterns, print_pattern, read_journal,
};

fn prepared(pattern: &Path) -> Session {
    let open = Command::open(pattern);
    let quality = Command::SetQuality {
        quality: Quality::Preview,
    };
    let mut session = Session::new();
    session.execute_all(&[open, quality], &mut Silent).unwrap();
    session
}

fn export(dir: &Path, formats: &[ExportFormat]) -> Command {
    Command::Export(Export {
        dir: dir.to_owned(),
        formats: formats.to_vec(),
        marker: None,
    })
}

#[test]
fn every_format_has_the_bytes_of_the_command_it_stands_for() {
    let folder = tempfile::tempdir().unwrap();
    let pattern = band(folder.path());
    let [all, made, nested, printed] = ["all", "made", "nested", "printed"].map(|name| {
        let dir = folder.path().join(name);
        std::fs::create_dir(&dir).unwrap();
        dir
    });
    let mut session = prepared(&pattern);
    let events = session.execute(export(&all, &ExportFormat::ALL), &mut Silent);
    let events = events.unwrap();
    let told = |is: fn(&Event) -> bool| events.iter().any(is);
    assert!(told(|event| matches!(event, Event::Nested(_))));
    assert!(told(|event| matches!(event, Event::Draped(_))));

    let (_, written) = Session::replay(&make(&pattern, &made), &made, &mut Silent).unwrap();
    assert!(!written.is_empty());
    let options = NestOptions {
        formats: vec![
            MarkerFormat::Dxf,
            MarkerFormat::Pdf,
            MarkerFormat::Report,
            MarkerFormat::Hpgl,
            MarkerFormat::Instance,
        ],
        ..NestOptions::default()
    };
    nest_patterns(
        std::slice::from_ref(&pattern),
        &options,
        (&nested, &mut Silent),
    )
    .unwrap();
    for (name, paper) in [("pieces.pdf", Paper::A4), ("pieces.svg", Paper::Page)] {
        let options = PrintOptions {
            paper,
            ..PrintOptions::default()
        };
        let to = printed.join(name);
        print_pattern((session.project(), &to), &options, &mut Silent).unwrap();
    }
    for export in ExportFormat::ALL {
        if let Some(format) = export.of_pattern() {
            let write = Command::WritePattern {
                path: printed.join(export.file()),
                options: WriteOptions {
                    format: Some(format),
                    all_sizes: format.holds_sizes(),
                },
            };
            session.execute(write, &mut Silent).unwrap();
        }
    }
    let mut expected: BTreeMap<String, Vec<u8>> = lasting(&made);
    expected.extend(files(&nested));
    expected.extend(files(&printed));
    let mut exported = lasting(&all);
    // The journals tell different ways.
    assert!(exported.remove("journal.jsonl").is_some());
    expected.remove("journal.jsonl");
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&exported), names(&expected));
    for (name, bytes) in &expected {
        assert!(exported[name] == *bytes, "{name} differs");
    }
}

#[test]
fn a_marker_alone_hangs_no_garment_and_one_of_the_pattern_is_written_as_it_lies() {
    let folder = tempfile::tempdir().unwrap();
    let pattern = band(folder.path());
    let mut session = prepared(&pattern);
    let fabric = session.project().pattern.panels[0].fabric;
    let (edits, _) = plan::add_marker(&session.evaluation(), Some("table 2"), fabric).unwrap();
    let edit = Command::Edit {
        edits,
        label: "Add marker".into(),
    };
    let kept = folder.path().join("kept.toile.json");
    let save = Command::SavePattern { path: kept.clone() };
    session.execute_all(&[edit, save], &mut Silent).unwrap();
    let job = |search| MarkerJob {
        name: "table 2".into(),
        search,
        formats: vec![MarkerFormat::Svg],
    };
    let search = (Start::Anew, Search::evaluations(3000));
    let nested = folder.path().join("nested");
    nest_marker(&kept, &job(Some(search)), (&nested, &mut Silent)).unwrap();

    let mut session = prepared(&kept);
    let mut write = |marker: Option<&str>, name: &str| {
        let dir = folder.path().join(name);
        let export = Command::Export(Export {
            dir: dir.clone(),
            formats: vec![ExportFormat::MarkerSvg],
            marker: marker.map(str::to_owned),
        });
        let events = session.execute(export, &mut Silent)?;
        assert!(!events.iter().any(|event| matches!(event, Event::Draped(_))));
        assert_eq!(files(&dir).into_keys().collect::<Vec<_>>(), ["marker.svg"]);
        Ok::<_, toile_session::SessionError>(files(&dir))
    };
    assert!(write(Some("table 2"), "stored").unwrap() == files(&nested));
    assert!(write(None, "anew").unwrap() != files(&nested));
    let error = write(Some("table 9"), "none").unwrap_err().to_string();
    assert!(
        error.contains("table 9") && error.contains("table 2"),
        "{error}"
    );
    assert!(!folder.path().join("none").exists());
}

#[test]
fn nothing_is_written_where_it_is_stopped_or_cannot_be() {
    let folder = tempfile::tempdir().unwrap();
    let pattern = band(folder.path());
    let mut session = prepared(&pattern);
    let dir = folder.path().join("out");
    let stages = [
        ("laying out", ExportFormat::MarkerDxf),
        ("sewing", ExportFormat::Glb),
        ("writing", ExportFormat::PiecesSvg),
    ];
    for (stage, format) in stages {
        let mut seen = false;
        let mut stop = |now: &str, _: f64, _: &str| {
            seen |= now == stage;
            match now == stage {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        };
        let stopped = session
            .snapshot()
            .execute(export(&dir, &[format]), &mut stop);
        assert!(stopped.is_err() && seen, "{stage}");
        assert!(!dir.exists(), "{stage}");
    }
    // Told before anything is made.
    let file: PathBuf = folder.path().join("file");
    std::fs::write(&file, "words").unwrap();
    let mut works = false;
    let mut watcher = |_: &str, _: f64, _: &str| {
        works = true;
        ControlFlow::Continue(())
    };
    let refused = session.execute(
        export(&file.join("out"), &[ExportFormat::Glb]),
        &mut watcher,
    );
    let error = refused.unwrap_err().to_string();
    assert!(error.contains("file is a file") && !works, "{error}");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "words");
}

#[test]
fn journals_without_formats_are_read_as_before() {
    let read = read_journal("{\"command\":\"export\",\"dir\":\"out\"}\n").unwrap();
    assert_eq!(read, [Command::export(Path::new("out"))]);
    let told = toile_session::journal_lines(&read).unwrap();
    assert_eq!(told, "{\"command\":\"export\",\"dir\":\"out\"}\n");
}
