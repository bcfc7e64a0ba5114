//! Paper, and the division of a drawing over several sheets.

use strum::{EnumCount, IntoStaticStr, VariantArray};
use toile_geometry::{Bounds2, Vec2};

/// Unprintable margin of printers on every side (m).
const MARGIN: f64 = 0.010;
/// Width of the overlap of neighbouring sheets (m).
pub(crate) const OVERLAP: f64 = 0.010;
/// White border round a drawing on one page (m).
const BORDER: f64 = 0.010;

/// The paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, EnumCount, VariantArray, IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum Paper {
    /// Sheets of 210 x 297 mm.
    A4,
    /// Sheets of 8.5 x 11 in.
    Letter,
    /// Sheets of 841 x 1189 mm.
    A0,
    /// One page as large as the drawing needs.
    Page,
    /// One page as large as the drawing needs, with lines that a projector can show.
    Projector,
}

impl Paper {
    /// Every paper, in the order in which it is offered.
    pub const ALL: [Self; Self::COUNT] = toile_geometry::all_variants!();

    /// Name of the paper.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Size of a sheet (m); `None` for a single page of any size.
    pub fn sheet(self) -> Option<Vec2> {
        match self {
            Self::A4 => Some(Vec2::new(0.210, 0.297)),
            Self::Letter => Some(Vec2::new(0.2159, 0.2794)),
            Self::A0 => Some(Vec2::new(0.841, 1.189)),
            Self::Page | Self::Projector => None,
        }
    }

    /// Size of the part of the drawing that a sheet shows (m).
    pub fn window(self) -> Option<Vec2> {
        Some(self.sheet()? - Vec2::repeat(2.0 * MARGIN))
    }

    /// Distance on the drawing from the start of one sheet to the start of the next (m).
    pub fn step(self) -> Option<Vec2> {
        Some(self.window()? - Vec2::repeat(OVERLAP))
    }

    /// Height of a drawing that fills a number of rows of sheets (m).
    pub fn height_of(self, rows: u32) -> Option<f64> {
        Some(f64::from(rows) * self.step()?.y + OVERLAP)
    }
}

/// A sheet and the part of the drawing that it shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// Row from the top and column from the left, both from 1.
    pub place: [u32; 2],
    /// Part of the drawing shown on the sheet (m).
    pub window: Bounds2,
    /// Size of the sheet (m).
    pub sheet: Vec2,
    /// Translation from the drawing to the page (m).
    pub shift: Vec2,
}

/// Part of the drawing that belongs to one sheet only: up to the middle of the overlap with the next sheet.
fn cell(tile: &Tile, last: [u32; 2]) -> Bounds2 {
    let half = 0.5 * OVERLAP;
    let [row, column] = tile.place;
    let inset = |inner: bool| if inner { half } else { 0.0 };
    Bounds2 {
        min: tile.window.min + Vec2::new(inset(column > 1), inset(row < last[0])),
        max: tile.window.max - Vec2::new(inset(column < last[1]), inset(row > 1)),
    }
}

/// The sheets of a drawing with its lower left corner at the origin, row by row from the top. A sheet is left
/// out if `shows` is `false` for its part of the drawing.
pub(crate) fn tiles(paper: Paper, size: Vec2, shows: impl Fn(&Bounds2) -> bool) -> Vec<Tile> {
    let (Some(sheet), Some(window), Some(step)) = (paper.sheet(), paper.window(), paper.step())
    else {
        let border = Vec2::repeat(BORDER);
        return vec![Tile {
            place: [1, 1],
            window: Bounds2 {
                min: Vec2::zeros(),
                max: size,
            },
            sheet: size + border * 2.0,
            shift: border,
        }];
    };
    let count = |length: f64, step: f64| ((length - OVERLAP) / step - 1e-9).ceil().max(1.0) as u32;
    let last = [count(size.y, step.y), count(size.x, step.x)];
    let mut all = Vec::new();
    for row in 1..=last[0] {
        for column in 1..=last[1] {
            let left = f64::from(column - 1) * step.x;
            let below = size.y - f64::from(row - 1) * step.y - window.y;
            let min = Vec2::new(left, below);
            let tile = Tile {
                place: [row, column],
                window: Bounds2 {
                    min,
                    max: min + window,
                },
                sheet,
                shift: Vec2::repeat(MARGIN) - min,
            };
            if shows(&cell(&tile, last)) {
                all.push(tile);
            }
        }
    }
    all
}

