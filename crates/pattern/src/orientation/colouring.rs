//! Two-colouring of a graph: each link demands that its nodes are of the same kind, or of different kinds.

use std::collections::{BTreeMap, VecDeque};

/// A link between two nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Link {
    pub nodes: [usize; 2],
    /// Whether the nodes must be of different kinds; else they must be of the same kind.
    pub unlike: bool,
}

/// The kinds of all nodes, relative to the root of their component.
pub(crate) struct Colouring {
    /// Root of each node: the smallest node of its component.
    pub root: Vec<usize>,
    /// Whether each node is of another kind than the root of its component.
    pub unlike: Vec<bool>,
    /// For each component that has no valid colouring, by its root: the indices of links that form a short
    /// ring and contradict each other.
    pub rings: BTreeMap<usize, Vec<usize>>,
}

impl Colouring {
    /// Colours the graph by breadth-first search, in the order of nodes and links.
    pub fn new(count: usize, links: &[Link]) -> Self {
        let mut beside: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (index, link) in links.iter().enumerate() {
            for node in link.nodes {
                beside[node].push(index);
            }
        }
        let mut colouring = Self {
            root: vec![usize::MAX; count],
            unlike: vec![false; count],
            rings: BTreeMap::new(),
        };
        for start in 0..count {
            if colouring.root[start] != usize::MAX {
                continue;
            }
            colouring.root[start] = start;
            let mut open = VecDeque::from([start]);
            while let Some(node) = open.pop_front() {
                for &index in &beside[node] {
                    let other = across(links[index], node);
                    if colouring.root[other] == usize::MAX {
                        colouring.root[other] = start;
                        colouring.unlike[other] = colouring.unlike[node] != links[index].unlike;
                        open.push_back(other);
                    }
                }
            }
        }
        colouring.find_rings(links, &beside);
        colouring
    }

    /// Finds for each component without a valid colouring the shortest ring through a violated link.
    fn find_rings(&mut self, links: &[Link], beside: &[Vec<usize>]) {
        for (index, link) in links.iter().enumerate() {
            let [a, b] = link.nodes;
            if (self.unlike[a] != self.unlike[b]) == link.unlike {
                continue;
            }
            let mut ring = vec![index];
            ring.extend(way((a, b, !link.unlike), links, beside));
            let kept = self.rings.entry(self.root[a]).or_default();
            if kept.is_empty() || ring.len() < kept.len() {
                *kept = ring;
            }
        }
    }
}

/// The node at the other end of a link; `node` itself if the link joins it to itself.
fn across(link: Link, node: usize) -> usize {
    match link.nodes {
        [a, b] if a == node => b,
        [a, _] => a,
    }
}

/// The shortest path of links from one node to another that makes their kinds unlike, or alike if `unlike` is
/// false.
fn way(
    (from, to, unlike): (usize, usize, bool),
    links: &[Link],
    beside: &[Vec<usize>],
) -> Vec<usize> {
    // Each node is visited at most twice: once as of the kind of `from`, and once as of the other kind.
    let mut reached_by: BTreeMap<(usize, bool), Option<usize>> = BTreeMap::new();
    reached_by.insert((from, false), None);
    let mut open = VecDeque::from([(from, false)]);
    while let Some((node, is_unlike)) = open.pop_front() {
        if (node, is_unlike) == (to, unlike) {
            break;
        }
        for &index in &beside[node] {
            let next = (across(links[index], node), is_unlike != links[index].unlike);
            reached_by.entry(next).or_insert_with(|| {
                open.push_back(next);
                Some(index)
            });
        }
    }
    let mut found = Vec::new();
    let mut at = (to, unlike);
    while let Some(Some(index)) = reached_by.get(&at) {
        found.push(*index);
        at = (across(links[*index], at.0), at.1 != links[*index].unlike);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link(a: usize, b: usize, unlike: bool) -> Link {
        Link {
            nodes: [a, b],
            unlike,
        }
    }

    #[test]
    fn nodes_are_unlike_across_an_odd_way_alone() {
        let links = [link(0, 1, true), link(1, 2, true), link(3, 4, false)];
        let found = Colouring::new(6, &links);
        assert_eq!(found.root, [0, 0, 0, 3, 3, 5]);
        assert_eq!(found.unlike, [false, true, false, false, false, false]);
        assert!(found.rings.is_empty());
    }

    #[test]
    fn of_a_component_that_no_kinds_suit_the_shortest_ring_is_kept() {
        // Ring 0-1-2-3-0 with one unlike link, and node 4 attached to it.
        let links = [
            link(0, 1, false),
            link(1, 2, false),
            link(2, 3, false),
            link(3, 0, true),
            link(3, 4, false),
        ];
        let found = Colouring::new(5, &links);
        let mut ring = found.rings[&0].clone();
        ring.sort_unstable();
        assert_eq!(ring, [0, 1, 2, 3]);
        assert_eq!(Colouring::new(1, &[link(0, 0, true)]).rings[&0], [0]);
        assert!(Colouring::new(1, &[link(0, 0, false)]).rings.is_empty());
    }
}
