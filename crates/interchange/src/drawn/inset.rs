//! Moves a closed line inwards, vertex by vertex, so that marks by the number of a vertex stay.

use toile_geometry::Vec2;

/// Cosine of the angle between two chords above which they count as parallel.
const PARALLEL: f64 = 1.0 - 1e-9;
/// Share of the length of a line whose chords may turn round: those of roundings that are tighter than the
/// distance.
const MAX_TURNED: f64 = 0.1;

/// A closed line that runs counter-clockwise, with each chord moved inwards by a distance (m), chord k from
/// vertex k; each vertex comes to lie where its two chords then meet. `None` if too little is left inside: more
/// than a small share of its chords turned round.
pub(crate) fn inset(ring: &[Vec2], by: impl Fn(usize) -> f64) -> Option<Vec<Vec2>> {
    let n = ring.len();
    let direction = |k: usize| {
        let along = ring[(k + 1) % n] - ring[k % n];
        let length = along.norm();
        (length > 0.0).then(|| along / length)
    };
    // A chord without length takes the direction of the one before or after.
    let before =
        |k: usize| (1..=n).find_map(|back| Some((direction(k + n - back)?, (k + n - back) % n)));
    let after = |k: usize| (0..n).find_map(|on| Some((direction(k + on)?, (k + on) % n)));
    let moved: Option<Vec<Vec2>> = (0..n)
        .map(|k| {
            let (a, of_a) = before(k)?;
            let (b, of_b) = after(k)?;
            let [da, db] = [by(of_a), by(of_b)];
            let left = |d: Vec2| Vec2::new(-d.y, d.x);
            let shift = match a.dot(&b).abs() > PARALLEL {
                true => left(a) * (0.5 * (da + db)),
                false => {
                    // The point p with left(a)·p = da and left(b)·p = db.
                    let (na, nb) = (left(a), left(b));
                    let determinant = na.perp(&nb);
                    Vec2::new(da * nb.y - db * na.y, na.x * db - nb.x * da) / determinant
                }
            };
            Some(ring[k] + shift)
        })
        .collect();
    let moved = moved?;
    let chord = |points: &[Vec2], k: usize| points[(k + 1) % n] - points[k];
    let lengths = (0..n).map(|k| (k, chord(ring, k).norm()));
    let whole: f64 = lengths.clone().map(|(_, length)| length).sum();
    let turned = lengths.filter(|&(k, _)| chord(&moved, k).dot(&chord(ring, k)) <= 0.0);
    let turned: f64 = turned.map(|(_, length)| length).sum();
    (whole > 0.0 && turned <= MAX_TURNED * whole).then_some(moved)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_is_moved_by_the_distance_of_each_side() {
        let ring = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.2], [0.4, 0.6], [0.0, 0.6]].map(Vec2::from);
        let moved = inset(&ring, |k| if k == 4 { 0.0 } else { 0.01 }).unwrap();
        let expected = [
            [0.0, 0.01],
            [0.39, 0.01],
            [0.39, 0.2],
            [0.39, 0.59],
            [0.0, 0.59],
        ];
        for (p, expected) in moved.iter().zip(expected) {
            assert!((p - Vec2::from(expected)).norm() < 1e-12, "{p}");
        }
        assert_eq!(inset(&ring, |_| 0.5), None);
        assert_eq!(inset(&[], |_| 0.01), None);
        assert_eq!(inset(&[Vec2::zeros(); 4], |_| 0.01), None);
    }
}
