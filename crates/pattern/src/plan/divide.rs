//! Divides an edge at a new corner on its curve, and joins two edges at an old one: exact inverses
//! in every size, since the curve stays.
//!
//! # Decided with
//! - [`crate::mark::Mark`], [`crate::name::Name`]: notches and spans name corners, so nothing is carried over;
//! - [`crate::stage::Stage::placed`] (`place.rs`), [`crate::evaluate`] (`panels.rs`, `notches`; `seams.rs`, `locate`): where a
//!   mark lies on the present edges;
//! - [`crate::document::Pattern::users`] (`references.rs`): a corner that something names stays;
//! - [`crate::document::Edge`], [`crate::document::EdgeCorner`]: the allowance taken over, the new corner.

use super::names::free_name;
use super::on_stage::nearest_edge;
use super::{impossible, lookup};
use crate::{
    Curve, CurveId, CurveRule, Edge, EdgeCorner, EdgeId, Edit, EditError, Entity, Evaluation, Name,
    Number, Panel, PanelId, PartId, Place, Point, PointId, PointRule, Sheet,
};
use std::sync::Arc;
use toile_geometry::Vec2;

/// Plans to divide an edge by a new corner: at the place nearest to the point `near` of the finished panel
/// (m), or in the middle of the edge. Returns the corner too. On a side of a split panel, the panel that was
/// split gets the corner.
///
/// # Errors
/// The edge is missing or cannot be drawn, or the place is one of its ends.
pub fn divide_edge(
    evaluation: &Evaluation,
    (panel, edge): (PanelId, EdgeId),
    near: Option<Vec2>,
) -> Result<(Vec<Edit>, PointId), EditError> {
    let pattern = evaluation.pattern();
    let missing = |part: &dyn std::fmt::Display| EditError::Missing(part.to_string());
    let seen = pattern.panel(panel).ok_or_else(|| missing(&panel))?;
    // The edges of a side belong to the panel that was split.
    let owner = pattern.owner_of(panel, edge.into());
    let owner = owner.ok_or_else(|| missing(&edge))?;
    let old = owner.edge(edge).ok_or_else(|| missing(&edge))?;
    let sheet = lookup::drawn_on(pattern, owner)?;
    let undrawn = || impossible("the edge cannot be drawn", "mend its formulas first");
    let path = evaluation.edge(edge).ok_or_else(undrawn)?;
    let curve = evaluation.curve(old.curve).ok_or_else(undrawn)?;
    let middle = path.at_length(0.5 * path.length()).ok_or_else(undrawn)?;
    let place = match near {
        Some(near) => {
            let own = |name| name == Name::Drawn(edge);
            match nearest_edge(evaluation, seen, near, own) {
                Some(found) => path.at_length(found.share * path.length()),
                None => path.nearest(near),
            }
            .ok_or_else(undrawn)?
        }
        None => middle,
    };
    if place.along < 1e-9 * path.length() || place.along > (1.0 - 1e-9) * path.length() {
        return Err(impossible(
            "an edge is divided at one of its ends",
            "choose a place between its ends",
        ));
    }
    let on_curve = curve.nearest(path.point(place)).ok_or_else(undrawn)?;
    let mut ids = pattern.ids;
    let corner: PointId = ids.take();
    let point = Point {
        id: corner,
        name: free_name(&format!("p{}", corner.0), |name| {
            sheet.point_named(name).is_some()
        }),
        rule: PointRule::OnCurve {
            curve: old.curve,
            share: Number::Value(on_curve.along / curve.length()),
        },
    };
    let mut changed = owner.clone();
    let name = free_name(&format!("{} 2", old.name), |name| {
        owner.edge_named(name).is_some()
    });
    let second = Edge {
        id: ids.take(),
        name,
        ends: [corner, old.ends[1]],
        corner: EdgeCorner::default(),
        ..old.clone()
    };
    for line in &mut changed.lines {
        if let Some(k) = line.edges.iter().position(|known| known.id == edge) {
            line.edges[k].ends[1] = corner;
            line.edges.insert(k + 1, second.clone());
        }
    }
    let edits = vec![
        Edit::Put(Entity::Point(sheet.id, Arc::new(point))),
        Edit::Put(Entity::Panel(Arc::new(changed))),
    ];
    Ok((edits, corner))
}

