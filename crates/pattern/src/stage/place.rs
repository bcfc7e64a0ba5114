//! Positions and stretches on the lines of a stage.

use super::{Stage, StageEdge, StageLine};
use crate::{CornerName, EdgeName, LineName, Role};
use toile_geometry::Vec2;

/// A mark with its number evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MarkValue {
    Corner(CornerName),
    /// At a distance from a corner along the line (m).
    Along(CornerName, f64),
    /// At a share of the way from one corner to another (1).
    Between([CornerName; 2], f64),
}

/// A position on a line: given by a mark on this stage, or by a spot that was found on an earlier stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Placed {
    Mark(MarkValue),
    Spot(Spot),
}

/// A spot: a position on a named edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spot {
    pub edge: EdgeName,
    /// Share of the named edge's arc length (1).
    pub share: f64,
    /// Arc length from the start of the line to the spot (m).
    pub along: f64,
}

/// Stretch of a line: named edges in walking order, each with the two shares between which it is walked.
pub(crate) type Stretch = Vec<(EdgeName, f64, f64)>;

/// Reason why a mark has no position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PlaceError {
    /// The stage has no such line.
    NoLine,
    /// The line has no such corner.
    NoCorner(CornerName),
    /// The position lies beyond the end of the line, or the share is not between 0 and 1.
    Beyond,
}

/// Distance by which a share (1) or a length (m) may exceed its bounds through rounding.
const SLACK: f64 = 1e-9;

impl Stage {
    /// Applies `give` to the lines with a name and returns the first success. A line that was divided is
    /// several lines with the same name.
    fn of_line<T>(
        &self,
        name: LineName,
        give: impl Fn(&StageLine) -> Result<T, PlaceError>,
    ) -> Result<T, PlaceError> {
        let mut error = PlaceError::NoLine;
        let own = |line: &&StageLine| line.name == name && line.half == 0;
        for line in self.lines.iter().filter(own) {
            match give(line) {
                Ok(found) => return Ok(found),
                Err(other) if error == PlaceError::NoLine => error = other,
                Err(_) => {}
            }
        }
        Err(error)
    }

    /// The spot at which a mark lies on a line.
    pub(crate) fn spot(&self, line: LineName, mark: MarkValue) -> Result<Spot, PlaceError> {
        self.of_line(line, |line| Ok(line.at(line.along(mark)?, mark)))
    }

    /// Position, on this stage, of a mark of the earlier stage `first`. A corner that still exists is taken
    /// where it is now; any other mark is a spot of the earlier stage.
    pub(crate) fn placed(
        &self,
        first: &Self,
        line: LineName,
        mark: MarkValue,
    ) -> Result<Placed, PlaceError> {
        let is_here = |corner| self.of_line(line, |line| line.corner(corner)).is_ok();
        match mark {
            MarkValue::Corner(corner) if is_here(corner) => Ok(Placed::Mark(mark)),
            MarkValue::Corner(_) | MarkValue::Along(..) | MarkValue::Between(..) => {
                first.spot(line, mark).map(Placed::Spot)
            }
        }
    }

    /// Position (m) and unit direction of the line at a spot.
    pub(crate) fn at_spot(&self, line: LineName, spot: Spot) -> Option<(Vec2, Vec2)> {
        let own = |known: &&StageLine| known.name == line && known.half == 0;
        let edges = self.lines.iter().filter(own).flat_map(|line| &line.edges);
        let mut edges = edges.filter(|edge| edge.name == spot.edge);
        let found = edges.find(|edge| {
            let (low, high) = (edge.from.min(edge.to), edge.from.max(edge.to));
            (low - SLACK..=high + SLACK).contains(&spot.share)
        });
        let edge = found?;
        let local = ((spot.share - edge.from) / (edge.to - edge.from)).clamp(0.0, 1.0);
        let t = edge.curve.parameter_at_length(edge.curve.length() * local);
        let direction = edge.curve.derivative(t).try_normalize(1e-15)?;
        Some((edge.curve.point(t), direction))
    }

