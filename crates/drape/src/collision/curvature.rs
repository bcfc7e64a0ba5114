//! Curvature test: whether a region of cloth can touch itself (Volino and Magnenat-Thalmann 1994). It cannot where
//! all its triangles face one direction and its contour, projected along that direction, does not intersect itself.
//!
//! Projected along v all triangles are oriented alike, so a point of the plane is covered by as many of them as the
//! winding number of the contour round it. A connected contour that does not intersect itself has winding numbers 0
//! and 1 alone: the projection covers no point twice, and the region is a graph over the plane.

use super::boxes::{BoxTree, Node, Region};
use crate::merge_map;
use pulp::{Arch, NullaryFnOnce};
use std::sync::LazyLock;
use toile_geometry::Vec3;

/// What regions that are left out of a search must guarantee.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Least distance of two features without a common vertex (m). At vertices with short edges it is limited to
    /// the contact offset that there is room for.
    pub offset: f64,
    /// Drift (m), which is deviation from a common rigid motion summed over queries, within which the guarantee
    /// holds; beyond, a region is tested again. Regions that deviate more in a single query are tested for twice or
    /// four times this drift.
    pub max_drift: f64,
}

/// Number of drift limits that regions are tested for.
pub const LEVELS: usize = 3;

impl Clearance {
    /// Drift within which a test at this level holds (m).
    pub fn max_drift_at(&self, level: usize) -> f64 {
        self.max_drift * f64::from(1u32 << level)
    }

    /// Lowest level whose test holds for this deviation (m) from the common rigid motion; none where it is larger
    /// than that of all levels.
    pub fn level(&self, deviation: f64) -> Option<usize> {
        (0..LEVELS).find(|&level| deviation <= self.max_drift_at(level))
    }
}

/// Number of directions that regions are tested to face: the bits of a mask.
const DIRECTIONS: usize = 64;

/// Least cosine between a triangle's normal and the direction that it faces: 75 degrees. A triangle seen at a larger
/// angle is narrower than the offset.
const MIN_COSINE: f64 = 0.258_819_045_102_520_76;

/// Least number of leaves of a region that is tested. To search a smaller one costs less than the test.
pub const MIN_LEAVES: u32 = 4;

/// Bound of the error of a cosine in single precision.
const COSINE_ERROR: f64 = 1e-6;

/// Bound of the error of a distance (m).
const DISTANCE_ERROR: f64 = 1e-9;

/// Half-edge of a triangle: twice the index of the edge, plus one where the triangle runs along it from the larger
/// vertex to the smaller.
type HalfEdge = u32;

/// Contours of the tree's nodes, and the directions that the nodes face at the positions of the last search.
#[derive(Clone, Debug, Default)]
pub struct Curvature {
    /// Triangles at an edge that has more than two triangles, or two of opposite orientation. Regions with one
    /// never pass the test.
    irregular: Vec<bool>,
    /// Contours of the nodes, each sorted, node after node; start of each node in that list, and its end.
    contours: Vec<HalfEdge>,
    starts: Vec<u32>,
    /// For every level, bits of the directions that all triangles of a node face.
    facing: [Vec<u64>; LEVELS],
    clearance: Option<Clearance>,
    /// Distance to be guaranteed at each vertex (m).
    offsets: Vec<f64>,
}

/// Evenly distributed directions, along a spiral on the sphere (Saff and Kuijlaars 1997), coordinate by coordinate.
static SPIRAL: LazyLock<[[f32; DIRECTIONS]; 3]> = LazyLock::new(|| {
    let golden = std::f64::consts::PI * (3.0 - 5.0f64.sqrt());
    let direction = |k: usize| {
        let y = 1.0 - (2 * k + 1) as f64 / DIRECTIONS as f64;
        let (radius, angle) = ((1.0 - y * y).sqrt(), golden * k as f64);
        [radius * angle.cos(), y, radius * angle.sin()]
    };
    [0, 1, 2].map(|axis| std::array::from_fn(|k| direction(k)[axis] as f32))
});

