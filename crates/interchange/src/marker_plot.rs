//! A marker for machines and for paper at true size: DXF, HPGL, PDF.
//!
//! # Decided with
//! - [`crate::marker_drawing::MarkerDrawing`]: what is drawn;
//! - [`crate::marker_strokes::Strokes`], [`crate::marker_strokes::Layer`]: lines and layers;
//! - [`crate::marker_svg::write_marker_svg`], [`crate::marker_report::write_marker_report`]: the same as SVG;
//!   a report on A4;
//! - [`crate::dxf`], [`crate::hpgl`], [`crate::pdf`], [`crate::svg_text`]: lines and words of each format;
//! - [`crate::pdf_fonts`], [`toile_lettering::missing_note`]: letters; those of no font are told;
//! - [`toile_cut::StrokeKind`], [`crate::print`] (`draw.rs`): kinds of lines of a piece; prints;
//! - [`crate::marker_json::MarkerFile`]: the marker as data, from which it can be checked again.
//!
//! Verdict and numbers: crate `marker` (`finished_marker.rs`, `summary.rs`). A file checked again: crate
//! `session`, `marker_file_check.rs`. In the window: `views/marker_piece.rs`.

use crate::dxf::DxfWriter;
use crate::hpgl::HpglWriter;
use crate::marker_strokes::{Layer, Strokes, fill_of};
use crate::pdf::{Align, PdfPage, PdfSheets, PdfText, fitted, wrapped};
use crate::{FormatError, MarkerDrawing};
use toile_geometry::Vec2;
use toile_lettering::width;

/// A marker as DXF of release 12, in millimetres. Layers CUT, SEW, NOTCH, GRAIN, LINE, DRILL, TEXT hold the
/// pieces, layers FABRIC, MARGIN, FOLD, PRINT, FLAW the cloth. The origin is the lower corner of the start of
/// the fabric. The title stands above the fabric.
///
/// # Errors
/// A coordinate is not finite.
pub fn write_marker_dxf(drawing: &MarkerDrawing) -> Result<String, FormatError> {
    drawing.check_numbers()?;
    let layers = Layer::ALL.map(|l| (l.name(), l.colour_index()));
    let mut dxf = DxfWriter::new(layers.to_vec());
    let all = Strokes::of(drawing);
    for stroke in &all.strokes {
        dxf.polyline(stroke.layer.name(), &stroke.points, stroke.closed);
    }
    for words in &all.words {
        let place = (words.at, words.size, words.angle);
        dxf.text(Layer::Text.name(), &words.text, place);
    }
    // Smaller letters if the title would be longer than the fabric.
    let size = TITLE.min(drawing.length.max(TITLE) / width(&drawing.title).max(1.0));
    let above = Vec2::new(0.5 * drawing.length, drawing.strip.width + TITLE);
    dxf.text(Layer::Text.name(), &drawing.title, (above, size, 0.0));
    Ok(dxf.finish())
}

/// A marker for a plotter or cutter: HPGL/2 in hundredths of a millimetre. Pen 1 draws the lines to cut, pen
/// 2 the markings on the pieces, pen 3 the fabric.
///
/// # Errors
/// A coordinate is not finite.
pub fn write_marker_hpgl(drawing: &MarkerDrawing) -> Result<String, FormatError> {
    drawing.check_numbers()?;
    let all = Strokes::of(drawing);
    let mut hpgl = HpglWriter::new(Vec2::new(drawing.length, drawing.strip.width));
    // Fabric first, then markings, then cuts: no line is drawn on a piece that has been cut out.
    for pen in [3, 2, 1] {
        for stroke in all.strokes.iter().filter(|s| s.layer.pen() == pen) {
            hpgl.polyline(pen, &stroke.points, stroke.closed);
        }
        if Layer::Text.pen() == pen {
            for words in &all.words {
                hpgl.text(pen, &words.text, (words.at, words.size, words.angle));
            }
        }
    }
    Ok(hpgl.finish())
}

/// Letter height of the title, and its distance above the fabric (m).
const TITLE: f64 = 0.02;
/// White border round the fabric (m).
const BORDER: f64 = 0.02;

