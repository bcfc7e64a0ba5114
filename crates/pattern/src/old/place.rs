//! Where points lie, and the edit that puts one somewhere else without losing how it is made:
//! formulas stay and get a term added, constructed points keep their construction.

use crate::apply::impossible;
use crate::resolver::Resolver;
use crate::{
    EdgeId, Edit, EditError, Formula, Number, PanelEdit, PanelId, Pattern, PointId, PointPlace,
};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use toile_geometry::{Curve, Vec2};
use toile_measure::Measurements;

/// Parts an edge is searched in for the place nearest to a point.
const SEARCH_PARTS: usize = 64;
/// Halvings of the part found. Distances to the nearest place differ by less than rounding then,
/// which leaves the place right to about 1e-8 of the length.
const SEARCH_HALVINGS: usize = 30;

impl Pattern {
    /// Place of every point that can be computed for these measurements [m].
    pub fn point_places(&self, measurements: &Measurements) -> BTreeMap<(PanelId, PointId), Vec2> {
        let mut resolver = Resolver::new(self, measurements);
        let mut places = BTreeMap::new();
        for (k, panel) in self.panels.iter().enumerate() {
            for point in &panel.points {
                if let Ok(place) = resolver.point_at(k, point.id) {
                    places.insert((panel.id, point.id), place);
                }
            }
        }
        places
    }

    /// The edit that moves a point to `to` [m] as it is drawn for these measurements.
    ///
    /// A value is replaced; a formula keeps its text and gets a term added. A point constructed
    /// from others keeps its construction with new numbers, so a point on an edge or a line goes
    /// to the nearest place on it.
    pub fn move_edit(
        &self,
        measurements: &Measurements,
        (panel, point): (PanelId, PointId),
        to: Vec2,
    ) -> Result<Edit, EditError> {
        if !(to.x.is_finite() && to.y.is_finite()) {
            return Err(EditError::NotFinite("the new place".into()));
        }
        let k = self.panel_position(panel)?;
        let found = self.panels[k]
            .point(point)
            .ok_or_else(|| EditError::Missing(point.to_string()))?;
        let mut mover = Mover {
            pattern: self,
            measurements,
            resolver: Resolver::new(self, measurements),
            panel: k,
        };
        let now = mover.at(point)?;
        let place = mover.place(&found.place, now, to)?;
        Ok(Edit::InPanel {
            panel,
            edit: PanelEdit::MovePoint { point, place },
        })
    }

    /// The edit that divides an edge at its place nearest to a point [m].
    pub fn split_edit_near(
        &self,
        measurements: &Measurements,
        (panel, edge): (PanelId, EdgeId),
        near: Vec2,
    ) -> Result<Edit, EditError> {
        let curve = self.drawn(measurements, panel, edge)?;
        self.split_edit(measurements, (panel, edge), nearest_share(&curve, near))
    }
}

/// What a number counts, for the term that is added to a formula.
#[derive(Clone, Copy)]
enum Unit {
    Length,
    Angle,
    Plain,
}

struct Mover<'a> {
    pattern: &'a Pattern,
    measurements: &'a Measurements,
    resolver: Resolver<'a>,
    panel: usize,
}

impl Mover<'_> {
    fn at(&mut self, point: PointId) -> Result<Vec2, EditError> {
        self.resolver
            .point_at(self.panel, point)
            .map_err(|_| impossible("the point cannot be drawn", "mend its formulas first"))
    }

    fn place(&mut self, old: &PointPlace, now: Vec2, to: Vec2) -> Result<PointPlace, EditError> {
        let shift = to - now;
        Ok(match old {
            PointPlace::At { x, y } => PointPlace::At {
                x: added(x, shift.x, Unit::Length)?,
                y: added(y, shift.y, Unit::Length)?,
            },
            PointPlace::Offset { base, x, y } => PointPlace::Offset {
                base: *base,
                x: added(x, shift.x, Unit::Length)?,
                y: added(y, shift.y, Unit::Length)?,
            },
            PointPlace::Polar {
                base,
                angle,
                distance,
            } => {
                let centre = self.at(*base)?;
                let (before, after) = (now - centre, to - centre);
                let turn = after.y.atan2(after.x) - before.y.atan2(before.x);
                PointPlace::Polar {
                    base: *base,
                    angle: added(angle, turn - TAU * (turn / TAU).round(), Unit::Angle)?,
                    distance: added(distance, after.norm() - before.norm(), Unit::Length)?,
                }
            }
            PointPlace::Between {
                base,
                tip,
                along,
                aside,
            } => {
                let way = self.way(*base, *tip)?;
                let left = Vec2::new(-way.y, way.x);
                let square = way.norm_squared();
                PointPlace::Between {
                    base: *base,
                    tip: *tip,
                    along: added(along, shift.dot(&way) / square, Unit::Plain)?,
                    aside: added(aside, shift.dot(&left) / square, Unit::Plain)?,
                }
            }
            PointPlace::Toward {
                base,
                tip,
                distance,
            } => {
                let unit = self.way(*base, *tip)?.normalize();
                PointPlace::Toward {
                    base: *base,
                    tip: *tip,
                    distance: added(distance, shift.dot(&unit), Unit::Length)?,
                }
            }
            PointPlace::OnEdge { edge, at } => {
                let owner = self.pattern.panels[self.panel].id;
                let curve = self.pattern.drawn(self.measurements, owner, *edge)?;
                let shift = nearest_share(&curve, to) - nearest_share(&curve, now);
                PointPlace::OnEdge {
                    edge: *edge,
                    at: added(at, shift, Unit::Plain)?,
                }
            }
            PointPlace::Crossing { .. } => {
                return Err(impossible(
                    "the point lies where two lines cross",
                    "move the points that the lines go through",
                ));
            }
            PointPlace::Mirrored { .. } => {
                return Err(impossible(
                    "the point is the mirror image of another",
                    "move the other point",
                ));
            }
        })
    }

    fn way(&mut self, base: PointId, tip: PointId) -> Result<Vec2, EditError> {
        let way = self.at(tip)? - self.at(base)?;
        if way.norm() > 1e-12 {
            return Ok(way);
        }
        Err(impossible(
            "the two points it is constructed from are in the same place",
            "move them apart",
        ))
    }
}

