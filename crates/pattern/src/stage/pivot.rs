//! Pivoted darts: a part of a dart's intake is moved to another place of the outline.

use super::dart::{legs, mouth, shut_mouth};
use super::motion::Motion;
use super::partition::{CutError, SAME, check_cut, outline_of, partition, ring};
use super::{Placed, Stage, StageDart, StageEdge, StageLine, with_ends};
use crate::{LineName, Name, OperationId, Pressed, Role, Turned};
use toile_geometry::{Curve, Path, Vec2};

/// A pivot operation with its numbers evaluated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pivoting {
    pub by: OperationId,
    /// The operation that made the dart to be pivoted.
    pub dart: OperationId,
    pub line: LineName,
    /// Position of the new mouth.
    pub mouth: Placed,
    /// Share of the dart's angle that is moved to the new dart (1).
    pub share: f64,
    /// Distance from the pivot point at which both darts end after the pivot (m).
    pub back: f64,
    pub turned: Turned,
    pub pressed: Pressed,
}

/// Reason why a dart cannot be pivoted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PivotError {
    Cut(CutError),
    /// The dart has no mouth in the outline.
    NoMouth,
    /// The share is not between 0 and 1.
    Share,
    /// The new mouth lies on a leg of a dart, or at the mouth of the dart that is pivoted.
    OnDart,
    /// The legs of the dart differ in length, so that it does not close.
    LegsDiffer,
    /// Both darts would end in the same point, where the panel would come apart.
    OnePoint,
    /// The distance from the pivot point at which the darts are to end is negative, or as long as a leg or
    /// longer.
    TooFarBack,
}

/// Shares of an angle that differ from 0 or 1 by no more than this count as 0 or 1 (1).
const ROUNDING: f64 = 1e-12;

fn leg(by: OperationId, index: u16) -> crate::EdgeName {
    Name::Made {
        by,
        role: Role::Leg,
        index,
    }
}

/// The stage with a dart pivoted.
pub(crate) fn pivot_dart(stage: &Stage, wish: &Pivoting) -> Result<Stage, PivotError> {
    let outline = outline_of(stage, wish.line).map_err(PivotError::Cut)?;
    if !(-ROUNDING..=1.0 + ROUNDING).contains(&wish.share) {
        return Err(PivotError::Share);
    }
    let mut line = stage.lines[outline].clone();
    let along = line
        .placed(wish.mouth)
        .map_err(|e| PivotError::Cut(CutError::Place(e)))?;
    let at = line.divide(along);
    if is_leg(&line.edges[at]) && line.edges[at].start.is_none() {
        return Err(PivotError::OnDart);
    }
    let is_idle = stage.idle.contains(&wish.dart);
    if is_idle || wish.share <= ROUNDING {
        shut_mouth(&mut line, wish.by, along);
        let mut result = stage.clone();
        result.lines[outline] = line;
        result.idle.extend(is_idle.then_some(wish.by));
        return Ok(result);
    }
    let own = |dart: &&StageDart| dart.by == wish.dart && dart.half == 0;
    let dart = stage.darts.iter().find(own).ok_or(PivotError::NoMouth)?;
    let first = line
        .edges
        .iter()
        .position(|edge| edge.name == leg(wish.dart, 0));
    let first = first.ok_or(PivotError::NoMouth)?;
    let count = line.edges.len();
    let begins = (line.edges[0].name, line.edges[0].from);
    line.edges.rotate_left(first);
    if count < 4 || line.edges[1].name != leg(wish.dart, 1) {
        return Err(PivotError::NoMouth);
    }
    // The edges are: the two legs, the part from the dart to the new mouth, then the other part from `at` on.
    let at = (at + count - first) % count;
    if at < 3 {
        return Err(PivotError::OnDart);
    }
    let cut = cut_to(&line.edges[at], dart.pivot);
    check_cut(stage, outline, &cut).map_err(PivotError::Cut)?;
    let turning = Turning::of(dart, line.edges[at].curve.start(), wish)?;
    let numbered = |edges: &[StageEdge], part: usize| -> Vec<(StageEdge, usize)> {
        edges.iter().map(|edge| (edge.clone(), part)).collect()
    };
    let mut parted = numbered(&line.edges[2..at], 0);
    parted.extend(numbered(&line.edges[at..], 1));
    let with_pivot = |edges: &[StageEdge]| {
        let mut ring = ring(edges);
        ring.push(dart.pivot);
        ring
    };
    let rings = [
        with_pivot(&line.edges[2..at]),
        with_pivot(&line.edges[at..]),
    ];
    let everything = partition(stage, outline, &parted, (&[cut], &rings));
    let mut line = turning.outline(line, at, wish);
    let begins = |edge: &StageEdge| (edge.name, edge.from) == begins;
    let start = line.edges.iter().position(begins).unwrap_or(0);
    line.edges.rotate_left(start);
    let mut result = everything.moved(stage, outline, line, &turning.motions);
    result
        .darts
        .retain(|known| known.by != wish.dart || known.half != 0);
    result.darts.extend(turning.darts(dart, wish));
    Ok(result)
}

