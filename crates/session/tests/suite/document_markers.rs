//! Markers of the document from making to cutting: made, searched for, moved, locked, undone, saved
//! and reopened, and what comes of them when points of the pattern move.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use toile_interchange::write_pattern;
use toile_pattern::{
    ClothSettings, Edit, Evaluation, MarkerId, OrderedPiece, OrderedSize, PiecePlacement,
    PointRule, Spread, plan,
};
use toile_session::{
    Budget, Command, Event, MarkerFormat, MarkerJob, MarkerState, NestOptions, SAMPLE, Search,
    SearchProgress, SearchWatcher, Session, SessionError, Silent, SizeSelection, Start,
    nest_marker, nest_patterns,
};

const EVALUATIONS: u64 = 150_000;

fn search(seed: u64) -> Search {
    Search {
        seed,
        ..Search::evaluations(EVALUATIONS)
    }
}

fn opened(path: &str) -> Session {
    let mut session = Session::new();
    session.execute(Command::open(path), &mut Silent).unwrap();
    session
}

fn edit(session: &mut Session, edits: Vec<Edit>) {
    let label = "Edit marker".to_owned();
    session
        .execute(Command::Edit { edits, label }, &mut Silent)
        .unwrap();
}

/// A shirt with a marker for one S and two M.
fn marked(session: &mut Session) -> MarkerId {
    let pattern = session.project().pattern.clone();
    let fabric = pattern.panels[0].fabric;
    let (edits, id) = plan::add_marker(&session.evaluation(), Some("shirts"), fabric).unwrap();
    edit(session, edits);
    let order = [("S", 1), ("M", 2)].map(|(name, quantity)| OrderedSize {
        size: pattern.size_named(name).map(|size| size.id),
        quantity,
    });
    let edits = plan::set_marker_order(&session.evaluation(), id, order.to_vec()).unwrap();
    edit(session, edits);
    id
}

fn lay(session: &mut Session, id: MarkerId, how: (Start, Search)) -> Vec<Event> {
    let job = session.marker_search(id).unwrap();
    let mut follow = SearchWatcher {
        report: &mut |_| true,
        stop: Arc::default(),
    };
    let found = job.run(how, &mut follow).unwrap();
    session.adopt_marker(found).unwrap().unwrap()
}

fn state(session: &mut Session, id: MarkerId) -> MarkerState {
    session.marker(id).unwrap().state()
}

fn placements(session: &Session, id: MarkerId) -> Vec<PiecePlacement> {
    let marker = session.project().pattern.marker(id).unwrap();
    marker.placements.clone()
}

fn piece(session: &Session, id: MarkerId, name: &str) -> OrderedPiece {
    let pattern = &session.project().pattern;
    let panel = pattern.panel_named(name).unwrap().id;
    let is_it = |laid: &&PiecePlacement| laid.piece.panel == panel;
    let all = placements(session, id);
    all.iter().find(is_it).unwrap().piece
}

fn undo(session: &mut Session) {
    session.execute(Command::Undo, &mut Silent).unwrap();
}

/// The pattern as its file, without the count of ids, which undoing does not take back.
fn text(session: &Session) -> String {
    let text = write_pattern(&session.project().pattern).unwrap();
    let end = text.rfind("\"next_id\"").unwrap();
    text[..end].to_owned()
}

/// The markers in a pattern's file.
fn markers_text(session: &Session) -> String {
    let text = text(session);
    text[text.find("\"markers\"").unwrap()..].to_owned()
}

/// Moves a point of the pattern by a millimetre as a gesture, if it can be moved.
fn nudge(session: &mut Session, k: usize) -> bool {
    let pattern = session.project().pattern.clone();
    let points: Vec<_> = pattern.sheets.iter().flat_map(|s| &s.points).collect();
    let point = points[k % points.len()];
    let evaluation = session.evaluation();
    let Some(mut to) = evaluation.point(point.id) else {
        return false;
    };
    if !matches!(point.rule, PointRule::At { .. } | PointRule::Offset { .. }) {
        return false;
    }
    to.y -= 0.001;
    let Ok(edits) = plan::move_point(&evaluation, point.id, to) else {
        return false;
    };
    session.preview(&edits).unwrap();
    session.commit("Move point").unwrap();
    true
}

