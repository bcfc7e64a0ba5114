//! Options for what a pattern file leaves open.

use crate::values::word;
use clap::Args;
use std::path::PathBuf;
use toile_geometry::Length;
use toile_session::{DisplayUnit, Format, OpenOptions, ReadOptions};

/// Answers to what a file leaves open; without them they are guessed, and told.
#[derive(Clone, Debug, Default, Args)]
pub struct ReadArguments {
    /// Format of the file, in place of the one that its content shows.
    #[arg(long, value_name = "FORMAT", value_parser = word::<Format>())]
    from: Option<Format>,
    /// Unit of the file's coordinates, in place of the one that it states or its size suggests.
    #[arg(long, value_name = "UNIT", value_parser = word::<DisplayUnit>())]
    unit: Option<DisplayUnit>,
    /// A file that belongs to the pattern: a table of grade rules, or of measurements. May be given again.
    #[arg(long, value_name = "FILE")]
    with: Vec<PathBuf>,
    /// Distance from the outline inwards to the sew line, of a file that has cut lines alone, as in 10mm.
    #[arg(long, value_name = "LENGTH")]
    inside: Option<Length>,
}

impl ReadArguments {
    /// How the file is opened.
    pub fn options(&self) -> OpenOptions {
        OpenOptions {
            reading: ReadOptions {
                format: self.from,
                unit: self.unit,
                allowance_inside: self.inside.map(Length::as_metres),
            },
            with: self.with.clone(),
        }
    }
}
