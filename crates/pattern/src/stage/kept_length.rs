//! Trued darts that shorten the finished edge by their intake alone: the mouth is made narrower by the length
//! that truing takes in addition.

use super::dart::{DartMouth, cut_dart};
use super::truing::true_darts;
use super::{NOTHING, Stage};
use crate::{CornerName, Role};

/// Largest difference between lengths that count as equal (m).
const SAME: f64 = 1e-12;
/// Most steps of the iteration for the width. Each step gives about 1.6 times as many correct digits as the
/// step before.
const MAX_STEPS: usize = 40;

/// Width of the mouth (m) with which a trued dart makes the finished outline shorter by its intake alone,
/// found by the secant method. `None`: there is no such width. For a dart that cannot be trued, the width is
/// the intake.
pub(crate) fn width_kept(stage: &Stage, mouth: &DartMouth, going_on: &[CornerName]) -> Option<f64> {
    let wanted = finished(stage) - mouth.intake;
    let untrued = stage.as_untrued();
    let beyond = |intake: f64| -> Option<f64> {
        let cut = cut_dart(&untrued, &DartMouth { intake, ..*mouth }).ok()?;
        let (trued, refused) = true_darts(cut, going_on);
        let is_trued = refused.iter().all(|(by, _)| *by != mouth.by);
        is_trued.then(|| finished(&trued) - wanted)
    };
    let mut before = mouth.intake;
    let Some(mut beyond_before) = beyond(before) else {
        return Some(mouth.intake);
    };
    // First guess: the finished outline changes by about as much as the width.
    let mut width = before + beyond_before;
    for _ in 0..MAX_STEPS {
        if beyond_before.abs() <= SAME {
            return Some(before);
        }
        if !(width > NOTHING && width.is_finite()) {
            return None;
        }
        let beyond_now = beyond(width)?;
        let slope = (beyond_now - beyond_before) / (width - before);
        (before, beyond_before) = (width, beyond_now);
        width -= beyond_now / slope;
    }
    // The result is accepted if it is as near as floating-point numbers of this size allow.
    (beyond_before.abs() <= 1e3 * SAME).then_some(before)
}

/// Length of the outline when its darts are closed (m).
fn finished(stage: &Stage) -> f64 {
    let edges = stage.outline().iter();
    let sewn = edges.filter(|edge| edge.name.role() != Some(Role::Leg));
    sewn.map(|edge| edge.curve.length()).sum()
}
