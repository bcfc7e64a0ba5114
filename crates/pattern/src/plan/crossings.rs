//! Adds points at crossings of curves, so that panels can be traced between them.

use super::additions::Additions;
use super::chain::ON_CURVE;
use super::impossible;
use super::lookup::{curve, path};
use crate::{CurveId, Edit, EditError, Evaluation, PointId, PointRule, SheetId};

/// Plans to add a point at every crossing of two curves of a sheet that has no point yet; returns the points
/// too, in the order of the first curve. The points stay at the crossings when the curves move.
///
/// # Errors
/// A curve is missing or cannot be drawn; the curves do not cross, or all crossings have a point already.
pub fn mark_crossings(
    evaluation: &Evaluation,
    sheet: SheetId,
    curves: [CurveId; 2],
) -> Result<(Vec<Edit>, Vec<PointId>), EditError> {
    let names = curves.map(|id| Ok(&*curve(evaluation.pattern(), id)?.1.name));
    let [one, other]: [Result<&str, EditError>; 2] = names;
    let (one, other) = (one?, other?);
    let found = match curves[0] == curves[1] {
        true => Vec::new(),
        false => path(evaluation, curves[0])?.crossings(path(evaluation, curves[1])?),
    };
    if found.is_empty() {
        return Err(impossible(
            format!("curves {one:?} and {other:?} do not cross"),
            "choose two curves that do",
        ));
    }
    let mut additions = Additions::new(evaluation.pattern(), sheet)?;
    let places: Vec<_> = additions
        .sheet
        .points
        .iter()
        .filter_map(|point| evaluation.point(point.id))
        .collect();
    let mut made = Vec::new();
    for (index, crossing) in (0_u16..).zip(&found) {
        let mut marked = places.iter().map(|place| (place - crossing.point).norm());
        if !marked.any(|away| away <= 2.0 * ON_CURVE) {
            made.push(additions.point(None, PointRule::CurveCrossing { curves, index })?);
        }
    }
    match made.is_empty() {
        true => Err(impossible(
            format!("every crossing of curves {one:?} and {other:?} has a point"),
            "use these points",
        )),
        false => Ok((additions.edits, made)),
    }
}
