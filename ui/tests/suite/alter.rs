//! Darts pivoted and panels spread at the window, from raw events.

use crate::drafter::Drafter;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use toile_pattern::{LineKind, Name, Role, StageEdge};

/// Length of the trued top with a dart of 2 by 15 cm in its middle (m): closed, it is the chord
/// between its corners.
fn trued_top() -> f64 {
    let half = (0.1_f64 / 0.15).atan() - (0.01_f64 / 0.15).atan();
    2.0 * 0.1_f64.hypot(0.15) * half.sin()
}

#[test]
fn a_dart_is_trued_by_a_tick_that_is_on() {
    let mut drafter = Drafter::with_panel("Altered");
    drafter.key(Key::D);
    drafter.click(drafter.part("Edge top of draft"));
    drafter.typed("2");
    // Before it is done it is told what becomes of the finished edge.
    drafter.type_text("15");
    let words = "top finished: 18 cm -> 17.96 cm by truing";
    assert!(drafter.status().contains(words), "{}", drafter.status());
    drafter.key(Key::Enter);
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.click(drafter.part("Dart of draft"));
    assert!((drafter.finished_length("top") - trued_top()).abs() < 1e-9);
    let told = |drafter: &Drafter, words: &str| drafter.window.query_by_label(words).is_some();
    let words = "top finished: 18 cm -> 17.96 cm by truing";
    assert!(told(&drafter, words), "{}", trued_top());
    // Its width alone is taken from the finished edge: what truing takes is given back at the mouth.
    drafter.tick("Keep the finished length");
    assert!((drafter.finished_length("top") - 0.18).abs() < 1e-9);
    assert!(told(&drafter, "No faults"));
    // Closed, half of the edge is 9 cm of the chord; the legs end on that, square to it.
    let reach = 0.1_f64.hypot(0.15);
    let turned = (0.09 / reach).asin();
    let mouth = 2.0 * reach * turned.cos() * ((0.1_f64 / 0.15).atan() - turned).sin();
    let kept = format!(
        "top finished: 18 cm, kept; the mouth is {:.2} cm wide",
        100.0 * mouth
    );
    assert!(told(&drafter, &kept), "{}", drafter.status());
    drafter.tick("Keep the finished length");
    assert!(told(&drafter, "No faults"));
    drafter.tick("True the edge");
    assert!((drafter.finished_length("top") - 0.18).abs() < 1e-9);
    assert!(told(&drafter, "No faults, 1 note"));
    let kink = &drafter.window.state().findings()[0];
    assert!(kink.message.contains("top turns by 7.6 degrees"), "{kink}");
    drafter.tick("Kink is meant");
    assert!(told(&drafter, "No faults"));
    drafter.tick("True the edge");
    assert!((drafter.finished_length("top") - trued_top()).abs() < 1e-9);
}

/// Waist darts are pressed to the centre where a fold says where that is; a dart of the side stays as it was.
#[test]
fn a_new_dart_is_pressed_to_the_centre() {
    let pressed = |is_folded: bool, edge: &str| {
        let mut drafter = Drafter::with_panel("Altered");
        if is_folded {
            drafter.chord(Modifiers::SHIFT, Key::F);
            drafter.click(drafter.part("Edge left of draft"));
        }
        drafter.key(Key::D);
        drafter.click(drafter.part(&format!("Edge {edge} of draft")));
        drafter.typed("2");
        drafter.typed("8");
        let scene = &drafter.window.state().view().scene;
        let arrows = &scene.panels[0].pressed;
        assert_eq!(arrows.len(), 1, "{}", drafter.status());
        arrows[0].way
    };
    // The centre lies on the left, and the outline runs to it along the top.
    assert!(pressed(true, "top").x < -0.9);
    assert!(pressed(false, "top").x > 0.9);
    assert!((pressed(true, "right") - pressed(false, "right")).norm() < 1e-9);
}

