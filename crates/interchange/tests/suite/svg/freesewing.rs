//! Patterns that FreeSewing drew, read from SVG, against the exact lengths and areas that it computed.

use serde_json::Value;
use std::path::{Path, PathBuf};
use toile_cut::{CutOptions, CutPiece};
use toile_geometry::{Bounds2, Curve, Vec2};
use toile_interchange::{Format, ReadOptions, Reading, read};
use toile_measure::Measurements;
use toile_pattern::{Draft, Evaluation, Number, OperationKind, Panel, Pattern, Piece, Wearer};

/// Largest difference of a length (m).
const LENGTH: f64 = 5e-5;
/// Largest difference of an area (m2), as a share of it, and in proportion to the length of its outline (m): the
/// coordinates in the files are rounded to 0.01 mm.
const AREA: f64 = 1e-6;
const AREA_SHARE: f64 = 1e-5;
const ROUNDED: f64 = 3e-6;
/// Largest distance of a notch from its place (m).
const PLACE: f64 = 5e-5;
/// Distance from the sew line within which a sign marks an edge (m).
const ON_LINE: f64 = 1e-3;

/// The folder of the drawings.
fn folder() -> Option<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut folders = here.ancestors().map(|up| up.join("shared/data/freesewing"));
    let found = folders.find(|folder| folder.is_dir());
    let found = found.or_else(|| {
        let data = PathBuf::from(std::env::var_os("TOILE_DATA")?).join("freesewing");
        data.is_dir().then_some(data)
    });
    if found.is_none() {
        println!("skipped: there is no ../shared/data/freesewing");
    }
    found
}

fn draft(pattern: &Pattern) -> Draft {
    let wearer = Wearer {
        measurements: Measurements::adult(),
        size: None,
    };
    Evaluation::new(pattern, wearer).draft().0
}

/// A drawing with what FreeSewing computed.
struct Sample {
    name: String,
    reading: Reading,
    draft: Draft,
    parts: serde_json::Map<String, Value>,
}

fn samples(folder: &Path, ending: &str) -> Vec<Sample> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.to_string_lossy().ends_with(&format!("{ending}.svg")))
        .collect();
    files.sort();
    let of = |path: &PathBuf| {
        let bytes = std::fs::read(path).unwrap();
        let reading = read(&bytes, &ReadOptions::default(), &[]).unwrap();
        let json = std::fs::read_to_string(path.with_extension("json")).unwrap();
        let json: Value = serde_json::from_str(&json).unwrap();
        Sample {
            name: path.file_stem().unwrap().to_string_lossy().into_owned(),
            draft: draft(&reading.pattern),
            reading,
            parts: json["parts"].as_object().unwrap().clone(),
        }
    };
    files.iter().map(of).collect()
}

/// The curves of a path's first stretch (m, y up), closed if it returns.
fn curves(subpath: &Value) -> Vec<Curve> {
    let mut curves = Vec::new();
    let (mut first, mut at) = (Vec2::zeros(), Vec2::zeros());
    for op in subpath["ops"].as_array().unwrap() {
        let number = |k: usize| op[k].as_f64().unwrap() * 1e-3;
        let point = |k: usize| Vec2::new(number(k), -number(k + 1));
        let from = at;
        match op[0].as_str().unwrap() {
            "M" => {
                at = point(1);
                first = at;
                continue;
            }
            "L" => at = point(1),
            "C" => {
                at = point(5);
                curves.push(Curve::Cubic {
                    start: from,
                    controls: [point(1), point(3)],
                    end: at,
                });
                continue;
            }
            "Z" => at = first,
            other => panic!("{other}"),
        }
        if from != at {
            curves.push(Curve::Line {
                start: from,
                end: at,
            });
        }
    }
    curves
}

fn length(curves: &[Curve]) -> f64 {
    curves.iter().map(Curve::length).sum()
}

fn area(curves: &[Curve]) -> f64 {
    0.5 * curves.iter().map(Curve::swept_area).sum::<f64>().abs()
}

/// The sew line of a part as computed.
fn sew_line(part: &Value) -> Option<Vec<Curve>> {
    let paths = part["paths"].as_object()?;
    let path = paths.get("seam").or(paths.get("outline"))?;
    Some(curves(&path["subpaths"][0]))
}

/// A panel with its piece.
fn panel<'a>(sample: &'a Sample, part: &str) -> (&'a Panel, &'a Piece) {
    let name = part.rsplit('.').next().unwrap();
    let panel = sample.reading.pattern.panel_named(name);
    let panel = panel.unwrap_or_else(|| panic!("{}: {part}", sample.name));
    let mut pieces = sample.draft.pieces.iter();
    let piece = pieces.find(|piece| piece.id.panel == panel.id && piece.id.copy == 0);
    (panel, piece.unwrap())
}

