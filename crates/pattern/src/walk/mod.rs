//! Walking a seam: the pieces of its second side are laid on those of its first along the seam line, place by
//! place, to compare lengths, notches and the edges that continue across the seam.
//!
//! At every place both seam lines touch and are tangent, with the cloth of the two pieces on opposite sides
//! of the line, as when the seam is sewn and pressed open. The walk skips mouths of darts in the seam, from
//! one leg to the other, as if the darts were closed.

mod joint;
mod notches;

pub use joint::{Joint, SLIGHT_KINK, SMOOTH, Smoothness};
pub use notches::{NOTCH_REACH, NOTCHES_MEET, WalkedNotch};

use crate::plan::Affine;
use crate::{Draft, DraftSeam, DraftSpan, Evaluation, Piece, PieceEdge, SeamOrigin};
use std::sync::Arc;
use toile_geometry::{Path, Vec2};

/// A seam of a draft, measured so that it can be walked.
#[derive(Clone, Debug)]
pub struct Walk<'d> {
    draft: &'d Draft,
    seam: &'d DraftSeam,
    sides: WalkSides,
}

/// The measured sides of a seam. As long as the draft is the same, another walk can use them, so that the
/// seam need not be measured again.
#[derive(Clone, Debug)]
pub struct WalkSides(Arc<[WalkedSide; 2]>);

/// One side of a seam in walking order, without the mouths of darts.
#[derive(Clone, Debug)]
struct WalkedSide {
    runs: Vec<Run>,
    /// Arc length of all runs (m).
    length: f64,
}

/// A run: a stretch of one edge, in walking order.
#[derive(Clone, Debug)]
struct Run {
    span: DraftSpan,
    path: Path,
    /// Arc length from the start of the side to the start of the run (m).
    start: f64,
}

/// A place at which both sides of a seam touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Arc length from the start of each side to the place (m).
    pub along: [f64; 2],
    /// Indices, in the draft, of the pieces that touch at the place.
    pub pieces: [usize; 2],
    /// Position of the place on each piece, in the piece's plane (m).
    pub places: [Vec2; 2],
    /// Map from the plane of the moving piece to the plane of the fixed piece, which lays the moving piece on
    /// the fixed one. It mirrors if the moving piece has to be turned over.
    pub laid: Affine,
}

/// The side of a seam whose piece stays fixed, while the piece of the other side is laid against it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FixedSide {
    /// The piece of the first side stays fixed.
    #[default]
    First,
    /// The piece of the second side stays fixed.
    Second,
}

impl FixedSide {
    /// Index of the fixed side, and index of the side that moves.
    pub fn sides(self) -> [usize; 2] {
        match self {
            Self::First => [0, 1],
            Self::Second => [1, 0],
        }
    }

    /// The other of the two sides.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second => Self::First,
        }
    }
}

impl Evaluation {
    /// Length by which one side of a seam may be longer than the other (m).
    pub fn ease(&self, seam: SeamOrigin) -> f64 {
        match seam {
            SeamOrigin::Seam(id) => self.seam_value(id).map_or(0.0, |value| value.ease),
            SeamOrigin::Dart { .. } => 0.0,
        }
    }
}

impl<'d> Walk<'d> {
    /// Starts the walk of a seam. `None`: a span is missing or a side has no length.
    pub fn new(draft: &'d Draft, seam: &'d DraftSeam) -> Option<Self> {
        let [first, second] = [0, 1].map(|k| WalkedSide::new(draft, &seam.sides[k]));
        Some(Self {
            draft,
            seam,
            sides: WalkSides(Arc::new([first?, second?])),
        })
    }

    /// Starts the walk of a seam whose sides were measured by an earlier walk.
    pub fn again(draft: &'d Draft, seam: &'d DraftSeam, sides: &WalkSides) -> Self {
        Self {
            draft,
            seam,
            sides: sides.clone(),
        }
    }

    /// The measured sides, for [`Self::again`].
    pub fn sides(&self) -> WalkSides {
        self.sides.clone()
    }

    /// Arc length of each side, without the mouths of darts (m).
    pub fn lengths(&self) -> [f64; 2] {
        [self.sides.0[0].length, self.sides.0[1].length]
    }

    /// The place at which both sides touch, given by its arc length on the first side (m); beyond an end of
    /// that side, the end is taken. The place on the second side is at the same share of its length, so that
    /// ease is spread evenly, as in sewing.
    pub fn contact(&self, along: f64, fixed: FixedSide) -> Contact {
        let [first, second] = self.lengths();
        let along = along.clamp(0.0, first);
        let along = [along, along / first * second];
        let at = [0, 1].map(|k| self.sides.0[k].at(along[k]));
        let places = at.map(|(_, place, _)| place);
        let directions = at.map(|(_, _, direction)| direction);
        // The cloth must lie left of the walk on one piece and right of it on the other. Where this is not
        // so, the moving piece is turned over.
        let left = [0, 1].map(|k| self.cloth_is_left(at[k].0));
        let turned_over = left[0] == left[1];
        let [base, moved] = fixed.sides();
        let laid = laying(
            [
                (places[base], directions[base]),
                (places[moved], directions[moved]),
            ],
            turned_over,
        );
        Contact {
            along,
            pieces: at.map(|(run, ..)| run.span.piece),
            places,
            laid,
        }
    }

