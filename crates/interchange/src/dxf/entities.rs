//! Entities of a DXF file as lines, points and texts; curves become points of them.

use super::curves::{BSpline, CurvePoints};
use super::drawing::{Drawn, Entity};
use super::groups::{bulged_places, is_behind, is_closed, place, places, value};
use super::tags::Tag;
use super::text::TextEncoding;
use crate::FormatError;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use toile_geometry::Vec2;

/// Largest distance of the chords of a curve from it, where the file states its unit (m).
const FLATNESS: f64 = 1e-5;
/// Share of the extent of a drawing that its chords may be off from its curves, where it states no unit (1): one of
/// half a metre is right to 0.003 mm.
const FLAT_SHARE: f64 = 5e-6;

/// Makes lines, points and texts of entities.
pub(super) struct EntityReader {
    encoding: TextEncoding,
    /// Largest distance of the chords of a curve from it (units of the file).
    tolerance: f64,
    /// Vertices read so far.
    pub vertices: usize,
    /// Kinds of entities that were left out, with their numbers.
    pub left_out: BTreeMap<String, usize>,
    /// Kinds of curves that were read as points of them, with their numbers.
    pub curves: BTreeMap<&'static str, usize>,
}

/// A polyline whose vertices are being read.
pub(super) struct OpenLine {
    pub layer: String,
    /// Vertices, each with the bulge of the way to the next.
    pub vertices: Vec<(Vec2, f64)>,
    pub is_closed: bool,
    /// Whether it is seen from behind.
    pub is_behind: bool,
    /// Whether it is a mesh, which is no line.
    pub is_mesh: bool,
}

