//! What the pattern view draws of each panel: plain polylines and fills in the panel's plane,
//! made anew when the pattern changes.

use crate::fill::{Fill, fill};
use crate::inside::{chord, roomiest};
use crate::space::PanelPoint;
use std::collections::BTreeSet;
use toile_geometry::{Bounds2, Curve, Vec2, ring_area};
use toile_pattern::{
    CurveId, CurveRule, Draft, EdgeId, EdgeOrigin, Evaluation, Mark, Name, OperationKind, Panel,
    PanelId, Pattern, Piece, PieceEdge, PointId, SeamId, SeamOrigin, Sheet,
};

/// Largest distance of a drawn curve from the true one [m]: a tenth of a millimetre, below a
/// pixel until the view is enlarged past 10 pixels a millimetre.
const CURVE_TOLERANCE: f64 = 1e-4;
/// Part of the chord through the middle of a panel that the grainline takes.
const GRAINLINE_SHARE: f64 = 0.62;

/// Everything the pattern view draws.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// The panels, in the pattern's order; those that cannot be drawn are left out.
    pub panels: Vec<PanelDrawing>,
    /// The seams, numbered from 1 in this order.
    pub seams: Vec<SeamDrawing>,
}

/// One panel as drawn.
#[derive(Clone, Debug)]
pub struct PanelDrawing {
    /// Which panel.
    pub id: PanelId,
    /// Its name.
    pub name: String,
    /// How often it is cut, in words; empty for once.
    pub cut: String,
    /// Side of its outline, seen along it, on which the cloth lies: 1 left, -1 right.
    pub cloth_side: f64,
    /// Least rectangle round the panel, its mirrored half included [m].
    pub bounds: Bounds2,
    /// Least rectangle round the half that is drawn [m].
    pub drawn_bounds: Bounds2,
    /// The half that is drawn, filled.
    pub fill: Fill,
    /// The mirrored half of a folded panel, filled.
    pub mirrored_fill: Fill,
    /// Edges of the half that is drawn.
    pub edges: Vec<EdgeDrawing>,
    /// Outline of the mirrored half.
    pub mirrored: Vec<Vec<Vec2>>,
    /// Legs of darts.
    pub darts: Vec<Vec<Vec2>>,
    /// The fold line.
    pub fold: Option<[Vec2; 2]>,
    /// Lines inside.
    pub internal_lines: Vec<Vec<Vec2>>,
    /// Notches: place on the outline and unit direction inward.
    pub notches: Vec<(Vec2, Vec2)>,
    /// Both ends of the grainline, if there is room for one.
    pub grainline: Option<[Vec2; 2]>,
    /// Where the name stands: a place with room round it.
    pub middle: Vec2,
    /// Points that can be taken hold of.
    pub points: Vec<PointDrawing>,
}

/// One edge as drawn.
#[derive(Clone, Debug)]
pub struct EdgeDrawing {
    /// Which edge.
    pub id: EdgeId,
    /// Its name.
    pub name: String,
    /// Length without dart mouths [m].
    pub length: f64,
    /// Polylines in its direction: one, or more where darts interrupt it.
    pub lines: Vec<Vec<Vec2>>,
    /// Control points and the edge ends they shape.
    pub handles: Vec<[Vec2; 2]>,
}

/// What a point is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointRole {
    /// An end of edges.
    Corner,
    /// Shapes a curve.
    Control,
    /// Others are constructed from it.
    Construction,
}

/// One point as drawn.
#[derive(Clone, Debug)]
pub struct PointDrawing {
    /// Which point.
    pub id: PointId,
    /// Its name.
    pub name: String,
    /// Where it is.
    pub at: PanelPoint,
    /// What it is for.
    pub role: PointRole,
}

/// One seam as drawn.
#[derive(Clone, Debug)]
pub struct SeamDrawing {
    /// Which seam.
    pub id: SeamId,
    /// Its name.
    pub name: String,
    /// Number that both sides carry.
    pub number: usize,
    /// Length of each side [m].
    pub lengths: [f64; 2],
    /// Stretches on the panels as drawn.
    pub stretches: Vec<SeamStretch>,
}

/// A stretch of one panel's outline that a seam joins.
#[derive(Clone, Debug)]
pub struct SeamStretch {
    /// The panel.
    pub panel: PanelId,
    /// The edge, unless it lies on the mirrored half.
    pub edge: Option<EdgeId>,
    /// 0 or 1.
    pub side: usize,
    /// Its course, in the direction of the outline.
    pub line: Vec<Vec2>,
}

impl Drawing {
    /// Draws an evaluated pattern and its draft.
    pub fn new(evaluation: &Evaluation, draft: &Draft) -> Self {
        let pattern: &Pattern = evaluation.pattern();
        let mut panels = Vec::new();
        for panel in &pattern.panels {
            let piece = draft
                .pieces
                .iter()
                .find(|piece| piece.id.panel == panel.id && piece.id.copy == 0);
            if let (Some(piece), Some(sheet)) = (piece, pattern.sheet(panel.sheet())) {
                panels.push(draw_panel((panel, sheet), piece, evaluation));
            }
        }
        Self {
            panels,
            seams: draw_seams(draft),
        }
    }