fn is_leg(edge: &StageEdge) -> bool {
    edge.name.role() == Some(Role::Leg)
}

fn cut_to(edge: &StageEdge, pivot: Vec2) -> Path {
    Path::new(vec![Curve::Line {
        start: edge.curve.start(),
        end: pivot,
    }])
}

/// Motions of both parts of the panel, and the new positions of both darts (m).
struct Turning {
    /// Motion of the part from the dart to the new mouth, and motion of the other part.
    motions: [Motion; 2],
    /// Ends of the mouth of the old dart (m).
    old: [Vec2; 2],
    old_apex: Vec2,
    /// Ends of the mouth of the new dart (m).
    new: [Vec2; 2],
    new_apex: Vec2,
    /// Whether the whole of the old dart is moved, so that its mouth closes.
    closes: bool,
}

impl Turning {
    fn of(dart: &StageDart, at: Vec2, wish: &Pivoting) -> Result<Self, PivotError> {
        let pivot = dart.pivot;
        let [open, close] = dart.mouth.map(|end| end - pivot);
        let closes = wish.share >= 1.0 - ROUNDING;
        if closes && (open.norm() - close.norm()).abs() > SAME {
            return Err(PivotError::LegsDiffer);
        }
        let shortest = open.norm().min(close.norm()).min((at - pivot).norm());
        if !(0.0..shortest).contains(&wish.back) {
            return Err(PivotError::TooFarBack);
        }
        if !closes && wish.back <= SAME {
            return Err(PivotError::OnePoint);
        }
        let angle = open.perp(&close).atan2(open.dot(&close)) * wish.share.clamp(0.0, 1.0);
        let motions = match wish.turned {
            Turned::FromDart => [Motion::about(pivot, -angle), Motion::NONE],
            Turned::ToDart => [Motion::NONE, Motion::about(pivot, angle)],
        };
        let old = [
            motions[1].point(dart.mouth[0]),
            motions[0].point(dart.mouth[1]),
        ];
        let new = [motions[0].point(at), motions[1].point(at)];
        let apex = |mouth: [Vec2; 2]| {
            let middle = mouth.map(|end| (end - pivot).normalize());
            let inward = (middle[0] + middle[1]).try_normalize(1e-12);
            pivot + inward.unwrap_or_else(Vec2::zeros) * wish.back
        };
        Ok(Self {
            motions,
            old,
            old_apex: apex(old),
            new,
            new_apex: apex(new),
            closes,
        })
    }

    /// The outline after the pivot. The first two edges of `line` are the legs of the old dart, and its edge
    /// `at` starts at the new mouth.
    fn outline(&self, mut line: StageLine, at: usize, wish: &Pivoting) -> StageLine {
        line.call(at, mouth(wish.by, 1));
        let old_mouth = [0, 1].map(|k| mouth(wish.dart, k));
        let moved = |edges: &[StageEdge], part: usize| -> Vec<StageEdge> {
            edges
                .iter()
                .map(|edge| self.motions[part].edge(edge))
                .collect()
        };
        let mut from_dart = moved(&line.edges[2..at], 0);
        let mut to_dart = moved(&line.edges[at..], 1);
        join(&mut from_dart, self.old[1], self.new[0]);
        join(&mut to_dart, self.new[1], self.old[0]);
        let [mut before, mut after] = [line.edges[0].clone(), line.edges[1].clone()];
        before.curve = straight(self.old[0], self.old_apex);
        after.curve = straight(self.old_apex, self.old[1]);
        let mut edges: Vec<StageEdge> = Vec::with_capacity(line.edges.len() + 2);
        if !self.closes {
            edges.extend([before, after]);
        } else if let Some(first) = from_dart.first_mut() {
            // Both ends of the closed mouth are one corner.
            first.curve = with_ends(first.curve, self.old[0], first.curve.end());
            let called = *first.start.get_or_insert(old_mouth[1]);
            let twins = old_mouth.into_iter().filter(|corner| *corner != called);
            line.twins.extend(twins.map(|corner| [corner, called]));
        }
        edges.append(&mut from_dart);
        edges.extend(legs(wish.by, self.new, self.new_apex));
        edges.append(&mut to_dart);
        StageLine { edges, ..line }
    }

    fn darts(&self, old: &StageDart, wish: &Pivoting) -> Vec<StageDart> {
        let new = StageDart {
            by: wish.by,
            mouth: self.new,
            apex: self.new_apex,
            pressed: wish.pressed,
            ..*old
        };
        let kept = StageDart {
            mouth: self.old,
            apex: self.old_apex,
            ..*old
        };
        match self.closes {
            true => vec![new],
            false => vec![kept, new],
        }
    }
}

fn straight(start: Vec2, end: Vec2) -> Curve {
    Curve::Line { start, end }
}

/// Moves the ends of joined edges to exactly the given points.
fn join(edges: &mut [StageEdge], start: Vec2, end: Vec2) {
    if let Some(first) = edges.first_mut() {
        first.curve = with_ends(first.curve, start, first.curve.end());
    }
    if let Some(last) = edges.last_mut() {
        last.curve = with_ends(last.curve, last.curve.start(), end);
    }
}
