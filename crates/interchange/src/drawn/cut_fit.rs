//! Seam allowances and corners by which the cut line that a file draws follows from its sew line.

use super::allowance::{Width, distance, width};
use super::corners::is_kink;
use super::cubics::Cubics;
use super::piece::DrawnLine;
use toile_cut::{Corner as CutCorner, MITRE_LIMIT, SeamEdge, SeamLine, cut_line};
use toile_geometry::{Curve, Polygon, Vec2};
use toile_pattern::{Corner, EdgeCorner, MitreLimit};

/// Chords of a curve whose distance to the cut line is taken.
const CHORDS: usize = 12;
/// Largest distance between a cut line as drawn and as made that counts as none (m).
const SAME: f64 = 1e-4;
/// Distance of a corner of the cut line from the one as drawn above which other shapes and tangents are tried (m).
pub(crate) const TRY_OTHERS: f64 = 5e-5;
/// Longest way from a corner of the sew line to what of the cut line belongs to it, over the wider allowance (1).
const REACH: f64 = 4.0;

/// Difference of the distances along an edge beyond which they may not be a width at all (m).
const MAX_SPREAD: f64 = 0.003;
/// Widths differ by as much from round ones as coordinates are rounded in files (m).
const EXACT: f64 = 2e-5;

/// Allowances and corners of the edges of a sew line.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CutFit {
    /// Width of the allowance of each edge (m).
    pub widths: Vec<f64>,
    /// Width that most of the line has (m).
    pub usual: f64,
    /// Corner at the start of each edge.
    pub corners: Vec<EdgeCorner>,
    /// Number of edges whose allowance is uneven; it is their mean.
    pub uneven: usize,
    /// Number of corners at which the cut line as drawn turns otherwise.
    pub other_corners: usize,
    /// For each corner the largest distance of a vertex of the cut line as drawn, near it, from the one that is made, and of
    /// a corner of the latter from the former (m).
    pub vertex_offs: Vec<f64>,
    /// Share of the vertices of the cut line as drawn that lie elsewhere than on the one that is made (1).
    pub off_share: f64,
}

/// The curves of the edges of a line in a size; `curves` are the cubics of those that are not straight.
pub(crate) fn edges_of(
    line: &DrawnLine,
    (corners, curves): (&[usize], &[Option<Cubics>]),
    size: usize,
) -> Vec<Vec<Curve>> {
    let vertices = line.in_size(size);
    let of = |(c, &from): (usize, &usize)| {
        let end = vertices[corners[(c + 1) % corners.len()]];
        match curves.get(c) {
            Some(Some(cubics)) => cubics.curves(size),
            Some(None) | None => vec![Curve::Line {
                start: vertices[from],
                end,
            }],
        }
    };
    corners.iter().enumerate().map(of).collect()
}

/// Points of an edge, near enough to each other to stand for it.
fn points_of(edge: &[Curve]) -> Vec<Vec2> {
    let mut points: Vec<Vec2> = edge.first().map(Curve::start).into_iter().collect();
    for curve in edge {
        match curve {
            Curve::Line { end, .. } => points.push(*end),
            Curve::Arc { .. } | Curve::Quadratic { .. } | Curve::Cubic { .. } => {
                points.extend((1..=CHORDS).map(|k| curve.point(k as f64 / CHORDS as f64)));
            }
        }
    }
    points
}

/// Points of the edges of a closed line, each once.
pub(crate) fn ring_of(edges: &[Vec<Curve>]) -> Vec<Vec2> {
    let points = edges.iter().flat_map(|edge| {
        let mut points = points_of(edge);
        points.pop();
        points
    });
    points.collect()
}

