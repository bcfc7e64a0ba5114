//! SIMD vectors of the width that the processor has, detected at run time, with gather and scatter of points.
//!
//! A point is four floats in memory (x, y, z and its inverse mass), so that one load fetches it; shuffles in registers
//! transpose sixteen points to four vectors.

use crate::lane_arithmetic::{F32s, Triple};
use pulp::Simd;
use pulp::bytemuck::cast;

/// A point: x, y, z (m) relative to an origin, and its inverse mass (1/kg) where it is used.
pub type Point = [f32; 4];

/// Constraints solved side by side.
pub const LANES: usize = 16;

/// One number for each constraint of a batch.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Row(pub [f32; LANES]);

impl Row {
    /// The same number everywhere.
    pub const fn splat(value: f32) -> Self {
        Self([value; LANES])
    }

    /// The lanes of one lane group: a group is as wide as the processor's vectors.
    #[inline(always)]
    pub fn lane_group<S: Simd>(&self, simd: S, lane_group: usize) -> F32s<S> {
        F32s::new(simd, S::as_simd_f32s(&self.0).0[lane_group])
    }

    /// Sets the lanes of one lane group.
    #[inline(always)]
    pub fn set_lane_group<S: Simd>(&mut self, lane_group: usize, value: F32s<S>) {
        S::as_mut_simd_f32s(&mut self.0).0[lane_group] = value.vector;
    }
}

/// The lanes of one lane group of several rows.
#[inline(always)]
pub fn lane_group_of<S: Simd, const N: usize>(
    simd: S,
    rows: &[Row; N],
    lane_group: usize,
) -> [F32s<S>; N] {
    let mut all = [rows[0].lane_group(simd, lane_group); N];
    for (lanes, row) in all.iter_mut().zip(rows) {
        *lanes = row.lane_group(simd, lane_group);
    }
    all
}

/// Sets the lanes of one lane group of the rows of x, y and z.
#[inline(always)]
pub fn set_lane_group_of<S: Simd>(rows: &mut [Row; 3], lane_group: usize, values: Triple<F32s<S>>) {
    let [x, y, z] = rows;
    x.set_lane_group(lane_group, values.0[0]);
    y.set_lane_group(lane_group, values.0[1]);
    z.set_lane_group(lane_group, values.0[2]);
}

/// Indices of one corner of each constraint of a batch.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Corner(pub [u32; LANES]);

/// The corner of consecutive points.
const SIDE_BY_SIDE: Corner = Corner([0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]);

/// Number of lane groups in a batch.
#[inline(always)]
pub const fn lane_groups<S: Simd>() -> usize {
    LANES / S::F32_LANES
}

/// The point that a lane of a lane group refers to.
#[inline(always)]
fn at<S: Simd>(points: &[Point], corner: &Corner, lane_group: usize, lane: usize) -> Point {
    points[corner.0[lane_group * S::F32_LANES + lane] as usize]
}

/// Points of one lane group: their positions, and their inverse masses where they have any.
pub type PointLanes<S> = (Triple<F32s<S>>, F32s<S>);

/// Loads the points of one corner for one lane group.
///
/// All functions on vectors are inlined by force, without closures: a function that is not inlined into the one compiled
/// for the processor's instruction set is compiled for the baseline set.
#[inline(always)]
pub fn gather<S: Simd>(
    simd: S,
    points: &[Point],
    corner: &Corner,
    lane_group: usize,
) -> PointLanes<S> {
    // Slot l of register r holds lane 4 l + r: the shuffle then leaves lanes in their order.
    let [x, y, z, w] = if S::F32_LANES == 16 {
        simd.deinterleave_shfl_f32s([
            four::<S>(points, corner, lane_group, 0),
            four::<S>(points, corner, lane_group, 1),
            four::<S>(points, corner, lane_group, 2),
            four::<S>(points, corner, lane_group, 3),
        ])
    } else if S::F32_LANES == 8 {
        simd.deinterleave_shfl_f32s([
            two::<S>(points, corner, lane_group, 0),
            two::<S>(points, corner, lane_group, 1),
            two::<S>(points, corner, lane_group, 2),
            two::<S>(points, corner, lane_group, 3),
        ])
    } else if S::F32_LANES == 4 {
        simd.deinterleave_shfl_f32s([
            cast::<Point, S::f32s>(at::<S>(points, corner, lane_group, 0)),
            cast::<Point, S::f32s>(at::<S>(points, corner, lane_group, 1)),
            cast::<Point, S::f32s>(at::<S>(points, corner, lane_group, 2)),
            cast::<Point, S::f32s>(at::<S>(points, corner, lane_group, 3)),
        ])
    } else {
        let [x, y, z, w] = at::<S>(points, corner, lane_group, 0);
        [
            simd.splat_f32s(x),
            simd.splat_f32s(y),
            simd.splat_f32s(z),
            simd.splat_f32s(w),
        ]
    };
    let position = Triple([F32s::new(simd, x), F32s::new(simd, y), F32s::new(simd, z)]);
    (position, F32s::new(simd, w))
}

