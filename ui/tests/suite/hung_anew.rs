//! A garment whose wearer, size or cloth is another now hangs anew by itself, on the right body or with the
//! reason why not.

use crate::worn::{Window, chord, hanging, is_at_rest, press, says, wait};
use egui::Key;
use egui_kittest::kittest::Queryable;
use std::path::PathBuf;
use toile_pattern::plan;
use toile_session::{Command, Figure};

/// A deterministic source of choices (Marsaglia 2003, xorshift).
struct Choices(u64);

impl Choices {
    fn below(&mut self, count: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % count as u64) as usize
    }
}

fn shipped(name: &str) -> PathBuf {
    let patterns = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../patterns");
    patterns.join(format!("{name}.toile.json"))
}

/// No cloth is seen on a body that it was not made for; cloth that waits for its successor is on none.
fn is_honest(window: &Window) -> bool {
    let stage = window.state().stage();
    if says(window, "Cutting the cloth") {
        return stage.is_out_of_date() && stage.seen_body().is_none();
    }
    let (Some(garment), Some(seen)) = (stage.garment(), stage.seen_body()) else {
        return true;
    };
    let own = garment.setup.colliders[0].mesh().bounds().unwrap();
    own == seen
}

/// The garment that is seen is made for the wearer of the present project.
fn is_on_wearer(window: &Window) -> bool {
    let stage = window.state().stage();
    let mut session = window.state().session().snapshot();
    let wearer = session.mannequin().unwrap();
    let garment = stage.garment().unwrap();
    let own = garment.setup.colliders[0].mesh();
    own.positions == wearer.skin().positions && garment.revision == session.revision()
}

/// Changes size, wearer or a measurement.
fn change(window: &mut Window, choices: &mut Choices) {
    let pattern = window.state().session().project().pattern.clone();
    let sizes = &pattern.sizes;
    let command = match choices.below(4) {
        0 => Command::SetSize {
            size: Some(sizes[choices.below(sizes.len())].name.clone()),
        },
        1 => Command::SetBody {
            figure: [Some(Figure::Woman), Some(Figure::Mean), None][choices.below(3)],
            measurements: None,
        },
        2 => {
            let shown = window.state().session().project().size.clone();
            let size = shown.and_then(|name| pattern.size_named(&name).map(|size| size.id));
            let size = size.or(pattern.base().map(|size| size.id)).unwrap();
            let waist = pattern.sizes[0].measurements.get("waist").unwrap();
            let waist = waist + 0.01 * choices.below(5) as f64;
            let base = window.state().base();
            Command::Edit {
                edits: plan::set_measurement(base, size, "waist", Some(waist)).unwrap(),
                label: "Set measurement".into(),
            }
        }
        _ if window.state().session().can_undo().is_some() => Command::Undo,
        _ => Command::SetSize { size: None },
    };
    window.state_mut().execute(command);
}

/// Changes one after the other, each after some frames.
fn changes(name: &str, count: usize, seed: u64) {
    let mut window = hanging(&shipped(name));
    let mut choices = Choices(seed);
    for k in 0..count {
        let before = window.state().session().project().clone();
        change(&mut window, &mut choices);
        window.step();
        assert!(is_honest(&window), "change {k} of {name}");
        let now = window.state().session().project();
        if !before.has_same_body(now) {
            assert!(
                says(&window, "Cutting the cloth"),
                "change {k} of {name}: it does not say that it works"
            );
        }
        for _ in 0..[0, 3, 40, 150][choices.below(4)] {
            window.step();
            assert!(is_honest(&window), "after change {k} of {name}");
            std::thread::sleep(std::time::Duration::from_millis(3));
        }
    }
    let rests = |window: &Window| {
        assert!(is_honest(window), "on the way to rest, {name}");
        is_at_rest(window)
    };
    assert!(wait(&mut window, rests), "{name} does not come to rest");
    assert!(is_on_wearer(&window), "{name} hangs on another body");
}

/// Random changes of each garment, 10 unless `TOILE_CHANGES` says more.
fn count() -> usize {
    let asked = std::env::var("TOILE_CHANGES").ok();
    asked.and_then(|count| count.parse().ok()).unwrap_or(10)
}

#[test]
fn a_t_shirt_changed_at_random_ends_at_rest_on_the_body_chosen_last() {
    changes("t-shirt", count(), 0x2026_1127);
}

#[test]
fn a_dress_changed_at_random_ends_at_rest_on_the_body_chosen_last() {
    changes("dress", count(), 0x48_0002);
}

/// A body that no garment fits takes the cloth off and says why; with the next one that can be, the garment
/// hangs again.
#[test]
fn what_cannot_be_made_any_more_is_taken_off_with_the_reason_and_comes_back_by_itself() {
    let mut window = hanging(&shipped("t-shirt"));
    let pattern = window.state().session().project().pattern.clone();
    let size = pattern.base().unwrap().id;
    let impossible = plan::set_measurement(window.state().base(), size, "bust", Some(0.02));
    let edits = impossible.unwrap();
    let label = "Set measurement".to_owned();
    window.state_mut().execute(Command::Edit { edits, label });
    let is_told = |window: &Window| {
        assert!(is_honest(window));
        says(window, "It does not hang") && window.state().stage().garment().is_none()
    };
    assert!(wait(&mut window, is_told));
    chord(&mut window, Key::Z);
    assert!(wait(&mut window, is_at_rest));
    assert!(is_on_wearer(&window));
    // Stopped before it hangs, there is the new wearer alone.
    let size = Some(pattern.sizes[0].name.clone());
    window.state_mut().execute(Command::SetSize { size });
    window.step();
    press(&mut window, "Stop");
    let is_bare = |window: &Window| {
        let stage = window.state().stage();
        let mut session = window.state().session().snapshot();
        let wearer = session.mannequin().unwrap().skin().bounds();
        stage.garment().is_none() && stage.seen_body() == wearer
    };
    assert!(wait(&mut window, is_bare));
    assert!(
        window
            .query_by_label_contains("Cutting the cloth")
            .is_none()
    );
}
