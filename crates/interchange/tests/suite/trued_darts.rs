//! Darts trued, on every edge of the shipped patterns that has room and in every size: closed, the edge
//! runs on without a kink from leg to leg, and all else is as it was.

use std::sync::Arc;
use toile_geometry::{Curve, Vec2};
use toile_interchange::read_pattern;
use toile_pattern::*;

const SHIPPED: [&str; 5] = ["dress", "gathered-skirt", "poncho", "t-shirt", "trousers"];
const EXACT: f64 = 1e-9;
/// Kinks that are none (deg).
const NO_KINK: f64 = 0.01;

fn shipped(name: &str) -> Pattern {
    let folder = env!("CARGO_MANIFEST_DIR");
    let path = format!("{folder}/../../patterns/{name}.toile.json");
    read_pattern(&std::fs::read_to_string(path).unwrap())
        .unwrap()
        .0
}

/// A dart on an edge of a panel, and the pattern with it.
struct Pair {
    pattern: Pattern,
    panel: PanelId,
    dart: OperationId,
    edge: EdgeId,
    words: String,
}

impl Pair {
    /// Where the share is free of other darts, the edge 12 cm long and the dart within the panel.
    fn new(pattern: &Pattern, panel: &Panel, edge: &Edge, share: f64) -> Option<Self> {
        let kind = OperationKind::Dart {
            line: Name::Drawn(panel.outline().unwrap().id),
            mouth: Mark::between(edge.ends, share),
            intake: 0.02.into(),
            apex: Apex::Depth(0.06.into()),
            pressed: Pressed::Before,
            trued: true,
            keeps_length: false,
        };
        let evaluation = Evaluation::new(pattern, pattern.base_measurements().unwrap());
        let length = evaluation.edge(edge.id).unwrap().length();
        let (edits, dart) = plan::add_operation(&evaluation, panel.id, kind).ok()?;
        let mut pattern = pattern.clone();
        pattern.apply(&edits).unwrap();
        let found = Evaluation::new(&pattern, pattern.base_measurements().unwrap()).check();
        let is_free = found.iter().all(|found| found.severity == Severity::Note);
        (length > 0.12 && is_free).then(|| Self {
            words: format!("{} {} {} {share}", pattern.name, panel.name, edge.name),
            panel: panel.id,
            edge: edge.id,
            pattern,
            dart,
        })
    }

    /// The stage after the dart, with what is asked of it.
    fn stage(&self, wearer: &Wearer, (side, on): (Pressed, bool)) -> Arc<Stage> {
        let mut pattern = self.pattern.clone();
        let mut panel = (**pattern.panel(self.panel).unwrap()).clone();
        for own in panel.operations.iter_mut().filter(|o| o.id == self.dart) {
            let own = Arc::make_mut(own);
            let OperationKind::Dart { pressed, trued, .. } = &mut own.kind else {
                panic!("it is a dart");
            };
            (*pressed, *trued) = (side, on);
        }
        pattern
            .apply(&[Edit::Put(Entity::Panel(Arc::new(panel)))])
            .unwrap();
        let evaluation = Evaluation::new(&pattern, wearer);
        let panel = evaluation.pattern().panel(self.panel).unwrap().clone();
        evaluation.stage(panel.id, Some(self.dart)).unwrap().clone()
    }
}

fn leg(by: OperationId, index: u16) -> EdgeName {
    Name::Made {
        by,
        role: Role::Leg,
        index,
    }
}

/// The dart of a stage: its legs, and the edges before and after them.
fn around(stage: &Stage, dart: OperationId) -> [&StageEdge; 4] {
    let edges = stage.outline();
    let first = edges.iter().position(|e| e.name == leg(dart, 0)).unwrap();
    let count = edges.len();
    [count - 1, 0, 1, 2].map(|step| &edges[(first + step) % count])
}

/// The angle from one direction to another.
fn angle(from: Vec2, to: Vec2) -> f64 {
    from.perp(&to).atan2(from.dot(&to))
}

fn turned(v: Vec2, angle: f64) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

/// The angle that lays the second leg on the first, about the apex.
fn closing(stage: &Stage, dart: OperationId) -> (Vec2, f64) {
    let [_, first, second, _] = around(stage, dart);
    let apex = first.curve.end();
    let ends = [first.curve.start() - apex, second.curve.end() - apex];
    (apex, angle(ends[1], ends[0]))
}

