//! Arithmetic on SIMD vectors: numbers, truth values and vectors of R3 in lanes, with operators.
//!
//! Each value carries the token of the instruction set it belongs to. An operator between two of them is one
//! instruction, and all functions are inlined by force, without closures, as [`crate::lanes::gather`] explains.

use pulp::Simd;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// A number of single precision in every lane.
#[derive(Clone, Copy)]
pub struct F32s<S: Simd> {
    /// The instruction set.
    pub simd: S,
    /// The numbers.
    pub vector: S::f32s,
}

/// A number of double precision in every lane.
#[derive(Clone, Copy)]
pub struct F64s<S: Simd> {
    /// The instruction set.
    pub simd: S,
    /// The numbers.
    pub vector: S::f64s,
}

/// A truth value in every lane of single precision.
#[derive(Clone, Copy)]
pub struct Mask<S: Simd> {
    simd: S,
    vector: S::m32s,
}

/// Operators between two vectors, and between a vector and one number for every lane.
macro_rules! operators {
    ($numbers:ident, $number:ty: $($operator:ident $name:ident $call:ident),*) => {$(
        impl<S: Simd> $operator for $numbers<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                let vector = self.simd.$call(self.vector, other.vector);
                Self { vector, ..self }
            }
        }

        impl<S: Simd> $operator<$number> for $numbers<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: $number) -> Self {
                self.$name(Self::splat(self.simd, other))
            }
        }

        impl<S: Simd> $operator<$numbers<S>> for $number {
            type Output = $numbers<S>;

            #[inline(always)]
            fn $name(self, other: $numbers<S>) -> $numbers<S> {
                $numbers::splat(other.simd, self).$name(other)
            }
        }
    )*};
}

operators!(F32s, f32: Add add add_f32s, Sub sub sub_f32s, Mul mul mul_f32s, Div div div_f32s);
operators!(F64s, f64: Add add add_f64s, Sub sub sub_f64s, Mul mul mul_f64s);

impl<S: Simd> Neg for F32s<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let vector = self.simd.neg_f32s(self.vector);
        Self { vector, ..self }
    }
}

impl<S: Simd> F32s<S> {
    /// The numbers of a vector.
    #[inline(always)]
    pub fn new(simd: S, vector: S::f32s) -> Self {
        Self { simd, vector }
    }

    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(simd: S, value: f32) -> Self {
        Self::new(simd, simd.splat_f32s(value))
    }

    /// c - a b for `self` as c; rounded once where the processor has an instruction for that.
    #[inline(always)]
    pub fn subtract_product(self, a: Self, b: Self) -> Self {
        let vector = self
            .simd
            .negate_mul_add_e_f32s(a.vector, b.vector, self.vector);
        Self { vector, ..self }
    }

    /// The smaller of two numbers.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        let vector = self.simd.min_f32s(self.vector, other.vector);
        Self { vector, ..self }
    }

    /// The larger of two numbers.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        let vector = self.simd.max_f32s(self.vector, other.vector);
        Self { vector, ..self }
    }

    /// The magnitude.
    #[inline(always)]
    pub fn abs(self) -> Self {
        let vector = self.simd.abs_f32s(self.vector);
        Self { vector, ..self }
    }

    /// The square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let vector = self.simd.sqrt_f32s(self.vector);
        Self { vector, ..self }
    }

    /// Whether a number is less than another.
    #[inline(always)]
    pub fn less_than(self, other: Self) -> Mask<S> {
        let simd = self.simd;
        let vector = simd.less_than_f32s(self.vector, other.vector);
        Mask { simd, vector }
    }

    /// Whether a number is greater than another.
    #[inline(always)]
    pub fn greater_than(self, other: Self) -> Mask<S> {
        let simd = self.simd;
        let vector = simd.greater_than_f32s(self.vector, other.vector);
        Mask { simd, vector }
    }

    /// The largest number of all lanes.
    #[inline(always)]
    pub fn reduce_max(self) -> f32 {
        self.simd.reduce_max_f32s(self.vector)
    }
}

impl<S: Simd> F64s<S> {
    /// The numbers of a vector.
    #[inline(always)]
    pub fn new(simd: S, vector: S::f64s) -> Self {
        Self { simd, vector }
    }

    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self::new(simd, simd.splat_f64s(value))
    }

    /// The smaller of two numbers.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        let vector = self.simd.min_f64s(self.vector, other.vector);
        Self { vector, ..self }
    }

    /// The larger of two numbers.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        let vector = self.simd.max_f64s(self.vector, other.vector);
        Self { vector, ..self }
    }

    /// The square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let vector = self.simd.sqrt_f64s(self.vector);
        Self { vector, ..self }
    }

    /// The sum of all lanes.
    #[inline(always)]
    pub fn reduce_sum(self) -> f64 {
        self.simd.reduce_sum_f64s(self.vector)
    }

    /// The smallest number of all lanes.
    #[inline(always)]
    pub fn reduce_min(self) -> f64 {
        self.simd.reduce_min_f64s(self.vector)
    }

    /// The largest number of all lanes.
    #[inline(always)]
    pub fn reduce_max(self) -> f64 {
        self.simd.reduce_max_f64s(self.vector)
    }
}

