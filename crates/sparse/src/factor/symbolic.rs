//! The structure of the factor: dense fronts in a tree (multifrontal method, Duff and Reid 1983).
//!
//! A front eliminates its pivots and hands what is left on its boundary, the vertices coupled to
//! them that are eliminated later, to its parent. Rows of a front are its pivots, then its
//! boundary, both in the order of elimination.

use super::Graph;
use super::dissection::Node;

/// One front of the tree.
#[derive(Clone, Debug)]
pub struct FrontalMatrix {
    /// First pivot, in the order of elimination.
    pub first: u32,
    /// Number of pivots.
    pub pivots: u32,
    /// Where its boundary starts in `Symbolic::boundary`.
    pub boundary_start: usize,
    /// Number of boundary vertices.
    pub boundary: u32,
    /// First front of the subtree that ends with this one.
    pub first_front: u32,
    /// Distance from the root.
    pub depth: u32,
    /// Fronts that hand on to this one, ascending.
    pub children: Vec<u32>,
    /// Where its boundary lands in the rows of its parent.
    pub runs: Vec<Run>,
}

impl FrontalMatrix {
    /// Vertices in its rows.
    pub fn rows(&self) -> usize {
        (self.pivots + self.boundary) as usize
    }
}

/// Consecutive boundary vertices of a front that are consecutive rows of its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// First boundary vertex.
    pub from: u32,
    /// Row of the parent that it lands in.
    pub to: u32,
    /// Number of vertices.
    pub length: u32,
}

/// Where an entry of the matrix goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Which entry of the vertex's row.
    pub entry: u32,
    /// Which row of the front.
    pub row: u32,
}

/// The tree of fronts, children before parents.
#[derive(Clone, Debug, Default)]
pub struct Symbolic {
    /// Vertices in the order of elimination.
    pub order: Vec<u32>,
    pub fronts: Vec<FrontalMatrix>,
    /// Boundary vertices of all fronts, as places in the order of elimination, ascending.
    pub boundary: Vec<u32>,
    /// For each place in the order, where its slots start.
    pub slot_start: Vec<usize>,
    /// Entries in the columns of the pivots, at or below the diagonal.
    pub slots: Vec<Slot>,
}

impl Symbolic {
    /// Works out the structure from a tree of separators; `unknowns` per vertex.
    pub fn new(graph: &Graph, nodes: Vec<Node>, unknowns: usize) -> Self {
        let nodes = amalgamate(graph, nodes, unknowns);
        let mut symbolic = Self::default();
        let place = symbolic.place_fronts(&nodes, graph.vertex_count());
        symbolic.find_boundaries(graph, &place);
        symbolic.find_runs();
        symbolic.find_slots(graph, &place);
        symbolic
    }

    /// Boundary of a front.
    pub fn boundary_of(&self, front: &FrontalMatrix) -> &[u32] {
        &self.boundary[front.boundary_start..front.boundary_start + front.boundary as usize]
    }

    /// Numbers fronts and vertices in postorder; returns the place of each vertex.
    fn place_fronts(&mut self, nodes: &[Node], vertices: usize) -> Vec<u32> {
        let mut place = vec![0; vertices];
        let mut number = vec![0u32; nodes.len()];
        let root = nodes.len() - 1;
        let mut stack = vec![(root, 0u32, 0u32, false)];
        while let Some((node, depth, first_front, done)) = stack.pop() {
            if !done {
                let first_front = self.fronts.len() as u32;
                stack.push((node, depth, first_front, true));
                let children = nodes[node].children.iter().rev();
                stack.extend(children.map(|&c| (c as usize, depth + 1, 0, false)));
                continue;
            }
            number[node] = self.fronts.len() as u32;
            let first = self.order.len() as u32;
            for &v in &nodes[node].pivots {
                place[v as usize] = self.order.len() as u32;
                self.order.push(v);
            }
            self.fronts.push(FrontalMatrix {
                first,
                pivots: nodes[node].pivots.len() as u32,
                boundary_start: 0,
                boundary: 0,
                first_front,
                depth,
                children: nodes[node]
                    .children
                    .iter()
                    .map(|&c| number[c as usize])
                    .collect(),
                runs: Vec::new(),
            });
        }
        place
    }

    fn find_boundaries(&mut self, graph: &Graph, place: &[u32]) {
        let mut seen = vec![u32::MAX; place.len()];
        let mut found = Vec::new();
        for f in 0..self.fronts.len() {
            let front = &self.fronts[f];
            let end = front.first + front.pivots;
            found.clear();
            let mut take = |p: u32| {
                if p >= end && seen[p as usize] != f as u32 {
                    seen[p as usize] = f as u32;
                    found.push(p);
                }
            };
            for &v in &self.order[front.first as usize..end as usize] {
                for &u in graph.row(v as usize) {
                    take(place[u as usize]);
                }
            }
            for &c in &front.children {
                self.boundary_of(&self.fronts[c as usize])
                    .iter()
                    .for_each(|&p| take(p));
            }
            found.sort_unstable();
            self.fronts[f].boundary_start = self.boundary.len();
            self.fronts[f].boundary = found.len() as u32;
            self.boundary.extend(&found);
        }
    }

    /// Row of a front in which a place of the order stands.
    fn row_of(&self, front: &FrontalMatrix, place: u32) -> u32 {
        if place < front.first + front.pivots {
            place - front.first
        } else {
            let at = self.boundary_of(front).binary_search(&place);
            front.pivots + at.expect("a boundary holds all that its pivots are coupled to") as u32
        }
    }

