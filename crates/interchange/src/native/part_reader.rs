//! Reads any part of the document by its fields.

use super::item::{Item, Object};
use super::json::Value as Json;
use super::reader::Reader;
use crate::FormatError;
use toile_measure::Measurements;
use toile_pattern::fields::{
    Absent, Fields, Group, ITSELF, List, NumberField, Optional, Told, Value, ValueField, ValueMut,
    VisitorMut,
};
use toile_pattern::{AnyId, Mark, Number, Want};

/// Reads a part; an error is stored as the reader's fault.
pub fn read_part<'a>(reader: &mut Reader<'a>, item: Item<'a>, part: &mut dyn Fields) {
    let mut own = PartReader::new(reader, item.clone(), Vec::new());
    own.choose_kind(part);
    part.visit_mut(&mut own);
    own.note_unknown();
    if reader.fault.is_some() {
        return;
    }
    if let Some(fault) = part.fault() {
        let object = item.fields().ok();
        let field = object.and_then(|object| object.get(fault.field));
        let field = field.unwrap_or_else(|| item.clone());
        let listed = fault
            .item
            .and_then(|k| field.list().ok()?.into_iter().nth(k));
        let place = listed.unwrap_or(field);
        reader.fault = Some(place.error(fault.message, fault.hint));
    }
}

/// Reads the whole document, apart from the fields named in `elsewhere`.
pub fn read_root<'a>(
    reader: &mut Reader<'a>,
    item: Item<'a>,
    elsewhere: &[&'static str],
    part: &mut dyn Fields,
) {
    let mut own = PartReader::new(reader, item, elsewhere.to_vec());
    part.visit_mut(&mut own);
    own.note_unknown();
}

/// The place in which the next field is looked up.
enum Place<'a> {
    /// In an object; or in the item itself, if it is not an object.
    Part {
        item: Item<'a>,
        object: Option<Object<'a>>,
        /// The known fields: those asked for, and those of the other kinds of the part.
        known: Vec<&'static str>,
        /// Whether the item is a single value, so that its fields are not fields of a part.
        is_value: bool,
    },
    /// In a list, from which the next item is taken.
    List(std::vec::IntoIter<Item<'a>>),
}

struct PartReader<'r, 'a> {
    reader: &'r mut Reader<'a>,
    place: Place<'a>,
}

impl<'r, 'a> PartReader<'r, 'a> {
    fn new(reader: &'r mut Reader<'a>, item: Item<'a>, known: Vec<&'static str>) -> Self {
        let place = Place::Part {
            item,
            object: None,
            known,
            is_value: false,
        };
        Self { reader, place }
    }

    /// The value of a result; the first error is stored as the reader's fault.
    fn take<T>(&mut self, result: Result<T, FormatError>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(error) => {
                self.reader.fault.get_or_insert(error);
                None
            }
        }
    }

    /// The item of a field; `None` if the field is left out, or after an error.
    fn child(&mut self, key: &'static str, may_lack: bool) -> Option<Item<'a>> {
        if self.reader.fault.is_some() {
            return None;
        }
        let (item, object, known) = match &mut self.place {
            Place::List(items) => return items.next(),
            Place::Part { item, is_value, .. } if key == ITSELF => {
                *is_value = true;
                return Some(item.clone());
            }
            Place::Part {
                item,
                object,
                known,
                ..
            } => (item, object, known),
        };
        known.push(key);
        if object.is_none() {
            match item.fields() {
                Ok(fields) => *object = Some(fields),
                Err(error) => {
                    self.reader.fault = Some(error);
                    return None;
                }
            }
        }
        let object = object.as_ref()?;
        match may_lack {
            true => object.get(key),
            false => {
                let found = object.need(key);
                self.take(found)
            }
        }
    }

    /// Changes the part to the kind that the item has, and adds the fields of all kinds to the known ones.
    fn choose_kind(&mut self, part: &mut dyn Fields) {
        let kinds = part.kinds();
        let Place::Part { item, known, .. } = &mut self.place else {
            return;
        };
        if kinds.is_empty() || self.reader.fault.is_some() {
            return;
        }
        known.extend(kinds.iter().flat_map(|kind| &kind.keys));
        let bare = |told: Told| kinds.iter().position(|kind| kind.told == told);
        let chosen = match &item.node.value {
            Json::Number(_) => Ok(bare(Told::Number)),
            Json::Text(_) => Ok(bare(Told::Text)),
            Json::Object(_) => item
                .fields()
                .and_then(|object| object.kind(kinds, &part.clash())),
            Json::Null | Json::Flag(_) | Json::List(_) => Ok(None),
        };
        if let Some(chosen) = self.take(chosen) {
            let usual = part.clash().usual.unwrap_or(kinds.len() - 1);
            part.become_kind(chosen.unwrap_or(usual));
        }
    }

    /// Notes the unknown fields of the current object.
    fn note_unknown(self) {
        let Place::Part {
            item,
            known,
            is_value,
            ..
        } = self.place
        else {
            return;
        };
        let is_object = matches!(item.node.value, Json::Object(_)) && !is_value;
        if self.reader.fault.is_none() && is_object {
            item.note_unknown(&known, &mut self.reader.notes);
        }
    }

    /// Reads the content of a field; the field's group may replace any error message by its own.
    fn within(&mut self, group: Group, read: impl FnOnce(&mut Reader<'a>, Item<'a>)) {
        let Some(item) = self.child(group.key, group.may_lack) else {
            return;
        };
        read(self.reader, item.clone());
        if let (Some([what, hint]), Some(fault)) = (group.refusal, &mut self.reader.fault) {
            *fault = item.error(what, hint);
        }
    }
}

