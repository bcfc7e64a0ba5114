//! Finds the mark on a line of a panel nearest to a point.

use super::chain::ON_CURVE;
use super::construct::add_point;
use super::impossible;
use super::lookup::{finite, panel};
use super::on_stage::{nearest_edge, place_of};
use crate::{
    EdgeName, Edit, EditError, Evaluation, LineId, Mark, Name, PanelId, PointId, PointRule, Want,
};
use toile_geometry::Vec2;

/// A mark with its position.
#[derive(Clone, Debug, PartialEq)]
pub struct NearMark {
    /// The line that the mark is on.
    pub line: LineId,
    /// The edge that the mark is on.
    pub edge: EdgeName,
    /// The mark: a corner, or a share of the way along the edge.
    pub mark: Mark,
    /// Position of the mark (m).
    pub at: Vec2,
}

/// The mark nearest to a point (m) on the lines of a finished panel.
///
/// # Errors
/// The panel is missing or none of its edges can be drawn; the point is not finite.
pub fn nearest_mark(
    evaluation: &Evaluation,
    panel: PanelId,
    near: Vec2,
) -> Result<NearMark, EditError> {
    finite("the place", &[near])?;
    let panel = self::panel(evaluation.pattern(), panel)?;
    let found = nearest_edge(evaluation, panel, near, |_| true).ok_or_else(|| {
        impossible(
            format!("panel {:?} has no edge that can be drawn", panel.name),
            "mend its outline first",
        )
    })?;
    let along = found.share * found.length;
    let mark = match along {
        along if along <= ON_CURVE => Mark::Corner(found.ends[0]),
        along if along >= found.length - ON_CURVE => Mark::Corner(found.ends[1]),
        _ => Mark::Between {
            ends: found.ends,
            share: found.share.into(),
        },
    };
    Ok(NearMark {
        line: found.line,
        edge: found.edge,
        mark,
        at: found.at,
    })
}

/// Plans to add a point at a mark to the panel's sheet, unless the mark is at a drawn corner; returns the
/// point too. The point stays at the mark when the panel changes.
///
/// # Errors
/// The panel is missing; operations moved the place away from its drawn position, or made it.
pub(super) fn point_at_mark(
    evaluation: &Evaluation,
    panel: PanelId,
    near: NearMark,
) -> Result<(Vec<Edit>, PointId), EditError> {
    let owner = self::panel(evaluation.pattern(), panel)?;
    let made = || {
        impossible(
            format!(
                "operations of panel {:?} made or moved that place, which its sheet does not have",
                owner.name
            ),
            "choose a place that lies where it was drawn",
        )
    };
    let sheet = evaluation.pattern().sheet_of(owner).ok_or_else(made)?;
    let here = place_of(evaluation, owner, (Name::Drawn(near.line), &near.mark));
    let is_here = |at: Vec2| here.is_some_and(|here| (at - here).norm() <= ON_CURVE);
    if let Mark::Corner(Name::Drawn(point)) = near.mark {
        return match evaluation.point(point).is_some_and(is_here) {
            true => Ok((Vec::new(), point)),
            false => Err(made()),
        };
    }
    let (Name::Drawn(edge), Mark::Between { share, .. }) = (near.edge, &near.mark) else {
        return Err(made());
    };
    let drawn = evaluation.pattern().owner_of(panel, edge.into());
    let curve = drawn.and_then(|owner| Some(owner.edge(edge)?.curve));
    let rule = curve.and_then(|curve| {
        let along = evaluation.edge(edge)?;
        let share = evaluation.number(share, Want::Plain)?;
        let at = along.point(along.at_length(share * along.length())?);
        let path = evaluation.curve(curve)?;
        let share = (path.nearest(at)?.along / path.length()).into();
        is_here(at).then_some(PointRule::OnCurve { curve, share })
    });
    add_point(evaluation, sheet, None, rule.ok_or_else(made)?)
}
