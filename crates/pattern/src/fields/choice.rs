//! Values of a closed list of words.

use super::field::{Value, ValueMut, ValueRef};
use strum::{VariantArray, VariantNames};

/// An enum that files write as one word. Its words are the variant names from `strum`, which equal those from
/// serde.
pub trait Choice: VariantArray + VariantNames + PartialEq + Copy {
    /// All values.
    fn all() -> &'static [Self] {
        <Self as VariantArray>::VARIANTS
    }

    /// Words for all values in files, in the order of [`Self::all`].
    fn words() -> &'static [&'static str] {
        <Self as VariantNames>::VARIANTS
    }

    /// Word for this value in files.
    fn word(self) -> &'static str {
        let place = Self::all().iter().position(|known| *known == self);
        place.map_or("", |k| Self::words()[k])
    }
}

impl<T: Choice + 'static> Value for T {
    fn get(&self) -> ValueRef<'_> {
        ValueRef::Word(self.word())
    }

    fn change(&mut self, by: &mut dyn FnMut(ValueMut<'_>)) {
        by(ValueMut::Word(Self::words(), &mut |k| {
            *self = Self::all()[k]
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::Choice;
    use crate::*;
    use serde::Serialize;

    /// Checks that pattern files and journals use the same words for a choice.
    fn alike<T: Choice + Serialize>() {
        for (choice, word) in T::all().iter().zip(T::words()) {
            assert_eq!(serde_json::to_value(choice).unwrap(), *word);
            assert_eq!(choice.word(), *word);
        }
    }

    #[test]
    fn files_and_journals_write_the_same_words() {
        alike::<BodyPart>();
        alike::<Bridge>();
        alike::<Corner>();
        alike::<Facing>();
        alike::<LineKind>();
        alike::<NapRule>();
        alike::<NotchKind>();
        alike::<PleatKind>();
        alike::<Pressed>();
        alike::<Role>();
        alike::<Side>();
        alike::<Spread>();
        alike::<Turned>();
    }
}