#[test]
fn a_dart_is_pivoted_by_four_actions() {
    let mut drafter = Drafter::with_panel("Altered");
    drafter.key(Key::D);
    drafter.click(drafter.part("Edge top of draft"));
    drafter.typed("2");
    drafter.typed("15");
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    assert!((drafter.finished_length("top") - trued_top()).abs() < 1e-9);
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
    let stage = drafter.stage();
    assert!(
        stage.darts.len() == 1 || stage.darts.len() == 2,
        "{}",
        stage.darts.len()
    );
    // The old mouth is closed: the top is as long as it was finished, in one straight line.
    assert!(
        (drafter.finished_length("top") - trued_top()).abs() < 1e-9,
        "{}",
        drafter.finished_length("top")
    );
    assert!((drafter.finished_length("left") - 0.3).abs() < 1e-9);
    assert!(drafter.window.query_by_label("No faults").is_some());
}

#[test]
fn a_panel_is_spread_by_two_clicks_and_numbers() {
    let mut drafter = Drafter::with_panel("Altered");
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
        assert!(
            (drafter.finished_length(name) - drawn).abs() < 1e-9,
            "{name}"
        );
    }
    // The lower edge runs over three openings of 2 cm.
    let around: f64 = drafter
        .stage()
        .outline()
        .iter()
        .map(|edge| edge.curve.length())
        .sum();
    assert!((around - (1.0 + 3.0 * 0.02)).abs() < 1e-6, "{around}");
}

/// A panel that was split from the middle of one side to the middle of the other.
fn halved() -> Drafter {
    let mut drafter = Drafter::with_panel("Altered");
    drafter.key(Key::K);
    drafter.click(drafter.part("Edge left of draft"));
    drafter.click(drafter.part("Edge right of draft"));
    drafter.key(Key::Escape);
    drafter
}

#[test]
fn a_panel_is_split_by_two_clicks_and_its_sides_are_panels() {
    let mut drafter = Drafter::with_panel("Altered");
    let before = drafter.pattern();
    drafter.actions = 0;
    drafter.key(Key::K);
    drafter.click(drafter.part("Edge left of draft"));
    drafter.click(drafter.part("Edge right of draft"));
    assert_eq!(drafter.actions, 3);
    let pattern = drafter.pattern();
    assert_eq!(pattern.panels.len(), 3, "{}", drafter.status());
    assert!(drafter.window.query_by_label("No faults").is_some());
    // The sides are drawn in place of the panel, with the cut on both.
    for side in ["draft left", "draft right"] {
        drafter.part(&format!("Panel {side}"));
        drafter.part(&format!("Split of {side}"));
    }
    assert!(drafter.window.query_by_label("Panel draft").is_none());
    let evaluation = drafter.evaluation();
    let height = |name: &str| -> f64 {
        let panel = pattern.panel_named(name).unwrap();
        let stage = evaluation.last_stage(panel).unwrap();
        let ends = stage.outline().iter().map(|edge| edge.curve.end().y);
        ends.clone().fold(f64::MIN, f64::max) - ends.fold(f64::MAX, f64::min)
    };
    for side in ["draft left", "draft right"] {
        assert!((height(side) - 0.15).abs() < 1e-9, "{side}");
    }
    drafter.chord(Modifiers::COMMAND, Key::Z);
    assert!(drafter.pattern().says_the_same(&before));
}

#[test]
fn a_panel_is_split_along_a_curve() {
    let mut drafter = Drafter::with_panel("Altered");
    drafter.key(Key::C);
    for (x, y) in [(-0.02, 0.1), (0.1, 0.2), (0.22, 0.1)] {
        drafter.click(drafter.place(x, y));
    }
    drafter.key(Key::Enter);
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.chord(Modifiers::SHIFT, Key::K);
    drafter.click(drafter.place(0.1, 0.2));
    assert_eq!(drafter.pattern().panels.len(), 3, "{}", drafter.status());
    // Its corners are sharp for the seam allowance, and nothing else is found.
    let mut findings = drafter.window.state().findings().iter();
    assert!(findings.all(|found| found.code == toile_pattern::Code::SharpCorner));
}