    fn find_runs(&mut self) {
        for f in 0..self.fronts.len() {
            for c in self.fronts[f].children.clone() {
                let mut runs: Vec<Run> = Vec::new();
                for (from, &p) in self
                    .boundary_of(&self.fronts[c as usize])
                    .iter()
                    .enumerate()
                {
                    let to = self.row_of(&self.fronts[f], p);
                    match runs.last_mut() {
                        Some(run) if run.to + run.length == to => run.length += 1,
                        _ => runs.push(Run {
                            from: from as u32,
                            to,
                            length: 1,
                        }),
                    }
                }
                self.fronts[c as usize].runs = runs;
            }
        }
    }

    fn find_slots(&mut self, graph: &Graph, place: &[u32]) {
        self.slot_start.push(0);
        for f in 0..self.fronts.len() {
            let front = &self.fronts[f];
            for p in front.first..front.first + front.pivots {
                let row = graph.row(self.order[p as usize] as usize);
                for (entry, &u) in row.iter().enumerate() {
                    let at = place[u as usize];
                    if at >= p {
                        self.slots.push(Slot {
                            entry: entry as u32,
                            row: self.row_of(front, at),
                        });
                    }
                }
                self.slot_start.push(self.slots.len());
            }
        }
    }
}

/// Operations of a front with so many pivots and boundary vertices (flop).
pub fn operations(pivots: usize, boundary: usize, unknowns: usize) -> f64 {
    let [p, b] = [pivots, boundary].map(|n| (n * unknowns) as f64);
    p * p * p / 3.0 + p * p * b + p * b * b
}

/// Estimated time of a front (s): a fixed part, the operations, and the memory it fills, at rates
/// measured on small fronts.
fn front_time(pivots: usize, boundary: usize, unknowns: usize) -> f64 {
    const EACH: f64 = 3e-6;
    const PER_OPERATION: f64 = 1.0 / 40e9;
    const PER_ENTRY: f64 = 0.3e-9;
    if pivots + boundary == 0 {
        return 0.0;
    }
    let rows = ((pivots + boundary) * unknowns) as f64;
    EACH + PER_OPERATION * operations(pivots, boundary, unknowns) + PER_ENTRY * rows * rows
}

/// Merges fronts into their parents as long as the estimated time falls (relaxed supernodes,
/// Ashcraft and Grimes 1989).
fn amalgamate(graph: &Graph, mut nodes: Vec<Node>, unknowns: usize) -> Vec<Node> {
    let boundary = boundary_counts(graph, &nodes);
    let time = |p: usize, f: usize| front_time(p, boundary[f] as usize, unknowns);
    for f in 0..nodes.len() {
        loop {
            let own = nodes[f].pivots.len();
            let gain = |p: usize, children: &[u32]| {
                let apart: f64 = children
                    .iter()
                    .map(|&c| time(nodes[c as usize].pivots.len(), c as usize))
                    .sum();
                apart + time(own, f) - time(own + p, f)
            };
            let size = |c: u32| nodes[c as usize].pivots.len();
            let mut best: Option<(f64, Vec<u32>)> = None;
            let children = nodes[f].children.clone();
            let singles = children.iter().map(|&c| vec![c]);
            let all = (children.len() == 2).then(|| children.clone());
            for merged in singles.chain(all) {
                let found = gain(merged.iter().map(|&c| size(c)).sum(), &merged);
                if found > 0.0 && best.as_ref().is_none_or(|(gain, _)| found > *gain) {
                    best = Some((found, merged));
                }
            }
            let Some((_, merged)) = best else { break };
            let (mut pivots, mut kept) = (Vec::new(), Vec::new());
            for c in children {
                if merged.contains(&c) {
                    let child = std::mem::take(&mut nodes[c as usize]);
                    pivots.extend(child.pivots);
                    kept.extend(child.children);
                } else {
                    kept.push(c);
                }
            }
            pivots.append(&mut nodes[f].pivots);
            nodes[f].pivots = pivots;
            nodes[f].children = kept;
        }
    }
    nodes
}

/// Boundary vertices of each node of a tree of separators.
fn boundary_counts(graph: &Graph, nodes: &[Node]) -> Vec<u32> {
    let mut node_of = vec![0u32; graph.vertex_count()];
    for (at, node) in nodes.iter().enumerate() {
        for &v in &node.pivots {
            node_of[v as usize] = at as u32;
        }
    }
    let mut seen = vec![u32::MAX; graph.vertex_count()];
    let mut lists: Vec<Vec<u32>> = Vec::with_capacity(nodes.len());
    let mut counts = Vec::with_capacity(nodes.len());
    for (at, node) in nodes.iter().enumerate() {
        let mut list = Vec::new();
        let mut take = |u: u32| {
            if node_of[u as usize] > at as u32 && seen[u as usize] != at as u32 {
                seen[u as usize] = at as u32;
                list.push(u);
            }
        };
        for &v in &node.pivots {
            graph.row(v as usize).iter().for_each(|&u| take(u));
        }
        for &c in &node.children {
            std::mem::take(&mut lists[c as usize])
                .into_iter()
                .for_each(&mut take);
        }
        counts.push(list.len() as u32);
        lists.push(list);
    }
    counts
}
