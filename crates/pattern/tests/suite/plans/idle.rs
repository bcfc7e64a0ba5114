//! Operations that take in nothing: in a size without a need for them they leave their panel as it was.

use super::*;
use crate::sample::{self, dart, ends, formula, outline, put_operation, put_point, sample};
use std::sync::Arc;

/// An operation on the front that takes in so much, and one after it that is placed by it.
type Case = (&'static str, fn(&mut Pattern, Number) -> OperationId);

fn with_dart(pattern: &mut Pattern, intake: Number) -> OperationId {
    let mut kind = dart(pattern, "top", 0.25, 0.02, Apex::Depth(0.1.into()));
    if let OperationKind::Dart { intake: own, .. } = &mut kind {
        *own = intake;
    }
    put_operation(pattern, 0, "own", kind)
}

fn with_diamond(pattern: &mut Pattern, intake: Number) -> OperationId {
    let a = put_point(pattern, 0, "a", PointRule::at(0.2, 0.2));
    let b = put_point(pattern, 0, "b", PointRule::at(0.2, 0.4));
    let kind = OperationKind::Diamond {
        ends: [a, b],
        widest: 0.5.into(),
        intake,
    };
    put_operation(pattern, 0, "own", kind)
}

fn with_pleats(pattern: &mut Pattern, (kind, depth): (PleatKind, Number)) -> OperationId {
    let panel = pattern.panels[0].id;
    let edges = ["bottom", "top"].map(|name| sample::edge(pattern, "front", name));
    let (line, lines) = plan::even_cuts(&evaluated(pattern), panel, edges, 2).unwrap();
    let wish = plan::PleatWish {
        line,
        lines,
        depth: 0.02.into(),
        kind,
        pressed: Side::Left,
        held: None,
    };
    let (edits, id) = plan::pleat_panel(&evaluated(pattern), panel, wish).unwrap();
    *pattern = done(pattern, &edits);
    sample::alter(pattern, 0, |panel| {
        let made = panel.operations.iter_mut().find(|o| o.id == id).unwrap();
        if let OperationKind::Pleat { depth: own, .. } = &mut Arc::make_mut(made).kind {
            *own = depth;
        }
    });
    id
}

const CASES: [Case; 4] = [
    ("dart", with_dart),
    ("diamond", with_diamond),
    ("knife pleat", |pattern, depth| {
        with_pleats(pattern, (PleatKind::Knife, depth))
    }),
    ("box pleat", |pattern, depth| {
        with_pleats(pattern, (PleatKind::Box, depth))
    }),
];

fn area(stage: &Stage) -> f64 {
    let swept = stage
        .lines
        .iter()
        .filter(|line| line.kind != LineKind::Internal)
        .flat_map(|line| &line.edges)
        .map(|edge| edge.curve.swept_area());
    0.5 * swept.sum::<f64>()
}

#[test]
fn what_takes_in_nothing_leaves_its_panel_as_it_was() {
    // Differences of equal lengths leave a rounding error of either sign.
    for nothing in [0.0, 1e-17, -1e-17] {
        for (name, put) in CASES {
            let plain = sample();
            let mut pattern = plain.clone();
            let id = put(&mut pattern, nothing.into());
            let evaluation = evaluated(&pattern);
            let notes = evaluation.check();
            let found: Vec<Code> = notes.iter().map(|note| note.code).collect();
            assert_eq!(found, [Code::NoEffect], "{name}: {notes:?}");
            assert_eq!(notes[0].severity, Severity::Note);
            let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
            assert_eq!(stage.idle, [id], "{name}");
            assert!(stage.darts.is_empty());
            let before = evaluated(&plain);
            let before = before.last_stage(&plain.panels[0]).unwrap();
            assert!((area(stage) - area(before)).abs() < 1e-12, "{name}");
            assert_eq!(stage.lines.len(), before.lines.len(), "{name}");
            for edge in before.outline() {
                let own = stage.outline().iter().filter(|e| e.name == edge.name);
                let length: f64 = own.map(|e| e.curve.length()).sum();
                assert!((length - edge.curve.length()).abs() < 1e-12, "{name}");
            }
        }
    }
}

#[test]
fn less_than_nothing_is_refused() {
    for (name, put) in CASES {
        let mut pattern = sample();
        put(&mut pattern, (-0.01).into());
        let found = evaluated(&pattern).check();
        let refused =
            |f: &Diagnostic| f.severity == Severity::Error && f.hint.contains("of 0 or more");
        assert!(found.iter().any(refused), "{name}: {found:?}");
    }
}

#[test]
fn what_is_placed_by_the_ends_of_a_mouth_stays_where_the_mouth_is_shut() {
    let mut pattern = sample();
    let id = with_dart(&mut pattern, formula("max(bust - 1 m, 0 m) / 8"));
    let line = outline(&pattern, "front");
    for index in 0..2 {
        let notch = Notch {
            id: pattern.ids.take(),
            name: format!("leg {index}"),
            line,
            at: Mark::Corner(Name::Made {
                by: id,
                role: Role::Mouth,
                index,
            }),
            kind: NotchKind::Slit,
        };
        sample::alter(&mut pattern, 0, |panel| panel.notches.push(notch));
    }
    let mut seen = [false; 2];
    for body in bodies() {
        let evaluation = Evaluation::new(&pattern, &body);
        let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
        let intake = ((body.get("bust").unwrap() - 1.0) / 8.0).max(0.0);
        seen[usize::from(intake > 0.0)] = true;
        assert_eq!(stage.idle.is_empty(), intake > 0.0);
        // The top runs from right to left.
        let wanted = [0.3 + 0.5 * intake, 0.3 - 0.5 * intake].map(|x| Vec2::new(x, 0.6));
        let found: Vec<Vec2> = stage.notches.iter().map(|notch| notch.point).collect();
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).norm() < 1e-12, "{found} is not {wanted}");
        }
        assert_eq!(found.len(), 2);
    }
    assert_eq!(seen, [true; 2]);
}

#[test]
fn a_dart_that_is_nothing_may_be_pivoted() {
    let mut pattern = sample();
    let dart = with_dart(&mut pattern, 0.0.into());
    let kind = OperationKind::Pivot {
        dart,
        line: Name::Drawn(outline(&pattern, "front")),
        mouth: Mark::between(ends(&pattern, "front", "right"), 0.5),
        share: 1.0.into(),
        back: 0.0.into(),
        turned: Turned::default(),
        pressed: Pressed::default(),
    };
    let pivot = put_operation(&mut pattern, 0, "pivot", kind);
    let evaluation = evaluated(&pattern);
    let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
    assert_eq!(stage.idle, [dart, pivot]);
    let notes = evaluation.check();
    assert!(
        notes.iter().all(|note| note.code == Code::NoEffect),
        "{notes:?}"
    );
    let plain = sample();
    let before = evaluated(&plain);
    let before = before.last_stage(&plain.panels[0]).unwrap();
    assert!((area(stage) - area(before)).abs() < 1e-12);
}
