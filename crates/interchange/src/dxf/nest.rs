//! Lines of a piece in several sizes, thinned to as many vertices in every size.

use toile_cut::{PieceRing, PieceSegment};
use toile_geometry::Vec2;

/// Places along a line that differ by less are one (1).
const SAME_SHARE: f64 = 1e-9;

/// A line in all sizes, with as many vertices in each.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct NestLine {
    /// The vertices by size (m).
    pub by_size: Vec<Vec<Vec2>>,
    /// For each vertex, whether it is a corner.
    pub is_corner: Vec<bool>,
}

/// A closed line in several sizes, within a tolerance (m). `None`: it is made of other parts in some of them.
pub(super) fn closed(rings: &[&PieceRing], tolerance: f64) -> Option<NestLine> {
    let first = runs(rings.first()?);
    let tags = |runs: &[Run]| -> Vec<PieceSegment> { runs.iter().map(|run| run.0).collect() };
    let expected = tags(&first);
    let mut all: Vec<Vec<Run>> = Vec::with_capacity(rings.len());
    for ring in rings {
        let mut own = runs(ring);
        if own.len() != expected.len() {
            return None;
        }
        // Lines may begin at other parts in other sizes.
        let turn = (0..own.len().max(1)).find(|&turn| {
            let turned = own.iter().cycle().skip(turn).map(|run| run.0);
            turned.take(own.len()).eq(expected.iter().copied())
        })?;
        own.rotate_left(turn);
        all.push(own);
    }
    let mut line = NestLine {
        by_size: vec![Vec::new(); rings.len()],
        is_corner: Vec::new(),
    };
    for (k, tag) in expected.iter().enumerate() {
        let run: Vec<&[Vec2]> = all.iter().map(|own| own[k].1.as_slice()).collect();
        let thinned = open(&run, tolerance);
        let is_edge = matches!(tag, PieceSegment::Edge(_));
        for (own, part) in line.by_size.iter_mut().zip(thinned) {
            // The last vertex is the first of the next part.
            own.extend_from_slice(&part[..part.len() - 1]);
        }
        let count = line.by_size[0].len() - line.is_corner.len();
        let corners = (0..count).map(|k| k == 0 || !is_edge);
        line.is_corner.extend(corners);
    }
    Some(line)
}

/// Part of a closed line that comes from one edge or corner, and its vertices (m), the first of the next part
/// too.
type Run = (PieceSegment, Vec<Vec2>);

fn runs(ring: &PieceRing) -> Vec<Run> {
    let count = ring.points.len();
    if ring.segments.len() != count || count == 0 {
        return Vec::new();
    }
    let is_start = |k: usize| ring.segments[k] != ring.segments[(k + count - 1) % count];
    let start = (0..count).find(|&k| is_start(k)).unwrap_or(0);
    let mut runs: Vec<Run> = Vec::new();
    for k in start..start + count {
        let (at, next) = (k % count, (k + 1) % count);
        if is_start(at) || runs.is_empty() {
            runs.push((ring.segments[at], vec![ring.points[at]]));
        }
        if let Some((_, points)) = runs.last_mut() {
            points.push(ring.points[next]);
        }
    }
    runs
}

/// Open lines, one for each size, thinned to vertices at the same shares of their lengths, within a tolerance (m)
/// in all sizes (after Douglas and Peucker 1973).
pub(super) fn open(lines: &[&[Vec2]], tolerance: f64) -> Vec<Vec<Vec2>> {
    let measured: Vec<Measured<'_>> = lines.iter().map(|points| Measured::new(points)).collect();
    let mut shares: Vec<f64> = measured.iter().flat_map(Measured::shares).collect();
    shares.extend([0.0, 1.0]);
    shares.sort_by(f64::total_cmp);
    shares.dedup_by(|b, a| *b - *a <= SAME_SHARE);
    let last = shares.len() - 1;
    let places: Vec<Vec<Vec2>> = measured
        .iter()
        .map(|line| shares.iter().map(|&share| line.at(share)).collect())
        .collect();
    let mut stays = vec![false; shares.len()];
    stays[0] = true;
    stays[last] = true;
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let off = |k: usize| {
            let of = places.iter().map(|own| {
                let along = own[to] - own[from];
                let out = own[k] - own[from];
                let length = along.norm();
                match length > 0.0 {
                    true => (along.perp(&out) / length).abs(),
                    false => out.norm(),
                }
            });
            of.fold(0.0, f64::max)
        };
        let offs = (from + 1..to).map(|k| (k, off(k)));
        let farthest = offs.max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, _)) = farthest.filter(|(_, off)| *off > tolerance) {
            stays[k] = true;
            open.extend([(from, k), (k, to)]);
        }
    }
    let kept = |own: &Vec<Vec2>| -> Vec<Vec2> {
        let kept = own.iter().zip(&stays).filter(|(_, stays)| **stays);
        kept.map(|(p, _)| *p).collect()
    };
    places.iter().map(kept).collect()
}