/// Allowances and corners of the edges of a sew line that runs counter-clockwise, which give the cut line that is drawn:
/// by its vertices, and by points of it that lie dense.
pub(crate) fn cut_fit(edges: &[Vec<Curve>], (vertices, dense): (&[Vec2], &[Vec2])) -> CutFit {
    let mut fit = CutFit {
        corners: vec![EdgeCorner::default(); edges.len()],
        ..CutFit::default()
    };
    let found: Vec<(Width, f64)> = edges
        .iter()
        .map(|edge| {
            let length = edge.iter().map(Curve::length).sum();
            (width(&points_of(edge), dense), length)
        })
        .collect();
    let even = found.iter().filter_map(|&(found, length)| match found {
        Width::Even(width) => Some((rounded(width), length)),
        Width::Uneven { .. } => None,
    });
    fit.usual = longest(&even.collect::<Vec<(f64, f64)>>());
    for ((found, _), edge) in found.into_iter().zip(edges) {
        // Curves of few vertices run apart between them, though the vertices themselves are at an even distance.
        let is_near = |curve: &Curve| (distance(curve.start(), dense) - fit.usual).abs() <= SAME;
        let is_usual = || edge.len() > 2 && edge.iter().skip(1).all(is_near);
        fit.widths.push(match found {
            Width::Even(width) => rounded(width),
            Width::Uneven { .. } if is_usual() => fit.usual,
            Width::Uneven { mean, spread } => {
                fit.uneven += 1;
                // The legs of a dart that is drawn lie at no distance of their own from the cut line.
                match spread > MAX_SPREAD && mean > 2.0 * fit.usual {
                    true => fit.usual,
                    false => rounded(mean),
                }
            }
        });
    }
    // No allowance gives the cut line of a sew line that crosses itself.
    if !Polygon::new(ring_of(edges)).is_simple() {
        return fit;
    }
    let Some(mut made) = fit.made(edges) else {
        return fit;
    };
    let mut offs = fit.corner_offs(edges, (vertices, dense), &made);
    let wrong: Vec<usize> = (0..edges.len()).filter(|&c| offs[c] > TRY_OTHERS).collect();
    if !wrong.is_empty() && !fit.is_mostly_uneven() {
        for corner in others() {
            let mut tried = fit.clone();
            wrong.iter().for_each(|&c| tried.corners[c] = corner);
            let Some(made) = tried.made(edges) else {
                continue;
            };
            let tried = tried.corner_offs(edges, (vertices, dense), &made);
            for &c in &wrong {
                if tried[c] < 0.5 * offs[c] {
                    offs[c] = tried[c];
                    fit.corners[c] = corner;
                }
            }
        }
        made = fit.made(edges).unwrap_or(made);
    }
    fit.compare(edges, (vertices, dense), &made);
    fit
}

/// The corners of a closed line.
fn kinks(ring: &[Vec2]) -> Vec<Vec2> {
    let line = DrawnLine::one(ring.to_vec(), true);
    let kinks = (0..ring.len()).filter(|&k| is_kink(&line, 0, k));
    kinks.map(|k| ring[k]).collect()
}

/// Corners besides the usual one.
fn others() -> [EdgeCorner; 5] {
    let of = |kind, limit| EdgeCorner {
        kind,
        limit,
        ..EdgeCorner::default()
    };
    [
        of(Corner::Mitre, MitreLimit::None),
        of(Corner::Bevel, MitreLimit::default()),
        of(Corner::Square, MitreLimit::default()),
        of(Corner::Extended, MitreLimit::default()),
        of(Corner::Mirrored, MitreLimit::default()),
    ]
}

impl CutFit {
    /// Whether most edges have no allowance of even width: no corners and tangents make the cut line follow then.
    pub fn is_mostly_uneven(&self) -> bool {
        2 * self.uneven > self.widths.len()
    }

    /// The same widths and corners at a sew line whose edges are drawn otherwise, with the distances of the cut lines anew.
    #[must_use]
    pub fn again(mut self, edges: &[Vec<Curve>], drawn: (&[Vec2], &[Vec2])) -> Self {
        match self.made(edges) {
            Some(made) => self.compare(edges, drawn, &made),
            None => self.vertex_offs.fill(f64::INFINITY),
        }
        self
    }

