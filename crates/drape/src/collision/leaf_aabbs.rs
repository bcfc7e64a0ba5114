//! Axis-aligned boxes of the features in every leaf of the tree, in single precision and rounded outwards. The boxes
//! of two leaves are tested against each other sixteen at a time.

use super::boxes::{Bounds, BoxTree, MAX_LEAF_ITEMS};
use super::trajectories::LinearTrajectories;
use crate::lanes::LANES;
use pulp::{Arch, NullaryFnOnce};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Index in an unused lane, and owner of a vertex without triangles.
const NONE: u32 = u32::MAX;

// The features of a leaf, up to three edges a triangle, are bits of a mask.
const _: () = assert!(3 * MAX_LEAF_ITEMS <= u64::BITS as usize);

/// An axis-aligned box (m).
#[derive(Clone, Copy, Debug)]
struct Aabb {
    low: [f32; 3],
    high: [f32; 3],
}

/// Bounds of nothing: joined to another box it changes nothing.
const EMPTY: Aabb = Aabb {
    low: [f32::INFINITY; 3],
    high: [f32::NEG_INFINITY; 3],
};

/// Bounds of an unused lane. NaN: every overlap test fails and `min`/`max` ignore it.
const PADDING: [f32; LANES] = [f32::NAN; LANES];

impl Aabb {
    /// Bounds of a segment, enlarged by `margin` (m) and rounded outwards to `f32`.
    fn swept(from: Vec3, to: Vec3, margin: f64) -> Self {
        let end = |k: usize| [from[k].min(to[k]) - margin, from[k].max(to[k]) + margin];
        Self {
            low: [0, 1, 2].map(|k| (end(k)[0] as f32).next_down()),
            high: [0, 1, 2].map(|k| (end(k)[1] as f32).next_up()),
        }
    }

    /// Bounds of two boxes.
    fn join(&self, other: &Self) -> Self {
        Self {
            low: [0, 1, 2].map(|k| self.low[k].min(other.low[k])),
            high: [0, 1, 2].map(|k| self.high[k].max(other.high[k])),
        }
    }
}

/// Boxes of sixteen features, in lanes.
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

    /// Fits the boxes of some features to the `swept` boxes of their vertices; `corners` gives the vertices of a
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
                self.set(
                    lane,
                    &own.iter().fold(EMPTY, |joined, aabb| joined.join(aabb)),
                );
            }
        }
    }

    fn get(&self, lane: usize) -> Aabb {
        Aabb {
            low: [0, 1, 2].map(|k| self.low[k][lane]),
            high: [0, 1, 2].map(|k| self.high[k][lane]),
        }
    }

    /// Bits of the boxes that overlap another one, shrunk by `shrink` (m) on all sides.
    #[inline(always)]
    fn overlapping(&self, other: &Aabb, shrink: f32) -> u32 {
        let mut bits = 0u32;
        for lane in 0..LANES {
            let mut meets = true;
            for k in 0..3 {
                meets &= other.low[k] + shrink <= self.high[k][lane];
                meets &= self.low[k][lane] <= other.high[k] - shrink;
            }
            bits |= u32::from(meets) << lane;
        }
        bits
    }
}

/// Lanes whose bits are set.
fn lanes(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (lane < u32::BITS).then_some(lane as usize)
    })
}

/// Features of one kind (vertices, edges or faces) in blocks of sixteen, leaf after leaf.
#[derive(Clone, Debug, Default)]
struct FeatureBlocks {
    /// Features of every block; [`NONE`] in the unused lanes of a leaf's last block.
    features: Vec<[u32; LANES]>,
    blocks: Vec<Block>,
    /// First block of each leaf, and the end.
    starts: Vec<u32>,
}

