//! A marker as SVG: millimetres, at true size, y down.
//!
//! The fabric lies along x from the origin of the drawing, with the upper selvedge at y = 0. Numbers have a
//! fixed count of decimals, so that the same marker gives the same bytes. The groups are layers for Inkscape,
//! which recognises them by its own attributes.

use crate::marker_label::lines_within;
use crate::marker_strokes::{Layer, Stroke, Strokes, fill_of};
use crate::svg_text::{escape, number};
use crate::{FormatError, MarkerDrawing, MarkerPiece};
use std::fmt::Write as _;
use toile_cut::Words;
use toile_geometry::Vec2;
use toile_nesting::Fold;

/// White border round the fabric (mm).
const BORDER: f64 = 20.0;
/// Smallest width of the heading with the scale bar (mm).
const SHORTEST: f64 = 400.0;
/// Letter size of the title, and distance from one line of the title to the next (mm).
const TITLE: f64 = 22.0;
/// Letter size of the lines below the title (mm).
const LETTERS: f64 = 14.0;
/// Line spacing below the title (mm).
const LINE: f64 = 18.0;
/// Distance from the last line of the heading to the fabric, with the scale bar between them (mm).
const BELOW: f64 = 36.0;
const BLACK: &str = "#222222";
const RED: &str = "#b00020";

/// The SVG text of a marker.
///
/// # Errors
/// A coordinate is not finite.
pub fn write_marker_svg(drawing: &MarkerDrawing) -> Result<String, FormatError> {
    drawing.check_numbers()?;
    let (length, width) = (drawing.length * 1e3, drawing.strip.width * 1e3);
    let right = length.max(SHORTEST);
    let summary = drawing.summary();
    let heading = Heading::new(&drawing.title, &summary, right);
    let sheet = (right + 2.0 * BORDER, width + heading.height + 2.0 * BORDER);
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" version=\"1.1\" width=\"{0}mm\" height=\"{1}mm\" viewBox=\"{2} {3} {0} {1}\" font-family=\"Helvetica, Arial, sans-serif\">",
        number(sheet.0),
        number(sheet.1),
        number(-BORDER),
        number(-heading.height - BORDER),
    );
    let _ = writeln!(
        text,
        "<title>{}: {}</title>",
        escape(&drawing.title),
        summary[0]
    );
    let _ = writeln!(text, "<desc>{}</desc>", escape(&summary.join(" ")));
    let bar = match drawing.shown().is_inch() {
        true => (101.6, "4 in"),
        false => (100.0, "100 mm"),
    };
    heading.write(&mut text, right, bar);
    let mut inside = String::new();
    fabric(&mut inside, drawing);
    layer(&mut text, ("fabric", "Fabric", ""), &inside);
    inside.clear();
    print_and_flaws(&mut inside, drawing);
    layer(
        &mut text,
        ("print-and-flaws", "Print and flaws", ""),
        &inside,
    );
    inside.clear();
    for piece in &drawing.pieces {
        write_piece(&mut inside, piece, drawing.strip.width);
    }
    let style = " stroke-linejoin=\"round\" stroke-linecap=\"round\"";
    layer(&mut text, ("pieces", "Pieces", style), &inside);
    inside.clear();
    overlaps(&mut inside, drawing);
    layer(&mut text, ("overlaps", "Overlaps", ""), &inside);
    text.push_str("</svg>\n");
    Ok(text)
}

/// A group that is a layer in Inkscape, given by its id, displayed name and style; nothing is written for an
/// empty layer.
fn layer(text: &mut String, (id, label, style): (&str, &str, &str), inside: &str) {
    if !inside.is_empty() {
        let _ = writeln!(
            text,
            "<g id=\"{id}\" inkscape:groupmode=\"layer\" inkscape:label=\"{label}\"{style}>\n{inside}</g>"
        );
    }
}

/// The heading above the fabric.
struct Heading {
    /// Lines with letter height (mm) and colour.
    lines: Vec<(f64, &'static str, String)>,
    /// Height of the heading above the fabric (mm).
    height: f64,
}

impl Heading {
    /// A title and a summary, wrapped to lines of limited length (mm).
    fn new(title: &str, summary: &[String], length: f64) -> Self {
        let title = lines_within(title, TITLE, length);
        let mut lines: Vec<_> = title.into_iter().map(|line| (TITLE, BLACK, line)).collect();
        for (k, words) in summary.iter().enumerate() {
            let colour = if k >= 2 { RED } else { BLACK };
            let wrapped = lines_within(words, LETTERS, length);
            lines.extend(wrapped.into_iter().map(|line| (LETTERS, colour, line)));
        }
        let first = lines.first().map_or(0.0, |_| 14.0);
        let steps: f64 = lines.windows(2).map(step).sum();
        Self {
            height: first + steps + BELOW,
            lines,
        }
    }

