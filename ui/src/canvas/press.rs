//! Which way darts and pleats are pressed, as arrows: where the cloth that is folded under lies.

use toile_geometry::Vec2;
use toile_pattern::{
    Name, Operation, OperationId, OperationKind, Panel, Pattern, PleatKind, Pressed, Role, Side,
    Stage, StageLine,
};

/// How far along a dart or a pleat from the edge its arrow stands [share of it].
const IN: f64 = 0.3;
/// Lines that a fold and two of it make.
const LINES: u16 = 5;

/// An arrow in the plane of a panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressArrow {
    /// What is pressed.
    pub by: OperationId,
    /// Where its middle is [m].
    pub at: Vec2,
    /// Its direction, a unit.
    pub way: Vec2,
}

/// The arrows of what a panel has been given by its steps.
pub fn press_arrows(stage: &Stage, pattern: &Pattern, panel: &Panel) -> Vec<PressArrow> {
    let mut arrows = Vec::new();
    for dart in stage.darts.iter().filter(|dart| dart.half == 0) {
        let is_pressed = |step: &&std::sync::Arc<Operation>| {
            matches!(
                step.kind,
                OperationKind::Dart { .. } | OperationKind::Pivot { .. }
            )
        };
        let step = pattern.operation_of(panel, dart.by);
        let [open, close] = dart.mouth;
        let way = match dart.pressed {
            Pressed::Before => open - close,
            Pressed::After => close - open,
        };
        let middle = (open + close) * 0.5;
        if let (Some(step), Some(way)) = (step.filter(is_pressed), way.try_normalize(1e-12)) {
            arrows.push(PressArrow {
                by: step.id,
                at: middle + (dart.apex - middle) * IN,
                way,
            });
        }
    }
    let placements = stage.lines.iter().filter(|line| {
        line.half == 0 && matches!(line.name, Name::Made { role, .. } if role == Role::Placement)
    });
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

/// The arrows of one pleat: one a fold, in the middle of what lies under.
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
    // Creases beside the placement, where the cloth under a fold turns back.
    let turns = stage.lines.iter().filter_map(|line| match line.name {
        Name::Made {
            by,
            role: Role::Crease,
            index,
        } if by == step.id
            && line.half == 0
            && index / LINES == number
            && index % LINES % 2 == 1 =>
        {
            at(line)
        }
        _ => None,
    });
    for turn in turns {
        // From where the fold is laid to, outward, lies what is under the part beside it; under a box
        // it is inward.
        let way = match kind {
            PleatKind::Knife | PleatKind::Inverted => turn - middle,
            PleatKind::Box => middle - turn,
        };
        if let Some(way) = way.try_normalize(1e-12) {
            let by = step.id;
            arrows.push(PressArrow { by, at: turn, way });
        }
    }
}

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
