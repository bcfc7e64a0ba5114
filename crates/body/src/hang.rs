//! The steepest angle at which straight arms hang beside a body without touching it.

use toile_geometry::Vec3;

/// Steepest angle below the horizontal at which the arms of any body hang (rad).
pub(crate) const STEEPEST: f64 = 1.15;
/// Least distance between arm and trunk, as a share of stature: arms swing and trunks turn.
const CLEAR: f64 = 0.012;
/// Height of the bands in which the breadth of the trunk is stored, as a share of stature.
const BAND: f64 = 0.01;
/// Distance from the shoulder joint within which the arm is not checked, as a share of stature: skin folds
/// there.
const SHOULDER: f64 = 0.075;

/// Steepest angle below the horizontal (rad) at which the left arm, now at the angle `down`, clears trunk and
/// legs; `arm` is the share with which each vertex follows the arm.
pub(crate) fn hang(positions: &[Vec3], arm: &[f64], (shoulder, down): (Vec3, f64)) -> f64 {
    let stature = positions.iter().map(|p| p.y).fold(0.0, f64::max);
    let band = |y: f64| (y / (BAND * stature)).max(0.0) as usize;
    let mut breadth = vec![0.0_f64; band(stature) + 3];
    for (p, &follow) in positions.iter().zip(arm) {
        if follow < 0.05 {
            let own = band(p.y);
            for known in &mut breadth[own.saturating_sub(1)..=own + 1] {
                *known = known.max(p.x);
            }
        }
    }
    let far = |p: &Vec3| (p - shoulder).norm() > SHOULDER * stature;
    let limb: Vec<Vec3> = positions
        .iter()
        .zip(arm)
        .filter(|(p, follow)| p.x > 0.0 && **follow > 0.95 && far(p))
        .map(|(p, _)| p - shoulder)
        .collect();
    let clears = |angle: f64| {
        let (sin, cos) = (angle - down).sin_cos();
        limb.iter().all(|p| {
            let x = shoulder.x + p.x * cos + p.y * sin;
            let y = shoulder.y + p.y * cos - p.x * sin;
            let beside = breadth.get(band(y)).copied().unwrap_or_default();
            y <= 0.0 || x >= beside + CLEAR * stature
        })
    };
    let mut angle = STEEPEST;
    while angle > down && !clears(angle) {
        angle -= 0.01;
    }
    angle.max(down.min(STEEPEST))
}
