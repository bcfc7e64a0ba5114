//! The progress bar, on a terminal only.

use indicatif::{ProgressBar, ProgressStyle};
use std::ops::ControlFlow;
use toile_session::Watcher;

/// Steps of the bar.
const STEPS: f64 = 1000.0;

/// A bar on stderr; hidden where stderr is no terminal.
pub struct Bar {
    bar: ProgressBar,
}

impl Bar {
    /// A bar at its start.
    pub fn new() -> Self {
        let bar = ProgressBar::new(STEPS as u64);
        let style = ProgressStyle::with_template("{bar:36} {percent:>3} %  {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style);
        Self { bar }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

impl Watcher for Bar {
    fn progress(&mut self, stage: &str, share: f64, detail: &str) -> ControlFlow<()> {
        let gap = if detail.is_empty() { "" } else { ": " };
        self.bar.set_message(format!("{stage}{gap}{detail}"));
        self.bar.set_position((share * STEPS) as u64);
        ControlFlow::Continue(())
    }
}
