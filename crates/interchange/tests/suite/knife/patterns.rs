//! Patterns with notches everywhere and allowances of every width.

use crate::random_pattern::Dice;
use std::path::Path;
use std::sync::Arc;
use toile_interchange::read_pattern;
use toile_pattern::*;

/// Widths of allowances (m).
pub const ALLOWANCES: [f64; 9] = [0.0, 0.001, 0.003, 0.006, 0.01, 0.015, 0.02, 0.03, 0.04];

const KINDS: [NotchKind; 5] = [
    NotchKind::Slit,
    NotchKind::V,
    NotchKind::Castle,
    NotchKind::T,
    NotchKind::Check,
];

const CORNERS: [Corner; 5] = [
    Corner::Mitre,
    Corner::Bevel,
    Corner::Square,
    Corner::Extended,
    Corner::Mirrored,
];

pub fn shipped() -> Vec<(String, Pattern)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns");
    let read = |path: std::path::PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        (name, read_pattern(&text).unwrap().0)
    };
    let paths = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path());
    let mut found: Vec<(String, Pattern)> = paths.filter(|p| p.is_file()).map(read).collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    assert!(found.len() >= 4);
    found
}

/// The pattern with notches at every corner and at three places of every edge, of all kinds in turn.
pub fn with_notches(pattern: &Pattern) -> Pattern {
    let mut pattern = pattern.clone();
    let mut number = 0;
    for panel in &mut pattern.panels {
        let panel = Arc::make_mut(panel);
        let lines: Vec<Line> = panel
            .lines
            .iter()
            .filter(|l| l.kind != LineKind::Internal)
            .cloned()
            .collect();
        for (line, edge) in lines
            .iter()
            .flat_map(|l| l.edges.iter().map(move |e| (l, e)))
        {
            let marks = [
                Mark::corner(edge.ends[0]),
                Mark::between(edge.ends, 0.02),
                Mark::between(edge.ends, 0.37),
                Mark::between(edge.ends, 0.9),
            ];
            for at in marks {
                number += 1;
                panel.notches.push(Notch {
                    id: NotchId(900_000 + number),
                    name: format!("more {number}"),
                    line: line.id,
                    at,
                    kind: KINDS[(number as usize * 3) % 5],
                });
            }
        }
    }
    pattern
}

/// The pattern with one allowance all round, or with one at random beside each edge.
pub fn with_allowances(pattern: &Pattern, width: Option<f64>, seed: u64) -> Pattern {
    let mut pattern = pattern.clone();
    let mut dice = Dice::new(seed);
    for panel in &mut pattern.panels {
        let panel = Arc::make_mut(panel);
        panel.allowance = Number::Value(width.unwrap_or(0.01));
        for edge in panel.lines.iter_mut().flat_map(|line| &mut line.edges) {
            let mixed = ALLOWANCES[dice.below(9)];
            edge.allowance = Some(Number::Value(width.unwrap_or(mixed)));
            if width.is_none() {
                edge.corner.kind = CORNERS[dice.below(5)];
            }
        }
    }
    pattern
}

/// A pattern of one panel round a middle: corners at random distances from it, arcs, at times a
/// hole, a dart, a fold.
pub fn star_pattern(seed: u64) -> Pattern {
    let mut dice = Dice::new(seed ^ 0x5eed);
    let mut fraction = |low: f64, high: f64| low + (high - low) * dice.below(10_001) as f64 / 1e4;
    let mut pattern = Pattern::new("star");
    let mut ids = Ids::default();
    let fabric: FabricId = ids.take();
    pattern.fabrics.push(Arc::new(Fabric::poplin(fabric)));
    let mut drawing = PanelBuilder::new(&mut ids, "star", fabric);
    let corners = fraction(3.0, 11.0) as usize;
    let size = [0.03, 0.1, 0.4][fraction(0.0, 2.99) as usize];
    let points: Vec<PointId> = (0..corners)
        .map(|k| {
            let angle = std::f64::consts::TAU * (k as f64 + fraction(0.0, 0.6)) / corners as f64;
            let far = size * fraction(0.35, 1.0);
            drawing.point(
                format!("p{k}"),
                PointRule::at(far * angle.cos(), far * angle.sin()),
            )
        })
        .collect();
    let mut ring = |drawing: &mut PanelBuilder<'_>, name: &str, points: &[PointId], bent: f64| {
        let count = points.len();
        let edges = (0..count).map(|k| {
            let rule = match k > 0 && fraction(0.0, 1.0) < 0.5 {
                true => CurveRule::Arc {
                    bulge: Number::Value(bent * fraction(-0.4, 0.4)),
                },
                false => CurveRule::Line,
            };
            drawing.edge(
                format!("{name}{k}"),
                [points[k], points[(k + 1) % count]],
                rule,
            )
        });
        edges.collect::<Vec<Edge>>()
    };
    let edges = ring(&mut drawing, "e", &points, 1.0);
    let outline = drawing.line("outline", LineKind::Outline, edges.clone());
    if seed % 3 == 1 {
        let far = 0.25 * size;
        let hole: Vec<PointId> = [[far, 0.0], [0.0, -far], [-far, 0.0], [0.0, far]]
            .iter()
            .enumerate()
            .map(|(k, p)| drawing.point(format!("h{k}"), PointRule::at(p[0], p[1])))
            .collect();
        let edges = ring(&mut drawing, "h", &hole, 0.5);
        drawing.line("hole", LineKind::Hole, edges);
    }
    let operation = |drawing: &mut PanelBuilder<'_>, name: &str, kind: OperationKind| {
        let id = drawing.id();
        let name = name.to_owned();
        drawing.panel.operations.push(Arc::new(Operation {
            id,
            name,
            kind,
            meant: false,
        }));
    };
    if seed % 4 == 1 {
        let dart = OperationKind::Dart {
            line: Name::Drawn(outline),
            mouth: Mark::between(edges[1].ends, 0.5),
            intake: Number::Value(0.1 * size),
            apex: Apex::Depth(Number::Value(0.3 * size)),
            trued: false,
            keeps_length: false,
            pressed: Pressed::After,
        };
        operation(&mut drawing, "dart", dart);
    }
    if seed % 4 >= 2 {
        let fold = OperationKind::Fold {
            line: Name::Drawn(outline),
            ends: edges[0].ends.map(Mark::corner),
        };
        operation(&mut drawing, "fold", fold);
    }
    let drawn = drawing.done();
    pattern.add(drawn);
    pattern.ids = ids;
    with_notches(&pattern)
}
