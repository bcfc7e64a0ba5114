//! Writes a pattern file: the document's head, measurements, variables, fabrics, seams.

use super::json::{self, Node, Value};
use super::units::{UNITS, write_degrees, write_length, write_plain};
use super::words::{VERSION, word};
use super::write_panel::panel;
use crate::FormatError;
use std::collections::BTreeSet;
use toile_measure::{Measurements, Origin, UnitKind, definition};
use toile_pattern::{
    DisplayUnit, Fabric, IdCounters, Number, Panel, Pattern, Rheology, Seam, Span, is_part_name,
};

/// Writes a pattern in the native format. Reading it back gives the same pattern.
///
/// # Errors
/// The pattern has parts that names cannot tell apart, or a number that is not finite. Documents
/// that were only changed by edits have neither.
pub fn write_pattern(pattern: &Pattern) -> Result<String, FormatError> {
    let mut writer = Writer {
        pattern,
        unit: pattern.unit,
        next: IdCounters::default(),
        highest: IdCounters::default(),
    };
    Ok(json::write(&writer.document()?))
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

    pub fn put_unless_empty(&mut self, name: &str, fields: Self) {
        if !fields.0.is_empty() {
            self.put(name, fields.done());
        }
    }
}

pub fn text(text: &str) -> Value {
    Value::Text(text.to_owned())
}

pub fn list(values: impl IntoIterator<Item = Value>) -> Value {
    Value::List(values.into_iter().map(node).collect())
}

/// What is known while writing.
pub struct Writer<'a> {
    pub pattern: &'a Pattern,
    pub unit: DisplayUnit,
    next: IdCounters,
    highest: IdCounters,
}

macro_rules! id_writers {
    ($($method:ident $field:ident $kind:ident),* $(,)?) => {
        impl Writer<'_> {
            $(
                /// The id, if a reader would not give the same.
                pub fn $method(&mut self, id: toile_pattern::$kind) -> Option<Value> {
                    let expected = self.next.$field == id.0;
                    self.next.$field = id.0.saturating_add(1);
                    self.highest.$field = self.highest.$field.max(self.next.$field);
                    (!expected).then(|| Value::Number(id.0.to_string()))
                }
            )*
        }
    };
}

id_writers! {
    panel_id panel PanelId,
    point_id point PointId,
    edge_id edge EdgeId,
    line_id internal_line InternalLineId,
    dart_id dart DartId,
    notch_id notch NotchId,
    seam_id seam SeamId,
    fabric_id fabric FabricId,
}

/// Refuses names that a file cannot tell apart or does not allow.
pub fn distinct<'n>(place: &str, names: impl Iterator<Item = &'n str>) -> Result<(), FormatError> {
    let mut seen = BTreeSet::new();
    for name in names {
        if !is_part_name(name) || !seen.insert(name) {
            return Err(FormatError::new(
                place,
                format!("the name {name:?} is given twice or is not allowed"),
                "rename the part",
            ));
        }
    }
    Ok(())
}

