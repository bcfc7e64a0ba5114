//! The shape of a panel: its outline with darts opened and its fold unfolded.

use crate::resolver::{Resolver, Want};
use crate::{
    Along, Code, Dart, DartId, DartShape, DartTip, Diagnostic, Edge, EdgeId, EdgeOrigin,
    InternalLineId, NotchId, Panel, Place,
};
use std::collections::{BTreeMap, BTreeSet};
use toile_geometry::{Curve, Vec2};

/// A piece of cloth before it has a place in a draft.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    pub outline: Vec<ShapeEdge>,
    pub holes: Vec<Vec<ShapeEdge>>,
    pub lines: Vec<(InternalLineId, Vec<Curve>)>,
    pub notches: Vec<(NotchId, Vec2, Vec2)>,
    pub grain: f64,
}

/// An edge of a shape and the stretch of its origin that it covers.
#[derive(Clone, Debug)]
pub(crate) struct ShapeEdge {
    pub origin: EdgeOrigin,
    /// Arc-length fraction of the origin where it starts.
    pub from: f64,
    /// Fraction where it ends; less than `from` if it runs against its origin.
    pub to: f64,
    pub curve: Curve,
    pub seam_allowance: f64,
}

impl ShapeEdge {
    fn reversed(&self) -> Self {
        Self {
            from: self.to,
            to: self.from,
            curve: self.curve.reversed(),
            ..*self
        }
    }

    /// The mirror image in a line; `half` marks it as the other half of a folded panel.
    fn mirrored(&self, (on_line, way): (Vec2, Vec2), half: bool) -> Self {
        let origin = match self.origin {
            EdgeOrigin::Edge { edge, reflected } => EdgeOrigin::Edge {
                edge,
                reflected: reflected || half,
            },
            EdgeOrigin::DartLeg {
                dart,
                reflected,
                leg,
            } => EdgeOrigin::DartLeg {
                dart,
                reflected: reflected || half,
                leg,
            },
        };
        Self {
            origin,
            curve: self.curve.reflected(on_line, way),
            ..*self
        }
        .reversed()
    }
}

/// A loop mirrored in a line, wound as before.
fn mirrored_loop(edges: &[ShapeEdge], mirror: (Vec2, Vec2), half: bool) -> Vec<ShapeEdge> {
    edges
        .iter()
        .rev()
        .map(|edge| edge.mirrored(mirror, half))
        .collect()
}

impl Shape {
    /// The mirror image in the y axis: the other piece of a pair.
    pub fn mirror_image(&self) -> Self {
        let axis = (Vec2::zeros(), Vec2::y());
        let flip = |v: Vec2| Vec2::new(-v.x, v.y);
        Self {
            outline: mirrored_loop(&self.outline, axis, false),
            holes: self
                .holes
                .iter()
                .map(|hole| mirrored_loop(hole, axis, false))
                .collect(),
            lines: mirrored_lines(&self.lines, axis),
            notches: self
                .notches
                .iter()
                .map(|&(id, point, inward)| (id, flip(point), flip(inward)))
                .collect(),
            grain: std::f64::consts::PI - self.grain,
        }
    }

    /// Adds the mirror image in the fold line.
    fn unfold(&mut self, start: Vec2, end: Vec2) {
        let mirror = (start, end - start);
        let mut other = mirrored_loop(&self.outline, mirror, true);
        if let Some(first) = other.first_mut() {
            first.curve = with_ends(first.curve, start, first.curve.end());
        }
        if let Some(last) = other.last_mut() {
            last.curve = with_ends(last.curve, last.curve.start(), end);
        }
        self.outline.extend(other);
        let holes: Vec<_> = self
            .holes
            .iter()
            .map(|hole| mirrored_loop(hole, mirror, true))
            .collect();
        self.holes.extend(holes);
        self.lines.extend(mirrored_lines(&self.lines, mirror));
        let unit = mirror.1.normalize();
        let flip = |v: Vec2| unit * (2.0 * v.dot(&unit)) - v;
        let notches: Vec<_> = self
            .notches
            .iter()
            .map(|&(id, point, inward)| (id, start + flip(point - start), flip(inward)))
            .collect();
        self.notches.extend(notches);
    }
}

