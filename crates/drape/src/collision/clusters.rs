//! Features of the cloth in clusters of neighbours, each with its box: those of two clusters are held
//! against each other sixteen at a time, in single precision rounded outward.

use super::boxes::{Bounds, BoxTree, CLUSTER};
use super::trajectories::LinearTrajectories;
use crate::lanes::LANES;
use pulp::{Arch, NullaryFnOnce};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// No feature.
const NONE: u32 = u32::MAX;

// The features of a cluster, three edges a triangle at the most, have a bit each.
const _: () = assert!(3 * CLUSTER <= u64::BITS as usize);

/// A box along the axes [m].
#[derive(Clone, Copy, Debug)]
struct Slab {
    low: [f32; 3],
    high: [f32; 3],
}

/// Round nothing.
const NOTHING: Slab = Slab {
    low: [f32::INFINITY; 3],
    high: [f32::NEG_INFINITY; 3],
};

/// Where there is no feature: it meets no box, and nothing is larger with it than without.
const NO_BOX: [f32; LANES] = [f32::NAN; LANES];

impl Slab {
    /// Round the way of a vertex, with a margin [m].
    fn of_way(from: Vec3, to: Vec3, margin: f64) -> Self {
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
    fn set(&mut self, lane: usize, slab: &Slab) {
        for k in 0..3 {
            self.low[k][lane] = slab.low[k];
            self.high[k][lane] = slab.high[k];
        }
    }

    /// Fits the boxes of some features; `corners` gives the vertices of one.
    fn fit<const N: usize>(
        &mut self,
        features: &[u32; LANES],
        ways: &[Slab],
        corners: impl Fn(u32) -> [u32; N],
    ) {
        for (lane, &feature) in features.iter().enumerate() {
            if feature != NONE {
                let ways = corners(feature).map(|v| ways[v as usize]);
                self.set(
                    lane,
                    &ways.iter().fold(NOTHING, |round, way| round.join(way)),
                );
            }
        }
    }

    fn get(&self, lane: usize) -> Slab {
        Slab {
            low: [0, 1, 2].map(|k| self.low[k][lane]),
            high: [0, 1, 2].map(|k| self.high[k][lane]),
        }
    }

    /// Which boxes meet another one that is made smaller all round by `less` [m], as bits.
    #[inline(always)]
    fn meeting(&self, one: &Slab, less: f32) -> u32 {
        let mut bits = 0u32;
        for lane in 0..LANES {
            let mut meets = true;
            for k in 0..3 {
                meets &= one.low[k] + less <= self.high[k][lane];
                meets &= self.low[k][lane] <= one.high[k] - less;
            }
            bits |= u32::from(meets) << lane;
        }
        bits
    }
}

/// The lanes that some bits name.
fn lanes(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (lane < u32::BITS).then_some(lane as usize)
    })
}

/// Features of one kind, cluster after cluster.
#[derive(Clone, Debug, Default)]
struct Kind {
    /// The features of every block; [`NONE`] where a cluster's last block is not full.
    features: Vec<[u32; LANES]>,
    blocks: Vec<Block>,
    /// First block of every cluster, and the end.
    starts: Vec<u32>,
}

