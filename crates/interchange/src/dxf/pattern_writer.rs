//! Patterns as DXF (ANSI/AAMA-292, ASTM D6673): a block for each piece and size, in millimetres.
//!
//! Nothing but pieces stands in blocks, as readers take every block for one. Sew lines have as many vertices in
//! every size, so that readers can take shifts of points from one to another.

use super::writer::DxfWriter;
use crate::drawn::drill::is_drill;
use crate::exchange::{SizedDraft, WriteSource};
use crate::{FormatError, Loss};
use std::collections::BTreeSet;
use toile_cut::{CutNotch, CutOptions, CutPiece, InsideLine, PieceRing, PieceSegment};
use toile_geometry::{Bounds2, Curve, Vec2};
use toile_pattern::{Cut, Draft, Name, NotchKind, Panel, Piece, PieceId};

/// Largest distance of a chord from its curve (m).
const FLATNESS: f64 = 4e-5;
/// Largest distance of the chords of a twin from its curve (m).
const TWIN_FLATNESS: f64 = 8e-6;
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

/// Writes the pieces of a pattern in its sizes, the base size first among the drafts; also returns what single
/// pieces lost. `is_astm` chooses the standard.
///
/// # Errors
/// There is no draft, or a piece without a cut line: its name, and the reason.
pub(crate) fn write_dxf(
    source: &WriteSource<'_>,
    is_astm: bool,
) -> Result<(String, Vec<Loss>), FormatError> {
    let base = source.drafts.first().ok_or_else(|| {
        FormatError::new("the pattern", "it has no draft", "mend its faults first")
    })?;
    let mut writer = PatternWriter {
        source,
        is_astm,
        dxf: DxfWriter::new(LAYERS.to_vec()),
        names: BTreeSet::new(),
    };
    writer.style(base);
    for piece in base.draft.pieces.iter().filter(|piece| piece.id.copy == 0) {
        for sized in source.drafts {
            writer.piece(piece.id, sized)?;
        }
    }
    Ok((writer.dxf.finish(), Vec::new()))
}

struct PatternWriter<'a> {
    source: &'a WriteSource<'a>,
    is_astm: bool,
    dxf: DxfWriter,
    /// Names of blocks that are taken.
    names: BTreeSet<String>,
}

