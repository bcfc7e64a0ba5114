//! Descriptions of fields: key in files, label, quantity, default where the field is left out.

use crate::Want;

/// Meaning of a file in which a field is missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Absent {
    /// The file is refused.
    Refused,
    /// The field has this value, (m), (rad) or plain; files are written with the field in any case.
    Means(f64),
    /// The field has this value, (m), (rad) or plain; files leave the field out if it has this value.
    LeftOutAt(f64),
}

/// Position of a number among the numbers of its part in inspectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shown {
    /// Before the other numbers.
    First,
    /// In the order of the fields in files.
    InOrder,
    /// After the other numbers.
    Last,
}

/// Description of a field that holds a number or formula.
#[derive(Clone, Copy, Debug)]
pub struct NumberField {
    /// Key of the field in files.
    pub key: &'static str,
    /// Label of the field in inspectors.
    pub label: &'static str,
    /// Quantity of the number: length, angle, plain or any.
    pub want: Want,
    /// Meaning of a file in which the field is missing.
    pub absent: Absent,
    /// Position of the number in inspectors.
    pub shown: Shown,
}

const fn number(key: &'static str, want: Want) -> NumberField {
    NumberField {
        key,
        label: key,
        want,
        absent: Absent::Refused,
        shown: Shown::InOrder,
    }
}

/// A field with a length (m), which must be given.
pub const fn length(key: &'static str) -> NumberField {
    number(key, Want::Length)
}

/// A field with an angle (rad), which must be given.
pub const fn angle(key: &'static str) -> NumberField {
    number(key, Want::Angle)
}

/// A field with a plain number, which must be given.
pub const fn plain(key: &'static str) -> NumberField {
    number(key, Want::Plain)
}

/// A field with a number of any quantity, which must be given.
pub const fn any(key: &'static str) -> NumberField {
    number(key, Want::Any)
}

impl NumberField {
    /// This field with a label that differs from its key.
    #[must_use]
    pub const fn label(self, label: &'static str) -> Self {
        Self { label, ..self }
    }

    /// This field with a value for files in which it is missing; it is always written.
    #[must_use]
    pub const fn means(self, number: f64) -> Self {
        Self {
            absent: Absent::Means(number),
            ..self
        }
    }

    /// This field with a value for files in which it is missing; it is not written if it has this value.
    #[must_use]
    pub const fn left_out_at(self, number: f64) -> Self {
        Self {
            absent: Absent::LeftOutAt(number),
            ..self
        }
    }

    /// This field, shown before the other numbers of its part.
    #[must_use]
    pub const fn shown_first(self) -> Self {
        Self {
            shown: Shown::First,
            ..self
        }
    }

    /// This field, shown after the other numbers of its part.
    #[must_use]
    pub const fn shown_last(self) -> Self {
        Self {
            shown: Shown::Last,
            ..self
        }
    }
}

/// Description of a field whose value is not a formula: a text, a flag, a count, a choice, or a number.
#[derive(Clone, Copy, Debug)]
pub struct ValueField {
    /// Key of the field in files.
    pub key: &'static str,
    /// Quantity of the value, if it is a real number.
    pub want: Want,
    /// Whether files may leave the field out: it then has the value that it has in an empty part.
    pub may_lack: bool,
    /// Whether the field is left out when its part is written.
    pub is_left_out: bool,
    /// Value of a flag that is missing in a file, if it is not the value in an empty part.
    pub absent_flag: Option<bool>,
    /// Least and greatest value allowed.
    pub range: Option<[f64; 2]>,
    /// The number that files write as `null`.
    pub null: Option<f64>,
    /// Whether the value is the name of a part.
    pub is_name: bool,
    /// Largest value allowed for a count.
    pub largest: u32,
    /// Message for a count above `largest`: description of the fault, and advice.
    pub beyond: [&'static str; 2],
}

/// A field that files must have.
pub const fn key(key: &'static str) -> ValueField {
    ValueField {
        key,
        want: Want::Plain,
        may_lack: false,
        is_left_out: false,
        absent_flag: None,
        range: None,
        null: None,
        is_name: false,
        largest: u32::MAX,
        beyond: ["there are not that many", "write a smaller number"],
    }
}

impl ValueField {
    /// The field for the name of a part.
    pub const NAME: Self = Self {
        is_name: true,
        ..key("name")
    };

    /// This field with a length as its value (m).
    #[must_use]
    pub const fn length(self) -> Self {
        Self {
            want: Want::Length,
            ..self
        }
    }

    /// This field with an angle as its value (rad).
    #[must_use]
    pub const fn angle(self) -> Self {
        Self {
            want: Want::Angle,
            ..self
        }
    }

    /// This field, which files may leave out; it is always written.
    #[must_use]
    pub const fn may_lack(self) -> Self {
        Self {
            may_lack: true,
            ..self
        }
    }

    /// This field, which files may leave out; it is not written if `is_usual`.
    #[must_use]
    pub const fn left_out_if(self, is_usual: bool) -> Self {
        Self {
            may_lack: true,
            is_left_out: is_usual,
            ..self
        }
    }

    /// This field, a flag that has the value `flag` if a file leaves it out.
    #[must_use]
    pub const fn flag_if_absent(self, flag: bool) -> Self {
        Self {
            may_lack: true,
            absent_flag: Some(flag),
            ..self
        }
    }

