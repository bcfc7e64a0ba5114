//! Nests and grade rule tables in DXF: sizes by rules, written and read.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;
use toile_geometry::Vec2;
use toile_interchange::{
    Companion, Fitting, Format, FormatError, ReadOptions, Reading, SizedDraft, WriteSource,
    Writing, read, read_pattern, write,
};
use toile_measure::Measurements;
use toile_pattern::{
    Draft, Evaluation, GradeRule, Number, Pattern, PointId, PointRule, Severity, Wearer, plan,
};

fn shipped(name: &str) -> Pattern {
    let file = format!("../../patterns/{name}.toile.json");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    read_pattern(&std::fs::read_to_string(file).unwrap())
        .unwrap()
        .0
}

fn in_size(pattern: &Pattern, size: Option<&str>) -> Evaluation {
    let known = size.map(|name| pattern.size_named(name).unwrap());
    let wearer = Wearer {
        measurements: known.map_or_else(Measurements::adult, |size| size.measurements.clone()),
        size: known.map(|size| size.id),
    };
    Evaluation::new(pattern, wearer)
}

fn drafted(pattern: &Pattern, size: Option<&str>) -> Draft {
    in_size(pattern, size).draft().0
}

/// Drafts in all sizes, the base size first.
fn drafts(pattern: &Pattern) -> Vec<SizedDraft> {
    let mut sizes: Vec<_> = pattern.sizes.iter().collect();
    sizes.sort_by_key(|size| pattern.base().unwrap().id != size.id);
    let named = sizes.iter().map(|size| SizedDraft {
        size: Some(size.name.clone()),
        draft: drafted(pattern, Some(&size.name)),
    });
    named.collect()
}

fn written(pattern: &Pattern, format: Format) -> Writing {
    let drafts = drafts(pattern);
    let source = WriteSource {
        pattern,
        fitting: &Fitting::default(),
        drafts: &drafts,
    };
    write(&source, format).unwrap()
}

fn with(bytes: &[u8], table: &str) -> Result<Reading, FormatError> {
    let companion = Companion {
        name: "skirt.rul".to_owned(),
        bytes: table.as_bytes().to_vec(),
    };
    read(bytes, &ReadOptions::default(), &[companion])
}

/// The file without the blocks of other sizes.
fn of_size(text: &str, size: &str) -> String {
    let mut kept = String::new();
    for part in text.split_inclusive("0\nENDBLK\n8\n1\n") {
        let is_other = part.contains("\nSize") && !part.contains(&format!(": {size}\n"));
        let start = part.find("0\nBLOCK\n").filter(|_| is_other);
        kept += start.map_or(part, |start| &part[..start]);
    }
    kept
}

/// Largest distance between places of both outlines at equal shares of each edge of the first piece's (m).
fn outlines_apart(one: &Draft, other: &Draft) -> f64 {
    let mut most = 0.0f64;
    for piece in &one.pieces {
        let own = other.pieces.iter().find(|own| own.name == piece.name);
        let ring = |draft: &toile_pattern::Piece| -> Vec<Vec2> {
            let edges = draft.outline.iter();
            edges
                .flat_map(|edge| edge.curve.sample(0.0, 1.0, 4))
                .collect()
        };
        let (a, b) = (ring(piece), ring(own.unwrap()));
        for p in &a {
            let ends = b.iter().zip(b.iter().cycle().skip(1));
            let off = ends.map(|(&from, &to)| {
                (toile_geometry::closest_on_segment(*p, [from, to]) - p).norm()
            });
            most = most.max(off.fold(f64::INFINITY, f64::min));
        }
    }
    most
}

