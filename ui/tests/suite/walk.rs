//! A seam walked in the window: the ghost of the second piece, the lines that cross the seam, by
//! pointer, keys and typed distances. The document stays as it is.

use crate::drafter::Drafter;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use toile_geometry::{Vec2, closest_on_segment};
use toile_pattern::plan;
use toile_session::Command;
use toile_ui::{LineStep, Overlay, Pointer, Tone, ToolEvent, ToolModifiers};

/// The T-shirt with the shoulder seam of the wearer's left selected and walked.
fn walking() -> Drafter {
    let mut drafter = Drafter::opened("t-shirt");
    let edge = drafter.part("Edge shoulder of front");
    drafter.click(edge);
    drafter.chord(Modifiers::SHIFT, Key::X);
    drafter.key(Key::W);
    drafter
}

fn overlay(drafter: &Drafter) -> Vec<Overlay> {
    drafter.window.state().view().overlay(&drafter.evaluation())
}

/// Words on the canvas.
fn words(drafter: &Drafter) -> Vec<(String, Tone)> {
    let all = overlay(drafter).into_iter();
    let labels = all.filter_map(|mark| match mark {
        Overlay::Label(_, words, tone) => Some((words, tone)),
        _ => None,
    });
    labels.collect()
}

/// Where the pieces touch on the table (m).
fn touch(drafter: &Drafter) -> Vec2 {
    let all = overlay(drafter).into_iter();
    let mut touches = all.filter_map(|mark| match mark {
        Overlay::Touch(at) => Some(at),
        _ => None,
    });
    touches.next().unwrap()
}

/// The outline of the ghost on the table (m).
fn ghost(drafter: &Drafter) -> Vec<Vec2> {
    let all = overlay(drafter).into_iter();
    let mut ghosts = all.filter_map(|mark| match mark {
        Overlay::Ghost(mut rings, _) => Some(rings.swap_remove(0)),
        _ => None,
    });
    ghosts.next().unwrap()
}

/// How far the middle of the ghost's corners lies above a place (m): beyond a shoulder line, while
/// the piece that stays hangs below it.
fn above(ring: &[Vec2], at: Vec2) -> f64 {
    let sum: f64 = ring.iter().map(|corner| corner.y - at.y).sum();
    sum / ring.len() as f64
}

/// How far the walk has come on the first piece, in words.
fn told(drafter: &Drafter) -> String {
    let last = words(drafter).pop();
    last.unwrap().0
}

#[test]
fn the_second_piece_lies_against_the_first_and_the_document_stays() {
    let mut drafter = walking();
    let before = drafter.pattern();
    assert!(drafter.status().contains("front stays: point or drag"));
    let at = touch(&drafter);
    let nearest = |ring: &[Vec2]| {
        let away = ring.iter().map(|p| (p - at).norm());
        away.fold(f64::INFINITY, f64::min)
    };
    assert!(nearest(&ghost(&drafter)) < 1e-9, "its corner touches");
    assert!(above(&ghost(&drafter), at) > 0.1);
    let told = words(&drafter);
    for line in ["armhole across left shoulder", "neck across left shoulder"] {
        assert!(
            told.iter().any(|(words, _)| words.starts_with(line)),
            "{line}: {told:?}"
        );
    }
    for key in [
        Key::End,
        Key::Home,
        Key::ArrowRight,
        Key::Tab,
        Key::ArrowLeft,
    ] {
        drafter.key(key);
    }
    drafter.typed("3");
    drafter.key(Key::Escape);
    assert!(overlay(&drafter).is_empty(), "Escape puts it down");
    assert_eq!(drafter.pattern(), before);
    assert!(!drafter.window.state().is_unsaved());
    assert_eq!(drafter.window.state().session().can_undo(), None);
}

