//! The commands that jobs of a batch are, and the options that a specification may give them.

use serde::{Deserialize, Serialize};
use strum::{VariantArray, VariantNames};
use toile_pattern::fields::Choice;

/// What a job does with its pattern: a command of the command line.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    VariantArray,
    VariantNames,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Work {
    /// Laid out, sewn and draped.
    Make,
    /// Sewn and draped.
    Drape,
    /// Laid on fabric.
    Nest,
    /// Printed at true size.
    Print,
    /// Checked for faults.
    Check,
    /// Written in another format.
    Convert,
}

impl Choice for Work {}

/// Name of the option that is no option of a command: the name of the file that a job writes.
pub(crate) const FILE: &str = "file";

impl Work {
    /// Whether a job is done in each fabric and on each body.
    pub(crate) fn takes_body(self) -> bool {
        matches!(self, Self::Make | Self::Drape)
    }

    /// Name of the file that a job writes, where the command takes one and the specification names none.
    pub(crate) fn file(self) -> Option<&'static str> {
        match self {
            Self::Print => Some("pieces.pdf"),
            Self::Convert => Some("pattern.toile.json"),
            Self::Make | Self::Drape | Self::Nest | Self::Check => None,
        }
    }

    /// Options of the command that a specification may give. Absent are those that name files, for what a job
    /// reads is in its digest, and those by which results depend on the machine.
    pub(crate) fn options(self) -> &'static [&'static str] {
        match self {
            Self::Make | Self::Drape => &["quality", "width", "origin", "formats"],
            Self::Nest => &[
                "width",
                "length",
                "selvedge",
                "end-margin",
                "gap",
                "nap",
                "spread",
                "plies",
                "price",
                "tilt",
                "repeat",
                "evaluations",
                "seed",
                "islands",
                "write",
            ],
            Self::Print => &[
                "pieces",
                "lines",
                "scale",
                "paper",
                "halves",
                "shrinkage",
                FILE,
            ],
            Self::Check => &["from", "unit", "inside"],
            Self::Convert => &["to", "from", "unit", "inside", "origin", FILE],
        }
    }
}
