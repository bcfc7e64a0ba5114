//! The rules of the house, as tests: layering, file length, units in docs, top level.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use toile_house::{files_below, root};

/// Our libraries from below: each may at most use those before it.
const LIBRARIES: [&str; 18] = [
    "realtime",
    "geometry",
    "measure",
    "lettering",
    "fabric",
    "sparse",
    "pattern",
    "cut",
    "assembly",
    "nesting",
    "body",
    "drape",
    "picture",
    "interchange",
    "marker",
    "reference",
    "flatten",
    "session",
];

/// Ours that the suite of tests uses: all of the libraries, and the window.
const TESTED: [&str; 16] = [
    "house",
    "geometry",
    "measure",
    "fabric",
    "pattern",
    "cut",
    "assembly",
    "nesting",
    "body",
    "drape",
    "picture",
    "interchange",
    "marker",
    "reference",
    "session",
    "ui",
];

/// The lowest libraries.
const fn lowest(count: usize) -> &'static [&'static str] {
    LIBRARIES.split_at(count).0
}

/// Which of our packages each may use. The arrows of docs/ARCHITECTURE.md, and nothing else.
const LAYERS: [(&str, &[&str]); 25] = [
    ("toile-realtime", &[]),
    ("toile-realtime-c", &["realtime"]),
    ("toile-geometry", &[]),
    ("toile-measure", &[]),
    ("toile-lettering", &[]),
    ("toile-fabric", &[]),
    ("toile-pattern", &["geometry", "measure", "fabric"]),
    ("toile-cut", &["geometry", "lettering", "pattern"]),
    (
        "toile-assembly",
        &["geometry", "measure", "sparse", "pattern"],
    ),
    ("toile-nesting", &["geometry"]),
    ("toile-body", &["geometry", "measure", "realtime"]),
    ("toile-sparse", &["geometry"]),
    ("toile-drape", &["geometry", "sparse", "fabric"]),
    (
        "toile-reference",
        &["geometry", "sparse", "fabric", "drape"],
    ),
    ("toile-flatten", &["geometry", "sparse", "drape"]),
    ("toile-picture", &["geometry", "lettering"]),
    ("toile-interchange", lowest(13)),
    (
        "toile-marker",
        &["geometry", "pattern", "cut", "nesting", "interchange"],
    ),
    ("toile-session", lowest(17)),
    ("toile", &["geometry", "measure", "session", "lab"]),
    ("toile-python", &["session"]),
    (
        "toile-ui",
        &[
            "geometry", "measure", "fabric", "pattern", "cut", "session", "picture",
        ],
    ),
    ("toile-house", &[]),
    ("toile-tests", &TESTED),
    ("toile-lab", lowest(18)),
];

/// What may stand at the top level besides dot-files.
const TOP_LEVEL: [&str; 11] = [
    "Cargo.toml",
    "Cargo.lock",
    "README.md",
    "LICENSE-MIT",
    "LICENSE-APACHE",
    "crates",
    "patterns",
    "ui",
    "tests",
    "docs",
    "target",
];

/// Lines a source file may have: about one screenful of ideas.
const MAX_FILE_LINES: usize = 600;

fn manifests() -> Vec<(String, toml::Table)> {
    let mut found = Vec::new();
    for path in files_below(&root(), "Cargo.toml") {
        let text = fs::read_to_string(&path).expect("readable");
        let table: toml::Table = text.parse().expect("a manifest is TOML");
        if let Some(package) = table.get("package") {
            let name = package["name"]
                .as_str()
                .expect("a package has a name")
                .to_owned();
            found.push((name, table));
        }
    }
    assert!(found.len() >= 13, "only {} manifests found", found.len());
    found
}

#[test]
fn packages_use_only_the_layers_below_them() {
    let allowed: BTreeMap<_, _> = LAYERS.iter().copied().collect();
    for (name, manifest) in manifests() {
        let below = allowed
            .get(name.as_str())
            .unwrap_or_else(|| panic!("{name} has no place in LAYERS"));
        let empty = toml::Table::new();
        let dependencies = manifest
            .get("dependencies")
            .and_then(|d| d.as_table())
            .unwrap_or(&empty);
        for dependency in dependencies.keys().filter_map(|d| d.strip_prefix("toile-")) {
            assert!(
                below.contains(&dependency),
                "{name} must not use toile-{dependency}"
            );
        }
    }
}

