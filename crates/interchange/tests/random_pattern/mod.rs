//! Patterns at random, most of them nonsense, for property tests.

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
        const FORMULAS: [&str; 16] = [
            "bust / 4 + 2cm",
            "waist",
            "ease",
            "loop_b",
            "-hips * 0.3",
            "1 / (bust - bust)",
            "sqrt(waist * waist)",
            "length(panel0.e0)",
            "length('panel 1'.e1) / 2",
            "distance(panel0.p0, panel0.p1)",
            "x(panel0.p2)",
            "tan(shoulder_incl) * 10cm",
            "elephant",
            "0.5",
            "90deg",
            "max(1cm, ease, bust - waist)",
        ];
        if self.chance(70) {
            Number::Value(self.finite())
        } else {
            let text = FORMULAS[self.below(FORMULAS.len())];
            Number::formula(text).unwrap_or(Number::Value(0.1))
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
    for k in 0..dice.below(3) {
        pattern.sizes.push(Size {
            name: format!("size {k}"),
            measurements: measurements(dice),
        });
    }
    if !pattern.sizes.is_empty() && dice.chance(50) {
        pattern.base_size = Some("size 0".into());
    }
    for (name, formula) in [("ease", "4cm"), ("loop", "loop_b"), ("loop_b", "loop + 1")] {
        if dice.chance(60) {
            pattern.variables.push(Variable {
                name: name.into(),
                number: Number::formula(formula).expect("the formula is right"),
            });
        }
    }
    let mut ids = IdCounters {
        panel: dice.below(3) as u32,
        point: dice.below(20) as u32,
        ..IdCounters::default()
    };
    for k in 0..=dice.below(3) {
        let fabric = fabric(dice, ids.take_fabric(), k);
        pattern.fabrics.push(Arc::new(fabric));
    }
    for k in 0..dice.below(4) {
        let panel = panel(dice, &mut ids, k, &pattern);
        pattern.panels.push(Arc::new(panel));
    }
    for k in 0..dice.below(6) {
        let sides = [spans(dice, &pattern), spans(dice, &pattern)];
        let mut seam = Seam::new(ids.take_seam(), format!("seam {k}"), sides);
        seam.ease = dice.number();
        seam.gathered = dice.chance(20);
        seam.right_sides_together = dice.chance(80);
        seam.multi_ply = dice.chance(20);
        pattern.seams.push(Arc::new(seam));
        if dice.chance(10) {
            ids.take_seam();
        }
    }
    ids.notch += dice.below(3) as u32;
    pattern.ids = ids;
    pattern
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
    let mut fabric = if dice.chance(50) {
        Fabric::poplin(id)
    } else {
        Fabric::jersey(id)
    };
    fabric.name = format!("cloth {k}");
    fabric.nap = dice.chance(30);
    if dice.chance(20) {
        fabric.density = dice.finite();
        fabric.bend[1] = dice.finite();
    }
    if dice.chance(20) {
        fabric.rheology.viscosity = dice.finite().abs();
        fabric.rheology.kept = [0.0, 0.25];
        fabric.rheology.relaxation_time = 3.5;
    }
    fabric
}

fn panel(dice: &mut Dice, ids: &mut IdCounters, k: usize, pattern: &Pattern) -> Panel {
    let name = ["panel0", "panel 1", "panel.2", "Größe"][k].to_owned();
    let fabric = pattern.fabrics[dice.below(pattern.fabrics.len())].id;
    let mut panel = Panel::new(ids.take_panel(), name, fabric);
    let corners = dice.below(9);
    for j in 0..corners + 4 {
        let id = ids.take_point();
        if dice.chance(10) {
            ids.take_point();
        }
        let place = place(dice, &panel, j, corners);
        panel.points.push(Point {
            id,
            name: format!("p{j}"),
            place,
        });
    }
    let loose: Vec<PointId> = panel.points.iter().map(|p| p.id).collect();
    for j in 0..corners {
        let edge = edge(dice, ids, &loose, [j, (j + 1) % corners]);
        panel.outline.push(edge);
    }
    if dice.chance(15) {
        let hole: Vec<_> = (0..dice.below(4))
            .map(|j| edge(dice, ids, &loose, [j, j + 1]))
            .collect();
        panel.holes.push(hole);
    }
    panel.grain = dice.number();
    panel.seam_allowance = dice.number();
    panel.cut = Cut {
        quantity: [0, 1, 1, 2, 2, 3, 5000][dice.below(7)],
        mirrored: dice.chance(50),
    };
    panel.worn = worn(dice);
    details(dice, ids, &mut panel, &loose);
    panel
}

