//! Ends of whole runs: the smallest garment, the T-shirt, three scenes.

use crate::band::band;
use crate::motions::placed_shirt;
use std::fmt::Write;
use std::path::PathBuf;
use toile_drape::{
    ContactSettings, Damping, GarmentRun, GarmentSetup, Material, MethodKind, ObjectKind, Scene,
    SceneElastic, SceneEnd, SceneObject, SceneRun, Stage, measure,
};
use toile_geometry::{TriangleMesh, Vec2, Vec3};
use toile_lab::{MeshKind, card, rectangle};
use toile_session::{Command, Quality, Session, Silent};

/// How far an end may be from that recorded in any direction (m).
const NEAR: f64 = 0.01;
/// Sewn garments come to rest below this net force over weight.
const REST: f64 = 1e-2;

/// Holds the ends to the bounds in the file, or writes it.
pub fn check() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/recorded/ends.txt");
    let ends = ends();
    if std::env::var_os("TOILE_RECORD").is_some() {
        let mut text = String::new();
        for (name, size) in &ends {
            let [low, high] = *size;
            writeln!(
                text,
                "{name}: {:.3?} {:.3?}",
                low.as_slice(),
                high.as_slice()
            )
            .unwrap();
        }
        std::fs::write(path, text).unwrap();
        return;
    }
    let recorded = std::fs::read_to_string(path).unwrap();
    assert_eq!(recorded.lines().count(), ends.len());
    for (line, (name, size)) in recorded.lines().zip(&ends) {
        let numbers = line.split(['[', ']', ',', ' ']);
        let numbers: Vec<f64> = numbers.filter_map(|word| word.parse().ok()).collect();
        assert!(line.starts_with(name) && numbers.len() == 6, "{line}");
        let now = size[0].iter().chain(size[1].iter());
        for (was, now) in numbers.iter().zip(now) {
            assert!((was - now).abs() <= NEAR, "{line}, now {size:?}");
        }
    }
}

/// The box round a mesh where it ends (m).
type Size = [Vec3; 2];

fn size(places: &[Vec3]) -> Size {
    let low = places
        .iter()
        .fold(Vec3::repeat(f64::INFINITY), |low, p| low.inf(p));
    let high = places
        .iter()
        .fold(Vec3::repeat(f64::NEG_INFINITY), |high, p| high.sup(p));
    [low, high]
}

fn ends() -> Vec<(&'static str, Size)> {
    vec![
        ("band", worn(placed_band())),
        ("T-shirt at preview", worn(placed_shirt())),
        ("a sheet falls on a ball", played(&falling(1))),
        ("two sheets fall on a ball", played(&falling(2))),
        ("two sheets are sewn and hang", played(&sewn())),
    ]
}

fn placed_band() -> GarmentSetup {
    let folder = std::env::temp_dir().join(format!("toile-recorded-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut session = Session::new();
    let commands = [
        Command::open(band(&folder)),
        Command::SetQuality {
            quality: Quality::Preview,
        },
    ];
    session.execute_all(&commands, &mut Silent).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    session.garment_setup().unwrap().setup
}

fn worn(setup: GarmentSetup) -> Size {
    let mut run = GarmentRun::new(setup).unwrap();
    while run.progress().stage != Stage::Finished {
        run.advance().unwrap();
    }
    let mut workspace = toile_drape::Workspace::default();
    let measures = measure(&run.system, &run.state, &mut workspace, &[]);
    assert!(measures.residual < REST, "{measures:?}");
    assert_eq!(measures.body_intersections, 0);
    assert_eq!(measures.self_intersections, 0);
    size(&run.state.positions)
}

fn cloth(name: &str, place: impl Fn(Vec2) -> Vec3, layer: u16) -> SceneObject {
    let half = Vec2::new(0.2, 0.2);
    let flat = rectangle(MeshKind::Alternating, -half, half, [16, 16]).unwrap();
    SceneObject {
        name: name.to_owned(),
        kind: ObjectKind::Deformable {
            material: Material::default(),
            pins: Vec::new(),
        },
        mesh: TriangleMesh {
            positions: flat.points.iter().map(|&p| place(p)).collect(),
            triangles: flat.triangles,
        },
        cloth: None,
        layer,
    }
}

/// Sheets above the ball of the standard scene.
fn falling(sheets: u16) -> Scene {
    let system = card("sphere")
        .and_then(|card| card.system(&card.cloth(0)?, &[]))
        .unwrap()
        .0;
    let ball = SceneObject {
        name: "ball".to_owned(),
        kind: ObjectKind::Static,
        mesh: system.colliders[0].surface.mesh().clone(),
        cloth: None,
        layer: 0,
    };
    let each = |k: u16| {
        let height = 0.13 + 0.02 * f64::from(k);
        cloth(
            &format!("sheet {k}"),
            move |p| Vec3::new(p.x, height, p.y),
            k,
        )
    };
    let mut objects: Vec<SceneObject> = (0..sheets).map(each).collect();
    objects.push(ball);
    Scene {
        duration: 0.6,
        damping: Damping {
            mass: 4.0,
            stiffness: 0.0,
        },
        method: MethodKind::Xpbd.into(),
        contact: ContactSettings {
            cloth_offset: 2e-3,
            ..ContactSettings::default()
        },
        objects,
        ..Scene::default()
    }
}

/// Two sheets side by side, the first held along an edge, drawn together along the edge between them.
fn sewn() -> Scene {
    let mut held = cloth("held", |p| Vec3::new(p.x, 0.0, p.y), 0);
    if let ObjectKind::Deformable { pins, .. } = &mut held.kind {
        pins.extend((0..17).map(|j| j * 17));
    }
    let free = cloth("free", |p| Vec3::new(p.x + 0.41, 0.0, p.y), 0);
    let seam = |j: u32| SceneElastic {
        from: SceneEnd::Vertex {
            object: 0,
            vertex: j * 17 + 16,
        },
        to: SceneEnd::Vertex {
            object: 1,
            vertex: j * 17,
        },
        stiffness: 200.0,
        merge_within: Some(1e-3),
    };
    Scene {
        duration: 0.5,
        damping: Damping {
            mass: 6.0,
            stiffness: 0.0,
        },
        method: MethodKind::ImplicitEuler.into(),
        objects: vec![held, free],
        elastics: (0..17).map(seam).collect(),
        ..Scene::default()
    }
}

fn played(scene: &Scene) -> Size {
    let mut run = SceneRun::new(scene, toile_reference::build).unwrap();
    while !run.finished() {
        run.advance().unwrap();
    }
    let measures = run.measure();
    assert_eq!(measures.body_intersections, 0);
    assert_eq!(run.crossings(), 0);
    size(&run.state.positions)
}
