//! Random pieces: no crossings, widths kept, corners in closed form, stretches found by brute force.

use crate::common::random::random_seam;
use crate::common::{self, meet};
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use std::sync::atomic::{AtomicUsize, Ordering};
use toile_cut::{
    Corner, CutError, CutLine, CutRing, EdgeIndex, Finding, MITRE_LIMIT, SeamEdge, SeamLine,
    SegmentKind, cut_line,
};
use toile_geometry::{CrossingKind, Curve, Polygon, Vec2, closest_on_segment, ring_area};

/// Random pieces a run; a soak sets `CUT_CASES`.
const CASES: u32 = 1000;
/// 0.01 mm.
const TOLERANCE: f64 = 1e-5;
/// Between samples of the seam line (m).
const SAMPLE: f64 = 4e-3;
/// Stretches shorter than 0.1 mm are not listed; the cut line is then no farther away than this (m).
const SHORT: f64 = 1e-3;
/// Ends of stretches are found to this (m): where a curve's cut line leaves at a grazing angle,
/// flattening to 5 um moves the place by some millimetres.
const SLACK: f64 = 4e-3;

fn distance(p: Vec2, segments: &[[Vec2; 2]]) -> f64 {
    let squared = segments
        .iter()
        .map(|&s| (p - closest_on_segment(p, s)).norm_squared());
    squared.fold(f64::INFINITY, f64::min).sqrt()
}

fn segments(ring: &CutRing) -> impl Iterator<Item = [Vec2; 2]> + '_ {
    let count = ring.points.len();
    (0..count).map(move |k| [ring.points[k], ring.points[(k + 1) % count]])
}

/// A loop as given, with the side its allowance lies on.
struct Loop<'a> {
    edges: &'a [SeamEdge],
    ring: usize,
    /// 1 if the allowance lies right of the given direction, -1 if left.
    sign: f64,
    legs: Vec<usize>,
}

impl<'a> Loop<'a> {
    fn all(seam: &'a SeamLine) -> Vec<Self> {
        (0..=seam.holes.len())
            .map(|ring| {
                let edges = seam.edges(ring).unwrap();
                let flat: Vec<Vec2> = edges.iter().flat_map(|e| e.curve.flatten(1e-4)).collect();
                let left = (ring_area(&flat) > 0.0) == (ring == 0);
                let legs = seam.darts.iter().flat_map(|dart| dart.legs);
                Self {
                    edges,
                    ring,
                    sign: if left { 1.0 } else { -1.0 },
                    legs: legs.filter(|_| ring == 0).collect(),
                }
            })
            .collect()
    }

    fn normal(&self, curve: &Curve, t: f64) -> Vec2 {
        let along = curve.derivative(t).normalize() * self.sign;
        Vec2::new(along.y, -along.x)
    }
}

/// Distance of a point from the parallel of an edge in its width, continued straight at both ends
/// as far as corners reach (m).
fn off_parallel(p: Vec2, edge: &SeamEdge, sign: f64) -> f64 {
    let normal = |t: f64| {
        let along = edge.curve.derivative(t).normalize() * sign;
        Vec2::new(along.y, -along.x)
    };
    let off = |t: f64| (edge.curve.point(t) + normal(t) * edge.width - p).norm();
    let mut best = f64::INFINITY;
    for (t, way) in [(0.0, -1.0), (1.0, 1.0)] {
        let start = edge.curve.point(t) + normal(t) * edge.width;
        let end = start + edge.curve.derivative(t).normalize() * (way * 0.11);
        best = best.min((p - closest_on_segment(p, [start, end])).norm());
    }
    if let Curve::Line { start, end } = edge.curve {
        let out = normal(0.0) * edge.width;
        return best.min((p - closest_on_segment(p, [start + out, end + out])).norm());
    }
    let count = 96;
    let at = |k: usize| k as f64 / count as f64;
    let coarse: Vec<f64> = (0..=count).map(|k| off(at(k))).collect();
    for k in 0..=count {
        let (low, high) = (k.max(1) - 1, (k + 1).min(count));
        if coarse[k] > coarse[low] || coarse[k] > coarse[high] {
            continue;
        }
        // Near a cusp of the parallel there are several nearest points between two samples.
        let (low, high) = (at(low), at(high));
        let fine = |i: usize| low + (high - low) * i as f64 / 32.0;
        let order = |a: &usize, b: &usize| off(fine(*a)).total_cmp(&off(fine(*b)));
        let nearest = (0..=32).min_by(order).unwrap();
        let (mut low, mut high) = (fine(nearest.max(1) - 1), fine((nearest + 1).min(32)));
        for _ in 0..40 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if off(a) < off(b) { high = b } else { low = a }
        }
        let t = 0.5 * (low + high);
        // Where the curve is about as tight as the edge is wide the parallel has a cusp, whose
        // place hangs on the curvature that chords have: 0.2 mm.
        let step = 1e-4;
        let (a, b) = ((t - step).max(0.0), (t + step).min(1.0));
        let way = edge.curve.point(b) - edge.curve.point(a);
        let speed = 1.0 + (normal(b) - normal(a)).dot(&way) * edge.width / way.norm_squared();
        let cusp = if speed.abs() < 0.4 { 2e-4 } else { 0.0 };
        best = best.min((off(t) - cusp).max(0.0));
    }
    best
}

