//! A marker of the document with its pieces where they lie: quick check, search, files.

use crate::ordered::MarkerPieces;
use crate::progress::{SearchProgress, SearchWatcher};
use crate::{FinishedMarker, MarkerError, MarkerSummary};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use toile_cut::CutPiece;
use toile_geometry::Polygon;
use toile_nesting::{Item, Locked, Pose, Search, Side, Strip, Unplaced, clashes};
use toile_pattern::{Marker, OrderedPiece, PiecePlacement};

/// A marker of a document with its pieces where they lie.
pub struct DocumentMarker {
    marker: Arc<Marker>,
    pieces: Arc<MarkerPieces>,
    /// The placements; pieces that wait are listed as unplaced.
    laid: toile_nesting::Marker,
    /// The placement of the document that each of these is.
    sources: Vec<usize>,
    suspended: Vec<OrderedPiece>,
}

/// A piece on a marker.
#[derive(Clone, Copy, Debug)]
pub struct LaidPiece<'a> {
    /// Which it is.
    pub piece: OrderedPiece,
    /// Name to write on it.
    pub name: &'a str,
    /// What is drawn on it, in its own plane; on the fold of the fabric the half that is laid.
    pub cut: &'a Arc<CutPiece>,
    /// Marker from piece.
    pub pose: Pose,
    /// Whether it is locked.
    pub locked: bool,
}

/// A piece of the order that is not laid.
#[derive(Clone, Copy, Debug)]
pub struct WaitingPiece<'a> {
    /// Which it is.
    pub piece: OrderedPiece,
    /// Name to write on it.
    pub name: &'a str,
    /// What is drawn on it, in its own plane.
    pub cut: &'a Arc<CutPiece>,
}

/// Two pieces that overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceOverlap {
    /// The pieces.
    pub pieces: [OrderedPiece; 2],
    /// Where they overlap, in the plane of the fabric [m].
    pub region: Vec<Polygon>,
}

/// A piece that reaches beyond the usable fabric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceOutside {
    /// The piece.
    pub piece: OrderedPiece,
    /// Where.
    pub side: Side,
    /// By how much [m].
    pub by: f64,
}

/// The state of a marker: its overlaps, pieces off the fabric, length, efficiency and cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MarkerState {
    /// Pairs of pieces that overlap.
    pub overlaps: Vec<PieceOverlap>,
    /// Pieces that reach beyond the usable fabric.
    pub outside: Vec<PieceOutside>,
    /// Pieces laid.
    pub laid: usize,
    /// Pieces that wait to be laid.
    pub waiting: usize,
    /// Fabric used, end margins included [m].
    pub length: f64,
    /// Area of the pieces over width times length between the end margins, 0..=1; more where they
    /// overlap.
    pub efficiency: f64,
    /// Area of the pieces over width times length, 0..=1; more where they overlap.
    pub utilisation: f64,
    /// Price of the fabric, all plies together, if a metre's is known.
    pub cost: Option<f64>,
}

/// The layout that a search starts from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// Only the locked pieces.
    #[default]
    Anew,
    /// What lies on the marker: pieces that wait are added, overlaps taken apart. Where all lies
    /// well the marker gets no longer.
    AsItLies,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Where the pieces lie, for `plan::place_marker`.
    pub placements: Vec<PiecePlacement>,
    /// The marker in a few numbers.
    pub summary: MarkerSummary,
}

impl DocumentMarker {
    /// A marker with its pieces.
    pub fn new(marker: Arc<Marker>, pieces: Arc<MarkerPieces>) -> Self {
        let mut laid = toile_nesting::Marker::default();
        let mut sources = Vec::new();
        let mut suspended = Vec::new();
        for (k, placed) in marker.placements.iter().enumerate() {
            let Some(&(item, copy)) = pieces.index.get(&placed.piece) else {
                suspended.push(placed.piece);
                continue;
            };
            sources.push(k);
            laid.placements.push(toile_nesting::Placement {
                item,
                copy,
                turn: placed.turn,
                mirrored: placed.flipped,
                translation: placed.at.into(),
            });
        }
        for (item, copies) in pieces.keys.iter().enumerate() {
            for (key, copy) in copies.iter().zip(0..) {
                if marker.placement(*key).is_none() {
                    laid.unplaced.push(Unplaced {
                        item,
                        copy,
                        reason: "it is not laid yet; lay it, or search".to_owned(),
                    });
                }
            }
        }
        laid.measure(&pieces.job.items, pieces.strip());
        Self {
            marker,
            pieces,
            laid,
            sources,
            suspended,
        }
    }

    /// The marker of the document.
    pub fn marker(&self) -> &Arc<Marker> {
        &self.marker
    }

    /// The fabric as it lies.
    pub fn strip(&self) -> &Strip {
        self.pieces.strip()
    }

