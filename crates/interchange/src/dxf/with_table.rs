//! Pieces of a DXF with the grade rule table that comes with it.

use super::block_piece::BlockPiece;
use super::graded_blocks::{Grading, graded};
use super::labels::Labels;
use super::limits::check_points;
use super::rule_table::RuleTable;
use crate::{Companion, FormatError, Guess, Loss, ReadOption};
use toile_geometry::Vec2;
use toile_pattern::DisplayUnit;

/// Largest distance of a number from the vertex that it grades (m).
const REACH: f64 = 5e-4;

/// Unit of a drawing as taken, and as the file states it.
#[derive(Clone, Copy)]
pub(super) struct Units {
    pub unit: DisplayUnit,
    pub stated: Option<DisplayUnit>,
}

/// The pieces in all sizes, and what the table gave.
#[derive(Default)]
pub(super) struct SizedPieces {
    pub pieces: Vec<BlockPiece>,
    /// The numbered rules by size (m); empty where the table was not used.
    pub rules: Vec<(u32, Vec<Vec2>)>,
    pub guesses: Vec<Guess>,
    pub losses: Vec<Loss>,
}

/// The pieces in the sizes of the rule table among the companions, if the file has blocks of one size alone. The
/// size that is drawn then stands in the style as the sample size.
///
/// # Errors
/// The companion is no grade rule table, or one of other sizes; there are several companions.
pub(super) fn with_table(
    pieces: Vec<BlockPiece>,
    companions: &[Companion],
    (style, units): (&mut Labels, Units),
) -> Result<SizedPieces, FormatError> {
    let companion = match companions {
        [] => {
            return Ok(SizedPieces {
                pieces,
                ..SizedPieces::default()
            });
        }
        [companion] => companion,
        several => {
            return Err(FormatError::new(
                "the further files",
                format!(
                    "{} files are given with a DXF, which has one grade rule table",
                    several.len()
                ),
                "give --with once",
            ));
        }
    };
    let file = companion.name.as_str();
    let table = RuleTable::read(&companion.bytes).map_err(|error| {
        FormatError::new(format!("{file}, {}", error.place), error.what, error.hint)
    })?;
    let mut sizes: Vec<String> = pieces.iter().filter_map(BlockPiece::size).collect();
    sizes.sort_unstable();
    sizes.dedup();
    if sizes.len() > 1 {
        return Ok(SizedPieces {
            pieces,
            guesses: vec![Guess {
                what: "sizes",
                chosen: "the sizes of the blocks".to_owned(),
                because: format!("the file has blocks of its sizes, and {file} is not needed"),
                option: ReadOption::With,
            }],
            ..SizedPieces::default()
        });
    }
    check_points(pieces.iter(), table.sizes.len())?;
    let metres = units.unit.metres();
    // A file that is wrong about its unit comes with a table that is as wrong.
    let own = table.unit.filter(|_| table.unit != units.stated);
    let grading = Grading {
        table: &table,
        file,
        scale: own.map_or(1.0, |unit| unit.metres() / metres),
        reach: REACH / metres,
        drawn_size: style.value(&["samplesize"]).map(str::to_owned),
    };
    let found = graded(pieces, &grading)?;
    style.set("samplesize", &found.base);
    let metric = |(number, shifts): (u32, Vec<Vec2>)| {
        let shifts = shifts.into_iter().map(|by| by * metres);
        (number, shifts.collect())
    };
    Ok(SizedPieces {
        pieces: found.pieces,
        rules: found.rules.into_iter().map(metric).collect(),
        guesses: found.guesses,
        losses: found.losses,
    })
}