/// An open line with its lengths.
struct Measured<'p> {
    points: &'p [Vec2],
    /// Length from the start to each vertex (m).
    along: Vec<f64>,
}

impl<'p> Measured<'p> {
    fn new(points: &'p [Vec2]) -> Self {
        let mut along = vec![0.0; points.len().max(1)];
        for k in 1..points.len() {
            along[k] = along[k - 1] + (points[k] - points[k - 1]).norm();
        }
        Self { points, along }
    }

    fn whole(&self) -> f64 {
        self.along.last().copied().unwrap_or_default()
    }

    fn shares(&self) -> impl Iterator<Item = f64> + '_ {
        let whole = self.whole();
        self.along.iter().map(move |along| match whole > 0.0 {
            true => along / whole,
            false => 0.0,
        })
    }

    fn at(&self, share: f64) -> Vec2 {
        let goal = share * self.whole();
        let next = self.along.partition_point(|along| *along <= goal);
        let Some(&to) = self.points.get(next) else {
            return self.points.last().copied().unwrap_or_default();
        };
        let from = next.max(1) - 1;
        let length = self.along[next] - self.along[from];
        let part = (goal - self.along[from]) / length.max(f64::MIN_POSITIVE);
        self.points[from] + (to - self.points[from]) * part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arc(radius: f64, count: usize) -> Vec<Vec2> {
        let at = |k: usize| {
            let angle = 1.5 * k as f64 / count as f64;
            Vec2::new(radius * angle.cos(), radius * angle.sin())
        };
        (0..=count).map(at).collect()
    }

    #[test]
    fn lines_of_other_counts_get_as_many_vertices_and_stay_as_near() {
        let (small, large) = (arc(0.1, 37), arc(0.25, 101));
        let thinned = open(&[&small, &large], 4e-5);
        assert_eq!(thinned[0].len(), thinned[1].len());
        assert!((8..80).contains(&thinned[0].len()), "{}", thinned[0].len());
        for (line, own) in [(&small, &thinned[0]), (&large, &thinned[1])] {
            assert_eq!((line[0], line.last()), (own[0], own.last()));
            for p in line {
                let off = own.windows(2).map(|pair| {
                    (toile_geometry::closest_on_segment(*p, [pair[0], pair[1]]) - p).norm()
                });
                let off = off.fold(f64::INFINITY, f64::min);
                assert!(off < 4.1e-5, "{off}");
            }
        }
        let straight = [Vec2::zeros(), Vec2::new(0.5, 0.0), Vec2::new(1.0, 0.0)];
        let point = [Vec2::new(2.0, 2.0); 2];
        let thinned = open(&[&straight, &point], 1e-5);
        assert_eq!(thinned[0], [straight[0], straight[2]]);
        assert_eq!(thinned[1], point);
    }

    #[test]
    fn a_closed_line_may_begin_elsewhere_and_must_have_the_same_parts() {
        let ring = |start: usize, tags: [PieceSegment; 4], size: f64| {
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            let mut points = corners.map(|p| Vec2::from(p) * size).to_vec();
            let mut segments = tags.to_vec();
            points.rotate_left(start);
            segments.rotate_left(start);
            PieceRing { points, segments }
        };
        let tags = [
            PieceSegment::Fold,
            PieceSegment::Unknown,
            PieceSegment::Unknown,
            PieceSegment::Unknown,
        ];
        let (one, two) = (ring(0, tags, 1.0), ring(2, tags, 2.0));
        let line = closed(&[&one, &two], 1e-5).unwrap();
        assert_eq!(line.by_size[0].len(), 4);
        for (a, b) in line.by_size[0].iter().zip(&line.by_size[1]) {
            assert_eq!(a * 2.0, *b);
        }
        let other = ring(0, [PieceSegment::Fold; 4], 1.0);
        assert_eq!(closed(&[&one, &other], 1e-5), None);
    }
}