#[test]
fn every_package_takes_the_common_lints() {
    for (name, manifest) in manifests() {
        let takes = manifest
            .get("lints")
            .and_then(|l| l.get("workspace"))
            .and_then(toml::Value::as_bool);
        assert_eq!(takes, Some(true), "{name} needs [lints] workspace = true");
    }
}

/// The table of a manifest at a path of keys.
fn table_at<'a>(manifest: &'a toml::Table, keys: &[&str]) -> &'a toml::Table {
    let mut table = manifest;
    for key in keys {
        table = table[*key].as_table().expect("a table");
    }
    table
}

#[test]
fn the_python_module_takes_lints_and_profiles_of_the_workspace() {
    let read = |place: &str| -> toml::Table {
        let text = fs::read_to_string(root().join(place)).expect("readable");
        text.parse().expect("a manifest is TOML")
    };
    let (whole, own) = (read("Cargo.toml"), read("crates/python/Cargo.toml"));
    for keys in [&["workspace", "lints"][..], &["profile"]] {
        assert_eq!(table_at(&whole, keys), table_at(&own, keys), "{keys:?}");
    }
    let common = table_at(&whole, &["workspace", "package"]);
    for key in ["version", "edition", "rust-version", "license", "publish"] {
        assert_eq!(common[key], own["package"][key], "{key}");
    }
}

/// Versions of packages in a lock, by name.
fn locked(place: &str) -> BTreeMap<String, BTreeSet<String>> {
    let text = fs::read_to_string(root().join(place)).expect("readable");
    let lock: toml::Table = text.parse().expect("a lock is TOML");
    let mut versions: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in lock["package"].as_array().expect("a list of packages") {
        let word = |key: &str| package[key].as_str().expect("a text").to_owned();
        versions
            .entry(word("name"))
            .or_default()
            .insert(word("version"));
    }
    versions
}

#[test]
fn the_python_module_is_built_of_the_same_versions() {
    let (whole, own) = (locked("Cargo.lock"), locked("crates/python/Cargo.lock"));
    let other: Vec<_> = own
        .iter()
        .filter(|(name, versions)| {
            whole
                .get(*name)
                .is_some_and(|known| !versions.is_subset(known))
        })
        .collect();
    assert!(
        other.is_empty(),
        "take these as the main lock has them: {other:?}"
    );
}

#[test]
fn every_dependency_is_named_with_its_reason() {
    let text = fs::read_to_string(root().join("docs/ARCHITECTURE.md")).expect("readable");
    let mut used = BTreeSet::new();
    for (_, manifest) in manifests() {
        for section in ["dependencies", "dev-dependencies"] {
            let Some(table) = manifest.get(section).and_then(|d| d.as_table()) else {
                continue;
            };
            used.extend(table.keys().filter(|k| !k.starts_with("toile")).cloned());
        }
    }
    for dependency in used {
        assert!(
            text.contains(&format!("`{dependency}`")),
            "docs/ARCHITECTURE.md does not say why {dependency} is used"
        );
    }
}

/// What grows an outline, or makes a region of grown loops.
const GROWING: [&str; 2] = ["offset", "wound_region"];

#[test]
fn no_crate_but_cut_offsets_an_outline() {
    let mut growing = Vec::new();
    let mut seen = 0;
    for folder in ["crates", "ui"] {
        for path in files_below(&root().join(folder), ".rs") {
            // The laboratory makes regions of shadows, not of pieces.
            let apart = |c: std::path::Component<'_>| {
                ["geometry", "lab"].iter().any(|f| c.as_os_str() == *f)
            };
            let own = path.components().any(apart);
            let text = fs::read_to_string(&path).expect("readable");
            let words = used_of_geometry(&text);
            let grows = words.iter().any(|word| GROWING.contains(word));
            if grows && path.components().any(|c| c.as_os_str() == "cut") {
                seen += 1;
            } else if grows && !own {
                growing.push(path.display().to_string());
            }
        }
    }
    assert!(seen > 0, "crate cut is not seen to grow outlines");
    assert!(
        growing.is_empty(),
        "take `CutPiece` of crate cut instead of growing outlines in {growing:?}"
    );
}

