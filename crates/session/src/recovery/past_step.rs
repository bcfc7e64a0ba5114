//! Steps of the history as they are kept: each as the difference between the documents before and after it,
//! for a step mostly changes little.

use serde::{Deserialize, Serialize};

/// A step that can be taken back after a crash.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PastStep {
    /// Label of the step.
    pub label: String,
    /// Number of bytes that the texts before and after the step have in common at their start, and at their
    /// end.
    same: [usize; 2],
    /// Text between the common start and end, before the step.
    before: String,
}

impl PastStep {
    /// A step between two texts of a document.
    pub(super) fn between(label: String, before: &str, after: &str) -> Self {
        let pairs = before.char_indices().zip(after.chars());
        let mut pairs = pairs.skip_while(|((_, a), b)| a == b);
        let least = before.len().min(after.len());
        let start = pairs.next().map_or(least, |((at, _), _)| at);
        let (rest, other) = (&before[start..], &after[start..]);
        let backward = rest.chars().rev().zip(other.chars().rev());
        let end = backward.take_while(|(a, b)| a == b);
        let end: usize = end.map(|(a, _)| a.len_utf8()).sum();
        Self {
            label,
            same: [start, end],
            before: rest[..rest.len() - end].to_owned(),
        }
    }

    /// The text before the step, rebuilt from the text `after` it; `None` if `after` does not belong to the
    /// step.
    pub(crate) fn text_before(&self, after: &str) -> Option<String> {
        let [start, end] = self.same;
        let tail = after.len().checked_sub(end).filter(|tail| *tail >= start)?;
        let parts = [after.get(..start)?, &self.before, after.get(tail..)?];
        Some(parts.concat())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_text_before_comes_back(before in "[aä€\n]{0,12}", after in "[aä€\n]{0,12}") {
            let step = PastStep::between("Move point".into(), &before, &after);
            prop_assert_eq!(step.text_before(&after), Some(before.clone()));
            // Of any other text it makes some text or none, and does not break down.
            let _ = step.text_before(&before);
            let _ = step.text_before("");
        }
    }

    #[test]
    fn little_is_kept_of_a_little_change() {
        let before = "0123456789".repeat(1000);
        let after = before.replacen("9012", "9x012", 1);
        let step = PastStep::between("Move point".into(), &before, &after);
        assert!(step.before.len() < 3, "{step:?}");
        let ([start, end], all) = (step.same, after.len());
        assert!(start + end >= all - 3);
    }
}