/// Share of a curve's length at which it comes nearest to a point.
fn nearest_share(curve: &Curve, to: Vec2) -> f64 {
    let length = curve.length();
    if length <= 0.0 {
        return 0.0;
    }
    let away = |t: f64| (curve.point(t) - to).norm_squared();
    let step = 1.0 / SEARCH_PARTS as f64;
    let mut best = (0..=SEARCH_PARTS)
        .map(|k| k as f64 * step)
        .min_by(|a, b| away(*a).total_cmp(&away(*b)))
        .unwrap_or(0.0);
    let mut reach = step;
    for _ in 0..SEARCH_HALVINGS {
        for t in [(best - reach).max(0.0), (best + reach).min(1.0)] {
            if away(t) < away(best) {
                best = t;
            }
        }
        reach *= 0.5;
    }
    curve.length_until(best) / length
}

/// The number with something added [m], [rad] or plain. A formula keeps its text: a term in cm or
/// degrees follows it, and takes up the term that an earlier move put there.
fn added(number: &Number, shift: f64, unit: Unit) -> Result<Number, EditError> {
    let text = match number {
        Number::Value(value) => return Ok(Number::Value(value + shift)),
        Number::Formula(_) if shift == 0.0 => return Ok(number.clone()),
        Number::Formula(formula) => formula.text(),
    };
    let (factor, name) = match unit {
        Unit::Length => (100.0, "cm"),
        Unit::Angle => (1f64.to_degrees(), "deg"),
        Unit::Plain => (1.0, ""),
    };
    let (core, before) = term(text, name).unwrap_or((text, 0.0));
    let total = before + shift * factor;
    let digits = format!("{:.6}", total.abs());
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    let whole = match digits {
        "0" => core.to_owned(),
        _ if total < 0.0 => format!("({core}) - {digits}{name}"),
        _ => format!("({core}) + {digits}{name}"),
    };
    Formula::parse(&whole)
        .map(Number::Formula)
        .map_err(|error| impossible(&error.message, &error.hint))
}