/// Names that a file takes from our geometry, or calls there by path.
fn used_of_geometry(text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    for after in text.split("toile_geometry::").skip(1) {
        let end = match after.starts_with('{') {
            true => after.find('}'),
            false => after.find(|c: char| !c.is_alphanumeric() && c != '_'),
        };
        let names = &after[..end.unwrap_or(after.len())];
        let split = names.split(|c: char| !c.is_alphanumeric() && c != '_');
        words.extend(split.filter(|word| !word.is_empty()));
    }
    words
}

/// The words in backticks of a line.
fn quoted(line: &str) -> impl Iterator<Item = &str> {
    line.split('`').skip(1).step_by(2)
}

/// Complaints about source files and folders that a page names in backticks and that are not there: each
/// must be the end of a path in the project.
fn lost_places(page: &str, sources: &[String]) -> Vec<String> {
    let is_there = |word: &str| {
        let end = format!("/{word}");
        match word.ends_with('/') {
            true => sources.iter().any(|path| path.contains(&end)),
            false => sources.iter().any(|path| path.ends_with(&end)),
        }
    };
    let words = page.lines().flat_map(quoted);
    let places = words.filter(|word| word.ends_with(".rs") || word.ends_with('/'));
    places
        .filter(|word| !is_there(word))
        .map(|word| format!("there is no `{word}`"))
        .collect()
}

#[test]
fn documents_name_places_that_are_there() {
    let sources: Vec<String> = files_below(&root(), ".rs")
        .iter()
        .map(|path| path.display().to_string().replace('\\', "/"))
        .collect();
    let mut pages = files_below(&root().join("docs/methods"), ".md");
    pages.push(root().join("docs/ARCHITECTURE.md"));
    let mut complaints = Vec::new();
    for page in &pages {
        let text = fs::read_to_string(page).expect("readable");
        let lost = lost_places(&text, &sources);
        complaints.extend(
            lost.into_iter()
                .map(|what| format!("{}: {what}", page.display())),
        );
    }
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

#[test]
fn places_and_names_that_are_gone_are_told() {
    let sources = ["/toile/crates/drape/src/merge.rs".to_owned()];
    let page = "`merge.rs`, `drape/src/` and `erge.rs`, `src/drape/`, `gone.rs`";
    let lost = ["erge.rs", "src/drape/", "gone.rs"].map(|word| format!("there is no `{word}`"));
    assert_eq!(lost_places(page, &sources), lost);
}

/// Words that the page of architecture may have: it is read before the first line of code.
const MAX_WORDS: usize = 3_200;

#[test]
fn the_page_of_architecture_stays_short() {
    let page = fs::read_to_string(root().join("docs/ARCHITECTURE.md")).expect("readable");
    let words = page.split_whitespace().count();
    assert!(words <= MAX_WORDS, "docs/ARCHITECTURE.md has {words} words");
    assert!(
        !page.contains("by hand"),
        "a list that is kept by hand is coded away"
    );
}

#[test]
fn source_files_stay_short() {
    for path in files_below(&root(), ".rs") {
        let lines = fs::read_to_string(&path).expect("readable").lines().count();
        assert!(
            lines <= MAX_FILE_LINES,
            "{} has {lines} lines: divide it",
            path.display()
        );
    }
}

#[test]
fn nothing_stray_at_the_top_level() {
    for entry in fs::read_dir(root()).expect("readable").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let known = name.starts_with('.') || name == "out" || TOP_LEVEL.contains(&name.as_str());
        assert!(known, "{name} does not belong at the top level");
    }
}

#[test]
fn nothing_is_left_undone_in_the_code() {
    let words = [
        "todo!(",
        "unimplemented!(",
        "FIX\u{4d}E",
        "TO\u{44}O",
        "HA\u{43}K",
        "#[ign\u{6f}re",
    ];
    for path in files_below(&root(), ".rs") {
        let text = fs::read_to_string(&path).expect("readable");
        for word in words {
            // This very list is spelled so that it does not find itself.
            let own = path.ends_with("suite/house_rules.rs");
            assert!(
                own || !text.contains(word),
                "{} contains {word}",
                path.display()
            );
        }
    }
}

