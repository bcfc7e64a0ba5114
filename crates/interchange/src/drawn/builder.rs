//! Makes a document of drawn pieces.
//!
//! Every vertex becomes a point of the sheet with its place in each size; vertices between two corners become
//! one edge, straight or a spline through them. Edges of the sew line get the allowance that their distance to
//! the cut line shows.

use super::allowance::{Width, distance, nearest, width};
use super::corners::{corners, is_straight};
use super::piece::{DrawnLine, DrawnNotch, DrawnPattern, DrawnPiece, Way};
use super::spline;
use crate::Loss;
use crate::part_names::part_name;
use std::collections::BTreeSet;
use std::sync::Arc;
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::{
    Corner, CurveRule, Edge, Fabric, FabricId, Knot, LineKind, Mark, Name, Notch, Number,
    Operation, OperationKind, PanelBuilder, Pattern, PointId, PointRule, Size, SizeId,
};

/// Coordinates of two sizes that differ by less are one (m).
const SAME: f64 = 1e-9;
/// Largest distance of the ends of a fold line from a vertex of the outline (m).
pub(crate) const ON_VERTEX: f64 = 2e-4;
/// Largest distance of a notch from the line of an edge that it belongs to beyond the corner (m).
const ON_LINE: f64 = 2e-4;
/// Distances from a notch that differ by less count as one (m): at an allowance of 10 mm this is 1 mm along the
/// line, nearer than notches are set to a corner.
const AS_NEAR: f64 = 5e-5;
/// Longest way from the sew line, or from a corner of it, to a notch on the cut line that belongs to it (m).
const MAX_REACH: f64 = 0.06;
/// Difference of the distances along an edge beyond which they may not be a width at all (m).
const MAX_SPREAD: f64 = 0.003;
/// Least turn of a corner at which a bevel is told from a mitre (rad): 30 degrees.
const MIN_BEVEL: f64 = std::f64::consts::PI / 6.0;
/// Largest difference of a bevel from the one that two widths give, as a share of the width.
const NEAR_BEVEL: f64 = 0.02;
/// Widths differ by as much from round ones as coordinates are rounded in files (m).
const EXACT: f64 = 2e-5;
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

