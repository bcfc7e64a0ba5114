//! Pictures of the window. They need a graphics adapter, of a card or of the processor; without
//! one they are skipped, and say so.

use crate::screens::renderer;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use std::time::Duration;
use toile_ui::{Beginning, ToileApp};

#[test]
fn the_pattern_and_the_mannequin_are_drawn() {
    let Some(renderer) = renderer() else { return };
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../patterns/t-shirt.toile.json");
    let beginning = Beginning {
        file: Some(file),
        folder: None,
    };
    let mut window = Harness::builder()
        .with_size(egui::vec2(1200.0, 800.0))
        .with_theme(egui::Theme::Light)
        .renderer(renderer)
        .build_eframe(move |creation| {
            let state = creation.wgpu_render_state.as_ref();
            ToileApp::new(&creation.egui_ctx, state, beginning)
        });
    for _ in 0..600 {
        window.step();
        if window.state().stage().has_body() {
            break;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    window.step();
    let picture = window.render().unwrap();
    let colours = |label: &str| {
        let area = window.get_by_label(label).rect().shrink(4.0);
        let mut seen = std::collections::BTreeMap::new();
        for y in area.top() as u32..area.bottom() as u32 {
            for x in area.left() as u32..area.right() as u32 {
                *seen.entry(picture.get_pixel(x, y).0).or_insert(0) += 1;
            }
        }
        seen
    };
    // Table, paper, mirrored paper, ink and ten seams, with their antialiased mixtures.
    let table = colours("Pattern view");
    assert!(table.len() > 50, "{} colours", table.len());
    assert!(
        table[&[0xFE, 0xFD, 0xFA, 255]] > 20_000,
        "the panels are filled"
    );
    // The mannequin is shaded smoothly over a good part of the view, the background is one colour.
    let stage = colours("3D view");
    let background: usize = stage[&[0xE4, 0xE6, 0xE7, 255]];
    let all: usize = stage.values().sum();
    assert!(
        background * 3 > all && background * 10 < all * 9,
        "{background} of {all}"
    );
    assert!(stage.len() > 500, "{} shades", stage.len());
}
