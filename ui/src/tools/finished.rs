//! The finished length of an edge that a dart is taken out of, in words.

use super::number;
use toile_pattern::plan;
use toile_pattern::{Evaluation, OperationId, OperationKind, PanelId, Want};

/// Lengths that differ by less are told as one (m).
const SAME: f64 = 5e-5;

/// How long the edge of a dart is once its darts are closed, and what truing made of it.
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
    // The mouth was narrowed to keep the length; what it were untrued with such a mouth says nothing.
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