#[test]
fn a_marker_is_laid_moved_locked_undone_saved_and_reopened() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = opened(SAMPLE);
    let before = text(&session);
    let id = marked(&mut session);
    let empty = text(&session);
    let start = state(&mut session, id);
    assert_eq!((start.laid, start.waiting), (0, 12));
    let run = |start: Start, session: &mut Session| {
        let mut follow = SearchWatcher {
            report: &mut |_| true,
            stop: Arc::default(),
        };
        let job = session.marker_search(id).unwrap();
        job.run((start, search(4)), &mut follow).unwrap().found
    };
    let anew = run(Start::Anew, &mut session);
    assert_eq!(run(Start::AsItLies, &mut session), anew);
    let events = lay(&mut session, id, (Start::Anew, search(1)));
    assert_eq!(session.can_undo(), Some("Lay marker"));
    let told = events.iter().find_map(|event| match event {
        Event::Nested(summary) => Some(summary.clone()),
        _ => None,
    });
    let told = told.unwrap();
    let found = state(&mut session, id);
    assert_eq!((found.laid, found.waiting), (12, 0));
    assert!(
        found.overlaps.is_empty() && found.outside.is_empty(),
        "{found:?}"
    );
    assert_eq!(
        (found.length, found.efficiency),
        (told.length, told.efficiency)
    );
    // The referee of all rules, on what is stored.
    let finished = session.marker(id).unwrap().finished();
    assert!(
        finished.verdict.is_sound(),
        "{:?}",
        finished.verdict.violations
    );
    assert!(finished.verdict.overlaps.is_empty());
    let laid = text(&session);
    // Saved and reopened.
    let path = folder.path().join("shirt.toile.json");
    let save = Command::SavePattern { path: path.clone() };
    session.execute(save, &mut Silent).unwrap();
    let mut again = opened(path.to_str().unwrap());
    assert_eq!(text(&again), laid);
    assert_eq!(state(&mut again, id), found);
    // Moved onto another, and back.
    let [front, back] = ["front", "back"].map(|name| piece(&session, id, name));
    let place = |session: &Session, piece| {
        let marker = session.project().pattern.marker(id).unwrap();
        marker.placement(piece).unwrap().at
    };
    let [to, from] = [place(&session, front), place(&session, back)];
    let by = [to[0] - from[0], to[1] - from[1]];
    let moved = plan::move_pieces(&session.evaluation(), (id, &[back]), by).unwrap();
    edit(&mut session, moved);
    let overlapping = state(&mut session, id);
    let pairs: Vec<_> = overlapping.overlaps.iter().map(|o| o.pieces).collect();
    assert!(
        pairs
            .iter()
            .any(|pair| pair.contains(&front) && pair.contains(&back)),
        "{pairs:?}"
    );
    assert!(!session.marker(id).unwrap().finished().verdict.is_sound());
    undo(&mut session);
    assert_eq!(text(&session), laid);
    assert_eq!(state(&mut session, id), found);
    // Locked pieces stay where they are, whatever is searched for.
    let locked = plan::lock_pieces(&session.evaluation(), (id, &[front]), true).unwrap();
    edit(&mut session, locked);
    lay(&mut session, id, (Start::Anew, search(5)));
    assert_eq!(place(&session, front), to);
    assert!(session.marker(id).unwrap().finished().verdict.is_sound());
    let kept = placements(&session, id);
    assert!(kept.iter().find(|laid| laid.piece == front).unwrap().locked);
    let as_it_lies = state(&mut session, id);
    let steps = session.past().len();
    lay(&mut session, id, (Start::AsItLies, search(2)));
    assert!(state(&mut session, id).length <= as_it_lies.length + 1e-9);
    // Where nothing shorter was found there is no step.
    while session.past().len() > steps {
        undo(&mut session);
    }
    assert_eq!(placements(&session, id), kept);
    for _ in 0..2 {
        undo(&mut session);
    }
    assert_eq!(text(&session), laid);
    undo(&mut session);
    assert_eq!(text(&session), empty);
    for _ in 0..2 {
        undo(&mut session);
    }
    assert_eq!(text(&session), before);
}

