//! Joins open lines whose ends meet.

use std::collections::{BTreeSet, HashMap};
use toile_geometry::Vec2;

/// Joins open lines to longer ones, in the order in which they follow one another, else by their ends within a gap (in
/// the unit of the points). Returns the lines, each with whether it is closed; a closed one does not repeat its start.
pub(crate) fn joined(lines: Vec<Vec<Vec2>>, gap: f64) -> Vec<(Vec<Vec2>, bool)> {
    let lines: Vec<Vec<Vec2>> = lines.into_iter().filter(|line| !line.is_empty()).collect();
    let mut rest = Rest::new(&lines, gap);
    let mut found = Vec::new();
    let mut next = 0;
    while next < lines.len() {
        if !rest.take(next) {
            next += 1;
            continue;
        }
        let mut last = next;
        let mut line = lines[next].clone();
        let mut is_wide = is_wide(&line, line[0], gap);
        loop {
            let end = line[line.len() - 1];
            let is_shut = is_wide && line.len() > 2 && (end - line[0]).norm() <= gap;
            let Some((k, is_turned)) = rest.next(end, last + 1) else {
                break;
            };
            // A line that has come back to its start takes only what lies there: other sizes may have more of it.
            if is_shut && (k != last + 1 || self::is_wide(&lines[k], end, gap)) {
                break;
            }
            rest.take(k);
            last = k;
            let further = lines[k].iter();
            let further: Vec<Vec2> = match is_turned {
                true => further.rev().copied().collect(),
                false => further.copied().collect(),
            };
            let skip = usize::from((further[0] - end).norm() <= gap);
            is_wide |= self::is_wide(&further, line[0], gap);
            line.extend(further.into_iter().skip(skip));
        }
        let is_closed = is_wide && line.len() > 3 && (line[line.len() - 1] - line[0]).norm() <= gap;
        if is_closed {
            line.pop();
        }
        found.push((line, is_closed));
    }
    found
}

/// Whether a line leaves the neighbourhood of a place.
fn is_wide(line: &[Vec2], place: Vec2, gap: f64) -> bool {
    line.iter().any(|p| (p - place).norm() > gap)
}

/// Lines that are not joined to others yet, found by their ends.
struct Rest<'a> {
    lines: &'a [Vec<Vec2>],
    gap: f64,
    is_taken: Vec<bool>,
    /// Ends of lines that are not taken, by the square of the plane that they lie in: whether it is the far end, and
    /// the number of the line.
    ends: HashMap<[i64; 2], BTreeSet<(bool, usize)>>,
}

impl<'a> Rest<'a> {
    fn new(lines: &'a [Vec<Vec2>], gap: f64) -> Self {
        let mut rest = Self {
            lines,
            gap,
            is_taken: vec![false; lines.len()],
            ends: HashMap::new(),
        };
        for k in 0..lines.len() {
            for is_far in [false, true] {
                let square = rest.square(rest.end(k, is_far));
                rest.ends.entry(square).or_default().insert((is_far, k));
            }
        }
        rest
    }

    fn end(&self, k: usize, is_far: bool) -> Vec2 {
        let line = &self.lines[k];
        line[if is_far { line.len() - 1 } else { 0 }]
    }

    fn square(&self, p: Vec2) -> [i64; 2] {
        [p.x, p.y].map(|x| (x / self.gap).floor() as i64)
    }

    /// Takes a line; `false` if it was taken before.
    fn take(&mut self, k: usize) -> bool {
        if std::mem::replace(&mut self.is_taken[k], true) {
            return false;
        }
        for is_far in [false, true] {
            let square = self.square(self.end(k, is_far));
            if let Some(ends) = self.ends.get_mut(&square) {
                ends.remove(&(is_far, k));
            }
        }
        true
    }

    /// The line that goes on at an end: its number, and whether it is turned round. The one that is wanted comes first,
    /// then those that start there in the order of their numbers, then those that end there.
    fn next(&self, end: Vec2, wanted: usize) -> Option<(usize, bool)> {
        let meets = |k: usize, is_far: bool| (self.end(k, is_far) - end).norm() <= self.gap;
        if self.is_taken.get(wanted) == Some(&false)
            && let Some(is_far) = [false, true]
                .into_iter()
                .find(|&is_far| meets(wanted, is_far))
        {
            return Some((wanted, is_far));
        }
        let [x, y] = self.square(end);
        let around = [-1, 0, 1].into_iter();
        let squares = around.flat_map(|dx| {
            let column = x.saturating_add(dx);
            [-1, 0, 1].map(|dy| [column, y.saturating_add(dy)])
        });
        let firsts = squares.filter_map(|square| {
            let ends = self.ends.get(&square)?;
            ends.iter().find(|&&(is_far, k)| meets(k, is_far)).copied()
        });
        firsts.min().map(|(is_far, k)| (k, is_far))
    }
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
    fn lines_without_length_stay_wherever_they_stand() {
        // A chain whose first and last lines have no length in this size.
        let corners = at(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
        let [a, b, c] = [corners[0], corners[1], corners[2]];
        let chain = vec![
            vec![a, a, a],
            vec![a, b],
            vec![b, c],
            vec![c, a],
            vec![a, a],
        ];
        let apart = vec![vec![a, a, b], vec![b, c], vec![c, a]];
        assert_eq!(joined(chain, 1e-6), [(vec![a, a, a, b, c, a], true)]);
        assert_eq!(joined(apart, 1e-6), [(vec![a, a, b, c], true)]);
        assert_eq!(joined(vec![vec![a, a, a, a]], 1e-6), [(vec![a; 4], false)]);
    }

    #[test]
    fn many_lines_are_joined_quickly() {
        let at = |k: i32| {
            let turn = f64::from(k) / 2e5 * std::f64::consts::TAU;
            Vec2::new(turn.cos(), turn.sin()) * 1e5
        };
        // Every second line first.
        let order = (0..200_000).step_by(2).chain((1..200_000).step_by(2));
        let lines = order.map(|k| vec![at(k), at((k + 1) % 200_000)]).collect();
        let found = joined(lines, 0.02);
        assert_eq!(
            (found.len(), found[0].0.len(), found[0].1),
            (1, 200_000, true)
        );
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
