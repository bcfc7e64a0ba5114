//! Pleats trued, on edges of the shipped patterns in every size: folded, the edge runs on without a kink, and what lies
//! under lies on it.

use std::sync::Arc;
use toile_geometry::{Curve, Path, Vec2};
use toile_interchange::{read_pattern, write_pattern};
use toile_pattern::*;

const SHIPPED: [&str; 4] = ["dress", "gathered-skirt", "t-shirt", "trousers"];
const DEPTH: f64 = 0.012;
const EXACT: f64 = 1e-9;
/// Kinks that are none (deg).
const NO_KINK: f64 = 0.01;

fn shipped(name: &str) -> Pattern {
    let folder = env!("CARGO_MANIFEST_DIR");
    let path = format!("{folder}/../../patterns/{name}.toile.json");
    let text = std::fs::read_to_string(path).unwrap();
    read_pattern(&text).unwrap().0
}

/// The pattern with a knife pleat from an edge of a panel to another, all other steps taken away; and the pleat.
fn pleated(
    pattern: &Pattern,
    panel: PanelId,
    (edges, side): ([EdgeId; 2], Side),
) -> Option<(Pattern, OperationId)> {
    let evaluation = Evaluation::new(pattern, pattern.base_measurements()?);
    let (line, lines) = plan::even_cuts(&evaluation, panel, edges, 1).ok()?;
    let wish = plan::PleatWish {
        line,
        lines,
        depth: DEPTH.into(),
        kind: PleatKind::Knife,
        pressed: side,
        held: None,
    };
    let (edits, id) = plan::pleat_panel(&evaluation, panel, wish).ok()?;
    let mut pattern = pattern.clone();
    pattern.apply(&edits).unwrap();
    Some((pattern, id))
}

fn angle(from: Vec2, to: Vec2) -> f64 {
    from.perp(&to).atan2(from.dot(&to)).to_degrees()
}

/// How far a place lies from an edge of a stage (m).
fn away(stage: &Stage, edge: EdgeId, place: Vec2) -> f64 {
    let own = stage.outline().iter();
    let own = own.filter(|known| known.name == Name::Drawn(edge));
    own.map(|known| {
        let path = Path::new(vec![known.curve]);
        (path.point(path.nearest(place).unwrap()) - place).norm()
    })
    .fold(f64::INFINITY, f64::min)
}

/// The edge before the underlay in an edge, its two layers, and the edge after it.
fn around(stage: &Stage, pleat: OperationId, edge: EdgeId) -> Option<[Curve; 4]> {
    let edges = stage.outline();
    let count = edges.len();
    let is_under = |k: usize| edges[k % count].name.maker() == Some(pleat);
    let first = (0..count).find(|&k| {
        let before = &edges[(k + count - 1) % count];
        is_under(k) && before.name == Name::Drawn(edge)
    })?;
    // One curve a layer: the underlay is beside no corner, nor is a dart there.
    let runs_on = edges[(first + 2) % count].name == Name::Drawn(edge);
    (is_under(first + 1) && runs_on)
        .then(|| [count - 1, 0, 1, 2].map(|step| edges[(first + step) % count].curve))
}

#[test]
fn folded_pleats_leave_no_kink_on_shipped_edges_in_every_size() {
    let (mut pairs, mut curved) = (0, 0);
    for name in SHIPPED {
        let pattern = shipped(name);
        for panel in pattern.panels.iter().filter(|panel| !panel.is_split()) {
            let edges: Vec<EdgeId> = panel
                .outline()
                .unwrap()
                .edges
                .iter()
                .map(|e| e.id)
                .collect();
            for (k, from) in edges.iter().enumerate() {
                let to = edges[(k + edges.len() / 2) % edges.len()];
                for side in [Side::Left, Side::Right] {
                    let Some((pleated, pleat)) = pleated(&pattern, panel.id, ([*from, to], side))
                    else {
                        continue;
                    };
                    for size in &pattern.sizes {
                        let evaluation = Evaluation::new(&pleated, Wearer::from(size));
                        let Some(stage) = evaluation.stage(panel.id, Some(pleat)) else {
                            continue;
                        };
                        let Some(found) = around(stage, pleat, *from) else {
                            continue;
                        };
                        let words = format!("{name} {} {k} {side:?} {}", panel.name, size.name);
                        curved += usize::from(!matches!(found[0], Curve::Line { .. }));
                        lies_flat(stage, *from, (found, side), &words);
                        pairs += 1;
                    }
                }
            }
        }
    }
    assert!(pairs >= 60 && curved >= 30, "{pairs} {curved}");
}

