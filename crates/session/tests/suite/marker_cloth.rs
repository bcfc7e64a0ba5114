//! Markers of the document on what the garment is cut from, for whom it is made, and beside flaws of the cloth.

use std::sync::Arc;
use toile_geometry::Vec2;
use toile_pattern::{ClothSettings, Edit, Flaw, MarkerId, OrderedSize, PiecePlacement, plan};
use toile_session::{
    Command, Event, LetGo, Obstacle, SAMPLE, Search, SearchWatcher, Session, Silent, Start,
    other_sizes_words,
};

fn edit(session: &mut Session, edits: Vec<Edit>) {
    let label = "Edit marker".to_owned();
    session
        .execute(Command::Edit { edits, label }, &mut Silent)
        .unwrap();
}

/// A session with the shirt.
fn opened() -> Session {
    let mut session = Session::new();
    let path = SAMPLE;
    session.execute(Command::open(path), &mut Silent).unwrap();
    session
}

/// A shirt with a marker, laid.
fn laid() -> (Session, MarkerId) {
    let mut session = opened();
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
    let with = |session: &mut Session, cloth: ClothSettings| {
        let edits = plan::set_marker_cloth(&session.evaluation(), id, cloth).unwrap();
        edit(session, edits);
    };
    let width = Some(1.4);
    with(
        &mut session,
        ClothSettings {
            width,
            ..usual.clone()
        },
    );
    let told = run(&mut session, wide(Some(1.1)));
    assert!(
        told[0].contains("\"shirts\" stays 140.0 cm wide"),
        "{told:?}"
    );
    with(&mut session, usual);
    let own_fabric = session.project().pattern.marker(id).unwrap().fabric;
    let keeps = |session: &mut Session, keeps_fabric: bool| {
        let lies_on = (own_fabric, keeps_fabric);
        let edits = plan::set_marker_fabric(&session.evaluation(), id, lies_on).unwrap();
        edit(session, edits);
    };
    keeps(&mut session, true);
    assert_eq!(lies_on(&mut session), (own.fabric.clone(), own.strip.width));
    let told = run(&mut session, wide(None));
    let words = format!("stays on {}, and the garment is cut from denim", own.fabric);
    assert!(told[0].contains(&words), "{told:?}");
    keeps(&mut session, false);

    // A search is on the same cloth, and is dropped where that changes meanwhile.
    let found = searched(&mut session, id);
    assert_eq!(found.found.summaries[0].fabric, "denim");
    run(&mut session, wide(Some(1.3)));
    assert!(session.adopt_marker(found).unwrap().is_none());
    run(&mut session, wide(None));
    run(&mut session, Command::SetFabric { fabric: None });
    assert_eq!(lies_on(&mut session), (own.fabric, own.strip.width));
}

/// A garment that is made for a wearer is laid so, in the pieces, the title and the words; a marker of sizes says that
/// the garment is other.
#[test]
fn a_marker_of_a_garment_made_for_a_wearer_is_the_wearers() {
    let mut session = opened();
    let folder = tempfile::tempdir().unwrap();
    let fabric = session.project().pattern.panels[0].fabric;
    let (edits, of_size) = plan::add_marker(&session.evaluation(), None, fabric).unwrap();
    edit(&mut session, edits);
    let body = folder.path().join("anna.measurements.json");
    let text = r#"{ "toile": 1, "kind": "measurements", "unit": "cm",
        "measurements": { "height": 180, "bust": 121, "waist": 101, "hips": 123 } }"#;
    std::fs::write(&body, text).unwrap();
    let set = Command::SetBody {
        figure: None,
        measurements: Some(body),
    };
    session.execute(set, &mut Silent).unwrap();
    let (edits, own) = plan::add_marker(&session.evaluation(), Some("own"), fabric).unwrap();
    edit(&mut session, edits);
    let marker = |session: &Session, id| session.project().pattern.marker(id).unwrap().clone();
    let ordered = marker(&session, own).order.clone();
    assert_eq!((ordered.len(), ordered[0].size), (1, None));
    let widest = |session: &mut Session, id, name: Option<&str>| {
        let laid = session.marker(id).unwrap();
        let waiting = laid.waiting();
        let named = waiting.filter(|piece| name.is_none_or(|name| piece.name == name));
        let sizes = named.map(|piece| piece.cut.polygon().bounds().size().x);
        sizes.fold(0.0, f64::max)
    };
    let of_wearer = widest(&mut session, own, None);
    assert!(of_wearer > widest(&mut session, of_size, None) + 0.02);

    let project = session.project();
    let words = other_sizes_words(project, &marker(&session, of_size)).unwrap();
    assert_eq!(words, "is of size M, and the garment is made for anna");
    assert_eq!(other_sizes_words(project, &marker(&session, own)), None);

    // Beside pieces of a size those of the wearer say whose they are.
    let mut order = ordered;
    let medium = session.project().pattern.size_named("M").unwrap().id;
    order.push(OrderedSize {
        size: Some(medium),
        quantity: 1,
    });
    let edits = plan::set_marker_order(&session.evaluation(), own, order).unwrap();
    edit(&mut session, edits);
    assert_eq!(
        widest(&mut session, own, Some("front made for anna")),
        of_wearer
    );
    assert!(widest(&mut session, own, Some("front M")) > 0.1);
}

