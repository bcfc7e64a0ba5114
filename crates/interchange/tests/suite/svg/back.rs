//! Patterns written as SVG and read again: the same document, and panels that were edited as drawn.

use crate::knife::patterns::star_pattern;
use crate::random_pattern::{Dice, random_pattern};
use crate::svg::{drafted, read, read_with};
use std::path::{Path, PathBuf};
use toile_geometry::Vec2;
use toile_interchange::{
    Fitting, Format, ReadOptions, SizedDraft, WriteSource, read_pattern, write,
};
use toile_measure::Measurements;
use toile_pattern::{DisplayUnit, Evaluation, Panel, Pattern, plan};

pub fn shirt() -> String {
    svg_of(&t_shirt(), None).unwrap()
}

fn t_shirt() -> Pattern {
    let mut all = shipped().into_iter();
    all.find(|(name, _)| name.starts_with("t-shirt")).unwrap().1
}

fn shipped() -> Vec<(String, Pattern)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.to_string_lossy().ends_with(".toile.json"))
        .collect();
    files.sort();
    let of = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(path).unwrap();
        (name, read_pattern(&text).unwrap().0)
    };
    files.iter().map(of).collect()
}

/// A pattern written in a size; `None` if it cannot be drawn.
pub fn svg_of(pattern: &Pattern, size: Option<&str>) -> Option<String> {
    let drafts = [SizedDraft {
        size: size.map(str::to_owned),
        draft: drafted(pattern, size),
    }];
    let source = WriteSource {
        pattern,
        fitting: &Fitting::default(),
        drafts: &drafts,
    };
    let writing = write(&source, Format::Svg).ok()?;
    assert_eq!(writing.losses, []);
    Some(String::from_utf8(writing.files[0].bytes.clone()).unwrap())
}

fn assert_same(found: &Pattern, expected: &Pattern, place: &str) {
    assert!(found.says_the_same(expected), "{place}");
}

#[test]
fn shipped_patterns_come_back_whole_in_every_size() {
    for (name, pattern) in shipped() {
        let mut sizes: Vec<Option<&str>> = pattern
            .sizes
            .iter()
            .map(|size| Some(size.name.as_str()))
            .collect();
        if sizes.is_empty() {
            sizes.push(None);
        }
        for size in sizes {
            let text = svg_of(&pattern, size).unwrap();
            let reading = read(&text).unwrap();
            let place = format!("{name} in {size:?}");
            assert_same(&reading.pattern, &pattern, &place);
            assert!(
                reading.notes.is_empty() && reading.losses.is_empty(),
                "{place}"
            );
            assert_eq!(reading.guesses, []);
        }
    }
}

#[test]
fn layers_and_kinds_are_named() {
    let text = shirt();
    for words in [
        "inkscape:groupmode=\"layer\" inkscape:label=\"front\" data-toile-panel=\"front\"",
        "inkscape:label=\"cut\"",
        "inkscape:label=\"sew\"",
        "inkscape:label=\"grain\"",
        "data-toile-kind=\"sew\" stroke=\"#0044aa\"",
        "data-toile-kind=\"cut\" stroke=\"#d40000\"",
    ] {
        assert!(text.contains(words), "{words}");
    }
}

/// Lines of the file that draw paths of a kind, with the panel of each.
fn paths(text: &str, kind: &str) -> Vec<(usize, String)> {
    let mut panel = String::new();
    let mut found = Vec::new();
    for (k, line) in text.lines().enumerate() {
        if let Some((_, rest)) = line.split_once("data-toile-panel=\"") {
            let name = rest.split('"').next().unwrap().replace("&quot;", "\"");
            panel = name
                .replace("&lt;", "<")
                .replace("&gt;", ">")
                .replace("&amp;", "&");
        }
        if line.contains(&format!("data-toile-kind=\"{kind}\"")) {
            found.push((k, panel.clone()));
        }
    }
    found
}

/// The text with one node of the path on a line moved by 0.5 and 0.3 mm; `None` if the path has no straight way.
fn with_moved_node(text: &str, line: usize) -> Option<String> {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let own = &lines[line];
    let at = own.find(" d=\"")?;
    let from = at + own[at..].find('L')? + 1;
    let end = from + own[from..].find(|c: char| c.is_ascii_alphabetic() || c == '"')?;
    let (x, y) = own[from..end].split_once(' ')?;
    let [x, y]: [f64; 2] = [x.parse().ok()?, y.parse().ok()?];
    let moved = format!("{} {}", x + 0.5, y + 0.3);
    lines[line] = format!("{}{moved}{}", &own[..from], &own[end..]);
    Some(lines.join("\n"))
}

fn without_place(panel: &Panel) -> Panel {
    Panel {
        on_table: None,
        ..panel.clone()
    }
}

