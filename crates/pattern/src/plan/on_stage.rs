//! Edges of a finished panel: their positions and their corners.

use super::{impossible, lookup};
use crate::stage::MarkValue;
use crate::{
    CornerName, EdgeId, EdgeName, EditError, Evaluation, LineId, LineKind, LineName, Mark, Name,
    Number, Panel, PanelId, PartId, Role, Stage, StageEdge, StageLine,
};
use toile_geometry::{Curve, Path, Vec2};

/// A position on an edge of a finished panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OnEdge {
    pub line: LineId,
    pub edge: EdgeName,
    /// Corners at the ends of the whole edge; for a drawn edge its drawn ends.
    pub ends: [CornerName; 2],
    /// Share of the edge's arc length, from the start of the edge (1).
    pub share: f64,
    /// Length of the whole edge (m).
    pub length: f64,
    pub at: Vec2,
}

/// A part of an edge on a stage of a panel, with one curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePart {
    /// The line that the edge is on.
    pub line: LineId,
    /// Name of the edge that the part belongs to.
    pub edge: EdgeName,
    /// Corners at the ends of the whole edge; for a drawn edge its drawn ends.
    pub ends: [CornerName; 2],
    /// Shares of the edge's arc length at the start and the end of the part (1).
    pub shares: [f64; 2],
    /// The curve of the part (m).
    pub curve: Curve,
}

/// All parts of the edges on a stage of a panel. Legs of darts, and halves of a folded panel that are not
/// drawn, are left out.
pub fn edge_parts(evaluation: &Evaluation, panel: &Panel, stage: &Stage) -> Vec<EdgePart> {
    let mut parts = Vec::new();
    for line in &stage.lines {
        let Name::Drawn(id) = line.name else {
            continue;
        };
        for (k, edge) in line.edges.iter().enumerate() {
            let is_own = edge.half == 0 && edge.name.role() != Some(Role::Leg);
            if let Some(ends) = ends_of(evaluation, panel, (line, k)).filter(|_| is_own) {
                parts.push(EdgePart {
                    line: id,
                    edge: edge.name,
                    ends,
                    shares: [edge.from, edge.to],
                    curve: edge.curve,
                });
            }
        }
    }
    parts
}

impl EdgePart {
    /// The position on the part nearest to a point (m), and its share of the whole edge's arc length. `None`:
    /// the part has no length.
    pub fn nearest(&self, near: Vec2) -> Option<(Vec2, f64)> {
        let path = Path::new(vec![self.curve]);
        let place = path.nearest(near)?;
        let length = path.length();
        let [from, to] = self.shares;
        let share = from + (to - from) * place.along / length;
        (length > 0.0).then(|| (path.point(place), share))
    }
}

/// The position on the wanted edges of a finished panel that is nearest to a point (m). `None`: the panel has
/// no such edge.
pub(super) fn nearest_edge(
    evaluation: &Evaluation,
    panel: &Panel,
    near: Vec2,
    wanted: impl Fn(EdgeName) -> bool,
) -> Option<OnEdge> {
    let stage = evaluation.last_stage(panel)?;
    let parts = edge_parts(evaluation, panel, stage).into_iter();
    let found = parts.filter(|part| wanted(part.edge)).filter_map(|part| {
        let (at, share) = part.nearest(near)?;
        Some(((at - near).norm(), part, at, share))
    });
    let (_, part, at, share) = found.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let covered = (part.shares[1] - part.shares[0]).abs();
    Some(OnEdge {
        line: part.line,
        edge: part.edge,
        ends: part.ends,
        share,
        length: part.curve.length() / covered.max(1e-12),
        at,
    })
}

/// Corners at the ends of the whole edge to which the edge `k` of a stage line belongs.
fn ends_of(
    evaluation: &Evaluation,
    panel: &Panel,
    (line, k): (&StageLine, usize),
) -> Option<[CornerName; 2]> {
    match line.edges[k].name {
        Name::Drawn(id) => {
            let owner = evaluation.pattern().owner_of(panel.id, PartId::Edge(id));
            Some(owner?.edge(id)?.ends.map(Name::Drawn))
        }
        made @ Name::Made { .. } => corners_of(line, made),
    }
}

