//! The way to rest where contact is hard.

use crate::methods::fixtures::{ball_mesh, cloth, sheet};
use std::sync::Arc;
use toile_drape::{Collider, Material, PseudoTransientContinuation, RestSettings, Workspace};
use toile_geometry::{SurfaceTree, Vec3};

/// In an armpit the push of the body turns as the cloth slides: steps that do not know it are too
/// long, and the way goes round for ever.
#[test]
fn cloth_in_a_hollow_slides_to_its_lowest_place_in_few_steps() {
    // A patch of 30 mm in a bowl whose walls it meets at a radius of 46 mm, 0.4 rad up its side.
    let mesh = sheet([6, 6], [0.03, 0.03], |u, v| {
        let (x, z) = (u - 0.015, v - 0.015);
        let y = -(0.046f64 * 0.046 - x * x - z * z).sqrt();
        let (sin, cos) = 0.4f64.sin_cos();
        Vec3::new(x * cos - y * sin, x * sin + y * cos, z)
    });
    let material = Material {
        friction: 0.0,
        ..Material::default()
    };
    let (mut system, mut state) = cloth(&mesh, material);
    let mut bowl = ball_mesh(0.05);
    for triangle in &mut bowl.triangles {
        triangle.swap(1, 2);
    }
    system = system.with(|builder| {
        builder.colliders = vec![Collider::new(Arc::new(SurfaceTree::new(bowl)))];
    });
    let settings = RestSettings {
        residual: 1e-4,
        steps: 300,
        ..RestSettings::default()
    };
    let mut run = PseudoTransientContinuation::near(settings);
    let mut workspace = Workspace::default();
    while !run.finished() {
        run.advance(&system, &mut state, &mut workspace)
            .expect("the way goes on");
    }
    assert!(run.residual() <= 1e-4, "{}", run.residual());
    assert!(run.steps() <= 30, "{}", run.steps());
    let middle = state.positions[24];
    assert!(middle.x.hypot(middle.z) < 2e-3, "{middle}");
}
