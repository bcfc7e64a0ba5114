//! Girth residuals of a fit: the convex hull of each section must be as long as the mesh's.
//!
//! A point of a convex hull that moves outward by d lengthens it by d times the angle the hull turns
//! by there (to first order: the edges' directions t change by `(t_before - t_after) . dp`).
//! So a girth is one more residual, linear in the surface's moves at the hull's corners.

use crate::fit_check::{LevelPart, pairs, tape};
use crate::fit_frame::FoundFrame;
use crate::fit_samples::PARTS;
use crate::fit_surface::Surface;
use crate::{Loop, Part, Primitive, Scan};
use std::f64::consts::TAU;
use toile_geometry::{Vec2, Vec3, convex_hull};

/// The residual of one tape, of the hull corners that lie on one part.
pub(crate) struct GirthResidual {
    /// Corners of the mesh's hull, folded to the left (m), and the angle it turns by there (rad).
    pub(crate) corners: Vec<(Vec3, f64)>,
    /// By how much the surface's moves off the corners should lengthen the tape (m).
    pub(crate) target: f64,
    /// Its share of the sum of squares (m2).
    pub(crate) weight: f64,
}

/// Distance between tapes, over stature. They lie between the levels a fit is judged by.
const SPACING: f64 = 0.005;
/// How much more the mean of a section's misfit counts than the misfit itself, for each round.
const STRESS: f64 = 8.0;
/// Corners of a hull are taken together up to this turn (rad).
const TURN: f64 = TAU / 64.0;
/// The most a tape is asked to change by at a time, over stature.
const FAR: f64 = 0.012;

/// The tapes of each of [`PARTS`]: the difference of a skin cast from primitives and the mesh, as moves of
/// the primitives' surface. Girths count for more from
/// round to round.
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
                // A surface that is not met near the corners says nothing of a tape.
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

/// Corners of the hull of a section's loops, near ones taken together, with what it turns by.
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

/// Which of [`PARTS`] a corner belongs to: of those whose surfaces the skin follows there, the one
/// that lies farthest out.
fn outermost(surfaces: &[Surface], level: LevelPart, p: Vec3, found: &FoundFrame) -> usize {
    /// Over stature: over which rings two parts meet.
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
        // Below, a trunk's section has no arms in it.
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
