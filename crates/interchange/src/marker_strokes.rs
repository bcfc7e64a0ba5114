//! The lines and words of a plotted marker, on layers, in the fabric's own plane (m), x along the warp from
//! 0, y across from the lower side.

use crate::{MarkerDrawing, MarkerPiece};
use strum::{EnumCount, IntoStaticStr, VariantArray};
use toile_cut::{StrokeKind, Words};
use toile_geometry::{Polygon, Vec2};
use toile_nesting::Fold;

/// The purpose of a line or a text.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, EnumCount, VariantArray, IntoStaticStr,
)]
#[strum(serialize_all = "UPPERCASE")]
pub(crate) enum Layer {
    /// Outline of the fabric.
    Fabric,
    /// Borders of the usable part of the fabric: along the selvedges and the end margins.
    Margin,
    /// Folds of the fabric, and edges of pieces that lie on a fold.
    Fold,
    /// Lines of the fabric's print.
    Print,
    Flaw,
    Cut,
    Sew,
    /// Lines and marks inside a piece.
    Line,
    Notch,
    Grain,
    Drill,
    Text,
}

impl Layer {
    pub const ALL: [Self; Self::COUNT] = toile_geometry::all_variants!();

    /// Name of the layer in files.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Class of the layer's lines in SVG.
    pub fn class(self) -> &'static str {
        match self {
            Self::Fabric => "fabric",
            Self::Margin => "margin",
            Self::Fold => "on-fold",
            Self::Print => "print",
            Self::Flaw => "flaw",
            Self::Cut => "cut",
            Self::Sew => "sew",
            Self::Line => "line",
            Self::Notch => "notch",
            Self::Grain => "grain",
            Self::Drill => "drill",
            Self::Text => "text",
        }
    }

    /// Whether a knife follows the lines of the layer.
    pub fn is_cut(self) -> bool {
        self.pen() == 1
    }

    /// AutoCAD colour index.
    pub fn colour_index(self) -> u8 {
        match self {
            Self::Cut | Self::Text => 7,
            Self::Fabric | Self::Margin => 8,
            Self::Sew | Self::Line => 9,
            Self::Notch | Self::Drill => 3,
            Self::Grain => 5,
            Self::Print => 4,
            Self::Fold => 6,
            Self::Flaw => 1,
        }
    }

    /// Red, green and blue (0 to 1).
    pub fn ink(self) -> [f32; 3] {
        match self {
            Self::Cut | Self::Notch | Self::Text => [0.07, 0.07, 0.07],
            Self::Fabric => [0.33, 0.33, 0.33],
            Self::Margin => [0.7, 0.68, 0.64],
            Self::Sew | Self::Line | Self::Drill => [0.45, 0.45, 0.45],
            Self::Grain => [0.12, 0.31, 0.62],
            Self::Print => [0.62, 0.72, 0.85],
            Self::Fold => [0.55, 0.2, 0.55],
            Self::Flaw => [0.85, 0.28, 0.37],
        }
    }

    /// Pen of a plotter: 1 for lines to cut, 2 for markings on the pieces, 3 for the fabric.
    pub fn pen(self) -> u8 {
        match self {
            Self::Cut | Self::Notch => 1,
            Self::Sew | Self::Line | Self::Grain | Self::Drill | Self::Text => 2,
            Self::Fabric | Self::Margin | Self::Fold | Self::Print | Self::Flaw => 3,
        }
    }
}

/// A line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub layer: Layer,
    pub points: Vec<Vec2>,
    pub closed: bool,
}

/// Lines and texts of a marker.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Strokes {
    pub strokes: Vec<Stroke>,
    pub words: Vec<Words>,
}

/// Pale fills, assigned to items in turn: red, green, blue.
const FILLS: [[u8; 3]; 8] = [
    [0xf6, 0xd9, 0xc8],
    [0xcf, 0xe3, 0xf2],
    [0xd9, 0xec, 0xd0],
    [0xf5, 0xe6, 0xb8],
    [0xe3, 0xd6, 0xee],
    [0xf3, 0xd0, 0xd8],
    [0xcd, 0xea, 0xe6],
    [0xe6, 0xe0, 0xd4],
];

