//! Patterns at random that draft without error, and damage to their files.

use crate::random_pattern::Dice;
use std::sync::Arc;
use toile_measure::{Measurements, Origin};
use toile_pattern::*;

const TAU: f64 = std::f64::consts::TAU;

fn formula(text: &str) -> Number {
    Number::formula(text).expect("the formula is right")
}

/// A length near `value` [m] that grows with the wearer, in one of several forms.
fn grown(dice: &mut Dice, value: f64) -> Number {
    let base = 0.96;
    match dice.below(6) {
        0 | 1 => Number::Value((value * 1e4).round() / 1e4),
        2 => formula(&format!("bust * {:.4}", value / base)),
        3 => formula(&format!(
            "bust * {:.4} + {:.2}cm - ease",
            value / base,
            100.0 * 0.04
        )),
        4 => formula(&format!("scale * {:.2}cm", value * 100.0)),
        _ => formula(&format!("(waist + hips) / 2 * {:.4}", value / 0.86)),
    }
}

fn share(dice: &mut Dice, low: f64, high: f64) -> f64 {
    let value = low + (high - low) * dice.below(1001) as f64 / 1000.0;
    (value * 1e4).round() / 1e4
}

pub fn sound_pattern(dice: &mut Dice) -> Pattern {
    let mut pattern = Pattern::new("random");
    pattern.unit = [
        DisplayUnit::Millimetre,
        DisplayUnit::Centimetre,
        DisplayUnit::Metre,
        DisplayUnit::Inch,
    ][dice.below(4)];
    let several = usize::from(dice.below(3) == 0);
    for k in 0..=several {
        let mut table = Measurements::new();
        let grow = 1.0 + 0.08 * k as f64;
        for (name, value) in [
            ("bust", 0.96 * grow),
            ("waist", 0.76 * grow),
            ("hips", 0.96 * grow),
            ("shoulder_incl", 0.37),
        ] {
            table
                .set(name, value, Origin::Asked)
                .expect("name and value are right");
        }
        pattern.sizes.push(Size {
            name: format!("size {k}"),
            measurements: table,
        });
    }
    pattern.base_size = Some("size 0".into());
    for (name, text) in [
        ("ease", "4cm"),
        ("scale", "bust / 96cm"),
        ("unused", "max(1cm, ease, bust - waist)"),
    ] {
        pattern.variables.push(Variable {
            name: name.into(),
            number: formula(text),
        });
    }
    let mut ids = IdCounters {
        panel: dice.below(3) as u32,
        point: dice.below(9) as u32,
        ..IdCounters::default()
    };
    pattern
        .fabrics
        .push(Arc::new(Fabric::poplin(ids.take_fabric())));
    for k in 0..1 + dice.below(2) {
        let panel = Drawing::new(dice, &mut ids, &pattern, k).panel();
        pattern.panels.push(Arc::new(panel));
    }
    seams(dice, &mut ids, &mut pattern);
    pattern.ids = ids;
    pattern
}

struct Drawing<'a> {
    dice: &'a mut Dice,
    ids: &'a mut IdCounters,
    panel: Panel,
    /// Where each point was meant to be in the base size.
    meant: Vec<(PointId, [f64; 2])>,
}

impl<'a> Drawing<'a> {
    fn new(dice: &'a mut Dice, ids: &'a mut IdCounters, pattern: &Pattern, k: usize) -> Self {
        let name = ["front", "back piece"][k];
        let panel = Panel::new(ids.take_panel(), name, pattern.fabrics[0].id);
        Self {
            dice,
            ids,
            panel,
            meant: Vec::new(),
        }
    }

    fn point(&mut self, name: &str, at: [f64; 2], place: PointPlace) -> PointId {
        let id = self.ids.take_point();
        if self.dice.below(12) == 0 {
            self.ids.take_point();
        }
        self.panel.points.push(Point {
            id,
            name: name.into(),
            place,
        });
        self.meant.push((id, at));
        id
    }

    fn earlier(&mut self) -> (PointId, [f64; 2]) {
        self.meant[self.dice.below(self.meant.len())]
    }

