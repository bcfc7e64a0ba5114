//! A large pattern made by rule: panels with curves, darts, notches and seams, and formulas that
//! measure one panel in another.

use std::f64::consts::TAU;
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_measure::Measurements;
use toile_pattern::{
    Apex, CurveRule, Edge, Fabric, Formula, FormulaError, LineKind, Mark, Name, Names, Notch,
    NotchKind, Number, Operation, OperationKind, PanelBuilder, PanelId, Pattern, PointId,
    PointRule, Pressed, Seam, Size,
};

/// Corners of an outline. Every second edge is straight, the others are curves with two handles.
const CORNERS: usize = 40;
/// Points of an internal line.
const INSIDE: usize = 10;
/// Points placed beside corners, two of them where darts end.
const BESIDE: usize = 10;
/// Points of a panel.
pub(crate) const POINTS: usize = 2 * CORNERS + INSIDE + BESIDE;
/// Every tenth point is measured in another panel, at the point half as far on.
const MEASURED: usize = 10;
/// Half the width and the height of a panel (m).
const REACH: Vec2 = Vec2::new(0.25, 0.35);
/// What the two darts take out of an edge (m).
const INTAKE: f64 = 0.006;

/// Where a point of the outline would lie without waves, by its share of the way round (m).
fn rim(share: f64) -> Vec2 {
    let (sin, cos) = (TAU * share).sin_cos();
    Vec2::new(REACH.x * cos, REACH.y * sin) * (1.0 + 0.08 * (3.0 * TAU * share).sin())
}

/// Sheet and panel of a number, and the panel's edges.
fn panel(pattern: &mut Pattern, number: usize) -> (PanelId, Vec<Edge>) {
    let fabric = pattern.fabrics[0].id;
    let mut ids = pattern.ids;
    let mut drawing = PanelBuilder::new(&mut ids, &format!("panel {number}"), fabric);
    let share = |k: usize, beyond: f64| (k as f64 + beyond) / CORNERS as f64;
    let at = |place: Vec2| PointRule::at(place.x, place.y);
    let mut names = (0..).map(|k| format!("p{k}"));
    let mut name = || names.next().unwrap_or_default();
    let corners: Vec<PointId> = (0..CORNERS)
        .map(|k| drawing.point(name(), at(rim(share(k, 0.0)))))
        .collect();
    let mut edges = Vec::new();
    for k in 0..CORNERS {
        let ends = [corners[k], corners[(k + 1) % CORNERS]];
        let rule = match k % 2 {
            0 => CurveRule::Line,
            _ => {
                let out = |beyond: f64| rim(share(k, beyond)) * 1.01;
                CurveRule::cubic([0.3, 0.7].map(|t| drawing.point(name(), at(out(t)))))
            }
        };
        edges.push(drawing.edge(format!("edge {k}"), ends, rule));
    }
    let outline = drawing.line("outline", LineKind::Outline, edges.clone());
    let inside: Vec<PointId> = (0..INSIDE)
        .map(|k| {
            let x = 0.2 * (k as f64 / (INSIDE - 1) as f64 - 0.5);
            drawing.point(name(), PointRule::at(x, 0.4 * x))
        })
        .collect();
    let stretches = inside.windows(2).enumerate();
    let crease = stretches
        .map(|(k, w)| drawing.edge(format!("crease {k}"), [w[0], w[1]], CurveRule::Line))
        .collect();
    drawing.line("crease", LineKind::Internal, crease);
    let beside: Vec<PointId> = (0..BESIDE)
        .map(|k| {
            let inward = rim(share(4 * k, 0.5)) * -0.25;
            let rule = PointRule::Offset {
                base: corners[4 * k],
                x: inward.x.into(),
                y: inward.y.into(),
            };
            drawing.point(name(), rule)
        })
        .collect();
    let operations: Vec<Arc<Operation>> = [2, 7]
        .map(|k| {
            let kind = OperationKind::Dart {
                line: Name::Drawn(outline),
                mouth: Mark::between(edges[4 * k].ends, 0.5),
                intake: INTAKE.into(),
                apex: Apex::Point(beside[k]),
                trued: false,
                keeps_length: false,
                pressed: Pressed::default(),
            };
            let (id, name) = (drawing.id(), format!("dart {k}"));
            Arc::new(Operation {
                id,
                name,
                kind,
                meant: false,
            })
        })
        .into();
    let notches: Vec<Notch> = [1, 11, 21, 31]
        .map(|k| Notch {
            id: drawing.id(),
            name: format!("notch {k}"),
            line: outline,
            at: Mark::between(edges[k].ends, 0.5),
            kind: NotchKind::V,
        })
        .into();
    let (sheet, mut panel) = drawing.done();
    let own = Arc::make_mut(&mut panel);
    own.operations = operations;
    own.notches = notches;
    own.allowance = 0.01.into();
    own.grain = 0.0.into();
    let id = panel.id;
    pattern.ids = ids;
    pattern.add((sheet, panel));
    (id, edges)
}