/// By how much the edge turns across the closed dart (deg).
fn kink(stage: &Stage, dart: OperationId) -> f64 {
    let [before, _, _, after] = around(stage, dart);
    let closed = turned(after.curve.derivative(0.0), closing(stage, dart).1);
    angle(before.curve.derivative(1.0), closed).to_degrees()
}

fn pairs() -> Vec<Pair> {
    let mut pairs = Vec::new();
    for name in SHIPPED {
        let pattern = shipped(name);
        for panel in pattern.panels.iter().filter(|panel| !panel.is_split()) {
            let edges = panel.outline().map_or(&[][..], |line| &line.edges);
            for (edge, share) in edges.iter().flat_map(|e| [0.3, 0.45, 0.62].map(|s| (e, s))) {
                pairs.extend(Pair::new(&pattern, panel, edge, share));
            }
        }
    }
    pairs
}

#[test]
fn closed_darts_leave_no_kink_on_shipped_edges_in_every_size() {
    let pairs = pairs();
    assert!(pairs.len() >= 60, "{}", pairs.len());
    let mut curved = 0;
    for pair in &pairs {
        for size in &pair.pattern.sizes {
            let wearer = Wearer::from(size);
            let plain = pair.stage(&wearer, (Pressed::Before, false));
            let words = format!("{} {}", pair.words, size.name);
            for side in [Pressed::Before, Pressed::After] {
                let stage = pair.stage(&wearer, (side, true));
                let [_, first, second, _] = around(&stage, pair.dart);
                let legs = [first.curve.length(), second.curve.length()];
                assert!((legs[0] - legs[1]).abs() < EXACT, "{words}: {legs:?}");
                let kink = kink(&stage, pair.dart);
                assert!(kink.abs() < NO_KINK, "{words}: {kink} degrees");
                // Legs lie where they lay, and all that is not beside the dart is as it was.
                for (index, at) in [(0, 1), (1, 2)] {
                    let old = around(&plain, pair.dart)[at].curve;
                    let new = [first, second][index].curve;
                    let ways = [old, new].map(|leg| leg.end() - leg.start());
                    assert!(angle(ways[0], ways[1]).abs() < EXACT, "{words}");
                }
                let others = |stage: &Stage| -> Vec<(EdgeName, f64)> {
                    let own = [Name::Drawn(pair.edge), leg(pair.dart, 0), leg(pair.dart, 1)];
                    let edges = stage.lines.iter().flat_map(|line| &line.edges);
                    let others = edges.filter(|edge| !own.contains(&edge.name));
                    others.map(|e| (e.name, e.curve.length())).collect()
                };
                for (a, b) in others(&stage).into_iter().zip(others(&plain)) {
                    assert!(a.0 == b.0 && (a.1 - b.1).abs() < EXACT, "{words}");
                }
                curved += ends_stay(&stage, &plain, (pair, &words));
            }
        }
    }
    assert!(curved > 300, "{curved}");
}

/// The far corners stay; so do the directions there of a curve, and what was straight is straight.
fn ends_stay(stage: &Stage, plain: &Stage, (pair, words): (&Pair, &str)) -> usize {
    let of = |stage: &Stage| -> Vec<Curve> {
        let edges = stage.outline().iter();
        let own = edges.filter(|edge| edge.name == Name::Drawn(pair.edge));
        let mut own: Vec<&StageEdge> = own.collect();
        own.sort_by(|a, b| a.from.total_cmp(&b.from));
        own.iter().map(|edge| edge.curve).collect()
    };
    let (new, old) = (of(stage), of(plain));
    let ends = |curves: &[Curve]| {
        let (first, last) = (curves[0], curves[curves.len() - 1]);
        let ways = [first.derivative(0.0), last.derivative(1.0)];
        ([first.start(), last.end()], ways)
    };
    let (places, ways) = ends(&new);
    let (old_places, old_ways) = ends(&old);
    for k in 0..2 {
        assert!((places[k] - old_places[k]).norm() < EXACT, "{words}");
    }
    let is_line = |curves: &[Curve]| curves.iter().all(|c| matches!(c, Curve::Line { .. }));
    if is_line(&new) {
        let (apex, turn) = closing(stage, pair.dart);
        let end = apex + turned(places[1] - apex, turn);
        let before = around(stage, pair.dart)[0].curve.end();
        let chord = end - places[0];
        assert!(
            chord.perp(&(before - places[0])).abs() / chord.norm() < EXACT,
            "{words}"
        );
        return 0;
    }
    let is_curved = !is_line(&old);
    let stays = [0, 1].map(|k| angle(ways[k], old_ways[k]).abs() < 1e-9);
    assert!(stays[0] || stays[1], "{words}");
    assert!(!is_curved || stays == [true; 2], "{words}");
    usize::from(is_curved)
}

