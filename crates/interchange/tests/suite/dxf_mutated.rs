//! Damaged DXF files: each is a pattern or an error with its place and a remedy, soon.

use crate::dxf_file::{File, MAX_SECONDS, line, point, tag, timed, words};
use toile_interchange::{Format, ReadOptions, read};

/// Damaged files that are tried; `TOILE_MUTATIONS` asks for more.
const COUNT: u64 = 2_000;

/// Numbers that look random (Marsaglia 2003).
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % count.max(1)
    }
}

/// A nest with marks, a half, twins and a moved insert.
fn nest() -> String {
    let mut file = File::default();
    file.style += &words("Units: METRIC");
    file.style += &words("Sample Size: M");
    for (size, right) in [("S", 380.0), ("M", 400.0), ("L", 430.0)] {
        let ring = [
            [0.0, 0.0],
            [0.5 * right, -10.0],
            [right, 0.0],
            [right, 600.0],
            [0.0, 600.0],
        ];
        let mut parts = vec![
            line(1, &ring[..3], false, &[]),
            line(1, &ring[2..], false, &[]),
            line(1, &[ring[4], ring[0]], false, &[]),
            line(84, &ring, true, &[(250, "2")]),
            line(6, &[ring[4], ring[0]], false, &[]),
            line(8, &[[50.0, 50.0], [90.0, 60.0], [95.0, 80.0]], false, &[]),
            line(
                11,
                &[[50.0, 150.0], [90.0, 160.0], [95.0, 180.0]],
                true,
                &[],
            ),
            line(
                14,
                &ring.map(|p| [0.95 * p[0], 0.95 * p[1] + 10.0]),
                true,
                &[],
            ),
            words("Piece Name: FRONT"),
            words(&format!("Size: {size}")),
        ];
        if size == "M" {
            parts.extend(ring.map(|p| point(2, p, &[])));
            parts.push(point(4, ring[1], &[(30, "-4"), (39, "2"), (50, "90")]));
            parts.push(point(13, [100.0, 100.0], &[]));
            parts.push(words("# 4"));
        }
        file.block(&format!("FRONT_{size}"), &parts);
    }
    file.insert(
        "FRONT_M",
        &[(10, "100"), (20, "5"), (41, "-1"), (42, "2"), (50, "33")],
    );
    file.text()
}

/// A drawing of curves without blocks.
fn curves() -> String {
    let mut file = File::default();
    let entities: [&[(i32, &str)]; 5] = [
        &[(0, "CIRCLE"), (8, "a"), (10, "900"), (20, "0"), (40, "120")],
        &[
            (0, "ARC"),
            (8, "a"),
            (10, "0"),
            (20, "0"),
            (40, "200"),
            (50, "0"),
            (51, "180"),
        ],
        &[
            (0, "LINE"),
            (8, "a"),
            (10, "-200"),
            (20, "0"),
            (11, "200"),
            (21, "0"),
        ],
        &[
            (0, "LWPOLYLINE"),
            (8, "a"),
            (70, "1"),
            (10, "0"),
            (20, "-300"),
            (42, "0.5"),
            (10, "200"),
            (20, "-300"),
            (10, "90"),
            (20, "-90"),
        ],
        &[
            (0, "SPLINE"),
            (8, "a"),
            (71, "2"),
            (40, "0"),
            (40, "0"),
            (40, "0"),
            (40, "1"),
            (40, "2"),
            (40, "2"),
            (40, "2"),
            (10, "0"),
            (20, "900"),
            (10, "300"),
            (20, "900"),
            (10, "300"),
            (20, "1200"),
            (10, "0"),
            (20, "900"),
        ],
    ];
    for (code, value) in entities.into_iter().flatten() {
        tag(&mut file.style, *code, value);
    }
    file.text()
}