/// Has every tenth point of a panel measured where the next panels have a point half as far on.
fn measure(pattern: &mut Pattern, names: &Names) -> Result<(), FormulaError> {
    let count = pattern.sheets.len();
    for number in 0..count {
        for k in (MEASURED / 2..POINTS).step_by(MEASURED) {
            // Never the panel itself, and ten different ones.
            let other = (number + 1 + 7 * (k / MEASURED)) % count;
            let measured = k - MEASURED / 2;
            let (from, to) = (&pattern.sheets[other], &pattern.sheets[number]);
            let of = match &from.points[measured].rule {
                PointRule::At { x, .. } | PointRule::Offset { x, .. } => x.value(),
                _ => None,
            };
            // The point stays where it is while nothing is moved; one measurement moves all.
            let text = format!(
                "(x('{}'.'{}') - {}m) / 5 + (bust - 92cm) / 50",
                from.name,
                from.points[measured].name,
                of.unwrap_or_default()
            );
            let rule = match &to.points[k].rule {
                PointRule::At { x, y } => PointRule::At {
                    x: plus(&text, x, names)?,
                    y: y.clone(),
                },
                PointRule::Offset { base, x, y } => PointRule::Offset {
                    base: *base,
                    x: plus(&text, x, names)?,
                    y: y.clone(),
                },
                other => other.clone(),
            };
            let sheet = Arc::make_mut(&mut pattern.sheets[number]);
            Arc::make_mut(&mut sheet.points[k]).rule = rule;
        }
    }
    Ok(())
}

/// A formula with a value added to it (m).
fn plus(text: &str, value: &Number, names: &Names) -> Result<Number, FormulaError> {
    let formula = Formula::parse(text, names)?;
    let by = value.value().unwrap_or_default();
    Ok(Number::Adjusted { formula, by })
}

/// A pattern of so many panels of [`POINTS`] points each, every one sewn to the next.
///
/// # Errors
/// A formula of it cannot be read.
pub(crate) fn large_pattern(panels: usize) -> Result<Pattern, FormulaError> {
    let mut pattern = Pattern::new("large");
    let fabric = Fabric::poplin(pattern.ids.take());
    pattern.fabrics.push(Arc::new(fabric));
    let size = Size {
        id: pattern.ids.take(),
        name: "M".into(),
        measurements: Measurements::adult_woman(),
    };
    pattern.base_size = Some(size.id);
    pattern.sizes.push(Arc::new(size));
    let drawn: Vec<(PanelId, Vec<Edge>)> = (0..panels).map(|k| panel(&mut pattern, k)).collect();
    for k in 1..panels {
        let span = |(panel, edges): &(PanelId, Vec<Edge>), edge: usize| {
            let found = pattern.panel(*panel)?;
            found.span(edges[edge].id)
        };
        let one = span(&drawn[k - 1], 4);
        let other = span(&drawn[k], 24);
        if let [Some(one), Some(other)] = [one, other] {
            let sides = [vec![one], vec![other.reversed()]];
            let seam = Seam::new(pattern.ids.take(), format!("seam {k}"), sides);
            pattern.seams.push(Arc::new(seam));
        }
    }
    let names = Names::new(&pattern);
    measure(&mut pattern, &names)?;
    Ok(pattern)
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_pattern::{Evaluation, Severity};

    #[test]
    fn a_large_pattern_is_sound_and_a_tenth_of_its_points_is_measured_elsewhere() {
        let pattern = large_pattern(12).unwrap();
        let evaluation = Evaluation::new(&pattern, &Measurements::adult_woman());
        assert_eq!(evaluation.points().len(), 12 * POINTS);
        let faults = evaluation.diagnostics();
        assert!(
            faults.iter().all(|found| found.severity == Severity::Note),
            "{faults:?}"
        );
        let (draft, _) = evaluation.draft();
        assert_eq!(draft.pieces.len(), 12);
        for number in 0..12 {
            toile_cut::CutPiece::new(
                (&pattern, &draft),
                number,
                (None, &toile_cut::CutOptions::default()),
            )
            .unwrap();
        }
        let points = pattern.sheets.iter().flat_map(|sheet| &sheet.points);
        let numbers = points.flat_map(|point| toile_pattern::fields::numbers(&point.rule));
        let mut measured: Vec<_> = numbers
            .filter_map(Number::as_formula)
            .flat_map(Formula::references)
            .collect();
        measured.sort_unstable();
        measured.dedup();
        assert_eq!(measured.len(), 12 * POINTS / MEASURED);
    }
}