fn is_folded(panel: &Panel) -> bool {
    let is_fold = |kind: &OperationKind| matches!(kind, OperationKind::Fold { .. });
    panel
        .operations
        .iter()
        .any(|operation| is_fold(&operation.kind))
}

/// The half of an outline as drawn, with the fold.
fn half(panel: &Panel, piece: &Piece) -> Vec<Curve> {
    let own = piece.outline.iter().filter(|edge| edge.origin.half == 0);
    let mut curves: Vec<Curve> = own.map(|edge| edge.curve).collect();
    if is_folded(panel) {
        // The unfolded outline begins anywhere: the half is turned to begin after the fold.
        let gap = |k: usize| {
            let next = (k + 1) % curves.len();
            (curves[k].end() - curves[next].start()).norm()
        };
        let k = (0..curves.len())
            .max_by(|&a, &b| gap(a).total_cmp(&gap(b)))
            .unwrap();
        let start = curves[k].end();
        let end = curves[(k + 1) % curves.len()].start();
        curves.push(Curve::Line { start, end });
    }
    curves
}

fn bounds(curves: &[Curve]) -> Bounds2 {
    Bounds2::of(curves.iter().flat_map(|curve| [curve.start(), curve.end()]))
}

/// Places of the notches of a part (m, y up).
fn signs(part: &Value) -> Vec<Vec2> {
    let all = part["snippets"].as_array().unwrap();
    let notches = all
        .iter()
        .filter(|sign| ["notch", "bnotch"].contains(&sign["def"].as_str().unwrap()));
    notches
        .map(|sign| Vec2::new(sign["x"].as_f64().unwrap(), -sign["y"].as_f64().unwrap()) * 1e-3)
        .collect()
}

fn distance(p: Vec2, curves: &[Curve]) -> f64 {
    let points = curves.iter().map(|curve| curve.flatten(1e-6));
    let chords = points.flat_map(|points| {
        let pairs: Vec<f64> = points
            .windows(2)
            .map(|pair| (toile_geometry::closest_on_segment(p, [pair[0], pair[1]]) - p).norm())
            .collect();
        pairs
    });
    chords.fold(f64::INFINITY, f64::min)
}

