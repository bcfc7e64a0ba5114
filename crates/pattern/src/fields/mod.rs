//! The fields of every part of the document, each said once: [`fields!`](crate::fields!) lists those of a type in the
//! order of the file, and everything that walks over fields is a [`Visitor`] or a [`VisitorMut`].
//!
//! What follows from the list alone: references ([`references()`]), new ids in copies ([`Remap`]), numbers with their labels
//! for inspectors ([`numbers_of`](crate::plan::numbers_of)), marks ([`marks`]), and in the crate `interchange` the reader
//! and the writer of files with the fields they know.

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

/// Key of a field that is its part itself: a part that is written as a bare number or text, not as an object.
pub const ITSELF: &str = "";

/// Meets every field of a part in the order of the file.
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
    /// The part is nothing but this word.
    fn word(&mut self, word: &'static str);
    /// A table of measurements.
    fn measurements(&mut self, key: &'static str, table: &'a Measurements);
    /// Says whether a field is there that may be left out; if it is, its own call follows.
    fn optional(&mut self, key: &'static str, field: &'a dyn Optional);
    /// A place on a line.
    fn mark(&mut self, group: Group, mark: &'a Mark);
    /// A part with fields of its own.
    fn part(&mut self, group: Group, part: &'a dyn Fields);
    /// A part whose fields stand among those of the part it belongs to.
    fn flat(&mut self, part: &'a dyn Fields);
    /// Fields that stand in an object of their own.
    fn object(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'a>));
    /// Fields that stand in a list without their keys, as many as there are.
    fn list(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn Visitor<'a>));
    /// Any number of parts; the field is left out where there are none.
    fn each(&mut self, group: Group, parts: &'a dyn List);
}

/// Meets the same fields, to change them.
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
    /// The part is nothing but this word.
    fn word(&mut self, word: &'static str);
    /// A table of measurements.
    fn measurements(&mut self, key: &'static str, table: &mut Measurements);
    /// Makes a field be there or not that may be left out; if it is then, its own call follows.
    fn optional(&mut self, key: &'static str, field: &mut dyn Optional);
    /// A place on a line.
    fn mark(&mut self, group: Group, mark: &mut Mark);
    /// A part with fields of its own.
    fn part(&mut self, group: Group, part: &mut dyn Fields);
    /// A part whose fields stand among those of the part it belongs to.
    fn flat(&mut self, part: &mut dyn Fields);
    /// Fields that stand in an object of their own.
    fn object(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut));
    /// Fields that stand in a list without their keys, as many as there are.
    fn list(&mut self, group: Group, walk: &mut dyn FnMut(&mut dyn VisitorMut));
    /// Any number of parts; the field is left out where there are none.
    fn each(&mut self, group: Group, parts: &mut dyn List);
}

/// A part of the document whose fields can be visited.
pub trait Fields {
    /// Shows every field to a visitor, in the order of the file.
    fn visit<'a>(&'a self, v: &mut dyn Visitor<'a>);
    /// The same, to be changed.
    fn visit_mut(&mut self, v: &mut dyn VisitorMut);
    /// The kinds it may be of, in the order in which a file tells them; none where there is but one.
    fn kinds(&self) -> &'static [Kind] {
        &[]
    }
    /// Becomes an empty one of a kind.
    fn become_kind(&mut self, _kind: usize) {}
    /// What is said where a file tells no kind, or two.
    fn clash(&self) -> Clash {
        Clash::default()
    }
    /// The first thing that no such part may have, though each of its fields may be as it is.
    fn fault(&self) -> Option<FieldFault> {
        None
    }
}

/// A fault of a part, with its place in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldFault {
    /// The field.
    pub field: &'static str,
    /// Which item of it, from 0, if it is a list.
    pub item: Option<usize>,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub hint: &'static str,
}

/// Parts in a row.
pub trait List {
    /// How many there are.
    fn count(&self) -> usize;
    /// One of them, from 0 and below the count.
    fn get(&self, k: usize) -> &dyn Fields;
    /// The same, to be changed; a shared one is copied first.
    fn get_mut(&mut self, k: usize) -> &mut dyn Fields;
    /// Makes it so many, new ones empty.
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

/// Something that may be left out.
pub trait Optional {
    /// Whether it is there.
    fn is_there(&self) -> bool;
    /// Makes it an empty one, or takes it away.
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

/// Lists the fields of a type, once for all visitors: `fields!(Type, |self, v| { ... })`. The body takes the value apart by
/// patterns without `..`, so that a field which is forgotten does not compile, and shows each to the visitor `v`; it is
/// compiled twice, once with references and once with mutable ones. A type with parameters has them before it, as in `@[Id: AnyId] Name<Id>`.
///
/// An enum whose kind a file tells by its fields adds `, kinds: |self| match self { ... }`, which gives for each variant
/// how it is told ([`Told`]), and, where that is refused in words of its own, `, clash: ...` ([`Clash`]). Its variants are
/// tried in the order of their declaration, those last that nothing tells.
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
/// The same with all its fields:
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
