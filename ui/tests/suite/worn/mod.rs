//! A window in which a garment hangs, without a display.

use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::time::{Duration, Instant};
use toile_session::{Command, Quality};
use toile_ui::{Beginning, ToileApp};

pub type Window = Harness<'static, ToileApp>;

/// A pattern in a window, its garment coarsely meshed and hanging at rest.
pub fn hanging(file: &Path) -> Window {
    hanging_begun(Beginning {
        file: Some(file.to_owned()),
        folder: None,
    })
}

/// The same in a window that begins as is said.
pub fn hanging_begun(beginning: Beginning) -> Window {
    let mut window: Window = Harness::builder()
        .with_size(vec2(1200.0, 800.0))
        .with_theme(egui::Theme::Light)
        .with_max_steps(20)
        .with_step_dt(1.0 / 60.0)
        .build_eframe(move |creation| ToileApp::new(&creation.egui_ctx, None, beginning));
    window.run();
    let quality = Quality::Preview;
    window.state_mut().execute(Command::SetQuality { quality });
    press(&mut window, "Drape");
    let hangs = |window: &Window| is_at_rest(window) && window.state().session().draped().is_some();
    assert!(wait(&mut window, hangs), "no garment came to rest");
    window
}

pub fn press(window: &mut Window, name: &str) {
    window.get_by_label(name).click();
    window.run_ok();
}

pub fn chord(window: &mut Window, key: Key) {
    window.key_press_modifiers(Modifiers::COMMAND, key);
    window.run_ok();
}

/// Runs frames until something holds, two minutes at the most.
pub fn wait(window: &mut Window, holds: impl Fn(&Window) -> bool) -> bool {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(120) {
        window.step();
        if holds(window) {
            return true;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    false
}

pub fn says(window: &Window, words: &str) -> bool {
    window.query_by_label_contains(words).is_some()
}

pub fn is_at_rest(window: &Window) -> bool {
    says(window, "At rest after") && !is_grey(window)
}

pub fn is_grey(window: &Window) -> bool {
    let is_grey = window.state().stage().is_out_of_date();
    assert_eq!(is_grey, says(window, "vertices, out of date"));
    is_grey
}
