//! A marker of the document with its placed pieces: quick check, search, files.
//!
//! # Decided with
//! - [`toile_pattern::Marker`], [`crate::ordered::MarkerPieces`]: the marker in the document; the pieces of
//!   its order;
//! - [`toile_nesting::clashes()`], [`crate::document_marker::DocumentMarker::state`]: quick check of pieces
//!   laid by hand;
//! - [`crate::document_marker::DocumentMarker::search`],
//!   [`crate::document_marker::DocumentMarker::under_way`]: the search; the marker as the search has it
//!   meanwhile;
//! - [`crate::document_marker::DocumentMarker::let_go`] (`butting.rs`): pieces let go against neighbours;
//! - [`crate::finished_marker::FinishedMarker`], [`crate::summary::MarkerSummary`]: verdict and numbers;
//! - [`crate::file::marker_files`], [`crate::file_check::judge_file`]: files written; a file checked again.
//!
//! Kept and shown by crate `session` (`markers.rs`, `marker_cache.rs`) and the window (`app/marker_pane.rs`).

use crate::ordered::MarkerPieces;
use crate::progress::{SearchProgress, SearchWatcher};
use crate::{FinishedMarker, MarkerError, MarkerSummary};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use toile_cut::CutPiece;
use toile_geometry::Polygon;
use toile_nesting::{Item, Locked, Pose, Search, Side, Strip, Unplaced, clashes};
use toile_pattern::{Marker, OrderedPiece, PiecePlacement};

/// A marker of a document with its placed pieces.
pub struct DocumentMarker {
    marker: Arc<Marker>,
    pieces: Arc<MarkerPieces>,
    /// Index of the displayed roll, from 0.
    roll: usize,
    /// The placements on the displayed roll; pieces still to be laid are listed as unplaced.
    laid: toile_nesting::Marker,
    /// For each placement in `laid`, its index among the placements of the document.
    sources: Vec<usize>,
    suspended: Vec<OrderedPiece>,
}

/// A piece on a marker.
#[derive(Clone, Copy, Debug)]
pub struct LaidPiece<'a> {
    /// Identity of the piece in the order.
    pub piece: OrderedPiece,
    /// Name written on the piece.
    pub name: &'a str,
    /// Drawing of the piece, in the piece's own plane; for a piece on the fold of the fabric only the half
    /// that is laid.
    pub cut: &'a Arc<CutPiece>,
    /// Transform from the piece to the marker.
    pub pose: Pose,
    /// Whether the piece is locked.
    pub locked: bool,
}

/// A piece of the order that is not laid yet.
#[derive(Clone, Copy, Debug)]
pub struct WaitingPiece<'a> {
    /// Identity of the piece in the order.
    pub piece: OrderedPiece,
    /// Name written on the piece.
    pub name: &'a str,
    /// Drawing of the piece, in the piece's own plane.
    pub cut: &'a Arc<CutPiece>,
}

/// Two pieces that overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceOverlap {
    /// The pieces.
    pub pieces: [OrderedPiece; 2],
    /// Region of the overlap, in the plane of the fabric (m).
    pub region: Vec<Polygon>,
}

/// A piece that extends beyond the usable fabric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceOutside {
    /// The piece.
    pub piece: OrderedPiece,
    /// Side of the fabric at which it extends beyond.
    pub side: Side,
    /// Distance by which it extends beyond (m).
    pub by: f64,
}

/// The state of a marker: its overlaps, pieces off the fabric, length, efficiency and cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MarkerState {
    /// Pairs of pieces that overlap.
    pub overlaps: Vec<PieceOverlap>,
    /// Pieces that extend beyond the usable fabric.
    pub outside: Vec<PieceOutside>,
    /// Number of pieces laid.
    pub laid: usize,
    /// Number of pieces still to be laid.
    pub waiting: usize,
    /// Length of fabric used, end margins included (m).
    pub length: f64,
    /// Area of the pieces divided by width times length between the end margins (0 to 1, more if pieces
    /// overlap).
    pub efficiency: f64,
    /// Area of the pieces divided by width times length (0 to 1, more if pieces overlap).
    pub utilisation: f64,
    /// Price of the fabric for all plies, if the price per metre is known.
    pub cost: Option<f64>,
}