/// Bits of the directions whose cosine with a unit normal is larger than `cosine`.
#[inline(always)]
fn directions_within(directions: &[[f32; DIRECTIONS]; 3], normal: [f32; 3], cosine: f32) -> u64 {
    let mut bits = 0u64;
    for block in 0..DIRECTIONS / 16 {
        let mut block_bits = 0u32;
        for lane in 0..16 {
            let [x, y, z] = [0, 1, 2].map(|k| directions[k][16 * block + lane]);
            let along = x * normal[0] + y * normal[1] + z * normal[2];
            block_bits |= u32::from(along > cosine) << lane;
        }
        bits |= u64::from(block_bits) << (16 * block);
    }
    bits
}

impl Curvature {
    /// Computes the contours of the nodes of a tree over triangles; `edges` have their smaller vertex first.
    pub fn new(
        tree: &BoxTree,
        triangles: &[[u32; 3]],
        edges: &[[u32; 2]],
        edge_triangles: &[Vec<u32>],
    ) -> Self {
        let mut irregular = vec![false; triangles.len()];
        let mut half_edges = vec![Vec::with_capacity(3); triangles.len()];
        for (e, (&[a, b], at)) in edges.iter().zip(edge_triangles).enumerate() {
            let backward = |t: u32| {
                let [p, q, r] = triangles[t as usize];
                ![(p, q), (q, r), (r, p)].contains(&(a, b))
            };
            let is_irregular = at.len() > 2 || at.len() == 2 && backward(at[0]) == backward(at[1]);
            for &t in at {
                irregular[t as usize] |= is_irregular;
                half_edges[t as usize].push(2 * e as HalfEdge + HalfEdge::from(backward(t)));
            }
        }
        let nodes = tree.nodes();
        let mut of_node: Vec<Vec<HalfEdge>> = vec![Vec::new(); nodes.len()];
        for node in nodes.iter().rev() {
            let index = node.index as usize;
            of_node[index] = match node.children() {
                None => {
                    let items = tree.items(node.first_leaf as usize).iter();
                    let of_item = |&t: &u32| {
                        let mut own = half_edges[t as usize].clone();
                        own.sort_unstable();
                        own
                    };
                    items
                        .map(of_item)
                        .fold(Vec::new(), |a, b| joined_contour(&a, &b))
                }
                Some([left, right]) => {
                    let [left, right] = [left, right].map(|child| &of_node[child.index as usize]);
                    joined_contour(left, right)
                }
            };
        }
        let mut starts = vec![0];
        for contour in &of_node {
            starts.push(starts[starts.len() - 1] + contour.len() as u32);
        }
        Self {
            irregular,
            contours: of_node.concat(),
            starts,
            facing: [const { Vec::new() }; LEVELS],
            clearance: None,
            offsets: Vec::new(),
        }
    }

    /// Sets the clearance of the tests that follow, whose offset is limited at each vertex to `max_offsets` (m).
    pub fn set_clearance(&mut self, max_offsets: impl Iterator<Item = f64>, clearance: Clearance) {
        if self.clearance == Some(clearance) {
            return;
        }
        self.offsets.clear();
        self.offsets
            .extend(max_offsets.map(|limit| limit.min(clearance.offset)));
        self.clearance = Some(clearance);
    }

    /// Computes the directions that the nodes of some regions, and all nodes below them, face at positions `x` (m),
    /// at the level of each region and all lower levels.
    pub fn find_facing(
        &mut self,
        tree: &BoxTree,
        triangles: &[[u32; 3]],
        x: &[Vec3],
        regions: &[(Region, usize)],
    ) {
        let Some(clearance) = self.clearance else {
            return;
        };
        for level in 0..LEVELS {
            // Differences of the number of regions that a leaf is in, then that number.
            let mut region_count = vec![0i32; tree.leaves() + 1];
            let at_level = regions.iter().filter(|(_, lowest)| *lowest >= level);
            let mut none = true;
            for node in at_level.flat_map(|(region, _)| region.nodes()) {
                region_count[node.first_leaf as usize] += 1;
                region_count[(node.first_leaf + node.leaf_count) as usize] -= 1;
                none = false;
            }
            if none {
                self.facing[level].clear();
                continue;
            }
            for leaf in 0..tree.leaves() {
                region_count[leaf + 1] += region_count[leaf];
            }
            let (irregular, offsets, directions) = (&*self.irregular, &*self.offsets, &*SPIRAL);
            let (arch, drift) = (Arch::new(), clearance.max_drift_at(level));
            let facing = |leaf: usize| match region_count[leaf] {
                0 => 0,
                _ => arch.dispatch(CommonDirections {
                    items: tree.items(leaf),
                    triangles,
                    x,
                    irregular,
                    offsets,
                    directions,
                    drift,
                }),
            };
            self.facing[level] = tree.reduced(facing, |a, b| a & b);
        }
    }

