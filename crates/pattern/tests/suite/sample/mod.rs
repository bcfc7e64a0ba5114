//! A small pattern for tests: a front and a back of 40 by 60 cm, sewn at both sides.

use std::sync::Arc;
use toile_geometry::Vec2;
use toile_measure::Measurements;
use toile_pattern::*;

/// A formula that speaks of measurements alone.
pub fn formula(text: &str) -> Number {
    Number::Formula(Formula::of_measurements(text).unwrap())
}

/// A formula that speaks of parts of a pattern.
pub fn formula_in(pattern: &Pattern, text: &str) -> Number {
    Number::Formula(Formula::parse(text, &Names::new(pattern)).unwrap())
}

/// A rectangle with its lower left corner at the origin; edges are bottom, right, top, left and
/// points p0 to p3, counter-clockwise.
pub fn rectangle(
    ids: &mut Ids,
    name: &str,
    fabric: FabricId,
    [width, height]: [f64; 2],
) -> (Arc<Sheet>, Arc<Panel>) {
    let mut drawing = PanelBuilder::new(ids, name, fabric);
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    let mut k = 0;
    let points = corners.map(|(x, y)| {
        k += 1;
        drawing.point(format!("p{}", k - 1), PointRule::at(x, y))
    });
    let names = ["bottom", "right", "top", "left"];
    let edges = (0..4)
        .map(|k| drawing.edge(names[k], [points[k], points[(k + 1) % 4]], CurveRule::Line))
        .collect();
    drawing.line("outline", LineKind::Outline, edges);
    drawing.done()
}

pub fn panel_id(pattern: &Pattern, name: &str) -> PanelId {
    pattern.panel_named(name).unwrap().id
}

pub fn edge(pattern: &Pattern, panel: &str, name: &str) -> EdgeId {
    let panel = pattern.panel_named(panel).unwrap();
    panel.edge_named(name).unwrap().id
}

/// The outline of a panel.
pub fn outline(pattern: &Pattern, panel: &str) -> LineId {
    pattern.panel_named(panel).unwrap().outline().unwrap().id
}

/// Both corners of an edge.
pub fn ends(pattern: &Pattern, panel: &str, name: &str) -> [PointId; 2] {
    let panel = pattern.panel_named(panel).unwrap();
    panel.edge_named(name).unwrap().ends
}

/// A point of the sheet a panel is traced from.
pub fn point(pattern: &Pattern, panel: &str, name: &str) -> PointId {
    let panel = pattern.panel_named(panel).unwrap();
    let sheet = pattern.sheet(panel.sheet().unwrap()).unwrap();
    sheet.point_named(name).unwrap().id
}

pub fn span(pattern: &Pattern, panel: &str, name: &str) -> Span {
    let panel = pattern.panel_named(panel).unwrap();
    panel.span(panel.edge_named(name).unwrap().id).unwrap()
}

