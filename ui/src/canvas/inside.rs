//! Finds room inside a panel for its name and grainline.

use toile_geometry::{Bounds2, Vec2, point_segment_distance};

/// Number of steps, in each direction, of the grid of places that [`roomiest`] tries. A finer grid would move
/// the name by less than its own height.
const TRIED: usize = 17;

fn sides(rings: &[Vec<Vec2>]) -> impl Iterator<Item = [Vec2; 2]> {
    rings.iter().flat_map(|ring| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| [*a, *b])
    })
}

/// Whether a point is inside rings, by the even-odd rule. Points on a ring can count as inside or outside:
/// the result only affects the place of a name.
pub fn contains(rings: &[Vec<Vec2>], point: Vec2) -> bool {
    sides(rings).fold(false, |inside, [a, b]| {
        let between = (a.y > point.y) != (b.y > point.y);
        let crossing = || a.x + (point.y - a.y) * (b.x - a.x) / (b.y - a.y);
        inside != (between && point.x < crossing())
    })
}

/// Weight of a place's distance to the outline relative to its distance from the middle (1): of two places
/// with similar room round them, the one nearer to the middle is taken.
const ROOM_OVER_DISTANCE: f64 = 5.0;

/// Of the grid points inside the rings, the one with the most room round it, with a preference for the
/// middle of `bounds`; the middle itself if no grid point is inside.
pub fn roomiest(rings: &[Vec<Vec2>], bounds: &Bounds2) -> Vec2 {
    let size = bounds.max - bounds.min;
    let middle = (bounds.min + bounds.max) * 0.5;
    let mut best = (middle, f64::NEG_INFINITY);
    for row in 1..TRIED {
        for column in 1..TRIED {
            let share = Vec2::new(column as f64, row as f64) / TRIED as f64;
            let place = bounds.min + size.component_mul(&share);
            if !contains(rings, place) {
                continue;
            }
            let room = sides(rings)
                .map(|side| point_segment_distance(place, side))
                .fold(f64::INFINITY, f64::min);
            let worth = room - (place - middle).norm() / ROOM_OVER_DISTANCE;
            if worth > best.1 {
                best = (place, worth);
            }
        }
    }
    best.0
}

/// The middle part, a `share` of the length, of the chord through a point in a direction; `None` if the line
/// has no ring before the point or none behind it.
pub fn chord(rings: &[Vec<Vec2>], through: Vec2, direction: Vec2, share: f64) -> Option<[Vec2; 2]> {
    let mut before = f64::NEG_INFINITY;
    let mut after = f64::INFINITY;
    for [a, b] in sides(rings) {
        let side = b - a;
        let turn = direction.perp(&side);
        if turn == 0.0 {
            continue;
        }
        let way = (a - through).perp(&side) / turn;
        let on_side = (a - through).perp(&direction) / turn;
        if !(0.0..=1.0).contains(&on_side) {
            continue;
        }
        if way > 0.0 {
            after = after.min(way);
        } else {
            before = before.max(way);
        }
    }
    let margin = (after - before) * (1.0 - share) * 0.5;
    (after - before).is_finite().then(|| {
        [
            through + direction * (before + margin),
            through + direction * (after - margin),
        ]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn letter_l() -> Vec<Vec<Vec2>> {
        let corners = [[0, 0], [10, 0], [10, 3], [3, 3], [3, 10], [0, 10]];
        vec![
            corners
                .map(|[x, y]| Vec2::new(f64::from(x), f64::from(y)))
                .to_vec(),
        ]
    }

    #[test]
    fn the_roomiest_place_of_an_l_is_inside_near_its_corner() {
        let rings = letter_l();
        let bounds = Bounds2::of(rings[0].iter().copied());
        let place = roomiest(&rings, &bounds);
        assert!(contains(&rings, place));
        assert!(place.x < 4.0 && place.y < 4.0, "{place}");
    }

    #[test]
    fn a_chord_ends_inside() {
        let rings = letter_l();
        let up = Vec2::new(0.0, 1.0);
        let [low, high] = chord(&rings, Vec2::new(1.0, 1.0), up, 0.5).unwrap();
        assert!((low - Vec2::new(1.0, 2.5)).norm() < 1e-12);
        assert!((high - Vec2::new(1.0, 7.5)).norm() < 1e-12);
        assert_eq!(chord(&rings, Vec2::new(-1.0, 1.0), up, 0.5), None);
    }
}
