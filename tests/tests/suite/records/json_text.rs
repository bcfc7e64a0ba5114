//! Finds the fields of a JSON text and their places in it, so that a fault can be put into one of them.

use std::ops::Range;

/// A field of a JSON text.
#[derive(Clone)]
pub struct Field {
    /// Path from the root, indices of lists in brackets.
    pub path: String,
    /// The object it is in.
    pub object: usize,
    /// Its name.
    pub name: String,
    /// Where name and value stand together in the text.
    pub whole: Range<usize>,
    /// Where the value stands.
    pub value: Range<usize>,
}

/// An object of a JSON text.
pub struct Object {
    /// Path from the root.
    pub path: String,
    /// Where its first field begins, or its closing bracket where it has none.
    pub inside: usize,
    /// Names of its fields.
    pub names: Vec<String>,
}

/// All fields and objects of a sound JSON text.
#[derive(Default)]
pub struct Fields {
    pub fields: Vec<Field>,
    pub objects: Vec<Object>,
}

impl Fields {
    /// Of a text that is known to be JSON.
    pub fn of(text: &str) -> Self {
        let mut found = Self::default();
        let end = found.value(text.as_bytes(), skip(text.as_bytes(), 0), "");
        assert_eq!(text[end..].trim(), "", "the text is one value");
        found
    }

    /// Reads the value that begins at a place; returns where it ends.
    fn value(&mut self, text: &[u8], at: usize, path: &str) -> usize {
        match text[at] {
            b'{' => self.object(text, at, path),
            b'[' => self.list(text, at, path),
            b'"' => string_end(text, at),
            _ => {
                let ends = |byte: &u8| b",]} \n".contains(byte);
                at + text[at..].iter().position(ends).unwrap()
            }
        }
    }

    fn object(&mut self, text: &[u8], start: usize, path: &str) -> usize {
        let mut at = skip(text, start + 1);
        let own = self.objects.len();
        self.objects.push(Object {
            path: path.to_owned(),
            inside: at,
            names: Vec::new(),
        });
        while text[at] != b'}' {
            let name_end = string_end(text, at);
            let name = std::str::from_utf8(&text[at + 1..name_end - 1])
                .unwrap()
                .to_owned();
            let begin = skip(text, skip(text, name_end) + 1);
            let path = match path {
                "" => name.clone(),
                path => format!("{path}.{name}"),
            };
            self.objects[own].names.push(name.clone());
            let place = self.fields.len();
            self.fields.push(Field {
                path: path.clone(),
                object: own,
                name,
                whole: at..at,
                value: begin..begin,
            });
            let end = self.value(text, begin, &path);
            self.fields[place].whole = at..end;
            self.fields[place].value = begin..end;
            at = after_comma(text, end);
        }
        at + 1
    }

    fn list(&mut self, text: &[u8], start: usize, path: &str) -> usize {
        let mut at = skip(text, start + 1);
        let mut k = 0;
        while text[at] != b']' {
            let end = self.value(text, at, &format!("{path}[{k}]"));
            at = after_comma(text, end);
            k += 1;
        }
        at + 1
    }
}

/// The place of the next byte that is no space.
fn skip(text: &[u8], from: usize) -> usize {
    let space = |byte: &u8| !byte.is_ascii_whitespace();
    from + text[from..].iter().position(space).unwrap_or(0)
}

/// Beyond a comma, if one follows.
fn after_comma(text: &[u8], from: usize) -> usize {
    let at = skip(text, from);
    match text[at] {
        b',' => skip(text, at + 1),
        _ => at,
    }
}

/// Beyond the closing quote of a text that begins at a place.
fn string_end(text: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while text[at] != b'"' {
        at += if text[at] == b'\\' { 2 } else { 1 };
    }
    at + 1
}

/// The text with a stretch of it replaced.
pub fn replaced(text: &str, stretch: Range<usize>, by: &str) -> String {
    format!("{}{by}{}", &text[..stretch.start], &text[stretch.end..])
}

/// The text without a field.
pub fn without(text: &str, field: &Field) -> String {
    let bytes = text.as_bytes();
    let end = after_comma(bytes, field.whole.end);
    if text[field.whole.end..end].contains(',') {
        return replaced(text, field.whole.start..end, "");
    }
    let before = text[..field.whole.start].trim_end();
    let start = match before.ends_with(',') {
        true => before.len() - 1,
        false => field.whole.start,
    };
    replaced(text, start..field.whole.end, "")
}

/// A path without the numbers in its brackets.
pub fn without_numbers(path: &str) -> String {
    path.chars().filter(|c| !c.is_ascii_digit()).collect()
}
