//! Edits of a world between steps: what they touch is merged, opened or moved over as it should be, and what they
//! do not touch goes on with the same numbers.

#![allow(clippy::unwrap_used)]

#[path = "support/numbers.rs"]
mod numbers;
#[path = "support/sheets.rs"]
mod sheets;
#[path = "support/solids.rs"]
mod solids;

use numbers::Numbers;
use sheets::{object, sheet};
use std::collections::BTreeMap;
use toile_drape::{
    AttachmentEnd, Cloth, ContactSettings, Kind, Layers, Material, MeshVertex, MethodKind, Motion,
    MotionKey, Object, ObjectAttachment, ObjectId, ObjectKind, PairPolicy, Scene, SceneObject,
    SceneRun, WorldEdit,
};
use toile_geometry::{Vec2, Vec3};

fn standing(name: &str, mesh: toile_geometry::TriangleMesh) -> SceneObject {
    SceneObject {
        kind: ObjectKind::Static,
        ..object(name, mesh, vec![])
    }
}

/// Three sheets over a block, one of them pinned at a corner, one sliding on the block.
fn scene(seed: u64) -> Scene {
    let flat = |x: f64, y: f64| {
        sheet([4, 4], [0.1, 0.1], move |u, v| {
            Vec3::new(x + u, y + 0.2 * u, v - 0.05)
        })
    };
    let objects = vec![
        object("hung", flat(0.0, 0.2), vec![0]),
        standing(
            "block",
            solids::block(Vec3::new(-0.3, -0.1, -0.2), Vec3::new(0.1, 0.0, 0.2)),
        ),
        object("beside", flat(0.105, 0.22), vec![]),
        object(
            "lying",
            sheet([4, 4], [0.1, 0.1], |u, v| {
                Vec3::new(u - 0.25, 0.004, v - 0.05)
            }),
            vec![],
        ),
    ];
    let kind = match seed % 2 {
        0 => MethodKind::Xpbd,
        _ => MethodKind::ImplicitEuler,
    };
    Scene {
        gravity: Vec3::new(1.5, -9.81, 0.0),
        duration: 10.0,
        objects,
        contact: ContactSettings {
            cloth_offset: 1e-3,
            ..ContactSettings::default()
        },
        method: kind.into(),
        ..Scene::default()
    }
}

/// What is remembered of one cloth, as bits: places and velocities of its vertices, anchors and forces of its
/// samples, and friction between its own features.
fn remembered(run: &SceneRun, id: ObjectId) -> Vec<u64> {
    let own = run.map().vertices_of(id).unwrap();
    let state = &run.state;
    let mut bits = Vec::new();
    let mut write = |v: &Vec3| bits.extend(v.iter().map(|x| x.to_bits()));
    for &v in own {
        write(&state.positions[v as usize]);
        write(&state.velocities[v as usize]);
        if !state.cloth.places.is_empty() {
            write(&state.cloth.places[v as usize]);
        }
    }
    let number: BTreeMap<u32, usize> = own.iter().copied().zip(0..).collect();
    for (index, sample) in state.samples.iter().enumerate() {
        if sample.vertices.iter().all(|v| number.contains_key(v)) {
            let none = Vec3::repeat(f64::NAN);
            write(&state.anchors[index].unwrap_or(none));
            write(&Vec3::x().scale(state.normal_forces[index]));
            write(&Vec3::new(
                sample.area,
                sample.extra_offset,
                sample.friction,
            ));
        }
    }
    for held in &state.cloth.held {
        let vertices = held.pair.vertices();
        if vertices.iter().all(|v| number.contains_key(v)) {
            for v in vertices {
                write(&Vec3::x().scale(number[&v] as f64));
            }
            write(&held.slip);
        }
    }
    bits
}

/// Momentum [kg m/s], the sum of the sizes of its shares, and kinetic energy [J].
fn motion(run: &SceneRun) -> (Vec3, f64, f64) {
    let moving = run.state.velocities.iter().zip(&run.system.rest.mass);
    let mut sums = (Vec3::zeros(), 0.0, 0.0);
    for (v, &m) in moving {
        sums.0 += v * m;
        sums.1 += v.norm() * m;
        sums.2 += 0.5 * m * v.norm_squared();
    }
    sums
}

fn cloths(run: &SceneRun) -> Vec<ObjectId> {
    run.map().objects().collect()
}