fn mirrored_lines(
    lines: &[(InternalLineId, Vec<Curve>)],
    mirror: (Vec2, Vec2),
) -> Vec<(InternalLineId, Vec<Curve>)> {
    lines
        .iter()
        .map(|(id, curves)| {
            let curves = curves.iter().map(|c| c.reflected(mirror.0, mirror.1));
            (*id, curves.collect())
        })
        .collect()
}

/// The curve with its ends put exactly where they belong.
fn with_ends(curve: Curve, start: Vec2, end: Vec2) -> Curve {
    match curve {
        Curve::Line { .. } => Curve::Line { start, end },
        Curve::Arc { bulge, .. } => Curve::Arc { start, end, bulge },
        Curve::Quadratic { control, .. } => Curve::Quadratic {
            start,
            control,
            end,
        },
        Curve::Cubic { controls, .. } => Curve::Cubic {
            start,
            controls,
            end,
        },
    }
}

/// Shapes one panel. Nothing comes back if its outline cannot be drawn; why is in the resolver's
/// diagnostics.
pub(crate) fn shape(resolver: &mut Resolver<'_>, index: usize, panel: &Panel) -> Option<Shape> {
    let mut shaper = Shaper {
        resolver,
        index,
        panel,
        turn: 1.0,
    };
    let mut outline = shaper.edges(&panel.outline);
    let holes: Vec<_> = panel.holes.iter().map(|hole| shaper.edges(hole)).collect();
    if let Some(outline) = &outline {
        let swept: f64 = outline.iter().map(|edge| edge.curve.swept_area()).sum();
        shaper.turn = if swept < 0.0 { -1.0 } else { 1.0 };
    }
    let fold = shaper.fold(outline.as_mut());
    let grain = shaper.number(&panel.grain, Want::Plain, "grain");
    let lines = shaper.lines();
    let notches = shaper.notches();
    let mut shape = Shape {
        outline: shaper.with_darts(outline.unwrap_or_default()),
        holes: holes.into_iter().flatten().collect(),
        lines,
        notches,
        grain: grain.unwrap_or(std::f64::consts::FRAC_PI_2),
    };
    shaper.diamonds(&mut shape);
    if let Ok(Some((start, end))) = fold {
        shape.unfold(start, end);
    }
    (fold.is_ok() && !shape.outline.is_empty()).then_some(shape)
}

struct Shaper<'r, 'p> {
    resolver: &'r mut Resolver<'p>,
    index: usize,
    panel: &'r Panel,
    /// 1 if the outline runs counter-clockwise, else -1.
    turn: f64,
}

struct Mouth {
    dart: DartId,
    from: f64,
    to: f64,
    tip: MouthTip,
}

enum MouthTip {
    Depth(f64),
    Apex(Vec2),
}

impl Shaper<'_, '_> {
    fn words(&self, what: &str) -> String {
        format!("panel {:?}, {what}", self.panel.name)
    }

    fn error(&mut self, code: Code, place: Place, what: &str, hint: &str) {
        let message = self.words(what);
        self.resolver
            .diagnostics
            .push(Diagnostic::error(code, place, message, hint));
    }

    fn number(&mut self, number: &crate::Number, want: Want, what: &str) -> Option<f64> {
        let place = Place::Panel(self.panel.id);
        let words = self.words(what);
        self.resolver.number(number, want, &place, &words)
    }

