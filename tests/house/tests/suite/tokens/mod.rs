//! Tokens of a source: attributes, and the items that are built for tests only.

use syn::buffer::Cursor;

/// Whether an attribute that begins here keeps what follows for tests, and what comes after it.
pub fn attribute(at: Cursor<'_>) -> Option<(bool, Cursor<'_>)> {
    let (_, rest) = at.punct().filter(|(mark, _)| mark.as_char() == '#')?;
    let (inside, _, _, rest) = rest.any_group()?;
    let is_test = || {
        let (cfg, within) = inside.ident()?;
        let (word, end) = within.any_group()?.0.ident()?;
        Some(cfg == "cfg" && word == "test" && end.eof())
    };
    Some((is_test().unwrap_or(false), rest))
}

/// Beyond the item that begins here: its braces or its semicolon.
pub fn past_item(mut at: Cursor<'_>) -> Cursor<'_> {
    while let Some((_, after)) = at.token_tree() {
        let is_end = match at.any_group() {
            Some((_, delimiter, ..)) => format!("{delimiter:?}") == "Brace",
            None => at.punct().is_some_and(|(mark, _)| mark.as_char() == ';'),
        };
        at = after;
        if is_end {
            break;
        }
    }
    at
}
