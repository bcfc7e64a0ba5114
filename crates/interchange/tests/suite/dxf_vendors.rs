//! Patterns in DXF with the habits of the programs that write them: pieces, sizes, outlines in every size, notches and
//! folds come back in the file that is written again.

use crate::dxf_file::{
    File, MAX_SECONDS, NEAR, Truth, blocks, default_held, held, line, off, point, tag, timed,
    words, written,
};
use toile_interchange::{Format, ReadOptions, read};
use toile_pattern::OperationKind;

/// A vertex of an outline (mm), and whether it is a turn point.
type Vertex = ([f64; 2], bool);

/// Sizes, each with its number of steps from the sample size.
const SIZES: [(&str, f64); 4] = [("6", -1.0), ("8", 0.0), ("10", 1.0), ("12", 2.0)];

/// A point of a cubic.
fn cubic(ends: [[f64; 2]; 4], t: f64) -> [f64; 2] {
    let u = 1.0 - t;
    let weights = [u * u * u, 3.0 * u * u * t, 3.0 * u * t * t, t * t * t];
    [0, 1].map(|axis| (0..4).map(|k| weights[k] * ends[k][axis]).sum())
}

/// The curves of a front: armhole and neckline.
fn curves(k: f64) -> [[[f64; 2]; 4]; 2] {
    let [underarm, tip] = [
        [245.0 + 5.0 * k, 400.0 + 2.0 * k],
        [180.0 + 3.0 * k, 620.0 + 4.0 * k],
    ];
    let [neck, front] = [[70.0 + k, 650.0 + 4.0 * k], [0.0, 560.0 + 3.0 * k]];
    let armhole = [
        underarm,
        [190.0 + 4.0 * k, 420.0 + 2.0 * k],
        [160.0 + 3.0 * k, 520.0 + 3.0 * k],
        tip,
    ];
    let neckline = [
        neck,
        [60.0 + k, 590.0 + 3.5 * k],
        [30.0, 560.0 + 3.0 * k],
        front,
    ];
    [armhole, neckline]
}

/// A front in a size, `k` steps from the sample: clockwise, as nearly all files have it. At the hem two turn points
/// come to lie in one place in the smallest size; on the side a turn point lies between two edges that run on straight.
fn front(k: f64) -> Vec<Vertex> {
    let right = 240.0 + 5.0 * k;
    let mut ring = vec![
        ([0.0, 0.0], true),
        ([100.0, 0.0], true),
        ([100.0 + 3.0 * (k + 1.0), 0.0], true),
        ([right, 0.0], true),
        ([right, 150.0], true),
        // A notch 20 mm above the turn point, on the same line.
        ([right, 170.0], false),
        ([right, 200.0], true),
    ];
    let [armhole, neckline] = curves(k);
    ring.push((armhole[0], true));
    ring.extend((1..6).map(|j| (cubic(armhole, f64::from(j) / 6.0), false)));
    ring.push((armhole[3], true));
    ring.push((neckline[0], true));
    ring.extend((1..5).map(|j| (cubic(neckline, f64::from(j) / 5.0), false)));
    ring.push((neckline[3], true));
    ring.push(([0.0, 300.0 + k], false));
    ring.reverse();
    ring
}

/// Numbers of the vertices with notches, counted from the end of the ring.
const NOTCHES: [usize; 2] = [5, 10];

/// The dense twin of a front, from another start.
fn dense_front(k: f64) -> Vec<[f64; 2]> {
    let ring: Vec<Vertex> = front(k).into_iter().rev().collect();
    let mut found: Vec<[f64; 2]> = ring[..7].iter().map(|(p, _)| *p).collect();
    let [armhole, neckline] = curves(k);
    found.extend((0..=60).map(|j| cubic(armhole, f64::from(j) / 60.0)));
    found.extend((0..=50).map(|j| cubic(neckline, f64::from(j) / 50.0)));
    found.push(([0.0, 300.0 + k], false).0);
    found.reverse();
    found.rotate_left(30);
    found
}

struct Habits {
    /// Length of a unit of the file (mm).
    unit: f64,
    units: &'static str,
    is_astm: bool,
    /// Style name, pieces of the file, each with whether it is a half.
    pieces: &'static [(&'static str, bool)],
}

