//! The 3D view: mannequin and garment, seen by an orbiting camera.
//!
//! # Decided with
//! - [`crate::gpu::orbit::Orbit`]: the camera;
//! - [`crate::gpu::solid::ClothLook`], [`crate::gpu::StageRenderer::draw`]: meshes with colours; how they are
//!   drawn;
//! - [`crate::app`] (`background_work.rs`, `follow_run`): frames of the run;
//! - [`crate::app`] (`garment_pane.rs`): the pane round it.
//!
//! Light stands in `gpu/stage.wgsl`.

use crate::gpu::orbit::Orbit;
use crate::gpu::solid::{ClothLook, ClothSolid, Corner, floor, mannequin};
use crate::gpu::{CornerBuffer, StageRenderer};
use crate::theme::{self, Palette};
use crate::views::laid_loop::{LaidLoop, on_screen, ray};
use eframe::egui_wgpu::RenderState;
use egui::{Align2, CursorIcon, PointerButton, Rect, Response, Role, Sense, Ui, WidgetInfo};
use std::sync::Arc;
use toile_geometry::{TriangleMesh, Vec3};
use toile_session::{GarmentJob, LiveFrame};

/// The 3D view and its state.
#[derive(Default)]
pub struct GarmentView {
    /// Position of the eye.
    pub orbit: Orbit,
    renderer: Option<StageRenderer>,
    body: Vec<Corner>,
    body_bounds: Option<[Vec3; 2]>,
    body_buffer: CornerBuffer,
    floor_buffer: CornerBuffer,
    look: Option<(Arc<GarmentJob>, ClothLook)>,
    frame: Option<LiveFrame>,
    is_old: bool,
    /// Whether the mannequin is hidden.
    pub hides_body: bool,
    cloth: ClothSolid,
    cloth_buffer: CornerBuffer,
    line_buffer: CornerBuffer,
    vertices: usize,
    stale: Stale,
    /// The loop that is laid on the mannequin; the cloth is hidden meanwhile.
    pub laid: Option<LaidLoop>,
    /// Why the last click laid no place.
    refusal: Option<String>,
    wants_fit: bool,
    /// The view in the last frame.
    view: Option<Rect>,
    /// Size of the view to which the mannequin was fitted; `None` once the user has panned or zoomed.
    fitted: Option<egui::Vec2>,
    drawn: Option<Drawn>,
}

/// Buffers that must be uploaded to the graphics card anew.
#[derive(Clone, Copy, Default)]
struct Stale {
    body: bool,
    cloth: bool,
}

/// State that the last picture shows.
#[derive(Clone, Copy, PartialEq)]
struct Drawn {
    orbit: Orbit,
    size: [u32; 2],
    theme: egui::Theme,
    hides_body: bool,
    has_loop: bool,
    id: egui::TextureId,
}

impl GarmentView {
    /// A view drawn by the window's graphics card; without a graphics card the view shows a message.
    pub fn new(state: Option<&RenderState>) -> Self {
        Self {
            renderer: state.map(StageRenderer::new),
            ..Self::default()
        }
    }

    /// Sets the mannequin.
    pub fn set_body(&mut self, skin: &TriangleMesh) {
        self.body = mannequin(&skin.positions, &skin.triangles);
        let first = self.body_bounds.is_none();
        self.body_bounds = skin.bounds();
        // A loop that was laid on another body is no loop of this one.
        if self
            .laid
            .as_ref()
            .is_some_and(|laid| !laid.skin.is_on(skin))
        {
            self.laid = None;
            self.refusal = Some("The wearer changed: lay the loop anew".to_owned());
        }
        self.stale.body = true;
        self.wants_fit |= first;
    }

    /// Sets the garment to the state in a frame of its drape.
    pub fn set_frame(&mut self, frame: LiveFrame) {
        let known = self.look.take();
        let known = known.filter(|(job, _)| Arc::ptr_eq(job, &frame.job));
        self.look = Some(known.unwrap_or_else(|| (frame.job.clone(), ClothLook::new(&frame.job))));
        self.vertices = frame.positions.len();
        self.frame = Some(frame);
        self.make_cloth();
    }

