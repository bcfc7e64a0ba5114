//! Commands, history and journal: invariants after any sequence.

use crate::support::{BAND, band};
use proptest::prelude::*;
use std::sync::Arc;
use toile_body::Figure;
use toile_pattern::{Edit, Entity, Fabric, Pattern, Point, PointId, PointRule, SizeId, plan};
use toile_session::{
    BodyChoice, Command, Event, Project, Quality, Session, SessionError, Silent, journal_lines,
    read_journal,
};

fn opened() -> (Session, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let path = band(folder.path());
    let mut session = Session::new();
    session.execute(Command::open(path), &mut Silent).unwrap();
    (session, folder)
}

fn move_point(session: &Session, which: usize, to: [f64; 2]) -> Edit {
    let sheet = &session.project().pattern.sheets[which % 2];
    let point = &sheet.points[which / 2 % sheet.points.len()];
    let moved = Point {
        rule: PointRule::at(to[0], to[1]),
        ..(**point).clone()
    };
    Edit::Put(Entity::Point(sheet.id, Arc::new(moved)))
}

/// The edit that removes a size.
fn remove_size(session: &Session, name: &str) -> Edit {
    let id = session.project().pattern.size_named(name).unwrap().id;
    Edit::Remove(id.into())
}

fn edit(edits: Vec<Edit>) -> Command {
    Command::Edit {
        edits,
        label: "Move point".into(),
    }
}

fn run(session: &mut Session, command: Command) -> Result<Vec<Event>, SessionError> {
    session.execute(command, &mut Silent)
}

#[test]
fn a_gesture_is_one_step_and_one_command() {
    let (mut session, _folder) = opened();
    let start = session.project().clone();
    for k in 0..20 {
        let step = move_point(&session, 0, [-0.2, -0.05 - 0.001 * f64::from(k)]);
        session.preview(&[step]).unwrap();
        assert_eq!(session.can_undo(), None);
    }
    let shown = session.project().pattern.clone();
    assert_eq!(session.commit("Move point").unwrap().len(), 1);
    assert!(session.project().pattern.says_the_same(&shown));
    let next = move_point(&session, 2, [0.2, -0.05]);
    session.preview(&[next]).unwrap();
    session.commit("Move point").unwrap();
    assert_eq!(session.journal().len(), 3, "opened, moved, moved");
    assert_eq!(session.can_undo(), Some("Move point"));
    run(&mut session, Command::Undo).unwrap();
    run(&mut session, Command::Undo).unwrap();
    assert!(same(session.project(), &start));
    assert_eq!(session.can_undo(), None);
    assert_eq!(session.can_redo(), Some("Move point"));
}

/// Whether two projects are the same, whatever ids would be given next.
fn same(a: &Project, b: &Project) -> bool {
    let with_pattern_of_a = Project {
        pattern: a.pattern.clone(),
        ..b.clone()
    };
    a.pattern.says_the_same(&b.pattern) && *a == with_pattern_of_a
}

#[test]
fn a_gesture_that_is_left_leaves_nothing() {
    let (mut session, _folder) = opened();
    let (start, draft) = (session.project().clone(), session.draft());
    let revision = session.revision();
    let step = move_point(&session, 0, [-0.3, -0.05]);
    session.preview(std::slice::from_ref(&step)).unwrap();
    assert!(*session.draft() != *draft);
    assert!(session.revision() > revision, "what is shown is another");
    // Edits that cannot be made leave what was shown before.
    let shown = session.project().clone();
    assert!(session.preview(&[step.clone(), remove_nothing()]).is_err());
    assert_eq!(*session.project(), shown);
    assert_eq!(session.cancel(), Some(vec![step.clone()]));
    assert_eq!(*session.project(), start);
    assert!(
        Arc::ptr_eq(&session.draft(), &draft),
        "nothing is made anew"
    );
    assert_eq!((session.can_undo(), session.journal().len()), (None, 1));
    assert_eq!(session.commit("Move point").unwrap(), []);
    // So does any command that is given meanwhile.
    session.preview(&[step]).unwrap();
    let size = Some("L".to_owned());
    run(&mut session, Command::SetSize { size }).unwrap();
    assert_eq!(session.project().pattern, start.pattern);
    assert!(!session.is_previewing());
}

fn remove_nothing() -> Edit {
    Edit::Remove(SizeId(9999).into())
}

