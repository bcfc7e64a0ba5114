//! Darts pivoted and panels spread at the window, from raw events.
#![allow(clippy::unwrap_used)]

mod drafter;

use drafter::Drafter;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use std::sync::Arc;
use toile_pattern::Stage;

fn panel() -> Drafter {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Altered");
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter
}

fn stage(drafter: &Drafter) -> Arc<Stage> {
    let pattern = drafter.pattern();
    let evaluation = drafter.evaluation();
    evaluation.last_stage(&pattern.panels[0]).unwrap().clone()
}

/// Length of a drawn edge as it is after all operations [m].
fn length(drafter: &Drafter, name: &str) -> f64 {
    let pattern = drafter.pattern();
    let edge = pattern.panels[0].edges().find(|edge| edge.name == name);
    let edge = toile_pattern::Name::Drawn(edge.unwrap().id);
    let stage = stage(drafter);
    let own = stage.outline().iter().filter(|found| found.name == edge);
    own.map(|found| found.curve.length()).sum()
}

#[test]
fn a_dart_is_pivoted_by_four_actions() {
    let mut drafter = panel();
    drafter.key(Key::D);
    drafter.click(drafter.part("Edge top of draft"));
    drafter.typed("2");
    drafter.typed("15");
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    assert!((length(&drafter, "top") - 0.18).abs() < 1e-9);
    drafter.actions = 0;
    drafter.chord(Modifiers::SHIFT, Key::E);
    drafter.click(drafter.part("Dart of draft"));
    drafter.click(drafter.part("Edge right of draft"));
    drafter.key(Key::Enter);
    assert!(drafter.actions <= 4, "{}", drafter.actions);
    assert_eq!(
        drafter.pattern().panels[0].operations.len(),
        2,
        "{}",
        drafter.status()
    );
    let stage = stage(&drafter);
    assert!(
        stage.darts.len() == 1 || stage.darts.len() == 2,
        "{}",
        stage.darts.len()
    );
    // The old mouth is closed: the top is as long as it is drawn less the intake, in one piece.
    assert!(
        (length(&drafter, "top") - 0.18).abs() < 1e-9,
        "{}",
        length(&drafter, "top")
    );
    assert!((length(&drafter, "left") - 0.3).abs() < 1e-9);
    assert!(drafter.window.query_by_label("No faults").is_some());
}

#[test]
fn a_panel_is_spread_by_two_clicks_and_numbers() {
    let mut drafter = panel();
    drafter.chord(Modifiers::SHIFT, Key::W);
    drafter.click(drafter.part("Edge bottom of draft"));
    drafter.click(drafter.part("Edge top of draft"));
    drafter.typed("3");
    drafter.typed("2");
    drafter.key(Key::Enter);
    assert_eq!(
        drafter.pattern().panels[0].operations.len(),
        1,
        "{}",
        drafter.status()
    );
    for name in ["top", "left", "right", "bottom"] {
        let drawn = if matches!(name, "left" | "right") {
            0.3
        } else {
            0.2
        };
        assert!((length(&drafter, name) - drawn).abs() < 1e-9, "{name}");
    }
    // The lower edge runs over three openings of 2 cm.
    let around: f64 = stage(&drafter)
        .outline()
        .iter()
        .map(|edge| edge.curve.length())
        .sum();
    assert!((around - (1.0 + 3.0 * 0.02)).abs() < 1e-6, "{around}");
}
