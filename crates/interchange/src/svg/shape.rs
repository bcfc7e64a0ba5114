//! Shapes of elements as lines of straight and cubic spans, in units of the element.

use super::viewport::{Axis, Viewport, length};
use crate::drawn::piece::{DrawnLine, Span};
use kurbo::{Affine, Arc, PathEl, Point, SvgArc};
use roxmltree::Node;
use svgtypes::{PathParser, PathSegment, PointsParser};
use toile_geometry::Vec2;

/// Largest distance of a cubic from the arc that it stands for, as a share of the radius: 1 um at 2 m.
const ARC_ERROR: f64 = 5e-7;
/// Arcs between ends that are nearer, as a share of the radius, are straight.
const SHORT_ARC: f64 = 1e-9;

/// Lines that are drawn by one element.
#[derive(Debug, Default)]
pub(super) struct Shape {
    /// The lines.
    pub lines: Vec<DrawnLine>,
    /// Whether its description ends in a fault; what comes before is drawn.
    pub is_damaged: bool,
}

/// The shape of an element; `None` if it is of a kind that draws no lines.
pub(super) fn shape(node: Node<'_, '_>, viewport: Viewport) -> Option<Shape> {
    let at = |name: &str, axis| length(node, name, (axis, viewport));
    let x = |name: &str| at(name, Axis::X).unwrap_or(0.0);
    let y = |name: &str| at(name, Axis::Y).unwrap_or(0.0);
    let mut pen = Pen::default();
    match node.tag_name().name() {
        "path" => pen.path(node.attribute("d").unwrap_or_default()),
        "line" => {
            pen.start(Vec2::new(x("x1"), y("y1")));
            pen.straight(Vec2::new(x("x2"), y("y2")));
        }
        "polyline" | "polygon" => {
            let points = node.attribute("points").unwrap_or_default();
            for (x, y) in PointsParser::from(points) {
                match pen.points.is_empty() {
                    true => pen.start(Vec2::new(x, y)),
                    false => pen.straight(Vec2::new(x, y)),
                }
            }
            if node.tag_name().name() == "polygon" {
                pen.close();
            }
        }
        "rect" => {
            let low = Vec2::new(x("x"), y("y"));
            let size = Vec2::new(x("width"), y("height"));
            let [rx, ry] = [at("rx", Axis::X), at("ry", Axis::Y)];
            let radii = Vec2::new(
                rx.or(ry).unwrap_or(0.0).clamp(0.0, 0.5 * size.x.max(0.0)),
                ry.or(rx).unwrap_or(0.0).clamp(0.0, 0.5 * size.y.max(0.0)),
            );
            if size.x > 0.0 && size.y > 0.0 {
                pen.rectangle(low, size, radii);
            }
        }
        "circle" => {
            let r = at("r", Axis::Both).unwrap_or(0.0);
            pen.ellipse(Vec2::new(x("cx"), y("cy")), Vec2::new(r, r));
        }
        "ellipse" => {
            let radii = Vec2::new(x("rx"), y("ry"));
            pen.ellipse(Vec2::new(x("cx"), y("cy")), radii);
        }
        _ => return None,
    }
    pen.finish();
    Some(pen.shape)
}

/// The lines of a description of a path.
pub(super) fn path(text: &str) -> Shape {
    let mut pen = Pen::default();
    pen.path(text);
    pen.finish();
    pen.shape
}

/// A line with its points mapped.
pub(super) fn placed(line: &DrawnLine, by: Affine) -> DrawnLine {
    line.mapped(|p| {
        let p = by * Point::new(p.x, p.y);
        Vec2::new(p.x, p.y)
    })
}

/// Draws lines one way after another.
#[derive(Default)]
struct Pen {
    shape: Shape,
    points: Vec<Vec2>,
    spans: Vec<Span>,
    /// Last handle of the way before, if that is a cubic or a quadratic, and which.
    handle: Option<(Vec2, bool)>,
}

impl Pen {
    fn at(&self) -> Vec2 {
        self.points.last().copied().unwrap_or_default()
    }

    fn start(&mut self, at: Vec2) {
        self.finish();
        self.points.push(at);
        self.handle = None;
    }

    fn straight(&mut self, to: Vec2) {
        self.points.push(to);
        self.spans.push(Span::Straight);
        self.handle = None;
    }

    fn cubic(&mut self, handles: [Vec2; 2], to: Vec2) {
        self.points.push(to);
        self.spans.push(Span::Cubic(handles));
        self.handle = Some((handles[1], true));
    }

    fn quadratic(&mut self, handle: Vec2, to: Vec2) {
        let from = self.at();
        let third = |end: Vec2| end + (handle - end) * (2.0 / 3.0);
        self.cubic([third(from), third(to)], to);
        self.handle = Some((handle, false));
    }

    fn close(&mut self) {
        let Some(&first) = self.points.first() else {
            return;
        };
        // A line that returns to its start before it is closed does not go there twice.
        if self.points.len() > 1 && self.at() == first {
            self.points.pop();
        } else {
            self.spans.push(Span::Straight);
        }
        self.put(true);
    }

    fn finish(&mut self) {
        self.put(false);
    }

    fn put(&mut self, is_closed: bool) {
        let points = std::mem::take(&mut self.points);
        let spans = std::mem::take(&mut self.spans);
        self.handle = None;
        if points.len() > 1 || is_closed && matches!(spans[..], [Span::Cubic(_)]) {
            self.shape.lines.push(DrawnLine {
                by_size: vec![points],
                is_closed,
                spans,
                ..DrawnLine::default()
            });
        }
    }

