//! Makes a document of drawn pieces.
//!
//! Every vertex becomes a point of the sheet; vertices between two corners become one edge, straight or a spline
//! through them. Corners grade by rules, points between them with their corners ([`crate::drawn::graded`]). Edges
//! of the sew line get the allowance that their distance to the cut line shows.

use super::corners::lies_along;
use super::cubics::Cubics;
use super::curved::Curved;
use super::cut_fit::{CutFit, edges_of, ring_of};
use super::cut_tangents::{DrawnCut, turn_ends};
use super::drill::{DRILL_LENGTH, DRILL_NAME};
use super::graded::{Frame, Rules, SizedPlaces};
use super::holes::sound_holes;
use super::marks::{Marked, OutlinePlace};
use super::piece::{DrawnLine, DrawnPattern, DrawnPiece, Span};
use crate::Loss;
use crate::part_names::part_name;
use std::collections::BTreeSet;
use std::sync::Arc;
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_pattern::{
    CurveRule, Edge, Fabric, FabricId, Knot, LineKind, Mark, Name, Notch, Operation, OperationKind,
    PanelBuilder, Pattern, PointId, Size, SizeId,
};

/// Shares of an edge in two sizes that differ by less are one (1).
const SAME: f64 = 1e-9;
/// Largest distance of the ends of a fold line from a vertex of the outline (m).
pub(crate) const ON_VERTEX: f64 = 2e-4;
/// Share of the vertices of a cut line that may lie elsewhere than allowances put them (1).
const MAX_OFF_SHARE: f64 = 0.5;
/// Room between pieces that are laid side by side on the table (m).
const ROOM: f64 = 0.03;
/// Width of a row of pieces on the table (m).
const ROW: f64 = 2.5;

/// Makes a document; also returns contents that were left out.
pub(crate) fn document(drawn: &DrawnPattern) -> (Pattern, Vec<Loss>) {
    let mut pattern = Pattern::new(drawn.name.trim());
    let mut size_names = BTreeSet::new();
    for name in &drawn.sizes {
        let id = pattern.ids.take::<SizeId>();
        let name = part_name(name, &mut size_names);
        let size = Size {
            id,
            name,
            ..Size::default()
        };
        pattern.sizes.push(Arc::new(size));
    }
    let sizes: Vec<SizeId> = pattern.sizes.iter().map(|size| size.id).collect();
    pattern.base_size = sizes.get(drawn.base).copied();
    let mut builder = Builder {
        pattern,
        rules: Rules::new(&sizes, drawn.base, &drawn.rules),
        sizes,
        base: drawn.base,
        names: BTreeSet::new(),
        losses: Vec::new(),
    };
    drawn.pieces.iter().for_each(|piece| builder.piece(piece));
    let variables = builder.rules.variables.drain(..).map(Arc::new);
    builder.pattern.variables.extend(variables);
    lay_out(&mut builder.pattern, &drawn.pieces, drawn.base);
    (builder.pattern, builder.losses)
}

/// Adds pieces in one size to a document, as panels after its own; returns contents that were left out.
pub(crate) fn add_pieces(pattern: &mut Pattern, pieces: &[DrawnPiece]) -> Vec<Loss> {
    let panels = pattern.panels.iter().map(|panel| panel.name.clone());
    let sheets = pattern.sheets.iter().map(|sheet| sheet.name.clone());
    let mut builder = Builder {
        names: panels.chain(sheets).collect(),
        pattern: std::mem::take(pattern),
        rules: Rules::new(&[], 0, &[]),
        sizes: Vec::new(),
        base: 0,
        losses: Vec::new(),
    };
    pieces.iter().for_each(|piece| builder.piece(piece));
    *pattern = builder.pattern;
    builder.losses
}

struct Builder {
    pattern: Pattern,
    rules: Rules,
    sizes: Vec<SizeId>,
    base: usize,
    /// Names of panels that are taken.
    names: BTreeSet<String>,
    losses: Vec<Loss>,
}

/// Numbers of parts of one piece, for their names.
#[derive(Default)]
struct Numbers {
    points: usize,
    handles: usize,
    edges: usize,
}

