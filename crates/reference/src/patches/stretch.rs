//! Principal stretches of triangles from the strains of their edges.

use super::octets::{Indices, Octet, Operands, PAD, WIDTH, lane_groups};
use pulp::Simd;
use std::collections::BTreeMap;
use toile_drape::lane_arithmetic::{F64s, Number};

/// Triangles in groups of eight.
pub struct Stretches {
    /// For each group the strains of the three edges, and the index of its shapes.
    groups: Vec<([Operands; 3], u32)>,
    scattered: Vec<Indices>,
    /// Shape coefficients of groups; equal groups share them.
    shapes: Vec<[Octet; 4]>,
}

/// Least number of triangles with equal edge offsets, within eight consecutive edge numbers, that make a group
/// whose strains are loaded as runs.
const MIN_RUN: usize = 4;

type Triangle = ([u32; 3], [f64; 4]);

impl Stretches {
    /// From the edge numbers and shape coefficients ([`super::membrane::EdgeMembrane::shape`]) of triangles.
    pub fn new(triangles: impl Iterator<Item = Triangle>) -> Self {
        let mut sorted: Vec<Triangle> = triangles.collect();
        // Sorts triangles with equal edge offsets together.
        let kind = |&([a, b, c], _): &Triangle| (b.wrapping_sub(a), c.wrapping_sub(a), a);
        sorted.sort_unstable_by_key(kind);
        let mut stretches = Self {
            groups: Vec::new(),
            scattered: Vec::new(),
            shapes: Vec::new(),
        };
        let mut known_shapes = BTreeMap::new();
        let mut single = Vec::new();
        let mut rest = &sorted[..];
        while let Some(first) = rest.first() {
            let (second, third, start) = kind(first);
            let run = rest.partition_point(|t| kind(t) < (second, third, start + WIDTH as u32));
            let (group, after) = rest.split_at(run);
            rest = after;
            if group.len() < MIN_RUN {
                single.extend_from_slice(group);
                continue;
            }
            let mut lanes = [None; WIDTH];
            for triangle in group {
                lanes[(triangle.0[0] - start) as usize] = Some(*triangle);
            }
            stretches.add(lanes, &mut known_shapes);
        }
        for group in single.chunks(WIDTH) {
            let mut lanes = [None; WIDTH];
            for (lane, triangle) in lanes.iter_mut().zip(group) {
                *lane = Some(*triangle);
            }
            stretches.add(lanes, &mut known_shapes);
        }
        stretches
    }

    fn add(
        &mut self,
        lanes: [Option<Triangle>; WIDTH],
        known_shapes: &mut BTreeMap<Vec<u64>, u32>,
    ) {
        let strains = [0, 1, 2].map(|side| {
            let indices = lanes.map(|lane| lane.map(|(sides, _)| sides[side] + PAD as u32));
            Operands::new(indices, &mut self.scattered)
        });
        let shape =
            [0, 1, 2, 3].map(|k| Octet(lanes.map(|lane| lane.map_or(0.0, |(_, shape)| shape[k]))));
        let bits = shape.iter().flat_map(|octet| octet.0).map(f64::to_bits);
        let at = *known_shapes.entry(bits.collect()).or_insert_with(|| {
            self.shapes.push(shape);
            self.shapes.len() as u32 - 1
        });
        self.groups.push((strains, at));
    }

    /// Largest and smallest principal squared stretch, from the strains of edges (m2); the largest is at least
    /// 1, the smallest at most 1, and both are NaN where a strain is. They are eigenvalues of the deformed
    /// metric relative to the one at rest: 1 + u +- root(u^2 - det).
    ///
    /// A triangle folded onto a line counts too: warp and weft are then parallel, and the squared stretch is up
    /// to 2.
    #[inline(always)]
    pub fn extremes<S: Simd>(&self, simd: S, strain: &[f64]) -> [f64; 2] {
        let zero = F64s::splat(simd, 0.0);
        let (mut largest, mut smallest, mut nan) = (zero, zero, zero);
        for (strains, shape) in &self.groups {
            let shape = &self.shapes[*shape as usize];
            for lane_group in 0..lane_groups::<S>() {
                let [a, b, c] = [
                    strains[0].load(simd, strain, &self.scattered, lane_group),
                    strains[1].load(simd, strain, &self.scattered, lane_group),
                    strains[2].load(simd, strain, &self.scattered, lane_group),
                ];
                let u = a * shape[0].lane_group(simd, lane_group);
                let u = b.mul_add(shape[1].lane_group(simd, lane_group), u);
                let u = c.mul_add(shape[2].lane_group(simd, lane_group), u);
                // Twice the change of d1.d2.
                let mixed = a + b - c;
                let det = a * b - 0.25 * (mixed * mixed);
                let det = det * shape[3].lane_group(simd, lane_group);
                let root = (u * u - det).max(zero).sqrt();
                largest = largest.max(u + root);
                smallest = smallest.min(u - root);
                nan = nan + u * zero;
            }
        }
        // Zero, or NaN where a strain is: maxima and minima ignore NaN.
        let nan = nan.reduce_sum();
        [
            1.0 + nan + largest.reduce_max(),
            1.0 + nan + smallest.reduce_min(),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::super::membrane::EdgeMembrane;
    use super::super::octets::padded;
    use super::*;
    use toile_drape::laws::membrane::MembraneElement;
    use toile_geometry::Vec2;

    struct Extremes<'a>(&'a Stretches, &'a [f64]);

    impl pulp::WithSimd for Extremes<'_> {
        type Output = [f64; 2];

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> [f64; 2] {
            self.0.extremes(simd, self.1)
        }
    }

    #[test]
    fn principal_stretch_is_that_of_the_deformation() {
        let rest = [
            Vec2::zeros(),
            Vec2::new(0.02, 0.001),
            Vec2::new(0.004, 0.017),
        ];
        let element = MembraneElement::new(rest).expect("has area");
        let membrane = EdgeMembrane::new(&element, [1.0, 1.0, 0.0, 1.0]);
        let drawn = rest.map(|p| Vec2::new(1.3 * p.x, 0.8 * p.y));
        let edges = [[0, 1], [0, 2], [1, 2]].map(|[a, b]: [usize; 2]| drawn[b] - drawn[a]);
        // Twenty triangles, the last of them drawn.
        let triangles = (0..20).map(|k| ([3 * k, 3 * k + 1, 3 * k + 2], membrane.shape));
        let stretches = Stretches::new(triangles);
        let mut strain = padded(60);
        for k in 0..3 {
            strain[PAD + 57 + k] = edges[k].norm_squared() - membrane.rest[k];
        }
        let [high, low] = pulp::Arch::new().dispatch(Extremes(&stretches, &strain));
        assert!(
            (high - 1.69).abs() < 1e-9 && (low - 0.64).abs() < 1e-9,
            "{high} {low}"
        );
    }
}
