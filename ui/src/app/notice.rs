//! The message of the status line.

/// Kind of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Tone {
    /// Information, as on a success.
    #[default]
    Information,
    /// Warning: the result is probably not intended.
    Warning,
    /// Failure; the text gives the reason.
    Fault,
}

/// The latest message.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Notice {
    /// Kind of the message.
    pub tone: Tone,
    /// Text; empty for no message.
    pub text: String,
}

impl Notice {
    /// Whether the notice reports a failure.
    pub fn is_fault(&self) -> bool {
        self.tone == Tone::Fault && !self.text.is_empty()
    }

    /// Whether the notice is mere information.
    pub fn is_news(&self) -> bool {
        self.tone == Tone::Information
    }

    /// Makes a notice of information.
    pub fn news(text: impl Into<String>) -> Self {
        Self {
            tone: Tone::Information,
            text: text.into(),
        }
    }

    /// Makes a warning: the result is probably not intended.
    pub fn warning(text: impl Into<String>) -> Self {
        Self {
            tone: Tone::Warning,
            text: text.into(),
        }
    }

    /// Makes a notice of a failure, with the reason.
    pub fn fault(text: impl Into<String>) -> Self {
        Self {
            tone: Tone::Fault,
            text: text.into(),
        }
    }
}
