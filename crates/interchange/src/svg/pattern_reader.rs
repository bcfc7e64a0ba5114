//! Patterns from SVG.

use super::ampersands::escaped;
use super::back::written;
use super::drawing::Drawing;
use super::piece::SvgPiece;
use super::reading::{SvgReading, sew_line_guess};
use super::region::Region;
use super::scale::Scale;
use super::scan::{is_freesewing, scan};
use super::{back, freesewing, layers, plain};
use crate::drawn::builder::document;
use crate::drawn::piece::DrawnPattern;
use crate::native::Fitting;
use crate::xml::Xml;
use crate::{FormatError, Guess, Loss, ReadOptions};
use toile_pattern::DisplayUnit;

/// Largest file (bytes).
const MAX_BYTES: usize = 64 << 20;

/// Reads a pattern.
///
/// # Errors
/// A damaged file, one beyond the limits, or one without a closed line: the fault, its place and a remedy.
pub(crate) fn read_svg(text: &str, options: &ReadOptions) -> Result<SvgReading, FormatError> {
    if text.len() > MAX_BYTES {
        return Err(FormatError::new(
            "the whole file",
            format!("it is larger than {} MB", MAX_BYTES >> 20),
            "leave pictures and fonts out of the drawing",
        ));
    }
    let remedy = "save the drawing anew in the program that it comes from";
    let (mended, signs);
    let xml = match Xml::read(text, remedy) {
        Ok(xml) => {
            signs = 0;
            xml
        }
        Err(fault) => {
            (mended, signs) = escaped(text);
            // The fault is told as it stands in the file.
            Xml::read(&mended, remedy).map_err(|_| fault)?
        }
    };
    let scale = Scale::of(xml.root(), text)?;
    let drawing = scan(&xml, &scale)?;
    let mut losses = left_out(&drawing);
    if signs > 0 {
        let why = "each was read as a letter";
        losses.push(Loss {
            count: signs,
            ..Loss::at("", "signs & that begin no entity", why)
        });
    }
    if let Some(written) = written(&xml)? {
        return back::read(&drawing, (written, &scale), options, losses);
    }
    let mut name = String::new();
    let rough = scale.metres(options.unit, 0.0).0;
    let mut pieces = match is_freesewing(xml.root()) {
        true => {
            let (pieces, design, lost) = freesewing::pieces(&drawing);
            name = design;
            losses.extend(lost);
            pieces
        }
        false => {
            let groups = layers::groups(&drawing);
            let own = groups.into_iter();
            own.filter_map(|group| layers::new_piece(&drawing, group, &mut losses))
                .collect()
        }
    };
    if pieces.is_empty() {
        pieces = plain::pieces(&drawing, (rough, scale.page), &mut losses)?;
    }
    if pieces.is_empty() {
        return Err(nothing(&drawing));
    }
    losses.extend(texts(&drawing));
    let (unit, guess) = scale.metres(options.unit, largest(&pieces));
    let mut guesses: Vec<Guess> = guess.into_iter().collect();
    let mut drawn = DrawnPattern {
        name,
        ..DrawnPattern::default()
    };
    guesses.extend(sew_line_guess(&pieces, options));
    for piece in &pieces {
        let (piece, lost) = piece.drawn(unit, options.allowance_inside);
        drawn.pieces.push(piece);
        losses.extend(lost);
    }
    let (mut pattern, lost) = document(&drawn);
    losses.extend(lost);
    pattern.unit = DisplayUnit::Centimetre;
    Ok(SvgReading {
        pattern,
        fitting: Fitting::default(),
        guesses,
        losses,
        notes: Vec::new(),
    })
}

/// The extent of the largest piece (units).
fn largest(pieces: &[SvgPiece]) -> f64 {
    let outlines = pieces.iter().filter_map(SvgPiece::outline);
    outlines
        .map(|line| Region::of(line).extent())
        .fold(0.0, f64::max)
}

/// The refusal of a drawing without a closed line.
fn nothing(drawing: &Drawing) -> FormatError {
    match drawing.lines.is_empty() {
        true => FormatError::new(
            "the whole file",
            "nothing is drawn in it that shows",
            "show the layers that hold the pattern, and save again",
        ),
        false => FormatError::new(
            "the whole file",
            "no closed line is in it that could be the outline of a piece",
            "close the outlines (in Inkscape: select the path, then Path > Join) and save again",
        ),
    }
}

/// Losses of elements that are no lines of a pattern.
fn left_out(drawing: &Drawing) -> Vec<Loss> {
    let all = drawing.left_out.iter();
    let why = |what: &str| match what {
        "scripts" => "they are never run",
        "links to other files" => "they are never followed",
        "ends of damaged paths" => "paths are drawn up to their faults",
        _ => "they are no lines of a pattern",
    };
    all.map(|(&what, &count)| Loss {
        count,
        ..Loss::at("", what, why(what))
    })
    .collect()
}

/// The loss of words.
fn texts(drawing: &Drawing) -> Option<Loss> {
    let count = drawing.texts.len();
    (count > 0).then(|| Loss {
        count,
        ..Loss::at(
            "",
            "texts",
            "pieces are named by them; the document has no other place for them",
        )
    })
}
