//! Opposite places on a seam, matched notches, and the mirror twin of a sewn edge.

use super::lookup::{self, after};
use super::notch::add_notch;
use super::seam::SewnEdge;
use super::{NearMark, impossible};
use crate::evaluate::SpanValue;
use crate::{
    EdgeId, Edit, EditError, Evaluation, LineId, Mark, Name, NotchId, NotchKind, OperationKind,
    Panel, PanelId, Pattern, SeamId, Span, Want,
};
use toile_geometry::Vec2;

/// Least component of a side's direction along the grain (1): a side with a smaller one counts as running
/// across the grain.
const STEEP: f64 = 0.5;

/// A place on an edge that lies opposite another place when their seam is sewn.
#[derive(Clone, Debug, PartialEq)]
pub struct Opposite {
    /// The panel.
    pub panel: PanelId,
    /// The edge.
    pub edge: EdgeId,
    /// Share of the edge's length, from the start of the edge (1).
    pub share: f64,
}

/// The places that lie opposite a place of an edge, one for each seam there. Each is at the same share of the
/// length of its side, so that ease is spread evenly. A place that lies opposite in several seams, such as
/// those of both halves of a folded panel, is returned once.
pub fn opposites(evaluation: &Evaluation, edge: EdgeId, share: f64) -> Vec<Opposite> {
    let mut found: Vec<Opposite> = Vec::new();
    for seam in &evaluation.pattern().seams {
        let Some(value) = evaluation.seam_value(seam.id) else {
            continue;
        };
        for (own, other) in [(0, 1), (1, 0)] {
            let total = value.lengths[own];
            let Some(along) = reached(evaluation, &value.sides[own], (edge, share)) else {
                continue;
            };
            let way = along / total * value.lengths[other];
            let Some(place) = walked(evaluation, &value.sides[other], way) else {
                continue;
            };
            let is_new = |known: &Opposite| {
                known.edge != place.edge || (known.share - place.share).abs() > 1e-6
            };
            let itself = place.edge == edge && (place.share - share).abs() < 1e-6;
            if total > 0.0 && !itself && found.iter().all(is_new) {
                found.push(place);
            }
        }
    }
    found
}

/// The drawn edge with this name, and its length with the mouths of darts (m). `None`: the edge is not drawn.
fn edge_length(evaluation: &Evaluation, name: Name<EdgeId>) -> Option<(EdgeId, f64)> {
    let Name::Drawn(edge) = name else {
        return None;
    };
    Some((edge, evaluation.edge(edge)?.length()))
}

/// Distance from the start of a side of a seam to a place on one of its edges (m).
fn reached(
    evaluation: &Evaluation,
    side: &[SpanValue],
    (edge, share): (EdgeId, f64),
) -> Option<f64> {
    let mut along = 0.0;
    for &(name, from, to) in side.iter().flat_map(|span| &span.stretch) {
        let (id, length) = edge_length(evaluation, name)?;
        let (low, high) = (from.min(to), from.max(to));
        if id == edge && (low - 1e-9..=high + 1e-9).contains(&share) {
            return Some(along + (share - from).abs() * length);
        }
        along += (to - from).abs() * length;
    }
    None
}

/// The place at a distance from the start of a side of a seam (m).
fn walked(evaluation: &Evaluation, side: &[SpanValue], way: f64) -> Option<Opposite> {
    let mut left = way;
    let mut last = None;
    for span in side {
        for &(name, from, to) in &span.stretch {
            let (edge, length) = edge_length(evaluation, name)?;
            let own = (to - from).abs() * length;
            let part = if own > 0.0 {
                (left / own).min(1.0)
            } else {
                0.0
            };
            last = Some(Opposite {
                panel: span.panel,
                edge,
                share: from + (to - from) * part,
            });
            if left <= own {
                return last;
            }
            left -= own;
        }
    }
    last
}

/// A notch, by its panel and its id.
pub type PanelNotch = (PanelId, NotchId);

