//! Numbers worked on eight at a time, in vectors as wide as the processor has.

use super::Lane;
use pulp::Simd;

/// Numbers of a group.
pub const WIDTH: usize = 8;

/// Numbers before the first of an array and after the last: they stay zero, so that a run may
/// reach beyond the ends.
pub const PAD: usize = WIDTH;

/// One number for each of a group.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct Octet(pub [f64; WIDTH]);

impl Octet {
    /// Those of one part; parts are as wide as the processor's vectors.
    #[inline(always)]
    pub fn part<S: Simd>(&self, part: usize) -> S::f64s {
        S::as_simd_f64s(&self.0).0[part]
    }
}

/// Parts of a group.
#[inline(always)]
pub const fn parts<S: Simd>() -> usize {
    WIDTH / S::F64_LANES
}

/// Groups that hold so many numbers.
pub fn groups(count: usize) -> usize {
    count.div_ceil(WIDTH)
}

/// An array for so many numbers, all zero; number `k` stands at `PAD + k`.
pub fn padded(count: usize) -> Vec<f64> {
    vec![0.0; PAD + WIDTH * groups(count) + WIDTH]
}

/// Where a part of a group begins in a padded array.
#[inline(always)]
pub fn place<S: Simd>(group: usize, part: usize) -> usize {
    PAD + group * WIDTH + part * S::F64_LANES
}

/// Loads what lies side by side.
#[inline(always)]
pub fn load<S: Simd>(from: &[f64], at: usize) -> S::f64s {
    S::as_simd_f64s(&from[at..at + S::F64_LANES]).0[0]
}

/// Stores side by side.
#[inline(always)]
pub fn store<S: Simd>(to: &mut [f64], at: usize, values: S::f64s) {
    S::as_mut_simd_f64s(&mut to[at..at + S::F64_LANES]).0[0] = values;
}

/// Places of a padded array that eight operands of a group lie at, in no order.
pub type Places = [u32; WIDTH];

/// Loads what lies in no order, a part of the group.
#[inline(always)]
pub fn gather<S: Simd>(from: &[f64], places: &Places, part: usize) -> S::f64s {
    let mut lanes = Octet::default();
    for k in 0..S::F64_LANES {
        lanes.0[k] = from[places[part * S::F64_LANES + k] as usize];
    }
    lanes.part::<S>(0)
}

/// Loads points that lie side by side.
#[inline(always)]
pub fn load_points<S: Simd>(from: [&[f64]; 3], at: usize) -> [S::f64s; 3] {
    [
        load::<S>(from[0], at),
        load::<S>(from[1], at),
        load::<S>(from[2], at),
    ]
}

/// Loads points that lie in no order.
#[inline(always)]
pub fn gather_points<S: Simd>(from: [&[f64]; 3], places: &Places, part: usize) -> [S::f64s; 3] {
    [
        gather::<S>(from[0], places, part),
        gather::<S>(from[1], places, part),
        gather::<S>(from[2], places, part),
    ]
}

/// Adds so many times some points to a sum of them.
#[inline(always)]
pub fn add_scaled<S: Simd>(simd: S, sum: &mut [S::f64s; 3], by: S::f64s, points: [S::f64s; 3]) {
    for (sum, x) in sum.iter_mut().zip(points) {
        *sum = simd.mul_add_f64s(by, x, *sum);
    }
}

/// Where the eight operands of a group lie in a padded array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Take {
    /// Side by side from here on: on a regular mesh neighbours lie like that.
    Run(u32),
    /// Each where this entry of a table says.
    Each(u32),
}

impl Take {
    /// For lanes that take these places of a padded array; the others take anything when it is a
    /// run, and zero otherwise.
    pub fn new(lanes: [Option<u32>; WIDTH], scattered: &mut Vec<Places>) -> Self {
        let mut starts = (0u32..)
            .zip(lanes)
            .filter_map(|(lane, at)| Some(at? - lane));
        let first = starts.next().unwrap_or(0);
        if starts.all(|start| start == first) {
            return Self::Run(first);
        }
        scattered.push(lanes.map(|at| at.unwrap_or(0)));
        Self::Each(scattered.len() as u32 - 1)
    }

    /// Loads a part of the group.
    #[inline(always)]
    pub fn load<S: Simd>(self, from: &[f64], scattered: &[Places], part: usize) -> S::f64s {
        match self {
            Self::Run(start) => load::<S>(from, start as usize + part * S::F64_LANES),
            Self::Each(entry) => gather::<S>(from, &scattered[entry as usize], part),
        }
    }

    /// Loads points.
    #[inline(always)]
    pub fn points<S: Simd>(
        self,
        from: [&[f64]; 3],
        scattered: &[Places],
        part: usize,
    ) -> [S::f64s; 3] {
        match self {
            Self::Run(start) => load_points::<S>(from, start as usize + part * S::F64_LANES),
            Self::Each(entry) => gather_points::<S>(from, &scattered[entry as usize], part),
        }
    }
}

/// Vectors of R3, each coordinate in a padded array of its own.
#[derive(Clone, Default)]
pub struct Points {
    axes: [Vec<f64>; 3],
}

impl Points {
    /// So many, all zero.
    pub fn new(count: usize) -> Self {
        Self {
            axes: [0; 3].map(|_| padded(count)),
        }
    }

    /// The arrays, of one length, so that an index is checked once.
    #[inline(always)]
    pub fn axes(&self) -> [&[f64]; 3] {
        let [x, y, z] = &self.axes;
        let length = x.len();
        [&x[..length], &y[..length], &z[..length]]
    }

    /// The arrays, to be changed.
    #[inline(always)]
    pub fn axes_mut(&mut self) -> [&mut [f64]; 3] {
        let [x, y, z] = &mut self.axes;
        let length = x.len();
        [&mut x[..length], &mut y[..length], &mut z[..length]]
    }

    /// One of them.
    #[inline(always)]
    pub fn get(&self, at: usize) -> Lane {
        let [x, y, z] = self.axes();
        Lane::new(x[PAD + at], y[PAD + at], z[PAD + at])
    }

    /// Puts one.
    #[inline(always)]
    pub fn set(&mut self, at: usize, value: Lane) {
        let [a, b, c] = value.coordinates();
        let [x, y, z] = self.axes_mut();
        (x[PAD + at], y[PAD + at], z[PAD + at]) = (a, b, c);
    }

    /// Adds to one.
    #[inline(always)]
    pub fn add(&mut self, at: usize, value: Lane) {
        self.set(at, self.get(at).plus(value));
    }
}
