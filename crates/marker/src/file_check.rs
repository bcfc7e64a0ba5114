//! Checks a marker file as it is, even after manual edits.

use crate::MarkerSummary;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_4, PI};
use toile_cut::CutPiece;
use toile_geometry::{Polygon, Vec2, total_area};
use toile_interchange::{MarkerDrawing, MarkerFacts, MarkerFile, MarkerPiece};
use toile_nesting::{Allowed, Item, Marker, Mirror, Nap, Violation, judge};

/// Outlines in the file are rounded to a micrometre, so that touching pieces may seem to overlap by this much
/// (m).
const ROUNDING: f64 = 3e-6;

/// Largest deviation of a grain from the warp on fabric with a nap (rad): a piece beyond it does not run
/// along the warp at all.
const MAX_TILT: f64 = FRAC_PI_4;

/// The result of a check of a marker file.
#[derive(Clone, Debug)]
pub struct Judged {
    /// Summary of the marker.
    pub summary: MarkerSummary,
    /// Faults in words; empty if the marker can be cut.
    pub faults: Vec<String>,
    /// The marker as a drawing, with the regions where pieces overlap.
    pub drawing: MarkerDrawing,
}

/// Checks a marker by the outlines in its file: overlaps, gaps, margins, nap of each garment, print, flaws.
/// Rules known only to the pattern (allowed tilt, folds, pairs, locks) are not checked.
pub fn judge_file(file: &MarkerFile) -> Judged {
    let items = items_of(file);
    let mut marker = file.marker();
    marker.unplaced.clear();
    for (k, placement) in marker.placements.iter_mut().enumerate() {
        (placement.item, placement.copy) = (k, 0);
    }
    let strip = file.strip();
    let verdict = judge(&items, &strip, &marker);
    marker.measure(&items, &strip);
    let name = |k: usize| {
        file.pieces
            .get(k)
            .map_or_else(String::new, |p| format!("\"{}\" {}", p.name, p.copy))
    };
    let faults: Vec<String> = verdict
        .violations
        .iter()
        .filter(|v| !within_rounding(v))
        .map(|v| v.in_words(&name))
        .collect();
    let overlaps: Vec<Polygon> = verdict
        .overlaps
        .iter()
        .filter(|o| total_area(&o.1) > ROUNDING * ROUNDING)
        .flat_map(|o| o.1.iter().cloned())
        .collect();
    let summary = MarkerSummary {
        fabric: file.name.clone(),
        roll: file.roll.clone(),
        pieces: file.pieces.len(),
        unplaced: file.unplaced.len(),
        length: verdict.length,
        width: strip.width,
        plies: file.plies,
        yardage: verdict.length * f64::from(file.plies),
        efficiency: marker.efficiency,
        utilisation: marker.utilisation,
        sound: faults.is_empty(),
        ..MarkerSummary::default()
    };
    Judged {
        summary,
        faults,
        drawing: drawing_of(file, (items, overlaps), &marker),
    }
}

/// Every piece as an item of its own, transformed back to its own plane.
fn items_of(file: &MarkerFile) -> Vec<Item> {
    let has_nap = file.strip().nap != Nap::None;
    let item = |piece: &toile_interchange::MarkerFilePiece| {
        let pose = toile_nesting::Pose {
            grain: piece.grain.to_radians(),
            turn: piece.turn.to_radians(),
            mirrored: piece.face_down,
            translation: Vec2::new(piece.at[0], piece.at[1]),
        };
        let [x, y] = pose.axes();
        let back = |p: Vec2| {
            let from = p - pose.translation;
            Vec2::new(from.dot(&x), from.dot(&y))
        };
        let ring = |ring: &Vec<[f64; 2]>| ring.iter().map(|&p| back(Vec2::from(p))).collect();
        let outline = Polygon {
            outer: ring(&piece.outline),
            holes: piece.holes.iter().map(ring).collect(),
        };
        let half_turns = (pose.turn / PI).round() * PI;
        let most = match has_nap {
            true => MAX_TILT,
            false => PI,
        };
        Item {
            grain: pose.grain,
            allowed: Allowed {
                tilt: (pose.turn - half_turns).abs().min(most),
                mirror: Mirror::Free,
                ..Allowed::turned(vec![0.0, PI])
            },
            gap: piece.gap,
            bundles: vec![piece.garment],
            over_flaws: piece.over_flaws,
            match_point: piece.on_print.map(|p| p.match_point()),
            ..Item::new(piece.name.clone(), outline)
        }
    };
    file.pieces.iter().map(item).collect()
}

fn drawing_of(
    file: &MarkerFile,
    (items, overlaps): (Vec<Item>, Vec<Polygon>),
    judged: &Marker,
) -> MarkerDrawing {
    let marker = file.marker();
    let mut kinds: BTreeMap<usize, usize> = BTreeMap::new();
    let pieces = items.into_iter().zip(&marker.placements);
    MarkerDrawing {
        title: file.name.clone(),
        strip: file.strip(),
        length: judged.length,
        efficiency: judged.efficiency,
        pieces: pieces
            .map(|(item, placement)| {
                let count = kinds.len();
                MarkerPiece {
                    name: item.name.clone(),
                    item: *kinds.entry(placement.item).or_insert(count),
                    pose: placement.pose(&item),
                    piece: CutPiece::of_outline(&item.name, &item.outline, item.grain).into(),
                }
            })
            .collect(),
        unplaced: file
            .unplaced
            .iter()
            .map(|u| [u.name.clone(), u.reason.clone()])
            .collect(),
        overlaps,
        facts: MarkerFacts {
            roll: file.roll.clone(),
            plies: file.plies,
            face_to_face: file.face_to_face,
            utilisation: judged.utilisation,
            ..MarkerFacts::default()
        },
    }
}

/// Whether a violation may be due to rounding in the file.
fn within_rounding(violation: &Violation) -> bool {
    match violation {
        Violation::Overlap { depth, .. } => *depth < ROUNDING,
        Violation::Gap {
            distance, needed, ..
        } => needed - distance < ROUNDING,
        Violation::Outside { by, .. } => *by < ROUNDING,
        Violation::Length { stated, found } => (stated - found).abs() < ROUNDING,
        Violation::OffPrint { by, .. } => by.amax() < ROUNDING,
        Violation::Orientation { .. }
        | Violation::Nap { .. }
        | Violation::OffFold { .. }
        | Violation::OnFlaw { .. }
        | Violation::Moved { .. }
        | Violation::Copy { .. }
        | Violation::Nonsense { .. } => false,
    }
}
