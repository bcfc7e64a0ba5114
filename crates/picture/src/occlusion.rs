//! Ambient occlusion: the share of the sky that each point sees, averaged over many far lights (Zhukov, Iones
//! and Kronin 1998; by depth maps as Pharr and Green 2004).

use crate::depth_map::DepthMap;
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Directions of the far lights.
const DIRECTIONS: usize = 40;
/// Cells a side of each depth map.
const CELLS: usize = 224;

/// The light of a sky that is bright above and half as bright below, which reaches both sides of
/// each point: along its normal and against it; 1 for a point in the open that faces up.
pub(crate) fn ambient(points: &[Vec3], normals: &[Vec3], triangles: &[[u32; 3]]) -> Vec<[f32; 2]> {
    let directions = sphere(DIRECTIONS);
    let reached: Vec<Vec<f32>> = directions
        .par_iter()
        .map(|&towards| {
            let map = DepthMap::new(points, triangles, towards, CELLS);
            // A point must not be hidden by the slope of its own surface within a cell.
            let step = 1.5 / map.cells_per_metre;
            points
                .iter()
                .zip(normals)
                .map(|(p, n)| {
                    let out = n * (step * 1_f64.copysign(n.dot(&towards)));
                    map.light(p + out, step, 1) as f32
                })
                .collect()
        })
        .collect();
    (0..points.len())
        .into_par_iter()
        .map(|v| {
            let mut sums = [[0.0_f64; 2]; 2];
            for (towards, light) in directions.iter().zip(&reached) {
                let cosine = normals[v].dot(towards);
                let sky = cosine.abs() * (0.75 + 0.25 * towards.y);
                let side = &mut sums[usize::from(cosine < 0.0)];
                side[0] += sky * f64::from(light[v]);
                side[1] += cosine.abs();
            }
            sums.map(|[light, whole]| (light / whole.max(1e-9)) as f32)
        })
        .collect()
}

/// Directions spread evenly over the sphere (Vogel 1979).
fn sphere(count: usize) -> Vec<Vec3> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..count)
        .map(|k| {
            let y = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
            let radius = (1.0 - y * y).sqrt();
            let (sine, cosine) = (golden * k as f64).sin_cos();
            Vec3::new(radius * cosine, y, radius * sine)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn open_sky_and_closed_box() {
        let open = ambient(&[Vec3::zeros()], &[Vec3::y()], &[]);
        assert!(open[0][0] > 0.85 && open[0][1] < 0.7, "{open:?}");
        // A floor far wider than the distance hides everything below.
        let mut points = vec![Vec3::zeros()];
        points.extend(
            [(-9.0, 9.0), (9.0, 9.0), (9.0, -9.0), (-9.0, -9.0)]
                .map(|(x, z)| Vec3::new(x, -1.0, z)),
        );
        let above = ambient(&points, &[Vec3::y(); 5], &[[1, 2, 3], [1, 3, 4]]);
        assert!((above[0][0] - open[0][0]).abs() < 1e-6);
        assert!(above[0][1] < 0.1, "{above:?}");
    }

    #[test]
    fn directions_are_units_without_a_preferred_side() {
        let directions = sphere(DIRECTIONS);
        let sum: Vec3 = directions.iter().sum();
        assert!(sum.norm() < 0.5, "{sum}");
        assert!(directions.iter().all(|d| (d.norm() - 1.0).abs() < 1e-12));
    }
}