    /// Compares the cut line as drawn, by its vertices and by dense points, with the one that is made.
    fn compare(
        &mut self,
        edges: &[Vec<Curve>],
        (vertices, dense): (&[Vec2], &[Vec2]),
        made: &[Vec2],
    ) {
        let drawn = self.offs_near(edges, vertices, made);
        let back = self.offs_near(edges, made, dense);
        let is_other = |(a, b): &(&f64, &f64)| a.max(**b) > SAME;
        self.other_corners = drawn.iter().zip(&back).filter(is_other).count();
        let back = self.offs_near(edges, &kinks(made), dense);
        self.vertex_offs = drawn.iter().zip(back).map(|(a, b)| a.max(b)).collect();
        let off = vertices.iter().filter(|p| distance(**p, made) > SAME);
        self.off_share = off.count() as f64 / vertices.len().max(1) as f64;
    }

    /// The cut line that follows from the sew line; `None` if none does.
    fn made(&self, edges: &[Vec<Curve>]) -> Option<Vec<Vec2>> {
        let mut outline = Vec::new();
        for ((edge, &width), corner) in edges.iter().zip(&self.widths).zip(&self.corners) {
            for (part, &curve) in edge.iter().enumerate() {
                let corner = match part {
                    0 => *corner,
                    _ => EdgeCorner::default(),
                };
                outline.push(SeamEdge {
                    curve,
                    width,
                    corner: match corner.kind {
                        Corner::Mitre => CutCorner::Mitre,
                        Corner::Bevel => CutCorner::Bevel,
                        Corner::Square => CutCorner::SquareToNext,
                        Corner::Extended => CutCorner::Extended,
                        Corner::Mirrored => CutCorner::MirroredInNext,
                    },
                    limit: match corner.limit {
                        MitreLimit::Widths(_) => MITRE_LIMIT,
                        MitreLimit::None => MitreLimit::RANGE[1],
                    },
                });
            }
        }
        let seam = SeamLine {
            outline,
            ..SeamLine::default()
        };
        let made = cut_line(&seam).ok()?.outline.points;
        (made.len() > 2).then_some(made)
    }

    /// For each corner how far the cut lines as drawn and as made are apart near it (m).
    fn corner_offs(
        &self,
        edges: &[Vec<Curve>],
        (vertices, dense): (&[Vec2], &[Vec2]),
        made: &[Vec2],
    ) -> Vec<f64> {
        let drawn = self.offs_near(edges, vertices, made);
        let back = self.offs_near(edges, made, dense);
        drawn.iter().zip(back).map(|(a, b)| a.max(b)).collect()
    }

    /// For each corner the largest distance of the points of a line near it from another line (m).
    fn offs_near(&self, edges: &[Vec<Curve>], line: &[Vec2], other: &[Vec2]) -> Vec<f64> {
        let count = edges.len();
        let starts: Vec<Vec2> = edges.iter().map(|edge| edge[0].start()).collect();
        let mut offs = vec![0.0_f64; count];
        for &p in line {
            let off = |c: &usize| (starts[*c] - p).norm();
            let nearest = (0..count).min_by(|a, b| off(a).total_cmp(&off(b)));
            if let Some(c) = nearest.filter(|c| off(c) <= self.reach(*c)) {
                offs[c] = offs[c].max(distance(p, other));
            }
        }
        offs
    }

    /// Largest distance from a corner of the sew line to what of the cut line belongs to it (m).
    pub fn reach(&self, corner: usize) -> f64 {
        let before = (corner + self.widths.len() - 1) % self.widths.len();
        REACH * self.widths[corner].max(self.widths[before])
    }
}

/// A width rounded to a tenth of a millimetre where it is as near to one as coordinates are exact, else to a
/// thousandth.
fn rounded(width: f64) -> f64 {
    let tenth = (width * 1e4).round() / 1e4;
    match (width - tenth).abs() <= EXACT {
        true => tenth,
        false => (width * 1e6).round() / 1e6,
    }
}

