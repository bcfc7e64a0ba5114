//! Typed access to a JSON value that knows its path, so that every error can name the place.

use super::json::{Node, Value};
use super::units;
use crate::FormatError;
use toile_pattern::fields::{Clash, Kind, Told};
use toile_pattern::{
    Code, Diagnostic, DisplayUnit, Formula, Place, Severity, is_part_name, nearest,
};

/// A value and the path to it from the root.
#[derive(Clone)]
pub struct Item<'a> {
    pub node: &'a Node,
    pub path: String,
}

/// A number as written: a value (a length in m, an angle in rad, or a plain number) or the text of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Written<'a> {
    Value(f64),
    Formula(&'a str),
}

/// The fields of an object.
pub struct Object<'a> {
    pub item: Item<'a>,
    fields: &'a [(String, Node)],
}

impl<'a> Item<'a> {
    pub fn root(node: &'a Node) -> Self {
        Self {
            node,
            path: String::new(),
        }
    }

    fn child(&self, node: &'a Node, name: &str) -> Self {
        let path = if self.path.is_empty() {
            name.to_owned()
        } else {
            format!("{}.{name}", self.path)
        };
        Self { node, path }
    }

    pub fn error(&self, what: impl Into<String>, hint: impl Into<String>) -> FormatError {
        let at = if self.path.is_empty() {
            String::new()
        } else {
            format!(", at {}", self.path)
        };
        let place = format!("line {}, column {}{at}", self.node.line, self.node.column);
        FormatError::new(place, what, hint)
    }

    pub fn wrong_kind(&self, wanted: &str, hint: &str) -> FormatError {
        let what = format!(
            "{} stands where {wanted} is expected",
            self.node.value.kind()
        );
        self.error(what, hint)
    }

