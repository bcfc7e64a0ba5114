//! The fields of every part of the document, each described once: [`fields!`](crate::fields!) lists
//! the fields of a type in the order of the file, and all code that walks over fields is a [`Visitor`]
//! or a [`VisitorMut`].
//!
//! Derived from this list alone: references ([`references()`]), new ids in copies ([`Remap`]), numbers with
//! their labels for inspectors ([`numbers_of`](crate::plan::numbers_of)), marks ([`marks`]), and in the crate
//! `interchange` the reader and the writer of files with their known fields.
//!
//! # Decided with
//! - [`crate::fields::field::ValueField`], [`crate::fields::field::NumberField`]: key, label, bounds and
//!   default of a field;
//! - [`crate::fields::kind::Kind`], [`crate::fields::choice::Choice`]: kinds told by their fields; words of a
//!   closed list;
//! - [`crate::fields::number_at::NumberAddress`]: numbers by the path of their keys;
//! - [`crate::edit`] (`references.rs`): parts that a part refers to, in edits;
//! - [`crate::plan::set_number`]: numbers read and set;
//! - [`crate::plan::paste`]: copies with new ids.
//!
//! The reader and the writer of files follow these lists. Random patterns for tests are made in
//! `interchange/tests/suite/random_pattern`.

mod choice;
mod count;
mod field;
mod kind;
mod measured;
mod names;
mod number_at;
mod references;
mod remap;

pub use choice::Choice;
pub use count::count;
pub use field::{
    Absent, Group, NumberField, Value, ValueField, ValueMut, ValueRef, angle, any, group, key,
    length, plain,
};
pub use kind::{Clash, Kind, Told};
pub use measured::{marks, numbers};
pub use number_at::{NumberAddress, NumberEntry};
pub(crate) use number_at::{NumberSlot, number_entries, with_number};
pub(crate) use references::{curves, points, references};
pub(crate) use remap::Remap;

use crate::{AnyId, Mark, Number};
use std::sync::Arc;
use toile_measure::Measurements;

/// Key for a part that files write as a bare number or text, not as an object with fields.
pub const ITSELF: &str = "";

