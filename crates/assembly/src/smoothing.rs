//! Moves interior vertices to better positions without moving the boundary.

use crate::circumcircle::circumcircle;
use crate::planar::{Frame, Planar};
use crate::quality::smallest_angle;
use crate::size_field::SizeField;
use toile_geometry::{Vec2, orient2d};

/// Triangles with a smaller angle are improved one by one (rad).
const POOR: f64 = 0.56;
/// Corners narrower than this keep their ear: splitting it would make two sharper triangles (rad).
const NARROW_EAR: f64 = 1.25;

/// Sweeps of optimal Delaunay smoothing (Chen 2004): each vertex moves to the mean of the circumcentres of
/// its triangles, weighted by area over target area, then edges are flipped. Circumcentres outside their
/// triangle are moved back to it, which keeps the sweep stable at the boundary.
pub(crate) fn relax(planar: &mut Planar, frame: &Frame, field: &SizeField, sweeps: usize) {
    for _ in 0..sweeps {
        let stars = planar.stars();
        for (v, star) in stars.iter().enumerate().skip(frame.fixed) {
            if let Some(target) = smoothed(planar, field, v, star) {
                move_towards(planar, v, star, target);
            }
        }
        planar.make_delaunay();
    }
}

fn smoothed(planar: &Planar, field: &SizeField, v: usize, star: &[usize]) -> Option<Vec2> {
    let mut sum = Vec2::zeros();
    let mut total = 0.0;
    let here = field.size(planar.points[v]);
    for &t in star {
        let [a, b, c] = planar.corners(t);
        let area = 0.5 * (b - a).perp(&(c - a));
        let centroid = (a + b + c) / 3.0;
        let size = field.size(centroid);
        let (centre, _) = circumcircle(a, b, c)?;
        let offset = centre - centroid;
        let reach = 0.4 * here;
        let centre = centroid + offset * (reach / offset.norm().max(reach));
        let weight = area / (size * size);
        sum += centre * weight;
        total += weight;
    }
    (total > 0.0).then(|| sum / total)
}

/// Whether all triangles of a star stay counter-clockwise when the vertex is moved.
fn stays_valid(planar: &Planar, v: usize, star: &[usize], place: Vec2) -> bool {
    star.iter().all(|&t| {
        let p = planar.triangles[t].map(|w| if w == v { place } else { planar.points[w] });
        orient2d(p[0], p[1], p[2]) > 0.0
    })
}

fn move_towards(planar: &mut Planar, v: usize, star: &[usize], target: Vec2) {
    let from = planar.points[v];
    let mut share = 1.0;
    for _ in 0..5 {
        let place = from + (target - from) * share;
        if stays_valid(planar, v, star, place) {
            planar.points[v] = place;
            return;
        }
        share *= 0.5;
    }
}

/// Flips the long edge of triangles with two boundary edges, if the corner is wide enough, so that the corner
/// vertex is connected to the interior.
pub(crate) fn open_ears(planar: &mut Planar, frame: &Frame) {
    for t in 0..planar.triangles.len() {
        let Some(k) = (0..3).find(|&k| !planar.locked[t][k]) else {
            continue;
        };
        if planar.locked[t].iter().filter(|&&l| l).count() != 2 || !planar.can_flip(t, k) {
            continue;
        }
        let Some(([a, b, c, d], _)) = planar.quad(t, k) else {
            continue;
        };
        let p = |v: usize| planar.points[v];
        let corner = (p(b) - p(a)).angle(&(p(c) - p(a)));
        let after = smallest_angle([p(a), p(b), p(d)]).min(smallest_angle([p(a), p(d), p(c)]));
        if d >= frame.fixed && corner > NARROW_EAR && after > POOR {
            planar.flip(t, k);
        }
    }
}

/// Moves the vertices of poor triangles by hill climbing so that the smallest angle of each star grows, and
/// flips edges if that helps (local optimisation after Freitag and Ollivier-Gooch 1997).
pub(crate) fn improve_worst(planar: &mut Planar, frame: &Frame, field: &SizeField) {
    for _ in 0..12 {
        let stars = planar.stars();
        let mut moved = false;
        for t in 0..planar.triangles.len() {
            if smallest_angle(planar.corners(t)) >= POOR {
                continue;
            }
            for v in planar.triangles[t] {
                if v >= frame.fixed {
                    moved |= climb(planar, v, &stars[v], 0.25 * field.size(planar.points[v]));
                }
            }
        }
        let mut flipped = false;
        for t in 0..planar.triangles.len() {
            for k in 0..3 {
                flipped |= flip_if_better(planar, t, k);
            }
        }
        if !moved && !flipped {
            break;
        }
    }
}

fn flip_if_better(planar: &mut Planar, t: usize, k: usize) -> bool {
    if !planar.can_flip(t, k) {
        return false;
    }
    let Some(([a, b, c, d], _)) = planar.quad(t, k) else {
        return false;
    };
    let p = |v: usize| planar.points[v];
    let angle = |x, y, z| smallest_angle([p(x), p(y), p(z)]);
    let before = angle(a, b, c).min(angle(d, c, b));
    let after = angle(a, b, d).min(angle(a, d, c));
    let better = before < POOR && after > before + 1e-6;
    if better {
        planar.flip(t, k);
    }
    better
}

fn climb(planar: &mut Planar, v: usize, star: &[usize], first_step: f64) -> bool {
    let score = |planar: &Planar, place: Vec2| {
        star.iter()
            .map(|&t| {
                let p = planar.triangles[t].map(|w| if w == v { place } else { planar.points[w] });
                if orient2d(p[0], p[1], p[2]) > 0.0 {
                    smallest_angle(p)
                } else {
                    -1.0
                }
            })
            .fold(f64::INFINITY, f64::min)
    };
    let start = score(planar, planar.points[v]);
    let (mut best, mut place) = (start, planar.points[v]);
    let mut step = first_step;
    for _ in 0..14 {
        let mut found = false;
        for k in 0..8 {
            let angle = f64::from(k) * std::f64::consts::FRAC_PI_4;
            let next = place + Vec2::new(angle.cos(), angle.sin()) * step;
            let value = score(planar, next);
            if value > best + 1e-9 {
                (best, place, found) = (value, next, true);
            }
        }
        if !found {
            step *= 0.5;
        }
    }
    planar.points[v] = place;
    best > start + 1e-6
}
