//! A skirt block of two panels for a waist and hips, with darts and a fold, sewn: from an empty window, with
//! its actions counted as in `drafting.rs`.

use crate::drafter::Drafter;
use egui::{Key, Modifiers};

/// The outline of a half panel from its centre at the waist, a place to the right of the last.
fn outline(drafter: &mut Drafter, [centre, waist, hips]: [&str; 3]) {
    drafter.chord(Modifiers::SHIFT, Key::L);
    drafter.typed_and(centre, Key::Tab);
    drafter.typed("0");
    drafter.typed_and(&format!("@={waist}"), Key::Tab);
    drafter.typed("1");
    drafter.typed_and(&format!("#={centre}cm + {hips}"), Key::Tab);
    drafter.typed("-20");
    drafter.typed_and("40", Key::Tab);
    drafter.typed("-90");
    drafter.typed_and(&format!("#{centre}"), Key::Tab);
    drafter.typed("-60");
    drafter.typed_and(&format!("#{centre}"), Key::Tab);
    drafter.typed("0");
    drafter.key(Key::Home);
}

#[test]
fn a_skirt_block_of_two_panels_with_darts_and_fold_is_drafted_and_sewn() {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Skirt block");
    drafter.key(Key::F8);
    drafter.press("Add size");
    drafter.enter("Waist girth", "72");
    drafter.enter("Hip girth", "98");
    drafter.key(Key::F8);
    outline(&mut drafter, ["0", "waist/4 + 3", "hips/4 + 0.5"]);
    drafter.typed("'front");
    outline(&mut drafter, ["60", "waist/4 + 3", "hips/4 + 0.5"]);
    drafter.typed("'back");
    let pattern = drafter.pattern();
    let names: Vec<&str> = pattern.panels.iter().map(|panel| &*panel.name).collect();
    assert_eq!(names, ["front", "back"], "{}", drafter.status());
    let edge = |panel: usize, k: usize| {
        let panel = &pattern.panels[panel];
        format!(
            "Edge {} of {}",
            panel.edges().nth(k).unwrap().name,
            panel.name
        )
    };
    let edges = |panel: usize| -> [String; 5] { std::array::from_fn(|k| edge(panel, k)) };
    let (front, back) = (edges(0), edges(1));
    let at = |evaluation: &toile_pattern::Evaluation, panel: usize, k: usize| {
        let edge = pattern.panels[panel].edges().nth(k).unwrap();
        edge.ends.map(|end| evaluation.point(end).unwrap())
    };
    // Edges by where they lie: waist, hip curve, side, hem, centre.
    let evaluation = drafter.evaluation();
    let named = |panel: usize, edges: &[String; 5], x: f64, y: f64| {
        let found = (0..5).min_by(|a, b| {
            let away = |k: usize| {
                let [from, to] = at(&evaluation, panel, k);
                ((from + to) * 0.5 - toile_geometry::Vec2::new(x, y)).norm()
            };
            away(*a).total_cmp(&away(*b))
        });
        edges[found.unwrap()].clone()
    };
    for (panel, edges, x) in [(0, &front, 0.0), (1, &back, 0.6)] {
        // The dart in the middle of the waist.
        drafter.key(Key::D);
        drafter.click(drafter.part(&named(panel, edges, x + 0.11, 0.0)));
        drafter.typed("3");
        drafter.typed(["9", "12"][panel]);
        // The hip curve.
        drafter.chord(Modifiers::SHIFT, Key::B);
        drafter.click(drafter.part(&named(panel, edges, x + 0.23, -0.1)));
        drafter.typed_and(&format!("={}cm + hips/4 - 0.3", x * 100.0), Key::Tab);
        drafter.typed("-12");
    }
    drafter.chord(Modifiers::SHIFT, Key::F);
    drafter.click(drafter.part(&named(0, &front, 0.0, -0.3)));
    for _ in 0..2 {
        drafter.key(Key::Escape);
    }
    drafter.click(drafter.part("Panel back"));
    drafter.enter_choice("in mirrored pairs");
    drafter.key(Key::S);
    for (x, y) in [(0.23, -0.1), (0.25, -0.4)] {
        drafter.click(drafter.part(&named(0, &front, x, y)));
        drafter.click(drafter.part(&named(1, &back, x + 0.6, y)));
    }
    for _ in 0..2 {
        drafter.window.run_steps(40);
        drafter.click(drafter.part(&named(1, &back, 0.6, -0.3)));
    }
    println!("{} actions", drafter.actions);
    assert!(drafter.actions <= 80, "{}", drafter.actions);
    let pattern = drafter.pattern();
    let steps: Vec<usize> = pattern
        .panels
        .iter()
        .map(|panel| panel.operations.len())
        .collect();
    assert_eq!(steps, [2, 1], "{}", drafter.status());
    // Both sides of the wearer, and the centre back.
    assert_eq!(pattern.seams.len(), 5, "{}", drafter.status());
    // The side seams lean as they are drawn: that the waist turns across them is told, and nothing else.
    let findings = drafter.window.state().findings();
    let turns = |found: &toile_pattern::Diagnostic| {
        found.code == toile_pattern::Code::Kink
            && found.severity == toile_pattern::Severity::Note
            && matches!(found.place, toile_pattern::Place::SeamEnd(..))
    };
    assert_eq!(findings.len(), 3, "{findings:?}");
    assert!(findings.iter().all(turns), "{findings:?}");
}
