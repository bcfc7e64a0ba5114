//! Regions of cloth that cannot touch themselves: they face one way, and their contour seen that way
//! keeps clear of itself (Volino and Magnenat-Thalmann 1994). Such a region lies over the plane it
//! faces like a map, every point over another one.
//!
//! Seen along v, all triangles turn the same way, so a point of the plane lies under as many of them as
//! the contour winds round it. Where the contour is one connected line that does not cross itself, it
//! winds round no point twice.

use super::boxes::{BoxTree, Node, Region};
use crate::merge_map;
use pulp::{Arch, NullaryFnOnce};
use std::sync::LazyLock;
use toile_geometry::Vec3;

/// What a region must keep to be left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Distance that two features without a common vertex keep all that time, as far as there is
    /// room at them [m].
    pub kept: f64,
    /// How far the vertices of a region may stray from one another, on their way and on later ones, before
    /// it is looked at again [m]; twice and four times as far where their way asks for it.
    pub beyond: f64,
}

/// How many margins regions are looked at with.
pub const LEVELS: usize = 3;

impl Clearance {
    /// How far the vertices of a region may stray from one another before it is looked at again [m].
    pub fn budget(&self, level: usize) -> f64 {
        self.beyond * f64::from(1u32 << level)
    }

    /// The least level at which a region can be left out whose vertices stray so far from one another on
    /// their way [m].
    pub fn level(&self, stray: f64) -> Option<usize> {
        (0..LEVELS).find(|&level| stray <= self.budget(level))
    }
}

/// The longest of some ways [m]; without end where one is not known.
pub fn longest(ways: impl Iterator<Item = f64>) -> f64 {
    ways.fold(0.0, |longest, way| {
        if way.is_nan() {
            f64::INFINITY
        } else {
            way.max(longest)
        }
    })
}

/// Directions a region may face: the bits of a mask.
const DIRECTIONS: usize = 64;

/// Cosine of the largest angle between a triangle's normal and the direction of its region, 75 degrees:
/// what is seen at a sharper one is narrower than what is to be kept.
const WIDEST: f64 = 0.258_819_045_102_520_76;

/// Regions of fewer clusters are looked into: that costs less than this.
pub const LEAST: u32 = 4;

/// Single precision knows cosines to less than this.
const SINGLE: f64 = 1e-6;

/// Distances are known no better than this [m].
const ROUNDING: f64 = 1e-9;

/// One triangle's side of an edge: twice the edge, and one more where the triangle goes from its
/// larger end to its smaller.
type Half = u32;

/// What the mesh says of regions, and what they face now.
#[derive(Clone, Debug, Default)]
pub struct Curvature {
    /// Triangles at an edge that is no plain border between two that turn alike.
    barred: Vec<bool>,
    /// Contours of the nodes, sorted, one after the other; where each begins.
    contours: Vec<Half>,
    starts: Vec<u32>,
    /// Directions that all triangles of a node face, for every level.
    facing: [Vec<u64>; LEVELS],
    clearance: Option<Clearance>,
    /// Distance that is to be kept at each vertex, motion and all [m].
    keeps: Vec<f64>,
}

/// Even places on the sphere along a spiral (Saff and Kuijlaars 1997), coordinate by coordinate.
static PLACES: LazyLock<[[f32; DIRECTIONS]; 3]> = LazyLock::new(|| {
    let golden = std::f64::consts::PI * (3.0 - 5.0f64.sqrt());
    let place = |k: usize| {
        let y = 1.0 - (2 * k + 1) as f64 / DIRECTIONS as f64;
        let (radius, angle) = ((1.0 - y * y).sqrt(), golden * k as f64);
        [radius * angle.cos(), y, radius * angle.sin()]
    };
    [0, 1, 2].map(|axis| std::array::from_fn(|k| place(k)[axis] as f32))
});

/// Which directions are at less than an angle from a unit normal, as bits.
#[inline(always)]
fn towards(directions: &[[f32; DIRECTIONS]; 3], normal: [f32; 3], cosine: f32) -> u64 {
    let mut bits = 0u64;
    for part in 0..DIRECTIONS / 16 {
        let mut some = 0u32;
        for lane in 0..16 {
            let [x, y, z] = [0, 1, 2].map(|k| directions[k][16 * part + lane]);
            let along = x * normal[0] + y * normal[1] + z * normal[2];
            some |= u32::from(along > cosine) << lane;
        }
        bits |= u64::from(some) << (16 * part);
    }
    bits
}

