//! Kinds of a part, such as the variants of a rule, which a file tells by the fields that are there.

use super::{Fields, Group, List, NumberField, Optional, Value, ValueField, Visitor};
use crate::{AnyId, Mark, Number};
use strum::IntoEnumIterator;
use toile_measure::Measurements;

/// Mark by which a file shows that a part is of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// The file has this field.
    Field(&'static str),
    /// The file has all of these fields. An empty list marks the kind that is assumed if the file shows no
    /// other.
    By(&'static [&'static str]),
    /// The part is a bare number.
    Number,
    /// The part is a bare text.
    Text,
    /// The kind is never written.
    Never,
}

/// A kind of a part.
#[derive(Clone, Debug)]
pub struct Kind {
    /// Mark by which files show this kind.
    pub told: Told,
    /// Keys of the fields of the kind.
    pub keys: Vec<&'static str>,
    /// Index of the enum variant, in the order of declaration.
    variant: usize,
}

/// Messages for a part whose file shows no kind, or two kinds; each is a description of the fault, and
/// advice.
#[derive(Clone, Debug, Default)]
pub struct Clash {
    /// Message if the file shows no kind; `None`: the part then has the usual kind.
    pub none: Option<[String; 2]>,
    /// Message if the file has fields of two kinds.
    pub two: Option<[&'static str; 2]>,
    /// Index of the kind that is assumed if the file shows none; `None`: the last kind.
    pub usual: Option<usize>,
}

impl Kind {
    /// The fields that together show the kind.
    pub fn telling(&self) -> &[&'static str] {
        match &self.told {
            Told::Field(field) => std::slice::from_ref(field),
            Told::By(fields) => fields,
            Told::Number | Told::Text | Told::Never => &[],
        }
    }

    /// A kind that is shown by the field `field` and has the fields `further` too.
    pub fn told_by(field: &'static str, further: &[&'static str]) -> Self {
        Self {
            told: Told::Field(field),
            keys: std::iter::once(field)
                .chain(further.iter().copied())
                .collect(),
            variant: 0,
        }
    }

    /// All kinds of a type, except those that are never written. A kind that no field shows comes last.
    pub fn all<T: Fields + IntoEnumIterator>(told: impl Fn(&T) -> Told) -> Vec<Self> {
        let kinds = T::iter().enumerate().map(|(variant, blank)| Self {
            told: told(&blank),
            keys: keys(&blank),
            variant,
        });
        let kinds = kinds.map(|mut kind| {
            kind.keys.extend(kind.telling().to_vec());
            kind
        });
        let mut kinds: Vec<Self> = kinds.filter(|kind| kind.told != Told::Never).collect();
        kinds.sort_by_key(|kind| kind.told == Told::By(&[]));
        kinds
    }

    /// An empty part of the kind with this index.
    pub fn blank<T: IntoEnumIterator>(kinds: &[Self], kind: usize) -> Option<T> {
        T::iter().nth(kinds.get(kind)?.variant)
    }
}

/// The keys of a part's own fields.
fn keys(part: &dyn Fields) -> Vec<&'static str> {
    let mut keys = Keys(Vec::new());
    part.visit(&mut keys);
    keys.0
}

struct Keys(Vec<&'static str>);

impl<'a> Visitor<'a> for Keys {
    fn own(&mut self, _: &'a dyn AnyId) {
        self.0.push("id");
    }

    fn id(&mut self, key: &'static str, _: &'a dyn AnyId) {
        self.0.push(key);
    }

    fn number(&mut self, field: NumberField, _: &'a Number) {
        self.0.push(field.key);
    }

    fn optional_number(&mut self, field: NumberField, _: &'a Option<Number>) {
        self.0.push(field.key);
    }

    fn value(&mut self, field: ValueField, _: &'a dyn Value) {
        self.0.push(field.key);
    }

    fn word(&mut self, _: &'static str) {}

    fn measurements(&mut self, key: &'static str, _: &'a Measurements) {
        self.0.push(key);
    }

    fn optional(&mut self, key: &'static str, _: &'a dyn Optional) {
        self.0.push(key);
    }

    fn mark(&mut self, group: Group, _: &'a Mark) {
        self.0.push(group.key);
    }

    fn part(&mut self, group: Group, _: &'a dyn Fields) {
        self.0.push(group.key);
    }

    fn flat(&mut self, part: &'a dyn Fields) {
        part.visit(self);
        let kinds = part.kinds().iter();
        self.0.extend(kinds.flat_map(|kind| &kind.keys));
    }

    fn object(&mut self, group: Group, _: &mut dyn FnMut(&mut dyn Visitor<'a>)) {
        self.0.push(group.key);
    }

    fn list(&mut self, group: Group, _: &mut dyn FnMut(&mut dyn Visitor<'a>)) {
        self.0.push(group.key);
    }

    fn each(&mut self, group: Group, _: &'a dyn List) {
        self.0.push(group.key);
    }
}
