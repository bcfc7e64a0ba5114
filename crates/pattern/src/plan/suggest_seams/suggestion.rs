//! Seams that are suggested: pairs of edges with their costs and ranks.

use crate::plan::seam::SewnEdge;

/// Two edges that may be meant to be sewn to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SuggestedPair {
    /// The edges: the start of one is sewn to the end of the other.
    pub edges: [SewnEdge; 2],
    /// Lengths of the edges (m).
    pub lengths: [f64; 2],
    /// Rank of the second edge among the partners of the first, and of the first among those of the second,
    /// from 1.
    pub ranks: [usize; 2],
    /// Cost of the pair (1): the lower, the likelier.
    pub cost: f64,
    /// Likelihood that the two edges are partners, among all candidates of both and staying unsewn (1).
    pub likelihood: f64,
    /// Whether the edges are each other's first choice and may be sewn unseen.
    pub is_certain: bool,
}

/// A seam that is suggested, together with the one on the other side of the wearer.
#[derive(Clone, Debug, PartialEq)]
pub struct SuggestedSeam {
    /// The pairs of edges: one, or two that are mirror images of each other.
    pub pairs: Vec<SuggestedPair>,
}

/// Suggestions for all edges of a pattern that are not sewn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeamSuggestions {
    /// The suggested seams: first those whose edges are each other's first choice, then the others by rank
    /// and cost.
    pub seams: Vec<SuggestedSeam>,
    /// The edges that are not sewn, in the order of pieces.
    pub open: Vec<SewnEdge>,
}

impl SuggestedPair {
    /// The edge that this one would be sewn to, and its rank among the partners of this one. `None`: the edge
    /// is not in the pair.
    pub fn partner(&self, edge: SewnEdge) -> Option<(SewnEdge, usize)> {
        let [one, two] = self.edges;
        match edge {
            _ if edge == one => Some((two, self.ranks[0])),
            _ if edge == two => Some((one, self.ranks[1])),
            _ => None,
        }
    }
}

impl SuggestedSeam {
    /// Cost of the likelier pair (1).
    pub fn cost(&self) -> f64 {
        let costs = self.pairs.iter().map(|pair| pair.cost);
        costs.fold(f64::INFINITY, f64::min)
    }

    /// The worst rank of an edge of the seam among the partners of another.
    pub(super) fn worst_rank(&self) -> usize {
        let ranks = self.pairs.iter().flat_map(|pair| pair.ranks);
        ranks.max().unwrap_or(usize::MAX)
    }

    /// The pairs of edges to sew.
    pub fn edges(&self) -> impl Iterator<Item = [SewnEdge; 2]> {
        self.pairs.iter().map(|pair| pair.edges)
    }
}

impl SeamSuggestions {
    /// The partners of an edge, the best first, each with the index of the suggested seam.
    pub fn partners(&self, edge: SewnEdge) -> Vec<(SewnEdge, usize)> {
        let seams = self.seams.iter().enumerate();
        let mut found: Vec<(usize, SewnEdge, usize)> = seams
            .flat_map(|(k, seam)| {
                let pairs = seam.pairs.iter();
                pairs.filter_map(move |pair| {
                    let (partner, rank) = pair.partner(edge)?;
                    Some((rank, partner, k))
                })
            })
            .collect();
        found.sort_by_key(|(rank, _, k)| (*rank, *k));
        let found = found.into_iter();
        found.map(|(_, partner, k)| (partner, k)).collect()
    }

    /// Indices of the suggested seams to accept unseen: all their pairs are certain, and no edge is in a seam
    /// before it.
    pub fn best(&self) -> Vec<usize> {
        let mut taken: Vec<SewnEdge> = Vec::new();
        let mut best = Vec::new();
        for (k, seam) in self.seams.iter().enumerate() {
            let edges: Vec<SewnEdge> = seam.edges().flatten().collect();
            if seam.pairs.iter().all(|pair| pair.is_certain)
                && edges.iter().all(|edge| !taken.contains(edge))
            {
                taken.extend(edges);
                best.push(k);
            }
        }
        best
    }
}