    /// The edges of a loop; nothing if one cannot be drawn.
    fn edges(&mut self, edges: &[Edge]) -> Option<Vec<ShapeEdge>> {
        let general = self
            .number(&self.panel.seam_allowance, Want::Length, "seam allowance")
            .unwrap_or(0.0);
        let mut result = Vec::with_capacity(edges.len());
        let mut complete = true;
        for edge in edges {
            let place = Place::Edge(self.panel.id, edge.id);
            let what = self.words(&format!("edge {:?}", edge.name));
            let curve =
                self.resolver
                    .curve_or_report(self.index, (edge.ends, &edge.curve), &place, &what);
            let own = edge.seam_allowance.as_ref().and_then(|allowance| {
                let what = format!("{what}, seam allowance");
                self.resolver.number(allowance, Want::Length, &place, &what)
            });
            let Some(curve) = curve else {
                complete = false;
                continue;
            };
            result.push(ShapeEdge {
                origin: EdgeOrigin::Edge {
                    edge: edge.id,
                    reflected: false,
                },
                from: 0.0,
                to: 1.0,
                curve,
                seam_allowance: own.unwrap_or(general),
            });
        }
        complete.then_some(result)
    }

    /// Takes the fold edge out of the outline, which then starts after it.
    fn fold(&mut self, outline: Option<&mut Vec<ShapeEdge>>) -> Result<Option<(Vec2, Vec2)>, ()> {
        let Some(fold) = self.panel.fold else {
            return Ok(None);
        };
        let Some(outline) = outline else {
            return Err(());
        };
        let place = Place::Edge(self.panel.id, fold);
        let at = outline
            .iter()
            .position(|edge| matches!(edge.origin, EdgeOrigin::Edge { edge, .. } if edge == fold));
        let Some(at) = at else {
            self.error(
                Code::BadFold,
                Place::Panel(self.panel.id),
                "the fold is not an edge of the outline",
                "choose a straight edge of the outline, or none",
            );
            return Err(());
        };
        let curve = outline[at].curve;
        let long_enough = (curve.end() - curve.start()).norm() > 1e-9;
        if !matches!(curve, Curve::Line { .. }) || !long_enough || outline.len() < 2 {
            self.error(
                Code::BadFold,
                place,
                "the fold is not a straight edge with a length",
                "choose a straight edge of the outline, or none",
            );
            return Err(());
        }
        outline.rotate_left(at);
        outline.remove(0);
        Ok(Some((curve.start(), curve.end())))
    }

    fn lines(&mut self) -> Vec<(InternalLineId, Vec<Curve>)> {
        let mut result = Vec::new();
        for line in &self.panel.internal_lines {
            let place = Place::InternalLine(self.panel.id, line.id);
            let what = self.words(&format!("internal line {:?}", line.name));
            let curves: Option<Vec<Curve>> = line
                .segments
                .iter()
                .map(|segment| {
                    self.resolver.curve_or_report(
                        self.index,
                        (segment.ends, &segment.curve),
                        &place,
                        &what,
                    )
                })
                .collect();
            if let Some(curves) = curves.filter(|curves| !curves.is_empty()) {
                result.push((line.id, curves));
            }
        }
        result
    }

    fn notches(&mut self) -> Vec<(NotchId, Vec2, Vec2)> {
        let mut result = Vec::new();
        for notch in &self.panel.notches {
            let place = Place::Notch(self.panel.id, notch.id);
            let what = self.words(&format!("notch {:?}", notch.name));
            let edge = self.resolver.edge(self.index, notch.edge);
            let Some(edge) = edge.filter(|edge| Some(edge.id) != self.panel.fold) else {
                let said = format!(
                    "notch {:?}: its edge is not there, or is the fold",
                    notch.name
                );
                self.error(
                    Code::MissingReference,
                    place,
                    &said,
                    "put it on an edge of this panel",
                );
                continue;
            };
            let curve =
                self.resolver
                    .curve_or_report(self.index, (edge.ends, &edge.curve), &place, &what);
            let Some(curve) = curve else { continue };
            let length = curve.length();
            let at = match &notch.at {
                Along::Fraction(at) => self
                    .resolver
                    .number(at, Want::Plain, &place, &what)
                    .map(|fraction| fraction * length),
                Along::Distance(at) => self
                    .resolver
                    .number(at, Want::Length, &place, &what)
                    .map(|d| if d < 0.0 { length + d } else { d }),
            };
            let Some(at) = at else { continue };
            if !(-1e-9..=length + 1e-9).contains(&at) {
                self.resolver.diagnostics.push(Diagnostic::warning(
                    Code::NotchOffEdge,
                    place,
                    format!("{what} lies beyond its edge and is left out"),
                    "use a fraction from 0 to 1, or a distance within the edge",
                ));
                continue;
            }
            let t = curve.parameter_at_length(at);
            let along = curve.derivative(t);
            let left = Vec2::new(-along.y, along.x) * self.turn;
            if let Some(inward) = left.try_normalize(1e-15) {
                result.push((notch.id, curve.point(t), inward));
            }
        }
        result
    }

