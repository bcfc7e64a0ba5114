//! glTF 2.0 in its binary form (GLB), written through `gltf-json`.

use crate::FormatError;
use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::buffer::{Target, View};
use gltf_json::material::{PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Accessor, Buffer, Index, Material, Mesh, Node, Root, Scene, Value};
use std::collections::BTreeMap;
use toile_geometry::Vec3;

/// Separate meshes in one scene. Metres, Y up.
#[derive(Clone, Debug, Default)]
pub struct GlbScene {
    /// The meshes, each written as one node, in order.
    pub meshes: Vec<GlbMesh>,
}

/// One object, such as a garment or a mannequin.
#[derive(Clone, Debug, Default)]
pub struct GlbMesh {
    /// Name of the node and of the mesh.
    pub name: String,
    /// The parts of the mesh; a garment has one part per panel.
    pub primitives: Vec<GlbPrimitive>,
}

/// One part of a mesh with its own vertices and its own material, which carries the part's name.
#[derive(Clone, Debug, Default)]
pub struct GlbPrimitive {
    /// Name of the material, since a glTF primitive has no name.
    pub name: String,
    /// Vertex positions (m).
    pub positions: Vec<Vec3>,
    /// A normal for each vertex, of any length; a zero vector is written as +Y.
    pub normals: Vec<Vec3>,
    /// Position of each vertex in the pattern plane (m), y up.
    pub uvs: Option<Vec<[f64; 2]>>,
    /// Vertex indices of each triangle, counter-clockwise seen from the right side.
    pub triangles: Vec<[u32; 3]>,
    /// Base colour, sRGB 0..=1.
    pub colour: [f64; 3],
}

/// If a coordinate of a pattern position is larger than this in magnitude (m), its part is moved towards the
/// origin along that axis before rounding to `f32`. Up to this magnitude the rounding is at most 6e-8 m, so
/// that a distance between two positions is exact to 1.7e-7 m.
const CENTRED_WITHIN: f64 = 2.0;

/// Writes a scene as GLB.
///
/// Texture coordinates are the pattern plane in metres: `u = x`, `v = -y`, since v points down in glTF;
/// distances between them are rest lengths. A primitive that reaches farther than 2 m from the origin is first
/// moved towards it by whole metres. A texture that repeats in a whole fraction of a metre looks the same then.
/// Materials are rough, two-sided, and have the given base colour.
///
/// # Errors
/// An empty primitive, lists of different lengths, a coordinate that is not finite in `f32`, an index out of
/// range, or more than 4 GiB.
pub fn write_glb(scene: &GlbScene) -> Result<Vec<u8>, FormatError> {
    let mut writer = Writer::default();
    for mesh in &scene.meshes {
        writer.mesh(mesh)?;
    }
    writer.finish()
}

#[derive(Default)]
struct Writer {
    root: Root,
    bytes: Vec<u8>,
}

impl Writer {
    fn mesh(&mut self, mesh: &GlbMesh) -> Result<(), FormatError> {
        let mut primitives = Vec::with_capacity(mesh.primitives.len());
        for primitive in &mesh.primitives {
            check(primitive).map_err(|what| {
                FormatError::new(
                    format!("mesh {:?}, part {:?}", mesh.name, primitive.name),
                    what,
                    "mesh the pattern again, and drape it with a smaller step",
                )
            })?;
            primitives.push(self.primitive(primitive));
        }
        if primitives.is_empty() {
            return Err(FormatError::new(
                format!("mesh {:?}", mesh.name),
                "it has no parts",
                "leave it out",
            ));
        }
        let index = self.root.push(Mesh {
            extensions: None,
            extras: Default::default(),
            name: Some(mesh.name.clone()),
            primitives,
            weights: None,
        });
        self.root.push(Node {
            mesh: Some(index),
            name: Some(mesh.name.clone()),
            ..Node::default()
        });
        Ok(())
    }

    fn primitive(&mut self, part: &GlbPrimitive) -> Primitive {
        let positions: Vec<[f32; 3]> = part.positions.iter().map(|p| single(*p)).collect();
        let normals: Vec<[f32; 3]> = part
            .normals
            .iter()
            .map(|n| single(n.try_normalize(0.0).unwrap_or(Vec3::y())))
            .collect();
        let corners: Vec<[u32; 1]> = part.triangles.iter().flatten().map(|&v| [v]).collect();
        let mut attributes = BTreeMap::new();
        let index = self.floats(&positions, Type::Vec3);
        attributes.insert(Checked::Valid(Semantic::Positions), index);
        let index = self.floats(&normals, Type::Vec3);
        attributes.insert(Checked::Valid(Semantic::Normals), index);
        if let Some(uvs) = &part.uvs {
            let index = self.floats(&texture_coordinates(uvs), Type::Vec2);
            attributes.insert(Checked::Valid(Semantic::TexCoords(0)), index);
        }
        let indices = self.accessor(
            corners.iter().flatten().flat_map(|v| v.to_le_bytes()),
            (corners.len(), Type::Scalar, ComponentType::U32),
            Target::ElementArrayBuffer,
        );
        Primitive {
            attributes,
            extensions: None,
            extras: Default::default(),
            indices: Some(indices),
            material: Some(self.material(part)),
            mode: Checked::Valid(Mode::Triangles),
            targets: None,
        }
    }

