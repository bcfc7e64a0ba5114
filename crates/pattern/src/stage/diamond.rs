//! Darts inside a panel, pointed at both ends.

use super::{NOTHING, Stage, StageDart, StageEdge, StageLine};
use crate::{EdgeCorner, LineKind, Name, OperationId, Pressed, Role};
use toile_geometry::{Curve, Vec2};

/// Takes a dart with two points out of a stage, as a hole. Its legs 0 and 1 lead from the first point to the
/// second on one side, 2 and 3 back on the other side. With width 0 no cloth is taken out. `None`: the width
/// is negative or the dart has no length.
pub(crate) fn cut_diamond(
    stage: &Stage,
    by: OperationId,
    [a, b]: [Vec2; 2],
    widest: f64,
    intake: f64,
) -> Option<Stage> {
    let way = b - a;
    if intake < -NOTHING || !(0.0..=1.0).contains(&widest) || way.norm() <= 1e-9 {
        return None;
    }
    let mut result = stage.clone();
    if intake <= NOTHING {
        result.idle.push(by);
        return Some(result);
    }
    let side = Vec2::new(-way.y, way.x).normalize() * (0.5 * intake * stage.turn());
    let middle = a + way * widest;
    let corners = [a, middle + side, b, middle - side];
    let made = |role, index| Name::Made { by, role, index };
    let edges = (0..4_u16)
        .map(|leg| StageEdge {
            name: made(Role::Leg, leg),
            half: 0,
            start: Some(Name::Made {
                by,
                role: Role::Mouth,
                index: leg,
            }),
            from: 0.0,
            to: 1.0,
            curve: Curve::Line {
                start: corners[usize::from(leg)],
                end: corners[usize::from(leg + 1) % 4],
            },
            allowance: 0.0,
            corner: EdgeCorner::default(),
        })
        .collect();
    let internal = result
        .lines
        .iter()
        .position(|line| line.kind == LineKind::Internal);
    let hole = StageLine {
        name: Name::Made {
            by,
            role: Role::Diamond,
            index: 0,
        },
        half: 0,
        kind: LineKind::Hole,
        edges,
        end: None,
        twins: Vec::new(),
    };
    result
        .lines
        .insert(internal.unwrap_or(result.lines.len()), hole);
    result.darts.push(StageDart {
        by,
        half: 0,
        mouth: [middle + side, middle - side],
        apex: a,
        pivot: a,
        trued: false,
        pressed: Pressed::default(),
    });
    Some(result)
}
