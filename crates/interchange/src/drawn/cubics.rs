//! The curve between two corners of a line as cubics: those that the file gives; else fitted to the points of the curve that the file has between the
//! vertices, else a cubic spline through the vertices.

use super::corners::lies_along;
use super::fit::{along, chord_handles, free};
use super::piece::{DrawnLine, Span};
use super::spline::{Tangents, handles, slopes_of};
use toile_geometry::{Curve, Vec2};

/// Largest distance of a cubic from the points that it is fitted to (m).
const MAX_OFF: f64 = 8e-6;
/// Distance above which a fit that cannot be made better gives way to a chord (m).
const MAX_LEFT: f64 = 5e-5;
/// Most halvings of the stretch between two vertices (1).
const MAX_HALVINGS: u32 = 5;

/// A cubic that starts where the one before ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cubic {
    /// The handle after the start and the one before the end.
    pub handles: [Vec2; 2],
    /// The end.
    pub end: Vec2,
}

/// The cubics of a curve, the same number in all sizes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cubics {
    /// The start of the curve in each size (m).
    pub starts: Vec<Vec2>,
    /// The cubics in each size.
    pub by_size: Vec<Vec<Cubic>>,
    /// For each cubic, whether it ends at a vertex of the line.
    pub ends_at_vertex: Vec<bool>,
    /// Whether straight chords are kept in some size, as a smooth curve would turn back.
    pub has_chords: bool,
    /// Whether they are the spline through the vertices, which takes tangents at its ends.
    pub is_spline: bool,
}

impl Cubics {
    /// The cubics in a size; those of the last size where it has no others.
    pub fn in_size(&self, size: usize) -> &[Cubic] {
        let own = self.by_size.get(size).or(self.by_size.last());
        own.map_or(&[], Vec::as_slice)
    }

    /// The curves in a size.
    pub fn curves(&self, size: usize) -> Vec<Curve> {
        let mut start = self.starts[size];
        let own = self.by_size[size].iter();
        own.map(|cubic| Curve::Cubic {
            start: std::mem::replace(&mut start, cubic.end),
            controls: cubic.handles,
            end: cubic.end,
        })
        .collect()
    }

    /// Lengths of the curve from vertex to vertex in a size (m).
    pub fn lengths(&self, size: usize) -> Vec<f64> {
        let mut lengths = Vec::new();
        let mut length = 0.0;
        for (curve, &is_vertex) in self.curves(size).iter().zip(&self.ends_at_vertex) {
            length += curve.length();
            if is_vertex {
                lengths.push(length);
                length = 0.0;
            }
        }
        lengths
    }
}

/// The curve from one vertex to another in some number of sizes; `to` may lie beyond the last vertex of a closed line.
/// `ends` are the known tangents of its ends in each size: a curve of vertices alone has them.
pub(crate) fn cubics(
    line: &DrawnLine,
    (from, to): (usize, usize),
    (sizes, ends): (usize, &[Tangents]),
) -> Cubics {
    if let Some(given) = given(line, (from, to)) {
        return given;
    }
    let dense: Vec<Dense> = (0..sizes)
        .map(|size| Dense::of(line, (from, to), size))
        .collect();
    let mut found = Cubics {
        starts: dense.iter().map(|dense| dense.points[0]).collect(),
        by_size: vec![Vec::new(); sizes],
        ..Cubics::default()
    };
    // Without further points in some size, the vertices are all that all sizes have.
    if dense
        .iter()
        .any(|dense| dense.points.len() == dense.vertices.len())
    {
        for (size, (dense, own)) in dense.iter().zip(&mut found.by_size).enumerate() {
            let vertices: Vec<Vec2> = dense.vertices.iter().map(|&k| dense.points[k]).collect();
            let ends = ends.get(size).copied().unwrap_or_default();
            let (handles, overshoots) = handles(&vertices, ends);
            found.has_chords |= overshoots;
            let ends = vertices.iter().skip(1);
            own.extend(
                handles
                    .into_iter()
                    .zip(ends)
                    .map(|(handles, &end)| Cubic { handles, end }),
            );
        }
        found.ends_at_vertex = vec![true; to - from];
        found.is_spline = true;
        return found;
    }
    for k in 0..to - from {
        let ranges = dense
            .iter()
            .map(|dense| [dense.vertices[k], dense.vertices[k + 1]]);
        found.stretch(&dense, &ranges.collect::<Vec<_>>(), 0);
        if let Some(last) = found.ends_at_vertex.last_mut() {
            *last = true;
        }
    }
    found
}

/// The curve that the file gives as cubics, which is in one size; `None` where it gives none.
fn given(line: &DrawnLine, (from, to): (usize, usize)) -> Option<Cubics> {
    let vertices = line.in_size(0);
    let count = vertices.len();
    let cubic = |k: usize| match line.span(k % count) {
        Span::Cubic(handles) => Some(Cubic {
            handles,
            end: vertices[(k + 1) % count],
        }),
        Span::Chord | Span::Straight => None,
    };
    let cubics: Option<Vec<Cubic>> = (from..to).map(cubic).collect();
    Some(Cubics {
        starts: vec![vertices[from]],
        by_size: vec![cubics?],
        ends_at_vertex: vec![true; to - from],
        ..Cubics::default()
    })
}

/// The points of a curve in one size, vertices among them.
struct Dense {
    points: Vec<Vec2>,
    /// Indices of the vertices among the points.
    vertices: Vec<usize>,
    /// Derivatives at the points by the length of their chords (1).
    slopes: Vec<Vec2>,
}

impl Dense {
    fn of(line: &DrawnLine, (from, to): (usize, usize), size: usize) -> Self {
        let (points, vertices) = line.stretch(size, (from, to));
        Self {
            slopes: slopes_of(&points),
            points,
            vertices,
        }
    }