fn pins(run: &SceneRun) -> Vec<(ObjectId, u32, Vec3)> {
    let held = cloths(run).into_iter().flat_map(|id| {
        let own = run.map().vertices_of(id).unwrap();
        let pins = run.world().object(id).unwrap().pins.clone();
        let place = |pin: u32| run.state.positions[own[pin as usize] as usize];
        pins.into_iter().map(move |pin| (id, pin, place(pin)))
    });
    held.collect()
}

/// A number from `range`.
fn within(random: &mut Numbers, range: std::ops::Range<u32>) -> u32 {
    let share = random.next();
    range.start + (share * f64::from(range.end - range.start)) as u32
}

fn any<T: Copy>(random: &mut Numbers, of: &[T]) -> T {
    of[within(random, 0..of.len() as u32) as usize]
}

/// An edit by chance, and the objects that it touches.
fn edit(random: &mut Numbers, run: &SceneRun, number: usize) -> Option<(WorldEdit, Vec<ObjectId>)> {
    let all = cloths(run);
    let vertex = |random: &mut Numbers, object| MeshVertex {
        object,
        vertex: within(random, 0..25),
    };
    let merged: Vec<[MeshVertex; 2]> = run.world().merged().collect();
    Some(match within(random, 0..9) {
        0..3 => {
            let pairs = (0..within(random, 1..4)).map(|_| {
                let [a, b] = [0, 1].map(|_| any(random, &all));
                [vertex(random, a), vertex(random, b)]
            });
            // A vertex that is merged into its neighbour takes a triangle, its mass and its motion away.
            let across = |pair: &[MeshVertex; 2]| pair[0].object != pair[1].object;
            let pairs: Vec<_> = pairs.filter(across).collect();
            let touched = pairs.iter().flatten().map(|v| v.object).collect();
            (WorldEdit::Merge(pairs), touched)
        }
        3 if !merged.is_empty() => {
            let pair = any(random, &merged);
            (WorldEdit::Open(vec![pair]), pair.map(|v| v.object).to_vec())
        }
        4 => {
            let mesh = sheet([4, 4], [0.1, 0.1], |u, v| {
                Vec3::new(u - 0.1, 0.4 + 0.05 * number as f64, v)
            });
            let cloth = Cloth::from_mesh("new", &mesh, Material::default()).unwrap();
            let name = format!("new {number}");
            let added = Object::deformable(name, cloth);
            (WorldEdit::Add(Box::new(added)), vec![])
        }
        5 if all.len() > 3 => {
            let gone = any(random, &all[3..]);
            let partners = merged
                .iter()
                .filter(|pair| pair.iter().any(|v| v.object == gone));
            let touched = partners.flatten().map(|v| v.object).chain([gone]);
            (WorldEdit::Remove(gone), touched.collect())
        }
        6 => {
            let object = any(random, &all);
            let ends = [
                AttachmentEnd::Vertex(vertex(random, object)),
                AttachmentEnd::Point(Vec3::new(0.0, 0.5, 0.0)),
            ];
            let attachment = ObjectAttachment {
                ends,
                stiffness: 5.0,
                merge_within: None,
            };
            (WorldEdit::Attach(attachment), vec![object])
        }
        7 => {
            let object = any(random, &all);
            let pins = vec![within(random, 0..25)];
            (WorldEdit::Pin(object, pins), vec![object])
        }
        8 => {
            let object = any(random, &all);
            let cloth = run.world().object(object).unwrap().cloth.clone().unwrap();
            let wider = cloth.rest.iter();
            let rest = wider.map(|t| t.map(|p| p * 1.01)).collect();
            (WorldEdit::Reshape(object, rest), vec![object])
        }
        _ => return None,
    })
}