impl<'a> VisitorMut for PartReader<'_, 'a> {
    fn own(&mut self, id: &mut dyn AnyId) {
        if let Some(item) = self.child("id", false) {
            let own = self.reader.own(&item, id);
            self.take(own);
        }
    }

    fn id(&mut self, key: &'static str, id: &mut dyn AnyId) {
        if let Some(item) = self.child(key, false) {
            let reference = self.reader.reference(&item, id);
            self.take(reference);
        }
    }

    fn number(&mut self, field: NumberField, number: &mut Number) {
        match (
            self.child(field.key, field.absent != Absent::Refused),
            field.absent,
        ) {
            (Some(item), _) => {
                let read = self.reader.number(&item, field.want);
                if let Some(read) = self.take(read) {
                    *number = read;
                }
            }
            (None, Absent::Means(usual) | Absent::LeftOutAt(usual)) => *number = usual.into(),
            (None, Absent::Refused) => {}
        }
    }

    fn optional_number(&mut self, field: NumberField, number: &mut Option<Number>) {
        *number = self.child(field.key, true).and_then(|item| {
            let read = self.reader.number(&item, field.want);
            self.take(read)
        });
    }

    fn value(&mut self, field: ValueField, value: &mut dyn Value) {
        let item = self.child(field.key, field.may_lack);
        let is_sound = self.reader.fault.is_none();
        let reader = &*self.reader;
        let mut result = Ok(());
        value.change(&mut |value| {
            result = match &item {
                Some(item) => set_value(reader, (item, field), value),
                None if is_sound => {
                    set_absent(field, value);
                    Ok(())
                }
                None => Ok(()),
            };
        });
        self.take(result);
    }

    fn word(&mut self, word: &'static str) {
        if let Some(item) = self.child(ITSELF, false) {
            let found = item.word(&[word]);
            self.take(found);
        }
    }

    fn measurements(&mut self, key: &'static str, table: &mut Measurements) {
        if let Some(item) = self.child(key, false) {
            let read = self.reader.measurements(&item);
            if let Some(read) = self.take(read) {
                *table = read;
            }
        }
    }

    fn optional(&mut self, key: &'static str, field: &mut dyn Optional) {
        let is_there = self.child(key, true).is_some();
        field.set(is_there);
    }

    fn mark(&mut self, group: Group, mark: &mut Mark) {
        self.within(group, |reader, item| read_part(reader, item, mark));
    }

    fn part(&mut self, group: Group, part: &mut dyn Fields) {
        self.within(group, |reader, item| read_part(reader, item, part));
    }

    fn flat(&mut self, part: &mut dyn Fields) {
        self.choose_kind(part);
        part.visit_mut(self);
    }

    fn object(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut)) {
        self.within(group, |reader, item| {
            let mut own = PartReader::new(reader, item, Vec::new());
            walk(&mut own);
            own.note_unknown();
        });
    }

    fn list(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut)) {
        self.within(group, |reader, item| {
            match item.exactly(toile_pattern::fields::count(walk)) {
                Ok(items) => walk(&mut PartReader {
                    reader,
                    place: Place::List(items.into_iter()),
                }),
                Err(error) => reader.fault = Some(error),
            }
        });
    }

    fn each(&mut self, group: Group, parts: &mut dyn List) {
        parts.resize(0);
        let group = Group {
            may_lack: true,
            ..group
        };
        self.within(group, |reader, item| match item.list() {
            Ok(items) => {
                parts.resize(items.len());
                for (k, item) in items.into_iter().enumerate() {
                    if reader.fault.is_none() {
                        read_part(reader, item, parts.get_mut(k));
                    }
                }
            }
            Err(error) => reader.fault = Some(error),
        });
    }
}

/// Sets a value from an item.
fn set_value(
    reader: &Reader<'_>,
    (item, field): (&Item<'_>, ValueField),
    value: ValueMut<'_>,
) -> Result<(), FormatError> {
    match value {
        ValueMut::Flag(flag) => *flag = item.flag()?,
        ValueMut::Count(largest, set) => {
            let count = item.count()?;
            if count > largest.min(field.largest) {
                let [what, hint] = field.beyond;
                return Err(item.error(what, hint));
            }
            set(count);
        }
        ValueMut::Real(real) if item.is_null() && field.null.is_some() => {
            *real = field.null.unwrap_or(*real);
        }
        ValueMut::Real(real) => {
            let read = match field.want {
                Want::Length | Want::Angle => reader.value(item, field.want)?,
                Want::Plain | Want::Any => item.plain_value()?,
            };
            if let Some([least, most]) = field.range
                && !(least..=most).contains(&read)
            {
                let hint = format!("give a number from {least} to {most}");
                return Err(item.error(format!("{read} is out of range"), hint));
            }
            *real = read;
        }
        ValueMut::Text(text) => {
            let read = match field.is_name {
                true => item.name()?,
                false => item.text()?,
            };
            read.clone_into(text);
        }
        ValueMut::Word(words, choose) => choose(item.word(words)?),
    }
    Ok(())
}

/// Sets a flag that the file leaves out, if leaving it out means another value than an empty part has.
fn set_absent(field: ValueField, value: ValueMut<'_>) {
    if let (ValueMut::Flag(flag), Some(absent)) = (value, field.absent_flag) {
        *flag = absent;
    }
}