    fn contour(&self, node: Node) -> &[HalfEdge] {
        let index = node.index as usize;
        &self.contours[self.starts[index] as usize..self.starts[index + 1] as usize]
    }

    /// Whether a region passes the curvature test at a level that [`Curvature::find_facing`] was called for: then no
    /// two of its features without a common vertex come nearer than the clearance within the drift of the level. A
    /// region that is not shown to pass fails.
    pub fn is_clear(&self, edges: &[[u32; 2]], x: &[Vec3], region: &Region, level: usize) -> bool {
        let of_node = |node: Node| self.facing[level].get(node.index as usize).copied();
        let facing = region
            .nodes()
            .fold(u64::MAX, |facing, node| facing & of_node(node).unwrap_or(0));
        let Some(clearance) = self.clearance else {
            return false;
        };
        if facing == 0 || region.leaf_count() < MIN_LEAVES {
            return false;
        }
        let bits = (0..DIRECTIONS).filter(|k| facing >> k & 1 == 1);
        // A triangle that faces each of some directions also faces their mean: they form a convex cone.
        let direction = |k: usize| Vec3::from([0, 1, 2].map(|axis| f64::from(SPIRAL[axis][k])));
        let mean: Vec3 = bits.map(direction).sum();
        let Some(view) = mean.try_normalize(0.0) else {
            return false;
        };
        let half_edges = match *region {
            Region::Own(a) => self.contour(a).to_vec(),
            Region::Two(a, b) => {
                let (a, b) = (self.contour(a), self.contour(b));
                let joined = joined_contour(a, b);
                if joined.len() == a.len() + b.len() {
                    // The two nodes share no edge; most often they are two plies.
                    return false;
                }
                joined
            }
        };
        let contour = ProjectedContour::new(&half_edges, edges, &self.offsets, (x, view));
        contour.is_connected()
            && contour.edges_alternate()
            && contour.is_clear(clearance.offset, clearance.max_drift_at(level))
    }
}

/// Contour of two regions together: edges on both contours are inside and drop out.
fn joined_contour(a: &[HalfEdge], b: &[HalfEdge]) -> Vec<HalfEdge> {
    let mut joined = Vec::with_capacity(a.len() + b.len());
    let (mut i, mut j) = (0, 0);
    while i < a.len() && j < b.len() {
        match (a[i] / 2).cmp(&(b[j] / 2)) {
            std::cmp::Ordering::Less => {
                joined.push(a[i]);
                i += 1;
            }
            std::cmp::Ordering::Greater => {
                joined.push(b[j]);
                j += 1;
            }
            std::cmp::Ordering::Equal => {
                i += 1;
                j += 1;
            }
        }
    }
    joined.extend_from_slice(&a[i..]);
    joined.extend_from_slice(&b[j..]);
    joined
}

/// Computes the directions that all triangles of a leaf face. It is a type since a closure would not be compiled for
/// the processor's vector instructions.
struct CommonDirections<'a> {
    items: &'a [u32],
    triangles: &'a [[u32; 3]],
    x: &'a [Vec3],
    irregular: &'a [bool],
    offsets: &'a [f64],
    directions: &'a [[f32; DIRECTIONS]; 3],
    /// Drift of the vertices (m).
    drift: f64,
}

impl NullaryFnOnce for CommonDirections<'_> {
    type Output = u64;

    #[inline(always)]
    fn call(self) -> u64 {
        let mut common = u64::MAX;
        for &t in self.items {
            if self.irregular[t as usize] {
                return 0;
            }
            let [a, b, c] = self.triangles[t as usize];
            let corners = [self.x[a as usize], self.x[b as usize], self.x[c as usize]];
            let offsets = [
                self.offsets[a as usize],
                self.offsets[b as usize],
                self.offsets[c as usize],
            ];
            common &= facing_directions(self.directions, &corners, &offsets, self.drift);
        }
        common
    }
}