/// A line of a panel as built: its edges, and for each vertex of the drawn line the point made of it.
struct Built {
    edges: Vec<Edge>,
    /// The cubics of each edge that is no straight line.
    curves: Vec<Option<Cubics>>,
    points: Vec<PointId>,
    /// Indices of the corners among the vertices.
    corners: Vec<usize>,
}

impl Builder {
    fn fabric(&mut self, name: Option<&str>) -> FabricId {
        let name = name.map(str::trim).filter(|name| !name.is_empty());
        let known = self.pattern.fabrics.iter().find(|fabric| match name {
            Some(name) => fabric.name == name,
            None => true,
        });
        if let Some(known) = known {
            return known.id;
        }
        let mut fabric = Fabric::poplin(self.pattern.ids.take());
        if let Some(name) = name {
            let taken = self
                .pattern
                .fabrics
                .iter()
                .map(|fabric| fabric.name.clone());
            fabric.name = part_name(name, &mut taken.collect());
        }
        let id = fabric.id;
        self.pattern.fabrics.push(Arc::new(fabric));
        id
    }

    fn piece(&mut self, piece: &DrawnPiece) {
        let name = part_name(&piece.name, &mut self.names);
        let fabric = self.fabric(piece.fabric.as_deref());
        let mut outline = piece.outline.clone();
        if outline.area(self.base) < 0.0 {
            outline.reverse();
        }
        let mut ids = self.pattern.ids;
        let mut drawing = PanelBuilder::new(&mut ids, &name, fabric);
        let mut numbers = Numbers::default();
        let mut fold = self.fold(&name, piece, &mut outline);
        let mut curved = self.smooth(&name, &mut outline, fold);
        let mut inside = piece.inside.clone();
        let cut = DrawnCut::of(piece, self.base, self.sizes.len().max(1));
        let mut fit = cut.as_ref().map(|cut| cut.fit(&outline, &curved));
        if let (Some(cut), Some(fit)) = (&cut, &mut fit) {
            turn_ends(&outline, cut, (&mut curved, fit));
        }
        if let (Some(cut), true) = (
            &piece.cut_outline,
            fit.as_ref().is_some_and(is_no_allowance),
        ) {
            let why = "the cut line is at no even distance from it: the cut line is the outline, the sew line a line inside";
            self.lost(&name, "a sew line", why);
            inside.push(piece.outline.clone());
            outline = cut.clone();
            if outline.area(self.base) < 0.0 {
                outline.reverse();
            }
            fold = self.fold(&name, piece, &mut outline);
            curved = self.smooth(&name, &mut outline, fold);
            fit = None;
        }
        let edges = edges_of(&outline, (&curved.corners, &curved.curves), self.base);
        let (holes, others) = sound_holes(ring_of(&edges), &piece.holes, self.base);
        for hole in others {
            let why = "it crosses the outline or another cut-out; kept as a line inside";
            self.lost(&name, "a cut-out", why);
            inside.push(hole);
        }
        let mut built = self.line(&mut drawing, &mut numbers, &outline, curved);
        if let Some(fit) = fit {
            self.allowances(&name, fit, &mut built.edges, &mut drawing);
        }
        let Built {
            edges,
            curves,
            points,
            corners,
        } = built;
        let line = drawing.line("outline", LineKind::Outline, edges);
        for (k, mut hole) in holes.into_iter().enumerate() {
            if hole.area(self.base) > 0.0 {
                hole.reverse();
            }
            let built = self.line(&mut drawing, &mut numbers, &hole, self.curved(&hole, None));
            drawing.line(format!("hole {}", k + 1), LineKind::Hole, built.edges);
        }
        for (k, inside) in inside.iter().enumerate() {
            let built = self.line(
                &mut drawing,
                &mut numbers,
                inside,
                self.curved(inside, None),
            );
            drawing.line(format!("line {}", k + 1), LineKind::Internal, built.edges);
        }
        self.drills(&mut drawing, &mut numbers, &piece.drills);
        let marked = Marked {
            outline: &outline,
            corners: &corners,
            curves: &curves,
            base: self.base,
            sizes: self.sizes.len().max(1),
        };
        for (k, notch) in piece.notches.iter().enumerate() {
            let at = match marked.place(notch) {
                None => {
                    self.lost(&name, "a notch", "it lies far from the outline");
                    continue;
                }
                Some(OutlinePlace::Corner(corner)) => Mark::corner(points[corner]),
                Some(OutlinePlace::Between { corners, shares }) => {
                    let share = self.rules.number(SAME, |size| shares[size]);
                    Mark::between(corners.map(|k| points[k]), share)
                }
            };
            // A notch at a corner is cut on both cut lines that meet there.
            let mut known = drawing.panel.notches.iter();
            if known.any(|known| known.at == at && known.kind == notch.kind) {
                continue;
            }
            let id = drawing.id();
            drawing.panel.notches.push(Notch {
                id,
                name: format!("n{}", k + 1),
                line,
                at,
                kind: notch.kind,
            });
        }
        if let Some([from, to]) = fold {
            let id = drawing.id();
            let ends = [from, to].map(|k| Mark::corner(points[k]));
            drawing.panel.operations.push(Arc::new(Operation {
                id,
                name: "fold".to_owned(),
                meant: false,
                kind: OperationKind::Fold {
                    line: Name::Drawn(line),
                    ends,
                },
            }));
        }
        if let Some(grain) = piece.grain {
            drawing.panel.grain = grain.into();
        }
        drawing.panel.cut = piece.cut;
        let drawn = drawing.done();
        self.pattern.ids = ids;
        self.pattern.add(drawn);
    }

