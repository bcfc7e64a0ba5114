//! Patterns as DXF (ANSI/AAMA-292, ASTM D6673): a block for each piece and size, in millimetres; and the grade
//! rules of their points.
//!
//! Nothing but pieces stands in blocks, as readers take every block for one. Lines have as many vertices in every
//! size, so that readers can take shifts of points from one to another; the block of the sample size numbers them.

use super::nest_piece::{NestPiece, SizedPiece, drills};
use super::rule_numbers::RuleNumbers;
use super::writer::DxfWriter;
use crate::drawn::drill::is_drill;
use crate::exchange::{SizedDraft, WriteSource};
use crate::{FormatError, Loss};
use std::collections::BTreeSet;
use toile_cut::{CutNotch, CutOptions, CutPiece, InsideLine};
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::{Cut, Draft, Name, NotchKind, Panel, Pattern, Piece, PieceId};

/// Longest name of a block (characters).
const MAX_NAME: usize = 31;
/// Width of a V notch at the cut line (m).
const V_WIDTH: f64 = 0.004;
/// Share of the length of a piece along its grain that the grain line takes.
const GRAIN_SHARE: f64 = 0.6;

/// The layers of both standards that are written, with their colours.
const LAYERS: &[(&str, u8)] = &[
    ("1", 7),
    ("2", 1),
    ("3", 3),
    ("4", 2),
    ("7", 5),
    ("8", 4),
    ("11", 6),
    ("13", 2),
    ("14", 3),
    ("80", 2),
    ("81", 2),
    ("82", 2),
    ("84", 7),
    ("87", 3),
];

/// A pattern in DXF, and what goes with it.
pub(crate) struct DxfWriting {
    /// The drawing.
    pub text: String,
    /// The grade rule table (RUL), if there are several sizes.
    pub rules: Option<String>,
    /// Contents that single pieces lost.
    pub losses: Vec<Loss>,
}

/// Writes the pieces of a pattern in its sizes, the base size first among the drafts. `is_astm` chooses the
/// standard.
///
/// # Errors
/// There is no draft, or a piece without a cut line: its name, and the reason.
pub(crate) fn write_dxf(
    source: &WriteSource<'_>,
    is_astm: bool,
) -> Result<DxfWriting, FormatError> {
    let base = source.drafts.first().ok_or_else(|| {
        FormatError::new("the pattern", "it has no draft", "mend its faults first")
    })?;
    let mut writer = PatternWriter {
        source,
        is_astm,
        dxf: DxfWriter::new(LAYERS.to_vec()),
        names: BTreeSet::new(),
        rules: RuleNumbers::new(source.drafts.len()),
        losses: Vec::new(),
    };
    writer.style(base);
    for piece in base.draft.pieces.iter().filter(|piece| piece.id.copy == 0) {
        writer.piece(piece.id)?;
    }
    let rules = (source.drafts.len() > 1).then(|| writer.table());
    Ok(DxfWriting {
        text: writer.dxf.finish(),
        rules,
        losses: writer.losses,
    })
}

struct PatternWriter<'a> {
    source: &'a WriteSource<'a>,
    is_astm: bool,
    dxf: DxfWriter,
    /// Names of blocks that are taken.
    names: BTreeSet<String>,
    rules: RuleNumbers,
    losses: Vec<Loss>,
}

