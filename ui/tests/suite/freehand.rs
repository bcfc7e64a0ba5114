//! What once was in the way of somebody who draws freehand, and is not any more.

use crate::drafter::Drafter;
use egui::{Color32, Key, Modifiers, Pos2, Rect, Role, Shape, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use toile_ui::Beginning;

fn drawing() -> Drafter {
    let mut drafter = Drafter::new();
    drafter.press("New pattern");
    drafter.enter("Name", "Tote bag");
    drafter
}

/// Shapes that were painted last, out of their groups.
fn painted(drafter: &Drafter) -> Vec<Shape> {
    fn unfold(shape: &Shape, into: &mut Vec<Shape>) {
        match shape {
            Shape::Vec(shapes) => shapes.iter().for_each(|shape| unfold(shape, into)),
            shape => into.push(shape.clone()),
        }
    }
    let mut found = Vec::new();
    for clipped in &drafter.window.output().shapes {
        unfold(&clipped.shape, &mut found);
    }
    found
}

/// Whether words were painted.
fn is_painted(drafter: &Drafter, words: &str) -> bool {
    painted(drafter).iter().any(|shape| match shape {
        Shape::Text(text) => text.galley.text().contains(words),
        _ => false,
    })
}

fn button(drafter: &Drafter, name: &str) -> Rect {
    let found = drafter.window.get_by_role_and_label(Role::Button, name);
    found.rect()
}

#[test]
fn lines_and_curves_are_named_as_they_are_drawn() {
    let mut drafter = drawing();
    drafter.key(Key::L);
    // By numbers; the name before the click that ends the line; the same with Enter.
    drafter.click(drafter.place(0.0, 0.0));
    drafter.typed_and("20", Key::Tab);
    drafter.typed_and("90", Key::Tab);
    drafter.typed("left");
    drafter.hover(drafter.place(0.2, 0.2));
    drafter.type_text("'top");
    assert!(is_painted(&drafter, "name top|"));
    drafter.click(drafter.place(0.2, 0.2));
    drafter.hover(drafter.place(0.2, 0.0));
    drafter.typed("'right");
    // A curve: the name before its last place, or before the key that ends it.
    drafter.key(Key::C);
    drafter.click(drafter.part("Point A of draft"));
    drafter.click(drafter.place(0.1, -0.03));
    drafter.type_text("'hem");
    drafter.click(drafter.part("Point D of draft"));
    drafter.key(Key::Enter);
    let names = |drafter: &Drafter| -> Vec<String> {
        let curves = drafter.pattern().sheets[0].curves.clone();
        curves.iter().map(|curve| curve.name.clone()).collect()
    };
    let all = ["left", "top", "right", "hem"];
    assert_eq!(names(&drafter), all, "{}", drafter.status());
    // The panel inside them.
    drafter.key(Key::T);
    drafter.hover(drafter.place(0.1, 0.1));
    drafter.type_text("'bag");
    drafter.click(drafter.place(0.1, 0.1));
    assert_eq!(drafter.pattern().panels[0].name, "bag");
    // A name that is there is refused, with the line.
    drafter.key(Key::L);
    drafter.click(drafter.place(0.3, 0.0));
    drafter.hover(drafter.place(0.4, 0.0));
    drafter.typed("'hem");
    assert!(
        drafter.status().contains("is taken"),
        "{}",
        drafter.status()
    );
    // What was typed goes back, then the place.
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    assert_eq!(names(&drafter), all, "{}", drafter.status());
    // One that is taken back is none, and the keys are commands again.
    drafter.hover(drafter.place(0.3, 0.0));
    drafter.type_text("'");
    drafter.key(Key::Escape);
    drafter.key(Key::R);
    drafter.click(drafter.place(0.3, 0.0));
    drafter.hover(drafter.place(0.4, 0.2));
    drafter.type_text("'");
    drafter.key(Key::Backspace);
    drafter.typed_and("5", Key::Tab);
    drafter.typed_and("40", Key::Tab);
    drafter.typed("strap");
    assert_eq!(drafter.pattern().panels[1].name, "strap");
}

#[test]
fn a_rectangle_tells_its_width_and_height() {
    let mut drafter = drawing();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.hover(drafter.place(0.2, -0.1));
    assert!(is_painted(&drafter, "20 cm x 10 cm"));
}

#[test]
fn the_tool_in_hand_is_marked() {
    let mut drafter = drawing();
    let soft = drafter
        .window
        .ctx
        .style_of(egui::Theme::Light)
        .visuals
        .selection
        .bg_fill;
    let is_marked = |drafter: &Drafter, name: &str| {
        let at = button(drafter, name).center();
        painted(drafter).iter().any(|shape| match shape {
            Shape::Rect(rect) => rect.fill == soft && rect.rect.contains(at),
            _ => false,
        })
    };
    assert!(is_marked(&drafter, "Select"));
    drafter.hover(drafter.place(0.0, 0.0));
    drafter.key(Key::C);
    assert!(is_marked(&drafter, "Curve"));
    assert!(!is_marked(&drafter, "Select"));
    assert_ne!(soft, Color32::TRANSPARENT);
}

#[test]
fn every_tool_is_seen_in_a_low_window() {
    let mut drafter = Drafter::of_size(vec2(1200.0, 760.0), Beginning::default(), None);
    drafter.press("New pattern");
    drafter.enter("Name", "Low");
    let view = drafter.window.get_by_label("Pattern view").rect();
    for name in ["Select", "Grain", "Seam", "Matched notches", "Walk seam"] {
        let seen = button(&drafter, name);
        assert!(seen.bottom() <= view.bottom(), "{name}: {seen} of {view}");
    }
}

#[test]
fn the_only_sheet_is_renamed_while_nothing_is_selected() {
    let mut drafter = drawing();
    drafter.key(Key::F8);
    drafter.press("Pattern");
    drafter.enter("Sheet that is drawn on", "bag");
    assert_eq!(drafter.pattern().sheets[0].name, "bag");
    // Of several it is the one that is drawn on.
    drafter.chord(Modifiers::COMMAND | Modifiers::SHIFT, Key::N);
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.enter("Sheet that is drawn on", "strap");
    let names: Vec<String> = drafter
        .pattern()
        .sheets
        .iter()
        .map(|s| s.name.clone())
        .collect();
    assert_eq!(names, ["bag", "strap"]);
}

#[test]
fn a_copy_lies_on_no_other_panel() {
    let mut drafter = drawing();
    for x in [0.0, 0.13, 0.26] {
        drafter.key(Key::R);
        drafter.click(drafter.place(x, 0.0));
        drafter.click(drafter.place(x + 0.1, 0.2));
        drafter.key(Key::Escape);
        drafter.key(Key::Escape);
    }
    drafter.key(Key::Escape);
    drafter.click(drafter.part("Panel draft"));
    drafter.chord(Modifiers::COMMAND, Key::D);
    let pattern = drafter.pattern();
    let place = pattern.sheets[1].on_table;
    // The last of three ends at 36 cm.
    assert!(place[0] >= 0.4 && place[0] < 0.45, "{place:?}");
}

#[test]
fn what_is_selected_is_printed_alone() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("one piece");
    std::fs::create_dir_all(&folder).unwrap();
    let mut drafter = Drafter::opened("t-shirt");
    let print = |drafter: &mut Drafter, name: &str, alone: bool| {
        let file = folder.join(name);
        drafter.chord(Modifiers::COMMAND, Key::P);
        if alone {
            drafter.enter_choice("Only what is selected: front");
        }
        drafter.enter("File", &file.display().to_string());
        drafter.wait(|drafter| drafter.status().contains("Printed"));
        std::fs::read_to_string(&file).unwrap()
    };
    let all = print(&mut drafter, "all.svg", false);
    drafter.key(Key::Escape);
    drafter.click(drafter.part("Panel front"));
    let alone = print(&mut drafter, "front.svg", true);
    assert!(all.contains("sleeve") && alone.contains("front"));
    assert!(!alone.contains("sleeve"));
}

