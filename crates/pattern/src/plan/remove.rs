//! Removes parts.

use super::divide::join_edges;
use crate::{Edit, EditError, Evaluation, PanelId, PointId};

/// The edits that remove a point: a corner of a panel's line joins its edges, any other point is
/// taken off its sheet. What was constructed from it waits for its return.
///
/// # Errors
/// The point is not there, or its line would lose too many corners.
pub fn remove_point(
    evaluation: &Evaluation,
    (panel, point): (PanelId, PointId),
) -> Result<Vec<Edit>, EditError> {
    let owner = evaluation.pattern().panel(panel);
    let mut edges = owner.into_iter().flat_map(|panel| panel.edges());
    if edges.any(|edge| edge.ends[1] == point) {
        return join_edges(evaluation, (panel, point));
    }
    Ok(vec![Edit::Remove(point.into())])
}
