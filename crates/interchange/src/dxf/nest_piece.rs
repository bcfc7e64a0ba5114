//! The lines of a piece in all sizes as they are written: with as many vertices in each size where they are made of
//! the same parts.

use super::nest::{closed, open};
use toile_cut::{CutPiece, InsideLine, PieceRing};
use toile_geometry::{Curve, Vec2};
use toile_pattern::{Draft, Piece, PieceEdge};

/// Largest distance of a chord from its curve (m).
const FLATNESS: f64 = 4e-5;
/// Largest distance of the chords of a twin from its curve (m).
const TWIN_FLATNESS: f64 = 8e-6;

/// Largest turn between parts of one spline that run on smoothly (rad).
const SMOOTH: f64 = 1e-3;

/// The place of the drill hole that a line inside marks (m), if it marks one.
pub(super) type DrillOf<'f> = &'f dyn Fn(&InsideLine) -> Option<Vec2>;

/// A piece in one size.
pub(super) struct SizedPiece<'d> {
    /// Name of the size, if the pattern has sizes.
    pub size: Option<&'d str>,
    pub draft: &'d Draft,
    /// The piece as it is sewn.
    pub piece: &'d Piece,
    /// The piece as it is cut.
    pub cut: CutPiece,
}

/// A line on its layer, in all sizes.
pub(super) struct LayerLine {
    pub layer: &'static str,
    pub is_closed: bool,
    /// The vertices by size (m).
    pub by_size: Vec<Vec<Vec2>>,
    /// For each size and vertex, whether it is a corner; no sizes for lines whose points are not marked.
    pub is_corner: Vec<Vec<bool>>,
    /// Whether rules are told at its vertices: all sizes have as many.
    pub has_rules: bool,
}

