//! Stages: a panel as drawn, and after each of its operations. Plain numbers.
//!
//! # Decided with
//! - [`crate::document::OperationKind`], [`crate::name::Name`]: the operations; names of corners and lines
//!   that outlive them;
//! - [`crate::stage::dart`], [`crate::stage::diamond`], [`crate::stage::pivot`]: darts taken out, pointed at
//!   both ends, pivoted;
//! - [`crate::stage::truing`], [`crate::stage::fair`], [`crate::stage::kept_length`]: darts trued;
//! - [`crate::press::press_arrows`], [`crate::kinks`]: which way darts and pleats are pressed; kinks that are
//!   left;
//! - [`crate::stage::pleat`](mod@crate::stage::pleat), [`crate::stage::spread`](mod@crate::stage::spread),
//!   [`crate::stage::split`](mod@crate::stage::split), [`crate::stage::fold`]: pleated, spread, split,
//!   unfolded;
//! - [`crate::stage::partition`], [`crate::stage::motion`]: cut apart; parts moved;
//! - [`crate::stage::place`]: places along lines;
//! - [`crate::evaluate`] (`operations.rs`, `stage`, `reshape.rs`): who calls it, with numbers evaluated.
//!
//! Cloth at a dart's mouth and its fold lines: crate `cut` (`dart.rs`, `allowance.rs`, `press.rs`). Words:
//! `inspector/press_words.rs` of the window.

mod dart;
mod diamond;
mod fair;
mod fold;
mod kept_length;
mod motion;
mod partition;
mod pivot;
mod place;
mod pleat;
mod split;
mod spread;
mod truing;

pub(crate) use dart::{DartApex, DartError, DartMouth, cut_dart};
pub(crate) use diamond::cut_diamond;
pub(crate) use fair::{MAX_GROWTH, NotTrued};
pub(crate) use fold::{FoldError, unfold};
pub(crate) use kept_length::width_kept;
pub(crate) use partition::CutError;
pub(crate) use pivot::{PivotError, Pivoting, pivot_dart};
pub(crate) use place::{MarkValue, PlaceError, Placed, Spot, Stretch, is_sewn, reversed};
pub(crate) use pleat::{Pleating, pleat};
pub(crate) use split::{SplitError, split};
pub(crate) use spread::{MAX_CUTS, SpreadAlong, SpreadError, Spreading, spread};
pub(crate) use truing::{CORNER, KINK, true_darts};

use crate::{
    CornerName, EdgeCorner, EdgeName, LineKind, LineName, NotchId, NotchKind, OperationId, Pressed,
};
use std::sync::Arc;
use toile_geometry::{Curve, Vec2};

/// Widths, depths and intakes up to this count as zero (m), since the difference of two equal lengths may
/// have a rounding error.
pub(crate) const NOTHING: f64 = 1e-9;

/// A stage of a panel: the panel as drawn, or after some of its operations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stage {
    /// Lines of the stage: the outline first, then holes, then internal lines.
    pub lines: Vec<StageLine>,
    /// Notches of the stage.
    pub notches: Vec<StageNotch>,
    /// Direction of the warp (rad), from +x counter-clockwise.
    pub grain: f64,
    /// Darts that were taken out, for the shape of the cloth at their mouths.
    pub darts: Vec<StageDart>,
    /// Fold lines along which the stage was unfolded: a point on each (m) and its direction.
    pub folds: Vec<(Vec2, Vec2)>,
    /// Operations that were done, in order.
    pub done: Vec<OperationId>,
    /// Operations that were done but left the panel unchanged, as they take in no cloth.
    pub idle: Vec<OperationId>,
    /// The stages of the left and right side, if the last operation split the stage.
    pub sides: Vec<Arc<Stage>>,
    /// Edges of the outline before its darts were trued. When the next dart is taken out, all darts are trued
    /// again from these edges. Empty if no dart is trued, or if the outline was cut apart after that.
    pub untrued: Vec<StageEdge>,
}

