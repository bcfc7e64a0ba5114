//! Steps of every method in six cases, and of the stages of a garment.

use crate::record::Record;
use crate::states::{self, Frozen};
use toile_drape::{
    Collider, ContactSettings, GarmentLevel, GarmentRun, GarmentSetup, MethodKind,
    PseudoTransientContinuation, RestSettings, SewSettings, Stage, State, Workspace,
};
use toile_geometry::Vec3;
use toile_lab::card;
use toile_session::{Command, Quality, SAMPLE, Session, Silent};

/// Step in time (s).
const STEP: f64 = 1.0 / 240.0;
/// Steps of sewing after which panels are still apart.
const EARLY: usize = 5;
/// Steps of a stage.
const STAGE_STEPS: usize = 20;

/// Places and velocities.
fn note(record: &mut Record, name: &str, state: &State) {
    record.vectors(&format!("{name}, places"), &state.positions);
    record.vectors(&format!("{name}, velocities"), &state.velocities);
}

pub fn note_methods(record: &mut Record) {
    let cases: [(&str, Frozen); 6] = [
        ("cantilever", states::scene("cantilever")),
        ("hang", states::scene("hang")),
        ("sphere", states::on_the_ball()),
        ("tube", states::scene("tube")),
        ("shirt", states::scene("shirt")),
        ("three layers", states::three_layers()),
    ];
    for (case, (system, start)) in &cases {
        for (method, kind) in MethodKind::ALL {
            let mut state = start.clone();
            let mut advancing =
                toile_reference::build(&kind.into()).expect("a method that there is");
            for step in 1..=10 {
                let name = format!("{case}, {method}, step {step}");
                if let Err(error) = advancing.advance(system, &mut state, STEP) {
                    record.words(&name, &error.to_string());
                    break;
                }
                if step == 1 || step == 10 {
                    note(record, &name, &state);
                }
            }
        }
    }
}

/// The T-shirt at preview, as it is placed round the body.
pub fn placed_shirt() -> GarmentSetup {
    let mut session = Session::new();
    let commands = [
        Command::open(SAMPLE),
        Command::SetQuality {
            quality: Quality::Preview,
        },
    ];
    session.execute_all(&commands, &mut Silent).unwrap();
    session.garment_setup().unwrap().setup
}

pub fn note_stages(record: &mut Record) {
    let mut run = GarmentRun::new(placed_shirt()).unwrap();
    let mut steps = 0;
    while steps < STAGE_STEPS && run.progress().stage == Stage::Sewing {
        run.advance().unwrap();
        steps += 1;
        if steps == EARLY {
            note(record, "sewing, early", &run.state);
        }
    }
    note(record, "sewn", &run.state);
    record.numbers("sewing, steps", &[steps as f64]);
    record.numbers("sewing, gap", &[run.gap_before_merging()]);

    // The standard shirt is sewn already: it is merged at once and swings.
    let scene = card("shirt").unwrap();
    let cloth = scene.cloth(0).unwrap();
    let (system, _) = scene.system(&cloth, &[]).unwrap();
    let setup = GarmentSetup {
        counted: vec![true; cloth.triangles.len()],
        levels: vec![GarmentLevel {
            cloth,
            ..GarmentLevel::default()
        }],
        colliders: system.colliders.iter().map(surface_of).collect(),
        contact: ContactSettings {
            cloth_offset: 2e-3,
            ..ContactSettings::default()
        },
        gravity: Vec3::new(0.0, -9.81, 0.0),
        sew: SewSettings::default(),
        rest: RestSettings::default(),
    };
    let mut run = GarmentRun::new(setup).unwrap();
    assert_eq!(run.progress().stage, Stage::Swinging);
    for _ in 0..STAGE_STEPS {
        run.advance().unwrap();
    }
    assert_eq!(run.progress().stage, Stage::Swinging);
    note(record, "swing", &run.state);

    let (mut state, mut workspace) = (run.state.clone(), Workspace::default());
    let mut rest = PseudoTransientContinuation::new(RestSettings::default());
    for _ in 0..STAGE_STEPS {
        rest.advance(&run.system, &mut state, &mut workspace)
            .unwrap();
    }
    note(record, "rest", &state);
    record.numbers("rest, residual", &[rest.residual()]);
    let mut anchors = vec![Vec3::zeros(); state.samples.len()];
    let mut forces = vec![0.0; state.samples.len()];
    for friction in &state.solid_friction {
        anchors[friction.sample as usize] = friction.anchor;
        forces[friction.sample as usize] = friction.force;
    }
    record.vectors("rest, anchors", &anchors);
    record.list("rest, normal forces", forces);
}

fn surface_of(collider: &Collider) -> std::sync::Arc<toile_geometry::SurfaceTree> {
    collider.surface.clone()
}