    /// The outline with every edge dart cut into it.
    fn with_darts(&mut self, outline: Vec<ShapeEdge>) -> Vec<ShapeEdge> {
        let panel = self.panel;
        if !panel
            .darts
            .iter()
            .any(|dart| matches!(dart.shape, DartShape::Edge { .. }))
        {
            return outline;
        }
        self.report_astray(&outline);
        let mut darts: BTreeMap<EdgeId, Vec<&Dart>> = BTreeMap::new();
        for dart in &panel.darts {
            if let DartShape::Edge { edge, .. } = dart.shape {
                darts.entry(edge).or_default().push(dart);
            }
        }
        let mut result = Vec::with_capacity(outline.len());
        for edge in outline {
            let EdgeOrigin::Edge { edge: id, .. } = edge.origin else {
                continue;
            };
            let mut mouths: Vec<Mouth> = darts
                .get(&id)
                .into_iter()
                .flatten()
                .filter_map(|dart| self.mouth(dart, &edge.curve))
                .collect();
            mouths.sort_by(|a, b| a.from.total_cmp(&b.from).then(a.dart.cmp(&b.dart)));
            self.cut(edge, &mouths, &mut result);
        }
        result
    }

    /// Reports darts whose edge is not in the outline.
    fn report_astray(&mut self, outline: &[ShapeEdge]) {
        let known: BTreeSet<EdgeOrigin> = outline.iter().map(|piece| piece.origin).collect();
        for dart in &self.panel.darts {
            let DartShape::Edge { edge, .. } = dart.shape else {
                continue;
            };
            let origin = EdgeOrigin::Edge {
                edge,
                reflected: false,
            };
            if !known.contains(&origin) {
                let said = format!("dart {:?}: its edge is not in the outline", dart.name);
                self.error(
                    Code::MissingReference,
                    Place::Dart(self.panel.id, dart.id),
                    &said,
                    "put it on an edge of the outline that is not the fold",
                );
            }
        }
    }

    fn mouth(&mut self, dart: &Dart, curve: &Curve) -> Option<Mouth> {
        let DartShape::Edge { at, width, tip, .. } = &dart.shape else {
            return None;
        };
        let place = Place::Dart(self.panel.id, dart.id);
        let what = self.words(&format!("dart {:?}", dart.name));
        let at = self.resolver.number(at, Want::Plain, &place, &what)?;
        let width = self.resolver.number(width, Want::Length, &place, &what)?;
        let tip = match tip {
            DartTip::Depth(depth) => {
                MouthTip::Depth(self.resolver.number(depth, Want::Length, &place, &what)?)
            }
            DartTip::Apex(apex) => MouthTip::Apex(
                self.resolver
                    .point_or_report(self.index, *apex, &place, &what)?,
            ),
        };
        let half = 0.5 * width / curve.length().max(1e-12);
        let (from, to) = (at - half, at + half);
        if width <= 0.0 || from < -1e-9 || to > 1.0 + 1e-9 {
            let said = format!(
                "dart {:?} is {:.1} cm wide and does not fit on its edge",
                dart.name,
                width * 100.0
            );
            self.error(
                Code::DartTooWide,
                place,
                &said,
                "make it narrower (and more than nothing), or move it along the edge",
            );
            return None;
        }
        Some(Mouth {
            dart: dart.id,
            from: from.clamp(0.0, 1.0),
            to: to.clamp(0.0, 1.0),
            tip,
        })
    }

