//! Groups of eight numbers, computed in vectors as wide as the processor has: a group is one or more lane groups,
//! each one vector.

use super::Lane;
use pulp::Simd;
use toile_drape::lane_arithmetic::{F64s, Triple};

/// Numbers in a group.
pub const WIDTH: usize = 8;

/// Zeros before the first and after the last number of a padded array, so that a run of eight may reach beyond
/// the ends.
pub const PAD: usize = WIDTH;

/// The eight numbers of a group.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct Octet(pub [f64; WIDTH]);

impl Octet {
    /// The numbers of one lane group: it is as wide as the processor's vectors.
    #[inline(always)]
    pub fn lane_group<S: Simd>(&self, simd: S, lane_group: usize) -> F64s<S> {
        F64s::new(simd, S::as_simd_f64s(&self.0).0[lane_group])
    }
}

/// Number of lane groups in a group.
#[inline(always)]
pub const fn lane_groups<S: Simd>() -> usize {
    WIDTH / S::F64_LANES
}

/// Number of groups that hold `count` numbers.
pub fn groups(count: usize) -> usize {
    count.div_ceil(WIDTH)
}

/// A padded array of `count` zeros; number `k` stands at index `PAD + k`.
pub fn padded(count: usize) -> Vec<f64> {
    vec![0.0; PAD + WIDTH * groups(count) + WIDTH]
}

/// Index of the first number of a lane group in a padded array.
#[inline(always)]
pub fn lane_group_start<S: Simd>(group: usize, lane_group: usize) -> usize {
    PAD + group * WIDTH + lane_group * S::F64_LANES
}

/// Loads consecutive numbers from index `at` on.
#[inline(always)]
pub fn load<S: Simd>(simd: S, from: &[f64], at: usize) -> F64s<S> {
    F64s::new(simd, S::as_simd_f64s(&from[at..at + S::F64_LANES]).0[0])
}

/// Stores consecutive numbers from index `at` on.
#[inline(always)]
pub fn store<S: Simd>(to: &mut [f64], at: usize, values: F64s<S>) {
    S::as_mut_simd_f64s(&mut to[at..at + S::F64_LANES]).0[0] = values.vector;
}

/// Indices of the eight operands of a group in a padded array.
pub type Indices = [u32; WIDTH];

/// Loads the operands of one lane group by their indices.
#[inline(always)]
pub fn gather<S: Simd>(simd: S, from: &[f64], indices: &Indices, lane_group: usize) -> F64s<S> {
    let mut lanes = Octet::default();
    for k in 0..S::F64_LANES {
        lanes.0[k] = from[indices[lane_group * S::F64_LANES + k] as usize];
    }
    lanes.lane_group(simd, 0)
}

/// Loads consecutive points from index `at` on.
#[inline(always)]
pub fn load_points<S: Simd>(simd: S, [x, y, z]: [&[f64]; 3], at: usize) -> Triple<F64s<S>> {
    Triple([load(simd, x, at), load(simd, y, at), load(simd, z, at)])
}

/// Loads the points of one lane group by their indices.
#[inline(always)]
pub fn gather_points<S: Simd>(
    simd: S,
    from: [&[f64]; 3],
    indices: &Indices,
    lane_group: usize,
) -> Triple<F64s<S>> {
    Triple([
        gather(simd, from[0], indices, lane_group),
        gather(simd, from[1], indices, lane_group),
        gather(simd, from[2], indices, lane_group),
    ])
}

/// The eight operands of a group in a padded array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operands {
    /// Consecutive from this index on, as most are on a regular mesh.
    Run(u32),
    /// At indices that are an entry of a table.
    Scattered(u32),
}

impl Operands {
    /// The operands of lanes with the given indices. An unused lane loads any number of a run, and index 0 of a
    /// scattered entry, where a padded array is zero.
    pub fn new(lanes: [Option<u32>; WIDTH], scattered: &mut Vec<Indices>) -> Self {
        let mut starts = (0u32..)
            .zip(lanes)
            .filter_map(|(lane, at)| Some(at? - lane));
        let first = starts.next().unwrap_or(0);
        if starts.all(|start| start == first) {
            return Self::Run(first);
        }
        scattered.push(lanes.map(|at| at.unwrap_or(0)));
        Self::Scattered(scattered.len() as u32 - 1)
    }

    /// Loads the numbers of one lane group.
    #[inline(always)]
    pub fn load<S: Simd>(
        self,
        simd: S,
        from: &[f64],
        scattered: &[Indices],
        lane_group: usize,
    ) -> F64s<S> {
        match self {
            Self::Run(start) => load(simd, from, start as usize + lane_group * S::F64_LANES),
            Self::Scattered(entry) => gather(simd, from, &scattered[entry as usize], lane_group),
        }
    }

    /// Loads the points of one lane group.
    #[inline(always)]
    pub fn points<S: Simd>(
        self,
        simd: S,
        from: [&[f64]; 3],
        scattered: &[Indices],
        lane_group: usize,
    ) -> Triple<F64s<S>> {
        match self {
            Self::Run(start) => load_points(simd, from, start as usize + lane_group * S::F64_LANES),
            Self::Scattered(entry) => {
                gather_points(simd, from, &scattered[entry as usize], lane_group)
            }
        }
    }
}

/// Vectors of R3, each coordinate in a padded array of its own.
#[derive(Clone, Default)]
pub struct Points {
    axes: [Vec<f64>; 3],
}

impl Points {
    /// `count` zero vectors.
    pub fn new(count: usize) -> Self {
        Self {
            axes: [0; 3].map(|_| padded(count)),
        }
    }

    /// The arrays of x, y and z, sliced to one length so that an index is checked once.
    #[inline(always)]
    pub fn axes(&self) -> [&[f64]; 3] {
        let [x, y, z] = &self.axes;
        let length = x.len();
        [&x[..length], &y[..length], &z[..length]]
    }

    /// The arrays of x, y and z, mutable.
    #[inline(always)]
    pub fn axes_mut(&mut self) -> [&mut [f64]; 3] {
        let [x, y, z] = &mut self.axes;
        let length = x.len();
        [&mut x[..length], &mut y[..length], &mut z[..length]]
    }

    /// The vector with index `at`.
    #[inline(always)]
    pub fn get(&self, at: usize) -> Lane {
        let [x, y, z] = self.axes();
        Lane::new(x[PAD + at], y[PAD + at], z[PAD + at])
    }

    /// Sets the vector with index `at`.
    #[inline(always)]
    pub fn set(&mut self, at: usize, value: Lane) {
        let [a, b, c] = value.coordinates();
        let [x, y, z] = self.axes_mut();
        (x[PAD + at], y[PAD + at], z[PAD + at]) = (a, b, c);
    }

    /// Adds to the vector with index `at`.
    #[inline(always)]
    pub fn add(&mut self, at: usize, value: Lane) {
        self.set(at, self.get(at).plus(value));
    }
}
