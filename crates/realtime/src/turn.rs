//! Rotations and rigid frames in `f32`.

/// A vector or a place (m).
pub(crate) type Vector = [f32; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn difference(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a` plus `share` times `b`.
pub(crate) fn moved(a: Vector, share: f32, b: Vector) -> Vector {
    [
        a[0] + share * b[0],
        a[1] + share * b[1],
        a[2] + share * b[2],
    ]
}

/// A unit quaternion x, y, z, w.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turn(pub [f32; 4]);

impl Turn {
    pub const NONE: Self = Self([0.0, 0.0, 0.0, 1.0]);

    /// By a rotation vector: axis times angle (rad).
    pub fn new(vector: Vector) -> Self {
        let angle = dot(vector, vector).sqrt();
        // sin(a/2) / a tends to a half.
        let share = match angle > 1e-6 {
            true => (0.5 * angle).sin() / angle,
            false => 0.5,
        };
        let [x, y, z] = vector.map(|v| v * share);
        Self([x, y, z, (0.5 * angle).cos()])
    }

    fn cosine(&self, other: &Self) -> f32 {
        self.0.iter().zip(&other.0).map(|(a, b)| a * b).sum()
    }

    /// `a` of this and `b` of another, scaled to length 1.
    fn mixed(&self, a: f32, other: &Self, b: f32) -> Self {
        let sum: [f32; 4] = std::array::from_fn(|k| a * self.0[k] + b * other.0[k]);
        let length = sum.iter().map(|v| v * v).sum::<f32>().sqrt();
        match length > 1e-6 {
            true => Self(sum.map(|v| v / length)),
            false => *self,
        }
    }

    /// Straight between this (0) and another (1), the short way round: quaternions evenly mixed
    /// and brought to length 1 again.
    pub fn blended_linearly(&self, other: &Self, share: f32) -> Self {
        let sign = self.cosine(other).signum();
        self.mixed(1.0 - share, other, sign * share)
    }

    /// Along the arc between this (0) and another (1) at an even speed, the short way round
    /// (Shoemake 1985).
    pub fn slerped(&self, other: &Self, share: f32) -> Self {
        let cosine = self.cosine(other);
        let angle = cosine.abs().min(1.0).acos();
        // Arc and chord are the same to f32 below a thousandth of a radian.
        if angle < 1e-3 {
            return self.blended_linearly(other, share);
        }
        let sine = angle.sin();
        let a = ((1.0 - share) * angle).sin() / sine;
        let b = (share * angle).sin() / sine;
        self.mixed(a, other, b * cosine.signum())
    }

    /// The rotation's matrix, by rows.
    pub fn matrix(&self) -> [Vector; 3] {
        let [x, y, z, w] = self.0;
        [
            [
                1.0 - 2.0 * (y * y + z * z),
                2.0 * (x * y - z * w),
                2.0 * (x * z + y * w),
            ],
            [
                2.0 * (x * y + z * w),
                1.0 - 2.0 * (x * x + z * z),
                2.0 * (y * z - x * w),
            ],
            [
                2.0 * (x * z - y * w),
                2.0 * (y * z + x * w),
                1.0 - 2.0 * (x * x + y * y),
            ],
        ]
    }
}

/// A rotation, then a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The rotation's matrix, by rows.
    pub rows: [[f32; 3]; 3],
    /// The shift (m).
    pub at: [f32; 3],
}

impl Frame {
    /// Nothing turned, nothing shifted.
    pub const NONE: Self = Self {
        rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        at: [0.0; 3],
    };

    /// A direction, turned.
    pub fn turned(&self, v: [f32; 3]) -> [f32; 3] {
        self.rows.map(|row| dot(row, v))
    }

    /// A place, turned and shifted (m).
    pub fn applied(&self, p: [f32; 3]) -> [f32; 3] {
        moved(self.turned(p), 1.0, self.at)
    }

    /// First `inner`, then this.
    pub fn after(&self, inner: &Self) -> Self {
        let columns: [Vector; 3] =
            std::array::from_fn(|j| self.turned(std::array::from_fn(|i| inner.rows[i][j])));
        Self {
            rows: std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i])),
            at: self.applied(inner.at),
        }
    }

    /// The way back.
    pub fn inverse(&self) -> Self {
        let rows: [Vector; 3] = std::array::from_fn(|i| std::array::from_fn(|j| self.rows[j][i]));
        Self {
            rows,
            at: rows.map(|row| -dot(row, self.at)),
        }
    }
}
