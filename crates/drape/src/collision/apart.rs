//! Four vertices seen sixteen times side by side: the way between the closest points of a vertex and a face, or
//! of two edges, and what lies beyond what along it. Single precision, so about right: [`super::sieve`] says
//! what may be made of it.

use crate::lanes::{Triple, add_scaled, dot, sub};
use pulp::Simd;

/// How far off a distance in single precision is, as a share of the largest coordinate: rounding of the
/// places (1.8), of their differences (at most 3) and of the sums (at most 6), and as much again.
pub(super) const ROUNDING: f32 = 24.0 * f32::EPSILON;

/// Below this lengths count as none and edges as parallel [m2, m4]: it keeps quotients numbers.
const TINY: f32 = 1e-30;

/// A share of a way, within it.
#[inline(always)]
fn share<S: Simd>(simd: S, part: S::f32s, whole: S::f32s) -> S::f32s {
    let share = simd.div_f32s(part, simd.max_f32s(whole, simd.splat_f32s(TINY)));
    let share = simd.max_f32s(share, simd.splat_f32s(0.0));
    simd.min_f32s(share, simd.splat_f32s(1.0))
}

/// a b - c d.
#[inline(always)]
fn cross<S: Simd>(simd: S, [a, b]: [S::f32s; 2], [c, d]: [S::f32s; 2]) -> S::f32s {
    simd.sub_f32s(simd.mul_f32s(a, b), simd.mul_f32s(c, d))
}

/// Whether all corners of a face lie farther than so along n from a vertex.
#[inline(always)]
pub fn face_is_beyond<S: Simd>(
    simd: S,
    [p, a, b, c]: &[Triple<S::f32s>; 4],
    n: Triple<S::f32s>,
    far: S::f32s,
) -> S::m32s {
    let a = simd.greater_than_f32s(dot(simd, sub(simd, *a, *p), n), far);
    let b = simd.greater_than_f32s(dot(simd, sub(simd, *b, *p), n), far);
    let c = simd.greater_than_f32s(dot(simd, sub(simd, *c, *p), n), far);
    simd.and_m32s(a, simd.and_m32s(b, c))
}

/// Whether both ends of an edge lie farther than so along n from both of another.
#[inline(always)]
pub fn edge_is_beyond<S: Simd>(
    simd: S,
    [a, b, c, d]: &[Triple<S::f32s>; 4],
    n: Triple<S::f32s>,
    far: S::f32s,
) -> S::m32s {
    let ac = dot(simd, sub(simd, *c, *a), n);
    let ad = dot(simd, sub(simd, *d, *a), n);
    let ab = dot(simd, sub(simd, *b, *a), n);
    let from_a = simd.and_m32s(
        simd.greater_than_f32s(ac, far),
        simd.greater_than_f32s(ad, far),
    );
    let far = simd.add_f32s(far, ab);
    let from_b = simd.and_m32s(
        simd.greater_than_f32s(ac, far),
        simd.greater_than_f32s(ad, far),
    );
    simd.and_m32s(from_a, from_b)
}

/// From a vertex to the closest point of a face, about: the foot of the perpendicular where it lies inside,
/// else the closest point of the three sides.
#[inline(always)]
pub fn to_face<S: Simd>(simd: S, [p, a, b, c]: &[Triple<S::f32s>; 4]) -> Triple<S::f32s> {
    let zero = simd.splat_f32s(0.0);
    let (u, v, w) = (sub(simd, *b, *a), sub(simd, *c, *a), sub(simd, *a, *p));
    let (uu, vv, uv) = (dot(simd, u, u), dot(simd, v, v), dot(simd, u, v));
    let (uw, vw) = (dot(simd, u, w), dot(simd, v, w));
    let on_u = add_scaled(simd, w, u, share(simd, simd.neg_f32s(uw), uu));
    let on_v = add_scaled(simd, w, v, share(simd, simd.neg_f32s(vw), vv));
    let (e, f) = (sub(simd, v, u), sub(simd, *b, *p));
    let on_e = add_scaled(
        simd,
        f,
        e,
        share(simd, simd.neg_f32s(dot(simd, e, f)), dot(simd, e, e)),
    );
    let nearest = nearer(simd, nearer(simd, on_u, on_v), on_e);
    let square = cross(simd, [uu, vv], [uv, uv]);
    let (s, t) = (
        cross(simd, [uv, vw], [vv, uw]),
        cross(simd, [uv, uw], [uu, vw]),
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
        add_scaled(simd, w, u, share(simd, s, square)),
        v,
        share(simd, t, square),
    );
    choose(simd, inside, foot, nearest)
}

