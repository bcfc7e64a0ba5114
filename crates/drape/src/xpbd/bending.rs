//! Bending: an explicit force where that is stable, constraints otherwise.
//!
//! The energy is x . K x / 2 with a constant K that is the same for x, y and z. As a force it costs
//! one row of K a vertex, but it is stable only for h w_max < 2, w_max^2 being the largest eigenvalue of
//! W K. For larger substeps the force is filtered by a few more products with K ([`Filter`]). Where that takes too
//! many products, and where constraints are iterated, the curvatures kappa = B x of each triangle are constraints
//! with compliance (A D)^-1: the 3x3 system B W B^T + (A D)^-1 / h^2 is constant, one for x, y and z, and is
//! inverted before the run (Macklin, Müller and Chentanez 2016, equation 18, for the block).

use super::membrane::inverse_mass;
use crate::lane_arithmetic::{F32s, Triple};
use crate::lanes::{
    Corner, LANES, Point, Row, gather, lane_group_of, lane_groups, scatter, set_lane_group_of,
};
use crate::laws::bending::BendingMatrix;
use crate::{Material, System};
use nalgebra::Matrix3;
use pulp::Simd;

/// The bending matrix K by rows over the slots of the vertices, without its diagonal. Sixteen rows make a block, with
/// as many entries each as the longest of them (ELLPACK format).
#[derive(Clone, Debug, Default)]
pub struct BendingForce {
    /// First entry of each block, and the end.
    start: Vec<u32>,
    /// Slots of the columns.
    columns: Vec<Corner>,
    /// Entries of K (N/m).
    values: Vec<Row>,
    /// Upper bound of w_max (rad/s).
    pub frequency: f64,
    /// Number of entries that are not zero.
    pub count: usize,
}

impl BendingForce {
    /// The matrix of a model; `vertex_of` is the vertex in each slot, `slot_of` the slot of each vertex.
    pub fn new(system: &System, vertex_of: &[Option<u32>], slot_of: &[u32]) -> Self {
        let mut force = Self {
            start: vec![0],
            ..Self::default()
        };
        let mut largest = 0f64;
        for (block, vertices) in vertex_of.chunks(LANES).enumerate() {
            let first = force.columns.len();
            for (lane, vertex) in vertices.iter().enumerate() {
                let Some(v) = vertex.filter(|&v| !system.prescribed.pinned[v as usize]) else {
                    continue;
                };
                let (columns, values) = system.rest.bending.row_entries(v as usize);
                let sum: f64 = values.iter().map(|value| value.abs()).sum();
                // Gershgorin's bound of the eigenvalues of W K.
                largest = largest.max(sum * inverse_mass(system, v));
                let others = columns.iter().zip(values);
                for (at, (&column, &value)) in others
                    .filter(|&(&column, &value)| column != v && value != 0.0)
                    .enumerate()
                {
                    if first + at == force.columns.len() {
                        // An unused lane has a zero entry in its own column.
                        let own = |lane: usize| (block * LANES + lane) as u32;
                        force.columns.push(Corner(std::array::from_fn(own)));
                        force.values.push(Row::splat(0.0));
                    }
                    force.columns[first + at].0[lane] = slot_of[column as usize];
                    force.values[first + at].0[lane] = value as f32;
                    force.count += 1;
                }
            }
            force.start.push(force.columns.len() as u32);
        }
        force.frequency = largest.sqrt();
        force
    }

    /// The product K x for the rows of one lane group from `slot` on, a multiple of sixteen (N): summed over
    /// differences from `here`, the positions of the rows themselves, since the rows of K sum to zero.
    #[inline(always)]
    pub fn times<S: Simd>(
        &self,
        simd: S,
        slot: usize,
        points: &[Point],
        here: Triple<F32s<S>>,
        lane_group: usize,
    ) -> Triple<F32s<S>> {
        let mut sum = Triple::repeat(F32s::splat(simd, 0.0));
        let block = slot / LANES;
        let entries = self.start[block] as usize..self.start[block + 1] as usize;
        for (column, value) in self.columns[entries.clone()]
            .iter()
            .zip(&self.values[entries])
        {
            let (there, _) = gather(simd, points, column, lane_group);
            sum = sum.add_scaled(there - here, value.lane_group(simd, lane_group));
        }
        sum
    }
}

