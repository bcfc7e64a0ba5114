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

/// The next free id of every kind. Counters only ever grow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub struct IdCounters {
    /// Next panel.
    pub panel: u32,
    /// Next point.
    pub point: u32,
    /// Next edge.
    pub edge: u32,
    /// Next internal line.
    pub internal_line: u32,
    /// Next dart.
    pub dart: u32,
    /// Next notch.
    pub notch: u32,
    /// Next seam.
    pub seam: u32,
    /// Next fabric.
    pub fabric: u32,
}

macro_rules! takers {
    ($($(#[$doc:meta])* $method:ident $field:ident $name:ident),* $(,)?) => {
        impl IdCounters {
            $(
                $(#[$doc])*
                pub fn $method(&mut self) -> $name {
                    let id = $name(self.$field);
                    self.$field = self.$field.saturating_add(1);
                    id
                }
            )*
        }

        $(
            impl $name {
                /// Makes sure the counters never give this id out again.
                pub fn reserve(self, counters: &mut IdCounters) {
                    counters.$field = counters.$field.max(self.0.saturating_add(1));
                }
            }
        )*
    };
}

impl IdCounters {
    /// Raises each counter to another's where that is higher: no id that the other has given is
    /// given again.
    pub fn raise(&mut self, other: &Self) {
        let pairs = [
            (&mut self.panel, other.panel),
            (&mut self.point, other.point),
            (&mut self.edge, other.edge),
            (&mut self.internal_line, other.internal_line),
            (&mut self.dart, other.dart),
            (&mut self.notch, other.notch),
            (&mut self.seam, other.seam),
            (&mut self.fabric, other.fabric),
        ];
        for (counter, other) in pairs {
            *counter = (*counter).max(other);
        }
    }
}

takers! {
    /// Takes a fresh id.
    take_panel panel PanelId,
    /// Takes a fresh id.
    take_point point PointId,
    /// Takes a fresh id.
    take_edge edge EdgeId,
    /// Takes a fresh id.
    take_internal_line internal_line InternalLineId,
    /// Takes a fresh id.
    take_dart dart DartId,
    /// Takes a fresh id.
    take_notch notch NotchId,
    /// Takes a fresh id.
    take_seam seam SeamId,
    /// Takes a fresh id.
    take_fabric fabric FabricId,
}
