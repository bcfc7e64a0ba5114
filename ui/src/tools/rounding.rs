//! Places of dragged points for which the numbers that define them are round: coordinates, distances and
//! angles, and the adjustments of formulas.

use crate::canvas::placed::drag_step;
use crate::tools::{Pointer, Reading};
use toile_geometry::Vec2;
use toile_pattern::{Evaluation, Number, PointId, PointRule, Want};

/// For a dragged point: the place nearest to the drag target (m) at which the numbers of the point's rule
/// are round. The target itself while rounding is turned off, or if the point's rule has no such numbers.
pub(super) fn rounded_place(
    point: PointId,
    to: Vec2,
    pointer: &Pointer,
    reading: &Reading<'_>,
) -> Vec2 {
    if pointer.modifiers.command {
        return to;
    }
    let evaluation = reading.evaluation;
    let step = drag_step(pointer.pixel, evaluation.pattern().unit.metres());
    let Some((_, found)) = evaluation.pattern().point(point) else {
        return to;
    };
    let round = |number: &Number, value: f64, step: f64| {
        let kept = kept(number, evaluation);
        kept + ((value - kept) / step).round() * step
    };
    let place = |id| evaluation.point(id);
    match &found.rule {
        PointRule::At { x, y } => Vec2::new(round(x, to.x, step), round(y, to.y, step)),
        PointRule::Offset { base, x, y } => match place(*base) {
            Some(base) => {
                let way = to - base;
                base + Vec2::new(round(x, way.x, step), round(y, way.y, step))
            }
            None => to,
        },
        PointRule::Polar {
            base,
            angle,
            distance,
        } => match place(*base) {
            Some(base) if (to - base).norm() > step => {
                let way = to - base;
                let far = round(distance, way.norm(), step);
                let turned = round(angle, way.y.atan2(way.x), angle_step(step, far));
                base + Vec2::new(turned.cos(), turned.sin()) * far
            }
            _ => to,
        },
        PointRule::Toward {
            base,
            tip,
            distance,
        } => match (place(*base), place(*tip)) {
            (Some(base), Some(tip)) if (tip - base).norm() > 1e-9 => {
                let way = (tip - base).normalize();
                base + way * round(distance, (to - base).dot(&way), step)
            }
            _ => to,
        },
        PointRule::AlongCurve { curve, distance } => {
            let along = evaluation.curve(*curve).and_then(|path| {
                let along = path.nearest(to)?.along;
                let from = evaluation.number(distance, Want::Length)?;
                let start = if from < 0.0 { path.length() } else { 0.0 };
                let along = start + round(distance, along - start, step);
                Some(path.point(path.at_length(along.clamp(0.0, path.length()))?))
            });
            along.unwrap_or(to)
        }
        _ => to,
    }
}

/// Part of a number that a drag does not round: the value of its formula. The drag rounds only the
/// adjustment that is added to the formula.
fn kept(number: &Number, evaluation: &Evaluation) -> f64 {
    let formula = match number {
        Number::Formula(formula) | Number::Adjusted { formula, .. } => formula.clone(),
        Number::Value(_) | Number::PerSize { .. } => return 0.0,
    };
    let value = evaluation.number(&Number::Formula(formula), Want::Any);
    value.unwrap_or(0.0)
}

/// Rounding step of an angle (rad) for a point at the distance `far` from the centre: the least of 1, 2 or
/// 5 times a power of ten of a degree that moves the point by at least `step` (m); at most a degree.
fn angle_step(step: f64, far: f64) -> f64 {
    let degrees = (step / far).to_degrees().min(1.0);
    // The same steps as for lengths, with a degree in place of a millimetre.
    (drag_step(degrees * 0.001, 0.001) * 1000.0).to_radians()
}
