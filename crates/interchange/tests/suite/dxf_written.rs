//! Patterns written as DXF and read again: pieces, sizes, sew lines, notches and grain come back.

use std::path::{Path, PathBuf};
use toile_cut::{CutOptions, CutPiece};
use toile_geometry::{Polygon, Vec2};
use toile_interchange::{
    Fitting, Format, ReadOptions, Reading, SizedDraft, WriteSource, read, read_pattern, write,
};
use toile_measure::Measurements;
use toile_pattern::{Draft, Evaluation, Pattern, Wearer};

fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.to_string_lossy().ends_with(".toile.json"))
        .collect();
    files.sort();
    files
}

fn drafted(pattern: &Pattern, size: Option<&str>) -> Draft {
    let known = size.map(|name| pattern.size_named(name).unwrap());
    let wearer = Wearer {
        measurements: known.map_or_else(Measurements::adult, |size| size.measurements.clone()),
        size: known.map(|size| size.id),
    };
    Evaluation::new(pattern, wearer).draft().0
}

/// Drafts in all sizes, the base size first.
fn drafts(pattern: &Pattern) -> Vec<SizedDraft> {
    let mut sizes: Vec<_> = pattern.sizes.iter().collect();
    sizes.sort_by_key(|size| pattern.base_size != Some(size.id));
    let named = sizes.iter().map(|size| SizedDraft {
        size: Some(size.name.clone()),
        draft: drafted(pattern, Some(&size.name)),
    });
    let named: Vec<SizedDraft> = named.collect();
    match named.is_empty() {
        true => vec![SizedDraft {
            size: None,
            draft: drafted(pattern, None),
        }],
        false => named,
    }
}

fn written(pattern: &Pattern, drafts: &[SizedDraft], format: Format) -> Vec<u8> {
    let source = WriteSource {
        pattern,
        fitting: &Fitting::default(),
        drafts,
    };
    write(&source, format).unwrap().files.remove(0).bytes
}

fn reread(bytes: &[u8]) -> Reading {
    read(bytes, &ReadOptions::default(), &[]).unwrap()
}

/// Largest distance of points from the boundary of a polygon (m).
fn distance(points: &[Vec2], ring: &[Vec2]) -> f64 {
    let far = points.iter().map(|&p| {
        let next = ring.iter().cycle().skip(1);
        let off = ring.iter().zip(next).map(|(&a, &b)| {
            let along = b - a;
            let share = ((p - a).dot(&along) / along.norm_squared().max(1e-300)).clamp(0.0, 1.0);
            (a + along * share - p).norm()
        });
        off.fold(f64::INFINITY, f64::min)
    });
    far.fold(0.0, f64::max)
}

fn cut_pieces(pattern: &Pattern, draft: &Draft) -> Vec<CutPiece> {
    let first = draft
        .pieces
        .iter()
        .enumerate()
        .filter(|(_, piece)| piece.id.copy == 0);
    first
        .map(|(k, _)| CutPiece::new((pattern, draft), k, (None, &CutOptions::default())).unwrap())
        .collect()
}

#[test]
fn shipped_patterns_come_back_in_every_size() {
    for path in shipped() {
        let (pattern, _) = read_pattern(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let drafts = drafts(&pattern);
        for format in [Format::DxfAama, Format::DxfAstm] {
            let reading = reread(&written(&pattern, &drafts, format));
            let place = format!("{} as {format:?}", path.display());
            assert_eq!(reading.format, format, "{place}");
            assert!(
                reading.guesses.iter().all(|guess| guess.what == "sew line"),
                "{:?}",
                reading.guesses
            );
            let names = |pattern: &Pattern| -> Vec<String> {
                pattern
                    .panels
                    .iter()
                    .map(|panel| panel.name.clone())
                    .collect()
            };
            let back = &reading.pattern;
            assert_eq!(names(back), names(&pattern), "{place}");
            assert_eq!(back.sizes.len(), pattern.sizes.len(), "{place}");
            for sized in &drafts {
                let again = drafted(back, sized.size.as_deref());
                let (ours, theirs) = (cut_pieces(&pattern, &sized.draft), cut_pieces(back, &again));
                assert_eq!(ours.len(), theirs.len(), "{place}");
                for (own, other) in ours.iter().zip(&theirs) {
                    let place = format!("{place}, {}, size {:?}", own.name, sized.size);
                    let sewn = |piece: &CutPiece| -> Polygon { piece.sewn() };
                    let [a, b] = [sewn(own), sewn(other)].map(|polygon| polygon.outer);
                    let off = distance(&a, &b).max(distance(&b, &a));
                    assert!(off < 5e-5, "{place}: {off}");
                    for (one, two) in [(own, other), (other, own)] {
                        for notch in &one.notches {
                            let off = two.notches.iter().map(|n| (n.point - notch.point).norm());
                            let off = off.fold(f64::INFINITY, f64::min);
                            // It is told by its place on the cut line, from which the sew line is found.
                            assert!(off < 2e-4, "{place}: a notch is {off} m off");
                        }
                    }
                    let turn = (own.grain - other.grain).rem_euclid(std::f64::consts::PI);
                    assert!(turn.min(std::f64::consts::PI - turn) < 1e-6, "{place}");
                }
            }
        }
    }
}

#[test]
fn sew_lines_have_as_many_vertices_in_every_size() {
    let (pattern, _) = read_pattern(&std::fs::read_to_string(&shipped()[3]).unwrap()).unwrap();
    let text = String::from_utf8(written(&pattern, &drafts(&pattern), Format::DxfAama)).unwrap();
    let mut counts: Vec<Vec<usize>> = Vec::new();
    for block in text.split("\nBLOCK\n").skip(1) {
        let lines = block.split("\nPOLYLINE\n8\n14\n").skip(1);
        let sew = lines.map(|line| {
            line.split("\nSEQEND")
                .next()
                .unwrap()
                .matches("\nVERTEX\n")
                .count()
        });
        counts.push(sew.collect());
    }
    assert_eq!(counts.len(), pattern.panels.len() * pattern.sizes.len());
    for sizes in counts.chunks(pattern.sizes.len()) {
        assert!(
            sizes
                .iter()
                .all(|count| *count == sizes[0] && !count.is_empty()),
            "{sizes:?}"
        );
    }
}
