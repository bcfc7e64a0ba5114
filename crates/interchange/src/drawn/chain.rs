//! Joins open lines whose ends meet.

use toile_geometry::Vec2;

/// Joins open lines to longer ones, in the order in which they follow one another, else by their nearest ends
/// within a gap (in the unit of the points). Returns the lines, each with whether it is closed; a closed one
/// does not repeat its start.
pub(crate) fn joined(lines: Vec<Vec<Vec2>>, gap: f64) -> Vec<(Vec<Vec2>, bool)> {
    let mut rest: Vec<Vec<Vec2>> = lines.into_iter().filter(|line| !line.is_empty()).collect();
    rest.reverse();
    let mut found = Vec::new();
    while let Some(mut line) = rest.pop() {
        while let Some((end, nearest)) = line.last().copied().and_then(|end| {
            let close = line.len() > 2 && (end - line[0]).norm() <= gap;
            let next = next_of(&rest, end, gap).filter(|_| !close)?;
            Some((end, next))
        }) {
            let (k, is_turned) = nearest;
            let mut next = rest.remove(k);
            if is_turned {
                next.reverse();
            }
            let skip = usize::from((next[0] - end).norm() <= gap);
            line.extend(next.into_iter().skip(skip));
        }
        let is_closed = line.len() > 3 && (line[line.len() - 1] - line[0]).norm() <= gap;
        if is_closed {
            line.pop();
        }
        found.push((line, is_closed));
    }
    found
}

/// The line that goes on at an end: its index, and whether it is turned round. The next in order comes first.
fn next_of(rest: &[Vec<Vec2>], end: Vec2, gap: f64) -> Option<(usize, bool)> {
    let starts = |k: &usize| (rest[*k][0] - end).norm() <= gap;
    let ends = |k: &usize| (rest[*k][rest[*k].len() - 1] - end).norm() <= gap;
    let all = || (0..rest.len()).rev();
    let start = all().find(starts).map(|k| (k, false));
    start.or_else(|| all().find(ends).map(|k| (k, true)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(places: &[[f64; 2]]) -> Vec<Vec2> {
        places.iter().copied().map(Vec2::from).collect()
    }

    #[test]
    fn chains_in_order_out_of_order_and_turned_are_closed() {
        let [a, b, c] = [
            at(&[[0.0, 0.0], [1.0, 0.0]]),
            at(&[[1.0, 0.0], [1.0, 1.0], [0.5, 1.2]]),
            at(&[[0.5, 1.2], [0.0, 0.0]]),
        ];
        let ring = at(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.2]]);
        let turned: Vec<Vec2> = b.iter().rev().copied().collect();
        for lines in [
            [a.clone(), b.clone(), c.clone()],
            [a.clone(), c.clone(), b],
            [a, turned, c],
        ] {
            assert_eq!(joined(lines.to_vec(), 1e-6), [(ring.clone(), true)]);
        }
    }

    #[test]
    fn lines_that_do_not_meet_stay_apart() {
        let lines = vec![
            at(&[[0.0, 0.0], [1.0, 0.0]]),
            at(&[[1.1, 0.0], [2.0, 0.0]]),
            Vec::new(),
        ];
        let found = joined(lines.clone(), 0.01);
        assert_eq!(
            found,
            [(lines[0].clone(), false), (lines[1].clone(), false)]
        );
        assert_eq!(joined(lines, 0.2).len(), 1);
    }

    #[test]
    fn two_rings_are_two_lines() {
        let ring = |x: f64| at(&[[x, 0.0], [x + 1.0, 0.0], [x, 1.0], [x, 0.0]]);
        let found = joined(vec![ring(0.0), ring(5.0)], 1e-6);
        assert!(
            found.len() == 2
                && found
                    .iter()
                    .all(|(line, is_closed)| *is_closed && line.len() == 3)
        );
    }
}
