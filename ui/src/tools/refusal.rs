//! Refusals of tools.

use toile_pattern::EditError;

/// A refusal with what is wrong and what to do.
pub(super) fn refuse(message: &str, hint: &str) -> EditError {
    EditError::Impossible {
        message: message.into(),
        hint: hint.into(),
    }
}
