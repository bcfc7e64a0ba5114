//! The title block: name and facts, legend of lines, map of the sheets, and a test box to measure.

use super::draw::{BLACK, style};
use super::mark::{LineStyle, Mark};
use super::paper::Tile;
use super::{Lines, PrintJob};
use crate::Shown;
use crate::marker_label::lines_within;
use crate::pdf::{Align, fitted};
use toile_cut::StrokeKind;
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::DisplayUnit;

/// The texts of a title block.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TitleBlock {
    /// Name of the pattern.
    pub name: String,
    /// Further lines of text.
    pub facts: Vec<String>,
    /// Unit of the test box.
    pub unit: DisplayUnit,
}

/// Distance of the content from the block's border (m).
const INSET: f64 = 0.004;
/// Width of the block (m).
const WIDTH: f64 = 0.172;
/// Letter size of the pattern's name (m).
const TITLE_LETTERS: f64 = 0.007;
/// Letter size of all other text (m).
const LETTERS: f64 = 0.0035;
/// Distance from one line to the next (m).
const LINE: f64 = 0.0055;
/// Largest number of lines of facts, and largest number of lines of the legend.
const MAX_LINES: usize = 10;

const THIN: LineStyle = LineStyle {
    layer: None,
    ink: BLACK,
    width: 0.0002,
    dash: 0.0,
};

impl TitleBlock {
    /// Width and height of the block (m) in a print of `sizes` sizes of the pattern.
    pub fn size(&self, sizes: usize) -> Vec2 {
        let rows = self.facts_within().len().max(legend_rows(sizes));
        let height = TITLE_LETTERS + LINE * rows as f64 + self.test_box().0.y + 6.0 * INSET;
        Vec2::new(WIDTH, height)
    }

    /// The box to check the scale of a print (m), and its caption.
    fn test_box(&self) -> (Vec2, &'static str) {
        match Shown(self.unit).is_inch() {
            true => (Vec2::new(0.1016, 0.0508), "2 x 4 in"),
            false => (Vec2::new(0.100, 0.050), "50 x 100 mm"),
        }
    }

    fn facts_within(&self) -> Vec<String> {
        let room = WIDTH - LEGEND - 3.0 * INSET;
        let lines = self
            .facts
            .iter()
            .flat_map(|f| lines_within(f, LETTERS, room));
        lines.take(MAX_LINES).collect()
    }
}

/// Width of the legend (m).
const LEGEND: f64 = 0.052;

fn legend_rows(sizes: usize) -> usize {
    (if sizes > 1 { sizes } else { 0 } + 2).min(MAX_LINES)
}

/// Everything in the block except the map of sheets.
pub(crate) fn block_marks(job: &PrintJob) -> Vec<Mark> {
    let size = job.title.size(job.layers.len());
    let (low, high) = (job.title_at, job.title_at + size);
    let border = Bounds2 {
        min: low,
        max: high,
    };
    let mut marks = vec![Mark::line(None, Mark::rectangle(&border), THIN)];
    let left = low.x + INSET;
    let mut y = high.y - INSET - TITLE_LETTERS;
    let name = fitted(&job.title.name, TITLE_LETTERS, WIDTH - 2.0 * INSET);
    let mut write = |words: &str, at: Vec2, letters: f64| {
        marks.push(Mark::text(words, (at, Align::Left), (letters, BLACK)));
    };
    write(&name, Vec2::new(left, y), TITLE_LETTERS);
    y -= INSET;
    for (k, line) in job.title.facts_within().iter().enumerate() {
        let at = Vec2::new(left, y - LINE * (k + 1) as f64);
        write(line, at, LETTERS);
    }
    marks.extend(legend(job, Vec2::new(high.x - INSET - LEGEND, y)));
    marks.extend(test_box(low + Vec2::repeat(INSET), job.title.test_box()));
    marks
}

