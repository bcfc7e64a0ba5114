//! Pieces as cut of the patterns that ship and of one with every corner, notch and dart: in a marker's
//! files, in print, and in numbers.

use crate::read_back::{dxf_lines, hausdorff, svg_paths};
use std::path::Path;
use std::sync::Arc;
use toile_cut::{
    CutOptions, CutPiece, PieceSegment, Shrinkage, StrokeKind, TextKind, cut_diagnostics, cut_list,
};
use toile_geometry::{CrossingKind, Polygon, Vec2};
use toile_interchange::{
    MarkerDrawing, MarkerFacts, MarkerPiece, read_pattern, write_marker_dxf, write_marker_svg,
};
use toile_measure::Measurements;
use toile_nesting::{Pose, Strip};
use toile_pattern::{Draft, NotchKind, OperationKind, Pattern, Pressed, Severity};

fn shipped() -> Vec<(String, Pattern)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns");
    let mut found: Vec<(String, Pattern)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file())
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            (name, read_pattern(&text).unwrap().0)
        })
        .collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    assert!(found.len() >= 4);
    found
}

/// Every piece of every shipped pattern and size, as cut.
fn each_piece(mut told: impl FnMut(&str, (&Pattern, &Draft), usize, CutPiece)) {
    for (file, pattern) in shipped() {
        for size in &pattern.sizes {
            let (draft, _) = pattern.resolve(&size.measurements);
            let how = (Some(&*size.name), &CutOptions::default());
            for k in 0..draft.pieces.len() {
                let cut = CutPiece::new((&pattern, &draft), k, how).unwrap();
                let name = format!("{file} {} {}", size.name, cut.name);
                told(&name, (&pattern, &draft), k, cut);
            }
        }
    }
}

fn tree(ring: &[Vec2]) -> Polygon {
    Polygon::new(ring.to_vec())
}

#[test]
fn cut_lines_of_shipped_patterns_do_not_cross_and_lie_in_their_allowances() {
    let mut count = 0;
    each_piece(|name, (_, draft), k, cut| {
        count += 1;
        let crossings = cut.polygon().crossings(4);
        assert!(
            crossings.iter().all(|c| c.kind == CrossingKind::Touch),
            "{name}: {crossings:?}"
        );
        let piece = &draft.pieces[k];
        let widest = piece
            .outline
            .iter()
            .map(|e| e.seam_allowance)
            .fold(0.0, f64::max);
        let (cut_area, sewn_area) = (cut.outer().area(), tree(&cut.sew[0].points).area().abs());
        assert!(cut_area >= sewn_area - 1e-9, "{name}");
        for ring in cut.cut.iter().chain(&cut.sew) {
            assert_eq!(ring.points.len(), ring.segments.len(), "{name}");
        }
        // No point of the cut line is farther from the seam line than a mitre reaches.
        let seam = tree(&cut.sew[0].points);
        let off = hausdorff(&cut.cut[0].points, &seam);
        assert!(
            off <= 2.5 * widest + 1e-6 || !cut.drills.is_empty(),
            "{name}: {off}"
        );
        let named = cut.cut[0]
            .segments
            .iter()
            .all(|s| *s != PieceSegment::Unknown);
        assert!(named, "{name}");
        assert!(
            cut.text(TextKind::Size)
                .is_some_and(|t| t.starts_with("size ")),
            "{name}"
        );
    });
    assert!(count > 50, "{count} pieces");
}

#[test]
fn shipped_patterns_are_cut_without_warnings() {
    for (file, pattern) in shipped() {
        for size in &pattern.sizes {
            let (draft, _) = pattern.resolve(&size.measurements);
            let found = cut_diagnostics(&pattern, &draft);
            let bad = found.iter().find(|d| d.severity > Severity::Note);
            assert!(bad.is_none(), "{file} {}: {bad:?}", size.name);
        }
    }
}

fn marker_of(cut: CutPiece) -> MarkerDrawing {
    let bounds = cut.bounds();
    let pose = Pose {
        grain: 0.0,
        turn: 0.0,
        mirrored: false,
        translation: -bounds.min,
    };
    MarkerDrawing {
        title: "one".into(),
        strip: Strip::of_width(bounds.size().y.max(0.1)),
        length: bounds.size().x,
        efficiency: 0.5,
        pieces: vec![MarkerPiece {
            name: cut.name.clone(),
            item: 0,
            piece: Arc::new(cut),
            pose,
        }],
        unplaced: Vec::new(),
        overlaps: Vec::new(),
        facts: MarkerFacts::default(),
    }
}