impl FeatureBlocks {
    /// Blocks for the features of every leaf, with unfitted boxes.
    fn new<'a>(leaves: impl Iterator<Item = &'a Vec<u32>>) -> Self {
        let mut all = Self {
            starts: vec![0],
            ..Self::default()
        };
        for features in leaves {
            for chunk in features.chunks(LANES) {
                let mut block = [NONE; LANES];
                block[..chunk.len()].copy_from_slice(chunk);
                all.features.push(block);
            }
            all.starts.push(all.features.len() as u32);
        }
        let empty = Block {
            low: [PADDING; 3],
            high: [PADDING; 3],
        };
        all.blocks = vec![empty; all.features.len()];
        all
    }

    /// Fits all boxes; `corners` gives the vertices of a feature.
    fn fit<const N: usize>(&mut self, swept: &[Aabb], corners: impl Fn(u32) -> [u32; N] + Sync) {
        let blocks = self.blocks.par_iter_mut().with_min_len(64);
        blocks
            .zip(&self.features)
            .for_each(|(block, features)| block.fit(features, swept, &corners));
    }

    /// [`Self::fit`] for the boxes of one leaf.
    fn fit_leaf<const N: usize>(
        &mut self,
        leaf: u32,
        swept: &[Aabb],
        corners: impl Fn(u32) -> [u32; N],
    ) {
        for block in self.blocks_of(leaf) {
            self.blocks[block].fit(&self.features[block], swept, &corners);
        }
    }

    /// For each lane of each block, the features of another kind in the same leaf for which `is_tested` is true, as
    /// bits.
    fn tests_within_leaf(&self, other: &Self, is_tested: impl Fn(u32, u32) -> bool) -> Vec<u64> {
        let mut masks = vec![0; LANES * self.features.len()];
        for leaf in 0..self.starts.len().saturating_sub(1) as u32 {
            let others = other.features[other.blocks_of(leaf)].iter();
            let others = others.flatten().enumerate();
            let others = others.filter(|(_, feature)| **feature != NONE);
            for block in self.blocks_of(leaf) {
                for (lane, &feature) in self.features[block].iter().enumerate() {
                    if feature != NONE {
                        let tested = (others.clone()).filter(|(_, o)| is_tested(feature, **o));
                        masks[LANES * block + lane] =
                            tested.fold(0, |bits, (bit, _)| bits | 1 << bit);
                    }
                }
            }
        }
        masks
    }

    /// Indices of the blocks of a leaf.
    fn blocks_of(&self, leaf: u32) -> std::ops::Range<usize> {
        self.starts[leaf as usize] as usize..self.starts[leaf as usize + 1] as usize
    }
}

/// Kinds of the two features of a pair.
#[derive(Clone, Copy, Debug)]
enum KindPair {
    VertexFace,
    EdgeEdge,
    EdgeFace,
}

/// Kinds of pairs that may come near each other.
const NEAR: [KindPair; 2] = [KindPair::VertexFace, KindPair::EdgeEdge];

/// Kinds of pairs that may cross.
const CROSSING: [KindPair; 1] = [KindPair::EdgeFace];

/// Pairs of features whose boxes overlap. Pairs of one leaf share no vertex; pairs of two leaves may.
#[derive(Clone, Debug, Default)]
pub struct Hits {
    /// Pairs of a vertex and a face.
    pub vertex_face: Vec<[u32; 2]>,
    /// Pairs of two edges.
    pub edge_edge: Vec<[u32; 2]>,
    /// Pairs of an edge and a face.
    pub edge_face: Vec<[u32; 2]>,
}

/// Features of all leaves, with their boxes as last fitted. Coordinates are relative to an origin at the cloth.
#[derive(Clone, Debug, Default)]
pub struct LeafAabbs {
    vertices: FeatureBlocks,
    edges: FeatureBlocks,
    faces: FeatureBlocks,
    /// Features of its own leaf that a feature is tested against, as bits: of each vertex the faces, of each edge the
    /// edges, and of each edge the faces.
    tests_within_leaf: [Vec<u64>; 3],
    /// Box of every leaf.
    leaf_boxes: Vec<Aabb>,
    /// Box of the trajectory of every vertex.
    swept: Vec<Aabb>,
    /// Length by which one box is shrunk to undo the margins of both in a test for crossings (m).
    margins: f32,
    /// Bound of the rounding error of a coordinate in single precision (m).
    rounding: f64,
}

/// Vertices of the edges and triangles.
#[derive(Clone, Copy)]
pub struct Corners<'a> {
    /// Ends of the edges.
    pub edges: &'a [[u32; 2]],
    /// Corners of the triangles.
    pub triangles: &'a [[u32; 3]],
}

/// Bound of the error of a coordinate after a few sums in single precision, as a share of the largest coordinate.
const ROUNDING: f64 = 8.0 * f32::EPSILON as f64;

/// Origin for coordinates in single precision: the first vertex whose coordinates are finite (m).
pub(super) fn origin(x: &[Vec3]) -> Vec3 {
    let is_finite = |p: &&Vec3| p.iter().all(|c| c.is_finite());
    x.iter().find(is_finite).copied().unwrap_or_default()
}