    /// A construction that leads to about `at`.
    fn place(&mut self, at: [f64; 2]) -> PointPlace {
        if self.meant.len() < 2 {
            return PointPlace::At {
                x: grown(self.dice, at[0]),
                y: grown(self.dice, at[1]),
            };
        }
        let (base, from) = self.earlier();
        let way = [at[0] - from[0], at[1] - from[1]];
        match self.dice.below(6) {
            0 | 1 => PointPlace::At {
                x: grown(self.dice, at[0]),
                y: grown(self.dice, at[1]),
            },
            2 => PointPlace::Offset {
                base,
                x: grown(self.dice, way[0]),
                y: grown(self.dice, way[1]),
            },
            3 => PointPlace::Polar {
                base,
                angle: formula(&format!("{:.2}deg", way[1].atan2(way[0]).to_degrees())),
                distance: grown(self.dice, way[0].hypot(way[1])),
            },
            _ => {
                let (tip, to) = self.earlier();
                let unit = [to[0] - from[0], to[1] - from[1]];
                let square = unit[0] * unit[0] + unit[1] * unit[1];
                if tip == base || square < 1e-6 {
                    return PointPlace::at(at[0], at[1]);
                }
                PointPlace::Between {
                    base,
                    tip,
                    along: Number::Value((way[0] * unit[0] + way[1] * unit[1]) / square),
                    aside: Number::Value((way[1] * unit[0] - way[0] * unit[1]) / square),
                }
            }
        }
    }

    fn panel(mut self) -> Panel {
        let corners = 4 + self.dice.below(4);
        let radius = 0.15 + 0.01 * self.dice.below(15) as f64;
        let clockwise = self.dice.below(4) == 0;
        let mut ends = Vec::new();
        for k in 0..corners {
            let turn = if clockwise { -1.0 } else { 1.0 };
            let angle = turn * TAU * (k as f64 + share(self.dice, 0.0, 0.3)) / corners as f64;
            let at = [angle.cos() * radius * 1.2, angle.sin() * radius];
            let place = self.place(at);
            ends.push(self.point(&format!("corner {k}"), at, place));
        }
        for k in 0..corners {
            let (a, b) = (
                self.meant_at(ends[k]),
                self.meant_at(ends[(k + 1) % corners]),
            );
            let ends = [ends[k], ends[(k + 1) % corners]];
            let curve = self.curve(k, ends, a, b);
            let id = self.ids.take_edge();
            let own = self.dice.below(4) == 0;
            let seam_allowance = own.then(|| formula("ease / 4 + 5mm"));
            let name = if self.dice.below(3) == 0 {
                format!("side {k}")
            } else {
                format!("e{k}")
            };
            self.panel.outline.push(Edge {
                id,
                name,
                ends,
                curve,
                seam_allowance,
            });
        }
        self.hang_on(&ends);
        if self.dice.below(4) == 0 {
            self.hole(clockwise);
        }
        self.details(&ends, radius);
        self.panel
    }

    fn meant_at(&self, id: PointId) -> [f64; 2] {
        self.meant
            .iter()
            .find(|m| m.0 == id)
            .map_or([0.0; 2], |m| m.1)
    }

    fn curve(&mut self, k: usize, ends: [PointId; 2], a: [f64; 2], b: [f64; 2]) -> EdgeCurve {
        let [start, end] = ends;
        let way = [b[0] - a[0], b[1] - a[1]];
        let control = |this: &mut Self, j: usize, along: f64| {
            let aside = share(this.dice, -0.15, 0.15);
            let place = PointPlace::Between {
                base: start,
                tip: end,
                along: along.into(),
                aside: Number::Value(aside),
            };
            let at = [
                a[0] + along * way[0] - aside * way[1],
                a[1] + along * way[1] + aside * way[0],
            ];
            this.point(&format!("control {k} {j}"), at, place)
        };
        match self.dice.below(7) {
            0 => EdgeCurve::Arc {
                bulge: if self.dice.below(2) == 0 {
                    Number::Value(share(self.dice, -0.2, 0.2))
                } else {
                    formula("0.1 * scale")
                },
            },
            1 => EdgeCurve::Quadratic {
                control: control(self, 0, 0.5),
            },
            2 | 3 => EdgeCurve::Cubic {
                controls: [control(self, 0, 0.3), control(self, 1, 0.7)],
            },
            _ => EdgeCurve::Line,
        }
    }

    /// Points of the rules that need others: toward, on an edge, crossing, mirrored.
    fn hang_on(&mut self, ends: &[PointId]) {
        let edge = self.panel.outline[self.dice.below(self.panel.outline.len())].id;
        let at = if self.dice.below(2) == 0 {
            Number::Value(share(self.dice, 0.1, 0.9))
        } else {
            formula("0.4 * scale")
        };
        self.point("on edge", [0.0; 2], PointPlace::OnEdge { edge, at });
        let distance = grown(self.dice, 0.06);
        self.point(
            "toward",
            [0.0; 2],
            PointPlace::Toward {
                base: ends[0],
                tip: ends[2],
                distance,
            },
        );
        self.point(
            "crossing",
            [0.0; 2],
            PointPlace::Crossing {
                first: [ends[0], ends[2]],
                second: [ends[1], ends[3]],
            },
        );
        self.point(
            "mirrored",
            [0.0; 2],
            PointPlace::Mirrored {
                base: ends[0],
                line: [ends[1], ends[3]],
            },
        );
    }

