//! Keeps hips, waist and bust the largest, smallest and largest girths where they lie.

use crate::definitions::Taping;
use crate::girths::Girth;
use crate::levels::Level;
use crate::measured::{SLACK, TapedSkin};
use crate::request::Request;
use crate::shape::{Scales, ribs};

/// Shares of the way from crotch to crown at which nothing below the hips may be larger than they.
const SEAT: [f64; 3] = [0.012, 0.03, 0.05];

/// A rib at the end of a range belongs to it [m].
const ROUNDING: f64 = 1e-3;

/// How far above the bust's range it is kept within, over stature: so that where exactly the armpits
/// are found does not matter.
const OVER: f64 = 0.001;

/// How much narrower the trunk may be at crotch, ribs and armpits for it, and how much wider at ribs.
const NARROWER: [f64; 2] = [0.85, 1.0];
const WIDER: [f64; 2] = [1.0, 1.25];

/// How much farther within its girth the trunk may be kept at the ribs, for what lies between them.
const MARGIN: [f64; 2] = [0.0, 0.006];

/// Smaller changes of a girth are left out, over stature: a tenth of a millimetre.
const STILL: f64 = 6e-5;

/// How much more than in proportion a section is corrected that lies beside the place it is held at.
const GAIN: f64 = 1.7;

/// Corrects how much narrower the trunk is below the hips and over the bust, and how much wider beside
/// the waist. Returns the largest change of a girth by it [m].
pub(crate) fn correct(scales: &mut Scales, taken: &TapedSkin, request: &Request) -> f64 {
    let mut moved: f64 = 0.0;
    for girth in [Girth::Hips, Girth::Waist, Girth::Bust] {
        if let (Some(asked), Some(taping)) = (request.girth(girth), Taping::of(girth, taken.body()))
        {
            let fence = Fence {
                girth,
                asked,
                taping,
            };
            moved = moved.max(fence.correct(scales, taken, request));
        }
    }
    moved
}

/// A girth round the trunk that nothing beside it may be beyond.
struct Fence {
    girth: Girth,
    /// What is asked for or predicted [m].
    asked: f64,
    taping: Taping,
}

impl Fence {
    fn correct(&self, scales: &mut Scales, taken: &TapedSkin, request: &Request) -> f64 {
        let mut moved: f64 = 0.0;
        let still = STILL * taken.body().stature;
        let mut step = |unknown: &mut f64, to: &dyn Fn(f64) -> f64, [low, high]: [f64; 2]| {
            let after = to(*unknown).clamp(low, high);
            let worth = (after - *unknown).abs() * self.asked;
            if worth > still {
                *unknown = after;
                moved = moved.max(worth);
            }
        };
        let margin = &mut scales.margin[self.girth as usize];
        if let Some(more) = self.beyond(taken) {
            step(margin, &|known| known + more / self.asked, MARGIN);
        }
        let within = *margin;
        let round = |y: f64| taken.taped(&self.taping, y);
        let body = taken.body();
        let goal = match self.girth {
            Girth::Waist => self.asked * (1.0 + within),
            _ => self.asked * (1.0 - within),
        };
        let limits = match self.girth {
            Girth::Waist => WIDER,
            _ => NARROWER,
        };
        match self.girth {
            Girth::Bust => {
                let top = round(self.taping.range[1] + OVER * body.stature);
                step(
                    &mut scales.chest,
                    &|known| known * (goal / top).powf(GAIN),
                    limits,
                );
                return moved;
            }
            Girth::Hips => {
                let level = taken.levels.at(Level::Hips);
                let below = SEAT.map(|share| body.up(share));
                let below = below.into_iter().filter(|y| *y < level);
                let most = below.map(round).fold(0.0, f64::max);
                if most > 0.0 {
                    step(
                        &mut scales.seat,
                        &|known| known * (goal / most).powf(GAIN),
                        limits,
                    );
                }
            }
            _ => {}
        }
        let [low, high] = self.taping.range;
        let heights = ribs(request, taken.levels);
        for (unknown, y) in scales.ribs.iter_mut().zip(heights) {
            if let Some(y) = y.filter(|y| (low - ROUNDING..=high + ROUNDING).contains(y)) {
                step(unknown, &|known| known * goal / round(y), limits);
            }
        }
        moved
    }

    /// By how much the trunk between the ribs is beyond the girth, where it is looked for and more
    /// than the tape lets pass [m].
    fn beyond(&self, taken: &TapedSkin) -> Option<f64> {
        if !taken.looks() {
            return None;
        }
        let round = |y: f64| taken.taped(&self.taping, y);
        let place = self.taping.find(|y| Some(round(y)))?;
        let there = taken.girth(self.girth);
        let more = self.taping.beyond(round(place), there);
        (more > 0.5 * SLACK * taken.body().stature).then_some(more)
    }
}
