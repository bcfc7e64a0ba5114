//! Every view of the window at 1280 x 800, by day and by night: what belongs to it is there, whole inside the
//! window. Where `TOILE_SCREENS` names a folder and there is a graphics adapter, pictures are written there:
//!
//!     TOILE_SCREENS=$PWD/docs/screens cargo test -p toile-ui --test suite every_view::

use crate::drafter::Drafter;
use crate::screens::{Colours, Part, Screens};
use egui::{Key, Modifiers, Rect, pos2, vec2};
use egui_kittest::kittest::Queryable;
use std::path::PathBuf;
use toile_ui::Beginning;

const SIZE: egui::Vec2 = vec2(1280.0, 800.0);

/// A view: its picture's name, how it is reached from the pattern, and names that stand in it.
struct View {
    name: &'static str,
    reach: fn(&mut Drafter),
    shows: &'static [&'static str],
    /// What else is true of it.
    holds: fn(&Drafter) -> bool,
}

const VIEWS: &[View] = &[
    View {
        name: "pattern",
        reach: |_| {},
        shows: &["Pattern view", "Select", "3D view", "Drape"],
        holds: |_| true,
    },
    View {
        name: "panel",
        reach: |drafter| {
            let at = drafter.part("Panel front skirt");
            drafter.click(at);
        },
        shows: &["Name"],
        holds: |_| true,
    },
    View {
        name: "table-measurements",
        reach: |drafter| tables(drafter, "Measurements"),
        shows: &["Add size", "New measurement"],
        holds: |_| true,
    },
    View {
        name: "table-variables",
        reach: |drafter| tables(drafter, "Variables"),
        shows: &["New variable", "Add variable"],
        holds: |_| true,
    },
    View {
        name: "table-fabric",
        reach: |drafter| drafter.key(Key::F4),
        shows: &["Garment cut from"],
        holds: |_| true,
    },
    View {
        name: "table-wearer",
        reach: |drafter| drafter.key(Key::F3),
        shows: &["Woman", "Find measurement"],
        holds: |_| true,
    },
    View {
        name: "table-worn-with",
        reach: |drafter| drafter.chord(Modifiers::SHIFT, Key::F3),
        shows: &["Wear over", "Wear under"],
        holds: |_| true,
    },
    View {
        name: "table-history",
        reach: |drafter| tables(drafter, "History"),
        shows: &["History"],
        holds: |_| true,
    },
    View {
        name: "properties",
        reach: |drafter| drafter.choose("Pattern properties"),
        shows: &["Name"],
        holds: |_| true,
    },
    View {
        name: "sizes-overlaid",
        reach: |drafter| drafter.choose("All sizes"),
        shows: &["Pattern view"],
        holds: |drafter| drafter.window.state().view().grading.is_some(),
    },
    View {
        name: "marker-table",
        reach: |drafter| drafter.choose("Show marker"),
        shows: &["Marker view"],
        holds: |_| true,
    },
    View {
        name: "walk-seam",
        reach: |drafter| {
            drafter.choose("Walk seam");
            let at = drafter.part("Edge side_hip of front skirt");
            drafter.click(at);
        },
        shows: &["Pattern view"],
        holds: |drafter| drafter.status().contains("stays"),
    },
    View {
        name: "findings",
        reach: |drafter| drafter.choose("Findings"),
        shows: &["Pattern view"],
        holds: |drafter| {
            drafter
                .window
                .query_by_label("Nothing is wrong with this pattern.")
                .is_some()
        },
    },
    View {
        name: "dialog-find",
        reach: |drafter| drafter.choose("Find"),
        shows: &["Find a command, a part, a variable or a measurement"],
        holds: |_| true,
    },
    View {
        name: "dialog-words",
        reach: |drafter| drafter.key(Key::F1),
        shows: &["Find a word", "Close", "allowance"],
        holds: |_| true,
    },
    View {
        name: "dialog-export",
        reach: |drafter| drafter.choose("Export"),
        shows: &["Export"],
        holds: |_| true,
    },
    View {
        name: "dialog-print",
        reach: |drafter| drafter.choose("Print"),
        shows: &["Print"],
        holds: |_| true,
    },
    View {
        name: "dialog-open",
        reach: |drafter| drafter.choose("Open"),
        shows: &["Open a pattern", "File"],
        holds: |_| true,
    },
];

fn tables(drafter: &mut Drafter, tab: &str) {
    drafter.key(Key::F8);
    drafter.press(tab);
}

impl Drafter {
    /// Does a command, as its menu does.
    fn choose(&mut self, name: &str) {
        let command = toile_ui::named(name).unwrap();
        (command.does)(self.window.state_mut());
        self.window.run_ok();
    }

    /// Draws the whole window by day and by night.
    fn pictures(&mut self, name: &str, screens: Option<&Screens>) {
        let Some(screens) = screens else { return };
        for suffix in ["", "-dark"] {
            let picture = Part::of(&mut self.window, None);
            screens.write(&format!("{name}{suffix}"), &[picture], Colours::Few);
            self.choose("Dark or light");
        }
    }
}

/// The dress, its body made.
fn dress(renderer: Option<egui_kittest::wgpu::WgpuTestRenderer>) -> Drafter {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../patterns/dress.toile.json");
    let beginning = Beginning {
        file: Some(file),
        folder: None,
    };
    let mut drafter = Drafter::of_size(SIZE, beginning, renderer);
    drafter.wait(|drafter| drafter.window.state().stage().has_body());
    drafter
}

#[test]
fn every_view_has_what_belongs_to_it_inside_the_window() {
    let window = Rect::from_min_max(pos2(0.0, 0.0), SIZE.to_pos2());
    let mut faults = Vec::new();
    for view in VIEWS {
        let (screens, renderer) = Screens::asked().unzip();
        let mut drafter = dress(renderer);
        (view.reach)(&mut drafter);
        drafter.window.run_ok();
        for label in view.shows {
            let found: Vec<Rect> = drafter
                .window
                .query_all_by_label(label)
                .map(|node| node.rect())
                .collect();
            if !found.iter().any(|rect| window.contains_rect(*rect)) {
                faults.push(format!("{}: {label}: {found:?}", view.name));
            }
        }
        if !(view.holds)(&drafter) {
            faults.push(format!("{} is not there: {}", view.name, drafter.status()));
        }
        drafter.pictures(view.name, screens.as_ref());
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn the_first_page_shows_patterns_by_their_pieces() {
    let (screens, renderer) = Screens::asked().unzip();
    let mut drafter = Drafter::of_size(SIZE, Beginning::default(), renderer);
    drafter.wait(|drafter| !drafter.window.ctx.has_requested_repaint());
    for card in ["New pattern", "T-shirt", "Trousers", "Dress"] {
        let found = drafter.window.query_by_label(card);
        assert!(found.is_some(), "{card}");
    }
    drafter.pictures("first-page", screens.as_ref());
    drafter.press("Trousers");
    assert_eq!(drafter.pattern().name, "Trousers");
}