    /// The pieces that are laid, in the order of the document.
    pub fn laid(&self) -> impl Iterator<Item = LaidPiece<'_>> {
        let placed = self.laid.placements.iter().zip(&self.sources);
        placed.map(|(placement, &source)| {
            let job = &self.pieces.job;
            let item = &job.items[placement.item];
            let known = &self.marker.placements[source];
            LaidPiece {
                piece: known.piece,
                name: &item.name,
                cut: &job.pieces[placement.item],
                pose: placement.pose(item),
                locked: known.locked,
            }
        })
    }

    /// The pieces of the order that are not laid.
    pub fn waiting(&self) -> impl Iterator<Item = WaitingPiece<'_>> {
        self.laid.unplaced.iter().map(|unplaced| {
            let job = &self.pieces.job;
            WaitingPiece {
                piece: self.pieces.keys[unplaced.item][unplaced.copy as usize],
                name: &job.items[unplaced.item].name,
                cut: &job.pieces[unplaced.item],
            }
        })
    }

    /// Pieces with a place that are not laid now: their panel or size is gone, the order does not
    /// cut them, or they are cut together with another.
    pub fn suspended(&self) -> &[OrderedPiece] {
        &self.suspended
    }

    /// Notes for the cutter.
    pub fn notes(&self) -> &[String] {
        &self.pieces.job.notes
    }

    /// Overlaps and pieces off the fabric as all lies now, with length, efficiency and cost: quick
    /// enough to be asked at every move.
    pub fn state(&self) -> MarkerState {
        let job = &self.pieces.job;
        let found = clashes(&job.items, self.strip(), &self.laid);
        let piece = |k: usize| self.marker.placements[self.sources[k]].piece;
        let overlaps = found.overlaps.into_iter().map(|overlap| PieceOverlap {
            pieces: overlap.pair.map(piece),
            region: overlap.region,
        });
        let outside = found.outside.iter().map(|outside| PieceOutside {
            piece: piece(outside.placement),
            side: outside.side,
            by: outside.by,
        });
        MarkerState {
            overlaps: overlaps.collect(),
            outside: outside.collect(),
            laid: self.laid.placements.len(),
            waiting: self.laid.unplaced.len(),
            length: found.length,
            efficiency: found.efficiency,
            utilisation: found.utilisation,
            cost: job.cost(found.length),
        }
    }

    /// The marker as it lies, judged by all rules, to be drawn and written.
    pub fn finished(&self) -> FinishedMarker {
        self.pieces.finished(self.laid.clone())
    }

    /// Lays the pieces in little length. Locked pieces stay where they are.
    ///
    /// # Errors
    /// Pieces that cannot be laid, a locked one that cannot stay, in words; the search was stopped
    /// before anything was found.
    pub fn search(
        &self,
        (start, search): (Start, Search),
        follow: &mut SearchWatcher<'_>,
    ) -> Result<Found, MarkerError> {
        let mut items = self.pieces.job.items.clone();
        let placed = self.laid.placements.iter().zip(&self.sources);
        for (placement, &source) in placed {
            if self.marker.placements[source].locked {
                items[placement.item].locked.push(Locked {
                    copy: placement.copy,
                    turn: placement.turn,
                    mirrored: placement.mirrored,
                    translation: placement.translation,
                });
            }
        }
        // Where nothing lies but what is locked, both ways begin alike.
        let is_free = |&source: &usize| !self.marker.placements[source].locked;
        let goes_on = start == Start::AsItLies && self.sources.iter().any(is_free);
        let from = goes_on.then_some(&self.laid);
        let flag = follow.stop.clone();
        let mut stopped = false;
        let mut report = |progress: SearchProgress| {
            stopped |= !(follow.report)(&progress);
            !stopped
        };
        let job = &self.pieces.job;
        let made = job.made((&items, from), search, (&flag, &mut report))?;
        let placements = self.placements_of(&made);
        let mut summary = self.pieces.finished(made).summary();
        if stopped || flag.load(Ordering::Relaxed) {
            let note = "stopped early: the best so far";
            summary.notes.push(note.to_owned());
        }
        Ok(Found {
            placements,
            summary,
        })
    }

    /// The marker as a search has it meanwhile, by its progress.
    pub fn under_way(&self, found: &toile_nesting::Marker) -> Self {
        let marker = Marker {
            placements: self.placements_of(found),
            ..(*self.marker).clone()
        };
        Self::new(Arc::new(marker), self.pieces.clone())
    }

    /// Where the pieces of the document lie on a marker that was found.
    fn placements_of(&self, found: &toile_nesting::Marker) -> Vec<PiecePlacement> {
        let each = found.placements.iter().map(|placement| {
            let piece = self.pieces.keys[placement.item][placement.copy as usize];
            let known = self.marker.placement(piece);
            PiecePlacement {
                piece,
                at: placement.translation.into(),
                turn: placement.turn,
                flipped: placement.mirrored,
                locked: known.is_some_and(|known| known.locked),
            }
        });
        each.collect()
    }

    /// The pieces that are laid, each as the search takes it and its outline on the fabric [m].
    pub(crate) fn outlines(&self) -> impl Iterator<Item = (OrderedPiece, &Item, Polygon)> {
        let placed = self.laid.placements.iter().zip(&self.sources);
        placed.map(|(placement, &source)| {
            let item = &self.pieces.job.items[placement.item];
            let outline = placement.pose(item).lay(&item.outline);
            (self.marker.placements[source].piece, item, outline)
        })
    }
}
