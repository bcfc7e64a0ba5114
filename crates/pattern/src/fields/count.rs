//! Counts the fields that stand in a list.

use super::{Fields, Group, List, NumberField, Optional, Value, ValueField, VisitorMut};
use crate::{AnyId, Mark, Number};
use toile_measure::Measurements;

/// The number of fields that `walk` visits in a list. The list is visited as mutable but not changed.
pub fn count(walk: &mut dyn FnMut(&mut dyn VisitorMut)) -> usize {
    let mut count = Count(0);
    walk(&mut count);
    count.0
}

/// Visitor that counts the fields of a list.
struct Count(usize);

impl VisitorMut for Count {
    fn own(&mut self, _: &mut dyn AnyId) {
        self.0 += 1;
    }

    fn id(&mut self, _: &'static str, _: &mut dyn AnyId) {
        self.0 += 1;
    }

    fn number(&mut self, _: NumberField, _: &mut Number) {
        self.0 += 1;
    }

    fn optional_number(&mut self, _: NumberField, _: &mut Option<Number>) {
        self.0 += 1;
    }

    fn value(&mut self, _: ValueField, _: &mut dyn Value) {
        self.0 += 1;
    }

    fn word(&mut self, _: &'static str) {
        self.0 += 1;
    }

    fn measurements(&mut self, _: &'static str, _: &mut Measurements) {
        self.0 += 1;
    }

    // A field that may be left out cannot stand in a list.
    fn optional(&mut self, _: &'static str, _: &mut dyn Optional) {}

    fn mark(&mut self, _: Group, _: &mut Mark) {
        self.0 += 1;
    }

    fn part(&mut self, _: Group, _: &mut dyn Fields) {
        self.0 += 1;
    }

    fn flat(&mut self, _: &mut dyn Fields) {
        self.0 += 1;
    }

    fn object(&mut self, _: Group, _: &mut dyn FnMut(&mut dyn VisitorMut)) {
        self.0 += 1;
    }

    fn list(&mut self, _: Group, _: &mut dyn FnMut(&mut dyn VisitorMut)) {
        self.0 += 1;
    }

    fn each(&mut self, _: Group, _: &mut dyn List) {
        self.0 += 1;
    }
}