#[test]
fn corners_of_a_nest_get_rules_and_points_between_follow_them() {
    let pattern = shipped("t-shirt");
    let files = written(&pattern, Format::DxfAama).files;
    let start = Instant::now();
    let reading = read(&files[0].bytes, &ReadOptions::default(), &[]).unwrap();
    let time = start.elapsed();
    let back = reading.pattern;
    let rules = GradeRule::all(&back);
    assert!(rules.len() > 4, "{}", rules.len());
    assert_eq!(back.variables.len(), 2 * rules.len());
    println!("{} rules, read in {time:?}", rules.len());
    for sheet in &back.sheets {
        for point in &sheet.points {
            // No point has coordinates by size: corners have rules, others follow.
            if let PointRule::At { x, y } = &point.rule {
                let by_size = |n: &Number| matches!(n, Number::PerSize { .. });
                assert!(!by_size(x) && !by_size(y), "{}", point.name);
            }
        }
    }
    // A drag of a corner in the base size moves it alike in all sizes, and points between keep their shares.
    let panel = &back.panels[0];
    let sheet = back.sheet(panel.sheet().unwrap()).unwrap();
    let between = sheet
        .points
        .iter()
        .find_map(|point| match &point.rule {
            PointRule::Between { base, tip, .. } => {
                let graded = plan::rule_of(&back, *base).is_some();
                graded.then_some((point.id, *base, *tip))
            }
            _ => None,
        })
        .unwrap();
    let (point, corner, tip) = between;
    let base = back.base().unwrap().name.clone();
    let evaluation = in_size(&back, Some(&base));
    let by = Vec2::new(0.004, -0.003);
    let to = evaluation.point(corner).unwrap() + by;
    let mut dragged = back.clone();
    dragged
        .apply(&plan::move_point(&evaluation, corner, to).unwrap())
        .unwrap();
    let shares = |pattern: &Pattern, size: &str| {
        let sized = in_size(pattern, Some(size));
        let at = |id: PointId| sized.point(id).unwrap();
        let (way, out) = (at(tip) - at(corner), at(point) - at(corner));
        Vec2::new(out.dot(&way), way.perp(&out)) / way.norm_squared()
    };
    for size in &back.sizes {
        let place = |pattern: &Pattern| in_size(pattern, Some(&size.name)).point(corner).unwrap();
        let moved = place(&dragged) - place(&back);
        assert!((moved - by).norm() < 1e-12, "{}: {moved:?}", size.name);
        let change = shares(&dragged, &size.name) - shares(&back, &size.name);
        assert!(change.norm() < 1e-9, "{}: {change:?}", size.name);
    }
}

#[test]
fn a_nest_read_written_and_read_again_has_its_corners_and_its_document_stays_small() {
    for name in ["t-shirt", "trousers", "dress"] {
        let pattern = shipped(name);
        if pattern.sizes.len() < 2 {
            continue;
        }
        let read_back = |pattern: &Pattern| {
            let bytes = &written(pattern, Format::DxfAama).files[0].bytes;
            read(bytes, &ReadOptions::default(), &[]).unwrap().pattern
        };
        let once = read_back(&pattern);
        for size in &once.sizes {
            let evaluation = in_size(&once, Some(&size.name));
            let errors = evaluation.check();
            let error = errors.iter().find(|d| d.severity == Severity::Error);
            assert_eq!(error, None, "{name}");
        }
        let twice = read_back(&once);
        let corners = |pattern: &Pattern, size: &str| -> Vec<(String, Vec<Vec2>)> {
            let sized = in_size(pattern, Some(size));
            let panels = pattern.panels.iter().map(|panel| {
                let ends = panel.edges().map(|edge| sized.point(edge.ends[0]).unwrap());
                (panel.name.clone(), ends.collect())
            });
            panels.collect()
        };
        for size in &once.sizes {
            let [a, b] = [&once, &twice].map(|one| corners(one, &size.name));
            assert_eq!(a.len(), b.len());
            for ((panel, own), (_, other)) in a.iter().zip(&b) {
                // Where a curve was kept as chords, the end of a chord is a corner the second time.
                assert!(own.len() <= other.len(), "{name}, {panel}");
                for p in own {
                    let off = other.iter().map(|q| (q - p).norm());
                    let off = off.fold(f64::INFINITY, f64::min);
                    assert!(off < 2e-5, "{name}, {panel}, {}: {off}", size.name);
                }
            }
        }
        let numbers = |pattern: &Pattern| serde_json::to_string(pattern).unwrap().len();
        println!(
            "{name}: {} bytes, {} rules",
            numbers(&once),
            GradeRule::all(&once).len()
        );
    }
}

