//! Cards of patterns on the first page: the pieces of each as they lie on the table, the garment as it last
//! hung, and the name.

use super::drape_views;
use super::job::Job;
use crate::canvas::fill::Fill;
use crate::canvas::scene::Scene;
use crate::canvas::table_layout::TableLayout;
use crate::theme::Palette;
use egui::epaint::Vertex;
use egui::{
    Color32, ColorImage, Mesh, Pos2, Rect, Role, Sense, Shape, Stroke, TextureHandle,
    TextureOptions, Ui, WidgetInfo, vec2,
};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use toile_geometry::{Bounds2, Vec2};
use toile_session::{Command, Session, SessionError, Silent};

/// Size of a card, with the name (pixels).
pub const CARD: egui::Vec2 = vec2(148.0, 150.0);
/// Height of the name (pixels).
const NAME: f32 = 26.0;
/// Margin round the pieces (pixels).
const MARGIN: f32 = 10.0;
/// Time until a picture that is being drawn is looked for again.
const SOON: Duration = Duration::from_millis(50);
/// Level of detail of the lines: exponent of the power of two that is the enlargement (pixels per metre).
const OCTAVE: i32 = 8;

/// Pictures of patterns, by the files of the patterns.
#[derive(Default)]
pub struct PatternCards {
    pictures: BTreeMap<PathBuf, Picture>,
}

/// State of the picture of a pattern: being drawn, drawn, or missing.
enum Picture {
    Drawing(Job<(Pieces, Option<ColorImage>)>),
    Drawn(Pieces, Option<TextureHandle>),
    /// The file is missing or cannot be read; opening it reports the reason.
    Missing,
}

/// The pieces of a pattern at their places on the table (m).
struct Pieces {
    /// Fills, their places on the table (m), and whether they are mirrored halves.
    fills: Vec<(Fill, Vec2, bool)>,
    lines: Vec<Vec<Vec2>>,
    bounds: Bounds2,
}

impl Pieces {
    fn of_file(path: &Path) -> Result<Self, SessionError> {
        // The pattern is drafted as if the file were opened: in its base size; if it has no sizes, to the
        // average body.
        let mut session = Session::new();
        let path = path.to_owned();
        session.execute(Command::open(path), &mut Silent)?;
        let pattern = session.project().pattern.clone();
        let evaluation = session.evaluation();
        let draft = Arc::new(evaluation.draft().0);
        let mut scene = Scene::default();
        scene.update(&evaluation, &draft, OCTAVE);
        let mut layout = TableLayout::default();
        layout.open(&pattern, &scene);
        layout.push_apart(&pattern, &scene);
        let mut fills = Vec::new();
        let mut lines: Vec<Vec<Vec2>> = Vec::new();
        for panel in &scene.panels {
            let at = layout.panel(panel.id);
            let shape = &panel.shape;
            fills.push((shape.fill.clone(), at, false));
            fills.push((shape.mirrored_fill.clone(), at, true));
            let darts = shape.darts.iter().map(|(_, _, line)| line);
            let rings = shape.rings.iter().chain(&shape.mirrored).chain(darts);
            let placed = |ring: &Vec<Vec2>| ring.iter().map(|p| p + at).collect();
            lines.extend(rings.map(placed));
        }
        Ok(Self {
            fills,
            bounds: Bounds2::of(lines.iter().flatten().copied()),
            lines,
        })
    }

