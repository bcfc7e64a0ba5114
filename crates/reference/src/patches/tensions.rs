//! The membrane of a patch as tensions of its edges.
//!
//! Strain is linear in the squared lengths of edges, so an edge's tension is a sum over the edges
//! of its two triangles, and the force at a vertex a sum over its edges of tension times edge.

use super::edges::Edges;
use super::membrane::EdgeMembrane;
use super::octets::{
    Indices, Operands, PAD, Points, WIDTH, gather, gather_points, lane_group_start, lane_groups,
    load, load_points, padded, store,
};
use super::rows::{Rows, cheapest_min_run, rounding};
use super::stretch::Stretches;
use pulp::Simd;
use std::collections::BTreeMap;
use toile_drape::System;
use toile_drape::lane_arithmetic::{F64s, Triple};

/// The membrane of the triangles of a patch, by its edges.
pub struct Tensions {
    /// First and second end of the edges of each group.
    ends: Vec<[Operands; 2]>,
    /// Squared lengths at rest (m2).
    rest: Vec<f64>,
    /// Strains: squared lengths less those at rest (m2).
    strain: Vec<f64>,
    /// Tensions (N/m).
    tension: Vec<f64>,
    /// The matrix of tensions by strains (N/m3).
    stiffness: Rows,
    /// Weight of strain times tension in the energy: 1/4 where the patch owns the edge, else 0.
    energy_weight: Vec<f64>,
    /// For each ring the groups of edges whose strains, and those whose tensions, the forces at vertices up to
    /// that ring depend on.
    strain_groups: Vec<Vec<u32>>,
    tension_groups: Vec<Vec<u32>>,
    /// First entry of each group of vertices in `runs` and in `others`, and the end.
    start: Vec<[u32; 2]>,
    /// Entries of consecutive numbers: first index of the other ends of edges, and of the edges.
    runs: Vec<[u32; 2]>,
    /// Entries by indices: the other ends of edges, and the edges.
    others: Vec<[Indices; 2]>,
    /// Table of the entries of `ends` that are no run.
    scattered: Vec<Indices>,
    stretches: Stretches,
}

/// The triangles and vertices of a patch, in the patch's numbering of vertices.
pub struct PatchTopology<'a> {
    /// The model.
    pub system: &'a System,
    /// The triangles all of whose corners are in the patch: index in the model, corners in the patch.
    pub triangles: &'a [(usize, [u32; 3])],
    /// The halo ring of each vertex; zero for vertices that the patch owns.
    pub ring: &'a [usize],
    /// The number of each vertex in the model.
    pub vertices: &'a [u32],
}

impl Tensions {
    /// The membrane of a patch.
    pub fn new(patch: &PatchTopology) -> Self {
        let PatchTopology { system, ring, .. } = *patch;
        let edges = Edges::new(patch.triangles.iter().map(|&(_, corners)| corners));
        let slots = edges.ends.len();
        let triangles: Vec<TriangleEdges> = patch
            .triangles
            .iter()
            .map(|t| triangle_edges(system, &edges, t))
            .collect();
        let values = triangles
            .iter()
            .flat_map(|triangle| triangle.membrane.stiffness);
        let largest = values
            .flatten()
            .fold(f64::MIN_POSITIVE, |m, k| m.max(k.abs()));
        let round = rounding(largest);
        let mut rows = vec![BTreeMap::new(); slots];
        let mut rest = padded(slots);
        // For each edge the innermost ring of a vertex of its triangles, and of its own two ends.
        let mut innermost_ring = vec![[usize::MAX; 2]; slots];
        for (triangle, (_, corners)) in triangles.iter().zip(patch.triangles) {
            let innermost = corners.map(|c| ring[c as usize]).into_iter().min();
            for i in 0..3 {
                let at = triangle.sides[i] as usize;
                rest[PAD + at] = triangle.membrane.rest[i];
                innermost_ring[at][0] = innermost_ring[at][0].min(innermost.unwrap_or(0));
                for j in 0..3 {
                    *rows[at].entry(triangle.sides[j]).or_insert(0.0) +=
                        round(triangle.membrane.stiffness[i][j]);
                }
            }
        }
        let mut energy_weight = padded(slots);
        for (number, ends) in edges.iter() {
            let at = number as usize;
            let [a, b] = ends.map(|end| end as usize);
            innermost_ring[at][1] = ring[a].min(ring[b]);
            let first = if patch.vertices[a] < patch.vertices[b] {
                a
            } else {
                b
            };
            energy_weight[PAD + at] = if ring[first] == 0 { 0.25 } else { 0.0 };
        }
        let rows: Vec<Vec<(u32, f64)>> = rows
            .into_iter()
            .map(|row| row.into_iter().collect())
            .collect();
        let rings = ring.iter().max().map_or(1, |most| most + 1);
        let [strain_groups, tension_groups] = [0, 1].map(|which| {
            let of: Vec<usize> = innermost_ring.iter().map(|rings| rings[which]).collect();
            groups_by_ring(&of, rings)
        });
        let mut tensions = Self {
            ends: Vec::new(),
            rest,
            strain: padded(slots),
            tension: padded(slots),
            stiffness: Rows::new(&rows),
            energy_weight,
            strain_groups,
            tension_groups,
            start: vec![[0; 2]],
            runs: Vec::new(),
            others: Vec::new(),
            scattered: Vec::new(),
            stretches: Stretches::new(triangles.iter().zip(patch.triangles).filter_map(
                |(triangle, (_, corners))| {
                    let inside = corners.iter().any(|&c| ring[c as usize] == 0);
                    inside.then_some((triangle.sides, triangle.membrane.shape))
                },
            )),
        };
        tensions.add_ends(&edges);
        tensions.add_vertex_edges(&edges, patch.vertices.len());
        tensions
    }