#[test]
fn one_drawing_serves_every_file() {
    each_piece(|name, _, _, cut| {
        let drawing = marker_of(cut);
        let piece = &drawing.pieces[0];
        let laid = piece.pose.lay(&piece.piece.outer());
        let dxf = dxf_lines(&write_marker_dxf(&drawing).unwrap(), "CUT");
        let width = drawing.strip.width;
        let svg = svg_paths(&write_marker_svg(&drawing).unwrap(), "class=\"cut\"");
        let up = |ring: &[Vec2]| -> Vec<Vec2> {
            ring.iter().map(|p| Vec2::new(p.x, width - p.y)).collect()
        };
        for ring in [&dxf[0], &up(&svg[0])] {
            let off = hausdorff(ring, &laid).max(hausdorff(&laid.outer, &tree(ring)));
            assert!(off < 2e-5, "{name}: {off}");
        }
    });
}

/// A folded panel with every kind of corner, notch and allowance, two darts, one inside, and a hole.
const EVERYTHING: &str = include_str!("cut_piece/everything.toile.json");

fn everything() -> (Pattern, Draft) {
    let (mut pattern, _) = read_pattern(EVERYTHING).unwrap();
    let panel = Arc::make_mut(&mut pattern.panels[0]);
    let hip = panel.notches[0].clone();
    let kinds = [
        NotchKind::V,
        NotchKind::Castle,
        NotchKind::T,
        NotchKind::Check,
    ];
    for (k, kind) in kinds.into_iter().enumerate() {
        let mut more = hip.clone();
        more.id = toile_pattern::NotchId(9000 + k as u32);
        more.kind = kind;
        panel.notches.push(more);
    }
    let (draft, found) = pattern.resolve(&Measurements::adult());
    assert!(
        found.iter().all(|d| d.severity < Severity::Error),
        "{found:?}"
    );
    (pattern, draft)
}

fn cut(pattern: &Pattern, draft: &Draft, options: &CutOptions) -> CutPiece {
    CutPiece::new((pattern, draft), 0, (Some("M"), options)).unwrap()
}

#[test]
fn a_piece_has_every_part_with_what_it_came_from() {
    let (pattern, draft) = everything();
    let piece = cut(&pattern, &draft, &CutOptions::default());
    // The hole is cut 1 cm inside its line, on both halves; the dart inside is sewn and not cut.
    assert_eq!(piece.cut.len(), 3);
    assert_eq!(piece.sew.len(), 5);
    let hole = tree(&piece.cut[1].points);
    assert!(
        (hole.area().abs() - 0.02 * 0.02).abs() < 1e-8,
        "{}",
        hole.area()
    );
    // One apex and four corners of the diamond on each half.
    assert_eq!(piece.drills.len(), 10);
    assert!(piece.drills.iter().any(|d| d.half == 1));
    assert_eq!(piece.notches.len(), 10);
    for notch in &piece.notches {
        assert!(
            ((notch.on_cut - notch.point).norm() - 0.01).abs() < 1e-9,
            "{notch:?}"
        );
        let lines = if notch.kind == NotchKind::T { 2 } else { 1 };
        assert_eq!([notch.cut.len(), notch.on_seam_line().len()], [lines; 2]);
        assert!((notch.depth - 0.006).abs() < 1e-12, "{notch:?}");
        for p in notch.cut.concat() {
            assert!((p - notch.on_cut).norm() < 0.0085, "{notch:?}");
            let inside = (p - notch.on_cut).dot(&notch.inward);
            assert!((-1e-9..0.007).contains(&inside), "{notch:?}");
        }
    }
    let texts: Vec<&str> = piece.texts.iter().map(|t| &*t.text).collect();
    assert_eq!(texts, ["front", "size M", "cut 1 pair", "poplin"]);
    let drawing = piece.drawing(|p| p, &texts);
    assert_eq!(drawing.words.len(), 4);
    // The grain line stands clear of the words, however the piece lies.
    for quarter in 0..4 {
        let (sin, cos) = (f64::from(quarter) * std::f64::consts::FRAC_PI_2).sin_cos();
        let turned = |p: Vec2| Vec2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
        let drawing = piece.drawing(turned, &texts);
        let first = &drawing.words[0];
        let up = Vec2::new(-first.angle.sin(), first.angle.cos());
        let heads = first.at.dot(&up) + first.size;
        let grain = drawing
            .strokes
            .iter()
            .filter(|s| s.kind == StrokeKind::Grain);
        let lowest = grain.flat_map(|s| &s.points).map(|p| p.dot(&up));
        assert!(
            lowest.fold(f64::INFINITY, f64::min) >= heads,
            "turned by {quarter} quarters"
        );
    }
    let caps = piece.cut[0].segments.iter();
    assert!(
        caps.filter(|s| matches!(s, PieceSegment::DartCap(_)))
            .count()
            >= 4
    );
    let list = cut_list((&pattern, &draft), std::slice::from_ref(&piece));
    assert_eq!(
        (list[0].pieces[0].quantity, list[0].pieces[0].pairs),
        (2, 1)
    );
    assert!((list[0].area() - 2.0 * piece.polygon().area()).abs() < 1e-12);
}

