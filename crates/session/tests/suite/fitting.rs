//! How a garment is tried on is kept with its pattern: wearer, size, fabric, layers are there when it is opened again,
//! undone as one step each, and named where what they refer to is missing.

use crate::support::{self, BAND, files, lasting, make};
use std::path::{Path, PathBuf};
use toile_measure::{Measurements, Origin};
use toile_session::{
    BodyChoice, Budget, ClothSettings, Command, ConvertOptions, Event, Figure, MarkerSummary,
    NestOptions, OtherGarment, PrintOptions, Project, Recovery, Session, SessionError, Silent,
    abandoned, convert, journal_lines, mesh_panels, nest_patterns, print_pattern, read_journal,
};

fn run(session: &mut Session, command: Command) -> Result<Vec<Event>, SessionError> {
    session.execute(command, &mut Silent)
}

/// What was warned of.
fn warned(events: &[Event]) -> Vec<&str> {
    let warned = events.iter().filter_map(|event| match event {
        Event::Warned { message } => Some(&**message),
        _ => None,
    });
    warned.collect()
}

fn open(path: &Path) -> (Session, Vec<Event>) {
    let mut session = Session::new();
    let open = Command::open(path);
    let events = run(&mut session, open).unwrap();
    (session, events)
}

/// A folder with the band, a belt for over it, a table, a mannequin and a fabric; and a session that
/// has the band open.
fn at_work(folder: &Path) -> Session {
    let belt = BAND
        .replace("\"Band\"", "\"Belt\"")
        .replace("waist / 2 + 0.5cm", "waist / 2 + 2cm");
    std::fs::create_dir_all(folder.join("layers")).unwrap();
    for (name, text) in [
        ("band.toile.json", BAND),
        ("layers/belt.toile.json", &*belt),
    ] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let table = r#"{"toile": 1, "kind": "measurements", "unit": "cm", "measurements": {"height": 171.5, "waist": 83}}"#;
    std::fs::write(folder.join("anna.json"), table).unwrap();
    let fabric = r#"{"toile": 1, "kind": "fabric", "name": "Ponte", "density": 0.31}"#;
    std::fs::write(folder.join("ponte.json"), fabric).unwrap();
    let mut tailor = Session::new();
    let path = folder.join("form.json");
    let man = Command::SetBody {
        figure: Some(Figure::Man),
        measurements: None,
    };
    run(&mut tailor, man).unwrap();
    run(&mut tailor, Command::SaveBody { path }).unwrap();
    open(&folder.join("band.toile.json")).0
}

fn typed() -> Command {
    let mut measurements = Measurements::new();
    measurements.set("waist", 0.811, Origin::Asked).unwrap();
    measurements.set("height", 1.74, Origin::Asked).unwrap();
    Command::SetMeasurements {
        figure: Some(Figure::Woman),
        measurements,
    }
}

/// Every choice that there is, each with what it is called in the history.
fn choices(folder: &Path) -> Vec<(Command, &'static str)> {
    let body = |figure: Option<Figure>, file: Option<&str>| Command::SetBody {
        figure,
        measurements: file.map(|name| folder.join(name)),
    };
    let fabric = |name: &str| Command::SetFabric {
        fabric: Some(name.to_owned()),
    };
    vec![
        (body(Some(Figure::Child10), None), "Choose body"),
        (body(Some(Figure::Woman), Some("anna.json")), "Choose body"),
        (body(None, Some("form.json")), "Choose body"),
        (typed(), "Set measurements"),
        (
            Command::SetSize {
                size: Some("L".into()),
            },
            "Choose size",
        ),
        (fabric("denim"), "Choose fabric"),
        (
            fabric(folder.join("ponte.json").to_str().unwrap()),
            "Choose fabric",
        ),
        (
            Command::SetWidth { width: Some(1.42) },
            "Choose fabric width",
        ),
        (
            Command::SetLayers {
                layer: 1,
                others: vec![OtherGarment {
                    path: folder.join("layers/belt.toile.json"),
                    layer: 2,
                }],
            },
            "Choose layers",
        ),
    ]
}

/// What of a project a file keeps, without the folder it lies in.
fn seen(project: &Project, folder: &Path) -> String {
    let all = format!(
        "{:?} {:?} {:?} {:?} {} {:?}",
        project.body, project.size, project.fabric, project.width, project.layer, project.others
    );
    all.replace(&folder.display().to_string(), "FOLDER")
}

