//! Computes every number of a pattern on demand, each once, and finds cycles.

use crate::evaluate::{Environment, Failure, Quantity, evaluate, kind};
use crate::formula::Reference;
use crate::suggest::nearest;
use crate::{
    Code, Diagnostic, Edge, EdgeCurve, EdgeId, Number, Panel, Pattern, Place, PointId, PointPlace,
    Severity,
};
use std::collections::{BTreeMap, BTreeSet};
use toile_geometry::{Curve, Vec2};
use toile_measure::Measurements;

/// Longest chain of numbers that need each other: keeps hostile patterns off the end of the stack.
const CHAIN_LIMIT: usize = 150;
/// No length of a garment is as long as this [m].
const LONGEST: f64 = 1000.0;
/// No plain number of a pattern is as large as this.
const LARGEST: f64 = 1e6;

/// What a number must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Want {
    /// A length [m].
    Length,
    /// A plain number or an angle [rad].
    Plain,
}

#[derive(Clone, Copy)]
enum Slot<T> {
    Unknown,
    Busy,
    Done(T),
    Failed,
}

struct PanelIndex<'a> {
    panel: &'a Panel,
    points: BTreeMap<PointId, usize>,
    point_names: BTreeMap<&'a str, usize>,
    edges: BTreeMap<EdgeId, &'a Edge>,
    edge_names: BTreeMap<&'a str, EdgeId>,
    places: Vec<Slot<Vec2>>,
    lengths: BTreeMap<EdgeId, f64>,
}

/// The numbers of one pattern for one table of measurements.
pub(crate) struct Resolver<'a> {
    pattern: &'a Pattern,
    given: &'a Measurements,
    base: Option<&'a Measurements>,
    variable_names: BTreeMap<&'a str, usize>,
    variables: Vec<Slot<Quantity>>,
    panel_names: BTreeMap<&'a str, usize>,
    panels: Vec<PanelIndex<'a>>,
    borrowed: BTreeSet<String>,
    trail: Vec<String>,
    /// Edges whose curve is being computed.
    drawing: BTreeSet<(usize, EdgeId)>,
    /// Everything found on the way.
    pub diagnostics: Vec<Diagnostic>,
}

impl<'a> Resolver<'a> {
    pub fn new(pattern: &'a Pattern, given: &'a Measurements) -> Self {
        let mut resolver = Self {
            pattern,
            given,
            base: pattern.base_measurements(),
            variable_names: BTreeMap::new(),
            variables: vec![Slot::Unknown; pattern.variables.len()],
            panel_names: BTreeMap::new(),
            panels: Vec::with_capacity(pattern.panels.len()),
            borrowed: BTreeSet::new(),
            trail: Vec::new(),
            drawing: BTreeSet::new(),
            diagnostics: Vec::new(),
        };
        for (k, variable) in pattern.variables.iter().enumerate() {
            if resolver.variable_names.insert(&variable.name, k).is_some() {
                resolver.duplicate(
                    Place::Variable(variable.name.clone()),
                    format!("two variables are called {:?}", variable.name),
                );
            }
        }
        for (k, panel) in pattern.panels.iter().enumerate() {
            if resolver.panel_names.insert(&panel.name, k).is_some() {
                resolver.duplicate(
                    Place::Panel(panel.id),
                    format!("two panels are called {:?}", panel.name),
                );
            }
            let index = resolver.index(panel);
            resolver.panels.push(index);
        }
        resolver
    }

    fn duplicate(&mut self, place: Place, message: String) {
        self.diagnostics.push(Diagnostic::error(
            Code::Duplicate,
            place,
            message,
            "rename or renumber one of them",
        ));
    }

