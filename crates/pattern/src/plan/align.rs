//! Aligns parts by their sides or middles, and distributes them evenly.

use super::impossible;
use super::lookup::place;
use super::transform::{Moved, move_points};
use crate::{EditError, Evaluation, PointId};
use toile_geometry::{Bounds2, Vec2};

/// Sides or middles of parts that are aligned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alignment {
    /// Left sides, moved to the leftmost of them.
    Left,
    /// Right sides, moved to the rightmost of them.
    Right,
    /// Upper sides, moved to the topmost of them.
    Top,
    /// Lower sides, moved to the bottommost of them.
    Bottom,
    /// Middles, moved to one vertical line through the middle of all groups together.
    Middle,
    /// Middles, moved to one horizontal line through the middle of all groups together.
    Level,
}

/// A direction in which parts are distributed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// From left to right.
    X,
    /// From bottom to top.
    Y,
}

/// Plans to align groups of points. The points of a group are moved by the same displacement.
///
/// # Errors
/// There are fewer than two groups, or an empty one; a point is missing or cannot be drawn; no group
/// can move.
pub fn align(
    evaluation: &Evaluation,
    groups: &[Vec<PointId>],
    alignment: Alignment,
) -> Result<Moved, EditError> {
    let bounds = bounds(evaluation, groups, 2)?;
    let all = bounds.iter().fold(Bounds2::EMPTY, |all, b| all.union(b));
    let shift = |own: &Bounds2| match alignment {
        Alignment::Left => Vec2::new(all.min.x - own.min.x, 0.0),
        Alignment::Right => Vec2::new(all.max.x - own.max.x, 0.0),
        Alignment::Top => Vec2::new(0.0, all.max.y - own.max.y),
        Alignment::Bottom => Vec2::new(0.0, all.min.y - own.min.y),
        Alignment::Middle => Vec2::new(all.centre().x - own.centre().x, 0.0),
        Alignment::Level => Vec2::new(0.0, all.centre().y - own.centre().y),
    };
    let shifts: Vec<Vec2> = bounds.iter().map(shift).collect();
    shifted(evaluation, groups, &shifts)
}

/// Plans to distribute groups of points evenly along an axis. The outermost groups stay; the middles of the
/// other groups are moved to equal distances, in their present order.
///
/// # Errors
/// There are fewer than three groups, or an empty one; a point is missing or cannot be drawn; no group
/// can move.
pub fn distribute(
    evaluation: &Evaluation,
    groups: &[Vec<PointId>],
    axis: Axis,
) -> Result<Moved, EditError> {
    let bounds = bounds(evaluation, groups, 3)?;
    let (k, unit) = match axis {
        Axis::X => (0, Vec2::x()),
        Axis::Y => (1, Vec2::y()),
    };
    let middles: Vec<f64> = bounds.iter().map(|own| own.centre()[k]).collect();
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by(|&a, &b| middles[a].total_cmp(&middles[b]));
    let last = order.len() - 1;
    let (low, high) = (middles[order[0]], middles[order[last]]);
    let mut shifts = vec![Vec2::zeros(); groups.len()];
    for (rank, &group) in order.iter().enumerate() {
        let wanted = low + (high - low) * rank as f64 / last as f64;
        shifts[group] = unit * (wanted - middles[group]);
    }
    shifted(evaluation, groups, &shifts)
}

fn bounds(
    evaluation: &Evaluation,
    groups: &[Vec<PointId>],
    least: usize,
) -> Result<Vec<Bounds2>, EditError> {
    if groups.len() < least || groups.iter().any(Vec::is_empty) {
        return Err(impossible(
            "there are too few parts with points",
            format!("choose at least {least}"),
        ));
    }
    let of_group = |group: &Vec<PointId>| -> Result<Bounds2, EditError> {
        let places: Result<Vec<Vec2>, EditError> =
            group.iter().map(|&id| place(evaluation, id)).collect();
        Ok(Bounds2::of(places?))
    };
    groups.iter().map(of_group).collect()
}

fn shifted(
    evaluation: &Evaluation,
    groups: &[Vec<PointId>],
    shifts: &[Vec2],
) -> Result<Moved, EditError> {
    let mut goals: Vec<(PointId, Vec2)> = Vec::new();
    for (group, shift) in groups.iter().zip(shifts) {
        for &id in group {
            if !goals.iter().any(|goal| goal.0 == id) {
                goals.push((id, place(evaluation, id)? + shift));
            }
        }
    }
    move_points(evaluation, &goals)
}