/// Bits of the directions that a triangle faces, now and after any drift of its corners up to `drift` (m).
///
/// Its plane turns by at most sin(turn) = 2 drift / h, with h the smallest height: every direction in the plane
/// runs along a chord at least as long as h.
#[inline(always)]
fn facing_directions(
    directions: &[[f32; DIRECTIONS]; 3],
    [a, b, c]: &[Vec3; 3],
    offsets: &[f64; 3],
    drift: f64,
) -> u64 {
    let normal = (b - a).cross(&(c - a));
    let double_area = normal.norm();
    let heights = [b - c, c - a, a - b].map(|edge| double_area / edge.norm());
    let least = heights[0].min(heights[1]).min(heights[2]);
    let sine = 2.0 * drift / least;
    // The projection shortens a height by the cosine at most; the offset of its corner must remain.
    let remaining = heights.iter().zip(offsets);
    let remaining =
        remaining.map(|(height, offset)| (offset + DISTANCE_ERROR) / (height - 2.0 * drift));
    let cosine = remaining.fold(MIN_COSINE, |largest, cosine| {
        if cosine >= 0.0 {
            largest.max(cosine)
        } else {
            1.0
        }
    });
    let (sine_of_angle, cosine_of_turn) =
        ((1.0 - cosine * cosine).sqrt(), (1.0 - sine * sine).sqrt());
    // The angle must be larger than the turn; false for NaN.
    if !(cosine < 1.0 && sine < sine_of_angle) {
        return 0;
    }
    // cos(angle - turn)
    let cosine = cosine * cosine_of_turn + sine_of_angle * sine;
    let normal = normal / double_area;
    let normal = [0, 1, 2].map(|k| normal[k] as f32);
    directions_within(directions, normal, (cosine + COSINE_ERROR) as f32)
}

/// Contour of a region, projected along a direction.
struct ProjectedContour {
    /// Projected positions of its vertices (m).
    points: Vec<[f64; 2]>,
    /// Distance to be guaranteed at each vertex (m).
    offsets: Vec<f64>,
    /// Directed edges, the region on their left.
    edges: Vec<[u32; 2]>,
}

