//! No stroke that a knife follows lies inside the cloth that is sewn: files of markers and prints
//! read back, of every shipped pattern and of patterns at random, with notches of every kind at
//! corners and between them and allowances from 0 to 40 mm.

mod files;
pub mod patterns;
mod region;

use crate::random_pattern::{Dice, random_pattern};
use files::{Strokes, dxf, hpgl, pdf, svg};
use patterns::{ALLOWANCES, shipped, star_pattern, with_allowances, with_notches};
use region::Region;
use std::sync::Arc;
use toile_cut::{CutOptions, CutPiece};
use toile_geometry::Vec2;
use toile_interchange::{
    Lines, MarkerDrawing, MarkerFacts, MarkerPiece, Paper, PrintJob, PrintLayer, PrintPiece,
    TitleBlock, write_marker_dxf, write_marker_hpgl, write_marker_pdf, write_marker_svg,
};
use toile_nesting::{Pose, Strip};
use toile_pattern::Pattern;

/// Patterns at random of each sort; a soak sets `KNIFE_CASES`.
fn cases() -> u64 {
    let asked = std::env::var("KNIFE_CASES").ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(12)
}

/// The pieces of a pattern in its base size that can be cut.
fn pieces(pattern: &Pattern) -> Vec<Arc<CutPiece>> {
    let body = pattern.sizes.first().map(|size| size.measurements.clone());
    let (draft, _) = pattern.resolve(&body.unwrap_or_default());
    let first = draft.pieces.iter().enumerate();
    let own = first.filter(|(_, piece)| piece.id.copy < 2);
    let cut = own.filter_map(|(k, _)| {
        CutPiece::new((pattern, &draft), k, (None, &CutOptions::default())).ok()
    });
    let of_a_size = |cut: &CutPiece| cut.is_finite() && cut.bounds().size().max() < 5.0;
    cut.filter(of_a_size).map(Arc::new).collect()
}

/// Pieces side by side, and the halves of those that are the same on both sides.
fn side_by_side(pieces: &[Arc<CutPiece>]) -> (Vec<(Arc<CutPiece>, Pose)>, Vec2) {
    let halves = pieces.iter().filter_map(|piece| {
        let fold = piece.fold.filter(|fold| piece.is_symmetric_in(fold))?;
        Some(Arc::new(piece.halved(&fold)))
    });
    let all: Vec<Arc<CutPiece>> = pieces.iter().cloned().chain(halves).collect();
    let (mut at, mut high) = (0.01, 0.1_f64);
    let mut laid = Vec::new();
    for (k, piece) in all.into_iter().enumerate() {
        let mut pose = Pose {
            grain: 0.0,
            turn: 0.4 * k as f64,
            mirrored: k % 3 == 1,
            translation: Vec2::zeros(),
        };
        let bounds = pose.lay(&piece.outer()).bounds();
        pose.translation = Vec2::new(at, 0.01) - bounds.min;
        at += bounds.size().x + 0.01;
        high = high.max(bounds.size().y + 0.02);
        laid.push((piece, pose));
    }
    (laid, Vec2::new(at, high))
}

fn marker(laid: &[(Arc<CutPiece>, Pose)], size: Vec2) -> MarkerDrawing {
    let piece = |(piece, pose): &(Arc<CutPiece>, Pose)| MarkerPiece {
        name: piece.name.clone(),
        item: 0,
        piece: piece.clone(),
        pose: *pose,
    };
    MarkerDrawing {
        title: "side by side".into(),
        strip: Strip::of_width(size.y),
        length: size.x,
        efficiency: 0.5,
        pieces: laid.iter().map(piece).collect(),
        unplaced: Vec::new(),
        overlaps: Vec::new(),
        facts: MarkerFacts::default(),
    }
}

fn print(laid: &[(Arc<CutPiece>, Pose)], size: Vec2, (paper, lines): (Paper, Lines)) -> PrintJob {
    let piece = |(piece, pose): &(Arc<CutPiece>, Pose)| PrintPiece {
        sizes: vec![(0, piece.clone())],
        words: vec![piece.name.clone()],
        pose: *pose,
    };
    PrintJob {
        paper,
        scale: 1.0,
        lines,
        size: size + Vec2::new(0.0, 0.2),
        layers: vec![PrintLayer { name: "M".into() }],
        pieces: laid.iter().map(piece).collect(),
        title: TitleBlock {
            name: "side by side".into(),
            ..TitleBlock::default()
        },
        title_at: Vec2::new(0.0, size.y),
    }
}

/// What was looked at.
#[derive(Default, Debug)]
struct Seen {
    pieces: usize,
    notches: usize,
    cut: usize,
    lines: usize,
}

