//! A small pattern for tests: a front and a back of 40 by 60 cm, sewn at both sides.
#![allow(dead_code)]

use std::sync::Arc;
use toile_pattern::*;

pub const FRONT: PanelId = PanelId(0);
pub const BACK: PanelId = PanelId(1);

pub fn formula(text: &str) -> Number {
    Number::formula(text).unwrap()
}

/// A rectangle with its lower left corner at the origin; edges are bottom, right, top, left and
/// points p0 to p3, counter-clockwise.
pub fn rectangle(ids: &mut IdCounters, name: &str, [width, height]: [f64; 2]) -> Panel {
    let mut panel = Panel::new(ids.take_panel(), name, FabricId(0));
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    for (k, (x, y)) in corners.into_iter().enumerate() {
        panel.points.push(Point {
            id: ids.take_point(),
            name: format!("p{k}"),
            place: PointPlace::at(x, y),
        });
    }
    for (k, name) in ["bottom", "right", "top", "left"].into_iter().enumerate() {
        panel.outline.push(Edge {
            id: ids.take_edge(),
            name: name.into(),
            ends: [panel.points[k].id, panel.points[(k + 1) % 4].id],
            curve: EdgeCurve::Line,
            seam_allowance: None,
        });
    }
    panel
}

pub fn edge(pattern: &Pattern, panel: &str, name: &str) -> (PanelId, EdgeId) {
    let panel = pattern.panel_named(panel).unwrap();
    (panel.id, panel.edge_named(name).unwrap().id)
}

pub fn span(pattern: &Pattern, panel: &str, name: &str) -> Span {
    let (panel, edge) = edge(pattern, panel, name);
    Span::whole(panel, edge)
}

pub fn sample() -> Pattern {
    let mut pattern = Pattern::new("sample");
    let mut ids = IdCounters::default();
    pattern
        .fabrics
        .push(Arc::new(Fabric::poplin(ids.take_fabric())));
    for name in ["front", "back"] {
        let panel = rectangle(&mut ids, name, [0.4, 0.6]);
        pattern.panels.push(Arc::new(panel));
    }
    for (name, one, other) in [
        ("one side", "right", "left"),
        ("other side", "left", "right"),
    ] {
        let sides = [
            vec![span(&pattern, "front", one)],
            vec![span(&pattern, "back", other).reversed()],
        ];
        let seam = Seam::new(ids.take_seam(), name, sides);
        pattern.seams.push(Arc::new(seam));
    }
    pattern.ids = ids;
    pattern
}

/// Changes one panel of a pattern, past all checks of edits.
pub fn alter(pattern: &mut Pattern, k: usize, change: impl FnOnce(&mut Panel)) {
    change(Arc::make_mut(&mut pattern.panels[k]));
}

/// Changes one seam of a pattern, past all checks of edits.
pub fn alter_seam(pattern: &mut Pattern, k: usize, change: impl FnOnce(&mut Seam)) {
    change(Arc::make_mut(&mut pattern.seams[k]));
}

pub fn put_point(pattern: &mut Pattern, k: usize, name: &str, place: PointPlace) -> PointId {
    let id = pattern.ids.take_point();
    let name = name.to_owned();
    alter(pattern, k, |panel| {
        panel.points.push(Point { id, name, place })
    });
    id
}
