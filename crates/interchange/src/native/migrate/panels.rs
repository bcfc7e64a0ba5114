//! Panels of version 1: a sheet with points and curves, and a panel traced from it.

use super::document::{
    Along, Dart, DartShape, DartTip, Edge as OldEdge, EdgeCurve, Panel as OldPanel, PointPlace,
    WornRule as OldWornRule,
};
use super::{EdgePlace, Migration, Values};
use std::sync::Arc;
use toile_pattern::{
    Apex, Curve, CurveId, CurveRule, Edge, EdgeCorner, EdgeId, FabricId, Line, LineId, LineKind,
    Mark, Name, Notch, NotchId, NotchKind, Number, Operation, OperationId, OperationKind, Panel,
    PanelId, Point, PointId, PointRule, Pressed, Sheet, SheetId, Want, WornRule,
};

/// A sheet and panel in the making.
struct Making {
    sheet: Sheet,
    panel: Panel,
}

impl Making {
    /// A name no point of the sheet has.
    fn point_name(&self, wanted: String) -> String {
        unique(wanted, |name| self.sheet.point_named(name).is_some())
    }

    /// A name no curve of the sheet and no edge of the panel has.
    fn edge_name(&self, wanted: String) -> String {
        unique(wanted, |name| {
            self.sheet.curve_named(name).is_some() || self.panel.edge_named(name).is_some()
        })
    }

    fn line_name(&self, wanted: String) -> String {
        unique(wanted, |name| {
            self.panel.lines.iter().any(|line| line.name == name)
        })
    }
}

fn unique(wanted: String, taken: impl Fn(&str) -> bool) -> String {
    let mut name = wanted.clone();
    let mut number = 2;
    while taken(&name) {
        name = format!("{wanted} {number}");
        number += 1;
    }
    name
}

