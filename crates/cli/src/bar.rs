//! The progress of long work: a bar on a terminal, else a line now and then.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use toile_session::{Watcher, is_logging};

/// Exit status of a program that was interrupted.
pub const INTERRUPTED: i32 = 130;
/// Steps of the bar.
const STEPS: f64 = 1000.0;
/// Time from one line to the next where there is no terminal.
const LINES_APART: Duration = Duration::from_secs(30);

/// A bar on stderr; where that is no terminal, a line there from time to time.
pub struct Bar {
    bar: ProgressBar,
    /// When the last line was written, at first when the work began.
    last_line: Instant,
    /// Set when the work is to stop.
    stop: Option<Arc<AtomicBool>>,
}

impl Bar {
    /// A bar at its start. Beside a log there is none, which its lines would tear apart.
    pub fn new() -> Self {
        let bar = match is_logging() {
            true => ProgressBar::hidden(),
            false => ProgressBar::new(STEPS as u64),
        };
        let style = ProgressStyle::with_template("{bar:36} {percent:>3} %  {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style);
        Self {
            bar,
            last_line: Instant::now(),
            stop: None,
        }
    }

    /// A bar whose work stops at the first Ctrl-C; the second one ends the program.
    pub fn stopped_by_a_signal() -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let own = stop.clone();
        let handled = ctrlc::set_handler(move || {
            if own.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED);
            }
        });
        let mut bar = Self::new();
        bar.stop = handled.is_ok().then_some(stop);
        bar
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
        if self.bar.is_hidden() && self.last_line.elapsed() >= LINES_APART {
            self.last_line = Instant::now();
            let percent = 100.0 * share;
            // Nothing happens when nobody reads it any more.
            let _ = writeln!(std::io::stderr(), "{percent:.0} %: {stage}{gap}{detail}");
        }
        self.bar.set_message(format!("{stage}{gap}{detail}"));
        self.bar.set_position((share * STEPS) as u64);
        match &self.stop {
            Some(stop) if stop.load(Ordering::Relaxed) => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }

    fn stop_flag(&self) -> Option<Arc<AtomicBool>> {
        self.stop.clone()
    }
}