impl Writer<'_> {
    fn document(&mut self) -> Result<Value, FormatError> {
        let pattern = self.pattern;
        distinct("sizes", pattern.sizes.iter().map(|s| &*s.name))?;
        distinct("variables", pattern.variables.iter().map(|v| &*v.name))?;
        distinct("fabrics", pattern.fabrics.iter().map(|f| &*f.name))?;
        distinct("panels", pattern.panels.iter().map(|p| &*p.name))?;
        let mut head = Fields::default();
        head.put("toile", Value::Number(VERSION.to_string()));
        head.put("kind", text("pattern"));
        head.put("name", text(&pattern.name));
        head.put("unit", text(word(UNITS, &pattern.unit)));
        head.put_if("base_size", pattern.base_size.as_deref().map(text));
        let mut sizes = Fields::default();
        for size in &pattern.sizes {
            sizes.put(&size.name, self.measurements(&size.measurements));
        }
        head.put_unless_empty("sizes", sizes);
        let mut variables = Fields::default();
        for variable in &pattern.variables {
            let place = format!("variables.{}", variable.name);
            variables.put(&variable.name, self.plain(&variable.number, &place)?);
        }
        head.put_unless_empty("variables", variables);
        let mut fabrics = Fields::default();
        for fabric in &pattern.fabrics {
            fabrics.put(&fabric.name, self.fabric(fabric)?);
        }
        head.put_unless_empty("fabrics", fabrics);
        let mut panels = Fields::default();
        for item in &pattern.panels {
            panels.put(&item.name, panel(self, item)?);
        }
        head.put_unless_empty("panels", panels);
        let mut seams = Vec::new();
        for seam in &pattern.seams {
            seams.push(self.seam(seam)?);
        }
        if !seams.is_empty() {
            head.put("seams", list(seams));
        }
        let counters = self.counters();
        head.put_unless_empty("next_ids", counters);
        Ok(head.done())
    }

    fn measurements(&self, table: &Measurements) -> Value {
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

    fn fabric(&mut self, fabric: &Fabric) -> Result<Value, FormatError> {
        let place = format!("fabrics.{}", fabric.name);
        let number = |value: f64| finite(value, &place).map(|()| plain_value(value));
        let numbers = |values: &[f64]| -> Result<Value, FormatError> {
            let values: Result<Vec<_>, _> = values.iter().map(|v| number(*v)).collect();
            Ok(list(values?))
        };
        let mut fields = Fields::default();
        fields.put_if("id", self.fabric_id(fabric.id));
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

    fn seam(&mut self, seam: &Seam) -> Result<Value, FormatError> {
        let place = format!("seam {:?}", seam.name);
        distinct(&place, std::iter::once(&*seam.name))?;
        let mut fields = Fields::default();
        fields.put_if("id", self.seam_id(seam.id));
        fields.put("name", text(&seam.name));
        let mut sides = Vec::new();
        for side in &seam.sides {
            let spans: Result<Vec<_>, _> = side.iter().map(|s| self.span(s, &place)).collect();
            sides.push(list(spans?));
        }
        fields.put("sides", list(sides));
        if seam.ease != Number::ZERO {
            fields.put("ease", self.length(&seam.ease, &place)?);
        }
        if seam.gathered {
            fields.put("gathered", Value::Flag(true));
        }
        if !seam.right_sides_together {
            fields.put("right_sides_together", Value::Flag(false));
        }
        if seam.multi_ply {
            fields.put("multi_ply", Value::Flag(true));
        }
        Ok(fields.done())
    }

    fn span(&self, span: &Span, place: &str) -> Result<Value, FormatError> {
        let panel: Option<&Panel> = self.pattern.panel(span.panel);
        let edge = panel.and_then(|panel| panel.edge(span.edge));
        let mut fields = Fields::default();
        match (panel, edge) {
            (Some(panel), Some(edge)) if !panel.name.contains('.') => {
                let dotted = format!("{}.{}", panel.name, edge.name);
                if *span == Span::whole(span.panel, span.edge) {
                    return Ok(Value::Text(dotted));
                }
                fields.put("edge", Value::Text(dotted));
            }
            (Some(panel), Some(edge)) => {
                fields.put("panel", text(&panel.name));
                fields.put("edge", text(&edge.name));
            }
            _ => {
                fields.put("panel_id", Value::Number(span.panel.0.to_string()));
                fields.put("edge_id", Value::Number(span.edge.0.to_string()));
            }
        }
        if span.copy != 0 {
            fields.put("copy", Value::Number(span.copy.to_string()));
        }
        if span.reflected {
            fields.put("reflected", Value::Flag(true));
        }
        if span.from != Number::Value(0.0) {
            fields.put("from", self.plain(&span.from, place)?);
        }
        if span.to != Number::Value(1.0) {
            fields.put("to", self.plain(&span.to, place)?);
        }
        Ok(fields.done())
    }

    fn counters(&self) -> Fields {
        let (given, read) = (&self.pattern.ids, &self.highest);
        let mut fields = Fields::default();
        for (name, given, read) in [
            ("panel", given.panel, read.panel),
            ("point", given.point, read.point),
            ("edge", given.edge, read.edge),
            ("line", given.internal_line, read.internal_line),
            ("dart", given.dart, read.dart),
            ("notch", given.notch, read.notch),
            ("seam", given.seam, read.seam),
            ("fabric", given.fabric, read.fabric),
        ] {
            if given > read {
                fields.put(name, Value::Number(given.to_string()));
            }
        }
        fields
    }

    pub fn length(&self, number: &Number, place: &str) -> Result<Value, FormatError> {
        self.number(number, place, |value| length_value(value, self.unit))
    }

    pub fn angle(&self, number: &Number, place: &str) -> Result<Value, FormatError> {
        self.number(number, place, angle_value)
    }

    pub fn plain(&self, number: &Number, place: &str) -> Result<Value, FormatError> {
        self.number(number, place, plain_value)
    }

    fn number(
        &self,
        number: &Number,
        place: &str,
        write: impl Fn(f64) -> Value,
    ) -> Result<Value, FormatError> {
        match number {
            Number::Formula(formula) => Ok(text(formula.text())),
            Number::Value(value) => finite(*value, place).map(|()| write(*value)),
        }
    }
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
