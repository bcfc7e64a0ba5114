//! Mirror images among pieces, and pieces halved along their fold.

use toile_geometry::{Bounds2, Polygon, Vec2, intersection, total_area};
use toile_pattern::{EdgeOrigin, Name, Piece};

/// Outlines that differ by less than this part of their area are the same.
const SAME_SHAPE: f64 = 1e-4;
/// Directions that differ by less are the same [rad].
const SAME_WAY: f64 = 1e-6;

/// The side of a line that is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HalfPlane {
    /// On the line [m].
    pub at: Vec2,
    /// Unit, to the side that is kept.
    pub inward: Vec2,
}

/// The fold of an unfolded piece: a line between its edges and their reflections, if it has any.
pub(crate) fn fold_of(piece: &Piece) -> Option<HalfPlane> {
    let mut best: Option<(f64, HalfPlane)> = None;
    for one in &piece.outline {
        let EdgeOrigin {
            name: name @ Name::Drawn(_),
            half: 0,
        } = one.origin
        else {
            continue;
        };
        let twin = piece
            .outline
            .iter()
            .find(|other| other.origin == EdgeOrigin { name, half: 1 });
        let Some(twin) = twin else { continue };
        let ends = [
            (one.curve.start(), twin.curve.end()),
            (one.curve.end(), twin.curve.start()),
        ];
        for (p, q) in ends {
            let across = p - q;
            let apart = across.norm();
            if apart > best.map_or(1e-6, |b| b.0) {
                let half = HalfPlane {
                    at: (p + q) * 0.5,
                    inward: across / apart,
                };
                best = Some((apart, half));
            }
        }
    }
    best.map(|b| b.1)
}

impl HalfPlane {
    /// Whether the line runs along a direction [rad].
    pub fn runs_along(&self, direction: f64) -> bool {
        let (sin, cos) = direction.sin_cos();
        self.inward.dot(&Vec2::new(cos, sin)).abs() < SAME_WAY
    }

    /// How far inside a point lies [m].
    fn depth(&self, point: Vec2) -> f64 {
        (point - self.at).dot(&self.inward)
    }

    /// Whether a point is kept, the line included.
    pub fn keeps(&self, point: Vec2) -> bool {
        self.depth(point) >= -1e-6
    }

    /// The largest part of a polygon that is kept.
    pub fn cut(&self, polygon: &Polygon) -> Polygon {
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

    /// The parts of a line of points that are kept.
    pub fn cut_line(&self, points: &[Vec2]) -> Vec<Vec<Vec2>> {
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

/// An outline with its grain along +x and its box at the origin.
pub(crate) fn straightened(outline: &Polygon, grain: f64) -> Polygon {
    let straight = outline.rotated(-grain);
    straight.translated(-straight.bounds().min)
}

/// Whether one straightened outline is the other turned over across the grain.
pub(crate) fn are_mirror_images(a: &Polygon, b: &Polygon) -> bool {
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

    #[test]
    fn mirror_images_are_told_from_equals() {
        let hook = polygon(&[[0.0, 0.0], [0.5, 0.0], [0.5, 0.1], [0.2, 0.3], [0.0, 0.3]]);
        let turned = polygon(&[[0.0, 0.0], [0.2, 0.0], [0.5, 0.2], [0.5, 0.3], [0.0, 0.3]]);
        assert!(are_mirror_images(&hook, &turned));
        assert!(!are_mirror_images(&hook, &hook));
        let kite = polygon(&[[0.0, 0.1], [0.3, 0.0], [0.4, 0.1], [0.3, 0.2]]);
        assert!(are_mirror_images(&kite, &kite));
        let quarter = straightened(&hook.rotated(0.7), 0.7);
        assert!(are_mirror_images(&quarter, &turned));
    }

    #[test]
    fn halves_keep_one_side_of_the_fold() {
        let half = HalfPlane {
            at: Vec2::new(0.0, 0.2),
            inward: Vec2::new(0.0, 1.0),
        };
        let kite = polygon(&[[0.0, 0.2], [0.3, 0.0], [0.4, 0.2], [0.3, 0.4]]);
        let kept = half.cut(&kite);
        assert!((kept.area() - 0.5 * kite.area()).abs() < 1e-8);
        assert!(kept.bounds().min.y > 0.2 - 1e-8);
        let line = [[0.0, 0.1], [0.1, 0.3], [0.2, 0.3], [0.3, 0.1], [0.3, 0.5]];
        let line = line.map(Vec2::from);
        let parts = half.cut_line(&line);
        assert_eq!(parts.len(), 2);
        assert!((parts[0][0] - Vec2::new(0.05, 0.2)).norm() < 1e-12);
        assert_eq!(parts[1].last(), Some(&line[4]));
        assert!(half.runs_along(std::f64::consts::PI) && !half.runs_along(0.1));
    }
}