/// A polynomial filter of the bending force where the force alone is not stable: the displacement of a substep is
/// -q(h^2 W K) x instead of -h^2 W K x, with q(z) = c (1 - T_s(w0 - w1 z / c) / T_s(w0)), q'(0) = 1, in s stages.
/// Slow modes have their own stiffness, fast ones at most the largest stable one; equilibria are unchanged and
/// momentum is conserved. The recursion is that of Runge-Kutta-Chebyshev methods (van der Houwen and Sommeijer
/// 1980).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Filter {
    /// Coefficients mu, nu, kappa of each stage: d = mu d - nu d_before - kappa h^2 W K (x + d).
    pub stages: Vec<[f32; 3]>,
    /// The factor c of the last d.
    pub factor: f32,
}

/// The lead theta: the bending force is evaluated at positions extrapolated by theta h, which damps bending as a
/// viscosity in proportion to stiffness with time constant theta h. Without it bending is undamped, and the
/// unconverged membrane sweeps feed it energy until the cloth vibrates permanently. Stable for q (1 + 2 theta) < 4.
pub const LEAD: f64 = 0.4;

/// The bounds of a filter. They keep the sum of all that acts on one mode stable: with a viscous q_v it is
/// q (1 + 2 theta) + 2 q_v < 4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterBounds {
    /// The factor c, half of the largest q.
    factor: f64,
    /// Largest z = h^2 w^2, or h w of a rate, at which nothing is filtered: then q = z.
    unfiltered: f64,
    /// Most stages.
    stages: usize,
}

impl FilterBounds {
    /// Bending without viscosity: q (1 + 2 theta) is up to 3.6.
    pub const ELASTIC: Self = Self {
        factor: 1.0,
        unfiltered: 1.4 * 1.4,
        stages: MAX_STAGES,
    };
    /// Bending of viscous cloth: up to 1.8.
    pub const BESIDE_VISCOSITY: Self = Self {
        factor: 0.5,
        unfiltered: 1.0,
        stages: MAX_STAGES,
    };
    /// Viscosity: 2 q_v is up to 1.6. It has no constraints beside it that would be cheaper, and with twice the stages a
    /// substep costs about ten times as much.
    pub const VISCOUS: Self = Self {
        factor: 0.4,
        unfiltered: 0.8,
        stages: 2 * MAX_STAGES,
    };
}

/// Damping of the Chebyshev polynomial: w0 - 1 times s^2. It makes q positive at its minima.
const FILTER_DAMPING: f64 = 0.1;
/// Most stages of elastic bending; with more, constraints are cheaper.
const MAX_STAGES: usize = 16;

impl Filter {
    /// The filter of fewest stages that is stable at `largest` = (h w_max)^2, or h w_max of a rate; none where more
    /// than there may be are needed.
    pub fn new(largest: f64, bounds: FilterBounds) -> Option<Self> {
        if largest <= bounds.unfiltered {
            return Some(Self::default());
        }
        (2..=bounds.stages).find_map(|count| Self::of_stages(count, largest, bounds.factor))
    }

    fn of_stages(count: usize, largest: f64, height: f64) -> Option<Self> {
        let w0 = 1.0 + FILTER_DAMPING / (count * count) as f64;
        // T_j and its derivative at w0.
        let (mut t, mut slope) = (vec![1.0, w0], vec![0.0, 1.0]);
        for j in 1..count {
            t.push(2.0 * w0 * t[j] - t[j - 1]);
            slope.push(2.0 * t[j] + 2.0 * w0 * slope[j] - slope[j - 1]);
        }
        let w1 = t[count] / slope[count];
        if largest > height * (1.0 + w0) / w1 {
            return None;
        }
        let pace = w1 / height;
        let mut stages = vec![[0.0, 0.0, (pace / w0) as f32]];
        for j in 1..count {
            // Before the first stage the displacement is zero.
            let before = if j == 1 { 0.0 } else { t[j - 1] };
            let numbers = [2.0 * w0 * t[j], before, 2.0 * pace * t[j]];
            stages.push(numbers.map(|x| (x / t[j + 1]) as f32));
        }
        Some(Self {
            stages,
            factor: height as f32,
        })
    }
}

/// The curvatures of a triangle along the principal directions of its stiffness, or of its viscosity.
#[derive(Clone, Debug)]
pub struct Stencil {
    /// The triangle.
    pub triangle: u32,
    /// Vertices of the stencil.
    pub vertices: Vec<u32>,
    /// Weights of each in the three curvatures (1/m2).
    pub weights: Vec<[f64; 3]>,
    /// Stiffnesses A D (N m3), or A times the viscosities (N m3 s).
    pub stiffness: [f64; 3],
}

/// Least bending stiffness of a direction over the largest one: compliances must be finite.
const MIN_STIFFNESS_RATIO: f64 = 1e-6;

