//! Descriptions of fields: key in files, label, quantity, default where the field is left out.

use crate::Want;

/// Meaning of a file that leaves a field out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Absent {
    /// The file is refused.
    Refused,
    /// The field has this value, (m), (rad) or plain; files write it all the same.
    Means(f64),
    /// The field has this value, (m), (rad) or plain; files leave the field out if it has this value.
    LeftOutAt(f64),
}

/// Position of a number among the numbers of its part in an inspector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shown {
    /// Before the others.
    First,
    /// In the order of the file.
    InOrder,
    /// After the others.
    Last,
}

/// Description of a field that holds a number or formula.
#[derive(Clone, Copy, Debug)]
pub struct NumberField {
    /// Key of the field in files.
    pub key: &'static str,
    /// Label of the field in inspectors.
    pub label: &'static str,
    /// Quantity that the number must be.
    pub want: Want,
    /// Meaning of a file that leaves the field out.
    pub absent: Absent,
    /// Position in inspectors.
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

/// A length (m).
pub const fn length(key: &'static str) -> NumberField {
    number(key, Want::Length)
}

/// An angle (rad).
pub const fn angle(key: &'static str) -> NumberField {
    number(key, Want::Angle)
}

/// A plain number.
pub const fn plain(key: &'static str) -> NumberField {
    number(key, Want::Plain)
}

/// A number of any quantity.
pub const fn any(key: &'static str) -> NumberField {
    number(key, Want::Any)
}

impl NumberField {
    /// With a label that differs from the key.
    #[must_use]
    pub const fn label(self, label: &'static str) -> Self {
        Self { label, ..self }
    }

    /// A file that leaves the field out means this number; the field is always written.
    #[must_use]
    pub const fn means(self, number: f64) -> Self {
        Self {
            absent: Absent::Means(number),
            ..self
        }
    }

    /// The field is left out of files if it has this value.
    #[must_use]
    pub const fn left_out_at(self, number: f64) -> Self {
        Self {
            absent: Absent::LeftOutAt(number),
            ..self
        }
    }

    /// Shown before the other numbers of its part.
    #[must_use]
    pub const fn shown_first(self) -> Self {
        Self {
            shown: Shown::First,
            ..self
        }
    }

    /// Shown after the other numbers of its part.
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
    /// Quantity of the value, if it is a number with a fraction.
    pub want: Want,
    /// Whether files may leave the field out: it then has the value of an empty part.
    pub may_lack: bool,
    /// Whether the field is left out on writing.
    pub is_left_out: bool,
    /// Value of a flag that a file leaves out, if it differs from that of an empty part.
    pub absent_flag: Option<bool>,
    /// Least and greatest value.
    pub range: Option<[f64; 2]>,
    /// The number that is written as `null`.
    pub null: Option<f64>,
    /// Whether the value is the name of a part.
    pub is_name: bool,
    /// Largest value of a count.
    pub largest: u32,
    /// Message for a count beyond the largest: the fault, and the advice.
    pub beyond: [&'static str; 2],
}

/// A field that must be there.
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
    /// The field with the name of a part.
    pub const NAME: Self = Self {
        is_name: true,
        ..key("name")
    };

    /// A length (m).
    #[must_use]
    pub const fn length(self) -> Self {
        Self {
            want: Want::Length,
            ..self
        }
    }

    /// An angle (rad).
    #[must_use]
    pub const fn angle(self) -> Self {
        Self {
            want: Want::Angle,
            ..self
        }
    }

    /// Files may leave the field out; it is always written.
    #[must_use]
    pub const fn may_lack(self) -> Self {
        Self {
            may_lack: true,
            ..self
        }
    }

    /// Files may leave the field out; it is left out on writing if it has its usual value.
    #[must_use]
    pub const fn left_out_if(self, is_usual: bool) -> Self {
        Self {
            may_lack: true,
            is_left_out: is_usual,
            ..self
        }
    }

    /// A flag with this value if a file leaves it out.
    #[must_use]
    pub const fn flag_if_absent(self, flag: bool) -> Self {
        Self {
            may_lack: true,
            absent_flag: Some(flag),
            ..self
        }
    }

    /// With a least and a greatest value.
    #[must_use]
    pub const fn within(self, range: [f64; 2]) -> Self {
        Self {
            range: Some(range),
            ..self
        }
    }

    /// Written as `null` where it is this number.
    #[must_use]
    pub const fn null_at(self, number: f64) -> Self {
        Self {
            null: Some(number),
            ..self
        }
    }

    /// With a largest value of a count.
    #[must_use]
    pub const fn at_most(self, largest: u16) -> Self {
        Self {
            largest: largest as u32,
            ..self
        }
    }

    /// With another message for a count that is too large: the fault, and the advice.
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
    /// Label of its number, if the label of the number's own field does not suffice.
    pub label: Option<&'static str>,
    /// Label of a share in the field.
    pub share_label: Option<&'static str>,
    /// Whether files may leave the field out: it is then empty.
    pub may_lack: bool,
    /// Whether the field is left out on writing.
    pub is_left_out: bool,
    /// Whether a list is written even if it is empty.
    pub even_empty: bool,
    /// Message for any fault of the field: the fault, and the advice.
    pub refusal: Option<[&'static str; 2]>,
}

/// A field with a part or list that must be there.
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
    /// With a label for its number.
    #[must_use]
    pub const fn label(self, label: &'static str) -> Self {
        Self {
            label: Some(label),
            ..self
        }
    }

    /// With a label for a share in it.
    #[must_use]
    pub const fn share_label(self, label: &'static str) -> Self {
        Self {
            share_label: Some(label),
            ..self
        }
    }

    /// Files may leave the field out; it is always written.
    #[must_use]
    pub const fn may_lack(self) -> Self {
        Self {
            may_lack: true,
            ..self
        }
    }

    /// Files may leave the field out; it is left out on writing if it is empty.
    #[must_use]
    pub const fn left_out_if(self, is_usual: bool) -> Self {
        Self {
            may_lack: true,
            is_left_out: is_usual,
            ..self
        }
    }

    /// A list that is written even if it is empty.
    #[must_use]
    pub const fn even_empty(self) -> Self {
        Self {
            even_empty: true,
            ..self
        }
    }

    /// With its own message for any fault: the fault, and the advice.
    #[must_use]
    pub const fn refusal(self, what: &'static str, hint: &'static str) -> Self {
        Self {
            refusal: Some([what, hint]),
            ..self
        }
    }
}

/// A value as it is shown to a visitor.
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

/// A value as a visitor may change it.
pub enum ValueMut<'a> {
    /// A flag.
    Flag(&'a mut bool),
    /// A whole number: the largest value, and a function that sets it.
    Count(u32, &'a mut dyn FnMut(u32)),
    /// A number: a length (m), an angle (rad) or plain.
    Real(&'a mut f64),
    /// A text.
    Text(&'a mut String),
    /// A word of a closed list: the list, and a function that sets the word by its index.
    Word(&'static [&'static str], &'a mut dyn FnMut(usize)),
}

/// A value of a field.
pub trait Value {
    /// The value.
    fn get(&self) -> ValueRef<'_>;
    /// Passes the value to a function that may change it.
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
                // The number passed in is at most the largest value.
                by(ValueMut::Count(<$type>::MAX.into(), &mut |count| {
                    *self = count.try_into().unwrap_or(<$type>::MAX);
                }));
            }
        })*
    };
}

counts!(u8, u16, u32);
