//! A garment that hangs follows an edit of its pattern: predicted, then corrected; and hands on the cloth
//! need no other structure.

use toile_drape::laws::elastic::ElasticLaw;
use toile_drape::{Attachment, Attachments, GarmentRun, Stage};
use toile_geometry::Vec3;
use toile_session::{Command, Quality, Session, Silent};
use toile_tests::edits::{Ends, Hung, draped};
use toile_tests::random::Random;
use toile_tests::root;

#[test]
fn an_edit_is_predicted_and_the_garment_goes_on_to_rest() {
    let mut hung = Hung::new("t-shirt.toile.json", Quality::Preview).unwrap();
    let mut random = Random(36);
    // The first edit keeps what the later ones share.
    hung.edit(&mut random, 1e-3).unwrap();
    let trial = hung.edit(&mut random, 1e-3).unwrap();
    assert!(trial.shares_topology);
    let [before, predicted, end] = trial.residuals;
    assert!(predicted <= 0.5 * before, "{trial:?}");
    assert!(trial.at_rest && end < 1e-2 * before, "{trial:?}");
    assert_eq!(trial.crossings, 0, "{trial:?}");
    let fresh = draped(hung.fresh_setup(0).unwrap()).unwrap();
    let fresh = Ends::of(&fresh.system.mesh(&fresh.state.positions));
    let off = [trial.ends.hem - fresh.hem, trial.ends.girth - fresh.girth];
    assert!(off.iter().all(|off| off.abs() < 0.015), "{off:?}");
}

/// The T-shirt with its seams closed.
fn swinging() -> GarmentRun {
    let path = root().join("patterns/t-shirt.toile.json");
    let mut session = Session::new();
    let quality = Quality::Preview;
    for command in [Command::open(path), Command::SetQuality { quality }] {
        session.execute(command, &mut Silent).unwrap();
    }
    let mut run = GarmentRun::new(session.garment_setup().unwrap().setup).unwrap();
    while run.progress().stage == Stage::Sewing {
        run.advance().unwrap();
    }
    run
}

/// Drags vertices about while a garment swings, so many times; the places it comes to.
fn dragged(count: usize) -> Vec<Vec3> {
    const AT_ONCE: usize = 10;
    let mut run = swinging();
    // The first step works the structure out.
    run.advance().unwrap();
    let structures = run.structures();
    let mut random = Random(5);
    for _ in 0..count / AT_ONCE {
        assert_eq!(run.progress().stage, Stage::Swinging);
        let hands = (0..AT_ONCE).map(|_| {
            let vertex = random.below(run.state.positions.len());
            let way = Vec3::from_fn(|_, _| random.between(-0.05, 0.05));
            Attachment {
                vertex: vertex as u32,
                place: run.state.positions[vertex] + way,
                law: ElasticLaw {
                    stiffness: 100.0,
                    largest_force: 5.0,
                },
            }
        });
        let hands: Attachments = hands.collect();
        run.control_mut().attachments = hands;
        run.advance().unwrap();
        assert_eq!(run.structures(), structures);
    }
    run.into_simulation().state.positions
}

#[test]
fn a_thousand_drags_need_no_other_structure_and_come_to_the_same_places_again() {
    let places = dragged(1000);
    assert_eq!(places, dragged(1000));
}
