//! Addresses of numbers in the document, by which inspectors show and set them.

use super::remap::Remap;
use super::seam::SeamSide;
use crate::{
    Apex, CurveId, CurveRule, EdgeId, Entity, Mark, NotchId, Number, OperationId, OperationKind,
    PanelId, PartId, Pattern, PointId, PointRule, SeamId, VariableId, Want, WornRule,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Where a number of the document stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NumberAddress {
    /// What a variable stands for.
    Variable(VariableId),
    /// A number of a point's rule.
    Point(PointId, PointNumber),
    /// The bulge of an arc.
    Bulge(CurveId),
    /// The length a spline is drawn to, if it is drawn to one.
    ToLength(CurveId),
    /// Direction of a panel's warp.
    Grain(PanelId),
    /// Seam allowance of a panel.
    Allowance(PanelId),
    /// Height at which a panel is worn, if it is known.
    Level(PanelId),
    /// Seam allowance of an edge, if it has its own.
    EdgeAllowance(PanelId, EdgeId),
    /// Where a notch is.
    Notch(PanelId, NotchId, MarkNumber),
    /// A number of an operation.
    Operation(PanelId, OperationId, OperationNumber),
    /// Ease of a seam.
    Ease(SeamId),
    /// Where a span of a seam starts or ends: side, place in it, end.
    Span(SeamId, SeamSide, usize, SpanEnd, MarkNumber),
}

/// A number of a point's rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PointNumber {
    /// To the right.
    X,
    /// Upward.
    Y,
    /// Direction.
    Angle,
    /// How far.
    Distance,
    /// Share of the way.
    Along,
    /// Share to the left of the way.
    Aside,
    /// Share of a curve.
    Share,
}

/// The number of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MarkNumber {
    /// Distance from a corner along the line.
    Distance,
    /// Share of the way between two corners.
    Share,
}

/// A number of an operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OperationNumber {
    /// Where a dart's mouth is.
    Mouth(MarkNumber),
    /// How wide a dart is.
    Intake,
    /// How deep a dart is.
    Depth,
    /// Where a diamond is widest.
    Widest,
    /// Where a fold starts.
    FoldStart(MarkNumber),
    /// Where a fold ends.
    FoldEnd(MarkNumber),
    /// Share of a dart that a pivot moves.
    Share,
    /// How far a pivot sets the points of its darts back.
    Back,
    /// Where a spread panel stays as it is.
    Held(MarkNumber),
    /// Where the cut at that place in a spread starts or ends.
    Cut(usize, SpanEnd, MarkNumber),
    /// How far the cut at that place in a spread opens at its start or its end.
    Opening(usize, SpanEnd),
}

/// An end of a span.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SpanEnd {
    /// Where it starts.
    From,
    /// Where it ends.
    To,
}

impl SpanEnd {
    /// 0 for the start, 1 for the end.
    fn index(self) -> usize {
        match self {
            Self::From => 0,
            Self::To => 1,
        }
    }
}