    /// The stretch between two positions of a line, without the edges for which `wanted` is false.
    pub(crate) fn stretch(
        &self,
        line: LineName,
        [from, to]: [Placed; 2],
        wanted: impl Fn(&StageEdge) -> bool,
    ) -> Result<Stretch, PlaceError> {
        self.of_line(line, |line| {
            let (start, end) = (line.placed(from)?, line.placed(to)?);
            Ok(line.between(start, end, &wanted))
        })
    }

    /// Length of a stretch on one half of a folded panel (m).
    pub(crate) fn stretch_length(&self, half: u8, stretch: &Stretch) -> f64 {
        let parts = stretch.iter().map(|&(name, from, to)| {
            let (low, high) = (from.min(to), from.max(to));
            let edges = self.lines.iter().flat_map(|line| &line.edges);
            let own = edges.filter(|edge| edge.name == name && edge.half == half);
            own.map(|edge| {
                let (a, b) = (edge.from.min(edge.to), edge.from.max(edge.to));
                let covered = (b.min(high) - a.max(low)).max(0.0);
                edge.curve.length() * covered / (b - a).max(1e-300)
            })
            .sum::<f64>()
        });
        parts.sum()
    }
}

/// Whether seams of the document sew an edge. Legs are sewn by their dart, underlays lie folded under, and
/// halves beyond a fold have spans of their own.
pub(crate) fn is_sewn(edge: &StageEdge) -> bool {
    edge.half == 0 && !matches!(edge.name.role(), Some(Role::Leg | Role::Underlay))
}

/// The stretch, walked the other way.
pub(crate) fn reversed(stretch: Stretch) -> Stretch {
    let back = stretch.into_iter().rev();
    back.map(|(edge, from, to)| (edge, to, from)).collect()
}

impl StageLine {
    pub(super) fn length(&self) -> f64 {
        self.edges.iter().map(|edge| edge.curve.length()).sum()
    }

    fn is_closed(&self) -> bool {
        self.kind != crate::LineKind::Internal
    }

    /// Arc length from the start of the line to a corner (m).
    fn corner(&self, corner: CornerName) -> Result<f64, PlaceError> {
        let called = self.called(corner);
        let mut along = 0.0;
        for edge in &self.edges {
            if edge.start == Some(called) {
                return Ok(along);
            }
            along += edge.curve.length();
        }
        let ends_there = !self.is_closed() && self.end == Some(called);
        match ends_there {
            true => Ok(along),
            false => Err(PlaceError::NoCorner(corner)),
        }
    }

    /// The name that a corner has in the edges of the line: its own name or, if that is a second name, the
    /// first.
    pub(super) fn called(&self, corner: CornerName) -> CornerName {
        let mut called = corner;
        // A chain of twins is at most as long as the list of twins.
        for _ in 0..self.twins.len() {
            match self.twins.iter().find(|[known, _]| *known == called) {
                Some([_, other]) => called = *other,
                None => break,
            }
        }
        called
    }

    /// Arc length from the start of the line to a position (m).
    pub(super) fn placed(&self, place: Placed) -> Result<f64, PlaceError> {
        match place {
            Placed::Mark(mark) => self.along(mark),
            Placed::Spot(spot) => self.along_spot(spot),
        }
    }

    /// Arc length from the start of the line to a spot of an earlier stage (m). If the spot now lies within
    /// the mouth of a dart, the arc length to the nearer end of the mouth.
    fn along_spot(&self, spot: Spot) -> Result<f64, PlaceError> {
        let mut before = 0.0;
        let mut best: Option<(f64, f64)> = None;
        for edge in &self.edges {
            let own = edge.curve.length();
            if edge.name == spot.edge && edge.half == 0 {
                let share = spot
                    .share
                    .clamp(edge.from.min(edge.to), edge.from.max(edge.to));
                let away = (share - spot.share).abs();
                let local = (share - edge.from) / (edge.to - edge.from);
                if best.is_none_or(|best| away < best.0) {
                    best = Some((away, before + own * local.clamp(0.0, 1.0)));
                }
            }
            before += own;
        }
        best.map(|(_, along)| along).ok_or(PlaceError::Beyond)
    }

