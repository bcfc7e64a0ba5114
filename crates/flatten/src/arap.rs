//! As-rigid-as-possible steps (Liu, Zhang, Xu, Gotsman and Gortler 2008): every triangle is turned as the flat shape
//! turns it, then the places that fit all of them best are solved for.

use crate::conformal::flipped;
use crate::cotangent::{Cotangent, cotangents};
use crate::{FlattenError, Region};
use toile_geometry::Vec2;

/// Steps of a start.
pub const STEPS: usize = 20;

/// Halvings of a step that would flip a triangle, before the steps end.
const MAX_HALVINGS: usize = 8;

/// Takes up to so many steps from a flat shape without flipped triangles; none flips one (m).
///
/// # Errors
/// The triangles are too thin.
pub fn arap(region: &Region, flat: &mut [Vec2], steps: usize) -> Result<(), FlattenError> {
    let mut matrix = Cotangent::new(region)?;
    let mut right = vec![Vec2::zeros(); flat.len()];
    let mut fitted = vec![Vec2::zeros(); flat.len()];
    let mut trial = flat.to_vec();
    for _ in 0..steps {
        right.iter_mut().for_each(|r| *r = Vec2::zeros());
        for (triangle, corners) in region.mesh().triangles.iter().zip(region.flat()) {
            let places = triangle.map(|v| flat[v as usize]);
            let weights = cotangents(*corners);
            let turn = best_rotation(*corners, places, weights);
            for (k, weight) in weights.into_iter().enumerate() {
                let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                let side = turn(corners[a] - corners[b]) * (0.5 * weight);
                right[triangle[a] as usize] += side;
                right[triangle[b] as usize] -= side;
            }
        }
        matrix.solve(&right, &mut fitted);
        // The held vertex comes out at the origin; the shape stays about its middle.
        let middle = |p: &[Vec2]| p.iter().sum::<Vec2>() / p.len() as f64;
        let shift = middle(flat) - middle(&fitted);
        let mut share = 1.0;
        let mut halvings = 0;
        loop {
            for ((to, from), new) in trial.iter_mut().zip(flat.iter()).zip(&fitted) {
                *to = from + (new + shift - from) * share;
            }
            if flipped(region, &trial) == 0 {
                break;
            }
            share *= 0.5;
            halvings += 1;
            if halvings > MAX_HALVINGS {
                return Ok(());
            }
        }
        flat.copy_from_slice(&trial);
    }
    Ok(())
}

/// The rotation that takes the sides of a triangle to those of its image best, sides weighted by cotangents.
fn best_rotation(from: [Vec2; 3], to: [Vec2; 3], weights: [f64; 3]) -> impl Fn(Vec2) -> Vec2 {
    let (mut cosine, mut sine) = (0.0, 0.0);
    for (k, weight) in weights.into_iter().enumerate() {
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        let (u, v) = (from[a] - from[b], to[a] - to[b]);
        cosine += weight * u.dot(&v);
        sine += weight * u.perp(&v);
    }
    let length = cosine.hypot(sine);
    let (cosine, sine) = if length > 0.0 {
        (cosine / length, sine / length)
    } else {
        (1.0, 0.0)
    };
    move |p| Vec2::new(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y)
}