fn rounded(p: [f64; 2], unit: f64) -> [f64; 2] {
    p.map(|x| (x / unit * 1e4).round() / 1e4)
}

/// A nest as AccuMark writes it: each outline a chain of open polylines, one from turn point to turn point; notches, turn
/// and curve points, quantity and material in the sample size alone, points twice; depths of notches negative; rule
/// numbers that count within a piece; halves with their mirror line in every block.
fn gerber(habits: &Habits) -> (String, Vec<Truth>) {
    let mut file = File::default();
    for text in [
        "STYLE NAME: TANK",
        "SAMPLE SIZE: 8",
        &format!("UNITS: {}", habits.units),
    ] {
        file.style += &words(text);
    }
    let mut truths = Vec::new();
    for (piece, is_half) in habits.pieces {
        for (size, k) in SIZES {
            let ring: Vec<Vertex> = front(k)
                .into_iter()
                .map(|(p, turn)| (rounded(p, habits.unit), turn))
                .collect();
            let start = ring.iter().position(|(_, turn)| *turn).unwrap();
            let at = |j: usize| ring[(start + j) % ring.len()];
            let mut parts = vec![
                words(&format!("PIECE NAME: {piece}")),
                words(&format!("SIZE: {size}")),
            ];
            let mut chain = vec![at(0).0];
            for j in 1..=ring.len() {
                chain.push(at(j).0);
                if at(j).1 {
                    parts.push(line(1, &chain, false, &[]));
                    chain = vec![at(j).0];
                }
            }
            let notches: Vec<[f64; 2]> =
                NOTCHES.iter().map(|j| ring[ring.len() - 1 - j].0).collect();
            if k == 0.0 {
                for (p, turn) in ring.iter().chain(&ring) {
                    parts.push(point(if *turn { 2 } else { 3 }, *p, &[]));
                }
                parts.extend(
                    notches
                        .iter()
                        .map(|&p| point(4, p, &[(30, "-0.25"), (39, "0")])),
                );
                parts.push(words("QUANTITY: 0"));
                parts.push(words("MATERIAL: SHELL"));
            }
            for (j, (p, _)) in ring.iter().filter(|(_, turn)| *turn).enumerate() {
                let mut text = String::new();
                tag(&mut text, 0, "TEXT");
                tag(&mut text, 8, 2);
                tag(&mut text, 10, p[0]);
                tag(&mut text, 20, p[1]);
                tag(&mut text, 1, format!("# {}", j + 1));
                parts.push(text);
            }
            if *is_half {
                let ends = [front(k)[1].0, [0.0, 0.0]].map(|p| rounded(p, habits.unit));
                parts.push(line(6, &ends, false, &[]));
            }
            if habits.is_astm {
                let twin: Vec<[f64; 2]> = dense_front(k)
                    .iter()
                    .map(|p| rounded(*p, habits.unit))
                    .collect();
                parts.push(line(84, &twin, true, &[]));
            }
            parts.push(line(
                7,
                &[
                    rounded([50.0, 200.0], habits.unit),
                    rounded([150.0, 200.0], habits.unit),
                ],
                false,
                &[],
            ));
            file.block(&format!("TANK {piece} {size}"), &parts);
            truths.push(Truth {
                piece: (*piece).to_owned(),
                size: size.to_owned(),
                ring: ring
                    .iter()
                    .map(|(p, _)| p.map(|x| x * habits.unit))
                    .collect(),
                notches: notches.iter().map(|p| p.map(|x| x * habits.unit)).collect(),
                fold: is_half.then_some(0.0),
            });
        }
    }
    // A block that is not there, and the style again in one without an outline.
    file.insert("TANK NOWHERE 8", &[]);
    (file.text(), truths)
}

