//! Cut-outs of a piece that lie within its outline, apart from each other.

use super::piece::DrawnLine;
use toile_geometry::{Polygon, Vec2};

/// The closed lines that can be cut out within an outline in a size, and those that cross it or each other, or lie
/// outside. An outline that crosses itself decides nothing.
pub(crate) fn sound_holes(
    outline: Vec<Vec2>,
    holes: &[DrawnLine],
    size: usize,
) -> (Vec<DrawnLine>, Vec<DrawnLine>) {
    let mut shape = Polygon::new(outline);
    if holes.is_empty() || !shape.defects().is_empty() {
        return (holes.to_vec(), Vec::new());
    }
    let (mut sound, mut others) = (Vec::new(), Vec::new());
    for hole in holes {
        shape.holes.push(hole.chords(size).points);
        if shape.defects().is_empty() {
            sound.push(hole.clone());
        } else {
            shape.holes.pop();
            others.push(hole.clone());
        }
    }
    (sound, others)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Vec<Vec2> {
        [[low, low], [high, low], [high, high], [low, high]]
            .map(Vec2::from)
            .to_vec()
    }

    #[test]
    fn holes_that_cross_or_lie_outside_are_told_apart() {
        let holes = [(0.1, 0.4), (0.3, 0.6), (0.9, 1.1), (2.0, 3.0), (0.7, 0.8)];
        let holes = holes.map(|(low, high)| DrawnLine::one(square(low, high), true));
        let (sound, others) = sound_holes(square(0.0, 1.0), &holes, 0);
        assert_eq!(sound, [holes[0].clone(), holes[4].clone()]);
        assert_eq!(others, holes[1..4]);
        let crossing = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]].map(Vec2::from);
        let (sound, _) = sound_holes(crossing.to_vec(), &holes, 0);
        assert_eq!(sound.len(), 5);
    }
}
