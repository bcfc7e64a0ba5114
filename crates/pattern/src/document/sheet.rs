//! Sheets: drafting planes with points and curves.

use crate::{CurveId, LineName, Mark, Number, OperationId, PanelId, PointId, SheetId};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A drafting plane.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Sheet {
    /// Its id.
    pub id: SheetId,
    /// Name to show and for formulas.
    pub name: String,
    /// The panel stage it lies on: after that operation, or as drawn. Nothing is a free sheet.
    pub on: Option<(PanelId, Option<OperationId>)>,
    /// Where its origin lies on the table [m].
    pub on_table: [f64; 2],
    /// Its points: corners, handles, construction points.
    pub points: Vec<Arc<Point>>,
    /// Its curves.
    pub curves: Vec<Arc<Curve>>,
}

impl Sheet {
    /// The point with that id.
    pub fn point(&self, id: PointId) -> Option<&Arc<Point>> {
        self.points.iter().find(|point| point.id == id)
    }

    /// The point with that name.
    pub fn point_named(&self, name: &str) -> Option<&Arc<Point>> {
        self.points.iter().find(|point| point.name == name)
    }

    /// The curve with that id.
    pub fn curve(&self, id: CurveId) -> Option<&Arc<Curve>> {
        self.curves.iter().find(|curve| curve.id == id)
    }

    /// The curve with that name.
    pub fn curve_named(&self, name: &str) -> Option<&Arc<Curve>> {
        self.curves.iter().find(|curve| curve.name == name)
    }
}

/// A point of a sheet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Its id.
    pub id: PointId,
    /// Name for formulas, unique in the sheet.
    pub name: String,
    /// Where it is.
    pub rule: PointRule,
}

/// Where a point is: its coordinates, or how it is constructed from other parts of its sheet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum PointRule {
    /// At coordinates of the sheet.
    At {
        /// To the right [m].
        x: Number,
        /// Upward [m].
        y: Number,
    },
    /// Beside another point.
    Offset {
        /// The other point.
        base: PointId,
        /// To the right of it [m].
        x: Number,
        /// Above it [m].
        y: Number,
    },
    /// At a distance from another point.
    Polar {
        /// The other point.
        base: PointId,
        /// Direction [rad], from +x counter-clockwise.
        angle: Number,
        /// How far [m].
        distance: Number,
    },
    /// In the frame of two points: `base + along (tip - base) + aside (tip - base turned left)`.
    Between {
        /// Origin of the frame.
        base: PointId,
        /// End of its unit axis.
        tip: PointId,
        /// Plain share of the way.
        along: Number,
        /// Plain share of the same length to the left of the way.
        aside: Number,
    },
    /// On the line through two points, at a distance from the first.
    Toward {
        /// Where to start.
        base: PointId,
        /// Where to go.
        tip: PointId,
        /// How far [m].
        distance: Number,
    },
    /// On a curve, at a share of its arc length.
    OnCurve {
        /// The curve.
        curve: CurveId,
        /// Plain share of its arc length.
        share: Number,
    },
    /// On a curve, at a distance from its start, or from its end if negative.
    AlongCurve {
        /// The curve.
        curve: CurveId,
        /// How far [m].
        distance: Number,
    },
    /// Where the lines through two pairs of points meet.
    Crossing {
        /// The first line.
        first: [PointId; 2],
        /// The second line.
        second: [PointId; 2],
    },
    /// Where two curves cross.
    CurveCrossing {
        /// The curves.
        curves: [CurveId; 2],
        /// Which of several crossings, from 0 along the first curve.
        index: u16,
    },
    /// Where the line through two points crosses a curve.
    LineCrossing {
        /// The line.
        line: [PointId; 2],
        /// The curve.
        curve: CurveId,
        /// Which of several crossings, from 0 along the curve.
        index: u16,
    },
    /// The foot of the perpendicular from a point on the line through two others.
    Foot {
        /// The point.
        base: PointId,
        /// The line.
        line: [PointId; 2],
    },
    /// The mirror image of a point in the line through two others.
    Mirrored {
        /// The point.
        base: PointId,
        /// The mirror.
        line: [PointId; 2],
    },
    /// A place on a line of the panel that the sheet lies on, at that stage.
    Mark {
        /// The line.
        line: LineName,
        /// Where on it.
        at: Mark,
    },
}

