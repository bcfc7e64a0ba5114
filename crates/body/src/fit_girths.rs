//! Girth residuals of a fit: the convex hull of each section must be as long as the mesh's.
//!
//! A point of a convex hull that moves outward by d lengthens the hull by d times the angle that the hull
//! turns by there (to first order: the directions t of the edges change the length by `(t_before - t_after) .
//! dp`). So a girth is one more residual, linear in the moves of the surface at the corners of the hull.

use crate::fit_check::{LevelPart, pairs, tape};
use crate::fit_frame::FoundFrame;
use crate::fit_samples::PARTS;
use crate::fit_surface::Surface;
use crate::{Loop, Part, Primitive, Scan};
use std::f64::consts::TAU;
use toile_geometry::{Vec2, Vec3, convex_hull};

/// The residual of one tape, from the corners of the hull that lie on one part.
pub(crate) struct GirthResidual {
    /// Corners of the mesh's hull, mirrored to the left side (m), and the angle that the hull turns by at
    /// each (rad).
    pub(crate) corners: Vec<(Vec3, f64)>,
    /// Length by which a tape round the primitives' surface should exceed one through the corners (m).
    pub(crate) target: f64,
    /// Weight of the residual in the sum of squares (m2).
    pub(crate) weight: f64,
}

/// Distance between tapes, as a share of stature. The tapes lie half-way between the levels at which a fit is
/// judged.
const SPACING: f64 = 0.005;
/// Weight of the residual of a tape over that of single samples (1), before it is multiplied by the number of
/// the round: a girth shows the mean misfit of a whole section.
const STRESS: f64 = 8.0;
/// Neighbouring corners of a hull are merged until the hull turns by this angle at them together (rad).
const TURN: f64 = TAU / 64.0;
/// Largest change of a girth that is asked for in one round, as a share of stature.
const FAR: f64 = 0.012;

/// The girth residuals of each of [`PARTS`]: the moves of the primitives' surface by which the girth of the
/// skin cast from them would become that of the mesh. Girths get more weight from round to round.
pub(crate) fn girths(
    [mesh, skin]: [&Scan; 2],
    found: &FoundFrame,
    (groups, round): (&[Vec<Primitive>], usize),
) -> [Vec<GirthResidual>; 4] {
    let height = found.frame.height;
    let surfaces: Vec<Surface> = groups.iter().map(|own| Surface::new(own)).collect();
    let mut all: [Vec<GirthResidual>; 4] = Default::default();
    let first = (0.04 / SPACING) as usize;
    for k in first.. {
        let y = (k as f64 + 0.5) * SPACING * height;
        if y > found.chin {
            break;
        }
        for (level, pair) in pairs([mesh, skin], &found.frame.joints, y) {
            let around = tape(&pair[0]);
            let gap = (tape(&pair[1]) - around).clamp(-FAR * height, FAR * height);
            let corners = corners(&pair[0], y);
            let outermost: Vec<usize> = corners
                .iter()
                .map(|&(p, _)| outermost(&surfaces, level, p, found))
                .collect();
            for k in 0..PARTS.len() {
                let own: Vec<(Vec3, f64)> = corners
                    .iter()
                    .zip(&outermost)
                    .filter(|(_, part)| **part == k)
                    .map(|(corner, _)| *corner)
                    .collect();
                let turn: f64 = own.iter().map(|c| c.1).sum();
                if turn < 0.05 * TAU {
                    continue;
                }
                let share = turn / TAU;
                let model = surfaces[k].lengthening(&own);
                // A surface that does not pass near the corners gives no information about a tape.
                if model.abs() > 4.0 * FAR * height {
                    continue;
                }
                all[k].push(GirthResidual {
                    target: model - gap * share,
                    weight: STRESS * round as f64 * around * SPACING * height / (TAU * TAU * share),
                    corners: own,
                });
            }
        }
    }
    all
}

/// Corners of the hull of a section's loops (m), near ones merged, with the angle that the hull turns by at
/// each (rad).
fn corners(loops: &[Loop], y: f64) -> Vec<(Vec3, f64)> {
    let points: Vec<Vec2> = loops.iter().flat_map(|l| &l.points).copied().collect();
    let hull = convex_hull(&points);
    let count = hull.len();
    let turn = |k: usize| {
        let [a, b, c] = [
            hull[(k + count - 1) % count],
            hull[k],
            hull[(k + 1) % count],
        ];
        let (u, v) = (b - a, c - b);
        u.perp(&v).atan2(u.dot(&v)).abs()
    };
    let mut all: Vec<(Vec3, f64)> = Vec::new();
    let (mut sum, mut best) = (0.0, (0.0, 0));
    for k in 0..count {
        let own = turn(k);
        sum += own;
        if own >= best.0 {
            best = (own, k);
        }
        if sum >= TURN || k + 1 == count {
            let p = hull[best.1];
            all.push((Vec3::new(p.x.abs(), y, p.y), sum));
            (sum, best) = (0.0, (0.0, k));
        }
    }
    all
}

/// Index in [`PARTS`] of the part that a corner belongs to: of the parts whose surfaces the skin follows at
/// the corner, the one that lies farthest out.
fn outermost(surfaces: &[Surface], level: LevelPart, p: Vec3, found: &FoundFrame) -> usize {
    /// Distance within which two parts overlap, as a share of stature.
    const MEET: f64 = 0.018;
    let frame = &found.frame;
    let (j, meet) = (&frame.joints, MEET * frame.height);
    let mut parts = Vec::new();
    match level {
        LevelPart::Leg => {
            parts.push(Part::LeftLeg);
            if p.y > frame.crotch - meet {
                parts.push(Part::Trunk);
            }
        }
        LevelPart::Arm => parts.push(Part::LeftArm),
        // Well below the armpit, a section of the trunk contains no arms.
        LevelPart::Trunk => {
            let shoulder = Vec3::from(j.shoulder);
            let along = (Vec3::from(j.elbow) - shoulder).normalize();
            let beyond = (p - shoulder).dot(&along) - found.arm_begins;
            let has_arms = p.y > frame.armpit - 1.5 * meet;
            if has_arms && beyond > -meet {
                parts.push(Part::LeftArm);
            }
            if !has_arms || beyond < meet {
                parts.push(Part::Trunk);
            }
            if p.y > j.neck[1] - 0.5 * meet {
                parts.push(Part::Head);
            }
        }
    }
    let far = |k: usize| surfaces[k].beyond(p, &mut Vec::new()).0;
    (0..PARTS.len())
        .filter(|&k| parts.contains(&PARTS[k]))
        .max_by(|&a, &b| far(a).total_cmp(&far(b)))
        .unwrap_or_default()
}
