//! Boxes of the features in every leaf of the tree: those of two leaves are tested against each other
//! sixteen at a time, in single precision rounded outwards.

use super::boxes::{Bounds, BoxTree, MAX_LEAF_ITEMS};
use super::trajectories::LinearTrajectories;
use crate::lanes::LANES;
use pulp::{Arch, NullaryFnOnce};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// No feature.
const NONE: u32 = u32::MAX;

// Each feature of a leaf, at most three edges a triangle, has a bit.
const _: () = assert!(3 * MAX_LEAF_ITEMS <= u64::BITS as usize);

/// A box along the axes [m].
#[derive(Clone, Copy, Debug)]
struct Aabb {
    low: [f32; 3],
    high: [f32; 3],
}

/// The box of nothing.
const EMPTY: Aabb = Aabb {
    low: [f32::INFINITY; 3],
    high: [f32::NEG_INFINITY; 3],
};

/// Bounds of an unused lane. NaN: every overlap test fails and `min`/`max` ignore it.
const PADDING: [f32; LANES] = [f32::NAN; LANES];

impl Aabb {
    /// Bounds of a segment, enlarged by `margin` [m] and rounded outwards to `f32`.
    fn swept(from: Vec3, to: Vec3, margin: f64) -> Self {
        let end = |k: usize| [from[k].min(to[k]) - margin, from[k].max(to[k]) + margin];
        Self {
            low: [0, 1, 2].map(|k| (end(k)[0] as f32).next_down()),
            high: [0, 1, 2].map(|k| (end(k)[1] as f32).next_up()),
        }
    }

    fn join(&self, other: &Self) -> Self {
        Self {
            low: [0, 1, 2].map(|k| self.low[k].min(other.low[k])),
            high: [0, 1, 2].map(|k| self.high[k].max(other.high[k])),
        }
    }
}

/// Boxes of sixteen features side by side.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
struct Block {
    low: [[f32; LANES]; 3],
    high: [[f32; LANES]; 3],
}

impl Block {
    fn set(&mut self, lane: usize, aabb: &Aabb) {
        for k in 0..3 {
            self.low[k][lane] = aabb.low[k];
            self.high[k][lane] = aabb.high[k];
        }
    }

    /// Fits the boxes of some features to the `swept` ones of the vertices; `corners` gives those of a
    /// feature.
    fn fit<const N: usize>(
        &mut self,
        features: &[u32; LANES],
        swept: &[Aabb],
        corners: impl Fn(u32) -> [u32; N],
    ) {
        for (lane, &feature) in features.iter().enumerate() {
            if feature != NONE {
                let own = corners(feature).map(|v| swept[v as usize]);
                self.set(lane, &own.iter().fold(EMPTY, |all, one| all.join(one)));
            }
        }
    }

    fn get(&self, lane: usize) -> Aabb {
        Aabb {
            low: [0, 1, 2].map(|k| self.low[k][lane]),
            high: [0, 1, 2].map(|k| self.high[k][lane]),
        }
    }

    /// Which boxes overlap another one that is shrunk by `shrink` [m] on all sides, as bits.
    #[inline(always)]
    fn overlapping(&self, one: &Aabb, shrink: f32) -> u32 {
        let mut bits = 0u32;
        for lane in 0..LANES {
            let mut meets = true;
            for k in 0..3 {
                meets &= one.low[k] + shrink <= self.high[k][lane];
                meets &= self.low[k][lane] <= one.high[k] - shrink;
            }
            bits |= u32::from(meets) << lane;
        }
        bits
    }
}

/// The lanes whose bits are set.
fn lanes(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (lane < u32::BITS).then_some(lane as usize)
    })
}

/// Features of one kind, leaf after leaf.
#[derive(Clone, Debug, Default)]
struct Kind {
    /// The features of every block; [`NONE`] where the last block of a leaf is not full.
    features: Vec<[u32; LANES]>,
    blocks: Vec<Block>,
    /// First block of every leaf, and the end.
    starts: Vec<u32>,
}

