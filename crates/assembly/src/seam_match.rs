//! Points that both sides of a seam must share: corners, ends of spans and notches, matched across each seam
//! until nothing changes.
//!
//! # Decided with
//! - [`crate::sampling`] (`link_intervals`, `grade`): stretches that share their number; how many;
//! - [`crate::sampling`] (`gathered_intervals`): gathered edges;
//! - [`crate::mesh::stitches`]: pairs of samples as vertices of the mesh;
//! - [`crate::morph`](mod@crate::morph) (`fractions`): samples kept under an edit of the pattern;
//! - [`toile_pattern::SEAM_TOLERANCE`]: how much lengths may differ;
//! - [`crate::seam_match::SeamChains::pair_gap`], [`crate::seam_match::as_shares`]: edges of different
//!   length: shares of the way along each side.

use crate::edges::EdgeTable;
use crate::{AssemblyError, Diagnostic};
use toile_geometry::{Curve, Vec2};
use toile_pattern::{Draft, DraftSeam, DraftSpan};

/// Points of the two sides that are nearer than this fraction of the edge length are merged.
const MERGE: f64 = 0.35;
/// Ends of spans on one edge that are nearer than this fraction of the edge length are merged.
const SNAP: f64 = 0.1;
/// Distance that a notch must keep from other points, relative to the edge length.
const NOTCH_CLEARANCE: f64 = 1.0;
/// Number of rounds after which seams that still require new points are refused.
const MAX_ROUNDS: usize = 64;

/// A point of an edge that must be a vertex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    /// Index into the edge table.
    pub edge: usize,
    /// Arc-length fraction.
    pub fraction: f64,
}

/// A span of an edge in a chain, the sequence of spans on one side of a seam.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeSpan {
    pub edge: usize,
    pub from: f64,
    pub to: f64,
    /// Start and end as fractions of the chain's length.
    start: f64,
    end: f64,
}

/// A position on a chain that must have vertices: one node, or two where spans join.
#[derive(Clone, Debug)]
pub(crate) struct Station {
    /// Position as a fraction of the chain's length.
    pub place: f64,
    /// Span and node that identify the station permanently.
    key: (usize, usize),
    /// All nodes at the station.
    pub nodes: Vec<usize>,
}

/// The chains of a seam with the stations matched so far.
#[derive(Clone, Debug)]
pub(crate) struct SeamChains {
    /// Index into the draft's seams.
    pub seam: usize,
    pub sides: [Vec<EdgeSpan>; 2],
    /// Length of each chain (m).
    pub lengths: [f64; 2],
    pairs: Vec<[(usize, usize); 2]>,
}

/// All nodes, and those of each edge in the order of their fractions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Nodes {
    pub all: Vec<Node>,
    pub on_edge: Vec<Vec<usize>>,
}

impl Nodes {
    fn insert(&mut self, edge: usize, fraction: f64) -> usize {
        let id = self.all.len();
        self.all.push(Node { edge, fraction });
        let list = &self.on_edge[edge];
        let at = list.partition_point(|&n| self.all[n].fraction < fraction);
        self.on_edge[edge].insert(at, id);
        id
    }

    /// The node nearest to a fraction of an edge, and the distance as a fraction.
    fn nearest(&self, edge: usize, fraction: f64) -> (usize, f64) {
        let mut best = (0, f64::INFINITY);
        for &n in &self.on_edge[edge] {
            let distance = (self.all[n].fraction - fraction).abs();
            if distance < best.1 {
                best = (n, distance);
            }
        }
        best
    }
}

fn seam_error(seam: &DraftSeam, reason: String, remedy: &str) -> AssemblyError {
    AssemblyError::Seam {
        seam: seam.name.clone(),
        reason,
        remedy: remedy.to_owned(),
    }
}

