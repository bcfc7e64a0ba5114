//! Adds sheets, points and curves.

use super::additions::Additions;
use super::impossible;
use super::lookup::{self, after, finite, place, refuse_faults};
use super::names::{free_name, numbered_name, sheet_owner, wished};
use crate::{
    CurveId, CurveRule, Edit, EditError, Entity, Evaluation, Knot, Number, Place, PointId,
    PointRule, SheetHead, SheetId,
};
use toile_geometry::Vec2;

/// Shape of a new curve between its ends.
#[derive(Clone, Debug, PartialEq)]
pub enum CurveShape {
    /// A circular arc through a point (m).
    ArcThrough(Vec2),
    /// A spline with handles at these positions (m). For each handle a point is added to the sheet; it is
    /// placed relative to the spline's end or knot that it belongs to, and moves with it.
    Spline {
        /// Handles at the start and at the end (m).
        handles: [Vec2; 2],
        /// Knots in order; each is given by its handle before, the knot, and its handle after (m).
        knots: Vec<[Vec2; 3]>,
    },
    /// A rule that needs no new points: a line, an arc by its bulge, a mirror image, a copy.
    Rule(CurveRule),
}

/// Plans to add an empty sheet with its origin at a position on the table (m); returns the sheet too. Without
/// a name the sheet is called `sheet`, `sheet 2`, ...
///
/// # Errors
/// The name is taken or not allowed; the position is not finite.
pub fn add_sheet(
    evaluation: &Evaluation,
    name: Option<&str>,
    on_table: [f64; 2],
) -> Result<(Vec<Edit>, SheetId), EditError> {
    let pattern = evaluation.pattern();
    let owner = |name: &str| sheet_owner(pattern, None, name);
    let name = match name {
        Some(name) => wished(name, owner)?,
        None => free_name("sheet", |name| owner(name).is_some()),
    };
    finite("the place of the sheet", &[on_table.into()])?;
    let mut ids = pattern.ids;
    let id: SheetId = ids.take();
    let head = SheetHead {
        id,
        name,
        on: None,
        on_table,
    };
    Ok((vec![Edit::Put(Entity::Sheet(head))], id))
}

/// Plans to move sheets on the table, each with its origin to a position (m). Panels traced from a sheet move
/// along.
///
/// # Errors
/// A sheet is missing, or it lies on a panel and moves only with that panel; a position is not finite.
pub fn move_sheets(
    evaluation: &Evaluation,
    places: &[(SheetId, [f64; 2])],
) -> Result<Vec<Edit>, EditError> {
    let put = |&(id, on_table): &(SheetId, [f64; 2])| {
        let sheet = lookup::sheet(evaluation.pattern(), id)?;
        if sheet.on.is_some() {
            return Err(impossible(
                format!("sheet {:?} lies on a panel", sheet.name),
                "move that panel",
            ));
        }
        finite("the place of the sheet", &[on_table.into()])?;
        let head = SheetHead {
            id,
            name: sheet.name.clone(),
            on: None,
            on_table,
        };
        Ok(Edit::Put(Entity::Sheet(head)))
    };
    places.iter().map(put).collect()
}

/// Plans to add a point to a sheet; returns the point too. Without a name the point gets the next free letter
/// as its name: A, B, ... Z, A1, ...
///
/// # Errors
/// The name is taken or not allowed; the rule names parts of other sheets, or gives no position.
pub fn add_point(
    evaluation: &Evaluation,
    sheet: SheetId,
    name: Option<&str>,
    rule: PointRule,
) -> Result<(Vec<Edit>, PointId), EditError> {
    let mut additions = Additions::new(evaluation.pattern(), sheet)?;
    let id = additions.point(name, rule)?;
    let after = after(evaluation, &additions.edits)?;
    refuse_faults(evaluation, &after, &[Place::Point(id)])?;
    place(&after, id)?;
    Ok((additions.edits, id))
}

