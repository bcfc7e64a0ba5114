//! A marker as SVG: millimetres, at true size, y down.
//!
//! The fabric lies along x from the origin of the drawing, the upper selvedge at y = 0. Numbers
//! have a fixed count of decimals, so that the same marker gives the same bytes.

use crate::FormatError;
use std::fmt::Write as _;
use toile_geometry::{Polygon, Vec2, point_segment_distance};
use toile_nesting::{Nap, Pose, Strip};

/// White round the fabric \[mm\].
const BORDER: f64 = 20.0;
/// Height of the text above the fabric \[mm\].
const HEADER: f64 = 90.0;
/// Pale fills, one after another by item.
const FILLS: [&str; 8] = [
    "#f6d9c8", "#cfe3f2", "#d9ecd0", "#f5e6b8", "#e3d6ee", "#f3d0d8", "#cdeae6", "#e6e0d4",
];

/// Everything that is drawn on a marker. All points of a piece are in its own plane \[m\].
#[derive(Clone, Debug, PartialEq)]
pub struct MarkerDrawing {
    /// Name of the marker.
    pub title: String,
    /// The fabric.
    pub strip: Strip,
    /// Fabric used, end margins included \[m\].
    pub length: f64,
    /// Area of the pieces over width times length between the end margins, 0..=1.
    pub efficiency: f64,
    /// The pieces laid.
    pub pieces: Vec<MarkerPiece>,
    /// Names of the copies that found no place.
    pub unplaced: Vec<String>,
}

/// One piece on a marker.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkerPiece {
    /// Name to write on it.
    pub name: String,
    /// Number that pieces of one kind share: they are filled with one colour.
    pub item: usize,
    /// Line to cut along \[m\].
    pub cut: Polygon,
    /// Line to sew along \[m\]; without rings where it is not known.
    pub sew: Polygon,
    /// Grain line, from its tail to its head \[m\]; nothing draws one through the middle.
    pub grain: Option<[Vec2; 2]>,
    /// Notches, each a short stroke \[m\].
    pub notches: Vec<[Vec2; 2]>,
    /// Other lines drawn on the piece \[m\].
    pub lines: Vec<Vec<Vec2>>,
    /// Marker from piece.
    pub pose: Pose,
}

/// The SVG text of a marker.
///
/// # Errors
/// A coordinate is not finite.
pub fn write_marker_svg(drawing: &MarkerDrawing) -> Result<String, FormatError> {
    check_numbers(drawing)?;
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
    let summary = summary(drawing);
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
    text.push_str("</g>\n</svg>\n");
    Ok(text)
}

