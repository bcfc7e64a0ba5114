//! Printing, on a thread of its own.

use super::ToileApp;
use super::dialogs::Dialog;
use super::job::Job;
use super::notice::Notice;
use super::print_choice::PrintChoice;
use std::path::PathBuf;
use toile_session::{PrintOptions, Printed, SizeSelection, print_pattern};

/// A print in progress.
pub struct Printing {
    job: Job<Printed>,
    /// The settings, with which the dialog opens again if the print fails.
    choice: PrintChoice,
    is_stopped: bool,
}

impl ToileApp {
    pub(crate) fn ask_print(&mut self) {
        let source = self.session.project().source.clone();
        let stem = source
            .as_ref()
            .and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
        let stem = stem.unwrap_or_else(|| self.session.project().pattern.name.clone());
        let stem = stem.split('.').next().unwrap_or("pattern").to_owned();
        let folder = source.and_then(|path| Some(path.parent()?.to_owned()));
        let path = folder.unwrap_or_default().join(format!("{stem}.pdf"));
        let sizes = match self.session.project().size_name() {
            Some(name) => SizeSelection::one(name),
            None => SizeSelection::Base,
        };
        self.dialog = Some(Dialog::Print(Box::new(PrintChoice {
            options: PrintOptions {
                sizes,
                paper: self.preferences.paper(),
                ..PrintOptions::default()
            },
            selected: self.selected_panels(),
            only_selected: false,
            scale: "1:1".into(),
            path: path.display().to_string(),
            fault: String::new(),
        })));
    }

    /// Names of the panels that are selected, or have a selected part.
    fn selected_panels(&self) -> Vec<String> {
        let pattern = self.base.pattern();
        let items = self.view.selection.items();
        let is_selected = |id| items.iter().any(|item| item.panel() == Some(id));
        let panels = pattern.panels.iter().filter(|panel| is_selected(panel.id));
        panels.map(|panel| panel.name.clone()).collect()
    }

    pub(super) fn print(&mut self, choice: PrintChoice) {
        let options = choice.options.clone();
        self.preferences.set_paper(options.paper);
        let project = self.session.project().clone();
        let path = PathBuf::from(choice.path.trim());
        self.printing = Some(Printing {
            job: Job::start(move |follower| print_pattern((&project, &path), &options, follower)),
            choice,
            is_stopped: false,
        });
    }

    /// Reports a print that has ended. After a failure the dialog opens again, with the reason.
    pub(super) fn follow_printing(&mut self) {
        let Some(printing) = &self.printing else {
            return;
        };
        let Some(result) = printing.job.result() else {
            let share = 100.0 * printing.job.progress().share;
            self.notice = Notice::news(format!("Printing: {share:.0} % (Esc stops)"));
            return;
        };
        self.notice = match result {
            Ok(printed) => {
                let sheets = printed.tiles.len();
                let plural = if sheets == 1 { "" } else { "s" };
                let to = printing.choice.path.trim();
                let mut words = format!("Printed {sheets} sheet{plural} to {to}");
                for note in &printed.notes {
                    words = format!("{words}; {note}");
                }
                match printed.notes.is_empty() {
                    true => Notice::news(words),
                    false => Notice::warning(words),
                }
            }
            Err(fault) => {
                // The user sees the failure before the window closes.
                if !printing.is_stopped {
                    (self.closes, self.waits_to_close) = (false, false);
                }
                if self.dialog.is_none() && !printing.is_stopped {
                    let fault = fault.clone();
                    let choice = printing.choice.clone();
                    self.dialog = Some(Dialog::Print(Box::new(PrintChoice { fault, ..choice })));
                }
                Notice::fault(fault)
            }
        };
        self.printing = None;
    }

    /// Stops the print in progress.
    pub(super) fn stop_printing(&mut self) {
        if let Some(printing) = &mut self.printing {
            printing.is_stopped = true;
            printing.job.cancel();
        }
    }
}