/// The shorter of two vectors.
#[inline(always)]
fn nearer<S: Simd>(simd: S, a: Triple<S::f32s>, b: Triple<S::f32s>) -> Triple<S::f32s> {
    let first = simd.less_than_f32s(dot(simd, a, a), dot(simd, b, b));
    choose(simd, first, a, b)
}

/// One of two vectors.
#[inline(always)]
fn choose<S: Simd>(
    simd: S,
    first: S::m32s,
    a: Triple<S::f32s>,
    b: Triple<S::f32s>,
) -> Triple<S::f32s> {
    [
        simd.select_f32s(first, a[0], b[0]),
        simd.select_f32s(first, a[1], b[1]),
        simd.select_f32s(first, a[2], b[2]),
    ]
}

/// From the closest point of an edge to that of another, about (Ericson 2005, section 5.1.9), and whether they
/// pass by each other for certain: with every vector in it off by d, no longer than l, a product of four of
/// them is off by 4 d l^3, a difference of two by 8 d l^3, and that of two of those by 16 d l^3. `farthest` is the
/// largest coordinate [m], whose rounding d is.
#[inline(always)]
pub fn to_edge<S: Simd>(
    simd: S,
    [a, b, c, d]: &[Triple<S::f32s>; 4],
    farthest: f32,
) -> (Triple<S::f32s>, S::m32s) {
    let (u, v, w) = (sub(simd, *b, *a), sub(simd, *d, *c), sub(simd, *a, *c));
    let (uu, vv, uv) = (dot(simd, u, u), dot(simd, v, v), dot(simd, u, v));
    let (uw, vw, ww) = (dot(simd, u, w), dot(simd, v, w), dot(simd, w, w));
    let square = cross(simd, [uu, vv], [uv, uv]);
    let (s, t) = (
        cross(simd, [uv, vw], [uw, vv]),
        cross(simd, [uu, vw], [uv, uw]),
    );
    // Where they are parallel any s will do: the closest points follow from each other.
    let on_first = share(simd, s, square);
    let on_second = share(simd, simd.mul_add_e_f32s(uv, on_first, vw), vv);
    let on_first = share(simd, simd.sub_f32s(simd.mul_f32s(uv, on_second), uw), uu);
    let second = add_scaled(simd, sub(simd, *c, *a), v, on_second);
    let n = add_scaled(simd, second, u, simd.neg_f32s(on_first));

    let longest = simd.max_f32s(ww, simd.max_f32s(uu, vv));
    let off = simd.mul_f32s(longest, simd.sqrt_f32s(longest));
    let off = simd.mul_f32s(off, simd.splat_f32s(8.0 * ROUNDING * farthest));
    let known = simd.greater_than_f32s(square, simd.add_f32s(off, off));
    let outside = simd.or_m32s(
        is_outside(simd, s, square, off),
        is_outside(simd, t, square, off),
    );
    (n, simd.and_m32s(known, outside))
}

/// Whether a share of a whole is below nothing or above all of it, known no better than so.
#[inline(always)]
fn is_outside<S: Simd>(simd: S, share: S::f32s, whole: S::f32s, off: S::f32s) -> S::m32s {
    let below = simd.greater_than_f32s(simd.neg_f32s(share), off);
    let above = simd.greater_than_f32s(simd.sub_f32s(share, whole), simd.add_f32s(off, off));
    simd.or_m32s(below, above)
}
