//! Recorded frames (`NAME.frames`): the positions of all surfaces of a scene at steps of a run.
//!
//! A section begins with its head, one line of JSON. Records of equal length follow, each with step, time,
//! positions in `f32` and a checksum that also covers the head. A new section begins wherever the triangles
//! change. A file that was cut short is read up to its last complete record.

use crate::FormatError;
use crate::scene::json_error;
use serde::{Deserialize, Serialize};
use toile_drape::{Cloth, Material};
use toile_geometry::{TriangleMesh, Vec2, Vec3};

/// The head of a section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameHead {
    format: String,
    version: u32,
    /// Digest of the scene, in hexadecimal digits.
    pub scene: String,
    /// The surfaces, in the order of their positions in a record.
    pub surfaces: Vec<FrameSurface>,
}

/// A surface: one object, or several objects that are sewn together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameSurface {
    /// Name of the surface, which can serve as a file name.
    pub name: String,
    /// The objects of the surface: name, index of the first triangle and index after the last one.
    pub objects: Vec<(String, [usize; 2])>,
    /// Number of the surface's vertices.
    pub vertices: usize,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Positions of a surface that does not move (m); it has no positions in the records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub still: Option<Vec<[f32; 3]>>,
    /// Rest shape of a cloth; `None` for other surfaces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rest: Option<RestShape>,
}

/// The properties of a cloth except its positions; see [`Cloth`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RestShape {
    /// Vertex positions of each triangle in its material plane (m).
    pub rest: Vec<[Vec2; 3]>,
    /// Index of the material of each triangle.
    pub material: Vec<u16>,
    /// Number of the panel of each triangle.
    pub panel: Vec<u32>,
    /// The materials.
    pub materials: Vec<Material>,
}

/// The surfaces at one step.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Steps taken.
    pub step: u64,
    /// Simulated time (s).
    pub time: f64,
    /// Positions of all moving surfaces, one surface after the other (m).
    pub positions: Vec<[f32; 3]>,
}

/// Consecutive frames with the same triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameSection {
    /// Scene and surfaces of the frames.
    pub head: FrameHead,
    /// The frames.
    pub frames: Vec<Frame>,
    /// Offset of the head from the start of the file (bytes).
    pub start: usize,
}

/// The content of a file of frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Frames {
    /// The sections; at least one of them has a frame.
    pub sections: Vec<FrameSection>,
    /// Number of bytes after the last complete record, not 0 if the file was cut short.
    pub left_out: usize,
}

const FORMAT: &str = "toile-frames";
/// The version written and read.
const VERSION: u32 = 1;
/// Tag at the start of every record.
const TAG: &[u8; 4] = b"FRM1";
/// Size of a record without its positions (bytes): tag, step, time, checksum.
const FRAMING: usize = 4 + 8 + 8 + 4;
/// Size of a position (bytes).
const POSITION: usize = 12;
const REMEDY: &str = "record the frames again";

impl FrameHead {
    /// The head of a section.
    pub fn new(scene: u64, surfaces: Vec<FrameSurface>) -> Self {
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            scene: format!("{scene:016x}"),
            surfaces,
        }
    }

    /// Number of positions in a record.
    pub fn moving_vertices(&self) -> usize {
        let moving = self.surfaces.iter().filter(|s| s.still.is_none());
        moving.map(|s| s.vertices).fold(0, usize::saturating_add)
    }

    /// Refuses a head with lists that do not fit together.
    fn check(&self) -> Result<(), FormatError> {
        let refuse = |place: &str, what: String| Err(FormatError::new(place, what, REMEDY));
        if self.format != FORMAT {
            return refuse("format", "it is no file of frames".to_owned());
        }
        if self.version != VERSION {
            let what = format!("it is {}; only {VERSION} is known here", self.version);
            return refuse("version", what);
        }
        for surface in &self.surfaces {
            let place = format!("surface {:?}", surface.name);
            if let Some(what) = surface.defect() {
                return refuse(&place, what);
            }
        }
        Ok(())
    }
}

