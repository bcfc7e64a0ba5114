//! The parts of a piece in one block, by their layers (ANSI/AAMA-292, ASTM D6673).

use super::drawing::{Block, Drawn};
use super::labels::Labels;
use crate::drawn::chain::joined;
use std::collections::HashSet;
use toile_geometry::{Bounds2, Vec2, point_segment_distance, ring_area};
use toile_pattern::NotchKind;

/// Largest gap between the ends of open lines that meet (units of the file).
const GAP: f64 = 0.02;

/// Distance of the ends of an outline from the fold that they lie on, as a share of its length (1).
const ON_FOLD: f64 = 1e-3;
/// Share of the square of its length below which a closed line encloses nothing (1).
const FLAT: f64 = 1e-6;

/// Contents of a layer of the standards holds.
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
    /// Dense twins of lines, for checks of quality, by the number of the layer: 84 to 87.
    Twin(u16),
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
            Ok(number @ 84..=87) => Self::Twin(number),
            Ok(9 | 10 | 12 | 15 | 19 | 26) => Self::Annotation,
            _ => Self::Other,
        }
    }
}

/// A line in a block, in the units of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct BlockLine {
    /// Vertices in order.
    pub points: Vec<Vec2>,
    pub is_closed: bool,
    /// For each vertex the points of a curve between it and the next one; empty if there are none on the line.
    pub between: Vec<Vec<Vec2>>,
}

impl BlockLine {
    /// A line through points; those of the set are no vertices.
    fn new((points, is_closed): (Vec<Vec2>, bool), between: &HashSet<[u64; 2]>) -> Self {
        let is_between = |p: &Vec2| between.contains(&bits(*p));
        let first = points.iter().position(|p| !is_between(p));
        let (false, Some(first)) = (between.is_empty(), first) else {
            return Self {
                points,
                is_closed,
                ..Self::default()
            };
        };
        let mut line = Self {
            is_closed,
            ..Self::default()
        };
        let mut points = points;
        points.rotate_left(first);
        for p in points {
            match (is_between(&p), line.between.last_mut()) {
                (true, Some(last)) => last.push(p),
                (true, None) | (false, _) => {
                    line.points.push(p);
                    line.between.push(Vec::new());
                }
            }
        }
        line
    }

    /// Vertices with the points of curves between them.
    pub fn shape(&self) -> Vec<Vec2> {
        let mut shape = Vec::with_capacity(self.points.len());
        for (k, &p) in self.points.iter().enumerate() {
            shape.push(p);
            shape.extend(self.between.get(k).into_iter().flatten());
        }
        shape
    }

    /// Area that the line encloses (square units of the file).
    pub fn area(&self) -> f64 {
        ring_area(&self.shape()).abs()
    }

    /// Length of the line, without the way back to its start.
    pub fn length(&self) -> f64 {
        self.shape()
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).norm())
            .sum()
    }
}

/// Closes the outline of a half that ends on the fold.
fn close_on_fold(lines: &mut [BlockLine], mirror: &[BlockLine]) {
    if lines.iter().any(|line| line.is_closed) {
        return;
    }
    for line in lines.iter_mut().filter(|line| line.points.len() > 2) {
        let gap = ON_FOLD * line.length();
        let ends = [line.points[0], line.points[line.points.len() - 1]];
        let is_on = |fold: &BlockLine| {
            ends.iter().all(|&end| {
                let mut chords = fold.points.windows(2);
                chords.any(|pair| point_segment_distance(end, [pair[0], pair[1]]) <= gap)
            })
        };
        line.is_closed = mirror.iter().any(is_on);
    }
}

/// A place as a key of sets.
fn bits(p: Vec2) -> [u64; 2] {
    [p.x, p.y].map(f64::to_bits)
}

