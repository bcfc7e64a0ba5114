//! A garment that hangs follows the edits of its pattern from there, or stands still and says why.

use crate::support::{band, make};
use std::path::Path;
use std::time::Duration;
use toile_drape::{GarmentRun, Stage};
use toile_geometry::{Vec2, Vec3};
use toile_measure::{Measurements, Origin};
use toile_pattern::{Edit, Entity, Panel, plan};
use toile_session::{
    CannotFollow, Command, Figure, GarmentEdit, GarmentJob, LiveFrame, LiveRun, OtherGarment,
    Quality, RestChange, Session, Silent, let_go_of_vertex, pull_vertex,
};

/// A session with the band in it, meshed coarsely.
fn prepared(folder: &Path) -> Session {
    let mut session = Session::new();
    let commands = make(&band(folder), folder);
    session.execute_all(&commands[..2], &mut Silent).unwrap();
    session
}

fn edit(session: &mut Session, edits: Vec<Edit>) {
    let label = "Edit".to_owned();
    let command = Command::Edit { edits, label };
    session.execute(command, &mut Silent).unwrap();
}

/// Moves a point of the front's sheet by a way (m).
fn move_point(session: &mut Session, name: &str, way: Vec2) {
    let evaluation = session.evaluation();
    let pattern = evaluation.pattern();
    let sheet = pattern.panel_named("front").unwrap().sheet().unwrap();
    let point = pattern.sheet(sheet).unwrap().point_named(name).unwrap().id;
    let to = evaluation.point(point).unwrap() + way;
    let edits = plan::move_point(&evaluation, point, to).unwrap();
    edit(session, edits);
}

/// Puts a corner on the lower edge of the front.
fn divide(session: &mut Session) {
    let evaluation = session.evaluation();
    let front = evaluation.pattern().panel_named("front").unwrap();
    let (edits, _) = plan::divide_edge(
        &evaluation,
        (front.id, front.edges().next().unwrap().id),
        None,
    )
    .unwrap();
    edit(session, edits);
}

/// Waits for a frame that something holds for.
fn seen(live: &LiveRun, holds: impl Fn(&LiveFrame) -> bool) -> LiveFrame {
    for _ in 0..12_000 {
        let ended = live.is_finished();
        if let Some(frame) = live.latest() {
            if holds(&frame) {
                return frame;
            }
        } else if ended {
            panic!("it came to an end before: {:?}", live.failure());
        } else {
            std::thread::sleep(Duration::from_millis(5));
        }
    }
    panic!("not seen within a minute");
}

/// The frame of a garment at rest.
fn at_rest(live: &LiveRun) -> LiveFrame {
    let frame = seen(live, |frame| frame.stage == Stage::Finished);
    rests(live);
    frame
}

/// The same after a frame that may be it already.
fn at_rest_after(live: &LiveRun, frame: LiveFrame) -> LiveFrame {
    match frame.stage {
        Stage::Finished => {
            rests(live);
            frame
        }
        _ => at_rest(live),
    }
}

