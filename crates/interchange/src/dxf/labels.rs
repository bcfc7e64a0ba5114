//! The texts of a pattern in DXF: `Key: value`, in any case, with or without a blank after the colon.

use std::collections::{BTreeMap, BTreeSet};

/// The texts of a block, or of the style.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Labels {
    /// Values by their keys in lower case without blanks; the first of several holds.
    values: BTreeMap<String, String>,
    /// Texts that are no pair, each once.
    pub others: BTreeSet<String>,
}

impl Labels {
    /// Takes a text.
    pub fn add(&mut self, text: &str) {
        match text.split_once(':') {
            Some((key, value)) if !key.trim().is_empty() => {
                let key: String = key.to_lowercase().split_whitespace().collect();
                let value = value.trim().to_owned();
                self.values.entry(key).or_insert(value);
            }
            _ => {
                let text = text.trim();
                if !text.is_empty() {
                    self.others.insert(text.to_owned());
                }
            }
        }
    }

    /// Takes the pairs of others.
    pub fn add_all(&mut self, others: &Self) {
        for (key, value) in &others.values {
            self.values.entry(key.clone()).or_insert(value.clone());
        }
    }

    /// The value of the first of these keys that has one.
    pub fn value(&self, keys: &[&str]) -> Option<&str> {
        let values = keys.iter().filter_map(|key| self.values.get(*key));
        values.map(String::as_str).find(|value| !value.is_empty())
    }

    /// Sets the value of a key, in lower case without blanks.
    pub fn set(&mut self, key: &str, value: &str) {
        self.values.insert(key.to_owned(), value.to_owned());
    }

    /// Adds to the name of the piece, if it has one.
    pub fn add_to_name(&mut self, text: &str) {
        for key in ["piecename", "piece"] {
            if let Some(name) = self.values.get_mut(key) {
                name.push_str(text);
            }
        }
    }

    /// Whether a quantity is there, and is 0.
    pub fn is_quantity_nothing(&self) -> bool {
        let text = self.value(&["quantity"]).unwrap_or("1");
        let mut counts = text.split(',').map(|count| count.trim().parse::<u32>());
        counts.all(|count| count == Ok(0))
    }

    /// Number of pieces of a quantity, as in `2` or, left and right, `1,1`; `None` if it is missing or 0.
    pub fn quantity(&self) -> Option<[u32; 2]> {
        let text = self.value(&["quantity"])?;
        let mut counts = text
            .split(',')
            .map(|count| count.trim().parse::<u32>().ok());
        let left = counts.next()??;
        let right = counts.next().flatten().unwrap_or(0);
        (left + right > 0).then_some([left, right])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_of_any_case_are_found() {
        let mut labels = Labels::default();
        [
            "PIECE NAME:FRONT",
            "Size : M",
            "quantity: 1,1",
            "NM",
            "NM",
            ": x",
            "Annotation:",
        ]
        .iter()
        .for_each(|text| labels.add(text));
        assert_eq!(labels.value(&["piecename"]), Some("FRONT"));
        assert_eq!(labels.value(&["sizename", "size"]), Some("M"));
        assert_eq!(labels.value(&["annotation"]), None);
        assert_eq!(labels.quantity(), Some([1, 1]));
        assert!(labels.others.iter().eq([": x", "NM"]));
    }

    #[test]
    fn a_quantity_of_nothing_is_none() {
        let quantity = |text: &str| {
            let mut labels = Labels::default();
            labels.add(text);
            assert_eq!(labels.is_quantity_nothing(), text.ends_with('0'));
            labels.quantity()
        };
        assert_eq!(quantity("Quantity: 0,0"), None);
        assert_eq!(quantity("Quantity: two"), None);
        assert_eq!(quantity("Quantity: 2"), Some([2, 0]));
    }
}
