//! Options of `toile seams`.

use crate::read_options::ReadArguments;
use crate::values::one_size;
use clap::Args;
use std::path::PathBuf;
use toile_session::AcceptedSeams;

/// `toile seams`.
#[derive(Debug, Args)]
pub struct Seams {
    /// The pattern, of any format that is read.
    pub pattern: PathBuf,
    /// Named size whose lengths are compared. Default: the size that the file keeps, else the base size.
    #[arg(long, value_name = "NAME", value_parser = one_size)]
    pub size: Option<String>,
    /// Suggestions to sew: numbers of the list, as in 1,4; or best, those that are certain: each edge is the other's first
    /// choice and three times as likely as all else together, mirror images are sewn on a centre line alone, and no pieces
    /// are closed to a bag. No edge gets a second seam.
    #[arg(long, value_name = "best|NUMBERS", value_parser = accepted, requires = "out")]
    pub accept: Option<AcceptedSeams>,
    /// List all suggestions. Default: for each edge the first three.
    #[arg(long)]
    pub all: bool,
    /// File to write the pattern with its new seams to; its ending says the format.
    #[arg(long, value_name = "FILE", requires = "accept")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub read: ReadArguments,
}

/// Suggestions to accept: `best`, or numbers with commas.
pub fn accepted(text: &str) -> Result<AcceptedSeams, String> {
    if text == "best" {
        return Ok(AcceptedSeams::Best);
    }
    let numbers = text.split(',').map(|one| one.trim().parse::<usize>());
    let numbers: Result<Vec<usize>, _> = numbers.collect();
    match numbers {
        Ok(numbers) if numbers.iter().all(|number| *number > 0) => {
            Ok(AcceptedSeams::Numbers(numbers))
        }
        Ok(_) | Err(_) => {
            Err("write best, or numbers of the list with commas, as in 1,4".to_owned())
        }
    }
}
