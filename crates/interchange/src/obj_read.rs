//! Reads Wavefront OBJ.

use crate::polygon::{distinct_corners, triangles_of};
use crate::{FormatError, ObjGroup, ObjMesh};
use std::ops::Range;
use toile_geometry::{Vec2, Vec3};

/// Reads OBJ text. Polygons of any shape are triangulated; materials, smoothing groups, lines and points are
/// skipped.
///
/// # Errors
/// With the line number: a number that is missing or not finite, an index out of range, a polygon with fewer
/// than three corners, without area or that crosses itself, free-form surfaces, an unknown keyword. Also a
/// file without any face.
pub fn read_obj(bytes: &[u8]) -> Result<ObjMesh, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let mut reader = Reader::default();
    let mut continued: Option<(usize, String)> = None;
    for (number, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        let (start, whole) = match continued.take() {
            Some((start, before)) => (start, Some(before + line)),
            None => (number + 1, None),
        };
        let whole = whole.as_deref().unwrap_or(line);
        match whole.strip_suffix('\\') {
            Some(before) => continued = Some((start, format!("{before} "))),
            None => reader.statement(whole, start)?,
        }
    }
    if let Some((start, whole)) = continued {
        reader.statement(&whole, start)?;
    }
    reader.finish()
}

/// One corner of a face: indices of position, texture coordinate and normal, from 0.
type Corner = [Option<u32>; 3];

const LIST_NAMES: [&str; 3] = ["position", "texture coordinate", "normal"];

#[derive(Default)]
struct Reader {
    mesh: ObjMesh,
    /// Corners of all faces, one after another.
    corners: Vec<Corner>,
    faces: Vec<Face>,
}

/// A polygon: its range of corners and its line in the file.
struct Face {
    corners: Range<usize>,
    line: usize,
}

impl Reader {
    fn statement(&mut self, line: &str, number: usize) -> Result<(), FormatError> {
        let mut words = line.split_ascii_whitespace();
        let Some(keyword) = words.next() else {
            return Ok(());
        };
        match keyword {
            "v" => {
                let [x, y, z] = coordinates(&mut words, number, "v x y z")?;
                self.mesh.positions.push(Vec3::new(x, y, z));
            }
            "vn" => {
                let [x, y, z] = coordinates(&mut words, number, "vn x y z")?;
                self.mesh.normals.push(Vec3::new(x, y, z));
            }
            "vt" => {
                let [u] = coordinates(&mut words, number, "vt u v")?;
                let v = match words.next() {
                    Some(word) => coordinate(word, number)?,
                    None => 0.0,
                };
                self.mesh.texture.push(Vec2::new(u, v));
            }
            "f" | "fo" => self.face(words, number)?,
            "g" | "o" => {
                let name = line[keyword.len()..].trim();
                self.group(if name.is_empty() { "unnamed" } else { name });
            }
            "usemtl" | "mtllib" | "usemap" | "maplib" | "s" | "mg" | "l" | "p" | "lod"
            | "bevel" | "c_interp" | "d_interp" | "shadow_obj" | "trace_obj" => {}
            "vp" | "cstype" | "deg" | "curv" | "curv2" | "surf" | "parm" | "trim" | "hole"
            | "end" | "bmat" | "step" | "scrv" | "sp" | "con" | "ctech" | "stech" => {
                return Err(at_line(
                    number,
                    format!("{keyword} belongs to a free-form surface"),
                    "export the model as polygons",
                ));
            }
            _ => {
                let shown: String = keyword.chars().take(20).collect();
                return Err(at_line(
                    number,
                    format!("unknown keyword {shown:?}"),
                    "check that this is an OBJ file, or remove the line",
                ));
            }
        }
        Ok(())
    }

    fn group(&mut self, name: &str) {
        let here = self.faces.len();
        if let Some(last) = self.mesh.groups.last_mut() {
            last.triangles.end = here;
            // Removes empty groups: "o front" followed by "g front", or a name without faces.
            if last.triangles.is_empty() {
                self.mesh.groups.pop();
            }
        }
        self.mesh.groups.push(ObjGroup {
            name: name.to_owned(),
            triangles: here..here,
        });
    }