#[test]
fn nests_of_gerber_in_inches_and_millimetres() {
    for (unit, units) in [(25.4, "ENGLISH"), (1.0, "METRIC")] {
        for is_astm in [false, true] {
            let (text, truths) = gerber(&Habits {
                unit,
                units,
                is_astm,
                pieces: &[("SR FRT", true), ("lining", false)],
            });
            let reading = default_held(&text, &truths);
            let pattern = &reading.pattern;
            assert_eq!(reading.format == Format::DxfAstm, is_astm);
            let sizes: Vec<&str> = pattern
                .sizes
                .iter()
                .map(|size| size.name.as_str())
                .collect();
            assert_eq!(sizes, ["6", "8", "10", "12"]);
            assert_eq!(pattern.base_size, Some(pattern.sizes[1].id));
            for (panel, half) in pattern.panels.iter().zip([true, false]) {
                let folds = panel
                    .operations
                    .iter()
                    .filter(|o| matches!(o.kind, OperationKind::Fold { .. }));
                assert_eq!(folds.count(), usize::from(half));
                assert_eq!(panel.notches.len(), 2);
                assert_eq!(panel.cut.quantity, 1);
            }
            assert_eq!(pattern.fabrics[0].name, "SHELL");
            let told: Vec<&str> = reading
                .losses
                .iter()
                .map(|loss| loss.what.as_str())
                .collect();
            let expected = [
                "a piece put in",
                "numbers of grade rules",
                "depths of notches",
                "quantities of 0",
            ];
            assert_eq!(told, expected, "{:?}", reading.losses);
            assert!(
                reading.guesses.iter().all(|guess| guess.what == "sew line"),
                "{:?}",
                reading.guesses
            );
        }
    }
}

#[test]
fn a_dense_twin_gives_the_curve_between_the_vertices() {
    let habits = |is_astm| Habits {
        unit: 1.0,
        units: "METRIC",
        is_astm,
        pieces: &[("BACK", false)],
    };
    let most = |is_astm: bool| {
        let (text, truths) = gerber(&habits(is_astm));
        let blocks = blocks(&written(
            &default_held(&text, &truths).pattern,
            Format::DxfAama,
        ));
        let mut most = 0.0_f64;
        for (block, k) in blocks.iter().zip([0.0, -1.0, 1.0, 2.0]) {
            let outline = block.layer(1).next().unwrap();
            for curve in curves(k) {
                let places = (0..200).map(|j| cubic(curve, f64::from(j) / 199.0));
                most = places.map(|p| off(p, outline)).fold(most, f64::max);
            }
        }
        most
    };
    // Chords that are written lie within 0.04 mm of the curve.
    let (with, without) = (most(true), most(false));
    assert!(with < 0.06, "{with}");
    assert!(without > 2.0 * with && without < 1.0, "{without}");
}

/// A pattern as CLO writes it: closed polylines with group 250, SEQEND without a layer, a header of release 10, points of
/// the dense twin on 84, internal lines on 8, notches with an angle alone.
fn clo(unit: f64, units: &str) -> (String, Vec<Truth>) {
    let mut file = File::default();
    file.style += &words(&format!("Units: {units}"));
    file.style += &words("Sample Size: 8");
    let mut truths = Vec::new();
    for (size, k) in SIZES {
        let ring: Vec<Vertex> = front(k)
            .into_iter()
            .map(|(p, turn)| (rounded(p, unit), turn))
            .collect();
        let points: Vec<[f64; 2]> = ring.iter().map(|(p, _)| *p).collect();
        let twin: Vec<[f64; 2]> = dense_front(k).iter().map(|p| rounded(*p, unit)).collect();
        let notch = points[points.len() - 1 - NOTCHES[1]];
        let inside = [[50.0, 100.0], [150.0, 100.0], [150.0, 150.0]].map(|p| rounded(p, unit));
        file.block(
            &format!("Pattern2D_4937_{size}"),
            &[
                line(1, &points, true, &[(250, "2")]),
                line(84, &twin, true, &[(250, "2")]),
                line(8, &inside, false, &[(250, "0")]),
                line(85, &inside, false, &[(250, "1")]),
                point(4, notch, &[(50, "12.5")]),
                words("Piece Name: Pattern2D_4937"),
                words(&format!("Size: {size}")),
                words("Quantity: 1"),
            ],
        );
        truths.push(Truth {
            piece: "Pattern2D_4937".to_owned(),
            size: size.to_owned(),
            ring: points.iter().map(|p| p.map(|x| x * unit)).collect(),
            notches: vec![notch.map(|x| x * unit)],
            fold: None,
        });
    }
    let header = "0\r\nSECTION\r\n2\r\nHEADER\r\n9\r\n$ACADVER\r\n1\r\nAC1006\r\n0\r\nENDSEC\r\n";
    (header.to_owned() + &file.text(), truths)
}

