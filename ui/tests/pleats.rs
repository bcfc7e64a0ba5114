//! Pleats at the window, from raw events: evenly, by a spacing, at a list of places, and seen before they are done.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod drafter;

use drafter::Drafter;
use egui::{Key, Modifiers};
use toile_pattern::{Mark, OperationKind};

#[test]
fn pleats_are_folded_by_two_clicks_and_numbers() {
    for (modifiers, key, taken) in [
        (Modifiers::NONE, Key::Y, 2.0),
        (Modifiers::SHIFT, Key::Y, 4.0),
        (Modifiers::SHIFT, Key::J, 4.0),
    ] {
        let mut drafter = Drafter::with_panel("Altered");
        drafter.chord(modifiers, key);
        drafter.click(drafter.part("Edge bottom of draft"));
        drafter.click(drafter.part("Edge top of draft"));
        drafter.typed("1.5");
        drafter.typed("2");
        // Evenly.
        drafter.key(Key::Enter);
        drafter.key(Key::Enter);
        drafter.key(Key::Escape);
        assert_eq!(
            drafter.pattern().panels[0].operations.len(),
            1,
            "{}",
            drafter.status()
        );
        for name in ["top", "bottom"] {
            assert!((drafter.finished_length(name) - 0.2).abs() < 1e-9, "{name}");
        }
        let stage = drafter.stage();
        let ends = stage.outline().iter().map(|edge| edge.curve.end().x);
        let width = ends.clone().fold(f64::MIN, f64::max) - ends.fold(f64::MAX, f64::min);
        assert!((width - 0.2 - 2.0 * taken * 0.015).abs() < 1e-9, "{width}");
        drafter.part("Pleat of draft");
        // Its depth is a number like any other.
        drafter.enter("depth", "1");
        let wide = drafter.evaluation();
        assert!(wide.diagnostics().is_empty());
    }
}

#[test]
fn six_pleats_lie_where_their_first_and_their_spacing_say() {
    let mut drafter = Drafter::with_panel("Altered");
    drafter.actions = 0;
    drafter.key(Key::Y);
    drafter.click(drafter.part("Edge bottom of draft"));
    drafter.click(drafter.part("Edge top of draft"));
    for number in ["1", "6", "2.5", "3"] {
        drafter.typed(number);
    }
    assert!(drafter.actions <= 8, "{}", drafter.actions);
    drafter.key(Key::Escape);
    let pattern = drafter.pattern();
    let operations = &pattern.panels[0].operations;
    let [step] = &operations[..] else {
        panic!("{}", drafter.status());
    };
    let OperationKind::Pleat { pleats, .. } = &step.kind else {
        panic!("it is a pleat");
    };
    assert_eq!(pleats.len(), 6);
    for (k, pleat) in pleats.iter().enumerate() {
        let along = 0.025 + 0.03 * k as f64;
        let [Mark::Along { distance, .. }, Mark::Between { share, .. }] = &pleat.ends else {
            panic!("{:?}", pleat.ends);
        };
        assert!((distance.value().unwrap() - along).abs() < 1e-9, "{k}");
        assert!(
            (share.value().unwrap() - (1.0 - along / 0.2)).abs() < 1e-9,
            "{k}"
        );
    }
}

#[test]
fn six_pleats_lie_where_a_list_of_places_says() {
    let places = [0.02, 0.045, 0.07, 0.1, 0.12, 0.165];
    for list in [
        "2 4.5 7 10 12 16.5",
        "2, 4.5, 7, 10, 12, 16,5",
        "2 4,5 7 =4cm + 6cm 12 16.5",
    ] {
        let mut drafter = Drafter::with_panel("Altered");
        let before = drafter.steps();
        drafter.actions = 0;
        drafter.key(Key::Y);
        drafter.click(drafter.part("Edge bottom of draft"));
        drafter.click(drafter.part("Edge top of draft"));
        drafter.typed("1");
        // They are seen while they are typed.
        drafter.type_text(list);
        let shown = drafter.window.state().view().scene.panels[0].pressed.len();
        assert_eq!(shown, 6, "{list}: {}", drafter.status());
        assert_eq!(drafter.steps(), before);
        drafter.key(Key::Enter);
        println!(
            "six pleats at given places: {} actions",
            drafter.actions - 1
        );
        // Typed text and the key that takes it are one action.
        assert!(drafter.actions - 1 <= 8, "{}", drafter.actions);
        drafter.key(Key::Escape);
        let pattern = drafter.pattern();
        let [step] = &pattern.panels[0].operations[..] else {
            panic!("{list}: {}", drafter.status());
        };
        let OperationKind::Pleat { pleats, .. } = &step.kind else {
            panic!("it is a pleat");
        };
        let evaluation = drafter.evaluation();
        let along = pleats.iter().map(|pleat| match &pleat.ends[0] {
            Mark::Along { distance, .. } => {
                evaluation.number(distance, toile_pattern::Want::Length)
            }
            Mark::Corner(_) | Mark::Between { .. } | Mark::Notch(_) => None,
        });
        let along: Vec<f64> = along.collect::<Option<_>>().unwrap();
        assert_eq!(along.len(), 6, "{list}");
        for (found, wanted) in along.iter().zip(places) {
            assert!((found - wanted).abs() < 1e-9, "{list}: {along:?}");
        }
    }
}

#[test]
fn numbers_are_seen_from_the_first_on() {
    let mut drafter = Drafter::with_panel("Altered");
    let width = |drafter: &Drafter| {
        let shape = &drafter.window.state().view().scene.panels[0].shape;
        shape.bounds.max.x - shape.bounds.min.x
    };
    let before = drafter.steps();
    drafter.chord(Modifiers::SHIFT, Key::W);
    drafter.click(drafter.part("Edge bottom of draft"));
    drafter.click(drafter.part("Edge top of draft"));
    // Cuts that open by as much as at first; then by as much as is typed.
    drafter.type_text("2");
    assert!(
        (width(&drafter) - 0.2 - 0.06).abs() < 0.01,
        "{}",
        width(&drafter)
    );
    drafter.key(Key::Enter);
    drafter.type_text("5");
    assert!(
        (width(&drafter) - 0.2 - 0.1).abs() < 0.02,
        "{}",
        width(&drafter)
    );
    assert_eq!(drafter.steps(), before);
    drafter.key(Key::Enter);
    drafter.typed("5");
    assert!((width(&drafter) - 0.3).abs() < 1e-6, "{}", width(&drafter));
}