/// Seams between the chosen pieces, and the nodes of all edges.
pub(crate) struct Matching {
    pub nodes: Nodes,
    pub sewings: Vec<SeamChains>,
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads all seams and matches their nodes until nothing changes.
pub(crate) fn match_seams(
    draft: &Draft,
    table: &EdgeTable,
    chosen: &[bool],
    spacing: f64,
) -> Result<Matching, AssemblyError> {
    let mut nodes = Nodes {
        on_edge: vec![Vec::new(); table.edges.len()],
        ..Nodes::default()
    };
    for edge in 0..table.edges.len() {
        nodes.insert(edge, 0.0);
        nodes.insert(edge, 1.0);
    }
    let mut matching = Matching {
        nodes,
        sewings: Vec::new(),
        diagnostics: Vec::new(),
    };
    for (index, seam) in draft.seams.iter().enumerate() {
        matching.add_seam(draft, table, chosen, (index, seam), spacing)?;
    }
    matching.settle(draft, table, spacing)?;
    if matching.add_notches(draft, table, chosen, spacing) {
        matching.settle(draft, table, spacing)?;
    }
    Ok(matching)
}

impl Matching {
    fn add_seam(
        &mut self,
        draft: &Draft,
        table: &EdgeTable,
        chosen: &[bool],
        (index, seam): (usize, &DraftSeam),
        spacing: f64,
    ) -> Result<(), AssemblyError> {
        let mut sides: [Vec<EdgeSpan>; 2] = Default::default();
        let mut lengths = [0.0; 2];
        for (side, spans) in seam.sides.iter().enumerate() {
            for span in spans {
                let Some(edge) = check_span(draft, table, seam, span)? else {
                    continue;
                };
                if !chosen[span.piece] {
                    let name = &draft.pieces[span.piece].name;
                    self.diagnostics.push(Diagnostic::warning(
                        &seam.name,
                        format!("piece \"{name}\" is not sewn, so this seam is left open"),
                        "cut the piece as part of the garment, or remove the seam",
                    ));
                    return Ok(());
                }
                let length = table.edges[edge].length;
                let [from, to] =
                    [span.from, span.to].map(|f| self.end_of_span(edge, f, spacing / length));
                if from == to {
                    continue;
                }
                let start = lengths[side];
                lengths[side] += (to - from).abs() * length;
                sides[side].push(EdgeSpan {
                    edge,
                    from,
                    to,
                    start,
                    end: lengths[side],
                });
            }
            if sides[side].is_empty() {
                return Err(seam_error(
                    seam,
                    "one side has no length".to_owned(),
                    "give both sides at least one span",
                ));
            }
            as_shares(&mut sides[side], lengths[side]);
        }
        self.sewings.push(SeamChains {
            seam: index,
            sides,
            lengths,
            pairs: Vec::new(),
        });
        Ok(())
    }

    /// Ensures that there is a node at the end of a span, and returns the node's fraction. `spacing` is the
    /// edge length as a fraction of the edge.
    fn end_of_span(&mut self, edge: usize, fraction: f64, spacing: f64) -> f64 {
        let fraction = fraction.clamp(0.0, 1.0);
        let (near, distance) = self.nodes.nearest(edge, fraction);
        let node = if distance <= (SNAP * spacing).min(0.25) {
            near
        } else {
            self.nodes.insert(edge, fraction)
        };
        self.nodes.all[node].fraction
    }

    /// Adds notches that are not too near to another node; returns whether any was added.
    fn add_notches(
        &mut self,
        draft: &Draft,
        table: &EdgeTable,
        chosen: &[bool],
        spacing: f64,
    ) -> bool {
        let mut added = false;
        for (index, piece) in draft.pieces.iter().enumerate() {
            if !chosen[index] {
                continue;
            }
            for notch in &piece.notches {
                if !(notch.point.x.is_finite() && notch.point.y.is_finite()) {
                    continue;
                }
                let Some((edge, fraction)) = nearest_on_piece(table, index, notch.point) else {
                    continue;
                };
                let clear = NOTCH_CLEARANCE * spacing / table.edges[edge].length;
                if self.nodes.nearest(edge, fraction).1 > clear {
                    self.nodes.insert(edge, fraction);
                    added = true;
                }
            }
        }
        added
    }

