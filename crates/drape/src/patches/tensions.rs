//! The membrane of a patch as tensions of its edges.
//!
//! Strain is linear in the squared lengths of edges, so an edge's tension is a sum over the edges
//! of its two triangles, and the force at a vertex a sum over its edges of tension times edge.

use super::edges::Edges;
use super::membrane::EdgeMembrane;
use super::octets::{
    PAD, Places, Points, Take, WIDTH, add_scaled, gather, gather_points, load, load_points, padded,
    parts, place, store,
};
use super::rows::{Rows, least_run, rounding};
use super::stretch::Stretches;
use crate::System;
use pulp::Simd;
use std::collections::BTreeMap;

/// The membrane of the triangles of a patch.
pub struct Tensions {
    /// Where the ends of the edges of each group lie.
    ends: Vec<[Take; 2]>,
    /// Squared lengths at rest [m2].
    rest: Vec<f64>,
    /// Squared lengths less those at rest [m2].
    strain: Vec<f64>,
    /// Tensions [N/m].
    tension: Vec<f64>,
    /// Tensions by strains.
    stiffness: Rows,
    /// A fourth where the patch answers for the edge's energy.
    counted: Vec<f64>,
    /// Groups whose strain, and whose tension, forces within each ring look at.
    strained: Vec<Vec<u32>>,
    tense: Vec<Vec<u32>>,
    /// Where the entries of each group of vertices begin, in `runs` and in `others`; one more than
    /// there are groups.
    start: Vec<[u32; 2]>,
    /// Where the other ends of their edges, and the edges, lie side by side.
    runs: Vec<[u32; 2]>,
    /// Where they lie otherwise.
    others: Vec<[Places; 2]>,
    /// Ends that lie in no order.
    scattered: Vec<Places>,
    stretches: Stretches,
}

/// What tensions are made from: a patch's vertices in their order.
pub struct Ground<'a> {
    /// The model.
    pub system: &'a System,
    /// Its triangles that lie in the patch, with their corners there.
    pub triangles: &'a [(usize, [u32; 3])],
    /// The ring of each vertex, zero for those the patch owns.
    pub ring: &'a [usize],
    /// The vertices in the model.
    pub vertices: &'a [u32],
}

impl Tensions {
    /// The membrane on some ground.
    pub fn new(ground: &Ground) -> Self {
        let Ground { system, ring, .. } = *ground;
        let edges = Edges::new(ground.triangles.iter().map(|&(_, corners)| corners));
        let slots = edges.ends.len();
        let laws: Vec<Law> = ground
            .triangles
            .iter()
            .map(|t| law(system, &edges, t))
            .collect();
        let values = laws.iter().flat_map(|law| law.membrane.stiffness);
        let largest = values
            .flatten()
            .fold(f64::MIN_POSITIVE, |m, k| m.max(k.abs()));
        let round = rounding(largest);
        let mut rows = vec![BTreeMap::new(); slots];
        let mut rest = padded(slots);
        // What forces within a ring look at: innermost vertex of an edge's triangles, of an edge.
        let mut looked = vec![[usize::MAX; 2]; slots];
        for (law, (_, corners)) in laws.iter().zip(ground.triangles) {
            let innermost = corners.map(|c| ring[c as usize]).into_iter().min();
            for i in 0..3 {
                let at = law.sides[i] as usize;
                rest[PAD + at] = law.membrane.rest[i];
                looked[at][0] = looked[at][0].min(innermost.unwrap_or(0));
                for j in 0..3 {
                    *rows[at].entry(law.sides[j]).or_insert(0.0) +=
                        round(law.membrane.stiffness[i][j]);
                }
            }
        }
        let mut counted = padded(slots);
        for (number, ends) in edges.iter() {
            let at = number as usize;
            let [a, b] = ends.map(|end| end as usize);
            looked[at][1] = ring[a].min(ring[b]);
            let answers = if ground.vertices[a] < ground.vertices[b] {
                a
            } else {
                b
            };
            counted[PAD + at] = if ring[answers] == 0 { 0.25 } else { 0.0 };
        }
        let rows: Vec<Vec<(u32, f64)>> = rows
            .into_iter()
            .map(|row| row.into_iter().collect())
            .collect();
        let rings = ring.iter().max().map_or(1, |most| most + 1);
        let [strained, tense] = [0, 1].map(|what| {
            let of: Vec<usize> = looked.iter().map(|looked| looked[what]).collect();
            within(&of, rings)
        });
        let mut made = Self {
            ends: Vec::new(),
            rest,
            strain: padded(slots),
            tension: padded(slots),
            stiffness: Rows::new(&rows),
            counted,
            strained,
            tense,
            start: vec![[0; 2]],
            runs: Vec::new(),
            others: Vec::new(),
            scattered: Vec::new(),
            stretches: Stretches::new(laws.iter().zip(ground.triangles).filter_map(
                |(law, (_, corners))| {
                    let inside = corners.iter().any(|&c| ring[c as usize] == 0);
                    inside.then_some((law.sides, law.membrane.shape))
                },
            )),
        };
        made.add_ends(&edges);
        made.add_pulls(&edges, ground.vertices.len());
        made
    }