/// The fill of an item's pieces: red, green, blue.
pub(crate) fn fill_of(item: usize) -> [u8; 3] {
    FILLS[item % FILLS.len()]
}

/// Largest number of print lines drawn in one direction.
const MAX_LINES: f64 = 2000.0;

impl Strokes {
    /// Everything on a marker.
    pub fn of(drawing: &MarkerDrawing) -> Self {
        let mut all = Self::of_fabric(drawing);
        for piece in &drawing.pieces {
            all.piece(piece);
        }
        all
    }

    /// The lines of the fabric.
    pub fn of_fabric(drawing: &MarkerDrawing) -> Self {
        let mut all = Self::default();
        all.fabric(drawing);
        all
    }

    /// The lines and texts of one piece.
    pub fn of_piece(piece: &MarkerPiece) -> Self {
        let mut all = Self::default();
        all.piece(piece);
        all
    }

    /// The lines of a layer.
    pub fn on(&self, layer: Layer) -> impl Iterator<Item = &Stroke> {
        self.strokes.iter().filter(move |s| s.layer == layer)
    }

    fn line(&mut self, layer: Layer, points: Vec<Vec2>, closed: bool) {
        if points.len() > 1 {
            self.strokes.push(Stroke {
                layer,
                points,
                closed,
            });
        }
    }

    fn rings(&mut self, layer: Layer, polygon: &Polygon) {
        for ring in polygon.rings() {
            self.line(layer, ring.clone(), true);
        }
    }

    fn fabric(&mut self, drawing: &MarkerDrawing) {
        let (strip, length) = (&drawing.strip, drawing.length);
        let width = strip.width;
        let across = |x: f64| vec![Vec2::new(x, 0.0), Vec2::new(x, width)];
        let along = |y: f64| vec![Vec2::new(0.0, y), Vec2::new(length, y)];
        let corners = [[0.0, 0.0], [length, 0.0], [length, width], [0.0, width]];
        self.line(Layer::Fabric, corners.map(Vec2::from).to_vec(), true);
        if strip.lower() > 0.0 {
            self.line(Layer::Margin, along(strip.lower()), false);
        }
        if strip.upper() < width {
            self.line(Layer::Margin, along(strip.upper()), false);
        }
        if strip.end_margin > 0.0 {
            self.line(Layer::Margin, across(strip.end_margin), false);
            self.line(Layer::Margin, across(length - strip.end_margin), false);
        }
        if strip.fold != Fold::Open {
            self.line(Layer::Fold, along(0.0), false);
        }
        if strip.fold == Fold::Both {
            self.line(Layer::Fold, along(width), false);
        }
        if let Some(print) = &strip.stripes {
            for axis in 0..2 {
                let (repeat, end) = (print.repeat[axis], [length, width][axis]);
                if repeat <= 0.0 || end / repeat > MAX_LINES {
                    continue;
                }
                let first = print.origin[axis].rem_euclid(repeat);
                let count = ((end - first) / repeat).floor().max(-1.0) as i64;
                for k in 0..=count {
                    let at = first + k as f64 * repeat;
                    let line = if axis == 0 { across(at) } else { along(at) };
                    self.line(Layer::Print, line, false);
                }
            }
        }
        for flaw in &strip.flaws {
            self.rings(Layer::Flaw, &flaw.outline);
        }
    }

    fn piece(&mut self, piece: &MarkerPiece) {
        let lines: &[&str] = match piece.pose.mirrored {
            true => &[&piece.name, "face down"],
            false => &[&piece.name],
        };
        let drawing = piece.piece.drawing(|p| piece.pose.apply(p), lines);
        for stroke in drawing.strokes {
            self.line(stroke.kind.into(), stroke.points, stroke.closed);
        }
        self.words.extend(drawing.words);
    }
}

impl From<StrokeKind> for Layer {
    fn from(kind: StrokeKind) -> Self {
        match kind {
            StrokeKind::Cut => Self::Cut,
            StrokeKind::Sew => Self::Sew,
            StrokeKind::Inside | StrokeKind::Mark => Self::Line,
            StrokeKind::Notch => Self::Notch,
            StrokeKind::Fold => Self::Fold,
            StrokeKind::Grain => Self::Grain,
            StrokeKind::Drill => Self::Drill,
        }
    }
}