impl Curvature {
    /// Contours of the nodes of a tree over triangles; `edges` have their smaller end first.
    pub fn new(
        tree: &BoxTree,
        triangles: &[[u32; 3]],
        edges: &[[u32; 2]],
        edge_triangles: &[Vec<u32>],
    ) -> Self {
        let mut barred = vec![false; triangles.len()];
        let mut halves = vec![Vec::with_capacity(3); triangles.len()];
        for (e, (&[a, b], at)) in edges.iter().zip(edge_triangles).enumerate() {
            let backward = |t: u32| {
                let [p, q, r] = triangles[t as usize];
                ![(p, q), (q, r), (r, p)].contains(&(a, b))
            };
            let odd = at.len() > 2 || at.len() == 2 && backward(at[0]) == backward(at[1]);
            for &t in at {
                barred[t as usize] |= odd;
                halves[t as usize].push(2 * e as Half + Half::from(backward(t)));
            }
        }
        let nodes = tree.nodes();
        let mut of_node: Vec<Vec<Half>> = vec![Vec::new(); nodes.len()];
        for node in nodes.iter().rev() {
            let at = node.at as usize;
            of_node[at] = match node.children() {
                None => {
                    let items = tree.items(node.first as usize).iter();
                    let of_item = |&t: &u32| {
                        let mut own = halves[t as usize].clone();
                        own.sort_unstable();
                        own
                    };
                    items.map(of_item).fold(Vec::new(), |a, b| joined(&a, &b))
                }
                Some([left, right]) => {
                    joined(&of_node[left.at as usize], &of_node[right.at as usize])
                }
            };
        }
        let mut starts = vec![0];
        for contour in &of_node {
            starts.push(starts[starts.len() - 1] + contour.len() as u32);
        }
        Self {
            barred,
            contours: of_node.concat(),
            starts,
            facing: [const { Vec::new() }; LEVELS],
            clearance: None,
            keeps: Vec::new(),
        }
    }

    /// Sets what is to be kept of the `room` [m] at each vertex.
    pub fn keep(&mut self, room: impl Iterator<Item = f64>, clearance: Clearance) {
        if self.clearance == Some(clearance) {
            return;
        }
        self.keeps.clear();
        self.keeps.extend(room.map(|room| room.min(clearance.kept)));
        self.clearance = Some(clearance);
    }

    /// Finds what the nodes of some regions, and all nodes below them, face at some positions [m], for
    /// each region at its level and those below it.
    pub fn face(
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
            let mut wanted = vec![0i32; tree.leaves() + 1];
            let asked = regions.iter().filter(|(_, least)| *least >= level);
            let mut none = true;
            for node in asked.flat_map(|(region, _)| region.nodes()) {
                wanted[node.first as usize] += 1;
                wanted[(node.first + node.count) as usize] -= 1;
                none = false;
            }
            if none {
                self.facing[level].clear();
                continue;
            }
            for leaf in 0..tree.leaves() {
                wanted[leaf + 1] += wanted[leaf];
            }
            let (barred, keeps, places) = (&*self.barred, &*self.keeps, &*PLACES);
            let (arch, stray) = (Arch::new(), clearance.budget(level));
            let facing = |leaf: usize| match wanted[leaf] {
                0 => 0,
                _ => arch.dispatch(Facing {
                    items: tree.items(leaf),
                    triangles,
                    x,
                    barred,
                    keeps,
                    places,
                    stray,
                }),
            };
            self.facing[level] = tree.folded(facing, |a, b| a & b);
        }
    }

    fn contour(&self, node: Node) -> &[Half] {
        let at = node.at as usize;
        &self.contours[self.starts[at] as usize..self.starts[at + 1] as usize]
    }

    /// Whether no two features of a region without a common vertex can come nearer than is to be kept, at
    /// a level that [`Curvature::face`] was asked for; where it cannot be told, it says no.
    pub fn is_clear(&self, edges: &[[u32; 2]], x: &[Vec3], region: &Region, level: usize) -> bool {
        let of_node = |node: Node| self.facing[level].get(node.at as usize).copied();
        let facing = region
            .nodes()
            .fold(u64::MAX, |facing, node| facing & of_node(node).unwrap_or(0));
        let Some(clearance) = self.clearance else {
            return false;
        };
        if facing == 0 || region.count() < LEAST {
            return false;
        }
        let bits = (0..DIRECTIONS).filter(|k| facing >> k & 1 == 1);
        // What all of these have in sight, their mean has too.
        let place = |k: usize| Vec3::from([0, 1, 2].map(|axis| f64::from(PLACES[axis][k])));
        let mean: Vec3 = bits.map(place).sum();
        let Some(view) = mean.try_normalize(0.0) else {
            return false;
        };
        let halves = match *region {
            Region::Own(a) => self.contour(a).to_vec(),
            Region::Two(a, b) => {
                let (a, b) = (self.contour(a), self.contour(b));
                let joined = joined(a, b);
                if joined.len() == a.len() + b.len() {
                    // No border in common: two plies, most often.
                    return false;
                }
                joined
            }
        };
        let contour = Contour::new(&halves, edges, &self.keeps, (x, view));
        contour.is_connected()
            && contour.alternates()
            && contour.is_clear(clearance.kept, clearance.budget(level))
    }
}