#[test]
fn nests_of_clo_and_their_twins_of_a_tenth() {
    for (unit, units, guessed) in [
        (1.0, "METRIC", false),
        (10.0, "METRIC", true),
        (10.0, "ENGLISH", true),
    ] {
        let (text, truths) = clo(unit, units);
        // A front of 65 inches could be meant: there the user says so.
        let options = ReadOptions {
            unit: (units == "ENGLISH").then_some(toile_pattern::DisplayUnit::Centimetre),
            ..ReadOptions::default()
        };
        let reading = held(text.as_bytes(), &truths, &options);
        let guess = reading.guesses.iter().any(|guess| guess.what == "unit");
        assert_eq!(guess, guessed && options.unit.is_none());
        assert_eq!(reading.pattern.panels[0].lines.len(), 2);
        assert_eq!(reading.losses, []);
    }
}

#[test]
fn richpeace_has_gbk_and_notches_on_layer_80() {
    let unit = 25.4;
    let points: Vec<[f64; 2]> = front(0.0).iter().map(|(p, _)| rounded(*p, unit)).collect();
    let mut file = File::default();
    file.style += &words("Units:ENGLISH");
    let notch = points[points.len() - 1 - NOTCHES[0]];
    let parts = [
        line(1, &points, true, &[]),
        point(80, notch, &[(30, "0.2")]),
        words("Piece Name:NAME"),
        words("Quantity:2"),
    ];
    file.block("P1", &parts);
    let text = file.text();
    let at = text.find("NAME\r").unwrap();
    let bytes = [
        &text.as_bytes()[..at],
        b"\xba\xf3\xc6\xac",
        &text.as_bytes()[at + 4..],
    ]
    .concat();
    let truth = Truth {
        piece: "后片".to_owned(),
        size: String::new(),
        ring: points.iter().map(|p| p.map(|x| x * unit)).collect(),
        notches: vec![notch.map(|x| x * unit)],
        fold: None,
    };
    // The writer says letters beyond ASCII by codes.
    let reading = read(&bytes, &ReadOptions::default(), &[]).unwrap();
    assert_eq!(reading.pattern.panels[0].name, truth.piece);
    let text = written(&reading.pattern, Format::DxfAama);
    let outline = &blocks(&text)[0];
    let ring = outline.layer(1).next().unwrap();
    assert!(truth.ring.iter().all(|p| off(*p, ring) < NEAR));
    assert_eq!(
        outline
            .points
            .iter()
            .filter(|(layer, _)| *layer == 80)
            .count(),
        1
    );
}

#[test]
fn valentina_has_no_text_and_notches_as_lines_across_the_allowance() {
    let sew = [[0.0, 0.0], [400.0, 0.0], [400.0, 600.0], [0.0, 600.0]];
    let cut = [
        [-10.0, -40.0],
        [410.0, -40.0],
        [410.0, 610.0],
        [-10.0, 610.0],
    ];
    for (sew_layer, twins) in [(8, false), (14, true)] {
        let moved = |ring: [[f64; 2]; 4], x: f64| ring.map(|p| [p[0] + x, p[1]]);
        let mut parts = Vec::new();
        // Two pieces of one name are one block.
        for x in [0.0, 500.0] {
            parts.push(line(1, &moved(cut, x), true, &[]));
            parts.push(line(sew_layer, &moved(sew, x), true, &[]));
            if twins {
                parts.push(line(84, &moved(cut, x), true, &[]));
                parts.push(line(87, &moved(sew, x), true, &[]));
            }
            parts.push(line(
                7,
                &[[x + 200.0, 100.0], [x + 200.0, 500.0]],
                false,
                &[],
            ));
            parts.push(line(
                4,
                &[[x + 400.0, 300.0], [x + 410.0, 300.0]],
                false,
                &[],
            ));
        }
        // The bare name of the piece, and blocks that drawings have.
        parts.push(words("Front"));
        let mut file = File::default();
        file.block("$MODEL_SPACE", &[]);
        file.block("FRONT", &parts);
        file.insert("FRONT", &[]);
        let truth = |piece: &str, x: f64| Truth {
            piece: piece.to_owned(),
            size: String::new(),
            ring: moved(cut, x).to_vec(),
            notches: vec![[x + 410.0, 300.0]],
            fold: None,
        };
        let truths = [truth("FRONT", 0.0), truth("FRONT 2", 500.0)];
        let reading = default_held(&file.text(), &truths);
        assert_eq!(reading.format == Format::DxfAstm, twins);
        for panel in &reading.pattern.panels {
            assert_eq!((panel.lines.len(), panel.notches.len()), (1, 1));
            assert_eq!(panel.allowance, toile_pattern::Number::Value(0.01));
        }
        let guesses: Vec<&str> = reading.guesses.iter().map(|guess| guess.what).collect();
        assert_eq!(guesses, ["unit"]);
        let told: Vec<&str> = reading
            .losses
            .iter()
            .map(|loss| loss.what.as_str())
            .collect();
        assert_eq!(told, ["a further place of a piece"]);
    }
}

