//! Pieces as they are cut: flattened outlines with their seam allowance, and what these leave out.

use toile_geometry::{Curve, Polygon, Vec2, wound_region};
use toile_pattern::{
    Code, Diagnostic, Draft, EdgeOrigin, LineKind, Name, OperationId, Panel, Pattern, Piece,
    PieceEdge, Place, Severity,
};

/// Flattened curves stay this near to the drawn ones [m].
const FLATNESS: f64 = 1e-4;
/// A corner of the cut line reaches no farther from the seam's corner than this times the
/// allowance; sharper corners are cut off.
const LONGEST_MITRE: f64 = 2.5;

/// A piece's outline as straight segments: the line that is sewn, and the allowance beside each
/// segment.
struct SewnRing {
    points: Vec<Vec2>,
    /// Width of cloth beside the segment that starts at each point [m].
    allowance: Vec<f64>,
    /// What each segment is a part of.
    origin: Vec<EdgeOrigin>,
}

fn ring<'a>(edges: impl IntoIterator<Item = &'a PieceEdge>) -> SewnRing {
    let mut ring = SewnRing {
        points: Vec::new(),
        allowance: Vec::new(),
        origin: Vec::new(),
    };
    for edge in edges {
        let points = edge.curve.flatten(FLATNESS);
        for &p in points.iter().take(points.len().saturating_sub(1)) {
            if ring
                .points
                .last()
                .is_none_or(|last| (last - p).norm() > 1e-9)
            {
                ring.points.push(p);
                ring.allowance.push(edge.seam_allowance.max(0.0));
                ring.origin.push(edge.origin);
            }
        }
    }
    ring
}

/// The line a piece is sewn along, holes included [m]. Curves are flattened to 0.1 mm.
pub(crate) fn sewn_outline(piece: &Piece) -> Polygon {
    Polygon {
        outer: ring(&piece.outline).points,
        holes: piece.holes.iter().map(|hole| ring(hole).points).collect(),
    }
}

/// The edges of an outline with every dart's mouth closed by a straight edge: the cloth inside a
/// dart is not cut away. The mouth has the allowance of the edge it interrupts.
fn with_closed_darts(edges: &[PieceEdge]) -> Vec<PieceEdge> {
    let Some(first) = edges.iter().position(|edge| dart_of(edge).is_none()) else {
        return edges.to_vec();
    };
    let mut closed: Vec<PieceEdge> = Vec::with_capacity(edges.len());
    // From an edge that is no leg, so that no dart is met half-way.
    for edge in edges[first..].iter().chain(&edges[..first]) {
        match (dart_of(edge), closed.last_mut()) {
            (Some(dart), Some(last)) if dart_of(last) == Some(dart) => {
                last.curve = Curve::Line {
                    start: last.curve.start(),
                    end: edge.curve.end(),
                };
            }
            (Some(_), Some(last)) => {
                let seam_allowance = last.seam_allowance;
                closed.push(PieceEdge {
                    seam_allowance,
                    ..edge.clone()
                });
            }
            _ => closed.push(edge.clone()),
        }
    }
    closed
}

/// The dart an edge is a leg of, and on which half of a folded panel.
fn dart_of(edge: &PieceEdge) -> Option<(OperationId, u8)> {
    let (dart, _) = edge.origin.leg()?;
    Some((dart, edge.origin.half))
}

/// The sewn outline with closed darts, as it is drawn.
fn closed_ring(piece: &Piece) -> SewnRing {
    ring(&with_closed_darts(&piece.outline))
}

impl SewnRing {
    /// The same counter-clockwise.
    fn counter_clockwise(mut self) -> Self {
        if toile_geometry::ring_area(&self.points) < 0.0 {
            self.points.reverse();
            // The segment that started at a point now ends there.
            self.allowance.reverse();
            self.allowance.rotate_left(1);
            self.origin.reverse();
            self.origin.rotate_left(1);
        }
        self
    }