/// Adds pieces in one size to a document, as panels after its own; returns contents that were left out.
pub(crate) fn add_pieces(pattern: &mut Pattern, pieces: &[DrawnPiece]) -> Vec<Loss> {
    let panels = pattern.panels.iter().map(|panel| panel.name.clone());
    let sheets = pattern.sheets.iter().map(|sheet| sheet.name.clone());
    let mut builder = Builder {
        names: panels.chain(sheets).collect(),
        pattern: std::mem::take(pattern),
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
        if outline.area(self.base) < 0.0 {
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
            if hole.area(self.base) > 0.0 {
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
        let mut edges = Vec::new();
        for (c, &from) in corners.iter().enumerate().take(last) {
            let next = corners[(c + 1) % corners.len()];
            let to = if next > from { next } else { next + count };
            numbers.edges += 1;
            let name = format!("e{}", numbers.edges);
            let ends = [points[from], points[to % count]];
            let ways: Vec<Way> = (from..to).map(|k| line.way(k % count)).collect();
            let rule = self.curve(drawing, numbers, (from, &ways), &points, &at);
            edges.push(drawing.edge(name, ends, rule));
        }
        Built {
            edges,
            points,
            corners,
        }
    }

    /// The curve from one corner to the next, along the ways from vertex to vertex.
    fn curve(
        &mut self,
        drawing: &mut PanelBuilder<'_>,
        numbers: &mut Numbers,
        (from, ways): (usize, &[Way]),
        points: &[PointId],
        at: &impl Fn(usize, usize) -> Vec2,
    ) -> CurveRule {
        let to = from + ways.len();
        let sizes = self.sizes.len().max(1);
        let given: Option<Vec<[Vec2; 2]>> = ways
            .iter()
            .map(|way| match way {
                Way::Cubic(handles) => Some(*handles),
                Way::Chord | Way::Straight => None,
            })
            .collect();
        let stretch = |size: usize| -> Vec<Vec2> { (from..=to).map(|k| at(k, size)).collect() };
        if given.is_none() && (0..sizes).all(|size| is_straight(&stretch(size))) {
            return CurveRule::Line;
        }
        let mut all = Vec::with_capacity(sizes);
        for size in 0..sizes {
            if let Some(handles) = &given {
                all.push(handles.clone());
                continue;
            }
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
        let mut handle = |segment: usize, end: usize| {
            numbers.handles += 1;
            let rule = self.rule(|size| all[size.min(sizes - 1)][segment][end]);
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
        let chords = outline.chords(self.base);
        let vertices = &chords.points;
        let count = vertices.len();
        let corners: Vec<usize> = built.corners.iter().map(|&k| chords.starts[k]).collect();
        let found: Vec<(Width, f64)> = corners
            .iter()
            .enumerate()
            .map(|(c, &from)| {
                let next = corners[(c + 1) % corners.len()];
                let to = if next > from { next } else { next + count };
                let edge: Vec<Vec2> = (from..=to).map(|k| vertices[k % count]).collect();
                let ways = edge.windows(2).map(|pair| (pair[1] - pair[0]).norm());
                (width(&edge, cut_line), ways.sum())
            })
            .collect();
        let even = found.iter().filter_map(|&(found, length)| match found {
            Width::Even(width) => Some((rounded(width), length)),
            Width::Uneven { .. } => None,
        });
        let usual = longest(&even.collect::<Vec<(f64, f64)>>());
        let uneven = found
            .iter()
            .filter(|(found, _)| matches!(found, Width::Uneven { .. }))
            .count();
        let taken = |found: Width| match found {
            Width::Even(width) => rounded(width),
            // The legs of a dart that is drawn lie at no distance of their own from the cut line.
            Width::Uneven { mean, spread } if spread > MAX_SPREAD && mean > 2.0 * usual => usual,
            Width::Uneven { mean, .. } => rounded(mean),
        };
        let widths: Vec<f64> = found.into_iter().map(|(found, _)| taken(found)).collect();
        if uneven > 0 {
            self.losses.push(Loss {
                count: uneven,
                ..Loss::at(
                    name,
                    "seam allowances of uneven width",
                    "their mean width is taken, or the usual one of the piece where that is beyond all measure",
                )
            });
        }
        drawing.panel.allowance = usual.into();
        let turns = corners.iter().map(|&k| turn(vertices, k));
        let places = corners.iter().map(|&k| distance(vertices[k], cut_line));
        let before = widths.iter().cycle().skip(widths.len().saturating_sub(1));
        let at_corners = turns.zip(places).zip(before);
        let edges = built.edges.iter_mut().zip(&widths);
        for ((edge, &width), ((turn, place), &before)) in edges.zip(at_corners) {
            edge.allowance = (width != usual).then(|| width.into());
            // A mitre comes no nearer to its corner than the allowance, a bevel does.
            let bevel = width * (0.5 * turn).cos();
            let is_bevel = turn > MIN_BEVEL && (place - bevel).abs() <= NEAR_BEVEL * width;
            if is_bevel && (width - before).abs() <= NEAR_BEVEL * width {
                edge.corner.kind = Corner::Bevel;
            }
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
            let is_curve = |k: usize| matches!(outline.way(k % count), Way::Cubic(_));
            let stretch: Vec<Vec2> = (from..=to).map(|k| vertices[k % count]).collect();
            !(from..to).any(is_curve) && is_straight(&stretch)
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
        let chords = outline.chords(self.base);
        let vertices = &chords.points;
        let place = notch.at;
        let on_chords: Vec<usize> = corners.iter().map(|&k| chords.starts[k]).collect();
        if let Some(c) = corner_of(place, vertices, &on_chords) {
            return Some(Mark::corner(points[corners[c]]));
        }
        let found = nearest(place, vertices).filter(|found| found.distance <= MAX_REACH)?;
        let count = vertices.len();
        let place = found.chord as f64 + found.share;
        let c = on_chords.iter().rposition(|&corner| corner <= found.chord);
        let c = c.unwrap_or(corners.len() - 1);
        let ends = [corners[c], corners[(c + 1) % corners.len()]].map(|k| points[k]);
        let from = on_chords[c];
        let next = on_chords[(c + 1) % corners.len()];
        let to = if next > from { next } else { next + count };
        let [from_place, to_place] = [from, to].map(|k| k as f64);
        let after_from = |place: f64| match place >= from_place {
            true => place,
            false => place + count as f64,
        };
        let along = after_from(place);
        let share = |size: usize| {
            let own = &outline.chords(size).points;
            // The place of its own in this size, if that lies between the same corners.
            let given = notch.in_sizes.get(size).copied().flatten();
            let found = given.and_then(|at| nearest(at, own));
            let found = found.map(|found| after_from(found.chord as f64 + found.share));
            let along = found.filter(|along| *along <= to_place).unwrap_or(along);
            let length = |a: f64, b: f64| length_between(own, a, b);
            length(from_place, along) / length(from_place, to_place).max(f64::MIN_POSITIVE)
        };
        Some(Mark::between(ends, self.number(share)))
    }
}

/// The corner of a sew line that a place on the cut line belongs to: it lies on the line of one of the edges
/// that meet there, beyond the corner, or no place is nearer to it than the corner. The corners are indices of
/// vertices; the one that is returned is an index among them. A place on the sew line itself lies beyond none.
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
    let is_on_line = nearest <= ON_LINE;
    corners.iter().position(|&corner| {
        is_as_near(corner)
            || !is_on_line && (beyond(corner, corner + count - 1) || beyond(corner, corner + 1))
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

/// The angle by which a closed line that runs counter-clockwise turns outwards at a vertex (rad); negative at one
/// that turns inwards.
fn turn(ring: &[Vec2], vertex: usize) -> f64 {
    let count = ring.len();
    let at = |k: usize| ring[(vertex + count + k) % count];
    let (a, b) = (at(0) - at(count - 1), at(1) - at(0));
    a.perp(&b).atan2(a.dot(&b))
}

/// A width rounded to a tenth of a millimetre where it is as near to one as coordinates are exact, else to a
/// thousandth.
fn rounded(width: f64) -> f64 {
    let tenth = (width * 1e4).round() / 1e4;
    match (width - tenth).abs() <= EXACT {
        true => tenth,
        false => (width * 1e6).round() / 1e6,
    }
}

/// The value other than 0 that most of a line has, by values with lengths, the first of equals; 0 without one.
fn longest(values: &[(f64, f64)]) -> f64 {
    let length = |value: f64| {
        let own = values.iter().filter(|(other, _)| *other == value);
        own.map(|(_, length)| length).sum::<f64>()
    };
    let mut best = (0.0, 0.0);
    for &(value, _) in values.iter().filter(|(value, _)| *value != 0.0) {
        if length(value) > best.0 {
            best = (length(value), value);
        }
    }
    best.1
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
