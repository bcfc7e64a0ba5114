//! A drafted piece as a seam line: allowances, corners and darts as the cut line takes them.
//!
//! # Decided with
//! - [`toile_pattern::Panel`], [`toile_pattern::EdgeCorner`]: allowance and corners in the document;
//! - [`toile_pattern::PieceEdge`]: the same on the draft;
//! - [`crate::options::CutOptions`]: a block added to every width;
//! - [`crate::corner::Corner`]: corners as the cut line takes them;
//! - [`crate::dart::caps`], [`crate::seams::Plane::grain`], [`crate::piece::CutPiece::grain_arrow`]
//!   (`drawing.rs`): a dart's mouth; the grain as cut and drawn;
//! - [`toile_pattern::press_arrows`]: which way a dart is pressed;
//! - [`toile_pattern::Evaluation`] (`panels.rs`, `edge`), [`toile_pattern::check_draft`]: an edge's own width
//!   or that of its panel; a negative one refused.
//!
//! The compiler asks for a new kind of corner here and in `corner`. Allowance and grain in the window:
//! `inspector.rs`, `canvas/allowance.rs`, `tools/panel.rs`, `canvas/panel_shape.rs`. In markers: crate
//! `marker`, `pieces.rs`; of worn cloth: crate `session`, `setup.rs`.
//! Width of a new panel: crate `pattern`, `plan/trace.rs` (`ALLOWANCE`).

use crate::{Corner, CutOptions, Dart, MITRE_LIMIT, SeamEdge, SeamLine};
use std::f64::consts::FRAC_PI_8;
use toile_geometry::{Curve, Vec2, ring_area};
use toile_pattern::{Corner as Asked, EdgeOrigin, MitreLimit, Piece, PieceEdge};

/// A seam line and, for each loop, the names of its edges: the outline, then each hole.
#[derive(Clone, Debug, Default)]
pub(crate) struct NamedSeam {
    pub line: SeamLine,
    pub names: Vec<Vec<EdgeOrigin>>,
    /// Loops that are sewn but not cut, with the names of their edges: darts inside the piece.
    pub sewn_only: Vec<(Vec<SeamEdge>, Vec<EdgeOrigin>)>,
}

impl NamedSeam {
    /// Loops with the names of their edges: the outline, the holes, then the loops that are sewn and not cut.
    pub fn loops(&self) -> impl Iterator<Item = (&[SeamEdge], &[EdgeOrigin])> {
        let cut = std::iter::once(&self.line.outline).chain(&self.line.holes);
        let only = self.sewn_only.iter().map(|(edges, names)| (edges, names));
        let all = cut.zip(&self.names).chain(only);
        all.map(|(edges, names)| (edges.as_slice(), names.as_slice()))
    }

    /// The width of the allowance beside an edge (m).
    pub fn width_of(&self, edge: EdgeOrigin) -> f64 {
        let all = self
            .loops()
            .flat_map(|(edges, names)| edges.iter().zip(names));
        let own = all.filter(|(_, name)| **name == edge);
        own.map(|(edge, _)| edge.width).fold(0.0, f64::max)
    }
}

/// The plane in which a piece is cut: enlarged to make up for shrinkage, and seen from the right side of the
/// cloth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    /// Unit vector along the warp, before any turning over.
    warp: Vec2,
    /// Factors by which the piece is enlarged along the warp and the weft.
    factors: [f64; 2],
    /// Whether the piece was drawn from the wrong side, so that x is negated.
    turned: bool,
}

impl Plane {
    pub fn new(piece: &Piece, options: &CutOptions) -> Self {
        let (sin, cos) = piece.grain.sin_cos();
        let corners = piece.outline.iter().flat_map(|e| e.curve.flatten(1e-3));
        let corners: Vec<Vec2> = corners.collect();
        Self {
            warp: Vec2::new(cos, sin),
            factors: options.shrinkage.factors(),
            turned: ring_area(&corners) < 0.0,
        }
    }

