//! The drawn shape of a panel: polylines and fills made once from its stage, in the panel's plane.

use super::fill::{Fill, fill};
use super::inside::{chord, roomiest};
use toile_geometry::{Bounds2, Curve, Vec2, ring_area};
use toile_pattern::{EdgeId, LineId, LineKind, Name, NotchId, OperationId, Role, Stage, StageEdge};

/// Share of the chord through the middle of a panel that the grainline takes.
const GRAINLINE_SHARE: f64 = 0.62;

/// The drawn shape of a panel. Lengths and coordinates in metres.
#[derive(Clone, Debug)]
pub struct PanelShape {
    /// Side of the outline, seen along it, on which the cloth lies: 1 left, -1 right.
    pub cloth_side: f64,
    /// Bounding box of the panel with its mirrored half (m).
    pub bounds: Bounds2,
    /// Bounding box of the drafted half (m).
    pub drawn_bounds: Bounds2,
    /// Outline and holes of the drafted half.
    pub rings: Vec<Vec<Vec2>>,
    /// Fill of the drafted half.
    pub fill: Fill,
    /// Fill of the mirrored half of a folded panel.
    pub mirrored_fill: Fill,
    /// Edges of outline and holes of the drafted half.
    pub edges: Vec<EdgeShape>,
    /// Edges of outline and holes of the mirrored half, without legs of darts.
    pub mirrored: Vec<Vec<Vec2>>,
    /// Other edges of the drafted half that operations made, as where the panel was split; each with its
    /// operation.
    pub made: Vec<(OperationId, Vec<Vec2>)>,
    /// Legs of darts: the operation that made them, whether they are on the mirrored half, and the
    /// polyline.
    pub darts: Vec<(OperationId, bool, Vec<Vec2>)>,
    /// Fold and placement lines of pleats: the operation that made them, whether it is a placement line,
    /// and the polyline.
    pub creases: Vec<(OperationId, bool, Vec<Vec2>)>,
    /// Internal lines of the drafted half.
    pub internal_lines: Vec<(LineId, Vec<Vec2>)>,
    /// Internal lines of the mirrored half.
    pub mirrored_lines: Vec<(LineId, Vec<Vec2>)>,
    /// Notches: point on the outline and unit direction inward.
    pub notches: Vec<(NotchId, Vec2, Vec2)>,
    /// Both ends of the grainline, if there is room for one.
    pub grainline: Option<[Vec2; 2]>,
    /// Place of the name, with room round it.
    pub middle: Vec2,
}

/// The drawn shape of an edge.
#[derive(Clone, Debug)]
pub struct EdgeShape {
    /// Identity of the edge.
    pub id: EdgeId,
    /// Length without the mouths of darts (m).
    pub length: f64,
    /// Polylines along the edge: one, or more where darts interrupt it.
    pub lines: Vec<Vec<Vec2>>,
}