    /// Shows the garment grey while it belongs to an earlier pattern.
    pub fn set_out_of_date(&mut self, is_old: bool) {
        if self.is_old != is_old {
            self.is_old = is_old;
            self.make_cloth();
        }
    }

    /// Whether the garment is shown grey.
    pub fn is_out_of_date(&self) -> bool {
        self.is_old
    }

    fn make_cloth(&mut self) {
        if let (Some((_, look)), Some(frame)) = (&self.look, &self.frame) {
            self.cloth = look.solid(frame);
            if self.is_old {
                self.cloth.fade();
            }
            self.stale.cloth = true;
        }
    }

    /// Removes the garment.
    pub fn clear_garment(&mut self) {
        self.look = None;
        self.frame = None;
        self.cloth = ClothSolid::default();
        self.vertices = 0;
        self.stale.cloth = true;
    }

    /// Number of vertices of the displayed garment.
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// Whether there is a mannequin to show.
    pub fn has_body(&self) -> bool {
        !self.body.is_empty()
    }

    /// The displayed garment.
    pub fn garment(&self) -> Option<&Arc<GarmentJob>> {
        self.frame.as_ref().map(|frame| &frame.job)
    }

    /// Bounding box of the mannequin (m), if it is visible.
    pub fn seen_body(&self) -> Option<[Vec3; 2]> {
        self.body_bounds.filter(|_| !self.hides_body)
    }

    /// Looks at the garment from a horizontal direction: 0 from the front, positive toward the wearer's
    /// left (rad).
    pub fn look_from(&mut self, yaw: f64) {
        self.orbit.yaw = yaw;
        self.orbit.pitch = 0.05;
        self.wants_fit = true;
    }

    /// The place in the window at which a point of the scene (m) is seen.
    pub fn place_on_screen(&self, point: Vec3) -> Option<egui::Pos2> {
        on_screen(&self.orbit, self.view?, point)
    }

    /// Why the last click laid no place of a loop, once.
    pub fn take_refusal(&mut self) -> Option<String> {
        self.refusal.take()
    }

    /// Lays a place of the loop where the view was clicked.
    fn lay_place(&mut self, ui: &Ui, view: Rect, response: &Response) {
        let Some(laid) = &mut self.laid else { return };
        if response.hovered() {
            ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        }
        let clicked = response.clicked().then(|| response.interact_pointer_pos());
        let Some(at) = clicked.flatten() else { return };
        if laid.is_held {
            self.refusal = Some("The panel is being made: wait, or Leave".to_owned());
            return;
        }
        let [eye, toward] = ray(&self.orbit, view, at);
        match laid.skin.add(eye, toward) {
            Ok(()) => laid.changed(Palette::of(ui.ctx())),
            Err(words) => self.refusal = Some(words),
        }
    }

    /// Draws the view and handles its input.
    pub fn show(&mut self, ui: &mut Ui, empty: &str) {
        let view = ui.available_rect_before_wrap();
        // A rim of the view is left out: there the borders between the parts of the window are dragged.
        let inner = view.shrink(theme::GRAB);
        let response = ui.interact(
            inner,
            ui.scope_id().with("3D view"),
            Sense::click_and_drag(),
        );
        ui.advance_cursor_after_rect(view);
        response.widget_info(|| {
            let words = match self.vertices {
                0 => "3D view".to_owned(),
                count if self.is_old => {
                    format!("3D view, garment of {count} vertices, out of date")
                }
                count => format!("3D view, garment of {count} vertices"),
            };
            WidgetInfo::labeled(Role::Canvas, true, words)
        });
        self.view = Some(view);
        self.lay_place(ui, view, &response);
        self.navigate(ui, &response);
        let resized = self.fitted.is_some_and(|size| size != view.size());
        if (self.wants_fit || resized)
            && view.height() > 50.0
            && let Some(bounds) = self.body_bounds
        {
            let aspect = f64::from(view.width() / view.height());
            self.orbit.fit(bounds, aspect);
            self.wants_fit = false;
            self.fitted = Some(view.size());
        }
        let palette = Palette::of(ui.ctx());
        ui.painter().rect_filled(view, 0.0, palette.stage);
        let words = match &self.renderer {
            None => "This computer offers no graphics card or driver for the 3D view",
            Some(_) if !self.has_body() => empty,
            Some(_) => "",
        };
        self.draw(ui, view);
        if let Some(laid) = &mut self.laid {
            laid.paint(&ui.painter().with_clip_rect(view), view, &self.orbit);
        }
        if !words.is_empty() {
            ui.painter().text(
                view.center(),
                Align2::CENTER_CENTER,
                words,
                theme::font(14.5),
                palette.ink_soft,
            );
        }
    }

