//! Target edge lengths for the triangles inside a piece, and distances from the boundary.

use crate::boundary::Boundary;
use crate::sampling::GROWTH;
use toile_geometry::Vec2;

/// Largest number of cells of a bucket grid, which limits the memory for needle-thin pieces.
const MAX_CELLS: f64 = 4e6;

/// Buckets of indices over a rectangle.
struct Grid {
    low: Vec2,
    cell: f64,
    columns: usize,
    rows: usize,
    buckets: Vec<Vec<u32>>,
}

impl Grid {
    fn new(low: Vec2, high: Vec2, cell: f64) -> Self {
        let extent = high - low;
        let cells = |c: f64| (extent.x / c + 1.0) * (extent.y / c + 1.0);
        let mut cell = cell;
        while cells(cell) > MAX_CELLS {
            cell *= 2.0;
        }
        let columns = (extent.x / cell) as usize + 1;
        let rows = (extent.y / cell) as usize + 1;
        Self {
            low,
            cell,
            columns,
            rows,
            buckets: vec![Vec::new(); columns * rows],
        }
    }

    fn place(&self, p: Vec2) -> (usize, usize) {
        let at = (p - self.low) / self.cell;
        (
            (at.x.max(0.0) as usize).min(self.columns - 1),
            (at.y.max(0.0) as usize).min(self.rows - 1),
        )
    }

    fn insert_disc(&mut self, centre: Vec2, radius: f64, index: u32) {
        let reach = Vec2::new(radius, radius);
        let ((i0, j0), (i1, j1)) = (self.place(centre - reach), self.place(centre + reach));
        for j in j0..=j1 {
            for i in i0..=i1 {
                self.buckets[j * self.columns + i].push(index);
            }
        }
    }

    fn at(&self, p: Vec2) -> &[u32] {
        let (i, j) = self.place(p);
        &self.buckets[j * self.columns + i]
    }
}

/// Target edge length at every point of a piece: the given edge length, or less near short boundary
/// intervals, growing gradually away from them.
pub(crate) struct SizeField {
    spacing: f64,
    sources: Vec<(Vec2, f64)>,
    near_sources: Grid,
    segments: Vec<[Vec2; 2]>,
    near_segments: Grid,
}

/// Distance from a point to a segment (m).
fn segment_distance(p: Vec2, [a, b]: [Vec2; 2]) -> f64 {
    let d = b - a;
    let t = ((p - a).dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
    (a + d * t - p).norm()
}

impl SizeField {
    /// The size field from the intervals of a boundary and the creases inside it.
    pub fn new(boundary: &Boundary, creases: &[[Vec2; 2]], spacing: f64) -> Self {
        let points = &boundary.points;
        let segments: Vec<[Vec2; 2]> = boundary
            .segments()
            .map(|s| s.map(|v| points[v]))
            .chain(creases.iter().copied())
            .collect();
        let first = points.first().copied().unwrap_or_default();
        let (low, high) = points
            .iter()
            .fold((first, first), |(l, h), p| (l.inf(p), h.sup(p)));
        let mut sources = Vec::new();
        for &[a, b] in &segments {
            let length = (b - a).norm();
            if length < 0.97 * spacing {
                sources.push(((a + b) * 0.5, length));
            }
        }
        let mut near_sources = Grid::new(low, high, 2.0 * spacing);
        for (k, &(point, size)) in sources.iter().enumerate() {
            near_sources.insert_disc(point, (spacing - size) / GROWTH, k as u32);
        }
        let mut near_segments = Grid::new(low, high, spacing);
        for (k, &[a, b]) in segments.iter().enumerate() {
            let reach = spacing + 0.5 * (b - a).norm();
            near_segments.insert_disc((a + b) * 0.5, reach, k as u32);
        }
        Self {
            spacing,
            sources,
            near_sources,
            segments,
            near_segments,
        }
    }

    /// The edge length away from short intervals (m).
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Target edge length at a point (m).
    pub fn size(&self, p: Vec2) -> f64 {
        self.near_sources
            .at(p)
            .iter()
            .map(|&k| {
                let (point, size) = self.sources[k as usize];
                size + GROWTH * (point - p).norm()
            })
            .fold(self.spacing, f64::min)
    }

    /// Distance to the boundary and to creases (m): exact up to the edge length, beyond it equal to the edge
    /// length.
    pub fn boundary_distance(&self, p: Vec2) -> f64 {
        self.near_segments
            .at(p)
            .iter()
            .map(|&k| segment_distance(p, self.segments[k as usize]))
            .fold(self.spacing, f64::min)
    }

    /// Points of a hexagonal lattice inside the boundary that keep a distance from it.
    pub fn lattice(&self, boundary: &Boundary) -> Vec<Vec2> {
        let h = self.spacing;
        let row_height = h * 0.75_f64.sqrt();
        let ys = boundary.points.iter().map(|p| p.y);
        let (low, high) = ys.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), y| {
            (l.min(y), u.max(y))
        });
        let rows = ((high - low) / row_height) as usize;
        let mut points = Vec::new();
        let margin = 0.5 * ((high - low) - rows as f64 * row_height);
        for row in 0..=rows {
            let y = low + margin + row as f64 * row_height;
            let mut crossings: Vec<f64> = boundary
                .segments()
                .map(|s| s.map(|v| boundary.points[v]))
                .filter(|[a, b]| (a.y > y) != (b.y > y))
                .map(|[a, b]| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
                .collect();
            crossings.sort_by(f64::total_cmp);
            let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
            for pair in crossings.chunks_exact(2) {
                let from = (pair[0] / h - shift).ceil() as i64;
                let to = (pair[1] / h - shift).floor() as i64;
                for i in from..=to {
                    let p = Vec2::new((i as f64 + shift) * h, y);
                    if self.size(p) > 0.9 * h && self.boundary_distance(p) > 0.6 * h {
                        points.push(p);
                    }
                }
            }
        }
        points
    }
}
