//! Reads PLY (Turk 1994), the Stanford triangle format: as text and binary of either byte order.

use crate::polygon::{distinct_corners, triangles_of};
use crate::{FormatError, ObjMesh};
use toile_geometry::Vec3;

/// Whether a file begins with the PLY signature.
pub(crate) fn looks_like_ply(bytes: &[u8]) -> bool {
    matches!(bytes, [b'p', b'l', b'y', b'\r' | b'\n', ..])
}

/// Reads vertex positions and faces of a mesh; other properties and elements are skipped. Polygons of any
/// shape are triangulated.
///
/// # Errors
/// With the line of the header, or the number of the vertex or face, from 1: an unreadable header, data that
/// end early, a number that is not finite, an index out of range, a polygon without area or that crosses
/// itself. Also a file without any face.
pub fn read_ply(bytes: &[u8]) -> Result<ObjMesh, FormatError> {
    let header = Header::read(bytes)?;
    let mut mesh = ObjMesh::default();
    let mut faces = Vec::new();
    let mut data = Data {
        rest: &bytes[header.length..],
        coding: header.coding,
    };
    for element in &header.elements {
        for row in 0..element.count {
            let place = || format!("{} {}", element.name, row + 1);
            let values = element
                .row(&mut data)
                .ok_or_else(|| short(element, place()))?;
            match &*element.name {
                "vertex" => mesh.positions.push(position(element, &values, place())?),
                "face" => faces.push(corners(element, &values, place())?),
                _ => {}
            }
        }
    }
    if faces.is_empty() {
        return Err(FormatError::new(
            "end of the file",
            "no face was found",
            "export the mesh with its faces: points alone have no surface",
        ));
    }
    for (row, corners) in faces.into_iter().enumerate() {
        add_face(&mut mesh, corners, format!("face {}", row + 1))?;
    }
    Ok(mesh)
}

fn add_face(mesh: &mut ObjMesh, mut corners: Vec<u32>, place: String) -> Result<(), FormatError> {
    let count = mesh.positions.len();
    if let Some(beyond) = corners.iter().find(|&&v| v as usize >= count) {
        return Err(FormatError::new(
            place,
            format!("vertex {beyond} does not exist: there are {count}, counted from 0"),
            "export the file again",
        ));
    }
    let made = distinct_corners(&mut corners, |&v| v).and_then(|()| {
        let places: Vec<Vec3> = corners
            .iter()
            .map(|&v| mesh.positions[v as usize])
            .collect();
        triangles_of(&places)
    });
    let triangles = made.map_err(|fault| fault.at(place))?;
    let of_mesh = triangles.into_iter().map(|t| t.map(|k| corners[k]));
    mesh.triangles.extend(of_mesh);
    Ok(())
}

fn short(element: &Element, place: String) -> FormatError {
    FormatError::new(
        place,
        format!(
            "it cannot be read: the data end, or a word is no number; the header says there are {}",
            element.count
        ),
        "export the file again: it may not have been written whole",
    )
}

fn position(element: &Element, values: &[Vec<f64>], place: String) -> Result<Vec3, FormatError> {
    let of = |name: &str| {
        let k = element.properties.iter().position(|p| p.name == name)?;
        values[k].first().copied().filter(|x| x.is_finite())
    };
    match (of("x"), of("y"), of("z")) {
        (Some(x), Some(y), Some(z)) => Ok(Vec3::new(x, y, z)),
        _ => Err(FormatError::new(
            place,
            "x, y or z is missing or not a finite number",
            "export the file again, with x, y and z of each vertex",
        )),
    }
}

fn corners(element: &Element, values: &[Vec<f64>], place: String) -> Result<Vec<u32>, FormatError> {
    let is_list = |p: &Property| matches!(&*p.name, "vertex_indices" | "vertex_index");
    let Some(k) = element.properties.iter().position(is_list) else {
        return Err(FormatError::new(
            place,
            "it has no list vertex_indices",
            "export the mesh as polygons",
        ));
    };
    let index =
        |&x: &f64| (x >= 0.0 && x.fract() == 0.0 && x < f64::from(u32::MAX)).then_some(x as u32);
    let indices: Option<Vec<u32>> = values[k].iter().map(index).collect();
    indices.ok_or_else(|| {
        let what = "an index is not a whole number from 0";
        FormatError::new(place, what, "export the file again")
    })
}

/// The encoding of numbers: text, or binary with the least or the most significant byte first.
#[derive(Clone, Copy, PartialEq)]
enum Coding {
    Text,
    Little,
    Big,
}

