//! How the cut line turns at an outer corner of the seam line.
//!
//! At a corner `p` the edge before it has direction `d`, outward normal `n` and width `a`; the
//! edge after it `e`, `m` and `b`. The seam line turns left by the angle φ, 0 < φ < π:
//! `n x m = sin φ`, `n . m = cos φ`. Everything below is relative to `p`.

use toile_geometry::{Vec2, ring_area};
use toile_pattern::MitreLimit;

/// How the cut line turns at a corner where the piece is convex. At an inner corner the two cut
/// lines meet on their own, whatever is asked: no cloth is added there and none taken away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Corner {
    /// Both cut lines run on until they meet, in `p + r` with `n.r = a`, `m.r = b`; a tip
    /// farther than the corner's limit is cut off there, square to `r`.
    #[default]
    Mitre,
    /// Straight across from the end of one allowance to that of the other.
    Bevel,
    /// The edge before is sewn first: its seam line runs on to the cut line of the edge after,
    /// and there its allowance ends square.
    SquareToPrevious,
    /// The edge after is sewn first: its seam line runs back to the cut line of the edge before,
    /// and there its allowance ends square.
    SquareToNext,
    /// Each cut line runs to the other edge's extended seam line; straight across between the two.
    Extended,
    /// The edge before is a hem: its allowance ends on the mirror image in it of the other cut
    /// line, so that both lie flush once it is turned up.
    MirroredInPrevious,
    /// The same of the edge after.
    MirroredInNext,
}

/// No corner reaches farther than this times the wider of its allowances unless it is asked to:
/// beyond, a point of cloth is in the way of the sewing. 2.5 keeps mitres down to 47 degrees whole.
pub const MITRE_LIMIT: f64 = MitreLimit::USUAL;

/// Corners that turn by less are none (sine of the angle): the ends of two allowances of 40 mm
/// are then 0.4 um apart, and wedges between them would be lost on the union's grid.
pub(crate) const STRAIGHT: f64 = 1e-5;

impl Corner {
    /// The same corner of the loop walked the other way.
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
    /// (m) where `normal` has length 1.
    pub limit: f64,
}

impl HalfPlane {
    /// The part of a convex polygon inside it.
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

    /// The same for points relative to an origin that lies at `-by`.
    pub fn translated(&self, by: Vec2) -> Self {
        Self {
            normal: self.normal,
            limit: self.limit + self.normal.dot(&by),
        }
    }
}

/// The outcome of a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Outcome {
    AsAsked,
    /// It would have reached this far (m) and is cut off.
    CutOff(f64),
    /// Its kind would reach this far (m): mitred instead.
    Mitred(f64),
}

/// The cloth at a corner: convex patches, counter-clockwise, and what is cut away from the ends
/// of the allowances before and after it.
#[derive(Clone, Debug)]
pub(crate) struct CornerCloth {
    pub patches: Vec<Vec<Vec2>>,
    pub trims: [Option<HalfPlane>; 2],
    pub outcome: Outcome,
}

/// One of the two edges, seen from the corner.
#[derive(Clone, Copy)]
struct Side {
    /// Direction in which its seam line leaves it: `d` before the corner, `-e` after it.
    out: Vec2,
    normal: Vec2,
    width: f64,
}

/// The corner between two edges.
struct Turn {
    before: Side,
    after: Side,
    sin: f64,
    cos: f64,
    /// Farthest reach (m).
    limit: f64,
}

/// The cloth at a corner between outward normals `n` and `m` with widths `a` and `b`, which reaches
/// up to the limit times the wider; nothing where the seam line turns inwards, not at all, or has no
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

/// Counter-clockwise without repeated points.
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

    /// `patch` up to a square end at `limit` along `out`, if `reach` is farther.
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
    /// Direction half-way out of the corner.
    fn bisector(&self) -> Vec2 {
        (self.before.out + self.after.out).normalize()
    }

    /// Where both offset lines meet; far away where they do not.
    fn tip(&self) -> Vec2 {
        let (n, m) = (self.before.normal, self.after.normal);
        let (a, b) = (self.before.width, self.after.width);
        Vec2::new(a * m.y - b * n.y, b * n.x - a * m.x) / self.sin
    }

    fn mitre(&self) -> CornerCloth {
        let Turn { before, after, .. } = self;
        let (na, mb) = (before.normal * before.width, after.normal * after.width);
        // The end of the wider allowance stands beyond the other's cut line, which runs on to it.
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

    /// A mitre because a corner of the kind asked for would reach this far.
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

    /// The seam line of `sewn` runs on to the cut line of `other`, its allowance ends square there.
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

    /// `hem` is turned up along its seam line; number of its trim.
    fn mirrored(&self, hem: &Side, other: &Side, trimmed: usize) -> CornerCloth {
        // The other cut line meets the hem's extended seam line here.
        let meet = other.width / self.sin;
        // Its mirror image meets the hem's cut line this far out.
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