fn check_shape(cut: &CutLine) {
    let crossings = cut.polygon().crossings(4);
    let bad = crossings.iter().find(|c| c.kind != CrossingKind::Touch);
    assert!(bad.is_none(), "{bad:?}");
    assert!(ring_area(&cut.outline.points) > 0.0);
    assert!(cut.holes.iter().all(|hole| ring_area(&hole.points) < 0.0));
    for ring in std::iter::once(&cut.outline).chain(&cut.holes) {
        assert_eq!(ring.points.len(), ring.origins.len());
        assert!(ring.points.len() > 2);
    }
}

/// Every point on an edge's cut line is as far from the edge, square to it, as the edge is wide.
fn check_widths(seam: &SeamLine, cut: &CutLine) {
    let signs: Vec<f64> = Loop::all(seam).iter().map(|ring| ring.sign).collect();
    for ring in std::iter::once(&cut.outline).chain(&cut.holes) {
        // Every few segments: a hundred on a ring.
        let step = 1 + ring.points.len() / 100;
        for (segment, origin) in segments(ring).zip(&ring.origins).step_by(step) {
            if origin.kind != SegmentKind::Edge {
                continue;
            }
            let edge = &seam.edges(origin.edge.ring).unwrap()[origin.edge.edge];
            for p in [segment[0], (segment[0] + segment[1]) * 0.5] {
                let off = off_parallel(p, edge, signs[origin.edge.ring]);
                assert!(
                    off < TOLERANCE,
                    "{:?}: {p:?} is off by {off}, width {}",
                    origin.edge,
                    edge.width
                );
            }
        }
    }
}

/// Lines at an outer corner, each a point and a direction.
struct Lines {
    seam: [[Vec2; 2]; 2],
    cut: [[Vec2; 2]; 2],
    normals: [Vec2; 2],
    widths: [f64; 2],
}

/// The corners of the cut line at an outer corner, where they have a closed form of their own:
/// not cut off, mitred instead, or a step.
fn tips(kind: Corner, lines: &Lines) -> Vec<Vec2> {
    let [n, m] = lines.normals;
    let [a, b] = lines.widths;
    let (sin, cos) = (n.perp(&m), n.dot(&m));
    let limit = MITRE_LIMIT * a.max(b);
    if sin < 0.05 || a == 0.0 || b == 0.0 {
        return Vec::new();
    }
    let [seam_a, seam_b] = lines.seam;
    let [cut_a, cut_b] = lines.cut;
    let p = seam_a[0];
    let e = meet(seam_b, cut_a);
    let f = meet(seam_a, cut_b);
    let flipped = |q: Vec2, axis: Vec2| axis * (2.0 * (q - p).dot(&axis)) - (q - p) + p;
    let hem = |n: Vec2, a: f64, seam: [Vec2; 2], other: [Vec2; 2]| {
        flipped(meet([p - n * a, seam[1]], other), seam[1])
    };
    let all = match kind {
        Corner::Mitre => vec![meet(cut_a, cut_b)],
        Corner::Bevel => return vec![p + n * a, p + m * b],
        Corner::SquareToNext => vec![e, e + m * b],
        Corner::SquareToPrevious => vec![f, f + n * a],
        Corner::Extended => vec![e, f],
        Corner::MirroredInPrevious => vec![f, hem(n, a, seam_a, cut_b)],
        Corner::MirroredInNext => vec![e, hem(m, b, seam_b, cut_a)],
    };
    let stepped = kind == Corner::Mitre && (b * cos > a || a * cos > b);
    let far = all.iter().any(|q| (q - p).norm() > 0.9 * limit);
    if stepped || far { Vec::new() } else { all }
}

