//! A figure that stands, walks and runs in its clothes, controlled by keys: `toile-ui --figure`.

mod arguments;

pub use arguments::FigureTask;

use crate::gpu::orbit::Orbit;
use crate::gpu::solid::{Corner, floor, painted};
use crate::gpu::{CornerBuffer, StageRenderer};
use crate::theme::{self, Palette};
use eframe::egui_wgpu::RenderState;
use egui::{Align2, Color32, Key, PointerButton, Pos2, Rect, Sense, Ui};
use std::time::Instant;
use toile_session::{Adjustment, RealtimeKey, RealtimeRun};

/// Keys of the keyboard for the motions of the figure.
const KEYS: [(Key, RealtimeKey); 4] = [
    (Key::ArrowDown, RealtimeKey::Stand),
    (Key::ArrowUp, RealtimeKey::Walk),
    (Key::ArrowRight, RealtimeKey::Run),
    (Key::G, RealtimeKey::Switch),
];

/// Weight of the newest frame in the mean computing time (1): averages over about half a second, so that
/// the number can be read.
const NEWEST: f64 = 0.03;

/// The window of a figure in motion.
pub struct FigureWindow {
    run: RealtimeRun,
    orbit: Orbit,
    renderer: Option<StageRenderer>,
    solids: CornerBuffer,
    floor: CornerBuffer,
    lines: CornerBuffer,
    last: Option<Instant>,
    /// Mean time in which a frame of the figure and its clothes is computed (s).
    spent: f64,
    refusal: Option<String>,
}

impl FigureWindow {
    /// A window for a dressed figure; without a graphics card it shows a message.
    pub fn new(run: RealtimeRun, state: Option<&RenderState>) -> Self {
        Self {
            run,
            orbit: Orbit::default(),
            renderer: state.map(StageRenderer::new),
            solids: CornerBuffer::default(),
            floor: CornerBuffer::default(),
            lines: CornerBuffer::default(),
            last: None,
            spent: 0.0,
            refusal: None,
        }
    }

    /// Handles keys, computes the next frame, and draws it.
    pub fn show(&mut self, ui: &mut Ui) {
        for (key, asked) in KEYS {
            if ui.input(|input| input.key_pressed(key)) {
                self.refusal = self.run.press(asked).err().map(|error| error.to_string());
            }
        }
        let now = Instant::now();
        let since = self
            .last
            .replace(now)
            .map_or(0.0, |last| (now - last).as_secs_f32());
        self.run.frame(since);
        let spent = now.elapsed().as_secs_f64();
        self.spent += NEWEST * (spent - self.spent);
        self.run.show();
        self.draw(ui);
        ui.ctx().request_repaint();
    }

    fn draw(&mut self, ui: &mut Ui) {
        let view = ui.available_rect_before_wrap();
        let response = ui.interact(view, ui.scope_id().with("figure"), Sense::click_and_drag());
        ui.advance_cursor_after_rect(view);
        if response.dragged_by(PointerButton::Primary) {
            self.orbit.turn(response.drag_delta());
        } else if response.dragged() {
            self.orbit.pan(response.drag_delta(), view.height());
        }
        let scroll = ui.input(|input| input.smooth_scroll_delta.y);
        self.orbit.zoom(f64::from(scroll / 300.0).exp2());
        let palette = Palette::of(ui.ctx());
        ui.painter().rect_filled(view, 0.0, palette.stage);
        let pixels = view.size() * ui.ctx().pixels_per_point();
        let size = [pixels.x, pixels.y].map(|x| x.round().clamp(1.0, 8192.0) as u32);
        if let Some(renderer) = &mut self.renderer {
            let surfaces = self.run.clothes.iter().chain([&self.run.body]);
            let corners: Vec<Corner> = surfaces.flat_map(painted).collect();
            renderer.upload(&corners, &mut self.solids);
            renderer.upload(&floor(palette), &mut self.floor);
            let image = (size, palette.stage);
            let solids = [&self.solids, &self.floor];
            let id = renderer.draw(&self.orbit, image, &solids, &self.lines);
            let whole = Rect::from_min_max(Pos2::ZERO, egui::pos2(1.0, 1.0));
            ui.painter().image(id, view, whole, Color32::WHITE);
        }
        ui.painter().text(
            view.left_top() + egui::vec2(16.0, 14.0),
            Align2::LEFT_TOP,
            self.words(),
            theme::font(14.5),
            palette.ink_soft,
        );
    }

    /// Text in the corner of the window.
    fn words(&self) -> String {
        let adjustment = match self.run.adjustment() {
            Adjustment::Gravity => "clothes hang",
            Adjustment::Shape => "clothes fit closely",
        };
        let vertices: usize = self
            .run
            .garments()
            .iter()
            .map(|garment| garment.len())
            .sum();
        let state = format!(
            "{}, {adjustment}: {:.2} ms a frame for {vertices} vertices",
            self.run.clip(),
            self.spent * 1e3
        );
        let help = "Down: stand   Up: walk   Right: run   G: hang or fit closely";
        let drawn = match &self.renderer {
            Some(_) => "",
            None => "\nThis computer offers no graphics card or driver for the 3D view",
        };
        let refusal = self.refusal.as_deref().unwrap_or_default();
        format!("{state}\n{help}{drawn}\n{refusal}")
    }
}

impl eframe::App for FigureWindow {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }
}
