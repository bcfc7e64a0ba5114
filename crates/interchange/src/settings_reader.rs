//! Reads a part of a settings file by its fields: lengths are texts with their unit, angles are in degrees,
//! and unknown fields are refused.

use crate::FormatError;
use crate::native::item::Item;
use crate::native::json::Value as Json;
use toile_geometry::Length;
use toile_measure::Measurements;
use toile_pattern::fields::{
    Fields, Group, ITSELF, List, NumberField, Optional, Value, ValueField, ValueMut, VisitorMut,
};
use toile_pattern::{AnyId, Mark, Number, Want};

/// The error for invalid settings.
pub fn refused(place: impl Into<String>, what: impl Into<String>) -> FormatError {
    FormatError::new(place, what, "see docs/FORMATS.md, marker settings")
}

fn refused_at(item: &Item<'_>, what: String) -> FormatError {
    let place = format!("line {}, column {}", item.node.line, item.node.column);
    refused(place, what)
}

/// The error for a value of the wrong type.
pub fn invalid_type(item: &Item<'_>, expected: &str) -> FormatError {
    let (is_integer, found) = match &item.node.value {
        Json::Null => (false, "null".to_owned()),
        Json::Flag(flag) => (false, format!("boolean `{flag}`")),
        Json::Number(raw) => match (raw.parse::<i128>(), raw.parse::<f64>()) {
            (Ok(_), _) => (true, format!("integer `{raw}`")),
            (Err(_), Ok(number)) => (false, format!("floating point `{number:?}`")),
            (Err(_), Err(_)) => (false, format!("number `{raw}`")),
        },
        Json::Text(text) => (false, format!("string {text:?}")),
        Json::List(_) => (false, "sequence".to_owned()),
        Json::Object(_) => (false, "map".to_owned()),
    };
    let word = match is_integer && expected == "u32" {
        true => "value",
        false => "type",
    };
    refused_at(
        item,
        format!("invalid {word}: {found}, expected {expected}"),
    )
}

/// The error for an unknown field.
pub fn unknown_field(item: &Item<'_>, name: &str, known: &[&str]) -> FormatError {
    let expected = match known {
        [a, b] => format!("`{a}` or `{b}`"),
        [only] => format!("`{only}`"),
        all => {
            let all: Vec<String> = all.iter().map(|name| format!("`{name}`")).collect();
            format!("one of {}", all.join(", "))
        }
    };
    refused_at(item, format!("unknown field `{name}`, expected {expected}"))
}

/// Reads one part of a settings file.
pub struct SettingsReader<'s, 'a> {
    item: Item<'a>,
    /// Name of the expected type, for the error if another type is found.
    expected: &'s str,
    /// Fields of the part that this kind of file does not use, and refuses.
    without: &'s [&'s str],
    /// Fields that another reader reads.
    besides: &'s [&'s str],
    place: Place<'a>,
    fault: Option<FormatError>,
}

/// The place in which the next field is looked up.
enum Place<'a> {
    /// In an object, by keys; holds the keys asked for so far.
    Part(Vec<&'static str>),
    /// In a list, in order; holds the remaining items.
    List(std::vec::IntoIter<Item<'a>>),
}

impl<'s, 'a> SettingsReader<'s, 'a> {
    /// A reader of a part; `expected` is the name of its type for messages, `without` lists the fields of the
    /// part that this kind of file refuses.
    pub fn new(item: &Item<'a>, expected: &'s str, without: &'s [&'s str]) -> Self {
        Self {
            item: item.clone(),
            expected,
            without,
            besides: &[],
            place: Place::Part(Vec::new()),
            fault: None,
        }
    }

    /// Names the fields that another reader reads, so that they do not count as unknown here.
    pub fn with(self, besides: &'s [&'s str]) -> Self {
        Self { besides, ..self }
    }

    /// Reads the part.
    pub fn read(&mut self, part: &mut dyn Fields) -> Result<(), FormatError> {
        part.visit_mut(self);
        self.done()
    }

    /// The first error; an unknown field comes before all others.
    fn done(&mut self) -> Result<(), FormatError> {
        if let Place::Part(known) = &self.place {
            let known: Vec<&str> = known.iter().chain(self.besides).copied().collect();
            let entries = self.item.entries().into_iter().flatten();
            let unknown = entries.into_iter().find(|(name, _)| !known.contains(name));
            if let Some((name, item)) = unknown.filter(|_| !known.contains(&ITSELF)) {
                return Err(unknown_field(&item, name, &known));
            }
        }
        self.fault.take().map_or(Ok(()), Err)
    }

    fn take<T>(&mut self, result: Result<T, FormatError>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(error) => {
                self.fault.get_or_insert(error);
                None
            }
        }
    }

    fn child(&mut self, key: &'static str, may_lack: bool) -> Option<Item<'a>> {
        let known = match &mut self.place {
            Place::List(items) => return items.next(),
            Place::Part(..) if self.without.contains(&key) => return None,
            Place::Part(known) => known,
        };
        if !known.contains(&key) {
            known.push(key);
        }
        if key == ITSELF {
            return Some(self.item.clone());
        }
        let fields = self
            .item
            .fields()
            .map_err(|_| invalid_type(&self.item, self.expected));
        let object = self.take(fields)?;
        match object.get(key) {
            None if !may_lack => {
                let missing = refused_at(&self.item, format!("missing field `{key}`"));
                self.fault.get_or_insert(missing);
                None
            }
            found => found,
        }
    }

    fn within(&mut self, item: &Item<'a>, expected: &str, part: &mut dyn Fields) {
        let read = SettingsReader::new(item, expected, &[]).read(part);
        self.take(read);
    }
}

