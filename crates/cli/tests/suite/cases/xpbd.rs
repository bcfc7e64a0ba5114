//! XPBD: friction that holds, and heaps.

use super::case;
use crate::common::{toile, words};
use serde_json::{Value, json};
use std::path::Path;

/// Heights of the vertices of a mesh that a scene in a folder ends with (m).
fn heights(folder: &Path, scene: &str, mesh: &str) -> Vec<f64> {
    let out = tempfile::tempdir().unwrap();
    let to = out.path().to_str().unwrap();
    let output = toile(folder, &["run", scene, "--out", to]);
    assert!(output.status.success(), "{}", words(&output.stderr));
    let text = std::fs::read_to_string(out.path().join(mesh)).unwrap();
    let vertices = text.lines().filter_map(|line| line.strip_prefix("v "));
    let height = |line: &str| line.split(' ').nth(1)?.parse().ok();
    vertices.filter_map(height).collect()
}

#[test]
fn pinched_cloth_does_not_creep_out() {
    let heights = heights(&case("friction-creeps-xpbd"), "pinch.json", "strip.obj");
    let border = &heights[heights.len() - 11..];
    let mean = border.iter().sum::<f64>() / 11.0;
    assert!(mean > 0.398, "{mean}");
}

/// Heights of the upper border of the strip of the pinch at the end of its scene as changed by `change` (m).
fn border(change: impl Fn(&mut Value)) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let from = case("friction-creeps-xpbd");
    for mesh in ["left.obj", "right.obj", "strip.obj"] {
        std::fs::copy(from.join(mesh), folder.path().join(mesh)).unwrap();
    }
    let text = std::fs::read_to_string(from.join("pinch.json")).unwrap();
    let mut scene: Value = serde_json::from_str(&text).unwrap();
    change(&mut scene);
    std::fs::write(folder.path().join("changed.json"), scene.to_string()).unwrap();
    let heights = heights(folder.path(), "changed.json", "strip.obj");
    let border = &heights[heights.len() - 11..];
    border.iter().sum::<f64>() / 11.0
}

#[test]
fn blocks_that_rise_carry_what_they_pinch() {
    let border = border(|scene| {
        for block in [0, 1] {
            let block = &mut scene["objects"][block];
            block["kind"] = json!("animated");
            let key = |time: f64, y: f64| json!({ "time": time, "translation": [0, y, 0] });
            block["motion"] = json!({ "keys": [key(0.0, 0.0), key(1.5, 0.03)] });
        }
    });
    assert!((border - 0.43).abs() < 1e-4, "{border}");
}

#[test]
fn two_strips_in_one_pinch_hold_each_other() {
    let border = border(|scene| {
        scene["collision"] = json!({ "cloth_offset": 0.002 });
        let objects = scene["objects"].as_array_mut().unwrap();
        let mut second = objects[2].clone();
        second["name"] = json!("second");
        objects[2]["transform"] = json!({ "translation": [0, 0, -0.001] });
        second["transform"] = json!({ "translation": [0, 0, 0.001] });
        objects.push(second);
        for (block, z) in [(0, -0.001), (1, 0.001)] {
            objects[block]["transform"] = json!({ "translation": [0, 0, z] });
        }
    });
    assert!((border - 0.4).abs() < 1e-4, "{border}");
}

#[test]
fn a_pinch_too_weak_for_the_weight_lets_go() {
    let border = border(|scene| {
        scene["objects"][2]["material"]["friction"] = json!(0.005);
    });
    assert!(border < 0.3, "{border}");
}
