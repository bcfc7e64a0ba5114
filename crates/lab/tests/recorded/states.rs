//! Frozen states: a sheet, a ball, a worn shirt, three layers, a fold, a tangle; and a sheet of each law.

use crate::numbers::Numbers;
use toile_drape::{Cloth, Compression, Material, State, System, SystemBuilder};
use toile_geometry::{Vec2, Vec3};
use toile_lab::{Flat, MeshKind, card, rectangle};

/// A model and a state of it.
pub type Frozen = (System, State);

/// Distance kept between cloths (m).
const APART: f64 = 2e-3;

/// A standard scene at its coarsest as it starts.
pub fn scene(name: &str) -> Frozen {
    let card = card(name).unwrap();
    let cloth = card.cloth(0).unwrap();
    card.system(&cloth, &card.cloths[0].pins).unwrap()
}

/// The same with some noise in its places, so that nothing is balanced.
pub fn stirred(name: &str, by: f64) -> Frozen {
    let (system, mut state) = scene(name);
    let mut numbers = Numbers(7);
    for (place, pinned) in state.positions.iter_mut().zip(&system.prescribed.pinned) {
        if !pinned {
            *place += numbers.vector(by);
        }
    }
    (system, state)
}

/// A sheet that lies on the ball of the scene, within the reach of contact.
pub fn on_the_ball() -> Frozen {
    let (system, mut state) = stirred("sphere", 1e-4);
    let radius = 0.12f64;
    for place in &mut state.positions {
        let flat = place.x.hypot(place.z).min(0.98 * radius);
        place.y = (radius * radius - flat * flat).sqrt() + 2e-3;
    }
    (system, state)
}

fn square(cells: usize) -> Flat {
    let (from, to) = (Vec2::zeros(), Vec2::new(0.2, 0.2));
    rectangle(MeshKind::Alternating, from, to, [cells, cells]).unwrap()
}

/// Sheets beside one another in one cloth.
fn together(sheets: &[Cloth]) -> Cloth {
    let mut all = Cloth {
        materials: sheets[0].materials.clone(),
        ..Cloth::default()
    };
    for (panel, sheet) in (0..).zip(sheets) {
        let first = all.positions.len() as u32;
        all.positions.extend(&sheet.positions);
        let moved = sheet.triangles.iter().map(|t| t.map(|v| v + first));
        all.triangles.extend(moved);
        all.rest.extend(&sheet.rest);
        all.material.extend(&sheet.material);
        all.panel.extend(sheet.panel.iter().map(|_| panel));
    }
    all
}

fn touching(cloth: &Cloth) -> Frozen {
    let mut builder = SystemBuilder::new("frozen", cloth).unwrap();
    builder.contact.cloth_offset = APART;
    let system = builder.build();
    let state = State::at_rest(&system, cloth.positions.clone());
    (system, state)
}

/// Three sheets in order, nearer than they keep apart.
pub fn three_layers() -> Frozen {
    let flat = square(10);
    let sheets: Vec<Cloth> = (0..3)
        .map(|k| {
            let height = f64::from(k) * 1.2e-3;
            let wave = move |p: Vec2| 4e-4 * (50.0 * p.x + f64::from(k)).sin() * (40.0 * p.y).cos();
            flat.cloth(Material::default(), |p| {
                Vec3::new(p.x, height + wave(p), p.y)
            })
        })
        .collect();
    let each = flat.points.len();
    let (mut system, state) = touching(&together(&sheets));
    system = system.with(|builder| {
        builder.layer = (0..3 * each).map(|v| (v / each) as u16).collect();
    });
    (system, state)
}

/// A sheet folded over itself, its leaves nearer than they keep apart.
pub fn fold() -> Frozen {
    let radius = 0.7e-3;
    let arc = std::f64::consts::PI * radius;
    let half = 0.1 - arc / 2.0;
    let cloth = square(14).cloth(Material::default(), |p| {
        let along = p.x - half;
        let ripple = 1e-4 * (60.0 * p.y).sin();
        let (x, y) = match () {
            () if along < 0.0 => (p.x, -radius),
            () if along < arc => {
                let angle = along / radius;
                (half + radius * angle.sin(), -radius * angle.cos())
            }
            () => (half - (along - arc), radius),
        };
        Vec3::new(x, y + ripple, p.y)
    });
    touching(&cloth)
}

/// Two sheets that cross.
pub fn tangle() -> Frozen {
    let flat = square(10);
    let lying = flat.cloth(Material::default(), |p| Vec3::new(p.x, 0.0, p.y));
    let slanted = flat.cloth(Material::default(), |p| {
        Vec3::new(p.x + 3.1e-3, 0.3 * (p.x - 0.1) + 1e-3, p.y + 4.7e-3)
    });
    touching(&together(&[lying, slanted]))
}

/// A wavy, stretched sheet of each law of cloth.
pub fn laws() -> Vec<(&'static str, Frozen)> {
    let plain = Material::default();
    let of = |name, material: Material| {
        let cloth = square(8).cloth(material, |p| {
            let wave = 6e-3 * (40.0 * p.x).sin() * (30.0 * p.y).cos();
            Vec3::new(1.03 * p.x + 0.1 * p.y, wave, 0.97 * p.y)
        });
        let mut builder = SystemBuilder::new(name, &cloth).unwrap();
        builder.pinned[0] = true;
        builder.pinned[8] = true;
        let system = builder.build();
        let mut state = State::at_rest(&system, cloth.positions.clone());
        for (velocity, place) in state.velocities.iter_mut().zip(&state.positions) {
            *velocity = Vec3::new(place.y, place.z, -place.x) * 2.0;
        }
        (name, (system, state))
    };
    vec![
        of("linear", plain.clone()),
        of(
            "orthotropic",
            Material {
                stretch: [900.0, 200.0],
                poisson: 0.3,
                bend: [4e-5, 1e-5, 2e-5],
                ..plain.clone()
            },
        ),
        of(
            "hardening",
            Material {
                hardening: [130.0, 40.0],
                ..plain.clone()
            },
        ),
        of(
            "strain limit",
            Material {
                strain_limit: [0.04, 0.06],
                ..plain.clone()
            },
        ),
        of(
            "tension field",
            Material {
                compression: Compression::TensionField,
                ..plain.clone()
            },
        ),
        of(
            "bending with a Poisson ratio",
            Material {
                bend_poisson: 0.3,
                ..plain.clone()
            },
        ),
        of(
            "viscous",
            Material {
                viscosity: 0.5,
                bend_viscosity: 1e-6,
                stiffness_damping: 1e-3,
                ..plain.clone()
            },
        ),
        of(
            "strain is kept",
            Material {
                relaxed_fraction: [0.3, 0.5],
                relaxation_time: 0.2,
                ..plain.clone()
            },
        ),
    ]
}
