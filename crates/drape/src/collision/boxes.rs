//! A tree of boxes over clusters of the triangles of a sheet: built once, refitted as they move.

use rayon::prelude::*;
use toile_geometry::Vec3;

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates [m].
    pub low: [f64; 3],
    /// Largest coordinates [m].
    pub high: [f64; 3],
}

impl Bounds {
    /// Round nothing.
    pub const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// Round some points, with a margin [m].
    pub fn round(points: &[Vec3], margin: f64) -> Self {
        let mut bounds = Self::EMPTY;
        for p in points {
            for k in 0..3 {
                bounds.low[k] = bounds.low[k].min(p[k] - margin);
                bounds.high[k] = bounds.high[k].max(p[k] + margin);
            }
        }
        bounds
    }

    /// Round some points; everywhere where one is no number.
    pub fn round_all(points: impl Iterator<Item = Vec3>) -> Self {
        let (mut bounds, mut sum) = (Self::EMPTY, 0.0);
        for p in points {
            sum += p.x + p.y + p.z;
            for k in 0..3 {
                bounds.low[k] = bounds.low[k].min(p[k]);
                bounds.high[k] = bounds.high[k].max(p[k]);
            }
        }
        let everywhere = Self {
            low: [f64::NEG_INFINITY; 3],
            high: [f64::INFINITY; 3],
        };
        if sum.is_finite() { bounds } else { everywhere }
    }

    /// Round two boxes.
    pub fn join(&self, other: &Self) -> Self {
        let mut bounds = *self;
        for k in 0..3 {
            bounds.low[k] = bounds.low[k].min(other.low[k]);
            bounds.high[k] = bounds.high[k].max(other.high[k]);
        }
        bounds
    }

    /// Half its diagonal [m].
    pub fn radius(&self) -> f64 {
        let side = |k: usize| self.high[k] - self.low[k];
        0.5 * (side(0) * side(0) + side(1) * side(1) + side(2) * side(2)).sqrt()
    }

    /// Whether two boxes share a point.
    #[inline(always)]
    pub fn meets(&self, other: &Self) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }

    /// Distance of two boxes [m].
    pub fn distance(&self, other: &Self) -> f64 {
        let between = |k: usize| {
            let apart = (self.low[k] - other.high[k]).max(other.low[k] - self.high[k]);
            apart.max(0.0).powi(2)
        };
        (between(0) + between(1) + between(2)).sqrt()
    }
}

/// A node: where its box is, and the leaves below it, clusters of items. With c leaves below, half of them (rounded
/// down) are below the first child, which follows at once; the tree needs no pointers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// Index of its box.
    pub at: u32,
    /// First of its leaves.
    pub first: u32,
    /// How many they are.
    pub count: u32,
}

impl Node {
    /// The two below it; none below a leaf.
    pub fn children(self) -> Option<[Self; 2]> {
        let left = self.count / 2;
        let first = Self {
            at: self.at + 1,
            first: self.first,
            count: left,
        };
        let second = Self {
            at: self.at + 2 * left,
            first: self.first + left,
            count: self.count - left,
        };
        (self.count > 1).then_some([first, second])
    }
}

/// One region against itself, or against another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// Itself.
    Own(Node),
    /// Two.
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

    /// How many leaves are below it.
    pub fn count(&self) -> u32 {
        self.nodes().map(|node| node.count).sum()
    }

    /// The one or two leaves that it is, where it cannot be looked into.
    fn leaves(&self) -> Option<[u32; 2]> {
        match *self {
            Self::Own(a) => (a.count == 1).then_some([a.first; 2]),
            Self::Two(a, b) => (a.count == 1 && b.count == 1).then_some([a.first, b.first]),
        }
    }
}

/// What a search of the tree found.
#[derive(Clone, Debug, Default)]
pub struct Pairs<N> {
    /// Pairs of leaves that the search came to, each once, and leaves with themselves.
    pub pairs: Vec<[u32; 2]>,
    /// How many regions were looked into.
    pub opened: usize,
    /// What was noted on the way, in parts.
    pub notes: Vec<N>,
}

/// The most items in a leaf.
pub const CLUSTER: usize = 16;

/// The tree.
#[derive(Clone, Debug, Default)]
pub struct BoxTree {
    items: Vec<u32>,
    /// First item of every leaf, and the end.
    starts: Vec<u32>,
    counts: Vec<u32>,
    boxes: Vec<Bounds>,
    /// Where the box of every leaf is.
    leaf_boxes: Vec<u32>,
}

/// Parts that a search is cut into before cores share them.
const PARTS: usize = 96;

impl BoxTree {
    /// Builds the tree over items at some centres [m], halving the longest axis, items of one piece
    /// together whatever lies between them; boxes are empty until it is fitted.
    pub fn new(centres: &[Vec3], pieces: &[u32]) -> Self {
        let mut items: Vec<u32> = (0..centres.len() as u32).collect();
        let mut tree = Self::default();
        let leaves = items.len().div_ceil(CLUSTER);
        if leaves > 0 {
            tree.split((centres, pieces), (0, &mut items), leaves);
        }
        tree.starts.push(items.len() as u32);
        tree.items = items;
        tree.boxes = vec![Bounds::EMPTY; tree.counts.len()];
        let leaves = (0u32..).zip(&tree.counts).filter(|(_, count)| **count == 1);
        tree.leaf_boxes = leaves.map(|(at, _)| at).collect();
        tree
    }