/// A front of 40 by 60 cm with a trued dart in its top edge, and 1 cm of cloth outside.
fn front(pressed: Pressed) -> (Pattern, OperationId) {
    let mut pattern = Pattern::new("front");
    let mut ids = Ids::default();
    let fabric: FabricId = ids.take();
    pattern.fabrics.push(Arc::new(Fabric::poplin(fabric)));
    let mut drawing = PanelBuilder::new(&mut ids, "front", fabric);
    let corners = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.6), (0.0, 0.6)];
    let points = corners.map(|(x, y)| drawing.point(format!("{x} {y}"), PointRule::at(x, y)));
    let names = ["bottom", "right", "top", "left"];
    let edges: Vec<Edge> = (0..4)
        .map(|k| drawing.edge(names[k], [points[k], points[(k + 1) % 4]], CurveRule::Line))
        .collect();
    drawing.line("outline", LineKind::Outline, edges);
    let (sheet, mut panel) = drawing.done();
    let id: OperationId = ids.take();
    let own = Arc::make_mut(&mut panel);
    own.allowance = 0.01.into();
    own.operations.push(Arc::new(Operation {
        id,
        name: "dart".into(),
        kind: OperationKind::Dart {
            line: Name::Drawn(own.outline().unwrap().id),
            mouth: Mark::between([points[2], points[3]], 0.4),
            intake: 0.03.into(),
            apex: Apex::Depth(0.11.into()),
            pressed,
            trued: true,
            keeps_length: false,
        },
        meant: false,
    }));
    pattern.add((sheet, panel));
    pattern.ids = ids;
    (pattern, id)
}

#[test]
fn the_piece_as_cut_folds_to_one_straight_edge_pressed_to_either_side() {
    for pressed in [Pressed::Before, Pressed::After] {
        let (pattern, dart) = front(pressed);
        let evaluation = Evaluation::new(&pattern, &toile_measure::Measurements::adult());
        let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
        let (apex, turn) = closing(stage, dart);
        let [before, first, second, after] = around(stage, dart);
        let out = [first.curve.start(), second.curve.end()].map(|p| (p - apex).normalize());
        let middle = out[0] + out[1];
        let mirror = |v: Vec2, axis: Vec2| axis * (2.0 * v.dot(&axis)) - v;
        // Where a place lies once the dart is sewn and pressed.
        let laid = |p: Vec2| {
            let v = p - apex;
            let is_inside = out[0].perp(&v) > 0.0 && out[1].perp(&v) < 0.0;
            let is_first = middle.perp(&v) < 0.0;
            let v = match (is_inside, is_first, pressed) {
                (true, true, Pressed::Before) => mirror(v, out[0]),
                (true, true, Pressed::After) => v,
                (true, false, Pressed::Before) => turned(v, turn),
                (true, false, Pressed::After) => turned(mirror(v, out[1]), turn),
                (false, ..) if middle.perp(&v) < 0.0 => v,
                (false, ..) => turned(v, turn),
            };
            apex + v
        };
        let start = before.curve.start();
        let way = (laid(after.curve.end()) - start).normalize();
        let (draft, _) = evaluation.draft();
        let how = (None, &toile_cut::CutOptions::default());
        let piece = toile_cut::CutPiece::new((&pattern, &draft), 0, how).unwrap();
        let beside = |p: &&Vec2| p.y > 0.5 && (0.03..0.37).contains(&p.x);
        let mouth: Vec<&Vec2> = piece.cut[0].points.iter().filter(beside).collect();
        assert!(mouth.len() >= 3, "{mouth:?}");
        for p in mouth {
            let away = -way.perp(&(laid(*p) - start));
            assert!(
                (away - 0.01).abs() < 1e-6,
                "{pressed:?}: {p} lies {away} m outside"
            );
        }
    }
}