#[test]
fn halves_and_copies_are_mirror_images() {
    let (pattern, mut draft) = everything();
    // Kinds that name an edge: on a mirror image the other one.
    for kind in [
        toile_pattern::Corner::Square,
        toile_pattern::Corner::Mirrored,
        toile_pattern::Corner::Extended,
        toile_pattern::Corner::Bevel,
    ] {
        for edge in draft.pieces.iter_mut().flat_map(|p| &mut p.outline) {
            edge.corner.kind = kind;
        }
        let piece = cut(&pattern, &draft, &CutOptions::default());
        let fold = piece.fold.unwrap();
        assert!(piece.is_symmetric_in(&fold), "{kind:?}");
        let half = piece.halved(&fold);
        assert!(
            (2.0 * half.polygon().area() - piece.polygon().area()).abs() < 1e-7,
            "{kind:?}"
        );
        assert!(half.on_fold.is_some() && half.notches.len() == 5 && half.drills.len() == 5);
        let known = half.cut.iter().flat_map(|ring| &ring.segments);
        assert!(
            known.clone().all(|s| *s != PieceSegment::Unknown),
            "{kind:?}"
        );
        assert_eq!(
            known.filter(|s| **s == PieceSegment::Fold).count(),
            1,
            "{kind:?}"
        );
        // What lies on the fold is drawn as the fold, and neither cut nor sewn.
        let strokes = half.drawing(|p| p, &[]).strokes;
        let on_fold = |p: &Vec2| (p - fold.at).dot(&fold.inward).abs() < 1e-6;
        for stroke in &strokes {
            let folded = stroke.points.windows(2).any(|p| p.iter().all(on_fold));
            assert_eq!(folded, stroke.kind == StrokeKind::Fold, "{stroke:?}");
            assert!(!stroke.closed || !stroke.points.iter().any(on_fold));
        }
        let other = CutPiece::new((&pattern, &draft), 1, (None, &CutOptions::default())).unwrap();
        assert!(
            (other.polygon().area() - piece.polygon().area()).abs() < 1e-9,
            "{kind:?}"
        );
        assert!(piece.is_mirror_image_of(&other), "{kind:?}");
    }
}

#[test]
fn darts_are_folded_to_the_leg_they_are_pressed_to_on_both_halves() {
    // A slanting dart: of one that is the same on both sides the mouth is the same either way.
    let slanting = EVERYTHING
        .replace("\"depth\": 10", "\"apex\": 36")
        .replace(
            "\"points\": [",
            "\"points\": [{\"id\": 36, \"name\": \"v\", \"at\": [14.5, 30]}, ",
        )
        .replace("\"next_id\": 36", "\"next_id\": 37");
    let (pattern, _) = read_pattern(&slanting).unwrap();
    let drafted = |pressed: Pressed| {
        let mut pattern = pattern.clone();
        let panel = Arc::make_mut(&mut pattern.panels[0]);
        for operation in &mut panel.operations {
            let operation = Arc::make_mut(operation);
            if let OperationKind::Dart { pressed: own, .. } = &mut operation.kind {
                *own = pressed;
            }
        }
        let (draft, _) = pattern.resolve(&Measurements::adult());
        cut(&pattern, &draft, &CutOptions::default())
    };
    let [before, after] = [Pressed::Before, Pressed::After].map(drafted);
    for piece in [&before, &after] {
        let fold = piece.fold.unwrap();
        let mirror = |p: &Vec2| p - fold.inward * (2.0 * (p - fold.at).dot(&fold.inward));
        let image: Vec<Vec2> = piece.cut[0].points.iter().map(mirror).collect();
        assert!(hausdorff(&image, &piece.outer()) < 1e-5);
    }
    // Pressed the other way the cloth at the mouth leans the other way, by some millimetres.
    assert!(hausdorff(&before.cut[0].points, &after.outer()) > 1e-3);
}

