//! Patterns as SVG: millimetres at true size, a layer of Inkscape for each panel, with a layer for each kind of
//! line in it, and the whole document in the metadata.

use super::kinds::{KIND, LineKind, NAMESPACE, NOTCH, PANEL};
use super::panel_lines::{PanelPath, at, paths};
use crate::exchange::WriteSource;
use crate::svg_text::{self, escape, number};
use crate::{FormatError, write_document};
use std::fmt::Write as _;
use toile_cut::{CutOptions, CutPiece, TextKind, Words};
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::fields::Choice;
use toile_pattern::{Draft, Panel, Pattern};

/// Name of a sublayer, and whether lines of a kind are in it.
type Sublayer = (&'static str, fn(LineKind) -> bool);

/// White border round the drawing (m).
const BORDER: f64 = 0.02;
/// Room between pieces that are laid side by side (m).
const ROOM: f64 = 0.03;
/// Width of a row of pieces (m).
const ROW: f64 = 2.5;
/// Width of lines (mm).
const STROKE: f64 = 0.3;
/// The layers of a panel: their words, and the kinds of lines in them.
const LAYERS: [Sublayer; 5] = [
    ("cut", |kind| matches!(kind, LineKind::Cut | LineKind::Hole)),
    ("sew", |kind| matches!(kind, LineKind::Sew)),
    ("internal", |kind| matches!(kind, LineKind::Internal)),
    ("notches", |kind| matches!(kind, LineKind::Notch(_))),
    ("grain", |kind| matches!(kind, LineKind::Grain)),
];

/// A panel as it is written.
struct Drawn {
    name: String,
    cut: CutPiece,
    bounds: Bounds2,
    piece: usize,
    place: Vec2,
}

/// Writes a pattern in the size of its first draft.
///
/// # Errors
/// There is no draft, a piece has no cut line, or a number is not finite.
pub(crate) fn write_svg(source: &WriteSource<'_>) -> Result<String, FormatError> {
    let sized = source.drafts.first().ok_or_else(|| {
        FormatError::new("the pattern", "it has no draft", "mend its faults first")
    })?;
    let (pattern, draft) = (source.pattern, &sized.draft);
    let size = sized.size.as_deref();
    let panels = drawn(pattern, draft, size)?;
    let mut layers = String::new();
    let mut record = String::new();
    for (number, panel) in panels.iter().enumerate() {
        let lines: Vec<&str> = [
            TextKind::Name,
            TextKind::Size,
            TextKind::Count,
            TextKind::Fabric,
        ]
        .into_iter()
        .filter_map(|kind| panel.cut.text(kind))
        .collect();
        let drawing = panel.cut.drawing(|p| p, &lines);
        let piece = &draft.pieces[panel.piece];
        let paths = paths(piece, &panel.cut, &drawing, panel.place);
        layer(&mut layers, (number + 1, panel), &paths, &drawing.words);
        let _ = writeln!(record, "<toile:panel name=\"{}\">", escape(&panel.name));
        for path in &paths {
            let word = path.kind.word();
            let _ = writeln!(
                record,
                "<toile:path kind=\"{word}\" d=\"{}\"/>",
                path.description
            );
        }
        record += "</toile:panel>\n";
    }
    let all = panels
        .iter()
        .map(|panel| panel.bounds.translated(panel.place));
    let all = all.reduce(|a, b| a.union(&b));
    let page = all.unwrap_or(Bounds2::of([Vec2::zeros()])).grown(BORDER);
    let document = write_document(pattern, source.fitting)?;
    Ok(page_of(&pattern.name, page) + &metadata(size, &record, &document) + &layers + "</svg>\n")
}

/// The panels that are cut, each where it lies on the table; side by side in rows if they overlap there.
fn drawn(pattern: &Pattern, draft: &Draft, size: Option<&str>) -> Result<Vec<Drawn>, FormatError> {
    let mut all = Vec::new();
    for (number, piece) in draft.pieces.iter().enumerate() {
        let Some(panel) = pattern.panel(piece.id.panel).filter(|_| piece.id.copy == 0) else {
            continue;
        };
        let cut = CutPiece::new((pattern, draft), number, (size, &CutOptions::default()));
        let cut = cut.map_err(|error| {
            FormatError::new(
                format!("piece {}", piece.name),
                error.to_string(),
                "mend it first",
            )
        })?;
        if !cut.is_finite() {
            let what = "a coordinate is not finite";
            let place = format!("piece {}", piece.name);
            return Err(FormatError::new(place, what, "mend the pattern first"));
        }
        all.push(Drawn {
            name: panel.name.clone(),
            bounds: cut.bounds(),
            cut,
            piece: number,
            place: on_table(pattern, panel),
        });
    }
    let lies = |panel: &Drawn| panel.bounds.translated(panel.place);
    let overlaps = |k: usize| {
        let own = lies(&all[k]);
        all[..k].iter().any(|before| lies(before).overlaps(&own))
    };
    if (0..all.len()).any(overlaps) {
        let (mut x, mut y, mut height) = (0.0_f64, 0.0_f64, 0.0_f64);
        for panel in &mut all {
            let size = panel.bounds.size();
            if x > 0.0 && x + size.x > ROW {
                (x, y, height) = (0.0, y - height - ROOM, 0.0);
            }
            panel.place = Vec2::new(x, y - size.y) - panel.bounds.min;
            x += size.x + ROOM;
            height = height.max(size.y);
        }
    }
    Ok(all)
}

/// The way from a panel's place on its sheet to its place on the table (m).
fn on_table(pattern: &Pattern, panel: &Panel) -> Vec2 {
    let own = panel.on_table.map_or(Vec2::zeros(), Vec2::from);
    let sheet = pattern.sheet_of(panel).and_then(|id| pattern.sheet(id));
    own + sheet.map_or(Vec2::zeros(), |sheet| sheet.on_table.into())
}

/// The beginning of a file: the size of its page.
fn page_of(name: &str, page: Bounds2) -> String {
    let [low, size] = [page.min, page.size()].map(|v| v * 1e3);
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" xmlns:sodipodi=\"http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd\" xmlns:toile=\"{NAMESPACE}\" version=\"1.1\" width=\"{0}mm\" height=\"{1}mm\" viewBox=\"{2} {3} {0} {1}\" font-family=\"Helvetica, Arial, sans-serif\">",
        number(size.x),
        number(size.y),
        number(low.x),
        number(-low.y - size.y),
    );
    let _ = writeln!(text, "<title>{}</title>", escape(name));
    text + "<sodipodi:namedview id=\"view\" inkscape:document-units=\"mm\"/>\n"
}

