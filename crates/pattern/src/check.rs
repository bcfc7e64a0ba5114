//! Checks that a draft can be cut and sewn.
//!
//! # Decided with
//! - [`crate::check::SEAM_TOLERANCE`], [`crate::document::Seam`]: how much the sides of a seam may differ;
//!   ease and gathers;
//! - [`crate::orientation::turned_pieces`]: pieces that are sewn inside out;
//! - [`crate::evaluate::Evaluation::ease`] (`walk/mod.rs`): differences as a seam is walked;
//! - [`crate::diagnostic::Code`]: the faults;
//! - [`toile_geometry::Rings::crossings`], [`crate::plan`] (`face.rs`, `refuse_crossing`): outlines that cross
//!   themselves; curves that cross where a panel is traced.
//!
//! Shown by the window, `tools/walk.rs`. Gathers of imported patterns: crate `interchange`,
//! `garmentcode/reader.rs`.
//! Outlines that cross are refused again by crates `cut` (`check.rs`, `check_shape`), `assembly` (`mesh.rs`,
//! `planar_error`) and `nesting` (`check.rs`, `check_outline`). Errors stop commands in crate `session`
//! (`project.rs`, `refuse_faults`).

use crate::evaluate::{Evaluation, Wearer};
use crate::orientation::turned_pieces;
use crate::{
    Code, Diagnostic, Draft, DraftSeam, DraftSpan, Fabric, Name, OperationId, OperationKind, Panel,
    Pattern, Piece, PieceEdge, PieceLine, Place, SeamOrigin, Severity,
};
use toile_fabric::{Component, Domain};
use toile_geometry::{Rings, Vec2};

/// Largest distance between the ends of neighbouring edges that counts as rounding, not as a gap (m).
const GAP: f64 = 1e-6;
/// Length below which an edge counts as having no length (m).
const SHORTEST: f64 = 1e-6;
/// Greatest distance between a curve and the polyline by which it is checked (m).
const FLATNESS: f64 = 5e-5;
/// Difference between the lengths of a seam's sides that needs no ease (m): less than a stitch.
pub const SEAM_TOLERANCE: f64 = 5e-4;
/// Greatest distance from its panel at which a point of an internal line still counts as inside (m).
const LINE_TOLERANCE: f64 = 1e-5;
/// Most crossings that are reported for one piece.
const CROSSINGS: usize = 5;
/// Limit of the number of points at which one internal line is checked. A line that does not reach the limit
/// is checked every 5 mm.
const LINE_SAMPLES: usize = 500;

impl Pattern {
    /// All faults of the pattern for a size or a table of measurements: first those that keep it from being
    /// drafted, then those that keep the draft from being cut and sewn.
    pub fn check(&self, wearer: impl Into<Wearer>) -> Vec<Diagnostic> {
        Evaluation::new(self, wearer).check()
    }
}

impl Evaluation {
    /// All faults of the pattern as last evaluated.
    pub fn check(&self) -> Vec<Diagnostic> {
        let drafting = self.drafting();
        let mut diagnostics = drafting.diagnostics;
        check_pieces(&drafting.draft, Some(self.pattern()), &mut diagnostics);
        for (seam, ease) in drafting.draft.seams.iter().zip(&drafting.eases) {
            check_seam(&drafting.draft, seam, *ease, &mut diagnostics);
        }
        diagnostics.extend(turned_pieces(&drafting.draft));
        diagnostics.extend(self.kinks(&drafting.draft));
        for panel in &self.pattern().panels {
            let stage = self.last_stage(panel);
            let idle = stage.map_or(&[][..], |stage| &stage.idle);
            note_pleats(panel, idle, &mut diagnostics);
        }
        diagnostics
    }

    /// Diagnostics about the side of the cloth that pieces show: panels whose seams take another copy than
    /// the document gives, so that pieces show their right sides, and pieces that still show their wrong
    /// side.
    pub fn check_sides(&self) -> Vec<Diagnostic> {
        let drafting = self.drafting();
        let mut found = drafting.diagnostics;
        found.retain(|found| found.code == Code::OtherCopy);
        found.extend(turned_pieces(&drafting.draft));
        found
    }
}

