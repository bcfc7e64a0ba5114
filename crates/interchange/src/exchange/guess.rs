//! Decisions of a reader where a file is silent, or contradicts itself.

use super::ReadOption;
use serde::Serialize;
use std::fmt;

/// What a reader took for granted because the file does not say it, or says what cannot be.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Guess {
    /// The question that the file leaves open, as in "unit".
    pub what: &'static str,
    /// The answer that was taken, as in "mm".
    pub chosen: String,
    /// The reason, as in "the largest piece is then 73 cm".
    pub because: String,
    /// The option that gives another answer.
    pub option: ReadOption,
}

impl fmt::Display for Guess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            what,
            chosen,
            because,
            option,
        } = self;
        write!(
            f,
            "{what}, guessed: {chosen}: {because}; {option} says otherwise"
        )
    }
}
