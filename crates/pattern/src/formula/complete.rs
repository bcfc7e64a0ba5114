//! Completions of a formula while it is typed.

use super::names::Names;
use super::parse::FUNCTION_NAMES;
use super::{PI, quoted};
use toile_measure::CATALOGUE;

/// A formula with its last word completed, offered while the formula is typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Completion {
    /// The completed word, to be shown in the list of proposals.
    pub word: String,
    /// The whole text with the completed word.
    pub text: String,
}

impl Names {
    /// Names that the last word of a text can be completed to: measurements, variables, functions and panels,
    /// and after `panel.` the edges and points of that panel. Names that begin with the typed word come
    /// first.
    pub fn completions(&self, text: &str) -> Vec<Completion> {
        let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
        let start = text
            .char_indices()
            .rev()
            .take_while(|(_, c)| is_word(*c))
            .last()
            .map_or(text.len(), |(at, _)| at);
        let (before, last) = text.split_at(start);
        if last.is_empty() || last.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            return Vec::new();
        }
        let (owner, begun) = last
            .rsplit_once('.')
            .map_or((None, last), |(owner, begun)| (Some(owner), begun));
        let mut words = match owner {
            Some(owner) => self.parts_of(owner),
            None => self.plain_words(),
        };
        let begun = begun.to_lowercase();
        let rank = |word: &str| {
            let word = word.to_lowercase();
            match (word.starts_with(&begun), word.contains(&begun)) {
                (true, _) => Some(0),
                (_, true) => Some(1),
                _ => None,
            }
        };
        words.retain(|word| rank(word).is_some() && word.to_lowercase() != begun);
        words.sort_by_key(|word| rank(word));
        words.dedup();
        words
            .into_iter()
            .map(|word| {
                let written = match owner {
                    Some(owner) => format!("{owner}.{}", quoted(&word)),
                    None if word.ends_with(['(', '.']) => word.clone(),
                    None => quoted(&word),
                };
                Completion {
                    text: format!("{before}{written}"),
                    word,
                }
            })
            .collect()
    }

    fn parts_of(&self, owner: &str) -> Vec<String> {
        let panel = self.panels.id((), owner);
        let mut words: Vec<String> = Vec::new();
        if let Some(edges) = panel.and_then(|panel| self.edges.get(&panel)) {
            words.extend(edges.keys().map(|name| name.to_string()));
        }
        let sheet = match panel {
            Some(panel) => self.source.get(&panel).copied(),
            None => self.sheets.id((), owner),
        };
        if let Some(sheet) = sheet {
            words.extend(self.points.names(sheet).map(str::to_owned));
        }
        words
    }

    fn plain_words(&self) -> Vec<String> {
        let variables = self.variables.names(()).map(str::to_owned);
        let mut words: Vec<String> = variables.collect();
        match &self.measured {
            measured if measured.is_empty() => {
                // A pattern without sizes uses the wearer's measurements: all names of the catalogue are
                // proposed.
                words.extend(CATALOGUE.iter().map(|known| known.name.to_owned()));
            }
            measured => words.extend(measured.iter().map(|name| name.to_string())),
        }
        words.push(PI.to_owned());
        words.extend(FUNCTION_NAMES.split(", ").map(|name| format!("{name}(")));
        words.extend(self.panels.names(()).map(|name| format!("{name}.")));
        words
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Number, Pattern, Variable, VariableId};

    #[test]
    fn the_last_word_is_completed_by_what_has_that_name() {
        let mut pattern = Pattern::blank("A");
        pattern.variables.push(std::sync::Arc::new(Variable {
            id: VariableId::from(900),
            name: "waist_ease".into(),
            number: Number::Value(1.0),
        }));
        let names = Names::new(&pattern);
        let found = |text: &str| -> Vec<String> {
            let all = names.completions(text).into_iter();
            all.map(|completion| completion.text).collect()
        };
        assert!(found("wai").contains(&"waist_ease".into()));
        assert!(found("wai").contains(&"waist".into()));
        assert!(found("2 * (wai").contains(&"2 * (waist".into()));
        assert!(found("le").contains(&"length(".into()));
        // No completion is proposed for numbers, complete words and the empty text.
        for text in ["", "12", "1.5", "waist_ease", "waist + ", "nobody.ar"] {
            assert_eq!(found(text), Vec::<String>::new(), "{text}");
        }
    }
}
