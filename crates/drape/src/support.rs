//! What carries the cloth: for each part of it that hangs together, its distance from the solids and the share of its
//! weight that nothing carries.

use crate::tie::Tie;
use crate::{PlacedSolid, State, System, Workspace};
use rayon::prelude::*;
use toile_geometry::{TriangleMesh, Vec3};

/// How a part of the cloth, connected by triangles, is carried.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// Its vertices, ascending.
    pub vertices: Vec<u32>,
    /// Distance of its nearest vertex from a solid (m); infinite without solids.
    pub clearance: f64,
    /// Heights of its lowest and its highest vertex (m).
    pub heights: [f64; 2],
    /// Net force against gravity over its weight: 1 in free fall, 0 at rest or without gravity.
    pub uncarried: f64,
    /// Whether a vertex of it is pinned, led or attached.
    pub is_held: bool,
}

/// Share of the weight of a falling part that contact carries at most.
const CARRIED_IN_FALL: f64 = 0.3;

impl Support {
    /// Whether hardly anything carries it, and nothing holds it.
    pub fn falls(&self) -> bool {
        !self.is_held && (self.uncarried - 1.0).abs() < CARRIED_IN_FALL
    }

    /// Whether it left the solids: it falls without touching one from within `reach` (m), or all of it is below `floor`
    /// (m).
    pub fn has_left(&self, reach: f64, floor: f64) -> bool {
        !self.is_held
            && (self.heights[1] < floor || (self.clearance > reach && self.uncarried > 0.5))
    }
}

/// How each part of the cloth is carried, in the order of their first vertices.
pub fn supports(system: &System, state: &State, workspace: &mut Workspace) -> Vec<Support> {
    let mesh = system.mesh(&state.positions);
    let held = held_vertices(system);
    let net = workspace.net_force(system, state);
    let gravity = system.control.gravity;
    let down = gravity.try_normalize(0.0);
    let solids = system.colliders.iter().map(|solid| solid.at(state.time));
    let solids: Vec<PlacedSolid> = solids.collect();
    let distance = |v: &u32| {
        let point = state.positions[*v as usize];
        let each = solids.iter().map(|solid| solid.exact_distance(point));
        each.fold(f64::INFINITY, f64::min)
    };
    let part = |vertices: Vec<u32>| {
        let weight: f64 = vertices
            .iter()
            .map(|&v| system.rest.mass[v as usize] * gravity.norm())
            .sum();
        let force: Vec3 = vertices.iter().map(|&v| net[v as usize]).sum();
        let heights = vertices
            .iter()
            .map(|&v| state.positions[v as usize].y)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| {
                [low.min(y), high.max(y)]
            });
        Support {
            clearance: vertices
                .par_iter()
                .map(distance)
                .reduce(|| f64::INFINITY, f64::min),
            heights,
            uncarried: down.map_or(0.0, |down| force.dot(&down) / weight),
            is_held: vertices.iter().any(|&v| held[v as usize]),
            vertices,
        }
    };
    components(&mesh).into_iter().map(part).collect()
}

/// Marks of the vertices that are pinned, led or attached to a point.
fn held_vertices(system: &System) -> Vec<bool> {
    let mut held = system.prescribed.pinned.clone();
    let attached = system.control.attachments.all().iter().map(|a| a.vertex);
    let led = system.control.frames.iter().map(|frame| frame.vertex);
    let tied = system.control.ties.iter().flat_map(Tie::vertices);
    for vertex in attached.chain(led).chain(tied) {
        held[vertex as usize] = true;
    }
    held
}

/// The vertices of each part of a mesh that hangs together, ascending.
fn components(mesh: &TriangleMesh) -> Vec<Vec<u32>> {
    let labels = mesh.component_labels();
    let count = labels
        .iter()
        .flatten()
        .max()
        .map_or(0, |&most| most as usize + 1);
    let mut parts = vec![Vec::new(); count];
    for (v, label) in labels.iter().enumerate() {
        if let Some(label) = label {
            parts[*label as usize].push(v as u32);
        }
    }
    parts
}