/// Returns how many corners were found as vertices of the cut line.
fn check_corners(seam: &SeamLine, cut: &CutLine) -> usize {
    let polygon = cut.polygon();
    let border: Vec<[Vec2; 2]> = polygon.edges().collect();
    let mut found = 0;
    for ring in Loop::all(seam) {
        let count = ring.edges.len();
        for k in 0..count {
            let before = (k + count - 1) % count;
            if ring.legs.contains(&k) || ring.legs.contains(&before) {
                continue;
            }
            let (prev, next) = (&ring.edges[before], &ring.edges[k]);
            let p = next.curve.point(0.0);
            let normals = [ring.normal(&prev.curve, 1.0), ring.normal(&next.curve, 0.0)];
            let along =
                [prev.curve.derivative(1.0), next.curve.derivative(0.0)].map(|d| d.normalize());
            let widths = [prev.width, next.width];
            let mut lines = Lines {
                seam: [0, 1].map(|i| [p, along[i]]),
                cut: [0, 1].map(|i| [p + normals[i] * widths[i], along[i]]),
                normals,
                widths,
            };
            let mut kind = next.corner;
            if ring.sign < 0.0 {
                // Walked the other way.
                kind = common::other_way(kind);
                lines.seam.swap(0, 1);
                lines.cut.swap(0, 1);
                lines.normals.swap(0, 1);
                lines.widths.swap(0, 1);
            }
            let index = EdgeIndex {
                ring: ring.ring,
                edge: k,
            };
            // A seam line bent within the corner's reach has no straight lines to meet.
            let bent = [prev, next]
                .iter()
                .any(|e| !matches!(e.curve, Curve::Line { .. }));
            for tip in tips(kind, &lines) {
                let nearest = border
                    .iter()
                    .map(|s| (s[0] - tip).norm())
                    .fold(f64::INFINITY, f64::min);
                let inside = polygon.contains(tip);
                let trimmed_away = bent && !inside;
                assert!(
                    nearest < TOLERANCE || inside || trimmed_away,
                    "corner {index:?} {kind:?}: nothing at {tip:?}, {nearest}"
                );
                found += usize::from(nearest < TOLERANCE);
            }
        }
    }
    found
}

/// Cloth beside a point of the seam line along its normal (m), up to the first border.
fn cloth_beside(p: Vec2, normal: Vec2, border: &[[Vec2; 2]]) -> f64 {
    let hits = border.iter().filter_map(|&[a, b]| {
        let (from, to) = (normal.perp(&(a - p)), normal.perp(&(b - p)));
        let along = (a + (b - a) * (from / (from - to)) - p).dot(&normal);
        ((from <= 0.0) != (to <= 0.0) && along > -TOLERANCE).then_some(along)
    });
    hits.fold(f64::INFINITY, f64::min)
}

/// Whether a point is not beyond the cut line: of a hole, not in what remains of it.
fn is_cloth(p: Vec2, ring: usize, cut: &CutLine, polygon: &Polygon) -> bool {
    let mut parts = cut
        .holes
        .iter()
        .filter(|hole| hole.origins[0].edge.ring == ring);
    match ring {
        0 => polygon.contains(p),
        _ => !parts.any(|hole| Polygon::new(hole.points.clone()).contains(p)),
    }
}

/// The stretches without a cut line of their own, by brute force: sampled on the true curves.
fn check_stretches(seam: &SeamLine, cut: &CutLine) {
    let polygon: Polygon = cut.polygon();
    let border: Vec<[Vec2; 2]> = polygon.edges().collect();
    for ring in Loop::all(seam) {
        let shut = cut
            .findings
            .iter()
            .any(|f| matches!(f, Finding::HoleShut { hole, parts: 0 } if hole + 1 == ring.ring));
        if shut {
            continue;
        }
        for (k, edge) in ring.edges.iter().enumerate() {
            if !ring.legs.contains(&k) {
                let index = EdgeIndex {
                    ring: ring.ring,
                    edge: k,
                };
                check_edge(&ring, edge, cut, index, (&polygon, &border));
            }
        }
    }
}