    fn index(&mut self, panel: &'a Panel) -> PanelIndex<'a> {
        let mut index = PanelIndex {
            panel,
            points: BTreeMap::new(),
            point_names: BTreeMap::new(),
            edges: BTreeMap::new(),
            edge_names: BTreeMap::new(),
            places: vec![Slot::Unknown; panel.points.len()],
            lengths: BTreeMap::new(),
        };
        for (k, point) in panel.points.iter().enumerate() {
            let twice = index.points.insert(point.id, k).is_some();
            if index.point_names.insert(&point.name, k).is_some() || twice {
                let message = format!("panel {:?}: two points {:?}", panel.name, point.name);
                self.duplicate(Place::Point(panel.id, point.id), message);
            }
        }
        for edge in panel.edges() {
            let twice = index.edges.insert(edge.id, edge).is_some();
            if index.edge_names.insert(&edge.name, edge.id).is_some() || twice {
                let message = format!("panel {:?}: two edges {:?}", panel.name, edge.name);
                self.duplicate(Place::Edge(panel.id, edge.id), message);
            }
        }
        index
    }

    /// The edge of a panel (by index) with that id.
    pub fn edge(&self, panel: usize, edge: EdgeId) -> Option<&'a Edge> {
        self.panels[panel].edges.get(&edge).copied()
    }

    /// The value of a number, in metres if a length is wanted. A fault is reported at `place`;
    /// `what` names the number in words.
    pub fn number(
        &mut self,
        number: &Number,
        want: Want,
        place: &Place,
        what: &str,
    ) -> Option<f64> {
        let result = self.quantity(number, want).and_then(|q| bounded(q, want));
        self.reported(result, place, what)
    }

    fn quantity(&mut self, number: &Number, want: Want) -> Result<Quantity, Failure> {
        match number {
            Number::Value(value) => Ok(Quantity {
                value: *value,
                power: i8::from(want == Want::Length),
            }),
            Number::Formula(formula) => evaluate(formula, self),
        }
    }

    /// Turns a failure into a diagnostic, unless that was done.
    fn reported<T>(&mut self, result: Result<T, Failure>, place: &Place, what: &str) -> Option<T> {
        let (code, message, hint) = match result {
            Ok(value) => return Some(value),
            Err(Failure::Reported) => return None,
            Err(Failure::Fault {
                code,
                column,
                message,
                hint,
            }) => (code, format!("{what}: column {column}: {message}"), hint),
            Err(Failure::Lookup {
                code,
                message,
                hint,
            }) => (code, format!("{what}: {message}"), hint),
        };
        self.diagnostics
            .push(Diagnostic::error(code, place.clone(), message, hint));
        None
    }

    fn enter(&mut self, name: String) -> Result<(), Failure> {
        if self.trail.len() >= CHAIN_LIMIT {
            return Err(lookup(
                Code::TooMany,
                format!("more than {CHAIN_LIMIT} numbers need each other in a chain"),
                "list what is needed before what needs it",
            ));
        }
        self.trail.push(name);
        Ok(())
    }

    fn cycle(&self, name: &str) -> Failure {
        let from = self.trail.iter().position(|n| n == name).unwrap_or(0);
        let mut chain: Vec<&str> = self.trail[from..].iter().map(String::as_str).collect();
        chain.push(name);
        if chain.len() > 12 {
            chain.splice(6..chain.len() - 5, ["..."]);
        }
        lookup(
            Code::Cycle,
            format!("{name} needs itself: {}", chain.join(" -> ")),
            "give one of them a value that does not need the others",
        )
    }

    fn variable(&mut self, k: usize) -> Result<Quantity, Failure> {
        let variable = &self.pattern.variables[k];
        match self.variables[k] {
            Slot::Done(quantity) => return Ok(quantity),
            Slot::Failed => return Err(Failure::Reported),
            Slot::Busy => return Err(self.cycle(&variable.name)),
            Slot::Unknown => {}
        }
        self.enter(variable.name.clone())?;
        self.variables[k] = Slot::Busy;
        let result = self.quantity(&variable.number, Want::Plain);
        self.trail.pop();
        let place = Place::Variable(variable.name.clone());
        let what = format!("variable {:?}", variable.name);
        let value = self.reported(result, &place, &what);
        self.variables[k] = value.map_or(Slot::Failed, Slot::Done);
        value.ok_or(Failure::Reported)
    }