/// A number that is there, or may be.
pub(super) enum Slot<'e> {
    Always(&'e mut Number),
    Optional(&'e mut Option<Number>),
}

impl NumberAddress {
    /// What it is called beside its field.
    pub fn label(&self) -> &'static str {
        match self {
            Self::Variable(_) => "value",
            Self::Point(_, number) => match number {
                PointNumber::X => "x",
                PointNumber::Y => "y",
                PointNumber::Angle => "angle",
                PointNumber::Distance => "distance",
                PointNumber::Along => "along",
                PointNumber::Aside => "aside",
                PointNumber::Share => "part of the way",
            },
            Self::Bulge(_) => "bulge",
            Self::ToLength(_) => "length",
            Self::Grain(_) => "grain",
            Self::Allowance(_) | Self::EdgeAllowance(..) => "seam allowance",
            Self::Level(_) => "height on the body",
            Self::Notch(_, _, mark) => mark.label(),
            Self::Operation(_, _, number) => match number {
                OperationNumber::Mouth(mark) => mark.label(),
                OperationNumber::Intake => "intake",
                OperationNumber::Depth => "depth",
                OperationNumber::Widest => "widest at",
                OperationNumber::FoldStart(_) => "start",
                OperationNumber::FoldEnd(_) => "end",
                OperationNumber::Share => "part moved",
                OperationNumber::Back => "set back",
                OperationNumber::Held(_) => "held at",
                OperationNumber::Cut(_, SpanEnd::From, _) => "cut from",
                OperationNumber::Cut(_, SpanEnd::To, _) => "cut to",
                OperationNumber::Opening(_, SpanEnd::From) => "opening at start",
                OperationNumber::Opening(_, SpanEnd::To) => "opening at end",
            },
            Self::Ease(_) => "ease",
            Self::Span(_, _, _, SpanEnd::From, _) => "start",
            Self::Span(_, _, _, SpanEnd::To, _) => "end",
        }
    }

    /// What the number must be. A variable may be anything.
    pub fn want(&self) -> Want {
        match self {
            Self::Variable(_) => Want::Any,
            Self::Bulge(_) => Want::Plain,
            Self::Point(_, number) => match number {
                PointNumber::X | PointNumber::Y | PointNumber::Distance => Want::Length,
                PointNumber::Angle => Want::Angle,
                PointNumber::Along | PointNumber::Aside | PointNumber::Share => Want::Plain,
            },
            Self::Grain(_) => Want::Angle,
            Self::ToLength(_)
            | Self::Allowance(_)
            | Self::EdgeAllowance(..)
            | Self::Level(_)
            | Self::Ease(_) => Want::Length,
            Self::Notch(_, _, mark) | Self::Span(_, _, _, _, mark) => mark.want(),
            Self::Operation(_, _, number) => match number {
                OperationNumber::Intake
                | OperationNumber::Depth
                | OperationNumber::Back
                | OperationNumber::Opening(..) => Want::Length,
                OperationNumber::Widest | OperationNumber::Share => Want::Plain,
                OperationNumber::Mouth(mark)
                | OperationNumber::FoldStart(mark)
                | OperationNumber::FoldEnd(mark)
                | OperationNumber::Held(mark)
                | OperationNumber::Cut(_, _, mark) => mark.want(),
            },
        }
    }

    /// The part it is a number of.
    pub fn part(&self) -> PartId {
        match *self {
            Self::Variable(id) => id.into(),
            Self::Point(id, _) => id.into(),
            Self::Bulge(id) | Self::ToLength(id) => id.into(),
            Self::Grain(id) | Self::Allowance(id) | Self::Level(id) => id.into(),
            Self::EdgeAllowance(_, id) => id.into(),
            Self::Notch(_, id, _) => id.into(),
            Self::Operation(_, id, _) => id.into(),
            Self::Ease(id) | Self::Span(id, ..) => id.into(),
        }
    }

    /// The same place of the part that stands for its part.
    pub(super) fn remapped(self, map: &Remap) -> Self {
        match self {
            Self::Variable(id) => Self::Variable(map.id(id)),
            Self::Point(id, number) => Self::Point(map.id(id), number),
            Self::Bulge(id) => Self::Bulge(map.id(id)),
            Self::ToLength(id) => Self::ToLength(map.id(id)),
            Self::Grain(id) => Self::Grain(map.id(id)),
            Self::Allowance(id) => Self::Allowance(map.id(id)),
            Self::Level(id) => Self::Level(map.id(id)),
            Self::EdgeAllowance(panel, id) => Self::EdgeAllowance(map.id(panel), map.id(id)),
            Self::Notch(panel, id, number) => Self::Notch(map.id(panel), map.id(id), number),
            Self::Operation(panel, id, number) => {
                Self::Operation(map.id(panel), map.id(id), number)
            }
            Self::Ease(id) => Self::Ease(map.id(id)),
            Self::Span(id, side, k, end, number) => Self::Span(map.id(id), side, k, end, number),
        }
    }

    /// The entity it stands in; nothing if that is not there.
    pub(super) fn entity(&self, pattern: &Pattern) -> Option<Entity> {
        Some(match *self {
            Self::Variable(id) => {
                let mut variables = pattern.variables.iter();
                Entity::Variable(variables.find(|variable| variable.id == id)?.clone())
            }
            Self::Point(id, _) => {
                let (sheet, point) = pattern.point(id)?;
                Entity::Point(sheet.id, point.clone())
            }
            Self::Bulge(id) | Self::ToLength(id) => {
                let (sheet, curve) = pattern.curve(id)?;
                Entity::Curve(sheet.id, curve.clone())
            }
            Self::Grain(id)
            | Self::Allowance(id)
            | Self::Level(id)
            | Self::EdgeAllowance(id, _)
            | Self::Notch(id, ..)
            | Self::Operation(id, ..) => Entity::Panel(pattern.panel(id)?.clone()),
            Self::Ease(id) | Self::Span(id, ..) => Entity::Seam(pattern.seam(id)?.clone()),
        })
    }

    /// The number in its entity; nothing if the entity has no such number.
    pub(super) fn slot<'e>(&self, entity: &'e mut Entity) -> Option<Slot<'e>> {
        match entity {
            Entity::Variable(variable) => Some(Slot::Always(&mut Arc::make_mut(variable).number)),
            Entity::Point(_, point) => {
                let Self::Point(_, number) = self else {
                    return None;
                };
                in_rule(&mut Arc::make_mut(point).rule, *number).map(Slot::Always)
            }
            Entity::Curve(_, curve) => match (self, &mut Arc::make_mut(curve).rule) {
                (Self::Bulge(_), CurveRule::Arc { bulge }) => Some(Slot::Always(bulge)),
                (Self::ToLength(_), CurveRule::Spline { to_length, .. }) => {
                    Some(Slot::Optional(to_length))
                }
                _ => None,
            },
            Entity::Panel(panel) => self.in_panel(Arc::make_mut(panel)),
            Entity::Seam(seam) => {
                let seam = Arc::make_mut(seam);
                match *self {
                    Self::Ease(_) => Some(Slot::Always(&mut seam.ease)),
                    Self::Span(_, side, k, end, number) => {
                        let span = seam.sides[side.index()].get_mut(k)?;
                        let mark = match end {
                            SpanEnd::From => &mut span.from,
                            SpanEnd::To => &mut span.to,
                        };
                        number.of(mark).map(Slot::Always)
                    }
                    _ => None,
                }
            }
            _ => None,
        }
    }

    fn in_panel<'p>(&self, panel: &'p mut crate::Panel) -> Option<Slot<'p>> {
        match *self {
            Self::Grain(_) => Some(Slot::Always(&mut panel.grain)),
            Self::Allowance(_) => Some(Slot::Always(&mut panel.allowance)),
            Self::Level(_) => match &mut panel.worn {
                WornRule::Wrapped { level, .. } => Some(Slot::Optional(level)),
                _ => None,
            },
            Self::EdgeAllowance(_, id) => {
                let mut edges = panel.lines.iter_mut().flat_map(|line| &mut line.edges);
                let edge = edges.find(|edge| edge.id == id)?;
                Some(Slot::Optional(&mut edge.allowance))
            }
            Self::Notch(_, id, number) => {
                let notch = panel.notches.iter_mut().find(|notch| notch.id == id)?;
                number.of(&mut notch.at).map(Slot::Always)
            }
            Self::Operation(_, id, number) => {
                let mut operations = panel.operations.iter_mut();
                let operation = operations.find(|known| known.id == id)?;
                in_operation(&mut Arc::make_mut(operation).kind, number).map(Slot::Always)
            }
            _ => None,
        }
    }
}

