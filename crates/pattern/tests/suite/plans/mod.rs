//! Planners: every wish is granted exactly, in every size, or refused by name.

mod construct;
mod copy;
mod formula_change;
mod grade;
mod idle;
mod kept;
mod notch;
mod numbers;
mod on_panel;
mod operations;
mod pleat;
mod remove;
mod rename;
mod reshape;
mod seam;
mod sequences;
mod sizes;
mod split;
mod trace;
mod transform;

use std::collections::HashSet;
use toile_geometry::Vec2;
use toile_measure::Measurements;
use toile_pattern::*;

/// Bodies of several sizes.
pub fn bodies() -> [Measurements; 4] {
    [
        Measurements::adult(),
        Measurements::adult_woman(),
        Measurements::adult_man(),
        Measurements::child(8),
    ]
}

/// The pattern for an adult.
pub fn evaluated(pattern: &Pattern) -> Evaluation {
    Evaluation::new(pattern, wearer(pattern, &Measurements::adult()))
}

/// Somebody of a body's measurements, in the size that has the same.
pub fn wearer(pattern: &Pattern, body: &Measurements) -> toile_pattern::Wearer {
    let size = pattern.sizes.iter().find(|size| size.measurements == *body);
    toile_pattern::Wearer {
        measurements: body.clone(),
        size: size.map(|size| size.id),
    }
}

/// The pattern after edits, which must survive JSON, keep ids and names unique, and leave what
/// they were planned from as it was.
pub fn done(pattern: &Pattern, edits: &[Edit]) -> Pattern {
    let text = serde_json::to_string(edits).unwrap();
    let read: Vec<Edit> = serde_json::from_str(&text).unwrap();
    assert_eq!(read, edits, "{text}");
    let before = pattern.clone();
    let mut after = pattern.clone();
    after.apply(edits).unwrap();
    assert_eq!(&before, pattern, "undo is the snapshot before");
    let mut again = before;
    again.apply(&read).unwrap();
    assert_eq!(again, after, "redo is the same");
    unique(&after);
    after
}

/// Ids and names are unique, each in its scope.
pub fn unique(pattern: &Pattern) {
    let ids: Vec<u32> = pattern.parts().iter().map(|(id, _)| id.number()).collect();
    assert_eq!(ids.len(), ids.iter().collect::<HashSet<_>>().len());
    assert!(ids.iter().all(|&id| id < pattern.ids.next));
    let all_differ = |what: &str, names: Vec<&str>| {
        let set: HashSet<&str> = names.iter().copied().collect();
        assert_eq!(set.len(), names.len(), "{what}: {names:?}");
        assert!(names.iter().all(|name| is_part_name(name)), "{names:?}");
    };
    let p = pattern;
    all_differ("sizes", p.sizes.iter().map(|s| &*s.name).collect());
    all_differ("variables", p.variables.iter().map(|v| &*v.name).collect());
    all_differ("sheets", p.sheets.iter().map(|s| &*s.name).collect());
    all_differ("panels", p.panels.iter().map(|s| &*s.name).collect());
    all_differ("seams", p.seams.iter().map(|s| &*s.name).collect());
    for sheet in &p.sheets {
        all_differ("points", sheet.points.iter().map(|x| &*x.name).collect());
        all_differ("curves", sheet.curves.iter().map(|x| &*x.name).collect());
    }
    for panel in &p.panels {
        all_differ("lines", panel.lines.iter().map(|x| &*x.name).collect());
        all_differ("edges", panel.edges().map(|x| &*x.name).collect());
        all_differ("notches", panel.notches.iter().map(|x| &*x.name).collect());
        let operations = panel.operations.iter();
        all_differ("operations", operations.map(|x| &*x.name).collect());
    }
}

/// What a refusal says.
pub fn refusal<T: std::fmt::Debug>(result: Result<T, EditError>) -> String {
    result.unwrap_err().to_string()
}

/// Asserts that two places are one, to 1e-9 m.
#[track_caller]
pub fn same_place(a: Vec2, b: Vec2) {
    assert!((a - b).norm() < 1e-9, "{a:?} is not {b:?}");
}

/// A place.
pub fn v(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

/// Places of points for a body.
pub fn places(pattern: &Pattern, body: &Measurements, points: &[PointId]) -> Vec<Vec2> {
    let evaluation = Evaluation::new(pattern, wearer(pattern, body));
    let place = |id: &PointId| evaluation.point(*id).unwrap();
    points.iter().map(place).collect()
}

/// Area that a panel's outline encloses, less its holes, for a body (m2).
pub fn area(pattern: &Pattern, body: &Measurements, panel: PanelId) -> f64 {
    let evaluation = Evaluation::new(pattern, wearer(pattern, body));
    let stage = evaluation.stage(panel, None).unwrap();
    let closed = stage.lines.iter().filter(|l| l.kind != LineKind::Internal);
    let edges = closed.flat_map(|line| &line.edges);
    edges.map(|e| e.curve.swept_area()).sum::<f64>() * 0.5
}

/// An empty pattern with one sheet.
pub fn blank() -> (Pattern, SheetId) {
    let pattern = Pattern::new("blank");
    let (edits, sheet) = plan::add_sheet(&evaluated(&pattern), None, [0.0, 0.0]).unwrap();
    (done(&pattern, &edits), sheet)
}

/// Adds a point and gives it.
pub fn dot(pattern: &mut Pattern, sheet: SheetId, rule: PointRule) -> PointId {
    let (edits, point) = plan::add_point(&evaluated(pattern), sheet, None, rule).unwrap();
    *pattern = done(pattern, &edits);
    point
}

/// Adds a straight line and gives it.
pub fn straight(pattern: &mut Pattern, sheet: SheetId, ends: [PointId; 2]) -> CurveId {
    let shape = plan::CurveShape::Rule(CurveRule::Line);
    let (edits, curve) = plan::add_curve(&evaluated(pattern), (sheet, None), ends, shape).unwrap();
    *pattern = done(pattern, &edits);
    curve
}