    fn add_ends(&mut self, edges: &Edges) {
        for group in edges.ends.chunks(WIDTH) {
            self.ends.push([0, 1].map(|end| {
                let mut lanes = [None; WIDTH];
                for (lane, ends) in lanes.iter_mut().zip(group) {
                    *lane = ends.map(|ends| ends[end] + PAD as u32);
                }
                Operands::new(lanes, &mut self.scattered)
            }));
        }
    }

    fn add_vertex_edges(&mut self, edges: &Edges, vertices: usize) {
        let mut around = vec![Vec::new(); vertices];
        for (number, [a, b]) in edges.iter() {
            around[a as usize].push([b, number]);
            around[b as usize].push([a, number]);
        }
        let is_unused = |index: u32| {
            let number = (index as usize).checked_sub(PAD);
            number.is_none_or(|n| edges.ends.get(n).is_none_or(Option::is_none))
        };
        for group in around.chunks(WIDTH) {
            let mut runs: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
            for (lane, edges) in (0u32..).zip(group) {
                for pair in edges {
                    let start = pair.map(|at| at + PAD as u32 - lane);
                    runs.entry(start).or_default().push(lane);
                }
            }
            let min_run = cheapest_min_run(runs.values().map(|lanes| lanes.iter().copied()));
            let mut scattered = [const { Vec::new() }; WIDTH];
            for (&start, lanes) in &runs {
                // The tension of an unused edge number is zero, so that lanes without an edge add nothing.
                let unused = (0..WIDTH as u32)
                    .filter(|lane| !lanes.contains(lane))
                    .all(|lane| is_unused(start[1] + lane));
                if unused && lanes.len() >= min_run {
                    self.runs.push(start);
                } else {
                    for &lane in lanes {
                        scattered[lane as usize].push(start.map(|at| at + lane));
                    }
                }
            }
            for k in 0..scattered.iter().map(Vec::len).max().unwrap_or(0) {
                self.others.push([0, 1].map(|which| {
                    scattered
                        .each_ref()
                        .map(|row| row.get(k).map_or(0, |pair| pair[which]))
                }));
            }
            self.start
                .push([self.runs.len() as u32, self.others.len() as u32]);
        }
    }

    /// Cost of the loads of one evaluation, in loads of a run.
    pub fn cost(&self) -> usize {
        let runs = self.stiffness.cost() + 6 * self.ends.len() + 4 * self.runs.len();
        runs + 2 * WIDTH * self.scattered.len() + 4 * WIDTH * self.others.len()
    }

    /// Sets strains and tensions to zero: values that are not finite must not reach later sums.
    pub fn clear(&mut self) {
        self.strain.fill(0.0);
        self.tension.fill(0.0);
    }