impl PatternWriter<'_> {
    /// The texts that are about the whole style.
    fn style(&mut self, base: &SizedDraft) {
        let size = base.size.as_deref().unwrap_or("ONE");
        let mut texts = vec![
            format!("Style Name: {}", self.source.pattern.name),
            "Author: Toile".to_owned(),
            format!("Product: Toile {}", env!("CARGO_PKG_VERSION")),
            match self.is_astm {
                true => "Version: ASTM D6673-10".to_owned(),
                false => "Version: ANSI/AAMA-292".to_owned(),
            },
            format!("Sample Size: {size}"),
            "Units: METRIC".to_owned(),
        ];
        if self.source.drafts.len() > 1 {
            texts.push(format!("Grade Rule Table: {}", self.source.pattern.name));
        }
        for (k, text) in texts.iter().enumerate() {
            self.dxf.label("1", text, Vec2::new(0.0, -0.01 * k as f64));
        }
    }

    /// The grade rule table, its sizes in the order of the pattern.
    fn table(&self) -> String {
        let drafts = self.source.drafts;
        let sizes: Vec<&str> = drafts
            .iter()
            .map(|sized| sized.size.as_deref().unwrap_or("ONE"))
            .collect();
        let mut order: Vec<usize> = (0..sizes.len()).collect();
        let known = &self.source.pattern.sizes;
        order.sort_by_key(|&k| known.iter().position(|size| size.name == sizes[k]));
        self.rules
            .table(&self.source.pattern.name, &sizes, &order, self.is_astm)
    }

    fn piece(&mut self, id: PieceId) -> Result<(), FormatError> {
        let Some(panel) = self.source.pattern.panel(id.panel) else {
            return Ok(());
        };
        let mut sized = Vec::with_capacity(self.source.drafts.len());
        for draft in self.source.drafts {
            let own = self.in_size(id, draft)?;
            sized.extend(own);
        }
        let source = self.source;
        let drill_of = |line: &InsideLine| drill_of(source.pattern, line);
        let nest = NestPiece::new(&sized, self.is_astm, &drill_of);
        let has_rules = sized.len() > 1 && sized.len() == self.source.drafts.len();
        if has_rules && nest.unlike > 0 {
            self.losses.push(Loss {
                count: nest.unlike,
                ..Loss::at(
                    &panel.name,
                    "lines with grade rules",
                    "they are made of other parts in some sizes, whose blocks hold their shape",
                )
            });
        }
        for (k, own) in sized.iter().enumerate() {
            let size = own.size.unwrap_or("ONE");
            let name = self.block_name(&panel.name, own.size);
            self.dxf.begin_block(&name);
            self.texts(panel, (own.piece, own.draft), size, &own.cut);
            self.lines(&nest, k);
            if let Some(ends) = grain_line(&own.cut) {
                self.dxf.polyline("7", &ends, false);
            }
            for notch in &own.cut.notches {
                self.notch(notch);
            }
            for at in drills(&own.cut, &drill_of) {
                self.dxf.mark("13", at, &[(30, 0.0)]);
            }
            if k == 0 && has_rules {
                self.numbers(&nest);
            }
            self.dxf.end_block(&name);
        }
        Ok(())
    }

    /// A piece as it is cut in one size. `None`: the draft has no such piece.
    fn in_size<'d>(
        &self,
        id: PieceId,
        sized: &'d SizedDraft,
    ) -> Result<Option<SizedPiece<'d>>, FormatError> {
        let draft = &sized.draft;
        let Some(number) = draft.pieces.iter().position(|piece| piece.id == id) else {
            return Ok(None);
        };
        let piece = &draft.pieces[number];
        let of = (self.source.pattern, draft);
        let size = sized.size.as_deref();
        let cut = CutPiece::new(of, number, (size, &CutOptions::default()));
        let cut = cut.map_err(|error| {
            FormatError::new(
                format!("piece {}", piece.name),
                error.to_string(),
                "mend it first",
            )
        })?;
        Ok(Some(SizedPiece {
            size,
            draft,
            piece,
            cut,
        }))
    }

    /// A name of a block in plain letters, unique in the file.
    fn block_name(&mut self, panel: &str, size: Option<&str>) -> String {
        let plain = |text: &str| -> String {
            let sign = |c: char| match c.is_ascii_alphanumeric() {
                true => c.to_ascii_uppercase(),
                false => '_',
            };
            text.chars().map(sign).collect()
        };
        let size = size.map_or_else(String::new, |size| format!("_{}", plain(size)));
        let panel = plain(panel);
        (1..)
            .map(|k| {
                let end = match k {
                    1 => size.clone(),
                    k => format!("-{k}{size}"),
                };
                let room = MAX_NAME.saturating_sub(end.len());
                format!("{}{end}", &panel[..panel.len().min(room)])
            })
            .find(|name| self.names.insert(name.clone()))
            .unwrap_or_default()
    }

    fn texts(
        &mut self,
        panel: &Panel,
        (piece, draft): (&Piece, &Draft),
        size: &str,
        cut: &CutPiece,
    ) {
        let Cut { quantity, mirrored } = panel.cut;
        let quantity = match mirrored {
            true => format!("{},{}", quantity.div_ceil(2), quantity / 2),
            false if self.is_astm => format!("{quantity},0"),
            false => quantity.to_string(),
        };
        let size_key = if self.is_astm { "Size Name" } else { "Size" };
        let fabric = draft.fabrics.get(piece.fabric);
        let texts = [
            format!("Piece Name: {}", panel.name),
            format!("{size_key}: {size}"),
            format!("Quantity: {quantity}"),
            format!("Material: {}", fabric.map_or("", |fabric| &fabric.name)),
        ];
        let middle = cut.bounds().centre();
        for (k, text) in texts.iter().enumerate() {
            let at = middle - Vec2::new(0.0, 0.01 * k as f64);
            self.dxf.label("1", text, at);
        }
    }

    /// The lines of a piece in the size of a number, with their corners and curve points.
    fn lines(&mut self, nest: &NestPiece, size: usize) {
        for line in &nest.lines {
            self.dxf
                .polyline(line.layer, &line.by_size[size], line.is_closed);
            let corners = line.is_corner.get(size).map_or(&[][..], Vec::as_slice);
            for (&at, &is_corner) in line.by_size[size].iter().zip(corners) {
                let layer = if is_corner { "2" } else { "3" };
                self.dxf.mark(layer, at, &[]);
            }
        }
    }

    /// The numbers of the grade rules of all points, at their places in the sample size.
    fn numbers(&mut self, nest: &NestPiece) {
        for (layer, by_size) in nest.ruled() {
            let [base, ..] = &by_size[..] else {
                continue;
            };
            for (k, &at) in base.iter().enumerate() {
                let places: Vec<Vec2> = by_size.iter().map(|own| own[k]).collect();
                let number = self.rules.of(&places);
                self.dxf.label(layer, &format!("# {number}"), at);
            }
        }
    }

    fn notch(&mut self, notch: &CutNotch) {
        let (layer, width) = match notch.kind {
            NotchKind::Slit => ("4", 0.0),
            NotchKind::V => ("4", V_WIDTH),
            NotchKind::T => ("80", V_WIDTH),
            NotchKind::Castle => ("81", V_WIDTH),
            NotchKind::Check => ("82", V_WIDTH),
        };
        let angle = notch
            .inward
            .y
            .atan2(notch.inward.x)
            .to_degrees()
            .rem_euclid(360.0);
        let values = [(30, notch.depth * 1e3), (39, width * 1e3), (50, angle)];
        self.dxf.mark(layer, notch.on_cut, &values);
    }
}

