//! Interior vertices of a piece: seeded, added where triangles are too large, removed where they crowd,
//! smoothed until triangles are nearly equilateral.

use crate::circumcircle::circumcircle;
use crate::planar::{Frame, NONE, Planar};
use crate::size_field::SizeField;
use crate::smoothing;
use toile_geometry::{TriangulationError, Vec2, orient2d};

/// Number of rounds of adding and removing vertices.
const ROUNDS: usize = 10;
/// Largest circumradius of a triangle, relative to the target edge length (an equilateral triangle with that
/// edge has 0.577).
const MAX_RADIUS: f64 = 0.76;
/// Distance between vertices, relative to the target edge length, below which they are thinned out.
const CROWDED: f64 = 0.62;
/// Distance of new vertices from the boundary, relative to the target edge length.
const BOUNDARY_CLEARANCE: f64 = 0.38;

/// Meshes the inside of a frame; the first `frame.fixed` points stay unchanged.
pub(crate) fn refine(
    fixed: Vec<Vec2>,
    seeds: Vec<Vec2>,
    frame: &Frame,
    field: &SizeField,
) -> Result<Planar, TriangulationError> {
    let mut points = fixed;
    points.extend(seeds);
    let mut planar = Planar::new(points, frame)?;
    for round in 0..ROUNDS {
        smoothing::relax(&mut planar, frame, field, 6);
        let removed = crowded(&planar, frame, field);
        let added = missing_vertices(&planar, frame, field);
        let changes = added.len() + removed.iter().filter(|&&r| r).count();
        if changes == 0 || (round + 1 == ROUNDS) {
            break;
        }
        let mut points: Vec<Vec2> = Vec::with_capacity(planar.points.len() + added.len());
        for (v, &p) in planar.points.iter().enumerate() {
            if !removed[v] {
                points.push(p);
            }
        }
        points.extend(added);
        planar = Planar::new(points, frame)?;
    }
    smoothing::relax(&mut planar, frame, field, 12);
    smoothing::open_ears(&mut planar, frame);
    smoothing::improve_worst(&mut planar, frame, field);
    Ok(planar)
}

/// Interior vertices to be removed: too near to another, or badly connected.
fn crowded(planar: &Planar, frame: &Frame, field: &SizeField) -> Vec<bool> {
    let mut removed = vec![false; planar.points.len()];
    let stars = planar.stars();
    for v in frame.fixed..planar.points.len() {
        let p = planar.points[v];
        let ring: Vec<usize> = stars[v]
            .iter()
            .flat_map(|&t| planar.triangles[t])
            .filter(|&w| w != v)
            .collect();
        if ring.iter().any(|&w| removed[w]) {
            continue;
        }
        let size = field.size(p);
        let nearest = ring
            .iter()
            .map(|&w| (planar.points[w] - p).norm())
            .fold(f64::INFINITY, f64::min);
        let few = stars[v].len() < 4;
        if few || nearest < CROWDED * size || field.boundary_distance(p) < 0.3 * size {
            removed[v] = true;
        }
    }
    removed
}

/// New vertices where triangles are too large or connect boundary with boundary.
fn missing_vertices(planar: &Planar, frame: &Frame, field: &SizeField) -> Vec<Vec2> {
    let mut candidates: Vec<(f64, Vec2)> = Vec::new();
    for t in 0..planar.triangles.len() {
        let [a, b, c] = planar.corners(t);
        let centroid = (a + b + c) / 3.0;
        let size = field.size(centroid);
        if let Some((centre, radius)) = circumcircle(a, b, c) {
            let excess = radius / size;
            if excess > MAX_RADIUS {
                let inside = walk(planar, t, centre).is_some();
                candidates.push((excess, if inside { centre } else { centroid }));
            }
        }
        for k in 0..3 {
            if let Some(middle) = crossing_edge(planar, frame, field, t, k) {
                candidates.push((0.5, middle));
            }
        }
    }
    candidates.sort_by(|x, y| {
        y.0.total_cmp(&x.0)
            .then(x.1.x.total_cmp(&y.1.x))
            .then(x.1.y.total_cmp(&y.1.y))
    });
    let mut accepted: Vec<Vec2> = Vec::new();
    let mut buckets: std::collections::HashMap<(i64, i64), Vec<u32>> =
        std::collections::HashMap::new();
    let cell = field.spacing();
    for (_, p) in candidates {
        let size = field.size(p);
        if field.boundary_distance(p) < BOUNDARY_CLEARANCE * size {
            continue;
        }
        let key = ((p.x / cell).floor() as i64, (p.y / cell).floor() as i64);
        let clear = (-1..=1).all(|i| {
            (-1..=1).all(|j| {
                buckets.get(&(key.0 + i, key.1 + j)).is_none_or(|list| {
                    list.iter()
                        .all(|&k| (accepted[k as usize] - p).norm() > 0.8 * size)
                })
            })
        });
        if clear {
            buckets.entry(key).or_default().push(accepted.len() as u32);
            accepted.push(p);
        }
    }
    accepted
}

/// Midpoint of an edge that connects two boundary vertices across the piece, unless it merely cuts off a
/// corner.
fn crossing_edge(
    planar: &Planar,
    frame: &Frame,
    field: &SizeField,
    t: usize,
    k: usize,
) -> Option<Vec2> {
    let other = planar.neighbours[t][k];
    if planar.locked[t][k] || other == NONE || other < t {
        return None;
    }
    let ([_, b, c, _], _) = planar.quad(t, k)?;
    if b >= frame.fixed || c >= frame.fixed {
        return None;
    }
    let ear = |t: usize| planar.locked[t].iter().filter(|&&l| l).count() >= 2;
    if ear(t) || ear(other) {
        return None;
    }
    let middle = (planar.points[b] + planar.points[c]) * 0.5;
    let length = (planar.points[b] - planar.points[c]).norm();
    (length > 0.85 * field.size(middle)).then_some(middle)
}

/// The triangle that contains a point, found by walking from `start` without crossing a locked edge.
fn walk(planar: &Planar, start: usize, target: Vec2) -> Option<usize> {
    let mut t = start;
    'steps: for _ in 0..64 {
        let corners = planar.corners(t);
        for k in 0..3 {
            if orient2d(corners[(k + 1) % 3], corners[(k + 2) % 3], target) < 0.0 {
                if planar.locked[t][k] {
                    return None;
                }
                t = planar.neighbours[t][k];
                continue 'steps;
            }
        }
        return Some(t);
    }
    None
}