#[test]
fn every_choice_is_one_step_unsaved_and_there_after_save_and_load() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("a");
    let mut session = at_work(&folder);
    let path = folder.join("band.toile.json");
    for (command, label) in choices(&folder) {
        let before = session.project().clone();
        let was_unsaved = session.is_unsaved();
        run(&mut session, command.clone()).unwrap();
        assert_eq!(session.can_undo(), Some(label));
        assert!(session.is_unsaved(), "{command:?}");
        run(&mut session, Command::Undo).unwrap();
        assert_eq!(*session.project(), before, "{command:?}");
        assert_eq!(session.is_unsaved(), was_unsaved, "{command:?}");
        run(&mut session, Command::Redo).unwrap();
        // By itself and with all that was chosen before it.
        run(&mut session, Command::SavePattern { path: path.clone() }).unwrap();
        assert!(!session.is_unsaved());
        let (again, events) = open(&path);
        assert_eq!(warned(&events), [""; 0], "{command:?}");
        assert_eq!(
            seen(again.project(), &folder),
            seen(session.project(), &folder)
        );
        assert!(!again.is_unsaved());
    }
    // All together in another place: what lies beside the pattern is found there.
    let moved = place.path().join("b");
    let kept = seen(session.project(), &folder);
    drop(session);
    std::fs::rename(&folder, &moved).unwrap();
    let (again, events) = open(&moved.join("band.toile.json"));
    assert_eq!(warned(&events), [""; 0]);
    assert_eq!(seen(again.project(), &moved), kept);
    // Saved elsewhere, it still finds what stayed where it was.
    let mut again = again;
    let path = place.path().join("c/d/copy.toile.json");
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    run(&mut again, Command::SavePattern { path: path.clone() }).unwrap();
    let (copy, events) = open(&path);
    assert_eq!(warned(&events), [""; 0]);
    assert_eq!(copy.project().others.len(), 1);
    assert_eq!(
        copy.project().others[0].pattern.as_ref().unwrap().name,
        "Belt"
    );
}

#[test]
fn what_is_missing_is_named_and_stays_named() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let path = folder.join("band.toile.json");
    let mut session = at_work(folder);
    for (command, _) in choices(folder) {
        run(&mut session, command).unwrap();
    }
    // A wearer of each kind whose file can go.
    let with_file = choices(folder);
    for (wearer, gone) in [
        (&with_file[1].0, "anna.json"),
        (&with_file[2].0, "form.json"),
    ] {
        run(&mut session, wearer.clone()).unwrap();
        run(&mut session, Command::SavePattern { path: path.clone() }).unwrap();
        let whole = std::fs::read_to_string(&path).unwrap();
        let measurements = session.project().body_measurements();
        let hidden = folder.join("hidden");
        std::fs::create_dir_all(&hidden).unwrap();
        let missing = [gone, "ponte.json", "layers/belt.toile.json"];
        for (k, name) in missing.iter().enumerate() {
            std::fs::rename(folder.join(name), hidden.join(k.to_string())).unwrap();
        }
        let (mut again, events) = open(&path);
        let told = warned(&events).join("\n");
        for name in missing {
            assert!(told.contains(name), "{name}: {told}");
        }
        assert_eq!(warned(&events).len(), 3, "{told}");
        let project = again.project().clone();
        assert_eq!((project.size.as_deref(), project.layer), (Some("L"), 1));
        assert_eq!(project.width, Some(1.42));
        assert!(!again.is_unsaved());
        match gone {
            // The values of a table are the pattern's own.
            "anna.json" => assert_eq!(project.body_measurements(), measurements),
            _ => assert!(matches!(project.body, BodyChoice::Missing { .. })),
        }
        // What is there is worn, cut and drafted all the same.
        assert_eq!(again.garment_setup().unwrap().parts.len(), 1);
        assert_eq!(again.draft().fabrics[0].name, "poplin");
        // Another change takes nothing of it away; nor does a layer that is put elsewhere.
        run(&mut again, Command::SetSize { size: None }).unwrap();
        let others = vec![OtherGarment {
            path: project.others[0].source.clone(),
            layer: 7,
        }];
        run(&mut again, Command::SetLayers { layer: 1, others }).unwrap();
        run(&mut again, Command::Undo).unwrap();
        run(&mut again, Command::Undo).unwrap();
        run(&mut again, Command::SavePattern { path: path.clone() }).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), whole);
        for (k, name) in missing.iter().enumerate() {
            std::fs::rename(hidden.join(k.to_string()), folder.join(name)).unwrap();
        }
        let (back, events) = open(&path);
        assert_eq!(warned(&events), [""; 0]);
        assert_eq!(
            seen(back.project(), folder),
            seen(session.project(), folder)
        );
    }
}

