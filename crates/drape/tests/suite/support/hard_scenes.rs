//! Hard scenes for contact of cloth with cloth and with bodies that move, small for tests and large
//! for long runs.

use super::hard_run::End;
use super::sheets::{object, sheet};
use super::solids::{block, cylinder, sphere, torus};
use toile_drape::{
    Cloth, Compression, ContactSettings, Damping, Material, MethodKind, Motion, MotionKey,
    ObjectKind, Scene, SceneGrip, SceneObject,
};
use toile_geometry::{TriangleMesh, Vec3};

/// A scene and what must hold in it.
pub struct HardScene {
    /// Its name.
    pub name: &'static str,
    /// The scene.
    pub scene: Scene,
    /// When the last body or grip stops (s): from then on nothing puts work in.
    pub driven_until: f64,
    /// Velocity of each object at the start (m/s); empty for rest.
    pub velocities: Vec<Vec3>,
    /// How far the energy may rise, as a share of what energies are compared with.
    pub most_rise: f64,
    /// Whether the end shows what the scene is about; without that a scene in which nothing met
    /// would do.
    pub shown: fn(&End) -> bool,
}

/// How far the energy may rise where nothing is said: what contact in substeps leaves.
const MAX_RISE: f64 = 0.02;

/// How fine and how many. Where cloth is hit hard, substeps grow with the cells of a side: stretch then
/// crosses as many cells in each at both sizes. What one sweep leaves of a strain counts as energy at
/// its full stiffness, and 20 substeps at full size show a rise of 94 % (flight), 18 % (sphere), 70 % (ring),
/// 28 % (twist), and four (layers) and seven times (fold, of which little moves then).
#[allow(dead_code)] // Tests run short ones, long runs long ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// For tests.
    Short,
    /// For long runs.
    Long,
}

impl Size {
    fn pick<T>(self, short: T, long: T) -> T {
        match self {
            Self::Short => short,
            Self::Long => long,
        }
    }
}

/// Every hard scene.
pub fn hard_scenes(size: Size) -> Vec<HardScene> {
    vec![
        crumpled_in_a_box(size),
        layers_on_a_cylinder(size),
        twisted(size),
        through_a_ring(size),
        stacked(size),
        knotted(size),
        pinched(size),
        curtain_and_sphere(size),
        folded_and_dropped(size),
        two_in_free_flight(size),
    ]
}

/// The hard scene of a name.
#[allow(dead_code)]
pub fn hard_scene(name: &str, size: Size) -> HardScene {
    let mut found = hard_scenes(size).into_iter().filter(|s| s.name == name);
    found.next().expect("a name of the list")
}

fn solid(name: &str, mesh: TriangleMesh, keys: Vec<MotionKey>) -> SceneObject {
    let motion = Motion {
        pivot: Vec3::zeros(),
        keys,
    };
    SceneObject {
        name: name.to_owned(),
        kind: if motion.keys.is_empty() {
            ObjectKind::Static
        } else {
            ObjectKind::moving(motion)
        },
        mesh,
        cloth: None,
        layer: 0,
    }
}

fn key(time: f64, translation: Vec3, rotation: Vec3) -> MotionKey {
    MotionKey {
        time,
        translation,
        rotation,
    }
}

/// Goes from rest by `way` between two times.
fn shifted(from: f64, to: f64, way: Vec3) -> Vec<MotionKey> {
    let still = Vec3::zeros();
    vec![key(from, still, still), key(to, way, still)]
}

fn floor() -> SceneObject {
    let corner = Vec3::new(1.0, 0.0, 1.0);
    solid("floor", block(-corner - Vec3::y() * 0.1, corner), vec![])
}