#[test]
fn what_was_made_stays_while_the_draft_is_the_same() {
    let (mut session, _folder) = opened();
    run(&mut session, Command::Assemble).unwrap();
    let before = session.garment_setup().unwrap();
    let mut moved = (*session.project().pattern.panels[0]).clone();
    moved.on_table = Some([0.3, 0.4]);
    let put = Edit::Put(Entity::Panel(Arc::new(moved.clone())));
    run(&mut session, edit(vec![put])).unwrap();
    let after = session.garment_setup().unwrap();
    assert!(Arc::ptr_eq(&before.garment, &after.garment));
    moved.name = "other".into();
    let put = Edit::Put(Entity::Panel(Arc::new(moved)));
    run(&mut session, edit(vec![put])).unwrap();
    let renamed = session.garment_setup().unwrap();
    assert!(!Arc::ptr_eq(&before.garment, &renamed.garment));
}

#[test]
fn a_fabric_that_nothing_is_cut_from_does_not_act() {
    let (mut session, _folder) = opened();
    let materials = |session: &mut Session| {
        let setup = session.garment_setup().unwrap().setup;
        setup.levels.last().unwrap().cloth.materials.clone()
    };
    let before = materials(&mut session);
    let mut pattern = Pattern::clone(&session.project().pattern);
    let mut felt = Fabric::poplin(pattern.ids.take());
    (felt.name, felt.material.thickness) = ("felt".into(), 0.03);
    let put = Edit::Put(Entity::Fabric(Arc::new(felt)));
    run(&mut session, edit(vec![put])).unwrap();
    assert_eq!(session.project().pattern.fabrics.len(), 2);
    assert_eq!(materials(&mut session), before);
}

#[test]
fn a_new_pattern_is_empty_and_saved_only_when_it_was_changed() {
    let (mut session, _folder) = opened();
    let name = "A skirt".to_owned();
    run(&mut session, Command::NewPattern { name }).unwrap();
    let pattern = session.project().pattern.clone();
    assert_eq!((pattern.panels.len(), pattern.sheets.len()), (0, 1));
    assert_eq!((session.can_undo(), session.is_unsaved()), (None, false));
    assert_eq!(session.project().source, None);
    let sheet = pattern.sheets[0].id;
    let point = Point {
        id: PointId(pattern.ids.next),
        name: "A".into(),
        rule: PointRule::at(0.0, 0.0),
    };
    let put = Edit::Put(Entity::Point(sheet, Arc::new(point)));
    run(&mut session, edit(vec![put])).unwrap();
    assert!(session.is_unsaved());
    run(&mut session, Command::Undo).unwrap();
    assert!(!session.is_unsaved());
    let name = " ".to_owned();
    let refused = run(&mut session, Command::NewPattern { name }).unwrap_err();
    assert!(refused.is_bad_input(), "{refused}");
}

#[test]
fn the_journal_is_bounded_and_a_broken_one_is_not_written() {
    let (mut session, folder) = opened();
    for k in 0..1001 {
        let width = Some(1.0 + 0.0001 * f64::from(k));
        run(&mut session, Command::SetWidth { width }).unwrap();
    }
    assert_eq!(session.journal().len(), 1000);
    assert_eq!(session.past().len(), 1000);
    run(&mut session, Command::Nest).unwrap();
    let dir = folder.path().join("out");
    let events = run(&mut session, Command::export(&dir)).unwrap();
    let told = |event: &Event| matches!(event, Event::Warned { message } if message.contains("journal.jsonl was left out"));
    assert!(events.iter().any(told), "{events:?}");
    assert!(dir.join("marker.svg").exists() && !dir.join("journal.jsonl").exists());
}

