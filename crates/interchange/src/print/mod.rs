//! Cut pieces on paper at true size: sheets to join by their marks, or one page; PDF or SVG.
//!
//! The pieces lie on a drawing of any size with its lower left corner at the origin. Sheets show windows of
//! the drawing that overlap by 10 mm. Every size is a layer.
//!
//! # Decided with
//! - [`toile_cut::CutPiece::drawing`] (`drawing.rs`): the lines of a piece;
//! - [`crate::print::draw`] (`prints`), [`crate::print::draw::style`]: which lines are printed and how;
//! - [`crate::print::paper::Paper`], [`crate::print::paper::tiles`]: papers; sheets that are needed;
//! - [`crate::print::title::block_marks`], [`crate::print::title`] (`legend`): title block, legend;
//! - [`crate::print::pdf`], [`crate::print::svg`]: the formats;
//! - [`toile_lettering::missing_note`]: letters of no font.
//!
//! The compiler asks a new paper here and in crate `cli`, `print_arguments.rs`. By hand: the window's list
//! (`app/print_choice.rs`, `app/preferences.rs`); a new kind of line in `legend`.
//! Laid out, and refused where there are too many sheets or a piece finds no room, by crate `session`, `printing.rs`
//! (`arranged`, `laid`, `too_many`).

mod draw;
mod mark;
mod paper;
mod pdf;
mod svg;
mod title;

pub use paper::{Paper, Tile};
pub use title::TitleBlock;

use crate::FormatError;
use crate::marker_strokes::Layer;
use crate::pdf::Align;
use mark::{LineStyle, Mark, Page, Shape};
use paper::{OVERLAP, clipped, crosses, tiles};
use std::sync::Arc;
use toile_cut::CutPiece;
use toile_geometry::{Bounds2, Vec2};
use toile_lettering::{missing_letters, missing_note, width};
use toile_nesting::Pose;

/// The lines of a piece that are printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lines {
    /// The cut lines.
    Cut,
    /// The seam lines.
    Sew,
    /// Both the cut lines and the seam lines.
    #[default]
    Both,
}

/// A size, which is a layer of the print.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PrintLayer {
    /// Name displayed, as in "size M".
    pub name: String,
}

/// A piece to print, in one size or in several that are stacked as drafted.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintPiece {
    /// Indices of sizes in [`PrintJob::layers`], each with the piece in that size.
    pub sizes: Vec<(usize, Arc<CutPiece>)>,
    /// Lines of text written on the piece.
    pub words: Vec<String>,
    /// Transform from the scaled piece to the drawing.
    pub pose: Pose,
}

/// A print: pieces, paper and title block.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintJob {
    /// The paper.
    pub paper: Paper,
    /// Length on paper divided by length of cloth.
    pub scale: f64,
    /// The lines of the pieces that are printed.
    pub lines: Lines,
    /// Size of the drawing (m).
    pub size: Vec2,
    /// The sizes.
    pub layers: Vec<PrintLayer>,
    /// The pieces.
    pub pieces: Vec<PrintPiece>,
    /// The title block.
    pub title: TitleBlock,
    /// Lower left corner of the title block (m).
    pub title_at: Vec2,
}

/// Arm length of the crosses at which sheets are joined (m).
const CROSS: f64 = 0.004;
const GREY: [f32; 3] = [0.55, 0.55, 0.55];
/// Line style of the frame of a sheet and of the crosses at which sheets are joined.
const JOIN: LineStyle = LineStyle {
    layer: None,
    ink: GREY,
    width: 0.000_15,
    dash: 0.0,
};
/// Spacing of the lines that texts keep clear of (m): less than the height of the smallest letters, so that
/// no text fits between them.
const ACROSS: f64 = 0.001;
/// Smallest distance between a text and the overlap of two sheets (m).
const BESIDE: f64 = 0.004;
/// Letter size of a sheet's row and column (m).
const PLACE_LETTERS: f64 = 0.004;

impl PrintJob {
    /// The sheets with content, row by row from the top.
    ///
    /// # Errors
    /// A number is not finite.
    pub fn tiles(&self) -> Result<Vec<Tile>, FormatError> {
        self.check_numbers()?;
        Ok(self.tiles_of(&self.marks()))
    }

    /// The print as PDF; sizes are optional content.
    ///
    /// # Errors
    /// A number is not finite.
    pub fn pdf(&self) -> Result<Vec<u8>, FormatError> {
        Ok(pdf::write_pdf(
            &self.title.name,
            &self.pages()?,
            &self.layer_names(),
        ))
    }

