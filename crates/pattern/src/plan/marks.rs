//! From a place near a panel to a mark on one of its lines.

use super::chain::ON_CURVE;
use super::impossible;
use super::lookup::{finite, panel};
use crate::{EdgeId, EditError, Evaluation, LineId, Mark, PanelId};
use toile_geometry::Vec2;

/// A mark and where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct NearMark {
    /// The line it is on.
    pub line: LineId,
    /// The edge it is on.
    pub edge: EdgeId,
    /// The mark: a corner, or a share of the way along the edge.
    pub mark: Mark,
    /// Where it is [m].
    pub at: Vec2,
}

/// The mark nearest to a place [m] on the lines of a panel as drawn.
///
/// # Errors
/// The panel is not there or none of its edges can be drawn; the place is not finite.
pub fn nearest_mark(
    evaluation: &Evaluation,
    panel: PanelId,
    near: Vec2,
) -> Result<NearMark, EditError> {
    finite("the place", &[near])?;
    let panel = self::panel(evaluation.pattern(), panel)?;
    let mut best: Option<(f64, NearMark)> = None;
    for line in &panel.lines {
        for edge in &line.edges {
            let path = evaluation.edge(edge.id);
            let Some((path, place)) = path.and_then(|path| Some((path, path.nearest(near)?)))
            else {
                continue;
            };
            let at = path.point(place);
            let away = (at - near).norm();
            if best.as_ref().is_some_and(|best| best.0 <= away) {
                continue;
            }
            let length = path.length();
            let mark = match place.along {
                along if along <= ON_CURVE => Mark::corner(edge.ends[0]),
                along if along >= length - ON_CURVE => Mark::corner(edge.ends[1]),
                along => Mark::between(edge.ends, along / length),
            };
            let (line, edge) = (line.id, edge.id);
            best = Some((
                away,
                NearMark {
                    line,
                    edge,
                    mark,
                    at,
                },
            ));
        }
    }
    best.map(|best| best.1).ok_or_else(|| {
        impossible(
            format!("panel {:?} has no edge that can be drawn", panel.name),
            "mend its outline first",
        )
    })
}
