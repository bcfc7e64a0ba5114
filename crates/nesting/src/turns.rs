//! The orientations in which a piece is tried: all allowed ones, or fewer if there are many pieces.

use crate::maps::Maps;
use crate::shape::{SNUG, extent, folds_up};
use crate::{Item, Mirror, Nap, Strip};

/// Resolution at which orientations are tried.
#[derive(Debug)]
pub(crate) struct Fineness {
    /// Tilts of the grain that are tried, as fractions of its tolerance.
    tilts: &'static [f64],
    /// Largest number of turns of a piece.
    turns: usize,
    /// Largest number of no-fit polygons at this level, 50 kB each, or 12 kB if there are many.
    pub no_fits: usize,
}

const TILTS: [&[f64]; 3] = [&[0.0, -0.5, 0.5, -1.0, 1.0], &[0.0, -1.0, 1.0], &[0.0]];
/// Number of no-fit polygons above which fewer tilts are tried, and the largest number held.
const NO_FITS: [usize; 2] = [4_000, 40_000];

/// Levels from fine to coarse.
const LEVELS: [Fineness; 6] = [
    Fineness::new(TILTS[0], usize::MAX, NO_FITS[0]),
    Fineness::new(TILTS[1], usize::MAX, NO_FITS[0]),
    Fineness::new(TILTS[2], usize::MAX, NO_FITS[1]),
    Fineness::new(TILTS[2], 12, NO_FITS[1]),
    Fineness::new(TILTS[2], 8, NO_FITS[1]),
    Fineness::new(TILTS[2], 4, NO_FITS[1]),
];

impl Fineness {
    /// All orientations.
    const ALL: Self = Self::new(TILTS[0], usize::MAX, usize::MAX);

    const fn new(tilts: &'static [f64], turns: usize, no_fits: usize) -> Self {
        Self {
            tilts,
            turns,
            no_fits,
        }
    }

    /// The levels to try in order, without those that make no difference for the items, with the resolution
    /// limits of the loss maps: the number of turns is reduced before maps become too coarse to be useful.
    pub fn levels(items: &[Item]) -> Vec<(&'static Self, Maps)> {
        let tilted = items.iter().any(|item| item.allowed.tilt > 0.0);
        let turns = items.iter().map(|item| item.allowed.turns.len());
        let most = turns.max().unwrap_or(0);
        let matters = |level: &&Self| {
            let tilts = tilted || level.tilts.len() == 1;
            tilts && (level.turns == usize::MAX || level.turns < most)
        };
        let levels: Vec<&Self> = LEVELS.iter().filter(matters).collect();
        let maps = |k: usize| match levels[k].tilts.len() == 1 && k + 1 < levels.len() {
            true => Maps::FINE,
            false => Maps::COARSE,
        };
        (0..levels.len()).map(|k| (levels[k], maps(k))).collect()
    }
}

/// Turns and sides that a copy of an item may have on a strip, without repetitions.
pub(crate) fn orientations(item: &Item, strip: &Strip, copy: u32) -> Vec<(f64, bool)> {
    orientations_within(item, strip, (copy, &Fineness::ALL))
}

/// Turns and sides that a copy may have, reduced to a resolution.
pub(crate) fn orientations_within(
    item: &Item,
    strip: &Strip,
    (copy, fineness): (u32, &Fineness),
) -> Vec<(f64, bool)> {
    let sides: &[bool] = match item.allowed.mirror {
        Mirror::Never => &[false],
        Mirror::Pairs if copy % 2 == 1 => &[true],
        Mirror::Pairs => &[false],
        Mirror::Always => &[true],
        Mirror::Free => &[false, true],
    };
    let mut found: Vec<(f64, bool)> = Vec::new();
    let tilt = item.allowed.tilt;
    let tilts = if tilt > 0.0 { fineness.tilts } else { &[0.0] };
    let runs = |base: &f64| match strip.nap {
        Nap::None => true,
        Nap::OneWay => *base == 0.0,
        Nap::PerBundle => base.sin().abs() <= 1e-9,
    };
    let bases: Vec<f64> = item.allowed.turns.iter().copied().filter(runs).collect();
    for base in thinned(bases, (item, strip, sides), fineness.turns) {
        for part in tilts {
            let turn = base + part * tilt;
            for &side in sides {
                if !found.contains(&(turn, side)) {
                    found.push((turn, side));
                }
            }
        }
    }
    found
}

/// At most `most` of a piece's turns, evenly chosen; all turns if the piece fits in none of those.
fn thinned(
    turns: Vec<f64>,
    (item, strip, sides): (&Item, &Strip, &[bool]),
    most: usize,
) -> Vec<f64> {
    if turns.len() <= most {
        return turns;
    }
    let room = strip.max_length.unwrap_or(f64::INFINITY) - 2.0 * strip.end_margin;
    let fits = |turn: &f64| {
        sides.iter().any(|&side| {
            let size = extent(item, (*turn, side));
            let inside = size.y <= strip.usable_width() + SNUG && size.x <= room + SNUG;
            inside && folds_up(item, strip, (*turn, side)) != Some(None)
        })
    };
    let kept = (0..most).map(|k| turns[k * turns.len() / most]);
    let kept: Vec<f64> = kept.collect();
    if kept.iter().any(fits) { kept } else { turns }
}
