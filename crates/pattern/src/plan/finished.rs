//! Effect of truing on the finished length of an edge.

use crate::{EdgeName, Evaluation, OperationId, PanelId};

/// The finished length of the edge that a dart opens in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FinishedLength {
    /// The edge.
    pub edge: EdgeName,
    /// Length with all darts of the edge closed (m).
    pub length: f64,
    /// Length that the edge would have without truing, with the mouths of its darts as wide as they are (m).
    pub untrued: f64,
    /// Width of the dart's mouth (m).
    pub mouth: f64,
}

/// The finished length of the edge that a dart opens in, to show the effect of truing. `None`: the dart lies
/// between two edges, or cannot be taken out.
pub fn finished_length(
    evaluation: &Evaluation,
    panel: PanelId,
    dart: OperationId,
) -> Option<FinishedLength> {
    let pattern = evaluation.pattern();
    // Truing is recorded only up to the first operation that cuts the outline apart, so the last stage before
    // it is taken.
    let owner = pattern.owner_of(panel, dart.into())?;
    let steps = owner.operations.iter().rev();
    let mut stages = steps.filter_map(|step| evaluation.stage(owner.id, Some(step.id)));
    let before = stages.find(|stage| !stage.untrued.is_empty());
    // Both lengths are taken on the same stage, so that they differ by truing alone.
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
