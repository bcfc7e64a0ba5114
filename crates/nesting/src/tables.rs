//! No-fit polygons and depth rasters of all pairs of shapes, within memory limits.

use crate::depth_raster::{DepthRaster, LANES, padded};
use crate::job::Job;
use crate::maps::{Maps, RASTER_NUMBERS};
use crate::marker::Pose;
use crate::pair::Pair;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::OnceLock;
use toile_geometry::Vec2;

/// Largest number of pairs of shapes, 64 bytes each: 256 MB.
const MAX_PAIRS: usize = 4_000_000;
/// Largest number of rows of the loss maps.
const ROWS: f64 = 64.0;
/// Smallest size of a depth raster: three rows of two SIMD groups.
const MIN_NUMBERS: f64 = 96.0;

/// Marks a pair of shapes that may overlap and has no polygon.
const NO_POLYGON: u32 = u32::MAX;

impl Job<'_> {
    /// Assigns no-fit polygons to all pairs. With N(a, b) = a + (-b) and an isometry Q, N(Qa, Qb) = Q N(a, b)
    /// and N(b, a) = -N(a, b), so one polygon serves all pairs in equal relative positions. Returns false as
    /// soon as more than `most` polygons or too much memory would be needed, or if `stop` returns true.
    pub(crate) fn pair_up(&mut self, most: usize, stop: &dyn Fn() -> bool) -> bool {
        self.keys.clear();
        let count = self.shapes.len();
        if count * count > MAX_PAIRS {
            return false;
        }
        let mut rasters: BTreeMap<(usize, usize, u64), u32> = BTreeMap::new();
        let mut known: BTreeMap<(usize, usize, i64, bool), u32> = BTreeMap::new();
        let mut pairs = Vec::with_capacity(count * count);
        for a in &self.shapes {
            let too_many =
                known.len() > most || rasters.len() as f64 * MIN_NUMBERS > Maps::COARSE.numbers;
            if too_many || stop() {
                return false;
            }
            for b in &self.shapes {
                let gap = self.gap(a.kind, b.kind);
                let swapped = b.ring < a.ring;
                let (fixed, moving) = if swapped { (b, a) } else { (a, b) };
                let apart = moving.turn - fixed.turn;
                let apart = if fixed.mirrored { -apart } else { apart };
                let angle = (apart.rem_euclid(TAU) * 1e9).round() as i64;
                let angle = angle % (TAU * 1e9).round() as i64;
                let mirrored = fixed.mirrored != moving.mirrored;
                let key = (fixed.ring, moving.ring, angle, mirrored);
                let next = known.len() as u32;
                let no_fit = match gap.is_finite() {
                    true => *known.entry(key).or_insert(next),
                    false => NO_POLYGON,
                };
                if no_fit == next {
                    self.keys.push((fixed.ring, moving.ring, apart, mirrored));
                }
                let sign = if swapped { -1.0 } else { 1.0 };
                let pose = Pose {
                    grain: 0.0,
                    turn: fixed.turn,
                    mirrored: fixed.mirrored,
                    translation: Vec2::zeros(),
                };
                let axes = pose.axes().map(|axis| axis * sign);
                let between = a.offset - b.offset;
                let next = rasters.len() as u32;
                let raster = rasters.entry((a.look, b.look, gap.to_bits()));
                pairs.push(Pair {
                    no_fit,
                    raster: *raster.or_insert(next),
                    axes,
                    shift: Vec2::new(between.dot(&axes[0]), between.dot(&axes[1])),
                    gap,
                });
            }
        }
        let gaps = pairs.iter().map(|p| p.gap);
        self.widest_gap = gaps.filter(|g| g.is_finite()).fold(0.0, f64::max);
        self.no_fits = known.iter().map(|_| OnceLock::new()).collect();
        self.rasters = rasters.iter().map(|_| OnceLock::new()).collect();
        self.pairs = pairs;
        self.no_fits.len() <= most
    }

    /// Chooses the grid spacing of the loss maps so that the depth rasters stay small; returns whether they
    /// fit into memory.
    pub(crate) fn choose_spacing(&mut self, maps: Maps) -> bool {
        let count = self.shapes.len();
        let mut seen = vec![false; self.rasters.len()];
        let mut firsts = Vec::with_capacity(self.rasters.len());
        for (k, pair) in self.pairs.iter().enumerate() {
            if !std::mem::replace(&mut seen[pair.raster as usize], true) {
                firsts.push((k / count, k % count));
            }
        }
        let numbers = |job: &Self| -> f64 {
            let each = firsts.iter().map(|&pair| DepthRaster::numbers(job, pair));
            each.sum()
        };
        self.spacing = self.height / ROWS;
        let mut sum = numbers(self);
        while sum > RASTER_NUMBERS && self.spacing < self.height / maps.rows {
            self.spacing *= 1.05;
            sum = numbers(self);
        }
        sum <= maps.numbers
    }

    /// The losses of a moving shape at grid positions relative to a fixed one.
    pub fn raster(&self, fixed: usize, moving: usize) -> &DepthRaster {
        let number = self.pairs[fixed * self.shapes.len() + moving].raster;
        self.rasters[number as usize].get_or_init(|| DepthRaster::new(self, fixed, moving))
    }
}

impl DepthRaster {
    /// First and last cell of a pair's raster along an axis.
    fn ends(job: &Job<'_>, (fixed, moving): (usize, usize), axis: usize) -> [f64; 2] {
        let (a, b) = (&job.shapes[fixed], &job.shapes[moving]);
        let more = job.widest_gap + job.growth();
        [
            ((-b.size[axis] - more) / job.spacing).floor(),
            ((a.size[axis] + more) / job.spacing).ceil(),
        ]
    }

    /// First cell of a pair's raster, with the number of columns and rows.
    fn extent(job: &Job<'_>, pair: (usize, usize)) -> ([i32; 2], usize, usize) {
        let [x, y] = [0, 1].map(|axis| Self::ends(job, pair, axis));
        let count = |[low, high]: [f64; 2]| (high - low + 1.0) as usize;
        ([x[0] as i32, y[0] as i32], count(x), count(y))
    }

    /// Size of a pair's raster (numbers), as a float that cannot overflow.
    fn numbers(job: &Job<'_>, pair: (usize, usize)) -> f64 {
        let count = |axis: usize| {
            let [low, high] = Self::ends(job, pair, axis);
            high - low + 1.0
        };
        let lanes = LANES as f64;
        ((count(0) / lanes).ceil() + 1.0) * lanes * count(1)
    }

    /// Samples the loss of a pair of shapes at every cell where it may be positive.
    fn new(job: &Job<'_>, fixed: usize, moving: usize) -> Self {
        let (first, columns, rows) = Self::extent(job, (fixed, moving));
        let stride = padded(columns);
        let mut values = Vec::with_capacity(stride * rows);
        for row in 0..rows {
            for column in 0..columns {
                let cell = Vec2::new(
                    f64::from(first[0] + column as i32),
                    f64::from(first[1] + row as i32),
                );
                values.push(job.loss(fixed, moving, cell * job.spacing) as f32);
            }
            values.resize((row + 1) * stride, 0.0);
        }
        Self {
            first,
            columns,
            stride,
            values,
        }
    }
}