#[test]
fn a_nest_by_rules_equals_the_redrafted_one() {
    for name in ["t-shirt", "dress"] {
        let pattern = shipped(name);
        let sheets: Vec<_> = pattern.sheets.iter().map(|sheet| sheet.id.into()).collect();
        let evaluation = in_size(&pattern, Some(&pattern.base().unwrap().name));
        let every = plan::points_of(&evaluation, &sheets);
        let corners: Vec<PointId> = pattern
            .panels
            .iter()
            .flat_map(|panel| panel.edges().map(|edge| edge.ends[0]))
            .collect();
        for points in [every.clone(), corners] {
            let (edits, count) = plan::rules_of_sizes(&evaluation, &points).unwrap();
            assert!(count > 4, "{name}: {count}");
            let mut ruled = pattern.clone();
            ruled.apply(&edits).unwrap();
            for size in &pattern.sizes {
                let [a, b] = [&pattern, &ruled].map(|one| in_size(one, Some(&size.name)));
                for &id in &every {
                    let off = (a.point(id).unwrap() - b.point(id).unwrap()).norm();
                    let bound = if points.contains(&id) { 1e-12 } else { 1e-4 };
                    assert!(off < bound, "{name}, {}: {off}", size.name);
                }
            }
            let rules = GradeRule::all(&ruled).len();
            println!("{name}: {count} points by {rules} rules");
        }
    }
}

/// The shifts of a table in millimetres, read plainly: number, then a pair for each size.
fn shifts_of(table: &str) -> Vec<(u32, Vec<[f64; 2]>)> {
    let mut rules: Vec<(u32, Vec<f64>)> = Vec::new();
    for line in table.lines() {
        if let Some(number) = line.strip_prefix("RULE: DELTA ") {
            rules.push((number.parse().unwrap(), Vec::new()));
        } else if line != "END"
            && let Some((_, values)) = rules.last_mut()
        {
            values.extend(
                line.split_whitespace()
                    .map(|word| word.parse::<f64>().unwrap()),
            );
        }
    }
    let paired = rules.into_iter().map(|(number, values)| {
        let pairs = values.chunks(2).map(|pair| [pair[0], pair[1]]);
        (number, pairs.collect())
    });
    paired.collect()
}

/// The number of a rule, and the place that it stands at.
type Numbered = (u32, [f64; 2]);

/// Vertices of the line on a layer of a block (mm), and the numbers of rules at places (mm).
fn block_parts(block: &str, layer: &str) -> (Vec<[f64; 2]>, Vec<Numbered>) {
    let lines: Vec<&str> = block.lines().collect();
    let tags: Vec<(&str, &str)> = lines
        .chunks_exact(2)
        .map(|pair| (pair[0], pair[1]))
        .collect();
    let (mut vertices, mut numbers) = (Vec::new(), Vec::new());
    for (k, tag) in tags.iter().enumerate() {
        let value = |code: &str| {
            let own = tags[k + 1..].iter().take_while(|tag| tag.0 != "0");
            let mut own = own.filter(|tag| tag.0 == code);
            own.next().map(|tag| tag.1)
        };
        let at = || ["10", "20"].map(|code| value(code).unwrap().parse::<f64>().unwrap());
        if *tag == ("0", "VERTEX") && value("8") == Some(layer) {
            vertices.push(at());
        }
        if *tag == ("0", "TEXT")
            && value("8") == Some(layer)
            && let Some(number) = value("1").unwrap().strip_prefix("# ")
        {
            numbers.push((number.parse().unwrap(), at()));
        }
    }
    (vertices, numbers)
}