impl Kind {
    /// Of the features of every leaf.
    fn new<'a>(leaves: impl Iterator<Item = &'a Vec<u32>>) -> Self {
        let mut kind = Self {
            starts: vec![0],
            ..Self::default()
        };
        for features in leaves {
            for some in features.chunks(LANES) {
                let mut block = [NONE; LANES];
                block[..some.len()].copy_from_slice(some);
                kind.features.push(block);
            }
            kind.starts.push(kind.features.len() as u32);
        }
        let empty = Block {
            low: [PADDING; 3],
            high: [PADDING; 3],
        };
        kind.blocks = vec![empty; kind.features.len()];
        kind
    }

    /// Fits all boxes; `corners` gives the vertices of a feature.
    fn fit<const N: usize>(&mut self, swept: &[Aabb], corners: impl Fn(u32) -> [u32; N] + Sync) {
        let all = self.blocks.par_iter_mut().with_min_len(64);
        all.zip(&self.features)
            .for_each(|(block, features)| block.fit(features, swept, &corners));
    }

    /// [`Self::fit`] for the boxes of a leaf.
    fn fit_one<const N: usize>(
        &mut self,
        leaf: u32,
        swept: &[Aabb],
        corners: impl Fn(u32) -> [u32; N],
    ) {
        for at in self.of(leaf) {
            self.blocks[at].fit(&self.features[at], swept, &corners);
        }
    }

    /// For each place, which features of another kind in the same leaf `tests` says yes to, as bits.
    fn own_tests(&self, other: &Self, tests: impl Fn(u32, u32) -> bool) -> Vec<u64> {
        let mut own = vec![0; LANES * self.features.len()];
        for leaf in 0..self.starts.len().saturating_sub(1) as u32 {
            let others = other.features[other.of(leaf)].iter().flatten().enumerate();
            let others = others.filter(|(_, feature)| **feature != NONE);
            for at in self.of(leaf) {
                for (lane, &one) in self.features[at].iter().enumerate() {
                    if one != NONE {
                        let tested = others.clone().filter(|(_, other)| tests(one, **other));
                        own[LANES * at + lane] =
                            tested.fold(0, |bits, (place, _)| bits | 1 << place);
                    }
                }
            }
        }
        own
    }

    fn of(&self, leaf: u32) -> std::ops::Range<usize> {
        self.starts[leaf as usize] as usize..self.starts[leaf as usize + 1] as usize
    }
}

/// Which kinds of features are tested against which.
#[derive(Clone, Copy, Debug)]
enum KindPair {
    VertexFace,
    EdgeEdge,
    EdgeFace,
}

/// Pairs that may come near.
const NEAR: [KindPair; 2] = [KindPair::VertexFace, KindPair::EdgeEdge];

/// Pairs that may cross.
const CROSSING: [KindPair; 1] = [KindPair::EdgeFace];

/// Features near each other; those of one leaf share no vertex.
#[derive(Clone, Debug, Default)]
pub struct Hits {
    /// A vertex and a face.
    pub vertex_face: Vec<[u32; 2]>,
    /// Two edges.
    pub edge_edge: Vec<[u32; 2]>,
    /// An edge and a face.
    pub edge_face: Vec<[u32; 2]>,
}

/// The features of all leaves, with their boxes as last fitted.
#[derive(Clone, Debug, Default)]
pub struct LeafAabbs {
    vertices: Kind,
    edges: Kind,
    faces: Kind,
    /// Which features of its own leaf one is tested against, as bits: for each place of a vertex against
    /// faces, and for each place of an edge against edges and against faces.
    own: [Vec<u64>; 3],
    /// The box of every leaf.
    leaf_boxes: Vec<Aabb>,
    /// The box of the trajectory of every vertex.
    swept: Vec<Aabb>,
    /// By how much a box may be shrunk before it is tested against another to undo the margin of both [m].
    slack: f32,
    /// Largest rounding error of single precision [m].
    rounding: f64,
}