#[test]
fn sew_lines_folds_grains_and_notches_are_those_that_were_computed() {
    let Some(folder) = folder() else { return };
    let (mut parts, mut folds, mut grains, mut notches) = (0, 0, 0, 0);
    let mut worst = [0.0_f64; 3];
    let mut faults = Vec::new();
    let mut all = samples(&folder, "_seam");
    all.extend(samples(&folder, "_sa10mm"));
    assert_eq!(all.len(), 48);
    for sample in &all {
        assert_eq!(sample.reading.format, Format::Svg);
        let stated = sample
            .reading
            .guesses
            .iter()
            .all(|guess| guess.what != "unit");
        assert!(stated, "{}: its unit is stated", sample.name);
        let mut expected_panels = 0;
        for (name, part) in &sample.parts {
            let Some(expected) = sew_line(part) else {
                continue;
            };
            expected_panels += 1;
            let (panel, piece) = panel(sample, name);
            let own = half(panel, piece);
            let [l, a] = [length(&expected), area(&expected)];
            let whole = |area: f64| AREA.max(AREA_SHARE * area).max(ROUNDED * l);
            let off = [(length(&own) - l).abs(), (area(&own) - a).abs()];
            parts += 1;
            worst[0] = worst[0].max(off[0]);
            worst[1] = worst[1].max(off[1] / whole(a));
            if off[0] > LENGTH || off[1] > whole(a) {
                faults.push(format!(
                    "{} {name}: length {:.3} mm, area {:.3} mm2 off",
                    sample.name,
                    off[0] * 1e3,
                    off[1] * 1e6
                ));
            }
            // Folds and grains.
            let paths = part["paths"].as_object().unwrap();
            let has = |macro_name: &str| paths.keys().any(|key| key.contains(macro_name));
            if has("_cutonfold") != is_folded(panel) {
                faults.push(format!("{} {name}: its fold", sample.name));
            }
            folds += usize::from(is_folded(panel));
            if let Some((_, path)) = paths.iter().find(|(key, _)| key.contains("_grainline")) {
                let line = curves(&path["subpaths"][0]);
                let way = line[0].end() - line[0].start();
                let angle = way.y.atan2(way.x).rem_euclid(std::f64::consts::PI);
                let own = panel.grain == Number::from(angle) || (piece.grain - angle).abs() < 1e-3;
                if !own {
                    faults.push(format!(
                        "{} {name}: grain {} for {angle}",
                        sample.name, piece.grain
                    ));
                }
                grains += 1;
            }
            // Notches, after the part is moved to its place on the page. The unfolded piece has no edge on its
            // fold.
            let shift = bounds(&own).min - bounds(&expected).min;
            let fold = is_folded(panel).then(|| own[own.len() - 1]);
            let is_on_fold = |p: Vec2| {
                fold.is_some_and(|fold| {
                    let ends = [fold.start(), fold.end()];
                    let is_end = ends.iter().any(|end| (end - p).norm() <= ON_LINE);
                    distance(p, &[fold]) <= ON_LINE && !is_end
                })
            };
            let places: Vec<Vec2> = signs(part)
                .into_iter()
                .filter(|p| distance(*p, &expected) <= ON_LINE)
                .map(|p| p + shift)
                .filter(|p| !is_on_fold(*p))
                .collect();
            if panel.notches.len() != places.len() {
                faults.push(format!(
                    "{} {name}: {} notches of {}",
                    sample.name,
                    panel.notches.len(),
                    places.len()
                ));
            }
            for place in places {
                let near = |point: Vec2| (point - place).norm();
                let nearest = piece.notches.iter().map(|notch| near(notch.point));
                let nearest = nearest.fold(f64::INFINITY, f64::min);
                notches += 1;
                worst[2] = worst[2].max(nearest.min(1.0));
                if nearest > PLACE {
                    faults.push(format!(
                        "{} {name}: a notch is {:.3} mm off",
                        sample.name,
                        nearest * 1e3
                    ));
                }
            }
        }
        assert_eq!(
            sample.reading.pattern.panels.len(),
            expected_panels,
            "{}",
            sample.name
        );
    }
    println!(
        "{parts} parts, {folds} folds, {grains} grain lines, {notches} notches; worst: length {:.4} mm, area {:.3} of what is allowed, notch {:.4} mm",
        worst[0] * 1e3,
        worst[1],
        worst[2] * 1e3
    );
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The area that a line of the allowance encloses, closed along the fold; `None` where it goes round a part of the
/// sew line alone, or hems have widths of their own.
fn area_with_allowance(part: &Value) -> Option<f64> {
    let paths = part["paths"].as_object()?;
    let own: Vec<&Value> = paths
        .iter()
        .filter(|(key, path)| key.as_str() == "sa" && path["class"] == "fabric sa")
        .map(|(_, path)| path)
        .collect();
    let others = paths
        .values()
        .filter(|path| path["class"] == "fabric sa")
        .count();
    let [path] = own[..] else { return None };
    if others > 1 {
        return None;
    }
    let subpaths = path["subpaths"].as_array()?;
    let largest = subpaths
        .iter()
        .map(curves)
        .max_by(|a, b| length(a).total_cmp(&length(b)))?;
    let mut line = largest;
    let [start, end] = [line[line.len() - 1].end(), line[0].start()];
    line.push(Curve::Line { start, end });
    let sewn = area(&sew_line(part)?);
    Some(area(&line)).filter(|area| *area > sewn)
}

#[test]
fn allowances_of_ten_millimetres_cut_what_theirs_cut() {
    let Some(folder) = folder() else { return };
    let (mut parts, mut fine) = (0, 0);
    for sample in samples(&folder, "_sa10mm") {
        for (name, part) in &sample.parts {
            let Some(expected) = area_with_allowance(part) else {
                continue;
            };
            let (panel, piece) = panel(&sample, name);
            let number = sample
                .draft
                .pieces
                .iter()
                .position(|own| own.id == piece.id);
            let of = (&sample.reading.pattern, &sample.draft);
            let cut = CutPiece::new(of, number.unwrap(), (None, &CutOptions::default())).unwrap();
            let halves = if is_folded(panel) { 2.0 } else { 1.0 };
            let own = cut.outer().area() / halves;
            let share = own / expected - 1.0;
            parts += 1;
            match share.abs() <= 0.005 {
                true => fine += 1,
                false => println!("{} {name}: {:+.2} %", sample.name, share * 100.0),
            }
        }
    }
    println!("{fine} of {parts} parts within 0.5 %");
    assert!(parts >= 40 && fine * 10 >= parts * 9, "{fine} of {parts}");
}