impl Migration<'_> {
    fn point(&self, old: u32) -> PointId {
        self.points.get(&old).copied().unwrap_or_default()
    }

    pub(super) fn panel(&mut self, old: &OldPanel, values: Values<'_>) {
        let sheet = Sheet {
            id: self.new.ids.take::<SheetId>(),
            name: old.name.clone(),
            ..Sheet::default()
        };
        let id: PanelId = self.new.ids.take();
        self.panels.insert(old.id, id);
        let fabric = self.fabrics.get(&old.fabric).copied();
        let fabric: FabricId = fabric.unwrap_or_else(|| self.new.ids.take());
        let mut panel = Panel::new(id, old.name.clone(), sheet.id, fabric);
        panel.grain = self.number(&old.grain);
        panel.allowance = self.number(&old.seam_allowance);
        panel.cut = old.cut;
        panel.worn = self.worn(&old.worn);
        for point in &old.points {
            let id: PointId = self.new.ids.take();
            self.points.insert(point.id, id);
        }
        let mut making = Making { sheet, panel };
        // Points keep their places in the list; their rules come when curves have ids.
        for point in &old.points {
            making.sheet.points.push(Arc::new(Point {
                id: self.point(point.id),
                name: point.name.clone(),
                rule: PointRule::at(0.0, 0.0),
            }));
        }
        self.line(
            &mut making,
            "outline".into(),
            LineKind::Outline,
            &old.outline,
        );
        for (k, hole) in old.holes.iter().enumerate() {
            self.line(&mut making, format!("hole {}", k + 1), LineKind::Hole, hole);
        }
        for (k, point) in old.points.iter().enumerate() {
            making.sheet.points[k] = Arc::new(Point {
                id: self.point(point.id),
                name: point.name.clone(),
                rule: self.rule(&point.place),
            });
        }
        self.internal_lines(&mut making, old);
        self.notches(&mut making, old, values);
        for dart in &old.darts {
            let operation = self.dart(dart);
            making.panel.operations.extend(operation.map(Arc::new));
        }
        if let Some(fold) = old.fold.and_then(|edge| self.edges.get(&edge)).copied() {
            let id: OperationId = self.new.ids.take();
            making.panel.operations.push(Arc::new(Operation {
                meant: false,
                id,
                name: "fold".into(),
                kind: OperationKind::Fold {
                    line: Name::Drawn(fold.line),
                    ends: fold.ends.map(Mark::corner),
                },
            }));
        }
        self.new.sheets.push(Arc::new(making.sheet));
        self.new.panels.push(Arc::new(making.panel));
    }

    fn worn(&self, old: &OldWornRule) -> WornRule {
        match old {
            OldWornRule::Automatic => WornRule::Automatic,
            OldWornRule::Wrapped {
                part,
                facing,
                level,
            } => WornRule::Wrapped {
                part: *part,
                facing: *facing,
                level: level.as_ref().map(|level| self.number(level)),
            },
            OldWornRule::Placed {
                translation,
                rotation,
            } => WornRule::Placed {
                translation: *translation,
                rotation: *rotation,
            },
        }
    }

    fn line(&mut self, making: &mut Making, name: String, kind: LineKind, edges: &[OldEdge]) {
        let line: LineId = self.new.ids.take();
        let mut made = Vec::with_capacity(edges.len());
        for old in edges {
            let ends = old.ends.map(|end| self.point(end));
            let curve = self.curve(making, old.name.clone(), ends, &old.curve);
            let edge: EdgeId = self.new.ids.take();
            self.edges.insert(
                old.id,
                EdgePlace {
                    panel: making.panel.id,
                    line,
                    curve,
                    ends,
                },
            );
            made.push(Edge {
                id: edge,
                name: old.name.clone(),
                curve,
                ends,
                allowance: old.seam_allowance.as_ref().map(|a| self.number(a)),
                corner: EdgeCorner::default(),
            });
        }
        let name = making.line_name(name);
        making.panel.lines.push(Line {
            id: line,
            name,
            kind,
            by: None,
            edges: made,
        });
    }

    fn curve(
        &mut self,
        making: &mut Making,
        name: String,
        ends: [PointId; 2],
        old: &EdgeCurve,
    ) -> CurveId {
        let id: CurveId = self.new.ids.take();
        let name = unique(name, |name| making.sheet.curve_named(name).is_some());
        let spline = |handles| CurveRule::Spline {
            handles,
            knots: Vec::new(),
            to_length: None,
        };
        let rule = match old {
            EdgeCurve::Line => CurveRule::Line,
            EdgeCurve::Arc { bulge } => CurveRule::Arc {
                bulge: self.number(bulge),
            },
            EdgeCurve::Cubic { controls } => spline(controls.map(|c| self.point(c))),
            EdgeCurve::Quadratic { control } => {
                // The same curve as a cubic: handles at 2/3 of the way to the control point.
                let tip = self.point(*control);
                let handles = [0, 1].map(|k| {
                    let id: PointId = self.new.ids.take();
                    let name = making.point_name(format!("{name} handle {}", k + 1));
                    making.sheet.points.push(Arc::new(Point {
                        id,
                        name,
                        rule: PointRule::Between {
                            base: ends[k],
                            tip,
                            along: Number::Value(2.0 / 3.0),
                            aside: Number::ZERO,
                        },
                    }));
                    id
                });
                spline(handles)
            }
        };
        making.sheet.curves.push(Arc::new(Curve {
            id,
            name,
            ends,
            rule,
        }));
        id
    }

    fn rule(&self, old: &PointPlace) -> PointRule {
        let pair = |ids: &[u32; 2]| ids.map(|id| self.point(id));
        match old {
            PointPlace::At { x, y } => PointRule::At {
                x: self.number(x),
                y: self.number(y),
            },
            PointPlace::Offset { base, x, y } => PointRule::Offset {
                base: self.point(*base),
                x: self.number(x),
                y: self.number(y),
            },
            PointPlace::Polar {
                base,
                angle,
                distance,
            } => PointRule::Polar {
                base: self.point(*base),
                angle: self.number(angle),
                distance: self.number(distance),
            },
            PointPlace::Between {
                base,
                tip,
                along,
                aside,
            } => PointRule::Between {
                base: self.point(*base),
                tip: self.point(*tip),
                along: self.number(along),
                aside: self.number(aside),
            },
            PointPlace::Toward {
                base,
                tip,
                distance,
            } => PointRule::Toward {
                base: self.point(*base),
                tip: self.point(*tip),
                distance: self.number(distance),
            },
            PointPlace::OnEdge { edge, at } => PointRule::OnCurve {
                curve: self
                    .edges
                    .get(edge)
                    .map(|place| place.curve)
                    .unwrap_or_default(),
                share: self.number(at),
            },
            PointPlace::Crossing { first, second } => PointRule::Crossing {
                first: pair(first),
                second: pair(second),
            },
            PointPlace::Mirrored { base, line } => PointRule::Mirrored {
                base: self.point(*base),
                line: pair(line),
            },
        }
    }

    fn internal_lines(&mut self, making: &mut Making, old: &OldPanel) {
        for inside in &old.internal_lines {
            let line: LineId = self.new.ids.take();
            let count = inside.segments.len();
            let mut edges = Vec::with_capacity(count);
            for (k, segment) in inside.segments.iter().enumerate() {
                let wanted = match count {
                    1 => inside.name.clone(),
                    _ => format!("{} {}", inside.name, k + 1),
                };
                let name = making.edge_name(wanted);
                let name = unique(name, |name| edges.iter().any(|e: &Edge| e.name == name));
                let ends = segment.ends.map(|end| self.point(end));
                let curve = self.curve(making, name.clone(), ends, &segment.curve);
                edges.push(Edge {
                    id: self.new.ids.take(),
                    name,
                    curve,
                    ends,
                    allowance: None,
                    corner: EdgeCorner::default(),
                });
            }
            let name = making.line_name(inside.name.clone());
            making.panel.lines.push(Line {
                id: line,
                name,
                kind: LineKind::Internal,
                by: None,
                edges,
            });
        }
    }

    fn notches(&mut self, making: &mut Making, old: &OldPanel, values: Values<'_>) {
        for notch in &old.notches {
            let Some(place) = self.edges.get(&notch.edge).copied() else {
                continue;
            };
            let at = match &notch.at {
                Along::Fraction(share) => Mark::between(place.ends, self.number(share)),
                Along::Distance(distance) => {
                    let distance = self.number(distance);
                    let known = distance.value().or_else(|| values(&distance, Want::Length));
                    let from_end = known.is_some_and(|value| value < 0.0);
                    Mark::Along {
                        from: Name::Drawn(place.ends[usize::from(from_end)]),
                        distance,
                    }
                }
            };
            making.panel.notches.push(Notch {
                id: self.new.ids.take::<NotchId>(),
                name: notch.name.clone(),
                line: place.line,
                at,
                kind: NotchKind::Slit,
            });
        }
    }

    fn dart(&mut self, old: &Dart) -> Option<Operation> {
        let kind = match &old.shape {
            DartShape::Edge {
                edge,
                at,
                width,
                tip,
            } => {
                let place = *self.edges.get(edge)?;
                OperationKind::Dart {
                    line: Name::Drawn(place.line),
                    mouth: Mark::between(place.ends, self.number(at)),
                    intake: self.number(width),
                    apex: match tip {
                        DartTip::Depth(depth) => Apex::Depth(self.number(depth)),
                        DartTip::Apex(apex) => Apex::Point(self.point(*apex)),
                    },
                    trued: false,
                    keeps_length: false,
                    pressed: Pressed::default(),
                }
            }
            DartShape::Diamond { ends, at, width } => OperationKind::Diamond {
                ends: ends.map(|end| self.point(end)),
                widest: self.number(at),
                intake: self.number(width),
            },
        };
        Some(Operation {
            meant: false,
            id: self.new.ids.take(),
            name: old.name.clone(),
            kind,
        })
    }
}