impl PointRule {
    /// A point at fixed coordinates [m].
    pub fn at(x: f64, y: f64) -> Self {
        Self::At {
            x: x.into(),
            y: y.into(),
        }
    }

    /// Points it is constructed from.
    pub fn points(&self) -> Vec<PointId> {
        match *self {
            Self::At { .. }
            | Self::OnCurve { .. }
            | Self::AlongCurve { .. }
            | Self::CurveCrossing { .. }
            | Self::Mark { .. } => vec![],
            Self::Offset { base, .. } | Self::Polar { base, .. } => vec![base],
            Self::Between { base, tip, .. } | Self::Toward { base, tip, .. } => vec![base, tip],
            Self::Crossing { first, second } => [first, second].concat(),
            Self::LineCrossing { line, .. } => line.to_vec(),
            Self::Foot { base, line } | Self::Mirrored { base, line } => {
                vec![base, line[0], line[1]]
            }
        }
    }

    /// Curves it is constructed from.
    pub fn curves(&self) -> Vec<CurveId> {
        match *self {
            Self::OnCurve { curve, .. }
            | Self::AlongCurve { curve, .. }
            | Self::LineCrossing { curve, .. } => vec![curve],
            Self::CurveCrossing { curves, .. } => curves.to_vec(),
            _ => vec![],
        }
    }

    /// Its numbers.
    pub fn numbers(&self) -> Vec<&Number> {
        match self {
            Self::At { x, y } | Self::Offset { x, y, .. } => vec![x, y],
            Self::Polar {
                angle, distance, ..
            } => vec![angle, distance],
            Self::Between { along, aside, .. } => vec![along, aside],
            Self::Toward { distance, .. } | Self::AlongCurve { distance, .. } => vec![distance],
            Self::OnCurve { share, .. } => vec![share],
            Self::Mark { at, .. } => at.number().into_iter().collect(),
            _ => vec![],
        }
    }
}

/// A curve of a sheet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Its id.
    pub id: CurveId,
    /// Name for formulas, unique among the curves of its sheet.
    pub name: String,
    /// Where it starts and ends.
    pub ends: [PointId; 2],
    /// How it runs between them.
    pub rule: CurveRule,
}

/// How a curve runs between its ends.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub enum CurveRule {
    /// Straight.
    #[default]
    Line,
    /// A circular arc.
    Arc {
        /// Tangent of a quarter of the swept angle; positive turns counter-clockwise, 1 is a
        /// half circle.
        bulge: Number,
    },
    /// Cubic Bezier curves through knots.
    Spline {
        /// Handles at the start and at the end.
        handles: [PointId; 2],
        /// Points between the ends, in order.
        knots: Vec<Knot>,
        /// The length it is drawn to by scaling all handles from their points [m]; nothing leaves
        /// them as they are.
        to_length: Option<Number>,
    },
    /// The mirror image of another curve in the line through two points.
    Mirrored {
        /// The other curve.
        of: CurveId,
        /// The mirror.
        line: [PointId; 2],
    },
    /// Another curve turned and scaled to lie between the ends.
    Copy {
        /// The other curve.
        of: CurveId,
    },
}

/// A point a spline goes through, with its handles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Knot {
    /// Handle before the point.
    pub before: PointId,
    /// The point.
    pub point: PointId,
    /// Handle after the point.
    pub after: PointId,
}

impl CurveRule {
    /// Points it is shaped by, its ends apart.
    pub fn points(&self) -> Vec<PointId> {
        match self {
            Self::Line | Self::Arc { .. } | Self::Copy { .. } => Vec::new(),
            Self::Spline { handles, knots, .. } => {
                let inner = knots.iter().flat_map(|k| [k.before, k.point, k.after]);
                std::iter::once(handles[0])
                    .chain(inner)
                    .chain([handles[1]])
                    .collect()
            }
            Self::Mirrored { line, .. } => line.to_vec(),
        }
    }

    /// The curve it is made from.
    pub fn curve(&self) -> Option<CurveId> {
        match self {
            Self::Mirrored { of, .. } | Self::Copy { of } => Some(*of),
            _ => None,
        }
    }

    /// Its number, if it has one.
    pub fn number(&self) -> Option<&Number> {
        match self {
            Self::Arc { bulge } => Some(bulge),
            Self::Spline { to_length, .. } => to_length.as_ref(),
            _ => None,
        }
    }
}
