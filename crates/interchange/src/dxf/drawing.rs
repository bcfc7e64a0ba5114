//! The drawing in a DXF file: blocks, and the lines, points and texts in them.

use std::collections::BTreeMap;
use toile_geometry::Vec2;

/// A drawing, in the units of the file.
#[derive(Clone, Debug, Default)]
pub(super) struct DxfDrawing {
    /// The blocks, in the order of the file.
    pub blocks: Vec<Block>,
    /// Entities outside of blocks.
    pub loose: Vec<Entity>,
    /// Places at which blocks are put in.
    pub inserts: Vec<Insert>,
    /// Unit that the header states (`$INSUNITS`), as its number there; 0 for none.
    pub header_unit: i64,
    /// Kinds of entities that were left out, with their numbers.
    pub left_out: BTreeMap<String, usize>,
    /// Kinds of curves that were read as points of them, with their numbers.
    pub curves: BTreeMap<&'static str, usize>,
}

/// A named group of entities.
#[derive(Clone, Debug, Default)]
pub(super) struct Block {
    pub name: String,
    /// The point of the block that an insert puts at its place.
    pub base: Vec2,
    pub entities: Vec<Entity>,
}

/// A place at which a block is put in.
#[derive(Clone, Debug)]
pub(super) struct Insert {
    /// Name of the block.
    pub block: String,
    pub at: Vec2,
    /// Scales along x and y; negative for a mirror image.
    pub scale: [f64; 2],
    /// Turn (rad), counter-clockwise.
    pub turn: f64,
}

/// Something drawn on a layer.
#[derive(Clone, Debug)]
pub(super) struct Entity {
    /// The layer; text that is no number stands for a layer of no standard.
    pub layer: String,
    pub drawn: Drawn,
}

/// Lines, points and texts.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Drawn {
    /// A line through points.
    Line {
        points: Vec<Vec2>,
        /// Whether it runs back to its first point.
        is_closed: bool,
        /// For each point, whether it lies between two vertices of a curve; empty if none does.
        between: Vec<bool>,
    },
    /// A point; its further values are the depth and width of a notch or the diameter of a drill hole, and the
    /// angle of a notch (degrees).
    Point {
        at: Vec2,
        /// The third coordinate, if it is there.
        z: Option<f64>,
        /// The thickness, if it is there.
        thickness: Option<f64>,
        /// The angle (degrees), if it is there.
        angle: Option<f64>,
    },
    /// A text.
    Text { at: Vec2, text: String },
}
