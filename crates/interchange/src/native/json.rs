//! JSON for files written by hand: it records the place of every value, the order of fields and numbers as
//! they were written, and refuses fields given twice.

use crate::FormatError;
use std::collections::BTreeSet;

/// Largest number of lists and objects inside one another. No file of this program nests deeper than ten.
const DEEPEST: usize = 64;

/// A value and its position in the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// A JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `null`
    Null,
    /// `true` or `false`
    Flag(bool),
    /// A number as written.
    Number(String),
    /// A text.
    Text(String),
    /// A list.
    List(Vec<Node>),
    /// Fields in the order of the file.
    Object(Vec<(String, Node)>),
}

impl Value {
    /// Kind of the value in words.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Null => "null",
            Self::Flag(_) => "true or false",
            Self::Number(_) => "a number",
            Self::Text(_) => "a text",
            Self::List(_) => "a list",
            Self::Object(_) => "an object",
        }
    }
}

/// Reads a JSON text (RFC 8259).
pub fn parse(text: &str) -> Result<Node, FormatError> {
    let mut parser = Parser {
        rest: text
            .strip_prefix('\u{feff}')
            .unwrap_or(text)
            .chars()
            .peekable(),
        line: 1,
        column: 1,
        depth: 0,
    };
    let node = parser.value()?;
    parser.skip_space();
    match parser.rest.peek() {
        None => Ok(node),
        Some(&c) => Err(parser.error(
            format!("{:?} follows the end of the file's content", c.to_string()),
            "remove it, or look for a bracket closed too early",
        )),
    }
}

struct Parser<'a> {
    rest: std::iter::Peekable<std::str::Chars<'a>>,
    line: usize,
    column: usize,
    depth: usize,
}