#[test]
fn a_rule_table_gives_the_shifts_of_the_blocks() {
    let pattern = shipped("t-shirt");
    for format in [Format::DxfAama, Format::DxfAstm] {
        let writing = written(&pattern, format);
        assert_eq!(writing.files.len(), 2);
        assert_eq!(writing.files[1].ending, ".rul");
        let text = String::from_utf8(writing.files[0].bytes.clone()).unwrap();
        let table = String::from_utf8(writing.files[1].bytes.clone()).unwrap();
        let rules = shifts_of(&table);
        assert_eq!(rules[0].1, vec![[0.0; 2]; pattern.sizes.len()]);
        let blocks: Vec<&str> = text
            .split("0\nBLOCK\n")
            .skip(1)
            .map(|block| block.split("0\nENDBLK").next().unwrap())
            .collect();
        let count = pattern.sizes.len();
        assert_eq!(blocks.len() % count, 0);
        let order: Vec<String> = drafts(&pattern)
            .into_iter()
            .map(|sized| sized.size.unwrap())
            .collect();
        let mut compared = 0;
        for piece in blocks.chunks(count) {
            for layer in ["1", "14"] {
                let (base, numbers) = block_parts(piece[0], layer);
                assert_eq!(base.len(), numbers.len(), "every vertex has its rule");
                for (block, size) in piece.iter().zip(&order) {
                    let (own, further) = block_parts(block, layer);
                    assert_eq!(own.len(), base.len(), "vertices in size {size}");
                    assert!(size == &order[0] || further.is_empty());
                    let column = pattern.sizes.iter().position(|known| known.name == *size);
                    for ((a, b), (number, at)) in base.iter().zip(&own).zip(&numbers) {
                        assert_eq!(a, at);
                        let (_, shifts) = &rules[*number as usize - 1];
                        let by = shifts[column.unwrap()];
                        for axis in [0, 1] {
                            let off = (b[axis] - a[axis] - by[axis]).abs();
                            assert!(off < 0.01, "rule {number}, {size}: {off} mm");
                        }
                        compared += 1;
                    }
                }
            }
        }
        assert!(compared > 1000, "{compared}");
        println!("{format:?}: {} rules, {compared} shifts", rules.len());
        // The sample size alone with the table is the whole nest.
        let base = &order[0];
        let alone = of_size(&text, base);
        assert!(alone.len() < text.len() / 2);
        let reading = with(alone.as_bytes(), &table).unwrap();
        assert_eq!(reading.pattern.sizes.len(), count);
        assert_eq!(reading.pattern.base().unwrap().name, *base);
        let whole = read(text.as_bytes(), &ReadOptions::default(), &[]).unwrap();
        for size in [&order[0], &order[1], &order[count - 1]] {
            let [a, b] = [&reading.pattern, &whole.pattern].map(|one| drafted(one, Some(size)));
            let off = outlines_apart(&a, &b);
            assert!(off < 3e-5, "{size}: {off}");
        }
        // With blocks of all sizes these hold, and that the table is not needed is said.
        let both = with(text.as_bytes(), &table).unwrap();
        assert!(both.pattern.says_the_same(&whole.pattern));
        let said = both.guesses.iter().find(|guess| guess.what == "sizes");
        assert!(said.unwrap().because.contains("blocks of its sizes"));
    }
}

/// A skirt of one size, 400 x 600 mm, with numbers of rules at its lower corners and its upper right one.
fn skirt(size: &str, units: &str) -> String {
    let mut block = String::new();
    let mut tag = |code: i32, value: &str| {
        let _ = writeln!(block, "{code}\n{value}");
    };
    let corners = ["0 0", "200 0", "400 0", "400 600", "0 600"];
    for (code, value) in [
        (0, "SECTION"),
        (2, "BLOCKS"),
        (0, "BLOCK"),
        (8, "1"),
        (2, "SKIRT"),
    ] {
        tag(code, value);
    }
    let xy = |place: &str| -> [String; 2] {
        let (x, y) = place.split_once(' ').unwrap();
        [x, y].map(str::to_owned)
    };
    for (code, value) in [(0, "POLYLINE"), (8, "1"), (66, "1"), (70, "1")] {
        tag(code, value);
    }
    for corner in corners {
        let [x, y] = xy(corner);
        for (code, value) in [(0, "VERTEX"), (8, "1"), (10, &*x), (20, &*y)] {
            tag(code, value);
        }
    }
    tag(0, "SEQEND");
    let texts = [
        ("# 1", "0 0"),
        ("# 2", "400 0"),
        ("# 3", "400 600"),
        ("# 9", "0 600"),
        ("Piece Name: SKIRT", "5 5"),
        (size, "5 5"),
        (units, "5 5"),
    ];
    for (text, place) in texts {
        let [x, y] = xy(place);
        for (code, value) in [(0, "TEXT"), (8, "1"), (10, &*x), (20, &*y), (1, text)] {
            tag(code, value);
        }
    }
    for (code, value) in [
        (0, "ENDBLK"),
        (0, "ENDSEC"),
        (0, "SECTION"),
        (2, "ENTITIES"),
        (0, "TEXT"),
        (8, "1"),
        (10, "0"),
        (20, "0"),
        (1, units),
        (0, "INSERT"),
        (8, "1"),
        (2, "SKIRT"),
        (0, "ENDSEC"),
        (0, "EOF"),
    ] {
        tag(code, value);
    }
    block
}

