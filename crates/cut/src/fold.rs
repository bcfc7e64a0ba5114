//! Pieces halved along their fold, and mirror images among them.

use crate::notch::CutNotch;
use crate::piece::{CutPiece, HalfPlane, InsideLine, PieceRing, PieceSegment};
use toile_geometry::{
    Bounds2, EdgeTree, Polygon, Vec2, intersection, point_segment_distance, total_area,
};

/// Largest difference between outlines that count as equal (share of their area).
const SAME_SHAPE: f64 = 1e-4;
/// Sine of the largest angle between directions that count as equal (1).
const SAME_WAY: f64 = 1e-6;
/// Largest distance from a line at which a point counts as on the line (m): some steps of the grid on which
/// halves are cut.
const ON_LINE: f64 = 1e-6;

impl HalfPlane {
    /// Whether the border of the half-plane runs in this direction (rad) or against it.
    pub fn runs_along(&self, direction: f64) -> bool {
        let (sin, cos) = direction.sin_cos();
        self.inward.dot(&Vec2::new(cos, sin)).abs() < SAME_WAY
    }

    /// Distance of a point from the border of the half-plane, positive inside (m).
    fn depth(&self, point: Vec2) -> f64 {
        (point - self.at).dot(&self.inward)
    }

    /// Whether a point lies inside the half-plane or on its border.
    fn keeps(&self, point: Vec2) -> bool {
        self.depth(point) >= -ON_LINE
    }

    /// The largest part of a polygon inside the half-plane.
    fn cut(&self, polygon: &Polygon) -> Polygon {
        let bounds = polygon.bounds();
        let reach = 1.1 * (bounds.size().norm() + (bounds.centre() - self.at).norm());
        let along = Vec2::new(self.inward.y, -self.inward.x) * reach;
        let inward = self.inward * reach;
        let (a, b) = (self.at - along, self.at + along);
        let half = Polygon::new(vec![a, b, b + inward, a + inward]).oriented();
        let parts = intersection(polygon, &half);
        let largest = parts
            .into_iter()
            .max_by(|a, b| a.area().total_cmp(&b.area()));
        largest.unwrap_or_else(|| Polygon::new(Vec::new()))
    }

    /// The part of the rings inside the half-plane; each segment keeps its name.
    fn cut_rings(&self, rings: &[PieceRing]) -> Vec<PieceRing> {
        let polygon = Polygon {
            outer: rings.first().map_or_else(Vec::new, |r| r.points.clone()),
            holes: rings.iter().skip(1).map(|r| r.points.clone()).collect(),
        };
        let names: Vec<PieceSegment> = rings.iter().flat_map(|r| r.segments.clone()).collect();
        let tree = EdgeTree::of(&polygon);
        let of = |points: &Vec<Vec2>| {
            let count = points.len();
            let segment = |k: usize| {
                let (a, b) = (points[k], points[(k + 1) % count]);
                if [a, b].iter().all(|&p| self.depth(p).abs() < ON_LINE) {
                    return PieceSegment::Fold;
                }
                let middle = (a + b) * 0.5;
                let reach = Bounds2::of([middle]).grown(ON_LINE);
                let mut best = (ON_LINE, PieceSegment::Unknown);
                tree.visit(&mut |bounds| bounds.meets(&reach), &mut |edge| {
                    let off = point_segment_distance(middle, tree.edges()[edge]);
                    if off < best.0 {
                        best = (off, names[edge]);
                    }
                });
                best.1
            };
            PieceRing {
                segments: (0..count).map(segment).collect(),
                points: points.clone(),
            }
        };
        self.cut(&polygon).rings().map(of).collect()
    }

    /// The whole polyline if all of it lies in the half-plane or on its border, else the parts of it that lie
    /// in the half-plane.
    fn kept(&self, points: &[Vec2]) -> Vec<Vec<Vec2>> {
        match points.iter().all(|&p| self.keeps(p)) {
            true => vec![points.to_vec()],
            false => self.cut_line(points),
        }
    }

    /// The parts of a polyline inside the half-plane.
    fn cut_line(&self, points: &[Vec2]) -> Vec<Vec<Vec2>> {
        let mut parts: Vec<Vec<Vec2>> = vec![Vec::new()];
        for (k, &p) in points.iter().enumerate() {
            let here = self.depth(p);
            if k > 0 {
                let before = points[k - 1];
                let there = self.depth(before);
                if (here < 0.0) != (there < 0.0) {
                    let crossing = before + (p - before) * (there / (there - here));
                    if let Some(part) = parts.last_mut() {
                        part.push(crossing);
                    }
                    if here < 0.0 {
                        parts.push(Vec::new());
                    }
                }
            }
            if let Some(part) = parts.last_mut().filter(|_| here >= 0.0) {
                part.push(p);
            }
        }
        parts.retain(|part| part.len() > 1);
        parts
    }
}

