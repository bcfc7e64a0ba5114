//! Depth maps: the nearest surface along parallel rays of a far light (Williams 1978).

use toile_geometry::Vec3;

/// Heights towards a light over a square grid across its direction.
pub(crate) struct DepthMap {
    /// Unit vectors across the light and towards it.
    axes: [Vec3; 3],
    /// Corner of the grid in the first two axes (m).
    corner: [f64; 2],
    /// Cells a metre.
    pub cells_per_metre: f64,
    size: usize,
    /// Largest height in each cell (m); minus infinity where nothing is.
    heights: Vec<f32>,
}

impl DepthMap {
    /// Draws triangles as seen from the direction `towards` a light, on a grid of `size` cells a
    /// side that just holds all of them.
    pub(crate) fn new(
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        towards: Vec3,
        size: usize,
    ) -> Self {
        let axes = frame(towards);
        let local: Vec<[f64; 3]> = positions
            .iter()
            .map(|p| [p.dot(&axes[0]), p.dot(&axes[1]), p.dot(&axes[2])])
            .collect();
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for p in &local {
            for k in 0..2 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(1e-6);
        let cells_per_metre = (size - 4) as f64 / extent;
        let corner = [0, 1].map(|k| low[k] - 2.0 / cells_per_metre);
        let mut map = Self {
            axes,
            corner,
            cells_per_metre,
            size,
            heights: vec![f32::NEG_INFINITY; size * size],
        };
        let cells: Vec<[f32; 3]> = local
            .iter()
            .map(|p| {
                // Cell centres get whole numbers.
                let x = (p[0] - corner[0]) * cells_per_metre - 0.5;
                let y = (p[1] - corner[1]) * cells_per_metre - 0.5;
                [x as f32, y as f32, p[2] as f32]
            })
            .collect();
        for triangle in triangles {
            map.draw(triangle.map(|v| cells[v as usize]));
        }
        map
    }

    /// Raises the cells whose centre a triangle covers.
    fn draw(&mut self, [a, b, c]: [[f32; 3]; 3]) {
        // All corners lie inside the grid, so that casts round down.
        let low = |k: usize| a[k].min(b[k]).min(c[k]) as usize + 1;
        let high = |k: usize| a[k].max(b[k]).max(c[k]) as usize;
        let (columns, rows) = ([low(0), high(0)], [low(1), high(1)]);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if columns[0] > columns[1] || rows[0] > rows[1] || area.abs() < 1e-12 {
            return;
        }
        let inverse = area.recip();
        // Rounding must leave no gap between neighbours.
        let slack = -1e-4_f32;
        for y in rows[0]..=rows[1] {
            for x in columns[0]..=columns[1] {
                let (px, py) = (x as f32, y as f32);
                let v = ((px - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (py - a[1])) * inverse;
                let w = ((b[0] - a[0]) * (py - a[1]) - (px - a[0]) * (b[1] - a[1])) * inverse;
                if v >= slack && w >= slack && 1.0 - v - w >= slack {
                    let height = a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2]);
                    let cell = &mut self.heights[y * self.size + x];
                    *cell = cell.max(height);
                }
            }
        }
    }

    /// Part of the light that reaches a point, 0..=1: a box of `2 * reach` cells a side of
    /// comparisons with fractional ends, so that it changes smoothly with the place (Reeves,
    /// Salesin and Cook 1987). Blockers less than `bias` (m) above the point do not count.
    pub(crate) fn light(&self, p: Vec3, bias: f64, reach: usize) -> f64 {
        let x = (p.dot(&self.axes[0]) - self.corner[0]) * self.cells_per_metre;
        let y = (p.dot(&self.axes[1]) - self.corner[1]) * self.cells_per_metre;
        let height = (p.dot(&self.axes[2]) + bias) as f32;
        // Far outside there is nothing; inside, casts of positive numbers round down.
        let outside = |c: f64| c < -8.0 || c > self.size as f64 + 8.0;
        if outside(x) || outside(y) {
            return 1.0;
        }
        let reach = reach as i64;
        let (column, row) = ((x + 64.0) as i64 - 64, (y + 64.0) as i64 - 64);
        let (part_x, part_y) = (x - column as f64, y - row as f64);
        let weight = |offset: i64, part: f64| match offset {
            o if o == -reach => 1.0 - part,
            o if o == reach => part,
            _ => 1.0,
        };
        let mut sum = 0.0;
        for j in -reach..=reach {
            let mut line = 0.0;
            for i in -reach..=reach {
                if self.height(column + i, row + j) <= height {
                    line += weight(i, part_x);
                }
            }
            sum += line * weight(j, part_y);
        }
        sum / (4 * reach * reach) as f64
    }

    fn height(&self, x: i64, y: i64) -> f32 {
        let size = self.size as i64;
        if x < 0 || y < 0 || x >= size || y >= size {
            f32::NEG_INFINITY
        } else {
            self.heights[y as usize * self.size + x as usize]
        }
    }
}

/// Two unit vectors across a unit direction, and the direction itself (Duff et al. 2017).
fn frame(d: Vec3) -> [Vec3; 3] {
    let sign = 1.0_f64.copysign(d.z);
    let a = -1.0 / (sign + d.z);
    let b = d.x * d.y * a;
    [
        Vec3::new(1.0 + sign * d.x * d.x * a, sign * b, -sign * d.x),
        Vec3::new(b, sign + d.y * d.y * a, -d.y),
        d,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of a metre at height 1 over a square of four metres at height 0.
    fn table() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let square = |half: f64, y: f64| {
            [(-half, half), (half, half), (half, -half), (-half, -half)]
                .map(|(x, z)| Vec3::new(x, y, z))
        };
        let positions = [square(0.5, 1.0), square(2.0, 0.0)].concat();
        (positions, vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    }

    #[test]
    fn light_from_above_casts_a_square_shadow() {
        let (positions, triangles) = table();
        let map = DepthMap::new(&positions, &triangles, Vec3::y(), 256);
        let at = |x: f64, y: f64| map.light(Vec3::new(x, y, 0.1), 0.01, 2);
        assert_eq!(at(0.0, 0.0), 0.0);
        assert_eq!(at(0.0, 1.0), 1.0);
        assert_eq!(at(1.0, 0.0), 1.0);
        assert!((at(0.5, 0.0) - 0.5).abs() < 0.3);
        assert_eq!(at(50.0, 0.0), 1.0);
    }

    #[test]
    fn the_edge_of_a_shadow_is_smooth() {
        let (positions, triangles) = table();
        let map = DepthMap::new(&positions, &triangles, Vec3::y(), 256);
        let values: Vec<f64> = (0..200)
            .map(|k| map.light(Vec3::new(0.4 + 0.001 * f64::from(k), 0.0, 0.0), 0.01, 2))
            .collect();
        assert_eq!((values[0], values[199]), (0.0, 1.0));
        for pair in values.windows(2) {
            assert!(pair[1] >= pair[0] && pair[1] - pair[0] < 0.05);
        }
    }

    #[test]
    fn frames_are_right_handed_everywhere() {
        for d in [
            Vec3::y(),
            -Vec3::y(),
            Vec3::z(),
            -Vec3::z(),
            Vec3::new(0.6, 0.0, -0.8),
        ] {
            let [a, b, c] = frame(d);
            assert!((a.cross(&b) - c).norm() < 1e-12 && (a.norm() - 1.0).abs() < 1e-12);
        }
    }
}