#[test]
fn a_hundred_sequences_of_edits_keep_momentum_pins_and_what_they_do_not_touch() {
    let mut counts = [0usize; 4];
    for seed in 0..100 {
        let mut random = Numbers(seed * 7919 + 1);
        let mut run = SceneRun::new(&scene(seed)).unwrap();
        for number in 0..5 {
            for _ in 0..within(&mut random, 1..4) {
                run.advance().unwrap();
            }
            let Some((edit, touched)) = edit(&mut random, &run, number) else {
                continue;
            };
            let said = format!("seed {seed}, edit {number}: {edit:?}");
            // A vertex that is merged belongs to all the objects it came from.
            let sewn = |ids: &[ObjectId]| ids.iter().any(|id| touched.contains(id));
            let groups = run.world().groups().into_iter().filter(|ids| !sewn(ids));
            let is_cloth = |id: &ObjectId| run.map().vertices_of(*id).is_some();
            let untouched: Vec<ObjectId> = groups.flatten().filter(is_cloth).collect();
            let before: Vec<_> = untouched.iter().map(|&id| remembered(&run, id)).collect();
            let (momentum, size, kinetic) = motion(&run);
            let triangles = run.map().triangles.len();
            let held = pins(&run);
            let merges = matches!(&edit, WorldEdit::Merge(_));
            let merges_held = match &edit {
                WorldEdit::Merge(pairs) => pairs.iter().flatten().any(|v| {
                    let own = |v: &MeshVertex| run.map().vertex(*v).unwrap();
                    run.system.prescribed.pinned[own(v) as usize]
                }),
                _ => false,
            };
            let is_structure = !matches!(&edit, WorldEdit::Attach(_) | WorldEdit::Pin(..));
            let pinned_anew = matches!(&edit, WorldEdit::Pin(..));
            if let Err(error) = run.edit(edit) {
                // Only what is held apart is refused.
                assert!(error.to_string().contains("held apart"), "{said}: {error}");
                continue;
            }
            counts[0] += 1;
            counts[1] += usize::from(is_structure);
            for (id, before) in untouched.iter().zip(before) {
                assert!(remembered(&run, *id) == before, "{said}: {id:?} changed");
                counts[2] += 1;
            }
            let (after, _, kinetic_after) = motion(&run);
            if merges {
                assert!(kinetic_after <= kinetic * (1.0 + 1e-12), "{said}");
                // A triangle whose corners became one is gone with its mass and its motion.
                if !merges_held && run.map().triangles.len() == triangles {
                    let off = (after - momentum).norm();
                    assert!(
                        off <= 1e-12 * size,
                        "{said}: momentum off by {off:e} of {size:e}"
                    );
                    counts[3] += 1;
                }
            }
            if !pinned_anew {
                let now: BTreeMap<_, _> =
                    pins(&run).into_iter().map(|p| ((p.0, p.1), p.2)).collect();
                for (id, pin, place) in held {
                    let is = now.get(&(id, pin));
                    assert!(is.is_none_or(|is| *is == place), "{said}: a pin moved");
                }
            }
        }
        for _ in 0..3 {
            run.advance().unwrap();
        }
        assert!(run.state.first_not_finite().is_none());
    }
    let [edits, structures, untouched, momenta] = counts;
    assert!(
        edits > 300 && structures > 200 && untouched > 500 && momenta > 80,
        "{counts:?}"
    );
}

#[test]
fn a_sheet_at_rest_on_a_slope_stays_where_it_is_when_something_else_is_merged() {
    // A slope of 20 degrees under friction of 0.6 holds a sheet; the ground is level and gravity leans.
    let angle = 20f64.to_radians();
    for kind in [MethodKind::Xpbd, MethodKind::ImplicitEuler] {
        let mut lying = object(
            "lying",
            sheet([6, 6], [0.12; 2], |u, v| Vec3::new(u, 0.0021, v)),
            vec![],
        );
        if let ObjectKind::Deformable { material, .. } = &mut lying.kind {
            material.friction = 0.6;
        }
        let far = |name, x| {
            let mesh = sheet([4, 4], [0.1; 2], |u, v| Vec3::new(x + u, 0.8 + v, 1.0));
            object(name, mesh, vec![20, 24])
        };
        let scene = Scene {
            gravity: Vec3::new(9.81 * angle.sin(), -9.81 * angle.cos(), 0.0),
            damping: toile_drape::Damping {
                mass: 2.0,
                stiffness: 0.0,
            },
            duration: 9.0,
            objects: vec![
                far("left", 0.0),
                standing(
                    "ground",
                    solids::block(Vec3::new(-0.3, -0.1, -0.3), Vec3::new(0.6, 0.0, 0.6)),
                ),
                lying,
                far("right", 0.1),
            ],
            method: kind.into(),
            ..Scene::default()
        };
        let mut run = SceneRun::new(&scene).unwrap();
        let steps = |run: &mut SceneRun, count| {
            for _ in 0..count {
                run.advance().unwrap();
            }
            run.mesh_of(SceneObject::id(2)).unwrap().positions
        };
        let before = steps(&mut run, 120);
        let settled = steps(&mut run, 30);
        let slip = |a: &[Vec3], b: &[Vec3]| {
            let each = a.iter().zip(b).map(|(a, b)| (a - b).norm());
            each.fold(0.0, f64::max)
        };
        assert!(
            slip(&before, &settled) < 1e-4,
            "{kind:?} had not come to rest"
        );
        let seam = (0..5).map(|j| {
            let end = |object, vertex| MeshVertex {
                object: SceneObject::id(object),
                vertex,
            };
            [end(0, 5 * j + 4), end(3, 5 * j)]
        });
        let count = run.state.positions.len();
        run.edit(WorldEdit::Merge(seam.collect())).unwrap();
        assert_eq!(run.state.positions.len(), count - 5);
        let after = steps(&mut run, 60);
        let slid = slip(&settled, &after);
        assert!(slid < 1e-4, "{kind:?}: it slid {slid} m");
    }
}

