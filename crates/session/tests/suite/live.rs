//! Live runs: the same rest as a drape, inputs by steps, results handed back to the session.

use crate::support::{band, lasting, make};
use std::path::Path;
use std::time::Duration;
use toile_drape::{Action, GarmentRun, Input, Parameter};
use toile_geometry::Vec3;
use toile_session::{
    Command, DrapeResult, GarmentJob, LiveRun, Quality, Session, Silent, Stage, let_go_of_vertex,
    open_journal, pull_vertex,
};

/// A session with the band in it, meshed coarsely.
fn prepared(folder: &Path) -> Session {
    let mut session = Session::new();
    let commands = make(&band(folder), folder);
    session.execute_all(&commands[..2], &mut Silent).unwrap();
    session
}

fn wait_for_end(live: &LiveRun) {
    for _ in 0..12_000 {
        if live.is_finished() {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("still running after a minute");
}

fn finished(live: &LiveRun) -> DrapeResult {
    wait_for_end(live);
    assert_eq!(live.failure(), None);
    live.result().unwrap()
}

fn bits(positions: &[Vec3]) -> Vec<[u64; 3]> {
    positions
        .iter()
        .map(|p| [p.x, p.y, p.z].map(f64::to_bits))
        .collect()
}

/// A vertex at the upper edge of the front, and a place half a metre before it.
fn handle(job: &GarmentJob) -> (u32, [f64; 3]) {
    let at = &job.garment.positions;
    let highest = (0..at.len()).max_by(|&a, &b| at[a].y.total_cmp(&at[b].y));
    let vertex = highest.unwrap();
    (vertex as u32, (at[vertex] + Vec3::z() * 0.5).into())
}

fn at(step: u64, action: Action) -> Input {
    Input { step, action }
}

#[test]
fn a_live_run_comes_to_the_same_rest() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();

    let live = LiveRun::start(job.clone());
    live.pause();
    assert!(live.is_paused());
    live.resume();
    let (mut last, mut step, mut share) = (None, 0, 0.0);
    for _ in 0..6000 {
        let ended = live.is_finished();
        if let Some(frame) = live.latest() {
            assert!(frame.step >= step && frame.share >= share);
            (step, share) = (frame.step, frame.share);
            assert_eq!(frame.target.len(), job.garment.positions.len());
            last = Some(frame);
        } else if ended {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(live.failure(), None);
    let last = last.unwrap();
    assert_eq!((last.stage, last.share), (Stage::Finished, 1.0));

    let mut run = GarmentRun::new(job.setup.clone()).unwrap();
    while run.advance().unwrap().stage != Stage::Finished {}
    assert_eq!(bits(&last.positions), bits(&run.state.positions));
    assert_eq!(live.result().unwrap().mesh().positions, run.state.positions);
    assert_eq!(live.inputs(), []);

    // A run that is dropped, held or not, ends its thread.
    drop(LiveRun::start(job.clone()));
    let held = LiveRun::start(job);
    held.pause();
    drop(held);
}

#[test]
fn the_same_inputs_give_the_same_positions_bit_by_bit() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();
    let (vertex, to) = handle(&job);
    let untouched = finished(&LiveRun::start(job.clone()));
    let last_step = untouched.summary().steps.iter().sum::<usize>() as u64;

    // Held while it is sewn, drawn on while it settles, let go at last.
    let drag = |share: f64| pull_vertex(vertex, [to[0], to[1], to[2] * share]);
    let live = LiveRun::start(job.clone());
    live.pause();
    for (step, input) in [
        (2, drag(1.0)),
        (last_step / 2, drag(0.9)),
        (last_step / 2, drag(0.8)),
        (last_step, let_go_of_vertex(vertex)),
        (last_step, let_go_of_vertex(vertex + 1)),
    ] {
        live.give_at(at(step, input)).unwrap();
    }
    live.resume();
    let first = finished(&live);
    // Of two inputs in one step the newest counts; letting go of what is not held is nothing.
    let applied = live.inputs();
    assert_eq!(applied, first.inputs());
    assert_eq!(applied[0], at(2, drag(1.0)));
    assert_eq!(applied[1], at(last_step / 2, drag(0.8)));
    assert_eq!(applied[2].action, let_go_of_vertex(vertex));
    assert_eq!(applied.len(), 3);
    assert_ne!(
        bits(&first.mesh().positions),
        bits(&untouched.mesh().positions)
    );

    let again = LiveRun::start(job);
    for stamped in first.inputs() {
        again.give_at(stamped.clone()).unwrap();
    }
    let again = finished(&again);
    assert_eq!(again.inputs(), first.inputs());
    assert_eq!(bits(&again.mesh().positions), bits(&first.mesh().positions));
}

#[test]
fn cloth_that_is_held_goes_to_the_hand_and_falls_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();
    let (vertex, to) = handle(&job);
    let live = LiveRun::start(job);
    live.give(pull_vertex(vertex, to)).unwrap();
    // It comes to rest in the hand, and does not end.
    let mut frame = None;
    for _ in 0..12_000 {
        frame = live.latest().or(frame);
        if frame.as_ref().is_some_and(|f| f.stage == Stage::Finished) {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let held = frame.unwrap();
    assert_eq!(held.stage, Stage::Finished);
    std::thread::sleep(Duration::from_millis(50));
    assert!(!live.is_finished() && live.result().is_none());
    let place = |positions: &[Vec3]| positions[held.target[vertex as usize] as usize];
    let in_hand = place(&held.positions);

    // Whenever the hand lets go, the journal knows: replayed it is the same garment.
    live.give(let_go_of_vertex(vertex)).unwrap();
    let released = finished(&live);
    let fallen = place(&released.mesh().positions);
    let to = Vec3::from(to);
    assert!(
        (in_hand - to).norm() + 0.02 < (fallen - to).norm(),
        "{in_hand:?} {fallen:?}"
    );
    assert_eq!(released.inputs().len(), 2);
    let inputs = released.inputs().to_vec();
    let events = session
        .execute(Command::Drape { inputs }, &mut Silent)
        .unwrap();
    assert!(!events.is_empty());
    assert_eq!(session.draped(), Some(released.summary()));
}

#[test]
fn cloth_is_held_on_coarse_meshes_too() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let coarse = session.garment_setup().unwrap();
    let quality = Quality::Fit;
    session
        .execute(Command::SetQuality { quality }, &mut Silent)
        .unwrap();
    let mut job = session.garment_setup().unwrap();
    job.setup.levels = vec![
        coarse.setup.levels.last().unwrap().clone(),
        job.setup.levels.last().unwrap().clone(),
    ];
    let (vertex, to) = handle(&job);
    let drag = pull_vertex(vertex, to);
    let live = LiveRun::start(job.clone());
    live.give(drag).unwrap();
    let mut is_held = true;
    let mut levels = Vec::new();
    while !live.is_finished() {
        let Some(frame) = live.latest() else {
            std::thread::sleep(Duration::from_millis(1));
            continue;
        };
        assert_eq!(frame.target.len(), job.garment.positions.len());
        assert!(
            frame
                .target
                .iter()
                .all(|&v| (v as usize) < frame.positions.len())
        );
        if levels.last() != Some(&frame.positions.len()) {
            levels.push(frame.positions.len());
        }
        // Let go when the finest mesh has been swung, so that the cloth comes to rest once and not twice.
        let has_swung = matches!(frame.stage, Stage::Settling | Stage::Finished);
        if is_held && frame.takes_edits && has_swung {
            live.give(let_go_of_vertex(vertex)).unwrap();
            is_held = false;
        }
    }
    assert!(!is_held);
    let first = finished(&live);
    assert!(levels.contains(&first.mesh().positions.len()) && levels.len() > 1);
    assert_eq!(first.inputs().len(), 2);
    let again = LiveRun::start(job);
    for stamped in first.inputs() {
        again.give_at(stamped.clone()).unwrap();
    }
    let again = finished(&again);
    assert_eq!(again.inputs(), first.inputs());
    assert_eq!(bits(&again.mesh().positions), bits(&first.mesh().positions));
}

#[test]
fn inputs_that_make_no_sense_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();
    let count = job.garment.positions.len() as u32;
    let live = LiveRun::start(job);
    live.pause();
    for (vertex, x) in [
        (count, 0.0),
        (u32::MAX, 0.0),
        (0, f64::NAN),
        (0, 1e300),
        (0, -1e3),
    ] {
        let input = pull_vertex(vertex, [0.0, x, 0.0]);
        let error = live.give(input.clone()).unwrap_err();
        assert!(error.is_bad_input(), "{error}");
        let before = session.journal().len();
        let inputs = vec![at(0, input)];
        assert!(
            session
                .execute(Command::Drape { inputs }, &mut Silent)
                .is_err()
        );
        assert_eq!(session.journal().len(), before);
    }
    live.stop();
    wait_for_end(&live);
    assert!(live.result().is_none() && live.failure().is_none());
}

#[test]
fn journals_of_earlier_versions_name_drags_by_vertices() {
    let line = r#"{"command": "drape", "inputs": [
        {"step": 120, "input": "drag", "vertex": 57, "to": [0.1, 1.2, 0.3]},
        {"step": 180, "input": "release", "vertex": 57}]}"#;
    let read: Command = serde_json::from_str(line).unwrap();
    let inputs = vec![
        at(120, pull_vertex(57, [0.1, 1.2, 0.3])),
        at(180, let_go_of_vertex(57)),
    ];
    assert_eq!(read, Command::Drape { inputs });
    let written = serde_json::to_string(&read).unwrap();
    assert!(written.contains(r#""action":{"pull""#), "{written}");
    assert_eq!(serde_json::from_str::<Command>(&written).unwrap(), read);
    let wrong = line.replace("drag", "push");
    assert!(serde_json::from_str::<Command>(&wrong).is_err());
}

#[test]
fn a_garment_takes_hands_alone() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let live = LiveRun::start(session.garment_setup().unwrap());
    live.pause();
    let gravity = Action::Set(Parameter::Gravity(Vec3::zeros()));
    let said = live.give(gravity).unwrap_err();
    assert!(said.is_bad_input(), "{said}");
    assert!(said.to_string().contains("hands on its vertices"), "{said}");
}