/// Plans to add a curve between two points of a sheet; returns the curve too. Without a name the curve is
/// named after its ends, as in `AB`.
///
/// # Errors
/// The name is taken or not allowed; the ends are not on the sheet; the shape cannot be drawn.
pub fn add_curve(
    evaluation: &Evaluation,
    (sheet, name): (SheetId, Option<&str>),
    ends: [PointId; 2],
    shape: CurveShape,
) -> Result<(Vec<Edit>, CurveId), EditError> {
    let mut additions = Additions::new(evaluation.pattern(), sheet)?;
    let rule = match shape {
        CurveShape::Rule(rule) => rule,
        CurveShape::ArcThrough(through) => {
            let bulge = bulge_through(evaluation, ends, through)?;
            CurveRule::Arc {
                bulge: Number::Value(bulge),
            }
        }
        CurveShape::Spline { handles, knots } => {
            spline(evaluation, &mut additions, ends, (handles, &knots))?
        }
    };
    let is_loop = matches!(&rule, CurveRule::Spline { .. } | CurveRule::Mirrored { .. });
    if ends[0] == ends[1] && !is_loop {
        return Err(impossible(
            "the curve would end where it starts",
            "choose two points, or draw a spline",
        ));
    }
    let id = additions.curve(name, ends, rule)?;
    let after = after(evaluation, &additions.edits)?;
    refuse_faults(evaluation, &after, &[Place::Curve(id)])?;
    lookup::path(&after, id)?;
    Ok((additions.edits, id))
}

/// Plans to bend a curve to a circular arc through the point `through` (m); the ends of the curve stay.
///
/// # Errors
/// The curve is missing; the point is not finite, or no arc between the ends passes through it.
pub fn bend_curve(
    evaluation: &Evaluation,
    id: CurveId,
    through: Vec2,
) -> Result<Vec<Edit>, EditError> {
    let found = evaluation.pattern().curve(id);
    let (sheet, curve) = found.ok_or_else(|| EditError::Missing(id.to_string()))?;
    let bulge = bulge_through(evaluation, curve.ends, through)?;
    let mut bent = (**curve).clone();
    bent.rule = match bulge.abs() < 1e-9 {
        true => CurveRule::Line,
        false => CurveRule::Arc {
            bulge: Number::Value(bulge),
        },
    };
    let edits = vec![Edit::Put(Entity::Curve(sheet.id, bent.into()))];
    let after = after(evaluation, &edits)?;
    refuse_faults(evaluation, &after, &[Place::Curve(id)])?;
    Ok(edits)
}

/// The bulge of the arc between two points that passes through a third. At the third point the chords to it
/// meet at a turn of half the swept angle (inscribed angle theorem); the bulge is the tangent of a quarter of
/// the swept angle.
fn bulge_through(
    evaluation: &Evaluation,
    ends: [PointId; 2],
    through: Vec2,
) -> Result<f64, EditError> {
    finite("the place on the arc", &[through])?;
    let start = place(evaluation, ends[0])?;
    let end = place(evaluation, ends[1])?;
    let (before, behind) = (through - start, end - through);
    let turn = before.perp(&behind).atan2(before.dot(&behind));
    let bulge = (0.5 * turn).tan();
    let is_apart = before.norm() > 1e-9 && behind.norm() > 1e-9;
    if is_apart && bulge.abs() < 1e6 {
        return Ok(bulge);
    }
    Err(impossible(
        "no arc leads from one end through that place to the other",
        "choose a place apart from both ends and not on the line beyond them",
    ))
}

/// The rule for a spline. Points for its handles and knots are added to the sheet.
fn spline(
    evaluation: &Evaluation,
    additions: &mut Additions,
    ends: [PointId; 2],
    (handles, knots): ([Vec2; 2], &[[Vec2; 3]]),
) -> Result<CurveRule, EditError> {
    finite("the handles", &handles)?;
    finite("the knots", &knots.concat())?;
    let handle = |additions: &mut Additions, base: PointId, from: Vec2, to: Vec2| {
        let name = numbered_name("h", |name| additions.sheet.point_named(name).is_some());
        let rule = PointRule::Offset {
            base,
            x: (to.x - from.x).into(),
            y: (to.y - from.y).into(),
        };
        additions.point(Some(&name), rule)
    };
    let start = place(evaluation, ends[0])?;
    let end = place(evaluation, ends[1])?;
    let first = handle(additions, ends[0], start, handles[0])?;
    let mut made = Vec::new();
    for &[before, at, after] in knots {
        let point = additions.point(None, PointRule::at(at.x, at.y))?;
        made.push(Knot {
            before: handle(additions, point, at, before)?,
            point,
            after: handle(additions, point, at, after)?,
        });
    }
    let last = handle(additions, ends[1], end, handles[1])?;
    Ok(CurveRule::Spline {
        handles: [first, last],
        knots: made,
        to_length: None,
    })
}
