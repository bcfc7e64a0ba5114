//! Wavefront OBJ: triangle meshes with groups, texture coordinates and normals, and their writer.

use crate::FormatError;
use std::fmt::Write;
use std::ops::Range;
use toile_geometry::{TriangleMesh, Vec2, Vec3};

/// A mesh as an OBJ file holds it. Positions, texture coordinates and normals are indexed separately, so that
/// the panels of a welded garment keep their own texture coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjMesh {
    /// Vertex positions (m).
    pub positions: Vec<Vec3>,
    /// Vertex indices of each triangle, into `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// Positions in the panel's plane (m), y up; may be empty.
    pub texture: Vec<Vec2>,
    /// Indices of each triangle's corners into `texture`: one entry per triangle, or an empty list.
    pub texture_triangles: Vec<[u32; 3]>,
    /// Unit normals; may be empty.
    pub normals: Vec<Vec3>,
    /// Indices of each triangle's corners into `normals`: one entry per triangle, or an empty list.
    pub normal_triangles: Vec<[u32; 3]>,
    /// Named ranges of triangles, in order.
    pub groups: Vec<ObjGroup>,
}

/// A named range of triangles.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ObjGroup {
    /// Name of the group or object.
    pub name: String,
    /// Range of triangles.
    pub triangles: Range<usize>,
}

impl ObjMesh {
    /// The positions and triangles without texture coordinates and normals.
    pub fn into_triangle_mesh(self) -> TriangleMesh {
        TriangleMesh {
            positions: self.positions,
            triangles: self.triangles,
        }
    }

    /// Refuses a mesh that cannot be written, with its first fault.
    fn check(&self) -> Result<(), FormatError> {
        let finite = self
            .positions
            .iter()
            .all(|p| p.iter().all(|x| x.is_finite()))
            && self.texture.iter().all(|p| p.iter().all(|x| x.is_finite()))
            && self.normals.iter().all(|p| p.iter().all(|x| x.is_finite()));
        if !finite {
            return Err(FormatError::new(
                "mesh",
                "a coordinate is not a finite number",
                "run the drape again with a smaller step",
            ));
        }
        let lists = [
            ("positions", &self.triangles, self.positions.len(), true),
            (
                "texture",
                &self.texture_triangles,
                self.texture.len(),
                false,
            ),
            ("normals", &self.normal_triangles, self.normals.len(), false),
        ];
        for (name, triangles, count, required) in lists {
            let complete = triangles.len() == self.triangles.len();
            if !complete && (required || !triangles.is_empty()) {
                return Err(FormatError::new(
                    name,
                    format!(
                        "{} corners for {} triangles",
                        triangles.len(),
                        self.triangles.len()
                    ),
                    "give one entry a triangle or none",
                ));
            }
            if let Some(at) = triangles.iter().flatten().find(|&&v| v as usize >= count) {
                return Err(FormatError::new(
                    name,
                    format!("a triangle names entry {at}, but there are only {count}"),
                    "rebuild the mesh",
                ));
            }
        }
        if let Some(group) = self
            .groups
            .iter()
            .find(|g| g.triangles.start > g.triangles.end || g.triangles.end > self.triangles.len())
        {
            return Err(FormatError::new(
                format!("group {:?}", group.name),
                "its triangles are not all there",
                "rebuild the mesh",
            ));
        }
        Ok(())
    }
}

impl From<TriangleMesh> for ObjMesh {
    fn from(mesh: TriangleMesh) -> Self {
        Self {
            positions: mesh.positions,
            triangles: mesh.triangles,
            ..Self::default()
        }
    }
}

/// Writes a mesh as OBJ text in metres, Y up, with nine decimals (a nanometre) and one `g` statement per
/// group. The same mesh always gives the same text.
///
/// # Errors
/// A coordinate is not finite or an index is out of range.
pub fn write_obj(mesh: &ObjMesh) -> Result<String, FormatError> {
    mesh.check()?;
    let mut text = String::with_capacity(64 * (mesh.positions.len() + mesh.triangles.len()) + 64);
    text.push_str("# Toile, metres, Y up\n");
    for p in &mesh.positions {
        numbers(&mut text, "v", p.as_slice());
    }
    for p in &mesh.texture {
        numbers(&mut text, "vt", p.as_slice());
    }
    for p in &mesh.normals {
        numbers(&mut text, "vn", p.as_slice());
    }
    let mut next = 0;
    for group in &mesh.groups {
        faces(&mut text, mesh, next..group.triangles.start.max(next));
        let _ = writeln!(text, "g {}", one_line(&group.name));
        faces(
            &mut text,
            mesh,
            group.triangles.start.max(next)..group.triangles.end,
        );
        next = next.max(group.triangles.end);
    }
    faces(&mut text, mesh, next..mesh.triangles.len());
    Ok(text)
}

fn numbers(text: &mut String, keyword: &str, values: &[f64]) {
    text.push_str(keyword);
    for &value in values {
        // A value that rounds to zero is written without a minus sign.
        let value = if value.abs() < 0.5e-9 { 0.0 } else { value };
        let _ = write!(text, " {value:.9}");
    }
    text.push('\n');
}

