//! Writes a pattern file: head, sizes, variables, fabrics, sheets; numbers.

use super::json::{self, Node, Value};
use super::units::{UNITS, write_degrees, write_length, write_plain};
use super::words::{VERSION, word};
use super::write_marker::marker;
use super::write_panel::panel;
use super::write_seam::{mark, name, seam};
use crate::FormatError;
use toile_measure::{Measurements, Origin, UnitKind, definition};
use toile_pattern::{
    Curve, CurveRule, DisplayUnit, Fabric, Guide, GuideRun, Names, Number, Pattern, Point,
    PointRule, Rheology, Sheet, is_part_name,
};

/// Writes a pattern, and what `fitting` gives of how its garment is tried on.
pub fn write(
    pattern: &Pattern,
    fitting: impl FnOnce(&Writer<'_>) -> Result<Option<Value>, FormatError>,
) -> Result<String, FormatError> {
    let writer = Writer {
        pattern,
        unit: pattern.unit,
        names: Names::new(pattern),
    };
    Ok(json::write(&writer.document(fitting(&writer)?)?))
}

/// Fields of an object in the making.
#[derive(Default)]
pub struct Fields(Vec<(String, Node)>);

/// A value without a place.
pub fn node(value: Value) -> Node {
    Node {
        value,
        line: 0,
        column: 0,
    }
}

impl Fields {
    pub fn put(&mut self, name: &str, value: Value) {
        self.0.push((name.to_owned(), node(value)));
    }

    pub fn put_if(&mut self, name: &str, value: Option<Value>) {
        if let Some(value) = value {
            self.put(name, value);
        }
    }

    pub fn done(self) -> Value {
        Value::Object(self.0)
    }

    /// A list, unless it is empty.
    pub fn put_list(&mut self, name: &str, values: Vec<Value>) {
        if !values.is_empty() {
            self.put(name, list(values));
        }
    }
}

pub fn text(text: &str) -> Value {
    Value::Text(text.to_owned())
}

pub fn list(values: impl IntoIterator<Item = Value>) -> Value {
    Value::List(values.into_iter().map(node).collect())
}

/// A whole number.
pub fn count(number: u32) -> Value {
    Value::Number(number.to_string())
}

/// Ids as a list.
pub fn counts(numbers: impl IntoIterator<Item = u32>) -> Value {
    list(numbers.into_iter().map(count))
}

/// The quantity that a number measures.
#[derive(Clone, Copy)]
pub enum Measure {
    Length,
    Angle,
    Plain,
}

/// State of the writer.
pub struct Writer<'a> {
    pub pattern: &'a Pattern,
    unit: DisplayUnit,
    names: Names,
}