/// The contour of two regions together: what is on both is inside.
fn joined(a: &[Half], b: &[Half]) -> Vec<Half> {
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

/// Triangles whose common directions are asked for. A type of its own, since a closure would not be
/// compiled for the processor's vectors.
struct Facing<'a> {
    items: &'a [u32],
    triangles: &'a [[u32; 3]],
    x: &'a [Vec3],
    barred: &'a [bool],
    keeps: &'a [f64],
    places: &'a [[f32; DIRECTIONS]; 3],
    /// How far corners stray [m].
    stray: f64,
}

impl NullaryFnOnce for Facing<'_> {
    type Output = u64;

    #[inline(always)]
    fn call(self) -> u64 {
        let mut all = u64::MAX;
        for &t in self.items {
            if self.barred[t as usize] {
                return 0;
            }
            let [a, b, c] = self.triangles[t as usize];
            let corners = [self.x[a as usize], self.x[b as usize], self.x[c as usize]];
            let keeps = [
                self.keeps[a as usize],
                self.keeps[b as usize],
                self.keeps[c as usize],
            ];
            all &= faced(self.places, &corners, &keeps, self.stray);
        }
        all
    }
}

/// The directions that a triangle faces and will face while its corners stray.
///
/// With every corner h or more from the opposite side, the plane turns by sin(turn) <= 2 stray / h: each
/// direction in it runs along a chord at least as long as the smallest height.
#[inline(always)]
fn faced(
    places: &[[f32; DIRECTIONS]; 3],
    [a, b, c]: &[Vec3; 3],
    keeps: &[f64; 3],
    stray: f64,
) -> u64 {
    let normal = (b - a).cross(&(c - a));
    let double_area = normal.norm();
    let heights = [b - c, c - a, a - b].map(|side| double_area / side.norm());
    let least = heights[0].min(heights[1]).min(heights[2]);
    let sine = 2.0 * stray / least;
    // Seen at an angle a height is shorter by its cosine; so much must be left of it.
    let left = heights.iter().zip(keeps);
    let left = left.map(|(height, kept)| (kept + ROUNDING) / (height - 2.0 * stray));
    let cosine = left.fold(
        WIDEST,
        |most, share| if share >= 0.0 { most.max(share) } else { 1.0 },
    );
    let (across, turned) = ((1.0 - cosine * cosine).sqrt(), (1.0 - sine * sine).sqrt());
    // That the angle is larger than the turn: NaN is neither.
    if !(cosine < 1.0 && sine < across) {
        return 0;
    }
    // cos(angle - turn)
    let cosine = cosine * turned + across * sine;
    let normal = normal / double_area;
    let normal = [0, 1, 2].map(|k| normal[k] as f32);
    towards(places, normal, (cosine + SINGLE) as f32)
}

/// A contour as it is seen.
struct Contour {
    /// Places of the vertices [m].
    places: Vec<[f64; 2]>,
    /// What is kept at each [m].
    keeps: Vec<f64>,
    /// From which vertex to which, the region on the left.
    sides: Vec<[u32; 2]>,
}

