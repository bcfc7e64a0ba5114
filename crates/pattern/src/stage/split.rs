//! Panels split in two along a curve.

use super::motion::Motion;
use super::partition::{CutError, SAME, check_cut, outline_of, partition, ring};
use super::{Stage, StageDart, StageEdge, StageLine, StageNotch, with_ends};
use crate::{EdgeCorner, LineKind, LineName, Name, OperationId, Role};
use std::sync::Arc;
use toile_geometry::{Curve, Path};

/// Reason why a panel cannot be split.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SplitError {
    Cut(CutError),
    /// The curve meets the outline in this number of places, not in two.
    Meets(usize),
}

/// Largest distance from the outline at which an end of the curve counts as on it (m).
const ON_OUTLINE: f64 = 1e-6;

/// The stage, completed by the stages of its two sides, left and right of the curve.
pub(crate) fn split(
    stage: &Stage,
    (by, line): (OperationId, LineName),
    curve: &Path,
) -> Result<Stage, SplitError> {
    let outline = outline_of(stage, line).map_err(SplitError::Cut)?;
    let mut line = stage.lines[outline].clone();
    let path = Path::new(line.edges.iter().map(|edge| edge.curve).collect());
    let [start, end] = meetings(curve, &path)?;
    let cut = curve.between(start.0, end.0);
    check_cut(stage, outline, &cut).map_err(SplitError::Cut)?;
    for along in [start.1.min(end.1), start.1.max(end.1)] {
        line.divide(along);
    }
    let [first, last] = [start.1, end.1].map(|along| line.divide(along));
    let mut result = stage.clone();
    result.sides = sides(stage, (outline, line), [first, last], (by, &cut));
    Ok(result)
}

/// The first and the last place at which the curve meets the outline: for each the arc lengths along the
/// curve and along the outline (m).
fn meetings(curve: &Path, outline: &Path) -> Result<[(f64, f64); 2], SplitError> {
    let length = curve.length();
    let end_at = |along: f64| {
        let at = curve.point(curve.at_length(along)?);
        let near = outline.nearest(at)?;
        ((outline.point(near) - at).norm() <= ON_OUTLINE).then_some((along, near.along))
    };
    let ends = [end_at(0.0), end_at(length)];
    let crossings = curve.crossings(outline);
    let inner = crossings.iter().map(|c| (c.here.along, c.there.along));
    // A crossing near an end of the curve that lies on the outline is the same place as that end.
    let inner = inner.filter(|(along, _)| {
        let near = |end: Option<(f64, f64)>, at: f64| end.is_some() && (along - at).abs() <= 1e-5;
        !near(ends[0], 0.0) && !near(ends[1], length)
    });
    let mut all: Vec<(f64, f64)> = ends[0].into_iter().collect();
    all.extend(inner);
    all.extend(ends[1]);
    match all[..] {
        [first, last] if (first.1 - last.1).abs() > SAME => Ok([first, last]),
        _ => Err(SplitError::Meets(all.len())),
    }
}

fn name<Id>(by: OperationId, index: u16) -> Name<Id> {
    Name::Made {
        by,
        role: Role::Split,
        index,
    }
}

/// The cut as edges, from its start on the outline to its end on the outline.
fn cut_edges(by: OperationId, cut: &Path) -> Vec<StageEdge> {
    let length = cut.length();
    let count = cut.curves().len();
    let share = |k: usize| match k {
        k if k == count => 1.0,
        k => cut.length_before(k) / length,
    };
    let edges = cut.curves().iter().enumerate();
    edges
        .map(|(k, curve)| StageEdge {
            name: name(by, 0),
            half: 0,
            start: (k == 0).then(|| name(by, 0)),
            from: share(k),
            to: share(k + 1),
            curve: *curve,
            allowance: 0.0,
            corner: EdgeCorner::default(),
        })
        .collect()
}