fn check_edge(
    ring: &Loop,
    edge: &SeamEdge,
    cut: &CutLine,
    index: EdgeIndex,
    (polygon, border): (&Polygon, &[[Vec2; 2]]),
) {
    let stretches: Vec<([f64; 2], bool)> = cut
        .findings
        .iter()
        .filter_map(|finding| match finding {
            Finding::Swallowed { edge, span, .. } => Some((*edge, *span, true)),
            Finding::Narrow { edge, span, .. } => Some((*edge, *span, false)),
            _ => None,
        })
        .filter(|(edge, ..)| *edge == index)
        .map(|(_, span, swallowed)| (span, swallowed))
        .collect();
    let length = edge.curve.length();
    let count = (length / SAMPLE).ceil() as usize;
    // Greatest distance of the edge's own cut line from the border in each stretch listed.
    let mut seen = vec![(0.0f64, 0usize); stretches.len()];
    for i in 0..=count {
        let t = (i as f64 / count as f64).clamp(1e-6, 1.0 - 1e-6);
        let at = edge.curve.length_until(t);
        let normal = ring.normal(&edge.curve, t);
        let p = edge.curve.point(t);
        let own = p + normal * edge.width;
        let off = distance(own, border);
        let listed = |slack: f64, which: bool| {
            stretches.iter().position(|([from, to], swallowed)| {
                *swallowed == which && at > from - slack && at < to + slack
            })
        };
        // Below 0 the curve is tighter than its allowance and the parallel runs backwards.
        let step = ring.normal(&edge.curve, t + 1e-6) - ring.normal(&edge.curve, t - 1e-6);
        let way = edge.curve.point(t + 1e-6) - edge.curve.point(t - 1e-6);
        let speed = 1.0 + step.dot(&way) * edge.width / way.norm_squared();
        for which in [false, true] {
            if let Some(k) = listed(-SLACK, which) {
                let off = if speed < 0.0 { 1.0 } else { off };
                seen[k] = (seen[k].0.max(off), seen[k].1 + 1);
            }
        }
        // What the normal meets first is the cut line, farther or nearer than asked.
        let beside = cloth_beside(p, normal, border);
        let excess = beside - edge.width;
        if off > SHORT && excess.abs() > SHORT {
            let swallowed = is_cloth(own, index.ring, cut, polygon);
            assert!(
                listed(SLACK, swallowed).is_some(),
                "{index:?} at {at} of {length}: off by {off}, beside {beside}, width {}, {stretches:?}",
                edge.width
            );
        }
    }
    for (k, (off, samples)) in seen.into_iter().enumerate() {
        assert!(
            samples < 2 || off > 0.5 * TOLERANCE,
            "{index:?}: {:?} is cut as asked",
            stretches[k]
        );
    }
}

/// Number of stretches that do not hang on how curves are flattened, which is not the same backwards.
fn long_stretches(cut: &CutLine) -> usize {
    let long = |finding: &&Finding| match finding {
        Finding::Swallowed { span, .. } | Finding::Narrow { span, .. } => span[1] - span[0] > SLACK,
        _ => false,
    };
    cut.findings.iter().filter(long).count()
}

/// Corners found as vertices, over all cases.
static CORNERS: AtomicUsize = AtomicUsize::new(0);
static PIECES: AtomicUsize = AtomicUsize::new(0);

fn cases() -> u32 {
    let asked = std::env::var("CUT_CASES").ok();
    asked.and_then(|text| text.parse().ok()).unwrap_or(CASES)
}

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: cases(),
        failure_persistence: None,
        max_shrink_iters: 200,
        max_global_rejects: 10 * cases(),
        ..ProptestConfig::default()
    }
}

fn rng() -> TestRng {
    let mut seed = [0; 32];
    seed[..4].copy_from_slice(&cases().to_le_bytes());
    TestRng::from_seed(RngAlgorithm::ChaCha, &seed)
}

#[test]
fn random_pieces_are_cut_as_asked() {
    let numbers = prop::collection::vec(0.0..1.0f64, 97);
    // The same pieces every time, others in a soak of another length.
    let mut runner = TestRunner::new_with_rng(config(), rng());
    let run = runner.run(&numbers, |numbers| {
        let seam = random_seam(&numbers);
        let cut = match cut_line(&seam) {
            Err(CutError::Crossing(..) | CutError::StrayHole(_) | CutError::Dart(_)) => {
                return Err(TestCaseError::reject("no piece"));
            }
            found => found.unwrap(),
        };
        check_shape(&cut);
        check_widths(&seam, &cut);
        CORNERS.fetch_add(check_corners(&seam, &cut), Ordering::Relaxed);
        PIECES.fetch_add(1, Ordering::Relaxed);
        check_stretches(&seam, &cut);
        let turned = cut_line(&common::reversed(&seam)).unwrap();
        let (one, other) = (cut.polygon().area(), turned.polygon().area());
        prop_assert!((one - other).abs() < 1e-7, "{one} turned {other}");
        prop_assert_eq!(long_stretches(&cut), long_stretches(&turned));
        Ok(())
    });
    if let Err(error) = run {
        panic!("{error}");
    }
    let (corners, pieces) = (
        CORNERS.load(Ordering::Relaxed),
        PIECES.load(Ordering::Relaxed),
    );
    assert!(corners > 2 * pieces, "{corners} corners on {pieces} pieces");
}
