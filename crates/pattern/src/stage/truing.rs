//! Trued darts: the edges beside their mouths are redrawn so that they run on across the closed darts, and
//! the legs of each dart become equally long.
//!
//! # Decided with
//! - [`crate::stage::fair::Row`], [`crate::stage::fair::MAX_GROWTH`]: the edge redrawn; how much longer it
//!   may become;
//! - [`crate::stage::kept_length::width_kept`], [`crate::plan::finished_length`]: a width that keeps the
//!   finished length; the length told;
//! - [`crate::evaluate`] (`operations.rs`, `trued`): who calls it for the darts of a panel;
//! - [`crate::kinks`]: kinks across darts, pleats and seams;
//! - [`crate::document::Operation`], [`crate::document::EdgeCorner`]: a kink that is meant.

use super::dart::parameter;
use super::fair::{Closing, NotTrued, Row, arriving, between, leaving};
use super::{Stage, StageEdge, with_ends};
use crate::{CornerName, EdgeCorner, LineKind, Name, OperationId, Role};
use std::f64::consts::FRAC_PI_8;
use toile_geometry::Curve;

/// Turn of an edge above which it has a kink where it continues across a dart, pleat or seam (rad). At this
/// turn a line is half a millimetre off its former direction after one centimetre.
pub(crate) const KINK: f64 = 3.0 * std::f64::consts::PI / 180.0;
/// Turn between edges with different names above which they form a corner, so that neither continues the
/// other (rad).
pub(crate) const CORNER: f64 = std::f64::consts::PI / 6.0;
/// Largest difference between two places on an edge, as shares of its length, that count as one place (1).
const SAME_SHARE: f64 = 1e-9;

/// A row of darts, as in [`Row`], by indices of the edges of the outline.
struct DartRow {
    /// Indices of the edges of each stretch before, between and after the darts.
    stretches: Vec<Vec<usize>>,
    /// Index of the first leg of each dart.
    legs: Vec<usize>,
    /// Indices of the darts in the stage.
    darts: Vec<usize>,
}

/// The stage with the edges across its trued darts redrawn; also the darts that cannot be trued, each with
/// the reason. At the corners `going_on`, where edges continue smoothly, they keep their direction.
pub(crate) fn true_darts(
    mut stage: Stage,
    going_on: &[CornerName],
) -> (Stage, Vec<(OperationId, NotTrued)>) {
    let is_outline = |line: &super::StageLine| line.kind == LineKind::Outline;
    let mut refused = Vec::new();
    if !stage.darts.iter().any(|dart| dart.trued && dart.half == 0) {
        return (stage, refused);
    }
    let Some(outline) = stage.lines.iter().position(is_outline) else {
        return (stage, refused);
    };
    stage.untrued = stage.lines[outline].edges.clone();
    divide_arcs(&mut stage, outline);
    let rows = rows(&stage, outline);
    let alone = beside_no_row(&stage, outline, &rows).into_iter();
    refused.extend(alone.map(|by| (by, NotTrued::NoLine)));
    for row in &rows {
        let plain = row.plain(&stage, outline, going_on);
        match plain.is_smooth() {
            true => {}
            false => match plain.redrawn() {
                Ok(redrawn) => row.put(&mut stage, outline, redrawn),
                Err(why) => refused.extend(row.darts.iter().map(|k| (stage.darts[*k].by, why))),
            },
        }
    }
    follow(&mut stage, outline, &rows);
    (stage, refused)
}

impl Stage {
    /// The edge that a dart opens in, and its length without mouths of darts (m). `None`: the dart lies
    /// between two edges.
    pub fn edge_beside(&self, dart: OperationId) -> Option<(crate::EdgeName, f64)> {
        let edges = self.outline();
        let is_own = |edge: &&StageEdge| edge.half == 0;
        let first = edges
            .iter()
            .position(|e| e.half == 0 && e.name == leg(dart, 0))?;
        let before = &edges[(first + edges.len() - 1) % edges.len()];
        let after = &edges[(first + 2) % edges.len()];
        let own = edges
            .iter()
            .filter(is_own)
            .filter(|e| e.name == before.name);
        let length = own.map(|edge| edge.curve.length()).sum();
        (before.name == after.name).then_some((before.name, length))
    }

    /// The stage with the outline that it had before its darts were trued, if that is recorded; else the
    /// stage unchanged.
    pub(crate) fn as_untrued(&self) -> Self {
        let mut stage = self.clone();
        let outline = |line: &&mut super::StageLine| line.kind == LineKind::Outline;
        let untrued = std::mem::take(&mut stage.untrued);
        if let Some(line) = stage.lines.iter_mut().find(outline)
            && !untrued.is_empty()
        {
            line.edges = untrued;
        }
        stage
    }
}