    fn arc(&mut self, arc: Arc) {
        let radius = arc.radii.x.max(arc.radii.y);
        for way in arc.append_iter(ARC_ERROR * radius) {
            if let PathEl::CurveTo(a, b, to) = way {
                let [a, b, to] = [a, b, to].map(|p| Vec2::new(p.x, p.y));
                self.cubic([a, b], to);
            }
        }
        self.handle = None;
    }

    fn ellipse(&mut self, centre: Vec2, radii: Vec2) {
        if radii.x <= 0.0 || radii.y <= 0.0 {
            return;
        }
        self.start(centre + Vec2::new(radii.x, 0.0));
        self.arc(Arc {
            center: Point::new(centre.x, centre.y),
            radii: kurbo::Vec2::new(radii.x, radii.y),
            start_angle: 0.0,
            sweep_angle: std::f64::consts::TAU,
            x_rotation: 0.0,
        });
        // The end is the start but for rounding.
        if let Some(&first) = self.points.first()
            && let Some(last) = self.points.last_mut()
        {
            *last = first;
        }
        self.close();
    }

    fn rectangle(&mut self, low: Vec2, size: Vec2, radii: Vec2) {
        let at = |x: f64, y: f64| low + Vec2::new(x, y);
        let (w, h, rx, ry) = (size.x, size.y, radii.x, radii.y);
        if rx <= 0.0 || ry <= 0.0 {
            self.start(at(0.0, 0.0));
            self.straight(at(w, 0.0));
            self.straight(at(w, h));
            self.straight(at(0.0, h));
            self.close();
            return;
        }
        self.start(at(rx, 0.0));
        let corners = [
            (at(w - rx, 0.0), at(w, ry)),
            (at(w, h - ry), at(w - rx, h)),
            (at(rx, h), at(0.0, h - ry)),
            (at(0.0, ry), at(rx, 0.0)),
        ];
        for (from, to) in corners {
            if from != self.at() {
                self.straight(from);
            }
            self.elliptic([rx, ry], 0.0, (false, true), to);
        }
        self.close();
    }

    /// An elliptic arc as a path describes it: radii, turn (degrees), and which of four ways it runs.
    fn elliptic(&mut self, [rx, ry]: [f64; 2], turn: f64, (large, sweep): (bool, bool), to: Vec2) {
        let from = self.at();
        let radius = rx.abs().min(ry.abs());
        if (to - from).norm() <= SHORT_ARC * radius || radius == 0.0 {
            self.straight(to);
            return;
        }
        // Radii are told in their own size, so that none counts as too small to be an arc.
        let unit = rx.abs().max(ry.abs());
        let own = |p: Vec2| Point::new(p.x / unit, p.y / unit);
        let arc = Arc::from_svg_arc(&SvgArc {
            from: own(from),
            to: own(to),
            radii: kurbo::Vec2::new(rx / unit, ry / unit),
            x_rotation: turn.to_radians(),
            large_arc: large,
            sweep,
        });
        let Some(arc) = arc.filter(|arc| arc.sweep_angle.is_finite()) else {
            self.straight(to);
            return;
        };
        self.arc(Arc {
            center: Point::new(arc.center.x * unit, arc.center.y * unit),
            radii: arc.radii * unit,
            ..arc
        });
        if let Some(last) = self.points.last_mut() {
            *last = to;
        }
    }

    fn path(&mut self, text: &str) {
        // The start of a line that is drawn on without a move after it is closed.
        let mut first = Vec2::zeros();
        for segment in PathParser::from(text) {
            let Ok(segment) = segment else {
                self.shape.is_damaged = true;
                return;
            };
            let is_move = matches!(segment, PathSegment::MoveTo { .. });
            let from = match self.points.is_empty() {
                true => first,
                false => self.at(),
            };
            let is_close = matches!(segment, PathSegment::ClosePath { .. });
            if !is_move && !is_close && self.points.is_empty() {
                self.start(first);
            }
            let base = if segment.is_abs() {
                Vec2::zeros()
            } else {
                from
            };
            let to = |x: f64, y: f64| base + Vec2::new(x, y);
            let mirrored = |is_cubic: bool, pen: &Self| match pen.handle {
                Some((handle, kind)) if kind == is_cubic => from * 2.0 - handle,
                Some(_) | None => from,
            };
            match segment {
                PathSegment::MoveTo { x, y, .. } => {
                    first = to(x, y);
                    self.start(first);
                }
                PathSegment::LineTo { x, y, .. } => self.straight(to(x, y)),
                PathSegment::HorizontalLineTo { x, .. } => {
                    self.straight(Vec2::new(base.x + x, from.y));
                }
                PathSegment::VerticalLineTo { y, .. } => {
                    self.straight(Vec2::new(from.x, base.y + y));
                }
                PathSegment::CurveTo {
                    x1,
                    y1,
                    x2,
                    y2,
                    x,
                    y,
                    ..
                } => self.cubic([to(x1, y1), to(x2, y2)], to(x, y)),
                PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                    self.cubic([mirrored(true, self), to(x2, y2)], to(x, y));
                }
                PathSegment::Quadratic { x1, y1, x, y, .. } => {
                    self.quadratic(to(x1, y1), to(x, y));
                }
                PathSegment::SmoothQuadratic { x, y, .. } => {
                    self.quadratic(mirrored(false, self), to(x, y));
                }
                PathSegment::EllipticalArc {
                    rx,
                    ry,
                    x_axis_rotation,
                    large_arc,
                    sweep,
                    x,
                    y,
                    ..
                } => self.elliptic([rx, ry], x_axis_rotation, (large_arc, sweep), to(x, y)),
                PathSegment::ClosePath { .. } => self.close(),
            }
        }
    }
}