/// The curvature stencils of the triangles of a model whose `matrix` of bending is not zero.
pub fn stencils(system: &System, matrix: fn(&Material) -> BendingMatrix) -> Vec<Stencil> {
    let curvatures = system.rest.curvatures.iter();
    let all = match system.topology.bending {
        Some(_) => curvatures.map(|stencil| (**stencil).clone()).collect(),
        None => system.topology.stencils(&system.rest.shapes()),
    };
    let laws: Vec<_> = system.materials.list.iter().map(matrix).collect();
    let mut stencils = Vec::with_capacity(system.topology.triangles.len());
    for (t, stencil) in all.into_iter().enumerate() {
        let (weights, stiffness) =
            stencil.principal(laws[system.materials.of_triangle[t] as usize]);
        let largest = stiffness.iter().copied().fold(0.0, f64::max);
        if largest > 0.0 {
            let area = system.rest.elements[t].area;
            stencils.push(Stencil {
                triangle: t as u32,
                vertices: stencil.vertices,
                weights,
                stiffness: stiffness.map(|d| area * d.max(MIN_STIFFNESS_RATIO * largest)),
            });
        }
    }
    stencils
}

/// Up to sixteen stencils of the same size without a shared vertex.
#[derive(Clone, Debug)]
pub struct BendingBatch {
    corners: Vec<Corner>,
    /// Weights of each corner in the three curvatures (1/m2).
    weights: Vec<[Row; 3]>,
    /// Inverse of B W B^T + (A D)^-1 kappa: 11, 22, 33, 12, 13, 23.
    inverse: [Row; 6],
    /// Compliances (A D)^-1 (1/(N m3)).
    compliance: [Row; 3],
    /// B W B^T of each lane, and its compliances, in double precision.
    exact: Vec<(Matrix3<f64>, [f64; 3])>,
}

/// XPBD multipliers of a batch over the substep: of three curvatures, for x, y and z each.
pub type Multipliers = [[Row; 3]; 3];

impl BendingBatch {
    /// A batch of up to sixteen stencils; `local` as for membranes.
    pub fn new(system: &System, members: &[&Stencil], local: impl Fn(u32) -> u32) -> Self {
        let size = members.first().map_or(0, |s| s.vertices.len());
        let mut batch = Self {
            corners: vec![Corner([0; LANES]); size],
            weights: vec![[Row::splat(0.0); 3]; size],
            inverse: [Row::splat(0.0); 6],
            compliance: [Row::splat(0.0); 3],
            exact: Vec::with_capacity(members.len()),
        };
        for (lane, stencil) in members.iter().enumerate() {
            let mut matrix = Matrix3::zeros();
            for (k, (&v, weights)) in stencil.vertices.iter().zip(&stencil.weights).enumerate() {
                batch.corners[k].0[lane] = local(v);
                let b = nalgebra::Vector3::from(*weights);
                matrix += b * b.transpose() * inverse_mass(system, v);
                for row in 0..3 {
                    batch.weights[k][row].0[lane] = weights[row] as f32;
                }
            }
            let compliance = stencil.stiffness.map(|d| 1.0 / d);
            for row in 0..3 {
                batch.compliance[row].0[lane] = compliance[row] as f32;
            }
            batch.exact.push((matrix, compliance));
        }
        batch
    }

    /// Number of stencils.
    pub fn len(&self) -> usize {
        self.exact.len()
    }

    /// Inverts the systems for a substep; `kappa` is (1 + drag h) / h^2 (1/s2).
    pub fn set_step(&mut self, kappa: f64) {
        for (lane, (matrix, compliance)) in self.exact.iter().enumerate() {
            let mut matrix = *matrix;
            for k in 0..3 {
                matrix[(k, k)] += compliance[k] * kappa;
            }
            let inverse = matrix.try_inverse().unwrap_or_else(Matrix3::zeros);
            for (row, (i, j)) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
                .into_iter()
                .enumerate()
            {
                self.inverse[row].0[lane] = inverse[(i, j)] as f32;
            }
        }
    }
}

/// Solves every batch once, in order; arguments as for membranes.
#[inline(always)]
pub fn solve<S: Simd>(
    simd: S,
    batches: &[BendingBatch],
    mut multipliers: Option<&mut [Multipliers]>,
    kappa: f32,
    points: &mut [Point],
) {
    for (at, batch) in batches.iter().enumerate() {
        for lane_group in 0..lane_groups::<S>() {
            let multipliers = multipliers.as_mut().map(|multipliers| &mut multipliers[at]);
            solve_lane_group(simd, batch, lane_group, multipliers, kappa, points);
        }
    }
}

