//! The words of a piece as a block of lines inside it, at any size: smaller, upright, shortened.

use crate::label::{Spot, cells, roomiest_of};
use std::f64::consts::FRAC_PI_2;
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_lettering::{shortened, width};

/// Ratio of the size of the second and later lines to the size of the first line (1).
const LATER_LINES: f64 = 0.7;
/// Ratio of the distance between two baselines to the size of the lower line (1).
const LINE_STEP: f64 = 1.3;
/// Height of letters above the baseline, over the size of the letters (1).
const ASCENT: f64 = 0.8;
/// Depth of letters below the baseline, over the size of the letters (1).
const DESCENT: f64 = 0.25;
/// Share of a free length that words may take (1): fonts of other programs are wider.
const FILLED: f64 = 0.85;
/// Gap between the middle of the grain line's spot and the words below it, over the spot's distance to the
/// outline (1).
const GAP: f64 = 0.05;
/// Largest height of the words below the spot, over the spot's distance to the outline (1).
const LINES: f64 = 0.85;
/// Smallest letters that are easy to read (m). Words stand by the grain line only if their letters are at
/// least this large.
const EASY: f64 = 0.003;
/// Smallest letters (m): below this size words are shortened instead.
const SMALL: f64 = 0.0018;
/// Least length of a shortened line, over the size of its letters (1).
const SHORTEST: f64 = 3.0;
/// Factor by which upright words must be larger than level words to be chosen, as they are harder to read
/// (1).
const UPRIGHT: f64 = 1.6;
/// Smallest size of letters for which a place counts as free (m).
const LEAST: f64 = 1e-6;
/// Number of bisections in the search for the largest size of letters.
const STEPS: u32 = 12;

/// A line of words, centred on a point of its baseline.
#[derive(Clone, Debug, PartialEq)]
pub struct Words {
    /// The text.
    pub text: String,
    /// Middle of the baseline (m).
    pub at: Vec2,
    /// Height of the letters (m).
    pub size: f64,
    /// Direction of the baseline (rad): 0, or a right angle for words that read upwards.
    pub angle: f64,
}

impl Words {
    /// Unit vector from the feet of the letters to their heads.
    pub(crate) fn up(&self) -> Vec2 {
        Vec2::new(-self.angle.sin(), self.angle.cos())
    }

    /// Box that holds the words (m).
    fn bounds(&self) -> Bounds2 {
        let (up, half) = (self.up(), 0.5 * width(&self.text) / FILLED * self.size);
        let along = Vec2::new(up.y, -up.x) * half;
        let [low, high] = [-DESCENT, ASCENT].map(|share| self.at + up * (share * self.size));
        Bounds2::of([low - along, low + along, high - along, high + along])
    }
}

/// Free room for words in a piece.
struct Room<'r> {
    /// Candidate places inside the piece, on a grid (m).
    cells: &'r [Vec2],
    /// Lines that words must not lie on, outline included (m).
    lines: &'r [[Vec2; 2]],
}

/// Lines of words that are set one below the other.
struct Block<'w> {
    lines: Vec<&'w str>,
}

/// A place for a block: its middle, the size of its first line, and whether it reads upwards.
#[derive(Clone, Copy)]
struct Fit {
    at: Vec2,
    size: f64,
    upright: bool,
}

fn share(line: usize) -> f64 {
    if line == 0 { 1.0 } else { LATER_LINES }
}

/// Height of a block of lines, over the size of the first line (1).
fn height(count: usize) -> f64 {
    let last = share(count.saturating_sub(1));
    ASCENT + LINE_STEP * LATER_LINES * (count.max(1) - 1) as f64 + DESCENT * last
}

impl Block<'_> {
    /// Width of the block, over the size of the first line (1), with allowance for wider fonts.
    fn width(&self) -> f64 {
        let widths = self.lines.iter().enumerate();
        widths
            .map(|(k, line)| width(line) * share(k))
            .fold(0.0, f64::max)
            / FILLED
    }

    fn placed(&self, fit: Fit) -> Vec<Words> {
        let angle = if fit.upright { FRAC_PI_2 } else { 0.0 };
        let down = Vec2::new(angle.sin(), -angle.cos());
        let mut below = (ASCENT - 0.5 * height(self.lines.len())) * fit.size;
        let mut words = Vec::with_capacity(self.lines.len());
        for (k, line) in self.lines.iter().enumerate() {
            let size = share(k) * fit.size;
            if k > 0 {
                below += LINE_STEP * size;
            }
            words.push(Words {
                text: (*line).to_owned(),
                at: fit.at + down * below,
                size,
                angle,
            });
        }
        words
    }
}

