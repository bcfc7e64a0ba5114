//! The parts of a piece in one block, by their layers (ANSI/AAMA-292, ASTM D6673).

use super::drawing::{Block, Drawn};
use super::labels::Labels;
use crate::drawn::chain::joined;
use toile_geometry::{Vec2, ring_area};
use toile_pattern::NotchKind;

/// Largest gap between the ends of open lines that meet (units of the file).
const GAP: f64 = 0.02;

/// What a layer of the standards holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layer {
    Cut,
    TurnPoints,
    CurvePoints,
    Notches(NotchKind),
    GradeReference,
    Mirror,
    Grain,
    Internal,
    Cutout,
    Drill,
    Sew,
    /// Dense twins of lines, for checks of quality.
    Twin,
    /// Text and reference lines.
    Annotation,
    /// A layer that is in neither standard.
    Other,
}

impl Layer {
    /// The layer of a name.
    pub fn of(name: &str) -> Self {
        match name.trim().parse::<u16>() {
            Ok(1) => Self::Cut,
            Ok(2) => Self::TurnPoints,
            Ok(3) => Self::CurvePoints,
            Ok(4) => Self::Notches(NotchKind::Slit),
            Ok(5) => Self::GradeReference,
            Ok(6) => Self::Mirror,
            Ok(7) => Self::Grain,
            Ok(8) => Self::Internal,
            Ok(11) => Self::Cutout,
            Ok(13) => Self::Drill,
            Ok(14) => Self::Sew,
            Ok(80) => Self::Notches(NotchKind::T),
            Ok(81) => Self::Notches(NotchKind::Castle),
            Ok(82) => Self::Notches(NotchKind::Check),
            // A U notch is nearest to a V.
            Ok(83) => Self::Notches(NotchKind::V),
            Ok(84..=87) => Self::Twin,
            Ok(9 | 10 | 12 | 15 | 19 | 26) => Self::Annotation,
            _ => Self::Other,
        }
    }
}

/// A line in a block, in the units of the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BlockLine {
    pub points: Vec<Vec2>,
    pub is_closed: bool,
}

impl BlockLine {
    /// Its length, without the way back to its start.
    pub fn length(&self) -> f64 {
        self.points
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).norm())
            .sum()
    }
}

/// A piece in one size as its block has it, in the units of the file.
#[derive(Clone, Debug, Default)]
pub(super) struct BlockPiece {
    /// Name of the block.
    pub block: String,
    /// Its texts.
    pub labels: Labels,
    /// Closed lines of the cut layer, the largest first.
    pub cut: Vec<BlockLine>,
    /// Lines of the sew layer.
    pub sew: Vec<BlockLine>,
    pub internal: Vec<BlockLine>,
    pub cutouts: Vec<BlockLine>,
    pub mirror: Vec<BlockLine>,
    pub grain: Vec<BlockLine>,
    /// Axes that the shifts of grade rules run along.
    pub axes: Vec<BlockLine>,
    pub turn_points: Vec<Vec2>,
    /// Notches with their shape.
    pub notches: Vec<(Vec2, NotchKind)>,
    pub drills: Vec<Vec2>,
    /// Numbers of grade rules, with the places that they stand at.
    pub rules: Vec<(Vec2, u32)>,
    /// Whether it has dense twins of its lines.
    pub has_twins: bool,
    /// Number of notches of a U shape, which is not known here.
    pub u_notches: usize,
    /// Number of notches with a depth of their own.
    pub depths: usize,
    /// Number of cut lines that are not closed.
    pub open_cuts: usize,
    /// Number of lines on layers of stripes, plaids and annotation.
    pub references: usize,
    /// Number of lines and points on layers of no standard.
    pub others: usize,
}

