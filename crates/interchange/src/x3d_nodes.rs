//! Nodes and routes of a VRML 97 or X3D file, as far as a motion needs them.

use crate::FormatError;
use std::collections::BTreeMap;

/// A node: type, DEF name, and the fields that hold numbers or words.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Node {
    pub(crate) kind: String,
    pub(crate) name: String,
    pub(crate) line: usize,
    pub(crate) fields: BTreeMap<String, Vec<String>>,
}

impl Node {
    /// Place of the node, for messages.
    pub(crate) fn place(&self) -> String {
        format!("line {}, {} {}", self.line, self.kind, self.name)
    }

    /// The numbers of a field; empty if the node does not have the field.
    pub(crate) fn numbers(&self, field: &str) -> Result<Vec<f64>, FormatError> {
        let number = |word: &String| match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let shown: String = word.chars().take(40).collect();
                let what = format!("{shown:?} in {field} is not a number");
                Err(FormatError::new(self.place(), what, "correct it"))
            }
        };
        let words = self.fields.get(field).into_iter().flatten();
        words.map(number).collect()
    }

    /// The first word of a field.
    pub(crate) fn text(&self, field: &str) -> Option<&str> {
        self.fields.get(field)?.first().map(String::as_str)
    }

    /// Whether a field is true.
    pub(crate) fn is_true(&self, field: &str) -> bool {
        self.text(field)
            .is_some_and(|word| word.eq_ignore_ascii_case("true"))
    }
}

/// A route from one node to a field of another.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Route {
    pub(crate) from: String,
    pub(crate) to: String,
    /// The target field, without the prefix `set_`.
    pub(crate) field: String,
    pub(crate) line: usize,
}

impl Route {
    pub(crate) fn new(from: &str, (to, field): (&str, &str), line: usize) -> Self {
        Self {
            from: from.to_owned(),
            to: to.to_owned(),
            field: field.strip_prefix("set_").unwrap_or(field).to_owned(),
            line,
        }
    }
}

/// The nodes and routes of a file, without prototypes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Scene {
    pub(crate) nodes: Vec<Node>,
    pub(crate) routes: Vec<Route>,
}

impl Scene {
    /// The node with a DEF name.
    pub(crate) fn named(&self, name: &str) -> Option<&Node> {
        self.nodes.iter().find(|node| node.name == name)
    }
}

/// Whether the values of a field are kept.
pub(crate) fn is_kept(field: &str) -> bool {
    matches!(
        field,
        "key" | "keyValue" | "center" | "cycleInterval" | "name" | "loop"
    )
}

/// The error for a file that ends inside an element.
pub(crate) fn ends_within(place: String) -> FormatError {
    FormatError::new(place, "the file ends within it", "export the motion again")
}

/// The error for a closing bracket without an opening one.
pub(crate) fn not_open(line: usize) -> FormatError {
    FormatError::new(
        format!("line {line}"),
        "what is closed here is not open",
        "export the motion again",
    )
}
