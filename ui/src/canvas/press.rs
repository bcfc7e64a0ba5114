//! The possible pressing directions of a dart or pleat, derived from the arrow for the present one.

use toile_geometry::Vec2;
use toile_pattern::{Operation, OperationKind, PleatKind, PressArrow, Pressed, Side};

/// Place at which a step is pressed, and the possible directions in the order of its choices: for a dart
/// to the leg before its point and to that after it, for a knife pleat left and right of its line.
pub fn press_ways(arrows: &[PressArrow], step: &Operation) -> Option<(Vec2, [Vec2; 2])> {
    let is_first = match step.kind {
        OperationKind::Dart { pressed, .. } | OperationKind::Pivot { pressed, .. } => {
            pressed == Pressed::Before
        }
        OperationKind::Pleat {
            pressed,
            kind: PleatKind::Knife,
            ..
        } => pressed == Side::Left,
        _ => return None,
    };
    let arrow = arrows.iter().find(|arrow| arrow.by == step.id)?;
    Some(match is_first {
        true => (arrow.at, [arrow.way, -arrow.way]),
        false => (arrow.at, [-arrow.way, arrow.way]),
    })
}

/// Cosine between a direction at a place and the way to a fold: 1 straight to it, -1 straight away from
/// it. `None` on the fold.
pub fn toward_fold((at, way): (Vec2, Vec2), [from, to]: [Vec2; 2]) -> Option<f64> {
    let along = (to - from).try_normalize(1e-12)?;
    let across = (from - at) - along * (from - at).dot(&along);
    Some(across.try_normalize(1e-9)?.dot(&way))
}