    fn hole(&mut self, clockwise: bool) {
        let mut ring = Vec::new();
        for k in 0..3 {
            let turn = if clockwise { 1.0 } else { -1.0 };
            let angle = turn * TAU * k as f64 / 3.0 + 0.2;
            let at = [angle.cos() * 0.02 - 0.03, angle.sin() * 0.02 + 0.01];
            ring.push(self.point(&format!("hole {k}"), at, PointPlace::at(at[0], at[1])));
        }
        let hole = (0..3)
            .map(|k| Edge {
                id: self.ids.take_edge(),
                name: format!("h{k}"),
                ends: [ring[k], ring[(k + 1) % 3]],
                curve: if k == 0 {
                    EdgeCurve::Arc {
                        bulge: Number::Value(0.1),
                    }
                } else {
                    EdgeCurve::Line
                },
                seam_allowance: None,
            })
            .collect();
        self.panel.holes.push(hole);
    }

    fn named(&self, name: &str) -> PointId {
        self.panel.point_named(name).map_or(PointId(0), |p| p.id)
    }

    fn details(&mut self, ends: &[PointId], radius: f64) {
        let quantity = 1 + self.dice.below(3) as u32;
        self.panel.cut = Cut {
            quantity,
            mirrored: quantity != 3 && self.dice.below(2) == 0,
        };
        if self.panel.cut.mirrored {
            self.panel.cut.quantity = 2;
        }
        self.panel.grain = [
            Number::Value(0.4),
            formula("90deg"),
            formula("shoulder_incl * 2"),
        ][self.dice.below(3)]
        .clone();
        self.panel.seam_allowance = grown(self.dice, 0.01);
        self.panel.worn = match self.dice.below(3) {
            0 => WornRule::Automatic,
            1 => WornRule::Wrapped {
                part: BodyPart::Trunk,
                facing: Facing::Front,
                level: Some(formula("bust")),
            },
            _ => WornRule::Placed {
                translation: [0.1, 1.2, 0.3],
                rotation: [0.0, 0.6, 0.0, 0.8],
            },
        };
        let straight: Vec<(EdgeId, usize)> = self
            .panel
            .outline
            .iter()
            .enumerate()
            .filter(|(_, e)| e.curve == EdgeCurve::Line)
            .map(|(k, e)| (e.id, k))
            .collect();
        if !straight.is_empty() && self.dice.below(3) == 0 {
            self.panel.fold = Some(straight[self.dice.below(straight.len())].0);
        }
        if self.dice.below(2) == 0 {
            let crossing = self.named("crossing");
            let segments = vec![LineSegment {
                ends: [crossing, self.named("on edge")],
                curve: EdgeCurve::Line,
            }];
            self.panel.internal_lines.push(InternalLine {
                id: self.ids.take_internal_line(),
                name: "style".into(),
                segments,
            });
        }
        if self.dice.below(3) == 0 {
            let centre = self.point("middle", [0.0; 2], PointPlace::at(0.02, -0.01));
            let control = self.point(
                "bow",
                [0.0; 2],
                PointPlace::Offset {
                    base: centre,
                    x: Number::Value(0.02),
                    y: Number::Value(0.03),
                },
            );
            let crossing = self.named("crossing");
            let curve = [
                EdgeCurve::Quadratic { control },
                EdgeCurve::Arc {
                    bulge: Number::Value(0.2),
                },
                EdgeCurve::Cubic {
                    controls: [control, control],
                },
            ][self.dice.below(3)]
            .clone();
            let segments = vec![LineSegment {
                ends: [centre, crossing],
                curve,
            }];
            self.panel.internal_lines.push(InternalLine {
                id: self.ids.take_internal_line(),
                name: "bow".into(),
                segments,
            });
        }
        for (k, edge) in self.panel.outline.clone().iter().enumerate() {
            if Some(edge.id) == self.panel.fold {
                continue;
            }
            if self.dice.below(5) == 0 {
                let tip = if self.dice.below(3) == 0 {
                    let (a, b) = (
                        self.meant_at(ends[k]),
                        self.meant_at(ends[(k + 1) % ends.len()]),
                    );
                    let at = [(a[0] + b[0]) * 0.3, (a[1] + b[1]) * 0.3];
                    let apex = self.point(&format!("apex {k}"), at, PointPlace::at(at[0], at[1]));
                    DartTip::Apex(apex)
                } else {
                    DartTip::Depth(grown(self.dice, radius * 0.3))
                };
                let shape = DartShape::Edge {
                    edge: edge.id,
                    at: share(self.dice, 0.3, 0.7).into(),
                    width: grown(self.dice, 0.02),
                    tip,
                };
                self.panel.darts.push(Dart {
                    id: self.ids.take_dart(),
                    name: format!("dart {k}"),
                    shape,
                });
            }
            if self.dice.below(4) == 0 {
                let at = match self.dice.below(4) {
                    0 => Along::Fraction(formula("0.5 * scale")),
                    1 => Along::Distance(Number::Value(-0.03)),
                    2 => Along::Distance(grown(self.dice, 0.03)),
                    _ => Along::Fraction(share(self.dice, 0.0, 1.0).into()),
                };
                self.panel.notches.push(Notch {
                    id: self.ids.take_notch(),
                    name: format!("notch {k}"),
                    edge: edge.id,
                    at,
                });
            }
        }
        if self.dice.below(5) == 0 {
            let low = self.point("low", [0.0; 2], PointPlace::at(0.05, -0.03));
            let high = self.point(
                "high",
                [0.0; 2],
                PointPlace::Offset {
                    base: low,
                    x: Number::Value(0.0),
                    y: formula("4cm"),
                },
            );
            let shape = DartShape::Diamond {
                ends: [low, high],
                at: share(self.dice, 0.2, 0.8).into(),
                width: formula("scale * 1cm"),
            };
            self.panel.darts.push(Dart {
                id: self.ids.take_dart(),
                name: "diamond".into(),
                shape,
            });
        }
        if self.dice.below(2) == 0 {
            self.ids.take_edge();
            let text = format!(
                "length('{}'.'{}') / 2 + distance('{}'.'corner 0', '{}'.crossing) * 0",
                self.panel.name, self.panel.outline[0].name, self.panel.name, self.panel.name
            );
            self.point(
                "measured",
                [0.0; 2],
                PointPlace::At {
                    x: formula(&text),
                    y: formula(&format!("y('{}'.toward)", self.panel.name)),
                },
            );
        }
    }
}

