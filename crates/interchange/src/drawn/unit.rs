//! The unit of a drawing, by what it states and by the sizes of its pieces.

use crate::{Guess, ReadOption};
use toile_pattern::DisplayUnit;
use toile_pattern::fields::Choice;

/// Sizes that the largest piece of a garment may have (m).
const PIECE_SIZES: [f64; 2] = [0.2, 2.5];

/// Units that are tried where the stated one does not fit, the likeliest first: those of the same system come
/// before others.
fn likely(stated: Option<DisplayUnit>) -> [DisplayUnit; 4] {
    use DisplayUnit::{Centimetre, Inch, Metre, Millimetre};
    match stated {
        Some(Millimetre | Centimetre | Metre) => [Millimetre, Centimetre, Metre, Inch],
        Some(Inch) | None => [Millimetre, Inch, Centimetre, Metre],
    }
}

/// The unit of a drawing whose largest piece has an extent in units of the file: as asked for, else as stated,
/// unless only another unit makes it the size of a piece of a garment. A decision against the file, or without
/// its word, is a guess.
pub(crate) fn unit(
    asked: Option<DisplayUnit>,
    stated: Option<DisplayUnit>,
    largest: f64,
) -> (DisplayUnit, Option<Guess>) {
    if let Some(asked) = asked {
        return (asked, None);
    }
    let fits = |unit: &DisplayUnit| {
        let size = largest * unit.metres();
        (PIECE_SIZES[0]..=PIECE_SIZES[1]).contains(&size)
    };
    if let Some(stated) = stated.filter(fits) {
        return (stated, None);
    }
    let likely = likely(stated).into_iter().find(fits);
    let chosen = likely.or(stated).unwrap_or(DisplayUnit::Millimetre);
    let size = format!(
        "the largest piece is then {:.0} cm",
        largest * chosen.metres() * 100.0
    );
    let because = match stated {
        Some(stated) if stated == chosen => return (chosen, None),
        Some(stated) => format!(
            "{size}; in {}, which the file states, it would be {:.1} cm",
            stated.word(),
            largest * stated.metres() * 100.0
        ),
        None => format!("the file states none; {size}"),
    };
    let guess = Guess {
        what: "unit",
        chosen: chosen.word().to_owned(),
        because,
        option: ReadOption::Unit,
    };
    (chosen, Some(guess))
}

#[cfg(test)]
mod tests {
    use super::*;
    use DisplayUnit::{Centimetre, Inch, Millimetre};

    #[test]
    fn the_stated_unit_holds_unless_only_another_fits() {
        assert_eq!(unit(None, Some(Millimetre), 700.0), (Millimetre, None));
        assert_eq!(unit(None, Some(Inch), 30.0), (Inch, None));
        // METRIC, and a tenth of its size in mm: a file in centimetres.
        let (chosen, guess) = unit(None, Some(Millimetre), 70.0);
        assert_eq!(chosen, Centimetre);
        assert!(guess.unwrap().because.contains("it would be 7.0 cm"));
        // ENGLISH, and 118 inches would be 3 m.
        let (chosen, guess) = unit(None, Some(Inch), 118.0);
        assert_eq!(chosen, Centimetre);
        assert!(guess.is_some());
        let (chosen, guess) = unit(None, None, 700.0);
        assert_eq!(chosen, Millimetre);
        assert_eq!(guess.unwrap().option, ReadOption::Unit);
        assert_eq!(
            unit(Some(Centimetre), Some(Inch), 700.0),
            (Centimetre, None)
        );
        // Nothing fits: the file's word holds.
        assert_eq!(unit(None, Some(Millimetre), 5.0).0, Millimetre);
    }
}