/// The drill hole that a line inside marks.
fn drill_of(pattern: &Pattern, line: &InsideLine) -> Option<Vec2> {
    let Name::Drawn(id) = line.name else {
        return None;
    };
    let ends = [*line.points.first()?, *line.points.last()?];
    let mut lines = pattern.panels.iter().flat_map(|panel| &panel.lines);
    let drawn = lines.find(|drawn| drawn.id == id)?;
    is_drill(&drawn.name, (ends[1] - ends[0]).norm()).then(|| 0.5 * (ends[0] + ends[1]))
}

/// A line along the grain inside a piece: on the longest stretch of cloth through the middle of its bounds.
fn grain_line(cut: &CutPiece) -> Option<[Vec2; 2]> {
    let along = Vec2::new(cut.grain.cos(), cut.grain.sin());
    let middle = Bounds2::of(cut.cut.first()?.points.iter().copied()).centre();
    let mut crossings: Vec<f64> = Vec::new();
    for ring in &cut.cut {
        let next = ring.points.iter().cycle().skip(1);
        for (a, b) in ring.points.iter().zip(next) {
            let [of_a, of_b] = [a, b].map(|p| along.perp(&(p - middle)));
            if (of_a > 0.0) != (of_b > 0.0) {
                let p = a + (b - a) * (of_a / (of_a - of_b));
                crossings.push((p - middle).dot(&along));
            }
        }
    }
    crossings.sort_by(f64::total_cmp);
    let stretches = crossings.chunks_exact(2);
    let longest = stretches.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
    let centre = 0.5 * (longest[0] + longest[1]);
    let half = 0.5 * GRAIN_SHARE * (longest[1] - longest[0]);
    Some([centre - half, centre + half].map(|place| middle + along * place))
}