const TABLE: &str = "version ANSI/AAMA-292-B\nUNITS: METRIC\nSIZE LIST: S, M, L\nSAMPLE SIZE: M\n\
    RULE: DELTA 1\n0 0, 0 0, 0 0\nRULE: DELTA 2\n-10 0 0 0 12 0\nRULE: DELTA 3\n-10 -5 0 0\n12 6\nEND\n";

fn corners_in(reading: &Reading, size: &str) -> Vec<Vec2> {
    let draft = drafted(&reading.pattern, Some(size));
    let outline = &draft.pieces[0].outline;
    outline
        .iter()
        .map(|edge| edge.curve.start() * 1e3)
        .collect()
}

fn has(corners: &[Vec2], x: f64, y: f64) {
    let near = corners.iter().any(|p| (p - Vec2::new(x, y)).norm() < 1e-6);
    assert!(near, "{x} {y} in {corners:?}");
}

#[test]
fn a_table_grades_a_sample_size_and_points_between_go_by_length() {
    let reading = with(skirt("Size: M", "Units: METRIC").as_bytes(), TABLE).unwrap();
    assert_eq!(reading.pattern.base().unwrap().name, "M");
    let names: Vec<&str> = reading
        .pattern
        .sizes
        .iter()
        .map(|size| &*size.name)
        .collect();
    assert_eq!(names, ["S", "M", "L"]);
    let large = corners_in(&reading, "L");
    has(&large, 0.0, 0.0);
    has(&large, 412.0, 0.0);
    has(&large, 412.0, 606.0);
    // The upper left corner has a rule that the table lacks: 400 of 1000 mm from there on to the lower left one.
    has(&large, 12.0 * 0.6, 600.0 + 6.0 * 0.6);
    let small = corners_in(&reading, "S");
    has(&small, 390.0, 595.0);
    let told: Vec<String> = reading.losses.iter().map(ToString::to_string).collect();
    assert!(
        told.iter().any(|loss| loss.contains("grade rules 9")),
        "{told:?}"
    );
    let guess = reading
        .guesses
        .iter()
        .find(|guess| guess.what == "points between grade rules");
    assert!(
        guess.unwrap().because.starts_with("2 vertices"),
        "{guess:?}"
    );
    // The numbers of the table are those of the document.
    let numbers: Vec<u32> = GradeRule::all(&reading.pattern)
        .iter()
        .map(|rule| rule.number)
        .collect();
    assert!(numbers.contains(&2) && numbers.contains(&3), "{numbers:?}");
    let shifts = plan::rule_shifts(
        &in_size(&reading.pattern, None),
        GradeRule::of_number(&reading.pattern, 3).unwrap(),
    );
    assert!((shifts[2].by - Vec2::new(0.012, 0.006)).norm() < 1e-12);
}

