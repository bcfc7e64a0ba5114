//! Pictures of the window: a renderer for tests, and files.

mod colours;

use eframe::egui_wgpu::WgpuSetup;
use eframe::wgpu::Backends;
use egui::Rect;
use egui_kittest::Harness;
use egui_kittest::wgpu::{WgpuTestRenderer, default_wgpu_setup};
use std::path::PathBuf;
use std::task::{Context, Poll, Waker};
use toile_ui::ToileApp;

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
pub fn renderer() -> Option<WgpuTestRenderer> {
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

/// A folder that pictures are written to.
pub struct Screens {
    folder: PathBuf,
}

impl Screens {
    /// The folder that `TOILE_SCREENS` names, and a renderer; nothing where one of them is missing.
    pub fn asked() -> Option<(Self, WgpuTestRenderer)> {
        let Some(folder) = std::env::var_os("TOILE_SCREENS") else {
            println!("without pictures: TOILE_SCREENS names no folder for them");
            return None;
        };
        let folder = PathBuf::from(folder);
        std::fs::create_dir_all(&folder).unwrap();
        Some((Self { folder }, renderer()?))
    }

    /// Writes parts of the window side by side as a PNG.
    pub fn write(&self, name: &str, parts: &[Part], colours: Colours) {
        let height = parts.iter().map(|part| part.height).min().unwrap();
        let width: usize = parts.iter().map(|part| part.width).sum();
        let mut pixels = Vec::new();
        for y in 0..height {
            for part in parts {
                pixels.extend_from_slice(&part.pixels[y * part.width..][..part.width]);
            }
        }
        let file = std::fs::File::create(self.folder.join(format!("{name}.png"))).unwrap();
        let file = std::io::BufWriter::new(file);
        let mut encoder = png::Encoder::new(file, width as u32, height as u32);
        encoder.set_compression(png::Compression::High);
        let bytes = match colours {
            Colours::All => {
                encoder.set_color(png::ColorType::Rgb);
                pixels.concat()
            }
            Colours::Few => {
                let (palette, numbers) = colours::reduced(&pixels);
                encoder.set_color(png::ColorType::Indexed);
                encoder.set_palette(palette.concat());
                numbers
            }
        };
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&bytes).unwrap();
    }
}

/// Colours of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// As they are: where something is shaded.
    All,
    /// At most 256, for a file half as large.
    Few,
}

/// A part of the window as it is drawn.
pub struct Part {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Part {
    /// The part inside a rectangle, or the whole window.
    pub fn of(window: &mut Harness<'static, ToileApp>, inside: Option<Rect>) -> Self {
        let picture = window.render().unwrap();
        let whole = egui::vec2(picture.width() as f32, picture.height() as f32);
        let whole = Rect::from_min_size(egui::Pos2::ZERO, whole);
        let inside = inside.map_or(whole, |inside| inside.round().intersect(whole));
        let rows = inside.top() as u32..inside.bottom() as u32;
        let columns = inside.left() as u32..inside.right() as u32;
        let mut pixels = Vec::new();
        for y in rows {
            for x in columns.clone() {
                let [red, green, blue, _] = picture.get_pixel(x, y).0;
                pixels.push([red, green, blue]);
            }
        }
        Self {
            width: columns.len(),
            height: pixels.len() / columns.len().max(1),
            pixels,
        }
    }
}
