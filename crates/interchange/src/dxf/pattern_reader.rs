//! Patterns from DXF (ANSI/AAMA-292 and ASTM D6673): blocks become pieces, blocks of one piece its sizes.

use super::block_piece::BlockPiece;
use super::blocks::Pieces;
use super::drawing_reader::read_drawing;
use super::labels::Labels;
use super::limits::check_points;
use super::piece_maker::PieceMaker;
use super::sized_pieces::Nest;
use super::with_table::{Units, with_table};
use crate::drawn::builder::document;
use crate::drawn::piece::DrawnPattern;
use crate::drawn::unit::unit;
use crate::{Companion, Format, FormatError, Guess, Loss, ReadOption, ReadOptions};
use toile_geometry::Bounds2;
use toile_pattern::{DisplayUnit, Pattern};

/// A pattern that was read.
pub(crate) struct DxfReading {
    pub pattern: Pattern,
    pub format: Format,
    pub guesses: Vec<Guess>,
    pub losses: Vec<Loss>,
}

/// Reads a pattern, with the grade rule table among its companions if there is one.
///
/// # Errors
/// A damaged file, or one without a closed line; a companion that is no grade rule table, or one of other sizes:
/// the fault, its place and a remedy.
pub(crate) fn read_dxf(
    bytes: &[u8],
    options: &ReadOptions,
    companions: &[Companion],
) -> Result<DxfReading, FormatError> {
    let drawing = read_drawing(bytes)?;
    let Pieces {
        pieces,
        mut style,
        mut guesses,
        mut losses,
    } = Pieces::of(&drawing)?;
    // Some programs say beside each piece what is about the style.
    let own = pieces
        .iter()
        .find(|piece| piece.labels.value(&["units"]).is_some());
    if let Some(own) = own {
        style.add_all(&own.labels);
    }
    let stated = stated_unit(&style, drawing.header_unit);
    let (unit, guess) = unit(options.unit, stated, largest(&pieces));
    guesses.extend(guess);
    let format = match pieces.iter().any(|piece| !piece.twins.is_empty()) {
        true => Format::DxfAstm,
        false => Format::DxfAama,
    };
    let sized = with_table(pieces, companions, (&mut style, Units { unit, stated }))?;
    guesses.extend(sized.guesses);
    losses.extend(sized.losses);
    let nest = Nest::of(sized.pieces, &style);
    let base = nest.pieces.iter();
    let base = base.filter_map(|piece| piece.sized.get(&nest.base));
    check_points(base, nest.sizes.len().max(1))?;
    let mut maker = PieceMaker {
        base: nest.base,
        count: nest.sizes.len().max(1),
        unit: unit.metres(),
        inside: options.allowance_inside,
        without_sew_line: 0,
        losses: Vec::new(),
    };
    let drawn = DrawnPattern {
        name: style
            .value(&["stylename", "style"])
            .unwrap_or_default()
            .to_owned(),
        base: nest.base,
        pieces: nest
            .pieces
            .iter()
            .filter_map(|piece| maker.piece(piece))
            .collect(),
        sizes: nest.sizes,
        rules: sized.rules,
    };
    guesses.extend(nest.guesses);
    if maker.without_sew_line > 0 && options.allowance_inside.is_none() {
        guesses.push(Guess {
            what: "sew line",
            chosen: "the cut line with no allowance".to_owned(),
            because: format!(
                "pieces without a sew line: {} of {}",
                maker.without_sew_line,
                drawn.pieces.len()
            ),
            option: ReadOption::Inside,
        });
    }
    let (mut pattern, left_out) = document(&drawn);
    pattern.unit = match unit {
        DisplayUnit::Inch => DisplayUnit::Inch,
        DisplayUnit::Millimetre | DisplayUnit::Centimetre | DisplayUnit::Metre => {
            DisplayUnit::Centimetre
        }
    };
    losses.extend(nest.losses.into_iter().chain(maker.losses).chain(left_out));
    Ok(DxfReading {
        pattern,
        format,
        guesses,
        losses,
    })
}

/// The unit that a file states.
fn stated_unit(style: &Labels, header_unit: i64) -> Option<DisplayUnit> {
    match style.value(&["units"]).map(str::to_lowercase).as_deref() {
        Some("english" | "inch" | "inches" | "in") => Some(DisplayUnit::Inch),
        Some("metric" | "millimeter" | "millimeters" | "mm") => Some(DisplayUnit::Millimetre),
        Some("centimeter" | "centimeters" | "cm") => Some(DisplayUnit::Centimetre),
        Some(_) | None => match header_unit {
            1 => Some(DisplayUnit::Inch),
            4 => Some(DisplayUnit::Millimetre),
            5 => Some(DisplayUnit::Centimetre),
            6 => Some(DisplayUnit::Metre),
            _ => None,
        },
    }
}

/// The larger side of the largest piece (units of the file).
fn largest(pieces: &[BlockPiece]) -> f64 {
    let sides = pieces.iter().filter_map(|piece| {
        let outline = piece.cut.first()?;
        let size = Bounds2::of(outline.shape()).size();
        Some(size.x.max(size.y))
    });
    sides.fold(0.0, f64::max)
}
