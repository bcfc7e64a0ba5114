//! XPBD: friction that holds, and heaps.

use super::case;
use super::common::{toile, words};

/// Heights of the vertices of a mesh that a scene of a case ends with [m].
fn heights(name: &str, scene: &str, mesh: &str) -> Vec<f64> {
    let out = tempfile::tempdir().unwrap();
    let to = out.path().to_str().unwrap();
    let output = toile(&case(name), &["run", scene, "--out", to]);
    assert!(output.status.success(), "{}", words(&output.stderr));
    let text = std::fs::read_to_string(out.path().join(mesh)).unwrap();
    let vertices = text.lines().filter_map(|line| line.strip_prefix("v "));
    let height = |line: &str| line.split(' ').nth(1)?.parse().ok();
    vertices.filter_map(height).collect()
}

#[test]
fn pinched_cloth_does_not_creep_out() {
    let heights = heights("friction-creeps-xpbd", "pinch.json", "strip.obj");
    let border = &heights[heights.len() - 11..];
    let mean = border.iter().sum::<f64>() / 11.0;
    assert!(mean > 0.398, "{mean}");
}
