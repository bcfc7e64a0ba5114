//! Recognises the kind of a file from its content, so that a file given in the wrong place is refused by its
//! kind and not by the first character that does not fit.
//!
//! # Decided with
//! - [`crate::file_kind::FileKind`], [`crate::recognise::ExpectedKind`]: kinds of files, and who takes which;
//! - [`crate::mesh_read::read_mesh`], [`crate::measurements_foreign::looks_like_freesewing`]: meshes and
//!   tables told apart;
//! - [`crate::exchange::Format`]: kinds that are patterns;
//! - [`crate::error::FormatError`]: refusals in words.
//!
//! The compiler asks a new kind for its name, remedy and who takes it. By hand: how it is seen from its first
//! bytes, XML, JSON or lines; wrong uses in `tests/wrong-uses/table.toml`.

use crate::dxf::is_rule_table;
use crate::{FileKind, Format, FormatError};
use serde_json::{Map, Value};

impl FileKind {
    /// The kind of a file; `None` if the content does not tell.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        of_magic(bytes).or_else(|| {
            // Other programs write texts in the encodings of their countries, too.
            let text = String::from_utf8_lossy(bytes);
            let text = text.trim_start_matches('\u{feff}').trim_start();
            match text.chars().next() {
                None => Some(Self::Empty),
                Some('<') => Some(of_xml(text)),
                Some('{') => of_json(text),
                Some(_) => of_lines(text),
            }
        })
    }

    /// The commands that take this kind of file; `None` if no command reads it yet.
    fn taken_by(self) -> Option<&'static str> {
        match self {
            Self::Measurements => {
                Some("`toile make --body` and `toile body --measurements` take it")
            }
            Self::Obj | Self::Ply => Some("`toile body --mesh` and scenes take it"),
            Self::Bvh | Self::X3d => Some("`toile body --motion` takes it"),
            Self::Pattern
            | Self::GarmentCode
            | Self::Svg
            | Self::Dxf
            | Self::ValentinaPattern
            | Self::SeamlyPattern => Some("`toile make`, `check` and `nest` take it"),
            Self::Mannequin => Some("`toile make --body` and `toile body --mannequin` take it"),
            Self::Marker => Some("`toile check` and `toile nest --from` take it"),
            Self::MarkerSettings => Some("`toile nest --settings` takes it"),
            Self::RuleTable => Some("give the DXF that it belongs to, and this with `--with`"),
            Self::NestingInstance => Some("`toile nest` takes it"),
            Self::Scene => Some("`toile run` takes it"),
            Self::Journal => Some("`toile replay` takes it"),
            Self::Fabric => Some("`toile make --fabric` and scenes take it"),
            Self::Empty
            | Self::Utf16
            | Self::Picture
            | Self::Pdf
            | Self::PostScript
            | Self::Archive
            | Self::Glb
            | Self::Dwg
            | Self::DrawnMarker
            | Self::Print
            | Self::Html
            | Self::Hpgl
            | Self::FreeSewingPattern
            | Self::OtherXml
            | Self::Stl
            | Self::Report => None,
        }
    }

    /// Remedy for a file of this kind; `None` if the user can only give another file.
    fn remedy(self) -> Option<&'static str> {
        match self {
            Self::Empty => Some("it holds nothing: it may not have been saved"),
            Self::Utf16 => Some("save it as UTF-8"),
            Self::Archive => Some("unpack it first"),
            Self::DrawnMarker | Self::Print => {
                Some("give the pattern that it was made of, which holds more than its drawing")
            }
            Self::Dwg => Some("save it as DXF in text (ASCII) in the program that it comes from"),
            Self::Picture
            | Self::Pdf
            | Self::PostScript
            | Self::Glb
            | Self::Dxf
            | Self::Svg
            | Self::Html
            | Self::Hpgl
            | Self::ValentinaPattern
            | Self::SeamlyPattern
            | Self::FreeSewingPattern
            | Self::OtherXml
            | Self::Stl
            | Self::Measurements
            | Self::Obj
            | Self::Ply
            | Self::Bvh
            | Self::X3d
            | Self::Pattern
            | Self::GarmentCode
            | Self::Mannequin
            | Self::Marker
            | Self::MarkerSettings
            | Self::NestingInstance
            | Self::RuleTable
            | Self::Scene
            | Self::Report
            | Self::Journal
            | Self::Fabric => None,
        }
    }
}

/// The kind of file that a reader expects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExpectedKind {
    /// A pattern.
    Pattern,
    /// Body measurements.
    Measurements,
    /// A mannequin file.
    Mannequin,
    /// A mesh.
    Mesh,
    /// A motion of a body.
    Motion,
    /// A scene.
    Scene,
    /// A marker (`marker.json`).
    Marker,
    /// Marker settings.
    MarkerSettings,
    /// A nesting instance.
    NestingInstance,
    /// A journal.
    Journal,
    /// A fabric file.
    Fabric,
    /// A small JSON file of another kind: edits, proportions, landmarks.
    SmallJson,
}