    /// Arc length from the start of the line to a mark (m).
    fn along(&self, mark: MarkValue) -> Result<f64, PlaceError> {
        let length = self.length();
        match mark {
            MarkValue::Corner(corner) => self.corner(corner),
            MarkValue::Along(corner, distance) => {
                let along = self.corner(corner)? + distance;
                match self.is_closed() {
                    true if distance.abs() <= length => Ok(along.rem_euclid(length)),
                    false if (-SLACK..=length + SLACK).contains(&along) => {
                        Ok(along.clamp(0.0, length))
                    }
                    _ => Err(PlaceError::Beyond),
                }
            }
            MarkValue::Between([from, to], share) => {
                if !(-SLACK..=1.0 + SLACK).contains(&share) {
                    return Err(PlaceError::Beyond);
                }
                let (start, end) = (self.corner(from)?, self.corner(to)?);
                let way = match end > start {
                    true => end - start,
                    false if self.is_closed() => end + length - start,
                    false => return Err(PlaceError::NoCorner(to)),
                };
                Ok(start + way * share.clamp(0.0, 1.0))
            }
        }
    }

    /// The spot at an arc length (m). A mark that is a share of one edge stays on that edge, so that a share
    /// of 1 is the end of the edge and not the start of the next one.
    fn at(&self, along: f64, mark: MarkValue) -> Spot {
        let length = self.length();
        let wrapped = match self.is_closed() && along > length {
            true => along - length,
            false => along,
        };
        let wanted = match mark {
            MarkValue::Between([from, _], _) => self.named_from(from),
            MarkValue::Corner(_) | MarkValue::Along(..) => None,
        };
        let mut before = 0.0;
        let mut best: Option<Spot> = None;
        for edge in &self.edges {
            let own = edge.curve.length();
            let inside = wrapped >= before - SLACK && wrapped <= before + own + SLACK;
            if inside && own > 0.0 {
                let local = ((wrapped - before) / own).clamp(0.0, 1.0);
                let spot = Spot {
                    edge: edge.name,
                    share: edge.from + (edge.to - edge.from) * local,
                    along: wrapped,
                };
                if best.is_none() || wanted == Some(edge.name) || wanted.is_none() {
                    best = Some(spot);
                }
            }
            before += own;
        }
        best.unwrap_or(Spot {
            edge: self.edges[0].name,
            share: self.edges[0].from,
            along: wrapped,
        })
    }

    /// Name of the edge that starts at a corner.
    fn named_from(&self, corner: CornerName) -> Option<EdgeName> {
        let called = self.called(corner);
        let found = self.edges.iter().find(|edge| edge.start == Some(called));
        found.map(|edge| edge.name)
    }

    /// The stretch from one arc length forwards to another (m). On a closed line it goes on round the line if
    /// `end` is not beyond `start`.
    fn between(&self, start: f64, end: f64, wanted: impl Fn(&StageEdge) -> bool) -> Stretch {
        let length = self.length();
        let end = match self.is_closed() && end <= start + SLACK {
            true => end + length,
            false => end,
        };
        let rounds = if self.is_closed() { 2 } else { 1 };
        let mut stretch: Stretch = Vec::new();
        let mut before = 0.0;
        for edge in (0..rounds).flat_map(|_| &self.edges) {
            let own = edge.curve.length();
            let (low, high) = (start.max(before), end.min(before + own));
            if high - low > SLACK && wanted(edge) {
                let share = |along: f64| match along {
                    along if along <= before => edge.from,
                    along if along >= before + own => edge.to,
                    along => share_of(edge, (along - before) / own),
                };
                let (a, b) = (share(low), share(high));
                match stretch.last_mut() {
                    Some(last) if last.0 == edge.name && (last.2 - a).abs() < SLACK => last.2 = b,
                    _ => stretch.push((edge.name, a, b)),
                }
            }
            before += own;
        }
        stretch
    }
}

fn share_of(edge: &StageEdge, local: f64) -> f64 {
    edge.from + (edge.to - edge.from) * local.clamp(0.0, 1.0)
}