    fn add_ends(&mut self, edges: &Edges) {
        for group in edges.ends.chunks(WIDTH) {
            self.ends.push([0, 1].map(|end| {
                let mut lanes = [None; WIDTH];
                for (lane, ends) in lanes.iter_mut().zip(group) {
                    *lane = ends.map(|ends| ends[end] + PAD as u32);
                }
                Take::new(lanes, &mut self.scattered)
            }));
        }
    }

    fn add_pulls(&mut self, edges: &Edges, vertices: usize) {
        let mut around = vec![Vec::new(); vertices];
        for (number, [a, b]) in edges.iter() {
            around[a as usize].push([b, number]);
            around[b as usize].push([a, number]);
        }
        let no_edge = |place: u32| {
            let number = (place as usize).checked_sub(PAD);
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
            let least = least_run(runs.values().map(|lanes| lanes.iter().copied()));
            let mut left = [const { Vec::new() }; WIDTH];
            for (&start, lanes) in &runs {
                // The others take the tension of no edge.
                let free = (0..WIDTH as u32)
                    .filter(|lane| !lanes.contains(lane))
                    .all(|lane| no_edge(start[1] + lane));
                if free && lanes.len() >= least {
                    self.runs.push(start);
                } else {
                    for &lane in lanes {
                        left[lane as usize].push(start.map(|at| at + lane));
                    }
                }
            }
            for k in 0..left.iter().map(Vec::len).max().unwrap_or(0) {
                self.others.push([0, 1].map(|what| {
                    left.each_ref()
                        .map(|row| row.get(k).map_or(0, |pair| pair[what]))
                }));
            }
            self.start
                .push([self.runs.len() as u32, self.others.len() as u32]);
        }
    }

    /// Numbers of runs that its loads are worth.
    pub fn cost(&self) -> usize {
        let runs = self.stiffness.cost() + 6 * self.ends.len() + 4 * self.runs.len();
        runs + 2 * WIDTH * self.scattered.len() + 4 * WIDTH * self.others.len()
    }

    /// Forgets strains and tensions: what blew up must not be looked at again.
    pub fn clear(&mut self) {
        self.strain.fill(0.0);
        self.tension.fill(0.0);
    }

    /// Measures the strains that forces within a ring look at.
    #[inline(always)]
    pub fn measure<S: Simd>(&mut self, simd: S, ring: usize, x: &Points) {
        let x = x.axes();
        for &group in &self.strained[ring] {
            let [a, b] = self.ends[group as usize];
            for part in 0..parts::<S>() {
                let a = a.points::<S>(x, &self.scattered, part);
                let b = b.points::<S>(x, &self.scattered, part);
                let d = [
                    simd.sub_f64s(b[0], a[0]),
                    simd.sub_f64s(b[1], a[1]),
                    simd.sub_f64s(b[2], a[2]),
                ];
                let at = place::<S>(group as usize, part);
                let sum = simd.mul_f64s(d[0], d[0]);
                let sum = simd.mul_add_f64s(d[1], d[1], sum);
                let sum = simd.mul_add_f64s(d[2], d[2], sum);
                let strain = simd.sub_f64s(sum, load::<S>(&self.rest, at));
                store::<S>(&mut self.strain, at, strain);
            }
        }
    }