/// The edges of the cut walked the other way, for the side on which the cut runs backwards.
fn cut_back(by: OperationId, edges: &[StageEdge]) -> Vec<StageEdge> {
    let back = edges.iter().rev().enumerate();
    back.map(|(k, edge)| StageEdge {
        start: (k == 0).then(|| name(by, 1)),
        name: name(by, 1),
        from: 1.0 - edge.to,
        to: 1.0 - edge.from,
        curve: edge.curve.reversed(),
        ..edge.clone()
    })
    .collect()
}

/// Both sides of a stage, whose outline is divided at the start and at the end of the cut.
fn sides(
    stage: &Stage,
    (outline, line): (usize, StageLine),
    [start, end]: [usize; 2],
    (by, cut): (OperationId, &Path),
) -> Vec<Arc<Stage>> {
    let count = line.edges.len();
    let walk = |from: usize, to: usize| -> Vec<StageEdge> {
        let steps = (to + count - from) % count;
        (0..steps)
            .map(|k| line.edges[(from + k) % count].clone())
            .collect()
    };
    // One side is the cut forwards, then the outline back to the start of the cut; the other is the cut
    // backwards, then the outline back to the end of the cut.
    let rests = [walk(end, start), walk(start, end)];
    let forwards = cut_edges(by, cut);
    let cuts = [forwards.clone(), cut_back(by, &forwards)];
    let mut lines: Vec<StageLine> = Vec::with_capacity(2);
    for (k, (mut own, rest)) in (1_u16..).zip(cuts.into_iter().zip(&rests)) {
        fit(&mut own, rest);
        let cut_count = own.len();
        own.extend(rest.iter().cloned());
        let mut side = StageLine {
            edges: own,
            ..line.clone()
        };
        // The cut walked forwards ends at corner 1, walked backwards at corner 0.
        side.call(cut_count, name(by, k % 2));
        lines.push(side);
    }
    let mut parted: Vec<(StageEdge, usize)> = Vec::with_capacity(count);
    for (part, rest) in rests.iter().enumerate() {
        parted.extend(rest.iter().map(|edge| (edge.clone(), part)));
    }
    let rings: Vec<Vec<_>> = lines.iter().map(|side| ring(&side.edges)).collect();
    let everything = partition(stage, outline, &parted, (std::slice::from_ref(cut), &rings));
    let mut sides: Vec<Arc<Stage>> = Vec::with_capacity(2);
    for (part, side) in lines.into_iter().enumerate() {
        let mut own = vec![side];
        let inside = everything.lines.iter().filter(|found| found.1 == part);
        own.extend(inside.map(|found| found.0.clone()));
        own.sort_by_key(|line| match line.kind {
            LineKind::Outline => 0,
            LineKind::Hole => 1,
            LineKind::Internal => 2,
        });
        let notches = everything.notches.iter().filter(|found| found.1 == part);
        let notches: Vec<StageNotch> = notches.map(|found| Motion::NONE.notch(found.0)).collect();
        let darts = everything
            .darts
            .iter()
            .filter(|found| found.1 == [part, part]);
        let darts: Vec<StageDart> = darts.map(|found| found.0).collect();
        sides.push(Arc::new(Stage {
            lines: own,
            notches,
            darts,
            sides: Vec::new(),
            done: stage.done.iter().copied().chain([by]).collect(),
            ..stage.clone()
        }));
    }
    // On a clockwise outline the side with the forward cut is the right side.
    if stage.turn() < 0.0 {
        sides.reverse();
    }
    sides
}

/// Moves the ends of a cut to exactly the outline. `rest` is the part of the outline from the end of the cut
/// back to its start.
fn fit(cut: &mut [StageEdge], rest: &[StageEdge]) {
    let (Some(next), Some(before)) = (rest.first(), rest.last()) else {
        return;
    };
    let put = |curve: Curve, start: bool| match start {
        true => with_ends(curve, before.curve.end(), curve.end()),
        false => with_ends(curve, curve.start(), next.curve.start()),
    };
    if let Some(first) = cut.first_mut() {
        first.curve = put(first.curve, true);
    }
    if let Some(last) = cut.last_mut() {
        last.curve = put(last.curve, false);
    }
}
