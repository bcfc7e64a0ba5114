//! Random documents in every format that is written, and back: every kind of contents is there again, or is named
//! with its number among the losses.

use std::collections::BTreeMap;
use toile_interchange::{
    Content, Fitting, Format, Loss, ReadOptions, SizedDraft, WriteSource, contents, read, write,
};
use toile_measure::Measurements;
use toile_pattern::Pattern;
use toile_pattern::fields::Choice;
use toile_tests::losses::sound_after_changes;

/// Number of documents.
const DOCUMENTS: u64 = 200;

/// Drafts of a pattern in the sizes that one file of a format holds.
fn drafts(pattern: &Pattern, format: Format) -> Vec<SizedDraft> {
    if !format.holds_shapes() {
        return Vec::new();
    }
    let base = pattern.base();
    let others = pattern
        .sizes
        .iter()
        .filter(|size| format.holds_sizes() && Some(size.id) != base.map(|size| size.id));
    match base {
        None => vec![SizedDraft {
            size: None,
            draft: pattern.resolve(&Measurements::default()).0,
        }],
        Some(base) => std::iter::once(base)
            .chain(others)
            .map(|size| SizedDraft {
                size: Some(size.name.clone()),
                draft: pattern.resolve(size).0,
            })
            .collect(),
    }
}

/// Number of things of a kind that losses name.
fn named(losses: &[Loss], content: Content) -> usize {
    let own = losses.iter().filter(|loss| loss.what == content.words());
    own.map(|loss| loss.count).sum()
}

#[test]
fn what_a_document_holds_is_back_or_named_with_its_number() {
    let mut faults = Vec::new();
    let mut tried = BTreeMap::new();
    for seed in 0..DOCUMENTS {
        let pattern = sound_after_changes(seed).unwrap();
        for &format in Format::all().iter().filter(|of| of.is_written()) {
            let source = WriteSource {
                pattern: &pattern,
                fitting: &Fitting::default(),
                drafts: &drafts(&pattern, format),
            };
            let told = format!("document {seed} as {}", format.word());
            let writing = match write(&source, format) {
                Ok(writing) => writing,
                // No panel is cut.
                Err(error) if error.what.contains("no panel") => {
                    assert!(source.drafts[0].draft.pieces.is_empty(), "{told}: {error}");
                    continue;
                }
                Err(error) => {
                    faults.push(format!("{told}: {error}"));
                    continue;
                }
            };
            let asked = ReadOptions {
                format: Some(format),
                ..ReadOptions::default()
            };
            let reading = match read(&writing.files[0].bytes, &asked, &[]) {
                Ok(reading) => reading,
                Err(error) => {
                    faults.push(format!("{told}, read: {error}"));
                    continue;
                }
            };
            *tried.entry(format.word()).or_insert(0) += 1;
            let back: BTreeMap<Content, usize> = contents(&reading.pattern).into_iter().collect();
            for (content, count) in contents(&pattern) {
                let lost = named(&writing.losses, content) + named(&reading.losses, content);
                let is_back = back.get(&content).copied().unwrap_or(0);
                if is_back + lost < count {
                    faults.push(format!(
                        "{told}: {} {}: {is_back} back, {lost} named",
                        count,
                        content.words()
                    ));
                }
            }
        }
    }
    let written = Format::all().iter().filter(|of| of.is_written());
    assert_eq!(tried.len(), written.count());
    assert!(tried.values().all(|&count| count > 150), "{tried:?}");
    assert!(
        faults.is_empty(),
        "{} faults:\n{}",
        faults.len(),
        faults.join("\n")
    );
}
