//! GarmentCode samples and the shipped patterns, read and meshed. Skipped, with a word, where the
//! samples are not there.

use std::path::{Path, PathBuf};
use toile_assembly::{Garment, MeshQuality, combine, mesh_pieces, sanity};
use toile_interchange::{read_garmentcode, read_pattern, write_garmentcode};
use toile_measure::Measurements;
use toile_pattern::{Draft, Severity};

fn samples() -> Option<PathBuf> {
    let folder = std::env::var_os("TOILE_SHARED")
        .map(PathBuf::from)
        .or_else(|| {
            Path::new(env!("CARGO_MANIFEST_DIR"))
                .ancestors()
                .map(|a| a.join("shared"))
                .find(|p| p.join("data").is_dir())
        });
    let folder = folder
        .map(|f| f.join("data/garmentcode"))
        .filter(|f| f.is_dir());
    if folder.is_none() {
        println!("skipped: no sample folder");
    }
    folder
}

fn sample(name: &str) -> Option<Draft> {
    let path = samples()?.join(name);
    let text = std::fs::read_to_string(path).unwrap();
    let reading = read_garmentcode(&text).unwrap();
    assert_eq!(reading.notes, []);
    let (draft, findings) = reading.pattern.resolve(&Measurements::new());
    for finding in findings {
        assert!(finding.severity < Severity::Error, "{finding}");
    }
    Some(draft)
}

const SAMPLES: [(&str, usize, f64); 2] = [
    ("shirt_mean_specification.json", 18, 6396.2),
    ("hoody_mean_specification.json", 12, 5936.0),
];

/// Area inside the outlines of all pieces (m2).
fn outline_area(draft: &Draft) -> f64 {
    draft
        .pieces
        .iter()
        .map(|piece| {
            let points: Vec<_> = piece
                .outline
                .iter()
                .flat_map(|e| (0..400).map(|k| e.curve.point(f64::from(k) / 400.0)))
                .collect();
            let ring = (0..points.len()).map(|k| (points[k], points[(k + 1) % points.len()]));
            0.5 * ring.map(|(a, b)| a.perp(&b)).sum::<f64>().abs()
        })
        .sum()
}

#[test]
fn areas_and_stitches_are_those_of_the_files() {
    for (name, stitches, area) in SAMPLES {
        let Some(draft) = sample(name) else { return };
        assert_eq!(draft.seams.len(), stitches);
        let got = outline_area(&draft) * 1e4;
        assert!((got - area).abs() < 0.1, "{name}: {got} cm2");
    }
}

#[test]
fn sewn_samples_are_one_sound_piece() {
    for (name, ..) in SAMPLES {
        let Some(draft) = sample(name) else { return };
        let meshes = mesh_pieces(&draft, 0.02).unwrap();
        let mut garment = Garment {
            stitches: meshes.stitches,
            ..Garment::default()
        };
        for mesh in &meshes.pieces {
            let base = garment.flat.len() as u32;
            garment.flat.extend(&mesh.points);
            garment
                .triangles
                .extend(mesh.triangles.iter().map(|t| t.map(|v| v + base)));
        }
        let report = sanity(&draft, &garment);
        assert!(
            report.is_sound() && report.components == 1,
            "{name}: {report:?}"
        );
    }
}

#[test]
fn samples_survive_writing() {
    for (name, ..) in SAMPLES {
        let Some(first) = sample(name) else { return };
        let reading = read_garmentcode(&write_garmentcode(&first).text).unwrap();
        let (second, _) = reading.pattern.resolve(&Measurements::new());
        assert!((outline_area(&first) - outline_area(&second)).abs() < 1e-10);
        assert_eq!(first.seams.len(), second.seams.len());
        for (a, b) in first.seams.iter().zip(&second.seams) {
            assert_eq!(a.sides, b.sides);
        }
    }
}

fn check_quality(name: &str, draft: &Draft) {
    let meshes = mesh_pieces(draft, 0.01).unwrap();
    let parts: Vec<MeshQuality> = meshes.pieces.iter().map(|m| m.quality()).collect();
    let q = combine(&parts);
    println!(
        "{name}: {} triangles, smallest angle {:.1}, mean {:.1} degrees, mean edge {:.2} mm",
        q.triangles,
        q.smallest_angle.to_degrees(),
        q.mean_smallest_angle.to_degrees(),
        q.mean_edge * 1e3
    );
    assert!(
        q.under_20 as f64 <= 1e-3 * q.triangles as f64,
        "{name}: {q:?}"
    );
    assert!(q.smallest_free_angle.to_degrees() > 10.0, "{name}: {q:?}");
    assert!((q.mean_edge / 0.01 - 1.0).abs() < 0.15, "{name}: {q:?}");
}

#[test]
fn samples_mesh_well_at_ten_millimetres() {
    for (name, ..) in SAMPLES {
        let Some(draft) = sample(name) else { return };
        check_quality(name, &draft);
    }
}

#[test]
fn shipped_patterns_mesh_well_at_ten_millimetres_in_every_size() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.to_string_lossy().ends_with(".toile.json"))
        .collect();
    files.sort();
    assert!(!files.is_empty());
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let (pattern, _) = read_pattern(&text).unwrap();
        for size in &pattern.sizes {
            let (draft, _) = pattern.resolve(&size.measurements);
            let name = format!(
                "{} {}",
                file.file_name().unwrap().to_string_lossy(),
                size.name
            );
            check_quality(&name, &draft);
        }
    }
}