    pub fn text(&self) -> Result<&'a str, FormatError> {
        match &self.node.value {
            Value::Text(text) => Ok(text),
            Value::Null | Value::Flag(_) | Value::Number(_) | Value::List(_) | Value::Object(_) => {
                Err(self.wrong_kind("a text", "write it in quotes"))
            }
        }
    }

    /// A text that is a valid name of a part.
    pub fn name(&self) -> Result<&'a str, FormatError> {
        let name = self.text()?;
        self.check_name(name)?;
        Ok(name)
    }

    pub fn check_name(&self, name: &str) -> Result<(), FormatError> {
        if is_part_name(name) {
            return Ok(());
        }
        let shown: String = name.chars().take(40).collect();
        Err(self.error(
            format!("{shown:?} cannot be a name"),
            "use 1 to 80 characters without single quotes, control characters or outer spaces",
        ))
    }

    pub fn flag(&self) -> Result<bool, FormatError> {
        match self.node.value {
            Value::Flag(flag) => Ok(flag),
            Value::Null | Value::Number(_) | Value::Text(_) | Value::List(_) | Value::Object(_) => {
                Err(self.wrong_kind("true or false", "write true or false without quotes"))
            }
        }
    }

    pub fn list(&self) -> Result<Vec<Item<'a>>, FormatError> {
        match &self.node.value {
            Value::List(items) => Ok(items
                .iter()
                .enumerate()
                .map(|(k, node)| Item {
                    node,
                    path: format!("{}[{k}]", self.path),
                })
                .collect()),
            Value::Null | Value::Flag(_) | Value::Number(_) | Value::Text(_) | Value::Object(_) => {
                Err(self.wrong_kind("a list", "write it in [ ]"))
            }
        }
    }

    /// A list of exactly `wanted` items.
    pub fn exactly(&self, wanted: usize) -> Result<Vec<Item<'a>>, FormatError> {
        let items = self.list()?;
        match items.len() {
            count if count == wanted => Ok(items),
            count => Err(self.error(
                format!("the list has {count} items"),
                format!("give it {wanted}"),
            )),
        }
    }

    /// Every field as an item, in the order of the file.
    pub fn entries(&self) -> Result<Vec<(&'a str, Item<'a>)>, FormatError> {
        match &self.node.value {
            Value::Object(fields) => Ok(fields
                .iter()
                .map(|(name, node)| (name.as_str(), self.child(node, name)))
                .collect()),
            Value::Null | Value::Flag(_) | Value::Number(_) | Value::Text(_) | Value::List(_) => {
                Err(self.wrong_kind("an object", "write it in { }"))
            }
        }
    }

    /// The fields of an object; unknown fields are noted.
    pub fn object(
        &self,
        known: &[&str],
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Object<'a>, FormatError> {
        let object = self.fields()?;
        self.note_unknown(known, notes);
        Ok(object)
    }

    /// Notes the fields that are not among the known ones.
    pub fn note_unknown(&self, known: &[&str], notes: &mut Vec<Diagnostic>) {
        let Value::Object(fields) = &self.node.value else {
            return;
        };
        for (name, node) in fields {
            if known.contains(&name.as_str()) {
                continue;
            }
            let hint = match nearest(name, known.iter().copied()) {
                Some(near) => format!("did you mean {near:?}? It is ignored and will not be saved"),
                None => "it is ignored and will not be saved; remove it, or use a newer version"
                    .to_owned(),
            };
            notes.push(Diagnostic::new(
                Severity::Warning,
                Code::UnknownField,
                Place::File {
                    path: self.child(node, name).path,
                    line: node.line,
                    column: node.column,
                },
                format!("the field {name:?} is not known"),
                hint,
            ));
        }
    }

    /// The fields of an object, whatever their names.
    pub fn fields(&self) -> Result<Object<'a>, FormatError> {
        match &self.node.value {
            Value::Object(fields) => Ok(Object {
                item: self.clone(),
                fields,
            }),
            Value::Null | Value::Flag(_) | Value::Number(_) | Value::Text(_) | Value::List(_) => {
                Err(self.wrong_kind("an object", "write it in { }"))
            }
        }
    }

    fn not_finite(&self) -> FormatError {
        self.error(
            "the number is too large to be finite",
            "write a smaller one",
        )
    }

    /// Reads a number by the function `read`, or a formula. An object whose only key is `exact_unit`
    /// holds the number in that unit.
    fn read_number(
        &self,
        wanted: &str,
        exact_unit: Option<&str>,
        read: impl Fn(&str) -> Option<f64>,
    ) -> Result<Written<'a>, FormatError> {
        match &self.node.value {
            Value::Number(raw) => read(raw)
                .map(Written::Value)
                .ok_or_else(|| self.not_finite()),
            Value::Text(text) => match Formula::of_measurements(text) {
                Ok(_) => Ok(Written::Formula(text)),
                Err(error) => {
                    let what = format!(
                        "the formula {text:?}, column {}: {}",
                        error.column, error.message
                    );
                    Err(self.error(what, error.hint))
                }
            },
            Value::Object(fields) => match (&fields[..], exact_unit) {
                ([(name, node)], Some(unit)) if name == unit => {
                    self.child(node, name).plain_value().map(Written::Value)
                }
                _ => Err(self.wrong_kind(wanted, "write a number, or a formula in quotes")),
            },
            Value::Null | Value::Flag(_) | Value::List(_) => {
                Err(self.wrong_kind(wanted, "write a number, or a formula in quotes"))
            }
        }
    }

    pub fn length(&self, unit: DisplayUnit) -> Result<Written<'a>, FormatError> {
        self.read_number("a length", Some("m"), |raw| units::read_length(raw, unit))
    }

    pub fn angle(&self) -> Result<Written<'a>, FormatError> {
        self.read_number("an angle in degrees", Some("rad"), units::read_degrees)
    }

    pub fn plain(&self) -> Result<Written<'a>, FormatError> {
        self.read_number("a number", None, units::read_plain)
    }

    /// Whether the value is `null`.
    pub fn is_null(&self) -> bool {
        matches!(self.node.value, Value::Null)
    }

    /// A plain number; a formula is refused.
    pub fn plain_value(&self) -> Result<f64, FormatError> {
        match &self.node.value {
            Value::Number(raw) => units::read_plain(raw).ok_or_else(|| self.not_finite()),
            Value::Null | Value::Flag(_) | Value::Text(_) | Value::List(_) | Value::Object(_) => {
                Err(self.wrong_kind("a number", "write it without quotes"))
            }
        }
    }

    /// The value of a length (m) or an angle (rad); a formula is refused.
    pub fn fixed(&self, number: &Written<'_>) -> Result<f64, FormatError> {
        match number {
            Written::Value(value) => Ok(*value),
            Written::Formula(_) => Err(self.error(
                "a formula stands where a number is expected",
                "write the number; formulas belong in variables and panels",
            )),
        }
    }

    pub fn count(&self) -> Result<u32, FormatError> {
        match &self.node.value {
            Value::Number(raw) => raw.parse().map_err(|_| {
                self.error(
                    format!("{raw} is not a whole number from 0 to {}", u32::MAX),
                    "write a whole number",
                )
            }),
            Value::Null | Value::Flag(_) | Value::Text(_) | Value::List(_) | Value::Object(_) => {
                Err(self.wrong_kind("a whole number", "write it without quotes"))
            }
        }
    }

    /// A word of the closed list `words`; returns its index in the list.
    pub fn word(&self, words: &[&str]) -> Result<usize, FormatError> {
        let word = self.text()?;
        let found = words.iter().position(|known| *known == word);
        found.ok_or_else(|| {
            self.error(
                format!("{word:?} is not known here"),
                format!("use one of {}", words.join(", ")),
            )
        })
    }
}