/// The value other than 0 that most of a line has, by values with lengths, the first of equals; 0 without one.
fn longest(values: &[(f64, f64)]) -> f64 {
    let length = |value: f64| {
        let own = values.iter().filter(|(other, _)| *other == value);
        own.map(|(_, length)| length).sum::<f64>()
    };
    let mut best = (0.0, 0.0);
    for &(value, _) in values.iter().filter(|(value, _)| *value != 0.0) {
        if length(value) > best.0 {
            best = (length(value), value);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(corners: [[f64; 2]; 4]) -> Vec<Vec<Curve>> {
        let [a, b, c, d] = corners.map(Vec2::from);
        let line = |start, end| vec![Curve::Line { start, end }];
        vec![line(a, b), line(b, c), line(c, d), line(d, a)]
    }

    /// A skirt panel that is narrower at its waist.
    const SEW: [[f64; 2]; 4] = [[0.0, 0.0], [0.3, 0.0], [0.25, 0.5], [0.05, 0.5]];

    fn fit_of(corners: [Corner; 4]) -> CutFit {
        let fit = CutFit {
            widths: vec![0.04, 0.01, 0.01, 0.01],
            corners: corners
                .map(|kind| EdgeCorner {
                    kind,
                    ..EdgeCorner::default()
                })
                .to_vec(),
            ..CutFit::default()
        };
        let made = fit.made(&square(SEW)).unwrap();
        cut_fit(&square(SEW), (&made, &made))
    }

    #[test]
    fn widths_and_shapes_of_corners_are_found_again() {
        for kinds in [
            [Corner::Mitre; 4],
            [
                Corner::Mirrored,
                Corner::Mitre,
                Corner::Extended,
                Corner::Mitre,
            ],
            [Corner::Bevel, Corner::Square, Corner::Mitre, Corner::Bevel],
        ] {
            let fit = fit_of(kinds);
            let found: Vec<Corner> = fit.corners.iter().map(|corner| corner.kind).collect();
            assert_eq!(found, kinds);
            let expected = [0.04, 0.01, 0.01, 0.01];
            let near = fit
                .widths
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-6);
            assert!(near, "{:?}", fit.widths);
            assert_eq!((fit.uneven, fit.other_corners, fit.off_share), (0, 0, 0.0));
        }
    }

    #[test]
    fn an_allowance_that_grows_along_an_edge_is_uneven_though_one_vertex_has_the_usual_width() {
        let ring = [[0.0, 0.0], [0.15, 0.0], [0.3, 0.0], [0.3, 0.5], [0.0, 0.5]].map(Vec2::from);
        let line = |start, end| Curve::Line { start, end };
        let [a, b, c, d, e] = ring;
        let sew = [
            vec![line(a, b), line(b, c)],
            vec![line(c, d)],
            vec![line(d, e)],
            vec![line(e, a)],
        ];
        // From 5 to 15 mm along the hem, and 10 beside all other edges.
        let slope = 0.01 / 0.3;
        let below = |x: f64| Vec2::new(x, -0.005 - slope * x);
        let above = [[0.31, 0.51], [-0.01, 0.51]].map(Vec2::from);
        let cut = [below(-0.01), below(0.31), above[0], above[1]];
        let fit = cut_fit(&sew, (&cut, &cut));
        assert_eq!(fit.uneven, 1);
        assert_eq!(fit.usual, 0.01);
    }

    #[test]
    fn a_cut_line_that_follows_from_no_allowance_is_off() {
        let cut = [[-0.01, -0.05], [0.33, -0.02], [0.27, 0.54], [0.0, 0.51]].map(Vec2::from);
        let fit = cut_fit(&square(SEW), (&cut, &cut));
        assert_eq!(fit.uneven, 4);
        assert!(fit.off_share > 0.5, "{fit:?}");
    }
}