/// Checks that a panel came in as drawn and all others are as they were.
fn assert_edited(found: &Pattern, expected: &Pattern, edited: &str, place: &str) {
    assert_eq!(found.panels.len(), expected.panels.len(), "{place}");
    for (own, before) in found.panels.iter().zip(&expected.panels) {
        assert_eq!(own.name, before.name, "{place}");
        match own.name == edited {
            false => assert_eq!(own, before, "{place}"),
            true => {
                assert_ne!(own.lines, before.lines, "{place}");
                assert!(own.operations.is_empty(), "{place}");
                assert_eq!((own.id, own.fabric), (before.id, before.fabric), "{place}");
                assert_eq!((own.cut, &own.worn), (before.cut, &before.worn), "{place}");
            }
        }
    }
    assert_eq!(found.variables, expected.variables, "{place}");
    assert_eq!(found.sizes, expected.sizes, "{place}");
    assert!(found.sheets.len() == expected.sheets.len() + 1, "{place}");
    let names = |seam: &toile_pattern::Seam| {
        let mut spans = seam.sides.iter().flatten();
        spans.any(|span| {
            found
                .panel(span.panel)
                .is_none_or(|panel| panel.name == edited)
        })
    };
    let kept: Vec<_> = expected.seams.iter().filter(|seam| !names(seam)).collect();
    assert_eq!(found.seams.iter().collect::<Vec<_>>(), kept, "{place}");
}

#[test]
fn one_node_moved_makes_that_panel_drawn_and_leaves_all_others() {
    let mut count = 0;
    for (name, pattern) in shipped() {
        let size = pattern.base().map(|size| size.name.clone());
        let text = svg_of(&pattern, size.as_deref()).unwrap();
        for kind in ["sew", "cut", "internal", "notch", "grain"] {
            for (line, panel) in paths(&text, kind) {
                let Some(edited) = with_moved_node(&text, line) else {
                    continue;
                };
                let reading = read(&edited).unwrap();
                let place = format!("{name}, {kind} of {panel}");
                assert_edited(&reading.pattern, &pattern, &panel, &place);
                let told = reading
                    .losses
                    .iter()
                    .any(|loss| loss.place == panel && loss.why.contains("comes in as drawn"));
                assert!(told, "{place}: {:?}", reading.losses);
                count += 1;
                // The piece is as large as it was drawn.
                let area = |pattern: &Pattern| {
                    let draft = drafted(pattern, size.as_deref());
                    let id = pattern.panel_named(&panel).unwrap().id;
                    let piece = draft
                        .pieces
                        .iter()
                        .find(|piece| piece.id.panel == id)
                        .unwrap();
                    0.5 * piece
                        .outline
                        .iter()
                        .map(|edge| edge.curve.swept_area())
                        .sum::<f64>()
                };
                let [before, after] = [&pattern, &reading.pattern].map(area);
                assert!((before - after).abs() < 1e-3, "{place}: {before} {after}");
                let is_sewn = kind == "sew" || (before - after).abs() < 5e-6;
                assert!(is_sewn, "{place}: {before} {after}");
            }
        }
    }
    println!("{count} panels edited");
    assert!(count > 60, "{count}");
}

/// A pattern of two panels at random.
fn two_stars(seed: u64) -> Pattern {
    let star = |seed| {
        let mut star = star_pattern(seed);
        // Its notches have ids of their own.
        star.ids.next = 1_000_000;
        star
    };
    let mut pattern = star(seed);
    let evaluated = |pattern: &Pattern| Evaluation::new(pattern, &Measurements::adult());
    let other = evaluated(&star(seed + 1_000));
    let pasted = plan::insert_pattern(&evaluated(&pattern), &other, [3.0, 0.0]).unwrap();
    pattern.apply(&pasted.edits).unwrap();
    pattern
}

#[test]
fn random_patterns_come_back_whole_and_one_panel_edited() {
    let (mut written, mut edited) = (0, 0);
    for seed in 0..200 {
        let pattern = two_stars(seed);
        let Some(text) = svg_of(&pattern, None) else {
            continue;
        };
        written += 1;
        let reading = read(&text).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        assert_same(&reading.pattern, &pattern, &format!("seed {seed}"));
        let sewn = paths(&text, "sew");
        let (line, panel) = &sewn[Dice::new(seed).below(sewn.len())];
        if let Some(moved) = with_moved_node(&text, *line) {
            let reading = read(&moved).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
            let lines = |pattern: &Pattern| pattern.panel_named(panel).unwrap().lines.clone();
            assert_ne!(lines(&reading.pattern), lines(&pattern), "seed {seed}");
            let others = |pattern: &Pattern| -> Vec<Panel> {
                let others = pattern.panels.iter().filter(|other| other.name != *panel);
                others.map(|panel| without_place(panel)).collect()
            };
            assert_eq!(others(&reading.pattern).len(), 1);
            assert_eq!(others(&reading.pattern), others(&pattern), "seed {seed}");
            edited += 1;
        }
    }
    println!("{written} written, {edited} edited");
    assert!(written >= 100 && edited >= 80, "{written} {edited}");
}