    /// Draws the pieces as large as they fit into a rectangle.
    fn paint(&self, ui: &Ui, room: Rect) {
        let bounds = self.bounds;
        let size = bounds.max - bounds.min;
        if !(size.x > 0.0 && size.y > 0.0) {
            return;
        }
        let scale = (f64::from(room.width()) / size.x).min(f64::from(room.height()) / size.y);
        let middle = (bounds.min + bounds.max) / 2.0;
        let seen = |p: Vec2| -> Pos2 {
            let from_middle = (p - middle) * scale;
            room.center() + vec2(from_middle.x as f32, -from_middle.y as f32)
        };
        let palette = Palette::of(ui.ctx());
        for (fill, at, is_mirrored) in &self.fills {
            let colour = match is_mirrored {
                true => palette.panel_mirrored,
                false => palette.panel,
            };
            let vertex = |p: &[f32; 2]| Vertex {
                pos: seen(Vec2::from(p.map(f64::from)) + at),
                uv: egui::epaint::WHITE_UV,
                color: colour,
            };
            ui.painter().add(Shape::mesh(Mesh {
                indices: fill.indices.clone(),
                vertices: fill.points.iter().map(vertex).collect(),
                ..Mesh::default()
            }));
        }
        for line in &self.lines {
            let line = line.iter().map(|p| seen(*p)).collect();
            let stroke = Stroke::new(1.0, palette.ink_soft);
            ui.painter().add(Shape::line(line, stroke));
        }
    }
}

impl PatternCards {
    /// Shows the card of a pattern; returns whether it was clicked.
    ///
    /// `folder` holds the pictures of draped garments.
    pub fn card(
        &mut self,
        ui: &mut Ui,
        (path, name): (&Path, &str),
        folder: Option<&Path>,
    ) -> bool {
        let palette = Palette::of(ui.ctx());
        let (room, response) = ui.allocate_exact_size(CARD, Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
        let visuals = ui.style().interact(&response);
        let stroke = match response.hovered() || response.has_focus() {
            true => Stroke::new(1.5, palette.accent),
            false => visuals.bg_stroke,
        };
        ui.painter().rect(
            room.shrink(1.0),
            4.0,
            palette.table,
            stroke,
            egui::StrokeKind::Inside,
        );
        let mut inner = room.shrink(MARGIN);
        inner.max.y -= NAME - MARGIN;
        let picture = self.pictures.entry(path.to_owned()).or_insert_with(|| {
            let path = path.to_owned();
            let hung = folder.map(|folder| drape_views::place(folder, &path));
            Picture::Drawing(Job::start(move |_| {
                let hung = hung.and_then(|place| drape_views::read(&place));
                Ok((Pieces::of_file(&path)?, hung))
            }))
        });
        if let Picture::Drawing(job) = picture {
            match job.result() {
                Some(Ok((pieces, hung))) => {
                    let load = |image| ui.ctx().load_texture(name, image, TextureOptions::LINEAR);
                    *picture = Picture::Drawn(pieces, hung.map(load));
                }
                Some(Err(_)) => *picture = Picture::Missing,
                None => ui.ctx().request_repaint_after(SOON),
            }
        }
        match picture {
            Picture::Drawn(pieces, None) => pieces.paint(ui, inner),
            Picture::Drawn(pieces, Some(hung)) => {
                // The garment on the right, as tall as the card.
                let size = hung.size_vec2();
                let width = inner.height() * size.x / size.y;
                let (left, right) = inner.split_left_right_at_x(inner.right() - width);
                pieces.paint(ui, left.with_max_x(left.right() - 6.0));
                let whole = Rect::from_min_max(Pos2::ZERO, egui::pos2(1.0, 1.0));
                ui.painter().image(hung.id(), right, whole, Color32::WHITE);
            }
            Picture::Drawing(_) => {}
            Picture::Missing => words(ui, inner, "not to be read", palette.ink_soft),
        }
        let mut below = room.shrink(6.0);
        below.min.y = below.max.y - NAME + 6.0;
        words(ui, below, name, palette.ink);
        response.on_hover_text(path.display().to_string()).clicked()
    }

    /// Discards all pictures, so that they are drawn anew.
    pub fn clear(&mut self) {
        self.pictures.clear();
    }
}

/// Text in the middle of a rectangle, truncated to its width.
fn words(ui: &Ui, room: Rect, words: &str, colour: Color32) {
    let font = egui::TextStyle::Body.resolve(ui.style());
    let mut job = egui::text::LayoutJob::simple_singleline(words.to_owned(), font, colour);
    job.wrap = egui::text::TextWrapping::truncate_at_width(room.width());
    let galley = ui.painter().layout_job(job);
    let at = room.center() - galley.size() / 2.0;
    ui.painter().galley(at, galley, colour);
}