/// Visits all fields of a part in the order of the file, to read them.
///
/// No method has a default: a visitor that leaves one out does not compile.
///
/// ```compile_fail,E0046
/// use toile_pattern::fields::Visitor;
/// struct OwnIds;
/// impl<'a> Visitor<'a> for OwnIds {
///     fn own(&mut self, _: &'a dyn toile_pattern::AnyId) {}
/// }
/// ```
pub trait Visitor<'a> {
    /// Called with the part's own id.
    fn own(&mut self, id: &'a dyn AnyId);
    /// Called with the id of another part.
    fn id(&mut self, key: &'static str, id: &'a dyn AnyId);
    /// Called with a number.
    fn number(&mut self, field: NumberField, number: &'a Number);
    /// Called with a number that may be left out.
    fn optional_number(&mut self, field: NumberField, number: &'a Option<Number>);
    /// Called with a text, a flag, a count, a choice or a real number.
    fn value(&mut self, field: ValueField, value: &'a dyn Value);
    /// Called if files write the part as this one word.
    fn word(&mut self, word: &'static str);
    /// Called with a table of measurements.
    fn measurements(&mut self, key: &'static str, table: &'a Measurements);
    /// Called with a field that may be left out, to tell whether it is given; if it is, another call passes
    /// the field itself.
    fn optional(&mut self, key: &'static str, field: &'a dyn Optional);
    /// Called with a mark: a position on a line.
    fn mark(&mut self, group: Group, mark: &'a Mark);
    /// Called with a part whose fields form a group of their own.
    fn part(&mut self, group: Group, part: &'a dyn Fields);
    /// Called with a part whose fields stand in files among those of its owner.
    fn flat(&mut self, part: &'a dyn Fields);
    /// Called with fields that files write in an object of their own; `walk` visits them.
    fn object(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'a>));
    /// Called with fields that files write in a list of fixed length, without keys; `walk` visits them.
    fn list(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'a>));
    /// Called with a list of any number of parts; files leave the field out if the list is empty.
    fn each(&mut self, group: Group, parts: &'a dyn List);
}

/// Visits all fields of a part in the order of the file, to change them. The calls are those of [`Visitor`].
pub trait VisitorMut {
    /// Called with the part's own id.
    fn own(&mut self, id: &mut dyn AnyId);
    /// Called with the id of another part.
    fn id(&mut self, key: &'static str, id: &mut dyn AnyId);
    /// Called with a number.
    fn number(&mut self, field: NumberField, number: &mut Number);
    /// Called with a number that may be left out.
    fn optional_number(&mut self, field: NumberField, number: &mut Option<Number>);
    /// Called with a text, a flag, a count, a choice or a real number.
    fn value(&mut self, field: ValueField, value: &mut dyn Value);
    /// Called if files write the part as this one word.
    fn word(&mut self, word: &'static str);
    /// Called with a table of measurements.
    fn measurements(&mut self, key: &'static str, table: &mut Measurements);
    /// Called with a field that may be left out: the visitor may add or remove it. If it is given afterwards,
    /// another call passes the field itself.
    fn optional(&mut self, key: &'static str, field: &mut dyn Optional);
    /// Called with a mark: a position on a line.
    fn mark(&mut self, group: Group, mark: &mut Mark);
    /// Called with a part whose fields form a group of their own.
    fn part(&mut self, group: Group, part: &mut dyn Fields);
    /// Called with a part whose fields stand in files among those of its owner.
    fn flat(&mut self, part: &mut dyn Fields);
    /// Called with fields that files write in an object of their own; `walk` visits them.
    fn object(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut));
    /// Called with fields that files write in a list of fixed length, without keys; `walk` visits them.
    fn list(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut));
    /// Called with a list of any number of parts; files leave the field out if the list is empty.
    fn each(&mut self, group: Group, parts: &mut dyn List);
}

/// A part of the document whose fields can be visited.
pub trait Fields {
    /// Passes all fields to a visitor that reads, in the order of the file.
    fn visit<'a>(&'a self, v: &mut dyn Visitor<'a>);
    /// Passes all fields to a visitor that may change them, in the order of the file.
    fn visit_mut(&mut self, v: &mut dyn VisitorMut);
    /// The kinds of the part, in the order in which a reader looks for them in a file; empty if there is only
    /// one kind.
    fn kinds(&self) -> &'static [Kind] {
        &[]
    }
    /// Replaces the part by an empty part of the kind with this index.
    fn become_kind(&mut self, _kind: usize) {}
    /// Messages for a file that shows no kind, or two kinds.
    fn clash(&self) -> Clash {
        Clash::default()
    }
    /// First fault of the part as a whole, such as two fields that contradict each other. The single fields
    /// are checked elsewhere.
    fn fault(&self) -> Option<FieldFault> {
        None
    }
}

/// A fault of a part, and the field that is at fault.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldFault {
    /// Key of the field that is at fault.
    pub field: &'static str,
    /// Index of the item, from 0, if the field is a list.
    pub item: Option<usize>,
    /// Description of the fault.
    pub message: String,
    /// Advice on how to remedy the fault.
    pub hint: &'static str,
}

/// A list of parts, as visitors use it.
pub trait List {
    /// Number of parts.
    fn count(&self) -> usize;
    /// The part with index `k`, which is less than the count.
    fn get(&self, k: usize) -> &dyn Fields;
    /// The part with index `k`, to be changed; it is copied first if it is shared.
    fn get_mut(&mut self, k: usize) -> &mut dyn Fields;
    /// Sets the number of parts; new parts are empty.
    fn resize(&mut self, count: usize);
}

impl<T: Fields + Default> List for Vec<T> {
    fn count(&self) -> usize {
        self.len()
    }

    fn get(&self, k: usize) -> &dyn Fields {
        &self[k]
    }

    fn get_mut(&mut self, k: usize) -> &mut dyn Fields {
        &mut self[k]
    }

    fn resize(&mut self, count: usize) {
        self.resize_with(count, T::default);
    }
}

/// A field that may be left out.
pub trait Optional {
    /// Whether the field is given.
    fn is_there(&self) -> bool;
    /// Adds the field with an empty value, or removes it.
    fn set(&mut self, is_there: bool);
}

impl<T: Default> Optional for Option<T> {
    fn is_there(&self) -> bool {
        self.is_some()
    }

    fn set(&mut self, is_there: bool) {
        *self = is_there.then(T::default);
    }
}

impl<T: Fields + Clone> Fields for Arc<T> {
    fn visit<'a>(&'a self, v: &mut dyn Visitor<'a>) {
        (**self).visit(v);
    }

    fn visit_mut(&mut self, v: &mut dyn VisitorMut) {
        Arc::make_mut(self).visit_mut(v);
    }

    fn kinds(&self) -> &'static [Kind] {
        (**self).kinds()
    }

    fn become_kind(&mut self, kind: usize) {
        Arc::make_mut(self).become_kind(kind);
    }

    fn clash(&self) -> Clash {
        (**self).clash()
    }

    fn fault(&self) -> Option<FieldFault> {
        (**self).fault()
    }
}

/// Lists the fields of a type, once for all visitors: `fields!(Type, |self, v| { ... })`. The body takes the
/// value apart by patterns without `..`, so that a forgotten field does not compile, and passes each field to
/// the visitor `v`. The body is compiled twice: with shared references and with mutable ones. Type parameters
/// come first, as in `@[Id: AnyId] Name<Id>`.
///
/// An enum whose kind a file shows by its fields adds `, kinds: |self| match self { ... }`, which gives for
/// each variant its mark in files ([`Told`]), and, for its own messages, `, clash: ...` ([`Clash`]). The
/// variants are tried in the order of declaration, those that no field shows last.
///
/// A field is forgotten, which does not compile:
///
/// ```compile_fail,E0027
/// struct Hem { depth: toile_pattern::Number, rolled: bool }
/// toile_pattern::fields!(Hem, |self, v| {
///     let Self { depth } = self;
///     v.number(toile_pattern::fields::length("depth"), depth);
/// });
/// ```
///
/// The same type with all its fields:
///
/// ```
/// struct Hem { depth: toile_pattern::Number, rolled: bool }
/// toile_pattern::fields!(Hem, |self, v| {
///     let Self { depth, rolled } = self;
///     v.number(toile_pattern::fields::length("depth"), depth);
///     v.value(toile_pattern::fields::key("rolled").left_out_if(!*rolled), rolled);
/// });
/// ```
#[macro_export]
macro_rules! fields {
    (
        $(@[$($generics:tt)*])? $type:ty, |$this:ident, $v:ident| $body:block
        $(, kinds: |$kind:ident| $told:expr)?
        $(, clash: $clash:expr)?
        $(, fault: |$own:ident| $fault:expr)?
        $(,)?
    ) => {
        impl<$($($generics)*)?> $crate::fields::Fields for $type {
            fn visit<'a>(&'a $this, $v: &mut dyn $crate::fields::Visitor<'a>) $body

            fn visit_mut(&mut $this, $v: &mut dyn $crate::fields::VisitorMut) $body

            $(
                fn kinds(&self) -> &'static [$crate::fields::Kind] {
                    static KINDS: std::sync::OnceLock<Vec<$crate::fields::Kind>> = std::sync::OnceLock::new();
                    KINDS.get_or_init(|| $crate::fields::Kind::all::<$type>(|$kind| $told))
                }

                fn become_kind(&mut self, kind: usize) {
                    if let Some(blank) = $crate::fields::Kind::blank(self.kinds(), kind) {
                        *self = blank;
                    }
                }
            )?

            $(
                fn clash(&self) -> $crate::fields::Clash {
                    $clash
                }
            )?

            $(
                fn fault(&$own) -> Option<$crate::fields::FieldFault> {
                    $fault
                }
            )?
        }
    };
}