    /// This field with a least and a greatest value.
    #[must_use]
    pub const fn within(self, range: [f64; 2]) -> Self {
        Self {
            range: Some(range),
            ..self
        }
    }

    /// This field, with `number` written as `null`.
    #[must_use]
    pub const fn null_at(self, number: f64) -> Self {
        Self {
            null: Some(number),
            ..self
        }
    }

    /// This field, a count, with its largest value.
    #[must_use]
    pub const fn at_most(self, largest: u16) -> Self {
        Self {
            largest: largest as u32,
            ..self
        }
    }

    /// This field with its own message for a count that is too large: description of the fault, and advice.
    #[must_use]
    pub const fn beyond(self, what: &'static str, hint: &'static str) -> Self {
        Self {
            beyond: [what, hint],
            ..self
        }
    }
}

/// Description of a field that holds a part or a list.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// Key of the field in files.
    pub key: &'static str,
    /// Label of the number in the field, if the label of that number's own field is not enough.
    pub label: Option<&'static str>,
    /// Label of the number in the field if it is a share.
    pub share_label: Option<&'static str>,
    /// Whether files may leave the field out: the part or list is then empty.
    pub may_lack: bool,
    /// Whether the field is left out when it is written.
    pub is_left_out: bool,
    /// Whether a list is written even if it is empty.
    pub even_empty: bool,
    /// Message for all faults of the field: description of the fault, and advice.
    pub refusal: Option<[&'static str; 2]>,
}

/// A field with a part or list, which files must have.
pub const fn group(key: &'static str) -> Group {
    Group {
        key,
        label: None,
        share_label: None,
        may_lack: false,
        is_left_out: false,
        even_empty: false,
        refusal: None,
    }
}

impl Group {
    /// This field with a label for its number.
    #[must_use]
    pub const fn label(self, label: &'static str) -> Self {
        Self {
            label: Some(label),
            ..self
        }
    }

    /// This field with a label for its number if it is a share.
    #[must_use]
    pub const fn share_label(self, label: &'static str) -> Self {
        Self {
            share_label: Some(label),
            ..self
        }
    }

    /// This field, which files may leave out; it is always written.
    #[must_use]
    pub const fn may_lack(self) -> Self {
        Self {
            may_lack: true,
            ..self
        }
    }

    /// This field, which files may leave out; it is not written if `is_usual`.
    #[must_use]
    pub const fn left_out_if(self, is_usual: bool) -> Self {
        Self {
            may_lack: true,
            is_left_out: is_usual,
            ..self
        }
    }

    /// This field, a list that is written even if it is empty.
    #[must_use]
    pub const fn even_empty(self) -> Self {
        Self {
            even_empty: true,
            ..self
        }
    }

    /// This field with its own message for all faults: description of the fault, and advice.
    #[must_use]
    pub const fn refusal(self, what: &'static str, hint: &'static str) -> Self {
        Self {
            refusal: Some([what, hint]),
            ..self
        }
    }
}

/// A value as visitors read it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ValueRef<'a> {
    /// A flag.
    Flag(bool),
    /// A whole number.
    Count(u32),
    /// A number: a length (m), an angle (rad) or plain.
    Real(f64),
    /// A text.
    Text(&'a str),
    /// A word of a closed list.
    Word(&'a str),
}

/// A value as visitors may change it.
pub enum ValueMut<'a> {
    /// A flag.
    Flag(&'a mut bool),
    /// A whole number: the largest value of its type, and a function that sets it.
    Count(u32, &'a mut dyn FnMut(u32)),
    /// A number: a length (m), an angle (rad) or plain.
    Real(&'a mut f64),
    /// A text.
    Text(&'a mut String),
    /// A word of a closed list: the words, and a function that sets the value by the index of its word.
    Word(&'static [&'static str], &'a mut dyn FnMut(usize)),
}

/// A value that a field can hold.
pub trait Value {
    /// The value.
    fn get(&self) -> ValueRef<'_>;
    /// Calls `by` with the value, to change it.
    fn change(&mut self, by: &mut dyn FnMut(ValueMut<'_>));
}

impl Value for bool {
    fn get(&self) -> ValueRef<'_> {
        ValueRef::Flag(*self)
    }

    fn change(&mut self, by: &mut dyn FnMut(ValueMut<'_>)) {
        by(ValueMut::Flag(self));
    }
}

impl Value for f64 {
    fn get(&self) -> ValueRef<'_> {
        ValueRef::Real(*self)
    }

    fn change(&mut self, by: &mut dyn FnMut(ValueMut<'_>)) {
        by(ValueMut::Real(self));
    }
}

impl Value for String {
    fn get(&self) -> ValueRef<'_> {
        ValueRef::Text(self)
    }

    fn change(&mut self, by: &mut dyn FnMut(ValueMut<'_>)) {
        by(ValueMut::Text(self));
    }
}

macro_rules! counts {
    ($($type:ty),*) => {
        $(impl Value for $type {
            fn get(&self) -> ValueRef<'_> {
                ValueRef::Count((*self).into())
            }

            fn change(&mut self, by: &mut dyn FnMut(ValueMut<'_>)) {
                // The visitor passes a count of at most the largest value of the type.
                by(ValueMut::Count(<$type>::MAX.into(), &mut |count| {
                    *self = count.try_into().unwrap_or(<$type>::MAX);
                }));
            }
        })*
    };
}

counts!(u8, u16, u32);
