//! Joins open lines whose ends meet, with their curves.

use crate::drawn::piece::{DrawnLine, Span};
use toile_geometry::Vec2;

/// Largest number of open lines that are joined; more are no outline.
const MAX_JOINED: usize = 2_000;

/// Joins open lines to longer ones by ends that are nearer than a gap, the next in order first; a line that
/// returns to its start is closed. Closed lines stay as they are.
pub(super) fn joined(lines: Vec<DrawnLine>, gap: f64) -> Vec<DrawnLine> {
    let (mut found, mut rest): (Vec<DrawnLine>, Vec<DrawnLine>) =
        lines.into_iter().partition(|line| line.is_closed);
    if rest.len() > MAX_JOINED {
        found.extend(rest.into_iter().map(|line| returned(line, gap)));
        return found;
    }
    rest.retain(|line| line.len() > 1);
    rest.reverse();
    while let Some(mut line) = rest.pop() {
        loop {
            line = returned(line, gap);
            if line.is_closed {
                break;
            }
            // A line that is begun in its middle goes on at its start, too.
            let Some(next) = next_of(&mut rest, &line, gap) else {
                line.reverse();
                match next_of(&mut rest, &line, gap) {
                    Some(next) => {
                        append(&mut line, next);
                        line.reverse();
                        continue;
                    }
                    None => {
                        line.reverse();
                        break;
                    }
                }
            };
            append(&mut line, next);
        }
        found.push(line);
    }
    found
}

/// A line closed, if it ends nearer to its start than a gap.
pub(super) fn returned(mut line: DrawnLine, gap: f64) -> DrawnLine {
    let [first, last] = ends(&line);
    let count = line.len();
    if line.is_closed || count < 3 && !has_curve(&line) || (first - last).norm() > gap {
        return line;
    }
    line.by_size[0].pop();
    line.spans.truncate(count - 1);
    line.is_closed = true;
    line
}

/// Both ends of a line.
pub(super) fn ends(line: &DrawnLine) -> [Vec2; 2] {
    let points = line.in_size(0);
    let [first, last] = [points.first(), points.last()];
    [first, last].map(|end| end.copied().unwrap_or_default())
}

fn has_curve(line: &DrawnLine) -> bool {
    line.spans.iter().any(|way| matches!(way, Span::Cubic(_)))
}

/// Appends a line that begins at the end of another.
pub(super) fn append(line: &mut DrawnLine, next: DrawnLine) {
    let count = line.len();
    let points = next.by_size.into_iter().next().unwrap_or_default();
    // An open line has a way less than vertices; one that was turned round may name one more.
    line.spans.resize(count.saturating_sub(1), Span::Straight);
    let mut spans = next.spans;
    spans.resize(points.len().saturating_sub(1), Span::Straight);
    line.spans.extend(spans);
    line.by_size[0].extend(points.into_iter().skip(1));
}

/// Takes the line out of others that goes on at the end of one, turned round if need be.
fn next_of(rest: &mut Vec<DrawnLine>, line: &DrawnLine, gap: f64) -> Option<DrawnLine> {
    let [_, end] = ends(line);
    let meets = |k: &usize, of: usize| (ends(&rest[*k])[of] - end).norm() <= gap;
    let all = || (0..rest.len()).rev();
    let start = all().find(|k| meets(k, 0)).map(|k| (k, false));
    let (k, is_turned) = start.or_else(|| all().find(|k| meets(k, 1)).map(|k| (k, true)))?;
    let mut next = rest.remove(k);
    if is_turned {
        next.reverse();
    }
    Some(next)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg::shape::path;

    fn lines(text: &str) -> Vec<DrawnLine> {
        path(text).lines
    }

    #[test]
    fn open_lines_in_any_order_and_direction_become_one_that_is_closed() {
        let whole = lines("M0 0L2 0C2 1 1 2 0 2Z");
        let found = joined(lines("M0 0L2 0M0 2L0 0M0 2C1 2 2 1 2 0"), 1e-6);
        assert_eq!(found.len(), 1);
        assert!(found[0].is_closed);
        assert!((found[0].area(0) - whole[0].area(0)).abs() < 1e-12);
        assert_eq!(found[0].spans.len(), found[0].len());
    }

    #[test]
    fn curves_stay_theirs_where_lines_are_turned_round() {
        let whole = lines("M0 0L2 0C2 1 1 2 0 2C-1 2 -2 1 -2 0Z");
        let parts = "M2 0L0 0M-2 0C-2 1 -1 2 0 2M2 0C2 1 1 2 0 2M0 0L-2 0";
        let found = joined(lines(parts), 1e-6);
        assert!(found.len() == 1 && found[0].is_closed);
        let [a, b] = [&whole[0], &found[0]].map(|line| line.area(0).abs());
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }

    #[test]
    fn lines_that_do_not_meet_stay_open() {
        let found = joined(lines("M0 0L2 0M2.1 0L2 2"), 1e-3);
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|line| !line.is_closed));
        // Begun in its middle.
        let found = joined(lines("M1 0L2 0M0 0L1 0M0 0L0 3"), 1e-3);
        assert_eq!((found.len(), found[0].len()), (1, 4));
    }
}