impl Seen {
    /// Reads the files of a pattern's pieces back.
    fn look(&mut self, told: &str, pattern: &Pattern) {
        let pieces = pieces(pattern);
        if pieces.is_empty() {
            return;
        }
        let (laid, size) = side_by_side(&pieces);
        self.pieces += laid.len();
        for (piece, _) in &laid {
            self.notches += piece.notches.len();
            self.cut += piece.notches.iter().filter(|n| !n.cut.is_empty()).count();
        }
        let drawing = marker(&laid, size);
        let from_dxf = dxf(&write_marker_dxf(&drawing).unwrap());
        self.clear(&format!("{told}, DXF"), &from_dxf);
        let with_seams = |knife| Strokes {
            knife,
            ..from_dxf.clone()
        };
        let plotted = with_seams(hpgl(&write_marker_hpgl(&drawing).unwrap()));
        self.clear(&format!("{told}, PLT"), &plotted);
        let drawn = svg(&write_marker_svg(&drawing).unwrap());
        self.clear(&format!("{told}, SVG"), &drawn);
        let page = pdf(&write_marker_pdf(&drawing).unwrap());
        self.clear(&format!("{told}, PDF"), &page);
        for paper in [Paper::Page, Paper::Projector] {
            let job = print(&laid, size, (paper, Lines::Both));
            let drawn = svg(&job.svg().unwrap());
            self.clear(&format!("{told}, {paper:?} as SVG"), &drawn);
            let page = pdf(&job.pdf().unwrap());
            self.clear(&format!("{told}, {paper:?} as PDF"), &page);
        }
        let job = print(&laid, size, (Paper::Page, Lines::Sew));
        assert!(svg(&job.svg().unwrap()).knife.is_empty(), "{told}");
    }

    fn clear(&mut self, told: &str, strokes: &Strokes) {
        assert!(
            !strokes.sewn.is_empty() && !strokes.knife.is_empty(),
            "{told}"
        );
        let region = Region::new(&strokes.sewn, &strokes.cut);
        for line in &strokes.knife {
            self.lines += 1;
            if let Some(at) = region.point_inside(line) {
                panic!("{told}: the knife is inside a seam line at {at:?} m: {line:?}");
            }
        }
    }
}

#[test]
fn shipped_patterns_are_cut_in_their_allowances() {
    let mut seen = Seen::default();
    for (name, pattern) in shipped() {
        seen.look(&name, &pattern);
        let all = with_notches(&pattern);
        let count = ALLOWANCES.len() as u64;
        // A run takes some of the allowances with each pattern, a soak all.
        let step = if cases() < 100 { 3 } else { 1 };
        for k in (0..=count).skip(name.len() % step).step_by(step) {
            let wide = with_allowances(&all, (k < count).then_some(ALLOWANCES[k as usize % 9]), k);
            seen.look(&format!("{name}, allowances {k}"), &wide);
        }
    }
    assert!(seen.pieces > 50 && seen.cut > 200, "{seen:?}");
}

#[test]
fn patterns_at_random_are_cut_in_their_allowances() {
    let mut seen = Seen::default();
    for seed in 0..cases() {
        let star = star_pattern(seed);
        let chaos = with_notches(&random_pattern(&mut Dice::new(seed)));
        for (sort, pattern) in [("star", star), ("random", chaos)] {
            for k in 0..2 {
                let mixed = with_allowances(&pattern, None, 2 * seed + k);
                seen.look(&format!("{sort} {seed}, allowances {k}"), &mixed);
            }
        }
    }
    assert!(seen.pieces > 10 && seen.cut > 50, "{seen:?}");
}

/// A notch drawn inside the seam line, as all were once, is found in every file.
#[test]
fn a_stroke_inside_a_seam_line_is_found_in_every_file() {
    let (_, pattern) = shipped().remove(0);
    let pieces = pieces(&with_notches(&pattern));
    let mut piece = (*pieces[0]).clone();
    let notch = piece
        .notches
        .iter_mut()
        .find(|n| !n.cut.is_empty())
        .unwrap();
    notch.cut = notch.on_seam_line();
    let (laid, size) = side_by_side(&[Arc::new(piece)]);
    let drawing = marker(&laid, size);
    let from_dxf = dxf(&write_marker_dxf(&drawing).unwrap());
    let job = print(&laid, size, (Paper::Projector, Lines::Both));
    let found = [
        from_dxf.clone(),
        Strokes {
            knife: hpgl(&write_marker_hpgl(&drawing).unwrap()),
            ..from_dxf
        },
        svg(&write_marker_svg(&drawing).unwrap()),
        pdf(&write_marker_pdf(&drawing).unwrap()),
        svg(&job.svg().unwrap()),
        pdf(&job.pdf().unwrap()),
    ];
    for (k, strokes) in found.iter().enumerate() {
        let region = Region::new(&strokes.sewn, &strokes.cut);
        let inside = strokes
            .knife
            .iter()
            .filter(|l| region.point_inside(l).is_some());
        assert!(inside.count() > 0, "file {k}");
    }
}
