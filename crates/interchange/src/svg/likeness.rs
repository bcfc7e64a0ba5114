//! Whether lines are those that were written, by their shapes.

use super::kinds::LineKind;
use crate::drawn::piece::{DrawnLine, Span};
use kurbo::{CubicBez, Line, ParamCurveNearest, PathSeg, Point, Rect, Shape};
use toile_geometry::{Bounds2, Vec2};

/// Largest distance of lines that are alike (mm).
const ALIKE: f64 = 0.01;
/// Shares of a segment at which it is compared.
const SHARES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Lines of a panel, by their kinds (mm, y down).
#[derive(Debug, Default)]
pub(super) struct Outlines {
    kinds: Vec<Kind>,
    bounds: Option<Bounds2>,
}

/// The lines of a kind.
#[derive(Debug)]
struct Kind {
    word: Option<&'static str>,
    count: usize,
    segments: Vec<(PathSeg, Rect)>,
}

impl Outlines {
    /// Adds lines of a kind.
    pub fn add(&mut self, kind: Option<LineKind>, lines: &[DrawnLine]) {
        let word = kind.map(LineKind::word);
        let known = self.kinds.iter().position(|kind| kind.word == word);
        let k = known.unwrap_or(self.kinds.len());
        if known.is_none() {
            self.kinds.push(Kind {
                word,
                count: 0,
                segments: Vec::new(),
            });
        }
        for line in lines {
            let points = line.in_size(0);
            let at = |p: Vec2| Point::new(p.x, p.y);
            let last = points.len() - usize::from(!line.is_closed && !points.is_empty());
            for from in 0..last {
                let ends = [points[from], points[(from + 1) % points.len()]].map(at);
                let segment = match line.span(from) {
                    Span::Cubic(handles) => {
                        let [a, b] = handles.map(at);
                        PathSeg::Cubic(CubicBez::new(ends[0], a, b, ends[1]))
                    }
                    Span::Chord | Span::Straight => PathSeg::Line(Line::new(ends[0], ends[1])),
                };
                let bounds = segment.bounding_box();
                let low = Vec2::new(bounds.x0, bounds.y0);
                let own = Bounds2::of([low, Vec2::new(bounds.x1, bounds.y1)]);
                self.bounds = Some(self.bounds.map_or(own, |all| all.union(&own)));
                self.kinds[k].segments.push((segment, bounds));
            }
            self.kinds[k].count += 1;
        }
    }

    /// Whether it has no lines.
    pub fn is_empty(&self) -> bool {
        self.bounds.is_none()
    }
}

/// By how much lines were moved from where they were written (mm), if they are alike but for that.
pub(super) fn are_alike(written: &Outlines, found: &Outlines) -> Option<Vec2> {
    let (before, after) = (written.bounds?, found.bounds?);
    let by = after.centre() - before.centre();
    let by = if by.norm() <= ALIKE {
        Vec2::zeros()
    } else {
        by
    };
    let is_alike = written.kinds.len() == found.kinds.len()
        && written.kinds.iter().all(|kind| {
            let same = found.kinds.iter().find(|other| other.word == kind.word);
            same.is_some_and(|same| {
                kind.count == same.count && lie_on(kind, same, by) && lie_on(same, kind, -by)
            })
        });
    is_alike.then_some(by)
}

/// Whether lines that are moved by an offset lie on others.
fn lie_on(lines: &Kind, others: &Kind, by: Vec2) -> bool {
    use kurbo::ParamCurve;
    let by = kurbo::Vec2::new(by.x, by.y);
    let mut guess = 0;
    let count = others.segments.len();
    lines.segments.iter().all(|(segment, _)| {
        SHARES.iter().all(|&share| {
            let p = segment.eval(share) + by;
            // Lines are mostly compared in their own order.
            let near = |k: &usize| {
                let (other, bounds) = &others.segments[*k];
                bounds.inflate(ALIKE, ALIKE).contains(p)
                    && other.nearest(p, 1e-6).distance_sq <= ALIKE * ALIKE
            };
            let found = (0..count).map(|k| (guess + k) % count).find(near);
            guess = found.unwrap_or(guess);
            found.is_some()
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg::shape::path;

    fn outlines(text: &str) -> Outlines {
        let mut all = Outlines::default();
        all.add(Some(LineKind::Sew), &path(text).lines);
        all
    }

    #[test]
    fn lines_are_alike_wherever_they_begin_and_however_they_are_written() {
        let written = outlines("M0 0L100 0A50 50 0 0 1 0 0Z");
        let moved = outlines("M5 -3h100a50 50 0 0 1 -100 0z");
        let by = are_alike(&written, &moved).unwrap();
        assert!((by - Vec2::new(5.0, -3.0)).norm() < 0.01, "{by}");
        // Begun elsewhere, and divided.
        let other = outlines("M50 0L100 0A50 50 0 0 1 50 50A50 50 0 0 1 0 0L50 0Z");
        assert_eq!(are_alike(&written, &other), Some(Vec2::zeros()));
        let edited = outlines("M0 0L100 0A50 50 0 0 1 0 0.03Z");
        assert_eq!(are_alike(&written, &edited), None);
        // An end that goes on along its line.
        let [short, long] = ["M0 0L5 0", "M0 0L5.5 0"].map(outlines);
        assert_eq!(are_alike(&short, &long), None);
        let more = outlines("M0 0L100 0A50 50 0 0 1 0 0ZM10 0L20 0");
        assert_eq!(are_alike(&written, &more), None);
    }
}