impl FrameSurface {
    /// Description of the first inconsistency of the surface.
    fn defect(&self) -> Option<String> {
        let count = self.vertices;
        let corners = self.triangles.iter().flatten();
        if let Some(v) = corners.into_iter().find(|&&v| v as usize >= count) {
            return Some(format!("a triangle names vertex {v} of {count}"));
        }
        let ranges = self.objects.iter().map(|(_, range)| range);
        if let Some([from, to]) =
            (ranges.into_iter()).find(|[from, to]| from > to || *to > self.triangles.len())
        {
            return Some(format!("there are no triangles {from} to {to}"));
        }
        if let Some(still) = &self.still {
            if still.len() != count {
                return Some(format!("{} positions for {count} vertices", still.len()));
            }
            if !still.iter().flatten().all(|x| x.is_finite()) {
                return Some("a coordinate is not finite".to_owned());
            }
        }
        let rest = self.rest.as_ref()?;
        let lists = [rest.rest.len(), rest.material.len(), rest.panel.len()];
        let triangles = self.triangles.len();
        if lists.iter().any(|&length| length != triangles) {
            return Some(format!("rest shapes do not fit its {triangles} triangles"));
        }
        let materials = rest.materials.len();
        let unknown = rest.material.iter().find(|&&m| usize::from(m) >= materials);
        unknown.map(|m| format!("there is no material {m}"))
    }
}

impl RestShape {
    /// The rest shape of a cloth.
    pub fn of(cloth: &Cloth) -> Self {
        Self {
            rest: cloth.rest.clone(),
            material: cloth.material.clone(),
            panel: cloth.panel.clone(),
            materials: cloth.materials.clone(),
        }
    }

    /// A cloth with this rest shape and the positions of a mesh.
    pub fn on(&self, mesh: &TriangleMesh) -> Cloth {
        Cloth {
            positions: mesh.positions.clone(),
            triangles: mesh.triangles.clone(),
            rest: self.rest.clone(),
            material: self.material.clone(),
            panel: self.panel.clone(),
            materials: self.materials.clone(),
        }
    }
}

impl FrameSection {
    /// The mesh of a surface at a frame.
    pub fn mesh(&self, surface: usize, frame: usize) -> Option<TriangleMesh> {
        let own = self.head.surfaces.get(surface)?;
        let positions = match &own.still {
            Some(still) => still.as_slice(),
            None => {
                let before = self.head.surfaces[..surface].iter();
                let start: usize = before
                    .filter(|s| s.still.is_none())
                    .map(|s| s.vertices)
                    .sum();
                let positions = &self.frames.get(frame)?.positions;
                positions.get(start..start + own.vertices)?
            }
        };
        Some(TriangleMesh {
            positions: positions
                .iter()
                .map(|p| Vec3::from(p.map(f64::from)))
                .collect(),
            triangles: own.triangles.clone(),
        })
    }
}

/// Encodes the heads and records of a file of frames; the caller appends the bytes to the file.
#[derive(Clone, Debug)]
pub struct FrameWriter {
    /// CRC-32 of the section's head.
    head: u32,
    /// Number of positions in a record.
    vertices: usize,
}

impl FrameWriter {
    /// Starts a section; returns its writer and the bytes of its head.
    ///
    /// # Errors
    /// The head has lists that do not fit together, or a value that JSON cannot represent.
    pub fn begin(head: &FrameHead) -> Result<(Self, Vec<u8>), FormatError> {
        head.check()?;
        let mut bytes = serde_json::to_vec(head).map_err(|error| json_error(&error))?;
        bytes.push(b'\n');
        let writer = Self {
            head: crc32fast::hash(&bytes),
            vertices: head.moving_vertices(),
        };
        Ok((writer, bytes))
    }

    /// The bytes of one record.
    ///
    /// # Errors
    /// The frame has another number of positions than the section, or a position that is not finite.
    pub fn record(&self, frame: &Frame) -> Result<Vec<u8>, FormatError> {
        check_frame(frame, self.vertices)?;
        let mut bytes = Vec::with_capacity(FRAMING + POSITION * self.vertices);
        bytes.extend(TAG);
        bytes.extend(frame.step.to_le_bytes());
        bytes.extend(frame.time.to_le_bytes());
        bytes.extend(
            frame
                .positions
                .iter()
                .flatten()
                .flat_map(|x| x.to_le_bytes()),
        );
        bytes.extend(checksum(self.head, &bytes).to_le_bytes());
        Ok(bytes)
    }
}

/// Checksum of a record, from the checksum of the section's head and the record's bytes before the checksum.
fn checksum(head: u32, record: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new_with_initial(head);
    hasher.update(record);
    hasher.finalize()
}

fn check_frame(frame: &Frame, vertices: usize) -> Result<(), FormatError> {
    let refuse = |what: String| {
        let place = format!("the frame of step {}", frame.step);
        Err(FormatError::new(place, what, REMEDY))
    };
    if frame.positions.len() != vertices {
        let given = frame.positions.len();
        return refuse(format!("{given} positions for {vertices} vertices"));
    }
    let is_finite = frame.positions.iter().flatten().all(|x| x.is_finite());
    match is_finite && frame.time.is_finite() {
        true => Ok(()),
        false => refuse("a number in it is not finite".to_owned()),
    }
}