#[test]
fn legs_of_darts_are_ticked_at_the_cut_line_and_arrows_say_where_they_are_pressed() {
    let (pattern, draft) = everything();
    let piece = cut(&pattern, &draft, &CutOptions::default());
    let fold = piece.fold.unwrap();
    let legs: Vec<[Vec2; 2]> = piece.sew[0]
        .points
        .iter()
        .zip(piece.sew[0].points.iter().cycle().skip(1))
        .zip(&piece.sew[0].segments)
        .filter(|(_, segment)| matches!(segment, PieceSegment::Edge(edge) if edge.leg().is_some()))
        .map(|((from, to), _)| [*from, *to])
        .collect();
    assert_eq!((legs.len(), piece.fold_ticks.len()), (4, 4));
    for tick in &piece.fold_ticks {
        assert!(tick.in_allowance);
        let [on_cut, end] = &tick.ends;
        let outline = piece.outer();
        let mut edges = outline.edges();
        assert!(edges.any(|e| toile_geometry::point_segment_distance(*on_cut, e) < 1e-6));
        let depth = (end - on_cut).norm();
        assert!(
            (0.003..=toile_cut::NOTCH_DEPTH + 1e-9).contains(&depth),
            "{depth}"
        );
        // One leg, drawn on, runs along it, and it leads towards that.
        let runs_along = |[a, b]: &&[Vec2; 2]| {
            let way = (b - a).normalize();
            let off = |p: &Vec2| way.perp(&(p - a)).abs();
            off(on_cut) < 1e-6 && off(end) < 1e-6
        };
        assert_eq!(legs.iter().filter(runs_along).count(), 1);
    }
    // Both halves press theirs to the same side, and the other way when they are to.
    let toward_fold = |piece: &CutPiece| -> Vec<f64> {
        let arrows = piece.pressed.iter();
        let sign = |at: Vec2| (at - fold.at).dot(&fold.inward).signum();
        let toward = arrows.map(|arrow| -arrow.way.dot(&fold.inward) * sign(arrow.at));
        toward.collect()
    };
    let before = toward_fold(&piece);
    assert_eq!(before.len(), 2);
    assert!(before.iter().all(|toward| *toward < -0.9), "{before:?}");
    let mut other = pattern.clone();
    let panel = Arc::make_mut(&mut other.panels[0]);
    for operation in &mut panel.operations {
        if let OperationKind::Dart { pressed, .. } = &mut Arc::make_mut(operation).kind {
            *pressed = Pressed::After;
        }
    }
    let (draft, _) = other.resolve(&Measurements::adult());
    let after = toward_fold(&cut(&other, &draft, &CutOptions::default()));
    assert!(after.iter().all(|toward| *toward > 0.9), "{after:?}");
    // The mirrored copy is the mirror image.
    let how = (None, &CutOptions::default());
    let copy = CutPiece::new((&other, &draft), 1, how).unwrap();
    assert!(toward_fold(&copy).iter().all(|toward| *toward > 0.9));
    let half = piece.halved(&fold);
    assert_eq!((half.fold_ticks.len(), half.pressed.len()), (2, 1));
}

#[test]
fn cloth_that_shrinks_is_cut_larger_along_and_across_the_grain() {
    let (pattern, draft) = everything();
    let plain = cut(&pattern, &draft, &CutOptions::default());
    let options = CutOptions {
        shrinkage: Shrinkage {
            warp: 0.05,
            weft: 0.02,
        },
        block: 0.0,
    };
    let wide = cut(&pattern, &draft, &options);
    let (before, after) = (plain.sewn().bounds().size(), wide.sewn().bounds().size());
    // The grain runs along y.
    assert!((after.y - before.y / 0.95).abs() < 1e-9);
    assert!((after.x - before.x / 0.98).abs() < 1e-9);
    for (a, b) in plain.notches.iter().zip(&wide.notches) {
        assert!((b.point.y - a.point.y / 0.95).abs() < 1e-9);
        assert!(((b.on_cut - b.point).norm() - 0.01).abs() < 1e-9);
    }
    let block = CutOptions {
        block: 0.02,
        ..CutOptions::default()
    };
    for notch in cut(&pattern, &draft, &block).notches {
        assert!(((notch.on_cut - notch.point).norm() - 0.03).abs() < 1e-9);
    }
}

#[test]
fn findings_name_their_edges_in_millimetres() {
    let sharp = EVERYTHING.replace("[24, 40]", "[90, 41]");
    let (pattern, _) = read_pattern(&sharp).unwrap();
    let (draft, _) = pattern.resolve(&Measurements::adult());
    let found = cut_diagnostics(&pattern, &draft);
    let corner = found
        .iter()
        .find(|d| d.message.contains("too sharp"))
        .unwrap();
    assert!(
        corner
            .message
            .contains("the corner of edge \"side\" and edge \"top\""),
        "{corner}"
    );
    assert!(corner.message.contains(" mm"), "{corner}");
    let shut = EVERYTHING
        .replace("[9, 8]", "[6, 8]")
        .replace("[9, 4]", "[6, 4]");
    let (pattern, _) = read_pattern(&shut).unwrap();
    let (draft, _) = pattern.resolve(&Measurements::adult());
    let found = cut_diagnostics(&pattern, &draft);
    let filled = found.iter().filter(|d| d.message.contains("filled"));
    assert_eq!(filled.count(), 1, "{found:?}");
}