#[test]
fn choices_that_make_no_sense_are_refused_and_nothing_changes() {
    let place = tempfile::tempdir().unwrap();
    let mut session = at_work(place.path());
    let before = session.project().clone();
    let measured = |name: &str, value: f64| {
        let mut measurements = Measurements::new();
        measurements.set(name, value, Origin::Asked).unwrap();
        Command::SetMeasurements {
            figure: None,
            measurements,
        }
    };
    let itself = Command::SetLayers {
        layer: 1,
        others: vec![OtherGarment {
            path: place.path().join("layers/../band.toile.json"),
            layer: 2,
        }],
    };
    for (command, words) in [
        (measured("waist", -0.7), "waist is -0.7 m"),
        (measured("collar", 0.0), "above 0"),
        (itself, "the pattern itself"),
        (
            Command::SetWidth {
                width: Some(f64::NAN),
            },
            "NaN",
        ),
    ] {
        let error = run(&mut session, command).unwrap_err();
        assert!(error.is_bad_input());
        assert!(error.to_string().contains(words), "{error}");
        assert_eq!(*session.project(), before);
    }
    // In a file that says so it is named and left off.
    let path = place.path().join("band.toile.json");
    run(&mut session, Command::SavePattern { path: path.clone() }).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let fitting =
        r#""fitting": {"worn_with": [{"file": "band.toile.json", "layer": 3}]}, "next_id""#;
    std::fs::write(&path, text.replacen("\"next_id\"", fitting, 1)).unwrap();
    let (session, events) = open(&path);
    assert!(warned(&events)[0].contains("the pattern itself"));
    assert_eq!(session.project().others[0].pattern, None);
}

#[test]
fn a_chosen_size_and_fabric_keep_their_part_under_another_name() {
    let place = tempfile::tempdir().unwrap();
    let mut session = at_work(place.path());
    let size = Some("L".to_owned());
    run(&mut session, Command::SetSize { size }).unwrap();
    let fabric = Some("poplin".to_owned());
    run(&mut session, Command::SetFabric { fabric }).unwrap();
    let rename = |session: &mut Session, part: toile_pattern::PartId, name: &str| {
        let evaluation = session.evaluation();
        let edits = toile_pattern::plan::rename(&evaluation, part, name).unwrap();
        let label = "Rename".to_owned();
        run(session, Command::Edit { edits, label }).unwrap();
    };
    let pattern = session.project().pattern.clone();
    rename(
        &mut session,
        pattern.size_named("L").unwrap().id.into(),
        "42",
    );
    assert_eq!(session.project().size.as_deref(), Some("42"));
    rename(&mut session, pattern.fabrics[0].id.into(), "Calico");
    assert_eq!(session.project().fabric.as_ref().unwrap().name(), "Calico");
    let gone = pattern.size_named("L").unwrap().id.into();
    let edits = vec![toile_pattern::Edit::Remove(gone)];
    let label = "Remove size".to_owned();
    run(&mut session, Command::Edit { edits, label }).unwrap();
    assert_eq!(session.project().size, None);
}

#[test]
fn a_crash_loses_nothing_of_it() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let mut session = at_work(folder);
    for (command, _) in choices(folder) {
        run(&mut session, command).unwrap();
    }
    let states = folder.join("states");
    let recovery = Recovery::start(&states).unwrap();
    recovery.keep(session.project(), session.steps_to_keep());
    drop(recovery);
    let found = abandoned(&states).unwrap().remove(0);
    let mut again = Session::new();
    let restore = Command::RestorePattern {
        text: found.text.clone(),
        source: found.source.clone(),
        past: found.past.clone(),
    };
    let events = run(&mut again, restore).unwrap();
    assert_eq!(warned(&events), [""; 0]);
    assert_eq!(
        seen(again.project(), folder),
        seen(session.project(), folder)
    );
    assert!(again.is_unsaved());
}

#[test]
fn typed_measurements_are_replayed_and_a_kept_fitting_is_made_to_the_same_bytes() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let mut session = at_work(folder);
    let choices = choices(folder);
    for k in [3, 5, 7, 8] {
        run(&mut session, choices[k].0.clone()).unwrap();
    }
    let lines = journal_lines(&session.journal()).unwrap();
    let mut again = Session::new();
    for command in read_journal(&lines).unwrap() {
        run(&mut again, command).unwrap();
    }
    assert_eq!(again.project(), session.project());
    assert!(read_journal(r#"{"command":"set_measurements","measurements":{"waist":{"value":null,"origin":"asked"}}}"#).is_err());
    // The file alone makes what the choices made, and so does its journal.
    let path = folder.join("kept.toile.json");
    run(&mut session, Command::SavePattern { path: path.clone() }).unwrap();
    let out: Vec<PathBuf> = ["made", "again"]
        .iter()
        .map(|name| folder.join(name))
        .collect();
    let commands = make(&path, &out[0]);
    Session::new().execute_all(&commands, &mut Silent).unwrap();
    let made = files(&out[0]);
    assert!(made.contains_key("layer-2-belt.obj"));
    let report = String::from_utf8(made["report.json"].clone()).unwrap();
    assert!(report.contains("denim"), "{report}");
    let (commands, notes) = toile_session::open_journal(&out[0].join("journal.jsonl")).unwrap();
    assert_eq!(notes, [""; 0]);
    Session::replay(&commands, &out[1], &mut Silent).unwrap();
    assert_eq!(lasting(&out[0]), lasting(&out[1]));
    // A layer that was changed since is said to be another.
    let belt = folder.join("layers/belt.toile.json");
    let text = std::fs::read_to_string(&belt).unwrap();
    std::fs::write(&belt, text.replace("+ 2cm", "+ 3cm")).unwrap();
    let (_, notes) = toile_session::open_journal(&out[0].join("journal.jsonl")).unwrap();
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].contains("belt.toile.json"), "{notes:?}");
}