#[test]
fn pieces_keep_their_places_while_fifty_points_move_and_overlaps_are_listed() {
    let mut session = opened(SAMPLE);
    let id = marked(&mut session);
    lay(&mut session, id, (Start::Anew, search(1)));
    let (kept, bytes) = (placements(&session, id), markers_text(&session));
    let mut moved = 0;
    for k in 0.. {
        moved += usize::from(nudge(&mut session, k));
        if moved == 50 {
            break;
        }
    }
    assert_eq!(markers_text(&session), bytes);
    assert_eq!(placements(&session, id), kept);
    let found = state(&mut session, id);
    assert_eq!((found.laid, found.waiting), (12, 0));
    // Points went down by some millimetres, hems too: pieces laid 2 mm apart overlap.
    assert!(!found.overlaps.is_empty(), "{found:?}");
    // The quick check, kept up from move to move, says what a fresh session says.
    let text = write_pattern(&session.project().pattern).unwrap();
    let mut fresh = Session::new();
    let restore = Command::RestorePattern {
        text,
        source: None,
        past: Vec::new(),
    };
    fresh.execute(restore, &mut Silent).unwrap();
    assert_eq!(state(&mut fresh, id), found);
    let words = |session: &mut Session| {
        let finished = session.marker(id).unwrap().finished();
        finished
            .verdict
            .overlaps
            .iter()
            .map(|o| o.0)
            .collect::<Vec<_>>()
    };
    assert_eq!(words(&mut fresh), words(&mut session));
    assert_eq!(words(&mut fresh).len(), found.overlaps.len());
    // Going on from there takes them apart.
    lay(&mut session, id, (Start::AsItLies, search(3)));
    let after = state(&mut session, id);
    assert!(
        after.overlaps.is_empty() && after.outside.is_empty(),
        "{after:?}"
    );
}

#[test]
fn a_document_s_marker_is_as_good_as_one_of_the_command_line() {
    let mut session = opened(SAMPLE);
    let id = marked(&mut session);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns/t-shirt.toile.json");
    let mut means = [0.0; 2];
    for seed in 1..=5 {
        let options = NestOptions {
            sizes: SizeSelection::Named(vec![("S".into(), 1), ("M".into(), 2)]),
            budget: Budget::Evaluations(EVALUATIONS),
            seed,
            formats: Vec::new(),
            ..NestOptions::default()
        };
        let folder = tempfile::tempdir().unwrap();
        let place = (folder.path(), &mut Silent as _);
        let (summary, _) = nest_patterns(std::slice::from_ref(&path), &options, place).unwrap();
        assert_eq!((summary.len(), summary[0].pieces), (1, 12));
        means[0] += summary[0].efficiency / 5.0;
        lay(&mut session, id, (Start::Anew, search(seed)));
        means[1] += state(&mut session, id).efficiency / 5.0;
    }
    let [command_line, document] = means;
    assert!(
        document >= command_line - 0.001,
        "{document} {command_line}"
    );
    assert!(document > 0.7, "{document}");
}

#[test]
fn a_search_tells_how_far_it_is_and_what_comes_too_late_is_dropped() {
    let mut session = opened(SAMPLE);
    let id = marked(&mut session);
    let usual = session.project().pattern.marker(id).unwrap().cloth.clone();
    let cloth = ClothSettings {
        price_per_metre: Some(10.0),
        currency: Some("EUR".into()),
        plies: Some(2),
        ..usual
    };
    let edits = plan::set_marker_cloth(&session.evaluation(), id, cloth).unwrap();
    edit(&mut session, edits);
    let job = session.marker_search(id).unwrap();
    let mut told: Vec<SearchProgress> = Vec::new();
    let mut follow = SearchWatcher {
        report: &mut |standing| {
            told.push(standing.clone());
            true
        },
        stop: Arc::default(),
    };
    let on_thread = std::thread::scope(|scope| {
        let run = scope.spawn(|| {
            let mut follow = SearchWatcher {
                report: &mut |_| true,
                stop: Arc::default(),
            };
            job.run((Start::Anew, search(1)), &mut follow).unwrap()
        });
        run.join().unwrap()
    });
    let found = job.run((Start::Anew, search(1)), &mut follow).unwrap();
    assert_eq!(found.found, on_thread.found, "the same on any thread");
    let last = told.last().unwrap();
    let (length, efficiency) = (last.length.unwrap(), last.efficiency.unwrap());
    assert!((last.cost.unwrap() - 20.0 * length).abs() < 1e-9);
    let lengths: Vec<f64> = told.iter().filter_map(|standing| standing.length).collect();
    assert!(lengths.is_sorted_by(|a, b| a >= b), "{lengths:?}");
    let summary = &found.found.summaries[0];
    assert!(summary.length <= length + 1e-9 && summary.efficiency >= efficiency - 1e-9);
    assert_eq!(summary.currency, "EUR");
    assert_eq!(
        state(&mut session, id).waiting,
        12,
        "nothing is taken over by itself"
    );
    // A point moved meanwhile.
    let mut k = 0;
    while !nudge(&mut session, k) {
        k += 1;
    }
    assert!(session.adopt_marker(found).unwrap().is_none());
    undo(&mut session);
    // Undone, it is what was searched for again.
    let events = session.adopt_marker(on_thread).unwrap();
    assert!(events.is_some());
    assert_eq!(session.journal().len(), 7);
    // Stopped before anything was found.
    let job = session.marker_search(id).unwrap();
    let mut follow = SearchWatcher {
        report: &mut |_| false,
        stop: Arc::new(AtomicBool::new(true)),
    };
    let stopped = job.run((Start::Anew, search(1)), &mut follow);
    assert!(matches!(stopped.err(), Some(SessionError::Cancelled)));
    assert!(follow.stop.load(Ordering::Relaxed));
}

