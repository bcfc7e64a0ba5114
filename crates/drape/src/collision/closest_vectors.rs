//! Vectors between the closest points of a vertex and a face, or of two edges, and tests of the separation along them.
//! Sixteen pairs are computed in lanes, in single precision: the vectors are approximate. A separation along any vector
//! is a proof all the same, which [`super::separation_filter`] makes use of.

use crate::lanes::{Triple, add_scaled, dot, sub};
use pulp::Simd;

/// Bound of the error of a distance in single precision, as a share of the largest coordinate. In units of the machine
/// epsilon, positions contribute 1.8, their differences at most 3 and the sums at most 6; the bound is twice that.
pub(super) const ROUNDING: f32 = 24.0 * f32::EPSILON;

/// Smallest divisor [m2, m4]: with it quotients of zero-length or parallel edges are finite.
const MIN_DIVISOR: f32 = 1e-30;

/// The quotient a / b, clamped to 0..=1.
#[inline(always)]
fn clamped_quotient<S: Simd>(simd: S, a: S::f32s, b: S::f32s) -> S::f32s {
    let quotient = simd.div_f32s(a, simd.max_f32s(b, simd.splat_f32s(MIN_DIVISOR)));
    let quotient = simd.max_f32s(quotient, simd.splat_f32s(0.0));
    simd.min_f32s(quotient, simd.splat_f32s(1.0))
}

/// The determinant a b - c d.
#[inline(always)]
fn determinant<S: Simd>(simd: S, [a, b]: [S::f32s; 2], [c, d]: [S::f32s; 2]) -> S::f32s {
    simd.sub_f32s(simd.mul_f32s(a, b), simd.mul_f32s(c, d))
}

/// Whether every corner of a face lies more than `gap` beyond the vertex along n. `gap` is the distance times |n|.
#[inline(always)]
pub fn face_is_beyond<S: Simd>(
    simd: S,
    [p, a, b, c]: &[Triple<S::f32s>; 4],
    n: Triple<S::f32s>,
    gap: S::f32s,
) -> S::m32s {
    let a = simd.greater_than_f32s(dot(simd, sub(simd, *a, *p), n), gap);
    let b = simd.greater_than_f32s(dot(simd, sub(simd, *b, *p), n), gap);
    let c = simd.greater_than_f32s(dot(simd, sub(simd, *c, *p), n), gap);
    simd.and_m32s(a, simd.and_m32s(b, c))
}

/// Whether both ends of the second edge lie more than `gap` beyond both ends of the first along n. `gap` is the
/// distance times |n|.
#[inline(always)]
pub fn edge_is_beyond<S: Simd>(
    simd: S,
    [a, b, c, d]: &[Triple<S::f32s>; 4],
    n: Triple<S::f32s>,
    gap: S::f32s,
) -> S::m32s {
    let ac = dot(simd, sub(simd, *c, *a), n);
    let ad = dot(simd, sub(simd, *d, *a), n);
    let ab = dot(simd, sub(simd, *b, *a), n);
    let from_a = simd.and_m32s(
        simd.greater_than_f32s(ac, gap),
        simd.greater_than_f32s(ad, gap),
    );
    let gap = simd.add_f32s(gap, ab);
    let from_b = simd.and_m32s(
        simd.greater_than_f32s(ac, gap),
        simd.greater_than_f32s(ad, gap),
    );
    simd.and_m32s(from_a, from_b)
}

/// Vector from a vertex to the closest point of a face: to the foot of the perpendicular where it lies inside, else to
/// the closest point of the three sides. Approximate.
#[inline(always)]
pub fn vertex_to_face<S: Simd>(simd: S, [p, a, b, c]: &[Triple<S::f32s>; 4]) -> Triple<S::f32s> {
    let zero = simd.splat_f32s(0.0);
    let (u, v, w) = (sub(simd, *b, *a), sub(simd, *c, *a), sub(simd, *a, *p));
    let (uu, vv, uv) = (dot(simd, u, u), dot(simd, v, v), dot(simd, u, v));
    let (uw, vw) = (dot(simd, u, w), dot(simd, v, w));
    let on_u = add_scaled(simd, w, u, clamped_quotient(simd, simd.neg_f32s(uw), uu));
    let on_v = add_scaled(simd, w, v, clamped_quotient(simd, simd.neg_f32s(vw), vv));
    let (e, f) = (sub(simd, v, u), sub(simd, *b, *p));
    let on_e = add_scaled(
        simd,
        f,
        e,
        clamped_quotient(simd, simd.neg_f32s(dot(simd, e, f)), dot(simd, e, e)),
    );
    let nearest = shorter(simd, shorter(simd, on_u, on_v), on_e);
    let square = determinant(simd, [uu, vv], [uv, uv]);
    let (s, t) = (
        determinant(simd, [uv, vw], [vv, uw]),
        determinant(simd, [uv, uw], [uu, vw]),
    );
    let inside = simd.and_m32s(
        simd.greater_than_f32s(s, zero),
        simd.and_m32s(
            simd.greater_than_f32s(t, zero),
            simd.greater_than_f32s(square, simd.add_f32s(s, t)),
        ),
    );
    let foot = add_scaled(
        simd,
        add_scaled(simd, w, u, clamped_quotient(simd, s, square)),
        v,
        clamped_quotient(simd, t, square),
    );
    select(simd, inside, foot, nearest)
}