    /// The segments before and after a point.
    fn beside(&self, k: usize) -> [usize; 2] {
        let count = self.points.len();
        [(k + count - 1) % count, k]
    }

    /// The outward normal of a segment.
    fn normal(&self, k: usize) -> Vec2 {
        let along = self.points[(k + 1) % self.points.len()] - self.points[k];
        Vec2::new(along.y, -along.x)
            .try_normalize(0.0)
            .unwrap_or_default()
    }

    /// The cut line's corner at a point.
    fn corner(&self, k: usize) -> Option<Corner> {
        let beside = self.beside(k);
        Corner::new(
            beside.map(|k| self.normal(k)),
            beside.map(|k| self.allowance[k]),
        )
    }
}

/// The line a piece is cut along, without holes [m]: the sewn outline, darts closed, grown by each
/// edge's allowance, with mitred corners.
///
/// It is the union of the outline, a rectangle outside each segment, and a kite at each outer
/// corner, so that narrow necks and tight curves come out whole.
pub(crate) fn cut_outline(piece: &Piece) -> Polygon {
    let drawn = closed_ring(piece);
    if drawn.allowance.iter().all(|&a| a == 0.0) {
        return Polygon::new(drawn.points);
    }
    let sewn = drawn.counter_clockwise();
    let count = sewn.points.len();
    let mut loops = vec![sewn.points.clone()];
    for k in 0..count {
        let (p, q) = (sewn.points[k], sewn.points[(k + 1) % count]);
        let width = sewn.allowance[k];
        if width > 0.0 {
            let out = sewn.normal(k) * width;
            loops.push(vec![p + out, q + out, q, p]);
        }
        loops.extend(sewn.corner(k).map(|corner| corner.cloth(p)));
    }
    let whole = wound_region(&loops);
    let largest = whole
        .into_iter()
        .max_by(|a, b| a.area().abs().total_cmp(&b.area().abs()));
    Polygon::new(largest.map_or(sewn.points, |polygon| polygon.outer))
}

/// An outer corner between two allowances, seen from the seam's corner [m].
struct Corner {
    /// Where the offset line of the segment before it ends.
    before: Vec2,
    /// Where that of the segment after it begins.
    after: Vec2,
    /// Where both offset lines meet.
    tip: Vec2,
    /// The wider allowance.
    width: f64,
}

impl Corner {
    /// Nothing where the outline turns inwards or not at all.
    fn new(normals: [Vec2; 2], widths: [f64; 2]) -> Option<Self> {
        let [n, m] = normals;
        let turn = n.perp(&m);
        let width = widths[0].max(widths[1]);
        if turn <= 1e-9 || width == 0.0 {
            return None;
        }
        // Both offset lines meet where n.x = n.p + widths[0] and m.x = m.p + widths[1].
        let tip = Vec2::new(
            widths[0] * m.y - widths[1] * n.y,
            widths[1] * n.x - widths[0] * m.x,
        ) / turn;
        Some(Self {
            before: n * widths[0],
            after: m * widths[1],
            tip,
            width,
        })
    }

    /// Whether it is too sharp for a mitre, so that it is cut off.
    fn is_cut_off(&self) -> bool {
        self.tip.norm() > LONGEST_MITRE * self.width
    }

    /// The cloth outside it, counter-clockwise.
    fn cloth(&self, p: Vec2) -> Vec<Vec2> {
        match self.is_cut_off() {
            true => vec![p, p + self.before, p + self.after],
            false => vec![p, p + self.before, p + self.tip, p + self.after],
        }
    }
}

/// What the cut lines of a draft do not do as drawn: corners that are cut off, and holes whose
/// seam allowance is left out. Each is found once for all copies of a panel. A draft with errors
/// is not looked at.
pub(crate) fn cut_findings(pattern: &Pattern, draft: &Draft) -> Vec<Diagnostic> {
    let first = draft.pieces.iter().filter(|piece| piece.id.copy == 0);
    first
        .flat_map(|piece| piece_findings(pattern, piece))
        .collect()
}

