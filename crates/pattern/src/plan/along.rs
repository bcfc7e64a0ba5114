//! Distances along an edge of a finished panel: darts sewn, pleats folded, openings of a spread included.

use super::impossible;
use super::lookup::{self, finite};
use super::moving::added;
use super::on_stage::{edge_ends, edge_parts};
use crate::stage::{MarkValue, Placed, Spot, is_sewn};
use crate::{
    CornerName, EdgeId, EdgeName, EditError, Evaluation, LineId, Mark, Name, Number, PanelId, Want,
};
use toile_geometry::{Curve, Path, Vec2};

/// Largest difference between distances that count as equal (m).
const SAME: f64 = 1e-9;

/// An edge of a finished panel, from corner to corner.
#[derive(Clone, Debug, PartialEq)]
pub struct FinishedEdge {
    /// The panel.
    pub panel: PanelId,
    /// The line that the edge is on.
    pub line: LineId,
    /// The corners at the ends of the edge.
    pub ends: [CornerName; 2],
    /// Length of the finished edge (m).
    pub length: f64,
    parts: Vec<Part>,
}

/// One curve of a finished edge. It is the stretch of the named edge `edge` between the two `shares` (1).
#[derive(Clone, Debug, PartialEq)]
struct Part {
    edge: EdgeName,
    shares: [f64; 2],
    path: Path,
    /// Distance from the first corner to the start of the curve (m).
    start: f64,
}

/// Returns an edge of a panel as finished.
///
/// # Errors
/// The panel has no such edge, or the edge cannot be drawn.
pub fn finished_edge(
    evaluation: &Evaluation,
    panel: PanelId,
    edge: EdgeId,
) -> Result<FinishedEdge, EditError> {
    let owner = lookup::panel(evaluation.pattern(), panel)?;
    let (line, ends) = edge_ends(evaluation, owner, edge)?;
    let lost = || {
        impossible(
            format!("the edge of panel {:?} cannot be drawn", owner.name),
            "mend the panel first, or choose another edge",
        )
    };
    let stage = evaluation.last_stage(owner).ok_or_else(lost)?;
    let name = Name::Drawn(line);
    let corners = ends.map(|end| Placed::Mark(MarkValue::Corner(end)));
    let stretch = stage.stretch(name, corners, is_sewn).map_err(|_| lost())?;
    let own = |known: &&crate::StageLine| known.name == name && known.half == 0;
    let (mut parts, mut length) = (Vec::new(), 0.0);
    for (edge, from, to) in stretch {
        let within = from.min(to) - SAME..=from.max(to) + SAME;
        let lines = stage.lines.iter().filter(own);
        let found = lines.flat_map(|line| &line.edges).filter(|known| {
            let is_within = within.contains(&known.from) && within.contains(&known.to);
            known.name == edge && known.half == 0 && is_within
        });
        let mut found: Vec<(Curve, [f64; 2])> = found
            .map(|known| (known.curve, [known.from, known.to]))
            .collect();
        found.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        if to < from {
            found.reverse();
        }
        for (curve, shares) in found {
            let path = Path::new(vec![curve]);
            let start = length;
            length += path.length();
            if path.length() > 0.0 {
                parts.push(Part {
                    edge,
                    shares,
                    path,
                    start,
                });
            }
        }
    }
    match length > SAME {
        true => Ok(FinishedEdge {
            panel,
            line,
            ends,
            length,
            parts,
        }),
        false => Err(lost()),
    }
}

impl FinishedEdge {
    /// Distance from the first corner, along the edge, to the point of the edge nearest to `near` (m).
    pub fn nearest(&self, near: Vec2) -> f64 {
        let found = self.parts.iter().filter_map(|part| {
            let place = part.path.nearest(near)?;
            let away = (part.path.point(place) - near).norm();
            Some((away, part.start + place.along))
        });
        let found = found.min_by(|a, b| a.0.total_cmp(&b.0));
        found.map_or(0.0, |(_, along)| along)
    }