#[test]
fn a_marker_is_named_and_uses_its_room() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.key(Key::F10);
    drafter.enter("called", "poplin, first lay");
    assert_eq!(drafter.pattern().markers[0].name, "poplin, first lay");
    // What waits lies beside the fabric, not under it, so that both are seen large.
    let view = drafter.window.get_by_label("Marker view").rect();
    assert!(view.height() > 300.0, "{view}");
    let waiting = drafter.window.query_all_by_role(Role::Button);
    let places: Vec<Pos2> = waiting
        .filter(|node| {
            node.accesskit_node()
                .label()
                .is_some_and(|l| l.starts_with("Waiting"))
        })
        .map(|node| node.rect().center())
        .collect();
    assert_eq!(places.len(), 4);
    let all = Rect::from_points(&places);
    assert!(all.height() > 0.3 * view.height(), "{all} of {view}");
}

#[test]
fn names_that_are_proposed_stand_close() {
    let mut drafter = Drafter::opened("dress");
    let at = drafter.part("Panel front skirt");
    drafter.click(at);
    let field = drafter
        .window
        .get_by_role_and_label(Role::TextInput, "seam allowance");
    let at = field.rect().center();
    drafter.click(at);
    drafter.type_text("wai");
    let rows: Vec<f32> = ["waist_back", "waist_to_bust_dart", "waist_ease"]
        .map(|name| button(&drafter, name))
        .map(|rect| rect.center().y)
        .into();
    let far = rows.iter().copied().fold(0.0, f32::max) - rows.iter().copied().fold(1e9, f32::min);
    assert!(far < 80.0, "{rows:?}");
    assert!(button(&drafter, "waist_back").height() >= 17.0);
}