/// The same of one piece.
pub(crate) fn piece_findings(pattern: &Pattern, piece: &Piece) -> Vec<Diagnostic> {
    let mut found = sharp_corners(pattern, piece);
    found.extend(bare_holes(pattern, piece));
    found
}

fn sharp_corners(pattern: &Pattern, piece: &Piece) -> Vec<Diagnostic> {
    let id = piece.id.panel;
    let Some(panel) = pattern.panel(id) else {
        return Vec::new();
    };
    let sewn = closed_ring(piece).counter_clockwise();
    let mut seen: Vec<[String; 2]> = Vec::new();
    let mut found = Vec::new();
    for k in 0..sewn.points.len() {
        let Some(corner) = sewn.corner(k).filter(Corner::is_cut_off) else {
            continue;
        };
        let origins = sewn.beside(k).map(|k| sewn.origin[k]);
        let [mut one, mut other] = origins.map(|origin| edge_words(panel, origin));
        if one > other {
            std::mem::swap(&mut one, &mut other);
        }
        // A folded panel has each corner twice.
        if seen.contains(&[one.clone(), other.clone()]) {
            continue;
        }
        let corner_words = match one == other {
            true if origins[0] != origins[1] => format!("the corner of {one} at the fold"),
            true => format!("a corner of {one}"),
            false => format!("the corner of {one} and {other}"),
        };
        seen.push([one, other]);
        found.push(Diagnostic::new(
            Severity::Warning,
            Code::SharpCorner,
            match origins[1].name {
                Name::Drawn(edge) => Place::Edge(id, edge),
                Name::Made { by, .. } => Place::Operation(id, by),
            },
            format!(
                "panel {:?}: {corner_words} is too sharp for its seam allowance of {:.0} mm, which would reach {:.0} mm beyond it: it is cut off there",
                panel.name,
                corner.width * 1e3,
                corner.tip.norm() * 1e3,
            ),
            "blunt the corner, or lessen the seam allowance of its edges",
        ));
    }
    found
}

fn edge_words(panel: &Panel, origin: EdgeOrigin) -> String {
    match origin.name {
        Name::Drawn(edge) => match panel.edge(edge) {
            Some(edge) => format!("edge {:?}", edge.name),
            None => edge.to_string(),
        },
        Name::Made { by, .. } => match panel.operations.iter().find(|o| o.id == by) {
            Some(operation) => format!("{} {:?}", operation.kind.word(), operation.name),
            None => by.to_string(),
        },
    }
}

