//! A garment that hangs in the window follows the edits of its pattern, or stands grey and says why.

use crate::garments;
use crate::worn::{Window, chord, hanging, hanging_begun, is_at_rest, is_grey, press, says, wait};
use egui::{Key, Modifiers, Role, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use std::path::Path;
use toile_session::{Command, Quality, Session, Silent};
use toile_ui::{Beginning, Item};

/// Drags a point of the front by a way (mm).
fn drag(window: &mut Window, point: &str, [x, y]: [f32; 2]) {
    let scale = window.state().view().camera.scale as f32;
    let name = format!("Point {point} of front");
    let part = window.get_by_role_and_label(Role::Button, &name);
    let from = part.rect().center();
    let way = vec2(x, -y) * scale * 1e-3;
    window.hover_at(from);
    window.drag_at(from);
    window.run_ok();
    for k in 1..=4 {
        window.hover_at(from + way * (k as f32 / 4.0));
        window.run_ok();
    }
    window.drop_at(from + way);
    window.step();
}

/// Garment, pictures and report of a session, without the way it came to them.
fn exported(session: &mut Session, dir: &Path) -> std::collections::BTreeMap<String, Vec<u8>> {
    let dir = dir.to_owned();
    let mut commands = vec![Command::Check, Command::Nest, Command::Assemble];
    commands.extend([Command::drape(), Command::export(&dir)]);
    session.execute_all(&commands, &mut Silent).unwrap();
    let mut files = garments::lasting(&dir);
    assert!(files.remove("journal.jsonl").is_some());
    assert!(files.contains_key("garment.glb"));
    files
}

#[test]
fn a_moved_point_moves_the_garment_that_hangs_and_what_is_exported_is_made_from_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = garments::band(folder.path());
    let mut window = hanging(&file);
    let product = window.state().session().draped();
    // Up by 5 mm, a millimetre a key.
    press(&mut window, "Point d of front");
    let revision = window.state().session().revision();
    let mut moved = false;
    for _ in 0..5 {
        window.key_press(Key::ArrowUp);
        window.step();
        moved |= says(&window, "Moving:");
    }
    assert!(moved || wait(&mut window, |window| says(window, "Moving:")));
    assert_eq!(window.state().session().revision(), revision + 5);
    assert!(!is_grey(&window));
    assert!(wait(&mut window, is_at_rest));
    // How it hangs came of its way.
    assert_eq!(window.state().session().draped(), None);

    chord(&mut window, Key::S);
    assert!(!window.state().is_unsaved());
    let mut session = window.state().session().snapshot();
    let mut made = Session::new();
    let quality = Quality::Preview;
    for command in [Command::open(file), Command::SetQuality { quality }] {
        made.execute(command, &mut Silent).unwrap();
    }
    let [here, there] = ["here", "there"].map(|name| folder.path().join(name));
    let (here, there) = (exported(&mut session, &here), exported(&mut made, &there));
    assert_eq!(
        here.keys().collect::<Vec<_>>(),
        there.keys().collect::<Vec<_>>()
    );
    for (name, bytes) in &here {
        assert!(*bytes == there[name], "{name} differs");
    }

    // Undone it hangs as the pattern first was, and that is no product either.
    let mut moved = false;
    for _ in 0..5 {
        window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        window.step();
        // It may be at rest again before the last of them is undone.
        moved |= says(&window, "Moving:");
    }
    assert!(moved || wait(&mut window, |window| says(window, "Moving:")));
    assert!(wait(&mut window, is_at_rest));
    assert!(
        window
            .state()
            .session()
            .can_undo()
            .is_some_and(|step| step != "Move point")
    );
    assert_eq!(window.state().session().draped(), None);
    press(&mut window, "Drape");
    let made = |window: &Window| window.state().session().draped().is_some();
    assert!(wait(&mut window, made));
    assert_eq!(window.state().session().draped(), product);
}