/// Folded, the parts meet without a kink, and both layers lie on the edge beside them.
fn lies_flat(
    stage: &Stage,
    edge: EdgeId,
    ([before, first, second, after], side): ([Curve; 4], Side),
    words: &str,
) {
    let kink = angle(before.derivative(1.0), after.derivative(0.0));
    assert!(kink.abs() < NO_KINK, "{words}: {kink} degrees");
    let across = after.start() - before.end();
    assert!((across.norm() - 2.0 * DEPTH).abs() < EXACT, "{words}");
    let line = Vec2::new(-across.y, across.x).normalize();
    let mirrored = |p: Vec2, at: Vec2| at + line * (2.0 * (p - at).dot(&line)) - (p - at);
    let area: f64 = stage.outline().iter().map(|e| e.curve.swept_area()).sum();
    // Left of the line, which leads into the cloth, lies the part before it where the outline runs
    // counter-clockwise.
    let is_before = (side == Side::Left) == (area > 0.0);
    for k in 0..=8 {
        let t = f64::from(k) / 8.0;
        let (one, two) = (first.point(t), second.point(t));
        let laid = match is_before {
            true => [mirrored(one, before.end()), two - across],
            false => [one + across, mirrored(two, after.start())],
        };
        for place in laid {
            let off = away(stage, edge, place);
            assert!(off < EXACT, "{words}: {off}");
        }
    }
}

#[test]
fn a_pleat_that_is_not_trued_runs_straight_across_and_says_so_in_its_file() {
    let pattern = shipped("t-shirt");
    let panel = pattern.panel_named("front").unwrap();
    let edge = |name: &str| panel.edges().find(|edge| edge.name == name).unwrap().id;
    let edges = [edge("neck"), edge("hem")];
    let (mut pattern, pleat) = pleated(&pattern, panel.id, (edges, Side::Left)).unwrap();
    let whole = write_pattern(&pattern).unwrap();
    assert!(!whole.contains("\"trued\""));
    let mut panel = (**pattern.panel_named("front").unwrap()).clone();
    let own = panel.operations.iter_mut().find(|step| step.id == pleat);
    let OperationKind::Pleat { trued, .. } = &mut Arc::make_mut(own.unwrap()).kind else {
        panic!("it is a pleat");
    };
    *trued = false;
    let id = panel.id;
    pattern
        .apply(&[Edit::Put(Entity::Panel(Arc::new(panel)))])
        .unwrap();
    let evaluation = Evaluation::new(&pattern, pattern.base_measurements().unwrap());
    let stage = evaluation.stage(id, Some(pleat)).unwrap();
    let [before, first, second, after] = around(stage, pleat, edges[0]).unwrap();
    let across = after.start() - before.end();
    for layer in [first, second] {
        assert!(matches!(layer, Curve::Line { .. }));
        assert!(angle(layer.end() - layer.start(), across).abs() < 1e-9);
        assert!((layer.length() - DEPTH).abs() < EXACT);
    }
    let text = write_pattern(&pattern).unwrap();
    assert_eq!(text.matches("\"trued\": false").count(), 1, "{text}");
    assert!(read_pattern(&text).unwrap().0.says_the_same(&pattern));
    let plain = text.replace("\"trued\": false", "\"trued\": true");
    let again = read_pattern(&plain).unwrap().0;
    assert_eq!(write_pattern(&again).unwrap(), whole);
}