/// Plans to add a notch at a mark of a panel, and a notch opposite on each seam there; returns all of these
/// notches too.
///
/// # Errors
/// The mark is a corner, or no seam sews the edge there.
pub fn add_matched_notches(
    evaluation: &Evaluation,
    (panel, near): (PanelId, NearMark),
    kind: NotchKind,
) -> Result<(Vec<Edit>, Vec<PanelNotch>), EditError> {
    let share = match &near.mark {
        Mark::Between { share, .. } => share.value(),
        Mark::Notch(_) | Mark::Along { .. } | Mark::Corner(_) => None,
    };
    let Some(share) = share else {
        return Err(impossible(
            "a corner needs no notch",
            "click on the edge between its corners",
        ));
    };
    let others = match near.edge {
        Name::Drawn(edge) => opposites(evaluation, edge, share),
        Name::Made { .. } => Vec::new(),
    };
    if others.is_empty() {
        return Err(impossible(
            "the edge is not sewn to anything there",
            "sew it first, or put a single notch",
        ));
    }
    let (mut edits, first) = add_notch(evaluation, panel, (near.line, near.mark), kind)?;
    let mut made = vec![(panel, first)];
    let mut state = after(evaluation, &edits)?;
    for other in others {
        let (line, ends) = located(state.pattern(), &other)?;
        let mark = Mark::between(ends, other.share);
        let (more, notch) = add_notch(&state, other.panel, (line, mark), kind)?;
        state = after(&state, &more)?;
        edits.extend(more);
        made.push((other.panel, notch));
    }
    Ok((edits, made))
}

fn located(
    pattern: &Pattern,
    place: &Opposite,
) -> Result<(LineId, [crate::PointId; 2]), EditError> {
    lookup::panel(pattern, place.panel)?;
    let owner = pattern.owner_of(place.panel, place.edge.into());
    let found = owner.and_then(|owner| {
        let line = owner.line_of(place.edge)?.id;
        Some((line, owner.edge(place.edge)?.ends))
    });
    found.ok_or_else(|| EditError::Missing(place.edge.to_string()))
}

/// The edge on the other side of the wearer: on the mirrored half of a folded panel, or on the other copy of
/// a mirrored pair. `None`: the panel is neither folded nor a pair.
pub fn twin(pattern: &Pattern, edge: SewnEdge) -> Option<SewnEdge> {
    let panel = pattern.panel(edge.panel)?;
    match is_folded(panel) {
        true => Some(SewnEdge {
            half: edge.half ^ 1,
            ..edge
        }),
        false => {
            let copy = edge.copy ^ 1;
            let is_pair = panel.cut.mirrored && copy < panel.cut.quantity;
            is_pair.then_some(SewnEdge { copy, ..edge })
        }
    }
}

/// Whether a seam sews the upper end of one side to the lower end of the other, judged by the grain of their
/// panels as drawn. `false` if a side runs across the grain or a panel cannot be drawn.
pub fn is_upside_down(evaluation: &Evaluation, seam: SeamId) -> bool {
    let Some(seam) = evaluation.pattern().seam(seam) else {
        return false;
    };
    let [one, two] = [0, 1].map(|side| rise(evaluation, &seam.sides[side]));
    one.zip(two)
        .is_some_and(|(one, two)| one * two < 0.0 && one.abs().min(two.abs()) > STEEP)
}

/// Whether a seam runs in the same direction round both pieces, seen from their right sides, so that one of
/// the pieces would show its wrong side.
pub fn turns_over(evaluation: &Evaluation, seam: SeamId) -> bool {
    let pattern = evaluation.pattern();
    let Some(seam) = pattern.seam(seam).filter(|seam| seam.right_sides_together) else {
        return false;
    };
    let [one, two] = [0, 1].map(|side| {
        let first = seam.sides[side].first()?;
        let panel = pattern.panel(first.panel)?;
        let odd_copy = panel.cut.mirrored && first.copy % 2 == 1;
        let is_mirrored = odd_copy != (first.half.count_ones() % 2 == 1);
        Some(first.backwards != is_mirrored)
    });
    one.is_some() && one == two
}

/// Component along the grain of the unit vector from the start to the end of a side: 1 if the side leads
/// straight up, -1 if straight down.
fn rise(evaluation: &Evaluation, side: &[Span]) -> Option<f64> {
    let (first, last) = (side.first()?, side.last()?);
    let place = |mark: &Mark| match mark {
        Mark::Corner(Name::Drawn(id)) => evaluation.point(*id),
        Mark::Notch(_) | Mark::Along { .. } | Mark::Between { .. } | Mark::Corner(_) => None,
    };
    let way = place(&last.to)? - place(&first.from)?;
    let panel = evaluation.pattern().panel(first.panel)?;
    let grain = evaluation.number(&panel.grain, Want::Angle)?;
    let along = Vec2::new(grain.cos(), grain.sin());
    Some(way.try_normalize(1e-9)?.dot(&along))
}

fn is_folded(panel: &Panel) -> bool {
    let mut kinds = panel.operations.iter().map(|step| &step.kind);
    kinds.any(|kind| matches!(kind, OperationKind::Fold { .. }))
}