fn rests(live: &LiveRun) {
    for _ in 0..2_000 {
        if live.is_finished() {
            assert_eq!(live.failure(), None);
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("it does not rest");
}

/// How far the vertices of two garments with the same triangles are from each other (m).
fn distance(a: &LiveFrame, b: &LiveFrame) -> f64 {
    distances(a, b).into_iter().fold(0.0, f64::max)
}

/// The same of each vertex (m).
fn distances(a: &LiveFrame, b: &LiveFrame) -> Vec<f64> {
    assert_eq!(a.target, b.target);
    let pairs = a.positions.iter().zip(&b.positions);
    pairs.map(|(a, b)| (a - b).norm()).collect()
}

/// From the lowest place of the front to the highest (m).
fn height_of_front(frame: &LiveFrame) -> f64 {
    let vertices = frame.job.garment.panels[0].vertices.clone();
    let place = |v: usize| frame.positions[frame.target[v] as usize];
    let places: Vec<Vec3> = vertices.map(place).collect();
    let [low, high] = bounds(&places);
    high.y - low.y
}

/// Mean height of a garment's vertices, as meshed (m).
fn height(frame: &LiveFrame) -> f64 {
    let places = frame.target.iter().map(|&v| frame.positions[v as usize].y);
    places.sum::<f64>() / frame.target.len() as f64
}

/// Lowest and highest place (m).
fn bounds(positions: &[Vec3]) -> [Vec3; 2] {
    let first = [positions[0]; 2];
    let fold = |[low, high]: [Vec3; 2], p: &Vec3| [low.inf(p), high.sup(p)];
    positions.iter().fold(first, fold)
}

fn follow(session: &mut Session, worn: &GarmentJob) -> GarmentEdit {
    session.garment_edit(worn).unwrap()
}

/// Where friction holds cloth is chance, so that several wearers are tried.
#[test]
fn a_garment_at_rest_goes_on_to_an_edit_and_back_by_undo() {
    for waist in [0.70, 0.72, 0.74] {
        goes_on_and_back(waist);
    }
}

/// On a woman of a waist girth (m).
fn goes_on_and_back(waist: f64) {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let mut measurements = Measurements::new();
    for (name, length) in [("height", 1.68), ("waist", waist)] {
        measurements.set(name, length, Origin::Asked).unwrap();
    }
    let wearer = Command::SetMeasurements {
        figure: Some(Figure::Woman),
        measurements,
    };
    session.execute(wearer, &mut Silent).unwrap();
    let job = session.garment_setup().unwrap();
    let live = LiveRun::start(job.clone());
    let first = at_rest(&live);
    let result = live.result().unwrap();
    assert!(session.adopt_drape(result).is_some());

    move_point(&mut session, "d", Vec2::new(0.0, 0.015));
    move_point(&mut session, "c", Vec2::new(0.0, 0.015));
    assert_eq!(session.draped(), None);
    let changed = follow(&mut session, &job);
    assert_eq!(changed.change, RestChange::Shapes);
    assert_eq!(changed.job.garment.triangles, job.garment.triangles);
    let edited = changed.job.clone();
    live.edit(changed);
    let moving = seen(&live, |frame| frame.job.revision == edited.revision);
    assert!(
        distance(&first, &moving) < 0.02,
        "it goes on from where it hung"
    );
    let second = at_rest_after(&live, moving);
    assert_eq!(second.job.revision, session.revision());
    // The front is 15 mm higher, the back as it was; and a fresh drape hangs there, too.
    let mut fresh = GarmentRun::new(session.garment_setup().unwrap().setup).unwrap();
    while fresh.advance().unwrap().stage != Stage::Finished {}
    let [a, b] = [&second.positions, &fresh.state.positions].map(|p| bounds(p));
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).norm() < 0.01, "{a:?} {b:?}");
    }
    let [before, after] = [&first, &second].map(height_of_front);
    assert!((after - before - 0.015).abs() < 0.003, "{before} {after}");
    // How it hangs came of its way: it is no product.
    assert!(live.result().is_none());

    session.execute(Command::Undo, &mut Silent).unwrap();
    session.execute(Command::Undo, &mut Silent).unwrap();
    let back = follow(&mut session, &edited);
    assert_eq!(back.change, RestChange::Shapes);
    assert_eq!(back.job.garment.flat, job.garment.flat);
    live.edit(back);
    let third = at_rest(&live);
    assert_eq!(third.job.revision, session.revision());
    // Friction keeps a few places where the edit had drawn them, no more than a third of it.
    let mut apart = distances(&first, &third);
    apart.sort_by(f64::total_cmp);
    let most = apart[apart.len() - 1];
    let mean = apart.iter().sum::<f64>() / apart.len() as f64;
    assert!(mean < 0.001, "{mean}");
    assert!(apart[apart.len() * 99 / 100] < 0.004, "{apart:?}");
    assert!(most < 0.35 * distance(&first, &second), "{most}");
}

#[test]
fn what_a_garment_lacks_after_an_edit_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();
    let live = LiveRun::start(job.clone());
    at_rest(&live);
    assert_eq!(live.warnings(), Vec::<String>::new());
    for name in ["a", "d"] {
        move_point(&mut session, name, Vec2::new(0.16, 0.0));
    }
    live.edit(follow(&mut session, &job));
    let taken = seen(&live, |frame| frame.job.revision == session.revision());
    at_rest_after(&live, taken);
    let warnings = live.warnings().join("; ");
    assert!(warnings.contains("stretched by"), "{warnings}");
}

