//! Cloth that starts tangled, made from a seed: points pushed through a layer, layers that cross, a
//! fold through itself, a panel half inside a body.

use super::numbers::Numbers;
use super::sheets::object;
use super::solids::sphere;
use toile_drape::{ContactSettings, Damping, Material, MethodKind, ObjectKind, Scene, SceneObject};
use toile_geometry::{TriangleMesh, Vec3};

/// What is planted, in turn.
#[allow(dead_code)] // Tests name them themselves.
pub const KINDS: [&str; 4] = [
    "points pushed through",
    "layers crossed",
    "a fold through itself",
    "a panel half in a body",
];

const CELLS: usize = 12;
const WIDTH: f64 = 0.18;

fn sheet(place: impl Fn(f64, f64) -> Vec3) -> TriangleMesh {
    super::sheets::sheet([CELLS, CELLS], [WIDTH; 2], place)
}

fn corners() -> Vec<u32> {
    let n = CELLS as u32;
    vec![0, n, n * (n + 1), n * (n + 1) + n]
}

/// Flat layers as they rest, and where they start.
fn starting(name: &str, rest: TriangleMesh, start: Vec<Vec3>, pins: Vec<u32>) -> SceneObject {
    let laid = toile_drape::Cloth::from_mesh(name, &rest, Material::default()).expect("sound");
    let mut object = object(name, rest, pins);
    object.mesh.positions.clone_from(&start);
    object.cloth = Some(toile_drape::Cloth {
        positions: start,
        ..laid
    });
    object
}

/// The tangle of a seed; its kind is `KINDS[seed % 4]`.
pub fn tangle(seed: u64) -> Scene {
    let mut numbers = Numbers(seed.wrapping_mul(977) + 11);
    numbers.next();
    let objects = match seed % 4 {
        0 => pushed_through(&mut numbers),
        1 => crossed(&mut numbers),
        2 => folded(&mut numbers),
        _ => half_inside(&mut numbers),
    };
    Scene {
        duration: 1.5,
        method: MethodKind::Xpbd.into(),
        damping: Damping {
            mass: 4.0,
            stiffness: 0.0,
        },
        contact: ContactSettings {
            cloth_offset: 2e-3,
            ..ContactSettings::default()
        },
        objects,
        ..Scene::default()
    }
}

/// Two layers that hang by their corners; one to four places of the upper lie beneath the lower.
fn pushed_through(numbers: &mut Numbers) -> Vec<SceneObject> {
    let low = sheet(|x, z| Vec3::new(x, 0.0, z));
    let high = sheet(|x, z| Vec3::new(x, 0.005, z));
    let count = 1 + (4.0 * numbers.next()) as usize;
    let places: Vec<[f64; 4]> = (0..count)
        .map(|_| {
            [
                numbers.between(0.1, 0.9) * WIDTH,
                numbers.between(0.1, 0.9) * WIDTH,
                numbers.between(0.008, 0.02),
                numbers.between(0.012, 0.03),
            ]
        })
        .collect();
    let start = high.positions.iter().map(|p| {
        let depth = places.iter().map(|&[x, z, depth, wide]| {
            let off = (p.x - x).hypot(p.z - z) / wide;
            depth * (-off * off).exp()
        });
        p - Vec3::y() * depth.fold(0.0, f64::max)
    });
    let start: Vec<Vec3> = start.collect();
    vec![
        object("low", low, corners()),
        starting("high", high, start, corners()),
    ]
}

/// A border or a corner of the upper layer dips through the lower.
fn crossed(numbers: &mut Numbers) -> Vec<SceneObject> {
    let low = sheet(|x, z| Vec3::new(x, 0.0, z));
    let (sine, cosine) = numbers.between(0.0, std::f64::consts::TAU).sin_cos();
    let (depth, share) = (numbers.between(0.01, 0.03), numbers.between(0.2, 0.5));
    let shift = Vec3::new(
        numbers.between(-0.03, 0.03),
        0.006,
        numbers.between(-0.03, 0.03),
    );
    let high = sheet(|x, z| {
        let along = (cosine * (x / WIDTH - 0.5) + sine * (z / WIDTH - 0.5)) / 0.7 + 0.5;
        let dip = depth * ((share - along) / share).max(0.0);
        Vec3::new(x, -dip, z) + shift
    });
    vec![object("low", low, corners()), object("high", high, vec![])]
}

/// A sheet folded over, the free end passing through the part below.
fn folded(numbers: &mut Numbers) -> Vec<SceneObject> {
    let (radius, line) = (0.006, numbers.between(0.08, 0.11));
    let slope = numbers.between(0.25, 0.6);
    let skew = numbers.between(-0.15, 0.15);
    let rest = sheet(|x, z| Vec3::new(x, 0.0, z));
    let arc = std::f64::consts::PI * radius;
    let start = rest.positions.iter().map(|p| {
        let line = line + skew * (p.z - 0.5 * WIDTH);
        let past = p.x - line;
        if past <= 0.0 {
            *p
        } else if past < arc {
            let angle = past / radius;
            let up = radius * (1.0 - angle.cos());
            Vec3::new(line + radius * angle.sin(), up, p.z)
        } else {
            let back = past - arc;
            Vec3::new(
                line - back * (1.0 - slope * slope).sqrt(),
                2.0 * radius - slope * back,
                p.z,
            )
        }
    });
    let start = start.collect();
    let n = CELLS as u32;
    let pins = (0..=n).map(|j| j * (n + 1)).collect();
    vec![starting("sheet", rest, start, pins)]
}

/// A flat panel, part of it inside a ball.
fn half_inside(numbers: &mut Numbers) -> Vec<SceneObject> {
    let radius = numbers.between(0.06, 0.09);
    let (height, reach) = (
        numbers.between(0.1, 0.6) * radius,
        numbers.between(-0.2, 0.5) * radius,
    );
    let tilt = numbers.between(-0.3, 0.3);
    let panel = sheet(|x, z| {
        let along = x + reach;
        Vec3::new(along, height + tilt * along, z - 0.5 * WIDTH)
    });
    let ball = SceneObject {
        name: "ball".to_owned(),
        kind: ObjectKind::Static,
        mesh: sphere(radius, Vec3::zeros()),
        cloth: None,
        layer: 0,
    };
    vec![object("panel", panel, vec![]), ball]
}
