//! A bounding volume hierarchy of axis-aligned boxes. Its leaves are clusters of items (triangles of the cloth); it is
//! built once and refitted as they move.

use rayon::prelude::*;
use toile_geometry::Vec3;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates (m).
    pub low: [f64; 3],
    /// Largest coordinates (m).
    pub high: [f64; 3],
}

impl Bounds {
    /// Bounds of nothing: joined to other bounds it changes nothing.
    pub const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// Bounds of some points, enlarged by `margin` (m).
    pub fn of(points: &[Vec3], margin: f64) -> Self {
        let mut bounds = Self::EMPTY;
        for p in points {
            for k in 0..3 {
                bounds.low[k] = bounds.low[k].min(p[k] - margin);
                bounds.high[k] = bounds.high[k].max(p[k] + margin);
            }
        }
        bounds
    }

    /// Bounds of some points; all of space where a coordinate is not finite.
    pub fn of_all(points: impl Iterator<Item = Vec3>) -> Self {
        let (mut bounds, mut sum) = (Self::EMPTY, 0.0);
        for p in points {
            sum += p.x + p.y + p.z;
            for k in 0..3 {
                bounds.low[k] = bounds.low[k].min(p[k]);
                bounds.high[k] = bounds.high[k].max(p[k]);
            }
        }
        let all_space = Self {
            low: [f64::NEG_INFINITY; 3],
            high: [f64::INFINITY; 3],
        };
        if sum.is_finite() { bounds } else { all_space }
    }

    /// Bounds of two boxes together.
    pub fn join(&self, other: &Self) -> Self {
        let mut bounds = *self;
        for k in 0..3 {
            bounds.low[k] = bounds.low[k].min(other.low[k]);
            bounds.high[k] = bounds.high[k].max(other.high[k]);
        }
        bounds
    }

    /// Half the diagonal (m).
    pub fn radius(&self) -> f64 {
        let side = |k: usize| self.high[k] - self.low[k];
        0.5 * (side(0) * side(0) + side(1) * side(1) + side(2) * side(2)).sqrt()
    }

    /// Whether two boxes share a point.
    #[inline(always)]
    pub fn meets(&self, other: &Self) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }

    /// Distance of two boxes (m).
    pub fn distance(&self, other: &Self) -> f64 {
        let squared_gap = |k: usize| {
            let gap = (self.low[k] - other.high[k]).max(other.low[k] - self.high[k]);
            gap.max(0.0).powi(2)
        };
        (squared_gap(0) + squared_gap(1) + squared_gap(2)).sqrt()
    }
}

/// A node of the tree. Nodes are numbered in depth-first order and leaves from left to right, so the tree stores no
/// pointers: with c leaves below a node, c / 2 (rounded down) are below its left child, whose index is the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// Index of the node, and of its box.
    pub index: u32,
    /// First leaf below it.
    pub first_leaf: u32,
    /// Number of leaves below it.
    pub leaf_count: u32,
}

impl Node {
    /// The two children; none of a leaf.
    pub fn children(self) -> Option<[Self; 2]> {
        let half = self.leaf_count / 2;
        let left = Self {
            index: self.index + 1,
            first_leaf: self.first_leaf,
            leaf_count: half,
        };
        // A subtree of n leaves has 2 n - 1 nodes.
        let right = Self {
            index: self.index + 2 * half,
            first_leaf: self.first_leaf + half,
            leaf_count: self.leaf_count - half,
        };
        (self.leaf_count > 1).then_some([left, right])
    }
}

/// A node of the bounding volume test tree: a node of the tree of boxes to be tested against itself, or two nodes to be
/// tested against each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// One node against itself.
    Own(Node),
    /// Two nodes against each other.
    Two(Node, Node),
}

impl Region {
    /// The one or two nodes.
    pub fn nodes(&self) -> impl Iterator<Item = Node> + use<> {
        let (first, second) = match *self {
            Self::Own(a) => (a, None),
            Self::Two(a, b) => (a, Some(b)),
        };
        std::iter::once(first).chain(second)
    }

    /// Number of leaves below its nodes.
    pub fn leaf_count(&self) -> u32 {
        self.nodes().map(|node| node.leaf_count).sum()
    }

    /// Its one or two leaves, where it consists of leaves and cannot be opened.
    fn leaves(&self) -> Option<[u32; 2]> {
        match *self {
            Self::Own(a) => (a.leaf_count == 1).then_some([a.first_leaf; 2]),
            Self::Two(a, b) => {
                let are_leaves = a.leaf_count == 1 && b.leaf_count == 1;
                are_leaves.then_some([a.first_leaf, b.first_leaf])
            }
        }
    }
}

/// Result of a search of the tree.
#[derive(Clone, Debug, Default)]
pub struct LeafPairs<N> {
    /// Pairs of leaves at which the search ended, each once, and leaves with themselves.
    pub pairs: Vec<[u32; 2]>,
    /// Number of regions opened.
    pub opened: usize,
    /// Notes of the search, one of each task.
    pub notes: Vec<N>,
}