impl Contour {
    fn new(halves: &[Half], edges: &[[u32; 2]], keeps: &[f64], (x, view): (&[Vec3], Vec3)) -> Self {
        let given: Vec<[u32; 2]> = halves
            .iter()
            .map(|&half| {
                let [a, b] = edges[half as usize / 2];
                if half % 2 == 0 { [a, b] } else { [b, a] }
            })
            .collect();
        let mut vertices: Vec<u32> = given.iter().map(|side| side[0]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let [right, up] = across(view);
        // Every vertex of a contour begins one of its sides, and ends one.
        let local = |v: u32| vertices.partition_point(|&other| other < v) as u32;
        Self {
            sides: given.iter().map(|side| side.map(local)).collect(),
            places: vertices
                .iter()
                .map(|&v| [right.dot(&x[v as usize]), up.dot(&x[v as usize])])
                .collect(),
            keeps: vertices.iter().map(|&v| keeps[v as usize]).collect(),
        }
    }

    /// Whether one can walk along it from everywhere to everywhere.
    fn is_connected(&self) -> bool {
        merge_map(self.places.len(), self.sides.iter().copied()).1 == 1
    }

    /// Whether, round every vertex where parts of the region touch, they lie side by side.
    fn alternates(&self) -> bool {
        if self.sides.len() == self.places.len() {
            return true;
        }
        let mut leaving = vec![0; self.places.len()];
        for side in &self.sides {
            leaving[side[0] as usize] += 1;
        }
        let several = (0..self.places.len() as u32).filter(|&v| leaving[v as usize] > 1);
        let mut rays: Vec<(u32, f64, bool)> = Vec::new();
        for v in several {
            for &[a, b] in self.sides.iter().filter(|side| side.contains(&v)) {
                let other = self.places[if a == v { b } else { a } as usize];
                let own = self.places[v as usize];
                rays.push((v, (other[1] - own[1]).atan2(other[0] - own[0]), a == v));
            }
        }
        rays.sort_by(|p, q| p.0.cmp(&q.0).then(p.1.total_cmp(&q.1)));
        rays.chunk_by(|p, q| p.0 == q.0)
            .all(|round| (0..round.len()).all(|k| round[k].2 != round[(k + 1) % round.len()].2))
    }

    /// Whether no vertex can come nearer than is kept to a side that it does not end, and no two
    /// sides cross.
    fn is_clear(&self, kept: f64, stray: f64) -> bool {
        let widest = kept + 2.0 * stray + ROUNDING;
        let range = |k: usize, axis: usize| {
            let [a, b] = self.sides[k].map(|v| self.places[v as usize][axis]);
            [a.min(b), a.max(b)]
        };
        let axis = usize::from(self.extent(1) > self.extent(0));
        let mut order: Vec<(f64, usize)> = (0..self.sides.len())
            .map(|k| (range(k, axis)[0], k))
            .collect();
        order.sort_unstable_by(|p, q| p.0.total_cmp(&q.0));
        for (n, &(_, k)) in order.iter().enumerate() {
            let (high, [low_across, high_across]) = (range(k, axis)[1], range(k, 1 - axis));
            for &(low, other) in &order[n + 1..] {
                if low > high + widest {
                    break;
                }
                let [low, high] = range(other, 1 - axis);
                let apart = low > high_across + widest || low_across > high + widest;
                if !apart && !self.keep_clear([k, other], stray) {
                    return false;
                }
            }
        }
        true
    }

    fn extent(&self, axis: usize) -> f64 {
        let along = || self.places.iter().map(|place| place[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    }

    fn keep_clear(&self, pair: [usize; 2], stray: f64) -> bool {
        let [first, second] = pair.map(|k| self.sides[k]);
        for (side, others) in [(first, second), (second, first)] {
            let [a, b] = side.map(|v| self.places[v as usize]);
            for v in others.into_iter().filter(|v| !side.contains(v)) {
                let least = self.keeps[v as usize] + 2.0 * stray + ROUNDING;
                let far = squared_distance(self.places[v as usize], [a, b]) > least * least;
                if !far {
                    return false;
                }
            }
        }
        let [a, b, c, d] =
            [first[0], first[1], second[0], second[1]].map(|v| self.places[v as usize]);
        let together = first.iter().any(|v| second.contains(v));
        together || !(splits(a, b, c, d) && splits(c, d, a, b))
    }
}

/// Two unit vectors across a third; the three are right-handed in this order.
fn across(view: Vec3) -> [Vec3; 2] {
    let smallest = view.iamin();
    let mut axis = Vec3::zeros();
    axis[smallest] = 1.0;
    let right = (axis - view * view[smallest]).normalize();
    [right, view.cross(&right)]
}

/// Whether the line through a and b has c on one side and d on the other.
fn splits(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    let side = |p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    (side(c) > 0.0) != (side(d) > 0.0)
}

/// Square of the distance of a point from a segment [m2].
fn squared_distance(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let to = [p[0] - a[0], p[1] - a[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let share = ((to[0] * along[0] + to[1] * along[1]) / length).clamp(0.0, 1.0);
    let rest = [to[0] - along[0] * share, to[1] - along[1] * share];
    rest[0] * rest[0] + rest[1] * rest[1]
}
