//! A strip pushed down on a table: its tip sticks until friction can bear no more.

use super::friction::board;
use crate::check::{Cases, Expected};
use crate::flat::{STRAIGHT, clamped};
use crate::settle::{mean, to_rest};
use crate::{Flat, LabError, MeshKind, Tolerance, propped_elastica, rectangle};
use std::sync::Arc;
use toile_drape::{Collider, ContactSettings, Material, State, System, SystemBuilder};
use toile_geometry::{SurfaceTree, Vec2, Vec3};

/// Length of the strip (m), elements along it, and its bending stiffness (N m).
const LENGTH: f64 = 0.1;
const ELEMENTS: usize = 40;
const BEND: f64 = 1e-5;
/// Membrane stiffness Y L^2 / D: at 20 D / L^2 the strip shortens by 2e-5.
const STIFF: f64 = 1e6;
/// Net force over weight at which it is at rest: its weight is ten times the force that buckles it.
const RESIDUAL: f64 = 1e-5;
/// A tip that slides by this share of the length no longer sticks. The springs of contact give by a
/// tenth of it, and a tip that has slid so far needs 0.2 % less friction.
const SLID: f64 = 3e-4;

/// A strip upright over a table, its tip on it.
struct Strip {
    flat: Flat,
    system: System,
    state: State,
    tip: Vec<u32>,
}

impl Strip {
    /// Bowed to one side by a little, its tip at the contact offset.
    fn new(kind: MeshKind) -> Result<Self, LabError> {
        let cell = LENGTH / (ELEMENTS as f64 + 0.5);
        let rows = 4;
        let from = -(STRAIGHT as f64 - 0.5) * cell;
        let flat = rectangle(
            kind,
            Vec2::new(from, 0.0),
            Vec2::new(LENGTH, rows as f64 * cell),
            [ELEMENTS + STRAIGHT, rows],
        )?;
        let stretch = STIFF * BEND / (LENGTH * LENGTH);
        let material = Material {
            density: 0.2,
            stretch: [stretch; 2],
            shear: 0.5 * stretch,
            poisson: 0.0,
            bend: [BEND; 3],
            friction: 10.0,
            ..Material::default()
        };
        let offset = ContactSettings::default().offset;
        let cloth = flat.cloth(material, |p| {
            let s = (p.x / LENGTH).clamp(0.0, 1.0);
            let bow = 0.02 * LENGTH * s * s * (1.0 - s);
            Vec3::new(bow, offset + LENGTH - p.x, p.y)
        });
        let mut builder = SystemBuilder::new("strip", &cloth)?;
        builder.control.gravity = Vec3::zeros();
        let table = SurfaceTree::new(board());
        builder.colliders.push(Collider::new(Arc::new(table)));
        for v in flat.chosen(|p| clamped(p.x, cell)) {
            builder.pinned[v as usize] = true;
        }
        let system = builder.build();
        let tip = flat.chosen(|p| p.x > LENGTH - 1e-9);
        let state = State::at_rest(&system, cloth.positions);
        Ok(Self {
            flat,
            system,
            state,
            tip,
        })
    }

    /// Brings the clamp down to a share of the length, in stages of half a per cent.
    fn push(&mut self, from: f64, to: f64) -> Result<(), LabError> {
        let stages = ((to - from) / 0.005).ceil().max(1.0);
        for _ in 0..stages as usize {
            for v in 0..self.flat.points.len() {
                if self.system.prescribed.pinned[v] {
                    self.state.positions[v].y -= (to - from) / stages * LENGTH;
                }
            }
            to_rest(&self.system, &mut self.state, RESIDUAL)?;
        }
        Ok(())
    }

    /// Whether the tip stays with a friction coefficient.
    fn sticks(&mut self, friction: f64) -> Result<bool, LabError> {
        for sample in Arc::make_mut(&mut self.state.samples) {
            sample.friction = friction;
        }
        let before = mean(&self.state.positions, &self.tip).x;
        let mut state = self.state.clone();
        to_rest(&self.system, &mut state, RESIDUAL)?;
        let moved = mean(&state.positions, &self.tip).x - before;
        Ok(moved.abs() < SLID * LENGTH)
    }

    /// The least friction coefficient that holds the tip, between a half and twice a guess.
    fn least_friction(&mut self, guess: f64) -> Result<f64, LabError> {
        let [mut slips, mut sticks] = [0.5 * guess, 2.0 * guess];
        while sticks - slips > 1e-3 * guess {
            let middle = 0.5 * (slips + sticks);
            if self.sticks(middle)? {
                sticks = middle;
            } else {
                slips = middle;
            }
        }
        Ok(0.5 * (slips + sticks))
    }
}

/// The least coefficient that holds the tip.
const LEAST: Tolerance = Tolerance::value("least mu", 0.01);
pub(super) const STICK_SLIP: [Tolerance; 1] = [LEAST];

/// How far the clamp comes down, over the length.
const DOWN: [f64; 4] = [0.05, 0.1, 0.2, 0.3];

/// The coefficient of friction that just holds the tip, against the propped elastica.
pub(super) fn stick_slip(cases: &mut Cases) -> Result<(), LabError> {
    for (name, kind) in [("right", MeshKind::Right), ("delaunay", MeshKind::Delaunay)] {
        let mut strip = Strip::new(kind)?;
        let mut before = 0.0;
        for down in DOWN {
            let expected = propped_elastica(down).friction();
            cases.measure(
                format!("clamp down by {down} L, {name}"),
                Expected::value(LEAST, expected),
                || {
                    for sample in Arc::make_mut(&mut strip.state.samples) {
                        sample.friction = 10.0;
                    }
                    strip.push(before, down)?;
                    before = down;
                    strip.least_friction(expected)
                },
            )?;
        }
    }
    Ok(())
}
