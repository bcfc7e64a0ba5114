//! Pictures of the window. They need a graphics adapter, of a card or of the processor; without
//! one they are skipped, and say so.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use eframe::egui_wgpu::WgpuSetup;
use eframe::wgpu::Backends;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use egui_kittest::wgpu::{WgpuTestRenderer, default_wgpu_setup};
use std::path::Path;
use std::task::{Context, Poll, Waker};
use std::time::Duration;
use toile_ui::{Beginning, ToileApp};

/// What a future of the graphics library gives: on a desktop they are ready when first asked.
fn ready<T>(future: impl Future<Output = T>) -> T {
    let mut future = std::pin::pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return value;
        }
        std::thread::yield_now();
    }
}

/// A renderer on this machine's adapter, if there is one. OpenGL is left out: without a display
/// it offers adapters that cannot draw.
fn renderer() -> Option<WgpuTestRenderer> {
    let backends = Backends::VULKAN | Backends::METAL | Backends::DX12;
    let mut setup = default_wgpu_setup();
    if let WgpuSetup::CreateNew(new) = &mut setup {
        new.instance_descriptor.backends = backends;
    }
    let instance = ready(setup.new_instance());
    let adapters = ready(instance.enumerate_adapters(backends));
    if adapters.is_empty() {
        println!("skipped: this machine has no graphics adapter");
        return None;
    }
    Some(WgpuTestRenderer::from_setup(setup))
}

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
