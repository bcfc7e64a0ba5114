//! A tree of boxes over triangles that move on straight lines within a step: built once, refitted for each step.

use crate::{TriangleMesh, Vec3};
use std::ops::Range;

/// Most triangles of a leaf.
const LEAF: usize = 4;

/// Room for the nodes that wait in a search: more than the tree is deep, as every node has half the triangles of
/// the one above it.
const WAITING: usize = 40;

/// A node: its children follow it, the first at once, or it is a leaf.
#[derive(Clone, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
    /// The second child, or the first of the leaf's triangles in their order.
    next: u32,
    /// How many triangles a leaf has; 0 for a node with children.
    count: u32,
}

impl Node {
    fn leaf(&self) -> Option<Range<usize>> {
        let first = self.next as usize;
        (self.count > 0).then(|| first..first + self.count as usize)
    }

    /// Square of the distance of a point from the box (m2).
    fn distance2(&self, point: Vec3) -> f64 {
        let outside = (self.low - point).sup(&(point - self.high));
        outside.sup(&Vec3::zeros()).norm_squared()
    }
}

/// A tree over the triangles of a mesh.
#[derive(Clone, Debug)]
pub(crate) struct SweptTree {
    /// A node comes before those below it.
    nodes: Vec<Node>,
    /// The triangles in order of the leaves.
    order: Vec<u32>,
}

impl SweptTree {
    /// Builds the tree of a mesh at rest: triangles are halved by their middles along the longest side of the box round
    /// those middles.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let middles: Vec<Vec3> = (0..mesh.triangles.len())
            .map(|t| mesh.corners(t).iter().sum::<Vec3>() / 3.0)
            .collect();
        let mut tree = Self {
            nodes: Vec::new(),
            order: (0..mesh.triangles.len() as u32).collect(),
        };
        if !tree.order.is_empty() {
            tree.split(0..mesh.triangles.len(), &middles);
        }
        tree.refit(&mesh.triangles, [&mesh.positions; 2]);
        tree
    }

    fn split(&mut self, range: Range<usize>, middles: &[Vec3]) {
        let at = self.nodes.len();
        self.nodes.push(Node {
            low: Vec3::zeros(),
            high: Vec3::zeros(),
            next: range.start as u32,
            count: range.len() as u32,
        });
        if range.len() <= LEAF {
            return;
        }
        let part = &mut self.order[range.clone()];
        let nothing = [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)];
        let [low, high] = part.iter().fold(nothing, |[low, high], &t| {
            let middle = &middles[t as usize];
            [low.inf(middle), high.sup(middle)]
        });
        let axis = (high - low).imax();
        let half = part.len() / 2;
        let along = |t: &u32| middles[*t as usize][axis];
        part.select_nth_unstable_by(half, |a, b| along(a).total_cmp(&along(b)).then(a.cmp(b)));
        self.split(range.start..range.start + half, middles);
        let second = self.nodes.len() as u32;
        self.split(range.start + half..range.end, middles);
        self.nodes[at].next = second;
        self.nodes[at].count = 0;
    }

    /// Makes the boxes hold the triangles at the start and at the end of a step, and so all the time.
    pub fn refit(&mut self, triangles: &[[u32; 3]], places: [&[Vec3]; 2]) {
        for at in (0..self.nodes.len()).rev() {
            let [low, high] = match self.nodes[at].leaf() {
                Some(range) => {
                    let corners = self.order[range]
                        .iter()
                        .flat_map(|&t| triangles[t as usize]);
                    let first = Vec3::repeat(f64::INFINITY);
                    corners.fold([first, -first], |[low, high], v| {
                        let [a, b] = places.map(|places| places[v as usize]);
                        [low.inf(&a).inf(&b), high.sup(&a).sup(&b)]
                    })
                }
                None => {
                    let second = self.nodes[at].next as usize;
                    let [a, b] = [at + 1, second].map(|child| &self.nodes[child]);
                    [a.low.inf(&b.low), a.high.sup(&b.high)]
                }
            };
            let node = &mut self.nodes[at];
            (node.low, node.high) = (low, high);
        }
    }

    /// The closest triangle no farther than `reach` (m), the lowest of several that are equally close.
    pub fn closest(
        &self,
        point: Vec3,
        reach: f64,
        likely: Option<u32>,
        distance2: impl Fn(u32) -> f64,
    ) -> Option<u32> {
        let mut best = (reach * reach, u32::MAX);
        let consider = |triangle: u32, best: &mut (f64, u32)| {
            let square = distance2(triangle);
            if square < best.0 || (square == best.0 && triangle < best.1) {
                *best = (square, triangle);
            }
        };
        if let Some(triangle) = likely {
            consider(triangle, &mut best);
        }
        let mut waiting = [(0_u32, 0.0_f64); WAITING];
        let mut count = usize::from(!self.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let (mut at, bound) = waiting[count];
            if bound > best.0 {
                continue;
            }
            // Down to the leaf on the nearer side; the others wait.
            loop {
                let node = &self.nodes[at as usize];
                if let Some(range) = node.leaf() {
                    for &triangle in &self.order[range] {
                        consider(triangle, &mut best);
                    }
                    break;
                }
                let children = [at + 1, node.next];
                let bounds = children.map(|child| self.nodes[child as usize].distance2(point));
                let nearer = usize::from(bounds[1] < bounds[0]);
                if bounds[1 - nearer] <= best.0 {
                    waiting[count] = (children[1 - nearer], bounds[1 - nearer]);
                    count += 1;
                }
                if bounds[nearer] > best.0 {
                    break;
                }
                at = children[nearer];
            }
        }
        (best.1 != u32::MAX).then_some(best.1)
    }

    /// Distance of a point from the nearest box of a leaf, at most `reach` (m).
    pub fn clearance(&self, point: Vec3, reach: f64) -> f64 {
        let mut least = reach * reach;
        let mut waiting = [(0_u32, 0.0_f64); WAITING];
        let mut count = usize::from(!self.nodes.is_empty());
        while count > 0 && least > 0.0 {
            count -= 1;
            let (at, bound) = waiting[count];
            if bound >= least {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.count > 0 {
                least = node.distance2(point);
                continue;
            }
            let children = [at + 1, node.next];
            let children = children.map(|at| (at, self.nodes[at as usize].distance2(point)));
            let nearer = usize::from(children[1].1 < children[0].1);
            // The nearer one is looked at first.
            waiting[count..count + 2].copy_from_slice(&[children[1 - nearer], children[nearer]]);
            count += 2;
        }
        least.sqrt()
    }

    /// Triangles of leaves whose boxes meet a box (m).
    pub fn near_box(&self, [low, high]: [Vec3; 2], mut found: impl FnMut(u32)) {
        let meets = |node: &Node| {
            (0..3).all(|axis| node.low[axis] <= high[axis] && low[axis] <= node.high[axis])
        };
        let mut waiting = [0_u32; WAITING];
        let mut count = usize::from(!self.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let at = waiting[count];
            let node = &self.nodes[at as usize];
            if !meets(node) {
                continue;
            }
            match node.leaf() {
                Some(range) => self.order[range].iter().for_each(|&t| found(t)),
                None => {
                    waiting[count..count + 2].copy_from_slice(&[node.next, at + 1]);
                    count += 2;
                }
            }
        }
    }
}
