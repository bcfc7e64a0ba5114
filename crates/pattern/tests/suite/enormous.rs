//! Enormous and hostile documents are evaluated, edited, checked and taken apart without a call
//! stack that grows with them.

use crate::sample::*;
use std::sync::Arc;
use std::time::Instant;
use toile_measure::Measurements;
use toile_pattern::*;

/// Points of the chain.
const COUNT: usize = 100_000;

fn told<T>(what: &str, run: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = run();
    println!("{what}: {:.2} s", start.elapsed().as_secs_f64());
    result
}

/// Points each of which lies beside the one before, by formulas as deep as they may be, that
/// measure the chain so far and a stretch of a panel.
fn chain(pattern: &mut Pattern) -> Vec<PointId> {
    let first: PointId = pattern.ids.take();
    let ids: Vec<PointId> = std::iter::once(first)
        .chain((1..COUNT).map(|_| pattern.ids.take()))
        .collect();
    let origin = PointRule::at(0.0, 0.0);
    let point = |k: usize, rule| {
        Arc::new(Point {
            id: ids[k],
            name: format!("c{k}"),
            rule,
        })
    };
    let sheet = Arc::make_mut(&mut pattern.sheets[0]);
    sheet.points.push(point(0, origin));
    for k in 1..COUNT {
        let base = ids[k - 1];
        let rule = PointRule::Offset {
            base,
            x: 1e-6.into(),
            y: Number::ZERO,
        };
        sheet.points.push(point(k, rule));
    }
    let names = Names::new(pattern);
    let deep = (FORMULA_DEPTH - 2) / 2;
    let sheet = Arc::make_mut(&mut pattern.sheets[0]);
    for k in 1..COUNT {
        let text = format!(
            "{}y(front.c{}) + length(front.right) * 0{} + nothing * 0 * {}",
            "-(".repeat(deep),
            k - 1,
            ")".repeat(deep),
            k % 2,
        );
        let text = if k % 100 == 0 {
            text
        } else {
            text.replace("nothing", "bust")
        };
        let formula = Formula::parse(&text, &names).unwrap();
        let place = sheet.points.len() - COUNT + k;
        if let PointRule::Offset { y, .. } = &mut Arc::make_mut(&mut sheet.points[place]).rule {
            *y = Number::Formula(formula);
        }
    }
    ids
}

#[test]
fn a_chain_of_a_hundred_thousand_points_is_evaluated() {
    let mut pattern = sample();
    let ids = told("making", || chain(&mut pattern));
    let body = Measurements::adult();
    let mut evaluation = told("evaluating", || Evaluation::new(&pattern, &body));
    // One in a hundred names what is not there, so the chain ends at the first of them.
    assert!(evaluation.point(ids[99]).is_some() && evaluation.point(ids[100]).is_none());
    put_variable(&mut pattern, "nothing", formula("1m"));
    let update = told("finding what was named", || {
        evaluation.update(&pattern, &body)
    });
    assert!(update.changed >= COUNT - 100, "{update:?}");
    let last = evaluation.point(ids[COUNT - 1]).unwrap();
    assert!(
        (last.x - 1e-6 * (COUNT - 1) as f64).abs() < 1e-6 && last.y == 0.0,
        "{last}"
    );
    let head = pattern.sheets[0].id;
    let moved = |id: PointId, at: f64| {
        let name = "moved".into();
        let rule = PointRule::at(at, 0.0);
        Edit::Put(Entity::Point(head, Arc::new(Point { id, name, rule })))
    };
    told("applying an edit", || pattern.apply(&[moved(ids[0], 0.5)])).unwrap();
    told("moving the first", || evaluation.update(&pattern, &body));
    let last = evaluation.point(ids[COUNT - 1]).unwrap();
    assert!(
        (last.x - 0.5 - 1e-6 * (COUNT - 1) as f64).abs() < 1e-6,
        "{last}"
    );
    let ring = PointRule::Offset {
        base: ids[COUNT - 1],
        x: 0.1.into(),
        y: Number::ZERO,
    };
    let name = "closed".into();
    let closed = Arc::new(Point {
        id: ids[0],
        name,
        rule: ring,
    });
    pattern
        .apply(&[Edit::Put(Entity::Point(head, closed))])
        .unwrap();
    told("closing the ring", || evaluation.update(&pattern, &body));
    let cycles = evaluation.diagnostics();
    let [cycle] = &*cycles else {
        panic!("one finding: {}", cycles.len());
    };
    assert_eq!(
        (cycle.code, &cycle.place),
        (Code::Cycle, &Place::Point(ids[0]))
    );
    let edits: Vec<Edit> = ids.iter().step_by(100).map(|id| moved(*id, 0.1)).collect();
    told("applying a thousand edits", || pattern.apply(&edits)).unwrap();
    told("moving a thousand", || evaluation.update(&pattern, &body));
    assert!(evaluation.point(ids[COUNT - 1]).is_some());
    told("checking", || evaluation.check());
    told("dropping", move || drop(evaluation));
}