impl Kind {
    /// Of the features of every cluster.
    fn new<'a>(clusters: impl Iterator<Item = &'a Vec<u32>>) -> Self {
        let mut kind = Self {
            starts: vec![0],
            ..Self::default()
        };
        for features in clusters {
            for some in features.chunks(LANES) {
                let mut block = [NONE; LANES];
                block[..some.len()].copy_from_slice(some);
                kind.features.push(block);
            }
            kind.starts.push(kind.features.len() as u32);
        }
        let empty = Block {
            low: [NO_BOX; 3],
            high: [NO_BOX; 3],
        };
        kind.blocks = vec![empty; kind.features.len()];
        kind
    }

    /// Fits all boxes; `corners` gives the vertices of a feature.
    fn fit<const N: usize>(&mut self, ways: &[Slab], corners: impl Fn(u32) -> [u32; N] + Sync) {
        let all = self.blocks.par_iter_mut().with_min_len(64);
        all.zip(&self.features)
            .for_each(|(block, features)| block.fit(features, ways, &corners));
    }

    /// [`Self::fit`] for the boxes of a cluster.
    fn fit_one<const N: usize>(
        &mut self,
        cluster: u32,
        ways: &[Slab],
        corners: impl Fn(u32) -> [u32; N],
    ) {
        for at in self.of(cluster) {
            self.blocks[at].fit(&self.features[at], ways, &corners);
        }
    }

    /// For each place, the features of another kind in the same cluster that `against` says yes to.
    fn each_own(&self, other: &Self, against: impl Fn(u32, u32) -> bool) -> Vec<u64> {
        let mut own = vec![0; LANES * self.features.len()];
        for cluster in 0..self.starts.len().saturating_sub(1) as u32 {
            let others = other.features[other.of(cluster)]
                .iter()
                .flatten()
                .enumerate();
            let others = others.filter(|(_, feature)| **feature != NONE);
            for at in self.of(cluster) {
                for (lane, &one) in self.features[at].iter().enumerate() {
                    if one != NONE {
                        let wanted = others.clone().filter(|(_, other)| against(one, **other));
                        own[LANES * at + lane] =
                            wanted.fold(0, |bits, (place, _)| bits | 1 << place);
                    }
                }
            }
        }
        own
    }

    fn of(&self, cluster: u32) -> std::ops::Range<usize> {
        self.starts[cluster as usize] as usize..self.starts[cluster as usize + 1] as usize
    }
}

/// Which kinds of features are held against which.
#[derive(Clone, Copy, Debug)]
enum Against {
    VertexFace,
    EdgeEdge,
    EdgeFace,
}

/// What may come near.
const NEAR: [Against; 2] = [Against::VertexFace, Against::EdgeEdge];

/// What may cross.
const CROSSING: [Against; 1] = [Against::EdgeFace];

/// Features near each other; those of one cluster share no vertex.
#[derive(Clone, Debug, Default)]
pub struct Hits {
    /// A vertex and a face.
    pub vertex_face: Vec<[u32; 2]>,
    /// Two edges.
    pub edge_edge: Vec<[u32; 2]>,
    /// An edge and a face.
    pub edge_face: Vec<[u32; 2]>,
}

/// The features of all clusters, with their boxes as last fitted.
#[derive(Clone, Debug, Default)]
pub struct Clusters {
    vertices: Kind,
    edges: Kind,
    faces: Kind,
    /// Which features of its own cluster one is held against, as bits: for each place of a vertex against
    /// faces, and for each place of an edge against edges and against faces.
    own: [Vec<u64>; 3],
    /// Round everything of a cluster.
    round: Vec<Slab>,
    ways: Vec<Slab>,
    /// By how much boxes may be made smaller again before two are held against each other [m].
    slack: f32,
    /// By how much single precision is off [m].
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

/// What single precision counts from: a vertex whose place is known [m].
pub(super) fn origin(x: &[Vec3]) -> Vec3 {
    let known = |p: &&Vec3| p.iter().all(|c| c.is_finite());
    x.iter().find(known).copied().unwrap_or_default()
}

/// Features of two clusters, or of one, to be held against each other. A type of its own, since a closure would
/// not be compiled for the processor's vectors.
struct Hold<'a> {
    clusters: &'a Clusters,
    kinds: &'a [Against],
    pair: [u32; 2],
    /// By how much boxes are made smaller [m].
    less: f32,
    hits: &'a mut Hits,
}

