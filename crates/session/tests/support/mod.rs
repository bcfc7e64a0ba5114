//! What the session's tests share.
#![allow(dead_code)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toile_session::{Command, Quality};

/// A ring of two pieces round the waist: the smallest garment there is.
pub const BAND: &str = r#"{
 "toile": 1, "kind": "pattern", "name": "Band", "unit": "cm", "base_size": "M",
 "sizes": { "M": { "waist": 84, "hips": 103 }, "L": { "waist": 90, "hips": 108 } },
 "variables": { "half": "waist / 2 + 0.5cm" },
 "fabrics": { "poplin": {
   "density_kg_per_m2": 0.12, "thickness_m": 0.0004, "stretch_N_per_m": [1500, 1200],
   "shear_N_per_m": 120, "poisson": 0.2, "bend_N_m": [1e-5, 8e-6, 7e-6], "friction": 0.4,
   "width_m": 1.5, "nap": false, "colour": [0.5, 0.6, 0.8] } },
 "panels": {
  "front": { "fabric": "poplin", "seam_allowance": 1,
   "worn": { "part": "trunk", "facing": "front", "level": "108.5cm" },
   "points": { "a": ["-half / 2", -4], "b": ["half / 2", -4], "c": ["half / 2", 4], "d": ["-half / 2", 4] },
   "outline": [ { "edge": "bottom", "from": "a" }, { "edge": "left", "from": "b" },
                { "edge": "top", "from": "c" }, { "edge": "right", "from": "d" } ] },
  "back": { "fabric": "poplin", "seam_allowance": 1,
   "worn": { "part": "trunk", "facing": "back", "level": "108.5cm" },
   "points": { "a": ["-half / 2", -4], "b": ["half / 2", -4], "c": ["half / 2", 4], "d": ["-half / 2", 4] },
   "outline": [ { "edge": "bottom", "from": "a" }, { "edge": "right", "from": "b" },
                { "edge": "top", "from": "c" }, { "edge": "left", "from": "d" } ] } },
 "seams": [
  { "name": "left", "sides": [["front.left"], [{ "edge": "back.left", "from": 1, "to": 0 }]] },
  { "name": "right", "sides": [["front.right"], [{ "edge": "back.right", "from": 1, "to": 0 }]] } ]
}
"#;

/// Writes the band into a folder.
pub fn band(folder: &Path) -> PathBuf {
    let path = folder.join("band.toile.json");
    std::fs::write(&path, BAND).unwrap();
    path
}

/// The commands that make the band into a folder.
pub fn make(pattern: &Path, dir: &Path) -> Vec<Command> {
    vec![
        Command::OpenPattern {
            path: pattern.to_owned(),
        },
        Command::SetQuality {
            quality: Quality::Preview,
        },
        Command::Check,
        Command::Nest,
        Command::Assemble,
        Command::drape(),
        Command::export(dir),
    ]
}

/// Every file of a folder.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap())
        .map(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            (name, std::fs::read(entry.path()).unwrap())
        })
        .collect()
}

/// Files without the times.
pub fn lasting(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = files(folder);
    assert!(files.remove("timing.json").is_some());
    files
}
