//! A finished marker with its verdict, and the summary, drawing and file made from it.

use crate::MarkerSummary;
use std::sync::Arc;
use toile_cut::CutPiece;
use toile_interchange::{
    MarkerDrawing, MarkerFabric, MarkerFacts, MarkerFile, MarkerFileUnplaced, MarkerPiece,
};
use toile_nesting::{Item, Marker, Strip, Verdict};

/// A finished marker, with everything needed to draw it.
#[derive(Clone, Debug)]
pub struct FinishedMarker {
    /// Name of the fabric.
    pub fabric: String,
    /// Items with the cut outlines of the pieces.
    pub items: Vec<Item>,
    /// Drawings of the pieces, in the order of the items.
    pub pieces: Vec<Arc<CutPiece>>,
    /// The fabric.
    pub strip: Strip,
    /// The placements.
    pub marker: Marker,
    /// The verdict of the referee.
    pub verdict: Verdict,
    /// Copies that lie on no marker of the fabric, by item and copy of the whole fabric.
    pub missing: Vec<MarkerFileUnplaced>,
    /// Index of the roll among those of the fabric, from 0.
    pub roll: usize,
    /// For a roll: for each item, its index among the items of the whole fabric, and its copies there.
    pub sources: Option<Vec<(usize, Vec<u32>)>>,
    /// Roll, plies, price and notes.
    pub facts: MarkerFacts,
}

impl FinishedMarker {
    /// Summary of the marker.
    pub fn summary(&self) -> MarkerSummary {
        let yardage = self.marker.length * f64::from(self.facts.plies);
        MarkerSummary {
            fabric: self.fabric.clone(),
            roll: self.facts.roll.clone(),
            pieces: self.marker.placements.len(),
            unplaced: self.missing.len(),
            missing: self.reasons(),
            length: self.marker.length,
            width: self.strip.width,
            plies: self.facts.plies,
            yardage,
            cost: self.facts.price_per_metre.map(|price| price * yardage),
            currency: self.facts.currency.clone(),
            efficiency: self.marker.efficiency,
            utilisation: self.marker.utilisation,
            unit: self.facts.unit,
            notes: self.facts.notes.clone(),
            sound: self.verdict.is_sound(),
        }
    }

    /// Faults of the marker that forbid cutting it, in words.
    pub fn faults(&self) -> Vec<String> {
        let name = |k: usize| {
            let laid = &self.marker.placements[k];
            format!("\"{}\" {}", self.items[laid.item].name, laid.copy)
        };
        let violations = self.verdict.violations.iter();
        violations
            .map(|violation| violation.in_words(&name))
            .collect()
    }

    /// Area of the laid pieces, seam allowance included (m2).
    pub fn cut_area(&self) -> f64 {
        let area = |p: &toile_nesting::Placement| self.items[p.item].outline.area().abs();
        self.marker.placements.iter().map(area).sum()
    }

    /// The marker as a drawing.
    pub fn drawing(&self, pattern: &str) -> MarkerDrawing {
        let piece = |placement: &toile_nesting::Placement| {
            let (item, piece) = (&self.items[placement.item], &self.pieces[placement.item]);
            MarkerPiece {
                name: item.name.clone(),
                item: self.of_fabric(placement.item, placement.copy).0,
                piece: piece.clone(),
                pose: placement.pose(item),
            }
        };
        let overlaps = self.verdict.overlaps.iter().flat_map(|o| &o.1);
        MarkerDrawing {
            title: self.title(pattern),
            strip: self.strip.clone(),
            length: self.marker.length,
            efficiency: self.marker.efficiency,
            pieces: self.marker.placements.iter().map(piece).collect(),
            unplaced: self.reasons(),
            overlaps: overlaps.cloned().collect(),
            facts: MarkerFacts {
                utilisation: self.marker.utilisation,
                ..self.facts.clone()
            },
        }
    }

    /// The marker as its file.
    pub fn file(&self, pattern: &str) -> MarkerFile {
        let title = self.title(pattern);
        let mut file = MarkerFile::new(&title, &self.items, &self.strip, &self.marker);
        for piece in &mut file.pieces {
            (piece.item, piece.copy) = self.of_fabric(piece.item, piece.copy);
        }
        MarkerFile {
            roll: self.facts.roll.clone(),
            plies: self.facts.plies,
            face_to_face: self.facts.face_to_face,
            unplaced: self.missing.clone(),
            fabric: MarkerFabric {
                name: Some(self.fabric.clone()),
                ..file.fabric
            },
            ..file
        }
    }

    /// Item and copy of the whole fabric for an item and a copy of this marker.
    pub(crate) fn of_fabric(&self, item: usize, copy: u32) -> (usize, u32) {
        let source = self.sources.as_ref().and_then(|s| s.get(item));
        let own = source.and_then(|(item, copies)| Some((*item, *copies.get(copy as usize)?)));
        own.unwrap_or((item, copy))
    }

    /// Names of the copies that could not be placed, each with the reason.
    fn reasons(&self) -> Vec<[String; 2]> {
        let reason = |u: &MarkerFileUnplaced| [u.name.clone(), u.reason.clone()];
        self.missing.iter().map(reason).collect()
    }

    fn title(&self, pattern: &str) -> String {
        match &self.facts.roll {
            Some(roll) => format!("{pattern}, {}, {roll}", self.fabric),
            None => format!("{pattern}, {}", self.fabric),
        }
    }
}