impl<'a> Object<'a> {
    pub fn get(&self, name: &str) -> Option<Item<'a>> {
        self.fields
            .iter()
            .find(|(field, _)| field == name)
            .map(|(_, node)| self.item.child(node, name))
    }

    pub fn need(&self, name: &str) -> Result<Item<'a>, FormatError> {
        self.get(name).ok_or_else(|| {
            self.item.error(
                format!("the field {name:?} is missing"),
                format!("add {name:?}"),
            )
        })
    }

    /// Index of the object's kind: the first of `kinds` whose distinguishing fields are all present. An object
    /// with fields of two kinds is refused, since the fields of one would be lost. An object of no kind is
    /// refused if `clash` says so; otherwise `None` is returned.
    pub fn kind(&self, kinds: &[Kind], clash: &Clash) -> Result<Option<usize>, FormatError> {
        let tells = |kind: &Kind| match kind.told {
            Told::Field(_) | Told::By(_) => {
                kind.telling().iter().all(|field| self.get(field).is_some())
            }
            Told::Number | Told::Text | Told::Never => false,
        };
        let Some(chosen) = kinds.iter().position(tells) else {
            return match &clash.none {
                Some([what, hint]) => Err(self.item.error(what, hint)),
                None => Ok(None),
            };
        };
        let own = &kinds[chosen];
        for (name, node) in self.fields {
            let is = |kind: &Kind| kind.keys.contains(&name.as_str());
            if is(own) || !kinds.iter().any(is) {
                continue;
            }
            let place = self.item.child(node, name);
            if let Some([what, hint]) = clash.two {
                return Err(place.error(what, hint));
            }
            let telling = own.telling().iter().map(|field| format!("{field:?}"));
            let beside = match telling.collect::<Vec<_>>().join(" and ") {
                none if none.is_empty() => "without the field that it belongs to".to_owned(),
                fields => format!("beside {fields}, with which it does not go"),
            };
            return Err(place.error(
                format!("the field {name:?} stands {beside}"),
                "keep the fields of one kind",
            ));
        }
        Ok(Some(chosen))
    }

    /// The items of a list; empty if the field is missing.
    pub fn items(&self, name: &str) -> Result<Vec<Item<'a>>, FormatError> {
        self.get(name).map_or(Ok(Vec::new()), |item| item.list())
    }
}
