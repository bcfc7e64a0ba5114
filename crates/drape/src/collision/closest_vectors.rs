//! Vectors between the closest points of a vertex and a face, or of two edges, and tests of the separation along them.
//! Sixteen pairs are computed in lanes, in single precision: the vectors are approximate. A separation along any vector
//! is a proof all the same, which [`super::separation_filter`] makes use of.

use crate::lane_arithmetic::{F32s, Mask, Number, Triple};
use pulp::Simd;

/// Bound of the error of a distance in single precision, as a share of the largest coordinate. In units of the machine
/// epsilon, positions contribute 1.8, their differences at most 3 and the sums at most 6; the bound is twice that.
pub(super) const ROUNDING: f32 = 24.0 * f32::EPSILON;

/// Smallest divisor (m2, m4): with it quotients of zero-length or parallel edges are finite.
const MIN_DIVISOR: f32 = 1e-30;

/// The quotient a / b, clamped to 0..=1.
#[inline(always)]
fn clamped_quotient<S: Simd>(a: F32s<S>, b: F32s<S>) -> F32s<S> {
    let simd = a.simd;
    let quotient = a / b.max(F32s::splat(simd, MIN_DIVISOR));
    let quotient = quotient.max(F32s::splat(simd, 0.0));
    quotient.min(F32s::splat(simd, 1.0))
}

/// Whether every corner of a face lies more than `gap` beyond the vertex along n. `gap` is the distance times |n|.
#[inline(always)]
pub fn face_is_beyond<S: Simd>(
    &[p, a, b, c]: &[Triple<F32s<S>>; 4],
    n: Triple<F32s<S>>,
    gap: F32s<S>,
) -> Mask<S> {
    let a = (a - p).dot(n).greater_than(gap);
    let b = (b - p).dot(n).greater_than(gap);
    let c = (c - p).dot(n).greater_than(gap);
    a & (b & c)
}

/// Whether both ends of the second edge lie more than `gap` beyond both ends of the first along n. `gap` is the
/// distance times |n|.
#[inline(always)]
pub fn edge_is_beyond<S: Simd>(
    &[a, b, c, d]: &[Triple<F32s<S>>; 4],
    n: Triple<F32s<S>>,
    gap: F32s<S>,
) -> Mask<S> {
    let (ac, ad, ab) = ((c - a).dot(n), (d - a).dot(n), (b - a).dot(n));
    let from_a = ac.greater_than(gap) & ad.greater_than(gap);
    let gap = gap + ab;
    let from_b = ac.greater_than(gap) & ad.greater_than(gap);
    from_a & from_b
}

/// Vector from a vertex to the closest point of a face: to the foot of the perpendicular where it lies inside, else to
/// the closest point of the three sides. Approximate.
#[inline(always)]
pub fn vertex_to_face<S: Simd>(&[p, a, b, c]: &[Triple<F32s<S>>; 4]) -> Triple<F32s<S>> {
    let (u, v, w) = (b - a, c - a, a - p);
    let (uu, vv, uv) = (u.dot(u), v.dot(v), u.dot(v));
    let (uw, vw) = (u.dot(w), v.dot(w));
    let on_u = w.add_scaled(u, clamped_quotient(-uw, uu));
    let on_v = w.add_scaled(v, clamped_quotient(-vw, vv));
    let (e, f) = (v - u, b - p);
    let on_e = f.add_scaled(e, clamped_quotient(-e.dot(f), e.dot(e)));
    let nearest = shorter(shorter(on_u, on_v), on_e);
    let square = uu * vv - uv * uv;
    let (s, t) = (uv * vw - vv * uw, uv * uw - uu * vw);
    let zero = F32s::splat(square.simd, 0.0);
    let inside = s.greater_than(zero) & (t.greater_than(zero) & square.greater_than(s + t));
    let foot = w.add_scaled(u, clamped_quotient(s, square));
    let foot = foot.add_scaled(v, clamped_quotient(t, square));
    inside.select_triple(foot, nearest)
}

/// The shorter of two vectors.
#[inline(always)]
fn shorter<S: Simd>(a: Triple<F32s<S>>, b: Triple<F32s<S>>) -> Triple<F32s<S>> {
    a.dot(a).less_than(b.dot(b)).select_triple(a, b)
}

/// Approximate vector from the closest point of the first edge to that of the second (Ericson 2005, section 5.1.9), and
/// whether the edges certainly pass by each other, which they do where the lines through them are nearest beyond the
/// end of an edge. Let d be the error of a vector, l its length: a product of four vectors has the error 4 d l^3, the
/// difference of two products 8 d l^3, and the difference of two of these 16 d l^3. `farthest` is the largest
/// coordinate (m), from which d follows.
#[inline(always)]
pub fn edge_to_edge<S: Simd>(
    &[a, b, c, d]: &[Triple<F32s<S>>; 4],
    farthest: f32,
) -> (Triple<F32s<S>>, Mask<S>) {
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, vv, uv) = (u.dot(u), v.dot(v), u.dot(v));
    let (uw, vw, ww) = (u.dot(w), v.dot(w), w.dot(w));
    let square = uu * vv - uv * uv;
    let (s, t) = (uv * vw - uw * vv, uu * vw - uv * uw);
    // For parallel edges any first point will do: the two below follow from it.
    let on_first = clamped_quotient(s, square);
    let on_second = clamped_quotient(uv.mul_add(on_first, vw), vv);
    let on_first = clamped_quotient(uv * on_second - uw, uu);
    let second = (c - a).add_scaled(v, on_second);
    let n = second.add_scaled(u, -on_first);

    let longest = ww.max(uu.max(vv));
    let error = longest * longest.sqrt() * (8.0 * ROUNDING * farthest);
    let is_known = square.greater_than(error + error);
    let outside = is_outside(s, square, error) | is_outside(t, square, error);
    (n, is_known & outside)
}

/// Whether the quotient a / b is certainly below 0 or above 1, where a and b have this error.
#[inline(always)]
fn is_outside<S: Simd>(a: F32s<S>, b: F32s<S>, error: F32s<S>) -> Mask<S> {
    (-a).greater_than(error) | (a - b).greater_than(error + error)
}
