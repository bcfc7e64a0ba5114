//! Dividing an edge at a new corner, and joining two edges at an old one: seams, notches and
//! darts stay where they were.

use crate::apply::impossible;
use crate::{
    Along, DartShape, Edge, EdgeCurve, EdgeId, Edit, EditError, Number, Panel, PanelEdit, PanelId,
    Pattern, Point, PointId, PointPlace, Span,
};
use std::sync::Arc;
use toile_geometry::Curve;
use toile_measure::Measurements;

/// An edge and the part that is divided from it.
pub(crate) struct Part {
    pub edge: EdgeId,
    pub at: f64,
    pub new_edge: EdgeId,
}

/// Two edges that become one.
pub(crate) struct Join {
    kept: EdgeId,
    gone: EdgeId,
    at: f64,
}

fn fixed(number: &Number, what: &str) -> Result<f64, EditError> {
    number.value().ok_or_else(|| {
        impossible(
            &format!("{what} is placed by a formula along the edge"),
            "give it a plain fraction first",
        )
    })
}

fn share(at: f64) -> Result<(), EditError> {
    if at > 1e-9 && at < 1.0 - 1e-9 {
        Ok(())
    } else {
        Err(impossible(
            "an edge is divided at one of its ends",
            "choose a place between its ends",
        ))
    }
}

impl Part {
    /// Where a fraction of the whole edge lies.
    fn locate(&self, fraction: f64) -> (EdgeId, f64) {
        if fraction <= self.at {
            (self.edge, fraction / self.at)
        } else {
            (self.new_edge, (fraction - self.at) / (1.0 - self.at))
        }
    }

    pub fn split(
        &mut self,
        panel: &mut Panel,
        points: Vec<Point>,
        curves: [EdgeCurve; 2],
        name: String,
    ) -> Result<(), EditError> {
        share(self.at)?;
        let Some(corner) = points.first().map(|point| point.id) else {
            return Err(impossible(
                "an edge is divided without a corner",
                "give the corner as the first point",
            ));
        };
        let id = self.edge;
        if panel.fold == Some(id) {
            return Err(impossible(
                "the fold line is divided",
                "unfold the panel first, or divide another edge",
            ));
        }
        let list = std::iter::once(&mut panel.outline)
            .chain(&mut panel.holes)
            .find(|list| list.iter().any(|edge| edge.id == id));
        let list = list.ok_or_else(|| EditError::Missing(id.to_string()))?;
        let k = list.iter().position(|edge| edge.id == id).unwrap_or(0);
        let [first, second] = curves;
        let end = list[k].ends[1];
        let allowance = list[k].seam_allowance.clone();
        list[k].ends[1] = corner;
        list[k].curve = first;
        list.insert(
            k + 1,
            Edge {
                id: self.new_edge,
                name,
                ends: [corner, end],
                curve: second,
                seam_allowance: allowance,
            },
        );
        panel.points.extend(points);
        for notch in panel.notches.iter_mut().filter(|notch| notch.edge == id) {
            let Along::Fraction(at) = &notch.at else {
                return Err(impossible(
                    &format!("notch {:?} is placed by a distance", notch.name),
                    "give it a fraction first",
                ));
            };
            let (edge, at) = self.locate(fixed(at, "a notch")?);
            notch.edge = edge;
            notch.at = Along::Fraction(at.into());
        }
        for dart in &mut panel.darts {
            if let DartShape::Edge { edge, at, .. } = &mut dart.shape
                && *edge == id
            {
                let (found, fraction) = self.locate(fixed(at, "a dart")?);
                *edge = found;
                *at = fraction.into();
            }
        }
        for point in &mut panel.points {
            if let PointPlace::OnEdge { edge, at } = &mut point.place
                && *edge == id
            {
                let (found, fraction) = self.locate(fixed(at, "a point")?);
                *edge = found;
                *at = fraction.into();
            }
        }
        Ok(())
    }

    fn spans(&self, span: &Span) -> Result<Vec<Span>, EditError> {
        let from = fixed(&span.from, "a seam")?;
        let to = fixed(&span.to, "a seam")?;
        let piece = |edge: EdgeId, from: f64, to: f64| Span {
            edge,
            from: from.into(),
            to: to.into(),
            ..span.clone()
        };
        let (low, high) = (from.min(to), from.max(to));
        let mut parts = Vec::new();
        if low < self.at {
            let end = high.min(self.at) / self.at;
            parts.push(piece(self.edge, low / self.at, end));
        }
        if high > self.at {
            let rest = 1.0 - self.at;
            let start = (low - self.at).max(0.0) / rest;
            parts.push(piece(self.new_edge, start, (high - self.at) / rest));
        }
        if from > to {
            parts = parts.into_iter().rev().map(Span::reversed).collect();
        }
        Ok(parts)
    }
}

