//! Chains of stretches of curves, from which the lines of panels are traced.

use super::impossible;
use super::lookup::{self, place};
use crate::{
    Curve, CurveId, Edge, EdgeCorner, EditError, Evaluation, Ids, LineKind, Panel, Pattern, Point,
    PointId, PointRule, Sheet, SheetId, Want,
};
use std::sync::Arc;
use toile_geometry::Path;

/// Largest distance from a curve at which a point counts as on it (m); equal to the limit in evaluation.
pub(super) const ON_CURVE: f64 = 1e-6;

/// The points or curves that a line of a panel is traced from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Chain<'a> {
    /// Corners in order. Between two corners the line follows the only curve that both lie on.
    Points(&'a [PointId]),
    /// Whole curves in order. Each shares an end with the next.
    Curves(&'a [CurveId]),
}

impl Chain<'_> {
    /// The sheet of the first point or curve.
    pub(super) fn sheet<'p>(&self, pattern: &'p Pattern) -> Option<&'p Arc<Sheet>> {
        Some(match self {
            Self::Points(points) => pattern.point(*points.first()?)?.0,
            Self::Curves(curves) => pattern.curve(*curves.first()?)?.0,
        })
    }
}

/// A stretch of a curve between two points on it.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    pub curve: CurveId,
    pub ends: [PointId; 2],
    /// The path of the stretch, from its first end to its second (m).
    pub path: Arc<Path>,
    /// Whether the stretch runs against its curve.
    pub is_reversed: bool,
}

impl Stretch {
    fn reversed(&self) -> Self {
        Self {
            curve: self.curve,
            ends: [self.ends[1], self.ends[0]],
            path: Arc::new(self.path.reversed()),
            is_reversed: !self.is_reversed,
        }
    }
}

/// Arc length from the start of a curve to a point (m). `None`: the point is not on the curve.
pub(super) fn along(
    evaluation: &Evaluation,
    curve: &Curve,
    path: &Path,
    point: &Point,
) -> Option<f64> {
    if let Some(k) = curve.ends.iter().position(|&end| end == point.id) {
        return Some(if k == 0 { 0.0 } else { path.length() });
    }
    if let PointRule::OnCurve { curve: on, share } = &point.rule
        && *on == curve.id
    {
        return Some(path.length() * evaluation.number(share, Want::Plain)?);
    }
    if let PointRule::AlongCurve {
        curve: on,
        distance,
    } = &point.rule
        && *on == curve.id
    {
        let distance = evaluation.number(distance, Want::Length)?;
        return Some(if distance < 0.0 { path.length() } else { 0.0 } + distance);
    }
    let at = evaluation.point(point.id)?;
    let nearest = path.nearest(at)?;
    ((path.point(nearest) - at).norm() <= ON_CURVE).then_some(nearest.along)
}

/// The stretches of a chain. The chain must be closed unless it is for an internal line.
pub(super) fn stretches(
    evaluation: &Evaluation,
    sheet: SheetId,
    chain: Chain<'_>,
    kind: LineKind,
) -> Result<Vec<Stretch>, EditError> {
    let sheet = lookup::sheet(evaluation.pattern(), sheet)?;
    let is_closed = kind != LineKind::Internal;
    match chain {
        Chain::Points(points) => through(evaluation, sheet, points, is_closed),
        Chain::Curves(curves) => joined(evaluation, sheet, curves, is_closed),
    }
}

fn point_name(sheet: &Sheet, id: PointId) -> String {
    let name = sheet.point(id).map(|point| format!("{:?}", point.name));
    name.unwrap_or_else(|| id.to_string())
}

fn through(
    evaluation: &Evaluation,
    sheet: &Sheet,
    points: &[PointId],
    is_closed: bool,
) -> Result<Vec<Stretch>, EditError> {
    for (k, &id) in points.iter().enumerate() {
        let on_sheet = sheet.point(id).is_some();
        if !on_sheet {
            return Err(EditError::Missing(format!(
                "{id} on sheet {:?}",
                sheet.name
            )));
        }
        place(evaluation, id)?;
        let again = points[..k].contains(&id);
        let is_end = !is_closed && k + 1 == points.len() && points[0] == id && k > 1;
        if again && !is_end {
            return Err(impossible(
                format!("the line comes to point {} twice", point_name(sheet, id)),
                "go through every point once; a closed line ends by itself where it began",
            ));
        }
    }
    if points.len() < 2 {
        return Err(impossible(
            "the line has fewer than two points",
            "choose its corners in order",
        ));
    }
    let count = points.len() - usize::from(!is_closed);
    (0..count)
        .map(|k| {
            between(
                evaluation,
                sheet,
                [points[k], points[(k + 1) % points.len()]],
            )
        })
        .collect()
}