/// The formula and the last term of a text that [`added`] wrote.
fn term<'a>(text: &'a str, unit: &str) -> Option<(&'a str, f64)> {
    let inner = text.strip_prefix('(')?;
    let mut depth = 1;
    let mut quoted = false;
    let close = inner.find(|c| {
        match c {
            '\'' => quoted = !quoted,
            '(' if !quoted => depth += 1,
            ')' if !quoted => depth -= 1,
            _ => {}
        }
        depth == 0
    })?;
    let rest = &inner[close + 1..];
    let (sign, rest) = match rest.strip_prefix(" + ") {
        Some(rest) => (1.0, rest),
        None => (-1.0, rest.strip_prefix(" - ")?),
    };
    let digits = rest.strip_suffix(unit)?;
    if !digits.chars().all(|c| c.is_ascii_digit() || c == '.') {
        return None;
    }
    Some((&inner[..close], sign * digits.parse::<f64>().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Edge, EdgeCurve, FabricId, Panel, Point};
    use std::sync::Arc;

    /// A square of 10 cm whose first corner has formulas, with one point of each construction.
    fn pattern() -> Pattern {
        let number = |text: &str| Number::formula(text).unwrap();
        let id = PointId;
        let places = [
            PointPlace::At {
                x: number("2cm - 2cm"),
                y: number("0"),
            },
            PointPlace::at(0.1, 0.0),
            PointPlace::at(0.1, 0.1),
            PointPlace::Offset {
                base: id(0),
                x: Number::Value(0.0),
                y: number("10cm"),
            },
            PointPlace::Polar {
                base: id(0),
                angle: number("30 deg"),
                distance: Number::Value(0.05),
            },
            PointPlace::Between {
                base: id(0),
                tip: id(2),
                along: Number::Value(0.5),
                aside: number("1/10"),
            },
            PointPlace::Toward {
                base: id(0),
                tip: id(1),
                distance: Number::Value(0.02),
            },
            PointPlace::OnEdge {
                edge: EdgeId(1),
                at: Number::Value(0.5),
            },
            PointPlace::Crossing {
                first: [id(0), id(2)],
                second: [id(1), id(3)],
            },
            PointPlace::Mirrored {
                base: id(1),
                line: [id(0), id(2)],
            },
        ];
        let mut panel = Panel::new(PanelId(0), "square", FabricId(0));
        for (k, place) in places.into_iter().enumerate() {
            panel.points.push(Point {
                id: PointId(k as u32),
                name: format!("p{k}"),
                place,
            });
        }
        for k in 0..4 {
            panel.outline.push(Edge {
                id: EdgeId(k),
                name: format!("e{k}"),
                ends: [PointId(k), PointId((k + 1) % 4)],
                curve: EdgeCurve::Line,
                seam_allowance: None,
            });
        }
        let mut pattern = Pattern::new("test");
        pattern.panels.push(Arc::new(panel));
        pattern
    }

    fn moved(pattern: &mut Pattern, point: u32, to: Vec2) -> Vec2 {
        let none = Measurements::new();
        let edit = pattern.move_edit(&none, (PanelId(0), PointId(point)), to);
        pattern.apply(edit.unwrap()).unwrap();
        pattern.point_places(&none)[&(PanelId(0), PointId(point))]
    }

    #[test]
    fn free_points_go_where_they_are_moved() {
        for point in [0, 1, 3, 4, 5] {
            let mut pattern = pattern();
            for to in [
                Vec2::new(0.0312, -0.0045),
                Vec2::new(0.2, 0.07),
                Vec2::new(-0.01, 0.02),
            ] {
                let at = moved(&mut pattern, point, to);
                assert!((at - to).norm() < 1e-7, "point {point}: {at} for {to}");
            }
        }
    }

    #[test]
    fn points_on_lines_and_edges_stay_on_them() {
        let mut pattern = pattern();
        let at = moved(&mut pattern, 6, Vec2::new(0.07, 0.5));
        assert!((at - Vec2::new(0.07, 0.0)).norm() < 1e-7);
        let at = moved(&mut pattern, 7, Vec2::new(0.3, 0.02));
        assert!((at - Vec2::new(0.1, 0.02)).norm() < 1e-7);
    }

    #[test]
    fn formulas_stay_and_their_added_term_is_renewed() {
        let mut pattern = pattern();
        let text = |pattern: &Pattern| match &pattern.panels[0].points[0].place {
            PointPlace::At {
                x: Number::Formula(x),
                ..
            } => x.text().to_owned(),
            other => panic!("{other:?}"),
        };
        moved(&mut pattern, 0, Vec2::new(0.015, 0.0));
        assert_eq!(text(&pattern), "(2cm - 2cm) + 1.5cm");
        moved(&mut pattern, 0, Vec2::new(-0.0125, 0.0));
        assert_eq!(text(&pattern), "(2cm - 2cm) - 1.25cm");
        moved(&mut pattern, 0, Vec2::zeros());
        assert_eq!(text(&pattern), "2cm - 2cm");
    }

    #[test]
    fn an_edge_is_divided_where_it_is_nearest() {
        let mut pattern = pattern();
        let none = Measurements::new();
        let near = Vec2::new(0.09, 0.027);
        let edit = pattern.split_edit_near(&none, (PanelId(0), EdgeId(1)), near);
        pattern.apply(edit.unwrap()).unwrap();
        let corner = pattern.panels[0].outline[1].ends[1];
        let at = pattern.point_places(&none)[&(PanelId(0), corner)];
        assert!((at - Vec2::new(0.1, 0.027)).norm() < 1e-7);
    }

    #[test]
    fn a_term_somebody_wrote_is_told_from_an_added_one() {
        assert_eq!(term("(a + b) + 2.5cm", "cm"), Some(("a + b", 2.5)));
        for text in ["(a) + (b) + 2cm", "(a) + bcm", "a + 2cm", "(a) * 2cm"] {
            assert_eq!(term(text, "cm"), None, "{text}");
        }
    }

    #[test]
    fn points_without_freedom_and_bad_places_are_refused() {
        let pattern = pattern();
        let none = Measurements::new();
        for point in [8, 9, 99] {
            let refused = pattern.move_edit(&none, (PanelId(0), PointId(point)), Vec2::zeros());
            assert!(refused.is_err());
        }
        let nowhere = Vec2::new(f64::NAN, 0.0);
        let refused = pattern.move_edit(&none, (PanelId(0), PointId(1)), nowhere);
        assert!(matches!(refused, Err(EditError::NotFinite(_))));
    }
}