    /// Works out the tensions that forces within a ring look at, from the strains.
    #[inline(always)]
    pub fn draw<S: Simd>(&mut self, simd: S, ring: usize) {
        for &group in &self.tense[ring] {
            for part in 0..parts::<S>() {
                let sum = self
                    .stiffness
                    .product(simd, group as usize, part, &self.strain);
                store::<S>(&mut self.tension, place::<S>(group as usize, part), sum);
            }
        }
    }

    /// The gradient of the membrane's energy by a part of a group of vertices [N].
    #[inline(always)]
    pub fn gradient<S: Simd>(
        &self,
        simd: S,
        group: usize,
        part: usize,
        x: [&[f64]; 3],
    ) -> [S::f64s; 3] {
        let mut sum = [simd.splat_f64s(0.0); 3];
        let mut total = simd.splat_f64s(0.0);
        let [[runs, others], [end, others_end]] = [self.start[group], self.start[group + 1]];
        let first = part * S::F64_LANES;
        for [other, edge] in &self.runs[runs as usize..end as usize] {
            let t = load::<S>(&self.tension, *edge as usize + first);
            let other = load_points::<S>(x, *other as usize + first);
            add_scaled(simd, &mut sum, t, other);
            total = simd.add_f64s(total, t);
        }
        for [other, edge] in &self.others[others as usize..others_end as usize] {
            let t = gather::<S>(&self.tension, edge, part);
            let other = gather_points::<S>(x, other, part);
            add_scaled(simd, &mut sum, t, other);
            total = simd.add_f64s(total, t);
        }
        let at = place::<S>(group, part);
        [
            simd.sub_f64s(simd.mul_f64s(total, load::<S>(x[0], at)), sum[0]),
            simd.sub_f64s(simd.mul_f64s(total, load::<S>(x[1], at)), sum[1]),
            simd.sub_f64s(simd.mul_f64s(total, load::<S>(x[2], at)), sum[2]),
        ]
    }

    /// Largest and smallest principal squared stretch of the triangles at what the patch owns.
    #[inline(always)]
    pub fn stretch<S: Simd>(&mut self, simd: S, x: &Points) -> [f64; 2] {
        self.measure(simd, 0, x);
        self.stretches.extremes(simd, &self.strain)
    }

    /// Energy of the edges the patch answers for [J].
    #[inline(always)]
    pub fn energy<S: Simd>(&mut self, simd: S, x: &Points) -> f64 {
        self.measure(simd, 0, x);
        self.draw(simd, 0);
        let pairs = self.strain.iter().zip(&self.tension).zip(&self.counted);
        let terms =
            pairs.map(|((q, t), counted)| if *counted > 0.0 { counted * q * t } else { 0.0 });
        terms.sum()
    }
}

/// A triangle's law and the numbers of its edges.
struct Law {
    membrane: EdgeMembrane,
    sides: [u32; 3],
}

fn law(system: &System, edges: &Edges, &(t, [a, b, c]): &(usize, [u32; 3])) -> Law {
    let law = system.materials.law(t).stiffness;
    Law {
        membrane: EdgeMembrane::new(&system.rest.elements[t], law),
        sides: [[a, b], [a, c], [b, c]].map(|[a, b]| edges.number(a, b).unwrap_or_default()),
    }
}

/// Groups with anything that is looked at from within each ring, given the ring of each number.
pub fn within(of: &[usize], rings: usize) -> Vec<Vec<u32>> {
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
