//! JSON in which no field is given twice: the second would silently replace the first.

use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Number, Value};
use std::fmt;
use toile_interchange::FormatError;

/// Reads a text.
///
/// # Errors
/// The text is no JSON, or gives a field of an object twice; with line and column.
pub(crate) fn read_strictly(text: &str) -> Result<Value, FormatError> {
    let read: Result<Strict, _> = serde_json::from_str(text);
    read.map(|Strict(value)| value).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        let words = error.to_string();
        let what = words.split(" at line ").next().unwrap_or_default();
        FormatError::new(
            place,
            what,
            "correct the JSON; see docs/FORMATS.md, batches",
        )
    })
}

/// A value that was read strictly.
struct Strict(Value);

impl<'de> Deserialize<'de> for Strict {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(StrictVisitor)
    }
}

struct StrictVisitor;

impl<'de> Visitor<'de> for StrictVisitor {
    type Value = Strict;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_unit<E>(self) -> Result<Strict, E> {
        Ok(Strict(Value::Null))
    }

    fn visit_bool<E>(self, flag: bool) -> Result<Strict, E> {
        Ok(Strict(flag.into()))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Strict, E> {
        Ok(Strict(number.into()))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Strict, E> {
        Ok(Strict(number.into()))
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Strict, E> {
        let number = Number::from_f64(number).ok_or_else(|| E::custom("a number without end"))?;
        Ok(Strict(number.into()))
    }

    fn visit_str<E>(self, text: &str) -> Result<Strict, E> {
        Ok(Strict(text.into()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Strict, A::Error> {
        let mut items = Vec::new();
        while let Some(Strict(item)) = list.next_element()? {
            items.push(item);
        }
        Ok(Strict(items.into()))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Strict, A::Error> {
        let mut fields = Map::new();
        while let Some(name) = map.next_key::<String>()? {
            if fields.contains_key(&name) {
                return Err(A::Error::custom(format!(
                    "the field `{name}` is given twice"
                )));
            }
            let Strict(value) = map.next_value()?;
            fields.insert(name, value);
        }
        Ok(Strict(fields.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_given_twice_is_refused_with_its_place() {
        let good = r#"{"a": [1, -2, 0.5, "x", true, null], "b": {"a": 1}}"#;
        let plain: Value = serde_json::from_str(good).unwrap();
        assert_eq!(read_strictly(good).unwrap(), plain);
        let error = read_strictly("{\"a\": 1,\n \"a\": 2}").unwrap_err();
        assert!(error.place.starts_with("line 2"), "{error}");
        assert!(error.what.contains("`a` is given twice"), "{error}");
        assert!(read_strictly("{").unwrap_err().place.starts_with("line 1"));
    }
}
