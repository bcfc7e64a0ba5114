//! A panel from a region of the mannequin: clicked in the 3D view, flattened, undone.

use crate::drafter::Drafter;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use toile_geometry::Vec3;

/// Clicks the mannequin where a point before it is seen.
fn click_body(drafter: &mut Drafter, point: [f64; 3]) {
    let at = drafter
        .window
        .state()
        .stage()
        .place_on_screen(Vec3::from(point));
    drafter.click(at.unwrap());
}

fn laid(drafter: &Drafter) -> usize {
    let laid = drafter.window.state().stage().laid.as_ref();
    laid.map_or(0, |laid| laid.skin.places().len())
}

#[test]
fn a_region_clicked_on_the_mannequin_is_a_panel_of_the_pattern() {
    let mut drafter = Drafter::opened("t-shirt");
    let before = drafter.pattern();
    drafter.chord(Modifiers::SHIFT, Key::F6);
    // The loop begins once the mannequin is there.
    drafter.wait(|drafter| drafter.window.state().stage().laid.is_some());
    drafter.key(Key::Num1);
    for point in [[0.0, 1.05, 0.1], [0.09, 1.06, 0.1], [0.09, 1.14, 0.1]] {
        click_body(&mut drafter, point);
    }
    assert_eq!(laid(&drafter), 3, "{}", drafter.status());
    // Beside the mannequin there is nothing to click.
    click_body(&mut drafter, [0.6, 1.0, 0.0]);
    assert!(
        drafter.status().contains("not there"),
        "{}",
        drafter.status()
    );
    click_body(&mut drafter, [0.0, 1.0, 0.1]);
    assert_eq!(laid(&drafter), 4);
    drafter.press("Take back");
    click_body(&mut drafter, [0.0, 1.14, 0.1]);
    let places = drafter
        .window
        .state()
        .stage()
        .laid
        .as_ref()
        .unwrap()
        .skin
        .places()
        .to_vec();
    assert!(places.iter().all(|place| place.z > 0.0));
    assert_eq!((places[0].x, places[3].x), (0.0, 0.0));

    drafter.enter("Ease", "far");
    drafter.press("Make the panel");
    assert!(drafter.status().contains("Ease"), "{}", drafter.status());
    assert_eq!(drafter.pattern(), before);
    drafter.enter("Ease", "5mm");
    drafter.press("Make the panel");
    drafter.wait(|drafter| {
        drafter
            .window
            .query_by_label("Flattening\u{2026}")
            .is_none()
    });
    assert!(
        drafter.status().contains("Made a panel"),
        "{}",
        drafter.status()
    );
    let after = drafter.pattern();
    assert_eq!(after.panels.len(), before.panels.len() + 1);
    assert_eq!(after.fabrics.len(), before.fabrics.len());
    let panel = after.panels.last().unwrap();
    assert_eq!(panel.fabric, before.fabrics[0].id);

    drafter.key(Key::Escape);
    assert_eq!(laid(&drafter), 0);
    assert!(drafter.window.query_by_label("Make the panel").is_none());
    drafter.chord(Modifiers::COMMAND, Key::Z);
    let undone = drafter.pattern();
    assert_eq!(
        (undone.panels, undone.sheets),
        (before.panels, before.sheets)
    );
}

#[test]
fn a_panel_that_is_made_meanwhile_is_no_part_of_another_pattern() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.chord(Modifiers::SHIFT, Key::F6);
    drafter.wait(|drafter| drafter.window.state().stage().laid.is_some());
    drafter.key(Key::Num1);
    for point in [[0.0, 1.05, 0.1], [0.09, 1.06, 0.1], [0.09, 1.14, 0.1]] {
        click_body(&mut drafter, point);
    }
    drafter.press("Make the panel");
    // Places stay while it is made.
    click_body(&mut drafter, [0.0, 1.14, 0.1]);
    assert_eq!(laid(&drafter), 3);
    let other = concat!(env!("CARGO_MANIFEST_DIR"), "/../patterns/poncho.toile.json");
    drafter.window.state_mut().open(std::path::Path::new(other));
    let pattern = drafter.pattern();
    assert_eq!(laid(&drafter), 0);
    for _ in 0..300 {
        std::thread::sleep(std::time::Duration::from_millis(10));
        drafter.window.run_steps(1);
    }
    assert_eq!(drafter.pattern(), pattern);
}