/// A test of the features of two leaves, or of one leaf given twice. It is a type since a closure would not be compiled
/// for the processor's vector instructions.
struct LeafTest<'a> {
    leaves: &'a LeafAabbs,
    kinds: &'a [KindPair],
    pair: [u32; 2],
    /// Length by which one of two boxes is shrunk, negative to enlarge it (m).
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
    /// Whether there are no pairs.
    pub fn is_empty(&self) -> bool {
        let all = [&self.vertex_face, &self.edge_edge, &self.edge_face];
        all.iter().all(|hits| hits.is_empty())
    }

    /// Adds the pairs of another.
    pub fn append(&mut self, other: &Self) {
        self.vertex_face.extend_from_slice(&other.vertex_face);
        self.edge_edge.extend_from_slice(&other.edge_edge);
        self.edge_face.extend_from_slice(&other.edge_face);
    }

    /// Removes all pairs.
    pub fn clear(&mut self) {
        self.vertex_face.clear();
        self.edge_edge.clear();
        self.edge_face.clear();
    }
}

impl LeafAabbs {
    /// Boxes for the leaves of a tree, not fitted yet. Every vertex and every edge is in the leaf of the triangle that
    /// owns it.
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
        let by_leaf = |owners: &[u32]| {
            let mut lists = vec![Vec::new(); faces.len()];
            for (feature, &owner) in owners.iter().enumerate() {
                if owner != NONE {
                    lists[leaf_of[owner as usize]].push(feature as u32);
                }
            }
            FeatureBlocks::new(lists.iter())
        };
        let [vertices, edges] = [vertex_owners, edge_owners].map(by_leaf);
        let leaf_boxes = vec![EMPTY; faces.len()];
        let faces = FeatureBlocks::new(faces.iter());
        let face = |t: u32| corners.triangles[t as usize];
        let edge = |e: u32| corners.edges[e as usize];
        let tests_within_leaf = [
            vertices.tests_within_leaf(&faces, |v, t| !face(t).contains(&v)),
            edges.tests_within_leaf(&edges, |e, f| {
                e < f && !edge(e).iter().any(|v| edge(f).contains(v))
            }),
            edges.tests_within_leaf(&faces, |e, t| !edge(e).iter().any(|v| face(t).contains(v))),
        ];
        Self {
            vertices,
            edges,
            faces,
            tests_within_leaf,
            leaf_boxes,
            ..Self::default()
        }
    }

    /// Fits all boxes to the trajectories of the vertices, enlarged by `margin` (m).
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
        let coordinates = self
            .leaf_boxes
            .iter()
            .flat_map(|aabb| aabb.low.into_iter().chain(aabb.high));
        let largest = coordinates.fold(0.0, |largest: f32, c| largest.max(c.abs()));
        self.rounding = ROUNDING * f64::from(largest);
        self.margins = (2.0 * margin - self.rounding).max(0.0) as f32;
    }

    /// Fits the boxes of some leaves to the trajectories of their vertices, without a margin. Boxes of other leaves are
    /// then not valid.
    pub fn fit_some(
        &mut self,
        trajectories: &LinearTrajectories,
        corners: Corners,
        leaves: &[u32],
    ) {
        if 2 * leaves.len() > self.leaf_boxes.len() {
            // To fit all of them in parallel takes no longer.
            self.fit(trajectories, corners, 0.0);
            return;
        }
        let origin = origin(trajectories.from);
        self.swept.resize(trajectories.from.len(), EMPTY);
        let mut largest = 0.0f64;
        for &leaf in leaves {
            for block in self.faces.blocks_of(leaf) {
                let faces = self.faces.features[block].iter().filter(|t| **t != NONE);
                for v in faces.flat_map(|&t| corners.triangles[t as usize]) {
                    let ends = [trajectories.from, trajectories.to];
                    let [from, to] = ends.map(|x| x[v as usize] - origin);
                    largest = largest.max(from.amax()).max(to.amax());
                    self.swept[v as usize] = Aabb::swept(from, to, 0.0);
                }
            }
            // The trajectories of all vertices of its edges are swept: each edge of a leaf belongs to one of its faces.
            self.vertices.fit_leaf(leaf, &self.swept, |v| [v]);
            self.edges
                .fit_leaf(leaf, &self.swept, |e| corners.edges[e as usize]);
            self.faces
                .fit_leaf(leaf, &self.swept, |t| corners.triangles[t as usize]);
            self.leaf_boxes[leaf as usize] = self.box_of(leaf as usize);
        }
        self.rounding = ROUNDING * largest;
        self.margins = 0.0;
    }

    /// Box of all faces of a leaf.
    fn box_of(&self, leaf: usize) -> Aabb {
        let blocks = &self.faces.blocks[self.faces.blocks_of(leaf as u32)];
        let aabbs = blocks
            .iter()
            .flat_map(|block| (0..LANES).map(|lane| block.get(lane)));
        aabbs.fold(EMPTY, |joined, aabb| joined.join(&aabb))
    }

    /// Box of a leaf, relative to an origin that is the same for all leaves (m).
    pub fn bounds(&self, leaf: usize) -> Bounds {
        let Aabb { low, high } = self.leaf_boxes[leaf];
        Bounds {
            low: low.map(f64::from),
            high: high.map(f64::from),
        }
    }

    /// Adds to `hits` the pairs of a vertex and a face and of two edges whose boxes come within a distance of each
    /// other (m). The features are those of two leaves, or of one leaf given twice.
    pub fn near_within(&self, arch: Arch, pair: [u32; 2], distance: f64, hits: &mut Hits) {
        self.test(arch, &NEAR, (pair, self.enlarged(distance)), hits);
    }

    /// [`Self::near_within`] for pairs of an edge and a face.
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

    /// Negative shrinking that enlarges one box by a distance (m), rounded outwards.
    fn enlarged(&self, distance: f64) -> f32 {
        -((distance + self.rounding) as f32).next_up()
    }

    /// Adds to `hits` the pairs of an edge and a face, of two leaves or of one leaf given twice, whose trajectories may
    /// cross: their boxes overlap without the margins.
    pub fn crossing(&self, arch: Arch, pair: [u32; 2], hits: &mut Hits) {
        self.test(arch, &CROSSING, (pair, self.margins), hits);
    }

    /// Tests the features of the first leaf against those of the second.
    #[inline(always)]
    fn test_blocks(&self, kinds: KindPair, [a, b]: [u32; 2], shrink: f32, out: &mut Vec<[u32; 2]>) {
        let (first, second, within_leaf) = match kinds {
            KindPair::VertexFace => (&self.vertices, &self.faces, &self.tests_within_leaf[0]),
            KindPair::EdgeEdge => (&self.edges, &self.edges, &self.tests_within_leaf[1]),
            KindPair::EdgeFace => (&self.edges, &self.faces, &self.tests_within_leaf[2]),
        };
        let other_leaf = &self.leaf_boxes[b as usize];
        for index in first.blocks_of(a) {
            let (block, features) = (&first.blocks[index], &first.features[index]);
            for lane in lanes(block.overlapping(other_leaf, shrink)) {
                let aabb = block.get(lane);
                let tested = within_leaf[LANES * index + lane];
                for (k, other) in second.blocks_of(b).enumerate() {
                    let mut overlapping = second.blocks[other].overlapping(&aabb, shrink);
                    if a == b {
                        overlapping &= (tested >> (LANES * k)) as u32;
                    }
                    let found = &second.features[other];
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
    fn boxes_overlap_where_their_bounds_in_double_precision_do() {
        let mut numbers = Numbers(1);
        let mut point = |scale: f64| numbers.vector(0.5 * scale);
        let mut met = 0;
        for _ in 0..200 {
            let mut block =
                FeatureBlocks::new([(0..LANES as u32).collect()].iter()).blocks[0].clone();
            let segments: Vec<[Vec3; 2]> = (0..=LANES).map(|_| [point(1.0), point(1.0)]).collect();
            let aabb = |[from, to]: [Vec3; 2]| Aabb::swept(from, to, 0.0);
            for (lane, segment) in segments[..LANES].iter().enumerate() {
                block.set(lane, &aabb(*segment));
            }
            let bits = block.overlapping(&aabb(segments[LANES]), 0.0);
            let one = Bounds::of(&segments[LANES], 0.0);
            for (lane, segment) in segments[..LANES].iter().enumerate() {
                let meets = Bounds::of(segment, 0.0).meets(&one);
                assert_eq!(bits >> lane & 1 == 1, meets);
                met += usize::from(meets);
            }
            assert_eq!(lanes(bits).count(), bits.count_ones() as usize);
        }
        assert!(met > 100, "{met}");
        let empty = &FeatureBlocks::new([vec![7]].iter()).blocks[0];
        let all = Aabb {
            low: [f32::NEG_INFINITY; 3],
            high: [f32::INFINITY; 3],
        };
        assert_eq!(empty.overlapping(&all, 0.0), 0, "padding overlaps nothing");
    }
}
