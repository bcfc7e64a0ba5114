//! Moves, turns, mirrors and scales many points at once: only their free numbers change.

use super::impossible;
use super::lookup;
use super::moving::moved;
use crate::{Edit, EditError, Entity, Evaluation, Node, Number, Point, PointId, fields};
use std::collections::HashSet;
use std::sync::Arc;
use toile_geometry::Vec2;

/// Largest distance from its goal at which a point counts as having reached it (m).
const THERE: f64 = 1e-9;

/// An affine map of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// Images of the unit vectors along x and y (1).
    pub axes: [Vec2; 2],
    /// Image of the origin (m).
    pub origin: Vec2,
}

impl Affine {
    fn about(centre: Vec2, axes: [Vec2; 2]) -> Self {
        let turned = axes[0] * centre.x + axes[1] * centre.y;
        Self {
            axes,
            origin: centre - turned,
        }
    }

    /// Translation by the vector `by` (m).
    pub fn translation(by: Vec2) -> Self {
        Self {
            axes: [Vec2::x(), Vec2::y()],
            origin: by,
        }
    }

    /// Rotation about the point `about` (m) by an angle, counter-clockwise (rad).
    pub fn rotation(about: Vec2, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self::about(about, [Vec2::new(cos, sin), Vec2::new(-sin, cos)])
    }

    /// Reflection in the line through two points (m). Not finite if the points are the same.
    pub fn reflection([a, b]: [Vec2; 2]) -> Self {
        let unit = (b - a) / (b - a).norm();
        let flip = |v: Vec2| unit * (2.0 * v.dot(&unit)) - v;
        Self::about(a, [flip(Vec2::x()), flip(Vec2::y())])
    }

    /// Scaling about the point `about` (m) by factors along x and along y (1).
    pub fn scaling(about: Vec2, [x, y]: [f64; 2]) -> Self {
        Self::about(about, [Vec2::x() * x, Vec2::y() * y])
    }

    /// The map that applies `first` and then this map.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        let turned = |v: Vec2| self.axes[0] * v.x + self.axes[1] * v.y;
        Self {
            axes: first.axes.map(turned),
            origin: self.apply(first.origin),
        }
    }

    /// The point that this map takes to `image` (m); not finite if the map flattens the plane.
    pub fn source(&self, image: Vec2) -> Vec2 {
        let [x, y] = self.axes;
        let way = image - self.origin;
        let area = x.perp(&y);
        Vec2::new(way.perp(&y), x.perp(&way)) / area
    }

    /// The point to which this map takes `place` (m).
    pub fn apply(&self, place: Vec2) -> Vec2 {
        self.origin + self.axes[0] * place.x + self.axes[1] * place.y
    }
}

/// Result of moving many points.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Moved {
    /// Edits that move the points.
    pub edits: Vec<Edit>,
    /// Points that do not reach their goals, because other points determine them, or because they are bound
    /// to a line or a curve and move on it as near as possible.
    pub held: Vec<PointId>,
}

/// Plans to move points by an affine map. A point that reaches its goal only because the points that it is
/// constructed from are moved keeps its own numbers.
///
/// # Errors
/// A point is missing or cannot be drawn; the map is not finite; none of the points can move.
pub fn transform_points(
    evaluation: &Evaluation,
    points: &[PointId],
    map: &Affine,
) -> Result<Moved, EditError> {
    lookup::finite("the map", &[map.axes[0], map.axes[1], map.origin])?;
    let goals: Result<Vec<(PointId, Vec2)>, EditError> = points
        .iter()
        .map(|&id| Ok((id, map.apply(lookup::place(evaluation, id)?))))
        .collect();
    move_points(evaluation, &goals?)
}

/// Plans to move points, each to a goal of its own (m); see [`transform_points`].
///
/// # Errors
/// A point is missing or cannot be drawn; a goal is not finite; none of the points can move.
pub fn move_points(evaluation: &Evaluation, goals: &[(PointId, Vec2)]) -> Result<Moved, EditError> {
    let mut ordered: Vec<(Option<u32>, PointId, Vec2)> = Vec::new();
    for &(id, goal) in goals {
        lookup::finite("the new place", &[goal])?;
        lookup::place(evaluation, id)?;
        ordered.push((evaluation.rank(Node::Point(id)), id, goal));
    }
    // Each point comes after the points that it is constructed from.
    ordered.sort_by_key(|(rank, id, _)| (*rank, *id));
    let points: Vec<PointId> = goals.iter().map(|goal| goal.0).collect();
    let mut pattern = evaluation.pattern().clone();
    let mut work = evaluation.clone();
    let mut result = Moved::default();
    let mut first_refusal = None;
    let mut pending = ordered;
    while !pending.is_empty() {
        // Points that depend on other points in the list are moved after these.
        let mut dependants = HashSet::new();
        let mut later = Vec::new();
        let mut edits = Vec::new();
        for (rank, id, goal) in pending {
            let node = Node::Point(id);
            if dependants.contains(&node) {
                later.push((rank, id, goal));
                continue;
            }
            evaluation.gather_dependants(node, &mut dependants);
            match step(&work, id, goal) {
                Ok(edit) => edits.extend(edit),
                Err(refusal) => first_refusal = first_refusal.or(Some(refusal)),
            }
        }
        pattern.apply(&edits)?;
        work.update_points(&pattern, &points);
        result.edits.append(&mut edits);
        pending = later;
    }
    for &(id, goal) in goals {
        let is_there = |at: Vec2| (at - goal).norm() <= THERE;
        if !work.point(id).is_some_and(is_there) {
            result.held.push(id);
        }
    }
    match first_refusal {
        Some(refusal) if result.held.len() == goals.len() && result.edits.is_empty() => {
            Err(refusal)
        }
        _ => Ok(result),
    }
}

/// The edit that moves a point to its goal. `None`: the point is there already.
fn step(work: &Evaluation, id: PointId, goal: Vec2) -> Result<Option<Edit>, EditError> {
    let (sheet, found) = lookup::point(work.pattern(), id)?;
    let now = lookup::place(work, id)?;
    if (goal - now).norm() <= 1e-3 * THERE {
        return Ok(None);
    }
    let rule = moved(work, (sheet, &found.rule), now, goal)?;
    if !fields::numbers(&rule).into_iter().all(Number::is_finite) {
        return Err(impossible(
            format!("point {:?} would go too far", found.name),
            "move it less far",
        ));
    }
    let point = Arc::new(Point {
        rule,
        ..(**found).clone()
    });
    Ok(Some(Edit::Put(Entity::Point(sheet.id, point))))
}