impl Room<'_> {
    fn is_free(&self, at: Vec2, half: Vec2) -> bool {
        let bounds = Bounds2 {
            min: at - half,
            max: at + half,
        };
        !self.lines.iter().any(|&line| enters(line, &bounds))
    }

    /// The largest size up to `most` (m) for which the box with the half extent `half(size)` is free at some
    /// place. Of equal places the one nearest to `near` is taken. The box of upright words has its sides
    /// swapped.
    fn largest(&self, near: Vec2, most: f64, half: impl Fn(f64) -> Vec2) -> Option<Fit> {
        let mut best: Option<Fit> = None;
        for &at in self.cells {
            for upright in [false, true] {
                let worth = |size: f64, upright: bool| if upright { size / UPRIGHT } else { size };
                let box_of = |size: f64| match (half(size), upright) {
                    (half, false) => half,
                    (half, true) => Vec2::new(half.y, half.x),
                };
                let least = best.map_or(0.0, |best| worth(best.size, best.upright));
                let least = if upright { least * UPRIGHT } else { least };
                let nearer = best.is_none_or(|best| (at - near).norm() < (best.at - near).norm());
                let wanted = least * if nearer { 1.0 } else { 1.001 };
                if wanted > most || !self.is_free(at, box_of(wanted.max(LEAST))) {
                    continue;
                }
                let size = grown([wanted, most], |size| self.is_free(at, box_of(size)));
                if size > LEAST {
                    best = Some(Fit { at, size, upright });
                }
            }
        }
        best
    }

    /// Lines of words below a spot. `None`: there is no room for letters that are easy to read.
    fn below(&self, spot: &Spot, block: &Block<'_>, most: f64) -> Option<Vec<Words>> {
        let half = Vec2::new(block.width(), height(block.lines.len())) * 0.5;
        let most = most.min(LINES * spot.room / (2.0 * half.y));
        let fits = [false, true].map(|upright| {
            let (down, half) = match upright {
                false => (-Vec2::y(), half),
                true => (Vec2::x(), Vec2::new(half.y, half.x)),
            };
            let tall = half.component_mul(&down.abs()).sum();
            let at = |size: f64| spot.at + down * (GAP * spot.room + tall * size);
            let size = grown([0.0, most], |size| self.is_free(at(size), half * size));
            Fit {
                at: at(size),
                size,
                upright,
            }
        });
        let fit = fits[usize::from(fits[1].size > UPRIGHT * fits[0].size)];
        (fit.size >= EASY).then(|| block.placed(fit))
    }

    fn fit(&self, block: &Block<'_>, (near, most): (Vec2, f64)) -> Option<Fit> {
        let whole = Vec2::new(block.width(), height(block.lines.len())) * 0.5;
        self.largest(near, most, |size| whole * size)
    }

    /// Lines of words anywhere inside, with the first line in letters of size `most` at most (m), near `near`
    /// if possible. If there is too little room, letters are smaller, upright or shortened; a line that is
    /// cut ends with an ellipsis.
    fn words(&self, lines: &[&str], (near, most): (Vec2, f64)) -> Vec<Words> {
        let block = Block {
            lines: lines.to_vec(),
        };
        match self.fit(&block, (near, most)) {
            Some(fit) if fit.size >= SMALL.min(most) => return block.placed(fit),
            _ => {}
        }
        let size = SMALL.min(most);
        for count in (1..=lines.len()).rev() {
            let tall = height(count) * size;
            let longest = block.width() * size;
            let half = |length: f64| Vec2::new(length, tall) * 0.5;
            if let Some(fit) = self.largest(near, longest, half)
                && fit.size >= SHORTEST * size
            {
                let fit = (fit.size, Fit { size, ..fit });
                return shortened_block(lines, count, fit);
            }
        }
        let line = shortened(lines.first().copied().unwrap_or_default(), SHORTEST);
        let block = Block { lines: vec![&line] };
        let fit = self.fit(&block, (near, size));
        fit.map_or_else(Vec::new, |fit| block.placed(fit))
    }
}

