//! VRML 97 and the classic encoding of X3D (ISO/IEC 14772, 19776-2): words, strings and brackets.

use crate::FormatError;
use crate::x3d_nodes::{Node, Route, Scene, ends_within, is_kept, not_open};
use std::collections::BTreeMap;
use std::iter::Peekable;
use std::str::Chars;

/// A token of a file.
#[derive(Clone, Debug, PartialEq)]
enum Token {
    Word(String),
    /// A string, without its quotes.
    Quoted(String),
    Bracket(char),
}

impl Token {
    fn is(&self, bracket: char) -> bool {
        *self == Self::Bracket(bracket)
    }

    /// The text of a word or string.
    fn text(&self) -> &str {
        match self {
            Self::Word(text) | Self::Quoted(text) => text,
            Self::Bracket(_) => "",
        }
    }
}

/// Tokens with their line numbers, without comments.
fn tokens(text: &str) -> Result<Vec<(usize, Token)>, FormatError> {
    let mut all = Vec::new();
    let mut line = 1;
    let mut word = String::new();
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        if !(c.is_whitespace() || "\"#,{}[]".contains(c)) {
            word.push(c);
            continue;
        }
        if !word.is_empty() {
            all.push((line, Token::Word(std::mem::take(&mut word))));
        }
        match c {
            '"' => {
                let start = line;
                let string = quoted(&mut chars, &mut line);
                let string =
                    string.ok_or_else(|| ends_within(format!("line {start}, a string")))?;
                all.push((start, Token::Quoted(string)));
            }
            '#' => while chars.next_if(|c| !matches!(c, '\n' | '\r')).is_some() {},
            '{' | '}' | '[' | ']' => all.push((line, Token::Bracket(c))),
            _ => line += usize::from(ends_line(c, &mut chars)),
        }
    }
    if !word.is_empty() {
        all.push((line, Token::Word(word)));
    }
    Ok(all)
}

/// Whether a line ends with this character; `\r\n` counts as one line end.
fn ends_line(c: char, rest: &mut Peekable<Chars<'_>>) -> bool {
    c == '\n' || (c == '\r' && rest.peek() != Some(&'\n'))
}

/// The rest of a string after its opening quote; `None` if the string does not end.
fn quoted(chars: &mut Peekable<Chars<'_>>, line: &mut usize) -> Option<String> {
    let mut string = String::new();
    loop {
        let c = chars.next()?;
        match c {
            '"' => return Some(string),
            '\\' => string.push(chars.next()?),
            c => string.push(c),
        }
        *line += usize::from(ends_line(c, chars));
    }
}

pub(crate) fn read(text: &str) -> Result<Scene, FormatError> {
    let tokens = tokens(text)?;
    let mut scene = Scene::default();
    let mut open: Vec<usize> = Vec::new();
    let mut k = 0;
    while let Some((line, token)) = tokens.get(k) {
        match token {
            Token::Bracket('{') => {
                scene.nodes.push(begun(&tokens, k));
                open.push(scene.nodes.len() - 1);
            }
            Token::Bracket('}') => {
                open.pop().ok_or_else(|| not_open(*line))?;
            }
            Token::Word(word) if word == "PROTO" || word == "EXTERNPROTO" => {
                k = after_prototype(&tokens, k)?;
                continue;
            }
            Token::Word(word) if word == "ROUTE" => {
                scene.routes.push(route(&tokens, k)?);
                k += 3;
            }
            Token::Word(word) if is_kept(word) => {
                let (values, next) = values(&tokens, k + 1);
                if let (Some(&node), Some(values)) = (open.last(), values) {
                    scene.nodes[node].fields.insert(word.clone(), values);
                }
                k = next;
                continue;
            }
            Token::Word(_) | Token::Quoted(_) | Token::Bracket(_) => {}
        }
        k += 1;
    }
    match open.last() {
        None => Ok(scene),
        Some(&node) => Err(ends_within(scene.nodes[node].place())),
    }
}

/// The node whose opening bracket is at an index.
fn begun(tokens: &[(usize, Token)], at: usize) -> Node {
    let word = |back: usize| {
        let token = at.checked_sub(back).map(|k| &tokens[k].1);
        token.map_or("", Token::text)
    };
    Node {
        kind: word(1).to_owned(),
        name: if word(3) == "DEF" { word(2) } else { "" }.to_owned(),
        line: tokens[at.saturating_sub(1)].0,
        fields: BTreeMap::new(),
    }
}

/// The index after a prototype, which is skipped: its fields belong to no node, and its body is not part of
/// the scene.
fn after_prototype(tokens: &[(usize, Token)], at: usize) -> Result<usize, FormatError> {
    let (line, word) = (tokens[at].0, tokens[at].1.text());
    let name = tokens.get(at + 1).map_or("", |t| t.1.text());
    let place = || format!("line {line}, {word} {name}");
    let interface = after_brackets(tokens, at + 2).ok_or_else(|| ends_within(place()))?;
    match word {
        "PROTO" => after_brackets(tokens, interface).ok_or_else(|| ends_within(place())),
        _ => Ok(interface),
    }
}

