//! Patterns at random, most of them nonsense, for property tests.

mod markers;

use markers::markers;
use std::sync::Arc;
use toile_measure::{Measurements, Origin};
use toile_pattern::*;

/// Repeatable randomness (SplitMix64, Steele et al. 2014).
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number below `end`, 0 if that is 0.
    pub fn below(&mut self, end: usize) -> usize {
        (self.roll() % end.max(1) as u64) as usize
    }

    fn chance(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }

    fn fraction(&mut self) -> f64 {
        (self.roll() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn value(&mut self) -> f64 {
        match self.below(12) {
            0 => 0.0,
            1 => f64::from_bits(self.roll()),
            2 => -self.fraction() * 1e6,
            3 => self.fraction() * 1e-9,
            4 => (self.below(400) as f64 - 200.0) / 1000.0,
            _ => self.fraction() - 0.3,
        }
    }

    fn finite(&mut self) -> f64 {
        let value = self.value();
        if value.is_finite() { value } else { 0.25 }
    }

    fn number(&mut self) -> Number {
        const FORMULAS: [&str; 17] = [
            "bust / 4 + 2cm",
            "waist",
            "ease",
            "loop",
            "-hips * 0.3",
            "1 / (bust - bust)",
            "sqrt(waist * waist)",
            "length(panel0.e0)",
            "length('panel 1'.e1) / 2",
            "finished(panel0.p0..panel0.p2) + length('seam 0')",
            "if(bust > 90cm, 1 5/8in, round(waist, 5mm))",
            "x(panel0.p2)",
            "tan(shoulder_incl) * 10cm",
            "elephant",
            "0.5",
            "90deg",
            "max(1cm, bust - waist)",
        ];
        if self.chance(70) {
            return Number::Value(self.finite());
        }
        let text = FORMULAS[self.below(FORMULAS.len())];
        let Ok(formula) = Formula::of_measurements(text) else {
            return Number::Value(0.1);
        };
        match self.below(8) {
            0 => Number::Adjusted {
                formula,
                by: self.finite(),
            },
            1 => Number::PerSize {
                usual: Box::new(Number::Formula(formula)),
                sizes: vec![(SizeId(0), self.finite())],
            },
            _ => Number::Formula(formula),
        }
    }

    fn share(&mut self) -> Number {
        if self.chance(80) {
            Number::Value(self.fraction())
        } else {
            self.number()
        }
    }
}

/// A pattern at random. Names are unique; most else is left to chance.
pub fn random_pattern(dice: &mut Dice) -> Pattern {
    let mut pattern = Pattern::new(["", "Größe \"42\"\n", "skirt"][dice.below(3)]);
    pattern.unit = [
        DisplayUnit::Millimetre,
        DisplayUnit::Centimetre,
        DisplayUnit::Metre,
        DisplayUnit::Inch,
    ][dice.below(4)];
    let mut ids = Ids::default();
    for k in 0..1 + dice.below(2) {
        pattern.sizes.push(Arc::new(Size {
            id: ids.take(),
            name: format!("size {k}"),
            measurements: measurements(dice),
        }));
    }
    if dice.chance(50) {
        pattern.base_size = Some(pattern.sizes[0].id);
    }
    for name in ["ease", "loop", "loop_b"] {
        if dice.chance(60) {
            pattern.variables.push(Arc::new(Variable {
                id: ids.take(),
                name: name.into(),
                number: Number::ZERO,
            }));
        }
    }
    for k in 0..=dice.below(3) {
        let id = ids.take();
        let fabric = fabric(dice, id, k);
        pattern.fabrics.push(Arc::new(fabric));
    }
    for k in 0..dice.below(4) {
        let drawn = panel(dice, &mut ids, k, &pattern);
        pattern.add(drawn);
    }
    for k in 0..dice.below(6) {
        let sides = [spans(dice, &pattern), spans(dice, &pattern)];
        let mut seam = Seam::new(ids.take(), format!("seam {k}"), sides);
        seam.ease = dice.number();
        seam.gathered = dice.chance(20);
        seam.right_sides_together = dice.chance(80);
        seam.multi_ply = dice.chance(20);
        pattern.seams.push(Arc::new(seam));
    }
    pattern.markers = markers(dice, &mut ids, &pattern);
    for _ in 0..dice.below(4) {
        let runs = match dice.chance(50) {
            true => GuideRun::Horizontal,
            false => GuideRun::Vertical,
        };
        pattern.guides.push(Arc::new(Guide {
            id: ids.take(),
            runs,
            at: dice.finite(),
        }));
    }
    ids.next += dice.below(3) as u32;
    pattern.ids = ids;
    bind(&pattern)
}

/// The pattern with variables that need each other and formulas that know its parts.
fn bind(pattern: &Pattern) -> Pattern {
    let mut bound = pattern.clone();
    let names = Names::new(pattern);
    for variable in &mut bound.variables {
        let text = match &*variable.name {
            "ease" => "4cm",
            "loop" => "loop_b",
            _ => "loop + length(panel0.e1) / 1m",
        };
        let formula = Formula::parse(text, &names).expect("the formula is right");
        Arc::make_mut(variable).number = Number::Formula(formula);
    }
    bound
}

fn measurements(dice: &mut Dice) -> Measurements {
    let mut table = Measurements::new();
    for name in ["bust", "waist", "shoulder_incl", "left_ear", "hips"] {
        if dice.chance(80) {
            let origin = if dice.chance(80) {
                Origin::Asked
            } else {
                Origin::Predicted
            };
            let value = dice.finite();
            table
                .set(name, value, origin)
                .expect("name and value are right");
        }
    }
    table
}

fn fabric(dice: &mut Dice, id: FabricId, k: usize) -> Fabric {
    let mut fabric = Fabric::poplin(id);
    if dice.chance(50) {
        fabric.material.stretch = [600.0, 450.0];
        fabric.material.poisson = 0.3;
    }
    fabric.name = format!("cloth {k}");
    fabric.nap = dice.chance(30);
    if dice.chance(20) {
        fabric.material.density = dice.finite();
        fabric.material.bend[1] = dice.finite();
    }
    if dice.chance(20) {
        fabric.material.viscosity = dice.finite().abs();
        fabric.material.relaxed_fraction = [0.0, 0.25];
        fabric.material.relaxation_time = 3.5;
    }
    fabric
}

fn panel(dice: &mut Dice, ids: &mut Ids, k: usize, pattern: &Pattern) -> (Arc<Sheet>, Arc<Panel>) {
    let name = ["panel0", "panel 1", "panel.2", "Größe"][k];
    let fabric = pattern.fabrics[dice.below(pattern.fabrics.len())].id;
    let mut drawing = PanelBuilder::new(ids, name, fabric);
    let corners = dice.below(9);
    let mut points: Vec<PointId> = Vec::new();
    for j in 0..corners + 4 {
        let curves: Vec<CurveId> = drawing.sheet.curves.iter().map(|c| c.id).collect();
        let rule = rule(dice, &points, &curves, (j, corners));
        points.push(drawing.point(format!("p{j}"), rule));
        if j > 1 && dice.chance(20) {
            let rule = curve(dice, &points);
            drawing.edge(format!("c{j}"), [points[j - 1], points[j]], rule);
        }
    }
    let line = |dice: &mut Dice, drawing: &mut PanelBuilder<'_>, name: &str, ends: usize| {
        let mut edges = Vec::new();
        for j in 0..ends {
            let mut at = [j, (j + 1) % ends].map(|k| points[k % points.len()]);
            if dice.chance(3) {
                at[1] = points[dice.below(points.len())];
            }
            let rule = curve(dice, &points);
            let mut edge = drawing.edge(format!("{name}{j}"), at, rule);
            edge.allowance = dice.chance(20).then(|| dice.number());
            if dice.chance(20) {
                edge.corner.kind = Corner::Mirrored;
            }
            edge.corner.meant = dice.chance(10);
            if dice.chance(10) {
                edge.corner.limit = MitreLimit::None;
            }
            edges.push(edge);
        }
        edges
    };
    let edges = line(dice, &mut drawing, "e", corners);
    drawing.line("outline", LineKind::Outline, edges);
    if dice.chance(15) {
        let count = dice.below(4);
        let edges = line(dice, &mut drawing, "h", count);
        drawing.line("hole", LineKind::Hole, edges);
    }
    for k in 0..dice.below(3) {
        let count = dice.below(4);
        let edges = line(dice, &mut drawing, &format!("i{k}"), count);
        drawing.line(format!("line {k}"), LineKind::Internal, edges);
    }
    drawing.panel.grain = dice.number();
    drawing.panel.allowance = dice.number();
    drawing.panel.cut = Cut {
        quantity: [0, 1, 1, 2, 2, 3, 5000][dice.below(7)],
        mirrored: dice.chance(50),
    };
    drawing.panel.worn = worn(dice);
    details(dice, &mut drawing, &points);
    drawing.done()
}

