//! Darts taken out of a line.

use super::{NOTHING, PlaceError, Placed, Spot, Stage, StageDart, StageEdge, StageLine, with_ends};
use crate::{EdgeCorner, LineKind, LineName, Name, OperationId, Pressed, Role};
use toile_geometry::{Curve, Vec2};

/// A dart with its numbers evaluated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DartMouth {
    pub by: OperationId,
    pub line: LineName,
    /// Position of the middle of the mouth.
    pub middle: Spot,
    /// Width of the mouth along the line (m).
    pub intake: f64,
    pub apex: DartApex,
    pub pressed: Pressed,
    /// Whether the dart is trued: the edge is made smooth across its closed mouth.
    pub trued: bool,
}

/// The end of a dart inside the panel (its point), with its number evaluated.
#[derive(Clone, Copy, Debug)]
pub(crate) enum DartApex {
    /// The apex lies at this distance from the middle of the mouth, square to the mouth (m).
    Depth(f64),
    /// The apex lies at this point (m).
    Point(Vec2),
}

/// Reason why a dart cannot be taken out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum DartError {
    /// The line, or the place on it, does not exist on the stage.
    Place(PlaceError),
    /// The width is negative, or larger than the edge has room for.
    TooWide,
    /// Another dart lies at the same place.
    Overlaps,
}

/// Takes a dart out of a stage. With width 0 no cloth is taken out, and both ends of the mouth are one
/// corner.
pub(crate) fn cut_dart(stage: &Stage, dart: &DartMouth) -> Result<Stage, DartError> {
    let turn = stage.turn();
    let mut result = stage.clone();
    let found = result
        .lines
        .iter_mut()
        .find(|line| line.name == dart.line && line.half == 0 && line.kind == LineKind::Outline);
    let line = found.ok_or(DartError::Place(PlaceError::NoLine))?;
    if dart.intake.abs() <= NOTHING {
        let along = line.placed(Placed::Spot(dart.middle));
        shut_mouth(line, dart.by, along.map_err(DartError::Place)?);
        result.idle.push(dart.by);
        return Ok(result);
    }
    let pieces: Vec<usize> = (0..line.edges.len())
        .filter(|&k| line.edges[k].name == dart.middle.edge)
        .collect();
    // Length of the whole named edge, including mouths of other darts.
    let covered = |k: &usize| (line.edges[*k].to - line.edges[*k].from).abs();
    let has_middle = |k: &usize| {
        let edge = &line.edges[*k];
        (edge.from.min(edge.to)..=edge.from.max(edge.to)).contains(&dart.middle.share)
    };
    let mut long = pieces.iter().filter(|k| covered(k) > 1e-12);
    let measured = long.clone().find(|k| has_middle(k)).or_else(|| long.next());
    let measured = measured.ok_or(DartError::Place(PlaceError::Beyond))?;
    let length = line.edges[*measured].curve.length() / covered(measured);
    let half = 0.5 * dart.intake / length.max(1e-12);
    let (from, to) = (dart.middle.share - half, dart.middle.share + half);
    if dart.intake < 0.0 || from < -1e-9 || to > 1.0 + 1e-9 {
        return Err(DartError::TooWide);
    }
    let (from, to) = (from.clamp(0.0, 1.0), to.clamp(0.0, 1.0));
    let covered: f64 = pieces
        .iter()
        .map(|&k| {
            let edge = &line.edges[k];
            (edge.to.min(to) - edge.from.max(from)).max(0.0)
        })
        .sum();
    if (covered - (to - from)).abs() > 1e-9 {
        return Err(DartError::Overlaps);
    }
    let (open, close) = (
        point_at(&line.edges, &pieces, from),
        point_at(&line.edges, &pieces, to),
    );
    let (Some(open), Some(close)) = (open, close) else {
        return Err(DartError::Overlaps);
    };
    let apex = match dart.apex {
        DartApex::Point(apex) => apex,
        DartApex::Depth(depth) => {
            let chord = close - open;
            let left = Vec2::new(-chord.y, chord.x) * turn;
            let inward = left.try_normalize(1e-15).unwrap_or_else(Vec2::zeros);
            (open + close) * 0.5 + inward * depth
        }
    };
    let mut edges: Vec<StageEdge> = Vec::with_capacity(line.edges.len() + 3);
    let mut legs = Some(legs(dart.by, [open, close], apex));
    let mut swallowed = None;
    for edge in &line.edges {
        let outside =
            edge.name != dart.middle.edge || edge.to <= from + 1e-12 || edge.from >= to - 1e-12;
        if outside {
            let is_after = edge.name == dart.middle.edge && edge.from >= to - 1e-12;
            if is_after {
                edges.extend(legs.take().into_iter().flatten());
            }
            edges.push(edge.clone());
            continue;
        }
        if (from - edge.from) * length > 1e-9 {
            edges.push(part(edge, edge.from, from, [edge.curve.start(), open]));
        } else if legs.is_some() {
            swallowed = edge.start;
        }
        edges.extend(legs.take().into_iter().flatten());
        if (edge.to - to) * length > 1e-9 {
            let after = part(edge, to, edge.to, [close, edge.curve.end()]);
            edges.push(StageEdge {
                start: Some(mouth(dart.by, 1)),
                corner: EdgeCorner::default(),
                ..after
            });
        }
    }
    line.edges = edges;
    line.twins
        .extend(swallowed.map(|corner| [corner, mouth(dart.by, 0)]));
    let leg = line
        .edges
        .iter()
        .position(|edge| edge.start == Some(mouth(dart.by, 0)));
    let next = leg.map_or(0, |k| (k + 2) % line.edges.len());
    if line.edges[next].start != Some(mouth(dart.by, 1)) {
        line.call(next, mouth(dart.by, 1));
    }
    result.darts.push(StageDart {
        by: dart.by,
        half: 0,
        mouth: [open, close],
        apex,
        pivot: apex,
        pressed: dart.pressed,
        trued: dart.trued,
    });
    Ok(result)
}

