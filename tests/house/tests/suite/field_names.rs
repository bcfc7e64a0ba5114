//! Keys of fields are written once: in the list that declares the field, not in a second one beside it.
//!
//! Keys are those of the `fields!` lists of the document and of the table of figures. Many of them are ordinary words
//! (`line`, `width`), which are written everywhere for other things; counted are keys with an underscore or of at least
//! [`DISTINCTIVE`] letters. A file that holds [`LISTED`] of them is taken for a list of fields.

use crate::tokens::{attribute, past_item};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::sync::LazyLock;
use syn::buffer::{Cursor, TokenBuffer};
use toile_house::{files_below, root};

/// Letters of a key from which on it is distinctive without an underscore.
const DISTINCTIVE: usize = 8;
/// Distinctive keys of one subject from which on a file is taken for a list of fields.
const LISTED: usize = 3;
/// Files that may list the fields of one subject: those that declare them, and those that write journals.
const MAX_FILES: usize = 5;

/// Files whose lists belong to another format, each with the reason. This list may only become shorter.
const OF_OTHER_FORMATS: [(&str, &str); 1] = [(
    "crates/drape/src/features.rs",
    "words for what a method supports; some laws of cloth are named like their figure",
)];

/// Files of the document that declare the cloth of a marker and the rules for its pieces.
const OF_CLOTH: [&str; 3] = ["cloth_settings.rs", "marker.rs", "piece_rule.rs"];

type Words = BTreeSet<String>;

/// Texts and declared fields in a source, leaving out what is built for tests only.
#[derive(Default)]
struct Texts {
    /// Literal texts, and the names in `given!` and `given_list!`, which declare fields by their own names.
    all: Words,
    /// Those of them within `fields!`.
    fields: Words,
    /// Those of them within `figures!`: names and pattern keys.
    figures: Words,
}

impl Texts {
    fn of(source: &str) -> Self {
        let tokens = TokenBuffer::new2(syn::parse_str(source).expect("the source is Rust"));
        let mut texts = Self::default();
        texts.read(tokens.begin());
        texts
    }

    fn read(&mut self, mut at: Cursor<'_>) {
        while let Some((_, after)) = at.token_tree() {
            if let Some((true, rest)) = attribute(at) {
                at = past_item(rest);
                continue;
            }
            let named = macro_at(at);
            if let Some((name, inside, rest)) = named {
                let mut own = Self::default();
                own.read(inside);
                match name.as_str() {
                    "given" | "given_list" => own.all.extend(second_word(inside)),
                    "fields" => own.fields.extend(keys(&own.all)),
                    "figures" => own.figures.extend(names_of_figures(inside)),
                    _ => {}
                }
                self.add(own);
                at = rest;
                continue;
            }
            if let Some((text, _)) = at.literal() {
                let text = text.to_string();
                self.all.extend(unquoted(&text).map(str::to_owned));
            }
            if let Some((inside, ..)) = at.any_group() {
                self.read(inside);
            }
            at = after;
        }
    }

    fn add(&mut self, other: Self) {
        self.all.extend(other.all);
        self.fields.extend(other.fields);
        self.figures.extend(other.figures);
    }
}

/// The text of a literal.
fn unquoted(literal: &str) -> Option<&str> {
    literal.strip_prefix('"')?.strip_suffix('"')
}

/// The use of a macro that begins here: its name, what is given to it, and what comes after.
fn macro_at(at: Cursor<'_>) -> Option<(String, Cursor<'_>, Cursor<'_>)> {
    let (name, rest) = at.ident()?;
    let (_, rest) = rest.punct().filter(|(mark, _)| mark.as_char() == '!')?;
    let (inside, _, _, rest) = rest.any_group()?;
    Some((name.to_string(), inside, rest))
}

/// The second of the words given to a macro.
fn second_word(inside: Cursor<'_>) -> Option<String> {
    let (_, rest) = inside.ident()?;
    let (_, rest) = rest.punct()?;
    Some(rest.ident()?.0.to_string())
}

/// Texts after `name:` and `pattern_key:` at any depth.
fn names_of_figures(mut at: Cursor<'_>) -> Words {
    let mut found = Words::new();
    while let Some((_, after)) = at.token_tree() {
        let text = at.ident().and_then(|(word, rest)| {
            let (colon, rest) = rest.punct()?;
            let is_key = word == "name" || word == "pattern_key";
            (is_key && colon.as_char() == ':').then(|| rest.literal())?
        });
        found.extend(text.and_then(|(text, _)| Some(unquoted(&text.to_string())?.to_owned())));
        if let Some((inside, ..)) = at.any_group() {
            found.extend(names_of_figures(inside));
        }
        at = after;
    }
    found
}