/// A number type: its length in bytes, and a function that decodes its bytes, the least significant first.
#[derive(Clone, Copy)]
struct Number {
    length: usize,
    read: fn([u8; 8]) -> f64,
}

impl Number {
    fn named(name: &str) -> Option<Self> {
        let (length, read): (usize, fn([u8; 8]) -> f64) = match name {
            "char" | "int8" => (1, |b| f64::from(b[0] as i8)),
            "uchar" | "uint8" => (1, |b| f64::from(b[0])),
            "short" | "int16" => (2, |b| f64::from(i16::from_le_bytes([b[0], b[1]]))),
            "ushort" | "uint16" => (2, |b| f64::from(u16::from_le_bytes([b[0], b[1]]))),
            "int" | "int32" => (4, |b| f64::from(u64::from_le_bytes(b) as u32 as i32)),
            "uint" | "uint32" => (4, |b| f64::from(u64::from_le_bytes(b) as u32)),
            "float" | "float32" => (4, |b| {
                f64::from(f32::from_bits(u64::from_le_bytes(b) as u32))
            }),
            "double" | "float64" => (8, f64::from_le_bytes),
            _ => return None,
        };
        Some(Self { length, read })
    }
}

struct Property {
    name: String,
    /// The number type of the list's length; `None` for a property that is a single number, not a list.
    length: Option<Number>,
    number: Number,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

impl Element {
    /// The values of each property in the next row of the element's data; `None` if the row cannot be read.
    fn row(&self, data: &mut Data<'_>) -> Option<Vec<Vec<f64>>> {
        let values = |property: &Property| {
            let count = match property.length {
                None => 1.0,
                Some(length) => data.next(length)?,
            };
            // A length greater than the remaining data is invalid.
            let is_length = count >= 0.0 && count <= data.rest.len() as f64;
            let count = is_length.then_some(count as usize)?;
            (0..count).map(|_| data.next(property.number)).collect()
        };
        self.properties.iter().map(values).collect()
    }
}

/// The data not yet read.
struct Data<'a> {
    rest: &'a [u8],
    coding: Coding,
}

impl Data<'_> {
    fn next(&mut self, number: Number) -> Option<f64> {
        if self.coding == Coding::Text {
            let rest = self.rest.trim_ascii_start();
            let end = rest.iter().position(u8::is_ascii_whitespace);
            let (word, rest) = rest.split_at(end.unwrap_or(rest.len()));
            self.rest = rest;
            return std::str::from_utf8(word).ok()?.parse().ok();
        }
        let (bytes, rest) = self.rest.split_at_checked(number.length)?;
        self.rest = rest;
        let mut eight = [0; 8];
        for (k, byte) in bytes.iter().enumerate() {
            let k = match self.coding {
                Coding::Big => number.length - 1 - k,
                Coding::Text | Coding::Little => k,
            };
            eight[k] = *byte;
        }
        Some((number.read)(eight))
    }
}

struct Header {
    coding: Coding,
    elements: Vec<Element>,
    /// Offset of the data in the file (bytes).
    length: usize,
}

impl Header {
    fn read(bytes: &[u8]) -> Result<Self, FormatError> {
        let mut coding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut length = 0;
        for (number, line) in bytes.split_inclusive(|&b| b == b'\n').enumerate() {
            length += line.len();
            let text = String::from_utf8_lossy(line);
            let words: Vec<&str> = text.split_whitespace().collect();
            let bad = || {
                let shown: String = text.trim().chars().take(40).collect();
                FormatError::new(
                    format!("line {}", number + 1),
                    format!("{shown:?} cannot be read in the header of a PLY file"),
                    "export the file again as PLY 1.0, or as OBJ",
                )
            };
            match words[..] {
                ["ply"] if number == 0 => {}
                [] | ["comment" | "obj_info", ..] => {}
                ["format", name, _] => coding = Some(coding_named(name).ok_or_else(bad)?),
                ["element", name, count] => elements.push(Element {
                    name: name.to_owned(),
                    count: count.parse().map_err(|_| bad())?,
                    properties: Vec::new(),
                }),
                ["property", ref rest @ ..] => {
                    let property = property(rest).ok_or_else(bad)?;
                    let element = elements.last_mut().ok_or_else(bad)?;
                    element.properties.push(property);
                }
                ["end_header"] => {
                    let coding = coding.ok_or_else(bad)?;
                    return Ok(Self {
                        coding,
                        elements,
                        length,
                    });
                }
                _ => return Err(bad()),
            }
        }
        Err(FormatError::new(
            "the header",
            "it does not end: there is no line end_header",
            "export the file again: it may not have been written whole",
        ))
    }
}