    /// Computes every variable, so that unused ones are checked too.
    pub fn all_variables(&mut self) {
        for k in 0..self.variables.len() {
            let result = self.variable(k).map(|_| ());
            let name = &self.pattern.variables[k].name;
            let place = Place::Variable(name.clone());
            self.reported(result, &place, &format!("variable {name:?}"));
        }
    }

    fn unknown_name(&self, name: &str) -> Failure {
        let known = self
            .variable_names
            .keys()
            .copied()
            .chain(self.given.iter().map(|(name, _)| name))
            .chain(self.base.iter().flat_map(|base| base.iter().map(|m| m.0)));
        let hint = match nearest(name, known) {
            Some(near) => format!("did you mean {near:?}?"),
            None => "define a variable of that name, or measure it in every size".to_owned(),
        };
        let message = format!("there is no variable or measurement {name:?}");
        lookup(Code::MissingReference, message, hint)
    }

    fn panel_index(&self, name: &str) -> Result<usize, Failure> {
        self.panel_names.get(name).copied().ok_or_else(|| {
            let near = nearest(name, self.panel_names.keys().copied());
            lookup(
                Code::MissingReference,
                format!("there is no panel {name:?}"),
                suggestion(near, "name a panel of this pattern"),
            )
        })
    }

    /// Place of a point of a panel (by index) [m]; faults are reported at the point.
    pub fn point_at(&mut self, panel: usize, id: PointId) -> Result<Vec2, Failure> {
        let index = &self.panels[panel];
        let Some(&k) = index.points.get(&id) else {
            return Err(lookup(
                Code::MissingReference,
                format!("panel {:?} has no {id}", index.panel.name),
                "choose a point of this panel",
            ));
        };
        let owner = index.panel;
        let point = &owner.points[k];
        let label = || format!("{}.{}", owner.name, point.name);
        match index.places[k] {
            Slot::Done(place) => return Ok(place),
            Slot::Failed => return Err(Failure::Reported),
            Slot::Busy => return Err(self.cycle(&label())),
            Slot::Unknown => {}
        }
        self.enter(label())?;
        self.panels[panel].places[k] = Slot::Busy;
        let result = self.construct(panel, &point.place);
        self.trail.pop();
        let place = Place::Point(owner.id, point.id);
        let what = format!("panel {:?}, point {:?}", owner.name, point.name);
        let value = self.reported(result, &place, &what);
        self.panels[panel].places[k] = value.map_or(Slot::Failed, Slot::Done);
        value.ok_or(Failure::Reported)
    }

    fn measure(&mut self, number: &Number, want: Want) -> Result<f64, Failure> {
        self.quantity(number, want).and_then(|q| bounded(q, want))
    }

    fn vector(&mut self, x: &Number, y: &Number) -> Result<Vec2, Failure> {
        Ok(Vec2::new(
            self.measure(x, Want::Length)?,
            self.measure(y, Want::Length)?,
        ))
    }