impl PanelShape {
    /// Shape of a stage, the panel after its operations; curves are flattened to within a tolerance (m).
    pub fn new(stage: &Stage, tolerance: f64) -> Self {
        let polyline = |curve: &Curve| curve.flatten(tolerance);
        let rings = || std::iter::once(stage.outline()).chain(stage.holes());
        let half = |mirrored| -> Vec<Vec<Vec2>> {
            let halves = rings().map(|ring| half_ring(ring, mirrored, tolerance));
            halves.filter(|ring| !ring.is_empty()).collect()
        };
        let drawn = half(false);
        let outline = stage.outline().iter();
        let bounds = Bounds2::of(outline.flat_map(|edge| polyline(&edge.curve)));
        let drawn_bounds = Bounds2::of(drawn.iter().flatten().copied());
        let middle = roomiest(&drawn, &drawn_bounds);
        let direction = Vec2::new(stage.grain.cos(), stage.grain.sin());
        let mut shape = Self {
            cloth_side: match drawn.first().is_some_and(|ring| ring_area(ring) < 0.0) {
                true => -1.0,
                false => 1.0,
            },
            bounds,
            drawn_bounds,
            fill: fill(&drawn),
            mirrored_fill: fill(&half(true)),
            grainline: chord(&drawn, middle, direction, GRAINLINE_SHARE),
            rings: drawn,
            edges: Vec::new(),
            mirrored: Vec::new(),
            made: Vec::new(),
            darts: Vec::new(),
            creases: Vec::new(),
            internal_lines: Vec::new(),
            mirrored_lines: Vec::new(),
            notches: stage
                .notches
                .iter()
                .map(|notch| (notch.id, notch.point, notch.inward))
                .collect(),
            middle,
        };
        for edge in rings().flatten() {
            shape.edge(edge, polyline(&edge.curve));
        }
        for line in &stage.lines {
            if line.kind != LineKind::Internal {
                continue;
            }
            let points = line.edges.iter().flat_map(|edge| polyline(&edge.curve));
            match line.name {
                Name::Drawn(id) if line.half != 0 => {
                    shape.mirrored_lines.push((id, points.collect()));
                }
                Name::Drawn(id) => shape.internal_lines.push((id, points.collect())),
                Name::Made { .. } if line.half != 0 => {}
                // Fold line or placement line of a pleat.
                Name::Made { by, role, .. } => {
                    let is_placement = role == Role::Placement;
                    shape.creases.push((by, is_placement, points.collect()));
                }
            }
        }
        shape
    }

    fn edge(&mut self, edge: &StageEdge, line: Vec<Vec2>) {
        let id = match edge.name {
            Name::Made {
                by,
                role: Role::Leg,
                ..
            } => {
                return self.darts.push((by, edge.half != 0, line));
            }
            _ if edge.half != 0 => return self.mirrored.push(line),
            Name::Made { by, .. } => return self.made.push((by, line)),
            Name::Drawn(id) => id,
        };
        let length = edge.curve.length();
        match self.edges.iter_mut().find(|known| known.id == id) {
            Some(known) => {
                known.length += length;
                // A spline consists of several curves of one edge: they are drawn as one line.
                match known.lines.last_mut() {
                    Some(last) if last.last() == line.first() => last.extend(&line[1..]),
                    _ => known.lines.push(line),
                }
            }
            None => self.edges.push(EdgeShape {
                id,
                length,
                lines: vec![line],
            }),
        }
    }

    /// Whether a point (m) lies on the drafted half.
    pub fn contains(&self, at: Vec2) -> bool {
        super::inside::contains(&self.rings, at)
    }

    /// The shape of the edge with an identity.
    pub fn edge_shape(&self, id: EdgeId) -> Option<&EdgeShape> {
        self.edges.iter().find(|edge| edge.id == id)
    }
}

impl EdgeShape {
    /// Middle of the edge's longest polyline.
    pub fn middle(&self) -> Option<Vec2> {
        self.lines
            .iter()
            .max_by(|a, b| polyline_length(a).total_cmp(&polyline_length(b)))
            .and_then(|line| along(line, 0.5))
            .map(|(at, _)| at)
    }
}

/// Length of a polyline (m).
fn polyline_length(line: &[Vec2]) -> f64 {
    line.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
}

/// The point at a share of a polyline's length, and the unit direction there.
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

/// The points of one half of a ring, in order from the start of that half.
fn half_ring(ring: &[StageEdge], of_mirrored: bool, tolerance: f64) -> Vec<Vec2> {
    let count = ring.len();
    let reflected = |k: usize| ring[k % count].half != 0;
    let start = (0..count)
        .find(|&k| reflected(k) == of_mirrored && reflected(k + count - 1) != of_mirrored)
        .unwrap_or(0);
    (0..count)
        .map(|k| start + k)
        .filter(|&k| reflected(k) == of_mirrored)
        .flat_map(|k| ring[k % count].curve.flatten(tolerance))
        .collect()
}