    /// Cuts sorted mouths out of an edge.
    fn cut(&mut self, edge: ShapeEdge, mouths: &[Mouth], result: &mut Vec<ShapeEdge>) {
        let length = edge.curve.length();
        let parameter = |fraction: f64| edge.curve.parameter_at_length(fraction * length);
        let piece = |from: f64, to: f64| ShapeEdge {
            from,
            to,
            curve: edge.curve.between(parameter(from), parameter(to)),
            ..edge
        };
        let mut at = 0.0;
        let mut corner = edge.curve.start();
        for mouth in mouths {
            if mouth.from < at - 1e-9 {
                self.error(
                    Code::DartTooWide,
                    Place::Dart(self.panel.id, mouth.dart),
                    "two darts of one edge overlap",
                    "move them apart or make them narrower",
                );
                continue;
            }
            let open = edge.curve.point(parameter(mouth.from));
            let close = edge.curve.point(parameter(mouth.to));
            if (mouth.from - at) * length > 1e-9 {
                let before = piece(at, mouth.from);
                result.push(ShapeEdge {
                    curve: with_ends(before.curve, corner, open),
                    ..before
                });
            }
            let apex = match mouth.tip {
                MouthTip::Apex(apex) => apex,
                MouthTip::Depth(depth) => {
                    let chord = close - open;
                    let left = Vec2::new(-chord.y, chord.x) * self.turn;
                    let inward = left.try_normalize(1e-15).unwrap_or_else(Vec2::zeros);
                    (open + close) * 0.5 + inward * depth
                }
            };
            for (leg, start, end) in [(0, open, apex), (1, apex, close)] {
                result.push(ShapeEdge {
                    origin: EdgeOrigin::DartLeg {
                        dart: mouth.dart,
                        reflected: false,
                        leg,
                    },
                    from: 0.0,
                    to: 1.0,
                    curve: Curve::Line { start, end },
                    seam_allowance: 0.0,
                });
            }
            at = mouth.to;
            corner = close;
        }
        if at == 0.0 && corner == edge.curve.start() {
            result.push(edge);
        } else if (1.0 - at) * length > 1e-9 {
            let after = piece(at, 1.0);
            result.push(ShapeEdge {
                curve: with_ends(after.curve, corner, edge.curve.end()),
                ..after
            });
        }
    }

    /// Adds a hole for every diamond dart.
    fn diamonds(&mut self, shape: &mut Shape) {
        for dart in &self.panel.darts {
            let DartShape::Diamond { ends, at, width } = &dart.shape else {
                continue;
            };
            let place = Place::Dart(self.panel.id, dart.id);
            let what = self.words(&format!("dart {:?}", dart.name));
            let ends = ends.map(|end| {
                self.resolver
                    .point_or_report(self.index, end, &place, &what)
            });
            let at = self.resolver.number(at, Want::Plain, &place, &what);
            let width = self.resolver.number(width, Want::Length, &place, &what);
            let ([Some(a), Some(b)], Some(at), Some(width)) = (ends, at, width) else {
                continue;
            };
            let way = b - a;
            let long_enough = way.norm() > 1e-9;
            if width <= 0.0 || !(0.0..=1.0).contains(&at) || !long_enough {
                let said = format!("dart {:?} has no width or length", dart.name);
                self.error(
                    Code::DartTooWide,
                    place,
                    &said,
                    "give it a width, two ends that are apart, and a widest place from 0 to 1",
                );
                continue;
            }
            let side = Vec2::new(-way.y, way.x).normalize() * (0.5 * width * self.turn);
            let middle = a + way * at;
            let corners = [a, middle + side, b, middle - side];
            let hole = (0..4).map(|leg| ShapeEdge {
                origin: EdgeOrigin::DartLeg {
                    dart: dart.id,
                    reflected: false,
                    leg: leg as u8,
                },
                from: 0.0,
                to: 1.0,
                curve: Curve::Line {
                    start: corners[leg],
                    end: corners[(leg + 1) % 4],
                },
                seam_allowance: 0.0,
            });
            shape.holes.push(hole.collect());
        }
    }
}
