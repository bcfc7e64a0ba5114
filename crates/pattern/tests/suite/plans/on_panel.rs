//! Sheets that lie on stages of panels, and lines that are inserted from them.

use super::*;
use crate::sample::{dart, ends, formula, outline, put_operation, sample};

/// The sample's front with a dart in its hem that was pivoted to a side.
fn pivoted() -> (Pattern, PanelId, OperationId) {
    let mut pattern = sample();
    let panel = pattern.panels[0].id;
    let apex = Apex::Depth(0.1.into());
    let mut kind = dart(&pattern, "bottom", 0.5, 0.02, apex);
    if let OperationKind::Dart { intake, .. } = &mut kind {
        *intake = formula("bust / 30");
    }
    let dart = put_operation(&mut pattern, 0, "dart", kind);
    let wish = plan::PivotWish {
        dart,
        mouth: (
            Name::Drawn(outline(&pattern, "front")),
            Mark::between(ends(&pattern, "front", "right"), 0.5),
        ),
        share: 1.0.into(),
        back: 0.0.into(),
        turned: None,
    };
    let (edits, pivot) = plan::pivot_dart(&evaluated(&pattern), panel, wish).unwrap();
    (done(&pattern, &edits), panel, pivot)
}

fn opened(pattern: &mut Pattern, panel: PanelId) -> SheetId {
    let (edits, sheet) = plan::open_sheet(&evaluated(pattern), panel).unwrap();
    *pattern = done(pattern, &edits);
    sheet
}

fn marked(pattern: &mut Pattern, sheet: SheetId, line: LineName, at: Mark) -> PointId {
    let rule = PointRule::Mark { line, at };
    let (edits, id) = plan::add_point(&evaluated(pattern), sheet, None, rule).unwrap();
    *pattern = done(pattern, &edits);
    id
}

fn line(pattern: &mut Pattern, sheet: SheetId, ends: [PointId; 2]) -> CurveId {
    let shape = plan::CurveShape::Rule(CurveRule::Line);
    let (edits, curve) = plan::add_curve(&evaluated(pattern), (sheet, None), ends, shape).unwrap();
    *pattern = done(pattern, &edits);
    curve
}

fn insert(pattern: &mut Pattern, panel: PanelId, curve: CurveId) -> LineId {
    let kind = (LineKind::Internal, None);
    let chain = plan::Chain::Curves(&[curve]);
    let (edits, line) = plan::add_line(&evaluated(pattern), panel, kind, chain).unwrap();
    *pattern = done(pattern, &edits);
    line
}

fn made(by: OperationId, role: Role, index: u16) -> CornerName {
    Name::Made { by, role, index }
}

/// A line from the new dart's apex to the middle of a drawn edge, inserted after the pivot.
fn with_line() -> (Pattern, PanelId, OperationId, LineId) {
    let (mut pattern, panel, pivot) = pivoted();
    let outline = Name::Drawn(outline(&pattern, "front"));
    let sheet = opened(&mut pattern, panel);
    let apex = marked(
        &mut pattern,
        sheet,
        outline,
        Mark::Corner(made(pivot, Role::Apex, 0)),
    );
    let top = Mark::between(ends(&pattern, "front", "top"), 0.5);
    let top = marked(&mut pattern, sheet, outline, top);
    let curve = line(&mut pattern, sheet, [apex, top]);
    let inserted = insert(&mut pattern, panel, curve);
    (pattern, panel, pivot, inserted)
}

