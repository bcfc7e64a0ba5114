//! Plans changes of guides.

use super::lookup::finite;
use crate::{Edit, EditError, Entity, Evaluation, Guide, GuideId, GuideRun};
use std::sync::Arc;

/// Plans to add a guide at a place on the table (m): a height or a distance to the right. Returns the guide
/// too.
///
/// # Errors
/// The position is not finite.
pub fn add_guide(
    evaluation: &Evaluation,
    runs: GuideRun,
    at: f64,
) -> Result<(Vec<Edit>, GuideId), EditError> {
    let mut ids = evaluation.pattern().ids;
    let id = ids.take();
    Ok((vec![put(Guide { id, runs, at })?], id))
}

/// Plans to move a guide to another place on the table (m).
///
/// # Errors
/// The guide is missing, or the position is not finite.
pub fn move_guide(evaluation: &Evaluation, id: GuideId, at: f64) -> Result<Vec<Edit>, EditError> {
    let found = evaluation.pattern().guide(id);
    let guide = found.ok_or_else(|| EditError::Missing(id.to_string()))?;
    Ok(vec![put(Guide { at, ..**guide })?])
}

/// Plans to remove all guides.
pub fn remove_guides(evaluation: &Evaluation) -> Vec<Edit> {
    let guides = evaluation.pattern().guides.iter();
    guides.map(|guide| Edit::Remove(guide.id.into())).collect()
}

fn put(guide: Guide) -> Result<Edit, EditError> {
    finite("the place of the guide", &[[guide.at, 0.0].into()])?;
    Ok(Edit::Put(Entity::Guide(Arc::new(guide))))
}
