//! Numbers of parts by the path of their keys.

use super::field::Shown;
use super::{Fields, Group, List, NumberField, Optional, Value, ValueField, Visitor, VisitorMut};
use crate::{AnyId, Mark, Number, PartId, Want};
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use toile_measure::Measurements;

/// Address of a number in the document: keys and list indices starting from its part, as
/// in `spread.cuts[1].from.distance`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct NumberAddress {
    /// The part that the number belongs to.
    pub part: PartId,
    /// Path of keys and list indices.
    pub path: String,
}

impl NumberAddress {
    /// The address of a number of `part` by its path; the number need not exist.
    pub fn new(part: impl Into<PartId>, path: impl Into<String>) -> Self {
        Self {
            part: part.into(),
            path: path.into(),
        }
    }
}

/// A number of a part, with all data that an inspector needs to show it.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberEntry {
    /// Address of the number.
    pub place: NumberAddress,
    /// Label of the number.
    pub label: &'static str,
    /// Quantity that the number must be.
    pub want: Want,
    /// The number. `None`: the field is optional and left out.
    pub number: Option<Number>,
    /// The mark (position on a line) that the number belongs to, if any.
    pub mark: Option<Mark>,
    /// Index of the cut, pleat or span that the number belongs to, from 0.
    pub item: Option<usize>,
}

/// A reference to a number, to change it.
pub enum NumberSlot<'e> {
    /// A number that is always given.
    Always(&'e mut Number),
    /// A number that may be left out.
    Optional(&'e mut Option<Number>),
}

/// The numbers of `part`, which is `whole` or lies within it, in the order in which they are shown. If `part`
/// is `None`, the numbers of all parts within `whole`.
pub fn number_entries(whole: &dyn Fields, part: Option<PartId>) -> Vec<NumberEntry> {
    let mut found = found(whole, part);
    found.sort_by_key(|found| found.shown);
    found.into_iter().map(|found| found.entry).collect()
}

/// Finds a number of a part, which is `whole` or lies within it, and calls `act` to change it; returns
/// whether the number was found.
pub fn with_number(
    whole: &mut dyn Fields,
    place: &NumberAddress,
    act: &mut dyn FnMut(NumberSlot<'_>),
) -> bool {
    let found = found(whole, Some(place.part));
    let Some(wanted) = found.into_iter().find(|found| found.entry.place == *place) else {
        return false;
    };
    whole.visit_mut(&mut Changing {
        wanted: &wanted.path,
        path: Path::default(),
        act,
    });
    true
}

/// The path of keys and indices that leads to the field being visited.
#[derive(Default)]
struct Path(String);

impl Path {
    /// Appends a key and, for a list, an index; returns the path's length before, for `leave`.
    fn enter(&mut self, key: &str, item: Option<usize>) -> usize {
        let before = self.0.len();
        if !key.is_empty() && before > 0 {
            self.0.push('.');
        }
        self.0.push_str(key);
        if let Some(k) = item {
            // Writing to a `String` does not fail.
            let _ = write!(self.0, "[{k}]");
        }
        before
    }

    fn leave(&mut self, before: usize) {
        self.0.truncate(before);
    }
}

/// A number that was found, with its path from the whole that was searched.
struct FoundNumber {
    entry: NumberEntry,
    path: String,
    shown: Shown,
}

fn found(whole: &dyn Fields, part: Option<PartId>) -> Vec<FoundNumber> {
    let mut numbers = Numbers {
        part,
        owner: None,
        start: 0,
        path: Path::default(),
        labels: [None, None],
        mark: None,
        item: None,
        found: Vec::new(),
    };
    whole.visit(&mut numbers);
    numbers.found
}

struct Numbers<'a> {
    /// The part whose numbers are wanted; `None`: all parts.
    part: Option<PartId>,
    /// The part whose fields are being visited.
    owner: Option<PartId>,
    /// Length of the path that leads to this part (bytes).
    start: usize,
    path: Path,
    /// Labels that the group of fields gives: for its number, and for its number if that is a share.
    labels: [Option<&'static str>; 2],
    mark: Option<&'a Mark>,
    item: Option<usize>,
    found: Vec<FoundNumber>,
}

impl<'a> Numbers<'a> {
    fn put(&mut self, field: NumberField, number: Option<&'a Number>) {
        let Some(owner) = self
            .owner
            .filter(|owner| self.part.is_none_or(|part| part == *owner))
        else {
            return;
        };
        let before = self.path.enter(field.key, None);
        let own = self.path.0[self.start..].trim_start_matches('.');
        let share = self.labels[1].filter(|_| field.want == Want::Plain);
        self.found.push(FoundNumber {
            entry: NumberEntry {
                place: NumberAddress::new(owner, own),
                label: self.labels[0].or(share).unwrap_or(field.label),
                want: field.want,
                number: number.cloned(),
                mark: self.mark.cloned(),
                item: self.item,
            },
            path: self.path.0.clone(),
            shown: field.shown,
        });
        self.path.leave(before);
    }

    /// Visits all fields under a key, and restores the state of the visitor afterwards.
    fn within(&mut self, group: Group, item: Option<usize>, visit: impl FnOnce(&mut Self)) {
        let before = self.path.enter(group.key, item);
        let state = (self.owner, self.start, self.labels, self.mark, self.item);
        self.labels = [group.label, group.share_label];
        self.item = item.or(self.item);
        visit(self);
        (self.owner, self.start, self.labels, self.mark, self.item) = state;
        self.path.leave(before);
    }
}

impl<'a> Visitor<'a> for Numbers<'a> {
    fn own(&mut self, id: &'a dyn AnyId) {
        self.owner = Some(id.part());
        self.start = self.path.0.len();
        self.item = None;
    }

    fn id(&mut self, _: &'static str, _: &'a dyn AnyId) {}

    fn number(&mut self, field: NumberField, number: &'a Number) {
        self.put(field, Some(number));
    }

    fn optional_number(&mut self, field: NumberField, number: &'a Option<Number>) {
        self.put(field, number.as_ref());
    }

    fn value(&mut self, _: ValueField, _: &'a dyn Value) {}

    fn word(&mut self, _: &'static str) {}

    fn measurements(&mut self, _: &'static str, _: &'a Measurements) {}

    fn optional(&mut self, _: &'static str, _: &'a dyn Optional) {}

    fn mark(&mut self, group: Group, mark: &'a Mark) {
        self.within(group, None, |own| {
            own.mark = Some(mark);
            mark.visit(own);
        });
    }

    fn part(&mut self, group: Group, part: &'a dyn Fields) {
        self.within(group, None, |own| part.visit(own));
    }

    fn flat(&mut self, part: &'a dyn Fields) {
        part.visit(self);
    }

    fn object(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'a>)) {
        self.within(group, None, |own| walk(own));
    }

    fn list(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'a>)) {
        self.within(group, None, |own| walk(own));
    }

    fn each(&mut self, group: Group, parts: &'a dyn List) {
        for k in 0..parts.count() {
            self.within(group, Some(k), |own| parts.get(k).visit(own));
        }
    }
}

/// Visits only the fields that lead to the wanted number: to visit another part for changing would copy it if
/// it is shared, and it would count as changed.
struct Changing<'w> {
    wanted: &'w str,
    path: Path,
    act: &'w mut dyn FnMut(NumberSlot<'_>),
}

impl Changing<'_> {
    fn is_wanted(&mut self, field: NumberField) -> bool {
        let before = self.path.enter(field.key, None);
        let is_wanted = self.path.0 == self.wanted;
        self.path.leave(before);
        is_wanted
    }

    fn within(&mut self, group: Group, item: Option<usize>, visit: impl FnOnce(&mut Self)) {
        let before = self.path.enter(group.key, item);
        let rest = self.wanted.strip_prefix(self.path.0.as_str());
        if rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '['])) {
            visit(self);
        }
        self.path.leave(before);
    }
}

