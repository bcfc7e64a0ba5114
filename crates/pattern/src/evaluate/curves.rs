//! Computes curves, and the spans of them that panels follow.

use super::node::{Definition, Node};
use super::numbers::Computation;
use crate::Want;
use crate::formula::Failure;
use crate::{Code, Curve, CurveRule, Edge, Knot, Panel, Place, PointId, PointRule};
use std::sync::Arc;
use toile_geometry::{Curve as Piece, Path, Vec2};

/// Largest distance from a curve at which a point counts as on it (m).
const ON_CURVE: f64 = 1e-6;
/// Greatest factor by which the handles of a spline are scaled to reach its length (1).
const MAX_SCALE: f64 = 16.0;

/// The pieces of a curve, as one path (m).
pub(super) fn curve(c: &mut Computation<'_>, curve: &Arc<Curve>) -> Option<Arc<Path>> {
    let result = pieces(c, curve).map(|pieces| Arc::new(Path::new(pieces)));
    if result.is_ok() {
        return result.ok();
    }
    let what = curve_words(c, curve);
    c.reported(result, &Place::Curve(curve.id), &what)
}

fn curve_words(c: &Computation<'_>, curve: &Curve) -> String {
    match c.evaluation.names.sheet_of_curve(curve.id) {
        Some(sheet) => format!("sheet {sheet:?}, curve {:?}", curve.name),
        None => format!("curve {:?}", curve.name),
    }
}

fn pieces(c: &mut Computation<'_>, curve: &Curve) -> Result<Vec<Piece>, Failure> {
    let start = c.point_at(curve.ends[0])?;
    let end = c.point_at(curve.ends[1])?;
    match &curve.rule {
        CurveRule::Line => Ok(vec![Piece::Line { start, end }]),
        CurveRule::Arc { bulge } => Ok(vec![Piece::Arc {
            start,
            end,
            bulge: c.measure(bulge, Want::Plain)?,
        }]),
        CurveRule::Spline {
            handles,
            knots,
            to_length,
        } => {
            let spline = Spline::new(c, [start, end], *handles, knots)?;
            match to_length {
                None => Ok(spline.scaled(1.0)),
                Some(length) => {
                    let length = c.measure(length, Want::Length)?;
                    spline.to_length(length)
                }
            }
        }
        CurveRule::Mirrored { of, line } => {
            let on_line = c.point_at(line[0])?;
            let way = c.point_at(line[1])? - on_line;
            if way.norm() <= 1e-12 {
                return Err(Failure::new(
                    Code::Formula,
                    "the mirror has no direction",
                    "choose two points that are apart",
                ));
            }
            let path = c.path(Node::Curve(*of))?;
            Ok(path
                .curves()
                .iter()
                .map(|p| p.reflected(on_line, way))
                .collect())
        }
        CurveRule::Copy { of } => copied(c.path(Node::Curve(*of))?, [start, end]),
    }
}

/// A curve turned and scaled so that it leads from `start` to `end`.
fn copied(path: &Path, [start, end]: [Vec2; 2]) -> Result<Vec<Piece>, Failure> {
    let (Some(first), Some(last)) = (path.curves().first(), path.curves().last()) else {
        return Ok(Vec::new());
    };
    let (from, way) = (first.start(), last.end() - first.start());
    let scale = (end - start).norm() / way.norm();
    if !(scale.is_finite() && scale > 0.0) {
        return Err(Failure::new(
            Code::Formula,
            "the copied curve or its copy begins where it ends",
            "choose ends that are apart",
        ));
    }
    let goal = end - start;
    let angle = way.perp(&goal).atan2(way.dot(&goal));
    let placed = path.curves().iter().map(|piece| {
        let home = piece.translated(-from).rotated(angle).scaled(scale);
        home.translated(start)
    });
    Ok(placed.collect())
}

/// A spline: its points, and the handles of the pieces between them (m).
struct Spline {
    points: Vec<Vec2>,
    /// Handles at the start and the end of each piece, as vectors from these points (m).
    handles: Vec<[Vec2; 2]>,
}

impl Spline {
    fn new(
        c: &Computation<'_>,
        [start, end]: [Vec2; 2],
        [first, last]: [PointId; 2],
        knots: &[Knot],
    ) -> Result<Self, Failure> {
        let mut points = vec![start];
        let mut after = vec![c.point_at(first)? - start];
        let mut before = Vec::new();
        for knot in knots {
            let point = c.point_at(knot.point)?;
            before.push(c.point_at(knot.before)? - point);
            after.push(c.point_at(knot.after)? - point);
            points.push(point);
        }
        before.push(c.point_at(last)? - end);
        points.push(end);
        let handles = after.into_iter().zip(before).map(|(a, b)| [a, b]).collect();
        Ok(Self { points, handles })
    }

