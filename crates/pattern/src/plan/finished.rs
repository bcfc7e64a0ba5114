//! What truing does to the finished length of an edge.

use crate::{EdgeName, Evaluation, OperationId, PanelId};

/// The finished length of the edge a dart is taken out of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FinishedLength {
    /// The edge.
    pub edge: EdgeName,
    /// Its length once its darts are closed (m).
    pub length: f64,
    /// The same if none of its darts were trued, their mouths as wide (m).
    pub untrued: f64,
    /// Width of the dart's mouth (m).
    pub mouth: f64,
}

/// The finished length of the edge a dart is taken out of; nothing where the dart lies between two edges, or cannot
/// be taken out.
pub fn finished_length(
    evaluation: &Evaluation,
    panel: PanelId,
    dart: OperationId,
) -> Option<FinishedLength> {
    let pattern = evaluation.pattern();
    // What cuts the outline apart forgets how it was before it was trued.
    let owner = pattern.owner_of(panel, dart.into())?;
    let steps = owner.operations.iter().rev();
    let mut stages = steps.filter_map(|step| evaluation.stage(owner.id, Some(step.id)));
    let before = stages.find(|stage| !stage.untrued.is_empty());
    // Both lengths are of one stage, so that nothing else is taken for truing.
    let stage = match before {
        Some(stage) => stage,
        None => evaluation.last_stage(pattern.panel(panel)?)?,
    };
    let (edge, length) = stage.edge_beside(dart)?;
    let own = stage
        .darts
        .iter()
        .find(|own| own.by == dart && own.half == 0)?;
    let of_edge = |stage: &crate::Stage| -> f64 {
        let own = stage
            .untrued
            .iter()
            .filter(|own| own.name == edge && own.half == 0);
        own.map(|own| own.curve.length()).sum()
    };
    Some(FinishedLength {
        edge,
        length,
        untrued: before.map_or(length, |stage| of_edge(stage)),
        mouth: (own.mouth[1] - own.mouth[0]).norm(),
    })
}