/// The legend: samples of lines with their meaning, below a position.
fn legend(job: &PrintJob, at: Vec2) -> Vec<Mark> {
    let several = job.layers.len() > 1;
    let mut rows: Vec<(StrokeKind, usize, String)> = Vec::new();
    if several {
        let sizes = job.layers.iter().enumerate();
        rows.extend(sizes.map(|(k, layer)| {
            let kind = match job.lines {
                Lines::Sew => StrokeKind::Sew,
                Lines::Cut | Lines::Both => StrokeKind::Cut,
            };
            (kind, k, layer.name.clone())
        }));
    }
    if job.lines != Lines::Sew {
        rows.push((StrokeKind::Cut, 0, "cut here".to_owned()));
    }
    if job.lines != Lines::Cut {
        rows.push((StrokeKind::Sew, 0, "sew here".to_owned()));
    }
    rows.truncate(MAX_LINES);
    let mut marks = Vec::new();
    for (k, (kind, layer, words)) in rows.into_iter().enumerate() {
        let y = at.y - LINE * (k + 1) as f64;
        let line = vec![
            Vec2::new(at.x, y + 0.3 * LETTERS),
            Vec2::new(at.x + 0.02, y + 0.3 * LETTERS),
        ];
        marks.push(Mark::line(None, (line, false), style(job, kind, layer)));
        let words = fitted(&words, LETTERS, LEGEND - 0.022);
        let place = Vec2::new(at.x + 0.022, y);
        marks.push(Mark::text(&words, (place, Align::Left), (LETTERS, BLACK)));
    }
    marks
}

/// The test box, at true size whatever the scale of the print.
fn test_box(low: Vec2, (size, name): (Vec2, &str)) -> Vec<Mark> {
    let bounds = Bounds2 {
        min: low,
        max: low + size,
    };
    let centre = bounds.centre();
    let words = |text: &str, above: f64, letters: f64| {
        let at = centre + Vec2::new(0.0, above);
        Mark::text(text, (at, Align::Middle), (letters, BLACK))
    };
    vec![
        Mark::line(None, Mark::rectangle(&bounds), THIN),
        words(name, 0.002, 2.0 * LETTERS),
        words("Measure this box before you cut.", -0.008, LETTERS),
        words(
            "Print at 100 %, without fitting to the page.",
            -0.014,
            LETTERS,
        ),
    ]
}

/// A map of the sheets, drawn to the right of the test box.
pub(crate) fn map_marks(job: &PrintJob, tiles: &[Tile]) -> Vec<Mark> {
    let rows = tiles.iter().map(|t| t.place[0]).max().unwrap_or(1);
    let columns = tiles.iter().map(|t| t.place[1]).max().unwrap_or(1);
    let (box_size, _) = job.title.test_box();
    let low = job.title_at + Vec2::new(box_size.x + 3.0 * INSET, INSET);
    let Some(step) = job.paper.step() else {
        return Vec::new();
    };
    let room = Vec2::new(WIDTH - box_size.x - 4.0 * INSET, box_size.y);
    let whole = Vec2::new(step.x * f64::from(columns), step.y * f64::from(rows));
    let scale = (room.x / whole.x).min(room.y / whole.y);
    let cell = step * scale;
    let top = low.y + box_size.y;
    let letters = (0.3 * cell.x).min(0.3 * cell.y).min(LETTERS);
    let mut marks = Vec::new();
    for (k, tile) in tiles.iter().enumerate() {
        let [row, column] = tile.place.map(f64::from);
        let min = Vec2::new(low.x + (column - 1.0) * cell.x, top - row * cell.y);
        let bounds = Bounds2 {
            min,
            max: min + cell,
        };
        marks.push(Mark::line(None, Mark::rectangle(&bounds), THIN));
        let at = bounds.centre() - Vec2::new(0.0, 0.35 * letters);
        let number = (k + 1).to_string();
        marks.push(Mark::text(&number, (at, Align::Middle), (letters, BLACK)));
    }
    marks
}
