//! Writes any part of the document by its fields.

use super::json::Value as Json;
use super::writer::{Object, Writer, count, finite, list, plain_value, text};
use crate::FormatError;
use toile_measure::Measurements;
use toile_pattern::fields::{
    Absent, Fields, Group, ITSELF, List, NumberField, Optional, Value, ValueField, ValueRef,
    Visitor,
};
use toile_pattern::{AnyId, Mark, Number, Want, is_part_name};

/// Writes a part.
pub fn write_part(writer: &Writer, part: &dyn Fields) -> Result<Json, FormatError> {
    let mut own = PartWriter {
        writer,
        form: Form::Object(Object::default()),
        part: String::new(),
        fault: None,
    };
    part.visit(&mut own);
    own.done()
}

/// The form in which a part is written.
enum Form {
    Object(Object),
    List(Vec<Json>),
    /// A bare value, not an object with fields.
    Itself(Json),
}

struct PartWriter<'w> {
    writer: &'w Writer,
    form: Form,
    /// Name of the part, for messages.
    part: String,
    fault: Option<FormatError>,
}

impl PartWriter<'_> {
    fn done(self) -> Result<Json, FormatError> {
        match (self.fault, self.form) {
            (Some(fault), _) => Err(fault),
            (None, Form::Object(fields)) => Ok(fields.done()),
            (None, Form::List(values)) => Ok(list(values)),
            (None, Form::Itself(value)) => Ok(value),
        }
    }

    fn put(&mut self, key: &str, value: Json) {
        match &mut self.form {
            Form::List(values) => values.push(value),
            form if key == ITSELF => *form = Form::Itself(value),
            Form::Object(fields) => fields.put(key, value),
            Form::Itself(_) => {}
        }
    }

    fn put_result(&mut self, key: &str, value: Result<Json, FormatError>) {
        match value {
            Ok(value) => self.put(key, value),
            Err(fault) => {
                self.fault.get_or_insert(fault);
            }
        }
    }

    /// A writer for a value inside this part.
    fn inner(&self, form: Form) -> Self {
        Self {
            writer: self.writer,
            form,
            part: self.part.clone(),
            fault: None,
        }
    }

    fn put_walked<'v>(
        &mut self,
        (group, form): (Group, Form),
        walk: &mut dyn FnMut(&mut dyn Visitor<'v>),
    ) where
        Self: Visitor<'v>,
    {
        if !group.is_left_out {
            let mut inner = self.inner(form);
            walk(&mut inner);
            self.put_result(group.key, inner.done());
        }
    }

    fn put_part(&mut self, group: Group, part: &dyn Fields) {
        if !group.is_left_out {
            let mut inner = self.inner(Form::Object(Object::default()));
            part.visit(&mut inner);
            self.put_result(group.key, inner.done());
        }
    }
}

impl<'v> Visitor<'v> for PartWriter<'_> {
    fn own(&mut self, id: &'v dyn AnyId) {
        let part = id.part();
        self.part = part.to_string();
        self.put("id", count(part.number()));
    }

    fn id(&mut self, key: &'static str, id: &'v dyn AnyId) {
        self.put(key, count(id.part().number()));
    }

    fn number(&mut self, field: NumberField, number: &'v Number) {
        let is_usual = |usual: f64| *number == Number::Value(usual);
        if !matches!(field.absent, Absent::LeftOutAt(usual) if is_usual(usual)) {
            let value = self.writer.number(number, field.want, &self.part);
            self.put_result(field.key, value);
        }
    }

    fn optional_number(&mut self, field: NumberField, number: &'v Option<Number>) {
        if let Some(number) = number {
            self.number(field, number);
        }
    }

    fn value(&mut self, field: ValueField, value: &'v dyn Value) {
        if field.is_left_out {
            return;
        }
        let value = match value.get() {
            ValueRef::Flag(flag) => Ok(Json::Flag(flag)),
            ValueRef::Count(number) => Ok(count(number)),
            ValueRef::Real(real) if field.null == Some(real) => Ok(Json::Null),
            ValueRef::Real(real) => match field.want {
                Want::Length | Want::Angle => {
                    self.writer
                        .number(&Number::Value(real), field.want, &self.part)
                }
                Want::Plain | Want::Any => finite(real, &self.part).map(|()| plain_value(real)),
            },
            ValueRef::Text(name) if field.is_name && !is_part_name(name) => Err(FormatError::new(
                self.part.clone(),
                format!("{name:?} cannot be a name"),
                "rename the part",
            )),
            ValueRef::Text(own) => {
                if field.is_name {
                    let kind = self.part.split(' ').next().unwrap_or_default();
                    self.part = format!("{kind} {own:?}");
                }
                Ok(text(own))
            }
            ValueRef::Word(word) => Ok(text(word)),
        };
        self.put_result(field.key, value);
    }

    fn word(&mut self, word: &'static str) {
        self.put(ITSELF, text(word));
    }

    fn measurements(&mut self, key: &'static str, table: &'v Measurements) {
        let table = self.writer.measurements(table);
        self.put(key, table);
    }

    fn optional(&mut self, _: &'static str, _: &'v dyn Optional) {}

    fn mark(&mut self, group: Group, mark: &'v Mark) {
        self.put_part(group, mark);
    }

    fn part(&mut self, group: Group, part: &'v dyn Fields) {
        self.put_part(group, part);
    }

    fn flat(&mut self, part: &'v dyn Fields) {
        part.visit(self);
    }

    fn object(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'v>)) {
        self.put_walked((group, Form::Object(Object::default())), walk);
    }

    fn list(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'v>)) {
        self.put_walked((group, Form::List(Vec::new())), walk);
    }

    fn each(&mut self, group: Group, parts: &'v dyn List) {
        let is_item = matches!(self.form, Form::List(_));
        if parts.count() == 0 && !is_item && !group.even_empty {
            return;
        }
        let mut inner = self.inner(Form::List(Vec::with_capacity(parts.count())));
        (0..parts.count())
            .for_each(|k| inner.put_part(toile_pattern::fields::group(ITSELF), parts.get(k)));
        self.put_result(group.key, inner.done());
    }
}