impl MarkNumber {
    fn label(self) -> &'static str {
        match self {
            Self::Distance => "distance",
            Self::Share => "part of the edge",
        }
    }

    fn want(self) -> Want {
        match self {
            Self::Distance => Want::Length,
            Self::Share => Want::Plain,
        }
    }

    fn of(self, mark: &mut Mark) -> Option<&mut Number> {
        match (self, mark) {
            (Self::Distance, Mark::Along { distance, .. }) => Some(distance),
            (Self::Share, Mark::Between { share, .. }) => Some(share),
            _ => None,
        }
    }
}

fn in_rule(rule: &mut PointRule, number: PointNumber) -> Option<&mut Number> {
    match (number, rule) {
        (PointNumber::X, PointRule::At { x, .. } | PointRule::Offset { x, .. }) => Some(x),
        (PointNumber::Y, PointRule::At { y, .. } | PointRule::Offset { y, .. }) => Some(y),
        (PointNumber::Angle, PointRule::Polar { angle, .. }) => Some(angle),
        (
            PointNumber::Distance,
            PointRule::Polar { distance, .. }
            | PointRule::Toward { distance, .. }
            | PointRule::AlongCurve { distance, .. },
        ) => Some(distance),
        (PointNumber::Along, PointRule::Between { along, .. }) => Some(along),
        (PointNumber::Aside, PointRule::Between { aside, .. }) => Some(aside),
        (PointNumber::Share, PointRule::OnCurve { share, .. })
        | (
            PointNumber::Share,
            PointRule::Mark {
                at: Mark::Between { share, .. },
                ..
            },
        ) => Some(share),
        (
            PointNumber::Distance,
            PointRule::Mark {
                at: Mark::Along { distance, .. },
                ..
            },
        ) => Some(distance),
        _ => None,
    }
}

