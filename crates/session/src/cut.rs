//! Pieces as they are cut: flattened outlines with their seam allowance.

use toile_geometry::{Curve, Polygon, Vec2, wound_region};
use toile_pattern::{DartId, EdgeOrigin, Piece, PieceEdge};

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
}

fn ring<'a>(edges: impl IntoIterator<Item = &'a PieceEdge>) -> SewnRing {
    let mut ring = SewnRing {
        points: Vec::new(),
        allowance: Vec::new(),
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
fn dart_of(edge: &PieceEdge) -> Option<(DartId, bool)> {
    match edge.origin {
        EdgeOrigin::DartLeg {
            dart, reflected, ..
        } => Some((dart, reflected)),
        EdgeOrigin::Edge { .. } => None,
    }
}

/// The line a piece is cut along, without holes [m]: the sewn outline, darts closed, grown by each
/// edge's allowance, with mitred corners.
///
/// It is the union of the outline, a rectangle outside each segment, and a kite at each outer
/// corner, so that narrow necks and tight curves come out whole.
pub(crate) fn cut_outline(piece: &Piece) -> Polygon {
    let mut sewn = ring(&with_closed_darts(&piece.outline));
    if sewn.allowance.iter().all(|&a| a == 0.0) {
        return Polygon::new(sewn.points);
    }
    if toile_geometry::ring_area(&sewn.points) < 0.0 {
        sewn.points.reverse();
        // The segment that started at a point now ends there.
        sewn.allowance.reverse();
        sewn.allowance.rotate_left(1);
    }
    let count = sewn.points.len();
    let normal = |k: usize| {
        let along = sewn.points[(k + 1) % count] - sewn.points[k];
        Vec2::new(along.y, -along.x)
            .try_normalize(0.0)
            .unwrap_or_default()
    };
    let mut loops = vec![sewn.points.clone()];
    for k in 0..count {
        let (p, q) = (sewn.points[k], sewn.points[(k + 1) % count]);
        let width = sewn.allowance[k];
        if width > 0.0 {
            let out = normal(k) * width;
            loops.push(vec![p + out, q + out, q, p]);
        }
        let before = (k + count - 1) % count;
        loops.extend(corner(
            p,
            [normal(before), normal(k)],
            [sewn.allowance[before], width],
        ));
    }
    let whole = wound_region(&loops);
    let largest = whole
        .into_iter()
        .max_by(|a, b| a.area().abs().total_cmp(&b.area().abs()));
    Polygon::new(largest.map_or(sewn.points, |polygon| polygon.outer))
}

/// The cloth outside an outer corner between two allowances, counter-clockwise.
fn corner(p: Vec2, normals: [Vec2; 2], widths: [f64; 2]) -> Option<Vec<Vec2>> {
    let [n, m] = normals;
    let turn = n.perp(&m);
    if turn <= 1e-9 || widths[0].max(widths[1]) == 0.0 {
        return None;
    }
    let (a, b) = (p + n * widths[0], p + m * widths[1]);
    // Both offset lines meet where n.x = n.p + widths[0] and m.x = m.p + widths[1].
    let reach = Vec2::new(
        widths[0] * m.y - widths[1] * n.y,
        widths[1] * n.x - widths[0] * m.x,
    ) / turn;
    let longest = LONGEST_MITRE * widths[0].max(widths[1]);
    if reach.norm() <= longest {
        return Some(vec![p, a, p + reach, b]);
    }
    Some(vec![p, a, b])
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
                    origin: EdgeOrigin::Edge {
                        edge: EdgeId(k as u32),
                        reflected: false,
                    },
                    curve: Curve::Line {
                        start: point(k),
                        end: point(k + 1),
                    },
                    seam_allowance: allowances[k],
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
            piece.outline[1 + leg].origin = EdgeOrigin::DartLeg {
                dart: DartId(0),
                reflected: false,
                leg: leg as u8,
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