#[test]
fn jobs_without_a_session_take_what_the_file_keeps() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let mut session = at_work(folder);
    let choices = choices(folder);
    for k in [2, 4, 5, 7, 8] {
        run(&mut session, choices[k].0.clone()).unwrap();
    }
    let path = folder.join("band.toile.json");
    run(&mut session, Command::SavePattern { path: path.clone() }).unwrap();
    // Marker: fabric and width; the pieces are those of size L.
    let options = NestOptions {
        budget: Budget::Evaluations(1000),
        ..NestOptions::default()
    };
    let nest = |path: &Path, options: &NestOptions| {
        let patterns = [path.to_owned()];
        let made = nest_patterns(&patterns, options, (&folder.join("marker"), &mut Silent));
        made.unwrap().0.remove(0)
    };
    let kept = nest(&path, &options);
    assert_eq!((&*kept.fabric, kept.width), ("denim", 1.42));
    let plain = folder.join("plain.toile.json");
    std::fs::write(&plain, BAND).unwrap();
    let medium = nest(&plain, &options);
    assert_eq!((&*medium.fabric, medium.width), ("poplin", 1.5));
    let area = |made: &MarkerSummary| made.efficiency * made.length * made.width;
    assert!(area(&kept) > area(&medium));
    // An option says otherwise.
    let asked = NestOptions {
        cloth: ClothSettings {
            width: Some(0.9),
            ..ClothSettings::default()
        },
        ..options
    };
    assert_eq!(nest(&path, &asked).width, 0.9);
    // Paper and mesh: the size.
    let (project, notes) = Project::open(&path).unwrap();
    assert_eq!(notes, [""; 0]);
    let to = folder.join("band.svg");
    let printed = print_pattern((&project, &to), &PrintOptions::default(), &mut Silent).unwrap();
    assert_eq!(printed.sizes, ["L"]);
    let mesh = |path: &Path, size: Option<&str>| {
        let to = folder.join("mesh.obj");
        let (_, notes) = mesh_panels(path, size, 0.02, &to).unwrap();
        assert_eq!(notes, [""; 0]);
        std::fs::read(to).unwrap()
    };
    assert_eq!(mesh(&path, None), mesh(&plain, Some("L")));
    assert_eq!(mesh(&path, Some("M")), mesh(&plain, None));
    // Converted to another folder it still names its files; GarmentCode has no place for them.
    std::fs::create_dir(folder.join("far")).unwrap();
    let far = folder.join("far/band.toile.json");
    let options = ConvertOptions::default();
    let converted = convert(&path, &far, &options).unwrap();
    assert_eq!(converted.notes, [""; 0]);
    assert_eq!(converted.written.losses, []);
    let (again, events) = open(&far);
    assert_eq!(warned(&events), [""; 0]);
    assert_eq!(again.project().others[0].name(), "Belt");
    let lost = convert(&path, &folder.join("band.json"), &options)
        .unwrap()
        .written
        .losses;
    assert!(
        lost.iter().any(|loss| loss.what == "the fitting"),
        "{lost:?}"
    );
}

#[test]
fn a_garment_is_draped_without_figures_that_rest_does_not_show_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let pattern = support::band(folder.path());
    let file = folder.path().join("scuba.json");
    let text = r#"{ "toile": 1, "kind": "fabric", "density": 0.3, "strain_limit": [0.2, null],
        "compression": "tension-field", "bend_poisson": 0.1, "stiffness_damping": 0.001,
        "restitution": 0.5 }"#;
    std::fs::write(&file, text).unwrap();
    let mut commands = make(&pattern, &folder.path().join("out"));
    commands.insert(
        1,
        Command::SetFabric {
            fabric: Some(file.display().to_string()),
        },
    );
    let mut session = Session::new();
    let mut told = Vec::new();
    for command in commands {
        let events = run(&mut session, command).unwrap();
        told.extend(warned(&events).into_iter().map(str::to_owned));
    }
    for word in ["restitution", "viscosity"] {
        assert!(told.iter().any(|t| t.contains(word)), "{word}: {told:?}");
    }
    let report = std::fs::read_to_string(folder.path().join("out/report.json")).unwrap();
    assert!(
        report.contains("restitution acts on impacts only"),
        "{report}"
    );
}