fn seams(dice: &mut Dice, ids: &mut IdCounters, pattern: &mut Pattern) {
    let panels: Vec<Panel> = pattern.panels.iter().map(|p| (**p).clone()).collect();
    let first = &panels[0];
    let last = &panels[panels.len() - 1];
    for k in 0..1 + dice.below(3) {
        let pick = |dice: &mut Dice, panel: &Panel| {
            let edges: Vec<EdgeId> = panel
                .outline
                .iter()
                .map(|e| e.id)
                .filter(|e| Some(*e) != panel.fold)
                .collect();
            let mut span = Span::whole(panel.id, edges[dice.below(edges.len())]);
            span.copy = dice.below(panel.cut.quantity as usize) as u32;
            span.reflected = panel.fold.is_some() && dice.below(2) == 0;
            if dice.below(3) == 0 {
                span.from = share(dice, 0.0, 0.4).into();
                span.to = if dice.below(2) == 0 {
                    share(dice, 0.6, 1.0).into()
                } else {
                    formula("0.8 * scale")
                };
            }
            if dice.below(3) == 0 {
                span.reversed()
            } else {
                span
            }
        };
        let mut sides = [vec![pick(dice, first)], vec![pick(dice, last)]];
        if dice.below(3) == 0 {
            sides[1].push(pick(dice, last));
        }
        let mut seam = Seam::new(ids.take_seam(), format!("seam {k}"), sides);
        match dice.below(3) {
            0 => seam.ease = formula("1m"),
            _ => seam.gathered = true,
        }
        seam.right_sides_together = dice.below(4) != 0;
        seam.multi_ply = dice.below(5) == 0;
        pattern.seams.push(Arc::new(seam));
    }
}

/// Makes the text worse in one of many ways.
pub fn damaged(text: &str, dice: &mut Dice) -> String {
    let at = dice.below(text.len());
    match dice.below(6) {
        0 => text[..at].to_owned(),
        1 => text.replacen("\"from\": \"", "\"from\": \"x", 1 + dice.below(3)),
        2 => text.replacen("\"edge\": \"", "\"egde\": \"", 1),
        3 => text.replacen(": [", ": {", 1 + dice.below(4)),
        4 => text.replacen("bust", "bust + * ", 1),
        _ => {
            let end = (at + 1 + dice.below(60)).min(text.len());
            format!("{}{}", &text[..at], &text[end..])
        }
    }
}