    /// Writes the lines and a scale bar with its caption, to check the scale of a print. The bar has a known
    /// length (mm) and ends at `right` (mm).
    fn write(&self, text: &mut String, right: f64, (bar, words): (f64, &str)) {
        let mut inside = String::new();
        let mut y = -self.height + 14.0;
        for (k, (size, colour, words)) in self.lines.iter().enumerate() {
            if k > 0 {
                y += step(&self.lines[k - 1..=k]);
            }
            let _ = writeln!(
                inside,
                "<text x=\"0\" y=\"{}\" font-size=\"{}\" fill=\"{colour}\">{}</text>",
                number(y),
                number(*size),
                escape(words)
            );
        }
        let _ = writeln!(
            inside,
            "<g id=\"scale\"><path d=\"M{0} -8v-6M{0} -11H{1}M{1} -8v-6\" fill=\"none\" stroke=\"{BLACK}\" stroke-width=\"1\"/><text x=\"{2}\" y=\"-18\" font-size=\"12\" text-anchor=\"middle\" fill=\"{BLACK}\">{words}</text></g>",
            number(right - bar),
            number(right),
            number(right - 0.5 * bar)
        );
        let style = format!(" fill=\"{BLACK}\" stroke=\"none\"");
        layer(text, ("heading", "Heading", &style), &inside);
    }
}

/// Distance from one line of a heading to the next (mm); `pair` holds these two lines.
fn step(pair: &[(f64, &'static str, String)]) -> f64 {
    match pair {
        [(size, ..), _] if *size == TITLE => TITLE,
        _ => LINE,
    }
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
}

/// Draws the lines of the print and the flaws of the fabric.
fn print_and_flaws(text: &mut String, drawing: &MarkerDrawing) {
    let page = Page(drawing.strip.width);
    let own = Strokes::of_fabric(drawing);
    let print = "fill=\"none\" stroke=\"#9db8d9\" stroke-width=\"1\"";
    draw(text, "print", &page.lines(own.on(Layer::Print)), print);
    for flaw in own.on(Layer::Flaw) {
        let d = page.path(&flaw.points, flaw.closed);
        draw(text, "flaw", &d, "fill=\"#d9485f\" stroke=\"none\"");
    }
}

/// Writes a path with a class, unless it is empty.
fn draw(text: &mut String, class: &str, d: &str, style: &str) {
    if !d.is_empty() {
        let _ = writeln!(text, "<path class=\"{class}\" d=\"{d}\" {style}/>");
    }
}

/// Fills the regions where pieces overlap.
fn overlaps(text: &mut String, drawing: &MarkerDrawing) {
    let page = Page(drawing.strip.width);
    let style = "fill=\"#e60000\" fill-opacity=\"0.8\" fill-rule=\"evenodd\" stroke=\"#e60000\" stroke-width=\"2\"";
    for polygon in &drawing.overlaps {
        let d: String = polygon.rings().map(|ring| page.path(ring, true)).collect();
        draw(text, "overlap", &d, style);
    }
}

/// Transform from points of the fabric (m) to the page (mm), on which y points down; holds the fabric's width
/// (m).
struct Page(f64);

impl Page {
    fn at(&self, laid: Vec2) -> [String; 2] {
        [number(laid.x * 1e3), number((self.0 - laid.y) * 1e3)]
    }

    fn path(&self, points: &[Vec2], closed: bool) -> String {
        let mut path = String::new();
        for (k, &p) in points.iter().enumerate() {
            let [x, y] = self.at(p);
            let command = if k == 0 { 'M' } else { 'L' };
            let _ = write!(path, "{command}{x} {y}");
        }
        if closed {
            path.push('Z');
        }
        path
    }

    fn lines<'a>(&self, strokes: impl Iterator<Item = &'a Stroke>) -> String {
        strokes.map(|s| self.path(&s.points, s.closed)).collect()
    }
}

fn write_piece(text: &mut String, piece: &MarkerPiece, width: f64) {
    let page = Page(width);
    let own = Strokes::of_piece(piece);
    let name = escape(&piece.name);
    let _ = writeln!(
        text,
        "<g class=\"piece\" inkscape:label=\"{name}\" data-name=\"{name}\" data-turn=\"{}\" data-face-down=\"{}\">",
        number(piece.pose.turn.to_degrees()),
        piece.pose.mirrored
    );
    let _ = writeln!(text, "<title>{name}</title>");
    let [red, green, blue] = fill_of(piece.item);
    let cut = format!(
        "fill=\"#{red:02x}{green:02x}{blue:02x}\" fill-rule=\"evenodd\" stroke=\"#111111\" stroke-width=\"0.8\""
    );
    let looks = [
        (Layer::Cut, cut.as_str()),
        (
            Layer::Sew,
            "fill=\"none\" stroke=\"#666666\" stroke-width=\"0.5\" stroke-dasharray=\"4 2\"",
        ),
        (
            Layer::Line,
            "fill=\"none\" stroke=\"#888888\" stroke-width=\"0.5\"",
        ),
        (
            Layer::Notch,
            "fill=\"none\" stroke=\"#111111\" stroke-width=\"0.8\"",
        ),
        (
            Layer::Grain,
            "fill=\"none\" stroke=\"#1f4e9e\" stroke-width=\"1\"",
        ),
        (
            Layer::Fold,
            "fill=\"none\" stroke=\"#8c338c\" stroke-width=\"1\" stroke-dasharray=\"20 5 4 5\"",
        ),
        (
            Layer::Drill,
            "fill=\"none\" stroke=\"#666666\" stroke-width=\"0.5\"",
        ),
    ];
    for (layer, style) in looks {
        draw(text, layer.class(), &page.lines(own.on(layer)), style);
    }
    for words in &own.words {
        write_words(text, &page, words);
    }
    text.push_str("</g>\n");
}

fn write_words(text: &mut String, page: &Page, words: &Words) {
    let [x, y] = page.at(words.at);
    let turned = number(-words.angle.to_degrees());
    let turn = match turned == "0" {
        true => String::new(),
        false => format!(" transform=\"rotate({turned} {x} {y})\""),
    };
    let _ = writeln!(
        text,
        "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"middle\" fill=\"#111111\" stroke=\"none\"{turn}>{}</text>",
        number(words.size * 1e3),
        escape(&words.text)
    );
}
