//! A mannequin as binary glTF: skin, skeleton, weights, and a clip of motion.

use crate::FormatError;
use crate::gltf::container;
use serde_json::{Value, json};
use toile_body::{Clip, Joint, Mannequin};
use toile_geometry::Vec3;

/// Largest number of joints that move one vertex; every viewer supports this number. Of more joints, those with
/// the largest weights are kept.
const JOINTS: usize = 4;

/// Component type of unsigned bytes in the glTF standard.
const BYTE: u32 = 5121;
/// Component type of unsigned 32-bit integers.
const INTEGER: u32 = 5125;
/// Component type of `f32`.
const FLOAT: u32 = 5126;
/// Buffer target of vertex attributes.
const VERTICES: u32 = 34962;
/// Buffer target of the vertex indices of triangles.
const CORNERS: u32 = 34963;

/// The binary data of a glTF file being written, with the views and accessors that describe them.
#[derive(Default)]
pub(crate) struct Binary {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Binary {
    /// Adds an accessor with a buffer view of its own; returns its index.
    pub fn add(&mut self, data: &[u8], accessor: Value, target: Option<u32>) -> usize {
        let mut view =
            json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": data.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend(data);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut accessor = accessor;
        accessor["bufferView"] = json!(self.views.len());
        self.views.push(view);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds rows of floats with their minimum and maximum; `vertices` tells whether they are vertex attributes.
    pub fn floats<const N: usize>(
        &mut self,
        rows: &[[f32; N]],
        kind: &str,
        vertices: bool,
    ) -> usize {
        let bound = |pick: fn(f32, f32) -> f32, start: f32| -> Vec<f32> {
            (0..N)
                .map(|k| rows.iter().map(|row| row[k]).fold(start, pick))
                .collect()
        };
        let accessor = json!({
            "componentType": FLOAT, "count": rows.len(), "type": kind,
            "min": bound(f32::min, f32::INFINITY), "max": bound(f32::max, f32::NEG_INFINITY),
        });
        let data: Vec<u8> = rows
            .iter()
            .flatten()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        self.add(&data, accessor, vertices.then_some(VERTICES))
    }
}

fn single(p: Vec3) -> [f32; 3] {
    [p.x as f32, p.y as f32, p.z as f32]
}

/// Writes a mannequin at rest as GLB, with its skeleton by H-Anim names and, if given, a named clip of
/// motion. Metres, Y up, facing +Z. glTF blends joints linearly, while [`Mannequin::posed_skin`] blends dual
/// quaternions: strongly bent joints look thinner in glTF.
///
/// # Errors
/// The file would be larger than 4 GiB.
pub fn write_body_glb(
    body: &Mannequin,
    clip: Option<(&str, &Clip)>,
) -> Result<Vec<u8>, FormatError> {
    let mut binary = Binary::default();
    let attributes = attributes(body, &mut binary);
    let triangles = &body.skin().triangles;
    let data: Vec<u8> = triangles
        .iter()
        .flatten()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let accessor =
        json!({ "componentType": INTEGER, "count": 3 * triangles.len(), "type": "SCALAR" });
    let indices = binary.add(&data, accessor, Some(CORNERS));
    let skeleton = body.skeleton();
    let binds: Vec<[f32; 16]> = Joint::ALL
        .iter()
        .map(|&joint| {
            let [x, y, z] = single(-skeleton.centre(joint));
            [
                1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0,
            ]
        })
        .collect();
    let binds = binary.floats(&binds, "MAT4", false);
    let mut nodes: Vec<Value> = Joint::ALL
        .iter()
        .map(|&joint| {
            let children: Vec<usize> = Joint::ALL
                .iter()
                .filter(|child| child.parent() == Some(joint))
                .map(|&child| child as usize)
                .collect();
            let mut node = json!({
                "name": joint.name(),
                "translation": single(skeleton.offset(joint)),
            });
            if !children.is_empty() {
                node["children"] = json!(children);
            }
            node
        })
        .collect();
    nodes.push(json!({ "name": "mannequin", "mesh": 0, "skin": 0 }));
    let joints: Vec<usize> = (0..Joint::COUNT).collect();
    let mut root = json!({
        "asset": { "version": "2.0", "generator": "Toile" },
        "scene": 0,
        "scenes": [{ "nodes": [Joint::HumanoidRoot as usize, Joint::COUNT] }],
        "meshes": [{ "name": "mannequin", "primitives": [
            { "attributes": attributes, "indices": indices, "material": 0 }] }],
        "materials": [{ "name": "skin", "pbrMetallicRoughness": {
            "baseColorFactor": [0.62, 0.58, 0.55, 1.0], "metallicFactor": 0.0,
            "roughnessFactor": 0.9 } }],
        "skins": [{ "joints": joints, "inverseBindMatrices": binds,
            "skeleton": Joint::HumanoidRoot as usize }],
    });
    root["nodes"] = Value::Array(nodes);
    if let Some((name, motion)) = clip.filter(|clip| !clip.1.poses.is_empty()) {
        root["animations"] = json!([animation(body, name, motion, &mut binary)]);
    }
    root["bufferViews"] = Value::Array(binary.views);
    root["accessors"] = Value::Array(binary.accessors);
    root["buffers"] = json!([{ "byteLength": binary.bytes.len() }]);
    container(root.to_string().into_bytes(), binary.bytes)
}

/// Positions, normals, joints and weights of the skin's vertices.
fn attributes(body: &Mannequin, binary: &mut Binary) -> Value {
    let skin = body.skin();
    let positions: Vec<[f32; 3]> = skin.positions.iter().map(|&p| single(p)).collect();
    let normals: Vec<[f32; 3]> = skin
        .vertex_normals()
        .iter()
        .map(|n| single(n.try_normalize(0.0).unwrap_or(Vec3::y())))
        .collect();
    let mut joints: Vec<u8> = Vec::with_capacity(JOINTS * positions.len());
    let mut weights: Vec<[f32; JOINTS]> = Vec::with_capacity(positions.len());
    for vertex in 0..positions.len() {
        let mut shares = body.shares(vertex).to_vec();
        shares.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        shares.truncate(JOINTS);
        let sum: f64 = shares.iter().map(|share| share.1).sum();
        let mut row = [0.0; JOINTS];
        for (k, weight) in row.iter_mut().enumerate() {
            let share = shares.get(k);
            joints.push(share.map_or(0, |share| share.0 as u8));
            *weight = share.map_or(0.0, |share| (share.1 / sum) as f32);
        }
        weights.push(row);
    }
    let accessor = json!({ "componentType": BYTE, "count": positions.len(), "type": "VEC4" });
    json!({
        "POSITION": binary.floats(&positions, "VEC3", true),
        "NORMAL": binary.floats(&normals, "VEC3", true),
        "JOINTS_0": binary.add(&joints, accessor, Some(VERTICES)),
        "WEIGHTS_0": binary.floats(&weights, "VEC4", true),
    })
}

/// The rotations of all joints and the path of the root over time; the first pose of a loop is repeated at its
/// end.
fn animation(body: &Mannequin, name: &str, motion: &Clip, binary: &mut Binary) -> Value {
    let skeleton = body.skeleton();
    let count = motion.poses.len() + usize::from(motion.is_loop);
    let pose = |k: usize| &motion.poses[k % motion.poses.len()];
    let times: Vec<[f32; 1]> = (0..count)
        .map(|k| [(k as f64 * motion.step) as f32])
        .collect();
    let input = binary.floats(&times, "SCALAR", false);
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    let mut add = |output: usize, joint: Joint, path: &str| {
        channels.push(json!({ "sampler": samplers.len(),
            "target": { "node": joint as usize, "path": path } }));
        samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
    };
    for joint in Joint::ALL {
        let turns: Vec<[f32; 4]> = (0..count)
            .map(|k| {
                let q = pose(k).rotation(joint);
                [q.i as f32, q.j as f32, q.k as f32, q.w as f32]
            })
            .collect();
        add(binary.floats(&turns, "VEC4", false), joint, "rotation");
    }
    let root = Joint::HumanoidRoot;
    let ways: Vec<[f32; 3]> = (0..count)
        .map(|k| single(skeleton.offset(root) + pose(k).shift * skeleton.leg_length()))
        .collect();
    add(binary.floats(&ways, "VEC3", false), root, "translation");
    json!({ "name": name, "channels": channels, "samplers": samplers })
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_body::Figure;

    #[test]
    fn a_walking_body_reads_back_with_skeleton_weights_and_clip() {
        let body = Mannequin::new(&Figure::Woman.average(), Figure::Woman).unwrap();
        let walk = Clip::walk(body.skeleton());
        let glb = write_body_glb(&body, Some(("walk", &walk))).unwrap();
        let file = gltf::Gltf::from_slice(&glb).unwrap();
        let blob = file.blob.clone().unwrap();
        let skin = file.skins().next().unwrap();
        assert_eq!(skin.joints().count(), Joint::COUNT);
        let names: Vec<_> = skin
            .joints()
            .map(|j| j.name().unwrap().to_owned())
            .collect();
        assert_eq!(names[0], "HumanoidRoot");
        let mesh = file.meshes().next().unwrap();
        let part = mesh.primitives().next().unwrap();
        let reader = part.reader(|_| Some(&blob));
        let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        assert_eq!(positions.len(), body.skin().positions.len());
        for weights in reader.read_weights(0).unwrap().into_f32() {
            assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
        }
        let clip = file.animations().next().unwrap();
        assert_eq!(clip.channels().count(), Joint::COUNT + 1);
        // The joints stand at the skeleton's positions.
        let binds = skin
            .reader(|_| Some(&blob))
            .read_inverse_bind_matrices()
            .unwrap();
        for (joint, matrix) in Joint::ALL.into_iter().zip(binds) {
            let centre = body.skeleton().centre(joint);
            for k in 0..3 {
                assert!((f64::from(matrix[3][k]) + centre[k]).abs() < 1e-6);
            }
        }
        let times: Vec<f32> = clip
            .channels()
            .next()
            .unwrap()
            .reader(|_| Some(&blob))
            .read_inputs()
            .unwrap()
            .collect();
        assert_eq!(times.len(), walk.poses.len() + 1);
        assert!(write_body_glb(&body, None).unwrap().len() < glb.len());
    }
}
