//! Dense twins of lines: the points of a twin between the vertices of the line that it belongs to.

use toile_geometry::{Vec2, closest_on_segment};

/// Largest distance of a vertex from the twin of its line (m).
const ON_TWIN: f64 = 5e-5;
/// Points of a twin that lie nearer to a vertex are the vertex (m).
const SAME: f64 = 1e-6;

/// For each vertex of a line the points of its twin between it and the next vertex; `None` if the twin does not run
/// along the line. The twin may start at another vertex of a closed line, and run the other way.
pub(crate) fn between(vertices: &[Vec2], is_closed: bool, twin: &[Vec2]) -> Option<Vec<Vec<Vec2>>> {
    if vertices.len() < 2 || twin.len() < 2 {
        return None;
    }
    walk(vertices, is_closed, twin).or_else(|| {
        let turned: Vec<Vec2> = twin.iter().rev().copied().collect();
        walk(vertices, is_closed, &turned)
    })
}

/// A place on a twin: the number of a chord, and the share of it before the place.
type Place = (usize, f64);

fn walk(vertices: &[Vec2], is_closed: bool, twin: &[Vec2]) -> Option<Vec<Vec<Vec2>>> {
    let count = twin.len();
    let chords = count - usize::from(!is_closed);
    let nearest = |chord: usize, p: Vec2, least: f64| {
        let ends = [twin[chord % count], twin[(chord + 1) % count]];
        let length = (ends[1] - ends[0]).norm();
        let at = closest_on_segment(p, ends);
        let share = if length > 0.0 {
            (at - ends[0]).norm() / length
        } else {
            0.0
        };
        let share = share.max(least);
        (share, (ends[0] + (ends[1] - ends[0]) * share - p).norm())
    };
    let first = (0..if is_closed { chords } else { 1 })
        .map(|chord| (chord, nearest(chord, vertices[0], 0.0)))
        .min_by(|a, b| a.1.1.total_cmp(&b.1.1))
        .filter(|(_, (_, off))| *off <= ON_TWIN)?;
    let start: Place = (first.0, first.1.0);
    let end = match is_closed {
        true => start.0 + chords,
        false => chords - 1,
    };
    let mut places = vec![start];
    let mut at = start;
    for pair in vertices.windows(2) {
        if (pair[1] - pair[0]).norm() > 0.0 {
            let found = |chord: usize| {
                let least = if chord == at.0 { at.1 } else { 0.0 };
                nearest(chord, pair[1], least)
            };
            let mut chord = (at.0..=end).find(|&chord| found(chord).1 <= ON_TWIN)?;
            while chord < end && found(chord + 1).1 < found(chord).1 {
                chord += 1;
            }
            at = (chord, found(chord).0);
        }
        places.push(at);
    }
    let last: Place = (start.0 + count, start.1);
    let follows = places
        .iter()
        .skip(1)
        .copied()
        .chain([if is_closed { last } else { at }]);
    let mut found = Vec::with_capacity(vertices.len());
    for (k, (from, to)) in places.iter().copied().zip(follows).enumerate() {
        let ends = [vertices[k], vertices[(k + 1) % vertices.len()]];
        // A place at the very start of a chord is that chord's first point.
        let points = (from.0 + 1..=to.0).map(|j| twin[j % count]);
        let inner = points.filter(|p| ends.iter().all(|end| (end - p).norm() > SAME));
        found.push(inner.collect());
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(k: i32, count: i32) -> Vec2 {
        let turn = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
        Vec2::new(0.1 * turn.cos(), 0.1 * turn.sin())
    }

    #[test]
    fn points_of_a_twin_lie_between_vertices_wherever_it_starts_and_whichever_way_it_runs() {
        let vertices: Vec<Vec2> = (0..6).map(|k| at(k, 6)).collect();
        let mut twin: Vec<Vec2> = (0..24).map(|k| at(k, 24)).collect();
        let expected = |k: i32| {
            (4 * k + 1..4 * k + 4)
                .map(|j| at(j, 24))
                .collect::<Vec<_>>()
        };
        for turn in [0, 5, 23] {
            twin.rotate_left(turn);
            for _ in 0..2 {
                twin.reverse();
                let found = between(&vertices, true, &twin).unwrap();
                for (k, points) in (0..).zip(&found) {
                    assert_eq!(*points, expected(k), "{turn} {k}");
                }
            }
        }
    }

    #[test]
    fn vertices_between_points_of_the_twin_and_repeats_are_found() {
        let vertices = [[0.0, 0.0], [0.15, 0.0], [0.15, 0.0], [0.3, 0.1]].map(Vec2::from);
        let twin = [[0.0, 0.0], [0.1, 0.0], [0.2, 0.0], [0.3, 0.1]].map(Vec2::from);
        let found = between(&vertices, false, &twin).unwrap();
        assert_eq!(found, [vec![twin[1]], vec![], vec![twin[2]], vec![]]);
        let beside = twin.map(|p| p + Vec2::new(0.0, 1e-3));
        assert_eq!(between(&vertices, false, &beside), None);
        assert_eq!(between(&vertices[..1], true, &twin), None);
    }
}
