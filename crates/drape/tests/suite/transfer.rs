//! Edits of a world between steps: what they touch is merged, opened or moved over as it should be, and what they
//! do not touch goes on with the same numbers.

use crate::support::numbers::Numbers;
use crate::support::sheets::{object, sheet};
use crate::support::solids;
use std::collections::BTreeMap;
use toile_drape::{
    AttachmentEnd, Cloth, ContactSettings, Material, MeshVertex, MethodKind, MethodSettings,
    Object, ObjectAttachment, ObjectId, ObjectKind, Scene, SceneObject, SceneRun, SolidFriction,
    WorldEdit,
};
use toile_geometry::Vec3;

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
        if !state.cloth.positions.is_empty() {
            write(&state.cloth.positions[v as usize]);
        }
    }
    let number: BTreeMap<u32, usize> = own.iter().copied().zip(0..).collect();
    for (index, sample) in state.samples.iter().enumerate() {
        if sample.vertices.iter().all(|v| number.contains_key(v)) {
            let of_sample = |one: &&SolidFriction| one.sample as usize == index;
            for friction in state.solid_friction.iter().filter(of_sample) {
                write(&friction.anchor);
                write(&Vec3::x().scale(friction.force));
            }
            write(&Vec3::new(
                sample.area,
                sample.extra_offset,
                sample.friction,
            ));
        }
    }
    for contact in &state.cloth.friction {
        let vertices = contact.pair.vertices();
        if vertices.iter().all(|v| number.contains_key(v)) {
            for v in vertices {
                write(&Vec3::x().scale(number[&v] as f64));
            }
            write(&contact.slip);
        }
    }
    bits
}

/// Momentum (kg m/s), the sum of the sizes of its shares, and kinetic energy (J).
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
        let mut run = SceneRun::new(&scene(seed), MethodSettings::build).unwrap();
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
        let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
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
