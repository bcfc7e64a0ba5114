//! Typed ids of the document's parts. An id is given once and never used again, so that seams,
//! selections and journals keep meaning the same thing.

use serde::{Deserialize, Serialize};

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident $prefix:literal),* $(,)?) => {$(
        $(#[$doc])*
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize,
        )]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, concat!($prefix, "{}"), self.0)
            }
        }
    )*};
}

ids! {
    /// A panel of the pattern.
    PanelId "panel ",
    /// A point of a panel.
    PointId "point ",
    /// An edge of a panel's outline or hole.
    EdgeId "edge ",
    /// A line drawn inside a panel.
    InternalLineId "internal line ",
    /// A dart of a panel.
    DartId "dart ",
    /// A notch of a panel.
    NotchId "notch ",
    /// A seam of the pattern.
    SeamId "seam ",
    /// A fabric of the pattern.
    FabricId "fabric ",
}