/// Adds a note for each pleat that takes in cloth: the drape does not fold and press pleats.
fn note_pleats(panel: &Panel, idle: &[OperationId], diagnostics: &mut Vec<Diagnostic>) {
    for operation in &panel.operations {
        let is_pleat = matches!(operation.kind, OperationKind::Pleat { .. });
        if is_pleat && !idle.contains(&operation.id) {
            diagnostics.push(Diagnostic::new(
                Severity::Note,
                Code::NotPressed,
                Place::Operation(panel.id, operation.id),
                format!(
                    "panel {:?}, pleat {:?}: draped with its underlay loose, not folded and pressed",
                    panel.name, operation.name
                ),
                "what is cut and sewn is right; in the drape the cloth of the pleat hangs open",
            ));
        }
    }
}

/// All faults that keep a draft from being cut and sewn, except that the lengths of seam sides are not
/// compared: a draft does not know the ease of its seams.
pub fn check_draft(draft: &Draft) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
    check_pieces(draft, None, &mut diagnostics);
    for seam in &draft.seams {
        if side_lengths(draft, seam).is_none() {
            diagnostics.push(missing_span(seam));
        }
    }
    diagnostics
}

fn check_pieces(draft: &Draft, pattern: Option<&Pattern>, diagnostics: &mut Vec<Diagnostic>) {
    for fabric in &draft.fabrics {
        check_fabric(fabric, diagnostics);
    }
    for piece in &draft.pieces {
        if piece.id.copy == 0 {
            PieceCheck {
                piece,
                pattern,
                diagnostics,
            }
            .run();
        }
        if !piece.sewn && draft.pieces.len() > 1 {
            diagnostics.push(Diagnostic::warning(
                Code::NotSewn,
                Place::Panel(piece.id.panel),
                format!("piece {:?} is sewn to nothing", piece.name),
                "sew it to another piece, or remove it",
            ));
        }
    }
}

/// Length of a span (m). `None`: its piece or edge is missing.
fn span_length(draft: &Draft, span: &DraftSpan) -> Option<f64> {
    let piece = draft.pieces.get(span.piece)?;
    let mut edges = piece.outline.iter().chain(piece.holes.iter().flatten());
    let edge = edges.nth(span.edge)?;
    Some(edge.curve.length() * (span.to - span.from).abs())
}

/// Lengths of both sides of a seam (m). `None`: a span is missing.
fn side_lengths(draft: &Draft, seam: &DraftSeam) -> Option<[f64; 2]> {
    let length = |side: &[DraftSpan]| side.iter().map(|s| span_length(draft, s)).sum();
    let first: Option<f64> = length(&seam.sides[0]);
    let second: Option<f64> = length(&seam.sides[1]);
    Some([first?, second?])
}

fn seam_place(seam: &DraftSeam, draft: &Draft) -> Place {
    match seam.id {
        SeamOrigin::Seam(id) => Place::Seam(id),
        SeamOrigin::Dart { dart, .. } => {
            let span = seam.sides.iter().flatten().next();
            match span.and_then(|span| draft.pieces.get(span.piece)) {
                Some(piece) => Place::Operation(piece.id.panel, dart),
                None => Place::Pattern,
            }
        }
    }
}

fn missing_span(seam: &DraftSeam) -> Diagnostic {
    Diagnostic::error(
        Code::MissingSpan,
        Place::Pattern,
        format!(
            "seam {:?} names a piece or an edge that is not there",
            seam.name
        ),
        "remove the seam or name an edge of the draft",
    )
}