impl VisitorMut for Changing<'_> {
    fn own(&mut self, _: &mut dyn AnyId) {}

    fn id(&mut self, _: &'static str, _: &mut dyn AnyId) {}

    fn number(&mut self, field: NumberField, number: &mut Number) {
        if self.is_wanted(field) {
            (self.act)(NumberSlot::Always(number));
        }
    }

    fn optional_number(&mut self, field: NumberField, number: &mut Option<Number>) {
        if self.is_wanted(field) {
            (self.act)(NumberSlot::Optional(number));
        }
    }

    fn value(&mut self, _: ValueField, _: &mut dyn Value) {}

    fn word(&mut self, _: &'static str) {}

    fn measurements(&mut self, _: &'static str, _: &mut Measurements) {}

    fn optional(&mut self, _: &'static str, _: &mut dyn Optional) {}

    fn mark(&mut self, group: Group, mark: &mut Mark) {
        self.within(group, None, |own| mark.visit_mut(own));
    }

    fn part(&mut self, group: Group, part: &mut dyn Fields) {
        self.within(group, None, |own| part.visit_mut(own));
    }

    fn flat(&mut self, part: &mut dyn Fields) {
        part.visit_mut(self);
    }

    fn object(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut)) {
        self.within(group, None, |own| walk(own));
    }

    fn list(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut)) {
        self.within(group, None, |own| walk(own));
    }

    fn each(&mut self, group: Group, parts: &mut dyn List) {
        for k in 0..parts.count() {
            self.within(group, Some(k), |own| parts.get_mut(k).visit_mut(own));
        }
    }
}
