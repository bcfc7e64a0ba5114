//! Errors that keep a draft from being assembled, and notes on one that was assembled.

/// Why no mesh could be made.
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
        /// What is wrong with it.
        reason: String,
        /// What to do about it.
        remedy: String,
    },
    /// A seam names something that is not there or cannot be matched.
    #[error("seam \"{seam}\": {reason}; {remedy}")]
    Seam {
        /// Name of the seam.
        seam: String,
        /// What is wrong with it.
        reason: String,
        /// What to do about it.
        remedy: String,
    },
    /// A piece is worn on a part that the body has not, as arms on a dress form.
    #[error(
        "piece \"{piece}\" is worn on {part}, which this body has not; choose a figure that has it"
    )]
    NoPart {
        /// Name of the piece.
        piece: String,
        /// The part, in words.
        part: &'static str,
    },
    /// The mesh would be larger than any garment needs.
    #[error("about {0} vertices would be made; give a larger edge length")]
    TooLarge(f64),
}

/// How much a diagnostic matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Said for information.
    Note,
    /// The result may not be what was meant.
    Warning,
}

/// A note on a garment that was assembled.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// How much it matters.
    pub severity: Severity,
    /// The piece or seam it is about.
    pub place: String,
    /// What was found.
    pub message: String,
    /// What can be done.
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
