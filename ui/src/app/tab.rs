//! Tabs of the tables under the pattern.

/// A tab of the tables.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub enum Tab {
    #[default]
    Measurements,
    Variables,
    Grading,
    Fabric,
    Wearer,
    WornWith,
    History,
    Pattern,
}
