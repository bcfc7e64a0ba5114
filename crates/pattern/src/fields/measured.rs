//! Collects numbers and marks of a part.

use super::{Fields, Group, List, NumberField, Optional, Value, ValueField, Visitor};
use crate::{AnyId, Mark, Number};
use toile_measure::Measurements;

/// All numbers of a part and of the parts within it.
pub fn numbers(part: &dyn Fields) -> Vec<&Number> {
    let mut found = Found::default();
    part.visit(&mut found);
    found.numbers
}

/// All marks of a part and of the parts within it: positions on lines.
pub fn marks(part: &dyn Fields) -> Vec<&Mark> {
    let mut found = Found::default();
    part.visit(&mut found);
    found.marks
}

#[derive(Default)]
struct Found<'a> {
    numbers: Vec<&'a Number>,
    marks: Vec<&'a Mark>,
}

impl<'a> Visitor<'a> for Found<'a> {
    fn own(&mut self, _: &'a dyn AnyId) {}

    fn id(&mut self, _: &'static str, _: &'a dyn AnyId) {}

    fn number(&mut self, _: NumberField, number: &'a Number) {
        self.numbers.push(number);
    }

    fn optional_number(&mut self, _: NumberField, number: &'a Option<Number>) {
        self.numbers.extend(number);
    }

    fn value(&mut self, _: ValueField, _: &'a dyn Value) {}

    fn word(&mut self, _: &'static str) {}

    fn measurements(&mut self, _: &'static str, _: &'a Measurements) {}

    fn optional(&mut self, _: &'static str, _: &'a dyn Optional) {}

    fn mark(&mut self, _: Group, mark: &'a Mark) {
        self.marks.push(mark);
        mark.visit(self);
    }

    fn part(&mut self, _: Group, part: &'a dyn Fields) {
        part.visit(self);
    }

    fn flat(&mut self, part: &'a dyn Fields) {
        part.visit(self);
    }

    fn object(&mut self, _: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'a>)) {
        walk(self);
    }

    fn list(&mut self, _: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'a>)) {
        walk(self);
    }

    fn each(&mut self, _: Group, parts: &'a dyn List) {
        (0..parts.count()).for_each(|k| parts.get(k).visit(self));
    }
}
