//! Edges that the seams of the document sew already.

use super::edges::SeamEdges;
use crate::plan::seam::SewnEdge;
use crate::{Draft, Evaluation, SeamOrigin};
use std::collections::BTreeMap;

/// All edges that seams of the document sew, wholly or in part.
pub(super) fn sewn_edges(evaluation: &Evaluation) -> Vec<SewnEdge> {
    let (draft, _) = evaluation.draft();
    let edges = SeamEdges::new(evaluation, &draft);
    let partners = sewn_partners(&edges, &draft);
    let sewn = partners.keys().filter_map(|edge| edges.all[*edge].sewn);
    sewn.collect()
}

/// For each edge that a seam sews, the edges on the other side of its seams.
pub(super) fn sewn_partners(edges: &SeamEdges, draft: &Draft) -> BTreeMap<usize, Vec<usize>> {
    let mut partners: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for seam in &draft.seams {
        if !matches!(seam.id, SeamOrigin::Seam(_)) {
            continue;
        }
        let [one, two] = [0, 1].map(|side| {
            let spans = seam.sides[side].iter();
            let found = spans.filter_map(|span| edges.place(span.piece, span.edge));
            found.collect::<Vec<usize>>()
        });
        for (own, other) in [(&one, &two), (&two, &one)] {
            for edge in own {
                partners.entry(*edge).or_default().extend(other);
            }
        }
    }
    partners
}