fn faces(text: &mut String, mesh: &ObjMesh, triangles: Range<usize>) {
    for t in triangles {
        text.push('f');
        for k in 0..3 {
            let v = mesh.triangles[t][k] + 1;
            let vt = mesh.texture_triangles.get(t).map(|c| c[k] + 1);
            let vn = mesh.normal_triangles.get(t).map(|c| c[k] + 1);
            let _ = match (vt, vn) {
                (None, None) => write!(text, " {v}"),
                (Some(vt), None) => write!(text, " {v}/{vt}"),
                (None, Some(vn)) => write!(text, " {v}//{vn}"),
                (Some(vt), Some(vn)) => write!(text, " {v}/{vt}/{vn}"),
            };
        }
        text.push('\n');
    }
}

/// The name with control characters and backslashes replaced: a line break would start a new statement, and a
/// backslash at the end would continue the line.
fn one_line(name: &str) -> String {
    let clean: String = name
        .chars()
        .map(|c| if c.is_control() || c == '\\' { '_' } else { c })
        .collect();
    let clean = clean.trim();
    if clean.is_empty() {
        "unnamed".into()
    } else {
        clean.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_obj;
    use proptest::prelude::*;

    #[test]
    fn a_grid_of_a_hundred_thousand_vertices_comes_back() {
        let side = 317_u32;
        let mut mesh = ObjMesh::default();
        for j in 0..side {
            for i in 0..side {
                let (x, y) = (f64::from(i) * 0.01, f64::from(j) * 0.01);
                mesh.positions.push(Vec3::new(x, y, (x * y).sin()));
            }
        }
        for j in 0..side - 1 {
            for i in 0..side - 1 {
                let a = j * side + i;
                mesh.triangles.push([a, a + 1, a + side]);
                mesh.triangles.push([a + 1, a + side + 1, a + side]);
            }
        }
        let back = read_obj(write_obj(&mesh).unwrap().as_bytes()).unwrap();
        assert_eq!(back.triangles, mesh.triangles);
        for (a, b) in back.positions.iter().zip(&mesh.positions) {
            assert!((a - b).norm() < 1e-9);
        }
    }

    #[test]
    fn writing_refuses_what_cannot_be_read_back() {
        let mut mesh = read_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").unwrap();
        mesh.texture_triangles = vec![[0, 1, 2]];
        assert!(write_obj(&mesh).unwrap_err().what.contains("only 0"));
        mesh.texture_triangles.clear();
        mesh.positions[0].x = f64::NAN;
        assert!(write_obj(&mesh).unwrap_err().what.contains("finite"));
        mesh.positions[0].x = 0.0;
        mesh.groups = vec![ObjGroup {
            name: "a".into(),
            triangles: 0..2,
        }];
        assert!(write_obj(&mesh).unwrap_err().place.contains("group"));
    }

    #[test]
    fn names_with_line_ends_stay_names() {
        let mut mesh = read_obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").unwrap();
        mesh.groups = vec![ObjGroup {
            name: "a\nf 9 9 9\\".into(),
            triangles: 0..1,
        }];
        let text = write_obj(&mesh).unwrap();
        assert_eq!(
            read_obj(text.as_bytes()).unwrap().groups[0].name,
            "a_f 9 9 9_"
        );
    }

    /// A fan of triangles round vertex 0, with every property that an OBJ file can hold.
    fn mesh_of(points: Vec<(f64, f64, f64)>) -> ObjMesh {
        let count = points.len() as u32;
        let triangles: Vec<[u32; 3]> = (1..count - 1).map(|k| [0, k, k + 1]).collect();
        let half = triangles.len() / 2;
        let mut groups = vec![ObjGroup {
            name: "first".into(),
            triangles: 0..half,
        }];
        groups.push(ObjGroup {
            name: "second half".into(),
            triangles: half..triangles.len(),
        });
        groups.retain(|g| !g.triangles.is_empty());
        ObjMesh {
            positions: points.iter().map(|&(x, y, z)| Vec3::new(x, y, z)).collect(),
            texture: points.iter().map(|&(x, y, _)| Vec2::new(x, y)).collect(),
            normals: vec![Vec3::z()],
            texture_triangles: triangles.clone(),
            normal_triangles: vec![[0; 3]; triangles.len()],
            triangles,
            groups,
        }
    }

    proptest! {
        #[test]
        fn what_is_written_is_read(
            points in prop::collection::vec((-1e3..1e3, -1e3..1e3, -1e3..1e3), 3..40)
        ) {
            let mesh = mesh_of(points);
            let text = write_obj(&mesh).unwrap();
            let back = read_obj(text.as_bytes()).unwrap();
            prop_assert_eq!(&back.triangles, &mesh.triangles);
            prop_assert_eq!(&back.groups, &mesh.groups);
            prop_assert_eq!(&back.normal_triangles, &mesh.normal_triangles);
            for (a, b) in back.positions.iter().zip(&mesh.positions) {
                prop_assert!((a - b).norm() < 1e-9);
            }
            prop_assert_eq!(write_obj(&back).unwrap(), text);
        }

        #[test]
        fn damaged_files_never_panic(
            at in 0.0..1.0_f64, junk in prop::collection::vec(any::<u8>(), 0..6)
        ) {
            let points = (0..12).map(|k| (f64::from(k), f64::from(k * k), 0.5)).collect();
            let mut bytes = write_obj(&mesh_of(points)).unwrap().into_bytes();
            let start = (at * bytes.len() as f64) as usize;
            let end = (start + junk.len()).min(bytes.len());
            bytes.splice(start..end, junk);
            if let Ok(mesh) = read_obj(&bytes) {
                prop_assert!(mesh.check().is_ok());
            }
        }

        #[test]
        fn any_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            if let Ok(mesh) = read_obj(&bytes) {
                prop_assert!(mesh.check().is_ok());
            }
        }
    }
}