/// The shorter of two vectors.
#[inline(always)]
fn shorter<S: Simd>(simd: S, a: Triple<S::f32s>, b: Triple<S::f32s>) -> Triple<S::f32s> {
    let is_shorter = simd.less_than_f32s(dot(simd, a, a), dot(simd, b, b));
    select(simd, is_shorter, a, b)
}

/// The first of two vectors in the lanes that are set, else the second.
#[inline(always)]
fn select<S: Simd>(
    simd: S,
    mask: S::m32s,
    a: Triple<S::f32s>,
    b: Triple<S::f32s>,
) -> Triple<S::f32s> {
    [
        simd.select_f32s(mask, a[0], b[0]),
        simd.select_f32s(mask, a[1], b[1]),
        simd.select_f32s(mask, a[2], b[2]),
    ]
}

/// Approximate vector from the closest point of the first edge to that of the second (Ericson 2005, section 5.1.9), and
/// whether the edges certainly pass by each other, which they do where the lines through them are nearest beyond the
/// end of an edge. Let d be the error of a vector, l its length: a product of four vectors has the error 4 d l^3, the
/// difference of two products 8 d l^3, and the difference of two of these 16 d l^3. `farthest` is the largest
/// coordinate [m], from which d follows.
#[inline(always)]
pub fn edge_to_edge<S: Simd>(
    simd: S,
    [a, b, c, d]: &[Triple<S::f32s>; 4],
    farthest: f32,
) -> (Triple<S::f32s>, S::m32s) {
    let (u, v, w) = (sub(simd, *b, *a), sub(simd, *d, *c), sub(simd, *a, *c));
    let (uu, vv, uv) = (dot(simd, u, u), dot(simd, v, v), dot(simd, u, v));
    let (uw, vw, ww) = (dot(simd, u, w), dot(simd, v, w), dot(simd, w, w));
    let square = determinant(simd, [uu, vv], [uv, uv]);
    let (s, t) = (
        determinant(simd, [uv, vw], [uw, vv]),
        determinant(simd, [uu, vw], [uv, uw]),
    );
    // For parallel edges any first point will do: the two below follow from it.
    let on_first = clamped_quotient(simd, s, square);
    let on_second = clamped_quotient(simd, simd.mul_add_e_f32s(uv, on_first, vw), vv);
    let on_first = clamped_quotient(simd, simd.sub_f32s(simd.mul_f32s(uv, on_second), uw), uu);
    let second = add_scaled(simd, sub(simd, *c, *a), v, on_second);
    let n = add_scaled(simd, second, u, simd.neg_f32s(on_first));

    let longest = simd.max_f32s(ww, simd.max_f32s(uu, vv));
    let error = simd.mul_f32s(longest, simd.sqrt_f32s(longest));
    let error = simd.mul_f32s(error, simd.splat_f32s(8.0 * ROUNDING * farthest));
    let is_known = simd.greater_than_f32s(square, simd.add_f32s(error, error));
    let outside = simd.or_m32s(
        is_outside(simd, s, square, error),
        is_outside(simd, t, square, error),
    );
    (n, simd.and_m32s(is_known, outside))
}

/// Whether the quotient a / b is certainly below 0 or above 1, where a and b have this error.
#[inline(always)]
fn is_outside<S: Simd>(simd: S, a: S::f32s, b: S::f32s, error: S::f32s) -> S::m32s {
    let below = simd.greater_than_f32s(simd.neg_f32s(a), error);
    let above = simd.greater_than_f32s(simd.sub_f32s(a, b), simd.add_f32s(error, error));
    simd.or_m32s(below, above)
}
