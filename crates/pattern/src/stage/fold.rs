//! Unfolding: adds the mirror half of a panel that lies on the fold of the cloth.

use super::{
    PlaceError, Placed, Stage, StageDart, StageEdge, StageLine, StageNotch, mirrored_edges,
    with_ends,
};
use crate::{CornerName, LineKind, LineName, NotchId};
use toile_geometry::{Curve, Vec2};

/// Reason why a stage cannot be unfolded along a stretch of its outline.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum FoldError {
    /// The stretch that is to lie on the fold is not on the outline.
    Place(PlaceError),
    /// The stretch that is to lie on the fold is not straight, has no length, or is the whole outline.
    NotStraight,
}

/// A stage joined with its mirror image in a straight stretch of its outline; returns also the notches on
/// that stretch, which the unfolded stage does not have.
pub(crate) fn unfold(
    stage: &Stage,
    line: LineName,
    ends: [Placed; 2],
) -> Result<(Stage, Vec<NotchId>), FoldError> {
    let stretch = stage
        .stretch(line, ends, |_| true)
        .map_err(FoldError::Place)?;
    let outline = stage
        .lines
        .iter()
        .find(|l| l.name == line && l.half == 0 && l.kind == LineKind::Outline);
    let outline = outline.ok_or(FoldError::Place(PlaceError::NoLine))?;
    let on_fold = |edge: &StageEdge| {
        stretch.iter().any(|&(name, from, to)| {
            name == edge.name && edge.from >= from - 1e-9 && edge.to <= to + 1e-9
        })
    };
    let mut edges = outline.edges.clone();
    let first = (0..edges.len())
        .find(|&k| on_fold(&edges[k]) && !on_fold(&edges[(k + edges.len() - 1) % edges.len()]));
    let Some(first) = first else {
        return Err(FoldError::NotStraight);
    };
    edges.rotate_left(first);
    let count = edges.iter().take_while(|edge| on_fold(edge)).count();
    let folded: Vec<StageEdge> = edges.drain(..count).collect();
    let (start, end) = (folded[0].curve.start(), folded[count - 1].curve.end());
    let way = end - start;
    let is_straight = way.norm() > 1e-9
        && folded.iter().all(|edge| {
            let away = way.perp(&(edge.curve.end() - start)) / way.norm();
            matches!(edge.curve, Curve::Line { .. }) && away.abs() < 1e-7
        });
    if !is_straight || edges.is_empty() {
        return Err(FoldError::NotStraight);
    }
    let mut own = stage.clone();
    for notch in &mut own.notches {
        if is_on(&folded, notch) {
            move_off(notch, &edges, (start, end));
        }
    }
    let lost = own.notches.iter().filter(|notch| is_on(&folded, notch));
    let lost: Vec<NotchId> = lost.map(|notch| notch.id).collect();
    let corner = folded[0].start;
    let whole = unfolded(&own, (line, edges, corner), (start, end), &lost);
    Ok((whole, lost))
}

/// Whether a notch is on one of the edges that lie on the fold.
fn is_on(folded: &[StageEdge], notch: &StageNotch) -> bool {
    notch.half == 0 && folded.iter().any(|edge| edge.name == notch.edge)
}

/// Assigns a notch at an end of the fold to the edge that meets the fold there. `edges` are the other edges
/// of the outline, from the end of the fold to its start.
fn move_off(notch: &mut StageNotch, edges: &[StageEdge], (start, end): (Vec2, Vec2)) {
    const SAME: f64 = 1e-9;
    let (Some(first), Some(last)) = (edges.first(), edges.last()) else {
        return;
    };
    let (edge, share, at) = match () {
        () if (notch.point - start).norm() < SAME => (last, last.to, 1.0),
        () if (notch.point - end).norm() < SAME => (first, first.from, 0.0),
        () => return,
    };
    let Some(along) = edge.curve.derivative(at).try_normalize(1e-15) else {
        return;
    };
    // The notch points into the cloth, which is on the same side of this edge as of the fold.
    let (left, fold) = (Vec2::new(-along.y, along.x), end - start);
    let side = Vec2::new(-fold.y, fold.x).dot(&notch.inward);
    (notch.edge, notch.share) = (edge.name, share);
    notch.inward = left * if side >= 0.0 { 1.0 } else { -1.0 };
}

fn unfolded(
    stage: &Stage,
    (name, edges, corner): (LineName, Vec<StageEdge>, Option<CornerName>),
    (start, end): (Vec2, Vec2),
    lost: &[NotchId],
) -> Stage {
    let bit = 1 << stage.folds.len().min(7);
    let mirror = (start, end - start);
    let unit = mirror.1.normalize();
    let flip = |v: Vec2| unit * (2.0 * v.dot(&unit)) - v;
    let reflect = |p: Vec2| start + flip(p - start);
    let mut other = mirrored_edges(&edges, mirror, bit, false);
    if let Some(first) = other.first_mut() {
        first.curve = with_ends(first.curve, start, first.curve.end());
        first.start = corner;
    }
    if let Some(last) = other.last_mut() {
        last.curve = with_ends(last.curve, last.curve.start(), end);
    }
    let mut result = stage.clone();
    result.folds.push((start, unit));
    let mut lines = Vec::with_capacity(2 * result.lines.len());
    for kind in [LineKind::Outline, LineKind::Hole, LineKind::Internal] {
        let own: Vec<_> = result
            .lines
            .iter()
            .filter(|l| l.kind == kind)
            .cloned()
            .collect();
        if kind == LineKind::Outline {
            let own = own.into_iter().map(|line| {
                let is_folded = line.name == name && line.half == 0;
                let whole = || edges.iter().chain(&other).cloned().collect();
                StageLine {
                    edges: if is_folded { whole() } else { line.edges },
                    ..line
                }
            });
            lines.extend(own);
            continue;
        }
        let mirrored: Vec<_> = own.iter().map(|line| line.mirrored(mirror, bit)).collect();
        lines.extend(own);
        lines.extend(mirrored);
    }
    result.lines = lines;
    result.notches.retain(|notch| !lost.contains(&notch.id));
    let notches: Vec<StageNotch> = result
        .notches
        .iter()
        .map(|notch| StageNotch {
            half: notch.half | bit,
            point: reflect(notch.point),
            inward: flip(notch.inward),
            ..*notch
        })
        .collect();
    result.notches.extend(notches);
    let darts: Vec<StageDart> = result
        .darts
        .iter()
        .map(|dart| StageDart {
            half: dart.half | bit,
            mouth: [reflect(dart.mouth[1]), reflect(dart.mouth[0])],
            apex: reflect(dart.apex),
            pivot: reflect(dart.pivot),
            ..*dart
        })
        .collect();
    result.darts.extend(darts);
    result
}
