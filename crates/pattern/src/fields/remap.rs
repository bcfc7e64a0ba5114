//! Replaces ids in copied parts and in all references among them.

use super::{Fields, Group, List, NumberField, Optional, Value, ValueField, VisitorMut};
use crate::{AnyId, Entity, Mark, Name, Number, PartId, PartReference, SizeId, Token};
use std::collections::HashMap;
use toile_measure::Measurements;

/// A map from old ids to new ones. Ids that are not in the map are not changed.
#[derive(Default)]
pub struct Remap {
    /// New id of each part.
    pub ids: HashMap<PartId, PartId>,
    /// New id of each size. Values that numbers have for a size that is not in this map are dropped.
    pub sizes: HashMap<SizeId, SizeId>,
}

impl Remap {
    /// The new id for an old id.
    pub fn new_id<T: Copy + Into<PartId> + From<u32>>(&self, id: T) -> T {
        let found = self.ids.get(&id.into());
        found.map_or(id, |part| T::from(part.number()))
    }

    fn name<T: Copy + Into<PartId> + From<u32>>(&self, name: Name<T>) -> Name<T> {
        match name {
            Name::Drawn(id) => Name::Drawn(self.new_id(id)),
            Name::Made { by, role, index } => Name::Made {
                by: self.new_id(by),
                role,
                index,
            },
        }
    }

    fn in_number(&self, number: &mut Number) {
        match number {
            Number::Value(_) => {}
            Number::Formula(formula) | Number::Adjusted { formula, .. } => {
                *formula = formula.mapped(&mut |token| self.token(token));
            }
            Number::PerSize { usual, sizes } => {
                self.in_number(usual);
                let own = |(size, value): &(SizeId, f64)| Some((*self.sizes.get(size)?, *value));
                *sizes = sizes.iter().filter_map(own).collect();
            }
        }
    }

    fn token(&self, token: &Token) -> Token {
        match token {
            Token::Text(_) | Token::Word(_) => token.clone(),
            Token::Variable(id) => Token::Variable(self.new_id(*id)),
            Token::Part(part) => Token::Part(match part {
                PartReference::Point(id) => PartReference::Point(self.new_id(*id)),
                PartReference::Curve(id) => PartReference::Curve(self.new_id(*id)),
                PartReference::Seam(id) => PartReference::Seam(self.new_id(*id)),
                PartReference::Stretch { panel, ends } => PartReference::Stretch {
                    panel: self.new_id(*panel),
                    ends: ends.map(|end| self.name(end)),
                },
                PartReference::Unknown(_) => part.clone(),
            }),
        }
    }
}

impl Remap {
    /// The entity with all ids replaced, including its own. Copied fragments contain no sizes and no markers.
    pub fn entity(&mut self, mut entity: Entity) -> Entity {
        if let Some(sheet) = entity.sheet_mut() {
            *sheet = self.new_id(*sheet);
        }
        entity.change(&mut |part| part.visit_mut(self));
        entity
    }
}

impl VisitorMut for Remap {
    fn own(&mut self, id: &mut dyn AnyId) {
        self.id(super::ITSELF, id);
    }

    fn id(&mut self, _: &'static str, id: &mut dyn AnyId) {
        if let Some(new) = self.ids.get(&id.part()) {
            id.set_number(new.number());
        }
    }

    fn number(&mut self, _: NumberField, number: &mut Number) {
        self.in_number(number);
    }

    fn optional_number(&mut self, _: NumberField, number: &mut Option<Number>) {
        number.iter_mut().for_each(|number| self.in_number(number));
    }

    fn value(&mut self, _: ValueField, _: &mut dyn Value) {}

    fn word(&mut self, _: &'static str) {}

    fn measurements(&mut self, _: &'static str, _: &mut Measurements) {}

    fn optional(&mut self, _: &'static str, _: &mut dyn Optional) {}

    fn mark(&mut self, _: Group, mark: &mut Mark) {
        mark.visit_mut(self);
    }

    fn part(&mut self, _: Group, part: &mut dyn Fields) {
        part.visit_mut(self);
    }

    fn flat(&mut self, part: &mut dyn Fields) {
        part.visit_mut(self);
    }

    fn object(&mut self, _: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut)) {
        walk(self);
    }

    fn list(&mut self, _: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut)) {
        walk(self);
    }

    fn each(&mut self, _: Group, parts: &mut dyn List) {
        (0..parts.count()).for_each(|k| parts.get_mut(k).visit_mut(self));
    }
}