fn bare_holes(pattern: &Pattern, piece: &Piece) -> Vec<Diagnostic> {
    let id = piece.id.panel;
    let as_drawn =
        |edge: &&PieceEdge| matches!(edge.origin.name, Name::Drawn(_)) && edge.origin.half == 0;
    let panel = pattern.panel(id);
    let mut holes = panel
        .into_iter()
        .flat_map(|panel| &panel.lines)
        .filter(|line| line.kind == LineKind::Hole);
    let mut found = Vec::new();
    for hole in &piece.holes {
        let line = holes.next();
        let widths = hole.iter().filter(as_drawn).map(|edge| edge.seam_allowance);
        let widest = widths.fold(0.0, f64::max);
        if widest <= 0.0 {
            continue;
        }
        let place = line.map_or(Place::Panel(id), |line| Place::Line(id, line.id));
        let words = pattern.describe(&place);
        found.push(Diagnostic::new(
            Severity::Warning,
            Code::HoleAllowance,
            place,
            format!(
                "{words}: its seam allowance of {:.0} mm is left out: a marker shows the line the hole is sewn along and none to cut",
                widest * 1e3
            ),
            "cut the hole by hand, that much inside its seam line, or give its edges an allowance of 0",
        ));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_pattern::{EdgeId, PanelId, PieceId, Worn};

    fn piece(corners: &[[f64; 2]], allowances: &[f64]) -> Piece {
        let point = |k: usize| Vec2::from(corners[k % corners.len()]);
        Piece {
            id: PieceId {
                panel: PanelId(0),
                copy: 0,
            },
            name: "piece".into(),
            outline: (0..corners.len())
                .map(|k| PieceEdge {
                    origin: EdgeOrigin::drawn(EdgeId(k as u32)),
                    curve: Curve::Line {
                        start: point(k),
                        end: point(k + 1),
                    },
                    seam_allowance: allowances[k],
                    corner: toile_pattern::Corner::Mitre,
                })
                .collect(),
            holes: Vec::new(),
            internal_lines: Vec::new(),
            notches: Vec::new(),
            grain: 0.0,
            fabric: 0,
            worn: Worn::Automatic,
            sewn: true,
        }
    }

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]];

    #[test]
    fn a_rectangle_grows_by_each_edges_allowance() {
        let cut = cut_outline(&piece(&SQUARE, &[0.02, 0.01, 0.01, 0.0]));
        assert!(
            (cut.area().abs() - 0.41 * 0.33).abs() < 1e-9,
            "{}",
            cut.area()
        );
        let bounds = cut.bounds();
        assert!((bounds.min - Vec2::new(0.0, -0.02)).norm() < 1e-9);
        assert!((bounds.max - Vec2::new(0.41, 0.31)).norm() < 1e-9);
    }

    #[test]
    fn winding_does_not_matter() {
        let mut turned = SQUARE;
        turned.reverse();
        // Edge k of the reversed square is edge 2 - k of the square.
        let cut = cut_outline(&piece(&turned, &[0.01, 0.01, 0.02, 0.0]));
        assert!(
            (cut.area().abs() - 0.41 * 0.33).abs() < 1e-9,
            "{}",
            cut.area()
        );
    }

    #[test]
    fn sharp_corners_are_cut_off_and_inner_corners_stay_clean() {
        let spike = [[0.0, 0.0], [1.0, 0.0], [0.0, 0.02]];
        let cut = cut_outline(&piece(&spike, &[0.01; 3]));
        assert!(cut.bounds().max.x < 1.03);
        let hook = [
            [0.0, 0.0],
            [0.3, 0.0],
            [0.3, 0.3],
            [0.2, 0.3],
            [0.2, 0.1],
            [0.0, 0.1],
        ];
        let cut = cut_outline(&piece(&hook, &[0.01; 6]));
        assert!((cut.area().abs() - (0.32 * 0.12 + 0.12 * 0.2)).abs() < 1e-9);
        assert_eq!(cut.outer.len(), 6);
    }

    #[test]
    fn the_cloth_inside_a_dart_is_not_cut_away() {
        let mouth = [
            [0.0, 0.0],
            [0.18, 0.0],
            [0.2, 0.1],
            [0.22, 0.0],
            [0.4, 0.0],
            [0.4, 0.3],
            [0.0, 0.3],
        ];
        let mut piece = piece(&mouth, &[0.02, 0.0, 0.0, 0.02, 0.02, 0.02, 0.02]);
        for leg in 0..2 {
            piece.outline[1 + leg].origin = EdgeOrigin {
                name: Name::Made {
                    by: OperationId(0),
                    role: toile_pattern::Role::Leg,
                    index: leg as u16,
                },
                half: 0,
            };
        }
        let whole = 0.44 * 0.34;
        assert!((cut_outline(&piece).area().abs() - whole).abs() < 1e-9);
        // Wherever the outline starts.
        piece.outline.rotate_left(2);
        assert!((cut_outline(&piece).area().abs() - whole).abs() < 1e-9);
        assert!(sewn_outline(&piece).area() < 0.4 * 0.3 - 1e-3);
    }

    #[test]
    fn without_allowance_the_outline_is_cut_as_drawn() {
        let cut = cut_outline(&piece(&SQUARE, &[0.0; 4]));
        assert_eq!(cut, sewn_outline(&piece(&SQUARE, &[0.0; 4])));
    }
}
