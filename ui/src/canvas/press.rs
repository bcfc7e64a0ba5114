//! The directions a dart or a pleat may be pressed in, by the arrow that shows how it is.

use toile_geometry::Vec2;
use toile_pattern::{Operation, OperationKind, PleatKind, PressArrow, Pressed, Side};

/// Where a step is pressed, and the directions it may be pressed in, in the order of its choices: of a dart to the leg
/// before its point and after it, of a knife pleat left and right of its line.
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

/// How far a direction at a place leads to a fold: 1 straight to it, -1 straight away from it. Nothing on the fold.
pub fn toward_fold((at, way): (Vec2, Vec2), [from, to]: [Vec2; 2]) -> Option<f64> {
    let along = (to - from).try_normalize(1e-12)?;
    let across = (from - at) - along * (from - at).dot(&along);
    Some(across.try_normalize(1e-9)?.dot(&way))
}