/// Darts that are to be trued and take in cloth, but are in no row: no edge runs on across their mouths.
fn beside_no_row(stage: &Stage, outline: usize, rows: &[DartRow]) -> Vec<OperationId> {
    let edges = &stage.lines[outline].edges;
    let is_open = |by: OperationId| edges.iter().any(|e| e.half == 0 && e.name == leg(by, 0));
    let darts = stage.darts.iter().enumerate();
    let lone = darts.filter(|(k, dart)| {
        let is_in_row = rows.iter().any(|row| row.darts.contains(k));
        dart.trued && dart.half == 0 && is_open(dart.by) && !is_in_row
    });
    lone.map(|(_, dart)| dart.by).collect()
}

/// Divides arcs of edges with trued darts, so that a cubic can follow each part of the arc closely.
fn divide_arcs(stage: &mut Stage, outline: usize) {
    let mut rows = rows(stage, outline);
    rows.retain(|row| !row.plain(stage, outline, &[]).is_smooth());
    let edges = &mut stage.lines[outline].edges;
    let curved: Vec<usize> = rows.iter().flat_map(|row| row.stretches.concat()).collect();
    let mut divided = Vec::with_capacity(edges.len());
    for (k, edge) in edges.drain(..).enumerate() {
        match edge.curve {
            Curve::Arc { bulge, .. } if curved.contains(&k) => {
                let count = (4.0 * bulge.atan().abs() / FRAC_PI_8).ceil().max(1.0);
                let share = |j: f64| edge.from + (edge.to - edge.from) * j / count;
                divided.extend((0..count as u32).map(f64::from).map(|j| StageEdge {
                    from: share(j),
                    to: share(j + 1.0),
                    curve: edge.curve.between(j / count, (j + 1.0) / count),
                    start: edge.start.filter(|_| j == 0.0),
                    corner: if j == 0.0 {
                        edge.corner
                    } else {
                        EdgeCorner::default()
                    },
                    ..edge.clone()
                }));
            }
            Curve::Line { .. }
            | Curve::Arc { .. }
            | Curve::Quadratic { .. }
            | Curve::Cubic { .. } => divided.push(edge),
        }
    }
    *edges = divided;
}

fn leg(by: OperationId, index: u16) -> crate::EdgeName {
    Name::Made {
        by,
        role: Role::Leg,
        index,
    }
}

/// The rows of trued darts in an outline.
fn rows(stage: &Stage, outline: usize) -> Vec<DartRow> {
    let edges = &stage.lines[outline].edges;
    let count = edges.len();
    // Index of the first leg of a dart that is to be trued, if an edge runs on across its mouth.
    let within = |number: usize| -> Option<usize> {
        let dart = &stage.darts[number];
        let is_first = |edge: &StageEdge| edge.name == leg(dart.by, 0) && edge.half == 0;
        let first = edges.iter().position(is_first)?;
        let [before, second, after] = [count - 1, 1, 2].map(|step| &edges[(first + step) % count]);
        let is_pair = second.name == leg(dart.by, 1) && second.half == 0;
        let is_whole = before.half == 0 && after.half == 0;
        let closing = Closing {
            apex: edges[first].curve.end(),
            ends: [edges[first].curve.start(), second.curve.end()],
        };
        let runs_on = match before.name == after.name {
            true => before.to <= after.from + SAME_SHARE && before.from < before.to,
            false => {
                let is_leg = |edge: &StageEdge| edge.name.role() == Some(Role::Leg);
                let kink = closing.kink(&[before.curve], &[after.curve]);
                !is_leg(before) && !is_leg(after) && kink.is_some_and(|kink| kink.abs() <= CORNER)
            }
        };
        (dart.trued && dart.half == 0 && is_pair && is_whole && runs_on).then_some(first)
    };
    let mut darts: Vec<(usize, usize)> = (0..stage.darts.len())
        .filter_map(|number| Some((within(number)?, number)))
        .collect();
    darts.sort_unstable();
    let mut rows: Vec<DartRow> = Vec::new();
    while let Some(&(mut first, mut number)) = darts.first() {
        let mut walked = vec![number];
        // Goes back to the first dart of the same edge.
        while let Some(&(leg, before)) = darts
            .iter()
            .find(|(leg, _)| (leg + 2) % count == stretch_before(edges, first)[0])
            && !walked.contains(&before)
        {
            (first, number) = (leg, before);
            walked.push(number);
        }
        let mut row = DartRow {
            stretches: vec![stretch_before(edges, first)],
            legs: Vec::new(),
            darts: Vec::new(),
        };
        while let Some(k) = darts.iter().position(|(leg, _)| *leg == first) {
            let (_, number) = darts.remove(k);
            row.legs.push(first);
            row.darts.push(number);
            let stretch = stretch_after(edges, (first + 2) % count);
            first = stretch.last().map_or(first, |last| (last + 1) % count);
            row.stretches.push(stretch);
        }
        rows.push(row);
    }
    rows
}

/// Indices of the consecutive edges with the same name that end where the edge `end` starts.
fn stretch_before(edges: &[StageEdge], end: usize) -> Vec<usize> {
    let count = edges.len();
    let mut stretch = vec![(end + count - 1) % count];
    while stretch.len() < count {
        let first = stretch[0];
        let before = (first + count - 1) % count;
        if !follows(&edges[before], &edges[first]) {
            break;
        }
        stretch.insert(0, before);
    }
    stretch
}