impl Parser<'_> {
    fn error(&self, what: impl Into<String>, hint: &str) -> FormatError {
        let place = format!("line {}, column {}", self.line, self.column);
        FormatError::new(place, what, hint)
    }

    fn unexpected(&mut self, wanted: &str) -> FormatError {
        match self.rest.peek().copied() {
            Some(c) => {
                let what = format!("{:?} stands where {wanted} is expected", c.to_string());
                self.error(
                    what,
                    "look for a missing quote, comma or bracket just before",
                )
            }
            None => self.error(
                format!("the text ends where {wanted} is expected"),
                "the file is cut short: use a complete copy",
            ),
        }
    }

    fn next(&mut self) -> Option<char> {
        let c = self.rest.next()?;
        if c == '\n' {
            self.line += 1;
            self.column = 1;
        } else {
            self.column += 1;
        }
        Some(c)
    }

    fn skip_space(&mut self) {
        while let Some(' ' | '\t' | '\n' | '\r') = self.rest.peek() {
            self.next();
        }
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.rest.peek() == Some(&wanted);
        if found {
            self.next();
        }
        found
    }

    fn value(&mut self) -> Result<Node, FormatError> {
        self.skip_space();
        let (line, column) = (self.line, self.column);
        let value = match self.rest.peek() {
            Some('{') => self.nested(Self::object)?,
            Some('[') => self.nested(Self::list)?,
            Some('"') => Value::Text(self.text()?),
            Some(c) if c.is_ascii_digit() || *c == '-' => Value::Number(self.number()?),
            Some(c) if c.is_ascii_alphabetic() => self.word()?,
            _ => return Err(self.unexpected("a value")),
        };
        Ok(Node {
            value,
            line,
            column,
        })
    }

    fn nested(
        &mut self,
        read: fn(&mut Self) -> Result<Value, FormatError>,
    ) -> Result<Value, FormatError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.error(
                format!("brackets are nested deeper than {DEEPEST} levels"),
                "this is not a file of this program: use another one",
            ));
        }
        self.next();
        let value = read(self);
        self.depth -= 1;
        value
    }

    fn object(&mut self) -> Result<Value, FormatError> {
        let mut fields = Vec::new();
        let mut names = BTreeSet::new();
        self.skip_space();
        if self.take('}') {
            return Ok(Value::Object(fields));
        }
        loop {
            self.skip_space();
            if self.rest.peek() != Some(&'"') {
                return Err(self.unexpected("the name of a field in quotes"));
            }
            let place = (self.line, self.column);
            let name = self.text()?;
            if !names.insert(name.clone()) {
                (self.line, self.column) = place;
                return Err(self.error(
                    format!("the field {name:?} is given twice"),
                    "remove or rename one of them",
                ));
            }
            self.skip_space();
            if !self.take(':') {
                return Err(self.unexpected("a colon"));
            }
            fields.push((name, self.value()?));
            self.skip_space();
            if self.take('}') {
                return Ok(Value::Object(fields));
            }
            if !self.take(',') {
                return Err(self.unexpected("a comma or }"));
            }
        }
    }

    fn list(&mut self) -> Result<Value, FormatError> {
        let mut items = Vec::new();
        self.skip_space();
        if self.take(']') {
            return Ok(Value::List(items));
        }
        loop {
            items.push(self.value()?);
            self.skip_space();
            if self.take(']') {
                return Ok(Value::List(items));
            }
            if !self.take(',') {
                return Err(self.unexpected("a comma or ]"));
            }
        }
    }

    fn word(&mut self) -> Result<Value, FormatError> {
        let mut ahead = self.rest.clone();
        let mut word = String::new();
        while let Some(c) = ahead.next_if(|c| c.is_ascii_alphanumeric()) {
            word.push(c);
            if word.len() > 20 {
                break;
            }
        }
        let value = match word.as_str() {
            "true" => Value::Flag(true),
            "false" => Value::Flag(false),
            "null" => Value::Null,
            _ => {
                return Err(self.error(
                    format!("{word} is not a value"),
                    "write a finite number, true, false, or a text in quotes",
                ));
            }
        };
        for _ in 0..word.len() {
            self.next();
        }
        Ok(value)
    }

    fn digits(&mut self, into: &mut String) -> Result<(), FormatError> {
        if !self.rest.peek().is_some_and(char::is_ascii_digit) {
            return Err(self.unexpected("a digit"));
        }
        while let Some(&c) = self.rest.peek().filter(|c| c.is_ascii_digit()) {
            into.push(c);
            self.next();
        }
        Ok(())
    }

    fn number(&mut self) -> Result<String, FormatError> {
        let mut number = String::new();
        if self.take('-') {
            number.push('-');
        }
        if self.take('0') {
            number.push('0');
            if self.rest.peek().is_some_and(char::is_ascii_digit) {
                return Err(self.error("a number starts with 0", "remove the leading zero"));
            }
        } else {
            self.digits(&mut number)?;
        }
        if self.take('.') {
            number.push('.');
            self.digits(&mut number)?;
        }
        if self.take('e') || self.take('E') {
            number.push('e');
            if self.take('-') {
                number.push('-');
            } else {
                self.take('+');
            }
            self.digits(&mut number)?;
        }
        Ok(number)
    }

    fn text(&mut self) -> Result<String, FormatError> {
        self.next();
        let mut text = String::new();
        loop {
            match self.rest.peek().copied() {
                Some('"') => {
                    self.next();
                    return Ok(text);
                }
                Some('\\') => {
                    self.next();
                    text.push(self.escape()?);
                }
                Some(c) if (c as u32) < 0x20 => {
                    return Err(self.error(
                        "a text contains a control character",
                        "close the quote, or write the character as \\n, \\t or \\u....",
                    ));
                }
                Some(c) => {
                    self.next();
                    text.push(c);
                }
                None => return Err(self.unexpected("a closing quote")),
            }
        }
    }

    fn escape(&mut self) -> Result<char, FormatError> {
        let c = match self.rest.peek() {
            Some('"') => '"',
            Some('\\') => '\\',
            Some('/') => '/',
            Some('b') => '\u{8}',
            Some('f') => '\u{c}',
            Some('n') => '\n',
            Some('r') => '\r',
            Some('t') => '\t',
            Some('u') => {
                self.next();
                return self.unicode();
            }
            _ => return Err(self.unexpected("one of \" \\ / b f n r t u after a backslash")),
        };
        self.next();
        Ok(c)
    }

    fn hexadecimal(&mut self) -> Result<u32, FormatError> {
        let mut code = 0;
        for _ in 0..4 {
            let digit = self.rest.peek().and_then(|c| c.to_digit(16));
            code = code * 16 + digit.ok_or_else(|| self.unexpected("a hexadecimal digit"))?;
            self.next();
        }
        Ok(code)
    }

    fn unicode(&mut self) -> Result<char, FormatError> {
        let mut code = self.hexadecimal()?;
        if (0xd800..0xdc00).contains(&code) && self.take('\\') {
            if !self.take('u') {
                return Err(self.unexpected("the second half of a surrogate pair"));
            }
            let low = self.hexadecimal()?;
            if (0xdc00..0xe000).contains(&low) {
                code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
            }
        }
        char::from_u32(code).ok_or_else(|| {
            self.error(
                "an escape is not a character",
                "write the character itself instead of \\u....",
            )
        })
    }
}

/// Largest line length of a file (characters).
const LINE_WIDTH: usize = 100;

/// Writes a value: short lists and objects on one line, longer ones with one line per item.
pub fn write(value: &Value) -> String {
    let mut text = String::new();
    lay_out(value, 0, 0, &mut text);
    text.push('\n');
    text
}

/// Writes `value` on a line that is indented by `indent`, after the `used` columns already written on it.
fn lay_out(value: &Value, indent: usize, used: usize, text: &mut String) {
    let room = LINE_WIDTH.saturating_sub(used);
    let mut line = String::new();
    if indent > 0 && inline(value, room, &mut line) {
        text.push_str(&line);
        return;
    }
    let inner = indent + 2;
    let new_line = |text: &mut String, indent: usize| {
        text.push('\n');
        text.extend(std::iter::repeat_n(' ', indent));
    };
    match value {
        Value::List(items) if !items.is_empty() => {
            text.push('[');
            for (k, item) in items.iter().enumerate() {
                if k > 0 {
                    text.push(',');
                }
                new_line(text, inner);
                lay_out(&item.value, inner, inner, text);
            }
            new_line(text, indent);
            text.push(']');
        }
        Value::Object(fields) if !fields.is_empty() => {
            text.push('{');
            for (k, (name, item)) in fields.iter().enumerate() {
                if k > 0 {
                    text.push(',');
                }
                new_line(text, inner);
                let before = text.len();
                quote(name, text);
                text.push_str(": ");
                let used = inner + text[before..].chars().count();
                lay_out(&item.value, inner, used, text);
            }
            new_line(text, indent);
            text.push('}');
        }
        Value::Null
        | Value::Flag(_)
        | Value::Number(_)
        | Value::Text(_)
        | Value::List(_)
        | Value::Object(_) => {
            inline(value, usize::MAX, text);
        }
    }
}