/// Joins the two edges of an outline or hole that meet at a corner.
pub(crate) fn join(panel: &mut Panel, point: PointId, at: f64) -> Result<Join, EditError> {
    share(at)?;
    let list = std::iter::once(&mut panel.outline)
        .chain(&mut panel.holes)
        .find(|list| list.iter().any(|edge| edge.ends[1] == point));
    let list = list.ok_or_else(|| EditError::Missing(format!("a corner at {point}")))?;
    if list.len() < 3 {
        return Err(impossible(
            "an outline of two edges would lose one",
            "remove the panel or the hole instead",
        ));
    }
    let k = list
        .iter()
        .position(|edge| edge.ends[1] == point)
        .unwrap_or(0);
    let next = (k + 1) % list.len();
    if list[next].ends[0] != point {
        return Err(impossible(
            "the outline is open at this corner",
            "close it first",
        ));
    }
    let gone = list[next].clone();
    let kept = list[k].id;
    if panel
        .fold
        .is_some_and(|fold| fold == gone.id || fold == kept)
    {
        return Err(EditError::InUse {
            what: point.to_string(),
            by: "the fold line".into(),
        });
    }
    list[k].ends[1] = gone.ends[1];
    list[k].curve = match (&list[k].curve, &gone.curve) {
        (EdgeCurve::Cubic { controls: a }, EdgeCurve::Cubic { controls: b }) => EdgeCurve::Cubic {
            controls: [a[0], b[1]],
        },
        _ => EdgeCurve::Line,
    };
    list.remove(next);
    let join = Join {
        kept,
        gone: gone.id,
        at,
    };
    for notch in &mut panel.notches {
        if notch.edge != kept && notch.edge != gone.id {
            continue;
        }
        let Along::Fraction(fraction) = &notch.at else {
            return Err(impossible(
                &format!("notch {:?} is placed by a distance", notch.name),
                "give it a fraction first",
            ));
        };
        let fraction = join.locate(notch.edge, fixed(fraction, "a notch")?);
        notch.edge = kept;
        notch.at = Along::Fraction(fraction.into());
    }
    for dart in &mut panel.darts {
        if let DartShape::Edge { edge, at, .. } = &mut dart.shape
            && (*edge == kept || *edge == gone.id)
        {
            *at = join.locate(*edge, fixed(at, "a dart")?).into();
            *edge = kept;
        }
    }
    for point in &mut panel.points {
        if let PointPlace::OnEdge { edge, at } = &mut point.place
            && (*edge == kept || *edge == gone.id)
        {
            *at = join.locate(*edge, fixed(at, "a point")?).into();
            *edge = kept;
        }
    }
    if panel.user_of(point).is_none() {
        panel.points.retain(|p| p.id != point);
    }
    Ok(join)
}

impl Join {
    fn locate(&self, edge: EdgeId, fraction: f64) -> f64 {
        if edge == self.kept {
            fraction * self.at
        } else {
            self.at + fraction * (1.0 - self.at)
        }
    }
}

impl Pattern {
    fn rewrite_spans(
        &mut self,
        touched: impl Fn(&Span) -> bool,
        replace: impl Fn(&Span) -> Result<Vec<Span>, EditError>,
    ) -> Result<(), EditError> {
        for seam in &mut self.seams {
            if !seam.spans().any(&touched) {
                continue;
            }
            let mut changed = (**seam).clone();
            for side in &mut changed.sides {
                let mut spans: Vec<Span> = Vec::new();
                for span in side.iter() {
                    if !touched(span) {
                        spans.push(span.clone());
                        continue;
                    }
                    for part in replace(span)? {
                        match spans.last_mut() {
                            Some(last) if continues(last, &part) => last.to = part.to,
                            _ => spans.push(part),
                        }
                    }
                }
                *side = spans;
            }
            *seam = Arc::new(changed);
        }
        Ok(())
    }

    pub(crate) fn respan(&mut self, part: &mut Part, panel: PanelId) -> Result<(), EditError> {
        let part = &*part;
        self.rewrite_spans(
            |span| span.panel == panel && span.edge == part.edge,
            |span| part.spans(span),
        )
    }