    /// Gives every node a partner across every seam that it lies on.
    fn settle(
        &mut self,
        draft: &Draft,
        table: &EdgeTable,
        spacing: f64,
    ) -> Result<(), AssemblyError> {
        for _ in 0..MAX_ROUNDS {
            let before = self.nodes.all.len();
            for sewing in &mut self.sewings {
                sewing.pair_up(&mut self.nodes, spacing);
            }
            if self.nodes.all.len() == before {
                return Ok(());
            }
            let limit = 200 * table.edges.len() + 10_000;
            if self.nodes.all.len() > limit {
                break;
            }
        }
        let seam = &draft.seams[self.sewings.last().map_or(0, |s| s.seam)];
        Err(seam_error(
            seam,
            "the points its neighbours ask for never settle".to_owned(),
            "check for seams that sew one span to shifted copies of itself",
        ))
    }
}

/// Converts lengths along a chain to fractions of its total length.
fn as_shares(spans: &mut [EdgeSpan], total: f64) {
    for stretch in spans.iter_mut() {
        stretch.start /= total;
        stretch.end /= total;
    }
    if let Some(last) = spans.last_mut() {
        last.end = 1.0;
    }
}

fn check_span(
    draft: &Draft,
    table: &EdgeTable,
    seam: &DraftSeam,
    span: &DraftSpan,
) -> Result<Option<usize>, AssemblyError> {
    let Some(piece) = draft.pieces.get(span.piece) else {
        let reason = format!("piece {} does not exist", span.piece);
        return Err(seam_error(seam, reason, "sew edges that exist"));
    };
    let count: usize = piece.outline.len() + piece.holes.iter().map(Vec::len).sum::<usize>();
    if span.edge >= count {
        let reason = format!("piece \"{}\" has no edge {}", piece.name, span.edge);
        return Err(seam_error(seam, reason, "sew edges that exist"));
    }
    if !(span.from.is_finite() && span.to.is_finite()) {
        let reason = "a span has no finite ends".to_owned();
        return Err(seam_error(seam, reason, "give fractions from 0 to 1"));
    }
    let flat = (span.from.clamp(0.0, 1.0) - span.to.clamp(0.0, 1.0)).abs() < 1e-9;
    Ok((!flat).then(|| table.first[span.piece] + span.edge))
}

/// Edge and arc-length fraction of the outline point that is nearest to a point.
fn nearest_on_piece(table: &EdgeTable, piece: usize, point: Vec2) -> Option<(usize, f64)> {
    // Edges in the order of a lower bound of their distance: once a point is nearer than the bound of the
    // remaining edges, those are not sampled.
    let mut edges: Vec<(f64, usize)> = table
        .of_piece(piece)
        .map(|edge| (least_distance(&table.edges[edge].curve, point), edge))
        .collect();
    edges.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut best: Option<(f64, usize, f64)> = None;
    for (least, edge) in edges {
        if best.is_some_and(|b| least > b.0) {
            break;
        }
        let count = 64;
        for k in 0..=count {
            let fraction = f64::from(k) / f64::from(count);
            let distance = (table.edges[edge].point(fraction) - point).norm();
            // Of equally near points, the first along the outline.
            if best.is_none_or(|b| distance < b.0 || (distance == b.0 && edge < b.1)) {
                best = Some((distance, edge, fraction));
            }
        }
    }
    let (_, edge, coarse) = best?;
    let (mut low, mut high) = (
        (coarse - 1.0 / 64.0).max(0.0),
        (coarse + 1.0 / 64.0).min(1.0),
    );
    for _ in 0..40 {
        let third = (high - low) / 3.0;
        let distance = |f: f64| (table.edges[edge].point(f) - point).norm();
        if distance(low + third) < distance(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    Some((edge, 0.5 * (low + high)))
}

/// A lower bound of the distance from a point to a curve (m): the distance to the bounding box of its
/// defining points, reduced for rounding; zero for arcs, which may leave that box.
fn least_distance(curve: &Curve, point: Vec2) -> f64 {
    if matches!(curve, Curve::Arc { .. }) {
        return 0.0;
    }
    let (mut low, mut high) = (curve.start(), curve.start());
    for p in curve.defining_points() {
        (low, high) = (low.inf(&p), high.sup(&p));
    }
    let rounding = 1e-9;
    (point - point.sup(&low).inf(&high)).norm() - rounding
}

impl EdgeSpan {
    fn place_of(&self, fraction: f64) -> f64 {
        self.start + (self.end - self.start) * (fraction - self.from) / (self.to - self.from)
    }

    fn fraction_at(&self, place: f64) -> f64 {
        self.from + (self.to - self.from) * (place - self.start) / (self.end - self.start)
    }
}

impl SeamChains {
    /// Stations of one side in walking order.
    pub fn stations(&self, nodes: &Nodes, side: usize) -> Vec<Station> {
        let mut stations: Vec<Station> = Vec::new();
        for (index, stretch) in self.sides[side].iter().enumerate() {
            let (low, high) = (stretch.from.min(stretch.to), stretch.from.max(stretch.to));
            let mut inside: Vec<usize> = nodes.on_edge[stretch.edge]
                .iter()
                .copied()
                .filter(|&n| (low..=high).contains(&nodes.all[n].fraction))
                .collect();
            if stretch.from > stretch.to {
                inside.reverse();
            }
            for (k, &node) in inside.iter().enumerate() {
                if k == 0
                    && let Some(joint) = stations.last_mut()
                {
                    joint.nodes.push(node);
                    continue;
                }
                stations.push(Station {
                    place: stretch.place_of(nodes.all[node].fraction),
                    key: (index, node),
                    nodes: vec![node],
                });
            }
        }
        stations
    }

    /// Index pairs of matched stations, in walking order.
    pub fn matched(&self, sides: [&[Station]; 2]) -> Vec<[usize; 2]> {
        let find = |side: usize, key| sides[side].iter().position(|s: &Station| s.key == key);
        let mut found: Vec<[usize; 2]> = self
            .pairs
            .iter()
            .filter_map(|pair| Some([find(0, pair[0])?, find(1, pair[1])?]))
            .collect();
        found.sort_unstable();
        found
    }

    fn pair_up(&mut self, nodes: &mut Nodes, spacing: f64) {
        let a = self.stations(nodes, 0);
        let b = self.stations(nodes, 1);
        if self.pairs.is_empty() {
            let ends = [[0, 0], [a.len() - 1, b.len() - 1]];
            self.pairs = ends.map(|[i, j]| [a[i].key, b[j].key]).to_vec();
        }
        let known = self.matched([&a, &b]);
        for gap in known.windows(2) {
            self.pair_gap(nodes, [&a, &b], [gap[0], gap[1]], spacing);
        }
    }

    /// Matches the stations between two matched pairs, adding nodes on the side that lacks one.
    fn pair_gap(
        &mut self,
        nodes: &mut Nodes,
        sides: [&[Station]; 2],
        [low, high]: [[usize; 2]; 2],
        spacing: f64,
    ) {
        let share = |side: usize, k: usize| {
            let (from, to) = (sides[side][low[side]].place, sides[side][high[side]].place);
            (sides[side][k].place - from) / (to - from)
        };
        let length = |side: usize| {
            self.lengths[side] * (sides[side][high[side]].place - sides[side][low[side]].place)
        };
        let mean = 0.5 * (length(0) + length(1));
        let mut near: Vec<(f64, usize, usize)> = Vec::new();
        for i in low[0] + 1..high[0] {
            for j in low[1] + 1..high[1] {
                let distance = (share(0, i) - share(1, j)).abs() * mean;
                if distance <= MERGE * spacing {
                    near.push((distance, i, j));
                }
            }
        }
        near.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
        let mut chosen = vec![low, high];
        for (_, i, j) in near {
            let fits = chosen
                .iter()
                .all(|c| (c[0] < i && c[1] < j) || (c[0] > i && c[1] > j));
            if fits {
                chosen.push([i, j]);
            }
        }
        chosen.sort_unstable();
        for &[i, j] in &chosen[1..chosen.len() - 1] {
            self.pairs.push([sides[0][i].key, sides[1][j].key]);
        }
        for between in chosen.windows(2) {
            for side in 0..2 {
                let other = 1 - side;
                for k in between[0][side] + 1..between[1][side] {
                    let place = |s: usize, w: usize| sides[s][between[w][s]].place;
                    let along =
                        (sides[side][k].place - place(side, 0)) / (place(side, 1) - place(side, 0));
                    let target = place(other, 0) + along * (place(other, 1) - place(other, 0));
                    let key = self.new_station(nodes, other, target);
                    let own = sides[side][k].key;
                    self.pairs
                        .push(if side == 0 { [own, key] } else { [key, own] });
                }
            }
        }
    }

    fn new_station(&self, nodes: &mut Nodes, side: usize, place: f64) -> (usize, usize) {
        let spans = &self.sides[side];
        let index = spans
            .iter()
            .position(|s| place < s.end)
            .unwrap_or(spans.len() - 1);
        let stretch = &spans[index];
        (
            index,
            nodes.insert(stretch.edge, stretch.fraction_at(place)),
        )
    }
}