fn check_seam(draft: &Draft, seam: &DraftSeam, ease: f64, diagnostics: &mut Vec<Diagnostic>) {
    let Some([first, second]) = side_lengths(draft, seam) else {
        diagnostics.push(missing_span(seam));
        return;
    };
    let place = seam_place(seam, draft);
    if ease < 0.0 {
        diagnostics.push(Diagnostic::warning(
            Code::Negative,
            place.clone(),
            format!("seam {:?}: its ease is negative", seam.name),
            "give the largest difference of its sides, zero or more",
        ));
    }
    let difference = (first - second).abs();
    if seam.gathered || difference <= ease.max(0.0) + SEAM_TOLERANCE {
        return;
    }
    let hint = match seam.id {
        SeamOrigin::Seam(_) => "make the sides equal, allow more ease, or gather the longer side",
        SeamOrigin::Dart { .. } => "move the apex so that both legs are equally long",
    };
    diagnostics.push(Diagnostic::warning(
        Code::SeamLength,
        place,
        format!(
            "seam {:?}: its sides are {:.1} mm and {:.1} mm long, {:.1} mm apart where {:.1} mm \
             are allowed",
            seam.name,
            first * 1000.0,
            second * 1000.0,
            difference * 1000.0,
            ease * 1000.0
        ),
        hint,
    ));
}

fn check_fabric(fabric: &Fabric, diagnostics: &mut Vec<Diagnostic>) {
    let mut report = |what: String, hint: &str| {
        diagnostics.push(Diagnostic::error(
            Code::BadFabric,
            Place::Fabric(fabric.id),
            format!("fabric {:?}: {what}", fabric.name),
            hint,
        ));
    };
    for component in Component::all() {
        let figure = component.figure;
        let domain = match figure.positive_in_patterns {
            true => Domain::Positive,
            false => figure.domain,
        };
        let value = component.of(&fabric.material);
        if let Some(value) = value.filter(|value| !domain.contains(*value)) {
            let hint = figure.pattern_remedy.unwrap_or(domain.remedy());
            report(format!("its {} is {value}", component.noun()), hint);
        }
    }
    if !Domain::Positive.contains(fabric.width) {
        let hint = Domain::Positive.remedy();
        report(format!("its width is {}", fabric.width), hint);
    }
    if !fabric.colour.iter().all(|c| (0.0..=1.0).contains(c)) {
        report(
            "its colour is not between 0 and 1".into(),
            "give red, green and blue from 0 to 1",
        );
    }
}

/// Twice the area that a loop of edges encloses (m2), positive if it runs counter-clockwise.
fn swept(edges: &[PieceEdge]) -> f64 {
    edges.iter().map(|edge| edge.curve.swept_area()).sum()
}

struct PieceCheck<'a> {
    piece: &'a Piece,
    pattern: Option<&'a Pattern>,
    diagnostics: &'a mut Vec<Diagnostic>,
}