impl ExpectedKind {
    fn takes(self, kind: FileKind) -> bool {
        match self {
            Self::Pattern => Format::of_kind(kind).is_some(),
            Self::Measurements => kind == FileKind::Measurements,
            Self::Mannequin => kind == FileKind::Mannequin,
            Self::Mesh => matches!(kind, FileKind::Obj | FileKind::Ply),
            Self::Motion => matches!(kind, FileKind::Bvh | FileKind::X3d),
            Self::Scene => kind == FileKind::Scene,
            Self::Marker => kind == FileKind::Marker,
            Self::MarkerSettings => kind == FileKind::MarkerSettings,
            Self::NestingInstance => kind == FileKind::NestingInstance,
            Self::Journal => kind == FileKind::Journal,
            Self::Fabric => kind == FileKind::Fabric,
            Self::SmallJson => false,
        }
    }

    /// The formats that this kind of reader supports, for the remedy.
    fn reads(self) -> String {
        let words = match self {
            Self::Pattern => return format!("patterns are read from {}", Format::read_words()),
            Self::Measurements => {
                "measurements are read from JSON, GarmentCode YAML, .smis, .smms, .vit, .vst and FreeSewing JSON"
            }
            Self::Mannequin => {
                "mannequins are read from JSON that `toile body --out NAME.json` wrote"
            }
            Self::Mesh => "meshes are read from OBJ and PLY",
            Self::Motion => "motions are read from BVH, VRML 97 and X3D",
            Self::Scene => "scenes are read from JSON, see docs/FORMATS.md",
            Self::Marker => "markers are read from a marker.json that `toile nest` wrote",
            Self::MarkerSettings => "marker settings are read from JSON, see docs/FORMATS.md",
            Self::NestingInstance => "nesting instances are read from JSON of jagua-rs",
            Self::Journal => "journals are read from journal.jsonl, one command a line",
            Self::Fabric => "fabrics are read from JSON or CSV, see docs/FORMATS.md",
            Self::SmallJson => "this is read from JSON, see docs/FORMATS.md",
        };
        words.to_owned()
    }

    /// Refuses content that is clearly of another kind, and names that kind. Damaged or unrecognised content
    /// passes, so that the reader can report the place of the fault.
    ///
    /// # Errors
    /// The content is of a kind that the reader does not take.
    pub fn check(self, bytes: &[u8]) -> Result<(), FormatError> {
        let Some(kind) = FileKind::of(bytes).filter(|&kind| !self.takes(kind)) else {
            return Ok(());
        };
        let what = match (kind.taken_by(), kind.remedy()) {
            (None, None) => format!("this is {}, which is not read yet", kind.name()),
            _ => format!("this is {}", kind.name()),
        };
        let hint = match kind.taken_by().or(kind.remedy()) {
            Some(remedy) => format!("{remedy}; {}", self.reads()),
            None => self.reads(),
        };
        Err(FormatError::new("the whole file", what, hint))
    }

    /// The refusal of content that is of no kind.
    pub(crate) fn unknown(self) -> FormatError {
        let what = "this is a file of no format that is known here";
        FormatError::new("the whole file", what, self.reads())
    }
}

/// Recognises a kind by its first bytes.
fn of_magic(bytes: &[u8]) -> Option<FileKind> {
    const STARTS: [(&[u8], FileKind); 18] = [
        (b"ply\n", FileKind::Ply),
        (b"ply\r", FileKind::Ply),
        (b"\x89PNG", FileKind::Picture),
        (b"\xff\xd8\xff", FileKind::Picture),
        (b"GIF8", FileKind::Picture),
        (b"BM", FileKind::Picture),
        (b"II*\0", FileKind::Picture),
        (b"MM\0*", FileKind::Picture),
        (b"%PDF", FileKind::Pdf),
        (b"%!PS", FileKind::PostScript),
        (b"PK\x03\x04", FileKind::Archive),
        (b"\x1f\x8b", FileKind::Archive),
        (b"glTF", FileKind::Glb),
        (b"AutoCAD Binary DXF", FileKind::Dxf),
        (b"\xff\xfe", FileKind::Utf16),
        (b"\xfe\xff", FileKind::Utf16),
        (b"\x1b%", FileKind::Hpgl),
        (b"\x1bE", FileKind::Hpgl),
    ];
    // A drawing of AutoCAD begins with its release, as in AC1032, and a byte that is no text.
    let is_release =
        |bytes: &[u8]| bytes.starts_with(b"AC") && bytes[2..].iter().all(u8::is_ascii_digit);
    if bytes.get(..6).is_some_and(is_release) && bytes.get(6).is_some_and(|&byte| byte < b'\t') {
        return Some(FileKind::Dwg);
    }
    if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") {
        return Some(FileKind::Picture);
    }
    let start = STARTS.iter().find(|(start, _)| bytes.starts_with(start));
    match start {
        // A text may begin with these letters; a bitmap is not valid text.
        Some((b"BM", _)) if std::str::from_utf8(bytes).is_ok() => None,
        found => found.map(|&(_, kind)| kind),
    }
}

