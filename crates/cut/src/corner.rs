//! Shapes of the cut line at an outer corner of the seam line.
//!
//! At a corner `p` the edge before it has direction `d`, outward normal `n` and width `a`; the edge after it
//! has direction `e`, normal `m` and width `b`. The seam line turns left by the angle φ, 0 < φ < π:
//! `n x m = sin φ`, `n . m = cos φ`. Everything below is relative to `p`.

use toile_geometry::{Vec2, ring_area};
use toile_pattern::MitreLimit;

/// Shape of the cut line at an outer corner, where the piece is convex. At an inner corner the two cut lines
/// meet without further cloth, whichever shape is asked: no cloth is added there or taken away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Corner {
    /// Both cut lines run on until they meet, in `p + r` with `n.r = a`, `m.r = b`. A tip farther out than
    /// the corner's limit is cut off at the limit, square to `r`.
    #[default]
    Mitre,
    /// A straight line from the end of one edge's allowance to the end of the other edge's allowance.
    Bevel,
    /// The seam of the edge before is sewn first: its seam line is extended to the cut line of the edge
    /// after, and there the allowance of the edge before ends square.
    SquareToPrevious,
    /// The seam of the edge after is sewn first: its seam line is extended back to the cut line of the edge
    /// before, and there the allowance of the edge after ends square.
    SquareToNext,
    /// Each cut line runs to the other edge's extended seam line; the ends are joined by a straight line.
    Extended,
    /// The edge before is a hem. The cut line of the other edge is mirrored in the hem's seam line, and the
    /// hem's allowance ends on this image, so that both lie flush once the hem is turned up.
    MirroredInPrevious,
    /// As `MirroredInPrevious`, but the edge after is the hem.
    MirroredInNext,
}

/// Default limit of the distance from a corner to its cut line, over the wider of the two allowances (1): a
/// longer point of cloth is in the way of the sewing. 2.5 keeps mitres down to 47 degrees whole.
pub const MITRE_LIMIT: f64 = MitreLimit::USUAL;

/// Sine of the smallest turn that counts as a corner (1): at this turn the ends of two allowances of 40 mm
/// are 0.4 um apart, and wedges between them would be lost on the grid on which the cloth is united.
pub(crate) const STRAIGHT: f64 = 1e-5;

impl Corner {
    /// The shape for the loop walked the other way: previous and next are swapped.
    pub(crate) fn reversed(self) -> Self {
        match self {
            Self::SquareToPrevious => Self::SquareToNext,
            Self::SquareToNext => Self::SquareToPrevious,
            Self::MirroredInPrevious => Self::MirroredInNext,
            Self::MirroredInNext => Self::MirroredInPrevious,
            Self::Mitre | Self::Bevel | Self::Extended => self,
        }
    }
}

/// The points `x` with `normal.x <= limit`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfPlane {
    pub normal: Vec2,
    /// Greatest dot product with `normal`: a distance (m) where `normal` has length 1.
    pub limit: f64,
}

impl HalfPlane {
    /// The part of a convex polygon that lies in the half-plane.
    pub fn clip(&self, polygon: &[Vec2]) -> Vec<Vec2> {
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (k, &p) in polygon.iter().enumerate() {
            let q = polygon[(k + 1) % polygon.len()];
            let (here, there) = (
                self.normal.dot(&p) - self.limit,
                self.normal.dot(&q) - self.limit,
            );
            if here <= 0.0 {
                kept.push(p);
            }
            if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
                kept.push(p + (q - p) * (here / (here - there)));
            }
        }
        kept
    }

    /// The half-plane moved by the vector `by` (m).
    pub fn translated(&self, by: Vec2) -> Self {
        Self {
            normal: self.normal,
            limit: self.limit + self.normal.dot(&by),
        }
    }
}

/// Result of making a corner: as asked, cut off, or mitred instead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Outcome {
    AsAsked,
    /// The corner is cut off at its limit; uncut, it would reach this far from the seam line's corner (m).
    CutOff(f64),
    /// The corner is mitred instead, because the shape asked for would reach too far: this far from the seam
    /// line's corner (m).
    Mitred(f64),
}

/// Cloth at a corner: convex patches, counter-clockwise, and the cuts through the allowances of the edge
/// before and of the edge after.
#[derive(Clone, Debug)]
pub(crate) struct CornerCloth {
    pub patches: Vec<Vec<Vec2>>,
    pub trims: [Option<HalfPlane>; 2],
    pub outcome: Outcome,
}