    /// The place on the side `side` of the seam, on one of its pieces, that is nearest to the point `to` of
    /// the plane of that piece; given by the arc length, on the first side, of the place where the seam
    /// touches there (m). `None`: the side has no stretch on the piece.
    pub fn nearest(&self, side: usize, piece: usize, to: Vec2) -> Option<f64> {
        let own = self.sides.0[side].runs.iter();
        let own = own.filter(|run| run.span.piece == piece);
        let mut best: Option<(f64, f64)> = None;
        for run in own {
            let place = run.path.nearest(to)?;
            let away = (run.path.point(place) - to).norm();
            if best.is_none_or(|(least, _)| away < least) {
                best = Some((away, run.start + place.along));
            }
        }
        let along = best?.1;
        Some(along / self.sides.0[side].length * self.sides.0[0].length)
    }

    /// The stretches of a side on their pieces, in walking order: each with the index of its piece, and the
    /// seam line in the plane of that piece (m).
    pub fn lines(&self, side: usize) -> impl Iterator<Item = (usize, &Path)> {
        let runs = self.sides.0[side].runs.iter();
        runs.map(|run| (run.span.piece, &run.path))
    }

    /// Whether the cloth lies left of a run in walking direction.
    fn cloth_is_left(&self, run: &Run) -> bool {
        let is_forward = run.span.to > run.span.from;
        let is_left = self.draft.pieces.get(run.span.piece);
        is_left.is_none_or(cloth_is_left) == is_forward
    }
}

/// Whether the cloth of a piece lies left of its rings; its outline then runs counter-clockwise.
fn cloth_is_left(piece: &Piece) -> bool {
    let edges = piece.outline.iter();
    edges.map(|edge| edge.curve.swept_area()).sum::<f64>() >= 0.0
}

/// The rings of a piece: its outline, then its holes.
fn rings(piece: &Piece) -> impl Iterator<Item = &[PieceEdge]> {
    let holes = piece.holes.iter().map(Vec::as_slice);
    std::iter::once(piece.outline.as_slice()).chain(holes)
}

/// The edge that a span lies on.
fn edge_of<'d>(draft: &'d Draft, span: &DraftSpan) -> Option<&'d PieceEdge> {
    let piece = draft.pieces.get(span.piece)?;
    rings(piece).flatten().nth(span.edge)
}

/// The rigid map that takes the point `from` to `to` and the direction `was` to `along`; if `turned_over`, it
/// mirrors.
fn laying([(to, along), (from, was)]: [(Vec2, Vec2); 2], turned_over: bool) -> Affine {
    let left = |v: Vec2| Vec2::new(-v.y, v.x);
    let side = if turned_over { -1.0 } else { 1.0 };
    let image = |v: Vec2| along * v.dot(&was) + left(along) * (side * v.dot(&left(was)));
    let axes = [image(Vec2::x()), image(Vec2::y())];
    Affine {
        axes,
        origin: to - image(from),
    }
}

impl WalkedSide {
    fn new(draft: &Draft, spans: &[DraftSpan]) -> Option<Self> {
        let mut runs = Vec::with_capacity(spans.len());
        let mut length = 0.0;
        for span in spans {
            let whole = Path::new(vec![edge_of(draft, span)?.curve]);
            let path = whole.between(span.from * whole.length(), span.to * whole.length());
            let own = path.length();
            if own > 0.0 {
                runs.push(Run {
                    span: *span,
                    path,
                    start: length,
                });
                length += own;
            }
        }
        let can_be_walked = length.is_finite() && length > 0.0;
        can_be_walked.then_some(Self { runs, length })
    }

    /// Run, position and unit direction at an arc length of the side (m). Where two runs meet, they are those
    /// of the second run.
    fn at(&self, along: f64) -> (&Run, Vec2, Vec2) {
        let last = self.runs.len() - 1;
        let k = self.runs.partition_point(|run| run.start <= along);
        let run = &self.runs[k.saturating_sub(1).min(last)];
        let place = run.path.at_length(along - run.start);
        let at = place.map_or_else(Vec2::zeros, |place| run.path.point(place));
        let own = place.and_then(|place| run.path.direction(place));
        // If the derivative of the curve vanishes, as with a handle of length 0, the chord of the run gives
        // the direction.
        let chord = || {
            let ends = run.path.curves().first().zip(run.path.curves().last());
            ends.and_then(|(first, last)| (last.end() - first.start()).try_normalize(1e-15))
        };
        let direction = own.or_else(chord).unwrap_or_else(Vec2::x);
        (run, at, direction)
    }
}
