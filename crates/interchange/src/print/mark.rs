//! Marks on paper: lines and words, each on a layer.

use crate::marker_strokes::Layer;
use crate::pdf::{Align, Ink};
use toile_geometry::{Bounds2, Vec2};
use toile_lettering::width;

/// Colour, width and dashes of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LineStyle {
    pub ink: Ink,
    /// Line width (m).
    pub width: f64,
    /// Length of a dash (m); 0 for a solid line.
    pub dash: f64,
    /// Purpose of the line, for lines of a piece; `None` for other lines.
    pub layer: Option<Layer>,
}

/// A line or a text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shape {
    Line {
        points: Vec<Vec2>,
        closed: bool,
        style: LineStyle,
    },
    Text {
        text: String,
        at: Vec2,
        /// Letter height (m).
        size: f64,
        /// Direction of the baseline (rad).
        angle: f64,
        align: Align,
        ink: Ink,
    },
}

/// A shape on a layer: the index of a size, or `None` for shapes common to all sizes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mark {
    pub layer: Option<usize>,
    pub shape: Shape,
}

/// A page of a print.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Page {
    /// Width and height (m).
    pub size: Vec2,
    pub name: String,
    /// The part of the page that shows the drawing (m).
    pub window: Bounds2,
    /// Marks of the drawing, clipped to the window.
    pub inside: Vec<Mark>,
    /// Marks drawn over the drawing, without clipping.
    pub on_top: Vec<Mark>,
}

impl Mark {
    pub fn line(
        layer: Option<usize>,
        (points, closed): (Vec<Vec2>, bool),
        style: LineStyle,
    ) -> Self {
        Self {
            layer,
            shape: Shape::Line {
                points,
                closed,
                style,
            },
        }
    }

    /// A horizontal text common to all sizes, aligned at a position.
    pub fn text(text: &str, (at, align): (Vec2, Align), (size, ink): (f64, Ink)) -> Self {
        Self {
            layer: None,
            shape: Shape::Text {
                text: text.to_owned(),
                at,
                size,
                angle: 0.0,
                align,
                ink,
            },
        }
    }

    pub fn rectangle(bounds: &Bounds2) -> (Vec<Vec2>, bool) {
        let (a, b) = (bounds.min, bounds.max);
        let corners = [[a.x, a.y], [b.x, a.y], [b.x, b.y], [a.x, b.y]];
        (corners.map(Vec2::from).to_vec(), true)
    }

    /// Bounding box (m); the box of a text has room for wider fonts.
    pub fn bounds(&self) -> Bounds2 {
        match &self.shape {
            Shape::Line { points, .. } => Bounds2::of(points.iter().copied()),
            Shape::Text {
                text,
                at,
                size,
                angle,
                align,
                ..
            } => {
                let length = 1.2 * width(text) * size;
                let back = match align {
                    Align::Left => 0.0,
                    Align::Middle => 0.5 * length,
                    Align::Right => length,
                };
                let along = Vec2::new(angle.cos(), angle.sin());
                let up = Vec2::new(-along.y, along.x) * *size;
                let start = at - along * back;
                let end = start + along * length;
                let low = up * -0.3;
                Bounds2::of([start + low, end + low, start + up, end + up])
            }
        }
    }
}