/// A piece that is let go on a flaw goes off it, or back; beside one it keeps the flaw's distance.
#[test]
fn a_piece_that_is_let_go_lies_on_no_flaw() {
    let mut session = opened();
    let fabric = session.project().pattern.panels[0].fabric;
    let (edits, id) = plan::add_marker(&session.evaluation(), None, fabric).unwrap();
    edit(&mut session, edits);
    let piece = session.marker(id).unwrap().waiting().next().unwrap().piece;
    let at = |at: [f64; 2]| PiecePlacement {
        piece,
        at,
        turn: 0.0,
        flipped: false,
        locked: false,
        roll: 0,
    };
    let edits = plan::place_pieces(&session.evaluation(), id, &[at([0.0; 2])]).unwrap();
    edit(&mut session, edits);
    let laid = session.marker(id).unwrap();
    let front = laid.laid().next().unwrap();
    let shape = front.pose.lay(&front.cut.polygon()).bounds();
    let clearance = 0.004;
    let flaw = Flaw {
        at: [1.5, 0.1],
        size: [0.3, 0.5],
        clearance,
    };
    let cloth = ClothSettings {
        flaws: Some(vec![flaw]),
        ..session.project().pattern.marker(id).unwrap().cloth.clone()
    };
    let edits = plan::set_marker_cloth(&session.evaluation(), id, cloth).unwrap();
    edit(&mut session, edits);
    let reach = 0.03;
    let mut let_go = |right: f64| {
        // So far the right end of the piece reaches.
        let placed = at([right - shape.max.x, 0.35 - shape.centre().y]);
        let edits = plan::place_pieces(&session.evaluation(), id, &[placed]).unwrap();
        edit(&mut session, edits);
        session.marker(id).unwrap().let_go(&[piece], reach)
    };
    for right in [1.49, 1.51] {
        let LetGo::Apart(way) = let_go(right) else {
            panic!("{right}");
        };
        let kept = 1.5 - (right + way.x);
        assert!((kept - clearance).abs() < 1e-9, "{kept}");
    }
    assert_eq!(let_go(1.4), LetGo::Apart(Vec2::zeros()));
    assert_eq!(let_go(1.65), LetGo::Over(Obstacle::Flaw));
}

/// A search goes on for a marker of one size while the garment is looked at in another, and its result is taken over.
#[test]
fn a_search_outlives_a_change_of_the_size_on_show() {
    let (mut session, id) = laid();
    let ordered = session.project().pattern.marker(id).unwrap().order[0].size;
    assert!(ordered.is_some());
    let found = searched(&mut session, id);
    let size = Command::SetSize {
        size: Some("S".to_owned()),
    };
    session.execute(size, &mut Silent).unwrap();
    assert!(session.adopt_marker(found).unwrap().is_some());
}