    fn navigate(&mut self, ui: &Ui, response: &Response) {
        let shift = ui.input(|input| input.modifiers.shift);
        let drag = response.drag_delta();
        if response.dragged_by(PointerButton::Primary) && !shift {
            self.orbit.turn(drag);
        } else if response.dragged() {
            self.orbit.pan(drag, response.rect.height());
            self.fitted = None;
        }
        if response.dragged() {
            ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        }
        if response.hovered() {
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta.y, input.zoom_delta()));
            let factor = f64::from(scroll / 300.0).exp2() * f64::from(pinch);
            if factor != 1.0 {
                self.orbit.zoom(factor);
                self.fitted = None;
            }
        }
    }

    fn draw(&mut self, ui: &Ui, view: Rect) {
        let Some(renderer) = &mut self.renderer else {
            return;
        };
        let pixels = view.size() * ui.ctx().pixels_per_point();
        let size = [pixels.x, pixels.y].map(|x| x.round().clamp(1.0, 8192.0) as u32);
        let theme = ui.ctx().theme();
        let palette = Palette::of(ui.ctx());
        let is_same_theme = self.drawn.is_some_and(|drawn| drawn.theme == theme);
        let is_laid_stale = self.laid.as_ref().is_some_and(|laid| laid.is_stale);
        let fresh = !self.stale.body && !self.stale.cloth && !is_laid_stale && is_same_theme;
        let now = (self.orbit, size, self.hides_body, self.laid.is_some());
        let is_same =
            |drawn: &Drawn| (drawn.orbit, drawn.size, drawn.hides_body, drawn.has_loop) == now;
        let kept = self.drawn.filter(|drawn| fresh && is_same(drawn));
        let id = match kept {
            Some(drawn) => drawn.id,
            None => {
                if self.stale.body {
                    renderer.upload(&self.body, &mut self.body_buffer);
                }
                if self.stale.cloth {
                    renderer.upload(&self.cloth.corners, &mut self.cloth_buffer);
                    renderer.upload(&self.cloth.lines, &mut self.line_buffer);
                }
                if !is_same_theme {
                    renderer.upload(&floor(palette), &mut self.floor_buffer);
                }
                self.stale = Stale::default();
                // The floor is hidden until there is a mannequin.
                let floor = (!self.body.is_empty()).then_some(&self.floor_buffer);
                let body = (!self.hides_body).then_some(&self.body_buffer);
                let (cloth, lines) = match &mut self.laid {
                    None => (&self.cloth_buffer, &self.line_buffer),
                    Some(laid) => {
                        if laid.is_stale {
                            renderer.upload(&laid.lines, &mut laid.line_buffer);
                            renderer.upload(&laid.strain, &mut laid.strain_buffer);
                        }
                        laid.is_stale = false;
                        (&laid.strain_buffer, &laid.line_buffer)
                    }
                };
                let solids = body.into_iter().chain([cloth]);
                let solids: Vec<_> = solids.chain(floor).collect();
                let image = (size, palette.stage);
                renderer.draw(&self.orbit, image, &solids, lines)
            }
        };
        self.drawn = Some(Drawn {
            orbit: self.orbit,
            size,
            theme,
            hides_body: self.hides_body,
            has_loop: self.laid.is_some(),
            id,
        });
        let whole = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
        ui.painter().image(id, view, whole, egui::Color32::WHITE);
    }
}
