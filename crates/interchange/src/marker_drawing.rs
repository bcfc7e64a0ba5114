//! The drawing of a marker, independent of the file format.

use crate::{FormatError, Shown};
use std::sync::Arc;
use toile_cut::CutPiece;
use toile_geometry::Polygon;
use toile_lettering::{missing_letters, missing_note};
use toile_nesting::{Fold, Nap, Pose, Strip};
use toile_pattern::DisplayUnit;

/// Everything that is drawn on a marker.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkerDrawing {
    /// Name of the marker.
    pub title: String,
    /// The fabric.
    pub strip: Strip,
    /// Length of fabric used, end margins included (m).
    pub length: f64,
    /// Area of the pieces divided by width times length between the end margins (0 to 1).
    pub efficiency: f64,
    /// The pieces laid on the fabric.
    pub pieces: Vec<MarkerPiece>,
    /// Names of the copies that could not be placed, each with the reason.
    pub unplaced: Vec<[String; 2]>,
    /// Regions where pieces overlap, in the plane of the fabric (m); empty for a valid marker.
    pub overlaps: Vec<Polygon>,
    /// Facts listed in the report.
    pub facts: MarkerFacts,
}

/// Facts that a report lists beside the drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkerFacts {
    /// Name of the fabric.
    pub fabric: String,
    /// The roll that the marker is cut from, if there are several.
    pub roll: Option<String>,
    /// Number of layers cut at once; the two layers of folded fabric count as one.
    pub plies: u32,
    /// Whether every second ply is turned over.
    pub face_to_face: bool,
    /// Area of the pieces divided by width times length (0 to 1).
    pub utilisation: f64,
    /// Price of one metre of fabric length.
    pub price_per_metre: Option<f64>,
    /// Currency of the price.
    pub currency: String,
    /// The unit of displayed lengths.
    pub unit: DisplayUnit,
    /// Notes for the cutter.
    pub notes: Vec<String>,
}

impl Default for MarkerFacts {
    fn default() -> Self {
        Self {
            fabric: String::new(),
            roll: None,
            plies: 1,
            face_to_face: false,
            utilisation: 0.0,
            price_per_metre: None,
            currency: String::new(),
            unit: DisplayUnit::default(),
            notes: Vec::new(),
        }
    }
}

/// One piece on a marker.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkerPiece {
    /// Name written on the piece.
    pub name: String,
    /// Number of the item; all copies of an item have the same number and are filled with one colour.
    pub item: usize,
    /// Drawing of the piece, in the piece's own plane.
    pub piece: Arc<CutPiece>,
    /// Transform from the piece to the marker.
    pub pose: Pose,
}

fn plural(count: usize) -> String {
    format!("{count} piece{}", if count == 1 { "" } else { "s" })
}

impl MarkerDrawing {
    /// Length of fabric needed for all plies together (m).
    pub fn yardage(&self) -> f64 {
        self.length * f64::from(self.facts.plies)
    }

    /// Price of the fabric needed; `None` if the price of a metre is unknown.
    pub fn cost(&self) -> Option<f64> {
        Some(self.facts.price_per_metre? * self.yardage())
    }

    /// Formatter for lengths and areas in the unit of the marker.
    pub(crate) fn shown(&self) -> Shown {
        Shown(self.facts.unit)
    }

    /// Warning about characters that no font has, in the texts of prints and plots of the marker.
    pub fn missing_note(&self) -> Option<String> {
        let names = self.pieces.iter().map(|piece| &piece.name);
        let names = names.chain(self.unplaced.iter().flatten());
        let facts = [&self.title, &self.facts.fabric, &self.facts.currency];
        let all = names.chain(facts).chain(&self.facts.roll);
        missing_note(&missing_letters(all.map(String::as_str)))
    }

    /// Summary in sentences: length and efficiency, then the fabric, then pieces left out and overlaps.
    pub(crate) fn summary(&self) -> Vec<String> {
        let strip = &self.strip;
        let shown = self.shown();
        let [length, width] = match shown.is_inch() {
            true => [shown.length(self.length), shown.width(strip.width)],
            false => [self.length, strip.width].map(|metres| format!("{metres:.3} m")),
        };
        let mut lines = vec![format!(
            "{} on {length} of fabric {width} wide, efficiency {:.1} %",
            plural(self.pieces.len()),
            self.efficiency * 100.0
        )];
        let nap = match strip.nap {
            Nap::None => "no nap: pieces may point either way",
            Nap::OneWay => "nap: all pieces point one way",
            Nap::PerBundle => "nap: the pieces of a garment point one way",
        };
        lines.push(format!(
            "Warp runs along the length; selvedge {}, end margin {}, gap {}; {nap}; {}.",
            shown.short(strip.selvedge),
            shown.short(strip.end_margin),
            shown.short(strip.gap),
            self.spread()
        ));
        if !self.unplaced.is_empty() {
            let names: Vec<&str> = self.unplaced.iter().map(|u| u[0].as_str()).collect();
            lines.push(format!("Not on this marker: {}.", names.join(", ")));
        }
        if !self.overlaps.is_empty() {
            lines.push("What is cut twice is red.".to_owned());
        }
        lines
    }

    /// The spread in words: number of plies, folded or open, face to face.
    pub(crate) fn spread(&self) -> String {
        let plies = match self.facts.plies {
            1 => String::new(),
            n => format!("{n} plies "),
        };
        let way = match (self.strip.fold, self.facts.face_to_face) {
            (Fold::Open, true) => "face to face",
            (Fold::Open, false) => "open",
            (Fold::Lower, _) => "folded, the fold below",
            (Fold::Both, _) => "tubular, folds above and below",
        };
        format!("{plies}{way}")
    }

    /// Refuses a drawing with numbers that are not finite.
    pub(crate) fn check_numbers(&self) -> Result<(), FormatError> {
        let refuse = |place: String| {
            let hint = "check the piece's outline and make the marker again";
            Err(FormatError::new(place, "a number is not finite", hint))
        };
        let Strip {
            width,
            selvedge,
            end_margin,
            ..
        } = self.strip;
        let sizes = [width, selvedge, end_margin, self.length, self.efficiency];
        if !sizes.iter().all(|x| x.is_finite()) {
            return refuse("marker".into());
        }
        for piece in &self.pieces {
            let [x, y] = piece.pose.axes();
            let mut points = [x, y, piece.pose.translation].into_iter();
            let posed = points.all(|p| p.x.is_finite() && p.y.is_finite());
            if !posed || !piece.piece.is_finite() {
                return refuse(format!("piece \"{}\"", piece.name));
            }
        }
        Ok(())
    }
}