    fn material(&mut self, part: &GlbPrimitive) -> Index<Material> {
        let [red, green, blue] = part.colour.map(|c| linear_from_srgb(c) as f32);
        self.root.push(Material {
            name: Some(part.name.clone()),
            double_sided: true,
            pbr_metallic_roughness: PbrMetallicRoughness {
                base_color_factor: PbrBaseColorFactor([red, green, blue, 1.0]),
                metallic_factor: StrengthFactor(0.0),
                roughness_factor: StrengthFactor(0.9),
                ..PbrMetallicRoughness::default()
            },
            ..Material::default()
        })
    }

    /// Writes a vertex attribute with its exact minimum and maximum.
    fn floats<const N: usize>(&mut self, values: &[[f32; N]], kind: Type) -> Index<Accessor> {
        let mut bounds = [[f32::INFINITY; N], [f32::NEG_INFINITY; N]];
        for value in values {
            for k in 0..N {
                bounds[0][k] = bounds[0][k].min(value[k]);
                bounds[1][k] = bounds[1][k].max(value[k]);
            }
        }
        let index = self.accessor(
            values.iter().flatten().flat_map(|x| x.to_le_bytes()),
            (values.len(), kind, ComponentType::F32),
            Target::ArrayBuffer,
        );
        let [low, high] = bounds.map(|b| Value::from(b.map(f64::from).to_vec()));
        let accessor = &mut self.root.accessors[index.value()];
        accessor.min = Some(low);
        accessor.max = Some(high);
        index
    }

    /// Appends the values with a buffer view of their own. Every component has four bytes, so each view
    /// starts at a multiple of four.
    fn accessor(
        &mut self,
        bytes: impl Iterator<Item = u8>,
        (count, kind, component): (usize, Type, ComponentType),
        target: Target,
    ) -> Index<Accessor> {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let view = self.root.push(View {
            buffer: Index::new(0),
            byte_length: USize64::from(self.bytes.len() - start),
            byte_offset: Some(USize64::from(start)),
            byte_stride: None,
            name: None,
            target: Some(Checked::Valid(target)),
            extensions: None,
            extras: Default::default(),
        });
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: USize64::from(count),
            component_type: Checked::Valid(GenericComponentType(component)),
            extensions: None,
            extras: Default::default(),
            type_: Checked::Valid(kind),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
        })
    }

    fn finish(mut self) -> Result<Vec<u8>, FormatError> {
        let nodes: Vec<Index<Node>> = (0..self.root.nodes.len() as u32).map(Index::new).collect();
        if !nodes.is_empty() {
            let scene = self.root.push(Scene {
                extensions: None,
                extras: Default::default(),
                name: None,
                nodes,
            });
            self.root.scene = Some(scene);
        }
        self.root.asset.generator = Some("Toile".into());
        if !self.bytes.is_empty() {
            self.root.push(Buffer {
                byte_length: USize64::from(self.bytes.len()),
                name: None,
                uri: None,
                extensions: None,
                extras: Default::default(),
            });
        }
        let text = gltf_json::serialize::to_vec(&self.root).map_err(|error| {
            FormatError::new("scene", error.to_string(), "shorten the names in it")
        })?;
        container(text, self.bytes)
    }
}

/// The GLB container: a header and two chunks, each padded to a multiple of four bytes.
pub(crate) fn container(mut text: Vec<u8>, mut data: Vec<u8>) -> Result<Vec<u8>, FormatError> {
    text.resize(text.len().next_multiple_of(4), b' ');
    data.resize(data.len().next_multiple_of(4), 0);
    let data_chunk = if data.is_empty() { 0 } else { 8 + data.len() };
    let total = 12 + 8 + text.len() + data_chunk;
    let size = u32::try_from(total).map_err(|_| {
        FormatError::new(
            "scene",
            format!("{total} bytes are more than the 4 GiB a GLB can hold"),
            "mesh with a longer edge",
        )
    })?;
    let mut glb = Vec::with_capacity(total);
    glb.extend(b"glTF");
    glb.extend(2_u32.to_le_bytes());
    glb.extend(size.to_le_bytes());
    glb.extend((text.len() as u32).to_le_bytes());
    glb.extend(b"JSON");
    glb.extend(text);
    if !data.is_empty() {
        glb.extend((data.len() as u32).to_le_bytes());
        glb.extend(b"BIN\0");
        glb.extend(data);
    }
    Ok(glb)
}