impl ProjectedContour {
    /// Projects a contour at positions `x` along the direction `view`.
    fn new(
        half_edges: &[HalfEdge],
        edges: &[[u32; 2]],
        offsets: &[f64],
        (x, view): (&[Vec3], Vec3),
    ) -> Self {
        let directed: Vec<[u32; 2]> = half_edges
            .iter()
            .map(|&half_edge| {
                let [a, b] = edges[half_edge as usize / 2];
                if half_edge % 2 == 0 { [a, b] } else { [b, a] }
            })
            .collect();
        // Every vertex of a contour is the start of one of its edges, and the end of one.
        let mut vertices: Vec<u32> = directed.iter().map(|edge| edge[0]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let [right, up] = image_axes(view);
        let local = |v: u32| vertices.partition_point(|&other| other < v) as u32;
        Self {
            edges: directed.iter().map(|edge| edge.map(local)).collect(),
            points: vertices
                .iter()
                .map(|&v| [right.dot(&x[v as usize]), up.dot(&x[v as usize])])
                .collect(),
            offsets: vertices.iter().map(|&v| offsets[v as usize]).collect(),
        }
    }

    /// Whether its edges form one connected graph.
    fn is_connected(&self) -> bool {
        merge_map(self.points.len(), self.edges.iter().copied()).1 == 1
    }

    /// Whether at every vertex that the contour passes more than once its edges, sorted by angle, leave and arrive
    /// in turn. Then the sectors of the region round that vertex lie side by side and do not overlap.
    fn edges_alternate(&self) -> bool {
        if self.edges.len() == self.points.len() {
            return true;
        }
        let mut leaving = vec![0; self.points.len()];
        for edge in &self.edges {
            leaving[edge[0] as usize] += 1;
        }
        let multiple = (0..self.points.len() as u32).filter(|&v| leaving[v as usize] > 1);
        // Vertex, angle, and whether the edge leaves it.
        let mut rays: Vec<(u32, f64, bool)> = Vec::new();
        for v in multiple {
            for &[a, b] in self.edges.iter().filter(|edge| edge.contains(&v)) {
                let other = self.points[if a == v { b } else { a } as usize];
                let own = self.points[v as usize];
                rays.push((v, (other[1] - own[1]).atan2(other[0] - own[0]), a == v));
            }
        }
        rays.sort_by(|p, q| p.0.cmp(&q.0).then(p.1.total_cmp(&q.1)));
        rays.chunk_by(|p, q| p.0 == q.0)
            .all(|round| (0..round.len()).all(|k| round[k].2 != round[(k + 1) % round.len()].2))
    }

    /// Whether, within a drift of the vertices (m), no vertex comes nearer than its offset to an edge that does not
    /// end at it, and no two edges cross. `max_offset` is the largest offset of a vertex (m). Pairs of edges are
    /// found by sweeping along the longer axis.
    fn is_clear(&self, max_offset: f64, drift: f64) -> bool {
        let margin = max_offset + 2.0 * drift + DISTANCE_ERROR;
        let range = |k: usize, axis: usize| {
            let [a, b] = self.edges[k].map(|v| self.points[v as usize][axis]);
            [a.min(b), a.max(b)]
        };
        let axis = usize::from(self.extent(1) > self.extent(0));
        let mut order: Vec<(f64, usize)> = (0..self.edges.len())
            .map(|k| (range(k, axis)[0], k))
            .collect();
        order.sort_unstable_by(|p, q| p.0.total_cmp(&q.0));
        for (n, &(_, k)) in order.iter().enumerate() {
            let (high, [low_across, high_across]) = (range(k, axis)[1], range(k, 1 - axis));
            for &(low, other) in &order[n + 1..] {
                if low > high + margin {
                    break;
                }
                let [low, high] = range(other, 1 - axis);
                let separated = low > high_across + margin || low_across > high + margin;
                if !separated && !self.edges_are_clear([k, other], drift) {
                    return false;
                }
            }
        }
        true
    }

    /// Extent along an axis (m).
    fn extent(&self, axis: usize) -> f64 {
        let along = || self.points.iter().map(|point| point[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    }

    /// [`Self::is_clear`] for two edges.
    fn edges_are_clear(&self, pair: [usize; 2], drift: f64) -> bool {
        let [first, second] = pair.map(|k| self.edges[k]);
        for (edge, others) in [(first, second), (second, first)] {
            let [a, b] = edge.map(|v| self.points[v as usize]);
            for v in others.into_iter().filter(|v| !edge.contains(v)) {
                let least = self.offsets[v as usize] + 2.0 * drift + DISTANCE_ERROR;
                let is_far = squared_distance(self.points[v as usize], [a, b]) > least * least;
                if !is_far {
                    return false;
                }
            }
        }
        let [a, b, c, d] =
            [first[0], first[1], second[0], second[1]].map(|v| self.points[v as usize]);
        let adjacent = first.iter().any(|v| second.contains(v));
        adjacent || !(line_separates(a, b, c, d) && line_separates(c, d, a, b))
    }
}

/// Axes of the plane across a unit vector: with it as the third they are orthonormal and right-handed.
fn image_axes(view: Vec3) -> [Vec3; 2] {
    let smallest = view.iamin();
    let mut axis = Vec3::zeros();
    axis[smallest] = 1.0;
    let right = (axis - view * view[smallest]).normalize();
    [right, view.cross(&right)]
}

/// Whether c and d are on different sides of the line through a and b.
fn line_separates(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    let side = |p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    (side(c) > 0.0) != (side(d) > 0.0)
}

/// Squared distance of a point from a segment (m2).
fn squared_distance(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let to = [p[0] - a[0], p[1] - a[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let share = ((to[0] * along[0] + to[1] * along[1]) / length).clamp(0.0, 1.0);
    let across = [to[0] - along[0] * share, to[1] - along[1] * share];
    across[0] * across[0] + across[1] * across[1]
}
