//! References: the parts that a part refers to.

use super::{Fields, Group, List, NumberField, Optional, Value, ValueField, Visitor};
use crate::{AnyId, CurveId, Mark, Number, PartId, PointId};
use toile_measure::Measurements;

/// All parts that a part refers to, by id or in a formula, in the order of its fields.
pub fn references(part: &dyn Fields) -> Vec<PartId> {
    let mut found = References(Vec::new());
    part.visit(&mut found);
    found.0
}

/// The points that a part is drawn from: those named by its own fields, not those in formulas or marks.
pub fn points(part: &dyn Fields) -> Vec<PointId> {
    let sources = sources(part).into_iter();
    let points = sources.filter_map(|part| part.try_into().ok());
    points.collect()
}

/// The curves that a part is drawn from: those named by its own fields, not those in formulas or marks.
pub fn curves(part: &dyn Fields) -> Vec<CurveId> {
    let sources = sources(part).into_iter();
    let curves = sources.filter_map(|part| part.try_into().ok());
    curves.collect()
}

fn sources(part: &dyn Fields) -> Vec<PartId> {
    let mut found = Sources(Vec::new());
    part.visit(&mut found);
    found.0
}

struct References(Vec<PartId>);

impl<'a> Visitor<'a> for References {
    fn own(&mut self, _: &'a dyn AnyId) {}

    fn id(&mut self, _: &'static str, id: &'a dyn AnyId) {
        self.0.push(id.part());
    }

    fn number(&mut self, _: NumberField, number: &'a Number) {
        if let Number::PerSize { sizes, .. } = number {
            let sizes = sizes.iter().map(|(size, _)| PartId::from(*size));
            self.0.extend(sizes);
        }
        let formula = number.as_formula().into_iter();
        self.0
            .extend(formula.flat_map(|formula| formula.references()));
    }

    fn optional_number(&mut self, field: NumberField, number: &'a Option<Number>) {
        if let Some(number) = number {
            self.number(field, number);
        }
    }

    fn value(&mut self, _: ValueField, _: &'a dyn Value) {}

    fn word(&mut self, _: &'static str) {}

    fn measurements(&mut self, _: &'static str, _: &'a Measurements) {}

    fn optional(&mut self, _: &'static str, _: &'a dyn Optional) {}

    fn mark(&mut self, _: Group, mark: &'a Mark) {
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

struct Sources(Vec<PartId>);

impl<'a> Visitor<'a> for Sources {
    fn own(&mut self, _: &'a dyn AnyId) {}

    fn id(&mut self, _: &'static str, id: &'a dyn AnyId) {
        self.0.push(id.part());
    }

    fn number(&mut self, _: NumberField, _: &'a Number) {}

    fn optional_number(&mut self, _: NumberField, _: &'a Option<Number>) {}

    fn value(&mut self, _: ValueField, _: &'a dyn Value) {}

    fn word(&mut self, _: &'static str) {}

    fn measurements(&mut self, _: &'static str, _: &'a Measurements) {}

    fn optional(&mut self, _: &'static str, _: &'a dyn Optional) {}

    fn mark(&mut self, _: Group, _: &'a Mark) {}

    fn part(&mut self, _: Group, _: &'a dyn Fields) {}

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