fn place(dice: &mut Dice, panel: &Panel, j: usize, corners: usize) -> PointPlace {
    let earlier = |dice: &mut Dice| panel.points[dice.below(panel.points.len())].id;
    if dice.chance(60) || panel.points.is_empty() {
        let angle = std::f64::consts::TAU * j as f64 / corners.max(1) as f64;
        if dice.chance(60) {
            return PointPlace::at(angle.cos() * 0.4, angle.sin() * 0.3);
        }
        return PointPlace::At {
            x: dice.number(),
            y: dice.number(),
        };
    }
    match dice.below(6) {
        0 => PointPlace::Offset {
            base: earlier(dice),
            x: dice.number(),
            y: dice.number(),
        },
        1 => PointPlace::Polar {
            base: earlier(dice),
            angle: dice.number(),
            distance: dice.number(),
        },
        2 => PointPlace::Between {
            base: earlier(dice),
            tip: earlier(dice),
            along: dice.share(),
            aside: dice.share(),
        },
        3 => PointPlace::Toward {
            base: earlier(dice),
            tip: earlier(dice),
            distance: dice.number(),
        },
        4 => PointPlace::Crossing {
            first: [earlier(dice), earlier(dice)],
            second: [earlier(dice), earlier(dice)],
        },
        _ => PointPlace::Mirrored {
            base: earlier(dice),
            line: [earlier(dice), earlier(dice)],
        },
    }
}

fn curve(dice: &mut Dice, points: &[PointId]) -> EdgeCurve {
    let any = |dice: &mut Dice| points[dice.below(points.len())];
    match dice.below(8) {
        0 => EdgeCurve::Arc {
            bulge: dice.number(),
        },
        1 => EdgeCurve::Quadratic { control: any(dice) },
        2 => EdgeCurve::Cubic {
            controls: [any(dice), any(dice)],
        },
        _ => EdgeCurve::Line,
    }
}

fn edge(dice: &mut Dice, ids: &mut IdCounters, points: &[PointId], ends: [usize; 2]) -> Edge {
    let id = ids.take_edge();
    let mut ends = ends.map(|k| points[k % points.len()]);
    if dice.chance(3) {
        ends[1] = points[dice.below(points.len())];
    }
    Edge {
        id,
        name: format!("e{}", id.0),
        ends,
        curve: curve(dice, points),
        seam_allowance: dice.chance(20).then(|| dice.number()),
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

fn details(dice: &mut Dice, ids: &mut IdCounters, panel: &mut Panel, points: &[PointId]) {
    let edges: Vec<EdgeId> = panel.edges().map(|e| e.id).collect();
    let any = |dice: &mut Dice| points[dice.below(points.len())];
    for k in 0..dice.below(3) {
        let segments = (0..dice.below(4))
            .map(|_| LineSegment {
                ends: [any(dice), any(dice)],
                curve: curve(dice, points),
            })
            .collect();
        panel.internal_lines.push(InternalLine {
            id: ids.take_internal_line(),
            name: format!("line {k}"),
            segments,
        });
    }
    if edges.is_empty() {
        return;
    }
    if dice.chance(25) {
        panel.fold = Some(edges[dice.below(edges.len())]);
    }
    for k in 0..dice.below(3) {
        let shape = if dice.chance(70) {
            DartShape::Edge {
                edge: edges[dice.below(edges.len())],
                at: dice.share(),
                width: Number::Value(dice.fraction() * 0.05),
                tip: if dice.chance(50) {
                    DartTip::Depth(dice.share())
                } else {
                    DartTip::Apex(any(dice))
                },
            }
        } else {
            DartShape::Diamond {
                ends: [any(dice), any(dice)],
                at: dice.share(),
                width: dice.number(),
            }
        };
        panel.darts.push(Dart {
            id: ids.take_dart(),
            name: format!("dart {k}"),
            shape,
        });
    }
    for k in 0..dice.below(3) {
        panel.notches.push(Notch {
            id: ids.take_notch(),
            name: format!("notch {k}"),
            edge: edges[dice.below(edges.len())],
            at: if dice.chance(50) {
                Along::Fraction(dice.share())
            } else {
                Along::Distance(dice.number())
            },
        });
    }
}

fn spans(dice: &mut Dice, pattern: &Pattern) -> Vec<Span> {
    let mut spans = Vec::new();
    for _ in 0..dice.below(4) {
        let panel = match pattern.panels.get(dice.below(pattern.panels.len())) {
            Some(panel) if dice.chance(95) => panel,
            _ => {
                spans.push(Span::whole(PanelId(900), EdgeId(900)));
                continue;
            }
        };
        let edges: Vec<EdgeId> = panel.edges().map(|e| e.id).collect();
        let edge = edges.get(dice.below(edges.len())).copied();
        let mut span = Span::whole(panel.id, edge.unwrap_or(EdgeId(901)));
        span.copy = dice.below(3) as u32;
        span.reflected = dice.chance(20);
        if dice.chance(40) {
            span.from = dice.share();
            span.to = dice.share();
        }
        spans.push(span);
    }
    spans
}