fn coding_named(name: &str) -> Option<Coding> {
    match name {
        "ascii" => Some(Coding::Text),
        "binary_little_endian" => Some(Coding::Little),
        "binary_big_endian" => Some(Coding::Big),
        _ => None,
    }
}

fn property(words: &[&str]) -> Option<Property> {
    let (length, number, name) = match words {
        ["list", length, number, name] => (Some(Number::named(length)?), number, name),
        [number, name] => (None, number, name),
        _ => return None,
    };
    Some(Property {
        name: (*name).to_owned(),
        length,
        number: Number::named(number)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const HEAD: &str = "element vertex 6\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\n\
        element face 2\nproperty list uchar int vertex_indices\nelement edge 1\nproperty short a\nend_header\n";
    const PLACES: [[f32; 2]; 6] = [
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [0.0, 2.0],
    ];
    const FACES: [&[i32]; 2] = [&[0, 1, 2, 3, 4, 5], &[2, 1, 0]];

    fn as_text() -> String {
        let mut text = format!("ply\r\nformat ascii 1.0\r\ncomment L\n{HEAD}");
        for [x, y] in PLACES {
            text += &format!("{x} {y} 0.5 255\n");
        }
        text + "6 0 1 2 3 4 5\n3 2 1 0\n-7\n"
    }

    fn as_bytes(big: bool) -> Vec<u8> {
        let order = if big { "big" } else { "little" };
        let mut bytes = format!("ply\nformat binary_{order}_endian 1.0\n{HEAD}").into_bytes();
        let mut put = |mut value: Vec<u8>| {
            if big {
                value.reverse();
            }
            bytes.extend(value);
        };
        for [x, y] in PLACES {
            put(x.to_le_bytes().to_vec());
            put(y.to_le_bytes().to_vec());
            put(0.5f64.to_le_bytes().to_vec());
            put(vec![255]);
        }
        for face in FACES {
            put(vec![face.len() as u8]);
            face.iter().for_each(|v| put(v.to_le_bytes().to_vec()));
        }
        put((-7i16).to_le_bytes().to_vec());
        bytes
    }

    #[test]
    fn text_and_both_byte_orders_hold_the_same_mesh() {
        let mesh = read_ply(as_text().as_bytes()).unwrap();
        assert_eq!(mesh.positions[4], Vec3::new(1.0, 2.0, 0.5));
        assert_eq!(mesh.triangles.len(), 5);
        assert_eq!(mesh.triangles[4], [2, 1, 0]);
        let area = mesh.clone().into_triangle_mesh().area();
        assert!((area - 4.0).abs() < 1e-12, "{area}");
        for big in [false, true] {
            assert_eq!(read_ply(&as_bytes(big)).unwrap(), mesh);
        }
    }

    #[test]
    fn refusals_name_the_place() {
        let fault = |from: &str, to: &str| {
            let text = as_text().replacen(from, to, 1);
            read_ply(text.as_bytes()).unwrap_err().to_string()
        };
        for (from, to, expected) in [
            (
                "ascii",
                "ebcdic",
                "line 2: \"format ebcdic 1.0\" cannot be read",
            ),
            ("end_header", "end", "line 13: \"end\" cannot"),
            ("float x", "quad x", "line 5: \"property quad x\" cannot"),
            ("float x", "float u", "vertex 1: x, y or z is missing"),
            ("1 2 0.5", "nan 2 0.5", "vertex 5: x, y or z is missing"),
            (
                "vertex_indices",
                "strips",
                "face 1: it has no list vertex_indices",
            ),
            (
                "3 2 1 0",
                "3 2 1 9",
                "face 2: vertex 9 does not exist: there are 6",
            ),
            ("3 2 1 0", "3 2 1 -1", "face 2: an index is not"),
            (
                "3 2 1 0",
                "3 2 1 2",
                "face 2: a face of 2 different corners",
            ),
            ("3 2 1 0\n-7", "", "face 2: it cannot be read"),
            ("face 2", "face 0", "end of the file: no face was found"),
        ] {
            let got = fault(from, to);
            assert!(got.contains(expected), "{to:?} gave {got}");
        }
    }

    proptest! {
        #[test]
        fn damaged_bytes_never_panic(at in 0usize..400, byte in 0u8.., cut in 0usize..400) {
            for mut bytes in [as_text().into_bytes(), as_bytes(false), as_bytes(true)] {
                let count = bytes.len();
                bytes[at % count] = byte;
                bytes.truncate(count - cut % count);
                let _ = read_ply(&bytes);
            }
        }
    }
}
