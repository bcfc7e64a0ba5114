//! The glossary, read from the page of the documentation.

use std::sync::LazyLock;

/// A word with its meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    /// Heading under which the word stands, for instance "Panels".
    pub subject: &'static str,
    /// The word.
    pub word: &'static str,
    /// Meaning of the word.
    pub meaning: &'static str,
}

/// All words, in the order of the page.
pub static GLOSSARY: LazyLock<Vec<Word>> =
    LazyLock::new(|| words(include_str!("../../docs/GLOSSARY.md")));

/// Meaning of a label of a field or title; `None` if the glossary does not have it.
pub fn meaning(label: &str) -> Option<&'static str> {
    let found = GLOSSARY.iter();
    let mut found = found.filter(|word| word.word.eq_ignore_ascii_case(label));
    found.next().map(|word| word.meaning)
}

/// Words that contain a text in name or meaning; those that begin with it come first.
pub fn found(text: &str) -> Vec<Word> {
    let text = text.trim().to_lowercase();
    let rank = |word: &Word| {
        let name = word.word.to_lowercase();
        match name.starts_with(&text) {
            true => Some(0),
            false if name.contains(&text) => Some(1),
            false if word.meaning.to_lowercase().contains(&text) => Some(2),
            false => None,
        }
    };
    let ranked = GLOSSARY
        .iter()
        .filter_map(|word| Some((rank(word)?, *word)));
    let mut ranked: Vec<(i32, Word)> = ranked.collect();
    if !text.is_empty() {
        ranked.sort_by_key(|(rank, _)| *rank);
    }
    ranked.into_iter().map(|(_, word)| word).collect()
}

/// Rows of the tables of a page, each with its heading.
fn words(page: &'static str) -> Vec<Word> {
    let mut subject = "";
    let mut words = Vec::new();
    for line in page.lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            subject = heading;
        }
        let cells = line
            .strip_prefix("| ")
            .and_then(|line| line.strip_suffix(" |"));
        if let Some((word, meaning)) = cells.and_then(|cells| cells.split_once(" | "))
            && word != "word"
        {
            words.push(Word {
                subject,
                word,
                meaning,
            });
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_word_stands_once_with_its_meaning() {
        let names: BTreeSet<&str> = GLOSSARY.iter().map(|word| word.word).collect();
        assert_eq!(names.len(), GLOSSARY.len());
        assert!(GLOSSARY.len() > 50, "{}", GLOSSARY.len());
        for word in GLOSSARY.iter() {
            assert!(
                word.meaning.ends_with('.') && !word.subject.is_empty(),
                "{word:?}"
            );
        }
        assert_eq!(meaning("Nap"), meaning("nap"));
        assert!(meaning("elephant").is_none());
    }

    #[test]
    fn a_word_is_found_before_meanings_that_have_it() {
        let fabric = found("fab");
        assert_eq!(fabric[0].word, "fabric");
        assert!(fabric.len() > 2);
        assert!(found("elephant").is_empty());
        assert_eq!(found("").len(), GLOSSARY.len());
    }
}