fn in_operation(kind: &mut OperationKind, number: OperationNumber) -> Option<&mut Number> {
    match (number, kind) {
        (
            OperationNumber::Mouth(number),
            OperationKind::Dart { mouth, .. } | OperationKind::Pivot { mouth, .. },
        ) => number.of(mouth),
        (OperationNumber::Share, OperationKind::Pivot { share, .. }) => Some(share),
        (OperationNumber::Back, OperationKind::Pivot { back, .. }) => Some(back),
        (
            OperationNumber::Held(number),
            OperationKind::Spread { held, .. } | OperationKind::Pleat { held, .. },
        ) => number.of(held),
        (OperationNumber::Cut(k, end, number), OperationKind::Spread { cuts, .. }) => {
            number.of(&mut cuts.get_mut(k)?.ends[end.index()])
        }
        (OperationNumber::Cut(k, end, number), OperationKind::Pleat { pleats, .. }) => {
            number.of(&mut pleats.get_mut(k)?.ends[end.index()])
        }
        (OperationNumber::Depth, OperationKind::Pleat { depth, .. }) => Some(depth),
        (OperationNumber::Opening(k, end), OperationKind::Spread { cuts, .. }) => {
            Some(&mut cuts.get_mut(k)?.openings[end.index()])
        }
        (
            OperationNumber::Intake,
            OperationKind::Dart { intake, .. } | OperationKind::Diamond { intake, .. },
        ) => Some(intake),
        (
            OperationNumber::Depth,
            OperationKind::Dart {
                apex: Apex::Depth(depth),
                ..
            },
        ) => Some(depth),
        (OperationNumber::Widest, OperationKind::Diamond { widest, .. }) => Some(widest),
        (OperationNumber::FoldStart(number), OperationKind::Fold { ends, .. }) => {
            number.of(&mut ends[0])
        }
        (OperationNumber::FoldEnd(number), OperationKind::Fold { ends, .. }) => {
            number.of(&mut ends[1])
        }
        _ => None,
    }
}
