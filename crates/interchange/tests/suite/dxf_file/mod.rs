//! DXF files of small parts, and the outlines and notches of a file that was written.

use std::fmt::Write as _;
use toile_interchange::{
    Fitting, Format, ReadOptions, Reading, SizedDraft, WriteSource, read, write,
};
use toile_measure::Measurements;
use toile_pattern::{Draft, Evaluation, Pattern, Wearer};

/// A DXF file in parts.
#[derive(Default)]
pub struct File {
    pub blocks: String,
    pub inserts: String,
    pub style: String,
}

pub fn tag(text: &mut String, code: i32, value: impl std::fmt::Display) {
    let _ = write!(text, "{code}\r\n{value}\r\n");
}

/// A line through points; `further` are tags of the polyline.
pub fn line(layer: u32, points: &[[f64; 2]], closed: bool, further: &[(i32, &str)]) -> String {
    let mut text = String::new();
    tag(&mut text, 0, "POLYLINE");
    tag(&mut text, 8, layer);
    tag(&mut text, 66, 1);
    tag(&mut text, 70, i32::from(closed));
    further
        .iter()
        .for_each(|(code, value)| tag(&mut text, *code, value));
    for [x, y] in points {
        tag(&mut text, 0, "VERTEX");
        tag(&mut text, 8, layer);
        tag(&mut text, 10, x);
        tag(&mut text, 20, y);
    }
    tag(&mut text, 0, "SEQEND");
    text
}

pub fn point(layer: u32, [x, y]: [f64; 2], further: &[(i32, &str)]) -> String {
    let mut text = String::new();
    tag(&mut text, 0, "POINT");
    tag(&mut text, 8, layer);
    tag(&mut text, 10, x);
    tag(&mut text, 20, y);
    further
        .iter()
        .for_each(|(code, value)| tag(&mut text, *code, value));
    text
}

pub fn words(text: &str) -> String {
    let mut out = String::new();
    tag(&mut out, 0, "TEXT");
    tag(&mut out, 8, 1);
    tag(&mut out, 10, 0);
    tag(&mut out, 20, 0);
    tag(&mut out, 1, text);
    out
}

impl File {
    pub fn block(&mut self, name: &str, parts: &[String]) {
        tag(&mut self.blocks, 0, "BLOCK");
        tag(&mut self.blocks, 8, 1);
        tag(&mut self.blocks, 2, name);
        tag(&mut self.blocks, 70, 64);
        tag(&mut self.blocks, 10, 0);
        tag(&mut self.blocks, 20, 0);
        self.blocks.extend(parts.iter().map(String::as_str));
        tag(&mut self.blocks, 0, "ENDBLK");
        self.insert(name, &[]);
    }

    pub fn insert(&mut self, name: &str, further: &[(i32, &str)]) {
        tag(&mut self.inserts, 0, "INSERT");
        tag(&mut self.inserts, 8, 1);
        tag(&mut self.inserts, 2, name);
        further
            .iter()
            .for_each(|(code, value)| tag(&mut self.inserts, *code, value));
    }

    pub fn text(&self) -> String {
        let mut text = String::new();
        for (name, content) in [
            ("BLOCKS", &self.blocks),
            ("ENTITIES", &(self.style.clone() + &self.inserts)),
        ] {
            tag(&mut text, 0, "SECTION");
            tag(&mut text, 2, name);
            text += content;
            tag(&mut text, 0, "ENDSEC");
        }
        tag(&mut text, 0, "EOF");
        text
    }

    pub fn read(&self) -> Reading {
        read(self.text().as_bytes(), &ReadOptions::default(), &[]).unwrap()
    }
}

pub fn draft_of(pattern: &Pattern, size: Option<&str>) -> Draft {
    let size = size.map(|name| pattern.size_named(name).unwrap().id);
    let wearer = Wearer {
        measurements: Measurements::adult(),
        size,
    };
    let (draft, found) = Evaluation::new(pattern, wearer).draft();
    let faults: Vec<String> = found
        .iter()
        .filter(|d| d.severity == toile_pattern::Severity::Error)
        .map(ToString::to_string)
        .collect();
    assert_eq!(faults, [""; 0]);
    draft
}

/// A block of a file: its texts, and the lines and points of each layer.
#[derive(Clone, Debug, Default)]
pub struct ReadBlock {
    pub texts: Vec<String>,
    pub lines: Vec<(u32, Vec<[f64; 2]>)>,
    pub points: Vec<(u32, [f64; 2])>,
}

impl ReadBlock {
    /// The value of a text `Key: value`.
    pub fn label(&self, key: &str) -> Option<&str> {
        let values = self.texts.iter().filter_map(|text| text.split_once(": "));
        values
            .into_iter()
            .find(|(k, _)| *k == key)
            .map(|(_, value)| value)
    }

    /// The lines of a layer.
    pub fn layer(&self, layer: u32) -> impl Iterator<Item = &Vec<[f64; 2]>> {
        let own = self.lines.iter().filter(move |(l, _)| *l == layer);
        own.map(|(_, points)| points)
    }
}

