//! Computes the positions of points.

use super::node::Node;
use super::numbers::{Computation, bounded_place};
use super::on_stage;
use crate::Want;
use crate::formula::Failure;
use crate::{Code, Number, Place, Point, PointId, PointRule};
use std::sync::Arc;
use toile_geometry::{Curve, Path, Vec2};

/// The position of a point (m).
pub(super) fn point(computation: &mut Computation<'_>, point: &Arc<Point>) -> Option<Vec2> {
    if let PointRule::Mark { line, at } = &point.rule {
        return on_stage::point(computation, point, (*line, at));
    }
    let result = construct(computation, &point.rule).and_then(bounded_place);
    if result.is_ok() {
        return result.ok();
    }
    let what = computation.point_words(point);
    computation.reported(result, &Place::Point(point.id), &what)
}

impl Computation<'_> {
    pub(super) fn point_words(&self, point: &Point) -> String {
        match self.evaluation.names.sheet_of_point(point.id) {
            Some(sheet) => format!("sheet {sheet:?}, point {:?}", point.name),
            None => format!("point {:?}", point.name),
        }
    }

    fn vector(&mut self, x: &Number, y: &Number) -> Result<Vec2, Failure> {
        Ok(Vec2::new(
            self.measure(x, Want::Length)?,
            self.measure(y, Want::Length)?,
        ))
    }

    /// Start of the line through two points, and the vector to its second point (m).
    fn line(&self, [a, b]: [PointId; 2]) -> Result<(Vec2, Vec2), Failure> {
        let start = self.point_at(a)?;
        Ok((start, self.point_at(b)? - start))
    }
}