#[test]
fn keys_and_numbers_say_how_far() {
    let mut drafter = walking();
    drafter.key(Key::Home);
    let start = touch(&drafter);
    assert!(told(&drafter).starts_with("front 0 cm, back 0 cm: no difference"));
    drafter.key(Key::ArrowRight);
    drafter.key(Key::ArrowUp);
    assert!(
        told(&drafter).starts_with("front 2 cm"),
        "{}",
        told(&drafter)
    );
    assert!(((touch(&drafter) - start).norm() - 0.02).abs() < 1e-4);
    drafter.key(Key::ArrowLeft);
    assert!(told(&drafter).starts_with("front 1 cm"));
    drafter.type_text("4,5");
    assert_eq!(told(&drafter), "distance 4,5|");
    assert!(
        ((touch(&drafter) - start).norm() - 0.045).abs() < 1e-4,
        "shown while typed"
    );
    drafter.key(Key::Escape);
    assert!(
        told(&drafter).starts_with("front 1 cm"),
        "a step back, not down"
    );
    drafter.typed("4.5");
    assert!(told(&drafter).starts_with("front 4.5 cm"));
    drafter.typed("900");
    let fault = drafter
        .window
        .state()
        .fault()
        .unwrap_or_default()
        .to_owned();
    assert!(fault.contains("type a distance from 0 to that"), "{fault}");
    drafter.key(Key::End);
    let whole = told(&drafter);
    drafter.key(Key::ArrowRight);
    assert_eq!(told(&drafter), whole, "it ends where the seam ends");
}

#[test]
fn tab_lets_the_other_piece_stay() {
    let mut drafter = walking();
    drafter.key(Key::Home);
    let (at, ring) = (touch(&drafter), ghost(&drafter));
    drafter.key(Key::Tab);
    assert!(drafter.status().contains("back stays"));
    assert!((touch(&drafter) - at).norm() > 0.05, "on the back");
    let other = ghost(&drafter);
    let size = |ring: &[Vec2]| {
        let reach = ring.iter().map(|p| (p - ring[0]).norm());
        reach.fold(0.0, f64::max)
    };
    assert!((size(&ring) - size(&other)).abs() > 1e-6, "another piece");
    drafter.key(Key::Tab);
    assert!((touch(&drafter) - at).norm() < 1e-12);
}

#[test]
fn both_pieces_are_seen_from_the_beginning_and_the_table_stays() {
    let mut drafter = Drafter::opened("t-shirt");
    let edge = drafter.part("Edge shoulder of front");
    drafter.click(edge);
    drafter.chord(Modifiers::SHIFT, Key::X);
    let before = drafter.window.state().view().camera;
    drafter.key(Key::W);
    let camera = drafter.window.state().view().camera;
    assert!(camera != before && camera.scale <= before.scale);
    let view = drafter.window.get_by_label("Pattern view").rect();
    for key in [Key::Home, Key::ArrowRight, Key::End, Key::Tab, Key::Tab] {
        drafter.key(key);
        let state = drafter.window.state().view();
        assert_eq!(state.camera, camera, "{key:?}");
        if key != Key::Tab {
            let mut ring = ghost(&drafter).into_iter();
            assert!(ring.all(|at| view.contains(state.screen(view, Vec2::zeros(), at))));
        }
    }
    // What is seen is left as it is.
    drafter.key(Key::Escape);
    drafter.key(Key::W);
    assert_eq!(drafter.window.state().view().camera, camera);
}

#[test]
fn what_keys_lead_to_is_brought_into_view() {
    let mut drafter = walking();
    drafter.key(Key::Home);
    let view = drafter.window.get_by_label("Pattern view").rect();
    let seen = |drafter: &Drafter| {
        let state = drafter.window.state().view();
        view.contains(state.screen(view, Vec2::zeros(), touch(drafter)))
    };
    let place = {
        let state = drafter.window.state().view();
        state.screen(view, Vec2::zeros(), touch(&drafter))
    };
    drafter.hover(place);
    drafter.key(Key::Home);
    for _ in 0..12 {
        drafter.window.event(egui::Event::Zoom(1.4));
        drafter.window.run();
    }
    assert!(seen(&drafter));
    let centre = drafter.window.state().view().camera.centre;
    drafter.key(Key::Tab);
    assert_ne!(drafter.window.state().view().camera.centre, centre);
    assert!(seen(&drafter), "the back lies elsewhere on the table");
    drafter.key(Key::Tab);
    assert!(seen(&drafter));
}

#[test]
fn the_pointer_leads_along_the_seam_near_it_and_when_it_is_dragged() {
    let mut drafter = walking();
    drafter.key(Key::Home);
    let start = touch(&drafter);
    let on_screen = |drafter: &Drafter, at: Vec2| {
        let view = drafter.window.get_by_label("Pattern view").rect();
        let state = drafter.window.state().view();
        state.screen(view, Vec2::zeros(), at)
    };
    drafter.key(Key::End);
    let middle = (start + touch(&drafter)) * 0.5;
    let place = on_screen(&drafter, middle);
    drafter.hover(place + egui::vec2(0.0, 20.0));
    assert!((touch(&drafter) - middle).norm() < 0.02, "near it");
    let here = touch(&drafter);
    drafter.hover(place + egui::vec2(0.0, 300.0));
    assert!((touch(&drafter) - here).norm() < 1e-12, "far from it");
    let goal = on_screen(&drafter, start);
    drafter.window.drag_at(place + egui::vec2(0.0, 300.0));
    drafter.window.run();
    drafter.window.hover_at(goal);
    drafter.window.run();
    drafter.window.drop_at(goal);
    drafter.window.run();
    assert!(
        (touch(&drafter) - start).norm() < 2e-3,
        "dragged from anywhere"
    );
}