/// Reads a file of frames; a file that was cut short is read up to its last complete record.
///
/// # Errors
/// The bytes are no file of frames, have no complete frame, or were changed: the place and a remedy.
pub fn read_frames(bytes: &[u8]) -> Result<Frames, FormatError> {
    let mut sections: Vec<FrameSection> = Vec::new();
    let mut writer: Option<FrameWriter> = None;
    let mut at = 0;
    while let Some(&first) = bytes.get(at) {
        let rest = &bytes[at..];
        if first == b'{' {
            let Some(end) = rest.iter().position(|&byte| byte == b'\n') else {
                break;
            };
            let head = read_head(&rest[..=end], at)?;
            writer = Some(FrameWriter {
                head: crc32fast::hash(&rest[..=end]),
                vertices: head.moving_vertices(),
            });
            sections.push(FrameSection {
                head,
                frames: Vec::new(),
                start: at,
            });
            at += end + 1;
            continue;
        }
        let (Some(writer), Some(section)) = (&writer, sections.last_mut()) else {
            let what = "it is no file of frames";
            return Err(FormatError::new("byte 0", what, "name a .frames file"));
        };
        let length = POSITION
            .saturating_mul(writer.vertices)
            .saturating_add(FRAMING);
        let Some(record) = rest.get(..length) else {
            break;
        };
        let frame = read_record(record, writer, at)?;
        check_order(section.frames.last(), &frame)?;
        section.frames.push(frame);
        at += length;
    }
    match sections.iter().any(|section| !section.frames.is_empty()) {
        true => Ok(Frames {
            sections,
            left_out: bytes.len() - at,
        }),
        false => Err(FormatError::new(
            "the file",
            "it has no whole frame",
            REMEDY,
        )),
    }
}

fn read_head(line: &[u8], at: usize) -> Result<FrameHead, FormatError> {
    let head: FrameHead = serde_json::from_slice(line).map_err(|error| {
        FormatError::new(format!("the head at byte {at}"), error.to_string(), REMEDY)
    })?;
    head.check()?;
    Ok(head)
}

fn read_record(record: &[u8], writer: &FrameWriter, at: usize) -> Result<Frame, FormatError> {
    let damaged = || {
        let what = "the record was changed, or belongs to another file";
        FormatError::new(format!("byte {at}"), what, REMEDY)
    };
    let (body, sum) = record.split_last_chunk::<4>().ok_or_else(damaged)?;
    if u32::from_le_bytes(*sum) != checksum(writer.head, body) {
        return Err(damaged());
    }
    let body = body.strip_prefix(TAG).ok_or_else(damaged)?;
    let (step, body) = body.split_first_chunk::<8>().ok_or_else(damaged)?;
    let (time, body) = body.split_first_chunk::<8>().ok_or_else(damaged)?;
    let (numbers, _) = body.as_chunks::<4>();
    let (positions, _) = numbers.as_chunks::<3>();
    let frame = Frame {
        step: u64::from_le_bytes(*step),
        time: f64::from_le_bytes(*time),
        positions: positions
            .iter()
            .map(|p| p.map(f32::from_le_bytes))
            .collect(),
    };
    check_frame(&frame, writer.vertices)?;
    Ok(frame)
}