#[test]
fn an_edit_while_it_is_sewn_waits_and_of_two_the_later_is_taken() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();
    let live = LiveRun::start(job.clone());
    live.pause();
    move_point(&mut session, "a", Vec2::new(0.0, 0.005));
    let replaced = follow(&mut session, &job);
    let passed_over = replaced.job.revision;
    live.edit(replaced);
    move_point(&mut session, "a", Vec2::new(0.0, -0.004));
    live.edit(follow(&mut session, &job));
    live.resume();
    let taken = seen(&live, |frame| {
        let revision = frame.job.revision;
        assert_ne!(revision, passed_over, "it was replaced");
        assert!(revision != session.revision() || frame.takes_edits);
        revision == session.revision()
    });
    assert_eq!(at_rest_after(&live, taken).job.revision, session.revision());
}

#[test]
fn a_swinging_garment_takes_an_edit() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();
    let live = LiveRun::start(job.clone());
    live.stand_still();
    let swinging = seen(&live, |frame| frame.takes_edits);
    assert_eq!(swinging.stage, Stage::Swinging);
    move_point(&mut session, "b", Vec2::new(0.0, 0.005));
    live.edit(follow(&mut session, &job));
    let taken = seen(&live, |frame| frame.job.revision == session.revision());
    assert_ne!(taken.stage, Stage::Sewing);
    at_rest_after(&live, taken);
}

#[test]
fn an_edit_that_needs_another_mesh_carries_the_garment_over() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();
    let live = LiveRun::start(job.clone());
    let first = at_rest(&live);
    let vertex = job.garment.positions.len() as u32 - 1;
    divide(&mut session);
    let changed = follow(&mut session, &job);
    assert_eq!(changed.change, RestChange::Mesh);
    let divided = changed.job.clone();
    live.pause();
    live.edit(changed);
    // The edit that comes with the next is for the mesh that waits.
    move_point(&mut session, "d", Vec2::new(0.0, 0.005));
    let next = follow(&mut session, &divided);
    assert_eq!(next.change, RestChange::Shapes);
    live.edit(next);
    let to = [0.0, 1.0, 1.0];
    live.give(pull_vertex(vertex, to)).unwrap();
    live.resume();
    let second = at_rest(&live);
    assert_eq!(second.job.revision, session.revision());
    assert_eq!(second.target.len(), divided.garment.positions.len());
    assert!((height(&first) - height(&second)).abs() < 0.005);
    // The hand let go of the old mesh; the new one can be taken hold of.
    let vertex = second.target.len() as u32 - 1;
    live.give(pull_vertex(vertex, to)).unwrap();
    let held = seen(&live, |frame| frame.stage == Stage::Finished);
    let place = |frame: &LiveFrame| frame.positions[frame.target[vertex as usize] as usize];
    let to = Vec3::from(to);
    assert!((place(&held) - to).norm() + 0.02 < (place(&second) - to).norm());
    // An edit under the hand leaves it where it is.
    move_point(&mut session, "d", Vec2::new(0.0, 0.005));
    live.edit(follow(&mut session, &second.job));
    let edited = seen(&live, |frame| {
        frame.job.revision == session.revision() && frame.stage == Stage::Finished
    });
    assert!((place(&edited) - place(&held)).norm() < 0.02);
    assert!(!live.is_finished());
    live.give(let_go_of_vertex(vertex)).unwrap();
    at_rest(&live);
}

#[test]
fn while_it_is_sewn_new_rest_shapes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();
    let level = job.setup.levels[0].clone();
    let mut run = GarmentRun::new(job.setup.clone()).unwrap();
    let counted = job.setup.counted;
    let refused = run.reshape(level.cloth.rest.clone(), counted.clone());
    let words = refused.unwrap_err().to_string();
    assert!(words.contains("still being sewn"), "{words}");
    let words = run.remesh(level.clone(), counted.clone()).unwrap_err();
    assert!(words.to_string().contains("still being sewn"), "{words}");
    while run.advance().unwrap().stage == Stage::Sewing {}
    let before = run.state.clone();
    for rest in [
        level.cloth.rest[1..].to_vec(),
        vec![[Vec2::zeros(); 3]; level.cloth.rest.len()],
    ] {
        assert!(run.reshape(rest, counted.clone()).is_err());
        assert_eq!(run.state, before);
    }
    run.reshape(level.cloth.rest, counted).unwrap();
    assert_eq!(run.state.positions, before.positions);
    assert_eq!(run.progress().stage, Stage::Swinging);
}