/// Recognises a kind of XML by the root element.
fn of_xml(text: &str) -> FileKind {
    match root_element(text) {
        Some("svg") => of_svg(text),
        Some("html") => FileKind::Html,
        Some("X3D") => FileKind::X3d,
        Some("vit" | "vst" | "smis" | "smms") => FileKind::Measurements,
        // Seamly2D adopted Valentina's format and names itself in a comment.
        Some("pattern") if text.contains("Seamly2D") => FileKind::SeamlyPattern,
        Some("pattern") => FileKind::ValentinaPattern,
        _ => FileKind::OtherXml,
    }
}

/// Recognises drawings of this program that are no patterns by the names of their first layers.
fn of_svg(text: &str) -> FileKind {
    const MARKER: &str = "<g id=\"fabric\" inkscape:groupmode=\"layer\" inkscape:label=\"Fabric\"";
    const PRINT: &str =
        "<g id=\"all-sizes\" inkscape:groupmode=\"layer\" inkscape:label=\"All sizes\"";
    match (text.contains(MARKER), text.contains(PRINT)) {
        (true, _) => FileKind::DrawnMarker,
        (false, true) => FileKind::Print,
        (false, false) => FileKind::Svg,
    }
}

/// Name of the root element, without its prefix.
fn root_element(text: &str) -> Option<&str> {
    let mut rest = text;
    loop {
        rest = &rest[rest.find('<')? + 1..];
        if let Some(comment) = rest.strip_prefix("!--") {
            rest = &comment[comment.find("-->")? + 3..];
        } else if !rest.starts_with(['!', '?']) {
            let end = rest.find(|c: char| c.is_whitespace() || matches!(c, '>' | '/'))?;
            return rest[..end].rsplit(':').next();
        } else if rest.to_ascii_lowercase().starts_with("!doctype html") {
            return Some("html");
        }
    }
}

/// Recognises a kind of JSON by the fields of the object; `None` for damaged JSON and for unknown fields.
fn of_json(text: &str) -> Option<FileKind> {
    let mut objects = serde_json::Deserializer::from_str(text).into_iter::<Map<String, Value>>();
    let head = objects.next()?.ok()?;
    let has = |name: &str| head.contains_key(name);
    let says = |name: &str| head.get(name).and_then(Value::as_str);
    let kind = match (says("kind"), says("format")) {
        (Some("pattern"), _) if has("toile") => FileKind::Pattern,
        (Some("fabric"), _) => FileKind::Fabric,
        (Some("mannequin"), _) => FileKind::Mannequin,
        (Some("measurements"), _) => FileKind::Measurements,
        (Some("marker-settings"), _) => FileKind::MarkerSettings,
        (_, Some("toile-marker")) => FileKind::Marker,
        (_, Some("toile-report")) => FileKind::Report,
        _ if says("generator").is_some_and(|g| g.contains("freesewing")) => {
            FileKind::FreeSewingPattern
        }
        _ if head.get("pattern").is_some_and(Value::is_object) => FileKind::GarmentCode,
        _ if has("command") => FileKind::Journal,
        _ if has("objects") => FileKind::Scene,
        _ if has("items") && has("strip_height") => FileKind::NestingInstance,
        _ if has("kes") || has("cantilever") || has("cusick") => FileKind::Fabric,
        _ if head.len() == 1 && has("body") => FileKind::Measurements,
        _ => return None,
    };
    Some(kind)
}

