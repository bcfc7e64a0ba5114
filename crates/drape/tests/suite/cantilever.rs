//! The heavy cantilever: a strip clamped level at one end, bent by its own weight. Its shape
//! depends on Gamma = rho g L^3 / D alone (theta'' = -Gamma (1 - s) cos theta).

use crate::support::strips::{KINDS, Kind, strip};
use toile_drape::{
    Material, PseudoTransientContinuation, RestSettings, State, SystemBuilder, Workspace,
};
use toile_geometry::Vec3;

const LENGTH: f64 = 0.2;

/// Drop over projection of the tip; `locking` is Y L^2 / D.
fn drop_over_projection(kind: Kind, along: usize, gamma: f64, locking: f64) -> f64 {
    let density = 0.2;
    let d = density * 9.81 * LENGTH.powi(3) / gamma;
    let y = locking * d / (LENGTH * LENGTH);
    let material = Material {
        density,
        stretch: [y, y],
        shear: 0.5 * y,
        poisson: 0.0,
        bend: [d, d, d],
        ..Material::default()
    };
    let (cloth, pins) = strip(kind, LENGTH, 0.25 * LENGTH, along, material);
    let mut builder = SystemBuilder::new("strip", &cloth).unwrap();
    for pin in pins {
        builder.pinned[pin as usize] = true;
    }
    let system = builder.build();
    let mut state = State::at_rest(&system, cloth.positions.clone());
    let mut workspace = Workspace::default();
    let mut run = PseudoTransientContinuation::new(RestSettings {
        residual: 1e-7,
        steps: 600,
        longest_move: 0.05,
    });
    while !run.finished() {
        if run.advance(&system, &mut state, &mut workspace).is_err() {
            println!("    no lower than {:.1e}", run.residual());
            break;
        }
    }
    if run.residual() > 1e-6 {
        println!("    residual {:.1e} after {}", run.residual(), run.steps());
    }
    let tip: Vec<Vec3> = (0..cloth.positions.len())
        .filter(|&v| (cloth.positions[v].x - LENGTH).abs() < 1e-9)
        .map(|v| state.positions[v])
        .collect();
    let tip = tip.iter().sum::<Vec3>() / tip.len() as f64;
    -tip.y / tip.x
}

/// Error of the drop over projection, from the shape's differential equation solved to 1e-9.
fn error(kind: Kind, along: usize, (gamma, expected): (f64, f64), locking: f64) -> f64 {
    drop_over_projection(kind, along, gamma, locking) / expected - 1.0
}

#[test]
fn twenty_elements_meet_the_curve_on_every_mesh() {
    for case in [(0.1, 0.012500), (10.0, 1.066802)] {
        let errors = KINDS.map(|kind| error(kind, 20, case, 1e4));
        println!("Gamma {}: {errors:.5?}", case.0);
        assert!(errors[..3].iter().all(|e| e.abs() < 2e-3), "{errors:?}");
        // Slivers lock: the membrane of a triangle a twentieth as high as long resists its sagitta.
        assert!(errors[3].abs() < 0.06, "{errors:?}");
    }
}

/// Prints the table of docs/methods/drape.md; `DRAPE_TABLE=1` makes it full.
#[test]
fn the_error_falls_with_the_square_of_the_element() {
    let full = std::env::var("DRAPE_TABLE").is_ok();
    let case = (1.0, 0.124562);
    for kind in KINDS.into_iter().take(3) {
        let [coarse, fine] = [10, 20].map(|along| error(kind, along, case, 1e5).abs());
        assert!(coarse / fine > 3.0, "{kind:?}: {coarse} {fine}");
    }
    if !full {
        return;
    }
    let curve = [
        (0.01, 0.0012499996),
        (1.0, 0.124562),
        (5.0, 0.585721),
        (10.0, 1.066802),
        (20.0, 1.863930),
        (50.0, 3.705561),
        (100.0, 5.888105),
    ];
    for locking in [1e4, 1e5, 1e6, 1e7, 1e8] {
        for along in [5, 10, 20, 40] {
            for case in curve {
                if locking != 1e5 && case.0 != 10.0 {
                    continue;
                }
                let errors = KINDS.map(|kind| 100.0 * error(kind, along, case, locking));
                println!("{locking:.0e} {along:3} {:6}: {errors:+.3?} %", case.0);
            }
        }
    }
}