#[test]
fn sizes_and_pieces_are_known_by_the_names_of_blocks() {
    let ring = |k: f64| -> Vec<[f64; 2]> { front(k).iter().map(|(p, _)| *p).collect() };
    // Labels in the sample's block alone.
    let mut file = File::default();
    file.style += &words("Sample Size: 8");
    for (size, k) in SIZES {
        let mut parts = vec![line(1, &ring(k), true, &[])];
        if k == 0.0 {
            parts.extend([words("Piece Name: Front, left"), words("Size: 8")]);
        } else {
            parts.push(words(&format!("Size Name: {size}")));
        }
        file.block(&format!("FR-{size}"), &parts);
    }
    let pattern = read(file.text().as_bytes(), &ReadOptions::default(), &[])
        .unwrap()
        .pattern;
    assert_eq!((pattern.panels.len(), pattern.sizes.len()), (1, 4));
    assert_eq!(pattern.panels[0].name, "Front, left");
    // No label at all.
    let mut file = File::default();
    for piece in ["FRONT", "BACK"] {
        for (size, k) in [("S", -1.0), ("M", 0.0), ("L", 1.0)] {
            file.block(&format!("{piece}_{size}"), &[line(1, &ring(k), true, &[])]);
        }
    }
    let reading = read(file.text().as_bytes(), &ReadOptions::default(), &[]).unwrap();
    assert_eq!(
        (reading.pattern.panels.len(), reading.pattern.sizes.len()),
        (2, 3)
    );
    assert!(
        reading
            .guesses
            .iter()
            .any(|guess| guess.what == "sizes" && guess.chosen == "S, M, L")
    );
    // Two pieces of one name.
    let mut file = File::default();
    for block in ["A", "B"] {
        for (size, k) in [("S", -1.0), ("M", 0.0)] {
            let texts = [words("Piece Name: POCKET"), words(&format!("Size: {size}"))];
            let parts = [&[line(1, &ring(k), true, &[])], texts.as_slice()].concat();
            file.block(&format!("{block}_{size}"), &parts);
        }
    }
    let pattern = read(file.text().as_bytes(), &ReadOptions::default(), &[])
        .unwrap()
        .pattern;
    let names: Vec<&str> = pattern
        .panels
        .iter()
        .map(|panel| panel.name.as_str())
        .collect();
    assert_eq!(
        (names, pattern.sizes.len()),
        (vec!["POCKET", "POCKET 2"], 2)
    );
}

#[test]
fn marks_in_another_size_than_the_sample_are_carried_to_it() {
    let (text, truths) = gerber(&Habits {
        unit: 1.0,
        units: "METRIC",
        is_astm: false,
        pieces: &[("BACK", false)],
    });
    let text = text.replace("SAMPLE SIZE: 8", "SAMPLE SIZE: 12");
    let reading = default_held(&text, &truths);
    let pattern = &reading.pattern;
    assert_eq!(pattern.base_size, Some(pattern.sizes[3].id));
    assert_eq!(pattern.panels[0].notches.len(), 2);
}

#[test]
fn two_thousand_blocks_are_read_in_two_seconds() {
    let (text, _) = gerber(&Habits {
        unit: 25.4,
        units: "ENGLISH",
        is_astm: true,
        pieces: &[("BACK", true); 500],
    });
    let (reading, seconds) = timed(|| read(text.as_bytes(), &ReadOptions::default(), &[]).unwrap());
    assert_eq!(reading.pattern.panels.len(), 500);
    assert!(seconds < MAX_SECONDS, "{seconds} s");
}