    fn split(
        &mut self,
        (centres, pieces): (&[Vec3], &[u32]),
        (first, items): (usize, &mut [u32]),
        leaves: usize,
    ) {
        self.counts.push(leaves as u32);
        if leaves == 1 {
            self.starts.push(first as u32);
            return;
        }
        let mut bounds = Bounds::EMPTY;
        for &item in items.iter() {
            bounds = bounds.join(&Bounds::round(&[centres[item as usize]], 0.0));
        }
        let length = |k: usize| bounds.high[k] - bounds.low[k];
        let axis = (1..3).fold(0, |best, k| if length(k) > length(best) { k } else { best });
        // Neither side gets more items than its leaves hold.
        let left = leaves / 2;
        let half = items.len() * left / leaves;
        items.select_nth_unstable_by(half, |&a, &b| {
            let (p, q) = (centres[a as usize][axis], centres[b as usize][axis]);
            let piece = |item: u32| pieces[item as usize];
            (piece(a).cmp(&piece(b)))
                .then(p.total_cmp(&q))
                .then(a.cmp(&b))
        });
        let (below, above) = items.split_at_mut(half);
        self.split((centres, pieces), (first, below), left);
        self.split((centres, pieces), (first + half, above), leaves - left);
    }

    /// The node over everything; none when there is nothing.
    pub fn root(&self) -> Option<Node> {
        let count = self.leaves() as u32;
        (count > 0).then_some(Node {
            at: 0,
            first: 0,
            count,
        })
    }

    /// How many leaves there are.
    pub fn leaves(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// The items of a leaf.
    pub fn items(&self, leaf: usize) -> &[u32] {
        &self.items[self.starts[leaf] as usize..self.starts[leaf + 1] as usize]
    }

    /// Nodes in the order of their boxes: children come after their parents.
    pub fn nodes(&self) -> Vec<Node> {
        let mut nodes = Vec::with_capacity(self.counts.len());
        let mut stack: Vec<Node> = self.root().into_iter().collect();
        while let Some(node) = stack.pop() {
            nodes.push(node);
            if let Some([left, right]) = node.children() {
                stack.extend([right, left]);
            }
        }
        nodes
    }

    /// Fits every box anew; `bounds` gives that of a leaf.
    pub fn refit(&mut self, bounds: impl Fn(usize) -> Bounds + Sync) {
        self.boxes = self.folded(bounds, Bounds::join);
    }

    /// What some values of the leaves below every node come to, in the order of the nodes' boxes.
    pub fn folded<T: Clone + Send + Sync>(
        &self,
        value: impl Fn(usize) -> T + Sync,
        join: impl Fn(&T, &T) -> T + Sync,
    ) -> Vec<T> {
        let leaves = (0..self.leaves()).into_par_iter().with_min_len(32);
        let leaves: Vec<T> = leaves.map(&value).collect();
        let Some(first) = leaves.first() else {
            return Vec::new();
        };
        let mut all = vec![first.clone(); self.counts.len()];
        fold(&leaves, &mut all, &join);
        all
    }

    /// Whether the boxes of a region's nodes meet.
    pub fn meets(&self, region: &Region) -> bool {
        match *region {
            Region::Own(_) => true,
            Region::Two(a, b) => self.boxes[a.at as usize].meets(&self.boxes[b.at as usize]),
        }
    }

    /// Distance of the boxes of a region's nodes [m]; none of a node from itself.
    pub fn distance(&self, region: &Region) -> Option<f64> {
        match *region {
            Region::Own(_) => None,
            Region::Two(a, b) => {
                Some(self.boxes[a.at as usize].distance(&self.boxes[b.at as usize]))
            }
        }
    }

    /// Two leaves as a region, or one with itself.
    pub fn region(&self, [a, b]: [u32; 2]) -> Region {
        let leaf = |first: u32| Node {
            at: self.leaf_boxes[first as usize],
            first,
            count: 1,
        };
        match a == b {
            true => Region::Own(leaf(a)),
            false => Region::Two(leaf(a), leaf(b)),
        }
    }

    /// Pairs of leaves in some regions, in an order that does not depend on the
    /// number of threads. Regions that `skip` names are not looked into; it may note what it likes.
    pub fn pairs<N: Default + Send>(
        &self,
        regions: &[Region],
        skip: impl Fn(&mut N, &Region) -> bool + Sync,
    ) -> Pairs<N> {
        let given: Vec<(bool, N)> = regions
            .par_iter()
            .map(|region| {
                let mut note = N::default();
                (!skip(&mut note, region), note)
            })
            .collect();
        let kept = regions.iter().zip(&given).filter(|(_, (kept, _))| *kept);
        let mut work: Vec<Region> = kept.map(|(region, _)| *region).collect();
        let mut notes: Vec<N> = given.into_iter().map(|(_, note)| note).collect();
        let (mut note, mut opened, mut grown) = (N::default(), 0, true);
        while grown && work.len() < PARTS {
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
        let mut all = Pairs {
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

/// Nodes of more leaves than this have both sides folded at a time.
const SHARED: usize = 64;

/// Fills the values of a node and all below it from those of its leaves.
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
    if leaves.len() > SHARED {
        rayon::join(fold_first, fold_second);
    } else {
        fold_first();
        fold_second();
    }
    *own = join(&first[0], &second[0]);
}

/// The regions that make up one, of those to keep.
fn open(region: Region, mut keep: impl FnMut(&Region) -> bool, out: &mut Vec<Region>) {
    let mut add = |region: Region| {
        if keep(&region) {
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
            let (large, small) = if a.count >= b.count { (a, b) } else { (b, a) };
            for child in large.children().into_iter().flatten() {
                add(Region::Two(child, small));
            }
        }
    }
}
