//! Nodes and routes of a VRML 97 or X3D (XML) file, as far as a motion needs them.

use crate::FormatError;
use std::collections::BTreeMap;

/// A node: its type, DEF and the fields that hold numbers or words.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Node {
    pub(crate) kind: String,
    pub(crate) name: String,
    pub(crate) line: usize,
    fields: BTreeMap<String, Vec<String>>,
}

impl Node {
    /// The numbers of a field; those that are none were refused before.
    pub(crate) fn numbers(&self, field: &str) -> Vec<f64> {
        let words = self.fields.get(field).into_iter().flatten();
        words.filter_map(|word| word.parse().ok()).collect()
    }

    /// A field's only word.
    pub(crate) fn text(&self, field: &str) -> Option<&str> {
        self.fields.get(field)?.first().map(String::as_str)
    }

    /// Whether a field says so.
    pub(crate) fn is_true(&self, field: &str) -> bool {
        self.text(field)
            .is_some_and(|word| word.eq_ignore_ascii_case("true"))
    }
}

/// A route from one node to another.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Route {
    pub(crate) from: String,
    pub(crate) to: String,
    pub(crate) line: usize,
}

/// What a file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Scene {
    pub(crate) nodes: Vec<Node>,
    pub(crate) routes: Vec<Route>,
}

impl Scene {
    /// The node of a DEF.
    pub(crate) fn named(&self, name: &str) -> Option<&Node> {
        self.nodes.iter().find(|node| node.name == name)
    }
}

/// Fields whose words must be numbers.
const NUMBERS: [&str; 4] = ["key", "keyValue", "center", "cycleInterval"];
/// Other fields that are kept.
const WORDS: [&str; 2] = ["name", "loop"];

/// Reads either encoding, by how the file begins.
pub(crate) fn read_scene(text: &str) -> Result<Scene, FormatError> {
    let start = text.trim_start();
    let scene = if start.starts_with('<') {
        read_xml(text)?
    } else if start.starts_with("#VRML") || start.starts_with("#X3D") {
        read_vrml(text)?
    } else {
        return Err(FormatError::new(
            "line 1",
            "the file begins neither as VRML (#VRML V2.0 utf8) nor as X3D (<X3D>)",
            "export the motion again as VRML 97 or X3D",
        ));
    };
    for node in &scene.nodes {
        for field in NUMBERS {
            let words = node.fields.get(field).into_iter().flatten();
            for word in words {
                if !word.parse::<f64>().is_ok_and(f64::is_finite) {
                    let shown: String = word.chars().take(40).collect();
                    return Err(FormatError::new(
                        format!("line {}, {} {}", node.line, node.kind, node.name),
                        format!("{shown:?} in {field} is not a number"),
                        "correct it",
                    ));
                }
            }
        }
    }
    Ok(scene)
}

/// Words and brackets of VRML with their lines; strings without quotes.
fn tokens(text: &str) -> Vec<(usize, String, bool)> {
    let mut all = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let mut word = String::new();
        let mut quoted = false;
        let mut flush = |word: &mut String, quoted: bool| {
            if !word.is_empty() {
                all.push((number + 1, std::mem::take(word), quoted));
            }
        };
        for c in line.chars() {
            match c {
                '"' => {
                    flush(&mut word, quoted);
                    quoted = !quoted;
                }
                _ if quoted => word.push(c),
                '#' => break,
                '{' | '}' | '[' | ']' => {
                    flush(&mut word, false);
                    word.push(c);
                    flush(&mut word, false);
                }
                ',' => flush(&mut word, false),
                c if c.is_whitespace() => flush(&mut word, false),
                c => word.push(c),
            }
        }
        flush(&mut word, quoted);
    }
    all
}

