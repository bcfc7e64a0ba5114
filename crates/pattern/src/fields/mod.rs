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
//! Files, and random patterns in `interchange/tests/random_pattern`, follow the lists.

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

/// Key of the field of a part that is written as a bare number or text, not as an object.
pub const ITSELF: &str = "";

/// Visits every field of a part in the order of the file.
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
    /// The part's own id.
    fn own(&mut self, id: &'a dyn AnyId);
    /// The id of another part.
    fn id(&mut self, key: &'static str, id: &'a dyn AnyId);
    /// A number.
    fn number(&mut self, field: NumberField, number: &'a Number);
    /// A number that may be left out.
    fn optional_number(&mut self, field: NumberField, number: &'a Option<Number>);
    /// A text, a flag, a count, a choice, a value.
    fn value(&mut self, field: ValueField, value: &'a dyn Value);
    /// The part is written as just this word.
    fn word(&mut self, word: &'static str);
    /// A table of measurements.
    fn measurements(&mut self, key: &'static str, table: &'a Measurements);
    /// Tells whether a field is there that may be left out; if it is, the call for the field follows.
    fn optional(&mut self, key: &'static str, field: &'a dyn Optional);
    /// A mark on a line.
    fn mark(&mut self, group: Group, mark: &'a Mark);
    /// A part with fields of its own.
    fn part(&mut self, group: Group, part: &'a dyn Fields);
    /// A part whose fields stand among those of the part it belongs to.
    fn flat(&mut self, part: &'a dyn Fields);
    /// Fields that are written in an object of their own.
    fn object(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'a>));
    /// Fields that are written in a list of fixed length, without their keys.
    fn list(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'a>));
    /// A list of any number of parts; the field is left out if the list is empty.
    fn each(&mut self, group: Group, parts: &'a dyn List);
}

/// Visits every field of a part in the order of the file, to change it.
pub trait VisitorMut {
    /// The part's own id.
    fn own(&mut self, id: &mut dyn AnyId);
    /// The id of another part.
    fn id(&mut self, key: &'static str, id: &mut dyn AnyId);
    /// A number.
    fn number(&mut self, field: NumberField, number: &mut Number);
    /// A number that may be left out.
    fn optional_number(&mut self, field: NumberField, number: &mut Option<Number>);
    /// A text, a flag, a count, a choice, a value.
    fn value(&mut self, field: ValueField, value: &mut dyn Value);
    /// The part is written as just this word.
    fn word(&mut self, word: &'static str);
    /// A table of measurements.
    fn measurements(&mut self, key: &'static str, table: &mut Measurements);
    /// May add or remove a field that may be left out; if it is there afterwards, the call for the
    /// field follows.
    fn optional(&mut self, key: &'static str, field: &mut dyn Optional);
    /// A mark on a line.
    fn mark(&mut self, group: Group, mark: &mut Mark);
    /// A part with fields of its own.
    fn part(&mut self, group: Group, part: &mut dyn Fields);
    /// A part whose fields stand among those of the part it belongs to.
    fn flat(&mut self, part: &mut dyn Fields);
    /// Fields that are written in an object of their own.
    fn object(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut));
    /// Fields that are written in a list of fixed length, without their keys.
    fn list(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut));
    /// A list of any number of parts; the field is left out if the list is empty.
    fn each(&mut self, group: Group, parts: &mut dyn List);
}

/// A part of the document whose fields can be visited.
pub trait Fields {
    /// Visits every field, in the order of the file.
    fn visit<'a>(&'a self, v: &mut dyn Visitor<'a>);
    /// Visits every field for changing, in the order of the file.
    fn visit_mut(&mut self, v: &mut dyn VisitorMut);
    /// The kinds of the part, in the order in which a file is asked for them; none if there is only one.
    fn kinds(&self) -> &'static [Kind] {
        &[]
    }
    /// Replaces the part by an empty one of this kind.
    fn become_kind(&mut self, _kind: usize) {}
    /// Messages for a file that tells no kind, or two.
    fn clash(&self) -> Clash {
        Clash::default()
    }
    /// The first fault of the part as a whole, though each of its fields is valid by itself.
    fn fault(&self) -> Option<FieldFault> {
        None
    }
}

/// A fault of a part, with the field at fault.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldFault {
    /// Key of the field.
    pub field: &'static str,
    /// Index of the item, from 0, if the field is a list.
    pub item: Option<usize>,
    /// Description of the fault.
    pub message: String,
    /// Advice on how to remedy the fault.
    pub hint: &'static str,
}

/// A list of parts.
pub trait List {
    /// Number of parts.
    fn count(&self) -> usize;
    /// One of the parts, by an index below the count.
    fn get(&self, k: usize) -> &dyn Fields;
    /// One of the parts for changing; a shared part is copied first.
    fn get_mut(&mut self, k: usize) -> &mut dyn Fields;
    /// Sets the number of parts; new ones are empty.
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
    /// Whether the field is there.
    fn is_there(&self) -> bool;
    /// Adds the field, empty, or removes it.
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

/// Lists the fields of a type, once for all visitors: `fields!(Type, |self, v| { ... })`. The body
/// destructures the value by patterns without `..`, so that a forgotten field does not compile, and passes
/// each field to the visitor `v`; it is compiled twice, once with references and once with mutable ones. Type
/// parameters stand in front, as in `@[Id: AnyId] Name<Id>`.
///
/// An enum whose kind a file tells by its fields adds `, kinds: |self| match self { ... }`, which gives for
/// each variant the way it is told ([`Told`]), and, for messages of its own, `, clash: ...` ([`Clash`]). The
/// variants are tried in the order of their declaration, variants without telling fields last.
///
/// A field that is forgotten:
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
