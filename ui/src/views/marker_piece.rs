//! A piece on a marker as drawn.

use crate::canvas::fill::{Fill, fill};
use egui::{Pos2, Rect};
use toile_cut::Drawing;
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::OrderedPiece;
use toile_session::Pose;

/// A name that is written instead of a piece's own text.
#[derive(Clone, Debug)]
pub struct PieceName {
    /// Text.
    pub name: String,
    /// Rectangle on the screen.
    pub rect: Rect,
    /// End of the leader line inside the piece; `None` if the name is not outside.
    pub led_to: Option<Pos2>,
    /// Height of the letters (pixels).
    pub letters: f32,
}

/// A piece as drawn.
#[derive(Clone, Debug)]
pub struct PieceScene {
    /// Identity of the piece.
    pub piece: OrderedPiece,
    /// Name to write on it.
    pub name: String,
    /// Lines, area and text on the marker.
    pub drawing: Drawing,
    /// Fill of the area.
    pub fill: Fill,
    /// Pose on the fabric: direction of the grain, turn, side up and translation.
    pub pose: Pose,
    /// Whether it is locked in its place.
    pub locked: bool,
    /// Whether the piece waits beside the fabric to be laid.
    pub waits: bool,
}

impl PieceScene {
    /// A piece in a pose; `draw` makes the drawing of its cut piece.
    pub fn new(
        piece: OrderedPiece,
        name: &str,
        pose: Pose,
        draw: impl FnOnce(&dyn Fn(Vec2) -> Vec2, &[&str]) -> Drawing,
    ) -> Self {
        let drawing = draw(&|at| pose.apply(at), &[name]);
        let rings = drawing.fill.as_ref();
        let rings: Vec<Vec<Vec2>> = rings.map_or_else(Vec::new, |p| p.rings().cloned().collect());
        Self {
            piece,
            name: name.to_owned(),
            fill: fill(&rings),
            drawing,
            pose,
            locked: false,
            waits: false,
        }
    }

    /// Bounding box on the marker (m).
    pub fn bounds(&self) -> Option<Bounds2> {
        let polygon = self.drawing.fill.as_ref()?;
        Some(polygon.bounds())
    }

    /// Place of the name (m).
    pub fn middle(&self) -> Vec2 {
        let words = self.drawing.words.first().map(|words| words.at);
        let bounds = self.bounds().map(|bounds| bounds.centre());
        words.or(bounds).unwrap_or_else(Vec2::zeros)
    }

    /// A number that is equal for pieces of one size: such pieces get the same colour.
    pub fn group(&self) -> u8 {
        self.piece.size.map_or(0, |id| (id.0 % 7) as u8)
    }
}