    /// The cubic along the points of a range, and whether it is near enough to them.
    fn fitted(&self, [from, to]: [usize; 2]) -> (Cubic, f64) {
        let points = &self.points[from..=to];
        let end = points[points.len() - 1];
        let directions = [from, to].map(|k| self.slopes[k].try_normalize(0.0).unwrap_or_default());
        let chord = end - points[0];
        let turns_back = directions
            .iter()
            .any(|direction| direction.dot(&chord) < 0.0);
        if points.len() == 2 && turns_back {
            let handles = chord_handles(points);
            return (Cubic { handles, end }, 0.0);
        }
        let mut fit = along(points, directions);
        if let (true, Some(other)) = (fit.off > MAX_OFF, free(points)) {
            fit = if other.off < fit.off { other } else { fit };
        }
        let handles = fit.handles;
        (Cubic { handles, end }, fit.off)
    }

    /// The point of a range that is nearest to the middle of its length.
    fn middle(&self, [from, to]: [usize; 2]) -> usize {
        let mut lengths = vec![0.0];
        for pair in self.points[from..=to].windows(2) {
            lengths.push(lengths[lengths.len() - 1] + (pair[1] - pair[0]).norm());
        }
        let half = 0.5 * lengths[lengths.len() - 1];
        let k = lengths.partition_point(|&length| length < half);
        (from + k).clamp(from + 1, to - 1)
    }
}

impl Cubics {
    /// Adds the cubics along ranges of points, one range a size.
    fn stretch(&mut self, dense: &[Dense], ranges: &[[usize; 2]], halvings: u32) {
        let fits: Vec<(Cubic, f64)> = dense
            .iter()
            .zip(ranges)
            .map(|(dense, &range)| dense.fitted(range))
            .collect();
        let is_near = fits.iter().all(|(_, off)| *off <= MAX_OFF);
        let can_halve = ranges.iter().all(|[from, to]| to - from > 1);
        if !is_near && can_halve && halvings < MAX_HALVINGS {
            let middles: Vec<usize> = dense
                .iter()
                .zip(ranges)
                .map(|(dense, &range)| dense.middle(range))
                .collect();
            let halves = |first: bool| -> Vec<[usize; 2]> {
                let both = ranges.iter().zip(&middles);
                both.map(|([from, to], &middle)| {
                    if first {
                        [*from, middle]
                    } else {
                        [middle, *to]
                    }
                })
                .collect()
            };
            self.stretch(dense, &halves(true), halvings + 1);
            self.stretch(dense, &halves(false), halvings + 1);
            return;
        }
        for ((mut cubic, off), ((dense, [from, to]), own)) in fits
            .into_iter()
            .zip(dense.iter().zip(ranges).zip(&mut self.by_size))
        {
            // A chord takes the place of a curve that it is nearer to the points than.
            let points = &dense.points[*from..=*to];
            if off > MAX_LEFT && lies_along(points, off) {
                self.has_chords = true;
                cubic.handles = chord_handles(points);
            }
            own.push(cubic);
        }
        self.ends_at_vertex.push(false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of an ellipse with 3 vertices and 20 points between each two, in two sizes.
    fn quarter() -> DrawnLine {
        let at = |share: f64, height: f64| {
            let turn = share * std::f64::consts::FRAC_PI_2;
            // Rounded as files are.
            let p = Vec2::new(0.2 * turn.cos(), height * turn.sin());
            p.map(|x| (x * 1e7).round() / 1e7)
        };
        let heights = [0.2, 0.35];
        let sizes = |count: usize| -> Vec<Vec<Vec2>> {
            let own = |h: f64| {
                (0..=count)
                    .map(|k| at(k as f64 / count as f64, h))
                    .collect()
            };
            heights.iter().map(|&h| own(h)).collect()
        };
        let between = sizes(42)
            .into_iter()
            .map(|all: Vec<Vec2>| vec![all[1..21].to_vec(), all[22..42].to_vec(), Vec::new()]);
        DrawnLine {
            by_size: sizes(2),
            between: between.collect(),
            ..DrawnLine::default()
        }
    }

    #[test]
    fn cubics_lie_on_the_points_of_the_curve() {
        let line = quarter();
        let found = cubics(&line, (0, 2), (2, &[]));
        assert!(!found.has_chords);
        assert_eq!(found.ends_at_vertex.iter().filter(|is| **is).count(), 2);
        for (size, height) in [0.2, 0.35].into_iter().enumerate() {
            let own = &found.by_size[size];
            assert_eq!(own.len(), found.ends_at_vertex.len());
            assert!(own.len() <= 8, "{}", own.len());
            let mut start = found.starts[size];
            for cubic in own {
                let curve = Curve::Cubic {
                    start,
                    controls: cubic.handles,
                    end: cubic.end,
                };
                for k in 0..=16 {
                    let p = curve.point(f64::from(k) / 16.0);
                    let off = ((p.x / 0.2).hypot(p.y / height) - 1.0).abs() * 0.2;
                    assert!(off < 1.2e-5, "{off}");
                }
                start = cubic.end;
            }
            let length: f64 = found.lengths(size).iter().sum();
            let exact = if size == 0 {
                0.1 * std::f64::consts::PI
            } else {
                0.440_039_5
            };
            assert!((length - exact).abs() < 2e-5, "{length}");
        }
    }

    #[test]
    fn without_points_between_in_every_size_it_is_the_spline_through_the_vertices() {
        let mut line = quarter();
        line.between[1].iter_mut().for_each(Vec::clear);
        let found = cubics(&line, (0, 2), (2, &[]));
        assert_eq!(found.ends_at_vertex, [true, true]);
        assert_eq!(found.by_size[0].len(), 2);
    }
}