/// A line of a stage.
#[derive(Clone, Debug, PartialEq)]
pub struct StageLine {
    /// Name of the line.
    pub name: LineName,
    /// Half of a folded panel that the line is on: 0 is the half as drawn; each fold has one bit, which is
    /// set for the half beyond that fold.
    pub half: u8,
    /// Kind of line.
    pub kind: LineKind,
    /// Edges of the line, in order. An edge that is a spline has several entries.
    pub edges: Vec<StageEdge>,
    /// The corner at the end of the line, if it is open.
    pub end: Option<CornerName>,
    /// Corners with two names: the second name, and the name that the start of the edge has.
    pub twins: Vec<[CornerName; 2]>,
}

/// An edge of a stage: one curve, and the stretch of a named edge that the curve is.
#[derive(Clone, Debug, PartialEq)]
pub struct StageEdge {
    /// Name of the edge: of an edge in the document, or made by an operation.
    pub name: EdgeName,
    /// Half of a folded panel that the edge is on, as in [`StageLine::half`].
    pub half: u8,
    /// The corner at the start of the edge. `None`: the edge continues another curve of the same named edge.
    pub start: Option<CornerName>,
    /// Share of the named edge's arc length at the start of this edge (1).
    pub from: f64,
    /// Share of the named edge's arc length at the end of this edge (1); less than `from` if this edge runs
    /// against the named edge.
    pub to: f64,
    /// The curve of the edge, directed as the line runs (m).
    pub curve: Curve,
    /// Width of the seam allowance outside the edge (m).
    pub allowance: f64,
    /// Settings of the corner at the start of the edge.
    pub corner: EdgeCorner,
}

/// A notch of a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageNotch {
    /// The notch of the panel.
    pub id: NotchId,
    /// Name of the edge that the notch is on.
    pub edge: EdgeName,
    /// Share of that edge's arc length at the notch (1).
    pub share: f64,
    /// Half of a folded panel that the notch is on.
    pub half: u8,
    /// Shape of the notch.
    pub kind: NotchKind,
    /// Position of the notch (m).
    pub point: Vec2,
    /// Unit vector from the notch into the piece.
    pub inward: Vec2,
}

/// A dart that was taken out of a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageDart {
    /// The operation that took the dart out.
    pub by: OperationId,
    /// Half of a folded panel that the dart is on.
    pub half: u8,
    /// Start and end of the mouth along the outline (m).
    pub mouth: [Vec2; 2],
    /// Apex of the dart (m); for a dart with two points, the first of them.
    pub apex: Vec2,
    /// Point about which the dart is pivoted (m): the apex before it was set back.
    pub pivot: Vec2,
    /// The leg towards which the dart is pressed.
    pub pressed: Pressed,
    /// Whether the dart is trued: the edge is smooth across its closed mouth.
    pub trued: bool,
}

impl Stage {
    /// Edges of the outline; empty if there is no outline.
    pub fn outline(&self) -> &[StageEdge] {
        let found = self
            .lines
            .iter()
            .find(|line| line.kind == LineKind::Outline);
        found.map_or(&[], |line| &line.edges)
    }

    /// Edges of each hole.
    pub fn holes(&self) -> impl Iterator<Item = &[StageEdge]> {
        let holes = self.lines.iter().filter(|line| line.kind == LineKind::Hole);
        holes.map(|line| line.edges.as_slice())
    }

    /// 1 if the outline runs counter-clockwise, else -1.
    pub fn turn(&self) -> f64 {
        let swept: f64 = self.outline().iter().map(|e| e.curve.swept_area()).sum();
        if swept < 0.0 { -1.0 } else { 1.0 }
    }

    /// All numbers of the stage, to compare stages to the last bit.
    fn bits(&self) -> Vec<u64> {
        let mut numbers = vec![self.grain];
        let mut points: Vec<Vec2> = Vec::new();
        let edges = self.lines.iter().flat_map(|line| &line.edges);
        for edge in edges.chain(&self.untrued) {
            numbers.extend([edge.from, edge.to, edge.allowance]);
            if let Curve::Arc { bulge, .. } = edge.curve {
                numbers.push(bulge);
            }
            points.extend(edge.curve.defining_points());
        }
        numbers.extend(self.notches.iter().map(|n| n.share));
        points.extend(self.notches.iter().flat_map(|n| [n.point, n.inward]));
        points.extend(
            self.darts
                .iter()
                .flat_map(|d| [d.mouth[0], d.mouth[1], d.apex, d.pivot]),
        );
        points.extend(self.folds.iter().flat_map(|f| [f.0, f.1]));
        numbers.extend(points.iter().flat_map(|p| [p.x, p.y]));
        numbers.into_iter().map(f64::to_bits).collect()
    }