impl Writer<'_> {
    fn document(&self, tried_on: Option<Value>) -> Result<Value, FormatError> {
        let pattern = self.pattern;
        let mut head = Fields::default();
        head.put("toile", count(VERSION));
        head.put("kind", text("pattern"));
        head.put("name", text(&pattern.name));
        head.put("unit", text(word(UNITS, &pattern.unit)));
        head.put_if("base_size", pattern.base_size.map(|id| count(id.0)));
        let mut sizes = Vec::new();
        for size in &pattern.sizes {
            let mut fields = named(size.id.0, &size.name)?;
            fields.put("measurements", self.measurements(&size.measurements));
            sizes.push(fields.done());
        }
        head.put_list("sizes", sizes);
        let mut variables = Vec::new();
        for variable in &pattern.variables {
            let mut fields = named(variable.id.0, &variable.name)?;
            let place = format!("variable {:?}", variable.name);
            fields.put(
                "value",
                self.number(&variable.number, Measure::Plain, &place)?,
            );
            variables.push(fields.done());
        }
        head.put_list("variables", variables);
        let fabrics: Result<Vec<_>, _> = pattern.fabrics.iter().map(|f| self.fabric(f)).collect();
        head.put_list("fabrics", fabrics?);
        let sheets: Result<Vec<_>, _> = pattern.sheets.iter().map(|s| self.sheet(s)).collect();
        head.put_list("sheets", sheets?);
        let panels: Result<Vec<_>, _> = pattern.panels.iter().map(|p| panel(self, p)).collect();
        head.put_list("panels", panels?);
        let seams: Result<Vec<_>, _> = pattern.seams.iter().map(|s| seam(self, s)).collect();
        head.put_list("seams", seams?);
        let markers: Result<Vec<_>, _> = pattern.markers.iter().map(|m| marker(self, m)).collect();
        head.put_list("markers", markers?);
        let guides: Result<Vec<_>, _> = pattern.guides.iter().map(|g| self.guide(g)).collect();
        head.put_list("guides", guides?);
        head.put_if("fitting", tried_on);
        head.put("next_id", count(pattern.ids.next));
        Ok(head.done())
    }

    /// A table of measurements.
    pub fn measurements(&self, table: &Measurements) -> Value {
        let mut fields = Fields::default();
        for (name, measured) in table.iter() {
            let is_angle = definition(name).is_some_and(|known| known.kind == UnitKind::Angle);
            let number = if is_angle {
                angle_value(measured.value)
            } else {
                length_value(measured.value, self.unit)
            };
            if measured.origin == Origin::Predicted {
                let mut predicted = Fields::default();
                predicted.put("predicted", number);
                fields.put(name, predicted.done());
            } else {
                fields.put(name, number);
            }
        }
        fields.done()
    }

    fn fabric(&self, fabric: &Fabric) -> Result<Value, FormatError> {
        let place = format!("fabrics.{}", fabric.name);
        let number = |value: f64| finite(value, &place).map(|()| plain_value(value));
        let numbers = |values: &[f64]| -> Result<Value, FormatError> {
            let values: Result<Vec<_>, _> = values.iter().map(|v| number(*v)).collect();
            Ok(list(values?))
        };
        let mut fields = Fields::default();
        fields.put("id", count(fabric.id.0));
        fields.put("name", text(&fabric.name));
        fields.put("density_kg_per_m2", number(fabric.density)?);
        fields.put("thickness_m", number(fabric.thickness)?);
        fields.put("stretch_N_per_m", numbers(&fabric.stretch)?);
        fields.put("shear_N_per_m", number(fabric.shear)?);
        fields.put("poisson", number(fabric.poisson)?);
        fields.put("bend_N_m", numbers(&fabric.bend)?);
        fields.put("friction", number(fabric.friction)?);
        fields.put("width_m", number(fabric.width)?);
        fields.put("nap", Value::Flag(fabric.nap));
        fields.put("colour", numbers(&fabric.colour)?);
        let (own, usual) = (&fabric.rheology, Rheology::default());
        if own.hardening != usual.hardening {
            fields.put("hardening", numbers(&own.hardening)?);
        }
        if own.viscosity != usual.viscosity {
            fields.put("viscosity_N_s_per_m", number(own.viscosity)?);
        }
        if own.bend_viscosity != usual.bend_viscosity {
            fields.put("bend_viscosity_N_m_s", number(own.bend_viscosity)?);
        }
        if own.kept != usual.kept {
            fields.put("kept", numbers(&own.kept)?);
        }
        if own.relaxation_time != usual.relaxation_time {
            fields.put("relaxation_time_s", number(own.relaxation_time)?);
        }
        Ok(fields.done())
    }

    fn guide(&self, guide: &Guide) -> Result<Value, FormatError> {
        finite(guide.at, &guide.id.to_string())?;
        let mut fields = Fields::default();
        fields.put("id", count(guide.id.0));
        let name = match guide.runs {
            GuideRun::Horizontal => "y",
            GuideRun::Vertical => "x",
        };
        fields.put(name, length_value(guide.at, self.unit));
        Ok(fields.done())
    }

    fn sheet(&self, sheet: &Sheet) -> Result<Value, FormatError> {
        let mut fields = named(sheet.id.0, &sheet.name)?;
        if let Some((panel, after)) = sheet.on {
            let mut on = Fields::default();
            on.put("panel", count(panel.0));
            on.put_if("after", after.map(|id| count(id.0)));
            fields.put("on", on.done());
        }
        if sheet.on_table != [0.0; 2] {
            fields.put("table", self.place(sheet.on_table, &sheet.name)?);
        }
        let points: Result<Vec<_>, _> = sheet.points.iter().map(|p| self.point(p)).collect();
        fields.put_list("points", points?);
        let curves: Result<Vec<_>, _> = sheet.curves.iter().map(|c| self.curve(c)).collect();
        fields.put_list("curves", curves?);
        Ok(fields.done())
    }

    /// Two lengths [m].
    pub fn place(&self, place: [f64; 2], what: &str) -> Result<Value, FormatError> {
        for value in place {
            finite(value, what)?;
        }
        Ok(list(place.map(|value| length_value(value, self.unit))))
    }

    fn point(&self, point: &Point) -> Result<Value, FormatError> {
        let mut fields = named(point.id.0, &point.name)?;
        let what = format!("point {:?}", point.name);
        let length = |number: &Number| self.number(number, Measure::Length, &what);
        let plain = |number: &Number| self.number(number, Measure::Plain, &what);
        match &point.rule {
            PointRule::At { x, y } => fields.put("at", list([length(x)?, length(y)?])),
            PointRule::Offset { base, x, y } => {
                fields.put("from", count(base.0));
                fields.put("offset", list([length(x)?, length(y)?]));
            }
            PointRule::Polar {
                base,
                angle,
                distance,
            } => {
                fields.put("from", count(base.0));
                fields.put("angle", self.number(angle, Measure::Angle, &what)?);
                fields.put("distance", length(distance)?);
            }
            PointRule::Between {
                base,
                tip,
                along,
                aside,
            } => {
                fields.put("from", count(base.0));
                fields.put("to", count(tip.0));
                fields.put("along", plain(along)?);
                if *aside != Number::ZERO {
                    fields.put("aside", plain(aside)?);
                }
            }
            PointRule::Toward {
                base,
                tip,
                distance,
            } => {
                fields.put("from", count(base.0));
                fields.put("toward", count(tip.0));
                fields.put("distance", length(distance)?);
            }
            PointRule::OnCurve { curve, share } => {
                fields.put("curve", count(curve.0));
                fields.put("share", plain(share)?);
            }
            PointRule::AlongCurve { curve, distance } => {
                fields.put("curve", count(curve.0));
                fields.put("distance", length(distance)?);
            }
            PointRule::Crossing { first, second } => {
                let lines = [first, second].map(|line| counts(line.map(|id| id.0)));
                fields.put("crossing", list(lines));
            }
            PointRule::CurveCrossing { curves, index } => {
                fields.put("curves", counts(curves.map(|id| id.0)));
                fields.put("index", count(u32::from(*index)));
            }
            PointRule::LineCrossing { line, curve, index } => {
                fields.put("line", counts(line.map(|id| id.0)));
                fields.put("curve", count(curve.0));
                fields.put("index", count(u32::from(*index)));
            }
            PointRule::Foot { base, line } => {
                fields.put("foot", count(base.0));
                fields.put("in", counts(line.map(|id| id.0)));
            }
            PointRule::Mark { line, at } => {
                fields.put("line", name(*line));
                fields.put("mark", mark(self, at, &what)?);
            }
            PointRule::Mirrored { base, line } => {
                fields.put("mirror", count(base.0));
                fields.put("in", counts(line.map(|id| id.0)));
            }
        }
        Ok(fields.done())
    }

    fn curve(&self, curve: &Curve) -> Result<Value, FormatError> {
        let mut fields = named(curve.id.0, &curve.name)?;
        let what = format!("curve {:?}", curve.name);
        fields.put("from", count(curve.ends[0].0));
        fields.put("to", count(curve.ends[1].0));
        match &curve.rule {
            CurveRule::Line => {}
            CurveRule::Arc { bulge } => {
                fields.put("bulge", self.number(bulge, Measure::Plain, &what)?);
            }
            CurveRule::Spline {
                handles,
                knots,
                to_length,
            } => {
                fields.put("handles", counts(handles.map(|id| id.0)));
                let knots = knots.iter();
                let knots = knots.map(|k| counts([k.before.0, k.point.0, k.after.0]));
                fields.put_list("knots", knots.collect());
                if let Some(length) = to_length {
                    fields.put("to_length", self.number(length, Measure::Length, &what)?);
                }
            }
            CurveRule::Mirrored { of, line } => {
                fields.put("mirror", count(of.0));
                fields.put("in", counts(line.map(|id| id.0)));
            }
            CurveRule::Copy { of } => fields.put("copy", count(of.0)),
        }
        Ok(fields.done())
    }

    /// A number: a value, a formula, an adjusted formula, a value a size.
    pub fn number(
        &self,
        number: &Number,
        measure: Measure,
        place: &str,
    ) -> Result<Value, FormatError> {
        let value = |value: f64| -> Result<Value, FormatError> {
            finite(value, place)?;
            Ok(match measure {
                Measure::Length => length_value(value, self.unit),
                Measure::Angle => angle_value(value),
                Measure::Plain => plain_value(value),
            })
        };
        Ok(match number {
            Number::Value(own) => value(*own)?,
            Number::Formula(formula) => text(&formula.text(&self.names)),
            Number::Adjusted { formula, by } => {
                let mut fields = Fields::default();
                fields.put("formula", text(&formula.text(&self.names)));
                fields.put("by", value(*by)?);
                fields.done()
            }
            Number::PerSize { usual, sizes } => {
                let mut fields = Fields::default();
                fields.put("usual", self.number(usual, measure, place)?);
                let mut pairs = Vec::new();
                for (size, own) in sizes {
                    pairs.push(list([count(size.0), value(*own)?]));
                }
                fields.put("sizes", list(pairs));
                fields.done()
            }
        })
    }
}

