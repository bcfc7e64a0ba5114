//! Draws rectangles and polygons on a sheet, on request with panels traced round them.

use super::additions::Additions;
use super::chain::Chain;
use super::impossible;
use super::lookup::{after, finite};
use super::names::free_name;
use super::trace::{NewPanel, trace_panel};
use crate::{
    CurveId, CurveRule, Edit, EditError, Evaluation, Number, PanelId, PointId, PointRule, SheetId,
    Want,
};
use toile_geometry::Vec2;

/// First corner of a rectangle.
#[derive(Clone, Debug, PartialEq)]
pub enum FirstCorner {
    /// At coordinates of the sheet (m).
    At([Number; 2]),
    /// At a point of the sheet.
    Point(PointId),
}

/// The parts of a new figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Corners, in order.
    pub points: Vec<PointId>,
    /// Sides of the figure; side k runs from corner k to the next.
    pub curves: Vec<CurveId>,
    /// The panel traced round the figure, if one was asked for.
    pub panel: Option<PanelId>,
}

/// Plans to draw a rectangle to the right of and above its first corner, with sides `[width, height]` (m);
/// returns its parts too. The other corners are placed relative to the first, by the same formulas. The sides
/// are called bottom, right, top and left.
///
/// # Errors
/// The sheet or the corner is missing; a side has no length or no value; the panel cannot be traced.
pub fn add_rectangle(
    evaluation: &Evaluation,
    sheet: SheetId,
    (corner, [width, height]): (FirstCorner, [Number; 2]),
    panel: Option<NewPanel<'_>>,
) -> Result<(Vec<Edit>, Figure), EditError> {
    let mut additions = Additions::new(evaluation.pattern(), sheet)?;
    let first = match corner {
        FirstCorner::At([x, y]) => additions.point(None, PointRule::At { x, y })?,
        FirstCorner::Point(point) => {
            super::lookup::place(evaluation, point)?;
            point
        }
    };
    let mut beside = |x: &Number, y: &Number| {
        let rule = PointRule::Offset {
            base: first,
            x: x.clone(),
            y: y.clone(),
        };
        additions.point(None, rule)
    };
    let points = vec![
        first,
        beside(&width, &Number::ZERO)?,
        beside(&width, &height)?,
        beside(&Number::ZERO, &height)?,
    ];
    let names = ["bottom", "right", "top", "left"];
    let mut curves = Vec::new();
    for k in 0..4 {
        let ends = [points[k], points[(k + 1) % 4]];
        let name = free_name(names[k], |name| additions.sheet.curve_named(name).is_some());
        curves.push(additions.curve(Some(&name), ends, CurveRule::Line)?);
    }
    let drawn = after(evaluation, &additions.edits)?;
    for (what, number) in [("width", &width), ("height", &height)] {
        let value = drawn.number(number, Want::Length);
        if value.is_none_or(|value| value.abs() < 1e-9) {
            return Err(impossible(
                format!("the rectangle has no {what}"),
                "give it a length more than nothing, with a unit",
            ));
        }
    }
    let figure = Figure {
        points,
        curves,
        panel: None,
    };
    finished(&drawn, additions, figure, panel)
}

/// Plans to draw a polygon through positions on a sheet (m), with a new point at each; returns its parts too.
///
/// # Errors
/// There are fewer than three positions, or two consecutive ones are equal; the panel cannot be traced.
pub fn add_polygon(
    evaluation: &Evaluation,
    sheet: SheetId,
    places: &[Vec2],
    panel: Option<NewPanel<'_>>,
) -> Result<(Vec<Edit>, Figure), EditError> {
    finite("the corners", places)?;
    let count = places.len();
    let is_apart = (0..count).all(|k| (places[k] - places[(k + 1) % count]).norm() > 1e-9);
    if count < 3 || !is_apart {
        return Err(impossible(
            "the polygon has fewer than three corners, or two in one place",
            "choose at least three places that are apart",
        ));
    }
    let mut additions = Additions::new(evaluation.pattern(), sheet)?;
    let mut points = Vec::new();
    for place in places {
        points.push(additions.point(None, PointRule::at(place.x, place.y))?);
    }
    let mut curves = Vec::new();
    for k in 0..count {
        let ends = [points[k], points[(k + 1) % count]];
        curves.push(additions.curve(None, ends, CurveRule::Line)?);
    }
    let drawn = after(evaluation, &additions.edits)?;
    let figure = Figure {
        points,
        curves,
        panel: None,
    };
    finished(&drawn, additions, figure, panel)
}

/// Completes a figure, with a panel traced round it if one was asked for.
fn finished(
    drawn: &Evaluation,
    additions: Additions,
    mut figure: Figure,
    panel: Option<NewPanel<'_>>,
) -> Result<(Vec<Edit>, Figure), EditError> {
    let mut edits = additions.edits;
    if let Some(new) = panel {
        let chain = Chain::Curves(&figure.curves);
        let (more, panel) = trace_panel(drawn, additions.sheet.id, chain, new)?;
        edits.extend(more);
        figure.panel = Some(panel);
    }
    Ok((edits, figure))
}
