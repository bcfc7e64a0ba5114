//! Selection of the sizes of a pattern that are printed, laid or checked.

use crate::Pattern;

/// The sizes that are printed, laid or checked.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum SizeSelection {
    /// The pattern as drafted; this is its base size if it has a table of sizes.
    #[default]
    Base,
    /// Sizes of the pattern by name, each with the number of garments.
    Named(Vec<(String, u32)>),
    /// All sizes, with one garment of each.
    All,
}

impl SizeSelection {
    /// One garment of the size with this name.
    pub fn one(name: impl Into<String>) -> Self {
        Self::Named(vec![(name.into(), 1)])
    }

    /// The selected sizes of a pattern, each with its number of garments. A size without a name means the
    /// pattern as drafted. Names are looked up later, when the sizes are drafted. `None`: all sizes are
    /// selected, but the pattern has no table of sizes.
    pub fn of(&self, pattern: &Pattern) -> Option<Vec<(Option<String>, u32)>> {
        match self {
            Self::Base => Some(vec![(None, 1)]),
            Self::Named(names) => Some(
                names
                    .iter()
                    .map(|(name, count)| (Some(name.clone()), *count))
                    .collect(),
            ),
            Self::All if pattern.sizes.is_empty() => None,
            Self::All => {
                let sizes = pattern.sizes.iter();
                Some(sizes.map(|size| (Some(size.name.clone()), 1)).collect())
            }
        }
    }
}