/// Texts that may be keys; labels and messages of more words are none.
fn keys(texts: &Words) -> impl Iterator<Item = String> {
    let is_key = |text: &&String| text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    texts.iter().filter(is_key).cloned()
}

fn is_distinctive(key: &str) -> bool {
    key.contains('_') || key.len() >= DISTINCTIVE
}

/// Texts of every source outside tests, by path from the root.
static SOURCES: LazyLock<BTreeMap<String, Texts>> = LazyLock::new(sources);

fn sources() -> BTreeMap<String, Texts> {
    let root = root();
    let mut found = BTreeMap::new();
    for folder in ["crates", "ui"] {
        for path in files_below(&root.join(folder), ".rs") {
            let name = path.strip_prefix(&root).expect("below the root");
            let name = name.display().to_string().replace('\\', "/");
            let is_test = name.ends_with("/tests.rs") || name.contains("/tests/");
            if name.contains("/src/") && !is_test {
                let text = fs::read_to_string(&path).expect("readable");
                found.insert(name, Texts::of(&text));
            }
        }
    }
    found
}

/// Distinctive keys by subject: the cloth of a marker with its rules, other parts of the document, figures of fabrics.
fn subjects(sources: &BTreeMap<String, Texts>) -> [(&'static str, Words); 3] {
    let [mut cloth, mut parts, mut figures] = [const { Words::new() }; 3];
    for (path, texts) in sources {
        let is_of_cloth = OF_CLOTH
            .iter()
            .any(|file| path.ends_with(&format!("document/{file}")));
        let is_of_document = path.starts_with("crates/pattern/src/");
        let subject = if is_of_cloth { &mut cloth } else { &mut parts };
        let fields = texts.fields.iter().filter(|_| is_of_document);
        subject.extend(fields.filter(|key| is_distinctive(key)).cloned());
        figures.extend(
            texts
                .figures
                .iter()
                .filter(|key| is_distinctive(key))
                .cloned(),
        );
    }
    [("cloth", cloth), ("parts", parts), ("figures", figures)]
}

/// The files that list fields of a subject, each with the keys that it holds.
fn lists<'s>(
    sources: &'s BTreeMap<String, Texts>,
    keys: &'s Words,
) -> impl Iterator<Item = (&'s str, Vec<&'s String>)> {
    sources.iter().filter_map(move |(path, texts)| {
        let held: Vec<&String> = keys.intersection(&texts.all).collect();
        (held.len() >= LISTED).then_some((&**path, held))
    })
}

#[test]
fn keys_of_fields_are_listed_in_few_files() {
    for (subject, keys) in subjects(&SOURCES) {
        assert!(keys.len() >= 9, "{subject}: only {keys:?} found");
        let own = lists(&SOURCES, &keys);
        let own = own.filter(|(path, _)| OF_OTHER_FORMATS.iter().all(|(other, _)| other != path));
        let own: Vec<String> = own
            .map(|(path, held)| format!("{path}: {held:?}"))
            .collect();
        assert!(
            own.len() <= MAX_FILES,
            "{} files list fields of {subject}: walk over the list that declares them instead\n{}",
            own.len(),
            own.join("\n")
        );
    }
}

#[test]
fn files_of_other_formats_still_have_such_lists() {
    let subjects = subjects(&SOURCES);
    for (file, reason) in OF_OTHER_FORMATS {
        let lists = |(_, keys): &(_, Words)| lists(&SOURCES, keys).any(|(path, _)| path == file);
        assert!(
            subjects.iter().any(lists),
            "{file} ({reason}) has no such list any more: take it out of OF_OTHER_FORMATS"
        );
    }
}

#[test]
fn keys_are_told_from_other_texts() {
    let texts = Texts::of(
        r#"
        fields!(Hem, |self, v| {
            given!(v, folded_twice);
            v.value(key("hem_depth").label("deep as sewn"), depth);
        });
        figures! { stiff: f64 = 1.0, Figure { name: "stiff", label: "Stiff", pattern_key: "stiff_N_per_m" } }
        #[serde(rename = "renamed")]
        struct Other;
        #[cfg(test)]
        mod tests {
            const KEY: &str = "tested";
        }
        const LAST: &str = "last";
        "#,
    );
    let words = |words: &[&str]| words.iter().map(|&word| word.to_owned()).collect::<Words>();
    assert_eq!(texts.fields, words(&["folded_twice", "hem_depth"]));
    assert_eq!(texts.figures, words(&["stiff", "stiff_N_per_m"]));
    let beside = ["renamed", "last", "Stiff", "deep as sewn"];
    assert!(words(&beside).is_subset(&texts.all), "{:?}", texts.all);
    assert!(!texts.all.contains("tested"));
}
