//! Suggests seams for edges that have none.
//!
//! Every pair of edges has a cost: lengths, angles at both ends, shapes, places in space, names, notches. The
//! costs are then lowered where pairs agree with each other, and each edge gets its partners in order.
//! Nothing is sewn unasked. See `docs/methods/seams-suggested.md`.
//!
//! # Decided with
//! - [`crate::plan::suggest_seams::cost`]: weights of what is known of two edges;
//! - [`crate::plan::suggest_seams::agreement`]: how seams that meet at a corner support each other;
//! - [`mod@crate::plan::suggest_seams::certain`]: which are certain enough to be sewn unseen;
//! - [`crate::plan::accept_seams`]: suggestions sewn.

mod accept;
mod agreement;
mod certain;
mod cost;
mod edges;
mod images;
mod places;
mod sewn;
mod suggestion;
mod wearer_side;

pub use accept::accept_seams;
pub use suggestion::{SeamSuggestions, SuggestedPair, SuggestedSeam};

use crate::plan::impossible;
use crate::{EditError, Evaluation};
use agreement::Candidates;
use certain::{FirstChoice, certain};
use edges::SeamEdges;
use sewn::sewn_partners;
use std::collections::{BTreeMap, BTreeSet};

/// Most edges of a draft for which seams are suggested: every pair of them is compared.
pub const MAX_SUGGESTED_EDGES: usize = 2000;
/// Candidates that are kept for each edge.
const MAX_CANDIDATES: usize = 16;
/// Partners of each edge that are suggested.
const MAX_PARTNERS: usize = 6;
/// Cost of edges that a seam sews already (1).
const SEWN: f64 = -2.0;

/// Suggests seams for all edges of the pattern that are in no seam, for the size that is evaluated.
///
/// # Errors
/// The pattern has more than [`MAX_SUGGESTED_EDGES`] edges.
pub fn suggest_seams(evaluation: &Evaluation) -> Result<SeamSuggestions, EditError> {
    let (draft, _) = evaluation.draft();
    let count = SeamEdges::count(&draft);
    if count > MAX_SUGGESTED_EDGES {
        return Err(impossible(
            format!(
                "the pieces have {count} edges; seams are suggested for up to {MAX_SUGGESTED_EDGES}"
            ),
            "suggest seams for a pattern of fewer pieces",
        ));
    }
    let edges = SeamEdges::new(evaluation, &draft);
    let places = places::Places::new(&edges.all, &draft);
    let images = images::mirror_images(&edges.all, &|i, j| places.image_distance(i, j));
    let known = cost::Known {
        edges: &edges.all,
        places: &places,
        images: &images,
        sides: &wearer_side::wearer_sides(&edges.all, &draft, &places),
        words: edges.all.iter().map(cost::words).collect(),
    };
    let partners = sewn_partners(&edges, &draft);
    let candidates = candidates(&known, &partners);
    let (costs, likelihoods) = agreement::agreed(&edges.all, &candidates);
    let is_open = |edge: &usize| !partners.contains_key(edge);
    let mut ranked = Ranked::new(costs, &likelihoods);
    ranked.certain = certain(&known, &ranked.first_choices(&partners));
    let mut suggestions = ranked.suggestions(&edges, &images, is_open);
    let open = (0..count).filter(is_open);
    suggestions.open = open.filter_map(|edge| edges.all[edge].sewn).collect();
    Ok(suggestions)
}

/// The candidates of every edge with their costs.
fn candidates(known: &cost::Known<'_>, partners: &BTreeMap<usize, Vec<usize>>) -> Candidates {
    let edges = known.edges;
    let count = edges.len();
    let mut found: Candidates = vec![Vec::new(); count];
    let is_free = |edge: usize| edges[edge].sewn.is_some() && !partners.contains_key(&edge);
    let free: Vec<usize> = (0..count).filter(|&edge| is_free(edge)).collect();
    for (k, &i) in free.iter().enumerate() {
        for &j in &free[k + 1..] {
            let cost = known.cost(i, j);
            if cost.is_finite() {
                found[i].push((j, cost));
                found[j].push((i, cost));
            }
        }
    }
    // An edge keeps its own best candidates, and those that keep it.
    let mut kept: Vec<BTreeMap<usize, f64>> = vec![BTreeMap::new(); count];
    for (i, own) in found.iter_mut().enumerate() {
        own.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        for &(j, cost) in own.iter().take(MAX_CANDIDATES) {
            kept[i].insert(j, cost);
            kept[j].insert(i, cost);
        }
    }
    for (&i, others) in partners {
        for &j in others.iter().filter(|&&j| j != i) {
            kept[i].insert(j, SEWN);
            kept[j].insert(i, SEWN);
        }
    }
    kept.into_iter()
        .map(|own| own.into_iter().collect())
        .collect()
}

