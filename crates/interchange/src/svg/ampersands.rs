//! Signs `&` that begin no entity, as FreeSewing writes them in words that nobody translated.

/// Longest name of an entity that is looked for (bytes).
const MAX_NAME: usize = 64;
const CDATA: [&str; 2] = ["<![CDATA[", "]]>"];

/// A text with each sign `&` that begins no entity written as one, and the number of those; sections of plain
/// characters stay as they are.
pub(super) fn escaped(text: &str) -> (String, usize) {
    let mut found = String::with_capacity(text.len());
    let (mut rest, mut count) = (text, 0);
    while let Some(at) = rest.find(['&', '<']) {
        let (before, from) = rest.split_at(at);
        found.push_str(before);
        let end = match from.starts_with(CDATA[0]) {
            true => from.find(CDATA[1]).unwrap_or(from.len()),
            false => 1,
        };
        found.push_str(&from[..end]);
        if from.starts_with('&') && !is_entity(&from[1..]) {
            found.push_str("amp;");
            count += 1;
        }
        rest = &from[end..];
    }
    found.push_str(rest);
    (found, count)
}

/// Whether a text after the sign `&` goes on as an entity.
fn is_entity(text: &str) -> bool {
    let Some(end) = text.bytes().take(MAX_NAME).position(|byte| byte == b';') else {
        return false;
    };
    let name = &text[..end];
    let name = name.strip_prefix('#').unwrap_or(name);
    !name.is_empty()
        && name
            .chars()
            .all(|c| c.is_alphanumeric() || "_:-.".contains(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_signs_that_begin_no_entity_are_written_as_one() {
        for (text, expected, count) in [
            (
                "<a b='& &#160; &amp;'>x & y</a>",
                "<a b='&amp; &#160; &amp;'>x &amp; y</a>",
                2,
            ),
            (
                "<a><![CDATA[a & b]]>&</a>",
                "<a><![CDATA[a & b]]>&amp;</a>",
                1,
            ),
            ("& ;&;&é", "&amp; ;&amp;;&amp;é", 3),
            ("<a/>", "<a/>", 0),
            ("<![CDATA[&", "<![CDATA[&", 0),
        ] {
            assert_eq!(escaped(text), (expected.to_owned(), count), "{text}");
        }
    }
}
