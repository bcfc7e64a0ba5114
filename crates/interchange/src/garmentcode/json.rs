//! Access to parsed JSON that knows its path, so that every refusal says where.

use crate::FormatError;
use serde_json::Value;

/// A JSON value and the path to it.
#[derive(Clone)]
pub(super) struct At<'a> {
    pub value: &'a Value,
    pub path: String,
}

impl<'a> At<'a> {
    pub fn root(value: &'a Value) -> Self {
        Self {
            value,
            path: String::new(),
        }
    }

    /// An error at this value.
    pub fn error(&self, what: impl Into<String>, hint: &str) -> FormatError {
        let place = if self.path.is_empty() {
            "the file"
        } else {
            &self.path
        };
        FormatError::new(place, what, hint)
    }

    fn kind(&self) -> &'static str {
        match self.value {
            Value::Null => "nothing",
            Value::Bool(_) => "true or false",
            Value::Number(_) => "a number",
            Value::String(_) => "a text",
            Value::Array(_) => "a list",
            Value::Object(_) => "an object",
        }
    }

    fn expected(&self, what: &str) -> FormatError {
        self.error(
            format!("{} stands where {what} is needed", self.kind()),
            "compare with a file written by GarmentCode",
        )
    }

    /// A field, if it is present and not null.
    pub fn optional(&self, name: &str) -> Option<Self> {
        let value = self.value.get(name).filter(|v| !v.is_null())?;
        let path = if self.path.is_empty() {
            name.to_owned()
        } else {
            format!("{}.{name}", self.path)
        };
        Some(Self { value, path })
    }

    /// A field that must be present.
    pub fn field(&self, name: &str) -> Result<Self, FormatError> {
        if !self.value.is_object() {
            return Err(self.expected("an object"));
        }
        self.optional(name).ok_or_else(|| {
            self.error(
                format!("the field \"{name}\" is missing"),
                "add it, or export the pattern again",
            )
        })
    }

    /// The fields of an object.
    pub fn entries(&self) -> Result<Vec<(&'a str, Self)>, FormatError> {
        let object = self
            .value
            .as_object()
            .ok_or_else(|| self.expected("an object"))?;
        Ok(object
            .iter()
            .map(|(name, value)| {
                let path = format!("{}.{name}", self.path);
                (name.as_str(), Self { value, path })
            })
            .collect())
    }

    /// The elements of a list.
    pub fn items(&self) -> Result<Vec<Self>, FormatError> {
        let list = self
            .value
            .as_array()
            .ok_or_else(|| self.expected("a list"))?;
        Ok(list
            .iter()
            .enumerate()
            .map(|(k, value)| Self {
                value,
                path: format!("{}[{k}]", self.path),
            })
            .collect())
    }

    /// A list of exactly `N` finite numbers.
    pub fn numbers<const N: usize>(&self) -> Result<[f64; N], FormatError> {
        let items = self.items()?;
        if items.len() != N {
            return Err(self.error(
                format!("{} numbers stand where {N} are needed", items.len()),
                "compare with a file written by GarmentCode",
            ));
        }
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(&items) {
            *number = item.number()?;
        }
        Ok(numbers)
    }

    /// A finite number, below 1e7 in magnitude.
    pub fn number(&self) -> Result<f64, FormatError> {
        // Python writes flags as true and false or as 1 and 0.
        let flag = self.value.as_bool().map(|flag| f64::from(u8::from(flag)));
        let number = flag.or_else(|| self.value.as_f64());
        let number = number.ok_or_else(|| self.expected("a number"))?;
        if !number.is_finite() || number.abs() >= 1e7 {
            return Err(self.error(
                format!("{number} is too large for a garment"),
                "check the units of the file",
            ));
        }
        Ok(number)
    }

    /// An index from 0.
    pub fn index(&self) -> Result<usize, FormatError> {
        let number = self.number()?;
        if number < 0.0 || number.fract() != 0.0 {
            return Err(self.expected("a whole number from 0"));
        }
        Ok(number as usize)
    }

    /// A text.
    pub fn text(&self) -> Result<&'a str, FormatError> {
        self.value.as_str().ok_or_else(|| self.expected("a text"))
    }

    /// Notes the fields that this reader does not know.
    pub fn unknown_fields(&self, known: &[&str], notes: &mut Vec<FormatError>) {
        for name in self.value.as_object().into_iter().flat_map(|o| o.keys()) {
            if !known.contains(&name.as_str()) {
                notes.push(self.error(
                    format!("the field \"{name}\" is not known and is left out"),
                    "nothing need be done unless it matters to you",
                ));
            }
        }
    }
}