impl PatternWriter<'_> {
    /// The texts that are about the whole style.
    fn style(&mut self, base: &SizedDraft) {
        let size = base.size.as_deref().unwrap_or("ONE");
        let texts = [
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
        for (k, text) in texts.iter().enumerate() {
            self.dxf.label("1", text, Vec2::new(0.0, -0.01 * k as f64));
        }
    }

    fn piece(&mut self, id: PieceId, sized: &SizedDraft) -> Result<(), FormatError> {
        let draft = &sized.draft;
        let Some(number) = draft.pieces.iter().position(|piece| piece.id == id) else {
            return Ok(());
        };
        let piece = &draft.pieces[number];
        let of = (self.source.pattern, draft);
        let cut = CutPiece::new(of, number, (sized.size.as_deref(), &CutOptions::default()));
        let cut = cut.map_err(|error| {
            FormatError::new(
                format!("piece {}", piece.name),
                error.to_string(),
                "mend it first",
            )
        })?;
        let Some(panel) = self.source.pattern.panel(id.panel) else {
            return Ok(());
        };
        let size = sized.size.as_deref().unwrap_or("ONE");
        let name = self.block_name(&panel.name, sized.size.as_deref());
        self.dxf.begin_block(&name);
        self.texts(panel, (piece, draft), size, &cut);
        self.lines(piece, &cut);
        for notch in &cut.notches {
            self.notch(notch);
        }
        for drill in &cut.drills {
            self.dxf.mark("13", drill.at, &[(30, 0.0)]);
        }
        self.dxf.end_block(&name);
        Ok(())
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

    fn lines(&mut self, piece: &Piece, cut: &CutPiece) {
        let [layer_twin, sew_twin] = ["84", "87"];
        for (k, ring) in cut.cut.iter().enumerate() {
            let layer = if k == 0 { "1" } else { "11" };
            let points = thinned(ring, FLATNESS);
            self.dxf.polyline(layer, &points, true);
            if k == 0 {
                self.marks_of(ring, &points);
                if self.is_astm {
                    self.dxf
                        .polyline(layer_twin, &thinned(ring, TWIN_FLATNESS), true);
                }
            }
        }
        let has_allowance = piece.outline.iter().any(|edge| edge.seam_allowance != 0.0);
        if has_allowance {
            let sew = self.sampled(piece, FLATNESS);
            self.dxf.polyline("14", &sew, true);
            let corners: Vec<Vec2> = piece
                .outline
                .iter()
                .map(|edge| edge.curve.start())
                .collect();
            for &at in &sew {
                let layer = if corners.contains(&at) { "2" } else { "3" };
                self.dxf.mark(layer, at, &[]);
            }
            if self.is_astm {
                let twin = self.sampled(piece, TWIN_FLATNESS);
                self.dxf.polyline(sew_twin, &twin, true);
            }
        }
        for line in &cut.inside {
            match self.drill_of(line) {
                Some(at) => self.dxf.mark("13", at, &[(30, 0.0)]),
                None => self.dxf.polyline("8", &line.points, false),
            }
        }
        if let Some(ends) = grain_line(cut) {
            self.dxf.polyline("7", &ends, false);
        }
    }

    /// The drill hole that a line inside marks.
    fn drill_of(&self, line: &InsideLine) -> Option<Vec2> {
        let Name::Drawn(id) = line.name else {
            return None;
        };
        let ends = [*line.points.first()?, *line.points.last()?];
        let mut lines = self
            .source
            .pattern
            .panels
            .iter()
            .flat_map(|panel| &panel.lines);
        let drawn = lines.find(|drawn| drawn.id == id)?;
        is_drill(&drawn.name, (ends[1] - ends[0]).norm()).then(|| 0.5 * (ends[0] + ends[1]))
    }

    /// Corners and curve points of the cut line.
    fn marks_of(&mut self, ring: &PieceRing, written: &[Vec2]) {
        for &at in written {
            let k = ring.points.iter().position(|p| *p == at).unwrap_or(0);
            let layer = if is_corner(ring, k) { "2" } else { "3" };
            self.dxf.mark(layer, at, &[]);
        }
    }

    /// The sew line of a piece, each edge sampled at equal shares of its length with as many chords in every size.
    fn sampled(&self, piece: &Piece, tolerance: f64) -> Vec<Vec2> {
        let alike: Vec<&Piece> = self
            .source
            .drafts
            .iter()
            .filter_map(|sized| sized.draft.pieces.iter().find(|other| other.id == piece.id))
            .filter(|other| other.outline.len() == piece.outline.len())
            .collect();
        let mut points = Vec::new();
        for (k, edge) in piece.outline.iter().enumerate() {
            let chords = alike
                .iter()
                .map(|other| chords(&other.outline[k].curve, tolerance));
            let count = chords.max().unwrap_or(1);
            points.extend(edge.curve.sample(0.0, 1.0, count));
            points.pop();
        }
        points
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

/// Number of chords at equal shares of a curve's length that stay within a tolerance (m).
fn chords(curve: &Curve, tolerance: f64) -> usize {
    match curve {
        Curve::Line { .. } => 1,
        // Parameters and shares of the length differ: twice as many are safe.
        Curve::Arc { .. } | Curve::Quadratic { .. } | Curve::Cubic { .. } => {
            (2 * curve.chord_count(tolerance)).max(2)
        }
    }
}

/// Whether the segments before and after a vertex come from different edges.
fn is_corner(ring: &PieceRing, k: usize) -> bool {
    let count = ring.segments.len();
    let edge = |k: usize| match ring.segments.get(k % count.max(1)) {
        Some(PieceSegment::Edge(edge)) => Some(*edge),
        Some(
            PieceSegment::DartCap(_)
            | PieceSegment::Corner(_)
            | PieceSegment::Fold
            | PieceSegment::Unknown,
        )
        | None => None,
    };
    count == 0 || edge(k + count - 1) != edge(k) || edge(k).is_none()
}

/// The vertices of a line without those that lie within a tolerance (m) of the chord between their neighbours
/// that stay; corners stay (Douglas and Peucker 1973).
fn thinned(ring: &PieceRing, tolerance: f64) -> Vec<Vec2> {
    let count = ring.points.len();
    let corners: Vec<usize> = (0..count).filter(|&k| is_corner(ring, k)).collect();
    let Some(&first) = corners.first() else {
        return ring.points.clone();
    };
    let mut stays = vec![false; count];
    corners.iter().for_each(|&k| stays[k] = true);
    let ends = corners.iter().skip(1).copied().chain([first + count]);
    let mut open: Vec<(usize, usize)> = corners.iter().copied().zip(ends).collect();
    let at = |k: usize| ring.points[k % count];
    while let Some((from, to)) = open.pop() {
        let along = at(to) - at(from);
        let length = along.norm();
        let off = |k: &usize| match length > 0.0 {
            true => (along.perp(&(at(*k) - at(from))) / length).abs(),
            false => (at(*k) - at(from)).norm(),
        };
        let farthest = (from + 1..to).max_by(|a, b| off(a).total_cmp(&off(b)));
        if let Some(k) = farthest.filter(|k| off(k) > tolerance) {
            stays[k % count] = true;
            open.extend([(from, k), (k, to)]);
        }
    }
    let kept = ring.points.iter().zip(stays).filter(|(_, stays)| *stays);
    kept.map(|(p, _)| *p).collect()
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