    /// The pieces of the spline, with all handles scaled by the factor `scale`.
    fn scaled(&self, scale: f64) -> Vec<Piece> {
        let ends = self.points.windows(2);
        let pieces = ends.zip(&self.handles).map(|(ends, handles)| Piece::Cubic {
            start: ends[0],
            controls: [ends[0] + handles[0] * scale, ends[1] + handles[1] * scale],
            end: ends[1],
        });
        pieces.collect()
    }

    /// The pieces of the spline, with all handles scaled so that the spline has the wanted length, by
    /// bisection.
    fn to_length(&self, length: f64) -> Result<Vec<Piece>, Failure> {
        let excess = |scale: f64| -> f64 {
            self.scaled(scale).iter().map(Piece::length).sum::<f64>() - length
        };
        let (mut low, mut high) = (0.0, MAX_SCALE);
        if excess(low) > 0.0 || excess(high) < 0.0 {
            let shortest = excess(low) + length;
            let longest = excess(high) + length;
            return Err(Failure::new(
                Code::OutOfReach,
                format!(
                    "it is to be {:.1} cm long; scaling its handles reaches {:.1} to {:.1} cm",
                    length * 100.0,
                    shortest * 100.0,
                    longest * 100.0
                ),
                "move its ends or handles, or ask for another length",
            ));
        }
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if excess(middle) > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        Ok(self.scaled(0.5 * (low + high)))
    }
}

/// The stretch of a curve that an edge follows (m).
pub(super) fn edge(c: &mut Computation<'_>, panel: &Panel, edge: &Edge) -> Option<Arc<Path>> {
    let result = stretch(c, edge);
    if result.is_ok() {
        return result.ok();
    }
    let what = format!("panel {:?}, edge {:?}", panel.name, edge.name);
    c.reported(result, &Place::Edge(panel.id, edge.id), &what)
}

fn stretch(c: &mut Computation<'_>, edge: &Edge) -> Result<Arc<Path>, Failure> {
    let path = c.path(Node::Curve(edge.curve))?.clone();
    let ends = match c.definition(Node::Curve(edge.curve)) {
        Some(Definition::Curve(curve)) => Some(curve.ends),
        _ => None,
    };
    if ends == Some(edge.ends) {
        return Ok(path);
    }
    if ends == Some([edge.ends[1], edge.ends[0]]) {
        return Ok(Arc::new(path.reversed()));
    }
    let from = along(c, &path, edge, ends, edge.ends[0])?;
    let to = along(c, &path, edge, ends, edge.ends[1])?;
    Ok(Arc::new(path.between(from, to)))
}

/// Arc length from the start of a curve to a point on it (m).
fn along(
    c: &mut Computation<'_>,
    path: &Path,
    edge: &Edge,
    ends: Option<[PointId; 2]>,
    point: PointId,
) -> Result<f64, Failure> {
    if let Some(k) = ends.and_then(|ends| ends.iter().position(|&end| end == point)) {
        return Ok(if k == 0 { 0.0 } else { path.length() });
    }
    let point_of = |c: &Computation<'_>| match c.definition(Node::Point(point)) {
        Some(Definition::Point(point)) => Some(point.clone()),
        _ => None,
    };
    let found = point_of(c);
    match found.as_ref().map(|point| point.rule.clone()) {
        Some(PointRule::OnCurve { curve, share }) if curve == edge.curve => {
            return Ok(path.length() * c.measure(&share, Want::Plain)?);
        }
        Some(PointRule::AlongCurve { curve, distance }) if curve == edge.curve => {
            let distance = c.measure(&distance, Want::Length)?;
            return Ok(if distance < 0.0 { path.length() } else { 0.0 } + distance);
        }
        _ => {}
    }
    let at = c.point_at(point)?;
    let nearest = path.nearest(at);
    let near = nearest.filter(|&place| (path.point(place) - at).norm() <= ON_CURVE);
    near.map(|place| place.along).ok_or_else(|| {
        let name = found.map_or_else(String::new, |point| point.name.clone());
        Failure::new(
            Code::MissingReference,
            format!("its end {name:?} is not on its curve"),
            "put the point on the curve, or trace another curve",
        )
    })
}