    fn face<'a>(
        &mut self,
        words: impl Iterator<Item = &'a str>,
        number: usize,
    ) -> Result<(), FormatError> {
        let mut polygon = Vec::new();
        for word in words {
            polygon.push(self.corner(word, number)?);
        }
        distinct_corners(&mut polygon, |corner| corner[0])
            .map_err(|fault| fault.at(format!("line {number}")))?;
        let start = self.corners.len();
        self.corners.extend(polygon);
        self.faces.push(Face {
            corners: start..self.corners.len(),
            line: number,
        });
        Ok(())
    }

    fn corner(&self, word: &str, number: usize) -> Result<Corner, FormatError> {
        let counts = [
            self.mesh.positions.len(),
            self.mesh.texture.len(),
            self.mesh.normals.len(),
        ];
        let mut corner = [None; 3];
        for (k, part) in word.split('/').enumerate() {
            if k > 2 || (part.is_empty() && k == 0) {
                return Err(bad_corner(word, number));
            }
            if part.is_empty() {
                continue;
            }
            let index: i64 = part.parse().map_err(|_| bad_corner(word, number))?;
            let from_zero = if index < 0 {
                counts[k] as i64 + index
            } else {
                index - 1
            };
            corner[k] = Some(
                u32::try_from(from_zero).map_err(|_| missing_entry(k, index, counts[k], number))?,
            );
        }
        Ok(corner)
    }

    /// Checks the indices and triangulates the faces. A face may stand before its vertices in the file, so
    /// indices are checked against the counts at the end of the file.
    fn finish(mut self) -> Result<ObjMesh, FormatError> {
        if self.faces.is_empty() {
            return Err(FormatError::new(
                "end of the file",
                "no face was found",
                "check that this is an OBJ file of a surface",
            ));
        }
        self.check_indices()?;
        let mesh = &mut self.mesh;
        let has = |k: usize| self.corners.iter().all(|corner| corner[k].is_some());
        let (textured, with_normals) = (has(1), has(2));
        // Number of triangles before each face, for the ranges of the groups.
        let mut before = vec![0];
        for face in &self.faces {
            let corners = &self.corners[face.corners.clone()];
            let place = |corner: &Corner| mesh.positions[corner[0].unwrap_or_default() as usize];
            let places: Vec<Vec3> = corners.iter().map(place).collect();
            let triangles =
                triangles_of(&places).map_err(|fault| fault.at(format!("line {}", face.line)))?;
            for triangle in triangles {
                let of = |k: usize| triangle.map(|c| corners[c][k].unwrap_or_default());
                mesh.triangles.push(of(0));
                if textured {
                    mesh.texture_triangles.push(of(1));
                }
                if with_normals {
                    mesh.normal_triangles.push(of(2));
                }
            }
            before.push(mesh.triangles.len());
        }
        if let Some(last) = mesh.groups.last_mut() {
            last.triangles.end = self.faces.len();
        }
        for group in &mut mesh.groups {
            group.triangles = before[group.triangles.start]..before[group.triangles.end];
        }
        mesh.groups.retain(|group| !group.triangles.is_empty());
        Ok(self.mesh)
    }

    /// Refuses the first index that is out of range.
    fn check_indices(&self) -> Result<(), FormatError> {
        let mesh = &self.mesh;
        let counts = [mesh.positions.len(), mesh.texture.len(), mesh.normals.len()];
        for face in &self.faces {
            for corner in &self.corners[face.corners.clone()] {
                for k in 0..3 {
                    if let Some(index) = corner[k]
                        && index as usize >= counts[k]
                    {
                        let index = i64::from(index) + 1;
                        return Err(missing_entry(k, index, counts[k], face.line));
                    }
                }
            }
        }
        Ok(())
    }
}

fn coordinates<'a, const N: usize>(
    words: &mut impl Iterator<Item = &'a str>,
    number: usize,
    form: &str,
) -> Result<[f64; N], FormatError> {
    let mut values = [0.0; N];
    for value in &mut values {
        let word = words
            .next()
            .ok_or_else(|| at_line(number, "a number is missing", format!("write {form:?}")))?;
        *value = coordinate(word, number)?;
    }
    Ok(values)
}

fn coordinate(word: &str, number: usize) -> Result<f64, FormatError> {
    match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => {
            let shown: String = word.chars().take(30).collect();
            Err(at_line(
                number,
                format!("{shown:?} is not a finite number"),
                "write a decimal number with a point",
            ))
        }
    }
}

fn bad_corner(word: &str, number: usize) -> FormatError {
    let shown: String = word.chars().take(30).collect();
    at_line(
        number,
        format!("corner {shown:?} cannot be read"),
        "write v, v/vt, v//vn or v/vt/vn in whole numbers",
    )
}

fn missing_entry(list: usize, index: i64, count: usize, number: usize) -> FormatError {
    at_line(
        number,
        format!(
            "{} {index} does not exist: there are {count}",
            LIST_NAMES[list]
        ),
        "indices count from 1, or from -1 backwards; export the file again",
    )
}