#[test]
fn sides_of_a_split_are_worked_on_as_panels() {
    let mut drafter = halved();
    let side = |drafter: &Drafter| {
        let pattern = drafter.pattern();
        let found = pattern.panel_named("yoke");
        found.unwrap().clone()
    };
    drafter.click(drafter.part("Panel draft left"));
    drafter.enter("Name", "yoke");
    drafter.enter("grain", "45deg");
    drafter.enter("seam allowance", "2");
    let evaluation = drafter.evaluation();
    let stage = evaluation.last_stage(&side(&drafter)).unwrap();
    assert!((stage.grain.to_degrees() - 45.0).abs() < 1e-9);
    // Its own width lies outside all edges that have none of their own.
    for edge in stage.outline() {
        assert!((edge.allowance - 0.02).abs() < 1e-12, "{:?}", edge.name);
    }
    // An edge of the side is that of the panel that was split.
    drafter.key(Key::N);
    drafter.click(drafter.part("Edge top of yoke"));
    drafter.key(Key::Escape);
    assert_eq!(side(&drafter).notches.len(), 1, "{}", drafter.status());
    drafter.part("Notch 1 of yoke");
    drafter.click(drafter.part("Edge right of yoke"));
    drafter.enter("seam allowance", "3");
    let evaluation = drafter.evaluation();
    let stage = evaluation.last_stage(&side(&drafter)).unwrap();
    let widest = stage.outline().iter().map(|edge| edge.allowance);
    assert!((widest.fold(0.0, f64::max) - 0.03).abs() < 1e-12);
    // A seam from side to side, a dart, a point on an edge: of the panel that was split.
    drafter.key(Key::S);
    drafter.click(drafter.part("Edge top of yoke"));
    drafter.click(drafter.part("Edge bottom of draft right"));
    drafter.key(Key::Escape);
    assert_eq!(drafter.pattern().seams.len(), 2, "{}", drafter.status());
    drafter.key(Key::D);
    drafter.click(drafter.part("Edge bottom of draft right"));
    drafter.typed("2");
    drafter.typed("5");
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.part("Dart of draft right");
    drafter.key(Key::B);
    drafter.click(drafter.part("Edge top of yoke"));
    drafter.key(Key::Escape);
    assert_eq!(drafter.pattern().panels[0].edges().count(), 5);
    // The stretch of an edge that is left on a side is laid on the fold.
    drafter.chord(Modifiers::SHIFT, Key::F);
    drafter.click(drafter.part("Edge left of yoke"));
    drafter.key(Key::Escape);
    assert_eq!(side(&drafter).operations.len(), 1, "{}", drafter.status());
    assert!(drafter.evaluation().diagnostics().is_empty());
    // A line inside is drawn on the side as it is finished.
    drafter.key(Key::I);
    drafter.click(drafter.part("Panel yoke"));
    drafter.click(drafter.place(0.05, 0.2));
    drafter.click(drafter.place(0.1, 0.25));
    drafter.key(Key::Enter);
    drafter.key(Key::Escape);
    assert_eq!(side(&drafter).lines.len(), 1, "{}", drafter.status());
    assert!(drafter.evaluation().diagnostics().is_empty());
    drafter.part("Line line of yoke");
}

#[test]
fn a_line_is_drawn_on_a_panel_after_a_pivot_and_inserted() {
    let mut drafter = Drafter::with_panel("Altered");
    drafter.key(Key::D);
    drafter.click(drafter.part("Edge top of draft"));
    drafter.typed("2");
    drafter.typed("15");
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.chord(Modifiers::SHIFT, Key::E);
    drafter.click(drafter.part("Dart of draft"));
    drafter.click(drafter.part("Edge right of draft"));
    drafter.key(Key::Enter);
    drafter.key(Key::Escape);
    drafter.chord(Modifiers::SHIFT, Key::I);
    drafter.click(drafter.part("Panel draft"));
    drafter.key(Key::Escape);
    let pattern = drafter.pattern();
    assert_eq!(pattern.sheets.len(), 2, "{}", drafter.status());
    let on = pattern.sheets[1].on.unwrap();
    assert_eq!(on.1, Some(pattern.panels[0].operations[1].id));
    // Points and lines are drawn there with the usual tools, and snap to the panel's edges.
    drafter.key(Key::L);
    drafter.click(drafter.part("Edge left of draft"));
    drafter.click(drafter.place(0.06, 0.1));
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    let pattern = drafter.pattern();
    let [curve] = &pattern.sheets[1].curves[..] else {
        panic!("{}", drafter.status());
    };
    let start = pattern.point(curve.ends[0]).unwrap().1;
    let is_mark = matches!(start.rule, toile_pattern::PointRule::Mark { .. });
    assert!(is_mark, "{:?}", start.rule);
    drafter.key(Key::J);
    let words = format!("Curve {} of {}", curve.name, pattern.sheets[1].name);
    drafter.click(drafter.part(&words));
    let panel = drafter.pattern().panels[0].clone();
    assert_eq!(panel.lines.len(), 2, "{}", drafter.status());
    assert_eq!(panel.operations.len(), 3);
    assert!(drafter.window.query_by_label("No faults").is_some());
}