/// A marker on one PDF page at true size.
///
/// # Errors
/// A coordinate is not finite.
pub fn write_marker_pdf(drawing: &MarkerDrawing) -> Result<Vec<u8>, FormatError> {
    drawing.check_numbers()?;
    let fabric = Vec2::new(drawing.length, drawing.strip.width);
    let wide = (fabric.x + 2.0 * BORDER).max(0.4);
    let room = wide - 2.0 * BORDER;
    let summary = drawing.summary();
    let lines: Vec<String> = summary
        .iter()
        .flat_map(|s| wrapped(s, 0.011, room))
        .collect();
    let header = 0.02 * (2 + lines.len()) as f64;
    let size = Vec2::new(wide, fabric.y + 2.0 * BORDER + header);
    let mut page = PdfPage::new(size);
    let look = PlotLook {
        origin: Vec2::new(BORDER, BORDER),
        scale: 1.0,
        width: 0.0005,
        words: true,
    };
    plot(&mut page, drawing, &look);
    let mut line = size.y - 0.03;
    let mut write = |text: &str, size: f64| {
        page.text(PdfText {
            text,
            at: Vec2::new(BORDER, line),
            size,
            angle: 0.0,
            align: Align::Left,
            ink: Layer::Text.ink(),
        });
        line -= 0.02;
    };
    write(&fitted(&drawing.title, 0.018, room), 0.018);
    for words in &lines {
        write(words, 0.011);
    }
    let mut sheets = PdfSheets::default();
    sheets.push(page);
    Ok(sheets.finish(&drawing.title))
}

/// Placement and style of a marker on a page.
pub(crate) struct PlotLook {
    /// Position of the fabric's lower corner (m).
    pub origin: Vec2,
    /// Length on the page divided by length of fabric.
    pub scale: f64,
    /// Width of a line to cut along (m); other lines are half as wide.
    pub width: f64,
    /// Whether texts are written.
    pub words: bool,
}

/// Fill colour of the regions where pieces overlap: these would be cut twice.
const CUT_TWICE: [f32; 3] = [0.9, 0.0, 0.0];

/// Draws a marker on a page.
pub(crate) fn plot(page: &mut PdfPage, drawing: &MarkerDrawing, look: &PlotLook) {
    let on_page = |p: Vec2| look.origin + p * look.scale;
    let mapped = |points: &[Vec2]| points.iter().map(|&p| on_page(p)).collect::<Vec<_>>();
    for piece in &drawing.pieces {
        let cut = piece.pose.lay(&piece.piece.polygon());
        let rings: Vec<Vec<Vec2>> = cut.rings().map(|r| mapped(r)).collect();
        let fill = fill_of(piece.item).map(|part| f32::from(part) / 255.0);
        page.fill(rings.iter().map(Vec::as_slice), fill);
    }
    for overlap in &drawing.overlaps {
        let rings: Vec<Vec<Vec2>> = overlap.rings().map(|r| mapped(r)).collect();
        page.fill(rings.iter().map(Vec::as_slice), CUT_TWICE);
    }
    let all = Strokes::of(drawing);
    for stroke in &all.strokes {
        let dash = match stroke.layer {
            Layer::Sew => 0.006,
            Layer::Fold => 0.02,
            Layer::Fabric
            | Layer::Margin
            | Layer::Print
            | Layer::Flaw
            | Layer::Cut
            | Layer::Line
            | Layer::Notch
            | Layer::Grain
            | Layer::Drill
            | Layer::Text => 0.0,
        };
        let width = match stroke.layer.is_cut() {
            true => look.width,
            false => 0.5 * look.width,
        };
        let style = (width, dash * look.scale, stroke.layer.ink());
        page.begin_kind(stroke.layer.name());
        page.stroke(&mapped(&stroke.points), stroke.closed, style);
        page.end_kind();
    }
    for words in all.words.iter().filter(|_| look.words) {
        page.text(PdfText {
            text: &words.text,
            at: on_page(words.at),
            size: words.size * look.scale,
            angle: words.angle,
            align: Align::Middle,
            ink: Layer::Text.ink(),
        });
    }
}
