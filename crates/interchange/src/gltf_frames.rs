//! Recorded frames as binary glTF: each frame after the first is a morph target, and an animation goes from one to the
//! next.

use crate::FormatError;
use crate::gltf::container;
use crate::gltf_body::Binary;
use serde_json::{Value, json};
use toile_geometry::{TriangleMesh, Vec3};

/// A surface over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MovingGlbMesh {
    /// Name of the surface.
    pub name: String,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Positions in each frame (m); a single list for a surface that does not move.
    pub frames: Vec<Vec<[f32; 3]>>,
    /// Base colour, linear 0..=1.
    pub colour: [f32; 3],
}

/// Component type of unsigned 32-bit integers in the glTF standard.
const INTEGER: u32 = 5125;
/// Buffer target of the vertex indices of triangles in the glTF standard.
const CORNERS: u32 = 34963;

/// Writes surfaces as GLB that all move at the given times (s). Metres, Y up. The animation starts at 0 and
/// interpolates linearly between frames. Some viewers show at most 64 morph targets.
///
/// # Errors
/// A surface has neither one frame nor as many as there are times, frames with different numbers of vertices,
/// no triangles, or triangles of vertices that do not exist; or the file would be larger than 4 GiB.
pub fn write_frames_glb(meshes: &[MovingGlbMesh], times: &[f64]) -> Result<Vec<u8>, FormatError> {
    let mut binary = Binary::default();
    let start = times.first().copied().unwrap_or_default();
    let clock: Vec<[f32; 1]> = times.iter().map(|time| [(time - start) as f32]).collect();
    let clock = binary.floats(&clock, "SCALAR", false);
    let (mut written, mut nodes, mut materials) = (Vec::new(), Vec::new(), Vec::new());
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    for (number, mesh) in meshes.iter().enumerate() {
        check(mesh, times.len())?;
        written.push(
            json!({ "name": mesh.name, "primitives": [primitive(mesh, number, &mut binary)] }),
        );
        nodes.push(json!({ "name": mesh.name, "mesh": number }));
        let [red, green, blue] = mesh.colour;
        materials.push(json!({ "name": mesh.name, "doubleSided": true, "pbrMetallicRoughness": {
            "baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9 } }));
        let targets = mesh.frames.len() - 1;
        if targets == 0 {
            continue;
        }
        written[number]["weights"] = json!(vec![0.0; targets]);
        let weight = |frame: usize, target: usize| [f32::from(u8::from(frame == target + 1))];
        let frames = 0..=targets;
        let weights: Vec<[f32; 1]> = frames
            .flat_map(|frame| (0..targets).map(move |target| weight(frame, target)))
            .collect();
        let output = binary.floats(&weights, "SCALAR", false);
        channels.push(
            json!({ "sampler": samplers.len(), "target": { "node": number, "path": "weights" } }),
        );
        samplers.push(json!({ "input": clock, "output": output, "interpolation": "LINEAR" }));
    }
    let mut root = json!({
        "asset": { "version": "2.0", "generator": "Toile" },
        "scene": 0,
        "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
        "meshes": written,
        "nodes": nodes,
        "materials": materials,
    });
    if !channels.is_empty() {
        root["animations"] =
            json!([{ "name": "frames", "channels": channels, "samplers": samplers }]);
    }
    root["bufferViews"] = Value::Array(binary.views);
    root["accessors"] = Value::Array(binary.accessors);
    root["buffers"] = json!([{ "byteLength": binary.bytes.len() }]);
    container(root.to_string().into_bytes(), binary.bytes)
}

fn check(mesh: &MovingGlbMesh, times: usize) -> Result<(), FormatError> {
    let refuse = |what: String| {
        let place = format!("surface {:?}", mesh.name);
        Err(FormatError::new(place, what, "record the frames again"))
    };
    let frames = mesh.frames.len();
    if frames == 0 {
        return refuse("it has no frame".to_owned());
    }
    if frames != 1 && frames != times {
        return refuse(format!(
            "it has {frames} frames, but there are {times} times"
        ));
    }
    let count = mesh.frames[0].len();
    if mesh.frames.iter().any(|frame| frame.len() != count) {
        return refuse("its frames have different numbers of vertices".to_owned());
    }
    let corners = mesh.triangles.iter().flatten();
    match corners.into_iter().any(|&v| v as usize >= count) || mesh.triangles.is_empty() {
        true => refuse("it has no triangles, or vertices that are not there".to_owned()),
        false => Ok(()),
    }
}

/// The first frame as the base mesh, the others as morph targets: differences to the first.
fn primitive(mesh: &MovingGlbMesh, material: usize, binary: &mut Binary) -> Value {
    let first = &mesh.frames[0];
    let first_normals = normals(first, &mesh.triangles);
    let corners = mesh.triangles.iter().flatten();
    let data: Vec<u8> = corners.flat_map(|v| v.to_le_bytes()).collect();
    let accessor =
        json!({ "componentType": INTEGER, "count": 3 * mesh.triangles.len(), "type": "SCALAR" });
    let indices = binary.add(&data, accessor, Some(CORNERS));
    let mut primitive = json!({
        "attributes": {
            "POSITION": binary.floats(first, "VEC3", true),
            "NORMAL": binary.floats(&first_normals, "VEC3", true),
        },
        "indices": indices,
        "material": material,
    });
    let mut targets = Vec::with_capacity(mesh.frames.len() - 1);
    for frame in &mesh.frames[1..] {
        let positions = differences(frame, first);
        let normals = differences(&normals(frame, &mesh.triangles), &first_normals);
        targets.push(json!({
            "POSITION": binary.floats(&positions, "VEC3", true),
            "NORMAL": binary.floats(&normals, "VEC3", true),
        }));
    }
    if !targets.is_empty() {
        primitive["targets"] = Value::Array(targets);
    }
    primitive
}

fn differences(rows: &[[f32; 3]], from: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let pairs = rows.iter().zip(from);
    pairs
        .map(|(a, b)| [a[0] - b[0], a[1] - b[1], a[2] - b[2]])
        .collect()
}

/// Unit normals of the vertices; +Y for a vertex whose normal is a zero vector.
fn normals(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[f32; 3]> {
    let mesh = TriangleMesh {
        positions: positions
            .iter()
            .map(|p| Vec3::from(p.map(f64::from)))
            .collect(),
        triangles: triangles.to_vec(),
    };
    let unit = |normal: &Vec3| normal.try_normalize(0.0).unwrap_or(Vec3::y());
    let normals = mesh.vertex_normals();
    let single = |n: Vec3| [n.x as f32, n.y as f32, n.z as f32];
    normals.iter().map(|normal| single(unit(normal))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_library_reads_the_surface_of_each_frame() {
        let at = |y: f32| vec![[0.0, y, 0.0], [0.3, 0.25 * y, 0.0], [0.0, 1.0, 0.5]];
        let moving = MovingGlbMesh {
            name: "cloth".to_owned(),
            triangles: vec![[0, 1, 2]],
            frames: vec![at(0.0), at(0.5), at(-0.125)],
            colour: [0.5; 3],
        };
        let still = MovingGlbMesh {
            name: "plate".to_owned(),
            frames: vec![at(2.0)],
            ..moving.clone()
        };
        let times = [0.5, 0.75, 1.5];
        let bytes = write_frames_glb(&[moving.clone(), still], &times).unwrap();
        let document = gltf::Gltf::from_slice(&bytes).unwrap();
        let blob = document.blob.as_deref();
        let primitive = document
            .meshes()
            .next()
            .unwrap()
            .primitives()
            .next()
            .unwrap();
        let reader = primitive.reader(|_| blob);
        let base: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        let targets: Vec<Vec<[f32; 3]>> = reader
            .read_morph_targets()
            .map(|(positions, ..)| positions.unwrap().collect())
            .collect();
        let channel = document
            .animations()
            .next()
            .unwrap()
            .channels()
            .next()
            .unwrap();
        let reader = channel.reader(|_| blob);
        let clock: Vec<f32> = reader.read_inputs().unwrap().collect();
        assert_eq!(clock, [0.0, 0.25, 1.0]);
        let gltf::animation::util::ReadOutputs::MorphTargetWeights(weights) =
            reader.read_outputs().unwrap()
        else {
            panic!("it moves by weights");
        };
        let weights: Vec<f32> = weights.into_f32().collect();
        for (k, frame) in moving.frames.iter().enumerate() {
            let own = &weights[2 * k..2 * k + 2];
            for (v, expected) in frame.iter().enumerate() {
                for axis in 0..3 {
                    let moved = own[0] * targets[0][v][axis] + own[1] * targets[1][v][axis];
                    assert_eq!(base[v][axis] + moved, expected[axis]);
                }
            }
        }
        assert_eq!(document.meshes().count(), 2);
        let none = MovingGlbMesh {
            frames: Vec::new(),
            ..moving.clone()
        };
        assert!(write_frames_glb(&[moving], &times[..2]).is_err());
        assert!(write_frames_glb(&[none], &[]).is_err());
    }
}
