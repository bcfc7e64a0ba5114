//! Directions in which darts and pleats are pressed, given by the side on which the folded cloth lies. The
//! window and printed patterns show them by the same arrows.

use crate::{
    Name, Operation, OperationKind, Panel, Pattern, PleatKind, PressArrow, Pressed, Role, Stage,
    StageLine,
};

/// Distance of an arrow from the edge in which the dart or pleat opens, as a share of its length (1).
const IN: f64 = 0.3;
/// Number of indices that each pleat has for the names of its lines: fold lines, and lines that the folds are
/// laid to.
const LINES: u16 = 5;

/// The arrows of the darts and pleats of a panel.
pub fn press_arrows(stage: &Stage, pattern: &Pattern, panel: &Panel) -> Vec<PressArrow> {
    let mut arrows = Vec::new();
    for dart in &stage.darts {
        let is_pressed = |step: &&std::sync::Arc<Operation>| {
            matches!(
                step.kind,
                OperationKind::Dart { .. } | OperationKind::Pivot { .. }
            )
        };
        let step = pattern.operation_of(panel, dart.by);
        let [open, close] = dart.mouth;
        // On a mirrored half the outline passes the leg after the apex first.
        let is_mirrored = dart.half.count_ones() % 2 == 1;
        let across = match (dart.pressed == Pressed::Before) != is_mirrored {
            true => open - close,
            false => close - open,
        };
        let middle = (open + close) * 0.5;
        if let (Some(step), Some(way)) = (step.filter(is_pressed), across.try_normalize(1e-12)) {
            arrows.push(PressArrow {
                by: step.id,
                half: dart.half,
                at: middle + (dart.apex - middle) * IN,
                way,
                width: across.norm() * (1.0 - IN),
            });
        }
    }
    let placements = stage
        .lines
        .iter()
        .filter(|line| line.name.role() == Some(Role::Placement));
    for placement in placements {
        let Name::Made { by, index, .. } = placement.name else {
            continue;
        };
        if let Some(step) = pattern.operation_of(panel, by) {
            pleat_arrows(stage, (step, placement, index / LINES), &mut arrows);
        }
    }
    arrows
}

/// The arrows of one pleat: one for each fold, in the middle of the underlay.
fn pleat_arrows(
    stage: &Stage,
    (step, placement, number): (&Operation, &StageLine, u16),
    arrows: &mut Vec<PressArrow>,
) {
    let OperationKind::Pleat { kind, .. } = &step.kind else {
        return;
    };
    let at = |line: &StageLine| {
        let (first, last) = (line.edges.first()?, line.edges.last()?);
        let (start, end) = (first.curve.start(), last.curve.end());
        Some(start + (end - start) * IN)
    };
    let Some(middle) = at(placement) else {
        return;
    };
    // The creases next to the placement line: there the cloth that lies under the pleat is folded back.
    let turns = stage.lines.iter().filter_map(|line| match line.name {
        Name::Made {
            by,
            role: Role::Crease,
            index,
        } if by == step.id
            && line.half == placement.half
            && index / LINES == number
            && index % LINES % 2 == 1 =>
        {
            at(line)
        }
        Name::Drawn(_) | Name::Made { .. } => None,
    });
    for turn in turns {
        // The underlay reaches from the placement line outward, under the part beside it; under a box pleat
        // it reaches inward.
        let across = match kind {
            PleatKind::Knife | PleatKind::Inverted => turn - middle,
            PleatKind::Box => middle - turn,
        };
        if let Some(way) = across.try_normalize(1e-12) {
            arrows.push(PressArrow {
                by: step.id,
                half: placement.half,
                at: turn,
                way,
                width: across.norm(),
            });
        }
    }
}