/// Writes a value on one line; returns whether it fits into `room` (characters).
fn inline(value: &Value, room: usize, line: &mut String) -> bool {
    match value {
        Value::Null => line.push_str("null"),
        Value::Flag(flag) => line.push_str(if *flag { "true" } else { "false" }),
        Value::Number(number) => line.push_str(number),
        Value::Text(text) => quote(text, line),
        Value::List(items) => {
            line.push('[');
            for (k, item) in items.iter().enumerate() {
                if k > 0 {
                    line.push_str(", ");
                }
                if !inline(&item.value, room, line) {
                    return false;
                }
            }
            line.push(']');
        }
        Value::Object(fields) => {
            line.push('{');
            for (k, (name, item)) in fields.iter().enumerate() {
                if k > 0 {
                    line.push_str(", ");
                }
                quote(name, line);
                line.push_str(": ");
                if !inline(&item.value, room, line) {
                    return false;
                }
            }
            line.push('}');
        }
    }
    line.len() <= room
}

fn quote(content: &str, text: &mut String) {
    text.push('"');
    for c in content.chars() {
        match c {
            '"' => text.push_str("\\\""),
            '\\' => text.push_str("\\\\"),
            '\n' => text.push_str("\\n"),
            '\t' => text.push_str("\\t"),
            '\r' => text.push_str("\\r"),
            c if (c as u32) < 0x20 => text.push_str(&format!("\\u{:04x}", c as u32)),
            c => text.push(c),
        }
    }
    text.push('"');
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn same(ours: &Node, theirs: &serde_json::Value) -> bool {
        match (&ours.value, theirs) {
            (Value::Null, serde_json::Value::Null) => true,
            (Value::Flag(a), serde_json::Value::Bool(b)) => a == b,
            (Value::Number(a), serde_json::Value::Number(b)) => a.parse::<f64>().ok() == b.as_f64(),
            (Value::Text(a), serde_json::Value::String(b)) => a == b,
            (Value::List(a), serde_json::Value::Array(b)) => {
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b))
            }
            (Value::Object(a), serde_json::Value::Object(b)) => {
                a.len() == b.len() && a.iter().all(|(k, v)| b.get(k).is_some_and(|b| same(v, b)))
            }
            _ => false,
        }
    }

    #[test]
    fn refusals_name_the_place() {
        for (text, line, column, says) in [
            ("", 1, 1, "ends"),
            ("{\n  \"a\": }", 2, 8, "a value"),
            ("{\"a\": 1, \"a\": 2}", 1, 10, "twice"),
            ("[1, 2", 1, 6, "comma"),
            ("NaN", 1, 1, "NaN is not a value"),
            ("[-Infinity]", 1, 3, "a digit"),
            ("01", 1, 2, "starts with 0"),
            ("\"ab", 1, 4, "closing quote"),
            ("\"\\q\"", 1, 3, "backslash"),
            ("\"\\ud800\"", 1, 8, "not a character"),
            ("{} x", 1, 4, "follows the end"),
            ("\"a\nb\"", 1, 3, "control character"),
        ] {
            let error = parse(text).unwrap_err();
            assert_eq!(
                error.place,
                format!("line {line}, column {column}"),
                "{text}"
            );
            assert!(error.what.contains(says), "{text}: {error}");
        }
        assert!(parse(&"[".repeat(100_000)).is_err());
    }

    proptest! {
        #[test]
        fn agrees_with_serde_json(text in "[\\[\\]{},:\"a1.e \\\\u0-]{0,24}") {
            match (parse(&text), serde_json::from_str::<serde_json::Value>(&text)) {
                (Ok(ours), Ok(theirs)) => {
                    prop_assert!(same(&ours, &theirs));
                    prop_assert!(same(&parse(&write(&ours.value)).unwrap(), &theirs));
                }
                (Ok(_), Err(error)) => prop_assert!(error.to_string().contains("out of range")),
                (Err(error), Ok(_)) => prop_assert!(error.what.contains("twice")),
                (Err(_), Err(_)) => {}
            }
        }

        #[test]
        fn texts_survive(text in any::<String>()) {
            let written = write(&Value::Text(text.clone()));
            prop_assert_eq!(parse(&written).unwrap().value, Value::Text(text.clone()));
            prop_assert_eq!(serde_json::from_str::<String>(&written).unwrap(), text);
        }
    }
}