/// Largest number of items in a leaf.
pub const MAX_LEAF_ITEMS: usize = 16;

/// Tree of boxes over items.
#[derive(Clone, Debug, Default)]
pub struct BoxTree {
    items: Vec<u32>,
    /// First item of every leaf, and the end.
    starts: Vec<u32>,
    /// Number of leaves below every node, in the order of the nodes.
    leaf_counts: Vec<u32>,
    boxes: Vec<Bounds>,
    /// Index of the node that is each leaf.
    leaf_nodes: Vec<u32>,
}

/// Number of regions that a search is divided into, one task each. It does not depend on the number of threads, and
/// neither does the order of the result.
const TASKS: usize = 96;

impl BoxTree {
    /// Builds the tree over items with these centres (m), halved along the longest axis of each node. Items of one
    /// connected component stay together, whatever lies between them: items are sorted by component first. Boxes are
    /// empty until the tree is fitted.
    pub fn new(centres: &[Vec3], components: &[u32]) -> Self {
        let mut items: Vec<u32> = (0..centres.len() as u32).collect();
        let mut tree = Self::default();
        let leaves = items.len().div_ceil(MAX_LEAF_ITEMS);
        if leaves > 0 {
            tree.split((centres, components), (0, &mut items), leaves);
        }
        tree.starts.push(items.len() as u32);
        tree.items = items;
        tree.boxes = vec![Bounds::EMPTY; tree.leaf_counts.len()];
        let nodes = (0u32..).zip(&tree.leaf_counts);
        let leaves = nodes.filter(|(_, count)| **count == 1);
        tree.leaf_nodes = leaves.map(|(node, _)| node).collect();
        tree
    }

    fn split(
        &mut self,
        (centres, components): (&[Vec3], &[u32]),
        (first, items): (usize, &mut [u32]),
        leaves: usize,
    ) {
        self.leaf_counts.push(leaves as u32);
        if leaves == 1 {
            self.starts.push(first as u32);
            return;
        }
        let mut bounds = Bounds::EMPTY;
        for &item in items.iter() {
            bounds = bounds.join(&Bounds::of(&[centres[item as usize]], 0.0));
        }
        let length = |k: usize| bounds.high[k] - bounds.low[k];
        let axis = (1..3).fold(0, |best, k| if length(k) > length(best) { k } else { best });
        // Neither half gets more items than its leaves can hold.
        let left = leaves / 2;
        let half = items.len() * left / leaves;
        items.select_nth_unstable_by(half, |&a, &b| {
            let (p, q) = (centres[a as usize][axis], centres[b as usize][axis]);
            let component = |item: u32| components[item as usize];
            (component(a).cmp(&component(b)))
                .then(p.total_cmp(&q))
                .then(a.cmp(&b))
        });
        let (below, above) = items.split_at_mut(half);
        self.split((centres, components), (first, below), left);
        self.split((centres, components), (first + half, above), leaves - left);
    }

    /// The root; none where the tree has no items.
    pub fn root(&self) -> Option<Node> {
        let count = self.leaves() as u32;
        (count > 0).then_some(Node {
            index: 0,
            first_leaf: 0,
            leaf_count: count,
        })
    }