    fn is_even(&self) -> bool {
        self.factors[0] == self.factors[1]
    }

    /// A vector of the drawn piece mapped to the plane of cutting.
    pub fn vector(&self, v: Vec2) -> Vec2 {
        let weft = Vec2::new(-self.warp.y, self.warp.x);
        let [along, across] = self.factors;
        let stretched = match self.factors == [1.0, 1.0] {
            true => v,
            false => self.warp * (v.dot(&self.warp) * along) + weft * (v.dot(&weft) * across),
        };
        let x = if self.turned {
            -stretched.x
        } else {
            stretched.x
        };
        Vec2::new(x, stretched.y)
    }

    /// A normal of the drawn piece mapped to the plane of cutting, of length 1.
    pub fn normal(&self, n: Vec2) -> Vec2 {
        let along = self.vector(Vec2::new(-n.y, n.x));
        let sign = if self.turned { -1.0 } else { 1.0 };
        (Vec2::new(along.y, -along.x) * sign)
            .try_normalize(0.0)
            .unwrap_or(n)
    }

    /// Direction of the warp in the plane of cutting (rad); `drawn` is its direction as drawn.
    pub fn grain(&self, drawn: f64) -> f64 {
        match self.turned {
            true => std::f64::consts::PI - drawn,
            false => drawn,
        }
    }

    /// A drawn curve mapped to the plane of cutting. An arc that is stretched unevenly becomes a few cubics,
    /// accurate to 1e-7 of its radius.
    pub fn curves(&self, curve: Curve) -> Vec<Curve> {
        match curve {
            Curve::Arc { bulge, .. } if !self.is_even() && bulge != 0.0 => {
                let count = (4.0 * bulge.atan().abs() / FRAC_PI_8).ceil().max(1.0);
                let part = |k: f64| cubic_of(curve.between(k / count, (k + 1.0) / count));
                (0..count as u32)
                    .map(|k| self.mapped(part(f64::from(k))))
                    .collect()
            }
            curve => vec![self.mapped(curve)],
        }
    }

    fn mapped(&self, curve: Curve) -> Curve {
        match curve {
            Curve::Line { start, end } => Curve::Line {
                start: self.vector(start),
                end: self.vector(end),
            },
            Curve::Arc { start, end, bulge } => Curve::Arc {
                start: self.vector(start),
                end: self.vector(end),
                bulge: if self.turned { -bulge } else { bulge },
            },
            Curve::Quadratic {
                start,
                control,
                end,
            } => Curve::Quadratic {
                start: self.vector(start),
                control: self.vector(control),
                end: self.vector(end),
            },
            Curve::Cubic {
                start,
                controls,
                end,
            } => Curve::Cubic {
                start: self.vector(start),
                controls: controls.map(|p| self.vector(p)),
                end: self.vector(end),
            },
        }
    }
}

/// A short arc as a cubic with the same ends, tangents and middle (Goldapp 1991).
fn cubic_of(arc: Curve) -> Curve {
    let Curve::Arc { start, end, bulge } = arc else {
        return arc;
    };
    // The bulge is the tangent of a quarter of the arc's angle. The handles are 4/3 of the bulge times the
    // radius long; the radius is half the chord over the sine of half the angle.
    let radius = 0.5 * (end - start).norm() / (2.0 * bulge.abs().atan()).sin();
    let handle = 4.0 / 3.0 * bulge.abs() * radius;
    let tangent = |t: f64| arc.derivative(t).try_normalize(0.0).unwrap_or_default();
    Curve::Cubic {
        start,
        controls: [start + tangent(0.0) * handle, end - tangent(1.0) * handle],
        end,
    }
}