#[test]
fn objects_that_ignore_each_other_pass_through_each_other_until_they_are_told_to_meet() {
    // A sheet held by its border, one that falls on it, and a block below.
    let border = (0..25)
        .filter(|v| v % 5 % 4 == 0 || v / 5 % 4 == 0)
        .collect();
    let level = |height| sheet([4, 4], [0.1; 2], move |u, v| Vec3::new(u, height, v));
    let low = Vec3::new(-0.1, -0.2, -0.1);
    let scene = Scene {
        objects: vec![
            object("held", level(0.1), border),
            object("falling", level(0.12), vec![]),
            standing("block", solids::block(low, Vec3::new(0.2, 0.0, 0.2))),
        ],
        contact: ContactSettings {
            cloth_offset: 2e-3,
            ..ContactSettings::default()
        },
        duration: 9.0,
        ..Scene::default()
    };
    let [held, falling, block] = [0, 1, 2].map(SceneObject::id);
    for kind in [MethodKind::Xpbd, MethodKind::ImplicitEuler] {
        let lowest = |run: &SceneRun| {
            let places = run.mesh_of(falling).unwrap().positions;
            places.iter().map(|p| p.y).fold(f64::INFINITY, f64::min)
        };
        let mut run = SceneRun::new(&Scene {
            method: kind.into(),
            ..scene.clone()
        })
        .unwrap();
        run.edit(WorldEdit::SetPolicy([falling, held], PairPolicy::Ignore))
            .unwrap();
        assert_eq!(run.world().policy([held, falling]), PairPolicy::Ignore);
        let steps = |run: &mut SceneRun, count| {
            for _ in 0..count {
                run.advance().unwrap();
            }
        };
        steps(&mut run, 48);
        let height = lowest(&run);
        assert!(
            (0.002..0.02).contains(&height),
            "{kind:?}: the block did not stop it: {height}"
        );
        run.edit(WorldEdit::SetPolicy([block, falling], PairPolicy::Ignore))
            .unwrap();
        steps(&mut run, 48);
        let height = lowest(&run);
        assert!(
            height < -0.05,
            "{kind:?}: the block still holds it: {height}"
        );
        let error = run.edit(WorldEdit::Remove(held)).err();
        assert!(error.is_none(), "{error:?}");
        assert!(
            run.edit(WorldEdit::SetPolicy([held, falling], PairPolicy::Meet))
                .is_err()
        );
    }
    // Without a policy the held sheet catches the other one.
    let mut run = SceneRun::new(&scene).unwrap();
    for _ in 0..48 {
        run.advance().unwrap();
    }
    let places = run.mesh_of(falling).unwrap().positions;
    assert!(places.iter().all(|p| p.y > 0.05), "it fell through");
}

/// Moves by 0.3 m within the first second.
fn sideways() -> Motion {
    let key = |time, x| MotionKey {
        time,
        translation: Vec3::x() * x,
        rotation: Vec3::zeros(),
    };
    Motion {
        pivot: Vec3::zeros(),
        keys: vec![key(0.0, 0.0), key(1.0, 0.3)],
    }
}

