//! The shape of a panel as drawn: polylines and fills made once from its stage, in the panel's plane.

use super::fill::{Fill, fill};
use super::inside::{chord, roomiest};
use toile_geometry::{Bounds2, Curve, Vec2, ring_area};
use toile_pattern::{EdgeId, LineId, LineKind, Name, NotchId, OperationId, Role, Stage, StageEdge};

/// Part of the chord through the middle of a panel that the grainline takes.
const GRAINLINE_SHARE: f64 = 0.62;

/// One panel as drawn.
#[derive(Clone, Debug)]
pub struct PanelShape {
    /// Side of its outline, seen along it, on which the cloth lies: 1 left, -1 right.
    pub cloth_side: f64,
    /// Least rectangle round the panel, its mirrored half included (m).
    pub bounds: Bounds2,
    /// Least rectangle round the half that is drawn (m).
    pub drawn_bounds: Bounds2,
    /// The half that is drawn, its outline and holes.
    pub rings: Vec<Vec<Vec2>>,
    /// The same, filled.
    pub fill: Fill,
    /// The mirrored half of a folded panel, filled.
    pub mirrored_fill: Fill,
    /// Edges of outline and holes of the half that is drawn.
    pub edges: Vec<EdgeShape>,
    /// Outline of the mirrored half.
    pub mirrored: Vec<Vec<Vec2>>,
    /// Other edges that operations made, as where the panel was split, on the half that is drawn.
    pub made: Vec<(OperationId, Vec<Vec2>)>,
    /// Legs of darts, with the operation that made them; of a mirrored half too.
    pub darts: Vec<(OperationId, bool, Vec<Vec2>)>,
    /// Lines that pleats are folded in, or laid to, with the operation that made them.
    pub creases: Vec<(OperationId, bool, Vec<Vec2>)>,
    /// Lines inside of the half that is drawn.
    pub internal_lines: Vec<(LineId, Vec<Vec2>)>,
    /// The same of the mirrored half.
    pub mirrored_lines: Vec<(LineId, Vec<Vec2>)>,
    /// Notches: place on the outline and unit direction inward.
    pub notches: Vec<(NotchId, Vec2, Vec2)>,
    /// Both ends of the grainline, if there is room for one.
    pub grainline: Option<[Vec2; 2]>,
    /// Where the name stands: a place with room round it.
    pub middle: Vec2,
}

/// One edge as drawn.
#[derive(Clone, Debug)]
pub struct EdgeShape {
    /// Which edge.
    pub id: EdgeId,
    /// Length without dart mouths (m).
    pub length: f64,
    /// Polylines in its direction: one, or more where darts interrupt it.
    pub lines: Vec<Vec<Vec2>>,
}

impl PanelShape {
    /// Draws a stage, curves to within a tolerance (m).
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
                // Where a pleat is folded, and where it is laid to.
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
                // A spline is several curves of one edge: they are drawn as one line.
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

    /// Whether a place (m) lies on the half that is drawn.
    pub fn contains(&self, at: Vec2) -> bool {
        super::inside::contains(&self.rings, at)
    }

    /// The edge with that id.
    pub fn edge_shape(&self, id: EdgeId) -> Option<&EdgeShape> {
        self.edges.iter().find(|edge| edge.id == id)
    }
}

impl EdgeShape {
    /// Its middle, halfway along its longest part.
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

/// The points of one half of a ring, in order from where that half begins.
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