#[test]
fn on_folded_fabric_pairs_are_laid_once_and_halves_on_the_fold() {
    let mut session = opened("sample:trousers");
    let fabric = session.project().pattern.panels[0].fabric;
    let (edits, id) = plan::add_marker(&session.evaluation(), None, fabric).unwrap();
    edit(&mut session, edits);
    let open = state(&mut session, id).waiting;
    lay(&mut session, id, (Start::Anew, search(1)));
    let usual = session.project().pattern.marker(id).unwrap().cloth.clone();
    let cloth = ClothSettings {
        spread: Some(Spread::Folded),
        ..usual.clone()
    };
    let edits = plan::set_marker_cloth(&session.evaluation(), id, cloth).unwrap();
    edit(&mut session, edits);
    let laid = session.marker(id).unwrap();
    let (on_fold, twins) = (laid.laid().count(), laid.suspended().len());
    assert_eq!(
        on_fold + twins,
        open,
        "those cut with another wait with their places"
    );
    assert!(twins > 0);
    lay(&mut session, id, (Start::Anew, search(1)));
    assert!(session.marker(id).unwrap().finished().verdict.is_sound());
    assert!(session.marker(id).unwrap().suspended().is_empty());
    // Of no fabric at all.
    session
        .execute(
            Command::Edit {
                edits: vec![Edit::Remove(fabric.into())],
                label: "Remove fabric".into(),
            },
            &mut Silent,
        )
        .unwrap();
    let error = session.marker(id).err().unwrap().to_string();
    assert!(error.contains("fabric of the marker"), "{error}");
}

