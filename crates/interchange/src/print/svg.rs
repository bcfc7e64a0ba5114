//! Pages as SVG: millimetres, side by side, sizes as layers of Inkscape.

use super::mark::{Mark, Page, Shape};
use crate::pdf::{Align, Ink};
use crate::svg_text::{escape, number};
use std::fmt::Write as _;
use toile_geometry::Vec2;

/// Distance between two pages (m).
const GAP: f64 = 0.02;

/// Writes pages as SVG; `layers` are the names of the layers of their marks.
pub(crate) fn write_svg(title: &str, pages: &[Page], layers: &[String]) -> String {
    let mut corners = Vec::with_capacity(pages.len());
    let (mut right, mut high) = (0.0_f64, 0.0_f64);
    for page in pages {
        let left = if corners.is_empty() { 0.0 } else { right + GAP };
        corners.push(left);
        right = left + page.size.x;
        high = high.max(page.size.y);
    }
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" xmlns:sodipodi=\"http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd\" version=\"1.1\" width=\"{0}mm\" height=\"{1}mm\" viewBox=\"0 0 {0} {1}\" font-family=\"Helvetica, Arial, sans-serif\">",
        number(right * 1e3),
        number(high * 1e3)
    );
    let _ = writeln!(text, "<title>{}</title>", escape(title));
    text += "<sodipodi:namedview id=\"view\" inkscape:document-units=\"mm\">\n";
    for (k, (page, left)) in pages.iter().zip(&corners).enumerate() {
        let _ = writeln!(
            text,
            "<inkscape:page id=\"page-{}\" x=\"{}\" y=\"0\" width=\"{}\" height=\"{}\" inkscape:label=\"{}\"/>",
            k + 1,
            number(left * 1e3),
            number(page.size.x * 1e3),
            number(page.size.y * 1e3),
            escape(&page.name)
        );
    }
    text += "</sodipodi:namedview>\n<defs>\n";
    for (k, page) in pages.iter().enumerate() {
        let (low, size) = (page.window.min, page.window.size());
        let _ = writeln!(
            text,
            "<clipPath id=\"window-{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>",
            k + 1,
            number(low.x * 1e3),
            number((page.size.y - low.y - size.y) * 1e3),
            number(size.x * 1e3),
            number(size.y * 1e3)
        );
    }
    text += "</defs>\n";
    let all = std::iter::once(None).chain((0..layers.len()).map(Some));
    for layer in all {
        let (id, label) = match layer {
            None => ("all-sizes".to_owned(), "All sizes".to_owned()),
            Some(k) => (format!("size-{}", k + 1), layers[k].clone()),
        };
        let _ = writeln!(
            text,
            "<g id=\"{id}\" inkscape:groupmode=\"layer\" inkscape:label=\"{}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">",
            escape(&label)
        );
        for (k, (page, left)) in pages.iter().zip(&corners).enumerate() {
            let own = |mark: &&Mark| mark.layer == layer;
            let _ = writeln!(
                text,
                "<g transform=\"translate({} 0)\">",
                number(left * 1e3)
            );
            let _ = writeln!(text, "<g clip-path=\"url(#window-{})\">", k + 1);
            page.inside
                .iter()
                .filter(own)
                .for_each(|m| write_mark(&mut text, page, m));
            text += "</g>\n";
            page.on_top
                .iter()
                .filter(own)
                .for_each(|m| write_mark(&mut text, page, m));
            text += "</g>\n";
        }
        text += "</g>\n";
    }
    text + "</svg>\n"
}

fn write_mark(text: &mut String, page: &Page, mark: &Mark) {
    let at = |p: Vec2| {
        format!(
            "{} {}",
            number(p.x * 1e3),
            number((page.size.y - p.y) * 1e3)
        )
    };
    let path = |points: &[Vec2], closed: bool| {
        let corners: Vec<String> = points.iter().map(|&p| at(p)).collect();
        let end = if closed { "Z" } else { "" };
        format!("M{}{end}", corners.join("L"))
    };
    match &mark.shape {
        Shape::Line {
            points,
            closed,
            style,
        } => {
            let dash = match style.dash > 0.0 {
                true => format!(
                    " stroke-dasharray=\"{} {}\"",
                    number(style.dash * 1e3),
                    number(style.dash * 0.5e3)
                ),
                false => String::new(),
            };
            let class = style
                .layer
                .map_or_else(String::new, |layer| format!(" class=\"{}\"", layer.class()));
            let _ = writeln!(
                text,
                "<path d=\"{}\"{class} fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{dash}/>",
                path(points, *closed),
                colour(style.ink),
                number(style.width * 1e3)
            );
        }
        Shape::Text {
            text: words,
            at: place,
            size,
            angle,
            align,
            ink,
        } => {
            let anchor = match align {
                Align::Left => "start",
                Align::Middle => "middle",
                Align::Right => "end",
            };
            let place = at(*place);
            let (x, y) = place.split_once(' ').unwrap_or((&place, "0"));
            let turned = number(-angle.to_degrees());
            let turn = match turned == "0" {
                true => String::new(),
                false => format!(" transform=\"rotate({turned} {x} {y})\""),
            };
            let _ = writeln!(
                text,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{}\" stroke=\"none\"{turn}>{}</text>",
                number(size * 1e3),
                colour(*ink),
                escape(words)
            );
        }
    }
}

fn colour(ink: Ink) -> String {
    let [r, g, b] = ink.map(|part| (part * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
