//! A marker's report on A4: picture, numbers, table of pieces.

use crate::marker_plot::{PlotLook, plot};
use crate::pdf::{Align, Ink, PdfPage, PdfSheets, PdfText, fitted, wrapped};
use crate::{FormatError, MarkerDrawing, MarkerPiece, Shown};
use toile_geometry::Vec2;

/// A4, upright (m).
const PAGE: [f64; 2] = [0.210, 0.297];
/// White border on every side (m).
const BORDER: f64 = 0.015;
/// Letter size of the text (m).
const LETTERS: f64 = 0.0035;
/// Distance from one line to the next (m).
const LINE: f64 = 0.0055;
const BLACK: Ink = [0.07, 0.07, 0.07];
const RED: Ink = [0.7, 0.0, 0.13];

/// Reports of markers on A4 pages, one marker after the other: a small picture, length, efficiency, yardage,
/// cost, a table of pieces, and the pieces left out with the reason.
///
/// # Errors
/// A coordinate is not finite.
pub fn write_marker_report(title: &str, markers: &[MarkerDrawing]) -> Result<Vec<u8>, FormatError> {
    let mut report = Report::new();
    for (k, marker) in markers.iter().enumerate() {
        marker.check_numbers()?;
        if k > 0 {
            report.turn_page();
        }
        report.marker(marker);
    }
    if markers.len() > 1 {
        report.turn_page();
        report.totals(title, markers);
    }
    Ok(report.finish(title))
}

/// A report being written.
struct Report {
    /// The pages that are full.
    sheets: PdfSheets,
    /// The page that is being filled.
    page: PdfPage,
    /// Height of the next line's baseline above the lower edge of the page (m).
    at: f64,
}

fn empty_page() -> PdfPage {
    PdfPage::new(Vec2::from(PAGE))
}

/// A column of a table: x position (m), and alignment of the text at that position.
type Column = (f64, Align);

impl Report {
    fn new() -> Self {
        Self {
            sheets: PdfSheets::default(),
            page: empty_page(),
            at: PAGE[1] - BORDER - LINE,
        }
    }

    fn turn_page(&mut self) {
        let full = std::mem::replace(&mut self.page, empty_page());
        self.sheets.push(full);
        self.at = PAGE[1] - BORDER - LINE;
    }

    fn finish(self, title: &str) -> Vec<u8> {
        let mut sheets = self.sheets;
        sheets.push(self.page);
        sheets.finish(title)
    }

    fn word(&mut self, text: &str, (x, align): Column, (size, ink): (f64, Ink)) {
        let room = match align {
            Align::Left => PAGE[0] - BORDER - x,
            Align::Middle | Align::Right => x - BORDER,
        };
        self.page.text(PdfText {
            text: &fitted(text, size, room),
            at: Vec2::new(x, self.at),
            size,
            angle: 0.0,
            align,
            ink,
        });
    }

    /// Moves to the next line, on a new page if this one is full.
    fn next_line(&mut self, height: f64) {
        self.at -= height;
        if self.at < BORDER {
            self.turn_page();
        }
    }

    fn heading(&mut self, text: &str) {
        self.word(text, (BORDER, Align::Left), (1.6 * LETTERS, BLACK));
        self.next_line(1.6 * LINE);
    }

    fn pair(&mut self, name: &str, value: &str) {
        self.word(name, (BORDER, Align::Left), (LETTERS, BLACK));
        self.word(value, (BORDER + 0.045, Align::Left), (LETTERS, BLACK));
        self.next_line(LINE);
    }

    fn row(&mut self, columns: &[Column], cells: &[String]) {
        for (column, cell) in columns.iter().zip(cells) {
            self.word(cell, *column, (LETTERS, BLACK));
        }
        self.next_line(LINE);
    }

    /// Small text, wrapped into as many lines as needed.
    fn small(&mut self, text: &str) {
        let size = 0.85 * LETTERS;
        for line in wrapped(text, size, PAGE[0] - 2.0 * BORDER) {
            self.word(&line, (BORDER, Align::Left), (size, BLACK));
            self.next_line(LINE);
        }
    }

    fn rule(&mut self) {
        let y = self.at + 0.7 * LINE;
        let ends = [Vec2::new(BORDER, y), Vec2::new(PAGE[0] - BORDER, y)];
        self.page.stroke(&ends, false, (0.0002, 0.0, BLACK));
    }