/// The first `count` lines, each at most `length` long (m). An ellipsis ends a line that is cut, and also the
/// last line if further lines are left out.
fn shortened_block(lines: &[&str], count: usize, (length, fit): (f64, Fit)) -> Vec<Words> {
    let short: Vec<String> = lines[..count]
        .iter()
        .enumerate()
        .map(|(k, line)| {
            let left_out = k + 1 == count && count < lines.len();
            let line = if left_out {
                format!("{line} …")
            } else {
                (*line).to_owned()
            };
            shortened(&line, FILLED * length / (fit.size * share(k)))
        })
        .collect();
    let block = Block {
        lines: short.iter().map(String::as_str).collect(),
    };
    block.placed(fit)
}

/// The largest number between `fits` and `most` for which the box of that size is free, found by bisection.
/// The box of size `fits` is known to be free.
fn grown([mut fits, most]: [f64; 2], is_free: impl Fn(f64) -> bool) -> f64 {
    if is_free(most) {
        return most;
    }
    let mut too_large = most;
    for _ in 0..STEPS {
        let middle = 0.5 * (fits + too_large);
        match is_free(middle) {
            true => fits = middle,
            false => too_large = middle,
        }
    }
    fits
}

/// Whether a segment enters a box.
fn enters([from, to]: [Vec2; 2], bounds: &Bounds2) -> bool {
    let way = to - from;
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let sides = [
            (-way[axis], from[axis] - bounds.min[axis]),
            (way[axis], bounds.max[axis] - from[axis]),
        ];
        for (speed, room) in sides {
            if speed == 0.0 {
                if room <= 0.0 {
                    return false;
                }
            } else if speed < 0.0 {
                enter = enter.max(room / speed);
            } else {
                leave = leave.min(room / speed);
            }
        }
    }
    enter < leave
}

/// The words of a piece, and the place of its grain line.
pub(crate) struct Label {
    pub words: Vec<Words>,
    /// Free place for the grain line.
    pub spot: Spot,
    /// Whether the words lie at the spot, so that the grain line is drawn above them. Else it is drawn in the
    /// middle of the spot.
    pub above: bool,
}

/// Lines of words inside a polygon, clear of the lines `others`. They stand at the roomiest spot, with the
/// grain line above them, if letters there are easy to read; else wherever they fit best. `most` gives the
/// size of the largest letters of the first line at a spot (m).
pub(crate) fn label(
    polygon: &Polygon,
    others: &[[Vec2; 2]],
    (lines, most): (&[&str], impl Fn(&Spot) -> f64),
) -> Label {
    let cells = cells(polygon);
    let edges: Vec<[Vec2; 2]> = polygon.edges().collect();
    let spot = roomiest_of(polygon, &cells, &edges);
    let block = Block {
        lines: lines.to_vec(),
    };
    let by_the_spot = |words| Label {
        words,
        spot,
        above: true,
    };
    if lines.is_empty() || spot.room <= 0.0 {
        return by_the_spot(Vec::new());
    }
    let most = most(&spot);
    let all: Vec<[Vec2; 2]> = edges.iter().chain(others).copied().collect();
    let [clear, free] = [&all, &edges].map(|lines| Room {
        cells: &cells,
        lines,
    });
    if let Some(words) = clear.below(&spot, &block, most) {
        return by_the_spot(words);
    }
    // It is better that words lie on an inner line than that they are cut.
    let fit = clear.fit(&block, (spot.at, most));
    let crowded = fit.is_none_or(|fit| fit.size < SMALL.min(most));
    let words = if crowded { &free } else { &clear }.words(lines, (spot.at, most));
    // The grain line keeps clear of the words.
    let boxes: Vec<Bounds2> = words.iter().map(Words::bounds).collect();
    let mut around = edges;
    around.extend(boxes.iter().flat_map(|b| {
        let sides = Polygon::rectangle(*b);
        sides.edges().collect::<Vec<_>>()
    }));
    let bare = |cell: &Vec2| !boxes.iter().any(|b| b.contains(*cell));
    let cells: Vec<Vec2> = cells.iter().copied().filter(bare).collect();
    Label {
        words,
        spot: roomiest_of(polygon, &cells, &around),
        above: false,
    }
}
