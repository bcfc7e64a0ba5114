//! Points that formulas place are moved, and what becomes of the formulas is chosen.

use super::*;
use crate::sample::{formula_in, put_variable};
use toile_pattern::plan::FormulaChange;

/// A point at formulas of two variables, a body measurement and a nonlinear use of a variable; and
/// the variables.
fn formulas() -> (Pattern, PointId, [VariableId; 2]) {
    let (mut pattern, sheet) = blank();
    let (edits, _) =
        plan::add_size(&evaluated(&pattern), Some("M"), Measurements::adult()).unwrap();
    pattern = done(&pattern, &edits);
    let (edits, _) =
        plan::add_size(&evaluated(&pattern), Some("C"), Measurements::child(8)).unwrap();
    pattern = done(&pattern, &edits);
    let width = formula_in(&pattern, "10cm");
    let width = put_variable(&mut pattern, "width", width);
    let rise = formula_in(&pattern, "bust / 10");
    let rise = put_variable(&mut pattern, "rise", rise);
    let rule = PointRule::At {
        x: formula_in(&pattern, "bust / 4 + width * 2"),
        y: formula_in(&pattern, "hypot(rise, 2cm) - width / 5"),
    };
    let point = dot(&mut pattern, sheet, rule);
    (pattern, point, [width, rise])
}

fn moved(pattern: &Pattern, point: PointId, way: Vec2, change: FormulaChange) -> Pattern {
    let evaluation = evaluated(pattern);
    let to = evaluation.point(point).unwrap() + way;
    let edits = plan::move_point_by(&evaluation, point, to, change).unwrap();
    let after = done(pattern, &edits);
    same_place(evaluated(&after).point(point).unwrap(), to);
    after
}

fn rule(pattern: &Pattern, point: PointId) -> PointRule {
    pattern.point(point).unwrap().1.rule.clone()
}

#[test]
fn adjusting_adds_to_the_formulas_in_every_size() {
    let (pattern, point, _) = formulas();
    let way = v(0.03, -0.02);
    let after = moved(&pattern, point, way, FormulaChange::Adjust);
    for body in bodies() {
        let [before, now] = [&pattern, &after].map(|of| places(of, &body, &[point])[0]);
        same_place(now, before + way);
    }
}

#[test]
fn changing_the_variable_keeps_the_formulas() {
    let (pattern, point, [width, rise]) = formulas();
    let after = moved(&pattern, point, v(0.03, 0.015), FormulaChange::Variable);
    assert_eq!(rule(&after, point), rule(&pattern, point));
    let number = |of: &Pattern, id| {
        let mut variables = of.variables.iter();
        variables
            .find(|known| known.id == id)
            .unwrap()
            .number
            .clone()
    };
    // A variable that is a formula keeps it and gets something added.
    assert!(matches!(number(&after, width), Number::Adjusted { .. }));
    assert!(matches!(number(&after, rise), Number::Adjusted { .. }));
}

#[test]
fn one_size_alone_moves_and_the_others_stay() {
    let (pattern, point, _) = formulas();
    let way = v(0.03, -0.02);
    let after = moved(&pattern, point, way, FormulaChange::ThisSize);
    let child = Measurements::child(8);
    let [before, now] = [&pattern, &after].map(|of| places(of, &child, &[point])[0]);
    same_place(now, before);
    // Again in the same size: its value is replaced.
    let again = moved(&after, point, way, FormulaChange::ThisSize);
    let PointRule::At {
        x: Number::PerSize { sizes, .. },
        ..
    } = rule(&again, point)
    else {
        panic!("{:?}", rule(&again, point));
    };
    assert_eq!(sizes.len(), 1);
}

#[test]
fn detaching_leaves_numbers_alone() {
    let (pattern, point, _) = formulas();
    let after = moved(&pattern, point, v(0.03, 0.0), FormulaChange::Detach);
    let PointRule::At { x, y } = rule(&after, point) else {
        panic!("{:?}", rule(&after, point));
    };
    assert!(matches!(x, Number::Value(_)));
    // What did not change keeps its formula.
    assert!(matches!(y, Number::Formula(_)), "{y:?}");
}

#[test]
fn what_no_variable_can_do_is_refused() {
    let (mut pattern, sheet) = blank();
    let rule = PointRule::At {
        x: formula_in(&pattern, "bust / 4"),
        y: 0.0.into(),
    };
    let point = dot(&mut pattern, sheet, rule);
    let evaluation = evaluated(&pattern);
    let to = evaluation.point(point).unwrap() + v(0.1, 0.0);
    let words = |change| refusal(plan::move_point_by(&evaluation, point, to, change));
    assert!(words(FormulaChange::Variable).contains("no variable"));
    assert!(words(FormulaChange::ThisSize).contains("no size"));
    let nowhere = v(f64::NAN, 0.0);
    let result = plan::move_point_by(&evaluation, point, nowhere, FormulaChange::Detach);
    assert!(refusal(result).contains("finite"));
}

#[test]
fn of_two_numbers_each_changes_a_variable_of_its_own() {
    let (mut pattern, sheet) = blank();
    let only = formula_in(&pattern, "10cm");
    put_variable(&mut pattern, "only", only);
    let rule = PointRule::At {
        x: formula_in(&pattern, "only"),
        y: formula_in(&pattern, "only / 2"),
    };
    let point = dot(&mut pattern, sheet, rule);
    let evaluation = evaluated(&pattern);
    let to = evaluation.point(point).unwrap() + v(0.1, 0.1);
    let result = plan::move_point_by(&evaluation, point, to, FormulaChange::Variable);
    assert!(refusal(result).contains("no variable"));
}
