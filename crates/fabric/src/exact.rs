//! Serialisation of numbers that may be infinite or NaN, which JSON cannot represent: they are written as words. Fields
//! use it by `#[serde(with = "toile_fabric::exact")]`.

use serde::de::{Error, Unexpected};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Words for numbers that are not finite.
const WORDS: [(&str, f64); 3] = [
    ("infinite", f64::INFINITY),
    ("-infinite", f64::NEG_INFINITY),
    ("none", f64::NAN),
];

#[derive(Deserialize)]
#[serde(untagged)]
enum Written {
    Number(f64),
    Word(String),
}

/// Writes a number or its word.
///
/// # Errors
/// Those of the serialiser.
pub fn serialize<S: Serializer>(number: &f64, to: S) -> Result<S::Ok, S::Error> {
    let word = WORDS
        .iter()
        .find(|(_, known)| known.total_cmp(number).is_eq() || known.is_nan() && number.is_nan());
    match word {
        Some((word, _)) => to.serialize_str(word),
        None => to.serialize_f64(*number),
    }
}

/// Reads a number or its word.
///
/// # Errors
/// Another word, or neither a number nor a word.
pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    match Written::deserialize(from)? {
        Written::Number(number) => Ok(number),
        Written::Word(word) => {
            let known = WORDS.iter().find(|(known, _)| *known == word);
            let unknown = || {
                let found = Unexpected::Str(&word);
                D::Error::invalid_value(found, &"a number, \"infinite\", \"-infinite\" or \"none\"")
            };
            known.map(|(_, number)| *number).ok_or_else(unknown)
        }
    }
}

/// The same for two numbers.
pub mod pair {
    use super::Serialize;
    use serde::{Deserialize, Deserializer, Serializer};

    #[derive(Serialize, Deserialize)]
    struct Number(#[serde(with = "super")] f64);

    /// Writes two numbers or their words.
    ///
    /// # Errors
    /// Those of the serialiser.
    pub fn serialize<S: Serializer>(pair: &[f64; 2], to: S) -> Result<S::Ok, S::Error> {
        pair.map(Number).serialize(to)
    }

    /// Reads two numbers or their words.
    ///
    /// # Errors
    /// Another word, or anything but two numbers or words.
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 2], D::Error> {
        let pair = <[Number; 2]>::deserialize(from)?;
        Ok(pair.map(|Number(number)| number))
    }
}