/// The stretch between two points on the only curve that both lie on.
fn between(
    evaluation: &Evaluation,
    sheet: &Sheet,
    ends: [PointId; 2],
) -> Result<Stretch, EditError> {
    let names = || ends.map(|end| point_name(sheet, end));
    let mut found: Vec<(&Curve, &Arc<Path>, [f64; 2])> = Vec::new();
    for curve in &sheet.curves {
        let Some(path) = evaluation.curve(curve.id) else {
            continue;
        };
        let along = ends.map(|end| along(evaluation, curve, path, sheet.point(end)?));
        if let [Some(from), Some(to)] = along
            && (from - to).abs() > ON_CURVE
        {
            found.push((curve, path, [from, to]));
        }
    }
    let whole = |curve: &Curve| curve.ends == ends || curve.ends == [ends[1], ends[0]];
    if found.iter().filter(|f| whole(f.0)).count() == 1 {
        found.retain(|f| whole(f.0));
    }
    let [from, to] = names();
    match found.as_slice() {
        [] => Err(impossible(
            format!("no curve leads from point {from} to point {to}"),
            "draw one between them, or choose the points between them too",
        )),
        [(curve, path, [start, end])] => Ok(Stretch {
            curve: curve.id,
            ends,
            path: Arc::new(path.between(*start, *end)),
            is_reversed: start > end,
        }),
        [(one, ..), (other, ..), ..] => Err(impossible(
            format!(
                "curves {:?} and {:?} both lead from point {from} to point {to}",
                one.name, other.name
            ),
            "choose the curves of the line instead of its points",
        )),
    }
}

fn joined(
    evaluation: &Evaluation,
    sheet: &Sheet,
    curves: &[CurveId],
    is_closed: bool,
) -> Result<Vec<Stretch>, EditError> {
    let mut whole: Vec<(&Curve, Stretch)> = Vec::new();
    for (k, &id) in curves.iter().enumerate() {
        let found = sheet.curve(id);
        let curve =
            found.ok_or_else(|| EditError::Missing(format!("{id} on sheet {:?}", sheet.name)))?;
        if curves[..k].contains(&id) {
            return Err(impossible(
                format!("curve {:?} is in the line twice", curve.name),
                "choose every curve once",
            ));
        }
        let stretch = Stretch {
            curve: id,
            ends: curve.ends,
            path: lookup::path(evaluation, id)?.clone(),
            is_reversed: false,
        };
        whole.push((curve, stretch));
    }
    let Some((first, _)) = whole.first() else {
        return Err(impossible(
            "the line has no curves",
            "choose its curves in order",
        ));
    };
    let starts_backwards = whole.get(1).is_some_and(|(second, _)| {
        !second.ends.contains(&first.ends[1]) && second.ends.contains(&first.ends[0])
    });
    let mut walked: Vec<Stretch> = Vec::new();
    for (k, (curve, stretch)) in whole.iter().enumerate() {
        let backwards = match walked.last() {
            None => starts_backwards,
            Some(before) if before.ends[1] == curve.ends[0] => false,
            Some(before) if before.ends[1] == curve.ends[1] => true,
            Some(_) => return Err(apart(whole[k - 1].0, curve)),
        };
        walked.push(match backwards {
            true => stretch.reversed(),
            false => stretch.clone(),
        });
    }
    let ends = walked.first().zip(walked.last());
    let returns = ends.is_some_and(|(first, last)| last.ends[1] == first.ends[0]);
    match is_closed && !returns {
        true => Err(apart(whole[whole.len() - 1].0, first)),
        false => Ok(walked),
    }
}

fn apart(one: &Curve, other: &Curve) -> EditError {
    impossible(
        format!(
            "curves {:?} and {:?} share no end where the line goes on",
            one.name, other.name
        ),
        "choose curves that follow each other, or choose points on them",
    )
}

/// Twice the signed area that the stretches sweep, seen from the origin (m2).
pub(super) fn swept(stretches: &[Stretch]) -> f64 {
    let curves = stretches.iter().flat_map(|s| s.path.curves());
    curves.map(|curve| curve.swept_area()).sum()
}

/// The stretches, reversed if necessary so that they run as this kind of line must: an outline
/// counter-clockwise, a hole clockwise.
pub(super) fn wound(stretches: Vec<Stretch>, kind: LineKind) -> Result<Vec<Stretch>, EditError> {
    let area = swept(&stretches);
    let wanted = match kind {
        LineKind::Outline => 1.0,
        LineKind::Hole => -1.0,
        LineKind::Internal => return Ok(stretches),
    };
    if area.abs() < 1e-12 {
        return Err(impossible(
            "the line encloses nothing",
            "choose corners or curves that go round something",
        ));
    }
    Ok(match area * wanted > 0.0 {
        true => stretches,
        false => stretches.iter().rev().map(Stretch::reversed).collect(),
    })
}

/// Edges that follow stretches, each named after its curve.
///
/// # Errors
/// A stretch runs all round a closed curve, against its direction: both ends are the same point, so the edge
/// could not show its direction.
pub(super) fn edges(
    sheet: &Sheet,
    stretches: &[Stretch],
    panel: &Panel,
    ids: &mut Ids,
) -> Result<Vec<Edge>, EditError> {
    let mut edges: Vec<Edge> = Vec::new();
    for stretch in stretches {
        let curve = sheet.curve(stretch.curve);
        let wanted = curve.map_or("edge", |curve| &curve.name);
        if stretch.ends[0] == stretch.ends[1] && stretch.is_reversed {
            return Err(impossible(
                format!("the closed curve {wanted:?} runs the wrong way round for this line"),
                "draw it the other way round: outlines run counter-clockwise, holes clockwise",
            ));
        }
        let name = super::names::free_name(wanted, |name| {
            let own = edges.iter().chain(panel.edges());
            own.into_iter().any(|edge| edge.name == name)
        });
        edges.push(Edge {
            id: ids.take(),
            name,
            curve: stretch.curve,
            ends: stretch.ends,
            allowance: None,
            corner: EdgeCorner::default(),
        });
    }
    Ok(edges)
}