    /// Computes the strains on which the forces at vertices up to a ring depend.
    #[inline(always)]
    pub fn update_strains<S: Simd>(&mut self, simd: S, ring: usize, x: &Points) {
        let x = x.axes();
        for &group in &self.strain_groups[ring] {
            let [a, b] = self.ends[group as usize];
            for lane_group in 0..lane_groups::<S>() {
                let a = a.points(simd, x, &self.scattered, lane_group);
                let b = b.points(simd, x, &self.scattered, lane_group);
                let d = b - a;
                let at = lane_group_start::<S>(group as usize, lane_group);
                let strain = d.dot(d) - load(simd, &self.rest, at);
                store(&mut self.strain, at, strain);
            }
        }
    }

    /// Computes from the strains the tensions on which the forces at vertices up to a ring depend.
    #[inline(always)]
    pub fn update_tensions<S: Simd>(&mut self, simd: S, ring: usize) {
        for &group in &self.tension_groups[ring] {
            for lane_group in 0..lane_groups::<S>() {
                let sum = self
                    .stiffness
                    .product(simd, group as usize, lane_group, &self.strain);
                store(
                    &mut self.tension,
                    lane_group_start::<S>(group as usize, lane_group),
                    sum,
                );
            }
        }
    }

    /// The gradient of the membrane's energy at the vertices of one lane group (N).
    #[inline(always)]
    pub fn gradient<S: Simd>(
        &self,
        simd: S,
        group: usize,
        lane_group: usize,
        x: [&[f64]; 3],
    ) -> Triple<F64s<S>> {
        let mut total = F64s::splat(simd, 0.0);
        let mut sum = Triple::repeat(total);
        let [[runs, others], [end, others_end]] = [self.start[group], self.start[group + 1]];
        let first = lane_group * S::F64_LANES;
        for [other, edge] in &self.runs[runs as usize..end as usize] {
            let t = load(simd, &self.tension, *edge as usize + first);
            let other = load_points(simd, x, *other as usize + first);
            sum = sum.add_scaled(other, t);
            total = total + t;
        }
        for [other, edge] in &self.others[others as usize..others_end as usize] {
            let t = gather(simd, &self.tension, edge, lane_group);
            let other = gather_points(simd, x, other, lane_group);
            sum = sum.add_scaled(other, t);
            total = total + t;
        }
        let at = lane_group_start::<S>(group, lane_group);
        load_points(simd, x, at) * total - sum
    }

    /// Largest and smallest principal squared stretch of the triangles at vertices that the patch owns.
    #[inline(always)]
    pub fn stretch<S: Simd>(&mut self, simd: S, x: &Points) -> [f64; 2] {
        self.update_strains(simd, 0, x);
        self.stretches.extremes(simd, &self.strain)
    }

    /// Energy of the edges that the patch owns (J): those whose vertex of the lower number it owns.
    #[inline(always)]
    pub fn energy<S: Simd>(&mut self, simd: S, x: &Points) -> f64 {
        self.update_strains(simd, 0, x);
        self.update_tensions(simd, 0);
        let pairs = self
            .strain
            .iter()
            .zip(&self.tension)
            .zip(&self.energy_weight);
        let terms = pairs.map(|((q, t), weight)| if *weight > 0.0 { weight * q * t } else { 0.0 });
        terms.sum()
    }
}

/// The membrane of a triangle and the numbers of its edges.
struct TriangleEdges {
    membrane: EdgeMembrane,
    sides: [u32; 3],
}

fn triangle_edges(
    system: &System,
    edges: &Edges,
    &(t, [a, b, c]): &(usize, [u32; 3]),
) -> TriangleEdges {
    let stiffness = system.materials.law(t).stiffness;
    TriangleEdges {
        membrane: EdgeMembrane::new(&system.rest.elements[t], stiffness),
        sides: [[a, b], [a, c], [b, c]].map(|[a, b]| edges.number(a, b).unwrap_or_default()),
    }
}

/// For each ring the groups with a number of at most that ring, given the ring of each number.
pub fn groups_by_ring(of: &[usize], rings: usize) -> Vec<Vec<u32>> {
    let group_rings: Vec<usize> = of
        .chunks(WIDTH)
        .map(|group| group.iter().copied().min().unwrap_or(usize::MAX))
        .collect();
    let lists = (0..rings).map(|ring| {
        let numbered = (0u32..).zip(&group_rings);
        let inside = numbered.filter(|(_, of)| **of <= ring);
        inside.map(|(group, _)| group).collect()
    });
    lists.collect()
}