    /// The part of the edge at the distance `along` from the first corner, and the distance within that part
    /// (m).
    fn part(&self, along: f64) -> Option<(&Part, f64)> {
        let part = self.parts.iter().rev().find(|part| part.start < along);
        let part = part.or(self.parts.first())?;
        Some((part, (along - part.start).clamp(0.0, part.path.length())))
    }

    /// The named edge at the distance `along` from the first corner (m), and the share of that named edge
    /// there.
    pub fn share(&self, along: f64) -> Option<(EdgeName, f64)> {
        let (part, local) = self.part(along)?;
        let [from, to] = part.shares;
        Some((part.edge, from + (to - from) * local / part.path.length()))
    }

    /// The position at the distance `along` from the first corner (m).
    pub fn place(&self, along: f64) -> Option<Vec2> {
        let (part, along) = self.part(along)?;
        Some(part.path.point(part.path.at_length(along)?))
    }
}

/// The mark on a finished edge at a distance from one of its corners (m). `end` is 0 for the first corner and
/// 1 for the second; distances from the second corner are zero or negative. A mark is measured on the first
/// stage that has its corner, so lengths that later operations take out of the edge or insert are added to
/// the distance.
///
/// # Errors
/// The distance has no value or is longer than the edge.
pub fn mark_along(
    evaluation: &Evaluation,
    edge: &FinishedEdge,
    (end, distance): (usize, &Number),
) -> Result<Mark, EditError> {
    let beyond = || {
        impossible(
            "the edge does not reach so far from its corner",
            "type a distance of zero or more that is no longer than the edge",
        )
    };
    let value = evaluation.number(distance, Want::Length);
    let value = value.ok_or_else(|| impossible("the distance has no value", "type a length"))?;
    finite("the distance", &[Vec2::new(value, 0.0)])?;
    let along = match end {
        0 => value,
        _ => edge.length + value,
    };
    if !(-SAME..=edge.length + SAME).contains(&along) {
        return Err(beyond());
    }
    if value.abs() <= SAME {
        return Ok(Mark::Along {
            from: edge.ends[end],
            distance: distance.clone(),
        });
    }
    let (name, share) = edge.share(along).ok_or_else(beyond)?;
    let spot = Spot {
        edge: name,
        share,
        along,
    };
    match on_first_stage(evaluation, edge, end, spot) {
        Some(first) => Ok(Mark::Along {
            from: edge.ends[end],
            distance: match first - value {
                moved if moved.abs() <= SAME => distance.clone(),
                moved => added(distance, moved),
            },
        }),
        // An operation made this part of the edge: the mark is a share of the part, so that it survives
        // edits.
        None => {
            let panel = lookup::panel(evaluation.pattern(), edge.panel)?;
            let stage = evaluation.last_stage(panel).ok_or_else(beyond)?;
            let mut parts = edge_parts(evaluation, panel, stage).into_iter();
            let made = parts.find(|known| known.edge == spot.edge);
            Ok(Mark::Between {
                ends: made.ok_or_else(beyond)?.ends,
                share: spot.share.into(),
            })
        }
    }
}

/// Distance from a corner of a finished edge to a spot on it, on the first stage that has the corner (m);
/// negative against the line. `None`: that stage does not have the spot.
fn on_first_stage(
    evaluation: &Evaluation,
    edge: &FinishedEdge,
    end: usize,
    spot: Spot,
) -> Option<f64> {
    let pattern = evaluation.pattern();
    let panel = pattern.panel(edge.panel)?;
    let lineage = pattern.stage_lineage(panel);
    let corner = edge.ends[end];
    let first = pattern.first_step(panel, &lineage, &Mark::Corner(corner))?;
    let (of, after) = lineage.stage(first)?;
    let stage = evaluation.stage(of, after)?;
    let line = Name::Drawn(edge.line);
    let corner = Placed::Mark(MarkValue::Corner(corner));
    let ends = match end {
        0 => [corner, Placed::Spot(spot)],
        _ => [Placed::Spot(spot), corner],
    };
    let stretch = stage.stretch(line, ends, |_| true).ok()?;
    let length = stage.stretch_length(0, &stretch);
    Some(if end == 0 { length } else { -length })
}