    /// Number of leaves.
    pub fn leaves(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// The items of a leaf.
    pub fn items(&self, leaf: usize) -> &[u32] {
        &self.items[self.starts[leaf] as usize..self.starts[leaf + 1] as usize]
    }

    /// All nodes in the order of their indices: parents come before their children.
    pub fn nodes(&self) -> Vec<Node> {
        let mut nodes = Vec::with_capacity(self.leaf_counts.len());
        let mut stack: Vec<Node> = self.root().into_iter().collect();
        while let Some(node) = stack.pop() {
            nodes.push(node);
            if let Some([left, right]) = node.children() {
                stack.extend([right, left]);
            }
        }
        nodes
    }

    /// Refits every box; `bounds` gives that of a leaf.
    pub fn refit(&mut self, bounds: impl Fn(usize) -> Bounds + Sync) {
        self.boxes = self.reduced(bounds, Bounds::join);
    }

    /// Reduces a value of each leaf up the tree with `join`. Returns the value of every node, in the order of nodes.
    pub fn reduced<T: Clone + Send + Sync>(
        &self,
        value: impl Fn(usize) -> T + Sync,
        join: impl Fn(&T, &T) -> T + Sync,
    ) -> Vec<T> {
        let leaves = (0..self.leaves()).into_par_iter().with_min_len(32);
        let leaves: Vec<T> = leaves.map(&value).collect();
        let Some(first) = leaves.first() else {
            return Vec::new();
        };
        let mut all = vec![first.clone(); self.leaf_counts.len()];
        fold(&leaves, &mut all, &join);
        all
    }

    /// Whether the boxes of a region's nodes overlap.
    pub fn meets(&self, region: &Region) -> bool {
        match *region {
            Region::Own(_) => true,
            Region::Two(a, b) => self.boxes[a.index as usize].meets(&self.boxes[b.index as usize]),
        }
    }

    /// Distance of the boxes of a region's two nodes (m); none where it has one node.
    pub fn distance(&self, region: &Region) -> Option<f64> {
        match *region {
            Region::Own(_) => None,
            Region::Two(a, b) => {
                Some(self.boxes[a.index as usize].distance(&self.boxes[b.index as usize]))
            }
        }
    }

    /// The region of two leaves, or of one leaf given twice.
    pub fn region(&self, [a, b]: [u32; 2]) -> Region {
        let leaf = |leaf: u32| Node {
            index: self.leaf_nodes[leaf as usize],
            first_leaf: leaf,
            leaf_count: 1,
        };
        match a == b {
            true => Region::Own(leaf(a)),
            false => Region::Two(leaf(a), leaf(b)),
        }
    }

    /// Searches some regions down to pairs of leaves, in an order that does not depend on the number of threads.
    /// Regions for which `skip` is true are left out; it may take notes.
    pub fn leaf_pairs<N: Default + Send>(
        &self,
        regions: &[Region],
        skip: impl Fn(&mut N, &Region) -> bool + Sync,
    ) -> LeafPairs<N> {
        let given: Vec<(bool, N)> = regions
            .par_iter()
            .map(|region| {
                let mut note = N::default();
                (!skip(&mut note, region), note)
            })
            .collect();
        let entered = regions.iter().zip(&given);
        let entered = entered.filter(|(_, (is_entered, _))| *is_entered);
        let mut work: Vec<Region> = entered.map(|(region, _)| *region).collect();
        let mut notes: Vec<N> = given.into_iter().map(|(_, note)| note).collect();
        let (mut note, mut opened, mut grown) = (N::default(), 0, true);
        while grown && work.len() < TASKS {
            let mut next = Vec::with_capacity(3 * work.len());
            grown = false;
            for region in &work {
                if region.leaves().is_some() {
                    next.push(*region);
                    continue;
                }
                open(*region, |region| !skip(&mut note, region), &mut next);
                opened += 1;
                grown = true;
            }
            work = next;
        }
        let found: Vec<(Vec<[u32; 2]>, usize, N)> = work
            .par_iter()
            .map(|&region| {
                let (mut stack, mut pairs, mut opened) = (vec![region], Vec::new(), 0);
                let mut note = N::default();
                while let Some(region) = stack.pop() {
                    if let Some(leaves) = region.leaves() {
                        pairs.push(leaves);
                        continue;
                    }
                    open(region, |region| !skip(&mut note, region), &mut stack);
                    opened += 1;
                }
                (pairs, opened, note)
            })
            .collect();
        notes.push(note);
        let mut all = LeafPairs {
            pairs: Vec::with_capacity(found.iter().map(|found| found.0.len()).sum()),
            opened,
            notes,
        };
        for (pairs, opened, note) in found {
            all.pairs.extend(pairs);
            all.opened += opened;
            all.notes.push(note);
        }
        all
    }
}

/// The two halves of a node with more leaves than this are reduced in parallel.
const PARALLEL_ABOVE: usize = 64;

/// Fills the values of a node and of all nodes below it from those of its leaves.
fn fold<T: Clone + Send + Sync>(leaves: &[T], all: &mut [T], join: &(impl Fn(&T, &T) -> T + Sync)) {
    let Some((own, below)) = all.split_first_mut() else {
        return;
    };
    if let [leaf] = leaves {
        own.clone_from(leaf);
        return;
    }
    let half = leaves.len() / 2;
    let (first, second) = below.split_at_mut(2 * half - 1);
    let (of_first, of_second) = leaves.split_at(half);
    let mut fold_first = || fold(of_first, first, join);
    let mut fold_second = || fold(of_second, second, join);
    if leaves.len() > PARALLEL_ABOVE {
        rayon::join(fold_first, fold_second);
    } else {
        fold_first();
        fold_second();
    }
    *own = join(&first[0], &second[0]);
}

/// Opens a region: pushes the regions that it consists of, where `enter` is true for them.
fn open(region: Region, mut enter: impl FnMut(&Region) -> bool, out: &mut Vec<Region>) {
    let mut add = |region: Region| {
        if enter(&region) {
            out.push(region);
        }
    };
    match region {
        Region::Own(node) => {
            let Some([left, right]) = node.children() else {
                return;
            };
            add(Region::Own(left));
            add(Region::Own(right));
            add(Region::Two(left, right));
        }
        Region::Two(a, b) => {
            let (large, small) = if a.leaf_count >= b.leaf_count {
                (a, b)
            } else {
                (b, a)
            };
            for child in large.children().into_iter().flatten() {
                add(Region::Two(child, small));
            }
        }
    }
}