#[test]
fn what_changes_nothing_of_the_cloth_leaves_it_at_rest() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();
    let live = LiveRun::start(job.clone());
    at_rest(&live);
    let first = live.result().unwrap();
    // A panel on the table.
    let front = session.project().pattern.panel_named("front").unwrap();
    let mut moved = Panel::clone(front);
    moved.on_table = Some([0.1, 0.3]);
    edit(&mut session, vec![Edit::Put(Entity::Panel(moved.into()))]);
    let changed = follow(&mut session, &job);
    assert_eq!(changed.change, RestChange::Nothing);
    live.edit(changed);
    let frame = at_rest(&live);
    assert_eq!(frame.job.revision, session.revision());
    // It is the garment of this revision, too.
    let result = live.result().unwrap();
    assert_eq!(result.mesh().positions, first.mesh().positions);
    assert_eq!(result.summary(), first.summary());
    assert!(session.adopt_drape(result).is_some());
    // A wider allowance is cut, and hangs as before.
    let front = session.project().pattern.panel_named("front").unwrap();
    let mut wider = Panel::clone(front);
    wider.allowance = 0.02.into();
    edit(&mut session, vec![Edit::Put(Entity::Panel(wider.into()))]);
    live.edit(follow(&mut session, &frame.job));
    let after = at_rest(&live);
    assert_eq!(after.step, frame.step);
    assert_eq!(distance(&after, &frame), 0.0);
    assert!(live.result().is_none());
}

#[test]
fn what_cannot_be_followed_is_told_and_the_garment_goes_on_later() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other.toile.json");
    std::fs::copy(band(folder.path()), &path).unwrap();
    let mut session = prepared(folder.path());
    let job = session.garment_setup().unwrap();
    let mut why = |command: Command| {
        session.execute(command, &mut Silent).unwrap();
        let refused = session.garment_edit(&job).err();
        session.execute(Command::Undo, &mut Silent).unwrap();
        assert!(session.garment_edit(&job).is_ok());
        refused
    };
    let quality = Quality::Fit;
    assert_eq!(
        why(Command::SetQuality { quality }),
        Some(CannotFollow::Quality)
    );
    let size = Some("L".to_owned());
    assert_eq!(why(Command::SetSize { size }), Some(CannotFollow::Body));
    let fabric = Some("jersey".to_owned());
    let other = why(Command::SetFabric { fabric });
    assert_eq!(other, Some(CannotFollow::Fabric("front".into())));
    let others = vec![OtherGarment { path, layer: 2 }];
    let several = why(Command::SetLayers { layer: 1, others });
    assert_eq!(several, Some(CannotFollow::Garments));
    let pattern = session.project().pattern.clone();
    let front = pattern.panel_named("front").unwrap().id;
    let edits = plan::remove_parts(&session.evaluation(), &[front.into()]).unwrap();
    edit(&mut session, edits);
    assert_eq!(session.garment_edit(&job).err(), Some(CannotFollow::Panels));
    session.execute(Command::Undo, &mut Silent).unwrap();

    // A fault: the garment is sewn, then stands, and goes on when the fault is mended.
    let live = LiveRun::start(job.clone());
    live.stand_still();
    move_point(&mut session, "d", Vec2::new(0.0, -0.16));
    let fault = session.garment_edit(&job).err().unwrap();
    assert_eq!(fault, CannotFollow::Faults);
    let sewn = seen(&live, |frame| frame.takes_edits);
    std::thread::sleep(Duration::from_millis(50));
    assert_eq!(sewn.stage, Stage::Swinging);
    assert!(live.latest().is_none() && !live.is_finished());
    session.execute(Command::Undo, &mut Silent).unwrap();
    move_point(&mut session, "d", Vec2::new(0.0, 0.005));
    live.edit(follow(&mut session, &job));
    assert_eq!(at_rest(&live).job.revision, session.revision());
}
