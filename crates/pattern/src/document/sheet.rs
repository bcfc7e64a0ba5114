//! Sheets: drafting planes with points and curves.
//!
//! # Decided with
//! - [`toile_geometry::Curve`]: plane curves;
//! - [`crate::evaluate`] (`points.rs`, `curves.rs`): points and curves evaluated;
//! - [`crate::plan::add_point`], [`crate::plan::add_curve`]: points and curves put on a sheet;
//! - [`crate::plan`] (`swept.rs`): bulge of an arc as an angle;
//! - [`crate::plan::move_point`], [`crate::plan::transform_points`]: one point moved, many points moved;
//! - [`crate::plan`] (`face.rs`, `chain.rs`): curves that a panel follows.
//!
//! A tool of the window draws them (`tools/draw.rs`).

use crate::fields::{Clash, ITSELF, Told, ValueField, angle, group, key, length, plain};
use crate::{CurveId, LineName, Mark, Number, OperationId, PanelId, PointId, SheetId, fields};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use strum::EnumIter;

/// A drafting plane.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Sheet {
    /// Identifier of the sheet.
    pub id: SheetId,
    /// Name to show and for formulas.
    pub name: String,
    /// The stage of a panel that the sheet lies on: the panel after the given operation, or as drawn if the
    /// operation is `None`. `None` as a whole: the sheet lies on no panel.
    pub on: Option<(PanelId, Option<OperationId>)>,
    /// Position of the sheet's origin on the table (m).
    pub on_table: [f64; 2],
    /// Points of the sheet: corners, handles, construction points.
    pub points: Vec<Arc<Point>>,
    /// Curves of the sheet.
    pub curves: Vec<Arc<Curve>>,
}

fields!(Sheet, |self, v| {
    let Self {
        id,
        name,
        on,
        on_table: [x, y],
        points,
        curves,
    } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.optional("on", on);
    if let Some((panel, after)) = on {
        v.object(group("on"), &mut |v| {
            v.id("panel", panel);
            v.optional("after", after);
            if let Some(after) = after {
                v.id("after", after);
            }
        });
    }
    v.list(
        group("table").left_out_if(*x == 0.0 && *y == 0.0),
        &mut |v| {
            v.value(key("x").length(), x);
            v.value(key("y").length(), y);
        },
    );
    v.each(group("points"), points);
    v.each(group("curves"), curves);
});

impl Sheet {
    /// The point with this id.
    pub fn point(&self, id: PointId) -> Option<&Arc<Point>> {
        self.points.iter().find(|point| point.id == id)
    }

    /// The point with this name.
    pub fn point_named(&self, name: &str) -> Option<&Arc<Point>> {
        self.points.iter().find(|point| point.name == name)
    }

    /// The curve with this id.
    pub fn curve(&self, id: CurveId) -> Option<&Arc<Curve>> {
        self.curves.iter().find(|curve| curve.id == id)
    }

    /// The curve with this name.
    pub fn curve_named(&self, name: &str) -> Option<&Arc<Curve>> {
        self.curves.iter().find(|curve| curve.name == name)
    }
}

/// A point of a sheet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Identifier of the point.
    pub id: PointId,
    /// Name for formulas, unique in the sheet.
    pub name: String,
    /// Rule that gives the position of the point.
    pub rule: PointRule,
}

fields!(Point, |self, v| {
    let Self { id, name, rule } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.flat(rule);
});