/// Whether a comment gives a unit in parentheses, as in (m), (N s/m) or (1).
fn has_unit(doc: &str) -> bool {
    const UNITS: [&str; 22] = [
        "m",
        "mm",
        "cm",
        "rad",
        "deg",
        "degrees",
        "s",
        "ms",
        "N",
        "J",
        "W",
        "kg",
        "mg",
        "gf",
        "1",
        "%",
        "pixels",
        "pixel",
        "bytes",
        "characters",
        "cells",
        "stature",
    ];
    doc.split('(').skip(1).any(|inside| {
        let first = inside
            .split([')', ' ', '/', ','])
            .next()
            .unwrap_or_default();
        UNITS.contains(&first.trim_end_matches(|c: char| ('2'..='4').contains(&c)))
    })
}

/// Public floating-point fields of the crates that carry physical quantities must say their unit
/// in parentheses, or that they are a ratio, share, weight, count or the like.
#[test]
fn public_numbers_say_their_unit() {
    let unitless = [
        "share",
        "ratio",
        "weight",
        "fraction",
        "efficiency",
        "coefficient",
        "parameter",
        "strain",
        "stretch",
        "scale",
        "factor",
        "0..=1",
        "number",
        "residual",
        "cosine",
        "opacity",
        "tangent of",
        "sRGB",
        "relative",
        "net force over",
        "barycentric",
        "value",
        "shortening",
        "error",
        "share",
    ];
    let mut missing = Vec::new();
    for folder in [
        "geometry",
        "pattern",
        "cut",
        "assembly",
        "nesting",
        "body",
        "sparse",
        "drape",
        "reference",
        "flatten",
    ] {
        for path in files_below(&root().join("crates").join(folder).join("src"), ".rs") {
            let text = fs::read_to_string(&path).expect("readable");
            let mut doc = String::new();
            // Whether the type is public, and whether its own words give the unit of all its fields.
            let (mut public, mut said_above) = (false, false);
            for line in text.lines().map(str::trim) {
                if let Some(rest) = line.strip_prefix("///") {
                    doc.push_str(rest);
                } else if line.starts_with("#[") {
                    continue;
                } else {
                    if line.contains("struct ") {
                        public = line.starts_with("pub struct ");
                        said_above = has_unit(&doc);
                    }
                    let field = line.strip_prefix("pub ").and_then(|l| l.strip_suffix(','));
                    let is_number = field.is_some_and(|f| {
                        [
                            ": f64",
                            ": [f64; 2]",
                            ": [f64; 3]",
                            ": Vec2",
                            ": Vec3",
                            ": Vec<f64>",
                            ": Vec<Vec3>",
                        ]
                        .iter()
                        .any(|end| f.ends_with(end))
                    });
                    let lower = doc.to_lowercase();
                    let said = has_unit(&doc)
                        || unitless.iter().any(|w| lower.contains(&w.to_lowercase()))
                        || lower.contains("unit ")
                        || lower.contains("normal")
                        || lower.contains("direction");
                    if is_number && public && !said_above && !said {
                        missing.push(format!("{}: {line}", path.display()));
                    }
                    doc.clear();
                }
            }
        }
    }
    assert!(
        missing.is_empty(),
        "no unit in the docs of:\n{}",
        missing.join("\n")
    );
}

/// Ways to begin the name of a bound, each with the word that the house has for it.
const NAMES_OF_BOUNDS: [(&str, &str); 7] = [
    ("MOST_", "MAX_"),
    ("LARGEST_", "MAX_"),
    ("LONGEST_", "MAX_"),
    ("DEEPEST_", "MAX_"),
    ("LEAST_", "MIN_"),
    ("SMALLEST_", "MIN_"),
    ("USUAL_", "DEFAULT_"),
];

#[test]
fn bounds_and_defaults_are_named_by_one_word_each() {
    let mut other = Vec::new();
    for path in files_below(&root(), ".rs") {
        let text = fs::read_to_string(&path).expect("readable");
        let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        for word in words {
            for (start, ours) in NAMES_OF_BOUNDS {
                if word.len() > start.len() && word.starts_with(start) {
                    other.push(format!("{}: {word}: say {ours}", path.display()));
                }
            }
        }
    }
    assert!(other.is_empty(), "{}", other.join("\n"));
}