/// Number of the unit that the header states; 0 for none.
pub(super) fn header_unit(tags: &[Tag<'_>]) -> i64 {
    let unit = tags.windows(2).find(|pair| pair[0].is(9, "$INSUNITS"));
    unit.map_or(0, |pair| pair[1].count())
}

/// Largest distance of chords from the curves that they are drawn for (units of the file).
pub(super) fn tolerance(tags: &[Tag<'_>]) -> f64 {
    let says = |word: &str| {
        let text = |tag: &&Tag<'_>| tag.code == 1 && tag.value.len() < 40;
        let mut texts = tags.iter().filter(text);
        texts.any(|tag| {
            let text = tag.value.to_ascii_lowercase();
            text.starts_with(b"units") && text.ends_with(word.as_bytes())
        })
    };
    match header_unit(tags) {
        1 => return FLATNESS / 0.0254,
        4 => return FLATNESS / 1e-3,
        5 => return FLATNESS / 1e-2,
        6 => return FLATNESS,
        _ if says("english") => return FLATNESS / 0.0254,
        _ if says("metric") => return FLATNESS / 1e-3,
        _ => {}
    }
    let mut places = [f64::INFINITY, f64::NEG_INFINITY];
    for tag in tags.iter().filter(|tag| matches!(tag.code, 10 | 20)) {
        let value = tag.number().unwrap_or(0.0);
        places = [places[0].min(value), places[1].max(value)];
    }
    let extent = (places[1] - places[0]).clamp(1e-3, 1e6);
    (FLAT_SHARE * extent).min(FLATNESS / 1e-3)
}

impl EntityReader {
    /// A reader of the entities of a file with these tags.
    pub fn new(encoding: TextEncoding, tags: &[Tag<'_>]) -> Self {
        Self {
            encoding,
            tolerance: tolerance(tags),
            vertices: 0,
            left_out: BTreeMap::new(),
            curves: BTreeMap::new(),
        }
    }

    pub fn text(&self, group: &[Tag<'_>], code: i32) -> String {
        value(group, code).map_or_else(String::new, |tag| self.encoding.decode(tag.value))
    }

    /// A polyline after its last vertex.
    pub fn finished(&mut self, line: OpenLine) -> Option<Entity> {
        if line.is_mesh {
            self.leave_out("POLYLINE mesh");
            return None;
        }
        let drawn = self.polyline(line.vertices, line.is_closed, line.is_behind);
        Some(Entity {
            layer: line.layer,
            drawn,
        })
    }

    fn leave_out(&mut self, kind: &str) {
        *self.left_out.entry(kind.to_owned()).or_default() += 1;
    }

    fn polyline(
        &mut self,
        mut vertices: Vec<(Vec2, f64)>,
        is_closed: bool,
        is_behind: bool,
    ) -> Drawn {
        if is_behind {
            vertices
                .iter_mut()
                .for_each(|(at, bulge)| (at.x, *bulge) = (-at.x, -*bulge));
        }
        if vertices.iter().all(|(_, bulge)| *bulge == 0.0) {
            return Drawn::Line {
                points: vertices.into_iter().map(|(at, _)| at).collect(),
                is_closed,
                between: Vec::new(),
            };
        }
        *self.curves.entry("arcs of polylines").or_default() += 1;
        self.curve(
            CurvePoints::bulged(&vertices, is_closed, self.tolerance),
            is_closed,
        )
    }

    fn curve(&mut self, curve: CurvePoints, is_closed: bool) -> Drawn {
        self.vertices += curve.points.len();
        Drawn::Line {
            points: curve.points,
            is_closed,
            between: curve.between,
        }
    }

    pub fn drawn(&mut self, kind: &str, group: &[Tag<'_>]) -> Result<Option<Drawn>, FormatError> {
        let number = |code| value(group, code).and_then(|tag| tag.number().ok());
        Ok(Some(match kind {
            "LINE" => match (place(group, 10)?, place(group, 11)?) {
                (Some(from), Some(to)) => {
                    self.vertices += 2;
                    Drawn::Line {
                        points: vec![from, to],
                        is_closed: false,
                        between: Vec::new(),
                    }
                }
                _ => return Ok(None),
            },
            "LWPOLYLINE" => {
                let vertices = bulged_places(group)?;
                self.vertices += vertices.len();
                self.polyline(vertices, is_closed(group), is_behind(group))
            }
            "ARC" | "CIRCLE" | "ELLIPSE" => match self.round(kind, group)? {
                Some(drawn) => drawn,
                None => return Ok(None),
            },
            "SPLINE" => match self.spline(group)? {
                Some(drawn) => drawn,
                None => return Ok(None),
            },
            "POINT" => match place(group, 10)? {
                Some(at) => Drawn::Point {
                    at,
                    z: number(30),
                    thickness: number(39),
                    angle: number(50),
                },
                None => return Ok(None),
            },
            "TEXT" | "MTEXT" | "ATTDEF" | "ATTRIB" => Drawn::Text {
                at: place(group, 10)?.unwrap_or_default(),
                text: self.text(group, 1),
            },
            "SEQEND" | "ENDTAB" | "EOF" | "" => return Ok(None),
            kind => {
                self.leave_out(kind);
                return Ok(None);
            }
        }))
    }

    /// An arc, a circle or an ellipse; `None` if it lacks a number or its size is 0.
    fn round(&mut self, kind: &str, group: &[Tag<'_>]) -> Result<Option<Drawn>, FormatError> {
        let number = |code| value(group, code).map_or(Ok(None), |tag| tag.number().map(Some));
        let (name, axes, range) = match kind {
            "ELLIPSE" => {
                let (Some(axis), Some(ratio)) = (place(group, 11)?, number(40)?) else {
                    return Ok(None);
                };
                let across = Vec2::new(-axis.y, axis.x) * ratio;
                let to = number(42)?.unwrap_or(TAU);
                ("ELLIPSE", [axis, across], [number(41)?.unwrap_or(0.0), to])
            }
            kind => {
                let Some(radius) = number(40)? else {
                    return Ok(None);
                };
                let axes = [Vec2::new(radius, 0.0), Vec2::new(0.0, radius)];
                let from = number(50)?.unwrap_or(0.0).to_radians();
                let to = number(51)?.unwrap_or(0.0).to_radians();
                match kind {
                    "CIRCLE" => ("CIRCLE", axes, [0.0, TAU]),
                    _ => ("ARC", axes, [from, to]),
                }
            }
        };
        let Some(centre) = place(group, 10)?.filter(|_| axes[0].norm() > 0.0) else {
            return Ok(None);
        };
        // They run counter-clockwise from the start to the end.
        let [from, to] = range;
        let sweep = match (to - from).rem_euclid(TAU) {
            sweep if sweep > 1e-9 => sweep,
            _ => TAU,
        };
        let mut curve = CurvePoints::ellipse(centre, axes, [from, from + sweep], self.tolerance);
        if kind != "ELLIPSE" && is_behind(group) {
            curve.points.iter_mut().for_each(|p| p.x = -p.x);
        }
        *self.curves.entry(name).or_default() += 1;
        Ok(Some(self.curve(curve, false)))
    }

    /// A spline by its controls, else a line through the points that it was fitted to.
    fn spline(&mut self, group: &[Tag<'_>]) -> Result<Option<Drawn>, FormatError> {
        let numbers = |code: i32| -> Result<Vec<f64>, FormatError> {
            let own = group[1..].iter().filter(|tag| tag.code == code);
            own.map(Tag::number).collect()
        };
        let spline = BSpline {
            degree: value(group, 71).map_or(3, |tag| usize::try_from(tag.count()).unwrap_or(0)),
            knots: numbers(40)?,
            controls: places(group, 10)?,
            weights: numbers(41)?,
        };
        if let Some(curve) = spline.points(self.tolerance) {
            *self.curves.entry("SPLINE").or_default() += 1;
            return Ok(Some(self.curve(curve, false)));
        }
        let points = places(group, 11)?;
        if points.len() < 2 {
            self.leave_out("SPLINE");
            return Ok(None);
        }
        self.vertices += points.len();
        *self.curves.entry("SPLINE").or_default() += 1;
        Ok(Some(Drawn::Line {
            points,
            is_closed: false,
            between: Vec::new(),
        }))
    }
}