/// The fields of a part, its id and name first.
pub fn named(id: u32, name: &str) -> Result<Fields, FormatError> {
    if !is_part_name(name) {
        return Err(FormatError::new(
            format!("part {id}"),
            format!("{name:?} cannot be a name"),
            "rename the part",
        ));
    }
    let mut fields = Fields::default();
    fields.put("id", count(id));
    fields.put("name", text(name));
    Ok(fields)
}

fn finite(value: f64, place: &str) -> Result<(), FormatError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(FormatError::new(
        place,
        format!("the number {value} cannot be written"),
        "give it a finite value",
    ))
}

pub fn plain_value(value: f64) -> Value {
    Value::Number(write_plain(value))
}

/// In the file's unit if that is exact, else in metres.
fn length_value(value: f64, unit: DisplayUnit) -> Value {
    match write_length(value, unit) {
        Some(raw) => Value::Number(raw),
        None => exactly("m", value),
    }
}

/// In degrees if that is exact, else in radians.
fn angle_value(value: f64) -> Value {
    match write_degrees(value) {
        Some(raw) => Value::Number(raw),
        None => exactly("rad", value),
    }
}

fn exactly(unit: &str, value: f64) -> Value {
    let mut fields = Fields::default();
    fields.put(unit, plain_value(value));
    fields.done()
}