/// The blocks of a file of polylines, points and texts.
pub fn blocks(text: &str) -> Vec<ReadBlock> {
    let mut lines = text.lines().map(str::trim);
    let (mut found, mut kind, mut layer) = (Vec::new(), String::new(), 0);
    let mut in_block = false;
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        let code: i32 = code.parse().unwrap();
        if code == 0 {
            kind = value.to_owned();
            match value {
                "BLOCK" => {
                    found.push(ReadBlock::default());
                    in_block = true;
                }
                "ENDBLK" => in_block = false,
                _ => {}
            }
        }
        let Some(block) = found.last_mut().filter(|_| in_block) else {
            continue;
        };
        match (kind.as_str(), code) {
            ("TEXT", 1) => block.texts.push(value.to_owned()),
            (_, 8) => {
                layer = value.parse().unwrap();
                if kind == "POLYLINE" {
                    block.lines.push((layer, Vec::new()));
                }
            }
            ("VERTEX", 10) => {
                let line = block.lines.last_mut().unwrap();
                line.1.push([value.parse().unwrap(), 0.0]);
            }
            ("VERTEX", 20) => {
                let line = block.lines.last_mut().unwrap();
                line.1.last_mut().unwrap()[1] = value.parse().unwrap();
            }
            ("POINT", 10) => block.points.push((layer, [value.parse().unwrap(), 0.0])),
            ("POINT", 20) => block.points.last_mut().unwrap().1[1] = value.parse().unwrap(),
            _ => {}
        }
    }
    found
}

/// A pattern written as DXF in all its sizes.
pub fn written(pattern: &Pattern, format: Format) -> String {
    let mut sizes: Vec<Option<String>> = pattern
        .sizes
        .iter()
        .map(|size| Some(size.name.clone()))
        .collect();
    sizes.sort_by_key(|size| {
        pattern
            .size_named(size.as_deref().unwrap())
            .map(|size| size.id)
            != pattern.base_size
    });
    if sizes.is_empty() {
        sizes.push(None);
    }
    let drafts: Vec<SizedDraft> = sizes
        .into_iter()
        .map(|size| SizedDraft {
            draft: draft_of(pattern, size.as_deref()),
            size,
        })
        .collect();
    let source = WriteSource {
        pattern,
        fitting: &Fitting::default(),
        drafts: &drafts,
    };
    String::from_utf8(write(&source, format).unwrap().files.remove(0).bytes).unwrap()
}

/// Distance of a point from a closed line.
pub fn off(p: [f64; 2], ring: &[[f64; 2]]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    let chords = ring.iter().zip(next).map(|(&[ax, ay], &[bx, by])| {
        let (dx, dy) = (bx - ax, by - ay);
        let along = (p[0] - ax) * dx + (p[1] - ay) * dy;
        let share = (along / (dx * dx + dy * dy).max(1e-300)).clamp(0.0, 1.0);
        (ax + dx * share - p[0]).hypot(ay + dy * share - p[1])
    });
    chords.fold(f64::INFINITY, f64::min)
}

/// Longest time for a file (s); without optimisation four times as long.
pub const MAX_SECONDS: f64 = if cfg!(debug_assertions) { 8.0 } else { 2.0 };

/// Time that this thread has had of a processor (s), where the system tells it; other tests run beside it.
pub fn processor_seconds() -> Option<f64> {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = told.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

/// The result of a task, and the time that it took of the processor (s); 0 where the system does not tell it.
pub fn timed<T>(task: impl FnOnce() -> T) -> (T, f64) {
    let start = processor_seconds();
    let found = task();
    let seconds = processor_seconds()
        .zip(start)
        .map(|(end, start)| end - start);
    (found, seconds.unwrap_or(0.0))
}

/// A piece of a file in one size (mm).
pub struct Truth {
    pub piece: String,
    pub size: String,
    pub ring: Vec<[f64; 2]>,
    /// Places of its notches.
    pub notches: Vec<[f64; 2]>,
    /// x of the fold, which vertices may lie on.
    pub fold: Option<f64>,
}

/// Reads a file, writes it again, and holds every outline and notch to what the file says.
pub fn held(bytes: &[u8], truths: &[Truth], options: &ReadOptions) -> Reading {
    let reading = read(bytes, options, &[]).unwrap();
    let mut pieces: Vec<&str> = truths.iter().map(|truth| truth.piece.as_str()).collect();
    pieces.dedup();
    let names: Vec<&str> = reading
        .pattern
        .panels
        .iter()
        .map(|panel| panel.name.as_str())
        .collect();
    assert_eq!(names, pieces);
    let text = written(&reading.pattern, Format::DxfAama);
    let blocks = blocks(&text);
    assert_eq!(blocks.len(), truths.len());
    for truth in truths {
        let place = format!("{} {}", truth.piece, truth.size);
        let block = blocks.iter().find(|block| {
            block.label("Piece Name") == Some(&truth.piece)
                && (block.label("Size") == Some(&truth.size) || truth.size.is_empty())
        });
        let block = block.expect(&place);
        let outline = block.layer(1).next().unwrap();
        for p in &truth.ring {
            let on_fold = truth.fold.is_some_and(|x| (p[0] - x).abs() < 1e-3);
            assert!(
                on_fold || off(*p, outline) < NEAR,
                "{place}: {p:?} is {} off",
                off(*p, outline)
            );
        }
        for p in &truth.notches {
            let notches = block
                .points
                .iter()
                .filter(|(layer, _)| matches!(layer, 4 | 80..=82));
            let off = notches.map(|(_, q)| (p[0] - q[0]).hypot(p[1] - q[1]));
            let off = off.fold(f64::INFINITY, f64::min);
            assert!(off < 0.3, "{place}: the notch at {p:?} is {off} off");
        }
    }
    reading
}

pub fn default_held(text: &str, truths: &[Truth]) -> Reading {
    held(text.as_bytes(), truths, &ReadOptions::default())
}

/// Largest distance of a vertex from the outline that is written again (mm).
pub const NEAR: f64 = 0.1;