/// Indices of the consecutive edges with the same name that begin with the edge `start`.
fn stretch_after(edges: &[StageEdge], start: usize) -> Vec<usize> {
    let count = edges.len();
    let mut stretch = vec![start];
    while stretch.len() < count {
        let last = stretch[stretch.len() - 1];
        let after = (last + 1) % count;
        if !follows(&edges[last], &edges[after]) {
            break;
        }
        stretch.push(after);
    }
    stretch
}

fn follows(before: &StageEdge, after: &StageEdge) -> bool {
    before.name == after.name
        && before.half == after.half
        && (before.to - after.from).abs() < SAME_SHARE
}

impl DartRow {
    fn is_curved(&self, edges: &[StageEdge]) -> bool {
        let mut all = self.stretches.iter().flatten();
        all.any(|k| !matches!(edges[*k].curve, Curve::Line { .. }))
    }

    /// The row as curves and points, without names.
    fn plain(&self, stage: &Stage, outline: usize, going_on: &[CornerName]) -> Row {
        let line = &stage.lines[outline];
        let edges = &line.edges;
        let count = edges.len();
        let curves = |stretch: &Vec<usize>| stretch.iter().map(|k| edges[*k].curve).collect();
        let closings = self.legs.iter().map(|&first| Closing {
            apex: edges[first].curve.end(),
            ends: [
                edges[first].curve.start(),
                edges[(first + 1) % count].curve.end(),
            ],
        });
        let first = self.stretches[0][0];
        let last = *self.stretches[self.legs.len()].last().unwrap_or(&first);
        let keeps = [first, (last + 1) % count].map(|corner| {
            let ways = [
                arriving(&[edges[(corner + count - 1) % count].curve]),
                leaving(&[edges[corner].curve]),
            ];
            let is_straight_on = match ways {
                [Some(from), Some(to)] => between(from, to).abs() <= KINK,
                _ => false,
            };
            let called = |name: &CornerName| {
                let named = line.called(*name);
                edges[corner].start == Some(named)
            };
            is_straight_on || going_on.iter().any(called) || self.is_curved(edges)
        });
        Row {
            stretches: self.stretches.iter().map(curves).collect(),
            closings: closings.collect(),
            keeps,
        }
    }

    /// Puts the redrawn edges and legs into the outline.
    fn put(&self, stage: &mut Stage, outline: usize, redrawn: super::fair::Redrawn) {
        let edges = &mut stage.lines[outline].edges;
        let count = edges.len();
        let numbers = self.stretches.iter().flatten();
        for (k, curve) in numbers.zip(redrawn.stretches.into_iter().flatten()) {
            edges[*k].curve = curve;
        }
        for (&first, [open, close]) in self.legs.iter().zip(redrawn.ends) {
            let apex = edges[first].curve.end();
            edges[first].curve = with_ends(edges[first].curve, open, apex);
            let second = &mut edges[(first + 1) % count];
            second.curve = with_ends(second.curve, apex, close);
        }
    }
}

/// Moves the mouths of darts in rows, and notches on the redrawn edges, with the outline.
fn follow(stage: &mut Stage, outline: usize, rows: &[DartRow]) {
    let edges = &stage.lines[outline].edges;
    let stretches = rows.iter().flat_map(|row| &row.stretches);
    let redrawn: Vec<crate::EdgeName> = stretches.map(|s| edges[s[0]].name).collect();
    let end = |by: OperationId, k: u16| {
        let mut legs = edges.iter().filter(|edge| edge.half == 0);
        let leg = legs.find(|edge| edge.name == leg(by, k))?;
        Some(match k {
            0 => leg.curve.start(),
            _ => leg.curve.end(),
        })
    };
    for dart in stage.darts.iter_mut().filter(|d| d.trued && d.half == 0) {
        if let (Some(open), Some(close)) = (end(dart.by, 0), end(dart.by, 1)) {
            dart.mouth = [open, close];
        }
    }
    let turn = stage.turn();
    let edges = &stage.lines[outline].edges;
    let beside = |notch: &&mut super::StageNotch| notch.half == 0 && redrawn.contains(&notch.edge);
    for notch in stage.notches.iter_mut().filter(beside) {
        let own = |edge: &&StageEdge| {
            edge.name == notch.edge
                && edge.half == 0
                && (edge.from.min(edge.to) - SAME_SHARE..=edge.from.max(edge.to) + SAME_SHARE)
                    .contains(&notch.share)
        };
        let Some(edge) = edges.iter().find(own) else {
            continue;
        };
        let t = parameter(edge, notch.share).clamp(0.0, 1.0);
        if let Some(along) = edge.curve.derivative(t).try_normalize(1e-15) {
            notch.point = edge.curve.point(t);
            notch.inward = toile_geometry::Vec2::new(-along.y, along.x) * turn;
        }
    }
}
