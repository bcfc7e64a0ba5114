//! What is laid on fabric is the line that is cut, of every shipped piece and size.

use std::path::{Path, PathBuf};
use toile_cut::{CutOptions, CutPiece};
use toile_geometry::{EdgeTree, Polygon, Vec2};
use toile_interchange::{read_marker_json, read_pattern};
use toile_nesting::Pose;
use toile_session::{Budget, MarkerFormat, NestOptions, Silent, SizeSelection, nest_patterns};

fn patterns() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns");
    let entries = std::fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths.filter(|path| path.is_file()).collect()
}

/// How far any point of a ring lies from another ring (m).
fn off(points: &[Vec2], border: &[Vec2]) -> f64 {
    let tree = EdgeTree::of(&Polygon::new(border.to_vec()));
    let each = points.iter();
    each.map(|p| EdgeTree::new(vec![[*p, *p]]).distance(&tree))
        .fold(0.0, f64::max)
}

#[test]
fn items_of_markers_are_the_cut_lines() {
    let mut compared = 0;
    for path in patterns() {
        let (pattern, _) = read_pattern(&std::fs::read_to_string(&path).unwrap()).unwrap();
        for size in &pattern.sizes {
            let (draft, _) = pattern.resolve(&size.measurements);
            let folder = tempfile::tempdir().unwrap();
            let options = NestOptions {
                sizes: SizeSelection::one(&*size.name),
                formats: vec![MarkerFormat::Json],
                budget: Budget::Evaluations(1000),
                ..NestOptions::default()
            };
            let place = (folder.path(), &mut Silent as _);
            let (_, files) = nest_patterns(std::slice::from_ref(&path), &options, place).unwrap();
            for file in files {
                let text = std::fs::read_to_string(file).unwrap();
                for laid in read_marker_json(&text).unwrap().pieces {
                    let number = draft.pieces.iter().position(|p| p.name == laid.name);
                    let how = (None, &CutOptions::default());
                    let cut = CutPiece::new((&pattern, &draft), number.unwrap(), how).unwrap();
                    let pose = Pose {
                        grain: laid.grain.to_radians(),
                        turn: laid.turn.to_radians(),
                        mirrored: laid.face_down,
                        translation: Vec2::from(laid.at),
                    };
                    let wanted = pose.lay(&cut.outer()).outer;
                    let found: Vec<Vec2> = laid.outline.iter().map(|&p| p.into()).collect();
                    let far = off(&found, &wanted).max(off(&wanted, &found));
                    assert!(far < 2e-5, "{} {}: {far}", laid.name, size.name);
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 50, "{compared} pieces");
}

#[test]
fn words_of_pieces_stand_clear_of_seam_lines_and_darts() {
    // Height of capital letters and of those that reach highest over the size.
    let tall = 0.8;
    for path in patterns() {
        let (pattern, _) = read_pattern(&std::fs::read_to_string(&path).unwrap()).unwrap();
        for size in &pattern.sizes {
            let (draft, _) = pattern.resolve(&size.measurements);
            for number in 0..draft.pieces.len() {
                let how = (None, &CutOptions::default());
                let cut = CutPiece::new((&pattern, &draft), number, how).unwrap();
                let name = &draft.pieces[number].name;
                let lines = [name.as_str(), &size.name, "cut 1 pair", "cotton"];
                let drawing = cut.drawing(|p| p, &lines);
                let sewn = cut.sewn();
                assert_eq!(drawing.words.len(), lines.len());
                for words in &drawing.words {
                    let along = Vec2::new(words.angle.cos(), words.angle.sin());
                    let up = Vec2::new(-along.y, along.x) * (tall * words.size);
                    let half = along * (0.5 * words.size * toile_lettering::width(&words.text));
                    let corners = [-half, half, half + up, up - half].map(|p| words.at + p);
                    let inside = corners.iter().all(|&corner| sewn.contains(corner));
                    let label = EdgeTree::of(&Polygon::new(corners.to_vec()));
                    let clear = label.distance(&EdgeTree::of(&sewn)) > 0.0;
                    let told = format!("{} {}: {words:?}", pattern.name, size.name);
                    assert!(inside && clear, "{told}");
                }
            }
        }
    }
}
