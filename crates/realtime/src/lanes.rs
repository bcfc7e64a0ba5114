//! Numbers of eight vertices side by side: plain arrays, which the compiler turns into vectors.

/// Vertices of a block.
pub(crate) const LANES: usize = 8;

/// One number of each vertex of a block.
pub(crate) type Lanes = [f32; LANES];

pub(crate) fn each(f: impl FnMut(usize) -> f32) -> Lanes {
    std::array::from_fn(f)
}

/// Columns of places or velocities, x, y and z, a whole number of blocks long.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns(pub [Vec<f32>; 3]);

impl Columns {
    pub fn zeros(count: usize) -> Self {
        Self(std::array::from_fn(|_| vec![0.0; count]))
    }

    pub fn at(&self, k: usize) -> [f32; 3] {
        [self.0[0][k], self.0[1][k], self.0[2][k]]
    }

    pub fn set(&mut self, k: usize, v: [f32; 3]) {
        for (column, value) in self.0.iter_mut().zip(v) {
            column[k] = value;
        }
    }

    /// The columns of a block.
    pub fn block(&self, block: usize) -> [Lanes; 3] {
        std::array::from_fn(|axis| {
            let mut lanes = [0.0; LANES];
            lanes.copy_from_slice(&self.0[axis][block * LANES..(block + 1) * LANES]);
            lanes
        })
    }

    pub fn set_block(&mut self, block: usize, values: &[Lanes; 3]) {
        for (column, lanes) in self.0.iter_mut().zip(values) {
            column[block * LANES..(block + 1) * LANES].copy_from_slice(lanes);
        }
    }

    pub fn copy_from(&mut self, other: &Self) {
        for (column, from) in self.0.iter_mut().zip(&other.0) {
            column.copy_from_slice(from);
        }
    }
}