    /// The print as SVG with the sheets side by side; sizes are Inkscape layers.
    ///
    /// # Errors
    /// A number is not finite.
    pub fn svg(&self) -> Result<String, FormatError> {
        Ok(svg::write_svg(
            &self.title.name,
            &self.pages()?,
            &self.layer_names(),
        ))
    }

    /// Warning about characters of the print's texts that no font has.
    pub fn missing_note(&self) -> Option<String> {
        let words = self.pieces.iter().flat_map(|piece| &piece.words);
        let layers = self.layers.iter().map(|layer| &layer.name);
        let title = std::iter::once(&self.title.name).chain(&self.title.facts);
        let all = words.chain(layers).chain(title);
        missing_note(&missing_letters(all.map(String::as_str)))
    }

    fn layer_names(&self) -> Vec<String> {
        self.layers.iter().map(|layer| layer.name.clone()).collect()
    }

    fn check_numbers(&self) -> Result<(), FormatError> {
        let refuse = |place: String| {
            let hint = "check the piece's outline";
            Err(FormatError::new(place, "a number is not finite", hint))
        };
        let sizes = [self.scale, self.size.x, self.size.y];
        if !sizes.iter().all(|x| x.is_finite() && *x > 0.0) {
            return refuse("print".to_owned());
        }
        for (_, piece) in self.pieces.iter().flat_map(|piece| &piece.sizes) {
            if !piece.is_finite() {
                return refuse(format!("piece {:?}", piece.name));
            }
        }
        Ok(())
    }

    /// All marks of the drawing; the frames, crosses and numbers of the sheets and their map are added later.
    fn marks(&self) -> Vec<Mark> {
        let clear_of = self.between_sheets();
        let mut marks = Vec::new();
        for piece in &self.pieces {
            marks.extend(draw::piece_marks(self, piece, Some(&clear_of)));
        }
        marks.extend(title::block_marks(self));
        marks
    }

    /// Lines that texts keep clear of: along every overlap of sheets, and across the sheets that are not
    /// printed because they show no line of a piece.
    fn between_sheets(&self) -> Vec<[Vec2; 2]> {
        let (Some(step), Some(window)) = (self.paper.step(), self.paper.window()) else {
            return Vec::new();
        };
        let bare = self.pieces.iter();
        let bare = bare.flat_map(|piece| draw::piece_marks(self, piece, None));
        // Without the grain line: its position depends on the texts, which are not placed yet.
        let is_grain = |mark: &Mark| match &mark.shape {
            Shape::Line { style, .. } => style.layer == Some(Layer::Grain),
            Shape::Text { .. } => false,
        };
        let mut bare: Vec<Mark> = bare.filter(|mark| !is_grain(mark)).collect();
        bare.extend(title::block_marks(self));
        let shown = self.tiles_of(&bare);
        let all = tiles(self.paper, self.size, |_| true);
        let left_out = all.iter().filter(|tile| !shown.contains(tile));
        let mut lines = Vec::new();
        for tile in left_out {
            let count = (window.y / ACROSS) as usize;
            lines.extend((1..count).map(|k| {
                let at = tile.window.min + Vec2::new(0.0, k as f64 * ACROSS);
                [at, at + Vec2::new(window.x, 0.0)]
            }));
        }
        for axis in [0, 1] {
            for k in 1..=(self.size[axis] / step[axis]) as usize {
                let count = ((OVERLAP + 2.0 * BESIDE) / ACROSS).round() as usize;
                for n in 0..=count {
                    // Columns are counted from the left, rows from the top.
                    let at = k as f64 * step[axis] - BESIDE + n as f64 * ACROSS;
                    lines.push(match axis {
                        0 => [Vec2::new(at, 0.0), Vec2::new(at, self.size.y)],
                        _ => [0.0, self.size.x].map(|x| Vec2::new(x, self.size.y - at)),
                    });
                }
            }
        }
        lines
    }

    fn tiles_of(&self, marks: &[Mark]) -> Vec<Tile> {
        tiles(self.paper, self.size, |cell| {
            marks.iter().any(|mark| match &mark.shape {
                Shape::Line { points, closed, .. } => !clipped(points, *closed, cell).is_empty(),
                Shape::Text { .. } => false,
            })
        })
    }