    fn marker(&mut self, marker: &MarkerDrawing) {
        self.heading(&marker.title);
        let room = Vec2::new(PAGE[0] - 2.0 * BORDER, 0.11);
        let fabric = Vec2::new(marker.length.max(1e-3), marker.strip.width);
        let scale = (room.x / fabric.x).min(room.y / fabric.y);
        let below = self.at + 0.5 * LINE - fabric.y * scale;
        let look = PlotLook {
            origin: Vec2::new(BORDER, below),
            scale,
            width: 0.0001,
            words: true,
        };
        plot(&mut self.page, marker, &look);
        self.at = below - 1.5 * LINE;
        self.numbers(marker, scale);
        self.pieces(marker);
        if !marker.unplaced.is_empty() {
            self.next_line(0.5 * LINE);
            self.word("Not on this marker", (BORDER, Align::Left), (LETTERS, RED));
            self.next_line(LINE);
            for [name, reason] in &marker.unplaced {
                self.small(&format!("{name}: {reason}"));
            }
        }
        for note in &marker.facts.notes {
            self.small(note);
        }
    }

    fn numbers(&mut self, marker: &MarkerDrawing, scale: f64) {
        let facts = &marker.facts;
        let shown = marker.shown();
        self.pair("Fabric", &facts.fabric);
        if let Some(roll) = &facts.roll {
            self.pair("Roll", roll);
        }
        self.pair("Spread", &marker.spread());
        self.pair("Width", &shown.length(marker.strip.width));
        self.pair("Length", &shown.length(marker.length));
        self.pair("Efficiency", &percent(marker.efficiency));
        self.pair("Utilisation", &percent(facts.utilisation));
        self.pair("Fabric needed", &bought(shown, marker.yardage()));
        if let Some(cost) = marker.cost() {
            let price = facts.price_per_metre.unwrap_or_default();
            let currency = &facts.currency;
            let text = format!("{cost:.2} {currency} at {price:.2} {currency} a metre");
            self.pair("Cost", &text);
        }
        self.pair("Picture", &format!("1 : {:.1}", 1.0 / scale));
        self.next_line(0.5 * LINE);
    }

    fn pieces(&mut self, marker: &MarkerDrawing) {
        let right = |x: f64| (PAGE[0] - BORDER - x, Align::Right);
        let columns = [
            (BORDER, Align::Left),
            right(0.085),
            right(0.055),
            right(0.03),
            right(0.0),
        ];
        let shown = marker.shown();
        let head = [
            "Piece".to_owned(),
            "on the marker".to_owned(),
            "face down".to_owned(),
            "length".to_owned(),
            format!("area, {}", shown.area_unit()),
        ];
        self.row(&columns, &head);
        self.rule();
        let mut seen: Vec<(usize, &str)> = Vec::new();
        for piece in &marker.pieces {
            let kind = (piece.item, piece.name.as_str());
            if seen.contains(&kind) {
                continue;
            }
            seen.push(kind);
            let is_it = |p: &&MarkerPiece| (p.item, p.name.as_str()) == kind;
            let same = || marker.pieces.iter().filter(is_it);
            let size = piece.pose.lay(&piece.piece.outer()).bounds().size();
            self.row(
                &columns,
                &[
                    piece.name.clone(),
                    same().count().to_string(),
                    same().filter(|p| p.pose.mirrored).count().to_string(),
                    shown.length(size.x),
                    shown.area_number(piece.piece.polygon().area()),
                ],
            );
        }
        self.rule();
    }

    /// Writes a table with the length of fabric, efficiency and cost of each marker, and the total length and
    /// cost.
    fn totals(&mut self, title: &str, markers: &[MarkerDrawing]) {
        self.heading(&format!("{title}: fabric needed"));
        let right = |x: f64| (PAGE[0] - BORDER - x, Align::Right);
        let columns = [(BORDER, Align::Left), right(0.085), right(0.03), right(0.0)];
        let head = ["Fabric", "length", "efficiency", "cost"];
        self.row(&columns, &head.map(str::to_owned));
        self.rule();
        let (mut length, mut cost, mut priced) = (0.0, 0.0, true);
        for marker in markers {
            let own = marker.cost();
            length += marker.yardage();
            cost += own.unwrap_or_default();
            priced &= own.is_some();
            let facts = &marker.facts;
            let name = match &facts.roll {
                Some(roll) => format!("{}, {roll}", facts.fabric),
                None => facts.fabric.clone(),
            };
            let own = own.map_or_else(String::new, |c| format!("{c:.2} {}", facts.currency));
            let cells = [
                name,
                bought(marker.shown(), marker.yardage()),
                percent(marker.efficiency),
                own,
            ];
            self.row(&columns, &cells);
        }
        self.rule();
        let currency = markers.first().map_or("", |m| &m.facts.currency);
        let cost = match priced {
            true => format!("{cost:.2} {currency}"),
            false => String::new(),
        };
        let shown = Shown(
            markers
                .first()
                .map_or_else(Default::default, |m| m.facts.unit),
        );
        let cells = ["all".to_owned(), bought(shown, length), String::new(), cost];
        self.row(&columns, &cells);
    }
}

fn percent(share: f64) -> String {
    format!("{:.1} %", share * 100.0)
}

/// A length of cloth in both trade units, metres and yards.
fn bought(shown: Shown, metres: f64) -> String {
    let [first, other] = shown.cloth(metres);
    format!("{first} ({other})")
}