/// Ends of edges and corners of triangles.
#[derive(Clone, Copy)]
pub struct Corners<'a> {
    /// Of the edges.
    pub edges: &'a [[u32; 2]],
    /// Of the triangles.
    pub triangles: &'a [[u32; 3]],
}

/// Share of the largest coordinate that single precision is off by after a few sums.
const ROUNDING: f64 = 8.0 * f32::EPSILON as f64;

/// Origin of single precision: a vertex whose coordinates are finite [m].
pub(super) fn origin(x: &[Vec3]) -> Vec3 {
    let known = |p: &&Vec3| p.iter().all(|c| c.is_finite());
    x.iter().find(known).copied().unwrap_or_default()
}

/// A test of the features of two leaves, or of one with itself. A type of its own, since a closure would not be
/// compiled for the processor's vectors.
struct LeafTest<'a> {
    leaves: &'a LeafAabbs,
    kinds: &'a [KindPair],
    pair: [u32; 2],
    /// By how much boxes are shrunk [m].
    shrink: f32,
    hits: &'a mut Hits,
}

impl NullaryFnOnce for LeafTest<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let [a, b] = self.pair;
        for &kinds in self.kinds {
            let (hits, both_ways) = match kinds {
                KindPair::VertexFace => (&mut self.hits.vertex_face, a != b),
                KindPair::EdgeEdge => (&mut self.hits.edge_edge, false),
                KindPair::EdgeFace => (&mut self.hits.edge_face, a != b),
            };
            self.leaves.test_blocks(kinds, [a, b], self.shrink, hits);
            if both_ways {
                self.leaves.test_blocks(kinds, [b, a], self.shrink, hits);
            }
        }
    }
}

impl Hits {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        let all = [&self.vertex_face, &self.edge_edge, &self.edge_face];
        all.iter().all(|hits| hits.is_empty())
    }

    /// Takes in others.
    pub fn append(&mut self, other: &Self) {
        self.vertex_face.extend_from_slice(&other.vertex_face);
        self.edge_edge.extend_from_slice(&other.edge_edge);
        self.edge_face.extend_from_slice(&other.edge_face);
    }

    /// Empties it.
    pub fn clear(&mut self) {
        self.vertex_face.clear();
        self.edge_edge.clear();
        self.edge_face.clear();
    }
}

impl LeafAabbs {
    /// For the leaves of a tree; every vertex and every edge is in the leaf of the triangle that owns it.
    pub fn new(
        tree: &BoxTree,
        [vertex_owners, edge_owners]: [&[u32]; 2],
        corners: Corners,
    ) -> Self {
        let faces: Vec<Vec<u32>> = (0..tree.leaves())
            .map(|leaf| tree.items(leaf).to_vec())
            .collect();
        let mut leaf_of = vec![0; faces.iter().map(Vec::len).sum()];
        for (leaf, items) in faces.iter().enumerate() {
            for &t in items {
                leaf_of[t as usize] = leaf;
            }
        }
        let of = |owners: &[u32]| {
            let mut lists = vec![Vec::new(); faces.len()];
            for (feature, &owner) in owners.iter().enumerate() {
                if owner != NONE {
                    lists[leaf_of[owner as usize]].push(feature as u32);
                }
            }
            Kind::new(lists.iter())
        };
        let [vertices, edges] = [of(vertex_owners), of(edge_owners)];
        let leaf_boxes = vec![EMPTY; faces.len()];
        let faces = Kind::new(faces.iter());
        let face = |t: u32| corners.triangles[t as usize];
        let edge = |e: u32| corners.edges[e as usize];
        let own = [
            vertices.own_tests(&faces, |v, t| !face(t).contains(&v)),
            edges.own_tests(&edges, |e, f| {
                e < f && !edge(e).iter().any(|v| edge(f).contains(v))
            }),
            edges.own_tests(&faces, |e, t| !edge(e).iter().any(|v| face(t).contains(v))),
        ];
        Self {
            vertices,
            edges,
            faces,
            own,
            leaf_boxes,
            ..Self::default()
        }
    }