    fn construct(&mut self, panel: usize, place: &PointPlace) -> Result<Vec2, Failure> {
        let point = match place {
            PointPlace::At { x, y } => self.vector(x, y)?,
            PointPlace::Offset { base, x, y } => {
                self.point_at(panel, *base)? + self.vector(x, y)?
            }
            PointPlace::Polar {
                base,
                angle,
                distance,
            } => {
                let angle = self.measure(angle, Want::Plain)?;
                let direction = Vec2::new(angle.cos(), angle.sin());
                self.point_at(panel, *base)? + direction * self.measure(distance, Want::Length)?
            }
            PointPlace::Between {
                base,
                tip,
                along,
                aside,
            } => {
                let start = self.point_at(panel, *base)?;
                let way = self.point_at(panel, *tip)? - start;
                let left = Vec2::new(-way.y, way.x);
                start
                    + way * self.measure(along, Want::Plain)?
                    + left * self.measure(aside, Want::Plain)?
            }
            PointPlace::Toward {
                base,
                tip,
                distance,
            } => {
                let start = self.point_at(panel, *base)?;
                let way = self.point_at(panel, *tip)? - start;
                let unit = way.try_normalize(1e-12).ok_or_else(same_place)?;
                start + unit * self.measure(distance, Want::Length)?
            }
            PointPlace::OnEdge { edge, at } => {
                let at = self.measure(at, Want::Plain)?;
                let curve = self.edge_curve(panel, *edge)?;
                curve.point(curve.parameter_at_length(curve.length() * at))
            }
            PointPlace::Crossing { first, second } => {
                let a = self.point_at(panel, first[0])?;
                let along = self.point_at(panel, first[1])? - a;
                let b = self.point_at(panel, second[0])?;
                let other = self.point_at(panel, second[1])? - b;
                let turn = along.perp(&other);
                if turn.abs() <= 1e-12 * along.norm() * other.norm() {
                    return Err(lookup(
                        Code::Formula,
                        "the two lines are parallel".into(),
                        "choose lines that meet",
                    ));
                }
                a + along * ((b - a).perp(&other) / turn)
            }
            PointPlace::Mirrored { base, line } => {
                let on_line = self.point_at(panel, line[0])?;
                let way = self.point_at(panel, line[1])? - on_line;
                let unit = way.try_normalize(1e-12).ok_or_else(same_place)?;
                let offset = self.point_at(panel, *base)? - on_line;
                on_line + unit * (2.0 * offset.dot(&unit)) - offset
            }
        };
        for coordinate in [point.x, point.y] {
            let power = 1;
            let value = coordinate;
            bounded(Quantity { value, power }, Want::Length)?;
        }
        Ok(point)
    }

    fn edge_curve(&mut self, panel: usize, id: EdgeId) -> Result<Curve, Failure> {
        let Some(edge) = self.edge(panel, id) else {
            return Err(lookup(
                Code::MissingReference,
                format!("panel {:?} has no {id}", self.panels[panel].panel.name),
                "choose an edge of this panel",
            ));
        };
        let name = format!("{}.{}", self.panels[panel].panel.name, edge.name);
        if self.drawing.contains(&(panel, id)) {
            return Err(self.cycle(&name));
        }
        self.enter(name)?;
        self.drawing.insert((panel, id));
        let result = self.curve(panel, edge.ends, &edge.curve);
        self.drawing.remove(&(panel, id));
        self.trail.pop();
        result
    }

    /// The curve between two points [m].
    pub fn curve(
        &mut self,
        panel: usize,
        ends: [PointId; 2],
        curve: &EdgeCurve,
    ) -> Result<Curve, Failure> {
        let start = self.point_at(panel, ends[0])?;
        let end = self.point_at(panel, ends[1])?;
        Ok(match curve {
            EdgeCurve::Line => Curve::Line { start, end },
            EdgeCurve::Arc { bulge } => Curve::Arc {
                start,
                end,
                bulge: self.measure(bulge, Want::Plain)?,
            },
            EdgeCurve::Quadratic { control } => Curve::Quadratic {
                start,
                control: self.point_at(panel, *control)?,
                end,
            },
            EdgeCurve::Cubic { controls } => Curve::Cubic {
                start,
                controls: [
                    self.point_at(panel, controls[0])?,
                    self.point_at(panel, controls[1])?,
                ],
                end,
            },
        })
    }

    /// The curve of an edge or line, its faults reported at `place`.
    pub fn curve_or_report(
        &mut self,
        panel: usize,
        (ends, curve): ([PointId; 2], &EdgeCurve),
        place: &Place,
        what: &str,
    ) -> Option<Curve> {
        let result = self.curve(panel, ends, curve);
        self.reported(result, place, what)
    }

    /// Place of a point, its faults reported at `place`.
    pub fn point_or_report(
        &mut self,
        panel: usize,
        id: PointId,
        place: &Place,
        what: &str,
    ) -> Option<Vec2> {
        let result = self.point_at(panel, id);
        self.reported(result, place, what)
    }