#[test]
fn a_prompt_asks_once_for_a_number() {
    let mut drafter = drawing();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.key(Key::D);
    drafter.click(drafter.place(0.1, 0.3));
    let words = drafter.status();
    assert!(
        words.contains("Type the width of the mouth; Enter"),
        "{words}"
    );
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    drafter.key(Key::Escape);
    let pattern = drafter.pattern();
    assert_eq!((pattern.panels.len(), pattern.seams.len()), (1, 0));
    assert!(pattern.panels[0].operations.is_empty());
}

#[test]
fn an_edge_tells_the_allowance_that_it_has_from_its_panel() {
    let mut drafter = drawing();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.2, 0.3));
    drafter.key(Key::V);
    drafter.click(drafter.place(0.1, 0.3));
    let told = |drafter: &Drafter| {
        let window = &drafter.window;
        let field = window.get_by_role_and_label(egui::Role::TextInput, "seam allowance");
        field.accesskit_node().description().unwrap_or_default()
    };
    assert_eq!(told(&drafter), "1 cm, as the panel");
    assert!(is_painted(&drafter, "1 cm, as the panel"));
    drafter.enter("seam allowance", "3");
    assert!(!is_painted(&drafter, "as the panel"));
}

#[test]
fn the_menu_marks_what_is_on_show() {
    let mut drafter = drawing();
    let soft = drafter
        .window
        .ctx
        .style_of(egui::Theme::Light)
        .visuals
        .selection
        .bg_fill;
    drafter.key(Key::F8);
    drafter.press("View");
    let is_marked = |drafter: &Drafter, name: &str| {
        let at = button(drafter, name).center();
        painted(drafter).iter().any(|shape| match shape {
            Shape::Rect(rect) => rect.fill == soft && rect.rect.contains(at),
            _ => false,
        })
    };
    assert!(is_marked(&drafter, "Tables"));
    assert!(!is_marked(&drafter, "Findings"));
}

#[test]
fn a_seam_is_named_by_what_its_edges_share() {
    let mut drafter = drawing();
    // Corners, each with the name of the line that starts there.
    type Outline = [(f64, f64, &'static str)];
    let outlines: [(&Outline, f64); 2] = [
        (
            &[
                (0.0, 0.0, "side_low"),
                (0.0, 0.1, "side_high"),
                (0.0, 0.2, "top"),
                (0.1, 0.2, "middle"),
                (0.1, 0.0, "hem"),
            ],
            0.05,
        ),
        (
            &[
                (0.2, 0.0, "side"),
                (0.2, 0.2, "over"),
                (0.3, 0.2, "back"),
                (0.3, 0.0, "under"),
            ],
            0.25,
        ),
    ];
    for (corners, inside) in outlines {
        drafter.key(Key::L);
        drafter.click(drafter.place(corners[0].0, corners[0].1));
        for (k, (_, _, name)) in corners.iter().enumerate() {
            let (x, y, _) = corners[(k + 1) % corners.len()];
            drafter.type_text(&format!("'{name}"));
            drafter.click(drafter.place(x, y));
        }
        drafter.key(Key::T);
        drafter.click(drafter.place(inside, 0.05));
    }
    drafter.key(Key::S);
    drafter.shift_click(drafter.place(0.0, 0.06));
    drafter.click(drafter.place(0.0, 0.16));
    drafter.click(drafter.place(0.2, 0.06));
    let pattern = drafter.pattern();
    assert_eq!(pattern.seams.len(), 1, "{}", drafter.status());
    assert_eq!(pattern.seams[0].name, "side seam");
}

#[test]
fn a_typed_rectangle_grows_to_the_side_of_the_pointer() {
    let mut drafter = drawing();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.1, 0.2));
    drafter.hover(drafter.place(0.2, -0.1));
    drafter.typed_and("38", Key::Tab);
    drafter.typed("=40cm + 2cm");
    let corner = drafter.point("C");
    let wanted = toile_geometry::Vec2::new(0.48, -0.22);
    assert!((corner - wanted).norm() < 1e-12, "{corner}");
    // From a corner that is typed it grows as its numbers say, wherever the pointer rests.
    for text in ["60", "0", "20", "30"] {
        drafter.typed_and(
            text,
            if ["60", "20"].contains(&text) {
                Key::Tab
            } else {
                Key::Enter
            },
        );
    }
    let corner = drafter.point("G");
    let wanted = toile_geometry::Vec2::new(0.8, 0.3);
    assert!((corner - wanted).norm() < 1e-12, "{corner}");
}