    fn pages(&self) -> Result<Vec<Page>, FormatError> {
        self.check_numbers()?;
        let mut marks = self.marks();
        let tiles = self.tiles_of(&marks);
        if self.paper.sheet().is_some() {
            marks.extend(title::map_marks(self, &tiles));
        }
        let count = tiles.len();
        let pages = tiles.iter().enumerate();
        Ok(pages
            .map(|(k, tile)| self.page(&marks, tile, (k + 1, count)))
            .collect())
    }

    fn page(&self, marks: &[Mark], tile: &Tile, (number, count): (usize, usize)) -> Page {
        let window = Bounds2 {
            min: tile.window.min + tile.shift,
            max: tile.window.max + tile.shift,
        };
        let mut page = Page {
            size: tile.sheet,
            name: format!("row {}, column {}", tile.place[0], tile.place[1]),
            window,
            inside: marks.iter().flat_map(|mark| on_page(mark, tile)).collect(),
            on_top: Vec::new(),
        };
        if self.paper.sheet().is_none() {
            page.name = self.title.name.clone();
            return page;
        }
        page.on_top
            .push(Mark::line(None, Mark::rectangle(&window), JOIN));
        for at in crosses(tile) {
            for arm in [Vec2::new(CROSS, 0.0), Vec2::new(0.0, CROSS)] {
                let ends = vec![at + tile.shift - arm, at + tile.shift + arm];
                page.on_top.push(Mark::line(None, (ends, false), JOIN));
            }
        }
        let words = format!("{}: sheet {number} of {count}", page.name);
        let letters = (PLACE_LETTERS, GREY);
        let at = free_place(&page, width(&words) * PLACE_LETTERS);
        page.on_top
            .push(Mark::text(&words, (at, Align::Left), letters));
        page
    }
}

/// A position for a text of a given length (m) that crosses no mark on a page: first along the lower edge,
/// then higher up; the lower left corner if there is no such position.
fn free_place(page: &Page, length: f64) -> Vec2 {
    let low = page.window.min + Vec2::repeat(1.5 * PLACE_LETTERS);
    let room =
        page.window.size() - Vec2::new(length, PLACE_LETTERS) - (low - page.window.min) * 2.0;
    let steps = |length: f64, step: f64| 0..=(length.max(0.0) / step) as u32;
    let columns = steps(room.x, 0.01);
    let rows = steps(room.y, 2.0 * PLACE_LETTERS);
    let places = rows.flat_map(|row| {
        let up = f64::from(row) * 2.0 * PLACE_LETTERS;
        let columns = columns.clone();
        columns.map(move |column| low + Vec2::new(f64::from(column) * 0.01, up))
    });
    let marks = || page.inside.iter().chain(&page.on_top);
    let is_free = |at: &Vec2| {
        let bounds = Bounds2 {
            min: *at,
            max: at + Vec2::new(length, PLACE_LETTERS),
        };
        let bounds = bounds.grown(0.4 * PLACE_LETTERS);
        !marks().any(|mark| match &mark.shape {
            Shape::Line { points, closed, .. } => !clipped(points, *closed, &bounds).is_empty(),
            Shape::Text { .. } => mark.bounds().meets(&bounds),
        })
    };
    places.into_iter().find(is_free).unwrap_or(low)
}

/// The part of a mark inside the window of a sheet.
fn on_page(mark: &Mark, tile: &Tile) -> Vec<Mark> {
    let moved = |points: &[Vec2]| points.iter().map(|p| p + tile.shift).collect::<Vec<_>>();
    let with = |shape: Shape| Mark {
        layer: mark.layer,
        shape,
    };
    match &mark.shape {
        Shape::Line {
            points,
            closed,
            style,
        } => {
            let inside = points.iter().all(|&p| tile.window.contains(p));
            let (parts, closed) = match inside {
                true => (vec![points.clone()], *closed),
                false => (clipped(points, *closed, &tile.window), false),
            };
            let line = |part: &Vec<Vec2>| {
                with(Shape::Line {
                    points: moved(part),
                    closed,
                    style: *style,
                })
            };
            parts.iter().map(line).collect()
        }
        _ if !mark.bounds().meets(&tile.window) => Vec::new(),
        Shape::Text { .. } => {
            let mut shape = mark.shape.clone();
            if let Shape::Text { at, .. } = &mut shape {
                *at += tile.shift;
            }
            vec![with(shape)]
        }
    }
}