    /// The panel with that id.
    pub fn panel(&self, id: PanelId) -> Option<&PanelDrawing> {
        self.panels.iter().find(|panel| panel.id == id)
    }
}

impl PanelDrawing {
    /// The edge with that id.
    pub fn edge(&self, id: EdgeId) -> Option<&EdgeDrawing> {
        self.edges.iter().find(|edge| edge.id == id)
    }

    /// The point with that id.
    pub fn point(&self, id: PointId) -> Option<&PointDrawing> {
        self.points.iter().find(|point| point.id == id)
    }
}

impl EdgeDrawing {
    /// Its middle, halfway along.
    pub fn middle(&self) -> Option<Vec2> {
        self.lines
            .iter()
            .max_by(|a, b| polyline_length(a).total_cmp(&polyline_length(b)))
            .and_then(|line| along(line, 0.5))
            .map(|(at, _)| at)
    }
}

/// Length of a polyline [m].
fn polyline_length(line: &[Vec2]) -> f64 {
    line.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
}

/// Place at a share of a polyline's length, and the unit direction there.
pub fn along(line: &[Vec2], share: f64) -> Option<(Vec2, Vec2)> {
    let mut left = polyline_length(line) * share;
    for w in line.windows(2) {
        let way = w[1] - w[0];
        let length = way.norm();
        if length >= left && length > 0.0 {
            return Some((w[0] + way * (left / length), way / length));
        }
        left -= length;
    }
    None
}

fn reflected(edge: &PieceEdge) -> bool {
    edge.origin.half != 0
}

fn polyline(curve: &Curve) -> Vec<Vec2> {
    curve.flatten(CURVE_TOLERANCE)
}

/// The points of one half of a ring, in order from where that half begins.
fn half_ring(ring: &[PieceEdge], of_mirrored: bool) -> Vec<Vec2> {
    let count = ring.len();
    let start = (0..count)
        .find(|&k| {
            reflected(&ring[k]) == of_mirrored
                && reflected(&ring[(k + count - 1) % count]) != of_mirrored
        })
        .unwrap_or(0);
    (0..count)
        .map(|k| &ring[(start + k) % count])
        .filter(|edge| reflected(edge) == of_mirrored)
        .flat_map(|edge| polyline(&edge.curve))
        .collect()
}

fn draw_panel(
    (panel, sheet): (&Panel, &Sheet),
    piece: &Piece,
    evaluation: &Evaluation,
) -> PanelDrawing {
    let rings = || std::iter::once(&piece.outline).chain(&piece.holes);
    let half = |mirrored| -> Vec<Vec<Vec2>> {
        let halves = rings().map(|ring| half_ring(ring, mirrored));
        halves.filter(|ring| !ring.is_empty()).collect()
    };
    let drawn = half(false);
    let bounds = Bounds2::of(piece.outline.iter().flat_map(|edge| polyline(&edge.curve)));
    let drawn_bounds = Bounds2::of(drawn.iter().flatten().copied());
    let middle = roomiest(&drawn, &drawn_bounds);
    let direction = Vec2::new(piece.grain.cos(), piece.grain.sin());
    let place = |id: PointId| evaluation.point(id);
    let mut drawing = PanelDrawing {
        id: panel.id,
        name: panel.name.clone(),
        cut: cut_words(panel),
        cloth_side: match drawn.first().is_some_and(|ring| ring_area(ring) < 0.0) {
            true => -1.0,
            false => 1.0,
        },
        bounds,
        drawn_bounds,
        fill: fill(&drawn),
        mirrored_fill: fill(&half(true)),
        edges: Vec::new(),
        mirrored: Vec::new(),
        darts: Vec::new(),
        fold: fold(panel).and_then(|[a, b]| Some([place(a)?, place(b)?])),
        internal_lines: piece
            .internal_lines
            .iter()
            .map(|line| line.curves.iter().flat_map(polyline).collect())
            .collect(),
        notches: piece.notches.iter().map(|n| (n.point, n.inward)).collect(),
        grainline: chord(&drawn, middle, direction, GRAINLINE_SHARE),
        middle,
        points: draw_points(panel, sheet, &place),
    };
    for edge in rings().flatten() {
        draw_edge(&mut drawing, (panel, sheet), edge, &place);
    }
    drawing
}

/// Both corners of the stretch that lies on the fold.
fn fold(panel: &Panel) -> Option<[PointId; 2]> {
    panel
        .operations
        .iter()
        .find_map(|operation| match &operation.kind {
            OperationKind::Fold {
                ends: [Mark::Corner(Name::Drawn(a)), Mark::Corner(Name::Drawn(b))],
                ..
            } => Some([*a, *b]),
            _ => None,
        })
}

