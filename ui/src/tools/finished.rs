//! The finished length of an edge with a dart, in words.

use super::number;
use toile_pattern::plan;
use toile_pattern::{Evaluation, OperationId, OperationKind, PanelId, Want};

/// Lengths that differ by less are shown as one length (m).
const SAME: f64 = 5e-5;

/// Finished length of the edge that a dart is on, with all darts of the edge closed, before and after
/// truing; in words.
pub fn finished_words(
    evaluation: &Evaluation,
    panel: PanelId,
    dart: OperationId,
) -> Option<String> {
    let found = plan::finished_length(evaluation, panel, dart)?;
    let pattern = evaluation.pattern();
    let name = pattern.edge_name(panel, found.edge)?;
    let length = |length: f64| number::show(length, Want::Length, pattern.unit);
    let keeps = pattern
        .operation_of(pattern.panel(panel)?, dart)
        .is_some_and(|step| {
            matches!(
                step.kind,
                OperationKind::Dart {
                    trued: true,
                    keeps_length: true,
                    ..
                }
            )
        });
    // With a kept length the mouth was narrowed: then the length before truing is of no interest.
    if keeps {
        let [length, mouth] = [found.length, found.mouth].map(length);
        return Some(format!(
            "{name} finished: {length}, kept; the mouth is {mouth} wide"
        ));
    }
    Some(match (found.untrued - found.length).abs() < SAME {
        true => format!("{name} finished: {}", length(found.length)),
        false => format!(
            "{name} finished: {} -> {} by truing",
            length(found.untrued),
            length(found.length)
        ),
    })
}