#[test]
fn what_a_deletion_leaves_at_fault_is_told() {
    let mut drafter = Drafter::opened("t-shirt");
    drafter.click(drafter.part("Panel front"));
    drafter.key(Key::Delete);
    let words = drafter.status();
    assert!(
        words.contains("cap_height") && words.contains("error"),
        "{words}"
    );
}

#[test]
fn each_cut_of_pleats_has_a_field_of_its_own() {
    let mut drafter = drawing();
    drafter.key(Key::R);
    drafter.click(drafter.place(0.0, 0.0));
    drafter.click(drafter.place(0.3, 0.3));
    drafter.key(Key::Y);
    drafter.click(drafter.place(0.15, 0.3));
    drafter.click(drafter.place(0.15, 0.0));
    drafter.typed("3");
    drafter.typed("2");
    drafter.key(Key::Enter);
    drafter.key(Key::Enter);
    drafter.key(Key::Escape);
    drafter.enter("pleat 2 at", "0.7");
    drafter.enter("pleat 1, other edge", "0.6");
    assert!(
        drafter.status().contains("pleat 1 at"),
        "{}",
        drafter.status()
    );
}

/// Two rectangles of 10 x 20 cm beside each other.
fn two_panels() -> Drafter {
    let mut drafter = drawing();
    for x in [0.0, 0.13] {
        drafter.key(Key::R);
        drafter.click(drafter.place(x, 0.0));
        drafter.click(drafter.place(x + 0.1, 0.2));
    }
    drafter
}

#[test]
fn no_corner_is_painted_over_what_is_said_of_a_seam() {
    let mut drafter = two_panels();
    drafter.key(Key::S);
    drafter.click(drafter.place(0.1, 0.1));
    drafter.click(drafter.place(0.13, 0.1));
    let shapes = painted(&drafter);
    let (at, words) = shapes
        .iter()
        .enumerate()
        .find_map(|(k, shape)| match shape {
            Shape::Text(text) if text.galley.text() == "same length" => {
                Some((k, text.visual_bounding_rect()))
            }
            _ => None,
        })
        .unwrap();
    let over = shapes[at..].iter().filter(|shape| match shape {
        Shape::Rect(rect) => rect.rect.width() < 15.0 && rect.rect.intersects(words),
        _ => false,
    });
    assert_eq!(over.count(), 0);
}

#[test]
fn what_is_selected_differs_from_what_is_pointed_at() {
    let mut drafter = two_panels();
    drafter.key(Key::V);
    drafter.click(drafter.place(0.05, 0.05));
    drafter.hover(drafter.place(0.16, 0.05));
    let style = drafter.window.ctx.style_of(egui::Theme::Light);
    let soft = style.visuals.selection.bg_fill;
    let filled = |drafter: &Drafter| {
        let shapes = painted(drafter);
        let of = shapes.iter().filter(|shape| match shape {
            Shape::Mesh(mesh) => {
                let is_soft = |vertex: &egui::epaint::Vertex| vertex.color == soft;
                !mesh.vertices.is_empty() && mesh.vertices.iter().all(is_soft)
            }
            _ => false,
        });
        of.count()
    };
    assert_eq!(filled(&drafter), 1);
}
