//! Markers of the document on what the garment is cut from.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;
use toile_pattern::{Edit, MarkerCloth, MarkerId, PiecePlacement, plan};
use toile_session::{Command, Event, SAMPLE, Search, SearchWatcher, Session, Silent, Start};

fn edit(session: &mut Session, edits: Vec<Edit>) {
    let label = "Edit marker".to_owned();
    session
        .execute(Command::Edit { edits, label }, &mut Silent)
        .unwrap();
}

/// A shirt with a marker, laid.
fn laid() -> (Session, MarkerId) {
    let mut session = Session::new();
    let path = SAMPLE.into();
    session
        .execute(Command::OpenPattern { path }, &mut Silent)
        .unwrap();
    let fabric = session.project().pattern.panels[0].fabric;
    let (edits, id) = plan::add_marker(&session.evaluation(), Some("shirts"), fabric).unwrap();
    edit(&mut session, edits);
    let found = searched(&mut session, id);
    session.adopt_marker(found).unwrap().unwrap();
    (session, id)
}

fn searched(session: &mut Session, id: MarkerId) -> toile_session::FoundMarker {
    let job = session.marker_search(id).unwrap();
    let mut follow = SearchWatcher {
        report: &mut |_| true,
        stop: Arc::default(),
    };
    let search = Search::evaluations(100_000);
    job.run((Start::Anew, search), &mut follow).unwrap()
}

fn placements(session: &Session, id: MarkerId) -> Vec<PiecePlacement> {
    let marker = session.project().pattern.marker(id).unwrap();
    marker.placements.clone()
}

#[test]
fn a_marker_lies_on_what_the_garment_is_cut_from_and_what_it_keeps_is_told() {
    let (mut session, id) = laid();
    let places = placements(&session, id);
    let own = session.marker(id).unwrap().finished();
    let lies_on = |session: &mut Session| {
        let finished = session.marker(id).unwrap().finished();
        (finished.fabric, finished.strip.width)
    };
    let run = |session: &mut Session, command: Command| {
        let events = session.execute(command, &mut Silent).unwrap();
        let told = events.into_iter().filter_map(|event| match event {
            Event::Warned { message } => Some(message),
            _ => None,
        });
        told.collect::<Vec<_>>()
    };
    let denim = || Command::SetFabric {
        fabric: Some("denim".into()),
    };
    let wide = |width| Command::SetWidth { width };

    assert!(run(&mut session, denim()).is_empty());
    assert_eq!(lies_on(&mut session), ("denim".to_owned(), 1.5));
    assert_eq!(
        placements(&session, id),
        places,
        "the pieces keep their places"
    );
    assert!(run(&mut session, wide(Some(0.5))).is_empty());
    assert_eq!(lies_on(&mut session), ("denim".to_owned(), 0.5));
    let outside = session.marker(id).unwrap().state().outside;
    assert!(!outside.is_empty(), "what lay beyond 0.5 m is told");

    // A width of its own, and its own fabric, stay: that is told.
    let usual = session.project().pattern.marker(id).unwrap().cloth.clone();
    let with = |session: &mut Session, cloth: MarkerCloth| {
        let edits = plan::set_marker_cloth(&session.evaluation(), id, cloth).unwrap();
        edit(session, edits);
    };
    let width = Some(1.4);
    with(
        &mut session,
        MarkerCloth {
            width,
            ..usual.clone()
        },
    );
    let told = run(&mut session, wide(Some(1.1)));
    assert!(
        told[0].contains("\"shirts\" stays 140.0 cm wide"),
        "{told:?}"
    );
    let keeps_fabric = true;
    with(
        &mut session,
        MarkerCloth {
            keeps_fabric,
            ..usual.clone()
        },
    );
    assert_eq!(lies_on(&mut session), (own.fabric.clone(), own.strip.width));
    let told = run(&mut session, wide(None));
    let words = format!("stays on {}, and the garment is cut from denim", own.fabric);
    assert!(told[0].contains(&words), "{told:?}");
    with(&mut session, usual);

    // A search is on the same cloth, and is dropped where that changes meanwhile.
    let found = searched(&mut session, id);
    assert_eq!(found.found.summary.fabric, "denim");
    run(&mut session, wide(Some(1.3)));
    assert!(session.adopt_marker(found).unwrap().is_none());
    run(&mut session, wide(None));
    run(&mut session, Command::SetFabric { fabric: None });
    assert_eq!(lies_on(&mut session), (own.fabric, own.strip.width));
}