    /// Fits all boxes to the trajectories of the vertices, with a margin [m].
    pub fn fit(&mut self, trajectories: &LinearTrajectories, corners: Corners, margin: f64) {
        let origin = origin(trajectories.from);
        let both = trajectories
            .from
            .par_iter()
            .zip(trajectories.to)
            .with_min_len(1024);
        both.map(|(from, to)| Aabb::swept(from - origin, to - origin, margin))
            .collect_into_vec(&mut self.swept);
        self.vertices.fit(&self.swept, |v| [v]);
        self.edges.fit(&self.swept, |e| corners.edges[e as usize]);
        self.faces
            .fit(&self.swept, |t| corners.triangles[t as usize]);
        for leaf in 0..self.leaf_boxes.len() {
            self.leaf_boxes[leaf] = self.box_of(leaf);
        }
        let ends = self
            .leaf_boxes
            .iter()
            .flat_map(|own| own.low.into_iter().chain(own.high));
        let farthest = f64::from(ends.fold(0.0, |most: f32, end| most.max(end.abs())));
        self.rounding = ROUNDING * farthest;
        // Both boxes have the margin.
        self.slack = (2.0 * margin - self.rounding).max(0.0) as f32;
    }

    /// Fits the boxes of some leaves to the trajectories of their vertices, without a margin.
    pub fn fit_some(
        &mut self,
        trajectories: &LinearTrajectories,
        corners: Corners,
        leaves: &[u32],
    ) {
        if 2 * leaves.len() > self.leaf_boxes.len() {
            // All of them in parallel take no longer.
            self.fit(trajectories, corners, 0.0);
            return;
        }
        let origin = origin(trajectories.from);
        self.swept.resize(trajectories.from.len(), EMPTY);
        let mut farthest = 0.0f64;
        for &leaf in leaves {
            for at in self.faces.of(leaf) {
                let faces = self.faces.features[at].iter().filter(|t| **t != NONE);
                for v in faces.flat_map(|&t| corners.triangles[t as usize]) {
                    let ends = [trajectories.from, trajectories.to];
                    let [from, to] = ends.map(|x| x[v as usize] - origin);
                    farthest = farthest.max(from.amax()).max(to.amax());
                    self.swept[v as usize] = Aabb::swept(from, to, 0.0);
                }
            }
            // Every edge and vertex of a leaf is of one of its faces.
            self.vertices.fit_one(leaf, &self.swept, |v| [v]);
            self.edges
                .fit_one(leaf, &self.swept, |e| corners.edges[e as usize]);
            self.faces
                .fit_one(leaf, &self.swept, |t| corners.triangles[t as usize]);
            self.leaf_boxes[leaf as usize] = self.box_of(leaf as usize);
        }
        self.rounding = ROUNDING * farthest;
        self.slack = 0.0;
    }

    /// The box of all faces of a leaf.
    fn box_of(&self, leaf: usize) -> Aabb {
        let blocks = &self.faces.blocks[self.faces.of(leaf as u32)];
        let all = blocks
            .iter()
            .flat_map(|block| (0..LANES).map(|lane| block.get(lane)));
        all.fold(EMPTY, |all, one| all.join(&one))
    }

    /// The box of a leaf, relative to an origin that is the same for all [m].
    pub fn bounds(&self, leaf: usize) -> Bounds {
        let Aabb { low, high } = self.leaf_boxes[leaf];
        Bounds {
            low: low.map(f64::from),
            high: high.map(f64::from),
        }
    }

    /// Vertices and faces, and edges, whose boxes come within a distance of each other [m], and some more, of
    /// two leaves or of one.
    pub fn near_within(&self, arch: Arch, pair: [u32; 2], distance: f64, hits: &mut Hits) {
        self.test(arch, &NEAR, (pair, self.enlarged(distance)), hits);
    }