/// Adds a dart's mouth of width 0: both of its ends are named at one position on a line (m).
pub(super) fn shut_mouth(line: &mut StageLine, by: OperationId, along: f64) {
    let at = line.divide(along);
    for end in 0..2 {
        line.call(at, mouth(by, end));
    }
}

/// Name of an end of a dart's mouth.
pub(super) fn mouth(by: OperationId, index: u16) -> crate::CornerName {
    Name::Made {
        by,
        role: Role::Mouth,
        index,
    }
}

/// Both legs of a dart, from the start of its mouth to its apex and on to the end of its mouth.
pub(super) fn legs(by: OperationId, [open, close]: [Vec2; 2], apex: Vec2) -> [StageEdge; 2] {
    let made = |role, index| Name::Made { by, role, index };
    let ends = [(open, apex), (apex, close)];
    [0, 1].map(|k: u16| {
        let (start, end) = ends[usize::from(k)];
        StageEdge {
            name: made(Role::Leg, k),
            half: 0,
            start: Some(match k {
                0 => mouth(by, 0),
                _ => Name::Made {
                    by,
                    role: Role::Apex,
                    index: 0,
                },
            }),
            from: 0.0,
            to: 1.0,
            curve: Curve::Line { start, end },
            allowance: 0.0,
            corner: EdgeCorner::default(),
        }
    })
}

/// The part of a stage edge between two shares of its named edge, moved to start and end at the given points.
pub(super) fn part(edge: &StageEdge, from: f64, to: f64, [start, end]: [Vec2; 2]) -> StageEdge {
    let parameter = |share: f64| parameter(edge, share);
    let curve = edge.curve.between(parameter(from), parameter(to));
    StageEdge {
        from,
        to,
        curve: with_ends(curve, start, end),
        ..edge.clone()
    }
}

pub(super) fn parameter(edge: &StageEdge, share: f64) -> f64 {
    let local = (share - edge.from) / (edge.to - edge.from);
    edge.curve.parameter_at_length(local * edge.curve.length())
}

fn point_at(edges: &[StageEdge], pieces: &[usize], share: f64) -> Option<Vec2> {
    let mut found = pieces.iter().map(|&k| &edges[k]);
    let edge = found.find(|edge| (edge.from - 1e-9..=edge.to + 1e-9).contains(&share))?;
    Some(
        edge.curve
            .point(parameter(edge, share.clamp(edge.from, edge.to))),
    )
}
