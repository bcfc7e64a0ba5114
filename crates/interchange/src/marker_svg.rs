//! A marker as SVG: millimetres, at true size, y down.
//!
//! The fabric lies along x from the origin of the drawing, the upper selvedge at y = 0. Numbers
//! have a fixed count of decimals, so that the same marker gives the same bytes.

use crate::marker_label::{Spot, roomiest_spot, size_on};
use crate::{FormatError, MarkerDrawing, MarkerPiece};
use std::fmt::Write as _;
use toile_geometry::{Polygon, Vec2};
use toile_nesting::{Fold, Pose};

/// White round the fabric \[mm\].
const BORDER: f64 = 20.0;
/// Height of the text above the fabric \[mm\].
const HEADER: f64 = 90.0;
/// Pale fills, one after another by item.
const FILLS: [&str; 8] = [
    "#f6d9c8", "#cfe3f2", "#d9ecd0", "#f5e6b8", "#e3d6ee", "#f3d0d8", "#cdeae6", "#e6e0d4",
];

/// The SVG text of a marker.
///
/// # Errors
/// A coordinate is not finite.
pub fn write_marker_svg(drawing: &MarkerDrawing) -> Result<String, FormatError> {
    drawing.check_numbers()?;
    let (length, width) = (drawing.length * 1e3, drawing.strip.width * 1e3);
    let sheet = (
        length.max(400.0) + 2.0 * BORDER,
        width + HEADER + 2.0 * BORDER,
    );
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"{0}mm\" height=\"{1}mm\" viewBox=\"{2} {3} {0} {1}\" font-family=\"Helvetica, Arial, sans-serif\">",
        number(sheet.0),
        number(sheet.1),
        number(-BORDER),
        number(-HEADER - BORDER),
    );
    let summary = drawing.summary();
    let _ = writeln!(
        text,
        "<title>{}: {}</title>",
        escape(&drawing.title),
        summary[0]
    );
    let _ = writeln!(text, "<desc>{}</desc>", escape(&summary.join(" ")));
    header(&mut text, drawing, &summary);
    fabric(&mut text, drawing);
    text.push_str("<g id=\"pieces\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n");
    for piece in &drawing.pieces {
        write_piece(&mut text, piece, drawing.strip.width);
    }
    text.push_str("</g>\n");
    overlaps(&mut text, drawing);
    text.push_str("</svg>\n");
    Ok(text)
}

/// Three decimals of a millimetre; no negative zero.
fn number(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}

fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            c if c.is_control() => safe.push(' '),
            c => safe.push(c),
        }
    }
    safe
}

fn header(text: &mut String, drawing: &MarkerDrawing, summary: &[String]) {
    text.push_str("<g id=\"heading\" fill=\"#222222\" stroke=\"none\">\n");
    let mut line = |y: f64, size: f64, colour: &str, words: &str| {
        let _ = writeln!(
            text,
            "<text x=\"0\" y=\"{}\" font-size=\"{}\" fill=\"{colour}\">{}</text>",
            number(y),
            number(size),
            escape(words)
        );
    };
    line(-HEADER + 14.0, 22.0, "#222222", &drawing.title);
    for (k, words) in summary.iter().enumerate() {
        let colour = if k >= 2 { "#b00020" } else { "#222222" };
        line(-HEADER + 36.0 + 18.0 * k as f64, 14.0, colour, words);
    }
    text.push_str("</g>\n");
    // A bar of known length, to check the scale of a print.
    let right = (drawing.length * 1e3).max(400.0);
    let _ = writeln!(
        text,
        "<g id=\"scale\"><path d=\"M{0} -{2}v-6M{0} -{3}H{1}M{1} -{2}v-6\" fill=\"none\" stroke=\"#222222\" stroke-width=\"1\"/><text x=\"{4}\" y=\"-18\" font-size=\"12\" text-anchor=\"middle\" fill=\"#222222\">100 mm</text></g>",
        number(right - 100.0),
        number(right),
        8,
        11,
        number(right - 50.0)
    );
}