/// Refuses a frame whose time is not later than that of the frame before it.
fn check_order(before: Option<&Frame>, frame: &Frame) -> Result<(), FormatError> {
    let is_later = before.is_none_or(|before| before.time < frame.time);
    match is_later {
        true => Ok(()),
        false => Err(FormatError::new(
            format!("the frame of step {}", frame.step),
            format!(
                "its time, {} s, is not after that of the frame before",
                frame.time
            ),
            REMEDY,
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn head(vertices: usize) -> FrameHead {
        let moving = FrameSurface {
            name: "cloth".to_owned(),
            objects: vec![("cloth".to_owned(), [0, 1])],
            vertices,
            triangles: vec![[0, 1, 2]],
            rest: Some(RestShape {
                rest: vec![[Vec2::new(0.1, 1.0 / 3.0); 3]],
                material: vec![0],
                panel: vec![0],
                materials: vec![Material::default()],
            }),
            ..FrameSurface::default()
        };
        let still = FrameSurface {
            name: "plate".to_owned(),
            vertices: 1,
            still: Some(vec![[0.1, f32::MIN_POSITIVE, 3.0e7]]),
            ..FrameSurface::default()
        };
        FrameHead::new(7, vec![still, moving])
    }

    fn frame(step: u64, vertices: usize) -> Frame {
        let place = |k: usize| [0.1 * step as f32, 1.0 / (k as f32 + 3.0), -0.0];
        Frame {
            step,
            time: step as f64 / 60.0,
            positions: (0..vertices).map(place).collect(),
        }
    }

    /// A file of two sections, with three and two frames, and the offset at which each record ends.
    fn file() -> (Vec<u8>, Vec<usize>) {
        let (mut bytes, mut ends) = (Vec::new(), Vec::new());
        for (vertices, steps) in [(3, 0..3), (4, 3..5)] {
            let (writer, line) = FrameWriter::begin(&head(vertices)).unwrap();
            bytes.extend(line);
            for step in steps {
                bytes.extend(writer.record(&frame(step, vertices)).unwrap());
                ends.push(bytes.len());
            }
        }
        (bytes, ends)
    }

    #[test]
    fn frames_are_read_to_the_bit() {
        let read = read_frames(&file().0).unwrap();
        assert_eq!(read.left_out, 0);
        assert_eq!(read.sections.len(), 2);
        assert_eq!(read.sections[0].head, head(3));
        assert_eq!(read.sections[1].frames, [frame(3, 4), frame(4, 4)]);
        let mesh = read.sections[1].mesh(1, 1).unwrap();
        assert_eq!(mesh.positions[2].y, f64::from(1.0_f32 / 5.0));
        assert_eq!(read.sections[1].mesh(0, 1).unwrap().positions.len(), 1);
        assert!(read.sections[1].mesh(1, 2).is_none());
    }

    #[test]
    fn a_file_cut_anywhere_is_read_to_its_last_whole_record() {
        let (bytes, ends) = file();
        for cut in 0..bytes.len() {
            let whole = ends.iter().filter(|&&end| end <= cut).count();
            match read_frames(&bytes[..cut]) {
                Ok(read) => {
                    let count: usize = read.sections.iter().map(|s| s.frames.len()).sum();
                    assert_eq!(count, whole, "{cut}");
                }
                Err(error) => assert!(whole == 0, "{cut}: {error}"),
            }
        }
    }

    #[test]
    fn a_frame_takes_12_bytes_a_vertex_and_24_more() {
        let (writer, _) = FrameWriter::begin(&head(1000)).unwrap();
        let record = writer.record(&frame(1, 1000)).unwrap();
        assert_eq!(record.len(), 12 * 1000 + 24);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let (writer, _) = FrameWriter::begin(&head(3)).unwrap();
        assert!(writer.record(&frame(0, 4)).is_err());
        let mut wild = frame(0, 3);
        wild.positions[1][2] = f32::NAN;
        assert!(
            writer
                .record(&wild)
                .unwrap_err()
                .what
                .contains("not finite")
        );
        let mut wrong = head(3);
        wrong.surfaces[1].triangles[0] = [0, 1, 3];
        assert!(FrameWriter::begin(&wrong).is_err());
        // A record of one file after the head of another.
        let (_, mut line) = FrameWriter::begin(&FrameHead::new(8, head(3).surfaces)).unwrap();
        line.extend(writer.record(&frame(0, 3)).unwrap());
        let error = read_frames(&line).unwrap_err();
        assert!(error.what.contains("another file"), "{error}");
        // A time that does not advance.
        let (writer, mut line) = FrameWriter::begin(&head(3)).unwrap();
        line.extend(writer.record(&frame(1, 3)).unwrap().repeat(2));
        assert!(read_frames(&line).unwrap_err().what.contains("not after"));
    }

    proptest! {
        /// A changed byte is detected, or did not alter the result; nothing panics.
        #[test]
        fn no_change_goes_unnoticed(at in 0_usize..10_000, byte in any::<u8>()) {
            let (mut bytes, _) = file();
            let at = at % bytes.len();
            prop_assume!(bytes[at] != byte);
            bytes[at] = byte;
            if let Ok(read) = read_frames(&bytes) {
                let (whole, _) = file();
                let whole = read_frames(&whole).unwrap();
                let frames = |frames: &Frames| -> Vec<Frame> {
                    frames.sections.iter().flat_map(|s| s.frames.clone()).collect()
                };
                let (read, whole) = (frames(&read), frames(&whole));
                prop_assert!(read.len() < whole.len() && read == whole[..read.len()]);
            }
        }

        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            let _ = read_frames(&bytes);
        }
    }
}