#[test]
fn an_edge_of_a_side_is_dragged_with_the_panel_that_was_split() {
    let mut drafter = halved();
    let from = drafter.part("Edge top of draft left");
    let to = from - egui::vec2(0.0, 40.0);
    drafter.window.hover_at(from);
    drafter.window.run();
    drafter.window.drag_at(from);
    drafter.window.run();
    drafter.window.hover_at(to);
    drafter.window.run();
    drafter.window.drop_at(to);
    drafter.window.run();
    assert!(drafter.point("C").y > 0.31, "{}", drafter.status());
    assert!(drafter.window.query_by_label("No faults").is_some());
}

#[test]
fn a_dart_with_two_points_is_taken_out_by_two_clicks_and_a_number() {
    let mut drafter = Drafter::with_panel("Altered");
    drafter.actions = 0;
    drafter.key(Key::O);
    drafter.click(drafter.place(0.1, 0.08));
    drafter.click(drafter.place(0.1, 0.24));
    drafter.typed("2.4");
    assert_eq!(drafter.actions, 4);
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    let hole = |drafter: &Drafter| {
        let stage = drafter.stage();
        let own = stage.lines.iter().find(|line| line.kind == LineKind::Hole);
        own.unwrap()
            .edges
            .iter()
            .map(|leg| leg.curve.length())
            .sum::<f64>()
    };
    let legs = |half: f64, first: f64, second: f64| 2.0 * (half.hypot(first) + half.hypot(second));
    assert!((hole(&drafter) - legs(0.012, 0.08, 0.08)).abs() < 1e-9);
    // Its numbers are like any others, and it is sewn shut without a seam being drawn.
    drafter.click(drafter.part("Dart of draft"));
    drafter.enter("intake", "3");
    drafter.enter("widest at", "0.25");
    assert!((hole(&drafter) - legs(0.015, 0.04, 0.12)).abs() < 1e-9);
    let evaluation = drafter.evaluation();
    assert!(evaluation.diagnostics().is_empty());
    // On nothing there is no dart.
    let steps = drafter.window.state().session().past().len();
    drafter.key(Key::O);
    drafter.click(drafter.place(0.3, 0.08));
    drafter.click(drafter.place(0.3, 0.24));
    drafter.typed("2");
    assert!(
        drafter.status().contains("no panel lies there"),
        "{}",
        drafter.status()
    );
    assert_eq!(drafter.window.state().session().past().len(), steps);
}

/// How far the last notch of the first panel is from both ends of a drawn edge, along that edge as it
/// is finished: darts sewn, pleats folded, openings in between (m).
fn reaches(drafter: &Drafter, name: &str) -> [f64; 2] {
    let pattern = drafter.pattern();
    let edge = pattern.panels[0].edges().find(|edge| edge.name == name);
    let wanted = Name::Drawn(edge.unwrap().id);
    let stage = drafter.stage();
    let notch = stage.notches.last().unwrap();
    let outline = stage.outline();
    let first = |edge: &StageEdge| edge.name == wanted && edge.start.is_some() && edge.from == 0.0;
    let first = outline.iter().position(first).unwrap();
    let (mut whole, mut reach) = (0.0, None);
    for edge in outline[first..].iter().chain(&outline[..first]) {
        if matches!(edge.name, Name::Drawn(_)) && edge.name != wanted {
            break;
        }
        if edge.name == notch.edge && (edge.from..=edge.to).contains(&notch.share) {
            let share = (notch.share - edge.from) / (edge.to - edge.from);
            reach = Some(whole + share * edge.curve.length());
        }
        if !matches!(edge.name.role(), Some(Role::Leg | Role::Underlay)) {
            whole += edge.curve.length();
        }
    }
    let reach = reach.unwrap();
    [reach, whole - reach]
}