fn construct(c: &mut Computation<'_>, rule: &PointRule) -> Result<Vec2, Failure> {
    match rule {
        PointRule::At { x, y } => c.vector(x, y),
        // A point with this rule is computed by `on_stage`.
        PointRule::Mark { .. } => Err(same_place()),
        PointRule::Offset { base, x, y } => Ok(c.point_at(*base)? + c.vector(x, y)?),
        PointRule::Polar {
            base,
            angle,
            distance,
        } => {
            let angle = c.measure(angle, Want::Angle)?;
            let direction = Vec2::new(angle.cos(), angle.sin());
            Ok(c.point_at(*base)? + direction * c.measure(distance, Want::Length)?)
        }
        PointRule::Between {
            base,
            tip,
            along,
            aside,
        } => {
            let (start, way) = c.line([*base, *tip])?;
            let left = Vec2::new(-way.y, way.x);
            let along = c.measure(along, Want::Plain)?;
            Ok(start + way * along + left * c.measure(aside, Want::Plain)?)
        }
        PointRule::Toward {
            base,
            tip,
            distance,
        } => {
            let (start, way) = c.line([*base, *tip])?;
            let unit = way.try_normalize(1e-12).ok_or_else(same_place)?;
            Ok(start + unit * c.measure(distance, Want::Length)?)
        }
        PointRule::OnCurve { curve, share } => {
            let share = c.measure(share, Want::Plain)?;
            let path = c.path(Node::Curve(*curve))?;
            on_path(path, path.length() * share)
        }
        PointRule::AlongCurve { curve, distance } => {
            let distance = c.measure(distance, Want::Length)?;
            let path = c.path(Node::Curve(*curve))?;
            let from_end = if distance < 0.0 { path.length() } else { 0.0 };
            on_path(path, from_end + distance)
        }
        PointRule::Crossing { first, second } => {
            let (a, along) = c.line(*first)?;
            let (b, other) = c.line(*second)?;
            let turn = along.perp(&other);
            if turn.abs() <= 1e-12 * along.norm() * other.norm() {
                return Err(Failure::new(
                    Code::Formula,
                    "the two lines are parallel",
                    "choose lines that meet",
                ));
            }
            Ok(a + along * ((b - a).perp(&other) / turn))
        }
        PointRule::CurveCrossing { curves, index } => {
            let [first, second] = curves.map(Node::Curve);
            let found = c.path(first)?.crossings(c.path(second)?);
            let points: Vec<Vec2> = found.iter().map(|crossing| crossing.point).collect();
            chosen(&points, *index)
        }
        PointRule::LineCrossing { line, curve, index } => {
            let (start, way) = c.line(*line)?;
            let unit = way.try_normalize(1e-12).ok_or_else(same_place)?;
            let path = c.path(Node::Curve(*curve))?;
            let reach = path
                .curves()
                .iter()
                .flat_map(Curve::defining_points)
                .map(|p| (p - start).norm())
                .fold(0.0, f64::max);
            let ray = Path::new(vec![Curve::Line {
                start: start - unit * (2.0 * reach),
                end: start + unit * (2.0 * reach),
            }]);
            let points: Vec<Vec2> = path.crossings(&ray).iter().map(|p| p.point).collect();
            chosen(&points, *index)
        }
        PointRule::Foot { base, line } => {
            let (start, way) = c.line(*line)?;
            let unit = way.try_normalize(1e-12).ok_or_else(same_place)?;
            Ok(start + unit * (c.point_at(*base)? - start).dot(&unit))
        }
        PointRule::Mirrored { base, line } => {
            let (start, way) = c.line(*line)?;
            let unit = way.try_normalize(1e-12).ok_or_else(same_place)?;
            let offset = c.point_at(*base)? - start;
            Ok(start + unit * (2.0 * offset.dot(&unit)) - offset)
        }
        PointRule::OnLineAt {
            line,
            centre,
            distance,
            far,
        } => {
            let (start, way) = c.line(*line)?;
            let unit = way.try_normalize(1e-12).ok_or_else(same_place)?;
            let to_centre = c.point_at(*centre)? - start;
            let distance = c.measure(distance, Want::Length)?;
            let half = leg(distance, unit.perp(&to_centre)).ok_or_else(too_short)?;
            let half = if *far { half } else { -half };
            Ok(start + unit * (unit.dot(&to_centre) + half))
        }
        PointRule::TwoDistances {
            centres,
            distances: [first, second],
            left,
        } => {
            let (start, way) = c.line(*centres)?;
            let unit = way.try_normalize(1e-12).ok_or_else(same_place)?;
            let first = c.measure(first, Want::Length)?;
            let second = c.measure(second, Want::Length)?;
            let between = way.norm();
            let along = (between * between + first * first - second * second) / (2.0 * between);
            let aside = leg(first, along).ok_or_else(apart)?;
            let aside = if *left { aside } else { -aside };
            Ok(start + unit * along + Vec2::new(-unit.y, unit.x) * aside)
        }
    }
}

/// The second leg of a right triangle (m). `None`: its hypotenuse is shorter than its first leg.
fn leg(hypotenuse: f64, first: f64) -> Option<f64> {
    let square = (hypotenuse - first) * (hypotenuse + first);
    // Where circle and line touch, rounding may leave a square just below zero.
    (square >= -1e-12 * hypotenuse * hypotenuse).then(|| square.max(0.0).sqrt())
}

fn too_short() -> Failure {
    Failure::new(
        Code::Formula,
        "the line is farther away than the distance",
        "make the distance longer",
    )
}

fn apart() -> Failure {
    Failure::new(
        Code::Formula,
        "no point has both distances",
        "choose distances whose circles meet",
    )
}

fn on_path(path: &Path, along: f64) -> Result<Vec2, Failure> {
    let place = path
        .at_length(along)
        .ok_or_else(|| Failure::new(Code::Formula, "the curve has no length", "draw it longer"))?;
    Ok(path.point(place))
}

fn chosen(points: &[Vec2], index: u16) -> Result<Vec2, Failure> {
    points.get(usize::from(index)).copied().ok_or_else(|| {
        let message = match points.len() {
            0 => "they do not cross".to_owned(),
            count => format!(
                "they cross {count} times, and crossing {} is asked for",
                index + 1
            ),
        };
        Failure::new(
            Code::Formula,
            message,
            "move them, or choose another crossing",
        )
    })
}

fn same_place() -> Failure {
    Failure::new(
        Code::Formula,
        "the two points it is constructed from are in the same place",
        "choose two points that are apart",
    )
}