/// Positions of the crosses that neighbouring sheets share: in the middle of their overlap, at its ends and
/// half-way.
pub(crate) fn crosses(tile: &Tile) -> Vec<Vec2> {
    let half = 0.5 * OVERLAP;
    let [low, high] = [
        tile.window.min + Vec2::repeat(half),
        tile.window.max - Vec2::repeat(half),
    ];
    let middle = (low + high) * 0.5;
    [
        [low.x, low.y],
        [middle.x, low.y],
        [high.x, low.y],
        [low.x, middle.y],
        [high.x, middle.y],
        [low.x, high.y],
        [middle.x, high.y],
        [high.x, high.y],
    ]
    .map(Vec2::from)
    .to_vec()
}

/// The parts of a polyline inside a window.
pub(crate) fn clipped(points: &[Vec2], closed: bool, window: &Bounds2) -> Vec<Vec<Vec2>> {
    let ends = points.iter().copied().zip(points.iter().copied().skip(1));
    let back = points.last().zip(points.first()).filter(|_| closed);
    let back = back.map(|(&last, &first)| (last, first));
    let mut parts: Vec<Vec<Vec2>> = Vec::new();
    for (from, to) in ends.chain(back) {
        let Some([a, b]) = clipped_segment([from, to], window) else {
            continue;
        };
        match parts.last_mut() {
            Some(part) if part.last() == Some(&a) => part.push(b),
            _ => parts.push(vec![a, b]),
        }
    }
    parts
}

/// The part of a segment inside a window (Liang, Barsky 1984).
fn clipped_segment([from, to]: [Vec2; 2], window: &Bounds2) -> Option<[Vec2; 2]> {
    let way = to - from;
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let sides = [
            (-way[axis], from[axis] - window.min[axis]),
            (way[axis], window.max[axis] - from[axis]),
        ];
        for (speed, room) in sides {
            if speed == 0.0 {
                if room < 0.0 {
                    return None;
                }
            } else if speed < 0.0 {
                enters = enters.max(room / speed);
            } else {
                leaves = leaves.min(room / speed);
            }
        }
    }
    let at = |t: f64| match t {
        0.0 => from,
        1.0 => to,
        t => from + way * t,
    };
    (enters < leaves).then(|| [at(enters), at(leaves)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_clipped_to_a_window_and_joined() {
        let window = Bounds2 {
            min: Vec2::zeros(),
            max: Vec2::new(1.0, 1.0),
        };
        let square = [[-0.5, 0.5], [0.5, 0.5], [0.5, 2.0], [-0.5, 2.0]].map(Vec2::from);
        let parts = clipped(&square, true, &window);
        let wanted = [[0.0, 0.5], [0.5, 0.5], [0.5, 1.0]].map(Vec2::from);
        assert_eq!(parts, [wanted.to_vec()]);
        let outside = [[2.0, 0.0], [2.0, 3.0]].map(Vec2::from);
        assert!(clipped(&outside, false, &window).is_empty());
    }

    #[test]
    fn sheets_cover_a_drawing_and_overlap() {
        let size = Vec2::new(0.9, Paper::A4.height_of(3).unwrap());
        let all = tiles(Paper::A4, size, |_| true);
        assert_eq!(all.len(), 3 * 5);
        assert_eq!(all[0].place, [1, 1]);
        assert!((all[0].window.max.y - size.y).abs() < 1e-12);
        let shared = all[0].window.max.x - all[1].window.min.x;
        assert!((shared - OVERLAP).abs() < 1e-12);
        assert!(all[14].window.max.x > 0.9 && all[14].window.min.y.abs() < 1e-9);
        // The crosses of neighbouring sheets coincide.
        let met = |p: Vec2| crosses(&all[1]).iter().any(|q| (p - q).norm() < 1e-12);
        assert_eq!(crosses(&all[0]).into_iter().filter(|&p| met(p)).count(), 3);
    }
}