impl PieceCheck<'_> {
    fn error(&mut self, code: Code, place: Place, what: &str, hint: &str) {
        self.tell(Severity::Error, (code, place), what, hint);
    }

    fn tell(&mut self, severity: Severity, (code, place): (Code, Place), what: &str, hint: &str) {
        let message = format!("panel {:?}: {what}", self.piece.name);
        self.diagnostics
            .push(Diagnostic::new(severity, code, place, message, hint));
    }

    fn edge_place(&self, edge: &PieceEdge) -> Place {
        let panel = self.piece.id.panel;
        match edge.origin.name {
            Name::Drawn(edge) => Place::Edge(panel, edge),
            Name::Made { by, .. } => Place::Operation(panel, by),
        }
    }

    /// Description of an edge for messages: its name, or the operation that made it.
    fn edge_words(&self, edge: &PieceEdge) -> String {
        let panel = self.pattern.and_then(|p| p.panel(self.piece.id.panel));
        let words = match edge.origin.name {
            Name::Drawn(id) => {
                let name = panel.and_then(|panel| panel.edge(id));
                let words = name.map_or_else(|| id.to_string(), |e| format!("{:?}", e.name));
                format!("edge {words}")
            }
            Name::Made { by, .. } => {
                let found = panel.and_then(|panel| panel.operations.iter().find(|o| o.id == by));
                let words = found.map_or_else(|| by.to_string(), |o| format!("{:?}", o.name));
                format!("{} {words}", found.map_or("operation", |o| o.kind.word()))
            }
        };
        match edge.origin.half {
            0 => words,
            _ => format!("{words} (mirrored)"),
        }
    }

    fn run(&mut self) {
        let piece = self.piece;
        let panel = Place::Panel(piece.id.panel);
        if piece.outline.is_empty() {
            let hint = "draw its outline or remove the panel";
            self.error(Code::EmptyOutline, panel, "it has no outline", hint);
            return;
        }
        let loops: Vec<&[PieceEdge]> = std::iter::once(&piece.outline)
            .chain(&piece.holes)
            .map(Vec::as_slice)
            .collect();
        if !self.check_finite(&loops) {
            return;
        }
        let mut closed = true;
        for edges in &loops {
            closed &= self.check_loop(edges);
        }
        let outline_area = swept(&piece.outline);
        if closed && outline_area.abs() < 1e-8 {
            let hint = "draw an outline that encloses some cloth";
            self.error(
                Code::EmptyOutline,
                panel,
                "its outline encloses nothing",
                hint,
            );
            return;
        }
        let points: Vec<Vec<(Vec2, usize)>> = flattened(&loops);
        let segments = Rings::new(&points);
        self.check_crossings(&loops, &segments);
        let outer = Rings::new(&points[..1]);
        for (k, hole) in piece.holes.iter().enumerate() {
            self.check_hole(k, hole, outline_area, &outer);
        }
        for line in &piece.internal_lines {
            self.check_line(line, &segments);
        }
    }

    fn check_finite(&mut self, loops: &[&[PieceEdge]]) -> bool {
        let bad = loops
            .iter()
            .flat_map(|edges| edges.iter())
            .find(|edge| !edge.curve.is_finite() || !edge.seam_allowance.is_finite());
        if let Some(edge) = bad {
            let words = format!("{} has a number that is not finite", self.edge_words(edge));
            let place = self.edge_place(edge);
            self.error(Code::NotFinite, place, &words, "give finite numbers");
        }
        bad.is_none()
    }

    /// Reports gaps between the edges of a loop, edges without length, and negative seam allowances. Returns
    /// whether the loop has no gap.
    fn check_loop(&mut self, edges: &[PieceEdge]) -> bool {
        let mut closed = true;
        for (k, edge) in edges.iter().enumerate() {
            let next = &edges[(k + 1) % edges.len()];
            let gap = (next.curve.start() - edge.curve.end()).norm();
            if gap > GAP {
                closed = false;
                let words = format!(
                    "the outline is open: {} ends {:.1} mm from where {} starts",
                    self.edge_words(edge),
                    gap * 1000.0,
                    self.edge_words(next)
                );
                let place = self.edge_place(next);
                let hint = "let both edges use the same point";
                self.error(Code::OpenOutline, place, &words, hint);
            }
            if edge.curve.length() < SHORTEST {
                let words = format!("{} has no length", self.edge_words(edge));
                let place = self.edge_place(edge);
                let hint = "move one of its ends, or remove the corner";
                self.error(Code::ZeroLengthEdge, place, &words, hint);
            }
            if edge.seam_allowance < 0.0 {
                let words = format!("{} has a negative seam allowance", self.edge_words(edge));
                let place = self.edge_place(edge);
                self.error(Code::Negative, place, &words, "give zero or more");
            }
        }
        closed
    }

    fn check_crossings(&mut self, loops: &[&[PieceEdge]], segments: &Rings) {
        let edges: Vec<&PieceEdge> = loops.iter().flat_map(|edges| edges.iter()).collect();
        let crossings = segments.crossings(CROSSINGS);
        for ([a, b], point) in crossings.found {
            let is_dart = |k: usize| edges[k].origin.leg().is_some();
            let (code, hint) = if is_dart(a) || is_dart(b) {
                (
                    Code::DartOutside,
                    "make the dart shorter, narrower, or move it",
                )
            } else {
                (
                    Code::SelfCrossing,
                    "move a point so that the edges stay apart",
                )
            };
            let place = self.edge_place(edges[if is_dart(b) { b } else { a }]);
            let words = format!(
                "{} and {} cross or touch near x = {:.1} cm, y = {:.1} cm",
                self.edge_words(edges[a]),
                self.edge_words(edges[b]),
                point.x * 100.0,
                point.y * 100.0
            );
            self.error(code, place, &words, hint);
        }
        if !crossings.complete {
            self.diagnostics.push(Diagnostic::warning(
                Code::Unchecked,
                Place::Panel(self.piece.id.panel),
                format!(
                    "panel {:?}: the outline is too intricate to look for all crossings",
                    self.piece.name
                ),
                "draw it with fewer edges",
            ));
        }
    }

    fn check_hole(&mut self, k: usize, hole: &[PieceEdge], outline: f64, outer: &Rings) {
        let place = self.hole_place(hole);
        let area = swept(hole);
        if hole.is_empty() || area.abs() < 1e-10 {
            let words = format!("hole {} encloses nothing", k + 1);
            let hint = "draw it larger or remove it";
            self.error(Code::EmptyOutline, place, &words, hint);
            return;
        }
        if (area > 0.0) == (outline > 0.0) {
            let words = format!("hole {} is wound like the outline", k + 1);
            let hint = "list its edges the other way round";
            self.error(Code::HoleWinding, place.clone(), &words, hint);
        }
        if !outer.holds(hole[0].curve.start(), 0.0) {
            let words = format!("hole {} is not inside the outline", k + 1);
            let hint = "move it inside, or remove it";
            self.error(Code::HoleOutside, place, &words, hint);
        }
    }

    /// Diagnostic place of a hole of the piece.
    fn hole_place(&self, hole: &[PieceEdge]) -> Place {
        let id = self.piece.id.panel;
        let edge = match hole.first().map(|edge| edge.origin.name) {
            Some(Name::Drawn(edge)) => edge,
            _ => return Place::Panel(id),
        };
        let owner = self.pattern.and_then(|p| p.owner_of(id, edge.into()));
        let line = owner.and_then(|owner| Some((owner.id, owner.line_of(edge)?.id)));
        line.map_or(Place::Panel(id), |(of, line)| Place::Line(of, line))
    }

    fn check_line(&mut self, line: &PieceLine, segments: &Rings) {
        let panel = self.piece.id.panel;
        let (place, name) = match line.name {
            Name::Drawn(id) => {
                let owner = self.pattern.and_then(|p| p.owner_of(panel, id.into()));
                let found = owner.and_then(|owner| owner.line(id));
                let name = found.map_or_else(|| id.to_string(), |l| format!("{:?}", l.name));
                (Place::Line(owner.map_or(panel, |owner| owner.id), id), name)
            }
            Name::Made { by, .. } => (Place::Operation(panel, by), by.to_string()),
        };
        if !line.curves.iter().all(|curve| curve.is_finite()) {
            let words = format!("internal line {name} has a number that is not finite");
            self.error(Code::NotFinite, place, &words, "give finite numbers");
            return;
        }
        let length: f64 = line.curves.iter().map(|curve| curve.length()).sum();
        for curve in &line.curves {
            let share = curve.length() / length.max(1e-9);
            let count = ((curve.length() / 0.005).ceil()).min(share * LINE_SAMPLES as f64);
            let count = (count as usize).max(2);
            let samples = (0..=count).map(|k| curve.point(k as f64 / count as f64));
            let outside = samples
                .into_iter()
                .find(|point| !segments.holds(*point, LINE_TOLERANCE));
            if let Some(point) = outside {
                let words = format!(
                    "internal line {name} leaves the panel at x = {:.1} cm, y = {:.1} cm; it is drawn there, but no cloth has it",
                    point.x * 100.0,
                    point.y * 100.0
                );
                let hint = "move its points inside the panel if the cloth should have all of it";
                self.tell(Severity::Note, (Code::LineOutside, place), &words, hint);
                return;
            }
        }
    }
}

/// Loops as polylines. Each point has the index of its edge; edges are numbered through all loops.
fn flattened(loops: &[&[PieceEdge]]) -> Vec<Vec<(Vec2, usize)>> {
    let mut edge = 0;
    let mut result = Vec::with_capacity(loops.len());
    for edges in loops {
        let mut points = Vec::new();
        for piece in *edges {
            let mut curve = piece.curve.flatten(FLATNESS);
            curve.pop();
            points.extend(curve.into_iter().map(|point| (point, edge)));
            edge += 1;
        }
        result.push(points);
    }
    result
}