    pub(crate) fn rejoin(&mut self, join: &Join, panel: PanelId) -> Result<(), EditError> {
        self.rewrite_spans(
            |span| span.panel == panel && (span.edge == join.kept || span.edge == join.gone),
            |span| {
                let place = |number: &Number| -> Result<Number, EditError> {
                    Ok(join.locate(span.edge, fixed(number, "a seam")?).into())
                };
                Ok(vec![Span {
                    edge: join.kept,
                    from: place(&span.from)?,
                    to: place(&span.to)?,
                    ..span.clone()
                }])
            },
        )
    }

    /// The edit that divides an edge at a fraction of its arc length, both parts lying on the
    /// curve as it is for these measurements.
    pub fn split_edit(
        &self,
        measurements: &Measurements,
        (panel, edge): (PanelId, EdgeId),
        at: f64,
    ) -> Result<Edit, EditError> {
        share(at)?;
        let owner = self
            .panel(panel)
            .ok_or_else(|| EditError::Missing(panel.to_string()))?;
        let found = owner
            .edge(edge)
            .ok_or_else(|| EditError::Missing(edge.to_string()))?;
        let curve = self.drawn(measurements, panel, edge)?;
        let t = curve.parameter_at_length(curve.length() * at);
        let halves = [curve.between(0.0, t), curve.between(t, 1.0)];
        let mut ids = self.free_ids();
        let mut points: Vec<Point> = Vec::new();
        let mut add = |place: toile_geometry::Vec2| {
            let id = ids.take_point();
            let mut name = format!("p{}", id.0);
            while owner.point_named(&name).is_some() {
                name.push('_');
            }
            points.push(Point {
                id,
                name,
                place: PointPlace::at(place.x, place.y),
            });
            id
        };
        add(halves[0].end());
        let curves = halves.map(|half| match half {
            Curve::Line { .. } => EdgeCurve::Line,
            Curve::Arc { bulge, .. } => EdgeCurve::Arc {
                bulge: bulge.into(),
            },
            Curve::Quadratic { control, .. } => EdgeCurve::Quadratic {
                control: add(control),
            },
            Curve::Cubic { controls, .. } => EdgeCurve::Cubic {
                controls: controls.map(&mut add),
            },
        });
        let new_edge = ids.take_edge();
        let mut name = format!("{} 2", found.name);
        while owner.edge_named(&name).is_some() || name.chars().count() > crate::NAME_LENGTH {
            name = format!("e{}{}", new_edge.0, "_".repeat(name.len() % 7));
        }
        Ok(Edit::InPanel {
            panel,
            edit: PanelEdit::SplitEdge {
                edge,
                at,
                points,
                curves,
                new_edge,
                name,
            },
        })
    }

    /// The edit that removes a corner of an outline or hole.
    pub fn join_edit(
        &self,
        measurements: &Measurements,
        (panel, point): (PanelId, PointId),
    ) -> Result<Edit, EditError> {
        let owner = self
            .panel(panel)
            .ok_or_else(|| EditError::Missing(panel.to_string()))?;
        let corner = || EditError::Missing(format!("a corner at {point}"));
        let before = owner.edges().find(|edge| edge.ends[1] == point);
        let after = owner.edges().find(|edge| edge.ends[0] == point);
        let first = self
            .drawn(measurements, panel, before.ok_or_else(corner)?.id)?
            .length();
        let second = self
            .drawn(measurements, panel, after.ok_or_else(corner)?.id)?
            .length();
        let total = first + second;
        let at = if total > 0.0 { first / total } else { 0.5 };
        Ok(Edit::InPanel {
            panel,
            edit: PanelEdit::JoinEdges { point, at },
        })
    }

    /// The curve of an edge as it is drawn for these measurements.
    pub fn drawn(
        &self,
        measurements: &Measurements,
        panel: PanelId,
        edge: EdgeId,
    ) -> Result<Curve, EditError> {
        let k = self.panel_position(panel)?;
        let found = self.panels[k]
            .edge(edge)
            .ok_or_else(|| EditError::Missing(edge.to_string()))?;
        let mut resolver = crate::resolver::Resolver::new(self, measurements);
        resolver
            .curve(k, found.ends, &found.curve)
            .map_err(|_| impossible("the edge cannot be drawn", "mend its formulas first"))
    }
}

/// Whether `next` goes on where `last` stopped, in the same direction.
fn continues(last: &Span, next: &Span) -> bool {
    let values = [&last.from, &last.to, &next.from, &next.to].map(Number::value);
    let [Some(a), Some(b), Some(c), Some(d)] = values else {
        return false;
    };
    (last.panel, last.copy, last.edge, last.reflected)
        == (next.panel, next.copy, next.edge, next.reflected)
        && (b - c).abs() < 1e-12
        && (b > a) == (d > c)
}