    /// Notes for measurements that were taken from the base size.
    pub fn note_borrowed(&mut self) {
        for name in std::mem::take(&mut self.borrowed) {
            self.diagnostics.push(Diagnostic::new(
                Severity::Note,
                Code::BorrowedMeasurement,
                Place::Pattern,
                format!("measurement {name:?} was not given; the pattern's base size has it"),
                "measure it, if the base size does not fit",
            ));
        }
    }
}

impl Environment for Resolver<'_> {
    fn named(&mut self, name: &str) -> Result<Quantity, Failure> {
        if let Some(&k) = self.variable_names.get(name) {
            return self.variable(k);
        }
        let is_angle = toile_measure::definition(name)
            .is_some_and(|known| known.kind == toile_measure::UnitKind::Angle);
        let power = i8::from(!is_angle);
        if let Some(value) = self.given.get(name) {
            return Ok(Quantity { value, power });
        }
        if let Some(value) = self.base.and_then(|base| base.get(name)) {
            self.borrowed.insert(name.to_owned());
            return Ok(Quantity { value, power });
        }
        Err(self.unknown_name(name))
    }

    fn edge_length(&mut self, reference: &Reference) -> Result<f64, Failure> {
        let panel = self.panel_index(&reference.panel)?;
        let index = &self.panels[panel];
        let Some(&id) = index.edge_names.get(&*reference.part) else {
            let near = nearest(&reference.part, index.edge_names.keys().copied());
            return Err(lookup(
                Code::MissingReference,
                format!(
                    "panel {:?} has no edge {:?}",
                    reference.panel, reference.part
                ),
                suggestion(near, "name an edge of that panel"),
            ));
        };
        if let Some(&length) = index.lengths.get(&id) {
            return Ok(length);
        }
        let length = self.edge_curve(panel, id)?.length();
        self.panels[panel].lengths.insert(id, length);
        Ok(length)
    }

    fn point(&mut self, reference: &Reference) -> Result<Vec2, Failure> {
        let panel = self.panel_index(&reference.panel)?;
        let index = &self.panels[panel];
        match index.point_names.get(&*reference.part) {
            Some(&k) => self.point_at(panel, index.panel.points[k].id),
            None => {
                let near = nearest(&reference.part, index.point_names.keys().copied());
                Err(lookup(
                    Code::MissingReference,
                    format!(
                        "panel {:?} has no point {:?}",
                        reference.panel, reference.part
                    ),
                    suggestion(near, "name a point of that panel"),
                ))
            }
        }
    }
}

fn suggestion(near: Option<&str>, otherwise: &str) -> String {
    near.map_or_else(|| otherwise.to_owned(), |n| format!("did you mean {n:?}?"))
}

fn lookup(code: Code, message: String, hint: impl Into<String>) -> Failure {
    Failure::Lookup {
        code,
        message,
        hint: hint.into(),
    }
}

fn same_place() -> Failure {
    lookup(
        Code::Formula,
        "the two points it is constructed from are in the same place".into(),
        "choose two points that are apart",
    )
}

/// Refuses wrong dimensions and numbers beyond any garment.
fn bounded(quantity: Quantity, want: Want) -> Result<f64, Failure> {
    let Quantity { value, power } = quantity;
    let (wanted, limit, unit) = match want {
        Want::Length => (1, LONGEST, " m"),
        Want::Plain => (0, LARGEST, ""),
    };
    if !value.is_finite() {
        return Err(lookup(
            Code::NotFinite,
            format!("the number is {value}"),
            "give a finite number",
        ));
    }
    if power != wanted && !(value == 0.0 && power == 0) {
        let hint = match want {
            Want::Length => "give a unit, for example 2cm",
            Want::Plain => "divide by a length, or leave the unit out",
        };
        return Err(lookup(
            Code::Formula,
            format!(
                "the result is {} and should be {}",
                kind(power),
                kind(wanted)
            ),
            hint,
        ));
    }
    if value.abs() > limit {
        return Err(lookup(
            Code::TooLarge,
            format!("the result is {value:.3e}{unit}, beyond {limit}{unit}"),
            "look at the values and units it is made from",
        ));
    }
    Ok(value)
}