    /// Tells something that was left out of a piece.
    fn lost(&mut self, piece: &str, what: &str, why: &str) {
        let alike = |loss: &&mut Loss| loss.place == piece && loss.what == what && loss.why == why;
        match self.losses.iter_mut().find(alike) {
            Some(loss) => loss.count += 1,
            None => self.losses.push(Loss::at(piece, what, why)),
        }
    }

    /// Corners and curves of a line; `fold` are the vertices at the ends of a straight edge of it.
    fn curved(&self, line: &DrawnLine, fold: Option<[usize; 2]>) -> Curved {
        Curved::new(line, fold, self.sizes.len().max(1))
    }

    /// Corners and curves of an outline. Where smooth curves would cross each other in some size, and its chords do not,
    /// all its vertices become corners.
    fn smooth(&mut self, name: &str, outline: &mut DrawnLine, fold: Option<[usize; 2]>) -> Curved {
        let curved = self.curved(outline, fold);
        let is_sound = |size: usize| {
            let edges = edges_of(outline, (&curved.corners, &curved.curves), size);
            let points = ring_of(&edges);
            // Straight lines cross where their vertices do.
            points.len() == edges.len()
                || Polygon::new(points).defects().is_empty()
                || !Polygon::new(outline.chords(size).points)
                    .defects()
                    .is_empty()
        };
        if (0..outline.by_size.len()).all(is_sound) {
            return curved;
        }
        let why =
            "its curves would cross each other, so straight chords are kept between all vertices";
        self.lost(name, "smoothness of an outline", why);
        outline.is_corner = vec![true; outline.len()];
        outline.between.clear();
        outline.spans.clear();
        self.curved(outline, fold)
    }

    /// Adds the points and curves of a line.
    fn line(
        &mut self,
        drawing: &mut PanelBuilder<'_>,
        numbers: &mut Numbers,
        line: &DrawnLine,
        Curved { corners, curves }: Curved,
    ) -> Built {
        let count = line.len();
        let at = |k: usize, size: usize| line.in_size(size)[k % count];
        let place = |k: usize| SizedPlaces::new(&|size| at(k, size), self.sizes.len());
        let name = |k: usize| format!("p{}", numbers.points + k + 1);
        let mut points: Vec<PointId> = vec![PointId::default(); count];
        for &k in &corners {
            let rule = self.rules.corner(drawing, &place(k));
            points[k] = drawing.point(name(k), rule);
        }
        let mut frames = Vec::with_capacity(curves.len());
        for (c, &from) in corners.iter().enumerate().take(curves.len()) {
            let next = corners[(c + 1) % corners.len()];
            let to = if next > from { next } else { next + count };
            let ends = [from, next];
            let frame = self.rules.frame(ends.map(|k| points[k]), &ends.map(place));
            for k in from + 1..to {
                let k = k % count;
                points[k] = drawing.point(name(k), self.rules.between(&frame, &place(k)));
            }
            frames.push(frame);
        }
        numbers.points += count;
        let mut edges = Vec::with_capacity(curves.len());
        for (c, curve) in curves.iter().enumerate() {
            let from = corners[c];
            let next = corners[(c + 1) % corners.len()];
            numbers.edges += 1;
            let name = format!("e{}", numbers.edges);
            let ends = [points[from], points[next]];
            let rule = match curve {
                None => CurveRule::Line,
                Some(cubics) => {
                    let vertex = |k: usize| points[(from + k) % count];
                    self.spline(drawing, numbers, (cubics, &frames[c]), vertex)
                }
            };
            edges.push(drawing.edge(name, ends, rule));
        }
        Built {
            edges,
            curves,
            points,
            corners,
        }
    }