    /// Whether another stage is equal to the last bit.
    pub fn is_same(&self, other: &Self) -> bool {
        let mut sides = self.sides.iter().zip(&other.sides);
        self == other && self.bits() == other.bits() && sides.all(|(a, b)| a.is_same(b))
    }

    /// The stage mirrored in the y axis, for the mirrored piece of a pair.
    #[must_use]
    pub fn mirror_image(&self) -> Self {
        let mirror = (Vec2::zeros(), Vec2::y());
        let flip = |v: Vec2| Vec2::new(-v.x, v.y);
        Self {
            lines: self
                .lines
                .iter()
                .map(|line| line.mirrored(mirror, 0))
                .collect(),
            notches: self
                .notches
                .iter()
                .map(|notch| StageNotch {
                    point: flip(notch.point),
                    inward: flip(notch.inward),
                    ..*notch
                })
                .collect(),
            grain: std::f64::consts::PI - self.grain,
            darts: self
                .darts
                .iter()
                .map(|dart| StageDart {
                    mouth: [flip(dart.mouth[1]), flip(dart.mouth[0])],
                    apex: flip(dart.apex),
                    pivot: flip(dart.pivot),
                    ..*dart
                })
                .collect(),
            folds: self.folds.iter().map(|f| (flip(f.0), flip(f.1))).collect(),
            done: self.done.clone(),
            idle: self.idle.clone(),
            sides: self
                .sides
                .iter()
                .map(|side| Arc::new(side.mirror_image()))
                .collect(),
            untrued: Vec::new(),
        }
    }
}

impl StageLine {
    /// The line, mirrored in the straight line `mirror`: a point (m) and a direction. If the line is closed
    /// it keeps its direction round the cloth. The bits of `half` are added to the halves of its edges.
    pub(crate) fn mirrored(&self, mirror: (Vec2, Vec2), half: u8) -> Self {
        let mut edges: Vec<StageEdge> = self.edges.clone();
        if self.kind == LineKind::Internal {
            for edge in &mut edges {
                edge.curve = edge.curve.reflected(mirror.0, mirror.1);
                edge.half |= half;
            }
        } else {
            edges = mirrored_edges(&edges, mirror, half, true);
        }
        Self {
            half: self.half | half,
            edges,
            ..self.clone()
        }
    }
}

/// Edges mirrored in the straight line `mirror`, a point (m) and a direction, and walked the other way, so
/// that a closed line keeps its direction. Each corner stays at its place: the corner at the end of an edge
/// becomes the corner at its start.
pub(crate) fn mirrored_edges(
    edges: &[StageEdge],
    mirror: (Vec2, Vec2),
    half: u8,
    closed: bool,
) -> Vec<StageEdge> {
    let count = edges.len();
    (0..count)
        .rev()
        .map(|k| {
            let edge = &edges[k];
            let next = match closed || k + 1 < count {
                true => Some(&edges[(k + 1) % count]),
                false => None,
            };
            StageEdge {
                half: edge.half | half,
                start: next.and_then(|next| next.start),
                corner: next.map_or(EdgeCorner::default(), |next| next.corner),
                from: edge.to,
                to: edge.from,
                curve: edge.curve.reflected(mirror.0, mirror.1).reversed(),
                ..edge.clone()
            }
        })
        .collect()
}

/// The curve with its ends moved to exactly the given points.
pub(crate) fn with_ends(curve: Curve, start: Vec2, end: Vec2) -> Curve {
    match curve {
        Curve::Line { .. } => Curve::Line { start, end },
        Curve::Arc { bulge, .. } => Curve::Arc { start, end, bulge },
        Curve::Quadratic { control, .. } => Curve::Quadratic {
            start,
            control,
            end,
        },
        Curve::Cubic { controls, .. } => Curve::Cubic {
            start,
            controls,
            end,
        },
    }
}
