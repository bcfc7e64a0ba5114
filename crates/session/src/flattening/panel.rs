//! A flattened panel as a pattern of one panel: cubics, darts as operations, the grain upright.

use std::sync::Arc;
use toile_flatten::{Cubic, PanelOutline};
use toile_geometry::Vec2;
use toile_pattern::{
    Apex, CurveRule, Edge, Fabric, Knot, LineKind, Mark, Name, Number, Operation, OperationKind,
    PanelBuilder, Pattern, PointId, PointRule, Pressed,
};

/// Distance of handles from the chord below which a curve is a straight line (m).
const STRAIGHT: f64 = 1e-6;

/// The pattern of one panel cut from a fabric.
pub(super) fn panel_pattern(name: &str, fabric: Fabric, outline: &PanelOutline) -> Pattern {
    let mut pattern = Pattern::new(name);
    let mut ids = pattern.ids;
    let fabric = Fabric {
        id: ids.take(),
        ..fabric
    };
    let mut drawing = PanelBuilder::new(&mut ids, name, fabric.id);
    let starts: Vec<Option<Vec2>> = (outline.edges.iter())
        .map(|edge| edge.cubics.first().map(|cubic| cubic[0]))
        .collect();
    let corners: Vec<PointId> = (starts.iter().enumerate())
        .map(|(k, place)| {
            at(
                &mut drawing,
                format!("p{}", k + 1),
                place.unwrap_or_default(),
            )
        })
        .collect();
    let mut edges: Vec<Edge> = Vec::with_capacity(corners.len());
    let mut mouths = Vec::new();
    for (k, edge) in outline.edges.iter().enumerate() {
        let ends = [corners[k], corners[(k + 1) % corners.len()]];
        let name = match edge.mouth {
            Some(dart) => format!("mouth {}", dart + 1),
            None => format!("edge {}", k + 1),
        };
        let rule = rule(&mut drawing, &format!("e{}", k + 1), &edge.cubics);
        edges.push(drawing.edge(name, ends, rule));
        if let Some(dart) = edge.mouth {
            mouths.push((dart, ends));
        }
    }
    let line = drawing.line("outline", LineKind::Outline, edges);
    for dart in &outline.darts {
        let Some((_, ends)) = mouths.iter().find(|mouth| mouth.0 == dart.dart) else {
            continue;
        };
        let name = format!("dart {}", dart.dart + 1);
        let apex = at(&mut drawing, format!("apex {}", dart.dart + 1), dart.apex);
        let operation = Operation {
            id: drawing.id(),
            name,
            kind: OperationKind::Dart {
                line: Name::Drawn(line),
                mouth: Mark::between(*ends, 0.5),
                intake: Number::Value(dart.intake),
                apex: Apex::Point(apex),
                pressed: Pressed::Before,
                trued: false,
                keeps_length: false,
            },
            meant: false,
        };
        drawing.panel.operations.push(Arc::new(operation));
    }
    let drawn = drawing.done();
    pattern.ids = ids;
    pattern.fabrics.push(Arc::new(fabric));
    pattern.add(drawn);
    pattern
}

fn at(drawing: &mut PanelBuilder<'_>, name: String, place: Vec2) -> PointId {
    let (x, y) = (Number::Value(place.x), Number::Value(place.y));
    drawing.point(name, PointRule::At { x, y })
}

fn rule(drawing: &mut PanelBuilder<'_>, name: &str, cubics: &[Cubic]) -> CurveRule {
    let (Some(first), Some(last)) = (cubics.first(), cubics.last()) else {
        return CurveRule::Line;
    };
    let off = |[a, b, c, d]: &Cubic| {
        let along = (d - a).try_normalize(0.0).unwrap_or_default();
        along.perp(&(b - a)).abs().max(along.perp(&(c - a)).abs())
    };
    if cubics.len() == 1 && off(first) < STRAIGHT {
        return CurveRule::Line;
    }
    let start = at(drawing, format!("{name} start"), first[1]);
    let knots = (cubics.windows(2).enumerate())
        .map(|(k, pair)| Knot {
            before: at(drawing, format!("{name} before {}", k + 1), pair[0][2]),
            point: at(drawing, format!("{name} knot {}", k + 1), pair[0][3]),
            after: at(drawing, format!("{name} after {}", k + 1), pair[1][1]),
        })
        .collect();
    let end = at(drawing, format!("{name} end"), last[2]);
    CurveRule::Spline {
        handles: [start, end],
        knots,
        to_length: None,
    }
}
