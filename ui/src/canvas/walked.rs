//! Geometry of a walked seam, cached while its draft is the same: it is drawn in every frame and at every
//! place of the walk.

use super::fill::{Fill, fill};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_geometry::{Curve, Vec2};
use toile_pattern::walk::{Walk, WalkSides, WalkedNotch};
use toile_pattern::{Draft, DraftSeam, Piece, SeamId, SeamOrigin};

/// Largest distance between a curve and the polyline drawn for it (m).
const FLATNESS: f64 = 1e-4;

/// Geometry of a seam that is walked.
#[derive(Debug)]
pub struct WalkedSeam {
    /// Measurements of both sides of the seam: a new walk uses them and does not measure again.
    sides: WalkSides,
    /// Index of the seam in the draft.
    at: usize,
    /// Pieces of the seam, by their index in the draft.
    pub pieces: BTreeMap<usize, WalkedPiece>,
    /// Stretches of each side: index of the piece in the draft, and polyline in the piece's plane (m).
    pub lines: [Vec<(usize, Vec<Vec2>)>; 2],
    /// Notches of the seam.
    pub notches: Vec<WalkedNotch>,
}

/// A piece that is laid along a seam, in its own plane (m).
#[derive(Debug)]
pub struct WalkedPiece {
    /// Outline and holes.
    pub rings: Vec<Vec<Vec2>>,
    /// Fill of the piece.
    pub fill: Fill,
}

impl WalkedSeam {
    fn new(draft: &Draft, id: SeamId) -> Option<Self> {
        let mut seams = draft.seams.iter();
        let at = seams.position(|seam| seam.id == SeamOrigin::Seam(id))?;
        let walk = Walk::new(draft, &draft.seams[at])?;
        let lines = [0, 1].map(|side| {
            let lines = walk.lines(side);
            let lines = lines.map(|(k, path)| (k, path.flatten(FLATNESS)));
            lines.collect::<Vec<_>>()
        });
        let all = lines.iter().flatten().map(|(k, _)| *k);
        let pieces = all.filter_map(|k| Some((k, WalkedPiece::new(draft.pieces.get(k)?))));
        Some(Self {
            pieces: pieces.collect(),
            sides: walk.sides(),
            at,
            notches: walk.notches(),
            lines,
        })
    }

    /// The seam in a draft, and its walk; `draft` must be the draft on which the seam was measured.
    pub fn walk<'d>(&self, draft: &'d Draft) -> Option<(&'d DraftSeam, Walk<'d>)> {
        let seam = draft.seams.get(self.at)?;
        Some((seam, Walk::again(draft, seam, &self.sides)))
    }
}

impl WalkedPiece {
    fn new(piece: &Piece) -> Self {
        let ring = |curves: &mut dyn Iterator<Item = &Curve>| -> Vec<Vec2> {
            curves.flat_map(|curve| curve.flatten(FLATNESS)).collect()
        };
        let outline = ring(&mut piece.outline.iter().map(|edge| &edge.curve));
        let holes = piece.holes.iter();
        let holes = holes.map(|hole| ring(&mut hole.iter().map(|edge| &edge.curve)));
        let rings: Vec<Vec<Vec2>> = std::iter::once(outline).chain(holes).collect();
        Self {
            fill: fill(&rings),
            rings,
        }
    }
}

/// Draft, seam and geometry of the last walk; the geometry is `None` if the seam cannot be walked.
type Kept = (Arc<Draft>, SeamId, Option<Arc<WalkedSeam>>);

/// Cache of the last seam that was walked.
#[derive(Debug, Default)]
pub(super) struct WalkedLast {
    kept: RefCell<Option<Kept>>,
    made: Cell<u64>,
}

impl WalkedLast {
    /// Geometry of a seam of a draft; `None` if the seam cannot be walked.
    pub fn seam(&self, draft: &Arc<Draft>, id: SeamId) -> Option<Arc<WalkedSeam>> {
        let mut kept = self.kept.borrow_mut();
        if let Some((of, known, seam)) = &*kept
            && Arc::ptr_eq(of, draft)
            && *known == id
        {
            return seam.clone();
        }
        self.made.set(self.made.get() + 1);
        let seam = WalkedSeam::new(draft, id).map(Arc::new);
        *kept = Some((draft.clone(), id, seam.clone()));
        seam
    }

    /// Number of seams measured so far.
    pub fn made(&self) -> u64 {
        self.made.get()
    }
}