/// One hung sheet, and a block that moves beside it, run for half a second by `xpbd`.
fn beside_a_moving_block() -> SceneRun {
    let block = solids::block(Vec3::new(0.5, 0.0, -0.1), Vec3::new(0.6, 0.1, 0.1));
    let motion = sideways();
    let moving = SceneObject {
        kind: ObjectKind::Animated { motion },
        ..object("block", block, vec![])
    };
    let mesh = sheet([4, 4], [0.1; 2], |u, v| Vec3::new(u, 0.3 - v, 0.0));
    let scene = Scene {
        objects: vec![object("hung", mesh, vec![0, 4]), moving],
        duration: 9.0,
        step: 1.0 / 60.0,
        method: MethodKind::Xpbd.into(),
        ..Scene::default()
    };
    let mut run = SceneRun::new(&scene).unwrap();
    for _ in 0..30 {
        run.advance().unwrap();
    }
    run
}

#[test]
fn an_object_stays_where_it_is_when_its_kind_changes_and_so_does_what_is_attached_to_it() {
    let mut run = beside_a_moving_block();
    let [hung, block] = [0, 1].map(SceneObject::id);
    let start = run.world().object(block).unwrap().mesh.positions[0];
    let attachment = ObjectAttachment {
        ends: [
            AttachmentEnd::Vertex(MeshVertex {
                object: hung,
                vertex: 24,
            }),
            AttachmentEnd::Frame {
                object: block,
                point: start,
            },
        ],
        stiffness: 1.0,
        merge_within: None,
    };
    run.edit(WorldEdit::Attach(attachment)).unwrap();
    let lies = |run: &SceneRun| run.mesh_of(block).unwrap().positions;
    let near = |a: &[Vec3], b: &[Vec3]| {
        let each = a.iter().zip(b).map(|(a, b)| (a - b).norm());
        each.fold(0.0, f64::max)
    };
    let before = lies(&run);
    assert!((before[0] - start).norm() > 0.1, "the block had not moved");
    let ends_at = |run: &SceneRun| match run.system.control.frames.first() {
        Some(frame) => frame.place(run.state.time),
        None => run.system.control.attachments.all()[0].place,
    };
    assert!((ends_at(&run) - before[0]).norm() < 1e-12);
    for kind in [Kind::Static, Kind::Animated, Kind::Static] {
        run.edit(WorldEdit::ChangeKind(block, kind)).unwrap();
        assert!(near(&lies(&run), &before) < 1e-12, "{kind:?}: it jumped");
        assert!((ends_at(&run) - before[0]).norm() < 1e-12, "{kind:?}");
    }
    // Cloth has no frame; the sheet stays where it is as a solid and as cloth again.
    let said = run
        .edit(WorldEdit::ChangeKind(block, Kind::Deformable))
        .err();
    assert!(said.unwrap().to_string().contains("no frame"));
    let other = Object::deformable(
        "other",
        run.world()
            .object(hung)
            .unwrap()
            .cloth
            .as_deref()
            .unwrap()
            .clone(),
    );
    run.edit(WorldEdit::Add(Box::new(other))).unwrap();
    let places = run.mesh_of(hung).unwrap().positions;
    run.edit(WorldEdit::ChangeKind(hung, Kind::Static)).unwrap();
    run.advance().unwrap();
    assert_eq!(run.mesh_of(hung).unwrap().positions, places);
    run.edit(WorldEdit::ChangeKind(hung, Kind::Deformable))
        .unwrap();
    assert_eq!(run.mesh_of(hung).unwrap().positions, places);
    run.advance().unwrap();
    assert_eq!(
        run.mesh_of(hung).unwrap().positions[4],
        places[4],
        "a pin moved"
    );
}

