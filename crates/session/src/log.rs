//! The log: on standard error, in lines, where the environment variable `TOILE_LOG` asks for it.
//!
//! Each crate tells it what it does; nothing is told within a substep of the simulation or an iteration
//! of a search.

use std::env::{self, VarError};
use strum::{EnumString, IntoStaticStr, VariantNames};
use tracing::level_filters::LevelFilter;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;
use tracing_subscriber::{fmt, registry};

/// Name of the environment variable.
const VARIABLE: &str = "TOILE_LOG";
/// Start of the names of the crates whose messages are logged.
const CRATES: &str = "toile";

/// How much is logged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumString, IntoStaticStr, VariantNames)]
#[strum(serialize_all = "lowercase")]
enum Detail {
    /// Nothing.
    Off,
    /// Commands with their seconds, stages of a garment, phases of a search.
    Info,
    /// Also every step with its residual, and what was recomputed.
    Debug,
}

impl Detail {
    /// Reads the value of the variable. A variable that is not set, or is empty, asks for no log.
    fn read(value: Result<String, VarError>) -> Result<Self, String> {
        let word = match value {
            Ok(word) if word.is_empty() => return Ok(Self::Off),
            Ok(word) => word,
            Err(VarError::NotPresent) => return Ok(Self::Off),
            Err(VarError::NotUnicode(bytes)) => bytes.to_string_lossy().into_owned(),
        };
        word.parse().map_err(|_| {
            let known = Self::VARIANTS.join(", ");
            format!("the environment variable {VARIABLE} is \"{word}\": give one of {known}")
        })
    }

    fn filter(self) -> LevelFilter {
        match self {
            Self::Off => LevelFilter::OFF,
            Self::Info => LevelFilter::INFO,
            Self::Debug => LevelFilter::DEBUG,
        }
    }
}

/// Whether a log is written.
pub fn is_logging() -> bool {
    LevelFilter::current() != LevelFilter::OFF
}

/// Starts the log if `TOILE_LOG` asks for one.
///
/// # Errors
/// The variable holds a word that is not known.
pub fn start_log() -> Result<(), String> {
    let detail = Detail::read(env::var(VARIABLE))?;
    if detail == Detail::Off {
        return Ok(());
    }
    let lines = fmt::layer()
        .with_writer(std::io::stderr)
        .with_ansi(false)
        .without_time();
    let filter = Targets::new().with_target(CRATES, detail.filter());
    // A second log in one process is not started: the first one holds for all of it.
    let _ = registry().with(lines).with(filter).try_init();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_known_words_are_taken() {
        let read = |word: &str| Detail::read(Ok(word.to_owned()));
        assert_eq!(read("debug"), Ok(Detail::Debug));
        assert_eq!(read("info"), Ok(Detail::Info));
        assert_eq!(read(""), Ok(Detail::Off));
        assert_eq!(Detail::read(Err(VarError::NotPresent)), Ok(Detail::Off));
        for wrong in ["all", "Debug", "toile=debug", " debug", "7"] {
            let refused = read(wrong).unwrap_err();
            assert!(refused.contains(wrong), "{refused}");
            assert!(
                refused.ends_with("give one of off, info, debug"),
                "{refused}"
            );
        }
    }
}
