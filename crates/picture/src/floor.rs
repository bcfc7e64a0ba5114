//! The ground and the soft shadow on it.
//!
//! Under a wide sky the shadow of a thing at height h is its outline from above, blurred over a
//! width in proportion to h. The scene is cut into a few layers of height, each is drawn from
//! above and blurred by a Gaussian, and the layers' shadows are multiplied (after Soler and
//! Sillion 1998, with one blur a layer).

use toile_geometry::Vec3;

/// The ground under a scene and how much sky it sees.
pub(crate) struct Floor {
    /// Its height (m).
    pub height: f64,
    corner: [f64; 2],
    /// Distance of grid points (m).
    step: f64,
    /// Light of the sky on each grid point, 1 in the open.
    light: Vec<f64>,
}

/// Grid points a side.
const GRID: usize = 200;

/// Upper end of a layer of height and width of its blur (m) for a scene two metres across;
/// both grow with the scene. The last number is the darkness of the layer's shadow.
const LAYERS: [[f64; 3]; 4] = [
    [0.03, 0.012, 0.60],
    [0.14, 0.045, 0.42],
    [0.50, 0.130, 0.30],
    [f64::INFINITY, 0.200, 0.15],
];

impl Floor {
    /// The ground under the lowest triangle, for a scene within bounds.
    pub(crate) fn under(
        [low, high]: [Vec3; 2],
        positions: &[Vec3],
        triangles: &[[u32; 3]],
    ) -> Self {
        let size = (high - low).norm().max(1e-3) / 2.0;
        let middle = 0.5 * (low + high);
        let reach = 0.5 * (high.x - low.x).max(high.z - low.z) + 0.9 * size;
        let step = 2.0 * reach / (GRID - 1) as f64;
        let mut floor = Self {
            height: low.y,
            corner: [middle.x - reach, middle.z - reach],
            step,
            light: vec![1.0; GRID * GRID],
        };
        let mut bottom = 0.0;
        for [top, blur, darkness] in LAYERS {
            let mut cover = vec![0.0; GRID * GRID];
            for triangle in triangles {
                let corners = triangle.map(|v| positions[v as usize]);
                let height = corners.iter().map(|p| p.y).fold(f64::INFINITY, f64::min) - low.y;
                if (bottom * size..top * size).contains(&height) {
                    floor.draw(corners, &mut cover);
                }
            }
            blurred(&mut cover, blur * size / step);
            for (light, cover) in floor.light.iter_mut().zip(&cover) {
                *light *= 1.0 - darkness * cover;
            }
            bottom = top;
        }
        floor
    }

    /// Marks the grid points under a triangle.
    fn draw(&self, corners: [Vec3; 3], cover: &mut [f64]) {
        let [a, b, c] = corners.map(|p| {
            [
                (p.x - self.corner[0]) / self.step,
                (p.z - self.corner[1]) / self.step,
            ]
        });
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area.abs() < 1e-12 {
            return;
        }
        let low = |k: usize| a[k].min(b[k]).min(c[k]).max(0.0) as usize;
        let high = |k: usize| (a[k].max(b[k]).max(c[k]) as usize + 1).min(GRID - 1);
        for j in low(1)..=high(1) {
            for i in low(0)..=high(0) {
                let (x, y) = (i as f64 - a[0], j as f64 - a[1]);
                let v = (x * (c[1] - a[1]) - (c[0] - a[0]) * y) / area;
                let w = ((b[0] - a[0]) * y - x * (b[1] - a[1])) / area;
                if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
                    cover[j * GRID + i] = 1.0;
                }
            }
        }
    }

    /// Light of the sky on the ground, 1 in the open and far away.
    pub(crate) fn light(&self, p: Vec3) -> f64 {
        let u = (p.x - self.corner[0]) / self.step;
        let v = (p.z - self.corner[1]) / self.step;
        let last = (GRID - 1) as f64;
        if !((0.0..last).contains(&u) && (0.0..last).contains(&v)) {
            return 1.0;
        }
        let (i, j) = (u as usize, v as usize);
        let at = |i: usize, j: usize| self.light[j * GRID + i];
        let (a, b) = (u - i as f64, v - j as f64);
        let near = at(i, j) * (1.0 - a) + at(i + 1, j) * a;
        let far = at(i, j + 1) * (1.0 - a) + at(i + 1, j + 1) * a;
        near * (1.0 - b) + far * b
    }
}

/// A Gaussian blur with a standard deviation in grid steps, first along rows, then along columns.
fn blurred(values: &mut Vec<f64>, deviation: f64) {
    let reach = (3.0 * deviation).ceil().max(1.0) as usize;
    let kernel: Vec<f64> = (0..=reach)
        .map(|k| (-0.5 * (k as f64 / deviation.max(0.3)).powi(2)).exp())
        .collect();
    let sum = 2.0 * kernel.iter().sum::<f64>() - kernel[0];
    for _ in 0..2 {
        // Writing the result transposed turns the second pass into that along columns.
        let mut next = vec![0.0; GRID * GRID];
        for j in 0..GRID {
            let row = &values[j * GRID..(j + 1) * GRID];
            if row.iter().all(|&value| value == 0.0) {
                continue;
            }
            for i in 0..GRID {
                let first = i.saturating_sub(reach);
                let last = (i + reach).min(GRID - 1);
                let total: f64 = (first..=last).map(|k| row[k] * kernel[k.abs_diff(i)]).sum();
                next[i * GRID + j] = total / sum;
            }
        }
        *values = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of half a metre at a height above a corner of the ground far away.
    fn floor_under(height: f64) -> Floor {
        let positions = [(-0.25, 0.25), (0.25, 0.25), (0.25, -0.25), (-0.25, -0.25)]
            .map(|(x, z)| Vec3::new(x, height, z));
        let bounds = [Vec3::new(-0.25, 0.0, -0.25), Vec3::new(0.25, 1.0, 1.6)];
        Floor::under(bounds, &positions, &[[0, 1, 2], [0, 2, 3]])
    }

    #[test]
    fn a_thing_on_the_ground_has_a_sharp_shadow_and_a_high_one_a_soft_one() {
        let light = |floor: &Floor, x: f64| floor.light(Vec3::new(x, 0.0, 0.0));
        let (near, far) = (floor_under(0.01), floor_under(0.9));
        assert!(light(&near, 0.0) < 0.5 && light(&far, 0.0) > light(&near, 0.0));
        assert!(light(&near, 0.32) > 0.999 && light(&far, 0.32) < 0.97);
        assert_eq!(light(&near, 50.0), 1.0);
    }

    #[test]
    fn a_blur_keeps_the_sum_and_is_symmetric() {
        let mut values = vec![0.0; GRID * GRID];
        values[100 * GRID + 90] = 1.0;
        blurred(&mut values, 4.0);
        assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        for k in 1..12 {
            let at = |i: usize, j: usize| values[j * GRID + i];
            assert!((at(90 + k, 100) - at(90 - k, 100)).abs() < 1e-15);
            assert!((at(90 + k, 100) - at(90, 100 + k)).abs() < 1e-15);
        }
    }
}