    /// The rule of a curve of cubics; `vertex` gives the points of its vertices by their numbers from its start.
    fn spline(
        &mut self,
        drawing: &mut PanelBuilder<'_>,
        numbers: &mut Numbers,
        (cubics, frame): (&Cubics, &Frame),
        vertex: impl Fn(usize) -> PointId,
    ) -> CurveRule {
        if cubics.has_chords {
            let why =
                "a smooth curve would turn back, so straight chords are kept between its vertices";
            self.lost(&drawing.panel.name.clone(), "smoothness of a curve", why);
        }
        let mut handle = |k: usize, end: usize| {
            numbers.handles += 1;
            let at = |size: usize| cubics.in_size(size)[k].handles[end];
            let place = SizedPlaces::new(&at, self.sizes.len());
            let rule = self.rules.between(frame, &place);
            drawing.point(format!("h{}", numbers.handles), rule)
        };
        let count = cubics.ends_at_vertex.len();
        let start = handle(0, 0);
        // Handles before and after each joint of two cubics.
        let joints: Vec<[PointId; 2]> = (1..count)
            .map(|k| [handle(k - 1, 1), handle(k, 0)])
            .collect();
        let end = handle(count - 1, 1);
        let mut vertices = 0;
        let mut knots = Vec::with_capacity(joints.len());
        for (k, [before, after]) in joints.into_iter().enumerate() {
            let point = if cubics.ends_at_vertex[k] {
                vertices += 1;
                vertex(vertices)
            } else {
                numbers.points += 1;
                let at = |size: usize| cubics.in_size(size)[k].end;
                let place = SizedPlaces::new(&at, self.sizes.len());
                let rule = self.rules.between(frame, &place);
                drawing.point(format!("p{}", numbers.points), rule)
            };
            knots.push(Knot {
                before,
                point,
                after,
            });
        }
        CurveRule::Spline {
            handles: [start, end],
            knots,
            to_length: None,
        }
    }

    /// Adds a short line inside for each drill hole.
    fn drills(
        &mut self,
        drawing: &mut PanelBuilder<'_>,
        numbers: &mut Numbers,
        drills: &[Vec<Vec2>],
    ) {
        for (k, by_size) in drills.iter().enumerate() {
            let arm = Vec2::new(0.5 * DRILL_LENGTH, 0.0);
            let mark = DrawnLine {
                by_size: by_size.iter().map(|at| vec![at - arm, at + arm]).collect(),
                ..DrawnLine::default()
            };
            let built = self.line(drawing, numbers, &mark, self.curved(&mark, None));
            drawing.line(
                format!("{DRILL_NAME} {}", k + 1),
                LineKind::Internal,
                built.edges,
            );
        }
    }

    /// The vertices at the ends of the fold of a piece; those between are left out of the outline.
    fn fold(
        &mut self,
        name: &str,
        piece: &DrawnPiece,
        outline: &mut DrawnLine,
    ) -> Option<[usize; 2]> {
        let ends = self.fold_vertices(outline, piece.fold?);
        if ends.is_none() {
            let why = "it is no straight stretch of the outline";
            self.lost(name, "the fold line", why);
        }
        ends.map(|ends| without_vertices_between(outline, ends))
    }