fn fabric(text: &mut String, drawing: &MarkerDrawing) {
    let (length, width) = (drawing.length * 1e3, drawing.strip.width * 1e3);
    let strip = &drawing.strip;
    let (lower, upper) = (strip.lower() * 1e3, width - strip.upper() * 1e3);
    let margin = strip.end_margin * 1e3;
    let mut rectangle = |class: &str, place: [f64; 4], style: &str| {
        if place[2] > 0.0 && place[3] > 0.0 {
            let [x, y, w, h] = place.map(number);
            let _ = writeln!(
                text,
                "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" {style}/>"
            );
        }
    };
    rectangle(
        "fabric",
        [0.0, 0.0, length, width],
        "fill=\"#fffdf8\" stroke=\"none\"",
    );
    let shade = "fill=\"#cfc8bb\" stroke=\"none\"";
    rectangle("selvedge", [0.0, 0.0, length, upper], shade);
    rectangle("selvedge", [0.0, width - lower, length, lower], shade);
    let shade = "fill=\"#ebe6dc\" stroke=\"none\"";
    let inner = width - lower - upper;
    rectangle("end-margin", [0.0, upper, margin, inner], shade);
    rectangle("end-margin", [length - margin, upper, margin, inner], shade);
    let line = "fill=\"none\" stroke=\"#555555\" stroke-width=\"1\"";
    rectangle("fabric-edge", [0.0, 0.0, length, width], line);
    let folds: &[f64] = match strip.fold {
        Fold::Open => &[],
        Fold::Lower => &[width],
        Fold::Both => &[0.0, width],
    };
    for y in folds {
        let _ = writeln!(
            text,
            "<path class=\"fold\" d=\"M0 {}H{}\" fill=\"none\" stroke=\"#8c338c\" stroke-width=\"2\" stroke-dasharray=\"20 5 4 5\"/>",
            number(*y),
            number(length)
        );
    }
    print_and_flaws(text, drawing);
}

/// Most lines of a print that are drawn along one side.
const MOST_LINES: f64 = 2000.0;

/// The lines of the print and the flaws of the fabric; y runs down on the page.
fn print_and_flaws(text: &mut String, drawing: &MarkerDrawing) {
    let (length, width) = (drawing.length * 1e3, drawing.strip.width * 1e3);
    let mut path = |class: &str, d: &str, style: &str| {
        if !d.is_empty() {
            let _ = writeln!(text, "<path class=\"{class}\" d=\"{d}\" {style}/>");
        }
    };
    if let Some(print) = &drawing.strip.stripes {
        let mut d = String::new();
        for axis in 0..2 {
            let (repeat, end) = (print.repeat[axis] * 1e3, [length, width][axis]);
            if repeat <= 0.0 || end / repeat > MOST_LINES {
                continue;
            }
            let mut at = (print.origin[axis] * 1e3).rem_euclid(repeat);
            while at <= end {
                let _ = match axis {
                    0 => write!(d, "M{} 0V{}", number(at), number(width)),
                    _ => write!(d, "M0 {}H{}", number(width - at), number(length)),
                };
                at += repeat;
            }
        }
        path(
            "print",
            &d,
            "fill=\"none\" stroke=\"#9db8d9\" stroke-width=\"1\"",
        );
    }
    for defect in &drawing.strip.defects {
        let mut d = String::new();
        for (k, p) in defect.outline.outer.iter().enumerate() {
            let step = if k == 0 { 'M' } else { 'L' };
            let _ = write!(
                d,
                "{step}{} {}",
                number(p.x * 1e3),
                number(width - p.y * 1e3)
            );
        }
        d.push('Z');
        path("flaw", &d, "fill=\"#d9485f\" stroke=\"none\"");
    }
}

/// What is cut twice.
fn overlaps(text: &mut String, drawing: &MarkerDrawing) {
    let width = drawing.strip.width;
    for polygon in &drawing.overlaps {
        let mut d = String::new();
        for ring in polygon.rings() {
            for (k, p) in ring.iter().enumerate() {
                let step = if k == 0 { 'M' } else { 'L' };
                let (x, y) = (number(p.x * 1e3), number((width - p.y) * 1e3));
                let _ = write!(d, "{step}{x} {y}");
            }
            d.push('Z');
        }
        let _ = writeln!(
            text,
            "<path class=\"overlap\" d=\"{d}\" fill=\"#e60000\" fill-opacity=\"0.8\" fill-rule=\"evenodd\" stroke=\"#e60000\" stroke-width=\"2\"/>"
        );
    }
}

/// From a piece's plane to the page.
struct Page<'a> {
    pose: &'a Pose,
    width: f64,
}

impl Page<'_> {
    fn at(&self, point: Vec2) -> Vec2 {
        self.flat(self.pose.apply(point))
    }

    /// From the fabric to the page.
    fn flat(&self, laid: Vec2) -> Vec2 {
        Vec2::new(laid.x, self.width - laid.y) * 1e3
    }

    fn path(&self, points: &[Vec2], end: &str) -> String {
        let mut path = String::new();
        for (k, &p) in points.iter().enumerate() {
            let p = self.at(p);
            let command = if k == 0 { 'M' } else { 'L' };
            let _ = write!(path, "{command}{} {}", number(p.x), number(p.y));
        }
        path + end
    }

    fn rings(&self, polygon: &Polygon) -> String {
        let rings = polygon.rings().filter(|r| r.len() > 1);
        rings.map(|r| self.path(r, "Z")).collect()
    }
}