/// A piece in one size as its block has it, in the units of the file.
#[derive(Clone, Debug, Default)]
pub(super) struct BlockPiece {
    /// Name of the block.
    pub block: String,
    /// Texts of the piece.
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
    /// Lines of notches that are drawn as such.
    pub notch_lines: Vec<(BlockLine, NotchKind)>,
    /// Dense twins of its lines, with the numbers of their layers.
    pub twins: Vec<(u16, BlockLine)>,
    /// Number of notches of a U shape, which is not known here.
    pub u_notches: usize,
    /// Number of notches with a depth of their own.
    pub depths: usize,
    /// Number of cut lines that are not closed.
    pub open_cuts: usize,
    /// Number of closed cut lines that enclose nothing.
    pub flat_cuts: usize,
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
        let mut inner = HashSet::new();
        for entity in &block.entities {
            let layer = Layer::of(&entity.layer);
            match &entity.drawn {
                Drawn::Line {
                    points,
                    is_closed,
                    between,
                } => {
                    let flagged = points.iter().zip(between).filter(|(_, is)| **is);
                    inner.extend(flagged.map(|(p, _)| bits(*p)));
                    let mut points = points.clone();
                    if *is_closed {
                        let start = points.first().copied();
                        points.extend(start);
                    }
                    if layer == Layer::Other {
                        piece.others += 1;
                    } else if layer == Layer::Drill {
                        piece.drills.push(Bounds2::of(points).centre());
                    } else if let Some((_, all)) = lines.iter_mut().find(|(l, _)| *l == layer) {
                        all.push(points);
                    } else {
                        lines.push((layer, vec![points]));
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
        // A text that repeats the name of the block says nothing more.
        let name = block.name.to_uppercase();
        let repeats = |text: &String| text.to_uppercase() == name;
        piece.labels.others.retain(|text| !repeats(text));
        for (layer, all) in lines {
            let found = joined(all, GAP).into_iter();
            let found = found.map(|line| BlockLine::new(line, &inner));
            match layer {
                Layer::Cut => piece.cut.extend(found),
                Layer::Sew => piece.sew.extend(found),
                Layer::Internal => piece.internal.extend(found),
                Layer::Cutout => piece.cutouts.extend(found),
                Layer::Mirror => piece.mirror.extend(found),
                Layer::Grain => piece.grain.extend(found),
                Layer::GradeReference => piece.axes.extend(found),
                Layer::Annotation => piece.references += found.count(),
                Layer::Notches(kind) => piece.notch_lines.extend(found.map(|line| (line, kind))),
                Layer::Twin(number) => piece.twins.extend(found.map(|line| (number, line))),
                Layer::TurnPoints | Layer::CurvePoints | Layer::Drill | Layer::Other => {}
            }
        }
        close_on_fold(&mut piece.cut, &piece.mirror);
        close_on_fold(&mut piece.sew, &piece.mirror);
        piece.open_cuts = piece.cut.iter().filter(|line| !line.is_closed).count();
        // The one line of a piece with a name is its outline.
        let is_named = piece.label().is_some();
        if let ([line], true) = (&mut piece.cut[..], is_named) {
            line.is_closed = true;
        }
        piece
            .cut
            .retain(|line| line.is_closed && line.shape().len() > 2);
        let closed = piece.cut.len();
        piece
            .cut
            .retain(|line| line.area() > FLAT * line.length().powi(2));
        piece.flat_cuts = closed - piece.cut.len();
        piece.cut.sort_by(|a, b| b.area().total_cmp(&a.area()));
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
            | Layer::Twin(_)
            | Layer::Annotation => {}
            Layer::Other => self.others += 1,
        }
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

    /// Name of the piece, as its label says.
    pub fn label(&self) -> Option<&str> {
        self.labels.value(&["piecename", "piece"])
    }

    /// Name of its block without a size at the end.
    pub fn stem(&self, size: &str) -> Option<&str> {
        let cut = self.block.len().checked_sub(size.len())?;
        let (stem, end) = self.block.split_at_checked(cut)?;
        let stem = stem.trim_end_matches(['_', '-', ' ']);
        let is_size = !size.is_empty() && end.eq_ignore_ascii_case(size);
        (is_size && !stem.is_empty()).then_some(stem)
    }

    /// The line that the panel becomes: the sew line where there is one.
    pub fn outline(&self) -> Option<&BlockLine> {
        let sew = self.sew.iter().find(|line| line.is_closed);
        sew.or(self.cut.first())
    }

    /// Leaves out last vertices of closed lines that repeat the first.
    pub fn drop_repeated_starts(&mut self) {
        let groups = [
            &mut self.cut,
            &mut self.sew,
            &mut self.internal,
            &mut self.cutouts,
        ];
        for line in groups.into_iter().flatten().filter(|line| line.is_closed) {
            while line.points.len() > 3 && line.points.last() == line.points.first() {
                line.points.pop();
                let last = line.between.pop().unwrap_or_default();
                if let Some(before) = line.between.last_mut() {
                    before.extend(last);
                }
            }
        }
    }

    /// Number of marks that stand in the block of the sample size alone.
    pub fn marks(&self) -> usize {
        self.turn_points.len() + self.notches.len() + self.notch_lines.len()
    }

    /// The size, as its label says.
    pub fn size(&self) -> Option<String> {
        let size = self.labels.value(&["size", "sizename"]);
        size.map(str::to_owned)
    }

    /// The size that some programs label as the sample size.
    pub fn sample_size(&self) -> Option<String> {
        self.labels.value(&["samplesize"]).map(str::to_owned)
    }
}
