//! Restitution: how high a cloth comes back.

use super::friction::board;
use crate::check::{Cases, Expected};
use crate::{Flat, LabError, MeshKind, Tolerance, rectangle};
use std::sync::Arc;
use toile_drape::{Collider, ContactSettings, Material, MethodKind, State, SystemBuilder};
use toile_geometry::{SurfaceTree, Vec2, Vec3};

/// Height that the cloth is dropped from (m).
const HEIGHT: f64 = 0.5;

/// How high it comes back, without restitution and with some.
const STAYS: Tolerance = Tolerance::zero("height/h", "the height it is dropped from", 1e-3);
const COMES_BACK: Tolerance = Tolerance::value("height, m", 0.01);
pub(super) const BOUNCE: [Tolerance; 2] = [STAYS, COMES_BACK];

/// Step (s): XPBD cuts it into twenty.
const STEP: f64 = 1.0 / 960.0;

/// Height that a cloth of some restitution comes back to (m).
fn back(restitution: f64) -> Result<f64, LabError> {
    let flat: Flat = rectangle(
        MeshKind::Alternating,
        Vec2::new(-0.05, -0.05),
        Vec2::new(0.05, 0.05),
        [4, 4],
    )?;
    let material = Material {
        restitution: Some(restitution),
        ..Material::default()
    };
    let ground = ContactSettings::default().offset;
    let cloth = flat.cloth(material, |p| Vec3::new(p.x, ground + HEIGHT, p.y));
    let mut builder = SystemBuilder::new("cloth", &cloth)?;
    let board = Arc::new(SurfaceTree::new(board()));
    builder.colliders.push(Collider::new(board));
    let system = builder.build();
    let mut state = State::at_rest(&system, cloth.positions);
    let all: Vec<u32> = (0..flat.points.len() as u32).collect();
    let fall = (2.0 * HEIGHT / 9.81).sqrt();
    let (mut down, mut highest) = (false, f64::NEG_INFINITY);
    let settings = MethodKind::Xpbd.into();
    // Down, and up again with that share of the speed.
    let duration = 1.05 * fall * (1.0 + restitution) + 0.05;
    crate::settle::in_time(&system, &mut state, settings, [STEP, duration], |state| {
        let height = crate::settle::mean(&state.positions, &all).y - ground;
        down |= height < 0.05 * HEIGHT;
        let leaving = state.velocities.iter().map(|v| v.y).sum::<f64>() >= 0.0;
        if down && leaving {
            highest = highest.max(height);
        }
    })?;
    Ok(highest)
}

/// A cloth dropped flat from h comes back to e^2 h. The substep, 5e-5 s, is too short for the fall to
/// sink more than 0.16 mm into the board.
pub(super) fn bounce(cases: &mut Cases) -> Result<(), LabError> {
    cases.measure("e 0".to_owned(), Expected::zero(STAYS, HEIGHT), || {
        back(0.0)
    })?;
    for e in [0.3, 0.6, 0.9, 1.0] {
        cases.measure(
            format!("e {e}"),
            Expected::value(COMES_BACK, e * e * HEIGHT),
            || back(e),
        )?;
    }
    Ok(())
}