/// Corners at the start and the end of a named edge of a line on its stage.
fn corners_of(line: &StageLine, edge: EdgeName) -> Option<[CornerName; 2]> {
    let count = line.edges.len();
    let is_own = |k: usize| {
        let found: &StageEdge = &line.edges[k % count];
        found.name == edge && found.half == 0
    };
    let is_closed = line.kind != LineKind::Internal;
    let begins = |k: &usize| is_own(*k) && (!is_own(*k + count - 1) || *k == 0 && !is_closed);
    let first = (0..count).find(begins)?;
    let after = (first..first + count).find(|&k| !is_own(k));
    let end = match after {
        Some(k) if is_closed || k < count => line.edges[k % count].start,
        _ => line.end,
    };
    Some([line.edges[first].start?, end?])
}

/// A mark with its number evaluated.
pub(super) fn mark_value(evaluation: &Evaluation, panel: &Panel, mark: &Mark) -> Option<MarkValue> {
    let number = |number: &Number, want| evaluation.number(number, want);
    Some(match mark {
        Mark::Corner(corner) => MarkValue::Corner(*corner),
        Mark::Along { from, distance } => {
            MarkValue::Along(*from, number(distance, crate::Want::Length)?)
        }
        Mark::Between { ends, share } => {
            MarkValue::Between(*ends, number(share, crate::Want::Plain)?)
        }
        Mark::Notch(id) => match &evaluation.pattern().notch_of(panel, *id)?.at {
            Mark::Notch(_) => return None,
            at @ (Mark::Along { .. } | Mark::Between { .. } | Mark::Corner(_)) => {
                mark_value(evaluation, panel, at)?
            }
        },
    })
}

/// Position, on the finished panel, of a mark on a line (m).
pub(super) fn place_of(
    evaluation: &Evaluation,
    panel: &Panel,
    (line, mark): (LineName, &Mark),
) -> Option<Vec2> {
    let stage = evaluation.last_stage(panel)?;
    let value = mark_value(evaluation, panel, mark)?;
    let pattern = evaluation.pattern();
    let lineage = pattern.stage_lineage(panel);
    let (of, after) = lineage.stage(pattern.first_step(panel, &lineage, mark)?)?;
    let first = evaluation.stage(of, after)?;
    let spot = match mark {
        Mark::Corner(_) => stage.spot(line, value),
        Mark::Notch(_) | Mark::Along { .. } | Mark::Between { .. } => first.spot(line, value),
    };
    Some(stage.at_spot(line, spot.ok()?)?.0)
}

/// Name of the outline of a finished panel.
///
/// # Errors
/// The panel is missing or its outline cannot be drawn.
pub fn outline_of(evaluation: &Evaluation, panel: PanelId) -> Result<LineName, EditError> {
    let panel = lookup::panel(evaluation.pattern(), panel)?;
    let stage = evaluation.last_stage(panel);
    let mut lines = stage.into_iter().flat_map(|stage| &stage.lines);
    let found = lines.find(|line| line.kind == LineKind::Outline);
    found.map(|line| line.name).ok_or_else(|| {
        impossible(
            format!("panel {:?} cannot be drawn", panel.name),
            "mend its outline first",
        )
    })
}

/// The line of an edge of a panel, and the corners of the edge on it. For an edge that a split divides, these
/// are the corners of the part on this side.
///
/// # Errors
/// The panel has no such edge, or no part of the edge lies on this side.
pub fn edge_ends(
    evaluation: &Evaluation,
    panel: &Panel,
    edge: EdgeId,
) -> Result<(LineId, [CornerName; 2]), EditError> {
    let missing = || EditError::Missing(format!("{edge} of panel {:?}", panel.name));
    let owner = evaluation.pattern().owner_of(panel.id, PartId::Edge(edge));
    let owner = owner.ok_or_else(missing)?;
    let (line, drawn) = (
        owner.line_of(edge).ok_or_else(missing)?,
        owner.edge(edge).ok_or_else(missing)?,
    );
    if owner.id == panel.id {
        return Ok((line.id, drawn.ends.map(Name::Drawn)));
    }
    let on_side = |stage: &Stage| {
        let own = |known: &&StageLine| known.name == Name::Drawn(line.id) && known.half == 0;
        let mut lines = stage.lines.iter().filter(own);
        lines.find_map(|line| corners_of(line, Name::Drawn(edge)))
    };
    let ends = evaluation.stage(panel.id, None).and_then(|s| on_side(s));
    let ends = ends.ok_or_else(|| {
        impossible(
            format!(
                "edge {:?} does not lie on panel {:?}",
                drawn.name, panel.name
            ),
            "choose an edge of that side",
        )
    })?;
    Ok((line.id, ends))
}