fn check(part: &GlbPrimitive) -> Result<(), String> {
    let count = part.positions.len();
    if count == 0 || part.triangles.is_empty() {
        return Err("it has no triangles".into());
    }
    if part.normals.len() != count {
        return Err(format!(
            "{} normals for {count} vertices",
            part.normals.len()
        ));
    }
    if let Some(uvs) = &part.uvs
        && uvs.len() != count
    {
        return Err(format!(
            "{} texture coordinates for {count} vertices",
            uvs.len()
        ));
    }
    let fits = |x: &f64| (*x as f32).is_finite();
    let vertex = (0..count).find(|&v| {
        !(part.positions[v].iter().all(fits)
            && part.normals[v].iter().all(fits)
            && part.uvs.as_ref().is_none_or(|uvs| uvs[v].iter().all(fits)))
    });
    if let Some(vertex) = vertex {
        return Err(format!(
            "vertex {vertex} has a coordinate that is not finite"
        ));
    }
    if !part.colour.iter().all(|c| (0.0..=1.0).contains(c)) {
        return Err("the colour is not between 0 and 1".into());
    }
    match part
        .triangles
        .iter()
        .flatten()
        .find(|&&v| v as usize >= count)
    {
        Some(v) => Err(format!(
            "a triangle names vertex {v}, but there are only {count}"
        )),
        None => Ok(()),
    }
}

fn single(p: Vec3) -> [f32; 3] {
    [p.x as f32, p.y as f32, p.z as f32]
}

fn texture_coordinates(uvs: &[[f64; 2]]) -> Vec<[f32; 2]> {
    let shift = [0, 1].map(|k| {
        let low = uvs.iter().map(|uv| uv[k]).fold(f64::INFINITY, f64::min);
        let high = uvs.iter().map(|uv| uv[k]).fold(f64::NEG_INFINITY, f64::max);
        if low.abs().max(high.abs()) > CENTRED_WITHIN {
            (0.5 * (low + high)).round()
        } else {
            0.0
        }
    });
    uvs.iter()
        .map(|uv| [(uv[0] - shift[0]) as f32, (shift[1] - uv[1]) as f32])
        .collect()
}