fn base(duration: f64, objects: Vec<SceneObject>) -> Scene {
    Scene {
        duration,
        method: MethodKind::Xpbd.into(),
        damping: Damping {
            mass: 0.5,
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

fn of(name: &'static str, scene: Scene, driven_until: f64, shown: fn(&End) -> bool) -> HardScene {
    HardScene {
        name,
        scene,
        driven_until,
        velocities: Vec::new(),
        most_rise: MAX_RISE,
        shown,
    }
}

/// Walls and a lid press a sheet into a quarter of its room.
fn crumpled_in_a_box(size: Size) -> HardScene {
    let n = size.pick(20, 60);
    let wavy = |x: f64, z: f64| {
        let up = 0.08 + 0.02 * (17.0 * x + 9.0 * z).sin() + 0.015 * (31.0 * z - 11.0 * x).sin();
        Vec3::new(x - 0.15, up, z - 0.15)
    };
    let wall = |x: f64, z: f64| {
        let (middle, half) = (
            Vec3::new(x, 0.1, z) * 0.22 + Vec3::y() * 0.1,
            Vec3::new(
                if x == 0.0 { 0.3 } else { 0.05 },
                0.2,
                if z == 0.0 { 0.3 } else { 0.05 },
            ),
        );
        block(middle - half, middle + half)
    };
    let mut objects = vec![
        object("sheet", sheet([n, n], [0.3; 2], wavy), vec![]),
        floor(),
    ];
    for (name, x, z) in [
        ("left", -1.0, 0.0),
        ("right", 1.0, 0.0),
        ("back", 0.0, -1.0),
        ("front", 0.0, 1.0),
    ] {
        let way = Vec3::new(-x, 0.0, -z) * 0.08;
        objects.push(solid(name, wall(x, z), shifted(0.1, 0.9, way)));
    }
    let lid = block(Vec3::new(-0.3, 0.16, -0.3), Vec3::new(0.3, 0.26, 0.3));
    let way = Vec3::new(0.0, -0.1, 0.0);
    objects.push(solid("lid", lid, shifted(0.1, 0.9, way)));
    // The lid comes down to 60 mm.
    of("crumpled in a box", base(1.2, objects), 0.9, |end| {
        (end.cloth().iter()).all(|p| p.y > 0.0 && p.y < 0.06 && p.x.abs() < 0.1 && p.z.abs() < 0.1)
    })
}

fn layers_on_a_cylinder(size: Size) -> HardScene {
    let (count, cells) = size.pick((6, [16, 10]), (50, [30, 20]));
    let mut objects: Vec<SceneObject> = (0..count)
        .map(|k| {
            let lie = |x: f64, z: f64| Vec3::new(x - 0.15, 0.086 + 0.004 * f64::from(k), z - 0.1);
            object(&format!("layer {k}"), sheet(cells, [0.3, 0.2], lie), vec![])
        })
        .collect();
    objects.push(solid("cylinder", cylinder(0.08, 0.3, 48), vec![]));
    let mut scene = base(size.pick(0.8, 1.0), objects);
    scene.method.substeps = Some(size.pick(20, 60));
    of("layers on a cylinder", scene, 0.0, |end| {
        // The middle of each lies on top, one over the other.
        let layers = end.meshes.len() - 1;
        let tops = end.meshes[..layers].iter().map(|mesh| {
            let over = mesh.positions.iter().filter(|p| p.x.abs() < 0.02);
            over.map(|p| p.y).fold(f64::INFINITY, f64::min)
        });
        let tops: Vec<f64> = tops.collect();
        tops.windows(2).all(|pair| pair[0] < pair[1]) && tops[0] > 0.07
    })
}

/// A strip held at both ends, one of which turns.
fn twisted(size: Size) -> HardScene {
    let (cells, turns, time) = size.pick(([8, 24], 3.0, 1.2), ([24, 72], 10.0, 4.0));
    let mesh = sheet(cells, [0.12, 0.36], |u, v| Vec3::new(u - 0.06, 0.0, v));
    let row = |j: usize| (0..=cells[0]).map(move |i| (j * (cells[0] + 1) + i) as u32);
    let mut scene = base(time + 0.4, vec![object("strip", mesh, row(0).collect())]);
    scene.method.substeps = Some(size.pick(20, 60));
    let turn = Vec3::new(0.0, 0.0, 2.0 * std::f64::consts::PI * turns);
    let way = Vec3::new(0.0, 0.0, -0.12);
    scene.grips.push(SceneGrip {
        object: 0,
        vertices: row(cells[1]).collect(),
        motion: Motion {
            pivot: Vec3::new(0.0, 0.0, 0.36),
            keys: vec![key(0.0, Vec3::zeros(), Vec3::zeros()), key(time, way, turn)],
        },
    });
    HardScene {
        // Moves are cut where it jams, which strains it a little.
        most_rise: 0.03,
        ..of("twisted", scene, time, |end| {
            // Its middle is wound up to less than half its width.
            let middle = end.cloth().iter().filter(|p| (p.z - 0.12).abs() < 0.03);
            let (count, sum) = middle.fold((0.0, 0.0), |(n, s), p| (n + 1.0, s + p.x.hypot(p.y)));
            count > 0.0 && sum / count < 0.03
        })
    }
}

/// A scarf pulled by a corner through a ring of a third of its diagonal.
fn through_a_ring(size: Size) -> HardScene {
    let n = size.pick(20, 60);
    let mesh = sheet([n, n], [0.26; 2], |u, v| {
        let (across, up) = ((u - v) * 0.5f64.sqrt(), (u + v) * 0.5f64.sqrt());
        let wave = 0.003 * ((90.0 * across).sin() + (70.0 * up).sin());
        Vec3::new(across, up - 0.05, wave)
    });
    let corner = |v: &u32| mesh.positions[*v as usize].y < -0.03;
    let held: Vec<u32> = (0..mesh.positions.len() as u32).filter(corner).collect();
    let ring = solid("ring", torus(0.075, 0.012), vec![]);
    let silky = Material {
        friction: 0.1,
        compression: Compression::TensionField,
        ..Material::default()
    };
    let mut scarf = object("scarf", mesh, vec![]);
    scarf.kind = ObjectKind::Deformable {
        material: silky,
        pins: vec![],
    };
    let mut scene = base(1.6, vec![scarf, ring]);
    scene.method.substeps = Some(size.pick(20, 60));
    scene.grips.push(SceneGrip {
        object: 0,
        vertices: held,
        motion: Motion {
            pivot: Vec3::zeros(),
            keys: shifted(0.1, 1.1, Vec3::new(0.0, -0.4, 0.0)),
        },
    });
    of("through a ring", scene, 1.1, |end| {
        let below = end.cloth().iter().filter(|p| p.y < -0.012).count();
        10 * below > 9 * end.cloth().len()
    })
}

fn stacked(size: Size) -> HardScene {
    let n = size.pick(12, 40);
    let mut objects: Vec<SceneObject> = (0..5)
        .map(|k| {
            let (sine, cosine) = (0.4 * f64::from(k)).sin_cos();
            let lie = |x: f64, z: f64| {
                let (x, z) = (x - 0.1, z - 0.1);
                let up = 0.02 + 0.015 * f64::from(k);
                Vec3::new(cosine * x - sine * z, up, sine * x + cosine * z)
            };
            object(&format!("cloth {k}"), sheet([n, n], [0.2; 2], lie), vec![])
        })
        .collect();
    objects.push(floor());
    objects.push(solid("ball", sphere(0.04, Vec3::zeros()), vec![]));
    of("five stacked", base(0.8, objects), 0.0, |end| {
        let heights = [0, 1, 2, 3, 4].map(|k| end.middle(k).y);
        end.cloth().iter().all(|p| p.y > 0.0) && heights.windows(2).all(|pair| pair[0] < pair[1])
    })
}

/// A ribbon along an overhand knot, its ends drawn apart.
fn knotted(size: Size) -> HardScene {
    let cells = size.pick([2, 100], [4, 240]);
    let curve = |t: f64| {
        Vec3::new(
            0.03 * (t * t * t - 3.0 * t),
            0.03 * (t.powi(4) - 4.0 * t * t),
            0.008 * (t.powi(5) - 10.0 * t),
        )
    };
    let (rows, width) = (cells[1] + 1, 0.012);
    // Rows evenly along the curve, their directions carried along without twist.
    let fine: Vec<Vec3> = (0..=4000)
        .map(|k| curve(-2.2 + 4.4 * f64::from(k) / 4000.0))
        .collect();
    let mut walked = vec![0.0];
    for pair in fine.windows(2) {
        walked.push(walked.last().unwrap_or(&0.0) + (pair[1] - pair[0]).norm());
    }
    let length = walked[walked.len() - 1];
    let centre: Vec<Vec3> = (0..rows)
        .map(|j| {
            let goal = length * j as f64 / (rows - 1) as f64;
            let k = walked.partition_point(|&w| w < goal).min(fine.len() - 1);
            fine[k]
        })
        .collect();
    let mut across = Vec3::x();
    let mut directions = Vec::new();
    for j in 0..rows {
        let along = (centre[(j + 1).min(rows - 1)] - centre[j.saturating_sub(1)]).normalize();
        across = (across - along * across.dot(&along)).normalize();
        directions.push(across);
    }
    let mesh = sheet(cells, [1.0, (rows - 1) as f64], |u, v| {
        let j = v.round() as usize;
        centre[j] + directions[j] * (width * (u - 0.5))
    });
    let row = |j: usize| (0..=cells[0]).map(move |i| (j * (cells[0] + 1) + i) as u32);
    let mut scene = base(2.0, vec![object("ribbon", mesh, vec![])]);
    // Strain that 20 substeps leave in the drawn ribbon goes up and down by more than its energy falls.
    scene.method.substeps = Some(size.pick(30, 60));
    scene.gravity = Vec3::zeros();
    let apart = 0.5 * (0.88 * length - (centre[rows - 1] - centre[0]).norm());
    for (j, sign) in [(0, -1.0), (rows - 1, 1.0)] {
        let way = Vec3::new(0.0, 0.0, sign * apart);
        scene.grips.push(SceneGrip {
            object: 0,
            vertices: row(j).chain(row(if j == 0 { 1 } else { j - 1 })).collect(),
            motion: Motion {
                pivot: Vec3::zeros(),
                keys: shifted(0.0, 1.6, way),
            },
        });
    }
    of("knot", scene, 1.6, |end| {
        // Still knotted: a straight ribbon has a writhe near 0.
        let across = if end.cloth().len() == 303 { 3 } else { 5 };
        let line: Vec<Vec3> = end
            .cloth()
            .chunks(across)
            .map(|row| row[across / 2])
            .collect();
        writhe(&line).abs() > 2.0
    })
}

/// How often a line crosses itself, signed, seen from all sides (Fuller 1971).
fn writhe(line: &[Vec3]) -> f64 {
    let parts: Vec<(Vec3, Vec3)> = (line.windows(2))
        .map(|pair| ((pair[0] + pair[1]) * 0.5, pair[1] - pair[0]))
        .collect();
    let mut sum = 0.0;
    for (k, (p, along)) in parts.iter().enumerate() {
        for (q, other) in &parts[k + 1..] {
            let between = p - q;
            sum += along.cross(other).dot(&between) / between.norm().powi(3);
        }
    }
    sum / std::f64::consts::TAU
}

/// Two cloths hang beside a trunk; an arm closes on them and rubs.
fn pinched(size: Size) -> HardScene {
    let cells = size.pick([14, 20], [40, 60]);
    let top: Vec<u32> = (0..=cells[0] as u32).collect();
    let hung = |x0: f64| {
        sheet(cells, [0.28, 0.4], move |u, v| {
            let fold = 0.02 * (38.0 * u).sin() * (v / 0.4);
            Vec3::new(x0 + fold, 0.2 - v, u - 0.14)
        })
    };
    let upright = |radius: f64, length: f64, x: f64| {
        let mut mesh = cylinder(radius, length, 48);
        for p in &mut mesh.positions {
            *p = Vec3::new(p.x + x, p.z, -p.y);
        }
        mesh
    };
    let arm =
        |time: f64, x: f64, turn: f64| key(time, Vec3::new(x, 0.0, 0.0), Vec3::new(turn, 0.0, 0.0));
    let keys = vec![
        arm(0.1, 0.0, 0.0),
        arm(0.6, -0.079, 0.0),
        arm(0.8, -0.079, 0.3),
        arm(1.0, -0.079, -0.2),
    ];
    let mut arm_shape = upright(0.045, 0.22, 0.26);
    for p in &mut arm_shape.positions {
        p.y -= 0.03;
    }
    let objects = vec![
        object("inner", hung(0.17), top.clone()),
        object("outer", hung(0.182), top),
        solid("trunk", upright(0.12, 0.6, 0.0), vec![]),
        solid("arm", arm_shape, keys),
    ];
    of("pinched by an arm", base(1.2, objects), 1.0, |end| {
        // Both lie between the arm and the trunk, one outside the other.
        end.farthest > 0.02 && end.middle(0).x < end.middle(1).x
    })
}

/// Two halves of a curtain that overlap, and a sphere at 10 m/s.
fn curtain_and_sphere(size: Size) -> HardScene {
    let cells = size.pick([10, 20], [32, 64]);
    let half = |x0: f64, z0: f64| {
        sheet(cells, [0.3, 0.6], move |u, v| {
            Vec3::new(x0 + u, -v, z0 + 0.004 * (60.0 * u).sin())
        })
    };
    let top: Vec<u32> = (0..=cells[0] as u32).collect();
    let ball = sphere(0.07, Vec3::new(0.0, -0.35, -0.2));
    let keys = shifted(0.05, 0.15, Vec3::new(0.0, 0.0, 1.0));
    let objects = vec![
        object("left", half(-0.28, 0.0), top.clone()),
        object("right", half(-0.02, 0.012), top),
        solid("sphere", ball, keys),
    ];
    let mut scene = base(0.7, objects);
    scene.method.substeps = Some(size.pick(20, 64));
    // The sphere takes the curtain with it.
    of("sphere at 10 m/s", scene, 0.15, |end| end.farthest > 0.2)
}

/// A strip folded in four like an accordion falls on a floor.
fn folded_and_dropped(size: Size) -> HardScene {
    let n = size.pick(1, 3);
    let (straight, radius) = (0.06, 0.006);
    let arc = std::f64::consts::PI * radius;
    let length = 4.0 * straight + 3.0 * arc;
    let cells = [14 * n, 40 * n];
    let flat = sheet(cells, [0.12, length], |u, v| Vec3::new(v, 0.0, u));
    let fold = |s: f64, z: f64| {
        let piece = (s / (straight + arc)).floor().min(3.0);
        let (along, level) = (s - piece * (straight + arc), 2.0 * radius * piece);
        let (x, y) = if along <= straight {
            (along, level)
        } else {
            let angle = (along - straight) / radius;
            (
                straight + radius * angle.sin(),
                level + radius * (1.0 - angle.cos()),
            )
        };
        let x = if (piece as usize).is_multiple_of(2) {
            x
        } else {
            straight - x
        };
        Vec3::new(x - 0.5 * straight, 0.05 + y, z - 0.06)
    };
    let rest = Cloth::from_mesh("strip", &flat, Material::default()).expect("a sound sheet");
    let places: Vec<Vec3> = flat.positions.iter().map(|p| fold(p.x, p.z)).collect();
    let mut object = object("strip", flat, vec![]);
    object.mesh.positions.clone_from(&places);
    object.cloth = Some(Cloth {
        positions: places,
        ..rest
    });
    let mut scene = base(0.8, vec![object, floor()]);
    scene.method.substeps = Some(size.pick(20, 60));
    HardScene {
        most_rise: 0.03,
        ..of("folded and dropped", scene, 0.0, |end| {
            end.cloth().iter().all(|p| p.y > 0.0 && p.y < 0.06)
        })
    }
}

/// Two sheets meet in flight: nothing else acts.
fn two_in_free_flight(size: Size) -> HardScene {
    let n = size.pick(14, 50);
    let low = sheet([n, n], [0.2; 2], |x, z| Vec3::new(x, 0.0, z));
    let high = sheet([n, n], [0.2; 2], |x, z| {
        Vec3::new(x + 0.07, 0.05 + 0.2 * x, z - 0.06 + 0.1 * x)
    });
    let objects = vec![object("low", low, vec![]), object("high", high, vec![])];
    let mut scene = base(0.3, objects);
    scene.gravity = Vec3::zeros();
    scene.damping = Damping::default();
    scene.method.substeps = Some(size.pick(20, 72));
    HardScene {
        velocities: vec![Vec3::new(0.0, 2.0, 0.0), Vec3::new(0.5, -2.0, 0.3)],
        most_rise: 1e-3,
        ..of("two in free flight", scene, 0.0, |end| {
            // They have met: at the start they close at 4 m/s.
            let first = end.meshes[0].positions.len();
            let mean = |all: &[Vec3]| all.iter().map(|v| v.y).sum::<f64>() / all.len() as f64;
            let (low, high) = end.run.state.velocities.split_at(first);
            mean(low) - mean(high) < 2.0
        })
    }
}