#[test]
fn refused_commands_change_nothing() {
    let (mut session, folder) = opened();
    let good = move_point(&session, 0, [-0.25, -0.04]);
    let bad = remove_nothing();
    let missing = folder.path().join("nobody.yaml");
    let refused = [
        edit(vec![good, bad]),
        Command::SetSize {
            size: Some("XXL".into()),
        },
        Command::SetFabric {
            fabric: Some("gossamer of nowhere".into()),
        },
        Command::SetWidth {
            width: Some(f64::NAN),
        },
        Command::SetWidth { width: Some(-1.0) },
        Command::SetBody {
            figure: None,
            measurements: Some(missing.clone()),
        },
        Command::open(missing),
        Command::Undo,
        Command::Redo,
        Command::export(&folder.path().join("out")),
    ];
    let (before, revision, journal) = (
        session.project().clone(),
        session.revision(),
        session.journal(),
    );
    for command in refused {
        let error = run(&mut session, command.clone()).unwrap_err();
        assert!(error.is_bad_input(), "{command:?}: {error}");
        assert!(!error.to_string().is_empty());
        assert_eq!(*session.project(), before, "{command:?}");
        assert_eq!(session.revision(), revision);
        assert_eq!(session.journal(), journal);
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn bodies_and_sizes_decide_the_measurements() {
    let (mut session, folder) = opened();
    let waist = |session: &Session| {
        let project = session.project();
        [
            project.body_measurements(),
            project.drafted_to().measurements,
        ]
        .map(|t| t.get("waist").unwrap())
    };
    assert_eq!(session.project().figure(), Figure::Woman);
    assert_eq!(waist(&session), [0.84, 0.84]);
    run(
        &mut session,
        Command::SetSize {
            size: Some("L".into()),
        },
    )
    .unwrap();
    assert_eq!(waist(&session), [0.9, 0.9]);
    // A file decides the body; the named size still decides the draft.
    let file = folder.path().join("me.yaml");
    std::fs::write(&file, "body:\n  waist: 87\n").unwrap();
    run(
        &mut session,
        Command::SetBody {
            figure: Some(Figure::Man),
            measurements: Some(file),
        },
    )
    .unwrap();
    assert_eq!(waist(&session), [0.87, 0.9]);
    run(&mut session, Command::SetSize { size: None }).unwrap();
    assert_eq!(waist(&session), [0.87, 0.87]);
    assert_eq!(session.project().figure(), Figure::Man);
    run(
        &mut session,
        Command::SetBody {
            figure: Some(Figure::Mean),
            measurements: None,
        },
    )
    .unwrap();
    assert_eq!(session.project().body, BodyChoice::Sample(Figure::Mean));
    assert!((waist(&session)[0] - 0.845).abs() < 1e-12);
}

#[test]
fn a_size_that_is_edited_away_is_no_longer_chosen() {
    let (mut session, _folder) = opened();
    let size = Some("L".to_owned());
    run(&mut session, Command::SetSize { size }).unwrap();
    let gone = remove_size(&session, "L");
    run(&mut session, edit(vec![gone])).unwrap();
    assert_eq!(session.project().size, None);
    run(&mut session, Command::Undo).unwrap();
    assert_eq!(session.project().size.as_deref(), Some("L"));
}

#[test]
fn ids_are_never_given_twice() {
    let (mut session, folder) = opened();
    let path = folder.path().join("saved.toile.json");
    let split = |session: &mut Session| {
        let evaluation = session.evaluation();
        let panel = &evaluation.pattern().panels[0];
        let edge = panel.lines[0].edges[0].id;
        plan::divide_edge(&evaluation, (panel.id, edge), None)
            .unwrap()
            .0
    };
    let points = |session: &Session| -> Vec<PointId> {
        let sheets = &session.project().pattern.sheets;
        sheets
            .iter()
            .flat_map(|sheet| sheet.points.iter().map(|p| p.id))
            .collect()
    };
    let start = session.project().pattern.clone();
    let mut given = points(&session);
    for round in 0..5 {
        let step = split(&mut session);
        run(&mut session, edit(step)).unwrap();
        let new: Vec<PointId> = points(&session)
            .into_iter()
            .filter(|id| start.point(*id).is_none())
            .collect();
        assert!(!new.is_empty());
        assert!(
            new.iter().all(|id| !given.contains(id)),
            "round {round}: {new:?}"
        );
        given.extend(new);
        run(&mut session, Command::Undo).unwrap();
        assert!(session.project().pattern.says_the_same(&start));
        if round == 2 {
            // What was given before is remembered in the file too, and past a redo.
            run(&mut session, Command::Redo).unwrap();
            run(&mut session, Command::Undo).unwrap();
            run(&mut session, Command::SavePattern { path: path.clone() }).unwrap();
            run(&mut session, Command::open(path.clone())).unwrap();
        }
    }
}

#[test]
fn a_saved_pattern_opens_as_the_same_pattern() {
    let (mut session, folder) = opened();
    let path = folder.path().join("saved.toile.json");
    let move_it = move_point(&session, 3, [0.21, -0.05]);
    run(&mut session, edit(vec![move_it])).unwrap();
    run(&mut session, Command::SavePattern { path: path.clone() }).unwrap();
    let mut again = Session::new();
    run(&mut again, Command::open(path)).unwrap();
    assert_eq!(again.project().pattern, session.project().pattern);
}

#[test]
fn damaged_journals_are_refused_with_their_line() {
    let text = "{\"command\":\"check\"}\n\n{\"command\":\"fly\"}\n";
    let error = read_journal(text).unwrap_err().to_string();
    assert!(error.contains("line 3"), "{error}");
}

#[test]
fn faults_keep_a_garment_from_being_made() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("crossed.toile.json");
    std::fs::write(
        &path,
        BAND.replace("[\"half / 2\", 4]", "[\"-half / 2\", -9]"),
    )
    .unwrap();
    let mut session = Session::new();
    run(&mut session, Command::open(path)).unwrap();
    let events = run(&mut session, Command::Check).unwrap();
    assert!(
        matches!(events[0], Event::Checked { errors, .. } if errors > 0),
        "{events:?}"
    );
    for command in [Command::Nest, Command::Assemble, Command::drape()] {
        let error = run(&mut session, command).unwrap_err();
        assert!(error.is_bad_input());
        assert!(error.to_string().contains("crossed.toile.json"), "{error}");
    }
}

#[test]
fn snapshots_give_back_what_they_derived() {
    let (mut session, _folder) = opened();
    let mut snapshot = session.snapshot();
    let drafted = snapshot.draft();
    session.adopt(snapshot);
    assert!(Arc::ptr_eq(&session.draft(), &drafted));
    // Of another project only the mannequin is taken, if it fits.
    let mut snapshot = session.snapshot();
    let mannequin = snapshot.mannequin().unwrap();
    let size = Some("L".to_owned());
    run(&mut session, Command::SetSize { size }).unwrap();
    session.adopt(snapshot);
    assert!(!Arc::ptr_eq(&session.draft(), &drafted));
    assert!(!Arc::ptr_eq(&session.mannequin().unwrap(), &mannequin));
}

/// One random command; some of them are refused.
fn any_command() -> impl Strategy<Value = (u8, usize, [f64; 2], bool)> {
    (
        0_u8..9,
        0_usize..8,
        [-0.5..0.5_f64, -0.5..0.5_f64],
        any::<bool>(),
    )
}

fn command_of(session: &Session, (kind, which, place, _): (u8, usize, [f64; 2], bool)) -> Command {
    match kind {
        0..=2 => edit(vec![move_point(session, which, place)]),
        3 => Command::Undo,
        4 => Command::Redo,
        5 => Command::SetSize {
            size: [None, Some("M"), Some("L"), Some("?")][which % 4].map(str::to_owned),
        },
        6 => Command::SetWidth {
            width: Some(place[0]),
        },
        7 => Command::SetQuality {
            quality: [Quality::Preview, Quality::Fit, Quality::Final][which % 3],
        },
        // Refused as a whole: the second edit names a size that is not there.
        _ => edit(vec![move_point(session, which, place), remove_nothing()]),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Any commands: refused ones change nothing, undoing everything gives back the start, redoing
    /// everything the end, and the journal replayed gives the same project.
    #[test]
    fn history_and_journal_hold(steps in proptest::collection::vec(any_command(), 1..40)) {
        let (mut session, folder) = opened();
        let start = session.project().clone();
        for step in steps {
            let command = command_of(&session, step);
            if step.3 {
                // A gesture that is left changes nothing that counts.
                session.preview(&[move_point(&session, 0, step.2)]).unwrap();
                session.cancel();
            }
            let (before, revision) = (session.project().clone(), session.revision());
            match run(&mut session, command) {
                Ok(events) if events.is_empty() => prop_assert_eq!(session.project(), &before),
                Ok(_) => prop_assert_eq!(session.revision(), revision + 1),
                Err(_) => {
                    prop_assert_eq!(session.project(), &before);
                    prop_assert_eq!(session.revision(), revision);
                }
            }
        }
        let journal = read_journal(&journal_lines(&session.journal()).unwrap()).unwrap();
        prop_assert_eq!(&journal, &session.journal());
        let (replayed, _) = Session::replay(&journal, folder.path(), &mut Silent).unwrap();
        prop_assert_eq!(replayed.project(), session.project());

        let end = session.project().clone();
        let mut passed: Vec<Project> = Vec::new();
        while session.can_undo().is_some() {
            passed.push(session.project().clone());
            run(&mut session, Command::Undo).unwrap();
        }
        prop_assert_eq!(session.project(), &start);
        while let Some(expected) = passed.pop() {
            run(&mut session, Command::Redo).unwrap();
            prop_assert_eq!(session.project(), &expected);
        }
        prop_assert_eq!(session.project(), &end);
    }
}

#[test]
fn undo_does_not_forget_where_the_pattern_is_kept() {
    let (mut session, folder) = opened();
    let step = move_point(&session, 0, [-0.2, -0.051]);
    run(&mut session, edit(vec![step])).unwrap();
    let path = folder.path().join("kept.toile.json");
    run(&mut session, Command::SavePattern { path: path.clone() }).unwrap();
    for command in [Command::Undo, Command::Redo] {
        run(&mut session, command).unwrap();
        assert_eq!(session.project().source.as_ref(), Some(&path));
    }
}

#[cfg(unix)]
#[test]
fn a_command_that_cannot_be_written_is_an_error() {
    use std::os::unix::ffi::OsStringExt;
    let path = std::ffi::OsString::from_vec(vec![0xff, 0xfe]).into();
    let error = journal_lines(&[Command::Check, Command::SavePattern { path }]).unwrap_err();
    assert!(
        error.to_string().starts_with("journal, line 2: "),
        "{error}"
    );
}