/// The document and the paths as they are written, by which edited panels are told.
fn metadata(size: Option<&str>, record: &str, document: &str) -> String {
    let size = size.map_or_else(String::new, |size| format!(" size=\"{}\"", escape(size)));
    let document = document
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;");
    format!(
        "<metadata id=\"toile\">\n<toile:pattern version=\"1\"{size}>\n{record}<toile:document>{document}</toile:document>\n</toile:pattern>\n</metadata>\n"
    )
}

/// Writes the layer of a panel.
fn layer(
    text: &mut String,
    (number, panel): (usize, &Drawn),
    paths: &[PanelPath],
    words: &[Words],
) {
    let name = escape(&panel.name);
    let _ = writeln!(
        text,
        "<g id=\"panel-{number}\" inkscape:groupmode=\"layer\" inkscape:label=\"{name}\" {PANEL}=\"{name}\" fill=\"none\" stroke-width=\"{STROKE}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">"
    );
    for (word, holds) in LAYERS {
        let own: Vec<&PanelPath> = paths.iter().filter(|path| holds(path.kind)).collect();
        if own.is_empty() {
            continue;
        }
        begin(text, number, word);
        for (k, path) in own.iter().enumerate() {
            let notch = match path.kind {
                LineKind::Notch(shape) => format!(" {NOTCH}=\"{}\"", shape.word()),
                LineKind::Cut
                | LineKind::Sew
                | LineKind::Hole
                | LineKind::Internal
                | LineKind::Grain => String::new(),
            };
            let _ = writeln!(
                text,
                "<path id=\"panel-{number}-{word}-{}\" {KIND}=\"{}\"{notch} stroke=\"{}\" d=\"{}\"/>",
                k + 1,
                path.kind.word(),
                path.kind.colour(),
                path.description
            );
        }
        text.push_str("</g>\n");
    }
    if !words.is_empty() {
        begin(text, number, "text");
        for words in words {
            let place = at(words.at, panel.place);
            let (x, y) = place.split_once(' ').unwrap_or((&place, "0"));
            let turned = svg_text::number(-words.angle.to_degrees());
            let turn = match turned == "0" {
                true => String::new(),
                false => format!(" transform=\"rotate({turned} {x} {y})\""),
            };
            let _ = writeln!(
                text,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"middle\" fill=\"#000000\" stroke=\"none\"{turn}>{}</text>",
                svg_text::number(words.size * 1e3),
                escape(&words.text)
            );
        }
        text.push_str("</g>\n");
    }
    text.push_str("</g>\n");
}

fn begin(text: &mut String, number: usize, word: &str) {
    let _ = writeln!(
        text,
        "<g id=\"panel-{number}-{word}\" inkscape:groupmode=\"layer\" inkscape:label=\"{word}\">"
    );
}