/// Plans to remove a corner: the edges before and after it become one edge. If both follow the same curve, so
/// does the new edge; else the new edge is a straight line.
///
/// # Errors
/// The panel has no such corner, or its line would have too few corners left.
pub fn join_edges(
    evaluation: &Evaluation,
    (panel, corner): (PanelId, PointId),
) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    let missing = |part: &dyn std::fmt::Display| EditError::Missing(part.to_string());
    let owner = pattern.panel(panel).ok_or_else(|| missing(&panel))?;
    let sheet = lookup::drawn_on(pattern, owner)?;
    let mut changed = (**owner).clone();
    let line = changed
        .lines
        .iter_mut()
        .find(|line| line.edges.iter().any(|edge| edge.ends[1] == corner))
        .ok_or_else(|| EditError::Missing(format!("a corner at {corner}")))?;
    if line.is_closed() && line.edges.len() < 3 {
        return Err(impossible(
            "an outline of two edges would lose one",
            "remove the panel or the hole instead",
        ));
    }
    let count = line.edges.len();
    let k = line
        .edges
        .iter()
        .position(|edge| edge.ends[1] == corner)
        .unwrap_or(0);
    let next = (k + 1) % count;
    if line.edges[next].ends[0] != corner || next == k {
        return Err(impossible(
            "the line ends at this corner or is open there",
            "choose a corner between two edges",
        ));
    }
    let gone = line.edges[next].clone();
    let kept = line.edges[k].clone();
    let ends = [kept.ends[0], gone.ends[1]];
    let mut ids = pattern.ids;
    let mut edits = Vec::new();
    line.edges[k].ends = ends;
    if kept.curve != gone.curve {
        let id: CurveId = ids.take();
        let name = free_name(&kept.name, |name| sheet.curve_named(name).is_some());
        line.edges[k].curve = id;
        edits.push(Edit::Put(Entity::Curve(
            sheet.id,
            Arc::new(Curve {
                id,
                name,
                ends,
                rule: CurveRule::Line,
            }),
        )));
    }
    line.edges.remove(next);
    let changed = Arc::new(changed);
    edits.push(Edit::Put(Entity::Panel(changed.clone())));
    edits.extend(unused(
        evaluation,
        &changed,
        sheet,
        corner,
        [kept.curve, gone.curve],
    ));
    Ok(edits)
}

/// Edits that remove the corner, if it is a point on a curve, as dividing an edge makes it, and the curves.
/// Each is removed only if nothing uses it any longer; `panel` is the panel as changed.
fn unused(
    evaluation: &Evaluation,
    panel: &Arc<Panel>,
    sheet: &Sheet,
    corner: PointId,
    curves: [CurveId; 2],
) -> Vec<Edit> {
    let pattern = evaluation.pattern();
    let mut edits = Vec::new();
    let only = |part: PartId, allowed: &[Place]| {
        pattern
            .users(part)
            .iter()
            .all(|place| allowed.contains(place))
    };
    let own = Place::Panel(panel.id);
    let mut allowed = vec![own.clone()];
    if curves[0] != curves[1] {
        for curve in curves {
            let still = panel.edges().any(|edge| edge.curve == curve);
            let is_there = pattern.curve(curve).is_some();
            if is_there && !still && only(curve.into(), std::slice::from_ref(&own)) {
                edits.push(Edit::Remove(curve.into()));
                allowed.push(Place::Curve(curve));
            }
        }
    }
    let named = Entity::Panel(panel.clone()).references();
    let is_made_for_it = matches!(
        sheet.point(corner).map(|point| &point.rule),
        Some(PointRule::OnCurve { .. })
    );
    if is_made_for_it && !named.contains(&corner.into()) && only(corner.into(), &allowed) {
        edits.push(Edit::Remove(corner.into()));
    }
    edits
}