fn check_numbers(drawing: &MarkerDrawing) -> Result<(), FormatError> {
    let refuse = |place: String| {
        let hint = "check the piece's outline and make the marker again";
        Err(FormatError::new(place, "a number is not finite", hint))
    };
    let Strip {
        width,
        selvedge,
        end_margin,
        ..
    } = drawing.strip;
    let sizes = [
        width,
        selvedge,
        end_margin,
        drawing.length,
        drawing.efficiency,
    ];
    if !sizes.iter().all(|x| x.is_finite()) {
        return refuse("marker".into());
    }
    for piece in &drawing.pieces {
        let [x, y] = piece.pose.axes();
        let rings = piece
            .cut
            .rings()
            .chain(piece.sew.rings())
            .chain(&piece.lines);
        let mut points = rings
            .flatten()
            .chain(piece.grain.iter().flatten())
            .chain(piece.notches.iter().flatten())
            .chain([&x, &y, &piece.pose.translation]);
        if !points.all(|p| p.x.is_finite() && p.y.is_finite()) {
            return refuse(format!("piece \"{}\"", piece.name));
        }
    }
    Ok(())
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

fn plural(count: usize) -> String {
    format!("{count} piece{}", if count == 1 { "" } else { "s" })
}

/// The marker in words: length and efficiency, then the fabric, then what is missing.
fn summary(drawing: &MarkerDrawing) -> Vec<String> {
    let strip = &drawing.strip;
    let mut lines = vec![format!(
        "{} on {:.3} m of fabric {:.3} m wide, efficiency {:.1} %",
        plural(drawing.pieces.len()),
        drawing.length,
        strip.width,
        drawing.efficiency * 100.0
    )];
    let nap = match strip.nap {
        Nap::None => "no nap: pieces may point either way",
        Nap::OneWay => "nap: all pieces point one way",
        Nap::PerBundle => "nap: the pieces of a garment point one way",
    };
    lines.push(format!(
        "Warp runs along the length; selvedge {:.0} mm, end margin {:.0} mm, gap {:.0} mm; {nap}.",
        strip.selvedge * 1e3,
        strip.end_margin * 1e3,
        strip.gap * 1e3
    ));
    if !drawing.unplaced.is_empty() {
        lines.push(format!(
            "Not on this marker: {}.",
            drawing.unplaced.join(", ")
        ));
    }
    lines
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
        let colour = if k == 2 { "#b00020" } else { "#222222" };
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
    let (edge, margin) = (drawing.strip.selvedge * 1e3, drawing.strip.end_margin * 1e3);
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
    rectangle("selvedge", [0.0, 0.0, length, edge], shade);
    rectangle("selvedge", [0.0, width - edge, length, edge], shade);
    let shade = "fill=\"#ebe6dc\" stroke=\"none\"";
    let inner = width - 2.0 * edge;
    rectangle("end-margin", [0.0, edge, margin, inner], shade);
    rectangle("end-margin", [length - margin, edge, margin, inner], shade);
    let line = "fill=\"none\" stroke=\"#555555\" stroke-width=\"1\"";
    rectangle("fabric-edge", [0.0, 0.0, length, width], line);
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

/// From a piece's plane to the page.
struct Page<'a> {
    pose: &'a Pose,
    width: f64,
}

impl Page<'_> {
    fn at(&self, point: Vec2) -> Vec2 {
        let laid = self.pose.apply(point);
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
    let laid = piece.cut.mapped(|p| page.at(p));
    let spot = roomiest_spot(&laid);
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
    let size = (spot.room * 0.3).clamp(4.0, 22.0);
    let grain = piece.grain.map_or_else(
        || grain_through(&piece.pose, &spot),
        |ends| ends.map(|p| page.at(p)),
    );
    stroke(
        "grain",
        &arrow(grain, size),
        "stroke=\"#1f4e9e\" stroke-width=\"1\"",
    );
    write_label(text, piece, &spot, size);
    text.push_str("</g>\n");
}

/// A grain line just above the label.
fn grain_through(pose: &Pose, spot: &Spot) -> [Vec2; 2] {
    // The piece's grain lies at the turn from the warp; y is down on the page.
    let (sin, cos) = pose.turn.sin_cos();
    let along = Vec2::new(cos, -sin) * (spot.room * 0.75);
    let centre = spot.at - Vec2::new(0.0, spot.room * 0.2);
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

/// Where the words of a piece go \[mm\].
struct Spot {
    at: Vec2,
    /// Distance to the outline.
    room: f64,
    /// Free length through the point along the page's x and y.
    runs: [f64; 2],
}

fn write_label(text: &mut String, piece: &MarkerPiece, spot: &Spot, size: f64) {
    // A letter is about 0.55 of its height wide.
    let letters = piece.name.chars().count().max(1) as f64;
    let fitted = |run: f64| size.min(0.85 * run / (0.55 * letters)).max(3.0);
    let upright = fitted(spot.runs[0]) < 0.6 * size && spot.runs[1] > 1.5 * spot.runs[0];
    let size = fitted(spot.runs[usize::from(upright)]);
    let turn = if upright {
        format!(
            " transform=\"rotate(-90 {} {})\"",
            number(spot.at.x),
            number(spot.at.y)
        )
    } else {
        String::new()
    };
    let mut line = |offset: f64, size: f64, words: &str| {
        let _ = writeln!(
            text,
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"middle\" fill=\"#111111\" stroke=\"none\"{turn}>{}</text>",
            number(spot.at.x),
            number(spot.at.y + offset),
            number(size),
            escape(words)
        );
    };
    line(spot.room * 0.05 + size, size, &piece.name);
    if piece.pose.mirrored {
        line(spot.room * 0.05 + 1.9 * size, size * 0.7, "face down");
    }
}

/// The point of a grid that lies far inside and near the middle.
fn roomiest_spot(polygon: &Polygon) -> Spot {
    const CELLS: u32 = 24;
    let bounds = polygon.bounds();
    let centre = bounds.centre();
    let mut best = (0.0, centre, 0.0);
    for k in 0..CELLS * CELLS {
        let cell = Vec2::new(f64::from(k % CELLS) + 0.5, f64::from(k / CELLS) + 0.5);
        let point = bounds.min + bounds.size().component_mul(&cell) / f64::from(CELLS);
        if !polygon.contains(point) {
            continue;
        }
        let room = polygon
            .edges()
            .map(|edge| point_segment_distance(point, edge))
            .fold(f64::INFINITY, f64::min);
        let score = room / (1.0 + (point - centre).norm() / bounds.size().norm());
        if score > best.0 {
            best = (score, point, room);
        }
    }
    let (_, at, room) = best;
    Spot {
        at,
        room,
        runs: [0, 1].map(|axis| free_run(polygon, at, axis)),
    }
}

/// Twice the way from a point to the nearer side of the outline along an axis.
fn free_run(polygon: &Polygon, at: Vec2, axis: usize) -> f64 {
    let other = 1 - axis;
    let crossed = |[a, b]: [Vec2; 2]| {
        let spans = (a[other] <= at[other]) != (b[other] <= at[other]);
        let share = (at[other] - a[other]) / (b[other] - a[other]);
        spans.then(|| (a[axis] + (b[axis] - a[axis]) * share - at[axis]).abs())
    };
    2.0 * polygon
        .edges()
        .filter_map(crossed)
        .fold(f64::INFINITY, f64::min)
}