fn read_vrml(text: &str) -> Result<Scene, FormatError> {
    let words = tokens(text);
    let mut scene = Scene::default();
    let mut open: Vec<usize> = Vec::new();
    let word = |k: usize| words.get(k).map_or("", |w| w.1.as_str());
    let mut k = 0;
    while k < words.len() {
        let (line, token, quoted) = (words[k].0, word(k), words[k].2);
        match token {
            "{" if !quoted => {
                let kind = k.checked_sub(1).map_or("", word);
                let name = match k >= 3 && word(k - 3) == "DEF" {
                    true => word(k - 2),
                    false => "",
                };
                scene.nodes.push(Node {
                    kind: kind.to_owned(),
                    name: name.to_owned(),
                    line: words[k.saturating_sub(1)].0,
                    fields: BTreeMap::new(),
                });
                open.push(scene.nodes.len() - 1);
            }
            "}" if !quoted => {
                open.pop().ok_or_else(|| {
                    FormatError::new(
                        format!("line {line}"),
                        "a bracket closes what is not open",
                        "export the motion again",
                    )
                })?;
            }
            "ROUTE" => {
                let node = |text: &str| text.split('.').next().unwrap_or_default().to_owned();
                if word(k + 2) != "TO" {
                    return Err(FormatError::new(
                        format!("line {line}, ROUTE"),
                        "it does not say from where to where",
                        "write ROUTE node.field TO node.field",
                    ));
                }
                scene.routes.push(Route {
                    from: node(word(k + 1)),
                    to: node(word(k + 3)),
                    line,
                });
                k += 3;
            }
            field if NUMBERS.contains(&field) || WORDS.contains(&field) => {
                let (values, next) = values(&words, k + 1);
                if let Some(&node) = open.last() {
                    let own = &mut scene.nodes[node].fields;
                    own.insert(field.to_owned(), values);
                }
                k = next;
                continue;
            }
            _ => {}
        }
        k += 1;
    }
    match open.last() {
        None => Ok(scene),
        Some(&node) => {
            let node = &scene.nodes[node];
            Err(FormatError::new(
                format!("line {}, {} {}", node.line, node.kind, node.name),
                "the file ends within it",
                "export the motion again",
            ))
        }
    }
}

/// The words of a field from a place on: those in brackets, or the numbers that follow, or one
/// word. Also the place after them.
fn values(words: &[(usize, String, bool)], from: usize) -> (Vec<String>, usize) {
    let is = |k: usize, bracket: &str| words.get(k).is_some_and(|w| w.1 == bracket && !w.2);
    if is(from, "[") {
        let length = words[from + 1..]
            .iter()
            .take_while(|w| w.2 || !matches!(w.1.as_str(), "]" | "{" | "}"))
            .count();
        let own = words[from + 1..from + 1 + length].iter();
        let after = from + 1 + length + usize::from(is(from + 1 + length, "]"));
        return (own.map(|w| w.1.clone()).collect(), after);
    }
    let numbers = words[from.min(words.len())..]
        .iter()
        .take_while(|w| w.1.parse::<f64>().is_ok())
        .count();
    let bracket = (0..4).any(|k| is(from, ["{", "}", "[", "]"][k]));
    let count = match (numbers, bracket) {
        (0, false) => 1,
        (count, _) => count,
    };
    let to = (from + count).min(words.len());
    let own = words[from.min(to)..to].iter();
    (own.map(|w| w.1.clone()).collect(), to)
}

fn read_xml(text: &str) -> Result<Scene, FormatError> {
    let mut scene = Scene::default();
    let mut rest = text;
    let line_of = |rest: &str| 1 + text[..text.len() - rest.len()].matches('\n').count();
    while let Some(start) = rest.find('<') {
        rest = &rest[start..];
        let line = line_of(rest);
        let ending = if rest.starts_with("<!--") { "-->" } else { ">" };
        let Some(end) = rest.find(ending) else {
            return Err(FormatError::new(
                format!("line {line}"),
                "a tag does not end",
                "export the motion again",
            ));
        };
        let tag = rest[1..end].trim_end_matches('/');
        rest = &rest[end + ending.len()..];
        if tag.starts_with(['!', '?', '/']) {
            continue;
        }
        let kind: String = tag.chars().take_while(|c| !c.is_whitespace()).collect();
        let mut attributes = attributes(&tag[kind.len()..]);
        let mut take = |name: &str| attributes.remove(name).unwrap_or_default();
        if kind == "ROUTE" {
            scene.routes.push(Route {
                from: take("fromNode"),
                to: take("toNode"),
                line,
            });
            continue;
        }
        let name = take("DEF");
        let kept = NUMBERS.iter().chain(&WORDS);
        let fields = kept
            .filter_map(|&field| {
                let value = attributes.get(field)?;
                let words = value.split(|c: char| c.is_whitespace() || c == ',');
                let words = words.filter(|w| !w.is_empty()).map(str::to_owned);
                Some((field.to_owned(), words.collect()))
            })
            .collect();
        scene.nodes.push(Node {
            kind,
            name,
            line,
            fields,
        });
    }
    Ok(scene)
}

/// Attributes of a tag: `name='value'` or `name="value"`.
fn attributes(mut text: &str) -> BTreeMap<String, String> {
    let mut all = BTreeMap::new();
    while let Some(equals) = text.find('=') {
        let name = text[..equals].trim();
        let value = text[equals + 1..].trim_start();
        let Some(quote) = value.chars().next().filter(|c| matches!(c, '"' | '\'')) else {
            break;
        };
        let Some(end) = value[1..].find(quote) else {
            break;
        };
        let name = name.rsplit(char::is_whitespace).next().unwrap_or(name);
        all.insert(name.to_owned(), value[1..=end].to_owned());
        text = &value[end + 2..];
    }
    all
}