impl NullaryFnOnce for Hold<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let [a, b] = self.pair;
        for &against in self.kinds {
            let (hits, both_ways) = match against {
                Against::VertexFace => (&mut self.hits.vertex_face, a != b),
                Against::EdgeEdge => (&mut self.hits.edge_edge, false),
                Against::EdgeFace => (&mut self.hits.edge_face, a != b),
            };
            self.clusters.meet(against, [a, b], self.less, hits);
            if both_ways {
                self.clusters.meet(against, [b, a], self.less, hits);
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

impl Clusters {
    /// Clusters as a tree has them; every vertex and every edge is in the cluster of the triangle that
    /// cares for it.
    pub fn new(
        tree: &BoxTree,
        [vertex_owners, edge_owners]: [&[u32]; 2],
        corners: Corners,
    ) -> Self {
        let faces: Vec<Vec<u32>> = (0..tree.leaves())
            .map(|leaf| tree.items(leaf).to_vec())
            .collect();
        let mut cluster = vec![0; faces.iter().map(Vec::len).sum()];
        for (leaf, items) in faces.iter().enumerate() {
            for &t in items {
                cluster[t as usize] = leaf;
            }
        }
        let of = |owners: &[u32]| {
            let mut lists = vec![Vec::new(); faces.len()];
            for (feature, &owner) in owners.iter().enumerate() {
                if owner != NONE {
                    lists[cluster[owner as usize]].push(feature as u32);
                }
            }
            Kind::new(lists.iter())
        };
        let [vertices, edges] = [of(vertex_owners), of(edge_owners)];
        let round = vec![NOTHING; faces.len()];
        let faces = Kind::new(faces.iter());
        let face = |t: u32| corners.triangles[t as usize];
        let edge = |e: u32| corners.edges[e as usize];
        let own = [
            vertices.each_own(&faces, |v, t| !face(t).contains(&v)),
            edges.each_own(&edges, |e, f| {
                e < f && !edge(e).iter().any(|v| edge(f).contains(v))
            }),
            edges.each_own(&faces, |e, t| !edge(e).iter().any(|v| face(t).contains(v))),
        ];
        Self {
            vertices,
            edges,
            faces,
            own,
            round,
            ..Self::default()
        }
    }

    /// Fits all boxes round the ways of the vertices, with a margin [m].
    pub fn fit(&mut self, ways: &LinearTrajectories, corners: Corners, margin: f64) {
        let origin = origin(ways.from);
        let both = ways.from.par_iter().zip(ways.to).with_min_len(1024);
        both.map(|(from, to)| Slab::of_way(from - origin, to - origin, margin))
            .collect_into_vec(&mut self.ways);
        self.vertices.fit(&self.ways, |v| [v]);
        self.edges.fit(&self.ways, |e| corners.edges[e as usize]);
        self.faces
            .fit(&self.ways, |t| corners.triangles[t as usize]);
        for cluster in 0..self.round.len() {
            self.round[cluster] = self.round_of(cluster);
        }
        let ends = self
            .round
            .iter()
            .flat_map(|round| round.low.into_iter().chain(round.high));
        let farthest = f64::from(ends.fold(0.0, |most: f32, end| most.max(end.abs())));
        self.rounding = ROUNDING * farthest;
        // The margin is of both boxes.
        self.slack = (2.0 * margin - self.rounding).max(0.0) as f32;
    }

    /// Fits the boxes of some clusters round the ways of their vertices, without a margin.
    pub fn fit_some(&mut self, ways: &LinearTrajectories, corners: Corners, clusters: &[u32]) {
        if 2 * clusters.len() > self.round.len() {
            // All of them side by side take no longer.
            self.fit(ways, corners, 0.0);
            return;
        }
        let origin = origin(ways.from);
        self.ways.resize(ways.from.len(), NOTHING);
        let mut farthest = 0.0f64;
        for &cluster in clusters {
            for at in self.faces.of(cluster) {
                let faces = self.faces.features[at].iter().filter(|t| **t != NONE);
                for v in faces.flat_map(|&t| corners.triangles[t as usize]) {
                    let [from, to] = [ways.from, ways.to].map(|x| x[v as usize] - origin);
                    farthest = farthest.max(from.amax()).max(to.amax());
                    self.ways[v as usize] = Slab::of_way(from, to, 0.0);
                }
            }
            // Every edge and vertex of a cluster is one of its faces'.
            self.vertices.fit_one(cluster, &self.ways, |v| [v]);
            self.edges
                .fit_one(cluster, &self.ways, |e| corners.edges[e as usize]);
            self.faces
                .fit_one(cluster, &self.ways, |t| corners.triangles[t as usize]);
            self.round[cluster as usize] = self.round_of(cluster as usize);
        }
        self.rounding = ROUNDING * farthest;
        self.slack = 0.0;
    }

    /// The box round everything of a cluster.
    fn round_of(&self, cluster: usize) -> Slab {
        let blocks = &self.faces.blocks[self.faces.of(cluster as u32)];
        let all = blocks
            .iter()
            .flat_map(|block| (0..LANES).map(|lane| block.get(lane)));
        all.fold(NOTHING, |round, slab| round.join(&slab))
    }

    /// The box of a cluster, from an origin that is the same for all [m].
    pub fn bounds(&self, cluster: usize) -> Bounds {
        let Slab { low, high } = self.round[cluster];
        Bounds {
            low: low.map(f64::from),
            high: high.map(f64::from),
        }
    }

    /// Vertices and faces, and edges, whose boxes come within a distance of each other [m], and some more, of
    /// two clusters or one.
    pub fn near_within(&self, arch: Arch, pair: [u32; 2], distance: f64, hits: &mut Hits) {
        self.hold(arch, &NEAR, (pair, self.wider(distance)), hits);
    }

    /// The same of edges and faces.
    pub fn piercing_within(&self, arch: Arch, pair: [u32; 2], distance: f64, hits: &mut Hits) {
        self.hold(arch, &CROSSING, (pair, self.wider(distance)), hits);
    }

    fn hold(&self, arch: Arch, kinds: &[Against], (pair, less): ([u32; 2], f32), hits: &mut Hits) {
        arch.dispatch(Hold {
            clusters: self,
            kinds,
            pair,
            less,
            hits,
        });
    }

    fn wider(&self, distance: f64) -> f32 {
        -((distance + self.rounding) as f32).next_up()
    }

    /// Edges and faces whose ways meet, of two clusters or one.
    pub fn crossing(&self, arch: Arch, pair: [u32; 2], hits: &mut Hits) {
        self.hold(arch, &CROSSING, (pair, self.slack), hits);
    }

    /// Holds features of the first cluster against those of the second.
    #[inline(always)]
    fn meet(&self, against: Against, [a, b]: [u32; 2], less: f32, out: &mut Vec<[u32; 2]>) {
        let (first, second, own) = match against {
            Against::VertexFace => (&self.vertices, &self.faces, &self.own[0]),
            Against::EdgeEdge => (&self.edges, &self.edges, &self.own[1]),
            Against::EdgeFace => (&self.edges, &self.faces, &self.own[2]),
        };
        let round = &self.round[b as usize];
        for at in first.of(a) {
            let (block, features) = (&first.blocks[at], &first.features[at]);
            for lane in lanes(block.meeting(round, less)) {
                let one = block.get(lane);
                let wanted = own[LANES * at + lane];
                for (k, at) in second.of(b).enumerate() {
                    let mut meeting = second.blocks[at].meeting(&one, less);
                    if a == b {
                        meeting &= (wanted >> (LANES * k)) as u32;
                    }
                    let found = &second.features[at];
                    out.extend(lanes(meeting).map(|other| [features[lane], found[other]]));
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
            let slab = |[from, to]: [Vec3; 2]| Slab::of_way(from, to, 0.0);
            for (lane, way) in ways[..LANES].iter().enumerate() {
                block.set(lane, &slab(*way));
            }
            let bits = block.meeting(&slab(ways[LANES]), 0.0);
            let one = Bounds::round(&ways[LANES], 0.0);
            for (lane, way) in ways[..LANES].iter().enumerate() {
                let meets = Bounds::round(way, 0.0).meets(&one);
                assert_eq!(bits >> lane & 1 == 1, meets);
                met += usize::from(meets);
            }
            assert_eq!(lanes(bits).count(), bits.count_ones() as usize);
        }
        assert!(met > 100, "{met}");
        let empty = &Kind::new([vec![7]].iter()).blocks[0];
        let all = Slab {
            low: [f32::NEG_INFINITY; 3],
            high: [f32::INFINITY; 3],
        };
        assert_eq!(
            empty.meeting(&all, 0.0),
            0,
            "what is not there meets nothing"
        );
    }
}