#[test]
fn edits_that_do_not_fit_are_refused_by_name_and_change_nothing() {
    let mut run = beside_a_moving_block();
    let [hung, block] = [0, 1].map(SceneObject::id);
    let cloth = run
        .world()
        .object(hung)
        .unwrap()
        .cloth
        .as_deref()
        .unwrap()
        .clone();
    let with = |change: &dyn Fn(&mut Cloth)| {
        let mut other = cloth.clone();
        change(&mut other);
        Box::new(Object::deformable("other", other))
    };
    let vertex = |object, vertex| MeshVertex { object, vertex };
    let layers = Object {
        layers: Layers::Each(vec![0; 3]),
        ..*with(&|_| {})
    };
    let mut windy = run.world().environment().clone();
    windy.gravity.x = f64::NAN;
    let mut far = run.world().environment().clone();
    far.contact.offset = 0.5;
    let rest = vec![[Vec2::repeat(f64::NAN); 3]; cloth.triangles.len()];
    let cases: Vec<(WorldEdit, &str)> = vec![
        (WorldEdit::Add(with(&|c| c.rest.truncate(3))), "rest shapes"),
        (
            WorldEdit::Add(with(&|c| c.material.fill(9))),
            "no material 9",
        ),
        (
            WorldEdit::Add(with(&|c| c.panel.fill(u32::MAX))),
            "out of range",
        ),
        (
            WorldEdit::Add(with(&|c| c.positions[3].x = f64::NAN)),
            "other",
        ),
        (
            WorldEdit::Add(with(&|c| c.materials[0].thickness = 0.4)),
            "other",
        ),
        (WorldEdit::Add(Box::new(layers)), "3 layers"),
        (
            WorldEdit::Merge(vec![[vertex(hung, 3), vertex(block, 0)]]),
            "no cloth",
        ),
        (
            WorldEdit::Merge(vec![[vertex(hung, 3), vertex(hung, 99)]]),
            "no vertex 99",
        ),
        (
            WorldEdit::Merge(vec![[vertex(hung, 0), vertex(hung, 4)]]),
            "held apart",
        ),
        (
            WorldEdit::Open(vec![[vertex(hung, 7), vertex(hung, 8)]]),
            "not merged",
        ),
        (WorldEdit::Pin(hung, vec![25]), "no vertex 25"),
        (WorldEdit::Reshape(block, vec![]), "rest shapes"),
        (WorldEdit::Reshape(hung, rest), "triangle"),
        (WorldEdit::SetEnvironment(Box::new(windy)), "gravity"),
        (WorldEdit::SetEnvironment(Box::new(far)), "offset"),
        (WorldEdit::SetMotion(block, Motion::default()), "no key"),
        (WorldEdit::Remove(hung), "no deformable object"),
    ];
    for (edit, word) in cases {
        let before = (run.world().clone(), run.state.clone());
        let name = format!("{edit:?}");
        let said = run.edit(edit).err();
        let said = said.unwrap_or_else(|| panic!("taken: {name}")).to_string();
        assert!(said.contains(word), "{word}: {said}");
        assert!(
            *run.world() == before.0 && run.state == before.1,
            "{word}: changed"
        );
    }
}

#[test]
fn vertices_that_are_one_by_way_of_others_are_opened_together_and_stay_apart() {
    let flat = |x: f64| sheet([2, 2], [0.1; 2], move |u, v| Vec3::new(x + u, 0.0, v));
    let vertex = |object: usize, vertex| MeshVertex {
        object: SceneObject::id(object),
        vertex,
    };
    let [a, b, c] = [vertex(0, 2), vertex(1, 0), vertex(2, 0)];
    let end = |v: MeshVertex, k| toile_drape::SceneEnd::Vertex {
        object: k,
        vertex: v.vertex,
    };
    let elastic = |from, to| toile_drape::SceneElastic {
        from,
        to,
        stiffness: 0.0,
        merge_within: Some(0.02),
    };
    let scene = Scene {
        gravity: Vec3::zeros(),
        objects: vec![
            object("a", flat(0.0), vec![]),
            object("b", flat(0.1), vec![]),
            object("c", flat(0.105), vec![]),
        ],
        elastics: vec![
            elastic(end(a, 0), end(b, 1)),
            elastic(end(b, 1), end(c, 2)),
            elastic(end(a, 0), end(c, 2)),
        ],
        duration: 9.0,
        ..Scene::default()
    };
    let mut run = SceneRun::new(&scene).unwrap();
    run.advance().unwrap();
    let whole = 27;
    assert_eq!(run.state.positions.len(), whole - 2);
    let all: Vec<[MeshVertex; 2]> = run.world().merged().collect();
    if all.len() == 3 {
        let said = run.edit(WorldEdit::Open(vec![all[0]])).err().unwrap();
        assert!(said.to_string().contains("by way of others"), "{said}");
    }
    run.edit(WorldEdit::Open(all)).unwrap();
    assert_eq!(run.state.positions.len(), whole);
    run.advance().unwrap();
    assert_eq!(run.state.positions.len(), whole, "they were merged again");
}
