//! The pieces of drafts that are to be laid, with their fabric and garments.

use crate::marks::resolve_marks;
use crate::{MarkerError, NestOptions};
use std::sync::Arc;
use toile_cut::{CutOptions, CutPiece, concerns_cutter};
use toile_geometry::Vec2;
use toile_interchange::{ANY_NAME, PieceSettings};
use toile_nesting::{MAX_PIECES, NestingError};
use toile_pattern::{Diagnostic, DisplayUnit, Draft, Pattern, Piece};

/// Garments to cut from one draft.
#[derive(Clone, Copy, Debug)]
pub struct Garments<'a> {
    /// The pattern.
    pub pattern: &'a Pattern,
    /// The pattern drafted to a size.
    pub draft: &'a Draft,
    /// Number of garments.
    pub count: u32,
    /// Label added to the names of the pieces to distinguish them from other drafts, such as a size.
    pub label: Option<&'a str>,
}

/// A piece of one draft that is to be cut from a fabric.
#[derive(Clone, Debug)]
pub(crate) struct PieceToCut {
    pub fabric: String,
    /// Number of the first copy; copies from additional fabrics are numbered after those of the panel.
    pub first_copy: u32,
    pub cut: Arc<CutPiece>,
    pub settings: PieceSettings,
    /// Name on the marker and in messages.
    pub name: String,
    /// The garment of each copy.
    pub bundles: Vec<u32>,
    /// Marks to match with the print: number of the set, and the point (m).
    pub marks: Vec<(usize, Vec2)>,
    /// Display unit of the pattern.
    pub unit: DisplayUnit,
    /// Faults of the cut line, in words.
    pub notes: Vec<String>,
}

