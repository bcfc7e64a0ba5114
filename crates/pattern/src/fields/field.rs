//! What is said of a field beside its value: its key in files, its label, its quantity, what stands for it where it is
//! left out.

use crate::Want;

/// What a file means that leaves a field out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Absent {
    /// It is refused.
    Refused,
    /// This number, which is written all the same (m), (rad) or plain.
    Means(f64),
    /// This number, and where it is that, it is not written (m), (rad) or plain.
    LeftOutAt(f64),
}

/// Where inspectors show a number among those of its part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shown {
    /// Before the others.
    First,
    /// In the order of the file.
    InOrder,
    /// After the others.
    Last,
}

/// A number of a part.
#[derive(Clone, Copy, Debug)]
pub struct NumberField {
    /// Its key in files.
    pub key: &'static str,
    /// What it is called beside its field.
    pub label: &'static str,
    /// What it must be.
    pub want: Want,
    /// What a file means that leaves it out.
    pub absent: Absent,
    /// Where it is shown.
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

/// A number that may be anything.
pub const fn any(key: &'static str) -> NumberField {
    number(key, Want::Any)
}

impl NumberField {
    /// With another label than its key.
    #[must_use]
    pub const fn label(self, label: &'static str) -> Self {
        Self { label, ..self }
    }

    /// Left out it means a number, which is always written.
    #[must_use]
    pub const fn means(self, number: f64) -> Self {
        Self {
            absent: Absent::Means(number),
            ..self
        }
    }

    /// Left out where it is this number.
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

/// A value that is no number of the document: a text, a flag, a count, a choice, or a number that no formula may be.
#[derive(Clone, Copy, Debug)]
pub struct ValueField {
    /// Its key in files.
    pub key: &'static str,
    /// What it measures, where it is a number with a fraction.
    pub want: Want,
    /// Whether a file may leave it out: it is then that of an empty part.
    pub may_lack: bool,
    /// Whether it is left out where it is written.
    pub is_left_out: bool,
    /// What a flag is that is left out, if that is not what an empty part has.
    pub absent_flag: Option<bool>,
    /// The least and the most that it may be.
    pub range: Option<[f64; 2]>,
    /// The number that is written as `null`.
    pub null: Option<f64>,
    /// Whether it is the name of a part.
    pub is_name: bool,
    /// The largest count.
    pub largest: u32,
    /// What is said of a count beyond the largest: what is wrong, what to do.
    pub beyond: [&'static str; 2],
}

/// A value that must be there.
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
    /// The name of a part.
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

    /// Files may leave it out; it is always written.
    #[must_use]
    pub const fn may_lack(self) -> Self {
        Self {
            may_lack: true,
            ..self
        }
    }

    /// Files may leave it out, and it is left out where it is what an empty part has.
    #[must_use]
    pub const fn left_out_if(self, is_usual: bool) -> Self {
        Self {
            may_lack: true,
            is_left_out: is_usual,
            ..self
        }
    }

    /// A flag that is this where it is left out.
    #[must_use]
    pub const fn flag_if_absent(self, flag: bool) -> Self {
        Self {
            may_lack: true,
            absent_flag: Some(flag),
            ..self
        }
    }

    /// With the least and the most that it may be.
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

    /// Of a count the largest.
    #[must_use]
    pub const fn at_most(self, largest: u16) -> Self {
        Self {
            largest: largest as u32,
            ..self
        }
    }

    /// With other words for a count that is too large: what is wrong, what to do.
    #[must_use]
    pub const fn beyond(self, what: &'static str, hint: &'static str) -> Self {
        Self {
            beyond: [what, hint],
            ..self
        }
    }
}

/// A part or list that is a field of another part.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// Its key in files.
    pub key: &'static str,
    /// What its number is called where the number's own label does not say it.
    pub label: Option<&'static str>,
    /// What a share in it is called.
    pub share_label: Option<&'static str>,
    /// Whether a file may leave it out: it is then empty.
    pub may_lack: bool,
    /// Whether it is left out where it is written.
    pub is_left_out: bool,
    /// Whether a list is written even where it is empty.
    pub even_empty: bool,
    /// What is said whatever is wrong with it, and what to do.
    pub refusal: Option<[&'static str; 2]>,
}

/// A part or list that must be there.
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

    /// Files may leave it out; it is always written.
    #[must_use]
    pub const fn may_lack(self) -> Self {
        Self {
            may_lack: true,
            ..self
        }
    }

    /// Left out where it is as an empty one.
    #[must_use]
    pub const fn left_out_if(self, is_usual: bool) -> Self {
        Self {
            may_lack: true,
            is_left_out: is_usual,
            ..self
        }
    }

    /// A list that is written even where it is empty.
    #[must_use]
    pub const fn even_empty(self) -> Self {
        Self {
            even_empty: true,
            ..self
        }
    }

    /// Refused in words of its own: what is wrong, what to do.
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
    /// One of a closed list of words.
    Word(&'a str),
}

/// A value as a visitor may change it.
pub enum ValueMut<'a> {
    /// A flag.
    Flag(&'a mut bool),
    /// A whole number up to a largest.
    Count(u32, &'a mut dyn FnMut(u32)),
    /// A number: a length (m), an angle (rad) or plain.
    Real(&'a mut f64),
    /// A text.
    Text(&'a mut String),
    /// One of a closed list of words, to be chosen by its place in it.
    Word(&'static [&'static str], &'a mut dyn FnMut(usize)),
}

/// A value of a field.
pub trait Value {
    /// The value.
    fn get(&self) -> ValueRef<'_>;
    /// Gives it to be changed.
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
                // What is given is at most the largest.
                by(ValueMut::Count(<$type>::MAX.into(), &mut |count| {
                    *self = count.try_into().unwrap_or(<$type>::MAX);
                }));
            }
        })*
    };
}

counts!(u8, u16, u32);