/// Rule for the position of a point: its coordinates, or its construction from other parts of its sheet.
#[derive(Clone, Debug, PartialEq, EnumIter, Serialize, Deserialize)]
pub enum PointRule {
    /// A point at given coordinates of the sheet.
    At {
        /// Distance to the right of the origin (m).
        x: Number,
        /// Distance above the origin (m).
        y: Number,
    },
    /// A point where two curves cross.
    CurveCrossing {
        /// The curves.
        curves: [CurveId; 2],
        /// Number of the crossing, from 0 along the first curve.
        index: u16,
    },
    /// A point where a curve crosses the line through two points.
    LineCrossing {
        /// The line.
        line: [PointId; 2],
        /// The curve.
        curve: CurveId,
        /// Number of the crossing, from 0 along the curve.
        index: u16,
    },
    /// A point on a curve at a distance from its start; from its end if the distance is negative.
    AlongCurve {
        /// The curve.
        curve: CurveId,
        /// Arc length from the start or end of the curve (m).
        distance: Number,
    },
    /// A point on a curve at a share of its arc length.
    OnCurve {
        /// The curve.
        curve: CurveId,
        /// Share of the curve's arc length (1).
        share: Number,
    },
    /// The point in which the lines through two pairs of points meet.
    Crossing {
        /// The first line.
        first: [PointId; 2],
        /// The second line.
        second: [PointId; 2],
    },
    /// The foot of the perpendicular from a point to the line through two other points.
    Foot {
        /// The point that the perpendicular starts from.
        base: PointId,
        /// The line.
        line: [PointId; 2],
    },
    /// The mirror image of a point in the line through two other points.
    Mirrored {
        /// The point that is mirrored.
        base: PointId,
        /// The mirror line.
        line: [PointId; 2],
    },
    /// A point on the line through two points, at a distance from a third point.
    OnLineAt {
        /// The line.
        line: [PointId; 2],
        /// The third point, centre of the circle that meets the line.
        centre: PointId,
        /// Distance from the third point (m).
        distance: Number,
        /// Whether it is the farther of both such points, in the direction of the line.
        far: bool,
    },
    /// A point at given distances from two other points.
    TwoDistances {
        /// The other points, centres of circles that meet.
        centres: [PointId; 2],
        /// Distances from them (m).
        distances: [Number; 2],
        /// Whether it lies to the left of the way from the first of them to the second.
        left: bool,
    },
    /// A place on a line of the panel stage that the sheet lies on.
    Mark {
        /// The line of the panel.
        line: LineName,
        /// Position on the line.
        at: Mark,
    },
    /// A point at a displacement from another point.
    Offset {
        /// The other point.
        base: PointId,
        /// Distance to the right of the other point (m).
        x: Number,
        /// Distance above the other point (m).
        y: Number,
    },
    /// A point in a direction and at a distance from another point.
    Polar {
        /// The other point.
        base: PointId,
        /// Direction (rad), from +x counter-clockwise.
        angle: Number,
        /// Distance from the other point (m).
        distance: Number,
    },
    /// A point on the line through two points, at a distance from the first.
    Toward {
        /// Start of the line.
        base: PointId,
        /// Point that gives the direction of the line.
        tip: PointId,
        /// Distance from the start (m).
        distance: Number,
    },
    /// A point in the frame of two points: `base + along (tip - base) + aside (tip - base turned left)`.
    Between {
        /// Origin of the frame.
        base: PointId,
        /// Point that is one unit from the origin, along the first axis.
        tip: PointId,
        /// Share of the way from `base` to `tip` (1).
        along: Number,
        /// Displacement to the left of that way, as a share of its length (1).
        aside: Number,
    },
}

impl Default for PointRule {
    fn default() -> Self {
        Self::at(0.0, 0.0)
    }
}

fields!(
    PointRule,
    |self, v| {
        match self {
            Self::At { x, y } => v.list(group("at"), &mut |v| {
                v.number(length("x"), x);
                v.number(length("y"), y);
            }),
            Self::CurveCrossing { curves: [first, second], index } => {
                v.list(group("curves"), &mut |v| {
                    v.id("first", first);
                    v.id("second", second);
                });
                v.value(INDEX, index);
            }
            Self::LineCrossing { line: [from, to], curve, index } => {
                v.list(group("line"), &mut |v| {
                    v.id("from", from);
                    v.id("to", to);
                });
                v.id("curve", curve);
                v.value(INDEX, index);
            }
            Self::AlongCurve { curve, distance } => {
                v.id("curve", curve);
                v.number(length("distance"), distance);
            }
            Self::OnCurve { curve, share } => {
                v.id("curve", curve);
                v.number(plain("share").label("part of the way"), share);
            }
            Self::Crossing { first: [a, b], second: [c, d] } => v.list(group("crossing"), &mut |v| {
                v.list(group("first"), &mut |v| {
                    v.id("from", a);
                    v.id("to", b);
                });
                v.list(group("second"), &mut |v| {
                    v.id("from", c);
                    v.id("to", d);
                });
            }),
            Self::Foot { base, line: [from, to] } => {
                v.id("foot", base);
                v.list(group("in"), &mut |v| {
                    v.id("from", from);
                    v.id("to", to);
                });
            }
            Self::Mirrored { base, line: [from, to] } => {
                v.id("mirror", base);
                v.list(group("in"), &mut |v| {
                    v.id("from", from);
                    v.id("to", to);
                });
            }
            Self::OnLineAt { line: [from, to], centre, distance, far } => {
                v.list(group("on_line"), &mut |v| {
                    v.id("from", from);
                    v.id("to", to);
                });
                v.id("centre", centre);
                v.number(length("distance"), distance);
                v.value(key("far").left_out_if(!*far), far);
            }
            Self::TwoDistances { centres: [a, b], distances: [first, second], left } => {
                v.list(group("centres"), &mut |v| {
                    v.id("first", a);
                    v.id("second", b);
                });
                v.list(group("distances"), &mut |v| {
                    v.number(length("first"), first);
                    v.number(length("second"), second);
                });
                v.value(key("left").left_out_if(!*left), left);
            }
            Self::Mark { line, at } => {
                v.part(group("line"), line);
                v.mark(group("mark").share_label("part of the way"), at);
            }
            Self::Offset { base, x, y } => {
                v.id("from", base);
                v.list(group("offset"), &mut |v| {
                    v.number(length("x"), x);
                    v.number(length("y"), y);
                });
            }
            Self::Polar { base, angle: direction, distance } => {
                v.id("from", base);
                v.number(angle("angle"), direction);
                v.number(length("distance"), distance);
            }
            Self::Toward { base, tip, distance } => {
                v.id("from", base);
                v.id("toward", tip);
                v.number(length("distance"), distance);
            }
            Self::Between { base, tip, along, aside } => {
                v.id("from", base);
                v.id("to", tip);
                v.number(plain("along"), along);
                v.number(plain("aside").left_out_at(0.0), aside);
            }
        }
    },
    kinds: |rule| Told::By(match rule {
        PointRule::At { .. } => &["at"],
        PointRule::CurveCrossing { .. } => &["curves"],
        PointRule::LineCrossing { .. } => &["curve", "line"],
        PointRule::AlongCurve { .. } => &["curve", "distance"],
        PointRule::OnCurve { .. } => &["curve"],
        PointRule::Crossing { .. } => &["crossing"],
        PointRule::Foot { .. } => &["foot"],
        PointRule::Mirrored { .. } => &["mirror"],
        PointRule::OnLineAt { .. } => &["on_line"],
        PointRule::TwoDistances { .. } => &["centres"],
        PointRule::Mark { .. } => &["mark"],
        PointRule::Offset { .. } => &["from", "offset"],
        PointRule::Polar { .. } => &["from", "angle"],
        PointRule::Toward { .. } => &["from", "toward"],
        PointRule::Between { .. } => &["from"],
    }),
    clash: Clash {
        none: Some([
            "the point has no place".into(),
            "give it at, from, curve, curves, crossing, foot, mirror, on_line, centres or mark".into(),
        ]),
        ..Clash::default()
    },
);