/// Handles of a curve with the points they shape.
fn handles(sheet: &Sheet, curve: CurveId) -> Vec<[PointId; 2]> {
    let Some(curve) = sheet.curve(curve) else {
        return Vec::new();
    };
    let CurveRule::Spline { handles, knots, .. } = &curve.rule else {
        return Vec::new();
    };
    let inner = knots
        .iter()
        .flat_map(|knot| [[knot.point, knot.before], [knot.point, knot.after]]);
    let ends = [[curve.ends[0], handles[0]], [curve.ends[1], handles[1]]];
    ends.into_iter().chain(inner).collect()
}

fn draw_edge(
    drawing: &mut PanelDrawing,
    (panel, sheet): (&Panel, &Sheet),
    edge: &PieceEdge,
    place: &impl Fn(PointId) -> Option<Vec2>,
) {
    let line = polyline(&edge.curve);
    let id = match edge.origin.name {
        Name::Made { .. } => return drawing.darts.push(line),
        Name::Drawn(_) if edge.origin.half != 0 => return drawing.mirrored.push(line),
        Name::Drawn(edge) => edge,
    };
    if let Some(known) = drawing.edges.iter_mut().find(|known| known.id == id) {
        known.length += edge.curve.length();
        known.lines.push(line);
        return;
    }
    let Some(of_panel) = panel.edge(id) else {
        return;
    };
    drawing.edges.push(EdgeDrawing {
        id,
        name: of_panel.name.clone(),
        length: edge.curve.length(),
        lines: vec![line],
        handles: handles(sheet, of_panel.curve)
            .into_iter()
            .filter_map(|[end, control]| Some([place(end)?, place(control)?]))
            .collect(),
    });
}

fn draw_points(
    panel: &Panel,
    sheet: &Sheet,
    place: &impl Fn(PointId) -> Option<Vec2>,
) -> Vec<PointDrawing> {
    let mut corners = BTreeSet::new();
    let mut controls: BTreeSet<PointId> = BTreeSet::new();
    for edge in panel.edges() {
        corners.extend(edge.ends);
        controls.extend(handles(sheet, edge.curve).iter().map(|pair| pair[1]));
    }
    let mut points = Vec::new();
    for point in &sheet.points {
        let role = if corners.contains(&point.id) {
            PointRole::Corner
        } else if controls.contains(&point.id) {
            PointRole::Control
        } else {
            PointRole::Construction
        };
        if let Some(at) = place(point.id) {
            points.push(PointDrawing {
                id: point.id,
                name: point.name.clone(),
                at: PanelPoint(at),
                role,
            });
        }
    }
    points
}

fn cut_words(panel: &Panel) -> String {
    match (panel.cut.quantity, panel.cut.mirrored, fold(panel)) {
        (0, ..) => "not cut".into(),
        (1, _, None) => String::new(),
        (1, _, Some(_)) => "cut on the fold".into(),
        (n, true, _) => format!("cut {n}, mirrored"),
        (n, false, Some(_)) => format!("cut {n} on the fold"),
        (n, false, None) => format!("cut {n}"),
    }
}

fn draw_seams(draft: &Draft) -> Vec<SeamDrawing> {
    let mut seams: Vec<SeamDrawing> = Vec::new();
    for seam in &draft.seams {
        let SeamOrigin::Seam(id) = seam.id else {
            continue;
        };
        let mut drawing = SeamDrawing {
            id,
            name: seam.name.clone(),
            number: seams.len() + 1,
            lengths: [0.0; 2],
            stretches: Vec::new(),
        };
        for (side, spans) in seam.sides.iter().enumerate() {
            for span in spans {
                let Some(piece) = draft.pieces.get(span.piece) else {
                    continue;
                };
                let all = piece.outline.iter().chain(piece.holes.iter().flatten());
                let Some(edge) = all.into_iter().nth(span.edge) else {
                    continue;
                };
                drawing.lengths[side] += edge.curve.length() * (span.to - span.from).abs();
                if piece.id.copy == 0 {
                    drawing.stretches.push(SeamStretch {
                        panel: piece.id.panel,
                        edge: match edge.origin {
                            EdgeOrigin {
                                name: Name::Drawn(edge),
                                half: 0,
                            } => Some(edge),
                            _ => None,
                        },
                        side,
                        line: stretch(&edge.curve, span.from, span.to),
                    });
                }
            }
        }
        seams.push(drawing);
    }
    seams
}

/// The part of a curve between two shares of its length, always in the curve's own direction.
fn stretch(curve: &Curve, from: f64, to: f64) -> Vec<Vec2> {
    let length = curve.length();
    let at = |share: f64| curve.parameter_at_length(length * share.clamp(0.0, 1.0));
    polyline(&curve.between(at(from.min(to)), at(from.max(to))))
}
