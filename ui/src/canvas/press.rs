//! The possible pressing directions of a dart or pleat, derived from the arrow for the present one.

use toile_geometry::Vec2;
use toile_pattern::{Operation, OperationKind, PleatKind, PressArrow, Pressed, Side};

/// Place of the pressing arrow of a dart or pleat, and the directions in which it can be pressed, in the
/// order of the choices: for a dart toward the leg before its point and toward the leg after it, for a knife
/// pleat left and right of its line.
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

/// Cosine of the angle between the direction `way` at the place `at` and the shortest way from there to a
/// fold line: 1 straight to the fold, -1 straight away from it. `None` for a place on the fold.
pub fn toward_fold((at, way): (Vec2, Vec2), [from, to]: [Vec2; 2]) -> Option<f64> {
    let along = (to - from).try_normalize(1e-12)?;
    let across = (from - at) - along * (from - at).dot(&along);
    Some(across.try_normalize(1e-9)?.dot(&way))
}
