//! A piece on a marker as drawn.

use crate::canvas::fill::{Fill, fill};
use egui::{Pos2, Rect};
use toile_cut::Drawing;
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::OrderedPiece;
use toile_session::Pose;

/// A name that stands in for a piece's own letters.
#[derive(Clone, Debug)]
pub struct PieceName {
    /// What it says.
    pub name: String,
    /// Where it stands on the screen.
    pub rect: Rect,
    /// The place in the piece that it is led to, if it stands outside.
    pub led_to: Option<Pos2>,
    /// Height of its letters (pixels).
    pub letters: f32,
}

/// A piece as drawn.
#[derive(Clone, Debug)]
pub struct PieceScene {
    /// Which it is.
    pub piece: OrderedPiece,
    /// Name to write on it.
    pub name: String,
    /// Its lines, area and words on the marker.
    pub drawing: Drawing,
    /// The same area, filled.
    pub fill: Fill,
    /// How it lies.
    pub pose: Pose,
    /// Whether it stays where it is.
    pub locked: bool,
    /// Whether it is not laid yet.
    pub waits: bool,
}

impl PieceScene {
    /// A piece in a pose, drawn by its cut piece.
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

    /// Least rectangle round it on the marker (m).
    pub fn bounds(&self) -> Option<Bounds2> {
        let polygon = self.drawing.fill.as_ref()?;
        Some(polygon.bounds())
    }

    /// Where its name stands (m).
    pub fn middle(&self) -> Vec2 {
        let words = self.drawing.words.first().map(|words| words.at);
        let bounds = self.bounds().map(|bounds| bounds.centre());
        words.or(bounds).unwrap_or_else(Vec2::zeros)
    }

    /// A number by which pieces of one size look alike.
    pub fn group(&self) -> u8 {
        self.piece.size.map_or(0, |id| (id.0 % 7) as u8)
    }
}