/// The index after the bracket that closes the one at `from`; `from` itself if no bracket opens there; `None`
/// if the bracket is not closed.
fn after_brackets(tokens: &[(usize, Token)], from: usize) -> Option<usize> {
    let mut depth = 0;
    for (k, (_, token)) in tokens.iter().enumerate().skip(from) {
        match token {
            Token::Bracket('{' | '[') => depth += 1,
            Token::Bracket(_) => depth -= 1,
            Token::Word(_) | Token::Quoted(_) => {}
        }
        if depth <= 0 {
            return Some(if k == from { k } else { k + 1 });
        }
    }
    None
}

fn route(tokens: &[(usize, Token)], at: usize) -> Result<Route, FormatError> {
    let word = |k: usize| tokens.get(k).map_or("", |t| t.1.text());
    let line = tokens[at].0;
    if word(at + 2) != "TO" {
        return Err(FormatError::new(
            format!("line {line}, ROUTE"),
            "it does not say from where to where",
            "write ROUTE node.field TO node.field",
        ));
    }
    let parts = |k: usize| word(k).split_once('.').unwrap_or((word(k), ""));
    Ok(Route::new(parts(at + 1).0, parts(at + 3), line))
}

/// The words of a field that starts at `from`: the words in brackets, or consecutive numbers, or one word;
/// `None` for a field taken from a prototype. Also returns the index after these words.
fn values(tokens: &[(usize, Token)], from: usize) -> (Option<Vec<String>>, usize) {
    let rest = tokens.get(from..).unwrap_or_default();
    let listed = |part: &[(usize, Token)]| {
        let words = part.iter().map(|t| t.1.text().to_owned());
        Some(words.collect())
    };
    match rest.first() {
        Some((_, Token::Word(word))) if word == "IS" => (None, (from + 2).min(tokens.len())),
        Some((_, token)) if token.is('[') => {
            let is_word = |t: &&(usize, Token)| !matches!(t.1, Token::Bracket(_));
            let length = rest[1..].iter().take_while(is_word).count();
            let closed = rest.get(1 + length).is_some_and(|t| t.1.is(']'));
            let after = from + 1 + length + usize::from(closed);
            (listed(&rest[1..1 + length]), after)
        }
        Some((_, Token::Bracket(_))) | None => (None, from),
        Some(_) => {
            let number = |t: &&(usize, Token)| matches!(&t.1, Token::Word(word) if word.parse::<f64>().is_ok());
            let count = rest.iter().take_while(number).count().max(1);
            (listed(&rest[..count]), from + count)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_may_span_lines_and_hold_quotes_and_brackets() {
        let text = "#VRML V2.0 utf8\n\
            Info { string \"one {\r\n two ] \\\"three\\\" # four\\\\\" name \"\" }\r\n\
            DEF a Joint { name \"l_hip\" } # } a comment\r\
            DEF b Joint { center 1, 2, 3 }";
        let scene = read(text).unwrap();
        assert_eq!(scene.nodes.len(), 3);
        assert_eq!(scene.nodes[0].text("name"), Some(""));
        assert_eq!(scene.named("a").unwrap().text("name"), Some("l_hip"));
        let b = scene.named("b").unwrap();
        assert_eq!(b.numbers("center").unwrap(), [1.0, 2.0, 3.0]);
        assert_eq!(b.line, 5);
        let error = read("#VRML V2.0 utf8\nInfo { string \"one }").unwrap_err();
        assert!(error.to_string().contains("line 2, a string"), "{error}");
    }

    #[test]
    fn prototypes_are_no_part_of_the_scene() {
        let text = "#VRML V2.0 utf8\n\
            PROTO Joint [ exposedField SFVec3f center 0 0 0 exposedField SFString name \"\"\n\
            exposedField MFNode children [] ]\n\
            { Transform { center IS center children IS children } ROUTE no.a TO no.b }\n\
            EXTERNPROTO Other [ field SFFloat key ] [ \"a.wrl\" ]\n\
            DEF hip Joint { center 0 1 0 name \"l_hip\" }";
        let scene = read(text).unwrap();
        assert_eq!((scene.nodes.len(), scene.routes.len()), (1, 0));
        assert_eq!(scene.nodes[0].kind, "Joint");
        assert_eq!(scene.nodes[0].numbers("center").unwrap(), [0.0, 1.0, 0.0]);
        let open = read("#VRML V2.0 utf8\nPROTO Joint [ ] { Transform { }").unwrap_err();
        assert!(open.to_string().contains("line 2, PROTO Joint"), "{open}");
    }
}
