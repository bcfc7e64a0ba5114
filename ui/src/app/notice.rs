//! The message of the status line.

/// How a message is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Tone {
    /// Good to know.
    #[default]
    WorkEvent,
    /// Probably not as meant.
    Warning,
    /// It was not done, and why.
    Fault,
}

/// The latest message.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Notice {
    /// How it is meant.
    pub tone: Tone,
    /// What it says; empty for none.
    pub text: String,
}

impl Notice {
    /// Whether something was not done.
    pub fn is_fault(&self) -> bool {
        self.tone == Tone::Fault && !self.text.is_empty()
    }

    /// Whether it only tells something.
    pub fn is_news(&self) -> bool {
        self.tone == Tone::WorkEvent
    }

    /// Good to know.
    pub fn news(text: impl Into<String>) -> Self {
        Self {
            tone: Tone::WorkEvent,
            text: text.into(),
        }
    }

    /// Probably not as meant.
    pub fn warning(text: impl Into<String>) -> Self {
        Self {
            tone: Tone::Warning,
            text: text.into(),
        }
    }

    /// It was not done, and why.
    pub fn fault(text: impl Into<String>) -> Self {
        Self {
            tone: Tone::Fault,
            text: text.into(),
        }
    }
}