#[inline(always)]
fn solve_lane_group<S: Simd>(
    simd: S,
    batch: &BendingBatch,
    lane_group: usize,
    mut multipliers: Option<&mut Multipliers>,
    kappa: f32,
    points: &mut [Point],
) {
    let Some(first) = batch.corners.first() else {
        return;
    };
    let zero = F32s::splat(simd, 0.0);
    let mut curvature = [Triple::repeat(zero); 3];
    let (origin, _) = gather(simd, points, first, lane_group);
    for (corner, weights) in batch.corners.iter().zip(&batch.weights).skip(1) {
        let (point, _) = gather(simd, points, corner, lane_group);
        let d = point - origin;
        for k in 0..3 {
            curvature[k] = curvature[k].add_scaled(d, weights[k].lane_group(simd, lane_group));
        }
    }
    if let Some(multipliers) = &multipliers {
        for k in 0..3 {
            let soft = batch.compliance[k].lane_group(simd, lane_group) * kappa;
            let sum = Triple(lane_group_of(simd, &multipliers[k], lane_group));
            curvature[k] = curvature[k].add_scaled(sum, soft);
        }
    }
    let [t11, t22, t33, t12, t13, t23] = lane_group_of(simd, &batch.inverse, lane_group);
    let change = [
        mixed(&curvature, [t11, t12, t13]),
        mixed(&curvature, [t12, t22, t23]),
        mixed(&curvature, [t13, t23, t33]),
    ];
    if let Some(multipliers) = &mut multipliers {
        for k in 0..3 {
            let sum = Triple(lane_group_of(simd, &multipliers[k], lane_group));
            set_lane_group_of(&mut multipliers[k], lane_group, sum - change[k]);
        }
    }
    for (corner, weights) in batch.corners.iter().zip(&batch.weights) {
        let (mut point, w) = gather(simd, points, corner, lane_group);
        let share = zero - w;
        for k in 0..3 {
            let weight = share * weights[k].lane_group(simd, lane_group);
            point = point.add_scaled(change[k], weight);
        }
        scatter(points, corner, lane_group, (point, w));
    }
}

/// The weighted sum of three vectors.
#[inline(always)]
fn mixed<S: Simd>(vectors: &[Triple<F32s<S>>; 3], weights: [F32s<S>; 3]) -> Triple<F32s<S>> {
    let zero = F32s::splat(weights[0].simd, 0.0);
    Triple::repeat(zero)
        .add_scaled(vectors[0], weights[0])
        .add_scaled(vectors[1], weights[1])
        .add_scaled(vectors[2], weights[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The polynomial q of the filter for h w_max = `limit`.
    fn filtered(limit: f64) -> impl Fn(f64) -> f64 {
        let filter = Filter::new(limit * limit, FilterBounds::ELASTIC);
        let filter = filter.expect("within the stages there are");
        move |z: f64| {
            let (mut before, mut d) = (0.0, 0.0);
            for [mu, nu, kappa] in filter.stages.iter().map(|n| n.map(f64::from)) {
                (before, d) = (d, mu * d - nu * before - kappa * z * (1.0 + d));
            }
            -d * f64::from(filter.factor)
        }
    }

    #[test]
    fn bending_vibrations_decay_at_any_stiffness() {
        // v = v - q (x + theta v), x = x + v, with h = 1: the larger of the two roots.
        let check_decay = |q: f64| {
            let (trace, product) = (2.0 - q - q * LEAD, 1.0 - q * LEAD);
            let inner = 0.25 * trace * trace - product;
            let root = match inner < 0.0 {
                true => product.sqrt(),
                false => 0.5 * trace.abs() + inner.sqrt(),
            };
            assert!(root < 1.0 - 0.15 * q.min(1.0), "q {q}: {root}");
        };
        for k in 1..=1000 {
            let z = 1e-3 * f64::from(k);
            check_decay(FilterBounds::ELASTIC.unfiltered * z);
            for limit in [1.6, 5.0, 20.0] {
                check_decay(filtered(limit)(limit * limit * z));
            }
        }
    }

    #[test]
    fn a_filter_preserves_slow_modes_and_bounds_fast_ones() {
        for limit in [1.6, 2.8, 5.0, 12.0, 20.0] {
            let q = filtered(limit);
            assert!((q(1e-4) / 1e-4 - 1.0).abs() < 1e-3, "{limit}");
            for k in 1..=1000 {
                let z = limit * limit * f64::from(k) / 1000.0;
                assert!(q(z) > 0.0 && q(z) < 2.5, "{limit}: {z} {}", q(z));
            }
        }
        let plain = Filter::new(1.0, FilterBounds::ELASTIC);
        assert!(plain.expect("plain").is_identity());
        assert_eq!(Filter::new(1e6, FilterBounds::ELASTIC), None);
    }
}
