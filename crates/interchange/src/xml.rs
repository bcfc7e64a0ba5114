//! XML as a tree, with the lines of its elements for messages.

use crate::FormatError;
use roxmltree::{Document, Error, Node, ParsingOptions};

/// Largest number of elements, comments and texts in a file: far more than any motion or table has.
const MAX_NODES: u32 = 20_000_000;
/// Limit for the text size of all expanded entities (bytes).
const MAX_EXPANDED_BYTES: usize = 1 << 26;
/// Limit for the depth of entity references inside one entity.
const MAX_DEPTH: usize = 256;

/// A document with the offsets of its lines.
pub(crate) struct Xml<'a> {
    document: Document<'a>,
    /// Offset of the start of each line after the first (bytes).
    starts: Vec<usize>,
    /// Lines of white space before the document.
    skipped: usize,
}

impl<'a> Xml<'a> {
    /// Parses a text. It may have a document type with entities of its own; external entities are not
    /// fetched.
    ///
    /// # Errors
    /// A syntax error with its line and a remedy; entities that expand beyond the limit.
    pub fn read(text: &'a str, remedy: &str) -> Result<Self, FormatError> {
        let body = text.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}');
        let skipped = text[..text.len() - body.len()].matches('\n').count();
        let refuse = |line: usize, what: String| {
            FormatError::new(format!("line {}", line + skipped), what, remedy)
        };
        if let Some(line) = entity_bomb(body) {
            let what = "the entities declared here grow too long".to_owned();
            return Err(refuse(line, what));
        }
        let options = ParsingOptions {
            allow_dtd: true,
            nodes_limit: MAX_NODES,
            ..ParsingOptions::default()
        };
        let document = Document::parse_with_options(body, options).map_err(|error| {
            let place = error.pos();
            let what = error.to_string().replace(&format!(" at {place}"), "");
            let ends_early = matches!(
                error,
                Error::NoRootNode | Error::UnclosedRootNode | Error::UnexpectedEndOfStream
            );
            match ends_early {
                true => refuse(
                    body.trim_end().matches('\n').count() + 1,
                    format!("the file ends too early: {what}"),
                ),
                false => refuse(place.row as usize, what),
            }
        })?;
        let starts = body.match_indices('\n').map(|(at, _)| at + 1).collect();
        Ok(Self {
            document,
            starts,
            skipped,
        })
    }

    /// The root element.
    pub fn root(&self) -> Node<'_, 'a> {
        self.document.root_element()
    }

    /// Every element, in document order.
    pub fn elements(&self) -> impl Iterator<Item = Node<'_, 'a>> {
        self.document.descendants().filter(|node| node.is_element())
    }

    /// The line in which an element begins, from 1.
    pub fn line(&self, node: Node<'_, 'a>) -> usize {
        let at = node.range().start;
        1 + self.skipped + self.starts.partition_point(|&start| start <= at)
    }
}

/// The line of the first entity declaration, if the text could expand beyond [`MAX_EXPANDED_BYTES`]: the length
/// of all entities together, times the number of references, times [`MAX_DEPTH`] if entities name entities.
fn entity_bomb(text: &str) -> Option<usize> {
    const DECLARATION: &str = "<!ENTITY";
    let first = text.find(DECLARATION)?;
    let value = |(at, _): (usize, &'_ str)| {
        let rest = &text[at..];
        let quote = rest.find(['"', '\''])?;
        let mark = rest[quote..].chars().next()?;
        rest[quote + 1..].split(mark).next()
    };
    let values: Vec<&str> = text.match_indices(DECLARATION).filter_map(value).collect();
    let letters: usize = values.iter().map(|value| value.len()).sum();
    let nested = values.iter().any(|value| value.contains('&'));
    let own = ["amp;", "lt;", "gt;", "quot;", "apos;", "#"];
    let references = text
        .match_indices('&')
        .filter(|(at, _)| !own.iter().any(|known| text[at + 1..].starts_with(known)))
        .count();
    let most = if nested { MAX_DEPTH } else { 1 };
    let grown = letters.saturating_mul(references).saturating_mul(most);
    (grown > MAX_EXPANDED_BYTES).then(|| 1 + text[..first].matches('\n').count())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> FormatError {
        Xml::read(text, "mend it").err().unwrap()
    }

    #[test]
    fn lines_are_counted_from_the_start_of_the_text() {
        let text = "\u{feff}\n\n<?xml version='1.0'?>\n<a>\n<!-- <b/> -->\n<c\n d='1'/></a>";
        let xml = Xml::read(text, "mend it").unwrap();
        let found: Vec<_> = xml
            .elements()
            .map(|node| (node.tag_name().name(), xml.line(node)))
            .collect();
        assert_eq!(found, [("a", 4), ("c", 6)]);
        assert_eq!(refusal("\n<a>\n<b></a>").place, "line 3");
        assert_eq!(refusal("<a>\n<b>\n").place, "line 2");
        assert_eq!(refusal("<a>\n<b c='").place, "line 2");
        assert_eq!(refusal("").place, "line 1");
        assert_eq!(refusal("<a>\n&none;</a>").hint, "mend it");
    }

    #[test]
    fn entities_are_followed_and_bombs_of_them_refused() {
        let text = "<!DOCTYPE a [ <!ENTITY % p \"INCLUDE\"> <!ENTITY size '42'> ]><a b='&size;'/>";
        let xml = Xml::read(text, "mend it").unwrap();
        let node = xml.elements().next().unwrap();
        assert_eq!(node.attribute("b"), Some("42"));
        // Each entity contains the one before ten times.
        let mut bomb = String::from("<!DOCTYPE a [\n<!ENTITY e0 'ha'>\n");
        for k in 1..10 {
            let tenfold = format!("&e{};", k - 1).repeat(10);
            bomb += &format!("<!ENTITY e{k} \"{tenfold}\">\n");
        }
        bomb += "]>\n<a>&e9;</a>";
        assert!(refusal(&bomb).what.contains("entit"), "{}", refusal(&bomb));
        // One long entity, referenced often.
        let long = "x".repeat(1_000_000);
        let often = "&e;".repeat(100_000);
        let flat = format!("<!DOCTYPE a [ <!ENTITY e '{long}'> ]>\n<a b='{often}'/>");
        let error = refusal(&flat);
        assert_eq!(
            (error.place.as_str(), error.hint.as_str()),
            ("line 1", "mend it")
        );
        assert!(error.what.contains("entities"), "{error}");
        // An entity that contains itself.
        let round = "<!DOCTYPE a [ <!ENTITY e '&e;'> ]>\n<a>&e;</a>";
        assert!(refusal(round).what.contains("entity"), "{}", refusal(round));
    }

    #[test]
    fn elements_may_lie_deep_in_one_another() {
        let deep = format!("{}{}", "<a>".repeat(200_000), "</a>".repeat(200_000));
        assert_eq!(Xml::read(&deep, "").unwrap().elements().count(), 200_000);
    }
}