    /// Edges and faces whose boxes come within a distance of each other [m], and some more.
    pub fn crossing_within(&self, arch: Arch, pair: [u32; 2], distance: f64, hits: &mut Hits) {
        self.test(arch, &CROSSING, (pair, self.enlarged(distance)), hits);
    }

    fn test(
        &self,
        arch: Arch,
        kinds: &[KindPair],
        (pair, shrink): ([u32; 2], f32),
        hits: &mut Hits,
    ) {
        arch.dispatch(LeafTest {
            leaves: self,
            kinds,
            pair,
            shrink,
            hits,
        });
    }

    /// A shrinking that enlarges boxes by a distance [m], rounded outwards.
    fn enlarged(&self, distance: f64) -> f32 {
        -((distance + self.rounding) as f32).next_up()
    }

    /// Edges and faces whose trajectories may meet, of two leaves or of one.
    pub fn crossing(&self, arch: Arch, pair: [u32; 2], hits: &mut Hits) {
        self.test(arch, &CROSSING, (pair, self.slack), hits);
    }

    /// Tests the features of the first leaf against those of the second.
    #[inline(always)]
    fn test_blocks(&self, kinds: KindPair, [a, b]: [u32; 2], shrink: f32, out: &mut Vec<[u32; 2]>) {
        let (first, second, own) = match kinds {
            KindPair::VertexFace => (&self.vertices, &self.faces, &self.own[0]),
            KindPair::EdgeEdge => (&self.edges, &self.edges, &self.own[1]),
            KindPair::EdgeFace => (&self.edges, &self.faces, &self.own[2]),
        };
        let all = &self.leaf_boxes[b as usize];
        for at in first.of(a) {
            let (block, features) = (&first.blocks[at], &first.features[at]);
            for lane in lanes(block.overlapping(all, shrink)) {
                let one = block.get(lane);
                let tested = own[LANES * at + lane];
                for (k, at) in second.of(b).enumerate() {
                    let mut overlapping = second.blocks[at].overlapping(&one, shrink);
                    if a == b {
                        overlapping &= (tested >> (LANES * k)) as u32;
                    }
                    let found = &second.features[at];
                    out.extend(lanes(overlapping).map(|other| [features[lane], found[other]]));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::numbers::Numbers;
    use super::*;

    #[test]
    fn boxes_meet_as_their_bounds_do() {
        let mut numbers = Numbers(1);
        let mut place = |scale: f64| numbers.vector(0.5 * scale);
        let mut met = 0;
        for _ in 0..200 {
            let mut block = Kind::new([(0..LANES as u32).collect()].iter()).blocks[0].clone();
            let ways: Vec<[Vec3; 2]> = (0..=LANES).map(|_| [place(1.0), place(1.0)]).collect();
            let aabb = |[from, to]: [Vec3; 2]| Aabb::swept(from, to, 0.0);
            for (lane, way) in ways[..LANES].iter().enumerate() {
                block.set(lane, &aabb(*way));
            }
            let bits = block.overlapping(&aabb(ways[LANES]), 0.0);
            let one = Bounds::of(&ways[LANES], 0.0);
            for (lane, way) in ways[..LANES].iter().enumerate() {
                let meets = Bounds::of(way, 0.0).meets(&one);
                assert_eq!(bits >> lane & 1 == 1, meets);
                met += usize::from(meets);
            }
            assert_eq!(lanes(bits).count(), bits.count_ones() as usize);
        }
        assert!(met > 100, "{met}");
        let empty = &Kind::new([vec![7]].iter()).blocks[0];
        let all = Aabb {
            low: [f32::NEG_INFINITY; 3],
            high: [f32::INFINITY; 3],
        };
        assert_eq!(empty.overlapping(&all, 0.0), 0, "padding overlaps nothing");
    }
}