/// Candidates in the order of their costs.
struct Ranked {
    /// For each edge, its candidates by rank: index, cost and likelihood (1).
    order: Vec<Vec<(usize, f64, f64)>>,
    /// The pairs that may be sewn unseen.
    certain: BTreeSet<[usize; 2]>,
}

impl Ranked {
    fn new(costs: Candidates, likelihoods: &[Vec<f64>]) -> Self {
        let order = costs.into_iter().zip(likelihoods).map(|(own, likely)| {
            let pairs = own.into_iter().zip(likely);
            let mut own: Vec<_> = pairs.map(|((j, cost), p)| (j, cost, *p)).collect();
            own.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            own
        });
        Self {
            order: order.collect(),
            certain: BTreeSet::new(),
        }
    }

    /// The pairs of edges that are each other's first choice.
    fn first_choices(&self, partners: &BTreeMap<usize, Vec<usize>>) -> Vec<FirstChoice> {
        let firsts = self.order.iter().enumerate();
        let choices = firsts.filter_map(|(i, own)| {
            let &(j, cost, likelihood) = own.first()?;
            (i < j && self.rank(j, i) == Some(1)).then(|| FirstChoice {
                edges: [i, j],
                cost,
                likelihood,
                is_sewn: partners.contains_key(&i),
            })
        });
        choices.collect()
    }

    fn rank(&self, i: usize, j: usize) -> Option<usize> {
        let mut own = self.order[i].iter();
        own.position(|known| known.0 == j).map(|k| k + 1)
    }

    /// The pair of two edges, the first being the one with the smaller index.
    fn pair(&self, edges: &SeamEdges, i: usize, j: usize) -> Option<SuggestedPair> {
        let (i, j) = (i.min(j), i.max(j));
        let ranks = [self.rank(i, j)?, self.rank(j, i)?];
        let (_, cost, likelihood) = self.order[i][ranks[0] - 1];
        let (a, b) = (&edges.all[i], &edges.all[j]);
        Some(SuggestedPair {
            edges: [a.sewn?, b.sewn?],
            lengths: [a.length, b.length],
            ranks,
            cost: cost + agreement::MAX_AGREEMENT + cost::MAX_GAIN,
            likelihood,
            is_certain: self.certain.contains(&[i, j]),
        })
    }

    /// The suggested seams between open edges, each with its mirror image.
    fn suggestions(
        &self,
        edges: &SeamEdges,
        images: &[Option<usize>],
        is_open: impl Fn(&usize) -> bool,
    ) -> SeamSuggestions {
        let is_suggested =
            |pair: &SuggestedPair| pair.ranks.iter().any(|rank| *rank <= MAX_PARTNERS);
        let mut done: BTreeSet<[usize; 2]> = BTreeSet::new();
        let mut seams = Vec::new();
        for i in (0..self.order.len()).filter(&is_open) {
            for &(j, ..) in self.order[i].iter().take(MAX_PARTNERS) {
                let own = [i.min(j), i.max(j)];
                if done.contains(&own) {
                    continue;
                }
                let Some(pair) = self.pair(edges, i, j) else {
                    continue;
                };
                done.insert(own);
                let mut pairs = vec![pair];
                if let [Some(a), Some(b)] = own.map(|edge| images[edge]) {
                    let image = [a.min(b), a.max(b)];
                    let is_apart = !own.contains(&a) && !own.contains(&b) && a != b;
                    let is_free = is_open(&a) && is_open(&b) && !done.contains(&image);
                    let found = self.pair(edges, a, b).filter(is_suggested);
                    if is_apart
                        && is_free
                        && let Some(found) = found
                    {
                        done.insert(image);
                        pairs.push(found);
                    }
                }
                seams.push(SuggestedSeam { pairs });
            }
        }
        seams.sort_by(|a, b| {
            let order = a.worst_rank().cmp(&b.worst_rank());
            order.then(a.cost().total_cmp(&b.cost()))
        });
        SeamSuggestions {
            seams,
            open: Vec::new(),
        }
    }
}