impl BlockPiece {
    /// The parts of a block.
    pub fn of(block: &Block) -> Self {
        let mut piece = Self {
            block: block.name.clone(),
            ..Self::default()
        };
        let mut lines: Vec<(Layer, Vec<Vec<Vec2>>)> = Vec::new();
        let mut put = |piece: &mut Self, layer: Layer, points: &[Vec2], is_closed: bool| {
            let mut points = points.to_vec();
            if is_closed {
                let start = points.first().copied();
                points.extend(start);
            }
            if layer == Layer::Other {
                piece.others += 1;
            } else if layer == Layer::Twin {
                piece.has_twins = true;
            } else if let Some((_, all)) = lines.iter_mut().find(|(known, _)| *known == layer) {
                all.push(points);
            } else {
                lines.push((layer, vec![points]));
            }
        };
        for entity in &block.entities {
            let layer = Layer::of(&entity.layer);
            match &entity.drawn {
                Drawn::Line { points, is_closed } => {
                    if let Layer::Notches(kind) = layer {
                        piece.notch_line(points, kind);
                    } else {
                        put(&mut piece, layer, points, *is_closed);
                    }
                }
                Drawn::Point {
                    at,
                    thickness,
                    z,
                    angle: _,
                } => {
                    let has_depth = z.is_some_and(|z| z != 0.0);
                    let is_notch = matches!(layer, Layer::Notches(_));
                    piece.depths += usize::from(is_notch && has_depth);
                    piece.point(layer, entity.layer.trim() == "83", (*at, *thickness));
                }
                Drawn::Text { at, text } => piece.text(*at, text),
            }
        }
        for (layer, all) in lines {
            let found = joined(all, GAP);
            let found = found
                .into_iter()
                .map(|(points, is_closed)| BlockLine { points, is_closed });
            match layer {
                Layer::Cut => piece.cut.extend(found),
                Layer::Sew => piece.sew.extend(found),
                Layer::Internal => piece.internal.extend(found),
                Layer::Cutout => piece.cutouts.extend(found),
                Layer::Mirror => piece.mirror.extend(found),
                Layer::Grain => piece.grain.extend(found),
                Layer::GradeReference => piece.axes.extend(found),
                Layer::Annotation => piece.references += found.count(),
                Layer::TurnPoints
                | Layer::CurvePoints
                | Layer::Notches(_)
                | Layer::Drill
                | Layer::Twin
                | Layer::Other => {}
            }
        }
        let drawn = piece.cut.len();
        piece
            .cut
            .retain(|line| line.is_closed && line.points.len() > 2);
        piece.open_cuts = drawn - piece.cut.len();
        let area = |line: &BlockLine| ring_area(&line.points).abs();
        piece.cut.sort_by(|a, b| area(b).total_cmp(&area(a)));
        piece
    }

    fn point(&mut self, layer: Layer, is_u: bool, (at, thickness): (Vec2, Option<f64>)) {
        match layer {
            Layer::TurnPoints => self.turn_points.push(at),
            Layer::Notches(NotchKind::Slit) => {
                // A width at the boundary makes a V of a slit.
                let is_wide = thickness.is_some_and(|width| width.abs() > 0.0);
                let kind = if is_wide {
                    NotchKind::V
                } else {
                    NotchKind::Slit
                };
                self.notches.push((at, kind));
            }
            Layer::Notches(kind) => {
                self.u_notches += usize::from(is_u);
                self.notches.push((at, kind));
            }
            Layer::Drill => self.drills.push(at),
            Layer::CurvePoints
            | Layer::Cut
            | Layer::GradeReference
            | Layer::Mirror
            | Layer::Grain
            | Layer::Internal
            | Layer::Cutout
            | Layer::Sew
            | Layer::Twin
            | Layer::Annotation => {}
            Layer::Other => self.others += 1,
        }
    }

    /// A notch that is drawn as a line across the boundary: one end of it lies there.
    fn notch_line(&mut self, points: &[Vec2], kind: NotchKind) {
        self.notches.extend(points.first().map(|&at| (at, kind)));
    }

    fn text(&mut self, at: Vec2, text: &str) {
        let number = text
            .trim()
            .strip_prefix('#')
            .map(|number| number.trim().parse::<u32>());
        match number {
            Some(Ok(number)) => self.rules.push((at, number)),
            _ => self.labels.add(text),
        }
    }

    /// Name of the piece: its label, else the name of its block without the size at its end.
    pub fn name(&self) -> String {
        let label = self.labels.value(&["piecename", "piece"]);
        if let Some(name) = label {
            return name.to_owned();
        }
        let size = self.size().filter(|size| !size.is_empty());
        let stripped = size.and_then(|size| {
            let block = self.block.strip_suffix(size.as_str())?;
            Some(block.trim_end_matches(['_', '-', ' ']).to_owned())
        });
        let name = stripped.filter(|name| !name.is_empty());
        name.unwrap_or_else(|| self.block.clone())
    }

    /// Its size, as its label says.
    pub fn size(&self) -> Option<String> {
        let size = self.labels.value(&["size", "sizename"]);
        size.map(str::to_owned)
    }
}
