//! Kinds of a part that a file tells by the fields it has.

use super::{Fields, Group, List, NumberField, Optional, Value, ValueField, Visitor};
use crate::{AnyId, Mark, Number};
use strum::IntoEnumIterator;
use toile_measure::Measurements;

/// How a file tells that a part is of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// By this field.
    Field(&'static str),
    /// By these fields together; by none where it is all that is left.
    By(&'static [&'static str]),
    /// It is a bare number.
    Number,
    /// It is a bare text.
    Text,
    /// It is not written at all.
    Never,
}

/// A kind of a part.
#[derive(Clone, Debug)]
pub struct Kind {
    /// How it is told.
    pub told: Told,
    /// Its fields.
    pub keys: Vec<&'static str>,
    /// Its place among the variants as they are declared.
    variant: usize,
}

/// What is said of a part whose file tells no kind, or two: what is wrong, what to do.
#[derive(Clone, Debug, Default)]
pub struct Clash {
    /// Where no kind is told; without it the part is of the usual kind.
    pub none: Option<[String; 2]>,
    /// Where a field stands beside those of another kind.
    pub two: Option<[&'static str; 2]>,
    /// Which of the kinds is meant where none is told; without it the last.
    pub usual: Option<usize>,
}

impl Kind {
    /// The fields that tell it together.
    pub fn telling(&self) -> &[&'static str] {
        match &self.told {
            Told::Field(field) => std::slice::from_ref(field),
            Told::By(fields) => fields,
            Told::Number | Told::Text | Told::Never => &[],
        }
    }

    /// A kind that is told by a field and has further ones.
    pub fn told_by(field: &'static str, further: &[&'static str]) -> Self {
        Self {
            told: Told::Field(field),
            keys: std::iter::once(field)
                .chain(further.iter().copied())
                .collect(),
            variant: 0,
        }
    }

    /// All kinds of a type, those last that nothing tells; kinds that are not written are left out.
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

    /// An empty part of a kind.
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
