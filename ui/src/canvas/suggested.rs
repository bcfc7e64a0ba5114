//! Suggested seams, cached while the draft is the same: they are drawn in every frame.

use std::cell::RefCell;
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_pattern::plan::{SeamSuggestions, SewnEdge, suggest_seams};
use toile_pattern::{Draft, EdgeOrigin, Evaluation, Name};

/// Largest distance between a curve and the polyline drawn for it (m).
const FLATNESS: f64 = 2e-4;

/// Suggestions for a draft, or the reason why there are none.
pub type Suggested = Result<SeamSuggestions, String>;

/// Cache of the last suggestions.
#[derive(Debug, Default)]
pub(super) struct SuggestedLast {
    kept: RefCell<Option<(Arc<Draft>, Arc<Suggested>)>>,
}

impl SuggestedLast {
    /// Suggestions for a pattern whose draft is given.
    pub fn seams(&self, draft: &Arc<Draft>, evaluation: &Evaluation) -> Arc<Suggested> {
        let mut kept = self.kept.borrow_mut();
        if let Some((of, found)) = &*kept
            && Arc::ptr_eq(of, draft)
        {
            return found.clone();
        }
        let found = suggest_seams(evaluation).map_err(|error| error.to_string());
        let found = Arc::new(found);
        *kept = Some((draft.clone(), found.clone()));
        found
    }
}

/// The polylines of an edge in the plane of its piece (m), one for each curve. Empty for a copy that is not
/// drawn.
pub fn edge_lines(draft: &Draft, edge: SewnEdge) -> Vec<Vec<Vec2>> {
    let origin = EdgeOrigin {
        name: Name::Drawn(edge.edge),
        half: edge.half,
    };
    let pieces = draft.pieces.iter();
    let mut own = pieces.filter(|piece| piece.id.panel == edge.panel && piece.id.copy == edge.copy);
    let Some(piece) = own.next().filter(|_| edge.copy == 0) else {
        return Vec::new();
    };
    let edges = piece.outline.iter().chain(piece.holes.iter().flatten());
    let edges = edges.filter(|known| known.origin == origin);
    edges.map(|known| known.curve.flatten(FLATNESS)).collect()
}