fn rule(
    dice: &mut Dice,
    points: &[PointId],
    curves: &[CurveId],
    (j, corners): (usize, usize),
) -> PointRule {
    let any = |dice: &mut Dice| points[dice.below(points.len())];
    if dice.chance(60) || points.is_empty() {
        let angle = std::f64::consts::TAU * j as f64 / corners.max(1) as f64;
        if dice.chance(60) {
            return PointRule::at(angle.cos() * 0.4, angle.sin() * 0.3);
        }
        return PointRule::At {
            x: dice.number(),
            y: dice.number(),
        };
    }
    let curve = curves.get(dice.below(curves.len())).copied();
    match (dice.below(13), curve) {
        (0, _) => PointRule::Offset {
            base: any(dice),
            x: dice.number(),
            y: dice.number(),
        },
        (1, _) => PointRule::Polar {
            base: any(dice),
            angle: dice.number(),
            distance: dice.number(),
        },
        (2, _) => PointRule::Between {
            base: any(dice),
            tip: any(dice),
            along: dice.share(),
            aside: dice.share(),
        },
        (3, _) => PointRule::Toward {
            base: any(dice),
            tip: any(dice),
            distance: dice.number(),
        },
        (4, _) => PointRule::Crossing {
            first: [any(dice), any(dice)],
            second: [any(dice), any(dice)],
        },
        (5, Some(curve)) => PointRule::OnCurve {
            curve,
            share: dice.share(),
        },
        (6, Some(curve)) => PointRule::AlongCurve {
            curve,
            distance: dice.number(),
        },
        (7, Some(curve)) => PointRule::LineCrossing {
            line: [any(dice), any(dice)],
            curve,
            index: dice.below(2) as u16,
        },
        (8, Some(curve)) => PointRule::CurveCrossing {
            curves: [curve, curves[0]],
            index: 0,
        },
        (9, _) => PointRule::Foot {
            base: any(dice),
            line: [any(dice), any(dice)],
        },
        (10, _) => PointRule::OnLineAt {
            line: [any(dice), any(dice)],
            centre: any(dice),
            distance: dice.number(),
            far: dice.chance(50),
        },
        (11, _) => PointRule::TwoDistances {
            centres: [any(dice), any(dice)],
            distances: [dice.number(), dice.number()],
            left: dice.chance(50),
        },
        _ => PointRule::Mirrored {
            base: any(dice),
            line: [any(dice), any(dice)],
        },
    }
}