/// Linear value of an sRGB component (IEC 61966-2-1:1999).
fn linear_from_srgb(c: f64) -> f64 {
    if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A square of cloth with its lower left corner at `corner` in the pattern plane.
    fn panel(name: &str, corner: [f64; 2], side: f64) -> GlbPrimitive {
        let square = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
        GlbPrimitive {
            name: name.into(),
            positions: square.map(|[x, y]| Vec3::new(x, y, 0.1 * x)).to_vec(),
            normals: vec![
                Vec3::new(0.0, 0.0, 2.0),
                Vec3::zeros(),
                Vec3::x(),
                Vec3::z(),
            ],
            uvs: Some(square.map(|[x, y]| [corner[0] + x, corner[1] + y]).to_vec()),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            colour: [1.0, 0.5, 0.0],
        }
    }

    fn scene() -> GlbScene {
        let mut body = panel("skin", [0.0, 0.0], 1.0);
        body.uvs = None;
        GlbScene {
            meshes: vec![
                GlbMesh {
                    name: "T-shirt".into(),
                    primitives: vec![
                        panel("front", [0.0, 0.0], 0.5),
                        panel("back", [0.7, -0.2], 0.6),
                    ],
                },
                GlbMesh {
                    name: "mannequin".into(),
                    primitives: vec![body],
                },
            ],
        }
    }

    #[test]
    fn comes_back_through_the_gltf_crate() {
        let glb = write_glb(&scene()).unwrap();
        assert_eq!(glb.len() % 4, 0);
        // `from_slice` validates the document: types, targets, bounds of the position accessor.
        let file = gltf::Gltf::from_slice(&glb).unwrap();
        let blob = file.blob.as_deref().unwrap();
        assert_eq!(file.default_scene().unwrap().nodes().len(), 2);
        let names: Vec<_> = file.nodes().map(|n| n.name().unwrap().to_owned()).collect();
        assert_eq!(names, ["T-shirt", "mannequin"]);
        let shirt = file.meshes().next().unwrap();
        let materials: Vec<_> = shirt
            .primitives()
            .map(|p| p.material().name().unwrap().to_owned())
            .collect();
        assert_eq!(materials, ["front", "back"]);
        let front = shirt.primitives().next().unwrap();
        let reader = front.reader(|_| Some(blob));
        let positions: Vec<_> = reader.read_positions().unwrap().collect();
        assert_eq!(positions[2], [0.5, 0.5, 0.05]);
        let normals: Vec<_> = reader.read_normals().unwrap().collect();
        assert_eq!(
            normals,
            [
                [0.0, 0.0, 1.0],
                [0.0, 1.0, 0.0],
                [1.0, 0.0, 0.0],
                [0.0, 0.0, 1.0]
            ]
        );
        let indices: Vec<_> = reader.read_indices().unwrap().into_u32().collect();
        assert_eq!(indices, [0, 1, 2, 0, 2, 3]);
        let box_ = front.bounding_box();
        assert_eq!((box_.min, box_.max), ([0.0; 3], [0.5, 0.5, 0.05]));
        let colour = front
            .material()
            .pbr_metallic_roughness()
            .base_color_factor();
        assert!((colour[1] - 0.214_04).abs() < 1e-4, "{colour:?}");
        assert!(front.material().double_sided());
        let skin = file.meshes().nth(1).unwrap().primitives().next().unwrap();
        assert!(skin.reader(|_| Some(blob)).read_tex_coords(0).is_none());
    }

    #[test]
    fn views_are_aligned_and_have_targets() {
        let glb = write_glb(&scene()).unwrap();
        let file = gltf::Gltf::from_slice(&glb).unwrap();
        let mut end = 0;
        for view in file.views() {
            assert_eq!(view.offset(), end, "views follow one another");
            assert_eq!(view.offset() % 4, 0);
            assert!(view.target().is_some());
            end = view.offset() + view.length();
        }
        assert_eq!(file.blob.as_ref().unwrap().len(), end);
    }

    #[test]
    fn v_points_down_and_keeps_the_place() {
        let glb = write_glb(&scene()).unwrap();
        let file = gltf::Gltf::from_slice(&glb).unwrap();
        let back = file.meshes().next().unwrap().primitives().nth(1).unwrap();
        let blob = file.blob.as_deref().unwrap();
        let uvs: Vec<_> = back
            .reader(|_| Some(blob))
            .read_tex_coords(0)
            .unwrap()
            .into_f32()
            .collect();
        assert_eq!(uvs[0], [0.7, 0.2]);
        assert_eq!(uvs[2], [1.3, -0.4]);
    }

    #[test]
    fn an_empty_scene_is_a_valid_file() {
        let glb = write_glb(&GlbScene::default()).unwrap();
        assert_eq!(gltf::Gltf::from_slice(&glb).unwrap().nodes().len(), 0);
    }

    #[test]
    fn refusals_name_the_part() {
        type Damage = fn(&mut GlbPrimitive);
        let cases: [(Damage, &str); 7] = [
            (|p| p.triangles.clear(), "no triangles"),
            (|p| p.normals.truncate(1), "1 normals for 4"),
            (|p| p.uvs = Some(vec![]), "0 texture coordinates for 4"),
            (|p| p.positions[1].x = f64::NAN, "vertex 1"),
            (|p| p.positions[1].x = 1e300, "vertex 1"),
            (|p| p.triangles[0][0] = 4, "vertex 4, but there are only 4"),
            (|p| p.colour[0] = f64::NAN, "colour"),
        ];
        for (damage, expected) in cases {
            let mut scene = scene();
            damage(&mut scene.meshes[0].primitives[1]);
            let error = write_glb(&scene).unwrap_err().to_string();
            assert!(
                error.contains("\"back\"") && error.contains(expected),
                "{error}"
            );
        }
        let empty = GlbScene {
            meshes: vec![GlbMesh::default()],
        };
        assert!(write_glb(&empty).unwrap_err().what.contains("no parts"));
    }

    proptest! {
        /// Distances between texture coordinates are rest lengths, wherever the panel lies in the pattern
        /// plane.
        #[test]
        fn texture_distances_are_rest_lengths(
            corner in (-1e4..1e4, -1e4..1e4), side in 0.001..2.5_f64
        ) {
            let part = panel("p", [corner.0, corner.1], side);
            let flat = part.uvs.clone().unwrap();
            let scene = GlbScene {
                meshes: vec![GlbMesh { name: "m".into(), primitives: vec![part] }],
            };
            let glb = write_glb(&scene).unwrap();
            let file = gltf::Gltf::from_slice(&glb).unwrap();
            let blob = file.blob.as_deref().unwrap();
            let part = file.meshes().next().unwrap().primitives().next().unwrap();
            let uvs: Vec<[f32; 2]> =
                part.reader(|_| Some(blob)).read_tex_coords(0).unwrap().into_f32().collect();
            for a in 0..4 {
                for b in 0..a {
                    let got = (f64::from(uvs[a][0]) - f64::from(uvs[b][0]))
                        .hypot(f64::from(uvs[a][1]) - f64::from(uvs[b][1]));
                    let rest = (flat[a][0] - flat[b][0]).hypot(flat[a][1] - flat[b][1]);
                    prop_assert!((got - rest).abs() < 1e-6, "{got} {rest}");
                }
            }
        }
    }
}
