//! Kinds of contents of a document.

use strum::{EnumCount, VariantArray};

/// A kind of contents of a document.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, EnumCount, VariantArray)]
pub enum Content {
    /// Tables of measurements.
    Sizes,
    /// Named numbers.
    Variables,
    /// Numbers given by formulas, or by size.
    Formulas,
    /// Fabrics with their figures.
    Fabrics,
    /// Points placed by a construction, not by coordinates.
    Constructions,
    /// Guides.
    Guides,
    /// Panels.
    Panels,
    /// Lines drawn inside panels.
    InternalLines,
    /// Holes.
    Holes,
    /// Notches.
    Notches,
    /// Darts, those pivoted and those inside a panel too.
    Darts,
    /// Panels cut on the fold.
    Folds,
    /// Cuts that are spread.
    Spreads,
    /// Panels divided into sides.
    Splits,
    /// Lines that an operation inserts.
    InsertedLines,
    /// Pleats.
    Pleats,
    /// Operations on panels of other kinds.
    Operations,
    /// Allowances along edges.
    Allowances,
    /// Shapes of the cut line at corners.
    Corners,
    /// Grains that are not upright.
    Grains,
    /// Panels cut more than once.
    Copies,
    /// Places of panels on the body.
    Places,
    /// Seams.
    Seams,
    /// Eases and gathers of seams.
    Eases,
    /// Markers.
    Markers,
    /// Wearer, fabric and other garments that the garment is tried on with.
    Fitting,
}

impl Content {
    /// The kind in words, in the plural.
    pub fn words(self) -> &'static str {
        match self {
            Self::Sizes => "sizes",
            Self::Variables => "variables",
            Self::Formulas => "formulas",
            Self::Fabrics => "fabrics",
            Self::Constructions => "constructed points",
            Self::Guides => "guides",
            Self::Panels => "panels",
            Self::InternalLines => "internal lines",
            Self::Holes => "holes",
            Self::Notches => "notches",
            Self::Darts => "darts",
            Self::Folds => "folds",
            Self::Spreads => "spread cuts",
            Self::Splits => "splits",
            Self::InsertedLines => "inserted lines",
            Self::Pleats => "pleats",
            Self::Operations => "other operations",
            Self::Allowances => "seam allowances",
            Self::Corners => "corners of the cut line",
            Self::Grains => "grains",
            Self::Copies => "copies of panels",
            Self::Places => "places on the body",
            Self::Seams => "seams",
            Self::Eases => "eases and gathers",
            Self::Markers => "markers",
            Self::Fitting => "the fitting",
        }
    }
}