/// File field for the number that picks one of several crossings.
const INDEX: ValueField = key("index")
    .may_lack()
    .beyond("there are not that many crossings", "write 0 or more");

impl PointRule {
    /// A point at fixed coordinates (m).
    pub fn at(x: f64, y: f64) -> Self {
        Self::At {
            x: x.into(),
            y: y.into(),
        }
    }
}

/// A curve of a sheet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Identifier of the curve.
    pub id: CurveId,
    /// Name for formulas, unique among the curves of its sheet.
    pub name: String,
    /// Start and end of the curve.
    pub ends: [PointId; 2],
    /// Shape of the curve between its ends.
    pub rule: CurveRule,
}

fields!(Curve, |self, v| {
    let Self {
        id,
        name,
        ends: [from, to],
        rule,
    } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.id("from", from);
    v.id("to", to);
    v.flat(rule);
});

/// Rule for the shape of a curve between its ends.
#[derive(Clone, Debug, PartialEq, Default, EnumIter, Serialize, Deserialize)]
pub enum CurveRule {
    /// A straight line.
    #[default]
    Line,
    /// A circular arc.
    Arc {
        /// Bulge: tangent of a quarter of the swept angle (1); positive if the arc turns counter-clockwise, 1
        /// for a half circle.
        bulge: Number,
    },
    /// Cubic Bezier curves through knots.
    Spline {
        /// Handles at the start and at the end.
        handles: [PointId; 2],
        /// Points between the ends, in order.
        knots: Vec<Knot>,
        /// Arc length of the spline (m), reached by scaling the distance of all handles from their points.
        /// `None`: the handles stay as they are.
        to_length: Option<Number>,
    },
    /// The mirror image of another curve in the line through two points.
    Mirrored {
        /// The curve that is mirrored.
        of: CurveId,
        /// The mirror line.
        line: [PointId; 2],
    },
    /// Another curve, turned and scaled so that it starts and ends at the ends of this curve.
    Copy {
        /// The curve that is copied.
        of: CurveId,
    },
}

fields!(
    CurveRule,
    |self, v| {
        match self {
            Self::Line => {}
            Self::Arc { bulge } => v.number(plain("bulge"), bulge),
            Self::Spline { handles: [start, end], knots, to_length } => {
                v.list(group("handles"), &mut |v| {
                    v.id("start", start);
                    v.id("end", end);
                });
                v.each(group("knots"), knots);
                v.optional_number(length("to_length").label("length"), to_length);
            }
            Self::Mirrored { of, line: [from, to] } => {
                v.id("mirror", of);
                v.list(group("in"), &mut |v| {
                    v.id("from", from);
                    v.id("to", to);
                });
            }
            Self::Copy { of } => v.id("copy", of),
        }
    },
    kinds: |rule| Told::By(match rule {
        CurveRule::Line => &[],
        CurveRule::Arc { .. } => &["bulge"],
        CurveRule::Spline { .. } => &["handles"],
        CurveRule::Mirrored { .. } => &["mirror"],
        CurveRule::Copy { .. } => &["copy"],
    }),
);

/// A point that a spline passes through, with its handles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Knot {
    /// Handle before the point.
    pub before: PointId,
    /// The point.
    pub point: PointId,
    /// Handle after the point.
    pub after: PointId,
}

fields!(Knot, |self, v| {
    let Self {
        before,
        point,
        after,
    } = self;
    v.list(group(ITSELF), &mut |v| {
        v.id("before", before);
        v.id("point", point);
        v.id("after", after);
    });
});