fn curve(dice: &mut Dice, points: &[PointId]) -> CurveRule {
    let any = |dice: &mut Dice| points[dice.below(points.len())];
    match dice.below(8) {
        0 => CurveRule::Arc {
            bulge: dice.number(),
        },
        1 => CurveRule::cubic([any(dice), any(dice)]),
        2 => CurveRule::Spline {
            handles: [any(dice), any(dice)],
            knots: vec![Knot {
                before: any(dice),
                point: any(dice),
                after: any(dice),
            }],
            to_length: dice.chance(30).then(|| dice.number()),
        },
        _ => CurveRule::Line,
    }
}

/// A mark on a line by its edges' corners.
fn mark(dice: &mut Dice, edges: &[Edge]) -> Mark {
    let edge = &edges[dice.below(edges.len())];
    match dice.below(4) {
        0 => Mark::corner(edge.ends[0]),
        1 => Mark::Along {
            from: Name::Drawn(edge.ends[0]),
            distance: dice.number(),
        },
        _ => Mark::between(edge.ends, dice.share()),
    }
}

fn worn(dice: &mut Dice) -> WornRule {
    match dice.below(3) {
        0 => WornRule::Automatic,
        1 => WornRule::Wrapped {
            part: BodyPart::LeftArm,
            facing: Facing::Around,
            level: dice.chance(50).then(|| dice.number()),
        },
        _ => WornRule::Placed {
            translation: [dice.finite(), dice.finite(), dice.finite()],
            rotation: [0.0, dice.finite(), 0.0, dice.finite()],
        },
    }
}