impl CutPiece {
    /// The half of the piece on one side of a fold, to be laid on the fold of the cloth.
    #[must_use]
    pub fn halved(&self, half: &HalfPlane) -> Self {
        let cut = half.cut_rings(&self.cut);
        let on_line = |p: &&Vec2| half.depth(**p).abs() < ON_LINE;
        let along = Vec2::new(-half.inward.y, half.inward.x);
        let places = cut.iter().flat_map(|ring| &ring.points).filter(on_line);
        let places = places.map(|p| (p - half.at).dot(&along));
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
            (low.min(at), high.max(at))
        });
        let inside = self.inside.iter().flat_map(|line| {
            half.cut_line(&line.points)
                .into_iter()
                .map(|points| InsideLine {
                    name: line.name,
                    points,
                })
        });
        Self {
            on_fold: (low < high).then(|| [half.at + along * low, half.at + along * high]),
            sew: half.cut_rings(&self.sew),
            inside: inside.collect(),
            fold: None,
            notches: self
                .notches
                .iter()
                .filter(|notch| half.keeps(notch.point) && half.keeps(notch.on_cut))
                .map(|notch| CutNotch {
                    cut: notch.cut.iter().flat_map(|l| half.kept(l)).collect(),
                    ..notch.clone()
                })
                .collect(),
            drills: self
                .drills
                .iter()
                .filter(|drill| half.keeps(drill.at))
                .copied()
                .collect(),
            fold_ticks: self
                .fold_ticks
                .iter()
                .filter(|tick| tick.ends.iter().all(|&at| half.keeps(at)))
                .copied()
                .collect(),
            pressed: self
                .pressed
                .iter()
                .filter(|arrow| half.keeps(arrow.at))
                .copied()
                .collect(),
            cut,
            ..self.clone()
        }
    }

    /// Whether the piece is its own mirror image in the border of `half`, so that it can be cut on a fold.
    pub fn is_symmetric_in(&self, half: &HalfPlane) -> bool {
        let outer = self.outer();
        let mirror = |p: Vec2| p - half.inward * (2.0 * half.depth(p));
        let shared = total_area(&intersection(&outer.mapped(mirror).oriented(), &outer));
        (outer.area() - shared).abs() <= SAME_SHAPE * outer.area()
    }

    /// Whether this piece has the shape of `other` turned over across the grain.
    pub fn is_mirror_image_of(&self, other: &Self) -> bool {
        are_mirror_images(&self.straightened(), &other.straightened())
    }

    /// Outline turned so that the grain runs along +x, and moved so that the lower left corner of its box is
    /// the origin.
    fn straightened(&self) -> Polygon {
        let straight = self.outer().rotated(-self.grain);
        straight.translated(-straight.bounds().min)
    }
}

/// Whether one straightened outline is the mirror image of the other across the grain.
fn are_mirror_images(a: &Polygon, b: &Polygon) -> bool {
    let (one, other): (Bounds2, Bounds2) = (a.bounds(), b.bounds());
    let area = a.area();
    if (one.size() - other.size()).amax() > SAME_SHAPE * one.size().amax()
        || (area - b.area()).abs() > SAME_SHAPE * area
    {
        return false;
    }
    let width = one.max.y;
    let turned = a.mapped(|p| Vec2::new(p.x, width - p.y)).oriented();
    let shared = total_area(&intersection(&turned, b));
    (area - shared).abs() <= SAME_SHAPE * area
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[[f64; 2]]) -> Polygon {
        Polygon::new(points.iter().map(|&p| Vec2::from(p)).collect())
    }

    fn piece(outline: &Polygon, grain: f64) -> CutPiece {
        CutPiece::of_outline("piece", outline, grain)
    }

    #[test]
    fn mirror_images_are_told_from_equals() {
        let hook = polygon(&[[0.0, 0.0], [0.5, 0.0], [0.5, 0.1], [0.2, 0.3], [0.0, 0.3]]);
        let turned = polygon(&[[0.0, 0.0], [0.2, 0.0], [0.5, 0.2], [0.5, 0.3], [0.0, 0.3]]);
        let one = piece(&hook, 0.0);
        assert!(one.is_mirror_image_of(&piece(&turned, 0.0)));
        assert!(!one.is_mirror_image_of(&one));
        let kite = piece(
            &polygon(&[[0.0, 0.1], [0.3, 0.0], [0.4, 0.1], [0.3, 0.2]]),
            0.0,
        );
        assert!(kite.is_mirror_image_of(&kite));
        let quarter = piece(&hook.rotated(0.7), 0.7);
        assert!(quarter.is_mirror_image_of(&piece(&turned, 0.0)));
    }

    #[test]
    fn halves_keep_one_side_of_the_fold() {
        let half = HalfPlane {
            at: Vec2::new(0.0, 0.2),
            inward: Vec2::new(0.0, 1.0),
        };
        let kite = polygon(&[[0.0, 0.2], [0.3, 0.0], [0.4, 0.2], [0.3, 0.4]]);
        let kept = piece(&kite, 0.0).halved(&half);
        assert!((kept.polygon().area() - 0.5 * kite.area()).abs() < 1e-8);
        assert!(kept.bounds().min.y > 0.2 - 1e-8);
        let folded = kept.cut[0].segments.iter();
        assert_eq!(folded.filter(|s| **s == PieceSegment::Fold).count(), 1);
        let [from, to] = kept.on_fold.unwrap();
        assert!(((to - from).norm() - 0.4).abs() < 1e-8);
        let line = [[0.0, 0.1], [0.1, 0.3], [0.2, 0.3], [0.3, 0.1], [0.3, 0.5]];
        let line = line.map(Vec2::from);
        let parts = half.cut_line(&line);
        assert_eq!(parts.len(), 2);
        assert!((parts[0][0] - Vec2::new(0.05, 0.2)).norm() < 1e-12);
        assert_eq!(parts[1].last(), Some(&line[4]));
        assert!(half.runs_along(std::f64::consts::PI) && !half.runs_along(0.1));
    }
}