#[test]
fn a_hand_on_a_vertex_without_cloth_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let mut job = session.garment_setup().unwrap();
    let vertex = job.garment.positions.len() as u32;
    let mut garment = (*job.garment).clone();
    garment.positions.push(Vec3::zeros());
    job.garment = garment.into();
    let live = LiveRun::start(job);
    live.pause();
    let to = [0.0, 1.0, 0.0];
    for input in [pull_vertex(vertex, to), let_go_of_vertex(vertex)] {
        let error = live.give(input).map_err(|error| error.to_string());
        let error = error.unwrap_err();
        assert!(error.contains(&format!("{vertex}")), "{error}");
        assert!(error.contains("no triangle"), "{error}");
    }
}

#[test]
fn a_run_whose_thread_panics_ends_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let mut job = session.garment_setup().unwrap();
    // No session makes such a stitch: the simulation takes its vertices for granted.
    job.setup.levels[0].stitches.push([u32::MAX, 0]);
    let live = LiveRun::start(job);
    wait_for_end(&live);
    assert!(live.result().is_none());
    let failure = live.failure().unwrap();
    assert!(failure.contains("fault of the program"), "{failure}");
    assert!(failure.contains("index out of bounds"), "{failure}");
}

#[test]
fn a_result_is_exported_without_draping_again_and_replayed_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();
    let (vertex, to) = handle(&job);
    let live = LiveRun::start(job);
    for stamped in [
        at(5, pull_vertex(vertex, to)),
        at(9, let_go_of_vertex(vertex)),
    ] {
        live.give_at(stamped).unwrap();
    }
    let result = finished(&live);
    assert_eq!(session.draped(), None);
    let events = session.adopt_drape(result.clone()).unwrap();
    assert!(!events.is_empty());
    assert_eq!(session.draped(), Some(result.summary()));
    let dir = folder.path().join("out");
    let mut stages = Vec::new();
    let mut watcher = |stage: &str, _: f64, _: &str| {
        stages.push(stage.to_owned());
        std::ops::ControlFlow::Continue(())
    };
    session
        .execute(Command::export(&dir), &mut watcher)
        .unwrap();
    assert!(stages.iter().all(|stage| stage == "writing"), "{stages:?}");

    let exported = lasting(&dir);
    let (journal, notes) = open_journal(&dir.join("journal.jsonl")).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let again = folder.path().join("again");
    Session::replay(&journal, &again, &mut Silent).unwrap();
    assert_eq!(exported, lasting(&again));
}

#[test]
fn a_late_result_of_an_older_revision_is_dropped() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let mut snapshot = session.snapshot();
    let job = snapshot.garment_setup().unwrap();
    assert_eq!(job.revision, session.revision());
    let result = finished(&LiveRun::start(job));
    session.adopt(snapshot);
    let size = Some("L".to_owned());
    session
        .execute(Command::SetSize { size }, &mut Silent)
        .unwrap();
    let journal = session.journal();
    assert_eq!(session.adopt_drape(result), None);
    assert_eq!(session.draped(), None);
    assert_eq!(session.journal(), journal);
}
