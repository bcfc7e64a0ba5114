//! Memory of a session whose history is full: counted bytes, in a process with this test alone.
#![allow(clippy::unwrap_used)]

use peak_alloc::PeakAlloc;
use std::path::PathBuf;
use std::sync::Arc;
use toile_pattern::{Edit, Entity, plan};
use toile_session::{Command, SAMPLES, Session, Silent};
use toile_tests::random::Random;

#[global_allocator]
static COUNTED: PeakAlloc = PeakAlloc;

/// Steps a history keeps.
const KEPT: usize = 1000;

fn run(session: &mut Session, command: Command) {
    session.execute(command, &mut Silent).unwrap();
}

/// One step: a point moved as by a drag, or a panel cut another number of times; the draft is
/// looked at, as the window does.
fn step(session: &mut Session, random: &mut Random) {
    let evaluation = session.evaluation();
    let pattern = evaluation.pattern();
    let points = || pattern.sheets.iter().flat_map(|sheet| &sheet.points);
    let point = points().nth(random.below(points().count())).unwrap().id;
    let from = evaluation.point(point).unwrap();
    let mut moved = Vec::new();
    for share in [0.5, 1.0] {
        let way = share * random.between(-0.002, 0.002);
        let to = from + toile_geometry::Vec2::new(way, -way);
        if let Ok(edits) = plan::move_point(&evaluation, point, to) {
            session.preview(&edits).unwrap();
            session.draft();
            moved = edits;
        }
    }
    let edits = match moved.is_empty() {
        false => moved,
        true => {
            let mut panel = (*pattern.panels[random.below(pattern.panels.len())]).clone();
            panel.cut.quantity += 1;
            vec![Edit::Put(Entity::Panel(Arc::new(panel)))]
        }
    };
    let label = "Change".to_owned();
    run(session, Command::Edit { edits, label });
    session.draft();
    session.diagnostics();
}

#[test]
fn a_full_history_takes_no_more_memory_as_work_goes_on() {
    let mut session = Session::new();
    let path = PathBuf::from(SAMPLES[0].0);
    run(&mut session, Command::open(path));
    let mut random = Random(1);
    let mut used = Vec::new();
    for number in 1..=3 * KEPT {
        step(&mut session, &mut random);
        if number.is_multiple_of(KEPT) {
            used.push(PeakAlloc.current_usage() as f64);
        }
    }
    assert_eq!(session.past().len(), KEPT);
    let grown = used[2] / used[1] - 1.0;
    assert!(
        grown.abs() <= 0.05,
        "{used:?} bytes after each {KEPT} steps"
    );
    // The count does count: a history that fills takes memory.
    assert!(used[0] > 1e6, "{used:?} bytes");
}
