//! What is measured on a drape: residual, strain, seam gaps, penetration, crossings.

use crate::{Model, State, Workspace};
use rayon::prelude::*;
use toile_geometry::{SurfaceTree, Vec3};

/// Measures of one state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measures {
    /// Norm of the net forces over the norm of the weights, over free vertices; contact and
    /// friction inside its cone are part of the net force.
    pub residual: f64,
    /// Kinetic energy [J].
    pub kinetic_energy: f64,
    /// Largest stretch along warp and weft.
    pub strain_max: [f64; 2],
    /// Stretch along warp and weft that 99 % of the cloth's area stays under.
    pub strain_p99: [f64; 2],
    /// Largest shortening along warp and weft, as a positive number.
    pub compression_max: [f64; 2],
    /// Largest shear angle [rad].
    pub shear_max: f64,
    /// Deepest vertex below a solid surface [m].
    pub penetration_max: f64,
    /// Pairs of a cloth triangle and a solid triangle that intersect, exactly.
    pub body_intersections: usize,
    /// Pairs of cloth triangles that intersect and share no vertex, exactly.
    pub self_intersections: usize,
}

/// Net force over weight, both as norms over all free vertices.
pub fn residual(model: &Model, state: &State, workspace: &mut Workspace) -> f64 {
    let net = workspace.net_force(model, state);
    let force: f64 = net.iter().map(Vec3::norm_squared).sum();
    force.sqrt() / weight_norm(model)
}

/// Norm of the weights of the free vertices [N]; without gravity their weight on earth.
pub(crate) fn weight_norm(model: &Model) -> f64 {
    let free = model
        .mass
        .iter()
        .zip(&model.pinned)
        .filter(|&(_, &pinned)| !pinned);
    let mass: f64 = free.map(|(m, _)| m * m).sum();
    // Without gravity the weight on earth is the scale.
    let gravity = if model.gravity.norm() > 0.0 {
        model.gravity.norm()
    } else {
        9.81
    };
    mass.sqrt() * gravity
}

/// Measures a state. `counted` says which triangles count for strain (those away from gathers).
pub fn measure(
    model: &Model,
    state: &State,
    workspace: &mut Workspace,
    counted: &[bool],
) -> Measures {
    let x = &state.positions;
    let strains: Vec<_> = (0..model.triangles.len())
        .into_par_iter()
        .map(|t| model.elements[t].strain(model.triangles[t].map(|v| x[v as usize])))
        .collect();
    let mut measures = Measures {
        residual: residual(model, state, workspace),
        kinetic_energy: state.kinetic_energy(model),
        ..Measures::default()
    };
    for direction in 0..2 {
        let mut stretch: Vec<(f64, f64)> = Vec::new();
        for (t, strain) in strains.iter().enumerate() {
            let value = if direction == 0 {
                strain.warp
            } else {
                strain.weft
            };
            let squeezed = &mut measures.compression_max[direction];
            *squeezed = squeezed.max(-value);
            if counted.get(t).copied().unwrap_or(true) {
                stretch.push((value.max(0.0), model.elements[t].area));
                measures.shear_max = measures.shear_max.max(strain.shear.abs());
            }
        }
        (
            measures.strain_max[direction],
            measures.strain_p99[direction],
        ) = top_of(&mut stretch);
    }
    let mesh = model.mesh(x);
    for collider in &model.colliders {
        measures.body_intersections += collider.crossings(state.time, &mesh).len();
        let pose = collider.pose(state.time);
        let depths: Vec<f64> = x
            .par_iter()
            .map(|&p| -collider.exact_distance(pose.as_ref(), p))
            .collect();
        measures.penetration_max = depths
            .iter()
            .copied()
            .fold(measures.penetration_max, f64::max);
    }
    measures.self_intersections = SurfaceTree::new(mesh).self_intersections().len();
    measures
}

/// The largest value, and the value that 99 % of the weight stays under.
fn top_of(values: &mut [(f64, f64)]) -> (f64, f64) {
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = values.iter().map(|v| v.1).sum();
    let mut passed = 0.0;
    let mut p99 = 0.0;
    for &(value, weight) in values.iter() {
        passed += weight;
        p99 = value;
        if passed >= 0.99 * total {
            break;
        }
    }
    (values.last().map_or(0.0, |v| v.0), p99)
}

/// Stretch of every triangle: the larger of warp and weft, negative where both are squeezed.
pub fn stretch_per_triangle(model: &Model, positions: &[Vec3]) -> Vec<f64> {
    (0..model.triangles.len())
        .map(|t| {
            let s = model.elements[t].strain(model.triangles[t].map(|v| positions[v as usize]));
            s.warp.max(s.weft)
        })
        .collect()
}