/// One of the two edges that meet at a corner, as seen from the corner.
#[derive(Clone, Copy)]
struct Side {
    /// Direction in which the edge's seam line is extended beyond the corner: `d` for the edge before the
    /// corner, `-e` for the edge after it.
    out: Vec2,
    normal: Vec2,
    width: f64,
}

/// A corner between two edges.
struct Turn {
    before: Side,
    after: Side,
    sin: f64,
    cos: f64,
    /// Largest distance from the corner that its cloth may reach (m).
    limit: f64,
}

/// Cloth at a corner between outward normals `n` and `m` with widths `a` and `b`. It reaches at most `limit`
/// times the wider width. `None`: the seam line turns inwards or not at all, or neither edge has an
/// allowance.
pub(crate) fn corner_cloth(
    (kind, limit): (Corner, f64),
    normals: [Vec2; 2],
    widths: [f64; 2],
) -> Option<CornerCloth> {
    let ([n, m], [a, b]) = (normals, widths);
    let (sin, cos) = (n.perp(&m), n.dot(&m));
    if a.max(b) == 0.0 || (sin <= STRAIGHT && (cos > 0.0 || sin < -STRAIGHT)) {
        return None;
    }
    let turn = Turn {
        before: Side {
            out: Vec2::new(-n.y, n.x),
            normal: n,
            width: a,
        },
        after: Side {
            out: Vec2::new(m.y, -m.x),
            normal: m,
            width: b,
        },
        sin: sin.max(0.0),
        cos,
        limit: limit * a.max(b),
    };
    let mut cloth = match kind {
        Corner::Mitre => turn.mitre(),
        Corner::Bevel => CornerCloth::patch(vec![Vec2::zeros(), n * a, m * b]),
        Corner::SquareToPrevious => turn.square(&turn.before, &turn.after, 1),
        Corner::SquareToNext => turn.square(&turn.after, &turn.before, 0),
        Corner::Extended => turn.extended(),
        Corner::MirroredInPrevious => turn.mirrored(&turn.before, &turn.after, 0),
        Corner::MirroredInNext => turn.mirrored(&turn.after, &turn.before, 1),
    };
    cloth.patches.iter_mut().for_each(tidy);
    cloth.patches.retain(|p| p.len() > 2);
    Some(cloth)
}

/// Makes a patch counter-clockwise and removes repeated points.
fn tidy(patch: &mut Vec<Vec2>) {
    patch.dedup_by(|a, b| (*a - *b).norm() < 1e-12);
    if ring_area(patch) < 0.0 {
        patch.reverse();
    }
}

impl CornerCloth {
    fn patch(patch: Vec<Vec2>) -> Self {
        Self {
            patches: vec![patch],
            trims: [None; 2],
            outcome: Outcome::AsAsked,
        }
    }

    /// `patch`, cut off square at the distance `limit` along `out` if its `reach` is farther.
    fn limited(patch: Vec<Vec2>, out: Vec2, limit: f64, reach: f64) -> Self {
        if reach <= limit {
            return Self::patch(patch);
        }
        let end = HalfPlane { normal: out, limit };
        Self {
            outcome: Outcome::CutOff(reach),
            ..Self::patch(end.clip(&patch))
        }
    }
}

impl Turn {
    /// Unit vector out of the corner, half-way between the two extended seam lines.
    fn bisector(&self) -> Vec2 {
        (self.before.out + self.after.out).normalize()
    }

    /// Meeting point of the two offset lines; far away or not finite where they are parallel.
    fn tip(&self) -> Vec2 {
        let (n, m) = (self.before.normal, self.after.normal);
        let (a, b) = (self.before.width, self.after.width);
        Vec2::new(a * m.y - b * n.y, b * n.x - a * m.x) / self.sin
    }

    fn mitre(&self) -> CornerCloth {
        let Turn { before, after, .. } = self;
        let (na, mb) = (before.normal * before.width, after.normal * after.width);
        // The end line of the wider allowance reaches beyond the other cut line. That cut line runs on until
        // it meets the end line.
        if after.width * self.cos > before.width {
            let u = after.normal * (before.width / self.cos);
            return CornerCloth::patch(vec![Vec2::zeros(), na, u]);
        }
        if before.width * self.cos > after.width {
            let v = before.normal * (after.width / self.cos);
            return CornerCloth::patch(vec![Vec2::zeros(), v, mb]);
        }
        let tip = self.tip();
        let reach = match tip.norm() {
            length if length.is_finite() => length,
            _ => f64::INFINITY,
        };
        if reach <= self.limit {
            return CornerCloth::patch(vec![Vec2::zeros(), na, tip, mb]);
        }
        let way = match self.sin > STRAIGHT {
            true => tip.normalize(),
            false => self.bisector(),
        };
        let end = |start: Vec2, out: Vec2| {
            start + out * ((self.limit - start.dot(&way)) / out.dot(&way)).max(0.0)
        };
        CornerCloth {
            outcome: Outcome::CutOff(reach),
            ..CornerCloth::patch(vec![
                Vec2::zeros(),
                na,
                end(na, before.out),
                end(mb, after.out),
                mb,
            ])
        }
    }