#[test]
fn a_table_of_another_unit_sample_size_and_axes_is_converted() {
    let inches = TABLE.replace("METRIC", "ENGLISH");
    let reading = with(skirt("Size: M", "Units: METRIC").as_bytes(), &inches).unwrap();
    has(
        &corners_in(&reading, "L"),
        400.0 + 12.0 * 25.4,
        600.0 + 6.0 * 25.4,
    );
    // Drawn in another size than the table's sample: shifts hold against the size that is drawn.
    let reading = with(skirt("Size: L", "Units: METRIC").as_bytes(), TABLE).unwrap();
    assert_eq!(reading.pattern.base().unwrap().name, "L");
    has(&corners_in(&reading, "L"), 400.0, 600.0);
    has(&corners_in(&reading, "S"), 378.0, 589.0);
    // Axes that are turned by a quarter: to the right is upwards.
    let axis = "0\nLINE\n8\n5\n10\n100\n20\n100\n11\n100\n21\n200\n0\nENDBLK\n";
    let turned = skirt("Size: M", "Units: METRIC").replacen("0\nENDBLK\n", axis, 1);
    let reading = with(turned.as_bytes(), TABLE).unwrap();
    has(&corners_in(&reading, "L"), 400.0 - 6.0, 600.0 + 12.0);
    // No size is named: the sample size of the table, said.
    let reading = with(skirt("Note: M", "Units: METRIC").as_bytes(), TABLE).unwrap();
    assert_eq!(reading.pattern.base().unwrap().name, "M");
    assert!(reading.guesses.iter().any(|guess| guess.what == "size"));
}

#[test]
fn a_table_that_does_not_fit_is_refused_by_name() {
    let own = skirt("Size: 44", "Units: METRIC");
    let refused = with(own.as_bytes(), TABLE).unwrap_err().to_string();
    assert!(refused.contains("skirt.rul"), "{refused}");
    assert!(refused.contains("S, M, L"), "{refused}");
    assert!(refused.contains("44"), "{refused}");
    let own = skirt("Size: M", "Units: METRIC");
    let refused = with(own.as_bytes(), &TABLE.replace("12 6", "12"))
        .unwrap_err()
        .to_string();
    assert!(refused.contains("skirt.rul, line 9"), "{refused}");
    let refused = with(own.as_bytes(), "<vit></vit>").unwrap_err().to_string();
    assert!(refused.contains("no grade rule table"), "{refused}");
    let refused = read(TABLE.as_bytes(), &ReadOptions::default(), &[]).unwrap_err();
    assert!(
        refused.to_string().contains("grade rule table"),
        "{refused}"
    );
    assert!(refused.hint.contains("--with"), "{refused}");
}

#[test]
fn damaged_tables_never_panic() {
    let drawing = skirt("Size: M", "Units: METRIC");
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = move |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    let parts = [
        "RULE: DELTA 2",
        "NaN",
        "1e999",
        "-",
        ",",
        ":",
        "\n",
        "SIZE LIST:",
        "END",
        "\0",
        "\u{e9}",
        "99999999999999999999",
        "SAMPLE SIZE: L",
        "#",
    ];
    let (mut sound, mut refused) = (0, 0);
    for _ in 0..1000 {
        let mut bytes = TABLE.as_bytes().to_vec();
        for _ in 0..1 + random(4) {
            let at = random(bytes.len());
            match random(4) {
                0 => bytes[at] = random(256) as u8,
                1 => bytes.truncate(at.max(1)),
                2 => {
                    let to = (at + random(20)).min(bytes.len());
                    bytes.drain(at..to);
                    bytes.push(b'\n');
                }
                _ => {
                    let part = parts[random(parts.len())].as_bytes();
                    bytes.splice(at..at, part.iter().copied());
                }
            }
        }
        let companion = Companion {
            name: "skirt.rul".to_owned(),
            bytes,
        };
        match read(drawing.as_bytes(), &ReadOptions::default(), &[companion]) {
            Ok(reading) => {
                sound += 1;
                let sizes = reading.pattern.sizes.clone();
                for size in sizes {
                    let _ = drafted(&reading.pattern, Some(&size.name));
                }
            }
            Err(error) => {
                refused += 1;
                assert!(!error.place.is_empty() && !error.hint.is_empty(), "{error}");
            }
        }
    }
    assert!(sound > 50 && refused > 300, "{sound} {refused}");
}