#[test]
fn a_marker_of_a_file_is_stored_there_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shirt.toile.json");
    let mut session = opened(SAMPLE);
    let id = marked(&mut session);
    let save = Command::SavePattern { path: path.clone() };
    session.execute(save, &mut Silent).unwrap();
    let job = MarkerJob {
        name: "shirts".into(),
        search: Some((Start::Anew, search(1))),
        formats: vec![MarkerFormat::Svg, MarkerFormat::Json],
    };
    let out = folder.path().join("out");
    let (summaries, paths) = nest_marker(&path, &job, (&out, &mut Silent)).unwrap();
    let [summary] = &summaries[..] else {
        panic!("{summaries:?}");
    };
    assert!(summary.sound && summary.unplaced == 0, "{summary:?}");
    assert_eq!(paths.len(), 3);
    lay(&mut session, id, (Start::Anew, search(1)));
    let mut again = opened(path.to_str().unwrap());
    assert_eq!(text(&again), text(&session), "the same as from the window");
    assert_eq!(state(&mut again, id).length, summary.length);
    let written = std::fs::read_to_string(&path).unwrap();
    let marker = std::fs::read(out.join("marker.json")).unwrap();
    // As it is stored.
    let stored = MarkerJob {
        search: None,
        ..job.clone()
    };
    let (_, paths) = nest_marker(&path, &stored, (&out, &mut Silent)).unwrap();
    assert_eq!(paths, [out.join("marker.svg"), out.join("marker.json")]);
    assert_eq!(std::fs::read(out.join("marker.json")).unwrap(), marker);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), written);
    // A piece moved onto another is told.
    let [front, back] = ["front", "back"].map(|name| piece(&again, id, name));
    let at = |piece| {
        let laid = placements(&again, id);
        laid.iter().find(|laid| laid.piece == piece).unwrap().at
    };
    let by = [at(front)[0] - at(back)[0], at(front)[1] - at(back)[1]];
    let moved = plan::move_pieces(&again.evaluation(), (id, &[back]), by).unwrap();
    edit(&mut again, moved);
    let other = folder.path().join("moved.toile.json");
    let save = Command::SavePattern {
        path: other.clone(),
    };
    again.execute(save, &mut Silent).unwrap();
    let (mut told, _) = nest_marker(&other, &stored, (&out, &mut Silent)).unwrap();
    let told = told.remove(0);
    assert!(!told.sound);
    let is_told = |note: &String| note.contains("front") && note.contains("overlap by");
    assert!(told.notes.iter().any(is_told), "{:?}", told.notes);
    // Stopped before anything is found: nothing is written.
    let mut stop = |_: &str, _: f64, _: &str| ControlFlow::Break(());
    let stopped = nest_marker(&path, &job, (&out, &mut stop));
    assert!(stopped.is_err());
    assert_eq!(std::fs::read_to_string(&path).unwrap(), written);
    // Refusals.
    let other = MarkerJob {
        name: "trousers".into(),
        ..job.clone()
    };
    let error = nest_marker(&path, &other, (&out, &mut Silent)).unwrap_err();
    assert!(error.is_bad_input());
    assert!(
        error.to_string().contains("choose one of shirts"),
        "{error}"
    );
    let unknown = written.replacen("\"unit\"", "\"thread\": 3, \"unit\"", 1);
    std::fs::write(&path, &unknown).unwrap();
    let error = nest_marker(&path, &job, (&out, &mut Silent)).unwrap_err();
    assert!(error.to_string().contains("would lose"), "{error}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), unknown);
}

/// A planner's edits.
type Change<'a> = &'a dyn Fn(&Evaluation) -> Vec<Edit>;

/// The pieces of a marker follow every way of changing the pattern, as a fresh session says.
#[test]
fn what_is_kept_of_a_marker_is_what_a_fresh_session_makes() {
    let mut session = opened(SAMPLE);
    let id = marked(&mut session);
    lay(&mut session, id, (Start::Anew, search(1)));
    let size = session.project().pattern.size_named("M").unwrap().id;
    let changes: [Change<'_>; 4] = [
        &|evaluation| plan::set_measurement(evaluation, size, "bust", Some(1.1)).unwrap(),
        &|evaluation| plan::rename(evaluation, size.into(), "Medium").unwrap(),
        &|evaluation| {
            let front = evaluation.pattern().panel_named("front").unwrap().id;
            plan::rename(evaluation, front.into(), "forepart").unwrap()
        },
        &|evaluation| {
            let order = vec![OrderedSize {
                size: Some(size),
                quantity: 1,
            }];
            plan::set_marker_order(evaluation, id, order).unwrap()
        },
    ];
    for change in changes {
        let edits = change(&session.evaluation());
        edit(&mut session, edits);
        let mut fresh = Session::new();
        let text = write_pattern(&session.project().pattern).unwrap();
        let restore = Command::RestorePattern {
            text,
            source: None,
            past: Vec::new(),
        };
        fresh.execute(restore, &mut Silent).unwrap();
        let seen = |session: &mut Session| {
            let laid = session.marker(id).unwrap();
            let names = laid
                .laid()
                .map(|piece| (piece.name.to_owned(), piece.cut.clone()));
            (
                names.collect::<Vec<_>>(),
                laid.state(),
                laid.suspended().to_vec(),
            )
        };
        assert_eq!(seen(&mut session), seen(&mut fresh));
    }
    assert_eq!(session.marker(id).unwrap().laid().count(), 4);
    assert_eq!(session.marker(id).unwrap().suspended().len(), 8);
}
