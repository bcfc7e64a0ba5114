//! Errors of assembling a draft, and notes on an assembled garment.

/// The reason why no mesh could be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AssemblyError {
    /// The target edge length cannot be used.
    #[error("edge length {0} m cannot be used; give one from 0.5 mm to 1 m")]
    EdgeLength(f64),
    /// The draft has no piece that is sewn.
    #[error("no piece is sewn; sew panels together, or an edge of one to another of it")]
    Empty,
    /// The outline of a piece cannot be meshed.
    #[error("piece \"{piece}\": {reason}; {remedy}")]
    Outline {
        /// Name of the piece.
        piece: String,
        /// The fault of the outline.
        reason: String,
        /// Remedy for the user.
        remedy: String,
    },
    /// A seam names something that does not exist, or its sides cannot be matched.
    #[error("seam \"{seam}\": {reason}; {remedy}")]
    Seam {
        /// Name of the seam.
        seam: String,
        /// The fault of the seam.
        reason: String,
        /// Remedy for the user.
        remedy: String,
    },
    /// A piece is worn on a body part that the body does not have, such as arms on a dress form.
    #[error(
        "piece \"{piece}\" is worn on {part}, which this body has not; choose a figure that has it"
    )]
    NoPart {
        /// Name of the piece.
        piece: String,
        /// Name of the body part in a sentence.
        part: &'static str,
    },
    /// The mesh would be larger than any garment needs.
    #[error("about {0} vertices would be made; give a larger edge length")]
    TooLarge(f64),
}

/// Importance of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Information only.
    Note,
    /// The result may not be as intended.
    Warning,
}

/// A note on a garment that was assembled.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Importance of the diagnostic.
    pub severity: Severity,
    /// The piece or seam concerned.
    pub place: String,
    /// Description of the finding.
    pub message: String,
    /// Suggested remedy.
    pub hint: String,
}

impl Diagnostic {
    pub(crate) fn note(place: &str, message: String, hint: &str) -> Self {
        Self {
            severity: Severity::Note,
            place: place.to_owned(),
            message,
            hint: hint.to_owned(),
        }
    }

    pub(crate) fn warning(place: &str, message: String, hint: &str) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::note(place, message, hint)
        }
    }
}

impl std::fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let word = match self.severity {
            Severity::Note => "note",
            Severity::Warning => "warning",
        };
        write!(f, "{word}: {}: {}", self.place, self.message)?;
        if !self.hint.is_empty() {
            write!(f, "; {}", self.hint)?;
        }
        Ok(())
    }
}