#[test]
fn a_line_drawn_after_a_pivot_is_inserted_there_in_every_size() {
    let (pattern, panel, pivot, inserted) = with_line();
    let owner = pattern.panel(panel).unwrap();
    let step = owner.operations.last().unwrap();
    assert_eq!(owner.step_of(pivot), Some(owner.operations.len() - 1));
    let sheet = step.kind.sheet().unwrap();
    assert_eq!(pattern.sheet(sheet).unwrap().on, Some((panel, Some(pivot))));
    for body in bodies() {
        let evaluation = Evaluation::new(&pattern, wearer(&pattern, &body));
        assert!(
            evaluation.diagnostics().is_empty(),
            "{:?}",
            evaluation.diagnostics()
        );
        let stage = evaluation.last_stage(owner).unwrap();
        let name = Name::Drawn(inserted);
        let found = stage.lines.iter().find(|line| line.name == name).unwrap();
        let apex = stage
            .darts
            .iter()
            .find(|dart| dart.by == pivot)
            .unwrap()
            .apex;
        assert!((found.edges[0].curve.start() - apex).norm() < 1e-9);
        // The stage before has no such line, nor has the panel as drawn.
        for before in [None, Some(pivot)] {
            let stage = evaluation.stage(panel, before).unwrap();
            assert!(stage.lines.iter().all(|line| line.name != name));
        }
        let piece = &evaluation.draft().0.pieces[0];
        assert!(
            piece
                .internal_lines
                .iter()
                .any(|line| line.name == Name::Drawn(inserted))
        );
    }
}

#[test]
fn a_pocket_hangs_on_a_leg_of_a_dart() {
    let (mut pattern, panel, pivot) = pivoted();
    let outline = Name::Drawn(outline(&pattern, "front"));
    let sheet = opened(&mut pattern, panel);
    let leg = [made(pivot, Role::Mouth, 0), made(pivot, Role::Apex, 0)];
    let half = Mark::Between {
        ends: leg,
        share: 0.5.into(),
    };
    let at = marked(&mut pattern, sheet, outline, half);
    let evaluation = evaluated(&pattern);
    let stage = evaluation.stage(panel, Some(pivot)).unwrap();
    let dart = stage.darts.iter().find(|dart| dart.by == pivot).unwrap();
    let middle = (dart.mouth[0] + dart.apex) * 0.5;
    assert!((evaluation.point(at).unwrap() - middle).norm() < 1e-9);
}

#[test]
fn a_style_line_after_a_pivot_splits_the_panel() {
    let (mut pattern, panel, _) = pivoted();
    let owner = pattern.panel(panel).unwrap().clone();
    let evaluation = evaluated(&pattern);
    let stage = evaluation.last_stage(&owner).unwrap().clone();
    let middle = |name: &str| {
        let id = Name::Drawn(owner.edge_named(name).unwrap().id);
        let edge = stage.outline().iter().find(|edge| edge.name == id).unwrap();
        edge.curve.point(0.4)
    };
    let places =
        ["left", "top"].map(|name| plan::nearest_mark(&evaluation, panel, middle(name)).unwrap());
    let (edits, curve) = plan::line_across(&evaluation, panel, places).unwrap();
    pattern = done(&pattern, &edits);
    let wish = plan::SplitWish {
        line: plan::outline_of(&evaluated(&pattern), panel).unwrap(),
        curve,
        joined: plan::Joined::Sewn,
    };
    let (edits, _) = plan::split_panel(&evaluated(&pattern), panel, wish).unwrap();
    pattern = done(&pattern, &edits);
    for body in bodies() {
        let evaluation = Evaluation::new(&pattern, wearer(&pattern, &body));
        assert!(
            evaluation.diagnostics().is_empty(),
            "{:?}",
            evaluation.diagnostics()
        );
    }
}

#[test]
fn lines_are_drawn_on_a_side_of_a_split() {
    let mut pattern = sample();
    let panel = pattern.panels[0].id;
    let evaluation = evaluated(&pattern);
    let at = |name: &str| {
        let edge = pattern.panels[0].edge_named(name).unwrap();
        let path = evaluation.edge(edge.id).unwrap();
        path.point(path.at_length(0.5 * path.length()).unwrap())
    };
    let places = ["left", "right"].map(|n| plan::nearest_mark(&evaluation, panel, at(n)).unwrap());
    let (edits, curve) = plan::line_across(&evaluation, panel, places).unwrap();
    pattern = done(&pattern, &edits);
    let wish = plan::SplitWish {
        line: Name::Drawn(outline(&pattern, "front")),
        curve,
        joined: plan::Joined::Sewn,
    };
    let (edits, found) = plan::split_panel(&evaluated(&pattern), panel, wish).unwrap();
    pattern = done(&pattern, &edits);
    let side = found.sides[0];
    let sheet = opened(&mut pattern, side);
    let corners: Vec<PointId> = pattern
        .sheet(sheet)
        .unwrap()
        .points
        .iter()
        .map(|p| p.id)
        .collect();
    assert_eq!(corners.len(), 4);
    let curve = line(&mut pattern, sheet, [corners[0], corners[2]]);
    let inserted = insert(&mut pattern, side, curve);
    let evaluation = evaluated(&pattern);
    assert!(
        evaluation.diagnostics().is_empty(),
        "{:?}",
        evaluation.diagnostics()
    );
    let stage = evaluation.last_stage(pattern.panel(side).unwrap()).unwrap();
    assert!(
        stage
            .lines
            .iter()
            .any(|line| line.name == Name::Drawn(inserted))
    );
}

