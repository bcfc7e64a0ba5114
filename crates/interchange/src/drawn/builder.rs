//! Makes a document of drawn pieces.
//!
//! Every vertex becomes a point of the sheet with its place in each size; vertices between two corners become
//! one edge, straight or a spline through them. Edges of the sew line get the allowance that their distance to
//! the cut line shows.

use super::allowance::{Width, width};
use super::corners::{corners, is_straight, lies_along};
use super::cubics::{Cubics, cubics};
use super::drill::{DRILL_LENGTH, DRILL_NAME};
use super::marks::{Marked, OutlinePlace};
use super::piece::{DrawnLine, DrawnPattern, DrawnPiece};
use crate::Loss;
use crate::part_names::part_name;
use std::collections::BTreeSet;
use std::sync::Arc;
use toile_geometry::{Bounds2, Vec2, ring_area};
use toile_pattern::{
    CurveRule, Edge, Fabric, FabricId, Knot, LineKind, Mark, Name, Notch, Number, Operation,
    OperationKind, PanelBuilder, Pattern, PointId, PointRule, Size, SizeId,
};

/// Coordinates of two sizes that differ by less are one (m).
const SAME: f64 = 1e-9;
/// Largest distance of the ends of a fold line from a vertex of the outline (m).
const ON_VERTEX: f64 = 2e-4;
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
        sizes,
        base: drawn.base,
        names: BTreeSet::new(),
        losses: Vec::new(),
    };
    drawn.pieces.iter().for_each(|piece| builder.piece(piece));
    lay_out(&mut builder.pattern, &drawn.pieces, drawn.base);
    (builder.pattern, builder.losses)
}