/// Register `r` of sixteen lanes.
#[inline(always)]
fn four<S: Simd>(points: &[Point], corner: &Corner, lane_group: usize, r: usize) -> S::f32s {
    cast::<[Point; 4], S::f32s>([
        at::<S>(points, corner, lane_group, r),
        at::<S>(points, corner, lane_group, 4 + r),
        at::<S>(points, corner, lane_group, 8 + r),
        at::<S>(points, corner, lane_group, 12 + r),
    ])
}

/// Register `r` of eight lanes.
#[inline(always)]
fn two<S: Simd>(points: &[Point], corner: &Corner, lane_group: usize, r: usize) -> S::f32s {
    cast::<[Point; 2], S::f32s>([
        at::<S>(points, corner, lane_group, r),
        at::<S>(points, corner, lane_group, 4 + r),
    ])
}

/// Loads one lane group of sixteen consecutive points.
#[inline(always)]
pub fn load<S: Simd>(simd: S, points: &[Point; LANES], lane_group: usize) -> PointLanes<S> {
    gather(simd, points, &SIDE_BY_SIDE, lane_group)
}

/// Stores one part of sixteen consecutive points.
#[inline(always)]
pub fn store<S: Simd>(points: &mut [Point; LANES], lane_group: usize, values: PointLanes<S>) {
    scatter(points, &SIDE_BY_SIDE, lane_group, values);
}

/// Stores the points of one corner for one lane group.
#[inline(always)]
pub fn scatter<S: Simd>(
    points: &mut [Point],
    corner: &Corner,
    lane_group: usize,
    (Triple([x, y, z]), w): PointLanes<S>,
) {
    let simd = w.simd;
    let values = [x.vector, y.vector, z.vector, w.vector];
    let first = lane_group * S::F32_LANES;
    if S::F32_LANES == 16 {
        let registers = simd.interleave_shfl_f32s(values);
        for r in 0..4 {
            let four: [Point; 4] = cast(registers[r]);
            points[corner.0[first + r] as usize] = four[0];
            points[corner.0[first + 4 + r] as usize] = four[1];
            points[corner.0[first + 8 + r] as usize] = four[2];
            points[corner.0[first + 12 + r] as usize] = four[3];
        }
    } else if S::F32_LANES == 8 {
        let registers = simd.interleave_shfl_f32s(values);
        for r in 0..4 {
            let two: [Point; 2] = cast(registers[r]);
            points[corner.0[first + r] as usize] = two[0];
            points[corner.0[first + 4 + r] as usize] = two[1];
        }
    } else if S::F32_LANES == 4 {
        let registers = simd.interleave_shfl_f32s(values);
        for r in 0..4 {
            points[corner.0[first + r] as usize] = cast(registers[r]);
        }
    } else {
        points[corner.0[first] as usize] = [
            simd.reduce_sum_f32s(values[0]),
            simd.reduce_sum_f32s(values[1]),
            simd.reduce_sum_f32s(values[2]),
            simd.reduce_sum_f32s(values[3]),
        ];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Copy<'a> {
        from: &'a [Point],
        to: &'a mut [Point],
        corner: &'a Corner,
        sums: &'a mut Row,
    }

    impl pulp::WithSimd for Copy<'_> {
        type Output = ();

        fn with_simd<S: Simd>(self, simd: S) {
            for lane_group in 0..lane_groups::<S>() {
                let point = gather(simd, self.from, self.corner, lane_group);
                let (Triple([x, y, z]), w) = point;
                let sum = (x + y) + (z + w);
                self.sums.set_lane_group(lane_group, sum);
                scatter(self.to, self.corner, lane_group, point);
            }
        }
    }

    #[test]
    fn points_come_back_where_they_were_and_lanes_keep_their_order() {
        let from: Vec<Point> = (0..40)
            .map(|i| [i as f32, 0.5 * i as f32, -3.0, 1e-3 * i as f32])
            .collect();
        let mut corner = Corner([0; LANES]);
        for (lane, index) in corner.0.iter_mut().enumerate() {
            *index = ((lane * 7 + 3) % 40) as u32;
        }
        let check = |run: &dyn Fn(Copy)| {
            let mut to = vec![[0.0; 4]; 40];
            let mut sums = Row::splat(0.0);
            run(Copy {
                from: &from,
                to: &mut to,
                corner: &corner,
                sums: &mut sums,
            });
            for (lane, &index) in corner.0.iter().enumerate() {
                let point = from[index as usize];
                assert_eq!(to[index as usize], point);
                assert!((sums.0[lane] - point.iter().sum::<f32>()).abs() < 1e-4);
            }
        };
        check(&|copy| pulp::Arch::new().dispatch(copy));
        check(&|copy| pulp::WithSimd::with_simd(copy, pulp::Scalar));
    }
}