#[test]
fn a_corner_that_an_operation_made_is_not_dragged() {
    let (pattern, _, pivot, inserted) = with_line();
    let owner = &pattern.panels[0];
    let [apex, top] = owner.line(inserted).unwrap().edges[0].ends;
    let evaluation = evaluated(&pattern);
    let error = plan::move_point(&evaluation, apex, v(0.1, 0.1)).unwrap_err();
    let number = format!("operation {}", owner.step_of(pivot).unwrap());
    assert!(error.to_string().contains(&number), "{error}");
    // A share of an edge is dragged along it.
    let now = evaluation.point(top).unwrap();
    let edits = plan::move_point(&evaluation, top, now + v(0.02, 0.05)).unwrap();
    let moved = evaluated(&done(&pattern, &edits)).point(top).unwrap();
    assert!(
        (moved - now - v(0.02, 0.0)).norm() < 1e-6,
        "{}",
        moved - now
    );
}

#[test]
fn what_was_inserted_waits_for_its_stage() {
    let (pattern, panel, pivot, inserted) = with_line();
    let before = evaluated(&pattern);
    let gone = plan::remove_operation(&before, (panel, pivot)).unwrap();
    let mut without = pattern.clone();
    without.apply(&gone).unwrap();
    let evaluation = evaluated(&without);
    assert!(!evaluation.diagnostics().is_empty());
    let owner = without.panel(panel).unwrap();
    assert!(owner.line(inserted).is_some());
    let stage = evaluation.last_stage(owner).unwrap();
    assert!(
        stage
            .lines
            .iter()
            .all(|line| line.name != Name::Drawn(inserted))
    );
    // The operation comes back, and the line with it.
    let mut follows = before.clone();
    follows.update(&without, before.wearer().clone());
    follows.update(&pattern, before.wearer().clone());
    assert!(follows.diagnostics().is_empty());
    let owner = pattern.panel(panel).unwrap();
    let (a, b) = (
        follows.last_stage(owner).unwrap(),
        before.last_stage(owner).unwrap(),
    );
    assert!(a.is_same(b));
    // Done before the pivot, its sheet does not lie there yet.
    let insert = owner.operations.last().unwrap().id;
    let error = plan::move_operation(&before, (panel, insert), 0).unwrap_err();
    assert!(
        error.to_string().contains("does not lie on the stage"),
        "{error}"
    );
}

#[test]
fn points_at_marks_follow_their_sheet_to_another_stage() {
    let (pattern, panel, pivot, inserted) = with_line();
    let [_, top] = pattern.panels[0].line(inserted).unwrap().edges[0].ends;
    let sheet = pattern.point(top).unwrap().0.clone();
    let put = |on| {
        Edit::Put(Entity::Sheet(SheetHead {
            id: sheet.id,
            name: sheet.name.clone(),
            on,
            on_table: sheet.on_table,
        }))
    };
    let mut evaluation = evaluated(&pattern);
    for on in [None, Some((panel, None)), Some((panel, Some(pivot)))] {
        let mut moved = pattern.clone();
        moved.apply(&[put(on)]).unwrap();
        evaluation.update(&moved, evaluation.wearer().clone());
        let fresh = evaluated(&moved);
        assert_eq!(evaluation.points(), fresh.points(), "{on:?}");
        assert_eq!(evaluation.diagnostics(), fresh.diagnostics(), "{on:?}");
    }
}