/// All pieces to be cut, in the order of the drafts. If marks are matched, the pieces of every garment are
/// listed separately, since each garment is matched separately. If a fabric is named, only pieces of that
/// fabric.
pub(crate) fn pieces_to_cut(
    garments: &[Garments<'_>],
    options: &NestOptions,
    only: Option<&str>,
) -> Result<Vec<PieceToCut>, MarkerError> {
    check_piece_names(garments, options)?;
    check_count(garments, options)?;
    let mut all = Vec::new();
    let mut first = 0;
    for garment in garments {
        let marks = resolve_marks(garment.pattern, options);
        let bundles: Vec<u32> = (first..first + garment.count).collect();
        first += garment.count;
        let alone = options.matches_marks();
        let parts: Vec<Vec<u32>> = match alone {
            true => bundles.iter().map(|&b| vec![b]).collect(),
            false => vec![bundles],
        };
        for bundles in parts {
            for (number, piece) in garment.draft.pieces.iter().enumerate() {
                let Some(own) = garment.draft.fabrics.get(piece.fabric) else {
                    continue;
                };
                let settings = options.piece(garment.pattern, piece);
                let fabric = settings.fabric.as_deref().unwrap_or(&own.name);
                let also = settings.also.iter().flatten();
                let also = also.filter(|(_, count)| piece.id.copy == 0 && **count > 0);
                let panel = garment.pattern.panel(piece.id.panel);
                let beside = panel.map_or(1, |panel| panel.cut.quantity);
                let cut_from = std::iter::once((fabric, 1, piece.id.copy));
                let also = also.map(|(fabric, count)| (&**fabric, *count, beside));
                let cut_from: Vec<(&str, u32, u32)> = cut_from
                    .chain(also)
                    .filter(|(fabric, ..)| only.is_none_or(|only| only == *fabric))
                    .collect();
                if cut_from.is_empty() {
                    continue;
                }
                let cut = cut_piece(garment, number, &settings)?;
                let found = match piece.id.copy {
                    0 => cut.diagnostics(garment.pattern),
                    _ => Vec::new(),
                };
                let name = match garment.label {
                    Some(label) => format!("{} {label}", piece.name),
                    None => piece.name.clone(),
                };
                let to_cut = |fabric: &str, count: u32, first_copy: u32| PieceToCut {
                    fabric: fabric.to_owned(),
                    first_copy,
                    name: name.clone(),
                    bundles: bundles
                        .iter()
                        .flat_map(|&b| (0..count).map(move |_| b))
                        .collect(),
                    marks: marks
                        .iter()
                        .filter(|mark| mark.1 == piece.id.panel)
                        .filter_map(|mark| {
                            let notch = cut.notches.iter().find(|n| n.id == mark.2)?;
                            Some((mark.0, notch.point))
                        })
                        .collect(),
                    settings: settings.clone(),
                    cut: cut.clone(),
                    unit: garment.pattern.unit,
                    notes: notes_of(&found, garment.label),
                };
                all.extend(
                    cut_from
                        .iter()
                        .map(|&(fabric, count, first)| to_cut(fabric, count, first)),
                );
            }
        }
    }
    Ok(all)
}

/// A piece of a draft with its block.
fn cut_piece(
    garment: &Garments<'_>,
    number: usize,
    settings: &PieceSettings,
) -> Result<Arc<CutPiece>, MarkerError> {
    let options = CutOptions {
        block: settings.rule.block.unwrap_or_default().max(0.0),
        ..CutOptions::default()
    };
    let of = (garment.pattern, garment.draft);
    let made = CutPiece::new(of, number, (None, &options));
    made.map(Arc::new).map_err(|error| MarkerError::Piece {
        pattern: garment.pattern.name.clone(),
        fault: format!(
            "piece {:?} cannot be cut: {error}",
            garment.draft.pieces[number].name
        ),
    })
}

/// Notes for the cutter in words, each with the label of its garment.
fn notes_of(found: &[Diagnostic], label: Option<&str>) -> Vec<String> {
    let of = label.map_or_else(String::new, |label| format!("{label}: "));
    let words = |one: &Diagnostic| format!("{of}{}; {}", one.message, one.hint);
    let told = found.iter().filter(|one| concerns_cutter(one));
    told.map(words).collect()
}

/// Refuses more pieces than can be laid at once, before any list of them is made.
fn check_count(garments: &[Garments<'_>], options: &NestOptions) -> Result<(), MarkerError> {
    let of = |garment: &Garments<'_>| {
        let each = |piece: &Piece| {
            let settings = options.piece(garment.pattern, piece);
            let also = settings.also.iter().flatten();
            1 + also.map(|(_, &count)| u64::from(count)).sum::<u64>()
        };
        let pieces: u64 = garment.draft.pieces.iter().map(each).sum();
        pieces.saturating_mul(u64::from(garment.count))
    };
    let total = garments.iter().map(of).fold(0, u64::saturating_add);
    match total > u64::from(MAX_PIECES) {
        true => Err(NestingError::TooManyPieces(total).into()),
        false => Ok(()),
    }
}

/// Refuses settings, locks and marks with names that do not exist.
fn check_piece_names(garments: &[Garments<'_>], options: &NestOptions) -> Result<(), MarkerError> {
    let mut names: Vec<String> = Vec::new();
    let mut marks: Vec<String> = Vec::new();
    for garment in garments {
        names.extend(garment.draft.pieces.iter().map(|p| p.name.clone()));
        for panel in &garment.pattern.panels {
            names.push(panel.name.clone());
            let notch = |n: &toile_pattern::Notch| format!("{}.{}", panel.name, n.name);
            marks.extend(panel.notches.iter().map(notch));
        }
    }
    for list in [&mut names, &mut marks] {
        list.sort_unstable();
        list.dedup();
    }
    let unknown = |kind: &'static str, name: &str, there: &[String]| MarkerError::Unknown {
        kind,
        name: name.to_owned(),
        hint: match there.is_empty() {
            true => "there are none in the pattern".to_owned(),
            false => format!("choose from: {}", there.join(", ")),
        },
    };
    let given = options.settings.pieces.keys();
    for name in given.filter(|name| *name != ANY_NAME) {
        if !names.contains(name) {
            return Err(unknown("piece", name, &names));
        }
    }
    for mark in options.settings.matched.iter().flatten() {
        if !marks.contains(mark) {
            return Err(unknown("mark", mark, &marks));
        }
    }
    Ok(())
}