/// The T-shirt with its front longer at the side: the hem turns across both side seams.
fn kinked() -> Drafter {
    let mut drafter = Drafter::opened("t-shirt");
    let pattern = drafter.pattern();
    let sheet = pattern.panel_named("front").unwrap().sheet().unwrap();
    let hem = pattern
        .sheet(sheet)
        .unwrap()
        .point_named("hem_side")
        .unwrap()
        .id;
    let evaluation = drafter.evaluation();
    let goal = evaluation.point(hem).unwrap() + Vec2::new(0.0, -0.05);
    let edits = plan::move_point(&evaluation, hem, goal).unwrap();
    let label = "Move point".to_owned();
    drafter
        .window
        .state_mut()
        .execute(Command::Edit { edits, label });
    drafter.window.run();
    drafter
}

#[test]
fn a_kink_has_its_sign_at_the_end_of_its_seam() {
    let drafter = kinked();
    let signs = drafter
        .window
        .query_all_by_role(egui::Role::Button)
        .filter(|node| {
            let label = node.accesskit_node().label();
            label.is_some_and(|label| label.contains("hem turns by"))
        });
    let signs: Vec<egui::Rect> = signs.map(|sign| sign.rect()).collect();
    assert_eq!(signs.len(), 2, "{}", drafter.status());
    let state = drafter.window.state();
    let scene = &state.view().scene;
    let front = scene.panels.iter().find(|panel| panel.name == "front");
    let bounds = front.unwrap().bounds();
    for x in [bounds.min.x, bounds.max.x] {
        // Corners of the hem: the lowest at both sides.
        let corner = drafter.place(x, bounds.min.y);
        let is_near = |sign: &&egui::Rect| sign.center().distance(corner) < 40.0;
        assert_eq!(
            signs.iter().filter(is_near).count(),
            1,
            "{signs:?} {corner:?}"
        );
    }
}

#[test]
fn a_kink_is_told_in_words_and_colour_on_the_canvas_and_beside_it() {
    let mut drafter = kinked();
    drafter.key(Key::W);
    let side = drafter.part("Edge side of front");
    drafter.click(side);
    let told = words(&drafter);
    let hem = told
        .iter()
        .find(|(words, _)| words.starts_with("hem across left side"));
    assert!(hem.is_some(), "{told:?} {}", drafter.status());
    let (hem, tone) = hem.unwrap();
    assert!(hem.contains("kink") && hem.contains("\u{b0}"), "{hem}");
    assert!(hem.contains("a peak"), "longer at the side: {hem}");
    assert_eq!(*tone, Tone::Fault);
    assert!(
        drafter.window.query_by_label(hem).is_some(),
        "in the inspector"
    );
}

#[test]
fn without_a_selection_an_edge_is_clicked() {
    let mut drafter = Drafter::opened("dress");
    drafter.key(Key::W);
    assert!(drafter.status().contains("Click a sewn edge"));
    assert!(overlay(&drafter).is_empty());
    let shoulder = drafter.pattern();
    let panel = &shoulder.panels[0];
    let seam = shoulder
        .seams
        .iter()
        .find(|seam| seam.name == "left side")
        .unwrap();
    let named = panel.edges().find(|edge| {
        let span = panel.span(edge.id).unwrap();
        span.from == seam.sides[0][0].from && span.to == seam.sides[0][0].to
    });
    let name = format!("Edge {} of {}", named.unwrap().name, panel.name);
    let edge = drafter.part(&name);
    drafter.click(edge);
    assert!(!ghost(&drafter).is_empty());
    assert!(
        words(&drafter)
            .iter()
            .any(|(words, _)| words.contains("across left side"))
    );
}