fn write_piece(text: &mut String, piece: &MarkerPiece, width: f64) {
    let page = Page {
        pose: &piece.pose,
        width,
    };
    let spot = roomiest_spot(&piece.pose.lay(&piece.cut));
    let name = escape(&piece.name);
    let _ = writeln!(
        text,
        "<g class=\"piece\" data-name=\"{name}\" data-turn=\"{}\" data-face-down=\"{}\">",
        number(piece.pose.turn.to_degrees()),
        piece.pose.mirrored
    );
    let _ = writeln!(
        text,
        "<title>{name}</title>\n<path class=\"cut\" d=\"{}\" fill=\"{}\" fill-rule=\"evenodd\" stroke=\"#111111\" stroke-width=\"0.8\"/>",
        page.rings(&piece.cut),
        FILLS[piece.item % FILLS.len()]
    );
    let mut stroke = |class: &str, path: &str, style: &str| {
        if !path.is_empty() {
            let _ = writeln!(
                text,
                "<path class=\"{class}\" d=\"{path}\" fill=\"none\" {style}/>"
            );
        }
    };
    let dashed = "stroke=\"#666666\" stroke-width=\"0.5\" stroke-dasharray=\"4 2\"";
    stroke("sew", &page.rings(&piece.sew), dashed);
    let lines: String = piece.lines.iter().map(|l| page.path(l, "")).collect();
    stroke("line", &lines, "stroke=\"#888888\" stroke-width=\"0.5\"");
    let notches: String = piece.notches.iter().map(|n| page.path(n, "")).collect();
    stroke("notch", &notches, "stroke=\"#111111\" stroke-width=\"0.8\"");
    let size = (spot.room * 300.0).clamp(4.0, 22.0);
    let grain = piece.grain.map_or_else(
        || grain_through(&page, &spot),
        |ends| ends.map(|p| page.at(p)),
    );
    stroke(
        "grain",
        &arrow(grain, size),
        "stroke=\"#1f4e9e\" stroke-width=\"1\"",
    );
    write_label(text, &page, (piece, &spot, size));
    text.push_str("</g>\n");
}

/// A grain line just above the label.
fn grain_through(page: &Page<'_>, spot: &Spot) -> [Vec2; 2] {
    // The piece's grain lies at the turn from the warp; y is down on the page.
    let (sin, cos) = page.pose.turn.sin_cos();
    let along = Vec2::new(cos, -sin) * (spot.room * 750.0);
    let centre = page.flat(spot.at) - Vec2::new(0.0, spot.room * 200.0);
    [centre - along, centre + along]
}

/// A line with a head at its end.
fn arrow([tail, head]: [Vec2; 2], size: f64) -> String {
    let along = head - tail;
    let length = along.norm();
    if length == 0.0 {
        return String::new();
    }
    let along = along / length;
    let across = Vec2::new(-along.y, along.x);
    let barb = (size * 0.6).min(length * 0.3);
    let wings = [0.5, -0.5].map(|side| head - along * barb + across * (barb * side));
    let point = |p: Vec2| format!("{} {}", number(p.x), number(p.y));
    format!(
        "M{}L{}M{}L{}L{}",
        point(tail),
        point(head),
        point(wings[0]),
        point(head),
        point(wings[1])
    )
}

fn write_label(
    text: &mut String,
    page: &Page<'_>,
    (piece, spot, size): (&MarkerPiece, &Spot, f64),
) {
    let (size, upright) = size_on(spot, &piece.name, size * 1e-3);
    let (size, room, at) = (size * 1e3, spot.room * 1e3, page.flat(spot.at));
    let turn = if upright {
        format!(
            " transform=\"rotate(-90 {} {})\"",
            number(at.x),
            number(at.y)
        )
    } else {
        String::new()
    };
    let mut line = |offset: f64, size: f64, words: &str| {
        let _ = writeln!(
            text,
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"middle\" fill=\"#111111\" stroke=\"none\"{turn}>{}</text>",
            number(at.x),
            number(at.y + offset),
            number(size),
            escape(words)
        );
    };
    line(room * 0.05 + size, size, &piece.name);
    if piece.pose.mirrored {
        line(room * 0.05 + 1.9 * size, size * 0.7, "face down");
    }
}