/// Patterns at random whose panels may not be drawn at all: those that are come back.
#[test]
fn nonsense_comes_back_where_it_can_be_written() {
    let mut written = 0;
    for seed in 0..400 {
        let pattern = random_pattern(&mut Dice::new(seed));
        let size = pattern.sizes.first().map(|size| size.name.clone());
        let Some(text) = svg_of(&pattern, size.as_deref()) else {
            continue;
        };
        written += usize::from(text.contains("data-toile-panel"));
        // The native format itself makes the same of it.
        let native = toile_interchange::write_pattern(&pattern).unwrap();
        let expected = read_pattern(&native).unwrap().0;
        let reading = read(&text).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        assert_same(&reading.pattern, &expected, &format!("seed {seed}"));
    }
    println!("{written} written");
    assert!(written > 0);
}

#[test]
fn another_frame_of_coordinates_changes_nothing() {
    let pattern = t_shirt();
    let text = shirt();
    // As an editor saves it that counts in pixels: other units, a turn of the axes, relative paths.
    let root = text.find("viewBox=\"").unwrap() + "viewBox=\"".len();
    let end = root + text[root..].find('"').unwrap();
    let numbers: Vec<f64> = text[root..end]
        .split(' ')
        .map(|n| n.parse().unwrap())
        .collect();
    let scale = 96.0 / 25.4;
    let scaled: Vec<String> = numbers.iter().map(|n| (n * scale).to_string()).collect();
    let body = text.find("</metadata>").unwrap() + "</metadata>".len();
    let other = format!(
        "{}{}{}<g transform=\"scale({scale})\">{}</g></svg>",
        &text[..root],
        scaled.join(" "),
        &text[end..body],
        text[body..].trim_end().trim_end_matches("</svg>")
    );
    let reading = read(&other).unwrap();
    assert_same(&reading.pattern, &pattern, "scaled");
    assert!(reading.notes.is_empty() && reading.losses.is_empty());
}

#[test]
fn panels_that_are_moved_hidden_or_copied_are_told() {
    let pattern = t_shirt();
    let text = shirt();
    let layer = "data-toile-panel=\"front\"";
    let moved = text.replace(layer, &format!("{layer} transform=\"translate(30 -20)\""));
    let reading = read(&moved).unwrap();
    assert_eq!(reading.losses, []);
    assert_eq!(reading.notes.len(), 1, "{:?}", reading.notes);
    let front = reading.pattern.panel_named("front").unwrap();
    let before = pattern.panel_named("front").unwrap();
    assert_eq!(without_place(front), without_place(before));
    let from = before.on_table.map_or(Vec2::zeros(), Vec2::from);
    let by = Vec2::from(front.on_table.unwrap()) - from;
    assert!((by - Vec2::new(0.03, 0.02)).norm() < 1e-5, "{by}");
    let hidden = text.replace(layer, &format!("{layer} style=\"display:none\""));
    let reading = read(&hidden).unwrap();
    assert_same(&reading.pattern, &pattern, "hidden");
    assert!(
        reading.notes[0].contains("does not show it"),
        "{:?}",
        reading.notes
    );
    let further = "<path id=\"patch\" d=\"M5000 0h300v300h-300z\"/></svg>";
    let more = text.replace("</svg>", further);
    let reading = read(&more).unwrap();
    assert_eq!(reading.pattern.panels.len(), pattern.panels.len() + 1);
    assert!(reading.pattern.panel_named("patch").is_some());
    assert!(
        reading.notes[0].contains("new in the drawing"),
        "{:?}",
        reading.notes
    );
}

#[test]
fn without_its_metadata_a_file_is_read_by_its_layers() {
    for (name, pattern) in shipped() {
        let text = svg_of(&pattern, pattern.base().map(|size| size.name.as_str())).unwrap();
        let (from, to) = (
            text.find("<metadata").unwrap(),
            text.find("</metadata>").unwrap(),
        );
        let plain = format!("{}{}", &text[..from], &text[to + "</metadata>".len()..]);
        let reading = read(&plain).unwrap();
        let names = |pattern: &Pattern| -> Vec<String> {
            let drawn = pattern.panels.iter().filter(|panel| !panel.is_split());
            drawn.map(|panel| panel.name.clone()).collect()
        };
        assert_eq!(names(&reading.pattern), names(&pattern), "{name}");
        assert_eq!(reading.guesses, [], "{name}");
    }
}

#[test]
fn answers_that_a_file_of_this_program_gives_itself_are_refused() {
    let asked = ReadOptions {
        unit: Some(DisplayUnit::Inch),
        ..ReadOptions::default()
    };
    let error = read_with(&shirt(), &asked).unwrap_err();
    assert!(error.what.contains("--unit"), "{error}");
}