/// Recognises a kind of text by its lines.
fn of_lines(text: &str) -> Option<FileKind> {
    let mut lines = text.lines().map(str::trim);
    let first = lines.next().unwrap_or_default();
    let second = lines.next().unwrap_or_default();
    if first == "HIERARCHY" {
        return Some(FileKind::Bvh);
    }
    if first.starts_with("#VRML") || first.starts_with("#X3D") {
        return Some(FileKind::X3d);
    }
    // A DXF consists of pairs of lines, a code and a value; code 999 is a comment.
    if first == "999" || (first == "0" && second == "SECTION") {
        return Some(FileKind::Dxf);
    }
    if first == "body:" {
        return Some(FileKind::Measurements);
    }
    if is_rule_table(text) {
        return Some(FileKind::RuleTable);
    }
    if first.starts_with("solid") && text.contains("facet normal") {
        return Some(FileKind::Stl);
    }
    if first.starts_with("IN;") || first.starts_with("PU") && first.contains(';') {
        return Some(FileKind::Hpgl);
    }
    let vertex = |line: &str| {
        let mut words = line.split_whitespace();
        let numbers = |words: std::str::SplitWhitespace<'_>| {
            words
                .take(3)
                .filter(|word| word.parse::<f64>().is_ok())
                .count()
        };
        words.next() == Some("v") && numbers(words) == 3
    };
    let mut told = text.lines().map(str::trim).take(2000);
    told.any(vertex).then_some(FileKind::Obj)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_known_by_their_content() {
        let cases: [(&[u8], FileKind); 29] = [
            (b"  \n", FileKind::Empty),
            (b"\xff\xfe<\0s\0", FileKind::Utf16),
            (b"\x89PNG\r\n\x1a\n", FileKind::Picture),
            (b"\xff\xd8\xff\xe0", FileKind::Picture),
            (b"BM\x9a\xff\0\0", FileKind::Picture),
            (b"%PDF-1.7\n", FileKind::Pdf),
            (b"PK\x03\x04\x14\0", FileKind::Archive),
            (b"glTF\x02\0\0\0", FileKind::Glb),
            (b"AC1032\0\0\0\0\0", FileKind::Dwg),
            (b"  0\r\nSECTION\r\n  2\r\n", FileKind::Dxf),
            (b"999\nmade by hand\n0\nSECTION\n", FileKind::Dxf),
            (
                b"<?xml version='1.0'?>\n<!-- <html> -->\n<svg:svg xmlns:svg='x'/>",
                FileKind::Svg,
            ),
            (b"<!DOCTYPE html><p>", FileKind::Html),
            (
                b"<pattern>\n<!--Valentina pattern format.--></pattern>",
                FileKind::ValentinaPattern,
            ),
            (
                b"<pattern><!--Pattern created with Seamly2D v0.6--></pattern>",
                FileKind::SeamlyPattern,
            ),
            (b"<vst><size base='50'/></vst>", FileKind::Measurements),
            (b"<broken", FileKind::OtherXml),
            (b"IN;SP1;PU0,0;", FileKind::Hpgl),
            (b"# mesh\no a\nv 0 0 1\nf 1 1 1\n", FileKind::Obj),
            (b"ply\r\nformat ascii 1.0\r\n", FileKind::Ply),
            (b"HIERARCHY\nROOT Hips\n", FileKind::Bvh),
            (b"body:\n  height: 171\n", FileKind::Measurements),
            (
                b"version ANSI/AAMA-292-B\r\nSIZE LIST: S M\r\nRULE: DELTA 1\r\n",
                FileKind::RuleTable,
            ),
            (br#"{"toile": 1, "kind": "pattern"}"#, FileKind::Pattern),
            (br#"{"pattern": {"panels": {}}}"#, FileKind::GarmentCode),
            (br#"{"format": "toile-marker"}"#, FileKind::Marker),
            (
                br#"{"format": "toile-report", "pattern": "T-shirt"}"#,
                FileKind::Report,
            ),
            (br#"{"objects": []}"#, FileKind::Scene),
            (br#"{"name": "suiting", "kes": {}}"#, FileKind::Fabric),
        ];
        for (bytes, kind) in cases {
            let text = String::from_utf8_lossy(bytes);
            assert_eq!(FileKind::of(bytes), Some(kind), "{text}");
        }
        for untold in [&b"{\"toile\": 1, "[..], b"[1, 2]", b"B,0.1\n", b"nonsense"] {
            assert_eq!(FileKind::of(untold), None);
        }
    }

    #[test]
    fn a_file_of_another_kind_is_refused_by_its_name_with_what_is_read() {
        let error = ExpectedKind::Pattern
            .check(b"%PDF-1.7\n")
            .expect_err("a PDF");
        assert_eq!(
            error.to_string(),
            format!(
                "the whole file: this is a PDF, which is not read yet; patterns are read from {}",
                Format::read_words()
            )
        );
        let error = ExpectedKind::Pattern
            .check(br#"{"objects": []}"#)
            .expect_err("a scene");
        assert!(error.hint.starts_with("`toile run` takes it"), "{error}");
        assert!(ExpectedKind::Scene.check(br#"{"objects": []}"#).is_ok());
        assert!(
            ExpectedKind::Pattern.check(b"{\"toile\": 1, ").is_ok(),
            "the reader says where"
        );
    }
}