pub fn sample() -> Pattern {
    let mut pattern = Pattern::new("sample");
    let mut ids = Ids::default();
    let fabric: FabricId = ids.take();
    pattern.fabrics.push(Arc::new(Fabric::poplin(fabric)));
    for name in ["front", "back"] {
        pattern.add(rectangle(&mut ids, name, fabric, [0.4, 0.6]));
    }
    for (name, one, other) in [
        ("one side", "right", "left"),
        ("other side", "left", "right"),
    ] {
        let sides = [
            vec![span(&pattern, "front", one)],
            vec![span(&pattern, "back", other).reversed()],
        ];
        let seam = Seam::new(ids.take(), name, sides);
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

/// Sets where a point of the k-th sheet is.
pub fn place(pattern: &mut Pattern, k: usize, name: &str, rule: PointRule) {
    let sheet = Arc::make_mut(&mut pattern.sheets[k]);
    let found = sheet.points.iter_mut().find(|p| p.name == name).unwrap();
    Arc::make_mut(found).rule = rule;
}

/// Sets how the curve of an edge runs.
pub fn bend(pattern: &mut Pattern, k: usize, name: &str, rule: CurveRule) {
    let sheet = Arc::make_mut(&mut pattern.sheets[k]);
    let found = sheet.curves.iter_mut().find(|c| c.name == name).unwrap();
    Arc::make_mut(found).rule = rule;
}

/// Adds a point to the k-th sheet.
pub fn put_point(pattern: &mut Pattern, k: usize, name: &str, rule: PointRule) -> PointId {
    let id = pattern.ids.take();
    let name = name.to_owned();
    let sheet = Arc::make_mut(&mut pattern.sheets[k]);
    sheet.points.push(Arc::new(Point { id, name, rule }));
    id
}

/// Adds a line of straight edges through points to the k-th panel and its sheet.
pub fn put_line(
    pattern: &mut Pattern,
    k: usize,
    (name, kind): (&str, LineKind),
    points: &[PointId],
) -> LineId {
    let line: LineId = pattern.ids.take();
    let closed = usize::from(kind != LineKind::Internal);
    let mut edges = Vec::new();
    for j in 0..points.len() - 1 + closed {
        let ends = [points[j], points[(j + 1) % points.len()]];
        let curve: CurveId = pattern.ids.take();
        let name = format!("{name} {j}");
        Arc::make_mut(&mut pattern.sheets[k])
            .curves
            .push(Arc::new(Curve {
                id: curve,
                name: name.clone(),
                ends,
                rule: CurveRule::Line,
            }));
        edges.push(Edge {
            id: pattern.ids.take(),
            name,
            curve,
            ends,
            allowance: None,
            corner: EdgeCorner::default(),
        });
    }
    let name = name.to_owned();
    alter(pattern, k, |panel| {
        panel.lines.push(Line {
            id: line,
            name,
            kind,
            by: None,
            edges,
        });
    });
    line
}

/// Adds an operation to the k-th panel.
pub fn put_operation(
    pattern: &mut Pattern,
    k: usize,
    name: &str,
    kind: OperationKind,
) -> OperationId {
    let id = pattern.ids.take();
    let name = name.to_owned();
    alter(pattern, k, |panel| {
        panel.operations.push(Arc::new(Operation {
            id,
            name,
            kind,
            meant: false,
        }));
    });
    id
}

/// A dart in an edge of the front.
pub fn dart(pattern: &Pattern, name: &str, share: f64, intake: f64, apex: Apex) -> OperationKind {
    OperationKind::Dart {
        line: Name::Drawn(outline(pattern, "front")),
        mouth: Mark::between(ends(pattern, "front", name), share),
        intake: intake.into(),
        apex,
        trued: false,
        keeps_length: false,
        pressed: Pressed::default(),
    }
}

/// A fold of the front on an edge.
pub fn fold(pattern: &Pattern, name: &str) -> OperationKind {
    OperationKind::Fold {
        line: Name::Drawn(outline(pattern, "front")),
        ends: ends(pattern, "front", name).map(Mark::corner),
    }
}

/// Adds a variable.
pub fn put_variable(pattern: &mut Pattern, name: &str, number: Number) -> VariableId {
    let id = pattern.ids.take();
    let name = name.to_owned();
    pattern
        .variables
        .push(Arc::new(Variable { id, name, number }));
    id
}

/// Where a point lies for an adult.
pub fn at(pattern: &Pattern, point: PointId) -> Vec2 {
    let evaluation = Evaluation::new(pattern, &Measurements::adult());
    evaluation.point(point).unwrap()
}

/// The sample with a curved side, a notch, a dart, a fold of its back, and formulas.
pub fn rich_sample() -> Pattern {
    let mut pattern = sample();
    bend(
        &mut pattern,
        0,
        "right",
        CurveRule::Arc { bulge: 0.2.into() },
    );
    let notch = Notch {
        id: pattern.ids.take(),
        name: "notch".into(),
        line: outline(&pattern, "front"),
        at: Mark::between(ends(&pattern, "front", "right"), 0.75),
        kind: NotchKind::V,
    };
    alter(&mut pattern, 0, |panel| panel.notches.push(notch));
    let kind = dart(&pattern, "top", 0.5, 0.02, Apex::Depth(0.1.into()));
    let by = put_operation(&mut pattern, 0, "dart", kind);
    let role = Role::Mouth;
    let beside = Notch {
        id: pattern.ids.take(),
        name: "beside the dart".into(),
        line: outline(&pattern, "front"),
        at: Mark::Along {
            from: Name::Made { by, role, index: 1 },
            distance: formula("bust / 100"),
        },
        kind: NotchKind::T,
    };
    alter(&mut pattern, 0, |panel| panel.notches.push(beside));
    let number = formula_in(&pattern, "length(front.right) / 10 + y(front.p2) * 0");
    put_variable(&mut pattern, "ease", number);
    let ease = formula_in(&pattern, "ease");
    alter_seam(&mut pattern, 0, |seam| seam.ease = ease);
    for (name, text) in [
        ("waiting", "late + 1cm"),
        (
            "other",
            "length(back.'late edge') + length('late edge') + x(front.late)",
        ),
        ("third", "length(right) + if(0, x(front.lat), 1cm)"),
        ("fourth", "waiting * 2 + ears"),
    ] {
        let number = formula_in(&pattern, text);
        put_variable(&mut pattern, name, number);
    }
    let id = pattern.ids.take();
    pattern.sizes.push(Arc::new(Size {
        id,
        name: "M".into(),
        measurements: Measurements::adult(),
    }));
    pattern
}

/// What is found wrong with a pattern, but for kinks: samples are drawn without care for them.
pub fn faults(pattern: &Pattern) -> Vec<Diagnostic> {
    let mut found = pattern.check(&Measurements::adult());
    found.retain(|found| found.code != Code::Kink);
    found
}
