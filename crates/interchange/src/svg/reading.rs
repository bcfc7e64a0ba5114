//! A pattern that was read from SVG.

use super::piece::SvgPiece;
use crate::native::Fitting;
use crate::{Guess, Loss, ReadOption, ReadOptions};
use toile_pattern::Pattern;

/// A pattern that was read.
#[derive(Debug)]
pub(crate) struct SvgReading {
    pub pattern: Pattern,
    pub fitting: Fitting,
    pub guesses: Vec<Guess>,
    pub losses: Vec<Loss>,
    pub notes: Vec<String>,
}

/// The guess about the sew line of pieces that have none.
pub(super) fn sew_line_guess(pieces: &[SvgPiece], options: &ReadOptions) -> Option<Guess> {
    let without = pieces.iter().filter(|piece| piece.sew.is_none()).count();
    (without > 0 && options.allowance_inside.is_none()).then(|| Guess {
        what: "sew line",
        chosen: "the outline with no allowance".to_owned(),
        because: format!("{without} of {} pieces have one line only", pieces.len()),
        option: ReadOption::Inside,
    })
}
