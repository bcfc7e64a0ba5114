//! What our own bodies are reported to have and what their skin has as anybody's mesh.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use toile_body::{Figure, Mannequin, Scan, ScanLandmarks};

/// What the two tapes may differ by [m]: that of a mesh looks for the largest or smallest girth, that
/// of our own bodies lies at a fixed place.
const LIMIT: f64 = 0.016;

#[test]
fn a_figure_s_mesh_has_its_girths_of_neck_and_limbs() {
    let mut missed = Vec::new();
    for figure in [Figure::Mean, Figure::Woman, Figure::Man] {
        let body = Mannequin::new(&figure.average(), figure).unwrap();
        let scan = Scan::new(body.skin().clone(), ScanLandmarks::default()).unwrap();
        let mesh = scan.measurements();
        for name in [
            "bust",
            "neck",
            "head",
            "leg_circ",
            "lower_thigh",
            "knee",
            "calf",
            "ankle",
            "upper_arm",
            "forearm",
            "wrist",
        ] {
            let (got, taken) = (
                body.taken(name).unwrap(),
                mesh.get(name).unwrap_or(f64::NAN),
            );
            let gap = (taken - got).abs();
            println!("{figure:?} {name}: {:.1} mm", 1e3 * (taken - got));
            if gap.is_nan() || gap > LIMIT {
                missed.push(format!("{figure:?} {name}: {got:.4} as a mesh {taken:.4}"));
            }
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}
