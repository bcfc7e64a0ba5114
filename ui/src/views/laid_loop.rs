//! A loop that is laid on the mannequin by clicks in the 3D view: its paths on the skin, its places, and the strain of the
//! panel that was made of it.

use crate::gpu::CornerBuffer;
use crate::gpu::orbit::Orbit;
use crate::gpu::solid::{Corner, path_lines, shaded};
use crate::theme::{self, Palette};
use egui::{Align2, Color32, Painter, Pos2, Rect, Stroke, pos2, vec2};
use toile_geometry::Vec3;
use toile_session::{FlatSurface, SkinLoop};

/// Radius of the mark of a place (pixels).
const MARK: f32 = 4.5;
/// Size of the bar of colours of the strain (pixels).
const LEGEND: egui::Vec2 = vec2(160.0, 10.0);
/// Steps of colour of that bar.
const STEPS: usize = 40;

/// A loop on the mannequin, with what the graphics card draws of it.
pub struct LaidLoop {
    /// The loop.
    pub skin: SkinLoop,
    pub(super) lines: Vec<Corner>,
    pub(super) strain: Vec<Corner>,
    pub(super) line_buffer: CornerBuffer,
    pub(super) strain_buffer: CornerBuffer,
    pub(super) is_stale: bool,
    /// Whether the panel is being made: places stay as they are.
    pub is_held: bool,
    /// The eye that last looked, and whether it sees each place.
    seen: Option<(Vec3, Vec<bool>)>,
    /// Limit of the stretch that the colours show (1), once a panel was made.
    limit: Option<f64>,
}

impl LaidLoop {
    /// A loop without places.
    pub fn new(skin: SkinLoop) -> Self {
        Self {
            skin,
            lines: Vec::new(),
            strain: Vec::new(),
            line_buffer: CornerBuffer::default(),
            strain_buffer: CornerBuffer::default(),
            is_stale: true,
            is_held: false,
            seen: None,
            limit: None,
        }
    }

    /// Draws the lines anew, after the loop changed; the strain was that of another region.
    pub fn changed(&mut self, palette: &Palette) {
        let closing = [self.skin.closing().to_vec()];
        self.lines = path_lines(self.skin.paths(), palette.accent);
        self.lines.extend(path_lines(&closing, palette.ink_soft));
        self.strain = Vec::new();
        self.limit = None;
        self.is_stale = true;
        self.seen = None;
    }

    /// Shows the stretch of the cloth on the region.
    pub fn show_strain(&mut self, flat: &FlatSurface) {
        let places = flat.surface();
        let places: Vec<Vec3> = places.into_iter().map(Vec3::from).collect();
        self.strain = shaded(&places, flat.triangles(), &flat.colours());
        self.limit = Some(flat.report.stretch_limit);
        self.is_stale = true;
    }

    /// Marks the places that can be seen, with their numbers.
    pub(super) fn paint(&mut self, painter: &Painter, view: Rect, orbit: &Orbit) {
        let palette = Palette::of(painter.ctx());
        let eye = orbit.eye();
        let (skin, places) = (&self.skin, self.skin.places());
        let known = self.seen.take().filter(|(from, _)| *from == eye);
        let look = || places.iter().map(|place| skin.is_seen(*place, eye));
        let (_, seen) = self
            .seen
            .insert(known.unwrap_or_else(|| (eye, look().collect())));
        for (k, (place, &is_seen)) in places.iter().zip(&*seen).enumerate() {
            let Some(at) = on_screen(orbit, view, *place) else {
                continue;
            };
            let stroke = Stroke::new(1.5, palette.accent);
            match is_seen {
                true => painter.circle(at, MARK, palette.accent, Stroke::new(1.5, palette.field)),
                false => painter.circle_stroke(at, MARK, stroke),
            };
            if is_seen {
                let words = (k + 1).to_string();
                let beside = at + vec2(7.0, -5.0);
                painter.text(
                    beside,
                    Align2::LEFT_BOTTOM,
                    words,
                    theme::font(12.5),
                    palette.ink,
                );
            }
        }
        if let Some(limit) = self.limit {
            legend(painter, view, limit);
        }
    }
}

/// The colour of a stretch (1) up to a limit (1).
fn colour_of(stretch: f64, limit: f64) -> Color32 {
    let [red, green, blue] = theme::bytes(FlatSurface::colour_of(stretch, limit));
    Color32::from_rgb(red, green, blue)
}

/// The bar of colours of the stretch, with its ends in words.
fn legend(painter: &Painter, view: Rect, limit: f64) {
    let palette = Palette::of(painter.ctx());
    let corner = view.right_top() + vec2(-LEGEND.x - 12.0, 30.0);
    let step = LEGEND.x / STEPS as f32;
    for k in 0..STEPS {
        let share = (k as f64 + 0.5) / STEPS as f64;
        let colour = colour_of(share * limit, limit);
        let at = Rect::from_min_size(
            corner + vec2(step * k as f32, 0.0),
            vec2(step + 0.5, LEGEND.y),
        );
        painter.rect_filled(at, 0.0, colour);
    }
    let over = colour_of(2.0 * limit, limit);
    let words = |at: Pos2, align, words: String, colour| {
        painter.text(at, align, words, theme::font(12.0), colour);
    };
    let below = corner + vec2(0.0, LEGEND.y + 2.0);
    words(
        corner - vec2(0.0, 2.0),
        Align2::LEFT_BOTTOM,
        "Stretch of the cloth".to_owned(),
        palette.ink,
    );
    words(below, Align2::LEFT_TOP, "0 %".to_owned(), palette.ink_soft);
    words(
        below + vec2(LEGEND.x, 0.0),
        Align2::RIGHT_TOP,
        format!("over {:.1} %", 100.0 * limit),
        over,
    );
}

/// The place of a point in a view that shows it, if it is before the eye.
pub(super) fn on_screen(orbit: &Orbit, view: Rect, point: Vec3) -> Option<Pos2> {
    let aspect = f64::from(view.width() / view.height().max(1.0));
    let [x, y] = orbit.seen(point, aspect)?;
    let half = view.size() * 0.5;
    Some(view.center() + vec2(x as f32 * half.x, -y as f32 * half.y))
}

/// The eye, and the direction in which it sees a place of a view.
pub(super) fn ray(orbit: &Orbit, view: Rect, at: Pos2) -> [Vec3; 2] {
    let aspect = f64::from(view.width() / view.height().max(1.0));
    let off = at - view.center();
    let half = view.size() * 0.5;
    let at = pos2(off.x / half.x.max(1.0), -off.y / half.y.max(1.0));
    [
        orbit.eye(),
        orbit.toward([f64::from(at.x), f64::from(at.y)], aspect),
    ]
}