/// The layout that a search starts from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// Only the locked pieces; all others are placed anew.
    #[default]
    Anew,
    /// The current layout: unplaced pieces are added and overlaps resolved. If the layout is complete and
    /// valid, the marker does not get longer.
    AsItLies,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Placements found, for `plan::place_marker`.
    pub placements: Vec<PiecePlacement>,
    /// Summary of the marker on each roll.
    pub summaries: Vec<MarkerSummary>,
}

impl DocumentMarker {
    /// A marker with its pieces.
    pub fn new(marker: Arc<Marker>, pieces: Arc<MarkerPieces>) -> Self {
        Self::on_roll(marker, pieces, 0)
    }

    /// A marker with the pieces on one of its rolls, counted from 0; the last roll if there are fewer.
    pub fn on_roll(marker: Arc<Marker>, pieces: Arc<MarkerPieces>, roll: usize) -> Self {
        let rolls = pieces.rolls().count();
        let roll = roll.min(rolls.saturating_sub(1));
        let mut laid = toile_nesting::Marker::default();
        let mut sources = Vec::new();
        let mut suspended = Vec::new();
        for (k, placed) in marker.placements.iter().enumerate() {
            let Some(&(item, copy)) = pieces.index.get(&placed.piece) else {
                suspended.push(placed.piece);
                continue;
            };
            if usize::from(placed.roll) != roll {
                continue;
            }
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
                // Pieces on a roll that no longer exists are unplaced, too.
                let placed = marker.placement(*key);
                if placed.is_none_or(|placed| usize::from(placed.roll) >= rolls) {
                    laid.unplaced.push(Unplaced {
                        item,
                        copy,
                        reason: "it is not laid yet; lay it, or search".to_owned(),
                    });
                }
            }
        }
        laid.measure(&pieces.job.items, pieces.strip(roll));
        Self {
            marker,
            pieces,
            roll,
            laid,
            sources,
            suspended,
        }
    }

    /// The marker of the document.
    pub fn marker(&self) -> &Arc<Marker> {
        &self.marker
    }

    /// Names of the rolls in order; a single `None` if no rolls are defined.
    pub fn rolls(&self) -> impl Iterator<Item = Option<&str>> {
        self.pieces.rolls()
    }

    /// Index of the displayed roll, from 0.
    pub fn roll(&self) -> usize {
        self.roll
    }

    /// The spread fabric of the displayed roll.
    pub fn strip(&self) -> &Strip {
        self.pieces.strip(self.roll)
    }

    /// The laid pieces, in the order of the document.
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

    /// The pieces of the order that are not laid yet.
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

    /// Placed pieces that are not shown now: their panel or size was deleted, the order does not include
    /// them, or they are cut together with another piece.
    pub fn suspended(&self) -> &[OrderedPiece] {
        &self.suspended
    }

    /// Notes for the cutter.
    pub fn notes(&self) -> &[String] {
        &self.pieces.job.notes
    }

    /// Overlaps, pieces beyond the fabric, length, efficiency and cost of the current layout: fast enough to
    /// be called at every move.
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
            cost: job.cost(found.length, self.roll),
        }
    }

    /// The current marker with the full check of all rules, to be drawn and written.
    pub fn finished(&self) -> FinishedMarker {
        let mut laid = self.laid.clone();
        let waiting = laid.unplaced.len();
        laid.unplaced.extend(self.elsewhere());
        let mut finished = self.pieces.job.whole(laid, self.roll);
        finished.missing.truncate(waiting);
        finished
    }

    /// The pieces that lie on other rolls.
    fn elsewhere(&self) -> impl Iterator<Item = Unplaced> {
        let rolls = self.rolls().count();
        let others = self.marker.placements.iter().filter_map(move |placed| {
            let on = usize::from(placed.roll);
            let is_other = on != self.roll && on < rolls;
            self.pieces.index.get(&placed.piece).filter(|_| is_other)
        });
        others.map(|&(item, copy)| Unplaced {
            item,
            copy,
            reason: "it lies on another roll".to_owned(),
        })
    }

    /// The finished marker of every roll with pieces, or of the first roll if there are no pieces. Pieces
    /// that lie on no roll are listed as missing on the last of these markers.
    pub fn finished_rolls(&self) -> Vec<FinishedMarker> {
        let rolls = 0..self.rolls().count();
        let each = rolls.map(|roll| Self::on_roll(self.marker.clone(), self.pieces.clone(), roll));
        let (full, empty): (Vec<Self>, Vec<Self>) =
            each.partition(|own| !own.laid.placements.is_empty());
        let first = empty.iter().take(usize::from(full.is_empty()));
        let mut finished: Vec<FinishedMarker> =
            full.iter().chain(first).map(Self::finished).collect();
        if let Some((_, before)) = finished.split_last_mut() {
            before.iter_mut().for_each(|own| own.missing.clear());
        }
        finished
    }

    /// Searches for a short layout of the pieces. Locked pieces stay in place.
    ///
    /// # Errors
    /// Pieces that cannot be laid or a locked piece that cannot stay, in words; the search was stopped before
    /// it found a layout.
    pub fn search(
        &self,
        (start, search): (Start, Search),
        follow: &mut SearchWatcher<'_>,
    ) -> Result<Found, MarkerError> {
        if self.pieces.job.is_on_rolls() {
            return self.search_on_rolls((start, search), follow);
        }
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
        // If only locked pieces are laid, both kinds of start are the same.
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
        let finished = job.whole(made, 0);
        let is_stopped = stopped || flag.load(Ordering::Relaxed);
        Ok(found(placements, &[finished], is_stopped))
    }

    /// Places all pieces anew, roll after roll.
    fn search_on_rolls(
        &self,
        (start, search): (Start, Search),
        follow: &mut SearchWatcher<'_>,
    ) -> Result<Found, MarkerError> {
        if start == Start::AsItLies && !self.marker.placements.is_empty() {
            return Err(MarkerError::Conflict(
                "the marker is laid on rolls, and markers on rolls cannot be gone on from; lay it anew, or leave the rolls out".to_owned(),
            ));
        }
        if self.marker.placements.iter().any(|laid| laid.locked) {
            return Err(MarkerError::Conflict(
                "pieces are locked, and on rolls each is laid anew; unlock them, or leave the rolls out".to_owned(),
            ));
        }
        let flag = follow.stop.clone();
        let mut stopped = false;
        let mut report = |progress: SearchProgress| {
            stopped |= !(follow.report)(&progress);
            !stopped
        };
        let finished = self.pieces.job.lay_on_rolls(search, (&flag, &mut report))?;
        let placements = finished.iter().flat_map(|own| {
            own.marker.placements.iter().map(|placement| {
                let (item, copy) = own.of_fabric(placement.item, placement.copy);
                PiecePlacement {
                    piece: self.pieces.keys[item][copy as usize],
                    at: placement.translation.into(),
                    turn: placement.turn,
                    flipped: placement.mirrored,
                    locked: false,
                    roll: own.roll as u16,
                }
            })
        });
        let placements = placements.collect();
        let is_stopped = stopped || flag.load(Ordering::Relaxed);
        Ok(found(placements, &finished, is_stopped))
    }

    /// The intermediate marker of a running search, from its progress.
    pub fn under_way(&self, found: &toile_nesting::Marker) -> Self {
        let marker = Marker {
            placements: self.placements_of(found),
            ..(*self.marker).clone()
        };
        Self::on_roll(Arc::new(marker), self.pieces.clone(), self.roll)
    }

    /// Placements of the document's pieces on a marker that was found.
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
                roll: 0,
            }
        });
        each.collect()
    }

    /// The laid pieces, each with its item and its outline on the fabric (m).
    pub(crate) fn outlines(&self) -> impl Iterator<Item = (OrderedPiece, &Item, Polygon)> {
        let placed = self.laid.placements.iter().zip(&self.sources);
        placed.map(|(placement, &source)| {
            let item = &self.pieces.job.items[placement.item];
            let outline = placement.pose(item).lay(&item.outline);
            (self.marker.placements[source].piece, item, outline)
        })
    }
}

/// The result of a search, with a note if the search was stopped early.
fn found(placements: Vec<PiecePlacement>, finished: &[FinishedMarker], is_stopped: bool) -> Found {
    let mut summaries: Vec<MarkerSummary> = finished.iter().map(FinishedMarker::summary).collect();
    if is_stopped {
        for summary in &mut summaries {
            summary
                .notes
                .push("stopped early: the best so far".to_owned());
        }
    }
    Found {
        placements,
        summaries,
    }
}
