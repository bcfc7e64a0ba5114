//! Pleats at the window, from raw events: evenly, by a spacing, at a list of places, and seen before they are done.

use crate::drafter::Drafter;
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
        let [
            Mark::Along { distance, .. },
            Mark::Along { distance: far, .. },
        ] = &pleat.ends
        else {
            panic!("{:?}", pleat.ends);
        };
        assert!((distance.value().unwrap() - along).abs() < 1e-9, "{k}");
        // The outline runs back along the top.
        assert!((far.value().unwrap() + along).abs() < 1e-9, "{k}");
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

/// Where the lines of a pleated panel's pleats start (m).
fn starts(drafter: &Drafter) -> Vec<f64> {
    let stage = drafter.stage();
    let placed = stage.lines.iter().filter(|line| {
        let role = line.name.role();
        line.half == 0 && role == Some(toile_pattern::Role::Placement)
    });
    let starts = placed.map(|line| line.edges[0].curve.start().x);
    starts.collect()
}

#[test]
fn places_count_from_the_end_of_the_edge_that_is_nearer_to_the_click() {
    for (x, end) in [
        (0.05, "A, where it meets left"),
        (0.17, "B, where it meets right"),
    ] {
        let mut drafter = Drafter::with_panel("Altered");
        drafter.key(Key::Y);
        drafter.click(drafter.place(x, 0.0));
        drafter.click(drafter.place(0.1, 0.3));
        drafter.typed("1");
        let told = format!("Places along bottom count from {end}");
        let status = drafter.status();
        assert!(status.contains(&told), "{told}: {status}");
        drafter.type_text("2 5");
        drafter.key(Key::Enter);
        drafter.key(Key::Escape);
        let from_left = |along: f64| if x < 0.1 { along } else { 0.2 - along };
        let pattern = drafter.pattern();
        let OperationKind::Pleat { pleats, .. } = &pattern.panels[0].operations[0].kind else {
            panic!("{}", drafter.status());
        };
        let evaluation = drafter.evaluation();
        for (pleat, along) in pleats.iter().zip([0.02, 0.05]) {
            let placed = pleat.ends.each_ref().map(|mark| {
                let Mark::Along { from, distance } = mark else {
                    panic!("{mark:?}");
                };
                let toile_pattern::Name::Drawn(from) = *from else {
                    panic!("{from:?}");
                };
                let along = evaluation
                    .number(distance, toile_pattern::Want::Length)
                    .unwrap();
                // Along the outline: to the right at the bottom and to the left at the top.
                let at = evaluation.point(from).unwrap();
                at.x + if at.y < 0.1 { along } else { -along }
            });
            for x in placed {
                assert!((x - from_left(along)).abs() < 1e-9, "{end}: {placed:?}");
            }
        }
        // Its fields say so, without a sign, and are typed so.
        let point = end.split(',').next().unwrap();
        let field = format!("pleat 1 on bottom from {point}");
        // A distance of nothing keeps the end that it counts from.
        drafter.enter(&field, "0");
        drafter.enter(&field, "3");
        let pattern = drafter.pattern();
        let OperationKind::Pleat { pleats, .. } = &pattern.panels[0].operations[0].kind else {
            panic!("{}", drafter.status());
        };
        let Mark::Along { distance, .. } = &pleats[0].ends[0] else {
            panic!("{:?}", pleats[0]);
        };
        let typed = distance.value().unwrap();
        assert!(
            (typed.abs() - 0.03).abs() < 1e-9 && (typed > 0.0) == (x < 0.1),
            "{typed}"
        );
        assert_eq!(starts(&drafter).len(), 2);
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