fn details(dice: &mut Dice, drawing: &mut PanelBuilder<'_>, points: &[PointId]) {
    let any = |dice: &mut Dice| points[dice.below(points.len())];
    let lines = drawing.panel.lines.clone();
    let lines: Vec<&Line> = lines.iter().filter(|line| !line.edges.is_empty()).collect();
    if lines.is_empty() {
        return;
    }
    for k in 0..dice.below(3) {
        let line = lines[dice.below(lines.len())];
        let notch = Notch {
            id: drawing.id(),
            name: format!("notch {k}"),
            line: line.id,
            at: mark(dice, &line.edges),
            kind: NotchKind::Castle,
        };
        drawing.panel.notches.push(notch);
    }
    for k in 0..dice.below(4) {
        let line = lines[dice.below(lines.len())];
        let kind = match dice.below(8) {
            7 => OperationKind::Insert {
                sheet: drawing.sheet.id,
            },
            6 => OperationKind::Split {
                line: Name::Drawn(line.id),
                curve: line.edges[0].curve,
            },
            4 => OperationKind::Pivot {
                dart: match drawing.panel.operations.first() {
                    Some(known) => known.id,
                    None => drawing.id(),
                },
                line: Name::Drawn(line.id),
                mouth: mark(dice, &line.edges),
                share: dice.share(),
                back: dice.number(),
                turned: match dice.chance(50) {
                    true => Turned::FromDart,
                    false => Turned::ToDart,
                },
                pressed: Pressed::After,
            },
            5 => OperationKind::Spread {
                line: Name::Drawn(line.id),
                held: mark(dice, &line.edges),
                cuts: (0..dice.below(3) as u16)
                    .map(|k| SpreadCut {
                        number: 3 * k,
                        ends: [mark(dice, &line.edges), mark(dice, &line.edges)],
                        openings: [dice.number(), Number::ZERO],
                    })
                    .collect(),
                bridge: match dice.chance(50) {
                    true => Bridge::Straight,
                    false => Bridge::Smooth,
                },
            },
            0 => OperationKind::Diamond {
                ends: [any(dice), any(dice)],
                widest: dice.share(),
                intake: dice.number(),
            },
            1 => {
                let edge = &line.edges[dice.below(line.edges.len())];
                OperationKind::Fold {
                    line: Name::Drawn(line.id),
                    ends: edge.ends.map(Mark::corner),
                }
            }
            _ => OperationKind::Dart {
                line: Name::Drawn(line.id),
                mouth: mark(dice, &line.edges),
                intake: Number::Value(dice.fraction() * 0.05),
                apex: match dice.chance(50) {
                    true => Apex::Depth(dice.share()),
                    false => Apex::Point(any(dice)),
                },
                trued: dice.chance(50),
                keeps_length: dice.chance(50),
                pressed: match dice.chance(50) {
                    true => Pressed::Before,
                    false => Pressed::After,
                },
            },
        };
        let operation = Operation {
            meant: dice.chance(10),
            id: drawing.id(),
            name: format!("operation {k}"),
            kind,
        };
        drawing.panel.operations.push(Arc::new(operation));
    }
}

fn spans(dice: &mut Dice, pattern: &Pattern) -> Vec<Span> {
    let mut spans = Vec::new();
    for _ in 0..dice.below(4) {
        let Some(panel) = pattern.panels.get(dice.below(pattern.panels.len())) else {
            continue;
        };
        let lines: Vec<&Line> = panel.lines.iter().filter(|l| !l.edges.is_empty()).collect();
        let Some(line) = lines.get(dice.below(lines.len())) else {
            continue;
        };
        spans.push(Span {
            panel: panel.id,
            copy: dice.below(3) as u32,
            half: u8::from(dice.chance(20)),
            line: Name::Drawn(line.id),
            from: mark(dice, &line.edges),
            to: mark(dice, &line.edges),
            backwards: dice.chance(40),
        });
    }
    spans
}