struct Builder {
    pattern: Pattern,
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
        if ring_area(outline.in_size(self.base)) < 0.0 {
            outline.reverse();
        }
        let mut ids = self.pattern.ids;
        let mut drawing = PanelBuilder::new(&mut ids, &name, fabric);
        let mut numbers = Numbers::default();
        let fold = piece
            .fold
            .and_then(|ends| self.fold_vertices(&outline, ends));
        if piece.fold.is_some() && fold.is_none() {
            let why = "it is no straight stretch of the outline";
            self.lost(&name, "the fold line", why);
        }
        let fold = fold.map(|ends| without_vertices_between(&mut outline, ends));
        let mut built = self.line(&mut drawing, &mut numbers, &outline, fold);
        if let Some(cut_line) = &piece.cut_line {
            self.allowances(&name, &outline, &mut built, cut_line, &mut drawing);
        }
        let Built {
            edges,
            curves,
            points,
            corners,
        } = built;
        let line = drawing.line("outline", LineKind::Outline, edges);
        for (k, hole) in piece.holes.iter().enumerate() {
            let mut hole = hole.clone();
            if ring_area(hole.in_size(self.base)) > 0.0 {
                hole.reverse();
            }
            let built = self.line(&mut drawing, &mut numbers, &hole, None);
            drawing.line(format!("hole {}", k + 1), LineKind::Hole, built.edges);
        }
        for (k, inside) in piece.inside.iter().enumerate() {
            let built = self.line(&mut drawing, &mut numbers, inside, None);
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
                    let share = self.number(|size| shares[size]);
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

    /// A number with its values in all sizes.
    fn number(&self, values: impl Fn(usize) -> f64) -> Number {
        let usual = values(self.base);
        let others = self.sizes.iter().enumerate();
        let others = others.filter(|&(k, _)| k != self.base);
        let differing: Vec<(SizeId, f64)> = others
            .map(|(k, &size)| (size, values(k)))
            .filter(|(_, value)| (value - usual).abs() > SAME)
            .collect();
        match differing.is_empty() {
            true => usual.into(),
            false => Number::PerSize {
                usual: Box::new(usual.into()),
                sizes: differing,
            },
        }
    }

    fn rule(&self, at: impl Fn(usize) -> Vec2) -> PointRule {
        PointRule::At {
            x: self.number(|size| at(size).x),
            y: self.number(|size| at(size).y),
        }
    }

    /// Tells something that was left out of a piece.
    fn lost(&mut self, piece: &str, what: &str, why: &str) {
        let alike = |loss: &&mut Loss| loss.place == piece && loss.what == what && loss.why == why;
        match self.losses.iter_mut().find(alike) {
            Some(loss) => loss.count += 1,
            None => self.losses.push(Loss::at(piece, what, why)),
        }
    }

    /// Adds the points and curves of a line; `fold` are the vertices at the ends of a straight edge of it.
    fn line(
        &mut self,
        drawing: &mut PanelBuilder<'_>,
        numbers: &mut Numbers,
        line: &DrawnLine,
        fold: Option<[usize; 2]>,
    ) -> Built {
        let corners = corners(line, fold.as_ref().map_or(&[], |ends| ends));
        let count = line.len();
        let at = |k: usize, size: usize| line.in_size(size)[k % count];
        let points: Vec<PointId> = (0..count)
            .map(|k| {
                numbers.points += 1;
                drawing.point(
                    format!("p{}", numbers.points),
                    self.rule(|size| at(k, size)),
                )
            })
            .collect();
        let last = corners.len() - usize::from(!line.is_closed);
        let (mut edges, mut curves) = (Vec::new(), Vec::new());
        for (c, &from) in corners.iter().enumerate().take(last) {
            let next = corners[(c + 1) % corners.len()];
            let to = if next > from { next } else { next + count };
            numbers.edges += 1;
            let name = format!("e{}", numbers.edges);
            let ends = [points[from], points[to % count]];
            let is_fold = fold == Some([from, to % count]);
            let curve = (!is_fold).then(|| self.curve(line, (from, to))).flatten();
            let rule = match &curve {
                None => CurveRule::Line,
                Some(cubics) => {
                    self.spline(drawing, numbers, cubics, |k| points[(from + k) % count])
                }
            };
            edges.push(drawing.edge(name, ends, rule));
            curves.push(curve);
        }
        Built {
            edges,
            curves,
            points,
            corners,
        }
    }

    /// The cubics through the vertices from one corner to the next; `None` if they lie on a straight line.
    fn curve(&self, line: &DrawnLine, (from, to): (usize, usize)) -> Option<Cubics> {
        let sizes = self.sizes.len().max(1);
        let is_line = (0..sizes).all(|size| {
            let vertices = line.in_size(size);
            let mut stretch: Vec<Vec2> = Vec::with_capacity(to - from + 1);
            for k in from..to {
                let k = k % vertices.len();
                stretch.push(vertices[k]);
                stretch.extend(line.between_in(size, k));
            }
            stretch.push(vertices[to % vertices.len()]);
            is_straight(&stretch)
        });
        (!is_line).then(|| cubics(line, (from, to), sizes))
    }

    /// The rule of a curve of cubics; `vertex` gives the points of its vertices by their numbers from its start.
    fn spline(
        &mut self,
        drawing: &mut PanelBuilder<'_>,
        numbers: &mut Numbers,
        cubics: &Cubics,
        vertex: impl Fn(usize) -> PointId,
    ) -> CurveRule {
        if cubics.has_chords {
            let why =
                "a smooth curve would turn back, so straight chords are kept between its vertices";
            self.lost(&drawing.panel.name.clone(), "smoothness of a curve", why);
        }
        let mut handle = |k: usize, end: usize| {
            numbers.handles += 1;
            let rule = self
                .rule(|size| cubics.by_size[size.min(cubics.by_size.len() - 1)][k].handles[end]);
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
                let at = |size: usize| cubics.by_size[size.min(cubics.by_size.len() - 1)][k].end;
                drawing.point(format!("p{}", numbers.points), self.rule(at))
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
            let built = self.line(drawing, numbers, &mark, None);
            drawing.line(
                format!("{DRILL_NAME} {}", k + 1),
                LineKind::Internal,
                built.edges,
            );
        }
    }

    /// Sets the allowances of the edges of an outline.
    fn allowances(
        &mut self,
        name: &str,
        outline: &DrawnLine,
        built: &mut Built,
        cut_line: &[Vec2],
        drawing: &mut PanelBuilder<'_>,
    ) {
        let vertices = outline.in_size(self.base);
        let count = vertices.len();
        let mut uneven = 0;
        let widths: Vec<f64> = built
            .corners
            .iter()
            .enumerate()
            .map(|(c, &from)| {
                let next = built.corners[(c + 1) % built.corners.len()];
                let to = if next > from { next } else { next + count };
                let edge: Vec<Vec2> = (from..=to).map(|k| vertices[k % count]).collect();
                match width(&edge, cut_line) {
                    Width::Even(width) => rounded(width),
                    Width::Uneven(mean) => {
                        uneven += 1;
                        rounded(mean)
                    }
                }
            })
            .collect();
        if uneven > 0 {
            self.losses.push(Loss {
                count: uneven,
                ..Loss::at(
                    name,
                    "seam allowances of uneven width",
                    "their mean width is taken",
                )
            });
        }
        let usual = most_common(&widths);
        drawing.panel.allowance = usual.into();
        for (edge, width) in built.edges.iter_mut().zip(widths) {
            edge.allowance = (width != usual).then(|| width.into());
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
            let stretch: Vec<Vec2> = (from..=to).map(|k| vertices[k % count]).collect();
            lies_along(&stretch, ON_VERTEX)
        };
        match a != b {
            true if runs_straight(a, b) => Some([a, b]),
            true if runs_straight(b, a) => Some([b, a]),
            _ => None,
        }
    }
}

/// Leaves out the vertices from one vertex to another, in the order of the line; returns the numbers of both.
fn without_vertices_between(line: &mut DrawnLine, [from, to]: [usize; 2]) -> [usize; 2] {
    let count = line.len();
    let after = |k: usize| (k + count - from) % count;
    let is_gone: Vec<bool> = (0..count)
        .map(|k| after(k) > 0 && after(k) < after(to))
        .collect();
    line.remove(&is_gone);
    let before = |k: usize| is_gone[..k].iter().filter(|is_gone| **is_gone).count();
    [from - before(from), to - before(to)]
}

/// A width rounded to a thousandth of a millimetre.
fn rounded(width: f64) -> f64 {
    (width * 1e6).round() / 1e6
}

/// The value that occurs most often, the first of equals; 0 without values.
fn most_common(values: &[f64]) -> f64 {
    let count = |value: f64| values.iter().filter(|&&other| other == value).count();
    let mut best = (0, 0.0);
    for &value in values {
        if count(value) > best.0 {
            best = (count(value), value);
        }
    }
    best.1
}

/// Lays pieces that overlap in the coordinates of their file side by side on the table, in rows; their
/// coordinates stay.
fn lay_out(pattern: &mut Pattern, pieces: &[DrawnPiece], base: usize) {
    let bounds = |piece: &DrawnPiece| {
        let outline = piece
            .outline
            .by_size
            .get(base)
            .or(piece.outline.by_size.first());
        Bounds2::of(outline.into_iter().flatten().copied())
    };
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