impl<S: Simd> BitAnd for Mask<S> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        let vector = self.simd.and_m32s(self.vector, other.vector);
        Self { vector, ..self }
    }
}

impl<S: Simd> BitOr for Mask<S> {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        let vector = self.simd.or_m32s(self.vector, other.vector);
        Self { vector, ..self }
    }
}

impl<S: Simd> Mask<S> {
    /// The first number where the mask is true, else the second.
    #[inline(always)]
    pub fn select(self, a: F32s<S>, b: F32s<S>) -> F32s<S> {
        let vector = self.simd.select_f32s(self.vector, a.vector, b.vector);
        F32s { vector, ..a }
    }

    /// The first vector of R3 where the mask is true, else the second.
    #[inline(always)]
    pub fn select_triple(self, a: Triple<F32s<S>>, b: Triple<F32s<S>>) -> Triple<F32s<S>> {
        let ([ax, ay, az], [bx, by, bz]) = (a.0, b.0);
        Triple([
            self.select(ax, bx),
            self.select(ay, by),
            self.select(az, bz),
        ])
    }

    /// 1 where the mask is true, else 0.
    #[inline(always)]
    pub fn flags(self) -> F32s<S> {
        self.select(F32s::splat(self.simd, 1.0), F32s::splat(self.simd, 0.0))
    }

    /// Whether the mask is true in any lane.
    #[inline(always)]
    pub fn any(self) -> bool {
        self.flags().reduce_max() > 0.0
    }
}

/// Numbers of which the coordinates of a [`Triple`] may be.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// a b + c for `self` as a.
    fn mul_add(self, b: Self, c: Self) -> Self;
}

impl<S: Simd> Number for F32s<S> {
    /// Rounded once where the processor has an instruction for that.
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        let vector = self.simd.mul_add_e_f32s(self.vector, b.vector, c.vector);
        Self { vector, ..self }
    }
}

impl<S: Simd> Number for F64s<S> {
    /// Rounded once.
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        let vector = self.simd.mul_add_f64s(self.vector, b.vector, c.vector);
        Self { vector, ..self }
    }
}

/// A vector of R3 in every lane: its coordinates x, y and z.
#[derive(Clone, Copy)]
pub struct Triple<F>(pub [F; 3]);

impl<F: Number> Add for Triple<F> {
    type Output = Self;

    #[inline(always)]
    fn add(self, b: Self) -> Self {
        let a = self.0;
        Self([a[0] + b.0[0], a[1] + b.0[1], a[2] + b.0[2]])
    }
}

impl<F: Number> Sub for Triple<F> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        let a = self.0;
        Self([a[0] - b.0[0], a[1] - b.0[1], a[2] - b.0[2]])
    }
}

impl<F: Number> Mul<F> for Triple<F> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, s: F) -> Self {
        let [x, y, z] = self.0;
        Self([x * s, y * s, z * s])
    }
}

impl<F: Number> Triple<F> {
    /// The same number in every coordinate.
    #[inline(always)]
    pub fn repeat(value: F) -> Self {
        Self([value; 3])
    }

    /// a + b s for `self` as a.
    #[inline(always)]
    pub fn add_scaled(self, b: Self, s: F) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, b.0);
        Self([bx.mul_add(s, ax), by.mul_add(s, ay), bz.mul_add(s, az)])
    }

    /// The scalar product.
    #[inline(always)]
    pub fn dot(self, b: Self) -> F {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, b.0);
        az.mul_add(bz, ay.mul_add(by, ax * bx))
    }
}

impl<S: Simd> Triple<F32s<S>> {
    /// The length.
    #[inline(always)]
    pub fn norm(self) -> F32s<S> {
        self.dot(self).sqrt()
    }

    /// a - b s for `self` as a.
    #[inline(always)]
    pub fn subtract_scaled(self, b: Self, s: F32s<S>) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, b.0);
        Self([
            ax.subtract_product(bx, s),
            ay.subtract_product(by, s),
            az.subtract_product(bz, s),
        ])
    }

    /// The vector product.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, b.0);
        Self([
            (ay * bz).subtract_product(az, by),
            (az * bx).subtract_product(ax, bz),
            (ax * by).subtract_product(ay, bx),
        ])
    }
}