    /// A mitre in place of the shape asked for, which would reach as far as `reach` (m).
    fn mitre_instead(&self, reach: f64) -> CornerCloth {
        let mitre = self.mitre();
        match mitre.outcome {
            Outcome::AsAsked => CornerCloth {
                outcome: Outcome::Mitred(reach),
                ..mitre
            },
            _ => mitre,
        }
    }

    /// The seam line of `sewn` is extended to the cut line of `other`, and there the allowance of `sewn` ends
    /// square. `trimmed` is the index of `sewn` among the trims.
    fn square(&self, sewn: &Side, other: &Side, trimmed: usize) -> CornerCloth {
        let reach = other.width / self.sin;
        let (end, out) = (sewn.out * reach, sewn.normal * sewn.width);
        if self.cos > 0.0 {
            if reach > self.limit {
                return self.mitre_instead(reach);
            }
            let mut cloth = CornerCloth::patch(vec![Vec2::zeros(), out, end + out, end]);
            cloth.trims[trimmed] = Some(HalfPlane {
                normal: sewn.normal,
                limit: sewn.width,
            });
            return cloth;
        }
        if self.sin <= STRAIGHT {
            return self.mitre();
        }
        let side = other.normal * other.width;
        CornerCloth::limited(
            vec![Vec2::zeros(), side, end, end + out, out],
            sewn.out,
            self.limit,
            reach,
        )
    }

    fn extended(&self) -> CornerCloth {
        let Turn { before, after, .. } = self;
        let reach = before.width.max(after.width) / self.sin;
        let e = after.out * (before.width / self.sin);
        let f = before.out * (after.width / self.sin);
        if self.cos > 0.0 {
            if reach > self.limit {
                return self.mitre_instead(reach);
            }
            let across = f - e;
            let normal = Vec2::new(across.y, -across.x).normalize();
            let trim = Some(HalfPlane {
                normal,
                limit: normal.dot(&e).max(0.0),
            });
            return CornerCloth {
                trims: [trim; 2],
                ..CornerCloth::patch(vec![Vec2::zeros(), e, f])
            };
        }
        if self.sin <= STRAIGHT {
            return self.mitre();
        }
        let (na, mb) = (before.normal * before.width, after.normal * after.width);
        let out = self.bisector();
        let reach = e.dot(&out).max(f.dot(&out));
        CornerCloth::limited(vec![Vec2::zeros(), na, e, f, mb], out, self.limit, reach)
    }

    /// The allowance of the hem edge `hem` ends so that it lies flush with `other` once it is turned up along
    /// its seam line. `trimmed` is the index of the hem among the trims.
    fn mirrored(&self, hem: &Side, other: &Side, trimmed: usize) -> CornerCloth {
        // Distance along the hem's extended seam line to the other cut line (m).
        let meet = other.width / self.sin;
        // Distance along the hem's cut line to the mirror image of the other cut line (m).
        let end = (other.width + hem.width * self.cos) / self.sin;
        let reach = meet.max(end);
        if reach > self.limit || self.sin <= STRAIGHT {
            return self.mitre_instead(reach);
        }
        let mirrored = other.normal - hem.normal * (2.0 * self.cos);
        let (f, w) = (hem.out * meet, hem.normal * hem.width + hem.out * end);
        let mut turned_up = vec![Vec2::zeros(), w, f];
        if end > 0.0 {
            turned_up.insert(1, hem.normal * hem.width);
        }
        let mut cloth = CornerCloth::patch(turned_up);
        if self.cos > 0.0 {
            cloth.trims[1 - trimmed] = Some(HalfPlane {
                normal: hem.normal,
                limit: hem.width,
            });
        } else {
            cloth
                .patches
                .push(vec![Vec2::zeros(), f, other.normal * other.width]);
            cloth.trims[trimmed] = Some(HalfPlane {
                normal: mirrored,
                limit: other.width,
            });
        }
        cloth
    }
}