#[test]
fn a_removed_panel_leaves_the_garment_grey_and_offers_to_hang_it_again() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = hanging(&garments::band(folder.path()));
    let pattern = window.state().session().project().pattern.clone();
    let front = pattern.panel_named("front").unwrap().id;
    assert!(!is_grey(&window));
    press(&mut window, "Panel front");
    assert_eq!(
        window.state().view().selection.single(),
        Some(Item::Panel(front))
    );
    window.key_press(Key::Delete);
    window.step();
    let stands = |window: &Window| {
        is_grey(window) && says(window, "Out of date: the pattern has other panels now")
    };
    assert!(wait(&mut window, stands));
    let removed = &window.state().session().project().pattern;
    assert!(removed.panel(front).is_none());
    let again = window.get_by_role_and_label(Role::Button, "Drape");
    assert!(!again.accesskit_node().is_disabled());
    // Nothing moves, and no frame is asked for.
    let pause = window.get_by_role_and_label(Role::Button, "Pause");
    assert!(pause.accesskit_node().is_disabled());
    chord(&mut window, Key::Z);
    assert!(wait(&mut window, is_at_rest));

    // Another mesh of the cloth hangs anew by itself.
    let quality = Quality::Fit;
    window.state_mut().execute(Command::SetQuality { quality });
    let is_meshed = |window: &Window| is_grey(window) && says(window, "Cutting the cloth");
    assert!(wait(&mut window, is_meshed));
    assert!(wait(&mut window, |window| {
        is_at_rest(window) && window.state().session().draped().is_some()
    }));
}

#[test]
fn a_fault_leaves_the_garment_grey_until_it_is_mended() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = hanging(&garments::band(folder.path()));
    drag(&mut window, "d", [0.0, -160.0]);
    let stands =
        |window: &Window| is_grey(window) && says(window, "Out of date: the pattern has faults");
    assert!(wait(&mut window, stands));
    drag(&mut window, "d", [0.0, 165.0]);
    assert!(wait(&mut window, is_at_rest));
}

#[test]
fn what_changes_nothing_of_the_cloth_leaves_the_garment_at_rest() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = hanging(&garments::band(folder.path()));
    let product = window.state().session().draped();
    let name = window.get_by_role_and_label(Role::Button, "Panel front");
    let from = name.rect().center();
    window.hover_at(from);
    window.drag_at(from);
    window.run_ok();
    for k in 1..=4 {
        window.hover_at(from + vec2(10.0, 5.0) * k as f32);
        window.run_ok();
    }
    window.drop_at(from + vec2(40.0, 20.0));
    window.run_ok();
    assert!(window.state().session().can_undo().is_some());
    assert!(wait(&mut window, is_at_rest));
    assert_eq!(window.state().session().draped(), product);
    assert!(!says(&window, "Moving:"));
}

#[test]
fn the_garment_as_it_hung_is_kept_for_the_first_page() {
    let folder = tempfile::tempdir().unwrap();
    let states = folder.path().join("states");
    let mut window = hanging_begun(Beginning {
        file: Some(garments::band(folder.path())),
        folder: Some(states.clone()),
    });
    let kept = || {
        let entries = std::fs::read_dir(states.join("drapes"))
            .into_iter()
            .flatten();
        let mut pictures = entries.map(|entry| entry.unwrap().path());
        pictures.find(|path| path.extension().is_some_and(|ending| ending == "png"))
    };
    assert!(wait(&mut window, |_| kept().is_some()));
    let file = std::io::BufReader::new(std::fs::File::open(kept().unwrap()).unwrap());
    let mut picture = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; picture.output_buffer_size().unwrap()];
    let frame = picture.next_frame(&mut bytes).unwrap();
    assert_eq!((frame.width, frame.height), (240, 360));
    let colours: std::collections::BTreeSet<&[u8]> = bytes.chunks(3).collect();
    assert!(colours.len() > 100, "{}", colours.len());
}