    /// Sets the allowances and corners of the edges of an outline.
    fn allowances(
        &mut self,
        name: &str,
        fit: CutFit,
        edges: &mut [Edge],
        drawing: &mut PanelBuilder<'_>,
    ) {
        let all = [
            (
                fit.uneven,
                "seam allowances of uneven width",
                "their mean width is taken, or the usual one of the piece where that is beyond all measure",
            ),
            (
                fit.other_corners,
                "corners of the cut line",
                "they turn in a way that no corner here does",
            ),
        ];
        for (count, what, why) in all.into_iter().filter(|(count, ..)| *count > 0) {
            self.losses.push(Loss {
                count,
                ..Loss::at(name, what, why)
            });
        }
        let usual = fit.usual;
        drawing.panel.allowance = usual.into();
        for ((edge, width), corner) in edges.iter_mut().zip(fit.widths).zip(fit.corners) {
            edge.allowance = (width != usual).then(|| width.into());
            edge.corner = corner;
        }
    }

    /// The vertices of an outline at the ends of a fold line, in the order of the line.
    fn fold_vertices(&self, outline: &DrawnLine, ends: [Vec2; 2]) -> Option<[usize; 2]> {
        let vertices = outline.in_size(self.base);
        // The line of the file may end at the cut line, beyond the ends of the sew line.
        let along = ends[1] - ends[0];
        let length = along.norm();
        let place = |k: &usize| (vertices[*k] - ends[0]).dot(&along) / length;
        let is_on = |k: &usize| {
            let off = (along.perp(&(vertices[*k] - ends[0])) / length).abs();
            off <= ON_VERTEX && (-ON_VERTEX..=length + ON_VERTEX).contains(&place(k))
        };
        let on = || (0..vertices.len()).filter(is_on);
        let a = on().min_by(|a, b| place(a).total_cmp(&place(b)))?;
        let b = on().max_by(|a, b| place(a).total_cmp(&place(b)))?;
        let count = vertices.len();
        let runs_straight = |from: usize, to: usize| {
            let to = if to > from { to } else { to + count };
            let is_cubic = |k: usize| matches!(outline.span(k % count), Span::Cubic(_));
            let (stretch, _) = outline.stretch(self.base, (from, to));
            !(from..to).any(is_cubic) && lies_along(&stretch, ON_VERTEX)
        };
        match a != b {
            true if runs_straight(a, b) => Some([a, b]),
            true if runs_straight(b, a) => Some([b, a]),
            _ => None,
        }
    }
}

/// Leaves out the vertices from one vertex to another, in the order of the line; returns the numbers of both.
pub(crate) fn without_vertices_between(line: &mut DrawnLine, [from, to]: [usize; 2]) -> [usize; 2] {
    let count = line.len();
    let after = |k: usize| (k + count - from) % count;
    let is_gone: Vec<bool> = (0..count)
        .map(|k| after(k) > 0 && after(k) < after(to))
        .collect();
    line.remove(&is_gone);
    let before = |k: usize| is_gone[..k].iter().filter(|is_gone| **is_gone).count();
    [from - before(from), to - before(to)]
}

/// Whether the cut line of a piece follows from its sew line by no allowances.
fn is_no_allowance(fit: &CutFit) -> bool {
    fit.is_mostly_uneven() && fit.off_share > MAX_OFF_SHARE
}

/// Lays pieces that overlap in the coordinates of their file side by side on the table, in rows; their
/// coordinates stay.
fn lay_out(pattern: &mut Pattern, pieces: &[DrawnPiece], base: usize) {
    let bounds = |piece: &DrawnPiece| Bounds2::of(piece.outline.chords(base).points);
    let bounds: Vec<Bounds2> = pieces.iter().map(bounds).collect();
    let any =
        (0..bounds.len()).any(|k| bounds[..k].iter().any(|before| before.overlaps(&bounds[k])));
    if !any {
        return;
    }
    let (mut x, mut y, mut height) = (0.0f64, 0.0f64, 0.0f64);
    for (sheet, bounds) in pattern.sheets.iter_mut().zip(bounds) {
        let size = bounds.size();
        if x > 0.0 && x + size.x > ROW {
            (x, y, height) = (0.0, y - height - ROOM, 0.0);
        }
        let corner = Vec2::new(x, y - size.y);
        Arc::make_mut(sheet).on_table = (corner - bounds.min).into();
        x += size.x + ROOM;
        height = height.max(size.y);
    }
}