/// The seam line of a drafted piece in the plane in which it is cut.
pub(crate) fn seam_of(piece: &Piece, plane: &Plane, options: &CutOptions) -> NamedSeam {
    let mut seam = NamedSeam::default();
    let (outline, names) = edges_of(&piece.outline, plane, options.block);
    seam.line.darts = darts_of(piece, &names);
    seam.line.outline = outline;
    seam.names.push(names);
    for hole in &piece.holes {
        let (edges, names) = edges_of(hole, plane, 0.0);
        match hole.iter().any(|edge| edge.origin.leg().is_some()) {
            true => seam.sewn_only.push((edges, names)),
            false => {
                seam.line.holes.push(edges);
                seam.names.push(names);
            }
        }
    }
    seam
}

fn edges_of(edges: &[PieceEdge], plane: &Plane, block: f64) -> (Vec<SeamEdge>, Vec<EdgeOrigin>) {
    let mut made = Vec::with_capacity(edges.len());
    let mut names = Vec::with_capacity(edges.len());
    for (k, edge) in edges.iter().enumerate() {
        let before = &edges[(k + edges.len() - 1) % edges.len()];
        let is_leg = edge.origin.leg().is_some();
        let width = match is_leg {
            true => 0.0,
            false => edge.seam_allowance.max(0.0) + block,
        };
        for (part, curve) in plane.curves(edge.curve).into_iter().enumerate() {
            let (corner, limit) = match part {
                0 => (corner_of(before, edge), limit_of(edge.corner.limit)),
                _ => (Corner::Mitre, MITRE_LIMIT),
            };
            made.push(SeamEdge {
                curve,
                width,
                corner,
                limit,
            });
            names.push(edge.origin);
        }
    }
    (made, names)
}

/// Limit of the cut line's distance from a corner, over the wider allowance (1). `MitreLimit::None` gives the
/// largest limit that may be asked for, which leaves mitres whole down to a little more than one degree.
fn limit_of(limit: MitreLimit) -> f64 {
    let [least, most] = MitreLimit::RANGE;
    match limit {
        MitreLimit::Widths(widths) => widths.clamp(least, most),
        MitreLimit::None => most,
    }
}

/// Shape of the cut line at the start of an edge. In the document, a shape that treats the two edges unlike
/// refers to the edge after the corner as drawn; on a mirror image this is the edge before. Where an edge
/// meets its own mirror image, such a shape becomes a mitre.
fn corner_of(before: &PieceEdge, edge: &PieceEdge) -> Corner {
    let own_image =
        before.origin.name == edge.origin.name && before.origin.half != edge.origin.half;
    match (edge.corner.kind, edge.reversed) {
        (Asked::Mitre, _) => Corner::Mitre,
        (Asked::Bevel, _) => Corner::Bevel,
        (Asked::Extended, _) => Corner::Extended,
        (Asked::Square | Asked::Mirrored, _) if own_image => Corner::Mitre,
        (Asked::Square, false) => Corner::SquareToNext,
        (Asked::Square, true) => Corner::SquareToPrevious,
        (Asked::Mirrored, false) => Corner::MirroredInNext,
        (Asked::Mirrored, true) => Corner::MirroredInPrevious,
    }
}

/// Darts of an outline: pairs of legs that follow each other.
fn darts_of(piece: &Piece, names: &[EdgeOrigin]) -> Vec<Dart> {
    let count = names.len();
    let mut darts = Vec::new();
    for k in 0..count {
        let next = (k + 1) % count;
        let (Some((by, first)), Some((other, second))) = (names[k].leg(), names[next].leg()) else {
            continue;
        };
        let half = names[k].half;
        let starts = darts.last().is_none_or(|dart: &Dart| dart.legs[1] != k);
        if by != other || half != names[next].half || first == second || !starts {
            continue;
        }
        let drawn = piece.darts.iter().find(|d| d.by == by && d.half == half);
        let pressed = drawn.map_or(0, |dart| dart.pressed.leg());
        darts.push(Dart {
            legs: [k, next],
            pressed: usize::from(pressed != first),
        });
    }
    darts
}
