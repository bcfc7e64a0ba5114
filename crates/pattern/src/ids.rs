//! Typed ids of the document's parts. One counter gives all of them, each number once, so that seams,
//! formulas, selections and journals keep referring to the same parts.

use serde::{Deserialize, Serialize};

/// An id of a part of any kind.
pub trait AnyId {
    /// The part that the id belongs to.
    fn part(&self) -> PartId;
    /// Replaces the number of the id.
    fn set_number(&mut self, number: u32);
}

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident $variant:ident $words:literal),* $(,)?) => {
        $(
            $(#[$doc])*
            #[derive(
                Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize,
            )]
            #[serde(transparent)]
            pub struct $name(pub u32);

            impl std::fmt::Display for $name {
                fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                    write!(f, concat!($words, " {}"), self.0)
                }
            }

            impl From<FreshId> for $name {
                fn from(id: FreshId) -> Self {
                    Self(id.0)
                }
            }

            impl From<u32> for $name {
                fn from(number: u32) -> Self {
                    Self(number)
                }
            }

            impl AnyId for $name {
                fn part(&self) -> PartId {
                    (*self).into()
                }

                fn set_number(&mut self, number: u32) {
                    self.0 = number;
                }
            }

            /// Fails if the part is of another kind; the error is the part.
            impl TryFrom<PartId> for $name {
                type Error = PartId;

                fn try_from(part: PartId) -> Result<Self, PartId> {
                    if let PartId::$variant(id) = part {
                        return Ok(id);
                    }
                    Err(part)
                }
            }

            impl From<$name> for PartId {
                fn from(id: $name) -> Self {
                    Self::$variant(id)
                }
            }
        )*

        /// The id of a part of any kind.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum PartId {
            $($(#[$doc])* $variant($name)),*
        }

        impl PartId {
            /// Number of the id, unique among parts of all kinds.
            pub fn number(self) -> u32 {
                match self {
                    $(Self::$variant(id) => id.0),*
                }
            }
        }

        impl std::fmt::Display for PartId {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                match self {
                    $(Self::$variant(id) => id.fmt(f)),*
                }
            }
        }
    };
}

ids! {
    /// A size: a named table of measurements.
    SizeId Size "size",
    /// A named number for formulas.
    VariableId Variable "variable",
    /// A fabric.
    FabricId Fabric "fabric",
    /// A sheet: a drafting plane.
    SheetId Sheet "sheet",
    /// A point of a sheet.
    PointId Point "point",
    /// A curve of a sheet.
    CurveId Curve "curve",
    /// A panel.
    PanelId Panel "panel",
    /// A line of a panel: its outline, a hole or an internal line.
    LineId Line "line",
    /// An edge: a stretch of a curve, part of a line.
    EdgeId Edge "edge",
    /// A notch.
    NotchId Notch "notch",
    /// An operation of a panel: a dart, a fold.
    OperationId Operation "operation",
    /// A seam.
    SeamId Seam "seam",
    /// A marker.
    MarkerId Marker "marker",
    /// A guide.
    GuideId Guide "guide",
}

/// The source of new ids. Its counter never decreases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Ids {
    /// The number that the next new id gets.
    pub next: u32,
}

impl Ids {
    /// A new id of the requested kind.
    pub fn take<T: From<FreshId>>(&mut self) -> T {
        let number = self.next;
        self.next = self.next.saturating_add(1);
        FreshId(number).into()
    }

    /// Makes sure that no new id gets this number.
    pub fn reserve(&mut self, number: u32) {
        self.next = self.next.max(number.saturating_add(1));
    }
}

/// A new number from [`Ids`], before it becomes an id of some kind.
pub struct FreshId(u32);