fn at_line(number: usize, what: impl Into<String>, hint: impl Into<String>) -> FormatError {
    FormatError::new(format!("line {number}"), what, hint)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failure(text: &str) -> String {
        read_obj(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn polygons_groups_and_negative_indices() {
        let text = "\u{feff}# a comment\r\nmtllib a.mtl\no body\ng front panel\nv 0 0 0 # corner\nv 1 0 0 0.5 0.5 0.5\n\
                    v 1 1 0\nv 0 1e0 -0.0\nusemtl red\ns off\nf 1 2 3 4\ng back\nf -1 -2 \\\n -3\nl 1 2\n";
        let mesh = read_obj(text.as_bytes()).unwrap();
        assert_eq!(mesh.positions.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [3, 2, 1]]);
        let groups: Vec<_> = mesh
            .groups
            .iter()
            .map(|g| (g.name.as_str(), g.triangles.clone()))
            .collect();
        assert_eq!(groups, [("front panel", 0..2), ("back", 2..3)]);
    }

    #[test]
    fn corners_with_texture_and_normals() {
        let text =
            "f 1/1/1 2/2/1 3/3/1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1\nvt 0 1 0\nvn 0 0 1\n";
        let mesh = read_obj(text.as_bytes()).unwrap();
        assert_eq!(mesh.texture[1], Vec2::new(1.0, 0.0));
        assert_eq!(mesh.texture_triangles, [[0, 1, 2]]);
        assert_eq!(mesh.normal_triangles, [[0, 0, 0]]);
        assert!(mesh.groups.is_empty());
    }

    #[test]
    fn texture_on_some_faces_only_is_left_out() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\nf 3//  2 1\n";
        let mesh = read_obj(text.as_bytes()).unwrap();
        assert_eq!(mesh.triangles.len(), 2);
        assert!(mesh.texture_triangles.is_empty());
    }

    #[test]
    fn every_refusal_names_the_line_and_a_remedy() {
        let three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        for (text, expected) in [
            ("v 0 0\n", "line 1: a number is missing; write \"v x y z\""),
            ("v 0 nan 0", "line 1: \"nan\" is not a finite number"),
            (
                "\n\nv 0 1e999 0",
                "line 3: \"1e999\" is not a finite number",
            ),
            ("vt x", "line 1: \"x\" is not"),
            ("hello there", "line 1: unknown keyword \"hello\""),
            ("curv 0 1 2", "export the model as polygons"),
            ("v 0 0 0", "no face was found"),
            ("", "no face was found"),
        ] {
            let got = failure(text);
            assert!(got.contains(expected), "{text:?} gave {got}");
        }
        for (face, expected) in [
            ("f 1 2 4", "line 4: position 4 does not exist: there are 3"),
            ("f 1 2 0", "line 4: position 0 does not exist"),
            ("f 1 2 -4", "line 4: position -4 does not exist"),
            ("f 1 2 99999999999", "line 4: position 99999999999"),
            ("f 1 2 99999999999999999999999", "cannot be read"),
            (
                "f 1/1 2/1 3/1",
                "texture coordinate 1 does not exist: there are 0",
            ),
            ("f 1//1 2//1 3//1", "normal 1 does not exist"),
            ("f 1 2", "a face of 2 different corners"),
            ("f 1 2 2 1", "a face of 2 different corners"),
            ("f 1 2 1 3", "a corner twice"),
            ("f 1/1/1/1 2 3", "cannot be read"),
            ("f /1 2 3", "cannot be read"),
            ("f 1.5 2 3", "cannot be read"),
        ] {
            let got = failure(&format!("{three}{face}\n"));
            assert!(got.contains(expected), "{face:?} gave {got}");
        }
    }

    #[test]
    fn polygons_that_are_none_are_refused_with_their_remedy() {
        let corners = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\n";
        for (face, expected) in [
            ("f 1 2 3 4", "line 8: a polygon without area"),
            (
                "f 1 2 6 7 5",
                "line 8: two corners of a polygon lie in one place",
            ),
            ("f 1 6 2 5", "line 8: a polygon that crosses itself"),
        ] {
            let got = failure(&format!("{corners}{face}\n"));
            assert!(got.contains(expected), "{face:?} gave {got}");
        }
    }

    #[test]
    fn groups_hold_the_triangles_of_their_polygons() {
        let corners = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nvt 7 7\n";
        let text = format!("{corners}g l\nf 1/1 2/1 3/1 4/1 5/1 6/1\ng one\nf 1/1 2/1 3/1\n");
        let mesh = read_obj(text.as_bytes()).unwrap();
        let groups: Vec<_> = mesh.groups.iter().map(|g| g.triangles.clone()).collect();
        assert_eq!(groups, [0..4, 4..5]);
        assert_eq!(mesh.texture_triangles.len(), 5);
        let area = mesh.into_triangle_mesh().area();
        assert!((area - 4.0).abs() < 1e-12, "{area}");
    }

    #[test]
    fn a_quad_with_a_corner_twice_is_a_triangle() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 3\nf 1 2 3 1";
        assert_eq!(
            read_obj(text.as_bytes()).unwrap().triangles,
            [[0, 1, 2], [0, 1, 2]]
        );
    }
}
