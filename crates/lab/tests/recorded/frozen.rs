//! What a frozen state is recorded by.

use crate::numbers::Numbers;
use crate::record::Record;
use crate::states::{self, Frozen};
use toile_drape::collision::{
    ContactDetector, ContactSet, Reach, edge_edge_impact, vertex_face_impact,
};
use toile_drape::laws::membrane::Curvature;
use toile_drape::{Expansion, MethodKind, MethodSettings, Workspace};
use toile_geometry::{SurfaceTree, Vec3};

/// Vectors that the Hessian is multiplied with.
const VECTORS: usize = 20;
/// Pairs of features whose impact is timed, and how far they move (m).
const IMPACTS: usize = 200;
const MOVE: f64 = 5e-3;

pub fn note(record: &mut Record) {
    let states: [(&str, Frozen); 6] = [
        ("sheet", states::stirred("hang", 1e-3)),
        ("ball", states::on_the_ball()),
        ("worn shirt", states::stirred("shirt", 2e-4)),
        ("three layers", states::three_layers()),
        ("fold", states::fold()),
        ("tangle", states::tangle()),
    ];
    for (name, frozen) in &states {
        note_potential(record, name, frozen);
        note_impacts(record, name, frozen);
        note_moves(record, name, frozen);
    }
    for (name, frozen) in &states::laws() {
        note_potential(record, name, frozen);
        note_step(record, name, frozen);
    }
}

fn note_potential(record: &mut Record, name: &str, (system, state): &Frozen) {
    let mut numbers = Numbers(42);
    let vector = |_| {
        state
            .positions
            .iter()
            .map(|_| numbers.vector(1.0))
            .collect()
    };
    let vectors: Vec<Vec<Vec3>> = (0..VECTORS).map(vector).collect();
    for (kind, curvature) in [("convex", Curvature::CONVEX), ("exact", Curvature::EXACT)] {
        let of = |what: &str| format!("{name}, {kind}, {what}");
        let expansion: Expansion = Workspace::default().expand(system, state, curvature, &vectors);
        for (k, product) in expansion.products.iter().enumerate() {
            record.vectors(&of(&format!("Hessian times vector {k}")), product);
        }
        if curvature == Curvature::EXACT {
            continue;
        }
        record.numbers(&of("energy"), &[expansion.energy]);
        record.vectors(&of("gradient"), &expansion.gradient);
        let surface = expansion.surface.iter().flat_map(|contact| {
            let (plane, law) = (&contact.plane, &contact.law);
            let n = plane.normal;
            [
                f64::from(contact.sample),
                plane.depth,
                n.x,
                n.y,
                n.z,
                law.normal,
                law.friction,
            ]
        });
        record.list(&of("contacts with a surface"), surface);
        let cloth = expansion.cloth.iter().flat_map(|contact| {
            let vertices = contact.vertices.map(f64::from);
            let rest = [
                contact.plane.depth,
                contact.law.normal,
                contact.law.friction,
            ];
            vertices.into_iter().chain(contact.weights).chain(rest)
        });
        record.list(&of("contacts with cloth"), cloth);
        let tree = SurfaceTree::new(system.mesh(&state.positions));
        record.numbers(&of("crossings"), &[tree.self_intersections().len() as f64]);
    }
}

/// When features of the state that are brought near one another meet.
fn note_impacts(record: &mut Record, name: &str, (system, state): &Frozen) {
    let mut numbers = Numbers(3);
    let mut any = |below: usize| (numbers.next() * below as f64) as usize;
    let mut times = Vec::new();
    for _ in 0..IMPACTS {
        let [vertex, first, second] = [
            state.positions.len(),
            system.topology.triangles.len(),
            system.topology.triangles.len(),
        ]
        .map(&mut any);
        let corners = |t: usize| system.topology.triangles[t].map(|v| state.positions[v as usize]);
        let (a, b) = (corners(first), corners(second));
        let middle = |t: [Vec3; 3]| (t[0] + t[1] + t[2]) / 3.0;
        // The face is put beside the vertex, the edge beside the other edge.
        let beside = state.positions[vertex] - middle(a) + Vec3::repeat(0.4 * MOVE);
        let face = [
            state.positions[vertex],
            a[0] + beside,
            a[1] + beside,
            a[2] + beside,
        ];
        let across = (a[0] + a[1] - b[0] - b[1]) / 2.0 + Vec3::repeat(0.3 * MOVE);
        let edges = [a[0], a[1], b[0] + across, b[1] + across];
        let mut moves = Numbers(vertex as u64 + 1);
        let mut moved = |places: [Vec3; 4]| places.map(|p| p + moves.vector(MOVE));
        let (face_end, edges_end) = (moved(face), moved(edges));
        let never = 2.0;
        times.push(vertex_face_impact(&face, &face_end, 1e-5).unwrap_or(never));
        times.push(edge_edge_impact(&edges, &edges_end, 1e-5).unwrap_or(never));
    }
    record.list(&format!("{name}, impact times"), times);
}

/// How far cloth may move of a motion that would cross itself.
fn note_moves(record: &mut Record, name: &str, (system, state): &Frozen) {
    if system.contact.cloth_offset <= 0.0 {
        return;
    }
    let (mut detector, mut contacts) = (ContactDetector::default(), ContactSet::default());
    let reach = Reach::uniform(2.0 * system.contact.cloth_offset);
    let (memory, x) = (&state.cloth, &state.positions);
    detector.detect(system, memory, x, &reach, &mut contacts);
    let mut numbers = Numbers(5);
    let moves = state.positions.iter().map(|_| numbers.vector(MOVE));
    let mut moves: Vec<Vec3> = moves.collect();
    let held = detector.truncate_moves(system, &contacts.exemptions, x, &mut moves);
    record.numbers(&format!("{name}, vertices held back"), &[held as f64]);
    record.vectors(&format!("{name}, truncated moves"), &moves);
}

/// One step by implicit Euler: what depends on the motion, too.
fn note_step(record: &mut Record, name: &str, (system, state): &Frozen) {
    let mut state = state.clone();
    let mut method = MethodSettings::from(MethodKind::ImplicitEuler)
        .build()
        .unwrap();
    method.advance(system, &mut state, 1.0 / 120.0).unwrap();
    record.vectors(&format!("{name}, places after a step"), &state.positions);
    let settled = state
        .internal_strain
        .iter()
        .flat_map(|kept| kept.stretch.into_iter().chain(kept.curvature));
    record.list(&format!("{name}, strain that was kept"), settled);
}