/// The lines of a piece in all sizes.
pub(super) struct NestPiece {
    pub lines: Vec<LayerLine>,
    /// Number of lines that are made of other parts in some sizes.
    pub unlike: usize,
    /// Places of notches on the cut line, and of drill holes, by size (m), where all sizes have as many.
    points: Vec<(&'static str, Vec<Vec<Vec2>>)>,
}

impl NestPiece {
    /// The lines of a piece, given in all sizes, the base size first. Lines inside that mark drill holes are none.
    pub fn new(sized: &[SizedPiece<'_>], is_astm: bool, drill_of: DrillOf<'_>) -> Self {
        let mut nest = Self {
            lines: Vec::new(),
            unlike: 0,
            points: Vec::new(),
        };
        let most = |count: fn(&CutPiece) -> usize| {
            let counts = sized.iter().map(|own| count(&own.cut));
            counts.max().unwrap_or(0)
        };
        for k in 0..most(|cut| cut.cut.len()) {
            let layer = if k == 0 { "1" } else { "11" };
            nest.ring(sized, k, (layer, FLATNESS));
            if k == 0 && is_astm {
                nest.ring(sized, k, ("84", TWIN_FLATNESS));
            }
        }
        let has_allowance = sized.iter().any(|own| {
            let mut edges = own.piece.outline.iter();
            edges.any(|edge| edge.seam_allowance != 0.0)
        });
        if has_allowance {
            nest.sew(sized, ("14", FLATNESS));
            if is_astm {
                nest.sew(sized, ("87", TWIN_FLATNESS));
            }
        }
        for k in 0..most(|cut| cut.inside.len()) {
            let mut own = sized.iter().filter_map(|own| own.cut.inside.get(k));
            if own.all(|line| drill_of(line).is_none()) {
                nest.inside(sized, k);
            }
        }
        let notches = sized.iter().map(|own| {
            let places = own.cut.notches.iter().map(|notch| notch.on_cut);
            places.collect()
        });
        nest.point_list("4", notches.collect());
        let drills = sized.iter().map(|own| drills(&own.cut, drill_of));
        nest.point_list("13", drills.collect());
        nest
    }

    /// The places of points with rules by size (m), with the layers that their numbers stand on.
    pub fn ruled(&self) -> impl Iterator<Item = (&'static str, &Vec<Vec<Vec2>>)> {
        let lines = self.lines.iter().filter(|line| line.has_rules);
        let lines = lines.map(|line| (line.layer, &line.by_size));
        lines.chain(self.points.iter().map(|(layer, by_size)| (*layer, by_size)))
    }

    fn point_list(&mut self, layer: &'static str, by_size: Vec<Vec<Vec2>>) {
        let count = by_size.first().map_or(0, Vec::len);
        match by_size.iter().all(|own| own.len() == count) {
            true => self.points.push((layer, by_size)),
            false => self.unlike += 1,
        }
    }

    /// The closed line of a number of the cut piece.
    fn ring(
        &mut self,
        sized: &[SizedPiece<'_>],
        k: usize,
        (layer, tolerance): (&'static str, f64),
    ) {
        let empty = PieceRing::default();
        let rings = sized.iter().map(|own| own.cut.cut.get(k));
        let rings: Vec<&PieceRing> = rings.map(|ring| ring.unwrap_or(&empty)).collect();
        let is_twin = layer == "84";
        let is_marked = layer == "1";
        if let Some(line) = closed(&rings, tolerance) {
            self.lines.push(LayerLine {
                layer,
                is_closed: true,
                is_corner: match is_marked {
                    true => vec![line.is_corner; sized.len()],
                    false => Vec::new(),
                },
                by_size: line.by_size,
                has_rules: !is_twin,
            });
            return;
        }
        self.unlike += usize::from(!is_twin);
        let mut line = LayerLine {
            layer,
            is_closed: true,
            by_size: Vec::new(),
            is_corner: Vec::new(),
            has_rules: false,
        };
        for ring in rings {
            let alone = closed(&[ring], tolerance);
            let (points, is_corner) = match alone {
                Some(mut own) => (own.by_size.pop().unwrap_or_default(), own.is_corner),
                None => (ring.points.clone(), Vec::new()),
            };
            line.by_size.push(points);
            if is_marked {
                line.is_corner.push(is_corner);
            }
        }
        self.lines.push(line);
    }

    /// The sew line, each edge sampled at equal shares of its length with as many chords in every size.
    fn sew(&mut self, sized: &[SizedPiece<'_>], (layer, tolerance): (&'static str, f64)) {
        let is_twin = layer == "87";
        let edges = sized.first().map_or(0, |own| own.piece.outline.len());
        let is_alike = sized.iter().all(|own| own.piece.outline.len() == edges);
        self.unlike += usize::from(!is_alike && !is_twin);
        let count = |k: usize| {
            let counts = sized
                .iter()
                .map(|own| chords(&own.piece.outline[k].curve, tolerance));
            counts.max().unwrap_or(1)
        };
        let mut line = LayerLine {
            layer,
            is_closed: true,
            by_size: Vec::new(),
            is_corner: Vec::new(),
            has_rules: is_alike && !is_twin,
        };
        for own in sized {
            let (mut points, mut is_corner) = (Vec::new(), Vec::new());
            let outline = &own.piece.outline;
            for (k, edge) in outline.iter().enumerate() {
                let before = &outline[(k + outline.len() - 1) % outline.len()];
                let count = match is_alike {
                    true => count(k),
                    false => chords(&edge.curve, tolerance),
                };
                points.extend(edge.curve.sample(0.0, 1.0, count));
                points.pop();
                is_corner.push(is_corner_between(before, edge));
                is_corner.resize(points.len(), false);
            }
            line.by_size.push(points);
            if !is_twin {
                line.is_corner.push(is_corner);
            }
        }
        self.lines.push(line);
    }

    /// The line of a number inside the piece.
    fn inside(&mut self, sized: &[SizedPiece<'_>], k: usize) {
        let lines = sized.iter().map(|own| own.cut.inside.get(k));
        let names: Vec<_> = lines
            .clone()
            .map(|line| line.map(|line| line.name))
            .collect();
        let points = lines.map(|line| line.map_or(&[][..], |line| &line.points[..]));
        let points: Vec<&[Vec2]> = points.collect();
        let is_alike = names.windows(2).all(|pair| pair[0] == pair[1]);
        self.unlike += usize::from(!is_alike);
        let by_size = match is_alike {
            true => open(&points, FLATNESS),
            false => points.iter().map(|own| own.to_vec()).collect(),
        };
        self.lines.push(LayerLine {
            layer: "8",
            is_closed: false,
            by_size,
            is_corner: Vec::new(),
            has_rules: is_alike,
        });
    }
}

/// The drill holes of a piece: those of its darts, and those that lines inside mark.
pub(super) fn drills(cut: &CutPiece, drill_of: DrillOf<'_>) -> Vec<Vec2> {
    let marked = cut.inside.iter().filter_map(drill_of);
    let own = cut.drills.iter().map(|drill| drill.at);
    marked.chain(own).collect()
}

/// Whether an outline has a corner between two pieces of it: they are of two edges, or do not run on smoothly. A
/// spline is several pieces of one edge.
fn is_corner_between(before: &PieceEdge, after: &PieceEdge) -> bool {
    let [from, to] = [before.curve.derivative(1.0), after.curve.derivative(0.0)];
    let turn = from.perp(&to).atan2(from.dot(&to)).abs();
    before.origin != after.origin || turn > SMOOTH
}

/// Number of chords at equal shares of a curve's length that stay within a tolerance (m).
fn chords(curve: &Curve, tolerance: f64) -> usize {
    match curve {
        Curve::Line { .. } => 1,
        // Parameters and shares of the length differ: twice as many are safe.
        Curve::Arc { .. } | Curve::Quadratic { .. } | Curve::Cubic { .. } => {
            (2 * curve.chord_count(tolerance)).max(2)
        }
    }
}
