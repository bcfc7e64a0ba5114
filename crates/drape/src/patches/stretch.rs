//! Principal stretch of triangles from the strains of their edges.

use super::octets::{Octet, PAD, Places, Take, WIDTH, parts};
use pulp::Simd;
use std::collections::BTreeMap;

/// Groups of triangles.
pub struct Stretches {
    /// Where the strains of their edges lie, and their shapes.
    takes: Vec<([Take; 3], u32)>,
    scattered: Vec<Places>,
    /// Shapes of groups, those that are alike kept once.
    shapes: Vec<[Octet; 4]>,
}

/// Triangles of one kind that lie side by side for a run to be made of them.
const LEAST_RUN: usize = 4;

type Triangle = ([u32; 3], [f64; 4]);

impl Stretches {
    /// Of triangles: the numbers of their edges and what stretch follows from
    /// ([`super::membrane::EdgeMembrane::shape`]).
    pub fn new(triangles: impl Iterator<Item = Triangle>) -> Self {
        let mut sorted: Vec<Triangle> = triangles.collect();
        // Those come together whose edges lie alike.
        let kind = |&([a, b, c], _): &Triangle| (b.wrapping_sub(a), c.wrapping_sub(a), a);
        sorted.sort_unstable_by_key(kind);
        let mut made = Self {
            takes: Vec::new(),
            scattered: Vec::new(),
            shapes: Vec::new(),
        };
        let mut known = BTreeMap::new();
        let mut single = Vec::new();
        let mut rest = &sorted[..];
        while let Some(first) = rest.first() {
            let (apart, more, start) = kind(first);
            let run = rest.partition_point(|t| kind(t) < (apart, more, start + WIDTH as u32));
            let (group, after) = rest.split_at(run);
            rest = after;
            if group.len() < LEAST_RUN {
                single.extend_from_slice(group);
                continue;
            }
            let mut lanes = [None; WIDTH];
            for triangle in group {
                lanes[(triangle.0[0] - start) as usize] = Some(*triangle);
            }
            made.add(lanes, &mut known);
        }
        for group in single.chunks(WIDTH) {
            let mut lanes = [None; WIDTH];
            for (lane, triangle) in lanes.iter_mut().zip(group) {
                *lane = Some(*triangle);
            }
            made.add(lanes, &mut known);
        }
        made
    }

    fn add(&mut self, lanes: [Option<Triangle>; WIDTH], known: &mut BTreeMap<Vec<u64>, u32>) {
        let takes = [0, 1, 2].map(|side| {
            let places = lanes.map(|lane| lane.map(|(sides, _)| sides[side] + PAD as u32));
            Take::new(places, &mut self.scattered)
        });
        let shape =
            [0, 1, 2, 3].map(|k| Octet(lanes.map(|lane| lane.map_or(0.0, |(_, shape)| shape[k]))));
        let bits = shape.iter().flat_map(|octet| octet.0).map(f64::to_bits);
        let at = *known.entry(bits.collect()).or_insert_with(|| {
            self.shapes.push(shape);
            self.shapes.len() as u32 - 1
        });
        self.takes.push((takes, at));
    }

    /// Largest and smallest principal squared stretch by the strains of edges [m2], no less and no
    /// more than 1; no numbers where a strain is none. They are eigenvalues of the present metric
    /// by the one at rest: 1 + u +- root(u^2 - det).
    ///
    /// A triangle folded onto a line counts too: warp and weft then pull the same way, and the
    /// square is up to 2.
    #[inline(always)]
    pub fn extremes<S: Simd>(&self, simd: S, strain: &[f64]) -> [f64; 2] {
        let (zero, quarter) = (simd.splat_f64s(0.0), simd.splat_f64s(0.25));
        let (mut most, mut least, mut lost) = (zero, zero, zero);
        for (takes, shape) in &self.takes {
            let shape = &self.shapes[*shape as usize];
            for part in 0..parts::<S>() {
                let q = [
                    takes[0].load::<S>(strain, &self.scattered, part),
                    takes[1].load::<S>(strain, &self.scattered, part),
                    takes[2].load::<S>(strain, &self.scattered, part),
                ];
                let u = simd.mul_f64s(q[0], shape[0].part::<S>(part));
                let u = simd.mul_add_f64s(q[1], shape[1].part::<S>(part), u);
                let u = simd.mul_add_f64s(q[2], shape[2].part::<S>(part), u);
                // Twice the change of d1.d2.
                let mixed = simd.sub_f64s(simd.add_f64s(q[0], q[1]), q[2]);
                let mixed = simd.mul_f64s(quarter, simd.mul_f64s(mixed, mixed));
                let det = simd.sub_f64s(simd.mul_f64s(q[0], q[1]), mixed);
                let det = simd.mul_f64s(det, shape[3].part::<S>(part));
                let root = simd.sub_f64s(simd.mul_f64s(u, u), det);
                let root = simd.sqrt_f64s(simd.max_f64s(root, zero));
                most = simd.max_f64s(most, simd.add_f64s(u, root));
                least = simd.min_f64s(least, simd.sub_f64s(u, root));
                lost = simd.add_f64s(lost, simd.mul_f64s(u, zero));
            }
        }
        // Zero, or no number.
        let lost = simd.reduce_sum_f64s(lost);
        [
            1.0 + lost + simd.reduce_max_f64s(most),
            1.0 + lost + simd.reduce_min_f64s(least),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::super::membrane::EdgeMembrane;
    use super::super::octets::padded;
    use super::*;
    use crate::laws::membrane::MembraneElement;
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