/// One kind of damage.
fn damaged(bytes: &mut Vec<u8>, random: &mut Random) {
    let numbers = [
        "1e308", "-1e7", "nan", "0", "1e-300", "-1", "", "9999999", "70000", "inf", "1,5",
    ];
    let at = random.below(bytes.len());
    let to = (at + random.below(400)).min(bytes.len());
    let line = |bytes: &[u8], at: usize| -> [usize; 2] {
        let start = bytes[..at]
            .iter()
            .rposition(|&b| b == b'\n')
            .map_or(0, |k| k + 1);
        let end = bytes[at..].iter().position(|&b| b == b'\n');
        [start, end.map_or(bytes.len(), |end| at + end)]
    };
    match random.below(8) {
        0 => bytes[at] = random.below(256) as u8,
        1 => drop(bytes.drain(at..to)),
        2 => {
            let copy = bytes[at..to].to_vec();
            let into = random.below(bytes.len());
            bytes.splice(into..into, copy);
        }
        3 => bytes.truncate(at.max(1)),
        4 | 5 => {
            let [start, end] = line(bytes, at);
            bytes.splice(start..end, numbers[random.below(numbers.len())].bytes());
        }
        6 => {
            let [start, end] = line(bytes, at);
            let code = random.below(100).to_string();
            bytes.splice(start..end, code.into_bytes());
        }
        _ => {
            let words = [
                "POLYLINE", "BLOCK", "ENDBLK", "INSERT", "SPLINE", "ARC", "SECTION", "EOF",
                "VERTEX", "84", "14", "6",
            ];
            let [start, end] = line(bytes, at);
            bytes.splice(start..end, words[random.below(words.len())].bytes());
        }
    }
}

#[test]
fn damaged_files_are_read_or_refused_with_a_place_and_a_remedy() {
    let asked = std::env::var("TOILE_MUTATIONS").ok();
    let count = asked.map_or(COUNT, |asked| asked.parse().unwrap());
    let samples = [nest(), curves()];
    let mut refused = 0;
    let mut slowest = 0.0_f64;
    for seed in 1..=count {
        let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let mut bytes = samples[random.below(samples.len())].clone().into_bytes();
        for _ in 0..=random.below(6) {
            damaged(&mut bytes, &mut random);
        }
        // The damage may hide that it is a DXF.
        let options = ReadOptions {
            format: Some(Format::DxfAama),
            allowance_inside: (random.below(4) == 0).then_some(0.01),
            ..ReadOptions::default()
        };
        let (found, seconds) = timed(|| read(&bytes, &options, &[]));
        match found {
            Ok(reading) => assert!(!reading.pattern.panels.is_empty(), "{seed}"),
            Err(error) => {
                refused += 1;
                let says = [&error.place, &error.what, &error.hint];
                assert!(says.iter().all(|text| !text.is_empty()), "{seed}: {error}");
            }
        }
        slowest = slowest.max(seconds);
        assert!(seconds < MAX_SECONDS, "{seed}: {seconds} s");
    }
    assert!(
        refused > 0 && refused < count,
        "{refused} of {count} refused, slowest {slowest} s"
    );
}

#[test]
fn files_that_are_large_without_sense_are_refused_or_read_soon() {
    let mut lines = String::from("0\nSECTION\n2\nENTITIES\n");
    for k in 0..150_000 {
        let _ = std::fmt::Write::write_fmt(
            &mut lines,
            format_args!(
                "0\nLINE\n8\n1\n10\n{k}\n20\n0\n11\n{}\n21\n{}\n",
                k + 1,
                k % 7
            ),
        );
    }
    let mut vertices = String::from("0\nSECTION\n2\nENTITIES\n0\nPOLYLINE\n8\n1\n70\n1\n");
    for k in 0..1_000_001 {
        let _ = std::fmt::Write::write_fmt(
            &mut vertices,
            format_args!("0\nVERTEX\n10\n{}\n20\n{k}\n", k % 1000),
        );
    }
    let mut circles = String::from("0\nSECTION\n2\nENTITIES\n");
    for k in 0..20_001 {
        let _ = std::fmt::Write::write_fmt(
            &mut circles,
            format_args!("0\nCIRCLE\n8\n1\n10\n{}\n20\n0\n40\n1\n", 3 * k),
        );
    }
    for (text, what) in [
        (lines, "no closed line"),
        (vertices, "more than 1000000 vertices"),
        (circles, "more than"),
    ] {
        let (found, seconds) = timed(|| read(text.as_bytes(), &ReadOptions::default(), &[]));
        let error = found.unwrap_err();
        assert!(error.what.contains(what), "{error}");
        assert!(seconds < MAX_SECONDS, "{what}: {seconds} s");
    }
}