#[test]
fn whatever_is_done_the_document_stays_and_the_pieces_touch() {
    let mut drafter = walking();
    let before = drafter.pattern();
    let evaluation = drafter.evaluation();
    let mut seed: u32 = 7;
    let mut next = |below: u32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 16) % below
    };
    for _ in 0..400 {
        let at = Vec2::new(
            f64::from(next(100)) * 0.01 - 0.3,
            f64::from(next(100)) * 0.01 - 0.8,
        );
        let state = drafter.window.state_mut();
        let pointer = state.view().pointer(at, ToolModifiers::default());
        let event = match next(11) {
            0 => ToolEvent::Hover(pointer),
            1 => ToolEvent::Drag(pointer.clone(), pointer),
            // Beside all edges: on another seam it would be that which is walked.
            2 => ToolEvent::Click(Pointer {
                hits: Vec::new(),
                ..pointer
            }),
            3 => ToolEvent::Go(LineStep::On),
            4 => ToolEvent::Go(LineStep::Back),
            5 => ToolEvent::Go([LineStep::ToStart, LineStep::ToEnd][next(2) as usize]),
            6 => ToolEvent::Text(["3", ".", "-", "cm", "=waist", "("][next(6) as usize].into()),
            7 => ToolEvent::Enter,
            8 => ToolEvent::Backspace,
            9 => ToolEvent::Tab,
            _ => ToolEvent::Leave,
        };
        state.give(&event);
        let marks = state.view().overlay(&evaluation);
        let touch = marks.iter().find_map(|mark| match mark {
            Overlay::Touch(at) => Some(*at),
            _ => None,
        });
        let ring = marks.iter().find_map(|mark| match mark {
            Overlay::Ghost(rings, _) => rings.first(),
            _ => None,
        });
        let (touch, ring) = (touch.unwrap(), ring.unwrap());
        let away = (0..ring.len()).map(|k| {
            let side = [ring[k], ring[(k + 1) % ring.len()]];
            (closest_on_segment(touch, side) - touch).norm()
        });
        let away = away.fold(f64::INFINITY, f64::min);
        assert!(away < 1e-4, "{event:?}: {away}");
        assert!(above(ring, touch) > 0.1, "{event:?}");
    }
    assert_eq!(drafter.pattern(), before);
    assert_eq!(drafter.window.state().session().can_undo(), None);
}

#[test]
fn a_click_on_another_seam_takes_it_up() {
    let mut drafter = walking();
    drafter.key(Key::End);
    let across = |drafter: &Drafter, seam: &str| {
        let told = words(drafter);
        told.iter().any(|(words, _)| words.contains(seam))
    };
    assert!(across(&drafter, "across left shoulder"));
    // On the seam that is walked a click leads along it.
    let shoulder = drafter.part("Edge shoulder of front");
    drafter.click(shoulder);
    assert!(across(&drafter, "across left shoulder"));
    let side = drafter.part("Edge side of front");
    drafter.click(side);
    assert!(
        across(&drafter, "across left side"),
        "{:?}",
        words(&drafter)
    );
    assert!(!across(&drafter, "across left shoulder"));
    // On no seam it leads along the one that is walked.
    let view = drafter.window.get_by_label("Pattern view").rect();
    drafter.click(view.left_bottom() + egui::vec2(60.0, -40.0));
    assert!(across(&drafter, "across left side"));
    assert_eq!(drafter.window.state().session().can_undo(), None);
}

#[test]
fn panning_and_walking_measure_and_flatten_nothing_anew() {
    let mut drafter = walking();
    let seen = |drafter: &Drafter| {
        let app = drafter.window.state();
        (app.view().scene.made(), app.session().revision())
    };
    let before = seen(&drafter);
    let view = drafter.window.get_by_label("Pattern view").rect();
    let camera = drafter.window.state().view().camera;
    for k in 0..12 {
        let at = view.center() + egui::vec2(3.0 * k as f32, 2.0);
        drafter.window.event(egui::Event::PointerMoved(at));
        if k == 0 || k == 11 {
            drafter.window.event(egui::Event::PointerButton {
                pos: at,
                button: egui::PointerButton::Middle,
                pressed: k == 0,
                modifiers: Modifiers::NONE,
            });
        }
        drafter.window.run();
    }
    assert_ne!(drafter.window.state().view().camera, camera);
    assert_eq!(seen(&drafter), before);
    for key in [Key::Home, Key::ArrowRight, Key::Tab, Key::End] {
        drafter.key(key);
    }
    assert_eq!(seen(&drafter), before);
    // Another seam is measured once.
    let side = drafter.part("Edge side of front");
    drafter.click(side);
    let once = seen(&drafter);
    assert!(once.0 > before.0);
    drafter.key(Key::Home);
    assert_eq!(seen(&drafter), once);
}