#[test]
fn a_typed_distance_is_measured_on_the_edge_as_it_is_finished() {
    type Alter = fn(&mut Drafter);
    let dart: Alter = |drafter| {
        drafter.key(Key::D);
        drafter.click(drafter.part("Edge top of draft"));
        drafter.typed("2");
        drafter.typed("15");
    };
    let pivoted: Alter = |drafter| {
        drafter.key(Key::D);
        drafter.click(drafter.part("Edge top of draft"));
        drafter.typed("2");
        drafter.typed("15");
        drafter.chord(Modifiers::SHIFT, Key::E);
        drafter.click(drafter.part("Dart of draft"));
        drafter.click(drafter.part("Edge right of draft"));
        drafter.key(Key::Enter);
    };
    let spread: Alter = |drafter| {
        drafter.chord(Modifiers::SHIFT, Key::W);
        drafter.click(drafter.part("Edge top of draft"));
        drafter.click(drafter.part("Edge bottom of draft"));
        drafter.typed("3");
        drafter.typed("2");
        drafter.key(Key::Enter);
    };
    let pleated: Alter = |drafter| {
        drafter.key(Key::Y);
        drafter.click(drafter.part("Edge top of draft"));
        drafter.click(drafter.part("Edge bottom of draft"));
        drafter.typed("1.5");
        drafter.typed("2");
        drafter.key(Key::Enter);
        drafter.key(Key::Enter);
    };
    for (what, alter) in [
        ("dart", dart),
        ("pivoted", pivoted),
        ("spread", spread),
        ("pleated", pleated),
    ] {
        let mut drafter = Drafter::with_panel("Altered");
        alter(&mut drafter);
        drafter.key(Key::Escape);
        drafter.key(Key::Escape);
        let pattern = drafter.pattern();
        // Within the first or last centimetres of the edge, wherever operations moved it.
        let edge = pattern.panels[0].edges().find(|edge| edge.name == "top");
        let top = Name::Drawn(edge.unwrap().id);
        let finished = drafter.stage();
        let own = finished.outline().iter().filter(|edge| edge.name == top);
        let mut own: Vec<&StageEdge> = own.collect();
        own.sort_by(|a, b| a.from.total_cmp(&b.from));
        let places = [own[0].curve.point(0.3), own[own.len() - 1].curve.point(0.7)];
        drafter.key(Key::N);
        for (text, wanted) in [("3", 0.03), ("12", 0.12), ("=10cm + 3cm", 0.13)] {
            for (end, place) in places.iter().enumerate() {
                drafter.hover(drafter.place(place.x, place.y));
                drafter.typed(text);
                let notches = drafter.stage().notches.len();
                assert_eq!(notches, 1, "{what} {text}: {}", drafter.status());
                let reach = reaches(&drafter, "top")[end];
                let is_there = (reach - wanted).abs() < 1e-9;
                assert!(is_there, "{what} {text} {end}: {reach}");
                drafter.chord(Modifiers::COMMAND, Key::Z);
            }
        }
    }
}

#[test]
fn a_typed_distance_is_measured_from_a_cut_too() {
    let mut drafter = halved();
    drafter.key(Key::Escape);
    drafter.key(Key::N);
    // Left of the cut, and both sides of it.
    for (y, text, wanted) in [(0.17, "5", 0.2), (0.12, "5", 0.1), (0.27, "=4cm", 0.26)] {
        drafter.hover(drafter.place(0.0, y));
        drafter.typed(text);
        let evaluation = drafter.evaluation();
        let pattern = drafter.pattern();
        let panels = pattern.panels.iter();
        let stages = panels.filter_map(|panel| evaluation.last_stage(panel));
        let mut notches = stages.flat_map(|stage| &stage.notches);
        let is_there = notches.any(|notch| {
            let away = notch.point - toile_geometry::Vec2::new(0.0, wanted);
            away.norm() < 1e-9
        });
        assert!(is_there, "{text} at {y}: {}", drafter.status());
    }
}
