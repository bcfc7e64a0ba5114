//! Pages as PDF, sizes as optional content.

use super::mark::{Mark, Page, Shape};
use crate::pdf::{PdfPage, PdfSheets, PdfText};

/// Writes pages as PDF; `layers` are the names of the layers of their marks.
pub(crate) fn write_pdf(title: &str, pages: &[Page], layers: &[String]) -> Vec<u8> {
    let mut sheets = PdfSheets::with_layers(layers);
    for page in pages {
        let mut sheet = PdfPage::new(page.size);
        sheet.clip(&page.window);
        write_marks(&mut sheet, &page.inside, layers.len());
        sheet.end_clip();
        write_marks(&mut sheet, &page.on_top, layers.len());
        sheets.push(sheet);
    }
    sheets.finish(title)
}

fn write_marks(sheet: &mut PdfPage, marks: &[Mark], layers: usize) {
    for layer in std::iter::once(None).chain((0..layers).map(Some)) {
        let mut own = marks.iter().filter(|mark| mark.layer == layer).peekable();
        if own.peek().is_none() {
            continue;
        }
        if let Some(layer) = layer {
            sheet.begin_layer(layer);
        }
        own.for_each(|mark| write_mark(sheet, mark));
        if layer.is_some() {
            sheet.end_layer();
        }
    }
}

fn write_mark(sheet: &mut PdfPage, mark: &Mark) {
    match &mark.shape {
        Shape::Line {
            points,
            closed,
            style,
        } => {
            if let Some(layer) = style.layer {
                sheet.begin_kind(layer.name());
            }
            sheet.stroke(points, *closed, (style.width, style.dash, style.ink));
            if style.layer.is_some() {
                sheet.end_kind();
            }
        }
        Shape::Text {
            text,
            at,
            size,
            angle,
            align,
            ink,
        } => sheet.text(PdfText {
            text,
            at: *at,
            size: *size,
            angle: *angle,
            align: *align,
            ink: *ink,
        }),
    }
}
