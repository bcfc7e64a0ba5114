//! Makes a document of drawn pieces.
//!
//! Every vertex becomes a point of the sheet; vertices between two corners become one edge, straight or a spline
//! through them. Corners grade by rules, points between them with their corners ([`crate::drawn::graded`]). Edges
//! of the sew line get the allowance that their distance to the cut line shows.

use super::allowance::{Width, nearest, width};
use super::corners::{corners, is_straight};
use super::graded::{Rules, SizedPlaces};
use super::piece::{DrawnLine, DrawnNotch, DrawnPattern, DrawnPiece};
use super::spline;
use crate::Loss;
use crate::part_names::part_name;
use std::collections::BTreeSet;
use std::sync::Arc;
use toile_geometry::{Bounds2, Vec2, ring_area};
use toile_pattern::{
    CurveRule, Edge, Fabric, FabricId, Knot, LineKind, Mark, Name, Notch, Operation, OperationKind,
    PanelBuilder, Pattern, PointId, Size, SizeId,
};

/// Shares of an edge in two sizes that differ by less are one (1).
const SAME: f64 = 1e-9;
/// Largest distance of the ends of a fold line from a vertex of the outline (m).
const ON_VERTEX: f64 = 2e-4;
/// Largest distance of a notch from the line of an edge that it belongs to beyond the corner (m).
const ON_LINE: f64 = 2e-4;
/// Distances from a notch that differ by less count as one (m): at an allowance of 10 mm this is 1 mm along the
/// line, nearer than notches are set to a corner.
const AS_NEAR: f64 = 5e-5;
/// Longest way from the sew line, or from a corner of it, to a notch on the cut line that belongs to it (m).
const MAX_REACH: f64 = 0.06;
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
            self.losses.push(Loss::at(
                &name,
                "the fold line",
                "it is no straight stretch of the outline",
            ));
        }
        let further = fold.map_or(Vec::new(), |ends| ends.to_vec());
        let mut built = self.line(&mut drawing, &mut numbers, &outline, &further);
        if let Some(cut_line) = &piece.cut_line {
            self.allowances(&name, &outline, &mut built, cut_line, &mut drawing);
        }
        let Built {
            edges,
            points,
            corners,
        } = built;
        let line = drawing.line("outline", LineKind::Outline, edges);
        for (k, hole) in piece.holes.iter().enumerate() {
            let mut hole = hole.clone();
            if ring_area(hole.in_size(self.base)) > 0.0 {
                hole.reverse();
            }
            let built = self.line(&mut drawing, &mut numbers, &hole, &[]);
            drawing.line(format!("hole {}", k + 1), LineKind::Hole, built.edges);
        }
        for (k, inside) in piece.inside.iter().enumerate() {
            let built = self.line(&mut drawing, &mut numbers, inside, &[]);
            drawing.line(format!("line {}", k + 1), LineKind::Internal, built.edges);
        }
        for (k, notch) in piece.notches.iter().enumerate() {
            let Some(at) = self.mark(&outline, &points, &corners, notch) else {
                self.losses
                    .push(Loss::at(&name, "a notch", "it lies far from the outline"));
                continue;
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

    /// Adds the points and curves of a line; `further` are vertices that must be corners.
    fn line(
        &mut self,
        drawing: &mut PanelBuilder<'_>,
        numbers: &mut Numbers,
        line: &DrawnLine,
        further: &[usize],
    ) -> Built {
        let corners = corners(line, further);
        let count = line.len();
        let at = |k: usize, size: usize| line.in_size(size)[k % count];
        let place = |k: usize| SizedPlaces::new(&|size| at(k, size), self.sizes.len());
        let name = |k: usize| format!("p{}", numbers.points + k + 1);
        let mut points: Vec<PointId> = vec![PointId::default(); count];
        for &k in &corners {
            let rule = self.rules.corner(drawing, &place(k));
            points[k] = drawing.point(name(k), rule);
        }
        for (c, &from) in corners.iter().enumerate() {
            let to = match corners.get(c + 1) {
                Some(&next) => next,
                None if line.is_closed => corners[0] + count,
                None => continue,
            };
            let ends = [from, to % count];
            let frame = self.rules.frame(ends.map(|k| points[k]), &ends.map(&place));
            for k in from + 1..to {
                let k = k % count;
                points[k] = drawing.point(name(k), self.rules.between(&frame, &place(k)));
            }
        }
        numbers.points += count;
        let last = corners.len() - usize::from(!line.is_closed);
        let mut edges = Vec::new();
        for (c, &from) in corners.iter().enumerate().take(last) {
            let next = corners[(c + 1) % corners.len()];
            let to = if next > from { next } else { next + count };
            numbers.edges += 1;
            let name = format!("e{}", numbers.edges);
            let ends = [points[from], points[to % count]];
            let rule = self.curve(drawing, numbers, (from, to), &points, &at);
            edges.push(drawing.edge(name, ends, rule));
        }
        Built {
            edges,
            points,
            corners,
        }
    }

    /// The curve through the vertices from one corner to the next.
    fn curve(
        &mut self,
        drawing: &mut PanelBuilder<'_>,
        numbers: &mut Numbers,
        (from, to): (usize, usize),
        points: &[PointId],
        at: &impl Fn(usize, usize) -> Vec2,
    ) -> CurveRule {
        let sizes = self.sizes.len().max(1);
        let stretch = |size: usize| -> Vec<Vec2> { (from..=to).map(|k| at(k, size)).collect() };
        if (0..sizes).all(|size| is_straight(&stretch(size))) {
            return CurveRule::Line;
        }
        let mut all = Vec::with_capacity(sizes);
        for size in 0..sizes {
            let (handles, overshoots) = spline::handles(&stretch(size));
            if overshoots && size == self.base {
                self.losses.push(Loss::at(
                    &drawing.panel.name,
                    "smoothness of a curve",
                    "its vertices turn back, so straight chords are kept between them",
                ));
            }
            all.push(handles);
        }
        let ends = [from, to];
        let places = ends.map(|k| SizedPlaces::new(&|size| at(k, size), self.sizes.len()));
        let frame = self
            .rules
            .frame(ends.map(|k| points[k % points.len()]), &places);
        let mut handle = |segment: usize, end: usize| {
            numbers.handles += 1;
            let at = |size: usize| all[size.min(sizes - 1)][segment][end];
            let place = SizedPlaces::new(&at, self.sizes.len());
            let rule = self.rules.between(&frame, &place);
            drawing.point(format!("h{}", numbers.handles), rule)
        };
        let segments = to - from;
        let start = handle(0, 0);
        let mut knots = Vec::new();
        for k in 1..segments {
            let before = handle(k - 1, 1);
            let after = handle(k, 0);
            knots.push(Knot {
                before,
                point: points[(from + k) % points.len()],
                after,
            });
        }
        let end = handle(segments - 1, 1);
        CurveRule::Spline {
            handles: [start, end],
            knots,
            to_length: None,
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
            is_straight(&stretch)
        };
        match a != b {
            true if runs_straight(a, b) => Some([a, b]),
            true if runs_straight(b, a) => Some([b, a]),
            _ => None,
        }
    }

    /// The mark of a place on an outline.
    fn mark(
        &self,
        outline: &DrawnLine,
        points: &[PointId],
        corners: &[usize],
        notch: &DrawnNotch,
    ) -> Option<Mark> {
        let vertices = outline.in_size(self.base);
        let place = notch.at;
        if let Some(corner) = corner_of(place, vertices, corners) {
            return Some(Mark::corner(points[corner]));
        }
        let found = nearest(place, vertices).filter(|found| found.distance <= MAX_REACH)?;
        let count = vertices.len();
        let place = found.chord as f64 + found.share;
        let c = corners.iter().rposition(|&corner| corner <= found.chord);
        let c = c.unwrap_or(corners.len() - 1);
        let from = corners[c];
        let next = corners[(c + 1) % corners.len()];
        let to = if next > from { next } else { next + count };
        let [from_place, to_place] = [from, to].map(|k| k as f64);
        let after_from = |place: f64| match place >= from_place {
            true => place,
            false => place + count as f64,
        };
        let along = after_from(place);
        let share = |size: usize| {
            let own = outline.in_size(size);
            // The place of its own in this size, if that lies between the same corners.
            let given = notch.in_sizes.get(size).copied().flatten();
            let found = given.and_then(|at| nearest(at, own));
            let found = found.map(|found| after_from(found.chord as f64 + found.share));
            let along = found.filter(|along| *along <= to_place).unwrap_or(along);
            let length = |a: f64, b: f64| length_between(own, a, b);
            length(from_place, along) / length(from_place, to_place).max(f64::MIN_POSITIVE)
        };
        let ends = [points[from], points[to % count]];
        Some(Mark::between(ends, self.rules.number(SAME, share)))
    }
}

/// The corner of a sew line that a place on the cut line belongs to: it lies on the line of one of the edges
/// that meet there, beyond the corner, or no place is nearer to it than the corner.
fn corner_of(place: Vec2, vertices: &[Vec2], corners: &[usize]) -> Option<usize> {
    let count = vertices.len();
    let beyond = |corner: usize, before: usize| {
        let along = vertices[corner] - vertices[before % count];
        let length = along.norm();
        let out = place - vertices[corner];
        let reach = out.dot(&along) / length;
        let off = (along.perp(&out) / length).abs();
        off <= ON_LINE && reach > ON_LINE && reach <= MAX_REACH
    };
    // Where two edges run on almost straight, a place square to the cut line is as near to their corner as to any
    // other place.
    let nearest = nearest(place, vertices).map_or(0.0, |found| found.distance);
    let is_as_near = |corner: usize| (vertices[corner] - place).norm() <= nearest + AS_NEAR;
    let mut all = corners.iter().copied();
    all.find(|&corner| {
        is_as_near(corner) || beyond(corner, corner + count - 1) || beyond(corner, corner + 1)
    })
}

/// Length of a closed line between two places, each the index of a vertex and the share of the chord after it.
fn length_between(ring: &[Vec2], from: f64, to: f64) -> f64 {
    let count = ring.len();
    let (mut length, mut at) = (0.0, from);
    while at < to {
        let k = at.floor();
        let end = (k + 1.0).min(to);
        let chord = ring[(k as usize + 1) % count] - ring[k as usize % count];
        length += chord.norm() * (end - at);
        at = end;
    }
    length
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