/// Name of the type of a field's value, for the error if another type is found.
fn struct_name(key: &str) -> &'static str {
    match key {
        "print" => "struct PrintSettings",
        "flaws" => "struct FlawSettings",
        "rolls" => "struct RollSettings",
        _ => "a map",
    }
}

fn set(item: &Item<'_>, field: ValueField, value: ValueMut<'_>) -> Result<(), FormatError> {
    let wrong = |expected: &str| invalid_type(item, expected);
    match value {
        ValueMut::Flag(flag) => *flag = item.flag().map_err(|_| wrong("a boolean"))?,
        ValueMut::Count(_, set) => set(item.count().map_err(|_| wrong("u32"))?),
        ValueMut::Real(real) if field.want == Want::Length => {
            let expected = "a length as text with its unit, as in \"150cm\"";
            let text = item.text().map_err(|_| wrong(expected))?;
            let length: Result<Length, _> = text.parse();
            *real = length
                .map_err(|error| refused_at(item, error.to_string()))?
                .as_metres();
        }
        ValueMut::Real(real) => {
            let number = item.plain_value().map_err(|_| wrong("f64"))?;
            *real = match field.want {
                Want::Angle => number.to_radians(),
                Want::Length | Want::Plain | Want::Any => number,
            };
        }
        ValueMut::Text(text) => item.text().map_err(|_| wrong("a string"))?.clone_into(text),
        ValueMut::Word(words, choose) => {
            let word = item.text().map_err(|_| wrong("a string"))?;
            let found = words.iter().position(|known| *known == word);
            choose(found.ok_or_else(|| {
                let what = match field.key {
                    "nap" => format!("{word:?} is no nap; write none, one-way or per-garment"),
                    _ => {
                        let words: Vec<String> =
                            words.iter().map(|word| format!("`{word}`")).collect();
                        format!(
                            "unknown variant `{word}`, expected one of {}",
                            words.join(", ")
                        )
                    }
                };
                refused_at(item, what)
            })?);
        }
    }
    Ok(())
}

impl VisitorMut for SettingsReader<'_, '_> {
    // Settings files refer to parts by name, not by id.
    fn own(&mut self, _: &mut dyn AnyId) {}

    fn id(&mut self, _: &'static str, _: &mut dyn AnyId) {}

    fn number(&mut self, _: NumberField, _: &mut Number) {}

    fn optional_number(&mut self, _: NumberField, _: &mut Option<Number>) {}

    fn value(&mut self, field: ValueField, value: &mut dyn Value) {
        let Some(item) = self.child(field.key, field.may_lack) else {
            return;
        };
        let mut result = Ok(());
        value.change(&mut |value| result = set(&item, field, value));
        self.take(result);
    }

    fn word(&mut self, _: &'static str) {}

    fn measurements(&mut self, _: &'static str, _: &mut Measurements) {}

    fn optional(&mut self, key: &'static str, field: &mut dyn Optional) {
        let item = self.child(key, true);
        field.set(item.is_some_and(|item| item.node.value != Json::Null));
    }

    fn mark(&mut self, _: Group, _: &mut Mark) {}

    fn part(&mut self, group: Group, part: &mut dyn Fields) {
        if let Some(item) = self.child(group.key, group.may_lack) {
            self.within(&item, struct_name(group.key), part);
        }
    }

    fn flat(&mut self, part: &mut dyn Fields) {
        part.visit_mut(self);
    }

    fn object(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut)) {
        if let Some(item) = self.child(group.key, group.may_lack) {
            let mut inner = SettingsReader::new(&item, struct_name(group.key), &[]);
            walk(&mut inner);
            let done = inner.done();
            self.take(done);
        }
    }

    fn list(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut)) {
        let Some(item) = self.child(group.key, group.may_lack) else {
            return;
        };
        let wanted = toile_pattern::fields::count(walk);
        let expected = format!("an array of length {wanted}");
        let items = item.list().map_err(|_| invalid_type(&item, &expected));
        let items = items.and_then(|items| match items.len() {
            count if count < wanted => Err(refused_at(
                &item,
                format!("invalid length {count}, expected {expected}"),
            )),
            count if count > wanted => Err(refused_at(&item, "trailing characters".to_owned())),
            _ => Ok(items),
        });
        if let Some(items) = self.take(items) {
            let mut inner = SettingsReader {
                place: Place::List(items.into_iter()),
                ..SettingsReader::new(&item, self.expected, &[])
            };
            walk(&mut inner);
            let done = inner.done();
            self.take(done);
        }
    }

    fn each(&mut self, group: Group, parts: &mut dyn List) {
        parts.resize(0);
        let Some(item) = self.child(group.key, true) else {
            return;
        };
        let items = item.list().map_err(|_| invalid_type(&item, "a sequence"));
        if let Some(items) = self.take(items) {
            parts.resize(items.len());
            for (k, item) in items.iter().enumerate() {
                self.within(item, struct_name(group.key), parts.get_mut(k));
            }
        }
    }
}
